"""What collide and range refuse, with which exit status, and that the message says which and where."""

import os
import pty
import select
import subprocess
import unittest

import gateway as g
import small_cell as s

DONE, REFUSED, USAGE = 0, 1, 2


class BadInput(unittest.TestCase):
    def setUp(self):
        self.home = s.Home()

    def tearDown(self):
        self.home.close()

    def refused(self, status, arguments, *words):
        done = s.program(*arguments)
        self.assertEqual(done.returncode, status, f"{arguments}: {done.stdout}{done.stderr}")
        self.assertEqual(done.stdout, "", arguments)
        for word in words:
            self.assertIn(word, done.stderr, arguments)

    def refused_postures(self, text, *words):
        path = self.home.postures(text)
        for command in ("collide", "range"):
            self.refused(REFUSED, [command, "--cell", self.home.cell, "--poses", path], *words)

    def test_all_mistakes_in_one_pass_with_their_places(self):
        self.refused_postures("S1.Slide,S1.Turn\nx,1\n1\n0,inf\n", "postures.csv:2:1: error: S1.Slide is not a finite",
                              "postures.csv:3:2: error: 1 columns, the header has 2",
                              "postures.csv:4:3: error: S1.Turn is not a finite number: inf")

    def test_headers(self):
        self.refused_postures("S1.Slid\n1\n", "postures.csv:1:1: error: robot S1 has no joint Slid; did you mean Slide?")
        self.refused_postures("S2.Slide\n1\n", "postures.csv:1:1: error: ", "S2")
        self.refused_postures("0.5\n1\n", "there is no header")
        self.refused_postures("", "the file is empty")
        self.refused_postures("S1.Slide\n", "there is no posture below the header")
        self.refused_postures(os.urandom(4096), "error: ")
        self.refused_postures(b"S1.Slide\n" + b"9" * 2_000_000, "is longer than 1048576 bytes")

    def test_files(self):
        self.refused(REFUSED, ["collide", "--cell", self.home.cell, "--poses", self.home.root / "none.csv"],
                     "there is no such file")
        self.refused(REFUSED, ["collide", "--cell", self.home.cell, "--poses", self.home.root], "no regular file")
        self.refused(REFUSED, ["collide", "--cell", self.home.root / "none.toml"], "none.toml")
        self.home.cell.write_text("format = 1\nname = 3\n[[node]]\nname = \"x\"\ngeometry = [{ box_m = [1, 2] }]\n")
        self.refused(REFUSED, ["range", "--cell", self.home.cell], "cell.toml:2:", "cell.toml:5:")

    def test_usage(self):
        for arguments in (["collide"], ["range"], ["collide", "--cell", self.home.cell, "--warning", "-1"],
                          ["collide", "--cell", self.home.cell, "--warning", "nan"],
                          ["collide", "--cell", self.home.cell, "--pairs", "--poses", "x.csv"],
                          ["range", "--cell", self.home.cell, "--pairs"]):
            self.refused(USAGE, arguments)

    def test_beyond_a_range_is_a_warning_on_standard_error(self):
        path = self.home.postures("S1.Slide\n-3\n-4\n")
        done = s.program("collide", "--cell", self.home.cell, "--poses", path, "--json")
        self.assertEqual(done.returncode, DONE)
        self.assertIn("postures.csv:2:1: warning: S1.Slide is -3 m, beyond its range -1 .. 3; so in 2 rows", done.stderr)

    def test_progress_is_for_terminals_only(self):
        rows = "S1.Slide\n" + "0.5\n" * 1_000_000
        path = self.home.postures(rows)
        command = [str(g.BIN / "cellmirror"), "collide", "--cell", str(self.home.cell), "--poses", str(path)]
        quiet = subprocess.run(command, capture_output=True, text=True, timeout=100)
        self.assertEqual(quiet.stderr, "")
        leader, follower = pty.openpty()
        with subprocess.Popen(command + ["--json"], stdout=subprocess.DEVNULL, stderr=follower) as running:
            os.close(follower)
            shown = b""
            while select.select([leader], [], [], 100)[0]:
                try:
                    piece = os.read(leader, 4096)
                except OSError:  # the other end is closed
                    break
                shown += piece
        os.close(leader)
        self.assertEqual(running.returncode, DONE)
        self.assertIn(b"of 1000000 frames", shown)


if __name__ == "__main__":
    unittest.main()

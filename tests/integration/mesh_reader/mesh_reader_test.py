"""The process that reads meshes, within the limits that it sets itself: what it may, and that nothing which a damaged file
does there reaches further."""

import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

BINARIES = pathlib.Path(os.environ["CELLMIRROR_BIN_DIR"])
READER = BINARIES / "cellmirror-mesh-reader"
CORPUS = pathlib.Path(os.environ["CELLMIRROR_SOURCE_DIR"]) / "tests/fuzz/mesh_check/corpus"
LONGEST = 60  # s, for what takes milliseconds


def text_of(path):
    return pathlib.Path(path).read_text()


def wait_for(condition):
    until = time.monotonic() + LONGEST
    while not condition():
        if time.monotonic() > until:
            raise TimeoutError
        time.sleep(0.01)


def is_confined(process):
    return "Seccomp:\t2" in text_of(f"/proc/{process}/status")


def runs(process):
    try:
        return text_of(f"/proc/{process}/stat").rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


class Limits(unittest.TestCase):
    def setUp(self):
        self.own, self.theirs = socket.socketpair()

    def tearDown(self):
        self.own.close()
        self.theirs.close()

    def test_takes_from_itself_what_reading_does_not_need(self):
        # A descriptor that somebody forgot to close.
        forgotten = os.dup2(self.own.fileno(), 77, inheritable=True)
        with subprocess.Popen([READER], stdin=self.theirs, stdout=self.theirs, close_fds=False) as reader:
            os.close(forgotten)
            try:
                wait_for(lambda: is_confined(reader.pid))
                self.assertIn("NoNewPrivs:\t1", text_of(f"/proc/{reader.pid}/status"))
                self.assertEqual(text_of(f"/proc/{reader.pid}/oom_score_adj").strip(), "1000")
                limits = text_of(f"/proc/{reader.pid}/limits")
                for name, most in (("address space", 3 << 30), ("cpu time", 60), ("core file size", 0), ("file size", 0),
                                   ("open files", 3)):
                    self.assertRegex(limits, rf"Max {re.escape(name)} +{most} ")
                self.assertEqual(sorted(os.listdir(f"/proc/{reader.pid}/fd")), ["0", "1", "2"])
            finally:
                reader.kill()

    def test_ends_with_the_process_that_started_it(self):
        # Its socket stays open here, so that nothing else can end it.
        starter = ("import subprocess, sys, time; process = subprocess.Popen([sys.argv[1]], stdin=0, stdout=0); "
                   "print(process.pid, file=sys.stderr, flush=True); time.sleep(60)")
        with subprocess.Popen([sys.executable, "-c", starter, READER], stdin=self.theirs, stderr=subprocess.PIPE) as parent:
            reader = int(parent.stderr.readline())
            wait_for(lambda: is_confined(reader))
            parent.kill()
        wait_for(lambda: not runs(reader))


class Files(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory(prefix="cellmirror-test-")
        self.folder = pathlib.Path(self._folder.name)

    def tearDown(self):
        self._folder.cleanup()

    def check(self, name):
        """Exit status and text of `cellmirror check` for a robot that has a file of the corpus as its mesh."""
        extension = name.rpartition("_")[2]
        (self.folder / f"{name}.{extension}").write_bytes((CORPUS / name).read_bytes()[1:])
        robot = self.folder / "robot.urdf"
        robot.write_text(f'<robot name="r"><link name="l"><collision><geometry><mesh filename="{name}.{extension}"/>'
                         "</geometry></collision></link></robot>")
        done = subprocess.run([BINARIES / "cellmirror", "check", robot], capture_output=True, text=True, timeout=60, check=False)
        return done.returncode, done.stdout + done.stderr

    def test_all_formats_are_read_within_the_limits(self):
        for name in ("tetra_stl", "tetra_ascii_stl", "l_obj", "tetra_dae", "tetra_ply", "tetra_glb"):
            with self.subTest(name):
                status, text = self.check(name)
                self.assertEqual(status, 0, text)

    def test_no_damaged_file_ends_more_than_its_reader(self):
        for path in sorted(CORPUS.iterdir()):
            with self.subTest(path.name):
                status, text = self.check(path.name)
                self.assertIn(status, (0, 1), text)

    def test_says_what_became_of_the_reader(self):
        status, text = self.check("odd_mime_type_glb")
        self.assertEqual(status, 1)
        self.assertRegex(text, r"the mesh odd_mime_type_glb.glb is refused: it cannot be read: ")
        status, text = self.check("huge_list_ply")
        self.assertEqual(status, 1)
        self.assertIn("the mesh huge_list_ply.ply is refused: it cannot be read: its reader ran out of memory; export it again, "
                      "or reduce the mesh", text)


if __name__ == "__main__":
    signal.alarm(110)
    unittest.main()

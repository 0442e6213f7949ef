"""The unit as systemd's own tools see it: it is well formed, and its exposure is 2.0 or less. The loop stays real time."""

import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

import gateway as g

UNIT = g.SOURCE / "config" / "systemd" / "cellmirror@.service"
DISCOVERY_SERVER = g.SOURCE / "docs" / "examples" / "discovery-server.service"
MOST_EXPOSED = 2.0


def lines_of(key):
    return re.findall(rf"^{key}=(.*)$", UNIT.read_text(), re.MULTILINE)


class Unit(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        g.require("systemd-analyze", "systemd-analyze is missing (package systemd)")
        # A name of an instance, and a program that is there.
        cls.root = pathlib.Path(tempfile.mkdtemp(prefix="cellmirror-unit-"))
        cls.unit = cls.root / "cellmirror@cell_1.service"
        cls.unit.write_text(UNIT.read_text().replace("/usr/bin/cellmirror", str(g.BIN / "cellmirror")))

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.root)

    def analyze(self, *arguments):
        return subprocess.run(["systemd-analyze", *arguments], capture_output=True, text=True, timeout=60,
                              env=dict(os.environ, LC_ALL="C.UTF-8", SYSTEMD_COLORS="0"))

    def test_is_well_formed(self):
        done = self.analyze("verify", "--man=no", "--generators=no", "--recursive-errors=no", str(self.unit))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr, "")

    def test_that_of_a_discovery_server_is_well_formed(self):
        unit = self.root / DISCOVERY_SERVER.name
        unit.write_text(DISCOVERY_SERVER.read_text().replace("/usr/bin/fast-discovery-server", "/bin/true"))
        done = self.analyze("verify", "--man=no", "--generators=no", "--recursive-errors=no", str(unit))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr, "")

    def test_exposes_little(self):
        done = self.analyze("security", "--offline=true", f"--threshold={int(MOST_EXPOSED * 10)}", str(self.unit))
        shown = re.search(r"Overall exposure level for .*: ([0-9.]+)", done.stdout)
        self.assertTrue(shown, done.stdout + done.stderr)
        self.assertLessEqual(float(shown[1]), MOST_EXPOSED, done.stdout)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_it_is_started_again_without_end_and_leaves_no_core(self):
        self.assertEqual(lines_of("StartLimitIntervalSec"), ["0"])
        self.assertEqual(lines_of("Restart"), ["always"])
        self.assertEqual(lines_of("LimitCORE"), ["0"])
        self.assertGreaterEqual(float(lines_of("RestartSec")[0]), 1, "a pause bounds the cost of a cell with an error")
        self.assertRegex(lines_of("ExecReload")[0], "^/usr/bin/cellmirror check ", "before the gateway is ended")

    def test_the_loop_stays_real_time_and_pictures_are_drawn(self):
        self.assertEqual(lines_of("RestrictRealtime"), ["no"])
        self.assertEqual(lines_of("LimitMEMLOCK"), ["infinity"])
        self.assertGreaterEqual(int(lines_of("LimitRTPRIO")[0]), 80)
        self.assertLessEqual(int(lines_of("LimitNICE")[0]), -10)
        self.assertNotIn("--headless", lines_of("ExecStart")[0])
        # The rasteriser of Mesa writes machine code and runs it.
        self.assertNotIn("yes", lines_of("MemoryDenyWriteExecute"))


if __name__ == "__main__":
    g.main()

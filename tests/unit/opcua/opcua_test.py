"""Runs the tests of the bridge to OPC UA that need no package of npm, with node's own test runner."""

import pathlib
import re
import shutil
import subprocess
import unittest

HERE = pathlib.Path(__file__).resolve().parent


class Modules(unittest.TestCase):
    def test_with_node(self):
        node = shutil.which("node") or shutil.which("nodejs")
        if not node:
            self.skipTest("skipped: node is not installed")
        done = subprocess.run([node, "--test", *sorted(str(test) for test in HERE.glob("*_test.mjs"))], cwd=HERE,
                              capture_output=True, text=True, timeout=100)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        passed = re.search(r"^(?:#|\u2139) pass (\d+)", done.stdout, re.M)
        self.assertGreater(int(passed[1]) if passed else 0, 3, done.stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)

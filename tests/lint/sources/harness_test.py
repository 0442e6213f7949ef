"""The tests' own tools: what is counted and printed of failures, and what a failed sub-test leaves behind."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(SOURCE / "tests" / "support"))
os.environ.setdefault("CELLMIRROR_SOURCE_DIR", str(SOURCE))
os.environ.setdefault("CELLMIRROR_BIN_DIR", str(SOURCE / "build" / "bin"))

import gateway as g  # noqa: E402
import test_report  # noqa: E402

PROGRAM = """
import unittest
class Some(unittest.TestCase):
    def test_a_passes(self): pass
    def test_b_fails(self): self.fail("once")
    def test_c_fails_twice(self):
        for i in range(4):
            with self.subTest(i=i): self.assertTrue(i % 2, f"sub {i}")
    @unittest.skip("skipped: not here")
    def test_d_is_skipped(self): pass
    def test_e_raises(self): raise ValueError("raised")
unittest.main(verbosity=2)
"""


class Counting(unittest.TestCase):
    def setUp(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "some.py"
            path.write_text(PROGRAM)
            output = subprocess.run([sys.executable, path], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False).stdout
        self.report = test_report.Report()
        self.assertTrue(test_report.count_unittest(output, self.report), output)

    def test_a_case_is_counted_once_and_each_of_its_failures_is_named(self):
        self.assertEqual(self.report.passed, 1)
        self.assertEqual([case.name for case in self.report.skipped], ["test_d_is_skipped"])
        self.assertEqual(sorted(case.name for case in self.report.failed),
                         ["test_b_fails", "test_c_fails_twice (i=0)", "test_c_fails_twice (i=2)", "test_e_raises"])

    def test_a_failure_is_printed_once(self):
        details = "\n".join(case.detail for case in self.report.failed)
        for text in ("AssertionError: once", ": sub 0", ": sub 2", "ValueError: raised"):
            self.assertEqual(details.count(text), 1, details)
        self.assertNotIn("Ran 5 tests", details)


class SubTests(unittest.TestCase):
    def test_what_a_failed_sub_test_began_is_cleaned_up_before_the_next_one(self):
        seen = []

        class Case(unittest.TestCase):
            def test(self):
                self.addCleanup(seen.append, "test")
                for number in (1, 2):
                    with g.sub_test(self, number=number):
                        self.addCleanup(seen.append, f"end {number}")
                        seen.append(f"begin {number}")
                        self.assertEqual(number, 2)

        result = unittest.TestResult()
        Case("test").run(result)
        self.assertEqual(seen, ["begin 1", "end 1", "begin 2", "end 2", "test"])
        self.assertEqual(len(result.failures), 1)


if __name__ == "__main__":
    unittest.main(verbosity=2)

"""cellmirror check --language: what the golden cases of every language say, and whether a program fits a robot."""

import json
import pathlib
import shutil
import subprocess
import tempfile
import unittest

import gateway as g
import small_cell as s

GOLDEN = g.SOURCE / "tests/golden/programs"
PROGRAMS = s.TRANSFER_CELL.parent / "programs"
CODES = {"irdata": "irdata_codes.tsv"}


def check(*arguments, folder=None):
    return subprocess.run([str(g.BIN / "cellmirror"), "check", *map(str, arguments)], capture_output=True, text=True,
                          timeout=60, cwd=folder)


class Goldens(unittest.TestCase):
    """All cases of a language in one call, which tells each file's faults behind its path."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="cellmirror-test-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def check_cases(self, language, kind):
        """{case: what was said of it}, and the exit status."""
        cases = {}
        for case in sorted((GOLDEN / language / kind).iterdir()):
            copy = self.folder / language / kind / case.name
            shutil.copytree(case, copy)
            if (copy / "codes.tsv").exists():
                (copy / "codes.tsv").rename(copy / CODES[language])
            cases[case] = next(copy.glob("program.*")).relative_to(self.folder)
        done = check("--language", language, *cases.values(), folder=self.folder)
        lines = done.stderr.splitlines()
        return {case: [line.replace(str(path), path.name, 1) for line in lines if line.startswith(f"{path}:")]
                for case, path in cases.items()}, done.returncode

    def languages(self, kind):
        return sorted(path.name for path in GOLDEN.iterdir() if (path / kind).is_dir())

    def test_all_that_is_wrong_is_told_at_once(self):
        compared = 0
        for language in self.languages("bad"):
            said, status = self.check_cases(language, "bad")
            self.assertEqual(status, 1)
            for case, lines in said.items():
                expected = (case / "diagnostics.txt").read_text().splitlines()
                # What does not fit the robot of the golden cases is told with --robot only; what is wrong with a table of
                # codes is told of the table.
                if not lines or not all(line.startswith("program.") for line in expected):
                    continue
                with self.subTest(language=language, case=case.name):
                    self.assertEqual(lines, expected)
                    compared += 1
        self.assertGreater(compared, 20 * len(self.languages("bad")))

    def test_good_programs_pass(self):
        for language in self.languages("good"):
            said, status = self.check_cases(language, "good")
            self.assertEqual(status, 0, said)


class Robots(unittest.TestCase):
    def test_the_programs_of_the_transfer_cell_without_naming_their_language(self):
        programs = sorted(PROGRAMS.glob("*.ird"))
        self.assertGreater(len(programs), 5)
        done = check(*programs)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("no errors", done.stdout)

    def test_a_program_has_to_fit_the_joints_of_its_robot(self):
        cell = ("--cell", s.TRANSFER_CELL)
        crane = PROGRAMS / "hs1.ird"
        self.assertEqual(check("--language", "irdata", *cell, "--robot", "ZELLENKRAN", crane).returncode, 0)
        arm = PROGRAMS / "r3demo.ird"
        done = check("--language", "irdata", *cell, "--robot", "ZELLENKRAN", "--json", arm)
        self.assertEqual(done.returncode, 1)
        found = json.loads(done.stdout)
        self.assertGreater(found["errors"], 0)
        self.assertTrue(all(d["line"] > 0 for d in found["diagnostics"]))

    def test_wrong_usage_and_unknown_robots(self):
        arm = PROGRAMS / "r3demo.ird"
        self.assertEqual(check("--language", "cobol", arm).returncode, 2)
        self.assertEqual(check("--robot", "PUMA_762", arm).returncode, 2)
        done = check("--cell", s.TRANSFER_CELL, "--robot", "PUMA_763", arm)
        self.assertEqual(done.returncode, 1)
        self.assertIn("did you mean PUMA_762", done.stderr)
        self.assertEqual(check("--language", "irdata", "no.ird").returncode, 1)


if __name__ == "__main__":
    unittest.main()

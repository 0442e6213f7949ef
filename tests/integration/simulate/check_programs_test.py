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


class SmallCell(unittest.TestCase):
    """A robot S1 with a slide from -1000 to 3000 mm and a joint that turns by 172 degrees both ways."""

    def setUp(self):
        self.home = s.Home()
        self.addCleanup(self.home.close)
        for folder in ("scripts", "programs"):
            (self.home.root / folder).mkdir()

    def findings(self, name, text, *arguments):
        """[(severity, line, column, message)], and all of it as one text."""
        path = self.home.root / name
        path.write_text(text)
        found = json.loads(check("--cell", self.home.cell, "--json", *arguments, path).stdout)["diagnostics"]
        return [(d["severity"], d["line"], d["column"], d["message"] + "; " + d["remedy"]) for d in found]

    def assert_found(self, found, expected):
        self.assertEqual([one[:3] for one in found], [one[:3] for one in expected], found)
        for (_, _, _, said), (_, _, _, words) in zip(found, expected):
            self.assertIn(words, said)


class Programs(SmallCell):
    def program(self, *records):
        lines = ["HEADER, test", "END_HEADER", *records, "END"]
        return "".join(f"{n}, {line}\n" for n, line in enumerate(lines, start=1))

    def test_commands_in_comments_are_checked_as_in_a_script(self):
        text = self.program("COMMENT, %hot_mesage done", "COMMENT, %POS_ROB S2 JOINT_ABS 1", "COMMENT, %WAIT",
                            "COMMENT, %POS_ROB S1 JOINT_ABS 1", "COMMENT, %POS_ROB S1 JOINT_ABS 4000", "COMMENT, %TF_LOAD gone S1")
        found = self.findings("programs/test.ird", text)
        self.assert_found([(a, b, 0, d) for a, b, _, d in found], [
            ("error", 3, 0, "did you mean hot_message"), ("error", 4, 0, "S2"), ("error", 5, 0, "would wait for itself"),
            ("warning", 7, 0, "upper limit"), ("warning", 8, 0, "no irdata program gone")])

    def test_constant_targets_beyond_the_ranges_and_speeds_above_the_robots_own(self):
        text = ("1, HEADER, test\n2, JOINTS, far, JOINTS(0, 200)\n3, JOINTS, near, JOINTS(0, 0)\n4, END_HEADER\n"
                "5, PTP, JOINTS(3500, 190)\n6, PTP, far\n7, PTP, near\n8, VEL_LIN, 250000\n9, VEL_LIN, 900\n10, END\n")
        found = self.findings("programs/test.ird", text, "--robot", "S1")
        self.assert_found([(a, b, 0, d) for a, b, _, d in found], [
            ("warning", 5, 0, "3.5 m (3500 mm) is above"), ("warning", 5, 0, "(190 deg) is above"),
            ("warning", 6, 0, "(200 deg) is above"), ("note", 8, 0, "250000 mm/s, but S1 goes at 1000 mm/s at most")])

    def test_what_does_not_fit_is_told_beside_other_faults(self):
        irdata = self.program("PTP, JOINTS(1, 2, 3)", "NONSENSE")
        srcl = "PROGRAMM T\nPTP STELLUNG(1, 2, 3)\nNONSENSE\n"
        boom = "JET_BOOM 1\nJOINTS 3\nPOINT P1 1 2 3\nNONSENSE\nEND\n"
        # NONSENSE before the move that does not fit.
        crcl = (GOLDEN / "crcl/bad/more_joints_than_the_robot/program.crcl").read_text().replace(
            "<MiddleCommand", '<MiddleCommand xsi:type="NONSENSE"/>\n<MiddleCommand', 1)
        rapid = ("MODULE M\nPROC main()\nMoveAbsJ [[1,2,3,9E9,9E9,9E9],[9E9,9E9,9E9,9E9,9E9,9E9]],vmax,fine,tool0;\n"
                 "NONSENSE 1;\nENDPROC\nENDMODULE\n")
        for name, text in (("test.ird", irdata), ("test.src", srcl), ("test.boom", boom), ("test.crcl", crcl),
                           ("test.mod", rapid)):
            with self.subTest(name=name):
                said = [d for _, _, _, d in self.findings("programs/" + name, text, "--robot", "S1")]
                self.assertTrue(any("NONSENSE" in d for d in said), said)
                self.assertTrue(any("joint values, the robot has 2 joints" in d for d in said), said)

    def test_a_word_that_is_nearly_fly(self):
        found = self.findings("programs/test.ird", self.program("PTP, JOINTS(1, 2), FLYY"))
        self.assert_found(found, [("error", 3, 23, "'FLYY' is not FLY; did you mean FLY?")])

    def test_a_name_that_says_another_language(self):
        found = self.findings("programs/test.src", "PROGRAMM T\n", "--language", "irdata")
        self.assertEqual(found[0][:2], ("warning", 0))
        self.assertIn("the file's name says srcl", found[0][3])
        self.assertIn("--language srcl", found[0][3])


class Scripts(SmallCell):
    def test_files_that_do_not_exist(self):
        found = self.findings("scripts/test.spt", "TF_LOAD gone S1;\nEXEC_SCRIPT gone;\nLOAD_VIEWS gone")
        self.assert_found(found, [("warning", 1, 9, "no irdata program gone"), ("warning", 2, 13, "scripts/gone"),
                                  ("warning", 3, 12, "scripts/gone")])

    def test_deformable_objects_and_their_files(self):
        text = ("eladyn_geo_def ALL CUT on;\neladyn_geo_def liver.mpo 3;\neladyn_hyper_name gone;\nROBACT S1;\n"
                "ela_clip_def gone.mpo 0 0 0 0 0 0;\nEFFECTS SUCTION ON")
        self.assert_found(self.findings("scripts/test.spt", text), [
            ("warning", 1, 16, "the cell has no deformable object"), ("warning", 2, 16, "the cell has no deformable object"),
            ("warning", 3, 19, "envlib/gone"), ("warning", 5, 14, "envlib/gone.mpo")])

    def test_files_that_an_earlier_command_makes(self):
        (self.home.root / "programs/there.src").write_text("")
        text = ("TF_RECORD taught S1 START;\nTF_RECORD taught S1 STOP;\nTF_LOAD taught S1;\nSAVE_VIEWS made;\n"
                "LOAD_VIEWS made.vws;\nROBOT_LANGUAGE srcl;\nTF_LOAD there S1")
        self.assertEqual(self.findings("scripts/test.spt", text), [])

    def test_values_beyond_the_ranges_that_hold_there(self):
        (self.home.root / "scripts/wide.spt").write_text("ROBACT S1;\nrob_jnt_max_range 9000 100\n")
        text = ("POS_ROB S1 JOINT_ABS 4000 0;\nMOVE_ROB S1 PTP JOINT_ABS 0\n 190;\nEXEC_SCRIPT wide;\n"
                "POS_ROB S1 JOINT_ABS 4000 101;\nROBACT S1;\nrob_jnt_act_vel 1 90")
        self.assert_found(self.findings("scripts/test.spt", text), [
            ("warning", 1, 22, "4 m (4000 mm) is above its upper limit 3 m"), ("warning", 3, 2, "(190 deg) is above"),
            ("warning", 5, 27, "(101 deg) is above its upper limit 1.74533 rad"), ("warning", 7, 17, "not degrees")])

    def test_a_file_that_calls_itself_is_followed_once(self):
        self.assertEqual(self.findings("scripts/test.spt", "EXEC_SCRIPT test"), [])


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

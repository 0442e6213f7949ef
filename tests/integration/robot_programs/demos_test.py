"""The scripts of the transfer cell with robot programs run off line to their ends, and do what they say."""

import json
import os
import re
import subprocess
import unittest
from pathlib import Path

CELL = Path(os.environ["CELLMIRROR_SOURCE_DIR"]) / "config/cells/transfer_cell"
CELLMIRROR = Path(os.environ["CELLMIRROR_BIN_DIR"]) / "cellmirror"
TICK = 0.001


def cellmirror(*arguments):
    return subprocess.run([CELLMIRROR, *arguments], capture_output=True, text=True, timeout=100)


class Demos(unittest.TestCase):
    def simulate(self, script, *options):
        done = cellmirror("simulate", "--cell", CELL / "cell.toml", "--script", script, "--json", *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        found = json.loads(done.stdout)
        self.assertEqual((found["end"], found["refused"], found["deadlocks"]), ("finished", [], []))
        for program in found["programs"]:
            self.assertEqual(program["end"], "ended", program)
        return found

    def test_the_example_of_the_manual_moves_the_gantry_to_its_reference_position(self):
        found = self.simulate("trsys_demo.spt", "--no-collisions")
        self.assertEqual([p["program"] for p in found["programs"]], ["ird_trstart"])
        gantry = next(robot for robot in found["robots"] if robot["id"] == "TRAEGERSYSTEM")
        self.assertEqual([joint["moved"] for joint in gantry["joints"]], [True, True, True])

    def test_the_examples_of_tf_run_run_beside_and_behind_each_other(self):
        programs = {p["program"]: p for p in self.simulate("tf_run.spt", "--no-collisions")["programs"]}
        self.assertEqual(set(programs), {"r3demo", "r3demo2", "hs1", "hs2", "hs3"})
        self.assertAlmostEqual(programs["r3demo"]["begin_s"], programs["r3demo2"]["begin_s"], delta=TICK)
        self.assertAlmostEqual(programs["r3demo"]["begin_s"], programs["hs1"]["begin_s"], delta=TICK)
        for before, behind in (("hs1", "hs2"), ("hs2", "hs3")):
            self.assertAlmostEqual(programs[before]["end_s"], programs[behind]["begin_s"], delta=TICK)

    def test_only_one_arm_is_at_the_place_where_they_hand_over(self):
        moves = self.simulate("tf_run.spt", "--no-collisions")["moves"]
        visits = []
        for program in ("r3demo", "r3demo2"):
            lines = (CELL / "programs" / f"{program}.ird").read_text().splitlines()
            down = next(i for i, line in enumerate(lines, 1) if re.search(r"LIN, exchange\s*$", line))
            up = next(i for i, line in enumerate(lines, 1) if "LIN, exchange @ raised" in line)
            mine = [m for m in moves if m["program"] == program]
            begins = [m["begin_s"] for m in mine if m["line"] == down]
            ends = [m["end_s"] for m in mine if m["line"] == up]
            self.assertEqual((len(begins), len(ends)), (3, 3), program)
            visits += [(begin, end, program) for begin, end in zip(begins, ends)]
        visits.sort()
        self.assertEqual([program for _, _, program in visits], ["r3demo", "r3demo2"] * 3)
        for (_, end, _), (begin, _, _) in zip(visits, visits[1:]):
            self.assertLess(end, begin)

    def test_all_programs_run_without_collisions(self):
        found = self.simulate("programs_demo.spt")
        self.assertTrue(found["collision"]["tested"])
        self.assertEqual(found["collision"]["collisions"], [])
        self.assertEqual(len(found["programs"]), 7)

    def test_teach_files_go_back_as_they_came(self):
        moves = self.simulate("teach_demo.spt", "--no-collisions")["moves"]
        # The crane stops on every check point. There: to PARKED, where it stands, then five legs and a dwell. Back: from
        # HOME, where it stands, the same legs without the dwell.
        crane = [m for m in moves if m["robot"] == "ZELLENKRAN"]
        legs = [m["duration_s"] for m in crane if m["kind"] == "joints" and m["duration_s"] > 0]
        self.assertEqual(len(legs), 10)
        for there, back in zip(legs[:5], reversed(legs[5:])):
            self.assertAlmostEqual(there, back, delta=1e-6)
        self.assertEqual([m["duration_s"] for m in crane if m["kind"] == "delay"], [0.5])
        # 1.5 m at half of 1.5 m/s, with 1 m/s2.
        self.assertAlmostEqual(legs[0], 1.5 / 0.75 + 0.75, delta=TICK)

    def test_the_programs_have_no_faults(self):
        for language, extension in (("irdata", "ird"), ("jet_boom", "boom"), ("jet_tarm", "tarm")):
            files = sorted((CELL / "programs").glob(f"*.{extension}"))
            self.assertTrue(files, extension)
            done = cellmirror("check", "--language", language, *files)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()

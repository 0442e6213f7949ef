"""Every example of the manual on the transfer cell: done, or refused for the stated reason."""

import json
import unittest

import gateway as g

# Examples that change the tree start from a fresh cell each, so that one does not take another's node away.
TREE = {"ACTIVATE", "DEACTIVATE", "DELETE_NODE", "SWAP_NODE", "LEVEL_DOWN", "LEVEL_UP", "CONNECT", "FRAME_TO_WFRM",
        "SET_FRAME"}
# These examples need what another command does first.
BEFORE = {
    "DELETE_NODE": "ACTIVATE Testlab_1.FL_Klein.Flansch_Typ1",
    "LEVEL_UP": "LEVEL_DOWN Testlab_1.FL_Klein",
}
# Robot programs: what goes before an example, so that it is done whatever went before it.
LONG = ["ROBOT_LANGUAGE srcl", "TF_LOAD ird_getschr MANTEC_RM3"]  # of ours, below
PROGRAMS = {
    "TF_LOAD": ["ROBOT_LANGUAGE irdata"],
    "TF_RUN": ["ROBOT_LANGUAGE irdata", "TF_LOAD hs2 ZELLENKRAN"],
    "TF_DELETE": LONG,
    "TF_BACK": ["ROBOT_LANGUAGE jet_boom", "TF_LOAD r3_taught mantec_R3"],
    "TF_HOLD": [*LONG, "TF_RUN ird_getschr MANTEC_RM3"],
    "TF_RESUME": ["TF_HOLD MANTEC_RM3"],
    "TF_STEP": ["TF_HOLD MANTEC_RM3"],
    "TF_WAIT": ["TF_STOP MANTEC_RM3"],
}
# Refused, and why.
REFUSED = {
    "WAIT": "suspends the SCRIPT file",
    # The manual's own range for this axis, in the examples before, ends at -115.5 degrees.
    "rob_jnt_start_pos 0.0 50.0 -110.0 0.0 -150.0 -180.0": "below its lower limit",
    "STOP_SCRIPT 3": "there is no run 3",
    "RESET_HAPTIC MANTEC_RM3": "has no haptic device",
    "VV_ISO on VALUE 300": "the cell has no voxel volume",
    "ALARM_ACK Ada 12": "no alarm 12 is open",
}
# The examples of 1.2.2 fit robots with so many joints; ROBACT comes first, as the manual says.
ROBOT_OF_COUNT = {6: "MANTEC_R3", 3: "ZELLENKRAN"}


def examples():
    """(section, command, example) of every form with an example."""
    done = g.subprocess.run([g.BIN / "cellmirror", "commands", "--json"], capture_output=True, text=True, check=True)
    for form in json.loads(done.stdout)["commands"]:
        example = (form.get("example") or "").strip().rstrip(";").strip()
        if example and not example.startswith("#"):
            yield form["section"], form["name"], example


class Examples(unittest.TestCase):
    def check(self, scratch, example):
        done = scratch.send(example)
        if example in REFUSED:
            self.assertEqual(done.returncode, 1, example)
            self.assertIn(REFUSED[example], done.stderr)
        else:
            self.assertEqual(done.returncode, 0, f"{example}: {done.stderr}")
            if example.startswith("EXEC_SCRIPT"):
                # It goes on by itself; its moves would take the place of those of the examples that follow.
                self.assertTrue(g.eventually(lambda: scratch.status()["script"]["running"] == 0, 60))

    def test_examples_that_change_the_tree(self):
        for _, name, example in examples():
            if name not in TREE:
                continue
            with self.subTest(example=example):
                scratch = g.Scratch()
                gateway = g.Gateway(scratch)
                try:
                    if name in BEFORE:
                        self.assertEqual(scratch.send(BEFORE[name]).returncode, 0)
                    self.check(scratch, example)
                finally:
                    gateway.close()
                    scratch.remove()

    def test_all_other_examples(self):
        scratch = g.Scratch()
        (scratch.home / "programs" / "ird_getschr.src").write_text("WARTE 60\n")
        scratch.cell_file.write_text(scratch.cell_file.read_text() + "\n[record]\n")  # for RECORD KEEP
        gateway = g.Gateway(scratch)
        try:
            count = 0
            for section, name, example in examples():
                if name in TREE:
                    continue
                with self.subTest(example=example):
                    if section == "1.2.2":
                        robot = ROBOT_OF_COUNT.get(len(example.split()) - 1, "MANTEC_R3")
                        self.assertEqual(scratch.send(f"ROBACT {robot}").returncode, 0)
                    for command in PROGRAMS.get(name, []):
                        scratch.send(command)
                    self.check(scratch, example)
                    count += 1
            self.assertGreater(count, 40)
            self.assertTrue(gateway.running())
        finally:
            gateway.close()
            scratch.remove()

    def test_a_cell_without_voxel_volumes_refuses_their_commands(self):
        scratch = g.Scratch()
        gateway = g.Gateway(scratch)
        try:
            for command in ("VV_RELOAD_LUTS", "VV_CLIP CLP1 off", "VV_CLIP_POS CLP1 ELE 1 AZI 2 DIST 3",
                            "VV_SET_LUT LIN_LUT", "VV_SET_LUT_PAR MEDICAL_LUT 0 0 0 1",
                            "VV_SET_LUT_PAR LIN_LUT 1 1 1 1", "VV_SET_LUT LIN_LUT Toolbox"):
                done = scratch.send(command)
                self.assertEqual(done.returncode, 1, command)
                self.assertIn("the cell has no voxel volume", done.stderr, command)
        finally:
            gateway.close()
            scratch.remove()

    def test_a_cell_without_deformable_objects_takes_settings_and_refuses_names(self):
        scratch = g.Scratch()
        gateway = g.Gateway(scratch)
        try:
            self.assertEqual(scratch.send("ROBACT PUMA_762").returncode, 0)
            for command in ("EFFECTS PULSE ON", "eladyn_calc off", "eladyn_show_def 1", "rob_ela_interact 6 1 0 0 0"):
                done = scratch.send(command)
                self.assertEqual(done.returncode, 0, command)
                self.assertIn("no deformable object", done.stdout, command)
            for command in ("eladyn_geo_def ALL CUT on", "eladyn_geo_def liver.mpo 3", "eladyn_hyper_name links.hyp"):
                done = scratch.send(command)
                self.assertEqual(done.returncode, 1, command)
                self.assertIn("no deformable object", done.stderr, command)
        finally:
            gateway.close()
            scratch.remove()

    def test_the_manuals_script_runs_to_its_end_and_its_robot_program_with_it(self):
        scratch = g.Scratch()
        gateway = g.Gateway(scratch)
        try:
            self.assertEqual(scratch.send("EXEC_SCRIPT trsys_demo.spt").returncode, 0)
            g.eventually(lambda: scratch.status()["script"]["running"] == 0)
            errors = [error for error in scratch.status()["script"]["last_errors"] if "trsys_demo" in error]
            self.assertEqual(errors, [])
            self.assertEqual(scratch.send("TF_WAIT TRAEGERSYSTEM").returncode, 0)
            programs = {p["program"]: p for p in scratch.status()["programs"]["loaded"]}
            self.assertEqual((programs["ird_trstart"]["state"], programs["ird_711"]["state"]), ("ended", "loaded"))
        finally:
            gateway.close()
            scratch.remove()


if __name__ == "__main__":
    g.main()

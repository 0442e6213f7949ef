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
# Refused, and why.
REFUSED = {
    "WAIT": "suspends the SCRIPT file",
    # The manual's own range for this axis, in the examples before, ends at -115.5 degrees.
    "rob_jnt_start_pos 0.0 50.0 -110.0 0.0 -150.0 -180.0": "below its lower limit",
    "RESET_HAPTIC MANTEC_RM3": "has no haptic device",
}
# The examples of 1.2.2 fit robots with so many joints; ROBACT comes first, as the manual says.
ROBOT_OF_COUNT = {6: "MANTEC_R3", 3: "ZELLENKRAN"}


def examples():
    """(section, command, example, implemented) of every form with an example."""
    done = g.subprocess.run([g.BIN / "cellmirror", "commands", "--json"], capture_output=True, text=True, check=True)
    for form in json.loads(done.stdout)["commands"]:
        example = (form.get("example") or "").strip().rstrip(";").strip()
        if example and not example.startswith("#"):
            yield form["section"], form["name"], example, form["implemented"]


class Examples(unittest.TestCase):
    def check(self, scratch, example, implemented):
        done = scratch.send(example)
        if example in REFUSED:
            self.assertEqual(done.returncode, 1, example)
            self.assertIn(REFUSED[example], done.stderr)
        elif implemented:
            self.assertEqual(done.returncode, 0, f"{example}: {done.stderr}")
            if example.startswith("EXEC_SCRIPT"):
                # It goes on by itself; its moves would take the place of those of the examples that follow.
                self.assertTrue(g.eventually(lambda: scratch.status()["script"]["running"] == 0, 60))
        else:
            self.assertEqual(done.returncode, 1, example)
            self.assertIn("not available yet", done.stderr, example)

    def test_examples_that_change_the_tree(self):
        for _, name, example, implemented in examples():
            if name not in TREE:
                continue
            with self.subTest(example=example):
                scratch = g.Scratch()
                gateway = g.Gateway(scratch)
                try:
                    if name in BEFORE:
                        self.assertEqual(scratch.send(BEFORE[name]).returncode, 0)
                    self.check(scratch, example, implemented)
                finally:
                    gateway.close()
                    scratch.remove()

    def test_all_other_examples(self):
        scratch = g.Scratch()
        gateway = g.Gateway(scratch)
        try:
            count = 0
            for section, name, example, implemented in examples():
                if name in TREE:
                    continue
                with self.subTest(example=example):
                    if section == "1.2.2":
                        robot = ROBOT_OF_COUNT.get(len(example.split()) - 1, "MANTEC_R3")
                        self.assertEqual(scratch.send(f"ROBACT {robot}").returncode, 0)
                    self.check(scratch, example, implemented)
                    count += 1
            self.assertGreater(count, 40)
            self.assertTrue(gateway.running())
        finally:
            gateway.close()
            scratch.remove()

    def test_every_command_that_is_not_available_says_so_and_none_pretends(self):
        scratch = g.Scratch()
        gateway = g.Gateway(scratch)
        try:
            self.assertEqual(scratch.send("ROBACT PUMA_762").returncode, 0)
            for command in ("EFFECTS PULSE ON", "VV_RELOAD_LUTS", "eladyn_calc on", "TF_LOAD r3demo mantec_R3"):
                done = scratch.send(command)
                self.assertEqual(done.returncode, 1, command)
                self.assertIn("not available yet", done.stderr)
        finally:
            gateway.close()
            scratch.remove()

    def test_the_manuals_script_runs_and_refuses_only_what_is_not_there_yet(self):
        scratch = g.Scratch()
        gateway = g.Gateway(scratch)
        try:
            self.assertEqual(scratch.send("EXEC_SCRIPT trsys_demo.spt").returncode, 0)
            g.eventually(lambda: scratch.status()["script"]["running"] == 0)
            errors = [error for error in scratch.status()["script"]["last_errors"] if "trsys_demo" in error]
            for error in errors:
                self.assertIn("not available yet", error)
            # TF_LOAD twice, TF_RUN; the rest of the script is done.
            self.assertEqual(len(errors), 3, errors)
        finally:
            gateway.close()
            scratch.remove()


if __name__ == "__main__":
    g.main()

"""All examples of the manual in one SCRIPT file, in its order: done, but for those that others exclude, and the
reference page says which."""

import pathlib
import re
import shutil
import unittest

import gateway as g

EXAMPLES = pathlib.Path(__file__).parent / "manual_examples" / "manual_examples.spt"
# A teach file for TF_LOAD under ROBOT_LANGUAGE jet_tarm.
TEACH_FILE = "JET_TARM 1\nNAME r3demo\nJOINTS 6\nSPEED 50\nPOINT THERE J1=5 J2=0 J3=5 J4=0 J5=0 J6=0\nEND\n"
# The example, and the reason for which it is refused.
REFUSED = {
    "LEVEL_DOWN": "is shown in full detail already",
    "TF_RUN r3demo2": "no program is loaded for mantec_R3a",
    "TF_RUN hs1": "no program is loaded for ZELLENKRAN",
    "TF_RUN hs2": "no program is loaded for ZELLENKRAN",
    "TF_RUN hs3": "no program is loaded for ZELLENKRAN",
    "TF_DELETE": "no program is loaded for MANTEC_RM3",
    "rob_jnt_min_vel": "3 values given",
    "rob_jnt_act_vel": "3 values given",
}
# It contradicts the ranges, whether it is refused or the range wins.
CONTRADICTION = "rob_jnt_start_pos"


def commands_at_lines(text):
    """The first line of each command, and its words."""
    line = 1
    commands = {}
    for piece in re.split(r"(?<=;)", "".join(
            "\n" if one.startswith(("#", "RBv01r01")) else one for one in text.splitlines(keepends=True))):
        begin = line + piece[:len(piece) - len(piece.lstrip())].count("\n")
        if piece.strip():
            commands[begin] = " ".join(piece.strip(" \n;").split())
        line += piece.count("\n")
    return commands


class ManualScript(unittest.TestCase):
    def test_every_example_in_the_order_of_the_manual(self):
        scratch = g.Scratch()
        shutil.copy(EXAMPLES, scratch.home / "scripts")
        (scratch.home / "programs" / "r3demo.tarm").write_text(TEACH_FILE)
        gateway = g.Gateway(scratch)
        try:
            self.assertEqual(scratch.send(f"EXEC_SCRIPT {EXAMPLES.name}").returncode, 0)
            self.assertTrue(g.eventually(lambda: scratch.status()["script"]["running"] == 0, 120))
            script = scratch.status()["script"]
            commands = commands_at_lines(EXAMPLES.read_text())
            refused = {}
            for error in script["last_errors"]:
                place = re.search(rf"{EXAMPLES.name}:(\d+):\d+: error: (.*)", error)
                if place:
                    refused[commands[int(place[1])]] = place[2]
            for example, why in REFUSED.items():
                found = [reason for command, reason in refused.items() if command.startswith(example)]
                self.assertEqual(len(found), 1, (example, refused))
                self.assertIn(why, found[0], example)
            others = [command for command in refused if not command.startswith((*REFUSED, CONTRADICTION))]
            self.assertEqual(others, [], refused)
            # Everything was executed: these, EXEC_SCRIPT of this file, and what trs_demo.spt holds.
            self.assertGreaterEqual(script["done"], len(commands) - len(refused))
            self.assertTrue(gateway.running())
        finally:
            gateway.close()
            scratch.remove()

    def test_the_reference_page_says_which_examples_exclude_each_other(self):
        page = (g.SOURCE / "docs" / "script-reference.md").read_text()
        entries = re.split(r"\n```\n(?=[A-Za-z])", page)
        names = {*(example.split()[0] for example in REFUSED), CONTRADICTION, "TF_LOAD"}
        for name in sorted(names):
            entry = next((one for one in entries if one.startswith(name + " ")), "")
            self.assertRegex(entry, r"(?m)^Example: `[^`]+` \(.+\)$", name)
        self.assertEqual(len(re.findall(r"(?m)^Example: `[^`]+` \(", page)), len(names))


if __name__ == "__main__":
    g.main()

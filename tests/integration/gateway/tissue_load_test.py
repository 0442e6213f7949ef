"""Outputs of the force of soft tissue on an instrument that SCRIPT moves, in a cell without haptic devices."""

import ctypes
import json
import math
import re
import unittest

import gateway as g
from shared_memory import Segment, unused_key

ROBOT = "LAP_RIGHT"


def norm(values):
    return math.sqrt(sum(value * value for value in values))


class TissueLoad(unittest.TestCase):
    def setUp(self):
        self.scratch = g.Scratch("trainer", startup=True)
        self.addCleanup(self.scratch.remove)
        text, devices = re.subn(r"(?ms)^\[\[haptic\]\]$.*?(?=^\[|\Z)", "", self.scratch.cell_file.read_text())
        self.assertEqual(devices, 2)
        self.scratch.cell_file.write_text(re.sub(r"(?ms)^\[foot_switches\]$.*?(?=^\[|\Z)", "", text))
        self.gateway = g.Gateway(self.scratch)
        self.addCleanup(self.gateway.close)

    def done(self, command):
        answer = self.scratch.send(command)
        self.assertEqual(answer.returncode, 0, f"{command}: {answer.stderr}")

    def felt(self):
        """Returns the force on the instrument, in N, from the tissue section of the status."""
        instruments = self.scratch.status()["tissue"]["instruments"]
        return next((norm(one["force_n"]) for one in instruments if one["robot"] == ROBOT), 0.0)

    def push_into_the_liver(self):
        """Moves the instrument forward until the liver resists."""
        for _ in range(40):
            if g.eventually(lambda: self.felt() > 0.6, 0.5):
                return
            self.done(f"POS_ROB {ROBOT} JOINT_INC 0 0 3")
        self.fail(self.scratch.status()["tissue"]["instruments"])

    def test_every_output_of_forces_has_the_force_of_tissue(self):
        scratch, done, felt = self.scratch, self.done, self.felt
        key = unused_key()

        for command in (f"ROBACT {ROBOT}", "SET_TORQUE_LIMIT 0.3 0", f"rob_ela_shm 0 {key} 32", f"ROBOT {ROBOT} send_on"):
            done(command)
        plain = Segment(key)
        self.addCleanup(plain.close)

        def plain_values():
            return [plain.cell(ctypes.c_float, 4 * i).value for i in range(8)]

        free = plain_values()
        self.assertLess(norm(free[:3]), 0.1)
        self.assertFalse(scratch.status()["haptics"]["tcp_force"]["beyond_limit"])
        self.push_into_the_liver()
        self.assertTrue(g.eventually(lambda: felt() > 0.5), scratch.status()["tissue"]["instruments"])

        def told():
            status = scratch.status()
            tcp = status["haptics"]["tcp_force"]
            robot = next(one for one in status["forces"]["robots"] if one["id"] == ROBOT)
            return {"felt": felt(), "plain": norm(plain_values()[:3]), "1313": norm(tcp["force_n"]), "valid": tcp["valid"],
                    "beyond": tcp["beyond_limit"], "times": tcp["times_beyond"], "wrench": norm(robot["tcp"]["force_n"])}

        def agree():
            now = told()
            near = all(abs(now[one] - now["felt"]) < 0.25 * now["felt"] for one in ("plain", "1313", "wrench"))
            return near and now["valid"] and now["beyond"] and now["times"] > 0

        self.assertTrue(g.eventually(agree), told())
        # The third joint slides along the shaft: the tissue pushes back against it.
        self.assertGreater(abs(plain_values()[5] - free[5]), 0.2, plain_values())

    def test_tissue_events_are_in_the_log_and_in_recordings(self):
        file = self.scratch.root / "events.mcap"
        recorder = g.Process([g.BIN / "cellmirror", "record", "-o", file, "--instance", self.scratch.instance], self.scratch.environment)
        self.addCleanup(recorder.close)
        self.assertTrue(g.eventually(lambda: any(one["messages"] for one in self.scratch.status()["recordings"])), recorder.output())
        self.done(f"ROBACT {ROBOT}")
        self.done(f"POS_ROB {ROBOT} JOINT_INC 0 0 0 0 25")
        self.push_into_the_liver()
        counts = lambda: self.scratch.status()["tissue"]["events"]["counts"]
        self.done(f"POS_ROB {ROBOT} JOINT_INC 0 0 0 0 -25")
        self.assertTrue(g.eventually(lambda: counts()["grip"] > 0), self.scratch.status()["tissue"])
        self.done(f"POS_ROB {ROBOT} JOINT_INC 0 0 -4")
        self.done(f"POS_ROB {ROBOT} JOINT_INC 0 0 0 0 25")
        self.assertTrue(g.eventually(lambda: counts()["release"] > 0), self.scratch.status()["tissue"])
        self.assertTrue(g.eventually(lambda: f"{ROBOT} releases liver" in self.gateway.output()), self.gateway.output())
        self.assertIn("[tissue.grip]", self.gateway.output())
        self.assertEqual(recorder.stop(), 0, recorder.output())
        exported = self.scratch.cellmirror("recording", "export", str(file), "--topic", "/cellmirror/tissue_events", "--json")
        self.assertEqual(exported.returncode, 0, exported.stderr)
        events = [one["values"] for one in json.loads(exported.stdout)["messages"]]
        self.assertEqual([one["event"] for one in events if one["robot"] == ROBOT][:2], ["grip", "release"], events)
        release = next(one for one in events if one["event"] == "release")
        self.assertGreater(release["value"], 0.01, "the force that the jaws held")
        self.assertIn("releases", release["text"])


if __name__ == "__main__":
    unittest.main()

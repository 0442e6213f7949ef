"""The force of soft tissue on an instrument that SCRIPT moves, in a cell without haptic devices: wherever forces are told."""

import ctypes
import math
import re
import unittest

import gateway as g
from shared_memory import Segment, unused_key

ROBOT = "LAP_RIGHT"


def norm(values):
    return math.sqrt(sum(value * value for value in values))


class TissueLoad(unittest.TestCase):
    def test_it_is_told_whoever_moves_the_instrument(self):
        scratch = g.Scratch("trainer", startup=True)
        self.addCleanup(scratch.remove)
        text = scratch.cell_file.read_text()
        text, devices = re.subn(r"(?ms)^\[\[haptic\]\]$.*?(?=^\[|\Z)", "", text)
        self.assertEqual(devices, 2)
        scratch.cell_file.write_text(re.sub(r"(?ms)^\[foot_switches\]$.*?(?=^\[|\Z)", "", text))
        gateway = g.Gateway(scratch)
        self.addCleanup(gateway.close)
        key = unused_key()

        def done(command):
            answer = scratch.send(command)
            self.assertEqual(answer.returncode, 0, f"{command}: {answer.stderr}")
            return answer.stdout

        for command in (f"ROBACT {ROBOT}", "SET_TORQUE_LIMIT 0.3 0", f"rob_ela_shm 0 {key} 32", f"ROBOT {ROBOT} send_on"):
            done(command)
        plain = Segment(key)
        self.addCleanup(plain.close)

        def plain_values():
            return [plain.cell(ctypes.c_float, 4 * i).value for i in range(8)]

        def felt():
            instruments = scratch.status()["tissue"]["instruments"]
            return next((norm(one["force_n"]) for one in instruments if one["robot"] == ROBOT), 0.0)

        free = plain_values()
        self.assertLess(norm(free[:3]), 0.1)
        self.assertFalse(scratch.status()["haptics"]["tcp_force"]["beyond_limit"])
        # Forward, until the liver holds against it.
        for _ in range(40):
            if g.eventually(lambda: felt() > 0.6, 0.5):
                break
            done(f"POS_ROB {ROBOT} JOINT_INC 0 0 3")
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


if __name__ == "__main__":
    unittest.main()

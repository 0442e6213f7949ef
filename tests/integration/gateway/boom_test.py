"""The classes EDITH and BOOM_3 .. BOOM_6 of rob_inverse_class on a redundant boom: the same pose of its tip, in postures
that differ."""

import math
import pathlib
import shutil
import unittest

import gateway as g

CELL = pathlib.Path(__file__).resolve().parent / "boom_cell"
CLASSES = ("BOOM_3", "BOOM_4", "BOOM_5", "BOOM_6", "EDITH")
START = (200, 57, -52, 46, -40, 34, -29, 23)  # mm, degrees: bent
TARGET = (2400, 1500, 1300)  # mm
HEADING = 23  # degrees


class Boom(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = g.Scratch()
        shutil.rmtree(cls.scratch.home)
        shutil.copytree(CELL, cls.scratch.home)
        cls.gateway = g.Gateway(cls.scratch)

    @classmethod
    def tearDownClass(cls):
        status = cls.gateway.stop()
        cls.gateway.close()
        cls.scratch.remove()
        assert status == 0, f"the gateway ended with {status}"

    def done(self, command):
        done = self.scratch.send(command, timeout=60)
        self.assertEqual(done.returncode, 0, f"{command}: {done.stderr}")

    def posture_for(self, inverse_class):
        """Of the turning joints, in degrees."""
        self.done("POS_ROB EDITH JOINT_ABS " + " ".join(map(str, START)))
        self.done(f"rob_inverse_class {inverse_class}")
        self.done("POS_ROB EDITH FRAME_ABS " + " ".join(map(str, (*TARGET, 0, 0, HEADING))))
        robot = self.scratch.robot("EDITH")
        tcp = robot["tcp"]
        for found, wanted in zip(tcp["position_m"], TARGET, strict=True):
            self.assertAlmostEqual(found, wanted / 1000, 3, inverse_class)
        x, y, z, w = tcp["quaternion_xyzw"]
        self.assertAlmostEqual(math.degrees(2 * math.atan2(z, w)), HEADING, 1, inverse_class)
        return [math.degrees(joint["position"]) for joint in robot["joints"][1:]]

    def test_each_class_resolves_the_redundancy_in_its_own_way(self):
        self.done("ROBACT EDITH")
        self.done("rob_positioning jump")
        postures = {name: self.posture_for(name) for name in CLASSES}
        for a in CLASSES:
            for b in CLASSES[:CLASSES.index(a)]:
                difference = max(abs(p - q) for p, q in zip(postures[a], postures[b], strict=True))
                self.assertGreater(difference, 2.0, f"{a} and {b}: {postures}")
        # The last n joints bend evenly, those before them stay near the start: smallest in the posture of the class.
        for name, bent in zip(CLASSES, (3, 4, 5, 6, 7), strict=True):
            wished = [*START[1:8 - bent], *[0] * bent]
            away = {one: math.dist(postures[one], wished) for one in CLASSES}
            self.assertEqual(min(away, key=away.get), name, away)


if __name__ == "__main__":
    g.main()

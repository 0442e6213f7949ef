"""Forces of the running gateway: what drives give, what an attached tool adds, what arrows show."""

import math
import unittest

import gateway as g

ARM = "MANTEC_R3"
HAND = "Mantec_2.HAND"
G = 9.80665


class Forces(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = g.Scratch()
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

    def forces(self):
        return self.scratch.status()["forces"]

    def robot(self, robot=ARM):
        return next((one for one in self.forces()["robots"] if one["id"] == robot), None)

    @staticmethod
    def at_rest(robot):
        """Accelerations are smoothed: they fade after the motion, and with them the forces (116.8 kg times 1e-6)."""
        return all(abs(joint["acceleration_rad_s2"]) < 1e-6 for joint in robot["joints"])

    def test_holding_still(self):
        self.done(f"POS_ROB {ARM} JOINT_ABS 0 0 90 0 0 0")
        self.assertTrue(g.eventually(lambda: self.robot() and self.at_rest(self.robot())))
        robot = self.robot()
        self.assertAlmostEqual(robot["model_kg"], 116.8, 9)
        # The forearm lies level: elbow, forearm and wrist about axis 3, which turns from up towards -y.
        level = 26.4 * -0.034 + 28.7 * 0.32 + 5.2 * (0.73 + 0.023)
        self.assertAlmostEqual(robot["joints"][2]["effort_nm"], -level * G, 3)
        self.assertIsNone(robot["tcp"])
        # The base bears it all.
        self.assertAlmostEqual(robot["joints"][0]["force_n"][2], 116.8 * G, 3)
        before = robot["joints"][2]["effort_nm"]

        self.done(f"FRAME_TO_WFRM Toolbox.Tool1 TO {HAND} Tool1_WFRM")
        self.assertTrue(g.eventually(lambda: abs(self.robot()["payload_kg"] - 2.2) < 1e-9))
        # 0.73 m to the wrist, 0.12 m to the hand, 0.02 m to the workframe, 0.09 m to the tool's centre.
        self.assertAlmostEqual(self.robot()["joints"][2]["effort_nm"] - before, -2.2 * 0.96 * G, 3)

    def test_arrows(self):
        self.done("SET_FORCE_ARROW 4 0 0")
        self.assertTrue(g.eventually(lambda: self.forces()["arrows"]["shown"]))
        arrows = self.forces()["arrows"]
        self.assertEqual(arrows["joint_forces"], "resultant")
        lengths = [math.hypot(*arrow["force_n"]) for arrow in arrows["shown"]]
        self.assertTrue(any(abs(length - 116.8 * G) < 1e-3 for length in lengths), lengths)
        self.done("SET_FORCE_ARROW 0 0 0")
        self.assertTrue(g.eventually(lambda: not self.forces()["arrows"]["shown"]))

    def test_status(self):
        forces = self.forces()
        self.assertTrue(forces["active"])
        self.assertEqual(forces["gravity_m_s2"], [0.0, 0.0, -G])
        self.assertEqual(forces["not_computed"], [])
        self.assertTrue(g.eventually(lambda: self.forces()["age_s"] is not None and self.forces()["age_s"] < 0.1))
        table = self.scratch.cellmirror("status").stdout
        self.assertIn("\nforces ", table)
        self.assertIn(f"  {ARM} 116.8 kg", table)


if __name__ == "__main__":
    g.main()

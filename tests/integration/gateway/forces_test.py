"""Forces of the running gateway: what drives give, what an attached tool adds, what arrows show."""

import ctypes
import math
import os
import struct
import unittest

import gateway as g
import haptic_device as h

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
        self.assertEqual(robot["tcp"]["force_n"], [0.0, 0.0, 0.0])  # it holds nothing
        # The base bears it all.
        self.assertAlmostEqual(robot["joints"][0]["force_n"][2], 116.8 * G, 3)
        before = robot["joints"][2]["effort_nm"]

        self.done(f"FRAME_TO_WFRM Toolbox.Tool1 TO {HAND} Tool1_WFRM")
        self.assertTrue(g.eventually(lambda: abs(self.robot()["payload_kg"] - 2.2) < 1e-9))
        # 0.73 m to the wrist, 0.12 m to the hand, 0.02 m to the workframe, 0.09 m to the tool's centre.
        self.assertAlmostEqual(self.robot()["joints"][2]["effort_nm"] - before, -2.2 * 0.96 * G, 3)
        self.plain_buffers_of_the_manual()
        self.arrow_of_what_the_hand_holds()

    def floats(self, memory, count):
        return struct.unpack(f"<{count}f", ctypes.string_at(memory._address, 4 * count))

    def plain_buffers_of_the_manual(self):
        """rob_ela_shm as in 1999: float32 from offset 0, of a robot that nothing but commands moves."""
        key = 0x43520000 + os.getpid() % 0x10000
        self.done(f"ROBACT {ARM}")
        sent = self.scratch.send(f"rob_ela_shm 0 {key} 28")
        self.assertEqual(sent.returncode, 0, sent.stderr)
        self.assertIn("4 of 6 joint torques; there is no room for J_5, J_6: 36 bytes hold all", sent.stdout)
        memory = h.attach(key, 24)  # whole words; the page holds the rest
        robot = self.robot()
        expected = [*robot["tcp"]["force_n"], *(joint["effort_nm"] for joint in robot["joints"][:4])]
        self.assertAlmostEqual(math.hypot(*expected[:3]), 2.2 * G, 3)
        self.assertTrue(g.eventually(lambda: self.near(self.floats(memory, 7), expected)),
                        (self.floats(memory, 7), expected))
        status = self.scratch.status()["haptics"]["robot_forces"]
        self.assertEqual([(one["robot"], one["key"], one["bytes"]) for one in status], [(ARM, key, 28)])
        # Another size under the same key is another memory; what was attached keeps zeros.
        sent = self.scratch.send(f"rob_ela_shm 0 {key} 36")
        self.assertEqual((sent.returncode, "no room" in sent.stdout), (0, False), sent.stderr)
        self.assertEqual(self.floats(memory, 7), (0.0,) * 7)
        memory.detach()
        memory = h.attach(key, 32)
        expected += [joint["effort_nm"] for joint in robot["joints"][4:]]
        self.assertTrue(g.eventually(lambda: self.near(self.floats(memory, 9), expected)),
                        (self.floats(memory, 9), expected))
        memory.detach()
        refused = self.scratch.send(f"rob_ela_shm 0 {key} 11")
        self.assertEqual(refused.returncode, 1, refused.stdout)
        self.assertIn("11", refused.stderr)
        self.done("ROBACT MANTEC_RM3")
        refused = self.scratch.send(f"rob_ela_shm 0 {key} 36")
        self.assertEqual(refused.returncode, 1, refused.stdout)
        self.assertIn(f"that of the forces of {ARM}", refused.stderr)

    def near(self, found, expected):
        return all(abs(a - b) < 1e-3 for a, b in zip(found, expected, strict=True))

    def arrow_of_what_the_hand_holds(self):
        sent = self.scratch.send("SET_FORCE_ARROW 0 0 4")
        self.assertEqual((sent.returncode, "no arrows" in sent.stdout), (0, False), sent.stderr)
        shown = g.eventually(lambda: self.forces()["arrows"]["shown"])
        self.assertEqual(len(shown), 1, shown)
        self.assertAlmostEqual(shown[0]["force_n"][2], -2.2 * G, 3)
        self.done("SET_FORCE_ARROW 0 0 0")

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
        self.assertTrue(g.eventually(lambda: (lambda age: age is not None and age < 1)(self.forces()["age_s"])), "they are old")
        table = self.scratch.cellmirror("status").stdout
        self.assertIn("\nforces ", table)
        self.assertIn(f"  {ARM} 116.8 kg", table)


class Start(unittest.TestCase):
    def test_the_demo_starts_within_the_limits_of_its_drives(self):
        scratch = g.Scratch(startup=True)
        gateway = g.Gateway(scratch)
        try:
            def arrived():
                script = scratch.status()["script"]
                return script["running"] == 0 and script["done"] > 10

            self.assertTrue(g.eventually(arrived, 60), scratch.status()["script"])
            self.assertEqual(scratch.status()["forces"]["limit_warnings"], 0, gateway.output())
            self.assertNotIn("forces.limit", gateway.output())
        finally:
            gateway.close()
            scratch.remove()


if __name__ == "__main__":
    g.main()

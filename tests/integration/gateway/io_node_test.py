"""I/O nodes ([[io_node]]): a controller reads limit switches and light barriers of the cell, and moves joints by outputs."""

import struct
import unittest

import gateway as g
import master_case
from master_case import drive_master

NODE = 20
PATIENCE = 30


def io_node(channel):
    return f"""
[[node]]
name = "Emitter"
xyz_m = [0.3, 0.2, 0.78]

[[node]]
name = "Receiver"
xyz_m = [0.3, 0.7, 0.78]

[[node]]
name = "Part"
xyz_m = [-0.3, -0.3, 0.1]

[[light_barrier]]
name = "gate"
from = "Emitter"
to = "Receiver"

[[io_node]]
id = {NODE}
channel = "{channel}"
[[io_node.input]]
bit = 0
barrier = "gate"
[[io_node.input]]
bit = 9
robot = "SCARA_1"
joint = "J_1"
above_rad = 0.5
[[io_node.output]]
bit = 0
robot = "TABLE_1"
joint = "TILT"
on_rad = 0.3
off_rad = 0.0
[[io_node.output]]
bit = 1
on = "CONNECT Part TO Table"
off = "CONNECT Part TO Nowhere"
"""


def setUpModule():
    master_case.require()


class IoNode(master_case.MasterCase):
    def cell(self, text, channel):
        return text + io_node(channel)

    def setUp(self):
        super().setUp()
        self.start_gateway()

    def inputs(self):
        return self.master.read(NODE, 0x6000, 1) | self.master.read(NODE, 0x6000, 2) << 8

    def status(self):
        return self.scratch.status()["io_nodes"][0]

    def joint(self, robot, name):
        return next(joint for joint in self.scratch.robot(robot)["joints"] if joint["name"] == name)["position"]

    def test_a_controller_reads_inputs_and_moves_a_joint(self):
        master, send = self.master, self.scratch.send
        self.assertEqual(master.read(NODE, 0x1000), 0x70191)
        self.assertTrue(g.eventually(lambda: self.inputs() == 0, PATIENCE), "the beam is free")

        with self.subTest("inputs come as a PDO when they change"):
            master.nmt(1, NODE)
            self.assertTrue(g.eventually(lambda: self.status()["condition"].endswith(": operational"), PATIENCE))
            # The answer comes on arrival; frames wait in the socket of the master.
            self.assertEqual(send("POS_ROB SCARA_1 JOINT_ABS 57.3;").returncode, 0)
            both = lambda identifier, data: identifier == 0x180 + NODE and struct.unpack("<I", data)[0] == 0x201
            self.assertIsNotNone(master.hear(both, PATIENCE), "both inputs on")
            barrier = self.scratch.status()["ranges"]["light_barriers"][0]
            self.assertTrue(barrier["interrupted"])
            self.assertIn("J_2", barrier["object"])

        with self.subTest("an input is stuck until the fault ends"):
            stuck = lambda on: lambda: (self.inputs() >> 5 & 1) == on
            self.assertEqual(self.scratch.cellmirror("fault", str(NODE), "stuck:bit=5,value=1").returncode, 0)
            self.assertTrue(g.eventually(stuck(1), PATIENCE))
            self.assertIn("stuck", str(self.status()))
            table = self.scratch.cellmirror("status").stdout
            self.assertRegex(table, rf"I/O node {NODE} on udp:.*injected faults stuck")
            self.assertRegex(table, r"gate: interrupted by .*J_2, 1 interruption")
            self.assertEqual(self.scratch.cellmirror("fault", str(NODE), "end").returncode, 0)
            self.assertTrue(g.eventually(stuck(0), PATIENCE))

        with self.subTest("an output moves a joint to one of two positions"):
            master.send(0x200 + NODE, b"\1\0\0\0")
            self.assertTrue(g.eventually(lambda: abs(self.joint("TABLE_1", "TILT") - 0.3) < 1e-6, PATIENCE))
            master.send(0x200 + NODE, b"\0\0\0\0")
            self.assertTrue(g.eventually(lambda: abs(self.joint("TABLE_1", "TILT")) < 1e-6, PATIENCE))

        with self.subTest("an output gives a command; what is refused stands in status"):
            before = self.scratch.status()["script"]["refused"]
            master.write(NODE, 0x6200, 2, 1, 1)
            self.assertTrue(g.eventually(lambda: self.status()["output_changes"] == 3, PATIENCE), self.status())
            self.assertEqual(self.status()["refused"], 0, self.status())
            master.nmt(2, NODE)  # stopped: the outputs take their error values, which are off
            self.assertTrue(g.eventually(lambda: self.status()["refused"] == 1, PATIENCE), self.status())
            self.assertIn("I/O node 20, output 1", self.status()["last_refusal"])
            self.assertIn("Nowhere", self.status()["last_refusal"])
            self.assertEqual(self.scratch.status()["script"]["refused"], before + 1)


if __name__ == "__main__":
    g.main()

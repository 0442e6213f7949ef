"""Drives and I/O nodes of a cell file on one channel: one thread, one recording of the frames, and nodes that hear each other."""

import json
import pathlib
import unittest

import gateway as g
import master_case
from master_case import drive_master

DRIVES, IO_NODE = [1, 2, 3], 20
ARM = """format = 1
[[node]]
name = "J_1"
joint = { type = "revolute", axis = [0, 0, 1], range_rad = [-3, 3], velocity_rad_s = 3.0, acceleration_rad_s2 = 10.0 }
[[node]]
name = "FLANGE"
parent = "J_1"
[robot]
id = "ARM"
flange = "FLANGE"
"""


def cell(channel):
    arms = "".join(f'[[node]]\nname = "N{n}"\nabstract = "arm.mpc"\nrobot_id = "R{n}"\nxyz_m = [{n}.0, 0.0, 0.0]\n' for n in DRIVES)
    devices = "".join(f'[[device]]\nrobot = "R{n}"\nprotocol = "cia402"\nchannel = "{channel}"\n'
                      f'[[device.node]]\nid = {n}\njoint = "J_1"\nencoder_increments = 65536\n' for n in DRIVES)
    return (f'format = 1\nname = "bus"\n{arms}{devices}[[io_node]]\nid = {IO_NODE}\nchannel = "{channel}"\n'
            '[[io_node.input]]\nbit = 1\nrobot = "R1"\njoint = "J_1"\nabove_rad = -1.0\n')


def setUpModule():
    master_case.require()


class SharedBus(master_case.MasterCase):
    def cell(self, _, channel):
        return cell(channel)

    def setUp(self):
        super().setUp()
        (self.scratch.home / "envlib" / "arm.mpc").write_text(ARM)
        self.start_gateway()

    def go_online(self):
        for node in DRIVES:
            self.assertEqual(self.scratch.send(f"ROBOT R{node} online;").returncode, 0)
        self.assertTrue(g.eventually(lambda: all(self.master.read(node, 0x1018, 4) == node for node in [*DRIVES, IO_NODE])))

    def threads(self):
        tasks = pathlib.Path(f"/proc/{self.gateway.child.pid}/task")
        return [(task / "comm").read_text().strip() for task in tasks.iterdir()]

    def test_all_nodes_share_one_thread_and_end_one_by_one(self):
        self.go_online()
        self.assertEqual(self.threads().count("can-nodes"), 1, self.threads())
        self.assertEqual(self.scratch.send("ROBOT R1 offline;").returncode, 0)
        self.assertEqual([self.master.read(node, 0x1018, 4) for node in (2, 3, IO_NODE)], [2, 3, IO_NODE])
        self.master.send(drive_master.SDO_REQUEST + 1, bytes([0x40, 0, 0x10, 0, 0, 0, 0, 0]))
        self.master.send(drive_master.SDO_REQUEST + 2, bytes([0x40, 0, 0x10, 0, 0, 0, 0, 0]))
        heard = []
        self.master.hear(lambda identifier, data: heard.append(identifier) or identifier == drive_master.SDO_ANSWER + 2)
        self.assertNotIn(drive_master.SDO_ANSWER + 1, heard)

    def test_an_input_is_the_controlword_of_a_drive(self):
        self.go_online()
        self.master.write(3, 0x1400, 0x8000_0203, 4, 1)
        self.master.write(3, 0x1400, 0x180 + IO_NODE, 4, 1)
        self.master.nmt(1)
        # Bit 1 of the inputs is on: "disable voltage" is off, the drive stays where it is; the object shows what it took.
        self.assertTrue(g.eventually(lambda: self.master.read(3, 0x6040) == 2), hex(self.master.read(3, 0x6040)))

    def test_a_recording_has_each_frame_once(self):
        self.go_online()
        file = self.scratch.root / "bus.mcap"
        recorder = g.Process([g.BIN / "cellmirror", "record", "-o", file, "--instance", self.scratch.instance],
                             self.scratch.environment)
        self.addCleanup(recorder.close)
        def recorded():
            topics = [topic for one in self.scratch.status()["recordings"] for topic in one["topics"]]
            return {topic["topic"]: topic["messages"] for topic in topics}.get("/inputs/can/R1", 0)

        def is_recorded():
            self.master.send(0x7FF)  # what nobody takes
            return recorded() > 0

        self.assertTrue(g.eventually(is_recorded))
        self.master.nmt(1)
        syncs = 20
        for _ in range(syncs):
            self.master.send(drive_master.SYNC)
            self.assertIsNotNone(self.master.hear(lambda identifier, _: identifier == 0x283))
        self.assertEqual(self.master.read(IO_NODE, 0x1018, 4), IO_NODE)
        # Frames are recorded in their order: with 300 more than now, all of the less than 300 before are in the file.
        before = recorded()
        for _ in range(400):
            self.master.send(0x7FF)
        self.assertTrue(g.eventually(lambda: recorded() > before + 300))
        recorder.stop()
        topics = {one["topic"] for one in json.loads(self.run_recording("info", str(file), "--json"))["topics"]}
        self.assertEqual({topic for topic in topics if topic.startswith("/inputs/can/")}, {"/inputs/can/R1"})
        messages = json.loads(self.run_recording("export", str(file), "--topic", "/inputs/can/R1", "--json"))["messages"]
        frames = [(one["values"]["sent"], one["values"]["frame"].split("#")[0]) for one in messages]
        self.assertEqual(frames.count((False, "080")), syncs)
        for node in DRIVES:
            self.assertEqual(frames.count((True, f"{0x280 + node:03X}")), syncs)
        self.assertIn((True, f"{0x580 + IO_NODE:03X}"), frames)

    def run_recording(self, *arguments):
        done = self.scratch.cellmirror("recording", *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout


if __name__ == "__main__":
    g.main()

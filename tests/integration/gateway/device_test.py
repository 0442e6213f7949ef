"""A robot of the cell as CiA 402 drives ([[device]]), commanded by a master on the bus."""

import math
import struct
import time
import unittest

import gateway as g
import master_case
from master_case import drive_master

NODES = {11: "J_1", 12: "J_2", 13: "J_3", 14: "J_4"}
TURN = 65536 / (2 * math.pi)  # increments a rad of J_1


def device(channel):
    return f"""[[device]]
robot = "SCARA_1"
protocol = "cia402"
channel = "{channel}"
[[device.node]]
id = 11
joint = "J_1"
encoder_increments = 65536
home_switch_rad = [-0.5, -0.4]
[[device.node]]
id = 12
joint = "J_2"
encoder_increments = 65536
sign = -1
offset_rad = 0.25
[[device.node]]
id = 13
joint = "J_3"
encoder_increments = 32768
feed_m = 0.02
[[device.node]]
id = 14
joint = "J_4"
encoder_increments = 4096
gear_motor_turns = 16
"""

# In the way of the second arm where J_1 turns upwards.
POST = """
[[node]]
name = "Post"
xyz_m = [0.41, 0.28, 0.78]
geometry = [{ name = "post", box_m = [0.04, 0.04, 0.2] }]
"""


def setUpModule():
    master_case.require()


class Device(master_case.MasterCase):
    def cell(self, text, channel):
        # In place of the stream of the arm; the table, on an interface that is not there, stays closed.
        start, end = text.index("[[stream]]"), text.index("[[stream]]", text.index("[[stream]]") + 1)
        return text[:start] + device(channel) + text[end:]

    def start(self):
        self.start_gateway()
        self.go_online()

    def go_online(self):
        done = self.scratch.send("ROBOT SCARA_1 online;")
        self.assertEqual(done.returncode, 0, done.stderr)
        boots = self.master.hear_all({drive_master.HEARTBEAT + node for node in NODES})
        self.assertEqual(set(boots.values()), {b"\0"}, boots)

    def joint(self, number):
        return self.scratch.robot("SCARA_1")["joints"][number]

    def test_check_knows_the_table_and_tells_its_errors(self):
        done = self.scratch.cellmirror("check", str(self.scratch.cell_file))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        text = self.scratch.cell_file.read_text()
        self.scratch.cell_file.write_text(text.replace("feed_m = 0.02", "feed = 0.02").replace("id = 14", "id = 13"))
        done = self.scratch.cellmirror("check", str(self.scratch.cell_file))
        self.assertEqual(done.returncode, 1)
        self.assertIn("two nodes have the id 13", done.stdout + done.stderr)
        self.assertIn("feed_m", done.stdout + done.stderr)

    def test_a_master_boots_moves_and_stops_the_robot(self):
        self.start()
        master = self.master
        self.assertEqual(master.read(11, 0x1000) & 0xFFFF, 402)
        with self.assertRaisesRegex(drive_master.Abort, "0x06010002"):
            master.write(11, 0x6041, 0, 2)

        with self.subTest("profile position moves the robot of the cell"):
            master.nmt(1)
            master.write(11, 0x6060, 1, 1)
            self.assertEqual(master.enable(11), "enabled")
            master.write(11, 0x6081, round(3 * TURN), 4)
            master.write(11, 0x607A, round(0.5 * TURN), 4)
            master.write(11, 0x6040, 0x1F, 2)
            self.assertTrue(master.wait_bit(11, 12), "the set-point is acknowledged")
            master.write(11, 0x6040, 0x0F, 2)
            self.assertTrue(master.wait_bit(11, 10), "the target is reached")
            self.assertTrue(g.eventually(lambda: abs(self.joint(0)["position"] - 0.5) < 0.002), self.joint(0))
            self.assertEqual(self.joint(0)["state"], "fresh")

        with self.subTest("homing at a switch of the cell file"):
            master.write(11, 0x6098, 24, 1)
            master.write(11, 0x6099, round(2 * TURN), 4, 1)
            master.write(11, 0x6099, round(0.2 * TURN), 4, 2)
            master.write(11, 0x6060, 6, 1)
            master.write(11, 0x6040, 0x1F, 2)
            # Method 24 looks upwards first, and turns at a limit switch, which this drive has not: it stands at the stop.
            self.assertTrue(g.eventually(lambda: master.state(11) == "fault"), "motor blocked")
            self.assertEqual(master.read(11, 0x603F), 0x7121)
            master.write(11, 0x6040, 0x80, 2)
            master.write(11, 0x6040, 0x00, 2)
            master.write(11, 0x6098, 27, 1)  # downwards first
            self.assertEqual(master.enable(11), "enabled")
            master.write(11, 0x6040, 0x1F, 2)
            self.assertTrue(master.wait_bit(11, 12), "homing attained")
            self.assertTrue(master.wait_bit(11, 10))
            here = master.read(11, 0x6064, signed=True) / TURN
            self.assertTrue(g.eventually(lambda: abs(self.joint(0)["position"] - here + 0.4) < 0.002), (self.joint(0), here))
            master.write(11, 0x6040, 0x0F, 2)

        with self.subTest("cyclic synchronous position of all drives, with SYNC"):
            for node in NODES:
                master.write(node, 0x60C2, 4, 1, 1)  # 4 ms
                master.write(node, 0x6065, 0xFFFFFFFF, 4)  # no fault where this machine is late
                master.write(node, 0x6060, 8, 1)
                self.assertEqual(master.enable(node), "enabled")
            starts = {node: master.read(node, 0x6064, signed=True) for node in NODES}
            for i in range(1, 101):
                for node in NODES:
                    master.send(0x300 + node, struct.pack("<Hi", 0x0F, starts[node] + 20 * i))
                master.send(drive_master.SYNC)
                answers = master.hear_all({0x280 + node for node in NODES})
                self.assertEqual(len(answers), len(NODES), f"SYNC {i}: {answers}")
                time.sleep(0.004)  # not faster than the drives interpolate; slower makes no difference
            for node in NODES:
                left = lambda node=node: master.read(node, 0x6064, signed=True) - starts[node] - 2000
                self.assertTrue(g.eventually(lambda left=left: abs(left()) <= 2), f"node {node}: {left()} from its target")

        with self.subTest("quick stop, and the state in status"):
            master.write(12, 0x6040, 0x02, 2)
            self.assertTrue(g.eventually(lambda: master.state(12) == "switch on disabled"))
            stream = lambda: self.scratch.robot("SCARA_1")["stream"]
            self.assertTrue(g.eventually(lambda: "4 operational, 3 enabled" in stream()["condition"]), stream())
            self.assertEqual(stream()["kind"], "cia402-device")
            self.assertIn("node 11 (J_1)", str(stream()))

        with self.subTest("offline is silence; online again it is where it was"):
            before = self.joint(0)["position"]
            self.assertEqual(self.scratch.send("ROBOT SCARA_1 offline;").returncode, 0)
            master.send(drive_master.SDO_REQUEST + 11, struct.pack("<BHBxxxx", 0x40, 0x1000, 0))
            self.assertIsNone(master.hear(lambda identifier, data: identifier == drive_master.SDO_ANSWER + 11, 0.3))
            self.go_online()
            self.assertTrue(g.eventually(lambda: abs(self.joint(0)["position"] - before) < 0.001))

    def fault(self, *arguments):
        return self.scratch.cellmirror("fault", *map(str, arguments))

    def test_injected_faults_are_seen_by_the_master(self):
        done = self.fault(11, "death")
        self.assertEqual(done.returncode, 1)
        self.start()
        master = self.master
        details = lambda: str(self.scratch.robot("SCARA_1")["stream"])

        with self.subTest("an error"):
            self.assertEqual(self.fault(11, "emergency:code=0x2310").returncode, 0)
            emcy = master.hear(lambda identifier, data: identifier == 0x8B, 30)
            self.assertEqual(struct.unpack_from("<HB", emcy), (0x2310, 0x03))
            self.assertEqual(master.state(11), "fault")

        with self.subTest("no heartbeat, until it ends"):
            master.write(12, 0x1017, 20, 2)
            heartbeat = lambda identifier, data: identifier == drive_master.HEARTBEAT + 12
            self.assertIsNotNone(master.hear(heartbeat, 30))
            self.assertEqual(self.fault(12, "loss:only=heartbeat").returncode, 0)
            self.assertTrue(g.eventually(lambda: "injected: loss" in details(), 30), details())
            # Those that were under way wait in the socket of the master.
            self.assertTrue(g.eventually(lambda: master.hear(heartbeat, 0.5) is None, 30))
            self.assertEqual(self.fault(12, "end").returncode, 0)
            self.assertIsNotNone(master.hear(heartbeat, 30))

        with self.subTest("no power, then it boots"):
            self.assertEqual(self.fault(13, "death", "--for", 0.5).returncode, 0)
            boot = master.hear(lambda identifier, data: identifier == drive_master.HEARTBEAT + 13, 30)
            self.assertEqual(boot, b"\0")

        with self.subTest("what is wrong is refused with the reason"):
            for arguments, reason in (((11, "deth"), "known: death"), ((99, "death"), "no node 99 answers"),
                                      ((11, "stuck:bit=0,value=1"), "is a drive"), ((11, "death", "--channel", "socketcan:x"), "no node 11")):
                done = self.fault(*arguments)
                self.assertEqual(done.returncode, 1, arguments)
                self.assertIn(reason, done.stderr)

    def test_a_contact_blocks_the_drive_until_it_is_driven_out(self):
        with self.scratch.cell_file.open("a") as cell:
            cell.write(POST)
        self.start()
        master = self.master
        master.nmt(1, 11)
        master.write(11, 0x6060, 3, 1)
        self.assertEqual(master.enable(11), "enabled")
        master.write(11, 0x60FF, round(1.0 * TURN), 4)
        emcy = master.hear(lambda identifier, data: identifier == 0x8B, 30)
        self.assertIsNotNone(emcy, "EMCY")
        self.assertEqual(struct.unpack_from("<HB", emcy), (0x7121, 0x21))
        self.assertTrue(g.eventually(lambda: master.state(11) == "fault", 30))
        blocked_at = master.read(11, 0x6064, signed=True) / TURN
        self.assertLess(blocked_at, 0.9)

        def touching():
            return {name for pair in self.scratch.status()["collisions"]["touching"] for name in (pair["a"], pair["b"])}

        self.assertTrue(g.eventually(lambda: "Post" in touching(), 30))
        errors = self.scratch.robot("SCARA_1")["stream"]["last_errors"]
        self.assertRegex(str(errors), r"drive 11 \(J_1\): 0x7121 motor blocked, [0-9.]+ ms after the robot touched")
        print(errors[-1])

        with self.subTest("the master drives out"):
            master.write(11, 0x60FF, -round(1.0 * TURN) & 0xFFFFFFFF, 4)
            master.write(11, 0x6040, 0x80, 2)
            master.write(11, 0x6040, 0x00, 2)
            self.assertEqual(master.enable(11), "enabled")
            self.assertTrue(g.eventually(lambda: self.joint(0)["position"] < blocked_at - 0.3, 30), self.joint(0))
            self.assertEqual(master.state(11), "enabled")
            self.assertTrue(g.eventually(lambda: "Post" not in touching(), 30))


if __name__ == "__main__":
    g.main()

"""Robots of the cell follow simulated controllers over real protocols; every fault is seen, counted and recovered from."""

import socket
import struct
import time
import unittest

import gateway as g

CAN_ROBOT = "MANTEC_R3"  # CiA 402 over udp multicast in the transfer cell
DDS_ROBOT = "PUMA_762"   # JointState in the transfer cell
PUMA_JOINTS = ",".join(f"puma_762_joint_{i}" for i in range(1, 7))


class Mirroring(unittest.TestCase):
    def setUp(self):
        self.scratch = g.Scratch()
        self.gateway = g.Gateway(self.scratch)
        self.simulators = []

    def tearDown(self):
        for simulator in self.simulators:
            simulator.close()
        status = self.gateway.stop()
        self.gateway.close()
        self.scratch.remove()
        self.assertEqual(status, 0)

    def simulate(self, *arguments):
        simulator = g.sim_robot(*arguments)
        self.simulators.append(simulator)
        return simulator

    def can(self, *more):
        return self.simulate("cia402", "--channel", "udp:239.74.163.2:43113", "--nodes", "1-6", "--rate", "100",
                             "--motion", "sine:amplitude=0.3,period=2", *more)

    def dds(self, *more):
        return self.simulate("dds", "--joint-names", PUMA_JOINTS, "--rate", "100",
                             "--motion", "sine:amplitude=0.3,period=2", *more)

    def online(self, robot):
        done = self.scratch.send(f"ROBOT {robot} online")
        self.assertEqual(done.returncode, 0, done.stderr)

    def wait_state(self, robot, state, timeout=g.PATIENCE_S):
        seen = g.eventually(lambda: self.scratch.robot(robot)["stream"]["state"] == state, timeout)
        self.assertTrue(seen, f"{robot} never became {state}: {self.scratch.robot(robot)['stream']}")

    def moves(self, robot):
        first = [j["position"] for j in self.scratch.robot(robot)["joints"]]
        return g.eventually(
            lambda: any(abs(a - j["position"]) > 0.01 for a, j in zip(first, self.scratch.robot(robot)["joints"])))

    def test_a_program_waits_for_streams_by_exit_status(self):
        def waits(*more):
            return self.scratch.cellmirror("status", "--wait", "fresh", *more)
        self.dds()
        done = waits("--timeout", "0.3")
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("not fresh after 0.3 s: no robot is online", done.stderr)
        self.online(DDS_ROBOT)
        done = waits("--robot", DDS_ROBOT)
        self.assertEqual((done.returncode, done.stdout), (0, f"fresh: {DDS_ROBOT}\n"), done.stderr)
        self.online(CAN_ROBOT)  # nobody sends
        done = waits("--timeout", "0.3")
        self.assertEqual(done.returncode, 1)
        self.assertIn(f"{CAN_ROBOT} is ", done.stderr)
        self.assertNotIn(DDS_ROBOT, done.stderr)

    def test_robots_of_both_buses_are_mirrored_at_once(self):
        self.can()
        self.dds()
        for robot in (CAN_ROBOT, DDS_ROBOT):
            self.online(robot)
        for robot in (CAN_ROBOT, DDS_ROBOT):
            self.wait_state(robot, "fresh")
            self.assertTrue(self.moves(robot), robot)
            state = self.scratch.robot(robot)
            self.assertEqual(state["mode"], "mirrored")
            self.assertTrue(g.eventually(lambda: self.scratch.robot(robot)["stream"]["rate_hz"] > 20))
            self.assertEqual(state["stream"]["rejected"], 0, state["stream"])

    def test_robot_without_a_sender_is_told_as_such(self):
        self.online(DDS_ROBOT)
        state = self.scratch.robot(DDS_ROBOT)
        self.assertEqual(state["stream"]["state"], "none")
        self.assertIn("no publisher", state["stream"]["condition"])

    def check_death_and_return(self, robot, start):
        simulator = start()
        self.online(robot)
        self.wait_state(robot, "fresh")
        simulator.kill()
        self.wait_state(robot, "lost")
        start()
        self.wait_state(robot, "fresh")
        self.assertTrue(self.moves(robot))

    def test_dead_can_robot_is_lost_and_comes_back_by_itself(self):
        self.check_death_and_return(CAN_ROBOT, self.can)

    def test_dead_dds_robot_is_lost_and_comes_back_by_itself(self):
        self.check_death_and_return(DDS_ROBOT, self.dds)

    def test_gateway_started_before_the_robot_finds_it(self):
        self.online(CAN_ROBOT)
        time.sleep(0.3)
        self.can()
        self.wait_state(CAN_ROBOT, "fresh")

    def test_robot_taken_offline_stays_where_it_was_and_obeys_commands_again(self):
        self.dds()
        self.online(DDS_ROBOT)
        self.wait_state(DDS_ROBOT, "fresh")
        refused = self.scratch.send(f"POS_ROB {DDS_ROBOT} JOINT_INC 1")
        self.assertEqual(refused.returncode, 1)
        self.assertIn("offline", refused.stderr)
        self.assertEqual(self.scratch.send(f"ROBOT {DDS_ROBOT} offline").returncode, 0)
        positions = lambda: [j["position"] for j in self.scratch.robot(DDS_ROBOT)["joints"]]

        def stands():  # the samples go on moving
            first = positions()
            time.sleep(0.3)
            return first == positions()

        self.assertTrue(g.eventually(stands), "it follows the samples still")
        second = positions()
        self.assertEqual(self.scratch.send(f"POS_ROB {DDS_ROBOT} JOINT_INC 1").returncode, 0)
        moved = g.eventually(lambda: abs(self.scratch.robot(DDS_ROBOT)["joints"][0]["position"] - second[0] - 0.0174533) < 1e-5)
        self.assertTrue(moved)

    def test_robot_that_stands_still_but_sends_is_fresh(self):
        self.simulate("dds", "--joint-names", PUMA_JOINTS, "--rate", "100", "--motion", "hold")
        self.online(DDS_ROBOT)
        self.wait_state(DDS_ROBOT, "fresh")
        before = self.scratch.robot(DDS_ROBOT)["stream"]["received"]
        self.assertTrue(g.eventually(lambda: self.scratch.robot(DDS_ROBOT)["stream"]["received"] > before + 100))
        self.wait_state(DDS_ROBOT, "fresh")  # at once, if the machine has not just been late

    def test_values_that_are_no_numbers_are_refused_and_counted(self):
        self.dds("--fault", "nan:p=0.2", "--seed", "3")
        self.online(DDS_ROBOT)
        self.assertTrue(g.eventually(lambda: self.scratch.robot(DDS_ROBOT)["stream"]["rejected"] > 5))
        for joint in self.scratch.robot(DDS_ROBOT)["joints"]:
            self.assertTrue(abs(joint["position"]) < 10)


def address_of_simulators():
    """From which datagrams to the group leave by the loopback interface: not 127.0.0.1 on every machine."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        by = struct.pack("@4s4si", bytes(4), bytes(4), socket.if_nametoindex("lo"))
        probe.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, by)
        probe.connect(("239.74.163.2", 43113))
        return probe.getsockname()[0]


class AllowedSources(unittest.TestCase):
    """allow_from of a udp channel."""

    def stream_with(self, address):
        scratch = g.Scratch()
        self.addCleanup(scratch.remove)
        channel = 'channel = "udp:239.74.163.2:43113"'
        text = scratch.cell_file.read_text()
        self.assertIn(channel, text)
        scratch.cell_file.write_text(text.replace(channel, f'{channel}\nallow_from = ["{address}"]'))
        gateway = g.Gateway(scratch)
        self.addCleanup(gateway.close)
        simulator = g.sim_robot("cia402", "--channel", "udp:239.74.163.2:43113", "--nodes", "1-6", "--rate", "100", "--self-starting")
        self.addCleanup(simulator.close)
        done = scratch.send(f"ROBOT {CAN_ROBOT} online")
        self.assertEqual(done.returncode, 0, done.stderr)
        return lambda: scratch.robot(CAN_ROBOT)["stream"]

    def test_senders_that_are_named_are_taken(self):
        stream = self.stream_with(address_of_simulators())
        self.assertTrue(g.eventually(lambda: stream()["received"] > 100), stream())
        self.assertEqual(stream()["rejected"], 0)

    def test_all_others_are_refused_and_counted(self):
        stream = self.stream_with("127.0.0.9")
        self.assertTrue(g.eventually(lambda: stream()["rejected"] > 300), stream())
        self.assertEqual(stream()["received"], 0)
        self.assertNotEqual(stream()["state"], "fresh")


if __name__ == "__main__":
    g.main()

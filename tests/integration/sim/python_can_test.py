"""sim_robot on CAN as python-can hears it: on the udp channel, or on a SocketCAN interface that $CELLMIRROR_SIM_CAN names.
SYNC by hand makes the tests independent of time: each SYNC asks for one sample of each drive."""

import collections
import os
import pathlib
import struct
import sys
import tempfile
import time
import unittest

import sim_robot_process as process

try:
    import can
except ImportError:
    can = None

# CiA 301, 7.3.3: the predefined connection set.
NMT, SYNC, EMCY, TPDO1, SDO_ANSWER, SDO_REQUEST, HEARTBEAT = 0, 0x80, 0x80, 0x180, 0x580, 0x600, 0x700
INCREMENTS = 1000
INTERFACE = os.environ.get("CELLMIRROR_SIM_CAN")


class Heard(unittest.TestCase):
    def setUp(self):
        if INTERFACE:
            self.endpoint = f"socketcan:{INTERFACE}"
            self.bus = can.Bus(interface="socketcan", channel=INTERFACE)
        else:
            group, port = process.group_of_its_own()
            self.endpoint = f"udp:{group}:{port}"
            self.bus = can.Bus(interface="udp_multicast", channel=group, port=port, fd=True)
        self.robot = None
        self.heard = []

    def tearDown(self):
        if self.robot:
            self.robot.close()
        self.bus.shutdown()

    def start(self, *arguments, nodes="1-2", motion="hold:position=0.5", increments=INCREMENTS):
        self.robot = process.SimRobot("cia402", "--channel", self.endpoint, "--nodes", nodes,
                                      "--increments-per-rad", increments, "--motion", motion, "--json", *arguments)

    def send(self, identifier, data=b""):
        self.bus.send(can.Message(arbitration_id=identifier, data=data, is_extended_id=False))

    def hear(self, wanted, timeout=60.0):
        """The next message for which wanted() holds; all are kept in self.heard."""
        end = time.monotonic() + timeout
        while time.monotonic() < end:
            message = self.bus.recv(0.05)
            if message is None:
                self.assertIsNone(self.robot.child.poll() or None, "sim_robot failed")
                continue
            # The bus hears its own messages too: those with identifiers of a master are ours.
            ours = message.arbitration_id in (NMT, SYNC) or SDO_REQUEST < message.arbitration_id < HEARTBEAT
            if ours and not message.is_error_frame:
                continue
            self.heard.append(message)
            if wanted(message):
                return message
        return None

    def hear_id(self, identifier, timeout=60.0):
        message = self.hear(lambda m: m.arbitration_id == identifier and not m.is_error_frame, timeout)
        self.assertIsNotNone(message, f"no message {identifier:#x}")
        return message

    def start_in_sync(self, *arguments, nodes="1", motion="hold:position=0.5"):
        self.start("--sync", "--self-starting", "--heartbeat", 0, *arguments, nodes=nodes, motion=motion)
        self.hear_id(HEARTBEAT + int(nodes.split("-")[0]))

    def sync(self, expected=1, quiet=0.0):
        """Sends a SYNC; the messages that answer it: `expected` ones, and what else comes within `quiet` seconds."""
        self.heard.clear()
        self.send(SYNC)
        self.hear(lambda m: len(self.heard) >= expected)
        if quiet:
            self.hear(lambda m: False, quiet)
        return list(self.heard)

    def upload(self, node, index, subindex=0):
        """An SDO read by hand: expedited upload (CiA 301, 7.2.4.3.5)."""
        self.send(SDO_REQUEST + node, struct.pack("<BHBxxxx", 0x40, index, subindex))
        answer = self.hear_id(SDO_ANSWER + node)
        command, got_index, got_subindex = struct.unpack_from("<BHB", answer.data)
        self.assertEqual((got_index, got_subindex), (index, subindex))
        self.assertEqual(command & 0xE3, 0x43, f"no expedited upload with size: {answer}")
        size = 4 - (command >> 2 & 3)
        return int.from_bytes(answer.data[4:4 + size], "little", signed=True)


class Protocol(Heard):
    def test_each_node_boots_and_then_sends_heartbeats_of_the_pre_operational_state(self):
        self.start("--heartbeat", 20, nodes="3,7")
        for node in (3, 7):
            states = [m.data[0] for m in self.heard if m.arbitration_id == HEARTBEAT + node]
            while states[-1:] != [0x7F]:
                states.append(self.hear_id(HEARTBEAT + node).data[0])
            self.assertIn(states, ([0, 0x7F], [0x7F]) if node == 7 else ([0, 0x7F],))

    def test_heartbeats_keep_their_period(self):
        self.start("--heartbeat", 20, nodes="1")
        self.hear_id(HEARTBEAT + 1)
        stamps = [self.hear_id(HEARTBEAT + 1).timestamp for _ in range(51)]
        mean = (stamps[-1] - stamps[0]) / 50
        self.assertGreater(mean, 0.018)  # never faster; a busy machine may be slower
        self.assertLess(mean, 0.5)

    def test_sdo_reads_device_type_and_position(self):
        self.start(nodes="5")
        self.hear_id(HEARTBEAT + 5)
        self.assertEqual(self.upload(5, 0x1000) & 0xFFFF, 402)
        self.assertEqual(self.upload(5, 0x6064), 0.5 * INCREMENTS)

    def test_tpdos_begin_with_nmt_start_and_hold_statusword_and_position(self):
        self.start(nodes="1-2", motion="sine:amplitude=0,offset=-0.25")
        self.hear_id(HEARTBEAT + 2)
        self.assertFalse([m for m in self.heard if TPDO1 < m.arbitration_id < TPDO1 + 128])
        self.send(NMT, b"\x01\x00")
        for node in (1, 2):
            message = self.hear_id(TPDO1 + node)
            self.assertEqual(len(message.data), 6)
            self.assertEqual(struct.unpack("<Hi", message.data)[1], -0.25 * INCREMENTS)
        self.assertEqual(self.hear(lambda m: m.arbitration_id == HEARTBEAT + 1 and m.data[0] == 5).data[0], 5)

    def test_samples_follow_the_motion_in_time(self):
        self.start("--self-starting", "--rate", 100, nodes="1", motion="ramp:velocity=1", increments=1_000_000)
        heard = [self.hear_id(TPDO1 + 1) for _ in range(101)]
        positions = [struct.unpack("<Hi", message.data)[1] for message in heard]
        # At 1 rad/s and 1e6 increments a rad a position is its time in microseconds. Most are on their way as long as the quickest one.
        delays = sorted(message.timestamp - position / 1e6 for message, position in zip(heard, positions))
        self.assertLess(delays[len(delays) // 2] - delays[0], 0.25)
        self.assertGreater(heard[-1].timestamp - heard[0].timestamp, 0.9)
        self.assertEqual(positions, sorted(positions))

    def test_each_sync_gives_one_sample_of_each_drive(self):
        self.start_in_sync(nodes="1-3")
        self.hear_id(HEARTBEAT + 3)
        for _ in range(5):
            got = [m.arbitration_id for m in self.sync(3)]
            self.assertEqual(sorted(got), [TPDO1 + 1, TPDO1 + 2, TPDO1 + 3])

    def test_the_report_counts_what_was_heard(self):
        self.start("--self-starting", "--for", 1, nodes="1-4")
        counted = collections.Counter()
        while self.robot.child.poll() is None:
            self.hear(lambda m: False, 0.1)
        self.hear(lambda m: False, 0.3)
        for message in self.heard:
            base = message.arbitration_id & 0x780
            kind = {TPDO1: "sample", HEARTBEAT: "heartbeat", EMCY: "emergency"}.get(base, "other")
            counted["boot_up" if kind == "heartbeat" and message.data[0] == 0 else kind] += 1
        status, report, _ = self.robot.finish(None)
        self.assertEqual(status, 0)
        sent = {kind: count for kind, count in report["sent"].items() if count}
        self.assertEqual(sent, dict(counted))
        self.assertEqual(report["refused"], 0)


class Faults(Heard):
    def test_loss_of_each_second_sample(self):
        self.start_in_sync("--fault", "loss:every=2,only=sample")
        for _ in range(6):
            self.send(SYNC)
        self.heard.clear()
        self.hear(lambda m: len(self.heard) == 3)
        self.hear(lambda m: False, 0.2)
        self.assertEqual([m.arbitration_id for m in self.heard], [TPDO1 + 1] * 3)

    def test_repetition(self):
        self.start_in_sync("--fault", "repeat:n=2,only=sample")
        self.assertEqual(len(self.sync(3, quiet=0.2)), 3)

    def test_wrong_id(self):
        self.start_in_sync("--fault", "wrong-id:id=0x1FF,only=sample")
        self.assertEqual(self.sync()[0].arbitration_id, 0x1FF)

    def test_wrong_length(self):
        self.start_in_sync("--fault", "wrong-length:by=-3,only=sample")
        self.assertEqual(len(self.sync()[0].data), 3)

    def test_corruption_is_the_same_for_the_same_seed(self):
        right = struct.pack("<i", int(0.5 * INCREMENTS))
        seen = []
        for _ in range(2):
            self.start_in_sync("--fault", "corrupt:n=4,only=sample", "--seed", 11)
            seen.append([bytes(self.sync()[0].data) for _ in range(4)])
            self.robot.close()
        self.assertEqual(seen[0], seen[1])
        self.assertTrue(any(data[2:] != right for data in seen[0]))

    def test_jump_and_frozen_values(self):
        self.start_in_sync("--fault", "jump:by=0.25,joint=2", nodes="1-2")
        self.hear_id(HEARTBEAT + 2)
        values = {m.arbitration_id: struct.unpack("<Hi", m.data)[1] for m in self.sync(2)}
        self.assertEqual(values, {TPDO1 + 1: 500, TPDO1 + 2: 750})

    def test_frozen_values_go_on_being_sent(self):
        self.start_in_sync("--fault", "frozen", motion="ramp:velocity=100")
        values = {bytes(self.sync()[0].data) for _ in range(5)}
        self.assertEqual(len(values), 1)

    def test_foreign_frames(self):
        self.start_in_sync("--fault", "insert:rate=100,id=0x7AA,count=5")
        for _ in range(5):
            self.hear_id(0x7AA)
        self.hear(lambda m: False, 0.2)
        self.assertEqual(len([m for m in self.heard if m.arbitration_id == 0x7AA]), 5)

    def test_burst(self):
        self.start("--self-starting", "--rate", 100, "--heartbeat", 0, "--fault", "burst:s=0.3,only=sample", nodes="1")
        self.hear_id(HEARTBEAT + 1)
        stamps = [self.hear_id(TPDO1 + 1).timestamp for _ in range(90)]
        gaps = [b - a for a, b in zip(stamps, stamps[1:])]
        self.assertGreaterEqual(len([gap for gap in gaps if gap > 0.1]), 2)
        self.assertLess(len([gap for gap in gaps if gap > 0.1]), 20)  # not each sample alone


class Commands(Heard):
    def setUp(self):
        super().setUp()
        self.folder = tempfile.TemporaryDirectory(prefix="sim_robot_test_")
        self.path = pathlib.Path(self.folder.name) / "control"
        self.control = None

    def tearDown(self):
        if self.control:
            self.control.close()
        super().tearDown()
        self.folder.cleanup()

    def open(self, *arguments, **keywords):
        self.start_in_sync("--control", self.path, *arguments, **keywords)
        self.control = process.ControlSocket(self.path)

    def test_a_dead_drive_is_silent_and_boots_when_it_returns(self):
        self.open(nodes="1-2")
        self.hear_id(HEARTBEAT + 2)
        self.assertRegex(self.control.ask("die joint=2"), "^ok: fault [0-9]+$")
        self.assertEqual([m.arbitration_id for m in self.sync(1, quiet=0.2)], [TPDO1 + 1])
        self.heard.clear()
        self.assertEqual(self.control.ask("return"), "ok: 1 ended")
        self.assertEqual(self.hear_id(HEARTBEAT + 2).data[0], 0)
        self.assertEqual(len(self.sync(2)), 2)

    def test_emergency_and_its_reset(self):
        self.open(nodes="1-2")
        self.assertEqual(self.control.ask("emcy 0x8611 register=0x21 joint=2"), "ok: 1 drives")
        message = self.hear_id(EMCY + 2)
        self.assertEqual(struct.unpack_from("<HB", message.data), (0x8611, 0x21))
        self.assertEqual(self.control.ask("emcy 0 joint=2"), "ok: 1 drives")
        self.assertEqual(struct.unpack_from("<H", self.hear_id(EMCY + 2).data)[0], 0)
        statuswords = {struct.unpack_from("<H", m.data)[0] & 0x6F for m in self.sync(2)}
        self.assertEqual(statuswords, {0x27})  # CiA 402-2: operation enabled

    def test_bus_off_is_an_error_frame_silence_and_a_restart(self):
        self.open()
        self.control.ask("fault bus-off")
        error = self.hear(lambda m: m.is_error_frame)
        self.assertIsNotNone(error)
        self.assertEqual(error.arbitration_id & 0x40, 0x40)  # linux/can/error.h: CAN_ERR_BUSOFF
        self.heard.clear()
        self.send(SYNC)
        self.assertIsNone(self.hear(lambda m: True, 0.3))
        self.control.ask("clear")
        restart = self.hear(lambda m: m.is_error_frame)
        self.assertEqual(restart.arbitration_id & 0x100, 0x100)  # CAN_ERR_RESTARTED
        self.assertEqual(len(self.sync()), 1)

    def test_the_motion_can_be_held(self):
        self.open(motion="ramp:velocity=100")
        self.assertEqual(self.control.ask("hold"), "ok: the motion stops")
        self.assertEqual(len({bytes(self.sync()[0].data) for _ in range(4)}), 1)
        self.assertEqual(self.control.ask("go"), "ok: the motion continues")
        first = bytes(self.sync()[0].data)
        self.assertTrue(process.eventually(lambda: bytes(self.sync()[0].data) != first))

    def test_faults_come_and_go_while_it_runs(self):
        self.open()
        number = self.control.ask("fault jump:by=1").split()[-1]
        self.assertEqual(struct.unpack("<Hi", self.sync()[0].data)[1], 1500)
        self.assertIn('"jump:by=1"', self.control.ask("status"))
        self.assertEqual(self.control.ask(f"clear {number}"), "ok: 1 ended")
        self.assertEqual(struct.unpack("<Hi", self.sync()[0].data)[1], 500)

    def test_wrong_commands_are_refused_with_the_remedy(self):
        self.open()
        self.assertRegex(self.control.ask("fualt loss"), "^error: .*did you mean")
        self.assertRegex(self.control.ask("fault nan"), "^error: .*NaN")
        self.assertRegex(self.control.ask("clear 99"), "^error: there is no fault 99")
        self.assertRegex(self.control.ask("x" * 3000), "^error: a command has at most")
        self.assertEqual(len(self.sync()), 1)

    def test_standard_input_takes_commands_too(self):
        self.start_in_sync()
        self.robot.tell("fault jump:by=1")
        self.assertEqual(self.robot.answer(), "ok: fault 1")
        self.assertEqual(struct.unpack("<Hi", self.sync()[0].data)[1], 1500)
        self.robot.tell("quit")
        self.assertEqual(self.robot.finish(None)[0], 0)

    def test_a_fifo_takes_commands(self):
        os.mkfifo(self.path, 0o600)
        self.start_in_sync("--control", self.path)
        for line, value in (("fault jump:by=1", 1500), ("clear", 500)):
            with open(self.path, "w", encoding="ascii") as fifo:
                fifo.write(line + "\n")
            self.assertTrue(self.robot.answer().startswith("ok: "))
            self.assertEqual(struct.unpack("<Hi", self.sync()[0].data)[1], value)

    def test_a_socket_left_by_a_killed_robot_is_replaced_and_one_in_use_is_not(self):
        self.open()
        self.robot.child.kill()
        self.robot.close()
        self.control.close()
        self.assertTrue(self.path.exists())
        self.open()
        self.assertIn("ok", self.control.ask("clear"))
        second = process.run("cia402", "--channel", self.endpoint, "--control", self.path)
        self.assertEqual(second.returncode, 1)
        self.assertIn("served socket", second.stderr)
        self.assertEqual(self.robot.finish()[0], 0)
        self.assertFalse(self.path.exists())


# Two axes in one message, big and little endian, and one in a multiplexed message; physical unit: degrees.
DBC = """VERSION ""
BU_: ROBOT GATEWAY
BO_ 256 Axes: 8 ROBOT
 SG_ Angle1 : 7|16@0- (0.01,0) [-180|180] "deg" GATEWAY
 SG_ Angle2 : 32|16@1- (0.01,-10) [-180|180] "deg" GATEWAY
BO_ 257 More: 4 ROBOT
 SG_ Page M : 0|8@1+ (1,0) [0|255] "" GATEWAY
 SG_ Angle3 m3 : 8|16@1- (0.01,0) [-180|180] "deg" GATEWAY
 SG_ Speed3 m4 : 8|16@1- (0.1,0) [-3000|3000] "deg/s" GATEWAY
"""


class DbcSignals(Heard):
    def setUp(self):
        super().setUp()
        with tempfile.NamedTemporaryFile("w", suffix=".dbc", delete=False) as file:
            file.write(DBC)
        self.dbc = file.name
        self.addCleanup(os.unlink, self.dbc)

    def start_dbc(self, *arguments):
        self.robot = process.SimRobot("dbc", "--channel", self.endpoint, "--dbc", self.dbc, "--position",
                                      "Axes.Angle1,Axes.Angle2,More.Angle3", "--json", "--rate", 50, *arguments)

    def test_signals_of_both_byte_orders_and_multiplexed_ones(self):
        self.start_dbc("--units-per-rad", 100, "--velocity", "Axes.Angle1,Axes.Angle2,More.Speed3", "--motion",
                       "ramp:velocity=0,offset=-0.5")
        axes = self.hear_id(256).data
        self.assertEqual(len(axes), 8)
        # Angle1 and Angle2 were named for position first, then for velocity, which is 0 and wins.
        self.assertEqual(struct.unpack_from(">h", axes, 0)[0], 0)
        self.assertEqual(struct.unpack_from("<h", axes, 4)[0], 1000)
        pages = {}
        self.assertTrue(self.hear(lambda m: m.arbitration_id == 257 and pages.update({m.data[0]: m.data}) or len(pages) == 2))
        self.assertEqual(struct.unpack_from("<h", pages[3], 1)[0], -5000)
        self.assertEqual(struct.unpack_from("<h", pages[4], 1)[0], 0)

    def test_positions_alone(self):
        self.start_dbc("--units-per-rad", 100, "--motion", "hold:position=0.3")
        axes = self.hear_id(256).data
        self.assertEqual(struct.unpack_from(">h", axes, 0)[0], 3000)
        self.assertEqual(struct.unpack_from("<h", axes, 4)[0], 4000)  # (30 + 10) / 0.01

    def test_signals_that_do_not_exist_are_refused_together(self):
        done = process.run("dbc", "--dbc", self.dbc, "--position", "Axes.Angel1,Nothing.At", "--for", "1", "--channel",
                           self.endpoint)
        self.assertEqual(done.returncode, 1)
        self.assertIn("did you mean Axes.Angle1", done.stderr)
        self.assertIn("Nothing.At", done.stderr)


class CommandLine(unittest.TestCase):
    def test_help_has_examples(self):
        for arguments in (("--help",), ("cia402", "--help"), ("dds", "--help"), ("dbc", "--help")):
            done = process.run(*arguments)
            self.assertEqual(done.returncode, 0)
            self.assertIn("Examples:", done.stdout)

    def test_wrong_usage_ends_with_2_and_says_what_is_wrong(self):
        for arguments, words in (
                ((), "subcommand"), (("cia402", "--rate", "0"), "--rate"), (("cia402", "--nodes", "0"), "1 to 127"),
                (("cia402", "--nodes", "1,1"), "twice"), (("cia402", "--rate", "333"), "whole milliseconds"),
                (("cia402", "--fault", "los", "--fault", "loss:p=9"), "did you mean loss"),
                (("cia402", "--motion", "sinus"), "motions:"), (("cia402", "--robots", "30"), "beyond 127"),
                (("dds", "--fault", "bus-off@1"), "use death")):
            done = process.run(*arguments, "--for", "1") if arguments else process.run()
            self.assertEqual(done.returncode, 1 if "bus-off@1" in arguments else 2, (arguments, done.stderr))
            self.assertIn(words, done.stderr)

    def test_what_does_not_work_ends_with_1(self):
        done = process.run("cia402", "--channel", "socketcan:no_such_bus0", "--for", "1")
        self.assertEqual(done.returncode, 1)
        self.assertIn("sim_robot:", done.stderr)


if __name__ == "__main__":
    if can is None:
        print("skipped: python3-can is not installed")
        sys.exit(77)
    unittest.main(verbosity=2)

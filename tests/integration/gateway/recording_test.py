"""`record` on a running gateway, and `recording` on what it has written: whole files, killed gateways, full disks, exports."""

import csv
import json
import re
import shlex
import struct
import subprocess
import unittest

import gateway as g
import mcap_structure


class RecordingCase(unittest.TestCase):
    def setUp(self):
        self.scratch = g.Scratch()
        self.addCleanup(self.scratch.remove)

    def start(self, *arguments):
        gateway = g.Gateway(self.scratch, *arguments)
        self.addCleanup(gateway.close)
        return gateway

    def loop_goes_on(self, loop):
        """It does not wait for the recording: it would need more than a period for most of its ticks. A busy machine may take the
        processor from it for a second or two, so the periods that it missed are no measure."""
        self.assertLess(loop["compute_us"]["p50"], 500, loop)
        self.assertGreater(loop["ticks"], loop["missed"], loop)

    def record(self, name, *arguments, seconds="1"):
        """A recording of so many seconds; its report."""
        done = self.scratch.cellmirror("record", "-o", str(self.scratch.root / name), "--for", seconds, "--json", "--instance",
                                       self.scratch.instance, *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def begin(self, name, *arguments):
        """A recording in the background."""
        recorder = g.Process([g.BIN / "cellmirror", "record", "-o", self.scratch.root / name, "--instance", self.scratch.instance,
                              *arguments], self.scratch.environment)
        self.addCleanup(recorder.close)
        def began():  # and not one that has ended before
            return any(one["file"] == str(self.scratch.root / name) and one["messages"] > 0 for one in self.recordings())

        self.assertTrue(g.eventually(began), recorder.output())
        return recorder

    def recordings(self):
        return self.scratch.status()["recordings"]

    def recording(self, *arguments, code=0):
        done = self.scratch.cellmirror("recording", *arguments)
        self.assertEqual(done.returncode, code, done.stderr + done.stdout)
        return done

    def info(self, name):
        return json.loads(self.recording("info", str(self.scratch.root / name), "--json").stdout)


class Record(RecordingCase):
    def test_a_recording_is_whole_and_has_everything(self):
        self.start()
        for compression in ("none", "lz4", "zstd"):
            recorder = self.begin(f"{compression}.mcap", "--compression", compression, "--for", "2", "--rate", "50")
            self.assertEqual(self.scratch.send("ROBACT PUMA_762").returncode, 0)
            self.assertEqual(recorder.child.wait(60), 0, recorder.output())
            file = self.scratch.root / f"{compression}.mcap"
            self.assertEqual(file.stat().st_mode & 0o777, 0o600)
            structure = mcap_structure.Recording(file.read_bytes())
            self.assertEqual(structure.profile, "ros2")
            counts = mcap_structure.topics(structure)
            # 100, but for what a busy machine makes the recorder come too late for.
            self.assertGreater(counts["/joint_states"], 10)
            self.assertGreater(counts["/tf"], 10)
            self.assertGreaterEqual(counts["/cellmirror/status"], 1)
            self.assertGreaterEqual(counts["/cellmirror/commands"], 1)
            self.assertIn("/cellmirror/collisions", counts)
            self.assertIn("cell.toml", structure.attachments)
            self.assertEqual(structure.attachments["cell.toml"], self.scratch.cell_file.read_bytes())
            info = self.info(f"{compression}.mcap")
            self.assertEqual({topic["topic"]: topic["messages"] for topic in info["topics"]}, counts)
            self.assertTrue(info["indexed"])
            self.assertTrue(info["cell"]["complete"], info["cell"])
            # A busy machine may make the recorder come too late for a tick; nothing else is left out.
            self.assertEqual(sum(topic["dropped"] for topic in info["topics"] if topic["topic"] != "/joint_states"), 0, info)
            self.assertEqual(info["gateway"]["instance"], self.scratch.instance)
            self.recording("check", str(file))

    def test_messages_are_what_was_published(self):
        self.start()
        self.assertEqual(self.scratch.send("ROBACT PUMA_762").returncode, 0)
        self.record("a.mcap", "--compression", "none")
        structure = mcap_structure.Recording((self.scratch.root / "a.mcap").read_bytes())
        commands = [json.loads(data) for topic, *_, data in structure.messages if topic == "/cellmirror/commands"]
        self.assertEqual(commands, [], "a command from before the recording")
        joints = [message for message in structure.messages if message[0] == "/joint_states"]
        # Numbers count what was left out too, on a busy machine ticks that the recorder came too late for.
        numbers = [message[1] for message in joints]
        self.assertEqual(numbers, sorted(set(numbers)))
        dropped = next(topic["dropped"] for topic in self.info("a.mcap")["topics"] if topic["topic"] == "/joint_states")
        self.assertIn(numbers[-1], range(len(joints), len(joints) + dropped + 1))
        times = [message[3] for message in joints]
        self.assertEqual(times, sorted(set(times)))
        data = joints[0][4]
        self.assertEqual(data[:4], b"\x00\x01\x00\x00")
        sec, nanosec = struct.unpack_from("<iI", data, 4)
        self.assertEqual(sec * 10**9 + nanosec, times[0])
        status = next(json.loads(data) for topic, *_, data in structure.messages if topic == "/cellmirror/status")
        self.assertEqual(status["instance"], self.scratch.instance)

    def test_only_the_topics_that_are_wanted(self):
        self.start()
        self.record("a.mcap", "--topics", "/joint_states,/cellmirror/st*")
        self.assertEqual({topic["topic"] for topic in self.info("a.mcap")["topics"]}, {"/joint_states", "/cellmirror/status"})

    def test_the_suggested_command_repairs_a_joined_recording(self):
        self.start()
        self.record("a.mcap", "--topics", "/joint_states")
        joined = self.scratch.root / "night shift's.mcap"
        joined.write_bytes(2 * (self.scratch.root / "a.mcap").read_bytes())
        once = self.info("a.mcap")["messages"]
        said = self.recording("check", str(joined), code=1)
        self.assertIn("another recording begins here", said.stdout + said.stderr)
        self.assertNotIn("CRC of the summary", said.stdout + said.stderr)
        for text in (said.stderr, self.recording("info", str(joined)).stdout):
            command = re.search(r"cellmirror (recording recover .*)$", text, re.MULTILINE)[1]
            self.recording(*shlex.split(command)[1:])
            repaired = self.scratch.root / "night shift's-repaired.mcap"
            self.recording("check", str(repaired))
            self.assertEqual(self.info(repaired.name)["messages"], 2 * once)
            repaired.unlink()

    def test_ctrl_c_ends_it_and_the_file_is_whole(self):
        self.start()
        recorder = self.begin("a.mcap")
        self.assertEqual(recorder.stop(), 0)
        self.recording("check", str(self.scratch.root / "a.mcap"))
        self.assertTrue(self.recordings()[0]["ended"])

    def test_one_at_a_time_and_never_over_another_file(self):
        self.start()
        (self.scratch.root / "b.mcap").write_bytes(b"mine")
        done = self.scratch.cellmirror("record", "-o", str(self.scratch.root / "b.mcap"), "--instance", self.scratch.instance)
        self.assertEqual(done.returncode, 1)
        self.assertIn("b.mcap", done.stderr)
        self.assertEqual((self.scratch.root / "b.mcap").read_bytes(), b"mine")
        self.begin("a.mcap")
        done = self.scratch.cellmirror("record", "-o", str(self.scratch.root / "c.mcap"), "--instance", self.scratch.instance)
        self.assertEqual(done.returncode, 1)
        self.assertIn("is running already", done.stderr)

    def test_the_end_of_the_gateway_finishes_the_file(self):
        gateway = self.start()
        self.begin("a.mcap")
        gateway.stop()
        self.recording("check", str(self.scratch.root / "a.mcap"))

    def test_a_killed_gateway_leaves_all_but_the_last_second(self):
        gateway = self.start()
        self.begin("a.mcap", "--rate", "100")
        self.assertTrue(g.eventually(lambda: self.recordings()[0]["duration_s"] > 1))
        then = self.recordings()[0]
        before = {topic["topic"]: topic["messages"] for topic in then["topics"]}
        # A second, and another one for a machine that is late.
        self.assertTrue(g.eventually(lambda: self.recordings()[0]["duration_s"] > then["duration_s"] + 2))
        gateway.kill()
        file = str(self.scratch.root / "a.mcap")
        info = self.info("a.mcap")
        self.assertFalse(info["indexed"])
        joints = next(topic for topic in info["topics"] if topic["topic"] == "/joint_states")
        self.assertGreater(before["/joint_states"], 10)
        self.assertGreaterEqual(joints["messages"], before["/joint_states"])
        self.recording("check", file, code=1)
        self.recording("recover", file, "-o", str(self.scratch.root / "b.mcap"))
        self.recording("check", str(self.scratch.root / "b.mcap"))
        structure = mcap_structure.topics(mcap_structure.Recording((self.scratch.root / "b.mcap").read_bytes()))
        self.assertEqual(structure["/joint_states"], joints["messages"])
        self.assertEqual(self.start().stop(), 0)  # the next one takes the queues over, and removes them

    def test_a_removed_file_ends_the_recording_and_nothing_else(self):
        self.start()
        recorder = self.begin("a.mcap")
        (self.scratch.root / "a.mcap").unlink()
        self.assertEqual(recorder.child.wait(60), 1)
        self.assertIn("was removed", recorder.output())
        status = self.scratch.status()
        self.assertIn("was removed", status["recordings"][0]["why"])
        self.loop_goes_on(status["loop"])
        self.assertIn(status["loop"]["allocations"], (0, None))

    def test_a_client_that_is_gone_ends_the_recording(self):
        self.start()
        recorder = self.begin("a.mcap")
        recorder.kill()
        self.assertTrue(g.eventually(lambda: self.recordings()[0]["ended"]))
        self.assertIn("gone", self.recordings()[0]["why"])
        self.recording("check", str(self.scratch.root / "a.mcap"))


class FullDisk(RecordingCase):
    def test_a_full_disk_is_counted_and_the_loop_goes_on(self):
        self.start()
        small = self.scratch.root / "small"
        small.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=200k", "tmpfs", str(small)], stderr=subprocess.DEVNULL).returncode != 0:
            self.skipTest("skipped: a file system cannot be mounted here")
        self.addCleanup(subprocess.run, ["umount", str(small)])
        recorder = self.begin("small/a.mcap", "--compression", "none", "--rate", "500", "--attach-mb", "0")
        self.assertTrue(g.eventually(lambda: self.recordings()[0]["dropped"] > 0), self.recordings())
        # What still finds room takes the problem back for a moment.
        self.assertTrue(g.eventually(lambda: any(one["kind"] == "recording" for one in self.scratch.status()["problems"])))
        self.assertEqual(recorder.child.wait(120), 1)
        self.assertIn("room", recorder.output())
        status = self.scratch.status()
        self.loop_goes_on(status["loop"])
        self.assertIn(status["loop"]["allocations"], (0, None))
        self.assertGreater(self.info("small/a.mcap")["messages"], 0)


class Inputs(RecordingCase):
    def test_can_frames_are_recorded_as_they_came(self):
        self.start()
        simulator = g.sim_robot("cia402", "--channel", "udp:239.74.163.2:43113", "--nodes", "1-6", "--rate", "100", "--motion",
                                "sine:amplitude=0.3,period=2")
        self.addCleanup(simulator.close)
        self.assertEqual(self.scratch.send("ROBOT MANTEC_R3 online").returncode, 0)
        self.assertTrue(g.eventually(lambda: self.scratch.robot("MANTEC_R3")["stream"]["state"] == "fresh"))
        self.record("a.mcap", seconds="2")
        file = str(self.scratch.root / "a.mcap")
        topic = "/inputs/can/MANTEC_R3"
        frames = json.loads(self.recording("export", file, "--topic", topic, "--json").stdout)["messages"]
        self.assertGreater(len(frames), 100)
        times = [frame["values"]["time_ns"] for frame in frames if not frame["values"]["sent"]]
        # Each stamp is turned into wall-clock time by itself, which two readings of clocks blur.
        self.assertTrue(all(later - earlier > -1_000_000 for earlier, later in zip(times, times[1:])))
        dropped = {one["topic"]: one["dropped"] for one in self.info("a.mcap")["topics"]}
        self.assertEqual(dropped[topic], 0)
        lines = self.recording("export", file, "--candump").stdout.splitlines()
        self.assertEqual(len(lines), len(times))
        self.assertEqual([line.split()[2] for line in lines],
                         [frame["values"]["frame"] for frame in frames if not frame["values"]["sent"]])


class BlackBox(RecordingCase):
    def black_box(self, text):
        self.scratch.cell_file.write_text(self.scratch.cell_file.read_text() + "\n[record]\n" + text)

    def files(self, begin="blackbox-"):
        return sorted((self.scratch.home / "records").glob(begin + "*.mcap"))

    def test_it_records_from_the_start_and_is_bounded(self):
        self.black_box("length_s = 3\nfile_s = 1\nkeep_after_s = 0\nkeep_on = []\n")
        gateway = self.start()
        self.assertTrue(g.eventually(lambda: self.recordings()[0]["files"] > 5))
        self.assertTrue(g.eventually(lambda: len(self.files()) <= 5), self.files())
        self.assertEqual(self.scratch.send("RECORD KEEP").returncode, 0)
        self.assertTrue(g.eventually(lambda: self.recordings()[0]["kept"] >= 3))
        self.assertEqual(self.scratch.send("RECORD OFF").returncode, 0)
        self.assertTrue(g.eventually(lambda: self.recordings()[0]["ended"]))
        self.assertEqual(self.scratch.send("RECORD KEEP").returncode, 1)
        self.assertEqual(self.scratch.send("RECORD ON").returncode, 0)
        self.assertFalse(self.recordings()[0]["ended"])
        gateway.stop()
        kept = self.files(f"blackbox-{self.scratch.instance}-kept-")
        self.assertGreaterEqual(len(kept), 3)
        for file in self.files():
            self.recording("check", str(file))

    def test_without_a_table_there_is_none(self):
        self.start()
        done = self.scratch.send("RECORD ON")
        self.assertEqual(done.returncode, 1)
        self.assertIn("[record]", done.stderr)
        self.assertEqual(self.recordings(), [])


class Export(RecordingCase):
    def test_joints_are_postures_for_collide(self):
        self.start()
        self.assertEqual(self.scratch.send("ROBACT PUMA_762").returncode, 0)
        self.record("a.mcap", "--rate", "20")
        postures = self.scratch.root / "postures.csv"
        self.recording("export", str(self.scratch.root / "a.mcap"), "--joints", "-o", str(postures))
        rows = list(csv.reader(postures.read_text().splitlines()))
        status = self.scratch.status()
        expected = {f"{robot['id']}.{joint['name']}": joint["position"] for robot in status["robots"] for joint in robot["joints"]}
        self.assertEqual(set(rows[0]), set(expected))
        for name, text in zip(rows[0], rows[-1]):
            self.assertAlmostEqual(float(text), expected[name], places=9, msg=name)
        for command in ("collide", "range"):
            done = self.scratch.cellmirror(command, "--cell", str(self.scratch.cell_file), "--poses", str(postures), "--json",
                                           timeout=200)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(len(json.loads(done.stdout)["frames"]), len(rows) - 1)

    def test_topics_as_csv_and_json(self):
        self.start()
        self.record("a.mcap")
        file = str(self.scratch.root / "a.mcap")
        table = list(csv.DictReader(self.recording("export", file, "--topic", "/joint_states").stdout.splitlines()))
        document = json.loads(self.recording("export", file, "--topic", "/joint_states", "--json").stdout)
        self.assertEqual(len(table), len(document["messages"]))
        for row, message in zip(table, document["messages"]):
            self.assertEqual(int(row["log_time_ns"]), message["log_time_ns"])
            self.assertEqual(row["name[0]"], message["values"]["name[0]"])
            self.assertEqual(float(row["position[0]"]), message["values"]["position[0]"])
        status = json.loads(self.recording("export", file, "--topic", "/cellmirror/status", "--json").stdout)
        self.assertEqual(status["messages"][0]["values"]["instance"], self.scratch.instance)
        half = json.loads(self.recording("export", file, "--topic", "/joint_states", "--json", "--to", "0.5").stdout)
        self.assertLess(len(half["messages"]), len(document["messages"]))
        self.assertIn("did you mean", self.recording("export", file, "--topic", "/joint_state", code=1).stderr)

    def test_what_is_no_recording_is_refused(self):
        other = self.scratch.root / "other.mcap"
        other.write_bytes(b"#ROSBAG V2.0\n" * 10)
        for command in (["info"], ["check"], ["export", "--joints"]):
            self.assertIn("at byte 0", self.recording(command[0], str(other), *command[1:], code=1).stderr)
        self.recording("recover", str(other), "-o", str(self.scratch.root / "new.mcap"), code=1)
        self.assertFalse((self.scratch.root / "new.mcap").exists())
        self.assertEqual(self.scratch.cellmirror("recording", "export", str(other)).returncode, 2)


if __name__ == "__main__":
    unittest.main(verbosity=2)

"""A robot that is mirrored over DDS, strikes a wall and falls silent, recorded with pictures and played: what a foreign reader (Cyclone
DDS) got then and gets now, what the robot's own messages were, the pictures, the alarms, and where the strike was."""

import bisect
import json
import shutil
import subprocess
import unittest

import gateway as g
import mcap_structure
from foxglove_client import Cdr, joint_state
from playback_test import Replay

JOINTS = ["turn", "shoulder", "elbow", "roll", "bend", "flange_turn"]
DOMAIN = "86"  # of this test alone
PICTURES = "/cellmirror/pictures/view_1"
STRIKES = "/cellmirror/collision_events"
TICK_NS = 1_000_000
# In the way of the flange once in two seconds.
WALL = """
[[node]]
name = "Wall"
xyz_m = [0.33, 0.0, 1.25]
geometry = [{ box_m = [0.1, 0.6, 0.3] }]
"""


def setUpModule():
    g.require(g.BIN / "dds_cyclone_peer", "Cyclone DDS is not installed")


class Reader(g.Process):
    """What a foreign reader gets on the gateway's output."""

    def __init__(self):
        super().__init__([g.BIN / "dds_cyclone_peer", "states", DOMAIN, "rt/cellmirror/joint_states"])

    def lines(self):
        return [json.loads(line) for line in self.output().splitlines(keepends=True) if line.startswith("{") and line.endswith("\n")]

    def writers(self):
        return next((line["writers"] for line in reversed(self.lines()) if "writers" in line), 0)

    def states(self):
        return [(line["stamp_ns"], line["position"]) for line in self.lines() if "stamp_ns" in line]


class RecordedDds(unittest.TestCase):
    """One recording for all."""

    @classmethod
    def setUpClass(cls):
        cls.scratch = scratch = g.Scratch("ros2_cell")
        cls.addClassCleanup(scratch.remove)
        text = scratch.cell_file.read_text().replace("domain = 0 ", f"domain = {DOMAIN} ")
        scratch.cell_file.write_text(text.replace("[dds_output]\nrate_hz = 50", f"[dds_output]\ndomain = {DOMAIN}\nrate_hz = 200") + WALL)
        (scratch.home / "scripts" / "startup.spt").write_text("ROBOT demo_arm online;\nROBOT demo_arm send_on;\n")
        cls.file = scratch.root / "a.mcap"
        cls.reader = Reader()
        cls.addClassCleanup(cls.reader.close)
        robot = g.sim_robot("dds", "--domain", DOMAIN, "--joint-names", ",".join(JOINTS), "--rate", "100", "--motion",
                            "sine:amplitude=0.3,period=2")
        gateway = g.Gateway(scratch, pictures=True)
        try:
            assert g.eventually(lambda: scratch.robot("demo_arm")["stream"]["state"] == "fresh"), scratch.robot("demo_arm")
            assert g.eventually(cls.reader.writers) == 1, cls.reader.output()
            before = len(cls.reader.states())
            recorder = g.Process([g.BIN / "cellmirror", "record", "-o", cls.file, "--rate", "1000", "--compression", "none",
                                  "--pictures", "1@2", "--instance", scratch.instance], scratch.environment)
            cls.addClassCleanup(recorder.close)
            cls.pictures = scratch.status()["pictures"]
            wanted = {"/inputs/dds/demo_arm": 200, STRIKES: 1, **({PICTURES: 2} if cls.pictures["on"] else {})}

            def counts():
                return {topic["topic"]: topic["messages"] for one in scratch.status()["recordings"] for topic in one["topics"]}

            assert g.eventually(lambda: all(counts().get(topic, 0) >= count for topic, count in wanted.items()), 60), counts()
            robot.kill()
            assert g.eventually(lambda: cls.lost(scratch.status())), scratch.status()["alarms"]
            now = counts()["/cellmirror/status"]
            assert g.eventually(lambda: counts()["/cellmirror/status"] > now), counts()
            assert recorder.stop() == 0, recorder.output()
            cls.then = cls.reader.states()[before:]
        finally:
            gateway.close()
            robot.close()
        cls.recording = mcap_structure.Recording(cls.file.read_bytes())

    @staticmethod
    def lost(status):
        """The alarm of the robot that is silent."""
        return next((alarm for alarm in status["alarms"]["open"] if (alarm["kind"], alarm["priority"]) == ("stream", "high")), None)

    def messages(self, topic, schema):
        """(publish time in ns, data) of each."""
        channel, = [one for one in self.recording.channels.values() if one[2] == topic]
        self.assertEqual((channel[3], *self.recording.schemas[channel[1]][1:3]), ("cdr", schema, "ros2msg"))
        return [(published, data) for name, _, _, published, data in self.recording.messages if name == topic]

    def recorded(self):
        """(stamp, positions) of the ticks that the recorder came in time for."""
        return [(published, tuple(sorted(joint_state(data)[1].items())))
                for published, data in self.messages("/joint_states", "sensor_msgs/msg/JointState")]

    def in_the_recording(self, states):
        """Positions of those whose time the recording has; each was the state of a tick then."""
        recorded, out = self.recorded(), set()
        stamps = [stamp for stamp, _ in recorded]
        for stamp, position in states:
            at = bisect.bisect(stamps, stamp)
            if not 0 < at < len(stamps) or stamps[at] - stamps[at - 1] > 2 * TICK_NS:
                continue  # before or after it, or the recorder came too late
            position = tuple(sorted(position.items()))
            # Stamps are turned into UTC one by one, which may shift them by less than a tick.
            near = [positions for one, positions in recorded[max(0, at - 3):at + 3] if abs(one - stamp) < 2 * TICK_NS]
            self.assertTrue(position in near, f"not to the bit: {position}, recorded {near}")
            out.add(position)
        return out

    def test_dds_outputs_of_the_replay_are_those_of_then(self):
        then = self.in_the_recording(self.then)
        self.assertGreater(len(then), 100)
        self.assertTrue(g.eventually(lambda: self.reader.writers() == 0), "the gateway's writer is still there")
        replay = Replay(self.scratch, self.file, "--paused", "--wait", "--publish")
        self.addCleanup(replay.close)
        self.assertTrue(g.eventually(lambda: self.reader.writers() == 1), self.reader.output())
        before = len(self.reader.states())
        replay.ask(request="playback", play=True)
        self.assertTrue(g.eventually(lambda: replay.status()["replay"]["state"] == "ended"), replay.status()["replay"])
        self.check_events(replay)
        states = self.reader.states()[before:]
        now = self.in_the_recording(states)
        self.assertEqual(set(states[-1][1]), set(JOINTS))
        # A busy machine leaves some out, then and now other ones.
        self.assertGreater(len(now & then), 0.1 * len(then))

    def check_events(self, replay):
        """Of the replay that has ended: alarms as they were, and marks where something began."""
        struck = [json.loads(data) for topic, *_, data in self.recording.messages if topic == STRIKES]
        struck = [one for one in struck if one["change"] == "touched"]
        alarms = [json.loads(data) for topic, *_, data in self.recording.messages if topic == "/cellmirror/alarms"]
        lost = next(one for one in alarms if (one["kind"], one["priority"]) == ("stream", "high"))
        status = replay.status()
        marks = status["replay"]["marks"]
        self.assertEqual(status["replay"]["mark_count"], len(marks))
        # Those of one instant are in no order.
        self.assertEqual(sorted(mark["text"] for mark in marks if mark["kind"] == "collision"),
                         sorted(f'{one["a"]}, {one["b"]}' for one in struck))
        # Besides that of the robot there may be faults of the loop, and a robot that was late, on a busy machine.
        faults = [mark for mark in marks if mark["kind"] == "fault"]
        self.assertIn(lost["text"], [mark["text"] for mark in faults])
        for mark in faults:
            self.assertRegex(mark["text"], "the data of demo_arm are lost|periods missed within a second|the loop stood still")
        self.assertEqual([mark["position_s"] for mark in marks], sorted(mark["position_s"] for mark in marks))
        # The strike is where the mark says, and was not there before; so is the alarm.
        at = next(mark["position_s"] for mark in marks if mark["kind"] == "collision")
        replay.seek(at + 0.01)
        self.assertTrue(g.eventually(lambda: replay.status()["collisions"]["touching_count"] > 0), "nothing touches at the mark")
        fault = next(mark["position_s"] for mark in faults if mark["text"] == lost["text"])
        self.assertIsNone(self.lost(replay.seek(fault - 0.3)))
        self.assertEqual(self.lost(replay.seek(fault + 0.3))["id"], lost["id"])

    def test_messages_of_the_robot_are_recorded_as_it_sent_them(self):
        samples = self.messages("/inputs/dds/demo_arm", "sensor_msgs/msg/JointState")
        self.assertGreater(len(samples), 100)
        shown, matched = {positions for _, positions in self.recorded()}, 0
        for received, data in samples:
            stamp, position = joint_state(data)
            self.assertEqual(list(position), JOINTS, "in the robot's order")
            self.assertLess(abs(received * 1e-9 - stamp), 10.0)
            matched += tuple(sorted(position.items())) in shown
        # What the robot sent is what the gateway shows, where the recorder came in time for its ticks.
        self.assertGreater(matched, 0.2 * len(samples))
        times = [received for received, _ in samples]
        self.assertTrue(all(later - earlier > -1_000_000 for earlier, later in zip(times, times[1:])))

    def test_pictures_can_be_decoded_and_show_the_cell(self):
        if not self.pictures["on"]:
            self.skipTest(f"skipped: no renderer: {self.pictures['problem']}")
        pictures = self.messages(PICTURES, "sensor_msgs/msg/CompressedImage")
        self.assertGreaterEqual(len(pictures), 2)
        self.assertGreater((pictures[-1][0] - pictures[0][0]) / (len(pictures) - 1), 0.4e9, "at most 2 a second")
        states = [stamp for stamp, _ in self.recorded()]
        for published, data in pictures:
            cdr = Cdr(data)
            self.assertLess(abs(cdr.stamp() - published * 1e-9), 1e-6)
            self.assertTrue(states[0] - 3e9 < published < states[-1] + 3e9, "the time of a tick")
            self.assertEqual((cdr.text(), cdr.text()), ("1", "jpeg"))
            jpeg = bytes(cdr.many(lambda: cdr.number("B")))
            self.assertEqual((jpeg[:2], jpeg[-2:]), (b"\xff\xd8", b"\xff\xd9"))
        if shutil.which("ffmpeg") is None:
            self.skipTest("skipped: ffmpeg is not installed, which decodes a picture")
        pixels = subprocess.run(["ffmpeg", "-v", "error", "-xerror", "-f", "mjpeg", "-i", "-", "-f", "rawvideo", "-pix_fmt", "rgb24", "-"],
                                input=jpeg, capture_output=True, check=True, timeout=120).stdout
        self.assertEqual(len(pixels), 640 * 480 * 3)
        self.assertGreater(len({pixels[at:at + 3] for at in range(0, len(pixels), 3)}), 50, "colours")


if __name__ == "__main__":
    unittest.main(verbosity=2)

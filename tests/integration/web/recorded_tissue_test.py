"""Deformable objects in a recording: they move and are cut, and a replay shows them as they were, to and fro."""

import json
import pathlib
import struct
import unittest

import gateway as g
import mcap_structure
import trainer
from foxglove_client import Foxglove
from playback_test import Replay

# The right instrument cuts the artery between its jaws, at several depths, so that one does where the organs lie a little elsewhere.
CUT = "EXEC_SCRIPT tool_scissors.spt;\nROBACT LAP_RIGHT;\nrob_jnt_max_vel 0.5 0.5 100.0 0.8 1.0;\n" + "".join(
    f"POS_ROB LAP_RIGHT JOINT_ABS 3.377 0.657 {depth} -36.0 {jaw};\n" for depth in (203, 204, 208) for jaw in (25, 2, 25)
) + "POS_ROB LAP_RIGHT JOINT_ABS 3.377 0.657 160 -36.0 25\n"
ARTERY = "/cellmirror/tissue/cystic_artery"


class Surface:
    """A message of /cellmirror/tissue/OBJECT by docs/recording.md."""

    def __init__(self, data):
        version, flags, self.step, self.time_ns, self.revision, count = struct.unpack_from("<BBQqII", data, 0)
        assert version == 1, version
        self.has_shape = bool(flags & 1)
        box = struct.unpack_from("<6f", data, 26)
        at, axes = 50, []
        for axis in range(3):
            low, high = data[at:at + count], data[at + count:at + 2 * count]
            at, value, places = at + 2 * count, 0, []
            for one in (a | b << 8 for a, b in zip(low, high)):
                value = (value + ((one >> 1) ^ (0xFFFF if one & 1 else 0))) & 0xFFFF
                places.append(box[axis] + box[3 + axis] * value / 65535)
            axes.append(places)
        self.vertices = list(zip(*axes))
        at += 3 * count
        if self.has_shape:
            size = data[at]
            self.name = data[at + 1:at + 1 + size].decode()
            self.triangles, = struct.unpack_from("<I", data, at + 1 + size)

    def is_like(self, other):
        """Places are rounded to 1/65535 of the surface's box, twice."""
        return len(self.vertices) == len(other.vertices) and all(
            abs(x - y) < 2e-5 for a, b in zip(self.vertices, other.vertices) for x, y in zip(a, b))


def tick_times(data):
    """Of each tick in a message of /inputs/ticks, ns."""
    at = 1
    while at < len(data):
        kind, length = struct.unpack_from("<BI", data, at)
        at += 5 + length
        if kind == 5:
            yield struct.unpack_from("<q", data, at - length + 8)[0]


class RecordedTissue(unittest.TestCase):
    def setUp(self):
        self.scratch = g.Scratch("trainer", startup=True)
        self.addCleanup(self.scratch.remove)
        trainer.with_own_memories(self.scratch)
        self.scratch.cell_file.write_text(self.scratch.cell_file.read_text().replace("online = true", "online = false"))
        (self.scratch.home / "scripts" / "cut.spt").write_text(CUT)
        self.file = pathlib.Path(self.scratch.root / "a.mcap")

    def nodes(self):
        """Of the artery's elements: a cut divides some."""
        return next(one["nodes"] for one in self.scratch.status()["tissue"]["objects"] if one["name"] == "cystic_artery.mpo")

    def surfaces(self):
        """Messages of the artery that are recorded."""
        return sum(one["messages"] for one in self.scratch.status()["recordings"][0]["topics"] if one["topic"] == ARTERY)

    def record(self):
        gateway = g.Gateway(self.scratch)
        self.addCleanup(gateway.close)
        recorder = g.Process([g.BIN / "cellmirror", "record", "-o", self.file, "--compression", "none", "--topics", "/inputs/ticks,/cellmirror/*",
                              "--instance", self.scratch.instance], self.scratch.environment)
        self.addCleanup(recorder.close)
        self.assertTrue(g.eventually(lambda: self.scratch.status()["recordings"] and self.surfaces() > 1, 30), recorder.output())
        before = self.nodes()
        for _ in range(4):  # a busy machine simulates some milliseconds less, and the artery may slip
            self.assertEqual(self.scratch.send("EXEC_SCRIPT cut.spt", timeout=60).returncode, 0)
            if g.eventually(lambda: self.nodes() != before, 15):
                break
        self.assertNotEqual(self.nodes(), before, gateway.output())
        recorded = self.surfaces()
        # One may have been made before the cut.
        self.assertTrue(g.eventually(lambda: self.surfaces() > recorded + 2, 30), recorder.output())
        recorder.child.terminate()
        self.assertEqual(recorder.child.wait(40), 0, recorder.output())
        status = self.scratch.status()
        self.assertIn(status["loop"]["allocations"], (0, None), "the tick allocates nothing for it")
        gateway.stop()

    def shown_at(self, recording, tick_ns):
        """What a replay shows beside that tick: the last message of the artery before the one that has the tick."""
        newest, out = None, []
        for topic, *_, data in recording.messages:
            if topic == ARTERY:
                newest = Surface(data)
            if topic == "/inputs/ticks" and newest and any(abs(time - tick_ns) < 1_500_000 for time in tick_times(data)):
                out.append(newest)
        return out

    def test_a_replay_shows_surfaces_as_they_were(self):
        self.record()
        recording = mcap_structure.Recording(self.file.read_bytes())
        shapes = [surface for surface in (Surface(data) for topic, *_, data in recording.messages if topic == ARTERY) if surface.has_shape]
        self.assertEqual(shapes[0].name, "cystic_artery.mpo")
        self.assertNotEqual(shapes[0].revision, shapes[-1].revision, "it was cut")
        self.assertNotEqual(len(shapes[0].vertices), len(shapes[-1].vertices))
        self.assertIn("/cellmirror/tissue_markers", {topic for topic, *_ in recording.messages})
        done = self.scratch.cellmirror("recording", "info", str(self.file), "--json")
        utc = int(json.loads(done.stdout)["gateway"]["utc_minus_monotonic_ns"])
        replay = Replay(self.scratch, self.file, "--paused", "--page")
        self.addCleanup(replay.close)
        client = Foxglove(replay.page())
        self.addCleanup(client.close)
        client.subscribe(ARTERY, 1)
        length = replay.status()["replay"]["length_s"]
        vertices = set()
        for share in (1.0, 0.1, 0.6, 0.1, 1.0):
            status = replay.seek(share * length)["replay"]
            wanted = self.shown_at(recording, status["now_ns"] - utc)
            self.assertTrue(wanted, status)
            # Messages of the times before may come first.
            shown = client.until(lambda message: isinstance(message, bytes) and message[0] == client.DATA and
                                 any(Surface(message[13:]).is_like(one) for one in wanted), timeout=30)
            vertices.add(len(Surface(shown[13:]).vertices))
        self.assertGreater(len(vertices), 1, "with and without the cut")


if __name__ == "__main__":
    unittest.main(verbosity=2)

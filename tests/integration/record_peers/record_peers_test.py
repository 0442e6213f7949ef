"""Recordings against @mcap/core, @mcap/nodejs and @foxglove/rosmsg2-serialization: they read what we write, we read what they write."""

import hashlib
import json
import unittest

import gateway as g
import mcap_structure
from judges import PACKAGES


def peers(*arguments):
    return PACKAGES.run("peers.mjs", *arguments)


class Peers(unittest.TestCase):
    def setUp(self):
        self.scratch = g.Scratch()
        self.addCleanup(self.scratch.remove)

    def recording(self, *arguments):
        done = self.scratch.cellmirror("recording", *arguments)
        self.assertEqual(done.returncode, 0, done.stderr + done.stdout)
        return done.stdout

    def info(self, file):
        return json.loads(self.recording("info", str(file), "--json"))

    def record(self, file, compression):
        """Until there is something of each topic that is looked at, however slow the machine is."""
        recorder = g.Process([g.BIN / "cellmirror", "record", "-o", file, "--compression", compression, "--instance",
                              self.scratch.instance], self.scratch.environment)
        self.addCleanup(recorder.close)

        def topics_so_far():
            recordings = [one for one in self.scratch.status()["recordings"] if one["file"] == str(file)]
            return {topic["topic"] for one in recordings for topic in one["topics"] if topic["messages"] > 1}

        wanted = {"/joint_states", "/tf", "/cellmirror/status", "/cellmirror/collisions"}
        g.eventually(lambda: wanted <= topics_so_far(), timeout=60)
        self.assertLessEqual(wanted, topics_so_far())
        self.assertEqual(recorder.stop(timeout=60), 0, recorder.output())

    def assert_same(self, found, info):
        counts = {topic["topic"]: topic["messages"] for topic in info["topics"] if topic["messages"]}
        for way in ("indexed", "stream"):
            self.assertEqual(found[way]["topics"], counts, way)
        self.assertEqual(found["indexed"]["digest"], found["stream"]["digest"])
        self.assertTrue(found["stream"]["done"])
        self.assertEqual(found["indexed"]["messages"], info["messages"])
        self.assertEqual(found["indexed"]["chunks"], info["chunks"])

    def test_they_read_what_the_gateway_records(self):
        gateway = g.Gateway(self.scratch)
        self.addCleanup(gateway.close)
        for compression in ("none", "lz4", "zstd"):
            file = self.scratch.root / f"{compression}.mcap"
            self.record(file, compression)
            info = self.info(file)
            found = peers("read", file)
            self.assert_same(found, info)
            self.assertEqual(found["indexed"]["profile"], "ros2")
            self.assertEqual(found["indexed"]["attachments"]["cell.toml"],
                             hashlib.sha256(self.scratch.cell_file.read_bytes()).hexdigest())
            # A busy machine may make the recorder come too late for a tick; nothing else is left out.
            self.assertLessEqual(set(found["indexed"]["metadata"]["cellmirror.drops"]), {"/joint_states"})
            last = found["indexed"]["last"]
            joints = {joint["name"]: joint["position"] for robot in self.scratch.status()["robots"] for joint in robot["joints"]}
            state = last["/joint_states"]
            self.assertEqual(len(state["name"]), sum(len(robot["joints"]) for robot in self.scratch.status()["robots"]))
            for name, position in zip(state["name"], state["position"]):
                if name in joints:
                    self.assertAlmostEqual(position, joints[name], places=9)
            self.assertEqual(last["/tf"]["transforms"][0]["header"]["frame_id"], "world")
            self.assertEqual(last["/cellmirror/status"]["instance"], self.scratch.instance)
            recovered = self.scratch.root / f"{compression}-recovered.mcap"
            file.write_bytes(file.read_bytes()[:-100])
            self.recording("recover", str(file), "-o", str(recovered), "--compression", compression)
            self.assert_same(peers("read", recovered), self.info(recovered))

    def test_we_read_what_they_write(self):
        switches = ("useChunks", "useStatistics", "useSummaryOffsets", "repeatSchemas", "repeatChannels", "useMessageIndex",
                    "useChunkIndex", "useAttachmentIndex", "useMetadataIndex")
        # Each switch off by itself, and pairs with useChunks.
        variants = [{}] + [{name: False} for name in switches] + [
            {"useChunks": False, other: False} for other in switches[1:]] + [{"chunkSize": 1000}]
        for number, variant in enumerate(variants):
            with self.subTest(variant=variant):
                file = self.scratch.root / f"{number}.mcap"
                written = peers("write", file, json.dumps(variant))
                info = self.info(file)
                self.assertEqual({topic["topic"]: topic["messages"] for topic in info["topics"]}, written["topics"])
                self.assertEqual(info["attachments"][0]["name"], "a.txt")
                rows = json.loads(self.recording("export", str(file), "--topic", "/b", "--json"))["messages"]
                self.assertEqual([row["log_time_ns"] for row in rows], [1000 + i for i in range(1, 500, 2)])
                self.assertEqual(rows[3]["values"], {"i": 7, "text": "x" * 7, "list[0]": 1.5, "list[1]": 7})
                copy = self.scratch.root / f"{number}-copy.mcap"
                self.recording("recover", str(file), "-o", str(copy))
                found = peers("read", copy)
                self.assert_same(found, self.info(copy))
                self.assertEqual(found["indexed"]["digest"], written["digest"])
                self.recording("recover", str(copy), "-o", str(self.scratch.root / f"{number}-none.mcap"), "--compression", "none")
                structure = mcap_structure.Recording((self.scratch.root / f"{number}-none.mcap").read_bytes())
                self.assertEqual(mcap_structure.topics(structure), written["topics"])


if __name__ == "__main__":
    PACKAGES.main()

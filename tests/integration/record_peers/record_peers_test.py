"""Recordings against @mcap/core, @mcap/nodejs and @foxglove/rosmsg2-serialization: they read what we write, we read what they write.

The packages are those of package-lock.json, with the integrity that it demands. They are downloaded where CELLMIRROR_PEERS is set
(./check --peers), and kept beside the build; else the test skips where they are not there."""

import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import unittest

import gateway as g
import mcap_structure

HERE = pathlib.Path(__file__).resolve().parent
PLACE = g.BIN.parent / "record_peers"
SKIPPED = 77


def why_no_peers():
    """Empty where the packages are there."""
    if shutil.which("npm") is None or shutil.which("node") is None:
        return "npm or node is not installed"
    lock = (HERE / "package-lock.json").read_bytes()
    mark = PLACE / "installed"
    wanted = hashlib.sha256(lock).hexdigest()
    if not (mark.exists() and mark.read_text() == wanted):
        if not os.environ.get("CELLMIRROR_PEERS"):
            return "the packages are not installed; ./check --peers does that"
        shutil.rmtree(PLACE, ignore_errors=True)
        PLACE.mkdir(parents=True)
        for name in ("package.json", "package-lock.json"):
            shutil.copy(HERE / name, PLACE)
        done = subprocess.run(["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund"], cwd=PLACE, capture_output=True,
                              text=True, timeout=200)
        if done.returncode != 0:
            return f"npm ci failed: {done.stderr[-300:]}"
        mark.write_text(wanted)
    # Modules are looked for beside the script.
    shutil.copy(HERE / "peers.mjs", PLACE)
    return ""


def peers(*arguments):
    done = subprocess.run(["node", "peers.mjs", *[str(one) for one in arguments]], cwd=PLACE, capture_output=True, text=True,
                          timeout=120)
    if done.returncode != 0:
        raise AssertionError(done.stderr)
    return json.loads(done.stdout)


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
            done = self.scratch.cellmirror("record", "-o", str(file), "--for", "2", "--compression", compression, "--instance",
                                           self.scratch.instance)
            self.assertEqual(done.returncode, 0, done.stderr)
            info = self.info(file)
            found = peers("read", file)
            self.assert_same(found, info)
            self.assertEqual(found["indexed"]["profile"], "ros2")
            self.assertEqual(found["indexed"]["attachments"]["cell.toml"],
                             hashlib.sha256(self.scratch.cell_file.read_bytes()).hexdigest())
            self.assertEqual(found["indexed"]["metadata"]["cellmirror.drops"], {})
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
    missing = why_no_peers()
    if missing:
        print(f"skipped: {missing}")
        sys.exit(SKIPPED)
    unittest.main(verbosity=2)

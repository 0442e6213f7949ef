"""Cameras that are online: their records leave over the SENSOR channel, a simulated head follows them, and the model shows
where the real one looks."""

import errno
import json
import math
import subprocess
import struct
import sys
import time
import unittest

import gateway as g

sys.path.insert(0, str(g.SOURCE / "docs" / "examples"))
from cellmirror_queue import IPC_NOWAIT, Queue  # noqa: E402

CAMERA, HEAD, TARGET = "UMG_Kamera_1", "KAMERAKOPF_1", "Gantry.J_2.Hand"
CHANNEL = "udp:239.74.163.2:43113"
RECORD = struct.Struct("<4sHHIIQqq64s128s18dII")
TRACKING, MIRRORED = 1, 2


class Record:
    def __init__(self, message):
        magic, version, self.kind, length, _, self.sequence, self.time_ns, _ = struct.unpack_from("<4sHHIIQqq", message)
        assert (magic, version, length) == (b"CMIR", 1, len(message))
        if self.kind != 4:
            return
        fields = RECORD.unpack(message)
        self.id, self.tracks = (field.split(b"\0", 1)[0].decode() for field in fields[8:10])
        numbers = fields[10:28]
        self.position, self.quaternion = numbers[0:3], numbers[3:7]
        self.mount = numbers[10:14]
        self.pan, self.tilt, self.distance, self.fovy = numbers[14:18]
        self.flags = fields[28]

    def looks_along(self):
        """The z axis of the pose."""
        x, y, z, w = self.quaternion
        return 2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)


class Cameras(unittest.TestCase):
    def setUp(self):
        self.scratch = g.Scratch()
        self.gateway = g.Gateway(self.scratch)
        self.processes = []
        info = json.loads(next(self.scratch.runtime.glob("**/instance.json")).read_text())
        self.key = info.get("queues", info)["sensor_key"]

    def tearDown(self):
        for process in self.processes:
            process.close()
        status = self.gateway.stop()
        self.gateway.close()
        self.scratch.remove()
        self.assertEqual(status, 0)

    def command(self, *commands):
        for command in commands:
            done = self.scratch.send(command)
            self.assertEqual(done.returncode, 0, f"{command}: {done.stderr}")

    def records(self, seconds=0.5):
        """What comes within so long, older records thrown away."""
        queue, taken, end = Queue(self.key), [], time.monotonic() + seconds
        fresh = time.monotonic_ns()
        while time.monotonic() < end:
            try:
                record = Record(queue.receive(5, IPC_NOWAIT))
                if record.time_ns > fresh:
                    taken.append(record)
            except OSError as error:
                self.assertEqual(error.errno, errno.ENOMSG)
                time.sleep(0.005)
        return taken

    def camera_records(self, count=1):
        """The first `count` camera records or more that are newer than this call."""
        taken = []
        self.assertTrue(g.eventually(lambda: taken.extend(r for r in self.records(0.3) if r.kind == 4) or len(taken) >= count),
                        f"{len(taken)} camera records came")
        return taken

    def head(self, *more):
        process = g.Process([g.BIN / "sim_camera_head", "--camera", CAMERA, "--key", self.key, "--channel", CHANNEL,
                             "--nodes", "21,22", "--pan-range", "-1.6,1.6", "--tilt-range", "-1.4,0.45",
                             "--start", "0,-0.6292", "--control", self.scratch.root / "head.sock", "--no-input", *more])
        self.processes.append(process)
        self.assertTrue(g.eventually((self.scratch.root / "head.sock").exists), "the head listens")
        return process

    def tell(self, line):
        import socket
        with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as client:
            client.settimeout(60)
            client.connect(str(self.scratch.root / "head.sock"))
            client.sendall(line.encode() + b"\n")
            answer = b""
            while not answer.endswith(b"\n"):
                piece = client.recv(65536)
                if not piece:
                    break
                answer += piece
        return answer.decode()

    def joints(self):
        return [joint["position"] for joint in self.scratch.robot(HEAD)["joints"]]

    def wanted(self):
        """Pan and tilt of the newest record; the head only looks, so that this may take them."""
        newest = self.camera_records()[-1]
        return newest.pan, newest.tilt

    def looks_at_target(self, within=0.01):
        wanted, joints = self.wanted(), self.joints()
        return all(abs(a - b) < within for a, b in zip(wanted, joints))

    def test_only_cameras_that_are_online_are_told_at_the_rate_of_the_channel(self):
        self.assertEqual([r for r in self.records(0.3) if r.kind == 4], [])
        self.command(f"SET_CAMPAR {CAMERA} 4.85 15.71", f"CAM_ONLINE {CAMERA} on")
        records = self.camera_records(30)
        for record in records:
            self.assertEqual((record.id, record.tracks, record.flags), (CAMERA, "", 0))
            self.assertAlmostEqual(record.distance, 4.85)
            self.assertAlmostEqual(record.fovy, math.radians(15.71))
            self.assertAlmostEqual(record.pan, 0, 9)
            self.assertAlmostEqual(record.tilt, -0.6292036732051034, 9)
        # 50 Hz: never more often; the median, since a busy machine is late now and then.
        between = sorted(b.time_ns - a.time_ns for a, b in zip(records, records[1:]))
        self.assertGreater(sum(between) / len(between), 15e6)
        self.assertLess(between[len(between) // 2], 100e6)
        self.command(f"CAM_ONLINE {CAMERA} off")
        self.assertTrue(g.eventually(lambda: not [r for r in self.records(0.3) if r.kind == 4]))

    def test_a_tracking_camera_is_told_to_look_at_its_frame_as_that_moves(self):
        self.command(f"CAM_TRACKING {CAMERA} on {TARGET}", f"CAM_ONLINE {CAMERA} on")
        before = self.camera_records()[-1]
        self.assertTrue(before.tracks.startswith("Gantry.") and before.tracks.endswith(".Hand"), before.tracks)
        self.assertEqual(before.flags, TRACKING)
        tcp = self.scratch.robot("TRAEGERSYSTEM")["tcp"]["position_m"]
        ahead = [p + before.distance * d for p, d in zip(before.position, before.looks_along())]
        self.command("ROBACT TRAEGERSYSTEM", "POS_ROB TRAEGERSYSTEM JOINT_INC 800.0 0.0 0.0")
        g.eventually(lambda: self.scratch.robot("TRAEGERSYSTEM")["tcp"]["position_m"][0] != tcp[0])
        after = self.camera_records()[-1]
        then = [p + after.distance * d for p, d in zip(after.position, after.looks_along())]
        self.assertEqual(before.position, after.position)
        moved = math.dist(ahead, then)
        self.assertGreater(moved, 0.5, "what it looks at has moved with the gantry")
        self.command(f"CAM_TRACKING {CAMERA} off")
        self.assertTrue(g.eventually(lambda: (lambda r: (r.tracks, r.flags) == ("", 0))(self.camera_records()[-1])), "it tracks on")

    def test_a_full_queue_loses_the_oldest_and_counts_them(self):
        self.command(f"CAM_ONLINE {CAMERA} on", "CAM_ONLINE CAMERA_5 on")
        counters = lambda: next(q for q in self.scratch.status()["queues"] if "sensor" in q["name"])
        self.assertTrue(g.eventually(lambda: counters()["dropped"] > 5))
        self.assertGreater(counters()["cameras_sent"], 40)
        self.assertEqual(counters()["cameras_refused"], 0)
        # What is in the queue now: nothing more comes that would take the place of another one while it is read.
        self.command(f"CAM_ONLINE {CAMERA} off", "CAM_ONLINE CAMERA_5 off")
        queue, sequences = Queue(self.key), []
        for _ in range(10):
            sequences.append(Record(queue.receive(5, IPC_NOWAIT)).sequence)
        self.assertEqual(sequences, list(range(sequences[0], sequences[0] + 10)))
        self.assertGreater(sequences[0], 1, "the oldest are gone")

    def test_the_real_head_follows_and_the_model_shows_where_it_looks(self):
        self.head()
        self.command(f"ROBOT {HEAD} online", f"CAM_TRACKING {CAMERA} on {TARGET}", f"CAM_ONLINE {CAMERA} on")
        self.assertTrue(g.eventually(self.looks_at_target), (self.wanted(), self.joints()))
        self.assertEqual(self.camera_records()[-1].flags, TRACKING | MIRRORED)
        at_first = self.joints()
        self.command("ROBACT TRAEGERSYSTEM", "POS_ROB TRAEGERSYSTEM JOINT_INC 800.0 0.0 0.0")
        self.assertTrue(g.eventually(lambda: abs(self.joints()[0] - at_first[0]) > 0.05), "it turns after the gantry")
        self.assertTrue(g.eventually(self.looks_at_target), (self.wanted(), self.joints()))
        # Told nothing any more it stays, and is not driven by the echo of its own posture.
        self.command(f"CAM_TRACKING {CAMERA} off")
        told_last, there = self.joints(), []

        def rests():
            there[:] = [self.joints()]
            time.sleep(0.5)
            return all(abs(a - b) < 1e-4 for a, b in zip(there[0], self.joints()))

        self.assertTrue(g.eventually(rests), "it does not stay")
        self.assertTrue(all(abs(a - b) < 0.03 for a, b in zip(there[0], told_last)), (there, told_last))
        report = lambda: json.loads(self.tell("status"))["channels"][0]
        self.assertTrue(g.eventually(lambda: report()["echoes"] > 5), report())
        self.assertEqual(report()["ignored"], 0)

    def test_a_head_that_sticks_is_seen_where_it_is_not_where_it_should_be(self):
        self.head()
        self.command(f"ROBOT {HEAD} online", f"CAM_ONLINE {CAMERA} on")
        self.assertTrue(g.eventually(lambda: self.scratch.robot(HEAD)["stream"]["state"] == "fresh"))
        self.assertIn("ok: fault 1001", self.tell("fault stuck:joint=1"))
        self.command(f"CAM_TRACKING {CAMERA} on {TARGET}")
        self.assertTrue(g.eventually(lambda: abs(self.wanted()[1] - self.joints()[1]) < 0.01), "tilt gets there")
        self.assertGreater(abs(self.wanted()[0] - self.joints()[0]), 0.1, "pan does not")
        self.assertIn("ok: 1 ended", self.tell("clear stuck"))
        self.assertTrue(g.eventually(self.looks_at_target))
        # Its drives have the faults of sim_robot.
        self.assertIn("ok: fault 1", self.tell("die"))
        self.assertTrue(g.eventually(lambda: self.scratch.robot(HEAD)["stream"]["state"] in ("stale", "lost")))
        self.assertIn("ok", self.tell("return"))
        self.assertTrue(g.eventually(lambda: self.scratch.robot(HEAD)["stream"]["state"] == "fresh"))

    def test_a_head_that_takes_the_records_leaves_the_queue_empty(self):
        process = self.head("--take")
        self.command(f"CAM_ONLINE {CAMERA} on")
        followed = lambda: json.loads(self.tell("status"))["channels"][0]["followed"]
        self.assertTrue(g.eventually(lambda: process.running() and followed() > 20))
        waiting = lambda: next(q for q in self.scratch.status()["queues"] if "sensor" in q["name"])["waiting"]
        self.assertTrue(g.eventually(lambda: waiting() < 5), "it does not take them")

    def test_words_that_are_wrong_are_explained(self):
        sut = lambda *words: subprocess.run([g.BIN / "sim_camera_head", *words], capture_output=True, text=True, timeout=60)
        for words, what in ((("--nodes", "21,22"), "--camera is needed"), (("--camera", "C", "--nodes", "1-3"), "two"),
                            (("--camera", "C", "--fault", "stuk"), "no fault 'stuk'"),
                            (("--camera", "C", "--speed", "1"), "--speed needs PAN,TILT"),
                            (("--camera", "C", "--rate", "333"), "whole milliseconds"),
                            (("--camera", "C", "--pan-range", "1,-1"), "LEAST,MOST")):
            done = sut(*words)
            self.assertEqual(done.returncode, 2, words)
            self.assertIn(what, done.stderr)
        self.assertEqual(sut("--camera", "C", "--channel", "log:x").returncode, 1)
        for page in ("--help", "--faults", "--commands"):
            done = sut(page)
            self.assertEqual(done.returncode, 0)
            self.assertGreater(len(done.stdout), 300)


if __name__ == "__main__":
    g.main()

"""Pictures of the running gateway and of cell files: `cellmirror snapshot`, films, who is refused, what goes on without."""

import base64
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import struct
import subprocess
import threading
import unittest

import gateway as g


def png_size(path):
    data = pathlib.Path(path).read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", data[:8]
    return struct.unpack(">II", data[16:24])


def jpeg_size(data):
    """Of the frame header (ISO 10918-1, B.2.2)."""
    assert data[:2] == b"\xff\xd8", data[:2]
    at = 2
    while at < len(data):
        marker, length = data[at + 1], struct.unpack(">H", data[at + 2:at + 4])[0]
        if marker in (0xC0, 0xC1, 0xC2):
            height, width = struct.unpack(">HH", data[at + 5:at + 9])
            return width, height
        at += 2 + length
    raise AssertionError("no frame header")


def require_renderer(scratch):
    done = scratch.cellmirror("snapshot", "--cell", str(scratch.cell_file), "--size", "16x16", "-o",
                              str(scratch.root / "probe.png"))
    if done.returncode != 0 and "renderer" in done.stderr.lower():
        raise unittest.SkipTest(f"skipped: {done.stderr.strip()}")
    if done.returncode != 0:
        raise AssertionError(done.stderr)


class WithGateway(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = g.Scratch()
        require_renderer(cls.scratch)
        cls.gateway = g.Gateway(cls.scratch, pictures=True)

    @classmethod
    def tearDownClass(cls):
        status = cls.gateway.stop()
        cls.gateway.close()
        cls.scratch.remove()
        assert status == 0, f"the gateway ended with {status}"

    def snapshot(self, *arguments, expect=0):
        done = self.scratch.cellmirror("snapshot", "--instance", self.scratch.instance, *map(str, arguments))
        self.assertEqual(done.returncode, expect, done.stderr)
        return done

    def send(self, command):
        done = self.scratch.send(command)
        self.assertEqual(done.returncode, 0, done.stderr)

    def path(self, name):
        return self.scratch.root / name


class Pictures(WithGateway):
    def test_picture_has_the_wanted_size_and_format(self):
        self.snapshot("--size", "320x200", "-o", self.path("a.png"))
        self.assertEqual(png_size(self.path("a.png")), (320, 200))
        self.snapshot("--view", 3, "--size", "200x320", "-o", self.path("a.jpg"))
        self.assertEqual(jpeg_size(self.path("a.jpg").read_bytes()), (200, 320))
        told = json.loads(self.snapshot("--json", "-o", self.path("b.jpeg")).stdout)
        self.assertEqual((told["width"], told["height"], told["format"]), (640, 480, "jpeg"))
        self.assertLess(told["posture_age_s"], 10)
        self.assertEqual(told["bytes"], self.path("b.jpeg").stat().st_size)

    def test_camera_sees_something_else_than_the_display(self):
        self.snapshot("--camera", "CAMERA_5", "--size", "160x120", "-o", self.path("c.png"))
        self.snapshot("--view", 0, "--size", "160x120", "-o", self.path("d.png"))
        self.assertNotEqual(self.path("c.png").read_bytes(), self.path("d.png").read_bytes())

    def test_robot_that_moves_is_seen_at_its_new_place(self):
        self.send("ROBACT MANTEC_R3")
        self.send("rob_positioning jump")
        self.send("DRAW_SCENE")
        self.snapshot("--view", 0, "-o", self.path("before.png"))
        self.send("POS_ROB MANTEC_R3 JOINT_INC 40 20 10")
        self.send("DRAW_SCENE")  # done when the renderer has it
        self.snapshot("--view", 0, "-o", self.path("after.png"))
        self.assertNotEqual(self.path("before.png").read_bytes(), self.path("after.png").read_bytes())

    def test_unknown_camera_is_refused_with_the_nearest(self):
        done = self.snapshot("--camera", "CAMERA_6", "-o", self.path("x.png"), expect=1)
        self.assertIn("CAMERA_5", done.stderr)
        self.assertFalse(self.path("x.png").exists())

    def test_wrong_usage_is_told(self):
        for arguments in ([], ["-o", "a.gif"], ["-o", "a.png", "--size", "12"], ["-o", "a.png", "--size", "8x8"],
                          ["-o", "a.png", "--view", "7"], ["-o", "a.png", "--view", "1", "--camera", "CAMERA_5"],
                          ["--film", "f", "--cell", "c.toml"], ["-o", "a.png", "--quality", "0"]):
            done = self.scratch.cellmirror("snapshot", *arguments)
            self.assertEqual(done.returncode, 2, f"{arguments}: {done.stderr}")

    def test_folder_that_is_not_there_is_told(self):
        done = self.snapshot("-o", self.path("no") / "where.png", expect=1)
        self.assertIn("cannot be written", done.stderr)
        self.assertIn("name a file in a folder of yours", done.stderr)

    def test_hostile_requests_are_refused(self):
        def ask(text):
            client = socket.socket(socket.AF_UNIX)
            client.connect(str(next(self.scratch.runtime.glob(f"**/{self.scratch.instance}/control.sock"))))
            client.sendall(text.encode() + b"\n")
            out = b""
            while chunk := client.recv(65536):
                out += chunk
            client.close()
            return json.loads(out)

        for members in ('"width": 1e9', '"width": -5', '"width": "x"', '"view": 9', '"view": 0.5', '"camera": ""',
                        '"format": "gif"', '"quality": 1000', '"size": 3', '"height": 99999999999999999999',
                        '"view": 0, "camera": "CAMERA_5"'):
            answer = ask('{"request": "snapshot", %s}' % members)
            self.assertIn("error", answer, members)
        answer = ask('{"request": "snapshot", "width": 64, "height": 48, "format": "jpeg"}')
        self.assertEqual(jpeg_size(base64.b64decode(answer["data"])), (64, 48))

    def test_status_answers_while_a_large_picture_is_drawn(self):
        large = threading.Thread(target=lambda: self.snapshot("--size", "4096x3072", "-o", self.path("large.jpg")))
        large.start()
        meanwhile = 0
        while large.is_alive():
            self.scratch.status()
            meanwhile += large.is_alive()
        large.join()
        self.assertGreater(meanwhile, 0)
        self.assertEqual(jpeg_size(self.path("large.jpg").read_bytes()), (4096, 3072))

    def test_status_tells_of_the_pictures(self):
        self.snapshot("--size", "64x64", "-o", self.path("s.png"))
        pictures = self.scratch.status()["pictures"]
        self.assertTrue(pictures["on"])
        self.assertRegex(pictures["renderer"], r"OSMesa|EGL")
        self.assertEqual(pictures["problem"], "")
        self.assertGreaterEqual(pictures["on_demand"], 1)
        self.assertEqual(pictures["streams"], 0)
        self.assertGreater(pictures["draw_ms"]["p50"], 0)
        self.assertIn(pictures["renderer"], self.scratch.cellmirror("status").stdout)

    def test_updates_go_on_where_nobody_looks_and_nothing_is_drawn(self):
        before = self.scratch.status()["pictures"]
        after = g.eventually(lambda: (lambda p: p if p["updates"] > before["updates"] + 5 else None)(
            self.scratch.status()["pictures"]))
        self.assertIsNotNone(after)
        self.assertEqual(after["drawn"], before["drawn"])

    def test_film_is_a_folder_of_frames_or_one_file(self):
        self.snapshot("--film", self.path("frames"), "--seconds", 1, "--rate", 5, "--size", "160x120")
        frames = sorted(self.path("frames").glob("*.jpg"))
        self.assertEqual(len(frames), 5)
        self.assertEqual(jpeg_size(frames[0].read_bytes()), (160, 120))
        told = json.loads(self.snapshot("--film", self.path("film.mjpeg"), "--seconds", 1, "--rate", 5, "--size",
                                        "160x120", "--json").stdout)
        self.assertEqual(told["frames"], 5)
        self.assertEqual(len(re.findall(b"\xff\xd8\xff", self.path("film.mjpeg").read_bytes())), 5)

    def test_film_replaces_a_longer_one_that_was_there(self):
        for seconds, frames in ((1.2, 6), (0.6, 3)):
            self.snapshot("--film", self.path("again"), "--seconds", seconds, "--rate", 5, "--size", "64x48")
            self.assertEqual(len(list(self.path("again").glob("*.jpg"))), frames)

    def test_without_ffmpeg_a_film_becomes_frames_and_says_so(self):
        film = self.path("none.mp4")
        done = subprocess.run([g.BIN / "cellmirror", "snapshot", "--instance", self.scratch.instance, "--film", film,
                               "--seconds", "1", "--rate", "5", "--size", "161x121"],
                              env=dict(self.scratch.environment, PATH=str(self.scratch.root)), capture_output=True,
                              text=True, timeout=120)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("apt-get install ffmpeg", done.stderr)
        self.assertEqual(len(list(self.path("none.mp4.frames").glob("*.jpg"))), 5)
        self.assertFalse(film.exists())


class Films(WithGateway):
    """MP4 by a real ffmpeg, looked at with ffprobe."""

    @classmethod
    def setUpClass(cls):
        for program in ("ffmpeg", "ffprobe"):
            if shutil.which(program) is None:
                raise unittest.SkipTest(f"skipped: {program} is not installed (apt-get install ffmpeg)")
        super().setUpClass()

    def probe(self, film):
        """Codec, edges, rate and duration as the file says, and the frames that can be read from it."""
        done = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-of", "json", "-show_entries",
                               "stream=codec_name,pix_fmt,width,height,avg_frame_rate,duration,nb_read_frames", film],
                              capture_output=True, text=True, timeout=120)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        (stream,) = json.loads(done.stdout)["streams"]
        return stream

    def rgb(self, file):
        """Of all its frames, 64 x 48 pixels each: whatever cannot be played is told on stderr."""
        done = subprocess.run(["ffmpeg", "-nostdin", "-v", "error", "-i", file, "-vf", "scale=64:48:flags=area", "-pix_fmt", "rgb24",
                               "-f", "rawvideo", "-"], capture_output=True, timeout=120)
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        size = 64 * 48 * 3
        return [done.stdout[at:at + size] for at in range(0, len(done.stdout), size)]

    def difference(self, a, b):
        return sum(abs(x - y) for x, y in zip(a, b, strict=True)) / len(a)

    def on_demand(self):
        return self.scratch.status()["pictures"]["on_demand"]

    def test_mp4_has_the_frames_the_size_and_the_length_that_were_asked_for(self):
        for size, seen in (("160x120", (160, 120)), ("161x121", (160, 120))):  # H.264 of this kind wants even edges
            film = self.path("film.mp4")
            told = json.loads(self.snapshot("--film", film, "--seconds", 1.5, "--rate", 8, "--size", size, "--json").stdout)
            stream = self.probe(film)
            self.assertEqual((stream["codec_name"], stream["pix_fmt"]), ("h264", "yuv420p"))
            self.assertEqual((stream["width"], stream["height"]), seen)
            self.assertEqual((told["frames"], int(stream["nb_read_frames"])), (12, 12))
            self.assertEqual(stream["avg_frame_rate"], "8/1")
            self.assertAlmostEqual(float(stream["duration"]), 1.5, delta=0.01)

    def test_mjpeg_can_be_played(self):
        film = self.path("film.mjpeg")
        self.snapshot("--film", film, "--seconds", 1, "--rate", 5, "--size", "160x120")
        stream = self.probe(film)
        self.assertEqual((stream["codec_name"], stream["width"], stream["height"]), ("mjpeg", 160, 120))
        self.assertEqual(len(self.rgb(film)), 5)

    def test_view_sequence_is_in_the_film_that_ctrl_c_ends(self):
        self.send("STVW 0 VP 4000 -6500 3000 LP 3000 500 1000")
        self.snapshot("--view", 0, "--size", "320x240", "-o", self.path("first.png"))
        film = self.path("sequence.mp4")
        before = self.on_demand()
        taking = subprocess.Popen([g.BIN / "cellmirror", "snapshot", "--instance", self.scratch.instance, "--view", "0", "--film",
                                   film, "--seconds", "60", "--rate", "10", "--size", "320x240", "--json"],
                                  env=self.scratch.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                  start_new_session=True)
        try:
            self.assertTrue(g.eventually(lambda: self.on_demand() >= before + 3))
            self.send("STVW 0 VP 9000 -4000 4000 LP 5000 0 1000 TIME 0.5")
            self.assertTrue(g.eventually(lambda: self.scratch.status()["display"]["views"][0]["sequence"] is None))
            there = self.on_demand()
            self.assertTrue(g.eventually(lambda: self.on_demand() >= there + 3))
            os.killpg(taking.pid, signal.SIGINT)  # as a terminal does: everybody in the group gets it
            out, problem = taking.communicate(timeout=120)
        finally:
            taking.kill()
            taking.wait()
        self.assertEqual(taking.returncode, 0, problem)
        self.snapshot("--view", 0, "--size", "320x240", "-o", self.path("last.png"))
        frames = self.rgb(film)
        self.assertEqual(len(frames), json.loads(out)["frames"])
        first, last = self.rgb(self.path("first.png"))[0], self.rgb(self.path("last.png"))[0]
        self.assertGreater(self.difference(first, last), 8)
        self.assertLess(self.difference(frames[0], first), 4)  # the colours, too, are those of the picture
        self.assertLess(self.difference(frames[-1], last), 4)

    def test_what_ffmpeg_cannot_write_is_told(self):
        done = self.snapshot("--film", self.path("no") / "where.mp4", "--seconds", 1, "--size", "64x48", expect=1)
        self.assertIn("ffmpeg made no", done.stderr)
        self.assertIn("No such file or directory", done.stderr)


class WithoutPictures(unittest.TestCase):
    def run_with(self, display, *arguments, pictures=True):
        scratch = g.Scratch()
        text = scratch.cell_file.read_text()
        scratch.cell_file.write_text(text + display)
        gateway = g.Gateway(scratch, *arguments, pictures=pictures)
        self.addCleanup(scratch.remove)
        self.addCleanup(gateway.close)
        done = scratch.cellmirror("snapshot", "--instance", scratch.instance, "-o", str(scratch.root / "x.png"))
        return scratch, done

    def test_headless_refuses_and_says_so(self):
        scratch, done = self.run_with("", pictures=False)
        self.assertEqual(done.returncode, 1)
        self.assertIn("--headless", done.stderr)
        self.assertFalse(scratch.status()["pictures"]["on"])

    def test_switched_off_in_the_cell_file(self):
        _, done = self.run_with("\n[display]\non = false\n")
        self.assertEqual(done.returncode, 1)
        self.assertIn("[display]", done.stderr)

    def test_nobody_to_ask(self):
        scratch = g.Scratch()
        self.addCleanup(scratch.remove)
        done = scratch.cellmirror("snapshot", "--instance", "nobody", "-o", str(scratch.root / "x.png"))
        self.assertEqual(done.returncode, 1)
        self.assertIn("no gateway", done.stderr)


class OfCellFiles(unittest.TestCase):
    def test_every_demo_cell_has_a_picture(self):
        for cell in ("transfer_cell", "trainer", "phantom_trainer", "can_cell", "ros2_cell"):
            scratch = g.Scratch(cell, startup=True)
            self.addCleanup(scratch.remove)
            require_renderer(scratch)
            picture = scratch.root / "cell.png"
            done = scratch.cellmirror("snapshot", "--cell", str(scratch.cell_file), "--view", "0", "--size", "400x300",
                                      "-o", str(picture), "--json")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(png_size(picture), (400, 300))
            self.assertGreater(picture.stat().st_size, 5_000, "a picture of nothing")
            self.assertTrue(json.loads(done.stdout)["renderer"])


if __name__ == "__main__":
    g.main()

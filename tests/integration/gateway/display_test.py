"""What SCRIPT sets of picture, views and cameras, as the running gateway tells it: no picture is drawn here."""

import math
import os
import pty
import subprocess
import time
import unittest

import gateway as g

CAMERA = "UMG_Kamera_1"


class Display(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = g.Scratch()
        cls.gateway = g.Gateway(cls.scratch)

    @classmethod
    def tearDownClass(cls):
        status = cls.gateway.stop()
        cls.gateway.close()
        cls.scratch.remove()
        assert status == 0, status

    def done(self, *commands):
        for command in commands:
            sent = self.scratch.send(command)
            self.assertEqual(sent.returncode, 0, f"{command}: {sent.stderr}")

    def refused(self, command, *words):
        sent = self.scratch.send(command)
        self.assertEqual(sent.returncode, 1, command)
        for word in words:
            self.assertIn(word, sent.stderr, command)

    def display(self):
        return self.scratch.status()["display"]

    def view(self, number):
        return self.display()["views"][number]

    def script(self, name, text):
        (self.scratch.home / "scripts" / name).write_text(text)

    def test_the_trace_is_the_path_whatever_the_rate_of_the_pictures(self):
        """60 degrees of the first axis: an arc about the base, of which the chord is 4.5 % shorter."""
        self.done("ROBACT MANTEC_R3", "POS_ROB MANTEC_R3 JOINT_INC 0 30 0 0 0 0", "SET_MODE SMEAR on",
                  "POS_ROB MANTEC_R3 JOINT_INC 60 0 0 0 0 0")

        def trace():
            traces = self.scratch.status()["pictures"]["traces"]
            return next((one for one in traces if one["robot"] == "MANTEC_R3"), None)

        pose = self.scratch.robot("MANTEC_R3")["tcp"]["position_m"]
        arc = math.hypot(pose[0] - 2.0, pose[1] + 1.6) * math.pi / 3  # the base stands at 2.0, -1.6
        self.assertGreater(arc, 0.3)
        self.assertTrue(g.eventually(lambda: trace() and abs(trace()["length_m"] - arc) < 0.002 * arc), (trace(), arc))
        self.assertGreaterEqual(trace()["frames"], 5)
        self.done("SET_MODE SMEAR off")
        self.assertTrue(g.eventually(lambda: trace() is None))
        self.done("POS_ROB MANTEC_R3 JOINT_INC -60 -30 0 0 0 0")

    def test_every_mode_is_switched_and_told(self):
        before = self.display()["modes"]
        others = [mode for mode in before if mode not in ("FLDR", "SHAD")]
        self.script("turn.spt", ";\n".join(f"SET_MODE {mode} {'off' if before[mode] else 'on'}" for mode in others))
        self.script("back.spt", ";\n".join(f"SET_MODE {mode} {'on' if before[mode] else 'off'}" for mode in others))
        self.done("EXEC_SCRIPT turn")
        turned = {mode: on if mode in ("FLDR", "SHAD") else not on for mode, on in before.items()}
        self.assertTrue(g.eventually(lambda: self.display()["modes"] == turned))
        self.done("EXEC_SCRIPT back")
        self.assertTrue(g.eventually(lambda: self.display()["modes"] == before))
        self.done("SHAD off", "FLDR off")
        self.refused("SHAD on", "floor", "FLDR on")
        self.refused("SET_MODE SHAD on", "floor")
        self.done("FLDR on", "SHAD on", "BFRM on")
        modes = self.display()["modes"]
        self.assertTrue(modes["FLDR"] and modes["SHAD"] and modes["BFRM"])
        self.done("BFRM off", "SET_MODE LEGEND off")
        self.assertFalse(self.display()["legend"])
        self.done("SET_MODE LEGEND on")

    def test_wait_waits_for_views_on_their_way(self):
        self.script("way.spt", "STVW 0 VP 5000 -9000 3000 LP 5000 0 1000;\nSTVW 0 VP 9000 -9000 3000 TIME 1.0;\n"
                               "STVW 6 TW 30 STEPS 20;\nWAIT;\nhot_message arrived;\n")
        begin = time.monotonic()
        self.done("EXEC_SCRIPT way")
        self.assertTrue(g.eventually(lambda: [m for m in self.scratch.status()["messages"] if m["text"] == "arrived"]))
        self.assertGreater(time.monotonic() - begin, 1.0, "it did not wait")
        view = self.view(0)
        self.assertIsNone(view["sequence"])
        self.assertIsNone(self.view(6)["sequence"])
        self.assertEqual(view["viewpoint_m"], [9.0, -9.0, 3.0])
        self.assertAlmostEqual(self.view(6)["twist_rad"], math.radians(30))
        self.done("STVW 6 TW 0")

    def test_views_are_saved_and_loaded_and_their_files_checked(self):
        self.done("STDP 5 FULL", "STVW 3 VP 1000 2000 30000 LP 1000 2000 0 VA 25", f"COVW 2 {CAMERA}", "SAVE_VIEWS mine")
        saved = self.display()
        file = self.scratch.home / "scripts" / "mine.vws"
        checked = self.scratch.cellmirror("check", file, "--cell", self.scratch.cell_file)
        self.assertEqual(checked.returncode, 0, checked.stderr)
        self.done("STDP 1", "STVW 3 VP 0 0 9000", "STVW 2 TW 10", "LOAD_VIEWS mine.vws")
        loaded = self.display()
        for number in range(7):
            self.assertEqual(loaded["views"][number], saved["views"][number])
        self.assertEqual((loaded["display"], loaded["full_screen"]), (5, True))
        file.write_text(file.read_text().replace(CAMERA, "UMG_Kamera_2").replace("near_m", "near_mm", 1))
        self.refused("LOAD_VIEWS mine", "mine.vws:")
        checked = self.scratch.cellmirror("check", file)
        self.assertEqual(checked.returncode, 1)
        self.assertIn("near_m = ", checked.stderr)
        self.refused("SAVE_VIEWS startup.spt", ".vws")
        self.refused("SAVE_VIEWS ../mine", "file name")
        self.refused("LOAD_VIEWS nothing", "does not exist")
        self.done("STDP 1", "STVW 2 TW 0")
        for name in ("overview", "trs_demo", "view1"):
            self.done(f"LOAD_VIEWS {name}")

    def test_draw_modes_cameras_and_arcs(self):
        self.done("SET_FRAME Testlab_1.FL_Klein RENDER 2", "SET_ABSTRACT Testlab_1 RENDER 20", "SET_FRAME Toolbox RENDER 3",
                  "TAG_DRAWLEN 50", f"CAM_TRACKING {CAMERA} on Gantry.J_2.Hand", f"CAM_VIEW_PYRAMID {CAMERA} on",
                  "CAM_ONLINE CAMERA_5 on", f"COVW 0 {CAMERA}", "ROBACT PUMA_762", "ARC on")
        display = self.display()
        self.assertEqual([(rule["node"], rule["with_details"], rule["mode"]) for rule in display["draw_modes"]],
                         [("Testlab_1", True, "transparent"), ("Toolbox", False, "flat")])
        self.assertAlmostEqual(display["tag_length_m"], 0.05)
        cameras = {camera["id"]: camera for camera in display["cameras"]}
        self.assertTrue(cameras[CAMERA]["tracks"].endswith("Hand"))
        self.assertTrue(cameras[CAMERA]["pyramid"] and cameras["CAMERA_5"]["online"] and not cameras[CAMERA]["online"])
        self.assertEqual(display["views"][0]["camera"], CAMERA)
        self.assertEqual(display["arcs"], ["PUMA_762"])
        table = self.scratch.cellmirror("status").stdout
        for words in (f"view 0 at the camera {CAMERA}", "tracks ", "Testlab_1 and its details drawn transparent", "arc at PUMA_762"):
            self.assertIn(words, table)
        self.refused(f"CAM_TRACKING {CAMERA} on {CAMERA}", "itself")
        self.refused("COVW 0 CAMERA_6", "CAMERA_5")
        self.done("ARC off", f"CAM_TRACKING {CAMERA} off", f"CAM_VIEW_PYRAMID {CAMERA} off", "CAM_ONLINE CAMERA_5 off", "STVW 0 TW 0")
        self.assertIsNone(self.view(0)["camera"])


class Bell(unittest.TestCase):
    def test_messages_ring_at_the_terminal_of_the_gateway_while_beep_is_on(self):
        scratch = g.Scratch()
        ours, theirs = pty.openpty()
        gateway = subprocess.Popen(
            [g.BIN / "cellmirror", "run", scratch.cell_file, "--no-web", "--headless", "--instance", scratch.instance],
            env=scratch.environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=theirs)
        try:
            self.assertTrue(g.eventually(lambda: scratch.cellmirror("status").returncode == 0))
            self.assertEqual(scratch.send("hot_message quiet").returncode, 0)
            self.assertEqual(scratch.send("SET_MODE BEEP on").returncode, 0)
            self.assertEqual(scratch.send("hot_message loud").returncode, 0)
            heard = b""
            while b"loud" not in heard or b"\a" not in heard:
                heard += os.read(ours, 4096)
            self.assertEqual(heard.count(b"\a"), 1)
        finally:
            gateway.terminate()
            gateway.wait(60)
            os.close(ours)
            os.close(theirs)
            scratch.remove()


if __name__ == "__main__":
    g.main()

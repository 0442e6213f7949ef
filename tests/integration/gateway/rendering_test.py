"""Every command and mode of the picture (manual 1.2.1, 1.2.3, 1.2.4, 1.2.6) through the running gateway: the picture changes
where it should, and comes back when the command is taken back."""

import base64
import time
import unittest

import control
import gateway as g
import pictures as p

WIDTH, HEIGHT = 320, 240
ARM = "STVW 0 VP 4600 -4600 1700 LP 2000 -1600 900 TW 0 VA 40 FCP 50 BCP 100000"  # MANTEC_R3 fills the picture
DEFAULTS = {"WFRM_display": False, "SMEAR": False, "BFRM": False, "CPU_BFRM": False, "CAM_MAINVIEW": False,
            "LGT_TWOSIDE": False, "TCP_DRAW": False, "ZPF_DRAW": False, "FLDR": True, "GEO_VIS_TEST": True, "SHAD": True,
            "BEEP": False, "TEXTURES": True, "ANTIALIAS": True, "LEGEND": True}


def is_axis(red, green, blue):
    """The colour of an axis of a frame: far from grey."""
    return max(red, green, blue) - min(red, green, blue) > 90


class Rendering(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = g.Scratch()
        cls.gateway = g.Gateway(cls.scratch, pictures=True)
        cls.file = cls.scratch.root / "picture.png"
        done = cls.scratch.cellmirror("snapshot", "--instance", cls.scratch.instance, "-o", str(cls.file))
        if done.returncode != 0:
            cls.close()
            raise unittest.SkipTest(f"skipped: no picture can be drawn here: {done.stderr.strip()}")
        cls.send("STDP 1 FULL_OFF", "SAVE_VIEWS at_first.vws")

    @classmethod
    def tearDownClass(cls):
        cls.close()

    @classmethod
    def close(cls):
        cls.gateway.close()
        cls.scratch.remove()

    @classmethod
    def send(cls, *commands):
        for command in commands:
            done = cls.scratch.send(command)
            if done.returncode != 0:
                raise AssertionError(f"{command}: {done.stderr}")

    def setUp(self):
        self.send("LOAD_VIEWS at_first.vws", "STDP 1 FULL_OFF")

    def tearDown(self):
        self.send(*(f"SET_MODE {mode} {'on' if on else 'off'}" for mode, on in DEFAULTS.items()))

    def picture(self, *options):
        """As `cellmirror snapshot`, which pictures_test tries, asks for it."""
        wanted = dict(zip((option.removeprefix("--") for option in options[0::2]), options[1::2]))
        answer = control.ask(self.scratch.gateway_folder(), request="snapshot", width=WIDTH, height=HEIGHT, format="png", **wanted)
        self.file.write_bytes(base64.b64decode(answer["data"]))
        return p.read_png(self.file)

    def settled(self, *options):
        """The picture of what was commanded: the renderer has it all."""
        self.send("DRAW_SCENE")
        return self.picture(*options)

    def after(self, *commands, options=(), before, at_least=0.001, threshold=12):
        """The picture once it differs from the one before."""
        self.send(*commands)
        kept = []

        def differs():
            kept[:] = [self.picture(*options)]
            return p.difference(before, kept[0], threshold) >= at_least

        self.assertTrue(g.eventually(differs, every=0.1), f"{commands[-1]} changes nothing")
        return kept[0]

    def back(self, *commands, options=(), to, at_most=0.001):
        """The picture is again as it was."""
        self.send(*commands)
        last = []

        def same():
            last[:] = [p.difference(to, self.picture(*options))]
            return last[0] <= at_most

        self.assertTrue(g.eventually(same, every=0.1), f"after {commands[-1]} {last[0]:.4f} of the picture differ")

    def test_nothing_moves_so_no_pixel_changes(self):
        first = self.settled("--view", "0")
        self.assertGreater(first.colours(), 50, "there is something to see")
        self.assertEqual(p.difference(first, self.picture("--view", "0"), 0), 0)
        self.send("DRAW_SCENE")
        self.assertEqual(p.difference(first, self.picture("--view", "0"), 0), 0)

    def test_the_six_layouts_are_six_pictures(self):
        self.send("SET_MODE LEGEND off")
        layouts = []
        for display in range(1, 7):
            self.send(f"STDP {display} FULL_OFF")
            layouts.append(self.settled())
        for i, one in enumerate(layouts):
            for other in layouts[:i]:
                self.assertGreater(p.difference(one, other), 0.05)
        # Top + side: two views, of which each alone is one picture of the others' kind.
        self.assertGreater(p.difference(layouts[1].box(0, 0, 0.5), layouts[1].box(0.5, 0, 1)), 0.05)
        titled = layouts[0]
        self.back("STDP 1 FULL_OFF", to=titled)
        self.after("STDP 1 FULL", before=titled, at_least=0.0001)

    def test_each_parameter_of_a_view(self):
        self.send("SET_MODE LEGEND off", ARM)
        at_first = self.settled("--view", "0")
        view = ("--view", "0")
        self.after("STVW 0 VP 4600 -3000 2500", options=view, before=at_first, at_least=0.1)
        self.back(ARM, options=view, to=at_first)
        self.after("STVW 0 LP 2000 -1600 200", options=view, before=at_first, at_least=0.1)
        self.back(ARM, options=view, to=at_first)
        turned = self.after("STVW 0 TW 180", options=view, before=at_first, at_least=0.1)
        self.assertLess(p.difference(turned.turned_round(), at_first), 0.3 * p.difference(turned, at_first))
        self.back(ARM, options=view, to=at_first)
        near = self.after("STVW 0 VA 15", options=view, before=at_first, at_least=0.1)
        self.back(ARM, options=view, to=at_first)
        wide = self.after("STVW 0 VA 80", options=view, before=at_first, at_least=0.1)
        self.assertGreater(p.difference(near, wide), 0.1)
        cut = self.after("STVW 0 VA 40 FCP 90000", options=view, before=at_first, at_least=0.1)
        self.assertLess(cut.colours(), at_first.colours(), "all of it is nearer than the front clipping plane")
        self.back(ARM, options=view, to=at_first)
        short = self.after("STVW 0 BCP 500", options=view, before=at_first, at_least=0.1)
        self.assertLess(short.colours(), at_first.colours(), "all of it is behind the back clipping plane")

    def test_a_view_on_its_way_by_time_and_by_steps(self):
        self.send(ARM)
        view, far = ("--view", "0"), "STVW 0 VP -4600 -6000 3500 LP 4000 0 900"
        start = self.settled(*view)
        end = self.after(far, options=view, before=start, at_least=0.1)
        for pace in ("TIME 6", "STEPS 120"):
            self.back(ARM, options=view, to=start)
            self.send(f"{far} {pace}")
            between = self.after(options=view, before=start, at_least=0.05, *("DRAW_SCENE",))
            self.assertGreater(p.difference(between, end), 0.02, pace)
            self.assertTrue(g.eventually(lambda: p.difference(end, self.picture(*view)) < 0.001, every=0.1), pace)

    def test_a_script_waits_for_a_view_sequence(self):
        (self.scratch.home / "scripts" / "way.spt").write_text(
            f"{ARM};\nSTVW 0 VP -4600 -6000 3500 TIME 1.5;\nWAIT;\nSET_MODE LEGEND off\n")
        begin = time.monotonic()
        self.send("EXEC_SCRIPT way.spt")
        self.assertTrue(g.eventually(lambda: self.scratch.status()["script"]["running"] == 0))
        self.assertGreater(time.monotonic() - begin, 1.0)

    def test_a_view_at_a_camera_and_the_main_view(self):
        self.send("SET_MODE LEGEND off")
        seen = self.settled("--camera", "CAMERA_5")
        own = self.settled("--view", "0")
        self.assertGreater(p.difference(seen, own), 0.1)
        bound = self.after("COVW 0 CAMERA_5", options=("--view", "0"), before=own, at_least=0.1)
        self.assertLess(p.difference(bound, seen), 0.03)
        display = self.settled()
        self.send("LOAD_VIEWS at_first.vws", "STDP 1 FULL_OFF")
        self.after("SET_CAMPAR CAMERA_5 4.85 15.471", "SET_MODE CAM_MAINVIEW on", before=own, at_least=0.1)
        self.assertLess(p.difference(self.picture(), display), 0.1)

    def test_parameters_of_cameras(self):
        self.send("SET_MODE LEGEND off")
        camera = ("--camera", "CAMERA_5")
        at_first = self.settled(*camera)
        self.after("SET_CAMPAR CAMERA_5 4.85 40", options=camera, before=at_first, at_least=0.1)
        tracked = self.after("CAM_TRACKING CAMERA_5 on Mantec_3.HAND", options=camera, before=at_first, at_least=0.1)
        self.assertGreater(tracked.colours(), 20)
        self.send("CAM_TRACKING CAMERA_5 off")
        self.back("SET_CAMPAR CAMERA_5 4.85 15.46986", options=camera, to=at_first, at_most=0.02)
        self.send("CAM_ONLINE CAMERA_5 on")
        self.back("CAM_ONLINE CAMERA_5 off", options=camera, to=at_first, at_most=0.02)

    def test_the_pyramid_of_a_camera(self):
        self.send("STVW 0 VP 16000 -9000 6000 LP 8500 -2000 1000 VA 40")
        view = ("--view", "0")
        at_first = self.settled(*view)
        shown = self.after("CAM_VIEW_PYRAMID CAMERA_5 on", options=view, before=at_first, at_least=0.002)
        left, top, right, bottom = p.changed_box(at_first, shown)
        self.assertLess(right - left, 0.9)
        self.after("SET_CAMPAR CAMERA_5 2.0 30", options=view, before=shown, at_least=0.001)
        self.send("SET_CAMPAR CAMERA_5 4.85 15.46986")
        self.back("CAM_VIEW_PYRAMID CAMERA_5 off", options=view, to=at_first)

    def test_views_are_saved_and_loaded(self):
        self.send(ARM)
        view = ("--view", "0")
        at_first = self.settled(*view)
        self.send("SAVE_VIEWS arm.vws")
        self.after("STVW 0 VP 9000 -9000 9000", options=view, before=at_first, at_least=0.1)
        self.back("LOAD_VIEWS arm.vws", options=view, to=at_first)

    def test_rendering_of_frames_and_branches(self):
        self.send("SET_MODE LEGEND off", ARM)
        view = ("--view", "0")
        gouraud = self.settled(*view)
        pictures = {}
        for mode, least, threshold in ((2, 0.02, 12), (3, 0.004, 3), (20, 0.02, 12)):  # flat: facets differ slightly
            pictures[mode] = self.after(f"SET_ABSTRACT Mantec_2 RENDER {mode}", options=view, before=gouraud,
                                        at_least=least, threshold=threshold)
            centre = p.changed_centre(gouraud, pictures[mode], threshold)
            self.assertTrue(all(0.2 < c < 0.8 for c in centre), (mode, centre))
            self.back("SET_ABSTRACT Mantec_2 RENDER 4", options=view, to=gouraud)
        self.assertGreater(p.difference(pictures[2], pictures[20]), 0.01)
        one = self.after("SET_FRAME Mantec_2.J_1 RENDER 2", options=view, before=gouraud, at_least=0.001)
        self.assertLess(p.difference(gouraud, one), p.difference(gouraud, pictures[2]), "only its own geometry")
        self.back("SET_FRAME Mantec_2.J_1 RENDER 4", options=view, to=gouraud)

    def test_workframes_and_their_length(self):
        self.send("SET_MODE LEGEND off", "STVW 0 VP 3500 -1500 3000 LP 600 1600 300 VA 40")
        view = ("--view", "0")
        plain = self.settled(*view)
        shown = self.after("SET_MODE WFRM_display on", options=view, before=plain, at_least=0.001)
        self.assertGreater(shown.share(is_axis), plain.share(is_axis))
        longer = self.after("TAG_DRAWLEN 1000", options=view, before=shown, at_least=0.001)
        self.assertGreater(longer.share(is_axis), shown.share(is_axis))
        self.back("TAG_DRAWLEN 250", options=view, to=shown)
        self.back("SET_MODE WFRM_display off", options=view, to=plain)

    def test_frames_of_the_active_robot(self):
        self.send("SET_MODE LEGEND off", ARM, "ROBACT MANTEC_R3")
        view = ("--view", "0")
        plain = self.settled(*view)
        boxes = []
        for mode in ("TCP_DRAW", "ZPF_DRAW"):
            shown = self.after(f"SET_MODE {mode} on", options=view, before=plain, at_least=0.0005)
            self.assertGreaterEqual(shown.share(is_axis), plain.share(is_axis), mode)
            boxes.append(p.changed_centre(plain, shown))
            self.back(f"SET_MODE {mode} off", options=view, to=plain)
        self.assertGreater(abs(boxes[0][1] - boxes[1][1]) + abs(boxes[0][0] - boxes[1][0]), 0.03, "they are not the same")

    def test_the_trace_of_the_tcp(self):
        self.send("SET_MODE LEGEND off", ARM, "ROBACT MANTEC_R3")
        view = ("--view", "0")
        plain = self.settled(*view)
        # A trace grows whether anybody looks or not: no picture is taken until the robot is back.
        self.send("SET_MODE SMEAR on", "POS_ROB MANTEC_R3 JOINT_INC 60 30 0 0 0 0", "POS_ROB MANTEC_R3 JOINT_INC -60 -30 0 0 0 0")
        traced = self.after("DRAW_SCENE", options=view, before=plain, at_least=0.001)
        self.assertGreater(p.difference(plain, traced), 0.001)
        self.back("SET_MODE SMEAR off", options=view, to=plain, at_most=0.01)

    def test_floor_shadow_textures(self):
        self.send("SET_MODE LEGEND off", ARM)
        view = ("--view", "0")
        full = self.settled(*view)
        for command in ("SHAD", "FLDR"):
            self.after(f"{command} off", options=view, before=full, at_least=0.001)
            self.back("FLDR on", "SHAD on", options=view, to=full)
        self.send("STVW 0 VP -3000 -14000 9000 LP 5000 0 0 VA 50")
        full = self.settled(*view)
        self.after("SET_MODE TEXTURES off", options=view, before=full, at_least=0.05, threshold=3)  # pale tiles
        self.back("SET_MODE TEXTURES on", options=view, to=full)

    def test_antialiasing_smooths_edges(self):
        self.send("SET_MODE LEGEND off", ARM)
        view = ("--view", "0")
        smooth = self.settled(*view)
        self.after("SET_MODE ANTIALIAS off", options=view, before=smooth, at_least=0.002)
        self.back("SET_MODE ANTIALIAS on", options=view, to=smooth)

    def test_backfaces_seen_from_inside(self):
        # From within the cupboard: its walls, or through them.
        self.send("SET_MODE LEGEND off", "STVW 0 VP 10500 3400 900 LP 5000 0 900 TW 0 VA 60 FCP 20 BCP 100000")
        view = ("--view", "0")
        inside = self.settled(*view)
        through = self.after("BFRM on", options=view, before=inside, at_least=0.2)
        self.back("BFRM off", options=view, to=inside)
        by_cpu = self.after("SET_MODE CPU_BFRM on", options=view, before=inside, at_least=0.2)
        self.assertLess(p.difference(through, by_cpu), 0.05, "both ways show the same")
        self.back("SET_MODE CPU_BFRM off", options=view, to=inside)
        self.after("SET_MODE LGT_TWOSIDE on", options=view, before=inside, at_least=0.1, threshold=2)
        self.back("SET_MODE LGT_TWOSIDE off", options=view, to=inside)

    def test_modes_that_change_no_picture(self):
        self.send(ARM)
        view = ("--view", "0")
        at_first = self.settled(*view)
        for mode, on in (("GEO_VIS_TEST", False), ("GEO_VIS_TEST", True), ("BEEP", True), ("BEEP", False)):
            self.send(f"SET_MODE {mode} {'on' if on else 'off'}")
            self.assertLess(p.difference(at_first, self.settled(*view)), 0.0005, mode)

    def test_the_legend_is_in_its_corner(self):
        plain = self.settled()
        with_legend = self.after("SET_USSPAR active USS_1B 1", before=plain, at_least=0.02)  # a cone is to be explained
        without = self.after("SET_MODE LEGEND off", before=with_legend, at_least=0.001)
        left, top, right, bottom = p.changed_box(with_legend, without)
        self.assertLess((right - left) * (bottom - top), 0.3)
        self.send("SET_USSPAR active USS_1B 0")

    def test_the_spark_of_a_welding_robot_is_at_its_tcp(self):
        self.send("SET_MODE LEGEND off", "ROBACT MANTEC_R3")
        x, y, z = (1000 * c for c in self.scratch.robot("MANTEC_R3")["tcp"]["position_m"])
        self.send(f"STVW 0 VP {x + 800:.0f} {y - 1500:.0f} {z + 500:.0f} LP {x:.0f} {y:.0f} {z:.0f} VA 40")
        view = ("--view", "0")
        dark = self.settled(*view)
        lit = self.after("ARC on", options=view, before=dark, at_least=0.001)
        centre = p.changed_centre(dark, lit)
        self.assertTrue(all(0.35 < c < 0.65 for c in centre), centre)
        self.back("ARC off", options=view, to=dark)

    def test_force_arrows(self):
        # Stretched out, or the arm would hide the forces that run along it.
        self.send("SET_MODE LEGEND off", ARM, "ROBACT MANTEC_R3", "POS_ROB MANTEC_R3 JOINT_ABS 40 70 10 0 0 0")
        view = ("--view", "0")
        plain = self.settled(*view)
        forces = self.after("SET_FORCE_ARROW 4 0 0", options=view, before=plain, at_least=0.0005)
        torques = self.after("SET_FORCE_ARROW 0 4 0", options=view, before=forces, at_least=0.0005)
        self.assertGreater(p.difference(plain, torques), 0.0005)
        both = self.after("SET_FORCE_ARROW 4 4 0", options=view, before=torques, at_least=0.0005)
        self.after("SET_FRC_ARR_SPECIAL on", options=view, before=both, at_least=0.0003)
        self.send("SET_FRC_ARR_SPECIAL off")
        self.back("SET_FORCE_ARROW 0 0 0", options=view, to=plain)
        self.send("POS_ROB MANTEC_R3 JOINT_ABS 0 0 0 0 0 0")

    def test_a_message_is_shown_for_a_while(self):
        self.send(ARM)
        plain = self.settled()
        shown = self.after("hot_message The flange is loose", before=plain, at_least=0.001)
        left, top, right, bottom = p.changed_box(plain, shown)
        self.assertLess((right - left) * (bottom - top), 0.5)
        begin = time.monotonic()
        self.assertTrue(g.eventually(lambda: p.difference(plain, self.picture()) < 0.001, every=0.2))
        self.assertLess(time.monotonic() - begin, 30)


LAYOUT = """format = 1
[[view]]
id = 5
name = "gate"
seen_from = [1, 0, 0.2]
[[display]]
id = 2
name = "gate and plan"
pane = [{ view = 5, area = [0, 0, 0.5, 1] }, { view = 3, area = [0.5, 0, 0.5, 0.5] }]
"""


class Layout(unittest.TestCase):
    """A cell with a layout file (.lay)."""

    def setUp(self):
        self.scratch = g.Scratch()
        self.addCleanup(self.scratch.remove)
        (self.scratch.home / "mine.lay").write_text(LAYOUT)
        self.text = self.scratch.cell_file.read_text()
        self.scratch.cell_file.write_text(self.text + '[display]\nlayout_file = "mine.lay"\n')

    def start(self):
        gateway = g.Gateway(self.scratch, pictures=True)
        self.addCleanup(gateway.close)
        return gateway

    def picture(self, size, *options):
        file = self.scratch.root / "picture.png"
        done = self.scratch.cellmirror("snapshot", *options, "-o", str(file), "--size", size)
        if done.returncode != 0 and "renderer" in done.stderr.lower():
            raise unittest.SkipTest(f"skipped: no picture can be drawn here: {done.stderr.strip()}")
        self.assertEqual(done.returncode, 0, done.stderr)
        return p.read_png(file)

    def test_displays_show_the_views_where_and_as_the_file_says(self):
        self.start()
        for command in ("SET_MODE LEGEND off", "STDP 2"):
            self.assertEqual(self.scratch.send(command).returncode, 0)
        running = ("--instance", self.scratch.instance)
        whole = self.picture("480x360", *running)
        for box, view, size in (((0, 0, 0.5, 1), "5", "240x360"), ((0.5, 0, 1, 0.5), "3", "240x180")):
            alone = self.picture(size, *running, "--view", view)
            self.assertLess(p.difference(whole.box(*box), alone), 0.05)  # but for the title and the border
            self.assertGreater(alone.colours(), 20)
        self.assertEqual(whole.box(0.52, 0.52, 0.98, 0.98).colours(), 1, "what no pane covers is grey")
        display = self.scratch.status()["display"]
        self.assertEqual((display["views"][5]["name"], display["views"][5]["projection"]), ("gate", "perspective"))
        self.assertEqual(display["displays"][1], {"id": 2, "name": "gate and plan", "panes": [
            {"view": 5, "area": [0, 0, 0.5, 1]}, {"view": 3, "area": [0.5, 0, 0.5, 0.5]}]})
        # Without a gateway the views stand in the same place.
        at_rest = self.picture("240x360", "--cell", str(self.scratch.cell_file), "--view", "5")
        self.assertLess(p.difference(at_rest, self.picture("240x360", *running, "--view", "5")), 0.05)

    def test_a_faulty_file_starts_nothing_and_is_told_whole(self):
        (self.scratch.home / "mine.lay").write_text(LAYOUT + "[[display]]\nid = 9\n[[view]]\nid = 8\n")
        done = self.scratch.cellmirror("run", str(self.scratch.cell_file), "--headless", "--no-web", "--for", "1",
                                       "--instance", self.scratch.instance, instance=False)
        self.assertEqual(done.returncode, 1)
        for word in ("mine.lay:11:6: error: display 2: id is 9", "mine.lay:13:6: error: view 2: id is 8", "nothing was started"):
            self.assertIn(word, done.stderr)
        checked = self.scratch.cellmirror("check", str(self.scratch.home / "mine.lay"))
        self.assertEqual(checked.returncode, 1)
        self.assertIn("mine.lay:13:6", checked.stderr)


if __name__ == "__main__":
    g.main()

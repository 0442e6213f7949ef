"""Voxel volumes in a running gateway: what SCRIPT sets is in force, reported and seen; what is refused says why."""

import json
import re
import sys
import unittest
import urllib.request

import gateway as g
import pictures as p

sys.path.insert(0, str(g.SOURCE / "tests" / "integration" / "web"))
import page_client  # noqa: E402: its folder is known only now

NAME = "Table.Phantom"
TABLE = """# value red green blue opacity
-1000 0 0 0 0
100 0 0 0 0
200 0 1 0 1
3000 0 1 0 1
"""


def require_renderer(scratch):
    done = scratch.cellmirror("snapshot", "--cell", str(scratch.cell_file), "--size", "16x16", "-o",
                              str(scratch.root / "probe.png"))
    if done.returncode != 0 and "renderer" in done.stderr.lower():
        raise unittest.SkipTest(f"skipped: {done.stderr.strip()}")
    if done.returncode != 0:
        raise AssertionError(done.stderr)


class Volumes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = g.Scratch("volume_cell")
        for table in (1, 2):
            (cls.scratch.home / "envlib" / f"USER{table}_LUT.lut").unlink(missing_ok=True)
        require_renderer(cls.scratch)
        cls.gateway = g.Gateway(cls.scratch, pictures=True, page=True)
        cls.count = 0

    @classmethod
    def tearDownClass(cls):
        status = cls.gateway.stop()
        cls.gateway.close()
        cls.scratch.remove()
        assert status == 0, f"the gateway ended with {status}"

    def do(self, *commands):
        for command in commands:
            done = self.scratch.send(command)
            self.assertEqual(done.returncode, 0, f"{command}: {done.stderr}")
        return done.stdout.strip()

    def refused(self, command):
        done = self.scratch.send(command)
        self.assertEqual(done.returncode, 1, f"{command}: {done.stdout}")
        return done.stderr

    def volume(self):
        """As the status has it; commands are answered before their effect is published, by some milliseconds."""
        self.do("DRAW_SCENE")
        return next(volume for volume in self.scratch.status()["volumes"] if volume["name"] == NAME)

    def picture(self):
        self.do("DRAW_SCENE")
        type(self).count += 1
        path = self.scratch.root / f"{self.count}.png"
        done = self.scratch.cellmirror("snapshot", "--instance", self.scratch.instance, "--camera", "SCAN_VIEW", "--size",
                                       "320x240", "-o", str(path))
        self.assertEqual(done.returncode, 0, done.stderr)
        return p.read_png(path)

    def setUp(self):
        self.do("VV_ISO off", "VV_SET_LUT MEDICAL_LUT", "VV_SET_LUT_PAR MEDICAL_LUT 0 0.05 0.3 1", *(f"VV_CLIP CLP{i} off" for i in range(1, 7)))

    def test_what_is_set_is_reported_in_si(self):
        self.assertEqual(self.volume()["table"], "MEDICAL_LUT")
        self.do("VV_SET_LUT EXP_LUT", "VV_SET_LUT_PAR EXP_LUT 2 3 1.5 1", "VV_CLIP CLP2 reverse Phantom", f"VV_CLIP CLP2 visible {NAME}",
                "VV_CLIP_POS CLP2 DIST -12.5 ELE 90 AZI 0")
        volume = self.volume()
        self.assertEqual(volume["table"], "EXP_LUT")
        self.assertEqual(volume["parameters"]["EXP_LUT"], {"opacity": 2, "gain": 3, "level": 1.5, "window": 1})
        plane = volume["planes"][1]
        self.assertEqual((plane["side"], plane["framed"]), ("reverse", True))
        self.assertAlmostEqual(plane["distance_m"], -0.0125)
        self.assertAlmostEqual(plane["elevation_rad"], 1.5707963267948966)
        table = self.scratch.cellmirror("status").stdout
        self.assertRegex(table, r"volume Table\.Phantom: 112 x 88 x 96 voxels of 3 x 2\.5 x 3 mm")
        self.assertIn("CLP2 reverse, visible: ELE 90 AZI 0 DIST -12.5 mm", table)

    def test_tables_and_planes_are_seen_and_can_be_taken_back(self):
        before = self.picture()
        self.do("VV_SET_LUT RAINBOW_LUT")
        self.assertGreater(p.difference(before, self.picture()), 0.02)
        self.do("VV_SET_LUT MEDICAL_LUT")
        self.assertLess(p.difference(before, self.picture()), 0.001)
        self.do("VV_SET_LUT_PAR MEDICAL_LUT 0 0 0 0")
        empty = self.picture()
        self.assertGreater(p.difference(before, empty), 0.02)
        self.do("VV_SET_LUT_PAR MEDICAL_LUT 0 0.05 0.3 1", "VV_CLIP_POS CLP1 ELE 0 AZI 0 DIST -1000", "VV_CLIP CLP1 active")
        self.assertLess(p.difference(empty, self.picture()), 0.001, "a plane that hides everything")
        self.do("VV_CLIP CLP1 reverse")
        self.assertLess(p.difference(before, self.picture()), 0.001, "the other side is all of it")
        self.do("VV_CLIP_POS CLP1 ELE 0 AZI 0 DIST 0")
        half = self.picture()
        self.assertGreater(p.difference(before, half), 0.01)
        self.do("VV_CLIP CLP1 off", "VV_CLIP_POS CLP1 ELE 0 AZI 0 DIST 0", "VV_CLIP CLP1 visible")
        self.assertGreater(p.difference(before, self.picture()), 0.001, "an outline")

    def test_a_surface_in_place_of_the_table(self):
        before = self.picture()
        self.do("VV_ISO on VALUE 500")
        self.assertTrue(self.volume()["isosurface"])
        bone = self.picture()
        self.assertGreater(p.difference(before, bone), 0.01)
        self.do(f"VV_ISO on VALUE -300 {NAME}")
        self.assertGreater(p.difference(bone, self.picture()), 0.02, "the skin")
        self.do("VV_ISO off")
        self.assertLess(p.difference(before, self.picture()), 0.001)

    def test_a_volume_is_hidden_and_moves_with_its_component(self):
        before = self.picture()
        self.do(f"DEACTIVATE {NAME}")
        self.assertFalse(self.volume()["shown"])
        hidden = self.picture()
        self.assertGreater(p.difference(before, hidden), 0.02)
        self.do("VV_SET_LUT RAINBOW_LUT")
        self.assertLess(p.difference(hidden, self.picture()), 0.001)
        self.do("VV_SET_LUT MEDICAL_LUT", f"ACTIVATE {NAME}")
        self.assertLess(p.difference(before, self.picture()), 0.001)
        self.do(f"SET_FRAME {NAME} PLACEMENT -90 0 0 100 0 115")
        moved = self.picture()
        self.assertGreater(p.difference(before, moved), 0.02)
        self.do(f"SET_FRAME {NAME} PLACEMENT -90 0 0 0 0 115")
        self.assertLess(p.difference(before, self.picture()), 0.001)

    def test_tables_of_users_are_read_again(self):
        file = self.scratch.home / "envlib" / "USER1_LUT.lut"
        self.assertIn("no envlib/USER1_LUT.lut", self.do("VV_SET_LUT USER1_LUT"))
        self.assertIn("neither envlib/USER1_LUT.lut nor envlib/USER2_LUT.lut", self.do("VV_RELOAD_LUTS"))
        without = self.picture()
        file.write_text(TABLE)
        self.assertLess(p.difference(without, self.picture()), 0.001, "not read before it is asked for")
        self.assertEqual(self.do("VV_RELOAD_LUTS"), "done")
        self.assertEqual(self.volume()["user_tables"], ["USER1_LUT"])
        green = self.picture()
        self.assertGreater(green.share(lambda r, g, b: g > r + 30 and g > b + 30), 0.01)
        file.write_text(TABLE + "2000 0 0 0 0\n")
        self.assertRegex(self.refused("VV_RELOAD_LUTS"), r"USER1_LUT\.lut:6")
        self.assertLess(p.difference(green, self.picture()), 0.001)
        file.unlink()
        self.do("VV_RELOAD_LUTS")
        self.assertEqual(self.volume()["user_tables"], [])

    def test_refusals_are_logged_with_their_reason(self):
        self.assertIn("did you mean Table.Phantom", self.refused("VV_SET_LUT LIN_LUT Table.Fantom"))
        self.assertIn("NEEDLE", self.refused("VV_CLIP CLP1 active Carriage.X.Y.DEPTH.NEEDLE"))
        self.assertIn("elevation 91 is not in -90..90", self.refused("VV_CLIP_POS CLP1 ELE 91 AZI 0 DIST 0"))
        log = self.scratch.home / "records" / f"commands-{self.scratch.instance}.jsonl"
        entry = g.eventually(lambda: next((entry for entry in map(json.loads, log.read_text().splitlines())
                                           if entry.get("command", "").endswith("Table.Fantom")), None))
        self.assertIn("no voxel volume", json.dumps(entry))

    def test_a_stream_shows_a_change_and_then_rests_at_full_quality(self):
        document = self.scratch.cellmirror("page", "--json", "--instance", self.scratch.instance)
        page = page_client.Page(json.loads(document.stdout))
        live = page_client.Live(page)
        self.addCleanup(live.close)

        def shown_until(condition):
            """The content of the newest picture, once it fulfils the condition."""
            for _ in range(1000):
                message = live.hear()
                number = page_client.picture_number(message)
                if number is None:
                    continue
                live.say(do="shown", sequence=number)
                if condition(message[32:]):
                    return message[32:]
            raise AssertionError("no such picture came")

        live.say(do="picture", width=320, height=240, rate_hz=20, quality=80, camera="SCAN_VIEW")
        seen = []

        def twice_the_same(picture):
            seen.append(picture)
            return seen[-2:] == [picture, picture]

        before = shown_until(twice_the_same)
        self.do("VV_SET_LUT RAINBOW_LUT")
        shown_until(lambda picture: picture != before)
        seen.clear()
        rainbow = shown_until(twice_the_same)
        self.assertNotEqual(rainbow, before)
        drawn = self.scratch.status()["pictures"]["volumes"]
        self.assertFalse(drawn["in_haste"])
        self.assertEqual(drawn["reduction"], 1)
        self.do("VV_SET_LUT MEDICAL_LUT")
        self.assertEqual(shown_until(lambda picture: picture == before), before, "full quality is the same each time")

    def test_metrics_and_the_tree(self):
        self.picture()
        address = self.scratch.status()["page"]["address"]
        metrics = urllib.request.urlopen(address + "metrics", timeout=60).read().decode()
        self.assertIn(f'cellmirror_volume_voxels{{volume="{NAME}"}} {112 * 88 * 96}\n', metrics)
        self.assertIn(f'cellmirror_volume_shown{{volume="{NAME}"}} 1\n', metrics)
        value = {name: float(text) for name, text in re.findall(r"^(cellmirror_volume_\w+) (\S+)$", metrics, re.M)}
        self.assertEqual(value["cellmirror_volume_reduction"], 1)
        self.assertGreater(value["cellmirror_volume_bricks_drawn"], 0)
        self.assertLess(value["cellmirror_volume_bricks_drawn"], value["cellmirror_volume_bricks"])
        self.assertGreater(value["cellmirror_volume_picture_seconds"], 0)
        tree = json.loads(urllib.request.urlopen(address + "api/tree", timeout=60).read())
        content = tree["volumes"][0]
        self.assertEqual((content["name"], content["voxels"], content["unit"]), (NAME, [112, 88, 96], "HU"))
        self.assertEqual(sum(content["histogram"]["counts"]), 112 * 88 * 96)


if __name__ == "__main__":
    g.main()

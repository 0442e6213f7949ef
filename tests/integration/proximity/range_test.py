"""cellmirror range: closed forms on a small cell, and the sensors of the transfer cell."""

import math
import unittest

import small_cell as s


class SmallCell(unittest.TestCase):
    def setUp(self):
        self.home = s.Home()

    def tearDown(self):
        self.home.close()

    def readings(self, rows, header="S1.Slide"):
        path = self.home.postures(header + "\n" + "\n".join(rows) + "\n")
        return [frame["sensors"] for frame in s.answer("range", "--cell", self.home.cell, "--poses", path)["frames"]]

    def test_keys_are_those_of_the_contract(self):
        (sensor,) = s.answer("range", "--cell", self.home.cell)["frames"][0]["sensors"]
        self.assertLessEqual({"id", "distance_m", "point_m", "object"}, set(sensor))
        self.assertEqual(sensor["id"], "EYE")
        self.assertEqual(sensor["path"], "Robot.Slide.EYE")

    def test_a_wall_at_known_distances(self):
        # The eye is 0.2 m ahead of the slide and looks along x at the wall's face at x = 2.
        for x in (0.0, 0.5, 1.0):
            (sensor,) = self.readings([repr(x)])[0]
            self.assertAlmostEqual(sensor["distance_m"], 1.8 - x, delta=1e-9)
            self.assertEqual(sensor["object"], "Wall")
            self.assertLess(math.dist(sensor["point_m"], [2.0, 0.0, 0.0]), 1e-6)
            self.assertFalse(sensor["in_blind_zone"])

    def test_out_of_range_and_in_the_blind_zone(self):
        (far,), (near,) = self.readings(["-0.5", "1.6"])
        self.assertIsNone(far["distance_m"])
        self.assertIsNone(far["point_m"])
        self.assertIsNone(far["object"])
        self.assertAlmostEqual(near["distance_m"], 0.2, delta=1e-9)
        self.assertTrue(near["in_blind_zone"])

    def test_a_frame_has_the_same_answer_alone(self):
        rows = [repr(-1.0 + 0.01 * i) for i in range(300)]
        together = self.readings(rows)
        for i in (0, 77, 210, 299):
            self.assertEqual(self.readings([rows[i]])[0], together[i])

    def test_text_and_figure(self):
        figure = self.home.root / "f.png"
        rows = "S1.Slide\n" + "".join(f"{0.1 * i!r}\n" for i in range(-5, 17))
        done = s.program("range", "--cell", self.home.cell, "--poses", self.home.postures(rows), "--plot", figure)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("22 frames", done.stdout)
        self.assertIn("0.2000 .. 2.0000 m; nearest in frame 22: Wall", done.stdout)
        self.assertEqual(figure.read_bytes()[:4], b"\x89PNG")
        few = s.program("range", "--cell", self.home.cell).stdout
        self.assertIn("EYE          1.8000 m  Wall at 2.000 0.000 0.000", few.replace("-0.000", "0.000"))

    def test_a_cell_without_sensors_has_empty_frames(self):
        (self.home.root / "envlib/slider.mpc").write_text(
            s.SLIDER.replace('type = "sensor"\n', "").replace("sensor = {", "# {"))
        self.assertEqual(s.answer("range", "--cell", self.home.cell)["frames"], [{"sensors": []}])


class TransferCell(unittest.TestCase):
    def test_every_sensor_sees_what_it_was_put_there_for(self):
        (frame,) = s.answer("range", "--cell", s.TRANSFER_CELL)["frames"]
        seen = {sensor["id"]: sensor for sensor in frame["sensors"]}
        self.assertEqual(set(seen), {"USS_1B", "USS_2", "USS_3", "USS_5", "USS_6"})
        # The coarse flange stand's face is at x = 2.75, the sensor at x = 1.2.
        self.assertEqual(seen["USS_1B"]["object"], "HTL_UMGEBUNG")
        self.assertAlmostEqual(seen["USS_1B"]["distance_m"], 1.55, delta=1e-9)
        # 0.15 + 0.25 m in front of the block that stands for the flange.
        self.assertEqual(seen["USS_3"]["object"], "Testlab_1.FL_Klein")
        self.assertAlmostEqual(seen["USS_3"]["distance_m"], 0.3, delta=1e-9)
        # From 3.45 m down to the floor.
        self.assertEqual(seen["USS_5"]["object"], "HTL_UMGEBUNG")
        self.assertAlmostEqual(seen["USS_5"]["distance_m"], 3.45, delta=1e-9)
        self.assertEqual(seen["USS_2"]["object"], "HTL_UMGEBUNG")
        self.assertAlmostEqual(seen["USS_2"]["distance_m"], 2.8, delta=1e-9)
        # 1.98 m up, looking up at the gantry's bridge or at nothing within 2 m.
        self.assertEqual(seen["USS_6"]["id"], "USS_6")

    def test_a_sensor_on_a_hand_moves_with_it(self):
        # Axis 2 turns about x: the arm leans by q towards -y, and the sensor looks at the floor. From the axis, 0.66 m
        # up, it is 0.5 + 0.73 + 0.12 - 0.03 m along the arm and 0.09 m beside it.
        home = s.Home()
        angles = (1.9, 2.0)
        path = home.postures("MANTEC_R3.J_2\n" + "".join(f"{q}\n" for q in angles))
        frames = s.answer("range", "--cell", s.TRANSFER_CELL, "--poses", path)["frames"]
        home.close()
        for q, frame in zip(angles, frames):
            (sensor,) = [sensor for sensor in frame["sensors"] if sensor["id"] == "USS_6"]
            height = 0.66 + 0.09 * math.sin(q) + 1.32 * math.cos(q)
            edge = math.pi - q - 0.15  # of the cone, against straight down
            self.assertEqual(sensor["object"], "HTL_UMGEBUNG")
            self.assertAlmostEqual(sensor["distance_m"], height / math.cos(edge), delta=1e-9)


if __name__ == "__main__":
    unittest.main()

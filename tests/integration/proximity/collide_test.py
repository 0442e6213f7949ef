"""cellmirror collide: closed forms on a small cell, and what has to hold on the transfer cell and on real robots."""

import math
import pathlib
import shutil
import subprocess
import unittest

import gateway as g
import small_cell as s


def pair(found):
    return {found["a"], found["b"]}


class SmallCell(unittest.TestCase):
    def setUp(self):
        self.home = s.Home()

    def tearDown(self):
        self.home.close()

    def frames(self, rows, header="S1.Slide,S1.Turn", options=()):
        path = self.home.postures(header + "\n" + "\n".join(rows) + "\n")
        return s.answer("collide", "--cell", self.home.cell, "--poses", path, *options)["frames"]

    def test_the_start_posture_without_a_file(self):
        document = s.answer("collide", "--cell", self.home.cell)
        self.assertEqual(len(document["frames"]), 1)
        self.assertEqual(document["cell"], "small")
        frame = document["frames"][0]
        self.assertEqual(frame["collisions"], [])
        # The capsule lies along x at z = 0.5; the ball's centre is 1 m beside it: 1 - 0.05 - 0.25.
        nearest = frame["min_distance"]
        self.assertEqual(pair(nearest), {"Robot.Slide.Turn.Arm", "Ball"})
        self.assertAlmostEqual(nearest["distance_m"], 0.7, delta=1e-9)

    def test_keys_are_those_of_the_contract(self):
        document = s.answer("collide", "--cell", self.home.cell, "--poses", self.home.postures("S1.Slide\n1.95\n0\n"))
        for frame in document["frames"]:
            self.assertLessEqual({"collisions", "min_distance"}, set(frame))
            self.assertLessEqual({"a", "b", "distance_m", "point_a_m", "point_b_m"}, set(frame["min_distance"]))
        collisions = document["frames"][0]["collisions"]
        self.assertTrue(collisions)
        for collision in collisions:
            self.assertLessEqual({"a", "b", "depth_m", "point_m"}, set(collision))
            self.assertEqual(len(collision["point_m"]), 3)

    def test_a_slide_runs_into_the_wall(self):
        # The arm's tip is 0.25 m ahead of the slide, the box's face 0.1 m.
        frames = self.frames(["1.5,0", "1.7,0", "1.8,0", "1.95,0"])
        self.assertAlmostEqual(frames[0]["min_distance"]["distance_m"], 0.25, delta=1e-9)
        self.assertAlmostEqual(frames[1]["min_distance"]["distance_m"], 0.05, delta=1e-9)
        self.assertEqual(frames[0]["within_warning"], [])
        self.assertEqual([pair(near) for near in frames[1]["within_warning"]], [{"Robot.Slide.Turn.Arm", "Wall"}])
        self.assertEqual([pair(c) for c in frames[2]["collisions"]], [{"Robot.Slide.Turn.Arm", "Wall"}])
        self.assertAlmostEqual(frames[2]["collisions"][0]["depth_m"], 0.05, delta=1e-9)
        self.assertEqual(frames[2]["min_distance"]["distance_m"], 0.0)
        both = {frozenset(pair(c)): c["depth_m"] for c in frames[3]["collisions"]}
        self.assertEqual(set(both), {frozenset(["Robot.Slide.Turn.Arm", "Wall"]), frozenset(["Robot.Slide", "Wall"])})
        self.assertAlmostEqual(both[frozenset(["Robot.Slide", "Wall"])], 0.05, delta=1e-9)

    def test_the_arm_turns_towards_the_ball(self):
        # Its end's centre is 0.2 m from the axis at this angle; the ball's centre 1 m away, in y.
        for angle in (0.3, 1.0, math.pi / 2):
            x, y = 0.2 * math.cos(angle), 0.2 * math.sin(angle)
            nearest = self.frames([f"0,{angle!r}"])[0]["min_distance"]
            expected = math.hypot(x, 1 - y) - 0.05 - 0.25
            self.assertAlmostEqual(nearest["distance_m"], expected, delta=1e-9)
            a, b = nearest["point_a_m"], nearest["point_b_m"]
            self.assertAlmostEqual(math.dist(a, b), expected, delta=1e-9, msg="the points are as far apart")

    def test_joints_without_a_column_stay(self):
        frames = self.frames(["1.7"], header="S1.Slide")
        self.assertAlmostEqual(frames[0]["min_distance"]["distance_m"], 0.05, delta=1e-9)

    def test_the_warning_distance_can_be_chosen(self):
        self.assertEqual(len(self.frames(["1.5,0"], options=["--warning", "0.3"])[0]["within_warning"]), 1)

    def test_pairs_are_listed_with_reasons(self):
        listed = s.answer("collide", "--cell", self.home.cell, "--pairs")
        states = {frozenset(pair(p)): p for p in listed["pairs"]}
        self.assertEqual(states[frozenset(["Robot.Slide", "Robot.Slide.Turn.Arm"])]["state"], "neighbours")
        self.assertTrue(states[frozenset(["Robot.Slide", "Robot.Slide.Turn.Arm"])]["reason"])
        self.assertFalse(states[frozenset(["Robot.Slide", "Robot.Slide.Turn.Arm"])]["tested"])
        self.assertTrue(states[frozenset(["Robot.Slide", "Wall"])]["tested"])
        self.assertEqual(listed["counts"]["rigid"], 1, "wall and ball")
        self.assertEqual(sum(listed["counts"].values()), 4 * 3 // 2)
        text = s.program("collide", "--cell", self.home.cell, "--pairs").stdout
        self.assertIn("Robot.Slide - Robot.Arm", text)

    def test_rules_of_the_cell_file_count(self):
        self.home.cell.write_text(s.CELL + 'ignore = [ { a = "Robot", b = "Wall", reason = "it is painted on" } ]\n'
                                  'test = [ { a = "Robot.Slide", b = "Robot.Slide.Turn.Arm" } ]\n')
        listed = s.answer("collide", "--cell", self.home.cell, "--pairs")
        states = {frozenset(pair(p)): p for p in listed["pairs"]}
        self.assertEqual(states[frozenset(["Robot.Slide", "Wall"])]["state"], "rule-ignore")
        self.assertIn("it is painted on", states[frozenset(["Robot.Slide", "Wall"])]["reason"])
        self.assertEqual(states[frozenset(["Robot.Slide", "Robot.Slide.Turn.Arm"])]["state"], "rule-test")
        self.assertEqual(self.frames(["1.95,0"])[0]["collisions"], [])

    def test_text_tells_few_frames_one_by_one_and_many_as_a_summary(self):
        few = s.program("collide", "--cell", self.home.cell, "--poses", self.home.postures("S1.Slide\n0\n1.8\n")).stdout
        self.assertIn("frame 1: free", few)
        self.assertIn("frame 2: 1 collision", few)
        self.assertIn("Wall - Robot.Arm: 0.0500 m deep at 2.0", few)
        rows = "S1.Slide\n" + "".join(f"{0.1 * i!r}\n" for i in range(20))
        many = s.program("collide", "--cell", self.home.cell, "--poses", self.home.postures(rows)).stdout
        self.assertIn("20 frames: 2 with collisions", many)
        self.assertIn("frame 19:", many)
        self.assertNotIn("frame 1:", many)

    def test_a_figure_is_drawn(self):
        figure = self.home.root / "f.png"
        done = s.program("collide", "--cell", self.home.cell, "--poses", self.home.postures("S1.Slide\n0\n1\n1.95\n"),
                         "--plot", figure)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(figure.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")


class TransferCell(unittest.TestCase):
    def setUp(self):
        self.home = s.Home()

    def tearDown(self):
        self.home.close()

    def test_its_start_posture_is_free_and_it_has_twenty_thousand_triangles(self):
        document = s.answer("collide", "--cell", s.TRANSFER_CELL)
        self.assertGreaterEqual(document["triangles"], 20_000)
        frame = document["frames"][0]
        self.assertEqual(frame["collisions"], [])
        self.assertEqual(frame["doubts"], [])

    def test_what_was_remembered_changes_no_answer(self):
        rows = s.random_postures(s.TRANSFER_RANGES, 60, seed=4)
        together = s.answer("collide", "--cell", s.TRANSFER_CELL, "--poses", self.home.postures("\n".join(rows) + "\n"))
        self.assertTrue(any(frame["collisions"] for frame in together["frames"]), "robots meet in this motion")
        self.assertTrue(any(not frame["collisions"] for frame in together["frames"]))
        for i in (1, 14, 27, 41, 60):
            alone = s.answer("collide", "--cell", s.TRANSFER_CELL, "--poses",
                             self.home.postures(rows[0] + "\n" + rows[i] + "\n"))["frames"][0]
            frame = together["frames"][i - 1]
            self.assertEqual([(c["a"], c["b"]) for c in frame["collisions"]],
                             [(c["a"], c["b"]) for c in alone["collisions"]], f"frame {i}")
            for one, other in zip(frame["collisions"], alone["collisions"]):
                self.assertAlmostEqual(one["depth_m"], other["depth_m"], delta=1e-6, msg=f"frame {i}")
            self.assertAlmostEqual(frame["min_distance"]["distance_m"], alone["min_distance"]["distance_m"],
                                   delta=1e-9, msg=f"frame {i}")

    def test_names_are_dotted_paths_of_nodes(self):
        listed = s.answer("collide", "--cell", s.TRANSFER_CELL, "--pairs")
        self.assertIn("Mantec_1.J_1.J_2", listed["bodies"])
        self.assertIn("Testlab_1.FL_Klein", listed["bodies"])


class RealRobots(unittest.TestCase):
    """Robots with their makers' meshes. Each reaches the floor, which is a box below it."""

    def setUp(self):
        self.home = s.Home()

    def tearDown(self):
        self.home.close()

    def test_they_are_tested_link_by_link(self):
        robots = [r for r in ("ur5e", "tx90", "irb120") if (s.SHARED / "robots" / r).is_dir()]
        if not robots:
            self.skipTest("skipped: shared/data/robots does not exist")
        (self.home.root / "robots").mkdir()
        for robot in robots:
            shutil.copytree(s.SHARED / "robots" / robot, self.home.root / "robots" / robot)
            self.home.cell.write_text(
                f'format = 1\nname = "real"\n[[node]]\nname = "R"\nabstract = "{robot}/{robot}.urdf"\n'
                '[[node]]\nname = "Floor"\nxyz_m = [0.0, 0.0, -0.2]\ngeometry = [{ box_m = [4.0, 4.0, 0.1] }]\n')
            listed = s.answer("collide", "--cell", self.home.cell, "--pairs")
            self.assertGreater(listed["triangles"], 500, robot)
            self.assertGreaterEqual(listed["counts"]["neighbours"], 5, robot)
            document = s.answer("collide", "--cell", self.home.cell)
            self.assertEqual(document["frames"][0]["collisions"], [], f"{robot} stands free of itself and of the floor")
            links = {body.rpartition(".")[2] for body in listed["bodies"]}
            urdf = (s.SHARED / "robots" / robot / f"{robot}.urdf").read_text()
            for link in links - {"Floor"}:
                self.assertIn(f'<link name="{link}"', urdf, "bodies have the names of links")


class Output(unittest.TestCase):
    def test_a_full_disk_is_a_failure(self):
        full = pathlib.Path("/dev/full")
        if not full.exists():
            self.skipTest("skipped: there is no /dev/full")
        home = s.Home()
        with full.open("w") as out:
            done = subprocess.run([str(g.BIN / "cellmirror"), "collide", "--cell", str(home.cell), "--json"],
                                  stdout=out, stderr=subprocess.PIPE, text=True, timeout=60)
        home.close()
        self.assertEqual(done.returncode, 1)
        self.assertIn("cannot be written", done.stderr)


if __name__ == "__main__":
    unittest.main()

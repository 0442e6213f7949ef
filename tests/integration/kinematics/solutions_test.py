"""fk and ik of real programs: every solution stands a check by another forward kinematics."""

import json
import math
import os
import pathlib
import struct
import subprocess
import tempfile
import time
import unittest

import gateway as g
import urdf_arm as u

DEMO_ARM = g.CELLS / "ros2_cell/robots/demo_arm/demo_arm.urdf"
SHARED = pathlib.Path(os.environ.get("CELLMIRROR_SHARED_DATA", g.SOURCE.parent / "shared/data")) / "robots"
TOLERANCE = 1e-5
ROUNDING = 1e-9  # of either forward kinematics


def cellmirror(*arguments, timeout=100):
    return subprocess.run([str(g.BIN / "cellmirror"), *map(str, arguments)], capture_output=True, text=True, timeout=timeout)


class KinematicsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="cellmirror-test-")
        cls.scratch = pathlib.Path(cls.folder.name)
        cls.arm = u.Arm(DEMO_ARM, "base_link", "tool0")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def document(self, *arguments, status=0):
        done = cellmirror(*arguments, "--json")
        self.assertEqual(done.returncode, status, done.stderr)
        return json.loads(done.stdout)

    def targets(self, arm, count, seed=7):
        random_numbers = u.seeded(seed)
        poses = [arm.pose(arm.random_posture(random_numbers)) for _ in range(count)]
        path = self.scratch / f"targets_{count}_{seed}.csv"
        u.write_targets(path, poses)
        return path, poses

    def check_solution(self, arm, joints, target, tolerance=TOLERANCE):
        self.assertTrue(arm.within_limits(joints), joints)
        position, rotation = u.error(arm.pose(joints), target)
        self.assertLessEqual(max(map(abs, position + rotation)), tolerance + ROUNDING)
        return math.hypot(*position), math.hypot(*rotation)


class ForwardKinematics(KinematicsTest):
    def test_pose_is_that_of_an_independent_computation(self):
        random_numbers = u.seeded(3)
        for _ in range(20):
            q = self.arm.random_posture(random_numbers)
            document = self.document("fk", *self.arm.arguments(), "--joints", " ".join(map(repr, q)))
            expected = self.arm.pose(q)
            self.assertEqual(document["joints"], q)
            self.assertTrue(document["within_limits"])
            for row, expected_row in zip(document["matrix"], expected):
                for value, expected_value in zip(row, expected_row):
                    self.assertAlmostEqual(value, expected_value, places=9)
            self.assertEqual(document["position_m"], [document["matrix"][i][3] for i in range(3)])
            inner = sum(a * b for a, b in zip(document["quaternion_xyzw"], u.quaternion(expected)))
            self.assertAlmostEqual(abs(inner), 1.0, places=9)
            roll, pitch, yaw = document["rpy_rad"]
            rotation = u.multiply(u.about((0, 0, 1), yaw), u.multiply(u.about((0, 1, 0), pitch), u.about((1, 0, 0), roll)))
            self.assertLess(max(map(abs, u.error(rotation, expected)[1])), 1e-9)

    def test_jacobian_is_the_derivative_of_the_pose(self):
        q = [0.3, -0.4, 0.9, 0.2, -0.7, 1.1]
        jacobian = self.document("fk", *self.arm.arguments(), "--joints", " ".join(map(repr, q)), "--jacobian")["jacobian"]
        step = 1e-6
        for column in range(6):
            ahead, behind = list(q), list(q)
            ahead[column] += step
            behind[column] -= step
            position, rotation = u.error(self.arm.pose(behind), self.arm.pose(ahead))
            for row, change in enumerate(position + rotation):
                self.assertAlmostEqual(jacobian[row][column], change / (2 * step), places=6)

    def test_joints_beyond_their_limits_are_told_and_computed(self):
        done = cellmirror("fk", *self.arm.arguments(), "--joints", "-9,0,0,0,0,0", "--json")
        self.assertEqual(done.returncode, 0)
        self.assertIn("turn = -9 is beyond -2.967..2.967 rad", done.stderr)
        self.assertFalse(json.loads(done.stdout)["within_limits"])

    def test_table_shows_degrees_and_metres(self):
        done = cellmirror("fk", *self.arm.arguments(), "--joints", "0 0 0 0 0 0")
        self.assertRegex(done.stdout, r"position +0\.000000 +0\.000000 +1\.270000  m")
        self.assertRegex(done.stdout, r"rpy .*deg")


class InverseKinematics(KinematicsTest):
    KEYS = {"method", "samples", "solved", "rate", "mean_us", "median_us", "p99_us", "solutions", "setup_ms"}

    def check_document(self, arm, document, poses, tolerance=TOLERANCE):
        self.assertLessEqual(self.KEYS, document.keys())
        self.assertEqual(document["samples"], len(poses))
        self.assertEqual(len(document["solutions"]), len(poses))
        self.assertEqual(document["solved"], sum(s["solved"] for s in document["solutions"]))
        self.assertAlmostEqual(document["rate"], document["solved"] / len(poses))
        for solution, target in zip(document["solutions"], poses):
            if not solution["solved"]:
                self.assertTrue(arm.within_limits(solution["joints"]))
                self.assertEqual(solution["by"], "none")
                continue
            position, rotation = self.check_solution(arm, solution["joints"], target, tolerance)
            self.assertAlmostEqual(position, solution["position_error_m"], delta=ROUNDING)
            self.assertAlmostEqual(rotation, solution["rotation_error_rad"], delta=ROUNDING)
            self.assertIn(solution["by"], ("closed-form", "seed-table", "fast", "ipopt"))
            self.assertGreater(solution["time_us"], 0)

    def test_every_method_solves_reachable_targets_within_tolerance_and_limits(self):
        path, poses = self.targets(self.arm, 200)
        for method, least in (("auto", 0.999), ("fast", 0.95), ("ipopt", 0.95)):
            with self.subTest(method=method):
                document = self.document("ik", *self.arm.arguments(), "--targets", path, "--method", method,
                                         "--timeout-ms", 5000 if method == "auto" else 200)
                self.assertEqual(document["method"], method)
                self.check_document(self.arm, document, poses)
                self.assertGreaterEqual(document["rate"], least)

    def test_statistics_are_those_of_the_solutions(self):
        path, poses = self.targets(self.arm, 101)
        document = self.document("ik", *self.arm.arguments(), "--targets", path)
        times = sorted(solution["time_us"] for solution in document["solutions"])
        self.assertAlmostEqual(document["mean_us"], sum(times) / len(times), delta=1e-6 * times[-1])
        self.assertEqual(document["median_us"], times[50])
        self.assertEqual(document["p99_us"], times[99])
        self.assertEqual(document["max_us"], times[100])
        self.assertEqual(document["found_by"]["closed-form"] + document["found_by"]["seed-table"] +
                         document["found_by"]["fast"] + document["found_by"]["ipopt"], document["solved"])

    def test_tighter_tolerance_is_kept(self):
        path, poses = self.targets(self.arm, 30)
        document = self.document("ik", *self.arm.arguments(), "--targets", path, "--tol", "1e-9", "--timeout-ms", 1000)
        self.check_document(self.arm, document, poses, 1e-9)
        self.assertGreater(document["rate"], 0.9)

    def test_same_seed_draws_the_same_targets_and_another_seed_others(self):
        arguments = ["ik", *self.arm.arguments(), "--samples", 50, "--timeout-ms", 5000]
        joints = lambda document: [solution["joints"] for solution in document["solutions"]]
        first = self.document(*arguments, "--seed", 5)
        self.assertEqual(joints(first), joints(self.document(*arguments, "--seed", 5)))
        self.assertNotEqual(joints(first), joints(self.document(*arguments, "--seed", 6)))
        self.assertEqual(first["solved"], 50)

    def test_solution_is_near_the_start(self):
        q = [0.3, -0.4, 0.9, 0.2, -0.7, 1.1]
        path = self.scratch / "one.csv"
        u.write_targets(path, [self.arm.pose(q)])
        start = " ".join(str(value + 0.02) for value in q)
        document = self.document("ik", *self.arm.arguments(), "--targets", path, "--seed-joints", start, "--timeout-ms", 5000)
        for value, expected in zip(document["solutions"][0]["joints"], q):
            self.assertAlmostEqual(value, expected, places=4)

    def test_all_gives_other_postures_that_reach_the_target_too(self):
        path, poses = self.targets(self.arm, 3)
        document = self.document("ik", *self.arm.arguments(), "--targets", path, "--all", "--timeout-ms", 500)
        several = 0
        for solution, target in zip(document["solutions"], poses):
            postures = [solution["joints"], *solution["alternatives"]]
            several += len(postures) > 1
            for i, posture in enumerate(postures):
                self.check_solution(self.arm, posture, target)
                for other in postures[:i]:
                    self.assertGreater(max(abs(a - b) for a, b in zip(posture, other)), 1e-3)
        self.assertGreater(several, 0)

    def test_position_class_asks_for_the_position_alone(self):
        path, poses = self.targets(self.arm, 20)
        document = self.document("ik", *self.arm.arguments(), "--targets", path, "--class", "align_POS", "--timeout-ms", 5000)
        self.assertEqual(document["class"], "align_POS")
        self.assertEqual(document["solved"], 20)
        for solution, target in zip(document["solutions"], poses):
            position, _ = u.error(self.arm.pose(solution["joints"]), target)
            self.assertLessEqual(max(map(abs, position)), TOLERANCE + ROUNDING)

    def test_plot_is_a_png(self):
        plot = self.scratch / "plot.png"
        self.assertEqual(cellmirror("ik", *self.arm.arguments(), "--samples", 100, "--plot", plot, "--timeout-ms", 5000).returncode, 0)
        data = plot.read_bytes()
        self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
        width, height = struct.unpack(">II", data[16:24])
        self.assertGreater(width, 800)
        self.assertGreater(height, 600)

    def test_base_may_be_the_moving_end(self):
        document = self.document("ik", "--urdf", DEMO_ARM, "--base", "tool0", "--tip", "base_link", "--samples", 20,
                                 "--timeout-ms", 5000)
        self.assertEqual(document["solved"], 20)

    def test_component_file_and_robot_of_a_cell(self):
        cell = g.CELLS / "transfer_cell"
        of_cell = self.document("ik", "--cell", cell / "cell.toml", "--robot", "MANTEC_R3", "--samples", 20, "--timeout-ms", 5000)
        self.assertEqual(of_cell["solved"], 20)
        self.assertEqual(of_cell["robot"], "MANTEC_R3")
        pose = self.document("fk", "--cell", cell / "cell.toml", "--robot", "MANTEC_R3", "--joints", "0 0 0 0 0 0")
        component = self.document("fk", "--urdf", cell / "envlib/manutec_r3.mpc", "--base", "J_1", "--tip", "J_6",
                                  "--joints", "0.1 0.2 0.3 0.4 0.5")
        self.assertEqual(component["joint_names"], ["J_2", "J_3", "J_4", "J_5", "J_6"])
        self.assertGreater(pose["position_m"][2], 1.5)  # with all joints at zero it stands straight up

    def test_arms_of_the_shared_data(self):
        if not (SHARED / "robots.json").exists():
            self.skipTest("skipped: the shared robots are not on this machine")
        for robot in json.loads((SHARED / "robots.json").read_text()):
            with self.subTest(robot=robot["id"]):
                arm = u.Arm(SHARED / robot["urdf"], robot["base"], robot["tip"])
                path, poses = self.targets(arm, 100)
                document = self.document("ik", *arm.arguments(), "--targets", path, "--timeout-ms", 5000)
                self.check_document(arm, document, poses)
                self.assertEqual(document["solved"], len(poses))


class Unreachable(KinematicsTest):
    FAR = "5,0,0.5,0,0,0,1"

    def write(self, *rows):
        path = self.scratch / "far.csv"
        path.write_text("px,py,pz,qx,qy,qz,qw\n" + "".join(row + "\n" for row in rows))
        return path

    def test_one_target_is_refused_with_the_nearest_pose_and_its_error(self):
        done = cellmirror("ik", *self.arm.arguments(), "--targets", self.write(self.FAR), "--json", "--timeout-ms", 50)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"target 1 is not reached .* nearest pose found is [\d.]+ m and [\d.e-]+ rad away")
        solution = json.loads(done.stdout)["solutions"][0]
        self.assertFalse(solution["solved"])
        self.assertTrue(self.arm.within_limits(solution["joints"]))
        target = u.shift(5, 0, 0.5)
        position, _ = u.error(self.arm.pose(solution["joints"]), target)
        self.assertAlmostEqual(math.hypot(*position), solution["position_error_m"], places=8)
        # It reaches 0.9 m from its shoulder at (0, 0, 0.36): the nearest pose is not much farther away than it has to be.
        self.assertLess(solution["position_error_m"], math.hypot(5, 0.14) - 0.91 + 0.3)

    def test_among_several_targets_it_keeps_its_place(self):
        path = self.write("0.5,0,0.6,0,1,0,0", self.FAR, "0.4,0.1,0.6,0,1,0,0")
        document = self.document("ik", *self.arm.arguments(), "--targets", path, "--timeout-ms", 1000)
        self.assertEqual([solution["solved"] for solution in document["solutions"]], [True, False, True])
        self.assertEqual((document["samples"], document["solved"]), (3, 2))

    def test_time_limit_is_kept(self):
        path = self.write(*[self.FAR] * 10)
        for method in ("auto", "fast", "ipopt"):
            with self.subTest(method=method):
                start = time.monotonic()
                document = self.document("ik", *self.arm.arguments(), "--targets", path, "--timeout-ms", 20, "--method", method)
                # Of the median, and ten times of it: other programs may have the processor meanwhile.
                self.assertLess(document["median_us"], 200_000)
                self.assertLess(time.monotonic() - start, 60)
                self.assertEqual(document["solved"], 0)


if __name__ == "__main__":
    g.main()

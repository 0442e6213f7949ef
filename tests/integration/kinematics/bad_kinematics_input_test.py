"""What fk and ik refuse, with which exit status, and that the message says which and where."""

import pathlib
import subprocess
import tempfile
import unittest

import gateway as g

DEMO_ARM = g.CELLS / "ros2_cell/robots/demo_arm/demo_arm.urdf"
ARM = ["--urdf", str(DEMO_ARM), "--base", "base_link", "--tip", "tool0"]
HEADER = "px,py,pz,qx,qy,qz,qw\n"
GOOD = "0.5,0,0.6,0,1,0,0\n"
REFUSED, USAGE = 1, 2


def joint(name, parent, child, kind="revolute", inside='<limit lower="-1" upper="1" velocity="1" effort="1"/>', axis="0 0 1"):
    return (f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
            f'<origin xyz="0.5 0 0"/><axis xyz="{axis}"/>{inside}</joint>\n')


def urdf(*joints, links="abc"):
    return '<robot name="r">\n' + "".join(f'<link name="{link}"/>\n' for link in links) + "".join(joints) + "</robot>\n"


class BadInput(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="cellmirror-test-")
        cls.scratch = pathlib.Path(cls.folder.name)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def refused(self, status, arguments, *words):
        done = subprocess.run([str(g.BIN / "cellmirror"), *arguments], capture_output=True, text=True, timeout=100)
        self.assertEqual(done.returncode, status, f"{arguments}: {done.stdout}{done.stderr}")
        self.assertEqual(done.stdout, "", arguments)
        for word in words:
            self.assertIn(word, done.stderr, arguments)

    def refused_targets(self, content, *words):
        path = self.scratch / "targets.csv"
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        self.refused(REFUSED, ["ik", *ARM, "--targets", str(path)], *words)

    def refused_robot(self, text, *words, base="a", tip="c"):
        path = self.scratch / "robot.urdf"
        path.write_text(text)
        self.refused(REFUSED, ["ik", "--urdf", str(path), "--base", base, "--tip", tip, "--samples", "3"], *words)

    def accepted_targets(self, content):
        path = self.scratch / "targets.csv"
        path.write_bytes(content)
        done = subprocess.run([str(g.BIN / "cellmirror"), "ik", *ARM, "--targets", str(path), "--timeout-ms", "5000"],
                              capture_output=True, text=True, timeout=100)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("solved  1 of 1 (100 %)", done.stdout)

    def test_csv_that_is_broken(self):
        self.refused_targets("", "targets.csv: error: the file is empty")
        self.refused_targets(HEADER, "no target below the header")
        self.refused_targets(GOOD, "targets.csv:1:1: error: there is no header")
        self.refused_targets(HEADER + GOOD + "0.5,0,0.6,0,1,0\n", "targets.csv:3:16: error: 6 columns")
        self.refused_targets(HEADER + "0.5,0,0.6,0,1,0,0,0\n", "targets.csv:2:19: error: 8 columns")
        self.refused_targets(HEADER + "0.5,0,six,0,1,0,0\n", "targets.csv:2:7: error: pz is not a finite number: six")
        self.refused_targets(HEADER + "0.5,NaN,0.6,0,1,0,0\n", "targets.csv:2:5: error: py is not a finite number: NaN")
        self.refused_targets(HEADER + "0.5,0,-inf,0,1,0,0\n", "targets.csv:2:7: error: pz is not a finite number: -inf")
        self.refused_targets(HEADER + "0.5,0,0.6,0,1.1,0,0\n", "targets.csv:2:11: error: the quaternion's norm is 1.1, not 1")
        self.refused_targets(HEADER + "0.5,0,0.6,0,0,0,0\n", "norm is 0")
        self.refused_targets(HEADER + "1e99,0,0.6,0,1,0,0\n", "targets.csv:2:1: error: px is 1e+99 m away")
        self.refused_targets(HEADER.encode() + b"\x00\xff,0,0.6,0,1,0,0\n", "targets.csv:2:1: error: px is not a finite number: \\x00\\xff")

    def test_all_that_is_wrong_with_a_csv_is_told_at_once(self):
        self.refused_targets(HEADER + "1,2\n" + GOOD + "x,0,0,0,0,0,1\n\n0,0,0,0,0,0,3\n",
                             "targets.csv:2:4:", "targets.csv:4:1:", "targets.csv:5:1: error: a blank line", "targets.csv:6:7:")

    def test_csv_as_spreadsheets_write_it_is_accepted(self):
        self.accepted_targets((HEADER + GOOD).replace("\n", "\r\n").encode())
        self.accepted_targets(b"\xef\xbb\xbf" + (HEADER + GOOD + "\n\n").encode())
        self.accepted_targets((HEADER + GOOD.strip()).encode())

    def test_csv_that_cannot_be_read(self):
        self.refused(REFUSED, ["ik", *ARM, "--targets", str(self.scratch / "nowhere.csv")], "nowhere.csv")
        self.refused(REFUSED, ["ik", *ARM, "--targets", str(self.scratch)], str(self.scratch))
        self.refused(REFUSED, ["ik", *ARM, "--targets", "/dev/zero"], "/dev/zero")

    def test_options_that_are_wrong(self):
        for arguments, words in {
            ("--samples", "0"): "0 is no count",
            ("--samples", "-5"): "-5 is no count",
            ("--samples", "1000001"): "no count from 1 to 1000000",
            ("--samples", "many"): "many",
            ("--samples", "5", "--timeout-ms", "0"): "--timeout-ms: 0 is no number above 0",
            ("--samples", "5", "--timeout-ms", "-3"): "--timeout-ms: -3",
            ("--samples", "5", "--timeout-ms", "1e30"): "up to 60000",
            ("--samples", "5", "--tol", "0"): "--tol: 0 is no number above 0",
            ("--samples", "5", "--tol", "nan"): "--tol: nan",
            ("--samples", "5", "--tol", "-1e-5"): "--tol: -1e-5",
            ("--samples", "5", "--method", "best"): "--method",
            ("--samples", "5", "--class", "align_FRAMES"): "did you mean align_FRAME",
            ("--samples", "5", "--seed", "x"): "--seed",
            ("--samples", "5", "--targets", "f.csv"): "excludes",
            (): "--targets F.csv",
        }.items():
            self.refused(USAGE, ["ik", *ARM, *arguments], words)

    def test_robot_that_is_not_named_completely(self):
        self.refused(USAGE, ["ik", "--samples", "5"], "there is no robot")
        self.refused(USAGE, ["ik", "--urdf", str(DEMO_ARM), "--tip", "tool0", "--samples", "5"], "--base")
        self.refused(USAGE, ["fk", "--urdf", str(DEMO_ARM), "--base", "base_link", "--joints", "0"], "--tip")
        self.refused(USAGE, ["fk", *ARM], "--joints")
        self.refused(USAGE, ["fk", *ARM, "--cell", "c.toml", "--joints", "0"], "--urdf and --cell")
        self.refused(USAGE, ["fk", "--cell", "c.toml", "--joints", "0"], "--robot")
        self.refused(USAGE, ["fk", "--robot", "PUMA", "--joints", "0"], "--cell")

    def test_joints_that_are_wrong(self):
        self.refused(REFUSED, ["fk", *ARM, "--joints", "0 0 0"], "3 values, the chain has 6 joints", "turn shoulder elbow")
        self.refused(REFUSED, ["fk", *ARM, "--joints", "0 0 0 0 0 0 0"], "7 values")
        self.refused(REFUSED, ["fk", *ARM, "--joints", "0 0 nan 0 0 0"], "value 3 is not a finite number: nan")
        self.refused(REFUSED, ["fk", *ARM, "--joints", "0 0 0 0 0 1e999"], "value 6")
        self.refused(REFUSED, ["fk", *ARM, "--joints", ""], "0 values")
        self.refused(REFUSED, ["ik", *ARM, "--samples", "3", "--seed-joints", "1 2"], "--seed-joints: 2 values")

    def test_chains_that_do_not_connect(self):
        self.refused(REFUSED, ["ik", "--urdf", str(DEMO_ARM), "--base", "base_link", "--tip", "tool1", "--samples", "3"],
                     str(DEMO_ARM), "tool1", "did you mean tool0")
        self.refused(REFUSED, ["ik", "--urdf", str(DEMO_ARM), "--base", "flange", "--tip", "tool0", "--samples", "3"],
                     "flange", "tool0")
        self.refused_robot(urdf(joint("j", "a", "b")), "c is a root link")
        self.refused_robot(urdf(joint("j", "a", "b"), joint("k", "b", "d")), "robot.urdf:6", "d is not a link")
        self.refused_robot(urdf(joint("j", "b", "c"), joint("k", "c", "b")), "form a loop")

    def test_joints_that_cannot_be(self):
        ends = joint("j", "a", "b"), "b", "c"
        self.refused_robot(urdf(ends[0], joint("k", "b", "c", inside='<limit lower="2" upper="-1" velocity="1" effort="1"/>')),
                           "robot.urdf:6", "lower 2 is not below upper -1")
        self.refused_robot(urdf(ends[0], joint("k", "b", "c", axis="0 0 0")), "robot.urdf:6", "the axis has length zero")
        self.refused_robot(urdf(ends[0], joint("k", "b", "c", axis="0 nan 1")), "robot.urdf:6")
        self.refused_robot(urdf(ends[0], joint("k", "b", "c", inside="")), "robot.urdf:6", "needs <limit>")
        self.refused_robot(urdf(ends[0], joint("k", "b", "c", kind="ball")), "robot.urdf:6", "ball")
        self.refused_robot("no xml", "robot.urdf")
        self.refused_robot("", "robot.urdf")

    def test_mistakes_off_the_chain_do_not_matter(self):
        many = [joint(f"finger{i}", "c" if i == 0 else f"f{i - 1}", f"f{i}") for i in range(40)]
        wrong = joint("hand", "c", "h", inside='<limit lower="2" upper="-1"/>', axis="0 0 0")
        text = urdf(joint("j", "a", "b"), joint("k", "b", "c"), *many, wrong, links=["a", "b", "c", "h", *(f"f{i}" for i in range(40))])
        path = self.scratch / "hand.urdf"
        path.write_text(text)
        done = subprocess.run([str(g.BIN / "cellmirror"), "fk", "--urdf", str(path), "--base", "a", "--tip", "c", "--joints", "0 0"],
                              capture_output=True, text=True, timeout=100)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("1.000000", done.stdout)

    def test_robot_of_few_joints_is_told_what_it_cannot_meet(self):
        path = self.scratch / "planar.urdf"
        path.write_text(urdf(joint("j", "a", "b"), joint("k", "b", "c")))
        targets = self.scratch / "targets.csv"
        targets.write_text(HEADER + "0.6,0.1,0.3,0.6,0,0,0.8\n")
        command = [str(g.BIN / "cellmirror"), "ik", "--urdf", str(path), "--base", "a", "--tip", "c", "--targets", str(targets)]
        done = subprocess.run(command, capture_output=True, text=True, timeout=100)
        self.assertEqual(done.returncode, REFUSED)
        self.assertIn("with 2 joints not every position and orientation can be met together", done.stderr)

    def test_output_that_cannot_be_written(self):
        with open("/dev/full", "w") as full:
            done = subprocess.run([str(g.BIN / "cellmirror"), "ik", *ARM, "--samples", "2"], stdout=full, stderr=subprocess.PIPE,
                                  text=True, timeout=100)
        self.assertEqual(done.returncode, REFUSED)
        self.assertIn("No space left", done.stderr)

    def test_plot_that_cannot_be_written(self):
        done = subprocess.run([str(g.BIN / "cellmirror"), "ik", *ARM, "--samples", "2", "--plot", "/nowhere/plot.png"],
                              capture_output=True, text=True, timeout=100)
        self.assertEqual(done.returncode, REFUSED)
        self.assertIn("/nowhere/plot.png", done.stderr)


if __name__ == "__main__":
    g.main()

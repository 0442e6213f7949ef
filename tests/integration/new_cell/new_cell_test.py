"""cellmirror new: what it makes checks without errors, overwrites nothing, and leaves nothing behind after an error."""

import errno
import os
import pathlib
import pty
import select
import shutil
import struct
import subprocess
import tempfile
import time
import tomllib
import unittest

import gateway as g

ARM = g.CELLS / "ros2_cell/robots/demo_arm/demo_arm.urdf"
EDS = g.CELLS / "can_cell/robots/axis_drive.eds"
DBC = g.CELLS / "can_cell/robots/table.dbc"
CHANNEL = "udp:239.74.163.9:43119"


def tree(folder):
    """{path: content} of every file below, and the folders."""
    return {str(path.relative_to(folder)): path.read_bytes() if path.is_file() else None
            for path in sorted(folder.rglob("*"))}


def box_mesh():
    """A binary STL of a tetrahedron."""
    corners = [(0, 0, 0), (0.1, 0, 0), (0, 0.1, 0), (0, 0, 0.1)]
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    data = b"\0" * 80 + struct.pack("<I", len(faces))
    for face in faces:
        data += struct.pack("<3f", 0, 0, 0) + b"".join(struct.pack("<3f", *corners[i]) for i in face) + b"\0\0"
    return data


def urdf(mesh=None, name="little", joints=1, origin=""):
    """A chain of `joints` joints; the root link has a mesh."""
    shape = f'<geometry><mesh filename="{mesh}"/></geometry>'
    body = f"<visual>{shape}</visual><collision>{shape}</collision>" if mesh is not None else ""
    text = f'<?xml version="1.0"?>\n<robot name="{name}">\n<link name="foot"/>\n<link name="link_0">{body}</link>\n'
    text += f'<joint name="mount" type="fixed"><parent link="foot"/><child link="link_0"/>{origin}</joint>\n'
    for i in range(1, joints + 1):
        text += (f'<link name="link_{i}"/><joint name="j_{i}" type="revolute"><parent link="link_{i - 1}"/>'
                 f'<child link="link_{i}"/><axis xyz="0 0 1"/><limit lower="-3" upper="-1" velocity="1" effort="1"/></joint>\n')
    return text + "</robot>\n"


class Base(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="cellmirror-test-"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.work = self.folder / "work"
        self.work.mkdir()
        self.environment = {key: value for key, value in os.environ.items()
                            if key not in ("kis_home", "AMENT_PREFIX_PATH", "ROS_PACKAGE_PATH")}

    def run_new(self, *arguments, **more):
        return subprocess.run([str(g.BIN / "cellmirror"), "new", *map(str, arguments)], cwd=self.work, text=True,
                              capture_output=True, timeout=60, stdin=subprocess.DEVNULL, env=self.environment | more)

    def make(self, *arguments, **more):
        done = self.run_new("mine", *arguments, **more)
        self.assertEqual(done.returncode, 0, done.stderr)
        return self.work / "mine", done

    def check(self, cell):
        done = subprocess.run([str(g.BIN / "cellmirror"), "check", str(cell / "cell.toml")], capture_output=True, text=True,
                              timeout=60, env=self.environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def refused(self, *arguments, status=1, said="", **more):
        """Nothing is left of it, and nothing that was there has changed."""
        before = tree(self.work)
        done = self.run_new(*arguments, **more)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        self.assertIn(said, done.stderr)
        self.assertEqual(tree(self.work), before)
        return done

    def write(self, name, content):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path


class Makes(Base):
    def test_a_cell_from_a_urdf_that_checks(self):
        cell, done = self.make("--urdf", ARM)
        self.assertEqual(self.check(cell).stderr, "")
        said = tomllib.loads((cell / "cell.toml").read_text())
        self.assertEqual(said["stream"][0]["robot"], "demo_arm")
        self.assertEqual(said["stream"][0]["topic"], "/joint_states")
        self.assertIn("DECIDE", (cell / "cell.toml").read_text())
        self.assertIn("ROBOT demo_arm online;", (cell / "scripts/startup.spt").read_text())
        self.assertIn("sim_robot dds --topic /joint_states", (cell / "README.md").read_text())
        self.assertTrue((cell / "robots/demo_arm/demo_arm.urdf").is_file())
        self.assertIn("guessed", done.stdout)

    def test_the_folder_is_like_any_other(self):
        cell, _ = self.make("--urdf", ARM)
        mask = os.umask(0)
        os.umask(mask)
        self.assertEqual(cell.stat().st_mode & 0o777, 0o777 & ~mask)
        self.assertEqual([path.name for path in self.work.iterdir()], ["mine"], "no temporary folder stays")

    def test_an_axis_beside_the_arm(self):
        cell, _ = self.make("--urdf", ARM, "--topic", "rt/left/joint_states", "--eds", EDS, "--node", "11",
                            "--channel", CHANNEL)
        self.check(cell)
        streams = {stream["robot"]: stream for stream in tomllib.loads((cell / "cell.toml").read_text())["stream"]}
        self.assertEqual(streams["demo_arm"]["topic"], "/left/joint_states")
        self.assertEqual(streams["AXIS"]["node"][0]["id"], 11)
        self.assertEqual(streams["AXIS"]["node"][0]["eds"], "axis_drive.eds")
        self.assertTrue((cell / "envlib/axis.mpc").is_file())

    def test_as_many_drives_as_joints_are_those_of_the_arm(self):
        cell, _ = self.make("--urdf", ARM, "--eds", EDS, "--node", *range(1, 7))
        self.check(cell)
        streams = tomllib.loads((cell / "cell.toml").read_text())["stream"]
        self.assertEqual([stream["robot"] for stream in streams], ["demo_arm"])
        self.assertEqual([node["joint"] for node in streams[0]["node"]],
                         ["turn", "shoulder", "elbow", "roll", "bend", "flange_turn"])

    def test_signals_of_a_dbc(self):
        cell, _ = self.make("--urdf", ARM, "--dbc", DBC)
        self.check(cell)
        stream = tomllib.loads((cell / "cell.toml").read_text())["stream"][1]
        self.assertEqual(stream["robot"], "DBC_AXES")
        self.assertEqual([(s["signal"], s["joint"], s["quantity"]) for s in stream["signal"]],
                         [("TurnAngle", "J_1", "position"), ("TiltAngle", "J_2", "position"),
                          ("TurnSpeed", "J_1", "velocity")])
        self.assertAlmostEqual(stream["signal"][0]["scale"], 0.017453292519943295)

    def test_base_and_place(self):
        source = self.write("r/little.urdf", urdf(origin='<origin xyz="0 0 0.5"/>'))
        cell, _ = self.make("--urdf", source, "--base", "link_0", "--xyz", "1", "-2", "0.75")
        self.check(cell)
        node = tomllib.loads((cell / "cell.toml").read_text())["node"][0]
        self.assertEqual(node["xyz_m"], [1.0, -2.0, 0.25])
        self.assertEqual(node["robot_base"], "link_0")

    def test_an_eds_without_a_position_gets_the_usual_mapping(self):
        bare = self.write("bare.eds", EDS.read_text().replace("0x60640020", "0x60770010"))
        cell, _ = self.make("--urdf", ARM, "--eds", bare, "--node", "5")
        self.check(cell)
        text = (cell / "cell.toml").read_text()
        node = tomllib.loads(text)["stream"][1]["node"][0]
        self.assertEqual(node["tpdo"][0]["entries"][1]["index"], 0x6064)
        self.assertNotIn("eds", node)
        self.assertFalse(node["configure"], "nothing is written to a drive that a person has not decided")

    def test_a_dbc_without_positions_leaves_a_comment(self):
        none = self.write("none.dbc", 'BO_ 1 Motor: 8 M\n SG_ Temperature : 0|8@1+ (1,0) [0|0] "C" G\n')
        cell, _ = self.make("--urdf", ARM, "--dbc", none)
        self.check(cell)
        self.assertIn("#   Motor.Temperature [C]", (cell / "cell.toml").read_text())

    def test_a_dbc_with_multiplexed_positions(self):
        muxed = self.write("muxed.dbc", 'BO_ 9 Axes: 8 M\n SG_ Which M : 0|8@1+ (1,0) [0|0] "" G\n'
                           ' SG_ PosA m0 : 8|16@1- (0.01,0) [0|0] "deg" G\n SG_ PosB m1 : 8|16@1- (0.01,0) [0|0] "deg" G\n')
        cell, _ = self.make("--urdf", ARM, "--dbc", muxed)
        self.check(cell)
        self.assertIn("multiplexed", (cell / "cell.toml").read_text())

    def test_kis_home_does_not_take_the_place_of_the_new_folder(self):
        cell, done = self.make("--urdf", ARM, kis_home=str(self.folder))
        self.check(cell)
        self.assertIn("$kis_home is set", done.stdout)

    def test_joints_whose_range_lies_beside_zero_are_simulated_within_it(self):
        cell, _ = self.make("--urdf", self.write("r/little.urdf", urdf(joints=3)))
        rows = (cell / "motion_Arm.csv").read_text().splitlines()[1:]
        for row in rows:
            for value in row.split(",")[1:]:
                self.assertTrue(-3 < float(value) < -1, rows)

    def test_sixteen_joints(self):
        cell, _ = self.make("--urdf", self.write("r/long.urdf", urdf(joints=16)), "--node", *range(1, 17))
        self.check(cell)


class Meshes(Base):
    def test_beside_the_urdf_in_its_package_and_by_the_environment(self):
        self.write("ws/share/arm_description/package.xml", "<package/>")
        self.write("ws/share/arm_description/meshes/a.stl", box_mesh())
        self.write("ws/share/other/meshes/b.stl", box_mesh())
        for mesh in ("../meshes/a.stl", "package://arm_description/meshes/a.stl", "package://other/meshes/b.stl",
                     f"file://{self.folder}/ws/share/other/meshes/b.stl"):
            with self.subTest(mesh=mesh):
                source = self.write("ws/share/arm_description/urdf/little.urdf", urdf(mesh))
                cell, _ = self.make("--urdf", source, AMENT_PREFIX_PATH=f"/nowhere:{self.folder}/ws")
                self.assertEqual(self.check(cell).stderr, "")
                self.assertEqual(len(list(cell.rglob("*.stl"))), 1)
                shutil.rmtree(cell)

    def test_materials_and_textures_come_along(self):
        self.write("r/meshes/part.obj", "mtllib part.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n")
        self.write("r/meshes/part.mtl", "newmtl m\nmap_Kd wood.png\n")
        self.write("r/meshes/wood.png", (g.CELLS / "can_cell/envlib/markings/scale.png").read_bytes())
        self.write("r/meshes/stranger.png", b"x")
        cell, _ = self.make("--urdf", self.write("r/little.urdf", urdf("meshes/part.obj")))
        names = sorted(path.name for path in (cell / "robots/little/meshes").iterdir())
        self.assertEqual(names, ["part.mtl", "part.obj", "wood.png"])

    def test_names_that_need_quoting_are_replaced(self):
        self.write("r/my meshes/ü $(x).stl", box_mesh())
        cell, _ = self.make("--urdf", self.write("r/little.urdf", urdf("my meshes/ü $(x).stl")))
        self.check(cell)
        mesh = next(cell.rglob("*.stl"))
        self.assertRegex(str(mesh.relative_to(cell)), r"^[\w./-]+$")

    def test_links_below_what_was_named_are_followed(self):
        mesh = self.write("elsewhere/a.stl", box_mesh())
        for folder in ("r/meshes", "arm_description/meshes"):
            (self.folder / folder).mkdir(parents=True)
            os.symlink(mesh, self.folder / folder / "linked.stl")
        for name in ("meshes/linked.stl", "package://arm_description/meshes/linked.stl"):
            with self.subTest(mesh=name):
                cell, _ = self.make("--urdf", self.write("r/little.urdf", urdf(name)))
                copy = next(cell.rglob("*.stl"))
                self.assertFalse(copy.is_symlink())
                self.assertEqual(self.check(cell).stderr, "")
                shutil.rmtree(cell)

    def test_meshes_beside_a_link_to_the_urdf_are_found(self):
        source = self.write("build/little.urdf", urdf("meshes/a.stl"))
        self.write("r/meshes/a.stl", box_mesh())
        os.symlink(source, self.folder / "r/little.urdf")
        cell, _ = self.make("--urdf", self.folder / "r/little.urdf")
        self.assertEqual(len(list(cell.rglob("*.stl"))), 1)

    def test_outside_of_everything_known_is_refused(self):
        self.write("elsewhere/a.stl", box_mesh())
        for mesh in ("../elsewhere/a.stl", f"{self.folder}/elsewhere/a.stl", f"file://{self.folder}/elsewhere/a.stl",
                     "package://../elsewhere/a.stl", "package://elsewhere/../elsewhere/a.stl",
                     "/etc/passwd", "http://example.org/a.stl", "", "."):
            with self.subTest(mesh=mesh):
                source = self.write("r/little.urdf", urdf(mesh))
                self.refused("mine", "--urdf", source, said="little.urdf")


class Refuses(Base):
    def test_what_is_there(self):
        (self.work / "folder").mkdir()
        (self.work / "file").write_text("kept")
        os.symlink("nowhere", self.work / "link")
        for name in ("folder", "file", "link"):
            self.refused(name, "--urdf", ARM, said="already")
            self.refused(name + "/", "--urdf", ARM, said="already")

    def test_names_and_places(self):
        for name in ("..", ".", "a b", "a;b", "ü", "-x/..", "x" * 64, "$(reboot)", "a\nb"):
            with self.subTest(name=name):
                self.refused("--urdf", ARM, "--", name, status=2, said="is not a name for a cell")
        self.refused("no/such/place", "--urdf", ARM, said="there is no folder no/such")

    def test_what_is_missing_or_makes_no_sense(self):
        self.refused("mine", status=2, said="--urdf is missing")
        self.refused("mine", "--urdf", ARM, "--eds", EDS, status=2, said="--node is missing")
        self.refused("mine", "--urdf", ARM, "--node", "0", status=2, said="not a node id")
        self.refused("mine", "--urdf", ARM, "--node", "3", "3", status=2, said="twice")
        self.refused("mine", "--urdf", ARM, "--node", *range(1, 18), status=2, said="at most 16")
        self.refused("mine", "--urdf", ARM, "--eds", EDS, "--eds", EDS, "--node", "1", status=2, said="--eds")
        self.refused("mine", "--urdf", ARM, "--xyz", "1", "2", status=2)
        self.refused("mine", "--urdf", ARM, "--xyz", "nan", "0", "0", status=2, said="--xyz")
        self.refused("mine", "--urdf", ARM, "--topic", 'a"b', status=2, said="not a ROS 2 topic")
        self.refused("mine", "--urdf", ARM, "--base", "base_lnk", said="did you mean base_link?")
        self.refused("mine", "--urdf", ARM, "--base", "flange", said="a joint moves")
        self.refused("mine", "--urdf", ARM, "--dbc", DBC, "--channel", "can0", said="is not a channel")

    def test_an_eds_of_another_device_is_refused(self):
        io_node = g.SOURCE / "config/devices/cellmirror_io_node.eds"
        self.refused("mine", "--urdf", ARM, "--eds", io_node, "--node", "1", said="an I/O device (CiA 401), not a drive")
        encoder = self.write("encoder.eds", "[1000]\nDataType=7\nDefaultValue=0x00020196\n[6004]\nDataType=7\n")
        self.refused("mine", "--urdf", ARM, "--eds", encoder, "--node", "1", said="a device of profile 406, not a drive")

    def test_files_that_are_none(self):
        self.refused("mine", "--urdf", "no.urdf", said="no.urdf")
        self.refused("mine", "--urdf", self.folder, said="error")
        self.refused("mine", "--urdf", "/dev/null", said="error")
        self.refused("mine", "--urdf", self.write("bad.urdf", "<robot"), said="bad.urdf")
        self.refused("mine", "--urdf", self.write("x.urdf", '<sdf version="1"/>'), said="xacro")
        self.refused("mine", "--urdf", self.write("still.urdf", '<robot name="r"><link name="a"/></robot>'), said="moves")
        self.refused("mine", "--urdf", ARM, "--eds", "no.eds", "--node", "1", said="no.eds")
        self.refused("mine", "--urdf", ARM, "--eds", self.write("bad.eds", "[1A00sub1]\nDefaultValue=xyz\n"), "--node", "1",
                     said="bad.eds")
        self.refused("mine", "--urdf", ARM, "--dbc", self.write("bad.dbc", "BO_ x y\n"), said="bad.dbc")

    def test_a_folder_that_cannot_be_written(self):
        if os.geteuid() == 0:
            self.skipTest("skipped: root may write everywhere")
        self.work.chmod(0o555)
        self.addCleanup(self.work.chmod, 0o755)
        self.refused("mine", "--urdf", ARM, said="no folder can be made")

    def test_hostile_names_in_a_urdf_reach_no_shell(self):
        cell, _ = self.make("--urdf", self.write("r/little.urdf", urdf(name="$(touch$IFS$9pwned)")))
        self.check(cell)
        for line in (cell / "README.md").read_text().splitlines():
            if line.startswith("sim_robot"):
                subprocess.run(["bash", "-c", "sim_robot() { :; }; " + line], cwd=self.work, check=True)
        self.assertFalse((self.work / "pwned").exists())


class OnATerminal(Base):
    """A person answers; what the command line said is not asked."""

    def converse(self, arguments, answers):
        child, terminal = pty.fork()
        if child == 0:
            os.chdir(self.work)
            os.execve(g.BIN / "cellmirror", ["cellmirror", "new", *map(str, arguments)], self.environment)
        self.addCleanup(os.close, terminal)
        shown, waiting = "", list(answers)
        end = time.monotonic() + 100
        while time.monotonic() < end:
            ready, _, _ = select.select([terminal], [], [], 0.5)
            if ready:
                try:
                    data = os.read(terminal, 4096)
                except OSError as error:
                    if error.errno == errno.EIO:
                        break
                    raise
                if not data:
                    break
                shown += data.decode(errors="replace")
            if waiting and shown.endswith(": "):
                os.write(terminal, (waiting[0] + "\n").encode())
                shown += "\n"
                waiting.pop(0)
        _, status = os.waitpid(child, 0)
        return os.waitstatus_to_exitcode(status), shown, waiting

    def test_it_asks_for_everything(self):
        status, shown, waiting = self.converse(
            ["mine"], ["no.urdf", str(ARM), "0 0 0.8", str(EDS), "x", "11", "", CHANNEL, "/arm/joint_states"])
        self.assertEqual((status, waiting), (0, []), shown)
        self.assertIn("there is no file no.urdf", shown)
        self.check(self.work / "mine")
        said = tomllib.loads((self.work / "mine/cell.toml").read_text())
        self.assertEqual(said["node"][0]["xyz_m"], [0.0, 0.0, 0.8])
        self.assertEqual({s["robot"]: s.get("topic") for s in said["stream"]},
                         {"demo_arm": "/arm/joint_states", "AXIS": None})

    def test_it_does_not_ask_for_what_was_told(self):
        status, shown, waiting = self.converse(
            ["mine", "--urdf", ARM, "--xyz", "0", "0", "0", "--topic", "/joint_states", "--eds", EDS, "--node", "3"],
            ["", CHANNEL])
        self.assertEqual((status, waiting), (0, []), shown)
        self.assertNotIn("URDF", shown)

    def test_an_input_that_ends_writes_nothing(self):
        status, shown, _ = self.converse(["mine"], ["\x04"])
        self.assertEqual(status, 1, shown)
        self.assertEqual(list(self.work.iterdir()), [])


if __name__ == "__main__":
    g.main()

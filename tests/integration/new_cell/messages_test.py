"""Messages that somebody met who made a cell of his own: each test does what he did, then what the message says."""

import json
import pathlib
import shutil
import subprocess
import tempfile
import unittest

import gateway as g

CELL = '''format = 1
name = "mine"
[[node]]
name = "Arm"
abstract = "demo_arm/demo_arm.urdf"
[[node]]
name = "Axis"
abstract = "axis.mpc"
'''
AXIS = '''format = 1
[[node]]
name = "J_1"
joint = { type = "revolute", axis = [0, 0, 1], range_rad = [-3, 3], velocity_rad_s = 1 }
[robot]
id = "AXIS"
flange = "J_1"
'''
DRIVE = '''[[stream]]
robot = "AXIS"
kind = "can-cia402"
channel = "udp:239.74.163.9:43119"
'''


def cellmirror(*arguments):
    return subprocess.run([str(g.BIN / "cellmirror"), *map(str, arguments)], capture_output=True, text=True, timeout=60)


class Messages(unittest.TestCase):
    def setUp(self):
        self.home = pathlib.Path(tempfile.mkdtemp(prefix="cellmirror-test-"))
        self.addCleanup(shutil.rmtree, self.home)
        for folder in ("envlib", "robots"):
            (self.home / folder).mkdir()
        shutil.copytree(g.CELLS / "ros2_cell/robots/demo_arm", self.home / "robots/demo_arm")
        (self.home / "envlib/axis.mpc").write_text(AXIS)

    def check(self, text, errors):
        """What `check` says of the cell."""
        (self.home / "cell.toml").write_text(CELL + text)
        done = cellmirror("check", "--json", self.home / "cell.toml")
        said = json.loads(done.stdout)
        self.assertEqual(said["errors"], errors, said)
        return [(item["message"], item["remedy"]) for item in said["diagnostics"] if item["severity"] != "note"]

    def test_a_topic_as_ros_2_writes_it(self):
        stream = '[[stream]]\nrobot = "demo_arm"\nkind = "dds"\ntopic = "{}"\n'
        for topic in ("/joint_states", "rt/joint_states", "/left/joint_states"):
            self.assertEqual(self.check(stream.format(topic), 0), [], topic)
        self.assertIn("no ROS 2 topic", self.check(stream.format("joint_states"), 0)[0][0])
        for topic in ("/joint states", "//joint_states", "/joint_states/", "/1st"):
            self.assertIn("is not a ROS 2 topic", self.check(stream.format(topic), 1)[0][0])

    def test_an_eds_without_the_position_names_the_key_that_mends_it(self):
        eds = (g.CELLS / "can_cell/robots/axis_drive.eds").read_text().replace("0x60640020", "0x60770010")
        (self.home / "robots/bare.eds").write_text(eds)
        node = DRIVE + '[[stream.node]]\nid = 3\njoint = "J_1"\nincrements_per_rad = 1000\neds = "bare.eds"\n'
        message, remedy = self.check(node, 1)[0]
        self.assertIn("0x6064", message)
        self.assertIn("[[stream.node.tpdo]]", remedy)
        mapping = "[[stream.node.tpdo]]\nnumber = 1\nentries = [{ index = 0x6041, bits = 16 }, { index = 0x6064, bits = 32 }]\n"
        self.assertEqual(self.check(node + mapping, 0), [])

    def test_a_vendors_file_is_refused_only_for_faults_in_used_parts(self):
        eds = (g.CELLS / "can_cell/robots/axis_drive.eds").read_text()
        node = DRIVE + '[[stream.node]]\nid = 3\njoint = "J_1"\nincrements_per_rad = 1000\neds = "vendor.eds"\n'
        for odd in ("# made by a tool\n[2010]\nDataType=5\nAccessType=rw\nDefaultValue=0x1FF\n", "[2011]\nDefaultValue=1\n",
                    "[2012]\nDataType=7\nAccessType=read and write\nDefaultValue=-1\n", "*** end ***\n"):
            (self.home / "robots/vendor.eds").write_text(eds.replace("0x60640020", "0x60640020 ; position") + "\n" + odd)
            self.assertTrue(self.check(node, 0), odd)
        (self.home / "robots/vendor.eds").write_text(eds.replace("0x60640020", "0x6064002000000"))
        messages = [message for message, _ in self.check(node, 1)]
        self.assertTrue(any("the stream uses 0x1A00:02" in message for message in messages), messages)
        axis = 'BO_ 256 Axis: 8 A\n SG_ Angle : 0|32@1- (0.001,0) [0|0] "rad" A\n'
        signal = (DRIVE.replace("can-cia402", "can-dbc") + 'dbc = "vendor.dbc"\n[[stream.signal]]\nmessage = "Axis"\n'
                  'signal = "Angle"\njoint = "J_1"\nscale = 1\n')
        for odd in ('BO_ 257 Other: 2 A\n SG_ S : 8|16@1+ (1,0) [0|0] "" A\n', "BO_ 2566844926 Long: 200 A\n",
                    'VAL_ 256 Angle 1 "one"'):
            (self.home / "robots/vendor.dbc").write_text(axis + odd)
            self.assertTrue(self.check(signal, 0), odd)
        (self.home / "robots/vendor.dbc").write_text(axis.replace("0|32", "40|32"))
        messages = [message for message, _ in self.check(signal, 1)]
        self.assertTrue(any("the stream uses Axis.Angle" in message for message in messages), messages)

    def test_a_key_one_level_too_high(self):
        said = dict(self.check(DRIVE + 'increments_per_rad = 1000\neds = "a.eds"\nnumber = 1\n'
                               '[[stream.node]]\nid = 3\njoint = "J_1"\nrad_per_increment = 0.001\n', 3))
        for key, table in (("increments_per_rad", "[[stream.node]]"), ("eds", "[[stream.node]]"),
                           ("number", "[[stream.node.tpdo]]")):
            self.assertEqual(said[f"stream of AXIS: the key {key} does not belong here"], f"it belongs under {table}")

    def test_a_key_one_level_too_low(self):
        (_, remedy), = self.check(DRIVE + '[[stream.node]]\nid = 3\njoint = "J_1"\nincrements_per_rad = 1000\n'
                                  "heartbeat_timeout_s = 1\n", 1)
        self.assertEqual(remedy, "it belongs under [[stream]], above its [[stream.node]]")

    def test_keys_of_the_other_kinds(self):
        dds = '[[stream]]\nrobot = "demo_arm"\nkind = "dds"\nros_name = "a"\n'
        self.assertEqual(self.check(dds, 1)[0][1], "it belongs under [[stream.joint]]")
        shutil.copy(g.CELLS / "can_cell/robots/table.dbc", self.home / "robots")
        dbc = DRIVE.replace("can-cia402", "can-dbc") + 'dbc = "table.dbc"\nquantity = "position"\n'
        said = self.check(dbc + '[[stream.signal]]\nmessage = "TableAxes"\nsignal = "TurnAngle"\njoint = "J_1"\nscale = 1\n', 1)
        self.assertEqual(said[0][1], "it belongs under [[stream.signal]]")

    def test_an_unknown_key_is_still_told_the_nearest(self):
        (message, remedy), = self.check(DRIVE + "sync_perid_s = 0.01\n[[stream.node]]\nid = 3\njoint = \"J_1\"\n"
                                        "increments_per_rad = 1000\n", 1)
        self.assertIn("is unknown", message)
        self.assertIn("did you mean sync_period_s?", remedy)

    def test_a_misspelt_subcommand_and_option(self):
        for words, said in ((["stauts"], "cellmirror has no subcommand stauts; did you mean status?"),
                            (["chek", "cell.toml"], "did you mean check?"),
                            (["xyzzy"], "there are check, collide"),
                            (["volume", "inf", "x"], "cellmirror volume has no subcommand inf; did you mean info?"),
                            (["run", "cell.toml", "--intsance", "a"],
                             "cellmirror run has no option --intsance; did you mean --instance?"),
                            (["status", "--jsno"], "did you mean --json?")):
            done = cellmirror(*words)
            self.assertEqual(done.returncode, 2, words)
            self.assertIn(said, done.stderr)
        self.assertIn("subcommand is required", cellmirror().stderr)


if __name__ == "__main__":
    g.main()

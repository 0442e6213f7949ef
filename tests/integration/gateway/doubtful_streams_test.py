"""A stream that leaves a joint out and has degrees for radians: check and start say so, status and the log show it."""

import re
import unittest

import gateway as g

CHANNEL = "udp:239.74.163.9:43119"
JOINT = """[[node]]
name = "J_{0}"
{1}joint = {{ type = "revolute", axis = [0, 0, 1], range_rad = [-2, 2], velocity_rad_s = 1 }}
"""
ARM = ("format = 1\n" + "".join(JOINT.format(i, f'parent = "J_{i - 1}"\n' if i > 1 else "") for i in range(1, 8)) +
       '[robot]\nid = "ARM"\nflange = "J_7"\n')
DBC = ('VERSION ""\nBO_ 256 First: 8 R\n' +
       "".join(f' SG_ A{i} : {16 * (i - 1)}|16@1- (0.01,0) [-180|180] "deg" M\n' for i in range(1, 5)) +
       "BO_ 257 Second: 8 R\n" +
       "".join(f' SG_ A{i} : {16 * (i - 5)}|16@1- (0.01,0) [-180|180] "deg" M\n' for i in range(5, 7)))
SIGNALS = "".join(f'[[stream.signal]]\nmessage = "{"First" if i < 5 else "Second"}"\nsignal = "A{i}"\njoint = "J_{i}"\n'
                  for i in range(1, 7))
CELL = f"""format = 1
name = "doubtful"
geometry = [{{ mesh = "twice.obj" }}]
[[node]]
name = "Arm"
abstract = "arm.mpc"
[[stream]]
robot = "ARM"
kind = "can-dbc"
channel = "{CHANNEL}"
dbc = "arm.dbc"
{SIGNALS}"""
# A closed body with a face that stands twice, which is repaired.
MESH = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\nf 2 3 4\n"


class DoubtfulStreams(unittest.TestCase):
    def setUp(self):
        self.scratch = g.Scratch()
        home = self.scratch.home
        for name, text in (("cell.toml", CELL), ("envlib/arm.mpc", ARM), ("robots/arm.dbc", DBC), ("envlib/twice.obj", MESH)):
            path = home / name
            path.parent.mkdir(exist_ok=True)
            path.write_text(text)
        self.processes = []

    def tearDown(self):
        for process in self.processes:
            process.close()
        self.scratch.remove()

    def run_gateway(self, *arguments):
        gateway = g.Gateway(self.scratch, *arguments)
        self.processes.append(gateway)
        return gateway

    def test_check_tells_all_beside_other_errors_and_at_its_line(self):
        done = self.scratch.cellmirror("check", str(self.scratch.cell_file))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("cell.toml:7:1: warning: stream of ARM: nothing gives the position of J_7; it stays at its start "
                      "position; add a [[stream.signal]]", done.stderr)
        for signal in range(1, 7):
            self.assertRegex(done.stderr, rf"cell.toml:{14 + 4 * (signal - 1)}:10: warning: stream of ARM: signal "
                                          rf"\w+\.A{signal} is in deg and scale is 1; write scale = 0\.017453292519943295")
        self.assertIn("triangle appears twice", done.stderr)
        faulty = CELL.replace('signal = "A2"', 'signal = "A9"').replace('"doubtful"', '"doubtful"\ncolour = 1')
        self.scratch.cell_file.write_text(faulty)
        done = self.scratch.cellmirror("check", str(self.scratch.cell_file))
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("cell.toml:3:1: error: the key colour", done.stderr)
        self.assertIn("cell.toml:19:10: error: stream of ARM: the message First has no signal A9", done.stderr)

    def test_start_warns_of_every_one_and_hides_notes_without_verbose(self):
        said = self.run_gateway().output()
        self.assertIn("nothing gives the position of J_7", said)
        self.assertEqual(len(re.findall("is in deg and scale is 1", said)), 6, said)
        self.assertNotIn("appears twice", said)
        self.processes.pop().close()
        self.assertIn("appears twice", self.run_gateway("--verbose").output())

    def test_status_and_log_show_joints_that_nothing_gives_or_that_are_beyond_their_range(self):
        gateway = self.run_gateway()
        simulator = g.sim_robot("dbc", "--dbc", self.scratch.home / "robots/arm.dbc", "--channel", CHANNEL, "--position",
                                "First.A1,First.A2,First.A3,First.A4,Second.A5,Second.A6", "--units-per-rad", "2.2",
                                "--motion", "hold:position=1", "--rate", "50")
        self.processes.append(simulator)
        self.assertEqual(self.scratch.send("ROBOT ARM online").returncode, 0)
        self.assertTrue(g.eventually(lambda: self.scratch.robot("ARM")["stream"]["state"] == "fresh"),
                        "a joint without a signal keeps no stream from being fresh")
        joints = lambda: self.scratch.robot("ARM")["joints"]
        self.assertTrue(g.eventually(lambda: [joint["beyond_range"] for joint in joints()] == [True] * 6 + [False]), joints())
        self.assertEqual(joints()[6]["state"], "none")
        text = self.scratch.cellmirror("status").stdout
        self.assertIn("J_7 0.00 deg (none)", text)
        self.assertIn("(beyond -114.592 .. 114.592 deg)", text)
        self.assertTrue(g.eventually(lambda: "J_1 of ARM is at" in gateway.output()), gateway.output())
        simulator.kill()
        self.assertTrue(g.eventually(lambda: self.scratch.robot("ARM")["stream"]["state"] == "lost"))

    def test_degrees_for_radians_are_implausible(self):
        self.run_gateway()
        simulator = g.sim_robot("dbc", "--dbc", self.scratch.home / "robots/arm.dbc", "--channel", CHANNEL, "--position",
                                "First.A1,First.A2", "--units-per-rad", "57.29578", "--motion", "hold:position=1", "--rate",
                                "50")
        self.processes.append(simulator)
        self.assertEqual(self.scratch.send("ROBOT ARM online").returncode, 0)
        self.assertTrue(g.eventually(lambda: self.scratch.robot("ARM")["joints"][0]["state"] == "implausible"))
        self.assertEqual(self.scratch.robot("ARM")["joints"][0]["position"], 0)
        condition = lambda: self.scratch.robot("ARM")["stream"]["condition"]
        self.assertTrue(g.eventually(lambda: "beyond 2.4 rad" in condition()), condition())


if __name__ == "__main__":
    g.main()

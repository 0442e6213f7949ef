"""A ROS 2 controller of a simulated robot, commanded by foreign programs: trajectories by Cyclone DDS, the action by a client of its own."""

import json
import unittest

import gateway as g

ROBOT, NAME, DOMAIN = "MANTEC_R3", "arm_controller", "88"  # of this test alone
JOINTS = [f"J_{i}" for i in range(1, 7)]
PATIENCE_S = 30
TABLES = f"""
[[controller]]
robot = "{ROBOT}"
name = "/{NAME}"
domain = {DOMAIN}
"""
SUCCEEDED, CANCELED, ABORTED = 4, 5, 6  # action_msgs/GoalStatus


def setUpModule():
    g.require(g.BIN / "dds_cyclone_peer", "Cyclone DDS is not installed")


class Peer(g.Process):
    """Takes commands on its standard input and prints JSON."""

    def write(self, line):
        self.child.stdin.write(line.encode() + b"\n")
        self.child.stdin.flush()

    def lines(self, key):
        found = []
        for line in self.output().splitlines(keepends=True):
            if line.startswith("{") and line.endswith("\n"):
                parsed = json.loads(line)
                if key in parsed:
                    found.append(parsed)
        return found

    def next_line(self, key, before):
        """The line with that key behind the first `before` ones, when it has come."""
        g.eventually(lambda: len(self.lines(key)) > before, PATIENCE_S)
        found = self.lines(key)
        assert len(found) > before, f"no more {key}: {self.output()}"
        return found[before]


def points(*targets):
    """T and the position of all joints, or of each."""
    out = []
    for t, target in targets:
        values = target if isinstance(target, list) else [target] * len(JOINTS)
        out.append(f"{t}:{','.join(str(value) for value in values)}")
    return out


class Controllers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = g.Scratch()
        cls.addClassCleanup(cls.scratch.remove)
        cls.scratch.cell_file.write_text(cls.scratch.cell_file.read_text() + TABLES)
        cls.gateway = g.Gateway(cls.scratch)
        cls.addClassCleanup(cls.gateway.close)
        cls.peer = Peer([g.BIN / "dds_cyclone_peer", "controller", DOMAIN, NAME], stdin=True)
        cls.addClassCleanup(cls.peer.close)
        cls.client = Peer([g.BIN / "dds_action_client", DOMAIN, NAME], stdin=True)
        cls.addClassCleanup(cls.client.close)
        cls.client.next_line("ready", 0)
        assert g.eventually(lambda: cls.status()["publishers"] == 1, PATIENCE_S), cls.status()

    @classmethod
    def status(cls):
        return next(one for one in cls.scratch.status()["controllers"] if one["name"] == f"/{NAME}")

    def position(self, joint=0):
        return self.scratch.robot(ROBOT)["joints"][joint]["position"]

    def settled(self):
        """The newest trajectory has ended; its last state."""
        def ended():
            trajectory = self.status()["trajectory"]
            return trajectory and trajectory["state"] not in ("running", "none")
        self.assertTrue(g.eventually(ended, PATIENCE_S), self.status())
        return self.status()["trajectory"]["state"]

    def command(self, *targets, joints=JOINTS):
        """Has it taken."""
        taken = self.status()["taken"]
        self.peer.write(f"{','.join(joints)} 0 {' '.join(points(*targets))}")
        self.assertTrue(g.eventually(lambda: self.status()["taken"] == taken + 1, PATIENCE_S), self.status())

    def refused(self, line, reason):
        before = self.status()["refusals"].get(reason, 0)
        self.peer.write(line)
        seen = g.eventually(lambda: self.status()["refusals"].get(reason, 0) == before + 1, PATIENCE_S)
        self.assertTrue(seen, (line, reason, self.status()))
        self.assertIn(reason, self.status()["last_refusal"]["text"])

    def goal(self, number, *targets, more="", joints=JOINTS):
        before = len(self.client.lines("accepted"))
        self.client.write(f"goal {number} {','.join(joints)} {';'.join(points(*targets))} {more}")
        return self.client.next_line("accepted", before)["accepted"]

    def result(self, number):
        before = len(self.client.lines("result"))
        self.client.write(f"result {number}")
        return self.client.next_line("result", before)

    def test_a_trajectory_moves_the_robot(self):
        self.command((0.2, 0.1), (0.5, 0.2))
        self.assertEqual(self.settled(), "arrived")
        self.assertTrue(g.eventually(lambda: abs(self.position(5) - 0.2) < 1e-9, PATIENCE_S), self.scratch.robot(ROBOT))
        table = self.scratch.cellmirror("status").stdout
        self.assertIn(f"controller /{NAME} of {ROBOT}: 1 publisher", table)

    def test_a_new_one_takes_the_place_of_the_running_one(self):
        replaced = self.status()["replaced"]
        self.command((300, 0.3))
        self.command((0.3, -0.1))
        self.assertEqual(self.status()["replaced"], replaced + 1)
        self.assertEqual(self.settled(), "arrived")
        self.assertTrue(g.eventually(lambda: abs(self.position() + 0.1) < 1e-9, PATIENCE_S))

    def test_it_ends_by_an_empty_one_and_by_stop_rob_and_keeps_others_out(self):
        stops = self.status()["stops"]
        self.command((300, 0.3))
        done = self.scratch.send(f"POS_ROB {ROBOT} JOINT_ABS 0 0 0 0 0 0")
        self.assertEqual(done.returncode, 1)
        self.assertIn(f"on a trajectory of the controller {NAME}", done.stderr)
        self.peer.write(f"{','.join(JOINTS)} 0")
        self.assertTrue(g.eventually(lambda: self.status()["stops"] == stops + 1, PATIENCE_S), self.status())
        self.assertEqual(self.settled(), "stopped")
        self.command((300, 0.3))
        self.assertEqual(self.scratch.send(f"STOP_ROB {ROBOT}").returncode, 0)
        self.assertEqual(self.settled(), "stopped")
        self.assertEqual(self.scratch.send(f"POS_ROB {ROBOT} JOINT_INC 1").returncode, 0)

    def test_what_is_wrong_is_refused_with_the_reason(self):
        names = ",".join(JOINTS)
        self.refused(f"{names.replace('J_6', 'J_7')} 0 {points((1, 0))[0]}", "joints")
        self.refused(f"J_1,J_2 0 1:0,0", "joints")
        self.refused(f"{names} 0 1:0,0", "sizes")
        self.refused(f"{names} 0 {' '.join(points((1, 0), (0.5, 0)))}", "times")
        self.refused(f"{names} 0 {points((1, [0, 0, 'nan', 0, 0, 0]))[0]}", "not_finite")
        self.refused(f"{names} 0 {points((1, 9))[0]}", "beyond_range")
        self.refused(f"{names} 5 {points((1, 0))[0]}", "past")
        self.refused(f"{names} 0 {points((1, 0))[0]}:0,0,0,0,0,0.5", "end_velocity")
        many = " ".join(points(*((0.001 * (i + 1), 0) for i in range(10_001))))
        self.refused(f"{names} 0 {many}", "too_many_points")

    def test_the_state_is_published(self):
        self.command((0.2, 0.15))
        self.settled()
        seen = g.eventually(lambda: [line for line in self.peer.lines("reference") if abs(line["feedback"][0] - 0.15) < 1e-9],
                            PATIENCE_S)
        self.assertTrue(seen, self.status())
        self.assertEqual(len(seen[-1]["reference"]), len(JOINTS))

    def test_a_goal_succeeds_with_feedback(self):
        before = len(self.client.lines("feedback"))
        self.assertTrue(self.goal(1, (0.3, 0.1), (1.5, 0.2)))
        result = self.result(1)
        self.assertEqual((result["result"], result["error_code"]), (SUCCEEDED, 0))
        feedback = self.client.next_line("feedback", before)
        self.assertEqual(feedback["feedback"], 1)
        self.assertEqual(len(feedback["desired"]), len(JOINTS))
        self.assertTrue(g.eventually(lambda: any(line["status"].get("1") == SUCCEEDED for line in self.client.lines("status")), PATIENCE_S))
        self.assertTrue(g.eventually(lambda: abs(self.position() - 0.2) < 1e-9, PATIENCE_S))

    def test_goals_that_are_wrong_tell_why(self):
        self.assertTrue(self.goal(11, (1, 0), joints=JOINTS[:5] + ["other"]))
        result = self.result(11)
        self.assertEqual((result["result"], result["error_code"]), (ABORTED, -2))
        self.assertIn("no joint other", result["text"])
        self.assertTrue(self.goal(12, (0.1, 1.2), (60, 1.3), more="path=0.05"))
        result = self.result(12)
        self.assertEqual((result["result"], result["error_code"]), (ABORTED, -4), result)
        self.assertTrue(self.goal(13, (0.1, -1.2), more="goal=0.001 time=0.01"))
        result = self.result(13)
        self.assertEqual((result["result"], result["error_code"]), (ABORTED, -5), result)
        self.assertFalse(self.goal(13, (1, 0)), "the id is known")

    def test_a_goal_can_be_cancelled_and_replaced(self):
        self.assertTrue(self.goal(21, (300, 0.1)))
        before = len(self.client.lines("cancel"))
        self.client.write("cancel 21")
        self.assertEqual(self.client.next_line("cancel", before), {"cancel": 0, "goals": 1})
        self.assertEqual(self.result(21)["result"], CANCELED)
        self.client.write("cancel 21")
        self.assertEqual(self.client.next_line("cancel", before + 1), {"cancel": 3, "goals": 0})
        self.client.write("cancel 99")
        self.assertEqual(self.client.next_line("cancel", before + 2), {"cancel": 2, "goals": 0})
        self.assertTrue(self.goal(22, (300, 0.1)))
        self.assertTrue(self.goal(23, (0.2, 0.1)))
        self.assertEqual(self.result(22)["result"], CANCELED)
        self.assertEqual(self.result(23)["result"], SUCCEEDED)


if __name__ == "__main__":
    g.main()

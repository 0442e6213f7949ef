"""A ROS 2 controller of a simulated robot, commanded by foreign programs: trajectories by Cyclone DDS, the action by clients of their own."""

import functools
import json
import os
import signal
import struct
import time
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
UNKNOWN, SUCCEEDED, CANCELED, ABORTED = 0, 4, 5, 6  # action_msgs/GoalStatus


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


def each_client(test):
    """Calls it with a client as rmw_fastrtps makes one and with one as rmw_cyclonedds does, and with numbers of goals for each."""
    @functools.wraps(test)
    def of_all(self):
        for client, goals in ((self.client, 0), (self.cyclone, 100)):
            with self.subTest(client=str(client.program)):
                test(self, client, goals)
    return of_all


def goal_without_header():
    """FollowJointTrajectory_SendGoal_Request from its fifth byte on, which dds_cyclone_action_client counts in the first four."""
    identity, stamp, nothing = bytes(12), bytes(8), struct.pack("<I4x", 1)
    joints = struct.pack("<I", len(JOINTS)) + b"".join(struct.pack("<I3sx", 4, joint.encode()) for joint in JOINTS)
    multi_dof = stamp + nothing + bytes(8)
    return identity + stamp + nothing + joints + bytes(4) + multi_dof + bytes(16) + bytes(8)


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
        cls.client = cls.action_client("dds_action_client")
        cls.cyclone = cls.action_client("dds_cyclone_action_client")
        assert g.eventually(lambda: cls.status()["publishers"] == 1, PATIENCE_S), cls.status()

    @classmethod
    def action_client(cls, program):
        client = Peer([g.BIN / program, DOMAIN, NAME], stdin=True)
        client.program = program
        cls.addClassCleanup(client.close)
        client.next_line("ready", 0)
        return client

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

    def goal(self, client, number, *targets, more="", joints=JOINTS):
        before = len(client.lines("accepted"))
        client.write(f"goal {number} {','.join(joints)} {';'.join(points(*targets))} {more}")
        return client.next_line("accepted", before)["accepted"]

    def result(self, client, number):
        before = len(client.lines("result"))
        client.write(f"result {number}")
        return client.next_line("result", before)

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

    @each_client
    def test_a_goal_succeeds_with_feedback(self, client, goals):
        before = len(client.lines("feedback"))
        self.assertTrue(self.goal(client, goals + 1, (0.3, 0.1), (1.5, 0.2)))
        result = self.result(client, goals + 1)
        self.assertEqual((result["result"], result["error_code"]), (SUCCEEDED, 0))
        feedback = client.next_line("feedback", before)
        self.assertEqual(feedback["feedback"], goals + 1)
        self.assertEqual(len(feedback["desired"]), len(JOINTS))
        self.assertTrue(g.eventually(lambda: any(line["status"].get(str(goals + 1)) == SUCCEEDED for line in client.lines("status")),
                                     PATIENCE_S))
        self.assertTrue(g.eventually(lambda: abs(self.position() - 0.2) < 1e-9, PATIENCE_S))

    @each_client
    def test_a_goal_goes_on_while_the_process_of_dds_is_replaced(self, client, goals):
        self.assertTrue(self.goal(client, goals + 45, (0.5, 0.1), (6, 0.3)))
        before = len(client.lines("result"))
        client.write(f"result {goals + 45}")  # waits in the gateway
        process = next(one for one in self.scratch.status()["processes"] if f"domain {DOMAIN} " in one["subject"])
        os.kill(process["pid"], signal.SIGKILL)
        result = client.next_line("result", before)
        self.assertEqual((result["result"], result["error_code"]), (SUCCEEDED, 0))
        self.assertTrue(g.eventually(lambda: abs(self.position() - 0.3) < 1e-9, PATIENCE_S))
        self.assertTrue(self.goal(client, goals + 46, (0.3, 0.2)), "the new process takes goals")
        self.assertEqual(self.result(client, goals + 46)["result"], SUCCEEDED)

    def test_a_trajectory_is_not_executed_again_by_the_next_process_of_dds(self):
        # Cyclone DDS gives a new reader what the one that was killed had not acknowledged.
        for round_ in range(2):
            self.command((0.3, 0.05 * (round_ + 1)))
            self.assertEqual(self.settled(), "arrived")
            taken = self.status()["taken"]
            process = next(one for one in self.scratch.status()["processes"] if f"domain {DOMAIN} " in one["subject"])
            os.kill(process["pid"], signal.SIGKILL)
            self.assertTrue(g.eventually(lambda: self.status()["publishers"] == 0, PATIENCE_S))
            self.assertTrue(g.eventually(lambda: self.status()["publishers"] == 1, PATIENCE_S))
            time.sleep(1)
            self.assertEqual(self.status()["taken"], taken)

    @each_client
    def test_goals_that_are_wrong_tell_why(self, client, goals):
        self.assertTrue(self.goal(client, goals + 11, (1, 0), joints=JOINTS[:5] + ["other"]))
        result = self.result(client, goals + 11)
        self.assertEqual((result["result"], result["error_code"]), (ABORTED, -2))
        self.assertIn("no joint other", result["text"])
        self.assertTrue(self.goal(client, goals + 12, (0.1, 1.2), (60, 1.3), more="path=0.05"))
        result = self.result(client, goals + 12)
        self.assertEqual((result["result"], result["error_code"]), (ABORTED, -4), result)
        self.assertTrue(self.goal(client, goals + 13, (0.1, -1.2), more="goal=0.001 time=0.01"))
        result = self.result(client, goals + 13)
        self.assertEqual((result["result"], result["error_code"]), (ABORTED, -5), result)
        self.assertFalse(self.goal(client, goals + 13, (1, 0)), "the id is known")

    @each_client
    def test_a_goal_beyond_the_limits_is_refused(self, client, goals):
        many = [(0.001 * (i + 1), 0) for i in range(14_000)]
        self.assertFalse(self.goal(client, goals + 31, *many[:10_001]), "too many points")
        self.assertFalse(self.goal(client, goals + 31, *many), "more than 1 MiB")

    @each_client
    def test_a_goal_can_be_cancelled_and_replaced(self, client, goals):
        self.assertTrue(self.goal(client, goals + 21, (300, 0.1)))
        before = len(client.lines("cancel"))
        client.write(f"cancel {goals + 21}")
        self.assertEqual(client.next_line("cancel", before), {"cancel": 0, "goals": 1})
        self.assertEqual(self.result(client, goals + 21)["result"], CANCELED)
        client.write(f"cancel {goals + 21}")
        self.assertEqual(client.next_line("cancel", before + 1), {"cancel": 3, "goals": 0})
        client.write("cancel 99")
        self.assertEqual(client.next_line("cancel", before + 2), {"cancel": 2, "goals": 0})
        self.assertTrue(self.goal(client, goals + 22, (300, 0.1)))
        self.assertTrue(self.goal(client, goals + 23, (0.2, 0.1)))
        self.assertEqual(self.result(client, goals + 22)["result"], CANCELED)
        self.assertEqual(self.result(client, goals + 23)["result"], SUCCEEDED)

    def test_clients_of_both_kinds_hear_only_their_own_replies(self):
        other = self.action_client("dds_cyclone_action_client")
        clients = ((self.cyclone, 141), (other, 142), (self.client, 43))
        keys = ("accepted", "result", "cancel")
        before = {client: [len(client.lines(key)) for key in keys] for client, _ in clients}
        for client, number in clients:
            self.assertTrue(self.goal(client, number, (300, 0.1)))
            client.write(f"result {number}")
        self.client.write("cancel 43")
        results = [client.next_line("result", before[client][1])["result"] for client, _ in clients]
        self.assertEqual(results, [CANCELED] * 3, "two were replaced, the last was cancelled")
        # What comes after has come behind all that was said to others.
        for client, number in clients:
            self.assertEqual(self.result(client, number)["result"], CANCELED)
        for client, _ in clients:
            heard = [len(client.lines(key)) - count for key, count in zip(keys, before[client])]
            self.assertEqual(heard, [1, 2, 1 if client is self.client else 0], client.program)
            self.assertEqual(client.lines("unexpected"), [])
        self.assertTrue(other.lines("foreign"), "replies to others reach it too")

    def test_an_answer_waits_for_the_reader_of_who_asked(self):
        self.cyclone.write("late 199")
        self.assertEqual(self.cyclone.next_line("late", 0)["late"], UNKNOWN)
        self.assertEqual(self.status()["action"]["unanswered"], 0)

    def test_clients_that_come_and_are_killed_are_answered_at_once(self):
        # What the killed ones did not acknowledge stays in the writer's history for those that come after.
        for _ in range(10):
            for program in ("dds_cyclone_action_client", "dds_action_client"):
                client = self.action_client(program)
                self.assertEqual(self.result(client, 250)["result"], UNKNOWN)
                client.kill()

    def test_requests_whose_header_is_cut_or_missing_are_refused(self):
        requests = [("goal", bytes(4)), ("cancel", bytes(11)), ("result", b""),  # cut inside the header
                    ("goal", bytes(12)), ("cancel", bytes(12)), ("result", bytes(20)),  # nothing behind it, or not enough
                    ("goal", bytes(range(200))),
                    ("goal", goal_without_header()), ("cancel", bytes(20)), ("result", bytes(12))]
        for service, content in requests:
            with self.subTest(service=service, bytes=len(content)):
                before = self.status()["action"]["bad_requests"]
                malformed = self.status()["refusals"].get("malformed", 0) + (service == "goal")
                self.cyclone.write(f"raw {service} {content.hex()}")
                self.assertTrue(g.eventually(lambda: self.status()["action"]["bad_requests"] > before, PATIENCE_S), self.status())
                self.assertEqual(self.status()["action"]["bad_requests"], before + 1)
                self.assertTrue(g.eventually(lambda: self.status()["refusals"].get("malformed", 0) == malformed, PATIENCE_S))
        for client, number in ((self.client, 51), (self.cyclone, 151)):
            self.assertTrue(self.goal(client, number, (0.2, 0.1)))
            self.assertEqual(self.result(client, number)["result"], SUCCEEDED)


if __name__ == "__main__":
    g.main()

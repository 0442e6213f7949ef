"""Robots move: every POS_ROB mode ends where it says, files wait, messages are answered at arrival."""

import ctypes
import json
import math
import os
import threading
import time
import unittest

import gateway as g

ARM = "MANTEC_R3"  # its base and ZP frame stand at (2.0, -1.6, 0) in the world, not turned
BASE = (2.0, -1.6, 0.0)
READY = f"POS_ROB {ARM} JOINT_ABS 0 40 80 0 30 0"


def degrees(*values):
    return [math.radians(value) for value in values]


class Sender:
    """Untagged messages, as any program may send them: nobody is answered."""

    def __init__(self, scratch):
        info = json.loads(next(scratch.runtime.glob(f"**/{scratch.instance}/instance.json")).read_text())
        self.libc = ctypes.CDLL(None, use_errno=True)
        self.queue = self.libc.msgget(info.get("script_key") or info["queues"]["script_key"], 0)

    def send(self, command):
        data = command.encode()
        if self.libc.msgsnd(self.queue, (5).to_bytes(8, "little") + data, len(data), 0) != 0:
            raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))


class Background(threading.Thread):
    """A command whose answer takes long."""

    def __init__(self, scratch, command):
        super().__init__()
        self.scratch, self.command, self.done = scratch, command, None
        self.start()

    def run(self):
        self.done = self.scratch.send(self.command)

    def answer(self):
        self.join(120)
        return self.done


class Motion(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = g.Scratch()
        cls.scripts = cls.scratch.home / "scripts"
        cls.gateway = g.Gateway(cls.scratch)
        cls.sender = Sender(cls.scratch)

    @classmethod
    def tearDownClass(cls):
        status = cls.gateway.stop()
        cls.gateway.close()
        cls.scratch.remove()
        assert status == 0, f"the gateway ended with {status}"

    def setUp(self):
        for command in (f"STOP_ROB {ARM}", f"ROBACT {ARM}", "rob_positioning jump", "rob_tcp_def 0 0 0 0 0 0", READY,
                        "rob_positioning move"):
            self.done(command)

    def done(self, command):
        done = self.scratch.send(command)
        self.assertEqual(done.returncode, 0, f"{command}: {done.stderr}")

    def refused(self, command, *words):
        done = self.scratch.send(command)
        self.assertEqual(done.returncode, 1, f"{command}: {done.stdout}")
        for word in words:
            self.assertIn(word, done.stderr)

    def joints(self, robot=ARM):
        return [joint["position"] for joint in self.scratch.robot(robot)["joints"]]

    def tcp(self, robot=ARM):
        tcp = self.scratch.robot(robot)["tcp"]
        return tcp["position_m"], tcp["quaternion_xyzw"]

    def motion(self, robot=ARM):
        return self.scratch.robot(robot)["motion"]

    def at(self, expected, actual, tolerance=5e-5):
        for wanted, value in zip(expected, actual, strict=True):
            self.assertAlmostEqual(wanted, value, delta=tolerance)

    def same_rotation(self, expected, actual):
        self.assertAlmostEqual(abs(sum(a * b for a, b in zip(expected, actual))), 1.0, delta=1e-8)

    # --- the six modes: the answer comes when the robot is there

    def test_joint_abs_and_joint_inc(self):
        self.done(f"POS_ROB {ARM} JOINT_ABS 10 20 70 5 25 -5")
        self.at(degrees(10, 20, 70, 5, 25, -5), self.joints(), 1e-9)
        self.done(f"POS_ROB {ARM} JOINT_INC 5 -5")
        self.at(degrees(15, 15, 70, 5, 25, -5), self.joints(), 1e-9)
        self.assertEqual(self.motion()["outcome"], "arrived")
        self.assertFalse(self.motion()["moving"])

    def test_frame_abs(self):
        self.done(f"POS_ROB {ARM} FRAME_ABS 600 300 900 180 0 0")
        position, rotation = self.tcp()
        self.at((BASE[0] + 0.6, BASE[1] + 0.3, 0.9), position)
        self.same_rotation((1, 0, 0, 0), rotation)

    def test_frame_inc_is_in_the_axes_of_the_zp_frame(self):
        self.done(f"POS_ROB {ARM} FRAME_ABS 600 300 900 180 0 0")
        self.done(f"POS_ROB {ARM} FRAME_INC X 50 Z -20 C 30")
        position, rotation = self.tcp()
        self.at((BASE[0] + 0.65, BASE[1] + 0.3, 0.88), position)
        self.same_rotation((math.cos(math.radians(15)), math.sin(math.radians(15)), 0, 0), rotation)

    def test_tool_inc_is_in_the_axes_of_the_tcp(self):
        self.done(f"POS_ROB {ARM} FRAME_ABS 600 300 900 180 0 0")  # the tool's z points down, its y to -y
        self.done(f"POS_ROB {ARM} TOOL_INC Y 10 Z 20")
        self.at((BASE[0] + 0.6, BASE[1] + 0.29, 0.88), self.tcp()[0])

    def test_screen_inc_is_in_the_axes_of_the_current_view(self):
        self.done(f"POS_ROB {ARM} FRAME_ABS 600 300 900 180 0 0")
        self.done("STDP 3")  # from above: x right, y up on the screen, z towards the viewer
        self.done(f"POS_ROB {ARM} SCREEN_INC X 10 Y 20 Z 5")
        self.at((BASE[0] + 0.61, BASE[1] + 0.32, 0.905), self.tcp()[0])
        self.done("STDP 4")  # from the side, -y: x right, z up, -y towards the viewer
        self.done(f"POS_ROB {ARM} SCREEN_INC X 10 Y 20 Z 5")
        self.at((BASE[0] + 0.62, BASE[1] + 0.315, 0.925), self.tcp()[0])
        self.done("STVW 4 TW 90")  # the screen is turned: its x is up
        self.done(f"POS_ROB {ARM} SCREEN_INC X 10")
        self.at((BASE[0] + 0.62, BASE[1] + 0.315, 0.935), self.tcp()[0])

    def test_tool_centre_point_of_the_next_command(self):
        self.done(f"POS_ROB {ARM} FRAME_ABS 600 300 900 180 0 0")
        self.done("rob_tcp_def 0 0 100 0 0 0")
        self.at((BASE[0] + 0.6, BASE[1] + 0.3, 0.8), self.tcp()[0])
        self.done(f"POS_ROB {ARM} FRAME_ABS 600 300 900 180 0 0")
        self.at((BASE[0] + 0.6, BASE[1] + 0.3, 0.9), self.tcp()[0])

    def slow(self, robot=ARM):
        """So slow that a move still goes on however late this machine looks; until the test ends."""
        fast = self.scratch.robot(robot)["parameters"]["active_velocity"]
        self.set_velocities(robot, [0.3] * len(fast))
        self.addCleanup(self.set_velocities, robot, fast)

    def set_velocities(self, robot, values):
        self.done(f"ROBACT {robot}")
        self.done("rob_jnt_act_vel " + " ".join(f"{value:.17g}" for value in values))

    # --- time

    def test_answer_comes_at_arrival(self):
        start = time.monotonic()
        self.done(f"POS_ROB {ARM} JOINT_INC 90")  # 1.57 rad at 3 rad/s and 15 rad/s2: 0.72 s
        self.assertGreater(time.monotonic() - start, 0.5)
        self.assertAlmostEqual(self.joints()[0], math.pi / 2, delta=1e-9)

    def test_other_messages_are_executed_while_one_waits(self):
        self.slow()
        waiting = Background(self.scratch, f"POS_ROB {ARM} JOINT_INC 80")  # 5 s
        self.assertTrue(g.eventually(lambda: self.motion()["moving"], every=0.01))
        self.done("hot_message meanwhile")
        self.assertTrue(self.motion()["moving"])
        self.assertEqual(waiting.answer().returncode, 0)

    def test_file_waits_for_each_pos_rob_so_that_connect_grips_at_the_right_place(self):
        (self.scripts / "grip.spt").write_text(
            "POS_ROB ZELLENKRAN JOINT_ABS 500 45 0;\nCONNECT Mantec_3 TO Zellenkran.HAKEN;\n"
            "POS_ROB ZELLENKRAN JOINT_INC 400;\nhot_message gripped;\n")
        before = self.tcp("mantec_R3")[0]
        self.done("EXEC_SCRIPT grip.spt")
        self.assertTrue(g.eventually(lambda: "gripped" in str(self.scratch.status()["messages"])))
        self.at([0.9, math.pi / 4, 0], self.joints("ZELLENKRAN"), 1e-9)
        # It hung on the hook from where the crane stood at 500 mm, so it went 400 mm along.
        self.at((before[0] + 0.4, before[1], before[2]), self.tcp("mantec_R3")[0], 1e-6)

    def test_connect_behind_a_jump_grips_at_the_right_place_too(self):
        (self.scripts / "jump.spt").write_text(
            "ROBACT ZELLENKRAN;\nrob_positioning jump;\nPOS_ROB ZELLENKRAN JOINT_ABS 1500 0 0;\n"
            "CONNECT Puma TO Zellenkran.HAKEN;\nPOS_ROB ZELLENKRAN JOINT_INC 400;\nrob_positioning move;\n"
            "DRAW_SCENE;\nhot_message jumped;\n")
        before = self.tcp("PUMA_762")[0]
        self.done("EXEC_SCRIPT jump.spt")
        self.assertTrue(g.eventually(lambda: "jumped" in str(self.scratch.status()["messages"])))
        self.at((before[0] + 0.4, before[1], before[2]), self.tcp("PUMA_762")[0], 1e-6)
        self.done("CONNECT Puma TO HTL_UMGEBUNG")

    def test_gateway_ends_in_order_while_a_robot_moves_straight(self):
        scratch = g.Scratch()
        gateway = g.Gateway(scratch)
        try:
            for command in (f"ROBACT {ARM}", "rob_cart_lin_vel 20", f"POS_ROB {ARM} FRAME_ABS 600 300 900 180 0 0"):
                self.assertEqual(scratch.send(command).returncode, 0)
            Sender(scratch).send(f"POS_ROB {ARM} FRAME_INC X 100")
            self.assertTrue(g.eventually(lambda: scratch.robot(ARM)["motion"]["moving"], every=0.01))
            self.assertEqual(gateway.stop(), 0, gateway.output())
        finally:
            gateway.close()
            scratch.remove()

    def test_wait_waits_for_queued_moves(self):
        (self.scripts / "wait.spt").write_text(
            f"MOVE_ROB {ARM} PTP JOINT_INC 20;\nMOVE_ROB {ARM} LIN FRAME_INC Z 30;\nMOVE_ROB {ARM} PTP JOINT_INC -20;\n"
            "WAIT;\nhot_message waited;\n")
        self.done("EXEC_SCRIPT wait.spt")
        self.assertTrue(g.eventually(lambda: "waited" in str(self.scratch.status()["messages"])))
        motion = self.motion()
        self.assertFalse(motion["moving"])
        self.assertEqual(motion["outcome"], "arrived")
        self.assertAlmostEqual(self.joints()[0], 0.0, delta=1e-4)

    def test_start_and_reference_positions(self):
        self.done("rob_jnt_ref_pos 5 6 7 8 9 10")
        self.done(f"MOVE_ROB {ARM} PTP REFERENCE")
        self.assertTrue(g.eventually(lambda: not self.motion()["moving"] and self.joints()[0] > 0.08))
        self.at(degrees(5, 6, 7, 8, 9, 10), self.joints(), 1e-9)

    # --- one command takes the place of another

    def test_stream_of_small_increments_adds_up(self):
        self.done(f"POS_ROB {ARM} FRAME_ABS 600 300 900 180 0 0")
        for _ in range(100):
            self.sender.send(f"POS_ROB {ARM} FRAME_INC Y -1")
        g.eventually(lambda: not self.motion()["moving"] and abs(self.tcp()[0][1] - BASE[1] - 0.2) < 1e-4)
        self.at((BASE[0] + 0.6, BASE[1] + 0.2, 0.9), self.tcp()[0], 2e-5)
        self.same_rotation((1, 0, 0, 0), self.tcp()[1])

    def test_superseded_move_is_told_to_who_waits(self):
        self.slow()
        waiting = Background(self.scratch, f"POS_ROB {ARM} JOINT_INC 120")
        self.assertTrue(g.eventually(lambda: self.motion()["moving"], every=0.01))
        self.done(f"POS_ROB {ARM} JOINT_ABS 5")
        answer = waiting.answer()
        self.assertEqual(answer.returncode, 1)
        self.assertIn("newer command", answer.stderr)
        self.assertAlmostEqual(self.joints()[0], math.radians(5), delta=1e-9)

    def test_stopped_move_is_told_to_who_waits_and_forgets_what_is_queued(self):
        self.slow()
        waiting = Background(self.scratch, f"POS_ROB {ARM} JOINT_INC 150")
        self.assertTrue(g.eventually(lambda: self.motion()["moving"], every=0.01))
        self.done(f"MOVE_ROB {ARM} PTP JOINT_INC 0 10")
        self.done(f"STOP_ROB {ARM}")
        answer = waiting.answer()
        self.assertEqual(answer.returncode, 1)
        self.assertIn("stopped", answer.stderr)
        self.assertTrue(g.eventually(lambda: not self.motion()["moving"]))
        self.assertEqual(self.motion()["outcome"], "stopped")
        stands = self.joints()
        self.assertLess(stands[0], math.radians(149))
        self.done(f"POS_ROB {ARM} JOINT_INC -5")  # from where it stands
        self.at([stands[0] - math.radians(5)] + stands[1:], self.joints(), 1e-9)

    def test_full_queue_is_refused_and_what_was_accepted_is_done(self):
        (self.scripts / "many.spt").write_text(f"MOVE_ROB {ARM} PTP JOINT_INC 0.1;\n" * 60)
        before = self.scratch.status()["script"]["refused"]
        self.slow()
        self.done(f"MOVE_ROB {ARM} PTP JOINT_INC 150")  # still on its way when the file has been read, however slow that is
        self.done("EXEC_SCRIPT many.spt")
        self.assertTrue(g.eventually(lambda: self.scratch.status()["script"]["refused"] > before))
        self.assertIn("32 moves", str(self.scratch.status()["script"]["last_errors"]))
        self.done(f"STOP_ROB {ARM}")

    # --- refusals

    def test_pose_out_of_reach_tells_the_nearest_and_moves_nothing(self):
        before = self.joints()
        self.refused(f"POS_ROB {ARM} FRAME_ABS 5000 0 500 0 0 0", "cannot reach", "mm", "degrees")
        self.assertEqual(before, self.joints())

    def test_robot_with_three_joints_says_what_it_cannot_meet(self):
        self.refused("POS_ROB ZELLENKRAN FRAME_ABS 1000 200 1000 0 0 0", "with 3 joints", "z by", "rob_inverse_class")
        self.refused("POS_ROB ZELLENKRAN FRAME_INC Z 5", "3 joints", "rob_inverse_class")
        self.done("ROBACT ZELLENKRAN")
        self.done("rob_inverse_class align_XY_AXIS")
        self.done("POS_ROB ZELLENKRAN FRAME_ABS 1000 200 1000 0 0 0")

    def test_straight_line_that_cannot_be_gone_hints_at_ptp(self):
        self.refused(f"POS_ROB {ARM} FRAME_INC Z 5000", "PTP")

    def test_values_beyond_limits_move_nothing(self):
        before = self.joints()
        self.refused(f"POS_ROB {ARM} JOINT_ABS 500", "J_1", "limit")
        self.refused(f"MOVE_ROB {ARM} PTP JOINT_ABS 500", "J_1", "limit")
        self.assertEqual(before, self.joints())

    def test_robot_that_is_online_takes_no_motion_commands(self):
        robot = "PUMA_762"
        self.slow(robot)
        waiting = Background(self.scratch, f"POS_ROB {robot} JOINT_INC 100")
        self.assertTrue(g.eventually(lambda: self.motion(robot)["moving"], every=0.01))
        self.done(f"ROBOT {robot} online")
        try:
            self.assertIn("online", waiting.answer().stderr)
            for command in (f"POS_ROB {robot} FRAME_INC X 1", f"MOVE_ROB {robot} PTP START", f"STOP_ROB {robot}"):
                self.refused(command, "offline")
        finally:
            self.done(f"ROBOT {robot} offline")
        self.assertFalse(self.motion(robot)["moving"])
        stands = self.joints(robot)
        self.done(f"POS_ROB {robot} JOINT_INC 1")
        self.assertAlmostEqual(self.joints(robot)[0], stands[0] + math.radians(1), delta=1e-9)

    def test_robot_that_is_deleted_while_it_moves_is_told_to_who_waits(self):
        self.slow("mantec_R3a")
        waiting = Background(self.scratch, "POS_ROB mantec_R3a JOINT_INC 120")
        self.assertTrue(g.eventually(lambda: self.motion("mantec_R3a")["moving"], every=0.01))
        self.done("DELETE_NODE Mantec_4")
        self.assertIn("deleted", waiting.answer().stderr)
        self.done("ACTIVATE Mantec_4")
        self.done("POS_ROB mantec_R3a JOINT_INC 10")
        self.at(degrees(10, 0, 0, 0, 0, 0), self.joints("mantec_R3a"), 1e-9)

    # --- parameters

    def test_jump_is_at_once_in_every_mode(self):
        self.slow()  # 7 s, if it did not jump
        for command in (f"ROBACT {ARM}", "rob_positioning jump"):
            self.done(command)
        start = time.monotonic()
        self.done(f"POS_ROB {ARM} JOINT_INC 120")
        self.done(f"POS_ROB {ARM} FRAME_ABS 600 300 900 180 0 0")
        self.done(f"POS_ROB {ARM} FRAME_INC X 100")
        self.assertLess(time.monotonic() - start, 6.0)
        self.done("DRAW_SCENE")
        self.at((BASE[0] + 0.7, BASE[1] + 0.3, 0.9), self.tcp()[0])

    def test_speeds_stay_below_their_maxima_and_scales_slow_down(self):
        for there, back in (("JOINT_INC 120 -30 40 90 20 90", "JOINT_INC -120 30 -40 -90 -20 -90"), ("FRAME_INC Z 250", "FRAME_INC Z -250")):
            fastest = [0.0] * 6
            for i in range(20):  # until it was looked at while it moved
                waiting = Background(self.scratch, f"POS_ROB {ARM} {back if i % 2 else there}")
                while waiting.is_alive():
                    state = self.scratch.robot(ARM)
                    fastest = [max(f, abs(j["velocity"])) for f, j in zip(fastest, state["joints"])]
                self.assertEqual(waiting.answer().returncode, 0, waiting.answer().stderr)
                if max(fastest) > 0.1:
                    break
            for speed, most in zip(fastest, state["parameters"]["max_velocity"]):
                self.assertLessEqual(speed, most * (1 + 1e-9))
            self.assertGreater(max(fastest), 0.1)
        self.done("rob_cart_lin_vel 50")
        start = time.monotonic()
        self.done(f"POS_ROB {ARM} FRAME_INC Z -50")
        self.assertGreater(time.monotonic() - start, 0.9)  # 50 mm at 50 mm/s
        self.done("rob_cart_lin_vel 1200")

    def test_timeout_of_send_tells_that_the_robot_may_still_move(self):
        self.slow()
        done = self.scratch.cellmirror("send", "--timeout", "0.2", f"POS_ROB {ARM} JOINT_INC 150")
        self.assertEqual(done.returncode, 1)
        self.assertIn("still be on its way", done.stderr)


class Start(unittest.TestCase):
    """rob_jnt_start_pos in the startup script sets the posture in which the simulation begins."""

    def begin(self, cell, script):
        scratch = g.Scratch(cell)
        self.addCleanup(scratch.remove)
        (scratch.home / "scripts" / "startup.spt").write_text(script)
        gateway = g.Gateway(scratch)
        self.addCleanup(gateway.close)
        self.assertTrue(g.eventually(lambda: scratch.status()["script"]["running"] == 0))
        return scratch

    def assert_at(self, scratch, robot, expected):
        def values():
            return [joint["position"] for joint in scratch.robot(robot)["joints"]]

        self.assertTrue(g.eventually(lambda: all(abs(a - b) < 1e-9 for a, b in zip(values(), expected))),
                        f"{robot} is at {values()}, not {expected}")

    def test_robots_begin_where_the_startup_script_says(self):
        scratch = self.begin("transfer_cell", f"ROBACT {ARM};\nrob_jnt_start_pos 10 40 80 0 30 5;\n")
        self.assert_at(scratch, ARM, degrees(10, 40, 80, 0, 30, 5))
        self.assertEqual(scratch.status()["script"]["refused"], 0)

    def test_later_it_is_the_target_of_move_rob_start_and_the_answer_says_so(self):
        scratch = self.begin("transfer_cell", f"ROBACT {ARM};\n")
        for command in ("rob_positioning jump", f"POS_ROB {ARM} JOINT_ABS 1"):
            self.assertEqual(scratch.send(command).returncode, 0)
        done = scratch.send("rob_jnt_start_pos 10 40 80 0 30 5")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(f"MOVE_ROB {ARM} PTP START", done.stdout)
        self.assertAlmostEqual(scratch.robot(ARM)["joints"][0]["position"], math.radians(1), delta=1e-9)
        self.assertEqual(scratch.send(f"MOVE_ROB {ARM} PTP START").returncode, 0)
        self.assert_at(scratch, ARM, degrees(10, 40, 80, 0, 30, 5))

    def test_a_robot_from_urdf_begins_there_too(self):
        scratch = self.begin("ros2_cell", "")
        robot = scratch.status()["robots"][0]
        count = len(robot["joints"])
        self.assertEqual({joint["unit"] for joint in robot["joints"]}, {"rad"})
        for command in (f"ROBACT {robot['id']}", "rob_jnt_start_pos " + " ".join(["5"] * count)):
            done = scratch.send(command)
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_at(scratch, robot["id"], degrees(*[5] * count))

    def test_a_maximum_that_is_raised_again_gives_back_the_requested_velocity(self):
        scratch = self.begin("transfer_cell", f"ROBACT {ARM};\n")
        asked = scratch.robot(ARM)["parameters"]["active_velocity"]
        fastest = scratch.robot(ARM)["parameters"]["max_velocity"]
        for maximum in ([0.05] * len(fastest), fastest):
            done = scratch.send("rob_jnt_max_vel " + " ".join(f"{value:.17g}" for value in maximum))
            self.assertEqual(done.returncode, 0, done.stderr)
            parameters = scratch.robot(ARM)["parameters"]
            self.assertEqual(parameters["requested"]["active_velocity"], asked)
            self.assertEqual(parameters["active_velocity"], [min(a, b) for a, b in zip(asked, maximum)])


if __name__ == "__main__":
    g.main()

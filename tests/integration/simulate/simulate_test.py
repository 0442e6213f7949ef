"""cellmirror simulate: closed forms on a small cell, and what has to hold on the transfer cell."""

import json
import unittest

import gateway as g
import small_cell as s

TICK = 0.001
# The slide: 1 m/s, 4 m/s2, linear ramps. A way of d > 0.25 m takes d + 0.25 s.
SET_UP = """ROBACT S1;
rob_vel_profile ramp;
rob_jnt_act_vel 1000 1;
rob_jnt_act_acc 4000 4;
"""


class Simulation(unittest.TestCase):
    def setUp(self):
        self.home = s.Home()
        (self.home.root / "scripts").mkdir()

    def tearDown(self):
        self.home.close()

    def script(self, text, name="test.spt"):
        path = self.home.root / "scripts" / name
        path.write_text(text)
        return path

    def simulate(self, text, *options, status=0):
        done = s.program("simulate", "--cell", self.home.cell, "--script", self.script(text), "--json", *options)
        self.assertEqual(done.returncode, status, done.stderr)
        return json.loads(done.stdout)


class Durations(Simulation):
    def test_a_ptp_move_takes_what_its_profile_says(self):
        found = self.simulate(SET_UP + "POS_ROB S1 JOINT_ABS 1000")
        self.assertEqual(found["end"], "finished")
        (move,) = found["moves"]
        self.assertEqual((move["robot"], move["kind"], move["outcome"]), ("S1", "joints", "arrived"))
        self.assertAlmostEqual(move["duration_s"], 1.25, delta=1.5 * TICK)

    def test_a_script_waits_for_its_moves_and_nothing_is_lost_between_queued_ones(self):
        found = self.simulate(SET_UP + "MOVE_ROB S1 PTP JOINT_ABS 500;\nMOVE_ROB S1 PTP JOINT_ABS 0;\nWAIT;\n"
                              "POS_ROB S1 JOINT_ABS 500")
        first, second, third = found["moves"]
        self.assertAlmostEqual(first["duration_s"], 0.75, delta=1.5 * TICK)
        self.assertAlmostEqual(second["begin_s"], first["end_s"], delta=1.5 * TICK)
        self.assertLess(abs(third["begin_s"] - second["end_s"]), 3 * TICK)
        self.assertAlmostEqual(found["simulated_s"], 3 * 0.75, delta=10 * TICK)

    def test_the_same_script_gives_the_same_answer_again(self):
        def once():
            found = self.simulate(SET_UP + "POS_ROB S1 JOINT_ABS 1900 30;\nPOS_ROB S1 JOINT_ABS 0 0")
            for key in ("wall_s", "processor_s", "times_real_time"):
                del found[key]
            del found["collision"]["wall_s"]
            return found
        self.assertEqual(once(), once())

    def test_a_command_that_recalculates_the_cell_does_not_wait_for_a_tick_that_never_comes(self):
        found = self.simulate(SET_UP + "DRAW_SCENE;\nPOS_ROB S1 JOINT_ABS 100;\nDRAW_SCENE")
        self.assertEqual(found["script_commands"], 7)
        self.assertEqual(found["refused"], [])


class Findings(Simulation):
    # The arm reaches 0.25 m before the slide, the wall stands at 2 m: they touch at 1.75 m, 1.875 s after the beginning.
    def test_a_collision_has_a_time_a_pair_and_an_end(self):
        found = self.simulate(SET_UP + "POS_ROB S1 JOINT_ABS 1850;\nPOS_ROB S1 JOINT_ABS 1000", "--collision-period",
                              "0.005")["collision"]
        self.assertTrue(found["tested"])
        self.assertEqual(found["period_s"], 0.005)
        (touch,) = found["collisions"]
        self.assertEqual({touch["a"], touch["b"]}, {"Wall", "Robot.Slide.Turn.Arm"})
        self.assertGreater(touch["time_s"], 1.875 - 3 * TICK)
        self.assertLess(touch["time_s"], 1.875 + 0.005 + 3 * TICK)
        self.assertGreater(touch["parted_s"], touch["time_s"])
        self.assertAlmostEqual(touch["depth_m"], 0.1, delta=0.01)  # depths of lasting touches are computed now and then
        self.assertEqual(found["min_distance"]["distance_m"], 0)

    def test_collisions_can_be_left_out(self):
        found = self.simulate(SET_UP + "POS_ROB S1 JOINT_ABS 1850", "--no-collisions")["collision"]
        self.assertFalse(found["tested"])
        self.assertEqual((found["tests"], found["collisions"], found["why_not"]), (0, [], "--no-collisions"))

    def test_set_collpar_switches_them_off(self):
        found = self.simulate("SET_COLLPAR active 0;\n" + SET_UP + "POS_ROB S1 JOINT_ABS 1850")["collision"]
        self.assertEqual(found["collisions"], [])

    def test_limits_that_are_approached(self):
        robot = self.simulate(SET_UP + "POS_ROB S1 JOINT_ABS -990", "--no-collisions")["robots"][0]
        slide, turn = robot["joints"]
        self.assertTrue(slide["range_approached"])
        self.assertFalse(slide["range_violated"])
        self.assertAlmostEqual(slide["nearest_limit"]["position_m"], -0.99, delta=1e-9)
        self.assertEqual(slide["nearest_limit"]["limit_m"], -1)
        self.assertTrue(slide["velocity_approached"])
        self.assertFalse(slide["velocity_violated"])
        self.assertAlmostEqual(abs(slide["peak_velocity_m_s"]), 1, delta=1e-6)
        self.assertFalse(turn["moved"] or turn["range_approached"] or turn["velocity_approached"])

    def test_what_is_refused_has_a_time_and_a_place(self):
        found = self.simulate(SET_UP + "POS_ROB S1 JOINT_ABS 500;\nPOS_ROB S1 JOINT_ABS 5000", status=1)
        (refused,) = found["refused"]
        self.assertEqual(refused["line"], 6)
        self.assertAlmostEqual(refused["time_s"], 0.75, delta=5 * TICK)
        self.assertIn("limit", refused["message"])
        self.assertTrue(found["failed"])

    def test_robots_cannot_be_mirrored_and_memories_are_not_made(self):
        found = self.simulate("ROBOT S1 online;\nROBACT S1;\nrob_ela_shm 0 4711 512;\nbin_ela_shm 0 4712 64", status=1)
        self.assertEqual([r["line"] for r in found["refused"]], [1])
        self.assertIn("off line", found["refused"][0]["message"])


class Messages(Simulation):
    def texts(self, script):
        return [message["text"] for message in self.simulate(script, "--no-collisions")["messages"]]

    def test_the_only_one(self):
        self.assertEqual(self.texts("HOT_MESSAGE only"), ["only"])

    def test_the_last_one_has_its_instant(self):
        found = self.simulate(SET_UP + "HOT_MESSAGE first;\nPOS_ROB S1 JOINT_ABS 1000;\nHOT_MESSAGE last", "--no-collisions")
        first, last = found["messages"]
        self.assertEqual((first["text"], last["text"]), ("first", "last"))
        self.assertAlmostEqual(last["time_s"], 1.25, delta=3 * TICK)

    def test_more_at_an_instant_than_the_picture_shows(self):
        texts = [f"number {i}" for i in range(30)]
        self.assertEqual(self.texts(";\n".join("HOT_MESSAGE " + text for text in texts)), texts)


class Refusals(Simulation):
    def refusal(self, command):
        (refused,) = self.simulate("ROBACT S1;\n" + command, "--no-collisions", status=1)["refused"]
        return refused["message"] + "; " + refused["remedy"]

    def test_a_velocity_in_degrees_a_second_is_told_its_unit_and_what_is_taken(self):
        said = self.refusal("rob_jnt_act_vel 500 57")
        self.assertIn("in rad/s, not degrees: give more than 0 and at most 1, or raise rob_jnt_max_vel", said)
        self.assertIn("in mm/s: give more than 0 and at most 1000", self.refusal("rob_jnt_act_vel 1001 1"))

    def test_a_pose_in_metres_is_told_that_lengths_are_in_mm(self):
        for command in ("POS_ROB S1 FRAME_ABS 0.4 0 0.5 0 90 0", "MOVE_ROB S1 LIN FRAME_ABS 0.4 0 0.5 0 90 0"):
            with self.subTest(command=command):
                said = self.refusal(command)
                self.assertIn("lengths are in mm, and x 0.4 y 0 z 0.5 mm", said)
                self.assertNotIn("command that pose", said)


class Ends(Simulation):
    def test_a_time_limit(self):
        found = self.simulate(SET_UP + "POS_ROB S1 JOINT_ABS 2900", "--for", "0.5", "--no-collisions", status=1)
        self.assertEqual(found["end"], "time limit")
        self.assertAlmostEqual(found["simulated_s"], 0.5, delta=2 * TICK)
        self.assertEqual(found["moves"][0]["outcome"], "under way")
        self.assertEqual(found["end_note"], "0.5 s are over (--for): a robot still moves")

    def test_scripts_are_named_as_with_run_by_any_path_or_by_a_name_in_scripts(self):
        path = self.script("HOT_MESSAGE here")
        for name in ("test.spt", "test", "scripts/test.spt", "scripts/test", str(path)):
            with self.subTest(name=name):
                done = s.program("simulate", "--cell", self.home.cell, "--script", name, "--no-collisions")
                self.assertEqual(done.returncode, 0, done.stderr)
        for name, words in (("gone", r"scripts/gone(\.spt)?"), ("scripts/gone.spt", "scripts/gone.spt"), ("/gone.spt", "/gone.spt")):
            for command in (("simulate", "--cell", self.home.cell), ("run", self.home.cell, "--headless", "--no-web",
                                                                     "--instance", f"test{self.home.root.name}")):
                with self.subTest(name=name, command=command[0]):
                    done = s.program(*command, "--script", name)
                    self.assertEqual(done.returncode, 1)
                    self.assertRegex(done.stderr, f"file {words} does not exist")

    def test_scripts_with_faults_are_refused_and_nothing_of_them_runs(self):
        done = s.program("simulate", "--cell", self.home.cell, "--script", self.script("POS_ROB S1 JOINT_ABS x;\nNONSENSE"))
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stdout, "")
        for words in ("has 2 errors", "test.spt:1:", "cellmirror check"):
            self.assertIn(words, done.stderr)

    def test_missing_files_and_wrong_usage(self):
        self.assertEqual(s.program("simulate", "--cell", self.home.cell, "--script", "no.spt").returncode, 1)
        self.assertEqual(s.program("simulate", "--cell", "no.toml", "--script", "no.spt").returncode, 1)
        self.assertEqual(s.program("simulate", "--cell", self.home.cell).returncode, 2)

    def test_a_picture_and_a_text(self):
        picture = self.home.root / "chart.png"
        done = s.program("simulate", "--cell", self.home.cell, "--script", self.script(SET_UP + "POS_ROB S1 JOINT_ABS 1850"),
                         "--plot", picture)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(picture.read_bytes().startswith(b"\x89PNG"))
        for words in ("times real time", "robots that moved", "S1 joints", "Wall", "limits approached"):
            self.assertIn(words, done.stdout)


class Waiting(Simulation):
    """What ends by itself is waited for, however long nothing happens until then."""

    def setUp(self):
        super().setUp()
        (self.home.root / "programs").mkdir()

    def program(self, name, *records):
        lines = [f"HEADER, {name}", *records, "END"]
        (self.home.root / f"programs/{name}.ird").write_text(
            "".join(f"{n}, {line}\n" for n, line in enumerate(lines, start=1)))

    def second_robot(self):
        slider = (self.home.root / "envlib/slider.mpc").read_text()
        (self.home.root / "envlib/other.mpc").write_text(slider.replace('"S1"', '"S2"').replace('"EYE"', '"EYE2"'))
        node = '[[node]]\nname = "Other"\nabstract = "other.mpc"\nxyz_m = [0.0, 9.0, 0.0]\n'
        self.home.cell.write_text(s.CELL.replace("[collision]", node + "[collision]"))

    def test_a_time_limit_of_a_program(self):
        self.program("waits", "END_HEADER", "WAIT_INPUT, 3, ON, 5, late", "LABEL, late")
        found = self.simulate("TF_LOAD waits S1;\nTF_RUN waits S1;\nWAIT", "--still", "2", "--no-collisions")
        self.assertEqual(found["end"], "finished")
        self.assertAlmostEqual(found["simulated_s"], 5, delta=10 * TICK)

    def test_the_delay_of_programs(self):
        self.program("nothing", "END_HEADER")
        found = self.simulate("ROBACT S1;\nrob_program_delays 5;\nTF_LOAD nothing S1;\nTF_RUN nothing S1;\nWAIT",
                              "--still", "2", "--no-collisions")
        self.assertEqual(found["end"], "finished")
        self.assertAlmostEqual(found["simulated_s"], 5, delta=10 * TICK)

    def test_an_input_that_nobody_sets_is_not_waited_for(self):
        self.program("waits", "END_HEADER", "WAIT_INPUT, 3, ON")
        found = self.simulate("TF_LOAD waits S1;\nTF_RUN waits S1;\nWAIT", "--still", "2", "--no-collisions", status=1)
        self.assertEqual(found["end"], "stands still")
        self.assertLess(found["simulated_s"], 3)
        for words in ("waits of S1 waits for input 3 is on at N3", "--still", "SET_INPUT"):
            self.assertIn(words, found["end_note"])

    def test_a_program_that_never_ends_is_named_with_its_place(self):
        self.program("turns", "END_HEADER", "LABEL, again", "JUMP, again")
        self.script("TF_LOAD turns S1;\nTF_RUN turns S1;\nWAIT")
        done = s.program("simulate", "--cell", self.home.cell, "--script", "test.spt", "--for", "0.05", "--no-collisions")
        self.assertEqual(done.returncode, 1)
        for text in (done.stdout, done.stderr):
            self.assertRegex(text, r"time limit: 0.05 s are over \(--for\): turns of S1 still runs, at N4; does it end\?")

    def test_a_robot_that_a_comment_moves_rests_before_the_program_goes_on(self):
        self.program("closes", "END_HEADER", "COMMENT, %MOVE_ROB S1 PTP JOINT_ABS 1000", "DOUT, 4, ON")
        found = self.simulate(SET_UP + "TF_LOAD closes S1;\nTF_RUN closes S1;\nWAIT", "--no-collisions")
        (move,) = found["moves"]
        (output,) = [event for event in found["events"] if event["event"] == "done" and "output" in event["text"]]
        self.assertGreaterEqual(output["time_s"], move["end_s"] - TICK / 2)

    def test_a_time_limit_beside_a_deadlock(self):
        self.second_robot()
        self.program("stuck", "SEMAPHORE, nobody_releases, 0", "END_HEADER", "ACQUIRE, nobody_releases")
        self.program("waits", "END_HEADER", "WAIT_INPUT, 3, ON, 5, late", "LABEL, late")
        found = self.simulate("TF_LOAD stuck S1;\nTF_LOAD waits S2;\nTF_RUN stuck S1;\nTF_RUN waits S2",
                              "--no-collisions", status=1)
        self.assertEqual(found["end"], "stands still")
        self.assertEqual(found["end_note"], "stuck of S1 waits for semaphore nobody_releases at N4")
        ends = {program["program"]: program["end"] for program in found["programs"]}
        self.assertEqual(ends["waits"], "ended")

    def test_a_deadlock_that_the_script_ends_in_time_is_no_failure(self):
        self.second_robot()
        self.program("takes", "SEMAPHORE, table, 0", "END_HEADER", "ACQUIRE, table")
        self.program("gives", "SEMAPHORE, table, 0", "END_HEADER", "RELEASE, table")
        found = self.simulate(SET_UP + "TF_LOAD takes S2;\nTF_LOAD gives S1;\nTF_RUN takes S2;\n"
                              "POS_ROB S1 JOINT_ABS 1900;\nTF_RUN gives S1;\nWAIT", "--no-collisions")
        self.assertEqual(len(found["deadlocks"]), 1)
        self.assertEqual((found["end"], found["refused"], found["failed"]), ("finished", [], False))

    def test_a_deadlock_that_the_script_ends_by_stopping_a_program_is_a_failure(self):
        self.second_robot()
        self.program("stuck", "SEMAPHORE, nobody_releases, 0", "END_HEADER", "ACQUIRE, nobody_releases")
        found = self.simulate(SET_UP + "TF_LOAD stuck S2;\nTF_RUN stuck S2;\nPOS_ROB S1 JOINT_ABS 1900;\nTF_STOP S2;\nWAIT",
                              "--no-collisions", status=1)
        self.assertEqual(len(found["deadlocks"]), 1)
        self.assertEqual((found["end"], found["refused"], found["failed"]), ("finished", [], True))

    def test_a_script_that_ends_a_deadlock_waits_for_what_it_starts_then(self):
        self.program("stuck", "SEMAPHORE, nobody_releases, 0", "END_HEADER", "ACQUIRE, nobody_releases")
        self.program("home", "END_HEADER", "WAIT_INPUT, 3, ON, 2, late", "LABEL, late")
        found = self.simulate("TF_LOAD stuck S1;\nTF_LOAD home S1;\nTF_RUN stuck S1;\nWAIT;\nTF_STOP S1;\n"
                              "TF_RUN home S1;\nWAIT", "--no-collisions", status=1)
        self.assertEqual([refusal["line"] for refusal in found["refused"]], [4])
        ends = {program["program"]: program["end"] for program in found["programs"]}
        self.assertEqual(ends, {"stuck": "stopped", "home": "ended"})

    def test_programs_that_are_stopped_with_their_queue_have_one_run_each(self):
        self.program("first", "END_HEADER", "WAIT_INPUT, 3, ON")
        self.program("second", "END_HEADER")
        found = self.simulate("TF_LOAD first S1;\nTF_LOAD second S1;\nTF_RUN first S1;\nTF_RUN second S1 exec_wait;\n"
                              "TF_STOP S1", "--no-collisions")
        self.assertEqual([(run["program"], run["end"]) for run in found["programs"]],
                         [("first", "stopped"), ("second", "stopped")])


class TransferCell(unittest.TestCase):
    def test_the_demo_that_moves_the_carried_arm(self):
        done = s.program("simulate", "--cell", s.TRANSFER_CELL, "--script", "trs_demo.spt", "--json")
        found = json.loads(done.stdout)
        self.assertEqual(found["end"], "finished", done.stderr)
        self.assertEqual(found["refused"], [])
        self.assertGreater(len(found["moves"]), 2)
        self.assertTrue(all(m["outcome"] == "arrived" for m in found["moves"]))


if __name__ == "__main__":
    unittest.main()

"""Robots run programs in the real gateway: loaded, queued, held, stepped, stopped, failing, waiting for each other."""

import math
import time
import unittest

import gateway as g

ARM, PUMA, CRANE = "MANTEC_R3", "PUMA_762", "ZELLENKRAN"
SPARE, SPARE_NODE = "mantec_R3a", "Mantec_4"  # a robot that no other test needs
HOME = "STELLUNG(0, 40, 80, 0, 30, 0)"


def program(*lines, name=None):
    return "\n".join([*([f"PROGRAMM {name}"] if name else []), *lines, ""])


class Programs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = g.Scratch()
        cls.folder = cls.scratch.home / "programs"
        cls.folder.mkdir(exist_ok=True)
        cls.scripts = cls.scratch.home / "scripts"
        cls.gateway = g.Gateway(cls.scratch)

    @classmethod
    def tearDownClass(cls):
        running = cls.gateway.running()
        cls.gateway.close()
        cls.scratch.remove()
        assert running, "the gateway ended during the tests"

    def setUp(self):
        self.done("ROBOT_LANGUAGE srcl")

    def tearDown(self):
        for robot in (ARM, PUMA, CRANE):
            self.scratch.send(f"TF_STOP {robot}")
        g.eventually(lambda: not self.running())
        for loaded in self.programs():
            self.scratch.send(f"TF_DELETE {loaded['program']} {loaded['robot']}")

    # Helpers.

    def done(self, *commands):
        for command in commands:
            done = self.scratch.send(command)
            self.assertEqual(done.returncode, 0, f"{command}: {done.stderr}")

    def refused(self, command, *why):
        done = self.scratch.send(command)
        self.assertEqual(done.returncode, 1, f"{command}: {done.stdout}")
        for part in why:
            self.assertIn(part, done.stderr, command)
        return done.stderr

    def write(self, name, *lines):
        (self.folder / f"{name}.src").write_text(program(*lines))

    def load(self, name, robot, *lines):
        self.write(name, *lines)
        self.done(f"TF_LOAD {name} {robot}")

    def status(self):
        return self.scratch.status()["programs"]

    def programs(self):
        return self.status()["loaded"]

    def running(self):
        return [p for p in self.programs() if p["state"] in ("queued", "delayed", "running", "waiting", "held")]

    def program(self, name, robot=ARM):
        return next(p for p in self.programs() if p["program"] == name and p["robot"] == robot)

    def state(self, name, robot=ARM):
        return self.program(name, robot)["state"]

    def wait_state(self, name, *states, robot=ARM, timeout=g.PATIENCE_S):
        reached = g.eventually(lambda: self.state(name, robot) in states, timeout)
        self.assertTrue(reached, self.program(name, robot))

    def joints(self, robot):
        return [joint["position"] for joint in self.scratch.robot(robot)["joints"]]

    def messages(self):
        return [message["text"] for message in self.scratch.status()["messages"]]

    def run_script(self, name, text, timeout=g.PATIENCE_S):
        (self.scripts / name).write_text(text)
        self.done(f"EXEC_SCRIPT {name}")
        self.assertTrue(g.eventually(lambda: self.scratch.status()["script"]["running"] == 0, timeout),
                        self.scratch.status()["script"])
        return [error for error in self.scratch.status()["script"]["last_errors"] if name in error]

    # Loading.

    def test_a_program_is_loaded_listed_run_and_deleted(self):
        self.load("simple", ARM, f"PTP {HOME}", "PTP STELLUNG(5, 40, 80, 0, 30, 0)")
        loaded = self.program("simple")
        self.assertEqual((loaded["state"], loaded["language"], loaded["file"], loaded["runs"]),
                         ("loaded", "srcl", "programs/simple.src", 0))
        self.assertIsNone(loaded["expected_s"])
        self.done(f"TF_RUN simple {ARM}", f"TF_WAIT {ARM}")
        ended = self.program("simple")
        self.assertEqual((ended["state"], ended["runs"], ended["error"]), ("ended", 1, ""))
        self.assertGreater(ended["elapsed_s"], 0.05)
        self.assertAlmostEqual(ended["expected_s"], ended["elapsed_s"], delta=1e-6)
        self.assertAlmostEqual(self.joints(ARM)[0], math.radians(5), delta=1e-6)
        self.assertIn("simple of MANTEC_R3", self.scratch.cellmirror("status").stdout)
        self.done(f"TF_DELETE simple {ARM}")
        self.assertEqual(self.programs(), [])
        self.refused(f"TF_RUN simple {ARM}", "simple")

    def test_what_is_wrong_is_told_with_its_place_and_nothing_is_loaded(self):
        self.refused(f"TF_LOAD nowhere {ARM}", "nowhere.src", "programs")
        self.refused("TF_LOAD simple NOBODY", "NOBODY")
        self.refused(f"TF_LOAD ../cell {ARM}")
        self.refused("ROBOT_LANGUAGE basic", "irdata", "jet_tarm")
        self.write("wrong", "PTP STELLUNG(1, 2", "LIN", "FREI")
        self.refused(f"TF_LOAD wrong {ARM}", "programs/wrong.src has 3 errors", "programs/wrong.src:1:")
        self.assertEqual(self.programs(), [])
        # More joints than the crane has.
        self.write("six", f"PTP {HOME}")
        self.refused(f"TF_LOAD six {CRANE}", "six.src:1:")

    def test_a_name_is_replaced_unless_it_runs(self):
        self.load("again", ARM, "WARTE 30")
        self.done(f"TF_RUN again {ARM}")
        self.refused(f"TF_LOAD again {ARM}", "again")
        self.refused(f"TF_DELETE again {ARM}", "again")
        self.refused(f"TF_RUN again {ARM}", "again")
        self.done(f"TF_STOP {ARM}")
        self.wait_state("again", "stopped")
        self.load("again", ARM, "WARTE 0.01")
        self.done(f"TF_RUN again {ARM}", f"TF_WAIT {ARM}")
        self.assertEqual(self.state("again"), "ended")

    # Running.

    def test_programs_of_several_robots_run_side_by_side_and_three_of_the_crane_one_after_another(self):
        self.load("hs1", CRANE, "WARTE 0.1", ";% hot_message hs1")
        self.load("hs2", CRANE, "WARTE 0.1", ";% hot_message hs2")
        self.load("hs3", CRANE, "WARTE 2.5", ";% hot_message hs3")  # still under way when hs1 is to be run again
        self.load("r3demo", ARM, f"PTP {HOME}", "WARTE 0.1", ";% hot_message r3demo")
        errors = self.run_script("queue.spt", f"""TF_RUN hs1 {CRANE}; TF_RUN hs2 {CRANE} exec_wait;
TF_RUN hs3 {CRANE} exec_wait; TF_RUN r3demo {ARM}; TF_RUN hs1 {CRANE}; WAIT; hot_message all;""")
        self.assertEqual(len(errors), 1, errors)  # hs1 ran already
        texts = self.messages()[-5:]
        self.assertEqual([text for text in texts if text.startswith("hs")], ["hs1", "hs2", "hs3"])
        self.assertEqual(texts[-1], "all")
        self.assertIn("r3demo", texts)

    def test_a_second_program_of_a_robot_needs_exec_wait(self):
        self.load("long", ARM, "WARTE 30")
        self.load("short", ARM, "WARTE 0.01")
        self.done(f"TF_RUN long {ARM}")
        self.refused(f"TF_RUN short {ARM}", "exec_wait")
        self.done(f"TF_RUN short {ARM} exec_wait")
        self.assertEqual(self.state("short"), "queued")
        self.done(f"TF_STOP {ARM}")
        self.wait_state("long", "stopped")
        self.assertNotEqual(self.state("short"), "ended")  # forgotten with it

    def test_a_moved_robot_takes_no_other_motion_and_stop_rob_stops_its_program(self):
        self.load("move", ARM, f"PTP {HOME}", "V_ACHSE 5", "PTP STELLUNG(60, 40, 80, 0, 30, 0)")
        self.done(f"TF_RUN move {ARM}")
        self.refused(f"POS_ROB {ARM} JOINT_ABS 0", "move", f"TF_STOP {ARM}")
        self.refused(f"MOVE_ROB {ARM} PTP JOINT_ABS 0", "move")
        self.done(f"POS_ROB {PUMA} JOINT_INC 1")
        self.done(f"STOP_ROB {ARM}")
        self.wait_state("move", "stopped")
        self.done(f"POS_ROB {ARM} JOINT_ABS 0 40 80 0 30 0")

    def test_the_delay_of_the_robot_goes_before_its_program(self):
        self.load("late", ARM, "WARTE 0.1")
        self.done(f"ROBACT {ARM}", "rob_program_delays 30", f"TF_RUN late {ARM}")
        try:
            self.assertEqual(self.state("late"), "delayed")
            self.done(f"TF_STOP {ARM}", "rob_program_delays 0.5")
            self.wait_state("late", "stopped")
            start = time.monotonic()
            self.done(f"TF_RUN late {ARM}", f"TF_WAIT {ARM}")
            self.assertGreater(time.monotonic() - start, 0.6)
        finally:
            self.done("rob_program_delays 0")
        self.assertEqual(self.state("late"), "ended")

    def test_script_in_comments_comes_when_the_moves_before_have_ended(self):
        self.load("talks", ARM, f"PTP {HOME}", ";% hot_message at home", "PTP STELLUNG(10, 40, 80, 0, 30, 0)",
                  f";% POS_ROB {PUMA} JOINT_INC 2", ";% hot_message puma is there", f";% POS_ROB {ARM} JOINT_INC 5",
                  "PTP STELLUNG(0, 40, 80, 0, 30, 0) UEBER", ";% hot_message the end")
        before = self.joints(PUMA)[0]
        self.done(f"TF_RUN talks {ARM}", f"TF_WAIT {ARM}")
        self.assertEqual(self.messages()[-3:], ["at home", "puma is there", "the end"])
        self.assertAlmostEqual(self.joints(PUMA)[0] - before, math.radians(2), delta=1e-6)
        self.assertAlmostEqual(self.joints(ARM)[0], 0, delta=1e-6)

    def test_a_command_of_a_program_that_is_refused_stops_it_with_its_line(self):
        self.load("refused", ARM, "WARTE 0.01", ";% CONNECT nothing TO nowhere", ";% hot_message never")
        self.done(f"TF_RUN refused {ARM}")
        self.wait_state("refused", "failed")
        self.assertIn("programs/refused.src:2", self.program("refused")["error"])
        self.assertNotIn("never", self.messages())
        self.load("waits", ARM, ";% WAIT")
        self.done(f"TF_RUN waits {ARM}")
        self.refused(f"TF_WAIT {ARM}", "waits.src:1", "cannot wait for programs")

    def test_a_program_may_start_and_stop_programs_and_scripts_and_even_delete_its_own_robot(self):
        (self.scripts / "beside.spt").write_text("hot_message beside")
        self.load("other", PUMA, ";% hot_message other")
        self.load("starts", ARM, f";% TF_RUN other {PUMA}", ";% EXEC_SCRIPT beside", f";% TF_STOP {ARM}",
                  ";% hot_message never again")
        self.done(f"TF_RUN starts {ARM}")
        self.wait_state("starts", "stopped")
        self.assertTrue(g.eventually(lambda: {"other", "beside"} <= set(self.messages())), self.messages())
        self.assertNotIn("never again", self.messages())
        self.load("deletes", ARM, f";% TF_DELETE deletes {ARM}")
        self.done(f"TF_RUN deletes {ARM}")
        self.refused(f"TF_WAIT {ARM}", "deletes.src:1")
        self.load("last", SPARE, f";% DELETE_NODE {SPARE_NODE}", ";% hot_message never again")
        self.done(f"TF_RUN last {SPARE}")
        self.assertTrue(g.eventually(lambda: not any(p["robot"] == SPARE for p in self.programs())))
        self.assertNotIn("never again", self.messages())
        self.refused(f"TF_LOAD last {SPARE}", SPARE)

    # Failures.

    def test_a_failure_is_told_by_status_and_by_whoever_waits(self):
        self.load("far", ARM, f"PTP {HOME}", "LIN LAGE(9000, 0, 0, 0, 0, 0)")
        failures = self.status()["failures"]
        errors = self.run_script("waits.spt", f"TF_RUN far {ARM};\n WAIT;\nhot_message goes on; WAIT;")
        self.assertEqual(len(errors), 1, errors)
        self.assertIn("scripts/waits.spt:2:2: error:", errors[0])
        self.assertIn("programs/far.src:2", errors[0])
        self.assertEqual(self.messages()[-1], "goes on")
        failed = self.program("far")
        self.assertEqual(failed["state"], "failed")
        self.assertIn("programs/far.src:2", failed["error"])
        self.assertEqual(self.status()["failures"], failures + 1)
        self.assertIn("programs/far.src:2", self.status()["last_failure"])
        self.refused(f"TF_WAIT {ARM}", "programs/far.src:2")
        self.assertFalse(self.scratch.robot(ARM)["motion"]["moving"])
        # It can be run again, and a program that does not fail is not blamed for it.
        self.load("near", ARM, f"PTP {HOME}")
        self.done(f"TF_RUN near {ARM}", f"TF_WAIT {ARM}")

    def test_a_robot_that_goes_online_ends_its_program(self):
        self.load("goes_on", PUMA, "WARTE 30")
        self.done(f"TF_RUN goes_on {PUMA}")
        went = self.scratch.send(f"ROBOT {PUMA} online")
        if went.returncode != 0:
            self.skipTest(f"skipped: {PUMA} cannot go online here: {went.stderr}")
        try:
            self.wait_state("goes_on", "failed", "stopped", robot=PUMA)
            self.assertIn("online", self.program("goes_on", PUMA)["error"])
            self.refused(f"TF_RUN goes_on {PUMA}", "online")
        finally:
            self.done(f"ROBOT {PUMA} offline")

    # Hold, step, stop.

    def test_a_held_program_rests_on_its_way_and_goes_on_from_there(self):
        self.done(f"POS_ROB {ARM} JOINT_ABS 0 40 80 0 30 0")
        self.load("sweep", ARM, "V_ACHSE 8", "PTP STELLUNG(40, 40, 80, 0, 30, 0)", "PTP STELLUNG(0, 40, 80, 0, 30, 0)")
        self.done(f"TF_RUN sweep {ARM}")
        self.assertTrue(g.eventually(lambda: self.joints(ARM)[0] > math.radians(2), every=0.01))
        self.done(f"TF_HOLD {ARM}")
        self.wait_state("sweep", "held")

        def rests():
            held = self.joints(ARM)
            time.sleep(0.2)
            return self.joints(ARM) == held

        self.assertTrue(g.eventually(rests), "it goes on")
        self.assertLess(self.joints(ARM)[0], math.radians(39))
        self.assertEqual(self.state("sweep"), "held")
        self.done(f"TF_RESUME {ARM}", f"TF_WAIT {ARM}")
        self.assertEqual(self.state("sweep"), "ended")
        self.assertAlmostEqual(self.joints(ARM)[0], 0, delta=1e-6)
        self.refused(f"TF_RESUME {ARM}")
        self.refused(f"TF_HOLD {ARM}")

    def test_a_held_program_goes_step_by_step(self):
        self.done(f"POS_ROB {ARM} JOINT_ABS 0 40 80 0 30 0")
        self.load("steps", ARM, "HALT", *(f"PTP STELLUNG({angle}, 40, 80, 0, 30, 0)" for angle in (3, 6, 9)))
        self.done(f"TF_RUN steps {ARM}")
        self.wait_state("steps", "held")
        for angle in (3, 6):
            self.done(f"TF_STEP {ARM}")
            reached = g.eventually(lambda: self.state("steps") == "held"
                                   and abs(self.joints(ARM)[0] - math.radians(angle)) < 1e-6)
            self.assertTrue(reached, (angle, self.program("steps"), self.joints(ARM)))
        self.refused(f"TF_STEP {ARM} BACKWARD")
        self.done(f"TF_RESUME {ARM}", f"TF_WAIT {ARM}")
        self.assertAlmostEqual(self.joints(ARM)[0], math.radians(9), delta=1e-6)

    def test_an_endless_loop_keeps_nobody_waiting_and_stops_at_once(self):
        self.load("endless", ARM, "GANZ I", "SCHLEIFE", "I = 1 - I", "ENDE_SCHLEIFE")
        self.load("recursion", PUMA, "RUF R", "UPRO R", "RUF R", "ENDE_UPRO")
        self.done(f"TF_RUN endless {ARM}", f"TF_RUN recursion {PUMA}")
        self.wait_state("recursion", "failed", robot=PUMA)
        start = time.monotonic()
        for _ in range(5):
            self.done("hot_message still here")
        self.assertLess(time.monotonic() - start, 20)
        missed = self.scratch.status()["loop"]["missed"]
        self.done(f"TF_STOP {ARM}")
        self.wait_state("endless", "stopped")
        self.assertGreaterEqual(self.scratch.status()["loop"]["missed"], missed)

    # Signals, semaphores.

    def test_programs_wait_for_inputs_and_set_outputs(self):
        self.load("inputs", ARM, "AUSGANG(2) = EIN", "ANALOG_AUS(1) = 2.5", "WARTE BIS EINGANG(3)",
                  "WARTE BIS ANALOG_EIN(1) > 4", "AUSGANG(2) = AUS")
        self.done(f"TF_RUN inputs {ARM}")
        self.wait_state("inputs", "waiting")
        signals = next(s for s in self.status()["signals"] if s["robot"] == ARM)
        self.assertEqual(signals["outputs_on"], [2])
        self.assertEqual(signals["analogue_outputs"], [{"number": 1, "value": 2.5}])
        self.done(f"SET_INPUT {ARM} 3 on")
        time.sleep(0.05)
        self.assertEqual(self.state("inputs"), "waiting")
        self.done(f"SET_ANALOG_INPUT {ARM} 1 4.75", f"TF_WAIT {ARM}")
        self.assertEqual(self.state("inputs"), "ended")
        self.done(f"SET_INPUT {ARM} 3 off", f"SET_ANALOG_INPUT {ARM} 1 0")
        self.refused(f"SET_INPUT {ARM} 0 on", "1")
        self.refused("SET_INPUT NOBODY 1 on", "NOBODY")

    def test_a_semaphore_keeps_two_robots_apart(self):
        body = ("SEMAPHOR TISCH = 1", "BELEGE TISCH", ";% hot_message {0} in", "WARTE 0.15", ";% hot_message {0} out",
                "FREI TISCH")
        self.load("guard_a", ARM, *(line.format("a") for line in body))
        self.load("guard_b", PUMA, *(line.format("b") for line in body))
        self.assertEqual(self.run_script("guard.spt", f"TF_RUN guard_a {ARM}; TF_RUN guard_b {PUMA}; WAIT;"), [])
        self.assertEqual(self.messages()[-4:], ["a in", "a out", "b in", "b out"])
        self.assertEqual(self.status()["semaphores"]["TISCH"], 1)

    def test_a_deadlock_is_reported_until_its_programs_are_stopped(self):
        # The left one waits until the right one has its semaphore, however late that begins.
        self.load("left", ARM, "SEMAPHOR LINKS = 1", "SEMAPHOR RECHTS = 1", "BELEGE LINKS", "WARTE 2.5", "BELEGE RECHTS", "FREI RECHTS", "FREI LINKS")
        self.load("right", PUMA, "SEMAPHOR LINKS = 1", "SEMAPHOR RECHTS = 1", "BELEGE RECHTS", "WARTE 0.1", "BELEGE LINKS", "FREI LINKS", "FREI RECHTS")
        errors = self.run_script("deadlock.spt", f"TF_RUN left {ARM}; TF_RUN right {PUMA}; WAIT; hot_message told;")
        self.assertEqual(len(errors), 1, errors)
        self.assertIn("deadlock", errors[0])
        deadlock = self.status()["deadlock"]
        waiting = {w["program"]: w for w in deadlock["waiting"]}
        self.assertEqual(waiting["left"]["semaphore"], "RECHTS")
        self.assertEqual(waiting["left"]["releasers"], [f"{PUMA} right"])
        self.assertEqual(waiting["right"]["semaphore"], "LINKS")
        self.assertEqual(self.state("left"), "waiting")
        self.assertIn("semaphore RECHTS", self.program("left")["waits_for"])
        self.refused(f"TF_WAIT {ARM}", "deadlock")
        self.assertIn("deadlock", self.scratch.cellmirror("status").stdout)
        self.done(f"TF_STOP {ARM}", f"TF_STOP {PUMA}")
        self.assertTrue(g.eventually(lambda: self.status()["deadlock"] is None))

    # Teach files.

    def test_a_way_is_recorded_and_repeated_backward_and_forward(self):
        self.done(f"POS_ROB {ARM} JOINT_ABS 0 40 80 0 30 0")
        self.refused(f"TF_RECORD taught {ARM} POINT", "START")
        self.done(f"TF_RECORD taught {ARM} START")
        self.refused(f"TF_RECORD other {ARM} START", "taught")
        self.assertEqual(self.status()["recordings"][0]["program"], "taught")
        self.done(f"POS_ROB {ARM} JOINT_ABS 10 40 80 0 30 0", f"TF_RECORD taught {ARM} POINT corner",
                  f"POS_ROB {ARM} JOINT_ABS 10 50 80 0 30 0", f"TF_RECORD taught {ARM} STOP")
        self.assertEqual(self.status()["recordings"], [])
        text = (self.folder / "taught.boom").read_text()
        self.assertIn("corner", text)
        self.done("ROBOT_LANGUAGE jet_boom", f"TF_LOAD taught {ARM}", f"TF_BACK taught {ARM}", f"TF_WAIT {ARM}")
        self.assertTrue(self.program("taught")["reversible"])
        self.assertAlmostEqual(self.joints(ARM)[0], 0, delta=1e-6)
        self.done(f"TF_RUN taught {ARM}", f"TF_WAIT {ARM}")
        self.assertAlmostEqual(self.joints(ARM)[1], math.radians(50), delta=1e-6)

    def test_a_mirrored_robot_is_recorded_and_its_simulation_repeats_the_way(self):
        names = ",".join(f"puma_762_joint_{i}" for i in range(1, 7))
        simulator = g.sim_robot("dds", "--joint-names", names, "--rate", "100", "--motion", "sine:amplitude=0.2,period=4")
        try:
            self.done(f"ROBOT {PUMA} online", f"TF_RECORD led {PUMA} START")
            fresh = g.eventually(lambda: self.scratch.robot(PUMA)["stream"]["state"] == "fresh")
            self.assertTrue(fresh, self.scratch.robot(PUMA)["stream"])
            for name in ("first", "second", "third"):
                self.done(f"TF_RECORD led {PUMA} POINT {name}")
                time.sleep(0.4)
            simulator.tell("hold")  # so that it is offline where the recording ends, however late that comes

            def rests():
                held = self.joints(PUMA)
                time.sleep(0.2)
                return self.joints(PUMA) == held

            self.assertTrue(g.eventually(rests), "the motion goes on")
            self.done(f"TF_RECORD led {PUMA} STOP", f"ROBOT {PUMA} offline")
        finally:
            simulator.close()
            self.scratch.send(f"ROBOT {PUMA} offline")
        text = (self.folder / "led.boom").read_text()
        for name in ("first", "second", "third"):
            self.assertIn(f"POINT {name}", text)
        end = self.joints(PUMA)
        self.done("ROBOT_LANGUAGE jet_boom", f"TF_LOAD led {PUMA}", f"TF_BACK led {PUMA}", f"TF_WAIT {PUMA}",
                  f"TF_RUN led {PUMA}", f"TF_WAIT {PUMA}")
        for repeated, taught in zip(self.joints(PUMA), end):
            self.assertAlmostEqual(repeated, taught, delta=0.1)


if __name__ == "__main__":
    g.main()

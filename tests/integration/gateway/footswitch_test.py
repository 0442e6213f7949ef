"""Foot switches in the running gateway: bits that another process writes run scripts, once a change and in order."""

import json
import subprocess
import sys
import threading
import time
import unittest

import gateway as g
import shared_memory
from motion_test import Sender

CELL = g.SOURCE / "tests" / "integration" / "gateway" / "slider_cell"
INPUTS = 8
STEP_MM = 10.0  # input n puts the slide to 2n steps when it goes on, to 2n + 1 when it goes off


def place(number, on):
    return STEP_MM * (2 * number + (0 if on else 1))


class FootSwitches(unittest.TestCase):
    def setUp(self):
        self.scratch = g.Scratch(CELL)
        self.key = shared_memory.unused_key()
        self.write_scripts()
        self.gateway = None

    def tearDown(self):
        if self.gateway is None:
            return
        status = self.gateway.stop()
        self.gateway.close()
        self.scratch.remove()
        self.assertEqual(status, 0)
        self.assertFalse(shared_memory.exists(self.key), "the memory is still there")

    def write_scripts(self):
        scripts = self.scratch.home / "scripts"
        for number in range(1, INPUTS + 1):
            for on, word in ((True, "ON"), (False, "OFF")):
                (scripts / f"BININP{number}_{word}.spt").write_text(
                    f"POS_ROB SLIDER JOINT_ABS {place(number, on)};\nhot_message {number} {word};\n")

    def start(self, debounce_s=0.0, more="", online=True):
        with open(self.scratch.cell_file, "a", encoding="utf-8") as cell:
            cell.write(f"\n[foot_switches]\nkey = {self.key}\nbytes = 2\ndebounce_s = {debounce_s}\n"
                       f"online = {str(online).lower()}\n{more}")
        self.gateway = g.Gateway(self.scratch)
        for command in ("ROBACT SLIDER", "rob_positioning jump"):
            self.done(command)

    def done(self, command):
        done = self.scratch.send(command)
        self.assertEqual(done.returncode, 0, f"{command}: {done.stderr}")

    def refused(self, command, *words):
        done = self.scratch.send(command)
        self.assertEqual(done.returncode, 1, f"{command}: {done.stdout}")
        for word in words:
            self.assertIn(word, done.stderr)

    def switches(self):
        return self.scratch.status()["foot_switches"]

    def until(self, condition, timeout=g.PATIENCE_S):
        """The switches' status as soon as it meets the condition."""
        seen = []

        def look():
            seen[:] = [self.switches()]
            return condition(seen[0])

        self.assertTrue(g.eventually(look, timeout), seen)
        return seen[0]

    def places(self):
        """Where the slide was put, in mm, in the order of the flight record."""
        self.done("SAVE_FLIGHT switches.jsonl")
        lines = (self.scratch.home / "records" / "switches.jsonl").read_text().splitlines()
        records = (json.loads(line) for line in lines)
        return [round(1e3 * record["position"][0], 3) for record in records
                if record["kind"] == "robot" and record["event"] == "setpoint"]

    def test_a_press_and_a_release_run_their_scripts_and_are_told(self):
        self.start()
        status = self.switches()
        self.assertTrue(status["online"])
        self.assertEqual((status["key"], status["inputs"], status["attached"]), (self.key, 16, 0))
        with shared_memory.Segment(self.key) as memory:
            memory.byte().value = 0b100
            status = self.until(lambda s: s["scripts"]["started"] == 1 and not s["last_script"]["running"])
            self.assertEqual(status["last_script"]["file"], "BININP3_ON.spt")
            self.assertEqual(status["inputs_on"], [3])
            self.assertIn("3 ON", [message["text"] for message in self.scratch.status()["messages"]])
            memory.byte().value = 0
            status = self.until(lambda s: s["scripts"]["started"] == 2 and not s["last_script"]["running"])
            self.assertEqual((status["edges"], status["scripts"]["missing"], status["inputs_on"]), (2, 0, []))
            self.assertEqual(self.until(lambda s: s["attached"] == 1)["trouble"], "")
            self.assertGreater(status["first_command_ms"]["max"], 0.0)
        self.assertEqual(self.places(), [place(3, True), place(3, False)])
        text = self.scratch.cellmirror("status").stdout
        self.assertIn("foot switches  online", text)

    def test_bits_that_change_together_run_lower_inputs_first(self):
        self.start()
        with shared_memory.Segment(self.key) as memory:
            memory.byte().value = 0xFF
            self.until(lambda s: s["scripts"]["started"] == 8)
            memory.byte().value = 0b01010101
            self.until(lambda s: s["scripts"]["started"] == 12 and not s["last_script"]["running"])
        self.assertEqual(self.places(), [place(n, True) for n in range(1, 9)] + [place(n, False) for n in (2, 4, 6, 8)])

    def test_a_recording_has_each_change_and_what_came_of_it_runs_again(self):
        self.start()
        file = str(self.scratch.root / "a.mcap")
        recorder = g.Process([g.BIN / "cellmirror", "record", "-o", file, "--instance", self.scratch.instance], self.scratch.environment)
        self.addCleanup(recorder.close)
        self.assertTrue(g.eventually(lambda: any(one["messages"] for one in self.scratch.status()["recordings"])), recorder.output())
        with shared_memory.Segment(self.key) as memory:
            for n in range(6):
                memory.byte().value = 0b10 if n % 2 == 0 else 0
                self.until(lambda s: s["edges"] == n + 1)
            memory.byte().value = 0b1100  # together
            self.until(lambda s: s["scripts"]["started"] == 8 and not s["last_script"]["running"])
        self.assertEqual(recorder.stop(), 0, recorder.output())

        def exported(topic):
            done = self.scratch.cellmirror("recording", "export", file, "--topic", topic, "--json")
            self.assertEqual(done.returncode, 0, done.stderr)
            return [message["values"] for message in json.loads(done.stdout)["messages"]]

        changes = exported("/inputs/foot_switch_changes")
        self.assertEqual([(one["input"], one["on"]) for one in changes], [(2, True), (2, False)] * 3 + [(3, True), (4, True)])
        times = [one["time_ns"] for one in changes]
        self.assertEqual(times, sorted(times))
        moves = [one for one in exported("/cellmirror/commands") if one["command"].startswith("POS_ROB")]
        self.assertEqual([one["place"].split("/")[-1].split(":")[0] for one in moves],
                         ["BININP2_ON.spt", "BININP2_OFF.spt"] * 3 + ["BININP3_ON.spt", "BININP4_ON.spt"])
        sent = [one["loop_command"] for one in moves]
        self.assertEqual(sent, sorted(set(sent)), "each has sent something to the loop")
        done = self.scratch.cellmirror("replay", file, "--verify", "--json")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertTrue(json.loads(done.stdout)["equal"])

    def test_bounces_are_no_changes(self):
        self.start(debounce_s=0.2)
        with shared_memory.Segment(self.key) as memory:
            for value in (1, 0, 1, 0, 1):
                memory.byte().value = value
                time.sleep(0.004)
            self.until(lambda s: s["scripts"]["started"] == 1)
            time.sleep(0.3)
            status = self.switches()
            self.assertEqual((status["edges"], status["scripts"]["started"]), (1, 1), status)

    def test_missing_and_broken_scripts_are_reported_and_the_next_goes_on(self):
        (self.scratch.home / "scripts" / "BININP1_ON.spt").unlink()
        (self.scratch.home / "scripts" / "BININP2_ON.spt").write_text("NO_SUCH_COMMAND;\n")
        (self.scratch.home / "scripts" / "BININP3_ON.spt").write_text("ROBACT NOBODY;\nhot_message after;\n")
        self.start()
        with shared_memory.Segment(self.key) as memory:
            for _ in range(3):
                before = self.switches()["edges"]
                memory.byte().value = 0b1111
                self.until(lambda s: s["edges"] == before + 4)
                memory.byte().value = 0
                self.until(lambda s: s["edges"] == before + 8)
            status = self.until(lambda s: s["scripts"]["waiting"] == 0 and not s["last_script"]["running"])
        scripts = status["scripts"]
        self.assertEqual((scripts["missing"], scripts["refused"], scripts["with_errors"]), (3, 3, 3), status)
        self.assertEqual(scripts["started"], 24 - 3 - 3)
        self.assertEqual(status["missing_files"], ["BININP1_ON.spt"])
        self.assertTrue(g.eventually(lambda: "BININP1_ON.spt" in self.gateway.output()), self.gateway.output())
        self.assertEqual(self.gateway.output().count("BININP1_ON.spt"), 1, self.gateway.output())

    def test_order_is_kept_under_load(self):
        """Hundreds of changes while messages come in as fast as they can."""
        self.start()
        sender = Sender(self.scratch)
        stop = threading.Event()

        def flood():
            while not stop.is_set():
                sender.send("SET_FORCE_ARROW 1 2 3")

        flooding = threading.Thread(target=flood)
        flooding.start()
        expected = []
        try:
            with shared_memory.Segment(self.key) as memory:
                bits = 0
                for round_number in range(100):
                    number = 1 + 3 * round_number % INPUTS
                    for _ in range(2):
                        bits ^= 1 << (number - 1)
                        memory.byte().value = bits
                        expected.append(place(number, bool(bits >> (number - 1) & 1)))
                        seen = len(expected)
                        # A change that nobody looked at in time would be none: memory has no queue.
                        self.until(lambda s: s["edges"] == seen)
                status = self.until(lambda s: s["scripts"]["waiting"] == 0 and not s["last_script"]["running"])
        finally:
            stop.set()
            flooding.join()
        self.assertEqual(status["edges_dropped"], 0)
        self.assertEqual(status["scripts"]["started"], status["edges"])
        if status["edges"] < len(expected):
            self.skipTest("skipped: the machine was too busy to look at the switches within 3 ms")
        self.assertEqual(self.places(), expected)
        print("first command after a change, under a flood of messages [ms]:", status["first_command_ms"])

    def test_a_writer_that_dies_and_comes_back(self):
        self.start()
        program = ("import sys, time, shared_memory as s\nm = s.Segment(int(sys.argv[1]))\n"
                   "m.byte().value = 1 - m.byte().value\nprint('done', flush=True)\ntime.sleep(60)\n")
        for life in range(1, 4):
            child = subprocess.Popen([sys.executable, "-c", program, str(self.key)], stdout=subprocess.PIPE)
            try:
                self.assertEqual(child.stdout.readline(), b"done\n")
                self.until(lambda s: s["scripts"]["started"] == life and s["attached"] == 1)
            finally:
                child.kill()
                child.wait()
                child.stdout.close()
            self.until(lambda s: s["attached"] == 0)

    def test_a_memory_that_is_removed_is_made_anew(self):
        self.start()
        with shared_memory.Segment(self.key) as memory:
            memory.remove()
            self.until(lambda s: s["renewed"] == 1)
        with shared_memory.Segment(self.key) as memory:
            memory.byte().value = 1
            self.until(lambda s: s["scripts"]["started"] == 1)

    def test_by_command_offline_and_another_memory(self):
        self.start(online=False)
        other = shared_memory.unused_key()
        with shared_memory.Segment(self.key) as memory:
            memory.byte().value = 1
            time.sleep(0.1)
            self.assertEqual(self.switches()["edges"], 0)
            self.done("BIN_ELA online")
            memory.byte(1).value = 0x80  # input 16 has no script; 1 was on before
            status = self.until(lambda s: s["scripts"]["missing"] == 1)
            self.assertEqual((status["inputs_on"], status["scripts"]["started"]), ([1, 16], 0))
            self.done("BIN_ELA offline")
            memory.byte().value = 0
            time.sleep(0.1)
            self.assertEqual(self.switches()["edges"], 1)
        self.done("BIN_ELA online")
        self.done(f"bin_ela_shm 0 {other} 1")
        self.assertFalse(shared_memory.exists(self.key))
        with shared_memory.Segment(other) as memory:
            memory.byte().value = 0b10
            status = self.until(lambda s: s["scripts"]["started"] == 1)
            self.assertEqual((status["key"], status["inputs"]), (other, 8))
        with shared_memory.Segment(self.key, 64, create=True) as memory:
            self.done(f"bin_ela_shm 0 {self.key} 64")  # ours already: taken as it stands

    def test_refusals(self):
        self.gateway = g.Gateway(self.scratch)
        self.refused("BIN_ELA online", "no memory of binary inputs is set", "bin_ela_shm")
        with shared_memory.Segment(self.key, 1, create=True):
            self.refused(f"bin_ela_shm 0 {self.key} 100000")
        self.refused("bin_ela_shm 0 0 1", "shared memory key")
        self.assertIsNone(self.switches()["key"])


if __name__ == "__main__":
    g.main()

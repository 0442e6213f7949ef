"""sim_haptic and sim_footswitch as processes, beside a memory that this test makes as a gateway would."""

import json
import pathlib
import signal
import subprocess
import sys
import threading
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from gateway import BIN, eventually  # noqa: E402
from shared_memory import HapticBlock, Segment, unused_key  # noqa: E402


def start(program, *arguments):
    return subprocess.Popen([str(BIN / program), *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def finish(child, timeout=60):
    out, err = child.communicate(timeout=timeout)
    if child.returncode != 0:
        raise AssertionError(f"ended with {child.returncode}: {err}")
    return json.loads(out)


class Wall:
    """Answers the newest sample about once a millisecond: a wall of 800 N/m at z = -0.01."""

    def __init__(self, block):
        self.block, self.end = block, threading.Event()
        self.thread = threading.Thread(target=self.work)

    def work(self):
        while not self.end.is_set():
            sample = self.block.sample()
            if sample:
                force = max(0.0, 800 * (-0.01 - sample["position"][2]))
                self.block.write_force([0, 0, force], sample["sequence"], time.monotonic_ns())
            time.sleep(0.0005)

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.end.set()
        self.thread.join()


class SimHaptic(unittest.TestCase):
    def setUp(self):
        self.key = unused_key()
        self.children = []

    def tearDown(self):
        for child in self.children:
            if child.poll() is None:
                child.kill()
            child.communicate()

    def sim(self, *arguments):
        self.children.append(start("sim_haptic", "--key", self.key, "-q", "--json", *arguments))
        return self.children[-1]

    def test_waits_for_the_memory_and_comes_back_to_a_new_one(self):
        child = self.sim("--for", 0, "--rate", 500)
        time.sleep(0.1)
        with HapticBlock(self.key, create=True) as first:
            sample = eventually(first.sample)
            self.assertEqual(sample["process"], child.pid)
            self.assertTrue(sample["valid"])
            self.assertEqual(sample["axis_count"], 6)
            self.assertEqual(sample["orientation"], [0, 0, 0, 1])
        with HapticBlock(self.key, create=True) as second:
            self.assertTrue(eventually(second.sample))
            child.send_signal(signal.SIGINT)
            report = finish(child)
        self.assertEqual(report["attachments"], 2)
        self.assertGreater(report["waited_s"], 0.05)

    def test_without_a_memory_it_gives_up_when_told(self):
        child = self.sim("--wait", 0.1)
        _, err = child.communicate(timeout=60)
        self.assertEqual(child.returncode, 1)
        self.assertIn("does not exist", err)

    def test_feels_a_wall_and_tells_of_it(self):
        with HapticBlock(self.key, create=True) as block, Wall(block):
            report = finish(self.sim("--motion", "touch z -0.03 at=0.3; press 0.01 500ms; letgo", "--poll", 100))
        self.assertTrue(report["motion_done"])
        # Hand of 300 N/m behind a wall of 800 N/m: 10 mm deeper are 2.2 N more.
        self.assertGreater(report["max_force_n"], 1.8)
        self.assertLess(report["max_force_n"], 4.5)
        self.assertGreater(report["latency_us"]["count"], 20)
        self.assertGreater(report["forces"], 20)
        self.assertEqual(report["phase"], "active")

    def test_a_watcher_sees_what_the_hand_feels_and_writes_nothing(self):
        log = pathlib.Path(f"/tmp/cellmirror-watch-{self.key}.csv")
        try:
            with HapticBlock(self.key, create=True) as block, Wall(block):
                watcher = self.sim("--watch", "--for", 1.5, "--log", log)
                report = finish(self.sim("--motion", "touch z -0.03 at=0.3; press 0.01 300ms"))
                seen = finish(watcher)
            rows = log.read_text().splitlines()
        finally:
            log.unlink(missing_ok=True)
        self.assertEqual(seen["device"], "haptic watcher")
        # It may look less often than the hand feels.
        self.assertLess(seen["max_force_n"], report["max_force_n"] + 0.3)
        self.assertGreater(seen["max_force_n"], 0.5 * report["max_force_n"])
        self.assertEqual(len(rows) - 1, seen["forces"])
        self.assertTrue(rows[0].startswith("time_ns,sequence,sample_time_ns,writer,x,y,z"))

    def faulty(self, fault, *arguments):
        child = self.sim("--for", 1.0, "--fault", fault, *arguments)
        return child

    def test_dead_and_torn_end_without_a_word(self):
        for fault, odd in (("dead@0.1", 0), ("torn@0.1", 1)):
            with self.subTest(fault), HapticBlock(self.key, create=True) as block:
                child = self.faulty(fault)
                out, _ = child.communicate(timeout=60)
                self.assertEqual(child.returncode, -signal.SIGKILL)
                self.assertEqual(out, "")
                self.assertEqual(block.u64(320).value % 2, odd)

    def test_a_new_device_writes_on_where_one_died_while_writing(self):
        with HapticBlock(self.key, create=True) as block:
            self.faulty("torn@0.05").communicate(timeout=60)
            self.assertIsNone(block.sample())
            child = self.sim("--for", 0)
            self.assertTrue(eventually(lambda: (s := block.sample()) and s["process"] == child.pid and s["sequence"] > 400))
            child.send_signal(signal.SIGINT)
            self.assertGreater(finish(child)["samples"], 100)

    def test_freeze_writes_nothing_and_lives(self):
        with HapticBlock(self.key, create=True) as block:
            child = self.sim("--for", 0, "--fault", "freeze@0.1")

            def frozen():
                sequence = block.u64(328).value
                time.sleep(0.3)
                return block.u64(328).value == sequence and sequence

            sequence = eventually(frozen)
            self.assertTrue(sequence, "it goes on writing")
            self.assertIsNone(child.poll())
            child.send_signal(signal.SIGINT)
            report = finish(child)
        self.assertEqual(report["samples"], sequence)
        self.assertEqual(report["faults"][0]["fault"], "freeze@0.1")
        self.assertEqual(report["faults"][0]["sequence"], sequence + 1)

    def test_twice_is_two_processes_until_its_end(self):
        with HapticBlock(self.key, create=True) as block:
            child = self.faulty("twice@0.1..0.5")
            writers = set()
            while child.poll() is None:
                writers.add(block.u32(344).value)
            finish(child)
        writers.discard(0)
        self.assertEqual(len(writers), 2)
        self.assertIn(child.pid, writers)
        other = (writers - {child.pid}).pop()
        self.assertFalse(pathlib.Path(f"/proc/{other}").exists())

    def test_values_are_struck(self):
        struck = {
            "nan@0.1": lambda s: s["position"][1] != s["position"][1],
            "invalid@0.1": lambda s: not s["valid"],
            "rotation@0.1": lambda s: s["orientation"] == [0, 0, 0, 0],
            "late:s=0.5@0.1": lambda s: time.monotonic_ns() - s["time_ns"] > 400_000_000,
            "jump:by=0.07@0.1": lambda s: abs(s["position"][0] - 0.07) < 0.01,
            "unbounded@0.1": lambda s: s["position"][0] > 1e200,
        }
        for fault, is_struck in struck.items():
            with self.subTest(fault), HapticBlock(self.key, create=True) as block:
                child = self.sim("--for", 0, "--fault", fault)
                self.assertTrue(eventually(lambda: (s := block.sample()) and is_struck(s), every=0.005))
                child.send_signal(signal.SIGINT)
                finish(child)


class SimFootSwitch(unittest.TestCase):
    def setUp(self):
        self.key = unused_key()

    def test_presses_and_leaves_other_bits(self):
        with Segment(self.key, 2, create=True) as memory:
            memory.byte(0).value = 0x80
            child = start("sim_footswitch", "--key", self.key, "--press", "1,10", "--for", 2.5, "--json", "-q")
            self.assertTrue(eventually(lambda: memory.byte(0).value == 0x81 and memory.byte(1).value == 0x02, every=0.005))
            report = finish(child)
            self.assertEqual((memory.byte(0).value, memory.byte(1).value), (0x80, 0))
        self.assertEqual((report["changes"], report["bounces"], report["left_out"]), (4, 0, 0))

    def test_a_sequence_is_played_in_order_with_bounces(self):
        log = pathlib.Path(f"/tmp/cellmirror-switches-{self.key}.csv")
        try:
            with Segment(self.key, 1, create=True) as memory:
                child = start("sim_footswitch", "--key", self.key, "--sequence", "1+ 2+ 50ms 1-,2-", "--bounce", "3,5ms",
                              "--log", log, "--json", "-q")
                report = finish(child)
                self.assertEqual(memory.byte().value, 0)
            rows = [row.split(",") for row in log.read_text().splitlines()[1:]]
        finally:
            log.unlink(missing_ok=True)
        self.assertEqual((report["changes"], report["bounces"]), (4, 24))
        self.assertEqual([row[1:3] for row in rows if row[3] == "0"], [["1", "1"], ["2", "1"], ["1", "0"], ["2", "0"]])
        self.assertEqual(sorted(int(row[0]) for row in rows), [int(row[0]) for row in rows])

    def test_a_hold_ends_with_ctrl_c(self):
        with Segment(self.key, 1, create=True) as memory:
            child = start("sim_footswitch", "--key", self.key, "--hold", "3", "--json", "-q")
            self.assertTrue(eventually(lambda: memory.byte().value == 4))
            child.send_signal(signal.SIGINT)
            finish(child)
            self.assertEqual(memory.byte().value, 0)

    def test_wrong_words_end_with_two(self):
        for words in (["--press", "0"], ["--sequence", "1*"], ["--bounce", "3", "--press", "1"], []):
            child = start("sim_footswitch", "--key", self.key, *words)
            _, err = child.communicate(timeout=60)
            self.assertEqual(child.returncode, 2, err)
            self.assertTrue(err)


if __name__ == "__main__":
    unittest.main(verbosity=2)

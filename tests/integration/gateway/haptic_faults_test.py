"""Hands feel the organ; and whatever goes wrong with a device, its force is zero within two ticks, until it is reset."""

import time
import unittest

import gateway as g
import trainer as t

STALE_NS = 30_000_000  # trainer.PATIENT
INTO = t.LEFT["into"]
TOUCH = f"motion touch {INTO} 0.12 speed=0.12 at=0.3; press 0.015 60s"

# fault, what the gateway says, whether the program is gone afterwards, how its instant is known
FAULTS = (
    ("freeze@0.1..0.6", {"stale"}, False, "silence"),
    ("jump:by=0.05@0.1..0.15", {"jump"}, False, "value"),
    ("nan@0.1..0.15", {"not_finite"}, False, "value"),
    ("rotation@0.1..0.15", {"not_finite"}, False, "value"),
    ("unbounded@0.1..0.15", {"not_finite", "jump", "invalid"}, False, "value"),
    ("late:s=0.1@0.1..0.4", {"stale"}, False, "value"),
    ("invalid@0.1..0.15", {"invalid"}, False, "value"),
    # The device itself is silent meanwhile: else its own sample may be the one that a tick finds.
    ("twice@0.1..0.3 freeze@0.1..0.3", {"two_writers"}, False, "writer"),
    ("dead@0.1", {"stale", "vanished"}, True, "silence"),
    ("torn@0.1", {"stale", "torn", "vanished"}, True, "silence"),
)

# As in the block (docs/shared-memory.md), from 0.
FAULT_NAMES = ("none", "stale", "vanished", "not_finite", "invalid", "jump", "two_writers", "torn", "late_tick", "stale_model",
               "not_passive")

OF_A_BUSY_MACHINE = ("stale", "late_tick")


def detectable_ns(how, seen, summary):
    """CLOCK_MONOTONIC from which on the gateway could know: what was read by a third process tells it. None where that came too
    late to see it."""
    if how == "value":
        return summary["faults"][0]["time_ns"] if summary["faults"] else None
    if how == "writer":
        return next((row["sample_time_ns"] for row in seen if row["writer"] not in (0, seen[0]["writer"])), None)
    # The longest pause between samples that were seen begins with the last good one.
    times = sorted({row["sample_time_ns"] for row in seen if row["sample_time_ns"]})
    times.append(seen[-1]["force_time_ns"])
    begin = max(range(len(times) - 1), key=lambda i: times[i + 1] - times[i])
    return times[begin] + STALE_NS


ATTEMPTS = 8  # to get a force without a fault of a busy machine, which is latched too


class Haptic(unittest.TestCase):
    settings = t.UNDISTURBED

    @classmethod
    def setUpClass(cls):
        cls.scratch = g.Scratch("phantom_trainer")
        cls.keys = t.with_own_memories(cls.scratch, drives=("pose", "joints"), more=cls.settings)
        cls.gateway = g.Gateway(cls.scratch)

    @classmethod
    def tearDownClass(cls):
        cls.gateway.close()
        cls.scratch.remove()

    def setUp(self):
        self.sims = []
        self.log = self.scratch.root / "watch.csv"

    def tearDown(self):
        for sim in self.sims:
            sim.kill()

    def sim(self, *arguments, robot="LAP_LEFT"):
        self.sims.append(t.sim_haptic(self.keys[robot], *arguments))
        return self.sims[-1]

    def hand(self, *arguments, robot="LAP_LEFT"):
        """A device whose force is on: what was latched before it (the last one's end is a fault too) is reset."""
        self.sims.append(t.Hand(self.scratch, self.keys[robot], *arguments))
        self.engage(self.sims[-1], robot)
        return self.sims[-1]

    def engage(self, device, robot="LAP_LEFT"):
        def engaged():
            state = t.haptic(self.scratch, robot)
            if state["device"]["process"] != device.child.pid:
                return False
            if state["phase"] == "faulted":
                self.scratch.send(f"RESET_HAPTIC {robot}")
            return state["phase"] == "active"
        self.assertTrue(g.eventually(engaged), t.haptic(self.scratch, robot))

    def press(self, device, motion=TOUCH, robot="LAP_LEFT"):
        """Until a force is felt."""
        for _ in range(ATTEMPTS):
            device.say(motion)
            state = {}

            def felt_or_faulted():
                state.update(t.haptic(self.scratch, robot))
                return sum(part * part for part in state["force"]["world_n"]) > 0.16 or state["phase"] == "faulted"
            self.assertTrue(g.eventually(felt_or_faulted), state)
            if state["phase"] != "faulted":
                return
            device.say("motion back speed=0.3")
            self.engage(device, robot)
        self.fail(f"{ATTEMPTS} touches ended in a fault: {t.haptic(self.scratch, robot)}")

    def end(self, device):
        device.say("quit")
        return device.finish()


class Feeling(Haptic):
    def test_a_hand_feels_the_organ_against_its_motion(self):
        device = self.hand("--axes", 7, "--log", self.log)
        self.press(device)
        time.sleep(0.5)
        device.say("motion letgo; back; hold 60s")
        force = lambda: t.haptic(self.scratch, "LAP_LEFT")["force"]["world_n"]
        self.assertTrue(g.eventually(lambda: force() == [0, 0, 0]), force())
        summary = self.end(device)
        self.assertEqual(summary["fault"], "none", summary)
        self.assertGreater(summary["max_force_n"], 0.5)
        self.assertLess(summary["max_force_n"], 8.01)
        pressing = max(t.rows(self.log), key=lambda row: row["force_n"])
        against = 0.5722 * pressing["effort_x"] + 0.3587 * pressing["effort_y"] - 0.7374 * pressing["effort_z"]
        self.assertLess(against, -0.4)
        self.assertLess(summary["max_work_j"], 5e-3)

    def test_a_handle_on_a_trocar_feels_torques(self):
        device = self.hand("--axes", 5, "--start", "0,0,0.12,0,0", robot="LAP_RIGHT")
        self.press(device, "motion touch insertion 0.1 speed=0.1 at=0.3; press 0.015 60s", robot="LAP_RIGHT")
        time.sleep(0.5)
        summary = self.end(device)
        self.assertEqual(summary["fault"], "none", summary)
        self.assertGreater(summary["max_torque_nm"], 0.5)  # N of the insertion

    def test_the_hand_moves_the_instrument_and_the_jaw(self):
        device = self.hand("--axes", 7)
        device.say("motion drag x 0.01; drag gripper 0.3 speed=1")

        def there():
            tip = t.haptic(self.scratch, "LAP_LEFT")["proxy_position_m"]
            joints = self.scratch.robot("LAP_LEFT")["joints"]
            jaw = joints[-1].get("position_rad", joints[-1].get("position"))
            return abs(tip[0] - t.LEFT["tip"][0] - 0.01) < 1e-3 and abs(jaw - 0.3) < 0.02
        self.assertTrue(g.eventually(there), (t.haptic(self.scratch, "LAP_LEFT")["proxy_position_m"], self.scratch.robot("LAP_LEFT")))
        self.end(device)

    def test_without_a_device_nothing_is_felt_and_reset_tells_so(self):
        done = self.scratch.send("RESET_HAPTIC LAP_RIGHT")
        self.assertNotEqual(done.returncode, 0, "there was nothing to reset")
        self.assertNotEqual(self.scratch.send("RESET_HAPTIC NOBODY").returncode, 0)


class Faults(Haptic):
    settings = t.PATIENT

    def check_fault(self, fault, words, killed, how):
        found = None
        for _ in range(ATTEMPTS):
            seen, summary = self.strike(fault, killed)
            begin = detectable_ns(how, seen, summary) if seen else None
            if begin is None:
                continue
            before = [row for row in seen if begin - 200_000_000 < row["force_time_ns"] < begin - STALE_NS]
            after = [row for row in seen if row["force_time_ns"] >= begin]
            # Two ticks: the instant of a silence is known to one.
            gone = any(row["phase"] == 5 for row in seen if row["force_time_ns"] < begin - 2_000_000)
            found = next((FAULT_NAMES[row["fault"]] for row in after if row["phase"] == 5), None)
            late = found in OF_A_BUSY_MACHINE and found not in words
            if before and after and not gone and not late:
                return self.check_record(before, after, fault, words)
        return self.fail(f"{ATTEMPTS} times the force was gone before the fault, or for another one ({found}), or nobody looked")

    def strike(self, fault, killed):
        """What a third process read meanwhile, and the report of the device."""
        device = self.hand("--axes", 7)
        self.press(device)
        watcher = self.sim("--axes", 7, "--watch", "--for", 2, "--log", self.log)
        time.sleep(0.5)
        device.say("\n".join("fault " + part for part in fault.split()))
        watcher.finish()
        if killed:
            device.finish(killed=True)
        else:
            device.say("motion back speed=0.3")
        state = lambda: t.haptic(self.scratch, "LAP_LEFT")
        self.assertTrue(g.eventually(lambda: state()["phase"] == "faulted"), state())
        self.assertTrue(state()["remedy"])
        # It is well again: reset works, and the force comes back.
        again = self.hand("--axes", 7) if killed else device
        self.engage(again)
        self.press(again)
        return t.rows(self.log), self.end(again)

    def check_record(self, before, after, fault, words):
        """Rows of the record before the gateway could know of the fault, and after that."""
        self.assertGreater(max(row["force_n"] for row in before), 0.3, f"nothing was felt before the fault; before: {before[:1]}")
        first = after[0]["force_sequence"]
        zero_from = next((row["force_sequence"] for row in after if row["force_n"] == 0 and row["torque_nm"] == 0), None)
        self.assertIsNotNone(zero_from, "the force never vanished")
        print(f"  {fault}: zero in tick {zero_from - first + 1} after it could be known")
        self.assertLessEqual(zero_from - first + 1, 2)
        for row in after:
            if row["force_sequence"] >= zero_from:
                self.assertEqual((row["force_n"], row["torque_nm"], row["phase"]), (0, 0, 5), "not latched")
        self.assertIn(FAULT_NAMES[next(row["fault"] for row in after if row["phase"] == 5)], words)

    def test_two_writers_by_turns_are_found(self):
        device = self.hand("--axes", 7)
        device.say("fault twice@0..10")

        def found():
            state = t.haptic(self.scratch, "LAP_LEFT")
            if state["phase"] == "faulted" and state["fault"] != "two_writers":  # the machine was late
                self.scratch.send("RESET_HAPTIC LAP_LEFT")
            return state["fault"] == "two_writers"

        self.assertTrue(g.eventually(found), t.haptic(self.scratch, "LAP_LEFT"))
        self.end(device)


def add_fault_test(fault, words, killed, how):
    def test(self):
        self.check_fault(fault, words, killed, how)
    setattr(Faults, f"test_fault_{fault.split('@')[0].split(':')[0]}", test)


for row in FAULTS:
    add_fault_test(*row)


if __name__ == "__main__":
    g.main()

"""Hands feel the organ; and whatever goes wrong with a device, its force is zero within two ticks, until it is reset."""

import time
import unittest

import gateway as g
import trainer as t

STALE_NS = 30_000_000  # trainer.PATIENT
INTO = t.LEFT["into"]
TOUCH = f"hold 1500ms; touch {INTO} 0.12 speed=0.12 at=0.3; press 0.006 60s"

# fault, what the gateway says, whether the program is gone afterwards, how its instant is known
FAULTS = (
    ("freeze@4..5", {"stale"}, False, "silence"),
    ("jump:by=0.05@4..4.05", {"jump"}, False, "value"),
    ("nan@4..4.05", {"not_finite"}, False, "value"),
    ("rotation@4..4.05", {"not_finite"}, False, "value"),
    ("unbounded@4..4.05", {"not_finite", "jump"}, False, "value"),
    ("late:s=0.1@4..4.4", {"stale"}, False, "value"),
    ("invalid@4..4.05", {"invalid"}, False, "value"),
    ("twice@4..4.2", {"two_writers", "jump"}, False, "writer"),
    ("dead@4", {"stale", "vanished"}, True, "silence"),
    ("torn@4", {"stale", "torn", "vanished"}, True, "silence"),
)


def detectable_ns(how, seen, summary):
    """CLOCK_MONOTONIC from which on the gateway could know: what was read by a third process tells it."""
    if how == "value":
        return summary["faults"][0]["time_ns"]
    if how == "writer":
        own = seen[0]["writer"]
        return next(row["sample_time_ns"] for row in seen if row["writer"] not in (0, own))
    # The longest pause between samples that were seen begins with the last good one.
    times = sorted({row["sample_time_ns"] for row in seen if row["sample_time_ns"]})
    times.append(seen[-1]["force_time_ns"])
    begin = max(range(len(times) - 1), key=lambda i: times[i + 1] - times[i])
    return times[begin] + STALE_NS


class Haptic(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = g.Scratch("trainer")
        cls.keys = t.with_own_memories(cls.scratch)
        cls.gateway = g.Gateway(cls.scratch)
        cls.key = cls.keys["LAP_LEFT"]

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
        device = self.sim(*arguments, robot=robot)

        def engaged():
            phase = t.haptic(self.scratch, robot)["phase"]
            if phase == "faulted":
                self.scratch.send(f"RESET_HAPTIC {robot}")
            return phase in ("engaging", "active")
        self.assertTrue(g.eventually(engaged, 5), t.haptic(self.scratch, robot))
        return device

    def test_a_hand_feels_the_organ_against_its_motion(self):
        summary = self.hand("--axes", 7, "--motion", f"hold 1500ms; touch {INTO} 0.12 speed=0.12 at=0.3; press 0.008 1s; letgo; hold 200ms",
                           "--log", self.log).finish()
        self.assertEqual(summary["fault"], "none", summary)
        self.assertTrue(summary["motion_done"])
        self.assertGreater(summary["max_force_n"], 1.0)
        self.assertLess(summary["max_force_n"], 8.01)
        pressing = max(t.rows(self.log), key=lambda row: row["force_n"])
        against = 0.5722 * pressing["effort_x"] + 0.3587 * pressing["effort_y"] - 0.7374 * pressing["effort_z"]
        self.assertLess(against, -0.5)
        self.assertLess(summary["max_work_j"], 5e-3)
        self.assertLess(summary["latency_us"]["p50"], 3000)

    def test_a_handle_on_a_trocar_feels_torques(self):
        summary = self.hand("--axes", 5, "--start", "0,0,0.12,0,0", "--motion",
                            "hold 1500ms; touch insertion 0.1 speed=0.1 at=0.3; press 0.006 1s; letgo", robot="LAP_RIGHT").finish()
        self.assertEqual(summary["fault"], "none", summary)
        self.assertGreater(summary["max_torque_nm"], 0.5)  # N of the insertion
        self.assertTrue(summary["motion_done"])

    def test_the_hand_moves_the_instrument_and_the_jaw(self):
        self.hand("--axes", 7, "--motion", "drag x 0.01; drag gripper 0.3 speed=1; hold 60s")
        time.sleep(1.5)
        tip = t.haptic(self.scratch, "LAP_LEFT")["proxy_position_m"]
        self.assertAlmostEqual(tip[0], t.LEFT["tip"][0] + 0.01, delta=2e-3)
        jaw = next(joint for joint in self.scratch.robot("LAP_LEFT")["joints"] if "JAW" in str(joint.get("name", "")))
        self.assertAlmostEqual(jaw.get("position_rad", jaw.get("position")), 0.3, delta=0.02)

    def check_fault(self, fault, words, killed, how):
        device = self.hand("--axes", 7, "--motion", TOUCH, "--fault", fault, "--for", 5.5)
        watcher = self.sim("--axes", 7, "--watch", "--for", 6, "--log", self.log)
        summary = device.finish(killed=killed)
        watcher.finish()
        seen = t.rows(self.log)
        self.assertGreater(len(seen), 1000)
        begin = detectable_ns(how, seen, summary)
        before = [row for row in seen if begin - 200_000_000 < row["force_time_ns"] < begin - STALE_NS]
        self.assertGreater(max((row["force_n"] for row in before), default=0), 0.3, "nothing was felt before the fault")
        after = [row for row in seen if row["force_time_ns"] >= begin]
        first = after[0]["force_sequence"]
        zero_from = next((row["force_sequence"] for row in after if row["force_n"] == 0 and row["torque_nm"] == 0), None)
        self.assertIsNotNone(zero_from, "the force never vanished")
        print(f"  {fault}: zero in tick {zero_from - first + 1} after it could be known")
        self.assertLessEqual(zero_from - first + 1, 2)
        for row in after:
            if row["force_sequence"] >= zero_from:
                self.assertEqual((row["force_n"], row["torque_nm"], row["phase"]), (0, 0, 5), "not latched")
        state = t.haptic(self.scratch, "LAP_LEFT")
        self.assertEqual(state["phase"], "faulted")
        self.assertIn(state["fault"], words)
        self.assertTrue(state["remedy"])

    def check_recovery(self):
        summary = self.hand("--axes", 7, "--motion", TOUCH, "--for", 4.5).finish()
        self.assertEqual((summary["phase"], summary["fault"]), ("active", "none"))
        self.assertGreater(summary["max_force_n"], 0.3)

    def test_without_a_device_nothing_is_felt_and_reset_tells_so(self):
        done = self.scratch.send("RESET_HAPTIC LAP_RIGHT")
        self.assertNotEqual(done.returncode, 0, "there was nothing to reset")
        self.assertNotEqual(self.scratch.send("RESET_HAPTIC NOBODY").returncode, 0)


def add_fault_test(fault, words, killed, how):
    def test(self):
        self.check_fault(fault, words, killed, how)
        self.check_recovery()
    setattr(Haptic, f"test_fault_{fault.split('@')[0].split(':')[0]}", test)


for row in FAULTS:
    add_fault_test(*row)


if __name__ == "__main__":
    g.main()

"""With the defaults of the cell file a haptic device survives a busy machine: what was only late or was replaced engages
again by itself, at rest and outside of bodies; the rest stays, and page and status say what to do."""

import json
import signal
import sys
import unittest

import gateway as g
import trainer as t

sys.path.append(str(g.SOURCE / "tests" / "integration" / "web"))
import page_client

ROBOT = "LAP_LEFT"
INTO = t.LEFT["into"]


class Recovery(unittest.TestCase):
    def setUp(self):
        self.scratch = g.Scratch("phantom_trainer")
        self.addCleanup(self.scratch.remove)
        # The defaults: nothing but memories of its own.
        self.key = t.with_own_memories(self.scratch, more="")[ROBOT]
        gateway = g.Gateway(self.scratch, page=True)
        self.addCleanup(gateway.close)
        done = self.scratch.cellmirror("page", "--json", "--instance", self.scratch.instance)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.page = page_client.Page(json.loads(done.stdout))

    def device(self):
        return t.haptic(self.scratch, ROBOT)

    def hand(self):
        hand = t.Hand(self.scratch, self.key, "--axes", 7)
        self.addCleanup(hand.kill)
        return hand

    def until(self, condition, what, timeout=g.PATIENCE_S):
        seen = {}

        def look():
            device = self.device()
            state = (device["phase"], device["fault"], device["awaits"])
            seen[state] = seen.get(state, 0) + 1
            return condition(device)

        self.assertTrue(g.eventually(look, timeout), (what, seen, self.device()))

    def active(self, process):
        """The force is on, for that process."""
        self.until(lambda d: d["phase"] == "active" and d["device"]["process"] == process, "never active")

    def faulted(self):
        self.until(lambda d: d["phase"] == "faulted", "no fault")

    def press(self, hand):
        """Until a force is felt. Where the machine was late meanwhile, the hand has to leave the body first."""
        for _ in range(8):
            hand.say(f"motion touch {INTO} 0.12 speed=0.12 at=0.3; press 0.004 60s")
            self.until(lambda d: sum(part * part for part in d["force"]["world_n"]) > 0.16 or d["awaits"] == "outside", "no force is felt")
            if self.device()["awaits"] != "outside":
                return
            hand.say("motion letgo; back speed=0.2; hold 60s")
            # Planes near a tip that was left in the bend of the organ may count the place of the hand as inside for good.
            if not g.eventually(lambda: self.device()["phase"] == "active", 10):
                self.scratch.send(f"RESET_HAPTIC {ROBOT}")
            self.active(hand.child.pid)
        self.fail(f"eight touches ended in a fault: {self.device()}")

    def condition_on_the_page(self, wanted):
        live = page_client.Live(self.page)
        try:
            live.until(lambda m: isinstance(m, dict) and m["is"] == "live" and
                       any(robot["id"] == ROBOT and wanted in robot["condition"] for robot in m["robots"]))
        finally:
            live.close()

    def test_the_default_profile_is_patient_and_strict_is_a_word(self):
        settings = self.device()["settings"]
        self.assertEqual(settings["profile"], "desktop")
        self.assertTrue(settings["re_engage"])
        self.assertGreaterEqual(settings["stale_after_s"], 0.05)

    def test_another_process_in_the_place_of_a_killed_one_engages_by_itself(self):
        first = self.hand()
        self.active(first.child.pid)
        self.press(first)
        resets = self.device()["resets"]
        first.child.kill()
        first.child.wait()
        self.faulted()
        self.assertEqual(self.device()["force"]["world_n"], [0, 0, 0])
        second = self.hand()
        self.active(second.child.pid)
        self.assertGreaterEqual(self.device()["re_engagements"], 1)
        self.assertEqual(self.device()["resets"], resets)
        self.press(second)

    def test_a_process_that_stood_still_engages_by_itself_outside_of_bodies(self):
        hand = self.hand()
        self.active(hand.child.pid)
        self.press(hand)
        hand.child.send_signal(signal.SIGSTOP)
        self.faulted()
        self.condition_on_the_page("engages again by itself, waits for")
        hand.child.send_signal(signal.SIGCONT)
        self.until(lambda d: d["awaits"] == "outside", "the hand is inside of the organ: it must wait")
        self.condition_on_the_page("waits for the hand outside of bodies")
        hand.say("motion letgo; back speed=0.2; hold 60s")
        self.active(hand.child.pid)

    def test_what_is_wrong_with_the_device_stays_and_says_so(self):
        hand = self.hand()
        self.active(hand.child.pid)
        hand.say("fault jump:by=0.05@0.1..1.5")
        self.until(lambda d: d["phase"] == "faulted" and d["awaits"] == "reset", "no fault that stays")
        before = self.device()["re_engagements"]  # of faults that a busy machine gave it
        self.condition_on_the_page(f"; then RESET_HAPTIC {ROBOT}")
        self.assertIn(f"then RESET_HAPTIC {ROBOT}", self.scratch.cellmirror("status").stdout)
        hand.say("motion hold 60s")
        # Longer than any fault that passes by itself takes, counted in the device's own samples.
        samples = self.device()["device"]["samples"]
        self.until(lambda d: d["device"]["samples"] > samples + 2000, "no samples come")
        self.assertEqual(self.device()["phase"], "faulted")
        self.assertEqual(self.device()["re_engagements"], before)
        self.assertTrue(g.eventually(lambda: self.scratch.send(f"RESET_HAPTIC {ROBOT}").returncode == 0))
        self.active(hand.child.pid)


if __name__ == "__main__":
    g.main()

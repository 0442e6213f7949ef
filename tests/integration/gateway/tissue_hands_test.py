"""A hand and a foot act on living tissue: the gateway, a simulated haptic device and simulated foot switches together."""

import math
import re
import time
import unittest

import gateway as g
import trainer as t

_SIMULATORS = (g.CELLS / "trainer" / "simulators.txt").read_text()


def motions(robot):
    """What the trainer's simulated hand does, step by step."""
    return re.search(rf"^{robot} .*--motion (\S+)", _SIMULATORS, re.M)[1].split(";")


# The left hand up to the lifted gallbladder.
GRIP_AND_LIFT = ";".join(motions("LAP_LEFT")[:7])
# The right hand up to the cystic duct, with open jaws.
_RIGHT = [step for step in motions("LAP_RIGHT") if not step.startswith("hold")]
TO_THE_DUCT = ";".join(_RIGHT[:_RIGHT.index("drag:gripper:-0.4014:speed=1.505")])
CLOSE = "motion drag:gripper:-0.4014:speed=2.0;hold:60s"
OPEN = "motion drag:gripper:0.4014:speed=2.0;hold:60s"


class HandsOnTissue(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = g.Scratch("trainer", startup=True)
        cls.keys = t.with_own_memories(cls.scratch, more=t.UNDISTURBED)
        cls.gateway = g.Gateway(cls.scratch)
        cls.hand = t.Hand(cls.scratch, cls.keys["LAP_LEFT"], "--axes", 7, "--motion", "hold:1s;" + GRIP_AND_LIFT + ";hold:60s")

    @classmethod
    def tearDownClass(cls):
        cls.hand.kill()
        cls.gateway.close()
        cls.scratch.remove()

    def tissue(self):
        return self.scratch.status()["tissue"]

    def count(self, kind):
        return self.tissue()["events"]["counts"][kind]

    def instrument(self, robot):
        return next(one for one in self.tissue()["instruments"] if one["robot"] == robot)

    def test_1_a_hand_grips_and_feels(self):
        self.assertTrue(g.eventually(lambda: self.count("grip") == 1), self.gateway.output())
        event = self.tissue()["events"]["last"][0]
        self.assertEqual((event["kind"], event["object"], event["robot"]), ("grip", "gallbladder.mpo", "LAP_LEFT"))

        def felt():
            force = t.haptic(self.scratch, "LAP_LEFT")["tissue_force_n"]
            return sum(x * x for x in force) ** 0.5

        # What is lifted pulls back, with less than the limit of the grip.
        self.assertTrue(g.eventually(lambda: felt() > 0.1), felt())
        self.assertLess(felt(), 3.0)
        device = t.haptic(self.scratch, "LAP_LEFT")
        self.assertEqual((device["phase"], device["fault"]), ("active", "none"))
        self.assertGreater(self.instrument("LAP_LEFT")["held"], 0)
        self.assertEqual(self.count("slip"), 0)

    def test_2_pedals_change_the_tool(self):
        self.leave(self.press("3", "clip applicator"))
        self.assertTrue(g.eventually(lambda: self.instrument("LAP_RIGHT")["kind"] == "gripper"))
        foot = self.press("1", "coagulation hook")
        self.assertTrue(g.eventually(lambda: self.instrument("LAP_RIGHT")["acting"]))
        self.leave(foot)
        self.assertTrue(g.eventually(lambda: not self.instrument("LAP_RIGHT")["acting"]))

    def press(self, switch, kind):
        """A foot on the switch, once the right instrument is what it makes of it."""
        foot = t.sim_footswitch(self.keys["switches"], "--hold", switch, "--for", 120)
        self.assertTrue(g.eventually(lambda: self.instrument("LAP_RIGHT")["kind"] == kind))
        return foot

    def tip(self):
        return t.haptic(self.scratch, "LAP_RIGHT")["device_position_m"]

    def rests(self):
        before = self.tip()
        time.sleep(0.3)
        return math.dist(self.tip(), before) < 5e-4

    def leave(self, foot):
        foot.child.terminate()
        foot.finish()

    def last(self, kind):
        return next(one for one in reversed(self.tissue()["events"]["last"]) if one["kind"] == kind)

    def test_3_hand_and_foot_clip_cut_and_coagulate(self):
        right = t.Hand(self.scratch, self.keys["LAP_RIGHT"], "--axes", 7, "--motion", TO_THE_DUCT + ";hold:60s")
        try:
            self.assertTrue(g.eventually(lambda: t.haptic(self.scratch, "LAP_RIGHT")["phase"] == "active"))
            start = self.tip()
            # The last way but one ends 45 mm from there, the last one 75 mm.
            self.assertTrue(g.eventually(lambda: math.dist(self.tip(), start) > 0.06 and self.rests()), self.tip())
            foot = self.press("3", "clip applicator")
            right.say(CLOSE)
            self.assertTrue(g.eventually(lambda: self.count("clip") == 1), self.instrument("LAP_RIGHT"))
            self.assertEqual((self.last("clip")["object"], self.last("clip")["robot"]), ("cystic_duct.mpo", "LAP_RIGHT"))
            right.say(OPEN)
            self.assertTrue(g.eventually(lambda: not self.instrument("LAP_RIGHT")["acting"]))
            self.leave(foot)
            foot = self.press("2", "scissors")
            self.snip(right)
            self.assertGreater(self.last("cut")["value"], 0)
            right.say(OPEN)
            self.assertTrue(g.eventually(lambda: not self.instrument("LAP_RIGHT")["acting"]))
            self.leave(foot)
            foot = self.press("1", "coagulation hook")  # current, whatever the jaws do
            self.assertTrue(g.eventually(lambda: self.count("coagulate") == 1), self.instrument("LAP_RIGHT"))
            self.leave(foot)
            self.assertTrue(g.eventually(lambda: self.count("coagulate") == 2), "its end has how much was burnt")
            self.assertGreater(self.last("coagulate")["value"], 0)
        finally:
            right.kill()

    def snip(self, hand):
        """Until something is cut: the duct moves, and blades that miss it are opened and closed again."""
        for _ in range(10):
            hand.say(CLOSE)
            if g.eventually(lambda: self.count("cut") > 0, timeout=5):
                return
            hand.say(OPEN)
            self.assertTrue(g.eventually(lambda: not self.instrument("LAP_RIGHT")["acting"]))
        self.fail(f"nothing was cut: {self.instrument('LAP_RIGHT')}")

    def test_4_open_jaws_let_go(self):
        self.hand.say("motion drag:gripper:0.4363:speed=2.0;hold:60s")
        self.assertTrue(g.eventually(lambda: self.count("release") == 1))
        self.assertEqual(self.instrument("LAP_LEFT")["held"], 0)

    def test_5_pedal_4_makes_everything_whole_again(self):
        before = self.tissue()["events"]["counts"]
        foot = t.sim_footswitch(self.keys["switches"], "--hold", "4", "--for", 120)

        def calm():
            return all(abs(one["energy_j"]) < 1e-4 for one in self.tissue()["objects"])

        self.assertTrue(g.eventually(calm), self.tissue()["objects"])
        self.leave(foot)
        self.assertEqual(before, self.tissue()["events"]["counts"])

    def test_6_the_simulation_goes_on(self):
        first = self.tissue()["step"]
        self.assertTrue(g.eventually(lambda: self.tissue()["step"] > first + 300), "it stands still")
        self.assertGreater(self.tissue()["pose_to_force_us"]["p50"], 0)


if __name__ == "__main__":
    g.main()

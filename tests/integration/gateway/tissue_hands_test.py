"""A hand and a foot act on living tissue: the gateway, a simulated haptic device and simulated foot switches together."""

import re
import time
import unittest

import gateway as g
import trainer as t

# The steps of the trainer's left hand up to the lifted gallbladder.
_MOTIONS = re.search(r"^LAP_LEFT .*--motion (\S+)", (g.CELLS / "trainer" / "simulators.txt").read_text(), re.M)[1]
GRIP_AND_LIFT = ";".join(_MOTIONS.split(";")[:7])


class HandsOnTissue(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = g.Scratch("trainer", startup=True)
        cls.keys = t.with_own_memories(cls.scratch)
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
        self.assertTrue(g.eventually(lambda: self.count("grip") == 1, 30), self.gateway.output())
        event = self.tissue()["events"]["last"][0]
        self.assertEqual((event["kind"], event["object"], event["robot"]), ("grip", "gallbladder.mpo", "LAP_LEFT"))

        def felt():
            force = t.haptic(self.scratch, "LAP_LEFT")["tissue_force_n"]
            return sum(x * x for x in force) ** 0.5

        # What is lifted pulls back, with less than the limit of the grip.
        self.assertTrue(g.eventually(lambda: felt() > 0.1, 10), felt())
        self.assertLess(felt(), 3.0)
        device = t.haptic(self.scratch, "LAP_LEFT")
        self.assertEqual((device["phase"], device["fault"]), ("active", "none"))
        self.assertGreater(self.instrument("LAP_LEFT")["held"], 0)
        self.assertEqual(self.count("slip"), 0)

    def test_2_pedals_change_the_tool(self):
        sim = t.sim_footswitch(self.keys["switches"], "--hold", "3", "--for", 3)
        self.assertTrue(g.eventually(lambda: self.instrument("LAP_RIGHT")["kind"] == "clip applicator", 10))
        sim.finish()
        self.assertTrue(g.eventually(lambda: self.instrument("LAP_RIGHT")["kind"] == "gripper", 10))
        sim = t.sim_footswitch(self.keys["switches"], "--hold", "1", "--for", 3)
        self.assertTrue(g.eventually(lambda: self.instrument("LAP_RIGHT")["kind"] == "coagulation hook" and
                                     self.instrument("LAP_RIGHT")["acting"], 10))
        sim.finish()
        self.assertTrue(g.eventually(lambda: not self.instrument("LAP_RIGHT")["acting"], 10))

    def test_3_open_jaws_let_go(self):
        self.hand.say("motion drag:gripper:0.4363:speed=2.0;hold:60s")
        self.assertTrue(g.eventually(lambda: self.count("release") == 1, 10))
        self.assertEqual(self.instrument("LAP_LEFT")["held"], 0)

    def test_4_pedal_4_makes_everything_whole_again(self):
        before = self.tissue()["events"]["counts"]
        t.sim_footswitch(self.keys["switches"], "--press", 4, "--times", 1, "--for", 0.2).finish()

        def calm():
            return all(abs(one["energy_j"]) < 1e-4 for one in self.tissue()["objects"])

        self.assertTrue(g.eventually(calm, 10), self.tissue()["objects"])
        self.assertEqual(before, self.tissue()["events"]["counts"])

    def test_5_the_simulation_goes_on(self):
        first = self.tissue()["step"]
        time.sleep(1)
        tissue = self.tissue()
        self.assertGreater(tissue["step"] - first, 300)  # 1,000, if nothing else runs
        self.assertGreater(tissue["pose_to_force_us"]["p50"], 0)


if __name__ == "__main__":
    g.main()

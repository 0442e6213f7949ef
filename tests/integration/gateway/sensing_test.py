"""Collisions, distances and ultrasonic ranges in the running gateway: what moves, is seen; what is switched off, is not."""

import math
import pathlib
import time
import unittest

import gateway as g

CELL = pathlib.Path(__file__).resolve().parent / "slider_cell"
HAND = "Slider.X.HAND"
CONTACT = 1.3  # m: where the hand meets the wall


class Sensing(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = g.Scratch(CELL)
        cls.gateway = g.Gateway(cls.scratch)

    @classmethod
    def tearDownClass(cls):
        status = cls.gateway.stop()
        cls.gateway.close()
        cls.scratch.remove()
        assert status == 0, f"the gateway ended with {status}"

    def setUp(self):
        for command in ("ROBACT SLIDER", "rob_positioning jump", "SET_COLLPAR active 1", "SET_COLLPAR warning 50",
                        "POS_ROB SLIDER JOINT_ABS 0"):
            self.done(command)
        self.settled()

    def done(self, command):
        done = self.scratch.send(command)
        self.assertEqual(done.returncode, 0, f"{command}: {done.stderr}")

    def refused(self, command, *words):
        done = self.scratch.send(command)
        self.assertEqual(done.returncode, 1, f"{command}: {done.stdout}")
        for word in words:
            self.assertIn(word, done.stderr)

    def collisions(self):
        return self.scratch.status()["collisions"]

    def settled(self):
        """What is found for a posture that was taken after this call, and after commands have reached the workers."""
        asked = time.monotonic() + 0.05

        def new():
            found = self.collisions()
            fresh = found["age_s"] is not None and found["age_s"] < time.monotonic() - asked
            return found if fresh and found["note"] == "" else None

        found = g.eventually(new)
        self.assertIsNotNone(found, self.collisions())
        return found

    def move(self, x):
        """Puts it there at once, unless `rob_positioning move` was sent before."""
        self.done(f"POS_ROB SLIDER JOINT_ABS {x * 1e3}")
        return self.settled()

    def new_events(self, since):
        return [(event["change"], {event["a"], event["b"]}) for event in self.collisions()["events"]
                if event["sequence"] > since]

    def last_event(self):
        return max((event["sequence"] for event in self.collisions()["events"]), default=0)

    def range(self):
        return self.scratch.status()["ranges"]["sensors"][0]

    # --- collisions and distances

    def test_smallest_distance_with_its_points(self):
        nearest = self.move(1.0)["nearest"]
        self.assertEqual({nearest["a"], nearest["b"]}, {HAND, "Wall"})
        self.assertAlmostEqual(nearest["distance_m"], CONTACT - 1.0, delta=1e-6)
        hand = nearest["point_a_m" if nearest["a"] == HAND else "point_b_m"]
        wall = nearest["point_b_m" if nearest["a"] == HAND else "point_a_m"]
        self.assertAlmostEqual(hand[0], 1.1, delta=1e-6)
        self.assertAlmostEqual(wall[0], 1.4, delta=1e-6)
        self.assertFalse(nearest["within_warning"])

    def test_robot_that_moves_into_a_wall_is_seen_with_depth_events_and_age(self):
        self.done("rob_positioning move")
        before = self.last_event()
        found = self.move(1.31)
        self.assertEqual(len(found["touching"]), 1, found)
        touch = found["touching"][0]
        self.assertEqual({touch["a"], touch["b"]}, {HAND, "Wall"})
        self.assertAlmostEqual(touch["depth_m"], 0.01, delta=1e-5)
        self.assertAlmostEqual(abs(touch["normal"][0]), 1.0, delta=1e-6)
        self.assertTrue(1.39 < touch["point_m"][0] < 1.42, touch)
        self.assertFalse(touch["doubtful"])
        self.assertLess(found["age_s"], 10.0)
        self.assertEqual({touch["a_short"], touch["b_short"]}, {"Slider.HAND", "Wall"})
        self.assertRegex(self.gateway.output(), r"Slider\.HAND touches Wall|Wall touches Slider\.HAND")
        self.move(0.5)
        pair = {HAND, "Wall"}
        self.assertEqual(self.new_events(before), [("entered_warning", pair), ("touched", pair), ("parted", pair),
                                                   ("left_warning", pair)])

    def test_warning_distance(self):
        before = self.last_event()
        self.done("SET_COLLPAR warning 200")
        found = self.move(1.2)
        self.assertTrue(found["nearest"]["within_warning"])
        self.assertEqual(found["warning_distance_m"], 0.2)
        self.assertEqual(found["touching"], [])
        self.done("SET_COLLPAR warning 50")
        self.assertTrue(g.eventually(lambda: not self.collisions()["nearest"]["within_warning"]))
        pair = {HAND, "Wall"}
        self.assertEqual(self.new_events(before), [("entered_warning", pair), ("left_warning", pair)])

    def test_deactivated_part_is_not_tested(self):
        self.assertEqual(len(self.move(1.31)["touching"]), 1)
        tested = self.collisions()["pairs"]["tested"]
        self.done("DEACTIVATE Wall")
        self.assertTrue(g.eventually(lambda: self.collisions()["touching"] == []))
        self.assertLess(self.settled()["pairs"]["tested"], tested)
        self.done("ACTIVATE Wall")
        self.assertTrue(g.eventually(lambda: len(self.collisions()["touching"]) == 1))
        self.assertEqual(self.settled()["pairs"]["tested"], tested)

    def test_pairs_of_a_tool_change_when_it_is_gripped(self):
        self.move(1.0)
        self.assertEqual({frozenset((near["a"], near["b"])) for near in self.settled()["near"]} - {frozenset((HAND, "Wall"))},
                         set())
        self.done(f"FRAME_TO_WFRM Tool TO {HAND} Grip_WFRM")
        try:
            found = self.settled()
            self.assertEqual(found["touching"], [], "what is gripped does not collide with the hand")
            nearest = found["nearest"]
            self.assertEqual({nearest["a"], nearest["b"]}, {"Tool", "Wall"})
            self.assertAlmostEqual(nearest["distance_m"], CONTACT - 1.0 - 0.1, delta=1e-6)
            touching = self.move(1.21)["touching"]
            self.assertEqual([{touch["a"], touch["b"]} for touch in touching], [{"Tool", "Wall"}])
        finally:
            self.move(0.0)
            self.done("CONNECT Tool TO Wall")
            self.done("SET_FRAME Tool PLACEMENT 0 0 0 0 5000 0")

    def test_rules_for_pairs(self):
        self.move(1.31)
        self.done(f"SET_COLLPAR pair {HAND} Wall ignore")
        self.assertTrue(g.eventually(lambda: self.collisions()["touching"] == []))
        self.assertEqual(self.settled()["pairs"]["left_out"]["rule"], 1)
        self.done("SET_COLLPAR pair Wall HAND derive")
        self.assertTrue(g.eventually(lambda: len(self.collisions()["touching"]) == 1))
        self.refused("SET_COLLPAR pair HANT Wall ignore", "HAND")

    def test_switched_off_nothing_is_computed_and_the_age_tells(self):
        self.move(0.2)
        self.done("SET_COLLPAR active 0")
        self.assertTrue(g.eventually(lambda: (lambda found: not found["active"] and found["age_s"] > 0.3)(self.collisions())))
        found = self.collisions()
        self.assertIn("SET_COLLPAR active 1", found["note"])
        checks = found["counters"]["checks"]
        self.done("POS_ROB SLIDER JOINT_ABS 1310")
        self.assertEqual(self.collisions()["counters"]["checks"], checks)
        self.done("SET_COLLPAR active 1")
        self.assertTrue(g.eventually(lambda: len(self.collisions()["touching"]) == 1))

    def test_time_to_contact_while_it_moves(self):
        self.done("rob_positioning move")
        self.done("MOVE_ROB SLIDER PTP JOINT_ABS 1250")
        seen = []

        def approaching():
            nearest = self.collisions()["nearest"]
            if nearest["closing_speed_m_s"] is not None:
                seen.append(nearest)
            return len(seen) >= 3

        g.eventually(approaching, 1.2, every=0.01)
        if not seen:
            self.skipTest("skipped: the machine was too busy to look while the robot moved")
        for nearest in seen:
            self.assertLessEqual(nearest["closing_speed_m_s"], 1.001)
            self.assertGreater(nearest["closing_speed_m_s"], 0.0)
            self.assertAlmostEqual(nearest["time_to_contact_s"], nearest["distance_m"] / nearest["closing_speed_m_s"],
                                   delta=1e-6)

    # --- ultrasonic sensors

    def test_sensor_reads_only_while_it_is_active(self):
        self.done("SET_USSPAR active USS_FRONT 0")
        self.assertTrue(g.eventually(lambda: not self.range()["active"]))
        self.assertIsNone(self.range()["distance_m"])
        self.done("SET_USSPAR active USS_FRONT 1")
        reading = g.eventually(lambda: self.range() if self.range()["distance_m"] is not None else None)
        self.assertEqual(reading["id"], "USS_FRONT")
        self.assertEqual(reading["path"], HAND + ".USS_FRONT")
        self.assertAlmostEqual(reading["distance_m"], CONTACT, delta=1e-6)
        self.assertEqual(reading["object"], "Wall")
        self.assertAlmostEqual(reading["point_m"][0], 1.4, delta=1e-6)

    def test_sensor_follows_the_robot(self):
        self.done("SET_USSPAR active USS_FRONT 1")
        self.done("SET_USSPAR range USS_FRONT 2000")
        for x in (0.25, 0.75, 1.28):
            self.done(f"POS_ROB SLIDER JOINT_ABS {x * 1e3}")
            self.assertTrue(g.eventually(lambda: abs((self.range()["distance_m"] or 0) - (CONTACT - x)) < 1e-6),
                            self.range())
        self.assertTrue(self.range()["in_blind_zone"])

    def test_sensor_while_the_robot_moves(self):
        self.done("SET_USSPAR active USS_FRONT 1")
        self.done("SET_USSPAR range USS_FRONT 2000")
        self.done("rob_positioning move")
        self.done("MOVE_ROB SLIDER PTP JOINT_ABS 1200")
        off, end = [], time.monotonic() + 2
        while time.monotonic() < end:
            status = self.scratch.status()
            x = status["robots"][0]["joints"][0]["position"]
            sensor = status["ranges"]["sensors"][0]
            if sensor["distance_m"] is None:
                continue
            # The two are of different ticks: at 1 m/s they differ by what the reading is older.
            off.append(abs(sensor["distance_m"] - (CONTACT - x)) - 1.0 * (sensor["age_s"] + 0.02))
        # Not each: between the two the machine may have stood still.
        self.assertLess(sorted(off)[9 * len(off) // 10], 0.001)
        self.assertTrue(g.eventually(lambda: abs(self.range()["distance_m"] - 0.1) < 1e-6), self.range())

    def test_range_limits_what_is_seen(self):
        self.done("SET_USSPAR active USS_FRONT 1")
        self.done("SET_USSPAR range USS_FRONT 1000")
        self.assertTrue(g.eventually(lambda: self.range()["range_m"] == 1.0 and self.range()["distance_m"] is None))
        self.assertIsNone(self.range()["object"])
        self.done("SET_USSPAR range Slider.USS_FRONT 1500.0")
        self.assertTrue(g.eventually(lambda: self.range()["distance_m"] is not None))

    def test_send_mode(self):
        self.done("SET_USSPAR sendmode 1")
        self.assertTrue(g.eventually(lambda: self.scratch.status()["ranges"]["sendmode"] == 1))
        self.done("SET_USSPAR sendmode 0")
        self.assertTrue(g.eventually(lambda: self.scratch.status()["ranges"]["sendmode"] == 0))

    def test_unknown_sensors_and_bad_ranges_are_refused(self):
        self.refused("SET_USSPAR active USS_FRONTT 1", "no sensor USS_FRONTT", "USS_FRONT")
        self.refused("SET_USSPAR range USS_FRONT 0", "more than 0")
        self.refused("SET_USSPAR range USS_FRONT -5", "more than 0")
        self.refused("SET_USSPAR sendmode 2", "0, 1")


class TransferCell(unittest.TestCase):
    def test_whole_cell_is_tested_at_the_rate_of_the_loop(self):
        scratch = g.Scratch()
        gateway = g.Gateway(scratch)
        try:
            found = g.eventually(lambda: (lambda c: c if c["counters"]["checks"] > 200 else None)(
                scratch.status()["collisions"]))
            self.assertIsNotNone(found)
            self.assertGreater(found["bodies"], 30)
            self.assertGreater(found["pairs"]["tested"], 300)
            self.assertGreater(found["pairs"]["left_out"]["rigid"], 0)
            self.assertGreater(found["pairs"]["left_out"]["neighbours"], 10)
            self.assertGreater(found["triangles"], 1000)
            for pair in found["near"] + found["touching"]:
                self.assertIn(".", pair["a"])
                self.assertFalse(math.isnan(pair.get("distance_m", 0)))
            # Far beyond the goal of 4 ms: this machine may be busy with anything.
            self.assertLess(found["age_ms"]["p50"], 500)
            loop = scratch.status()["loop"]
            self.assertEqual(loop["allocations"] or 0, 0)
            self.assertEqual(scratch.send("SET_USSPAR active USS_1B 1").returncode, 0)
            sensors = lambda: {sensor["id"]: sensor for sensor in scratch.status()["ranges"]["sensors"]}
            self.assertTrue(g.eventually(lambda: sensors()["USS_1B"]["age_s"] is not None))
            self.assertIsNone(sensors()["USS_5"]["age_s"])
        finally:
            gateway.close()
            scratch.remove()


if __name__ == "__main__":
    g.main()

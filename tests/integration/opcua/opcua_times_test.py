"""How good and how old what a client is told is: robots that move, streams that stop, gateways that go and come back."""

import time
import unittest

import bridge as b
import gateway as g
import standin as s


class Times(unittest.TestCase):
    def setUp(self):
        self.scratch = g.Scratch("transfer_cell")
        self.addCleanup(self.scratch.remove)

    def kept(self, process):
        self.addCleanup(process.close)
        return process

    def position(self, robot, joint):
        return f"ns=1;s={self.scratch.instance}/{robot}/Axes/{joint}.ParameterSet.ActualPosition"

    def until(self, watch, node, wanted):
        def found():
            newest = watch.newest(node)
            return newest if newest and wanted(newest) else None

        newest = g.eventually(found)
        self.assertTrue(newest, watch.newest(node))
        return newest

    def test_a_gateway_that_is_killed_and_comes_back(self):
        gateway = self.kept(g.Gateway(self.scratch))
        bridge = self.kept(b.Bridge(self.scratch))
        bridge.wait_for("answers: 8 robots")
        node = self.position("PUMA_762", "J_1")
        answers = f"ns=1;s={self.scratch.instance}.Cell.GatewayAnswers"
        watch = self.kept(bridge.watch(node, answers))
        self.until(watch, node, lambda one: one["status"] == "Good")
        before = set(bridge.nodes())
        gateway.kill()
        gone = self.until(watch, node, lambda one: one["status"] == "BadNoCommunication")
        self.assertIsNone(gone["value"])
        self.until(watch, answers, lambda one: one["value"] is False)
        self.assertEqual(set(bridge.nodes()), before)
        self.kept(g.Gateway(self.scratch))
        self.until(watch, node, lambda one: one["status"] == "Good")
        self.until(watch, answers, lambda one: one["value"] is True)
        self.assertEqual(set(bridge.nodes()), before)

    def test_a_move_is_seen_and_its_times_go_on(self):
        self.kept(g.Gateway(self.scratch))
        bridge = self.kept(b.Bridge(self.scratch))
        bridge.wait_for("answers")
        watch = self.kept(bridge.watch(self.position("PUMA_762", "J_1")))
        self.until(watch, self.position("PUMA_762", "J_1"), lambda one: one["status"] == "Good")
        done = self.scratch.send("POS_ROB PUMA_762 JOINT_ABS 40")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.until(watch, self.position("PUMA_762", "J_1"), lambda one: abs(one["value"] - 40) < 1e-6)
        good = [one for one in watch.notifications() if one["status"] == "Good"]
        self.assertGreater(len({one["value"] for one in good}), 3)
        self.assertEqual([one["source"] for one in good], sorted(one["source"] for one in good))
        ages = sorted(one["at"] - one["source"] for one in good)
        self.assertLess(ages[len(ages) // 2], 1000)

    def test_ids_stay_over_a_restart_of_the_bridge(self):
        self.kept(g.Gateway(self.scratch))
        seen = []
        for _ in range(2):
            bridge = b.Bridge(self.scratch)
            try:
                bridge.wait_for("answers")
                seen.append({name: node["name"] for name, node in bridge.nodes().items()})
                self.assertEqual(bridge.stop(), 0, bridge.output())
            finally:
                bridge.close()
        self.assertEqual(seen[0], seen[1])

    def test_a_stream_that_stops_is_told_with_its_last_value_and_time(self):
        now = {"joint": {"state": "fresh", "age_s": 0.001}}

        def answer():
            return s.status([s.robot("R") | {"joints": [s.joint("J", **now["joint"])]}])

        gateway = s.Standin(self.scratch.runtime, self.scratch.instance, answer)
        self.addCleanup(gateway.close)
        bridge = self.kept(b.Bridge(self.scratch))
        bridge.wait_for("answers: 1 robots")
        node = self.position("R", "J")
        watch = self.kept(bridge.watch(node))
        self.until(watch, node, lambda one: one["status"] == "Good")
        now["joint"] = {"state": "stale", "age_s": 4000.0}
        stale = self.until(watch, node, lambda one: one["status"] == "UncertainLastUsableValue")
        self.assertAlmostEqual(stale["value"], 28.6478897565, places=6)
        self.assertGreaterEqual(time.time() - stale["source"] / 1000, 4000 - 60)
        now["joint"] = {"state": "lost", "age_s": 4001.0}
        self.until(watch, node, lambda one: one["status"] == "UncertainNoCommunicationLastUsableValue")
        now["joint"] = {"state": "none", "age_s": None}
        self.until(watch, node, lambda one: one["status"] == "BadWaitingForInitialData" and one["value"] is None)

    def test_a_gateway_that_stands_still_is_late_first(self):
        still = {"now": False}

        def answer():
            g.eventually(lambda: not still["now"], every=0.02)
            return s.status([s.robot("R")])

        gateway = s.Standin(self.scratch.runtime, self.scratch.instance, answer)
        self.addCleanup(gateway.close)
        bridge = self.kept(b.Bridge(self.scratch))
        bridge.wait_for("answers")
        node = self.position("R", "J_0")
        watch = self.kept(bridge.watch(node))
        good = self.until(watch, node, lambda one: one["status"] == "Good")
        still["now"] = True
        self.addCleanup(still.update, now=False)
        late = self.until(watch, node, lambda one: one["status"] == "UncertainNoCommunicationLastUsableValue")
        self.assertEqual(late["value"], good["value"])
        self.until(watch, node, lambda one: one["status"] == "BadNoCommunication")
        still["now"] = False
        self.until(watch, node, lambda one: one["status"] == "Good")

    def test_two_gateways_are_two_systems(self):
        other = "u" + self.scratch.instance[1:]
        for name in (self.scratch.instance, other):
            gateway = s.Standin(self.scratch.runtime, name, lambda name=name: s.status([s.robot(f"R_{name}")]))
            self.addCleanup(gateway.close)
        bridge = self.kept(b.Bridge(self.scratch, instances=[self.scratch.instance, other]))
        for name in (self.scratch.instance, other):
            bridge.wait_for(f"{name} answers: 1 robots")
        nodes = bridge.nodes()
        for name in (self.scratch.instance, other):
            self.assertIn(f"ns=1;s={name}/R_{name}", nodes)


if __name__ == "__main__":
    b.main()

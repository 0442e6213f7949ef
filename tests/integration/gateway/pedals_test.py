"""Feet press switches, scripts run: once a change, in order, bounces left out."""

import time
import unittest

import gateway as g
import trainer as t


class FootSwitches(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = g.Scratch("phantom_trainer")
        cls.keys = t.with_own_memories(cls.scratch)
        scripts = cls.scratch.home / "scripts"
        for number in range(1, 8):
            (scripts / f"BININP{number}_ON.spt").write_text(f"hot_message {number} on\n")
            (scripts / f"BININP{number}_OFF.spt").write_text(f"hot_message {number} off\n")
        cls.gateway = g.Gateway(cls.scratch)

    @classmethod
    def tearDownClass(cls):
        cls.gateway.close()
        cls.scratch.remove()

    def switches(self):
        return self.scratch.status()["foot_switches"]

    def play(self, *arguments):
        before = self.switches()
        summary = t.sim_footswitch(self.keys["switches"], *arguments).finish()
        after = {}

        def all_done():
            earlier = after.get("edges")
            after.update(self.switches())
            time.sleep(0.2)
            return after["edges"] == earlier and after["scripts"]["waiting"] == 0 and not after["last_script"]["running"]

        self.assertTrue(g.eventually(all_done), after)
        return summary, {name: after[name] - before[name] for name in ("edges", "bounces", "edges_dropped")}, after, before

    def play_on_time(self, changes, *arguments):
        """What a playing gave in which each change was an edge. Memory has no queue: where the machine is late a change that was taken
        back meanwhile is none, and a bounce that takes too long is two."""
        for _ in range(8):
            played = self.play(*arguments)
            self.assertEqual(played[0]["changes"], changes)
            if played[1]["edges"] == changes:
                return played
        return self.fail(f"{changes} changes were never so many edges: {played}")

    def test_every_press_is_two_edges(self):
        _, _, after, _ = self.play_on_time(10, "--press", 1, "--times", 5, "--for", 0.1)
        self.assertEqual(after["inputs_on"], [])
        self.assertEqual(after["last_script"]["file"].rsplit("/")[-1], "BININP1_OFF.spt")

    def test_bounces_are_left_out(self):
        _, edges, _, _ = self.play_on_time(40, "--press", "2,3", "--times", 10, "--for", 0.05, "--bounce", "4,4ms")
        self.assertGreater(edges["bounces"], 0)

    def test_a_held_switch_shows(self):
        sim = t.sim_footswitch(self.keys["switches"], "--hold", "5", "--for", 120)
        self.assertTrue(g.eventually(lambda: self.switches()["inputs_on"] == [5]), self.switches())
        sim.child.terminate()
        sim.finish()
        self.assertTrue(g.eventually(lambda: self.switches()["inputs_on"] == []))

    def test_under_load_each_change_runs_one_script(self):
        summary, edges, after, before = self.play("--random", 40, "--inputs", 7, "--for", 5, "--seed", 11, "--bounce", "2,2ms")
        self.assertGreater(summary["changes"], 100)
        # A busy machine stretches bounces, and looks too late.
        self.assertIn(edges["edges"], range(summary["changes"] // 4, summary["changes"] * 5 // 4))
        self.assertEqual(edges["edges"] % 2, 0)
        self.assertEqual(edges["edges_dropped"], 0)
        self.assertEqual(after["scripts"]["started"] - before["scripts"]["started"], edges["edges"])
        self.assertEqual(after["scripts"]["with_errors"], before["scripts"]["with_errors"])

    def test_a_switch_without_a_script_is_told_once(self):
        for name in ("BININP8_ON.spt", "BININP8_OFF.spt"):
            (self.scratch.home / "scripts" / name).unlink(missing_ok=True)
        _, _, after, _ = self.play_on_time(6, "--press", 8, "--times", 3, "--for", 0.05)
        self.assertEqual(sum("BININP8" in file for file in after["missing_files"]), 2)


if __name__ == "__main__":
    g.main()

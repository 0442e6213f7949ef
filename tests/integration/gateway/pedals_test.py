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
        self.assertTrue(g.eventually(lambda: self.switches()["edges"] - before["edges"] >= summary["changes"], 5), self.switches())
        time.sleep(0.2)
        after = self.switches()
        return summary, {name: after[name] - before[name] for name in ("edges", "bounces", "edges_dropped")}, after, before

    def test_every_press_is_two_edges(self):
        summary, edges, after, _ = self.play("--press", 1, "--times", 5, "--for", 0.1)
        self.assertEqual(summary["changes"], 10)
        self.assertEqual(edges["edges"], 10)
        self.assertEqual(after["inputs_on"], [])
        self.assertEqual(after["last_script"]["file"].rsplit("/")[-1], "BININP1_OFF.spt")

    def test_bounces_are_left_out(self):
        summary, edges, _, _ = self.play("--press", "2,3", "--times", 10, "--for", 0.05, "--bounce", "4,4ms")
        self.assertEqual(summary["changes"], 40)
        self.assertEqual(edges["edges"], 40)
        self.assertGreater(edges["bounces"], 0)

    def test_a_held_switch_shows(self):
        sim = t.sim_footswitch(self.keys["switches"], "--hold", "5", "--for", 2)
        self.assertTrue(g.eventually(lambda: self.switches()["inputs_on"] == [5], 2), self.switches())
        sim.finish()
        self.assertTrue(g.eventually(lambda: self.switches()["inputs_on"] == [], 2))

    def test_under_load_each_change_runs_one_script(self):
        summary, edges, after, before = self.play("--random", 40, "--inputs", 7, "--for", 5, "--seed", 11, "--bounce", "2,2ms")
        self.assertGreater(summary["changes"], 300)
        # A bounce of 2 ms that a busy machine stretches beyond the debounce time is two changes.
        stretched = edges["edges"] - summary["changes"]
        self.assertEqual(stretched % 2, 0)
        self.assertIn(stretched, range(summary["changes"] // 50))
        self.assertEqual(edges["edges_dropped"], 0)
        g.eventually(lambda: self.switches()["scripts"]["waiting"] == 0, 5)
        after = self.switches()
        self.assertEqual(after["scripts"]["started"] - before["scripts"]["started"], edges["edges"])
        self.assertEqual(after["scripts"]["with_errors"], before["scripts"]["with_errors"])

    def test_a_switch_without_a_script_is_told_once(self):
        for name in ("BININP8_ON.spt", "BININP8_OFF.spt"):
            (self.scratch.home / "scripts" / name).unlink(missing_ok=True)
        _, edges, after, _ = self.play("--press", 8, "--times", 3, "--for", 0.05)
        self.assertEqual(edges["edges"], 6)
        self.assertEqual(sum("BININP8" in file for file in after["missing_files"]), 2)


if __name__ == "__main__":
    g.main()

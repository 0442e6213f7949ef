"""The trainer cell off line: its script does the steps of the task, and what is left out shows."""

import json
import pathlib
import subprocess
import unittest

import gateway as g

SCRIPT = g.SOURCE / "config/cells/trainer/scripts/cholecystectomy.spt"


class Cholecystectomy(unittest.TestCase):
    def setUp(self):
        self.scratch = g.Scratch("trainer")
        self.addCleanup(self.scratch.remove)

    def simulate(self, change=lambda text: text):
        """What became of the tissue, with the script's text changed."""
        path = pathlib.Path(self.scratch.home) / "scripts" / "task.spt"
        path.write_text(change(SCRIPT.read_text()))
        done = subprocess.run([str(g.BIN / "cellmirror"), "simulate", "--cell", str(self.scratch.cell_file), "--script", str(path),
                               "--no-collisions", "--json"], capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)["tissue"]

    def events(self, tissue, kind):
        return [event for event in tissue["events"] if event["event"] == kind]

    def test_the_task_is_done_without_blood(self):
        tissue = self.simulate()
        grips = self.events(tissue, "grip")
        self.assertEqual([event["object"] for event in grips], ["gallbladder.mpo"])
        clips = self.events(tissue, "clip")
        self.assertEqual([event["part"] for event in clips], ["cystic_duct"] * 2 + ["cystic_artery"] * 2)
        cuts = [event for event in self.events(tissue, "cut") if "part" in event]
        self.assertEqual({event["part"] for event in cuts}, {"cystic_duct", "cystic_artery"})
        self.assertGreater(cuts[0]["time_s"], clips[-1]["time_s"])
        parts = {found["name"]: found["parts"] for found in tissue["objects"]}
        self.assertGreaterEqual(parts["cystic_duct.mpo"], 2)
        self.assertGreaterEqual(parts["cystic_artery.mpo"], 2)
        self.assertEqual(parts["gallbladder.mpo"], 1)
        torn = {event.get("part") for event in self.events(tissue, "tear")}
        self.assertEqual(torn, {"bed_fundus", "bed_body", "bed_infundibulum"})
        burnt = {found["name"]: found["coagulated_share"] for found in tissue["objects"]}
        self.assertGreater(burnt["liver.mpo"], 0.0)
        self.assertEqual(self.events(tissue, "bleed"), [])
        self.assertEqual(tissue["blood_loss_ml"], 0.0)

    def test_without_clips_it_bleeds(self):
        tissue = self.simulate(lambda text: text.replace("EXEC_SCRIPT tool_clips.spt;\n", ""))
        self.assertEqual(self.events(tissue, "clip"), [])
        bleeds = self.events(tissue, "bleed")
        self.assertEqual(bleeds[0]["part"], "cystic_artery")
        # An artery of 1.2 mm gives some 20 ml a minute; the rest of the script takes more than three seconds.
        self.assertGreater(tissue["blood_loss_ml"], 0.5)

    def test_two_runs_are_the_same_to_the_bit(self):
        short = lambda text: text[: text.index("# Two clips")].rstrip().rstrip(";") + "\n"
        self.assertEqual(self.simulate(short)["digest"], self.simulate(short)["digest"])


if __name__ == "__main__":
    unittest.main()

"""SCRIPT's commands for deformable objects, off line: what each does to two soft cubes of 100 mm that stand on a fixed base."""

import json
import unittest

import small_cell as s

CELL = """format = 1
name = "soft"
[[node]]
name = "Robot"
abstract = "slider.mpc"
[[deformable]]
object = "cube.mpo"
xyz_m = [1.5, 0.0, 0.0]
[[deformable]]
object = "block.mpo"
xyz_m = [1.5, 0.2, 0.1]
"""
BODY = """format = 1
[surface]
mesh = "cube.obj"
[volume]
element_size_m = 0.03
[[fixed]]
low_m = [0.0, 0.0, 0.0]
high_m = [0.1, 0.1, 0.01]
"""
VESSEL_AND_POOL = """[[vessel]]
name = "artery"
kind = "artery"
points_m = [[0.05, 0.05, 0.01], [0.05, 0.05, 0.09]]
[pool]
size_m = [0.1, 0.1]
"""
BED = """format = 1
[[connection]]
name = "bed"
object_a = "cube.mpo"
object_b = "block.mpo"
point_a_m = [0.1, 0.1, 0.1]
point_b_m = [0.1, 0.0, 0.1]
stiffness_n_m = 200
"""
CORNERS = [((i & 1) * 0.1, (i >> 1 & 1) * 0.1, (i >> 2 & 1) * 0.1) for i in range(8)]
FACES = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)]
# Some 0.4 s pass with each.
FORTH = "POS_ROB S1 JOINT_ABS 200;\n"
BACK = "POS_ROB S1 JOINT_ABS 0;\n"
FALL = "eladyn_geo_def ALL GRAVITY on;\n"
# J: what rounding of 32-bit numbers leaves of the stiffness times the volume, 5 J.
REST = 1e-6


class Commands(unittest.TestCase):
    def setUp(self):
        self.home = s.Home(CELL)
        self.addCleanup(self.home.close)
        folder = self.home.root / "envlib"
        (folder / "cube.obj").write_text("".join(f"v {x} {y} {z}\n" for x, y, z in CORNERS)
                                         + "".join(f"f {a} {b} {c} {d}\n" for a, b, c, d in FACES))
        (folder / "cube.mpo").write_text(BODY + VESSEL_AND_POOL)
        (folder / "block.mpo").write_text(BODY)
        (folder / "clip.mpo").write_text('format = 1\n[surface]\nmesh = "cube.obj"\nscale = [0.03, 0.03, 0.1]\n')
        (folder / "bed.hyper").write_text(BED)

    def simulate(self, text):
        path = self.home.root / "test.spt"
        path.write_text(text)
        done = s.program("simulate", "--cell", self.home.cell, "--script", path, "--json")
        found = json.loads(done.stdout)
        self.assertEqual(found["end"], "finished", done.stderr)
        return found

    def energies(self, text):
        """Elastic energy of the cube and of the block at the end [J]; nothing is refused."""
        found = self.simulate(text)
        self.assertEqual(found["refused"], [])
        return [one["energy_j"] for one in found["tissue"]["objects"]]

    def test_every_form_is_done(self):
        text = ("ROBACT S1;\neladyn_calc off;\neladyn_hyper_name bed;\neladyn_model_reset;\neladyn_geo_def ALL 0xd3f;\n"
                "eladyn_geo_def cube WET off;\neladyn_plaus_param STRAIN 33 1.5;\nEFFECTS PULSE ON;\nEFFECTS BLEEDING ON;\n"
                "EFFECTS POOL_RIPPLES ON;\nEFFECTS RESET_POOL;\nEFFECTS CLEAN_ENDOSCOPIC_LENSE;\nEFFECTS SUCTION ON;\n"
                "EFFECTS IRRIGATION ON;\nrob_ela_interact 1 1 100 0 1;\nela_clip_def clip 0 90 0 1 2 3;\n"
                "eladyn_geo_def arm 0 5 4 18 0;\neladyn_show_def 1;\neladyn_calc on;\n" + FORTH)
        found = self.simulate(text)
        self.assertEqual((found["refused"], found["script_commands"]), ([], 20))

    def test_what_is_wrong_is_refused_with_its_place(self):
        found = self.simulate("ROBACT S1;\neladyn_geo_def cubes.mpo CUT off;\neladyn_hyper_name bet;\n"
                              "eladyn_geo_def Wall 0 5 4 18 0;\nrob_ela_interact 3 1 0 0 0")
        said = [json.dumps(one) for one in found["refused"]]
        self.assertEqual(len(said), 4, said)
        for text, words in zip(said, ("did you mean cube.mpo?", "did you mean bed", "Wall is no geometry of S1",
                                      "S1 has 2 joints")):
            self.assertIn(words, text)

    def test_an_attribute_of_one_object_and_of_all(self):
        cube, block = self.energies("eladyn_geo_def cube.mpo GRAVITY on;\n" + FORTH)
        self.assertGreater(cube, 1e-3)
        self.assertLess(block, REST)
        cube, block = self.energies(FALL + "eladyn_geo_def cube CALCULATE off;\n" + FORTH)
        self.assertLess(cube, REST)
        self.assertGreater(block, 1e-3)
        self.assertGreater(min(self.energies(FALL + FORTH)), 1e-3)
        self.assertLess(max(self.energies(FALL + "eladyn_geo_def ALL 0xd3f;\n" + FORTH)), REST)

    def test_eladyn_calc(self):
        self.assertLess(max(self.energies("eladyn_calc off;\n" + FALL + FORTH)), REST)
        self.assertGreater(min(self.energies("eladyn_calc off;\n" + FALL + FORTH + "eladyn_calc on;\n" + BACK)), 1e-3)

    def test_a_reset_restores_the_shape_and_keeps_what_was_set(self):
        fallen = FALL + FORTH
        self.assertLess(max(self.energies(fallen + "eladyn_calc off;\neladyn_model_reset;\n" + BACK)), REST)
        self.assertGreater(min(self.energies(fallen + "eladyn_model_reset;\n" + BACK)), 1e-3)

    def test_connections_of_a_hyper_file(self):
        alone = self.energies("eladyn_geo_def cube GRAVITY on;\n" + FORTH)[1]
        self.assertLess(alone, REST)
        pulled = self.energies("eladyn_hyper_name bed;\neladyn_geo_def cube GRAVITY on;\n" + FORTH)[1]
        self.assertGreater(pulled, 20 * REST)

    def test_a_limit_that_freezes_and_reports(self):
        limit = "eladyn_plaus_param STRAIN 0x30 0.01;\n"
        found = self.simulate(limit + "eladyn_geo_def cube GRAVITY on;\n" + FORTH)
        events = found["tissue"]["events"]
        self.assertTrue(any("limit" in json.dumps(event) for event in events), events)
        frozen = found["tissue"]["objects"][0]["energy_j"]
        free = self.energies("eladyn_geo_def cube GRAVITY on;\n" + FORTH)[0]
        self.assertLess(frozen, 0.5 * free)
        # A reset ends it, and so does the attribute.
        for end in ("eladyn_model_reset;\n", "eladyn_geo_def cube CALCULATE on;\n"):
            text = limit + "eladyn_geo_def cube GRAVITY on;\n" + FORTH + "eladyn_plaus_param STRAIN 0 0;\n" + end + BACK
            self.assertGreater(self.energies(text)[0], 0.5 * free, end)


if __name__ == "__main__":
    unittest.main()

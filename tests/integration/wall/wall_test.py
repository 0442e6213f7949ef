"""A wall and a plant of made-up gateways over DDS: what is there, what is silent, and what does not fit."""

import json
import pathlib
import re
import subprocess
import tempfile
import unittest
import urllib.error

import gateway as g
from wall import Plant, Wall, free_domain


class WallOfCells(unittest.TestCase):
    def plant(self, cells, **arguments):
        plant = Plant(cells, **arguments)
        self.addCleanup(plant.close)
        return plant

    def wall(self, domain, *arguments, cells=None):
        wall = Wall(domain, *arguments, cells=cells)
        self.addCleanup(wall.close)
        return wall

    def eventually(self, condition, told=lambda: ""):
        self.assertTrue(g.eventually(condition), told())

    def test_thirty_cells_of_eight_robots_are_shown_and_nothing_is_lost(self):
        plant = self.plant(30)
        wall = self.wall(plant.domain)
        self.eventually(lambda: sum(content["state"] == "ok" for content in wall.contents()) == 30)
        self.assertEqual({len(content["robots"]) for content in wall.contents()}, {8})
        self.eventually(lambda: all(tile["pulse"]["received"] >= 10 for tile in wall.document()["tiles"]))
        self.assertEqual({tile["pulse"]["lost"] for tile in wall.document()["tiles"]}, {0})
        metrics = wall.get("metrics").decode()
        self.assertEqual(len(re.findall(r'^cellmirror_wall_cell_up\{.*\} 1$', metrics, re.M)), 30)
        plant.tell("fault 7 the loop is late")
        self.eventually(lambda: wall.state("cell_007") == "fault")
        self.assertEqual(wall.cell("cell_007")[0]["reasons"], ["the loop is late"])
        self.assertIn('cellmirror_wall_cell_health{cell="cell_007",host="host-007",instance="default",claim="1"} 2\n',
                      wall.get("metrics").decode())

    def test_a_cell_that_was_there_stays_and_says_since_when(self):
        plant = self.plant(3)
        wall = self.wall(plant.domain)
        self.eventually(lambda: len(wall.contents()) == 3)
        plant.tell("quiet 1 ")
        plant.tell("close 2 ")
        self.eventually(lambda: (wall.state("cell_001"), wall.state("cell_002")) == ("silent", "silent"))
        self.assertIn("silent_since_ms", wall.cell("cell_001")[0])
        self.assertEqual(wall.state("cell_003"), "ok")
        plant.tell("start 2 ")
        self.eventually(lambda: wall.state("cell_002") == "ok")
        self.assertEqual(len(wall.contents()), 3)

    def test_what_does_not_fit_is_shown_as_what_it_is(self):
        plant = self.plant(8)
        wall = self.wall(plant.domain, cells="format = 1\n" + "".join(
            f'[[cell]]\nname = "cell_{i:03}"\nhost = "host-{i:03}"\n' for i in (*range(1, 8), 99)))
        self.eventually(lambda: all(wall.state(f"cell_{i:03}") == "ok" for i in range(1, 8)))
        self.assertEqual(wall.state("cell_099"), "never seen")
        self.assertEqual(wall.marks("cell_008"), [["unexpected"]])
        plant.tell("call 1 cell_002")  # a lie, and two cells with one name
        self.eventually(lambda: sorted(wall.marks("cell_002")) == [["conflict"], ["conflict", "renamed", "wrong_gateway"]],
                        lambda: wall.marks("cell_002"))
        self.assertEqual(wall.state("cell_001"), "silent")
        plant.tell("version 3 2")
        plant.tell("clock 4 -3600")
        plant.tell("flood 5 200")
        plant.tell("raw 6 rubbish")
        plant.tell("host 7 elsewhere")
        self.eventually(lambda: wall.marks("cell_003") == [["newer_version"]])
        self.eventually(lambda: wall.marks("cell_004") == [["clock"]])
        self.eventually(lambda: wall.marks("cell_005") == [["flood"]])
        self.eventually(lambda: wall.marks("cell_006") == [["rejected"]])
        self.eventually(lambda: wall.marks("cell_007") == [["wrong_gateway"]])
        text = json.dumps(wall.contents())
        self.assertIn("behind that of the wall", text)
        for tile in wall.document()["tiles"]:  # ages are the wall's own
            if tile["content"]["cell"] == "cell_004":
                self.assertLess(tile["pulse"]["age_s"], 5)

    def test_pictures_are_shown_where_they_are_asked_for(self):
        plant = self.plant(2)
        wall = self.wall(plant.domain, cells='format = 1\n[[cell]]\nname = "cell_001"\nthumbnail = "rt/cell_1/picture"\n'
                                             '[[cell]]\nname = "cell_002"\nthumbnail = "rt/cell_2/picture"\n')
        good = bytes([0xFF, 0xD8, 0xFF, 0xC0, 0, 17, 8, 0, 48, 0, 64, 3]) + bytes(20000)
        with tempfile.TemporaryDirectory() as folder:
            for number, content in ((1, good), (2, b"no picture")):
                pathlib.Path(folder, str(number)).write_bytes(content)

            def pulse(name):
                return next(tile["pulse"] for tile in wall.document()["tiles"] if tile["content"]["cell"] == name)

            def sent(number, seen):
                plant.tell(f"jpeg {number} {folder}/{number}")
                return seen()

            self.eventually(lambda: sent(1, lambda: pulse("cell_001").get("thumbnail")))
            self.assertEqual(wall.get("thumbnail.jpg?cell=cell_001&number=1"), good)
            self.eventually(lambda: sent(2, lambda: "thumbnail_refused" in pulse("cell_002")))
            with self.assertRaises(urllib.error.HTTPError) as error:
                wall.get("thumbnail.jpg?cell=cell_002")
            self.assertEqual(error.exception.code, 404)

    def test_a_restart_of_the_wall_remembers_which_cells_were_there(self):
        with tempfile.TemporaryDirectory() as folder:
            state = str(pathlib.Path(folder, "wall.json"))
            plant = Plant(2)
            wall = Wall(plant.domain, "--state", state)
            self.assertTrue(g.eventually(lambda: len(wall.contents()) == 2))
            plant.close()
            self.assertEqual(wall.close(), 0)
            again = self.wall(plant.domain, "--state", state)
            self.assertEqual([again.state("cell_001"), again.state("cell_002")], ["silent", "silent"])
            self.assertIn("silent_since_ms", again.cell("cell_001")[0])

    def test_it_commands_nothing(self):
        wall = self.wall(free_domain())
        for path in ("api/command", "api/status", "snapshot.png", "scene.glb"):
            with self.assertRaises(urllib.error.HTTPError) as error:
                wall.get(path)
            self.assertEqual(error.exception.code, 404, path)

    def test_one_shot_prints_what_was_heard(self):
        plant = self.plant(2)

        def heard():
            done = subprocess.run([g.BIN / "cellmirror", "wall", "--json", "--domain", str(plant.domain)], capture_output=True, text=True, timeout=60)
            self.assertEqual(done.returncode, 0, done.stderr)
            return len(json.loads(done.stdout)["tiles"]) == 2
        self.eventually(heard)

    def test_wrong_use_is_refused_with_a_remedy(self):
        def refused(*arguments):
            done = subprocess.run([g.BIN / "cellmirror", "wall", "--for", "1", *arguments], capture_output=True, text=True, timeout=60)
            self.assertEqual(done.returncode, 1, arguments)
            return done.stderr
        self.assertIn("--allow-remote", refused("--bind", "0.0.0.0"))
        self.assertIn("none.toml", refused("--cells", "/none.toml"))
        with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
            file.write('format = 1\n[[cell]]\nname = "A"\npage = "http://h/#token=1"\n')
            file.flush()
            self.assertRegex(refused("--cells", file.name), r":4:8: error: .*without the token")
        wall = self.wall(free_domain())
        self.assertIn("--port", refused("--port", wall.address.split(":")[-1].rstrip("/")))
        self.assertIn("is not an IPv4 address of this machine", refused("--port", "0", "--interface", "192.0.2.1"))


if __name__ == "__main__":
    unittest.main(verbosity=2)

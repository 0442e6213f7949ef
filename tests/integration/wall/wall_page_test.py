"""The page of the wall in headless Chromium, before a plant of made-up gateways on DDS."""

import os
import pathlib
import subprocess
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "page"))
import browser  # noqa: E402
from wall import Plant, Wall  # noqa: E402

CELLS = "format = 1\n" + '[[cell]]\nname = "cell_001"\npage = "http://127.0.0.1:9001/"\nthumbnail = "rt/cell_1/picture"\n' + "".join(
    f'[[cell]]\nname = "cell_{i:03}"\n' for i in range(2, 8)) + '[[cell]]\nname = "paint"\ntitle = "Paint shop"\n'
PICTURE = browser.SOURCE / "docs" / "figures" / "cell_mirrored.jpg"


def setUpModule():
    browser.chromium(), browser.node(), browser.playwright_core()


def scenario(address, name, *arguments, answer=lambda line: None, seconds=200):
    """What it prints; `answer` does what it asks for."""
    browser.ARTEFACTS.mkdir(parents=True, exist_ok=True)
    environment = dict(os.environ, CHROMIUM=browser.chromium(), PLAYWRIGHT_CORE=str(browser.playwright_core()),
                       AXE_CORE=str(browser.playwright_core().parent / "axe-core"), ARTEFACTS=str(browser.ARTEFACTS))
    child = subprocess.Popen([browser.node(), HERE / "wall_scenarios.mjs", address, name, *map(str, arguments)], env=environment, text=True,
                             stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    output = []
    try:
        for line in child.stdout:
            if line.startswith("> "):
                answer(line[2:].rstrip("\n"))
                child.stdin.write("done\n")
                child.stdin.flush()
            else:
                output.append(line)
        status = child.wait(seconds)
    finally:
        child.kill()
        child.wait()
        child.stdout.close()
        child.stdin.close()
    if status != 0:
        raise AssertionError("".join(output))
    return "".join(output)


class WallPage(unittest.TestCase):
    def setUp(self):
        self.plant = Plant(7)
        self.addCleanup(self.plant.close)
        self.wall = Wall(self.plant.domain, cells=CELLS)
        self.addCleanup(lambda: self.wall.close())

    def test_it_shows_the_worst_first_and_what_is_silent(self):
        scenario(self.wall.address, "cells", PICTURE, answer=self.plant.tell)

    def test_it_shows_what_does_not_fit_as_what_it_is(self):
        scenario(self.wall.address, "lies", answer=self.plant.tell)

    def test_it_says_that_the_wall_is_gone_and_comes_back(self):
        port = self.wall.address.rstrip("/").split(":")[-1]

        def answer(line):
            if line == "wall away":
                self.wall.close()
            elif line == "wall back":
                self.wall = Wall(self.plant.domain, "--port", port, cells=CELLS)
        scenario(self.wall.address, "gone", answer=answer)


if __name__ == "__main__":
    unittest.main(verbosity=2)

#!/usr/bin/python3
"""Takes the figure of the wall before a plant of made-up gateways, in headless Chromium: python3 tests/support/wall_figure.py FILE.png"""

import pathlib
import shutil
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "integration" / "wall"))
import wall_page_test as page  # noqa: E402


def main():
    plant = page.Plant(7)
    wall = page.Wall(plant.domain, cells=page.CELLS)
    try:
        page.scenario(wall.address, "cells", page.PICTURE, answer=plant.tell)
        shutil.copy(page.browser.ARTEFACTS / "wall-light.png", sys.argv[1])
    finally:
        wall.close()
        plant.close()


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Takes the figures of the monitor page (tests/support/figures/figures.py) of the running demo, with its simulated devices, in
headless Chromium.

    python3 tests/support/page_figure.py FOLDER
"""

import json
import pathlib
import shutil
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "integration" / "page"), str(ROOT / "tests" / "bench" / "web")]
import browser  # noqa: E402
import gateway as g  # noqa: E402
from first_picture_bench import simulators  # noqa: E402

PICTURES_OF = {"scene_figure": ["monitor_page_3d"], "page_figure": ["monitor_page", "monitor_page_phone"]}


def main():
    scratch = g.Scratch("transfer_cell", startup=True)
    devices = simulators("transfer_cell")
    gateway = g.Gateway(scratch, pictures=True, page=True)
    try:
        for scenario, names in PICTURES_OF.items():
            page = json.loads(scratch.cellmirror("page", "--json", "--instance", scratch.instance).stdout)
            browser.Scenario(scenario, f"{page['address']}#token={page['token']}").run()
            for name in names:
                shutil.copy(browser.ARTEFACTS / f"{name}.png", pathlib.Path(sys.argv[1]) / f"{name}.png")
    finally:
        gateway.close()
        for device in devices:
            device.close()
        scratch.remove()


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Makes docs/figures/monitor_page_3d.png: the monitor page of the running demo in 3D, with its simulated devices, in headless Chromium.

    python3 tests/support/page_figure.py
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


def main():
    scratch = g.Scratch("transfer_cell", startup=True)
    devices = simulators("transfer_cell")
    gateway = g.Gateway(scratch, pictures=True, page=True)
    try:
        page = json.loads(scratch.cellmirror("page", "--json", "--instance", scratch.instance).stdout)
        browser.Scenario("scene_figure", f"{page['address']}#token={page['token']}").run()
        shutil.copy(browser.ARTEFACTS / "monitor_page_3d.png", ROOT / "docs" / "figures" / "monitor_page_3d.png")
    finally:
        gateway.close()
        for device in devices:
            device.close()
        scratch.remove()


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""How soon whoever opens the page of a running gateway sees the cell: from the address to the first picture, in headless Chromium.

  first_picture_bench.py [LOADS=10] [--cell NAME=transfer_cell]

The demo with its startup script and simulated devices. The first load is told apart: the gateway's renderer is made and the cell's
meshes go to it then. Ends with 1 where the median of the others, or the first one, is a second or more.
"""

import argparse
import json
import pathlib
import re
import statistics
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1] / "support"), str(HERE.parents[1] / "integration" / "page")]
import browser  # noqa: E402
import gateway as g  # noqa: E402

LIMIT_MS = 1000


def simulators(cell):
    lines = (g.CELLS / cell / "simulators.txt").read_text().splitlines()
    words = [line.split() for line in lines if line.strip() and not line.startswith("#")]
    return [g.Process([g.BIN / program, *arguments, "--no-input", "--quiet"]) for _, program, *arguments in words]


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("loads", nargs="?", type=int, default=10)
    arguments.add_argument("--cell", default="transfer_cell")
    wanted = arguments.parse_args()
    scratch = g.Scratch(wanted.cell, startup=True)
    devices = simulators(wanted.cell)
    gateway = g.Gateway(scratch, pictures=True, page=True)
    try:
        page = json.loads(scratch.cellmirror("page", "--json", "--instance", scratch.instance).stdout)
        told = browser.Scenario("first_picture", f"{page['address']}#token={page['token']}", wanted.loads).run()
        times = [float(word) for word in re.search(r"first picture: (.*) ms", told)[1].split()]
        others = times[1:] or times
        draw = scratch.status()["pictures"]["draw_ms"]
        print(f"first load {times[0]:.0f} ms; {len(others)} others: median {statistics.median(others):.0f}, "
              f"longest {max(others):.0f} ms; a drawing takes {draw['p50']:.0f} ms (p50), {draw['max']:.0f} ms (max)")
        return int(times[0] >= LIMIT_MS or statistics.median(others) >= LIMIT_MS)
    finally:
        gateway.close()
        for device in devices:
            device.close()
        scratch.remove()


if __name__ == "__main__":
    sys.exit(main())

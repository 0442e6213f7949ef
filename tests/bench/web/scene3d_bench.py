#!/usr/bin/python3
"""How fluent the 3D view of the monitor page is with a software renderer, beside a bare scene of three.js with the same triangles in
the same run: frames a second while the view turns, in headless Chromium at 1440 x 900, against the stand-in of the gateway.

  scene3d_bench.py [RUNS=3] [--triangles 100000] [--parts 100]

Ends with 1 where the median is below 10 frames a second or below 0.8 of the bare scene's.
"""

import argparse
import pathlib
import re
import statistics
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1] / "integration" / "page")]
import browser  # noqa: E402
from standin_test import StandIn  # noqa: E402

FEWEST = 10
LEAST_SHARE = 0.8
FOUND = re.compile(r"scene: ([\d.]+) frames a second with (\d+) triangles at (.*); bare: ([\d.]+) with (\d+)")


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    arguments.add_argument("runs", nargs="?", type=int, default=3)
    arguments.add_argument("--triangles", type=int, default=100_000)
    arguments.add_argument("--parts", type=int, default=100)
    wanted = arguments.parse_args()
    rates, shares = [], []
    for _ in range(wanted.runs):
        with StandIn("--robots", "2", "--parts", str(wanted.parts), "--triangles", str(wanted.triangles)) as server:
            told = browser.Scenario("scene_bench", server.address).run()
        found = FOUND.search(told)
        rate, bare = float(found[1]), float(found[4])
        rates.append(rate)
        shares.append(rate / bare)
        print(f"{rate:.1f} frames a second with {int(found[2]):,} triangles at {found[3]}; bare scene {bare:.1f} with {int(found[5]):,}: "
              f"{rate / bare:.2f} of it", flush=True)
    rate, share = statistics.median(rates), statistics.median(shares)
    print(f"median {rate:.1f} frames a second, {share:.2f} of the bare scene")
    return int(rate < FEWEST or share < LEAST_SHARE)


if __name__ == "__main__":
    sys.exit(main())

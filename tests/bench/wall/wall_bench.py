#!/usr/bin/python3
"""A wall before many cells: the age of what its page shows, its memory and its processor time.

  wall_bench.py [CELLS=30] [ROBOTS=8] [SECONDS=60] [--rate HZ=2] [--no-browser] [--picture FILE.png]

One process publishes the summaries of all cells over DDS on loopback, each by a writer of its own; Chromium shows the page. The age is that
of the newest summary that the page shows, by the clock of this machine, looked at 50 times a second for each cell; the delay is from the
gateway's publishing to the page's document. Without a browser the page is not rendered: the document of the wall is read once a second.
"""

import argparse
import json
import os
import pathlib
import re
import statistics
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1] / "support"), str(HERE.parents[1] / "integration" / "wall")]
import gateway as g  # noqa: E402
from wall import Plant, Wall  # noqa: E402


def resident_mb(pid, name="VmRSS"):
    return int(re.search(rf"{name}:\s+(\d+)", pathlib.Path(f"/proc/{pid}/status").read_text())[1]) / 1024


def cpu_s(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def watch_without_browser(wall, seconds):
    ages, took = [], []
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        begun = time.monotonic()
        document = wall.document()
        took.append(1000 * (time.monotonic() - begun))
        ages += [1000 * tile["pulse"]["age_s"] for tile in document["tiles"] if "age_s" in tile["pulse"]]
        time.sleep(1)
    return {"age_ms": {"p50": statistics.median(ages), "p95": sorted(ages)[int(0.95 * len(ages))], "count": len(ages)},
            "document_ms": statistics.median(took)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cells", nargs="?", type=int, default=30)
    parser.add_argument("robots", nargs="?", type=int, default=8)
    parser.add_argument("seconds", nargs="?", type=float, default=60)
    parser.add_argument("--rate", type=float, default=2)
    parser.add_argument("--no-browser", action="store_true")
    parser.add_argument("--picture")
    given = parser.parse_args()
    plant = Plant(given.cells, given.robots, given.rate)
    wall = Wall(plant.domain)
    try:
        begun = time.monotonic()
        if not g.eventually(lambda: sum(content["state"] == "ok" for content in wall.contents()) >= given.cells, timeout=120, every=0.2):
            print(f"only {len(wall.contents())} of {given.cells} cells were seen")
        print(f"all cells seen after {time.monotonic() - begun:.1f} s")
        before = {tile["content"]["cell"]: tile["pulse"] for tile in wall.document()["tiles"]}
        cpu, plant_cpu, since = cpu_s(wall.child.pid), cpu_s(plant.child.pid), time.monotonic()
        if given.no_browser:
            seen = watch_without_browser(wall, given.seconds)
        else:
            if given.picture:
                os.environ["WALL_PICTURE"] = given.picture
            from wall_page_test import scenario  # noqa: PLC0415
            seen = json.loads(scenario(wall.address, "age", given.seconds, given.cells, seconds=given.seconds + 120))
        passed = time.monotonic() - since
        after = {tile["content"]["cell"]: tile["pulse"] for tile in wall.document()["tiles"]}
        received = sum(pulse["received"] - before.get(cell, {}).get("received", 0) for cell, pulse in after.items())
        print(json.dumps({
            "cells": given.cells, "robots": given.cells * given.robots, "rate_hz": given.rate, **seen,
            "received_per_s": round(received / passed, 1), "lost": sum(pulse["lost"] for pulse in after.values()),
            "dropped": sum(pulse["dropped"] for pulse in after.values()),
            "wall_cores": round((cpu_s(wall.child.pid) - cpu) / passed, 3), "plant_cores": round((cpu_s(plant.child.pid) - plant_cpu) / passed, 3),
            "wall_mb": round(resident_mb(wall.child.pid), 1), "wall_peak_mb": round(resident_mb(wall.child.pid, "VmHWM"), 1)}, indent=1))
    finally:
        wall.close()
        plant.close()


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""A gateway that is cut off from two discovery servers and a control room for some seconds: after how long it is heard again.

  cut_bench.py [--cuts S,S,...] [--plain]

In the middle of each cut a second control room is started, which must find the gateway too; a third one comes after the cut. A last
one comes and goes during a cut of its own, so that servers and peers have more to tell. --plain: servers with the settings that
fast-discovery-server has by itself, as those of a ROS 2 system.
"""

import argparse
import pathlib
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import gateway as g  # noqa: E402
import plant  # noqa: E402

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--cuts", default="2,6,9,12,18,25,40", help="in seconds")
parser.add_argument("--plain", action="store_true")
OPTIONS = parser.parse_args()
CELLS = {"cut", "other"}
PATIENCE_S, BETWEEN_S = 30, 8


class Plant:
    def __init__(self, root):
        self.servers = [plant.Place(1), plant.Place(2)]
        settings = {"settings": ()} if OPTIONS.plain else {}
        self.running = [plant.start_server(place, number, **settings) for number, place in enumerate(self.servers)]
        self.places = [plant.Place(10), plant.Place(11)]
        self.host = 20
        for name, place in zip(sorted(CELLS), self.places):
            cell = plant.PlantCell(root, name, 2, place.address, f"discovery_servers = {plant.servers_text(self.servers)}")
            self.running.append(place.start(cell.command(), cell.environment()))
            if not g.eventually(lambda: "Ctrl-C ends it" in self.running[-1].output(), PATIENCE_S):
                sys.exit(self.running[-1].output())

    def control_room(self):
        self.host += 1
        return plant.SummaryReader(plant.Place(self.host), self.servers)

    def connect(self, connected):
        self.places[0].connect(connected)

    def close(self):
        for process in self.running:
            process.close()


def heard(reader, since):
    """As a text."""
    if g.eventually(lambda: CELLS <= reader.cells_since(since), PATIENCE_S, 0.05):
        return f"{time.monotonic() - since:5.2f} s"
    return f"not in {PATIENCE_S} s"


def main():
    if not plant.is_possible() or not plant.enter():
        sys.exit("skipped: network namespaces cannot be made here")
    cells = Plant(pathlib.Path(tempfile.mkdtemp(prefix="cellmirror-cut-")))
    try:
        early = cells.control_room()
        print(f"a control room hears both gateways after {heard(early, time.monotonic())}", flush=True)
        for cut in map(float, OPTIONS.cuts.split(",")):
            cells.connect(False)
            time.sleep(cut / 2)
            during = cells.control_room()
            time.sleep(cut / 2)
            cells.connect(True)
            since = time.monotonic()
            told = f"cut for {cut:g} s: the control room before {heard(early, since)}, the one during it {heard(during, since)}"
            during.close()
            late = cells.control_room()
            print(f"{told}, the one after it {heard(late, time.monotonic())}", flush=True)
            late.close()
            cells.connect(False)
            passing = cells.control_room()
            time.sleep(BETWEEN_S / 2)
            passing.close()
            cells.connect(True)
            time.sleep(BETWEEN_S)
        early.close()
    finally:
        cells.close()


main()

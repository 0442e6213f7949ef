#!/usr/bin/python3
"""Many gateways on one network: how fast all are found, with discovery servers and without, and what finding them costs.

  plant_bench.py [--cells N=30] [--robots N=8] [--simple]

Each gateway, two discovery servers and a control room are in network namespaces of their own, joined by a bridge. Loops run at
100 Hz, so that two cores carry them. Prints: after how long a new control room has a summary of each cell; what machines received
for discovery; the same after both servers were killed and started again, after a split of the network, and after a gateway came up at
another address; summaries that were lost. --simple: peers find each other by multicast instead.
"""

import argparse
import pathlib
import socket
import struct
import sys
import tempfile
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import gateway as g  # noqa: E402
import plant  # noqa: E402

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--cells", type=int, default=30)
parser.add_argument("--robots", type=int, default=8)
parser.add_argument("--simple", action="store_true")
OPTIONS = parser.parse_args()
PATIENCE_S = 120


class DiscoveryMeter:
    """Bytes and datagrams for discovery that the bridge gave to machines: those to a server, to the group, or to the even ports by
    which a participant is found (RTPS 2.3, 9.6.1.1)."""

    def __init__(self):
        self.bytes = self.datagrams = self.data_bytes = 0
        self.socket = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(3))
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 64 << 20)
        threading.Thread(target=self.count, daemon=True).start()

    def count(self):
        while True:
            frame, address = self.socket.recvfrom(2048)
            if address[2] != socket.PACKET_OUTGOING or not address[0].startswith("p") or address[0] == "plant":
                continue
            if len(frame) < 42 or frame[12:14] != b"\x08\x00" or frame[23] != 17 or frame[20] & 0x1F or frame[21]:
                continue
            port = struct.unpack("!H", frame[36:38])[0]
            source = struct.unpack("!H", frame[34:36])[0]
            if port in (7400, plant.SERVER_PORT) or source == plant.SERVER_PORT or (port >= 7410 and port % 2 == 0):
                self.bytes += len(frame)
                self.datagrams += 1
            else:
                self.data_bytes += len(frame)

    def figures(self):
        return self.bytes, self.datagrams


def rss_mb(pid):
    return int(pathlib.Path(f"/proc/{pid}/statm").read_text().split()[1]) * 4096 / 1e6


def wait_for_all(reader, cells, since, what):
    found = g.eventually(lambda: len(reader.cells_since(since)) == cells, PATIENCE_S, 0.02)
    first = {}
    for event in reader.events():
        if event["at_s"] >= since:
            first.setdefault(event["cell"], event["at_s"] - since)
    late = f"; {cells - len(first)} never" if not found else ""
    print(f"{what}: all {cells} cells after {max(first.values(), default=float('nan')):.2f} s{late}", flush=True)


def lost(reader):
    """Summaries that a control room should have seen between the first and the last of each run."""
    runs = {}
    for event in reader.events():
        runs.setdefault(event["run"], []).append(event["sequence"])
    return sum(max(seen) - min(seen) + 1 - len(set(seen)) for seen in runs.values()), sum(map(len, runs.values()))


def main():
    if not plant.is_possible() or not plant.enter():
        sys.exit("skipped: network namespaces cannot be made here")
    root = pathlib.Path(tempfile.mkdtemp(prefix="cellmirror-plant-"))
    servers = [] if OPTIONS.simple else [plant.Place(1), plant.Place(2)]
    meter = DiscoveryMeter()

    def start_all():
        return [plant.start_server(place, number) for number, place in enumerate(servers)]

    running = start_all()
    dds = f"discovery_servers = {plant.servers_text(servers)}" if servers else ""
    places = [plant.Place(10 + cell) for cell in range(OPTIONS.cells)]
    cells = [plant.PlantCell(root, f"cell{number:02}", OPTIONS.robots, place.address, dds) for number, place in enumerate(places)]
    gateways = []
    begin = time.monotonic()
    for cell, place in zip(cells, places):
        gateways.append(place.start(cell.command(), cell.environment()))
    for gateway in gateways:
        if not g.eventually(lambda: "Ctrl-C ends it" in gateway.output(), PATIENCE_S):
            sys.exit(f"a gateway did not start:\n{gateway.output()}")
    print(f"{OPTIONS.cells} gateways of {OPTIONS.robots} robots up after {time.monotonic() - begin:.1f} s", flush=True)
    time.sleep(5)
    print("discovery so far: {:.0f} kB in {} datagrams".format(meter.figures()[0] / 1e3, meter.figures()[1]))

    before = meter.figures()
    time.sleep(10)
    after = meter.figures()
    print(f"discovery at rest: {(after[0] - before[0]) / 1e4:.1f} kB/s, {(after[1] - before[1]) / 10:.0f} datagrams/s")

    room = plant.Place(3)
    since = time.monotonic()
    reader = plant.SummaryReader(room, servers)
    wait_for_all(reader, OPTIONS.cells, since, "a new control room")
    time.sleep(10)
    print("lost at 2 Hz: {} of {}".format(*lost(reader)))

    if servers:
        for server in running:
            server.kill()
        time.sleep(plant.SERVER_PAUSE_S)
        running = start_all()
        since = time.monotonic()
        later = plant.SummaryReader(plant.Place(4), servers)
        wait_for_all(later, OPTIONS.cells, since, f"servers killed for {plant.SERVER_PAUSE_S} s, a new control room from their start on")
        print("lost meanwhile by the one before: {} of {}".format(*lost(reader)))
        later.close()
        for server in running:
            server.kill()
        time.sleep(40)
        print(f"servers dead for 40 s: {len(reader.cells_since(time.monotonic() - 1.5))} cells heard in the last 1.5 s")
        running = start_all()
        since = time.monotonic()
        later = plant.SummaryReader(plant.Place(5), servers)
        wait_for_all(later, OPTIONS.cells, since, "servers back after 40 s, a new control room from their start on")
        wait_for_all(reader, OPTIONS.cells, since, "servers back after 40 s, the one before")
        later.close()

    places[0].connect(False)
    time.sleep(25)
    since = time.monotonic()
    places[0].connect(True)
    wait_for_all_of(reader, "cell00", since, "a cell cut off for 25 s")

    gateways[0].kill()
    moved = plant.Place(200)
    cell = plant.PlantCell(root, "cell00", OPTIONS.robots, moved.address, dds)
    since = time.monotonic()
    gateways[0] = moved.start(cell.command(), cell.environment())
    wait_for_all_of(reader, "cell00", since, "a gateway killed and started at another address, with its start")

    memory = sorted(rss_mb(gateway.child.pid) for gateway in gateways)
    print(f"a gateway: {memory[len(memory) // 2]:.0f} MB (median)")
    for process in [*gateways, *running, reader]:
        process.close()


def wait_for_all_of(reader, cell, since, what):
    g.eventually(lambda: cell in reader.cells_since(since), PATIENCE_S, 0.02)
    times = [event["at_s"] - since for event in reader.events() if event["cell"] == cell and event["at_s"] >= since]
    print(f"{what}: heard after {min(times, default=float('nan')):.2f} s", flush=True)


main()

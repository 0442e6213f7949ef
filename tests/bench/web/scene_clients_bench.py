#!/usr/bin/python3
"""What eight pages in 3D cost the gateway: processor time and wake-up latency of the loop without clients, with pages that only hear the
news, and with pages that also get poses, while the robots of the cell move.

  scene_clients_bench.py [SECONDS=30] [--cell NAME=transfer_cell]

Ends with 1 where eight pages with poses take more than 0.1 of a processor beyond the gateway without clients.
"""

import argparse
import json
import os
import pathlib
import sys
import threading
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1] / "support"), str(HERE.parents[1] / "integration" / "web")]
import gateway as g  # noqa: E402
from first_picture_bench import simulators  # noqa: E402
from page_client import Live, Page  # noqa: E402

PAGES = 8
MOST = 0.1


def processor_s(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def look(page, poses, stop, counts, number):
    live = Live(page)
    if poses:
        live.say(do="scene")
    while not stop.is_set():
        message = live.hear()
        if isinstance(message, bytes) and message[:4] == b"CMS1":
            live.say(do="posed", sequence=int.from_bytes(message[4:8], "little"))
            counts[number][0] += 1
            counts[number][1] += len(message)
    live.close()


def measure(scratch, gateway, page, poses, seconds):
    """(share of a processor, updates a second of a page, KiB a second of a page, latency p99 in us); `poses`: None without pages"""
    stop, counts = threading.Event(), [[0, 0] for _ in range(PAGES)]
    threads = []
    if poses is not None:
        threads = [threading.Thread(target=look, args=(page, poses, stop, counts, i), daemon=True) for i in range(PAGES)]
        for thread in threads:
            thread.start()
    time.sleep(3)
    before, begin, counted = processor_s(gateway.child.pid), time.monotonic(), [list(count) for count in counts]
    time.sleep(seconds)
    took = time.monotonic() - begin
    share = (processor_s(gateway.child.pid) - before) / took
    updates = sum(a[0] - b[0] for a, b in zip(counts, counted)) / took / PAGES
    size = sum(a[1] - b[1] for a, b in zip(counts, counted)) / took / PAGES / 1024
    latency = scratch.status()["loop"]["wakeup_latency_us"]["p99"]
    stop.set()
    for thread in threads:
        thread.join(10)
    return share, updates, size, latency


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    arguments.add_argument("seconds", nargs="?", type=float, default=30)
    arguments.add_argument("--cell", default="transfer_cell")
    wanted = arguments.parse_args()
    scratch = g.Scratch(wanted.cell, startup=True)
    devices = simulators(wanted.cell)
    gateway = g.Gateway(scratch, page=True)
    try:
        page = Page(json.loads(scratch.cellmirror("page", "--json", "--instance", scratch.instance).stdout))
        time.sleep(5)
        shares = []
        for name, poses in (("no page", None), ("news", False), ("news and poses", True)):
            share, updates, size, latency = measure(scratch, gateway, page, poses, wanted.seconds)
            shares.append(share)
            print(f"{name:15} {share:.3f} of a processor; {updates:.1f} updates, {size:.0f} KiB a second for each page; "
                  f"wake-up p99 since the start {latency:.0f} us", flush=True)
        cost = shares[2] - shares[0]
        print(f"{PAGES} pages in 3D: {cost:.3f} of a processor beyond none, {shares[2] - shares[1]:.3f} of it for poses")
        return int(cost > MOST)
    finally:
        gateway.close()
        for device in devices:
            device.close()
        scratch.remove()


if __name__ == "__main__":
    sys.exit(main())

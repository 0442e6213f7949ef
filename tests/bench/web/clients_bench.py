#!/usr/bin/python3
"""Eight pages look at a running gateway, one of them stalled: what that costs the loop, and whether memory stays flat.

  clients_bench.py [SECONDS=600] [--pictures]

Runs the transfer cell for a tenth of the time without clients, then with them. Prints the loop's wake-up latency in both, missed
periods, pictures a second of each client, and resident memory at the beginning and the end. With --pictures the gateway draws; without, only
`live` and its documents go over the wire.
"""

import json
import pathlib
import re
import sys
import threading
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1] / "support"), str(HERE.parents[1] / "integration" / "web")]
import gateway as g  # noqa: E402
from page_client import Live, Page, picture_number  # noqa: E402

CLIENTS = 7


def resident_mb(pid):
    return int(re.search(r"VmRSS:\s+(\d+)", pathlib.Path(f"/proc/{pid}/status").read_text())[1]) / 1024


def look(page, pictures, stop, counts, number):
    live = Live(page)
    if pictures:
        live.say(do="picture", rate_hz=15)
    while not stop.is_set():
        message = live.hear()
        shown = picture_number(message)
        if shown is not None:
            live.say(do="shown", sequence=shown)
            counts[number][1] += 1
        else:
            counts[number][0] += message.get("is") == "live"
    live.close()


def measure(scratch, seconds, page=None, pictures=False):
    gateway = g.Gateway(scratch, page=page is None or page, pictures=pictures)
    try:
        stop, counts = threading.Event(), [[0, 0] for _ in range(CLIENTS)]
        threads = []
        stalled = None
        if page:
            where = Page(json.loads(scratch.cellmirror("page", "--json", "--instance", scratch.instance).stdout))
            threads = [threading.Thread(target=look, args=(where, pictures, stop, counts, i), daemon=True) for i in range(CLIENTS)]
            for thread in threads:
                thread.start()
            stalled = Live(where, 4096)
            if pictures:
                stalled.say(do="picture")
        time.sleep(40 if page else 5)  # buffers have the size they need
        before = resident_mb(gateway.child.pid)
        begin, counted = time.monotonic(), [list(count) for count in counts]
        time.sleep(seconds)
        took = time.monotonic() - begin
        status = scratch.status()
        after = resident_mb(gateway.child.pid)
        stop.set()
        for thread in threads:
            thread.join(10)
        if stalled:
            stalled.close()
        rates = [[round((now - then) / took, 1) for now, then in zip(a, b)] for a, b in zip(counts, counted)]
        return status, before, after, rates
    finally:
        gateway.close()


def report(title, status, before, after):
    loop = status["loop"]
    latency = loop["wakeup_latency_us"]
    print(f"{title}: wake-up latency p50 {latency['p50']:.0f} p99 {latency['p99']:.0f} p99.9 {latency['p999']:.0f} max {latency['max']:.0f} us, "
          f"missed {loop['missed']} of {loop['ticks']} periods ({loop['scheduler']}), memory {before:.1f} MB -> {after:.1f} MB")


def main():
    arguments = [a for a in sys.argv[1:] if a != "--pictures"]
    pictures = "--pictures" in sys.argv
    seconds = float(arguments[0]) if arguments else 600.0
    scratch = g.Scratch()
    try:
        status, before, after, _ = measure(scratch, max(5.0, seconds / 10), page=False, pictures=pictures)
        report("without clients", status, before, after)
        status, before, after, rates = measure(scratch, seconds, page=True, pictures=pictures)
        report(f"{CLIENTS} clients and a stalled one", status, before, after)
        print("live and pictures a second of each client:", ", ".join(f"{live}/{shown}" for live, shown in rates))
        print("page:", json.dumps(status["page"]))
    finally:
        scratch.remove()


if __name__ == "__main__":
    main()

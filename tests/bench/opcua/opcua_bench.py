#!/usr/bin/python3
"""How old the positions of all joints are at a client of the bridge to OPC UA, and what bridge and gateway cost.

  opcua_bench.py [--periods MS,MS,...] [SECONDS=30]

The transfer cell with its 8 robots (38 joints), five of which move; one client subscribes all positions with every change of their
time. "at arrival" is the age of a value when the client has it, "replaced" when the next one comes: the oldest that a client sees.
Memory is resident, processor time a share of one core. Needs the packages that ./check --peers installs.
"""

import argparse
import os
import pathlib
import sys
import time

TESTS = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(TESTS / "support"), str(TESTS / "integration" / "opcua")]
import bridge as b  # noqa: E402
import gateway as g  # noqa: E402

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("seconds", nargs="?", type=float, default=30.0)
parser.add_argument("--periods", default="50,100,200,500")
OPTIONS = parser.parse_args()
MOVING = ("MANTEC_RM3", "MANTEC_R3", "mantec_R3", "mantec_R3a", "PUMA_762")


def processor_s(process):
    fields = pathlib.Path(f"/proc/{process.child.pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def resident_mb(process):
    return int(pathlib.Path(f"/proc/{process.child.pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6


def share(values, part):
    values = sorted(values)
    return values[min(len(values) - 1, int(part * len(values)))]


def move(scratch, seconds):
    """All of MOVING to and fro; they need longer than the second between two commands."""
    end, turn = time.monotonic() + seconds, 0
    while time.monotonic() < end:
        turn += 1
        for robot in MOVING:
            scratch.send(f"POS_ROB {robot} JOINT_ABS {30 if turn % 2 else -30}")
        time.sleep(1)


def measure(scratch, gateway, period, idle_share):
    bridge = b.Bridge(scratch, "--period", period)
    try:
        bridge.wait_for("answers: 8 robots")
        ids = [node for node in bridge.nodes() if node.endswith(".ActualPosition")]
        watch = bridge.watch(*ids)
        try:
            g.eventually(lambda: len({one["id"] for one in watch.notifications()}) == len(ids))
            seen, start = len(watch.notifications()), time.monotonic()
            before = [processor_s(one) for one in (bridge, gateway)]
            move(scratch, OPTIONS.seconds)
            lasted = time.monotonic() - start
            used = [(processor_s(one) - was) / lasted for one, was in zip((bridge, gateway), before)]
            report(period, ids, watch.notifications()[seen:], lasted, used, idle_share, resident_mb(bridge))
        finally:
            watch.close()
    finally:
        bridge.close()


def report(period, ids, notifications, lasted, used, idle_share, memory):
    arrival, replaced, last = [], [], {}
    for one in (one for one in notifications if one["status"] == "Good"):
        arrival.append(one["at"] - one["source"])
        if one["id"] in last:
            replaced.append(one["at"] - last[one["id"]])
        last[one["id"]] = one["source"]
    print(f"period {period} ms: {len(last)} of {len(ids)} positions, {len(arrival) / lasted / max(1, len(last)):.1f} a second each; age at arrival "
          f"p50 {share(arrival, 0.5):.0f} p95 {share(arrival, 0.95):.0f} ms, replaced p50 {share(replaced, 0.5):.0f} p95 "
          f"{share(replaced, 0.95):.0f} ms; bridge {100 * used[0]:.1f} % of a core, {memory:.0f} MB; gateway {100 * used[1]:.1f} % "
          f"({100 * idle_share:.1f} % without it)")


def main():
    missing = b.why_missing()
    if missing:
        raise SystemExit(missing)
    scratch = g.Scratch()
    gateway = g.Gateway(scratch)
    try:
        before, start = processor_s(gateway), time.monotonic()
        move(scratch, OPTIONS.seconds)
        idle_share = (processor_s(gateway) - before) / (time.monotonic() - start)
        for period in OPTIONS.periods.split(","):
            measure(scratch, gateway, int(period), idle_share)
    finally:
        gateway.close()
        scratch.remove()


main()

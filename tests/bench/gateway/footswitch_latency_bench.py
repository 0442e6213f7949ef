#!/usr/bin/python3
"""From the bit of a foot switch to the first command of its script, in the running gateway with the phantom trainer cell.

  footswitch_latency_bench.py [CHANGES=500]

Two figures: what the gateway tells (from the look that saw the bit to the end of the first command), and what another
process sees: it writes the bit and looks until the command's effect stands in the memory of key 1313, which the
gateway's worker writes after the next tick. Goal: p99 at most 5 ms.
"""

import pathlib
import random
import statistics
import sys
import time
from ctypes import c_float

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import gateway as g  # noqa: E402
import trainer as t  # noqa: E402
from shared_memory import Segment, unused_key  # noqa: E402

GOAL_MS = 5.0


def percentile(values, share):
    return sorted(values)[min(len(values) - 1, int(len(values) * share))]


def wait_for(force, wanted, begin):
    while force.cell(c_float, 0).value != wanted:
        if time.perf_counter() - begin > 2:
            raise SystemExit(f"the command was not executed within 2 s (waiting for {wanted})")
        time.sleep(0.00005)
    return time.perf_counter() - begin


def main():
    changes = int(sys.argv[1]) if len(sys.argv) > 1 else 500
    scratch = g.Scratch("phantom_trainer")
    keys = t.with_own_memories(scratch)
    force_key = unused_key()
    text = scratch.cell_file.read_text()
    scratch.cell_file.write_text(text + f"\n[queues]\ntcp_force_key = {force_key}\n")
    for state, value in (("ON", 1), ("OFF", 2)):
        (scratch.home / "scripts" / f"BININP1_{state}.spt").write_text(f"SET_EXT_TCP_TEST on {value} 0 0 0\n")
    gateway = g.Gateway(scratch)
    lot = random.Random(1)
    try:
        if scratch.send("SET_EXT_TCP_TEST on 2 0 0 0").returncode != 0:
            raise SystemExit("the force at the TCP is not written")
        with Segment(keys["switches"]) as switches, Segment(force_key) as force:
            seen = []
            for i in range(changes):
                time.sleep(0.03 + 0.02 * lot.random())
                begin = time.perf_counter()
                switches.byte().value ^= 1
                seen.append(1e3 * wait_for(force, 1.0 if i % 2 == 0 else 2.0, begin))
        told = scratch.status()["foot_switches"]["first_command_ms"]
        print(f"{changes} changes: told by the gateway p50 {told['p50']:.2f} ms, p99 {told['p99']:.2f} ms, max {told['max']:.2f} ms; "
              f"seen by another process p50 {statistics.median(seen):.2f} ms, p99 {percentile(seen, 0.99):.2f} ms, max {max(seen):.2f} ms "
              f"(goal: p99 {GOAL_MS} ms)")
    finally:
        gateway.stop()
        gateway.close()
        scratch.remove()


if __name__ == "__main__":
    main()

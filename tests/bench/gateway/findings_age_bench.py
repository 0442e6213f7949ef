#!/usr/bin/python3
"""How old the results of collision tests and range sensors are in the running gateway, all robots of the transfer cell moving.

  findings_age_bench.py [SECONDS=15]

Each robot runs a script of random POS_ROB commands within 10 to 90 % of its ranges. The age is that which a reader sees at
most: from the tick's posture to the moment at which the next result replaces it (docs/status.md, collisions.age_ms).
"""

import math
import pathlib
import random
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import gateway as g  # noqa: E402

MOVES = 200


def script_of(robot, rng):
    lines = []
    parameters = robot["parameters"]
    for _ in range(MOVES):
        values = []
        for low, high, joint in zip(parameters["min_range"], parameters["max_range"], robot["joints"]):
            value = low + (high - low) * rng.uniform(0.1, 0.9)
            values.append(f"{value * 1000 if joint['unit'] == 'm' else math.degrees(value):.3f}")
        lines.append(f"POS_ROB {robot['id']} JOINT_ABS {' '.join(values)};")
    return "\n".join(lines) + "\n"


def show(title, found):
    age, compute = found["age_ms"], found["compute_us"]
    print(f"{title}: age p50 {age['p50']:.2f}, p99 {age['p99']:.2f}, max {age['max']:.1f} ms; "
          f"computation p50 {compute['p50']:.0f}, p99 {compute['p99']:.0f} us; {found['skipped']} ticks passed over")


def main():
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 15.0
    scratch = g.Scratch()
    gateway = g.Gateway(scratch)
    try:
        g.eventually(lambda: scratch.status()["collisions"]["counters"]["checks"] > 10, 60)
        rng = random.Random(1)
        for robot in scratch.status()["robots"]:
            (scratch.home / "scripts" / f"age_{robot['id']}.spt").write_text(script_of(robot, rng))
            scratch.send(f"EXEC_SCRIPT age_{robot['id']}.spt")
        for sensor in scratch.status()["ranges"]["sensors"]:
            scratch.send(f"SET_USSPAR active {sensor['id']} 1")
        time.sleep(seconds)
        status = scratch.status()
        collisions = status["collisions"]
        print(f"{collisions['bodies']} bodies, {collisions['triangles']} triangles, {collisions['pairs']['tested']} pairs, "
              f"{collisions['counters']['checks']} checks in {seconds:g} s, {collisions['counters']['doubts']} doubts")
        show("collisions", collisions)
        show("ranges", status["ranges"])
        loop = status["loop"]
        print(f"loop: {loop['scheduler']}, wake-up p99 {loop['wakeup_latency_us']['p99']:.0f} us, tick p99 "
              f"{loop['compute_us']['p99']:.0f} us, {loop['missed']} missed, {loop['allocations']} allocations")
    finally:
        gateway.close()
        scratch.remove()


if __name__ == "__main__":
    main()

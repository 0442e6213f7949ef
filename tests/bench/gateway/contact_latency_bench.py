#!/usr/bin/python3
"""From the first posture in which a robot overlaps something to the EMCY of its blocked drive, in the running gateway.

  contact_latency_bench.py [CONTACTS=50]

The second arm of the SCARA robot of can_cell, whose drives the gateway answers for ([[device]], over udp on loopback), runs
into a post at 0.5 to 3 rad/s. The gateway tells the time from the tick with the first overlap to the drive's EMCY; what the
frame takes to the master comes on top. Goal: at most 5 ms.
"""

import pathlib
import random
import re
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "support"), str(ROOT / "integration" / "gateway")]
import device_test  # noqa: E402
import drive_master  # noqa: E402
import gateway as g  # noqa: E402

GOAL_MS = 5.0
NODE = 11
START = -0.2  # rad


def velocity(master, rad_s):
    master.write(NODE, 0x60FF, round(rad_s * device_test.TURN) & 0xFFFFFFFF, 4)


def wait_for(condition, what):
    if not g.eventually(condition, 30, 0.002):
        raise SystemExit(f"not within 30 s: {what}")


def one_contact(scratch, master, speed):
    position = lambda: master.read(NODE, 0x6064, signed=True) / device_test.TURN
    velocity(master, -1.0)
    if master.enable(NODE) != "enabled":
        raise SystemExit("the drive cannot be enabled")
    wait_for(lambda: position() < START, "the way back")
    velocity(master, speed)
    wait_for(lambda: master.state(NODE) == "fault", "a contact")
    told = re.search(r"0x7121 motor blocked, ([0-9.]+) ms", scratch.robot("SCARA_1")["stream"]["last_errors"][-1])
    if told is None:
        raise SystemExit("another fault than a blocked motor")
    velocity(master, -1.0)
    master.write(NODE, 0x6040, 0x80, 2)
    master.write(NODE, 0x6040, 0x00, 2)
    return float(told[1])


def main():
    contacts = int(sys.argv[1]) if len(sys.argv) > 1 else 50
    lot = random.Random(1)
    group, port = f"239.75.{random.randrange(1, 255)}.{random.randrange(1, 255)}", random.randrange(20000, 60000)
    scratch = g.Scratch("can_cell")
    text = scratch.cell_file.read_text()
    start, end = text.index("[[stream]]"), text.index("[[stream]]", text.index("[[stream]]") + 1)
    scratch.cell_file.write_text(text[:start] + device_test.device(f"udp:{group}:{port}") + text[end:] + device_test.POST)
    master = drive_master.Master(group, port)
    gateway = g.Gateway(scratch)
    try:
        if scratch.send("ROBOT SCARA_1 online;").returncode != 0:
            raise SystemExit("the drives do not go online")
        time.sleep(0.2)
        master.nmt(1)
        master.write(NODE, 0x6060, 3, 1)
        times = sorted(one_contact(scratch, master, lot.uniform(0.5, 3.0)) for _ in range(contacts))
        collisions = scratch.status()["collisions"]
        print(f"{contacts} contacts: p50 {times[len(times) // 2]:.1f} ms, p90 {times[len(times) * 9 // 10]:.1f} ms, "
              f"max {times[-1]:.1f} ms (goal {GOAL_MS:.0f} ms); collision tests at {collisions['rate_hz']:.0f} Hz")
    finally:
        gateway.close()
        master.close()
        scratch.remove()


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""A haptic device without hardware: writes a pose on a slow circle and prints the force that comes back.

    python3 haptic_device.py --key 1401 --seconds 10
    python3 haptic_device.py --key 1401 --seconds 10 --to 0.0469,0.0294,-0.0605     # there and back, every 4 s

    sequence phase fault force x y z N age MICROSECONDS us

The hand rests for a second and a half first: a gateway that has lost a device before engages the next one at rest.

SPDX-License-Identifier: Apache-2.0
"""

import argparse
import math
import sys
import time

import cellmirror_memory as cellmirror

PERIOD_NS = 1_000_000
OLDEST_NS = 5_000_000  # a force that is older is not rendered
REST_S = 1.5
THERE_AND_BACK_S = 4.0


def name(names, number):
    return names[number] if number < len(names) else "unknown"


def line_of(force, age_ns, rendered):
    x, y, z = force["force_device"]
    return (
        f"{force['sequence']} {name(cellmirror.PHASES, force['phase'])} {name(cellmirror.FAULTS, force['fault'])} "
        f"force {x:.3f} {y:.3f} {z:.3f} N age {age_ns // 1000} us" + ("" if rendered else ", not rendered")
    )


def place(text):
    values = tuple(float(part) for part in text.split(","))
    if len(values) != 3 or not all(math.isfinite(value) for value in values):
        raise argparse.ArgumentTypeError("three numbers X,Y,Z in metres")
    return values


def position_at(seconds, options):
    """In the device's axes, m."""
    moving = max(0.0, seconds - REST_S)
    if options.to is None:
        return (options.radius * math.cos(moving), options.radius * math.sin(moving), 0.0)
    share = 0.5 - 0.5 * math.cos(2 * math.pi * moving / THERE_AND_BACK_S)
    return tuple(share * value for value in options.to)


def attached(key):
    try:
        return cellmirror.Memory(key, cellmirror.HAPTIC_BYTES)
    except OSError:
        return None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--key", type=lambda text: int(text, 0), required=True)
    parser.add_argument("--seconds", type=float, default=0.0, help="default: without end")
    parser.add_argument("--radius", type=float, default=0.01, metavar="METRES")
    parser.add_argument("--to", type=place, metavar="X,Y,Z", help="moves there and back instead of on the circle")
    options = parser.parse_args()

    try:
        memory = cellmirror.Memory(options.key, cellmirror.HAPTIC_BYTES)
    except OSError as error:
        print(f"haptic_device.py: no gateway is running: {error}", file=sys.stderr)
        return 1
    start = time.monotonic_ns()
    step = sequence = 0
    position = (0.0, 0.0, 0.0)
    largest = 0.0
    while options.seconds <= 0 or time.monotonic_ns() - start < options.seconds * 1e9:
        now = time.monotonic_ns()
        if memory is not None:
            position = position_at(1e-9 * (now - start), options)
            sequence += 1
            cellmirror.write_sample(memory, sequence, now, position)
            force = cellmirror.read_force(memory)
            if force is not None:
                largest = max(largest, math.hypot(*force["force_device"]))
            if force is not None and step % 100 == 0:
                age = time.monotonic_ns() - force["time_ns"]
                print(line_of(force, age, force["gateway"] != 0 and age <= OLDEST_NS), flush=True)
        if step % 500 == 499:  # has the gateway gone, is it there again?
            if memory is not None and memory.removed():
                memory.detach()
                memory = None
            if memory is None:
                memory = attached(options.key)
        step += 1
        time.sleep(max(0, start + step * PERIOD_NS - time.monotonic_ns()) * 1e-9)
    if memory is not None:  # the device's last word: its values no longer count
        cellmirror.write_sample(memory, sequence + 1, time.monotonic_ns(), position, good=False)
        memory.detach()
    # What rounds to zero is no touch.
    print(f"touched: largest force {largest:.3f} N" if largest >= 5e-4 else "nothing was touched", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())

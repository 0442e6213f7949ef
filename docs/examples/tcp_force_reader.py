#!/usr/bin/env python3
"""Prints the force at the TCP of the active robot, one line a change.

    python3 tcp_force_reader.py --count 10

    sequence robot force x y z N torque t Nm valid|no force [beyond the limit] [test]

SPDX-License-Identifier: Apache-2.0
"""

import argparse
import sys
import time

import cellmirror_memory as cellmirror

VALID, TEST, BEYOND_LIMIT = 1, 2, 4
SILENCE = 1.0  # s: the gateway may be held up for a moment by other work of the machine


def line_of(force):
    x, y, z, torque = force["values"]
    words = ["valid" if force["flags"] & VALID else "no force"]
    if force["flags"] & BEYOND_LIMIT:
        words.append("beyond the limit")
    if force["flags"] & TEST:
        words.append("test")
    return f"{force['sequence']} {force['robot'] or '-'} force {x:.3f} {y:.3f} {z:.3f} N torque {torque:.3f} Nm " + " ".join(words)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=0, help="end after so many changes")
    parser.add_argument("--timeout", type=float, default=0.0, metavar="SECONDS", help="end when nothing changes for so long")
    parser.add_argument("--key", type=lambda text: int(text, 0), default=cellmirror.TCP_FORCE_KEY)
    options = parser.parse_args()
    try:
        memory = cellmirror.Memory(options.key, cellmirror.TCP_FORCE_BYTES, read_only=True)
    except OSError as error:
        print(f"tcp_force_reader.py: no gateway is running: {error}", file=sys.stderr)
        return 1
    printed = last = 0
    changed = current = time.monotonic()
    while options.count == 0 or printed < options.count:
        force = cellmirror.read_tcp_force(memory)
        good = force is not None and cellmirror.is_current(force)
        if good:
            current = time.monotonic()
        if good and force["sequence"] != last:
            last = force["sequence"]
            changed = time.monotonic()
            print(line_of(force), flush=True)
            printed += 1
            continue
        if memory.removed():
            print("tcp_force_reader.py: the gateway ended", file=sys.stderr)
            return 1
        if time.monotonic() - current > SILENCE:
            print("tcp_force_reader.py: the gateway no longer writes: it was killed, or hangs", file=sys.stderr)
            return 1
        if options.timeout > 0 and time.monotonic() - changed > options.timeout:
            print("tcp_force_reader.py: no change in time", file=sys.stderr)
            return 1
        time.sleep(0.001)
    return 0


if __name__ == "__main__":
    sys.exit(main())

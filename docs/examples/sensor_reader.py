#!/usr/bin/env python3
"""Prints the robot-parameter records of a running cellmirror (ROBOT <id> send_on), one a line.

    python3 sensor_reader.py --count 10

A line: sequence robot online|offline state joint=position ... tcp x y z
A record that was read is gone from the queue: there is one reader. SPDX-License-Identifier: Apache-2.0
"""

import argparse
import errno
import signal
import struct
import sys

from cellmirror_queue import Queue

MESSAGE_TYPE = 5
KIND_ROBOT = 1
# docs/messages.md; "<" is little-endian without padding
HEADER = struct.Struct("<4sHHIIQqq")
ROBOT = struct.Struct("<64sBBHIQ14d")  # two poses: position, quaternion x y z w
JOINT = struct.Struct("<64sBB6x5d")
STATES = ("none", "fresh", "stale", "lost", "invalid")


def name(field):
    return field.split(b"\0", 1)[0].decode(errors="replace")


def robot_line(record):
    """The line of a robot record; None for anything else."""
    if len(record) < HEADER.size + ROBOT.size:
        return None
    magic, version, kind, length, _, sequence, _, _ = HEADER.unpack_from(record)
    if magic != b"CMIR" or version != 1 or kind != KIND_ROBOT or length != len(record):
        return None
    robot, online, state, joints, _, _, *poses = ROBOT.unpack_from(record, HEADER.size)
    if length != HEADER.size + ROBOT.size + joints * JOINT.size:
        return None
    words = [str(sequence), name(robot), "online" if online else "offline", STATES[state] if state < 5 else "unknown"]
    for i in range(joints):
        joint = JOINT.unpack_from(record, HEADER.size + ROBOT.size + i * JOINT.size)
        words.append(f"{name(joint[0])}={joint[3]:.6f}")
    words.append("tcp")
    words.extend(f"{value:.6f}" for value in poses[7:10])
    return " ".join(words)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=0, help="end after so many records")
    parser.add_argument("--timeout", type=float, default=0.0, metavar="SECONDS", help="end when none comes for so long")
    parser.add_argument("--key", type=lambda text: int(text, 0), default=1990)
    options = parser.parse_args()

    signal.signal(signal.SIGALRM, lambda number, frame: None)  # interrupts msgrcv
    printed = 0
    try:
        queue = Queue(options.key)
        while options.count == 0 or printed < options.count:
            signal.setitimer(signal.ITIMER_REAL, options.timeout, 0.1 if options.timeout else 0.0)
            line = robot_line(queue.receive(MESSAGE_TYPE))
            if line is not None:
                print(line, flush=True)
                printed += 1
    except OSError as error:
        why = {
            errno.ENOENT: "no gateway is running",
            errno.EIDRM: "the gateway ended",
            errno.EINTR: "no record in time",
        }.get(error.errno, str(error))
        print(f"sensor_reader.py: {why}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Prints the records of a running cellmirror, one a line.

    python3 sensor_reader.py --count 10

    sequence robot online|offline state joint=position ... tcp x y z     ROBOT <id> send_on
    sequence range sensor DISTANCE|nothing|blind|doubt [object]          SET_USSPAR active
    sequence ranges PART/PARTS sensor=DISTANCE|nothing|blind|doubt ...   SET_USSPAR sendmode 1
    sequence camera NAME tracks FRAME|free mirrored|simulated pan P tilt T distance D fovy F   CAM_ONLINE
    sequence proximity touching N warning N of TESTED pairs: a|b=DISTANCE|touching ...
    sequence event NUMBER CHANGE a b DISTANCE
    sequence tissue NUMBER KIND robot|- object|- part|- VALUE at x y z
    sequence barrier NAME interrupted|free|doubt COUNT object|-

A record that was read is gone from the queue: there is one reader. SPDX-License-Identifier: Apache-2.0
"""

import argparse
import errno
import signal
import struct
import sys

from cellmirror_queue import Queue

MESSAGE_TYPE = 5
# docs/messages.md; "<" is little-endian without padding
HEADER = struct.Struct("<4sHHIIQqq")
ROBOT = struct.Struct("<64sBBHIQ14d")  # two poses: position, quaternion x y z w
JOINT = struct.Struct("<64sBB6x5d")
RANGE = struct.Struct("<64s128s7dI4x")  # distance, range, blind zone, half angle, point; flags
RANGES = struct.Struct("<4H")  # part, parts, count, total
RANGE_ENTRY = struct.Struct("<64s5dI4x")  # distance, range, point; flags
CAMERA = struct.Struct("<64s128s18dI4x")  # pose, mount, pan, tilt, focal distance, fovy; flags
PROXIMITY = struct.Struct("<Q2d5IH2x")  # tested, touching, within warning, doubts, found; pairs
PAIR = struct.Struct("<128s128s13d2Id")  # distance, depth, points, normal, closing speed, time to contact; flags; contact age
EVENT = struct.Struct("<QB7xd128s128s")
TISSUE_EVENT = struct.Struct("<QBB6x4d64s64s64s")  # event, kind, limit; value, place; robot, object, part
BARRIER = struct.Struct("<64s128sQI4x")  # name, object, interruptions; flags
STATES = ("none", "fresh", "stale", "lost", "invalid")
CHANGES = ("entered_warning", "touched", "parted", "left_warning")
DEEDS = ("grip", "release", "slip", "clip", "cut", "coagulate", "tear", "bleed", "bleed_end", "limit")
CAMERA_TRACKING, CAMERA_MIRRORED = 1, 2
RANGE_SEEN, RANGE_IN_BLIND_ZONE, RANGE_DOUBTFUL, PAIR_TOUCHING = 1, 2, 4, 1
BARRIER_INTERRUPTED, BARRIER_DOUBTFUL = 1, 2


def name(field):
    return field.split(b"\0", 1)[0].decode(errors="replace")


def word(words, number):
    return words[number] if number < len(words) else "unknown"


def robot(payload):
    robot_id, online, state, joints, _, _, *poses = ROBOT.unpack_from(payload)
    words = [name(robot_id), "online" if online else "offline", word(STATES, state)]
    for joint in JOINT.iter_unpack(payload[ROBOT.size : ROBOT.size + joints * JOINT.size]):
        words.append(f"{name(joint[0])}={joint[3]:.6f}")
    return words + ["tcp"] + [f"{value:.6f}" for value in poses[7:10]]


def reading(distance, flags):
    if flags & RANGE_DOUBTFUL:
        return "doubt"
    if not flags & RANGE_SEEN:
        return "nothing"
    return "blind" if flags & RANGE_IN_BLIND_ZONE else f"{distance:.6f}"


def single_range(payload):
    sensor, seen, distance, *_, flags = RANGE.unpack(payload)
    return ["range", name(sensor), reading(distance, flags)] + ([name(seen)] if name(seen) else [])


def ranges(payload):
    part, parts, _, _ = RANGES.unpack_from(payload)
    entries = RANGE_ENTRY.iter_unpack(payload[RANGES.size :])
    return ["ranges", f"{part}/{parts}"] + [f"{name(entry[0])}={reading(entry[1], entry[6])}" for entry in entries]


def camera(payload):
    camera_id, tracks, *numbers, flags = CAMERA.unpack(payload)
    words = ["camera", name(camera_id)] + (["tracks", name(tracks)] if flags & CAMERA_TRACKING else ["free"])
    words.append("mirrored" if flags & CAMERA_MIRRORED else "simulated")
    for what, number in zip(("pan", "tilt", "distance", "fovy"), numbers[14:]):
        words += [what, f"{number:.6f}"]
    return words


def proximity(payload):
    _, _, _, tested, touching, warning, _, _, _ = PROXIMITY.unpack_from(payload)
    words = f"proximity touching {touching} warning {warning} of {tested} pairs:".split()
    for a, b, distance, *_, flags, _, _ in PAIR.iter_unpack(payload[PROXIMITY.size :]):
        words.append(f"{name(a)}|{name(b)}=" + ("touching" if flags & PAIR_TOUCHING else f"{distance:.6f}"))
    return words


def event(payload):
    number, change, distance, a, b = EVENT.unpack(payload)
    return ["event", str(number), word(CHANGES, change), name(a), name(b), f"{distance:.6f}"]


def tissue(payload):
    number, kind, _, value, x, y, z, *texts = TISSUE_EVENT.unpack(payload)
    words = ["tissue", str(number), word(DEEDS, kind)] + [name(text) or "-" for text in texts]
    return words + [f"{value:.6f}", "at"] + [f"{place:.6f}" for place in (x, y, z)]


def barrier(payload):
    barrier_id, seen, interruptions, flags = BARRIER.unpack(payload)
    state = "doubt" if flags & BARRIER_DOUBTFUL else "interrupted" if flags & BARRIER_INTERRUPTED else "free"
    return ["barrier", name(barrier_id), state, str(interruptions), name(seen) or "-"]


KINDS = {1: robot, 2: single_range, 3: ranges, 4: camera, 5: proximity, 6: event, 7: tissue, 8: barrier}


def record_line(record):
    """The line of a record; None for anything else."""
    if len(record) < HEADER.size:
        return None
    magic, version, kind, length, _, sequence, _, _ = HEADER.unpack_from(record)
    if magic != b"CMIR" or version != 1 or kind not in KINDS or length != len(record):
        return None
    try:
        return " ".join([str(sequence)] + KINDS[kind](record[HEADER.size :]))
    except struct.error:  # not as long as its kind is
        return None


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
            line = record_line(queue.receive(MESSAGE_TYPE))
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

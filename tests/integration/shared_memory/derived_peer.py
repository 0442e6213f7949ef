"""derived_peer.c in Python, by way of docs/examples/cellmirror_memory.py (first argument: that folder)."""

import os
import sys
import time

sys.path.insert(0, sys.argv[1])
import cellmirror_memory as cellmirror  # noqa: E402


def is_derived(values):
    floats, numbers, doubles = values[:19], values[25:31], values[31:]
    sequence = numbers[0]
    value = float(sequence % 4096)
    return (
        numbers == (sequence, sequence, sequence, sequence, sequence & 0xFFFFFFFF, sequence & 0xFFFFFFFF)
        and all(number == value for number in floats)
        and all(number == value for number in doubles)
    )


def read_all(memory, last, many):
    whole = retried = inconsistent = sequence = 0
    end = time.monotonic() + 300
    print("ready", flush=True)
    while sequence < last and time.monotonic() < end:
        copy, tries = memory.read(0, cellmirror.FORCE.size, cellmirror.FORCE_LOCK)
        retried += tries - 1
        if copy is None:
            continue
        values = cellmirror.FORCE.unpack(copy)
        if values[25] != 0:
            if values[25] == sequence:
                os.sched_yield()
            elif (whole := whole + 1) == many:
                print("enough", flush=True)
            inconsistent += values[25] < sequence or not is_derived(values)
            sequence = values[25]
    print(f"whole {whole} retried {retried} inconsistent {inconsistent} last {sequence}")


def write_all(memory, last):
    for i in range(1, last + 1):
        value = float(i)
        cellmirror.write_sample(memory, i, i, (value,) * 3, (value,) * 4, i & 0xFFFFFFFF, value, (value,) * 7)


_, _, what, key, last, *many = sys.argv
memory = cellmirror.Memory(int(key, 0), cellmirror.HAPTIC_BYTES, read_only=what == "read")
(read_all if what == "read" else write_all)(memory, int(last), *map(int, many))

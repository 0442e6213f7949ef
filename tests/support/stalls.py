"""Runs a command as on a machine that stalls: every few seconds all its processes stand still for one to two seconds.

    python3 tests/support/stalls.py [--busy N] ctest --test-dir build -R '^gateway_' --output-on-failure

--busy: so many programs beside it that take all of the processor that they get. Processes that have stopped themselves, or
that a test has stopped, are left alone. STALLS_SEED: another sequence of instants. Exit status: that of the command."""

import argparse
import contextlib
import os
import pathlib
import random
import signal
import subprocess
import sys
import time

BETWEEN_S, LONG_S = (2.5, 7.0), (1.0, 1.8)


def processes():
    """{process: (parent, state)} of all that can be read."""
    found = {}
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):
            state, parent = stat.read_text(errors="replace").rsplit(")", 1)[1].split()[:2]
            found[int(stat.parent.name)] = (int(parent), state)
    return found


def descendants(root):
    """Those that run or sleep, parents first."""
    known, children = processes(), {}
    for process, (parent, _) in known.items():
        children.setdefault(parent, []).append(process)
    todo, out = [root], []
    while todo:
        process = todo.pop()
        if process in known and known[process][1] not in "TtZX":
            out.append(process)
        todo += children.get(process, [])
    return out


def tell(those, number):
    for process in those:
        with contextlib.suppress(ProcessLookupError):
            os.kill(process, number)


def main():
    parser = argparse.ArgumentParser(description="Runs a command as on a machine that stalls.")
    parser.add_argument("--busy", type=int, default=0, metavar="N")
    parser.add_argument("command", nargs=argparse.REMAINDER)
    options = parser.parse_args()
    if not options.command:
        parser.error("give a command")
    chance = random.Random(int(os.environ.get("STALLS_SEED", "1")))
    busy = [subprocess.Popen(["sh", "-c", "while :; do :; done"]) for _ in range(options.busy)]
    child = subprocess.Popen(options.command)
    try:
        while child.poll() is None:
            time.sleep(chance.uniform(*BETWEEN_S))
            those = descendants(child.pid)
            try:
                tell(those, signal.SIGSTOP)
                time.sleep(chance.uniform(*LONG_S))
            finally:
                tell(reversed(those), signal.SIGCONT)
    finally:
        for one in busy:
            one.kill()
            one.wait()
    return child.returncode


if __name__ == "__main__":
    sys.exit(main())

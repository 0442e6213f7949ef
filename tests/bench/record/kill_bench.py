#!/usr/bin/python3
"""What a killed gateway leaves: `kill -9` at random moments of a recording, and a recording cut off at random bytes.

    tests/bench/record/kill_bench.py [KILLS [CUTS]]

For each kill: the seconds between the last message that the gateway had taken and the last one in the file, whether the file is
readable as it is, and whether `recover` makes a whole one of it. For each cut: the same of the file up to that byte, where the loss is
counted from the last message that begins before it."""

import json
import pathlib
import random
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tests" / "support")]
import gateway as g  # noqa: E402


def run(scratch, *arguments):
    return scratch.cellmirror("recording", *[str(one) for one in arguments])


def repaired(scratch, file):
    """(readable as it is, end of the last message in ns, whole after recover)"""
    info = run(scratch, "info", file, "--json")
    copy = file.with_suffix(".recovered")
    copy.unlink(missing_ok=True)
    recovered = run(scratch, "recover", file, "-o", copy, "--compression", "none")
    whole = recovered.returncode == 0 and run(scratch, "check", copy).returncode == 0
    copy.unlink(missing_ok=True)
    readable = info.returncode == 0
    document = json.loads(info.stdout) if readable else {}
    return readable, document.get("end_ns", 0), whole


def kills(count):
    lost, readable, whole = [], 0, 0
    for number in range(count):
        scratch = g.Scratch()
        gateway = g.Gateway(scratch)
        file = scratch.root / "a.mcap"
        recorder = g.Process([g.BIN / "cellmirror", "record", "-o", file, "--instance", scratch.instance], scratch.environment)
        g.eventually(lambda: file.exists() and file.stat().st_size > 0)
        begun_ns = time.time_ns()  # a file without messages has lost what came since
        time.sleep(random.uniform(0.2, 1.5))
        killed_ns = time.time_ns()
        gateway.kill()
        good, end_ns, repaired_whole = repaired(scratch, file)
        readable += good
        whole += repaired_whole
        lost.append((killed_ns - max(begun_ns, end_ns)) / 1e9)
        recorder.close()
        gateway.close()
        scratch.remove()
    lost.sort()
    print(f"{count} kills: lost {lost[len(lost) // 2]:.2f} s (median), {lost[-1]:.2f} s at most; {readable} readable as they were, "
          f"{whole} whole after recover")


def cuts(count):
    scratch = g.Scratch()
    gateway = g.Gateway(scratch)
    file = scratch.root / "a.mcap"
    done = scratch.cellmirror("record", "-o", str(file), "--for", "4", "--instance", scratch.instance)
    assert done.returncode == 0, done.stderr
    gateway.close()
    done = subprocess.run([g.BIN / "record_cuts", file, str(count)], capture_output=True, text=True)
    print(done.stdout.strip() or done.stderr)
    scratch.remove()


def main():
    numbers = [int(one) for one in sys.argv[1:]] + [20, 1000][len(sys.argv) - 1:]
    kills(numbers[0])
    cuts(numbers[1])


if __name__ == "__main__":
    main()

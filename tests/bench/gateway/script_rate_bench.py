#!/usr/bin/python3
"""Commands a second that the running gateway executes from a file: POS_ROB on a simulated robot that is put
to its places at once (rob_positioning jump), a goal of 100,000.

  script_rate_bench.py [COMMANDS=400000]
"""

import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import gateway as g  # noqa: E402

GOAL = 100_000


def main():
    pairs = int(sys.argv[1]) // 2 if len(sys.argv) > 1 else 200_000
    scratch = g.Scratch()
    (scratch.home / "scripts" / "rate.spt").write_text(
        "ROBACT PUMA_762;\nrob_positioning jump;\n" + "POS_ROB PUMA_762 JOINT_INC 0.001;\nPOS_ROB PUMA_762 JOINT_INC -0.001;\n" * pairs)
    gateway = g.Gateway(scratch)
    try:
        before = scratch.status()["script"]["done"]
        start = time.monotonic()
        scratch.send("EXEC_SCRIPT rate.spt")
        while scratch.status()["script"]["done"] - before < 2 * pairs:
            if time.monotonic() - start > 120:
                raise SystemExit("not done within two minutes")
        seconds = time.monotonic() - start
        loop = scratch.status()["loop"]
        print(f"{2 * pairs} commands in {seconds:.2f} s: {2 * pairs / seconds:.0f} a second (goal: {GOAL}); "
              f"tick p99 {loop['compute_us']['p99']:.0f} us, missed {loop['missed']} of {loop['ticks']}, "
              f"allocations in ticks {loop['allocations']}")
    finally:
        gateway.stop()
        gateway.close()
        scratch.remove()


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""From ./run to the first mirrored sample, with packages installed and everything built. Goal: under two seconds."""

import json
import os
import pathlib
import signal
import subprocess
import time

ROOT = pathlib.Path(__file__).resolve().parents[3]
GOAL_S = 2.0


def first_sample():
    """Whether a robot of the demo has a fresh stream."""
    done = subprocess.run([ROOT / "build/bin/cellmirror", "status", "--json"], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return False
    return any(robot["stream"]["state"] == "fresh" for robot in json.loads(done.stdout)["robots"])


def main():
    subprocess.run([ROOT / "run", "--build-only"], check=True, capture_output=True)
    start = time.monotonic()
    demo = subprocess.Popen([ROOT / "run"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=dict(os.environ))
    try:
        while not first_sample():
            if time.monotonic() - start > 30:
                raise SystemExit("no mirrored sample within 30 s")
            time.sleep(0.01)
        seconds = time.monotonic() - start
        print(f"first mirrored sample after {seconds:.2f} s (goal: under {GOAL_S} s)")
    finally:
        demo.send_signal(signal.SIGINT)
        demo.wait()


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Makes the figure recorded_joints.png: the running demo with its simulated devices, recorded for 20 s, and a chart of the file.

    python3 tests/support/recording_figure.py FILE

No other simulated devices may run meanwhile: they would send to the same addresses.
"""

import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "bench" / "web")]
import gateway as g  # noqa: E402
from first_picture_bench import simulators  # noqa: E402


def main():
    scratch = g.Scratch("transfer_cell", startup=True)
    devices = simulators("transfer_cell")
    gateway = g.Gateway(scratch)
    try:
        file = scratch.root / "demo.mcap"
        done = scratch.cellmirror("record", "-o", str(file), "--for", "20", "--instance", scratch.instance, timeout=60)
        assert done.returncode == 0, done.stderr
        done = scratch.cellmirror("recording", "plot", str(file), "--topic", "/joint_states", "--fields",
                                  "position[MANTEC_R3],position[PUMA_762]", "-o", sys.argv[1])
        assert done.returncode == 0, done.stderr
        print(done.stdout, end="")
    finally:
        gateway.close()
        for device in devices:
            device.close()
        scratch.remove()


if __name__ == "__main__":
    main()

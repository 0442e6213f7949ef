#!/usr/bin/python3
"""DDS sample in to DDS sample out through the running gateway, its 1 kHz tick included.

  dds_round_trip_bench.py [ROUNDS=2000]

Goal: median at most 1.3 times a bare Fast DDS echo (build/bin/dds_echo_bench, run in turn) plus one period.
"""

import json
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
ROUNDS = sys.argv.pop(1) if len(sys.argv) > 1 else "2000"  # load_bench reads its own arguments
import gateway as g  # noqa: E402
import load_bench  # noqa: E402

DOMAIN = 77
PERIOD_US = 1000.0
CELL = f"""format = 1
name = "echo"
[dds_output]
domain = {DOMAIN}
rate_hz = 1000
[startup]
script = "startup.spt"
[[node]]
name = "N"
abstract = "arm.mpc"
robot_id = "R"
[[stream]]
robot = "R"
kind = "dds"
domain = {DOMAIN}
topic = "rt/in"
joint = [{", ".join(f'{{ joint = "J_{j}", ros_name = "J_{j}" }}' for j in range(1, load_bench.JOINTS + 1))}]
"""


def main():
    rounds = ROUNDS
    scratch = g.Scratch(startup=True)
    (scratch.home / "envlib" / "arm.mpc").write_text(load_bench.ARM)
    (scratch.home / "scripts" / "startup.spt").write_text("ROBOT R online;\nROBOT R send_on;\n")
    (scratch.home / "cell.toml").write_text(CELL)
    gateway = g.Gateway(scratch)
    try:
        client = subprocess.run([g.BIN / "dds_client", str(DOMAIN), "rt/in", "rt/cellmirror/joint_states", rounds],
                                capture_output=True, text=True, check=True)
    finally:
        gateway.stop()
        gateway.close()
        scratch.remove()
    through = json.loads(client.stdout)
    echo = subprocess.run([g.BIN / "dds_echo_bench", rounds, "1000"], capture_output=True, text=True, check=True).stdout
    bare = float(re.search(r"bare_udp\s+median\s+([\d.]+)", echo)[1])
    goal = 1.3 * bare + PERIOD_US
    print(f"through the gateway: median {through['median_us']:.0f} us, p99 {through['p99_us']:.0f} us, missed {through['missed']}; "
          f"bare echo: median {bare:.0f} us; over (1.3 bare + one period): {through['median_us'] / goal:.2f} (goal: at most 1)")


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Drives that the running gateway answers for ([[device]]), in cyclic synchronous position: 32 at 250 Hz unless said otherwise.

  device_load_bench.py [--channel udp:GROUP:PORT | socketcan:INTERFACE] [--echo CHANNEL]
                       [--nodes N] [--rate HZ] [SECONDS=60]

The master is build/bin/device_load. Prints how long after SYNC the TPDOs came, how long SDO answers took, the raw echo of such a
channel in the same run, SYNCs without all answers, and the gateway's processor time. Goals: no SYNC missed; SYNC to TPDO p99 at most
150 us beyond the raw echo; SDO p99 at most 1 ms; a target is motion after one period. For vcan: in User-Mode Linux with 2.5 GB
(tests/support/run-in-vcan.sh has less).
"""

import argparse
import pathlib
import shutil
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import gateway as g  # noqa: E402

JOINTS = 4  # of a robot
parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("seconds", nargs="?", type=float, default=60.0)
parser.add_argument("--channel", default="udp:239.74.163.23:43951")
parser.add_argument("--echo", help="the channel of the raw echo; else the port behind that of CHANNEL, or vcan1")
parser.add_argument("--nodes", type=int, default=32)
parser.add_argument("--rate", type=int, default=250)
OPTIONS = parser.parse_args()

ARM = "format = 1\n" + "".join(
    f'[[node]]\nname = "J_{j}"\n' + (f'parent = "J_{j - 1}"\n' if j > 1 else "") + 'xyz_m = [0.0, 0.0, 0.2]\n'
    f'joint = {{ type = "revolute", axis = [0, {j % 2}, {(j + 1) % 2}], range_rad = [-300, 300], velocity_rad_s = 30.0, '
    'acceleration_rad_s2 = 100.0 }\n'
    for j in range(1, JOINTS + 1)) + f'[[node]]\nname = "FLANGE"\nparent = "J_{JOINTS}"\n[robot]\nid = "ARM"\nflange = "FLANGE"\n'


def device(robot, numbers):
    nodes = "".join(f'[[device.node]]\nid = {number}\njoint = "J_{joint}"\nencoder_increments = 65536\n'
                    for joint, number in enumerate(numbers, start=1))
    return f'[[device]]\nrobot = "R{robot}"\nprotocol = "cia402"\nchannel = "{OPTIONS.channel}"\n{nodes}'


def write_cell(home):
    for old in home.iterdir():
        shutil.rmtree(old) if old.is_dir() else old.unlink()
    for folder in ("envlib", "scripts"):
        (home / folder).mkdir()
    numbers = [list(range(first, min(first + JOINTS, OPTIONS.nodes + 1))) for first in range(1, OPTIONS.nodes + 1, JOINTS)]
    (home / "envlib" / "arm.mpc").write_text(ARM)
    (home / "scripts" / "startup.spt").write_text("".join(f"ROBOT R{robot} online;\n" for robot in range(len(numbers))))
    (home / "cell.toml").write_text('format = 1\nname = "drives"\n[startup]\nscript = "startup.spt"\n' + "".join(
        f'[[node]]\nname = "N{robot}"\nabstract = "arm.mpc"\nrobot_id = "R{robot}"\nxyz_m = [{robot}.0, 0.0, 0.0]\n'
        for robot in range(len(numbers))) + "".join(device(robot, its) for robot, its in enumerate(numbers)))
    return len(numbers)


def echo_channel():
    if OPTIONS.echo or not OPTIONS.channel.startswith("udp:"):
        return OPTIONS.echo or "socketcan:vcan1"
    group, port = OPTIONS.channel.rsplit(":", 1)
    return f"{group}:{int(port) + 1}"


def processor_s(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / 100


def main():
    scratch = g.Scratch(startup=True)
    robots = write_cell(scratch.home)
    gateway = g.Gateway(scratch)
    try:
        assert g.eventually(lambda: scratch.status()["script"]["done"] >= robots), gateway.output()
        cpu, start = processor_s(gateway.child.pid), time.monotonic()
        done = subprocess.run([g.BIN / "device_load", OPTIONS.channel, echo_channel(), str(OPTIONS.nodes), str(OPTIONS.rate), str(OPTIONS.seconds)],
                              capture_output=True, text=True, timeout=OPTIONS.seconds + 60)
        cores = (processor_s(gateway.child.pid) - cpu) / (time.monotonic() - start)
        print(f"{OPTIONS.nodes} drives of {robots} robots at {OPTIONS.rate} Hz on {OPTIONS.channel} for {OPTIONS.seconds:g} s\n{done.stdout}{done.stderr}", end="")
        loop = scratch.status()["loop"]
        print(f"gateway: {cores:.2f} cores; wake-up p99 {loop['wakeup_us']['p99']} us" if "wakeup_us" in loop else f"gateway: {cores:.2f} cores")
        return done.returncode
    finally:
        gateway.close()
        scratch.remove()


if __name__ == "__main__":
    sys.exit(main())

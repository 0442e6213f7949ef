#!/usr/bin/python3
"""Many robots into the running gateway, over DDS or as CAN FD frames over udp: 32 of seven joints at 500 Hz unless said otherwise.

  load_bench.py dds|can [SECONDS=60] [--robots N] [--joints N] [--rate HZ] [--record none|lz4|zstd]

Prints what was sent, what arrived in the tick, what was lost anywhere inside, the processor time of the gateway over
wall time, and its largest resident memory. Goals: nothing lost, under one core, under 200 MB. With --record a recording goes
on all the time: what was dropped, its size beside that of the uncompressed one, and the processor time of the threads that
record. Goals: nothing dropped, under 0.3 cores, with lz4 at most 40 %.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import gateway as g  # noqa: E402

BUSES, FIRST_PORT = 8, 43900
CLOCK_TICKS = os.sysconf("SC_CLK_TCK")

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("kind", nargs="?", choices=("dds", "can"), default="dds")
parser.add_argument("seconds", nargs="?", type=float, default=60.0)
parser.add_argument("--robots", type=int, default=32)
parser.add_argument("--joints", type=int, default=7)
parser.add_argument("--rate", type=int, default=500)
parser.add_argument("--record", choices=("none", "lz4", "zstd"))
OPTIONS = parser.parse_args()
ROBOTS, JOINTS, RATE = OPTIONS.robots, OPTIONS.joints, OPTIONS.rate

ARM = "format = 1\n" + "".join(
    f'[[node]]\nname = "J_{j}"\n' + (f'parent = "J_{j - 1}"\n' if j > 1 else "") + 'xyz_m = [0.0, 0.0, 0.2]\n'
    f'joint = {{ type = "revolute", axis = [0, {j % 2}, {(j + 1) % 2}], range_rad = [-3.2, 3.2], velocity_rad_s = 3.0, '
    'acceleration_rad_s2 = 10.0 }\n'
    for j in range(1, JOINTS + 1)) + f'[[node]]\nname = "FLANGE"\nparent = "J_{JOINTS}"\n[robot]\nid = "ARM"\nflange = "FLANGE"\n'


def stream(kind, robot):
    head = f'[[stream]]\nrobot = "R{robot}"\n'
    if kind == "dds":
        joints = ", ".join(f'{{ joint = "J_{j}", ros_name = "robot{robot + 1}_joint_{j}" }}' for j in range(1, JOINTS + 1))
        return head + f'kind = "dds"\ntopic = "rt/joint_states"\nreliable = true\njoint = [{joints}]\n'
    signals = ", ".join(f'{{ message = "M{robot}", signal = "J{j}", joint = "J_{j}", scale = 0.0001 }}' for j in range(1, JOINTS + 1))
    return head + (f'kind = "can-dbc"\nchannel = "udp:239.74.163.2:{FIRST_PORT + robot % BUSES}"\nfd = true\ndbc = "load.dbc"\n'
                   f'signal = [{signals}]\n')


def write_cell(home, kind):
    for old in home.iterdir():
        subprocess.run(["rm", "-rf", str(old)], check=True)
    for folder in ("envlib", "robots", "scripts"):
        (home / folder).mkdir()
    (home / "envlib" / "arm.mpc").write_text(ARM)
    (home / "robots" / "load.dbc").write_text("".join(
        f"BO_ {0x100 + robot} M{robot}: 16 X\n" + "".join(f' SG_ J{j} : {16 * (j - 1)}|16@1- (1,0) [0|0] "" X\n' for j in range(1, JOINTS + 1))
        for robot in range(ROBOTS)))
    (home / "scripts" / "startup.spt").write_text("".join(f"ROBOT R{robot} online;\n" for robot in range(ROBOTS)))
    (home / "cell.toml").write_text(
        'format = 1\nname = "load"\n[startup]\nscript = "startup.spt"\n' + "".join(
            f'[[node]]\nname = "N{robot}"\nabstract = "arm.mpc"\nrobot_id = "R{robot}"\nxyz_m = [{robot}.0, 0.0, 0.0]\n'
            for robot in range(ROBOTS)) + "".join(stream(kind, robot) for robot in range(ROBOTS)))


def processor_s(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / CLOCK_TICKS


def recording_s(pid):
    """Processor time of the threads that record."""
    ticks = 0
    for task in pathlib.Path(f"/proc/{pid}/task").iterdir():
        if (task / "comm").read_text().strip() in ("recorder", "recording"):
            fields = (task / "stat").read_text().rsplit(")", 1)[1].split()
            ticks += int(fields[11]) + int(fields[12])
    return ticks / CLOCK_TICKS


class Recording:
    """Of the whole load, where one is wanted."""

    def __init__(self, scratch, pid):
        self.scratch, self.pid, self.child = scratch, pid, None
        if OPTIONS.record is None:
            return
        self.file = scratch.root / "load.mcap"
        self.child = g.Process([g.BIN / "cellmirror", "record", "-o", self.file, "--compression", OPTIONS.record, "--instance",
                                scratch.instance], scratch.environment)
        g.eventually(lambda: self.file.exists() and self.file.stat().st_size > 0)
        self.cpu, self.start = recording_s(pid), time.monotonic()

    def report(self):
        if self.child is None:
            return
        cores = (recording_s(self.pid) - self.cpu) / (time.monotonic() - self.start)
        self.child.stop(timeout=60)
        self.child.close()
        info = json.loads(self.scratch.cellmirror("recording", "info", str(self.file), "--json").stdout)
        dropped = {topic["topic"]: topic["dropped"] for topic in info["topics"] if topic["dropped"]}
        raw = info["uncompressed_bytes"]
        print(f"recording: {cores:.3f} cores, {info['messages']} messages, dropped {dropped or 0}; {info['bytes'] / 1e6:.1f} MB, "
              f"{100 * info['bytes'] / raw:.0f} % of {raw / 1e6:.1f} MB uncompressed")
        for topic in sorted(info["topics"], key=lambda one: -one["messages"])[:4]:
            print(f"  {topic['topic']}: {topic['messages']} messages")


def memory_mb(pid):
    line = next(line for line in pathlib.Path(f"/proc/{pid}/status").read_text().splitlines() if line.startswith("VmHWM"))
    return int(line.split()[1]) / 1024


def load(kind, seconds):
    if kind == "can":
        return [g.BIN / "can_load", ROBOTS, BUSES, RATE, seconds, FIRST_PORT]
    return [g.BIN / "sim_robot", "dds", "--robots", ROBOTS, "--joints", JOINTS, "--rate", RATE, "--for", seconds, "--spread", 8,
            "--wait-for-reader", 10, "--no-input", "--json"]


def main():
    kind, seconds = OPTIONS.kind, OPTIONS.seconds
    scratch = g.Scratch(startup=True)
    write_cell(scratch.home, kind)
    gateway = g.Gateway(scratch)
    try:
        g.eventually(lambda: scratch.status()["script"]["done"] >= ROBOTS)
        recording = Recording(scratch, gateway.child.pid)
        pids = [gateway.child.pid] + [one["pid"] for one in scratch.status().get("processes", [])]
        before, start = [processor_s(pid) for pid in pids], time.monotonic()
        done = subprocess.run([str(part) for part in load(kind, seconds)], capture_output=True, text=True, check=True)
        wall = time.monotonic() - start
        cores = [(processor_s(pid) - then) / wall for pid, then in zip(pids, before)]
        time.sleep(1)
        status = scratch.status()
        sent = json.loads(done.stdout)
        streams = [robot["stream"] for robot in status["robots"]]
        queues = [queue for queue in status["queues"] if queue["name"].startswith("samples")]
        received = sum(stream["received"] for stream in streams)
        print(f"{kind}: sent {json.dumps(sent)[:300]}")
        print(f"received {received} ({received / seconds:.0f} a second), lost on the way in {sum(s['lost'] for s in streams)}, "
              f"rejected {sum(s['rejected'] for s in streams)}, dropped inside {sum(q['dropped'] for q in queues)}, "
              f"taken by the tick {sum(q['passed'] for q in queues)}")
        loop = status["loop"]
        print(f"gateway: {sum(cores):.2f} cores ({' + '.join(f'{one:.2f}' for one in cores)}: itself and its confined processes), "
              f"{' + '.join(f'{memory_mb(pid):.0f}' for pid in pids)} MB; tick p99 {loop['compute_us']['p99']:.0f} us, "
              f"wake-up p99 {loop['wakeup_latency_us']['p99']:.0f} us, missed {loop['missed']} of {loop['ticks']}, "
              f"allocations in ticks {loop['allocations']}")
        recording.report()
    finally:
        gateway.stop()
        gateway.close()
        scratch.remove()


if __name__ == "__main__":
    main()

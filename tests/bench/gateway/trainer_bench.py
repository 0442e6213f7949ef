#!/usr/bin/python3
"""The trainer cell with two hands and feet at work, pictures 15 times a second beside it, and the same without tissue;
the latter also with a program that does the same work of a step's length each millisecond, at the simulation's priority:
how far its 99th percentile is above its median is what the machine adds.

  trainer_bench.py [SECONDS=30] [--rate PICTURES_A_SECOND] [--film F.mp4]

Prints the time of a tissue step, from a pose to the force that the tissue gives back, the loop's wake-up with and
without tissue in turn, and the processor time of the gateway. Goals: step p99 0.3 ms, pose to force p99 2 ms, wake-up
ratio 1.
"""

import argparse
import json
import os
import pathlib
import re
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import gateway as g  # noqa: E402
import trainer as t  # noqa: E402

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("seconds", nargs="?", type=float, default=30.0)
parser.add_argument("--rate", type=float, default=15.0)
parser.add_argument("--film", type=pathlib.Path, help="keep the film of the laparoscope")
OPTIONS = parser.parse_args()
CLOCK_TICKS = os.sysconf("SC_CLK_TCK")
SIMULATORS = [line.split() for line in (g.CELLS / "trainer" / "simulators.txt").read_text().splitlines()
              if line.strip() and not line.startswith("#")]
KEYS = {"LAP_LEFT": "LAP_LEFT", "LAP_RIGHT": "LAP_RIGHT", "PEDALS": "switches"}


def without_tissue(scratch):
    text = scratch.cell_file.read_text()
    text = re.sub(r"(?ms)^\[\[deformable\]\]$.*?(?=^\[)", "", text)
    scratch.cell_file.write_text(re.sub(r"(?ms)^\[tissue\]$.*?(?=^\[|^# ---)", "", text))
    for script in (scratch.home / "scripts").glob("*.spt"):
        commands = [line.rstrip("; ") for line in script.read_text().splitlines() if line.strip() and not line.startswith("#")]
        kept = [one for one in commands if not re.match(r"(eladyn|ela_clip|rob_ela|EFFECTS|EXEC_SCRIPT (tissue|reset|tool))", one)]
        script.write_text(";\n".join(kept) + "\n" if kept else "# nothing\n")


def cpu_s(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(") ", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / CLOCK_TICKS


# Below the loop, as the gateway does it.
TISSUE_PRIORITY = 60


def measure(tissue, work_us=None):
    scratch = g.Scratch("trainer", startup=True)
    hands = []
    try:
        keys = t.with_own_memories(scratch)
        if not tissue:
            without_tissue(scratch)
        gateway = g.Gateway(scratch, pictures=True)
        try:
            for name, program, *rest in SIMULATORS:
                rest[rest.index("--key") + 1] = str(keys[KEYS[name]])
                hands.append(subprocess.Popen([str(g.BIN / program), *rest, "--no-input", "--quiet"]))
            work = None
            if work_us:
                work = subprocess.Popen([str(g.BIN / "rt_fixed_work"), str(max(1, round(OPTIONS.seconds) - 2)), str(TISSUE_PRIORITY), str(work_us)],
                                        stdout=subprocess.PIPE, text=True)
                hands.append(work)
            before, start = cpu_s(gateway.child.pid), time.monotonic()
            film = OPTIONS.film if tissue and OPTIONS.film else scratch.root / "film.mjpeg"
            done = subprocess.run(
                [str(g.BIN / "cellmirror"), "snapshot", "--instance", scratch.instance, "--camera", "LAPAROSCOPE", "--size", "640x480",
                 "--film", str(film), "--seconds", str(OPTIONS.seconds), "--rate", str(OPTIONS.rate)],
                env=scratch.environment, capture_output=True, text=True, timeout=OPTIONS.seconds + 60)
            if done.returncode != 0:
                raise SystemExit(done.stderr)
            cores = (cpu_s(gateway.child.pid) - before) / (time.monotonic() - start)
            fixed = json.loads(work.communicate(timeout=30)[0]) if work else None
            return scratch.status(), cores, done.stdout.strip(), fixed
        finally:
            for hand in hands:
                hand.kill()
                hand.wait()
            gateway.close()
    finally:
        scratch.remove()


plain, plain_cores, _, _ = measure(False)
full, full_cores, film_line, _ = measure(True)
tissue = full["tissue"]
_, _, _, fixed = measure(False, round(tissue["step_us"]["p50"]))
elements = sum(one["elements"] for one in tissue["objects"])
print(f"{elements} elements, {tissue['step']} steps with {tissue['simd']}, {tissue['late_steps']} late; {film_line}")
for key, name in (("step_us", "tissue step"), ("pose_to_force_us", "pose to force")):
    values = tissue[key]
    print(f"{name:<22} p50 {values['p50']:6.0f}  p99 {values['p99']:6.0f}  p99.9 {values['p999']:6.0f} us")
step = tissue["step_us"]
print(f"{'same work, no tissue':<22} p50 {fixed['p50']:6.0f}  p99 {fixed['p99']:6.0f}  p99.9 {fixed['p999']:6.0f} us ({fixed['scheduler']} "
      f"{fixed['priority']}): p99 over p50 {fixed['p99'] / fixed['p50']:.2f}, of the step {step['p99'] / step['p50']:.2f}")
for status, cores, name in ((plain, plain_cores, "loop without tissue"), (full, full_cores, "loop with tissue")):
    wake, tick = status["loop"]["wakeup_latency_us"], status["loop"]["compute_us"]
    print(f"{name:<22} wake-up p50 {wake['p50']:4.0f}  p99 {wake['p99']:5.0f} us, tick p99 {tick['p99']:4.0f} us, "
          f"{status['loop']['missed']} of {status['loop']['ticks']} missed, {cores:.2f} cores")
ratio = full["loop"]["wakeup_latency_us"]["p99"] / plain["loop"]["wakeup_latency_us"]["p99"]
print(f"wake-up p99 with tissue over without: {ratio:.2f}")
for device in full["haptics"]["devices"]:
    print(f"{device['robot']}: device to force p99 {device['latency_us']['p99']:.0f} us, contact model {device['contact_model']['age_s'] * 1e3:.1f} ms old, "
          f"fault {device['fault']}, tissue late {device['tissue']['late']}")
counts = tissue["events"]["counts"]
print("events: " + ", ".join(f"{kind} {count}" for kind, count in counts.items() if count))

#!/usr/bin/python3
"""The transfer cell with all its robots moving and pictures beside, without and with a voxel volume in the picture.

  volume_bench.py [SECONDS=20] [--rate PICTURES_A_SECOND=15] [--times N=4]

The volume is that of volume_cell with each voxel N times along each axis (448 x 352 x 384 voxels with 4). The camera
moves, so that each picture is cast anew. Prints the loop's wake-up and the age of collisions of both runs and their
ratios. Goal: 1, so that a volume costs neither.
"""

import argparse
import array
import gzip
import pathlib
import random
import re
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import gateway as g  # noqa: E402

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import findings_age_bench as findings  # noqa: E402

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("seconds", nargs="?", type=float, default=20.0)
parser.add_argument("--rate", type=float, default=15.0)
parser.add_argument("--times", type=int, default=4)
OPTIONS = parser.parse_args()
VOLUME = g.CELLS / "volume_cell" / "envlib"


def enlarged(head, voxels, times):
    """NRRD with each voxel `times` times along each axis; 16 bit, little endian."""
    size = [int(n) for n in head["sizes"].split()]
    values = array.array("h", voxels)
    slices = []
    for k in range(size[2]):
        rows = []
        for j in range(size[1]):
            begin = size[0] * (j + size[1] * k)
            wide = array.array("h", bytes(2 * size[0] * times))
            for i in range(times):
                wide[i::times] = values[begin:begin + size[0]]
            rows.append(wide.tobytes() * times)
        slices.append(b"".join(rows) * times)
    directions = re.sub(r"-?[0-9.]+", lambda found: str(float(found.group()) / times), head["space directions"])
    fields = {**head, "sizes": " ".join(str(n * times) for n in size), "space directions": directions, "encoding": "raw"}
    return ("NRRD0004\n" + "".join(f"{key}: {value}\n" for key, value in fields.items()) + "\n").encode() + b"".join(slices)


def read_nrrd(path):
    text, data = path.read_bytes().split(b"\n\n", 1)
    head = dict(line.split(": ", 1) for line in text.decode().splitlines()[1:] if not line.startswith("#"))
    return head, gzip.decompress(data) if head["encoding"] in ("gzip", "gz") else data


def add_volume(scratch):
    envlib = scratch.home / "envlib"
    envlib.mkdir(exist_ok=True)
    (envlib / "phantom.mpc").write_bytes((VOLUME / "phantom.mpc").read_bytes())
    (envlib / "phantom.nrrd").write_bytes(enlarged(*read_nrrd(VOLUME / "phantom.nrrd"), OPTIONS.times))
    node = '\n[[node]]\nname = "Scan"\nabstract = "phantom.mpc"\nxyz_m = [0.0, 0.0, 1.2]\n'
    text = scratch.cell_file.read_text()
    place = text.index("[[node]]")
    scratch.cell_file.write_text(text[:place] + node.lstrip() + "\n" + text[place:])


def measure(volume):
    scratch = g.Scratch()
    if volume:
        add_volume(scratch)
    gateway = g.Gateway(scratch, pictures=True)
    try:
        g.eventually(lambda: scratch.status()["collisions"]["counters"]["checks"] > 10, 60)
        rng = random.Random(1)
        for robot in scratch.status()["robots"]:
            (scratch.home / "scripts" / f"age_{robot['id']}.spt").write_text(findings.script_of(robot, rng))
            scratch.send(f"EXEC_SCRIPT age_{robot['id']}.spt")
        film = subprocess.run(
            [str(g.BIN / "cellmirror"), "snapshot", "--instance", scratch.instance, "--size", "1280x720", "--film",
             str(scratch.root / "film.mjpeg"), "--seconds", str(OPTIONS.seconds), "--rate", str(OPTIONS.rate)],
            env=scratch.environment, capture_output=True, text=True, timeout=OPTIONS.seconds + 60)
        if film.returncode != 0:
            raise SystemExit(film.stderr)
        return scratch.status(), film.stdout.strip()
    finally:
        gateway.close()
        scratch.remove()


def main():
    found = {}
    for volume in (False, True):
        status, film = measure(volume)
        found[volume] = (status["loop"]["wakeup_latency_us"]["p99"], status["collisions"]["age_ms"]["p99"])
        print(f"{'with' if volume else 'without'} a volume: wake-up p99 {found[volume][0]:.0f} us, collisions at most "
              f"{found[volume][1]:.2f} ms old (p99); {film}")
        for one in status["volumes"]:
            print(f"  {one['name']}: {'x'.join(map(str, one['voxels']))} voxels")
    print(f"with over without: wake-up {found[True][0] / found[False][0]:.2f}, age of collisions {found[True][1] / found[False][1]:.2f}")


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""500 slices of 512 x 512 of 16 bits, written with pydicom, to a volume in memory: wall-clock time and peak memory of
`cellmirror volume info`. Goals: 3 s, and 1.3 times the raw volume. With a transfer syntax of gdcmconv as argument
(--jpeg, --j2k, --rle, --jpegls) the same slices in that one."""

import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[3]
os.environ.setdefault("CELLMIRROR_BIN_DIR", str(ROOT / "build/bin"))
sys.path.insert(0, str(ROOT / "tests/integration/volumes"))
import series as s  # noqa: E402

SLICES, SIDE, ROUNDS = 500, 512, 5


def write(folder, coder):
    # A smooth body with a little noise, as of a scanner: decoders take their usual time.
    state = 1
    pixels = []
    for j in range(SIDE):
        for i in range(SIDE):
            state = (1103515245 * state + 12345) % (1 << 31)
            inside = (i - 256) ** 2 + (j - 256) ** 2 < 200 ** 2
            pixels.append((1064 if inside else 24) + state // (1 << 27))
    for k in range(SLICES):
        data = s.slice_of(k, rows=SIDE, columns=SIDE, pixels=pixels[k:] + pixels[:k])
        s.save(folder, data, f"{k * 7 % SLICES:04d}.dcm")
    if coder:
        for path in folder.iterdir():
            subprocess.run(["gdcmconv", coder, path, path], check=True, capture_output=True)


def main():
    coder = sys.argv[1] if len(sys.argv) > 1 else None
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary) / "ct"
        write(folder, coder)
        times = []
        for _ in range(ROUNDS):
            start = time.monotonic()
            done = s.run("info", folder, timeout=600)
            assert done.returncode == 0, done.stderr
            times.append(time.monotonic() - start)
        raw = SLICES * SIDE * SIDE * 2
        peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024
        print(f"{SLICES} slices {coder or 'without compression'}: median {sorted(times)[ROUNDS // 2]:.2f} s of "
              + " ".join(f"{t:.2f}" for t in times) + f" (goal 3); peak {peak / 2**20:.0f} MiB, "
              f"{peak / raw:.2f} of the raw volume (goal 1.3)")


if __name__ == "__main__":
    main()

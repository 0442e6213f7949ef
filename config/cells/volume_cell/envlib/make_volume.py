#!/usr/bin/env python3
"""Makes phantom.nrrd: computed tomography of a torso that nobody has, in Hounsfield units.

  make_volume.py [--into FOLDER]

Two lungs of air, a layer of fat around soft tissue, a liver with a denser lesion, a heart with blood, a spine, ribs and
a breastbone of bone. Each voxel is the mean of 8 points and blurred with its neighbours, as by a scanner. The same
values on every machine with IEEE arithmetic. Python's standard library is all it needs."""
import argparse
import array
import math
import pathlib
import sys
import zlib

SIZE = (112, 88, 96)  # voxels along x (to the left hand), y (to the back), z (to the head)
SPACING_MM = (3.0, 2.5, 3.0)

AIR, LUNG, FAT, TISSUE, LIVER, LESION, BLOOD, MARROW, BONE = -1000, -850, -100, 40, 65, 110, 180, 300, 900


def inside(p, middle, radii):
    x, y, z = p
    a, b, c = middle
    d, e, f = radii
    return ((x - a) / d) ** 2 + ((y - b) / e) ** 2 + ((z - c) / f) ** 2 <= 1.0


def torso(p, less=0.0):
    """A cylinder with an elliptic base and rounded ends."""
    x, y, z = p
    end = max(0.0, abs(z) - 100.0) / (36.0 - less * 0.5)
    return (x / (146.0 - less)) ** 2 + (y / (94.0 - less)) ** 2 + end * end <= 1.0


def rib(p):
    """Rings that fall towards the front."""
    x, y, z = p
    radius = math.hypot(x / 128.0, y / 77.0)
    if abs(radius - 1.0) > 0.045 or y < -66.0:
        return None
    height = (z - 0.30 * y + 6.0) % 27.0 - 13.5
    if z > 104.0 or z < -70.0 or abs(height) > 5.5:
        return None
    return MARROW if abs(height) < 2.2 and abs(radius - 1.0) < 0.02 else BONE


def spine(p):
    x, y, z = p
    along = (z + 140.0) % 30.0
    body = math.hypot(x, (y - 56.0) * 1.15)
    if along < 25.0 and body <= 19.0:
        return BONE if body > 16.0 or along < 2.0 or along > 23.0 else MARROW
    if along >= 25.0 and body <= 18.0:
        return TISSUE + 30  # a disc
    canal = math.hypot(x, y - 79.0)
    if canal <= 7.5:
        return TISSUE - 25
    if canal <= 11.0 and along < 18.0:
        return BONE
    if abs(x) <= 3.0 and 79.0 <= y <= 91.0 and along < 14.0:
        return BONE
    return None


def value(p):
    if not torso(p):
        # The table under the back.
        return -200 if 97.0 <= p[1] <= 101.0 and abs(p[0]) <= 150.0 else AIR
    if not torso(p, 14.0):
        return FAT
    bone = spine(p) or rib(p)
    if bone is None and abs(p[0]) <= 14.0 and -80.0 <= p[1] <= -70.0 and -30.0 <= p[2] <= 95.0:
        bone = BONE if abs(p[0]) > 10.0 or p[1] < -77.0 or p[1] > -73.0 else MARROW
    if bone is not None:
        return bone
    if inside(p, (22.0, -22.0, 18.0), (40.0, 36.0, 44.0)):
        return BLOOD if inside(p, (24.0, -24.0, 12.0), (22.0, 20.0, 28.0)) else TISSUE + 10
    if math.hypot(p[0] - 12.0, p[1] - 32.0) <= 10.0:
        return BLOOD  # the aorta
    if inside(p, (-45.0, -8.0, -82.0), (66.0, 56.0, 40.0)):
        return LESION if inside(p, (-66.0, -16.0, -76.0), (11.0, 11.0, 11.0)) else LIVER
    for side in (-1.0, 1.0):
        if inside(p, (side * 62.0, 2.0, 34.0), (46.0, 58.0, 82.0)) and p[2] > -48.0 + 0.006 * p[0] * p[0]:
            # Vessels of the lung.
            branch = math.sin(0.11 * p[0] + 0.4) * math.sin(0.13 * p[1]) * math.sin(0.10 * p[2] + 1.0)
            return TISSUE - 60 if branch > 0.80 else LUNG
    if inside(p, (0.0, -8.0, 10.0), (118.0, 64.0, 130.0)):
        return TISSUE
    return TISSUE - 5 if torso(p, 30.0) else FAT + 20


def centre(index):
    return [(i - 0.5 * (n - 1)) * d for i, n, d in zip(index, SIZE, SPACING_MM)]


def sample(index):
    """The mean of 8 points."""
    x, y, z = centre(index)
    a, b, c = (0.25 * d for d in SPACING_MM)
    if abs(y) < 95.0 and not torso((abs(x) - a, abs(y) - b, abs(z) - c)):
        return AIR  # the nearest of them is outside, and the table is farther back
    return sum(value((x + d, y + e, z + f)) for f in (-c, c) for e in (-b, b) for d in (-a, a)) / 8


def blurred(values, size, step):
    """A quarter of each neighbour along an axis; the first and last voxel stay as they are."""
    out = list(values)
    for i, middle in enumerate(values):
        if 0 < i // step % size < size - 1:
            out[i] = 0.25 * values[i - step] + 0.5 * middle + 0.25 * values[i + step]
    return out


def nrrd():
    smooth = [sample((i, j, k)) for k in range(SIZE[2]) for j in range(SIZE[1]) for i in range(SIZE[0])]
    for size, step in zip(SIZE, (1, SIZE[0], SIZE[0] * SIZE[1])):
        smooth = blurred(smooth, size, step)
    values = array.array("h", (round(v) for v in smooth))
    if sys.byteorder == "big":
        values.byteswap()
    origin = ",".join(f"{a:g}" for a in centre((0, 0, 0)))
    head = f"""NRRD0004
# Made by make_volume.py: no patient.
type: short
dimension: 3
space: left-posterior-superior
sizes: {SIZE[0]} {SIZE[1]} {SIZE[2]}
space directions: ({SPACING_MM[0]:g},0,0) (0,{SPACING_MM[1]:g},0) (0,0,{SPACING_MM[2]:g})
space origin: ({origin})
space units: "mm" "mm" "mm"
kinds: domain domain domain
endian: little
encoding: gzip

"""
    # Without a time and a name, so that the same values are the same bytes.
    packer = zlib.compressobj(9, zlib.DEFLATED, -zlib.MAX_WBITS)
    raw = values.tobytes()
    packed = packer.compress(raw) + packer.flush()
    frame = b"\x1f\x8b\x08\x00\x00\x00\x00\x00\x02\xff"
    end = zlib.crc32(raw).to_bytes(4, "little") + (len(raw) & 0xFFFFFFFF).to_bytes(4, "little")
    return head.encode() + frame + packed + end


def main():
    parser = argparse.ArgumentParser(description="Makes the volume of this cell.")
    parser.add_argument("--into", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent)
    folder = parser.parse_args().into
    (folder / "phantom.nrrd").write_bytes(nrrd())


if __name__ == "__main__":
    main()

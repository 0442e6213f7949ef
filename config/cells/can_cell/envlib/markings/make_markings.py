#!/usr/bin/env python3
"""Makes what is painted on this cell: stripes along the edge of the bench, and the scale of the turning plate.

  make_markings.py [--into FOLDER]

Thin sheets as OBJ, in metres, with their pictures as PNG. Apache-2.0, as everything here.
"""

import argparse
import math
import pathlib
import struct
import zlib

SAMPLES = 3  # a pixel each way
YELLOW = (244, 190, 20)
BLACK = (38, 40, 44)
PALE = (196, 200, 206)
BLUE = (24, 92, 160)


def write_png(path, size, colour_at):
    """`colour_at(x, y)`, 0 to 1 from the upper left corner, averaged over each pixel."""
    steps = [(i + 0.5) / SAMPLES for i in range(SAMPLES)]
    rows = bytearray()
    for y in range(size):
        rows.append(0)
        for x in range(size):
            samples = [colour_at((x + i) / size, (y + j) / size) for i in steps for j in steps]
            rows += bytes(round(sum(part) / len(samples)) for part in zip(*samples))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", size, size, 8, 2, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(rows), 9))
                     + chunk(b"IEND", b""))


def stripes(x, y):
    """Repeats without a seam."""
    return YELLOW if (x + y) % 1.0 < 0.5 else BLACK


def scale(x, y):
    """A mark each 5 degrees, longer each 10 and 30, and one radius that tells where 0 is."""
    right, up = 2 * x - 1, 1 - 2 * y
    radius, angle = math.hypot(right, up), math.degrees(math.atan2(up, right)) % 360
    if abs(up) < 0.025 and 0.16 < right < 0.66:
        return BLUE
    if radius < 0.10 or 0.955 < radius:
        return BLACK
    for every, inner, width in ((30, 0.70, 0.014), (10, 0.79, 0.010), (5, 0.86, 0.006)):
        off = (angle + every / 2) % every - every / 2
        if radius > inner and abs(math.radians(off)) * radius < width:
            return BLUE if every == 30 else BLACK
    return PALE


def write_obj(path, material, corners, faces):
    """`corners`: x, y, z, u, v; faces by their numbers from 0."""
    lines = ["# made by make_markings.py", "mtllib markings.mtl", f"usemtl {material}"]
    lines += [f"v {x:.6g} {y:.6g} {z:.6g}" for x, y, z, _, _ in corners]
    lines += [f"vt {u:.6g} {v:.6g}" for _, _, _, u, v in corners]
    lines += ["f " + " ".join(f"{i + 1}/{i + 1}" for i in face) for face in faces]
    path.write_text("\n".join(lines) + "\n")


def frame(left, right, front, back, width, tile):
    corners, faces = [], []
    for x0, x1, y0, y1 in ((left, right, front, front + width), (left, right, back - width, back),
                           (left, left + width, front + width, back - width),
                           (right - width, right, front + width, back - width)):
        faces.append(range(len(corners), len(corners) + 4))
        corners += [(x, y, 0, x / tile, y / tile) for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))]
    return corners, faces


def disc(radius, count):
    corners = []
    for i in range(count):
        x, y = math.cos(2 * math.pi * i / count), math.sin(2 * math.pi * i / count)
        corners.append((radius * x, radius * y, 0, 0.5 + 0.5 * x, 0.5 + 0.5 * y))
    return corners, [range(count)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--into", type=pathlib.Path, default=pathlib.Path(__file__).parent)
    into = parser.parse_args().into
    write_png(into / "stripes.png", 64, stripes)
    write_png(into / "scale.png", 512, scale)
    (into / "markings.mtl").write_text("# made by make_markings.py\nnewmtl stripes\nKd 0.96 0.75 0.08\nmap_Kd stripes.png\n"
                                       "newmtl scale\nKd 0.89 0.90 0.91\nmap_Kd scale.png\n")
    write_obj(into / "bench_edge.obj", "stripes", *frame(-0.7, 1.3, -0.6, 0.6, 0.06, 0.12))
    write_obj(into / "scale.obj", "scale", *disc(0.158, 64))


if __name__ == "__main__":
    main()

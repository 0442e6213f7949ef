#!/usr/bin/env python3
"""Makes the meshes of this cell as binary STL, in metres: closed solids in one frame, that of the cell's scene.

  make_meshes.py [--into FOLDER]

The same bytes on every machine with IEEE arithmetic. Python's standard library is all it needs."""
import argparse
import math
import pathlib
import struct

PHI = (1 + math.sqrt(5)) / 2
ICOSAHEDRON = [(-1, PHI, 0), (1, PHI, 0), (-1, -PHI, 0), (1, -PHI, 0), (0, -1, PHI), (0, 1, PHI), (0, -1, -PHI),
               (0, 1, -PHI), (PHI, 0, -1), (PHI, 0, 1), (-PHI, 0, -1), (-PHI, 0, 1)]
FACES = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6),
         (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7),
         (9, 8, 1)]

# x to the surgeon's right, y away from the surgeon, z up; the origin is in the middle of the tray.
# The gallbladder lies on the liver, its neck towards the surgeon. Points of its axis, from the fundus to the neck, with
# its radius there.
GALLBLADDER = [((-0.024, 0.018, 0.0655), 0.0115), ((-0.021, 0.006, 0.0670), 0.0135), ((-0.017, -0.007, 0.0660), 0.0130),
               ((-0.013, -0.020, 0.0620), 0.0105), ((-0.009, -0.030, 0.0560), 0.0075), ((-0.005, -0.037, 0.0500), 0.0050)]
# From the neck to the hilum, at the liver's front side.
CYSTIC_DUCT = [(-0.0005, -0.0435, 0.0455), (0.007, -0.0465, 0.0445), (0.017, -0.0470, 0.0425), (0.028, -0.0430, 0.0390),
               (0.036, -0.0360, 0.0350), (0.041, -0.0270, 0.0310)]
DUCT_RADIUS = 0.0025
# From the hilum to the gallbladder.
CYSTIC_ARTERY = [(0.047, -0.0235, 0.0400), (0.040, -0.0300, 0.0465), (0.031, -0.0325, 0.0515), (0.020, -0.0315, 0.0550),
                 (0.0095, -0.0285, 0.0575), (0.0000, -0.0260, 0.0585)]
ARTERY_RADIUS = 0.0020
# The liver: middle, half axes; the gallbladder's bed is a hollow with this gap.
LIVER = ((0.004, 0.020, 0.030), (0.064, 0.044, 0.026))
GAP = 0.0020


def add(a, b, factor=1.0):
    return tuple(x + factor * y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(p):
    length = math.sqrt(dot(p, p))
    return tuple(x / length for x in p)


def sphere(frequency):
    """Triangles of a unit sphere: every face of an icosahedron divided into frequency^2."""
    for face in FACES:
        a, b, c = (ICOSAHEDRON[i] for i in face)

        def at(i, j):
            k = frequency - i - j
            # Sums in an order that is the same on both sides of an edge.
            parts = sorted([(i, a), (j, b), (k, c)], key=lambda part: part[1])
            return unit([sum(n * corner[axis] for n, corner in parts if n) for axis in range(3)])

        for i in range(frequency):
            for j in range(frequency - i):
                yield at(i + 1, j), at(i, j + 1), at(i, j)
                if i + j + 1 < frequency:
                    yield at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)


def curve(points, steps):
    """A smooth line (Catmull and Rom) through points of any dimension, `steps` pieces between two of them."""
    ends = [add(points[0], add(points[0], points[1], -1.0)), *points,
            add(points[-1], add(points[-1], points[-2], -1.0))]
    line = []
    for i in range(1, len(points)):
        p, a, b, q = ends[i - 1], ends[i], ends[i + 1], ends[i + 2]
        for k in range(steps):
            t = k / steps
            line.append(tuple(0.5 * (2 * y + (z - x) * t + (2 * x - 5 * y + 4 * z - w) * t * t +
                                     (3 * y - x - 3 * z + w) * t ** 3) for x, y, z, w in zip(p, a, b, q)))
    return line + [points[-1]]


def swept(line, around, cap_rings):
    """A closed surface about a line of ((x, y, z), radius), with rounded ends."""
    centres = [centre for centre, _ in line]
    way = [unit(add(centres[min(i + 1, len(line) - 1)], centres[max(i - 1, 0)], -1.0)) for i in range(len(line))]
    side = unit(cross(way[0], (0.0, 0.0, 1.0)))
    rings = []

    def ring(centre, radius, forwards, right):
        up = cross(right, forwards)
        rings.append([add(add(centre, right, radius * math.cos(2 * math.pi * k / around)), up,
                          radius * math.sin(2 * math.pi * k / around)) for k in range(around)])

    def cap(centre, radius, forwards, right, angles):
        for angle in angles:
            ring(add(centre, forwards, radius * math.sin(angle)), radius * math.cos(angle), forwards, right)

    steps = [math.pi / 2 * k / (cap_rings + 1) for k in range(1, cap_rings + 1)]
    cap(centres[0], line[0][1], way[0], side, [-angle for angle in reversed(steps)])
    for (centre, radius), forwards in zip(line, way):
        side = unit(add(side, forwards, -dot(side, forwards)))  # turns as little as it can
        ring(centre, radius, forwards, side)
    cap(centres[-1], line[-1][1], way[-1], side, steps)
    first = add(centres[0], way[0], -line[0][1])
    last = add(centres[-1], way[-1], line[-1][1])
    triangles = []
    for k in range(around):
        n = (k + 1) % around
        triangles.append((first, rings[0][k], rings[0][n]))
        for a, b in zip(rings, rings[1:]):
            triangles += [(a[k], b[k], b[n]), (a[k], b[n], a[n])]
        triangles.append((last, rings[-1][n], rings[-1][k]))
    return triangles


def gallbladder_line(steps):
    return [(p[:3], p[3]) for p in curve([(*centre, radius) for centre, radius in GALLBLADDER], steps)]


def liver(frequency=14):
    """A flattened lobe of 3,920 triangles, lower in front, with the gallbladder's bed in its upper side."""
    (cx, cy, cz), (rx, ry, rz) = LIVER
    bladder = gallbladder_line(8)

    def surface(p):
        # Fuller than an ellipsoid, and thinner towards the front and the right.
        full = 1.0 / (sum(abs(x) ** 2.6 for x in p) ** (1 / 2.6))
        x, y, z = rx * full * p[0], ry * full * p[1], rz * full * p[2]
        z *= 1.0 + 0.10 * p[1] - 0.10 * p[0] + 0.03 * math.sin(5 * p[0] + 2) * math.cos(4 * p[1])
        at = (cx + x, cy + y, cz + z)
        if p[2] < -0.3:
            return at
        # What would be in the gallbladder goes down, out of it; softly, so that the bed has round edges.
        low = at[2]
        for centre, radius in bladder:
            wide = radius + GAP
            beside = math.hypot(at[0] - centre[0], at[1] - centre[1])
            if beside < wide:
                low = min(low, centre[2] - math.sqrt(wide * wide - beside * beside))
        return (at[0], at[1], low)

    return [tuple(surface(p) for p in triangle) for triangle in sphere(frequency)]


def gallbladder():
    return swept(gallbladder_line(6), around=28, cap_rings=6)


def tube(points, radius, steps=8, around=16):
    return swept([(p, radius) for p in curve(points, steps)], around, cap_rings=3)


def clip(length=0.009, gap=0.0022, thickness=0.0009, width=0.0012):
    """Two legs along z, joined at z = 0: a closed clip of titanium, as it sits on a vessel."""
    y0, y1 = gap / 2, gap / 2 + thickness
    outline = [(-y1, 0.0), (y1, 0.0), (y1, length), (y0, length), (y0, thickness), (-y0, thickness), (-y0, length),
               (-y1, length)]
    faces = [(0, 1, 4), (0, 4, 5), (1, 2, 3), (1, 3, 4), (0, 5, 6), (0, 6, 7)]
    x = width / 2
    triangles = []
    for a, b, c in faces:
        for sign, order in ((x, (a, b, c)), (-x, (a, c, b))):
            triangles.append(tuple((sign, *outline[i]) for i in order))
    for i, (y, z) in enumerate(outline):
        v, w = outline[(i + 1) % len(outline)]
        a, b, c, d = (-x, y, z), (-x, v, w), (x, v, w), (x, y, z)
        triangles += [(a, b, c), (a, c, d)]
    return triangles


def write_stl(path, triangles):
    with open(path, "wb") as out:
        out.write(b"trainer cell, made by make_meshes.py".ljust(80, b"\0"))
        out.write(struct.pack("<I", len(triangles)))
        for a, b, c in triangles:
            out.write(struct.pack("<12fH", 0.0, 0.0, 0.0, *a, *b, *c, 0))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--into", type=pathlib.Path, default=pathlib.Path(__file__).parent)
    into = parser.parse_args().into
    for name, triangles in (("liver", liver()), ("gallbladder", gallbladder()),
                            ("cystic_duct", tube(CYSTIC_DUCT, DUCT_RADIUS)),
                            ("cystic_artery", tube(CYSTIC_ARTERY, ARTERY_RADIUS, around=14)), ("clip", clip())):
        write_stl(into / f"{name}.stl", triangles)
        print(f"{name}: {len(triangles)} triangles")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Makes the meshes of this cell as binary STL, in metres: closed solids.

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


def unit(p):
    length = math.sqrt(sum(x * x for x in p))
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


# Lobes and hollows of the organ: direction, height (m), width (rad).
LOBES = [((-0.8, -0.1, 0.55), 0.014, 0.55), ((0.75, 0.25, 0.5), 0.011, 0.50), ((0.1, -0.75, 0.5), 0.010, 0.40),
         ((0.05, 0.1, 1.0), -0.010, 0.38), ((0.35, -0.45, 0.8), 0.007, 0.22), ((-0.25, 0.8, 0.55), 0.009, 0.35)]


def organ(frequency=14):
    """A flattened body of 3,920 triangles with smooth lobes and a hollow between them; it stands on z = -0.030."""
    lobes = [(unit(d), height, width) for d, height, width in LOBES]

    def surface(p):
        radius = 0.042
        for d, height, width in lobes:
            angle = math.acos(max(-1.0, min(1.0, sum(x * y for x, y in zip(p, d)))))
            radius += height * math.exp(-(angle / width) ** 2)
        x, y, z = 1.25 * radius * p[0], 0.95 * radius * p[1], 0.75 * radius * p[2]
        return (x, y, -0.0299 if z < -0.0299 else z)

    return [tuple(surface(p) for p in triangle) for triangle in sphere(frequency)]


def tube(inner=0.009, outer=0.011, length=0.050, around=32, along=5):
    """A hollow cylinder along z."""
    def point(radius, k, row):
        angle = 2 * math.pi * (k % around) / around
        return (radius * math.cos(angle), radius * math.sin(angle), length * (row / along - 0.5))

    def quad(a, b, c, d):
        return [(a, b, c), (a, c, d)]

    triangles = []
    for k in range(around):
        for row in range(along):
            triangles += quad(point(outer, k, row), point(outer, k + 1, row), point(outer, k + 1, row + 1),
                              point(outer, k, row + 1))
            triangles += quad(point(inner, k + 1, row), point(inner, k, row), point(inner, k, row + 1),
                              point(inner, k + 1, row + 1))
        triangles += quad(point(outer, k + 1, 0), point(outer, k, 0), point(inner, k, 0), point(inner, k + 1, 0))
        triangles += quad(point(outer, k, along), point(outer, k + 1, along), point(inner, k + 1, along),
                          point(inner, k, along))
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
    for name, triangles in (("organ", organ()), ("tube", tube())):
        write_stl(into / f"{name}.stl", triangles)
        print(f"{name}: {len(triangles)} triangles")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Makes the meshes of this cell as binary STL, in metres, z along the axis. Run it in this folder."""
import math
import struct


def write_stl(name, triangles):
    with open(name, "wb") as out:
        out.write(b"transfer cell, made by make_meshes.py".ljust(80, b"\0"))
        out.write(struct.pack("<I", len(triangles)))
        for a, b, c in triangles:
            u = [b[i] - a[i] for i in range(3)]
            v = [c[i] - a[i] for i in range(3)]
            n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
            length = math.sqrt(sum(x * x for x in n)) or 1.0
            out.write(struct.pack("<12fH", *(x / length for x in n), *a, *b, *c, 0))


def turned(profile, steps, close):
    """The surface of revolution of (radius, z) points about z; `close`: the last point joins the first."""
    points = [[(r * math.cos(2 * math.pi * k / steps), r * math.sin(2 * math.pi * k / steps), z)
               for r, z in profile] for k in range(steps)]
    count = len(profile)
    triangles = []
    for k in range(steps):
        here, there = points[k], points[(k + 1) % steps]
        for i in range(count if close else count - 1):
            j = (i + 1) % count
            if profile[i][0] > 0:
                triangles.append((here[i], there[i], there[j] if profile[j][0] > 0 else here[j]))
            if profile[j][0] > 0 and profile[i] != profile[j]:
                triangles.append((here[i], there[j], here[j]))
    return triangles


def tube(path, radius, steps):
    """A closed tube in the x-z plane along the points of `path`."""
    rings = []
    for i, (x, z) in enumerate(path):
        before, after = path[max(i - 1, 0)], path[min(i + 1, len(path) - 1)]
        angle = math.atan2(after[1] - before[1], after[0] - before[0])
        rings.append([(x - radius * math.cos(t) * math.sin(angle), radius * math.sin(t),
                       z + radius * math.cos(t) * math.cos(angle))
                      for t in (2 * math.pi * k / steps for k in range(steps))])
    triangles = []
    for first, second in zip(rings, rings[1:]):
        for k in range(steps):
            n = (k + 1) % steps
            triangles += [(first[k], first[n], second[n]), (first[k], second[n], second[k])]
    for ring, x_z, turn in ((rings[0], path[0], 1), (rings[-1], path[-1], -1)):
        centre = (x_z[0], 0.0, x_z[1])
        for k in range(steps):
            triangles.append((centre, ring[(k + turn) % steps], ring[k]))
    return triangles


# A pipe flange: a ring with a raised face.
write_stl("flange.stl", turned([(0.07, 0.0), (0.15, 0.0), (0.15, 0.03), (0.10, 0.03), (0.10, 0.04), (0.07, 0.04)],
                               32, True))
# The flange of a hand: a stepped disc.
write_stl("hand_flange.stl", turned([(0.0, 0.02), (0.05, 0.02), (0.05, 0.005), (0.065, 0.005), (0.065, -0.01),
                                     (0.0, -0.01)][::-1], 24, False))
# A crane hook: a shank and an arc of 240 degrees.
arc = [(0.06 * math.cos(a), -0.15 + 0.06 * math.sin(a))
       for a in (math.pi / 2 - math.radians(d) for d in range(0, 241, 20))]
write_stl("hook.stl", tube([(0.0, 0.05), (0.0, -0.02)] + arc, 0.018, 10))

"""Closed solids as triangle meshes, and binary STL. Metres. Everything is a function of its arguments, so that the same
call writes the same bytes on every machine with IEEE arithmetic."""
import math
import struct


class Mesh:
    """Vertices and triangles that run counter-clockwise seen from outside."""

    def __init__(self):
        self.vertices = []
        self.triangles = []
        self._known = {}

    def add(self, point):
        """Index of a point as STL will hold it (float32); equal points are one."""
        key = struct.unpack("<3f", struct.pack("<3f", *point))
        if key not in self._known:
            self._known[key] = len(self.vertices)
            self.vertices.append(key)
        return self._known[key]

    def triangle(self, a, b, c):
        self.triangles.append((a, b, c))

    def quad(self, a, b, c, d):
        self.triangle(a, b, c)
        self.triangle(a, c, d)

    def along(self, axis):
        """Lays what was made along z along x or y instead."""
        turn = {"x": lambda p: (p[2], p[0], p[1]), "y": lambda p: (p[1], p[2], p[0])}[axis]
        self.vertices = [turn(p) for p in self.vertices]
        return self

    def across(self):
        """Lays what was made along x along y instead; z stays."""
        self.vertices = [(-p[1], p[0], p[2]) for p in self.vertices]
        return self

    def volume(self):
        total = 0.0
        for a, b, c in (tuple(self.vertices[i] for i in t) for t in self.triangles):
            total += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
                      + a[2] * (b[0] * c[1] - b[1] * c[0]))
        return total / 6

    def fault(self):
        """What keeps it from being a closed solid with an inside; empty: nothing."""
        edges = {}
        for t in self.triangles:
            if len(set(t)) < 3:
                return "a triangle without an area"
            for i in range(3):
                edge = (t[i], t[(i + 1) % 3])
                edges[edge] = edges.get(edge, 0) + 1
        for (a, b), count in edges.items():
            if count != 1 or edges.get((b, a)) != 1:
                return f"the edge {self.vertices[a]} - {self.vertices[b]} is open or used too often"
        return "" if self.volume() > 0 else "it is inside out"

    def write_stl(self, path):
        with open(path, "wb") as out:
            out.write(b"transfer cell, made by make_meshes.py".ljust(80, b"\0"))
            out.write(struct.pack("<I", len(self.triangles)))
            for t in self.triangles:
                a, b, c = (self.vertices[i] for i in t)
                u = [b[i] - a[i] for i in range(3)]
                v = [c[i] - a[i] for i in range(3)]
                n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
                length = math.sqrt(sum(x * x for x in n)) or 1.0
                out.write(struct.pack("<12fH", *(x / length for x in n), *a, *b, *c, 0))


class Detail:
    """How finely curves are divided: `factor` times as many triangles, about."""

    def __init__(self, factor):
        self.scale = math.sqrt(factor)

    def around(self, count):
        """Segments of a ring: a multiple of four."""
        return max(8, 4 * round(count * self.scale / 4))

    def steps(self, count):
        return max(1, round(count * self.scale))

    def spans(self, length, pitch):
        return max(1, round(length * self.scale / pitch))


def section(z, hx, hy=None, power=2.0, x=0.0, y=0.0):
    """A superellipse across z: half widths hx and hy; power 2 is an ellipse, 8 nearly a rectangle with round corners."""
    return (z, hx, hx if hy is None else hy, power, x, y)


def rounded(sections, radius, detail, steps=3):
    """`sections` with the edges at both ends rounded by `radius`."""
    count = detail.steps(steps)

    def end(outer, direction):
        z, hx, hy, power, x, y = outer
        for i in range(count):
            angle = 0.5 * math.pi * i / count
            inset = radius * (1 - math.sin(angle))
            yield (z + direction * radius * (1 - math.cos(angle)), hx - inset, hy - inset, power, x, y)

    first, last = sections[0], sections[-1]
    body = [(first[0] + radius, *first[1:]), *sections[1:-1], (last[0] - radius, *last[1:])]
    return [*end(first, 1), *body, *reversed(list(end(last, -1)))]


def loft(sections, around, detail, pitch=0.1):
    """The skin over sections in the order of z, closed by flat ends. No two neighbouring sections are the same."""
    around = detail.around(around)
    rows = [sections[0]]
    for here, there in zip(sections, sections[1:]):
        spans = detail.spans(max(abs(t - h) for h, t in zip(here[:3], there[:3])), pitch)
        for i in range(1, spans + 1):
            rows.append(tuple(h + (t - h) * i / spans for h, t in zip(here, there)))
    mesh = Mesh()
    rings = [[mesh.add(p) for p in superellipse(row, around)] for row in rows]
    for lower, upper in zip(rings, rings[1:]):
        for k in range(around):
            n = (k + 1) % around
            mesh.quad(lower[k], lower[n], upper[n], upper[k])
    for outline, row, turned in ((rings[0], rows[0], True), (rings[-1], rows[-1], False)):
        centre = mesh.add((row[4], row[5], row[0]))
        for k in range(around):
            n = (k + 1) % around
            mesh.triangle(centre, *((outline[n], outline[k]) if turned else (outline[k], outline[n])))
    return mesh


def superellipse(row, around):
    z, hx, hy, power, x, y = row
    points = []
    for k in range(around):
        # Not on the axes, where a high power bends the curve so little that points would fall together.
        angle = 2 * math.pi * (k + 0.5) / around
        c, s = math.cos(angle), math.sin(angle)
        points.append((x + hx * math.copysign(abs(c) ** (2 / power), c),
                       y + hy * math.copysign(abs(s) ** (2 / power), s), z))
    return points


def bolt_ring(inner, outer, bolt_circle, hole, bolts, z0, z1, detail, fineness=4):
    """A flat ring from z0 to z1 with `bolts` round holes of radius `hole`. Each hole lies in a sector of its own, whose
    outline is joined to it by a strip of triangles."""
    radial, arc = detail.steps(fineness - 1), detail.steps(fineness)
    mesh = Mesh()

    def at(turn, radius):
        angle = 2 * math.pi * turn / bolts
        return (radius * math.cos(angle), radius * math.sin(angle))

    def outline(k):
        """(turn, radius, on the rim): counter-clockwise about the hole, each point once."""
        end = (k + 1) % bolts
        for i in range(radial):
            yield (k, inner + (outer - inner) * i / radial, False)
        for i in range(arc):
            yield (k + i / arc if i else k, outer, True)
        for i in range(radial):
            # The same expression as on the other side of the edge, so that the points are the same.
            yield (end, inner + (outer - inner) * (radial - i) / radial, False)
        for i in range(arc):
            yield (k + 1 - i / arc if i else end, inner, True)

    for k in range(bolts):
        points = list(outline(k))
        centre = at(k + 0.5, bolt_circle)
        rim, edge = [], []
        for turn, radius, _ in points:
            p = at(turn, radius)
            away = math.hypot(p[0] - centre[0], p[1] - centre[1])
            q = [centre[i] + hole * (p[i] - centre[i]) / away for i in range(2)]
            rim.append([mesh.add((p[0], p[1], z)) for z in (z0, z1)])
            edge.append([mesh.add((q[0], q[1], z)) for z in (z0, z1)])
        for j, (_, _, on_rim) in enumerate(points):
            n = (j + 1) % len(points)
            mesh.quad(rim[j][1], rim[n][1], edge[n][1], edge[j][1])
            mesh.quad(rim[n][0], rim[j][0], edge[j][0], edge[n][0])
            mesh.quad(edge[j][1], edge[n][1], edge[n][0], edge[j][0])
            if on_rim:
                mesh.quad(rim[n][1], rim[j][1], rim[j][0], rim[n][0])
    return mesh


def ring(profile, around, detail):
    """A body of revolution with a hole along z: the closed outline of (radius, z) runs counter-clockwise, z upwards."""
    around = detail.around(around)
    mesh = Mesh()
    columns = [[mesh.add((r * math.cos(a), r * math.sin(a), z)) for r, z in profile]
               for a in (2 * math.pi * k / around for k in range(around))]
    for k in range(around):
        here, there = columns[k], columns[(k + 1) % around]
        for i in range(len(profile)):
            j = (i + 1) % len(profile)
            mesh.quad(here[i], there[i], there[j], here[j])
    return mesh


def girder(length, half_width, half_height, plate, web, stiffeners, detail):
    """An I-beam along x from 0 to `length`; the web widens to stiffeners."""
    count = detail.spans(stiffeners, 1)
    stations = [(0.0, web)]
    for i in range(count):
        middle = length * (i + 0.5) / count
        wide = half_width - 0.008
        stations += [(middle - 0.02, web), (middle - 0.008, wide), (middle + 0.008, wide), (middle + 0.02, web)]
    stations.append((length, web))
    b, h, t = half_width, half_height, half_height - plate
    mesh = Mesh()
    rings = []
    for x, w in stations:
        outline = [(b, -h), (b, -t), (w, -t), (w, t), (b, t), (b, h),
                   (-b, h), (-b, t), (-w, t), (-w, -t), (-b, -t), (-b, -h)]
        rings.append([mesh.add((x, y, z)) for y, z in outline])
    for here, there in zip(rings, rings[1:]):
        for i in range(12):
            j = (i + 1) % 12
            mesh.quad(here[i], here[j], there[j], there[i])
    ends = [(0, 1, 2), (0, 2, 9), (0, 9, 10), (0, 10, 11), (2, 3, 8), (2, 8, 9), (5, 6, 7), (5, 7, 8), (5, 8, 3),
            (5, 3, 4)]
    for i, j, k in ends:
        mesh.triangle(*(rings[-1][n] for n in (i, j, k)))
        mesh.triangle(*(rings[0][n] for n in (i, k, j)))
    return mesh


def tube(path, radius, around, detail):
    """A bent rod in the x-z plane along the points of `path`, with blunt points at its ends."""
    around = detail.around(around)
    mesh = Mesh()
    rings = []
    for i, (x, z) in enumerate(path):
        before, after = path[max(i - 1, 0)], path[min(i + 1, len(path) - 1)]
        angle = math.atan2(after[1] - before[1], after[0] - before[0])
        rings.append([mesh.add((x - radius * math.cos(t) * math.sin(angle), radius * math.sin(t),
                                z + radius * math.cos(t) * math.cos(angle)))
                      for t in (2 * math.pi * k / around for k in range(around))])
    for first, second in zip(rings, rings[1:]):
        for k in range(around):
            n = (k + 1) % around
            mesh.quad(first[n], first[k], second[k], second[n])
    for outline, tip, inner, turned in ((rings[0], path[0], path[1], False), (rings[-1], path[-1], path[-2], True)):
        length = math.hypot(tip[0] - inner[0], tip[1] - inner[1])
        x, z = (tip[i] + 0.5 * radius * (tip[i] - inner[i]) / length for i in range(2))
        point = mesh.add((x, 0.0, z))
        for k in range(around):
            n = (k + 1) % around
            mesh.triangle(point, *((outline[n], outline[k]) if turned else (outline[k], outline[n])))
    return mesh

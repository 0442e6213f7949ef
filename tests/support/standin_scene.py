"""The cell of page_standin.py in three dimensions: a glTF file of boxes and spheres, and their poses
(docs/monitor-page.md). Standard library only."""

import hashlib
import json
import math
import struct

LINK_M = 0.28
CUBE = [(-0.5, -0.5, -0.5), (0.5, -0.5, -0.5), (-0.5, 0.5, -0.5), (0.5, 0.5, -0.5), (-0.5, -0.5, 0.5), (0.5, -0.5, 0.5), (-0.5, 0.5, 0.5),
        (0.5, 0.5, 0.5)]
FACES = [((0, 2, 3, 1), (0, 0, -1)), ((4, 5, 7, 6), (0, 0, 1)), ((0, 1, 5, 4), (0, -1, 0)), ((2, 6, 7, 3), (0, 1, 0)),
         ((0, 4, 6, 2), (-1, 0, 0)), ((1, 3, 7, 5), (1, 0, 0))]


def cube():
    """positions, normals, indices"""
    positions, normals, indices = [], [], []
    for corners, normal in FACES:
        first = len(positions)
        positions += [CUBE[i] for i in corners]
        normals += [normal] * 4
        indices += [first, first + 1, first + 2, first, first + 2, first + 3]
    return positions, normals, indices


def sphere(triangles):
    """Of radius 1/2, with about so many triangles."""
    rings = max(3, round(math.sqrt(triangles / 4)))
    around = 2 * rings
    positions, indices = [], []
    for i in range(rings + 1):
        for k in range(around + 1):
            polar, turn = math.pi * i / rings, 2 * math.pi * k / around
            positions.append((0.5 * math.sin(polar) * math.cos(turn), 0.5 * math.sin(polar) * math.sin(turn), 0.5 * math.cos(polar)))
    for i in range(rings):
        for k in range(around):
            a, b = i * (around + 1) + k, (i + 1) * (around + 1) + k
            indices += [a, b, a + 1, a + 1, b, b + 1]
    return positions, [tuple(2 * x for x in p) for p in positions], indices


class Scene:
    """Bodies of a stand-in's cell; `parts`: so many spheres with `triangles` together."""

    def __init__(self, cell, parts=0, triangles=0, tissue=False, volumes=0):
        self.cell = cell
        self.tissue, self.volumes = tissue, volumes
        self.bodies = []  # (path, robot, mesh, size)
        for robot in cell.ids:
            path = robot
            for k in range(cell.joints):
                path += f".J_{k + 1}"
                self.bodies.append((path, robot, "cube", (LINK_M, 0.09, 0.09)))
        for i in range(8):
            self.bodies.append((f"Cell.Table_{i}.top", "", "cube", (0.8, 0.5, 0.05)))
        for i in range(parts):
            self.bodies.append((f"Cell.Part_{i}", "", "sphere", (0.3, 0.3, 0.3)))
        self.each = triangles // parts if parts else 0
        self.parts = parts
        self.file = self.glb()
        self.hash = int.from_bytes(hashlib.sha1(self.file).digest()[:8], "little")

    def glb(self):
        buffer, accessors, views, meshes = bytearray(), [], [], []

        def add(data, kind, count, component, target, **more):
            views.append({"buffer": 0, "byteOffset": len(buffer), "byteLength": len(data), "target": target})
            accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": count, "type": kind, **more})
            buffer.extend(data + bytes(-len(data) % 4))
            return len(accessors) - 1

        kinds = ["cube"] + (["sphere"] if self.parts else [])
        for kind in kinds:
            positions, normals, indices = cube() if kind == "cube" else sphere(self.each)
            flat = [x for p in positions for x in p]
            bounds = {"min": [min(p[i] for p in positions) for i in range(3)], "max": [max(p[i] for p in positions) for i in range(3)]}
            place = add(struct.pack(f"<{len(flat)}f", *flat), "VEC3", len(positions), 5126, 34962, **bounds)
            flat = [x for p in normals for x in p]
            normal = add(struct.pack(f"<{len(flat)}f", *flat), "VEC3", len(normals), 5126, 34962)
            corner = add(struct.pack(f"<{len(indices)}I", *indices), "SCALAR", len(indices), 5125, 34963)
            meshes.append({"primitives": [{"attributes": {"POSITION": place, "NORMAL": normal}, "indices": corner, "material": len(meshes)}]})
        colours = [[0.05, 0.2, 0.3, 1], [0.4, 0.42, 0.45, 1]]
        nodes = [{"name": "cell", "rotation": [-math.sqrt(0.5), 0, 0, math.sqrt(0.5)], "children": list(range(1, len(self.bodies) + 1))}]
        for i, (path, robot, kind, size) in enumerate(self.bodies):
            nodes.append({"name": path, "mesh": kinds.index(kind), "scale": list(size),
                          "extras": {"index": i, "object": i + 1, "path": path, "robot": robot}})
        document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": nodes, "meshes": meshes,
                    "materials": [{"pbrMetallicRoughness": {"baseColorFactor": colour}} for colour in colours[:len(kinds)]],
                    "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(buffer)}]}
        text = json.dumps(document).encode()
        text += b" " * (-len(text) % 4)
        total = 12 + 8 + len(text) + 8 + len(buffer)
        return struct.pack("<4sII", b"glTF", 2, total) + struct.pack("<I4s", len(text), b"JSON") + text + \
            struct.pack("<I4s", len(buffer), b"BIN\0") + bytes(buffer)

    def poses_of_robot(self, i):
        """Links that swing about the world's y axis."""
        x, z, tilt = 1.1 * i, 0.0, 0.0
        for k in range(self.cell.joints):
            tilt += 0.5 * self.cell.angle(i, k)
            up = math.pi / 2 - tilt
            dx, dz = LINK_M * math.cos(up), LINK_M * math.sin(up)
            half = -up / 2  # the link lies along its own x axis
            yield (x + dx / 2, 0.0, z + dz / 2, 0.0, math.sin(half), 0.0, math.cos(half))
            x, z = x + dx, z + dz

    def poses(self, sequence):
        """The whole message."""
        cell = self.cell
        numbers, states = [], bytearray()
        for i, robot in enumerate(cell.ids):
            for pose in self.poses_of_robot(i):
                numbers += pose
                states.append({"stale": 3, "lost": 3}.get(cell.state(i), 0))
        for i in range(8):
            numbers += (1.1 * i, -1.2, 0.4, 0, 0, 0, 1)
            states.append(0)
        columns = max(1, round(math.sqrt(self.parts)))
        for i in range(self.parts):
            numbers += (0.4 * (i % columns), 1 + 0.4 * (i // columns), 0.3 + 0.1 * math.sin(cell.now() + i), 0, 0, 0, 1)
            states.append(0)
        touching = not cell.still and int(cell.now() / 8) % 2
        if touching and states:
            states[min(cell.joints, len(states)) - 1] = 2
        near = struct.pack("<7f2I", 0, -1.2, 0.5, 0, 0, 1, 2.5, 0xFF1FB8F2, 2)
        frame = struct.pack("<9f", 0, 0, 0, 0, 0, 0, 1, 0.4, 1)
        cone = struct.pack("<9fI", 2.2, -1.2, 0.5, 0, 0, 0, 1, 0.3, 0.6, 0x38E8B557)
        arrow = struct.pack("<6f2I", 1.1, 0, 0.5, 0, 0, 0.5, 0xFF618000, 0)
        camera = struct.pack("<9f", 4, -6, 3, 0.8660254 * 0.9, 0, 0, 0.5, 0.8, 6)
        head = struct.pack("<4sIQd", b"CMS1", sequence, self.hash, 0.004)
        counts = struct.pack("<6I", len(states), 1, 1, 1, 1, 1)
        return head + counts + struct.pack(f"<{len(numbers)}f", *numbers) + near + frame + cone + arrow + camera + bytes(states)

    def marks(self):
        return {"is": "marks", "labels": [{"at_m": [0, -0.6, 0.75], "text": "0.65 m", "mark": "near"}], "axes": ["base"],
                "cameras": ["CAMERA_5"], "traces": [{"rgba": [0, 0.45, 0.7, 1], "points_m": [0, 0, 1, 0.5, 0, 1.2, 1, 0, 1]}],
                "floor": {"shown": self.cell.modes["FLDR"], "z_m": 0, "low_m": [-2, -3], "high_m": [9, 6]}, "legend": [], "tissue": self.tissue,
                "volumes": self.volumes}

    SHEET = 24  # vertices along an edge of the sheet of tissue

    def tissue_number(self):
        """Of the shape: a cut is made, and healed, every three seconds."""
        return 1 + int(self.cell.now() / 3)

    def tissue_shape(self):
        n = self.SHEET
        quads = [(i, k) for i in range(n - 1) for k in range(n - 1) if self.tissue_number() % 2 or i != n // 2]
        corners = [corner for i, k in quads for corner in (i * n + k, (i + 1) * n + k, i * n + k + 1, (i + 1) * n + k, (i + 1) * n + k + 1, i * n + k + 1)]
        clip = struct.pack("<2I9f3I", 3, 1, 0, 0, 0, 0.2, 0, 0, 0, 0, 0.2, 0, 1, 2)
        return struct.pack("<4s3I3I", b"CMT1", self.tissue_number(), 1, 1, n * n, len(corners) // 3, len(corners) // 3) + \
            struct.pack(f"<{len(corners)}I", *corners) + bytes((190, 70, 70, 0)) * (n * n) + clip

    def tissue_motion(self):
        n = self.SHEET
        places = b"".join(struct.pack("<3H", round(65535 * i / (n - 1)), round(65535 * k / (n - 1)),
                                      round(32767 * (1 + math.sin(3 * self.cell.now() + i / 3)))) for i in range(n) for k in range(n))
        burns = bytes(255 if i == k else 0 for i in range(n) for k in range(n))
        box = struct.pack("<6fI", 0.5, -2.4, 1.0, 1.5, 0.8, 0.3, 3)
        return struct.pack("<4s5I", b"CMM1", self.tissue_number(), 1, 1, 1, 0) + box + places + bytes(2 * n * n) + burns + \
            struct.pack("<7f", 1, -2, 1.4, 0, 0, 0, 1) + struct.pack("<4fI", 1, -2, 1.5, 0.01, 0)

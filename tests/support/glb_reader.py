"""Reads a glTF 2.0 binary file and refuses what the specification does not allow of what the gateway writes: container, bounds of
buffer views and accessors, indices, minima and maxima, the tree of nodes. Standard library only."""

import json
import math
import struct

SIZES = {5121: 1, 5123: 2, 5125: 4, 5126: 4}
WORDS = {5121: "B", 5123: "H", 5125: "I", 5126: "f"}
PARTS = {"SCALAR": 1, "VEC3": 3}


class Glb:
    def __init__(self, data):
        magic, version, length = struct.unpack_from("<4sII", data)
        assert magic == b"glTF" and version == 2, (magic, version)
        assert length == len(data), (length, len(data))
        chunks, at = [], 12
        while at < length:
            size, kind = struct.unpack_from("<I4s", data, at)
            assert size % 4 == 0 and at + 8 + size <= length, (at, size)
            chunks.append((kind, data[at + 8:at + 8 + size]))
            at += 8 + size
        assert [kind for kind, _ in chunks] in ([b"JSON"], [b"JSON", b"BIN\0"]), chunks
        self.document = json.loads(chunks[0][1])
        self.buffer = chunks[1][1] if len(chunks) > 1 else b""
        assert self.document["asset"]["version"] == "2.0"
        self.check_buffers()
        self.accessors = [self.read_accessor(accessor) for accessor in self.document.get("accessors", [])]
        self.meshes = [self.read_mesh(mesh) for mesh in self.document.get("meshes", [])]
        self.check_nodes()

    def check_buffers(self):
        buffers = self.document.get("buffers", [])
        assert len(buffers) == (1 if self.buffer else 0)
        if buffers:
            assert 0 <= len(self.buffer) - buffers[0]["byteLength"] < 4
        for name in ("meshes", "materials", "accessors", "bufferViews", "buffers"):
            assert self.document.get(name) != [], f"{name} may be missing, not empty"

    def read_accessor(self, accessor):
        view = self.document["bufferViews"][accessor["bufferView"]]
        parts, component = PARTS[accessor["type"]], accessor["componentType"]
        size = SIZES[component]
        assert view["byteOffset"] % size == 0 and accessor["count"] > 0
        assert accessor["count"] * parts * size <= view["byteLength"]
        assert view["byteOffset"] + view["byteLength"] <= len(self.buffer)
        values = struct.unpack_from(f"<{accessor['count'] * parts}{WORDS[component]}", self.buffer, view["byteOffset"])
        if component == 5126:
            assert all(map(math.isfinite, values))
        for name, function in (("min", min), ("max", max)):
            if name in accessor:
                found = [function(values[i::parts]) for i in range(parts)]
                assert all(abs(a - b) <= 1e-6 * max(1, abs(b)) for a, b in zip(accessor[name], found)), (accessor[name], found)
        return {**accessor, "values": values, "target": view["target"]}

    def read_mesh(self, mesh):
        primitive, = mesh["primitives"]
        position = self.accessors[primitive["attributes"]["POSITION"]]
        normal = self.accessors[primitive["attributes"]["NORMAL"]]
        indices = self.accessors[primitive["indices"]]
        assert "min" in position and "max" in position
        assert position["type"] == normal["type"] == "VEC3" and position["count"] == normal["count"]
        assert position["target"] == normal["target"] == 34962 and indices["target"] == 34963
        assert indices["count"] % 3 == 0 and max(indices["values"]) < position["count"]
        values = normal["values"]
        assert all(abs(math.dist(values[i:i + 3], (0, 0, 0)) - 1) < 1e-3 for i in range(0, len(values), 3)), "a normal is not of length 1"
        assert 0 <= primitive["material"] < len(self.document["materials"])
        return {"triangles": indices["count"] // 3, "min": position["min"], "max": position["max"]}

    def check_nodes(self):
        nodes = self.document["nodes"]
        assert self.document["scenes"] == [{"nodes": [0]}] and self.document["scene"] == 0
        assert nodes[0].get("children", []) == list(range(1, len(nodes)))
        self.bodies = nodes[1:]
        for i, node in enumerate(self.bodies):
            assert node["extras"]["index"] == i and isinstance(node["extras"]["path"], str)
            assert 0 <= node.get("mesh", 0) < max(1, len(self.meshes))
            assert abs(math.dist(node.get("rotation", (0, 0, 0, 1)), (0, 0, 0, 0)) - 1) < 1e-6

    @property
    def triangles(self):
        """As drawn: those of a mesh count at each node."""
        return sum(self.meshes[node["mesh"]]["triangles"] for node in self.bodies if "mesh" in node)


PARTS_OF_POSES = [("bodies", 7), ("lines", 9), ("axes", 9), ("cones", 10), ("arrows", 8), ("cameras", 9)]


def read_poses(message):
    """A message of poses, checked for its length."""
    magic, sequence, geometry, age = struct.unpack_from("<4sIQd", message)
    assert magic == b"CMS1"
    counts = struct.unpack_from("<6I", message, 24)
    out, at = {"sequence": sequence, "geometry": geometry, "age_s": age}, 48
    for (name, stride), count in zip(PARTS_OF_POSES, counts):
        rows = [struct.unpack_from(f"<{stride}f", message, at + 4 * stride * i) for i in range(count)]
        out[name] = rows
        at += 4 * stride * count
    out["states"] = message[at:at + counts[0]]
    assert at + counts[0] == len(message), (at, counts, len(message))
    return out

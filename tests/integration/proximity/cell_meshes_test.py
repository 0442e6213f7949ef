"""The meshes of the transfer cell: what make_meshes.py makes is what lies there, closed, and as fine as is asked for."""

import pathlib
import struct
import subprocess
import tempfile
import unittest

import gateway as g

MESHES = g.CELLS / "transfer_cell/envlib/meshes"


def triangles(path):
    data = path.read_bytes()
    (count,) = struct.unpack_from("<I", data, 80)
    assert len(data) == 84 + 50 * count, path
    return [[struct.unpack_from("<3f", data, 84 + 50 * i + 12 + 12 * k) for k in range(3)] for i in range(count)]


def make(folder, *options):
    subprocess.run(["/usr/bin/python3", "-B", str(MESHES / "make_meshes.py"), "--into", str(folder), *options], check=True,
                   capture_output=True, timeout=60)


class Meshes(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory(prefix="cellmirror-test-")
        self.folder = pathlib.Path(self._folder.name)

    def tearDown(self):
        self._folder.cleanup()

    def test_the_files_are_what_the_script_makes(self):
        make(self.folder)
        made = {path.name for path in self.folder.glob("*.stl")}
        self.assertEqual(made, {path.name for path in MESHES.glob("*.stl")})
        for name in made:
            # Sines differ in their last bit from one C library to another.
            for one, other in zip(triangles(self.folder / name), triangles(MESHES / name), strict=True):
                for p, q in zip(one, other):
                    for a, b in zip(p, q):
                        self.assertAlmostEqual(a, b, delta=1e-6, msg=name)

    def test_every_edge_is_used_once_in_each_direction(self):
        for path in MESHES.glob("*.stl"):
            edges = {}
            for corners in triangles(path):
                self.assertEqual(len(set(corners)), 3, path.name)
                for i in range(3):
                    edge = (corners[i], corners[(i + 1) % 3])
                    edges[edge] = edges.get(edge, 0) + 1
            self.assertTrue(all(count == 1 and edges.get((b, a)) == 1 for (a, b), count in edges.items()), path.name)

    def test_detail_makes_it_finer(self):
        make(self.folder, "--detail", "6")
        for path in MESHES.glob("*.stl"):
            self.assertGreater(len(triangles(self.folder / path.name)), len(triangles(path)), path.name)


if __name__ == "__main__":
    unittest.main()

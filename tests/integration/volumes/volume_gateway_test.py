"""Series of slices in a running gateway: read with their component, refused by name while it goes on, and not locked."""

import unittest
import zlib

import gateway as g
import series as s

NODE = """
[[node]]
name = "Scan"
abstract = "scan.mpc"
loaded = false
shown = "hidden"
"""


def memory_kib(process, key):
    with open(f"/proc/{process}/status") as status:
        return next(int(line.split()[1]) for line in status if line.startswith(key + ":"))


class SeriesInACell(unittest.TestCase):
    def setUp(self):
        self.scratch = g.Scratch("volume_cell")
        self.folder = self.scratch.home / "envlib/ct"
        (self.scratch.home / "envlib/scan.mpc").write_text('format = 1\n[volume]\nsource = "ct"\norigin = "patient"\n')
        self.scratch.cell_file.write_text(self.scratch.cell_file.read_text() + NODE)
        s.save_all(self.folder, [s.slice_of(k) for k in range(6)], lambda k: f"im{k}")

    def tearDown(self):
        self.scratch.remove()

    def names(self):
        return {volume["name"] for volume in self.scratch.status()["volumes"]}

    def test_is_read_and_refused_while_the_gateway_goes_on(self):
        gateway = g.Gateway(self.scratch)
        try:
            self.assertEqual(self.names(), {"Table.Phantom"})
            slice_3 = (self.folder / "im3").read_bytes()
            (self.folder / "im3").unlink()
            refused = self.scratch.send("ACTIVATE Scan", timeout=60)
            self.assertEqual(refused.returncode, 1)
            self.assertIn("slices are missing between im2 (105.000 mm) and im4", refused.stderr)
            (self.folder / "im3").write_bytes(slice_3[:300] + b"\xff" * 500)
            refused = self.scratch.send("ACTIVATE Scan", timeout=60)
            self.assertEqual(refused.returncode, 1)
            self.assertEqual(self.names(), {"Table.Phantom"})
            (self.folder / "im3").write_bytes(slice_3)
            done = self.scratch.send("ACTIVATE Scan", timeout=60)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertTrue(g.eventually(lambda: self.names() == {"Table.Phantom", "Scan"}), self.names())
            self.assertEqual(self.scratch.send("DELETE_NODE Scan").returncode, 0)
            self.assertTrue(g.eventually(lambda: self.names() == {"Table.Phantom"}), self.names())
            self.assertEqual(gateway.stop(), 0)
        finally:
            gateway.close()

    def test_voxels_are_not_locked_into_memory(self):
        side, mib = 512, 128
        head = (f"NRRD0004\ntype: uchar\ndimension: 3\nsizes: {side} {side} {mib * 4}\nencoding: gzip\nspacings: 1 1 1\n\n")
        packer = zlib.compressobj(1, zlib.DEFLATED, zlib.MAX_WBITS | 16)
        data = b"".join(packer.compress(bytes(1 << 20)) for _ in range(mib)) + packer.flush()
        (self.scratch.home / "envlib/large.nrrd").write_bytes(head.encode() + data)
        (self.scratch.home / "envlib/scan.mpc").write_text('format = 1\n[volume]\nsource = "large.nrrd"\n')
        self.scratch.cell_file.write_text(self.scratch.cell_file.read_text().replace("loaded = false\nshown = \"hidden\"\n", ""))
        gateway = g.Gateway(self.scratch)
        try:
            self.assertEqual(self.names(), {"Table.Phantom", "Scan"})
            process = gateway.child.pid
            locked, resident = memory_kib(process, "VmLck"), memory_kib(process, "VmRSS")
            if locked < 1024:
                self.skipTest("skipped: memory cannot be locked here")
            self.assertGreater(resident, mib * 1024)
            self.assertLess(self.locked_and_resident(process), resident - (mib - 2) * 1024)
        finally:
            gateway.close()

    @staticmethod
    def locked_and_resident(process):
        """KiB: with MCL_ONFAULT reserved memory counts as locked too; what matters is the resident part."""
        with open(f"/proc/{process}/smaps_rollup") as sums:
            return next(int(line.split()[1]) for line in sums if line.startswith("Locked:"))


if __name__ == "__main__":
    unittest.main(verbosity=2)

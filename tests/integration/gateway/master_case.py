"""A gateway on a copy of can_cell with nodes of its own, and a CiA 402 master on their bus."""

import random
import unittest

import gateway as g

try:
    import can  # noqa: F401
    import drive_master
except ImportError:
    drive_master = None


def require():
    """For setUpModule."""
    if drive_master is None:
        raise unittest.SkipTest("skipped: python3-can is not installed")


class MasterCase(unittest.TestCase):
    def cell(self, text, channel):
        """The text of the cell file with nodes on `channel`, from that of can_cell."""
        raise NotImplementedError

    def setUp(self):
        lot = random.SystemRandom()
        group, port = f"239.76.{lot.randrange(1, 255)}.{lot.randrange(1, 255)}", lot.randrange(20000, 60000)
        self.scratch = g.Scratch("can_cell")
        self.addCleanup(self.scratch.remove)
        self.scratch.cell_file.write_text(self.cell(self.scratch.cell_file.read_text(), f"udp:{group}:{port}"))
        self.master = drive_master.Master(group, port)
        self.addCleanup(self.master.close)

    def start_gateway(self):
        self.gateway = g.Gateway(self.scratch)
        self.addCleanup(self.gateway.close)

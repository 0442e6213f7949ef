"""The example of a CANopen master on the cell hil_cell: it boots, homes and moves the drives, and recovers where one stops."""

import random
import subprocess
import unittest

import gateway as g

try:
    import can
except ImportError:
    can = None

MASTER = g.SOURCE / "docs" / "examples" / "canopen_master.py"


def setUpModule():
    if can is None:
        raise unittest.SkipTest("skipped: python3-can is not installed")


class CanopenMaster(unittest.TestCase):
    def setUp(self):
        lot = random.SystemRandom()
        self.channel = f"udp:239.75.{lot.randrange(1, 255)}.{lot.randrange(1, 255)}:{lot.randrange(20000, 60000)}"
        self.scratch = g.Scratch("hil_cell", startup=True)
        self.addCleanup(self.scratch.remove)

    def edit(self, before, after):
        text = self.scratch.cell_file.read_text()
        self.assertIn(before, text)
        self.scratch.cell_file.write_text(text.replace(before, after))

    def master(self):
        return subprocess.run(["/usr/bin/python3", "-B", str(MASTER), "--channel", self.channel, "--rounds", "1"], capture_output=True, text=True,
                              timeout=200)

    def test_it_recovers_where_a_drive_stops(self):
        self.edit("udp:239.74.163.21:43121", self.channel)
        # A mechanical stop before the post: the motor is blocked, and the following error grows.
        self.edit("gear_motor_turns = 100               #", "stops_rad = [-2.9, 0.6]\ngear_motor_turns = 100               #")
        gateway = g.Gateway(self.scratch)
        self.addCleanup(gateway.close)
        done = self.master()
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertRegex(done.stdout, r"homed: (\+0\.10 ){6}rad")
        self.assertRegex(done.stdout, r"stopped: node 1 has the fault 0x(8611|7121), at 0\.[56]")
        self.assertRegex(done.stdout, r"reset\nrecovered: joint 1 is at [+-]0\.0[0-2] rad")
        self.assertIn("0 enabled", self.scratch.robot("ARM_1")["stream"]["condition"], "it has switched the drives off")


if __name__ == "__main__":
    g.main()

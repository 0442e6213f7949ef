"""A network interface appears after the gateway has started: streams, drives and I/O nodes report that they wait, and then work.

Runs in its own network namespace, in which it creates the interface."""

import os
import shutil
import subprocess
import sys
import unittest

import gateway as g

GROUP = "udp:239.74.163.7:43127"
LATE = "late0"
INSIDE = "CELLMIRROR_TEST_INSIDE"
SKIPPED = 77
SPACES = (["unshare", "--net"], ["unshare", "--map-root-user", "--net"])
OTHERS = f"""
[[device]]
robot = "TABLE_1"
protocol = "cia402"
channel = "{GROUP}"
interface = "{LATE}"
[[device.node]]
id = 21
joint = "TURN"
encoder_increments = 65536
[[device.node]]
id = 22
joint = "TILT"
encoder_increments = 65536

[[io_node]]
id = 30
channel = "{GROUP}"
interface = "{LATE}"
[[io_node.input]]
bit = 0
robot = "SCARA_1"
joint = "J_1"
above_rad = 0.5
"""


def ip(*arguments):
    subprocess.run(["ip", *arguments], check=True, timeout=10)


class LateInterface(unittest.TestCase):
    def setUp(self):
        ip("link", "set", "lo", "up")
        self.scratch = g.Scratch("can_cell")
        self.addCleanup(self.scratch.remove)
        text = self.scratch.cell_file.read_text()
        first, table = text.split('[[stream]]\nrobot = "TABLE_1"')
        first = first.replace('channel = "socketcan:vcan0"', f'channel = "{GROUP}"\ninterface = "{LATE}"')
        rest = "\n[startup]" + table.split("[startup]")[1]
        self.scratch.cell_file.write_text(first + OTHERS + rest)
        self.gateway = g.Gateway(self.scratch)
        self.addCleanup(self.gateway.close)

    def problems(self):
        return [problem["text"] for problem in self.scratch.status()["problems"] if problem["kind"] == "stream"]

    def test_streams_wait_for_the_interface_and_are_mirrored_once_it_exists(self):
        for robot in ("SCARA_1", "TABLE_1"):
            done = self.scratch.send(f"ROBOT {robot} online")
            self.assertEqual(done.returncode, 0, done.stderr)
        condition = self.scratch.robot("SCARA_1")["stream"]["condition"]
        self.assertTrue(condition.startswith(f"waits for {LATE}: "), condition)
        (text,) = self.problems()
        for part in (f"waits for {LATE}", "robot SCARA_1", "robot TABLE_1", "I/O node 30"):
            self.assertIn(part, text)
        alarm = g.eventually(lambda: [a for a in self.scratch.status()["alarms"]["open"] if a["subject"] == "stream"])
        self.assertIn(LATE, alarm[0]["text"])

        ip("link", "add", LATE, "type", "veth", "peer", "name", "late1")
        ip("address", "add", "10.99.7.1/24", "dev", LATE)
        ip("link", "set", LATE, "up")
        ip("link", "set", "late1", "up")
        self.assertTrue(g.eventually(lambda: not self.problems()), self.scratch.status()["problems"])
        simulator = g.sim_robot("cia402", "--channel", GROUP, "--interface", LATE, "--nodes", "11-14", "--rate", "100")
        self.addCleanup(simulator.close)
        self.assertTrue(g.eventually(lambda: self.scratch.robot("SCARA_1")["stream"]["state"] == "fresh"),
                        self.scratch.robot("SCARA_1")["stream"])
        self.assertIn("answers as", self.scratch.robot("TABLE_1")["stream"]["condition"])
        self.assertFalse([a for a in self.scratch.status()["alarms"]["open"] if a["subject"] == "stream" and a["state"].startswith("active")])


if __name__ == "__main__":
    if not os.environ.get(INSIDE):
        spaces = next((s for s in SPACES if shutil.which("unshare") and subprocess.run([*s, "true"], stderr=subprocess.DEVNULL).returncode == 0), None)
        if spaces is None or shutil.which("ip") is None:
            print("skipped: no network namespace here")
            sys.exit(SKIPPED)
        os.environ[INSIDE] = "1"
        os.execvp(spaces[0], [*spaces, sys.executable, *sys.argv])
    g.main()

"""A cell made by `cellmirror new` runs, and mirrors the simulated robots that its README names."""

import pathlib
import shlex
import shutil
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree

import gateway as g

ARM = g.CELLS / "ros2_cell/robots/demo_arm/demo_arm.urdf"
EDS = g.CELLS / "can_cell/robots/axis_drive.eds"


class Mirrored(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = g.Scratch("ros2_cell", startup=True)
        shutil.rmtree(cls.scratch.home)
        done = subprocess.run([g.BIN / "cellmirror", "new", cls.scratch.home, "--urdf", ARM, "--topic", "/new_cell_test",
                               "--eds", EDS, "--node", "11", "--channel", "udp:239.74.163.9:43119"], text=True,
                              capture_output=True, stdin=subprocess.DEVNULL, timeout=60, check=True)
        assert "DECIDE" in done.stdout
        cls.robots = []
        for line in (cls.scratch.home / "README.md").read_text().splitlines():
            if line.startswith("sim_robot "):
                words = shlex.split(line)
                cls.robots.append(subprocess.Popen([g.BIN / words[0], *words[1:], "--no-input", "--quiet"],
                                                   cwd=cls.scratch.home))
        cls.gateway = g.Gateway(cls.scratch)

    @classmethod
    def tearDownClass(cls):
        for robot in cls.robots:
            robot.terminate()
            robot.wait()
        cls.gateway.stop()
        cls.gateway.close()
        cls.scratch.remove()

    def test_every_robot_is_fresh_and_plausible(self):
        self.assertEqual(len(self.robots), 2)
        def fresh():
            return all(robot["mode"] == "mirrored" and robot["stream"]["state"] == "fresh" and
                       all(joint["state"] == "fresh" for joint in robot["joints"])
                       for robot in self.scratch.status()["robots"])
        self.assertTrue(g.eventually(fresh), self.scratch.status()["robots"])
        for robot in self.scratch.status()["robots"]:
            self.assertEqual(robot["plausibility"]["implausible_values"], 0, robot)

    def test_a_viewer_that_comes_later_finds_the_description(self):
        """As RViz does: it knows the topic alone."""
        peer = g.BIN / "dds_cyclone_peer"
        if not peer.exists():
            self.skipTest("skipped: dds_cyclone_peer is not built here")
        self.assertTrue(g.eventually(lambda: all(r["sending"] for r in self.scratch.status()["robots"])))
        done = subprocess.run([peer, "description", "0", "rt/robot_description"], capture_output=True, timeout=60, check=True)
        robot = xml.etree.ElementTree.fromstring(done.stdout)
        links = {link.get("name") for link in robot.findall("link")}
        self.assertLessEqual({"world", "demo_arm/base", "demo_arm/turn", "demo_arm/tcp", "AXIS/J_1"}, links)
        joints = {joint.get("name"): joint.get("type") for joint in robot.findall("joint")}
        self.assertEqual(joints["elbow"], "revolute")
        self.assertGreater(len(robot.findall("link/visual")), 8)

    def test_a_sensor_queue_without_a_reader_is_nothing_wrong(self):
        def unread():
            return next(q for q in self.scratch.status()["queues"] if "sensor" in q["name"])["unread"]
        self.assertTrue(g.eventually(lambda: unread() > 0))
        table = self.scratch.cellmirror("status").stdout
        self.assertIn("nothing dropped; nobody reads sensor queue", table)


if __name__ == "__main__":
    g.main()

"""The live server against @foxglove/ws-protocol as a client: every kind of message that both have."""

import json
import unittest

import gateway as g
from judges import PACKAGES


class Live(unittest.TestCase):
    def setUp(self):
        self.scratch = g.Scratch()
        self.addCleanup(self.scratch.remove)
        self.gateway = g.Gateway(self.scratch, page=True)
        self.addCleanup(self.gateway.close)

    def test_a_client_of_others(self):
        page = json.loads(self.scratch.cellmirror("page", "--json", "--instance", self.scratch.instance).stdout)
        url = page["address"].replace("http://", "ws://")
        mesh = self.scratch.home / "envlib" / "meshes" / "coupling.stl"
        for protocol in ("foxglove.websocket.v1", "foxglove.sdk.v1"):
            found = PACKAGES.run("live.mjs", url, protocol, page["token"], "package://cell/envlib/meshes/coupling.stl")
            self.assertEqual(found["errors"], [])
            self.assertEqual(found["protocol"], protocol)
            self.assertEqual(found["info"]["metadata"]["instance"], self.scratch.instance)
            self.assertEqual(found["topics"]["/joint_states"], ["cdr", "sensor_msgs/msg/JointState", "ros2msg"])
            self.assertIn("token", found["without"]["failure"])
            self.assertEqual(found["with"], {"done": True})
            self.assertEqual(found["parameters"]["/robot_description"], "string")
            self.assertEqual(found["changed"], "/cellmirror/warning_distance_m")
            self.assertEqual((found["asset"]["status"], found["asset"]["bytes"]), (0, mesh.stat().st_size))
            self.assertEqual(found["refused"]["status"], 1)
            self.assertTrue(found["refused"]["error"])
            self.assertGreater(found["times"], 0)
            joints = found["messages"]["/joint_states"]["value"]
            status = self.scratch.status()
            self.assertEqual(len(joints["name"]), sum(len(robot["joints"]) for robot in status["robots"]))
            self.assertEqual(found["messages"]["/tf"]["value"]["transforms"][0]["header"]["frame_id"], "world")
            self.assertEqual(found["messages"]["/cellmirror/status"]["value"]["instance"], self.scratch.instance)
            self.assertEqual(found["messages"]["/cellmirror/commands"]["value"]["command"], "ROBACT PUMA_762")
            self.scratch.send("SET_COLLPAR warning 50")


if __name__ == "__main__":
    PACKAGES.main()

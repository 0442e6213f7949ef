"""A running gateway as a server of the Foxglove WebSocket protocol: topics, commands, parameters, files, and bad clients."""

import http.client
import json
import os
import re
import struct
import unittest

import gateway as g
from foxglove_client import Foxglove, frames, joint_state
from page_client import Page


def setUpModule():
    """One gateway for all: what a test changes, no other one looks at."""
    FoxgloveCase.scratch = scratch = g.Scratch()
    outside = scratch.root / "outside.stl"
    outside.write_text("solid secret\nendsolid\n")
    (scratch.home / "envlib" / "meshes" / "link.stl").symlink_to(outside)
    FoxgloveCase.gateway = g.Gateway(scratch, page=True)
    FoxgloveCase.page = Page(json.loads(scratch.cellmirror("page", "--json", "--instance", scratch.instance).stdout))


def tearDownModule():
    FoxgloveCase.gateway.close()
    FoxgloveCase.scratch.remove()


class FoxgloveCase(unittest.TestCase):
    def connect(self, *arguments, **keywords):
        client = Foxglove(self.page, *arguments, **keywords)
        self.addCleanup(client.close)
        return client

    def request(self, **members):
        return json.dumps(members).encode()


class Topics(FoxgloveCase):
    def test_both_subprotocols_are_accepted_and_the_server_says_what_it_has(self):
        for protocol in ("foxglove.websocket.v1", "foxglove.sdk.v1"):
            for path in ("/", "/foxglove"):
                client = self.connect(protocol, path)
                self.assertIn(f"Sec-WebSocket-Protocol: {protocol}\r\n", client.head + "\r\n")
                info = client.hear()
                self.assertEqual(info["op"], "serverInfo")
                self.assertEqual(set(info["capabilities"]), {"time", "parameters", "parametersSubscribe", "services", "assets"})
                self.assertEqual(info["metadata"]["instance"], self.scratch.instance)
                client.until_op("advertise")
                client.until_op("advertiseServices")
                channel = client.channels["/joint_states"]
                self.assertEqual((channel["encoding"], channel["schemaName"], channel["schemaEncoding"]),
                                 ("cdr", "sensor_msgs/msg/JointState", "ros2msg"))
                self.assertIn("float64[] position", channel["schema"])
                collisions = client.channels["/cellmirror/collisions"]
                self.assertEqual((collisions["encoding"], collisions["schemaEncoding"]), ("json", "jsonschema"))
                self.assertEqual(json.loads(collisions["schema"])["type"], "object")
                client.close()

    def test_who_may_connect(self):
        def opened(**headers):
            connection = http.client.HTTPConnection(self.page.host, self.page.port, timeout=60)
            connection.request("GET", "/", headers={
                "Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==", "Sec-WebSocket-Version": "13",
                **{name.replace("_", "-"): value for name, value in headers.items()}})
            status = connection.getresponse().status
            connection.close()
            return status
        protocol = "foxglove.sdk.v1"
        self.assertEqual(opened(Sec_WebSocket_Protocol=protocol), 101)
        self.assertEqual(opened(Sec_WebSocket_Protocol="foxglove.websocket.v2"), 400)
        self.assertEqual(opened(), 400)
        self.assertEqual(opened(Sec_WebSocket_Protocol=protocol, Origin="https://app.example.org"), 403)
        self.assertEqual(opened(Sec_WebSocket_Protocol=protocol, Host="attacker.example.org"), 421)
        self.assertEqual(self.page.ask("/")[0], 200, "the page is where it was")

    def test_messages_are_what_status_says(self):
        client = self.connect()
        client.subscribe("/joint_states", 7)
        client.subscribe("/tf", 8)
        status = self.scratch.status()
        time_ns, data = client.data(7)
        stamp, joints = joint_state(data)
        self.assertLess(abs(time_ns / 1e9 - stamp), 10)
        self.assertEqual(len(joints), sum(len(robot["joints"]) for robot in status["robots"]))
        for robot in status["robots"]:
            for joint in robot["joints"]:
                position = joints.get(joint["name"], joints.get(f"{robot['id']}/{joint['name']}"))
                self.assertAlmostEqual(position, joint["position"], places=6)
        of_frames = frames(client.data(8)[1])
        self.assertTrue(all(parent == "world" or parent in of_frames for parent, _ in of_frames.values()))
        self.assertTrue(any(child.endswith("/tcp") for child in of_frames))
        time, = struct.unpack("<Q", client.until_binary(client.TIME)[1:])
        self.assertGreaterEqual(time, time_ns)
        live = {topic["topic"]: topic for topic in self.scratch.status()["page"]["foxglove"]["topics"]}
        self.assertGreaterEqual(live["/tf"]["subscribers"], 1)
        self.assertGreater(live["/joint_states"]["sent"], 0)
        # Only what is subscribed to comes.
        client.say(op="unsubscribe", subscriptionIds=[7])
        client.say(op="fetchAsset", uri="x", requestId=99)
        client.until_binary(client.ASSET, 99)
        for _ in range(20):
            message = client.until_binary(client.DATA)
            self.assertEqual(struct.unpack_from("<I", message, 1)[0], 8)

    def test_commands_and_their_log_come_as_topics(self):
        client = self.connect()
        client.subscribe("/cellmirror/commands", 3)
        client.subscribe("/rosout", 4)
        client.say(op="fetchAsset", uri="x", requestId=1)  # answered: the subscriptions were taken
        client.until_binary(client.ASSET, 1)
        self.assertEqual(self.scratch.send("ROBACT PUMA_762").returncode, 0)
        self.assertEqual(json.loads(client.data(3)[1])["command"], "ROBACT PUMA_762")


class Commands(FoxgloveCase):
    def test_a_command_needs_the_token(self):
        client = self.connect()
        command = "ROBACT MANTEC_R3"
        self.assertEqual(client.call(self.request(command=command)),
                         (b"", "commands need the field token of the request; cellmirror page --json prints it"))
        self.assertIn("wrong token", client.call(self.request(command=command, token="0" * 32))[1])
        self.assertFalse(self.scratch.robot("MANTEC_R3")["active"])
        response, failure = client.call(self.request(command=command, token=self.page.token))
        self.assertEqual(failure, "")
        self.assertEqual(json.loads(response), {"done": True})
        self.assertTrue(self.scratch.robot("MANTEC_R3")["active"])
        response, _ = client.call(self.request(command="ROBACT NOBODY", token=self.page.token))
        self.assertFalse(json.loads(response)["done"])
        self.assertNotIn(self.page.token, self.gateway.output())
        self.assertNotIn(self.page.token, json.dumps(self.scratch.status()))
        authorized = self.connect(headers=[("Authorization", f"Bearer {self.page.token}")])
        self.assertEqual(authorized.call(self.request(command="ROBACT PUMA_762"))[1], "")

    def test_three_wrong_tokens_end_the_connection(self):
        client = self.connect()
        for _ in range(2):
            self.assertIn("wrong token", client.call(self.request(command="ROBACT PUMA_762", token="x"))[1])
        with self.assertRaises(ConnectionError):
            client.call(self.request(command="ROBACT PUMA_762", token="x"))
            while True:
                client.hear()

    def test_malformed_calls_fail_and_nothing_else(self):
        client = self.connect()
        for payload in (b"", b"[]", b"{", self.request(token=self.page.token), self.request(command=7), self.request(command="  "),
                        self.request(command="x" * 9000)):
            self.assertTrue(client.call(payload)[1], payload)
        good = self.request(command="ROBACT PUMA_762", token=self.page.token)
        self.assertIn("no such service", client.call(good, service=2)[1])
        self.assertIn("JSON", client.call(good, encoding=b"cdr")[1])
        self.assertEqual(client.call(good)[1], "")

    def test_parameters(self):
        client = self.connect()
        distance = "/cellmirror/warning_distance_m"

        def values(message):
            return {one["name"]: one.get("value") for one in message["parameters"]}
        client.say(op="getParameters", parameterNames=[], id="all")
        everything = values(client.until_op("parameterValues", id="all"))
        self.assertGreater(everything[distance], 0)
        self.assertGreater(everything["/cellmirror/loop_rate_hz"], 0)
        self.assertIn("<robot name=", everything["/robot_description"])
        wanted = {"name": distance, "value": 0.123}
        client.say(op="setParameters", parameters=[wanted], id="set")
        self.assertIn("token", client.until_op("status", level=2)["message"])
        client.say(op="subscribeParameterUpdates", parameterNames=[distance])
        self.assertEqual(values(client.until_op("parameterValues"))[distance], everything[distance])
        self.assertEqual(client.call(self.request(command="ROBACT PUMA_762", token=self.page.token))[1], "")
        client.say(op="setParameters", parameters=[wanted])
        self.assertAlmostEqual(values(client.until_op("parameterValues"))[distance], 0.123)
        client.say(op="setParameters", parameters=[{"name": distance, "value": -1}, {"name": "/robot_description", "value": 3}])
        self.assertIn(distance, client.until_op("status", level=2)["message"])
        self.assertIn("cannot be set", client.until_op("status", level=2)["message"])
        client.say(op="setParameters", parameters=[{"name": "/cellmirror/live_rate_hz", "value": 20}], id="rate")
        self.assertEqual(values(client.until_op("parameterValues", id="rate")), {"/cellmirror/live_rate_hz": 20})


class Files(FoxgloveCase):
    def test_the_description_of_the_robots_and_its_meshes(self):
        client = self.connect()
        description, error = client.asset("package://cell/robot_description.urdf")
        self.assertEqual(error, "")
        meshes = set(re.findall(r'<mesh filename="([^"]*)"', description.decode()))
        self.assertGreater(len(meshes), 3)
        for uri in sorted(meshes):
            self.assertTrue(uri.startswith("package://cell/"), uri)
            content, error = client.asset(uri)
            self.assertEqual(error, "", uri)
            self.assertEqual(content, (self.scratch.home / uri.removeprefix("package://cell/")).read_bytes())

    def test_other_files_are_refused(self):
        client = self.connect()
        (self.scratch.home / "secret.txt").write_text("secret")
        os.symlink("secret.txt", self.scratch.home / "looks_like.png")
        for uri in ("package://cell/../outside.stl", "package://cell/%2e%2e/outside.stl", "package://cell//etc/passwd",
                    "package://cell/envlib/meshes/link.stl", "package://cell/cell.toml", "package://cell/secret.txt",
                    "package://cell/looks_like.png", "package://cell/envlib", "package://cell/%00.stl", "package://cell/none.stl",
                    "package://other/a.stl", f"file://{self.scratch.home}/envlib/meshes/coupling.stl", "", "x" * 1000):
            content, error = client.asset(uri)
            self.assertEqual(content, b"", uri)
            self.assertTrue(error, uri)


class BadClients(FoxgloveCase):
    def test_what_is_not_understood_is_answered_and_not_fatal(self):
        client = self.connect()
        client.until_op("advertiseServices")
        for message in (dict(op="nonsense"), dict(op="subscribeConnectionGraph"), dict(op="advertise", channels=[]), dict(no="op"),
                        dict(op="subscribe"), dict(op="subscribe", subscriptions=[{"id": 1, "channelId": 10**6}]),
                        dict(op="subscribe", subscriptions=[{"id": -1, "channelId": 1}]), dict(op="subscribe", subscriptions=[{}] * 600),
                        dict(op="unsubscribe", subscriptionIds=[77]), dict(op="getParameters", parameterNames=[7]),
                        dict(op="setParameters", parameters=[{"name": "x", "value": [1]}]), dict(op="fetchAsset", uri=5, requestId=1)):
            client.say(**message)
            self.assertEqual(client.until_op("status")["level"], 2, message)
        for data in (b"", b"\x63", b"\x01\x00", b"\x02\x01", struct.pack("<BIII", 2, 1, 1, 0xFFFFFFFF)):
            client.say_bytes(data)
            self.assertEqual(client.until_op("status")["level"], 2, data)
        client._send(1, b"{not json")
        client.until_op("status", level=2)
        for _ in range(2):
            client.subscribe("/tf", 1)
        client.until_op("status", level=2)
        client.data(1)


if __name__ == "__main__":
    unittest.main(verbosity=2)

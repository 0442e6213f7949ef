"""The gateway as an edge node of Sparkplug B, judged by npm's sparkplug-payload: as a decoder of what it says, as the
encoder of the command that it takes."""

import json
import pathlib
import subprocess

import brokers
import gateway as g
from npm_packages import Packages

PACKAGES = Packages(pathlib.Path(__file__).resolve().parent, g.BIN.parent / "mqtt_peers")
NODE = "spBv1.0/hall/{}/n1"


def setUpModule():
    brokers.require()


class Sparkplug(brokers.MqttCase):
    def setUp(self):
        self.broker = brokers.Broker()
        self.addCleanup(self.broker.close)
        self.make(self.broker, joint_states_hz=20, sparkplug='{ group = "hall", edge_node = "n1" }')
        self.listener = g.Process(["mosquitto_sub", "-h", "127.0.0.1", "-p", str(self.broker.port), "-t", "spBv1.0/#", "-t", "test", "-F",
                                   "%t %x"])
        self.addCleanup(self.listener.close)

        def hears():
            brokers.publish(self.broker, "test", "x")
            return "test 78" in self.listener.output()

        self.assertTrue(g.eventually(hears))
        self.start()

    def messages(self):
        """(topic, decoded payload), oldest first."""
        lines = [line for line in self.listener.output().splitlines() if line.startswith("spBv1.0/") and len(line.split()) == 2]
        file = self.scratch.root / "messages"
        file.write_text("\n".join(lines))
        return [(one["topic"], one["payload"]) for one in PACKAGES.run("sparkplug.mjs", "decode", file)]

    def of(self, kind, device=""):
        topic = NODE.format(kind) + (f"/{device}" if device else "")
        return [payload for at, payload in self.messages() if at == topic]

    def test_birth_data_rebirth_and_death(self):
        self.assertTrue(g.eventually(lambda: self.of("DBIRTH", brokers.ROBOT), every=0.5))
        birth = self.of("NBIRTH")[-1]
        metrics = {one["name"]: one for one in birth["metrics"]}
        self.assertEqual((birth["seq"], metrics["bdSeq"]["type"], metrics["bdSeq"]["value"]), (0, "Int64", 0))
        self.assertEqual(metrics["Node Control/Rebirth"]["value"], False)
        self.assertEqual(metrics["Properties/Cell"]["value"], brokers.CELL)
        self.scratch.send(f"ROBOT {brokers.ROBOT} send_on")
        joint = self.scratch.robot(brokers.ROBOT)["joints"][0]

        def told():
            names = {one["name"]: one for one in self.of("DBIRTH", brokers.ROBOT)[-1]["metrics"]}
            return names.get(f"Joints/{joint['name']}/Position")

        self.assertTrue(g.eventually(told, every=0.5), self.of("DBIRTH", brokers.ROBOT))
        self.assertEqual(told()["type"], "Double")
        self.assertAlmostEqual(told()["value"], joint["position"], places=6)
        births = len(self.of("NBIRTH"))
        file = self.scratch.root / "command"
        PACKAGES.run("sparkplug.mjs", "rebirth", file)
        subprocess.run(["mosquitto_pub", "-h", "127.0.0.1", "-p", str(self.broker.port), "-t", NODE.format("NCMD"), "-f", file], check=True,
                       timeout=g.PATIENCE_S)
        self.assertTrue(g.eventually(lambda: len(self.of("NBIRTH")) > births, every=0.5))
        self.assertEqual(self.gateway.stop(), 0)
        self.assertTrue(g.eventually(lambda: self.of("NDEATH"), every=0.5))
        death = self.of("NDEATH")[-1]
        self.assertEqual([(one["name"], one["value"]) for one in death["metrics"]], [("bdSeq", 0)])
        self.check_order()

    def test_a_robot_without_data_is_dead_and_sessions_are_counted_on(self):
        births = lambda: len(self.of("DBIRTH", brokers.ROBOT))
        self.assertTrue(g.eventually(births, every=0.5))
        self.scratch.send(f"ROBOT {brokers.ROBOT} online")
        self.assertTrue(g.eventually(lambda: self.of("DDEATH", brokers.ROBOT), every=0.5), "nothing sends")
        before = births()
        names = ",".join(f"puma_762_joint_{i}" for i in range(1, 7))
        robot = g.sim_robot("dds", "--joint-names", names, "--rate", "50")
        self.addCleanup(robot.close)
        self.assertTrue(g.eventually(lambda: births() > before, every=0.5))
        self.assertEqual(self.gateway.stop(), 0)
        self.start()
        self.assertTrue(g.eventually(lambda: [self.session_of(one) for one in self.of("NBIRTH")][-1] == 1, every=0.5))
        self.check_order()

    @staticmethod
    def session_of(birth):
        return next(one["value"] for one in birth["metrics"] if one["name"] == "bdSeq")

    def check_order(self):
        """The numbers have no gap, and nothing of a device comes before its birth."""
        expected, born = None, set()
        for topic, payload in self.messages():
            kind = topic.split("/")[2]
            if kind in ("NCMD", "NDEATH"):
                continue
            if kind == "NBIRTH":
                expected, born = 0, set()
            self.assertEqual(payload["seq"], expected, topic)
            expected = (expected + 1) % 256
            if kind == "DBIRTH":
                born.add(topic.split("/")[4])
            if kind == "DDEATH":
                self.assertIn(topic.split("/")[4], born)
                born.remove(topic.split("/")[4])
            if kind == "DDATA":
                self.assertIn(topic.split("/")[4], born)


if __name__ == "__main__":
    PACKAGES.main()

"""A broker that dies, comes back, stands still, or was never there."""

import signal
import socket
import unittest

import brokers
import gateway as g
from brokers import BASE, ROBOT


def setUpModule():
    brokers.require()


class Away(brokers.MqttCase):
    def setUp(self):
        self.broker = brokers.Broker()
        self.addCleanup(self.broker.close)

    def test_a_broker_that_was_killed_is_found_again_and_hears_what_happened(self):
        self.make(self.broker, joint_states_hz=50)
        self.start()
        for robot in self.scratch.status()["robots"]:
            self.scratch.send(f"ROBOT {robot['id']} send_on")
        self.broker.kill()
        self.assertTrue(g.eventually(self.problems))
        self.assertIn("nothing reaches the MQTT broker", self.problems()[0])
        # The problem is an alarm, which is an event that waits.
        self.assertTrue(g.eventually(lambda: self.counters()["events"] > 0))
        self.assertTrue(g.eventually(lambda: self.counters()["joint_states_dropped"] > 2000))
        before = self.counters()
        self.assertLess(before["waiting_bytes"], 3 << 20)
        dropped = before["joint_states_dropped"]
        self.assertTrue(g.eventually(lambda: self.counters()["joint_states_dropped"] > dropped + 2000))
        # 2000 joint states are more than half a megabyte; the events of these seconds are a few kilobytes.
        self.assertLess(self.counters()["waiting_bytes"] - before["waiting_bytes"], 100_000, "what waits is bounded")
        self.broker.start()
        listener = brokers.Listener(self.broker, f"{BASE}/#")
        self.addCleanup(listener.close)
        self.connected()
        self.assertTrue(g.eventually(lambda: listener.all(f"{BASE}/state")))
        self.assertTrue(g.eventually(lambda: any(one["alarm"]["subject"] == "mqtt" for one in listener.events("alarm"))),
                        listener.process.output()[-2000:])
        self.assertTrue(g.eventually(lambda: not self.problems()))
        self.assertEqual(self.counters()["connections"], 2)

    def test_a_broker_that_stands_still_holds_up_nothing(self):
        self.make(self.broker, keep_alive_s=5, joint_states_hz=50, commands=True)
        self.start()
        for robot in self.scratch.status()["robots"]:
            self.scratch.send(f"ROBOT {robot['id']} send_on")
        self.broker.signal(signal.SIGSTOP)
        self.assertTrue(g.eventually(lambda: self.counters()["joint_states_dropped"] > 500), self.counters())
        self.assertEqual(self.scratch.send(f"ROBACT {ROBOT}").returncode, 0)
        self.assertTrue(g.eventually(self.problems), "the connection is given up")
        failures = self.counters()["failures"]
        self.assertTrue(g.eventually(lambda: self.counters()["failures"] > failures), "the kernel connects, nobody answers")
        self.assertIn("answer", self.problems()[0])
        self.broker.signal(signal.SIGCONT)
        self.connected()
        self.assertTrue(brokers.ask(self.broker, {"command": f"ROBACT {ROBOT}"})["done"])

    def test_the_gateway_ends_at_once_whatever_the_broker_does(self):
        self.make(self.broker)
        self.start()
        self.broker.signal(signal.SIGSTOP)
        self.assertEqual(self.gateway.stop(20), 0)

    def test_a_gateway_starts_without_a_broker_and_one_that_does_not_answer_the_connection(self):
        self.broker.kill()
        with socket.socket() as full:
            # With a full backlog the kernel answers nobody: to a client it is as a machine that is off.
            full.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            full.bind(("127.0.0.1", self.broker.port))
            full.listen(0)
            fillers = [socket.socket() for _ in range(4)]
            for one in fillers:
                one.setblocking(False)
                one.connect_ex(("127.0.0.1", self.broker.port))
            self.make(self.broker)
            self.start(connected=False)
            self.assertTrue(g.eventually(self.problems))
            for one in fillers:
                one.close()
        self.broker.start()
        self.connected()


if __name__ == "__main__":
    g.main()

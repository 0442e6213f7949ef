"""The gateway on an MQTT broker: what it says, and commands that it takes from there."""

import json
import subprocess
import unittest

import brokers
import gateway as g
from brokers import BASE, ROBOT


def setUpModule():
    brokers.require()


class Saying(brokers.MqttCase):
    def setUp(self):
        self.broker = brokers.Broker()
        self.addCleanup(self.broker.close)

    def listen(self, topic="#"):
        listener = brokers.Listener(self.broker, topic)
        self.addCleanup(listener.close)
        return listener

    def test_another_client_with_the_same_id_is_suspected(self):
        self.make(self.broker, client_id="same")
        self.start()
        other = g.Process(["mosquitto_sub", "-h", "127.0.0.1", "-p", str(self.broker.port), "-t", "x", "-i", "same"])
        self.addCleanup(other.close)
        self.assertTrue(g.eventually(lambda: any("same client_id" in one for one in self.problems())), self.problems())
        self.assertTrue(g.eventually(lambda: "another client has the same client_id" in self.gateway.output()), self.gateway.output())

    def test_state_summary_joint_states_and_the_end(self):
        brokers.publish(self.broker, f"{BASE}/state", "rubbish of others", ["-r"])
        self.make(self.broker, joint_states_hz=20)
        self.start()
        listener = self.listen()
        state = listener.all(f"{BASE}/state")
        self.assertEqual(state[-1]["online"], True, "what others had put there is overwritten")
        self.assertEqual((state[-1]["instance"], state[-1]["commands"]), (self.scratch.instance, False))
        self.assertTrue(g.eventually(lambda: len(listener.all(f"{BASE}/summary")) > 3))
        summary = listener.all(f"{BASE}/summary")[-1]
        self.assertEqual((summary["cellmirror_summary"], summary["cell"]), (1, brokers.CELL))
        self.assertEqual([one["id"] for one in summary["robots"]], [one["id"] for one in self.scratch.status()["robots"]])
        self.assertEqual(listener.all(f"{BASE}/joint_states/{ROBOT}"), [], "not before send_on")
        self.assertEqual(self.scratch.send(f"ROBOT {ROBOT} send_on").returncode, 0)
        self.assertTrue(g.eventually(lambda: len(listener.all(f"{BASE}/joint_states/{ROBOT}")) > 20))
        times = [one["time_ms"] for one in listener.all(f"{BASE}/joint_states/{ROBOT}")]
        steps = sorted(after - before for before, after in zip(times, times[1:]))
        self.assertTrue(40 <= steps[len(steps) // 2] <= 60, f"20 Hz: {steps}")
        joints = listener.all(f"{BASE}/joint_states/{ROBOT}")[-1]
        robot = self.scratch.robot(ROBOT)
        self.assertEqual(joints["name"], [one["name"] for one in robot["joints"]])
        for position, joint in zip(joints["position"], robot["joints"]):
            self.assertAlmostEqual(position, joint["position"], places=6)
        self.assertEqual(self.gateway.stop(), 0)
        self.assertTrue(g.eventually(lambda: listener.all(f"{BASE}/state")[-1] == {"online": False, "reason": "stopped"}))
        late = self.listen(f"{BASE}/#")
        self.assertEqual(late.all(f"{BASE}/state")[-1]["online"], False, "it is retained")

    def test_a_killed_gateway_is_told_by_its_last_will(self):
        self.make(self.broker, keep_alive_s=5)
        self.start()
        listener = self.listen(f"{BASE}/state")
        self.gateway.kill()
        self.assertTrue(g.eventually(lambda: listener.all(f"{BASE}/state")[-1] == {"online": False, "reason": "lost"}))
        self.start()
        self.assertTrue(g.eventually(lambda: listener.all(f"{BASE}/state")[-1]["online"]), "its next run")

    def test_events_of_alarms_and_collisions(self):
        self.make(self.broker)
        self.start()
        listener = self.listen(f"{BASE}/event")
        # A bound that many pairs are within, but fewer than the gateway keeps events where the broker is slow.
        self.assertEqual(self.scratch.send("SET_COLLPAR warning 800").returncode, 0)
        self.assertTrue(g.eventually(lambda: listener.events("collision")), listener.process.output())
        event = listener.events("collision")[0]
        self.assertEqual(event["change"], "entered_warning")
        self.assertGreater(event["distance_m"], 0)
        self.assertTrue(g.eventually(lambda: any(one["alarm"]["kind"] == "near" for one in listener.events("alarm"))))
        numbers = [one["number"] for one in listener.all(f"{BASE}/event")]
        self.assertEqual(sorted(numbers), list(range(numbers[0], numbers[0] + len(numbers))), "none is missing")


class Commands(brokers.MqttCase):
    def setUp(self):
        self.broker = brokers.Broker()
        self.addCleanup(self.broker.close)

    def log(self):
        lines = (self.scratch.home / "records" / f"commands-{self.scratch.instance}.jsonl").read_text().splitlines()
        return [one for one in map(json.loads, lines) if one["source"] == "mqtt"]

    def test_commands_are_answered_and_logged(self):
        self.make(self.broker, commands=True)
        self.start()
        answer = brokers.ask(self.broker, {"command": f"ROBACT {ROBOT}", "id": 7})
        self.assertEqual((answer["done"], answer["id"]), (True, 7))
        answer = brokers.ask(self.broker, {"command": "ROBACT nobody", "id": "x"})
        self.assertEqual((answer["done"], answer["id"]), (False, "x"))
        self.assertIn("nobody", answer["text"])
        self.assertTrue(g.eventually(lambda: len(self.log()) == 2))
        self.assertEqual([one["outcome"] for one in self.log()], ["done", "refused"])
        self.assertEqual(self.log()[0]["peer"], f"broker 127.0.0.1:{self.broker.port}")

    def test_rubbish_is_refused_and_what_the_broker_keeps_is_never_executed(self):
        brokers.publish(self.broker, f"{BASE}/command", json.dumps({"command": f"ROBOT {ROBOT} send_on"}), ["-r"])
        self.make(self.broker, commands=True)
        self.start()
        self.assertTrue(g.eventually(lambda: self.counters()["retained_ignored"] == 1))
        listener = brokers.Listener(self.broker, f"{BASE}/reply/#")
        self.addCleanup(listener.close)
        for rubbish in ("", "rubbish", "[]", '{"command":5}', "x" * 20_000):
            brokers.publish(self.broker, f"{BASE}/command", rubbish)
        self.assertTrue(g.eventually(lambda: len(listener.all(f"{BASE}/reply")) == 5), listener.process.output()[:2000])
        self.assertTrue(all(not one["done"] and one["text"] for one in listener.all(f"{BASE}/reply")))
        # More than the gateway lets the broker send: the broker keeps it.
        brokers.publish(self.broker, f"{BASE}/command", "x" * 100_000)
        self.assertTrue(brokers.ask(self.broker, {"command": f"ROBACT {ROBOT}"})["done"])
        self.assertEqual(self.counters()["commands"], 1)
        self.assertFalse(self.scratch.robot(ROBOT)["sending"], "the retained command was not executed")

    def test_of_a_flood_few_are_taken_and_the_loop_does_not_feel_it(self):
        self.make(self.broker, commands=True, commands_per_s=5)
        self.start()
        lines = (json.dumps({"command": f"ROBACT {ROBOT}"}) + "\n") * 20_000
        subprocess.run(["mosquitto_pub", "-h", "127.0.0.1", "-p", str(self.broker.port), "-t", f"{BASE}/command", "-l"], input=lines, text=True,
                       check=True, timeout=g.PATIENCE_S)
        # The broker itself may drop some of them.
        self.assertTrue(g.eventually(lambda: self.counters()["commands_flooded"] > 500), self.counters())
        counters = self.counters()
        self.assertLess(counters["commands"], 500)
        self.assertTrue(g.eventually(lambda: self.counters()["waiting"] == 0), self.counters())
        self.assertLess(len(self.log()), 700, "the log of commands does not grow with the flood")
        # In the flood a command of others is not answered either.
        self.assertTrue(g.eventually(lambda: brokers.ask(self.broker, {"command": f"ROBACT {ROBOT}"}, patience=3)))

    def test_a_broker_that_is_spoken_to_in_3_1_1(self):
        self.make(self.broker, commands=True, protocol="3.1.1")
        self.start()
        listener = brokers.Listener(self.broker, f"{BASE}/reply")
        self.addCleanup(listener.close)
        brokers.publish(self.broker, f"{BASE}/command", json.dumps({"command": f"ROBACT {ROBOT}", "id": "old"}))
        self.assertTrue(g.eventually(lambda: listener.all(f"{BASE}/reply")))
        answer = listener.all(f"{BASE}/reply")[0]
        self.assertEqual((answer["done"], answer["id"]), (True, "old"))

    def test_nothing_is_taken_where_it_is_not_allowed(self):
        self.make(self.broker)
        self.start()
        brokers.publish(self.broker, f"{BASE}/command", json.dumps({"command": f"ROBOT {ROBOT} send_on"}))
        sent = self.counters()["sent"]
        self.assertTrue(g.eventually(lambda: self.counters()["sent"] > sent + 3))
        self.assertEqual(self.counters()["received"], 0)
        self.assertFalse(self.scratch.robot(ROBOT)["sending"])


if __name__ == "__main__":
    g.main()

"""Alarms of a running gateway: raised by a stream that falters, acknowledged by name, kept over a restart."""

import json
import stat
import unittest
import urllib.request

import gateway as g

ROBOT = "MANTEC_R3"  # CiA 402 over udp multicast in the transfer cell
CHANNEL = "udp:239.74.163.9:43127"  # of this test alone: another simulated robot would keep the stream alive
PATIENCE_S = g.PATIENCE_S


class Alarms(unittest.TestCase):
    def setUp(self):
        self.scratch = g.Scratch()
        self.addCleanup(self.scratch.remove)
        cell = self.scratch.cell_file.read_text()
        self.assertIn('channel = "udp:239.74.163.2:43113"', cell)
        self.scratch.cell_file.write_text(cell.replace('channel = "udp:239.74.163.2:43113"', f'channel = "{CHANNEL}"'))
        self.file = self.scratch.home / "records" / f"alarms-{self.scratch.instance}.jsonl"

    def start(self):
        gateway = g.Gateway(self.scratch, page=True)
        self.addCleanup(gateway.close)
        return gateway

    def robot(self):
        robot = g.sim_robot("cia402", "--channel", CHANNEL, "--nodes", "1-6", "--rate", "100")
        self.addCleanup(robot.close)
        return robot

    def alarm(self, where, matches):
        """The alarm of the robot's stream, once it is in the list and `matches` it."""
        def look():
            listed = self.scratch.status()["alarms"][where]
            return next((alarm for alarm in listed if alarm["kind"] == "stream" and alarm["subject"] == ROBOT and matches(alarm)), None)
        found = g.eventually(look, PATIENCE_S)
        self.assertTrue(found, self.scratch.status()["alarms"])
        return found

    def test_a_life(self):
        gateway = self.start()
        robot = self.robot()
        self.assertEqual(self.scratch.send(f"ROBOT {ROBOT} online").returncode, 0)
        self.assertTrue(g.eventually(lambda: self.scratch.robot(ROBOT)["stream"]["state"] == "fresh", PATIENCE_S))
        robot.close()
        lost = self.alarm("open", lambda alarm: alarm["state"] == "active_unacknowledged" and alarm["priority"] == "high")
        self.assertIn(f"the data of {ROBOT} are lost", lost["text"])

        # By name; who was first stays.
        done = self.scratch.send(f"ALARM_ACK Ada {lost['id']}")
        self.assertEqual(done.returncode, 0, done.stderr)
        again = self.scratch.send(f"ALARM_ACK Bo {lost['id']}")
        self.assertIn("was acknowledged before", again.stdout + again.stderr)
        known = self.alarm("open", lambda alarm: alarm["state"] == "active_acknowledged")
        self.assertEqual((known["id"], known["acknowledged_by"]), (lost["id"], "Ada"))
        refused = self.scratch.send("ALARM_ACK 12")
        self.assertEqual(refused.returncode, 1)
        self.assertIn("ALARM_ACK Ada 12", refused.stdout + refused.stderr)
        self.assertEqual(self.scratch.send("ALARM_ACK Ada 99999").returncode, 1)
        table = self.scratch.cellmirror("status").stdout
        self.assertRegex(table, r"alarms +\d+ active")

        # The page and monitoring see the same.
        address = self.scratch.status()["page"]["address"].rstrip("/")
        page = json.load(urllib.request.urlopen(address + "/api/alarms", timeout=60))
        self.assertEqual([alarm["acknowledged_by"] for alarm in page["open"] if alarm["id"] == lost["id"]], ["Ada"])
        metrics = urllib.request.urlopen(address + "/metrics", timeout=60).read().decode()
        self.assertRegex(metrics, r'cellmirror_alarms\{state="active_acknowledged"\} [1-9]')
        self.assertRegex(metrics, r'cellmirror_alarms_raised_total\{priority="high"\} [1-9]')

        # Over when the robot is back; the history outlives the gateway, and numbers go on.
        robot = self.robot()
        over = self.alarm("history", lambda alarm: alarm["id"] == lost["id"])
        self.assertTrue(over["cleared_time"])
        self.assertEqual(stat.S_IMODE(self.file.stat().st_mode), 0o600)
        self.assertEqual(gateway.stop(), 0)
        gateway.close()
        with self.file.open("a") as file:
            file.write("not an alarm\n")
        self.start()
        kept = self.alarm("history", lambda alarm: alarm["id"] == lost["id"])
        self.assertEqual({**kept, "age_s": 0}, {**over, "age_s": 0})
        self.assertEqual(self.scratch.status()["alarms"]["refused_lines"], 1)
        self.assertEqual(self.scratch.send(f"ROBOT {ROBOT} online").returncode, 0)
        self.assertTrue(g.eventually(lambda: self.scratch.robot(ROBOT)["stream"]["state"] == "fresh", PATIENCE_S))
        robot.close()
        self.assertGreater(self.alarm("open", lambda alarm: True)["id"], lost["id"])


if __name__ == "__main__":
    g.main()

"""kill -9 at any moment: the next start works, nothing is left behind or wrongly reused."""

import json
import os
import random
import subprocess
import time
import unittest

import gateway as g

ROUNDS = 50
PUMA_JOINTS = ",".join(f"puma_762_joint_{i}" for i in range(1, 7))


def queues():
    """Keys of all System V queues of this IPC namespace."""
    with open("/proc/sysvipc/msg", encoding="ascii") as file:
        next(file)
        return {int(line.split()[0]) & 0xFFFFFFFF for line in file}


class Crash(unittest.TestCase):
    def setUp(self):
        self.scratch = g.Scratch()
        self.before = queues()

    def tearDown(self):
        self.scratch.remove()
        self.assertEqual(queues() - self.before, set(), "queues left behind")

    def test_killed_at_random_moments_it_starts_again(self):
        chance = random.Random(7)
        for round_number in range(ROUNDS):
            gateway = g.Gateway(self.scratch, wait=False)
            time.sleep(chance.uniform(0.0, 0.4))
            gateway.kill()
            gateway.close()
            self.assertLessEqual(len(queues() - self.before), 3, f"round {round_number}")
        gateway = g.Gateway(self.scratch)
        self.assertEqual(self.scratch.send("DRAW_SCENE").returncode, 0)
        self.assertEqual(gateway.stop(), 0)
        gateway.close()

    def test_messages_left_behind_by_a_killed_gateway_are_not_executed(self):
        gateway = g.Gateway(self.scratch)
        info = json.loads(next(self.scratch.runtime.glob("**/instance.json")).read_text())
        key = info.get("script_key") or info["queues"]["script_key"]
        gateway.kill()
        gateway.close()
        subprocess.run(["perl", "-e", 'my $q = msgget($ARGV[0], 0); msgsnd($q, pack("l! a*", 5, "ROBACT PUMA_762"), 0) or die $!',
                        str(key)], check=True)
        gateway = g.Gateway(self.scratch)
        self.assertFalse(self.scratch.robot("PUMA_762")["active"])
        self.assertEqual(gateway.stop(), 0)
        gateway.close()

    def test_second_gateway_of_the_same_name_is_refused_and_another_name_runs_beside_it(self):
        first = g.Gateway(self.scratch)
        second = g.Gateway(self.scratch, wait=False)
        self.assertEqual(second.child.wait(60), 1)
        self.assertIn(str(first.child.pid), second.output())
        other = g.Gateway(self.scratch, instance=self.scratch.instance + "b")
        self.assertEqual(self.scratch.send("ROBACT PUMA_762").returncode, 0)
        active = [r["id"] for r in self.scratch.status(instance=self.scratch.instance + "b")["robots"] if r["active"]]
        self.assertNotIn("PUMA_762", active)
        for process in (other, first):
            self.assertEqual(process.stop(), 0)
            process.close()
        second.close()

    def test_simulators_killed_at_any_moment_do_not_disturb_the_gateway(self):
        simulators = (
            ("dds", "--joint-names", PUMA_JOINTS, "--rate", "100"),
            ("cia402", "--channel", "udp:239.74.163.2:43113", "--nodes", "1-6", "--rate", "100"),
        )
        gateway = g.Gateway(self.scratch)
        try:
            for robot in ("PUMA_762", "MANTEC_R3"):
                self.assertEqual(self.scratch.send(f"ROBOT {robot} online").returncode, 0)
            chance = random.Random(11)
            for round_number in range(ROUNDS):
                simulator = g.sim_robot(*simulators[round_number % 2])
                time.sleep(chance.uniform(0.0, 0.3))
                simulator.close()
                self.assertTrue(gateway.running())
            for arguments in simulators:  # the next start works
                self.simulators = getattr(self, "simulators", []) + [g.sim_robot(*arguments)]
            for robot in ("PUMA_762", "MANTEC_R3"):
                fresh = g.eventually(lambda: self.scratch.robot(robot)["stream"]["state"] == "fresh")
                self.assertTrue(fresh, self.scratch.robot(robot)["stream"])
        finally:
            for simulator in getattr(self, "simulators", []):
                simulator.close()
            self.assertEqual(gateway.stop(), 0)
            gateway.close()


if __name__ == "__main__":
    g.main()

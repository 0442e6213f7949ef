"""Master and slave in the running gateway: robots that follow others, mirrored masters included; what cannot be is refused."""

import json
import math
import unittest

import gateway as g

MASTER, SLAVE, THIRD = "MANTEC_R3", "mantec_R3", "mantec_R3a"
MIRRORED = "PUMA_762"
JOINTS = ",".join(f"puma_762_joint_{i}" for i in range(1, 7))


class Coupling(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = g.Scratch()
        cls.gateway = g.Gateway(cls.scratch)

    @classmethod
    def tearDownClass(cls):
        status = cls.gateway.stop()
        cls.gateway.close()
        cls.scratch.remove()
        assert status == 0, f"the gateway ended with {status}"

    def setUp(self):
        self.simulator = None
        for robot in (MASTER, SLAVE, THIRD):
            for command in (f"ROBACT {robot}", "rob_positioning jump", f"POS_ROB {robot} JOINT_ABS 0 0 0 0 0 0",
                            "rob_positioning move"):
                self.done(command)

    def tearDown(self):
        if self.simulator:
            self.simulator.close()
        for slave, entry in self.couplings().items():
            pairs = " ".join(f"{joint['master']} {joint['slave']}" for joint in entry["joints"])
            self.done(f"MASTER_SLAVE off {entry['master']} 1 {slave} {len(entry['joints'])} {pairs}")
        self.scratch.send(f"ROBOT {MIRRORED} offline")

    def done(self, command):
        done = self.scratch.send(command)
        self.assertEqual(done.returncode, 0, f"{command}: {done.stderr}")

    def refused(self, command, *words):
        done = self.scratch.send(command)
        self.assertEqual(done.returncode, 1, f"{command}: {done.stdout}")
        for word in words:
            self.assertIn(word, done.stderr)

    def joint(self, robot, number):
        return self.scratch.robot(robot)["joints"][number - 1]["position"]

    def couplings(self):
        return {entry["slave"]: entry for entry in self.scratch.status()["couplings"]}

    def arrives(self, robot, number, degrees):
        seen = g.eventually(lambda: abs(self.joint(robot, number) - math.radians(degrees)) < 1e-6)
        self.assertTrue(seen, (robot, number, math.degrees(self.joint(robot, number)), self.couplings()))

    def test_slaves_follow_by_names_and_are_free_again(self):
        self.done(f"MASTER_SLAVE on {MASTER} 2 {SLAVE} 2 J_1 J_1 J_2 J_3 {THIRD} 1 J_1 J_4")
        self.done(f"POS_ROB {MASTER} JOINT_ABS 20 30")
        self.arrives(SLAVE, 1, 20)
        self.arrives(SLAVE, 3, 30)
        self.arrives(THIRD, 4, 20)
        coupling = self.couplings()[SLAVE]
        self.assertEqual((coupling["master"], coupling["state"]), (MASTER, "following"))
        self.assertEqual([(j["master"], j["slave"], j["limited"]) for j in coupling["joints"]],
                         [("J_1", "J_1", False), ("J_2", "J_3", False)])
        self.assertIn(f"{SLAVE} follows {MASTER}: following", self.scratch.cellmirror("status").stdout)
        self.done(f"MASTER_SLAVE off {MASTER} 2 {SLAVE} 2 J_1 J_1 J_2 J_3 {THIRD} 1 J_1 J_4")
        self.assertEqual(self.couplings(), {})
        self.done(f"POS_ROB {MASTER} JOINT_ABS 0 0")
        self.arrives(SLAVE, 1, 20)
        self.done(f"POS_ROB {SLAVE} JOINT_INC 5")
        self.arrives(SLAVE, 1, 25)

    def test_chains_pass_values_on(self):
        self.done(f"MASTER_SLAVE on {MASTER} 1 {SLAVE} 1 J_1 J_1")
        self.done(f"MASTER_SLAVE on {SLAVE} 1 {THIRD} 1 J_1 J_1")
        self.done(f"POS_ROB {MASTER} JOINT_ABS 15")
        self.arrives(THIRD, 1, 15)

    def test_a_slave_keeps_its_own_limits(self):
        for command in (f"ROBACT {SLAVE}", "rob_jnt_max_range 10 90 90 90 90 90",
                        f"MASTER_SLAVE on {MASTER} 1 {SLAVE} 1 J_1 J_1", f"POS_ROB {MASTER} JOINT_ABS 30"):
            self.done(command)
        self.arrives(SLAVE, 1, 10)
        self.assertTrue(g.eventually(lambda: self.couplings()[SLAVE]["state"] == "limited"), self.couplings())
        coupling = self.couplings()[SLAVE]
        self.assertAlmostEqual(coupling["joints"][0]["lag_rad"], math.radians(20), delta=1e-6)
        self.done("rob_jnt_max_range 90 90 90 90 90 90")

    def test_a_slave_accelerates_and_brakes_within_its_own_limit(self):
        limit = 5.0  # rad/s2
        for command in (f"ROBACT {SLAVE}", f"rob_jnt_max_acc {' '.join([str(limit)] * 6)}",
                        f"POS_ROB {MASTER} JOINT_ABS 60"):
            self.done(command)
        self.arrives(MASTER, 1, 60)
        file = self.scratch.root / "slave.mcap"
        recorder = g.Process([g.BIN / "cellmirror", "record", "-o", file, "--instance", self.scratch.instance, "--rate", "1000",
                              "--topics", "/joint_states"], self.scratch.environment)
        self.addCleanup(recorder.close)
        self.assertTrue(g.eventually(lambda: any(one["messages"] > 0 for one in self.scratch.status()["recordings"])))
        self.done(f"MASTER_SLAVE on {MASTER} 1 {SLAVE} 1 J_1 J_1")
        self.arrives(SLAVE, 1, 60)
        self.assertEqual(recorder.stop(), 0)
        done = self.scratch.cellmirror("recording", "export", str(file), "--topic", "/joint_states", "--json")
        ticks = [message["values"] for message in json.loads(done.stdout)["messages"]]
        joint = next(key for key, name in ticks[0].items() if name == f"{SLAVE}/J_1").removeprefix("name")
        velocities = [tick["velocity" + joint] for tick in ticks]
        times = [tick["header.stamp.sec"] + 1e-9 * tick["header.stamp.nanosec"] for tick in ticks]
        # A tick that the recording has not got makes a step of two periods; both are judged by their time.
        steps = [abs(b - a) / max(t - s, 0.001) for a, b, s, t in zip(velocities, velocities[1:], times, times[1:])]
        self.assertGreater(max(velocities), 0.5, "it has moved")
        self.assertLess(max(steps), 2 * limit)
        self.assertEqual(self.scratch.robot(SLAVE)["refused_setpoints"], 0)
        self.done("rob_jnt_max_acc 15 15 15 15 15 15")

    def test_commands_do_not_move_coupled_joints_but_the_others(self):
        self.done(f"MASTER_SLAVE on {MASTER} 1 {SLAVE} 1 J_1 J_1")
        self.done(f"POS_ROB {MASTER} JOINT_ABS 12")
        self.arrives(SLAVE, 1, 12)
        self.refused(f"POS_ROB {SLAVE} JOINT_ABS 5", "J_1", f"follows {MASTER}", "MASTER_SLAVE off")
        self.refused(f"POS_ROB {SLAVE} TOOL_INC Z 5", f"follow {MASTER}")
        self.refused(f"MOVE_ROB {SLAVE} LIN JOINT_ABS 12 5", f"follow {MASTER}")
        self.done(f"POS_ROB {SLAVE} JOINT_INC 0 7")
        self.arrives(SLAVE, 1, 12)

    def test_what_cannot_be_is_refused(self):
        self.done(f"MASTER_SLAVE on {MASTER} 1 {SLAVE} 1 J_1 J_1")
        self.refused(f"MASTER_SLAVE on {SLAVE} 1 {MASTER} 1 J_1 J_1", "circle")
        self.refused(f"MASTER_SLAVE on {THIRD} 1 {SLAVE} 1 J_2 J_2", f"follows {MASTER} already")
        self.refused(f"MASTER_SLAVE on {MASTER} 1 {MASTER} 1 J_1 J_1", "its own slave")
        self.refused(f"MASTER_SLAVE on {MASTER} 1 {THIRD} 2 J_1 J_1 J_2 J_1", "J_1")
        self.refused(f"MASTER_SLAVE on {MASTER} 1 {THIRD} 1 J_1 J_9", "no joint J_9")
        self.refused(f"MASTER_SLAVE on TRAEGERSYSTEM 1 {THIRD} 1 J_1 J_1", "one cannot follow the other")
        self.refused(f"MASTER_SLAVE on {MASTER} 2 {THIRD} 1 J_1 J_1 {SLAVE} 1 J_1 J_9", "no joint J_9")
        self.refused(f"MASTER_SLAVE off {MASTER} 1 {THIRD} 1 J_1 J_1", f"does not follow {MASTER}")
        self.refused(f"MASTER_SLAVE off {MASTER} 1 {SLAVE} 1 J_2 J_2", "does not follow J_2")
        self.assertEqual(list(self.couplings()), [SLAVE])

    def test_a_mirrored_robot_is_no_slave_and_a_slave_is_not_mirrored(self):
        self.done(f"ROBOT {MIRRORED} online")
        self.refused(f"MASTER_SLAVE on {MASTER} 1 {MIRRORED} 1 J_1 J_1", "mirrored", "offline")
        self.done(f"ROBOT {MIRRORED} offline")
        self.done(f"MASTER_SLAVE on {MASTER} 1 {MIRRORED} 1 J_1 J_1")
        self.refused(f"ROBOT {MIRRORED} online", f"follows {MASTER}", "MASTER_SLAVE off")

    def test_the_slave_of_a_mirrored_master_follows_and_holds(self):
        self.done(f"ROBOT {MIRRORED} online")
        self.done(f"MASTER_SLAVE on {MIRRORED} 1 {SLAVE} 1 J_1 J_1")
        self.assertTrue(g.eventually(lambda: self.couplings()[SLAVE]["state"] == "holding"))
        self.simulator = g.sim_robot("dds", "--joint-names", JOINTS, "--rate", "100",
                                     "--motion", "sine:amplitude=0.2,period=4")
        self.assertTrue(g.eventually(lambda: self.couplings()[SLAVE]["state"] != "holding"), self.couplings())
        first = self.joint(SLAVE, 1)
        self.assertTrue(g.eventually(lambda: abs(self.joint(SLAVE, 1) - first) > 0.05), "the slave does not follow")
        self.simulator.kill()
        self.assertTrue(g.eventually(lambda: self.couplings()[SLAVE]["state"] == "holding"), self.couplings())
        held = self.joint(SLAVE, 1)
        self.assertFalse(g.eventually(lambda: self.joint(SLAVE, 1) != held, 0.5))

    # The last by its name: the robot does not come back.
    def test_when_a_robot_vanishes_its_slaves_are_free(self):
        # In one go, so that nobody looks after the couplings in between.
        (self.scratch.home / "scripts" / "vanishes.spt").write_text(
            f"MASTER_SLAVE on {MIRRORED} 1 {SLAVE} 1 J_1 J_1;\nDELETE_NODE Puma;\nROBACT {SLAVE};\n"
            "rob_jnt_max_vel 90 90 90 90 90 90\n")
        self.done("EXEC_SCRIPT vanishes.spt")
        self.assertTrue(g.eventually(lambda: self.couplings() == {}), self.couplings())
        self.done(f"POS_ROB {SLAVE} JOINT_ABS 5")
        self.arrives(SLAVE, 1, 5)


if __name__ == "__main__":
    g.main()

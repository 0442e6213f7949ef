"""Bad input never ends the gateway, never half-applies, never disappears."""

import os
import unittest

import gateway as g


class BadInput(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = g.Scratch()
        cls.scripts = cls.scratch.home / "scripts"
        cls.gateway = g.Gateway(cls.scratch)

    @classmethod
    def tearDownClass(cls):
        status = cls.gateway.stop()
        cls.gateway.close()
        cls.scratch.remove()
        assert status == 0, f"the gateway ended with {status}"

    def tearDown(self):
        self.assertTrue(self.gateway.running(), self.gateway.output())
        self.assertEqual(self.scratch.send("DRAW_SCENE").returncode, 0, "the gateway goes on")

    def refused(self, command, *words):
        done = self.scratch.send(command)
        self.assertEqual(done.returncode, 1, f"{command}: {done.stdout}")
        for word in words:
            self.assertIn(word, done.stderr)

    def test_unknown_command_is_refused_with_the_nearest_one(self):
        self.refused("ROBAKT PUMA_762", "ROBACT")

    def test_unknown_robot_is_refused_with_the_nearest_one(self):
        self.refused("ROBACT PUMA_726", "PUMA_762")

    def test_value_beyond_a_limit_moves_nothing_and_names_joint_value_and_limit(self):
        before = self.scratch.robot("PUMA_762")["joints"]
        self.refused("POS_ROB PUMA_762 JOINT_ABS 5 5000", before[1]["name"], "5000")
        after = self.scratch.robot("PUMA_762")["joints"]
        self.assertEqual([j["position"] for j in before], [j["position"] for j in after])

    def test_joint_that_a_narrowed_limit_left_outside_is_told_and_nothing_moves(self):
        for command in ("POS_ROB mantec_R3a JOINT_ABS 0 40", "ROBACT mantec_R3a", "rob_jnt_max_range 162.5 30 145 170 115 170"):
            done = self.scratch.send(command)
            self.assertEqual(done.returncode, 0, done.stderr)
        self.refused("POS_ROB mantec_R3a JOINT_ABS 5", "J_2", "40 deg")
        self.assertEqual(self.scratch.robot("mantec_R3a")["joints"][0]["position"], 0.0)
        self.assertEqual(self.scratch.send("POS_ROB mantec_R3a JOINT_ABS 5 20").returncode, 0)
        moved = lambda: self.scratch.robot("mantec_R3a")["joints"][0]["position"] > 0.08
        self.assertTrue(g.eventually(moved))

    def test_noise_of_the_longest_message_is_refused_and_counted(self):
        before = self.scratch.status()["script"]["refused"]
        self.send_raw(os.urandom(8192))
        self.assertTrue(g.eventually(lambda: self.scratch.status()["script"]["refused"] > before))

    def send_raw(self, data):
        import ctypes
        import json
        info = json.loads(next(self.scratch.runtime.glob(f"**/{self.scratch.instance}/instance.json")).read_text())
        key = info.get("script_key") or info["queues"]["script_key"]
        libc = ctypes.CDLL(None, use_errno=True)
        queue = libc.msgget(key, 0)
        self.assertGreaterEqual(queue, 0)
        message = (5).to_bytes(8, "little") + data
        self.assertEqual(libc.msgsnd(queue, message, len(data), 0), 0, os.strerror(ctypes.get_errno()))

    def test_script_that_calls_itself_is_refused(self):
        (self.scripts / "self.spt").write_text("EXEC_SCRIPT self.spt;\n")
        self.scratch.send("EXEC_SCRIPT self.spt")
        self.assertTrue(g.eventually(lambda: any("self.spt" in e for e in self.scratch.status()["script"]["last_errors"])))

    def test_runaway_scripts_leave_places_and_are_stopped(self):
        for name, called in (("runaway", "called"), ("called", "leaf")):
            (self.scripts / f"{name}.spt").write_text(f"EXEC_SCRIPT {called};\n" * 2000)
        (self.scripts / "leaf.spt").write_text("DRAW_SCENE;\n" * 10)
        started = 0
        while self.scratch.send("EXEC_SCRIPT runaway").returncode == 0:
            started += 1
            self.assertLess(started, 32, "messages took every place")
        self.refused("EXEC_SCRIPT runaway", "STOP_ALL")
        runs = self.scratch.status()["script"]["runs"]
        self.assertEqual(len(runs), started)
        self.assertIn(f"run {runs[0]['id']}: scripts/runaway.spt:", self.scratch.cellmirror("status").stdout)
        self.assertEqual(self.scratch.send(f"STOP_SCRIPT {runs[0]['id']}").returncode, 0)
        self.assertNotIn(runs[0]["id"], [run["id"] for run in self.scratch.status()["script"]["runs"]])
        done = self.scratch.send("STOP_ALL")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(f"{started - 1} SCRIPT files stopped", done.stdout)
        self.assertEqual(self.scratch.status()["script"]["runs"], [])

    def test_missing_script_is_refused(self):
        self.refused("EXEC_SCRIPT nowhere.spt", "does not exist")

    def test_folder_in_place_of_a_script_is_refused(self):
        (self.scripts / "folder.spt").mkdir()
        self.refused("EXEC_SCRIPT folder.spt", "folder")

    def test_path_out_of_the_home_is_refused(self):
        self.refused("EXEC_SCRIPT ../../../etc/passwd", "cell folder")
        (self.scripts / "link.spt").symlink_to("/etc/passwd")
        self.refused("EXEC_SCRIPT link.spt", "cell folder")

    def test_unreadable_script_is_refused(self):
        if os.geteuid() == 0:
            self.skipTest("skipped: root reads every file")
        path = self.scripts / "closed.spt"
        path.write_text("DRAW_SCENE;\n")
        path.chmod(0)
        self.refused("EXEC_SCRIPT closed.spt", "readable")

    def test_script_with_a_syntax_error_is_refused_as_a_whole_with_every_place(self):
        (self.scripts / "wrong.spt").write_text("hot_message must not appear;\nROBACT;\n\nSET_CAMPAR CAMERA_5 x 1;\n")
        self.refused("EXEC_SCRIPT wrong.spt", "2 errors", "wrong.spt:2")
        self.assertIn("wrong.spt:4", str(self.scratch.status()["script"]["last_errors"]))
        self.assertNotIn("must not appear", str(self.scratch.status()["messages"]))

    def test_large_script_runs_while_messages_are_answered(self):
        line = "POS_ROB PUMA_762 JOINT_INC 0.001; POS_ROB PUMA_762 JOINT_INC -0.001;\n"
        count = 10 * 1024 * 1024 // len(line)
        # At once, so that the commands do not wait for the robot.
        (self.scripts / "large.spt").write_text("ROBACT PUMA_762;\nrob_positioning jump;\n" + line * count)
        before = self.scratch.status()["script"]["done"]
        self.assertEqual(self.scratch.send("EXEC_SCRIPT large.spt").returncode, 0)
        self.assertEqual(self.scratch.send("hot_message still here").returncode, 0)
        done = g.eventually(lambda: self.scratch.status()["script"]["done"] - before >= 2 * count, 200, 0.5)
        self.assertTrue(done, self.scratch.status()["script"])

    def test_other_messages_are_executed_while_a_script_waits_for_its_turn(self):
        self.assertEqual(self.scratch.send("WAIT").returncode, 1)


if __name__ == "__main__":
    g.main()

"""`cellmirror send` with several commands, from the command line, a file and standard input."""

import json
import subprocess
import unittest

import gateway as g


class Send(unittest.TestCase):
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

    def send(self, *arguments, status, text=None):
        done = subprocess.run([str(g.BIN / "cellmirror"), "send", *arguments, "--instance", self.scratch.instance],
                              env=self.scratch.environment, input=text, capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done

    def received(self):
        return self.scratch.status()["script"]["received"]

    def file(self, text):
        path = self.scratch.root / "commands.spt"
        path.write_text(text)
        return str(path)

    def test_commands_are_answered_in_their_order(self):
        done = self.send("ROBACT PUMA_762", "rob_program_delays 1", "ROBACT MANTEC_RM3", status=0)
        self.assertEqual(done.stdout, "done\ndone\ndone\n")
        self.assertEqual(done.stderr, "")

    def test_the_text_of_a_message_may_have_semicolons(self):
        self.send("hot_message Ready; go", status=0)
        shown = self.scratch.status()["messages"]
        self.assertEqual(shown[-1]["text"], "Ready; go")
        refused = self.send("ACTIVATE a", status=1)
        self.assertNotIn("did you mean", refused.stderr)

    def test_it_ends_at_the_first_that_is_refused(self):
        before = self.received()
        done = self.send("DRAW_SCENE", "ROBACT nobody", "DRAW_SCENE", status=1)
        self.assertEqual(done.stdout, "done\n")
        self.assertIn("cellmirror: command 2 (ROBACT nobody): refused: ", done.stderr)
        self.assertEqual(self.received(), before + 2)

    def test_it_keeps_going_where_told(self):
        before = self.received()
        done = self.send("--keep-going", "ROBACT nobody", "DRAW_SCENE", "ROBACT nobody_else", status=1)
        self.assertEqual(done.stdout, "done\n")
        self.assertEqual(done.stderr.count("refused: "), 2)
        self.assertEqual(self.received(), before + 3)

    def test_one_refused_command_is_told_as_ever(self):
        done = self.send("ROBACT nobody", status=1)
        self.assertTrue(done.stderr.startswith("cellmirror: refused: "), done.stderr)

    def test_a_file_is_script_text(self):
        text = ("\ufeffRBv01r01\n# comment; not a command\nROBACT\n# between\n  PUMA_762 ;;\r\nDRAW_SCENE; "
                "DRAW_SCENE\n;\nhot_message two\nlines")
        done = self.send("--file", self.file(text), status=0)
        self.assertEqual(done.stdout, "done\n" * 4)

    def test_a_refusal_in_a_file_has_its_line(self):
        path = self.file("DRAW_SCENE;\n\n\n  ROBACT nobody;\nDRAW_SCENE;\n")
        done = self.send("--file", path, status=1)
        self.assertEqual(done.stdout, "done\n")
        self.assertIn(f"cellmirror: {path}:4: refused: ", done.stderr)

    def test_standard_input(self):
        for arguments in (["-"], ["--file", "-"]):
            done = self.send(*arguments, status=1, text="DRAW_SCENE; ROBACT nobody")
            self.assertEqual(done.stdout, "done\n")
            self.assertIn("cellmirror: standard input:1: refused: ", done.stderr)

    def test_what_comes_through_a_pipe_is_sent_at_once(self):
        sender = subprocess.Popen([str(g.BIN / "cellmirror"), "send", "-", "--instance", self.scratch.instance],
                                  env=self.scratch.environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        try:
            for _ in range(2):
                sender.stdin.write("DRAW_SCENE;\n")
                sender.stdin.flush()
                self.assertEqual(sender.stdout.readline(), "done\n")
            sender.stdin.close()
            self.assertEqual(sender.wait(60), 0)
        finally:
            sender.kill()
            sender.wait()
            sender.stdout.close()

    def test_json_is_an_object_a_command(self):
        done = self.send("--json", "--keep-going", 'hot_message "quoted"', "ROBACT nobody", status=1)
        first, second = (json.loads(line) for line in done.stdout.splitlines())
        self.assertEqual(first, {"command": 'hot_message "quoted"', "done": True, "answered": True, "text": ""})
        self.assertEqual((second["done"], second["answered"]), (False, True))
        self.assertIn("nobody", second["text"])

    def test_nothing_to_send(self):
        self.assertEqual(self.send("--file", self.file("# nothing\n"), status=0).stdout, "")
        self.assertEqual(self.send("--file", self.file(""), status=0).stdout, "")
        self.assertEqual(self.send("-", status=0, text="").stdout, "")

    def test_wrong_usage_and_files_that_cannot_be_read(self):
        self.send(status=2)
        self.send("DRAW_SCENE", "--file", self.file("DRAW_SCENE"), status=2)
        missing = str(self.scratch.root / "missing.spt")
        self.assertIn(missing, self.send("--file", missing, status=1).stderr)
        self.send("--file", str(self.scratch.root), status=1)

    def test_a_command_without_an_end_is_refused(self):
        done = self.send("-", status=1, text="DRAW_SCENE;\n" + 20_000 * "x")
        self.assertIn("line 2: a command of more than", done.stderr)


if __name__ == "__main__":
    unittest.main()

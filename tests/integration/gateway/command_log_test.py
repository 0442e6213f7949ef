"""Every command leaves a trace: who sent it, when, and what became of it; in a file that outlives the gateway."""

import json
import os
import re
import stat
import subprocess
import unittest
import urllib.request

import gateway as g

RAW_SEND = ('my $q = msgget($ARGV[0], 0); msgsnd($q, pack("l! a*", 5, $ARGV[1]), 0) or die $!; print $$;'
            '$| = 1; <STDIN>;')  # it stays until it has been received
UTC = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z")


class CommandLog(unittest.TestCase):
    def setUp(self):
        self.scratch = g.Scratch()
        self.addCleanup(self.scratch.remove)
        self.file = self.scratch.home / "records" / f"commands-{self.scratch.instance}.jsonl"

    def start(self, *arguments, **keywords):
        gateway = g.Gateway(self.scratch, *arguments, **keywords)
        self.addCleanup(gateway.close)
        return gateway

    def entries(self):
        return [json.loads(line) for line in self.file.read_text().splitlines()] if self.file.exists() else []

    def entry(self, command):
        found = g.eventually(lambda: [entry for entry in self.entries() if entry.get("command") == command])
        self.assertTrue(found, f"{command}: {self.entries()}")
        self.assertEqual(len(found), 1, found)
        return found[0]

    def test_messages(self):
        self.start()
        sender = subprocess.Popen([str(g.BIN / "cellmirror"), "send", "ROBACT PUMA_762", "--instance", self.scratch.instance],
                                  env=self.scratch.environment, stdout=subprocess.DEVNULL)
        self.assertEqual(sender.wait(60), 0)
        entry = self.entry("ROBACT PUMA_762")
        self.assertEqual(entry["source"], "message")
        self.assertEqual(entry["process"], sender.pid)
        self.assertEqual(entry["user"], os.geteuid())
        self.assertEqual(entry["outcome"], "done")
        self.assertRegex(entry["time"], UTC)
        self.assertGreaterEqual(entry["took_s"], 0)

        self.assertEqual(self.scratch.send("ROBACT nobody").returncode, 1)
        entry = self.entry("ROBACT nobody")
        self.assertEqual(entry["outcome"], "refused")
        self.assertIn("nobody", entry["answer"])

    def test_messages_without_an_answer_and_those_that_are_no_command(self):
        self.start()
        key = json.loads(next(self.scratch.runtime.glob("**/instance.json")).read_text())["script_key"]
        for text in ("DRAW_SCENE", "ROB\x02"):
            sender = subprocess.Popen(["perl", "-e", RAW_SEND, str(key), text], stdin=subprocess.PIPE,
                                      stdout=subprocess.PIPE, text=True)
            if text == "DRAW_SCENE":
                entry = self.entry(text)
                self.assertEqual(entry["outcome"], "done")
            else:
                entry = g.eventually(lambda: next((e for e in self.entries() if "byte" in e.get("answer", "")), None))
                self.assertTrue(entry, self.entries())
                self.assertEqual(entry["outcome"], "refused")
            self.assertEqual(entry["process"], sender.pid)
            sender.communicate("\n", timeout=60)

    def test_files(self):
        (self.scratch.home / "scripts" / "two.spt").write_text("# first a comment\nROBACT PUMA_762;\nROBACT nobody;\n")
        self.start()
        self.assertEqual(self.scratch.send("EXEC_SCRIPT two").returncode, 0)
        self.assertEqual(self.entry("EXEC_SCRIPT two")["source"], "message")
        entry = self.entry("ROBACT PUMA_762")
        self.assertEqual((entry["source"], entry["place"], entry["outcome"]), ("file", "scripts/two.spt:2", "done"))
        self.assertGreater(entry["run"], 0)
        entry = self.entry("ROBACT nobody")
        self.assertEqual((entry["place"], entry["outcome"]), ("scripts/two.spt:3", "refused"))

    def test_page(self):
        self.start(page=True)
        token = json.loads(next(self.scratch.runtime.glob("**/page.json")).read_text())["token"]
        address = self.scratch.status()["page"]["address"].rstrip("/")

        def post(command):
            request = urllib.request.Request(address + "/api/command", command.encode(), {"Authorization": f"Bearer {token}"})
            return json.load(urllib.request.urlopen(request, timeout=60))

        self.assertTrue(post("ROBACT PUMA_762")["done"])
        entry = self.entry("ROBACT PUMA_762")
        self.assertEqual(entry["source"], "page")
        self.assertGreater(entry["session"], 0)
        self.assertEqual(entry["peer"], f"uid {os.geteuid()}")
        self.assertFalse(post("@3 DRAW_SCENE")["done"])
        self.assertEqual(self.entry("@3 DRAW_SCENE")["outcome"], "refused")
        log = json.load(urllib.request.urlopen(address + "/api/command-log", timeout=60))
        self.assertEqual([e["command"] for e in log["last"]], ["ROBACT PUMA_762", "@3 DRAW_SCENE"])
        self.assertNotIn(token, self.file.read_text())

    def test_it_is_private_and_kept(self):
        gateway = self.start()
        self.assertEqual(self.scratch.send("ROBACT PUMA_762").returncode, 0)
        self.entry("ROBACT PUMA_762")
        self.assertEqual(stat.S_IMODE(self.file.stat().st_mode), 0o600)
        self.assertEqual(gateway.stop(), 0)
        gateway = self.start()
        self.assertEqual(self.scratch.send("DRAW_SCENE").returncode, 0)
        self.entry("DRAW_SCENE")
        gateway.kill()
        self.start()
        log = self.scratch.status()["command_log"]
        self.assertEqual(log["file"], str(self.file))
        self.assertEqual([entry["command"] for entry in log["last"]], ["ROBACT PUMA_762", "DRAW_SCENE"])

    def test_a_folder_without_room_for_it_is_reported_and_stops_nothing(self):
        self.file.parent.mkdir()
        self.file.mkdir()
        self.start()
        problems = self.scratch.status()["problems"]
        self.assertEqual([problem["kind"] for problem in problems], ["command_log"])
        self.assertEqual(self.scratch.send("DRAW_SCENE").returncode, 0)


if __name__ == "__main__":
    g.main()

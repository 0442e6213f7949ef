"""Few descriptors, little memory, full disks and other users: a clear error, or everything goes on; never an end that
looks like a bug."""

import gzip
import json
import os
import re
import shutil
import signal
import stat
import subprocess
import unittest

import gateway as g

NOBODY = 65534


class Limits(unittest.TestCase):
    def setUp(self):
        self.scratch = g.Scratch()
        self.addCleanup(self.scratch.remove)

    def run_with(self, limit, *arguments):
        """The gateway under `ulimit LIMIT`: its exit status and output."""
        command = [str(g.BIN / "cellmirror"), "run", str(self.scratch.cell_file), "--no-web", "--headless", "--instance",
                   self.scratch.instance, "--for", "0.5", *arguments]
        done = subprocess.run(["bash", "-c", f'ulimit {limit}; exec "$@"', "bash", *command], capture_output=True,
                              text=True, timeout=120, env=self.scratch.environment)
        return done.returncode, done.stdout + done.stderr

    def test_few_descriptors(self):
        for number in (8, 12, 16, 20, 24, 64):
            with self.subTest(descriptors=number):
                status, output = self.run_with(f"-n {number}")
                self.assertEqual(status, 1, output)
                self.assertIn(f"the limit of open files is {number}", output)
                self.assertIn("ulimit -n", output)
                self.assertNotIn("bug", output)

    def test_a_soft_limit_of_descriptors_is_raised(self):
        status, output = self.run_with("-Sn 24")
        self.assertEqual(status, 0, output)

    def test_little_address_space(self):
        status, output = self.run_with("-v 307200")
        self.assertEqual(status, 1, output)
        self.assertIn("the address space is limited to 300 MiB", output)
        self.assertNotIn("terminate", output)

    def test_memory_that_runs_out_later(self):
        for mebibytes in (2048, 2300, 2600, 3000):
            with self.subTest(mebibytes=mebibytes):
                status, output = self.run_with(f"-v {mebibytes * 1024}")
                self.assertIn(status, (0, 1), output)
                self.assertNotIn("bug", output)
                self.assertNotIn("terminate called", output)
                if status == 1:
                    self.assertRegex(output, "memory|limits")


class OtherUsers(unittest.TestCase):
    def test_status_says_whose_gateway_runs(self):
        if os.geteuid() != 0:
            self.skipTest("skipped: only root can become another user")
        scratch = g.Scratch()
        self.addCleanup(scratch.remove)
        scratch.root.chmod(0o755)
        program = scratch.root / "cellmirror"
        shutil.copy(g.BIN / "cellmirror", program)
        program.chmod(0o755)
        gateway = g.Gateway(scratch)
        self.addCleanup(gateway.close)
        own = scratch.root / "nobody"
        own.mkdir(mode=0o700)
        os.chown(own, NOBODY, NOBODY)
        environment = dict(os.environ, CELLMIRROR_RUNTIME_DIR=str(own))

        def as_nobody(*arguments):
            return subprocess.run([program, *arguments, "--instance", scratch.instance], user=NOBODY, group=NOBODY,
                                  extra_groups=[], env=environment, cwd="/", capture_output=True, text=True, timeout=60)

        for arguments in (("status",), ("send", "DRAW_SCENE")):
            done = as_nobody(*arguments)
            self.assertEqual(done.returncode, 1)
            # Any cellmirror of that user may be the one that is named, and other tests run some beside this one.
            self.assertRegex(done.stderr, r"a gateway runs as user root \(uid 0\) \(process \d+\)")
            self.assertIn("only that user and root may ask it", done.stderr)
        self.assertEqual(gateway.stop(), 0)
        self.assertIn("no gateway of the instance", as_nobody("status").stderr)


class FlightRecords(unittest.TestCase):
    def setUp(self):
        self.scratch = g.Scratch()
        self.addCleanup(self.scratch.remove)
        self.records = self.scratch.home / "records"
        self.records.mkdir()

    def start(self):
        gateway = g.Gateway(self.scratch)
        self.addCleanup(gateway.close)
        self.assertTrue(g.eventually(lambda: self.scratch.status()["loop"]["ticks"] > 200))
        return gateway

    def test_they_are_private_and_follow_no_link(self):
        self.start()
        target = self.scratch.root / "target"
        target.write_text("mine")
        (self.records / "a.jsonl.part").symlink_to(target)
        self.assertEqual(self.scratch.send("SAVE_FLIGHT a.jsonl").returncode, 0)
        self.assertEqual(target.read_text(), "mine")
        file = self.records / "a.jsonl"
        self.assertFalse(file.is_symlink())
        self.assertEqual(stat.S_IMODE(file.stat().st_mode), 0o600)
        self.assertEqual(json.loads(file.read_text().splitlines()[0])["reason"], "request")
        self.assertEqual(list(self.records.glob("*.part")), [])

    def test_they_are_compressed_where_the_name_says_so(self):
        self.start()
        self.assertEqual(self.scratch.send("SAVE_FLIGHT a.jsonl.gz").returncode, 0)
        with gzip.open(self.records / "a.jsonl.gz", "rt") as file:
            self.assertEqual(json.loads(file.readline())["kind"], "header")

    def test_a_full_disk_leaves_nothing(self):
        """A limit of file sizes stands for it."""
        gateway = self.start()
        subprocess.run(["prlimit", f"--pid={gateway.child.pid}", "--fsize=4096"], check=True)
        done = self.scratch.send("SAVE_FLIGHT a.jsonl")
        self.assertEqual(done.returncode, 1)
        self.assertIn("cannot be written", done.stderr)
        self.assertEqual([path.name for path in self.records.glob("a.jsonl*")], [])
        self.assertTrue(gateway.running())

    def test_those_of_faults_are_compressed_and_the_oldest_go(self):
        for number in range(1, 26):
            (self.records / f"fault-{number}.jsonl").write_text("{}\n")
        (self.records / "fault-26.jsonl.gz.part").write_text("half")
        (self.records / "mine.jsonl").write_text("{}\n")
        gateway = self.start()
        gateway.child.send_signal(signal.SIGSTOP)
        self.assertTrue(g.eventually(lambda: not self.is_running(gateway.child.pid)))
        for _ in range(4):  # long enough to be a fault; nothing depends on how long it takes
            g.eventually(lambda: False, 0.2)
        gateway.child.send_signal(signal.SIGCONT)
        # A busy machine may have given it a fault before, which then is latched and has the record.
        self.assertTrue(g.eventually(lambda: self.scratch.status()["loop"]["faults"]), "no fault was reported")
        new = [path for path in self.records.glob("fault-*.jsonl.gz") if len(path.name) > 20]
        self.assertTrue(new, "no record of the fault")
        for path in new:
            self.assertEqual(stat.S_IMODE(path.stat().st_mode), 0o600)
            with gzip.open(path, "rt") as file:
                self.assertEqual(json.loads(file.readline())["kind"], "header")
        left = sorted(int(re.search(r"\d+", path.name)[0]) for path in self.records.glob("fault-*"))
        self.assertEqual(left[:-len(new)], list(range(6 + len(new), 26)), "20 in all")
        self.assertTrue((self.records / "mine.jsonl").exists())

    @staticmethod
    def is_running(process):
        with open(f"/proc/{process}/stat", encoding="ascii", errors="replace") as file:
            return file.read().rsplit(")", 1)[1].split()[0] != "T"


if __name__ == "__main__":
    g.main()

"""Queues that another program removes or takes: the gateway brings them back, or says what is wrong and how to get out;
nothing is sent into a queue that is not the gateway's."""

import ctypes
import json
import os
import pathlib
import signal
import subprocess
import unittest
import urllib.request

import gateway as g

IPC_CREAT, IPC_EXCL, IPC_RMID = 0o1000, 0o2000, 0
NOBODY = 65534

_libc = ctypes.CDLL(None, use_errno=True)


def number_of(key):
    """The kernel's number of the queue with that key; negative: there is none."""
    return _libc.msgget(ctypes.c_int(key), 0)


def remove(key):
    return _libc.msgctl(number_of(key), IPC_RMID, None)


def make(key, mode, user=None):
    """As a program that knows nothing of cellmirror, in a process of its own where it is another user's."""
    if user is None:
        return _libc.msgget(ctypes.c_int(key), IPC_CREAT | IPC_EXCL | mode)
    code = ("import ctypes, os, sys; os.setresuid(*[int(sys.argv[3])] * 3);"
            "sys.exit(ctypes.CDLL(None).msgget(int(sys.argv[1]), 0o3000 | int(sys.argv[2])) < 0)")
    done = subprocess.run(["/usr/bin/python3", "-c", code, str(key), str(mode), str(user)])
    return number_of(key) if done.returncode == 0 else -1


def messages_in(key):
    with open("/proc/sysvipc/msg", encoding="ascii") as file:
        next(file)
        rows = [line.split() for line in file]
    return next(int(row[4]) for row in rows if int(row[0]) == key)


def all_stopped(process):
    stats = [path.read_text() for path in pathlib.Path(f"/proc/{process}/task").glob("*/stat")]
    return all(stat.rsplit(")", 1)[1].split()[0] == "T" for stat in stats)


class Queues(unittest.TestCase):
    def setUp(self):
        self.scratch = g.Scratch()
        self.addCleanup(self.scratch.remove)

    def start(self, *arguments, **keywords):
        gateway = g.Gateway(self.scratch, *arguments, **keywords)
        self.addCleanup(gateway.close)
        info = json.loads(next(self.scratch.runtime.glob("**/instance.json")).read_text())
        self.script, self.reply, self.sensor = info["script_key"], info["reply_key"], info["sensor_key"]
        return gateway

    def steal(self, gateway, key, mode=0o666, user=None):
        """Removes the gateway's queue and makes one of that key first."""
        gateway.child.send_signal(signal.SIGSTOP)
        try:
            self.assertTrue(g.eventually(lambda: all_stopped(gateway.child.pid)))
            self.assertEqual(remove(key), 0)
            self.assertGreaterEqual(make(key, mode, user), 0)
        finally:
            gateway.child.send_signal(signal.SIGCONT)
        self.addCleanup(remove, key)

    def problem(self, kind):
        return next((p["text"] for p in self.scratch.status()["problems"] if p["kind"] == kind), None)

    def metrics(self):
        address = self.scratch.status()["page"]["address"]
        return urllib.request.urlopen(address + "metrics", timeout=60).read().decode()


class Stolen(Queues):
    def test_script_queue(self):
        gateway = self.start(page=True)
        self.assertEqual(self.scratch.status()["problems"], [])
        self.assertIn("cellmirror_problems 0\n", self.metrics())
        self.steal(gateway, self.script)
        text = g.eventually(lambda: self.problem("script_queue"))
        self.assertIn(f"({self.script})", text)
        self.assertIn(f"ipcrm -q {number_of(self.script)}", text)
        self.assertIn("PROBLEM  the SCRIPT input queue", self.scratch.cellmirror("status").stdout)
        self.assertIn('cellmirror_problem{kind="script_queue"} 1\n', self.metrics())

        done = self.scratch.send("DRAW_SCENE")  # at once: an answer is not waited for
        self.assertEqual(done.returncode, 1)
        self.assertIn("was not sent", done.stderr)
        self.assertIn(f"ipcrm -q {number_of(self.script)}", done.stderr)
        self.assertEqual(messages_in(self.script), 0)

        since = self.scratch.status()["uptime_s"]
        self.assertTrue(g.eventually(lambda: self.scratch.status()["uptime_s"] > since + 3))
        self.assertEqual(gateway.output().count("SCRIPT input queue"), 1, gateway.output())

        remove(self.script)
        self.assertTrue(g.eventually(lambda: self.problem("script_queue") is None))
        self.assertEqual(self.scratch.send("DRAW_SCENE").returncode, 0)

    def test_reply_queue(self):
        gateway = self.start()
        self.steal(gateway, self.reply)
        self.assertIn(f"({self.reply})", g.eventually(lambda: self.problem("reply_queue")))
        done = self.scratch.send("DRAW_SCENE")
        self.assertEqual(done.returncode, 1)
        self.assertIn("was not sent", done.stderr)
        remove(self.reply)
        self.assertTrue(g.eventually(lambda: self.problem("reply_queue") is None))
        self.assertEqual(self.scratch.send("DRAW_SCENE").returncode, 0)

    def test_sensor_queue(self):
        gateway = self.start()
        self.steal(gateway, self.sensor)
        self.assertIn(f"({self.sensor})", g.eventually(lambda: self.problem("sensor_queue")))
        remove(self.sensor)
        self.assertTrue(g.eventually(lambda: self.problem("sensor_queue") is None))

    def test_one_of_the_same_user_and_mode_is_taken_for_a_leftover(self):
        gateway = self.start()
        self.steal(gateway, self.script, mode=0o600)
        self.assertTrue(g.eventually(lambda: self.scratch.send("DRAW_SCENE").returncode == 0))
        self.assertEqual(self.scratch.status()["problems"], [])

    def test_another_user_is_named(self):
        if os.geteuid() != 0:
            self.skipTest("skipped: only root can make a queue of another user")
        gateway = self.start()
        self.steal(gateway, self.script, user=NOBODY)
        text = g.eventually(lambda: self.problem("script_queue"))
        self.assertIn(f"user nobody (uid {NOBODY})", text)
        self.assertIn(f"ipcrm -q {number_of(self.script)}", text)


class Removed(Queues):
    def test_reply_queue_comes_back_before_anybody_sends(self):
        self.start()
        remove(self.reply)
        self.assertTrue(g.eventually(lambda: number_of(self.reply) >= 0))
        self.assertEqual(self.scratch.send("DRAW_SCENE").returncode, 0)

    def test_sensor_queue_comes_back_with_nothing_to_send(self):
        self.start()
        remove(self.sensor)
        self.assertTrue(g.eventually(lambda: number_of(self.sensor) >= 0))

    def test_script_queue_comes_back(self):
        self.start()
        remove(self.script)
        self.assertTrue(g.eventually(lambda: number_of(self.script) >= 0))
        self.assertEqual(self.scratch.send("DRAW_SCENE").returncode, 0)


class Blocked(Queues):
    """What another user has made first blocks the start; the error says who, and the way out."""

    def setUp(self):
        super().setUp()
        if os.geteuid() != 0:
            self.skipTest("skipped: only root can make objects of another user")
        gateway = self.start()
        self.tcp_force = self.scratch.status()["haptics"].get("tcp_force")
        self.assertEqual(gateway.stop(), 0)

    def refused(self, *words):
        gateway = g.Gateway(self.scratch, wait=False)
        self.addCleanup(gateway.close)
        self.assertEqual(gateway.child.wait(60), 1)
        for word in words:
            self.assertIn(word, gateway.output())

    def test_queues(self):
        for key in (self.script, self.reply, self.sensor):
            with self.subTest(key=key):
                self.assertGreaterEqual(make(key, 0o600, NOBODY), 0)
                self.addCleanup(remove, key)
                self.refused(f"user nobody (uid {NOBODY})", f"ipcrm -q {number_of(key)}", "cell file")
                remove(key)

    def test_semaphore_of_a_key(self):
        code = ("import ctypes, os, sys; os.setresuid(65534, 65534, 65534);"
                "sys.exit(ctypes.CDLL(None).semget(int(sys.argv[1]), 1, 0o3600) < 0)")
        subprocess.run(["/usr/bin/python3", "-c", code, str(self.script)], check=True)
        semaphore = _libc.semget(ctypes.c_int(self.script), 0, 0)
        self.addCleanup(_libc.semctl, semaphore, 0, IPC_RMID)
        self.refused(f"user nobody (uid {NOBODY})", f"ipcrm -s {semaphore}", "--instance")

    def test_memory_of_a_haptic_device(self):
        import haptic_device as h
        self.scratch.remove()
        self.scratch = h.trainer()
        self.addCleanup(self.scratch.remove)
        key = self.scratch.keys["LAP_LEFT"]
        code = ("import ctypes, os, sys; os.setresuid(65534, 65534, 65534);"
                "sys.exit(ctypes.CDLL(None).shmget(int(sys.argv[1]), 512, 0o3600) < 0)")
        subprocess.run(["/usr/bin/python3", "-c", code, str(key)], check=True)
        memory = _libc.shmget(ctypes.c_int(key), 0, 0)
        self.addCleanup(_libc.shmctl, memory, IPC_RMID, None)
        self.refused(f"user nobody (uid {NOBODY})", f"ipcrm -m {memory}", "cell file")


if __name__ == "__main__":
    g.main()

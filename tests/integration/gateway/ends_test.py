"""However a gateway ends, nobody renders the last force of one that is gone: every signal ends it in order, and after a
kill -9 its guard removes the forces. Where the guard was killed too, the age of the force shows it."""

import os
import pathlib
import signal
import subprocess
import unittest

import gateway as g
import haptic_device as h

memory_of = h.memory_of
C_READER = g.BIN / "shared_memory_example_tcp_force_reader"
PERL_READER = g.SOURCE / "docs" / "examples" / "force_reader_1999.pl"
TEST_FORCE = (1.5, -2.5, 3.5, 0.25)
# Of those whose default action ends a process, all that report no error of the program itself.
ORDINARY = (signal.SIGHUP, signal.SIGINT, signal.SIGQUIT, signal.SIGTERM)
OTHERS = (signal.SIGUSR1, signal.SIGUSR2, signal.SIGALRM, signal.SIGVTALRM, signal.SIGPROF, signal.SIGXCPU,
          signal.SIGIO, signal.SIGPWR, signal.SIGRTMIN, signal.SIGRTMAX)


def ipc_objects(kind):
    """Keys of all queues ("msg"), memories ("shm") or semaphores ("sem") of this IPC namespace; removed memories that
    are still attached have none."""
    with open(f"/proc/sysvipc/{kind}", encoding="ascii") as file:
        next(file)
        return {int(line.split()[0]) & 0xFFFFFFFF for line in file} - {0}


def all_objects():
    return {(kind, key) for kind in ("msg", "shm", "sem") for key in ipc_objects(kind)}


def children_of(process):
    return [int(child) for child in pathlib.Path(f"/proc/{process}/task/{process}/children").read_text().split()]


def is_alive(process):
    """Not so for a zombie that its parent has not collected."""
    try:
        return pathlib.Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


class Ends(unittest.TestCase):
    def setUp(self):
        self.scratch = g.Scratch()
        self.addCleanup(self.scratch.remove)

    def start(self):
        gateway = g.Gateway(self.scratch)
        self.addCleanup(gateway.close)
        done = self.scratch.send("SET_EXT_TCP_TEST on {} {} {} {}".format(*TEST_FORCE))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.key = self.scratch.status()["haptics"]["tcp_force"]["key"]
        memory = h.attach(self.key, memory_of.TCP_FORCE_BYTES)
        self.addCleanup(memory.detach)
        # None: it was being written.
        shown = g.eventually(lambda: (memory_of.read_tcp_force(memory) or {}).get("values") == list(TEST_FORCE))
        self.assertTrue(shown, memory_of.read_tcp_force(memory))
        return gateway, memory

    def gone(self, memory):
        force = memory_of.read_tcp_force(memory)
        return force is not None and force["values"] == [0.0] * 4 and force["process"] == 0 and force["flags"] == 0

    def read_as_in_1999(self):
        done = subprocess.run(["perl", PERL_READER, str(self.key), "4"], capture_output=True, text=True, check=True)
        return [float(value) for value in done.stdout.split()]

    def read_in_c(self):
        return subprocess.run([C_READER, "--key", str(self.key), "--count", "3", "--timeout", "60"],
                              capture_output=True, text=True, timeout=120)


class Signals(Ends):
    def test_every_signal_that_ends_a_process_ends_it_in_order(self):
        before = all_objects()
        for number in ORDINARY + OTHERS:
            with g.sub_test(self, signal=number):
                gateway, memory = self.start()
                gateway.child.send_signal(number)
                status = gateway.child.wait(60)
                self.assertTrue(self.gone(memory), memory_of.read_tcp_force(memory))
                self.assertEqual(all_objects() - before, set())
                self.assertEqual(list(self.scratch.runtime.glob("*/instance.json")), [])
                if number in ORDINARY:
                    self.assertEqual(status, 0, gateway.output())
                else:  # nobody may take it for an end that was asked for
                    self.assertEqual(status, 1, gateway.output())
                    self.assertIn("ended by SIG", gateway.output())

    def test_sighup_that_is_ignored_at_the_start_stays_ignored(self):
        before = signal.signal(signal.SIGHUP, signal.SIG_IGN)  # as nohup does
        try:
            gateway, memory = self.start()
        finally:
            signal.signal(signal.SIGHUP, before)
        gateway.child.send_signal(signal.SIGHUP)
        self.assertEqual(self.scratch.send("DRAW_SCENE").returncode, 0)
        self.assertFalse(self.gone(memory))
        gateway.child.send_signal(signal.SIGTERM)
        self.assertEqual(gateway.child.wait(60), 0)
        self.assertTrue(self.gone(memory))

    def test_a_reader_in_c_sees_an_ordinary_end(self):
        gateway, memory = self.start()
        seen = self.read_in_c()
        self.assertEqual(seen.returncode, 0, seen.stderr)
        self.assertIn("valid test", seen.stdout)
        self.assertEqual(gateway.stop(), 0)
        self.assertEqual(self.read_in_c().returncode, 1)


class Kills(Ends):
    def test_the_guard_removes_the_force_of_a_killed_gateway(self):
        gateway, memory = self.start()
        guard = self.scratch.status()["force_guard"]
        self.assertTrue(guard["running"])
        self.assertIn(guard["process"], children_of(gateway.child.pid))
        self.assertEqual(self.read_as_in_1999(), list(TEST_FORCE))
        gateway.kill()
        self.assertTrue(g.eventually(lambda: self.gone(memory)), memory_of.read_tcp_force(memory))
        self.assertEqual(self.read_as_in_1999(), [0.0] * 4)
        self.assertTrue(g.eventually(lambda: not is_alive(guard["process"])))
        # The next gateway takes all over.
        gateway, memory = self.start()
        self.assertEqual(gateway.stop(), 0)
        self.assertTrue(self.gone(memory))

    def test_the_guard_holds_nothing_and_ends_with_the_gateway(self):
        gateway, memory = self.start()
        guard = self.scratch.status()["force_guard"]["process"]
        self.assertTrue(g.eventually(lambda: len(os.listdir(f"/proc/{guard}/fd")) == 1), os.listdir(f"/proc/{guard}/fd"))
        status = dict(line.split(":\t", 1) for line in pathlib.Path(f"/proc/{guard}/status").read_text().splitlines()
                      if ":\t" in line)
        self.assertEqual(status["CapEff"].strip(), "0" * 16)
        self.assertEqual(status["NoNewPrivs"].strip(), "1")
        for number in ORDINARY:
            os.kill(guard, number)
        self.assertTrue(self.scratch.status()["force_guard"]["running"])
        self.assertEqual(gateway.stop(), 0)
        self.assertTrue(g.eventually(lambda: not is_alive(guard)), "the guard goes on")

    def test_a_reader_tells_by_age_where_the_guard_was_killed_too(self):
        gateway, memory = self.start()
        os.kill(self.scratch.status()["force_guard"]["process"], signal.SIGKILL)

        def reported():
            status = self.scratch.status()
            return not status["force_guard"]["running"] and [p for p in status["problems"] if p["kind"] == "force_guard"]

        self.assertTrue(g.eventually(reported), self.scratch.status()["problems"])
        self.assertIn("forces", self.scratch.cellmirror("status").stdout)
        self.assertEqual(self.read_in_c().returncode, 0)
        gateway.kill()
        self.assertEqual(memory_of.read_tcp_force(memory)["values"], list(TEST_FORCE))
        self.assertTrue(g.eventually(lambda: not memory_of.is_current(memory_of.read_tcp_force(memory))))
        seen = self.read_in_c()
        self.assertEqual(seen.returncode, 1, seen.stdout)
        self.assertIn("no longer", seen.stderr)
        self.assertEqual(seen.stdout, "")
        gateway, memory = self.start()  # tidies up
        self.assertTrue(g.eventually(lambda: memory_of.is_current(memory_of.read_tcp_force(memory))))
        self.assertEqual(gateway.stop(), 0)


class Hands(unittest.TestCase):
    """A hand that feels a contact when the gateway dies."""

    def felt(self, end):
        scratch = h.trainer()
        self.addCleanup(scratch.remove)
        gateway = g.Gateway(scratch)
        self.addCleanup(gateway.close)
        device = h.Device(scratch.keys["LAP_LEFT"])
        self.addCleanup(device.close)
        phase = lambda: next(d for d in scratch.status()["haptics"]["devices"] if d["robot"] == "LAP_LEFT")["phase"]
        self.assertTrue(g.eventually(lambda: phase() == "active"))
        into = (0.5721892, 0.3588027, -0.7373937)  # the direction of the shaft; the organ begins after some 75 mm
        device.go([0.09 * x for x in into])
        self.assertTrue(g.eventually(lambda: h.norm(device.force()["force"]) > 0.5), device.force())
        end(gateway)

        def nothing_felt():
            force = device.force()
            return force["gateway"] == 0 and force["phase"] == 0 and h.norm(force["force"]) == 0 and \
                h.norm(force["force_device"]) == 0
        self.assertTrue(g.eventually(nothing_felt), device.force())
        sequence = device.force()["sequence"]
        self.assertEqual(device.force()["sequence"], sequence)
        return scratch

    def test_sighup(self):
        def end(gateway):
            gateway.child.send_signal(signal.SIGHUP)
            self.assertEqual(gateway.child.wait(60), 0)
        self.felt(end)

    def test_kill(self):
        scratch = self.felt(lambda gateway: gateway.kill())
        gateway = g.Gateway(scratch)
        self.assertEqual(gateway.stop(), 0)
        gateway.close()

    def test_crash(self):
        scratch = self.felt(lambda gateway: (os.kill(gateway.child.pid, signal.SIGSEGV), gateway.child.wait(60)))
        gateway = g.Gateway(scratch)
        self.assertEqual(gateway.stop(), 0)
        gateway.close()


if __name__ == "__main__":
    g.main()

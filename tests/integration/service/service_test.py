"""The gateway as a service: notifications, watchdog, /healthz, port of a named instance, state folder, dashboard."""

import json
import os
import pathlib
import re
import signal
import socket
import unittest

import gateway as g
from page_client import Page

DASHBOARD = g.SOURCE / "config" / "grafana" / "cellmirror.json"
# Prometheus makes this one for each target; it tells a gateway that is gone.
MADE_BY_PROMETHEUS = r"\bup\{"


class Manager:
    """The service manager's end of NOTIFY_SOCKET."""

    def __init__(self, address):
        self.address = address
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.socket.bind("\0" + address[1:] if address.startswith("@") else address)

    def until(self, line, timeout=g.PATIENCE_S):
        """Lines of the datagrams up to the one that has `line`."""
        self.socket.settimeout(timeout)
        heard = []
        while line not in heard:
            try:
                heard += self.socket.recv(4096).decode().splitlines()
            except TimeoutError:
                raise AssertionError(f"{line} did not come, but {heard}") from None
        return heard

    def waiting(self):
        """Takes what has come; the number of datagrams."""
        self.socket.setblocking(False)
        count = 0
        try:
            while self.socket.recv(4096):
                count += 1
        except BlockingIOError:
            return count

    def close(self):
        self.socket.close()


def page_of(scratch):
    done = scratch.cellmirror("page", "--json", "--instance", scratch.instance)
    assert done.returncode == 0, done.stderr
    return Page(json.loads(done.stdout))


class Service(unittest.TestCase):
    def setUp(self):
        self.scratch = g.Scratch()
        self.gateway = None

    def tearDown(self):
        if self.gateway:
            self.gateway.close()
        self.scratch.remove()

    def start(self, *arguments, **keywords):
        self.gateway = g.Gateway(self.scratch, *arguments, **keywords)

    def managed(self, address):
        """A gateway whose service manager listens at `address`."""
        manager = Manager(address)
        self.addCleanup(manager.close)
        self.scratch.environment |= {"NOTIFY_SOCKET": address, "WATCHDOG_USEC": "400000"}
        self.start()
        return manager

    def test_tells_when_it_is_ready_that_its_loop_runs_and_when_it_ends(self):
        for address in (str(self.scratch.root / "notify"), f"@{self.scratch.instance}"):
            manager = self.managed(address)
            heard = manager.until("READY=1")
            self.assertEqual(heard[0], "READY=1")
            self.assertRegex("\n".join(heard + manager.until("WATCHDOG=1")), "STATUS=cell transfer_cell with .* at 1000 Hz")
            manager.until("WATCHDOG=1")
            self.gateway.child.send_signal(signal.SIGTERM)
            self.assertNotIn("READY=1", manager.until("STOPPING=1"))
            self.assertEqual(self.gateway.child.wait(60), 0)
            self.gateway.close()

    def test_is_silent_while_it_is_stopped(self):
        manager = self.managed(f"@{self.scratch.instance}")
        manager.until("WATCHDOG=1")
        self.gateway.child.send_signal(signal.SIGSTOP)
        self.assertTrue(g.eventually(lambda: self.state() == "T"))
        manager.waiting()
        self.assertFalse(g.eventually(manager.waiting, timeout=0.5))
        self.gateway.child.send_signal(signal.SIGCONT)
        manager.until("WATCHDOG=1")

    def state(self):
        stat = pathlib.Path(f"/proc/{self.gateway.child.pid}/stat").read_text()
        return stat.rsplit(")", 1)[1].split()[0]

    def test_health_is_a_status(self):
        self.start(page=True)
        page = page_of(self.scratch)

        def healthy():
            return page.ask("/healthz")[::2] == (200, b"ok\n")

        def becomes_healthy():
            if g.eventually(healthy):
                return
            # A fault lasts until the loop has been on time for ten seconds.
            missed = lambda: self.scratch.status()["loop"]["missed"]
            before = missed()
            if g.eventually(lambda: missed() > before + 20, 15):
                self.skipTest("skipped: this machine stands still every few seconds")
            self.fail(page.ask("/healthz"))

        becomes_healthy()  # a machine that is short of time at the start may have had a fault
        self.gateway.child.send_signal(signal.SIGSTOP)
        self.assertTrue(g.eventually(lambda: self.state() == "T"))
        g.time.sleep(2)
        self.gateway.child.send_signal(signal.SIGCONT)
        # The loop has skipped 2000 periods.
        status, _, body = g.eventually(lambda: (answer := page.ask("/healthz"))[0] == 503 and answer) or page.ask("/healthz")
        self.assertEqual(status, 503)
        self.assertRegex(body.decode(), "^the loop .*\n$")
        becomes_healthy()

    def test_the_port_of_the_cell_holds_for_a_named_gateway(self):
        port = g.free_port()
        text = self.scratch.cell_file.read_text()
        self.assertNotIn("[web]", text)
        self.scratch.cell_file.write_text(text + f"\n[web]\nport = {port}\n")
        arguments = [g.BIN / "cellmirror", "run", self.scratch.cell_file, "--headless", "--instance", self.scratch.instance]
        first = g.Process(arguments, self.scratch.environment)
        self.addCleanup(first.close)
        self.assertTrue(g.eventually(lambda: "Ctrl-C ends it" in first.output()), first.output())
        self.assertIn(f"monitor page http://127.0.0.1:{port}/", first.output())
        self.assertEqual(first.stop(), 0)

    def test_everything_is_written_into_the_state_folder(self):
        before = sorted(path.relative_to(self.scratch.home) for path in self.scratch.home.rglob("*"))
        state = self.scratch.root / "state" / "one"
        self.start("--state", state)
        self.assertEqual(self.scratch.send("ROBACT MANTEC_R3").returncode, 0)
        done = self.scratch.send("SAVE_VIEWS mine")
        self.assertEqual(done.returncode, 0, done.stderr)
        done = self.scratch.send("LOAD_VIEWS mine")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue((state / "scripts" / "mine.vws").is_file())
        self.assertTrue(g.eventually(lambda: list((state / "records").glob("commands-*.jsonl"))))
        self.gateway.stop()
        after = sorted(path.relative_to(self.scratch.home) for path in self.scratch.home.rglob("*"))
        self.assertEqual(after, before, "nothing was written into the cell folder")

    def test_every_metric_of_the_dashboard_exists(self):
        self.start(page=True)
        self.assertEqual(self.scratch.send("SET_USSPAR active USS_6 1").returncode, 0)
        page = page_of(self.scratch)

        def known():  # those of collisions and ranges come with the first results
            found = dict(re.findall(r"^# TYPE (\S+) (\S+)$", page.ask("/metrics")[2].decode(), re.MULTILINE))
            return {"cellmirror_nearest_meters", "cellmirror_range_meters"} <= set(found) and found

        families = g.eventually(known)
        self.assertTrue(families)
        dashboard = json.loads(DASHBOARD.read_text())
        expressions = [target["expr"] for panel in dashboard["panels"] for target in panel.get("targets", [])]
        expressions += [variable["query"]["query"] for variable in dashboard["templating"]["list"] if variable["type"] == "query"]
        self.assertGreater(len(expressions), 10)
        for expression in expressions:
            names = re.findall(r"\bcellmirror_\w+", expression)
            self.assertTrue(names or re.search(MADE_BY_PROMETHEUS, expression), expression)
            for name in names:
                family = name if name in families else re.sub("_(sum|count)$", "", name)
                self.assertIn(family, families, expression)
                if families[family] == "counter":
                    self.assertRegex(expression, rf"(rate|increase)\({name}\b", "a counter alone says little")


if __name__ == "__main__":
    g.main()

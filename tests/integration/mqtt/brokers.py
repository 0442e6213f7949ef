"""A broker of mosquitto on the loopback interface, its clients, and a gateway that speaks to it."""

import json
import pathlib
import signal
import subprocess
import tempfile
import unittest

import gateway as g

CELL = "transfer_cell"
BASE = f"cellmirror/{CELL}"
ROBOT = "PUMA_762"


def require():
    """For setUpModule."""
    for program in ("/usr/sbin/mosquitto", "mosquitto_sub", "mosquitto_rr"):
        g.require(program, "mosquitto and mosquitto-clients are not installed")


class Broker:
    """`settings`: further lines of its configuration."""

    def __init__(self, settings="allow_anonymous true\n", port=None):
        self.port = port or g.free_port()
        self.folder = tempfile.TemporaryDirectory(prefix="cellmirror-broker-")
        self.file = pathlib.Path(self.folder.name) / "mosquitto.conf"
        # As the user who runs the test, who can read the files of the test.
        self.file.write_text(f"user root\nlistener {self.port} 127.0.0.1\npersistence false\n{settings}")
        self.process = None
        self.start()

    def start(self):
        self.process = g.Process(["/usr/sbin/mosquitto", "-c", self.file])
        if not g.eventually(self.listens):
            raise AssertionError(self.process.output())

    def listens(self):
        hexadecimal = f":{self.port:04X} "
        with open("/proc/net/tcp", encoding="ascii") as table:
            return any(hexadecimal in line and " 0A " in line for line in table)

    def signal(self, which):
        self.process.child.send_signal(which)

    def kill(self):
        self.process.close()

    def close(self):
        if self.process.running():
            self.signal(signal.SIGCONT)
        self.process.close()
        self.folder.cleanup()


class Listener:
    """What mosquitto_sub hears on `topic`, from when it is made on."""

    def __init__(self, broker, topic="#", options=()):
        self.process = g.Process(["mosquitto_sub", "-h", "127.0.0.1", "-p", str(broker.port), "-t", topic, "-t",
                                  "test/marker", "-F", '{"retained":%r,"topic":"%t","payload":"%x"}', *options])

        def hears():
            publish(broker, "test/marker", "", options)
            return self.all("test/marker")

        if not g.eventually(hears):
            raise AssertionError(self.process.output())

    def all(self, topic):
        """The payloads on that topic, oldest first; those of JSON decoded."""
        out = []
        for line in self.process.output().splitlines():
            if not line.startswith("{") or not line.endswith("}"):
                continue
            message = json.loads(line)
            if message["topic"] == topic:
                text = bytes.fromhex(message["payload"]).decode(errors="replace")
                try:
                    out.append(json.loads(text))
                except json.JSONDecodeError:
                    out.append(text)
        return out

    def events(self, kind):
        return [one for one in self.all(f"{BASE}/event") if one["event"] == kind]

    def close(self):
        self.process.close()


def publish(broker, topic, payload, options=()):
    done = subprocess.run(["mosquitto_pub", "-h", "127.0.0.1", "-p", str(broker.port), "-t", topic, "-m", payload, *options],
                          capture_output=True, text=True, timeout=g.PATIENCE_S)
    if done.returncode != 0:
        raise AssertionError(done.stderr)


def ask(broker, document, answer=f"{BASE}/reply/tester", patience=g.PATIENCE_S):
    """The answer to a command that is sent with MQTT 5's response topic; None where none comes."""
    done = subprocess.run(["mosquitto_rr", "-h", "127.0.0.1", "-p", str(broker.port), "-V", "5", "-q", "1", "-t", f"{BASE}/command", "-e",
                           answer, "-m", json.dumps(document), "-W", str(patience)],
                          capture_output=True, text=True, timeout=2 * g.PATIENCE_S)
    if "Timed out" in done.stderr:
        return None
    if done.returncode != 0:
        raise AssertionError(done.stderr)
    return json.loads(done.stdout)


class MqttCase(unittest.TestCase):
    def make(self, broker, **keys):
        """A scratch cell with [mqtt]."""
        self.scratch = g.Scratch(CELL)
        self.addCleanup(self.scratch.remove)
        self.write(broker, **keys)

    def write(self, broker, **keys):
        lines = [f"{key} = {value if key == 'sparkplug' else json.dumps(value)}\n"
                 for key, value in {"broker": "127.0.0.1", "port": broker.port, **keys}.items()]
        text = self.scratch.cell_file.read_text().split("\n[mqtt]\n")[0]
        self.scratch.cell_file.write_text(text + "\n[mqtt]\n" + "".join(lines))

    def start(self, connected=True):
        self.gateway = g.Gateway(self.scratch)
        self.addCleanup(self.gateway.close)
        if connected:
            self.connected()

    def counters(self):
        return next(one for one in self.scratch.status()["queues"] if one["name"].startswith("mqtt ") and "sent" in one)

    def connected(self):
        self.assertTrue(g.eventually(lambda: self.counters()["connected"] == 1), self.problems())

    def problems(self):
        return [one["text"] for one in self.scratch.status()["problems"] if one["kind"] == "mqtt"]

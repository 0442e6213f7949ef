"""The bridge to OPC UA with the packages of its package-lock.json, and a client of it in a process of its own.

The packages are downloaded where CELLMIRROR_PEERS is set (./check --peers), and kept beside the build; else tests skip where they
are not there."""

import json
import shutil
import subprocess
import sys
import unittest

import gateway as g
from npm_packages import SKIPPED, Packages

SOURCE = g.SOURCE / "ipc" / "opcua"
HERE = g.SOURCE / "tests" / "integration" / "opcua"
PLACE = g.BIN.parent / "opcua"
NODESETS = PLACE / "node_modules" / "node-opcua-nodesets" / "nodesets"
PACKAGES = Packages(SOURCE, PLACE, scripts=HERE)


def why_missing():
    """Empty where the packages are there; the program and the client lie beside them then."""
    missing = PACKAGES.why_missing()
    if missing:
        return missing
    for name in ("package.json", "cellmirror-opcua.mjs"):
        shutil.copy(SOURCE / name, PLACE)
    shutil.copytree(SOURCE / "src", PLACE / "src", dirs_exist_ok=True)
    return ""


class Bridge(g.Process):
    """A running bridge that shows the gateway of the scratch folder, or those of `instances`."""

    def __init__(self, scratch, *arguments, instances=None, bind="127.0.0.1", state="opcua", node_options=""):
        self.port = g.free_port()
        self.url = f"opc.tcp://{bind}:{self.port}"
        self.state = scratch.root / state
        names = [part for name in instances or [scratch.instance] for part in ("--instance", name)]
        super().__init__(["node", PLACE / "cellmirror-opcua.mjs", *names, "--bind", bind, "--port", self.port, "--state",
                          self.state, *arguments], scratch.environment | {"NODE_OPTIONS": node_options})
        if not g.eventually(lambda: "OPC UA at" in self.output() or not self.running()) or not self.running():
            raise AssertionError(f"the bridge did not start:\n{self.output()}")

    def wait_for(self, words):
        if not g.eventually(lambda: words in self.output()):
            raise AssertionError(f"the bridge did not say {words}:\n{self.output()}")

    def ask(self, what, *arguments, timeout=120):
        """The client's document."""
        done = subprocess.run(["node", "client.mjs", what, self.url, *[str(one) for one in arguments]], cwd=PLACE,
                              capture_output=True, text=True, timeout=timeout)
        if done.returncode != 0:
            raise AssertionError(done.stderr)
        return json.loads(done.stdout.splitlines()[-1])  # node-opcua writes its warnings before it

    def nodes(self):
        """What is below the devices, by NodeId."""
        return {node["id"]: node for node in self.ask("browse")["nodes"]}

    def watch(self, *ids):
        return Watch(self, ids)


class Watch(g.Process):
    """A client with a subscription of some variables."""

    def __init__(self, bridge, ids):
        super().__init__(["node", PLACE / "client.mjs", "watch", bridge.url, *ids])

    def notifications(self):
        lines = self.output().split("\n")[:-1]
        return [json.loads(line) for line in lines if line.startswith("{")]

    def newest(self, node):
        return next((one for one in reversed(self.notifications()) if one["id"] == node), None)


def main():
    missing = why_missing()
    if missing:
        print(f"skipped: {missing}")
        sys.exit(SKIPPED)
    unittest.main(verbosity=2)

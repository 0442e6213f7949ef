"""The monitor page of a running gateway in headless Chromium: sees a robot move, orbits, commands, sees a refusal
explained, loses the gateway and gets it back."""

import json
import re
import unittest
import urllib.request

import browser
import gateway as g

ROBOT = "MANTEC_R3"  # CiA 402 over udp multicast in the transfer cell
REFUSED = "ROBOT PUMA_763 online"


def setUpModule():
    browser.chromium(), browser.node(), browser.playwright_core()


def cell_with_few_pictures():
    """Each is drawn by the processor, and more show nothing else."""
    scratch = g.Scratch()
    with open(scratch.cell_file, "a", encoding="utf-8") as cell:
        cell.write("\n[display]\nrate_hz = 5\n")
    return scratch


class PageGateway(g.Gateway):
    """With its page and pictures, at a port that stays the same when it is started again."""

    def __init__(self, scratch, port):
        self.scratch = scratch
        self.instance = scratch.instance
        g.Process.__init__(self, [g.BIN / "cellmirror", "run", scratch.cell_file, "--port", str(port), "--instance", scratch.instance],
                           scratch.environment)
        self.wait_ready()


class Scene(unittest.TestCase):
    """The 3D view; nothing moves but what is commanded."""

    def test_the_view_moves_with_a_joint_and_names_what_is_clicked(self):
        scratch = cell_with_few_pictures()
        self.addCleanup(scratch.remove)
        gateway = PageGateway(scratch, g.free_port())
        self.addCleanup(gateway.close)
        address = json.loads(scratch.cellmirror("page", "--json", "--instance", scratch.instance).stdout)
        output = browser.Scenario("scene_gateway", f"{address['address']}#token={address['token']}").run()
        path = re.search(r"^picked: (.+)$", output, re.M)[1]
        shown = urllib.request.urlopen(f"{address['address']}api/tree", timeout=60).read()
        self.assertIn(path, [node["path"] for node in json.loads(shown)["nodes"]])


class Page(unittest.TestCase):
    def setUp(self):
        self.scratch = cell_with_few_pictures()
        self.port = g.free_port()
        self.robot = g.sim_robot("cia402", "--channel", "udp:239.74.163.2:43113", "--nodes", "1-6", "--rate", "100",
                                 "--motion", "sine:amplitude=0.5,period=3")
        self.start()

    def tearDown(self):
        self.gateway.close()
        self.robot.close()
        self.scratch.remove()

    def start(self):
        self.gateway = PageGateway(self.scratch, self.port)
        self.assertEqual(self.scratch.send(f"ROBOT {ROBOT} online").returncode, 0)

    def outside(self, word):
        if word == "gone":
            self.assertEqual(self.gateway.stop(), 0, self.gateway.output())
            self.gateway.close()
        elif word == "back":
            self.start()
            # As many as the page had of the gateway before: only the run tells that these are others.
            self.assertEqual(self.scratch.send("hot_message The gateway is new").returncode, 0)

    def test_a_visit(self):
        shown = self.scratch.cellmirror("page", "--instance", self.scratch.instance, instance=False)
        self.assertEqual(shown.returncode, 0, shown.stderr)
        address = next(word for word in shown.stdout.split() if word.startswith("http"))
        output = browser.Scenario("gateway", address, ROBOT, REFUSED).run(self.outside)
        self.assertIn("PUMA_762", output)  # the refusal names the nearest
        for name in ("gateway-desk-light", "gateway-orbit", "gateway-console", "gateway-gone", "gateway-back"):
            self.assertGreater((browser.ARTEFACTS / f"{name}.png").stat().st_size, 10000)


if __name__ == "__main__":
    unittest.main(verbosity=2)

"""A cell in which everything that strangers can reach runs at once: a CAN robot, a DDS robot, a hand that feels a force, MQTT, a page."""

import random
import re
import shutil
import subprocess
import urllib.request

import gateway as g
import hostile
import trainer as t

PUMA = ",".join(f"puma_762_joint_{i}" for i in range(1, 7))
TOUCH = f"motion touch {t.LEFT['into']} 0.12 speed=0.12 at=0.3; press 0.015 100000s"
RECOVERED_WITHIN_S = 2.0
# After a machine has stood still for 0.1 s the hand may stand where its contact chatters: then forces of less than NO_FORCE_N come one
# by one. Where a force is taken away, none of them comes for longer than PAUSE_ROWS in a row, at 1 kHz.
NO_FORCE_N = 0.05
PAUSE_ROWS = 20
# Least share of the looks at the force and at the CAN robot: a busy machine delays the simulator, too.
FORCE_LOOKS = 0.7
FRESH_LOOKS = 0.8


def _streams(domain, can_port, broker_port):
    nodes = "".join(f'  {{ id = {i}, joint = "J_{i}", increments_per_rad = 100000 }},\n' for i in range(1, 7))
    joints = "".join(f'  {{ joint = "J_{i}", ros_name = "puma_762_joint_{i}" }},\n' for i in range(1, 7))
    return f"""
[[node]]
name = "Arm"
abstract = "manutec_r3.mpc"
robot_id = "MANTEC_R3"
xyz_m = [3.0, 3.0, 0.0]

[[node]]
name = "Puma"
abstract = "puma_762.mpc"
xyz_m = [6.0, 3.0, 0.0]

[[stream]]
robot = "MANTEC_R3"
kind = "can-cia402"
channel = "udp:239.74.163.9:{can_port}"
interface = "lo"
node = [
{nodes}]

[[stream]]
robot = "PUMA_762"
kind = "dds"
domain = {domain}
topic = "rt/joint_states"
joint = [
{joints}]

[dds_output]
domain = {domain}
rate_hz = 50

[mqtt]
broker = "127.0.0.1"
port = {broker_port}
"""


class GuardedCell:
    """Started whole: after the constructor both robots are fresh, a force is felt, the page answers."""

    def __init__(self):
        chance = random.SystemRandom()
        self.domain, self.can_port = chance.randrange(20, 200), chance.randrange(20000, 30000)
        self.children, self.hand, self.gateway = [], None, None
        self.broker = hostile.FakeBroker()
        self.datagrams = hostile.Datagrams(self.domain)
        self.scratch = g.Scratch("phantom_trainer")
        for name in ("manutec_r3.mpc", "puma_762.mpc"):
            shutil.copy(g.CELLS / "transfer_cell" / "envlib" / name, self.scratch.home / "envlib" / name)
        shutil.copytree(g.CELLS / "transfer_cell" / "envlib" / "meshes", self.scratch.home / "envlib" / "meshes", dirs_exist_ok=True)
        self.keys = t.with_own_memories(self.scratch, more=t.UNDISTURBED)
        with open(self.scratch.cell_file, "a", encoding="utf-8") as cell:
            cell.write(_streams(self.domain, self.can_port, self.broker.port))
        (self.scratch.home / "scripts" / "startup.spt").write_text("ROBOT MANTEC_R3 online;\nROBOT PUMA_762 online;\n")
        try:
            self._start()
        except BaseException:
            self.close()
            raise

    def _start(self):
        self.sim("cia402", "--channel", f"udp:239.74.163.9:{self.can_port}", "--nodes", "1-6", "--rate", "250",
                 "--increments-per-rad", "100000", "--motion", "sine:amplitude=0.3,period=8")
        self.dds_robot = self.sim("dds", "--domain", self.domain, "--topic", "rt/joint_states", "--joint-names", PUMA, "--rate", "125",
                                  "--motion", "sine:amplitude=0.2,period=10,offset=-0.3")
        self.gateway = g.Gateway(self.scratch, page=True)
        self.page = re.search(r"http://127\.0\.0\.1:\d+", self.gateway.output())[0]
        self.hand = t.Hand(self.scratch, self.keys["LAP_LEFT"], seconds=100_000)
        if not g.eventually(lambda: self.fresh("MANTEC_R3") and self.fresh("PUMA_762")):
            raise AssertionError(self.scratch.status()["robots"])
        self.press()

    def sim(self, *arguments):
        command = [str(g.BIN / "sim_robot"), *map(str, arguments), "--no-input", "--quiet", "--for", "100000"]
        self.children.append(subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
        return self.children[-1]

    def engaged(self):
        device = t.haptic(self.scratch, "LAP_LEFT")
        if device["phase"] == "faulted":  # a busy machine at the start
            self.scratch.send("RESET_HAPTIC LAP_LEFT")
        return device["phase"] == "active" and device["device"]["process"] == self.hand.child.pid

    def press(self):
        """Until a force is felt."""
        def felt():
            if not self.engaged():
                self.hand.say("motion back speed=0.3")
                self.hand.say(TOUCH)
            return self.force() > 0.4
        if g.eventually(self.engaged):
            self.hand.say(TOUCH)
        if not g.eventually(felt):
            raise AssertionError(t.haptic(self.scratch, "LAP_LEFT"))

    def force(self):
        return sum(part * part for part in t.haptic(self.scratch, "LAP_LEFT")["force"]["world_n"]) ** 0.5

    def fresh(self, robot):
        return self.scratch.robot(robot)["stream"]["state"] == "fresh"

    def process(self, program):
        return next(one for one in self.scratch.status()["processes"] if one["program"] == program)

    def page_answers(self):
        with urllib.request.urlopen(self.page + "/", timeout=10) as answer:
            return answer.status == 200

    def close(self):
        if self.hand is not None:
            self.hand.kill()
        for child in self.children:
            child.kill()
            child.wait()
        if self.gateway is not None:
            self.gateway.close()
        self.broker.close()
        self.datagrams.close()
        self.scratch.remove()

"""The whole gateway, built with sanitizers, through all that goes on at once: streams that come and go, robot programs,
scripts, pictures, eight clients of the page, haptic devices, and an end while everything runs. Neither answers nor times are
judged here, only reports of the sanitizers and how the programs end. docs/sanitizers.md."""

import json
import os
import pathlib
import random
import signal
import sys
import threading
import time
import unittest
import uuid

import gateway as g
import sanitizers
import trainer as t

sys.path.insert(0, str(g.SOURCE / "tests" / "integration" / "web"))
from page_client import Live, Page, picture_number  # noqa: E402

SECONDS = float(os.environ.get("SCENARIO_SECONDS", "8"))  # of each running gateway
PATIENCE = 120  # seconds; sanitizers make a program up to ten times slower
WISHES = ({}, {"view": 0}, {"view": 3}, {"camera": "UMG_Kamera_1"}, {"camera": "CAMERA_5"},
          {"free": {"viewpoint_m": [4, -4, 3], "lookpoint_m": [4, 0, 1], "twist_rad": 0, "opening_angle_rad": 0.7}})


def takes_signal(pid, which):
    """Whether the program handles or blocks the signal (proc(5), status)."""
    masks = [int(line.split()[1], 16) for line in pathlib.Path(f"/proc/{pid}/status").read_text().splitlines()
             if line.startswith(("SigBlk:", "SigCgt:"))]
    return any(mask >> (which - 1) & 1 for mask in masks)


class PageClient(threading.Thread):
    """A page in somebody's browser: looks, asks, commands; goes away without a word and comes again."""

    def __init__(self, page, commands, seed):
        super().__init__(daemon=True)
        self.page, self.commands, self.chance = page, commands, random.Random(seed)
        self.ended = threading.Event()
        self.pictures = self.replies = 0
        self.start()

    def run(self):
        while not self.ended.is_set():
            try:
                self.ask()
                self.look(Live(self.page, 16384))
            except (OSError, AssertionError):
                self.ended.wait(0.1)  # the gateway has ended, or has enough of this client

    def ask(self):
        path = self.chance.choice(("/api/status", "/api/tree", "/api/names", "/api/commands", "/metrics", "/", "/nowhere",
                                   "/snapshot.png?view=0&width=160&height=120", "/snapshot.jpg?camera=NOBODY"))
        self.page.ask(path)
        if self.chance.random() < 0.5:
            self.page.command(self.chance.choice(self.commands))

    def look(self, live):
        live.socket.settimeout(2)
        try:
            live.say(do="hello", token=self.page.token)
            live.say(do="picture", width=self.chance.choice((64, 200, 320)), height=150, rate_hz=10, quality=60,
                     **self.chance.choice(WISHES))
            for number in range(self.chance.randrange(5, 60)):
                if self.ended.is_set():
                    return
                message = live.hear()
                shown = picture_number(message)
                if shown is not None:
                    self.pictures += 1
                    live.say(do="shown", sequence=shown)
                    if number % 4 == 0:
                        live.say(do="pick", id=number, x=self.chance.randrange(64), y=self.chance.randrange(64))
                elif message["is"] == "reply":
                    self.replies += 1
                if number % 5 == 0:
                    live.say(do="command", id=number, text=self.chance.choice(self.commands))
                if number % 11 == 0:
                    live.say(do="picture", width=160, height=120, rate_hz=5, quality=50, **self.chance.choice(WISHES))
        finally:
            live.close()

    def end(self):
        self.ended.set()
        self.join(30)


class Sanitized(unittest.TestCase):
    def setUp(self):
        self.reports = sanitizers.Reports()
        self.addCleanup(self.reports.close)
        self.scratch = None
        self.gateway = None
        self.devices = {}
        self.clients = []

    def tearDown(self):
        for client in self.clients:
            client.end()
        for device in self.devices.values():
            device.close()
        if self.gateway:
            self.gateway.close()
        if self.scratch:
            self.scratch.remove()
        reports = self.reports.texts()
        self.assertFalse(reports, f"{len(reports)} reports:\n" + "\n".join(reports))

    def cell(self, name, startup=False):
        """A copy of the cell whose loop leaves something of the processor to the others."""
        self.scratch = g.Scratch(name, startup=startup)
        self.scratch.environment.update(self.reports.environment())
        self.replace('real_time = "prefer"', 'real_time = "off"')
        return self.scratch

    def replace(self, old, new):
        text = self.scratch.cell_file.read_text()
        self.assertIn(old, text)
        self.scratch.cell_file.write_text(text.replace(old, new))

    def run_gateway(self, *arguments, rate=200):
        self.gateway = g.Gateway(self.scratch, "--rate", str(rate), *arguments, wait=False, pictures=True, page=True)
        self.gateway.wait_ready(PATIENCE)

    def page(self):
        done = self.scratch.cellmirror("page", "--json", "--instance", self.scratch.instance, timeout=PATIENCE)
        self.assertEqual(done.returncode, 0, done.stderr)
        return Page(json.loads(done.stdout))

    def watch(self, page, commands, count):
        self.clients += [PageClient(page, commands, seed) for seed in range(count)]

    def device(self, name, program, *arguments):
        if name in self.devices:
            self.devices.pop(name).close()
        self.devices[name] = g.Process([g.BIN / program, *map(str, arguments), "--no-input", "--quiet"], self.scratch.environment)

    def asks(self, *arguments):
        """Any answer will do; a crash will not."""
        done = self.scratch.cellmirror(*arguments, timeout=PATIENCE)
        self.assertIn(done.returncode, (0, 1), f"{arguments}: {done.stderr}")

    def send_all(self, page, commands, seconds):
        """One after the other, for so long; their answers are their own matter."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            for command in commands:
                if isinstance(command, str):
                    try:
                        page.command(command)
                    except OSError:
                        self.assertTrue(self.gateway.running(), f"it ended with {self.gateway.child.poll()}:\n{self.gateway.output()}")
                else:
                    command()
                if time.monotonic() > end:
                    return
                time.sleep(0.02)

    def still_runs(self):
        self.assertTrue(self.gateway.running(), f"it ended with {self.gateway.child.poll()}:\n{self.gateway.output()}")

    def ends_in_order(self):
        self.still_runs()
        self.assertEqual(self.gateway.stop(PATIENCE), 0, self.gateway.output())


class TransferCell(Sanitized):
    """Streams over CAN and DDS, robot programs in four languages, pictures, the page."""

    COMMANDS = (
        "ROBACT MANTEC_R3", "POS_ROB MANTEC_RM3 JOINT_INC 3 2 1 0 0 0", "POS_ROB mantec_R3a FRAME_INC X 20 Z -10",
        "MOVE_ROB mantec_R3 PTP JOINT_INC 5 0 -5 0 0 0", "MOVE_ROB mantec_R3 LIN TOOL_INC Z 15", "STOP_ROB mantec_R3",
        "STOP_ROB MANTEC_RM3", "SET_COLLPAR active 0", "SET_COLLPAR active 1", "SET_COLLPAR warning 300",
        "SET_USSPAR active USS_6 1", "SET_USSPAR sendmode 1", "SET_USSPAR active USS_6 0", "SET_FORCE_ARROW 4 4 0",
        "ACTIVATE Testlab_1.FL_Klein_02.Flansch_Typ1", "DEACTIVATE Testlab_1.FL_Klein_02.Flansch_Typ1", "LEVEL_DOWN Testlab_1.FL_Klein",
        "LEVEL_UP Testlab_1.FL_Klein", "SWAP_NODE HTL_UMGEBUNG.FL_Klein01", "SET_FRAME Toolbox PLACEMENT 0 0 0 600 1600 0",
        "CONNECT Testlab_1.FL_Klein_02.Flansch_Typ1 TO Zellenkran.HAKEN", "FRAME_TO_WFRM Toolbox.Tool1 TO Mantec_1.HAND Tool1_WFRM",
        "LOAD_VIEWS trs_demo.vws", "LOAD_VIEWS overview.vws", "SAVE_VIEWS kept.vws", "STDP 5 FULL_OFF", "STDP 1 FULL",
        "STVW 0 VP 4000 -3000 2500 LP 4000 0 900 TIME 1", "COVW 1 CAMERA_5", "CAM_VIEW_PYRAMID CAMERA_5 on",
        "CAM_TRACKING CAMERA_5 on Mantec_3.HAND", "SET_CAMPAR CAMERA_5 4.85 20", "SET_MODE SMEAR on", "SET_MODE TCP_DRAW on",
        "SET_MODE WFRM_display on", "SHAD off", "SHAD on", "hot_message all at once", "SAVE_FLIGHT all.jsonl", "DRAW_SCENE",
        "MASTER_SLAVE on mantec_R3 1 mantec_R3a 2 1 1 2 2", "MASTER_SLAVE off mantec_R3 1 mantec_R3a 2 1 1 2 2",
        "SET_EXT_TCP_TEST on 1 2 3 4", "SET_EXT_TCP_TEST off 0 0 0 0", "TF_HOLD ZELLENKRAN", "TF_STEP ZELLENKRAN FORWARD",
        "TF_RESUME ZELLENKRAN", "TF_STOP mantec_R3", "TF_RUN hs1 ZELLENKRAN", "rob_tcp_def 0 0 50 0 0 0", "rob_vel_profile ramp",
        "SET_INPUT ZELLENKRAN 1 on", "NONSENSE 1 2", "POS_ROB NOBODY JOINT_ABS 1", "")

    def start_robot(self):
        self.device("MANTEC_R3", "sim_robot", "cia402", "--channel", self.channel, "--nodes", "1-6", "--rate", 100,
                    "--increments-per-rad", 100000, "--motion", "sine:amplitude=0.5,period=8,step=0.7")

    def start_puma(self):
        names = ",".join(f"puma_762_joint_{i}" for i in range(1, 7))
        self.device("PUMA_762", "sim_robot", "dds", "--topic", self.topic, "--joint-names", names, "--rate", 100,
                    "--motion", "sine:amplitude=0.4,period=10,offset=-0.2,step=0.5")

    def start_camera_head(self):
        self.device("KAMERAKOPF_1", "sim_camera_head", "--camera", "UMG_Kamera_1", "--channel", self.channel, "--nodes", "21,22",
                    "--rate", 50, "--pan-range", "-1.6,1.6", "--tilt-range", "-1.4,0.45", "--start", "0,-0.6292")

    def goes_away(self, name, start):
        def action():
            self.devices[name].kill()
            start()
        return action

    def start_all(self):
        self.cell("transfer_cell", startup=True)
        # Whoever else simulates robots on this machine is not heard.
        self.channel = f"udp:239.74.163.2:{random.randrange(20000, 40000)}"
        self.topic = "rt/joint_states_" + uuid.uuid4().hex[:8]
        self.replace("udp:239.74.163.2:43113", self.channel)
        self.replace('topic = "rt/joint_states"', f'topic = "{self.topic}"')
        # With sanitizers it takes half a minute to find out which of all pairs can touch.
        self.replace("[collision]\nignore = [", '[collision]\ntest = [{ a = "Mantec_3", b = "Testlab_1" }, { a = "Mantec_4", b = "Puma" }]\n'
                     'ignore = [{ a = "", b = "" }, ')
        self.start_robot()
        self.start_puma()
        self.start_camera_head()
        self.run_gateway()

    def test_it_ends_in_order_while_everything_runs(self):
        self.start_all()
        page = self.page()
        self.watch(page, self.COMMANDS, 8)
        scripts = ("EXEC_SCRIPT programs_demo.spt", "EXEC_SCRIPT two_languages.spt", "EXEC_SCRIPT teach_demo.spt",
                   "EXEC_SCRIPT trs_demo.spt")
        streams = ("ROBOT PUMA_762 offline", self.goes_away("MANTEC_R3", self.start_robot), "ROBOT PUMA_762 online",
                   "ROBOT MANTEC_R3 offline", self.goes_away("PUMA_762", self.start_puma), "ROBOT MANTEC_R3 online",
                   "DELETE_NODE Mantec_4", "ROBOT KAMERAKOPF_1 offline", "ROBOT KAMERAKOPF_1 online")
        self.send_all(page, (*scripts, *streams, *self.COMMANDS), SECONDS)
        self.asks("send", "hot_message over the queue")
        self.asks("status", "--json")
        self.asks("snapshot", "--size", "160x120", "--instance", self.scratch.instance, "-o", str(self.scratch.root / "now.png"))
        self.send_all(page, scripts, 0.5)
        self.assertGreater(sum(client.pictures for client in self.clients), 0)
        self.ends_in_order()

    def test_it_is_told_to_end_before_it_has_begun(self):
        self.cell("transfer_cell", startup=True)
        self.replace("[collision]", "[collision]\nactive = false")  # to find the pairs takes long with sanitizers, and goes on
        self.gateway = g.Gateway(self.scratch, "--rate", "200", wait=False, pictures=True, page=True)
        # Before that the kernel ends it, as any program.
        self.assertTrue(g.eventually(lambda: takes_signal(self.gateway.child.pid, signal.SIGINT), PATIENCE))
        self.assertEqual(self.gateway.stop(PATIENCE), 0, self.gateway.output())

    def test_programs_that_come_to_their_end(self):
        cell = str(self.cell("transfer_cell").cell_file)
        out = self.scratch.root
        for arguments in (
            ("simulate", "--cell", cell, "--script", "teach_demo.spt", "--no-collisions", "--json", "--plot",
             str(out / "simulated.png")),
            ("check", cell, str(self.scratch.home / "scripts" / "programs_demo.spt")), ("doctor", "--json"),
            ("run", str(out / "nothing.toml"))):
            with self.subTest(arguments[0]):
                self.asks(*arguments)


class Trainer(Sanitized):
    """Two hands and a foot; one hand dies with its force on."""

    COMMANDS = ("RESET_HAPTIC LAP_LEFT", "RESET_HAPTIC LAP_RIGHT", "ACTIVATE LampCutting", "DEACTIVATE LampCutting", "DEACTIVATE Phantom",
                "ACTIVATE Phantom", "ROBOT LAP_LEFT offline", "ROBOT LAP_LEFT online", "BIN_ELA offline", "BIN_ELA online",
                "SET_FORCE_ARROW 4 4 0", "LOAD_VIEWS laparoscope.vws", "TAG_DRAWLEN 30", "DRAW_SCENE")

    def start_hand(self, robot, into):
        self.device(robot, "sim_haptic", "--key", self.keys[robot], "--axes", 7, "--repeat", "--for", 0, "--tremor", "1e-4", "--motion",
                    f"hold:300ms;touch:{into}:0.12:speed=0.2:at=0.3;press:0.004:500ms;drag:x:0.01;back:speed=0.2")

    def test_it_ends_in_order_with_forces_on(self):
        self.cell("phantom_trainer", startup=True)
        self.keys = t.with_own_memories(self.scratch)
        self.run_gateway(rate=500)
        page = self.page()
        self.start_hand("LAP_LEFT", t.LEFT["into"])
        self.start_hand("LAP_RIGHT", t.RIGHT["into"])
        self.device("PEDALS", "sim_footswitch", "--key", self.keys["switches"], "--random", 0.2, "--inputs", 2, "--for", 600)
        self.watch(page, self.COMMANDS, 2)
        dies = lambda: self.start_hand("LAP_LEFT", t.LEFT["into"])  # what runs is killed first
        self.send_all(page, (*self.COMMANDS, dies), SECONDS)
        self.asks("status", "--json")
        self.ends_in_order()


if __name__ == "__main__":
    g.main()

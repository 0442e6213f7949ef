#!/usr/bin/env python3
"""Stands in for the gateway behind the monitor page: serves ipc/web/page and speaks docs/monitor-page.md with a made-up
cell that moves. For work on the page without a build, and for tests of the page alone. Standard library only.

    python3 tests/support/page_standin.py --port 8421 --robots 20 --joints 10
"""

import argparse
import asyncio
import base64
import hashlib
import json
import math
import mimetypes
import os
import pathlib
import struct
import subprocess
import sys
import time
import traceback

import standin_alarms
import standin_jpeg
import standin_playback
import standin_scene

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "ipc" / "web" / "page"
SHARE = pathlib.Path("/usr/share/javascript")  # Debian's libjs-three and libjs-dygraphs, as ipc/web/CMakeLists.txt embeds them
LIBRARIES = {"lib/three/build/three.module.js": "three/three.module.js",
             "lib/three/examples/jsm/loaders/GLTFLoader.js": "three/examples/jsm/loaders/GLTFLoader.js",
             "lib/dygraph.min.js": "dygraphs/dygraph.min.js", "lib/dygraph.min.css": "dygraphs/dygraph.min.css"}
POLICY = ("default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src 'self'; "
          "base-uri 'none'; form-action 'none'; frame-ancestors 'none'")
MODES = ["WFRM_display", "SMEAR", "BFRM", "CPU_BFRM", "CAM_MAINVIEW", "LGT_TWOSIDE", "TCP_DRAW", "ZPF_DRAW", "FLDR",
         "GEO_VIS_TEST", "SHAD", "BEEP", "TEXTURES", "ANTIALIAS", "LEGEND"]
FEW_COMMANDS = [
    {"name": "ROBACT", "syntax": "ROBACT <Robot_id>", "help": "makes a robot the active one", "kind": "command",
     "example": "ROBACT ROBOT_1", "parameters": [{"name": "Robot_id", "meaning": "robot"}]},
    {"name": "ROBOT", "syntax": "ROBOT <Robot_id> [online | offline]", "help": "follows the real robot, or not",
     "kind": "command", "example": "ROBOT ROBOT_1 online", "parameters": [{"name": "Robot_id", "meaning": "robot"}]},
    {"name": "hot_message", "syntax": "hot_message <text>", "help": "shows a message", "kind": "command",
     "example": "hot_message Hello", "parameters": [{"name": "text", "meaning": "message"}]},
    {"name": "LEVEL_DOWN", "syntax": "LEVEL_DOWN <frame_node>", "help": "one more layer of details", "kind": "command",
     "example": "LEVEL_DOWN Cell.Table", "parameters": [{"name": "frame_node", "meaning": "frame or joint"}]},
]


class Cell:
    """Robots that swing, and what SCRIPT has set; time counts from the start."""

    def __init__(self, robots, joints):
        self.start = time.monotonic()
        self.ids = [f"ROBOT_{i + 1}" for i in range(robots)]
        self.joints = joints
        self.online = {robot: i % 3 != 2 for i, robot in enumerate(self.ids)}
        self.active = self.ids[0] if self.ids else ""
        self.messages = []
        self.modes = {mode: mode in ("FLDR", "SHAD", "LEGEND", "BEEP") for mode in MODES}
        self.display, self.full_screen = 1, False
        self.views = [{"id": i, "name": f"angle {i}", "viewpoint_m": [6 + i, -9, 5 + i], "lookpoint_m": [4, 0, 0.8], "twist_rad": 0,
                       "opening_angle_rad": 0.7, "camera": "", "moving": False} for i in range(7)]
        self.displays = [{"id": i, "name": f"layout {i}", "views": [i] if i > 1 else [0, 1]} for i in range(1, 7)]
        self.hidden, self.revision = set(), 1
        self.problems = []
        self.alarms = standin_alarms.Alarms()
        self.still = False  # joints stand where they are after a second
        self.playback = None  # a standin_playback.Playback: of a recording

    def command_log(self):
        """Made up, one of each source; the last one is the newest."""
        return {"file": "records/commands-default.jsonl", "written": 3, "dropped": 0, "last": [
            {"time": "2026-11-23T08:00:00.123Z", "took_s": 0.001, "source": "file", "place": "scripts/a.spt:12", "run": 1,
             "command": "ROBACT ROBOT_1", "outcome": "done"},
            {"time": "2026-11-23T08:00:01.123Z", "took_s": 0.001, "source": "message", "process": 12, "user": 1000,
             "command": "ROBACT nobody", "outcome": "refused", "answer": "there is no robot nobody"},
            {"time": "2026-11-23T08:00:02.123Z", "took_s": 0.001, "source": "page", "session": 3, "peer": "uid 1000",
             "command": "hot_message <b>x</b>", "outcome": "done"}]}

    def now(self):
        return time.monotonic() - self.start

    def state(self, i):
        if not self.online[self.ids[i]]:
            return "none"
        return "stale" if i % 7 == 4 else "lost" if i % 7 == 6 else "fresh"

    def angle(self, i, k):
        return 1.2 * math.sin(0.5 * (1 if self.still else self.now()) + 0.7 * i + 0.9 * k) / (1 + 0.15 * k)

    def robot(self, i):
        age = {"fresh": 0.004, "stale": 0.31, "lost": 12.5 + self.now(), "none": None}[self.state(i)]
        joints = []
        for k in range(self.joints):
            slides = k == 0 and i % 4 == 0
            joints.append({"name": f"J_{k + 1}", "kind": "prismatic" if slides else "revolute", "unit": "m" if slides else "rad",
                           "position": self.angle(i, k), "velocity": 0.6 * math.cos(0.5 * self.now() + 0.7 * i + 0.9 * k),
                           "lower": -1.4 if k < 5 else None, "upper": 1.4 if k < 5 else None, "state": self.state(i)})
        mode = "mirrored" if self.online[self.ids[i]] else "simulated"
        return {"id": self.ids[i], "mode": mode, "state": self.state(i), "age_s": age, "active": self.ids[i] == self.active,
                "moving": i == 0, "condition": "silent for 12 s" if self.state(i) == "lost" else "", "joints": joints}

    def near(self):
        pairs = []
        for i in range(min(8, max(0, len(self.ids) - 1))):
            distance = 0.02 + 0.3 * abs(math.sin(0.2 * self.now() + i))
            pairs.append({"a": f"{self.ids[i]}.J_4.link", "b": f"Cell.Table_{i}.top",
                          "a_short": f"{self.ids[i]}.link", "b_short": f"Table_{i}.top", "distance_m": distance,
                          "time_to_contact_s": distance / 0.05 if i % 2 else None})
        return sorted(pairs, key=lambda pair: pair["distance_m"])

    def live(self):
        now = self.now()
        n = len(self.ids)
        touching = [{"a": f"{self.ids[0]}.J_6.tool", "b": "Cell.Table_1.top", "a_short": f"{self.ids[0]}.tool", "b_short": "Table_1.top",
                     "depth_m": 0.0031}] if n and int(now / 8) % 2 else []
        forces = [{"robot": robot, "tcp_force_n": [3 * math.sin(now), 1, 9.81] if i == 0 else None,
                   "joints": [{"name": f"J_{k + 1}", "unit": "rad", "effort": 20 * math.cos(now + k), "max_effort": 100,
                               "beyond_limit": False} for k in range(self.joints)]} for i, robot in enumerate(self.ids[:2])]
        return {
            "is": "live", "time_s": time.time(), "uptime_s": now, "cell": "stand_in", "instance": "standin", "revision": self.revision,
            "loop": {"rate_hz": 1000, "latency_p99_us": 40 + 6 * math.sin(3 * now), "compute_p99_us": 9 + math.sin(2 * now),
                     "missed": 0},
            "robots": [self.robot(i) for i in range(n)], "touching": touching, "near": self.near(), "warning_distance_m": 0.1,
            "within_warning_count": sum(pair["distance_m"] <= 0.1 for pair in self.near()),
            "collision_age_s": 0.003,
            "ranges": [{"id": f"USS_{i}", "distance_m": 0.4 + 0.3 * math.sin(now + i) if i < 2 else None, "range_m": 2.0,
                        "object": "Cell.Table_1.top", "object_short": "Table_1.top", "in_blind_zone": False, "doubtful": i == 1} for i in range(3)],
            "light_barriers": [{"name": "gate", "interrupted": bool(touching), "interruptions": int(now / 16), "doubtful": False,
                                "object": "Cell.Table_1.top" if touching else "", "object_short": "Table_1.top" if touching else ""}],
            "forces": forces,
            "problems": [{"kind": "script_queue", "text": text} for text in self.problems], "commands_logged": 3,
            "alarms": self.alarms.counts(), **({"replay": self.playback.state()} if self.playback else {}),
            "queues": [{"name": name, "dropped": dropped, "high_water": 12, "capacity": 1024} for name, dropped in
                       (("messages (2351)", 0), ("sensor queue (1990)", int(3 * now)), ("ticks to the studio", 0))],
            "messages": [{"number": number, "text": text, "age_s": now - at} for number, at, text in self.messages[-20:]],
            "display": {"display": self.display, "full_screen": self.full_screen, "views": self.views,
                        "displays": self.displays, "modes": self.modes},
            "cameras": ["CAMERA_5", "UMG_Kamera_1"], "bell": self.modes["BEEP"],
        }

    def status(self):
        """As far as the page asks for it."""
        live = self.live()
        return {**live, "replay": {**live["replay"], "marks": self.playback.marks}} if self.playback else live

    def tree(self):
        nodes = [{"path": "Cell", "name": "Cell", "parent": None, "kind": "frame", "shown": True, "has_detail": False}]

        def add(parent, name, kind, detail=False):
            path = f"{parent}.{name}" if parent else name
            nodes.append({"path": path, "name": name, "parent": parent, "kind": kind, "shown": path not in self.hidden,
                          "has_detail": detail})
            return path

        for i in range(8):
            add(add("Cell", f"Table_{i}", "frame", detail=i < 3), "top", "frame")
        for robot in self.ids:
            path = add(None, robot, "robot", detail=True)
            for k in range(self.joints):
                path = add(path, f"J_{k + 1}", "joint")
            add(path, "tool", "workframe")
        return {"revision": self.revision, "nodes": nodes}

    def names(self):
        return {"robots": self.ids, "frames": [node["path"] for node in self.tree()["nodes"]],
                "cameras": ["CAMERA_5", "UMG_Kamera_1"], "sensors": ["USS_0", "USS_1", "USS_2"], "scripts": ["startup.spt"]}

    def execute(self, text):
        """What was wrong with it, or None."""
        word, *rest = text.split() or [""]
        known = {"robot": self.robot_command, "robact": self.robact, "hot_message": self.hot_message, "stdp": self.stdp,
                 "set_mode": self.set_mode, "level_down": self.node, "level_up": self.node, "swap_node": self.node,
                 "activate": self.node, "deactivate": self.node, "stvw": self.stvw,
                 "alarm_ack": self.alarms.acknowledge}.get(word.lower())
        if not known:
            return f"there is no command {word}; commands lists what there is"
        return known(word, rest)

    def robot_command(self, _, rest):
        if len(rest) != 2 or rest[1] not in ("online", "offline"):
            return "ROBOT wants a robot, then online or offline"
        if rest[0] not in self.online:
            return f"there is no robot {rest[0]}; did you mean {self.active}?"
        self.online[rest[0]] = rest[1] == "online"
        return None

    def robact(self, _, rest):
        if not rest or rest[0] not in self.online:
            return f"there is no robot {' '.join(rest)}; did you mean {self.active}?"
        self.active = rest[0]
        return None

    def hot_message(self, _, rest):
        self.messages.append((len(self.messages) + 1, self.now(), " ".join(rest)))
        return None

    def stdp(self, _, rest):
        self.display = int(rest[0])
        self.full_screen = rest[1:] == ["FULL"]
        return None

    def set_mode(self, _, rest):
        if len(rest) != 2 or rest[0] not in self.modes:
            return f"there is no mode {' '.join(rest)}"
        self.modes[rest[0]] = rest[1] == "on"
        return None

    def stvw(self, _, rest):
        view = self.views[int(rest[0])]
        view["viewpoint_m"] = [float(value) / 1000 for value in rest[2:5]]
        view["lookpoint_m"] = [float(value) / 1000 for value in rest[6:9]]
        return None

    def node(self, word, rest):
        found = next((node for node in self.tree()["nodes"] if rest and node["path"] == rest[0]), None)
        if not found:
            return f"there is no frame {' '.join(rest)}"
        if not found["has_detail"]:
            return f"{found['path']} has no component file: nothing to switch"
        (self.hidden.add if word.upper() == "DEACTIVATE" else self.hidden.discard)(found["path"])
        self.revision += 1
        return None


class Client:
    """One WebSocket."""

    def __init__(self, reader, writer, cell, options):
        self.reader, self.writer, self.cell, self.options = reader, writer, cell, options
        self.wish, self.sequence, self.shown, self.may_command = None, 0, 0, False
        self.wants_scene, self.posed, self.poses_sent, self.marks_sent, self.shape_sent = False, 0, 0, "", 0

    def send(self, message):
        self.frame(1, json.dumps(message).encode())

    def frame(self, opcode, data):
        size = bytes([len(data)]) if len(data) < 126 else b"\x7e" + struct.pack(">H", len(data)) if len(data) < 65536 else \
            b"\x7f" + struct.pack(">Q", len(data))
        self.writer.write(bytes([0x80 | opcode]) + size + data)

    def welcome(self):
        self.send({"is": "welcome", "version": "0.1.0", "cell": "stand_in", "instance": "standin", "run": str(self.cell.start),
                   "may_command": self.may_command and not self.options.read_only, "read_only": self.options.read_only})

    async def serve(self):
        """Until the first of its parts ends. A fault of ours ends the connection and is printed: a part that
        ended alone would look like a gateway that sends nothing."""
        self.welcome()
        parts = [asyncio.create_task(part()) for part in (self.listen, self.send_live, self.send_pictures, self.send_scene)]
        done, others = await asyncio.wait(parts, return_when=asyncio.FIRST_COMPLETED)
        for part in others:
            part.cancel()
        await asyncio.gather(*others, return_exceptions=True)
        faults = [part.exception() for part in done if part.exception()]
        for fault in faults:
            if not isinstance(fault, (asyncio.IncompleteReadError, ConnectionError)):
                traceback.print_exception(fault)
                self.frame(8, struct.pack(">H", 1011) + b"the stand-in failed")

    async def listen(self):
        while True:
            opcode, data = await self.receive()
            if opcode == 8:
                return
            if opcode == 1:
                self.follow(json.loads(data))

    async def receive(self):
        first, second = await self.reader.readexactly(2)
        size = second & 0x7F
        if size == 126:
            size, = struct.unpack(">H", await self.reader.readexactly(2))
        elif size == 127:
            size, = struct.unpack(">Q", await self.reader.readexactly(8))
        if size > 16384:
            raise ConnectionError("a message may have 16 KiB")
        mask = await self.reader.readexactly(4)
        data = await self.reader.readexactly(size)
        return first & 0x0F, bytes(byte ^ mask[i % 4] for i, byte in enumerate(data))

    def follow(self, message):
        do = message.get("do")
        if do == "hello":
            self.may_command = message.get("token") == self.options.token
            self.welcome()
        elif do == "picture":
            why = standin_jpeg.why_not(message)
            if why:
                self.send({"is": "refused", "id": 0, "text": why})
            else:
                self.wish = message
        elif do == "no_picture":
            self.wish = None
        elif do in ("scene", "no_scene"):
            self.wants_scene = do == "scene"
            self.shape_sent = 0
        elif do == "posed":
            self.posed = max(self.posed, min(message["sequence"], self.poses_sent))
        elif do == "shown":
            # Pages decode pictures in no particular order. An acknowledgement that comes late takes nothing back: with
            # two newer ones before it, no picture would be under way, and none would ever be sent again.
            if self.shown < message["sequence"] <= self.sequence:
                self.shown = message["sequence"]
        elif do == "command":
            why = self.cell.execute(message["text"]) if self.may_command else "this client may not command"
            self.send({"is": "reply", "id": message["id"], "done": why is None, "text": why or ""})
        elif do == "playback" and self.cell.playback:
            self.cell.playback.follow(message)
        elif do == "pick":
            width = self.wish["width"] if self.wish else 0
            robot = self.cell.ids[0] if self.cell.ids and 0 < width / 2 < message["x"] else ""
            path = f"{robot}.J_1.J_2" if robot else None
            self.send({"is": "picked", "id": message["id"], "path": path, "robot": robot})

    async def send_live(self):
        while True:
            self.send(self.cell.live())
            await self.writer.drain()
            await asyncio.sleep(0.1)

    async def send_pictures(self):
        while True:
            if self.wish and self.sequence - self.shown < 2:
                self.sequence += 1
                jpeg = standin_jpeg.picture(self.cell, self.wish)
                header = struct.pack("<4sIHHIdd", b"CMP1", self.sequence, self.wish["width"], self.wish["height"], 0, 0.012, 0)
                self.frame(2, header + jpeg)
                await self.writer.drain()
            await asyncio.sleep(1 / self.options.pictures_hz)


    async def send_scene(self):
        while True:
            if self.wants_scene and self.poses_sent - self.posed < 2:
                marks = self.cell.scene.marks()
                if marks != self.marks_sent:
                    self.marks_sent = marks
                    self.send(marks)
                self.poses_sent += 1
                self.frame(2, self.cell.scene.poses(self.poses_sent))
                if self.options.tissue:
                    if self.shape_sent != self.cell.scene.tissue_number():
                        self.shape_sent = self.cell.scene.tissue_number()
                        self.frame(2, self.cell.scene.tissue_shape())
                    self.frame(2, self.cell.scene.tissue_motion())
                await self.writer.drain()
            await asyncio.sleep(1 / self.options.poses_hz)


class Server:
    def __init__(self, options):
        self.options = options
        self.cell = Cell(options.robots, options.joints)
        self.cell.problems = options.problem
        self.cell.still = options.still
        self.cell.playback = standin_playback.Playback() if options.replay else None
        self.cell.scene = standin_scene.Scene(self.cell, options.parts, options.triangles, options.tissue, options.volumes)
        self.commands = commands()

    async def answer(self, reader, writer):
        try:
            request = (await reader.readuntil(b"\r\n\r\n")).decode("latin-1").split("\r\n")
            path = request[0].split(" ")[1].split("?")[0]
            headers = {name.lower(): value.strip() for name, _, value in (line.partition(":") for line in request[1:])}
            if path == "/live":
                await self.upgrade(headers, reader, writer)
            else:
                self.file(path, writer)
            await writer.drain()
        except (asyncio.IncompleteReadError, asyncio.LimitOverrunError, ConnectionError, IndexError):
            pass
        finally:
            writer.close()

    async def upgrade(self, headers, reader, writer):
        key = headers["sec-websocket-key"] + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"
        accept = base64.b64encode(hashlib.sha1(key.encode()).digest()).decode()
        offered = "sec-websocket-protocol" in headers  # a browser ends the connection where none of them is selected
        selected = "Sec-WebSocket-Protocol: cellmirror.live\r\n" if offered else ""
        writer.write(f"HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                     f"Sec-WebSocket-Accept: {accept}\r\n{selected}\r\n".encode())
        await Client(reader, writer, self.cell, self.options).serve()

    def file(self, path, writer):
        documents = {"/api/tree": self.cell.tree, "/api/names": self.cell.names, "/api/commands": lambda: self.commands,
                     "/api/status": self.cell.status, "/api/command-log": self.cell.command_log,
                     "/api/alarms": self.cell.alarms.document}
        if path in documents:
            kind, body = "application/json", json.dumps(documents[path]()).encode()
        elif path == "/scene.glb":
            kind, body = f"model/gltf-binary\r\nETag: \"{self.cell.scene.hash:016x}\"", self.cell.scene.file
        else:
            name = "index.html" if path == "/" else path.removeprefix("/page/")
            found = SHARE / LIBRARIES[name] if name in LIBRARIES else (PAGE / name).resolve()
            if not (name in LIBRARIES or found.is_relative_to(PAGE)) or not found.is_file():
                writer.write(b"HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\nConnection: close\r\n\r\n")
                return
            kind, body = mimetypes.guess_type(found.name)[0] or "text/plain", found.read_bytes()
        writer.write(f"HTTP/1.1 200 OK\r\nContent-Type: {kind}\r\nContent-Length: {len(body)}\r\nCache-Control: no-store\r\n"
                     f"Content-Security-Policy: {POLICY}\r\nConnection: close\r\n\r\n".encode() + body)


def commands():
    """The true command table where the program is built, else a few."""
    program = pathlib.Path(os.environ.get("CELLMIRROR_BIN_DIR", ROOT / "build" / "bin")) / "cellmirror"
    try:
        return json.loads(subprocess.run([program, "commands", "--json"], capture_output=True, timeout=10, check=True).stdout)
    except (OSError, subprocess.SubprocessError, ValueError):
        return {"commands": FEW_COMMANDS}


async def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--port", type=int, default=0, help="0: a free one; the address is printed")
    parser.add_argument("--robots", type=int, default=7)
    parser.add_argument("--joints", type=int, default=6)
    parser.add_argument("--token", default="standin")
    parser.add_argument("--parts", type=int, default=0, help="spheres beside the robots, in 3D")
    parser.add_argument("--triangles", type=int, default=0, help="of these spheres together")
    parser.add_argument("--tissue", action="store_true", help="a sheet of tissue, which is cut and heals")
    parser.add_argument("--volumes", type=int, default=0, help="voxel volumes that 3D is told of")
    parser.add_argument("--pictures-hz", type=float, default=15)
    parser.add_argument("--poses-hz", type=float, default=20, help="how often 3D is told where everything is")
    parser.add_argument("--still", action="store_true", help="no joint moves")
    parser.add_argument("--replay", action="store_true", help="a recording is played")
    parser.add_argument("--read-only", action="store_true")
    parser.add_argument("--problem", action="append", default=[], help="text of a problem to report; repeatable")
    server = Server(parser.parse_args())
    listener = await asyncio.start_server(server.answer, "127.0.0.1", server.options.port)
    port = listener.sockets[0].getsockname()[1]
    print(f"http://127.0.0.1:{port}/#token={server.options.token}", flush=True)
    async with listener:
        await listener.serve_forever()


if __name__ == "__main__":
    try:
        asyncio.run(main())
    except KeyboardInterrupt:
        sys.exit(0)

#!/usr/bin/python3
"""How long it takes from a robot's joint sample to the picture that shows it, at the socket of three clients.

  picture_latency_bench.py [SECONDS=20] [SAME]

The demo cell with its simulated controllers, 640x480, 15 pictures a second wished for. The three clients look at three
different views (three drawings a round), or with SAME at one. A picture tells the age of its posture; a sample that came
at any time between two postures is shown by the second picture, so that waiting for it counts. Goal: p95 under 150 ms at
10 pictures a second or more to each client.
"""

import base64
import json
import os
import pathlib
import re
import socket
import struct
import sys
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import gateway as g  # noqa: E402

VIEWS = (0, 3, 5)


class Client(threading.Thread):
    """Looks at a view as the monitor page does (docs/monitor-page.md)."""

    def __init__(self, port, view, seconds):
        super().__init__()
        self.view = view
        self.seconds = seconds
        self.pictures = []  # (arrival, age of the posture at the arrival)
        self.bytes = 0
        self.socket = socket.create_connection(("127.0.0.1", port))
        self.socket.settimeout(10)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(
            (f"GET /live HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
             f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n").encode())
        self.stream = self.socket.makefile("rb")
        assert b"101" in self.stream.readline()
        while self.stream.readline() not in (b"\r\n", b""):
            pass

    def send(self, document):
        data = json.dumps(document).encode()
        mask = os.urandom(4)
        length = bytes([0x80 | len(data)]) if len(data) < 126 else bytes([0x80 | 126]) + struct.pack(">H", len(data))
        self.socket.sendall(b"\x81" + length + mask + bytes(b ^ mask[i % 4] for i, b in enumerate(data)))

    def frame(self):
        first, second = self.stream.read(2)
        length = second & 0x7F
        if length == 126:
            length = struct.unpack(">H", self.stream.read(2))[0]
        elif length == 127:
            length = struct.unpack(">Q", self.stream.read(8))[0]
        return first & 0x0F, self.stream.read(length)

    def run(self):
        self.send({"do": "picture", "view": self.view, "width": 640, "height": 480, "rate_hz": 15, "quality": 80})
        end = time.monotonic() + self.seconds
        while time.monotonic() < end:
            opcode, data = self.frame()
            if opcode != 2:
                continue
            arrival = time.monotonic()
            magic, sequence, _, _, _, age, _ = struct.unpack("<4sIHHIdd", data[:32])
            assert magic == b"CMP1", magic
            self.pictures.append((arrival, age))
            self.bytes += len(data)
            self.send({"do": "shown", "sequence": sequence})


def latencies(pictures):
    """Of samples that come every millisecond: to the first picture whose posture is not older."""
    out = []
    before = None
    for arrival, age in pictures:
        posture = arrival - age
        t = before
        while before is not None and t < posture:
            out.append(arrival - t)
            t += 0.001
        before = posture
    return sorted(out)


def percentile(values, percent):
    return values[min(len(values) - 1, int(len(values) * percent / 100))] * 1e3


def main():
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 20
    same = "SAME" in sys.argv
    scratch = g.Scratch(startup=True)
    simulators = []
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    gateway = g.Process([g.BIN / "cellmirror", "run", scratch.cell_file, "--port", port, "--instance", scratch.instance],
                        scratch.environment)
    try:
        assert g.eventually(lambda: "Ctrl-C ends it" in gateway.output(), 30), gateway.output()
        for line in (scratch.home / "simulators.txt").read_text().splitlines():
            words = re.sub(r"#.*", "", line).split()
            if len(words) > 1 and words[1] == "sim_robot":
                simulators.append(g.sim_robot(*words[2:], "--no-input", "--quiet", environment=scratch.environment))
        time.sleep(3)
        before = scratch.status()
        clients = [Client(port, VIEWS[0] if same else view, seconds) for view in VIEWS]
        for client in clients:
            client.start()
        for client in clients:
            client.join()
        after = scratch.status()
    finally:
        for process in [*simulators, gateway]:
            process.stop()
            process.close()
        scratch.remove()
    everything = []
    for client in clients:
        found = latencies(client.pictures[2:])
        everything += found
        rate = (len(client.pictures) - 1) / (client.pictures[-1][0] - client.pictures[0][0])
        ages = sorted(age for _, age in client.pictures[2:])
        print(f"view {client.view}: {rate:.1f} pictures/s, {client.bytes / max(1, len(client.pictures)) / 1e3:.0f} kB each; "
              f"posture's age at the socket p50 {percentile(ages, 50):.1f} p95 {percentile(ages, 95):.1f} ms; "
              f"sample to picture p50 {percentile(found, 50):.1f} p95 {percentile(found, 95):.1f} ms")
    everything.sort()
    pictures = after["pictures"]
    print(f"all: sample to picture p50 {percentile(everything, 50):.1f} p95 {percentile(everything, 95):.1f} ms (goal: p95 < 150); "
          f"{pictures['renderer']}, drawn in p50 {pictures['draw_ms']['p50']:.1f} ms, encoded in p50 "
          f"{pictures['encode_ms']['p50']:.1f} ms; loop missed {after['loop']['missed'] - before['loop']['missed']}, "
          f"wake-up p99 {after['loop']['wakeup_latency_us']['p99']:.0f} us")


if __name__ == "__main__":
    main()

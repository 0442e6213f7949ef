#!/usr/bin/python3
"""How soon after a robot's arrival the sender of POS_ROB is answered.

  arrival_bench.py [MOVES=200]

A move of no distance ends in the tick that takes it, so that its answer takes the message's way, a tick, and how soon
the owner of the cell notices. DRAW_SCENE, which is answered when the next tick has run, is measured beside it.
"""

import ctypes
import json
import os
import pathlib
import statistics
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import gateway as g  # noqa: E402


class Client:
    def __init__(self, scratch):
        info = json.loads(next(scratch.runtime.glob(f"**/{scratch.instance}/instance.json")).read_text())
        keys = info.get("queues", info)
        self.libc = ctypes.CDLL(None, use_errno=True)
        self.commands = self.libc.msgget(keys["script_key"], 0)
        self.replies = self.libc.msgget(keys["reply_key"], 0)
        self.buffer = ctypes.create_string_buffer(8 + 4096)

    def ask(self, command, tag=77):
        data = f"@{tag} {command}".encode()
        start = time.perf_counter()
        self.libc.msgsnd(self.commands, (5).to_bytes(8, "little") + data, len(data), 0)
        size = self.libc.msgrcv(self.replies, self.buffer, 4096, ctypes.c_long(tag), 0)
        seconds = time.perf_counter() - start
        answer = self.buffer.raw[8:8 + size].decode()
        if not answer.startswith("done"):
            raise SystemExit(f"{command}: {answer} {os.strerror(ctypes.get_errno()) if size < 0 else ''}")
        return seconds


def text(values):
    values = sorted(values)
    return (f"p50 {statistics.median(values) * 1e3:.2f} ms, p99 {values[int(len(values) * 0.99)] * 1e3:.2f} ms, "
            f"max {values[-1] * 1e3:.2f} ms")


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    scratch = g.Scratch()
    gateway = g.Gateway(scratch)
    try:
        client = Client(scratch)
        client.ask("POS_ROB MANTEC_R3 FRAME_ABS 600 300 900 170 0 0")
        for name, command in (("message answered at once", "ROBACT MANTEC_R3"), ("DRAW_SCENE", "DRAW_SCENE"),
                              ("POS_ROB JOINT_INC, no distance", "POS_ROB MANTEC_R3 JOINT_INC 0"),
                              ("POS_ROB FRAME_ABS, no distance", "POS_ROB MANTEC_R3 FRAME_ABS 600 300 900 170 0 0"),
                              ("POS_ROB FRAME_INC, no distance", "POS_ROB MANTEC_R3 FRAME_INC X 0")):
            print(f"{name}: {text([client.ask(command) for _ in range(count)])}")
    finally:
        gateway.stop()
        gateway.close()
        scratch.remove()


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""How long it takes until a recording can be played, and to seek in it.

    tests/bench/record/open_bench.py FILE [PROGRAM]      PROGRAM: build/bin/cellmirror unless given

FILE is played as it is, and cut off before its summary. Log of the times in seconds."""

import json
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[3]


def ask(path, **members):
    with socket.socket(socket.AF_UNIX) as client:
        client.connect(str(path))
        client.sendall(json.dumps(members).encode() + b"\n")
        answer = b""
        while not answer.endswith(b"\n"):
            answer += client.recv(65536)
        return json.loads(answer)


def measure(program, file, folder):
    log, runtime = folder / "log", pathlib.Path(tempfile.mkdtemp(dir=folder))
    begin = time.monotonic()
    with open(log, "w") as out:
        process = subprocess.Popen([program, "replay", file, "--headless", "--paused", "--wait", "--instance", "open"],
                                   env=dict(os.environ, CELLMIRROR_RUNTIME_DIR=str(runtime)), stdout=out, stderr=out)
    while "Ctrl-C ends it" not in log.read_text():
        if process.poll() is not None:
            sys.exit(log.read_text())
        time.sleep(0.005)
    opened = time.monotonic() - begin
    path, seeks = next(runtime.glob("**/open/control.sock")), []
    length = ask(path, request="playback", play=False)["length_s"]
    for share in (0.95, 0.05, 0.5):
        begin = time.monotonic()
        ask(path, request="playback", seek_s=share * length)
        while ask(path, request="playback")["state"] == "seeking":
            time.sleep(0.001)
        seeks.append(time.monotonic() - begin)
    process.terminate()
    process.wait()
    print(f"{file.name}: {1e-6 * file.stat().st_size:.0f} MB, opened in {opened:.2f} s, seeks in " + ", ".join(f"{1e3 * one:.0f}" for one in seeks) + " ms")


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    file, program = pathlib.Path(sys.argv[1]), sys.argv[2] if len(sys.argv) > 2 else ROOT / "build" / "bin" / "cellmirror"
    folder = pathlib.Path(tempfile.mkdtemp(prefix="open-"))
    try:
        cut = folder / "cut.mcap"
        shutil.copyfile(file, cut)
        os.truncate(cut, cut.stat().st_size - min(cut.stat().st_size // 2, 500_000))
        measure(program, file, folder)
        measure(program, cut, folder)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


main()

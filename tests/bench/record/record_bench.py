#!/usr/bin/python3
"""Writing and seeking of recordings beside @mcap/core and bare write(2), in one run: in memory, and on the disk of FOLDER.

    tests/bench/record/record_bench.py [FOLDER]

@mcap/core is that of `./check --peers`; without it its lines are missing."""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
BIN = pathlib.Path(os.environ.get("CELLMIRROR_BIN_DIR", ROOT / "build" / "bin"))
PACKAGES = BIN.parent / "record_peers"


def ours(folder, only):
    environment = dict(os.environ, CELLMIRROR_BENCH_FOLDER=str(folder))
    done = subprocess.run([BIN / "record_bench", "--benchmark_format=json", "--benchmark_min_time=0.5", f"--benchmark_filter={only}"],
                          env=environment, capture_output=True, text=True, check=True)
    for run in json.loads(done.stdout)["benchmarks"]:
        yield run["name"].removesuffix("/real_time"), run


def theirs(folder):
    script = "mcap_core_bench.mjs"
    if not (PACKAGES / "node_modules").is_dir():
        return {}
    shutil.copy(pathlib.Path(__file__).with_name(script), PACKAGES)
    done = subprocess.run(["node", script, folder / "mcap_core_bench.mcap"], cwd=PACKAGES, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def show(place, name, messages, size):
    print(f"{place:7} {name:28} {messages:12,.0f} messages/s {size / 1e6:9,.0f} MB/s")


def main():
    disk = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.gettempdir())
    names = {"small_messages": "100 bytes", "large_messages": "10 KiB"}
    compressions = {"0": "none", "1": "lz4", "2": "zstd"}
    for place, folder, only in (("memory", pathlib.Path("/dev/shm"), "."), ("disk", disk, "bare_write|messages/0")):
        for name, run in ours(folder, only):
            if name.startswith("bare_write"):
                show(place, "bare write(2)", 0, run["bytes_per_second"])
            elif name.startswith("seek"):
                print(f"{place:7} {'seek in 1 GB':28} {run['real_time']:12.2f} ms")
            else:
                kind, compression = name.split("/")
                show(place, f"{names[kind]}, {compressions[compression]}", run["items_per_second"], run["bytes_per_second"])
        for size, found in theirs(folder).items():
            show(place, f"@mcap/core, {size} bytes, none", found["messages_per_s"], found["bytes_per_s"])


if __name__ == "__main__":
    main()

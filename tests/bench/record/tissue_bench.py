#!/usr/bin/python3
"""What the surfaces of deformable objects add to a recording of the trainer cell: bytes of the file, and processor time of the threads.

    tests/bench/record/tissue_bench.py [SECONDS]      build/bin has the programs"""

import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
sys.dont_write_bytecode = True
import gateway as g
import trainer


def processor_seconds(pid, threads):
    out = dict.fromkeys(threads, 0.0)
    for task in pathlib.Path(f"/proc/{pid}/task").iterdir():
        name = (task / "comm").read_text().strip()
        if name in out:
            fields = (task / "stat").read_text().rsplit(")", 1)[1].split()
            out[name] += (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    return out


def run(rate, seconds):
    scratch = g.Scratch("trainer", startup=True)
    trainer.with_own_memories(scratch)
    scratch.cell_file.write_text(scratch.cell_file.read_text().replace("online = true", "online = false"))
    gateway = g.Gateway(scratch)
    try:
        operation = subprocess.Popen([g.BIN / "cellmirror", "send", "--instance", scratch.instance, "EXEC_SCRIPT cholecystectomy.spt"],
                                     env=scratch.environment, stdout=subprocess.DEVNULL)
        file = scratch.root / "a.mcap"
        done = scratch.cellmirror("record", "-o", str(file), "--for", str(seconds), "--attach-mb", "0", "--tissue-rate", str(rate), "--instance",
                                  scratch.instance, timeout=seconds + 60)
        if done.returncode != 0:
            sys.exit(done.stderr)
        used = processor_seconds(gateway.child.pid, ("recorder", "recording", "tissue"))
        operation.wait()
        print(f"{rate:2} Hz: {1e-3 * file.stat().st_size / seconds:.0f} kB/s; processor time of " +
              ", ".join(f"{name} {100 * time / seconds:.1f} %" for name, time in used.items()))
    finally:
        gateway.close()
        scratch.remove()


for tissue_rate in (0, 10, 30):
    run(tissue_rate, int(sys.argv[1]) if len(sys.argv) > 1 else 12)

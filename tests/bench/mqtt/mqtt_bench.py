#!/usr/bin/python3
"""What [mqtt] costs a running gateway: the transfer cell (eight robots), joint states at 10 Hz, summaries, Sparkplug B.
Processor share of the threads "mqtt" and "publisher" and of the whole, and resident memory, without, with a broker, and
with a broker that was killed.   mqtt_bench.py [SECONDS]"""

import os
import pathlib
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tests" / "support"), str(ROOT / "tests" / "integration" / "mqtt")]

import brokers  # noqa: E402
import gateway as g  # noqa: E402

SECONDS = float(sys.argv[1]) if len(sys.argv) > 1 else 60.0
TICK = os.sysconf("SC_CLK_TCK")


def processor_seconds(pid):
    """By the name of the thread; all under ""."""
    out = {"": 0.0}
    for task in pathlib.Path(f"/proc/{pid}/task").iterdir():
        text = (task / "stat").read_text()
        name = text[text.index("(") + 1:text.rindex(")")]
        fields = text[text.rindex(")") + 2:].split()
        used = (int(fields[11]) + int(fields[12])) / TICK
        out[name] = out.get(name, 0.0) + used
        out[""] += used
    return out


def resident_mb(pid):
    return int(pathlib.Path(f"/proc/{pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6


def measure(name, gateway):
    pid = gateway.child.pid
    time.sleep(5)
    before, first = processor_seconds(pid), resident_mb(pid)
    time.sleep(SECONDS)
    after = processor_seconds(pid)
    share = {key: 100 * (after[key] - before.get(key, 0)) / SECONDS for key in ("mqtt", "publisher", "summary", "") if key in after}
    print(f"{name}: " + ", ".join(f"{key or 'all'} {value:.2f} %" for key, value in share.items()) +
          f"; resident {first:.1f} to {resident_mb(pid):.1f} MB", flush=True)


def run(keys, with_broker):
    broker = brokers.Broker()
    scratch = g.Scratch(brokers.CELL)
    if with_broker:
        text = scratch.cell_file.read_text()
        scratch.cell_file.write_text(f'{text}\n[mqtt]\nbroker = "127.0.0.1"\nport = {broker.port}\n{keys}')
    gateway = g.Gateway(scratch)
    try:
        for robot in scratch.status()["robots"]:
            scratch.send(f"ROBOT {robot['id']} send_on")
        measure(keys.replace("\n", " ") if with_broker else "without", gateway)
        if with_broker:
            broker.kill()
            measure("the broker is away", gateway)
    finally:
        gateway.close()
        broker.close()
        scratch.remove()


run("", False)
run("joint_states_hz = 10\n", True)
run('joint_states_hz = 10\nsparkplug = { group = "hall", edge_node = "n1" }\n', True)

"""The drives of a [[device]] commanded by canopen for Python, a master that nobody here wrote.

    /usr/bin/python3 tests/peers/canopen_python.py FOLDER

FOLDER holds the package canopen (https://github.com/canopen-python/canopen); python3-can is Debian's. Starts a gateway of
build/bin on a copy of can_cell. Prints what was done; the exit code is 1 where something failed."""

import logging
import pathlib
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "support"), str(ROOT / "tests" / "integration" / "gateway")]
sys.dont_write_bytecode = True

EDS = str(ROOT / "config" / "devices" / "cellmirror_servo_drive.eds")
COUNT = 20000


def wait(what, condition, timeout=10.0):
    end = time.monotonic() + timeout
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(f"not within {timeout} s: {what}")
        time.sleep(0.01)
    print(f"ok: {what}")


def walk(node):
    """Every state that the package can ask for."""
    for state in ("READY TO SWITCH ON", "SWITCHED ON", "OPERATION ENABLED", "SWITCHED ON", "READY TO SWITCH ON",
                  "SWITCH ON DISABLED", "OPERATION ENABLED", "QUICK STOP ACTIVE"):
        if state == "QUICK STOP ACTIVE":
            node.sdo[0x605A].raw = 6
        node.state = state
        wait(f"state {state}", lambda: node.state == state)
    node.state = "OPERATION ENABLED"
    wait("state OPERATION ENABLED out of the quick stop", lambda: node.state == "OPERATION ENABLED")


def move(node):
    node.op_mode = "PROFILED POSITION"
    wait("mode profile position", lambda: node.op_mode == "PROFILED POSITION")
    node.sdo[0x607A].raw = COUNT
    node.controlword = 0x1F
    wait("the set-point is acknowledged", lambda: node.sdo[0x6041].raw & 0x1000)
    node.controlword = 0x0F
    wait("the target is reached", lambda: node.sdo[0x6041].raw & 0x400 and abs(node.sdo[0x6064].raw - COUNT) < 50)
    node.op_mode = "PROFILED VELOCITY"
    node.sdo[0x60FF].raw = -COUNT
    wait("it turns with the profile velocity", lambda: abs(node.sdo[0x606C].raw + COUNT) < 200)
    node.sdo[0x60FF].raw = 0
    wait("it stands", lambda: abs(node.sdo[0x606C].raw) < 100)
    node.op_mode = "CYCLIC SYNCHRONOUS VELOCITY"
    node.sdo[0x60FF].raw = COUNT
    wait("it turns with the cyclic velocity", lambda: abs(node.sdo[0x606C].raw - COUNT) < 200)
    node.sdo[0x60FF].raw = 0
    node.op_mode = "CYCLIC SYNCHRONOUS POSITION"
    start = node.sdo[0x6064].raw
    node.sdo[0x607A].raw = start + 100
    wait("it follows the cyclic position", lambda: abs(node.sdo[0x6064].raw - start - 100) < 5)


def home(node):
    node.sdo[0x6098].raw = 37
    done = node.homing(timeout=5)
    print(f"ok: homing() says {done}" if done else "failed: homing()")
    if not done:
        raise AssertionError("homing")
    wait("the position is 0", lambda: abs(node.sdo[0x6064].raw) < 5)


def run(canopen, gateway, device_test, drive_master):
    group, port = "239.75.201.17", 43171
    scratch = gateway.Scratch("can_cell")
    text = scratch.cell_file.read_text()
    start, end = text.index("[[stream]]"), text.index("[[stream]]", text.index("[[stream]]") + 1)
    scratch.cell_file.write_text(text[:start] + device_test.device(f"udp:{group}:{port}") + text[end:])
    master = drive_master.Master(group, port)
    process = gateway.Gateway(scratch)
    network = canopen.Network(master.bus)
    try:
        network.connect()
        nodes = [canopen.BaseNode402(number, EDS) for number in device_test.NODES]
        for node in nodes:
            network.add_node(node)
        scratch.send("ROBOT SCARA_1 online;")
        for node in nodes:
            wait(f"boot-up of node {node.id}", lambda node=node: node.nmt.state == "PRE-OPERATIONAL")
        first = nodes[0]
        print("ok: segmented upload:", first.sdo[0x1008].raw)
        with first.sdo.open(0x1008, mode="rb", block_transfer=True) as file:
            assert file.read() == b"cellmirror servo drive"
        print("ok: block upload")
        for node in nodes:
            node.setup_402_state_machine()
            # The package waits for TPDOs that it takes for periodic, and ours come with a change: the states by SDO.
            node.tpdo_pointers.pop(0x6041, None)
            node.tpdo_values.pop(0x6041, None)
            # A bus of python-can on UDP hears its own frames, and the package would take RPDOs that it hears for periodic.
            for pdo in node.rpdo.values():
                if pdo.enabled:
                    network.unsubscribe(pdo.cob_id, pdo.on_message)
        network.nmt.state = "OPERATIONAL"
        network.sync.start(0.01)
        walk(first)
        move(first)
        home(first)
        emergencies = first.emcy.log
        print(f"ok: {len(emergencies)} emergencies")
    finally:
        network.sync.stop()
        network.disconnect()
        process.close()
        scratch.remove()


def main():
    if len(sys.argv) != 2:
        print(__doc__)
        return 2
    sys.path.insert(0, sys.argv[1])
    logging.basicConfig(level=logging.ERROR)
    import canopen
    import device_test
    import drive_master
    import gateway
    run(canopen, gateway, device_test, drive_master)
    print("all done with canopen", getattr(canopen, "__version__", ""))
    return 0


if __name__ == "__main__":
    sys.exit(main())

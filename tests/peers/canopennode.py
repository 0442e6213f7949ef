"""The drives of a [[device]] commanded by CANopenNode, a master that nobody here wrote.

    /usr/bin/python3 tests/peers/canopennode.py FOLDER [INTERFACE]

FOLDER holds canopend and cocomm/cocomm, built from https://github.com/CANopenNode/CANopenLinux. Needs SocketCAN: INTERFACE is
vcan0 unless given. Starts a gateway of build/bin on a copy of can_cell. Prints what was done; the exit code is 1 where something
failed."""

import pathlib
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "support"), str(ROOT / "tests" / "integration" / "gateway")]
sys.dont_write_bytecode = True

COUNT = 20000  # increments
MASTER = 1  # its own node number
VENDOR, PRODUCT, REVISION = "0x1018 1 u32", "0x1018 2 u32", "0x1018 3 u32"


def wait(what, condition, timeout=20.0):
    end = time.monotonic() + timeout
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(f"not within {timeout} s: {what}")
        time.sleep(0.01)
    print(f"ok: {what}", flush=True)


class Commander:
    """canopend, asked by cocomm in the language of CiA 309-3."""

    def __init__(self, folder, interface, scratch):
        self.socket = scratch / "commander"
        self.cocomm = folder / "cocomm" / "cocomm"
        self.daemon = subprocess.Popen([folder / "canopend", interface, "-i", str(MASTER), "-c", f"local-{self.socket}", "-s", f"{scratch}/"],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        wait("canopend answers", self.socket.exists)

    def close(self):
        self.daemon.terminate()
        self.daemon.wait(10)

    def ask(self, command):
        """What came as data, and how the gateway of CiA 309-3 answered."""
        done = subprocess.run([self.cocomm, "-s", self.socket, command], capture_output=True, text=True, timeout=20)
        return done.stdout.strip(), done.stderr.strip()

    def do(self, command):
        data, answer = self.ask(command)
        if "ERROR" in answer or "OK" not in data + answer:
            raise AssertionError(f"{command}: {data} {answer}")

    def read(self, node, what):
        data, answer = self.ask(f"{node} r {what}")
        if not data:
            raise AssertionError(f"{node} r {what}: {answer}")
        return int(data, 0)

    def is_there(self, node):
        return "cellmirror" in self.ask(f"{node} r 0x1008 0 vs")[0]

    def write(self, node, what, value):
        self.do(f"{node} w {what} {value}")


class Drive:
    def __init__(self, commander, node):
        self.commander, self.node = commander, node

    def statusword(self):
        return self.commander.read(self.node, "0x6041 0 u16")

    def position(self):
        return self.commander.read(self.node, "0x6064 0 i32")

    def set(self, what, value):
        self.commander.write(self.node, what, value)

    def control(self, word, mask, expected, what):
        self.set("0x6040 0 u16", word)
        wait(what, lambda: self.statusword() & mask == expected)

    def mode(self, number):
        self.set("0x6060 0 i8", number)
        wait(f"mode {number}", lambda: self.commander.read(self.node, "0x6061 0 i8") == number)


def walk(drive):
    """The transitions of the power state machine, by their numbers in CiA 402."""
    drive.set("0x605A 0 i16", 6)  # the quick stop is kept
    for word, mask, expected, what in (
            (0x06, 0x6F, 0x21, "transition 2: ready to switch on"), (0x00, 0x4F, 0x40, "transition 7: switch on disabled"),
            (0x06, 0x6F, 0x21, "transition 2 again"), (0x07, 0x6F, 0x23, "transition 3: switched on"),
            (0x06, 0x6F, 0x21, "transition 6: ready to switch on"), (0x07, 0x6F, 0x23, "transition 3 again"),
            (0x00, 0x4F, 0x40, "transition 10: switch on disabled"), (0x06, 0x6F, 0x21, "transition 2 again"),
            (0x0F, 0x6F, 0x27, "transitions 3 and 4: operation enabled"), (0x07, 0x6F, 0x23, "transition 5: switched on"),
            (0x0F, 0x6F, 0x27, "transition 4: operation enabled"), (0x06, 0x6F, 0x21, "transition 8: ready to switch on"),
            (0x0F, 0x6F, 0x27, "operation enabled again"), (0x00, 0x4F, 0x40, "transition 9: switch on disabled"),
            (0x06, 0x6F, 0x21, "transition 2 again"), (0x0F, 0x6F, 0x27, "operation enabled again"),
            (0x02, 0x6F, 0x07, "transition 11: quick stop active"), (0x0F, 0x6F, 0x27, "transition 16: operation enabled"),
            (0x02, 0x6F, 0x07, "transition 11 again"), (0x00, 0x4F, 0x40, "transition 12: switch on disabled"),
            (0x06, 0x6F, 0x21, "transition 2 again"), (0x0F, 0x6F, 0x27, "operation enabled again")):
        drive.control(word, mask, expected, what)


def move(drive):
    drive.mode(1)
    start = drive.position()
    drive.set("0x607A 0 i32", start + COUNT)
    drive.control(0x1F, 0x1000, 0x1000, "the set-point is acknowledged")
    drive.control(0x0F, 0x1400, 0x0400, "profile position: the target is reached")
    wait("it is there", lambda: abs(drive.position() - start - COUNT) < 50)
    drive.mode(3)
    drive.set("0x60FF 0 i32", -COUNT)
    wait("profile velocity", lambda: abs(drive.commander.read(drive.node, "0x606C 0 i32") + COUNT) < 200)
    drive.set("0x60FF 0 i32", 0)
    wait("it stands", lambda: abs(drive.commander.read(drive.node, "0x606C 0 i32")) < 100)
    drive.mode(9)
    drive.set("0x60FF 0 i32", COUNT)
    wait("cyclic synchronous velocity", lambda: abs(drive.commander.read(drive.node, "0x606C 0 i32") - COUNT) < 200)
    drive.set("0x60FF 0 i32", 0)
    drive.mode(8)
    start = drive.position()
    drive.set("0x607A 0 i32", start + 100)
    wait("cyclic synchronous position", lambda: abs(drive.position() - start - 100) < 5)
    drive.mode(6)
    drive.set("0x6098 0 i8", 37)
    drive.control(0x1F, 0x3400, 0x1400, "homing attained, method 37")
    wait("the position is 0", lambda: abs(drive.position()) < 5)


def fault(drive):
    """Cyclic synchronous position to a place far beyond the window of the following error."""
    drive.set("0x6040 0 u16", 0x0F)
    drive.mode(8)
    drive.set("0x607A 0 i32", drive.position() + 100 * COUNT)
    wait("transitions 13 and 14: fault", lambda: drive.statusword() & 0x4F == 0x08)
    print(f"ok: error code {drive.commander.read(drive.node, '0x603F 0 u16'):#06x}")
    drive.set("0x6040 0 u16", 0x00)
    drive.control(0x80, 0x4F, 0x40, "transition 15: switch on disabled")


def lss(commander, node, other):
    """The node takes another number, and the old one again."""
    identity = [commander.read(node, what) for what in (VENDOR, PRODUCT, REVISION)] + [commander.read(node, "0x1018 4 u32")]
    commander.do("lss_switch_sel " + " ".join(map(str, identity)))
    data, answer = commander.ask("lss_get_node")
    if not data or int(data, 0) != node:
        raise AssertionError(f"lss_get_node: {data} {answer}")
    print("ok: LSS, switch state selective and inquire the node number")
    commander.do(f"lss_set_node {other}")
    commander.do("lss_switch_glob 0")
    commander.do(f"{node} reset communication")
    wait(f"the node is {other} now", lambda: commander.is_there(other))
    commander.do(f"{other} reset node")
    wait(f"the node is {node} again", lambda: commander.is_there(node))


def run(folder, interface, gateway, device_test):
    scratch = gateway.Scratch("can_cell")
    text = scratch.cell_file.read_text()
    start, end = text.index("[[stream]]"), text.index("[[stream]]", text.index("[[stream]]") + 1)
    scratch.cell_file.write_text(text[:start] + device_test.device(f"socketcan:{interface}") + text[end:])
    process = gateway.Gateway(scratch)
    commander = Commander(folder, interface, scratch.root)
    try:
        scratch.send("ROBOT SCARA_1 online;")
        for node in device_test.NODES:
            wait(f"node {node} answers", lambda node=node: commander.is_there(node))
            commander.do(f"{node} start")
        commander.do("set sdo_block 1")
        wait("block upload", lambda: commander.is_there(node))
        commander.do("set sdo_block 0")
        drive = Drive(commander, next(iter(device_test.NODES)))
        walk(drive)
        move(drive)
        fault(drive)
        lss(commander, 14, 44)
    finally:
        commander.close()
        process.close()
        scratch.remove()


def main():
    if len(sys.argv) not in (2, 3):
        print(__doc__)
        return 2
    import device_test
    import gateway
    run(pathlib.Path(sys.argv[1]).resolve(), sys.argv[2] if len(sys.argv) == 3 else "vcan0", gateway, device_test)
    print("all done with CANopenNode")
    return 0


if __name__ == "__main__":
    sys.exit(main())

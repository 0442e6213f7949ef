"""What every master of CiA 309-3 commands does with the drives of a [[device]]: a gateway on a copy of can_cell on SocketCAN, the
transitions of the power state machine, the modes, a fault and its reset, layer setting services. The scripts here give the master."""

import pathlib
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "support"), str(ROOT / "tests" / "integration" / "gateway")]
sys.dont_write_bytecode = True

import device_test
import gateway

NODES = device_test.NODES
FIRST = next(iter(NODES))
COUNT = 20000  # increments
IDENTITY = [f"0x1018 {part} u32" for part in (1, 2, 3, 4)]
UNNUMBERED = 14  # waits for its number where a cell was asked for that


def wait(what, condition, timeout=20.0):
    end = time.monotonic() + timeout
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(f"not within {timeout} s: {what}")
        time.sleep(0.01)
    print(f"ok: {what}", flush=True)


class Cell:
    """A running gateway whose SCARA_1 answers as drives on the interface."""

    def __init__(self, interface, without_number=False):
        self.scratch = gateway.Scratch("can_cell")
        text = self.scratch.cell_file.read_text()
        start, end = text.index("[[stream]]"), text.index("[[stream]]", text.index("[[stream]]") + 1)
        device = device_test.device(f"socketcan:{interface}")
        if without_number:
            device = device.replace(f"id = {UNNUMBERED}\n", f"id = {UNNUMBERED}\nwait_for_lss = true\n")
        self.scratch.cell_file.write_text(text[:start] + device + text[end:])
        self.gateway = gateway.Gateway(self.scratch)

    def power(self, on):
        self.scratch.send(f"ROBOT SCARA_1 {'online' if on else 'offline'};")

    def close(self):
        self.gateway.close()
        self.scratch.remove()


class Commander:
    """A master that takes the commands of CiA 309-3. ask() is the peer's: what came as data, and how it was answered."""

    def do(self, command):
        data, answer = self.ask(command)
        if "ERROR" in answer or "OK" not in data + answer:
            raise AssertionError(f"{command}: {data} {answer}")

    def number(self, command):
        data, answer = self.ask(command)
        if not data:
            raise AssertionError(f"{command}: {answer}")
        return int(data, 0)

    def read(self, node, what):
        return self.number(f"{node} r {what}")

    def write(self, node, what, value):
        self.do(f"{node} w {what} {value}")

    def is_there(self, node):
        return "cellmirror" in self.ask(f"{node} r 0x1008 0 vs")[0]


class Drive:
    def __init__(self, commander, node):
        self.commander, self.node = commander, node

    def get(self, what):
        return self.commander.read(self.node, what)

    def statusword(self):
        return self.get("0x6041 0 u16")

    def position(self):
        return self.get("0x6064 0 i32")

    def velocity(self):
        return self.get("0x606C 0 i32")

    def set(self, what, value):
        self.commander.write(self.node, what, value)

    def control(self, word, mask, expected, what):
        self.set("0x6040 0 u16", word)
        wait(what, lambda: self.statusword() & mask == expected)

    def mode(self, number):
        self.set("0x6060 0 i8", number)
        wait(f"mode {number}", lambda: self.get("0x6061 0 i8") == number)


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
    for mode, speed, what in ((3, -COUNT, "profile velocity"), (9, COUNT, "cyclic synchronous velocity")):
        drive.mode(mode)
        drive.set("0x60FF 0 i32", speed)
        wait(what, lambda speed=speed: abs(drive.velocity() - speed) < 200)
        stand(drive)
    drive.mode(8)
    start = drive.position()
    drive.set("0x607A 0 i32", start + 100)
    wait("cyclic synchronous position", lambda: abs(drive.position() - start - 100) < 5)
    drive.mode(7)
    drive.set("0x6040 0 u16", 0x1F)
    drive.set("0x60C1 1 i32", start)
    wait("interpolated position", lambda: abs(drive.position() - start) < 5)
    drive.set("0x6040 0 u16", 0x0F)
    for mode, torque, what in ((4, 50, "profile torque"), (10, -50, "cyclic synchronous torque")):
        drive.mode(mode)
        drive.set("0x6071 0 i16", torque)
        wait(what, lambda torque=torque: drive.velocity() * torque > 50 * 1000)
        drive.set("0x6071 0 i16", 0)
        drive.mode(9)
        stand(drive)
    drive.mode(6)
    drive.set("0x6098 0 i8", 37)
    drive.control(0x1F, 0x3400, 0x1400, "homing attained, method 37")
    wait("the position is 0", lambda: abs(drive.position()) < 5)


def stand(drive):
    drive.set("0x60FF 0 i32", 0)
    wait("it stands", lambda: abs(drive.velocity()) < 100)


def fault(drive):
    """Cyclic synchronous position to a place far beyond the window of the following error."""
    drive.set("0x6040 0 u16", 0x0F)
    drive.mode(8)
    drive.set("0x607A 0 i32", drive.position() + 100 * COUNT)
    wait("transitions 13 and 14: fault", lambda: drive.statusword() & 0x4F == 0x08)
    print(f"ok: error code {drive.get('0x603F 0 u16'):#06x}")
    drive.set("0x6040 0 u16", 0x00)
    drive.control(0x80, 0x4F, 0x40, "transition 15: switch on disabled")


def lss(commander, node, other):
    """The node takes another number, and the old one again."""
    commander.do("lss_switch_sel " + " ".join(str(commander.read(node, what)) for what in IDENTITY))
    found = commander.number("lss_get_node")
    if found != node:
        raise AssertionError(f"lss_get_node: {found}")
    print("ok: LSS, switch state selective and inquire the node number")
    commander.do(f"lss_set_node {other}")
    commander.do("lss_switch_glob 0")
    commander.do(f"{node} reset communication")
    wait(f"the node is {other} now", lambda: commander.is_there(other))
    commander.do(f"{other} reset node")
    wait(f"the node is {node} again", lambda: commander.is_there(node))


def take_number(commander, scan):
    """A node without a number is found by `scan`, which chooses it, and gets one."""
    if commander.is_there(UNNUMBERED):
        raise AssertionError(f"node {UNNUMBERED} has a number")
    found = [int(part, 0) for part in scan()]
    if found != [0, 0, 0, UNNUMBERED]:
        raise AssertionError(f"fastscan: {found}")
    print("ok: LSS fastscan found the node without a number")
    commander.do(f"lss_set_node {UNNUMBERED}")
    commander.do("lss_switch_glob 0")
    wait("it has got its number", lambda: commander.is_there(UNNUMBERED))

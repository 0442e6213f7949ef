#!/usr/bin/env python3
"""A CANopen master for six CiA 402 drives: it boots them, homes them, moves them in cyclic synchronous position, and recovers
where they stop.

    /usr/bin/python3 canopen_master.py [--channel udp:GROUP:PORT | socketcan:INTERFACE] [--for SECONDS] [--rounds N]

Made for config/cells/hil_cell and its drives (config/devices/cellmirror_servo_drive.eds); needs Debian's python3-can alone.
`--rounds 1` goes against the post once, recovers, and ends. The exit status is 1 where a drive does not do what it should."""

import argparse
import math
import os
import signal
import socket
import struct
import sys
import time

import can

NMT, SYNC, EMCY, TPDO2, RPDO2, SDO_ANSWER, SDO_REQUEST, HEARTBEAT = 0x000, 0x080, 0x080, 0x280, 0x300, 0x580, 0x600, 0x700
NODES = range(1, 7)
HOME_RAD = 0.1              # where the lower edge of each home switch is; the zero of a joint lies so much below
PERIOD_S = 0.01             # of SYNC
READY = (0.0, 0.1, 0.2, 0.0, -0.3, 0.0)
BEHIND_THE_POST = (1.6, 0.1, 0.2, 0.0, -0.3, 0.0)
PATIENCE_S = 30.0           # with a busy machine


class Failed(Exception):
    pass


class Stopped(Exception):
    """A drive has a fault."""

    def __init__(self, node, code):
        super().__init__(f"node {node} has the fault {code:#06x}")
        self.node = node


def open_bus(channel):
    kind, _, rest = channel.partition(":")
    if kind == "socketcan":
        return can.Bus(interface="socketcan", channel=rest)
    group, port = rest.rsplit(":", 1)
    # python-can 4.1 joins the group on the interface of INADDR_ANY. The gateway is on the loopback interface.
    any_address, socket.INADDR_ANY = socket.INADDR_ANY, struct.unpack("@I", socket.inet_aton("127.0.0.1"))[0]
    try:
        bus = can.Bus(interface="udp_multicast", channel=group, port=int(port), fd=True)
    finally:
        socket.INADDR_ANY = any_address
    with socket.socket(fileno=os.dup(bus.fileno())) as sender:
        sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))
    return bus


class Master:
    def __init__(self, bus):
        self.bus = bus
        self.emergencies = {}  # node: error code of its last EMCY
        self.booted = set()
        self.resolution = {}  # node: increments of the encoder for one radian of the joint

    def send(self, identifier, data=b""):
        self.bus.send(can.Message(arbitration_id=identifier, data=data, is_extended_id=False))

    def receive(self, until):
        """The next frame as (identifier, data) before that time; None behind it."""
        while (left := until - time.monotonic()) > 0:
            message = self.bus.recv(left)
            if message is None or message.is_extended_id or message.is_error_frame:
                continue
            identifier, data = message.arbitration_id, bytes(message.data)
            if EMCY < identifier <= EMCY + 127 and len(data) == 8:
                code, = struct.unpack_from("<H", data)
                self.emergencies[identifier - EMCY] = code  # 0: the error is reset
            if HEARTBEAT < identifier <= HEARTBEAT + 127 and data == b"\0":
                self.booted.add(identifier - HEARTBEAT)
            return identifier, data
        return None

    # --- SDO: expedited transfers are all that these objects need ------------------------------------------------------
    def transfer(self, node, request):
        self.send(SDO_REQUEST + node, request)
        end = time.monotonic() + PATIENCE_S
        while frame := self.receive(end):
            identifier, data = frame
            if identifier == SDO_ANSWER + node and data[1:4] == request[1:4]:
                if data[0] == 0x80:
                    raise Failed(f"node {node} refuses {data[2]:02x}{data[1]:02x}:{data[3]}: {struct.unpack_from('<I', data, 4)[0]:#010x}")
                return data
        raise Failed(f"node {node} does not answer")

    def read(self, node, index, subindex=0, signed=False):
        data = self.transfer(node, struct.pack("<BHBxxxx", 0x40, index, subindex))
        return int.from_bytes(data[4:8 - (data[0] >> 2 & 3)], "little", signed=signed)

    def write(self, node, index, value, size, subindex=0):
        data = (value & (1 << 8 * size) - 1).to_bytes(size, "little").ljust(4, b"\0")
        self.transfer(node, struct.pack("<BHB", 0x23 | (4 - size) << 2, index, subindex) + data)

    def wait(self, node, what, mask, value, timeout=PATIENCE_S):
        """For these bits of the statusword."""
        end = time.monotonic() + timeout
        while (word := self.read(node, 0x6041)) & mask != value:
            if word & 0x08 and not mask & 0x08:
                raise Stopped(node, self.read(node, 0x603F))
            if time.monotonic() > end:
                raise Failed(f"node {node}: {what} did not come: statusword {word:#06x}")
            time.sleep(0.005)

    # --- what an installation does -------------------------------------------------------------------------------------
    def boot(self):
        """NMT reset communication, boot-up messages, and what the drives say of themselves."""
        end = time.monotonic() + PATIENCE_S
        while not self.booted >= set(NODES):  # again, where the gateway comes later
            self.send(NMT, bytes([130, 0]))
            again = time.monotonic() + 1.0
            while not self.booted >= set(NODES) and self.receive(again):
                pass
            if time.monotonic() > end:
                raise Failed(f"no boot-up message of nodes {sorted(set(NODES) - self.booted)}: does the gateway run on this channel?")
        for node in NODES:
            if self.read(node, 0x1000) & 0xFFFF != 402:
                raise Failed(f"node {node} is no CiA 402 drive")
            increments, encoder_turns = self.read(node, 0x608F, 1), self.read(node, 0x608F, 2)
            motor, shaft = self.read(node, 0x6091, 1), self.read(node, 0x6091, 2)
            self.resolution[node] = increments / encoder_turns * motor / shaft / (2 * math.pi)
        self.send(NMT, bytes([1, 0]))

    def enable(self, node, mode):
        self.write(node, 0x6060, mode, 1)
        for word, mask, value in ((0x06, 0x6F, 0x21), (0x07, 0x6F, 0x23), (0x0F, 0x6F, 0x27)):
            self.write(node, 0x6040, word, 2)
            self.wait(node, f"the state after controlword {word:#04x}", mask, value)

    def home(self):
        """Method 19: upwards until the home switch is on, back to its edge. All drives at once."""
        for node in NODES:
            self.write(node, 0x607C, -round(HOME_RAD * self.resolution[node]), 4)
            self.write(node, 0x6098, 19, 1)
            self.write(node, 0x6099, round(0.3 * self.resolution[node]), 4, 1)
            self.write(node, 0x6099, round(0.05 * self.resolution[node]), 4, 2)
            self.enable(node, 6)
            self.write(node, 0x6040, 0x1F, 2)
        for node in NODES:
            self.wait(node, "homing attained", 0x3400, 0x1400)
            self.write(node, 0x6040, 0x0F, 2)

    def prepare_cyclic(self):
        for node in NODES:
            self.write(node, 0x60C2, round(1000 * PERIOD_S), 1, 1)  # interpolation period: so many 10^-3 s
            self.write(node, 0x60C2, -3, 1, 2)
            self.enable(node, 8)

    def positions(self):
        return [self.read(node, 0x6064, signed=True) / self.resolution[node] for node in NODES]

    def cycle(self, targets):
        """Targets of all drives, SYNC, and what each answers."""
        for node, target in zip(NODES, targets):
            self.send(RPDO2 + node, struct.pack("<Hi", 0x0F, round(target * self.resolution[node])))
        self.send(SYNC)
        missing, end = set(NODES), time.monotonic() + PATIENCE_S
        while missing:
            frame = self.receive(end)
            if frame is None:
                raise Failed(f"nodes {sorted(missing)} do not answer SYNC")
            identifier, data = frame
            node = identifier - TPDO2
            if node in missing and len(data) >= 2:
                missing.discard(node)
                if struct.unpack_from("<H", data)[0] & 0x08:
                    raise Stopped(node, self.emergencies.get(node) or self.read(node, 0x603F))

    def move(self, to, duration_s):
        """From where the drives are, with a smooth start and end."""
        start, begin, due = self.positions(), time.monotonic(), time.monotonic()
        while (share := min(1.0, (time.monotonic() - begin) / duration_s)) < 1.0:
            smooth = share * share * (3.0 - 2.0 * share)
            self.cycle([a + smooth * (b - a) for a, b in zip(start, to)])
            # Not two at once behind a pause of this machine: a drive interpolates over one period.
            due = max(due + PERIOD_S, time.monotonic())
            time.sleep(max(0.0, due - time.monotonic()))
        for _ in range(3):
            self.cycle(to)
            time.sleep(PERIOD_S)

    def stop_all(self):
        """Quick stop: the others do not push on."""
        for node in NODES:
            self.write(node, 0x6040, 0x02, 2)

    def recover(self):
        """Fault reset where there is one, and all drives again in cyclic synchronous position, where they are."""
        for node in NODES:
            if self.read(node, 0x6041) & 0x08:
                self.write(node, 0x6040, 0x00, 2)
                self.write(node, 0x6040, 0x80, 2)
                self.wait(node, "the end of the fault", 0x08, 0)
            self.write(node, 0x6040, 0x00, 2)
            self.wait(node, "switch on disabled", 0x4F, 0x40)
        self.prepare_cyclic()

    def switch_off(self):
        for node in NODES:
            self.write(node, 0x6040, 0x00, 2)
        self.send(NMT, bytes([128, 0]))


def go_against_the_post(master):
    """Whether a drive has stopped."""
    master.move(READY, 1.0)
    say("moves towards the post")
    try:
        master.move(BEHIND_THE_POST, 2.5)
    except Stopped as stopped:
        master.stop_all()
        say(f"stopped: {stopped}, at {master.positions()[stopped.node - 1]:.2f} rad")
        return True
    say("went through: no drive has a fault; the status of the gateway has the collision")
    return False


def run(master, end, rounds):
    master.boot()
    say(f"{len(NODES)} drives are booted, {master.resolution[1]:.0f} increments a radian of joint 1")
    master.home()
    say("homed: " + " ".join(f"{position:+.2f}" for position in master.positions()) + " rad")
    master.prepare_cyclic()
    done = 0
    while time.monotonic() < end and done < rounds:
        if go_against_the_post(master):
            master.recover()
            say("reset")
        master.move(READY, 2.5)
        done += 1
        say(f"recovered: joint 1 is at {master.positions()[0]:+.2f} rad")
    master.switch_off()


def say(text):
    print(text, flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--channel", default="udp:239.74.163.21:43121")
    parser.add_argument("--for", dest="seconds", type=float, default=math.inf)
    parser.add_argument("--rounds", type=float, default=math.inf)
    options = parser.parse_args()
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    bus = open_bus(options.channel)
    try:
        run(Master(bus), time.monotonic() + options.seconds, options.rounds)
    except KeyboardInterrupt:
        pass
    except (Failed, Stopped) as failure:
        print(f"canopen_master.py: {failure}", file=sys.stderr)
        return 1
    finally:
        bus.shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""A CiA 402 master by hand over python-can's udp_multicast bus: NMT, expedited SDO, SYNC, the power state machine."""

import os
import socket
import struct
import time

import can

NMT, SYNC, SDO_ANSWER, SDO_REQUEST, HEARTBEAT = 0, 0x80, 0x580, 0x600, 0x700
STATES = {0x40: "switch on disabled", 0x21: "ready", 0x23: "switched on", 0x27: "enabled", 0x07: "quick stop", 0x08: "fault"}


class Abort(Exception):
    pass


class Master:
    def __init__(self, group, port):
        # python-can joins on the interface with this address: loopback instead of whatever the default route names.
        any_address, socket.INADDR_ANY = socket.INADDR_ANY, struct.unpack("@I", socket.inet_aton("127.0.0.1"))[0]
        try:
            self.bus = can.Bus(interface="udp_multicast", channel=group, port=port, fd=True)
        finally:
            socket.INADDR_ANY = any_address
        sender = socket.socket(fileno=os.dup(self.bus.fileno()))
        sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))
        sender.close()

    def close(self):
        self.bus.shutdown()

    def send(self, identifier, data=b""):
        self.bus.send(can.Message(arbitration_id=identifier, data=data, is_extended_id=False))

    def hear(self, wanted, timeout=60.0):
        """The data of the next message for which wanted(identifier, data) holds; None after the timeout."""
        end = time.monotonic() + timeout
        while time.monotonic() < end:
            message = self.bus.recv(0.05)
            if message is not None and wanted(message.arbitration_id, bytes(message.data)):
                return bytes(message.data)
        return None

    def hear_all(self, identifiers, timeout=60.0):
        """One message of each identifier, in whatever order: {identifier: data}."""
        found = {}

        def note(identifier, data):
            if identifier in identifiers:
                found.setdefault(identifier, data)
            return len(found) == len(identifiers)

        self.hear(note, timeout)
        return found

    def nmt(self, command, node=0):
        self.send(NMT, bytes([command, node]))

    def _transfer(self, node, request):
        self.send(SDO_REQUEST + node, request)
        answer = self.hear(lambda identifier, data: identifier == SDO_ANSWER + node and data[1:4] == request[1:4])
        if answer is None:
            raise TimeoutError(f"node {node} does not answer")
        if answer[0] == 0x80:
            raise Abort(f"{struct.unpack_from('<I', answer, 4)[0]:#010x}")
        return answer

    def read(self, node, index, subindex=0, signed=False):
        answer = self._transfer(node, struct.pack("<BHBxxxx", 0x40, index, subindex))
        return int.from_bytes(answer[4:8 - (answer[0] >> 2 & 3)], "little", signed=signed)

    def write(self, node, index, value, size, subindex=0):
        data = (value & (1 << 8 * size) - 1).to_bytes(size, "little").ljust(4, b"\0")
        self._transfer(node, struct.pack("<BHB", 0x23 | (4 - size) << 2, index, subindex) + data)

    def state(self, node):
        word = self.read(node, 0x6041)
        return STATES.get(word & (0x4F if word & 0x48 else 0x6F), hex(word))

    def enable(self, node):
        for word in (0x06, 0x07, 0x0F):
            self.write(node, 0x6040, word, 2)
        return self.state(node)

    def wait_bit(self, node, bit, timeout=60.0):
        end = time.monotonic() + timeout
        while time.monotonic() < end:
            if self.read(node, 0x6041) >> bit & 1:
                return True
            time.sleep(0.01)
        return False

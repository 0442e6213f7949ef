"""Bytes of strangers for tests: RTPS datagrams and an MQTT broker, well-formed and malformed. Standard library only."""

import random
import socket
import struct
import threading

# DATA_FRAG with an empty inline QoS: Fast DDS 2.9.1 frees what it did not allocate.
DATA_FRAG = bytes.fromhex("525450530201010f010faabb010faabb010faabb1603240000001c00000100c7000100c2000000000100000001000000010010001000000001000000")
GROUP = "239.255.0.1"  # RTPS 2.3, 9.6.1.4


def ports(domain):
    """Where participants of a domain listen for discovery and for data: the group's, and those of the first participants."""
    base = 7400 + 250 * domain
    return [base, base + 1] + [base + 10 + i for i in range(16)]


def parameter(identifier, value, length=None):
    """`length`: as it is announced; by default the true one."""
    value += bytes(-len(value) % 4)
    return struct.pack("<HH", identifier, len(value) if length is None else length) + value


def announcement(chance, false_length=False, unknown=None):
    """An announcement of a participant, DATA(p). `false_length`: one of its parameters says another length than it has."""
    prefix = bytes([0x01, 0x0F]) + chance.randbytes(10)
    locator = struct.pack("<iI", 1, 17410) + bytes(12) + bytes([127, 0, 0, 1])
    parameters = [
        (0x0015, struct.pack("<BBxx", 2, 1)),  # protocol version
        (0x0016, bytes([0x01, 0x0F, 0, 0])),   # vendor
        (0x0050, prefix + bytes([0, 0, 1, 0xC1])),
        (0x0032, locator), (0x0031, locator), (0x0048, locator),
        (0x0002, struct.pack("<iI", 20, 0)),   # lease
        (0x0058, struct.pack("<I", 0x0C3F)),   # endpoints
        (0x0062, struct.pack("<I", 12) + b"participant\0"),
    ]
    if unknown is not None:
        parameters.insert(chance.randrange(len(parameters)), (unknown, chance.randbytes(chance.randrange(0, 64))))
    wrong = chance.randrange(len(parameters)) if false_length else -1
    body = b"".join(parameter(number, value, chance.choice((0, 1, 3, 0x7FFF, 0xFFF0, 0xFFFF, chance.randrange(65536))) if i == wrong else None)
                    for i, (number, value) in enumerate(parameters))
    body += struct.pack("<HH", 1, 0)  # sentinel
    payload = bytes([0, 3, 0, 0]) + body
    data = struct.pack("<HH", 0, 16) + bytes([0, 1, 0, 0xC7, 0, 1, 0, 0xC2]) + struct.pack("<iI", 0, chance.randrange(1, 9)) + payload
    return b"RTPS" + bytes([2, 1, 1, 0x0F]) + prefix + struct.pack("<BBH", 0x15, 0x05, len(data)) + data


def mutated(chance, packet):
    """Some of its bytes are others, or missing, or there twice."""
    out = bytearray(packet)
    for _ in range(chance.randrange(1, 6)):
        kind, at = chance.randrange(4), chance.randrange(len(out)) if out else 0
        if not out:
            break
        if kind == 0:
            out[at] = chance.choice((0, 1, 0x7F, 0x80, 0xFF, chance.randrange(256)))
        elif kind == 1:
            del out[at:at + chance.randrange(1, 9)]
        elif kind == 2:
            out[at:at] = out[at:at + chance.randrange(1, 33)]
        else:
            out[at:at + 4] = struct.pack("<I", chance.choice((0, 1, 0x7FFFFFFF, 0xFFFFFFFF, chance.randrange(1 << 32))))
    return bytes(out[:60_000])


class Datagrams:
    """Sends to the participants of a domain on the loopback interface."""

    def __init__(self, domain):
        self.ports = ports(domain)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))

    def send(self, packet, everywhere=True):
        for port in self.ports if everywhere else self.ports[:1]:
            for host in ("127.0.0.1", GROUP):
                try:
                    self.socket.sendto(packet, (host, port))
                except OSError:  # nobody listens there, or no multicast
                    pass

    def close(self):
        self.socket.close()


def _variable(number):
    out = bytearray()
    while True:
        out.append(number % 128 | (128 if number > 127 else 0))
        number //= 128
        if not number:
            return bytes(out)


def mqtt_packet(kind, body, announced=None):
    return bytes([kind]) + _variable(len(body) if announced is None else announced) + body


UNKNOWN_PROPERTY = bytes([5, 0x7E, 1, 2, 3, 4])
CONNACK = mqtt_packet(0x20, bytes([0, 0, 0]))
# What a faulty broker sends after CONNACK (MQTT 5); libmosquitto 2.0.11 ends the process over the first four.
BROKER_FAULTS = {
    "PUBLISH": mqtt_packet(0x30, bytes([0, 1]) + b"t" + UNKNOWN_PROPERTY + b"x"),
    "SUBACK": mqtt_packet(0x90, bytes([0, 1]) + UNKNOWN_PROPERTY + bytes([0])),
    "PUBACK": mqtt_packet(0x40, bytes([0, 1, 0]) + UNKNOWN_PROPERTY),
    "DISCONNECT": mqtt_packet(0xE0, bytes([0]) + UNKNOWN_PROPERTY),
    "256 MB": mqtt_packet(0x30, b"", announced=268_435_455) + bytes(64),
}


class FakeBroker:
    """Accepts connections, answers CONNECT, then sends the fault that is set; none: it answers what a broker has to."""

    def __init__(self, port=0):
        self.fault = None  # bytes, or a function that gives them
        self.connections = 0
        self.listener = socket.create_server(("127.0.0.1", port))
        self.port = self.listener.getsockname()[1]
        self.sockets = []
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self):
        while True:
            try:
                client, _ = self.listener.accept()
            except OSError:
                return
            self.sockets.append(client)
            threading.Thread(target=self._serve, args=(client,), daemon=True).start()

    def _serve(self, client):
        try:
            first = client.recv(4096)
            if not first or first[0] >> 4 != 1:
                return  # nothing but a look whether somebody listens
            self.connections += 1
            client.sendall(CONNACK)
            fault = self.fault() if callable(self.fault) else self.fault
            if fault:
                client.sendall(fault)
            while True:
                packet = client.recv(65536)
                if not packet:
                    return
                if packet[0] >> 4 == 12:
                    client.sendall(bytes([0xD0, 0]))
        except OSError:
            pass
        finally:
            client.close()

    def drop(self):
        for client in self.sockets:
            try:
                client.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass
        self.sockets.clear()

    def close(self):
        self.listener.close()
        self.drop()


def seeded(seed):
    return random.Random(seed)

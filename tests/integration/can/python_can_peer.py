#!/usr/bin/python3
"""A peer made of Debian's python3-can on the udp_multicast bus of the loopback interface.

python_can_peer.py GROUP PORT receive N   prints N frames, one a line
python_can_peer.py GROUP PORT send        sends one frame of each kind
python_can_peer.py GROUP PORT node ID     a CANopen node: boot-up, waits for NMT start, then heartbeat and TPDO1 with the
                                          position 1000, 1001, ...
Exit status 77: python3-can is missing.
"""
import os
import socket
import struct
import sys
import time

try:
    import can
except ImportError:
    print("skipped: no python3-can", file=sys.stderr)
    sys.exit(77)


def open_bus(group, port):
    # python-can joins on the interface with this address: loopback instead of whatever the default route names.
    loopback = socket.inet_aton("127.0.0.1")
    socket.INADDR_ANY = struct.unpack("@I", loopback)[0]
    bus = can.Bus(interface="udp_multicast", channel=group, port=port, fd=True)
    sock = socket.socket(fileno=os.dup(bus.fileno()))
    sock.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, loopback)
    return bus


def describe(message):
    return "%x ext=%d rtr=%d fd=%d brs=%d dlc=%d %s" % (
        message.arbitration_id, message.is_extended_id, message.is_remote_frame, message.is_fd,
        message.bitrate_switch, message.dlc, bytes(message.data).hex())


def receive(bus, count):
    print("ready", flush=True)
    while count > 0:
        message = bus.recv(60)
        if message is None:
            sys.exit("nothing came for a minute")
        print(describe(message), flush=True)
        count -= 1


def send(bus):
    for message in (
            can.Message(arbitration_id=0x181, is_extended_id=False, data=[1, 2, 3, 4]),
            can.Message(arbitration_id=0x1ABCDEF0, is_extended_id=True, data=[8] * 8),
            can.Message(arbitration_id=0x123, is_extended_id=False, is_remote_frame=True, dlc=4),
            can.Message(arbitration_id=0x7FF, is_extended_id=False, is_fd=True, bitrate_switch=True, data=[0x5A] * 64)):
        bus.send(message)


def node(bus, node_id):
    def put(cob_id, data):
        bus.send(can.Message(arbitration_id=cob_id, is_extended_id=False, data=data))

    put(0x700 + node_id, [0])
    deadline = time.monotonic() + 60
    while True:
        message = bus.recv(0.2)
        if time.monotonic() > deadline:
            sys.exit("no NMT start")
        # The bus hears itself: only the master sends on identifier 0.
        if message and message.arbitration_id == 0 and bytes(message.data) == bytes([1, node_id]):
            break
    print("started", flush=True)
    position = 1000
    while time.monotonic() < deadline:
        put(0x700 + node_id, [5])
        put(0x180 + node_id, list(struct.pack("<Hi", 0x0237, position)))
        position += 1
        time.sleep(0.01)


def main():
    group, port, mode = sys.argv[1], int(sys.argv[2]), sys.argv[3]
    bus = open_bus(group, port)
    try:
        if mode == "receive":
            receive(bus, int(sys.argv[4]))
        elif mode == "send":
            send(bus)
        else:
            node(bus, int(sys.argv[4]))
    finally:
        bus.shutdown()


main()

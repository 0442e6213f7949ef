"""A client of the monitor page in the standard library alone: requests, and the WebSocket /live (RFC 6455)."""

import base64
import http.client
import json
import os
import socket
import struct
import time


class Page:
    """Where a gateway's page is; `cellmirror page --json` says so."""

    def __init__(self, document):
        self.address = document["address"]
        self.token = document["token"]
        self.host, port = self.address.removeprefix("http://").rstrip("/").rsplit(":", 1)
        self.port = int(port)

    def ask(self, path, method="GET", body=None, headers=()):
        """(status, headers, body)"""
        connection = http.client.HTTPConnection(self.host, self.port, timeout=60)
        try:
            connection.request(method, path, body, dict(headers))
            answer = connection.getresponse()
            return answer.status, dict(answer.getheaders()), answer.read()
        finally:
            connection.close()

    def json(self, path):
        status, _, body = self.ask(path)
        assert status == 200, (path, status, body)
        return json.loads(body)

    def command(self, text, token=None):
        """Waits for its turn where too many commands came."""
        for _ in range(1000):
            status, _, body = self.ask("/api/command", "POST", text, {"Authorization": f"Bearer {token or self.token}"})
            if status != 429:
                break
            time.sleep(0.05)
        return status, body.decode()


class Live:
    """The WebSocket: say() and hear()."""

    def __init__(self, page, receive_buffer=None, path="/live", headers=()):
        self.socket = socket.socket()
        if receive_buffer:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
        self.socket.settimeout(60)
        self.socket.connect((page.host, page.port))
        key = base64.b64encode(os.urandom(16)).decode()
        more = "".join(f"{name}: {value}\r\n" for name, value in headers)
        self.socket.sendall((f"GET {path} HTTP/1.1\r\nHost: {page.host}:{page.port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                             f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n{more}\r\n").encode())
        self.bytes = b""
        while b"\r\n\r\n" not in self.bytes:
            self.bytes += self.socket.recv(4096)
        head, self.bytes = self.bytes.split(b"\r\n\r\n", 1)
        assert head.startswith(b"HTTP/1.1 101"), head
        self.head = head.decode()

    def close(self):
        self.socket.close()

    def _send(self, opcode, payload):
        mask = os.urandom(4)
        length = bytes([0x80 | len(payload)]) if len(payload) < 126 else bytes([0xFE]) + struct.pack(">H", len(payload))
        self.socket.sendall(bytes([0x80 | opcode]) + length + mask + bytes(b ^ mask[i % 4] for i, b in enumerate(payload)))

    def say_bytes(self, payload):
        self._send(2, payload)

    def say(self, **message):
        self._send(1, json.dumps(message).encode())

    def _take(self, count):
        while len(self.bytes) < count:
            more = self.socket.recv(1 << 18)
            if not more:
                raise ConnectionError("the server has ended the connection")
            self.bytes += more
        out, self.bytes = self.bytes[:count], self.bytes[count:]
        return out

    def hear(self):
        """The next message: a dictionary, or the bytes of a picture."""
        while True:
            first, second = self._take(2)
            length = second & 0x7F
            if length == 126:
                length = struct.unpack(">H", self._take(2))[0]
            elif length == 127:
                length = struct.unpack(">Q", self._take(8))[0]
            payload = self._take(length)
            opcode = first & 0x0F
            if opcode == 9:
                self._send(10, payload)
            elif opcode == 8:
                raise ConnectionError("the server says goodbye")
            elif opcode == 2:
                return payload
            elif opcode == 1:
                return json.loads(payload)

    def until(self, wanted, timeout=60):
        """The first message for which wanted() is true."""
        end = time.monotonic() + timeout
        while time.monotonic() < end:
            message = self.hear()
            if wanted(message):
                return message
        raise AssertionError("what was waited for did not come")

    def until_is(self, kind, **members):
        return self.until(lambda m: isinstance(m, dict) and m["is"] == kind and
                          all(m.get(key) == value for key, value in members.items()))


def picture_number(message):
    """The sequence of a picture; None for other messages."""
    return struct.unpack("<I", message[4:8])[0] if isinstance(message, bytes) and message[:4] == b"CMP1" else None

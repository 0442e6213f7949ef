"""A client of the Foxglove WebSocket protocol in the standard library alone, and a decoder of the ROS 2 messages that tests look at."""

import struct

from page_client import Live


class Cdr:
    """Little-endian CDR behind its four bytes of encapsulation; numbers are aligned to their size."""

    def __init__(self, data):
        assert data[:4] == b"\x00\x01\x00\x00", data[:4]
        self.data, self.at = data[4:], 0

    def number(self, kind):
        size = struct.calcsize("<" + kind)
        self.at += -self.at % size
        value, = struct.unpack_from("<" + kind, self.data, self.at)
        self.at += size
        return value

    def text(self):
        size = self.number("I")
        self.at += size
        return self.data[self.at - size:self.at - 1].decode()

    def many(self, read):
        return [read() for _ in range(self.number("I"))]

    def stamp(self):
        return self.number("i") + 1e-9 * self.number("I")


def joint_state(data):
    cdr = Cdr(data)
    stamp, _ = cdr.stamp(), cdr.text()
    names, positions = cdr.many(cdr.text), cdr.many(lambda: cdr.number("d"))
    return stamp, dict(zip(names, positions))


def frames(data):
    """{child: (parent, translation)} of a TFMessage."""
    cdr, out = Cdr(data), {}
    for _ in range(cdr.number("I")):
        cdr.stamp()
        parent, child = cdr.text(), cdr.text()
        values = [cdr.number("d") for _ in range(7)]
        out[child] = (parent, values[:3])
    return out


class Foxglove(Live):
    """hear() gives texts as dictionaries and binary messages as bytes."""

    DATA, TIME, RESPONSE, ASSET = 1, 2, 3, 4

    def __init__(self, page, protocol="foxglove.websocket.v1", path="/", headers=(), receive_buffer=None):
        super().__init__(page, receive_buffer, path, [("Sec-WebSocket-Protocol", protocol), *headers])
        self.channels = {}
        self.calls = 0

    def hear(self):
        message = super().hear()
        if isinstance(message, dict) and message["op"] == "advertise":
            self.channels.update((channel["topic"], channel) for channel in message["channels"])
        return message

    def until_op(self, op, **members):
        return self.until(lambda m: isinstance(m, dict) and m["op"] == op and all(m.get(key) == value for key, value in members.items()))

    def until_binary(self, opcode, number=None):
        """A binary message whose first number is that one, without both."""
        return self.until(lambda m: isinstance(m, bytes) and m[0] == opcode and
                          (number is None or struct.unpack_from("<I", m, 1)[0] == number))

    def subscribe(self, topic, number):
        self.until(lambda _: topic in self.channels) if topic not in self.channels else None
        self.say(op="subscribe", subscriptions=[{"id": number, "channelId": self.channels[topic]["id"]}])

    def data(self, number):
        """(time in ns, message) of the next one of a subscription."""
        message = self.until_binary(self.DATA, number)
        return struct.unpack_from("<Q", message, 5)[0], message[13:]

    def asset(self, uri):
        """(content, error), one of them empty."""
        self.calls += 1
        self.say(op="fetchAsset", uri=uri, requestId=self.calls)
        message = self.until_binary(self.ASSET, self.calls)
        failed, size = struct.unpack_from("<BI", message, 5)
        error, content = message[10:10 + size].decode(), message[10 + size:]
        assert failed == (1 if error else 0), message[:20]
        return content, error

    def call(self, payload, service=1, encoding=b"json"):
        """(response, failure), one of them empty."""
        self.calls += 1
        self.say_bytes(struct.pack("<BIII", 2, service, self.calls, len(encoding)) + encoding + payload)
        number = self.calls

        def of_call(message):
            if isinstance(message, dict):
                return message["op"] == "serviceCallFailure" and message["callId"] == number
            return message[0] == self.RESPONSE and struct.unpack_from("<I", message, 5)[0] == number
        message = self.until(of_call)
        if isinstance(message, dict):
            return b"", message["message"]
        size, = struct.unpack_from("<I", message, 9)
        assert message[13:13 + size] == encoding
        return message[13 + size:], ""

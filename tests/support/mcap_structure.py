"""Reads the structure of MCAP files by the specification (version 0), independently of the product's reader.

Every byte is accounted for: magic, records one behind the other, CRCs, what the summary says of the records before it. What is
wrong raises AssertionError. Chunks are looked into where they are not compressed, or where `decompress` has a function for them."""

import struct
import zlib

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX = range(1, 9)
ATTACHMENT, ATTACHMENT_INDEX, STATISTICS, METADATA, METADATA_INDEX, SUMMARY_OFFSET, DATA_END = range(9, 16)


class Fields:
    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, size):
        assert self.at + size <= len(self.data), "a field reaches beyond its record"
        self.at += size
        return self.data[self.at - size:self.at]

    def number(self, kind):
        return struct.unpack("<" + kind, self.take(struct.calcsize(kind)))[0]

    def text(self):
        return self.take(self.number("I")).decode()

    def rest(self):
        return self.take(len(self.data) - self.at)

    def pairs(self, key, value):
        inner, out = Fields(self.take(self.number("I"))), []
        while inner.at < len(inner.data):
            out.append((key(inner), value(inner)))
        return out

    def texts(self):
        return dict(self.pairs(Fields.text, Fields.text))


def records(data, begin, end):
    """(opcode, offset, content) of each record; they fill the space exactly."""
    at = begin
    while at < end:
        opcode, length = struct.unpack_from("<BQ", data, at)
        assert at + 9 + length <= end, f"the record at byte {at} reaches beyond byte {end}"
        yield opcode, at, data[at + 9:at + 9 + length]
        at += 9 + length
    assert at == end


class Recording:
    """What a file has; `messages` is (topic, sequence, log_time, publish_time, data), of chunks that could be opened."""

    def __init__(self, data, decompress=None):
        self.data = data
        self.decompress = dict(decompress or {})
        self.decompress[""] = lambda content, size: content
        self.schemas, self.channels, self.messages, self.chunks = {}, {}, [], []
        self.attachments, self.metadata, self.unopened = {}, [], 0
        self.message_indexes = {}
        assert data[:8] == MAGIC and data[-8:] == MAGIC, "no magic"
        self.read_footer()
        self.read_data()
        self.read_summary()

    def read_footer(self):
        at = len(self.data) - 8 - 29
        assert struct.unpack_from("<BQ", self.data, at) == (FOOTER, 20), "no footer"
        self.summary_start, self.offsets_start, crc = struct.unpack_from("<QQI", self.data, at + 9)
        self.footer_at = at
        assert 0 < self.summary_start <= self.offsets_start <= at
        assert crc == zlib.crc32(self.data[self.summary_start:at + 9 + 16]), "the CRC of the summary"

    def read_data(self):
        ended = False
        for number, (opcode, at, content) in enumerate(records(self.data, 8, self.summary_start)):
            assert not ended, "a record behind the end of the data"
            assert (number == 0) == (opcode == HEADER), "the header is the first record"
            fields = Fields(content)
            if opcode == HEADER:
                self.profile, self.library = fields.text(), fields.text()
            elif opcode == CHUNK:
                self.read_chunk(at, fields, len(content))
            elif opcode == MESSAGE_INDEX:
                channel = fields.number("H")
                self.message_indexes[at] = (channel, fields.pairs(lambda f: f.number("Q"), lambda f: f.number("Q")))
            elif opcode == ATTACHMENT:
                _, _, name, _ = fields.number("Q"), fields.number("Q"), fields.text(), fields.text()
                self.attachments[name] = fields.take(fields.number("Q"))
                covered = fields.at
                assert fields.number("I") == zlib.crc32(content[:covered]), f"the CRC of the attachment {name}"
            elif opcode == METADATA:
                self.metadata.append((fields.text(), fields.texts()))
            elif opcode == DATA_END:
                ended = True
            else:
                self.read_inner(opcode, content)
        assert ended, "no end of the data"

    def read_inner(self, opcode, content):
        fields = Fields(content)
        if opcode == SCHEMA:
            schema = (fields.number("H"), fields.text(), fields.text(), fields.text())
            assert schema[0] != 0 and self.schemas.setdefault(schema[0], schema) == schema
        elif opcode == CHANNEL:
            channel = (fields.number("H"), fields.number("H"), fields.text(), fields.text(), fields.texts())
            assert channel[1] == 0 or channel[1] in self.schemas, "a channel before its schema"
            assert self.channels.setdefault(channel[0], channel) == channel
        elif opcode == MESSAGE:
            channel, sequence, log_time, publish_time = (fields.number(kind) for kind in "HIQQ")
            assert channel in self.channels, "a message before its channel"
            self.messages.append((self.channels[channel][2], sequence, log_time, publish_time, fields.rest()))
        else:
            raise AssertionError(f"a record of kind {opcode}")

    def read_chunk(self, at, fields, length):
        start, end, size, crc = (fields.number(kind) for kind in "QQQI")
        compression = fields.text()
        stored = fields.take(fields.number("Q"))
        self.chunks.append({"offset": at, "length": 9 + length, "start": start, "end": end, "compression": compression,
                            "stored": len(stored), "size": size})
        if compression not in self.decompress:
            self.unopened += 1
            return
        content = self.decompress[compression](stored, size)
        assert len(content) == size and zlib.crc32(content) == crc, f"the chunk at byte {at}"
        before = len(self.messages)
        for opcode, _, inner in records(content, 0, len(content)):
            self.read_inner(opcode, inner)
        times = [message[2] for message in self.messages[before:]]
        assert (min(times), max(times)) == (start, end), f"the times of the chunk at byte {at}"
        self.chunks[-1]["content"] = content

    def read_summary(self):
        self.statistics, indexes, last, group_starts = None, [], None, {}
        for opcode, at, content in records(self.data, self.summary_start, self.offsets_start):
            if opcode != last:
                assert opcode not in group_starts, "the summary is not grouped by kind"
                group_starts[opcode] = at
            last = opcode
            fields = Fields(content)
            if opcode in (SCHEMA, CHANNEL):
                self.read_inner(opcode, content)
            elif opcode == STATISTICS:
                numbers = [fields.number(kind) for kind in "QHIIIIQQ"]
                self.statistics = dict(zip(("messages", "schemas", "channels", "attachments", "metadata", "chunks", "start", "end"),
                                           numbers), by_channel=dict(fields.pairs(lambda f: f.number("H"), lambda f: f.number("Q"))))
            elif opcode == CHUNK_INDEX:
                indexes.append(self.read_chunk_index(fields))
        for opcode, _, content in records(self.data, self.offsets_start, self.footer_at):
            assert opcode == SUMMARY_OFFSET
            kind, start, length = struct.unpack("<BQQ", content)
            assert group_starts.pop(kind) == start and start + length <= self.offsets_start
        assert not group_starts, "a group without an offset"
        self.compare(indexes)

    def read_chunk_index(self, fields):
        start, end, offset, length = (fields.number("Q") for _ in range(4))
        at = dict(fields.pairs(lambda f: f.number("H"), lambda f: f.number("Q")))
        index_length, compression, stored, size = fields.number("Q"), fields.text(), fields.number("Q"), fields.number("Q")
        chunk = {"offset": offset, "length": length, "start": start, "end": end, "compression": compression, "stored": stored,
                 "size": size}
        return chunk, at, index_length

    def compare(self, indexes):
        assert [index[0] for index in indexes] == [{key: value for key, value in chunk.items() if key != "content"}
                                                   for chunk in self.chunks], "the chunk indexes"
        for (chunk, at, index_length), found in zip(indexes, self.chunks):
            end = chunk["offset"] + chunk["length"]
            assert all(end <= offset < end + index_length for offset in at.values())
            for channel, offset in at.items():
                assert self.message_indexes[offset][0] == channel
                for time, place in self.message_indexes[offset][1] if "content" in found else ():
                    opcode, _, number, _, log_time = struct.unpack_from("<BQHIQ", found["content"], place)
                    assert (opcode, number, log_time) == (MESSAGE, channel, time), "a message index"
        statistics = self.statistics
        assert statistics["chunks"] == len(self.chunks) and statistics["channels"] == len(self.channels)
        assert statistics["schemas"] == len(self.schemas) and statistics["attachments"] == len(self.attachments)
        assert statistics["metadata"] == len(self.metadata)
        assert statistics["messages"] == sum(statistics["by_channel"].values())
        if self.unopened == 0:
            assert statistics["messages"] == len(self.messages)


def topics(recording):
    """Messages by topic, by the statistics."""
    out = {}
    for channel, count in recording.statistics["by_channel"].items():
        topic = recording.channels[channel][2]
        out[topic] = out.get(topic, 0) + count
    return out

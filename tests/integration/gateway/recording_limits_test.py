"""Small recordings with a large decompressed size are answered from the index or refused; an option raises the limit."""

import json
import struct
import unittest
import zlib

import gateway as g

CHUNKS = 40
CHUNK_BYTES = 200_000_000
MAGIC = b"\x89MCAP0\r\n"
LIMIT = "--decompressed-limit"


def zeros_as_zstd(size):
    """A frame of zstd (RFC 8878) with `size` zeros: run-length blocks of 128 KiB."""
    block = 128 << 10
    out = struct.pack("<IBQ", 0xFD2FB528, 0xE0, size)  # one segment, with its size
    while size > 0:
        now = min(block, size)
        size -= now
        out += struct.pack("<I", (now << 3) | (1 << 1) | (size == 0))[:3] + b"\0"
    return out


def record(opcode, content):
    return struct.pack("<BQ", opcode, len(content)) + content


def text(value):
    return struct.pack("<I", len(value)) + value.encode()


def chunk():
    """A chunk of zeros, which are not records."""
    data = zeros_as_zstd(CHUNK_BYTES)
    return record(0x06, struct.pack("<QQQI", 1, 2, CHUNK_BYTES, 0) + text("zstd") + struct.pack("<Q", len(data)) + data)


def write_recording(path, indexed, chunks=CHUNKS):
    one = chunk()
    channel = record(0x04, struct.pack("<HH", 1, 0) + text("/a") + text("json") + struct.pack("<I", 0))
    data = MAGIC + record(0x01, text("") + text("test")) + channel
    offsets = []
    for _ in range(chunks):
        offsets.append(len(data))
        data += one
    data += record(0x0F, struct.pack("<I", 0))
    start = 0
    if indexed:
        start = len(data)
        statistics = struct.pack("<QHIIIIQQ", chunks, 0, 1, 0, 0, chunks, 1, 2) + struct.pack("<IHQ", 10, 1, chunks)
        data += channel + record(0x0B, statistics)
        for offset in offsets:
            data += record(0x08, struct.pack("<QQQQ", 1, 2, offset, len(one)) + struct.pack("<I", 0) + struct.pack("<Q", 0) + text("zstd") +
                           struct.pack("<QQ", len(one), CHUNK_BYTES))
    footer = struct.pack("<BQQQ", 0x02, 20, start, 0)
    crc = zlib.crc32(data[start:] + footer) if indexed else 0
    path.write_bytes(data + footer + struct.pack("<I", crc) + MAGIC)


class RecordingLimits(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = g.Scratch()
        cls.indexed = cls.scratch.root / "indexed.mcap"
        cls.plain = cls.scratch.root / "plain.mcap"
        write_recording(cls.indexed, True)
        write_recording(cls.plain, False)
        assert cls.plain.stat().st_size < 260_000

    @classmethod
    def tearDownClass(cls):
        cls.scratch.remove()

    def refused(self, *arguments):
        done = self.scratch.cellmirror(*arguments)
        self.assertNotEqual(done.returncode, 0, done.stdout)
        self.assertIn("more than 1.1 GB decompressed", done.stderr)
        self.assertIn("at byte ", done.stderr)
        self.assertIn(f"raise the limit: {LIMIT} GB", done.stderr)

    def test_info_answers_from_the_index(self):
        done = self.scratch.cellmirror("recording", "info", self.indexed, "--json", LIMIT, "0.001")
        self.assertEqual(done.returncode, 0, done.stderr)
        info = json.loads(done.stdout)
        self.assertTrue(info["indexed"], info["why_not_indexed"])
        self.assertEqual((info["chunks"], info["messages"], info["uncompressed_bytes"]), (CHUNKS, CHUNKS, CHUNKS * CHUNK_BYTES))
        self.assertEqual(info["chunks_left_out"], 0)

    def test_info_without_an_index_reports_the_chunks_left_out(self):
        done = self.scratch.cellmirror("recording", "info", self.plain, "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        info = json.loads(done.stdout)
        self.assertEqual((info["indexed"], info["chunks"], info["uncompressed_bytes"]), (False, CHUNKS, CHUNKS * CHUNK_BYTES))
        self.assertEqual(info["chunks_left_out"], CHUNKS - (1 << 30) // CHUNK_BYTES)
        done = self.scratch.cellmirror("recording", "info", self.plain)
        self.assertIn("35 of 40 chunks are not counted: all chunks together have 8.0 GB decompressed", done.stdout)
        self.assertIn(f"{LIMIT} 8\n", done.stdout)

    def test_subcommands_that_read_every_chunk_refuse(self):
        for file in (self.plain, self.indexed):
            self.refused("recording", "check", file)
            self.refused("recording", "recover", file, "-o", self.scratch.root / "new.mcap")
            self.assertFalse((self.scratch.root / "new.mcap").exists())
        self.refused("recording", "export", self.plain, "--topic", "/a")
        self.refused("recording", "plot", self.plain, "--topic", "/a", "--fields", "x", "-o", self.scratch.root / "a.png")
        self.refused("replay", self.plain, "--verify")
        self.refused("replay", self.plain, "--cell", self.scratch.cell_file)
        self.refused("replay", self.plain)

    def test_a_chunk_without_records_ends_the_reading_of_an_indexed_file(self):
        done = self.scratch.cellmirror("recording", "export", self.indexed, "--topic", "/a")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("no whole record at its byte 0", done.stderr)

    def test_the_limit_can_be_raised(self):
        few = self.scratch.root / "few.mcap"
        write_recording(few, False, 6)
        self.refused("recording", "check", few)
        done = self.scratch.cellmirror("recording", "check", few, "--json", LIMIT, "1.2")
        check = json.loads(done.stdout)
        # One fault in each chunk, and one for the missing summary.
        self.assertEqual((check["fault_count"], check["chunks"]), (7, 6))
        self.assertEqual(done.returncode, 1)


if __name__ == "__main__":
    g.main()

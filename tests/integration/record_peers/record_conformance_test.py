"""The conformance suite of MCAP (github.com/foxglove/mcap, tests/conformance): all 416 variants, made anew with @mcap/core.

That they are the same files is known by their SHA-256, which the suite's repository has as pointers. Our reader reads each of them
in order and by its index, and our writer writes what is in it; @mcap/core says what both have to find.

What does not apply: the suite also lets a writer repeat its files to the byte. Its variants are switches of a writer (no chunks, no
index, bytes behind records) that ours does not have: it writes one layout, with everything."""

import hashlib
import json
import pathlib
import subprocess
import tempfile
import unittest

import gateway as g
from judges import PACKAGES

# Of "NAME SHA256\n" of all variants of an input, sorted by name; computed from the pointers of the repository.
SUITE = {
    "NoData": (6, "b44e4fcaa02a347a846c3a73cdacedb2760f052849d42770cc524df905e912b0"),
    "OneAttachment": (14, "40a833056836d43242de4c6f1ade432318b9dd99bbdd7288af67e6e8ec66d2e1"),
    "OneMessage": (154, "aef6afb96b3307499b965743343a956c8b299a130d3197fa946573038d0a842c"),
    "OneMetadata": (14, "2cace83e09dc6c7273cb209c5753020726da2d56b8f49ab229261d8c15ab36cd"),
    "OneSchemalessMessage": (74, "cc98bcbc33f2d30118337060fce1ded94dab10c48c966172fb9fca39222d7b3a"),
    "TenMessages": (154, "5409ef83eaebca38cac56f6c84896368ce077675b162719b22c6784a53a0578c"),
}
KINDS = ("Schema", "Channel", "Message", "Attachment", "Metadata")
COUNTS = {"Message": "messageCount", "Schema": "schemaCount", "Channel": "channelCount", "Attachment": "attachmentCount",
          "Metadata": "metadataCount"}


def of_kind(records, kind):
    return [record for record in records if record["type"] == kind]


def by_time(messages):
    return sorted(messages, key=lambda one: (int(one["logTime"]), one["sequence"]))


class Conformance(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = g.Scratch()
        cls.variants = cls.scratch.root / "variants"
        cls.hashes = PACKAGES.run("conformance.mjs", "make", cls.variants)
        cls.theirs = PACKAGES.run("conformance.mjs", "read", *sorted(cls.variants.iterdir()))

    @classmethod
    def tearDownClass(cls):
        cls.scratch.remove()

    def ours(self, compression):
        copies = pathlib.Path(tempfile.mkdtemp(dir=self.scratch.root))
        done = subprocess.run([g.BIN / "record_conformance", self.variants, copies, compression], capture_output=True, text=True,
                              timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout), copies

    def test_the_files_are_those_of_the_suite(self):
        for name, (count, digest) in SUITE.items():
            lines = [f"{variant} {self.hashes[variant]}\n" for variant in sorted(self.hashes) if variant.split("-")[0] == name]
            self.assertEqual(len(lines), count, name)
            self.assertEqual(hashlib.sha256("".join(lines).encode()).hexdigest(), digest, name)
        self.assertEqual(len(self.hashes), 416)

    def test_reader(self):
        ours, _ = self.ours("none")
        self.assertEqual(set(ours), set(self.theirs))
        for name, found in ours.items():
            with self.subTest(variant=name):
                records = self.theirs[name]["records"]
                self.assertEqual(found["records"], records)
                self.assertTrue(found["ended"])
                self.assertEqual(found["faults"], 0)
                messages = of_kind(records, "Message")
                self.assertEqual(found["messages"], messages)
                by_index = self.theirs[name]["indexed"]
                if by_index is not None and found["indexed"]:
                    self.assertEqual(by_time(found["messages"]), by_time(by_index["messages"]))
                for kind, count in COUNTS.items():
                    self.assertEqual(found["statistics"][count], len(of_kind(records, kind)), kind)
                times = [int(message["logTime"]) for message in messages] or [0]
                self.assertEqual((found["statistics"]["messageStartTime"], found["statistics"]["messageEndTime"]),
                                 (min(times), max(times)))
        # Files with everything that an index needs are read by it.
        self.assertTrue(ours["TenMessages-ch-chx-mx-rch-rsh-st-sum"]["indexed"])
        self.assertTrue(ours["TenMessages-ch-chx-mx-pad-rch-rsh-st"]["indexed"])
        self.assertFalse(ours["TenMessages"]["indexed"])

    def test_writer(self):
        for compression in ("none", "lz4", "zstd"):
            _, copies = self.ours(compression)
            written = PACKAGES.run("conformance.mjs", "read", *sorted(copies.iterdir()))
            self.assertEqual(set(written), set(self.theirs))
            for name, found in written.items():
                with self.subTest(variant=name, compression=compression):
                    records = self.theirs[name]["records"]
                    for kind in KINDS:
                        self.assertEqual(of_kind(found["records"], kind), of_kind(records, kind), kind)
                    if of_kind(records, "Message"):
                        self.assertEqual(by_time(found["indexed"]["messages"]), by_time(of_kind(records, "Message")))
                        self.assertEqual(found["indexed"]["statistics"]["messageCount"], str(len(of_kind(records, "Message"))))


if __name__ == "__main__":
    PACKAGES.main()

"""The figures of the documents: each is made by tests/support/figures/figures.py, shown by a page, small, and up to date."""

import os
import pathlib
import re
import sys
import unittest

SOURCE = pathlib.Path(os.environ.get("CELLMIRROR_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[3]))
sys.path.insert(0, str(SOURCE / "tests/support/figures"))
import figures  # noqa: E402

LARGEST = {".png": 150_000, ".jpg": 150_000, ".svg": 50_000, ".webp": 250_000}  # bytes
FEWEST = 20


class Figures(unittest.TestCase):
    def setUp(self):
        self.files = {file.name: file for file in (SOURCE / "docs/figures").iterdir()}

    def test_each_is_made_by_a_script_and_each_that_is_made_is_there(self):
        self.assertEqual(set(self.files), set(figures.ALL))
        self.assertGreaterEqual(len(self.files), FEWEST)

    def test_each_is_shown(self):
        pages = [SOURCE / "README.md", *(SOURCE / "docs").rglob("*.md")]
        shown = {name for page in pages for name in re.findall(r"!\[[^\]]+\]\((?:[\w./]*/)?figures/([\w.]+)\)", page.read_text())}
        self.assertEqual(shown, set(self.files))

    def test_each_is_small(self):
        self.assertEqual({name: file.stat().st_size for name, file in self.files.items() if file.stat().st_size > LARGEST[file.suffix]}, {})

    def test_diagrams_are_those_of_the_sources(self):
        old = [name for name, draw in figures.DIAGRAMS.items() if name in self.files and self.files[name].read_bytes() != draw().bytes()]
        self.assertEqual(old, [], "make them with: tests/support/figures/figures.py --diagrams")


if __name__ == "__main__":
    sys.exit(unittest.main(verbosity=2))

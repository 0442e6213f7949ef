"""The site of the documents: it builds without warnings, its links and anchors hold, and it loads nothing from elsewhere."""

import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from html.parser import HTMLParser
from urllib.parse import unquote

SOURCE = pathlib.Path(os.environ.get("CELLMIRROR_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[3]))
# Attributes by which a browser loads something, and those that only lead elsewhere where somebody clicks.
LOADS = {("script", "src"), ("link", "href"), ("img", "src"), ("iframe", "src"), ("source", "src"), ("video", "src"), ("object", "data")}
ADDRESSES = LOADS | {("a", "href")}
ELSEWHERE = re.compile(r"(?:[a-z]+:)?//|(?:https?|ftp|data|javascript):", re.IGNORECASE)


def build(folder):
    done = subprocess.run([sys.executable, "-B", SOURCE / "cmake/site/build.py", folder], capture_output=True, text=True, timeout=100)
    if done.returncode != 0:
        raise AssertionError(done.stdout + done.stderr)


class Page(HTMLParser):
    def __init__(self, file):
        super().__init__()
        self.ids, self.addresses, self.loads, self.pictures, self.paragraphs = set(), [], [], [], []
        self.in_paragraph = False
        self.feed(file.read_text())

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.in_paragraph = tag == "p"
        if values.get("id"):
            self.ids.add(values["id"])
        for name, value in attributes:
            if value and (tag, name) in ADDRESSES:
                self.addresses.append(value)
            if value and (tag, name) in LOADS:
                self.loads.append(value)
        if tag == "img":
            self.pictures.append((values.get("src"), values.get("alt")))

    def handle_data(self, text):
        if self.in_paragraph:
            self.paragraphs.append(text)
            self.in_paragraph = False


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if shutil.which("mkdocs") is None or not pathlib.Path("/usr/share/mkdocs/themes/material").is_dir():
            raise unittest.SkipTest("skipped: mkdocs and mkdocs-material are not installed")
        cls.root = pathlib.Path(tempfile.mkdtemp(prefix="cellmirror-site-"))
        cls.site = cls.root / "site"
        build(cls.site)
        cls.pages = {file.relative_to(cls.site).as_posix(): Page(file) for file in sorted(cls.site.rglob("*.html"))}

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.root)

    def test_every_link_and_anchor_holds(self):
        wrong = []
        for name, page in self.pages.items():
            for address in page.addresses:
                if ELSEWHERE.match(address):
                    continue
                path, _, anchor = address.partition("#")
                goal = (self.site / name).parent / unquote(path) if path else self.site / name
                if goal.is_dir():
                    goal /= "index.html"
                if not goal.is_file():
                    wrong.append(f"{name}: {address}: there is no such file")
                elif anchor and goal.suffix == ".html":
                    if unquote(anchor) not in self.pages[goal.resolve().relative_to(self.site.resolve()).as_posix()].ids:
                        wrong.append(f"{name}: {address}: there is no such heading")
        self.assertEqual(wrong, [])

    def test_nothing_is_loaded_from_elsewhere(self):
        self.assertEqual([f"{name}: {address}" for name, page in self.pages.items() for address in page.loads if ELSEWHERE.match(address)], [])
        for style in self.site.rglob("*.css"):
            self.assertIsNone(re.search(r"@import|url\(['\"]?(?:https?:)?//", style.read_text()), style.name)

    def test_every_page_is_in_the_navigation(self):
        navigation = (SOURCE / "mkdocs.yml").read_text()
        pages = [page.relative_to(SOURCE / "docs").as_posix() for page in sorted((SOURCE / "docs").rglob("*.md"))]
        self.assertEqual([page for page in pages if not re.search(rf"[ ]{re.escape(page)}$", navigation, re.MULTILINE)], [],
                         "give them a place in nav of mkdocs.yml")
        for kind in ("Tutorials", "How-to guides", "Reference", "Explanation"):
            self.assertIn(f"  - {kind}:", navigation)

    def test_markdown_became_what_it_means(self):
        """Tables and lists that Python-Markdown did not recognise are paragraphs that begin with their marks."""
        self.assertEqual([f"{name}: {text[:60]}" for name, page in self.pages.items() for text in page.paragraphs
                          if re.match(r"\s*(\||[-*] |```|<!--)", text)], [])

    def test_every_figure_has_words_for_those_who_do_not_see_it(self):
        self.assertEqual([f"{name}: {source}" for name, page in self.pages.items() for source, words in page.pictures
                          if not words and "figures/" in source], [])

    def test_the_index_of_the_search_has_every_page(self):
        text = (self.site / "search/search_index.js").read_text()
        index = json.loads(text.removeprefix("cellmirrorSearchIndex(").removesuffix(");\n"))
        found = {entry["location"].split("#")[0] for entry in index["docs"]}
        self.assertEqual({name for name in self.pages if name not in found}, set())

    def test_the_same_again(self):
        """Byte for byte, later and elsewhere: packages have to be reproducible."""
        def hashes(folder):
            return {file.relative_to(folder): hashlib.sha256(file.read_bytes()).hexdigest() for file in folder.rglob("*") if file.is_file()}

        time.sleep(1)  # a time of the build would differ now
        build(self.root / "again")
        one, two = hashes(self.site), hashes(self.root / "again")
        self.assertEqual([str(name) for name in sorted(one.keys() | two.keys()) if one.get(name) != two.get(name)], [])


if __name__ == "__main__":
    sys.exit(unittest.main(verbosity=2))

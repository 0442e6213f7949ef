"""Runs the tests of the page's modules with node's own test runner, and looks at what no module can see: sizes, policy."""

import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("CELLMIRROR_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[3]))
PAGE = SOURCE / "ipc" / "web" / "page"
WALL = SOURCE / "ipc" / "web" / "wall_page"
MOST_BYTES = 300_000


class Modules(unittest.TestCase):
    def test_with_node(self):
        node = shutil.which("node") or shutil.which("nodejs")
        if not node:
            self.skipTest("skipped: node is not installed")
        with tempfile.TemporaryDirectory(prefix="cellmirror-page-") as folder:
            place = pathlib.Path(folder)
            shutil.copytree(PAGE / "modules", place / "modules")
            shutil.copytree(WALL / "modules", place / "modules", dirs_exist_ok=True)
            shutil.copy(PAGE / "index.html", place)
            (place / "package.json").write_text('{"type": "module"}')  # else node takes .js for its older kind
            for test in pathlib.Path(__file__).parent.glob("*_test.mjs"):
                shutil.copy(test, place)
            done = subprocess.run([node, "--test", *sorted(str(test) for test in place.glob("*_test.mjs"))], cwd=place,
                                  capture_output=True, text=True, timeout=100)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            passed = re.search(r"^(?:#|\u2139) pass (\d+)", done.stdout, re.M)
            self.assertGreater(int(passed[1]) if passed else 0, 3, done.stdout)


class Files(unittest.TestCase):
    def files(self):
        return [path for path in PAGE.rglob("*") if path.is_file()]

    def test_no_code_of_others_lies_among_them(self):
        self.assertFalse([path for path in self.files() if "lib" in path.parts or path.name.endswith(".min.js")])

    def test_all_together_are_small(self):
        self.assertLess(sum(path.stat().st_size for path in self.files()), MOST_BYTES)

    def test_what_the_page_names_is_there(self):
        text = (PAGE / "index.html").read_text()
        named = re.findall(r'(?:src|href)="page/([^"]+)"', text)
        self.assertIn("modules/main.js", named)
        for name in named:
            self.assertTrue(name.startswith("lib/") or (PAGE / name).is_file(), name)
        for module in (PAGE / "modules").glob("*.js"):
            for name in re.findall(r'from "\./([^"]+)"', module.read_text()):
                self.assertTrue((module.parent / name).is_file(), f"{module.name}: {name}")

    def test_every_id_that_modules_ask_for_is_in_the_page_once(self):
        ids = re.findall(r'\bid="([^"]+)"', (PAGE / "index.html").read_text())
        self.assertEqual(len(ids), len(set(ids)))
        for module in (PAGE / "modules").glob("*.js"):
            for name in re.findall(r'byId\("([^"]+)"\)', module.read_text()):
                self.assertIn(name, ids, module.name)

    def test_nothing_is_inline_and_nothing_comes_from_elsewhere(self):
        text = (PAGE / "index.html").read_text()
        self.assertNotRegex(text, r"<style|\sstyle=|\son\w+=|<script(?![^>]*\ssrc=)")
        for path in self.files():
            if path.suffix in (".html", ".css", ".js"):
                outside = re.findall(r"https?://(?!www\.w3\.org/2000/svg)[^\s\"'`)]+", path.read_text())
                self.assertEqual(outside, [], path)

class WallFiles(Files):
    """The same of the wall, which has some of the files of the page (ipc/web/CMakeLists.txt)."""

    def files(self):
        return [path for path in WALL.rglob("*") if path.is_file()]

    def shared(self):
        text = (WALL.parent / "CMakeLists.txt").read_text()
        return re.search(r"set\(shared ([^)]*)\)", text)[1].split()

    def test_what_the_page_names_is_there(self):
        named = re.findall(r'(?:src|href)="page/([^"]+)"', (WALL / "index.html").read_text())
        for module in (WALL / "modules").glob("*.js"):
            named += [f"modules/{name}" for name in re.findall(r'from "\./([^"]+)"', module.read_text())]
        for name in self.shared():
            self.assertTrue((PAGE / name).is_file(), name)
            if name.endswith(".js"):
                named += [f"modules/{other}" for other in re.findall(r'from "\./([^"]+)"', (PAGE / name).read_text())]
        self.assertIn("modules/wall_main.js", named)
        for name in named:
            self.assertTrue((WALL / name).is_file() or name in self.shared(), name)

    def test_every_id_that_modules_ask_for_is_in_the_page_once(self):
        text = (WALL / "index.html").read_text()
        ids = re.findall(r'\bid="([^"]+)"', text)
        self.assertEqual(len(ids), len(set(ids)))
        for module in (WALL / "modules").glob("*.js"):
            for name in re.findall(r'byId\("([^"]+)"\)', module.read_text()):
                self.assertIn(name, ids, module.name)

    def test_nothing_is_inline_and_nothing_comes_from_elsewhere(self):
        text = (WALL / "index.html").read_text()
        self.assertNotRegex(text, r"<style|\sstyle=|\son\w+=|<script(?![^>]*\ssrc=)")
        for path in self.files():
            outside = re.findall(r"https?://(?!127\.0\.0\.1)[a-z][^\s\"'`)]+", path.read_text())
            self.assertEqual(outside, [], path)


if __name__ == "__main__":
    unittest.main(verbosity=2)

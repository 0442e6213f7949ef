"""The same series through dcmtk: its view of order, spacing and values, and the transfer syntaxes that it writes."""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import series as s

for program, package in (("dcmdump", "dcmtk"), ("dcmcjpeg", "dcmtk"), ("gdcmconv", "libgdcm-tools")):
    if not shutil.which(program):
        print(f"skipped: {package} is not installed")
        sys.exit(77)


def dcmdump(path, *tags):
    options = [word for tag in tags for word in ("+P", tag)]
    out = subprocess.run(["dcmdump", "-M", "+L", *options, path], capture_output=True, text=True, check=True).stdout
    return dict(re.findall(r"^(\(\w{4},\w{4}\)) \w\w \[?([^\]#]*?)\]?\s+#", out, re.MULTILINE))


class Dcmtk(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.temporary.name)
        self.folder = self.root / "ct"
        s.save_all(self.folder, [s.slice_of(k, rows=32, columns=32) for k in range(6)])

    def tearDown(self):
        self.temporary.cleanup()

    def test_order_and_spacing_are_those_of_dcmdump(self):
        found = s.info(self.folder)
        places = []
        for name in found["files"]:
            tags = dcmdump(self.folder / name, "0020,0032", "0028,0030", "0028,0010", "0028,0011")
            places.append(float(tags["(0020,0032)"].split("\\")[2]))
            rows, columns = tags["(0028,0030)"].split("\\")
            self.assertAlmostEqual(1e3 * found["spacing_m"][0], float(columns))
            self.assertAlmostEqual(1e3 * found["spacing_m"][1], float(rows))
        self.assertEqual(places, sorted(places))
        steps = [b - a for a, b in zip(places, places[1:])]
        self.assertAlmostEqual(1e3 * found["spacing_m"][2], sum(steps) / len(steps))

    def test_every_lossless_transfer_syntax_has_the_same_values(self):
        plain, _ = s.converted(self.folder, self.root / "plain.nrrd")
        coders = [["dcmcjpeg", "+e1"], ["dcmcjpeg", "+el"], ["dcmcrle"], ["dcmcjpls", "+el"], ["dcmconv", "+te"],
                  ["dcmconv", "+ti"], ["dcmconv", "+tb"], ["dcmconv", "+td"],
                  ["gdcmconv", "--j2k"]]
        for coder in coders:
            folder = self.root / "".join(coder)
            folder.mkdir()
            for path in self.folder.iterdir():
                subprocess.run([coder[0], *coder[1:], path, folder / path.name], check=True, capture_output=True)
            with self.subTest(coder):
                coded, _ = s.converted(folder, self.root / "coded.nrrd")
                self.assertEqual(coded.fields, plain.fields)
                self.assertEqual(coded.values, plain.values)

    def test_values_are_those_that_dcmdump_writes(self):
        found = s.info(self.folder)
        grid, _ = s.converted(self.folder, self.root / "out.nrrd")
        for k, name in enumerate(found["files"]):
            raw = self.root / "raw"
            raw.mkdir(exist_ok=True)
            subprocess.run(["dcmdump", "+W", raw, self.folder / name], check=True, capture_output=True)
            pixels = s.array.array("H", (raw / f"{name}.0.raw").read_bytes())
            self.assertEqual([v - 1024 for v in pixels], list(grid.values[k * 1024:(k + 1) * 1024]))


if __name__ == "__main__":
    unittest.main(verbosity=2)

"""The bill of materials: well-formed SPDX 2.3, the same twice, and with every library that the programs load."""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import gateway as g

PROGRAMS = [g.BIN / "cellmirror", g.BIN / "cellmirror-dds", g.BIN / "sim_robot"]
# SPDX 2.3, clauses 6 to 11: what a document and a package must have.
OF_A_DOCUMENT = {"spdxVersion", "dataLicense", "SPDXID", "name", "documentNamespace", "creationInfo", "packages", "relationships"}
OF_A_PACKAGE = {"SPDXID", "name", "downloadLocation", "versionInfo", "filesAnalyzed", "licenseConcluded", "licenseDeclared", "copyrightText"}


def check_form(case, document):
    """Also used for the bill of the package."""
    case.assertLessEqual(OF_A_DOCUMENT, set(document))
    case.assertEqual((document["spdxVersion"], document["dataLicense"], document["SPDXID"]), ("SPDX-2.3", "CC0-1.0", "SPDXRef-DOCUMENT"))
    case.assertRegex(document["documentNamespace"], r"^urn:uuid:[0-9a-f-]{36}$")
    case.assertRegex(document["creationInfo"]["created"], r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$")
    case.assertTrue(document["creationInfo"]["creators"])
    known = {"SPDXRef-DOCUMENT"}
    for package in document["packages"]:
        case.assertLessEqual(OF_A_PACKAGE, set(package), package["name"])
        case.assertRegex(package["SPDXID"], r"^SPDXRef-[A-Za-z0-9.-]+$")
        case.assertNotIn(package["SPDXID"], known, "twice")
        known.add(package["SPDXID"])
        for reference in package.get("externalRefs", ()):
            case.assertRegex(reference["referenceLocator"], r"^pkg:deb/debian/[a-z0-9.+-]+@[^?\s]+\?arch=\w+$")
    related = set()
    for relationship in document["relationships"]:
        ends = {relationship["spdxElementId"], relationship["relatedSpdxElement"]}
        case.assertLessEqual(ends, known)
        related |= ends
    case.assertEqual(related, known, "a package that nothing relates to")
    case.assertEqual(document["documentDescribes"], ["SPDXRef-Package-cellmirror"])


class Bill(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        g.require("dpkg-query", "this is no Debian")
        cls.root = pathlib.Path(tempfile.mkdtemp(prefix="cellmirror-sbom-"))

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.root)

    def make(self, name):
        file = self.root / name
        subprocess.run([sys.executable, "-B", g.SOURCE / "cmake" / "sbom.py", "--version", "1.2.3", "--build-packages",
                        g.SOURCE / "cmake" / "packages-build.txt", "--opened-at-run-time", "libosmesa6", "no-such-package",
                        "--output", file, "--", *PROGRAMS],
                       check=True, timeout=110, env=dict(os.environ, SOURCE_DATE_EPOCH="1700000000"))
        return file.read_text()

    def test_is_well_formed_complete_and_repeatable(self):
        text = self.make("one.json")
        document = json.loads(text)
        check_form(self, document)
        self.assertEqual(document["creationInfo"]["created"], "2023-11-14T22:13:20Z")
        names = {package["name"] for package in document["packages"]}
        linked = {package["SPDXID"]: package["name"] for package in document["packages"]}
        dynamic = {linked[r["relatedSpdxElement"]] for r in document["relationships"] if r["relationshipType"] == "DYNAMIC_LINK"}
        self.assertGreater(len(dynamic), 10)
        for package in ("libc6", "libstdc++6", "libfastrtps2.9"):
            self.assertTrue(any(name.startswith(package) for name in dynamic), f"{package} in {sorted(dynamic)}")
        self.assertIn("libeigen3-dev", names, "only headers, but part of the program")
        self.assertNotIn("no-such-package", names)
        self.assertEqual(text, self.make("two.json"))


if __name__ == "__main__":
    g.main()

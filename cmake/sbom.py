"""A bill of materials in SPDX 2.3 (JSON) of our programs: the Debian packages of the libraries that they are linked with,
of those that they open at run time, and of what they were compiled with. The same files give the same text.

sbom.py --version V --build-packages LIST --output FILE [--opened-at-run-time PACKAGE...] -- PROGRAM...
"""

import argparse
import hashlib
import json
import os
import re
import subprocess
import time
import uuid
from pathlib import Path

LICENSE = "Apache-2.0"
MOST_LIBRARIES = 2000


def output_of(*command: str) -> str:
    return subprocess.run(command, capture_output=True, text=True, check=True, timeout=120,
                          env=dict(os.environ, LC_ALL="C.UTF-8")).stdout


def libraries_of(programs: list[Path]) -> list[Path]:
    """All that the dynamic linker loads for the programs; libraries of libraries too."""
    found = set()
    for program in programs:
        listing = output_of("ldd", str(program))
        if "not found" in listing:
            raise SystemExit(f"sbom.py: {program} lacks a library:\n{listing}")
        found |= {Path(name) for name in re.findall(r"(?:=> |^\s*)(/\S+) \(0x", listing, re.MULTILINE)}
    return sorted(found)[:MOST_LIBRARIES]


def owners_of(files: list[Path]) -> set[str]:
    """The packages that the files belong to. Their lists name a file by the path before or after the merge of /usr."""
    places = {file: {place for path in (file, file.resolve()) for place in (str(path), str(path).removeprefix("/usr"), f"/usr{path}")}
              for file in files}
    # Fails where one of the places is unknown, as most are; what is known is printed all the same.
    done = subprocess.run(["dpkg-query", "--search", *sorted(set().union(*places.values()))], capture_output=True, text=True, timeout=300)
    owner = {path: names.split(",")[0].strip() for names, path in re.findall(r"^(\S.*?): (/.*)$", done.stdout, re.MULTILINE)}
    for file, tried in places.items():
        if not tried & set(owner):
            raise SystemExit(f"sbom.py: {file} belongs to no package")
    return {owner[place] for tried in places.values() for place in tried if place in owner}


def listed_packages(lists: list[Path]) -> list[str]:
    lines = (line.split("#")[0].split() for path in lists for line in path.read_text().splitlines())
    return sorted({words[0] for words in lines if words})


def described(package: str) -> dict[str, str] | None:
    """None: it is not installed."""
    fields = ("binary:Package", "Version", "Architecture", "source:Package", "source:Version", "Maintainer", "Homepage", "db:Status-Status")
    form = "\\n".join(f"${{{field}}}" for field in fields) + "\\n"
    done = subprocess.run(["dpkg-query", "--show", "--showformat", form, package], capture_output=True, text=True, timeout=60)
    values = done.stdout.splitlines()[:len(fields)]
    if done.returncode != 0 or len(values) < len(fields) or values[-1] != "installed":
        return None
    return dict(zip(fields, values))


def spdx_id(name: str) -> str:
    return "SPDXRef-Package-" + re.sub(r"[^A-Za-z0-9.-]", "-", name)


def package_entry(data: dict[str, str]) -> dict:
    name = data["binary:Package"].split(":")[0]
    supplier = re.sub(r"^(.*?)\s*<(.*)>$", r"\1 (\2)", data["Maintainer"]) or "Debian"
    return {
        "SPDXID": spdx_id(name),
        "name": name,
        "versionInfo": data["Version"],
        "supplier": f"Organization: {supplier}",
        "downloadLocation": "NOASSERTION",
        "filesAnalyzed": False,
        "licenseConcluded": "NOASSERTION",
        "licenseDeclared": "NOASSERTION",
        "copyrightText": "NOASSERTION",
        "sourceInfo": f"built from the Debian source package {data['source:Package']} {data['source:Version']}",
        **({"homepage": data["Homepage"]} if data["Homepage"] else {}),
        "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                          "referenceLocator": f"pkg:deb/debian/{name}@{data['Version']}?arch={data['Architecture']}"}],
    }


def document(version: str, groups: list[tuple[str, bool, set[str]]], epoch: int) -> dict:
    """`groups`: a relationship, whether the package is its subject, and names of packages."""
    root = spdx_id("cellmirror")
    packages, relationships = {}, []
    for relationship, is_subject, names in groups:
        for name in sorted(names):
            data = described(name)
            if data is None:
                continue  # one of two that may be opened at run time
            entry = package_entry(data)
            packages[entry["SPDXID"]] = entry
            ends = (entry["SPDXID"], root) if is_subject else (root, entry["SPDXID"])
            relationships.append({"spdxElementId": ends[0], "relationshipType": relationship, "relatedSpdxElement": ends[1]})
    ours = {"SPDXID": root, "name": "cellmirror", "versionInfo": version, "downloadLocation": "NOASSERTION", "filesAnalyzed": False,
            "licenseConcluded": LICENSE, "licenseDeclared": LICENSE, "copyrightText": "NOASSERTION", "primaryPackagePurpose": "APPLICATION"}
    content = [ours, *(packages[key] for key in sorted(packages))]
    digest = hashlib.sha256(json.dumps([content, relationships], sort_keys=True).encode()).hexdigest()
    return {
        "spdxVersion": "SPDX-2.3",
        "dataLicense": "CC0-1.0",
        "SPDXID": "SPDXRef-DOCUMENT",
        "name": f"cellmirror-{version}",
        "documentNamespace": f"urn:uuid:{uuid.uuid5(uuid.NAMESPACE_OID, digest)}",
        "creationInfo": {"created": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(epoch)), "creators": ["Tool: cellmirror-sbom.py"]},
        "documentDescribes": [root],
        "packages": content,
        "relationships": [{"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES", "relatedSpdxElement": root}, *relationships],
    }


def main() -> None:
    parser = argparse.ArgumentParser(description="A bill of materials (SPDX 2.3, JSON) of programs.")
    parser.add_argument("--version", required=True)
    parser.add_argument("--build-packages", type=Path, action="append", default=[], help="a list as cmake/packages-build.txt")
    parser.add_argument("--opened-at-run-time", nargs="*", default=[], help="packages that the programs open at run time")
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("programs", type=Path, nargs="+")
    options = parser.parse_args()
    epoch = int(os.environ.get("SOURCE_DATE_EPOCH") or time.time())
    linked = owners_of(libraries_of(options.programs))
    built = {name for name in listed_packages(options.build_packages) if name.split(":")[0] not in {n.split(":")[0] for n in linked}}
    groups = [("DYNAMIC_LINK", False, linked), ("OPTIONAL_DEPENDENCY_OF", True, set(options.opened_at_run_time)),
              ("BUILD_DEPENDENCY_OF", True, built)]
    options.output.parent.mkdir(parents=True, exist_ok=True)
    text = json.dumps(document(options.version, groups, epoch), indent=1, ensure_ascii=False) + "\n"
    options.output.write_text(text)


if __name__ == "__main__":
    main()

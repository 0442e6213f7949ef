"""The packages of npm that judge recordings and the live server: those of package-lock.json, with the integrity that it demands.

They are downloaded where CELLMIRROR_PEERS is set (./check --peers), and kept beside the build; else tests skip where they are not
there."""

import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import unittest

import gateway as g

HERE = pathlib.Path(__file__).resolve().parent
PLACE = g.BIN.parent / "record_peers"
SKIPPED = 77


def why_missing():
    """Empty where the packages are there."""
    if shutil.which("npm") is None or shutil.which("node") is None:
        return "npm or node is not installed"
    lock = (HERE / "package-lock.json").read_bytes()
    mark = PLACE / "installed"
    wanted = hashlib.sha256(lock).hexdigest()
    if not (mark.exists() and mark.read_text() == wanted):
        if not os.environ.get("CELLMIRROR_PEERS"):
            return "the packages are not installed; ./check --peers does that"
        shutil.rmtree(PLACE, ignore_errors=True)
        PLACE.mkdir(parents=True)
        for name in ("package.json", "package-lock.json"):
            shutil.copy(HERE / name, PLACE)
        done = subprocess.run(["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund"], cwd=PLACE, capture_output=True,
                              text=True, timeout=200)
        if done.returncode != 0:
            return f"npm ci failed: {done.stderr[-300:]}"
        mark.write_text(wanted)
    # Modules are looked for beside the script.
    for script in HERE.glob("*.mjs"):
        shutil.copy(script, PLACE)
    return ""


def run(script, *arguments, timeout=120):
    """What the script prints, a JSON document."""
    done = subprocess.run(["node", script, *[str(one) for one in arguments]], cwd=PLACE, capture_output=True, text=True,
                          timeout=timeout)
    if done.returncode != 0:
        raise AssertionError(done.stderr)
    return json.loads(done.stdout)


def main():
    missing = why_missing()
    if missing:
        print(f"skipped: {missing}")
        sys.exit(SKIPPED)
    unittest.main(verbosity=2)

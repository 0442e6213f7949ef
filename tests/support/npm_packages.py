"""Packages of npm for tests: those of a package-lock.json, with the integrity that it demands, and scripts that use them.

They are downloaded where CELLMIRROR_PEERS is set (./check --peers), and kept beside the build; else tests skip where they are not
there."""

import hashlib
import json
import os
import shutil
import subprocess
import sys
import unittest

INSTALL_S = 300
SKIPPED = 77


class Packages:
    """Of the package-lock.json in `source`, installed in `place`; the modules (*.mjs) in `scripts` lie beside them."""

    def __init__(self, source, place, scripts=None):
        self.source, self.place, self.scripts = source, place, scripts or source

    def why_missing(self):
        """Empty where the packages are there."""
        if shutil.which("npm") is None or shutil.which("node") is None:
            return "npm or node is not installed"
        wanted = hashlib.sha256((self.source / "package-lock.json").read_bytes()).hexdigest()
        mark = self.place / "installed"
        if not (mark.exists() and mark.read_text() == wanted):
            if not os.environ.get("CELLMIRROR_PEERS"):
                return "the packages are not installed; ./check --peers does that"
            problem = self.install()
            if problem:
                return problem
            mark.write_text(wanted)
        # Modules are looked for beside the script.
        for script in self.scripts.glob("*.mjs"):
            shutil.copy(script, self.place)
        return ""

    def install(self):
        shutil.rmtree(self.place, ignore_errors=True)
        self.place.mkdir(parents=True)
        for name in ("package.json", "package-lock.json"):
            shutil.copy(self.source / name, self.place)
        done = subprocess.run(["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund"], cwd=self.place, capture_output=True,
                              text=True, timeout=INSTALL_S)
        return f"npm ci failed: {done.stderr[-300:]}" if done.returncode != 0 else ""

    def run(self, script, *arguments, timeout=120):
        """What the script prints, a JSON document."""
        done = subprocess.run(["node", script, *map(str, arguments)], cwd=self.place, capture_output=True, text=True, timeout=timeout)
        if done.returncode != 0:
            raise AssertionError(done.stderr)
        return json.loads(done.stdout)

    def main(self):
        """The tests of the module that calls it, or its exit as skipped."""
        missing = self.why_missing()
        if missing:
            print(f"skipped: {missing}")
            sys.exit(SKIPPED)
        unittest.main(module="__main__", verbosity=2)

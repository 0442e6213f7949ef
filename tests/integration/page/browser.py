"""Finds what a browser test needs, Chromium, node and playwright-core, and runs the scenarios of scenarios.mjs."""

import os
import pathlib
import shutil
import subprocess
import unittest

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = pathlib.Path(os.environ.get("CELLMIRROR_SOURCE_DIR", HERE.parents[2]))
BUILD = pathlib.Path(os.environ.get("CELLMIRROR_BIN_DIR", SOURCE / "build" / "bin")).parent
ARTEFACTS = BUILD / "page-artefacts"
PLAYWRIGHT = "playwright-core@~1.58.0"  # runs with Debian 12's node 18, which newer ones refuse
AXE = "axe-core@~4.10.3"  # finds what people with disabilities would stumble over


def chromium():
    for name in ("chromium-headless-shell", "chromium", "google-chrome"):
        if found := shutil.which(name):
            return found
    raise unittest.SkipTest("skipped: neither chromium-headless-shell nor chromium is installed")


def node():
    if found := shutil.which("node") or shutil.which("nodejs"):
        return found
    raise unittest.SkipTest("skipped: node is not installed")


def playwright_core():
    """Its folder; fetched once into the build folder where npm is there."""
    if given := os.environ.get("CELLMIRROR_PLAYWRIGHT"):
        return pathlib.Path(given)
    place = BUILD / "browser-tools"
    found = place / "node_modules" / "playwright-core"
    if not (found / "index.mjs").is_file() or not (found.parent / "axe-core" / "axe.min.js").is_file():
        npm = shutil.which("npm")
        if not npm:
            raise unittest.SkipTest("skipped: npm, which brings playwright-core, is not installed")
        place.mkdir(parents=True, exist_ok=True)
        try:
            done = subprocess.run([npm, "install", "--prefix", place, "--ignore-scripts", "--no-audit", "--no-fund", "--no-save",
                                   "--no-package-lock", PLAYWRIGHT, AXE], capture_output=True, text=True, timeout=120)
        except subprocess.TimeoutExpired:
            raise unittest.SkipTest("skipped: npm could not fetch playwright-core within 120 s") from None
        if done.returncode != 0:
            last = (done.stderr.strip().splitlines() or ["no reason given"])[-1]
            raise unittest.SkipTest(f"skipped: npm could not fetch playwright-core: {last}")
    return found


class Scenario:
    """A scenario in a browser of its own. It asks for what happens outside the page by printing `> WORD`; `answer`
    makes it happen and gives a line back, or none."""

    def __init__(self, name, address, *arguments):
        ARTEFACTS.mkdir(parents=True, exist_ok=True)
        self.command = [node(), HERE / "scenarios.mjs", name, address, *arguments]
        self.environment = dict(os.environ, CHROMIUM=chromium(), PLAYWRIGHT_CORE=str(playwright_core()),
                                AXE_CORE=str(playwright_core().parent / "axe-core"), ARTEFACTS=str(ARTEFACTS))

    def run(self, answer=None, timeout=100):
        child = subprocess.Popen([str(part) for part in self.command], env=self.environment, text=True, stdin=subprocess.PIPE,
                                 stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        output = []
        try:
            for line in child.stdout:
                output.append(line)
                if line.startswith("> "):
                    child.stdin.write((answer(line[2:].strip()) or "") + "\n")
                    child.stdin.flush()
            status = child.wait(timeout)
        finally:
            child.kill()
            child.wait()
            child.stdin.close()
            child.stdout.close()
        text = "".join(output)
        if status != 0:
            raise AssertionError(text)
        return text

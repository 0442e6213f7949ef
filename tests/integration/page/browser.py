"""Finds what a browser test needs, Chromium, node and playwright-core, and runs the scenarios of scenarios.mjs."""

import atexit
import json
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


def drawing(scenario):
    """What its browser draws with."""
    return "without-webgl" if "without_webgl" in scenario else "3d" if scenario.startswith("scene") else "2d"


class Browser:
    """Chromium and the scenarios in it, as child processes; they end with standard input."""

    running = {}  # by what they draw with: the next scenario of that kind goes on with it

    def __init__(self, kind):
        ARTEFACTS.mkdir(parents=True, exist_ok=True)
        environment = dict(os.environ, CHROMIUM=chromium(), PLAYWRIGHT_CORE=str(playwright_core()),
                           AXE_CORE=str(playwright_core().parent / "axe-core"), ARTEFACTS=str(ARTEFACTS))
        self.child = subprocess.Popen([node(), str(HERE / "scenarios.mjs"), kind], env=environment, text=True, stdin=subprocess.PIPE,
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.running[kind] = self

    def say(self, line):
        self.child.stdin.write(line + "\n")
        self.child.stdin.flush()

    def close(self):
        try:
            self.child.stdin.close()
            self.child.wait(20)
        except (OSError, subprocess.TimeoutExpired):
            pass
        self.child.kill()
        self.child.wait()
        self.child.stdout.close()

    @classmethod
    def of(cls, kind):
        return cls.running.get(kind) or cls(kind)


@atexit.register
def close_browsers():
    for browser in Browser.running.values():
        browser.close()


class Scenario:
    """Scenarios, NAME[,NAME...], in pages of their own. They ask for what happens outside the page by printing `> WORD`;
    `answer` makes it happen and gives a line back, or none."""

    def __init__(self, name, address, *arguments):
        self.kind = drawing(name)
        self.request = json.dumps({"scenarios": name, "address": address, "arguments": arguments})

    def run(self, answer=None):
        """What they print."""
        browser, output = Browser.of(self.kind), []
        passed = False
        try:
            browser.say(self.request)
            for line in browser.child.stdout:
                if line.startswith("= "):
                    passed = line == "= passed\n"
                    break
                output.append(line)
                if line.startswith("> "):
                    browser.say(answer(line[2:].strip()) or "")
        finally:
            if not passed:  # the next one gets another
                Browser.running.pop(self.kind).close()
        text = "".join(output)
        if not passed:
            raise AssertionError(text)
        return text

"""The site of the documents in headless Chromium, from file:// as the package has it: search, light and dark, axe, no request."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import browser

BUILD = browser.SOURCE / "cmake" / "site" / "build.py"


class Site(unittest.TestCase):
    def test_the_search_works_without_a_server(self):
        if shutil.which("mkdocs") is None:
            self.skipTest("skipped: mkdocs and mkdocs-material are not installed")
        environment = dict(os.environ, CHROMIUM=browser.chromium(), PLAYWRIGHT_CORE=str(browser.playwright_core()),
                           AXE_CORE=str(browser.playwright_core().parent / "axe-core"), ARTEFACTS=str(browser.ARTEFACTS))
        browser.ARTEFACTS.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix="cellmirror-site-") as folder:
            subprocess.run([sys.executable, "-B", BUILD, folder], check=True, timeout=100)
            done = subprocess.run([browser.node(), pathlib.Path(__file__).with_name("site_scenarios.mjs"), folder], env=environment,
                                  capture_output=True, text=True, timeout=100)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)

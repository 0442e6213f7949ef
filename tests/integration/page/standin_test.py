"""The monitor page in headless Chromium, against a stand-in that speaks its protocol: size, keys, fingers, rights."""

import re
import subprocess
import sys
import tempfile
import unittest

import browser

SUPPORT = browser.SOURCE / "tests" / "support"
FEW_PICTURES = ("--pictures-hz", "5")  # the processor draws each


class StandIn:
    """What it prints on stderr is a fault of its own: the test fails with it, whatever the page made of it."""

    def __init__(self, *arguments):
        self.errors = tempfile.TemporaryFile("w+")
        self.child = subprocess.Popen(["/usr/bin/python3", "-B", SUPPORT / "page_standin.py", *arguments], text=True,
                                      stdout=subprocess.PIPE, stderr=self.errors, stdin=subprocess.DEVNULL)
        self.address = self.child.stdout.readline().strip()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        ended = self.child.poll()
        self.child.kill()
        self.child.wait()
        self.child.stdout.close()
        with self.errors:
            self.errors.seek(0)
            told = self.errors.read()
        if told or ended is not None:
            raise AssertionError(f"the stand-in failed (status {ended}):\n{told}")


def setUpModule():
    browser.chromium(), browser.node(), browser.playwright_core()


class Page(unittest.TestCase):
    def run_scenario(self, name, *arguments, standin=FEW_PICTURES):
        with StandIn(*standin) as server:
            return browser.Scenario(name, server.address, *arguments).run()

    def test_an_update_with_200_joints_is_short(self):
        output = self.run_scenario("performance", "8", standin=("--robots", "20", "--joints", "10"))
        print("\n".join(re.findall(r"^(?:updates|script) .*$", output, re.M)), file=sys.stderr)

    def test_it_fits_every_screen(self):
        self.run_scenario("screens")
        for name in ("desk-light", "desk-dark", "tablet-light", "phone-light", "phone-dark"):
            self.assertGreater((browser.ARTEFACTS / f"{name}.png").stat().st_size, 10000)

    def test_views_have_the_names_of_the_layout_and_what_is_old_does_not_look_new(self):
        self.run_scenario("layout,old")

    def test_deformable_objects_have_a_panel_where_there_are_some(self):
        self.run_scenario("tissue")

    def test_voxel_volumes_have_a_panel_where_there_are_some(self):
        self.run_scenario("volume")

    def test_it_can_be_used_by_keyboard(self):
        self.run_scenario("keyboard")

    def test_it_can_be_used_by_touch(self):
        self.run_scenario("touch")

    def test_problems_and_commands_are_shown(self):
        self.run_scenario("surroundings", standin=(*FEW_PICTURES, "--problem", "the SCRIPT input queue 0x92f (2351) was taken"))

    def test_who_has_no_token_may_look(self):
        self.run_scenario("looking")

    def test_a_read_only_gateway_says_so(self):
        self.run_scenario("looking", standin=(*FEW_PICTURES, "--read-only"))


if __name__ == "__main__":
    unittest.main(verbosity=2)

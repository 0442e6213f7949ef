"""axe-core over the states of the page in 3D, by day and at night, large and small. Half a minute of computing: for
./check --peers (CELLMIRROR_PEERS); the states that other tests look at have it in a plain ./check too."""

import os
import unittest

import browser
from standin_test import StandIn


@unittest.skipUnless(os.environ.get("CELLMIRROR_PEERS"), "skipped: takes half a minute; ./check --peers runs it")
class Axe(unittest.TestCase):
    def test_axe_finds_nothing(self):
        browser.chromium(), browser.node(), browser.playwright_core()
        with StandIn("--robots", "3") as server:
            browser.Scenario("scene_axe", server.address).run()


if __name__ == "__main__":
    unittest.main(verbosity=2)

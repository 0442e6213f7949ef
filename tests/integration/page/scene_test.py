"""The 3D view of the monitor page, its charts and its links in headless Chromium, against the stand-in of the gateway."""

import unittest

import browser
from standin_test import FEW_PICTURES, StandIn


def setUpModule():
    browser.chromium(), browser.node(), browser.playwright_core()


class Scene(unittest.TestCase):
    def run_scenario(self, name, *arguments, standin=()):
        with StandIn(*standin, *FEW_PICTURES, "--poses-hz", "5") as server:
            return browser.Scenario(name, server.address, *arguments).run()

    def test_the_cell_is_drawn_in_three_dimensions(self):
        self.run_scenario("scene", standin=("--robots", "3"))

    def test_distances_are_measured_and_bodies_cut_in_three_dimensions(self):
        self.run_scenario("scene_tools", standin=("--robots", "3", "--still"))

    def test_tissue_moves_and_is_cut_in_three_dimensions(self):
        self.run_scenario("scene_tissue", standin=("--robots", "2", "--still", "--tissue", "--volumes", "1"))

    def test_what_is_old_does_not_look_new_in_three_dimensions(self):
        self.run_scenario("scene_old", standin=("--robots", "2"))

    def test_without_webgl_the_pictures_stay(self):
        self.run_scenario("scene_without_webgl", standin=("--robots", "2"))

    def test_a_recording_that_is_played_shows_where_something_happened(self):
        self.run_scenario("playback", standin=("--robots", "2", "--replay"))

    def test_alarms_are_acknowledged_by_name(self):
        self.run_scenario("alarms", standin=("--robots", "7"))

    def test_taking_offline_asks_first(self):
        self.run_scenario("offline")

    def test_charts_zoom_search_and_export(self):
        self.run_scenario("charts", standin=("--robots", "3"))

    def test_a_link_shows_the_same(self):
        self.run_scenario("link", standin=("--robots", "3"))


if __name__ == "__main__":
    unittest.main(verbosity=2)

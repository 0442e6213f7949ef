"""The stand-in of the monitor page without a browser: its flow of pictures, and that it never fails without a word."""

import argparse
import asyncio
import contextlib
import io
import os
import pathlib
import sys
import threading
import time
import unittest
from unittest import mock

SOURCE = pathlib.Path(os.environ.get("CELLMIRROR_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[3]))
sys.path[:0] = [str(SOURCE / "tests" / "support"), str(SOURCE / "tests" / "integration" / "web")]

import page_client
import page_standin
import standin_jpeg

SMALL = {"do": "picture", "width": 64, "height": 64}
GOOD = {"viewpoint_m": [6, -9, 5], "lookpoint_m": [4, 0, 0.8], "twist_rad": 0, "opening_angle_rad": 0.7}


class Running:
    """A stand-in in a thread of this process; the address as page_client wants it."""

    def __enter__(self):
        self.loop = asyncio.new_event_loop()
        self.server = page_standin.Server(argparse.Namespace(robots=3, joints=6, token="standin", read_only=False, problem=[], parts=0, triangles=0,
                                                                  still=False, replay=False, tissue=False, volumes=0, poses_hz=20, pictures_hz=15))
        self.listener = self.loop.run_until_complete(asyncio.start_server(self.server.answer, "127.0.0.1", 0))
        port = self.listener.sockets[0].getsockname()[1]
        self.thread = threading.Thread(target=self.loop.run_forever)
        self.thread.start()
        return page_client.Page({"address": f"http://127.0.0.1:{port}/", "token": "standin"})

    def __exit__(self, *_):
        self.loop.call_soon_threadsafe(self.listener.close)
        self.loop.call_soon_threadsafe(self.loop.stop)
        self.thread.join()
        tasks = asyncio.all_tasks(self.loop)  # they end since their client is gone
        if tasks:
            self.loop.run_until_complete(asyncio.wait(tasks, timeout=10))
        self.loop.close()


class StandIn(unittest.TestCase):
    def setUp(self):
        running = Running()
        self.page = running.__enter__()
        self.addCleanup(running.__exit__)
        self.live = page_client.Live(self.page)
        self.addCleanup(self.live.close)

    def picture(self):
        return page_client.picture_number(self.live.until(page_client.picture_number))

    def refused(self, **request):
        self.live.say(**{**SMALL, **request})
        return self.live.until_is("refused")["text"]

    def test_an_acknowledgement_that_two_newer_ones_overtook_does_not_end_the_pictures(self):
        self.live.say(**SMALL)
        self.assertEqual([self.picture(), self.picture()], [1, 2])
        self.live.say(do="shown", sequence=2)
        self.assertEqual(self.picture(), 3)
        # Before the next picture is due: the third is acknowledged, then the first.
        self.live.say(do="shown", sequence=3)
        self.live.say(do="shown", sequence=1)
        self.assertEqual(self.picture(), 4)
        self.assertEqual(self.picture(), 5)

    def test_no_more_than_two_pictures_are_under_way(self):
        self.live.say(**SMALL)
        self.assertEqual([self.picture(), self.picture()], [1, 2])
        self.live.say(do="shown", sequence=1000)  # never sent
        heard = [self.live.hear() for _ in range(5)]  # half a second of news
        self.assertEqual([page_client.picture_number(message) for message in heard], [None] * 5)

    def test_a_request_that_cannot_be_drawn_is_refused_and_the_pictures_go_on(self):
        self.live.say(**SMALL)
        self.assertEqual(self.picture(), 1)
        for place in ([None, 0, 0], [1e308, 0, 0], [float("nan"), 0, 0], [float("inf"), 0, 0], [0, 0], "far", GOOD["lookpoint_m"]):
            self.assertIn("free view", self.refused(free={**GOOD, "viewpoint_m": place}))
        self.assertIn("opening_angle", self.refused(free={**GOOD, "opening_angle_rad": 0}))
        self.assertIn("size", self.refused(width=0))
        self.assertIn("size", self.refused(width=1e9))
        self.assertIn("views", self.refused(view=7))
        for sequence in range(2, 6):
            self.live.say(do="shown", sequence=sequence - 1)
            self.assertEqual(self.picture(), sequence)

    def test_every_view_that_is_not_refused_can_be_drawn(self):
        cell = page_standin.Cell(3, 6)
        far, near, wide = [1e4, -1e4, 1e4], [4, 0, 0.8 + 2e-6], {**GOOD, "opening_angle_rad": 3.1}
        for view in (GOOD, {**GOOD, "viewpoint_m": far}, {**GOOD, "viewpoint_m": near}, wide, {**GOOD, "opening_angle_rad": 1e-3}):
            self.assertIsNone(standin_jpeg.why_not({**SMALL, "free": view}))
            self.assertTrue(standin_jpeg.picture(cell, {**SMALL, "free": view}).startswith(b"\xff\xd8"))

    def test_a_fault_of_its_own_ends_the_connection_and_is_printed(self):
        told = io.StringIO()
        with contextlib.redirect_stderr(told), mock.patch.object(standin_jpeg, "picture", side_effect=ZeroDivisionError("planted")):
            self.live.say(**SMALL)
            with self.assertRaises(ConnectionError):
                self.live.until(lambda _: False)
            end = time.monotonic() + 10
            while "planted" not in told.getvalue() and time.monotonic() < end:
                time.sleep(0.01)
        self.assertIn("ZeroDivisionError: planted", told.getvalue())


if __name__ == "__main__":
    unittest.main(verbosity=2)

"""Gateways that say strange things, and clients that want too much: bounded, and told as what it is."""

import os
import pathlib
import socket
import struct
import unittest

import bridge as b
import gateway as g
import standin as s

PAGE = os.sysconf("SC_PAGE_SIZE")


def resident_mb(process):
    pages = int(pathlib.Path(f"/proc/{process.child.pid}/statm").read_text().split()[1])
    return pages * PAGE / 1e6


class Hostile(unittest.TestCase):
    def setUp(self):
        self.scratch = g.Scratch()
        self.addCleanup(self.scratch.remove)

    def started(self, answer, *arguments, **more):
        self.gateway = s.Standin(self.scratch.runtime, self.scratch.instance, answer)
        self.addCleanup(self.gateway.close)
        bridge = b.Bridge(self.scratch, *arguments, **more)
        self.addCleanup(bridge.close)
        return bridge

    def devices(self, bridge):
        nodes = bridge.nodes()
        parent = f"ns=1;s={self.scratch.instance}.MotionDevices"
        return [nodes[child["id"]] for child in nodes[parent]["children"]]

    def test_names_of_any_kind(self):
        names = ["a/b", "a", "a.b", "a%2Fb", "ns=0;i=85", "Gr\u00f6\u00dfe", "\U0001f916", "<Axis>", "\u0000\n\u2028", "x" * 10_000, " ", "__proto__",
                 "constructor", "\ud800", "../../x", "1:Axes"]
        bridge = self.started(lambda: s.status([s.robot(name, joints=1) for name in names]))
        bridge.wait_for(f"answers: {len(names)} robots")
        devices = self.devices(bridge)
        self.assertEqual(len({one["id"] for one in devices}), len(names))
        shown = {one["name"].split("|", 1)[1] for one in devices}
        self.assertLess(max(len(name) for name in shown), 300)
        self.assertTrue({"a/b", "a", "a.b", "a%2Fb", "ns=0;i=85", "Gr\u00f6\u00dfe", "\U0001f916", "<Axis>", "__proto__", "constructor"} <= shown)

    def test_rubbish_instead_of_a_status(self):
        answers = iter([b"", b"{}\n", b"[]\n", b"null\n", b"\xff\xfe\n", b"{" * 100_000 + b"\n", b'{"robots": 7, "version": "1"}\n',
                        {"error": "no", "remedy": "yes"}, s.status([None, 7, {}, {"id": "R"}])])
        good = s.status([s.robot("R")])
        bridge = self.started(lambda: next(answers, good))
        bridge.wait_for("answers: 1 robots")
        self.assertTrue(g.eventually(lambda: self.gateway.requests > 12))
        bridge.wait_for("is not shown: the gateway's answer is not a status")
        self.assertEqual(len(self.devices(bridge)), 1)

    def test_robots_that_change_all_the_time(self):
        turn = {"number": 0}

        def answer():
            turn["number"] += 1
            kinds = [s.robot("A", joints=1 + turn["number"] % 7), s.robot(f"R{turn['number']}", joints=6), s.robot("same")]
            return s.status(kinds[turn["number"] % 3:])

        # 50 MB are in use without robots, and 0.3 MB by a robot: it would not live if they stayed.
        bridge = self.started(answer, "--period", "50", node_options="--max-old-space-size=80")
        self.assertTrue(g.eventually(lambda: turn["number"] > 300 or not bridge.running(), timeout=180), bridge.output())
        last = s.status([s.robot("B", joints=2)])
        self.gateway.answer = lambda: last
        self.assertTrue(g.eventually(lambda: [one["name"].split("|")[1] for one in self.devices(bridge)] == ["B"], every=0.2))
        self.assertTrue(bridge.running(), bridge.output())

    def test_more_robots_than_are_shown(self):
        many = s.status([s.robot(f"R{number}", joints=1) for number in range(300)])
        bridge = self.started(lambda: many)
        bridge.wait_for("answers: 256 robots")
        bridge.wait_for("44 robots or joints are left out")
        self.assertLess(resident_mb(bridge), 600)

    def test_sixty_robots_stay_within_bounds(self):
        many = s.status([s.robot(f"R{number}") for number in range(60)])
        bridge = self.started(lambda: many)
        bridge.wait_for("answers: 60 robots")
        self.assertTrue(g.eventually(lambda: self.gateway.requests > 30))
        self.assertLess(resident_mb(bridge), 400)

    def test_abandoned_sessions_lock_nobody_out(self):
        bridge = self.started(lambda: s.status([s.robot("R")]))
        bridge.wait_for("answers")
        self.assertEqual(bridge.ask("abandon", 25), {"made": 25})
        self.assertEqual(len(self.devices(bridge)), 1)
        self.assertIn("that was silent for the longest time is closed", bridge.output())

    def test_bytes_that_are_no_message(self):
        bridge = self.started(lambda: s.status([s.robot("R")]))
        bridge.wait_for("answers")
        hello = b"HELF" + struct.pack("<I", 32) + struct.pack("<IIIII", 0, 0, 0, 0, 0) + struct.pack("<i", -1)
        for data in (b"\x00" * 1000, b"GET / HTTP/1.1\r\n\r\n", b"HELF\xff\xff\xff\xff", b"HELF\x08\x00\x00\x00", hello + b"OPNF" + struct.pack("<I", 2**31),
                     hello + b"MSGF" + struct.pack("<I", 100) + b"\xff" * 92, hello + b"OPNF" + struct.pack("<II", 5000, 0) + b"\xff" * 4988):
            with socket.create_connection(("127.0.0.1", bridge.port), 60) as client:
                client.sendall(data)
                client.shutdown(socket.SHUT_WR)
                client.settimeout(60)
                try:
                    while client.recv(65536):
                        pass
                except ConnectionResetError:
                    pass
        waiting = [socket.create_connection(("127.0.0.1", bridge.port), 60) for _ in range(25)]
        for one in waiting:
            one.close()
        self.assertEqual(len(self.devices(bridge)), 1)


if __name__ == "__main__":
    b.main()

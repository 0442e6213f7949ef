"""A recording that is played: the same states as were recorded, seeks, the page's and Foxglove's controls, bad files."""

import json
import os
import pathlib
import socket
import struct
import subprocess
import unittest

import gateway as g
from foxglove_client import Foxglove, joint_state
from page_client import Live, Page

READER = r'''
my ($key) = @ARGV;
my $queue = msgget($key, 0); defined $queue or die "no queue: $!";
my $buffer;
defined msgrcv($queue, $buffer, 8192, 5, 0) or die $!;
print unpack("H*", substr($buffer, 8)), "\n";
'''


class Replay(g.OrderlyProcess):
    """`cellmirror replay`, paused and with the page, ready when the constructor returns."""

    def __init__(self, scratch, file, *arguments):
        self.scratch = scratch
        self.instance = "p" + os.urandom(6).hex()
        super().__init__([g.BIN / "cellmirror", "replay", file, "--headless", "--instance", self.instance, *arguments], scratch.environment)
        if not g.eventually(lambda: "Ctrl-C ends it" in self.output() or not self.running()) or not self.running():
            raise AssertionError(f"the replay did not start:\n{self.output()}")

    def status(self):
        return self.scratch.status(instance=self.instance)

    def ask(self, **members):
        """One request of the control socket."""
        path = next(self.scratch.runtime.glob(f"**/{self.instance}/control.sock"))
        with socket.socket(socket.AF_UNIX) as client:
            client.settimeout(60)
            client.connect(str(path))
            client.sendall(json.dumps(members).encode() + b"\n")
            answer = b""
            while not answer.endswith(b"\n"):
                more = client.recv(65536)
                if not more:
                    break
                answer += more
            return json.loads(answer)

    def seek(self, seconds):
        """Its status there."""
        self.ask(request="playback", seek_s=seconds)
        if not g.eventually(lambda: self.status()["replay"]["state"] != "seeking"):
            raise AssertionError(self.status()["replay"])
        return self.status()

    def page(self):
        done = self.scratch.cellmirror("page", "--json", "--instance", self.instance)
        return Page(json.loads(done.stdout))


def positions_of(status):
    """All joints by "robot/joint", in SI, as status prints them."""
    return {(robot["id"], joint["name"]): joint["position"] for robot in status["robots"] for joint in robot["joints"]}


def setUpModule():
    """One recording for all, in which a robot moves, and one gateway that plays it: each test seeks where it looks."""
    case = PlaybackCase
    case.scratch = scratch = g.Scratch()
    (scratch.home / "scripts" / "startup.spt").write_text("ROBOT PUMA_762 send_on;\nPOS_ROB MANTEC_R3 JOINT_INC 3;\n")
    case.file = scratch.root / "a.mcap"
    gateway = g.Gateway(scratch)
    try:
        recorder = g.Process([g.BIN / "cellmirror", "record", "-o", case.file, "--for", "2.5", "--instance", scratch.instance], scratch.environment)
        assert g.eventually(lambda: any(one["messages"] for one in scratch.status()["recordings"])), recorder.output()
        for command in ("ROBACT PUMA_762", "POS_ROB PUMA_762 JOINT_INC 20", "POS_ROB PUMA_762 JOINT_INC -20"):
            assert scratch.send(command).returncode == 0
        assert recorder.child.wait(60) == 0, recorder.output()
        recorder.close()
    finally:
        gateway.close()
    exported = scratch.cellmirror("recording", "export", str(case.file), "--topic", "/joint_states", "--json")
    case.states = json.loads(exported.stdout)["messages"]
    case.shared = Replay(scratch, case.file, "--paused", "--port", "0")  # with the page, as --port says


def tearDownModule():
    PlaybackCase.shared.close()
    PlaybackCase.scratch.remove()


class PlaybackCase(unittest.TestCase):
    def replay(self, *arguments, file=None):
        replay = Replay(self.scratch, file or self.file, *arguments)
        self.addCleanup(replay.close)
        return replay

    def recorded(self, message):
        """{robot/joint: position} of a recorded message."""
        names, n = {}, 0
        while f"name[{n}]" in message["values"]:
            names[message["values"][f"name[{n}]"]] = message["values"][f"position[{n}]"]
            n += 1
        return names


class States(PlaybackCase):
    def test_at_any_time_they_are_those_that_were_recorded(self):
        replay = self.shared
        status = replay.seek(0)
        self.assertEqual((status["replay"]["state"], status["recordings"], status["problems"]), ("paused", [], []))
        self.assertFalse([queue for queue in status["queues"] if "sensor" in queue["name"]], "nothing leaves it")
        before, begin = status["replay"]["seeks"], status["replay"]["now_ns"]
        different = {}
        for message in self.states:
            if 0 < 1e-9 * (message["publish_time_ns"] - begin) < status["replay"]["length_s"]:
                different.setdefault(tuple(self.recorded(message).values()), message)
        different = list(different.values())
        self.assertGreater(len(different), 10, "nothing moves in the recording")
        chosen = [different[(len(different) - 1) * share // 100] for share in (100, 10, 50, 10, 50, 75)]
        seen = {}
        for message in chosen:
            status = replay.seek(1e-9 * (message["publish_time_ns"] - begin))
            shown = sorted(positions_of(status).values())
            self.assertEqual(shown, sorted(self.recorded(message).values()), "to the bit")
            self.assertLess(abs(status["replay"]["now_ns"] - message["publish_time_ns"]), 2_000_000)
            seen.setdefault(message["publish_time_ns"], set()).add((str(shown), status["replay"]["now_ns"]))
        self.assertTrue(all(len(one) == 1 for one in seen.values()), "the same time, the same state")
        self.assertEqual(status["replay"]["seeks"] - before, len(chosen))

    def test_it_plays_to_the_end_and_ends(self):
        done = subprocess.run([g.BIN / "cellmirror", "replay", self.file, "--headless", "--speed", "10", "--instance", "p" + os.urandom(6).hex()],
                              env=self.scratch.environment, capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("is played from", done.stdout)

    def test_a_part_with_sensor_records_and_then_it_waits(self):
        replay = self.replay("--from", "1", "--to", "1.4", "--wait", "--publish")
        info = json.loads(next(self.scratch.runtime.glob(f"**/{replay.instance}/instance.json")).read_text())
        read = subprocess.run(["perl", "-e", READER, str(info.get("queues", info)["sensor_key"])], capture_output=True, text=True, timeout=60,
                              check=True)
        self.assertIn(b"PUMA_762", bytes.fromhex(read.stdout.strip()))
        self.assertTrue(g.eventually(lambda: replay.status()["replay"]["state"] == "ended"))
        report = replay.status()["replay"]
        self.assertLess(abs(report["length_s"] - 0.4), 0.2)
        self.assertEqual(report["position_s"], report["length_s"])


class Controls(PlaybackCase):
    def test_the_page_has_the_recorded_time_and_refuses_to_change_the_cell(self):
        replay = self.shared
        before = replay.seek(0)["replay"]["seeks"]
        page = replay.page()
        live = Live(page)
        self.addCleanup(live.close)
        first = live.until_is("live")
        self.assertEqual(first["replay"]["state"], "paused")
        self.assertLess(abs(first["time_s"] - 1e-9 * self.states[0]["publish_time_ns"]), 1)
        live.say(do="playback", seek_s=1.25, speed=0.5)
        moved = live.until(lambda m: isinstance(m, dict) and m.get("replay", {}).get("seeks") == before + 1 and m["replay"]["state"] == "paused")
        self.assertAlmostEqual(moved["replay"]["position_s"], 1.25, delta=0.01)
        self.assertEqual(moved["replay"]["speed"], 0.5)
        live.say(do="playback", play=True)
        live.until(lambda m: isinstance(m, dict) and m.get("replay", {}).get("position_s", 0) > 1.3)
        live.say(do="playback", play=False)
        live.say(do="playback", speed=1e9)
        self.assertIn("speed", json.dumps(live.until_is("refused")))
        for command in ("POS_ROB PUMA_762 JOINT_INC 5", "ROBOT PUMA_762 online", "EXEC_SCRIPT startup", "DELETE_NODE Puma"):
            status, body = page.command(command)
            self.assertIn("this is a replay", body, command)
        self.assertIn('"done":true', page.command("STDP 2")[1].replace(" ", ""))
        self.assertIn("takes no SCRIPT messages", self.scratch.send("STDP 1", instance=replay.instance).stderr)
        self.assertIn("recorded already", replay.ask(request="record", action="start", file="/tmp/x.mcap")["error"])

    def test_foxglove_controls_it(self):
        replay = self.shared
        replay.ask(request="playback", play=False, speed=1)
        replay.seek(0)
        client = Foxglove(replay.page(), "foxglove.sdk.v1")
        self.addCleanup(client.close)
        info = client.hear()
        self.assertIn("playbackControl", info["capabilities"])
        begin, end = (info[key]["sec"] * 10**9 + info[key]["nsec"] for key in ("dataStartTime", "dataEndTime"))
        self.assertGreater(end - begin, 1.5e9)
        told = client.until_binary(5)
        self.assertEqual(struct.unpack_from("<BQf", told, 1), (1, begin, 1.0), "paused at the begin")
        client.subscribe("/joint_states", 7)
        wanted = self.states[len(self.states) // 2]
        client.say_bytes(b"\x03\x01" + struct.pack("<fBQI", 0.5, 1, wanted["publish_time_ns"], 4) + b"seek")
        answer = client.until(lambda m: isinstance(m, bytes) and m[0] == 5 and m.endswith(b"seek"))
        self.assertEqual(struct.unpack_from("<fB", answer, 10), (0.5, 1))
        state = answer[1]  # the newest, which may come before the data

        def next_data():
            nonlocal state
            while True:
                message = client.until(lambda m: isinstance(m, bytes) and m[0] in (client.DATA, 5))
                if message[0] == client.DATA:
                    self.assertEqual(struct.unpack_from("<I", message, 1)[0], 7)
                    return struct.unpack_from("<Q", message, 5)[0], message[13:]
                state = message[1]
        time_ns, data = next_data()
        while time_ns + 2_000_000 < wanted["publish_time_ns"]:
            time_ns, data = next_data()
        self.assertLess(abs(time_ns - wanted["publish_time_ns"]), 2_000_000)
        self.assertEqual(sorted(joint_state(data)[1].values()), sorted(self.recorded(wanted).values()))
        if state != 1:
            client.until(lambda m: isinstance(m, bytes) and m[0] == 5 and m[1] == 1)
        client.say_bytes(b"\x03\x00" + struct.pack("<fBQI", 10, 0, 0, 4) + b"play")
        client.until(lambda m: isinstance(m, bytes) and m[0] == 5 and m[1] == 3)
        shown = client.until_binary(2)
        self.assertLess(abs(struct.unpack_from("<Q", shown, 1)[0] - end), 10_000_000, "the time that clients are told")
        for bad in (b"\x03", b"\x03\x07" + bytes(17), b"\x03\x00" + struct.pack("<fBQI", -1, 0, 0, 0)):
            client.say_bytes(bad)
            client.until_op("status")


def listening_at(port):
    """Returns the local addresses, in hexadecimal, of all listeners on this TCP port."""
    found = []
    for table in ("/proc/net/tcp", "/proc/net/tcp6"):
        for line in pathlib.Path(table).read_text().splitlines()[1:]:
            local, state = line.split()[1], line.split()[3]
            if state == "0A" and int(local.rsplit(":", 1)[1], 16) == port:
                found.append(local.rsplit(":", 1)[0])
    return found


class StrangersFile(unittest.TestCase):
    """Recordings from a stranger: a cell file that opens the page to every machine, and a path on this machine."""

    def setUp(self):
        self.scratch = g.Scratch()
        self.addCleanup(self.scratch.remove)

    def record(self, *arguments):
        file = self.scratch.root / "stranger.mcap"
        gateway = g.Gateway(self.scratch)
        self.addCleanup(gateway.close)
        done = self.scratch.cellmirror("record", "-o", str(file), "--for", "1", "--instance", self.scratch.instance, *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        gateway.close()
        return file

    def test_replay_ignores_the_web_table_of_the_recording(self):
        with self.scratch.cell_file.open("a") as cell:
            # Disabled, so that the gateway that records does not listen there.
            cell.write('\n[web]\nenabled = false\naddress = "0.0.0.0"\nallow_remote = true\nport = 28431\norigins = ["https://evil.example"]\n')
        checked = self.scratch.cellmirror("check", str(self.scratch.cell_file))
        self.assertIn("is reachable from other machines", checked.stdout + checked.stderr)
        self.assertIn("pages of https://evil.example", checked.stdout + checked.stderr)
        replay = Replay(self.scratch, self.record(), "--paused", "--page")
        self.addCleanup(replay.close)
        page = replay.page()
        self.assertNotEqual(page.port, 28431, "the port of the recording")
        self.assertEqual(listening_at(page.port), ["0100007F"], "on loopback alone")
        self.assertEqual(replay.status()["page"]["listens_on"], "127.0.0.1")
        self.assertEqual(page.ask("/api/status")[0], 200)
        self.assertEqual(page.ask("/api/status", headers={"Origin": "https://evil.example"})[0], 403)
        self.assertEqual(page.ask("/api/status", headers={"Host": "evil.example"})[0], 421)

    def test_replay_does_not_open_a_path_from_the_recording(self):
        file = self.record("--attach-mb", "0")
        self.assertTrue(self.scratch.cell_file.is_file(), "the file that the recording names is there")
        for arguments in (("--headless",), ("--cell", str(self.scratch.cell_file))):
            refused = self.scratch.cellmirror("replay", str(file), *arguments)
            self.assertEqual(refused.returncode, 1, refused.stdout)
            self.assertIn("name the cell file with --recorded-cell", refused.stderr)
            self.assertIn(str(self.scratch.cell_file), refused.stderr, "the message gives the recorded path")
        instance = "p" + os.urandom(6).hex()
        named = self.scratch.cellmirror("replay", str(file), "--headless", "--speed", "10", "--instance", instance, "--recorded-cell",
                                        str(self.scratch.cell_file))
        self.assertEqual(named.returncode, 0, named.stderr)


class BadFiles(PlaybackCase):
    def refused(self, file, *arguments):
        done = self.scratch.cellmirror("replay", str(file), "--headless", *arguments)
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        return done.stderr

    def test_what_cannot_be_played_is_refused_with_the_reason(self):
        data = self.file.read_bytes()
        other = self.scratch.root / "other.mcap"
        other.write_bytes(b"no recording")
        self.assertIn("no MCAP file", self.refused(other))
        other.write_bytes(data[:4000])
        self.assertIn("/inputs/ticks", self.refused(other))
        self.assertIn("nothing is recorded", self.refused(self.file, "--from", "1000"))

    def test_a_file_that_was_cut_off_is_played_as_far_as_it_goes(self):
        data = self.file.read_bytes()
        cut = self.scratch.root / "cut.mcap"
        info = json.loads(self.scratch.cellmirror("recording", "info", str(self.file), "--json").stdout)
        messages = len(data) - sum(one["bytes"] for one in info["attachments"])  # bytes after the files of the cell
        cut.write_bytes(data[:len(data) - messages // 4])
        replay = self.replay("--paused", "--wait", file=cut)
        self.assertIn("was not ended in order", replay.output())
        length = replay.status()["replay"]["length_s"]
        self.assertGreater(length, 0.5)
        self.assertTrue(positions_of(replay.seek(length / 2)))

    def test_noise_in_the_middle_ends_nothing_but_the_playing(self):
        data = bytearray(self.file.read_bytes())
        for at in range(len(data) // 2, len(data) // 2 + 2000):
            data[at] ^= 0x5A
        noisy = self.scratch.root / "noisy.mcap"
        noisy.write_bytes(data)
        done = self.scratch.cellmirror("replay", str(noisy), "--headless", "--speed", "10", "--instance", "p" + os.urandom(6).hex())
        self.assertIn(done.returncode, (0, 1), done.stderr)
        self.assertTrue(done.returncode == 0 or done.stderr, "refused without a reason")


if __name__ == "__main__":
    unittest.main(verbosity=2)

"""`replay` on recordings of the running gateway: each tick again to the bit, killed gateways, other builds, other cells."""

import json
import struct
import unittest

import gateway as g
import mcap_structure
from recording_test import RecordingCase


def ticks_of(recording):
    """(tick, commands done) of each, out of /inputs/ticks by docs/recording.md."""
    out = []
    for topic, *_, data in recording.messages:
        at = 1
        while topic == "/inputs/ticks" and at < len(data):
            kind, length = struct.unpack_from("<BI", data, at)
            at += 5 + length
            if kind == 5:
                # cycle, times of waking and of the slot, missed, period, last computing; then commands
                out.append((struct.unpack_from("<Q", data, at - length)[0], struct.unpack_from("<Q", data, at - length + 48)[0]))
    return out


class ReplayCase(RecordingCase):
    def verify(self, file, *arguments, code=0):
        done = self.scratch.cellmirror("replay", str(file), "--verify", "--json", *arguments)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return json.loads(done.stdout) if done.stdout else done.stderr

    def simulator(self):
        """A drive for each joint of a robot; the robot follows it."""
        simulator = g.sim_robot("cia402", "--channel", "udp:239.74.163.2:43113", "--nodes", "1-6", "--rate", "100", "--motion",
                                "sine:amplitude=0.3,period=2")
        self.addCleanup(simulator.close)
        self.assertEqual(self.scratch.send("ROBOT MANTEC_R3 online").returncode, 0)
        self.assertTrue(g.eventually(lambda: self.scratch.robot("MANTEC_R3")["stream"]["state"] == "fresh"))

    def move(self):
        for command in ("ROBACT PUMA_762", "POS_ROB PUMA_762 JOINT_INC 5", "POS_ROB PUMA_762 JOINT_INC -5"):
            self.assertEqual(self.scratch.send(command).returncode, 0)


class Verify(ReplayCase):
    def test_a_run_with_streams_and_moves_is_equal_to_the_bit(self):
        self.start()
        self.simulator()
        recorder = self.begin("a.mcap", "--for", "3", "--compression", "none")
        self.move()
        self.assertEqual(recorder.child.wait(60), 0, recorder.output())
        file = self.scratch.root / "a.mcap"
        report = self.verify(file)
        self.assertTrue(report["equal"], report)
        self.assertGreater(report["recorded_s"], 0.5)
        self.assertEqual((report["gaps"], report["not_sound"], report["lost_messages"]), (0, 0, 0), report)
        self.assertEqual(self.info("a.mcap")["gateway"]["cell_file"], str(self.scratch.cell_file))
        commands = json.loads(self.recording("export", str(file), "--topic", "/cellmirror/commands", "--json").stdout)["messages"]
        self.assertTrue(all(one["values"]["tick"] > 0 for one in commands), commands)
        # Each move was carried out by a tick of the recording, before the one in which its end was known.
        ticks = ticks_of(mcap_structure.Recording(file.read_bytes()))
        self.assertEqual([tick for tick, _ in ticks], sorted({tick for tick, _ in ticks}))
        moves = [one["values"] for one in commands if one["values"]["command"].startswith("POS_ROB")]
        self.assertEqual(len(moves), 2)
        for move in moves:
            carried_out = next(tick for tick, done in ticks if done >= move["loop_command"])
            self.assertLess(carried_out, move["tick"])
        # Another instruction set is refused, unless that is asked for. Metadata are outside of chunks, without a CRC.
        data = file.read_bytes()
        other = self.scratch.root / "other.mcap"
        for word in (b"avx2", b"baseline"):
            data = data.replace(b"target" + len(word).to_bytes(4, "little") + word, b"target" + len(word).to_bytes(4, "little") + b"z" * len(word))
        other.write_bytes(data)
        self.assertIn("instructions", self.verify(other, code=1))
        self.assertIn("instructions", self.verify(other, "--force")["other_build"])
        # The same cell again: nothing differs.
        done = self.scratch.cellmirror("replay", str(file), "--cell", str(self.scratch.cell_file), "--to", "0.3", "--json", timeout=200)
        self.assertEqual(done.returncode, 0, done.stderr)
        comparison = json.loads(done.stdout)
        self.assertEqual(comparison["differences"], [])
        self.assertEqual(comparison["changed_files"], [])
        self.assertGreater(comparison["postures"], 5)

    def test_of_a_killed_gateway_and_recovered(self):
        gateway = self.start()
        self.begin("a.mcap")
        self.move()
        self.assertTrue(g.eventually(lambda: self.recordings()[0]["duration_s"] > 2))
        gateway.kill()
        self.recording("recover", str(self.scratch.root / "a.mcap"), "-o", str(self.scratch.root / "b.mcap"))
        for name in ("a.mcap", "b.mcap"):
            report = self.verify(self.scratch.root / name)
            self.assertTrue(report["equal"], report)
            self.assertGreater(report["recorded_s"], 0.5)
        self.assertEqual(self.start().stop(), 0)  # the next one takes the queues over, and removes them

    def test_each_file_of_the_black_box_can_be_run(self):
        self.scratch.cell_file.write_text(self.scratch.cell_file.read_text() + "\n[record]\nlength_s = 60\nfile_s = 1\n")
        gateway = self.start()
        self.move()
        self.assertTrue(g.eventually(lambda: self.recordings()[0]["files"] > 3))
        self.assertIn(self.scratch.status()["loop"]["allocations"], (0, None))
        gateway.stop()
        files = sorted((self.scratch.home / "records").glob("blackbox-*.mcap"))
        for file in files[:3]:
            report = self.verify(file)
            self.assertTrue(report["equal"], report)
            self.assertGreater(report["recorded_s"], 0.1)

    def test_recordings_beside_a_black_box_begin_with_a_start_state_each(self):
        self.scratch.cell_file.write_text(self.scratch.cell_file.read_text() + "\n[record]\nfile_s = 60\n")
        self.start()
        for number in (1, 2):
            # A machine that stands still for that second leaves no time for a start state; it does not each time.
            for attempt in range(8):
                file = self.scratch.root / f"{number}-{attempt}.mcap"
                self.record(file.name, "--attach-mb", "0", seconds="0.8")
                done = self.scratch.cellmirror("replay", str(file), "--verify", "--json")
                report = json.loads(done.stdout)
                if report["starts"]:
                    break
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            self.assertGreater(report["recorded_s"], 0.1, report)

    def test_without_inputs_there_is_nothing_to_verify(self):
        self.start()
        self.record("a.mcap", "--topics", "/joint_states", seconds="0.5")
        self.assertIn("/inputs/ticks", self.verify(self.scratch.root / "a.mcap", code=1))
        self.assertEqual(self.scratch.cellmirror("replay", str(self.scratch.root / "a.mcap"), "--verify", "--page").returncode, 2)


if __name__ == "__main__":
    unittest.main(verbosity=2)

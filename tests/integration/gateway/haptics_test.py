"""Haptic devices on the running gateway: a device moves its instrument and feels what the instrument touches; whatever
goes wrong takes the force away until it is reset."""

import ctypes
import json
import math
import pathlib
import struct
import sys
import time
import unittest

import gateway as g
import haptic_device as h

HERE = pathlib.Path(__file__).resolve().parent
# From the tip of LAP_LEFT at the start straight on: the direction of the shaft.
INTO = (math.sin(2.4) * math.cos(0.56), math.sin(2.4) * math.sin(0.56), math.cos(2.4))
DEEP = 0.09  # m along it: the organ begins after some 75 mm


def reset(test, scratch):
    """Once the device writes sound samples again."""
    last = []

    def done():
        last[:] = [scratch.send("RESET_HAPTIC LAP_LEFT")]
        return last[0].returncode == 0

    test.assertTrue(g.eventually(done), last)


class Trainer(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = h.trainer()
        cls.gateway = g.Gateway(cls.scratch)
        cls.device = h.Device(cls.scratch.keys["LAP_LEFT"])

    @classmethod
    def tearDownClass(cls):
        status = cls.gateway.stop()
        cls.device.close()
        cls.gateway.close()
        cls.scratch.remove()
        assert status == 0, f"the gateway ended with {status}"

    def setUp(self):
        self.device.good, self.device.silent, self.device.corrupt, self.device.buttons = True, False, None, 0
        self.device.go((0, 0, 0))
        if self.haptic()["phase"] == "faulted":
            reset(self, self.scratch)
        self.active()

    def done(self, command):
        done = self.scratch.send(command)
        self.assertEqual(done.returncode, 0, f"{command}: {done.stderr}")

    def refused(self, command, *words):
        done = self.scratch.send(command)
        self.assertEqual(done.returncode, 1, f"{command}: {done.stdout}")
        for word in words:
            self.assertIn(word, done.stderr)

    def haptic(self, robot="LAP_LEFT"):
        devices = self.scratch.status()["haptics"]["devices"]
        return next(device for device in devices if device["robot"] == robot)

    def active(self, robot="LAP_LEFT"):
        found = g.eventually(lambda: self.haptic(robot)["phase"] == "active")
        self.assertTrue(found, self.haptic(robot))

    def touch(self):
        self.device.go([DEEP * x for x in INTO])
        return g.eventually(lambda: h.norm(self.device.force()["force_device"]) > 0.5 and self.device.force())

    def faulted(self, fault):
        """Waits for it; the force is zero, and the fault stays."""
        found = g.eventually(lambda: self.haptic()["fault"] == fault and self.haptic())
        self.assertTrue(found, self.haptic())
        self.assertEqual(found["phase"], "faulted")
        self.assertNotEqual(found["fault_note"], "")
        self.assertNotEqual(found["remedy"], "")
        force = self.device.force()
        self.assertEqual(force["force_device"], (0.0, 0.0, 0.0))
        self.assertEqual(force["force"], (0.0, 0.0, 0.0))
        self.assertEqual(force["fault"], h.memory_of.FAULTS.index(fault))

    def recovers(self):
        time.sleep(0.05)
        self.assertEqual(self.haptic()["phase"], "faulted")  # latched, though the cause is gone
        reset(self, self.scratch)
        self.active()


class Moving(Trainer):
    def test_the_tip_follows_the_hand(self):
        before = self.scratch.robot("LAP_LEFT")["tcp"]["position_m"]
        self.device.go((0.01, -0.005, 0.02))

        def there():
            robot = self.scratch.robot("LAP_LEFT")
            moved = [a - b for a, b in zip(robot["tcp"]["position_m"], before)]
            return all(abs(m - t) < 1e-5 for m, t in zip(moved, self.device.target)) and robot

        robot = g.eventually(there)
        self.assertTrue(robot, self.scratch.robot("LAP_LEFT")["tcp"])
        self.assertEqual(robot["mode"], "mirrored")
        self.assertEqual(robot["stream"]["kind"], "haptic")
        self.assertEqual({joint["state"] for joint in robot["joints"]}, {"fresh"})

    def test_the_clutch_lets_the_hand_move_alone(self):
        self.device.buttons = 1
        self.assertTrue(g.eventually(lambda: self.haptic()["phase"] == "clutched"))
        before = self.scratch.robot("LAP_LEFT")["tcp"]["position_m"]
        self.device.go((0.02, 0, 0))
        after = self.scratch.robot("LAP_LEFT")["tcp"]["position_m"]
        self.assertLess(h.norm([a - b for a, b in zip(after, before)]), 1e-6)
        self.device.go((0, 0, 0))
        self.device.buttons = 0
        self.active()

    def test_the_gripper_moves_the_jaw(self):
        self.device.gripper = 0.3
        jaw = lambda: next(j for j in self.scratch.robot("LAP_LEFT")["joints"] if j["name"] == "JAW")["position"]
        self.assertTrue(g.eventually(lambda: abs(jaw() - 0.3) < 1e-6), jaw())
        self.device.gripper = 0.0

    def verified_from_here(self):
        """What is recorded now runs again to the bit, with the forces of the devices that are open already."""
        # A machine that stands still meanwhile leaves no time for a start state; it does not each time.
        for attempt in range(8):
            file = self.scratch.root / f"{attempt}.mcap"
            done = self.scratch.cellmirror("record", "-o", str(file), "--for", "0.7", "--attach-mb", "0", "--topics", "/inputs/ticks",
                                           "--instance", self.scratch.instance)
            self.assertEqual(done.returncode, 0, done.stderr)
            done = self.scratch.cellmirror("replay", str(file), "--verify", "--json")
            report = json.loads(done.stdout)
            if report["starts"]:
                break
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual((report["not_compared"], report["not_sound"]), ([], 0), report)
        self.assertGreater(report["ticks"], 10)

    def test_what_it_touches_pushes_back(self):
        self.assertLess(h.norm(self.device.force()["force_device"]), 0.3)
        appeared = self.haptic()["contact_model"]["appeared"]
        force = self.touch()
        self.assertTrue(force, self.haptic())
        self.assertLess(h.dot(force["force_device"], INTO), -0.5)
        self.assertLessEqual(h.norm(force["force_device"]), 8.0 + 1e-6)
        # The plain values of 1999 say the same in the end-effector frame.
        self.assertAlmostEqual(h.norm(force["force"]), h.norm(force["force_device"]), places=3)
        state = self.haptic()
        self.assertGreaterEqual(state["force"]["contacts"], 1)
        depth = h.norm([a - b for a, b in zip(state["device_position_m"], state["proxy_position_m"])])
        self.assertGreater(depth, 0.001)
        self.assertEqual(self.scratch.status()["collisions"]["touching_count"], 0)  # the tip stays outside
        self.verified_from_here()
        self.device.go((0, 0, 0))
        self.assertTrue(g.eventually(lambda: h.norm(self.device.force()["force_device"]) < 0.05))
        self.assertEqual(self.haptic()["contact_model"]["appeared"], appeared)  # what stands still is always felt

    def largest_force(self, duration):
        end = time.monotonic() + duration
        largest = 0.0
        while time.monotonic() < end:
            largest = max(largest, h.norm(self.device.force()["force_device"]))
        return largest

    def test_a_body_that_is_put_onto_the_tip_does_not_push(self):
        self.done("SET_FRAME Phantom PLACEMENT 0 0 0 " + " ".join(f"{-1000 * DEEP * x:.1f}" for x in INTO))
        self.assertLess(self.largest_force(1.0), 0.2)  # the planes of a bent surface differ by some 10 um
        state = self.haptic()
        self.assertGreaterEqual(state["contact_model"]["appeared"], 1)
        self.assertIn(state["phase"], ("engaging", "active"))
        away = h.norm([a - b for a, b in zip(state["device_position_m"], state["proxy_position_m"])])
        self.assertGreater(away, 0.005)  # the instrument has gone out of it
        self.done("SET_FRAME Phantom PLACEMENT 0 0 0 0 0 0")
        self.active()

    def test_a_hand_that_is_inside_when_it_goes_online_is_not_pushed(self):
        self.done("ROBOT LAP_LEFT offline")
        self.device.go([DEEP * x for x in INTO])
        self.done("ROBOT LAP_LEFT online")
        self.assertLess(self.largest_force(1.0), 0.2)
        self.assertNotEqual(self.haptic()["phase"], "waiting")
        self.assertTrue(g.eventually(lambda: self.haptic()["force"]["contacts"] >= 1), self.haptic())
        self.device.go((0, 0, 0))

    def test_the_loop_takes_no_memory_and_tells_its_latency(self):
        status = self.scratch.status()
        self.assertIn(status["loop"]["allocations"], (0, None))
        self.assertGreater(self.haptic()["latency_us"]["count"], 0)
        stream = next(robot["stream"] for robot in status["robots"] if robot["id"] == "LAP_LEFT")
        self.assertGreater(stream["rate_hz"], 10, stream)  # told at the first question too
        self.assertGreater(status["haptics"]["contact_models"]["rate_hz"], 0)


class Faults(Trainer):
    def setUp(self):
        super().setUp()
        self.assertTrue(self.touch(), self.haptic())

    def test_silence(self):
        self.device.silent = True
        self.faulted("stale")
        self.refused("RESET_HAPTIC LAP_LEFT", "stays in fault")
        self.device.silent = False
        self.recovers()

    def test_values_that_are_no_numbers(self):
        self.device.corrupt = (h.NAN, 0, 0)
        self.faulted("not_finite")
        self.refused("RESET_HAPTIC LAP_LEFT", "stays in fault")
        self.device.corrupt = None
        self.recovers()

    def test_the_device_says_that_it_is_not_well(self):
        self.device.good = False
        self.faulted("invalid")
        self.device.good = True
        self.recovers()

    def test_a_leap(self):
        self.device.corrupt = (0.2, 0.2, 0.2)
        self.faulted("jump")
        self.device.corrupt = None
        time.sleep(0.1)
        self.recovers()

    def test_another_process_writes_too(self):
        other = g.Process([sys.executable, HERE / "haptic_device.py", self.scratch.keys["LAP_LEFT"]])
        try:
            self.faulted("two_writers")
        finally:
            other.close()
        time.sleep(0.2)
        self.recovers()

    def test_a_write_that_does_not_end(self):
        self.device.silent = True
        time.sleep(0.02)  # the write under way ends
        words = self.device.memory._words
        words[h.memory_of.DEVICE_LOCK // 8] |= 1
        found = g.eventually(lambda: self.haptic()["phase"] == "faulted")
        self.assertTrue(found, self.haptic())
        self.assertIn(self.haptic()["fault"], ("torn", "stale"))
        self.assertEqual(self.device.force()["force_device"], (0.0, 0.0, 0.0))
        self.device.silent = False
        self.recovers()


class Processes(unittest.TestCase):
    def setUp(self):
        self.scratch = h.trainer()
        self.gateway = g.Gateway(self.scratch)
        self.children = []

    def tearDown(self):
        for child in self.children:
            child.close()
        self.gateway.close()
        self.scratch.remove()

    def start_device(self, robot="LAP_LEFT"):
        child = g.Process([sys.executable, HERE / "haptic_device.py", self.scratch.keys[robot]])
        self.children.append(child)
        return child

    def haptic(self, robot="LAP_LEFT"):
        return next(d for d in self.scratch.status()["haptics"]["devices"] if d["robot"] == robot)

    def wait_for(self, phase, robot="LAP_LEFT"):
        self.assertTrue(g.eventually(lambda: self.haptic(robot)["phase"] == phase), self.haptic(robot))

    def test_a_device_that_dies_and_comes_back(self):
        self.wait_for("waiting")
        first = self.start_device()
        self.wait_for("active")
        first.kill()
        self.wait_for("faulted")
        self.assertTrue(g.eventually(lambda: self.haptic()["device"]["gone"]), self.haptic())
        self.assertIn(self.haptic()["fault"], ("stale", "vanished"))
        refused = self.scratch.send("RESET_HAPTIC LAP_LEFT")
        self.assertEqual(refused.returncode, 1, refused.stdout)
        self.start_device()
        self.assertTrue(g.eventually(lambda: not self.haptic()["device"]["gone"]), self.haptic())
        reset(self, self.scratch)
        self.wait_for("active")

    def test_a_gateway_that_is_killed_and_one_that_ends(self):
        device = h.Device(self.scratch.keys["LAP_LEFT"])
        self.wait_for("active")
        self.gateway.kill()
        last = device.force()
        self.gateway.close()
        time.sleep(0.05)
        self.assertEqual(device.force()["time_ns"], last["time_ns"])  # its age tells the device
        self.gateway = g.Gateway(self.scratch)
        self.wait_for("active")  # the same memory: the device goes on without attaching anew
        self.assertGreater(device.force()["time_ns"], last["time_ns"])
        self.assertEqual(self.gateway.stop(), 0)
        end = device.force()
        self.assertEqual((end["gateway"], end["force_device"], end["force"]), (0, (0.0,) * 3, (0.0,) * 3))
        self.assertTrue(device.memory.removed())
        device.close()

    def test_a_memory_that_somebody_removes(self):
        first = h.Device(self.scratch.keys["LAP_LEFT"])
        self.wait_for("active")
        libc = ctypes.CDLL(None, use_errno=True)
        self.assertEqual(libc.shmctl(first.memory._id, 0, None), 0)  # IPC_RMID: what ipcrm does, and log-out
        self.assertTrue(g.eventually(lambda: self.haptic()["memory"]["renewed"] == 1), self.haptic())
        self.wait_for("faulted")
        self.assertTrue(first.memory.removed())
        first.close()
        second = h.Device(self.scratch.keys["LAP_LEFT"])
        self.assertTrue(g.eventually(lambda: not self.haptic()["device"]["gone"]), self.haptic())
        reset(self, self.scratch)
        self.wait_for("active")
        second.close()

    def test_a_memory_too_small_for_samples(self):
        key = self.scratch.keys["LAP_LEFT"] + 2
        for command in ("ROBACT LAP_LEFT", f"rob_ela_shm 0 {key} 16"):
            done = self.scratch.send(command)
            self.assertEqual(done.returncode, 0, done.stderr)
        memory = h.attach(key, 16)
        self.assertEqual(struct.unpack("<3f", ctypes.string_at(memory._address, 12)), (0.0, 0.0, 0.0))
        # A buffer beside the memory of the device, which stays.
        self.assertEqual(self.haptic()["memory"]["key"], self.scratch.keys["LAP_LEFT"])
        memory.detach()
        same = self.scratch.send(f"rob_ela_shm 0 {self.scratch.keys['LAP_LEFT']} 28")
        self.assertEqual(same.returncode, 0, same.stderr)
        self.assertIn("begin with these values", same.stdout)
        self.assertEqual(self.haptic()["memory"]["bytes"], 512)
        other = self.scratch.send(f"rob_ela_shm 0 {self.scratch.keys['LAP_RIGHT']} 28")
        self.assertEqual(other.returncode, 1, other.stdout)
        self.assertIn("LAP_RIGHT", other.stderr)

    def test_a_key_that_another_gateway_has(self):
        other = g.Scratch("phantom_trainer")
        try:
            other.cell_file.write_text(self.scratch.cell_file.read_text())
            other.environment = self.scratch.environment
            second = g.Gateway(other, wait=False)
            self.assertTrue(g.eventually(lambda: not second.running()))
            self.assertEqual(second.child.returncode, 1)
            self.assertIn(self.scratch.instance, second.output())
            second.close()
        finally:
            other.remove()

    def test_a_fault_outlives_a_change_of_its_instrument(self):
        device = h.Device(self.scratch.keys["LAP_LEFT"])
        self.wait_for("active")
        device.silent = True
        self.wait_for("faulted")
        device.silent = False
        for command in ("ROBACT LAP_LEFT", "rob_tcp_def 0 0 5 0 0 0"):
            done = self.scratch.send(command)
            self.assertEqual(done.returncode, 0, done.stderr)
        time.sleep(0.2)
        self.assertEqual((self.haptic()["phase"], self.haptic()["fault"]), ("faulted", "stale"))
        reset(self, self.scratch)
        self.wait_for("active")
        self.assertEqual(self.haptic()["resets"], 1)
        device.close()

    def test_two_devices_at_once(self):
        self.start_device("LAP_LEFT")
        self.start_device("LAP_RIGHT")
        self.wait_for("active", "LAP_LEFT")
        self.wait_for("active", "LAP_RIGHT")
        robots = {robot["id"]: robot for robot in self.scratch.status()["robots"]}
        self.assertEqual({robots[r]["stream"]["state"] for r in ("LAP_LEFT", "LAP_RIGHT")}, {"fresh"})

    def test_offline_takes_the_device_off_and_online_brings_it_back(self):
        self.start_device()
        self.wait_for("active")
        for command, phase in (("ROBOT LAP_LEFT offline", "closed"), ("ROBOT LAP_LEFT online", "active")):
            done = self.scratch.send(command)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.wait_for(phase)

    def test_an_instrument_that_is_taken_away_and_brought_back(self):
        self.start_device()
        self.wait_for("active")
        refused = self.scratch.send("DELETE_NODE Left")
        self.assertEqual(refused.returncode, 1, refused.stdout)
        self.assertIn("ROBOT LAP_LEFT offline first", refused.stderr)
        for command in ("ROBOT LAP_LEFT offline", "DELETE_NODE Left", "ACTIVATE Left", "ROBOT LAP_LEFT online"):
            done = self.scratch.send(command)
            self.assertEqual(done.returncode, 0, f"{command}: {done.stderr}")
        self.wait_for("active")

    def test_changes_of_the_cell_do_not_stop_the_force(self):
        self.start_device()
        self.wait_for("active")
        for command in ("ACTIVATE LampCutting", "DEACTIVATE LampCutting", "DEACTIVATE Phantom", "ACTIVATE Phantom",
                        "SET_FRAME LampCutting PLACEMENT 0 0 400 0 0 0"):
            self.scratch.send(command)
            time.sleep(0.05)
        self.assertEqual(self.haptic()["phase"], "active")
        self.assertGreater(self.scratch.status()["haptics"]["contact_models"]["adopting_us"]["count"], 1)

    def test_another_memory(self):
        key = self.scratch.keys["LAP_LEFT"] + 2
        for command in ("ROBACT LAP_LEFT", f"rob_ela_shm 0 {key} 512"):
            done = self.scratch.send(command)
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.haptic()["memory"]["key"], key)
        device = h.Device(key)
        self.wait_for("active")
        device.close()
        for command, word in ((f"rob_ela_shm 0 {key} 8", "bytes"),
                              (f"rob_ela_shm 0 {self.scratch.keys['LAP_RIGHT']} 512", "LAP_RIGHT")):
            refused = self.scratch.send(command)
            self.assertEqual(refused.returncode, 1, refused.stdout)
            self.assertIn(word, refused.stderr)


class ForceAtTheTcp(unittest.TestCase):
    """The memory 1313, here under a key of its own, and read as in 1999: four float32 and nothing else."""

    @classmethod
    def setUpClass(cls):
        cls.scratch = h.trainer()
        cls.gateway = g.Gateway(cls.scratch)

    @classmethod
    def tearDownClass(cls):
        cls.gateway.close()
        cls.scratch.remove()

    def done(self, command):
        done = self.scratch.send(command)
        self.assertEqual(done.returncode, 0, f"{command}: {done.stderr}")

    def tcp_force(self):
        return self.scratch.status()["haptics"]["tcp_force"]

    def test_test_values_reach_a_plain_reader(self):
        self.done("SET_EXT_TCP_TEST on 1.5 -2 3.25 0.125")
        memory = h.attach(self.tcp_force()["key"], 16)
        plain = lambda: struct.unpack("<4f", ctypes.string_at(memory._address, 16))
        self.assertTrue(g.eventually(lambda: plain() == (1.5, -2.0, 3.25, 0.125)), plain())
        self.assertTrue(self.tcp_force()["test"])
        self.done("SET_EXT_TCP_TEST off 0 0 0 0")
        self.assertTrue(g.eventually(lambda: plain() == (0.0, 0.0, 0.0, 0.0)), plain())
        memory.detach()

    def test_limits_warn(self):
        self.done("ROBACT LAP_LEFT")
        self.done("SET_TORQUE_LIMIT 5 0")
        self.done("SET_EXT_TCP_TEST on 0 0 4 9")
        self.assertFalse(self.tcp_force()["beyond_limit"])
        self.done("SET_EXT_TCP_TEST on 0 0 6 0")
        self.assertTrue(g.eventually(lambda: self.tcp_force()["beyond_limit"]), self.tcp_force())
        told = lambda: [m for m in self.scratch.status()["messages"] if "limits" in m["text"]]
        self.assertTrue(g.eventually(told))
        self.done("SET_TORQUE_LIMIT 0 0")
        self.assertTrue(g.eventually(lambda: not self.tcp_force()["beyond_limit"]), self.tcp_force())
        self.done("SET_EXT_TCP_TEST off 0 0 0 0")


if __name__ == "__main__":
    g.main()

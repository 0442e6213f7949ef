"""System calls of the tick's thread in a running gateway, while it mirrors robots, moves one and serves a haptic device:
the sleep between two cycles and nothing else."""

import pathlib
import re
import shutil
import signal
import subprocess
import time
import unittest

import gateway as g
import haptic_device as h

SECONDS = 3.0
CAN_ROBOT = "MANTEC_R3"  # CiA 402 over udp multicast in the transfer cell
DDS_ROBOT = "PUMA_762"   # JointState in the transfer cell
PUMA_JOINTS = ",".join(f"puma_762_joint_{i}" for i in range(1, 7))
# What the tick may call, and why.
ALLOWED = {
    "clock_nanosleep": "the sleep between two cycles",
    "restart_syscall": "the same, where strace has interrupted it",
}
# Clock sources that the kernel lets user space read; others make clock_gettime() a system call.
READABLE = ("tsc", "kvm-clock", "hyperv_clocksource_tsc_page", "arch_sys_counter")


def thread_of(process, name):
    """The kernel's number of the thread of that name."""
    for task in pathlib.Path(f"/proc/{process}/task").iterdir():
        if (task / "comm").read_text().strip() == name:
            return int(task.name)
    raise AssertionError(f"process {process} has no thread {name}")


def system_calls(thread, seconds):
    """Name -> how often, of one thread."""
    strace = subprocess.Popen(["strace", "-p", str(thread), "-o", "/dev/stdout"], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True)
    try:
        time.sleep(seconds)
        strace.send_signal(signal.SIGINT)
        lines, messages = strace.communicate(timeout=60)
    finally:
        strace.kill()
        strace.wait()
    if "attached" not in messages:
        raise unittest.SkipTest(f"skipped: no thread can be traced here: {messages.strip()}")
    counts = {}
    for line in lines.splitlines():
        match = re.match(r"(\w+)\(", line)
        if match:
            counts[match[1]] = counts.get(match[1], 0) + 1
    return counts


class SystemCalls(unittest.TestCase):
    def setUp(self):
        if not shutil.which("strace"):
            self.skipTest("skipped: no strace")
        self.processes = []
        self.allowed = dict(ALLOWED)
        source = pathlib.Path("/sys/devices/system/clocksource/clocksource0/current_clocksource").read_text().strip()
        if source not in READABLE:
            self.allowed["clock_gettime"] = f"the clock source {source} is none that user space can read"

    def tearDown(self):
        for process in reversed(self.processes):
            process.close()

    def start(self, scratch):
        self.addCleanup(scratch.remove)
        gateway = g.Gateway(scratch)
        self.processes.append(gateway)
        return gateway

    def expect_only_sleeps(self, scratch, gateway):
        before = scratch.status()["loop"]
        counts = system_calls(thread_of(gateway.child.pid, "tick"), SECONDS)
        after = scratch.status()["loop"]
        others = {name: count for name, count in counts.items() if name not in self.allowed}
        self.assertEqual(others, {}, "the tick may call what ALLOWED lists")
        # Of 1,000 a second: strace slows the loop down, and others may have the processor.
        self.assertGreater(counts["clock_nanosleep"], 100, counts)
        self.assertGreater(after["ticks"] - before["ticks"], 100)

    def test_mirrored_and_moving_robots(self):
        scratch = g.Scratch()
        gateway = self.start(scratch)
        motion = ("--rate", "100", "--motion", "sine:amplitude=0.3,period=2")
        self.processes.append(g.sim_robot("cia402", "--channel", "udp:239.74.163.2:43113", "--nodes", "1-6", *motion))
        self.processes.append(g.sim_robot("dds", "--joint-names", PUMA_JOINTS, *motion))
        for robot in (CAN_ROBOT, DDS_ROBOT):
            self.assertEqual(scratch.send(f"ROBOT {robot} online").returncode, 0)
            fresh = g.eventually(lambda robot=robot: scratch.robot(robot)["stream"]["state"] == "fresh")
            self.assertTrue(fresh, scratch.robot(robot)["stream"])
        self.assertEqual(scratch.send("MOVE_ROB MANTEC_RM3 PTP JOINT_INC 20").returncode, 0)
        self.expect_only_sleeps(scratch, gateway)
        # The method sees what there is: the thread of a stream waits for frames.
        waits = set()

        def both():
            waits.update(system_calls(thread_of(gateway.child.pid, "can"), 1.0))
            return {"ppoll", "recvmmsg"} <= waits

        self.assertTrue(g.eventually(both), waits)

    def test_haptic_device(self):
        scratch = h.trainer()
        gateway = self.start(scratch)
        device = h.Device(scratch.keys["LAP_LEFT"])
        self.processes.append(device)

        def phase():
            devices = scratch.status()["haptics"]["devices"]
            return next(device for device in devices if device["robot"] == "LAP_LEFT")["phase"]

        self.assertTrue(g.eventually(lambda: phase() == "active"), phase())
        self.expect_only_sleeps(scratch, gateway)


if __name__ == "__main__":
    g.main()

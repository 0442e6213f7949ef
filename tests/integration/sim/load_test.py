"""Can sim_robot generate the load that the gateway is measured with, and what does that cost? Counts are exact; the limits for
missed periods and processor time leave room for a busy machine, and CELLMIRROR_LOAD_SECONDS makes the run longer."""

import os
import resource
import sys
import time
import unittest

import sim_robot_process as process

SECONDS = float(os.environ.get("CELLMIRROR_LOAD_SECONDS", "4"))
SANITIZED = "asan" in str(process.BIN) or "tsan" in str(process.BIN)


class Load(unittest.TestCase):
    def run_load(self, *arguments):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        begin = time.monotonic()
        robot = process.SimRobot(*arguments, "--for", SECONDS, "--json", "--no-input", "--quiet")
        self.addCleanup(robot.close)
        status, report, errors = robot.finish(None, timeout=SECONDS + 60)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.assertEqual(status, 0, errors)
        cpu = (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime) / (time.monotonic() - begin)
        channels = report["channels"]
        latest = max(channel["latest_start_s"] for channel in channels)
        print(f"{arguments[0]}: {report['sent']['sample'] / SECONDS:.0f} samples/s, {100 * cpu:.1f} % of a core, "
              f"latest start {1e3 * latest:.2f} ms, peak memory {after.ru_maxrss / 1024:.0f} MB", file=sys.stderr)
        self.assertEqual(report["refused"], 0)
        self.assertGreater(report["sent"]["sample"], 0)
        return report, cpu

    def test_32_robots_of_7_joints_at_500_hz_on_dds(self):
        report, cpu = self.run_load("dds", "--domain", 77, "--topic", "rt/load", "--robots", 32, "--joints", 7, "--rate", 500)
        # Every robot has the same count: a period that is missed is missed by all.
        self.assertEqual(len(set(report["channels"][0]["samples_of_robot"])), 1)
        wanted = 16000 * SECONDS
        self.assertLessEqual(report["sent"]["sample"], wanted + 32)
        if not SANITIZED:
            missed = 32 * report["channels"][0]["missed_periods"]
            self.assertAlmostEqual(report["sent"]["sample"] + missed, wanted, delta=64)
            self.assertLess(cpu, 0.75)

    def test_16000_frames_a_second_of_can_over_udp(self):
        group, port = process.group_of_its_own()
        report, cpu = self.run_load("cia402", "--channel", f"udp:{group}:{port}", "--robots", 16, "--nodes", "1-2", "--rate",
                                    500, "--self-starting", "--heartbeat", 0)
        self.assertLessEqual(report["sent"]["sample"], 16000 * SECONDS + 64)
        if not SANITIZED:
            self.assertLess(cpu, 0.75)


if __name__ == "__main__":
    unittest.main(verbosity=2)

"""Runs sim_robot for integration tests. Standard library only; every process is ended by the test that started it."""

import json
import os
import pathlib
import random
import signal
import socket
import subprocess
import time

SOURCE = pathlib.Path(os.environ.get("CELLMIRROR_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[3]))
BIN = pathlib.Path(os.environ.get("CELLMIRROR_BIN_DIR", SOURCE / "build" / "bin"))


def eventually(condition, timeout=60.0, every=0.01):
    """The first true value of condition(), or its last value after the timeout."""
    end = time.monotonic() + timeout
    while True:
        value = condition()
        if value or time.monotonic() > end:
            return value
        time.sleep(every)


def group_of_its_own():
    """A multicast group and port that no other test on this machine is likely to use."""
    lot = random.SystemRandom()
    return f"239.75.{lot.randrange(1, 255)}.{lot.randrange(1, 255)}", lot.randrange(20000, 60000)


class SimRobot:
    def __init__(self, *arguments, program="sim_robot"):
        self.child = subprocess.Popen([str(BIN / program), *map(str, arguments)], stdin=subprocess.PIPE,
                                      stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def tell(self, line):
        self.child.stdin.write(line + "\n")
        self.child.stdin.flush()

    def answer(self):
        """The next line on standard error."""
        return self.child.stderr.readline().strip()

    def finish(self, how=signal.SIGINT, timeout=60):
        """Ends it; its exit status, report and standard error."""
        if how is not None and self.child.poll() is None:
            self.child.send_signal(how)
        out, err = self.child.communicate(timeout=timeout)
        return self.child.returncode, json.loads(out) if out.strip() else None, err

    def close(self):
        if self.child.poll() is None:
            self.child.kill()
        self.child.communicate()


def run(*arguments, stdin=subprocess.DEVNULL, timeout=60):
    return subprocess.run([str(BIN / "sim_robot"), *map(str, arguments)], stdin=stdin, capture_output=True, text=True,
                          timeout=timeout)


class ControlSocket:
    def __init__(self, path):
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.settimeout(60)

        def connected():
            try:
                self.socket.connect(str(path))
                return True
            except OSError:
                return False

        if not eventually(connected):
            raise AssertionError(f"nobody serves {path}")
        self.lines = self.socket.makefile("r")

    def ask(self, line):
        self.socket.sendall((line + "\n").encode())
        return self.lines.readline().strip()

    def close(self):
        self.lines.close()
        self.socket.close()

"""Runs the real programs for integration tests. Standard library only; every process is ended by the one who started it.

A test module is a unittest module that runs as `python3 module.py`; programs are found in $CELLMIRROR_BIN_DIR.
"""

import contextlib
import json
import os
import pathlib
import random
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import uuid

import control

SOURCE = pathlib.Path(os.environ.get("CELLMIRROR_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
BIN = pathlib.Path(os.environ.get("CELLMIRROR_BIN_DIR", SOURCE / "build" / "bin"))
CELLS = SOURCE / "config" / "cells"
STEP_S = 0.02  # between two steps of a test: nobody who starts the program for each is faster
# For what comes, however busy the machine is: it may be five times slower, and stand still for a second or two.
PATIENCE_S = 60


@contextlib.contextmanager
def sub_test(case, **parameters):
    """case.subTest(), which also runs at its end what was added as a cleanup inside, so that a failed sub-test leaves no
    gateway in the way of the next one."""
    outer, case._cleanups = case._cleanups, []
    try:
        with case.subTest(**parameters):
            try:
                yield
            finally:
                case.doCleanups()
    finally:
        case._cleanups = outer


def eventually(condition, timeout=PATIENCE_S, every=0.05):
    """The first true value of condition(), or its last value after the timeout. What is expected not to come needs a short timeout."""
    end = time.monotonic() + timeout
    while True:
        value = condition()
        if value or time.monotonic() > end:
            return value
        time.sleep(every)


def free_port():
    """A TCP port on the loopback interface that nobody uses, below those that the kernel gives to clients (ip(7),
    ip_local_port_range): it stays free until somebody takes it by its number."""
    while True:
        port = random.SystemRandom().randrange(15000, 32000)
        with socket.socket() as probe:
            try:
                probe.bind(("127.0.0.1", port))
            except OSError:
                continue
        return port


class Scratch:
    """A folder with a copy of a cell, and a runtime folder of its own, so that tests never meet another gateway.

    The cell's startup script is emptied unless `startup` is true: nothing is online or sending by itself."""

    def __init__(self, cell="transfer_cell", startup=False):
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="cellmirror-test-"))
        self.runtime = self.root / "runtime"
        self.runtime.mkdir(mode=0o700)
        self.home = self.root / "cell"
        # Not the records that a gateway may have left in the cell of the tree.
        shutil.copytree(CELLS / cell, self.home, ignore=shutil.ignore_patterns("records"))
        self.cell_file = self.home / "cell.toml"
        if not startup:
            (self.home / "scripts" / "startup.spt").write_text("# empty for tests\n")
        self.instance = "t" + uuid.uuid4().hex[:12]
        self.environment = dict(os.environ, CELLMIRROR_RUNTIME_DIR=str(self.runtime))
        self.environment.pop("kis_home", None)

    def remove(self):
        shutil.rmtree(self.root, ignore_errors=True)

    def cellmirror(self, *arguments, timeout=120, instance=None):
        """Runs the program to its end; the completed process."""
        command = [str(BIN / "cellmirror"), *arguments]
        if instance is not False and arguments and arguments[0] in ("fault", "send", "status"):
            command += ["--instance", instance or self.instance]
        return subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=timeout)

    # Each start of the program costs 25 ms of processor time, and tests send and ask thousands of times: these two do what it
    # does without it. What they cannot do, and tests of the command line, start it.

    def send(self, command, timeout=PATIENCE_S, instance=None):
        """As `cellmirror send COMMAND`; the completed process."""
        time.sleep(STEP_S)
        try:
            done, text = control.send(self.gateway_folder(instance), command, timeout)
        except control.NoGateway:
            return self.cellmirror("send", command, timeout=timeout, instance=instance)
        except control.NoAnswer as failure:
            return subprocess.CompletedProcess(["send", command], 1, "", f"cellmirror: {failure}\n")
        if done:
            return subprocess.CompletedProcess(["send", command], 0, f"done {text}\n" if text else "done\n", "")
        return subprocess.CompletedProcess(["send", command], 1, "", f"cellmirror: refused: {text}\n")

    def status(self, timeout=PATIENCE_S, instance=None):
        """The document of `cellmirror status --json`."""
        time.sleep(STEP_S)
        try:
            return control.ask(self.gateway_folder(instance), timeout, request="status")
        except control.NoGateway:
            done = self.cellmirror("status", "--json", timeout=timeout, instance=instance)
            if done.returncode != 0:
                raise AssertionError(f"status failed: {done.stderr}") from None
            return json.loads(done.stdout)

    def gateway_folder(self, instance=None):
        """Where the gateway of that name has its socket."""
        return self.runtime / (instance or self.instance)

    def robot(self, robot_id):
        return next(robot for robot in self.status()["robots"] if robot["id"] == robot_id)


class Process:
    """A child in the background; its output goes to a file that error messages show."""

    def __init__(self, command, environment=None, log=None, stdin=None):
        self.log = open(log or tempfile.mktemp(prefix="cellmirror-log-"), "w+b")
        self.child = subprocess.Popen(
            [str(part) for part in command], env=environment, stdout=self.log, stderr=subprocess.STDOUT,
            stdin=subprocess.PIPE if stdin else subprocess.DEVNULL)

    def output(self):
        self.log.flush()
        with open(self.log.name, "rb") as file:
            return file.read().decode(errors="replace")

    def tell(self, line):
        """A line on the standard input of one that was made with `stdin`."""
        self.child.stdin.write(line.encode() + b"\n")
        self.child.stdin.flush()

    def running(self):
        return self.child.poll() is None

    def kill(self):
        if self.running():
            self.child.kill()
        self.child.wait()

    def stop(self, timeout=PATIENCE_S):
        """Ends it as Ctrl-C would; its exit status."""
        if self.running():
            self.child.send_signal(signal.SIGINT)
        try:
            return self.child.wait(timeout)
        except subprocess.TimeoutExpired:
            self.kill()
            raise AssertionError(f"did not end within {timeout} s:\n{self.output()}") from None

    def close(self):
        self.kill()
        if self.child.stdin:
            self.child.stdin.close()
        self.log.close()
        pathlib.Path(self.log.name).unlink(missing_ok=True)


class OrderlyProcess(Process):
    """Ended by SIGTERM, so that its queues and folders go with it: only a killed one leaves them for its next start."""

    def close(self):
        if self.running():
            self.child.terminate()
            try:
                self.child.wait(PATIENCE_S)
            except subprocess.TimeoutExpired:
                pass
        super().close()


class Gateway(OrderlyProcess):
    """A running gateway on a scratch cell, ready to be asked when the constructor returns."""

    def __init__(self, scratch, *arguments, instance=None, wait=True, pictures=False, page=False):
        self.scratch = scratch
        self.instance = instance or scratch.instance
        super().__init__(
            [BIN / "cellmirror", "run", scratch.cell_file, *(["--port", "0"] if page else ["--no-web"]),
             *([] if pictures else ["--headless"]),
             "--instance", self.instance, *arguments], scratch.environment)
        if wait:
            self.wait_ready()

    def wait_ready(self, timeout=PATIENCE_S):
        def ready():
            if not self.running():
                raise AssertionError(f"the gateway ended with {self.child.returncode}:\n{self.output()}")
            return "Ctrl-C ends it" in self.output()

        if not eventually(ready, timeout):
            raise AssertionError(f"the gateway did not start:\n{self.output()}")


def sim_robot(*arguments, environment=None):
    return Process([BIN / "sim_robot", *arguments], environment, stdin=True)


def require(path, why):
    """For setUpModule: skips the module visibly where a program is missing."""
    import unittest
    if shutil.which(str(path)) is None:
        raise unittest.SkipTest(f"skipped: {why}")


def main():
    import unittest
    unittest.main(module="__main__", verbosity=2, argv=sys.argv)

"""Runs the console blocks of Markdown pages and compares their output, so that the pages stay true.

A block is run when the line before it is a comment:

    <!-- tested: NAME -->             the commands run one after the other in one shell, in the source root
    <!-- tested: NAME, eventually --> the same, repeated until the output is as shown, a minute at most
    <!-- tested: NAME, background --> one command that goes on running; at the end of the page it gets Ctrl-C and has to end
                                      with status 0
    <!-- tested: NAME, background in FOLDER -->   the same in a folder below the source root

In the block, a line that begins with `$ ` is a command (a following line that begins with `> ` belongs to it), what
follows is its output. `...` in a line stands for any text, a line of nothing but `...` for any lines. `[exit N]` as the
last line of an output is the expected exit status; without it 0 is expected.

Arguments: source root, folder of the programs, pages. Exit status: 1 where a block failed, 77 where the programs are not
there.
"""

import contextlib
import ctypes
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

BLOCK = re.compile(r"^<!-- tested: (?P<name>[^,>]+?)(?:, (?P<mode>eventually|background)(?: in (?P<folder>[^ >]+))?)? -->\s*\n```console\n(?P<body>.*?)^```",
                   re.MULTILINE | re.DOTALL)
COMMAND_SECONDS = 120
EVENTUALLY_SECONDS = 60


@dataclass
class Step:
    command: str
    expected: list[str]
    status: int


def steps_of(body: str) -> list[Step]:
    steps: list[Step] = []
    for line in body.splitlines():
        if line.startswith("$ "):
            steps.append(Step(line[2:], [], 0))
        elif not steps:
            raise ValueError(f"output before the first command: {line}")
        elif line.startswith("> ") and not steps[-1].expected:
            steps[-1].command += "\n" + line[2:]
        elif match := re.fullmatch(r"\[exit (\d+)\]", line):
            steps[-1].status = int(match[1])
        else:
            steps[-1].expected.append(line.rstrip())
    return steps


def matches(expected: list[str], output: str) -> bool:
    pattern = ""
    for line in expected:
        if line.strip() == "...":
            pattern += r"(?:[^\n]*\n)*?"
        else:
            pattern += "[^\n]*".join(re.escape(part) for part in line.split("...")) + r"[ \t]*\n"
    lines = "".join(line.rstrip() + "\n" for line in output.splitlines())
    return re.fullmatch(pattern, lines) is not None


class Shell:
    """One bash that keeps its variables and folder from command to command."""

    def __init__(self, root: Path, environment: dict[str, str]):
        self.process = subprocess.Popen(["bash", "--norc"], cwd=root, env=environment, stdin=subprocess.PIPE, text=True,
                                        start_new_session=True)
        self.results = tempfile.TemporaryDirectory()

    def run(self, command: str) -> tuple[int, str]:
        output, status = Path(self.results.name, "output"), Path(self.results.name, "status")
        status.unlink(missing_ok=True)
        script = Path(self.results.name, "command")
        script.write_text(command + "\n")
        self.process.stdin.write(f". '{script}' >'{output}' 2>&1 </dev/null; echo $? >'{status}.new'; mv '{status}.new' '{status}'\n")
        self.process.stdin.flush()
        end = time.monotonic() + COMMAND_SECONDS
        while not status.exists():
            if time.monotonic() > end or self.process.poll() is not None:
                return 124, output.read_text(errors="replace") + f"\n(not ended after {COMMAND_SECONDS} s)"
            time.sleep(0.01)
        return int(status.read_text()), output.read_text(errors="replace")

    def close(self) -> None:
        self.process.stdin.close()
        self.process.wait()
        # What the page has left running, where one of its commands failed.
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self.process.pid, signal.SIGKILL)
        self.results.cleanup()


class Background:
    def __init__(self, command: str, root: Path, environment: dict[str, str]):
        self.command = command
        self.log = tempfile.NamedTemporaryFile(mode="w+")
        self.process = subprocess.Popen(["bash", "--norc", "-c", f"exec {command}"], cwd=root, env=environment, stdin=subprocess.DEVNULL,
                                        stdout=self.log, stderr=subprocess.STDOUT, start_new_session=True)

    def output(self) -> str:
        return Path(self.log.name).read_text(errors="replace")

    def shows(self, expected: list[str]) -> bool:
        end = time.monotonic() + COMMAND_SECONDS
        while not matches(expected + ["..."], self.output()):
            if time.monotonic() > end or self.process.poll() is not None:
                return matches(expected + ["..."], self.output())
            time.sleep(0.05)
        return True

    def stop(self) -> int:
        """Ctrl-C reaches every process of the terminal's group."""
        if self.process.poll() is None:
            os.killpg(self.process.pid, signal.SIGINT)
        try:
            return self.process.wait(60)
        except subprocess.TimeoutExpired:
            os.killpg(self.process.pid, signal.SIGKILL)
            return self.process.wait()


def complain(place: str, step: Step, status: int, output: str) -> bool:
    expected = "\n".join("    " + line for line in step.expected)
    got = "\n".join("    " + line for line in output.splitlines()[-80:])
    print(f"{place}: $ {step.command}\n  expected (status {step.status}):\n{expected}\n  got (status {status}):\n{got}")
    return False


def run_step(shell: Shell, step: Step, eventually: bool) -> tuple[bool, int, str]:
    end = time.monotonic() + (EVENTUALLY_SECONDS if eventually else 0)
    while True:
        status, output = shell.run(step.command)
        good = status == step.status and matches(step.expected, output)
        if good or time.monotonic() >= end:
            return good, status, output
        time.sleep(0.1)


def run_page(page: Path, root: Path, environment: dict[str, str]) -> tuple[int, bool]:
    """The number of commands that ran, and whether all were as told."""
    text = page.read_text()
    shell, backgrounds, count, good = Shell(root, environment), [], 0, True
    try:
        for block in BLOCK.finditer(text):
            place = f"{page.name}:{text.count(chr(10), 0, block.start()) + 1} ({block['name']})"
            for step in steps_of(block["body"]):
                count += 1
                if block["mode"] == "background":
                    backgrounds.append(Background(step.command, root / (block["folder"] or "."), environment))
                    if not backgrounds[-1].shows(step.expected):
                        return count, complain(place, step, backgrounds[-1].process.poll() or 0, backgrounds[-1].output())
                    continue
                step_good, status, output = run_step(shell, step, block["mode"] == "eventually")
                if not step_good:
                    return count, complain(place, step, status, output)
    finally:
        shell.close()
        for background in backgrounds:
            status = background.stop()
            if status != 0:
                print(f"{page.name}: {background.command} ended with status {status} after Ctrl-C\n{background.output()[-4000:]}")
                good = False
    return count, good


def move_into_own_namespaces() -> None:
    """Queues and a loopback network of our own where that is allowed (as root), so that no gateway and no robot that run
    on this machine show up in the output."""
    clone_newipc, clone_newnet = 0x08000000, 0x40000000
    if os.geteuid() != 0 or ctypes.CDLL(None, use_errno=True).unshare(clone_newipc | clone_newnet) != 0:
        return
    for command in ("ip link set lo up", "ip link set lo multicast on", "ip route add 224.0.0.0/4 dev lo"):
        subprocess.run(command.split(), check=True)


def main() -> int:
    root, programs = Path(sys.argv[1]), Path(sys.argv[2])
    if not (programs / "cellmirror").exists():
        print("skipped: the program cellmirror is not built here")
        return 77
    environment = os.environ | {"PATH": f"{programs}:{os.environ['PATH']}", "TERM": "dumb", "LC_ALL": "C.UTF-8", "COLUMNS": "120"}
    move_into_own_namespaces()
    runtime = tempfile.TemporaryDirectory()
    environment["CELLMIRROR_RUNTIME_DIR"] = runtime.name
    total = 0
    for page in sys.argv[3:]:
        count, good = run_page(Path(page), root, environment)
        if not good:
            return 1
        if count == 0:
            print(f"{page}: no block is marked as tested")
            return 1
        total += count
    print(f"{total} documented commands do what the pages say")
    return 0


if __name__ == "__main__":
    sys.exit(main())

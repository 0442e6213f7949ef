"""The phantom trainer cell for tests: shared memories of this run's own, and simulated hands and feet."""

import csv
import json
import os
import pathlib
import re
import subprocess
import uuid

import gateway as g
from shared_memory import unused_key

# Where the tips of the two instruments stand at the start (insertion 0.12 m), and the direction of their shafts.
LEFT = {"tip": (-0.0413, -0.0169, 0.1115), "into": "0.5722,0.3587,-0.7374"}
RIGHT = {"tip": (0.0413, -0.0169, 0.1115), "into": "-0.5722,0.3587,-0.7374"}

# Ordinary machines are late at times; a test of faults is not to find others than it makes.
# What is latched is to stay, so that they see it.
PATIENT = """
profile = "strict"
stale_after_s = 0.03
model_stale_after_s = 10.0
allowed_missed_periods = 5000
"""

# Where nothing is to go wrong: the machine may stand still for a second or two.
UNDISTURBED = """
profile = "strict"
stale_after_s = 5.0
model_stale_after_s = 10.0
allowed_missed_periods = 5000
"""


def _table(text, drive, key, more):
    """A table [[haptic]] of the cell with another drive and key; `more` takes the place of what it says of the same."""
    replaced = {"shm_key", "online"} | set(re.findall(r"^(\w+) *=", more, re.M)) | ({"drive", "xyz_m"} if drive == "joints" else set())
    kept = [line for line in text.splitlines() if line.split("=")[0].strip() not in replaced]
    return "\n".join(kept) + f"\nshm_key = {key}\nonline = true\n" + ('drive = "joints"\n' if drive == "joints" else "") + more + "\n"


def with_own_memories(scratch, drives=("pose", "pose"), more=PATIENT):
    """Gives the scratch cell's haptic devices and foot switches keys of this run's own; the keys by name. `more`: further
    keys of [[haptic]]."""
    keys = {"LAP_LEFT": unused_key(), "LAP_RIGHT": unused_key(), "switches": unused_key()}
    drive_of = dict(zip(("LAP_LEFT", "LAP_RIGHT"), drives))

    def own(match):
        robot = re.search(r'^robot *= *"(\w+)"', match[0], re.M)[1]
        return _table(match[0], drive_of[robot], keys[robot], more)

    text = scratch.cell_file.read_text()
    # A table ends where the next one begins.
    text, devices = re.subn(r"(?ms)^\[\[haptic\]\]$.*?(?=^\[|\Z)", own, text)
    text = re.sub(r"(?ms)^\[foot_switches\]$.*?(?=^\[|\Z)", "", text)
    if devices != 2:
        raise AssertionError(f"the phantom trainer cell has {devices} haptic devices")
    text += f"\n[foot_switches]\nkey = {keys['switches']}\nbytes = 1\ndebounce_s = 0.01\nonline = true\n"
    scratch.cell_file.write_text(text)
    return keys


def haptic(scratch, robot):
    devices = scratch.status()["haptics"]["devices"]
    return next(device for device in devices if device["robot"] == robot)


class Sim:
    """A simulator in the background whose summary is wanted at its end."""

    def __init__(self, program, *arguments):
        self.child = subprocess.Popen([str(g.BIN / program), *map(str, arguments), "--json", "-q"], stdout=subprocess.PIPE,
                                      stderr=subprocess.PIPE, text=True)

    def finish(self, timeout=120, killed=False):
        """The summary; nothing where it was to be killed."""
        out, err = self.child.communicate(timeout=timeout)
        if killed:
            if self.child.returncode != -9:
                raise AssertionError(f"was to be killed, ended with {self.child.returncode}: {err}")
            return None
        if self.child.returncode != 0:
            raise AssertionError(f"ended with {self.child.returncode}: {err}")
        return json.loads(out)

    def kill(self):
        if self.child.poll() is None:
            self.child.kill()
        self.child.communicate()


class Hand(Sim):
    """A simulated hand that is told what to do while it runs."""

    def __init__(self, scratch, key, *arguments, seconds=120):
        self.fifo = scratch.root / f"hand-{key}-{uuid.uuid4().hex[:8]}"
        os.mkfifo(self.fifo)
        super().__init__("sim_haptic", "--key", key, "--priority", 60, "--for", seconds, "--control", self.fifo, *arguments)

    def say(self, line):
        with open(self.fifo, "w", encoding="ascii") as fifo:
            fifo.write(line + "\n")


def sim_haptic(key, *arguments):
    return Sim("sim_haptic", "--key", key, "--priority", 60, *arguments)


def sim_footswitch(key, *arguments):
    return Sim("sim_footswitch", "--key", key, "--priority", 60, *arguments)


def rows(path):
    """A log as a list of dictionaries of numbers."""
    with open(pathlib.Path(path), newline="", encoding="ascii") as file:
        return [{name: float(value) if "." in value or "e" in value or "n" in value else int(value)
                 for name, value in row.items()} for row in csv.DictReader(file)]

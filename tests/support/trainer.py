"""The trainer cell for tests: shared memories of this run's own, and simulated hands and feet."""

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
LEFT = {"tip": (-0.0413, -0.0170, 0.1115), "into": "0.5722,0.3587,-0.7374"}
RIGHT = {"tip": (0.0413, -0.0170, 0.1115), "into": "-0.5722,0.3587,-0.7374"}

# Ordinary machines are late at times; a test of faults is not to find others than it makes.
PATIENT = """
stale_after_s = 0.03
model_stale_after_s = 10.0
allowed_missed_periods = 500
"""


def with_own_memories(scratch, drives=("pose", "joints"), more=PATIENT):
    """Rewrites the scratch cell's haptic devices and foot switches; the keys by name. `more`: further keys of [[haptic]]."""
    keys = {"LAP_LEFT": unused_key(), "LAP_RIGHT": unused_key(), "switches": unused_key()}
    text = scratch.cell_file.read_text()
    # A table ends where the next one begins.
    text = re.sub(r"(?ms)^\[\[?(haptic|foot_switches)\]\]?$.*?(?=^\[|\Z)", "", text)
    for robot, place, drive in (("LAP_LEFT", LEFT, drives[0]), ("LAP_RIGHT", RIGHT, drives[1])):
        text += f'\n[[haptic]]\nrobot = "{robot}"\ndrive = "{drive}"\ngripper_joint = "JAW"\nshm_key = {keys[robot]}\nonline = true\n'
        if drive == "pose":
            text += f"xyz_m = {list(place['tip'])}\n"
        text += more
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

    def finish(self, timeout=60, killed=False):
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

    def __init__(self, scratch, key, *arguments):
        self.fifo = scratch.root / f"hand-{key}-{uuid.uuid4().hex[:8]}"
        os.mkfifo(self.fifo)
        super().__init__("sim_haptic", "--key", key, "--priority", 60, "--for", 120, "--control", self.fifo, *arguments)

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

"""A haptic device for tests: a thread that writes a pose a thousand times a second, as docs/examples show it."""

import importlib.util
import math
import os
import re
import threading
import time
import uuid

import gateway as g

_spec = importlib.util.spec_from_file_location(
    "cellmirror_memory", g.SOURCE / "docs" / "examples" / "cellmirror_memory.py")
memory_of = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(memory_of)

PERIOD = 0.001
NAN = float("nan")


def trainer(replace=(), guards=True):
    """A scratch copy of the phantom trainer cell with memories of its own, and with guards so wide that a machine that is busy
    with other things does not trip them. Keys by robot in `keys`."""
    scratch = g.Scratch("phantom_trainer")
    text = scratch.cell_file.read_text()
    first = 0x43500000 + int(uuid.uuid4().hex[:4], 16) * 4
    scratch.keys = {"LAP_LEFT": first, "LAP_RIGHT": first + 1}
    for robot, key in scratch.keys.items():
        wide = "\nprofile = \"strict\"\nstale_after_s = 2.5\nmodel_stale_after_s = 10.0\nallowed_missed_periods = 5000" if guards else ""
        text, count = re.subn(rf'(robot = "{robot}"\n)shm_key = \w+', rf"\g<1>shm_key = {key}{wide}", text)
        assert count == 1, f"{robot} has no shm_key in the phantom trainer cell"
    text = re.sub(r"(\[foot_switches\]\nkey = )\w+", rf"\g<1>{first + 3}", text)
    for old, new in replace:
        assert old in text, old
        text = text.replace(old, new)
    scratch.cell_file.write_text(text)
    return scratch


def attach(key, size=memory_of.HAPTIC_BYTES):
    def found():
        try:
            return memory_of.Memory(key, size)
        except OSError:
            return None

    memory = g.eventually(found)
    assert memory is not None, f"nobody made the memory {key:#x}"
    return memory


class Device(threading.Thread):
    """Moves its handle to `target` (m, in its base frame) at a speed of a hand, and keeps writing until close()."""

    SPEED = 0.08  # m/s

    def __init__(self, key):
        super().__init__(daemon=True)
        self.memory = attach(key)
        self.target = (0.0, 0.0, 0.0)
        self.position = (0.0, 0.0, 0.0)
        self.good = True
        self.silent = False  # writes nothing, as one that hangs
        self.corrupt = None  # written in place of the position
        self.gripper = 0.0
        self.buttons = 0
        self.sequence = 0
        self.at = time.monotonic()
        self._ended = threading.Event()
        self.start()

    def run(self):
        while not self._ended.is_set():
            self.step()
            time.sleep(PERIOD)

    def step(self):
        # The hand goes on by the time that passed, but never in a leap after a pause of the machine.
        now = time.monotonic()
        step = self.SPEED * min(now - self.at, 0.01)
        self.at = now
        away = [t - p for t, p in zip(self.target, self.position)]
        length = math.sqrt(sum(a * a for a in away))
        share = 1.0 if length <= step else step / length
        self.position = tuple(p + share * a for p, a in zip(self.position, away))
        if self.silent:
            return
        self.sequence += 1
        memory_of.write_sample(self.memory, self.sequence, time.monotonic_ns(), self.corrupt or self.position,
                               gripper=self.gripper, buttons=self.buttons, good=self.good)

    def force(self):
        return g.eventually(lambda: memory_of.read_force(self.memory))

    def arrived(self):
        return all(abs(t - p) < 1e-9 for t, p in zip(self.target, self.position))

    def go(self, target):
        self.target = tuple(target)
        assert g.eventually(self.arrived), f"the hand did not arrive: {self.position}"

    def close(self):
        self._ended.set()
        self.join()
        self.memory.detach()


def norm(v):
    return math.sqrt(sum(x * x for x in v))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def main_of_a_process():
    """`python3 haptic_device.py KEY`: a device of its own process, until it is ended."""
    import sys
    device = Device(int(sys.argv[1]))
    print("writing", os.getpid(), flush=True)
    while True:
        time.sleep(1)


if __name__ == "__main__":
    main_of_a_process()

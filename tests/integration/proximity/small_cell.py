"""A cell whose distances can be computed by hand, and the programs that compute them."""

import json
import os
import pathlib
import random
import subprocess
import tempfile

import gateway as g

TRANSFER_CELL = g.CELLS / "transfer_cell/cell.toml"
SHARED = pathlib.Path(os.environ.get("CELLMIRROR_SHARED_DATA", g.SOURCE.parent / "shared/data"))

# A box of 0.2 m on a slide along x, from x = 0; on it a capsule of radius 0.05 and 0.4 m between its ends' centres that
# turns about z, 0.5 m above the box.
SLIDER = """format = 1
[[node]]
name = "Slide"
joint = { type = "prismatic", axis = [1, 0, 0], range_m = [-1.0, 3.0], velocity_m_s = 1 }
geometry = [{ name = "carriage", box_m = [0.2, 0.2, 0.2] }]
[[node]]
name = "Turn"
parent = "Slide"
xyz_m = [0.0, 0.0, 0.5]
joint = { type = "revolute", axis = [0, 0, 1], range_rad = [-3.0, 3.0], velocity_rad_s = 1 }
[[node]]
name = "Arm"
parent = "Turn"
rpy_rad = [0.0, 1.5707963267948966, 0.0]
geometry = [{ name = "arm", capsule_m = [0.05, 0.4] }]
[[node]]
name = "EYE"
type = "sensor"
parent = "Slide"
xyz_m = [0.2, 0.0, 0.0]
rpy_rad = [0.0, 1.5707963267948966, 0.0]
sensor = { range_m = 2.0, half_angle_rad = 0.2, blind_zone_m = 0.3 }
[robot]
id = "S1"
flange = "Arm"
"""

# A wall whose face is at x = 2, and a ball of radius 0.25 at (0, 1, 0.5).
CELL = """format = 1
name = "small"
[[node]]
name = "Robot"
abstract = "slider.mpc"
[[node]]
name = "Wall"
xyz_m = [2.05, 0.0, 0.0]
geometry = [{ box_m = [0.1, 4.0, 4.0] }]
[[node]]
name = "Ball"
xyz_m = [0.0, 1.0, 0.5]
geometry = [{ sphere_m = 0.25 }]
[collision]
warning_distance_m = 0.1
"""


class Home:
    """A folder with the small cell, gone with this object."""

    def __init__(self, cell=CELL):
        self._folder = tempfile.TemporaryDirectory(prefix="cellmirror-test-")
        self.root = pathlib.Path(self._folder.name)
        (self.root / "envlib").mkdir()
        (self.root / "envlib/slider.mpc").write_text(SLIDER)
        self.cell = self.root / "cell.toml"
        self.cell.write_text(cell)

    def postures(self, text, name="postures.csv"):
        path = self.root / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    def close(self):
        self._folder.cleanup()


def program(*arguments, timeout=60):
    return subprocess.run([str(g.BIN / "cellmirror"), *map(str, arguments)], capture_output=True, text=True,
                          timeout=timeout)


def answer(*arguments, timeout=60):
    done = program(*arguments, "--json", timeout=timeout)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def columns(ranges):
    return ",".join(ranges)


def random_postures(ranges, count, seed):
    """A CSV of a smooth motion through random postures; ranges: {column: (lower, upper)}."""
    dice = random.Random(seed)
    corners = [[dice.uniform(*ranges[c]) for c in ranges] for _ in range(count // 10 + 2)]
    rows = [columns(ranges)]
    for i in range(count):
        start, end, part = corners[i // 10], corners[i // 10 + 1], (i % 10) / 10
        rows.append(",".join(repr(a + part * (b - a)) for a, b in zip(start, end)))
    return rows


# Some joints of the transfer cell with ranges in which robots meet.
TRANSFER_RANGES = {
    "TRAEGERSYSTEM.J_0": (0.0, 11.0), "TRAEGERSYSTEM.J_1": (-2.4, 2.4), "TRAEGERSYSTEM.J_2": (0.0, 1.6),
    "MANTEC_RM3.J_2": (-2.0, 2.0), "MANTEC_RM3.J_3": (-2.5, 2.5), "MANTEC_R3.J_1": (-2.9, 2.9),
    "MANTEC_R3.J_2": (-2.0, 2.0), "MANTEC_R3.J_3": (-2.5, 2.5), "PUMA_762.J_1": (-2.7, 2.7),
    "PUMA_762.J_2": (-3.4, 0.3), "PUMA_762.J_3": (-3.9, 0.7), "ZELLENKRAN.KATZE": (0.0, 5.0),
    "ZELLENKRAN.ARM": (-3.1, 3.1),
}

"""A plant: gateways, discovery servers and control rooms, each in a network namespace of its own with an address on one bridge.

Call enter() first: it moves the process into a network and a mount namespace, so that nothing is left behind and nothing else is met.
Needs the rights to make namespaces.
"""

import ctypes
import fcntl
import json
import os
import pathlib
import random
import select
import shutil
import struct
import subprocess
import sys
import threading

import gateway as g

TUNSETIFF, IFF_TAP, IFF_NO_PI = 0x400454CA, 0x0002, 0x1000
CLONE_NEWNS, CLONE_NEWIPC, CLONE_NEWNET = 0x00020000, 0x08000000, 0x40000000
SUBNET = "10.77.0"
SERVER_PORT = 11811
ARM = "format = 1\n" + "".join(
    f'[[node]]\nname = "J_{j}"\n' + (f'parent = "J_{j - 1}"\n' if j > 1 else "") + 'xyz_m = [0.0, 0.0, 0.2]\n'
    f'joint = {{ type = "revolute", axis = [0, {j % 2}, {(j + 1) % 2}], range_rad = [-3, 3], velocity_rad_s = 3.0, '
    'acceleration_rad_s2 = 10.0 }\n'
    for j in range(1, 7)) + '[[node]]\nname = "FLANGE"\nparent = "J_6"\n[robot]\nid = "ARM"\nflange = "FLANGE"\n'


def ip(*arguments, check=True):
    return subprocess.run(["ip", *arguments], check=check, capture_output=True, text=True).returncode == 0


def enter():
    """False where this machine does not permit it."""
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.unshare(CLONE_NEWNS | CLONE_NEWNET | CLONE_NEWIPC) != 0 or libc.mount(b"none", b"/", None, 0x44000, None) != 0:
        return False
    pathlib.Path("/run/netns").mkdir(exist_ok=True)
    if libc.mount(b"none", b"/run/netns", b"tmpfs", 0, None) != 0:
        return False
    return ip("link", "set", "lo", "up", check=False) and ip("link", "add", "plant", "type", "bridge", check=False) and \
        ip("link", "set", "plant", "up", check=False)


class LossyCable:
    """Between two interfaces: each frame is lost with that probability, either way."""

    def __init__(self, near, far, loss):
        self.ends = [self.open(near), self.open(far)]
        self.loss, self.chance = loss, random.Random(7)
        threading.Thread(target=self.carry, daemon=True).start()

    @staticmethod
    def open(name):
        end = os.open("/dev/net/tun", os.O_RDWR)
        fcntl.ioctl(end, TUNSETIFF, struct.pack("16sH", name.encode(), IFF_TAP | IFF_NO_PI))
        return end

    def carry(self):
        other = dict(zip(self.ends, reversed(self.ends)))
        while True:
            for end in select.select(self.ends, [], [])[0]:
                frame = os.read(end, 65536)
                if self.chance.random() >= self.loss:
                    try:
                        os.write(other[end], frame)
                    except OSError:  # the interface is down
                        pass


class Place:
    """A machine of the plant."""

    made = 0

    def __init__(self, host, loss=0.0):
        Place.made += 1
        self.name, self.port = f"m{Place.made}", f"p{Place.made}"
        self.address = f"{SUBNET}.{host}"
        ip("netns", "add", self.name)
        if loss > 0:
            self.cable = LossyCable(f"far{Place.made}", self.port, loss)
            ip("link", "set", f"far{Place.made}", "netns", self.name)
            ip("-n", self.name, "link", "set", f"far{Place.made}", "name", "eth0")
        else:
            ip("link", "add", self.port, "type", "veth", "peer", "name", "eth0", "netns", self.name)
        ip("link", "set", self.port, "master", "plant", "up")
        ip("-n", self.name, "link", "set", "lo", "up")
        ip("-n", self.name, "addr", "add", f"{self.address}/24", "dev", "eth0")
        ip("-n", self.name, "link", "set", "eth0", "up")
        ip("-n", self.name, "route", "add", "224.0.0.0/4", "dev", "eth0")

    def start(self, command, environment=None):
        return g.OrderlyProcess(["ip", "netns", "exec", self.name, *command], environment)

    def connect(self, connected):
        """Plugs its cable in or out."""
        ip("link", "set", self.port, "up" if connected else "down")


SERVER_SETTINGS = pathlib.Path(__file__).resolve().parents[2] / "docs" / "examples" / "discovery_server.xml"
SERVER_PAUSE_S = 8  # before it is started again, as docs/plant.md says: its clients have missed it then


def start_server(place, number, settings=("-x", SERVER_SETTINGS)):
    """One of the discovery servers, of Debian's fastdds-tools, as docs/plant.md has it; or with other `settings`."""
    return place.start(["fast-discovery-server", *settings, "-i", str(number), "-l", place.address, "-p", str(SERVER_PORT)])


def servers_text(places):
    return json.dumps([f"{place.address}:{SERVER_PORT}" for place in places])


class PlantCell:
    """The home of a cell with `robots` arms that stand still."""

    def __init__(self, root, name, robots, address, dds="", rate_hz=100, more="", output_hz=2):
        self.name, self.home, self.runtime = name, root / name, root / "runtime"
        for folder in ("envlib", "scripts"):
            (self.home / folder).mkdir(parents=True, exist_ok=True)
        self.runtime.mkdir(mode=0o700, exist_ok=True)
        (self.home / "envlib" / "arm.mpc").write_text(ARM)
        (self.home / "cell.toml").write_text(
            f'format = 1\nname = "{name}"\n[loop]\nrate_hz = {rate_hz}\nreal_time = "off"\n'
            f'[dds]\n{dds}\n[dds_output]\ninterface_address = "{address}"\nrate_hz = {output_hz}\n{more}' + "".join(
                f'[[node]]\nname = "N{robot}"\nabstract = "arm.mpc"\nrobot_id = "R{robot}"\nxyz_m = [{robot}.0, 0.0, 0.0]\n'
                for robot in range(robots)))

    def environment(self):
        return {**os.environ, "XDG_RUNTIME_DIR": str(self.runtime)}

    def command(self):
        return [g.BIN / "cellmirror", "run", self.home, "--headless", "--no-web", "--instance", self.name]


class SummaryReader:
    """A control room: what tests/integration/dds/summary_peer_main.cpp prints, as it comes."""

    def __init__(self, place, servers=()):
        self.process = place.start([g.BIN / "dds_summary_peer", place.address,
                                    *(f"{server.address}:{SERVER_PORT}" for server in servers)])

    def events(self, kind="received"):
        whole = self.process.output().rpartition("\n")[0]
        return [event for event in map(json.loads, whole.splitlines()) if event["event"] == kind]

    def cells_since(self, at_s):
        return {event["cell"] for event in self.events() if event["at_s"] >= at_s}

    def close(self):
        self.process.close()


def is_possible():
    return shutil.which("ip") is not None and os.geteuid() == 0


if __name__ == "__main__":
    sys.exit(__doc__)

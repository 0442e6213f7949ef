"""System V shared memory for tests, by the C library alone: what a program in another language sees.

The layout of the haptic block is written down here a second time, from docs/shared-memory.md."""

import ctypes
import os
import struct

_libc = ctypes.CDLL(None, use_errno=True)
_libc.shmat.restype = ctypes.c_void_p
_libc.shmat.argtypes = [ctypes.c_int, ctypes.c_void_p, ctypes.c_int]
_libc.shmdt.argtypes = [ctypes.c_void_p]
_libc.shmctl.argtypes = [ctypes.c_int, ctypes.c_int, ctypes.c_void_p]

IPC_CREAT, IPC_EXCL, IPC_RMID = 0o1000, 0o2000, 0


def unused_key():
    """A positive key that nobody has: tests on one machine never meet."""
    while True:
        key = struct.unpack("<I", os.urandom(4))[0] & 0x3FFFFFFF | 0x20000000
        if _libc.shmget(key, 0, 0) < 0:
            return key


def exists(key):
    return _libc.shmget(key, 0, 0) >= 0


class Segment:
    """Attached to the segment of a key, or its maker. As a context manager, a maker removes it."""

    def __init__(self, key, size=0, create=False):
        self.key, self.made = key, create
        self.id = _libc.shmget(key, size, (IPC_CREAT | IPC_EXCL | 0o600) if create else 0)
        if self.id < 0:
            raise OSError(ctypes.get_errno(), f"shmget {key:#x}")
        self.address = _libc.shmat(self.id, None, 0)
        if self.address in (None, ctypes.c_void_p(-1).value):
            raise OSError(ctypes.get_errno(), f"shmat {key:#x}")
        if create:
            ctypes.memset(self.address, 0, size)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        if self.address:
            if self.made:
                self.remove()
            _libc.shmdt(self.address)
            self.address = None

    def remove(self):
        _libc.shmctl(self.id, IPC_RMID, None)

    def cell(self, kind, offset):
        """The value at an offset, shared: read and write its .value. Aligned accesses of 8 bytes are whole."""
        return kind.from_address(self.address + offset)

    def byte(self, offset=0):
        return self.cell(ctypes.c_uint8, offset)

    def u32(self, offset):
        return self.cell(ctypes.c_uint32, offset)

    def u64(self, offset):
        return self.cell(ctypes.c_uint64, offset)

    def i64(self, offset):
        return self.cell(ctypes.c_int64, offset)

    def f64(self, offset):
        return self.cell(ctypes.c_double, offset)


class HapticBlock(Segment):
    SIZE = 512

    def __init__(self, key, create=False):
        super().__init__(key, self.SIZE, create)
        if create:
            ctypes.memmove(self.address + 128, struct.pack("<4sHHII", b"CMHP", 1, 5, self.SIZE, os.getpid()), 16)

    def sample(self):
        """The device's newest sample as a dictionary; None while it is being written, or before the first."""
        before = self.u64(320).value
        sample = {
            "sequence": self.u64(328).value, "time_ns": self.i64(336).value, "process": self.u32(344).value,
            "valid": bool(self.u32(348).value & 1), "buttons": self.u32(352).value, "axis_count": self.u32(356).value,
            "position": [self.f64(360 + 8 * i).value for i in range(3)],
            "orientation": [self.f64(384 + 8 * i).value for i in range(4)],
            "gripper": self.f64(416).value, "axes": [self.f64(424 + 8 * i).value for i in range(7)]}
        return sample if before and before % 2 == 0 and self.u64(320).value == before else None

    def write_force(self, force, answers, time_ns):
        """As the gateway does: force x, y, z in the device's base frame [N], in answer to a sample."""
        lock = self.u64(144)
        lock.value += 1
        self.u64(152).value += 1
        self.i64(160).value = time_ns
        self.i64(168).value = 1_000_000
        self.u64(176).value = answers
        self.u32(184).value = 4
        for i in range(3):
            self.f64(192 + 8 * i).value = force[i]
        lock.value += 1

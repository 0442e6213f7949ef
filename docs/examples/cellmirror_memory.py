"""The shared memories of cellmirror for Python 3 by way of the C library: nothing has to be installed.

docs/shared-memory.md says what the numbers mean. The order in which this reads and writes is kept by x86-64; on other
processors use cellmirror_haptic.h. SPDX-License-Identifier: Apache-2.0
"""

import ctypes
import os
import struct
import time

SHM_RDONLY = 0o10000
TCP_FORCE_KEY = 1313
HAPTIC_BYTES = 512
TCP_FORCE_BYTES = 192
TRIES = 100

PHASES = ("closed", "waiting", "clutched", "engaging", "active", "faulted")
FAULTS = (
    "none stale vanished not_finite invalid jump two_writers torn late_tick stale_model not_passive".split()
)

# "<" is little-endian without padding.
FORCE = struct.Struct("<19f52x4sHHIIQQqqQII3d3d2d64x")  # bytes 0 to 319
SAMPLE = struct.Struct("<QqIIII3d4dd7d32x")  # bytes 328 to 511
TCP_FORCE = struct.Struct("<4f48x4sHHQQqII64s24x")
FORCE_LOCK, DEVICE_LOCK, TCP_FORCE_LOCK = 144, 320, 72

_libc = ctypes.CDLL(None, use_errno=True)
_libc.shmget.argtypes = [ctypes.c_int, ctypes.c_size_t, ctypes.c_int]
_libc.shmat.argtypes = [ctypes.c_int, ctypes.c_void_p, ctypes.c_int]
_libc.shmat.restype = ctypes.c_void_p
_libc.shmdt.argtypes = [ctypes.c_void_p]


def _failed():
    number = ctypes.get_errno()
    raise OSError(number, os.strerror(number))


def _signed(key):
    return key - (1 << 32) if key >= 1 << 31 else key


class Memory:
    """An existing segment of at least `least` bytes. Errors are OSError: ENOENT none is there, EINVAL too small."""

    def __init__(self, key, least, read_only=False):
        self._key = _signed(key)
        self._id = _libc.shmget(self._key, least, 0)
        if self._id < 0:
            _failed()
        self._address = _libc.shmat(self._id, None, SHM_RDONLY if read_only else 0)
        if self._address in (None, ctypes.c_void_p(-1).value):
            _failed()
        self._bytes = (ctypes.c_char * least).from_address(self._address)
        self._words = memoryview(self._bytes).cast("B").cast("Q")

    def detach(self):
        self._words.release()
        del self._bytes
        _libc.shmdt(self._address)

    def removed(self):
        """The gateway ended: a look-up of the key no longer finds this memory."""
        return _libc.shmget(self._key, 0, 0) != self._id

    def read(self, begin, end, lock):
        """The bytes begin to end of one write; None where every try met the writer, and the number of tries."""
        for tries in range(1, TRIES + 1):
            before = self._words[lock // 8]
            if before % 2 == 0:
                copy = ctypes.string_at(self._address + begin, end - begin)
                if self._words[lock // 8] == before:
                    return copy, tries
        return None, TRIES

    def write(self, begin, data, lock):
        """Writes a section: the lock is odd meanwhile. It goes on from where an earlier process left it."""
        odd = self._words[lock // 8] | 1
        self._words[lock // 8] = odd
        ctypes.memmove(self._address + begin, data, len(data))
        self._words[lock // 8] = (odd + 1) & 0xFFFFFFFFFFFFFFFF


def read_force(memory):
    """What the gateway answers, as a dictionary; None where there is no block of version 1 or it was torn."""
    copy, _ = memory.read(0, FORCE.size, FORCE_LOCK)
    if copy is None:
        return None
    values = FORCE.unpack(copy)
    magic, version, joints, _, gateway, _, sequence, time_ns, period_ns, answers, phase, fault = values[19:31]
    if magic != b"CMHP" or version != 1:
        return None
    return {
        "force": values[0:3],
        "joint_torque": values[3 : 3 + min(joints, 16)],
        "gateway": gateway,
        "sequence": sequence,
        "time_ns": time_ns,
        "period_ns": period_ns,
        "answers": answers,
        "phase": phase,
        "fault": fault,
        "force_device": values[31:34],
        "torque_device": values[34:37],
        "gripper_torque": values[37],
        "max_force": values[38],
    }


def is_current(force, most_s=0.1):
    """Whether a living gateway stands behind what was read: only then use it. A gateway that was killed together with its
    guard leaves its last force behind, but its time stands still."""
    age = time.monotonic_ns() - force["time_ns"]
    return force.get("gateway", force.get("process")) != 0 and force["time_ns"] > 0 and 0 <= age <= most_s * 1e9


def write_sample(memory, sequence, time_ns, position, orientation=(0, 0, 0, 1), buttons=0, gripper=0.0, axes=(), good=True):
    """The device's pose, m and a quaternion x y z w; axes in rad or m. One writer."""
    padded = tuple(axes) + (0.0,) * (7 - len(axes))
    data = SAMPLE.pack(
        sequence, time_ns, os.getpid(), 1 if good else 0, buttons, len(axes), *position, *orientation, gripper, *padded
    )
    memory.write(DEVICE_LOCK + 8, data, DEVICE_LOCK)


def read_tcp_force(memory):
    """The force at the TCP as a dictionary; None where there is no block of version 1 or it was torn."""
    copy, _ = memory.read(0, TCP_FORCE.size, TCP_FORCE_LOCK)
    if copy is None:
        return None
    *values, magic, version, _, _, sequence, time_ns, flags, process, robot = TCP_FORCE.unpack(copy)
    if magic != b"CMTF" or version != 1:
        return None
    return {
        "values": values,
        "sequence": sequence,
        "time_ns": time_ns,
        "flags": flags,
        "process": process,
        "robot": robot.split(b"\0", 1)[0].decode(errors="replace"),
    }

"""System V message queues for Python 3 by way of the C library: nothing has to be installed.

SPDX-License-Identifier: Apache-2.0
"""

import ctypes
import os

IPC_NOWAIT = 0o4000
MSG_NOERROR = 0o10000
MAX_MESSAGE = 8192

_libc = ctypes.CDLL(None, use_errno=True)
_libc.msgrcv.restype = ctypes.c_ssize_t
_libc.msgget.argtypes = [ctypes.c_int, ctypes.c_int]
_libc.msgsnd.argtypes = [ctypes.c_int, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_int]
_libc.msgrcv.argtypes = [ctypes.c_int, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_long, ctypes.c_int]


class _Message(ctypes.Structure):
    # System V wants a long first; it is not counted in the length.
    _fields_ = [("type", ctypes.c_long), ("text", ctypes.c_char * MAX_MESSAGE)]


def _checked(result):
    if result < 0:
        number = ctypes.get_errno()
        raise OSError(number, os.strerror(number))
    return result


class Queue:
    """An existing queue. Errors are OSError with the usual errno: ENOENT no such queue, EIDRM it was removed."""

    def __init__(self, key):
        self._id = _checked(_libc.msgget(key, 0))

    def send(self, message_type, text, flags=0):
        message = _Message(message_type, b"")
        ctypes.memmove(ctypes.byref(message, _Message.text.offset), text, len(text))
        _checked(_libc.msgsnd(self._id, ctypes.byref(message), len(text), flags))

    def receive(self, message_type, flags=0):
        message = _Message()
        length = _checked(_libc.msgrcv(self._id, ctypes.byref(message), MAX_MESSAGE, message_type, flags | MSG_NOERROR))
        return ctypes.string_at(ctypes.byref(message, _Message.text.offset), length)

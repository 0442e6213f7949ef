"""What `cellmirror send` and `status` do, in this process: the control socket and the SCRIPT queues (docs/messages.md)."""

import ctypes
import errno
import json
import os
import random
import socket
import time

MESSAGE_TYPE = 5
LARGEST_TEXT = 8192
LARGEST_PROCESS, LARGEST_TAG = 4_194_304, 2_147_483_647
WITHOUT_WAITING, CUT_TO_FIT = 0o4000, 0o10000  # IPC_NOWAIT, MSG_NOERROR

libc = ctypes.CDLL(None, use_errno=True)
libc.msgsnd.argtypes = [ctypes.c_int, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_int]
libc.msgrcv.argtypes = [ctypes.c_int, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_long, ctypes.c_int]
libc.msgrcv.restype = ctypes.c_ssize_t


class NoGateway(Exception):
    """Nothing was sent: none that can be asked runs in the folder, or one of its queues is not as it should be."""


class NoAnswer(Exception):
    """The command was sent, or waited in vain to be."""


def ask(folder, timeout=60, **request):
    """The gateway's answer to one request of the control socket, a document."""
    answer = b""
    try:
        with socket.socket(socket.AF_UNIX) as connection:
            connection.settimeout(timeout)
            connection.connect(str(folder / "control.sock"))
            connection.sendall(json.dumps(request).encode() + b"\n")
            while part := connection.recv(1 << 20):
                answer += part
        document = json.loads(answer)
    except (OSError, ValueError) as error:
        raise NoGateway(str(error)) from None
    if "error" in document:
        raise NoGateway(document["error"])
    return document


def repeated(call, expected, until):
    """The call's result once it does not fail with `expected`, or with None once it is too late."""
    pause_s = 0.0002
    while True:
        result = call()
        if result >= 0:
            return result
        if ctypes.get_errno() not in (expected, errno.EINTR):
            raise NoAnswer(f"the gateway ended before it answered: {os.strerror(ctypes.get_errno())}")
        if time.monotonic() > until:
            return None
        time.sleep(pause_s)
        pause_s = min(2 * pause_s, 0.005)


def send(folder, command, timeout=60):
    """Whether the command was done, and the text of the answer."""
    queues = ask(folder, timeout, request="queues")
    if queues["script_problem"] or queues["reply_problem"]:
        raise NoGateway(queues["script_problem"] + queues["reply_problem"])
    tag = random.randrange(LARGEST_PROCESS + 1, LARGEST_TAG)
    text = f"@{tag} {command}".encode()
    if not command or len(text) > LARGEST_TEXT:
        raise NoGateway("no command that can be sent")
    until = time.monotonic() + timeout
    message = ctypes.create_string_buffer(MESSAGE_TYPE.to_bytes(8, "little") + text)
    if repeated(lambda: libc.msgsnd(queues["script_queue"], message, len(text), WITHOUT_WAITING), errno.EAGAIN, until) is None:
        raise NoAnswer(f"the message queue stayed full for {timeout} s")
    reply = ctypes.create_string_buffer(8 + LARGEST_TEXT)
    size = repeated(lambda: libc.msgrcv(queues["reply_queue"], reply, LARGEST_TEXT, tag, WITHOUT_WAITING | CUT_TO_FIT), errno.ENOMSG,
                    until)
    if size is None:
        raise NoAnswer(f"the gateway did not answer within {timeout} s")
    word, _, answer = reply.raw[8:8 + size].split(b"\0")[0].decode().partition(" ")
    if word not in ("done", "refused"):
        raise AssertionError(f"{command}: {word} {answer} is no answer")
    return word == "done", answer

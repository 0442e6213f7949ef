#!/usr/bin/env python3
"""Sends one SCRIPT command to a running cellmirror and prints its answer: done, or refused and why.

    python3 send_command.py 'ROBACT PUMA_762'

Exit status: 0 done, 1 refused or failed, 2 wrong usage. SPDX-License-Identifier: Apache-2.0
"""

import argparse
import errno
import os
import signal
import sys

from cellmirror_queue import IPC_NOWAIT, MAX_MESSAGE, Queue

MESSAGE_TYPE = 5


def ask(command, script_key, reply_key):
    queue = Queue(script_key)
    replies = Queue(reply_key)
    # Any number from 1 to 2147483647 that nobody else uses now. A process is alone with its own.
    tag = os.getpid()
    try:
        while True:  # a reply to an earlier process of this number could still be there
            replies.receive(tag, IPC_NOWAIT)
    except OSError as error:
        if error.errno != errno.ENOMSG:
            raise
    queue.send(MESSAGE_TYPE, b"@%d %s" % (tag, command))
    return replies.receive(tag)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--timeout", type=float, default=5.0, metavar="SECONDS")
    parser.add_argument("--script-key", type=lambda text: int(text, 0), default=2351, metavar="KEY")
    parser.add_argument("--reply-key", type=lambda text: int(text, 0), default=2352, metavar="KEY")
    parser.add_argument("command", metavar="COMMAND")
    options = parser.parse_args()
    command = options.command.encode()
    if options.timeout <= 0 or len(command) > MAX_MESSAGE - 16:
        parser.error("the time-out must be positive and the command shorter than a message")

    # Neither msgsnd nor msgrcv has a time-out: a timer interrupts them, and goes on, in case it came just before the wait.
    signal.signal(signal.SIGALRM, lambda number, frame: None)
    signal.setitimer(signal.ITIMER_REAL, options.timeout, 0.1)
    try:
        reply = ask(command, options.script_key, options.reply_key).decode(errors="replace")
    except OSError as error:
        why = {
            errno.ENOENT: "no gateway is running",
            errno.EIDRM: "the gateway ended before it answered",
            errno.EINTR: "no answer in time; the command may still be executed",
        }.get(error.errno, str(error))
        print(f"send_command.py: {why}", file=sys.stderr)
        return 1
    print(reply)
    return 0 if reply.startswith("done") else 1


if __name__ == "__main__":
    sys.exit(main())

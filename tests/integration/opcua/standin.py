"""A stand-in for a gateway's control socket: answers each request with what a test wants."""

import json
import os
import pathlib
import socketserver
import threading


class Standin(socketserver.ThreadingUnixStreamServer):
    daemon_threads = True
    block_on_close = False
    request_queue_size = 64

    def __init__(self, runtime, instance, answer):
        """`answer()`: bytes, or a document."""
        self.answer, self.requests = answer, 0
        self.path = pathlib.Path(runtime) / instance / "control.sock"
        self.path.parent.mkdir(mode=0o700, exist_ok=True)
        self.path.unlink(missing_ok=True)
        super().__init__(str(self.path), Handler)
        os.chmod(self.path, 0o600)
        threading.Thread(target=self.serve_forever, kwargs={"poll_interval": 0.05}, daemon=True).start()

    def handle_error(self, request, client_address):
        pass  # a client that closed first

    def close(self):
        self.shutdown()
        self.server_close()
        self.path.unlink(missing_ok=True)


class Handler(socketserver.StreamRequestHandler):
    def handle(self):
        self.rfile.readline()
        self.server.requests += 1
        answer = self.server.answer()
        self.wfile.write(answer if isinstance(answer, bytes) else json.dumps(answer).encode() + b"\n")


def joint(name, **more):
    return {"name": name, "position": 0.5, "velocity": 0.0, "unit": "rad", "range": [-3.0, 3.0], "state": "fresh", "age_s": 0.001, **more}


def robot(name, joints=6, **more):
    return {"id": name, "mode": "mirrored", "stream": {"kind": "dds", "state": "fresh", "age_s": 0.001, "details": {}},
            "joints": [joint(f"J_{number}") for number in range(joints)], **more}


def status(robots):
    return {"version": "1", "cell": "cell", "robots": robots, "programs": {"loaded": []},
            "collisions": {"active": False}, "alarms": {"unacknowledged": 0, "highest_priority": None}, "problems": []}

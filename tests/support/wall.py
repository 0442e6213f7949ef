"""Runs a wall and a plant of made-up gateways (tests/integration/wall/plant_main.cpp) in a DDS domain of their own."""

import json
import os
import random
import subprocess
import tempfile
import urllib.request

import gateway as g

DOMAINS = range(120, 220)  # no other test is there


def free_domain():
    return random.SystemRandom().choice(DOMAINS)


class Plant:
    def __init__(self, cells, robots=8, rate_hz=2, domain=None):
        self.domain = free_domain() if domain is None else domain
        self.child = subprocess.Popen([g.BIN / "wall_plant", str(cells), str(robots), str(rate_hz), str(self.domain)], text=True,
                                      stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        assert self.child.stdout.readline() == "ready\n"

    def tell(self, line):
        self.child.stdin.write(line + "\n")
        self.child.stdin.flush()
        assert self.child.stdout.readline() == f"done {line}\n"

    def close(self):
        self.child.stdin.close()
        self.child.wait(g.PATIENCE_S)
        self.child.stdout.close()


class Wall:
    def __init__(self, domain, *arguments, cells=None):
        self.errors = tempfile.TemporaryFile("w+")
        self.file = None
        if cells is not None:
            self.file = tempfile.NamedTemporaryFile("w", suffix=".toml")
            self.file.write(cells)
            self.file.flush()
            arguments += ("--cells", self.file.name)
        self.child = subprocess.Popen([g.BIN / "cellmirror", "wall", "--domain", str(domain), *(() if "--port" in arguments else ("--port", "0")), *arguments], text=True,
                                      stdout=subprocess.PIPE, stderr=self.errors, env=dict(os.environ, LC_ALL="C"))
        line = self.child.stdout.readline()
        if not line.startswith("the wall is at "):
            self.child.wait(g.PATIENCE_S)
            told = self.told()
            self.close_files()
            raise AssertionError(f"no wall: {line}{told}")
        self.address = line.split()[-1]

    def close_files(self):
        self.child.stdout.close()
        self.errors.close()
        if self.file is not None:
            self.file.close()

    def told(self):
        self.errors.seek(0)
        return self.errors.read()

    def get(self, path):
        with urllib.request.urlopen(self.address + path, timeout=g.PATIENCE_S) as answer:
            return answer.read()

    def document(self):
        return json.loads(self.get("api/wall"))

    def contents(self):
        return [tile["content"] for tile in self.document()["tiles"]]

    def cell(self, name):
        """The contents of that cell, one for each gateway that says that it is it."""
        return [content for content in self.contents() if content["cell"] == name]

    def marks(self, name):
        return [sorted(mark["mark"] for mark in content["marks"]) for content in self.cell(name)]

    def state(self, name):
        found = self.cell(name)
        return found[0]["state"] if found else None

    def close(self):
        self.child.terminate()
        status = self.child.wait(g.PATIENCE_S)
        self.close_files()
        return status

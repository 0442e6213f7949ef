#!/usr/bin/python3
"""Builds the site of the documents into a folder; a warning is an error. Arguments: the folder."""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def build(folder):
    # Warnings of Python are those of the packages' own sources.
    done = subprocess.run(["mkdocs", "build", "--strict", "--quiet", "--config-file", ROOT / "mkdocs.yml", "--site-dir", Path(folder).resolve()],
                          cwd=ROOT, env=dict(os.environ, PYTHONWARNINGS="ignore", PYTHONDONTWRITEBYTECODE="1", LC_ALL="C.UTF-8"))
    return done.returncode


if __name__ == "__main__":
    sys.exit(build(sys.argv[1]))

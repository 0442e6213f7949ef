"""The packages of npm that judge recordings and the live server."""

import pathlib

import gateway as g
from npm_packages import Packages

PACKAGES = Packages(pathlib.Path(__file__).resolve().parent, g.BIN.parent / "record_peers")

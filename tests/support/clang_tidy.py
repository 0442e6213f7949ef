"""clang-tidy over every source of ours that the clang build compiles, on all cores.

Sources that are compiled together are checked together. What was clean is remembered by the content of the sources and of all
headers of ours that they include, so that a second run checks only what changed. The sources that the change touches (since CHECK_BASE, by default the newest commit that is twelve hours
older than HEAD) come first and have TIDY_CHANGE_SECONDS; the others, what was committed last first, have TIDY_SECONDS together.
Within ./check both end when CHECK_SECONDS have passed since it began. `./check --full` has no bound. Sources that were not
reached count as skipped."""

import hashlib
import json
import os
import re
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from test_report import Report

ROOT = Path(__file__).resolve().parents[2]
TIDY = "clang-tidy-19"
SECONDS = float(os.environ.get("TIDY_SECONDS", "40"))
CHANGE_SECONDS = float(os.environ.get("TIDY_CHANGE_SECONDS", "420"))
CHECK_SECONDS = 1650.0  # a whole ./check takes at most half an hour
CHANGE_AGE = 12 * 3600  # s
CLEAN = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "cellmirror/clang-tidy"
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]+"([^"]+)"', re.MULTILINE)


def empty_entries() -> list[str]:
    """Entries of .clang-tidy that name no check of this clang-tidy, and so would check nothing."""
    text = (ROOT / ".clang-tidy").read_text()
    block = re.search(r"^Checks: >\n((?:  .*\n)+)", text, re.MULTILINE)[1]
    wanted = {entry.strip() for entry in block.replace("\n", "").split(",") if not entry.strip().startswith("-")}
    listing = subprocess.run([TIDY, "--checks=*", "--list-checks"], cwd="/", capture_output=True, text=True).stdout
    return sorted(wanted - {line.strip() for line in listing.splitlines()})


def newest_first() -> dict[str, int]:
    """Paths in the order of their last commits; empty where git does not know."""
    log = subprocess.run(["git", "log", "--name-only", "--format="], cwd=ROOT, capture_output=True, text=True).stdout
    order: dict[str, int] = {}
    for path in log.splitlines():
        order.setdefault(path, len(order))
    return order


def git(*arguments: str) -> str:
    return subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True).stdout


def touched() -> set[str]:
    """Paths that differ from the base of the change, also where that is not committed; empty where git does not know."""
    base = os.environ.get("CHECK_BASE", "")
    if not base:
        head = git("log", "-1", "--format=%ct").strip()
        base = git("rev-list", "-1", f"--before={int(head) - CHANGE_AGE}", "HEAD").strip() if head else ""
    return set(git("diff", "--name-only", base).splitlines()) if base else set()


def together(file: Path) -> list[Path]:
    """The sources that this file of the build compiles: several in one (cmake/Library.cmake), or the file itself."""
    if file.parent.name != "Unity":
        return [file]
    return [Path(name) for name in re.findall(r'^#include "(/.+)"$', file.read_text(), re.MULTILINE)]


def write_for_editors(build: Path, commands: list[dict[str, str]]) -> None:
    """The commands with a source each, in build/clang-tidy: for editors, and for clang-tidy by hand."""
    alone = [{**entry, "command": entry["command"].replace(entry["file"], str(source)), "file": str(source)}
             for entry in commands for source in together(Path(entry["file"]))]
    (build / "clang-tidy").mkdir(exist_ok=True)
    (build / "clang-tidy/compile_commands.json").write_text(json.dumps(alone, indent=1))


def is_product(source: Path) -> bool:
    top = source.relative_to(ROOT).parts[0] if source.is_relative_to(ROOT) else "build"
    return top not in ("tests", "docs") and not top.startswith("build")


@dataclass(frozen=True)
class Unit:
    """What one run of clang-tidy reads. Most of its time goes into the headers: sources that are compiled together take
    an eighth of what they take one by one."""

    file: Path
    command: str
    sources: tuple[Path, ...]

    def names(self) -> list[str]:
        return [str(source.relative_to(ROOT)) for source in self.sources]


def units(build: Path) -> list[Unit]:
    """Of the product, no tests, no examples in the pages; what was committed last comes first."""
    commands = json.loads((build / "compile_commands.json").read_text())
    write_for_editors(build, commands)
    order = newest_first()
    found = [Unit(Path(entry["file"]), entry["command"], tuple(together(Path(entry["file"])))) for entry in commands]
    found = [unit for unit in found if all(is_product(source) for source in unit.sources)]
    return sorted(found, key=lambda unit: min(order.get(name, -1) for name in unit.names()))


def fingerprint(unit: Unit) -> str:
    """Of all that decides the findings, as far as it is ours."""
    closure, waiting = {}, list(unit.sources)
    while waiting:
        path = waiting.pop()
        if path not in closure and path.exists():
            closure[path] = path.read_text(errors="replace")
            waiting += [ROOT / name for name in INCLUDE.findall(closure[path])]
    digest = hashlib.sha256(unit.command.replace(str(ROOT), "").encode() + (ROOT / ".clang-tidy").read_bytes())
    for path in sorted(closure):
        digest.update(f"{path.relative_to(ROOT)}\0{closure[path]}\0".encode())
    return digest.hexdigest()


def check(build: Path, unit: Unit, end: float) -> str | None:
    """What clang-tidy found; nothing where it is clean; None where the time is over."""
    clean = CLEAN / fingerprint(unit)
    if clean.exists():
        return ""
    if time.monotonic() > end:
        return None
    result = subprocess.run([TIDY, "-p", str(build), "--quiet", str(unit.file)], cwd=ROOT, capture_output=True, text=True)
    if result.returncode == 0:
        clean.touch()
        return ""
    return result.stdout.strip() or result.stderr.strip()


def within_check(seconds: float, least: float) -> float:
    """Not beyond the time of a ./check that runs this, but `least` in any case."""
    started = os.environ.get("CHECK_STARTED")
    return seconds if not started else max(min(seconds, CHECK_SECONDS - (time.time() - float(started))), least)


def run(build: Path, full: bool = False) -> Report:
    report = Report()
    for entry in empty_entries():
        report.fail(".clang-tidy", f"'{entry}' names no check")
    if not (build / "compile_commands.json").exists():
        report.fail("compile_commands.json", f"{build} is not configured")
        return report
    CLEAN.mkdir(parents=True, exist_ok=True)
    changed = touched()
    every = units(build)
    first = [unit for unit in every if changed.intersection(unit.names())]
    check_all(report, build, first, None if full else within_check(CHANGE_SECONDS, 20.0))
    check_all(report, build, [unit for unit in every if unit not in first], None if full else within_check(SECONDS, 0.0))
    return report


def check_all(report: Report, build: Path, wanted: list[Unit], bound: float | None) -> None:
    end = time.monotonic() + (bound if bound is not None else float("inf"))
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        results = pool.map(lambda unit: check(build, unit, end), wanted)
        for unit, findings in zip(wanted, results):
            if findings is None:
                for name in unit.names():
                    report.skip(name, f"not reached by clang-tidy within {bound:g} s; ./check --full reaches all")
            elif findings:
                report.fail(place_of(findings, unit), findings)
            else:
                report.passed += len(unit.sources)


def place_of(findings: str, unit: Unit) -> str:
    """The source of the first finding; of a text without one, all sources of the unit."""
    found = re.search(r"^(/[^:\n]+):\d+:\d+: (?:error|warning)", findings, re.MULTILINE)
    path = Path(found[1]) if found else None
    return str(path.relative_to(ROOT)) if path and path.is_relative_to(ROOT) else ", ".join(unit.names())


if __name__ == "__main__":
    outcome = run(Path(sys.argv[1]).resolve(), full="--full" in sys.argv)
    for case in outcome.failed:
        print(f"{case.name}\n{case.detail}\n")
    print(outcome)
    sys.exit(1 if outcome.failed else 0)

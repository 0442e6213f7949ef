"""clang-tidy over every source of ours that the clang build compiles, on all cores."""

import json
import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from test_report import Report

ROOT = Path(__file__).resolve().parents[2]
TIDY = "clang-tidy-19"


def empty_groups() -> list[str]:
    """Entries of .clang-tidy that name no check of this clang-tidy, and so would check nothing."""
    text = (ROOT / ".clang-tidy").read_text()
    block = re.search(r"^Checks: >\n((?:  .*\n)+)", text, re.MULTILINE)[1]
    wanted = [entry.strip() for entry in block.replace("\n", "").split(",")]
    return [entry for entry in wanted if not entry.startswith("-") and not checks_in(entry)]


def checks_in(entry: str) -> int:
    listing = subprocess.run([TIDY, f"--checks=-*,{entry}", "--list-checks"], cwd="/", capture_output=True, text=True)
    return len(re.findall(r"^    ", listing.stdout, re.MULTILINE))


def sources(build: Path) -> list[Path]:
    """The translation units of the build's folder that are ours and not tests."""
    commands = json.loads((build / "compile_commands.json").read_text())
    units = {Path(command["file"]) for command in commands}
    ours = {unit: unit.relative_to(ROOT).parts[0] for unit in units if unit.is_relative_to(ROOT)}
    return sorted(unit for unit, top in ours.items() if top != "tests" and not top.startswith("build"))


def check(build: Path, unit: Path) -> tuple[Path, str]:
    result = subprocess.run([TIDY, "-p", str(build), "--quiet", str(unit)], cwd=ROOT, capture_output=True, text=True)
    return unit.relative_to(ROOT), "" if result.returncode == 0 else result.stdout.strip() or result.stderr.strip()


def run(build: Path) -> Report:
    report = Report()
    for entry in empty_groups():
        report.fail(".clang-tidy", f"'{entry}' names no check")
    if not (build / "compile_commands.json").exists():
        report.fail("compile_commands.json", f"{build} is not configured")
        return report
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for unit, findings in pool.map(lambda unit: check(build, unit), sources(build)):
            if findings:
                report.fail(str(unit), findings)
            else:
                report.passed += 1
    return report


if __name__ == "__main__":
    outcome = run(Path(sys.argv[1]).resolve())
    for case in outcome.failed:
        print(f"{case.name}\n{case.detail}\n")
    print(outcome)
    sys.exit(1 if outcome.failed else 0)

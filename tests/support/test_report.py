"""Runs ctest and counts test cases: those of a GoogleTest or Python unittest program one by one, any other test as one.

A program that skips some of its cases still counts as passed for ctest, so the cases are read from the XML report of
GoogleTest, and from what unittest prints."""

import os
import re
import shutil
import subprocess
import xml.etree.ElementTree as ElementTree
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path


@dataclass
class Case:
    name: str
    detail: str = ""


@dataclass
class Report:
    passed: int = 0
    failed: list[Case] = field(default_factory=list)
    skipped: list[Case] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def fail(self, name: str, detail: str = "") -> None:
        self.failed.append(Case(name, detail))

    def skip(self, name: str, reason: str) -> None:
        self.skipped.append(Case(name, reason))

    def add(self, other: "Report", prefix: str) -> None:
        self.passed += other.passed
        self.failed += [Case(f"{prefix}: {case.name}", case.detail) for case in other.failed]
        self.skipped += [Case(f"{prefix}: {case.name}", case.detail) for case in other.skipped]

    def print_skipped(self) -> None:
        for reason, count in Counter(case.detail for case in self.skipped).items():
            names = [case.name for case in self.skipped if case.detail == reason]
            print(f"skipped: {', '.join(names[:3])}{f' and {count - 3} more' if count > 3 else ''}: {reason}")

    def __str__(self) -> str:
        counts = [f"{n} {word}" for n, word in
                  ((self.passed, "passed"), (len(self.failed), "failed"), (len(self.skipped), "skipped")) if n]
        return ", ".join(self.notes + counts) or "nothing to do"


def tail(text: str | None, lines: int = 60) -> str:
    return "\n".join((text or "").strip().splitlines()[-lines:])


def reason_of(text: str) -> str:
    """The reason in what GTEST_SKIP() << "skipped: reason" or a test script printed."""
    lines = [line.strip() for line in text.strip().splitlines() if line.strip()]
    marked = [line for line in lines if line.startswith("skipped:")]
    return ((marked or lines or ["no reason given"])[-1]).removeprefix("skipped:").strip()


def count_cases(path: Path, report: Report) -> None:
    """Adds the cases of one GoogleTest XML report."""
    for case in ElementTree.parse(path).iter("testcase"):
        name = f"{case.get('classname')}.{case.get('name')}"
        if case.find("failure") is not None:
            report.fail(name, tail("\n".join(failure.text or "" for failure in case.iter("failure")), 30))
        elif case.find("skipped") is not None:
            skipped = case.find("skipped")
            report.skip(name, reason_of(skipped.text or skipped.get("message") or ""))
        elif case.get("status") != "notrun":
            report.passed += 1


def count_unittest(output: str, report: Report) -> bool:
    """Adds the cases of a Python unittest program; False where it is none."""
    ran = re.search(r"^Ran (\d+) tests? in ", output, re.MULTILINE)
    if not ran:
        return False
    counts = {word: int(n) for word, n in re.findall(r"(failures|errors|skipped)=(\d+)", output[ran.end():])}
    reasons = re.findall(r"^(\w+) \(.*\.\.\. skipped ['\"](.*)['\"]$", output, re.MULTILINE)
    for name, reason in reasons:
        report.skip(name, reason_of(reason))
    for number in range(len(reasons), counts.get("skipped", 0)):
        report.skip(f"case {number + 1}", "its reason shows with unittest's verbosity 2")
    failed = failures_of(output)
    for _, name, detail in failed:
        report.fail(name, detail)
    tests = {test for test, _, _ in failed}
    report.passed += max(0, int(ran[1]) - len(tests) - counts.get("skipped", 0))
    return True


def failures_of(output: str) -> list[tuple[str, str, str]]:
    """Test with its class, name and traceback of each failed case or sub-test that unittest printed."""
    rule, line = "=" * 70, "-" * 70
    found = []
    for block in output.split(rule + "\n")[1:]:
        head = re.match(r"(?:FAIL|ERROR): ((\w+)(?: \([^)]*\))?)(.*)\n", block)
        if head:
            text = block.split("\n" + line + "\nRan ")[0].replace(line + "\n", "")
            found.append((head[1], f"{head[2]} {head[3].strip()}".strip(), tail(text, 40)))
    return found


def add_test(test: ElementTree.Element, reports: Path, total: Report) -> None:
    """Adds one ctest entry: its own cases where it is a GoogleTest program, else itself."""
    name = test.get("name")
    output = test.findtext("system-out")
    cases = Report()
    xml = reports / f"{name}.xml"
    if xml.exists():
        try:
            count_cases(xml, cases)
        except ElementTree.ParseError:
            pass  # the program died while writing; ctest knows that it failed
    counted = xml.exists() or count_unittest(output or "", cases)
    not_built = test.get("status") == "notrun" and "Unable to find executable" in (output or "")
    if test.find("failure") is not None or test.get("status") == "fail" or not_built:
        if not cases.failed:
            failure = test.find("failure")
            cases.fail("ended badly" if counted else "failed",
                       f"{failure.get('message') if failure is not None else ''}\n{tail(output)}")
    elif test.find("skipped") is not None or test.get("status") in ("notrun", "disabled"):
        cases = Report()
        cases.skip("all of it", reason_of(output or ""))
    elif not counted:
        cases.passed += 1
    total.add(cases, name)


def system_v_objects() -> set[str]:
    """Message queues, shared memory and semaphores of this IPC namespace."""
    found = set()
    for kind in ("msg", "shm", "sem"):
        try:
            lines = Path(f"/proc/sysvipc/{kind}").read_text().splitlines()[1:]
        except OSError:
            continue
        found |= {f"{kind} key {int(line.split()[0]) & 0xFFFFFFFF:#x} id {line.split()[1]}" for line in lines}
    return found


def own_ipc_namespace() -> bool:
    """Moves this process into an IPC namespace of its own where that is allowed, so that the tests meet no queue of a
    running gateway and what they leave behind is theirs for certain."""
    import ctypes

    clone_newipc = 0x08000000
    return os.geteuid() == 0 and ctypes.CDLL(None, use_errno=True).unshare(clone_newipc) == 0


def run_tests(build: Path, name: str, selection: list[str], environment: dict[str, str]) -> Report:
    """ctest in the folder `build` with the arguments `selection`; what the tests print is kept in build/reports."""
    slug = "".join(c if c.isalnum() else "_" for c in name)
    reports = build / "reports" / slug
    shutil.rmtree(reports, ignore_errors=True)
    reports.mkdir(parents=True)
    junit = reports / "ctest.junit"
    command = ["ctest", "--test-dir", str(build), "-j", str(os.cpu_count() or 2), "--output-junit", str(junit),
               "--output-on-failure", "--test-output-size-passed", "1000000", "--test-output-size-failed", "1000000",
               *selection]
    own_ipc_namespace()
    before = system_v_objects()
    with open(reports / "ctest.log", "w", encoding="utf-8") as log:
        status = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT,
                                env=os.environ | environment | {"GTEST_OUTPUT": f"xml:{reports}/"}).returncode
    left_behind = system_v_objects() - before

    total = Report()
    try:
        for test in ElementTree.parse(junit).iter("testcase"):
            add_test(test, reports, total)
    except (OSError, ElementTree.ParseError):
        total.fail("ctest", tail((reports / "ctest.log").read_text(errors="replace")))
    if status != 0 and not total.failed:
        total.fail("ctest", tail((reports / "ctest.log").read_text(errors="replace")))
    if not total.passed and not total.failed and not total.skipped:
        total.notes.append("no such tests")
    elif left_behind:
        total.fail("System V objects left behind", "\n".join(sorted(left_behind)))
    else:
        total.passed += 1
    return total

"""The stages of ./check: builds, tests, lint, sanitizers, fuzzers; a table of them and one closing line of counts."""

import argparse
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import clang_tidy
from test_report import Report, run_tests

ROOT = Path(__file__).resolve().parents[2]

SANITIZER_OPTIONS = {
    "ASAN_OPTIONS": "detect_leaks=1:strict_string_checks=1:detect_stack_use_after_return=1",
    "LSAN_OPTIONS": f"suppressions={ROOT}/tests/support/lsan.supp:print_suppressions=0",
    "UBSAN_OPTIONS": "print_stacktrace=1:halt_on_error=1",
    "TSAN_OPTIONS": f"halt_on_error=1:second_deadlock_stack=1:suppressions={ROOT}/tests/support/tsan.supp",
}

# One clang build serves the address and undefined-behaviour sanitizers, the fuzzers and clang-tidy.
SANITIZED_TARGETS = ("tests_unit", "tests_golden", "tests_fuzz", "programs")
SANITIZED_BUILD = f"configure fuzz build-fuzz && build build-fuzz {' '.join(SANITIZED_TARGETS)}"
THREAD_TARGETS = ("tests_stress", "tests_concurrency")
THREAD_BUILD = f"configure tsan build-tsan && build build-tsan {' '.join(THREAD_TARGETS)}"


def shell(command: str) -> bool:
    """Runs a function of cmake/setup.sh, which prints progress and failures itself."""
    return subprocess.run(["bash", "-uc", f". cmake/setup.sh; {command}"], cwd=ROOT).returncode == 0


class EarlyBuild:
    """Builds in the idle class, which every other program preempts at once, while many tests wait for time to pass. The build
    that follows continues from here and reports failures."""

    def __init__(self, command: str):
        idle = ["chrt", "-i", "0"] if shutil.which("chrt") else ["nice", "-n", "19"]
        self.process = subprocess.Popen([*idle, "bash", "-uc", f". cmake/setup.sh; {command}"], cwd=ROOT, start_new_session=True,
                                        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        # The kernel gives each session the same share of the processors whatever the class of its threads (autogroup, sched(7)), so
        # that a build in a session of its own took half of the time of every test. This makes the share of the session small too.
        try:
            Path(f"/proc/{self.process.pid}/autogroup").write_text("19")
        except OSError:
            pass  # a kernel without it

    def end(self) -> None:
        if self.process.poll() is None:
            os.killpg(self.process.pid, signal.SIGTERM)  # ninja removes what it has begun
        self.process.communicate()  # the pipe ends with the last of the group: two ninjas in one folder would be one too many


def later_lists(options: argparse.Namespace) -> list[str]:
    lists = ["cmake/packages-later.txt"]
    if options.peers:
        lists.append("cmake/packages-peers.txt")
    # User-Mode Linux fails on these processors (tests/support/run-in-vcan.sh).
    if "amx_tile" in Path("/proc/cpuinfo").read_text(encoding="ascii").split():
        lists.append("cmake/packages-amx.txt")
    return lists


class LaterPackages:
    """Installs packages that only the tests need, while the release is built."""

    def __init__(self, lists: str):
        self.process = subprocess.Popen(["bash", "-uc", f". cmake/setup.sh; ensure_packages {lists}"], cwd=ROOT,
                                        stdin=subprocess.DEVNULL)

    def wait(self) -> Report:
        report = Report()
        if self.process.wait() == 0:
            report.notes.append("installed")
        else:
            report.fail("packages for the tests", "see above")
        return report


class Check:
    def __init__(self, options: argparse.Namespace):
        self.options = options
        self.total = Report()
        self.rows: list[tuple[str, float, str]] = []
        self.packages = LaterPackages(" ".join(later_lists(options)))

    def stage(self, name: str, action) -> bool:
        """Runs `action`, which returns a Report; False if anything in it failed."""
        print(f"== {name}", file=sys.stderr, flush=True)
        start = time.monotonic()
        report = action()
        self.rows.append((name, time.monotonic() - start, str(report)))
        for failure in report.failed:
            print(f"FAILED {failure.name}\n{failure.detail}\n", file=sys.stderr, flush=True)
        self.total.add(report, name)
        return not report.failed

    def build(self, preset: str, folder: str, *targets: str, settings: Sequence[str] = ()) -> bool:
        command = f"configure {preset} {folder} {' '.join(settings)} && build {folder} {' '.join(targets)}"

        def action() -> Report:
            report = Report()
            if shell(command):
                report.notes.append("built")
            else:
                report.fail("it does not build", "see above")
            return report

        return self.stage(f"build {folder}", action)

    def tests(self, name: str, folder: str, *selection: str, **environment: str) -> bool:
        return self.stage(name, lambda: run_tests(ROOT / folder, name, list(selection), environment))

    def peers(self) -> bool:
        """The comparisons with programs of others, all of which are there now: what skips has not been compared."""

        def action() -> Report:
            # What takes longer than a plain ./check may take skips without this.
            report = run_tests(ROOT / "build", "peers", ["-L", "^peers$"], {"CELLMIRROR_PEERS": "1"})
            for case in report.skipped:
                report.fail(case.name, f"it was skipped, and nothing compared: {case.detail}")
            report.skipped.clear()
            if "no such tests" in report.notes:
                report.fail("no test is labelled peers", "see cmake/Testing.cmake")
            return report

        return self.stage("peers", action)

    def release(self) -> None:
        cache = ROOT / "build/CMakeCache.txt"
        without_tests = cache.exists() and "CELLMIRROR_TESTS:BOOL=OFF" in cache.read_text()
        targets = []  # all; what runs with sanitizers in a whole check is built without them only where that check is not whole
        if self.options.label == "bench" or self.options.full:
            targets = ["all", "benches"]
        elif self.options.quick or self.options.label in ("unit", "golden", "fuzz"):
            targets = ["all", "tests_sanitized"]
        settings = ["-DCELLMIRROR_TESTS=ON"] if without_tests else []
        if self.options.once:
            settings.append("-DCELLMIRROR_ONCE=ON")
        if not self.build("release", "build", *targets, settings=settings):
            self.packages.wait()
            return
        self.stage("packages", self.packages.wait)
        if self.options.peers:
            self.peers()
        elif self.options.label:
            self.tests("tests", "build", "-L", f"^({self.options.label})$")
        elif self.options.quick:
            self.tests("tests", "build", "-LE", "^(integration|stress|bench)$")
        else:
            early = EarlyBuild(f"{SANITIZED_BUILD}; {THREAD_BUILD}")
            try:
                self.tests("tests", "build", "-LE", "^sanitized$" if self.options.full else "^(sanitized|bench)$")
            finally:
                early.end()

    def sanitizers(self) -> None:
        if self.build("fuzz", "build-fuzz", *SANITIZED_TARGETS):
            seconds = os.environ.get("FUZZ_SECONDS", "1")
            self.tests("address, undefined", "build-fuzz", "-L", "^(unit|golden|fuzz|whole)$", "-LE", "^libfuzzer$", **SANITIZER_OPTIONS)
            # Another seed each day; what failed can be repeated with the one that is printed.
            seed = os.environ.get("FUZZ_SEED", time.strftime("%Y%m%d", time.gmtime()))
            self.tests(f"fuzzing, {seconds} s each, FUZZ_SEED={seed}", "build-fuzz", "-L", "^libfuzzer$", FUZZ_SECONDS=seconds,
                       FUZZ_SEED=seed, **SANITIZER_OPTIONS)
        if self.build("tsan", "build-tsan", *THREAD_TARGETS):
            self.tests("threads", "build-tsan", "-L", "^(stress|concurrency)$", **SANITIZER_OPTIONS)

    def tidy(self) -> None:
        self.stage("clang-tidy", lambda: clang_tidy.run(ROOT / "build-fuzz", full=self.options.full))

    def finish(self) -> int:
        print()
        width = max(len(name) for name, _, _ in self.rows)
        for name, seconds, result in self.rows:
            print(f"{name:<{width}}  {seconds:7.1f} s  {result}")
        started = os.environ.get("CHECK_STARTED")
        if started:
            print(f"{'in all':<{width}}  {time.time() - float(started):7.1f} s")
        self.total.print_skipped()
        for failure in self.total.failed:
            print(f"failed: {failure.name}")
        print(f"{self.total.passed} passed, {len(self.total.failed)} failed, {len(self.total.skipped)} skipped", flush=True)
        return 1 if self.total.failed else 0


def main() -> int:
    parser = argparse.ArgumentParser(prog="./check", description="Installs missing packages, builds, and runs every test.")
    parser.add_argument("--quick", action="store_true", help="release build only: lint and tests without timing")
    parser.add_argument("--full", action="store_true", help="also clang-tidy over every source, without a time limit, and benchmarks")
    parser.add_argument("--once", action="store_true",
                        help="for a folder that is not built again, as in CI: compiles large batches, which makes the first build shorter and later ones longer")
    parser.add_argument("--label", help="only the release tests with this label: unit, integration, golden, fuzz, stress, lint, docs, bench")
    parser.add_argument("--peers", action="store_true",
                        help="installs the programs in cmake/packages-peers.txt, and runs only the comparisons with them; a skip fails")
    check = Check(parser.parse_args())
    check.release()
    if not check.options.quick and not check.options.label and not check.options.peers:
        check.sanitizers()
        check.tidy()
    return check.finish()


if __name__ == "__main__":
    sys.exit(main())

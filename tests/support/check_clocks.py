"""Time or a `Clock&` is passed in: no source makes a SystemClock or reads a clock but those of the table below.
Arguments: the source root. What is found in comments and strings does not count."""

import re
import sys
from pathlib import Path

ROOT = Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
FOLDERS = ("app", "config", "drivers", "ipc", "rt_core", "scripts", "sim_devices")
SOURCES = {".cpp", ".hpp", ".h", ".c"}

# File or folder -> why it may read a clock. A line that no source needs any more is refused, too.
EXCEPTIONS = {
    "rt_core/base/time.hpp": "SystemClock itself",
    "rt_core/base/time.cpp": "SystemClock itself, and the offset between the monotonic clock and the wall clock",
    "rt_core/base/log.cpp": "the rate limit of messages, which come from all threads",
    "rt_core/rt": "the cyclic thread sleeps by the monotonic clock of the system and by no other",
    "drivers/can/channel": "I/O: receive time stamps and waiting with a limit, on the thread of a channel",
    "drivers/dds/internal/action_server.cpp": "I/O: the wall-clock time at which a goal came is a part of its answer",
    "drivers/dds/internal/findings_writer.hpp": "I/O: how often diagnostics and markers are written, on the publisher's thread",
    "drivers/display/internal/volume/volume_casting.hpp": "measures how long volumes take, by which their resolution follows",
    "drivers/dds/internal/bytes_reader.hpp": "I/O: the age of a sample that another process has taken, on the link's thread",
    "drivers/dds/process/endpoints.cpp": "I/O: the instant at which a sample is taken, in a process of its own",
    "drivers/mqtt/internal/session.hpp": "I/O: watches a process, on the connection's thread",
    "ipc/sandbox/sandbox.hpp": "I/O: watches a process and starts it again, on a thread of its own",
    "ipc/control": "I/O: time limits of the control socket, on the threads of server and client",
    "ipc/sysv/script_client.cpp": "I/O: how long the client waits for an answer, on its own thread",
    "config/volume/volume_process.cpp": "I/O: how long the process that reads a slice may take, on the thread that waits for it",
    "config/volume/volume_process.hpp": "the same",
    "config/mesh_process.cpp": "I/O: how long the process that reads a mesh may take, on the thread that waits for it",
    "app/gateway/gateway_parts.hpp": "wiring: makes the clock of the gateway",
    "app/subcommands": "wiring: makes the clock of a command that runs no gateway",
    "app/console/progress_line.hpp": "how often a command shows its progress",
    "app/console/progress_line.cpp": "how often a command shows its progress",
    "app/pictures/film.cpp": "paces the pictures of a film that a command takes",
    "app/pictures/cell_snapshot.cpp": "the time of a picture of a cell that is not running",
    "app/proximity": "measures the computation that the command reports, and nothing depends on it",
    "app/simulation": "measures the wall and processor time that the command reports; the simulated time is a ManualClock",
    "sim_devices": "programs of their own, whose threads play devices in real time",
}

CLOCK = re.compile(r"\bSystemClock\b"
                   r"|\b(?:steady|system|high_resolution|utc|tai|gps|file)_clock\b|\bclock::now\b"
                   r"|\b(?:clock_gettime|gettimeofday|timespec_get|ftime|__rdtscp?|__builtin_ia32_rdtscp?)\s*\("
                   r"|\bstd::(?:time|clock)\s*\(|(?<![\w.>])time\s*\(\s*(?:NULL|nullptr|0|&\s*\w+)\s*\)")
TEXT = re.compile(r'//[^\n]*|/\*.*?\*/|R"(?P<mark>[^\s()\\]*)\(.*?\)(?P=mark)"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'',
                  re.DOTALL)
DIGITS = re.compile(r"(?<=[0-9a-fA-F])'(?=[0-9a-fA-F])")

# The check checks itself: what it has to find, and what it must not.
PLANTED = ("SystemClock clock;", "const auto now = std::chrono::steady_clock::now();", "using C = high_resolution_clock;",
           "clock_gettime(CLOCK_MONOTONIC, &t);", "::time(nullptr)", "std::time(nullptr)", "x = time(&now);",
           "file_time_type::clock::now()", "gettimeofday (&t, nullptr);", "1'000; auto t = system_clock::now(); // '")
INNOCENT = ("// SystemClock", '"steady_clock::now()"', "clock_.now()", "/* gettimeofday(\n) */", "state.time(0)",
            "const Clock& clock", "clock_nanosleep(CLOCK_MONOTONIC, 0, &t, nullptr)", "ManualClock clock;")


def without_texts(source: str) -> str:
    """Comments and string literals become blanks; line numbers stay."""
    source = DIGITS.sub("", source)
    return TEXT.sub(lambda match: "\n" * match[0].count("\n") + " ", source)


def readings(source: str) -> list[tuple[int, str]]:
    """(line, what) of each reading of a clock."""
    code = without_texts(source)
    return [(code.count("\n", 0, match.start()) + 1, match[0].strip(" (")) for match in CLOCK.finditer(code)]


def exception_of(path: Path) -> str | None:
    return next((row for row in EXCEPTIONS if path.is_relative_to(row)), None)


def main() -> int:
    errors = [f"{__file__}: does not find {text!r}" for text in PLANTED if not readings(text)]
    errors += [f"{__file__}: finds {text!r}" for text in INNOCENT if readings(text)]
    used = set()
    for folder in FOLDERS:
        for source in sorted((ROOT / folder).rglob("*")):
            if source.suffix not in SOURCES:
                continue
            path = source.relative_to(ROOT)
            row = exception_of(path)
            for line, what in readings(source.read_text(errors="replace")):
                if row is None:
                    errors.append(f"{path}:{line}: {what}: have the time or a Clock& passed in, or say in {Path(__file__).name} "
                                  "why this file reads a clock")
                else:
                    used.add(row)
    errors += [f"{Path(__file__).name}: no source of {row} reads a clock: take the line out" for row in EXCEPTIONS
               if row not in used]
    print("\n".join(errors) or f"{len(EXCEPTIONS)} exceptions, each in use")
    return 1 if errors else 0


sys.exit(main())

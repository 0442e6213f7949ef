"""House rules that a compiler cannot check. Arguments: the source root, then which check: format, files, docs."""

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(sys.argv[1]).resolve()
CODE = {".cpp", ".hpp", ".h", ".c"}
MAX_LINES = 600
MARKS = re.compile(r"\b(TO" r"DO|FIX" r"ME|X" r"XX|HA" r"CK)\b")
HOME_PATHS = re.compile(r"(?<![\w.$}])/(root|home/[a-z]+|work)/")
# Flags and counters are allowed everywhere; lock-free structures are in rt_core/rt, with stress tests under ThreadSanitizer,
# and the words of shared memory in ipc/wire/shared_words.hpp, tested likewise. C programs have a header of their own.
HOMES_OF_LOCK_FREE = ("rt_core/rt", "tests", "ipc/wire/shared_words.hpp", "docs/examples/cellmirror_haptic.h")
LOCK_FREE = re.compile(r"std::atomic<(?!bool>|int>|std::u?int(?:32|64)_t>)[^>]*>|std::atomic_ref"
                       r"|compare_exchange\w+|atomic_thread_fence|__atomic_\w+|__sync_\w+")


def tracked_files() -> list[Path]:
    """Files known to git or not ignored; without a checkout, all files outside build folders."""
    listing = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT,
                             capture_output=True, text=True)
    if listing.returncode == 0:
        names = [Path(name) for name in listing.stdout.split("\0") if name]
    else:
        names = [path.relative_to(ROOT) for path in ROOT.rglob("*")]
        names = [name for name in names if not name.parts[0].startswith(("build", "."))]
    return sorted(name for name in names if (ROOT / name).is_file())


def check_format() -> list[str]:
    sources = [str(path) for path in tracked_files() if path.suffix in CODE]
    result = subprocess.run(["clang-format-19", "--dry-run", "-Werror", *sources], cwd=ROOT, capture_output=True, text=True)
    if result.returncode == 0:
        return []
    wrong = sorted(set(re.findall(r"^([^\s:]+):\d+:\d+: error", result.stderr, re.MULTILINE)))
    return [f"{path}: fix it by clang-format-19 -i {path}" for path in wrong] or [result.stderr]


def is_shell(path: Path) -> bool:
    return path.suffix == ".sh" or (not path.suffix and (ROOT / path).read_bytes().startswith(b"#!/bin/bash"))


def check_files() -> list[str]:
    errors = []
    for path in tracked_files():
        text = (ROOT / path).read_text(errors="replace")
        data = path.is_relative_to("tests/data") or "corpus" in str(path) or path.suffix in (".png", ".jpg")
        if path.suffix in CODE:
            lines = text.count("\n")
            if lines > MAX_LINES:
                errors.append(f"{path}: {lines} lines; split it by subject ({MAX_LINES} at most)")
            if path.suffix in (".hpp", ".h") and not re.search(r"^#pragma once|^#ifndef|HWY_TARGET_TOGGLE", text, re.MULTILINE):
                errors.append(f"{path}: no #pragma once")
            home_of_lock_free = any(path.is_relative_to(home) for home in HOMES_OF_LOCK_FREE)
            if not home_of_lock_free and (match := LOCK_FREE.search(text)):
                errors.append(f"{path}: {match[0]} belongs in rt_core/rt: use Fifo, Latest, Ring or shared_words")
        if is_shell(path):
            result = subprocess.run(["bash", "-n", str(ROOT / path)], capture_output=True, text=True)
            errors += [f"{path}: {result.stderr.strip()}"] if result.returncode else []
        if not data and path.name != "LICENSE":
            errors += [f"{path}: {match[0]} left in" for match in [MARKS.search(text)] if match]
            errors += [f"{path}: a path of one machine: {match[0]}" for match in [HOME_PATHS.search(text)] if match]
    errors += [f"{path.parent}: no README.md (purpose, what it may include, real-time class, where to start)"
               for path in tracked_files()
               if path.name == "CMakeLists.txt" and path.parts[0] not in ("CMakeLists.txt", "tests", "cmake")
               and not (ROOT / path.parent / "README.md").exists()]
    return errors


def check_docs() -> list[str]:
    """Every relative link of a Markdown file leads to a file that exists; every page is reachable from docs/README.md."""
    errors = []
    linked = set()
    pages = [path for path in tracked_files() if path.suffix == ".md"]
    for page in pages:
        text = re.sub(r"```.*?```", "", (ROOT / page).read_text(), flags=re.DOTALL)
        for target in re.findall(r"\[[^\]]*\]\(([^)\s]+)\)", text):
            if re.match(r"[a-z]+:|#", target):
                continue
            goal = (ROOT / page).parent / target.split("#")[0]
            if not goal.exists():
                errors.append(f"{page}: the link to {target} has no target")
            else:
                linked.add(goal.resolve())
    errors += [f"{page}: no page links to it" for page in pages
               if page.parts[0] == "docs" and (ROOT / page).resolve() not in linked and page != Path("docs/README.md")]
    return errors


def main() -> int:
    errors = {"format": check_format, "files": check_files, "docs": check_docs}[sys.argv[2]]()
    print("\n".join(errors) or "as agreed")
    return 1 if errors else 0


sys.exit(main())

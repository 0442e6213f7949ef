"""Collects what AddressSanitizer, UndefinedBehaviorSanitizer, LeakSanitizer and ThreadSanitizer report of programs that were
built with them. Children report into files, so that no report is lost in a log that nobody reads."""

import os
import pathlib
import tempfile

SUPPORT = pathlib.Path(__file__).resolve().parent

# new_delete_type_mismatch: Fast DDS 2.9 deletes the listeners of its statistics by a type that is smaller than what it made.
OPTIONS = {
    "ASAN_OPTIONS": "detect_leaks=1:strict_string_checks=1:detect_stack_use_after_return=1:new_delete_type_mismatch=0",
    "UBSAN_OPTIONS": "print_stacktrace=1:halt_on_error=1",
    "LSAN_OPTIONS": f"suppressions={SUPPORT}/lsan.supp:print_suppressions=0",
    # All of them in one run: a race does not end the program.
    "TSAN_OPTIONS": f"halt_on_error=0:second_deadlock_stack=1:history_size=4:suppressions={SUPPORT}/tsan.supp:"
                    "print_suppressions=0",
}


class Reports:
    """A folder that the programs report into."""

    def __init__(self):
        self.folder = tempfile.TemporaryDirectory(prefix="cellmirror-reports-")

    def environment(self):
        """For the programs. What the caller's environment says goes before."""
        own = f"log_path={self.folder.name}/report"
        return {name: f"{options}:{os.environ.get(name, '')}:{own}" for name, options in OPTIONS.items()}

    def texts(self):
        return [path.read_text(errors="replace") for path in sorted(pathlib.Path(self.folder.name).iterdir())]

    def close(self):
        self.folder.cleanup()

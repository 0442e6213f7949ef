"""Whether tick_calls.py finds what tests/lint/tick/planted.cpp does behind a virtual call. Arguments as of tick_calls.py."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(sys.argv[1]).resolve()
EXPECTED = {
    "operator new": "Device::read", "pthread_mutex_lock": "Device::read", "write is not in": "Device::write",
    "__cxa_throw": "Device::fail", "1 call(s) through a pointer": "Device::write", 'assembly "syscall"': "Device::write",
}


def main() -> int:
    result = subprocess.run([sys.executable, "-B", str(ROOT / "tests/support/tick_calls.py"), sys.argv[1], sys.argv[2], "--plant",
                             str(ROOT / "tests/lint/tick/planted.cpp")], capture_output=True, text=True)
    if result.returncode == 77:
        print(result.stdout)
        return 77
    findings = result.stdout.replace("\n    ", "\t").splitlines()
    errors = [] if result.returncode == 1 else [f"ended with {result.returncode}: {result.stderr}"]
    for what, where in EXPECTED.items():
        if not any(what in line and where in line and "HapticChannel" in line and "CyclicThread::loop" in line for line in findings):
            errors.append(f"not found: {what} in {where}, with the calls that lead there")
    if not any("planted::Device implements cellmirror::HapticDevicePort" in line for line in findings):
        errors.append("not found: that the list of implementers lacks one")
    if not any("declares Device, which derives from cellmirror::HapticDevicePort" in line for line in findings):
        errors.append("not found: that a source declares an implementer that is not listed")
    strangers = [line for line in findings if "Device" not in line]
    errors += [f"found without being planted: {line}" for line in strangers]
    print("\n".join(errors) or f"all {len(EXPECTED) + 2} planted faults are found")
    return 1 if errors else 0


sys.exit(main())

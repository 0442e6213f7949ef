"""Reads the shipped EDS files with other tools: canopen for Python and lely's dcf tools, which ros2_canopen uses.

    /usr/bin/python3 tests/peers/eds_files.py CANOPEN LELY [FILE...]

CANOPEN is a checkout of https://github.com/canopen-python/canopen, LELY one of https://gitlab.com/lely_industries/lely-core. Without
FILE: those of config/devices and config/cells. Only the readers of these tools run; nothing is installed. Prints their findings; the
exit status is 1 if a tool refuses a file, warns of it, or loses a value."""

import pathlib
import re
import sys
import types
import warnings

ROOT = pathlib.Path(__file__).resolve().parents[2]
NODE = 5


def readers(canopen, lely):
    """Imports only the file readers of canopen: the rest needs a CAN library. SdoClient would read a device."""
    sys.path[:0] = [str(pathlib.Path(lely) / "python/dcf-tools")]
    package = types.ModuleType("canopen")
    package.__path__ = [str(pathlib.Path(canopen) / "canopen")]
    sdo = types.ModuleType("canopen.sdo")
    sdo.SdoClient = None
    sys.modules.update({"canopen": package, "canopen.sdo": sdo})
    from canopen import objectdictionary
    import dcf
    return objectdictionary, dcf


def shipped():
    return sorted([*(ROOT / "config/devices").glob("*.eds"), *(ROOT / "config/cells").rglob("*.eds")])


def written_values(path):
    """Index, subindex and text of each DefaultValue."""
    for section, body in re.findall(r"^\[([^\]]+)\]\s*$(.*?)(?=^\[|\Z)", path.read_text(), re.M | re.S):
        name = re.fullmatch(r"([0-9A-Fa-f]{4})(?:sub([0-9A-Fa-f]+))?", section)
        value = re.search(r"^DefaultValue=(.+)$", body, re.M)
        if name and value:
            yield int(name[1], 16), int(name[2] or "0", 16), value[1].strip()


def judge(path, objectdictionary, dcf):
    found = []
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        try:
            if not dcf.lint(dcf.parse_file(str(path))):
                found.append("lely's lint refuses it")
            dcf.Device.from_dcf(str(path), {"NODEID": NODE})
        except Exception as problem:  # any exception of the reader is a finding
            found.append(f"lely: {problem!r}")
    found += [f"lely: {warning.message}" for warning in told]
    try:
        objects = objectdictionary.import_od(str(path), NODE)
    except Exception as problem:
        return [*found, f"canopen: {problem!r}"]
    for index, sub, text in written_values(path):
        entry = objects.get(index)
        if entry is not None and not isinstance(entry, objectdictionary.ODVariable):
            entry = entry.subindices.get(sub)
        if entry is None or entry.default is None:
            found.append(f"canopen loses {index:04X}sub{sub:X}={text}")
            continue
        limits = {5: 8, 6: 16, 7: 32}.get(entry.data_type)
        if limits and not 0 <= entry.default < 1 << limits:
            found.append(f"canopen reads {entry.default:#x} from {index:04X}sub{sub:X}={text}")
    return found


def main():
    objectdictionary, dcf = readers(sys.argv[1], sys.argv[2])
    paths = [pathlib.Path(name) for name in sys.argv[3:]] or shipped()
    bad = 0
    for path in paths:
        found = judge(path, objectdictionary, dcf)
        print(f"{path}: " + ("; ".join(found) if found else "no findings"))
        bad += bool(found)
    return 1 if bad or not paths else 0


if __name__ == "__main__":
    sys.exit(main())

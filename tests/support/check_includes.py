"""Checks every #include of ours against the table in cmake/Layers.cmake, and that no header which another folder
includes, directly or through others, drags a private third-party library in. Arguments: the source root."""

import re
import sys
from pathlib import Path

ROOT = Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
SOURCES = ("*.cpp", "*.hpp", "*.h", "*.c")
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]+([<"])([^>"]+)[>"]', re.MULTILINE)
# Each of these is private to the folder that links it. (What may show: the standard library, POSIX, Eigen,
# fmt/core.h, Boost's lock-free queue inside our own.)
PRIVATE_LIBRARIES = re.compile(r"^(fcl|ccd|coin|Ip[A-Z]|GL/|GLES|EGL|fastdds|fastrtps|fastcdr|ft2build|freetype|nlohmann|toml\+\+|toml\.hpp"
                               r"|tinyxml2|spdlog|CLI/|dds/|urdf|assimp|embree|civetweb|turbojpeg|png|cairo|gdcm|mosquitto|mqtt_protocol|google/protobuf|.*\.pb\.h)")
# The programs' own folders: nobody includes them whom cmake/Layers.cmake does not name, and their headers may show what
# they like.
PROGRAM_FOLDERS = ("app", "sim_devices", "tests")


def is_program(folder: str | None) -> bool:
    return folder is not None and folder.split("/")[0] in PROGRAM_FOLDERS


def layers() -> dict[str, set[str]]:
    text = (ROOT / "cmake/Layers.cmake").read_text()
    table = text[text.index("set(CELLMIRROR_LAYERS"):]
    rows = re.findall(r'"([^":]+):([^"]*)"', table[:table.index('")') + 2])
    return {folder: set(allowed.split()) for folder, allowed in rows}


def folder_of(path: str, table: dict[str, set[str]]) -> str | None:
    """The folder of the table that holds the file `path`: the longest that fits."""
    holders = [folder for folder in table if path.startswith(folder + "/")]
    return max(holders, key=len, default=None)


def files(table: dict[str, set[str]]) -> dict[str, list[tuple[str, str, int]]]:
    """Path -> its includes (kind, name, line)."""
    found = {}
    for top in sorted({folder.split("/")[0] for folder in table}):
        for pattern in SOURCES:
            for path in sorted((ROOT / top).rglob(pattern)):
                text = path.read_text(errors="replace")
                found[str(path.relative_to(ROOT))] = [
                    (match[1], match[2], text.count("\n", 0, match.start()) + 1) for match in INCLUDE.finditer(text)]
    return found


def check_layers(table, sources) -> list[str]:
    errors = []
    for path, includes in sources.items():
        home = folder_of(path, table)
        if home is None:
            errors.append(f"{path}:1: its folder is not in cmake/Layers.cmake")
            continue
        for kind, name, line in includes:
            if kind == "<" and name in sources:
                errors.append(f'{path}:{line}: <{name}> is a header of ours: write #include "{name}"')
            if kind == "<" or name in sources and folder_of(name, table) == home:
                continue
            if name not in sources:
                known = "a header beside the file" if (ROOT / path).with_name(Path(name).name).exists() else "no header of ours"
                if home != "tests":
                    errors.append(f'{path}:{line}: "{name}" is {known}: write the path from the project\'s root')
                continue
            used = folder_of(name, table)
            if used not in table[home] and "*" not in table[home]:
                errors.append(f"{path}:{line}: {home} may not include {used} ({name}): cmake/Layers.cmake")
            elif used in PROGRAM_FOLDERS and used not in table[home] and home != "tests":
                errors.append(f"{path}:{line}: nobody includes {used} ({name})")
    return errors


def check_leaks(table, sources) -> list[str]:
    """A header that shows a private library must not be reachable from another folder."""
    shows: dict[str, str] = {}  # header -> how the private library gets in

    def way_in(header: str, visited: set[str]) -> str | None:
        if header in shows:
            return shows[header]
        if header in visited:
            return None
        visited.add(header)
        for kind, name, line in sources[header]:
            if kind == "<" and PRIVATE_LIBRARIES.match(name) and name != "fmt/core.h":
                shows[header] = f"{header}:{line} includes <{name}>"
                return shows[header]
            if name in sources and (through := way_in(name, visited)):
                shows[header] = f"{header}:{line} -> {through}"
                return shows[header]
        return None

    errors = []
    for path, includes in sources.items():
        home = folder_of(path, table)
        if is_program(home):
            continue
        for _, name, line in includes:
            if name in sources and folder_of(name, table) != home and (through := way_in(name, set())):
                errors.append(f"{path}:{line}: a private library leaks out of {folder_of(name, table)}: {through}")
    # Programs and tests may use the libraries themselves, but a library's header must not force one on them.
    for path, includes in sources.items():
        if path.startswith("app/"):
            for _, name, line in includes:
                if name in sources and not is_program(folder_of(name, table)) and (through := way_in(name, set())):
                    errors.append(f"{path}:{line}: a private library leaks out of {folder_of(name, table)}: {through}")
    return errors


def main() -> int:
    table = layers()
    sources = files(table)
    errors = check_layers(table, sources) + check_leaks(table, sources)
    print("\n".join(errors) or f"{len(sources)} files follow the {len(table)} rows of cmake/Layers.cmake")
    return 1 if errors or not sources else 0


sys.exit(main())

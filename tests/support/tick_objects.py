"""The calls of the release build's own machine code, for tick_calls.py: the direct calls and jumps out of each function of
the libraries that the tick consists of."""

import re
import subprocess
from pathlib import Path

LIBRARIES = ("rt_core/base", "rt_core/rt", "rt_core/kinematics", "rt_core/motion", "rt_core/haptics", "rt_core/engine",
             "drivers/haptic", "ipc/wire")

SYMBOL = re.compile(r"^([0-9a-f]{16}) ([lgu! ])\S* .*?F (\S+)\s+[0-9a-f]{16} (?:\.hidden )?(\S+)$")
FUNCTION = re.compile(r"^[0-9a-f]{16} <(.+)>:$")
SECTION = re.compile(r"^Disassembly of section (\S+):$")
BRANCH = re.compile(r"^\s*[0-9a-f]+:\t(?:\S+ )*?(?:call|j[a-z]+)\s+(?:([0-9a-f]+) <([^>+]+)|\*)")
RELOCATION = re.compile(r"^\s+[0-9a-f]+: R_X86_64_\w+\s+(.+?)([+-]0x[0-9a-f]+)?$")

Graph = dict[str, set[str]]


def read_member(lines: list[str], member: str, graph: Graph) -> None:
    """Names that are local to an object carry its name."""
    local: set[str] = set()
    at: dict[str, dict[int, list[str]]] = {}  # section -> offset -> functions that begin there
    for line in lines:
        if match := SYMBOL.match(line):
            at.setdefault(match[3], {}).setdefault(int(match[1], 16), []).append(match[4])
            if match[2] == "l":
                local.add(match[4])

    def name_of(symbol: str) -> str:
        return f"{symbol}#{member}" if symbol in local else symbol

    def target_of(symbol: str, addend: str | None) -> str:
        if symbol not in at:
            return name_of(symbol)
        offset = int(addend or "0", 16) + 4  # relative to the end of a field of four bytes
        return name_of(at[symbol][max(place for place in at[symbol] if place <= offset)][0])

    def within(section: str, address: int, shown: str) -> str:
        """Of a branch without a relocation, whose name may be that of a constant at this address of another section."""
        before = [place for place in at.get(section, {}) if place <= address]
        return name_of(at[section][max(before)][0]) if before else name_of(shown)

    current, section, branch = "", "", None  # what objdump shows as a branch's target holds where no relocation follows
    for line in [*lines, "-"]:
        if branch is not None:
            relocation = RELOCATION.match(line)
            graph[current].add(target_of(relocation[1], relocation[2]) if relocation else
                               within(section, int(branch[1], 16), branch[2]))
            branch = None
        if match := SECTION.match(line):
            section = match[1]
        elif match := FUNCTION.match(line):
            current = name_of(match[1])
            graph.setdefault(current, set())
        elif (match := BRANCH.match(line)) and match[1]:
            branch = match
    for functions in at.values():
        for same in functions.values():
            calls = set().union(*(graph.get(name_of(name), set()) for name in same))
            for name in same:
                graph[name_of(name)] = calls


def graph_of(build: Path) -> Graph:
    graph: Graph = {}
    for folder in LIBRARIES:
        archive = build / folder / f"libcellmirror_{folder.replace('/', '_')}.a"
        text = subprocess.run(["objdump", "-drt", "--no-show-raw-insn", str(archive)], capture_output=True, text=True,
                              check=True).stdout
        for member in re.split(r"\n(?=\S+\.o:\s+file format)", text):
            if ".o:" in member:
                read_member(member.splitlines(), folder + "/" + member.strip().split(":")[0], graph)
    return graph


def walk(graph: Graph, roots: set[str]) -> dict[str, str | None]:
    """What the roots reach, and from where. Roots are mangled names; parts that the compiler has split off (.cold, .part.0)
    and copies (.constprop.0) of a root are roots, too."""
    found: dict[str, str | None] = {name: None for name in graph if re.split(r"[.#]", name)[0] in roots}
    todo = list(found)
    while todo:
        name = todo.pop()
        for callee in graph.get(name, ()):
            if callee not in found:
                found[callee] = name
                todo.append(callee)
    return found

"""Lists every function that the tick can reach and refuses what CELL_RT forbids: heap, waiting locks, exceptions,
formatting, system calls. Arguments: the source root, the release build, then optionally
  --list          prints each reachable function
  --plant FILE    one more source, whose classes implement what they derive from

It walks over the intermediate code that clang makes of the same sources with the release build's optimisation. Every
call is either direct, or virtual, or through a pointer:
- A direct call of a function that no analysed source defines has to be in tests/lint/tick/allowed.txt with its reason.
  So nothing is looked for by name: what is not known to be harmless is refused.
- A virtual call carries the class through which it is made (-fwhole-program-vtables), and each vtable the classes that it
  serves. The calls of all implementers are followed. The implementers of each class have to be those of
  tests/lint/tick/implementers.txt, and those that the sources declare.
- Any other call through a pointer has to be in tests/lint/tick/pointers.txt with all its targets.
Then it walks over the machine code of the release build (tick_objects.py): all direct calls of the same functions, and of
what they call there, have to end in functions of ours or in allowed.txt. docs/tick.md says more.
"""

import re
import shutil
import subprocess
import sys
from collections import deque
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

import tick_objects

ROOT = Path(sys.argv[1]).resolve()
TABLES = ROOT / "tests/lint/tick"
ROOTS = ("cellmirror::CyclicThread::loop(",)  # it calls Cycle::run, and so the engine
MUST_REACH = ("cellmirror::engine::Engine::run(",)
FLAGS = ["-std=c++23", "-O2", "-DFMT_SHARED", "-w", "-flto", "-fwhole-program-vtables", f"-I{ROOT}",
         "-isystem", "/usr/include/eigen3"]
# What is compiled together: each parses its headers once. The rest of these folders is not reachable from the tick; a
# function of ours that is called and not analysed is an error, so nothing can be missing here unnoticed.
ANALYSED = {
    "rt": ["rt_core/rt/cyclic_thread.cpp", "rt_core/rt/allocation_guard.cpp", "rt_core/rt/latency_histogram.cpp",
           "rt_core/rt/watchdog.cpp", "rt_core/base/time.cpp", "rt_core/base/pose.cpp"],
    "kinematics": ["rt_core/kinematics"],
    "motion": ["rt_core/motion"],
    "haptics": ["rt_core/haptics"],
    "engine": ["rt_core/engine", "drivers/haptic", "ipc/wire/haptic_block.cpp"],
}
AVX2 = {"rt_core/kinematics/forward_kernel_avx2.cpp": ["-mavx2", "-mfma"]}  # as in its folder's CMakeLists.txt
KERNELS = "-DCELLMIRROR_AVX2_KERNELS"
# What nearly every unit includes is parsed once: 13 s of processor time in all instead of 27, and the same intermediate code.
COMMON_HEADERS = ("<algorithm>", "<chrono>", "<cmath>", "<functional>", "<map>", "<memory>", "<string>", "<variant>", "<vector>",
                  "<Eigen/Geometry>", '"rt_core/engine/engine.hpp"')


# ---------------------------------------------------------------------------------------------------- compiling

def apart(folder: Path) -> set[Path]:
    """The sources that a folder compiles each by itself (cmake/Library.cmake)."""
    text = (folder / "CMakeLists.txt").read_text()
    return {folder / name for match in re.finditer(r"cellmirror_apart\(([^)]*)\)", text) for name in match[1].split()}


def sources_of(entries: list[str]) -> tuple[list[str], list[str]]:
    """Those that are compiled together, and those that are not."""
    together, alone = [], []
    for entry in entries:
        path = ROOT / entry
        files = sorted(path.glob("*.cpp")) if path.is_dir() else [path]
        for file in files:
            name = str(file.relative_to(ROOT))
            if name not in AVX2:
                (alone if path.is_dir() and file in apart(path) else together).append(name)
    return together, alone


def units(plants: list[str]) -> dict[str, tuple[list[str], list[str]]]:
    """Name -> (sources, flags)."""
    made = {}
    for name, entries in ANALYSED.items():
        together, alone = sources_of(entries)
        made[name] = (together, [KERNELS])
        made |= {Path(source).stem: ([source], [KERNELS]) for source in alone}
    made |= {Path(source).stem: ([source], flags) for source, flags in AVX2.items()}
    made["implementers"] = ([str(TABLES.relative_to(ROOT) / "implementers.cpp")], [KERNELS])
    return made | {"plant_" + Path(plant).stem: ([plant], [KERNELS]) for plant in plants}


def is_current(output: Path, wish: str) -> bool:
    """Nothing that it was made of has changed since."""
    made_with = output.with_suffix(".wish")
    if not output.exists() or not made_with.exists() or made_with.read_text() != wish:
        return False
    needed = [ROOT / name for name in re.sub(r"\\\n", " ", output.with_suffix(".d").read_text()).split()[1:]]  # clang ran in ROOT
    return all(file.exists() and file.stat().st_mtime <= output.stat().st_mtime for file in needed)


def made_by(command: list[str], text: str, output: Path) -> Path:
    """What `command` makes of `text`, made again only where something has changed."""
    command = [*command, "-MD", "-MF", str(output.with_suffix(".d")), "-", "-o", str(output)]
    wish = "\n".join([*command, text])
    if not is_current(output, wish):
        output.with_suffix(".wish").unlink(missing_ok=True)
        subprocess.run(command, input=text, text=True, check=True, cwd=ROOT)
        output.with_suffix(".wish").write_text(wish)
    return output


def common_headers(folder: Path) -> Path:
    text = "".join(f"#include {header}\n" for header in COMMON_HEADERS)
    return made_by(["clang++-19", *FLAGS, KERNELS, "-x", "c++-header"], text, folder / "common.pch")


def compiled(name: str, sources: list[str], flags: list[str], folder: Path, common: Path) -> Path:
    """Headers that are precompiled go with one set of flags."""
    text = "".join(f'#include "{source}"\n' for source in sources)
    precompiled = ["-include-pch", str(common)] if flags == [KERNELS] else []
    output = folder / f"{name}.ll"
    if precompiled and output.exists() and output.stat().st_mtime < common.stat().st_mtime:
        output.unlink()
    return made_by(["clang++-19", *FLAGS, *flags, *precompiled, "-S", "-emit-llvm", "-x", "c++"], text, output)


# ---------------------------------------------------------------------------------------------------- reading

NAME = r'(?:"[^"]+"|[\w.$-]+)'
DEFINE = re.compile(rf"^define\b.*?@({NAME})\(")
CALL = re.compile(rf"\b(?:call|invoke)\b.*?\s([@%]{NAME})\(")
ASSEMBLY = re.compile(r'\b(?:call|invoke)\b[^@%]*\basm\b[^"]*"((?:[^"\\]|\\.)*)"')
ASSIGN = re.compile(rf"^\s+(%{NAME}) = (.*)")
SYSTEM_CALL = re.compile(r"\b(?:syscall|sysenter|int|svc|call)\b")
TYPE_TEST = re.compile(rf'@llvm\.(?:public\.)?type\.test\(ptr (%{NAME}), metadata !("[^"]+"|\d+)\)')
LOAD = re.compile(rf"load ptr, ptr (%{NAME})[,\s]?")
OFFSET = re.compile(rf"getelementptr (?:inbounds |nuw |nusw )*(i8|ptr), ptr (%{NAME}), i64 (-?\d+)")
ALIAS = re.compile(rf"^@({NAME}) = .*\balias\b.*ptr @({NAME})")
IFUNC = re.compile(rf"^@({NAME}) = .*\bifunc\b")
VTABLE = re.compile(rf"^@({NAME}) = .*\bconstant \{{ \[.*\{{ (\[.*\]) \}}(.*)$")
TYPE = re.compile(r'^!(\d+) = !\{i64 (\d+), !("[^"]+"|\d+)\}', re.MULTILINE)


@dataclass
class Function:
    name: str
    calls: set[str] = field(default_factory=set)             # of functions by name
    virtual: set[tuple[str, int]] = field(default_factory=set)  # (class, byte offset in its vtable)
    pointers: int = 0                                        # calls through other pointers
    assembly: set[str] = field(default_factory=set)


@dataclass
class Program:
    functions: dict[str, Function] = field(default_factory=dict)
    aliases: dict[str, str] = field(default_factory=dict)
    # class -> [(vtable, byte offset of the address point, elements)]
    vtables: dict[str, list[tuple[str, int, list[str]]]] = field(default_factory=dict)


def bare(name: str) -> str:
    return name.strip('@%"')


def class_of(metadata: str, unit: str) -> str:
    """The name of a class; those of unnamed namespaces have a number within their unit."""
    return bare(metadata) if metadata.startswith('"') else f"class {metadata} of {unit}"


def unified(name: str, unit: str, local: bool) -> str:
    return f"{name}#{unit}" if local else name


def elements_of(arrays: str) -> list[str]:
    """The pointers of a vtable's initialiser, in order; "" for what is no function."""
    found, depth, word = [], 0, ""
    inner = re.sub(r"\[\d+ x ptr\] ", "", arrays)
    for char in inner + ",":
        if char in "([{":
            depth += char == "("
            word += char if char == "(" else ""
        elif char in ")]}":
            depth -= char == ")"
            word += char if char == ")" else ""
        elif char == "," and depth == 0:
            match = re.search(rf"^\s*ptr (?:dso_local_equivalent |no_cfi )?@({NAME})\s*$", word)
            found.append(bare(match[1]) if match else "")
            word = ""
        else:
            word += char
    return found


def read_body(lines: list[str], function: Function, unit: str) -> None:
    registers: dict[str, str] = {}
    classes: dict[str, str] = {}
    for line in lines:
        if match := ASSIGN.match(line):
            registers[match[1]] = match[2]
        if match := TYPE_TEST.search(line):
            classes.setdefault(match[1], class_of(match[2], unit))
    for line in lines:
        if " call " not in line and " invoke " not in line and not line.lstrip().startswith(("call", "invoke")):
            continue
        if match := ASSEMBLY.search(line):
            function.assembly.add(match[1])
            continue
        match = CALL.search(line)
        if not match:
            raise ValueError(f"a call that is not understood in {function.name}: {line}")
        callee = match[1]
        if callee.startswith("@"):
            function.calls.add(bare(callee))
            continue
        site = virtual_site(callee, registers, classes)
        if site:
            function.virtual.add(site)
        else:
            function.pointers += 1


def virtual_site(callee: str, registers: dict[str, str], classes: dict[str, str]) -> tuple[str, int] | None:
    load = LOAD.search(registers.get(callee, ""))
    if not load:
        return None
    place, offset = load[1], 0
    step = OFFSET.search(registers.get(place, ""))
    if step:
        place, offset = step[2], int(step[3]) * (8 if step[1] == "ptr" else 1)
    return (classes[place], offset) if place in classes else None


def read_unit(path: Path, program: Program) -> None:
    unit = path.stem
    local: set[str] = set()
    text = path.read_text()
    for match in re.finditer(rf"^define (?:internal|private)\b.*?@({NAME})\(", text, re.MULTILINE):
        local.add(bare(match[1]))
    types = {match[1]: (int(match[2]), class_of(match[3], unit)) for match in TYPE.finditer(text)}
    lines = text.splitlines()
    at = 0
    while at < len(lines):
        line = lines[at]
        at += 1
        if match := DEFINE.match(line):
            name = bare(match[1])
            begin = at
            while lines[at] != "}":
                at += 1
            function = Function(unified(name, unit, name in local))
            read_body(lines[begin:at], function, unit)
            function.calls = {unified(callee, unit, callee in local) for callee in function.calls}
            known = program.functions.setdefault(function.name, function)
            if known is not function:  # an inline function, optimised differently in another unit
                known.calls |= function.calls
                known.virtual |= function.virtual
                known.pointers = max(known.pointers, function.pointers)
                known.assembly |= function.assembly
        elif line.startswith("@"):
            if match := ALIAS.match(line):
                program.aliases[unified(bare(match[1]), unit, False)] = bare(match[2])
            elif IFUNC.match(line):
                raise ValueError(f"an indirect function is not understood: {line}")
            elif line.startswith(("@_ZTV", '@"_ZTV')) and (match := VTABLE.match(line)):
                elements = [unified(name, unit, name in local) for name in elements_of(match[2])]
                for number in re.findall(r"!type !(\d+)", match[3]):
                    offset, cls = types[number]
                    row = (bare(match[1]), offset, elements)
                    if row not in program.vtables.setdefault(cls, []):
                        program.vtables[cls].append(row)


def demangled(names: list[str]) -> dict[str, str]:
    plain = [name.split("#")[0] for name in names]
    result = subprocess.run(["c++filt"], input="\n".join(plain) + "\n", capture_output=True, text=True, check=True)
    return dict(zip(names, result.stdout.splitlines()))


# ---------------------------------------------------------------------------------------------------- tables

def rows(name: str) -> list[tuple[str, str]]:
    """(what, why) of each line "what: why"; lines that begin with # are comments."""
    found = []
    for line in (TABLES / name).read_text().splitlines():
        if not line.strip() or line.startswith("#"):
            continue
        what, separator, why = line.partition(" -- ")
        if not separator or not why.strip():
            raise ValueError(f"{name}: no reason in: {line}")
        found.append((what.strip(), why.strip()))
    return found


DERIVED = re.compile(r"\b(?:class|struct)\s+(\w+)(?:\s+final)?\s*:\s*([^{;]+)\{")


def declared_heirs(folders=("app", "config", "drivers", "ipc", "rt_core", "scripts", "sim_devices"), plants=()) -> dict[str, set[str]]:
    """Last part of a class's name -> those of all classes that the sources derive from it, at any depth."""
    heirs: dict[str, set[str]] = {}
    paths = [path for folder in folders for path in (ROOT / folder).rglob("*.[hc]pp")] + [Path(plant) for plant in plants]
    for path in paths:
        for match in DERIVED.finditer(re.sub(r"//[^\n]*", "", path.read_text(errors="replace"))):
            for base in match[2].split(","):
                words = re.findall(r"[\w:]+", base.split("<")[0])
                if words:
                    heirs.setdefault(words[-1].split("::")[-1], set()).add(match[1])
    changed = True
    while changed:
        changed = False
        for base, found in heirs.items():
            more = set().union(*(heirs.get(heir, set()) for heir in found)) - found
            found |= more
            changed |= bool(more)
    return heirs


# ---------------------------------------------------------------------------------------------------- walking

class Walk:
    def __init__(self, program: Program, plants: list[str]):
        self.program = program
        self.plain = demangled(sorted(program.functions) + sorted({callee for function in program.functions.values()
                                                                   for callee in function.calls}))
        self.allowed = rows("allowed.txt")
        self.pointers = rows("pointers.txt")
        self.implementers = rows("implementers.txt")
        self.heirs = declared_heirs(plants=plants)
        self.used: set[tuple[str, str]] = set()
        self.parent: dict[str, str | None] = {}
        self.errors: list[str] = []
        self.classes: set[str] = set()

    def chain(self, name: str) -> str:
        steps = [name]
        while (above := self.parent.get(steps[-1])) is not None:
            steps.append(above)
        return "\n    ".join(self.plain.get(step, step) for step in reversed(steps))

    def refuse(self, what: str, caller: str) -> None:
        self.errors.append(f"{what}, reached by\n    {self.chain(caller)}")

    def allowed_row(self, name: str, caller: str, compiler: str) -> tuple[str, str] | None:
        """A row is "name" or "name in caller"; with "g++: " before it, it is for the release build's machine code alone."""
        def fits(row: tuple[str, str]) -> bool:
            if row[0].startswith("g++: ") and compiler != "g++":
                return False
            what, _, where = row[0].removeprefix("g++: ").partition(" in ")
            return bool(re.fullmatch(what, name) and re.fullmatch(where or ".*", caller))
        return next((row for row in self.allowed if fits(row)), None)

    def run(self) -> None:
        queue: deque[str] = deque()

        def reach(name: str, caller: str | None) -> None:
            if name not in self.parent:
                self.parent[name] = caller
                queue.append(name)

        for name in self.program.functions:
            if self.plain[name].startswith(ROOTS):
                reach(name, None)
        while queue:
            function = self.program.functions[queue.popleft()]
            for callee in sorted(function.calls):
                callee = self.program.aliases.get(callee, callee)
                if callee.startswith("llvm."):
                    continue
                row = self.allowed_row(self.plain.get(callee, callee), self.plain[function.name], "clang")
                if row:
                    self.used.add(row)
                elif callee in self.program.functions:
                    reach(callee, function.name)
                else:
                    ours = "cellmirror::" in self.plain.get(callee, callee)
                    self.refuse(f"{self.plain.get(callee, callee)} " +
                                ("is not analysed: add its source to tick_calls.py" if ours else
                                 "is not in tests/lint/tick/allowed.txt"), function.name)
            for cls, offset in sorted(function.virtual):
                self.classes.add(cls)
                targets = [(table, elements[(point + offset) // 8])
                           for table, point, elements in self.program.vtables.get(cls, [])]
                if not targets:
                    self.refuse(f"a virtual call of {cls} has no implementer in the analysed sources", function.name)
                for _, target in targets:
                    if target in self.program.functions:
                        reach(target, function.name)
                    elif target not in ("", "__cxa_pure_virtual"):
                        self.refuse(f"{target} (virtual) is not analysed", function.name)
            for text in sorted(function.assembly):
                if SYSTEM_CALL.search(text):
                    self.refuse(f'assembly "{text}"', function.name)
            if function.pointers:
                self.follow_pointers(function, reach)
        self.check_implementers()

    def check_objects(self, build: Path) -> int:
        """The release build's machine code; how many of its functions are reachable."""
        graph = tick_objects.graph_of(build)
        found = tick_objects.walk(graph, {name.split("#")[0] for name in self.parent})
        self.plain |= demangled(sorted(found))
        for name, caller in sorted(found.items()):
            row = self.allowed_row(self.plain[name].removesuffix("@plt"), self.plain.get(caller, ""), "g++")
            if row:
                self.used.add(row)
            elif name not in graph:
                steps = [name]
                while (above := found.get(steps[-1])) is not None:
                    steps.append(above)
                chain = "\n    ".join(self.plain[step] for step in reversed(steps[1:]))
                self.errors.append(f"the release build calls {self.plain[name]}, which is not in allowed.txt, from\n    {chain}")
        return sum(name in graph for name in found)

    def follow_pointers(self, function: Function, reach) -> None:
        row = next((row for row in self.pointers
                    if re.fullmatch(row[0].partition(" => ")[0].strip(), self.plain[function.name])), None)
        if not row:
            return self.refuse(f"{function.pointers} call(s) through a pointer that is not in tests/lint/tick/pointers.txt",
                               function.name)
        self.used.add(row)
        for pattern in row[0].partition(" => ")[2].split(" | "):
            targets = [name for name in self.program.functions if re.fullmatch(pattern.strip(), self.plain[name])]
            if not targets:
                self.errors.append(f"pointers.txt: no function is {pattern}")
            for target in targets:
                reach(target, function.name)

    def check_implementers(self) -> None:
        """The listed, the compiled and the declared implementers of each class that is called are the same."""
        listed: dict[str, dict[str, str]] = {}
        for what, why in self.implementers:
            base, _, heir = what.partition(" <- ")
            listed.setdefault(base.strip(), {})[heir.strip()] = why
        names = demangled(sorted({cls for cls in self.program.vtables} | {table for found in self.program.vtables.values()
                                                                          for table, _, _ in found}))
        seen = set()
        for cls in sorted(self.classes):
            base = names.get(cls, cls).removeprefix("typeinfo name for ")
            seen.add(base)
            rows_of_base = listed.get(base, {})
            compiled_ones = {names[table].removeprefix("vtable for ") for table, _, _ in self.program.vtables.get(cls, [])} - {base}
            declared = self.heirs.get(base.split("::")[-1], set())
            for heir in sorted(compiled_ones - set(rows_of_base)):
                self.errors.append(f"{heir} implements {base}, which the tick calls: list it in tests/lint/tick/implementers.txt")
            for heir in sorted(declared - {row.split("::")[-1] for row in rows_of_base}):
                self.errors.append(f"a source declares {heir}, which derives from {base}: list it in "
                                   "tests/lint/tick/implementers.txt")
            for heir, why in sorted(rows_of_base.items()):
                if heir not in compiled_ones and not why.startswith("not in a tick: "):
                    self.errors.append(f"implementers.txt: {heir} is no analysed implementer of {base}")
        for base in sorted(set(listed) - seen):
            self.errors.append(f"implementers.txt: the tick does not call {base}")

    def check_ends(self) -> None:
        reached = [self.plain[name] for name in self.parent]
        for wanted in ROOTS + MUST_REACH:
            if not any(name.startswith(wanted) for name in reached):
                self.errors.append(f"{wanted}...) was not reached: the walk is broken")
        for table, name in ((self.allowed, "allowed.txt"), (self.pointers, "pointers.txt")):
            self.errors += [f"{name}: the tick does not reach {row[0]}: take the line out" for row in table
                            if row not in self.used]


def main() -> int:
    if not shutil.which("clang++-19"):
        print("skipped: no clang++-19")
        return 77
    build = Path(sys.argv[2])
    folder = build / "tick_calls"
    folder.mkdir(parents=True, exist_ok=True)
    plants = [str(Path(sys.argv[sys.argv.index("--plant") + 1]).resolve())] if "--plant" in sys.argv else []
    program = Program()
    common = common_headers(folder)
    with ThreadPoolExecutor(max_workers=2) as pool:
        jobs = [pool.submit(compiled, name, sources, flags, folder, common) for name, (sources, flags) in units(plants).items()]
        for job in jobs:
            read_unit(job.result(), program)
    walk = Walk(program, plants)
    walk.run()
    in_objects = 0 if plants else walk.check_objects(build)
    if not plants:
        walk.check_ends()
    if "--list" in sys.argv:
        print("\n".join(sorted(walk.plain[name] for name in walk.parent)))
    print("\n".join(walk.errors) or f"{len(walk.parent)} functions are reachable from the tick, {in_objects} in the release "
          "build: none does what it must not")
    return 1 if walk.errors else 0


if __name__ == "__main__":
    sys.exit(main())

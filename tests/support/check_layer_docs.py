"""Keeps the documents equal to the table of layers (cmake/Layers.cmake): the table of folders in docs/architecture.md, and the
'May include:' sentence in the README of each folder. Arguments: the source root; --write puts right what differs."""

import re
import sys
from pathlib import Path

ROOT = Path(sys.argv[1]).resolve()
WRITE = "--write" in sys.argv
ARCHITECTURE = ROOT / "docs/architecture.md"
BEGIN, END = "<!-- generated from cmake/Layers.cmake: begin -->", "<!-- generated from cmake/Layers.cmake: end -->"
# From "May include:" to the end of the sentence; a full stop within `code` does not end it.
SENTENCE = re.compile(r"\*{0,2}May include\*{0,2}:(?:`[^`]*`|[^`.;])*[.;]")
WHOLE_PROGRAM = "*"


def layers() -> dict[str, list[str]]:
    text = (ROOT / "cmake/Layers.cmake").read_text()
    table = text[text.index("set(CELLMIRROR_LAYERS"):]
    return {folder: allowed.split() for folder, allowed in re.findall(r'"([^":]+):([^"]*)"', table[:table.index('")') + 2])}


def names(folders: list[str]) -> str:
    if WHOLE_PROGRAM in folders:
        return "every folder"
    return ", ".join(f"`{folder}`" for folder in folders) or "nothing of this project"


LONGEST_PURPOSE = 14  # words; of a longer sentence the table has what stands before the first colon


def purpose(folder: str) -> str:
    """What the README's title says behind its colon, else its first sentence; without links."""
    readme = ROOT / folder / "README.md"
    if not readme.exists():
        return ""
    title, body = readme.read_text().split("\n", 1)
    if ": " in title:
        return title.split(": ", 1)[1]
    paragraph = " ".join(body.strip().split("\n\n")[0].split())
    paragraph = re.sub(r"^- (\*\*Purpose\*\*: )?", "", re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", paragraph))
    sentence = re.split(r"(?<=[.]) ", paragraph)[0]
    if len(sentence.split()) > LONGEST_PURPOSE:
        sentence = sentence.split(": ", 1)[0]
    return sentence.rstrip(".:").replace("|", "/")


def with_capital(text: str) -> str:
    return text if "_" in text.split(" ")[0] else text[:1].upper() + text[1:]


def table(rows: dict[str, list[str]]) -> str:
    lines = ["| folder | what it is for |", "| --- | --- |"]
    lines += [f"| `{folder}` | {with_capital(purpose(folder))} |" for folder in rows if folder != "tests"]
    return "\n".join(lines)


def check_architecture(rows: dict[str, list[str]]) -> list[str]:
    text = ARCHITECTURE.read_text()
    if BEGIN not in text or END not in text:
        return [f"{ARCHITECTURE.relative_to(ROOT)}: the generated table is missing: put '{BEGIN}' and '{END}' where it belongs"]
    before, rest = text.split(BEGIN, 1)
    after = rest.split(END, 1)[1]
    wanted = f"{before}{BEGIN}\n{table(rows)}\n{END}{after}"
    if wanted == text:
        return []
    if WRITE:
        ARCHITECTURE.write_text(wanted)
        return []
    return ["docs/architecture.md: the table of folders differs from cmake/Layers.cmake"]


def check_readme(folder: str, allowed: list[str]) -> list[str]:
    readme = ROOT / folder / "README.md"
    if not readme.exists():
        return [f"{folder}/README.md: there is none: purpose, what it may include, real-time class, where to start reading"]
    text = readme.read_text()
    found = SENTENCE.search(text)
    if not found:
        return [f"{folder}/README.md: it has no sentence 'May include: ...'"]
    wanted = f"May include: {names(allowed)}{found[0][-1]}"
    if found[0] == wanted:
        return []
    if WRITE:
        readme.write_text(text[:found.start()] + wanted + text[found.end():])
        return []
    return [f"{folder}/README.md: 'May include:' differs from cmake/Layers.cmake, which says: {names(allowed)}"]


def main() -> int:
    rows = layers()
    errors = [error for folder, allowed in rows.items() if folder != "tests" for error in check_readme(folder, allowed)]
    errors += check_architecture(rows)
    print("\n".join(errors) or f"the documents agree with the {len(rows)} rows of cmake/Layers.cmake")
    if errors:
        print(f"\nput right what can be with: python3 {Path(__file__).relative_to(ROOT)} . --write")
    return 1 if errors else 0


sys.exit(main())

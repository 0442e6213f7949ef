"""Keeps retired words out of the sources: docs/glossary.md lists them beside the terms that replace them.

Arguments: the source root. Exit status: 1 if a covered file contains a retired word.

Identifiers match whole words with case; `*` at an end of one matches any characters of a name. Prose matches whole words
without regard to case, also across line breaks: in sources only within comments and string literals, elsewhere anywhere.
"""

import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(sys.argv[1]).resolve()
GLOSSARY = Path("docs/glossary.md")

# What is covered, in the form of git's path specifications; `:!` excludes.
DOCUMENTATION = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "run", "check", "docs", "config/**README.md",
                 "drivers/**README.md", "ipc/**README.md", "rt_core/**README.md", "scripts/**README.md",
                 "sim_devices/**README.md", ":!docs/decisions", ":!docs/script-reference.md")
FOLDERS = ("app", "config", "docs/examples", "drivers", "ipc", "rt_core", "scripts", "sim_devices")
EXCLUDED = (":!*.png", ":!*.jpg", ":!*.stl", ":!*.ttf", f":!{GLOSSARY}")

C_SOURCES = {".cpp", ".hpp", ".h", ".c", ".js", ".css", ".inc"}
# Comments and string literals of C and C++; character literals only so that a quote within one does not open a string.
C_TEXT = re.compile(r"""//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])'""", re.DOTALL)


@dataclass
class Retired:
    pattern: re.Pattern
    word: str
    term: str
    prose: bool

    def rare_part(self) -> str:
        """Is in every text that the pattern matches: to look for it is faster by far. Of prose, in small letters."""
        return max(self.word.casefold().split(), key=len) if self.prose else self.word.strip("*")


def cells(row: str) -> list[str]:
    return [cell.strip() for cell in row.strip().strip("|").split("|")]


def identifier_pattern(word: str) -> re.Pattern:
    return re.compile(r"(?<!\w)" + re.escape(word).replace(r"\*", r"\w*") + r"(?!\w)")


def prose_pattern(phrase: str) -> re.Pattern:
    # Between the words of a phrase a comment may go on in the next line.
    return re.compile(r"(?<![\w-])" + r"(?:\s|//|#|\*)+".join(map(re.escape, phrase.split())) + r"(?![\w-])", re.IGNORECASE)


def retired_words(glossary: str) -> list[Retired]:
    """The rows of the glossary's table of retired words: use instead | retired identifiers | retired prose."""
    words = []
    for row in glossary.splitlines():
        if not row.startswith("|") or len(cells(row)) != 3 or cells(row)[0] in ("use instead", "---"):
            continue
        term, identifiers, prose = cells(row)
        words += [Retired(identifier_pattern(word), word, term, False) for word in re.findall(r"`([^`]+)`", identifiers)]
        words += [Retired(prose_pattern(word.strip()), word.strip(), term, True) for word in prose.split(",") if word.strip()]
    return words


def texts_of(path: Path, text: str) -> str:
    """Comments and string literals of `text`; the rest, included names and quoted code are blanks, so that positions stay."""
    if path.suffix not in C_SOURCES:
        return text
    text = re.sub(r"^#include [^\n]*|`[^`\n]+`", lambda match: " " * len(match[0]), text, flags=re.MULTILINE)
    kept, end = [], 0
    for match in C_TEXT.finditer(text):
        kept.append(re.sub(r"[^\n]", " ", text[end:match.start()]))
        kept.append(match[0])
        end = match.end()
    kept.append(re.sub(r"[^\n]", " ", text[end:]))
    return "".join(kept)


def covered_files() -> list[Path]:
    listing = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", "--",
                              *DOCUMENTATION, *FOLDERS, *EXCLUDED], cwd=ROOT, capture_output=True, text=True, check=True)
    return [path for path in map(Path, sorted(set(listing.stdout.split("\0")) - {""})) if (ROOT / path).is_file()]


def main() -> int:
    words = retired_words((ROOT / GLOSSARY).read_text())
    files = covered_files()
    if not words or not files:
        print(f"{GLOSSARY}: no retired words, or no files covered")
        return 1
    errors = []
    for path in files:
        text = (ROOT / path).read_text(errors="replace")
        texts = texts_of(path, text)
        small = texts.casefold()
        for retired in words:
            if retired.rare_part() not in (small if retired.prose else text):
                continue
            for match in retired.pattern.finditer(texts if retired.prose else text):
                line = text.count("\n", 0, match.start()) + 1
                errors.append(f"{path}:{line}: '{retired.word}' is retired; see '{retired.term}' in {GLOSSARY}")
    print("\n".join(errors) or f"{len(words)} retired words, {len(files)} files: none found")
    return 1 if errors else 0


sys.exit(main())

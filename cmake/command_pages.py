"""Manual pages and bash completion of our programs, from what they say about their command lines (--describe-command-line).

command_pages.py --version V --date YYYY-MM-DD --man FOLDER --completion FOLDER PROGRAM...
"""

import argparse
import json
import re
import subprocess
from pathlib import Path

EXIT_STATUS = (("0", "done"), ("1", "refused or failed, with a message on standard error"), ("2", "wrong usage"))
SECTIONS_OF = {
    "cellmirror": [
        ("FILES", [("/etc/cellmirror/cells/NAME/", "the cell of the service cellmirror@NAME"),
                   ("/var/lib/cellmirror/NAME/", "what that service writes: records, saved views, recorded programs"),
                   ("/usr/share/cellmirror/cells/", "cells to copy")]),
        ("ENVIRONMENT", [("CELLMIRROR_RUNTIME_DIR", "the folder in which running gateways are found"),
                         ("kis_home", "the cell folder, instead of that of the cell file")]),
    ],
}


def described(program: Path) -> dict:
    done = subprocess.run([str(program), "--describe-command-line"], capture_output=True, text=True, check=True, timeout=30)
    return json.loads(done.stdout)


def subcommands_of(command: dict, path: str = "") -> list[tuple[str, dict]]:
    """All of them with their names, as "volume" and "volume info"."""
    found = []
    for sub in command["subcommands"]:
        name = f"{path} {sub['name']}".strip()
        found += [(name, sub), *subcommands_of(sub, name)]
    return found


# --- manual pages ------------------------------------------------------------------------------------------------------

def roff(text: str) -> str:
    """Text as roff: nothing in it is a request, and options keep their hyphens."""
    text = text.replace("\\", r"\(rs").replace("-", r"\-").replace("'", r"\(aq").replace("^", r"\(ha").replace("~", r"\(ti")
    return re.sub(r"^\.", r"\&.", text, flags=re.MULTILINE)


def paragraphs(text: str) -> str:
    """Lines that are indented, and those of examples, stay as they are; others are filled."""
    out = []
    for block in re.split(r"\n\s*\n", text.strip("\n")):
        lines = block.splitlines()
        as_it_is = len(lines) > 1 or lines[0].startswith(("  ", "Example:"))
        out.append(".PP\n" + (".nf\n" + roff(block) + "\n.fi" if as_it_is else roff(block)))
    return "\n".join(out) + "\n"


def words_of(kind: str) -> str:
    """The values of an option in a few words: the kind, and what a check of it says."""
    return kind.replace(":", " ", 1).strip()


def option_entry(option: dict) -> str:
    names = ", ".join(f"\\fB{roff(name)}\\fP" for name in option["names"]) or f"\\fI{roff(option['positional'])}\\fP"
    notes = [text for text in (f"{words_of(option['type'])}" if option["type"] else "",
                               "several" if option["values"] == "many" else "",
                               "required" if option["required"] else "",
                               f"default {option['default']}" if option["default"] else "") if text]
    note = f" ({roff('; '.join(notes))})" if notes else ""
    return f".TP\n{names}{note}\n{roff(option['help'] or 'see above')}\n"


def usage(name: str, command: dict) -> str:
    options = any(option["names"] for option in command["options"])
    places = [option for option in command["options"] if not option["names"]]
    shown = [f"\\fB{roff(name)}\\fP", *(["[\\fIOPTIONS\\fP]"] if options else [])]
    for option in places:
        word = f"\\fI{roff(option['positional'])}\\fP" + ("..." if option["values"] == "many" else "")
        shown.append(word if option["required"] else f"[{word}]")
    if command["subcommands"]:
        shown.append("\\fISUBCOMMAND\\fP")
    return " ".join(shown)


def one_line(program: dict) -> str:
    first = program["description"].splitlines()[0].removeprefix(program["name"]).strip().rstrip(".")
    return first[:1].lower() + first[1:]


def manual_page(program: dict, version: str, date: str) -> str:
    name = program["name"]
    rest = program["description"].split("\n", 1)[1:]
    out = [f".TH {name.upper()} 1 {date} \"cellmirror {version}\" \"User Commands\"\n",
           f".SH NAME\n{roff(name)} \\- {roff(one_line(program))}\n", ".SH SYNOPSIS\n" + usage(name, program) + "\n"]
    for path, sub in subcommands_of(program):
        out.append(".br\n" + usage(f"{name} {path}", sub) + "\n")
    if rest and rest[0].strip():
        out.append(".SH DESCRIPTION\n" + paragraphs(rest[0]))
    out.append(".SH OPTIONS\n" + "".join(map(option_entry, program["options"])))
    if program["subcommands"]:
        out.append(".SH COMMANDS\n")
    for path, sub in subcommands_of(program):
        out.append(f".SS {usage(f'{name} {path}', sub)}\n{roff(sub['description'])}\n")
        # --help is told once, above.
        out += [option_entry(option) for option in sub["options"] if "--help" not in option["names"]]
        if sub["footer"] and sub["footer"] != program["footer"]:
            out.append(paragraphs(sub["footer"]))
    if program["footer"]:
        out.append(".SH NOTES\n" + paragraphs(program["footer"]))
    out.append(".SH EXIT STATUS\n" + "".join(f".TP\n\\fB{status}\\fP\n{roff(text)}\n" for status, text in EXIT_STATUS))
    for title, entries in SECTIONS_OF.get(name, ()):
        out.append(f".SH {title}\n" + "".join(f".TP\n\\fI{roff(key)}\\fP\n{roff(text)}\n" for key, text in entries))
    return "".join(out)


# --- bash completion -----------------------------------------------------------------------------------------------------

def choices_of(option: dict) -> list[str]:
    """The words of "TEXT:{a,b}"."""
    found = re.search(r"\{([^{}]*)\}", option["type"])
    return found[1].split(",") if found else []


def quoted(text: str) -> str:
    return "'" + text.replace("'", "'\\''") + "'"


def case_of_values(label: str, option: dict) -> str:
    """What stands behind an option: its words; nothing where it takes a number; else a file."""
    names = "|".join(quoted(f"{label}:{name}") for name in option["names"])
    words = choices_of(option)
    if words:
        return f"    {names}) COMPREPLY=($(compgen -W {quoted(' '.join(words))} -- \"$word\")); return ;;\n"
    if re.match(r"(INT|UINT|FLOAT)", option["type"]):
        return f"    {names}) compopt +o default 2>/dev/null; return ;;\n"
    return f"    {names}) return ;;\n"


def completion(program: dict) -> str:
    name = program["name"]
    function = "_" + re.sub(r"\W", "_", name)
    commands = [("", program), *subcommands_of(program)]
    values = "".join(case_of_values(label, option) for label, command in commands for option in command["options"]
                     if option["names"] and option["values"] != "none")
    words = "".join(f"    {quoted(label)}) options={quoted(' '.join(n for option in command['options'] for n in option['names']))} ;;\n"
                    for label, command in commands)
    below = "".join(f"      {quoted(label)}) commands={quoted(' '.join(sub['name'] for sub in command['subcommands']))} ;;\n"
                    for label, command in commands if command["subcommands"])
    return f"""# bash completion of {name}; made by cmake/command_pages.py. A file where nothing else fits.
{function}() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} command='' commands options='' i
  COMPREPLY=()
  for ((i = 1; i <= COMP_CWORD; i++)); do
    case "$command" in
{below}      *) commands='' ;;
    esac
    [ "$i" -lt "$COMP_CWORD" ] || break
    case " $commands " in *" ${{COMP_WORDS[i]}} "*) command="${{command:+$command }}${{COMP_WORDS[i]}}" ;; esac
  done
  case "$command:$before" in
{values}  esac
  case "$command" in
{words}  esac
  case "$word" in
    -*) COMPREPLY=($(compgen -W "$options" -- "$word")) ;;
    *) [ -z "$commands" ] || COMPREPLY=($(compgen -W "$commands" -- "$word")) ;;
  esac
}}
complete -o default -F {function} {name}
"""


def main() -> None:
    parser = argparse.ArgumentParser(description="Manual pages and bash completion of programs of cellmirror.")
    parser.add_argument("--version", required=True)
    parser.add_argument("--date", required=True)
    parser.add_argument("--man", type=Path, required=True, help="folder for NAME.1")
    parser.add_argument("--completion", type=Path, required=True, help="folder for NAME")
    parser.add_argument("programs", type=Path, nargs="+")
    options = parser.parse_args()
    options.man.mkdir(parents=True, exist_ok=True)
    options.completion.mkdir(parents=True, exist_ok=True)
    for program in map(described, options.programs):
        (options.man / f"{program['name']}.1").write_text(manual_page(program, options.version, options.date))
        (options.completion / program["name"]).write_text(completion(program))


if __name__ == "__main__":
    main()

"""What mkdocs (mkdocs.yml) does not do by itself with pages that have to be right on disk, in a forge, and in the site.

- Files outside docs/ that a page links to become pages of the site: Markdown as it is, other text as code.
- Anchors are made as forges make them, so that one link is right in all three places.
- The search gets its index by a script, since no page of file:// may fetch anything.
- What a folder of files has no use for is left out: the sitemap, the page 404, tokenisers of other languages.
"""

import json
import os
import posixpath
import re
import shutil
from pathlib import Path

from mkdocs.structure.files import File

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
# Pages with a place in the navigation; others that are linked to are in tree/.
NAMED = {"README.md": "tour.md", "CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changelog.md", "SECURITY.md": "security.md"}
CODE = {".cmake": "cmake", ".toml": "toml", ".py": "python", ".sh": "bash", ".tsv": "text", ".txt": "text", "": "text"}
LINK = re.compile(r"(!?\[(?:[^\[\]]|\[[^\]]*\])*\])\(([^)\s]+)\)")
FENCE = re.compile(r"^( *)(```+|~~~+)")
# Shown where the mouse rests on the words.
EXPLAINED = {"the manual": "the KISMET SCRIPT manual of March 1999, which defines the commands"}


def slug(heading, separator):
    """As GitHub and GitLab make anchors: small letters, no punctuation, a hyphen for each blank."""
    return re.sub(r"[^\w\- ]", "", re.sub(r"<[^>]*>", "", heading).strip().lower()).replace(" ", separator)


def outside_fences(text, change):
    """`change` of each stretch of lines that is not in a code block."""
    parts, lines, fence = [], [], None
    for line in text.split("\n"):
        mark = FENCE.match(line)
        if fence is None and mark:
            parts.append(change("\n".join(lines)) if lines else None)
            lines, fence = [line], mark[2]
        elif fence is not None and line.strip() == fence:
            parts.append("\n".join([*lines, line]))
            lines, fence = [], None
        else:
            lines.append(line)
    if lines:
        parts.append("\n".join(lines) if fence else change("\n".join(lines)))
    return "\n".join(part for part in parts if part is not None)


def text_file(path):
    return path.is_file() and path.suffix in (".md", *CODE)


def place_of(path):
    """Where the site has a file of the tree, as a path in docs/; None where it does not."""
    name = path.relative_to(ROOT).as_posix()
    if path.is_relative_to(DOCS):
        return path.relative_to(DOCS).as_posix()
    if name in NAMED:
        return NAMED[name]
    return f"tree/{name}" + ("" if path.suffix == ".md" else ".md") if text_file(path) else None


def goal_of(source, target):
    """The file that a relative link leads to; None for one to elsewhere or out of the tree."""
    if re.match(r"[a-z]+:|#|/", target):
        return None
    goal = (source.parent / target.split("#")[0]).resolve()
    if goal.is_dir():
        goal /= "README.md"
    return goal if goal.is_relative_to(ROOT) else None


def linked_from(source):
    goals = []
    outside_fences(source.read_text(), lambda text: goals.extend(goal_of(source, link[2]) for link in LINK.finditer(text)) or "")
    return [goal for goal in goals if goal]


def on_config(config):
    config["mdx_configs"].setdefault("toc", {})["slugify"] = slug
    return config


def on_files(files, config):
    named = [ROOT / name for name in NAMED]
    pages = [*DOCS.rglob("*.md"), *named]
    more = {goal for page in pages for goal in linked_from(page) if not goal.is_relative_to(DOCS) and text_file(goal)}
    for path in sorted({*named, *more}):
        file = File(place_of(path), config["docs_dir"], config["site_dir"], config["use_directory_urls"])
        file.abs_src_path = str(path)
        files.append(file)
    return files


def on_page_read_source(page, config):
    path = Path(page.file.abs_src_path)
    if path.suffix == ".md":
        return None
    name = path.relative_to(ROOT).as_posix()
    return f"# {name}\n\n````{CODE[path.suffix]}\n{path.read_text()}\n````\n"


def title_of(path):
    """The heading of a page, without marks."""
    first = path.read_text().split("\n", 1)[0]
    return first.lstrip("# ").replace("`", "") if path.suffix == ".md" and first.startswith("# ") else path.name


def with_links_of_the_site(text, source, place, has):
    """A link to a file that the site does not have is the words alone; one whose words are the name of a page has its title."""

    def link(match):
        goal = goal_of(source, match[2])
        if not goal or not goal.exists():  # a wrong one stays: mkdocs refuses it
            return match[0]
        goal_place = place_of(goal)
        if goal_place is None or not has(goal_place):
            return match[1][1:-1] if match[1].startswith("[") else ""
        anchor = match[2][match[2].index("#"):] if "#" in match[2] else ""
        words = match[1]
        if re.fullmatch(r"\[[\w/.-]+\.md\]", words):
            words = f"[{title_of(goal)}]"
        return f"{words}({posixpath.relpath(goal_place, posixpath.dirname(place) or '.')}{anchor})"

    return LINK.sub(link, text)


def with_blank_lines_before_lists(text):
    """Forges begin a list right below a heading or a paragraph; Python-Markdown wants a blank line there. Nor does a forge begin
    one with a number that is part of a sentence, such as '0600.' at the start of a line."""
    lines = []
    for line in text.split("\n"):
        item = re.match(r"([-*]|1\.) ", line)
        if item and lines and lines[-1].strip() and not re.match(r"( |[-*] |\d+\. )", lines[-1]):
            lines.append("")
        lines.append(re.sub(r"^(\d{2,})\. ", r"\1\\. ", line) if not item else line)
    return "\n".join(lines)


def with_deep_lists(text):
    """Forges nest what is indented by the width of the marker, 2 or 3; Python-Markdown what is indented by 4."""
    lines, width = [], 0
    for line in text.split("\n"):
        item = re.match(r"([-*] |\d+\. )", line)
        if item:
            width = len(item[1])
        elif line and not line.startswith(" "):
            width = 0
        elif width and line.strip():
            line = " " * (4 - width) + line
        lines.append(line)
    return "\n".join(lines)


def on_page_markdown(markdown, page, config, files):
    source, place = Path(page.file.abs_src_path), page.file.src_uri

    def has(goal):
        return files.get_file_from_path(goal) is not None

    def change(text):
        return with_blank_lines_before_lists(with_links_of_the_site(text, source, place, has))

    text = with_deep_lists(outside_fences(markdown, change))
    return text + "\n\n" + "".join(f"*[{words}]: {meaning}\n" for words, meaning in EXPLAINED.items())


def on_page_content(html, page, config, files):
    """A heading of a column without words is none."""
    return re.sub(r"<th([^>]*)></th>", r"<td\1></td>", html)


def on_post_build(config):
    site = Path(config["site_dir"])
    index = json.dumps(json.loads((site / "search/search_index.json").read_text()), separators=(",", ":"), ensure_ascii=False)
    (site / "search/search_index.js").write_text(f"cellmirrorSearchIndex({index});\n")
    for name in ("404.html", "sitemap.xml", "sitemap.xml.gz", "search/search_index.json"):
        (site / name).unlink(missing_ok=True)
    shutil.rmtree(site / "assets/javascripts/lunr", ignore_errors=True)
    for file in site.rglob("*.map"):
        file.unlink()
    # Nothing may depend on the modes of the builder's files.
    for file in site.rglob("*"):
        os.chmod(file, 0o755 if file.is_dir() else 0o644)

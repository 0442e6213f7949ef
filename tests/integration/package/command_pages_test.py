"""Manual pages and bash completion, made from the command lines of the programs."""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import gateway as g

PROGRAMS = ("cellmirror", "sim_robot", "sim_haptic", "sim_footswitch", "sim_camera_head")


def help_of(program, *sub):
    done = subprocess.run([g.BIN / program, *sub, "--help"], capture_output=True, text=True, timeout=60, check=True)
    return done.stdout


def plain(page):
    """The text of a page without the escapes of roff."""
    for escape, character in ((r"\-", "-"), (r"\(aq", "'"), (r"\(ha", "^"), (r"\(ti", "~"), (r"\(rs", "\\"), (r"\&", "")):
        page = page.replace(escape, character)
    return re.sub(r"\\f[BIP]", "", page)


class Pages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.root = pathlib.Path(tempfile.mkdtemp(prefix="cellmirror-pages-"))
        subprocess.run([sys.executable, "-B", g.SOURCE / "cmake" / "command_pages.py", "--version", "1.2.3", "--date", "2026-01-02",
                        "--man", cls.root / "man", "--completion", cls.root / "bash", *(g.BIN / name for name in PROGRAMS)],
                       check=True, timeout=60)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.root)

    def page(self, program):
        return (self.root / "man" / f"{program}.1").read_text()

    def test_hold_every_option_and_subcommand_of_the_help(self):
        for program in PROGRAMS:
            page = plain(self.page(program))
            self.assertRegex(page, rf'^\.TH {program.upper()} 1 2026-01-02 "cellmirror 1\.2\.3"')
            self.assertRegex(page, rf"\.SH NAME\n{program} - [a-z].{{10,}}")
            text = help_of(program)
            subcommands = re.findall(r"^  (\S+)  ", text.partition("Subcommands:")[2], re.MULTILINE)
            self.assertEqual(bool(subcommands), program in ("cellmirror", "sim_robot"))
            for sub in subcommands:
                self.assertIn(f".SS {program} {sub}", page)
                text += help_of(program, sub)
            if program == "cellmirror":
                text += help_of(program, "volume", "info")
                self.assertIn(".SS cellmirror volume info [OPTIONS]", page)
            options = set(re.findall(r"^  (?:-\w,)?(--[\w-]+)", text, re.MULTILINE))
            self.assertGreater(len(options), 5)
            for option in options:
                self.assertIn(option, page, program)

    def test_are_sound_roff(self):
        if shutil.which("man") is None:
            self.skipTest("skipped: man is missing (package man-db)")
        for program in PROGRAMS:
            done = subprocess.run(["man", "--warnings", "-E", "UTF-8", "-l", "-Tutf8", "-Z", self.root / "man" / f"{program}.1"],
                                  capture_output=True, text=True, timeout=60, env={"PATH": "/usr/bin:/bin", "LC_ALL": "C.UTF-8", "MANWIDTH": "80"})
            self.assertEqual((done.returncode, done.stderr), (0, ""), program)

    def completed(self, line):
        """What is offered at the end of the line."""
        words = line.split(" ")
        script = (f'source "{self.root}/bash/{words[0]}"; COMP_WORDS=({" ".join(repr(word) for word in words)}); COMP_CWORD={len(words) - 1}; '
                  f'_{words[0]} 2>/dev/null; printf "%s\\n" "${{COMPREPLY[@]}}"')
        done = subprocess.run(["bash", "--norc", "-c", script], capture_output=True, text=True, timeout=60)
        return done.stdout.split()

    def test_completion_offers_what_may_stand_there(self):
        self.assertIn("run", self.completed("cellmirror "))
        self.assertEqual(self.completed("cellmirror sim"), ["simulate"])
        self.assertEqual(self.completed("cellmirror run --ins"), ["--instance"])
        self.assertEqual(self.completed("cellmirror run cell.toml --no-w"), ["--no-web"])
        self.assertEqual(sorted(self.completed("cellmirror ik --method ")), ["auto", "fast", "ipopt"])
        self.assertEqual(self.completed("cellmirror --vers"), ["--version"])
        self.assertEqual(self.completed("cellmirror run --script "), [], "a file: that is bash's own")
        self.assertEqual(self.completed("cellmirror run --port "), [], "a number")
        self.assertEqual(self.completed("cellmirror volume in"), ["info"])
        self.assertIn("--plot", self.completed("cellmirror volume info --"))
        self.assertEqual(self.completed("cellmirror send status --for"), [], "no option of status: it is a command to send")
        self.assertIn("dds", self.completed("sim_robot "))
        self.assertNotIn("--describe-command-line", self.completed("cellmirror --"))


if __name__ == "__main__":
    g.main()

# SPDX-License-Identifier: Apache-2.0
"""Manual page and completions hold what --help tells of."""
import os
import pathlib
import pty
import re
import select
import shutil
import subprocess
import unittest

from hang_limit import HANG_LIMIT
from harness import SETTINGS, CliTest, clean_environment

VERBS = [["render"], ["merge"], ["compare"], ["bench"], ["converge"], ["stress"], ["report"],
         ["devices"], ["doctor"], ["explain"], ["scene", "info"], ["scene", "check"]]


class Shell(CliTest):
    def options(self, verb):
        found = re.findall(r"^ +((?:-\w,)?--[\w-]+|-\w)\b", self.output(*verb, "--help"), re.M)
        self.assertTrue(found)
        return {name for names in found for name in names.split(",")}

    def sections_of_the_manual(self):
        """By verb, with roff's escapes undone."""
        text = self.output("--man").replace("\\-", "-").replace("\\:", "").replace("\\fR", "")
        parts = re.split(r"^\.SS mirrorball ?(.*)\n", text, flags=re.M)
        return {name: part.split("\n.SH")[0] for name, part in zip(parts[1::2], parts[2::2])}

    def complete(self, *words):
        """What is offered for the last word."""
        return [line.split("\t")[0] for line in self.output("--complete", *words).splitlines()]

    def test_manual_has_every_option(self):
        sections = self.sections_of_the_manual()
        for verb in VERBS:
            written = re.findall(r"\\fB(-[\w-]+)", sections[" ".join(verb)])
            self.assertEqual(self.options(verb), set(written), verb)

    @unittest.skipUnless(shutil.which("groff"), "no groff")
    def test_manual_is_right_roff(self):
        for more in [[], ["-Tutf8", "-rLL=80n"]]:  # the second as on a terminal
            result = subprocess.run(["groff", "-man", "-ww", "-z", *more], input=self.output("--man"),
                                    text=True, capture_output=True, check=False)
            self.assertEqual(result.stderr, "", more)

    def test_manual_says_which_arguments_may_be_left_out(self):
        lines = self.output("--man").replace("\\fI", "").replace("\\fR", "").splitlines()
        for verb, arguments in [("render", "[SCENE...]"), ("merge", "PART..."), ("compare", "A B")]:
            at = lines.index(f".B mirrorball {verb}")
            self.assertEqual(lines[at + 1], f"[options] {arguments}")

    def test_manual_names_the_files_that_are_installed(self):
        self.assertIn("share/mirrorball/scenes", self.output("--man").split(".SH FILES")[1])

    def test_every_option_is_completed(self):
        for verb in VERBS:
            self.assertEqual(self.options(verb), set(self.complete(*verb, "-")), verb)
        self.assertEqual(self.complete("re"), ["render", "report"])
        self.assertEqual(self.complete("scene", ""), ["info", "check", "schema", "-h", "--help"])
        self.assertEqual(self.complete("render", "--filter", "m"), ["mitchell"])
        self.assertEqual(self.complete("render", "a.json", "--no-f"), ["--no-fallback"])

        self.assertEqual(self.complete("render", "--math=s"), ["--math=strict"])
        self.assertEqual(self.complete("render", "--stats", "j"), ["json"])
        self.assertEqual(self.complete("render", "--stats", "--ma"), ["--max-bounces", "--math"])
        self.assertEqual(self.complete("render", "--stats", "--math", "s"), ["strict"])
        self.assertEqual(self.complete("bench", "--json", "--precision", "f"), ["float"])
        self.assertEqual(self.complete("render", "--format", ""), ["png", "exr", "pfm"])
        for words in [["render", ""], ["render", "scene"], ["render", "-o", ""], ["render", "--output=p"], []]:
            self.assertEqual(self.complete(*words), self.complete("") if not words else [], words)
        self.assertEqual(self.complete("--completions", ""), ["bash", "zsh", "fish"])

    def words_of(self, shell, typed):
        """The words of a line that was typed into a shell, its completions loaded."""
        keys, terminal = pty.openpty()
        self.addCleanup(os.close, keys)
        process = subprocess.Popen(
            [*shell, "-i"], cwd=self.folder, stdin=terminal, stdout=terminal, stderr=terminal,
            start_new_session=True, env=clean_environment(
                {"ZDOTDIR": str(self.folder), "MIRRORBALL": SETTINGS["program"], "TERM": "dumb",
                 "PATH": f"{pathlib.Path(SETTINGS['program']).parent}:{os.environ['PATH']}"}))
        os.close(terminal)
        self.addCleanup(self._finish, process)
        shown = b""
        while select.select([keys], [], [], HANG_LIMIT)[0]:
            try:
                shown += os.read(keys, 4096)
            except OSError:  # the shell has ended
                break
            if typed and b"READY" in shown:
                os.write(keys, typed.encode() + b"\r")
                typed = ""
        process.wait(HANG_LIMIT)
        words = self.folder / "words"
        self.assertTrue(words.exists(), shown.decode(errors="replace"))
        found = words.read_text().splitlines()
        words.unlink()
        return found

    def check_typing(self, shell):
        self.write_text("my scene.json", "")
        self.write_text("picture.json", "")
        for typed, words in [("ren\t", ["render"]),
                             ("render --filter m\t", ["render", "--filter", "mitchell"]),
                             ("render --math=s\t", ["render", "--math=strict"]),
                             ("render --stats=j\t", ["render", "--stats=json"]),
                             ("render pic\t", ["render", "picture.json"]),
                             ("render --batch pic\t", ["render", "--batch", "picture.json"]),
                             ("scene info my\t", ["scene", "info", "my scene.json"])]:
            self.assertEqual(self.words_of(shell, "mirrorball " + typed), words)

    def test_bash_completes_what_is_typed(self):
        self.write_text("rc", "PS1='READY '; source <($MIRRORBALL --completions bash)\n"
                        "mirrorball() { printf '%s\\n' \"$@\" >words; exit; }\n")
        self.check_typing(["bash", "--rcfile", "rc"])

    @unittest.skipUnless(shutil.which("zsh"), "no zsh")
    def test_zsh_completes_what_is_typed(self):
        """From the first Tab on: each line is typed into a shell of its own."""
        (self.folder / "site-functions").mkdir()
        self.write_text("site-functions/_mirrorball", self.output("--completions", "zsh"))
        self.write_text(".zshrc", "PS1='READY '; fpath=($ZDOTDIR/site-functions $fpath)\n"
                        "autoload -U compinit; compinit -u -D\n"
                        "mirrorball() { printf '%s\\n' \"$@\" >words; exit; }\n")
        self.check_typing(["zsh", "-d"])

    def test_unknown_shell(self):
        self.assert_refused(self.run_cli("--completions", "tcsh"), 2, "bash, zsh or fish")

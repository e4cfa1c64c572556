# SPDX-License-Identifier: Apache-2.0
"""Manual page and completions hold what --help tells of."""
import re
import shutil
import subprocess
import unittest

from harness import CliTest

VERBS = [["render"], ["merge"], ["compare"], ["bench"], ["converge"], ["stress"], ["report"],
         ["devices"], ["doctor"], ["explain"], ["scene", "info"], ["scene", "check"]]


class Shell(CliTest):
    def text(self, *arguments):
        result = self.run_cli(*arguments)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return result.stdout

    def options(self, verb):
        found = re.findall(r"^ +((?:-\w,)?--[\w-]+|-\w)\b", self.text(*verb, "--help"), re.M)
        self.assertTrue(found)
        return {name for names in found for name in names.split(",")}

    def sections_of_the_manual(self):
        """By verb, with roff's escapes undone."""
        text = self.text("--man").replace("\\-", "-").replace("\\:", "").replace("\\fR", "")
        parts = re.split(r"^\.SS mirrorball ?(.*)\n", text, flags=re.M)
        return {name: part.split("\n.SH")[0] for name, part in zip(parts[1::2], parts[2::2])}

    def complete(self, *words):
        """What bash offers for the last word."""
        quoted = " ".join(f"'{word}'" for word in ["mirrorball", *words])
        return self.run_shell(f"source <($MIRRORBALL --completions bash); COMP_WORDS=({quoted}); "
                              f"COMP_CWORD={len(words)}; _mirrorball; "
                              "printf '%s\\n' \"${COMPREPLY[@]}\"").stdout.split()

    def test_manual_has_every_option(self):
        sections = self.sections_of_the_manual()
        for verb in VERBS:
            written = re.findall(r"\\fB(-[\w-]+)", sections[" ".join(verb)])
            self.assertEqual(self.options(verb), set(written), verb)

    @unittest.skipUnless(shutil.which("groff"), "no groff")
    def test_manual_is_right_roff(self):
        result = subprocess.run(["groff", "-man", "-ww", "-z"], input=self.text("--man"), text=True,
                                capture_output=True, check=False)
        self.assertEqual(result.stderr, "")

    def test_bash_completes_every_option(self):
        for verb in VERBS:
            self.assertEqual(self.options(verb), set(self.complete(*verb, "-")), verb)
        self.assertEqual(self.complete("re"), ["render", "report"])
        self.assertEqual(self.complete("scene", ""), ["info", "check", "-h", "--help"])
        self.assertEqual(self.complete("render", "--filter", "m"), ["mitchell"])
        self.assertEqual(self.complete("render", "a.json", "--no-f"), ["--no-fallback"])

    def test_bash_completes_files(self):
        self.write_text("picture.json", "")
        for words in [("render", "pic"), ("render", "--batch", "pic"), ("scene", "info", "pic")]:
            self.assertEqual(self.complete(*words), ["picture.json"])

    def test_fish_completes_every_option(self):
        lines = self.text("--completions", "fish").splitlines()
        for verb in VERBS:
            seen = "; and ".join(f"__fish_seen_subcommand_from {word}" for word in verb)
            own = [line for line in lines if f"-n '{seen}'" in line]
            offered = {f"--{name}" for line in own for name in re.findall(r" -l (\S+)", line)}
            offered |= {f"-{name}" for line in own for name in re.findall(r" -s (\S)", line)}
            self.assertEqual(self.options(verb), offered, verb)

    def test_unknown_shell(self):
        self.assert_refused(self.run_cli("--completions", "tcsh"), 2, "bash, zsh or fish")

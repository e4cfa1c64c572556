# SPDX-License-Identifier: Apache-2.0
"""Manual page and completions hold what --help tells of."""
import re
import shutil
import subprocess
import unittest

from harness import CliTest, clean_environment
from program import HANG_LIMIT, PROGRAM

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

    def check_scripts(self, shell, command):
        """What a shell's script offers for the last of its words; shells split at = themselves."""
        for words, offered in [(["ren"], ["render"]), (["scene", "ch"], ["check"]),
                               (["render", "--filter", "m"], ["mitchell"]),
                               (["render", "--math=s"], ["--math=strict"]), (["render", "pic"], [])]:
            if shell == "bash":
                words = [part for word in words for part in re.split("(=)", word)]
                offered = [word.split("=")[-1] for word in offered]
            result = subprocess.run([shell, "-c", command, PROGRAM, *words], capture_output=True,
                                    text=True, env=clean_environment({}), timeout=HANG_LIMIT, check=False)
            self.assertEqual((result.stdout.split(), result.stderr), (offered, ""), words)

    def test_bash_completes_words(self):
        self.check_scripts("bash", 'source <("$0" --completions bash); COMP_WORDS=("$0" "$@"); '
                           'COMP_CWORD=$#; _mirrorball; printf "%s\\n" "${COMPREPLY[@]}"')

    @unittest.skipUnless(shutil.which("zsh"), "no zsh")
    def test_zsh_completes_words(self):
        self.check_scripts("zsh", 'words=("$0" "$@") CURRENT=$#words; _files() {}; '
                           '_describe() { print -l -- ${offered%%:*} }; source <("$0" --completions zsh)')

    def test_unknown_shell(self):
        self.assert_refused(self.run_cli("--completions", "tcsh"), 2, "bash, zsh or fish")

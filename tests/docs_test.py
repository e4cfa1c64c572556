#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the commands of README.md, docs/tutorial.md and docs/kernels.md as they are printed; reads those
of all pages.

A block of a page without a language is commands: lines that begin with `mirrorball` or
`build/release/mirrorball` are run, one after the other, in a folder that has the repository's scenes.
A json block that follows "Save this as `NAME`" is written to NAME first.
"""
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import tempfile
import unittest

from program import PROGRAM, ROOT, run

NAMES = {"mirrorball", "build/release/mirrorball"}
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "python/README.md",
         *sorted((ROOT / "docs").glob("*.md"))]
# Of other programs, of scripts, and of an earlier revision.
OTHERS_OPTIONS = {"--spec", "--bind-to", "--enable-recovery", "--sshlogin", "--corners", "--naive"}


def steps_of(page):
    """("file", name, text) and ("command", words, line) of a page, in order."""
    text = page.read_text(encoding="utf-8")
    for block in re.finditer(r"^```(\w*)\n(.*?)^```$", text, re.M | re.S):
        language, content = block.groups()
        if language == "json":
            named = re.search(r"Save this as `([\w.-]+)`[^`]*$", text[:block.start()])
            if named:
                yield "file", named[1], content
        elif not language:
            for line in content.splitlines():
                words = shlex.split(line, comments=True)
                if words and words[0] in NAMES and words[1] != "report":  # which report_test.py runs
                    yield "command", words[1:], line


def code_of(page):
    """The code of a page: blocks without a language or of a shell's, and what is between backquotes."""
    text = page.read_text(encoding="utf-8")
    block = re.compile(r"^```(\w*)\n(.*?)^```$", re.M | re.S)
    for found in block.finditer(text):
        if found[1] in ("", "sh"):
            yield found[2]
    yield from re.findall(r"`([^`]+)`", block.sub("", text))


class Code(unittest.TestCase):
    """What is not run, since it installs or takes long."""

    def test_names_scripts_that_are_there(self):
        for page in PAGES:
            for script in re.findall(r"(?<![\w/.])scripts/[\w/.-]*\w", "\n".join(code_of(page))):
                self.assertTrue((ROOT / script).exists(), f"{page}: {script}")

    def test_names_packages_as_apt_reads_them(self):
        """To apt, `build/x.deb` is package build of release x.deb."""
        commands = [(page, words.split()) for page in PAGES for code in code_of(page)
                    for words in re.findall(r"apt(?:-get)? install ([^\n]+)", code)]
        self.assertTrue(commands)
        for page, words in commands:
            for word in words:
                self.assertRegex(word, r"^(\.{0,2}/.*|[^/]*)$", page)

    def test_names_presets_that_are_there(self):
        presets = json.loads((ROOT / "CMakePresets.json").read_text(encoding="utf-8"))
        names = {preset["name"] for preset in presets["configurePresets"]}
        found = [name for page in PAGES for code in code_of(page) for name in re.findall(r"--preset (\S+)", code)]
        self.assertTrue(found)
        self.assertLessEqual(set(found), names)

    def test_tells_how_long_the_tracer_is(self):
        page = (ROOT / "docs/kernels.md").read_text(encoding="utf-8")
        said = int(re.search(r"about ([\d,]+) lines of OpenCL C in `kernels/`", page)[1].replace(",", ""))
        lines = sum(len(path.read_text(encoding="utf-8").splitlines())
                    for path in (ROOT / "kernels").iterdir() if path.is_file())
        self.assertAlmostEqual(said / lines, 1, delta=0.05, msg=str(lines))


def anchors_of(page):
    """As GitHub makes them of headings."""
    headings = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), re.M)
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}


class Links(unittest.TestCase):
    def test_lead_somewhere(self):
        found = 0
        for page in PAGES:
            for link in re.findall(r"\]\(([^()\s]+)\)", page.read_text(encoding="utf-8")):
                if "://" in link:
                    continue
                path, _, anchor = link.partition("#")
                target = (page.parent / path).resolve() if path else page
                self.assertTrue(target.exists(), f"{page}: {link}")
                if anchor:
                    self.assertIn(anchor, anchors_of(target), f"{page}: {link}")
                found += 1
        self.assertGreater(found, 50)


def options_of(*verb):
    return set(re.findall(r"^  (?:-\w,)?(--[\w-]+)", run(*verb, "--help").stdout, re.M))


class Options(unittest.TestCase):
    def test_that_pages_name_are_there(self):
        verbs = re.findall(r"^  (\w+) ", run("--help").stdout.partition("Verbs (")[2], re.M)
        of_verb = {verb: options_of(verb) for verb in verbs}
        of_verb["scene"] = options_of("scene", "info") | options_of("scene", "check")
        of_any = set().union(options_of(), *of_verb.values())
        found = 0
        for page in PAGES:
            for line in "\n".join(code_of(page)).splitlines():
                words = line.partition("#")[0].split()
                if words and words[0] in NAMES:
                    words = words[1:]
                if not words or not (words[0] in verbs or words[0].startswith("--")):
                    continue
                options = set(re.findall(r"(?<!\S)--[a-z][\w-]*", " ".join(words)))
                found += len(options)
                unknown = options - OTHERS_OPTIONS - of_verb.get(words[0], of_any)
                self.assertFalse(unknown, f"{page}: {line}")
        self.assertGreater(found, 100)


class Pages(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "out").mkdir()
        shutil.copytree(ROOT / "scenes", self.folder / "scenes")

    def run_page(self, name, environment):
        """How many commands ran."""
        commands = 0
        for kind, what, content in steps_of(ROOT / name):
            if kind == "file":
                (self.folder / what).write_text(content, encoding="utf-8")
                continue
            result = subprocess.run(
                ["bash", "-c", '"$0" ' + " ".join(glob_safe(word) for word in what),
                 PROGRAM], cwd=self.folder, capture_output=True, text=True,
                check=False, env={**os.environ, **environment})
            with self.subTest(command=content):
                self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
            commands += 1
        return commands

    def test_readme(self):
        self.assertGreaterEqual(self.run_page("README.md", {}), 4)

    def test_tutorial(self):
        home = {"XDG_CACHE_HOME": str(self.folder / "cache")}
        self.assertGreaterEqual(self.run_page("docs/tutorial.md", home), 10)
        for picture in ["ball.png", "balls.png", "torus.png", "heat.png"]:
            self.assertTrue((self.folder / picture).exists(), picture)

    def test_kernels(self):
        self.assertGreaterEqual(self.run_page("docs/kernels.md", {}), 3)


def glob_safe(word):
    """The word for a shell that may still expand its stars."""
    return word if re.fullmatch(r"[\w./:,*=-]+", word) else shlex.quote(word)


if __name__ == "__main__":
    unittest.main(verbosity=2)

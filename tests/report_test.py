# SPDX-License-Identifier: Apache-2.0
"""The page of `mirrorball report`: well-formed, alone, small, described, and without a word on the
console of a real Chromium.

usage: report_test.py BUILD_DIR REPO_ROOT
"""
import html.parser
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
ROOT = pathlib.Path(sys.argv.pop(1)).resolve()
EVIL = '</title><script>alert("x")</script>'
VOID = {"meta", "link", "img", "br", "hr", "input"}


class Page(html.parser.HTMLParser):
    """Checks that elements nest; keeps start tags and the JSON blocks."""

    def __init__(self, text):
        super().__init__()
        self.open, self.mistakes, self.tags, self.blocks = [], [], [], {}
        self.block = None
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        self.tags.append((tag, attrs))
        if tag not in VOID:
            self.open.append(tag)
        if tag == "script":
            self.block = attrs.get("id")
            self.blocks[self.block] = (attrs.get("type"), "")

    def handle_startendtag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.mistakes.append(f"</{tag}> at {self.getpos()}")
        self.block = None

    def handle_data(self, data):
        if self.block:
            kind, text = self.blocks[self.block]
            self.blocks[self.block] = (kind, text + data)


def setUpModule():
    global FOLDER, TEXT, PAGE
    FOLDER = pathlib.Path(tempfile.mkdtemp(prefix="mirrorball-report-"))
    unittest.addModuleCleanup(shutil.rmtree, FOLDER, ignore_errors=True)
    scene = (ROOT / "scenes" / "cornell-box.json").read_text(encoding="utf-8")
    scene, names = re.subn(r'"name"\s*:\s*"[^"]*"', lambda _: '"name": ' + json.dumps(EVIL), scene,
                           count=1)
    assert names == 1
    (FOLDER / "scene.json").write_text(scene, encoding="utf-8")
    environment = dict(os.environ, XDG_CACHE_HOME=str(FOLDER / "cache"))
    subprocess.run([str(BUILD / "mirrorball"), "report", "scene.json", "-o", "report.html",
                    "--size", "48", "--quick", "-q"],
                   cwd=FOLDER, env=environment, check=True, timeout=300)
    TEXT = (FOLDER / "report.html").read_text(encoding="utf-8")
    PAGE = Page(TEXT)


class Report(unittest.TestCase):
    def test_is_well_formed(self):
        self.assertEqual(PAGE.mistakes, [])
        self.assertEqual(PAGE.open, [])
        ids = [attrs["id"] for _, attrs in PAGE.tags if "id" in attrs]
        self.assertEqual(len(ids), len(set(ids)), "an id stands twice")

    def test_stands_alone_and_is_small(self):
        self.assertLess(len(TEXT.encode()), 2_000_000)
        addresses = set(re.findall(r"https?://[^\s\"'<>]+", TEXT))
        self.assertLessEqual(addresses, {"http://www.w3.org/2000/svg"})
        for tag, attrs in PAGE.tags:
            for name in ["src", "href"]:
                self.assertTrue(attrs.get(name, "#").startswith(("data:", "#")), (tag, attrs))

    def test_pictures_are_described(self):
        for tag, attrs in PAGE.tags:
            if tag == "img":
                self.assertTrue(attrs.get("alt"), attrs.get("src", "")[:40])
            if tag == "svg":
                self.assertTrue(attrs.get("aria-labelledby") or attrs.get("aria-hidden"))

    def test_names_are_text(self):
        self.assertNotIn(EVIL, TEXT)
        self.assertIn("&lt;/title&gt;&lt;script&gt;", TEXT)

    def test_data_can_be_read_and_sources_lead_to_it(self):
        blocks = {}
        for name, (kind, text) in PAGE.blocks.items():
            self.assertEqual(kind, "application/json")
            blocks[name] = json.loads(text)
        self.assertGreaterEqual(set(blocks), {"environment", "bench-0", "converge-0", "pictures-0"})
        sources = {attrs["data-source"] for _, attrs in PAGE.tags if "data-source" in attrs}
        self.assertGreater(len(sources), 10)
        for source in sources:
            name, pointer = source.split("#")
            value = blocks[name]
            for key in pointer.split("/")[1:]:
                value = value[int(key)] if isinstance(value, list) else value[key]
            self.assertIsNotNone(value, source)

    def test_figures_come_from_the_repeats(self):
        rows = json.loads(PAGE.blocks["bench-0"][1])["rows"]
        for row in rows:
            self.assertEqual(row["verdict"], "right", row["why"])
            self.assertEqual(len(row["repeats"]), 5)

    def chromium(self, *arguments):
        program = shutil.which("chromium") or shutil.which("chromium-browser")
        if program is None:
            self.skipTest("no chromium: scripts/install test")
        with tempfile.TemporaryDirectory() as profile:
            return subprocess.run(
                [program, "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run",
                 "--disable-background-networking", "--disable-component-update",
                 "--disable-sync", "--user-data-dir=" + profile, "--enable-logging=stderr",
                 "--v=0", *arguments, (FOLDER / "report.html").as_uri()],
                capture_output=True, timeout=120, check=False)

    def test_chromium_renders_it_in_silence(self):
        picture = FOLDER / "page.png"
        result = self.chromium("--window-size=1000,6000", f"--screenshot={picture}")
        log = result.stderr.decode(errors="replace")
        self.assertEqual(result.returncode, 0, log)
        self.assertNotIn("CONSOLE", log)
        self.assertGreater(picture.stat().st_size, 50_000)

    def test_chromium_keeps_its_elements(self):
        result = self.chromium("--dump-dom")
        text = result.stdout.decode(errors="replace")
        self.assertEqual(text.count("<figure"), TEXT.count("<figure"))
        self.assertEqual(text.count("<svg"), TEXT.count("<svg"))


if __name__ == "__main__":
    unittest.main()

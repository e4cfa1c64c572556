# SPDX-License-Identifier: Apache-2.0
"""The page of `mirrorball report`: well-formed, alone, small, described, and its numbers those of its data."""
import html
import html.parser
import json
import os
import pathlib
import re
import shlex
import shutil
import signal
import statistics
import subprocess
import tempfile
import unittest

from program import HANG_LIMIT, PROGRAM, ROOT, run

EVIL = '</title><script>alert("x")</script>'
VOID = {"meta", "link", "img", "br", "hr", "input"}


class Page(html.parser.HTMLParser):
    """Checks that elements nest; keeps start tags, the JSON blocks, and the tables' rows: a cell is
    its text and its data-source."""

    def __init__(self, text):
        super().__init__()
        self.open, self.mistakes, self.tags, self.blocks = [], [], [], {}
        self.tables, self.glance = [], []
        self.colored = []  # (color, data-source)
        self.block = self.cell = None
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        self.tags.append((tag, attrs))
        color = re.search(r"var\(--s(\d)\)", attrs.get("style", ""))
        if tag not in VOID:
            self.open.append(tag)
        if color and "data-source" in attrs:
            self.colored.append((color[1], attrs["data-source"]))
        if tag == "table":
            self.tables.append([])
        if tag == "tr":
            self.tables[-1].append([])
        if tag in {"td", "th", "dd"}:
            self.cell = ["", attrs.get("data-source", "")]
            (self.glance if tag == "dd" else self.tables[-1][-1]).append(self.cell)
        if tag in {"small", "caption"}:
            self.cell = None
        if tag == "script":
            self.block = attrs.get("id")
            self.blocks[self.block] = (attrs.get("type"), "")

    def handle_startendtag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.mistakes.append(f"</{tag}> at {self.getpos()}")
        self.block = None
        if tag in {"td", "th", "dd"}:
            self.cell = None

    def handle_data(self, data):
        if self.cell is not None:
            self.cell[0] += data
        if self.block:
            kind, text = self.blocks[self.block]
            self.blocks[self.block] = (kind, text + data)


SUPERSCRIPTS = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
UNITS = {"s": 1, "ms": 1e-3, "µs": 1e-6, "M": 1e6}


def number(text):
    """What a reader takes from 1.9·10⁻⁷, 403 µs or RMSE 0.1."""
    found = re.search(r"([0-9.]+)(?:·10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+))?(?:\xa0(s|ms|µs|M)\b)?", text)
    power = 10.0 ** int(found[2].translate(SUPERSCRIPTS)) if found[2] else 1
    return float(found[1]) * power * UNITS.get(found[3], 1)


def seconds_of(row, phases):
    """The median over a row's repeats."""
    return statistics.median(sum(one["seconds"][phase] for phase in phases)
                             for one in row["repeats"])


def trace(row):
    return seconds_of(row, ["trace"])


def total(row):
    return seconds_of(row, ["flatten", "open", "build", "upload", "trace", "resolve", "read_back"])


def rate(row):
    return row["repeats"][0]["rays"]["total"] / trace(row)


def rmse(row):
    return row["repeats"][0]["error"]["rmse"]


def setUpModule():
    global FOLDER, TEXT, PAGE
    FOLDER = pathlib.Path(tempfile.mkdtemp(prefix="mirrorball-report-"))
    unittest.addModuleCleanup(shutil.rmtree, FOLDER, ignore_errors=True)
    scene = (ROOT / "scenes" / "cornell-box.json").read_text(encoding="utf-8")
    scene, names = re.subn(r'"name"\s*:\s*"[^"]*"', lambda _: '"name": ' + json.dumps(EVIL), scene,
                           count=1)
    assert names == 1
    (FOLDER / "scene.json").write_text(scene, encoding="utf-8")
    line = re.search(r"^build/release/mirrorball (report .*)$", (ROOT / "README.md").read_text(encoding="utf-8"), re.M)[1]
    others = {"scenes/cornell-box.json": "scene.json", "160": "48"}
    run(*(others.get(word, word) for word in shlex.split(line, comments=True)), "-q", "--plots", "plots",
        cwd=FOLDER, XDG_CACHE_HOME=str(FOLDER / "cache"))
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
        ids = {attrs["id"] for _, attrs in PAGE.tags if "id" in attrs}
        for _, attrs in PAGE.tags:
            self.assertLessEqual(set(attrs.get("aria-labelledby", "").split()), ids)

    def test_headings_leave_no_level_out(self):
        levels = [int(tag[1]) for tag, _ in PAGE.tags if re.fullmatch("h[1-6]", tag)]
        self.assertEqual(levels.count(1), 1)
        for before, after in zip(levels, levels[1:]):
            self.assertLessEqual(after, before + 1, levels)

    def test_a_policy_forbids_scripts_and_addresses(self):
        policy = next(attrs["content"] for _, attrs in PAGE.tags
                      if attrs.get("http-equiv") == "Content-Security-Policy")
        self.assertTrue(policy.startswith("default-src 'none';"))
        self.assertNotIn("script-src", policy)

    def test_the_verdict_is_in_words_and_those_of_the_data(self):
        verdict = html.unescape(re.search(r"<h1>(.*?)</h1>", TEXT, re.S)[1])
        found = re.fullmatch(r"(.*) traces? (.*) in ([\d.]+\xa0\S+?)"
                             r"(?:(?:: ([\d.]+) times)?,? as fast as (.*))", verdict)
        self.assertTrue(found, verdict)
        self.assertEqual(found[2], EVIL)
        rows = [row for row in self.source("bench-0#/rows")
                if row["width"] == 48 and row["aa"] == "grid:2"]
        most = max(row["threads"] for row in rows)
        device, threads = (min((row for row in rows if row["threads"] == count), key=trace) for count in (0, most))
        fast, slow = sorted((device, threads), key=trace)
        self.assert_shown(found[3], trace(fast))
        for name, row in ((found[1], fast), (found[5], slow)):
            self.assertEqual(name.partition(" (")[0], "PoCL" if not row["threads"] else
                             f"{row['threads']} thread" + "s" * (row["threads"] > 1) +
                             ", sample buffers" * (row["schedule"] == "buffers") +
                             ", one ray at a time" * (row["schedule"] == "scalar"))
        if found[4]:
            self.assert_shown(found[4], trace(slow) / trace(fast))
        title = html.unescape(re.search(r"<title>(.*?)</title>", TEXT, re.S)[1])
        self.assertTrue(title.startswith(verdict))
        self.assertIn(self.source("environment#/cpu"), title)
        self.assertRegex(title, r"\d{4}-\d\d-\d\d \d\d:\d\d UTC$")

    def test_a_color_is_a_device(self):
        devices = {}
        for color, source in PAGE.colored:
            found = re.match(r"((?:bench|converge)-0#/(?:rows|points)/\d+)", source)
            devices.setdefault(color, set()).add(self.source(found[1])["device_name"])
        self.assertEqual([len(names) for names in devices.values()], [1] * len(devices), devices)
        names = [name for found in devices.values() for name in found]
        self.assertEqual(len(names), len(set(names)), devices)
        self.assertGreaterEqual(len(names), 2)

    def test_the_environment_names_the_machine(self):
        shown = {name: text for (name, _), (text, _) in next(
            table for table in PAGE.tables if table[0][0][0] == "what")[1:]}
        for name in ["git revision", "compiler", "processor", "memory", "operating system",
                     "kernel", "load before"]:
            self.assertTrue(shown[name], name)
        self.assertRegex(shown["memory"], r"^[\d.]{1,5}\xa0GiB$")
        self.assertLessEqual(len(shown["load before"]), 4)

    def test_names_are_text(self):
        self.assertNotIn(EVIL, TEXT)
        self.assertIn("&lt;/title&gt;&lt;script&gt;", TEXT)

    def test_data_can_be_read_and_sources_lead_to_it(self):
        self.assertEqual({kind for kind, _ in PAGE.blocks.values()}, {"application/json"})
        self.assertGreaterEqual(set(PAGE.blocks), {"environment", "bench-0", "converge-0", "pictures-0"})
        sources = {attrs["data-source"] for _, attrs in PAGE.tags if "data-source" in attrs}
        self.assertGreater(len(sources), 10)
        for source in sources:
            self.assertIsNotNone(self.source(source), source)

    def test_figures_come_from_the_repeats(self):
        for row in self.source("bench-0#/rows"):
            self.assertEqual(row["verdict"], "right", row["why"])
            self.assertEqual(len(row["repeats"]), 5)

    def source(self, pointer):
        name, path = pointer.split("#")
        value = json.loads(PAGE.blocks[name][1])
        for key in path.split("/")[1:]:
            value = value[int(key)] if isinstance(value, list) else value[key]
        return value

    def assert_shown(self, text, value, digits=3):
        """That a text shows a number with so many digits."""
        self.assertAlmostEqual(number(text) / value, 1, delta=0.51 * 10 ** (1 - digits), msg=text)

    def table_with(self, *headings):
        """The rows below the one table with these headings, each a dict by heading."""
        found = [table for table in PAGE.tables
                 if {heading for heading, _ in table[0]} >= set(headings)]
        self.assertEqual(len(found), 1, headings)
        names = [heading for heading, _ in found[0][0]]
        return [dict(zip(names, row)) for row in found[0][1:]]

    def test_the_table_of_every_row_shows_what_its_repeats_give(self):
        shown = self.table_with("trace, ms", "total, ms", "Mrays/s", "RMSE")
        self.assertEqual(len(shown), len(self.source("bench-0#/rows")))
        for cells in shown:
            row = self.source(cells["pixels"][1])
            self.assertEqual(cells["pixels"][0], f"{row['width']}\xa0x\xa0{row['height']}")
            self.assert_shown(cells["trace, ms"][0], 1e3 * trace(row))
            self.assert_shown(cells["total, ms"][0], 1e3 * total(row))
            self.assert_shown(cells["Mrays/s"][0], 1e-6 * rate(row))
            self.assert_shown(cells["RMSE"][0], rmse(row), digits=2)
            base = next(other for other in self.source("bench-0#/rows")
                        if other["device"] == "threads:1"
                        and other["schedule"] == (row["schedule"] or "tiles")
                        and all(other[k] == row[k] for k in ["width", "aa", "precision"]))
            self.assert_shown(cells["total speed-up"][0], total(base) / total(row))
            self.assert_shown(cells["trace speed-up"][0], trace(base) / trace(row))

    def test_tables_of_trace_times_show_their_rows(self):
        cells = [cell for table in PAGE.tables if len(table[0]) < 8
                 for line in table[1:] for cell in line if cell[1].startswith("bench-0#/rows/")]
        self.assertGreaterEqual(len(cells), 8)
        for text, source in cells:
            self.assert_shown(text, 1e3 * trace(self.source(source)))

    def test_the_front_shows_its_points(self):
        for cells in self.table_with("sampling", "run time, ms", "RMSE"):
            point = self.source(cells["sampling"][1])
            seconds = seconds_of(point, ["flatten", "upload", "trace", "resolve", "read_back"])
            self.assert_shown(cells["run time, ms"][0], 1e3 * seconds)
            self.assert_shown(cells["RMSE"][0], statistics.median(
                one["error"]["rmse"] for one in point["repeats"]))

    def test_the_numbers_at_a_glance_are_those_of_their_row(self):
        (time, source), (rays, _), (gain, _), (rounding, _), (sampling, picture) = PAGE.glance
        row = self.source(source)
        self.assert_shown(time, trace(row))
        self.assert_shown(rays, rate(row))
        self.assert_shown(gain, row["figures"]["trace_speed_up"])
        self.assert_shown(rounding, rmse(row), digits=2)
        self.assert_shown(sampling, self.source(picture)["rmse"], digits=2)

    def test_a_setting_has_one_total(self):
        """The bars name the totals of the largest picture's rows, in their order."""
        bars = re.search(r'<desc id="phases-0-desc">.*?</svg>', TEXT, re.S)[0]
        names = [html.unescape(name) for name in re.findall(r'font-weight[^>]*>([^<]*)</text>', bars)]
        rows = [row for row in self.source("bench-0#/rows") if row["width"] == 48 and row["aa"] == "grid:2"]
        self.assertEqual(len(names), len(rows))
        for name, row in zip(names, rows):
            self.assert_shown(name.rpartition("  ")[2], total(row))

    def test_a_picture_has_one_time(self):
        """The captions give the medians of the tables, and nothing gives another."""
        rows, pictures = self.source("bench-0#/rows"), self.source("pictures-0#")
        captions = re.findall(r"(?:Plain|Anti-aliased): (.+), traced in ([\d.]+)\xa0(\S+) on", TEXT)
        self.assertEqual([samples for samples, *_ in captions],
                         ["one sample per pixel", "2\xa0x\xa02 samples per pixel (grid:2)"])
        for aa, (_, shown, unit), picture in zip(["none", "grid:2"], captions, pictures.values()):
            medians = [row["figures"]["trace"]["median"] for row in rows
                       if (row["width"], row["aa"], row["device_name"]) ==
                       (48, aa, picture["device"]["name"])]
            self.assertEqual(len(medians), 1)
            self.assertAlmostEqual(float(shown) * UNITS[unit] / medians[0], 1, delta=0.01)
        trial = re.search(r"kernels compiled with.*?</table>", TEXT, re.S).group(0)
        self.assertNotIn("trace", trial)

    def test_pictures_have_an_estimate_of_their_error(self):
        for picture in self.source("pictures-0#").values():
            ratio = picture["estimate"]["rmse"] / picture["error"]["rmse"]
            self.assertTrue(0.5 < ratio < 2, ratio)
        self.assertEqual(TEXT.count(" (estimated without the reference: "), 4)  # captions and their images

    def test_the_commands_measure_the_same_rows(self):
        commands = html.unescape(re.search(r"<pre tabindex=\"0\"><code>(.*?)</code>", TEXT, re.S)[1])
        bench = next(line for line in commands.splitlines() if line.startswith("mirrorball bench"))
        option = dict(re.findall(r"--(sizes|aa|precision) (\S+)", bench))
        rows = self.source("bench-0#/rows")
        self.assertEqual(set(option["sizes"].split(",")), {f"{row['width']}x{row['height']}" for row in rows})
        self.assertEqual(set(option["aa"].split(",")), {row["aa"] for row in rows})
        self.assertEqual({option["precision"]}, {row["precision"] for row in rows})
        self.assertNotIn(str(pathlib.Path(tempfile.gettempdir()) / "mirrorball-report"), commands)

    def test_slopes_have_their_noise_and_a_mark(self):
        table = next(table for table in PAGE.tables if table[0][0][0] == "device" and table[0][1][0] == "grid")
        converge = self.source("converge-0#")
        for curve, shown in zip([c for c in converge["curves"] if c["family"] == "grid"], table[1:]):
            self.assertTrue(shown[1][0].startswith(f"{curve['slope']:.2f} ± "), shown)
            seconds = [converge["points"][i]["figures"]["seconds"] for i in curve["points"]]
            noisy = any(one["mad"] > .2 * one["median"] for one in seconds)
            self.assertEqual("(noisy)" in shown[1][0], noisy, seconds)

    def test_plots_are_also_files(self):
        names = set(re.findall(r'<svg [^>]*aria-labelledby="(\S+)-title', TEXT))
        self.assertGreaterEqual(names, {"phases-0", "size-0", "size-ratio-0", "error-time-0"})
        starts = {"svg": b"<?xml", "pdf": b"%PDF", "png": b"\x89PNG"}
        found = {file.name for file in (FOLDER / "plots").iterdir()}
        self.assertEqual(found, {f"{name}.{suffix}" for name in names for suffix in starts})
        for file in (FOLDER / "plots").iterdir():
            self.assertTrue(file.read_bytes().startswith(starts[file.suffix[1:]]), file)


class Failures(unittest.TestCase):
    """No page, the right exit code, and one line that says why."""

    def report(self, code, *words, **environment):
        page = FOLDER / "none.html"
        said = run("report", *words, "-o", page, "--quick", code=code, cwd=FOLDER, **environment).stderr
        self.assertFalse(page.exists())
        self.assertEqual(len(said.splitlines()), 1, said)
        return said

    def test_a_scene_that_is_missing(self):
        self.assertIn("missing.json: no such file", self.report(3, "scene.json", "missing.json"))

    def test_an_interpreter_without_matplotlib(self):
        (FOLDER / "bare").mkdir()
        (FOLDER / "bare" / "matplotlib.py").write_text("raise ImportError\n")
        said = self.report(5, "scene.json", PYTHONPATH=str(FOLDER / "bare"))
        self.assertIn("/usr/bin/python3", said)
        self.assertIn("apt install python3-matplotlib", said)

    def test_an_interpreter_that_lacks_it_gives_way_to_debians(self):
        (FOLDER / "bin").mkdir()
        own = FOLDER / "bin" / "python3"
        own.write_text("#!/bin/sh\nexit 1\n")
        own.chmod(0o755)
        self.report(3, "missing.json", PATH=f"{own.parent}:{os.environ['PATH']}")

    def test_a_folder_that_cannot_be_made(self):
        (FOLDER / "file").write_text("")
        self.assertIn("file/plots: cannot make this folder", self.report(4, "scene.json", "--plots", "file/plots"))

    def test_a_signal(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            command = [PROGRAM, "report", "scene.json", "-o", "stopped.html", "--size", "64",
                       "--devices", "threads", "--repeats", "30"]
            with subprocess.Popen(command, cwd=FOLDER, stderr=subprocess.PIPE, text=True) as process:
                for line in process.stderr:
                    if "round 2" in line:
                        break
                process.send_signal(number)
                stderr = process.communicate(timeout=HANG_LIMIT)[1]
            self.assertEqual(process.returncode, 128 + number, stderr)
            self.assertIn("; no page written", stderr)
            self.assertEqual([path for path in FOLDER.iterdir() if path.name.startswith((".mirrorball", "stopped"))], [])


if __name__ == "__main__":
    unittest.main(verbosity=2)

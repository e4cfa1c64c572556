# SPDX-License-Identifier: Apache-2.0
"""One self-contained page about scenes: `mirrorball report` runs `python3 -m mirrorball.report`.

It runs bench, converge, render and stress, and shows what their JSON says; that JSON is in the page.
"""
from __future__ import annotations

import argparse
import datetime
import os
import pathlib
import shlex
import signal
import statistics
import sys
import tempfile
from typing import Any, Optional

import numpy

from . import plots, sections, time_sections
from .errors import Error, OutputError
from .measures import WITH_BAD_ROWS
from .page import data_block, document, paragraph, text
from .picture import read_pfm
from .program import run_json, run_main
from .study import Figures, Json, Study, was_cold
from .stress_section import stress_section
from .texts import counted, size_text

SWEEP = {False: "none,grid:2,grid:4,sobol:4,sobol:16,sobol:64,sobol:256,adaptive:0.1,adaptive:0.03,"
                "edges:0.01,edges:0.001,edges:0.0001",
          True: "none,grid:2,grid:3,sobol:4"}  # by --quick
_REFERENCE_SAMPLES = {False: 1024, True: 32}
_SIGNALS = {signal.SIGINT: "interrupted (Ctrl-C)", signal.SIGTERM: "terminated",
            signal.SIGHUP: "the terminal has gone", signal.SIGUSR1: "asked to stop (SIGUSR1)",
            signal.SIGXCPU: "out of CPU time"}


class Stopped(BaseException):
    """A signal arrived."""

    def __init__(self, number: int) -> None:
        self.number = number


def _stop(number: int, _: Any) -> None:
    raise Stopped(number)


class Laboratory:
    """Runs the program in a folder of its own, with caches that start empty, and remembers what it ran."""

    def __init__(self, folder: pathlib.Path, quiet: bool) -> None:
        self.folder, self.quiet = folder, quiet
        self.commands: list[str] = []
        os.environ["XDG_CACHE_HOME"] = str(folder / "cache")
        os.environ.pop("POCL_CACHE_DIR", None)

    def say(self, what: str) -> None:
        if not self.quiet:
            print(f"mirrorball: {what}", file=sys.stderr, flush=True)

    def run(self, *words: str, remember: bool = True) -> Json:
        """The JSON a verb prints. Verdicts tell what is wrong or failed."""
        command = shlex.join(["mirrorball", *words]).replace(f"{self.folder}/", "")
        if remember and command not in self.commands:
            self.commands.append(command)
        is_quiet = words[0] == "render" or (self.quiet and words[0] in ("bench", "converge", "stress"))
        accepted = WITH_BAD_ROWS if words[0] in ("bench", "converge") else (0, 1)
        return run_json([*words, *(["-q"] if is_quiet else [])], accepted=accepted, echo=True)


def _study(lab: Laboratory, index: int, scene: str, arguments: argparse.Namespace) -> Study:
    """Measures one scene."""
    size = ["--size", arguments.size] if arguments.size else []
    shown = lab.run("render", scene, *size, "--crop", "0,0,1,1", "--device", "threads", "--stats=json",
                    remember=False)["settings"]
    width, height, aa = shown["width"], shown["height"], shown["aa"]
    aa = "grid:2" if aa == "none" else aa
    devices = ["--devices", arguments.devices, "--repeats", str(arguments.repeats)]

    lab.say(f"{scene}, step 1 of 3: timings")
    fifths = (2, 5) if arguments.quick else (1, 2, 3, 4, 5)
    sizes = ",".join(f"{max(1, width * part // 5)}x{max(1, height * part // 5)}" for part in fifths)
    bench = lab.run("bench", scene, "--sizes", sizes, "--aa", f"none,{aa}", "--precision", "float", *devices,
                    "--json")

    lab.say(f"{scene}, step 2 of 3: error against run time")
    size = ["--size", f"{width}x{height}"]
    kept = lab.folder / "converged.pfm"
    converge = lab.run("converge", scene, *size, "--aa", SWEEP[arguments.quick], "--reference-samples",
                       str(_REFERENCE_SAMPLES[arguments.quick]), "--reference", str(kept), *devices, "--json")
    reference = read_pfm(kept)

    lab.say(f"{scene}, step 3 of 3: pictures, and what leaving features out saves")
    device = next((row["device"] for row in bench["rows"] if row["figures"] and not row["threads"]), None)
    render = ["render", scene, *size, "--device", device or "threads", "--stats=json"]
    stats, pixels = {}, {}
    for kind, mode in (("plain", "none"), ("smooth", aa)):
        file = lab.folder / f"{kind}.pfm"
        stats[kind] = lab.run(*render, "--aa", mode, "--estimate", "-o", str(file))
        pixels[kind] = numpy.clip(read_pfm(file), 0, 1)
    for kind, one in stats.items():
        one["error"] = lab.run("compare", str(lab.folder / f"{kind}.pfm"), str(kept), "--clamp", "--json",
                               remember=False)["error"]
    kept.unlink()
    features = _features(lab, [*render, "--aa", aa], max(arguments.repeats, 9), bench) if device else None
    return Study(index, bench, converge, stats, pixels["plain"], pixels["smooth"], numpy.clip(reference, 0, 1),
                 features)


def _features(lab: Laboratory, render: list[str], rounds: int, bench: Json) -> Json:
    """The scene alternately with the kernels it needs and with everything compiled in; the first of each
    compiles them."""
    runs: dict[str, list[Json]] = {"auto": [], "all": []}
    cold: dict[str, Json] = {}
    for row in bench["rows"]:
        if row["warm_up"] and not row["threads"] and was_cold(row):
            cold.setdefault("auto_cold", row["warm_up"][0])
    for _ in range(rounds + 1):
        for kind, found in runs.items():
            found.append(lab.run(*render, "--features", kind, remember=kind == "all"))
    first = {kind: found.pop(0) for kind, found in runs.items()}
    builds = [run["seconds"]["build"] for run in runs["all"]]
    if first["all"]["seconds"]["build"] > 2 * statistics.median(builds):
        cold["all_cold"] = first["all"]
    return {**runs, **cold}


# The page

def _machine_and_date(machine: Json, date: str) -> str:
    return f"{machine['cpu']}, {counted(machine['cores'], 'core')}, {date}"


def _scene(study: Study, figures: Figures, alone: bool) -> str:
    stats, i = study.pictures["plain"], study.index
    scene, settings = stats["scene"], stats["settings"]
    held = [counted(scene[key], key[:-1]) for key in ("spheres", "cones", "triangles", "lights")]
    held += [name for name in ("mirrors", "glass") if name in scene["features_used"]]
    out = (f'<section id="scene-{i}" aria-labelledby="scene-{i}-head">\n'
           f'<h2 id="scene-{i}-head">{text(study.name)}</h2>\n'
           f'<p class="note">{text(scene["path"])}: {", ".join(held)}; '
           f'{size_text(settings["width"], settings["height"])} pixels, up to {settings["max_bounces"]} bounces; '
           f'scene hash <code>{text(scene["hash"])}</code></p>\n')
    if not alone:
        said = sections.verdict(study) or "No right picture"
        out += paragraph(f"{said}. {sections.verdict_details(study)}", "lead")
    return (out + sections.glance(study) + sections.pictures(study) + time_sections.times(study, figures)
            + time_sections.error_time(study, figures) + sections.features(study) + "</section>\n")


def page(studies: list[Study], stress: Optional[Json], stress_folder: pathlib.Path, commands: list[str],
         figures: Figures) -> str:
    """The page's HTML; its plots are kept in `figures`."""
    machine = studies[0].bench["environment"]
    load_after = studies[-1].pictures["smooth"]["environment"].get("load")
    date = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d %H:%M UTC")
    headline = sections.headline(studies)
    out = f"<header>\n<h1>{text(headline)}</h1>\n"
    if len(studies) == 1:
        out += paragraph(sections.verdict_details(studies[0]), "lead")
    out += paragraph(f"A mirrorball report, measured in one run on {_machine_and_date(machine, date)}.", "note")
    if machine["busy"]:
        out += paragraph(f"Busy machine (load {machine['load_before']:.1f} on {counted(machine['cores'], 'core')}, "
                         f"{machine['load_per_core']:.2f} per core): do not quote timings", "warning")
    links = [(f"scene-{study.index}", study.name) for study in studies]
    links += [("stability", "Numerical stability")] if stress else []
    links += [("machine", "Environment"), ("commands", "Reproduce"), ("data", "Raw data")]
    out += '<nav aria-label="Sections"><ul>\n' + "".join(
        f'<li><a href="#{name}">{text(title)}</a></li>\n' for name, title in links)
    out += "</ul></nav>\n</header>\n<main>\n"
    out += "".join(_scene(study, figures, len(studies) == 1) for study in studies)
    out += stress_section(stress, stress_folder, figures) if stress else ""
    out += sections.environment(machine, load_after, studies, date)
    out += ('<h2 id="commands">Reproduce</h2>\n' + paragraph("The first command makes this page; the others measure "
                                                             "its parts, with the same sizes and sampling.")
            + f'<pre tabindex="0"><code>{text(chr(10).join(commands))}\n</code></pre>\n'
            + _data(machine, studies, stress))
    out += (f"</main>\n<footer>Made by {text(machine['program'])}, {date}. This page loads nothing from elsewhere "
            "and runs no scripts.</footer>\n")
    return document(f"{headline} – mirrorball on {_machine_and_date(machine, date)}", out)


def _data(machine: Json, studies: list[Study], stress: Optional[Json]) -> str:
    blocks: dict[str, Any] = {"environment": machine}
    for study in studies:
        blocks.update({f"pictures-{study.index}": study.pictures, f"bench-{study.index}": study.bench,
                       f"converge-{study.index}": study.converge})
        if study.features:
            blocks[f"features-{study.index}"] = study.features
    if stress:
        blocks["stress"] = stress
    return ('<h2 id="data">Raw data</h2>\n'
            + paragraph("Every number above comes from the repeats kept in this page as JSON, in script elements of "
                        "type application/json. An element's data-source says which: bench-0#/rows/3 is row 3 of the "
                        "block bench-0.")
            + "".join(data_block(name, value) for name, value in blocks.items()))


def exit_code(studies: list[Study], stress: Optional[Json]) -> int:
    """1 if any picture is wrong, 5 if any could not be rendered."""
    verdicts = {row["verdict"] for study in studies for row in study.bench["rows"] + study.converge["points"]}
    if "wrong" in verdicts or (stress and not stress["passed"]):
        return 1
    return 5 if "failed" in verdicts else 0


def _write(path: pathlib.Path, content: bytes) -> None:
    """The whole file, or none; through a link, and with the mode of the file that it replaces."""
    try:
        target = pathlib.Path(os.path.realpath(path))
        mode = target.stat().st_mode & 0o7777 if target.exists() else 0o666 & ~_umask()
        with tempfile.NamedTemporaryFile("wb", dir=target.parent, prefix=".mirrorball-", delete=False) as file:
            try:
                file.write(content)
                file.flush()
                os.fchmod(file.fileno(), mode)
                os.replace(file.name, target)
            except BaseException:
                os.unlink(file.name)
                raise
    except OSError as error:
        raise OutputError(f"{path}: cannot write: {error.strerror}", 4) from error


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def make_report(arguments: argparse.Namespace) -> int:
    """Measures, then writes the page and its plots. Raises Error."""
    with tempfile.TemporaryDirectory(prefix="mirrorball-report-") as name:
        lab = Laboratory(pathlib.Path(name), arguments.quiet)
        lab.commands.append(_own_command(arguments))
        for scene in arguments.scenes:
            lab.run("scene", "info", scene, "--json", remember=False)  # refuses a scene before anything is measured
        if arguments.plots:
            _make_folder(arguments.plots)
        studies = [_study(lab, i, scene, arguments) for i, scene in enumerate(arguments.scenes)]
        stress, pictures = None, lab.folder / "stress"
        if arguments.stress:
            quick = ["--quick"] if arguments.quick else []
            stress = lab.run("stress", "--device", arguments.devices, *quick, "--json", "-", "-o", str(pictures))
        figures = Figures()
        html = page(studies, stress, pictures, lab.commands, figures).encode("utf-8", "replace")
        for plot in figures.plots if arguments.plots else []:
            for suffix in ("svg", "pdf", "png"):
                _write(arguments.plots / f"{plot.name}.{suffix}", plots.as_file(plot, suffix))
        _write(arguments.output, html)
        lab.say(f"{arguments.output}: {-(-len(html) // 1000)} kB")
        return exit_code(studies, stress)


def _make_folder(path: pathlib.Path) -> None:
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{path}: cannot make this folder: {error.strerror}", 4) from error
    if not os.access(path, os.W_OK):
        raise OutputError(f"{path}: cannot write into this folder; choose another", 4)


def _own_command(arguments: argparse.Namespace) -> str:
    words = ["mirrorball", "report", *arguments.scenes, "-o", str(arguments.output)]
    words += ["--size", arguments.size] if arguments.size else []
    words += ["--devices", arguments.devices, "--repeats", str(arguments.repeats)]
    words += [f"--{flag}" for flag in ("quick", "stress") if getattr(arguments, flag)]
    return shlex.join(words)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="mirrorball report",
                                     description="one page: pictures, timings, error against run time")
    parser.add_argument("scenes", nargs="+", metavar="SCENE")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, metavar="FILE", help="HTML file to write")
    parser.add_argument("--plots", type=pathlib.Path, metavar="DIR", help="also write each plot as SVG, PDF and PNG")
    parser.add_argument("--size", metavar="WxH|N", help="size of the largest picture (default: the scene's)")
    parser.add_argument("--devices", default="all", metavar="LIST", help="as for bench (default: all)")
    parser.add_argument("--repeats", type=int, default=5, metavar="N", help="timed rounds (default: 5)")
    parser.add_argument("--quick", action="store_true", help="fewer settings and a coarser reference: a preview")
    parser.add_argument("--stress", action="store_true", help="also run the stress suite")
    parser.add_argument("-q", "--quiet", action="store_true", help="print no progress")
    return parser


def main() -> int:
    for number in _SIGNALS:
        if signal.getsignal(number) != signal.SIG_IGN:  # as nohup ignores SIGHUP
            signal.signal(number, _stop)
    try:
        return make_report(_parser().parse_intermixed_args())
    except Stopped as stopped:
        print(f"mirrorball: {_SIGNALS[signal.Signals(stopped.number)]}; no page written", file=sys.stderr)
        return 128 + stopped.number
    except OutputError as error:
        print(f"mirrorball: {error}", file=sys.stderr)
        return error.exit_code
    except Error as error:  # what the program printed is on stderr already
        return error.exit_code if error.exit_code > 0 else 128 - error.exit_code
    except OSError as error:
        print(f"mirrorball: {error.filename or 'report'}: {error.strerror or error}", file=sys.stderr)
        return 4


if __name__ == "__main__":
    run_main(main)

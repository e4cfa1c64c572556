# SPDX-License-Identifier: Apache-2.0
"""The report's sections on time, and on error against run time, from the JSON of bench and converge."""
from __future__ import annotations

import math
import statistics
from typing import Any, Callable, Optional

from . import plots
from .page import Cell, Row, paragraph, table
from .plots import Axis, Bar, Curve, Point
from .study import Figures, Json, Study, settings_text, trace_seconds, was_cold
from .texts import (NBSP, duration, milliseconds, noise_percent, renderer_name, sampling_text, scientific, significant,
                    size_text)

_NOISY = 20  # percent: a slope through a noisier point says little
_PHASES = {"flatten": .5, "open": .25, "build": .7, "upload": .35, "trace": 1, "resolve": .5, "read_back": .35}


def _paper_table(study: Study, rows: list[Json]) -> str:
    """Like the paper's: sizes down, devices across."""
    heads = list(dict.fromkeys(renderer_name(row) for row in rows))
    lines: dict[int, dict[str, Json]] = {}
    for row in rows:
        lines.setdefault(row["width"] * row["height"], {})[renderer_name(row)] = row
    body = []
    for _, line in sorted(lines.items()):
        fastest = min((trace_seconds(row) for row in line.values() if row["figures"]), default=None)
        first = next(iter(line.values()))
        cells: list[Any] = [size_text(first["width"], first["height"])]
        for name in heads:
            one = line.get(name)
            right = one is not None and one["figures"]
            cells.append("" if one is None else
                         Cell(milliseconds(trace_seconds(one)) if right else one["verdict"], study.source(one),
                              strong=bool(right) and trace_seconds(one) == fastest))
        body.append(cells)
    return table(f"Ray trace, {sampling_text(rows[0]['aa'])}, {rows[0]['precision']}: milliseconds, medians; fastest "
                 "in bold", ["pixels", *heads], body)


def _all_settings(study: Study) -> str:
    rows: list[Row] = []
    for row in study.bench["rows"]:
        start = [Cell(size_text(row["width"], row["height"]), study.source(row)), row["aa"], row["precision"],
                 renderer_name(row)]
        figures = row["figures"]
        if not figures:
            rows.append([*start, f"{row['verdict']}: {row['why']}"])
            continue
        ratios = [significant(figures[key]) if figures[key] else "–" for key in ("trace_speed_up", "speed_up")]
        rows.append([*start, milliseconds(trace_seconds(row)), significant(noise_percent(figures["trace"]), 2),
                     milliseconds(figures["total"]["median"]), significant(figures["rays_per_second"] * 1e-6), *ratios,
                     scientific(row["repeats"][0]["error"]["rmse"])])
    about = f"{len(rows)} settings, with noise, rays per second, speed-up and error"
    return (paragraph(f"The table of all {about}, is left out on paper.", "on-paper")
            + f"<details><summary>All {about}</summary>\n"
            + table("All settings; total excludes starting the program, reading the scene and writing the picture; "
                    "speed-up is over one thread; RMSE is against double precision at the same samples",
                    ["pixels", "sampling", "precision", "device", "trace, ms", "noise, %", "total, ms", "Mrays/s",
                     "trace speed-up", "total speed-up", "RMSE"], rows) + "</details>\n")


def _phases_figure(study: Study, figures: Figures, name: str, title: str,
                   rows: list[tuple[str, Json, list[Json]]], caption: str) -> str:
    """A bar for each (label, row, runs): medians of the total and of each phase."""
    bars = []
    for label, row, runs in rows:
        medians = [(phase.replace("_", " "), statistics.median(run["seconds"][phase] for run in runs), opacity)
                   for phase, opacity in _PHASES.items()]
        total = statistics.median(sum(run["seconds"][phase] for phase in _PHASES) for run in runs)
        bars.append(Bar(label, duration(total), study.color(row), medians))
    return figures.put(plots.bars_plot(f"{name}-{study.index}", title, bars), caption, "plot wide")


def _phases(study: Study, figures: Figures) -> str:
    largest = study.largest()
    if not largest:
        return ""
    warm = [(renderer_name(row), row, row["repeats"]) for row in largest]
    cold = [(f"{renderer_name(row)}, {size_text(row['width'], row['height'])} pixels, {row['aa']}, {row['precision']}",
             row, row["warm_up"]) for row in study.bench["rows"]
            if row["warm_up"] and was_cold(row)]
    out = "<h3>Where the time goes</h3>\n" + _phases_figure(
        study, figures, "phases", "Time by phase", warm, f"{settings_text(largest[0])}, float; kernels from a cache. "
        "Medians of the total and of each phase, so the phases do not quite add up.")
    if cold:
        out += "<h4>The first picture</h4>\n" + _phases_figure(
            study, figures, "first", "Time of a first picture by phase", cold,
            "After installation, kernels are compiled once, then cached.")
    return out


def _size_curves(study: Study, value: Callable[[Json], Optional[tuple[float, tuple[float, float], str]]],
                 keeps: Callable[[Json], bool]) -> list[Curve]:
    """A curve over the sizes for OpenCL, the most threads, and one thread with and without vectors. `value` gives a
    row's height, its range and its words."""
    largest = study.largest()
    most = max((row["threads"] for row in largest), default=1)
    curves = []
    for like in largest:
        is_usual = like["threads"] in (0, most) if like["schedule"] != "scalar" else like["threads"] == 1
        if not (is_usual or (like["threads"] == 1 and like["schedule"] == "tiles")) or not keeps(like):
            continue
        points = []
        for row in study.bench["rows"]:
            same = all(row[key] == like[key] for key in ("aa", "precision", "device", "schedule"))
            measured = value(row) if same and row["figures"] else None
            if measured:
                y, between, words = measured
                points.append(Point(math.sqrt(row["width"] * row["height"]), y, y_range=between,
                                    source=study.source(row),
                                    title=f"{row['width']}×{row['height']} on {renderer_name(row)}: {words}"))
        style = {"buffers": 2, "scalar": 3}.get(like["schedule"], int(like["threads"] == 1))
        curves.append(Curve(renderer_name(like), study.color(like),
                            sorted(points, key=lambda p: p.x), style))
    return curves


def _sizes(study: Study, figures: Figures) -> str:
    def seconds(row: Json) -> tuple[float, tuple[float, float], str]:
        trace = row["figures"]["trace"]
        return (trace["median"], _around(trace),
                f"{duration(trace['median'])} ± {significant(noise_percent(trace), 2)}{NBSP}%")

    def ratio(row: Json) -> Optional[tuple[float, tuple[float, float], str]]:
        gain = row["figures"]["trace_speed_up"]
        return (gain, (gain, gain), f"{significant(gain)} times as fast as one thread") if gain else None

    rows = study.bench["rows"]
    ticks = [(math.sqrt(row["width"] * row["height"]), f"{row['width']}²" if row["width"] == row["height"]
              else f"{row['width']}×{row['height']}") for row in rows]
    pixels = Axis("pixels", ticks=ticks)
    times = _size_curves(study, seconds, lambda row: row["schedule"] != "buffers")
    if not times or len(times[0].points) < 2:
        return ""
    out = figures.put(plots.curves_plot(f"size-{study.index}", "Ray trace time against picture size",
                                        "Both axes logarithmic. The numbers are in the tables above.", pixels,
                                        Axis("ray trace time", "seconds"), times), "Bands: median absolute deviation.")
    gains = [c for c in _size_curves(study, ratio, lambda row: row["threads"] != 1) if c.points]
    if gains:
        gains.append(Curve("1 thread", plots.THREADS_COLOR, [Point(p.x, 1) for p in gains[0].points],
                           is_prediction=True))
        out += figures.put(plots.curves_plot(
            f"size-ratio-{study.index}", "Ray trace speed-up over one thread against picture size",
            "Sizes on a logarithmic axis. The numbers are in the table of all settings.", pixels,
            Axis("tracing: times as fast as one thread", "near", is_log=False), gains),
            "Tracing time of one thread over tracing time of the device.")
    return (f"<h3>Time against size</h3>\n{paragraph('In float, ' + sampling_text(study.largest()[0]['aa']) + '.')}"
            f'<div class="plots">\n{out}</div>\n')


def _around(spread: Json) -> tuple[float, float]:
    return max(spread["median"] - spread["mad"], spread["median"] / 10), spread["median"] + spread["mad"]


def _threads(study: Study, figures: Figures) -> str:
    """Measured speed-ups with those of Amdahl's law: a sentence each, and a plot from three counts on."""
    curves, said = [], ""
    for style, schedule in enumerate(("tiles", "buffers")):
        rows = [row for row in study.largest() if row["schedule"] == schedule and row["figures"]["amdahl"]]
        if len(rows) < 2:
            continue
        measured, predicted = [], []
        for row in sorted(rows, key=lambda row: int(row["threads"])):
            one, total = row["figures"], row["figures"]["total"]
            base, (low, high) = one["speed_up"] * total["median"], _around(total)
            measured.append(Point(row["threads"], one["speed_up"], y_range=(base / high, base / low),
                                  source=study.source(row),
                                  title=f"{renderer_name(row)}: {significant(one['speed_up'])} times as fast as one "
                                  f"thread; Amdahl: {significant(one['amdahl'])}"))
            predicted.append(Point(row["threads"], one["amdahl"]))
        name = "sample buffers" if schedule == "buffers" else "shared tiles"
        curves += [Curve(name, plots.THREADS_COLOR, measured, style),
                   Curve(f"Amdahl, {schedule}", plots.THREADS_COLOR, predicted, is_prediction=True)]
        said += paragraph(f"{measured[-1].x} threads {'with sample buffers ' if schedule == 'buffers' else ''}are "
                          f"{significant(measured[-1].y)} times as fast as one (Amdahl's law: "
                          f"{significant(predicted[-1].y)}), counting the total time.", source=measured[-1].source)
    if not curves:
        return ""
    if len(curves[0].points) > 2:
        said += figures.put(plots.curves_plot(
            f"threads-{study.index}", "Speed-up against threads, measured and predicted by Amdahl's law",
            "Linear axes. Amdahl's law takes the share of one thread's total time that is spent tracing as what "
            "threads can shorten.", Axis("threads", is_log=False),
            Axis("total: times as fast as one thread", is_log=False), curves),
            "Dotted: Amdahl's law from the measured share of tracing in one thread's total. Bands: median absolute "
            "deviation.")
    return "<h3>Threads</h3>\n" + said


def times(study: Study, figures: Figures) -> str:
    groups: dict[tuple[str, str], list[Json]] = {}
    for row in study.bench["rows"]:
        is_own_schedule = row["threads"] > 1 and row["aa"] != "none"  # of sample buffers
        if row["schedule"] != "scalar" and (row["schedule"] != "buffers" or is_own_schedule):
            groups.setdefault((row["aa"], row["precision"]), []).append(row)
    return ("<h3>Time</h3>\n"
            + paragraph(f"Medians of {study.bench['repeats']} repeats, interleaved so that a slow moment of the "
                        "machine affects every row equally; the first round is not counted. A wrong picture gets no "
                        "time. With sample buffers, the paper's schedule, each thread traces one sample of every pixel "
                        "at a time.")
            + "".join(_paper_table(study, rows) for rows in groups.values()) + _all_settings(study)
            + _phases(study, figures) + _sizes(study, figures) + _threads(study, figures))


# Error against run time

def _point_name(point: Json) -> str:
    return f"{_thread_free(point)}, {point['precision']}" + (", fast math" if point["math"] == "fast" else "")


def _thread_free(point: Json) -> str:
    """The device alone: converge has one kind of threads."""
    return "threads" if point["device_name"] == "threads" else renderer_name(point)


def _error_curves(study: Study) -> list[Curve]:
    """Color is the device, dash and marker the kind of sampling; double precision has hollow markers and,
    where there is float, no name."""
    result = study.converge
    has_float = any(point["precision"] == "float" for point in result["points"])
    families: list[str] = []
    curves = []
    for measured in result["curves"]:
        if measured["family"] not in families:
            families.append(measured["family"])
        first = result["points"][measured["points"][0]]
        is_double = measured["precision"] == "double"
        points = []
        for i in measured["points"]:
            one, seconds = result["points"][i], result["points"][i]["figures"]["seconds"]
            points.append(Point(seconds["median"], one["figures"]["rmse"], x_range=_around(seconds),
                                source=study.source(one), label=one["aa"] if i in result["pareto_front"] else "",
                                title=f"{one['aa']} on {_point_name(one)}: {duration(seconds['median'])} ± "
                                f"{significant(noise_percent(seconds), 2)}{NBSP}%, RMSE "
                                f"{scientific(one['figures']['rmse'])}"))
        points.sort(key=lambda point: point.x)
        build = next((one for one in result["builds"]
                      if all(one[key] == measured[key] for key in ("device", "precision", "math"))), None)
        if build and build["first_build"] > 0:
            points[0].with_build = points[0].x + build["open"] + build["first_build"]
        name = "" if is_double and has_float else f"{_thread_free(first)} {measured['family']}"
        curves.append(Curve(name, study.color(measured), points, families.index(measured["family"]),
                            is_double))
    return curves


def _slope(study: Study, curve: Json) -> Cell:
    """The slope with what the noise of its points' times may do to it; marked where a point is noisy."""
    spreads = [study.converge["points"][i]["figures"]["seconds"] for i in curve["points"]]
    u = [math.log(spread["median"]) for spread in spreads]
    noise = [spread["mad"] / spread["median"] for spread in spreads]
    mean = statistics.fmean(u)
    moved = math.sqrt(sum(((x - mean) * n) ** 2 for x, n in zip(u, noise))) / sum((x - mean) ** 2 for x in u)
    mark = " (noisy)" if max(noise) * 100 > _NOISY else ""
    return Cell(f"{curve['slope']:.2f} ± {abs(curve['slope']) * moved:.2f}{mark}")


def _slopes(study: Study) -> str:
    curves = [curve for curve in study.converge["curves"] if curve["slope"] is not None]
    families = list(dict.fromkeys(curve["family"] for curve in curves))
    lines: dict[str, dict[str, Cell]] = {}
    for curve in curves:
        name = _point_name({**study.converge["points"][curve["points"][0]]})
        lines.setdefault(name, {})[curve["family"]] = _slope(study, curve)
    if not lines:
        return ""
    marked = any("noisy" in cell.text for line in lines.values() for cell in line.values())
    return table("Slope of log RMSE over log time, ± what the noise of the times may change it by"
                 + (f"; noisy: through a point whose time is uncertain by over {_NOISY} %" if marked else ""),
                 ["device", *families],
                 [[name, *(line.get(family, Cell("")) for family in families)] for name, line in lines.items()])


def _targets(study: Study) -> str:
    result = study.converge
    targets = list(dict.fromkeys(entry["rmse"] for entry in result["seconds_to_rmse"]))
    lines: dict[str, list[Any]] = {}
    for entry in result["seconds_to_rmse"]:
        cell = Cell("below the floor" if entry["below_floor"] else "not reached")
        if entry["point"] is not None:
            point = result["points"][entry["point"]]
            cell = Cell(f"{duration(entry['seconds'])} ({point['aa']})", study.source(point))
        name = next((_thread_free(p) for p in result["points"] if p["device"] == entry["device"] and p["repeats"]),
                    entry["device_name"])
        lines.setdefault(name, []).append(cell)
    return table("Time to reach an error, with the fastest setting that reaches it",
                 ["device", *(f"RMSE {significant(target, 1)}" for target in targets)],
                 [[name, *cells] for name, cells in lines.items()])


def error_time(study: Study, figures: Figures) -> str:
    result = study.converge
    if not result["curves"]:
        return ""
    curves, reference = _error_curves(study), result["reference"]
    by_source = {point.source: point for curve in curves for point in curve.points}
    best = [result["points"][i] for i in result["pareto_front"]]
    front: list[Row] = [
        [Cell(point["aa"], study.source(point)), _point_name(point), milliseconds(point["figures"]["seconds"]["median"]),
         significant(noise_percent(point["figures"]["seconds"]), 2), scientific(point["figures"]["rmse"], 3)]
        for point in best]
    plot = plots.curves_plot(
        f"error-time-{study.index}", "Error against run time",
        f"Both axes logarithmic: {len(curves)} curves, each a device and precision with one kind of sampling, "
        "falling to the right. The numbers are in the tables below.", Axis("run time of a picture", "seconds"),
        Axis("RMSE against the converged picture", "power"), curves,
        front=[by_source[study.source(point)] for point in best],
        floor=(reference["floor"], "below the reference's own noise"), width=5.8)
    caption = (f"{size_text(result['width'], result['height'])} pixels, medians of {result['repeats']} repeats; "
               "bands: median absolute deviation; gray: the Pareto front. Hollow markers: double precision. A dotted "
               "whisker at a curve's first point leads to the time that includes opening the device and building its "
               "kernels, which is paid once; it ends at the frame if that time is beyond it. Run time: flatten, "
               "upload, trace, resolve, read back. Values clamped to 0 to 1.")
    return ("<h3>Error against run time</h3>\n"
            + paragraph(f"Two independent pictures in double precision ({' and '.join(reference['halves'])}) lie "
                        f"RMSE {scientific(reference['halves_rmse'])} apart; their mean, the reference, is known to "
                        f"about {scientific(reference['floor'])}: the shaded zone.",
                        source=f"converge-{study.index}#/reference")
            + figures.put(plot, caption, "plot wide")
            + table("Pareto front: no other setting is both faster and more accurate",
                    ["sampling", "device", "run time, ms", "noise, %", "RMSE"], front)
            + _targets(study) + _slopes(study))

# SPDX-License-Identifier: Apache-2.0
"""The report's verdict and its sections on pictures, features and the machine, from the JSON of bench and render.

Every number has its `data-source`: the place in the page's data that it was taken from.
"""
from __future__ import annotations

import math
from typing import Iterable, Optional

import matplotlib
import numpy

from .page import Cell, Row, attribute, image, paragraph, png_uri, table, text
from .picture import png_of
from .study import Json, Study, settings_text, spread_of, trace_seconds
from .texts import (NBSP, counted, duration, estimate_text, noise_percent, renderer_name, sampling_text, scientific,
                    short_name, significant, size_text)

_ERROR_SCALE = .25  # the difference at the top of the error maps' colors


# The verdict

def _fastest(*rows: Optional[Json]) -> Optional[Json]:
    return min(filter(None, rows), key=trace_seconds, default=None)


def _versus(study: Study) -> tuple[Optional[Json], Optional[Json]]:
    """The fastest OpenCL device's row of the largest picture, and that of the most threads."""
    rows = study.largest()
    most = max((row["threads"] for row in rows), default=0)

    def fastest(threads: int) -> Optional[Json]:
        return _fastest(*(row for row in rows if row["threads"] == threads))
    return fastest(0), fastest(most) if most else None


def _times(ratio: float) -> str:
    return f"{significant(ratio)} times as fast as"


def verdict(study: Study) -> str:
    """PoCL traces cornell-box in 22 ms: 1.2 times as fast as 2 threads. Empty if no row is right."""
    device, threads = _versus(study)
    best = _fastest(device, threads)
    if best is None:
        return ""
    said = (f"{renderer_name(best)} {'trace' if best['threads'] > 1 else 'traces'} {study.name} in "
            f"{duration(trace_seconds(best))}")
    if device and threads:
        other = threads if best is device else device
        ratio = trace_seconds(other) / trace_seconds(best)
        noise = math.hypot(*(noise_percent(row["figures"]["trace"]) for row in (device, threads))) / 100
        return f"{said}{', as fast as' if ratio - 1 <= noise else ': ' + _times(ratio)} {renderer_name(other)}"
    gain = best["figures"]["trace_speed_up"]
    return f"{said}: {_times(gain)} one thread" if gain and best["threads"] != 1 else said


def headline(studies: list[Study]) -> str:
    """The verdict of one scene; of several, what their devices have in common, then a ratio each."""
    if len(studies) == 1:
        return verdict(studies[0]) or f"No right picture of {studies[0].name}"
    parts: list[tuple[str, str, str]] = []
    for study in studies:
        device, threads = _versus(study)
        if not (device and threads):
            return "; ".join(verdict(one) or f"no right picture of {one.name}" for one in studies)
        ratio = significant(trace_seconds(threads) / trace_seconds(device))
        parts.append((renderer_name(device), renderer_name(threads),
                      f"{ratio} {'on' if parts else 'times as fast on'} {study.name}"))
    if len({part[:2] for part in parts}) > 1:
        return "; ".join(map(verdict, studies))
    return f"{parts[0][0]} against {parts[0][1]}: " + ", ".join(part[2] for part in parts)


def verdict_details(study: Study) -> str:
    rows, points = study.bench["rows"], study.converge["points"]
    failed = {kind: sum(row["verdict"] == kind for row in rows + points) for kind in ("wrong", "failed")}
    rounding = max((row["repeats"][0]["error"]["rmse"] for row in rows
                    if row["figures"] and row["precision"] == "float"), default=0)
    right = (f"All {len(rows)} combinations of device, size and sampling gave the right picture; float is within "
             f"RMSE {scientific(rounding)} of double.")
    if any(failed.values()):
        right = (f"Of {len(rows) + len(points)} combinations, {failed['wrong']} gave a wrong picture and "
                 f"{failed['failed']} failed.")
    best = _fastest(*_versus(study))
    if best is None:
        return right
    figures = best["figures"]
    total = f"{duration(figures['total']['median'])} in total"
    if figures["speed_up"] and best["threads"] != 1:
        total += f" (one thread: {duration(figures['speed_up'] * figures['total']['median'])})"
    return f"{settings_text(best)}, float. {total}. {right}"


def glance(study: Study) -> str:
    best = _fastest(*study.largest())
    if best is None:
        return ""
    figures, source, on = best["figures"], study.source(best), f"on {renderer_name(best)}"
    tiles = [("Fastest ray trace", duration(trace_seconds(best)),
              f"± {significant(noise_percent(figures['trace']), 2)}{NBSP}%, {on}, "
              f"{size_text(best['width'], best['height'])}, {best['aa']}", source),
             ("Rays per second", significant(figures["rays_per_second"] * 1e-6) + NBSP + "M",
              f"{on}, all kinds of ray", source)]
    if figures["speed_up"]:
        tiles.append(("Speed-up over one thread", significant(figures["trace_speed_up"]) + " times",
                      f"tracing, {on}; {significant(figures['speed_up'])} times in total, with set-up", source))
    tiles.append(("Rounding error (RMSE)", scientific(best["repeats"][0]["error"]["rmse"]),
                  "float against double, same samples", source))
    plain, smooth = (study.pictures[kind]["error"]["rmse"] for kind in ("plain", "smooth"))
    tiles.append(("Sampling error (RMSE)", scientific(smooth),
                  f"{study.pictures['smooth']['settings']['aa']}; plain: {scientific(plain)}",
                  f"pictures-{study.index}#/smooth/error"))
    return '<dl class="glance">\n' + "".join(
        f"<div><dt>{text(term)}</dt><dd{attribute('data-source', source)}>{text(value)}<small>{text(more)}</small>"
        "</dd></div>\n"
        for term, value, more, source in tiles) + "</dl>\n"


# Pictures

def _telling_window(plain: numpy.ndarray, smooth: numpy.ndarray) -> tuple[int, int, int]:
    """The square (x, y, side), a fifth of the width, where anti-aliasing changes the picture most."""
    height, width, _ = plain.shape
    side = min(max(16, width // 5), width, height)
    change = numpy.abs(plain - smooth).sum(axis=2)
    step = max(1, side // 4)
    places = [(x, y) for y in range(0, height - side + 1, step) for x in range(0, width - side + 1, step)]
    x, y = max(places, key=lambda at: float(change[at[1]:at[1] + side, at[0]:at[0] + side].sum()))
    return x, y, side


def _heat(share: numpy.ndarray) -> numpy.ndarray:
    return numpy.asarray(matplotlib.colormaps["magma"](numpy.clip(share, 0, 1)))[..., :3]


def pictures(study: Study) -> str:
    names = {"plain": "Plain", "smooth": "Anti-aliased"}
    pixels = {"plain": study.plain, "smooth": study.smooth}
    x, y, side = window = _telling_window(study.plain, study.smooth)
    out, crops, maps = "", "", ""
    for kind, name in names.items():
        stats, source = study.pictures[kind], f"pictures-{study.index}#/{kind}"
        settings, error = stats["settings"], stats["error"]
        timed = next((row for row in study.bench["rows"] if row["figures"] and row["aa"] == settings["aa"]
                      and row["repeats"][0]["device"] == stats["device"]
                      and (row["width"], row["height"]) == (settings["width"], settings["height"])), None)
        on = renderer_name({"device_name": stats["device"]["name"], "repeats": [stats]})
        made = f"traced in {duration(trace_seconds(timed))} on {on}" if timed else f"on {on}"
        out += image(pixels[kind], f"{study.name}, {name}", f"{name}: {sampling_text(settings['aa'])}, {made}, "
                     f"{settings['precision']}.", source, window)
        about = stats.get("estimate")
        guess = f" (estimated without the reference: {estimate_text(about)})" if about else ""
        wrong = (f"RMSE {scientific(error['rmse'])}{guess}, PSNR {significant(error['psnr_db'] or math.inf)}{NBSP}dB, "
                 f"{error['pixels_over_1_255']} of {settings['width'] * settings['height']} pixels off by more than "
                 f"1/255, {error['pixels_over_8_255']} by more than 8/255")
        difference = numpy.abs(pixels[kind] - study.reference).max(axis=2)
        maps += image(_heat(difference / _ERROR_SCALE), f"Error map of the picture: bright along edges where it is "
                      f"wrong. {wrong}", f"{name}: {wrong}.", source + "/error")
    for name, whole in (*((name, pixels[kind]) for kind, name in names.items()), ("Converged", study.reference)):
        crops += image(whole[y:y + side, x:x + side], f"{name} crop of {study.name}",
                       f"{name}: {size_text(side, side)} pixels from {x},{y}, enlarged.")
    halves = " and ".join(study.converge["reference"]["halves"])
    scale = png_uri(png_of(_heat(numpy.linspace(0, 1, 128))[None]))
    return ("<h3>Pictures</h3>\n<div class=\"pictures\">\n" + out + "</div>\n<h3>Edges, close up</h3>\n"
            + paragraph("The part of the picture that anti-aliasing changes most: the frame in the pictures above.")
            + f'<div class="pictures three pixels">\n{crops}</div>\n<h3>Error maps</h3>\n'
            + paragraph("The largest channel difference of each pixel from the converged picture: the mean of two "
                        f"pictures in double precision, {halves}.")
            + f'<div class="pictures">\n{maps}</div>\n<p class="scale">0 <img src="{scale}" alt="Color scale of the '
            f'error maps: black for no difference over purple and orange to pale yellow for {_ERROR_SCALE} and more"> '
            f"{_ERROR_SCALE} or more, where black to white is 1</p>\n")


# Features

def _in_scene(stats: Json, feature: str) -> str:
    scene = stats["scene"]
    counts = {"spheres": "spheres", "cones": "cones", "triangles": "triangles", "vertex normals": "smooth_triangles",
              "lights": "lights"}
    if feature in counts:
        return str(scene[counts[feature]] or "none")
    if feature not in scene["features_used"]:
        return "none"
    if feature == "hierarchy":
        return ", ".join(f"over {one['over']}" for one in scene["hierarchies"])
    return f"up to {stats['settings']['max_bounces']} bounces" if feature in ("mirrors", "glass") else ""


def _trial(study: Study) -> str:
    trial, source = study.features, f"features-{study.index}#"
    if trial is None:
        return paragraph("Without an OpenCL device nothing is compiled.")
    first = trial["auto"][0]
    build = {kind: spread_of([run["seconds"]["build"] for run in trial[kind]])["median"] for kind in ("auto", "all")}
    cold = {kind: duration(trial[kind + "_cold"]["seconds"]["build"]) if trial.get(kind + "_cold") else "not measured"
            for kind in ("auto", "all")}
    rows: list[Row] = [[Cell(name, f"{source}/{kind}"), duration(build[kind]), cold[kind]]
            for kind, name in (("auto", "what the scene needs"), ("all", "everything"))]
    lean, full = (spread_of([run["seconds"]["trace"] for run in trial[kind]]) for kind in ("auto", "all"))
    ratio = full["median"] / lean["median"]
    noise = ratio * math.hypot(noise_percent(lean), noise_percent(full)) / 100
    same = first["image"]["hash"] == trial["all"][0]["image"]["hash"]
    settings = first["settings"]
    return (table(f"On {short_name(first['device']['name'])}, "
                  f"{size_text(settings['width'], settings['height'])} pixels, {settings['aa']}: medians of "
                  f"{len(trial['auto'])} interleaved repeats",
                  ["kernels compiled with", "build, from cache", "build, cold"], rows)
            + paragraph(f"Compiled with everything, tracing takes {significant(ratio)} ± {significant(noise, 2)} "
                        f"times as long{'' if abs(ratio - 1) > noise else ': no difference beyond the noise'}. The "
                        f"pictures are {'the same, bit for bit' if same else 'NOT the same'}.", source=source))


def features(study: Study) -> str:
    stats = study.pictures["plain"]
    used, left_out = stats["scene"]["features_used"], stats["scene"]["features_left_out"]
    rows = [[feature, "used" if feature in used else "left out", _in_scene(stats, feature)]
            for feature in [*used, *left_out]]
    left = f"Left out: {', '.join(left_out)}." if left_out else (
        "This scene needs everything, so there is nothing to leave out: both rows below use the same kernels, and "
        "their difference is noise.")
    return ("<h3>What leaving features out saves</h3>\n"
            + table("Features of the kernels", ["feature", "compiled", "in the scene"], rows)
            + paragraph(f"The flattened scene is {stats['scene']['flat_bytes']} bytes in "
                        f"{stats['settings']['precision']}. A feature left out is not compiled, and its array is not "
                        "allocated: it is a null argument of the kernel.")
            + paragraph(left) + _trial(study))


# The machine

def environment(machine: Json, load_after: Optional[float], studies: Iterable[Study], date: str) -> str:
    names = {"git_revision": "git revision", "cpu": "processor", "cores": "cores used", "memory_bytes": "memory",
             "os": "operating system", "load_before": "load before"}
    rows: list[Row] = []
    for key, value in machine.items():
        if key in ("load", "load_per_core", "busy"):
            continue
        said = "unknown" if value is None else str(value)
        if key == "memory_bytes" and value:
            said = f"{significant(value / 2**30)}{NBSP}GiB"
        elif isinstance(value, float):
            said = significant(value, 2)
        rows.append([names.get(key, key), Cell(said, f"environment#/{key}")])
    rows.append(["load afterwards", "unknown" if load_after is None else significant(load_after, 2)])
    devices = [run["repeats"][0]["device"] for study in studies for run in study.bench["rows"]
               if run["repeats"] and not run["threads"]]
    lines = [f"{short_name(device['name'])}: {device['name']}, {device['platform']}, driver "
             f"{device['driver']}, per {device['launch']}, {counted(device['lanes'], 'lane')}" for device in devices]
    rows += [["OpenCL device", line] for line in dict.fromkeys(lines)]
    rows.append(["created", date])
    return ('<h2 id="machine">Environment</h2>\n<div class="facts">'
            + table("The machine and the program behind every number", ["what", "value"], rows) + "</div>\n")

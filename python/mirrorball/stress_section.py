# SPDX-License-Identifier: Apache-2.0
"""The report's section on numerical stability, from the JSON and the pictures of `mirrorball stress`."""
from __future__ import annotations

import math
import pathlib
import re
from typing import Optional

from . import plots
from .page import Cell, Row, image, paragraph, table, text
from .plots import Axis, Curve, Point
from .study import Figures, Json
from .texts import milliseconds, scientific, significant

#: Families whose parameter is a number that spans decades.
_PLOTTED = ("scale-2", "shift-odd", "sphere-size", "cone-size", "cone-needle", "flat-cone", "long-cone",
            "huge-ball-floor", "facing-mirrors", "glass-depth", "light-pipe", "shininess", "highlight",
            "field-of-view", "needles", "huge-triangle")
_LEAST_ERROR = 1e-9  # drawn: a picture's values are floats
_MOST_PICTURES, _MOST_PIXELS = 4, 160 * 120


def _figures(row: Json) -> Json:
    """What a row was judged by: its rays, or its picture; {} if it was not."""
    return {} if row["verdict"] == "not judged" else row.get("rays") or row["picture"]


def _worst(family: Json, key: str) -> float:
    """The largest figure of a family. An error that JSON has no number for is infinite."""
    values = [_figures(row).get(key, 0) for case in family["cases"] for row in case["rows"]]
    return max((math.inf if value is None else value for value in values), default=0)


def used_tolerance(family: Json) -> Optional[float]:
    """The largest ratio of error to allowed error; None where no number is compared."""
    shares = [(math.inf if error is None else error) / case["bar"]["max_error"]
              for case in family["cases"] if case["bar"]["max_error"] > 0
              for row in case["rows"]
              for error in [_figures(row).get("max_error", -1)] if error != -1]
    return max(shares, default=None)


def by_margin(families: list[Json]) -> list[int]:
    """Indices of the families: failed ones first, then by decreasing used tolerance."""
    def rank(i: int) -> tuple[bool, float]:
        used = used_tolerance(families[i])
        return families[i]["passed"], 1 if used is None else -used
    return sorted(range(len(families)), key=rank)


def _verdict(result: Json, order: list[int]) -> str:
    """PASS: 59 of 59 families; needles comes closest to its tolerance, at 43 % of it."""
    families = result["families"]
    said = (f"{'PASS' if result['passed'] else 'FAIL'}: {sum(family['passed'] for family in families)} of "
            f"{len(families)} families")
    closest = families[order[0]]
    used = used_tolerance(closest)
    if used is None or not closest["passed"]:
        return said + "."
    return f"{said}; {closest['name']} comes closest to its tolerance, at {significant(100 * used, 2)} % of it."


def _allowed(family: Json) -> str:
    """The largest error allowed, and how many wrong pixels if there may be any."""
    bars = [case["bar"] for case in family["cases"]]
    said = scientific(max(bar["max_error"] for bar in bars), 1)
    wrong = [bar["wrong"] for bar in bars]
    return said if not any(wrong) and None not in wrong else \
        f"{'any' if None in wrong else max(wrong)} wrong, {said}"


def _table(families: list[Json], order: list[int]) -> str:
    rows: list[Row] = []
    for i in order:
        family, used = families[i], used_tolerance(families[i])
        share = 1 + math.log10(used) / 6 if used else 0
        margin = Cell("–") if used is None else Cell(significant(100 * used, 2) + " %", share=share)
        seconds = sum(row["seconds"] for case in family["cases"] for row in case["rows"]
                      if (row["device"], row["precision"]) == ("threads", "float"))
        rows.append([Cell(family["name"], f"stress#/families/{i}"),
                     Cell("pass" if family["passed"] else "fail", strong=not family["passed"]), margin,
                     scientific(_worst(family, "max_error")), _allowed(family),
                     str(int(max(_worst(family, "wrong"), _worst(family, "failures")))),
                     milliseconds(seconds) if seconds else "", family["why"]])
    return '<div class="dense">' + table(
        "Families by how much of their tolerance they use (bars: six decades, full at 100 %). Worst of every "
        "family's cases and renderers, float and double; times on threads, in float",
        ["family", "verdict", "tolerance used", "error", "tolerance", "wrong", "ms", "typical failure"],
        rows) + "</div>\n"


def _plot(family: Json, index: int) -> plots.Plot:
    """Largest error against the parameter, on one device: in strict arithmetic all give the same."""
    curves = []
    first = family["cases"][0]["rows"]
    for k, like in enumerate(first):
        if like["device"] != first[0]["device"]:
            continue
        points = []
        for i, case in enumerate(family["cases"]):
            if case["value"] > 0 and k < len(case["rows"]):
                row = case["rows"][k]
                error = (row.get("rays") or row["picture"])["max_error"]
                error = min(1.0, 1.0 if error is None else error)
                points.append(Point(case["value"], max(_LEAST_ERROR, error), f"{row['renderer']} at {case['label']}: "
                                    f"{scientific(error)}", f"stress#/families/{index}/cases/{i}/rows/{k}"))
        style = int(like["precision"] == "double")
        curves.append(Curve(like["precision"], plots.NO_DEVICE_COLOR, sorted(points, key=lambda p: p.x), style))
    return plots.curves_plot(
        f"stress-{family['name']}", f"Largest error against the {family['parameter']}: {family['name']}",
        "Both axes logarithmic; away from edges, values clamped to 0 to 1; NaN counts as 1.",
        Axis(family["parameter"], "power"), Axis("largest error", "power"),
        [curve for curve in curves if curve.points], floor=(1e-4, "below the usual tolerance, 10⁻⁴"),
        heights=(_LEAST_ERROR, 1.0))


def _pictures(families: list[Json], order: list[int], folder: pathlib.Path) -> str:
    """Reference, worst picture and error map of the families with the smallest margins."""
    out, shown = "", 0
    for family in (families[i] for i in order):
        def badness(case: Json) -> tuple[int, int, float]:
            parts = [row["picture"] for row in case["rows"] if "picture" in row]
            return max(((part["wrong"] + part["nan"], part["wrong_at_edges"], part["max_error"] or 0)
                        for part in parts), default=(-1, 0, 0))
        worst = max(family["cases"], key=badness)
        stem = re.sub("[/^ ]", "-", f"{family['name']}-{worst['label']}")
        files = [folder / f"{stem}.{kind}.png" for kind in ("reference", "worst", "error")]
        if shown == _MOST_PICTURES or not all(file.exists() for file in files):
            continue
        shots = [file.read_bytes() for file in files]
        if int.from_bytes(shots[0][16:20], "big") * int.from_bytes(shots[0][20:24], "big") > _MOST_PIXELS:
            continue
        shown += 1
        name = f"{family['name']}/{worst['label']}"
        captions = ("Reference.", "Worst of mirrorball's.", "Difference, 1/255 and more at the top of the color map.")
        out += f"<h4>{text(name)}</h4>\n<div class=\"pictures three pixels\">\n" + "".join(
            image(shot, f"{name}, {kind}", caption)
            for shot, kind, caption in zip(shots, ("reference", "worst of mirrorball's pictures", "error map"),
                                           captions)) + "</div>\n"
    if not out:
        return ""
    return "<h3>Worst pictures</h3>\n" + paragraph(
        "From the families with the smallest margin to their tolerance.") + out


def stress_section(result: Json, folder: pathlib.Path, figures: Figures) -> str:
    families = result["families"]
    if not families:
        return ""
    order = by_margin(families)
    drawn = "".join(
        figures.put(_plot(families[i], i), f"{families[i]['name']}: {families[i]['why']}")
        for i in order if families[i]["name"] in _PLOTTED and len(families[i]["cases"]) > 1)
    return ('<section aria-labelledby="stability">\n<h2 id="stability">Numerical stability</h2>\n'
            + paragraph(_verdict(result, order), "lead")
            + paragraph("Numerically hard and extreme scenes against a reference in 113-bit arithmetic. A pixel is "
                        "wrong when a channel is off by over 1/255 where the reference itself does not change within "
                        "0.02 pixel; the error is the largest there.")
            + _table(families, order)
            + (f'<h3>Error against each family\'s parameter</h3>\n<div class="plots">\n{drawn}</div>\n' if drawn else "")
            + _pictures(families, order, folder) + "</section>\n")

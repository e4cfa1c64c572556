# SPDX-License-Identifier: Apache-2.0
"""Charts by matplotlib: inline SVG for a page that has THEME's colors as CSS variables, and files.

One plot is one function call that returns a Figure; `inline_svg` and `as_file` write it.
"""
from __future__ import annotations

import dataclasses
import html
import io
import math
import re
from typing import Any, Callable, Iterable, Optional, Sequence

import matplotlib
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.ticker import FixedFormatter, FixedLocator, FuncFormatter, LogLocator, MaxNLocator, NullLocator

from .texts import duration, power_of_ten, significant

#: A color by its name in the light and in the dark page. The curves' (s0 ..) are after Okabe and Ito (2008),
#: distinct to the color-blind, with a contrast of 3 to 1 or more.
THEME = {
    "paper": ("#ffffff", "#14171b"), "ink": ("#1b1f24", "#e7eaee"), "soft": ("#57606a", "#a3adb8"),
    "grid": ("#e3e7eb", "#2b3139"), "floor": ("#e9ebed", "#23282e"), "front": ("#cfd3d8", "#4a525c"),
    "s0": ("#0068a8", "#5fb8f5"), "s1": ("#c04f00", "#ff9a55"), "s2": ("#00805d", "#3ecb9d"),
    "s3": ("#a8407f", "#f29ac7"), "s4": ("#746400", "#e4d150"), "s5": ("#5b4bb5", "#ab9eff"),
    "s6": ("#333334", "#e8e8e8")}
THREADS_COLOR, NO_DEVICE_COLOR = "s0", "s6"
MARKERS, DASHES = "osD^vPX", [(), (5, 2), (1.5, 1.5), (7, 2, 1.5, 2)]
SIZE = 8  # points, of every text; the page draws an inch as 72 to 110 pixels
LINE = 11.5  # points between neighboring lines of text
matplotlib.rcParams.update({"font.size": SIZE, "axes.labelsize": SIZE, "xtick.labelsize": SIZE, "pdf.fonttype": 42,
                            "ytick.labelsize": SIZE, "font.family": "sans-serif", "svg.fonttype": "none"})


def color(name: str) -> str:
    return THEME[name][0]


@dataclasses.dataclass
class Point:
    """A measured point; its title is shown under the pointer, its source is where its numbers lie."""
    x: float
    y: float
    title: str = ""
    source: str = ""
    label: str = ""
    x_range: Optional[tuple[float, float]] = None
    y_range: Optional[tuple[float, float]] = None
    with_build: Optional[float] = None  # x with the kernels built


@dataclasses.dataclass
class Curve:
    """Points joined by a line. `style` is a marker with its dash; predictions have no markers."""
    label: str
    color: str
    points: list[Point]
    style: int = 0
    is_hollow: bool = False
    is_prediction: bool = False


@dataclasses.dataclass
class Plot:
    """A figure, and what its page says about it; `points` are those of each group of markers, by its id."""
    name: str
    title: str
    description: str
    figure: Figure
    points: dict[str, list[Point]]


@dataclasses.dataclass
class Axis:
    label: str
    unit: str = "plain"  # plain, seconds or power
    is_log: bool = True
    ticks: Sequence[tuple[float, str]] = ()


def _tick_text(unit: str) -> Callable[[float, int], str]:
    def text(value: float, _: int) -> str:
        if unit == "seconds":
            return duration(value, 1)
        exponent = math.floor(math.log10(value) + 1e-9) if value > 0 else 0
        step = round(value / 10.0 ** exponent)
        if unit == "power" and value > 0:
            return ("" if step == 1 else f"{step}·") + power_of_ten(exponent)
        return significant(value, 1) if value >= 1e4 else f"{value:g}"
    return text


def _set_axis(axes: Any, which: str, axis: Axis, values: list[float]) -> None:
    """Scale, limits around the values, and ticks of axis x or y."""
    of = getattr(axes, which + "axis")
    usable = [v for v in values if math.isfinite(v) and (v > 0 or not axis.is_log)] or [1.0, 10.0]
    low, high = min(usable), max(usable)
    if axis.is_log:
        getattr(axes, f"set_{which}scale")("log")
        air = max(1.25, (high / low) ** 0.06)
        low, high = low / air, high * air
        subs = (1, 2, 5) if high / low < 300 else (1,)
        of.set_major_locator(LogLocator(subs=subs, numticks=9))
    else:
        span = max(high - low, 1e-9 + abs(high) * .01)
        low, high = low - .06 * span if low < 0 or axis.unit == "near" else 0, high + .06 * span
    if axis.ticks:
        # Those that would touch their neighbors give way, the largest last.
        room = axes.bbox.width * 72 / axes.figure.dpi / (1.3 * max(_text_width(name) for _, name in axis.ticks))
        width = (math.log(high / low) if axis.is_log else high - low) / room
        place = math.log if axis.is_log else float
        shown: list[tuple[float, str]] = []
        for value, name in sorted(dict(axis.ticks).items(), reverse=True):
            if not shown or place(shown[-1][0]) - place(value) >= width:
                shown.append((value, name))
        of.set_major_locator(FixedLocator([value for value, _ in shown]))
        of.set_major_formatter(FixedFormatter([name for _, name in shown]))
    else:
        of.set_major_formatter(FuncFormatter(_tick_text(axis.unit)))
    of.set_minor_locator(NullLocator())
    getattr(axes, f"set_{which}lim")(low, high)


def _new_figure(width: float, height: float, title: str) -> tuple[Figure, Any]:
    figure = Figure(figsize=(width, height))
    axes = figure.subplots()
    figure.patch.set_alpha(0)
    _clean(axes, title)
    return figure, axes


def _clean(axes: Any, title: str) -> None:
    axes.set_facecolor("none")
    axes.set_title(title, loc="left", color=color("ink"), fontsize=SIZE, fontweight="bold", pad=8)
    for side in axes.spines.values():
        side.set_visible(False)
    axes.tick_params(colors=color("soft"), length=0)


def spread(places: Sequence[float], gap: float, low: float, high: float) -> list[float]:
    """Each place, moved as little as needed to lie at least `gap` from its neighbors and, if there is
    room, within low .. high."""
    order = sorted(range(len(places)), key=lambda i: places[i])
    groups: list[tuple[float, int]] = []  # center of a group of neighbors, how many
    for i in order:
        groups.append((min(max(places[i], low), high), 1))
        while len(groups) > 1 and groups[-1][0] - groups[-2][0] < gap * (groups[-1][1] + groups[-2][1]) / 2:
            (a, n), (b, m) = groups[-2:]
            half = gap * (n + m - 1) / 2
            center = min(max((a * n + b * m) / (n + m), low + half), max(high - half, low + half))
            groups[-2:] = [(center, n + m)]
    spaced = [center + gap * (k - (count - 1) / 2) for center, count in groups for k in range(count)]
    moved = [0.0] * len(places)
    for i, place in zip(order, spaced):
        moved[i] = place
    return moved


def _text_width(text: str) -> float:
    """In points, about: browsers' fonts differ."""
    return .64 * SIZE * len(text)


def end_labels(axes: Any, labels: Sequence[tuple[float, float, str, str]]) -> None:
    """Names (x, y, text, color) of curves in a column right of the axes, each tied to its curve's end."""
    box = axes.get_position()
    height = axes.figure.get_figheight() * 72 * box.height
    to_axes = axes.transData + axes.transAxes.inverted()
    ends = [to_axes.transform((x, y))[1] for x, y, _, _ in labels]
    for (x, y, text, ink), place in zip(labels, spread(ends, LINE / height, 0, 1)):
        axes.annotate(text, (x, y), (1.04, place), textcoords="axes fraction", va="center", color=ink,
                      fontweight="bold", annotation_clip=False,
                      arrowprops={"arrowstyle": "-", "color": ink, "alpha": .45, "linewidth": .7,
                                  "shrinkA": 1, "shrinkB": 3, "relpos": (0, .5)})


_SIDES = [(5, 4, "left"), (-5, 4, "right"), (5, -11, "left"), (-5, -11, "right"), (0, 8, "center"),
          (0, -15, "center")]


def point_labels(axes: Any, curves: Iterable[Curve]) -> None:
    """The labels of points, where they touch neither a marker nor a label; else none."""
    points = [point for curve in curves for point in curve.points]
    scale = 72 / axes.figure.dpi
    spots = [axes.transData.transform((p.x, p.y)) * scale for p in points]
    left, bottom, right, top = (value * scale for value in axes.bbox.extents)
    taken = [(x - 3, y - 3, x + 3, y + 3) for x, y in spots]
    named: list[tuple[str, float, float]] = []
    for point, (x, y) in zip(points, spots):
        if not point.label or any(point.label == name and math.hypot(x - a, y - b) < 45 for name, a, b in named):
            continue
        width = _text_width(point.label)
        for dx, dy, anchor in _SIDES:
            start = x + dx - {"left": 0, "center": width / 2, "right": width}[anchor]
            place = (start, y + dy - 1, start + width, y + dy + SIZE)
            free = all(place[2] < b[0] or b[2] < place[0] or place[3] < b[1] or b[3] < place[1] for b in taken)
            if free and left <= place[0] and place[2] <= right and bottom <= place[1] and place[3] <= top:
                axes.annotate(point.label, (point.x, point.y), (dx, dy), textcoords="offset points",
                              ha=anchor, va="baseline", color=color("ink"))
                taken.append(place)
                named.append((point.label, x, y))
                break


def _draw_curve(axes: Any, curve: Curve, gid: str) -> None:
    ink = color(curve.color)
    x, y = [p.x for p in curve.points], [p.y for p in curve.points]
    if curve.is_prediction:
        axes.plot(x, y, color=ink, linewidth=1, dashes=(1, 2))
        return
    if not curve.is_hollow:
        low = [((p.x_range or (p.x,))[0], (p.y_range or (p.y,))[0]) for p in curve.points]
        high = [((p.x_range or (p.x,))[-1], (p.y_range or (p.y,))[-1]) for p in curve.points]
        axes.fill(*zip(*low, *reversed(high)), color=ink, alpha=.16, linewidth=.6)
    axes.plot(x, y, color=ink, linewidth=.8 if curve.is_hollow else 1.5,
              dashes=DASHES[curve.style % len(DASHES)] or (None, None))
    axes.plot(x, y, MARKERS[curve.style % len(MARKERS)], color=ink, markersize=5, gid=gid, clip_on=False, zorder=3,
              markerfacecolor=color("paper") if curve.is_hollow else ink, markeredgewidth=.9,
              markeredgecolor=ink if curve.is_hollow else color("paper"))
    first = curve.points[0]
    if first.with_build:
        axes.plot([first.x, first.with_build], [first.y, first.y], color=ink, linewidth=.9, dashes=(1, 2))


def curves_plot(name: str, title: str, description: str, x: Axis, y: Axis, curves: list[Curve], *,
                front: Sequence[Point] = (), floor: Optional[tuple[float, str]] = None, heights: Sequence[float] = (),
                width: float = 5) -> Plot:
    """Curves with the names at their ends. front: a Pareto front; floor: y below which
    nothing is known; heights: which the y axis has at least."""
    figure, axes = _new_figure(width, .7 * width, y.label)
    points = [point for curve in curves for point in curve.points]
    names = [curve.label for curve in curves if curve.label]
    right = max((1.15 * _text_width(text) + 14 for text in names), default=12)  # bold
    figure.subplots_adjust(left=.12, bottom=.15, top=.89, right=1 - right / (width * 72))
    _set_axis(axes, "x", x, [v for p in points for v in (p.x_range or (p.x,))])
    _set_axis(axes, "y", y, [v for p in points for v in (p.y_range or (p.y,))]
              + [*heights, *([floor[0]] if floor else [])])
    axes.set_xlabel(x.label, color=color("ink"))
    axes.grid(True, color=color("grid"), linewidth=.7)
    axes.set_axisbelow(True)
    if floor:
        axes.axhspan(axes.get_ylim()[0], floor[0], color=color("floor"), linewidth=0, zorder=.5)
        axes.annotate(floor[1], (1, 0), (-4, 3), xycoords="axes fraction", textcoords="offset points", ha="right",
                      color=color("soft"))
    if front:
        ends = [*front, Point(axes.get_xlim()[1], front[-1].y)]
        axes.step([p.x for p in ends], [p.y for p in ends], where="post", color=color("front"), linewidth=4,
                  zorder=.9)
    for i, curve in enumerate(curves):
        _draw_curve(axes, curve, f"c{i}")
    end_labels(axes, [(c.points[-1].x, c.points[-1].y, c.label, color(c.color)) for c in curves if c.label])
    point_labels(axes, curves)
    return Plot(name, title, description, figure,
                {f"c{i}": curve.points for i, curve in enumerate(curves) if not curve.is_prediction})


@dataclasses.dataclass
class Bar:
    """A bar of parts (name, value, opacity of its color)."""
    label: str
    total: str
    color: str
    parts: list[tuple[str, float, float]]


def bars_plot(name: str, title: str, bars: list[Bar], text: Callable[[float], str] = duration, *,
              width: float = 5.4) -> Plot:
    """Stacked bars, each below its name and total and above its parts in words."""
    row = 38 / 72  # inches
    figure, axes = _new_figure(width, row * len(bars) + .02, "")
    figure.subplots_adjust(left=0, right=1, bottom=0, top=1)
    longest = max(sum(value for _, value, _ in bar.parts) for bar in bars)
    for i, bar in enumerate(bars):
        y, left = -i, 0.0
        for _, value, opacity in bar.parts:
            axes.barh(y, value, .3, left, color=color(bar.color), alpha=opacity, linewidth=0)
            left += value
            axes.plot([left, left], [y - .15, y + .15], color=color("paper"), linewidth=.8)
        whole = sum(value for _, value, _ in bar.parts)
        told = [(part, value) for part, value, _ in bar.parts if value >= .005 * whole]
        rest = whole - sum(value for _, value in told)
        told += [("other", rest)] if rest > .001 * whole else []
        axes.text(0, y + .21, f"{bar.label}  {bar.total}", color=color("ink"), va="bottom", fontweight="bold")
        axes.text(0, y - .21, "  ·  ".join(f"{part} {text(value)}" for part, value in told), color=color("soft"),
                  va="top")
    axes.set_xlim(0, longest)
    axes.set_ylim(.5 - len(bars), .5)
    axes.xaxis.set_visible(False)
    axes.yaxis.set_visible(False)
    return Plot(name, title, "Bars, longest for the most time; their numbers are in words below each.", figure, {})


def _with_titles(svg: str, gid: str, points: Sequence[Point]) -> str:
    """Titles and sources for the markers in the group of this id, which come in the points' order."""
    head, found, rest = svg.partition(f'<g id="{gid}">')
    named = iter(points)

    def marker(match: re.Match[str]) -> str:
        point = next(named)
        source = f' data-source="{html.escape(point.source)}"' if point.source else ""
        return f"<use {match[1].strip()}{source}><title>{html.escape(point.title)}</title></use>"
    return head + found + re.sub(r"<use ([^>]*)/>", marker, rest, count=len(points))


def panels_plot(name: str, title: str, groups: dict[str, list[Bar]], colors: dict[str, str]) -> Plot:
    """Stacked bars of seconds in a panel for each group, each with an axis of its own. A part has the color of
    its name; a bar's own color and its parts' opacity are not used."""
    rows = [len(bars) for bars in groups.values()]
    figure = Figure(figsize=(6.4, sum(.21 * count + .55 for count in rows) + .3))
    figure.patch.set_alpha(0)
    height = figure.get_figheight()
    for axes, (group, bars) in zip(figure.subplots(len(groups), height_ratios=rows), groups.items()):
        _clean(axes, group)
        for i, bar in enumerate(bars):
            left = 0.0
            for part, value, _ in bar.parts:
                axes.barh(i, value, .62, left, color=color(colors[part]), linewidth=0)
                left += value
            axes.annotate(bar.total, (left, i), (4, 0), textcoords="offset points", va="center", color=color("ink"))
        axes.set_yticks(range(len(bars)), [bar.label for bar in bars], color=color("ink"))
        axes.invert_yaxis()
        axes.xaxis.set_major_locator(MaxNLocator(6))
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g} s"))
        axes.grid(True, axis="x", color=color("grid"), linewidth=.7)
        axes.set_axisbelow(True)
    figure.subplots_adjust(left=.2, right=.92, top=1 - .5 / height, bottom=.25 / height, hspace=.85)
    squares = [Rectangle((0, 0), 1, 1, color=color(ink)) for ink in colors.values()]
    figure.legend(squares, list(colors), loc="upper right", ncol=len(colors), frameon=False, handlelength=.8, handleheight=.8,
                  labelcolor=color("ink"), bbox_to_anchor=(.94, 1))
    return Plot(name, title, "Stacked bars of seconds, a panel for each scene.", figure, {})


def inline_svg(plot: Plot) -> str:
    """The plot as an <svg> element: ids unique to its name, colors as CSS variables, sizes and fonts the page's."""
    out = io.StringIO()
    with matplotlib.rc_context({"svg.hashsalt": plot.name}):
        plot.figure.savefig(out, format="svg", metadata={"Date": None, "Creator": None, "Format": None, "Type": None})
    svg = out.getvalue()
    for gid, points in plot.points.items():
        svg = _with_titles(svg, gid, points)
    view = re.search(r'viewBox="[^"]*"', svg)
    assert view is not None
    body = re.sub(r"<!--.*?-->\s*| transform=\"rotate\(-0 [^)]*\)\"", "", svg[svg.index("</defs>") + 7:], flags=re.S)
    for name, (light, _) in THEME.items():
        body = re.sub(light, f"var(--{name})", body, flags=re.I)
    body = re.sub(r'\bid="', f'id="{plot.name}-', body)
    body = re.sub(r'xlink:href="#|url\(#', lambda m: m[0].replace("xlink:", "") + plot.name + "-", body)
    body = re.sub(r"font: (700 )?[^;\"]*;? ?", lambda m: "font-weight: 600;" if m[1] else "", body)
    head = (f'<svg id="{plot.name}" {view[0]} role="img" aria-labelledby="{plot.name}-title {plot.name}-desc">\n'
            f'<title id="{plot.name}-title">{html.escape(plot.title)}</title>\n'
            f'<desc id="{plot.name}-desc">{html.escape(plot.description)}</desc>\n')
    return head + body


def as_file(plot: Plot, suffix: str) -> bytes:
    """The plot as an SVG, PDF or PNG file, for slides, papers and docs: light, on white."""
    dated = {"svg": {"Date": None}, "pdf": {"CreationDate": None}, "png": {"Software": None}}[suffix]
    file = io.BytesIO()
    with matplotlib.rc_context({"svg.hashsalt": plot.name}):
        plot.figure.savefig(file, format=suffix, facecolor="white", dpi=200, metadata=dated)
    return file.getvalue()

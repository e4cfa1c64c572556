# SPDX-License-Identifier: Apache-2.0
"""What the report has measured of a scene, and the plots of its page."""
from __future__ import annotations

import dataclasses
import math
import statistics
from typing import Any, Optional

import numpy

from . import plots
from .page import text
from .plots import Plot
from .texts import name_renderers, sampling_text, size_text

Json = dict[str, Any]


@dataclasses.dataclass
class Study:
    """Everything measured of one scene; pixels are height x width x 3, clamped to 0 to 1."""
    index: int
    bench: Json
    converge: Json
    pictures: dict[str, Json]  # plain and smooth: the stats of render, with the error from the reference
    plain: numpy.ndarray
    smooth: numpy.ndarray
    reference: numpy.ndarray
    features: Optional[Json]  # runs with what the scene needs (auto) and with everything (all); None without OpenCL

    def __post_init__(self) -> None:
        for rows in (self.bench["rows"], self.converge["points"]):
            name_renderers(rows)
        self._colors: dict[str, str] = {}
        for row in self.bench["rows"]:
            if row["device_name"] != "threads":
                self._colors.setdefault(row["device"], f"s{1 + len(self._colors) % 5}")

    def color(self, row: Json) -> str:
        """Of a row, point or curve: that of its device."""
        return self._colors.get(row["device"], plots.THREADS_COLOR)

    @property
    def name(self) -> str:
        scene = self.pictures["plain"]["scene"]
        return str(scene["name"] or scene["path"])

    def source(self, row: Json) -> str:
        """Where a row of bench or a point of converge lies in the page's data."""
        for kind, rows in (("bench", self.bench["rows"]), ("converge", self.converge["points"])):
            for i, other in enumerate(rows):
                if other is row:
                    return f"{kind}-{self.index}#/{'rows' if kind == 'bench' else 'points'}/{i}"
        raise ValueError("not a row of this study")

    def largest(self) -> list[Json]:
        """The right rows in float of the largest picture with the most samples."""
        rows = [row for row in self.bench["rows"] if row["figures"] and row["precision"] == "float"]
        most = max((_work(row) for row in rows), default=None)
        return [row for row in rows if _work(row) == most]


def _work(row: Json) -> tuple[int, float]:
    return row["width"] * row["height"], row["samples"] or math.inf  # None: as many as a pixel needs


def trace_seconds(row: Json) -> float:
    return float(row["figures"]["trace"]["median"])


def was_cold(row: Json) -> bool:
    """Whether its warm-up compiled the kernels: bench begins with an empty cache."""
    builds = [run["seconds"]["build"] for run in row["repeats"]]
    return bool(builds) and not row["threads"] and row["warm_up"][0]["seconds"]["build"] > 2 * statistics.median(builds)


def spread_of(values: list[float]) -> Json:
    median = statistics.median(values)
    return {"median": median, "mad": statistics.median(abs(value - median) for value in values)}


def settings_text(row: Json) -> str:
    return f"{size_text(row['width'], row['height'])} pixels, {sampling_text(row['aa'])}"


class Figures:
    """Puts plots into the page and keeps them."""

    def __init__(self) -> None:
        self.plots: list[Plot] = []

    def put(self, plot: Plot, caption: str, css_class: str = "plot") -> str:
        self.plots.append(plot)
        return (f'<figure class="{css_class}">{plots.inline_svg(plot)}'
                f"<figcaption>{text(caption)}</figcaption></figure>\n")

# SPDX-License-Identifier: Apache-2.0
"""Numbers and names as tables, plots and sentences write them."""
from __future__ import annotations

import math
import re
from typing import Any

NBSP = "\u00a0"
_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def scientific(value: float, digits: int = 2) -> str:
    """1.9·10⁻⁷"""
    if value == 0 or not math.isfinite(value):
        return significant(value, digits)
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    return f"{mantissa}·{power_of_ten(int(exponent))}"


def estimate_text(estimate: dict[str, Any]) -> str:
    """The estimated RMSE, or what it is below."""
    if estimate["rmse"] is None:
        return f"below {scientific(estimate['high'])}"
    return scientific(estimate["rmse"])


def power_of_ten(exponent: int) -> str:
    return "10" + str(exponent).translate(_SUPERSCRIPTS)


def significant(value: float, digits: int = 3) -> str:
    """So many digits: 1234, 12.3, 0.0500."""
    if value == 0:
        return "0"
    if not math.isfinite(value):
        return "not a number" if math.isnan(value) else "∞" if value > 0 else "−∞"
    if not 1e-4 <= abs(value) < 1e9:
        return scientific(value, digits)
    exponent = int(f"{abs(value):.{digits - 1}e}".split("e")[1])  # rounding may carry: 9.996 is 10.0
    return f"{value:.{max(0, digits - 1 - exponent)}f}"


def duration(seconds: float, digits: int = 3) -> str:
    """12.3 ms"""
    rounded = abs(float(f"{seconds:.{digits - 1}e}"))
    if rounded >= 1 or seconds == 0:
        return significant(seconds, digits) + NBSP + "s"
    if rounded >= 1e-3:
        return significant(seconds * 1e3, digits) + NBSP + "ms"
    return significant(seconds * 1e6, digits) + NBSP + "µs"


def milliseconds(seconds: float) -> str:
    return significant(seconds * 1e3)


def counted(count: int, noun: str) -> str:
    return f"{count} {noun}" + ("s" if count != 1 else "")


def size_text(width: int, height: int) -> str:
    return f"{width}{NBSP}x{NBSP}{height}"


def sampling_text(aa: str) -> str:
    """What an AA mode does, then the mode: 2 x 2 samples per pixel (grid:2)."""
    kind, _, number = aa.partition(":")
    if kind == "none":
        return "one sample per pixel"
    if kind == "adaptive":
        return f"more samples where neighbors differ ({aa})"
    if kind == "edges":
        return f"more samples at edges ({aa})"
    samples = size_text(int(number), int(number)) if kind == "grid" else number
    return f"{samples} samples per pixel ({aa})"


def noise_percent(spread: dict[str, Any]) -> float:
    """The median absolute deviation, in percent of the median."""
    return 100 * float(spread["mad"]) / float(spread["median"]) if spread["median"] > 0 else 0.0


def short_name(name: str) -> str:
    """The one short name of an OpenCL device: PoCL calls its own `pthread-haswell-AMD EPYC`, which is
    PoCL (AMD EPYC) here. Other names are short enough."""
    pocl = re.fullmatch(r"(?:pthread|cpu)(?:-[^- A-Z]*)*(?:-(.*))?", name)
    if pocl is None:
        return name
    processor = re.sub(r"\((?:R|TM)\)|(?: CPU)? @.*|(?: [^ ]*)?-Core Processor.*", "", pocl[1] or "")
    return f"PoCL ({processor})" if processor else "PoCL"


def renderer_name(row: dict[str, Any]) -> str:
    """Who rendered a row of bench or a point of converge: PoCL (AMD EPYC), or 2 threads, sample buffers."""
    if "renderer" in row:
        return str(row["renderer"])
    runs = row.get("repeats") or row.get("warm_up") or []
    device = runs[0]["device"] if runs else {}
    threads = row.get("threads") or device.get("threads", 0)
    if row["device_name"] != "threads":
        return short_name(row["device_name"])
    schedule = {"buffers": ", sample buffers", "scalar": ", one ray at a time"}
    name = counted(threads, "thread") if threads else "threads"
    return name + schedule.get(row.get("schedule", ""), "")


def name_renderers(rows: list[dict[str, Any]]) -> None:
    """Gives each row its `renderer`, with the device's number where devices share a name."""
    names = [renderer_name(row) for row in rows]
    for row, name in zip(rows, names):
        devices = {other["device"] for other, its in zip(rows, names) if its == name}
        row["renderer"] = f"{name}, device {row['device']}" if len(devices) > 1 else name

# SPDX-License-Identifier: Apache-2.0
"""What the program measures, as rows and dicts."""
from __future__ import annotations

import contextlib
import re
import tempfile
from typing import Any, Dict, Iterable, List

from .picture import as_file
from .program import option_words, run, run_json
from .rendering import NOT_HERE
from .scenes import Scene, scene_path
from .texts import name_renderers


#: Exit codes of bench and converge with a wrong, failed or non-finite row, whose verdict says so.
WITH_BAD_ROWS = (0, 1, 5, 6)


class Rows(List[Dict[str, Any]]):
    """Flat dicts, one per row, as pandas.DataFrame takes them; `report` is the full JSON."""

    def __init__(self, rows: Iterable[dict[str, Any]], report: dict[str, Any]) -> None:
        super().__init__(rows)
        self.report = report


def _flat(value: dict[str, Any], before: str = "") -> dict[str, Any]:
    """Nested objects as keys with dots; lists are left out."""
    found: dict[str, Any] = {}
    for key, part in value.items():
        name = f"{before}{key}"
        if isinstance(part, dict):
            found.update(_flat(part, name + "."))
        elif not isinstance(part, list):
            found[name] = part
    return found


def bench(*scenes: Scene, **options: Any) -> Rows:
    """`mirrorball bench`: a row for each device, size, mode and schedule.

    Options are, for example, sizes=[100, 200], devices=["pocl", "threads:2"], aa=["none", "grid:2"],
    repeats=5. Without a scene, it measures the paper's. `verdict` says which rows are wrong or failed,
    `renderer` is its device's short name, such as PoCL (AMD EPYC), and `asked` what of `devices` it is.
    Raises Error.
    """
    with contextlib.ExitStack() as stack:
        paths = [stack.enter_context(scene_path(scene)) for scene in scenes]
        report = run_json(["bench", *paths, "--json", "-q", *option_words(options)], accepted=WITH_BAD_ROWS)
    return _rows(report, "rows", options.get("devices"))


def converge(scene: Scene, **options: Any) -> Rows:
    """`mirrorball converge`: error against run time, a row for each device, precision and AA mode.

    `figures.seconds.median` and `figures.rmse` are the two axes; report["pareto_front"] has the
    indices of the best rows; `verdict` is as for bench. Raises Error.
    """
    with scene_path(scene) as path:
        report = run_json(["converge", path, "--json", "-q", *option_words(options)], accepted=WITH_BAD_ROWS)
    return _rows(report, "points", options.get("devices"))


def _rows(report: dict[str, Any], key: str, devices: Any) -> Rows:
    rows = report[key]
    name_renderers(rows)
    return Rows([{**_flat(row), "asked": _asked(row, rows, devices)} for row in rows], report)


def _asked(row: dict[str, Any], rows: list[dict[str, Any]], devices: Any) -> str:
    """What of `devices` asked for a row; "all" where it was not named."""
    asked = devices.split(",") if isinstance(devices, str) else [str(one) for one in devices or ["all"]]
    opencl = [spec for spec in asked if not spec.startswith(("threads", "all"))]
    found = list(dict.fromkeys(one["device"] for one in rows if one["device_name"] != "threads"))
    if row["device_name"] == "threads":
        return next((spec for spec in asked if spec == row["device"]), None) or \
            next((spec for spec in asked if spec == "threads"), "all")
    return opencl[found.index(row["device"])] if len(opencl) == len(found) else str(row["device"])


def stress(**options: Any) -> Rows:
    """`mirrorball stress`: a row for each family, case and renderer, such as case="needles,scale-*", quick=True.

    `verdict` is pass, fail or not judged. Raises Error.
    """
    report = run_json(["stress", "--json", "-q", *option_words(options)], accepted=(0, 1))
    return Rows(({"family": family["name"], "parameter": family["parameter"], "case": case["label"],
                  "value": case["value"], **_flat(row)}
                 for family in report["families"] for case in family["cases"] for row in case["rows"]), report)


def explain(scene: Scene, x: int, y: int, **options: Any) -> dict[str, Any]:
    """`mirrorball explain`: the tree of the rays of pixel x, y, counted from 0 at the top left, and what each
    light adds. Options are, for example, size=100 and aa="grid:2". Raises Error.
    """
    with scene_path(scene) as path:
        return run_json(["explain", path, "--pixel", f"{x},{y}", "--json", *option_words(options)])


def compare(picture: Any, reference: Any, **options: Any) -> dict[str, Any]:
    """`mirrorball compare`: how far a picture is from a reference.

    Both are paths, Pictures or arrays of height x width x 3. An error beyond a threshold, such as
    max_abs=0, does not raise; `passed` is then false. Raises Error.
    """
    with tempfile.TemporaryDirectory(prefix="mirrorball-") as folder:
        return run_json(["compare", as_file(picture, folder, "picture.pfm"),
                         as_file(reference, folder, "reference.pfm"), "--json",
                         *option_words(options)], accepted=(0, 1))


def devices(**options: Any) -> list[dict[str, Any]]:
    """The OpenCL devices of this machine; `usable` says whether one can render. Raises Error."""
    report = run_json(["devices", "--json", *option_words(options)], accepted=(0, 5))
    return Rows(report["devices"], report)


def doctor() -> dict[str, Any]:
    """`mirrorball doctor`: what works on this machine; `well` is false where something is broken."""
    return run_json(["doctor", "--json"], accepted=(0, 5))


def scene_info(scene: Scene) -> dict[str, Any]:
    """`mirrorball scene info`: what a scene holds, and warnings. Raises Error."""
    with scene_path(scene) as path:
        return run_json(["scene", "info", path, "--json"])


def options(verb: str) -> list[str]:
    """The keyword arguments that are options of a verb."""
    found = re.findall(r"^  (?:-\w,)?--([a-z][a-z-]+)", run([verb, "--help"]), re.M)
    not_here = {"help", *(NOT_HERE if verb == "render" else ())}
    return [name.replace("-", "_") for name in dict.fromkeys(found) if name not in not_here]

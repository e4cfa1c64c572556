# SPDX-License-Identifier: Apache-2.0
"""Runs the cells of the notebooks in docs, on smaller pictures."""
import json
import pathlib
import sys
from unittest import mock

import pytest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SMALLER = {"SIZES = [100, 200, 300, 400, 500]": "SIZES = [16, 24]", "REPEATS = 5": "REPEATS = 1",
           "THREADS = os.cpu_count()": "THREADS = 2", "reference_samples=256": "reference_samples=16",
           'devices=["threads", "pocl"]': 'devices=["threads:1", "threads:2"]'}


def code_cells(name):
    notebook = json.loads((ROOT / "docs" / name).read_text(encoding="utf-8"))
    return ["".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code"]


def pyplot():
    """A function that counts the curves drawn by matplotlib."""
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    from matplotlib import pyplot as real
    return lambda: sum(len(real.figure(number).axes[0].lines) for number in real.get_fignums())


def test_the_papers_evaluation_runs(monkeypatch, tmp_path):
    drawn = pyplot()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    source = "\n".join(code_cells("paper.ipynb"))
    for long, short in SMALLER.items():
        assert long in source
        source = source.replace(long, short)
    variables = {}
    exec(compile(source, "paper.ipynb", "exec"), variables)
    assert len(variables["rows"]) > 0
    assert all(row["verdict"] == "right" for row in variables["rows"])
    assert len(variables["points"]) == 12
    assert drawn() >= 5


def test_the_sliders_move_the_scene(monkeypatch):
    monkeypatch.setitem(sys.modules, "ipywidgets", mock.MagicMock())
    variables = {}
    source = "\n".join(code_cells("sliders.ipynb")).replace("size=320", "size=24")
    exec(compile(source, "sliders.ipynb", "exec"), variables)
    hashes = {variables["render"](**moved).hash for moved in ({}, {"radius": .6}, {"x": .5}, {"mirror": 0}, {"samples": 1})}
    assert len(hashes) == 5
    interact = sys.modules["ipywidgets"].interact.call_args
    assert interact.args == (variables["render"],) and set(interact.kwargs) == {"radius", "x", "mirror", "samples", "bounces"}

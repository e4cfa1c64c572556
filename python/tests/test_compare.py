# SPDX-License-Identifier: Apache-2.0
"""FLIP: with a stand-in for the package, and where it is installed, the real one."""
import importlib.util
import os
import pathlib
import subprocess
import sys
import types

import numpy
import pytest

import mirrorball
from mirrorball.compare import flip


@pytest.fixture(name="seen")
def stand_in(monkeypatch):
    """What a stand-in was given."""
    seen = []

    def evaluate(reference, test, kind, applyMagma):
        seen[:] = [reference, test, kind]
        return None, .25, {}
    monkeypatch.setitem(sys.modules, "flip_evaluator", types.SimpleNamespace(evaluate=evaluate, load=None))
    return seen


def test_flip_gets_the_reference_first_clamped_in_three_channels(seen, tmp_path):
    path = tmp_path / "b.pfm"
    mirrorball.write_pfm(path, numpy.full((1, 2, 3), 2.0))
    assert flip(numpy.full((1, 2, 1), .25), path) == .25
    assert seen[0].tolist() == [[[1.0] * 3] * 2] and seen[1].tolist() == [[[.25] * 3] * 2] and seen[2] == "LDR"


@pytest.mark.parametrize("pixels", [numpy.full((2, 2, 3), .5), numpy.full((1, 2, 3), numpy.nan)])
def test_flip_refuses_what_it_cannot_compare(seen, pixels):
    with pytest.raises(ValueError):
        flip(pixels, numpy.full((1, 2, 3), .5))
    assert not seen


def run(folder, *words):
    package = pathlib.Path(mirrorball.__file__).parent.parent
    return subprocess.run([sys.executable, "-m", "mirrorball.compare", *words], cwd=folder, capture_output=True, text=True,
                          env={**os.environ, "PYTHONPATH": os.pathsep.join([str(package), *sys.path])}, check=False)


def test_the_command_adds_a_line_or_says_what_is_missing(tmp_path):
    for name, value in (("a", .5), ("b", .25)):
        mirrorball.write_pfm(tmp_path / f"{name}.pfm", numpy.full((4, 4, 3), value))
    plain = run(tmp_path, "a.pfm", "b.pfm", "--max-rmse", "0.1")
    assert plain.returncode == 1 and "RMSE" in plain.stdout and "FLIP" not in plain.stdout
    result = run(tmp_path, "--flip", "a.pfm", "b.pfm", "--max-flip", "0.01")
    if importlib.util.find_spec("flip_evaluator"):
        assert result.returncode == 1 and "FLIP" in result.stdout and "exceeds --max-flip 0.01" in result.stderr
    else:
        assert result.returncode == 5 and "no module flip_evaluator; install it" in result.stderr
        assert len(result.stderr.splitlines()) == 1
    assert run(tmp_path, "--flip", "a.pfm", "none.pfm").returncode == 3

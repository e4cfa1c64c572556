# SPDX-License-Identifier: Apache-2.0
"""Regressions between two results of bench."""
import json
import os
import pathlib
import subprocess
import sys

import pytest

import mirrorball
from mirrorball.regressions import _read, slower


def result(**seconds):
    rows = [{"key": f"hash {key}", "scene": {"path": "a.json"},
             "figures": {"total": {"median": 2 * one, "mad": 0}, "trace": {"median": one, "mad": 0}}}
            for key, one in seconds.items()]
    return {"format": "mirrorball-bench", "version": 1, "rows": [*rows, {"key": "wrong", "figures": None}]}


@pytest.fixture(name="compare")
def comparison(tmp_path):
    def compare(old, new, *options):
        for name, text in (("old.json", old), ("new.json", new)):
            (tmp_path / name).write_text(text if isinstance(text, str) else json.dumps(text), encoding="utf-8")
        package = pathlib.Path(mirrorball.__file__).parent.parent
        return subprocess.run([sys.executable, "-m", "mirrorball.regressions", "old.json", "new.json", *options],
                              cwd=tmp_path, capture_output=True, text=True, check=False,
                              env={**os.environ, "PYTHONPATH": os.pathsep.join([str(package), *sys.path])})
    return compare


@pytest.mark.parametrize("median, mad, expected", [(1.04, 0, False), (1.1, .01, True), (1.1, .03, False), (.5, 0, False)])
def test_slower_means_beyond_the_share_and_beyond_the_noise(median, mad, expected):
    assert slower({"median": 1, "mad": .01}, {"median": median, "mad": mad}, .05) == expected


def test_slower_rows_are_named(compare):
    found = compare(result(a=1, b=1), result(a=1.1, b=1.04, c=9))
    assert (found.returncode, found.stdout.count("\n")) == (1, 1)
    assert found.stdout.startswith("slower: a.json a: total 2.2")
    assert compare(result(a=1, b=1), result(a=1.1, b=1.04), "--max-regress", "20%").returncode == 0
    assert compare(result(a=1), result(a=1), "--max-regress", "fast").returncode == 2


@pytest.mark.parametrize("old", ["", "[]", "{}", json.dumps(result(a=1))[:-9], result(b=1),
                                 {"format": "mirrorball-bench", "version": 1, "rows": [{"key": "a", "figures": {}}, 3]}])
def test_damaged_files_and_other_rows_are_refused(compare, old):
    found = compare(old, result(a=1))
    assert (found.returncode, found.stdout, found.stderr.count("\n")) == (3, "", 1) and "Traceback" not in found.stderr


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(ValueError, match="missing.json: cannot read: No such file or directory; check the path"):
        _read(str(tmp_path / "missing.json"))

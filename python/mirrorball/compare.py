# SPDX-License-Identifier: Apache-2.0
"""`mirrorball compare` and NVIDIA's FLIP: python -m mirrorball.compare [--flip] [--max-flip X] A B [options of compare]

FLIP (Andersson et al. 2020) at 67 pixels per degree, by the PyPI package flip-evaluator; pictures as a display shows
them: values as they are stored, clamped. Exit code 1 if it exceeds --max-flip.
"""
from __future__ import annotations

import argparse
import importlib
import os
import subprocess
import sys
import types
from typing import Any, Union

import numpy

from . import measures
from .picture import read_pfm
from .program import find_program, run_main


def flip(picture: Any, reference: Any) -> float:
    """The mean FLIP error, 0 to 1, of pictures: arrays, Pictures or paths of PFM, PNG or EXR files.

    Raises ModuleNotFoundError without the package, ValueError for pictures it cannot compare.
    """
    evaluator = importlib.import_module("flip_evaluator")
    pixels = [_pixels(evaluator, one) for one in (reference, picture)]
    if pixels[0].shape != pixels[1].shape:
        raise ValueError("FLIP needs pictures of the same size")
    if not all(numpy.isfinite(one).all() for one in pixels):
        raise ValueError("FLIP needs pixels that are finite")
    return float(evaluator.evaluate(*pixels, "LDR", applyMagma=False)[1])


def _pixels(evaluator: Any, picture: Union[str, Any]) -> numpy.ndarray:
    if isinstance(picture, (str, os.PathLike)):
        path = os.fspath(picture)
        picture = read_pfm(path) if path.lower().endswith(".pfm") else evaluator.load(path)
    array = numpy.asarray(getattr(picture, "array", picture), numpy.float32)
    array = numpy.repeat(array, 3, axis=2) if array.shape[2] == 1 else array[..., :3]
    return numpy.ascontiguousarray(numpy.clip(array, 0, 1))


class _Callable(types.ModuleType):
    """This module has the name of the package's function compare(): importing it must not hide that."""

    def __call__(self, *arguments: Any, **options: Any) -> dict[str, Any]:
        return measures.compare(*arguments, **options)


sys.modules[__name__].__class__ = _Callable


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m mirrorball.compare", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("picture", metavar="A")
    parser.add_argument("reference", metavar="B")
    parser.add_argument("--flip", action="store_true", help="also compute FLIP")
    parser.add_argument("--max-flip", type=float, metavar="X", help="exit 1 if the mean FLIP error exceeds X")
    arguments, others = parser.parse_known_args()
    status = subprocess.run([find_program(), "compare", arguments.picture, arguments.reference, *others],
                            check=False).returncode
    if status > 1 or status < 0 or not (arguments.flip or arguments.max_flip is not None):
        return status
    try:
        mean = flip(arguments.picture, arguments.reference)
    except ModuleNotFoundError as error:
        print(f"mirrorball: {sys.executable} has no module {error.name}; install it with 'python3 -m pip install "
              "flip-evaluator'", file=sys.stderr)
        return 5
    except ValueError as error:
        print(f"mirrorball: {error}", file=sys.stderr)
        return 3
    is_json = any(word.startswith("--json") for word in others)  # which stdout may hold
    print(f"  FLIP        {mean:.4e}", file=sys.stderr if is_json else sys.stdout)
    if arguments.max_flip is not None and not mean <= arguments.max_flip:
        print(f"mirrorball: FLIP {mean:.4g} exceeds --max-flip {arguments.max_flip:.4g}", file=sys.stderr)
        return 1
    return status


if __name__ == "__main__":
    run_main(main)

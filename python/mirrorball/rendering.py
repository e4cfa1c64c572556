# SPDX-License-Identifier: Apache-2.0
"""Rendering one picture."""
from __future__ import annotations

import pathlib
import sys
import tempfile
from typing import Any, Union

from .errors import MissingPartsError
from .picture import Picture, read_pfm
from .program import Progress, option_words, run_json
from .scenes import Scene, scene_path

#: Options of `mirrorball render` that render() does not take.
NOT_HERE = ("output", "o", "format", "stats", "q", "quiet", "batch", "frames", "shard", "aov",
            "watch", "show", "preview")


def _print_progress(fraction: float) -> None:
    print(f"\rmirrorball: {100 * fraction:3.0f} %", end="" if fraction < 1 else "\n",
          file=sys.stderr, flush=True)


def render(scene: Scene, *, progress: Union[bool, Progress, None] = None,
           **options: Any) -> Picture:
    """Renders a scene.

    scene: a path or a dict. progress: True for a line on stderr, or a function that is called with the
    fraction done, 0 to 1. options: those of `mirrorball render`, such as device="pocl", aa="grid:2",
    size=500 or (640, 480), precision="double", except for those that say where the picture and the
    figures go or that make several pictures. Raises Error.
    """
    taken = [name for name in NOT_HERE if options.get(name)]
    if taken:
        raise TypeError(f"render() has no option {taken[0]}: it returns one picture, to save()")
    show = _print_progress if progress is True else progress or None
    with scene_path(scene) as path, tempfile.TemporaryDirectory(prefix="mirrorball-") as folder:
        pfm = pathlib.Path(folder) / "picture.pfm"
        try:
            stats = run_json(["render", path, "-o", pfm, "--stats=json", "--progress",
                              "json" if show else "none", *option_words(options)], show)
        except MissingPartsError as error:  # the finished part goes with the folder
            message = str(error).split("; the finished part is in ")[0]
            raise MissingPartsError(message, error.exit_code) from None
        return Picture(read_pfm(pfm), stats)

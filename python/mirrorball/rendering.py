# SPDX-License-Identifier: Apache-2.0
"""Rendering one picture."""
from __future__ import annotations

import pathlib
import sys
import tempfile
from typing import Any, Sequence, Union

import numpy

from .errors import MissingPartsError
from .exr import read_exr
from .picture import Picture, read_pfm
from .program import Progress, option_words, run_json
from .scenes import Scene, scene_path

#: Options of `mirrorball render` that render() does not take.
NOT_HERE = ("output", "o", "format", "stats", "q", "quiet", "batch", "frames", "shard", "aov",
            "watch", "show", "preview", "resume", "fresh")


def _print_progress(fraction: float) -> None:
    print(f"\rmirrorball: {100 * fraction:3.0f} %", end="" if fraction < 1 else "\n",
          file=sys.stderr, flush=True)


def render(scene: Scene, *, progress: Union[bool, Progress, None] = None,
           **options: Any) -> Picture:
    """Renders a scene.

    scene: a path or a dict. progress: True for a line on stderr, or a function that is called with the
    fraction done, 0 to 1. options: those of `mirrorball render`, except for those that say where the picture,
    its journal and the figures go or that make several pictures:

        what: size=500 or (640, 480), aa="grid:2", filter, crop, max_bounces, light_scale, ambient, reference,
            estimate, target_rmse=1e-3
        on what: device="pocl", threads, schedule, lanes, isa, launch, tile, isolate, deadline, no_fallback
        how: precision="double", math, features, hierarchies, caster_lists, check, timeout, encoding, expect,
            cl_options, save_kernels, verbose
        viewers: tev

    `mirrorball render --help` describes them. Raises Error.
    """
    return _rendered(scene, progress, options)[0]


def aov(scene: Scene, names: Union[str, Sequence[str]] = ("depth", "normal", "id", "rays", "samples"),
        **options: Any) -> dict[str, numpy.ndarray]:
    """What `mirrorball render --aov` saves of each pixel: the distance to what it shows (depth), the normal
    there (height x width x 3), the number of the object (id), and the rays and samples it took.

    Arrays of height x width by name; options as for render(). Raises Error.
    """
    wanted = names.split(",") if isinstance(names, str) else list(names)
    channels = _rendered(scene, None, options, wanted)[1]
    return {name: numpy.stack([channels[f"normal.{axis}"] for axis in "XYZ"], axis=2) if name == "normal"
            else channels[name] for name in wanted}


def _rendered(scene: Scene, progress: Union[bool, Progress, None], options: dict[str, Any],
              aovs: Sequence[str] = ()) -> tuple[Picture, dict[str, numpy.ndarray]]:
    """The picture, and the channels of the AOVs."""
    taken = [name for name in NOT_HERE if options.get(name)]
    if taken:
        raise TypeError(f"render() has no option {taken[0]}: it returns one picture, to save()")
    show = _print_progress if progress is True else progress or None
    with scene_path(scene) as path, tempfile.TemporaryDirectory(prefix="mirrorball-") as folder:
        file = pathlib.Path(folder) / ("picture.exr" if aovs else "picture.pfm")
        also = ["--aov", aovs] if aovs else []
        try:
            stats = run_json(["render", path, "-o", file, "--stats=json", "--progress",
                              "json" if show else "none", *also, *option_words(options)], show)
        except MissingPartsError as error:  # the finished part goes with the folder
            message = str(error).split("; the finished part is in ")[0]
            raise MissingPartsError(message, error.exit_code) from None
        if not aovs:
            return Picture(read_pfm(file), stats), {}
        color = read_exr(file)
        pixels = numpy.stack([color[name] for name in "RGB"], axis=2).astype(numpy.float32)
        return Picture(pixels, stats), read_exr(file.with_suffix(".aov.exr"))

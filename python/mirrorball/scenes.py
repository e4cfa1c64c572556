# SPDX-License-Identifier: Apache-2.0
"""Scenes as the program takes them: paths, or dicts that are written to a file for it."""
from __future__ import annotations

import contextlib
import json
import os
import pathlib
import tempfile
from typing import Iterator, Union

from .program import find_program

Scene = Union[str, "os.PathLike[str]", dict]


def scene(name: str) -> str:
    """The path of a scene that comes with the program: scene("cornell-box"), scene("gallery/marbles").

    Raises FileNotFoundError where the program brings no such scene.
    """
    prefix = pathlib.Path(find_program()).resolve().parent
    for folder in (prefix.parent / "share" / "mirrorball" / "scenes",
                   prefix.parent.parent / "scenes"):
        path = folder / f"{name}.json"
        if path.exists():
            return str(path)
    raise FileNotFoundError(f"no scene {name} beside {prefix}")


@contextlib.contextmanager
def scene_path(scene: Scene) -> Iterator[str]:
    """A file that holds the scene while the block runs.

    That of a dict with meshes lies in the working folder, which their names are relative to: the
    program reads nothing from outside of a scene's folder.
    """
    if not isinstance(scene, dict):
        yield os.fspath(scene)
        return
    with tempfile.TemporaryDirectory(prefix="mirrorball-") as folder:
        place = os.getcwd() if scene.get("meshes") else folder
        with tempfile.NamedTemporaryFile("w", suffix=".json", prefix=".mirrorball-", dir=place,
                                         encoding="utf-8") as file:
            json.dump({"name": "scene", **scene}, file)
            file.flush()
            yield file.name

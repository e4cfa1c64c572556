# SPDX-License-Identifier: Apache-2.0
"""Scenes as the program takes them: paths, or dicts that are written to a file for it."""
from __future__ import annotations

import contextlib
import json
import os
import pathlib
import re
import tempfile
from typing import IO, Any, Dict, Iterator, Union

from .errors import Error, OutputError
from .program import find_program

Scene = Union[str, "os.PathLike[str]", Dict[str, Any]]


def load(name: Union[str, "os.PathLike[str]"]) -> Dict[str, Any]:
    """A JSON scene as a dict to change and render: one that comes with the program, by its name, or a file.

    Names of meshes stay relative to the scene's folder: render such a dict from there. Raises
    FileNotFoundError, and ValueError for a file that is no JSON.
    """
    path = pathlib.Path(name)
    text = (path if path.suffix else pathlib.Path(scene(str(name)))).read_text(encoding="utf-8-sig")
    plain = re.sub(r'("(?:[^"\\]|\\.)*")|//[^\n]*|/\*.*?\*/', lambda m: m[1] or "", text, flags=re.S)
    return dict(json.loads(plain))


def scene(name: str) -> str:
    """The path of a scene that comes with the program: scene("cornell-box"), scene("gallery/marbles").

    Raises FileNotFoundError if the program has no such scene.
    """
    prefix = pathlib.Path(find_program()).resolve().parent
    for folder in (prefix.parent / "share" / "mirrorball" / "scenes",
                   prefix.parent.parent / "scenes"):
        path = folder / f"{name}.json"
        if path.exists():
            return str(path)
    raise FileNotFoundError(f"no scene {name} next to {prefix}")


def _plain(value: Any) -> Any:
    """numpy's numbers and arrays as Python's."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"a scene cannot hold a {type(value).__name__}: {value}")


def _new_file(folder: str) -> IO[str]:
    try:
        return tempfile.NamedTemporaryFile("w", suffix=".json", prefix=".mirrorball-", dir=folder,
                                           encoding="utf-8")
    except OSError as error:
        raise OutputError(f"{folder}: cannot be written to; a scene with meshes needs a file in the "
                          "working folder, which their names are relative to; change to another", 4) from error


@contextlib.contextmanager
def scene_path(scene: Scene) -> Iterator[str]:
    """A file that holds the scene while the block runs.

    For a dict with meshes it lies in the working folder, which their names are relative to: the
    program reads nothing outside of a scene's folder.
    """
    if not isinstance(scene, dict):
        yield os.fspath(scene)
        return
    with tempfile.TemporaryDirectory(prefix="mirrorball-") as folder:
        place = os.getcwd() if scene.get("meshes") else folder
        with _new_file(place) as file:
            json.dump({"name": "scene", **scene}, file, default=_plain)
            file.flush()
            try:
                yield file.name
            except Error as error:  # the file's one line says nothing
                said = re.sub(re.escape(file.name) + r"(:\d+:\d+)?", "the scene's dict", str(error))
                raise type(error)(said, error.exit_code) from None

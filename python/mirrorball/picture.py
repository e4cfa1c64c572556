# SPDX-License-Identifier: Apache-2.0
"""A rendered picture: its pixels and what was measured."""
from __future__ import annotations

import os
import struct
import tempfile
import zlib
from typing import Any, Union

import numpy

from .program import run


def read_pfm(path: Union[str, "os.PathLike[str]"]) -> numpy.ndarray:
    """The pixels of a PFM file: height x width x 3 (or x 1), float32, row 0 at the top.

    Raises ValueError if it is not a PFM file.
    """
    with open(path, "rb") as file:
        kind = file.readline().strip()
        size = file.readline().split()
        scale = file.readline().strip()
        values = file.read()
    channels = {b"PF": 3, b"Pf": 1}.get(kind)
    if channels is None or len(size) != 2:
        raise ValueError(f"{path}: not a PFM file")
    width, height = int(size[0]), int(size[1])
    order = "<f4" if float(scale) < 0 else ">f4"
    pixels = numpy.frombuffer(values, order, height * width * channels)
    return pixels.reshape(height, width, channels)[::-1].astype(numpy.float32)


def write_pfm(path: Union[str, "os.PathLike[str]"], array: numpy.ndarray) -> None:
    """Writes height x width x 3 values, row 0 at the top, as a PFM file."""
    array = numpy.asarray(array)
    if array.ndim != 3 or array.shape[2] != 3:
        raise ValueError(f"the array must be height x width x 3, but is {array.shape}")
    height, width, _ = array.shape
    with open(path, "wb") as file:
        file.write(f"PF\n{width} {height}\n-1.0\n".encode())
        file.write(numpy.ascontiguousarray(array[::-1], "<f4").tobytes())


def png_of(array: numpy.ndarray) -> bytes:
    """The pixels as an 8-bit PNG: values clamped to 0..1, times 255, rounded, as the program does."""
    height, width, _ = array.shape
    values = (numpy.clip(array, 0, 1).astype(float) * 255 + 0.5).astype(numpy.uint8)
    rows = numpy.zeros((height, 1 + 3 * width), numpy.uint8)  # a row begins with its filter, none
    rows[:, 1:] = values.reshape(height, 3 * width)

    def chunk(name: bytes, data: bytes) -> bytes:
        return (struct.pack(">I", len(data)) + name + data
                + struct.pack(">I", zlib.crc32(name + data)))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
            + chunk(b"IDAT", zlib.compress(rows.tobytes())) + chunk(b"IEND", b""))


class Picture:
    """Pixels in linear light, and the figures of `mirrorball render --stats=json`.

    array: height x width x 3, float32, row 0 at the top.
    """

    def __init__(self, array: numpy.ndarray, stats: dict[str, Any]) -> None:
        self.array = array
        self.stats = stats

    @property
    def hash(self) -> str:
        """The hash over every bit of the picture, the same on every device."""
        return str(self.stats["image"]["hash"])

    @property
    def seconds(self) -> dict[str, Any]:
        """Wall-clock seconds by phase."""
        return dict(self.stats["seconds"])

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes the picture in the format of the name's ending: .pfm and .exr (every bit), .png, .tif, .jpg
        and the others of `mirrorball render -o`. Raises Error."""
        with tempfile.TemporaryDirectory(prefix="mirrorball-") as folder:
            run(["merge", as_file(self.array, folder, "picture.pfm"), "-o", path, "-q"])

    def _repr_png_(self) -> bytes:
        return png_of(self.array)

    def __repr__(self) -> str:
        height, width, _ = self.array.shape
        device = self.stats["device"]["name"]
        return f"<Picture {width}x{height}, {self.hash}, {device}, {self.seconds['trace']:.3f} s>"


def as_file(picture: Any, folder: str, name: str) -> str:
    """The path of a picture; a Picture or an array is first written to a file in the folder."""
    if isinstance(picture, Picture):
        picture = picture.array
    if isinstance(picture, numpy.ndarray):
        path = os.path.join(folder, name)
        write_pfm(path, picture)
        return path
    return str(os.fspath(picture))

# SPDX-License-Identifier: Apache-2.0
"""Reads the EXR files that the program writes for --aov: scan lines, without compression or by ZIP."""
from __future__ import annotations

import os
import pathlib
import struct
import zlib
from typing import Union

import numpy

_TYPES = {0: "<u4", 1: "<f2", 2: "<f4"}
_ROWS_A_BLOCK = {0: 1, 2: 1, 3: 16}  # by compression: none, a row each, 16 rows


def read_exr(path: Union[str, "os.PathLike[str]"]) -> dict[str, numpy.ndarray]:
    """Each channel by its name: height x width, row 0 at the top. Raises ValueError for other kinds of EXR."""
    data = pathlib.Path(path).read_bytes()
    if data[:4] != b"v/1\x01":
        raise ValueError(f"{path}: not an EXR file")
    header: dict[str, bytes] = {}
    at = 8
    while data[at]:
        key, key_type, _ = data[at:at + 512].split(b"\0", 2)
        at += len(key) + len(key_type) + 2
        size, = struct.unpack_from("<i", data, at)
        header[key.decode()] = data[at + 4:at + 4 + size]
        at += 4 + size
    left, top, right, bottom = struct.unpack("<4i", header["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    compression = header["compression"][0]
    if compression not in _ROWS_A_BLOCK or "tiles" in header:
        raise ValueError(f"{path}: this kind of EXR is not read here")
    channels = _channels(header["channels"])
    pixels = {name: numpy.empty((height, width), kind) for name, kind in channels}
    rows = _ROWS_A_BLOCK[compression]
    offsets = struct.unpack_from(f"<{-(-height // rows)}Q", data, at + 1)
    for offset in offsets:
        first, size = struct.unpack_from("<ii", data, offset)
        block = _unpacked(data[offset + 8:offset + 8 + size],
                          width * min(rows, top + height - first) * sum(int(kind[2]) for _, kind in channels))
        for row in range(first - top, min(first - top + rows, height)):
            for name, kind in channels:
                pixels[name][row] = numpy.frombuffer(block, kind, width)
                block = block[width * int(kind[2]):]
    return pixels


def _channels(text: bytes) -> list[tuple[str, str]]:
    """(name, numpy's type) in the file's order."""
    found = []
    while text[0]:
        name, rest = text.split(b"\0", 1)
        found.append((name.decode(), _TYPES[rest[0]]))
        text = rest[16:]
    return found


def _unpacked(block: bytes, size: int) -> bytes:
    """ZIP stores differences of bytes, the first halves of pairs before the second; unless it does not pay."""
    if len(block) == size:
        return block
    differences = numpy.frombuffer(zlib.decompress(block), numpy.uint8).astype(numpy.int64)
    differences[1:] -= 128
    values = numpy.cumsum(differences).astype(numpy.uint8)
    half = (size + 1) // 2
    paired = numpy.empty(size, numpy.uint8)
    paired[0::2], paired[1::2] = values[:half], values[half:]
    return bytes(paired)

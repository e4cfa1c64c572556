#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders the seven Standard Procedural Databases and puts them side by side in one PNG.

usage: contact_sheet.py MIRRORBALL OUT.png [--side N]
"""
import argparse
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

HERE = pathlib.Path(__file__).resolve().parent
NAMES = ["balls", "gears", "mount", "rings", "teapot", "tetra", "tree"]
COLUMNS, GAP = 4, 4


def encode(value):
    """A linear value as an sRGB byte."""
    value = min(max(value, 0.0), 1.0)
    curved = 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055
    return int(255 * curved + 0.5)


def render(mirrorball, name, side, folder):
    """Rows of sRGB bytes, from the top."""
    scene, picture = folder / f"{name}.nff", folder / f"{name}.pfm"
    with open(scene, "w", encoding="utf-8") as out:
        subprocess.run([sys.executable, HERE / "spd.py", name], stdout=out, check=True)
    subprocess.run([mirrorball, "render", scene, "--size", str(side), "--aa", "grid:3",
                    "-o", picture], check=True, stdout=subprocess.DEVNULL)
    data = picture.read_bytes()[-12 * side * side:]
    values = struct.unpack(f"<{3 * side * side}f", data)
    rows = [bytes(map(encode, values[3 * side * y:3 * side * (y + 1)])) for y in range(side)]
    return rows[::-1]  # a PFM begins at the bottom


def write_png(path, rows, width):
    def chunk(kind, body):
        return (struct.pack(">I", len(body)) + kind + body
                + struct.pack(">I", zlib.crc32(kind + body)))

    header = struct.pack(">IIBBBBB", width, len(rows), 8, 2, 0, 0, 0)
    pixels = zlib.compress(b"".join(b"\0" + row for row in rows), 9)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", pixels)
                     + chunk(b"IEND", b""))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("mirrorball", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--side", type=int, default=220, help="of each picture, pixels")
    arguments = parser.parse_args()
    side = arguments.side
    width = COLUMNS * side + (COLUMNS - 1) * GAP
    blank = bytes([255]) * 3
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        pictures = [render(arguments.mirrorball, name, side, pathlib.Path(folder))
                    for name in NAMES]
    for first in range(0, len(pictures), COLUMNS):
        line = pictures[first:first + COLUMNS]
        line += [[blank * side] * side] * (COLUMNS - len(line))
        if rows:
            rows += [blank * width] * GAP
        rows += [(blank * GAP).join(parts) for parts in zip(*line)]
    write_png(arguments.out, rows, width)


if __name__ == "__main__":
    main()

# SPDX-License-Identifier: Apache-2.0
"""Enough of PNG and PFM to look at mirrorball's pictures: rows from the top, RGB per pixel."""
import struct
import zlib

PNG_SIGNATURE = b"\x89PNG\r\n\x1a\n"


def png_chunks(data):
    """(type, content) of every chunk, checksums verified; the last must be IEND."""
    if not data.startswith(PNG_SIGNATURE):
        raise ValueError("no PNG signature")
    chunks, at = [], 8
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        content = data[at + 8:at + 8 + length]
        (checksum,) = struct.unpack_from(">I", data, at + 8 + length)
        if zlib.crc32(kind + content) != checksum:
            raise ValueError(f"bad checksum in {kind}")
        chunks.append((kind, content))
        at += 12 + length
    if chunks[-1][0] != b"IEND":
        raise ValueError("no IEND at the end")
    return chunks


def png_texts(data):
    """The text chunks (tEXt, iTXt uncompressed) as a dictionary."""
    texts = {}
    for kind, content in png_chunks(data):
        if kind == b"tEXt":
            name, text = content.split(b"\0", 1)
            texts[name.decode()] = text.decode("latin-1")
        elif kind == b"iTXt":
            name, rest = content.split(b"\0", 1)
            texts[name.decode()] = rest[2:].split(b"\0", 2)[2].decode()
    return texts


def _paeth(a, b, c):
    p = a + b - c
    distances = (abs(p - a), abs(p - b), abs(p - c))
    return (a, b, c)[distances.index(min(distances))]


def _unfilter(kind, line, above, step):
    for i, value in enumerate(line):
        left = line[i - step] if i >= step else 0
        up_left = above[i - step] if i >= step else 0
        add = (0, left, above[i], (left + above[i]) // 2, _paeth(left, above[i], up_left))[kind]
        line[i] = (value + add) & 255


def read_png(path):
    """(width, height, bytes of RGB) of an 8-bit RGB picture."""
    chunks = png_chunks(path.read_bytes())
    width, height, depth, color, _, _, interlace = struct.unpack(">IIBBBBB", chunks[0][1])
    if (depth, color, interlace) != (8, 2, 0):
        raise ValueError(f"not plain 8-bit RGB: {depth} {color} {interlace}")
    raw = zlib.decompress(b"".join(content for kind, content in chunks if kind == b"IDAT"))
    stride = 3 * width
    above, rows = bytearray(stride), []
    for y in range(height):
        start = y * (stride + 1)
        line = bytearray(raw[start + 1:start + 1 + stride])
        _unfilter(raw[start], line, above, 3)
        rows.append(line)
        above = line
    return width, height, b"".join(rows)


def read_pfm(path):
    """(width, height, floats of RGB)."""
    data = path.read_bytes()
    kind, size, scale, pixels = data.split(b"\n", 3)
    width, height = map(int, size.split())
    if kind != b"PF" or len(pixels) != 12 * width * height:
        raise ValueError("not an RGB PFM of its size")
    order = "<" if float(scale) < 0 else ">"
    row = struct.Struct(f"{order}{3 * width}f")
    rows = [row.unpack_from(pixels, y * row.size) for y in reversed(range(height))]
    return width, height, [value for line in rows for value in line]


def cropped(width, values, x0, y0, x1, y1):
    """The part of an RGB picture, as a list of values."""
    part = []
    for y in range(y0, y1):
        part.extend(values[3 * (y * width + x0):3 * (y * width + x1)])
    return part

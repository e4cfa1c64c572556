# SPDX-License-Identifier: Apache-2.0
"""Enough of PNG, PFM and EXR to look at mirrorball's pictures: rows from the top, RGB per pixel."""
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


def _exr_attributes(data):
    """(attributes by name, where the table of offsets begins) of a single-part scanline file."""
    if data[:8] != b"\x76\x2f\x31\x01\x02\0\0\0":
        raise ValueError("no plain EXR file")
    attributes, at = {}, 8
    while data[at] != 0:
        name_end = data.index(0, at)
        name = data[at:name_end].decode()
        kind_end = data.index(0, name_end + 1)
        (size,) = struct.unpack_from("<i", data, kind_end + 1)
        at = kind_end + 5 + size
        attributes[name] = data[kind_end + 5:at]
    return attributes, at + 1


def _exr_block(packed, size):
    """Undoes the ZIP compression: differences of neighbors, then halves woven together."""
    if len(packed) == size:
        return packed
    raw = bytearray(zlib.decompress(packed))
    for i in range(1, len(raw)):
        raw[i] = (raw[i - 1] + raw[i] - 128) & 255
    half = (len(raw) + 1) // 2
    woven = bytearray(len(raw))
    woven[0::2], woven[1::2] = raw[:half], raw[half:]
    return bytes(woven)


def read_exr(path):
    """(width, height, {channel: rows of floats from the top}) of 32-bit floats under ZIP."""
    data = path.read_bytes()
    attributes, at = _exr_attributes(data)
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    names, rest = [], attributes["channels"]
    while rest[:1] != b"\0":
        name, _, rest = rest.partition(b"\0")
        if struct.unpack_from("<i", rest)[0] != 2:
            raise ValueError(f"{name} is not of 32-bit floats")
        names.append(name.decode())
        rest = rest[16:]
    if attributes["compression"] != b"\3":
        raise ValueError("not under ZIP")
    channels = {name: [] for name in names}
    for first in range(0, height, 16):
        (place,) = struct.unpack_from("<Q", data, at + 8 * (first // 16))
        rows = min(16, height - first)
        _, size = struct.unpack_from("<ii", data, place)
        block = _exr_block(data[place + 8:place + 8 + size], rows * width * 4 * len(names))
        for i in range(rows * len(names)):
            channels[names[i % len(names)]].append(
                list(struct.unpack_from(f"<{width}f", block, i * width * 4)))
    return width, height, channels

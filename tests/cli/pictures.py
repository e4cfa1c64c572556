# SPDX-License-Identifier: Apache-2.0
"""Picture files as arrays of height x width x channels, row 0 at the top, by other readers than the program's."""
import sys

import numpy
from PIL import Image

from program import ROOT

sys.path.append(str(ROOT / "python"))

from mirrorball import read_pfm
from mirrorball.exr import read_exr


def png(path):
    """An 8-bit RGB picture, whole and with right checksums."""
    assert path.read_bytes().endswith(b"IEND\xaeB`\x82"), path
    with Image.open(path) as picture:
        picture.load()
    assert (picture.format, picture.mode) == ("PNG", "RGB"), path
    return picture


def read_png(path):
    return numpy.asarray(png(path))


def png_texts(path):
    """The text chunks as a dictionary."""
    return png(path).text

# SPDX-License-Identifier: Apache-2.0
"""Writes Neutral File Format."""
import math

SKY = (0.078, 0.361, 0.753)


def numbers(*values):
    return " ".join(f"{value:.12g}" for value in values)


class Writer:
    """The resolution and angle are those of the databases, unless `corners` asks for the rays of
    their Readme's table: one through each corner of the 512 x 512 pixels, the centers of 513 x 513.
    """

    def __init__(self, stream, corners=False):
        self.stream = stream
        self.corners = corners

    def _line(self, *parts):
        self.stream.write(" ".join(parts) + "\n")

    def view(self, start, at, up=(0.0, 0.0, 1.0), angle=45.0, hither=1.0):
        side = 512
        if self.corners:
            half = math.tan(math.radians(angle / 2)) * (side + 1) / side
            angle = math.degrees(2 * math.atan(half))
            side += 1
        self._line("v")
        for name, vector in [("from", start), ("at", at), ("up", up)]:
            self._line(name, numbers(*vector))
        self._line("angle", numbers(angle))
        self._line("hither", numbers(hither))
        self._line("resolution", str(side), str(side))

    def background(self, color=SKY):
        self._line("b", numbers(*color))

    def light(self, position):
        self._line("l", numbers(*position))

    def fill(self, color, kd, ks=0.0, half_angle=0.0, t=0.0, ior=0.0):
        """half_angle: degrees from a highlight's middle to where it has half its strength."""
        shine = 100000.0
        if half_angle > 0:
            shine = math.log(0.5) / math.log(math.cos(math.radians(half_angle)))
        self._line("f", numbers(*color, kd, ks, shine, t, ior))

    def sphere(self, center, radius):
        self._line("s", numbers(*center, radius))

    def cone(self, base, base_radius, apex, apex_radius):
        self._line("c")
        self._line(numbers(*base, base_radius))
        self._line(numbers(*apex, apex_radius))

    def polygon(self, corners):
        self._line("p", str(len(corners)))
        for corner in corners:
            self._line(numbers(*corner))

    def patch(self, corners, normals):
        self._line("pp", str(len(corners)))
        for corner, normal in zip(corners, normals):
            self._line(numbers(*corner, *normal))

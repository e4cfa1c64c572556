# SPDX-License-Identifier: Apache-2.0
"""rings: a pyramid of knots of six pentagonal rings, seen from its tip; three lights, a wall."""
import math

from vectors import X, Z, add, rotated

USUAL = 7
RADIUS = 0.07412
COLOURS = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 1, 1), (1, 0, 1), (1, 1, 0)]


def knot():
    """Six pentagons that join the middles of a dodecahedron's edges, within a sphere of radius 1
    when dressed."""
    scale = 1 / (1 + RADIUS)
    fifth = 2 * math.pi / 5
    first = [(scale * math.cos(i * fifth), scale * math.sin(i * fifth), 0.0) for i in range(5)]
    tilt = 2 * math.acos(math.cos(math.pi / 3) / math.sin(math.pi / 5))
    others = [[rotated(rotated(v, X, tilt), Z, math.pi * (2 * i + 1) / 5) for v in first]
              for i in range(5)]
    return [first] + others


def write(out, size):
    spread = 1 / math.sin(math.pi / 8)
    eye = (-1, -spread, 0.5)
    out.background()
    out.view(eye, add(eye, (0, 1, 0)))
    for light in [(3, -spread, 3), (-4, -spread, 1), (2, -spread, -4)]:
        out.light(light)
    out.fill((1, 1, 1), 1)
    back = spread * (size + 1)
    half = 1.01 * (back - eye[1]) * math.tan(math.pi / 8)  # the view's angle and 1 %
    out.polygon([(x * half + eye[0], back, z * half + eye[2])
                 for x, z in [(1, 1), (-1, 1), (-1, -1), (1, -1)]])
    rings = knot()
    for depth in range(size):
        for iz in range(depth + 1):
            for ix in range(depth + 1):
                write_knot(out, rings, (2 * ix - depth, spread * (depth + 1), 2 * iz - depth))


def write_knot(out, rings, offset):
    for ring, color in zip(rings, COLOURS):
        out.fill(color, 0.5, 0.2, 37)
        points = [add(v, offset) for v in ring]
        for i, point in enumerate(points):
            out.cone(point, RADIUS, points[i - 1], RADIUS)
            out.sphere(point, RADIUS)

# SPDX-License-Identifier: Apache-2.0
"""balls, or sphereflake: each sphere carries nine of a third its radius; three lights, a floor."""
import math

from vectors import X, Y, Z, add, cross, dot, rotated, scaled, sub, unit

USUAL = 4
SHRINK = 1 / 3


def directions():
    """Where the nine stand on a parent that points up: three trios around the axis."""
    d = math.sqrt(0.5)
    tilt = math.asin(2 / math.sqrt(6))
    axis = unit(sub(X, Y))
    trio = [rotated(v, axis, tilt) for v in [(d, d, 0), (d, 0, -d), (0, d, -d)]]
    return [rotated(v, Z, turn * 2 * math.pi / 3) for turn in range(3) for v in trio]


def turned_to(direction, v):
    """v by the rotation that takes +z to the direction."""
    if direction[2] >= 0.9999:
        return v
    if direction[2] <= -0.9999:
        return rotated(v, Y, math.pi)
    return rotated(v, unit(cross(Z, direction)), math.acos(dot(Z, direction)))


def grow(out, nine, depth, center, radius, direction):
    out.sphere(center, radius)
    if depth == 0:
        return
    distance = radius * (1 + SHRINK)
    for v in nine:
        outward = turned_to(direction, v)
        grow(out, nine, depth - 1, add(center, scaled(outward, distance)), radius * SHRINK, outward)


def write(out, size):
    out.background()
    out.view((2.1, 1.3, 1.7), (0, 0, 0), hither=0.01)
    for light in [(4, 3, 2), (1, -4, 4), (-3, 1, 5)]:
        out.light(light)
    out.fill((1, 0.75, 0.33), 0.8, ior=1)
    out.polygon([(12, 12, -0.5), (-12, 12, -0.5), (-12, -12, -0.5), (12, -12, -0.5)])
    out.fill((1, 0.9, 0.7), 0.5, 0.5, 37, ior=1)
    grow(out, directions(), size, (0, 0, 0), 0.5, Z)

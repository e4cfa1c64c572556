# SPDX-License-Identifier: Apache-2.0
"""tree: branches that fork in two (Aono and Kunii 1984) on a field; seven lights."""
import math

from vectors import X, Z, add, rotated, scaled

USUAL = 11
TAPER = 0.67  # a branch's upper radius to its lower
LIGHTS = [(-5, 5, 50), (30, -30, 30), (-40, -30, 20), (10, 30, 40), (-30, 40, 10), (50, 25, 20),
          (-10, -60, 30)]
# Angle to the parent and about it, degrees; length to the parent's.
FORKS = [(40, 90, 0.65), (25, 230, 0.7)]


class Frame:
    """Where a branch stands: its foot, and what x, y and z of a branch become."""

    def __init__(self, foot, axes):
        self.foot, self.axes = foot, axes

    def vector(self, v):
        parts = [scaled(axis, amount) for axis, amount in zip(self.axes, v)]
        return add(add(parts[0], parts[1]), parts[2])

    def fork(self, angle, around, contraction):
        def turned(v):
            bent = rotated(rotated(v, X, math.radians(angle)), Z, math.radians(around))
            return self.vector(scaled(bent, contraction))

        return Frame(self.tip(), [turned(v) for v in [(1, 0, 0), (0, 1, 0), (0, 0, 1)]])

    def tip(self):
        return add(self.foot, self.axes[2])


def grow(out, frame, radius, depth):
    out.cone(frame.foot, radius, frame.tip(), radius * TAPER)
    out.sphere(frame.tip(), radius * TAPER)
    if depth > 0:
        for fork in FORKS:
            grow(out, frame.fork(*fork), radius * TAPER, depth - 1)


def write(out, size):
    out.background()
    out.view((4.5, 0.4, 2), (0, 0, 1.5))
    for light in LIGHTS:
        out.light(light)
    out.fill((0.2, 0.7, 0.2), 1)
    out.polygon([(50, 50, 0), (-50, 50, 0), (-50, -50, 0), (50, -50, 0)])
    out.fill((0.55, 0.4, 0.2), 1)
    grow(out, Frame((0, 0, 0), [(1, 0, 0), (0, 1, 0), (0, 0, 1)]), 0.15, size)

# SPDX-License-Identifier: Apache-2.0
"""gears: size^3 meshed gears, some of glass, over a mirroring ground; five lights."""
import math

USUAL = 4
TEETH = 36
RIM = 0.1        # of the radius: the teeth
CLEARANCE = 0.995  # of the radius: gears that mesh do not touch
# Angles of a tooth's four corners, of the tooth's angle, and whether they are on the outer circle.
PROFILE = [(-0.19, True), (0.19, True), (0.3, False), (0.7, False)]


def outline(center, turn, outer, inner):
    """A gear's corners, counterclockwise from above."""
    tooth = 2 * math.pi / TEETH
    corners = []
    for i in range(TEETH):
        for place, is_outer in PROFILE:
            angle = turn + (i + place) * tooth
            radius = outer if is_outer else inner
            corners.append((center[0] + radius * math.cos(angle),
                            center[1] + radius * math.sin(angle), center[2]))
    return corners


def gear(out, center, turn, outer, inner, thickness):
    top = outline(center, turn, outer, inner)
    bottom = [(x, y, z - thickness) for x, y, z in top]
    out.polygon(top)
    for i, corner in enumerate(top):
        j = (i + 1) % len(top)
        out.polygon([corner, bottom[i], bottom[j], top[j]])
    # Seen from below, and beginning on an outer edge: the first corner's turn is convex.
    below = bottom[::-1]
    out.polygon(below[2:] + below[:2])


def color(ix, iy, iz):
    def fraction(x):
        return x - math.floor(x)

    rgb = [0.01 + fraction((ix * 3 + iy * 2 + iz + 1) * 5 / 7),
           0.01 + fraction((iy * 3 + iz * 2 + ix + 1) * 3 / 7),
           0.01 + fraction((iz * 3 + ix * 2 + iy + 1) * 2 / 7)]
    return [c / max(rgb) for c in rgb]


def write(out, size):
    out.background()
    out.view((-1.1, -2.1, 2.6), (0, 0, 0))
    for light in [(2, 4, 4), (-2, 4, 3), (2, -2.5, 2.5), (-1, -4, 2), (-1.111, -2.121, 2.626)]:
        out.light(light)
    out.fill((1, 0.85, 0.7), 0.3, 0.6, 37)
    out.polygon([(2, 2, 0), (-2, 2, 0), (-2, -2, 0), (2, -2, 0)])
    radius = 1 / (size - (size - 1) * RIM / 2)
    thickness = min(0.1, 1 / (2 * size))
    for iz in range(size):
        for iy in range(size):
            for ix in range(size):
                if (ix * 4 + iy * 2 + iz) % 5 == 0:
                    out.fill(color(ix, iy, iz), 0.2, t=0.8, ior=1.1)
                else:
                    out.fill(color(ix, iy, iz), 1)
                center = (-1 + radius + ix * radius * (2 - RIM),
                          -1 + radius + iy * radius * (2 - RIM), 1 - iz / size)
                turn = math.pi / TEETH * ((ix + iy + iz) % 2)
                gear(out, center, turn, CLEARANCE * radius, (1 - RIM) * radius, thickness)

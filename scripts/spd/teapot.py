# SPDX-License-Identifier: Apache-2.0
"""teapot: Martin Newell's teapot with Frank Crow's bottom on a checkerboard; two lights.

Its 32 Bezier patches (Crow, IEEE CG&A, January 1987) are quarters of bodies of revolution and
halves of tubes, so that radii, heights and outlines say it all.
"""
from vectors import add, cross, dot, scaled, unit

USUAL = 12
CIRCLE = 0.56  # how far a quarter circle's inner control points are along the tangents

# (radius, z) of the four control rings, from the first row to the last.
RIM = [(1.4, 2.4), (1.3375, 2.53125), (1.4375, 2.53125), (1.5, 2.4)]
SHOULDER = [(1.5, 2.4), (1.75, 1.875), (2, 1.35), (2, 0.9)]
BELLY = [(2, 0.9), (2, 0.45), (1.5, 0.225), (1.5, 0.15)]
KNOB = [(0, 3.15), (0.8, 3.15), (0, 2.85), (0.2, 2.7)]
LID = [(0.2, 2.7), (0.4, 2.55), (1.3, 2.55), (1.3, 2.4)]
BOTTOM = [(0, 0), (1.425, 0), (1.5, 0.075), (1.5, 0.15)]

# (x, z) on both sides of a tube, and half its width, row by row.
HANDLE = [
    [((-1.6, 2.025), (-1.5, 2.25), 0.3), ((-2.3, 2.025), (-2.5, 2.25), 0.3),
     ((-2.7, 2.025), (-3, 2.25), 0.3), ((-2.7, 1.8), (-3, 1.8), 0.3)],
    [((-2.7, 1.8), (-3, 1.8), 0.3), ((-2.7, 1.575), (-3, 1.35), 0.3),
     ((-2.5, 1.125), (-2.65, 0.9375), 0.3), ((-2, 0.9), (-1.9, 0.6), 0.3)],
]
SPOUT = [
    [((1.7, 1.425), (1.7, 0.6), 0.66), ((2.6, 1.425), (3.1, 0.825), 0.66),
     ((2.3, 2.1), (2.4, 2.025), 0.25), ((2.7, 2.4), (3.3, 2.4), 0.25)],
    [((2.7, 2.4), (3.3, 2.4), 0.25), ((2.8, 2.475), (3.525, 2.49375), 0.25),
     ((2.9, 2.475), (3.45, 2.5125), 0.15), ((2.8, 2.4), (3.2, 2.4), 0.15)],
]


def quarters(rings, sense=-1):
    """The four patches of a body of revolution, going round clockwise (-1) or the other way."""
    patches = []
    for quarter in range(4):
        rows = []
        for radius, z in rings:
            k = 0.5625 if radius == 0.8 else CIRCLE  # Newell's knob is a little rounder
            row = [(radius, 0), (radius, sense * k * radius), (k * radius, sense * radius),
                   (0, sense * radius)]
            for _ in range(quarter):
                row = [(-sense * y, sense * x) for x, y in row]
            rows.append([(x, y, z) for x, y in row])
        patches.append(rows)
    return patches


def halves(rows):
    """The two patches of a piece of tube."""
    def row(a, b, width, side):
        points = [(a, 0), (a, side * width), (b, side * width), (b, 0)]
        return [(x, y, z) for (x, z), y in points]

    return [[row(a, b, width, -1) for a, b, width in rows],
            [row(b, a, width, 1) for a, b, width in rows]]


def patches():
    body = quarters(RIM) + quarters(SHOULDER) + quarters(BELLY)
    tubes = [patch for part in HANDLE + SPOUT for patch in halves(part)]
    return body + tubes + quarters(KNOB) + quarters(LID) + quarters(BOTTOM, 1)


def bernstein(t):
    u = 1 - t
    return (u * u * u, 3 * u * u * t, 3 * u * t * t, t * t * t)


def slopes(t):
    u = 1 - t
    return (-3 * u * u, 3 * u * u - 6 * u * t, 6 * u * t - 3 * t * t, 3 * t * t)


def blend(patch, rows, columns):
    total = (0.0, 0.0, 0.0)
    for row, weight in zip(patch, rows):
        for point, share in zip(row, columns):
            total = add(total, scaled(point, weight * share))
    return total


def point_and_normal(patch, s, t):
    point = blend(patch, bernstein(s), bernstein(t))
    normal = cross(blend(patch, bernstein(s), slopes(t)), blend(patch, slopes(s), bernstein(t)))
    if is_tip(point):
        return point, (0, 0, 1 if point[2] > 1.5 else -1)
    return point, unit(normal) if dot(normal, normal) > 0 else (0, 0, 1)


def is_tip(point):
    """On the axis, where the knob and the bottom come to a point."""
    return abs(point[0]) < 1e-4 and abs(point[1]) < 1e-4


def write_patch(out, patch, size):
    grid = [[point_and_normal(patch, i / size, j / size) for j in range(size + 1)]
            for i in range(size + 1)]
    for i in range(size):
        for j in range(size):
            a, b, c, d = grid[i][j], grid[i][j + 1], grid[i + 1][j + 1], grid[i + 1][j]
            for triangle in [(a, b, c), (c, d, a)]:
                if sum(is_tip(point) for point, _ in triangle) < 2:
                    out.patch([point for point, _ in triangle], [n for _, n in triangle])


def write_board(out, size):
    def place(i):
        return 4 * (2 * i / size - 1)

    for color, odd in [((1, 1, 1), 1), ((0.5, 0.5, 0.5), 0)]:
        out.fill(color, 0.5, 0.5, 30)
        for i in range(size):
            for j in range(size):
                if (i + j) % 2 == odd:
                    x, x1, y, y1 = place(i), place(i + 1), place(j), place(j + 1)
                    out.polygon([(x, y, 0), (x1, y, 0), (x1, y1, 0), (x, y1, 0)])


def write(out, size):
    out.background()
    out.view((4.86, 7.2, 5.4), (0, 0, 0))
    out.light((-3.1, 9.8, 12.1))
    out.light((11.3, 5.1, 8.8))
    write_board(out, size)
    out.fill((1, 0.5, 0.1), 0.75, 0.25, 37)
    for patch in patches():
        write_patch(out, patch, size)

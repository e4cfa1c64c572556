# SPDX-License-Identifier: Apache-2.0
"""mount: a fractal mountain (Carpenter's, on a square grid) with four glass spheres; one light."""
import math

from vectors import Z, add, rotated, unit

USUAL = 6
DIMENSION = 2.2
SEED = 21
CORNER, WIDTH = -1.0, 2.0
MODULUS = 134456


def gauss(seed):
    """A normal deviate by the polar method from a linear congruential generator (Numerical
    Recipes' portable pair), so that every machine grows the same mountain."""
    value = seed
    while True:
        first = (28411 + value * 8121) % MODULUS
        value = (28411 + first * 8121) % MODULUS
        x, y = 2 * first / MODULUS - 1, 2 * value / MODULUS - 1
        r = x * x + y * y
        if 0 < r < 1:
            return x * math.sqrt(-2 * math.log(r) / r)


def seed_at(x, y, size):
    """The published hash of a grid point, patterns and all."""
    def moved(value, bits):
        return value << bits if bits >= 0 else value >> -bits

    return SEED + ((moved(x, 23 - size) + moved(y, 15 - size) + moved(x, 7 - size)) & 0xFFFF)


def heights(size):
    """z on the grid of 2^size + 1 points a side, by midpoints."""
    points = 1 << size
    ratio = 2 / math.exp(math.log(2) / (DIMENSION - 1))
    roughness = math.sqrt(ratio * ratio - 1)
    z = [[0.0] * (points + 1) for _ in range(points + 1)]
    width = points
    while width > 1:
        half = width // 2
        rise = half * WIDTH / points * roughness
        for y in range(0, points, width):
            for x in range(0, points, width):
                lift(z, x, y, width, rise, size)
        width = half
    return z


def lift(z, x, y, width, rise, size):
    """Sets the middles of a square's sides and its own; z[y][x]."""
    half, x1, y1 = width // 2, x + width, y + width

    def noise(px, py):
        return rise * gauss(seed_at(px, py, size))

    z[y][x + half] = (z[y][x] + z[y][x1]) / 2 + noise(x + half, y)
    z[y + half][x1] = (z[y][x1] + z[y1][x1]) / 2 + noise(x1, y + half)
    z[y1][x + half] = (z[y1][x1] + z[y1][x]) / 2 + noise(x + half, y1)
    z[y + half][x] = (z[y1][x] + z[y][x]) / 2 + noise(x, y + half)
    z[y + half][x + half] = ((z[y][x] + z[y][x1] + z[y1][x1] + z[y1][x]) / 4
                             + 1.4142136 * noise(x + half, y + half))


def spheres(out, center, radius):
    """A pyramid of four that touch."""
    up = (0, 0, radius * math.sqrt(1.5))
    out.sphere(add(center, up), radius)
    side = rotated(up, unit((1, 1, 0)), math.acos(-1 / 3))
    for i in range(3):
        out.sphere(add(center, rotated(side, Z, i * 2 * math.pi / 3)), radius)


def write(out, size):
    out.background()
    out.view((-1.6, 1.6, 1.7), (0, 0, 0), hither=0.01)
    out.light((-100, -100, 100))
    out.fill((1, 1, 1), 0.1, 0.1, 6.7, 0.9, 1.5)
    spheres(out, (-0.8, 0.8, 1), 0.17)
    out.fill((0.5, 0.45, 0.35), 1)
    z = heights(size)
    points = 1 << size

    def corner(x, y):
        return (CORNER + x * WIDTH / points, CORNER + y * WIDTH / points, z[y][x])

    for y in range(points):
        for x in range(points):
            a, b, c, d = corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)
            out.polygon([a, b, c])
            out.polygon([c, d, a])

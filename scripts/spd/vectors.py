# SPDX-License-Identifier: Apache-2.0
"""Vectors as tuples, rotations as three columns; angles in radians, counterclockwise."""
import math


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def scaled(a, factor):
    return (a[0] * factor, a[1] * factor, a[2] * factor)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return scaled(a, 1 / math.sqrt(dot(a, a)))


def rotated(v, axis, angle):
    """v turned about a unit axis (Rodrigues)."""
    along = scaled(axis, dot(axis, v) * (1 - math.cos(angle)))
    across = scaled(cross(axis, v), math.sin(angle))
    return add(add(scaled(v, math.cos(angle)), across), along)


X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)

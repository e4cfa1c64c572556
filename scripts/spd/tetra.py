# SPDX-License-Identifier: Apache-2.0
"""tetra: a tetrahedron of four half as large, and so on; one light."""
from vectors import add, scaled

USUAL = 6
# Four corners of a cube that make a tetrahedron.
CORNERS = [(-1, -1, 1), (-1, 1, -1), (1, -1, -1), (1, 1, 1)]
FACES = [(0, 1, 2), (3, 2, 1), (2, 3, 0), (1, 0, 3)]


def grow(out, depth, center, half):
    if depth > 1:
        for corner in CORNERS:
            grow(out, depth - 1, add(center, scaled(corner, half / 2)), half / 2)
        return
    corners = [add(center, scaled(corner, half)) for corner in CORNERS]
    for face in FACES:
        out.polygon([corners[i] for i in face])


def write(out, size):
    out.background()
    out.view((1.022846, -3.177154, -2.174512), (-0.004103, -0.004103, 0.216539),
             (-0.816497, -0.816497, 0.816497))
    out.light((2, -18, -5))
    out.fill((1, 0.2, 0.2), 1)
    grow(out, size, (0, 0, 0), 1)

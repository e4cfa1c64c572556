#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes a large scene, so that none has to be stored.

  sphere-flake DEPTH    mirror balls, each carrying nine a third its size: 1 + 9 + 81 + ...
  bumpy-mesh N          a bumpy ring of N triangles (N even) on a mirror floor, with mirror balls;
                        the mesh goes into a .ply file next to the scene; --mirror: makes the
                        mesh a mirror, too
"""
import argparse
import array
import json
import math
import pathlib
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "spd"))
sys.dont_write_bytecode = True

import balls
import vectors

MIRROR = {"ambient": 0.1, "diffuse": [0.25, 0.24, 0.2], "specular": 0.5, "shininess": 60,
          "mirror": [0.7, 0.68, 0.6]}
FLOOR = {"ambient": 0.3, "diffuse": [0.35, 0.3, 0.25], "mirror": 0.3, "two_sided": True}
CLAY = {"ambient": [0.5, 0.3, 0.2], "diffuse": [0.7, 0.4, 0.25], "specular": 0.2, "shininess": 30,
        "two_sided": True}

POLISHED = {"ambient": [0.25, 0.15, 0.1], "diffuse": [0.35, 0.2, 0.12], "specular": 0.4,
            "shininess": 60, "mirror": 0.5, "two_sided": True}


def scene(name, camera_from, camera_at, **more):
    camera = {"from": camera_from, "at": camera_at, "fov_degrees": 40}
    return {"name": name, "camera": camera, "image": {"width": 512, "height": 512},
            "background": [0.35, 0.5, 0.75], "ambient_light": 0.3,
            "lights": [{"position": [4, 6, 5], "intensity": 0.6},
                       {"position": [-5, 4, 2], "intensity": 0.4}], **more}


def floor_triangles(y, half=12):
    corners = [[-half, y, half], [half, y, half], [half, y, -half], [-half, y, -half]]
    return [{"vertices": [corners[i] for i in face], "material": "floor"}
            for face in [(0, 1, 2), (2, 3, 0)]]


def sphere(center, radius, material="mirror"):
    return {"center": [round(c, 9) for c in center], "radius": radius, "material": material}


class Spheres:
    """What the sphereflake of the Standard Procedural Databases writes to; z becomes up, y."""

    def __init__(self):
        self.list = []

    def sphere(self, center, radius):
        x, y, z = center
        self.list.append(sphere((x, z, -y), radius))


def sphere_flake(depth, *_):
    flake = Spheres()
    balls.grow(flake, balls.directions(), depth, (0, 0, 0), 0.5, vectors.Z)
    return scene("sphere-flake", [2.1, 1.7, 2.3], [0, 0, 0],
                 materials={"mirror": MIRROR, "floor": FLOOR}, spheres=flake.list,
                 triangles=floor_triangles(-0.5))


def mesh_sides(triangles):
    """Two whole numbers, one about twice the other where that can be, with that many cells."""
    cells, odd = divmod(triangles, 2)
    for side in range(max(3, int(math.sqrt(cells / 2))), 2, -1):
        if not odd and cells % side == 0:
            return side, cells // side
    raise SystemExit(f"bumpy-mesh {triangles}: give an even number with more divisors, 18 or more")


def ring_points(around, along):
    """Points of a bumpy torus that stands on y = 0, x y z x y z ..., row by row."""
    waves = [(math.cos(a), math.sin(a), math.sin(5 * a), math.sin(23 * a))
             for a in (2 * math.pi * i / around for i in range(around))]
    points = array.array("f")
    for j in range(along):
        b = 2 * math.pi * j / along
        cos_b, sin_b, coarse, fine = math.cos(b), math.sin(b), math.sin(9 * b), math.sin(61 * b)
        for cos_a, sin_a, coarse_a, fine_a in waves:
            radius = 0.4 * (1 + 0.12 * coarse * coarse_a + 0.03 * fine * fine_a)
            out = 1 + radius * cos_a
            points.extend((out * cos_b, 0.46 + radius * sin_a, out * sin_b))
    return points


def ring_faces(around, along):
    """Rows of faces: three indices of points a triangle, one after the other."""
    for j in range(along):
        start, other = j * around, (j + 1) % along * around
        numbers = []
        for i in range(around):
            k = i + 1 if i + 1 < around else 0
            a, b, c, d = start + i, start + k, other + k, other + i
            numbers += (a, b, c, c, d, a)
        yield numbers


def write_ring(path, triangles):
    around, along = mesh_sides(triangles)
    points = ring_points(around, along)
    if sys.byteorder == "big":
        points.byteswap()
    row = struct.Struct("<" + "Biii" * (2 * around))
    with open(path, "wb") as file:
        file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {around * along}\n"
                   "property float x\nproperty float y\nproperty float z\n"
                   f"element face {2 * around * along}\n"
                   "property list uchar int vertex_indices\nend_header\n".encode())
        points.tofile(file)
        for corners in ring_faces(around, along):
            numbers = []
            for i in range(0, len(corners), 3):
                numbers += (3, *corners[i:i + 3])
            file.write(row.pack(*numbers))


def bumpy_mesh(triangles, output, mirror):
    material = "polished" if mirror else "clay"
    materials = {"mirror": MIRROR, "floor": FLOOR, material: POLISHED if mirror else CLAY}
    around = [sphere((1.9 * math.cos(a), 0.3, 1.9 * math.sin(a)), 0.3)
              for a in (2 * math.pi * i / 7 for i in range(7))]
    mesh = output.with_suffix(".ply")
    write_ring(mesh, triangles)
    return scene("bumpy-mesh", [2.6, 2.4, 3.8], [0, 0.2, 0], materials=materials,
                 spheres=around + [sphere((0, 0.4, 0), 0.4)], triangles=floor_triangles(0),
                 meshes=[{"file": mesh.name, "material": material}])


SCENES = {"sphere-flake": (sphere_flake, 0, 7), "bumpy-mesh": (bumpy_mesh, 18, 200000000)}


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name", choices=SCENES)
    parser.add_argument("size", type=int)
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, help="scene file, .json")
    parser.add_argument("--mirror", action="store_true", help="bumpy-mesh: the mesh is a mirror")
    arguments = parser.parse_args()
    make, least, most = SCENES[arguments.name]
    if not least <= arguments.size <= most:
        parser.error(f"size of {arguments.name}: give {least} to {most}")
    if arguments.output.suffix != ".json":
        parser.error("-o: name a .json file")
    if arguments.mirror and arguments.name != "bumpy-mesh":
        parser.error("--mirror is for bumpy-mesh")
    result = make(arguments.size, arguments.output, arguments.mirror)
    with open(arguments.output, "w", encoding="utf-8") as file:
        json.dump(result, file, separators=(",", ":"))
        file.write("\n")


if __name__ == "__main__":
    main()

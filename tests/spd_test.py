#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Scenes written by scripts/spd and scripts/generate."""
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

from program import ROOT, run

# The table "Database Analysis" in the Readme of SPD 3.14, and the heads of its programs.
USUAL = {
    "balls": (4, {"s": 7381, "p": 1}, 3),
    "gears": (4, {"p": 9345}, 5),
    "mount": (6, {"s": 4, "p": 8192}, 1),
    "rings": (7, {"s": 4200, "c": 4200, "p": 1}, 3),
    "teapot": (12, {"pp": 9120, "p": 144}, 2),
    "tetra": (6, {"p": 4096}, 1),
    "tree": (11, {"s": 4095, "c": 4095, "p": 1}, 7),
}
TOTAL = {"balls": 7382, "gears": 9345, "mount": 8196, "rings": 8401, "teapot": 9264,
         "tetra": 4096, "tree": 8191}
SMALL = {
    "balls": {1: {"s": 10, "p": 1}, 2: {"s": 91, "p": 1}, 3: {"s": 820, "p": 1}},
    "gears": {1: {"p": 147}, 2: {"p": 1169}, 3: {"p": 3943}},
    "mount": {1: {"s": 4, "p": 8}, 2: {"s": 4, "p": 32}, 3: {"s": 4, "p": 128}},
    "rings": {1: {"s": 30, "c": 30, "p": 1}, 2: {"s": 150, "c": 150, "p": 1}},
    "teapot": {1: {"pp": 56, "p": 1}, 2: {"pp": 240, "p": 4}, 3: {"pp": 552, "p": 9}},
    "tetra": {1: {"p": 4}, 2: {"p": 16}, 3: {"p": 64}},
    "tree": {1: {"s": 3, "c": 3, "p": 1}, 2: {"s": 7, "c": 7, "p": 1}, 3: {"s": 15, "c": 15, "p": 1}},
}


def script(name, *arguments):
    """What a script prints; it must say nothing else."""
    result = subprocess.run([sys.executable, ROOT / "scripts" / name, *map(str, arguments)], capture_output=True,
                            text=True, check=True)
    assert result.stderr == ""
    return result.stdout


def written(name, *options):
    return script("spd/spd.py", name, *options)


def info_of(path):
    return json.loads(run("scene", "info", path, "--json").stdout)


def entities(text):
    """(letter, numbers) of every entity but the view; the view's parts by their names."""
    found, words = [], []
    for line in text.splitlines():
        parts = line.split("#")[0].split()
        if not parts:
            continue
        if parts[0][0].isalpha():
            words = []
            found.append((parts[0], words))
            parts = parts[1:]
        words.extend(float(p) for p in parts)
    return found


def counts(text):
    result = {}
    for letter, _ in entities(text):
        if letter in ("s", "c", "p", "pp"):
            result[letter] = result.get(letter, 0) + 1
    return result


class Databases(unittest.TestCase):
    def test_usual_sizes(self):
        for name, (_, expected, lights) in USUAL.items():
            with self.subTest(name=name):
                text = written(name)
                self.assertEqual(counts(text), expected)
                self.assertEqual(sum(expected.values()), TOTAL[name])
                self.assertEqual(sum(letter == "l" for letter, _ in entities(text)), lights)
                self.assert_accepted(name, text)

    def test_counts_are_the_published_ones(self):
        for name, sizes in SMALL.items():
            for size, expected in sizes.items():
                with self.subTest(name=name, size=size):
                    text = written(name, "--size", size)
                    self.assertEqual(counts(text), expected)
                    self.assert_accepted(name, text)

    def assert_accepted(self, name, text):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, f"{name}.nff")
            path.write_text(text, encoding="utf-8")
            check = run("scene", "check", path)
            self.assertRegex(
                check.stderr,
                r"^(mirrorball: .*:\d+:\d+: zero-area polygon.* \(\d+ polygons ignored\)\n)?$",
            )
            info = info_of(path)
        expected = counts(text)
        self.assertEqual(info["spheres"], expected.get("s", 0))
        self.assertEqual(info["cones"], expected.get("c", 0))
        polygons = expected.get("p", 0) + expected.get("pp", 0)
        degenerate = 3 if polygons == 57 else 0  # of the teapot's, size 1
        self.assertGreaterEqual(info["triangles"], polygons - degenerate)
        self.assertEqual((info["width"], info["max_bounces"]), (512, 4))

    def test_float_is_near_double(self):
        """The small mirror balls had an RMSE of 1.8e-3 before sphere_normal. docs/spd.md has all databases."""
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder, "scene.nff")
            scene.write_text(written("balls"), encoding="utf-8")
            for precision in ["float", "double"]:
                result = run("render", scene, "--size", 160, "-q", "--aa", "none", "--device", "threads",
                             "--precision", precision, "-o", f"{folder}/{precision}.pfm")
                self.assertEqual(result.stderr, "")
            error = json.loads(run("compare", f"{folder}/float.pfm", f"{folder}/double.pfm", "--json").stdout)["error"]
            self.assertLessEqual(error["rmse"], 1e-3)
            self.assertLessEqual(error["pixels_over_8_255"], 1e-3 * 160 * 160)

    def test_corner_rays_are_those_of_513_pixels(self):
        text = written("tetra", "--size", 1, "--corners")
        view = dict(entities(text))
        self.assertEqual(view["resolution"], [513, 513])
        half = math.tan(math.radians(view["angle"][0] / 2))
        self.assertAlmostEqual(half * 512 / 513, math.tan(math.radians(22.5)))


class Generated(unittest.TestCase):
    def generate(self, folder, name, size):
        path = pathlib.Path(folder, f"{name}.json")
        script("generate/generate.py", name, size, "-o", path)
        return path

    def test_balls_are_as_many_as_they_should_be(self):
        with tempfile.TemporaryDirectory() as folder:
            path = self.generate(folder, "sphere-flake", 3)
            self.assertEqual(info_of(path)["spheres"], 820)

    def test_mesh_is_closed_and_has_as_many_triangles_as_asked_for(self):
        for triangles in [18, 1000, 20000]:
            with self.subTest(triangles=triangles), tempfile.TemporaryDirectory() as folder:
                path = self.generate(folder, "bumpy-mesh", triangles)
                meshes = json.loads(path.read_text(encoding="utf-8"))["meshes"]
                self.assertEqual([mesh["file"] for mesh in meshes], ["bumpy-mesh.ply"])
                self.assert_closed(path.with_suffix(".ply").read_bytes(), triangles)
                self.assertEqual(run("scene", "check", path).stderr, "")
                info = info_of(path)
                self.assertEqual((info["mesh_triangles"], info["notes"]), (triangles, []))

    def assert_closed(self, ply, triangles):
        head, body = ply.split(b"end_header\n", 1)
        self.assertIn(f"element face {triangles}\n".encode(), head)
        vertices = triangles // 2
        self.assertEqual(len(body), 12 * vertices + 13 * triangles)
        edges = set()
        for corners, a, b, c in struct.iter_unpack("<Biii", body[12 * vertices:]):
            self.assertEqual(corners, 3)
            edges |= {(a, b), (b, c), (c, a)}
        self.assertEqual(len(edges), 3 * triangles)
        self.assertEqual({(b, a) for a, b in edges}, edges)
        self.assertLess(max(a for a, _ in edges), vertices)


if __name__ == "__main__":
    unittest.main(verbosity=2)

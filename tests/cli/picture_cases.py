# SPDX-License-Identifier: Apache-2.0
"""Picture files: what is in them, and that it is always the same."""
import math
import re

import numpy

from harness import GRAY, CliTest, scene_path
from pictures import png_texts, read_pfm, read_png

SMALL = ["--size", "24x18", "--device", "threads"]


def display_byte(value):
    return math.floor(255 * min(max(value, 0.0), 1.0) + 0.5)


def srgb_byte(value):
    value = min(max(value, 0.0), 1.0)
    curve = 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055
    return math.floor(255 * curve + 0.5)


class Pixels(CliTest):
    def picture(self, scene, name, *arguments):
        self.render(scene, "-o", name, *SMALL, *arguments)
        return self.folder / name

    def test_png_is_the_clamped_rounded_film(self):
        film = read_pfm(self.picture("cornell-box", "film.pfm"))
        for options, byte in [([], display_byte), (["--encoding", "srgb"], srgb_byte),
                              (["--encoding", "linear"], display_byte)]:
            with self.subTest(options=options):
                png = read_png(self.picture("cornell-box", "out.png", *options))
                self.assertEqual((film.shape, png.shape), ((18, 24, 3), (18, 24, 3)))
                self.assertEqual(list(png.flat), [byte(float(value)) for value in film.flat])

    def test_first_row_is_the_top_and_first_column_the_left(self):
        scene = self.write_scene(
            ambient_light=1, materials={"gray": GRAY},
            spheres=[{"center": [-1, 1, 0], "radius": 0.4, "material": "gray"}])
        for read, name in [(read_png, "out.png"), (read_pfm, "out.pfm")]:
            values = read(self.picture(scene, name))
            self.assertTrue(values.any(), name)
            self.assertFalse(values[9:].any() or values[:, 12:].any(), name)


class Crop(CliTest):
    def check_parts(self, boxes, *options):
        for device in ["threads", "pocl"]:
            self.render("cornell-box", "-o", "whole.pfm", "--device", device, *options)
            whole = read_pfm(self.folder / "whole.pfm")
            for box in boxes:
                x0, y0, x1, y1 = box
                with self.subTest(device=device, box=box):
                    self.render("cornell-box", "-o", "part.pfm", "--device", device, *options,
                                "--crop", ",".join(map(str, box)))
                    part = read_pfm(self.folder / "part.pfm")
                    self.assertEqual(part.tolist(), whole[y0:y1, x0:x1].tolist())

    def test_is_that_part_of_the_whole(self):
        self.check_parts([(0, 0, 31, 23), (5, 3, 17, 20), (30, 22, 31, 23), (0, 10, 31, 11)],
                         "--size", "31x23")

    def test_has_the_pixels_of_the_whole_where_neighbors_decide(self):
        for aa in ["adaptive:0.01", "edges:0.01"]:
            self.check_parts([(5, 3, 37, 20), (60, 22, 61, 23), (0, 30, 61, 33), (20, 20, 41, 47)],
                             "--size", "61x47", "--aa", aa)

    def test_of_the_buffers_schedule_and_odd_tiles(self):
        options = ["--size", "31x23", "--crop", "5,3,17,20"]
        hashes = {self.hash_of("cornell-box", *options, *more) for more in [
            [], ["--tile", "5x4"], ["--device", "threads", "--schedule", "buffers"],
            ["--device", "threads", "--tile", "7x2"], ["--launch", "sample", "--tile", "3"]]}
        self.assertEqual(len(hashes), 1)

    def test_outside_of_the_picture_is_refused_before_what_follows_from_it(self):
        self.render("single-sphere", "--size", "8", "-o", "small.png")
        for more in [["--reference", "small.png"], ["-o", "out.webp"]]:
            self.assert_refused(self.run_cli("render", scene_path("single-sphere"), "--size", "32", "-q",
                                             "--crop", "0,0,200000,2", *more), 2, "--crop extends to 200000,2")


class Bytes(CliTest):
    def test_same_file_on_every_run_and_device(self):
        for ending in ["png", "exr", "pfm"]:
            files = set()
            for i, device in enumerate(["pocl", "pocl", "threads:1", "threads:3"]):
                name = f"{i}.{ending}"
                self.render("mirror-hall", "--size", "20x15", "--device", device, "-o", name)
                files.add(self.bytes_of(name))
            with self.subTest(ending=ending):
                self.assertEqual(len(files), 1)


class Metadata(CliTest):
    def test_png_tells_scene_settings_and_hash(self):
        result = self.render("single-sphere", *SMALL, "-o", "out.png")
        texts = png_texts(self.folder / "out.png")
        self.assertEqual(texts["mirrorball:Scene"], "single-sphere")
        self.assertRegex(texts["mirrorball:SceneHash"], "^[0-9a-f]{16}$")
        self.assertIn(texts["mirrorball:ImageHash"], result.stderr)
        for setting in ["24x18", "grid:2", "float", "strict"]:
            self.assertIn(setting, texts["mirrorball:Settings"])

    def test_no_dates_or_paths(self):
        for name in ["out.png", "out.exr"]:
            self.render("single-sphere", *SMALL, "-o", name)
            data = self.bytes_of(name)
            with self.subTest(name=name):
                self.assertIsNone(re.search(rb"20\d\d[:-]\d\d[:-]\d\d", data))
                self.assertNotIn(str(self.folder).encode(), data)
                self.assertNotIn(b"capDate", data)


class NotFinite(CliTest):
    """Light times diffuse is 4e39: too much for a float, exit 6, and the picture is there."""

    def setUp(self):
        super().setUp()
        self.scene = self.write_scene(
            lights=4000 * [{"position": [0, 0, 9], "intensity": 1e30}],
            materials={"hot": {"diffuse": 1e6}},
            spheres=[{"center": [0, 0, 0], "radius": 0.5, "material": "hot"}])

    def assert_reported(self, *arguments):
        result = self.run_cli("render", self.scene, "--size", "9", "-o", "out.pfm", *arguments)
        self.assertEqual(result.returncode, 6, result.stderr)
        message = result.stderr.splitlines()[-1]
        self.assertRegex(message, r"^mirrorball: \d+ pixels? .*not finite.* \d+,\d+")
        rows, columns, _ = (~numpy.isfinite(read_pfm(self.folder / "out.pfm"))).nonzero()
        self.assertIn(f" {columns[0]},{rows[0]}", message)

    def test_has_no_estimate(self):
        self.assert_reported("--estimate", "--device", "threads")
        result = self.run_cli("render", self.scene, "--size", "9", "--target-rmse", "1e-2")
        self.assertEqual(result.returncode, 6, result.stderr)
        self.assertNotIn("no error found", result.stderr)

    def test_on_every_device(self):
        for options in [["threads"], ["pocl"], ["threads", "--precision", "double"]]:  # its float file overflows
            self.assert_reported("--device", *options)

    def test_place_in_a_crop_is_told_in_pixels_of_the_whole_picture(self):
        result = self.run_cli("render", self.scene, "--size", "9", "--aa", "none", "--crop",
                              "4,4,5,5")
        self.assertEqual(result.returncode, 6, result.stderr)
        self.assertIn("4,4", result.stderr.splitlines()[-1])

    def test_light_that_a_mirror_does_not_reflect_is_black(self):
        scene = self.write_scene(
            lights=4000 * [{"position": [0, 0, 9], "intensity": 1e30}],
            materials={"hot": {"diffuse": [0, 1e6, 0]}, "red": {"diffuse": 0, "mirror": [1, 0, 0]}},
            spheres=[{"center": [0, 0, 7], "radius": 0.5, "material": "hot"},
                     {"center": [0, 0, 0], "radius": 0.5, "material": "red"}])
        self.succeed("render", scene, "--size", "9", "--aa", "none", "--crop", "4,4,5,5",
                     "-o", "out.pfm")
        self.assertFalse(read_pfm(self.folder / "out.pfm").any())

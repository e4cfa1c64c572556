# SPDX-License-Identifier: Apache-2.0
"""What render --aov saves beside a picture, against closed forms and the rays that were counted."""
import json
import math
import signal
import time

from harness import CAMERA, GRAY, CliTest, scene_path
from pictures import read_exr, read_png

ALL = "depth,normal,id,rays,samples"


class Aov(CliTest):
    def stats(self, *arguments):
        result = self.succeed("render", *arguments, "--stats=json", "--device", "threads")
        return json.loads(result.stdout)

    def channels(self, *arguments):
        stats = self.stats(*arguments, "-o", "a.exr", "--aov", ALL)
        return stats, read_exr(self.folder / "a.aov.exr")

    def test_depth_normal_and_id_of_two_spheres(self):
        self.write_text("scene.json", json.dumps(
            {"camera": CAMERA, "materials": {"gray": GRAY}, "spheres": [
                {"center": [0, 0, -20], "radius": 2, "material": "gray"},
                {"center": [0, 0, 0], "radius": 1, "material": "gray"}]}))
        _, channels = self.channels("scene.json", "--size", "41", "--aa", "grid:2")
        self.assertEqual(channels["depth"].shape, (41, 41))
        self.assertEqual(sorted(channels), ["depth", "id", "normal.X", "normal.Y", "normal.Z",
                                            "rays", "samples"])
        seen = 0
        for y in range(41):
            for x in range(41):
                half = math.tan(math.radians(20))
                ray = [half * ((x + 0.5) / 20.5 - 1), half * (1 - (y + 0.5) / 20.5), -1]
                length = math.hypot(*ray)
                ray = [part / length for part in ray]
                along = -4 * ray[2]
                under = along * along - 15
                if abs(under) < 1e-9:
                    continue
                found = [channels[name][y][x] for name in ["depth", "normal.X", "normal.Y", "normal.Z"]]
                if under < 0:
                    self.assertEqual((found, channels["id"][y][x]), ([0, 0, 0, 0], 0))
                    continue
                depth = along - math.sqrt(under)
                expected = [depth, depth * ray[0], depth * ray[1], 4 + depth * ray[2]]
                for a, b in zip(found, expected):
                    self.assertAlmostEqual(a, b, delta=1e-6)
                self.assertEqual(channels["id"][y][x], 2)
                seen += 1
        self.assertGreater(seen, 200)

    def test_rays_and_samples_add_up_to_the_pictures(self):
        for more in [["--aa", "grid:3"], ["--aa", "adaptive:0.05", "--precision", "double"],
                     ["--aa", "edges:0.01"], ["--aa", "edges:0.01", "--crop", "3,5,41,30"],
                     ["--aa", "adaptive:0.05", "--crop", "3,5,41,30"]]:
            with self.subTest(more=more):
                stats, channels = self.channels(scene_path("glass"), "--size", "48x36", *more)
                if "--crop" not in more:  # its border is rendered too
                    self.assertEqual((channels["samples"].sum(), channels["rays"].sum()),
                                     (stats["rays"]["primary"], stats["rays"]["total"]))
                kinds = set(channels["samples"].flat)
                expected = {9} if "grid:3" in more else {1, 5, 17, 65, 257}
                if "edges:0.01" in more:
                    expected = {1, *range(17, 4098, 16)}
                self.assertLessEqual(kinds, expected)
                self.assertEqual(len(kinds) > 1, "grid:3" not in more)

    def test_samples_are_those_of_the_picture_that_met_the_target(self):
        for aa in [["--aa", "sobol:4"], []]:
            stats, channels = self.channels(scene_path("glass"), "--size", "48x36", "--target-rmse", "0.004", *aa)
            self.assertEqual((channels["samples"].sum(), channels["rays"].sum()),
                             (stats["rays"]["primary"], stats["rays"]["total"]))

    def test_a_window_has_the_pixels_of_the_whole(self):
        arguments = [scene_path("many-lights"), "--size", "96x72", "--aa", "adaptive:0.05"]
        whole = self.channels(*arguments)[1]
        part = self.channels(*arguments, "--crop", "7,9,83,61")[1]
        for name, values in part.items():
            self.assertTrue((values == whole[name][9:61, 7:83]).all(), name)

    def test_ids_are_those_of_the_scene_where_it_has_a_hierarchy(self):
        arguments = [scene_path("meshes"), "--size", "64", "-o", "a.exr", "--aov", "id"]
        self.stats(*arguments)
        with_hierarchy = self.bytes_of("a.aov.exr")
        self.stats(*arguments, "--hierarchies", "off")
        self.assertEqual(self.bytes_of("a.aov.exr"), with_hierarchy)

    def test_false_colors(self):
        plain = self.stats(scene_path("cornell-box"), "--size", "100x60", "-o", "a.png")
        stats = self.stats(scene_path("cornell-box"), "--size", "100x60", "-o", "b.png", "--aov", ALL)
        self.assertEqual(plain["image"]["hash"], stats["image"]["hash"])
        self.assertEqual(self.bytes_of("a.png"), self.bytes_of("b.png"))
        for name in ALL.split(","):
            pixels = read_png(self.folder / f"b.{name}.png")
            self.assertEqual(pixels.shape, (60, 100, 3))
            colors = set(map(bytes, pixels.reshape(-1, 3)))
            self.assertEqual(len(colors) > 3, name != "samples", name)  # equally many everywhere

    def test_says_what_the_colors_mean(self):
        picture = [scene_path("cornell-box"), "--size", "50"]
        depths = [value for value in self.channels(*picture)[1]["depth"].flat if value]
        said = self.succeed("render", *picture, "-o", "b.png", "--aov", "depth,normal").stderr
        self.assertIn(f"b.depth.png: violet {min(depths):.4g} to yellow {max(depths):.4g}\n", said)
        self.assertIn("b.normal.png: x, y, z from -1 to 1", said)

    def test_stopped_after_the_picture(self):
        process = self.start("render", scene_path("glass"), "--size", "80", "--aa", "grid:16",
                             "--device", "threads", "-o", "a.png", "--aov", "rays")
        while "a.png" not in self.files() and process.poll() is None:
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        stderr = process.communicate()[1]
        self.assertEqual(process.returncode, 130, stderr)
        self.assertIn("--aov saved nothing", stderr)
        self.assertEqual(self.files(), ["a.png"])

    def test_refusals(self):
        scene = scene_path("single-sphere")
        for arguments, words in [(["-o", "a.png", "--aov", "color"], "'color'"),
                                 (["--aov", "depth"], "-o FILE"),
                                 (["-o", "-", "--aov", "depth"], "-o FILE"),
                                 (["-o", "a.mbj", "--shard", "0/2", "--aov", "depth"], "whole"),
                                 ([scene, "-o", "%s.png", "--aov", "depth"], "whole")]:
            self.assert_refused(self.run_cli("render", scene, *arguments), 2, *words.split("|"))
        (self.folder / "a.depth.png").mkdir()
        self.assert_refused(self.run_cli("render", scene, "-o", "a.png", "--aov", "depth"), 4,
                            "a.depth.png")
        self.assertEqual(self.files(), ["a.depth.png"])

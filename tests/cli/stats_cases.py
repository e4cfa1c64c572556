# SPDX-License-Identifier: Apache-2.0
"""--stats and --stats=json: valid, complete, adding up."""
import json
import platform
import unittest

from harness import CliTest, image_hash

DEVICES = [["--device", "pocl"], ["--device", "pocl", "--launch", "sample"],
           ["--device", "threads"], ["--device", "threads", "--schedule", "buffers"]]


class JsonStats(CliTest):
    @unittest.skipUnless(platform.machine() == "x86_64", "no x86-64")
    def test_names_the_processor(self):
        """All else is in tests/golden."""
        environment = self.stats_of("cornell-box", "--size", "20x10")["environment"]
        self.assertRegex(environment["cpu"], r".+ \(family \d+, model \d+\)$")

    def test_nothing_else_on_stdout_or_stderr(self):
        result = self.render("cornell-box", "--stats=json", "--size", "20", "-v")
        json.loads(result.stdout)
        self.assertEqual(result.stderr, "")

    def test_scene_path_with_quotes_and_umlauts(self):
        path = self.write_scene('a "quoted" nämé.json')
        self.assertEqual(self.stats_of(path, "--size", "4")["scene"]["path"], path)

    def test_scene_path_that_is_not_utf_8(self):
        path = self.folder / b"latin-\xe9.json".decode("utf-8", "surrogateescape")
        path.write_text('{"camera": {"from": [0, 0, 4], "at": [0, 0, 0], "fov_degrees": 40}}')
        result = self.succeed("render", path, "--size", "4", "--stats=json", "-o", "out.png")
        json.loads(result.stdout)


class Rays(CliTest):
    def test_of_a_crop(self):
        rays = self.stats_of("empty", "--size", "50", "--crop", "1,1,11,6", "--aa", "none")["rays"]
        self.assertEqual(rays, {"primary": 50, "shadow": 0, "mirror": 0, "transmitted": 0,
                                "total": 50})


class Phases(CliTest):
    def test_sum_to_about_the_total(self):
        for device in DEVICES:
            seconds = self.stats_of("mirror-hall", "--size", "300", "--aa", "grid:3", *device,
                                    "-o", "out.png")["seconds"]
            known = seconds["set_up"] + seconds["trace"] + seconds["resolve_and_write"]
            with self.subTest(device=device, seconds=seconds):
                self.assertGreaterEqual(min(seconds.values()), 0)
                self.assertEqual(seconds["build"] == 0, "threads" in device)
                self.assertLessEqual(known, seconds["total"] + 0.02)
                self.assertLess(seconds["total"] - known, 0.1 + 0.1 * seconds["total"])

    def test_kernels_take_most_of_the_trace_time(self):
        """By the device's own clock, against the host's. The work is long enough that launching it
        does not count."""
        for launch in ["pixel", "sample"]:
            seconds = self.stats_of("mirror-hall", "--size", "400", "--aa", "grid:4", "--device",
                                    "pocl", "--launch", launch)["seconds"]
            with self.subTest(launch=launch, seconds=seconds):
                self.assertLessEqual(seconds["kernel"], seconds["trace"])
                self.assertGreater(seconds["kernel"], 0.2 * seconds["trace"])


class TextStats(CliTest):
    def test_sections(self):
        for option in ["--stats", "--stats=text"]:
            result = self.render("cornell-box", "--size", "20", option)
            self.assertEqual(result.stderr, "")
            for word in ["scene ", "picture 20x20", "device ", "needs: ", "leaves out: ", "time\n",
                         "set-up", "ray trace", "total", "rays\n", "primary", "Mrays/s"]:
                self.assertIn(word, result.stdout)
            self.assertIsNotNone(image_hash(result.stdout))

    def test_all_that_the_scene_holds_is_told(self):
        result = self.render("glass", "--size", "8", "--stats")
        self.assertIn("(4 spheres, 4 cones, 128 triangles, 2 lights, mirrors, glass; hash ",
                      result.stdout)

    def test_no_hierarchy_is_none(self):
        self.assertIn("BVH: none\n", self.render("glass", "--size", "8", "--hierarchies", "off", "--stats").stdout)

    def test_features_all_is_said(self):
        result = self.render("empty", "--size", "4", "--features", "all", "--stats")
        self.assertRegex(result.stdout, "leaves out: nothing\n"
                                        "compiled in but not needed: .*spheres.*glass.*wide filters, edges\n")

    def test_features_that_the_kernels_have_are_not_left_out(self):
        for device in ["threads", "pocl"]:
            result = self.render("cornell-box", "--size", "4", "--features", "glass", "--stats",
                                 "--device", device)
            self.assertRegex(result.stdout, "compiled in but not needed: .*glass")
            self.assertNotRegex(result.stdout, "leaves out: .*glass")
        result = self.render("cornell-box", "--size", "4", "--stats", "--device", "pocl")
        self.assertNotIn("compiled in but", result.stdout)
        self.assertRegex(result.stdout, "leaves out: .*glass")

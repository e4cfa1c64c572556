# SPDX-License-Identifier: Apache-2.0
"""mirrorball explain: the ray tree of a pixel."""
import json

from harness import CliTest, scene_path

BOX = ["--size", "40", "--pixel", "26,31"]  # on the mirror ball


def rays_of(ray):
    waiting = [ray]
    while waiting:
        ray = waiting.pop()
        yield ray
        waiting += ray["children"]


class Explain(CliTest):
    def explain(self, *arguments):
        result = self.succeed("explain", *arguments)
        return result.stdout

    def test_adds_up(self):
        answer = json.loads(self.explain(scene_path("cornell-box"), *BOX, "--json"))
        self.assertEqual(answer["format"], "mirrorball-explain")
        tree = answer["samples"][0]["ray"]
        self.assertEqual(tree["hit"]["object"], "sphere 2")
        self.assertEqual(tree["hit"]["material"], "mirror")
        self.assertEqual(tree["children"][0]["kind"], "mirror")
        for channel in range(3):
            total = sum(ray["weight"][channel] * ray["color"][channel] for ray in rays_of(tree))
            self.assertAlmostEqual(total, answer["color"][channel], delta=1e-15)

    def test_is_a_text_with_a_line_for_each_light(self):
        text = self.explain(scene_path("cornell-box"), *BOX)
        self.assertIn("eye ray hits sphere 2 (mirror) at (", text)
        self.assertIn("mirror ray hits ", text)
        self.assertIn("    light 1 ", text)
        self.assertNotIn("nan", text)

    def test_counts_the_triangles_that_polygons_are_split_into(self):
        self.write_text("quads.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 2 5 6 3\n")
        text = self.explain("quads.obj", "--size", "40", "--pixel", "28,17")
        self.assertIn("hits mesh 1, triangle 4 (", text)

    def write_hall(self, mirror, max_bounces):
        """Two mirrors that face each other, and the eye between them."""
        wall = [[-99, -99, -2], [99, -99, -2], [0, 99, -2]]
        return self.write_scene(
            camera={"from": [0, 0, 0], "at": [0, 0, -1], "fov_degrees": 20},
            image={"width": 3, "height": 3}, max_bounces=max_bounces,
            materials={"m": {"mirror": mirror, "two_sided": True}},
            triangles=[{"vertices": [[x, y, z * side] for x, y, z in wall], "material": "m"}
                       for side in (1, -1)])

    def test_leaves_out_what_nobody_sees(self):
        """Unless asked for all: rays between two mirrors that return little."""
        pixel = [self.write_hall(mirror=0.1, max_bounces=9), "--pixel", "1,1"]
        self.assertEqual(self.explain(*pixel, "-v").count(" ray hits "), 10)
        text = self.explain(*pixel)
        self.assertEqual(text.count(" ray hits "), 3)
        self.assertIn("7 rays of weight below 0.004", text)

    def test_has_a_tree_for_each_sample(self):
        answer = json.loads(self.explain(scene_path("cornell-box"), *BOX, "--json", "--aa", "sobol:3"))
        self.assertEqual([sample["sample"] for sample in answer["samples"]], [0, 1, 2])

    def test_ends_where_it_is_told_to(self):
        answer = json.loads(self.explain(scene_path("cornell-box"), *BOX, "--json", "--max-bounces", "1"))
        self.assertEqual(max(ray["bounce"] for ray in rays_of(answer["samples"][0]["ray"])), 1)

    def test_refuses_trees_without_an_end(self):
        pixel = [self.write_hall(mirror=1, max_bounces=100000), "--pixel", "1,1"]
        result = self.run_cli("explain", *pixel)
        self.assertEqual(result.returncode, 7)
        self.assertIn("--max-bounces 256", result.stderr)
        answer = json.loads(self.explain(*pixel, "--max-bounces", "256", "--json"))
        self.assertEqual(len(list(rays_of(answer["samples"][0]["ray"]))), 257)

    def test_refuses_what_it_cannot_explain(self):
        box = scene_path("cornell-box")
        for arguments, words in [([box], "--pixel"),
                                 ([box, "--pixel", "500,0"], "500x500"),
                                 ([box, "--pixel", "1"], "x,y"),
                                 ([box, "--pixel", "-1,2"], "x,y"),
                                 ([box, "--pixel", "1,1", "--aa", "adaptive:0.1"], "--aa"),
                                 ([box, "--pixel", "1,1", "--aa", "grid:9"], "--aa"),
                                 ([box, "--pixel", "1,1", "--max-bounces", "x"], "--max-bounces")]:
            result = self.run_cli("explain", *arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertIn(words, result.stderr)
            self.assertEqual(result.stdout, "")

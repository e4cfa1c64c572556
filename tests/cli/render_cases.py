# SPDX-License-Identifier: Apache-2.0
"""The same picture whoever renders it, and sizes at the ends of what is allowed."""
import json

from harness import CliTest, scene_path
from pictures import read_pfm

PATHS = [
    ["--device", "pocl", "--launch", "pixel"],
    ["--device", "pocl", "--launch", "sample"],
    ["--device", "pocl", "--features", "all"],
    ["--device", "threads:1"],
    ["--device", "threads:2"],
    ["--device", "threads:7"],
    ["--device", "threads", "--schedule", "buffers"],
    ["--device", "threads", "--schedule", "buffers", "--threads", "2"],
]


class SameHash(CliTest):
    def assert_one_picture(self, paths, scene, *options):
        """The same bits, by the same rays."""
        found = {}
        for path in paths:
            stats = self.stats_of(scene, *options, *path)
            found[" ".join(path)] = [stats["image"]["hash"], stats["rays"]]
        self.assertTrue(all(one == found[" ".join(paths[0])] for one in found.values()), json.dumps(found, indent=1))

    def test_on_every_path(self):
        for picture in [["glass", "--size", "37x29"],
                        ["single-sphere", "--size", "9x7", "--aa", "grid:64"],
                        *(["mirror-hall", "--size", "9x7", "--max-bounces", bounces] for bounces in ["0", "50"])]:
            with self.subTest(picture=picture):
                self.assert_one_picture(PATHS, *picture)

    def test_with_every_tile_size(self):
        paths = [["--tile", tile, "--device", device] for tile in ["1x1", "37x1", "13x7", "10000", "65536x1"]
                 for device in ["pocl", "threads"]]
        paths += [["--tile", "5x3", "--launch", "sample"],
                  ["--tile", "5x3", "--device", "threads", "--schedule", "buffers"]]
        self.assert_one_picture(paths, "cornell-box", "--size", "37x29")

    def test_hash_tells_pictures_apart(self):
        hashes = {self.hash_of("cornell-box", "--size", "20", *more) for more in [
            [], ["--aa", "none"], ["--max-bounces", "0"], ["--precision", "double"]]}
        self.assertEqual(len(hashes), 4)

    def test_expected_hash(self):
        right = self.hash_of("cornell-box", "--size", "20")
        for wanted, code, says in [(right, 0, ""), (right[::-1], 1, f"hash is {right}, expected {right[::-1]}"),
                                   (right[1:], 2, "expected 16 hexadecimal digits")]:
            result = self.run_cli("render", scene_path("cornell-box"), "--size", "20", "--expect", wanted)
            self.assertEqual(result.returncode, code, result.stderr)
            self.assertIn(says, result.stderr)

    def test_grid_1_is_none(self):
        self.assertEqual(self.hash_of("cornell-box", "--size", "20", "--aa", "none"),
                         self.hash_of("cornell-box", "--size", "20", "--aa", "grid:1"))

    def test_fast_math_renders(self):
        for device in ["pocl", "threads"]:
            self.hash_of("cornell-box", "--size", "20", "--math", "fast", "--device", device)


class Extremes(CliTest):
    def test_sizes(self):
        for size in ["1x1", "65536x1", "1x65536"]:
            hashes = set()
            for device in ["pocl", "threads"]:
                hashes.add(self.hash_of("single-sphere", "--size", size, "--aa", "none",
                                        "--device", device, "-o", "out.pfm"))
                with self.subTest(size=size, device=device):
                    height, width, _ = read_pfm(self.folder / "out.pfm").shape
                    self.assertEqual(f"{width}x{height}", size)
            self.assertEqual(len(hashes), 1)

    def test_long_pictures_as_png_and_exr(self):
        for name in ["out.png", "out.exr"]:
            self.render("empty", "--size", "65536x1", "--aa", "none", "-o", name)
        self.assertEqual(self.files(), ["out.exr", "out.png"])

    def test_most_bounces(self):
        self.hash_of("mirror-hall", "--size", "4", "--max-bounces", "100000")

    def test_most_threads(self):
        self.hash_of("single-sphere", "--size", "4", "--device", "threads:4096")


class NonFinite(CliTest):
    def test_a_picture_without_finite_pixels_has_no_error(self):
        scene = self.write_scene(ambient_light=1e30, materials={"bright": {"ambient": 1e6, "mirror": 1e6}},
                                 spheres=[{"center": [0, 0, 0], "radius": 100, "material": "bright"}])
        self.render("empty", "--size", "4", "-o", "a.pfm")
        result = self.run_cli("render", scene, "--size", "4", "--device", "threads", "--reference",
                              "a.pfm", "--stats=json")
        self.assertEqual(result.returncode, 6, result.stderr)
        self.assertNotIn("error", json.loads(result.stdout))


class Reference(CliTest):
    def compare(self, reference, *options):
        return self.run_cli("render", self.scene, "--size", "16", "--device", "threads",
                            "--reference", reference, *options)

    def setUp(self):
        super().setUp()
        self.scene = self.write_scene(background=[0.25, 0.5, 1])
        for name in ["same.pfm", "same.exr", "same.png"]:
            self.render(self.scene, "--size", "16", "--device", "threads", "-o", name)
        self.render(self.scene, "--size", "17", "--device", "threads", "-o", "larger.pfm")

    def test_equal_picture(self):
        for options in [["same.pfm"], ["same.exr"], ["same.pfm", "-q"]]:
            with self.subTest(options=options):
                result = self.compare(*options)
                self.assertEqual(result.returncode, 0)
                self.assertRegex(result.stdout, r"^RMSE 0\.000e\+00, .* 0 not finite\n$")

    def test_rounded_picture_is_close(self):
        answer = json.loads(self.compare("same.png", "--stats=json").stdout)
        self.assertLess(answer["error"]["max"], 0.5 / 255 + 1e-6)
        self.assertGreater(answer["error"]["max"], 0)

    def test_is_not_overwritten(self):
        other = self.write_scene("other.json", background=0)
        self.render(other, "--size", "16", "--device", "threads", "-o", "same.pfm")
        before = self.bytes_of("same.pfm")
        result = self.compare("same.pfm", "-o", "same.pfm", "--stats=json")
        self.assertEqual((result.returncode, result.stdout), (2, ""))
        self.assertEqual(self.bytes_of("same.pfm"), before)

    def test_what_cannot_be_compared_is_refused(self):
        self.write_text("text.png", "this is no picture")
        for name, words in [("larger.pfm", ["16x16", "17x17"]), ("text.png", ["text.png"])]:
            self.assert_refused(self.compare(name), 3, *words)

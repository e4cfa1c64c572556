# SPDX-License-Identifier: Apache-2.0
"""`compare`: what it measures, what it catches, what it refuses."""
import json
import math
import struct
import zlib

import jsonschema
import numpy

from harness import CliTest, scene_path
from pictures import png_texts, read_pfm, read_png
from program import ROOT

CYAN = (0, 255, 255)


class CompareTest(CliTest):
    def write_pfm(self, name, width, height, values, channels=3):
        """values: rows from the top."""
        rows = numpy.array(values, "<f4").reshape(height, -1)
        head = f"{'PF' if channels == 3 else 'Pf'}\n{width} {height}\n-1.0\n".encode()
        (self.folder / name).write_bytes(head + rows[::-1].tobytes())

    def compare(self, *arguments, code=0, **more):
        result = self.run_cli("compare", *arguments, **more)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1 if code else 0, result.stderr)
        return result

    def figures(self, *arguments, **more):
        return json.loads(self.compare(*arguments, "--json", **more).stdout)

    def cornell(self):
        """The paper's picture, 40x30."""
        self.render("cornell-box", "--size", "40x30", "--device", "threads", "-o", "box.pfm")
        return read_pfm(self.folder / "box.pfm")


class Figures(CompareTest):
    def test_identical(self):
        self.cornell()
        text = self.compare("box.pfm", "box.pfm", "--max-rmse", "0", "--max-abs", "0",
                            "--max-pixels", "0").stdout
        self.assertRegex(text, r"(?m)^  identical$")
        answer = self.figures("box.pfm", "box.pfm")
        self.assertTrue(answer["identical"])
        self.assertEqual((answer["error"]["rmse"], answer["error"]["psnr_db"]), (0, None))

    def test_numbers(self):
        """One channel of one of four pixels off by half."""
        self.write_pfm("a.pfm", 2, 2, [0.5] * 7 + [1.0] + [0.5] * 4)
        self.write_pfm("b.pfm", 2, 2, [0.5] * 12)
        answer = self.figures("a.pfm", "b.pfm")
        error = answer["error"]
        self.assertAlmostEqual(error["rmse"], 0.5 / math.sqrt(12))
        self.assertAlmostEqual(error["mean"], 0.5 / 12)
        self.assertAlmostEqual(error["psnr_db"], 10 * math.log10(12 / 0.25))
        self.assertAlmostEqual(error["rel_mse"], (0.5 / 0.51) ** 2 / 12)
        self.assertEqual((error["max"], error["max_at"]), (0.5, [0, 1]))
        self.assertEqual([error[f"pixels_over_{n}_255"] for n in (1, 2, 8)], [1, 1, 1])
        self.assertEqual((answer["identical"], answer["passed"]), (False, True))

    def test_text_has_them_all(self):
        self.write_pfm("a.pfm", 1, 1, [0.5] * 3)
        self.write_pfm("b.pfm", 1, 1, [0.25] * 3)
        text = self.compare("a.pfm", "b.pfm").stdout
        for line in ["not finite  0 pixels", "RMSE        2.5000e-01", "mean        2.5000e-01",
                     "maximum     2.5000e-01 at 0,0", "PSNR        12.04 dB",
                     "over 1/255  1 pixel (100.00 %)", "over 2/255", "over 8/255",
                     "relMSE      9.2456e-01"]:
            self.assertIn("  " + line, text)
        self.assertNotIn("identical", text)

    def test_eight_bits_against_the_film(self):
        """Rounding to 8 bits costs half a level at most, once clamped."""
        scene = self.write_scene(background=[3, 0.4, 0.123])
        for name in ["film.pfm", "out.png"]:
            self.render(scene, "--size", "8", "--device", "threads", "-o", name)
        self.assertEqual(self.figures("out.png", "film.pfm")["error"]["max"], 2)
        answer = self.figures("out.png", "film.pfm", "--clamp", "--max-abs", "0.5001/255")
        self.assertTrue(answer["clamped"])

    def test_one_level_is_not_over_one_level(self):
        for level in range(255):
            for name, value in [("a.pfm", level), ("b.pfm", level + 1)]:
                self.write_pfm(name, 1, 1, [numpy.float32(value / 255)] * 3)
            self.compare("a.pfm", "b.pfm", "--max-abs", "1/255", "--max-rmse", "1/255", "--max-pixels", "0")
        self.compare("a.pfm", "b.pfm", "--max-abs", "0.999/255", code=1)

    def test_formats_mix(self):
        for name in ["a.pfm", "a.exr"]:
            self.render("single-sphere", "--size", "16", "--device", "threads", "-o", name)
        self.assertTrue(self.figures("a.pfm", "a.exr")["identical"])


class Catches(CompareTest):
    def test_one_nan(self):
        values = self.cornell()
        values[7, 5, 1] = math.nan
        self.write_pfm("nan.pfm", 40, 30, values)
        for pair, name in [(("nan.pfm", "box.pfm"), "A"), (("box.pfm", "nan.pfm"), "B")]:
            result = self.compare(*pair, code=1)
            self.assertIn(f"1 pixel of {name} not finite, the first at 5,7", result.stderr)
            self.assertIn("not finite  1 pixel ", result.stdout)

    def test_infinity_that_is_in_both(self):
        self.write_pfm("a.pfm", 1, 1, [0, -math.inf, 0])
        answer = self.figures("a.pfm", "a.pfm", "--clamp", code=1)
        self.assertEqual(len(answer["breaches"]), 2)
        self.assertFalse(answer["identical"])

    def test_reference_of_a_render(self):
        values = [0.5] * (8 * 8 * 3)
        values[3 * (8 * 7 + 5)] = math.inf
        self.write_pfm("inf.pfm", 8, 8, values)
        result = self.run_cli("render", scene_path("empty"), "--size", "8", "-o", "out.png",
                              "--reference", "inf.pfm")
        self.assert_refused(result, 3, "inf.pfm: 1 pixel is not finite, the first at 5,7")
        self.assertEqual(self.files(), ["inf.pfm"])

    def test_all_nan(self):
        self.write_pfm("a.pfm", 2, 2, [math.nan] * 12)
        result = self.compare("a.pfm", "a.pfm", "--max-rmse", "1", code=1)
        self.assertIn("no pixel is finite", result.stdout)
        self.assertIsNone(self.figures("a.pfm", "a.pfm", code=1)["error"])

    def test_shifted_by_one_pixel(self):
        values = self.cornell()
        for name, axis in [("right.pfm", 1), ("down.pfm", 0)]:
            self.write_pfm(name, 40, 30, numpy.roll(values, 1, axis))
            for limit in [("--max-rmse", "0.01"), ("--max-abs", "0.1"), ("--max-pixels", "100")]:
                with self.subTest(name=name, limit=limit):
                    self.assertIn(limit[0], self.compare(name, "box.pfm", *limit, code=1).stderr)


class Thresholds(CompareTest):
    def setUp(self):
        super().setUp()
        self.write_pfm("a.pfm", 2, 1, [0.5, 0, 0, 0, 0, 0])
        self.write_pfm("b.pfm", 2, 1, [0.0] * 6)

    def test_at_the_limit_passes_and_without_one(self):
        self.compare("a.pfm", "b.pfm", "--max-abs", "0.5", "--max-pixels", "1",
                     "--max-rmse", "0.21")
        self.compare("a.pfm", "b.pfm")

    def test_all_breaches_in_one_line(self):
        result = self.compare("a.pfm", "b.pfm", "--max-abs", "0.4", "--max-pixels", "0",
                              "--max-rmse", "2/255", code=1)
        for name in ["RMSE 0.2041 exceeds --max-rmse 0.007843",
                     "maximum 0.5 exceeds --max-abs 0.4",
                     "1 pixel over 1/255, exceeding --max-pixels 0"]:
            self.assertIn(name, result.stderr)

    def test_a_scale_needs_a_heatmap(self):
        self.assert_refused(self.run_cli("compare", "a.pfm", "b.pfm", "--heatmap-scale", "1"), 2,
                            "--heatmap-scale requires --heatmap")

    def test_garbage(self):
        for option, value in [("--max-rmse", "-1"), ("--max-rmse", "nan"), ("--max-abs", "1x"),
                              ("--max-abs", ""), ("--max-pixels", "-1"),
                              ("--max-pixels", "1.5"), ("--heatmap-scale", "0"),
                              ("--heatmap", "map.exr"), ("--heatmap", "map")]:
            with self.subTest(option=option, value=value):
                result = self.run_cli("compare", "a.pfm", "b.pfm", f"{option}={value}")
                self.assert_refused(result, 2, "map" if value.startswith("map") else option)
        self.assertEqual(self.files(), ["a.pfm", "b.pfm"])


class Refuses(CompareTest):
    def test_what_has_another_shape_or_is_no_picture(self):
        self.write_pfm("a.pfm", 2, 1, [0.0] * 6)
        self.write_pfm("size.pfm", 1, 2, [0.0] * 6)
        self.write_pfm("gray.pfm", 2, 1, [0.0] * 2, channels=1)
        self.write_text("text.png", "no picture")
        for pair, words in [(("a.pfm", "size.pfm"), ["a.pfm has 2x1", "size.pfm has 1x2"]),
                            (("a.pfm", "gray.pfm"), ["3 channels", "and 1;"]), (("a.pfm", "text.png"), ["text.png"]),
                            (("text.png", "a.pfm"), ["text.png"]), (("a.pfm", "nowhere.png"), ["nowhere.png"])]:
            self.assert_refused(self.run_cli("compare", *pair, "--heatmap", "h.png"), 3, *words)
        self.assert_refused(self.run_cli("compare", "a.pfm"), 2, "B")
        self.assertNotIn("h.png", self.files())

    def test_other_sizes_before_it_reads_pixels(self):
        """Else a small file of a large picture takes gigabytes first."""
        chunk = lambda kind, data: (struct.pack(">I", len(data)) + kind + data +
                                    struct.pack(">I", zlib.crc32(kind + data)))
        head = struct.pack(">IIBBBBB", 4000, 4000, 8, 0, 0, 0, 0)
        (self.folder / "a.png").write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) +
                                            chunk(b"IDAT", b"no pixels" * 2000))
        self.write_pfm("b.pfm", 1, 1, [0.5], channels=1)
        for pair in [("a.png", "b.pfm"), ("b.pfm", "a.png")]:
            self.assert_refused(self.run_cli("compare", *pair), 3, "4000x4000", "1x1")


class Json(CompareTest):
    def setUp(self):
        super().setUp()
        self.write_pfm("a.pfm", 1, 1, [0.5] * 3)

    def test_to_a_file_leaves_the_text(self):
        text = self.compare("a.pfm", "a.pfm", "--json", "out.json").stdout
        self.assertIn("identical", text)
        answer = json.loads((self.folder / "out.json").read_text())
        self.assertEqual((answer["format"], answer["version"]), ("mirrorball-compare", 1))
        self.assertEqual((answer["picture"], answer["width"], answer["channels"]), ("a.pfm", 1, 3))

    def test_is_what_the_schema_says(self):
        schema = ROOT / "docs" / "compare.schema.json"
        validator = jsonschema.Draft202012Validator(json.loads(schema.read_text()))
        self.write_pfm("b.pfm", 1, 1, [0.25] * 3)
        self.write_pfm("nan.pfm", 1, 1, [math.nan] * 3)
        for other, code in [("a.pfm", 0), ("b.pfm", 0), ("nan.pfm", 1)]:
            validator.validate(self.figures("a.pfm", other, "--heatmap", "h.png", code=code))

    def test_dash_is_stdout(self):
        for arguments in [["--json", "-"], ["--json=-"], ["--json"]]:
            json.loads(self.compare("a.pfm", "a.pfm", *arguments).stdout)

    def test_files_that_cannot_be_written(self):
        for option in ["--json", "--heatmap"]:
            self.assert_refused(self.run_cli("compare", "a.pfm", "a.pfm", option, "no/out.png"), 4, "no/out.png")


class HeatMap(CompareTest):
    def setUp(self):
        super().setUp()
        self.write_pfm("a.pfm", 3, 2, [0.0] * 3 + [0.25, 0.5, 0] + [0.0] * 9 + [0, 0, math.nan])
        self.write_pfm("b.pfm", 3, 2, [0.0] * 18)

    def pixels(self, *arguments):
        self.text = self.compare("a.pfm", "b.pfm", "--heatmap", "h.png", *arguments, code=1).stdout
        data = read_png(self.folder / "h.png")
        self.assertEqual(data.shape, (2, 3, 3))
        return list(map(tuple, data.reshape(6, 3)))

    def test_black_to_yellow_and_cyan(self):
        pixels = self.pixels()
        self.assertEqual(pixels, [(0, 0, 4), (252, 253, 191)] + [(0, 0, 4)] * 3 + [CYAN])
        self.assertIn("h.png: black 0 to yellow 5.0000e-01 by square roots, cyan not finite", self.text)
        self.assertEqual(png_texts(self.folder / "h.png")["mirrorball:HeatmapScale"], "0.5")

    def test_fixed_scale(self):
        self.assertEqual(self.pixels("--heatmap-scale", "1.62")[1], (205, 64, 113))
        self.assertEqual(self.pixels("--heatmap-scale", "0.1")[1], (252, 253, 191))

    def test_of_identical_pictures(self):
        self.compare("b.pfm", "b.pfm", "--heatmap", "h.png")
        self.assertEqual(set(read_png(self.folder / "h.png").flat), {0, 4})

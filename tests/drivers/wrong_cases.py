# SPDX-License-Identifier: Apache-2.0
"""A device computes other bits."""
import json
import os

from driver_case import SCENE, WrongDriver, brighter
from pictures import png_texts


class Wrong(WrongDriver):
    """A device that computes other bits is found out."""

    def render(self, shim, code, *arguments):
        result = self.run_with(shim, "render", SCENE, "--size", "100", "--device", "pocl",
                               "--stats=json", *arguments, code=code)
        return result

    def right_hash(self):
        return json.loads(self.render({}, 0).stdout)["image"]["hash"]

    def test_a_gpu_counts_the_rays_of_all_work_items(self):
        """It reads back sums of them, and rows of tiles or parts of rows."""
        gpu = {"CL_SHIM_GPU": "1"}
        figures = [json.loads(self.run_with(
            shim, "render", SCENE, "--size", "100", "--stats=json", "--no-fallback", "--device", device, "--tile", tile,
            code=0).stdout) for device, shim, tile in [("threads", {}, "100"), ("gpu", gpu, "100x30"), ("gpu", gpu, "33x17")]]
        for one in figures[1:]:
            self.assertEqual(one["device"]["launch"], "sample")
            self.assertEqual(one["rays"], figures[0]["rays"])
            self.assertEqual(one["image"]["hash"], figures[0]["image"]["hash"])

    def test_by_the_doctor(self):
        result = self.run_with(brighter("1.000001"), "doctor", code=5)
        self.assertRegex(result.stdout, r"broken +device 0, .*: renders a wrong picture")

    def test_by_its_self_test(self):
        result = self.render(brighter("1.000001"), 0)
        self.assertIn("fails its self-test", result.stderr)
        figures = json.loads(result.stdout)
        self.assertEqual(figures["image"]["hash"], self.right_hash())
        self.assertIn("fallback_from", figures["device"])

    def test_that_promises_no_exact_rounding_is_advised_fast_math(self):
        shim = dict(brighter("1.000001"), CL_SHIM_INEXACT="1")
        self.assertRegex(self.render(shim, 0).stderr, "fails its self-test: .*use --math fast")
        result = self.run_with(shim, "doctor", code=5)
        self.assertRegex(result.stdout, "renders a wrong picture in float.*use --math fast")
        said = self.run_with({"CL_SHIM_INEXACT": "1"}, "render", SCENE, "--size", "8", "--precision", "double",
                             "--device", "pocl,threads", "-v", code=0).stderr
        self.assertNotIn("round", said)

    def test_is_an_error_without_fallback(self):
        out = ["-o", str(self.folder / "out.pfm")]
        for shim, more in [(brighter("1.000001"), []), (self.CORNERS, ["--check", "100%"])]:
            self.render(shim, 5, "--no-fallback", *out, *more)
            self.assertEqual(list(self.folder.iterdir()), [])

    def test_a_right_one_is_not(self):
        figures = json.loads(self.render({}, 0, "--check", "100%").stdout)
        self.assertNotIn("fallback_from", figures["device"])
        self.assertGreater(figures["tiles_checked"], 1)
        self.assertGreater(figures["seconds"]["self_test"], 0)
        for share, tiles in [("1%", 1), ("20%", 5), ("21%", 6)]:
            result = self.render({}, 0, "--check", share, "--tile", "20")
            self.assertEqual(json.loads(result.stdout)["tiles_checked"], tiles)

    def test_by_its_self_test_wherever_it_is(self):
        for where in ["x >= 99", "y < 25"]:
            shim = {"CL_SHIM_OLD": self.CORNERS["CL_SHIM_OLD"], "CL_SHIM_NEW":
                    f"RT_TO_REALS(x) + ({where} ? (Reals)0.25f : offset.x)"}
            self.assertIn("fails its self-test", self.render(shim, 0).stderr)

    def test_by_its_self_test_in_a_second_round(self):
        shim = {"CL_SHIM_OLD": "store_lanes(film, color, live ? place",
                "CL_SHIM_NEW": "store_lanes(film, scale3((Reals)0.5f, color), live ? place"}
        self.assertNotIn("self-test", self.render({}, 0, "--aa", "adaptive:0.1").stderr)
        result = self.render(shim, 0, "--aa", "adaptive:0.1")
        self.assertIn("fails its self-test", result.stderr)

    # A fault in the left corners alone, where the self-test does not look.
    CORNERS = {"CL_SHIM_OLD": "RT_TO_REALS(x) + offset.x",
               "CL_SHIM_NEW": "RT_TO_REALS(x) + (x < 3 & (y < 8 | y > 92) ? (Reals)0.25f : offset.x)"}

    def test_by_tracing_tiles_again(self):
        arguments = ["--check", "100%", "--tile", "20"]
        result = self.render(self.CORNERS, 0, *arguments)
        self.assertIn("tiles differ when traced again on threads", result.stderr)
        self.assertNotIn("tiles_checked", json.loads(result.stdout))
        self.assertEqual(json.loads(result.stdout)["image"]["hash"], self.right_hash())
        self.render(self.CORNERS, 5, "--no-fallback", *arguments)

    def hash_of(self, code, *arguments, shim=None):
        result = self.run_with(shim or {}, *arguments, code=code)
        return result.stderr.split()[-1], result.stderr

    def test_leaves_nothing_in_the_journal(self):
        part = str(self.folder / "part.mbj")
        share = ["render", SCENE, "--size", "100", "--shard", "0/1", "-o", part]
        for more in [[], ["--aa", "adaptive:0.05"]]:
            _, said = self.hash_of(5, *share, *more, "--device", "pocl", "--check", "100%", "--fresh",
                                   "--no-fallback", shim=self.CORNERS)
            self.assertIn("differ", said)
            self.assertFalse(os.path.exists(part))
            self.hash_of(0, *share, *more, "--device", "pocl")
            right, _ = self.hash_of(0, "render", SCENE, "--size", "100", *more, "--device", "threads")
            self.assertEqual(self.hash_of(0, "merge", part)[0], right)

    def test_in_a_share_is_found_when_merged(self):
        bad, good = str(self.folder / "bad.mbj"), str(self.folder / "good.mbj")
        again = str(self.folder / "again.mbj")
        share = ["render", SCENE, "--size", "100", "--aa", "adaptive:0.05", "--precision", "double", "--shard"]
        self.hash_of(0, *share, "0,1/3", "-o", bad, "--device", "pocl", shim=self.CORNERS)
        self.hash_of(0, *share, "2/3", "-o", good, "--device", "pocl")
        self.hash_of(0, *share, "0/1", "-o", again, "--device", "threads")
        out = self.folder / "out.png"
        merge = ["merge", good, bad, "-o", str(out)]
        _, said = self.hash_of(1, *merge, again)
        for words in ["bad.mbj (", "threads on ", "differ at"]:
            self.assertIn(words, said)
        self.assertFalse(out.exists())
        self.hash_of(0, *merge)

    def test_is_replaced_in_a_finished_share(self):
        part = str(self.folder / "part.mbj")
        share = ["render", SCENE, "--size", "100", "--shard", "0/1", "-o", part]
        self.hash_of(0, *share, "--device", "pocl", shim=self.CORNERS)
        _, said = self.hash_of(0, *share, "--device", "threads", "--check", "100%")
        self.assertIn("the journal: ", said)
        self.assertEqual(self.hash_of(0, "merge", part)[0], self.right_hash())

    def test_by_tracing_the_journals_tiles_again(self):
        journal, picture = str(self.folder / "out.png.mbj"), str(self.folder / "out.png")
        right = self.right_hash()
        for device in ["threads:1", "pocl"]:
            self.hash_of(0, "render", SCENE, "--size", "100", "--shard", "0/1", "-o", journal,
                         "--device", "pocl", shim=self.CORNERS)
            found, said = self.hash_of(0, "render", SCENE, "--size", "100", "--device", device,
                                       "-o", picture, "--check", "100%")
            self.assertIn("the journal: ", said)
            self.assertRegex(png_texts(self.folder / "out.png")["mirrorball:FallbackFrom"], "the journal$")
            self.assertTrue(" on 1 thread, " in said or device == "pocl", said)
            self.assertEqual(found, right)
            self.assertFalse(os.path.exists(journal))

    TILES = ["--size", "100", "--tile", "100x5", "--aa", "grid:16"]  # several launches

    def test_leaves_no_tiles_among_those_of_threads(self):
        """Threads finish only what has their bits."""
        right, _ = self.hash_of(0, "render", SCENE, *self.TILES, "--device", "threads")
        for shim, launch, arguments in [(dict(self.CORNERS, CL_SHIM_INEXACT="1"), "8", []),
                                        (brighter("1.000001"), "4", ["--math", "fast"])]:
            render = ["render", SCENE, *self.TILES, *arguments, "--device"]
            shim = dict(shim, CL_SHIM_FAIL_LAUNCH=launch)
            for device in ["pocl", "pocl,0"]:
                found, said = self.hash_of(0, *render, device, shim=shim)
                self.assertIn("rendering on threads instead", said)
                self.assertEqual(found, right)
            figures = json.loads(self.run_with(shim, *render, "pocl", "--stats=json").stdout)
            self.assertGreater(figures["devices"][0]["pixels"], 0)
            self.assertEqual(figures["devices"][1]["pixels"], 100 * 100)
            self.hash_of(5, *render, "pocl", "--no-fallback", shim=shim)
            _, said = self.hash_of(0, *render, "pocl,threads", shim=dict(shim, CL_SHIM_FAIL_LAUNCH=""))
            self.assertIn("may round differently, and share this picture", said)

    def test_of_other_bits_leaves_a_share_to_threads(self):
        part = str(self.folder / "part.mbj")
        right, _ = self.hash_of(0, "render", SCENE, *self.TILES, "--device", "threads")
        _, said = self.hash_of(0, "render", SCENE, *self.TILES, "--device", "pocl", "--shard", "0/1",
                               "-o", part, shim={"CL_SHIM_INEXACT": "1", "CL_SHIM_DIE_AT": "7",
                                                 "CL_SHIM_DIE_IN": "clEnqueueNDRangeKernel",
                                                 "CL_SHIM_DIE_BY": "abort"})
        self.assertIn("may round differently; starting over", said)
        self.assertEqual(self.hash_of(0, "merge", part)[0], right)

    def test_by_its_rays(self):
        shim = {"CL_SHIM_OLD": "counts->shadow += lit & 1;", "CL_SHIM_NEW": "counts->shadow += 9;"}
        result = self.render(shim, 0)
        self.assertRegex(result.stderr, r"fails its self-test: it counts \d+ rays, threads \d+")
        figures = json.loads(result.stdout)
        self.assertEqual(figures["rays"], json.loads(self.render({}, 0).stdout)["rays"])
        self.render(shim, 5, "--no-fallback")

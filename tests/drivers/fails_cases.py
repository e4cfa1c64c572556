# SPDX-License-Identifier: Apache-2.0
"""A device returns errors in the middle of a picture."""
import json
import os

from driver_case import SCENE, WrongDriver


class Fails(WrongDriver):
    """A device that fails in the middle leaves what it finished in the journal, and threads do the rest."""
    ARGUMENTS = ["render", SCENE, "--stats=json", "-q", "--size", "300", "--device"]
    TILES = ["--tile", "100x10", "--aa", "grid:4"]  # several launches

    def figures(self, shim, device, *arguments):
        result = self.run_with(shim, *self.ARGUMENTS, device, *arguments, code=0)
        return json.loads(result.stdout)

    def finished_before(self, launches, *arguments):
        """The pixels that the device had finished when each of these launches failed."""
        right, finished = self.figures({}, "threads", *arguments), []
        arguments += ("--resume", "-o", str(self.folder / "out.pfm"))
        for launch in launches:
            got = self.figures({"CL_SHIM_FAIL_LAUNCH": str(launch)}, "pocl", *arguments)
            self.assertEqual(got["image"]["hash"], right["image"]["hash"])
            self.assertEqual(got["device"]["name"], "threads")
            device, threads = got["devices"]
            share = threads["pixels"] / (300 * 300)  # threads' rays alone are counted
            if "grid:4" in arguments:
                self.assertEqual(got["rays"]["primary"], share * right["rays"]["primary"])
            self.assertEqual(got["rays"] == right["rays"], share == 1)
            self.assertEqual(got["device"]["fallback_from"], device["name"])
            self.assertIn("CL_OUT_OF_RESOURCES", device["failure"])
            self.assertEqual(device["pixels"] + threads["pixels"], 300 * 300)
            self.assertAlmostEqual(got.get("resumed", 0), 1 - share)
            self.assertEqual(os.listdir(self.folder), ["out.pfm"])
            finished.append(device["pixels"])
        return finished

    def test_at_any_launch(self):
        # The first is of nothing, the next four are the self-test's; two are in flight.
        finished = self.finished_before([1, 2, 5, 6, 7, 8, 9], *self.TILES)
        self.assertEqual(finished[:5], [0, 0, 0, 0, 0])
        self.assertGreater(finished[5], 0)
        self.assertGreater(finished[6], finished[5])

    def test_rays_that_it_had_counted_are_not_in_the_sum(self):
        picture = ["--aa", "grid:16", "--tile", "100x10", "--threads", "1"]
        shim = {"CL_SHIM_DIE_IN": "clEnqueueNDRangeKernel", "CL_SHIM_DIE_BY": "error", "CL_SHIM_DIE_AT": "9",
                "CL_SHIM_DIE_AFTER": "1"}  # rays are counted every 0.2 s
        got, right = self.figures(shim, "pocl", *picture), self.figures({}, "threads", *picture)
        device, threads = got["devices"]
        self.assertGreater(device["pixels"], 0)
        self.assertEqual(threads["pixels"], 300 * 300)  # there is no journal
        self.assertEqual(got["rays"]["primary"], threads["pixels"] * 16 * 16)
        self.assertEqual(got["image"]["hash"], right["image"]["hash"])

    def test_samples_as_work_items(self):
        self.finished_before([8, 9, 10, 11, 12], "--launch", "sample", *self.TILES)

    def test_while_refining(self):
        self.finished_before([11, 12], "--aa", "adaptive:0.01")

    def test_beside_others(self):
        picture = ["--aa", "grid:24", "--tile", "100x10"]
        right = self.figures({}, "pocl", *picture)  # compiles, too
        got = self.figures({"CL_SHIM_FAIL_LAUNCH": "7"}, "pocl,threads", *picture)
        self.assertEqual(got["image"]["hash"], right["image"]["hash"])
        self.assertLessEqual(got["rays"]["total"], right["rays"]["total"])
        self.assertIn("CL_OUT_OF_RESOURCES", got["devices"][0]["failure"])

    def test_in_a_batch_it_is_not_asked_again(self):
        right = self.figures({}, "threads", *self.TILES)
        result = self.run_with({"CL_SHIM_FAIL_LAUNCH": "7"}, *self.ARGUMENTS, "pocl", SCENE,
                               *self.TILES)
        first, second = map(json.loads, result.stdout.splitlines())
        for got in (first, second):
            self.assertEqual(got["image"]["hash"], right["image"]["hash"])
            self.assertEqual(got["device"]["name"], "threads")
        self.assertIn("fallback_from", first["device"])
        self.assertNotIn("fallback_from", second["device"])

    def test_in_the_first_picture_of_a_target_it_is_not_asked_again(self):
        target = ["--aa", "sobol:4", "--target-rmse", "2e-3"]
        result = self.run_with({"CL_SHIM_FAIL_LAUNCH": "7"}, "render", SCENE, "--stats=json", "--size",
                               "300", "--device", "pocl", "--schedule", "buffers", *target, code=0)
        for text in ["CL_OUT_OF_RESOURCES", "rendering again", "--schedule has no effect"]:
            self.assertEqual(result.stderr.count(text), 1, result.stderr)
        got, right = json.loads(result.stdout), self.figures({}, "threads", *target)
        self.assertEqual(got["image"]["hash"], right["image"]["hash"])
        self.assertEqual(got["device"]["fallback_from"], got["devices"][0]["name"])
        self.assertIn("CL_OUT_OF_RESOURCES", got["devices"][0]["failure"])

    def test_in_a_share_that_starts_over(self):
        """What it finished is in the journal, whatever was there before."""
        part = str(self.folder / "part.mbj")
        share = ["--shard", "0/1", "--fresh", "-o", part, *self.TILES]
        for _ in range(2):
            got = self.figures({"CL_SHIM_FAIL_LAUNCH": "8"}, "pocl", *share)
            device, threads = got["devices"]
            self.assertGreater(device["pixels"], 0)
            self.assertEqual(device["pixels"] + threads["pixels"], 300 * 300)
        right = self.figures({}, "threads", *self.TILES)["image"]["hash"]
        self.assertIn(right, self.run_with({}, "merge", part, code=0).stderr)

    def test_is_an_error_without_fallback(self):
        self.run_with({"CL_SHIM_FAIL_LAUNCH": "7"}, *self.ARGUMENTS, "pocl", "--no-fallback", code=5)

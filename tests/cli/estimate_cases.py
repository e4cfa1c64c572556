# SPDX-License-Identifier: Apache-2.0
"""--estimate: the picture's error, without a reference."""
import json

from harness import CliTest, scene_path

RMSE = r"RMSE about \d\.\de-\d \(\d\.\de-\d to \d\.\de-\d\)"


class Estimate(CliTest):
    def estimate_of(self, *options):
        return self.stats_of("cornell-box", "--size", "80", "--estimate", *options)["estimate"]

    def test_is_in_the_summary_line_and_in_the_picture(self):
        result = self.render("cornell-box", "--size", "80", "--estimate", "-o", "out.png")
        self.assertRegex(result.stderr, RMSE + ", image ")
        self.assertRegex(self.bytes_of("out.png").decode("latin-1"), r"mirrorball:EstimatedError.{0,9}" + RMSE)

    def test_is_in_the_text_of_stats(self):
        result = self.render("cornell-box", "--size", "80", "--estimate", "--stats")
        self.assertRegex(result.stdout, "error   " + RMSE + ", estimated from ")

    def test_changes_no_bit_and_is_optional(self):
        with_it = self.stats_of("cornell-box", "--size", "80", "--estimate")
        without = self.stats_of("cornell-box", "--size", "80")
        self.assertEqual(with_it["image"], without["image"])
        self.assertEqual(with_it["rays"], without["rays"])
        self.assertNotIn("estimate", without)

    def test_is_the_same_on_every_path(self):
        estimates = []
        for device in [["pocl"], ["threads:1"], ["threads:3"], ["threads", "--schedule", "buffers"],
                       ["threads", "--lanes", "1"], ["threads", "--lanes", "4"], ["threads,pocl", "--tile", "7"]]:
            estimates.append(self.estimate_of("--device", *device))
            del estimates[-1]["seconds"]
        self.assertEqual(estimates, estimates[:1] * len(estimates))

    def test_is_refused_for_shares(self):
        result = self.run_cli("render", scene_path("cornell-box"), "--estimate", "--shard", "0/2",
                              "-o", "out.mbj")
        self.assert_refused(result, 2, "--estimate", "--shard")


class Target(CliTest):
    def reach(self, rmse, *options, scene="cornell-box"):
        return self.stats_of(scene, "--size", "80", "--target-rmse", rmse, *options)

    def test_is_reached_by_the_true_error(self):
        for scene in ["cornell-box", "many-lights", "mirror-hall"]:
            self.render(scene, "--size", "80", "--aa", "sobol:1024", "-o", "right.pfm")
            self.reach("1e-3", "-o", "out.pfm", scene=scene)
            error = json.loads(self.run_cli("compare", "out.pfm", "right.pfm", "--clamp",
                                            "--json").stdout)["error"]["rmse"]
            self.assertLess(error, 1.2e-3, scene)
            self.assertGreater(error, 0.5e-3, scene)

    def test_takes_no_more_samples_than_it_needs(self):
        samples = [self.reach(rmse, "--aa", "sobol:4")["settings"]["samples"]
                   for rmse in ["0.3", "1e-2", "3e-3"]]
        self.assertEqual(samples[0], 4)
        self.assertEqual(sorted(set(samples)), samples)
        estimate = self.reach("3e-3", "--aa", "sobol:4")["estimate"]
        self.assertLess(estimate["rmse"], estimate["target"])
        self.assertEqual(estimate["target"], 3e-3)

    def test_is_the_picture_of_that_mode_on_every_device(self):
        for device in ["pocl", "threads:3"]:
            stats = self.reach("5e-3", "--device", device)
            other = self.stats_of("cornell-box", "--size", "80", "--aa", stats["settings"]["aa"])
            self.assertEqual(stats["image"], other["image"])

    def test_goes_on_with_a_grid(self):
        stats = self.reach("5e-3", "--aa", "grid:2", "--precision", "double")
        self.assertRegex(stats["settings"]["aa"], "^grid:[3-8]$")
        self.assertLess(stats["estimate"]["rmse"], 5e-3)

    def test_starts_with_the_samples_that_the_filter_needs(self):
        for filter_, aa in [("box", "edges:0.3"), ("gaussian", "sobol:4"), ("mitchell", "sobol:16")]:
            self.assertEqual(self.reach("0.3", "--filter", filter_)["settings"]["aa"], aa)

    def test_goes_on_at_edges(self):
        stats = self.reach("1e-3", "--aa", "edges:0.1")
        self.assertLess(float(stats["settings"]["aa"].removeprefix("edges:")), 0.01)
        self.assertLess(stats["estimate"]["rmse"], 1e-3)

    def test_makes_edges_of_the_least_tolerance_give_way_to_sobol(self):
        result = self.run_cli("render", scene_path("gallery/newtons-cradle"), "--size", "6", "--aa", "edges:5e-5",
                              "--target-rmse", "5e-5", "-o", "out.png")
        self.assertIn(" sobol:", result.stdout + result.stderr)

    def test_of_a_batch(self):
        result = self.succeed("render", scene_path("cornell-box"), scene_path("many-lights"),
                              "--size", "40", "--target-rmse", "1e-2", "--stats=json")
        for line in result.stdout.splitlines():
            self.assertLess(json.loads(line)["estimate"]["rmse"], 1e-2)

    def test_that_no_mode_reaches(self):
        result = self.run_cli("render", scene_path("cornell-box"), "--size", "6", "--aa", "grid:60",
                              "--target-rmse", "1e-5", "-o", "out.png")
        self.assertEqual(result.returncode, 8)
        self.assertRegex(result.stderr, "with grid:64, not the target of 1e-05: no mode has more")
        self.assertEqual(self.files(), ["out.png"])
        result = self.run_cli("render", scene_path("glass"), "--size", "16", "--aa", "sobol:4096",
                              "--target-rmse", "1e-5")
        self.assertEqual(result.returncode, 8)
        self.assertNotIn("rendering again", result.stderr)

    def test_out_of_time_keeps_the_first_picture(self):
        result = self.run_cli("render", scene_path("glass"), "--size", "120", "--aa", "sobol:4",
                              "--target-rmse", "5e-5", "--timeout", "5", "--threads", "1", "-o", "out.png")
        self.assertEqual(result.returncode, 8)
        self.assertRegex(result.stderr, RMSE + " with sobol:4, not the target of 5e-05: out of")
        self.assertEqual(self.files(), ["out.png"])

    def test_is_refused(self):
        for options in [["--shard", "0/2", "-o", "a.mbj"], ["--resume"], ["--aa", "adaptive:0.1"]]:
            result = self.run_cli("render", scene_path("cornell-box"), "--target-rmse", "1e-3",
                                  *options)
            self.assert_refused(result, 2, "--target-rmse", options[0])
        for rmse in ["0", "2", "x"]:
            result = self.run_cli("render", scene_path("cornell-box"), "--target-rmse", rmse)
            self.assert_refused(result, 2, "--target-rmse", "expected an RMSE")

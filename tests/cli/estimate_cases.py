# SPDX-License-Identifier: Apache-2.0
"""--estimate: the picture's error, without a reference."""
import json

from harness import CliTest, scene_path

RMSE = r"RMSE about \d\.\de-\d \(\d\.\de-\d to \d\.\de-\d\)"


class Estimate(CliTest):
    def estimate_of(self, *options):
        return self.stats_of("cornell-box", "--size", "80", "--estimate", *options)["estimate"]

    def test_is_in_the_summary_line(self):
        result = self.render("cornell-box", "--size", "80", "--estimate", "-o", "out.png")
        self.assertRegex(result.stderr, RMSE + ", image ")

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
                       ["threads", "--lanes", "1"], ["threads,pocl", "--tile", "7"]]:
            estimates.append(self.estimate_of("--device", *device))
            del estimates[-1]["seconds"]
        self.assertEqual(estimates, estimates[:1] * len(estimates))

    def test_is_near_the_error(self):
        self.render("cornell-box", "--size", "80", "--aa", "sobol:1024", "-o", "right.pfm")
        for aa in ["none", "grid:3", "sobol:16", "adaptive:0.05"]:
            self.render("cornell-box", "--size", "80", "--aa", aa, "-o", "out.pfm")
            error = json.loads(self.run_cli("compare", "out.pfm", "right.pfm", "--clamp",
                                            "--json").stdout)["error"]["rmse"]
            estimate = self.estimate_of("--aa", aa)
            self.assertLess(abs(estimate["rmse"] / error - 1), 0.4, aa)
            self.assertLess(estimate["low"], estimate["rmse"])
            self.assertLess(estimate["rmse"], estimate["high"])

    def test_is_in_the_metadata_of_the_picture(self):
        self.render("cornell-box", "--size", "80", "--estimate", "-o", "out.png")
        self.assertRegex((self.folder / "out.png").read_bytes().decode("latin-1"),
                         r"mirrorball:EstimatedError.{0,9}" + RMSE)

    def test_is_refused_for_shares(self):
        result = self.run_cli("render", scene_path("cornell-box"), "--estimate", "--shard", "0/2",
                              "-o", "out.mbj")
        self.assert_refused(result, 2, "--estimate", "--shard")

# SPDX-License-Identifier: Apache-2.0
"""bench and converge: every figure in their JSON follows from the raw runs in it, computed independently
here."""
import csv
import io
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import unittest

import program
from program import ROOT

SCENE = str(ROOT / "scenes" / "cornell-box.json")
PICTURE = ["flatten", "upload", "trace", "resolve", "read_back"]
TARGETS = [1e-2, 3e-3, 1e-3, 3e-4]
CACHE = tempfile.TemporaryDirectory(prefix="mirrorball-bench-test-")


def run(*arguments, code=0):
    return program.run(*arguments, code=code, XDG_CACHE_HOME=CACHE.name)


def picture_seconds(one):
    return sum(one["seconds"][phase] for phase in PICTURE)


def total_seconds(one):
    return picture_seconds(one) + one["seconds"]["open"] + one["seconds"]["build"]


def spread(values):
    middle = statistics.median(values)
    return {"median": middle, "mad": statistics.median(abs(v - middle) for v in values),
            "min": min(values), "max": max(values)}


class FiguresTest(unittest.TestCase):
    def assert_close(self, found, expected, what=""):
        self.assertAlmostEqual(found, expected, delta=1e-9 * max(1, abs(expected)), msg=what)

    def assert_spread(self, found, values):
        for name, expected in spread(values).items():
            self.assert_close(found[name], expected, name)


class Bench(FiguresTest):
    @classmethod
    def setUpClass(cls):
        cls.file = os.path.join(CACHE.name, "bench.json")
        cls.csv = os.path.join(CACHE.name, "bench.csv")
        cls.table = run("bench", SCENE, "--sizes", "16,24x20", "--repeats", "5", "--threads", "2",
                        "--json", cls.file, "--csv", cls.csv, "-q").stdout
        cls.result = json.loads(pathlib.Path(cls.file).read_text(encoding="utf-8"))

    def base_of(self, row):
        for schedule in [row["schedule"]] if row["schedule"] else ["tiles", "buffers"]:
            for other in self.result["rows"]:
                if (other["device"], other["schedule"]) == ("threads:1", schedule) and all(
                        other[k] == row[k] for k in ["scene", "width", "height", "aa", "precision"]):
                    return other
        return None

    def test_rows_are_complete_and_right(self):
        threads = {(r["width"], r["aa"], r["precision"], r["device"], r["schedule"])
                   for r in self.result["rows"] if r["device_name"] == "threads"}
        # One buffer has work for one thread; and each picture without vectors on one and on two.
        self.assertEqual(len(threads), 2 * 2 * 2 * 4 - 2 * 2 + 2 * 2 * 2 * 2)
        self.assertEqual({run["device"]["lanes"] for row in self.result["rows"]
                          for run in row["repeats"] if row["schedule"] == "scalar"}, {1})
        for row in self.result["rows"]:
            self.assertEqual(row["verdict"], "right", row["why"])
            self.assertEqual((len(row["warm_up"]), len(row["repeats"])), (1, 5))

    def test_has_no_buffers_where_pixels_take_different_samples(self):
        rows = json.loads(run("bench", SCENE, "--sizes", "8", "--aa", "adaptive:0.1", "--devices", "threads:1",
                              "--repeats", "3", "--precision", "float", "-q", "--json").stdout)["rows"]
        self.assertEqual([row["schedule"] for row in rows], ["tiles", "scalar"])

    def test_tells_the_sampling_error_of_each_picture(self):
        errors = [run["estimate"]["rmse"] for run in self.result["references"]]
        self.assertEqual(len(set(errors)), 4)
        self.assertEqual(self.table.count("\n  sampling error: RMSE about "), 8)

    def test_rounds_go_over_all_rows(self):
        """A B A B: all rows warm up, then all have their first repeat, and so on."""
        rounds = [[row["warm_up"][0] for row in self.result["rows"]]]
        rounds += [[row["repeats"][i] for row in self.result["rows"]] for i in range(5)]
        times = [one["started"] for runs in rounds for one in runs]
        self.assertEqual(times, sorted(times))
        self.assertEqual(len(set(times)), len(times))

    def test_medians_and_mads(self):
        for row in self.result["rows"]:
            figures, repeats = row["figures"], row["repeats"]
            self.assert_spread(figures["trace"], [r["seconds"]["trace"] for r in repeats])
            self.assert_spread(figures["total"], [total_seconds(r) for r in repeats])
            rate = repeats[0]["rays"]["total"] / figures["trace"]["median"]
            self.assert_close(figures["rays_per_second"] / rate, 1)

    def test_speed_up_and_amdahl(self):
        for row in self.result["rows"]:
            base, figures = self.base_of(row), row["figures"]
            base_total = statistics.median(total_seconds(r) for r in base["repeats"])
            speed_up = base_total / statistics.median(total_seconds(r) for r in row["repeats"])
            self.assert_close(figures["speed_up"], speed_up)
            trace = statistics.median(r["seconds"]["trace"] for r in base["repeats"])
            self.assert_close(figures["trace_speed_up"], trace / figures["trace"]["median"])
            if row["device_name"] != "threads":
                self.assertIsNone(figures["amdahl"])
                continue
            fraction = trace / base_total
            amdahl = 1 / ((1 - fraction) + fraction / row["threads"])
            self.assert_close(figures["parallel_fraction"], fraction)
            self.assert_close(figures["amdahl"], amdahl)
            self.assert_close(figures["over_amdahl"], speed_up - amdahl)

    def test_table_shows_the_medians(self):
        self.assertLessEqual(max(map(len, self.table.splitlines())), 80)
        for row in self.result["rows"]:
            self.assertIn(f"{row['figures']['trace']['median']:9.5f}", self.table)

    def test_csv_has_a_line_per_run(self):
        text = pathlib.Path(self.csv).read_text(encoding="utf-8")
        lines = list(csv.DictReader(io.StringIO(text)))
        self.assertEqual(len(lines), 6 * len(self.result["rows"]))
        traces = sorted(float(line["trace"]) for line in lines)
        self.assertEqual(traces, sorted(r["seconds"]["trace"] for row in self.result["rows"]
                                        for r in row["warm_up"] + row["repeats"]))
        environment = self.result["environment"]
        for line in lines:
            self.assertEqual(line["machine"], environment["cpu"])
            self.assertTrue(line["version"].startswith(environment["program"].split()[1]))
            self.assertIn(environment["git_revision"], line["version"])
            self.assertEqual(line["driver"] != "", line["device_name"] != "threads")

    def test_a_scene_is_never_replaced_by_results(self):
        before = pathlib.Path(SCENE).read_bytes()
        self.assertIn("choose another name", run("bench", "--json=" + SCENE, code=2).stderr)
        self.assertEqual(pathlib.Path(SCENE).read_bytes(), before)

    def test_numbers_that_are_not_finite_have_their_exit_code(self):
        scene = json.loads(pathlib.Path(SCENE).read_text(encoding="utf-8"))
        scene["ambient_light"] = 1e30
        for material in scene["materials"].values():
            material["ambient"] = 1e6
            material["mirror"] = 1e6
        path = pathlib.Path(CACHE.name, "hot.json")
        path.write_text(json.dumps(scene), encoding="utf-8")
        result = run("bench", path, "--sizes", "8", "--aa", "none", "--devices", "threads:1", "--precision", "float",
                     "--schedules", "tiles", code=6)
        self.assertIn("not finite", result.stderr)

    def test_wrong_usage(self):
        for options in [["--aa", "none,mush"], ["--sizes", "0"], ["--devices", "threads:0"],
                        ["--json", "--csv"], ["--schedules", "x"],
                        ["--schedules", "buffers", "--aa", "adaptive:0.1", "--devices", "threads", "--sizes", "8"]]:
            run("bench", SCENE, *options, code=2)


class Converge(FiguresTest):
    @classmethod
    def setUpClass(cls):
        command = ["converge", SCENE, "--size", "16x12", "--reference-samples", "256", "-q"]
        cls.table = run(*command, "--aa", "none,sobol:4", "--devices", "threads").stdout
        cls.result = json.loads(run(*command, "--aa", "none,grid:4,sobol:16,adaptive:0.1",
                                    "--max-bounces", "8,1", "--devices", "threads:1,threads:2", "--json").stdout)
        cls.points = cls.result["points"]

    def costs(self):
        return [(statistics.median(picture_seconds(r) for r in p["repeats"]),
                 statistics.median(r["error"]["rmse"] for r in p["repeats"])) for p in self.points]

    def test_table_is_narrow(self):
        self.assertLessEqual(max(map(len, self.table.splitlines())), 80)

    def test_promises_nearly_the_true_error(self):
        self.assertRegex(self.table, r"(?m)^  AA .* RMSE +estimate$")
        points = [p for p in self.points if p["max_bounces"] == 8]
        self.assertEqual(len({p["estimate"]["rmse"] for p in points}), 8)
        for point in points:
            ratio = point["estimate"]["rmse"] / point["figures"]["rmse"]
            self.assertTrue(0.5 < ratio < 2, f"{point['aa']}: {ratio}")

    def test_reference_is_the_mean_of_halves(self):
        self.assertNotEqual(*self.result["reference"]["hashes"])
        self.assertEqual(self.result["reference"]["floor"],
                         self.result["reference"]["halves_rmse"] / 2)

    def test_reference_is_kept_in_a_file(self):
        path = os.path.join(CACHE.name, "kept.pfm")
        command = ["converge", SCENE, "--size", "16x12", "--reference-samples", "16", "-q", "--aa", "none",
                   "--devices", "threads:1", "--precision", "float", "--json"]
        first = json.loads(run(*command, "--reference", path).stdout)
        again = json.loads(run(*command, "--reference", path).stdout)
        self.assertNotIn("file", first["reference"])
        self.assertEqual(again["reference"]["file"], path)
        rmse = [result["points"][0]["figures"]["rmse"] for result in (first, again)]
        self.assertEqual(*rmse)
        run(*command, "--size", "8", "--reference", path, code=2)  # given twice
        run(*[word.replace("16x12", "8") for word in command], "--reference", path, code=3)
        run(*command, "--reference", os.path.join(CACHE.name, "kept.png"), code=2)

    def test_a_reference_that_is_kept_knows_its_error_and_its_scene(self):
        """An EXR does; a PFM holds no text."""
        path = os.path.join(CACHE.name, "kept.exr")
        command = ["converge", SCENE, "--size", "16x12", "--reference-samples", "16", "-q", "--aa", "none",
                   "--devices", "threads:1", "--precision", "float", "--reference", path]
        first, again = (json.loads(run(*command, "--json").stdout)["reference"] for _ in range(2))
        self.assertEqual(again, {"file": path, **first})
        self.assertIn("reference: mean of sobol:16 seed 1 and sobol:16 seed 2", run(*command).stdout)
        glass = str(ROOT / "scenes" / "glass.json")
        for other in [[*command[:1], glass, *command[2:]], [*command, "--max-bounces", "9"]]:
            self.assertIn("the reference of another scene", run(*other, code=3).stderr)
        pfm = [*command[:-1], os.path.join(CACHE.name, "unknown.pfm")]
        run(*pfm)
        self.assertIn("whose own error is unknown", run(*pfm).stdout)

    def test_points(self):
        for point, (_, rmse) in zip(self.points, self.costs()):
            self.assertEqual(point["verdict"], "right", point["why"])
            self.assertEqual(len(point["repeats"]), 5)
            figures = point["figures"]
            self.assert_spread(figures["seconds"], [picture_seconds(r) for r in point["repeats"]])
            self.assert_close(figures["rmse"], rmse)
            self.assertEqual(figures["below_floor"], rmse < self.result["reference"]["floor"])

    def test_pareto_front(self):
        costs = self.costs()
        shown = [tuple(float(f"{value:.2e}") for value in cost) for cost in costs]
        front = {(s, e) for s, e in shown
                 if not any(t <= s and f <= e and (t, f) != (s, e) for t, f in shown)}
        found = self.result["pareto_front"]
        self.assertEqual(sorted(shown[i] for i in found), sorted(front))
        self.assertEqual(found, sorted(found, key=lambda i: costs[i][0]))

    def test_seconds_to_rmse(self):
        costs = self.costs()
        devices = list(dict.fromkeys(p["device"] for p in self.points))
        self.assertEqual([(t["device"], t["rmse"]) for t in self.result["seconds_to_rmse"]],
                         [(d, t) for d in devices for t in TARGETS])
        for entry in self.result["seconds_to_rmse"]:
            reached = [s for p, (s, e) in zip(self.points, costs)
                       if p["device"] == entry["device"] and e <= entry["rmse"]]
            self.assertEqual(entry["seconds"] is None, not reached)
            self.assertEqual(entry["below_floor"],
                             entry["rmse"] < self.result["reference"]["floor"])
            if reached:
                self.assert_close(entry["seconds"], min(reached))
                self.assert_close(costs[entry["point"]][0], min(reached))

    def test_a_single_point_has_no_slope(self):
        points = {len(curve["points"]): curve["slope"] for curve in self.result["curves"]}
        self.assertIsNone(points[1])
        two = next(curve for curve in self.result["curves"] if len(curve["points"]) == 2)
        (t0, e0), (t1, e1) = (self.costs()[point] for point in two["points"])
        self.assert_close(two["slope"], math.log(e1 / e0) / math.log(t1 / t0))

    def test_curves_hold_every_point_once(self):
        held = [i for curve in self.result["curves"] for i in curve["points"]]
        self.assertEqual(sorted(held), list(range(len(self.points))))

    def test_builds(self):
        result = json.loads(run("converge", SCENE, "--size", "16x12", "--reference-samples", "16", "-q", "--aa",
                                "none,sobol:4", "--devices", "pocl", "--precision", "float", "--json").stdout)
        self.assertEqual(len(result["builds"]), 1)
        for build in result["builds"]:
            same = [p for p in result["points"]
                    if all(p[k] == build[k] for k in ["device", "precision", "math"])]
            self.assert_spread(build["warm_build"],
                               [r["seconds"]["build"] for p in same for r in p["repeats"]])
            self.assertEqual(build["first_build"], same[0]["warm_up"][0]["seconds"]["build"])

    def test_too_few_repeats_are_refused(self):
        run("converge", SCENE, "--repeats", "4", code=2)


if __name__ == "__main__":
    unittest.main(verbosity=2)

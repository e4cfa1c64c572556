# SPDX-License-Identifier: Apache-2.0
"""The rays of the quick stress suite pass on PoCL, and its options do what they say."""
import json
import pathlib
import tempfile
import unittest

from program import run


def stress(*arguments, code=0):
    return run("stress", *arguments, code=code)


class Output(unittest.TestCase):
    SMALL = ["--case", "scale-2/2^0,scale-2/2^20,leaving-sphere/1", "--quick", "-q"]

    def test_json(self):
        result = json.loads(stress(*self.SMALL, "--json").stdout)
        self.assertTrue(result["passed"])
        rows = [row for family in result["families"] for case in family["cases"]
                for row in case["rows"]]
        self.assertEqual({row["precision"] for row in rows}, {"float", "double"})
        hashes = {row["picture"]["hash"] for case in result["families"][0]["cases"]
                  for row in case["rows"] if row["precision"] == "float"}
        self.assertEqual(len(hashes), 1)
        rays = {(row["renderer"], row["precision"]): row["rays"]["traced"] for row in rows
                if "rays" in row}
        self.assertEqual(len(rays), 4)  # threads and PoCL in float and double
        self.assertGreater(min(rays.values()), 10_000)

    def test_rays_on_pocl(self):
        """Among them packets in which no ray meets anything."""
        lines = stress("--case", "leaving-*/1e-06,leaving-*/1e+06,leaving-edges,sphere-rays/1e-06,sphere-rays/0.5,"
                       "cone-rays/1e-06,cone-rays/0.5,rays-at-*", "--quick", "--device", "pocl", "--all-features",
                       "-q").stdout.splitlines()
        self.assertRegex(lines[0], "^PASS: 9 of 9 families")

    def test_one_build_for_all_changes_no_bit(self):
        one = ["--case", "scale-2/2^0", "-q", "--json"]
        hashes = [{row["picture"]["hash"] for row in
                   json.loads(stress(*one, *more).stdout)["families"][0]["cases"][0]["rows"]}
                  for more in ([], ["--all-features"])]
        self.assertEqual(*hashes)
        self.assertEqual(len(hashes[0]), 2)

    def test_table(self):
        lines = stress(*self.SMALL, "--device", "threads").stdout.splitlines()
        self.assertEqual(len(lines), 3)
        self.assertRegex(lines[0], "^PASS: 2 of 2 families")
        self.assertRegex(lines[1], "^pass scale-2 .* wrong")
        self.assertLessEqual(max(map(len, lines)), 80)

    def test_pictures(self):
        with tempfile.TemporaryDirectory() as folder:
            stress("--case", "picture-shape/1x1", "--device", "threads", "-q", "-o", folder)
            names = sorted(path.name for path in pathlib.Path(folder).iterdir())
            self.assertEqual(names, [f"picture-shape-1x1.{kind}.png"
                                     for kind in ["error", "reference", "worst"]])

    def test_json_never_replaces_something_else(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "scene.json"
            path.write_text("{}")
            stress(*self.SMALL, "--json", str(path), code=2)
            self.assertEqual(path.read_text(), "{}")


class Usage(unittest.TestCase):
    def test_unknown_family(self):
        error = stress("--case", "scale-3", code=2).stderr
        self.assertIn("scale-3", error)
        self.assertIn("\n  scale-2\n", error)

    def test_unknown_device(self):
        stress("--device", "nonsense", code=2)
        stress("--device", "99", code=5)

    def test_list_marks_the_quick_ones(self):
        text = stress("--list").stdout
        self.assertIn("  shift/1e9  quick\n", text)
        self.assertIn("  shift/1e8\n", text)
        self.assertNotIn("shift/1e8", stress("--list", "--quick").stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)

# SPDX-License-Identifier: Apache-2.0
"""Runs every kernel under Oclgrind: no bad memory access, and the bits of the pthreads renderer.

Oclgrind exits with 0 when it has found errors, so its log is what is judged.
"""
import json
import pathlib
import subprocess
import tempfile
import unittest

from program import HANG_LIMIT, PROGRAM, ROOT


def render(scenes, options, device, prefix=()):
    """The --stats=json of each scene's picture, of 20 x 20 pixels where the options do not say."""
    size = [] if "--size" in options else ["--size", "20"]
    command = [*prefix, PROGRAM, "render", *(str(ROOT / "scenes" / scene) for scene in scenes), *size,
               "--device", device, "--no-fallback", "--progress", "none", "--stats=json", *options]
    result = subprocess.run(command, capture_output=True, text=True, timeout=HANG_LIMIT)
    if result.returncode != 0:
        raise AssertionError(f"{command}: exit {result.returncode}\n{result.stderr}")
    return [json.loads(text) for text in (result.stdout.splitlines() if len(scenes) > 1 else [result.stdout])]


class Oclgrind(unittest.TestCase):
    def check(self, scenes, *options):
        with tempfile.TemporaryDirectory() as folder:
            log = pathlib.Path(folder) / "oclgrind.log"
            simulated = render(scenes, options, "0", ("oclgrind", "--check-api", "--log", str(log)))
            self.assertEqual(log.read_text() if log.exists() else "", "")
        threads = render(scenes, options, "threads")
        self.assertEqual(len(simulated), len(scenes))
        for scene, one, other in zip(scenes, simulated, threads):
            with self.subTest(scene=scene):
                self.assertEqual(one["device"]["platform"], "Oclgrind")
                self.assertEqual(one["image"]["hash"], other["image"]["hash"])
                self.assertEqual(one["rays"], other["rays"])

    def test_every_scene(self):
        """Their cones, meshes, hierarchies, and the stack of glass; one program for all of them."""
        folder = ROOT / "scenes"
        scenes = sorted(str(path.relative_to(folder)) for path in folder.rglob("*.json")
                        if path.name not in ("golden.json", "scene.schema.json"))
        self.assertGreater(len(scenes), 10)
        self.check(scenes, "--size", "4x27", "--aa", "none", "--features", "all")

    def test_every_kernel(self):
        for options in [["--launch", "pixel"], ["--launch", "sample"], ["--launch", "pixel", "--precision", "double"],
                        ["--aa", "adaptive:0.4"], ["--aa", "edges:0.1"],
                        ["--aa", "sobol:4", "--filter", "gaussian", "--launch", "sample"]]:
            with self.subTest(options=options):
                self.check(["cornell-box.json"], *options)


if __name__ == "__main__":
    unittest.main(verbosity=2)

# SPDX-License-Identifier: Apache-2.0
"""A driver ends its process in the middle of several pictures."""
import json
import pathlib

from driver_case import ROOT, WrongDriver


class DiesInABatch(WrongDriver):
    """Several pictures by a driver that ends its process: each is rendered once."""

    NAMES = ["glass.json", "cones.json", "torus.ply", "single-sphere.json", "two-sided.json",
             "glass.json"]
    SMALL = ["--size", "40", "-o", "%s.png", "--stats=json", "--threads", "1"]

    def setUp(self):
        super().setUp()
        self.scenes = []
        for i, name in enumerate(self.NAMES):
            scene = self.folder / f"{i}{pathlib.Path(name).suffix}"
            scene.symlink_to(ROOT / "scenes" / name)
            self.scenes.append(str(scene))

    def figures(self, code, text, arguments, **shim):
        """The batch's JSON lines, by scene, and what it said."""
        result = self.run_with(shim, "render", *arguments, code=code, cwd=self.folder, text=text)
        lines = [json.loads(line) for line in result.stdout.splitlines()]
        return [(line["scene"]["path"], line["image"]["hash"]) for line in lines], result.stderr

    def check(self, code, text, *arguments, by="abort", at="22"):
        """By a worker that dies at its `at`-th launch (up to six a picture). Returns what was said."""
        right, _ = self.figures(code, text, [*arguments, "--device", "threads"])
        got, said = self.figures(code, text, [*arguments, "--device", "pocl", "--deadline", "1"],
                                 CL_SHIM_DIE_IN="clEnqueueNDRangeKernel", CL_SHIM_DIE_BY=by,
                                 CL_SHIM_DIE_AT=at)
        self.assertEqual(got, right)
        return said

    def test_of_the_command_line(self):
        said = self.check(0, "", *self.scenes, *self.SMALL)
        self.assertIn("was killed by SIGABRT; rendering on threads instead", said)

    def test_of_a_list(self):
        scenes = [f"{scene}\n" for scene in self.scenes]
        scenes[2:2] = ["# a comment\n", "nowhere.json\n"]
        last = "mirrorball: 1 of 7 pictures failed, with exit codes: nowhere.json (3)"
        said = self.check(3, "".join(scenes), "--batch", "-", *self.SMALL)
        self.assertEqual(said.count("nowhere.json: "), 1)
        self.assertIn(last, said.splitlines()[-1])
        (self.folder / "list").write_text("".join(scenes))
        self.assertIn(last, self.check(3, "", "--batch", "list", *self.SMALL, by="hang").splitlines()[-1])

    def test_of_frames(self):
        (self.folder / "path.json").write_text(json.dumps({
            "image": {"width": 40, "height": 30}, "camera": {"from": [0, 0, 5], "at": [0, 0, 0],
                                                            "fov_degrees": 40},
            "materials": {"red": {"ambient": [1, 0, 0]}},
            "spheres": [{"center": [0, 0, 0], "radius": 1, "material": "red"}],
            "path": {"keys": [{"frame": 1, "from": [0, 0, 5]}, {"frame": 6, "from": [2, 0, 5]}]}}))
        self.assertIn("rendering on threads instead", self.check(
            0, "", "path.json", "--frames", "1-6", "-o", "%d.png", "--stats=json"))

# SPDX-License-Identifier: Apache-2.0
"""render --frames: an animation along the scene's camera path."""
import json

from harness import CliTest, scene_path

SCENE = {
    "camera": {"from": [0, 0, 5], "at": [0, 0, 0], "fov_degrees": 40},
    "image": {"width": 32, "height": 24, "aa": "none"},
    "ambient_light": 1,
    "materials": {"red": {"ambient": [1, 0, 0]}},
    "spheres": [{"center": [0, 0, 0], "radius": 1, "material": "red"},
                *({"center": [i / 10 - 2, i % 7 / 3 - 1, -1], "radius": 0.05, "material": "red"}
                  for i in range(40))],  # enough for a hierarchy
    "path": {"interpolation": "linear",
             "keys": [{"frame": 1, "from": [-2, 0, 5]}, {"frame": 5, "from": [2, 0, 5]}]}}


class Frames(CliTest):
    def setUp(self):
        super().setUp()
        self.write_text("s.json", json.dumps(SCENE))

    def frames(self, *options, code=0, output="f%02d.pfm"):
        result = self.run_cli("render", "s.json", "--device", "threads:1", "-o", output, *options)
        self.assertEqual(result.returncode, code, result.stderr)
        return result

    def names(self):
        return sorted(path.name for path in self.folder.glob("f*"))

    def test_each_has_the_picture_of_its_camera(self):
        self.frames("--frames", "1-5")
        self.assertEqual(self.names(), [f"f{i:02}.pfm" for i in range(1, 6)])
        still = {key: value for key, value in SCENE.items() if key != "path"}
        for frame, x in [(1, -2), (3, 0), (4, 1)]:
            still["camera"] = {**SCENE["camera"], "from": [x, 0, 5]}
            self.write_text("still.json", json.dumps(still))
            self.run_cli("render", "still.json", "--device", "threads:1", "-o", "still.pfm")
            self.assertEqual(self.bytes_of("still.pfm"),
                             self.bytes_of(f"f{frame:02}.pfm"), frame)

    def test_a_list_of_them(self):
        self.frames("--frames", "2,4-5,9", output="f%d.pfm")
        self.assertEqual(self.names(), ["f2.pfm", "f4.pfm", "f5.pfm", "f9.pfm"])

    def test_one_frame_to_standard_output(self):
        self.frames("--frames", "2")
        program = "$MIRRORBALL render s.json --device threads:1 --frames 2 -q -o - --format pfm"
        result = self.run_shell(f"{program} | cmp - f02.pfm")
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_resume_renders_those_that_are_missing(self):
        self.frames("--frames", "1-3")
        mine = (self.folder / "f01.pfm").read_bytes()
        (self.folder / "f02.pfm").write_bytes(mine)
        (self.folder / "f03.pfm").unlink()
        result = self.frames("--frames", "1-3", "--resume")
        self.assertIn("skipped 2 existing frames", result.stderr)
        self.assertEqual((self.folder / "f02.pfm").read_bytes(), mine)
        self.assertTrue((self.folder / "f03.pfm").exists())
        self.assertIn("skipped 3 existing frames", self.frames("--frames", "1-3", "--resume").stderr)

    def test_resume_replaces_those_that_are_cut_or_hold_nan(self):
        self.frames("--frames", "1-2")
        whole = (self.folder / "f01.pfm").read_bytes()
        for bad in [whole[:-1], whole[:-4] + b"\0\0\xc0\x7f"]:
            (self.folder / "f01.pfm").write_bytes(bad)
            self.assertIn("skipped 1 existing frame", self.frames("--frames", "1-2", "--resume").stderr)
            self.assertEqual((self.folder / "f01.pfm").read_bytes(), whole)

    def test_resume_replaces_those_of_other_pictures(self):
        for ending in ["png", "exr"]:
            with self.subTest(ending=ending):
                output = f"f%02d.{ending}"
                self.frames("--frames", "1-2", output=output)
                again = ["--frames", "1-2", "--resume"]
                self.assertIn("skipped 2 existing frames", self.frames(*again, output=output).stderr)
                for change in [["--encoding", "srgb"], ["--size", "16x12"], ["--ambient", "0.5"],
                               ["--precision", "double"]]:
                    self.frames("--frames", "1", *change, output=output)
                    result = self.frames(*again, *change, output=output)
                    self.assertIn("skipped 1 existing frame", result.stderr)
                    result = self.frames(*again, *change, output=output)
                    self.assertIn("skipped 2 existing frames", result.stderr)
                whole = (self.folder / f"f01.{ending}").read_bytes()
                for cut in [b"cut", whole[:-20]]:
                    (self.folder / f"f01.{ending}").write_bytes(cut)
                    self.assertIn("skipped 1 existing frame", self.frames(*again, *change, output=output).stderr)
                    self.assertEqual((self.folder / f"f01.{ending}").read_bytes(), whole)

    def test_a_scene_that_cannot_be_read_is_told_once(self):
        (self.folder / "s.json").unlink()
        result = self.frames("--frames", "1-3", code=3)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)

    def test_shares_of_them_are_all_of_them(self):
        for share in range(3):
            self.frames("--frames", "1-5", "--shard", f"{share}/3")
            self.assertEqual(len(self.names()), [2, 4, 5][share])

    def test_one_that_fails_does_not_stop_the_others(self):
        scene = json.loads(json.dumps(SCENE))
        scene["path"]["keys"] = [{"frame": 1, "from": [0, 0, 5]}, {"frame": 3, "from": [0, 0, -5]}]
        self.write_text("s.json", json.dumps(scene))
        result = self.frames("--frames", "1-3", code=3)
        self.assertEqual(self.names(), ["f01.pfm", "f03.pfm"])
        self.assertIn("frame 2 (3)", result.stderr)

    def test_what_makes_no_sense_is_refused(self):
        for options, words in [(["--frames", "5-1"], "expected frames"), (["--frames", "x"], "expected frames"),
                               (["--frames", "1,"], "expected frames"), (["--frames", "-1"], "frames"),
                               (["--frames", "1-9999999"], "999999"),
                               (["--frames", "1", "--shard", "1/2"], "no frame"),
                               (["--frames", "1", "--reference", "f1.pfm"], "--reference")]:
            result = self.frames(*options, code=2)
            self.assertIn(words, result.stderr)
        for output in ["one.pfm", "f%d%d.pfm", "f%s.pfm"]:
            self.assertIn("%04d", self.frames("--frames", "1-2", code=2, output=output).stderr)
        result = self.run_cli("render", scene_path("single-sphere"), "--frames", "1-2", "-o", "f%d.pfm")
        self.assertEqual(result.returncode, 3)
        self.assertIn("path", result.stderr)
        self.assertEqual(self.names(), [])

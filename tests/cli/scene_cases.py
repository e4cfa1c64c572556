# SPDX-License-Identifier: Apache-2.0
"""Scene files: what is refused and how (exit 3), and `scene info`, `scene check`."""
import json
import os
import shutil

from harness import CAMERA, GRAY, CliTest, all_scenes, scene_path
from program import ROOT


class Unreadable(CliTest):
    def assert_scene_refused(self, path, *says):
        for verb in [("render", "-o", "out.png"), ("scene", "info"), ("scene", "check")]:
            with self.subTest(verb=verb):
                self.assert_refused(self.run_cli(*verb, path), 3, str(path), *says)
        self.assertNotIn("out.png", self.files())

    def test_what_is_no_file_or_of_no_known_format(self):
        os.mkfifo(self.folder / "fifo.json")
        os.symlink("loop.json", self.folder / "loop.json")
        self.write_text("file", "")
        (self.folder / "noise.json").write_bytes(bytes(range(256)) * 16)
        for path, words in [("nowhere.json", "no such file"), (self.folder, "directory"),
                            ("fifo.json", "regular file"), ("/dev/zero", "regular file"),
                            ("file/scene.json", ""), ("x" * 5000 + ".json", ""), ("loop.json", ""),
                            (self.write_text("empty.json", ""), ""), ("noise.json", "noise.json:1:1"),
                            (self.write_text("ball.off", "ball\n"), "unknown extension '.off'"),
                            (self.write_text("ball.stl", "solid ball\n"), "unknown extension '.stl'")]:
            self.assert_scene_refused(path, words)

    def test_a_format_is_known_by_its_contents(self):
        shutil.copy(scene_path("empty"), self.folder / "ball.txt")
        self.assertEqual(self.run_cli("scene", "check", "ball.txt").returncode, 0)


class HostileNames(CliTest):
    NAME = os.fsdecode(b"new\nline \x1b[31m\x9b31m" + "\x9b31m\u202e".encode())

    def test_control_characters_do_not_reach_the_terminal(self):
        scene, bad, picture = (f"{self.NAME}{ending}" for ending in [".json", "-bad.json", ".png"])
        shutil.copy(scene_path("single-sphere"), self.folder / scene)
        (self.folder / bad).write_text("{}")
        bench = ["bench", scene, "--sizes", "8", "--aa", "none", "--devices", "threads", "--repeats", "1", "-q"]
        converge = ["converge", scene, "--size", "8", "--aa", "none", "--devices", "threads",
                    "--reference-samples", "4", "-q"]
        render = ["render", scene, "--size", "8", "--device", "threads", "-o", picture, "--stats"]
        compare = ["compare", picture, picture, "--heatmap", f"{self.NAME}-map.png"]
        for arguments in [bench, [*bench, "--csv=-"], [*bench, "--json=-"], converge, [*converge, "--json=-"],
                          render, [*render, "json"], compare, [*compare, "--json=-"],
                          *(["scene", verb, name, *more] for verb in ["check", "info"] for name in [scene, bad]
                            for more in [[], ["--json"]])]:
            with self.subTest(arguments=arguments):
                result = self.run_cli(*arguments, env={"XDG_CACHE_HOME": str(self.folder)})
                self.assertEqual(result.returncode, 3 if bad in arguments else 0, result.stderr)
                self.assertNotRegex(result.stdout + result.stderr,
                                    "[\x00-\x09\x0b-\x1f\x7f-\x9f\u202e]|new\nline")


class MalformedFiles(CliTest):
    """What is said of each, and where, is tested with the readers."""

    def test_one_of_each_format(self):
        for ending in [".json", ".nff", ".obj", ".ply"]:
            for path in sorted((ROOT / "tests" / "scenes_bad").glob(f"*{ending}"))[::10]:
                with self.subTest(path=path.name):
                    result = self.run_cli("scene", "check", path)
                    self.assertEqual((result.returncode, result.stdout), (3, ""))
                    self.assertIn(f"{path}:", result.stderr)


class NeutralFileFormat(CliTest):
    """.nff files; what is wrong in them is tested with the reader."""

    TEXT = ("v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 1\nresolution 32 24\n"
            "l 1 2 3\nf 1 0.5 0.5 0.8 0 1 0 0\ns 0 0 0 1\n")

    def test_info(self):
        path = self.write_text("ball.NFF", self.TEXT)
        info = json.loads(self.output("scene", "info", path, "--json"))
        self.assertEqual((info["name"], info["width"], info["height"]), ("ball", 32, 24))
        self.assertEqual((info["spheres"], info["cones"], info["max_bounces"]), (1, 0, 4))

    def test_mistakes_have_line_and_column(self):
        path = self.write_text("bad.nff", self.TEXT.replace("s 0 0 0 1\n", "\ns 0 0 0 0\nq\n"))
        for verb in [("render", "-o", "out.png"), ("scene", "check"), ("bench", "--repeats", "1"),
                     ("converge",)]:
            with self.subTest(verb=verb):
                result = self.run_cli(*verb, path)
                self.assert_refused(result, 3, f"{path}:11:1: ", f"{path}:12:1: ", lines=2)

    def test_light_is_half_and_may_be_set(self):
        path = self.write_text("ball.nff", self.TEXT)
        plain = self.hash_of(path)
        self.assertEqual(self.hash_of(path, "--light-scale", "0.5", "--ambient", "0.5"), plain)
        self.assertEqual(self.hash_of(path, "--ambient", "0.5,0.5,0.5"), plain)
        self.assertNotEqual(self.hash_of(path, "--light-scale", "1"), plain)
        self.assertNotEqual(self.hash_of(path, "--ambient", "0"), plain)

    def test_light_scale_leaves_given_intensities_alone(self):
        light = {"position": [1, 2, 3], "intensity": 0.7}
        scene = {"materials": {"m": GRAY}, "spheres": [{"center": [0, 0, 0], "radius": 1,
                                                        "material": "m"}]}
        given = self.write_scene("given.json", lights=[light], **scene)
        left_open = self.write_scene("open.json", lights=[{"position": [1, 2, 3]}], **scene)
        size = ["--size", "16"]
        plain = self.hash_of(given, *size)
        self.assertEqual(self.hash_of(given, *size, "--light-scale", "0.3"), plain)
        self.assertEqual(self.hash_of(left_open, *size, "--light-scale", "0.7"), plain)
        for path, says in [(given, True), (left_open, False)]:
            said = self.succeed("render", path, *size, "--light-scale", "0.3").stderr
            self.assertEqual("given.json: --light-scale has no effect" in said, says)


TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


class Models(CliTest):
    def test_alone(self):
        info = json.loads(
            self.output("scene", "info", self.write_text("a.obj", TRIANGLE), "--json"))
        self.assertEqual((info["name"], info["meshes"], info["mesh_triangles"]), ("a", 1, 1))

    def test_in_a_scene(self):
        self.assertIn("3 meshes, 846 triangles", self.output("scene", "info", scene_path("meshes")))

    def test_bounds(self):
        path = self.write_text("a.obj", TRIANGLE)
        self.assertIn("1 mesh, 1 triangle\n  reaches    from (0, 0, 0) to (1, 1, 0)\n",
                      self.output("scene", "info", path))
        for name, bounds in [(path, [[0, 0, 0], [1, 1, 0]]), (scene_path("empty"), None)]:
            self.assertEqual(json.loads(self.output("scene", "info", name, "--json"))["bounds"], bounds)

    def test_what_is_left_out_is_said(self):
        path = self.write_text("a.obj", TRIANGLE + "f 1 1 2\nl 1 2\nf 1 2 9\n")
        render = ["render", "--device", "threads", "--size", "8"]
        for verb, count in [(render, 3), ([*render, "-q"], 0), (["scene", "check"], 3)]:
            result = self.succeed(*verb, path)
            self.assertEqual(sum(f"{path}:" in line for line in result.stderr.splitlines()), count)
        self.assertEqual(len(json.loads(self.output("scene", "check", path, "--json"))["notes"]), 3)

    def test_checks_of_what_is_over_a_limit_are_json_too(self):
        path = self.write_scene(max_bounces=17, lights=[{"position": [0, 0, 9]}],
                                materials={"m": {"mirror": 0.5, "transmission": 0.5}},
                                spheres=[{"center": [0, 0, 0], "radius": 0.5, "material": "m"}])
        result = self.run_cli("scene", "check", path, "--json")
        self.assertEqual(result.returncode, 7)
        self.assertTrue(json.loads(result.stdout)["mistakes"][0].startswith("scene: max_bounces is 17, "))

    def test_bench_says_what_is_left_out(self):
        path = self.write_text("A.OBJ", TRIANGLE + "f 1 1 2\n")
        result = self.succeed("bench", path, "--devices", "threads", "--threads", "1", "--sizes", "8",
                              "--aa", "none", "--repeats", "1")
        self.assertEqual(result.stderr.count("ignored"), 1)

    def test_light_of_a_model_alone(self):
        path = self.write_text("a.obj", TRIANGLE)
        plain = self.hash_of(path)
        self.assertEqual(self.hash_of(path, "--ambient", "0.25"), plain)
        self.assertNotEqual(self.hash_of(path, "--ambient", "0"), plain)
        self.assertNotEqual(self.hash_of(path, "--light-scale", "0.75"), plain)


class Schema(CliTest):
    def test_is_the_one_that_scenes_name(self):
        self.assertEqual(self.run_cli("scene", "schema").stdout, (ROOT / "scenes" / "scene.schema.json").read_text())


class Check(CliTest):
    def test_all_shipped_scenes_are_fine(self):
        for path in all_scenes():
            with self.subTest(scene=path.name):
                self.assertEqual(self.output("scene", "check", path), f"{path}: fine\n")

    def test_what_is_hardly_meant_is_a_warning(self):
        path = self.write_scene(materials={"m": {"diffuse": 1}},
                                spheres=[{"center": [0, 0, 9], "radius": 1, "material": "m"}])
        result = self.run_cli("scene", "check", path)
        self.assertEqual((result.returncode, result.stdout), (0, f"{path}: can be rendered, with 2 warnings\n"))
        for words in ["no light reaches", "nothing is in view"]:
            self.assertIn(f"mirrorball: {path}: warning: {words}", result.stderr)
        for verb in ["check", "info"]:
            info = json.loads(self.output("scene", verb, path, "--json"))
            self.assertEqual(len(info["warnings"]), 2)
        self.assertEqual(self.run_cli("scene", "info", path).stdout.count("  warning  "), 2)

    def test_frames_between_keys(self):
        """Halfway between the two keys the camera is where it looks."""
        path = self.write_scene(
            camera={"from": [0, 0, 5], "at": [0, 0, 0], "fov_degrees": 40},
            path={"interpolation": "linear", "keys": [{"frame": 1}, {"frame": 3, "from": [0, 0, -5]}]})
        self.assert_refused(self.run_cli("scene", "check", path), 3, "the camera's path at frame 2")


class Info(CliTest):
    def info(self, name):
        return json.loads(self.output("scene", "info", scene_path(name), "--json"))

    def test_features_used_and_left_out_are_all_features(self):
        every = set()
        for path in all_scenes():
            info = self.info(path.stem)
            used, left_out = set(info["features_used"]), set(info["features_left_out"])
            self.assertFalse(used & left_out)
            every = every or used | left_out
            self.assertEqual(used | left_out, every)

    def test_empty_scene_needs_nothing(self):
        self.assertEqual(self.info("empty")["features_used"], [])

    def test_hash_does_not_depend_on_layout_or_name_of_the_file(self):
        keys = {"materials": {"gray": GRAY}, "name": "same"}
        first = self.write_scene("first.json", **keys)
        second = self.write_text("second.json", json.dumps({**keys, "camera": CAMERA}, indent=3))
        hashes = [json.loads(self.run_cli("scene", "info", path, "--json").stdout)["hash"]
                  for path in [first, second]]
        self.assertEqual(*hashes)

    def test_text(self):
        text = self.output("scene", "info", scene_path("cornell-box"))
        for word in ["cornell-box", "500x500", "triangles", "mirrors"]:
            self.assertIn(word, text)

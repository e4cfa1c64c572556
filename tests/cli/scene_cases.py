# SPDX-License-Identifier: Apache-2.0
"""Scene files: what is refused and how (exit 3), and `scene info`, `scene check`."""
import json
import os
import shutil

from harness import CAMERA, GRAY, CliTest, all_scenes, malformed_files, scene_path


class Unreadable(CliTest):
    def assert_scene_refused(self, path, *says):
        for verb in [("render", "-o", "out.png"), ("scene", "info"), ("scene", "check")]:
            with self.subTest(verb=verb):
                self.assert_refused(self.run_cli(*verb, path), 3, str(path), *says)
        self.assertNotIn("out.png", self.files())

    def test_missing(self):
        self.assert_scene_refused("nowhere.json", "no such file")

    def test_folder(self):
        self.assert_scene_refused(self.folder, "directory")

    def test_fifo_does_not_hang(self):
        os.mkfifo(self.folder / "fifo.json")
        self.assert_scene_refused("fifo.json", "regular file")

    def test_empty(self):
        self.assert_scene_refused(self.write_text("empty.json", ""))

    def test_device_file(self):
        self.assert_scene_refused("/dev/zero", "regular file")

    def test_name_is_a_file_where_a_folder_should_be(self):
        self.write_text("file", "")
        self.assert_scene_refused("file/scene.json")

    def test_name_longer_than_the_system_takes(self):
        self.assert_scene_refused("x" * 5000 + ".json")

    def test_binary(self):
        (self.folder / "noise.json").write_bytes(bytes(range(256)) * 16)
        self.assert_scene_refused("noise.json", "noise.json:1:1")

    def test_format_that_is_unknown(self):
        self.assert_scene_refused(self.write_text("ball.off", "ball\n"), "unknown extension '.off'")
        self.assert_scene_refused(self.write_text("ball.stl", "solid ball\n"), "is an STL model")
        shutil.copy(scene_path("empty"), self.folder / "ball.txt")
        self.assertEqual(self.run_cli("scene", "check", "ball.txt").returncode, 0)

    def test_symbolic_link_to_itself(self):
        os.symlink("loop.json", self.folder / "loop.json")
        self.assert_scene_refused("loop.json")


class Mistakes(CliTest):
    """Each message begins with file:line:column."""

    def assert_mistake(self, text, place, *says, lines=1):
        path = self.write_text("bad.json", text)
        result = self.run_cli("render", path, "-o", "out.png")
        self.assert_refused(result, 3, f"{path}:{place}", *says, lines=lines)
        self.assertEqual(self.files(), ["bad.json"])

    def scene_with(self, line):
        return '{\n"camera": ' + json.dumps(CAMERA) + ",\n" + line + "\n}"

    def test_malformed(self):
        self.assert_mistake('{\n  "camera" 5\n}', "2:12")

    def test_ends_too_early(self):
        self.assert_mistake('{"camera": ', "1:")

    def test_unknown_key(self):
        self.assert_mistake(self.scene_with('"light": []'), "3:1", "light", "lights")

    def test_duplicate_key(self):
        self.assert_mistake(self.scene_with('"name": "a", "name": "b"'), "3:14", "name")

    def test_wrong_type(self):
        self.assert_mistake(self.scene_with('"max_bounces": "many"'), "3:16", "max_bounces")

    def test_nan(self):
        self.assert_mistake(self.scene_with('"background": NaN'), "3:15")

    def test_number_beyond_double(self):
        self.assert_mistake(self.scene_with('"background": 1e999'), "3:15", "1e999")

    def test_negative_radius(self):
        sphere = '"spheres": [{"center": [0, 0, 0], "radius": -1, "material": "m"}]'
        self.assert_mistake(self.scene_with('"materials": {"m": {}}, ' + sphere), "3:", "radius")

    def test_unknown_material(self):
        sphere = '"spheres": [{"center": [0, 0, 0], "radius": 1, "material": "gold"}]'
        self.assert_mistake(self.scene_with(sphere), "3:", "gold")

    def test_zero_field_of_view(self):
        camera = dict(CAMERA, fov_degrees=0)
        self.assert_mistake(json.dumps({"camera": camera}), "1:", "fov_degrees")

    def test_no_camera(self):
        self.assert_mistake("{}", "1:1", "camera")

    def test_several_at_once(self):
        self.assert_mistake('{"one": 1,\n"two": 2, "camera": ' + json.dumps(CAMERA) + "}",
                            "2:1", "bad.json:1:2", lines=2)

    def test_at_most_twenty(self):
        keys = "".join(f'"key{i}": 0,\n' for i in range(50))
        result = self.run_cli("scene", "check", self.write_text("bad.json", "{" + keys + "}"))
        self.assertEqual(result.returncode, 3)
        self.assertLessEqual(len(result.stderr.splitlines()), 21)

    def test_control_characters_do_not_reach_the_terminal(self):
        path = self.write_text("bad.json", '{"\\u001b[31m": 1, "camera": 1}')
        self.assertNotIn("\x1b", self.run_cli("scene", "check", path).stderr)

    def test_nor_do_those_of_file_names(self):
        names = ["new\nline", "esc\x1b[31m", b"csi\x9b31m", "c1\x9b31m", "bidi\u202e"]
        for name in [n if isinstance(n, bytes) else n.encode() for n in names]:
            path = os.path.join(os.fsencode(self.folder), name + b".json")
            for text, code in [("{}", 3), (json.dumps({"camera": CAMERA}), 0)]:
                with open(path, "w", encoding="utf-8") as file:
                    file.write(text)
                for verb in [("check",), ("check", "--json"), ("info",), ("info", "--json")]:
                    with self.subTest(name=name, verb=verb):
                        result = self.run_cli("scene", *verb, os.fsdecode(path))
                        self.assertEqual(result.returncode, code)
                        for stream in [result.stdout, result.stderr]:
                            self.assertNotRegex(stream, "[\x00-\x09\x0b-\x1f\x7f-\x9f\u202e]")
                        self.assertNotIn("new\nline", result.stdout + result.stderr)

    def test_nesting_bomb(self):
        self.assert_mistake("[" * 100000, "1:65")


class MalformedFiles(CliTest):
    """What is said of each, and where, is tested with the readers."""

    def test_one_of_each_format(self):
        for ending in [".json", ".nff", ".obj", ".ply"]:
            for path in malformed_files(ending)[::10]:
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
                self.assert_refused(result, 3, f"{path}:11:9: ", f"{path}:12:1: ", lines=2)

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

    def test_cones_are_counted(self):
        cone = {"base": [0, 0, 0], "base_radius": 1, "apex": [0, 1, 0], "apex_radius": 0,
                "material": "m"}
        path = self.write_scene(materials={"m": {"transmission": 0.5, "ior": 1.5}}, cones=[cone])
        info = json.loads(self.run_cli("scene", "info", path, "--json").stdout)
        self.assertEqual(info["cones"], 1)


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

    def test_mistakes(self):
        path = self.write_text("a.obj", TRIANGLE.replace("f 1 2 3", "f 1 2 9"))
        self.assert_refused(self.run_cli("render", path, "-o", "out.png"), 3, f"{path}:4:7: ")

    def test_fifo_does_not_hang(self):
        os.mkfifo(self.folder / "fifo.ply")
        self.assert_refused(self.run_cli("scene", "check", "fifo.ply"), 3, "regular file")


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


class Info(CliTest):
    def info(self, name):
        return json.loads(self.output("scene", "info", scene_path(name), "--json"))

    def test_json_fields(self):
        info = self.info("single-sphere")
        self.assertEqual((info["format"], info["version"]), ("mirrorball-scene-info", 1))
        self.assertEqual((info["width"], info["height"], info["aa"]), (240, 180, "grid:2"))
        self.assertEqual((info["spheres"], info["triangles"], info["lights"]), (1, 0, 1))
        self.assertRegex(info["hash"], "^[0-9a-f]{16}$")

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

    def test_check_json_is_json(self):
        json.loads(self.succeed("scene", "check", scene_path("empty"), "--json").stdout)

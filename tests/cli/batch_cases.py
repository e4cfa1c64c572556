# SPDX-License-Identifier: Apache-2.0
"""Several scenes by one command: the pictures of one each, errors that stop nothing but their own."""
import json
import pathlib
import signal
import subprocess

from harness import CliTest, scene_path
from program import HANG_LIMIT

SMALL = ["--size", "32", "--device", "threads"]


class SeveralScenes(CliTest):
    def test_pictures_are_those_of_a_command_each(self):
        scenes = ["single-sphere", "glass", "cones", "glass"]
        for scene in scenes:
            self.assertEqual(self.run_cli("render", scene_path(scene), "-o", f"alone-{scene}.png",
                                          *SMALL).returncode, 0)
        for device in ["threads", "pocl"]:
            result = self.succeed("render", *map(scene_path, scenes[:3]), "-o", f"{device}-%s.png",
                                  "--size", "32", "--device", device)
            self.assertEqual(len(result.stderr.splitlines()), 3)
            for scene in scenes[:3]:
                self.assertEqual(self.bytes_of(f"{device}-{scene}.png"),
                                 self.bytes_of(f"alone-{scene}.png"))

    def test_what_differs_in_settings_alone_is_not_mistaken_for_the_scene_before(self):
        changes = [{}, {"width": 24}, {"aa": "grid:3"}, {"aa": "sobol:4"}, {"max_bounces": 1}]
        scene = json.loads(pathlib.Path(scene_path("glass")).read_text())
        names = []
        for i, image in enumerate(changes):
            max_bounces = image.pop("max_bounces", 8)
            scene.update({"image": {"width": 32, "height": 24, "aa": "grid:2", **image},
                          "max_bounces": max_bounces})
            names.append(self.write_text(f"{i}.json", json.dumps(scene)))
        self.succeed("render", *names, "-o", "%s.png", "--device", "threads")
        for name in names:
            alone = self.succeed("render", name, "-o", "alone.png", "--device", "threads")
            self.assertEqual(self.bytes_of("alone.png"),
                             self.bytes_of(pathlib.Path(name).stem + ".png"), name)

    def test_without_outputs_it_says_once_that_nothing_is_saved(self):
        for scenes in [[scene_path("cones"), scene_path("glass")],
                       ["--batch", self.write_text("list", f"{scene_path('cones')}\n" * 2)]]:
            result = self.run_cli("render", *scenes, *SMALL)
            self.assertEqual(result.stderr.count("is not saved"), 1, result.stderr)
            self.assertNotIn("is not saved", self.run_cli("render", *scenes, *SMALL, "-q").stderr)

    def test_no_output_replaces_a_later_scene_of_the_list(self):
        scene = pathlib.Path(scene_path("cones")).read_text()
        later = self.write_text("later.png", scene)
        (self.folder / "later.json").symlink_to(later)
        items = self.write_text("list", f"{scene_path('glass')} later.png\nlater.json other.png\n")
        result = self.run_cli("render", "--batch", items, *SMALL)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual((self.folder / "later.png").read_text(), scene)
        self.assertIn("other.png", self.files())

    def test_a_bad_scene_stops_no_other(self):
        self.write_text("bad.json", "{")
        result = self.run_cli("render", "nowhere.json", scene_path("cones"),
                              "bad.json", "-o", "%s.png", *SMALL)
        self.assertEqual(result.returncode, 3)
        self.assertIn("nowhere.json", result.stderr.splitlines()[0])
        self.assertEqual(result.stderr.splitlines()[-1],
                         "mirrorball: 2 of 3 pictures failed, with exit codes: nowhere.json (3), "
                         "bad.json (3)")
        self.assertEqual([name for name in self.files() if name.endswith(".png")], ["cones.png"])

    def test_the_worst_exit_code_is_told(self):
        result = self.run_cli("render", "nowhere.json", scene_path("cones"), "--batch",
                              self.write_text("list", f"{scene_path('glass')} missing/x.png\n"),
                              *SMALL, "-q")
        self.assertEqual(result.returncode, 4)

    def test_one_file_for_several_scenes_is_refused(self):
        scenes = [scene_path("cones"), scene_path("glass")]
        self.assert_refused(self.run_cli("render", *scenes, "-o", "out.png"), 2, "%s")
        self.assert_refused(self.run_cli("render", *scenes, "-o", "%s.gif"), 2, ".gif")
        self.assert_refused(self.run_cli("render", *scenes, "-o", "nowhere/%s.png"), 4,
                            "nowhere")
        self.assert_refused(self.run_cli("render", *scenes, "--reference", "a.png"), 2,
                            "--reference")
        self.assertEqual(self.files(), [])

    def test_two_scenes_of_one_name_do_not_overwrite(self):
        result = self.run_cli("render", scene_path("cones"), scene_path("cones"), "-o", "%s.png",
                              *SMALL)
        self.assert_refused(result, 2, "cones.png: is the same file as cones.png")
        self.assertEqual(self.files(), [])


class List(CliTest):
    def test_lines_name_scenes_and_pictures(self):
        text = f"# two\n\n{scene_path('cones')}\n  {scene_path('cones')}  \"with blank.png\""
        self.succeed("render", "--batch", self.write_text("list", text), "-o", "%s.png", *SMALL)
        self.assertEqual(self.files(), ["cones.png", "list", "with blank.png"])
        self.assertEqual(self.bytes_of("cones.png"), self.bytes_of("with blank.png"))

    def test_list_of_a_windows_editor(self):
        self.write_text("list", f"\ufeff{scene_path('cones')} 1.png\r\n{scene_path('cones')} 2.png\r\n")
        self.succeed("render", "--batch", "list", *SMALL)
        self.assertEqual(self.files(), ["1.png", "2.png", "list"])

    def test_a_line_that_cannot_be_read_is_refused_before_any_work(self):
        scene = scene_path("cones")
        for line, word in [(f'"{scene} 2.png', "missing closing quote"), ('""', "empty name"),
                           (f'{scene} "3.png', "missing closing quote"), (f'{scene} ""', "empty name"),
                           (f"{scene} a.png b.png", "unexpected 'b.png' after SCENE and OUTPUT")]:
            self.write_text("list", f"{scene} 1.png\n{line}\n")
            self.assert_refused(self.run_cli("render", "--batch", "list", *SMALL), 2, "list:2: " + word)
        self.assertEqual(self.files(), ["list"])

    def test_the_list_is_not_overwritten(self):
        text = f"{scene_path('cones')} list.png"
        result = self.run_cli("render", "--batch", self.write_text("list.png", text), *SMALL)
        self.assertEqual(result.returncode, 2)
        self.assertIn("list.png: is the same file as", result.stderr)
        self.assertEqual((self.folder / "list.png").read_text(), text)

    def test_no_scene_is_overwritten(self):
        text = pathlib.Path(scene_path("cones")).read_text()
        for name in ["1.json", "2.json"]:
            self.write_text(name, text)
        (self.folder / "1.png").symlink_to("2.json")
        (self.folder / "2.png").symlink_to("1.json")
        lists = [["1.json", "2.json", "-o", "%s.png"],
                 ["--batch", self.write_text("list", "1.json 3.png\n2.json 2.png")]]
        for arguments, failed in zip(lists, [["1", "2"], ["2"]]):
            result = self.run_cli("render", *arguments, *SMALL)
            self.assertEqual(result.returncode, 2, result.stderr)
            for name in failed:
                self.assertIn(f"{name}.png: is the same file as", result.stderr)
            for name in ["1.json", "2.json"]:
                self.assertEqual((self.folder / name).read_text(), text)

    def test_one_file_by_two_names_is_not_written_twice(self):
        (self.folder / "b.png").symlink_to("a.png")
        (self.folder / "folder").symlink_to(".")
        scene = scene_path("cones")
        for other in ["b.png", "folder/a.png"]:
            self.write_text("list", f"{scene} a.png\n{scene} {other}\n")
            self.assert_refused(self.run_cli("render", "--batch", "list", *SMALL), 2,
                                f"{other}: is the same file as a.png")

    def test_that_has_no_scene(self):
        for name, code, words in [(self.write_text("list", "# none\n"), 2, "no scene"), ("nowhere", 3, "nowhere"),
                                  (".", 3, "is a directory")]:
            self.assert_refused(self.run_cli("render", "--batch", name), code, words)

    def test_json_has_a_line_for_each_picture_as_it_is_done(self):
        process = self.start("render", "--batch", "-", "--stats=json", *SMALL,
                             stdin=subprocess.PIPE)
        for scene in ["cones", "glass"]:
            process.stdin.write(scene_path(scene) + "\n")
        process.stdin.close()
        process.stdin = None
        for scene in ["cones", "glass"]:
            self.assertEqual(json.loads(process.stdout.readline())["scene"]["path"],
                             scene_path(scene))
        self.assertEqual(process.wait(timeout=HANG_LIMIT), 0)

    def test_a_signal_ends_the_wait_for_the_list(self):
        process = self.start("render", "--batch", "-", *SMALL, stdin=subprocess.PIPE)
        process.stdin.write(scene_path("cones") + "\n")
        process.stdin.flush()
        process.send_signal(signal.SIGTERM)
        self.assertIn(process.wait(timeout=HANG_LIMIT), [143, -signal.SIGTERM])

# SPDX-License-Identifier: Apache-2.0
"""--watch: the picture follows its scene."""
import json
import signal
import threading

from harness import CAMERA, GRAY, CliTest
from program import HANG_LIMIT


class Watch(CliTest):
    def setUp(self):
        super().setUp()
        self.lines, self.news = [], threading.Condition()

    def watch(self, device, *more, size=8):
        process = self.start("render", "scene.json", "--size", size, "--device", device, "--watch",
                             "-o", "out.png", *more)
        for stream in [process.stdout, process.stderr]:
            threading.Thread(target=self.read, args=[stream], daemon=True).start()
        return process

    def read(self, stream):
        for line in stream:
            with self.news:
                self.lines.append(line)
                self.news.notify_all()

    def wait_for(self, part, count):
        """Until so many lines have the part."""
        with self.news:
            there = self.news.wait_for(
                lambda: sum(part in line for line in self.lines) >= count, HANG_LIMIT)
        self.assertTrue(there, self.lines)

    def write(self, radius):
        scene = {"camera": CAMERA, "ambient_light": 1, "materials": {"gray": GRAY},
                 "spheres": [{"center": [0, 0, 0], "radius": radius, "material": "gray"}]}
        self.write_text("scene.json", json.dumps(scene) if radius else "{")

    def test_each_change_is_rendered_and_mistakes_are_said(self):
        for device in ["threads", "pocl"]:
            with self.subTest(device=device):
                self.lines = []
                self.write(0.5)
                process = self.watch(device)
                self.wait_for("waiting for", 1)
                small = self.bytes_of("out.png")
                self.write(0)
                self.wait_for("waiting for", 2)
                self.wait_for("scene.json:1:2: ", 1)
                self.assertEqual(self.bytes_of("out.png"), small)
                self.write(1)
                self.wait_for("waiting for", 3)
                self.assertNotEqual(self.bytes_of("out.png"), small)
                process.send_signal(signal.SIGINT)
                self.assertIn(process.wait(HANG_LIMIT), [130, -signal.SIGINT])

    def test_what_no_change_of_the_scene_mends_ends_it(self):
        self.write(0.5)
        for code, arguments in [(2, ["-o", "out.xyz"]), (4, ["-o", "nowhere/out.png"]),
                                (5, ["-o", "out.png", "--device", "name:nobody"])]:
            result = self.run_cli("render", "scene.json", "--watch", *arguments)
            self.assertEqual(result.returncode, code, result.stderr)

    def test_ctrl_c_while_nothing_renders_is_no_news(self):
        self.write(0.5)
        process = self.watch("threads")
        self.wait_for("waiting for", 1)
        process.send_signal(signal.SIGINT)
        process.wait(HANG_LIMIT)
        self.assertFalse(any("stopping" in line for line in self.lines), self.lines)

    def write_model(self, last_corner="0 1 0"):
        if not (self.folder / "scene.json").exists():
            self.write_scene(meshes=[{"file": "model.obj"}], ambient_light=1)
        self.write_text("model.obj", f"mtllib a b.mtl\nv 0 0 0\nv 1 0 0\nv {last_corner}\n"
                                     "usemtl gray\nf 1 2 3\n")

    def test_a_model_that_is_wrong_missing_or_new_is_looked_at_again(self):
        self.write_model()
        (self.folder / "model.obj").write_text("wrong\n")
        self.watch("threads")
        self.wait_for("waiting for", 1)
        self.wait_for("model.obj:1:1: ", 1)
        self.write_model()
        self.wait_for("waiting for", 2)
        (self.folder / "model.obj").unlink()
        self.wait_for("waiting for", 3)
        self.write_model("0 2 0")
        self.wait_for("waiting for", 4)

    def test_material_libraries_are_watched_and_may_come_later(self):
        self.write_model()
        self.watch("threads")
        for count, color in [(1, None), (2, "1 0 0"), (3, "0 1 0")]:
            if color:
                self.write_text("a b.mtl", f"newmtl gray\nKa {color}\n")
            self.wait_for("waiting for", count)
        self.assertEqual(sum("gray" in line for line in self.lines), 1, self.lines)

    def test_a_model_that_changes_while_it_is_rendered_is_rendered_again(self):
        self.write_model()
        self.watch("threads", "--progress", "json", "--aa", "grid:16", "--lanes", "1", size=400)
        self.wait_for('{"fraction"', 1)
        self.write_model("0 2 0")
        self.wait_for("waiting for", 2)

    def test_results_are_printed_with_each_picture(self):
        self.write(0.5)
        self.run_cli("render", "scene.json", "--size", "8", "-o", "reference.pfm")
        self.watch("threads", "--reference", "reference.pfm")
        self.wait_for("PSNR", 1)
        self.write(1)
        self.wait_for("PSNR", 2)

    def test_what_it_cannot_be_with(self):
        self.write(1)
        for more in [["-o", "-"], ["--timeout", "5"], ["scene.json", "-o", "%s.png"]]:
            self.assert_refused(self.run_cli("render", "scene.json", "--watch", *more), 2, "--watch")
        self.assert_refused(self.run_cli("render", "-", "--watch"), 2, "--watch")

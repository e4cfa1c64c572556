# SPDX-License-Identifier: Apache-2.0
"""--watch: the picture follows its scene."""
import json
import signal
import threading

from harness import CAMERA, GRAY, CliTest


class Watch(CliTest):
    def setUp(self):
        super().setUp()
        self.lines, self.news = [], threading.Condition()

    def watch(self, device):
        process = self.start("render", "scene.json", "--size", "8", "--device", device, "--watch",
                             "-o", "out.png")
        threading.Thread(target=self.read, args=[process], daemon=True).start()
        return process

    def read(self, process):
        for line in process.stderr:
            with self.news:
                self.lines.append(line)
                self.news.notify_all()

    def wait_for(self, part, count):
        """Until so many lines have the part."""
        with self.news:
            there = self.news.wait_for(
                lambda: sum(part in line for line in self.lines) >= count, 20)
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
                small = (self.folder / "out.png").read_bytes()
                self.write(0)
                self.wait_for("waiting for", 2)
                self.wait_for("scene.json:1:2: ", 1)
                self.assertEqual((self.folder / "out.png").read_bytes(), small)
                self.write(1)
                self.wait_for("waiting for", 3)
                self.assertNotEqual((self.folder / "out.png").read_bytes(), small)
                process.send_signal(signal.SIGINT)
                self.assertIn(process.wait(10), [130, -signal.SIGINT])

    def test_what_it_cannot_be_with(self):
        self.write(1)
        for more in [["-o", "-"], ["--timeout", "5"], ["--show"], ["scene.json", "-o", "%s.png"]]:
            self.assert_refused(self.run_cli("render", "scene.json", "--watch", *more), 2, "--watch")
        self.assert_refused(self.run_cli("render", "-", "--watch"), 2, "--watch")

# SPDX-License-Identifier: Apache-2.0
"""A scene from standard input, a picture to standard output."""
import os
import pty
import subprocess

from harness import CliTest, clean_environment, scene_path
from program import HANG_LIMIT, PROGRAM

SIZE = ["--size", "16", "--device", "threads"]


class PictureToStdout(CliTest):
    def piped(self, *arguments, code=0, **more):
        result = subprocess.run(
            [PROGRAM, "render", *arguments], cwd=self.folder, capture_output=True,
            env=clean_environment({}), timeout=HANG_LIMIT, check=False, **more)
        self.assertEqual(result.returncode, code, result.stderr)
        return result.stdout

    def test_the_bytes_of_the_file(self):
        scene = scene_path("single-sphere")
        for more, name in [([], "a.png"), (["--format", "png"], "b.png"),
                           (["--format", "exr"], "c.exr"), (["--format", "PFM"], "d.pfm"),
                           (["--format", "ppm"], "e.ppm")]:
            with self.subTest(name=name):
                got = self.piped(scene, *SIZE, "-o", "-", *more)
                self.render(scene, *SIZE, "-o", name)
                self.assertEqual(got, self.bytes_of(name))
        self.assertEqual([name for name in self.files() if name.endswith(".mbj")], [])

    def test_from_a_worker_process(self):
        scene = scene_path("single-sphere")
        got = self.piped(scene, "--size", "16", "--device", "pocl", "-o", "-")
        self.assertEqual(got, self.piped(scene, *SIZE, "-o", "-"))

    def test_behind_what_a_file_holds(self):
        line = (f"echo first > out; $MIRRORBALL render $SCENE {' '.join(SIZE)} -o - -q >> out; "
                "tail -c +7 out | cmp - <($MIRRORBALL render $SCENE --size 16 -q -o -)")
        result = self.run_shell(line)
        self.assertEqual((result.returncode, result.stderr), (0, ""))

    def test_not_to_a_terminal(self):
        ours, theirs = pty.openpty()
        result = self.run_cli("render", scene_path("single-sphere"), *SIZE, "-o", "-",
                              stdout=theirs)
        os.close(theirs)
        os.close(ours)
        self.assertEqual(result.returncode, 2)
        self.assertIn("terminal", result.stderr)

    def test_full_disk_is_exit_4(self):
        result = self.run_shell(f"$MIRRORBALL render $SCENE {' '.join(SIZE)} -o - > /dev/full")
        self.assertEqual(result.returncode, 4, result.stderr)

    def test_nothing_of_a_picture_that_is_given_up(self):
        got = self.piped(scene_path("mirror-hall"), "--size", "2000", "--aa", "grid:8", "--device",
                         "threads", "--timeout", "0.3", "-o", "-", code=8)
        self.assertEqual(got, b"")

    def test_what_else_would_want_stdout(self):
        for more in [["--stats"], ["--stats=json"], ["--reference", "x.png"]]:
            result = self.run_cli("render", scene_path("single-sphere"), "-o", "-", *more)
            self.assert_refused(result, 2, "-o -", "--stats or --reference")

    def test_format_is_for_stdout_alone(self):
        scene = scene_path("single-sphere")
        self.assert_refused(self.run_cli("render", scene, "-o", "a.png", "--format", "exr"), 2,
                            "--format", "extension")
        self.assert_refused(self.run_cli("render", scene, "-o", "-", "--format", "pgm"), 2, "or dpx")
        self.assert_refused(self.run_cli("render", scene, "-o", "-", "--format", "gif"), 2,
                            "'gif'", "png, exr, pfm")

    def test_merge(self):
        scene = scene_path("single-sphere")
        self.render(scene, *SIZE, "--shard", "0,1/2", "-o", "part.mbj")
        self.render(scene, *SIZE, "-o", "whole.pfm")
        result = self.run_shell("$MIRRORBALL merge part.mbj -o - --format pfm -q | cmp - whole.pfm")
        self.assertEqual((result.returncode, result.stderr), (0, ""))


class SceneFromStdin(CliTest):
    def given(self, text, *arguments, code=0):
        result = self.run_cli(*arguments, text=text)
        self.assertEqual(result.returncode, code, result.stderr)
        return result

    def setUp(self):
        super().setUp()
        with open(scene_path("cornell-box"), encoding="utf-8") as file:
            self.text = file.read()

    def test_the_bytes_of_the_file_s_picture(self):
        self.render("cornell-box", *SIZE, "-o", "a.pfm")
        for device in ["threads", "pocl"]:  # pocl: a worker process reads it, after its parent
            self.given(self.text, "render", "-", "--size", "16", "--device", device, "-o", "b.pfm")
            self.assertEqual(self.bytes_of("a.pfm"),
                             self.bytes_of("b.pfm"))

    def test_read_more_than_once(self):
        self.given(self.text, "bench", "-", "--sizes", "16", "--aa", "none", "--precision", "float",
                   "--repeats", "1", "--threads", "1", "--devices", "pocl")

    def test_every_verb_that_reads_a_scene(self):
        for verb in [["scene", "check", "-"], ["scene", "info", "-"],
                     ["explain", "-", "--pixel", "5,5"]]:
            with self.subTest(verb=verb):
                self.given(self.text, *verb)

    def test_meshes_come_from_the_working_folder(self):
        self.write_text("one.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                        "property float y\nproperty float z\nelement face 1\n"
                        "property list uchar int vertex_indices\nend_header\n"
                        "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        scene = ('{"camera": {"from": [0, 0, 4], "at": [0, 0, 0], "fov_degrees": 40}, "materials": '
                 '{"m": {"diffuse": 1}}, "meshes": [{"file": "one.ply", "material": "m"}]}')
        info = self.given(scene, "scene", "info", "-").stdout
        self.assertRegex(info, r"1 triangle")

    def test_mistakes_name_line_and_column(self):
        for text, words in [('{"camera": 3}', "stdin:1:12: "), ("", "stdin")]:
            self.assertIn(words, self.given(text, "render", "-", code=3).stderr)

    def test_not_twice(self):
        result = self.given(self.text, "render", "-", "--batch", "-", code=2)
        self.assertIn("standard input", result.stderr)
        result = self.given("-\n", "render", "--batch", "-", code=2)
        self.assertIn("stdin:1: ", result.stderr)

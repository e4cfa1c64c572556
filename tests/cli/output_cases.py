# SPDX-License-Identifier: Apache-2.0
"""Output that cannot be written: exit 4, nothing left behind, nothing old destroyed."""
import os
import resource
import shutil
import unittest

from harness import SCENES, CliTest, scene_path
from program import PROGRAM

SCENE = "single-sphere"


class WrongName(CliTest):
    def render_to(self, path, *arguments):
        return self.run_cli("render", scene_path(SCENE), "--size", "8", "--device", "threads",
                            "-o", path, *arguments)

    def test_that_cannot_be_written(self):
        self.write_text("file", "")
        (self.folder / "folder.png").mkdir()
        for name in ["out.gif", "out", "out.png.bak", ".png", "out."]:
            self.assert_refused(self.render_to(name), 2, name, ".png, .exr, .pfm")
        self.assert_refused(self.render_to("out.pgm"), 2, "no color")
        for name, words in [("nowhere/out.png", "create"), ("file/out.png", ""), ("folder.png", "director"),
                            ("/proc/x.png", "")]:
            self.assert_refused(self.render_to(name), 4, name, words)
        self.assertNotEqual(self.render_to("").returncode, 0)
        self.assertEqual(self.files(), ["file", "folder.png"])

    def test_extension_in_capitals_is_known(self):
        for name in ["out.PNG", "out.Exr", "out.PFM"]:
            self.assertEqual(self.render_to(name).returncode, 0)
        self.assertEqual(self.files(), ["out.Exr", "out.PFM", "out.PNG"])

    def test_refused_before_the_scene_is_read(self):
        result = self.run_cli("render", "missing.json", "-o", "nowhere/out.png")
        self.assert_refused(result, 4, "nowhere/out.png")

    def test_picture_to_stdout_is_a_whole_pfm(self):
        os.symlink("/dev/stdout", self.folder / "out.pfm")
        with open(self.folder / "caught", "wb") as file:
            self.succeed("render", scene_path(SCENE), "--size", "8", "--device",
                         "threads", "-o", "out.pfm", stdout=file)
        self.assertEqual((self.folder / "caught").stat().st_size, len("PF\n8 8\n-1.0\n") + 8 * 96)

    def test_larger_than_the_format_can_hold(self):
        for name, most in [("out.webp", 16383), ("out.jpg", 65500), ("out.tga", 65535)]:
            with self.subTest(name=name):
                result = self.run_cli("render", scene_path(SCENE), "--size", f"{most + 1}x1",
                                      "--device", "threads", "-o", name)
                self.assert_refused(result, 7, name, f"{most + 1}x1", str(most))
        self.render(SCENE, "--size", "16384x1", "--crop", "0,0,16383,1", "--device", "threads",
                    "-o", "out.webp")
        self.assertEqual(self.files(), ["out.webp"])

    def test_a_name_may_have_as_many_bytes_as_the_file_system_allows(self):
        longest = 255 - len(".png")
        self.assertEqual(self.render_to("a" * longest + ".png").returncode, 0)
        self.assert_refused(self.render_to("a" * (longest + 1) + ".png"), 4, "too long", "shorter")

    def test_unreadable_reference_is_refused_before_anything_is_written(self):
        result = self.render_to("out.png", "--reference", "nowhere.png")
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("nowhere.png", result.stderr)
        self.assertEqual(self.files(), [])


class OverInputs(CliTest):
    """An output that is an input, by whatever name, is refused before any work."""

    def refuse(self, *arguments, files):
        before = {name: self.bytes_of(name) for name in files}
        result = self.run_cli(*arguments)
        self.assert_refused(result, 2, "is the same file as")
        for name, data in before.items():
            self.assertEqual(self.bytes_of(name), data)

    def test_model_of_a_scene(self):
        shutil.copy(SCENES / "torus.ply", self.folder)
        os.symlink("torus.ply", self.folder / "out.png")
        self.write_scene(materials={"grey": {"diffuse": 0.5}},
                         meshes=[{"file": "torus.ply", "material": "grey"}])
        self.refuse("render", "scene.json", "-o", "out.png", files=["torus.ply"])

    def test_material_library(self):
        self.write_text("gem.mtl", "newmtl red\nKd 1 0 0\n")
        self.write_text("gem.obj", "mtllib gem.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n")
        self.write_scene(meshes=[{"file": "gem.obj"}], lights=[{"position": [0, 5, 5]}])
        os.symlink("gem.mtl", self.folder / "m.png")
        os.symlink("gem.mtl", self.folder / "out.depth.png")
        for scene in ["gem.obj", "scene.json"]:
            self.refuse("render", scene, "-o", "m.png", files=["gem.mtl"])
            self.refuse("render", scene, "-o", "out.png", "--aov", "depth", files=["gem.mtl"])

    def test_reference_and_compared_pictures(self):
        self.render(SCENE, "--size", "8", "--device", "threads", "-o", "a.png")
        self.refuse("render", scene_path(SCENE), "--reference", "a.png", "-o", "./a.png",
                    files=["a.png"])
        for option in ["--heatmap", "--json"]:
            self.refuse("compare", "a.png", "a.png", f"{option}=a.png", files=["a.png"])

    def test_results_of_compare_replace_only_such_results(self):
        self.render(SCENE, "--size", "8", "--device", "threads", "-o", "a.png")
        self.write_text("notes.txt", "mine")
        self.assert_refused(self.run_cli("compare", "a.png", "a.png", "--json=notes.txt"), 2,
                            "is not such a result file")
        self.assertEqual((self.folder / "notes.txt").read_text(), "mine")
        for _ in range(2):
            self.succeed("compare", "a.png", "a.png", "--json=a.json")


class OneFileTwice(CliTest):
    """Two results in one file, by whatever names, are refused before any work."""

    def refuse(self, *arguments):
        before = self.files()
        self.assert_refused(self.run_cli(*arguments), 2, "is the same file as")
        self.assertEqual(self.files(), before)

    def test_results_of_bench_and_converge(self):
        os.symlink("a.x", self.folder / "link")
        for verb in ["bench", "converge"]:
            for other in ["a.x", "./a.x", "link"]:
                self.refuse(verb, scene_path(SCENE), "--devices", "threads:1", "--json=a.x",
                            f"--csv={other}")

    def test_heat_map_and_json(self):
        self.render(SCENE, "--size", "8", "--device", "threads", "-o", "a.png")
        self.refuse("compare", "a.png", "a.png", "--json=h.png", "--heatmap=h.png")

    def test_picture_and_aovs(self):
        os.symlink("out.png", self.folder / "out.depth.png")
        os.symlink("out.id.png", self.folder / "out.normal.png")
        for aovs in ["depth", "id,normal"]:
            self.refuse("render", scene_path(SCENE), "-o", "out.png", "--aov", aovs)


class Patterns(CliTest):
    def test_of_one_scene(self):
        self.render(SCENE, "--size", "8", "--device", "threads", "-o", "a-%s.png")
        self.assertEqual(self.files(), [f"a-{SCENE}.png"])

    def test_that_are_parts_of_words_are_none(self):
        for name in ["50%share", "5%dark", "a%sb"]:
            (self.folder / name).mkdir()
            self.render(SCENE, "--size", "8", "--device", "threads", "-o", f"{name}/{name}.png")
            self.assertEqual(os.listdir(self.folder / name), [f"{name}.png"])

    def test_names_of_standard_streams(self):
        self.assert_refused(self.run_cli("render", scene_path(SCENE), "-o", "/dev/stdout"), 2,
                            "for standard output, name -")
        result = self.run_shell('"$MIRRORBALL" render <(cat "$SCENE")')
        self.assert_refused(result, 3, "pipe JSON to -")

    def test_frame_number_without_frames(self):
        self.assert_refused(self.run_cli("render", scene_path(SCENE), "-o", "a%04d.png"), 2,
                            "a%04d.png", "--frames")


class Libraries(CliTest):
    """What loads slowly is loaded by those who need it."""

    def libraries(self, *arguments):
        result = self.succeed(*arguments, env={"LD_DEBUG": "files"})
        return result.stderr

    def test_pictures_load_what_their_format_needs(self):
        options = ["render", scene_path(SCENE), "--size", "8", "--device", "threads"]
        self.assertNotIn("OpenEXR", self.libraries(*options, "-o", "a.png"))
        self.assertNotIn("OpenEXR", self.libraries("compare", "a.png", "a.png"))
        self.assertIn("OpenEXR", self.libraries(*options, "-o", "a.exr"))
        for name in ["a.png", "a.exr", "a.pfm"]:
            self.assertNotIn("OpenImageIO", self.libraries(*options, "-o", name))
        self.assertIn("OpenImageIO", self.libraries(*options, "-o", "a.jpg"))

    def test_a_missing_module_is_told_before_any_work(self):
        shutil.copy(PROGRAM, self.folder / "mirrorball")
        for name, module in [("a.exr", "mirrorball_exr"), ("a.tif", "mirrorball_oiio")]:
            result = self.run_shell(f"./mirrorball render missing.json -o {name}")
            self.assert_refused(result, 4, module, "no such file")

    @unittest.skipUnless(os.geteuid() == 0, "changing the user takes root")
    def test_no_more_threads_at_the_end_lose_no_picture(self):
        """Two threads for a user: enough to trace on one, too few for OpenEXR's."""
        self.folder.chmod(0o777)
        for name in ["out.png", "out.exr", "out.pfm"]:
            self.succeed(
                "render", scene_path(SCENE), "--size", "256", "--device", "threads:1",
                "--progress", "none", "-o", name, user=65534, group=65534, extra_groups=[],
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NPROC, (2, 2)))
        self.succeed("compare", "out.exr", "out.pfm", "--max-abs", "0")


class NoRoom(CliTest):
    OLD = "what was there before"

    def assert_old_file_untouched(self, folder, name):
        self.assertEqual((folder / name).read_text(), self.OLD)
        self.assertEqual([p.name for p in folder.iterdir()], [name])

    def test_file_size_limit(self):
        for name in ["out.pfm", "out.png", "out.exr"]:
            with self.subTest(name=name):
                folder = self.folder / name.replace(".", "-")
                folder.mkdir()
                (folder / name).write_text(self.OLD)
                result = self.run_shell(f"ulimit -f 1; cd {folder}; "
                                        f"$MIRRORBALL render $SCENE --device threads -o {name}")
                self.assert_refused(result, 4, name, "ulimit")
                self.assert_old_file_untouched(folder, name)

    def test_memory_for_what_shows_the_picture_is_counted(self):
        """Were it not, a picture would be lost once it is traced."""
        for options, needs in [("", 6144), ("--tev=127.0.0.1:1", 12288), ("--precision double", 12288)]:
            with self.subTest(options=options):
                result = self.run_shell("ulimit -v 4000000; $MIRRORBALL render $SCENE --device threads "
                                        f"--size 16384 -o out.png {options}")
                self.assert_refused(result, 7, f"needs {needs} MiB", "reduce --size")

    def test_results_are_printed_even_if_their_file_cannot_be_written(self):
        result = self.run_cli("bench", scene_path(SCENE), "--sizes", "8", "--aa", "none",
                              "--devices", "threads:1", "--repeats", "1", "-q", "--json=/dev/full")
        self.assertEqual(result.returncode, 4)
        self.assertIn("/dev/full: cannot write", result.stderr)
        self.assertIn("Mray/s", result.stdout)

    def test_full_disk(self):
        place = self.small_disk("size=8k")
        for name in ["out.pfm", "out.png", "out.exr"]:
            with self.subTest(name=name):
                (place / name).write_text(self.OLD)
                result = self.run_cli("render", scene_path(SCENE), "--device", "threads",
                                      "-o", place / name)
                self.assert_refused(result, 4, name, "space")
                self.assert_old_file_untouched(place, name)
                (place / name).unlink()

    def test_read_only_disk(self):
        place = self.small_disk("ro,size=64k")
        result = self.run_cli("render", scene_path(SCENE), "--size", "8", "-o", place / "out.png")
        self.assert_refused(result, 4, "out.png", "write")

    @unittest.skipUnless(os.geteuid() == 0, "dropping rights takes root")
    def test_folder_one_may_not_write(self):
        self.folder.chmod(0o755)
        locked = self.folder / "locked"
        locked.mkdir(mode=0o555)
        cache = self.folder / "cache"
        cache.mkdir(mode=0o777)
        cache.chmod(0o777)
        result = self.run_cli("render", scene_path(SCENE), "--size", "8", "--device", "threads",
                              "-o", locked / "out.png", user=65534, group=65534, extra_groups=[],
                              env={"POCL_CACHE_DIR": str(cache)})
        self.assert_refused(result, 4, "out.png", "Permission denied")
        result = self.run_cli("stress", "--case", "shift", "--device", "threads", "-o", locked,
                              user=65534, group=65534, extra_groups=[])
        self.assert_refused(result, 4, "locked", "Permission denied")

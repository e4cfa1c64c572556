# SPDX-License-Identifier: Apache-2.0
"""A machine that misbehaves: out of memory, with broken drivers. Where it cannot be had, a
library loaded first (LD_PRELOAD) plays it."""
import json
import shutil
import subprocess

from harness import CliTest, scene_path
from pictures import png_texts

COMPILER = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")

# From the first large request on no memory is left, and what ends a process in order hangs.
NO_MEMORY = """
#include <errno.h>
#include <stddef.h>
#include <unistd.h>
extern void* __libc_malloc(size_t);
static int out;
void* malloc(size_t size) {
    if (size > 300000000) out = 1;
    if (!out) return __libc_malloc(size);
    errno = ENOMEM;
    return NULL;
}
__attribute__((destructor)) static void hang(void) { while (out) pause(); }
"""

NO_BUILD = "int clBuildProgram(void) { return -11; }"

CRASH = "__attribute__((constructor)) static void crash(void) { __builtin_trap(); }"


class PreloadTest(CliTest):
    def library(self, source, name="preload.so"):
        if COMPILER is None:
            self.skipTest("no C compiler")
        (self.folder / "preload.c").write_text(source)
        path = str(self.folder / name)
        subprocess.run([COMPILER, "-shared", "-fPIC", "-o", path, str(self.folder / "preload.c")],
                       check=True)
        return path

    def preload(self, source):
        return {"LD_PRELOAD": self.library(source)}


class OutOfMemory(PreloadTest):
    def test_ends_at_once_with_a_message(self):
        """A message that needs no memory, and an end that waits for nobody's destructor."""
        result = self.run_cli("render", scene_path("empty"), "--size", "8000", "--device",
                              "threads:1", "-q", env=self.preload(NO_MEMORY))
        self.assert_refused(result, 7, "out of memory")


class Fallback(PreloadTest):
    def render_without_opencl(self, *more):
        return self.render("single-sphere", "--size", "8", "--device", "pocl", *more,
                           env=self.preload(NO_BUILD))

    def test_stats_text_says_so(self):
        text = self.render_without_opencl("--stats").stdout
        self.assertRegex(text, r"(?m)^device  \d+ threads?, tiles\n +instead of pthread.*, which failed$")

    def test_picture_says_so(self):
        self.render_without_opencl("-q", "-o", "out.png")
        texts = png_texts((self.folder / "out.png").read_bytes())
        self.assertIn("pthread", texts["mirrorball:FallbackFrom"])

    def test_no_word_without_one(self):
        stats = self.render("single-sphere", "--size", "8", "--stats", "-o", "out.png").stdout
        self.assertNotIn("instead of", stats)
        texts = png_texts((self.folder / "out.png").read_bytes())
        self.assertNotIn("mirrorball:FallbackFrom", texts)


class BrokenDrivers(PreloadTest):
    def problems(self):
        env = {"OCL_ICD_VENDORS": str(self.folder)}
        answer = json.loads(self.run_cli("devices", "--json", env=env).stdout)
        return [line for line in answer["problems"] if ".icd" in line]

    def test_missing_library_is_named(self):
        self.write_text("gone.icd", "libno-such-driver.so.1\n")
        problems = self.problems()
        self.assertEqual(len(problems), 1, problems)
        for word in ["gone.icd", "libno-such-driver.so.1"]:
            self.assertIn(word, problems[0])

    def test_library_that_crashes_is_named(self):
        self.write_text("crash.icd", self.library(CRASH, "libcrash.so") + "\n")
        result = self.run_cli("devices", env={"OCL_ICD_VENDORS": str(self.folder)})
        self.assertRegex(result.stdout, "crash.icd: .*crashes while loading")

    def test_empty_file_is_named(self):
        self.write_text("empty.icd", "")
        self.assertIn("names no library", self.problems()[0])

    def test_working_drivers_are_not_named(self):
        answer = json.loads(self.run_cli("devices", "--json").stdout)
        self.assertEqual(answer["problems"], [])


class KernelCache(CliTest):
    def test_one_that_cannot_be_written_is_named(self):
        """/proc/sys takes no file, not even from root."""
        result = self.run_cli("render", scene_path("single-sphere"), "--size", "8", "--device",
                              "pocl", "--no-fallback", "-o", "out.png",
                              env={"POCL_CACHE_DIR": "/proc/sys"})
        self.assertEqual(result.returncode, 5, result.stderr)
        self.assertIn("cannot write its kernel cache (/proc/sys", result.stderr)
        self.assertNotIn("update the driver", result.stderr)


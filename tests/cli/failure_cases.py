# SPDX-License-Identifier: Apache-2.0
"""A machine that misbehaves: busy, out of memory, with broken drivers. Where it cannot be had, a
library loaded first (LD_PRELOAD) plays it."""
import json
import os
import pathlib
import shutil
import subprocess
import time

from harness import SHIM, CliTest, clean_environment, scene_path, unwritable_folder
from pictures import png_texts
from program import HANG_LIMIT, PROGRAM, ROOT

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


class Busy(CliTest):
    """Another program computes on one core."""
    BENCH = ["--sizes", "8", "--aa", "none", "--devices", "threads:1", "--precision", "float",
             "--repeats", "1"]
    WORDS = r"busy machine \(others use \d\.\d of \d+ cores?, \d+\.\d\d per core\)"

    def setUp(self):
        super().setUp()
        cores = os.sched_getaffinity(0)
        self.addCleanup(os.sched_setaffinity, 0, cores)
        os.sched_setaffinity(0, {min(cores)})  # which processes inherit
        other = subprocess.Popen(["sh", "-c", "while :; do :; done"])
        self.addCleanup(other.wait)
        self.addCleanup(other.kill)

    def bench(self, *more):
        return self.run_cli("bench", scene_path("empty"), *self.BENCH, *more)

    def test_bench_says_so_first_and_on_top_of_its_table_and_in_json(self):
        result = self.bench("--json", "bench.json")
        self.assertRegex(result.stderr.splitlines()[0], self.WORDS)
        self.assertRegex(result.stdout.splitlines()[0], self.WORDS)
        environment = json.loads(self.bytes_of("bench.json"))["environment"]
        self.assertIs(environment["busy"], True)
        self.assertAlmostEqual(environment["load_before"], environment["load_per_core"])

    def test_quiet_keeps_the_table_honest(self):
        result = self.bench("-q")
        self.assertEqual(result.stderr, "")
        self.assertRegex(result.stdout, self.WORDS)

    def test_devices_has_no_times(self):
        self.assertNotIn("busy", self.run_cli("devices").stdout)
        machine = json.loads(self.run_cli("devices", "--json").stdout)["machine"]
        self.assertIs(machine["busy"], True)

    def test_converge(self):
        result = self.run_cli("converge", scene_path("empty"), "--size", "8", "--aa", "none",
                              "--devices", "threads", "--precision", "float",
                              "--reference-samples", "2", "-q", env={"XDG_CACHE_HOME": str(self.folder)})
        self.assertRegex(result.stdout.splitlines()[0], self.WORDS)

    def test_scripts_bench_refuses(self):
        result = subprocess.run(
            [str(ROOT / "scripts" / "bench"), "--only", "embree", PROGRAM],
            capture_output=True, text=True, check=False, timeout=HANG_LIMIT, env=clean_environment({}))
        self.assertEqual(result.returncode, 1)
        self.assertIn("--anyway", result.stderr)


class OutOfMemory(PreloadTest):
    def test_ends_at_once_with_a_message(self):
        """A message that needs no memory, and an end that waits for nobody's destructor."""
        result = self.run_cli("render", scene_path("empty"), "--size", "8000", "--device",
                              "threads:1", "-q", env=self.preload(NO_MEMORY))
        self.assert_refused(result, 7, "out of memory")


class Fallback(CliTest):
    def render_without_opencl(self, *more):
        return self.render("single-sphere", "--size", "8", "--device", "pocl", *more,
                           env={"LD_PRELOAD": SHIM, "CL_SHIM_DIE_IN": "clBuildProgram",
                                "CL_SHIM_DIE_BY": "error"})

    def test_stats_text_says_so(self):
        text = self.render_without_opencl("--stats").stdout
        self.assertRegex(text, r"(?m)^device  \d+ threads?, tiles, .*\n +instead of pthread.*, which failed$")
        self.assertNotIn("instead of", self.render("single-sphere", "--size", "8", "--stats").stdout)

    def test_picture_says_so(self):
        self.render_without_opencl("-q", "-o", "out.png")
        texts = png_texts(self.folder / "out.png")
        self.assertIn("pthread", texts["mirrorball:FallbackFrom"])


class BrokenDrivers(PreloadTest):
    def problems(self):
        env = {"OCL_ICD_VENDORS": str(self.folder)}
        answer = json.loads(self.run_cli("devices", "--json", env=env).stdout)
        return [line for line in answer["problems"] if ".icd" in line]

    def test_what_loads_no_driver_is_named(self):
        for name, text, words in [("gone.icd", "libno-such-driver.so.1\n", "libno-such-driver.so.1"),
                                  ("empty.icd", "", "names no library")]:
            self.write_text(name, text)
            problem, = self.problems()
            self.assertIn(name, problem)
            self.assertIn(words, problem)
            (self.folder / name).unlink()

    def test_library_that_crashes_is_named(self):
        self.write_text("crash.icd", self.library(CRASH, "libcrash.so") + "\n")
        result = self.run_cli("devices", env={"OCL_ICD_VENDORS": str(self.folder)})
        self.assertRegex(result.stdout, "crash.icd: .*was killed by SIG.* while loading")

    def test_names_and_contents_are_escaped(self):
        self.write_text("x.icd", "\x1b[31m\x9b\n")
        self.write_text("a\nb.icd", "\a\n")
        for command in [["devices"], ["devices", "--json"], ["doctor"]]:
            result = self.run_cli(*command, env={"OCL_ICD_VENDORS": str(self.folder)})
            self.assertIn("a\\x0ab.icd", result.stdout.replace("\\\\", "\\"))
            self.assertNotRegex(result.stdout, "[\x00-\x09\x0b-\x1f\x7f-\x9f]")


class KernelCache(CliTest):
    def test_one_that_cannot_be_written_is_named(self):
        cache = unwritable_folder(self.folder)
        result = self.run_cli("render", scene_path("single-sphere"), "--size", "8", "--device",
                              "pocl", "--no-fallback", "-o", "out.png",
                              env={"POCL_CACHE_DIR": cache})
        self.assertEqual(result.returncode, 5, result.stderr)
        self.assertIn("cannot write its kernel cache (" + cache, result.stderr)
        self.assertNotIn("update the driver", result.stderr)

    def render_on_pocl(self, **env):
        self.succeed("render", scene_path("single-sphere"), "--size", "8", "--device",
                     "pocl", "--lanes", "1", "--no-fallback", "-q",
                     env=dict({"XDG_CACHE_HOME": str(self.folder / "home")}, **env))
        return self.folder / "home" / "mirrorball" / "pocl"

    def test_is_our_own_and_closed_to_others(self):
        """Where none is named, or one that others can put kernels into."""
        shared = self.folder / "shared"
        shared.mkdir()
        for mode in [0o777, 0o770]:
            shared.chmod(mode)
            own = self.render_on_pocl(POCL_CACHE_DIR=str(shared))
            self.assertEqual(list(shared.iterdir()), [])
        self.assertTrue(list(own.iterdir()))
        self.assertEqual(own.stat().st_mode & 0o777, 0o700)
        shutil.rmtree(own)
        self.render_on_pocl(POCL_CACHE_DIR="")
        self.assertTrue(list(own.iterdir()))

    def test_is_temporary_where_no_folder_is_safe(self):
        """Without a home, and with the folder in /tmp open to others."""
        shared = self.folder / "shared"
        folder = self.folder / "tmp" / f"mirrorball-{os.geteuid()}"
        for place in [shared, folder]:
            place.mkdir(parents=True)
            place.chmod(0o777)
        result = self.succeed("render", scene_path("single-sphere"), "--size", "8", "--device",
                              "pocl", "--lanes", "1", "--no-fallback", "-q",
                              env={"POCL_CACHE_DIR": str(shared), "XDG_CACHE_HOME": "", "HOME": "",
                                   "TMPDIR": str(folder.parent), "LD_DEBUG": "files"})
        self.assertRegex(result.stderr, f"{folder.parent}/mirrorball.tmp[^ ]*/[^ ]*\\.so")
        self.assertEqual([*shared.iterdir(), *folder.iterdir()], [])
        self.assertEqual(list(folder.parent.iterdir()), [folder])

    def test_what_builds_leave_is_removed_after_an_hour(self):
        own = self.render_on_pocl(POCL_CACHE_DIR="")
        self.assertEqual(list(own.glob("tempfile_*")), [])  # each process leaves an empty one
        for name, age in [("tempfile_a.so", 4000), ("tempfile_b.so", 60), ("other", 4000)]:
            (own / name).touch()
            os.utime(own / name, times=(time.time() - age,) * 2)
        self.render_on_pocl(POCL_CACHE_DIR="")
        self.assertEqual({path.name for path in own.iterdir() if path.is_file()},
                         {"tempfile_b.so", "other"})

    def test_needs_no_path_to_the_linker(self):
        """PoCL calls ld, and ends the process where it finds none. The working folder's is not ours."""
        linker = pathlib.Path(self.write_text("ld", "#!/bin/sh\necho > called\nexec /usr/bin/ld \"$@\"\n"))
        linker.chmod(0o700)
        for i, path in enumerate(["", ".", ":"]):
            self.render_on_pocl(POCL_CACHE_DIR=str(self.folder / f"cold{i}"), PATH=path)
            self.assertTrue(list((self.folder / f"cold{i}").iterdir()))
        self.assertNotIn("called", self.files())

    def test_a_linker_that_hangs_costs_one_deadline(self):
        """And is not left behind."""
        linker = pathlib.Path(self.write_text("ld", "#!/bin/sh\necho $$ > linker\nexec sleep 600\n"))
        linker.chmod(0o700)
        began = time.monotonic()
        result = self.succeed("render", scene_path("single-sphere"), "--size", "8", "--device", "pocl",
                              "--deadline", "2", env={"POCL_CACHE_DIR": str(self.folder / "cold"),
                                                      "PATH": f"{self.folder}:{os.environ['PATH']}"})
        self.assertIn("made no progress for 2 s; rendering on threads instead", result.stderr)
        self.assertLess(time.monotonic() - began, 60)
        stat = pathlib.Path(f"/proc/{(self.folder / 'linker').read_text().strip()}/stat")
        self.assertTrue(not stat.exists() or ") Z " in stat.read_text())

    def test_is_temporary_where_the_home_cannot_be_written_or_is_too_long_for_pocl(self):
        home = self.folder.joinpath(*["x" * 200] * 5)
        home.mkdir(parents=True)
        for place in ["/proc/no", str(home)]:
            self.render_on_pocl(POCL_CACHE_DIR="", XDG_CACHE_HOME="", HOME=place)
        answer = json.loads(self.run_cli("doctor", "--json", env={"POCL_CACHE_DIR": str(home)}).stdout)
        self.assertTrue(any("PoCL has room for" in finding["verdict"] for finding in answer["findings"]))

    def test_a_relative_folder_is_not_used(self):
        self.render_on_pocl(POCL_CACHE_DIR="", XDG_CACHE_HOME="here", HOME=str(self.folder / "home"))
        self.assertEqual(self.files(), ["home"])

    def hash_on_pocl(self, **env):
        """With fallback."""
        result = self.succeed("render", scene_path("single-sphere"), "--size", "8", "--device", "pocl",
                              "--deadline", "5", env=env)
        return result.stderr.split()[-1]

    def test_damaged_costs_no_picture(self):
        """Each file of it: cut short, empty, or other bytes."""
        right = self.hash_of("single-sphere", "--size", "8", "--device", "threads")
        cache = self.folder / "cold"
        self.assertEqual(self.hash_on_pocl(POCL_CACHE_DIR=str(cache)), right)
        good = {file: file.read_bytes() for file in cache.rglob("*") if file.is_file()}
        self.assertTrue(any(file.suffix == ".so" for file in good))
        for damage in [lambda data: data[:len(data) // 2], lambda data: b"",
                       lambda data: data[:64] + bytes(255 - byte for byte in data[64:])]:
            for file, data in good.items():
                file.write_bytes(damage(data))
            self.assertEqual(self.hash_on_pocl(POCL_CACHE_DIR=str(cache)), right)

    def test_full_disk_costs_no_picture(self):
        right = self.hash_of("single-sphere", "--size", "8", "--device", "threads")
        for size in ["8k", "64k"]:
            place = self.small_disk(f"size={size}", size)
            self.assertEqual(self.hash_on_pocl(POCL_CACHE_DIR=str(place)), right)

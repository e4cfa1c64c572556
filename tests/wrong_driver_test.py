# SPDX-License-Identifier: Apache-2.0
"""A driver that gives wrong pictures (tests/cl_shim.cpp) is noticed by bench and stress, and what
--math asks for reaches the driver.

usage: wrong_driver_test.py BUILD_DIR REPO_ROOT [I/N] [TEST...]

I/N: only every N-th test, from the I-th, counted from 0.
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

from hang_limit import HANG_LIMIT

BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
ROOT = pathlib.Path(sys.argv.pop(1)).resolve()
SHARE, SHARES = map(int, sys.argv.pop(1).split("/")) if "/" in "".join(sys.argv[1:2]) else (0, 1)
SCENE = str(ROOT / "scenes" / "cornell-box.json")
# What a light adds: a little brighter, within every tolerance but that of the bits; or much.
LIGHT = "real3 added = select3(lit, mul3(load3(light->intensity), reflected), none);"


def brighter(factor):
    return {"CL_SHIM_OLD": LIGHT, "CL_SHIM_NEW": LIGHT.replace(
        "mul3(", f"scale3((Reals){factor}f, mul3(").replace("reflected)", "reflected))")}


class WrongDriver(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="mirrorball-driver-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_with(self, shim, *arguments):
        """With the shim's settings; a program it does not find its text in ends the process."""
        variables = dict(os.environ, LD_PRELOAD=str(BUILD / "libcl_shim.so"),
                         POCL_CACHE_DIR=str(BUILD / "wrong-driver-cache"), **shim)
        (BUILD / "wrong-driver-cache").mkdir(exist_ok=True)
        result = subprocess.run([str(BUILD / "mirrorball"), *arguments], cwd=ROOT, text=True,
                                env=variables, capture_output=True, timeout=HANG_LIMIT, check=False)
        self.assertNotEqual(result.returncode, 99, result.stderr)
        return result


class Bench(WrongDriver):
    ARGUMENTS = ["bench", SCENE, "--sizes", "32", "--aa", "none", "--precision", "float",
                 "--devices", "threads:1,pocl", "--repeats", "3", "-q", "--json"]

    def verdicts(self, shim, code):
        result = self.run_with(shim, *self.ARGUMENTS)
        self.assertEqual(result.returncode, code, result.stderr)
        rows = json.loads(result.stdout)["rows"]
        return ({row["verdict"] for row in rows if row["device_name"] == "threads"},
                [(row["verdict"], row["why"]) for row in rows if row["device_name"] != "threads"],
                result.stderr)

    def test_a_right_driver_passes(self):
        threads, device, _ = self.verdicts({}, 0)
        self.assertEqual(threads, {"right"})
        self.assertEqual(device, [("right", "")])

    def test_a_picture_far_from_the_reference_is_wrong(self):
        threads, [(verdict, why)], said = self.verdicts(brighter("1.5"), 1)
        self.assertEqual((threads, verdict), ({"right"}, "wrong"))
        self.assertIn("off by more than 1/255", why)  # the judge's word, which comes before the bits'
        self.assertIn(why, said)

    def test_a_picture_that_is_off_in_a_bit_is_wrong(self):
        threads, [(verdict, why)], _ = self.verdicts(brighter("1.000001"), 1)
        self.assertEqual((threads, verdict), ({"right"}, "wrong"))
        self.assertIn("but threads produce", why)

    def test_a_picture_that_changes_between_repeats_is_wrong(self):
        shim = dict(brighter("1.000001"), CL_SHIM_FROM="3")
        threads, [(verdict, why)], _ = self.verdicts(shim, 1)
        self.assertEqual((threads, verdict), ({"right"}, "wrong"))
        self.assertIn("changes from run to run", why)


class Converge(WrongDriver):
    ARGUMENTS = ["converge", SCENE, "--size", "24", "--aa", "none,grid:2", "--precision", "float",
                 "--devices", "pocl", "--repeats", "5", "--reference-samples", "16", "-q"]

    def test_a_picture_that_is_off_in_a_bit_is_wrong(self):
        self.assertEqual(self.run_with({}, *self.ARGUMENTS).returncode, 0)
        result = self.run_with(brighter("1.000001"), *self.ARGUMENTS)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("but threads produce", result.stderr)


class Stress(WrongDriver):
    def stress(self, shim, code, *arguments):
        result = self.run_with(shim, "stress", "-q", *arguments)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result.stdout

    def test_devices_that_disagree_in_a_bit_fail(self):
        case = ["--case", "scale-2/2^0", "--device", "threads,pocl"]
        self.stress({}, 0, *case)
        self.assertRegex(self.stress(brighter("1.000001"), 1, *case),
                         "devices give 2 different pictures in (float|double)")

    def test_cases_that_should_have_the_same_bits_and_do_not_fail(self):
        case = ["--case", "scale-2/2^0,scale-2/2^20", "--device", "pocl"]
        self.stress({}, 0, *case)
        shim = dict(brighter("1.000001"), CL_SHIM_FROM="3")  # the first case has two precisions
        self.assertIn("bits differ from", self.stress(shim, 1, *case))


class Fails(WrongDriver):
    """A device that fails in the middle leaves what it finished, and threads do the rest."""
    ARGUMENTS = ["render", SCENE, "--stats=json", "-q", "--size", "300", "--device"]
    TILES = ["--tile", "100x10", "--aa", "grid:4"]  # several launches

    def figures(self, shim, device, *arguments):
        result = self.run_with(shim, *self.ARGUMENTS, device, *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def check_fails_at(self, launch, *arguments, **shim):
        """The pixels that the device had finished."""
        right = self.figures({}, "threads", *arguments)
        got = self.figures(dict({"CL_SHIM_FAIL_LAUNCH": str(launch)}, **shim), "pocl", *arguments)
        self.assertEqual(got["image"]["hash"], right["image"]["hash"])
        self.assertEqual(got["rays"], right["rays"])
        self.assertEqual(got["device"]["name"], "threads")
        device, threads = got["devices"]
        self.assertEqual(got["device"]["fallback_from"], device["name"])
        self.assertIn("CL_OUT_OF_RESOURCES", device["failure"])
        self.assertEqual(device["pixels"] + threads["pixels"], 300 * 300)
        return device["pixels"]

    def test_at_any_launch(self):
        # The first is of nothing, the next four are the self-test's.
        finished = [self.check_fails_at(launch, *self.TILES) for launch in [1, 2, 5, 6, 7, 8]]
        self.assertEqual(finished[:4], [0, 0, 0, 0])
        self.assertGreater(finished[4], 0)
        self.assertGreater(finished[5], finished[4])

    def test_samples_as_work_items(self):
        for launch in [8, 9, 10, 11, 12]:
            self.check_fails_at(launch, "--launch", "sample", *self.TILES)

    def test_when_what_was_finished_cannot_be_read(self):
        self.assertEqual(self.check_fails_at(8, *self.TILES, CL_SHIM_FAIL_READ="1"), 0)

    def test_while_refining(self):
        for launch in [11, 12]:
            self.check_fails_at(launch, "--aa", "adaptive:0.01")

    def test_beside_others(self):
        picture = ["--aa", "grid:64", "--tile", "100x10"]
        right = self.figures({}, "threads", *picture)
        got = self.figures({"CL_SHIM_FAIL_LAUNCH": "7"}, "pocl,threads", *picture)
        self.assertEqual(got["image"]["hash"], right["image"]["hash"])
        self.assertEqual(got["rays"], right["rays"])
        self.assertIn("CL_OUT_OF_RESOURCES", got["devices"][0]["failure"])

    def test_in_a_batch_it_is_not_asked_again(self):
        right = self.figures({}, "threads", *self.TILES)
        result = self.run_with({"CL_SHIM_FAIL_LAUNCH": "7"}, *self.ARGUMENTS, "pocl", SCENE,
                               *self.TILES)
        first, second = map(json.loads, result.stdout.splitlines())
        for got in (first, second):
            self.assertEqual(got["image"]["hash"], right["image"]["hash"])
            self.assertEqual(got["device"]["name"], "threads")
        self.assertIn("fallback_from", first["device"])
        self.assertNotIn("fallback_from", second["device"])

    def test_is_an_error_without_fallback(self):
        result = self.run_with({"CL_SHIM_FAIL_LAUNCH": "7"}, *self.ARGUMENTS, "pocl", "--no-fallback")
        self.assertEqual(result.returncode, 5, result.stderr)


class Dies(WrongDriver):
    """A driver that ends its process, or does nothing any more: the picture is whole all the same."""

    ARGUMENTS = ["render", SCENE, "--size", "120", "--device", "pocl", "--deadline", "1"]
    LATE = ["render", SCENE, "--size", "190", "--device", "pocl", "--aa", "grid:64", "--progress", "none"]
    PLACES = {"clGetPlatformIDs": 1, "clGetDeviceIDs": 1, "clCreateContext": 1, "clBuildProgram": 1,
              "clEnqueueNDRangeKernel": 2, "clFinish": 2}

    @classmethod
    def setUpClass(cls):
        right = subprocess.run([str(BUILD / "mirrorball"), *cls.ARGUMENTS[:4], "--device",
                                "threads"], text=True, capture_output=True, check=True)
        cls.right = right.stderr.split()[-1]

    def die(self, place, by, *arguments, render=ARGUMENTS, **shim):
        if "-o" not in arguments:
            arguments += ("-o", str(self.folder / "out.png"))
        return self.run_with({"CL_SHIM_DIE_IN": place, "CL_SHIM_DIE_BY": by, **shim},
                             *render, *arguments)

    def die_late(self, *arguments):
        """In the middle of a picture of three seconds, of which a journal is kept."""
        return self.die("clEnqueueNDRangeKernel", "abort", *arguments, "--tile", "16", "--threads", "1",
                        render=self.LATE, CL_SHIM_DIE_AT="4", CL_SHIM_DIE_AFTER="1.5")

    def test_costs_time_and_not_the_picture(self):
        words = {"abort": "was killed by SIGABRT", "segfault": "was killed by SIGSEGV",
                 "exit": "ended with exit code 1", "hang": "made no progress for 1 s"}
        for place, call in self.PLACES.items():
            for by, word in words.items():
                if call > 1 and by in ["segfault", "exit"]:
                    continue
                with self.subTest(place=place, by=by):
                    result = self.die(place, by, CL_SHIM_DIE_AT=str(call))
                    self.assertEqual(result.returncode, 0, result.stderr)
                    lines = result.stderr.splitlines()
                    self.assertEqual(lines[-1].split()[-1], self.right)
                    is_listing = place in ["clGetPlatformIDs", "clGetDeviceIDs"]
                    self.assertEqual(len(lines), 2 if by == "hang" or is_listing else 3,
                                     result.stderr)
                    for line in lines[:-1]:
                        self.assertIn(word, line)
                    self.assertIn("rendering on threads instead", lines[-2])

    def test_by_returning_an_error(self):
        for place, call in self.PLACES.items():
            with self.subTest(place=place):
                result = self.die(place, "error", "--stats=json", CL_SHIM_DIE_AT=str(call))
                self.assertEqual(result.returncode, 0, result.stderr)
                lines = result.stderr.splitlines()
                self.assertEqual(len(lines), 2, result.stderr)
                self.assertIn("CL_OUT_OF_HOST_MEMORY", lines[0])
                self.assertIn("rendering on threads instead", lines[1])
                stats = json.loads(result.stdout)
                self.assertEqual(stats["image"]["hash"], self.right)
                self.assertIn("CL_OUT_OF_HOST_MEMORY", stats["devices"][0]["failure"])
                result = self.die(place, "error", "--no-fallback", CL_SHIM_DIE_AT=str(call))
                self.assertEqual(result.returncode, 5, result.stderr)

    def test_by_returning_an_error_beside_others(self):
        for devices, other in [("pocl,threads", "threads"), ("auto", None)]:
            result = self.run_with({"CL_SHIM_DIE_IN": "clGetDeviceIDs", "CL_SHIM_DIE_BY": "error"},
                                   *self.ARGUMENTS[:4], "--stats=json", "--device", devices)
            self.assertEqual(result.returncode, 0, result.stderr)
            stats = json.loads(result.stdout)
            self.assertEqual(stats["image"]["hash"], self.right)
            if other:
                self.assertIn("CL_OUT_OF_HOST_MEMORY", stats["devices"][0]["failure"])
                self.assertIn("continuing without it", result.stderr)

    def test_once_is_tried_once_more(self):
        once = str(self.folder / "died")
        result = self.die("clBuildProgram", "abort", "--stats=json", CL_SHIM_DIE_ONCE=once)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("with an empty kernel cache", result.stderr)
        stats = json.loads(result.stdout)
        self.assertIn("pthread", stats["device"]["name"])
        self.assertEqual(stats["image"]["hash"], self.right)

    def test_leaves_the_picture_to_other_devices(self):
        picture = ["render", SCENE, "--size", "120", "--aa", "grid:40", "--threads", "1", "--stats=json"]
        right = json.loads(self.run_with({}, *picture, "--device", "threads").stdout)["image"]["hash"]
        for devices in ["0,1", "all"]:
            result = self.run_with({"CL_SHIM_DIE_IN": "clCreateContext", "CL_SHIM_DIE_BY": "abort",
                                    "CL_SHIM_DIE_AT": "2", "POCL_DEVICES": "pthread pthread"},
                                   *picture, "--device", devices)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("trying again without --device 0", result.stderr)
            stats = json.loads(result.stdout)
            self.assertIn("pthread", json.dumps(stats.get("devices", stats["device"])))
            self.assertEqual(stats["image"]["hash"], right)

    def test_stats_say_whom_threads_stand_in_for(self):
        stats = json.loads(self.die("clFinish", "segfault", "--stats=json").stdout)
        self.assertEqual(stats["device"]["name"], "threads")
        self.assertEqual(stats["device"]["fallback_from"], "--device pocl")
        device, threads = stats["devices"]
        self.assertEqual((device["name"], device["failure"]),
                         ("--device pocl", "the driver process was killed by SIGSEGV"))
        self.assertEqual((threads["name"], threads["pixels"]), ("threads", 120 * 120))
        picture = (self.folder / "out.png").read_bytes()
        self.assertIn(b"the driver process was killed by SIGSEGV", picture)
        self.assertIn("was killed by SIGSEGV", self.die("clFinish", "segfault", "--stats").stdout)

    def test_late_is_gone_on_with(self):
        """What it had finished is in the journal."""
        picture = str(self.folder / "out.png")
        result = self.die_late("-o", picture, "--resume")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stderr, r"resuming from .*out\.png\.mbj, which has [1-9]\d* %")
        right = subprocess.run([str(BUILD / "mirrorball"), *self.LATE[:4], *self.LATE[6:], "-o", picture,
                                "--device", "threads"], text=True, capture_output=True, check=True)
        self.assertEqual(result.stderr.split()[-1], right.stderr.split()[-1])

    def test_late_is_gone_on_with_though_it_began_anew(self):
        result = self.die_late("--shard", "0/1", "--fresh", "-o", str(self.folder / "part.mbj"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stderr, r"resuming from .*part\.mbj, which has [1-9]\d* %")

    def test_busy_for_ever_it_ends_at_the_timeout(self):
        self.run_with({}, *self.ARGUMENTS)  # compiles
        result = self.die("clEnqueueNDRangeKernel", "spin", "--timeout", "2", CL_SHIM_DIE_AT="6")
        self.assertIn(result.returncode, [0, 8], result.stderr)  # so small a picture may be whole
        self.assertIn("did not end in time", result.stderr)

    def test_busy_for_ever_costs_time_and_not_the_picture(self):
        picture = ["--aa", "grid:64", "--progress", "none", "--tile", "16"]
        shim = {"CL_SHIM_DIE_IN": "clEnqueueNDRangeKernel", "CL_SHIM_DIE_BY": "spin",
                "CL_SHIM_DIE_AT": "4", "CL_SHIM_DIE_AFTER": "0.5"}
        result = self.run_with(shim, *self.ARGUMENTS[:-1], "0.5", *picture)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("made no progress for", result.stderr)
        self.assertIn("rendering on threads instead", result.stderr)
        right = subprocess.run([str(BUILD / "mirrorball"), *self.ARGUMENTS[:4], *picture,
                                "--device", "threads"], text=True, capture_output=True, check=True)
        self.assertEqual(result.stderr.split()[-1], right.stderr.split()[-1])

    def test_is_an_error_without_fallback(self):
        result = self.die("clBuildProgram", "abort", "--no-fallback")
        self.assertEqual(result.returncode, 5)
        self.assertIn("was killed by SIGABRT", result.stderr.splitlines()[-1])

    def test_takes_the_program_along_where_nobody_isolates_it(self):
        self.assertEqual(self.die("clBuildProgram", "abort", "--isolate", "never").returncode, -6)

    def test_doctor_names_it(self):
        result = self.run_with({"CL_SHIM_DIE_IN": "clBuildProgram", "CL_SHIM_DIE_BY": "segfault"},
                               "doctor")
        self.assertEqual(result.returncode, 5, result.stderr)
        self.assertRegex(result.stdout, r"BROKEN +device 0, .*: its test process was killed by SIGSEGV")
        self.assertRegex(result.stdout, r"ok +threads: ")

    def drivers(self, *names):
        """A folder of .icd files, each of PoCL."""
        folder = self.folder / "drivers"
        folder.mkdir()
        for name in names:
            shutil.copy("/etc/OpenCL/vendors/pocl.icd", folder / name)
        return {"OCL_ICD_VENDORS": str(folder)}

    def test_beside_another_one_is_listed_alone(self):
        shim = {"CL_SHIM_DIE_IN": "clGetPlatformIDs", "CL_SHIM_DIE_BY": "abort",
                "CL_SHIM_DIE_WITH": "a.icd b.icd", **self.drivers("a.icd", "b.icd")}
        result = self.run_with(shim, "devices", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        answer = json.loads(result.stdout)
        self.assertEqual([pathlib.Path(device["icd_file"]).name for device in answer["devices"]],
                         ["a.icd", "b.icd"])
        self.assertRegex(answer["problems"][0], r"a process that loads the drivers of .*a\.icd and "
                         r".*b\.icd crashes while listing their devices \(Aborted\)")
        self.assertRegex(self.run_with(shim, "devices").stdout,
                         r"only with OCL_ICD_VENDORS=.*b\.icd, as --device 0")
        result = self.run_with(shim, "doctor")
        self.assertEqual(result.returncode, 5, result.stderr)
        self.assertEqual(result.stdout.count("renders the right picture"), 3, result.stdout)
        self.assertRegex(result.stdout, r"BROKEN +OpenCL: a process that loads the drivers of")

    def test_is_left_out_of_what_is_measured(self):
        shim = {"CL_SHIM_DIE_IN": "clGetPlatformIDs", "CL_SHIM_DIE_BY": "abort",
                "CL_SHIM_DIE_WITH": "bad.icd", **self.drivers("bad.icd", "good.icd")}
        result = self.run_with(shim, *Bench.ARGUMENTS)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stderr, r"bad\.icd: its driver crashes while listing its devices")
        self.assertEqual({row["verdict"] for row in json.loads(result.stdout)["rows"]
                          if row["device_name"] != "threads"}, {"right"})

    def test_by_computing_for_ever_does_not_hold_up_devices_and_doctor(self):
        shim = {"CL_SHIM_DIE_IN": "clGetDeviceIDs", "CL_SHIM_DIE_BY": "spin"}
        result = self.run_with(shim, "devices", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("hangs: still listing its devices after 10 s",
                      json.loads(result.stdout)["problems"][0])
        shim["CL_SHIM_DIE_IN"] = "clBuildProgram"
        result = self.run_with(shim, "doctor", "--deadline", "0.5")
        self.assertEqual(result.returncode, 5, result.stderr)
        self.assertRegex(result.stdout, r"BROKEN +device 0, .*: its test process did not end in time")

    def check_hanging_ends(self, *command):
        result = self.run_with({"CL_SHIM_DIE_IN": "clBuildProgram", "CL_SHIM_DIE_BY": "hang"}, *command)
        self.assertEqual(result.returncode, 5, result.stderr)
        self.assertRegex(result.stderr, r"pthread.*: the worker process made no progress for")

    def test_by_hanging_ends_bench(self):
        self.check_hanging_ends(*Bench.ARGUMENTS)

    def test_by_hanging_ends_ray_trials(self):
        self.check_hanging_ends("stress", "-q", "--quick", "--case", "sphere-rays", "--device", "pocl")

    @unittest.skipUnless(shutil.which("mpirun"), "needs openmpi-bin")
    def test_does_not_take_an_mpi_job_along(self):
        out, right = self.folder / "out.png", self.folder / "right.png"
        self.run_with({}, *self.ARGUMENTS[:4], "--device", "threads", "-o", str(right))
        for place in ["", "clGetPlatformIDs", "clBuildProgram"]:
            result = subprocess.run(
                ["mpirun", "--oversubscribe", "--bind-to", "none", "-n", "2", "-x",
                 "LD_PRELOAD=" + str(BUILD / "libcl_shim.so"),
                 str(BUILD / "mirrorball"), *self.ARGUMENTS, "--mpi", "-o", str(out)],
                env=dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                         CL_SHIM_DIE_IN=place, CL_SHIM_DIE_BY="abort",
                         POCL_CACHE_DIR=str(BUILD / "wrong-driver-cache")),
                text=True, capture_output=True, timeout=HANG_LIMIT, check=False)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(place != "", "the driver process was killed by SIGABRT; rendering on "
                             "threads instead" in result.stderr, result.stderr)
            self.assertEqual(out.read_bytes(), right.read_bytes())
            out.unlink()

    def test_measuring_names_it(self):
        for verb in [["bench", SCENE], ["converge", SCENE], ["stress", "--quick"],
                     ["report", SCENE, "-o", str(self.folder / "report.html")]]:
            result = self.run_with({"CL_SHIM_DIE_IN": "clGetPlatformIDs",
                                    "CL_SHIM_DIE_BY": "abort"}, *verb, "-q")
            self.assertEqual(result.returncode, 5, result.stderr)
            named, ended = result.stderr.splitlines()
            self.assertIn("its driver crashes while listing its devices (Aborted)", named)
            self.assertEqual(ended, "mirrorball: listing OpenCL devices: the worker process was "
                             "killed by SIGABRT; test each driver with 'mirrorball doctor'")

    def test_devices_says_that_it_could_try_none(self):
        result = self.run_with({"CL_SHIM_NO_FORK": "1"}, "devices")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("could not be started", result.stdout)

    def test_devices_survives(self):
        result = self.run_with({"CL_SHIM_DIE_IN": "clGetPlatformIDs", "CL_SHIM_DIE_BY": "abort"},
                               "devices", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        answer = json.loads(result.stdout)
        self.assertEqual(answer["devices"], [])
        self.assertIn("crashes while listing its devices (Aborted)", answer["problems"][0])


class IsNotAsked(WrongDriver):
    def test_by_what_needs_no_opencl(self):
        """A driver that would end the process when asked for its platforms."""
        picture = str(self.folder / "out.png")
        for arguments in [["--help"], ["--version"], ["render", "--help"], ["scene", "info", SCENE],
                          ["scene", "check", SCENE], ["explain", SCENE, "--pixel", "5,5"],
                          ["render", SCENE, "--size", "20", "--device", "threads", "--isolate", "never",
                           "-o", picture], ["compare", picture, picture]]:
            with self.subTest(arguments=arguments):
                result = self.run_with({"CL_SHIM_DIE_IN": "clGetPlatformIDs",
                                        "CL_SHIM_DIE_BY": "abort"}, *arguments)
                self.assertEqual(result.returncode, 0, result.stderr)


class DiesInABatch(WrongDriver):
    """Several pictures by a driver that ends its process again and again: each is rendered once."""

    NAMES = ["glass.json", "cones.json", "torus.ply", "single-sphere.json", "two-sided.json",
             "glass.json"]
    SMALL = ["--size", "40", "-o", "%s.png", "--stats=json", "--threads", "1"]

    def setUp(self):
        super().setUp()
        self.scenes = []
        for i, name in enumerate(self.NAMES):
            scene = self.folder / f"{i}{pathlib.Path(name).suffix}"
            scene.symlink_to(ROOT / "scenes" / name)
            self.scenes.append(str(scene))

    def figures(self, code, text, arguments, **shim):
        """The batch's JSON lines, by scene, and what it said."""
        result = subprocess.run(
            [str(BUILD / "mirrorball"), "render", *arguments], input=text, text=True,
            cwd=self.folder, capture_output=True, timeout=HANG_LIMIT, check=False,
            env=dict(os.environ, LD_PRELOAD=str(BUILD / "libcl_shim.so"),
                     POCL_CACHE_DIR=str(BUILD / "wrong-driver-cache"), **shim))
        self.assertEqual(result.returncode, code, result.stderr)
        lines = [json.loads(line) for line in result.stdout.splitlines()]
        return [(line["scene"]["path"], line["image"]["hash"]) for line in lines], result.stderr

    def check(self, code, text, *arguments, by="abort", at="22"):
        """By a worker that dies at its `at`-th launch (up to six a picture). Returns what was said."""
        right, _ = self.figures(code, text, [*arguments, "--device", "threads"])
        got, said = self.figures(code, text, [*arguments, "--device", "pocl", "--deadline", "1"],
                                 CL_SHIM_DIE_IN="clEnqueueNDRangeKernel", CL_SHIM_DIE_BY=by,
                                 CL_SHIM_DIE_AT=at)
        self.assertEqual(got, right)
        return said

    def test_of_the_command_line(self):
        said = self.check(0, "", *self.scenes, *self.SMALL)
        self.assertIn("was killed by SIGABRT; restarting it", said)
        self.assertIn("was killed by SIGABRT; retrying with an empty kernel cache",
                      self.check(0, "", *self.scenes, *self.SMALL, at="1"))

    def test_of_a_list(self):
        scenes = [f"{scene}\n" for scene in self.scenes]
        scenes[2:2] = ["# a comment\n", "nowhere.json\n", "a b c\n"]
        last = "mirrorball: 2 of 8 pictures failed, with exit codes: nowhere.json (3), stdin:5 (2)"
        said = self.check(3, "".join(scenes), "--batch", "-", *self.SMALL)
        self.assertEqual(said.count("nowhere.json: "), 1)
        self.assertIn(last, said.splitlines()[-1])
        (self.folder / "list").write_text("".join(scenes))
        self.assertIn(last.replace("stdin", "list"), self.check(
            3, "", "--batch", "list", *self.SMALL, by="hang").splitlines()[-1])

    def test_of_frames(self):
        (self.folder / "path.json").write_text(json.dumps({
            "image": {"width": 40, "height": 30}, "camera": {"from": [0, 0, 5], "at": [0, 0, 0],
                                                            "fov_degrees": 40},
            "materials": {"red": {"ambient": [1, 0, 0]}},
            "spheres": [{"center": [0, 0, 0], "radius": 1, "material": "red"}],
            "path": {"keys": [{"frame": 1, "from": [0, 0, 5]}, {"frame": 6, "from": [2, 0, 5]}]}}))
        self.assertIn("restarting it", self.check(
            0, "", "path.json", "--frames", "1-6", "-o", "%d.png", "--stats=json"))


class Wrong(WrongDriver):
    """A device that computes other bits is found out."""

    def render(self, shim, code, *arguments):
        result = self.run_with(shim, "render", SCENE, "--size", "100", "--device", "pocl",
                               "--stats=json", *arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        return result

    def right_hash(self):
        return json.loads(self.render({}, 0).stdout)["image"]["hash"]

    def test_by_the_doctor(self):
        result = self.run_with(brighter("1.000001"), "doctor")
        self.assertEqual(result.returncode, 5, result.stderr)
        self.assertRegex(result.stdout, r"BROKEN +device 0, .*: renders a wrong picture")

    def test_by_its_self_test(self):
        result = self.render(brighter("1.000001"), 0)
        self.assertIn("fails its self-test", result.stderr)
        figures = json.loads(result.stdout)
        self.assertEqual(figures["image"]["hash"], self.right_hash())
        self.assertIn("fallback_from", figures["device"])

    def test_its_self_test_is_an_error_without_fallback(self):
        self.render(brighter("1.000001"), 5, "--no-fallback")

    def test_a_right_one_is_not(self):
        figures = json.loads(self.render({}, 0, "--check", "100%").stdout)
        self.assertNotIn("fallback_from", figures["device"])
        self.assertGreater(figures["tiles_checked"], 1)
        self.assertGreater(figures["seconds"]["self_test"], 0)
        for share, tiles in [("1%", 1), ("20%", 5), ("21%", 6)]:
            result = self.render({}, 0, "--check", share, "--tile", "20")
            self.assertEqual(json.loads(result.stdout)["tiles_checked"], tiles)

    def test_by_its_self_test_wherever_it_is(self):
        for where in ["x >= 99", "y < 25"]:
            shim = {"CL_SHIM_OLD": self.CORNERS["CL_SHIM_OLD"], "CL_SHIM_NEW":
                    f"RT_TO_REALS(x) + ({where} ? (Reals)0.25f : offset.x)"}
            self.assertIn("fails its self-test", self.render(shim, 0).stderr)

    def test_by_its_self_test_when_it_refines(self):
        shim = {"CL_SHIM_OLD": "store_lanes(colors, color, live ? number.all",
                "CL_SHIM_NEW": "store_lanes(colors, scale3((Reals)0.5f, color), live ? number.all"}
        self.assertNotIn("self-test", self.render({}, 0, "--aa", "adaptive:0.1").stderr)
        result = self.render(shim, 0, "--aa", "adaptive:0.1")
        self.assertIn("fails its self-test", result.stderr)

    # A fault in the left corners alone, where the self-test does not look.
    CORNERS = {"CL_SHIM_OLD": "RT_TO_REALS(x) + offset.x",
               "CL_SHIM_NEW": "RT_TO_REALS(x) + (x < 3 & (y < 8 | y > 92) ? (Reals)0.25f : offset.x)"}

    def test_by_tracing_tiles_again(self):
        arguments = ["--check", "100%", "--tile", "20"]
        result = self.render(self.CORNERS, 0, *arguments)
        self.assertIn("tiles differ when traced again on threads", result.stderr)
        self.assertEqual(json.loads(result.stdout)["image"]["hash"], self.right_hash())
        self.render(self.CORNERS, 5, "--no-fallback", *arguments)

    def hash_of(self, code, *arguments, shim=None):
        result = self.run_with(shim or {}, *arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        return result.stderr.split()[-1], result.stderr

    def test_leaves_nothing_in_the_journal(self):
        part = str(self.folder / "part.mbj")
        share = ["render", SCENE, "--size", "100", "--shard", "0/1", "-o", part]
        for more in [[], ["--aa", "adaptive:0.05"]]:
            _, said = self.hash_of(5, *share, *more, "--device", "pocl", "--check", "100%", "--fresh",
                                   "--no-fallback", shim=self.CORNERS)
            self.assertIn("differ", said)
            self.assertEqual(os.path.getsize(part), 0)
            self.hash_of(0, *share, *more, "--device", "pocl")
            right, _ = self.hash_of(0, "render", SCENE, "--size", "100", *more, "--device", "threads")
            self.assertEqual(self.hash_of(0, "merge", part)[0], right)

    def test_in_a_share_is_found_when_merged(self):
        bad, good = str(self.folder / "bad.mbj"), str(self.folder / "good.mbj")
        share = ["render", SCENE, "--size", "100", "--device", "pocl", "--aa", "adaptive:0.05",
                 "--precision", "double"]
        self.hash_of(0, *share, "--shard", "0,1/3", "-o", bad, shim=self.CORNERS)
        self.hash_of(0, *share, "--shard", "2/3", "-o", good)
        out = self.folder / "out.png"
        merge = ["merge", good, bad, "-o", str(out)]
        _, said = self.hash_of(1, *merge, "--verify", "100%")
        for words in ["bad.mbj (", "threads on ", "differ in"]:
            self.assertIn(words, said)
        self.assertFalse(out.exists())
        self.hash_of(0, *merge)

    def test_is_replaced_in_a_finished_share(self):
        part = str(self.folder / "part.mbj")
        share = ["render", SCENE, "--size", "100", "--shard", "0/1", "-o", part]
        self.hash_of(0, *share, "--device", "pocl", shim=self.CORNERS)
        _, said = self.hash_of(0, *share, "--device", "threads", "--check", "100%")
        self.assertIn("the journal: ", said)
        self.assertEqual(self.hash_of(0, "merge", part)[0], self.right_hash())

    def test_by_tracing_the_journals_tiles_again(self):
        journal, picture = str(self.folder / "out.png.mbj"), str(self.folder / "out.png")
        right = self.right_hash()
        for device, code in [("threads", 0), ("pocl", 0)]:
            self.hash_of(0, "render", SCENE, "--size", "100", "--shard", "0/1", "-o", journal,
                         "--device", "pocl", shim=self.CORNERS)
            found, said = self.hash_of(code, "render", SCENE, "--size", "100", "--device", device,
                                       "-o", picture, "--check", "100%")
            self.assertIn("the journal: ", said)
            self.assertEqual(found, right)
            self.assertFalse(os.path.exists(journal))

    TILES = ["--size", "100", "--tile", "100x5", "--aa", "grid:16"]  # several launches

    def test_leaves_no_tiles_among_those_of_threads(self):
        """Threads finish only what has their bits."""
        right, _ = self.hash_of(0, "render", SCENE, *self.TILES, "--device", "threads")
        for shim, launch, arguments in [(dict(self.CORNERS, CL_SHIM_INEXACT="1"), "8", []),
                                        (brighter("1.000001"), "4", ["--math", "fast"])]:
            render = ["render", SCENE, *self.TILES, *arguments, "--device"]
            shim = dict(shim, CL_SHIM_FAIL_LAUNCH=launch)
            for device in ["pocl", "pocl,0"]:
                found, said = self.hash_of(0, *render, device, shim=shim)
                self.assertIn("rendering all of it on threads", said)
                self.assertEqual(found, right)
            figures = json.loads(self.run_with(shim, *render, "pocl", "--stats=json").stdout)
            self.assertGreater(figures["devices"][0]["pixels"], 0)
            self.assertEqual(figures["devices"][1]["pixels"], 100 * 100)
            self.hash_of(5, *render, "pocl", "--no-fallback", shim=shim)
            _, said = self.hash_of(0, *render, "pocl,threads", shim=dict(shim, CL_SHIM_FAIL_LAUNCH=""))
            self.assertIn("may round differently, and share this picture", said)

    def test_of_other_bits_leaves_a_share_to_threads(self):
        part = str(self.folder / "part.mbj")
        right, _ = self.hash_of(0, "render", SCENE, *self.TILES, "--device", "threads")
        _, said = self.hash_of(0, "render", SCENE, *self.TILES, "--device", "pocl", "--shard", "0/1",
                               "-o", part, shim={"CL_SHIM_INEXACT": "1", "CL_SHIM_DIE_AT": "7",
                                                 "CL_SHIM_DIE_IN": "clEnqueueNDRangeKernel",
                                                 "CL_SHIM_DIE_BY": "abort"})
        self.assertIn("may round differently; starting over", said)
        self.assertEqual(self.hash_of(0, "merge", part)[0], right)

    def test_by_rays_that_cannot_be(self):
        shim = {"CL_SHIM_OLD": "counts->shadow += lit & 1;", "CL_SHIM_NEW": "counts->shadow += 9;"}
        result = self.render(shim, 0)
        self.assertIn("reports an impossible number of rays", result.stderr)
        figures = json.loads(result.stdout)
        self.assertEqual(figures["rays"], json.loads(self.render({}, 0).stdout)["rays"])
        self.render(shim, 5, "--no-fallback")


class Math(WrongDriver):
    def options(self, *arguments):
        log = self.folder / "options"
        log.unlink(missing_ok=True)
        result = self.run_with({"CL_SHIM_LOG": str(log)}, "render", SCENE, "--size", "8",
                               "--device", "pocl", "--no-fallback", "-q", "-o",
                               str(self.folder / "a.pfm"), *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return log.read_text()

    def test_fast_lets_the_compiler_contract(self):
        fast = self.options("--math", "fast")
        self.assertIn(" -DRT_FAST_MATH=1", fast)
        self.assertIn(" -cl-mad-enable", fast)

    def test_strict_does_not(self):
        strict = self.options()
        self.assertNotIn("FAST_MATH", strict)
        self.assertNotIn("-cl-mad-enable", strict)
        self.assertIn("-cl-fp32-correctly-rounded-divide-sqrt", strict)


def load_tests(_loader, classes, _pattern):
    tests = [test for tests in classes for test in tests]
    return unittest.TestSuite(tests[SHARE::SHARES])


if __name__ == "__main__":
    unittest.main(verbosity=2)

# SPDX-License-Identifier: Apache-2.0
"""A driver ends its process, or hangs, also in the middle of several pictures."""
import fcntl
import json
import os
import pathlib
import shutil
import signal
import time

from driver_case import SCENE, WrongDriver
from harness import POCL_DRIVER, SCENES, SHIM, scene_path
from measure_cases import BENCH
from program import run


class Dies(WrongDriver):
    """A driver that ends its process, or does nothing any more: the picture is whole all the same."""

    ARGUMENTS = ["render", SCENE, "--size", "120", "--device", "pocl", "--deadline", "1"]
    LATE = ["render", SCENE, "--size", "190", "--device", "pocl", "--aa", "grid:16", "--progress", "none"]
    PLACES = {"clGetPlatformIDs": 1, "clGetDeviceIDs": 1, "clCreateContext": 1, "clBuildProgram": 1,
              "clEnqueueNDRangeKernel": 2, "clFinish": 2}

    @classmethod
    def setUpClass(cls):
        cls.right = cls.hash_on_threads(*cls.ARGUMENTS[:4])

    @staticmethod
    def hash_on_threads(*render):
        return run(*render, "--device", "threads").stderr.split()[-1]

    def die(self, place, by, *arguments, render=ARGUMENTS, code=None, **shim):
        if "-o" not in arguments:
            arguments += ("-o", str(self.folder / "out.png"))
        return self.run_with({"CL_SHIM_DIE_IN": place, "CL_SHIM_DIE_BY": by, **shim},
                             *render, *arguments, code=code)

    def die_late(self, *arguments):
        """In the middle of a picture, when its first tiles are in the journal, which is written every second."""
        return self.die("clEnqueueNDRangeKernel", "abort", *arguments, "--tile", "16", "--threads", "1",
                        render=self.LATE, CL_SHIM_DIE_AT="10", CL_SHIM_DIE_AFTER="3", code=0)

    def test_costs_time_and_not_the_picture(self):
        words = {"abort": "was killed by SIGABRT", "segfault": "was killed by SIGSEGV",
                 "exit": "ended with exit code 1", "hang": "made no progress for 1 s"}
        for place, call in self.PLACES.items():
            for by, word in words.items():
                if call > 1 and by in ["segfault", "exit"]:
                    continue
                with self.subTest(place=place, by=by):
                    result = self.die(place, by, CL_SHIM_DIE_AT=str(call), code=0)
                    lines = result.stderr.splitlines()
                    self.assertEqual(lines[-1].split()[-1], self.right)
                    is_listing = place in ["clGetPlatformIDs", "clGetDeviceIDs"]
                    self.assertEqual(len(lines), 3 if is_listing else 2, result.stderr)
                    for line in lines[:-1]:
                        self.assertIn(word, line)
                    self.assertIn("rendering on threads instead", lines[-2])

    def test_by_returning_an_error(self):
        for place, call in self.PLACES.items():
            with self.subTest(place=place):
                result = self.die(place, "error", "--stats=json", CL_SHIM_DIE_AT=str(call), code=0)
                lines = result.stderr.splitlines()
                self.assertEqual(len(lines), 2, result.stderr)
                self.assertIn("CL_OUT_OF_HOST_MEMORY", lines[0])
                self.assertIn("rendering on threads instead", lines[1])
                stats = json.loads(result.stdout)
                self.assertEqual(stats["image"]["hash"], self.right)
                self.assertIn("CL_OUT_OF_HOST_MEMORY", stats["devices"][0]["failure"])
                self.die(place, "error", "--no-fallback", CL_SHIM_DIE_AT=str(call), code=5)

    def test_by_returning_an_error_beside_others(self):
        for devices, other in [("pocl,threads", "threads"), ("auto", None)]:
            result = self.run_with({"CL_SHIM_DIE_IN": "clGetDeviceIDs", "CL_SHIM_DIE_BY": "error"},
                                   *self.ARGUMENTS[:4], "--stats=json", "--device", devices, code=0)
            stats = json.loads(result.stdout)
            self.assertEqual(stats["image"]["hash"], self.right)
            if other:
                self.assertIn("CL_OUT_OF_HOST_MEMORY", stats["devices"][0]["failure"])
                self.assertIn("continuing without it", result.stderr)

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

    def test_its_width_of_packets_is_not_for_threads(self):
        stats = json.loads(self.die("clBuildProgram", "abort", "--lanes", "1", "--stats=json", code=0).stdout)
        self.assertGreater(stats["device"]["lanes"], 1)

    def test_late_is_gone_on_with(self):
        """What it had finished is in the journal."""
        picture = str(self.folder / "out.png")
        result = self.die_late("-o", picture, "--resume")
        self.assertRegex(result.stderr, r"resuming from .*out\.png\.mbj, which has [1-9]\d* %")
        self.assertEqual(result.stderr.split()[-1], self.hash_on_threads(*self.LATE[:4], *self.LATE[6:]))

    def test_late_is_gone_on_with_though_it_began_afresh(self):
        result = self.die_late("--shard", "0/1", "--fresh", "-o", str(self.folder / "part.mbj"))
        self.assertRegex(result.stderr, r"resuming from .*part\.mbj, which has [1-9]\d* %")

    def stop_late(self, by, *arguments, stops=None):
        """The exit code where a driver does not end, in the middle of a picture; its finished part is saved."""
        process = self.start(*self.LATE, "--tile", "16", "--threads", "1", "--resume", "--deadline", "2", "-o", "out.png",
                             *arguments, env={"LD_PRELOAD": SHIM, "CL_SHIM_DIE_IN": "clEnqueueNDRangeKernel",
                                              "CL_SHIM_DIE_BY": by, "CL_SHIM_DIE_AT": "10"})
        worker, last, now = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children"), "", []
        while stops and process.poll() is None and (last != now or not (self.folder / "out.png.mbj").exists()):
            time.sleep(0.5)  # until it computes no more
            children = worker.read_text().split()
            last, now = now, [pathlib.Path(f"/proc/{child}/stat").read_text().split()[13:15] for child in children]
        if stops:
            process.send_signal(stops)
        said = process.communicate()[1]
        self.assertTrue((self.folder / "out.partial.png").exists(), said)
        return process.returncode

    def test_late_by_hanging_it_leaves_what_is_finished_to_ctrl_c(self):
        self.assertEqual(self.stop_late("hang", stops=signal.SIGINT), 130)

    def test_late_for_ever_it_leaves_what_is_finished_to_the_timeout(self):
        self.run_with({}, *self.LATE)  # compiles
        self.assertEqual(self.stop_late("spin", "--timeout", "6"), 8)

    def test_busy_for_ever_it_ends_at_the_timeout(self):
        self.run_with({}, *self.ARGUMENTS)  # compiles
        result = self.die("clEnqueueNDRangeKernel", "spin", "--timeout", "2", CL_SHIM_DIE_AT="6")
        self.assertIn(result.returncode, [0, 8], result.stderr)  # so small a picture may be whole
        self.assertIn("did not end in time", result.stderr)

    def test_busy_for_ever_costs_time_and_not_the_picture(self):
        result = self.die("clEnqueueNDRangeKernel", "spin", "--tile", "16", render=[*self.ARGUMENTS[:-1], "0.1"],
                          CL_SHIM_DIE_AT="6", code=0)
        self.assertIn("made no progress for", result.stderr)
        self.assertIn("rendering on threads instead", result.stderr)
        self.assertEqual(result.stderr.split()[-1], self.right)

    def test_a_gpu_never_ends_a_launch(self):
        """Waiting for it is no progress, whatever the driver does meanwhile."""
        gpu = ["gpu" if word == "pocl" else word for word in self.ARGUMENTS]
        result = self.die("clGetEventInfo", "error", render=gpu, code=0, CL_SHIM_GPU="1")
        self.assertIn("made no progress for 1 s", result.stderr)
        self.assertEqual(result.stderr.split()[-1], self.right)

    def test_hangs_in_the_second_picture_of_a_target(self):
        arguments = ["--aa", "sobol:4", "--target-rmse", "1e-3"]
        result = self.die("clEnqueueNDRangeKernel", "hang", *arguments, CL_SHIM_DIE_AT="11", code=0)
        first, hung = [result.stderr.find(text) for text in ["rendering again", "made no progress"]]
        self.assertTrue(0 < first < hung, result.stderr)
        self.assertEqual(result.stderr.split()[-1], self.hash_on_threads(*self.ARGUMENTS[:4], *arguments))

    def test_is_an_error_without_fallback(self):
        result = self.die("clBuildProgram", "abort", "--no-fallback", code=5)
        self.assertIn("was killed by SIGABRT", result.stderr.splitlines()[-1])

    def test_takes_the_program_along_where_nobody_isolates_it(self):
        self.assertEqual(self.die("clBuildProgram", "abort", "--isolate", "never").returncode, -6)

    def test_doctor_names_it(self):
        result = self.run_with({"CL_SHIM_DIE_IN": "clBuildProgram", "CL_SHIM_DIE_BY": "segfault"},
                               "doctor", code=5)
        self.assertRegex(result.stdout, r"broken +device 0, .*: its test process was killed by SIGSEGV")
        self.assertRegex(result.stdout, r"ok +threads: ")

    def drivers(self, *names):
        """A folder of .icd files, each of PoCL."""
        folder = self.folder / "drivers"
        folder.mkdir()
        for name in names:
            shutil.copy(POCL_DRIVER, folder / name)
        return {"OCL_ICD_VENDORS": str(folder)}

    def test_beside_another_one_is_named(self):
        shim = {"CL_SHIM_DIE_IN": "clGetPlatformIDs", "CL_SHIM_DIE_BY": "abort",
                "CL_SHIM_DIE_WITH": "a.icd b.icd", **self.drivers("a.icd", "b.icd")}
        words = (r"a process that loads .*a\.icd and .*b\.icd was killed by SIGABRT while listing its "
                 "devices; choose one of them with OCL_ICD_VENDORS")
        self.assertRegex(self.run_with(shim, "devices", code=0).stdout, words)
        self.assertRegex(self.run_with(shim, "doctor", code=5).stdout, "broken +OpenCL: " + words)

    def test_one_without_devices_is_missing_and_one_that_fails_is_broken(self):
        drivers = self.drivers("a.icd", "b.icd")
        for by, code, words in [("none", 0, "missing +OpenCL: .* has no devices"),
                                ("error", 5, "broken +OpenCL: .* cannot list its devices")]:
            shim = {"CL_SHIM_DIE_IN": "clGetDeviceIDs", "CL_SHIM_DIE_BY": by, "CL_SHIM_DIE_AT": "3", **drivers}
            self.assertRegex(self.run_with(shim, "doctor", code=code).stdout, words)

    def test_one_of_three_is_left_out(self):
        shim = {"CL_SHIM_DIE_IN": "clGetPlatformIDs", "CL_SHIM_DIE_BY": "abort",
                "CL_SHIM_DIE_WITH": "bad.icd", **self.drivers("a.icd", "bad.icd", "c.icd")}
        self.write_text("drivers/lost.icd", "libno-such-driver.so.1\n")
        result = json.loads(self.run_with(shim, "devices", "--json", code=0).stdout)
        self.assertEqual([device["platform_index"] for device in result["devices"]], [0, 1])
        bad, lost = result["problems"]
        self.assertIn("bad.icd: its driver was killed by SIGABRT", bad)
        self.assertIn("lost.icd: its driver cannot be loaded", lost)

    def test_is_left_out_of_what_is_measured(self):
        shim = {"CL_SHIM_DIE_IN": "clGetPlatformIDs", "CL_SHIM_DIE_BY": "abort",
                "CL_SHIM_DIE_WITH": "bad.icd", "CL_SHIM_FOLDERS": "1", **self.drivers("bad.icd", "good.icd")}
        result = self.run_with(shim, *BENCH, code=0)
        self.assertRegex(result.stderr, r"bad\.icd: its driver was killed by SIGABRT while listing its devices")
        self.assertEqual({row["verdict"] for row in json.loads(result.stdout)["rows"]
                          if row["device_name"] != "threads"}, {"right"})

    def test_is_left_out_and_the_scene_from_standard_input_is_read_all_the_same(self):
        shim = {"CL_SHIM_DIE_IN": "clGetPlatformIDs", "CL_SHIM_DIE_BY": "abort",
                "CL_SHIM_DIE_WITH": "bad.icd", **self.drivers("bad.icd", "good.icd")}
        scene = pathlib.Path(scene_path("single-sphere")).read_text(encoding="utf-8")
        for verb, size in [("bench", "--sizes"), ("converge", "--size")]:
            result = self.run_with(shim, verb, "-", size, "8", "--aa", "none", "--precision", "float",
                                   "--repeats", "5", "-q", text=scene, code=0)
            self.assertIn("bad.icd: its driver was killed by SIGABRT", result.stderr)

    def test_by_computing_for_ever_does_not_hold_up_doctor(self):
        # Where others keep the processors busy, computing may look like hanging.
        words = "(did not end in time|made no progress)"
        shim = {"CL_SHIM_DIE_IN": "clGetDeviceIDs", "CL_SHIM_DIE_BY": "spin"}
        result = self.run_with(shim, "doctor", "--deadline", "0.5", code=5)
        self.assertRegex(result.stdout, rf"broken +driver: .*: its driver {words}.* while listing its devices")
        shim["CL_SHIM_DIE_IN"] = "clBuildProgram"
        result = self.run_with(shim, "doctor", "--deadline", "0.5", code=5)
        self.assertRegex(result.stdout, rf"broken +device 0, .*: its test process {words}")

    def check_hanging_ends(self, *command):
        result = self.run_with({"CL_SHIM_DIE_IN": "clBuildProgram", "CL_SHIM_DIE_BY": "hang"}, *command,
                               code=5)
        self.assertRegex(result.stderr, r"pthread.*: the worker process made no progress for")

    def test_by_hanging_ends_bench(self):
        self.check_hanging_ends(*BENCH)

    def test_by_hanging_ends_ray_trials(self):
        self.check_hanging_ends("stress", "-q", "--quick", "--case", "sphere-rays", "--device", "pocl")

    def test_measuring_names_it(self):
        for verb in [["bench", SCENE], ["converge", SCENE], ["stress", "--quick"],
                     ["report", SCENE, "-o", str(self.folder / "report.html")]]:
            result = self.run_with({"CL_SHIM_DIE_IN": "clGetPlatformIDs",
                                    "CL_SHIM_DIE_BY": "abort"}, *verb, "-q", code=5)
            named, ended = result.stderr.splitlines()
            self.assertIn("its driver was killed by SIGABRT while listing its devices", named)
            self.assertEqual(ended, "mirrorball: listing OpenCL devices: the worker process was "
                             "killed by SIGABRT; test each driver with 'mirrorball doctor'")

    def test_devices_says_that_it_could_try_none(self):
        result = self.run_with({"CL_SHIM_NO_CHILD": "1"}, "devices", code=0)
        self.assertIn("could not be started", result.stdout)


class IsNotAsked(WrongDriver):
    def test_by_what_needs_no_opencl(self):
        """A driver that would end the process when asked for its platforms."""
        picture = str(self.folder / "out.png")
        for arguments in [["--help"], ["--version"], ["render", "--help"], ["scene", "info", SCENE],
                          ["scene", "check", SCENE], ["explain", SCENE, "--pixel", "5,5"],
                          ["render", SCENE, "--size", "20", "--device", "threads", "--isolate", "never",
                           "-o", picture], ["compare", picture, picture]]:
            with self.subTest(arguments=arguments):
                self.run_with({"CL_SHIM_DIE_IN": "clGetPlatformIDs",
                               "CL_SHIM_DIE_BY": "abort"}, *arguments, code=0)


class DiesInABatch(WrongDriver):
    """Several pictures by a driver that ends its process: each is rendered once."""

    NAMES = ["glass.json", "cones.json", "torus.ply", "single-sphere.json", "two-sided.json",
             "glass.json"]
    SMALL = ["--size", "40", "-o", "%s.png", "--stats=json", "--threads", "1"]

    def setUp(self):
        super().setUp()
        self.scenes = []
        for i, name in enumerate(self.NAMES):
            scene = self.folder / f"{i}{pathlib.Path(name).suffix}"
            scene.symlink_to(SCENES / name)
            self.scenes.append(str(scene))

    def figures(self, code, text, arguments, **shim):
        """The batch's JSON lines, by scene, and what it said."""
        result = self.run_with(shim, "render", *arguments, code=code, text=text)
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
        self.assertIn("was killed by SIGABRT; rendering on threads instead", said)

    def test_of_a_list(self):
        scenes = [f"{scene}\n" for scene in self.scenes]
        scenes[2:2] = ["# a comment\n", "nowhere.json\n"]
        last = "mirrorball: 1 of 7 pictures failed, with exit codes: nowhere.json (3)"
        said = self.check(3, "".join(scenes), "--batch", "-", *self.SMALL)
        self.assertEqual(said.count("nowhere.json: "), 1)
        self.assertIn(last, said.splitlines()[-1])
        (self.folder / "list").write_text("".join(scenes))
        self.assertIn(last, self.check(3, "", "--batch", "list", *self.SMALL, by="hang").splitlines()[-1])

    def test_while_results_wait(self):
        """The pipe for the results is full when the driver ends the process: each comes once all the same."""
        ours, theirs = os.pipe()
        os.write(theirs, b"\n" * fcntl.fcntl(theirs, fcntl.F_SETPIPE_SZ, 4096))
        process = self.start(
            "render", *self.scenes, *self.SMALL, "--device", "pocl", stdout=theirs, env={
                "LD_PRELOAD": SHIM, "CL_SHIM_DIE_IN": "clEnqueueNDRangeKernel", "CL_SHIM_DIE_BY": "abort",
                "CL_SHIM_DIE_AT": "8"})
        os.close(theirs)
        children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children")
        for _ in range(200):  # for 10 s, or until the worker has ended
            workers = children.read_text().split()
            if workers and not any(map(self.runs, workers)):
                break
            time.sleep(0.05)
        with open(ours, encoding="utf-8") as results:
            scenes = [json.loads(line)["scene"]["path"] for line in results.read().split("\n") if line]
        self.assertEqual(scenes, self.scenes)
        self.assertEqual(process.wait(), 0)

    @staticmethod
    def runs(process):
        """Not a zombie."""
        try:
            return "\nState:\tZ" not in pathlib.Path(f"/proc/{process}/status").read_text()
        except OSError:  # it has ended
            return False

    PATH = json.dumps({
        "image": {"width": 40, "height": 30}, "camera": {"from": [0, 0, 5], "at": [0, 0, 0],
                                                        "fov_degrees": 40},
        "materials": {"red": {"ambient": [1, 0, 0]}},
        "spheres": [{"center": [0, 0, 0], "radius": 1, "material": "red"}],
        "path": {"keys": [{"frame": 1, "from": [0, 0, 5]}, {"frame": 6, "from": [2, 0, 5]}]}})

    def test_of_frames(self):
        (self.folder / "path.json").write_text(self.PATH)
        for scene, text in [("path.json", ""), ("-", self.PATH)]:
            self.assertIn("rendering on threads instead", self.check(
                0, text, scene, "--frames", "1-6", "-o", "%d.png", "--stats=json"))

    def test_with_a_scene_from_standard_input(self):
        for scenes in [[*self.scenes, "-"], ["-", *self.scenes]]:
            self.assertIn("rendering on threads instead", self.check(0, self.PATH, *scenes, *self.SMALL))

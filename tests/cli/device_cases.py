# SPDX-License-Identifier: Apache-2.0
"""Which device renders: --device, MIRRORBALL_DEVICE, `devices`, and what happens without OpenCL."""
import json
import os
import pathlib
import signal
import subprocess
import unittest

from harness import NO_DRIVERS, CliTest, clean_environment, image_hash, scene_path
from program import PROGRAM

TWO_DEVICES = {"POCL_DEVICES": "pthread pthread"}


class Devices(CliTest):
    def devices(self, *arguments, **env):
        return self.output("devices", *arguments, env=env)

    def test_text_names_index_and_threads(self):
        text = self.devices()
        self.assertRegex(text, r"(?m)^0  PoCL")
        self.assertIn("Portable Computing Language", text)
        self.assertRegex(text, r"(?m)^threads  .*\d+ cores?")

    def test_json_fields(self):
        answer = json.loads(self.devices("--json"))
        self.assertEqual((answer["format"], answer["version"]), ("mirrorball-devices", 1))
        self.assertGreater(answer["threads"]["cores"], 0)
        self.assertEqual(answer["problems"], [])
        device = answer["devices"][0]
        self.assertEqual((device["index"], device["platform_index"], device["device_index"]),
                         (0, 0, 0))
        self.assertTrue(device["usable"])
        for key in ["name", "vendor", "platform", "driver", "version", "kind", "compute_units",
                    "memory_bytes", "has_double", "rounds_correctly", "unusable_because"]:
            self.assertIn(key, device)

    def test_two_devices_have_their_own_indices(self):
        devices = json.loads(self.devices("--json", **TWO_DEVICES))["devices"]
        self.assertEqual([device["index"] for device in devices], [0, 1])


CORES = os.sched_getaffinity(0)
ALL_CORES = CORES == set(range(os.cpu_count()))


class PoclThreads(CliTest):
    """Whether PoCL's threads keep to a core each."""

    def cores_of_threads(self, *options, **env):
        """The cores that each thread of a rendering process may run on."""
        process = self.start("render", scene_path("mirror-hall"), "--device", "pocl", "--size",
                             "900", "--aa", "grid:64", "--progress", "json", "--isolate", "never",
                             *options, env=env)
        for line in process.stderr:
            if line.startswith("{") and json.loads(line)["fraction"] > 0:
                break
        cores = []
        for task in pathlib.Path(f"/proc/{process.pid}/task").iterdir():
            try:
                cores.append(os.sched_getaffinity(int(task.name)))
            except ProcessLookupError:  # it has ended meanwhile
                pass
        self.assertGreater(len(cores), 1)
        return cores

    def kept_to_one(self, *options, **env):
        return sorted(core for cores in self.cores_of_threads(*options, **env) if len(cores) == 1
                      for core in cores)

    @unittest.skipUnless(ALL_CORES and len(CORES) > 1, "not all cores are ours, or one")
    def test_each_keeps_to_its_own(self):
        self.assertEqual(self.kept_to_one(), sorted(CORES))
        self.assertEqual(self.kept_to_one("--threads", len(CORES)), sorted(CORES))

    @unittest.skipUnless(len(CORES) > 1, "one core")
    def test_none_does_where_fewer_are_asked_for(self):
        self.assertEqual(self.kept_to_one("--threads", 1), [])
        self.assertEqual(self.kept_to_one(POCL_MAX_PTHREAD_COUNT="1"), [])

    @unittest.skipUnless(len(CORES) > 1, "one core")
    def test_none_does_where_the_environment_says_so(self):
        self.assertEqual(self.kept_to_one(POCL_AFFINITY="0"), [])
        more = {"POCL_PTHREAD_MIN_THREADS": str(len(CORES) + 2)}
        self.assertEqual(self.kept_to_one(**more), [])
        self.assertEqual(self.kept_to_one("--threads", len(CORES), **more), [])

    @unittest.skipUnless(len(CORES) > 1, "one core")
    def test_none_leaves_the_cores_that_the_process_was_given(self):
        self.addCleanup(os.sched_setaffinity, 0, CORES)
        first = {min(CORES)}
        os.sched_setaffinity(0, first)  # which the process inherits
        for cores in self.cores_of_threads():
            self.assertEqual(cores, first)


class Choice(CliTest):
    def refused(self, spec, code, *says, lines=1, env=None):
        result = self.run_cli("render", scene_path("empty"), "--size", "4", "-o", "out.png",
                              "--device", spec, env=env)
        self.assert_refused(result, code, "device", f"'{spec}'", *says, lines=lines)
        self.assertEqual(self.files(), [])

    def test_that_is_none(self):
        for code, words, specs in [
                (2, "threads[:N]", ["garbage", "0:", ":0", "-1", "0:0:0", "name:", "0x1", " ", "threads "]),
                (2, "4096", ["threads:0", "threads:-1", "threads:", "threads:4097", "threads:two"]),
                (2, "empty", ["pocl,", ",", ",threads", "threads,,pocl"]),
                (5, "  0  pthread", ["99", "7:7", "0:9", "gpu", "name:nobody"])]:
            for spec in specs:
                with self.subTest(spec=spec):
                    self.refused(spec, code, words, lines=2 if code == 5 else 1)

    def test_lists(self):
        self.assert_refused(self.run_cli("render", scene_path("empty"), "-o", "out.png",
                                         "--device", "threads:1,threads:2"), 2, "threads twice")
        for spec, names in [("threads,threads", []), ("pocl,0,cpu", []), ("auto,threads", []),
                            ("all,0,threads", ["threads", "pthread"])]:
            with self.subTest(spec=spec):
                stats = self.stats_of("empty", "--size", "4", "--device", spec)
                self.assertEqual([device["name"].split("-")[0]
                                  for device in stats.get("devices", [])], names)

    def test_auto_in_verbs_that_measure(self):
        options = [scene_path("single-sphere"), "--aa", "none", "--precision", "float"]
        for verb in [["bench", *options, "--sizes", "4", "--repeats", "3", "--devices"],
                     ["stress", "--case", "scale-2/2^0", "--device"]]:
            self.succeed(*verb, "auto", "-q")

    def test_fallback_needs_no_packets_of_the_width_asked_for(self):
        if "x86-64" not in json.loads(self.run_cli("devices", "--json").stdout)["threads"]["isas"]:
            self.skipTest("no kernels for x86-64 here")
        result = self.render("empty", "--size", "4", "--device", "pocl", "--isa", "x86-64", "--lanes", "16")
        self.assertIn("--isa has no effect on OpenCL devices", result.stderr)

    def test_options_without_effect_on_threads_are_named(self):
        result = self.render("empty", "--size", "4", "--device", "threads", "--launch", "sample", "--math", "fast",
                             "--cl-options=-w", "--save-kernels", "kernels")
        for option in ["--launch", "--math fast", "--cl-options", "--save-kernels"]:
            self.assertIn(f"{option} has no effect on threads", result.stderr)

    def test_buffers_have_no_effect_where_pixels_take_different_samples(self):
        stats = self.stats_of("cornell-box", "--size", "4", "--aa", "edges:0.1", "--device", "threads:2",
                              "--schedule", "buffers")
        self.assertEqual((stats["device"]["schedule"], stats["device"]["threads"]), ("tiles", 2))
        result = self.render("cornell-box", "--size", "4", "--aa", "edges:0.1", "--device", "threads",
                             "--schedule", "buffers")
        self.assertIn("--schedule has no effect on edges:0.1", result.stderr)

    def test_packets_wider_than_a_vector_compile_without_a_warning(self):
        result = self.render("single-sphere", "--size", "4", "--device", "pocl", "--precision", "double", "--lanes",
                             "16", "--no-fallback", env={"POCL_CACHE_DIR": str(self.folder / "cold")})
        self.assertNotIn("warning", result.stderr)

    def test_a_parent_that_ignores_its_children_breaks_no_driver(self):
        result = subprocess.run([PROGRAM, "render", scene_path("empty"), "--size", "4", "--device", "pocl",
                                 "--no-fallback"], capture_output=True, text=True, check=False,
                                env=clean_environment({"POCL_CACHE_DIR": str(self.folder / "cold")}),
                                preexec_fn=lambda: signal.signal(signal.SIGCHLD, signal.SIG_IGN))
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_ambiguous_lists_the_candidates(self):
        for spec in ["pocl", "cpu", "name:pthread"]:
            with self.subTest(spec=spec):
                self.refused(spec, 2, "\n  0  pthread", "\n  1  pthread", lines=3, env=TWO_DEVICES)

    def test_index_chooses_between_two(self):
        for spec in ["0", "1", "0:1"]:
            with self.subTest(spec=spec):
                self.render("empty", "--size", "4", "--device", spec, env=TWO_DEVICES)

    def test_ways_to_name_the_same_device(self):
        names = {self.stats_of("empty", "--size", "4", "--device", spec)["device"]["name"]
                 for spec in ["0", "0:0", "pocl", "cpu", "name:PTHREAD"]}
        self.assertEqual(len(names), 1)
        self.assertTrue(names.pop().startswith("pthread"))

    def test_count_of_threads(self):
        for options in [["threads:3"], ["threads", "--threads", "3"]]:
            device = self.stats_of("empty", "--size", "4", "--device", *options)["device"]
            self.assertEqual((device["name"], device["threads"]), ("threads", 3))

    def test_threads_are_counted_once(self):
        result = self.run_cli("render", scene_path("empty"), "--threads", "3", "--device",
                              "threads:2", "-o", "out.png")
        self.assert_refused(result, 2, "--threads 3", "threads:2")

    def test_a_bad_scene_is_told_before_a_device_that_is_not_there(self):
        result = self.run_cli("render", "no-such-scene.json", "--device", "99")
        self.assert_refused(result, 3, "no-such-scene.json")


class EnvironmentDefault(CliTest):
    def device_name(self, *arguments, **env):
        return self.stats_of("empty", "--size", "4", *arguments, env=env)["device"]["name"]

    def test_is_honored_and_overridden(self):
        for options, spec, name in [([], "threads:2", "threads"), ([], "", "threads"), ([], "auto", "threads"),
                                    (["--device", "pocl"], "threads:2", "pthread")]:
            self.assertTrue(self.device_name(*options, MIRRORBALL_DEVICE=spec).startswith(name), spec)

    def test_what_test_suites_of_drivers_set_is_honored(self):
        for variables in [{"CL_PLATFORM_INDEX": "0"}, {"CL_PLATFORM_INDEX": "0", "CL_DEVICE_INDEX": "0"},
                          {"CL_PLATFORM_NAME": "Portable"}, {"CL_DEVICE_TYPE": "CPU"}]:
            self.assertTrue(self.device_name(**variables).startswith("pthread"), variables)
            self.assertEqual(self.device_name(MIRRORBALL_DEVICE="threads", **variables), "threads")
        self.assertEqual(self.device_name(CL_DEVICE_TYPE="DEFAULT"), "threads")
        result = self.run_cli("render", scene_path("empty"), env={"CL_DEVICE_INDEX": "x"})
        self.assert_refused(result, 2, "in $CL_PLATFORM_INDEX and CL_DEVICE_INDEX: ")

    def test_mistake_in_it_concerns_render_alone(self):
        for verb in [["devices"], ["scene", "check", scene_path("empty")],
                     ["selftest", "--device", "threads", "--filter", "picture/empty/none/float"],
                     ["render", scene_path("empty"), "--size", "4", "--device", "threads"]]:
            self.succeed(*verb, env={"MIRRORBALL_DEVICE": "rubbish"})

    def test_mistake_in_it_names_the_variable(self):
        result = self.run_cli("render", scene_path("empty"), env={"MIRRORBALL_DEVICE": "rubbish"})
        self.assert_refused(result, 2, "in $MIRRORBALL_DEVICE: device 'rubbish': ")


class Unusable:
    """What must hold when OpenCL has no devices; subclasses say why there is none."""

    env, reason = {}, ""

    def test_threads_render_in_silence(self):
        for options in [[], ["--device", "threads"]]:
            result = self.render("single-sphere", "--size", "8", "-o", "out.png", *options, env=self.env)
            lines = result.stderr.splitlines()
            self.assertEqual(len(lines), 1, result.stderr)
            self.assertIn("threads", lines[0])
            self.assertIsNotNone(image_hash(lines[0]))
        self.assertEqual(self.render("single-sphere", "--size", "8", "-q", env=self.env).stderr, "")

    def test_named_device_fails_and_says_why(self):
        for spec in ["pocl", "0", "cpu"]:
            result = self.run_cli("render", scene_path("empty"), "--device", spec, "-o", "out.png",
                                  env=self.env)
            self.assert_refused(result, 5, spec, "devices")
        self.assertEqual(self.files(), [])

    def test_devices_says_why(self):
        text = self.succeed("devices", env=self.env).stdout
        self.assertIn("threads", text)
        self.assertIn(self.reason, text)
        answer = json.loads(self.run_cli("devices", "--json", env=self.env).stdout)
        self.assertEqual(answer["devices"], [])
        self.assertIn(self.reason, " ".join(answer["problems"]))


class NoOpenCl(Unusable, CliTest):
    reason = "pocl-opencl-icd"

    def setUp(self):
        super().setUp()
        self.env = {"OCL_ICD_VENDORS": NO_DRIVERS}


class UnwritableKernelCache(Unusable, CliTest):
    reason = "POCL_CACHE_DIR"
    env = {"POCL_CACHE_DIR": "/proc/nowhere"}

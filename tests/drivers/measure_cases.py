# SPDX-License-Identifier: Apache-2.0
"""bench, converge and stress notice wrong pictures; what --math asks for reaches the driver."""
import json

from driver_case import SCENE, WrongDriver, brighter


BENCH = ["bench", SCENE, "--sizes", "32", "--aa", "none", "--precision", "float",
         "--devices", "threads:1,pocl", "--repeats", "3", "-q", "--json"]


class Bench(WrongDriver):
    def verdicts(self, shim, code):
        result = self.run_with(shim, *BENCH, code=code)
        rows = json.loads(result.stdout)["rows"]
        return ({row["verdict"] for row in rows if row["device_name"] == "threads"},
                [(row["verdict"], row["why"]) for row in rows if row["device_name"] != "threads"],
                result.stderr)

    def test_a_right_driver_passes(self):
        threads, device, _ = self.verdicts({}, 0)
        self.assertEqual(threads, {"right"})
        self.assertEqual(device, [("right", "")])

    def test_a_picture_that_is_off_in_a_bit_is_wrong(self):
        threads, [(verdict, why)], said = self.verdicts(brighter("1.000001"), 1)
        self.assertEqual((threads, verdict), ({"right"}, "wrong"))
        self.assertIn("but threads produce", why)
        self.assertIn(why, said)

    def test_a_picture_with_infinities_is_wrong(self):
        threads, [(verdict, why)], _ = self.verdicts(brighter("1.0f/0.0"), 6)
        self.assertEqual((threads, verdict), ({"right"}, "wrong"))
        self.assertIn("not finite", why)

    def test_a_picture_that_changes_between_repeats_is_wrong(self):
        shim = dict(brighter("1.000001"), CL_SHIM_FROM="3")
        threads, [(verdict, why)], _ = self.verdicts(shim, 1)
        self.assertEqual((threads, verdict), ({"right"}, "wrong"))
        self.assertIn("changes from run to run", why)

    def test_other_rays_are_wrong(self):
        shim = {"CL_SHIM_OLD": "counts->shadow += lit & 1;", "CL_SHIM_NEW": "counts->shadow += 9;"}
        threads, [(verdict, why)], _ = self.verdicts(shim, 1)
        self.assertEqual((threads, verdict), ({"right"}, "wrong"))
        self.assertRegex(why, r"counts \d+ rays, but threads \d+")


class Converge(WrongDriver):
    ARGUMENTS = ["converge", SCENE, "--size", "24", "--aa", "none", "--precision", "float",
                 "--devices", "pocl", "--repeats", "5", "--reference-samples", "16", "-q"]

    def test_a_picture_that_is_off_in_a_bit_is_wrong(self):
        self.assertEqual(self.run_with({}, *self.ARGUMENTS).returncode, 0)
        result = self.run_with(brighter("1.000001"), *self.ARGUMENTS, "--json", "-", code=1)
        self.assertIn("but threads produce", result.stderr)
        self.assertEqual(json.loads(result.stdout)["builds"], [])  # none was timed


class Stress(WrongDriver):
    def stress(self, shim, code, *arguments):
        result = self.run_with(shim, "stress", "-q", *arguments, code=code)
        return result.stdout

    def test_devices_that_disagree_in_a_bit_fail(self):
        case = ["--case", "scale-2/2^0", "--device", "threads,pocl"]
        self.stress({}, 0, *case)
        self.assertRegex(self.stress(brighter("1.000001"), 1, *case),
                         "devices give 2 different pictures in (float|double)")

    def test_a_device_that_fails_does_not_disagree(self):
        case = ["--case", "scale-2/2^0", "--device", "threads,pocl"]
        said = self.stress({"CL_SHIM_FAIL_LAUNCH": "1"}, 1, *case)
        self.assertRegex(said, r"(?m)^FAIL scale-2 .*\n  2\^0 .* FAIL: pthread.* failed in clEnqueueNDRangeKernel: CL_")
        self.assertNotIn("different pictures", said)

    def test_builds_each_program_once(self):
        log = self.folder / "builds"
        cases = "scale-2/2^0,scale-2/2^20,leaving-sphere/1,leaving-sphere/1e-06"
        self.stress({"CL_SHIM_LOG": str(log)}, 0, "--quick", "--case", cases, "--device", "pocl")
        builds = log.read_text().splitlines()
        self.assertEqual(len(builds), 4)  # pictures and rays, in float and double
        self.assertEqual(len(set(builds)), 4)


class Math(WrongDriver):
    def options(self, *arguments):
        log = self.folder / "options"
        log.unlink(missing_ok=True)
        self.run_with({"CL_SHIM_LOG": str(log)}, "render", SCENE, "--size", "8",
                      "--device", "pocl", "--no-fallback", "-q", "-o",
                      str(self.folder / "a.pfm"), *arguments, code=0)
        return log.read_text()

    def test_fast_lets_the_compiler_contract_and_strict_does_not(self):
        fast = self.options("--math", "fast")
        self.assertIn(" -DRT_FAST_MATH=1", fast)
        self.assertIn(" -cl-mad-enable", fast)
        strict = self.options()
        self.assertNotIn("FAST_MATH", strict)
        self.assertNotIn("-cl-mad-enable", strict)
        self.assertIn("-cl-fp32-correctly-rounded-divide-sqrt", strict)

    def test_further_options_reach_every_build_and_each_is_saved(self):
        kernels = self.folder / "kernels"
        for verb in ["render", "bench", "converge", "stress", "doctor"]:
            log = self.folder / f"{verb}.log"
            arguments = {"render": [SCENE, "--size", "8", "--device", "pocl"], "doctor": [],
                         "bench": [SCENE, "--sizes", "8", "--devices", "pocl", "--aa", "none", "--precision", "float",
                                   "--repeats", "1"],
                         "converge": [SCENE, "--size", "8", "--devices", "pocl", "--aa", "none",
                                      "--precision", "float", "--reference-samples", "2"],
                         "stress": ["--case", "scale-2/2^0", "--device", "pocl"]}[verb]
            self.run_with({"CL_SHIM_LOG": str(log)}, verb, *arguments, "--cl-options=-DMINE=1 -cl-opt-disable",
                          "--save-kernels", str(kernels / verb), code=0)
            builds = log.read_text().splitlines()
            self.assertTrue(builds and all(" -DMINE=1 -cl-opt-disable" in build for build in builds), builds)
            saved = {path.suffix: path for path in (kernels / verb).iterdir()}
            self.assertEqual(set(saved), {".cl", ".options", ".log", ".bin"})
            self.assertIn(saved[".options"].read_text().strip(), [build.strip() for build in builds])
            self.assertIn("__kernel void render_pixels", saved[".cl"].read_text())
            self.assertGreater(saved[".bin"].stat().st_size, 1000)

    def test_kernels_that_do_not_build_are_saved_with_the_log(self):
        kernels = self.folder / "kernels"
        self.run_with({"CL_SHIM_OLD": "__kernel", "CL_SHIM_NEW": "nonsense"}, "render", SCENE, "--size", "8",
                      "--device", "pocl", "--no-fallback", "--save-kernels", str(kernels), code=5)
        self.assertTrue(any("nonsense" in log.read_text() for log in kernels.glob("*.log")))

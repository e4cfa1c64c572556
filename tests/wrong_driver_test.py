# SPDX-License-Identifier: Apache-2.0
"""A driver that gives wrong pictures (tests/cl_shim.cpp) is noticed by bench and stress, and what
--math asks for reaches the driver.

usage: wrong_driver_test.py BUILD_DIR REPO_ROOT
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
ROOT = pathlib.Path(sys.argv.pop(1)).resolve()
SCENE = str(ROOT / "scenes" / "cornell-box.json")
# What a light adds: a little brighter, within every tolerance but that of the bits; or much.
LIGHT = "return select3(lit, mul3(load3(light->intensity), reflected), none);"


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
                                env=variables, capture_output=True, timeout=200, check=False)
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
        self.assertIn(why, said)

    def test_a_picture_that_changes_between_repeats_is_wrong(self):
        shim = dict(brighter("1.000001"), CL_SHIM_FROM="3")
        threads, [(verdict, why)], _ = self.verdicts(shim, 1)
        self.assertEqual((threads, verdict), ({"right"}, "wrong"))
        self.assertIn("changes from run to run", why)


class Stress(WrongDriver):
    def stress(self, shim, code, *arguments):
        result = self.run_with(shim, "stress", "-q", *arguments)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result.stdout

    def test_devices_that_disagree_in_a_bit_fail(self):
        case = ["--case", "scale-2/2^0", "--device", "threads,pocl"]
        self.stress({}, 0, *case)
        self.assertRegex(self.stress(brighter("1.000001"), 1, *case),
                         "devices give 2 pictures in (float|double)")

    def test_cases_that_should_have_the_same_bits_and_do_not_fail(self):
        case = ["--case", "scale-2/2^0,scale-2/2^20", "--device", "pocl"]
        self.stress({}, 0, *case)
        shim = dict(brighter("1.000001"), CL_SHIM_FROM="3")  # the first case has two precisions
        self.assertIn("not the bits of", self.stress(shim, 1, *case))


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


if __name__ == "__main__":
    unittest.main(verbosity=2)

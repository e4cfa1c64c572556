# SPDX-License-Identifier: Apache-2.0
"""`mirrorball selftest` and `blame` find planted faults."""
import json
import os
import subprocess
import xml.etree.ElementTree as ElementTree

from driver_case import WrongDriver
from harness import SCENES, SHIM
from planted_faults import FAULTS
from program import ROOT

# Where each fault of a single function shows, and what is said of it; MIRRORBALL_ALL_FAULTS for whole runs of
# all faults.
CHECKS = {"fma undone": ("dot3", ""), "dot product in another order": ("dot3", ""),
          "division by a reciprocal": ("divide3", ""), "flushed subnormals": ("scale3", ""),
          "square root an ulp off": ("square_root", "by up to [12] ulps;"),
          "a dropped rounding": ("difference_of_products", ""), "fmax returns NaN": ("max_of", " differ, by far; "),
          "a shift off by one": ("hash_bits", r"items differ; item \d+: 0x[0-9a-f]+ instead of 0x[0-9a-f]+$"),
          "a field elsewhere": ("intersect_sphere", "")}
ALL = bool(os.environ.get("MIRRORBALL_ALL_FAULTS"))


class Selftest(WrongDriver):
    def selftest(self, code, *arguments, shim=None):
        """Unoptimized kernels, which compile in half the time."""
        return self.run_with(shim or {}, "selftest", "--device", "pocl", "-q", "--cl-options=-cl-opt-disable",
                             *arguments, code=code)

    def fault(self, name):
        return {"CL_SHIM_OLD": FAULTS[name][0], "CL_SHIM_NEW": FAULTS[name][1]}

    def test_finds_faults(self):
        for name, (function, words) in CHECKS.items():
            with self.subTest(name):
                check = f"{function}/float/1"
                result = self.selftest(1, "--filter", f"{check},mul3/float/1", shim=self.fault(name))
                lines = result.stdout.splitlines()
                self.assertEqual(len(lines), 2, result.stdout)
                self.assertRegex(lines[0], f"^wrong +{check}: .*{words}")
                self.assertRegex(lines[1], r"^2 checks, 1 wrong, ")

    def test_of_a_right_device(self):
        report, junit = self.folder / "report.json", self.folder / "junit.xml"
        self.selftest(0, "--filter", "dot3/float/*,picture/empty/a*/float", "--json", str(report),
                      "--junit", str(junit))
        figures = json.loads(report.read_text())
        names = [check["name"] for check in figures["checks"]]
        self.assertEqual([names[0], names[-1]], ["dot3/float/1", "picture/empty/adaptive:0.05/float"])
        self.assertEqual([device["index"] for device in figures["devices"]], [0])
        self.assertTrue(figures["passed"] and all(check["right"] for check in figures["checks"]))
        suite = ElementTree.parse(junit).getroot()
        self.assertEqual([suite.get("tests"), suite.get("failures")], [str(len(names)), "0"])
        self.assertEqual([case.get("name") for case in suite], names)
        self.selftest(0, "--filter", "dot3/float/1", "--json", str(report))
        self.assertEqual(len(json.loads(report.read_text())["checks"]), 1)

    def test_a_device_that_cannot_be_opened_is_no_bug_of_ours(self):
        result = self.selftest(5, shim={"CL_SHIM_DIE_IN": "clCreateContext", "CL_SHIM_DIE_BY": "error"})
        self.assertRegex(result.stderr, "pthread.* failed in clCreateContext: CL_OUT_OF_HOST_MEMORY")

    def test_results_on_stdout_come_alone(self):
        said = [self.selftest(0, "--filter", "dot3/float/1", option, "-").stdout for option in ["--json", "--junit"]]
        self.assertEqual(json.loads(said[0])["format"], "mirrorball-selftest")
        self.assertEqual(ElementTree.fromstring(said[1].encode()).get("tests"), "1")
        self.selftest(2, "--json", "-", "--junit", "-")
        self.selftest(2, "--json", "a", "--junit", "a")

    def test_of_a_device_that_renders_wrong_pictures(self):
        name = "picture/cornell-box/none/float"
        result = self.selftest(1, "--filter", name + ",picture/empty/none/float", shim=self.fault("only with glass"))
        self.assertRegex(result.stdout, rf"(?m)^wrong +{name}: another picture: [0-9a-f]+ instead of [0-9a-f]+$")

    def test_of_a_scene_that_is_not_golden(self):
        """Those that are shipped all are."""
        golden = json.loads((SCENES / "golden.json").read_text())["pictures"]
        scenes = {str(path.relative_to(SCENES).with_suffix("")) for path in SCENES.rglob("*.json")}
        scenes -= {"golden", "scene.schema"}
        self.assertEqual({name.rsplit("/", 2)[0] for name in golden}, scenes)
        self.assertEqual(len(golden), 12 * len(scenes))

    def test_known_failures(self):
        known = self.folder / "known"
        known.write_text("# of this driver\ndot3/float/1  # fma\n")
        options = ["--filter", "dot3/float/1,mul3/float/1", "--expect", str(known)]
        result = self.selftest(0, *options, shim=self.fault("fma undone"))
        self.assertRegex(result.stdout, r"(?m)^known +dot3/float/1: [\s\S]*1 wrong, 1 known to be, 0 unexpected")
        result = self.selftest(1, *options)
        self.assertRegex(result.stdout, r"(?m)^passes dot3/float/1: right, but expected to fail")
        known.write_text("dot3/float/1\nmul3/float/1 fails\n")
        self.assertIn(f"{known}:2:14: ", self.selftest(3, *options).stderr)

    def test_shipped_expectations_name_checks(self):
        known = ROOT / "contrib" / "deqp-runner" / "rusticl-22.3.txt"
        names = [line for line in known.read_text().splitlines() if line and line[0] != "#"]
        result = self.selftest(1, "--filter", ",".join(names), "--expect", str(known))
        self.assertEqual([line.split()[1].rstrip(":") for line in result.stdout.splitlines()[:-1]], names)

    def test_of_a_driver_that_crashes(self):
        shim = {"CL_SHIM_DIE_IN": "clBuildProgram", "CL_SHIM_DIE_BY": "abort"}
        result = self.selftest(1, "--filter", "dot3/float/1,mul3/float/1", shim=shim)
        self.assertIn("dot3/float/1: the worker process was killed by SIGABRT", result.stderr)
        shim = {"CL_SHIM_DIE_IN": "clEnqueueNDRangeKernel", "CL_SHIM_DIE_BY": "abort", "CL_SHIM_DIE_AT": "12"}
        result = self.selftest(1, "--filter", "[a-d]*/float/1", "--json", "-", shim=shim)
        checks = json.loads(result.stdout)["checks"]
        self.assertEqual([check["right"] for check in checks][-3:], [True, True, False], checks)
        self.assertIn("was killed by SIGABRT", checks[-1]["why"])

    def test_without_such_a_device(self):
        self.run_with({}, "selftest", "--device", "name:nobody's", code=5)
        self.run_with({"OCL_ICD_VENDORS": str(self.folder)}, "selftest", code=5)

    def test_of_no_check(self):
        self.selftest(2, "--filter", "nothing/*")

    def reproduced(self, name):
        """What blame says, and what its C program prints with the fault and without."""
        folder, log = self.folder / name.replace(" ", "-").replace("^", ""), self.folder / "builds"
        result = self.run_with(self.fault(name) | {"CL_SHIM_LOG": str(log)}, "blame", "--device", "pocl", "-o",
                               str(folder), code=1)
        self.assertIn("mirrorball: checking functions\n", result.stderr)
        said = result.stdout
        options = next(line[8:] for line in (folder / "launch.txt").read_text().splitlines() if line[:8] == "options ")
        self.assertIn(options, [build.split(" -D_OPENCL_H_")[0] for build in log.read_text().splitlines()])
        subprocess.run(["cc", "-std=c99", "reproduce.c", "-lOpenCL"], cwd=folder, check=True)
        run = [subprocess.run([folder / "a.out", "pthread"], cwd=folder, text=True, check=False,
                              capture_output=True, env=dict(os.environ, **shim))
               for shim in [{"LD_PRELOAD": SHIM, **self.fault(name)}, {}]]
        return said, run

    def test_blame(self):
        names = list(FAULTS) if ALL else ["fma undone"]
        for name in names:
            with self.subTest(name):
                said, (wrong, right) = self.reproduced(name)
                self.assertRegex(said, f"(?m)^to blame: .*{FAULTS[name][2].replace('^', '.')}")
                self.assertEqual(wrong.returncode, 1, wrong.stdout + wrong.stderr)
                self.assertIn(": WRONG, ", wrong.stdout)
                self.assertEqual((right.returncode, right.stdout[-8:]), (0, ": right\n"), right.stderr)

    def test_blame_looks_at_its_folder_first(self):
        taken = self.folder / "taken"
        taken.write_text("mine")
        for folder in [taken, self.folder]:  # a file, and a folder with somebody's files
            result = self.run_with(self.fault("fma undone"), "blame", "--device", "pocl", "-o", str(folder), code=4)
            self.assertNotIn("checking functions", result.stderr)

    def test_blame_of_a_bit_in_double(self):
        if not ALL:
            self.skipTest("takes minutes; set MIRRORBALL_ALL_FAULTS")
        old, new, _ = FAULTS["only per sample"]
        shim = {"CL_SHIM_OLD": old, "CL_SHIM_NEW": new.replace("0.25f", "(sizeof(Real) == 8 ? 1e-12f : 0)")}
        said = self.run_with(shim, "blame", "--device", "pocl", "-o", str(self.folder / "double"), code=1).stdout
        self.assertRegex(said, r"(?m)^the first pixel that differs: \d+,\d+ of \d+x\d+: 0x[^ ]+ instead of 0x")

    def test_all_faults(self):
        if not ALL:
            self.skipTest("takes hours; set MIRRORBALL_ALL_FAULTS")
        for name in FAULTS:
            with self.subTest(name):
                self.selftest(1, shim=self.fault(name))

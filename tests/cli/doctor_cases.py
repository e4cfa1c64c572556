# SPDX-License-Identifier: Apache-2.0
"""mirrorball doctor: what is installed works, or is named with what to do."""
import json
import os
import subprocess

from harness import KERNEL_CACHE, NO_DRIVERS, POCL_DRIVER, CliTest, unwritable_folder
from program import HANG_LIMIT, PROGRAM


class Doctor(CliTest):
    def findings(self, code, **env):
        result = self.run_cli("doctor", "--json", env=env)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        answer = json.loads(result.stdout)
        self.assertEqual(answer["format"], "mirrorball-doctor")
        self.assertIs(answer["well"], code == 0)
        return {finding["what"]: finding for finding in answer["findings"]}

    def test_finds_nothing_where_all_is_well(self):
        findings = self.findings(0)
        for name, finding in findings.items():
            optional = name == "windows (--show)" and finding["state"] == "missing"
            self.assertTrue(optional or finding["state"] == "ok", finding)
        devices = [name for name in findings if name.startswith("device ")]
        self.assertEqual(len(devices), 1)
        for name in ["processor", "driver", "threads", "kernel cache", "EXR pictures",
                     "windows (--show)"]:
            self.assertIn(name, findings)
        self.assertIn(os.environ.get("POCL_CACHE_DIR", KERNEL_CACHE), findings["kernel cache"]["verdict"])
        text = self.run_cli("doctor").stdout.splitlines()
        self.assertEqual(text[-1], "everything installed works")
        self.assertEqual(len(text), len(findings) + 2)

    def test_does_without_drivers(self):
        findings = self.findings(0, OCL_ICD_VENDORS=NO_DRIVERS)
        self.assertEqual(findings["OpenCL"]["state"], "missing")
        self.assertIn("pocl-opencl-icd", findings["OpenCL"]["verdict"])
        self.assertEqual(findings["threads"]["state"], "ok")

    def test_names_libraries_that_are_missing_or_no_drivers(self):
        for library in ["libno-such-driver.so.1", "libz.so.1"]:
            self.write_text("a.icd", library + "\n")
            findings = self.findings(5, OCL_ICD_VENDORS=str(self.folder))
            self.assertEqual(findings["driver"]["state"], "broken")
            self.assertIn(library, findings["driver"]["verdict"])

    def test_names_the_library_of_a_gpu_that_no_file_names(self):
        (self.folder / "libnvidia-opencl.so.1").touch()
        env = {"LD_LIBRARY_PATH": str(self.folder), "OCL_ICD_VENDORS": str(self.folder)}
        finding = self.findings(0, **env)["driver"]
        self.assertEqual(finding["state"], "missing")
        self.assertIn(f"put that name into {self.folder}/libnvidia-opencl.icd", finding["verdict"])
        self.write_text("nvidia.icd", "libnvidia-opencl.so.1\n")
        self.assertNotIn("no .icd file", self.run_cli("doctor", env=env).stdout)
        env["OCL_ICD_VENDORS"] += "/libnvidia-opencl.so.1"
        self.assertNotIn("no .icd file", self.run_cli("doctor", env=env).stdout)

    def test_takes_a_library_for_a_driver(self):
        """As the loader does."""
        with open(POCL_DRIVER, encoding="ascii") as file:
            library = file.readline().strip()
        findings = self.findings(0, OCL_ICD_VENDORS=library)
        self.assertTrue(any(name.startswith("device 0") for name in findings), findings)

    def test_names_a_kernel_cache_that_cannot_be_written(self):
        findings = self.findings(5, POCL_CACHE_DIR=unwritable_folder(self.folder))
        self.assertEqual(findings["kernel cache"]["state"], "broken")

    def test_says_that_the_kernel_cache_is_off(self):
        finding = self.findings(0, POCL_KERNEL_CACHE="0")["kernel cache"]
        self.assertEqual(finding["state"], "missing")
        self.assertIn("POCL_KERNEL_CACHE", finding["verdict"])

    def test_names_a_missing_proc(self):
        command = "umount -l /proc && exec \"$0\" doctor"
        result = subprocess.run(["unshare", "-m", "sh", "-c", command, PROGRAM], text=True,
                                capture_output=True, timeout=HANG_LIMIT, check=False)
        if "broken" not in result.stdout:
            self.skipTest(f"cannot unmount /proc: {result.stderr}")
        self.assertEqual(len(result.stdout.splitlines()), 3, result.stdout)
        self.assertIn("broken   /proc: is not mounted", result.stdout)

    def test_tests_one_device(self):
        for spec in ["threads", "pocl"]:
            self.assertIn(f"{spec}: renders the right picture", self.output("doctor", "--device", spec))
        finding, = json.loads(self.output("doctor", "--device", "threads", "--json"))["findings"]
        self.assertEqual((finding["state"], finding["what"]), ("ok", "threads"))
        result = self.run_cli("doctor", "--device", "17")
        self.assertEqual(result.returncode, 5)
        self.assertIn("'17' matches no OpenCL device", result.stdout + result.stderr)

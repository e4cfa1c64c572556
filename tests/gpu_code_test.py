#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The kernels as clang compiles them for GPUs: not run, but read.

usage: gpu_code_test.py BUILD_DIR REPO_ROOT CLANG
"""
import functools
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from program import ROOT, run

CLANG = sys.argv.pop(1)
GPUS = {"nvptx64": ["-target", "nvptx64-nvidia-cuda", "-Xclang", "-target-cpu", "-Xclang", "sm_70"],
        "amdgcn": ["-target", "amdgcn-amd-amdhsa", "-mcpu=gfx1030", "-O1"]}
STRICT = "-cl-fp32-correctly-rounded-divide-sqrt"
# Some devices have no double; clang warns about each constant.
FLOAT = [STRICT, "-Xclang", "-cl-ext=-cl_khr_fp64"]
PRECISIONS = {"f32": FLOAT, "f64": [STRICT, "-DRT_DOUBLE=1"]}


def targets():
    return set(re.findall(r"^ +(\w+) ", subprocess.run([CLANG, "--print-targets"], check=True, text=True,
                                                       capture_output=True).stdout, re.M))


@functools.cache
def compiled(gpu, *options):
    """The assembly of kernels/render.cl, for one ray at a time, as GPUs run it."""
    return subprocess.run(
        [CLANG, "-x", "cl", "-O3", *GPUS[gpu], "-cl-std=CL1.2", "-Xclang", "-finclude-default-header", "-nogpulib",
         "-Wall", "-Werror", "-I.", *options, "-S", "kernels/render.cl", "-o", "-"],
        cwd=ROOT, check=True, text=True, stdout=subprocess.PIPE).stdout


def left_out(scene):
    """The build options for what a scene does not need."""
    names = re.findall(r'"([\w ]+)"', (ROOT / "host/flatten/features.h").read_text())
    with tempfile.TemporaryDirectory() as folder:
        stats = json.loads(run("render", ROOT / "scenes" / scene, "--size", "8", "--device", "threads", "--stats=json",
                               "-o", pathlib.Path(folder, "out.pfm")).stdout)
    bits = sum(1 << i for i, name in enumerate(names) if name not in stats["scene"]["features_left_out"])
    return [f"-DRT_FEATURE_BITS={bits:#x}"]


def arithmetic(ptx):
    """The kinds of instructions that round, with their modifiers."""
    return set(re.findall(r"\s((?:add|sub|mul|div|rcp|sqrt|fma|mad)\.[\w.]*f(?:32|64))\s", ptx))


class GpuCode(unittest.TestCase):
    def setUp(self):
        if missing := GPUS.keys() - targets():
            self.skipTest(f"{CLANG} cannot compile for {', '.join(missing)}")

    def test_compiles_without_warnings(self):
        for gpu, precision in [("nvptx64", "f32"), ("nvptx64", "f64"), ("amdgcn", "f32")]:  # each takes long
            for entry in "render_pixels", "render_samples", "render_round", "resolve_samples", "sum_counts", "trace_rays":
                self.assertRegex(compiled(gpu, *PRECISIONS[precision]), rf"\b{entry}\b")

    def test_old_compilers_get_no_pragma_of_newer_ones(self):
        """NVIDIA's is a clang 7, which rejects always_inline in one."""
        for version, there in [("7", False), ("19", True)]:
            text = subprocess.run([CLANG, "-x", "cl", "-E", "-cl-std=CL1.2", "-U__clang_major__",
                                   f"-D__clang_major__={version}", "-Wno-builtin-macro-redefined", "-I.",
                                   "kernels/render.cl"], cwd=ROOT, check=True, text=True, stdout=subprocess.PIPE).stdout
            self.assertEqual("#pragma clang attribute" in text, there)

    def test_rounds_as_written(self):
        """Nothing is fused or approximated, and no subnormal is flushed; fma() is a call here."""
        for kind, options in PRECISIONS.items():
            self.assertEqual(arithmetic(compiled("nvptx64", *options)),
                             {f"{name}.rn.{kind}" for name in ["add", "sub", "mul", "div", "rcp"]})

    def test_fast_math_fuses(self):
        self.assertIn("fma.rn.f32", arithmetic(compiled("nvptx64", "-DRT_FAST_MATH=1", "-cl-mad-enable",
                                                      *left_out("cornell-box.json"))))

    def test_calls_only_what_opencl_rounds_correctly(self):
        """The rest of OpenCL's functions differ from vendor to vendor."""
        for options in PRECISIONS.values():
            mangled = re.findall(r"\b_Z(\d+)(\w+)", compiled("nvptx64", *options))
            called = {name[:int(length)] for length, name in mangled}
            self.assertEqual({name for name in called if not name.startswith("convert_")},
                             {"fabs", "fma", "sqrt", "get_global_id"})

    def test_the_papers_scene_lives_in_registers(self):
        """Without glass and hierarchies no kernel has a stack, which GPUs keep in their slow memory."""
        self.assertIn(".local ", compiled("nvptx64", *FLOAT))
        self.assertNotIn(".local ", compiled("nvptx64", STRICT, *left_out("cornell-box.json")))


if __name__ == "__main__":
    unittest.main(verbosity=2)

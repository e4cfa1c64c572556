# SPDX-License-Identifier: Apache-2.0
"""Runs mirrorball with an OpenCL driver that misbehaves (tests/cl_shim.cpp)."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

from hang_limit import HANG_LIMIT

BUILD = pathlib.Path(sys.argv[1]).resolve()
ROOT = pathlib.Path(sys.argv[2]).resolve()
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

    def run_with(self, shim, *arguments, code=None, cwd=ROOT, text=None):
        """With the shim's settings, and a text as standard input; a program it does not find its text in
        ends the process. `code` is the exit code expected, if any."""
        variables = dict(os.environ, LD_PRELOAD=str(BUILD / "libcl_shim.so"),
                         POCL_CACHE_DIR=str(BUILD / "wrong-driver-cache"), **shim)
        (BUILD / "wrong-driver-cache").mkdir(exist_ok=True)
        result = subprocess.run([str(BUILD / "mirrorball"), *arguments], cwd=cwd, text=True,
                                input=text, env=variables, capture_output=True, timeout=HANG_LIMIT, check=False)
        self.assertNotEqual(result.returncode, 99, result.stderr)
        if code is not None:
            self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

# SPDX-License-Identifier: Apache-2.0
"""Runs mirrorball with an OpenCL driver that misbehaves (tests/cl_shim.cpp)."""
from harness import SHIM, CliTest, scene_path

SCENE = scene_path("cornell-box")
# What a light adds: a little brighter, within every tolerance but that of the bits; or much.
LIGHT = "real3 added = select3(lit, mul3(load3(light->intensity), reflected), none);"


def brighter(factor):
    return {"CL_SHIM_OLD": LIGHT, "CL_SHIM_NEW": LIGHT.replace(
        "mul3(", f"scale3((Reals){factor}f, mul3(").replace("reflected)", "reflected))")}


class WrongDriver(CliTest):
    def run_with(self, shim, *arguments, code=None, text=""):
        """With the shim's settings; a program it does not find its text in ends the process. `code` is the exit
        code expected, if any."""
        result = self.run_cli(*arguments, text=text, env={"LD_PRELOAD": SHIM, **shim})
        self.assertNotEqual(result.returncode, 99, result.stderr)
        if code is not None:
            self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

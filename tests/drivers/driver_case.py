# SPDX-License-Identifier: Apache-2.0
"""Runs mirrorball with an OpenCL driver that misbehaves (tests/cl_shim.cpp)."""
from harness import SHIM, CliTest, scene_path
from program import BUILD

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
        result = self.run_cli(*arguments, text=text, env=self.environment(shim))
        self.assertNotEqual(result.returncode, 99, result.stderr)
        if code is not None:
            self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    @staticmethod
    def environment(shim):
        cache = BUILD / "wrong-driver-cache"
        cache.mkdir(exist_ok=True)
        return {"LD_PRELOAD": SHIM, "POCL_CACHE_DIR": str(cache), **shim}

# SPDX-License-Identifier: Apache-2.0
"""Builds scripts/embree against the libraries of a mirrorball build folder."""
import pathlib
import subprocess

from lib.program import ROOT, run

SOURCES = pathlib.Path(__file__).resolve().parent
COMPILER = ["g++", "-std=c++20", "-O3", "-march=native", "-mprefer-vector-width=512",
            "-ffp-contract=fast", "-fno-math-errno", "-fno-trapping-math", "-Wall", "-Wextra",
            "-Wno-maybe-uninitialized", "-Wno-psabi"]
LIBRARIES = ["threads", "scene", "base", "native", "texts"]


def is_installed():
    test = "#include <embree3/rtcore.h>\nint main() { return 0; }\n"
    return subprocess.run(["g++", "-xc++", "-fsyntax-only", "-"], input=test, text=True,
                          capture_output=True, check=False).returncode == 0


def build(folder):
    """The Embree renderer, rebuilt when it is older than its sources or the libraries."""
    program = folder / "embree-bench"
    libraries = [folder / f"libmirrorball_{name}.a" for name in LIBRARIES]
    inputs = [*SOURCES.glob("*.cpp"), *SOURCES.glob("*.h"), *libraries]
    if not program.exists() or any(f.stat().st_mtime > program.stat().st_mtime for f in inputs):
        run([*COMPILER, f"-I{ROOT}", *sorted(SOURCES.glob("*.cpp")), "-Wl,--start-group",
             *libraries, "-Wl,--end-group", "-lfmt", "-lembree3", "-pthread", "-ldl", "-o", program])
    return program

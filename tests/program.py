# SPDX-License-Identifier: Apache-2.0
"""What every test in Python is given: TEST.py BUILD_DIR REPO_ROOT [ARGUMENTS...]"""
import os
import pathlib
import subprocess
import sys

sys.dont_write_bytecode = True
if len(sys.argv) < 3:
    sys.exit(f"usage: {sys.argv[0]} BUILD_DIR REPO_ROOT [ARGUMENTS...]")
BUILD, ROOT = (pathlib.Path(sys.argv.pop(1)).resolve() for _ in range(2))
PROGRAM = str(BUILD / "mirrorball")
HANG_LIMIT = 1000  # seconds: many times what a slow, busy machine takes for any command


def run(*arguments, code=0, cwd=ROOT, **environment):
    """The program's outcome, which must be this exit code."""
    result = subprocess.run([PROGRAM, *map(str, arguments)], cwd=cwd, env=os.environ | environment, text=True,
                            capture_output=True, timeout=HANG_LIMIT, check=False)
    assert result.returncode == code, (arguments, result.returncode, result.stdout, result.stderr)
    return result

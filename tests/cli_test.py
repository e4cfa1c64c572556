#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The mirrorball command line, from outside, also with an OpenCL driver that misbehaves (tests/cl_shim.cpp).

usage: cli_test.py BUILD_DIR REPO_ROOT [I/N] [TEST...]

TEST is a unittest name such as signal_cases or stats_cases.TextStats.test_sections, or `cli` or `drivers` for all
in that folder. I/N: only every N-th test, from the I-th, counted from 0. Needs python3-matplotlib, for numpy and
Pillow, and python3-jsonschema.
"""
import pathlib
import sys
import unittest

import program

FOLDERS = [program.ROOT / "tests" / name for name in ["cli", "drivers"]]
sys.path[:0] = map(str, FOLDERS)
GROUPS = {folder.name: [path.stem for path in sorted(folder.glob("*_cases.py"))] for folder in FOLDERS}


def tests_of(suite):
    """All tests, however deep in suites."""
    for test in suite:
        yield from tests_of(test) if isinstance(test, unittest.TestSuite) else [test]


def main():
    arguments = sys.argv[1:]
    share, shares = map(int, arguments.pop(0).split("/")) if "/" in "".join(arguments[:1]) else (0, 1)
    names = [name for argument in arguments or GROUPS for name in GROUPS.get(argument, [argument])]
    tests = [*tests_of(unittest.defaultTestLoader.loadTestsFromNames(names))]
    result = unittest.TextTestRunner(verbosity=2).run(unittest.TestSuite(tests[share::shares]))
    sys.exit(0 if result.wasSuccessful() else 1)


if __name__ == "__main__":
    main()

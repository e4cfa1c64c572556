#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The mirrorball command line, from outside. Usage: cli_test.py BUILD_DIR REPO_ROOT [TEST...]

TEST is a unittest name such as signal_cases or stats_cases.TextStats.test_sections.
"""
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "cli"))
sys.dont_write_bytecode = True

import harness

MODULES = [
    "usage_cases",
    "scene_cases",
    "output_cases",
    "device_cases",
    "picture_cases",
    "render_cases",
    "compare_cases",
    "stats_cases",
    "stream_cases",
    "signal_cases",
]


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    with harness.environment(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])):
        suite = unittest.defaultTestLoader.loadTestsFromNames(sys.argv[3:] or MODULES)
        result = unittest.TextTestRunner().run(suite)
    sys.exit(0 if result.wasSuccessful() else 1)


if __name__ == "__main__":
    main()

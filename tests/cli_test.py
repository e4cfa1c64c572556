#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The mirrorball command line, from outside. Usage: cli_test.py BUILD_DIR REPO_ROOT [TEST...]

TEST is a unittest name such as signal_cases or stats_cases.TextStats.test_sections, or `calm` or
`timed` for those that may run next to other tests, or may not.
"""
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "cli"))
sys.dont_write_bytecode = True

import harness

MODULES = {
    "calm": ["usage_cases", "shell_cases", "batch_cases", "journal_cases", "doctor_cases",
             "explain_cases", "frames_cases", "scene_cases", "pipe_cases",
             "view_cases", "watch_cases", "aov_cases",
             "output_cases", "device_cases", "picture_cases",
             "render_cases", "compare_cases", "stats_cases", "failure_cases", "estimate_cases"],
    "timed": ["stream_cases", "signal_cases"],
}


def names(arguments):
    """Tests for unittest: groups by their modules, all of them without arguments."""
    return [name for argument in arguments or MODULES for name in MODULES.get(argument, [argument])]


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    with harness.environment(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])):
        suite = unittest.defaultTestLoader.loadTestsFromNames(names(sys.argv[3:]))
        result = unittest.TextTestRunner(verbosity=2).run(suite)
    sys.exit(0 if result.wasSuccessful() else 1)


if __name__ == "__main__":
    main()

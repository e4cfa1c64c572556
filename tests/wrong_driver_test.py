# SPDX-License-Identifier: Apache-2.0
"""A driver that misbehaves (tests/cl_shim.cpp) costs time, not the picture, and is found out.

usage: wrong_driver_test.py BUILD_DIR REPO_ROOT [I/N] [TEST...]

I/N: only every N-th test, from the I-th, counted from 0. TEST: such as Wrong.test_by_the_doctor.
"""
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "drivers"))
sys.dont_write_bytecode = True

from batch_cases import DiesInABatch
from dies_cases import Dies, IsNotAsked
from fails_cases import Fails
from measure_cases import Bench, Converge, Math, Stress
from selftest_cases import Selftest
from wrong_cases import Wrong

del sys.argv[1:3]
SHARE, SHARES = map(int, sys.argv.pop(1).split("/")) if "/" in "".join(sys.argv[1:2]) else (0, 1)


def load_tests(_loader, classes, _pattern):
    tests = [test for tests in classes for test in tests]
    return unittest.TestSuite(tests[SHARE::SHARES])


if __name__ == "__main__":
    unittest.main(verbosity=2)

# SPDX-License-Identifier: Apache-2.0
"""The package of this tree, over the program that $MIRRORBALL names, else that of build/release."""
import os
import pathlib
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "python"))
sys.dont_write_bytecode = True


@pytest.fixture(autouse=True)
def program(monkeypatch):
    if "MIRRORBALL" not in os.environ:
        monkeypatch.setenv("MIRRORBALL", str(ROOT / "build" / "release" / "mirrorball"))

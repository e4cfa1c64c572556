# SPDX-License-Identifier: Apache-2.0
"""mirrorball from Python: each call runs the program in a process of its own.

A scene is a path, or a dict with the keys of a JSON scene. Keyword arguments are the program's options,
with `_` for `-`. What fails raises Error, or its subclass for the program's exit code.
"""
from .errors import (DeviceError, Error, InputError, InternalError, LimitError, MissingPartsError,
                     NonFiniteError, OutputError, UsageError)
from .measures import (Rows, bench, compare, converge, devices, doctor, explain, options, scene_info,
                       stress)
from .picture import Picture, read_pfm, write_pfm
from .program import find_program
from .rendering import aov, render
from .scenes import load, scene

__all__ = ["DeviceError", "Error", "InputError", "InternalError", "LimitError",
           "MissingPartsError", "NonFiniteError", "OutputError", "Picture", "Rows", "UsageError",
           "aov", "bench", "compare", "converge", "devices", "doctor", "explain", "find_program", "load",
           "options", "read_pfm", "render", "scene", "scene_info", "stress", "write_pfm"]
__version__ = "0.1.0"

# SPDX-License-Identifier: Apache-2.0
"""The program's exit codes as exceptions."""
from __future__ import annotations


class Error(Exception):
    """The program failed: its message, and its exit code."""

    def __init__(self, message: str, exit_code: int) -> None:
        super().__init__(message)
        self.exit_code = exit_code


class UsageError(Error):
    """Exit code 2: an unknown option, or a value that an option does not take."""


class InputError(Error):
    """Exit code 3: a scene or picture was rejected."""


class OutputError(Error):
    """Exit code 4: a file could not be written."""


class DeviceError(Error):
    """Exit code 5: no usable device, or it failed under no_fallback=True."""


class NonFiniteError(Error):
    """Exit code 6: the picture has a NaN or an infinity."""


class LimitError(Error):
    """Exit code 7: over a memory or size limit."""


class MissingPartsError(Error):
    """Exit code 8: parts of the picture are missing, for example after a timeout."""


class InternalError(Error):
    """Exit code 70: a bug in mirrorball."""


_BY_EXIT_CODE = {2: UsageError, 3: InputError, 4: OutputError, 5: DeviceError, 6: NonFiniteError,
                 7: LimitError, 8: MissingPartsError, 70: InternalError}


def error_of(exit_code: int, message: str) -> Error:
    """The exception for an exit code; Error itself where none has a name."""
    text = message.strip() or f"mirrorball ended with exit code {exit_code}"
    return _BY_EXIT_CODE.get(exit_code, Error)(text, exit_code)

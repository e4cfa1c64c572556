# SPDX-License-Identifier: Apache-2.0
"""Finds the program, spells its options and runs it."""
from __future__ import annotations

import json
import os
import pathlib
import shutil
import subprocess
import sys
import threading
from typing import Any, Callable, Iterable, Optional

from .errors import UsageError, error_of

Progress = Callable[[float], None]

_PACKAGED = pathlib.Path(__file__).resolve().parent / "program" / "bin" / "mirrorball"  # in a wheel
_SECONDS_TO_STOP = 10


def find_program() -> str:
    """The path of the program: $MIRRORBALL, else the package's own, else the one in PATH.

    Raises FileNotFoundError if there is none.
    """
    named = os.environ.get("MIRRORBALL")
    if named:
        found = shutil.which(named)
        if found is None:
            raise FileNotFoundError(f"MIRRORBALL is {named}, which is not a program")
        return os.path.abspath(found)
    if _PACKAGED.exists():
        return str(_PACKAGED)
    found = next((path for path in _in_path("mirrorball") if not _is_script(path)), None)
    if found is None:
        raise FileNotFoundError("no mirrorball in PATH: install it, or set MIRRORBALL to its path")
    return found


def _in_path(name: str) -> Iterable[str]:
    for folder in os.get_exec_path():
        path = shutil.which(name, path=folder)
        if path is not None:
            yield path


def _is_script(path: str) -> bool:
    """Whether it is a script, such as the command that pip makes for main() below."""
    with open(path, "rb") as file:
        return file.read(2) == b"#!"


def _word(value: Any) -> str:
    if isinstance(value, (list, tuple)):
        return ",".join("x".join(map(str, part)) if isinstance(part, (list, tuple)) else _word(part) for part in value)
    return os.fspath(value) if isinstance(value, os.PathLike) else str(value)


def option_words(options: dict[str, Any]) -> list[str]:
    """The command line's words for keyword arguments: `max_bounces=4` is `--max-bounces 4`.

    None and False leave an option out, True gives a flag; a list is written with commas, a size in it with x.
    """
    words = []
    for name, value in options.items():
        if value is None or value is False:
            continue
        words.append("--" + name.replace("_", "-"))
        if value is not True:
            words.append(_word([value] if name == "size" else value))
    return words


def _stop(process: subprocess.Popen[str]) -> None:
    """Asks the program to end, which has nobody to write to any more; kills it if it does not."""
    if process.poll() is not None:
        return
    assert process.stdout is not None
    process.stdout.close()
    process.terminate()  # SIGINT is ignored in background jobs
    try:
        process.wait(_SECONDS_TO_STOP)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def _listen(process: subprocess.Popen[str], progress: Optional[Progress], said: list[str],
            raised: list[BaseException], echo: bool) -> None:
    """Takes the lines of stderr: shares of progress, and everything else. What `progress` raises
    stops the program, which must not wait for a reader of its messages."""
    assert process.stderr is not None
    for line in process.stderr:
        try:
            fraction = float(json.loads(line)["fraction"])
        except (ValueError, TypeError, KeyError):
            said.append(line)
            if echo:
                print(line, end="", file=sys.stderr, flush=True)
            continue
        if progress is None or raised:
            continue
        try:
            progress(fraction)
        except BaseException as error:
            raised.append(error)
            process.terminate()


def run(words: Iterable[Any], progress: Optional[Progress] = None,
        accepted: Iterable[int] = (0,), echo: bool = False) -> str:
    """What the program prints on stdout; `echo` passes its messages on to stderr as they come.

    Raises Error if its exit code is not among the accepted, or is not 0 and it printed nothing. An interrupt,
    and what `progress` raises, first stops the program and is then raised again.
    """
    command = [find_program(), *(_word(word) for word in words)]
    said: list[str] = []
    raised: list[BaseException] = []
    with subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, encoding="utf-8", errors="replace") as process:
        assert process.stdout is not None
        listener = threading.Thread(target=_listen, args=(process, progress, said, raised, echo),
                                    daemon=True)
        try:
            listener.start()
            printed = process.stdout.read()
            process.wait()
        except BaseException:
            _stop(process)
            raise
        finally:
            if listener.is_alive():
                listener.join(_SECONDS_TO_STOP)
    if raised:
        raise raised[0]
    if process.returncode not in accepted or (process.returncode != 0 and not printed):
        raise error_of(process.returncode, "".join(said))
    return printed


def run_json(words: Iterable[Any], progress: Optional[Progress] = None,
             accepted: Iterable[int] = (0,), echo: bool = False) -> dict[str, Any]:
    """The JSON object that the program prints."""
    printed = run(words, progress, accepted, echo)
    try:
        return dict(json.loads(printed))
    except ValueError as error:
        raise UsageError("mirrorball printed no JSON: an option here may send it elsewhere",
                         0) from error


def run_main(main: Callable[[], int]) -> None:
    """Ends this process with the exit code that `main` returns; 5, after one line, if there is no program."""
    try:
        find_program()
    except FileNotFoundError as error:
        print(f"mirrorball: {error}", file=sys.stderr)
        sys.exit(5)
    sys.exit(main())


def _become_program() -> int:
    program = find_program()
    os.execv(program, [program, *sys.argv[1:]])


def main() -> None:
    """The command `mirrorball` of an installed package: the program itself, in this process's place."""
    run_main(_become_program)

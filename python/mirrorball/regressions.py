# SPDX-License-Identifier: Apache-2.0
"""Which rows of a bench became slower: python3 -m mirrorball.regressions OLD.json NEW.json [--max-regress P%]

Both files are of `mirrorball bench --json FILE`. A row is slower when its median time, total or trace, exceeds the old
one by more than P % and by more than 3 times the sum of both MADs. Exit code 1 if a row is slower, 3 for a damaged file
or if no row is in both.
"""
from __future__ import annotations

import argparse
import json
import pathlib
import sys
from typing import Any


def slower(old: dict[str, Any], new: dict[str, Any], max_regress: float) -> bool:
    """Whether a time (its median and MAD) has grown by more than the share max_regress and by more than noise."""
    growth = new["median"] - old["median"]
    return growth > max_regress * old["median"] and growth > 3 * (old["mad"] + new["mad"])


def regressions(old: dict[str, Any], new: dict[str, Any], max_regress: float = .05) -> list[str]:
    """A line for each row that became slower, in total or else in trace; both are results of bench.

    Raises ValueError if no row is in both.
    """
    known, rows = _rows(old), _rows(new)
    if not known.keys() & rows.keys():
        raise ValueError("no row is in both results; use the same scenes, sizes, AA modes and devices")
    lines = []
    for key, row in rows.items():
        for what in ("total", "trace") if key in known else ():
            before, now = known[key]["figures"][what], row["figures"][what]
            if slower(before, now, max_regress):
                name = " ".join([row["scene"]["path"], *key.split()[1:]])  # a key begins with the scene's hash
                lines.append(f"{name}: {what} {now['median']:.6f} s was {before['median']:.6f} s")
                break
    return lines


def _rows(result: dict[str, Any]) -> dict[str, Any]:
    return {row["key"]: row for row in result["rows"] if row["figures"]}


def _read(path: str) -> dict[str, Any]:
    try:
        result = json.loads(pathlib.Path(path).read_text(encoding="utf-8"))
        if (result["format"], result["version"]) != ("mirrorball-bench", 1):
            raise ValueError
        for row in _rows(result).values():
            slower(row["figures"]["total"], row["figures"]["trace"], 0)
            str.join(" ", [row["scene"]["path"], row["key"]])
        return result
    except OSError as error:
        raise ValueError(f"{path}: cannot read: {error.strerror}; check the path") from None
    except (ValueError, LookupError, TypeError, AttributeError, RecursionError):
        raise ValueError(f"{path}: is not a result of mirrorball bench; write one with 'bench --json FILE'") from None


def _share(text: str) -> float:
    share = float(text.removesuffix("%")) / 100
    if not 0 <= share <= 1e6:
        raise ValueError
    return share


def main() -> int:
    parser = argparse.ArgumentParser(prog="python3 -m mirrorball.regressions", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", metavar="OLD.json")
    parser.add_argument("new", metavar="NEW.json")
    parser.add_argument("--max-regress", type=_share, default=.05, metavar="P%", help="default: 5%%")
    arguments = parser.parse_args()
    try:
        found = regressions(_read(arguments.old), _read(arguments.new), arguments.max_regress)
    except ValueError as error:
        print(f"mirrorball: {error}", file=sys.stderr)
        return 3
    sys.stdout.reconfigure(errors="backslashreplace")  # type: ignore[union-attr]
    for line in found or ["no row is slower"]:
        print(f"slower: {line}" if found else line)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())

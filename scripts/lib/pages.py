# SPDX-License-Identifier: Apache-2.0
"""Pages of docs/ with parts that scripts write, each between its own markers, and the provenance of such a part:
date, machine, revision."""
import datetime
import json
import os
import pathlib

from lib.program import ROOT, run

NUMERICS = ROOT / "docs" / "numerics.md"
BENCH_STAMP = "MIRRORBALL_BENCH_STAMP"


def replace_between_marks(page, name, text, is_whole=True):
    """Puts the text between the page's lines `<!-- NAME: begin -->` and `<!-- NAME: end -->`; prints a part."""
    if not is_whole:
        return print(text, end="")
    begin, end = f"<!-- {name}: begin -->\n", f"<!-- {name}: end -->\n"
    before, rest = page.read_text(encoding="utf-8").split(begin)
    _, after = rest.split(end)
    page.write_text(before + begin + text + end + after, encoding="utf-8")


def environment(program):
    """The environment that `mirrorball bench --json` reports."""
    return json.loads(run([program, "bench", "scenes/empty.json", "--sizes", "8", "--aa", "none", "--devices",
                           "threads:1", "--repeats", "1", "--json", "-q"]))["environment"]


def processor():
    """As the program names it."""
    lines = pathlib.Path("/proc/cpuinfo").read_text().partition("\n\n")[0].splitlines()
    about = dict(map(str.strip, line.partition(":")[::2]) for line in lines)
    return f"{about['model name']} (family {about['cpu family']}, model {about['model']})"


def revision_stamp():
    """One line of Markdown for results of the source alone, without a program: date, processor, revision."""
    revision = run(["git", "describe", "--always", "--dirty", "--abbrev=12", "--exclude=*"]).strip()
    return f"*{datetime.date.today()}, {processor()}, revision {revision}.*"


def stamp(program, has_times=True):
    """One line of Markdown; scripts/bench's own for the scripts it runs, whose load is its work. A busy
    machine matters where there are times."""
    busy = "; **the machine was busy**"
    if BENCH_STAMP in os.environ:
        where = os.environ[BENCH_STAMP]
        return where if has_times else where.replace(busy, "")
    machine = environment(program)
    return (f"*{datetime.date.today()}, {machine['cpu']}, {machine['cores']} cores, "
            f"{machine['os']}; {machine['program']}, revision {machine['git_revision']}"
            f"{busy if has_times and machine['busy'] else ''}.*")

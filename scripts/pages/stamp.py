# SPDX-License-Identifier: Apache-2.0
"""The provenance of a table of figures: date, machine, revision."""
import datetime
import json
import os
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BENCH_STAMP = "MIRRORBALL_BENCH_STAMP"


def environment(program):
    """The environment that `mirrorball bench --json` reports."""
    result = subprocess.run([program, "bench", "scenes/empty.json", "--sizes", "8", "--aa", "none",
                             "--devices", "threads:1", "--repeats", "1", "--json", "-q"], check=True,
                            capture_output=True, text=True, cwd=ROOT)
    return json.loads(result.stdout)["environment"]


def processor():
    """As the program names it."""
    lines = pathlib.Path("/proc/cpuinfo").read_text().partition("\n\n")[0].splitlines()
    about = dict(map(str.strip, line.partition(":")[::2]) for line in lines)
    return f"{about['model name']} (family {about['cpu family']}, model {about['model']})"


def revision_stamp():
    """One line of Markdown for results of the source alone, without a program: date, processor, revision."""
    revision = subprocess.run(["git", "describe", "--always", "--dirty", "--abbrev=12", "--exclude=*"],
                              check=True, capture_output=True, text=True, cwd=ROOT).stdout.strip()
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

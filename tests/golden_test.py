# SPDX-License-Identifier: Apache-2.0
"""The JSON and CSV of each verb: every key in its order and, where it does not depend on the machine or
the moment, its value, as in tests/golden/; and each result is what its schema in docs/ says.

usage: golden_test.py BUILD_DIR REPO_ROOT [--write]
"""
import csv
import json
import pathlib
import re
import sys
import tempfile
import unittest

import jsonschema

from program import ROOT, run

WRITE = "--write" in sys.argv
sys.argv = [argument for argument in sys.argv if argument != "--write"]
GOLDEN = ROOT / "tests" / "golden"

BOX = ["scenes/cornell-box.json", "--size", "24x16"]
# Each writes its JSON to {}.json and, where it has one, its CSV to {}.csv.
RUNS = {
    "render-threads": ["render", *BOX, "--device", "threads:2", "--stats=json"],
    "render-buffers": ["render", *BOX, "--device", "threads:2", "--schedule", "buffers", "--stats=json"],
    "render-pocl": ["render", *BOX, "--device", "pocl", "--launch", "sample", "--stats=json"],
    "render-crop": ["render", *BOX, "--device", "threads:1", "--crop", "3,2,11,9", "--aa", "sobol:4",
                    "--filter", "tent", "--precision", "double", "--max-bounces", "2", "--stats=json"],
    "render-adaptive": ["render", "scenes/glass.json", "--size", "24", "--device", "threads:1", "--aa",
                        "adaptive:0.1", "--features", "all", "--stats=json"],
    "render-mesh": ["render", "scenes/meshes.json", "--size", "16", "--device", "pocl,threads:1",
                    "--stats=json"],
    "render-reference": ["render", *BOX, "--device", "threads:1", "--aa", "none", "--reference",
                         "{}.pfm", "--stats=json"],
    "bench": ["bench", "scenes/cornell-box.json", "--sizes", "16", "--aa", "grid:2", "--devices",
              "threads:1,pocl", "--precision", "float", "--repeats", "1",
              "-q", "--json", "{}.json", "--csv", "{}.csv"],
    "converge": ["converge", "scenes/cornell-box.json", "--size", "16", "--aa", "none,sobol:4",
                 "--devices", "threads:1", "--precision", "float", "--reference-samples", "16", "--repeats", "5", "-q",
                 "--json", "{}.json", "--csv", "{}.csv"],
    "stress": ["stress", "--case", "coincident,sphere-rays", "--quick", "--device", "threads", "--json", "{}.json"],
    "scene-info": ["scene", "info", "scenes/glass.json", "--json"],
    "compare": ["compare", "{}.pfm", "{}.pfm", "--json", "{}.json"],
    "explain": ["explain", "scenes/glass.json", "--size", "16", "--pixel", "7,9", "--json"],
}

# What depends on the machine or on the moment: only the kind of value is compared.
VOLATILE = {"environment", "seconds", "rays_per_second", "started", "figures", "hierarchy_seconds",
            "reference_seconds", "lanes", "isa", "platform", "driver", "ready", "pixels",
            "slope", "open", "first_build", "warm_build", "point", "bar",
            "pareto_front", "features_left_out", "program", "path", "device_name"}


def kind(value):
    return {bool: "bool", int: "number", float: "number", str: "text", type(None): "null"}[type(value)]


def lines(value, path="", volatile=False):
    """A line for each value: its path, and itself or its kind; of a list of records, the first."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from lines(inner, f"{path}/{key}", volatile or key in VOLATILE)
    elif isinstance(value, list) and any(isinstance(item, (dict, list)) for item in value):
        yield f"{path}: {len(value)} items"
        yield from lines(value[0], f"{path}/0", volatile)
    elif isinstance(value, list):
        yield f"{path}: " + ("list" if volatile else json.dumps(value))
    else:
        yield f"{path}: " + (kind(value) if volatile else json.dumps(value))


def without(value, keys):
    """The value without these fields, however deep."""
    if isinstance(value, list):
        return [without(item, keys) for item in value]
    if isinstance(value, dict):
        return {key: without(inner, keys) for key, inner in value.items() if key not in keys}
    return value


def expect_documented(result):
    """By the schema of its format, if that has one, which notices missing fields."""
    name = result["format"].removeprefix("mirrorball-").replace("render", "results")
    path = ROOT / "docs" / f"{name}.schema.json"
    if path.exists():
        schema = json.loads(path.read_text())
        jsonschema.Draft202012Validator.check_schema(schema)
        validator = jsonschema.Draft202012Validator(schema)
        validator.validate(result)
        assert not validator.is_valid(without(result, ["trace", "max_error", "rmse"]))


def outcome(name, command, folder):
    stem = str(pathlib.Path(folder) / name)
    pixels = b"".join(number.to_bytes(4, "little") for number in [0x3F000000] * 3 * 24 * 16)
    pathlib.Path(stem + ".pfm").write_bytes(b"PF\n24 16\n-1.0\n" + pixels)
    said = run(*(word.replace("{}", stem) for word in command)).stdout
    file = pathlib.Path(stem + ".json")
    text = file.read_text() if file.exists() else said
    expect_documented(json.loads(text))
    found = list(lines(json.loads(text)))
    table = pathlib.Path(stem + ".csv")
    if table.exists():
        rows = list(csv.reader(table.read_text().splitlines()))
        found += ["csv: " + ",".join(rows[0])] + [f"csv: {len(row)} cells" for row in rows[1:]]
    # PoCL's device has the processor's name.
    return [re.sub(r'pthread-[^"]*?(?= \+ |")', "PoCL", line.replace(stem, "{}")) for line in found]


class Golden(unittest.TestCase):
    maxDiff = None

    def test_results(self):
        for name, command in RUNS.items():
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                found = outcome(name, command, folder)
                if WRITE:
                    GOLDEN.mkdir(exist_ok=True)
                    (GOLDEN / f"{name}.txt").write_text("\n".join(found) + "\n")
                self.assertEqual((GOLDEN / f"{name}.txt").read_text().splitlines(), found)


if __name__ == "__main__":
    unittest.main(verbosity=2)

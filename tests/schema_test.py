#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Does scenes/scene.schema.json agree with the scene reader? Usage: schema_test.py REPO_ROOT

Every scene in scenes/ must validate; every file in tests/scenes_bad/ must not, save those whose
mistake a schema cannot see (SEEN_BY_READER_ONLY). Needs python3-jsonschema.
"""
import json
import pathlib
import re
import sys

import jsonschema

# Geometry, names that refer to each other, repeated keys: beyond JSON Schema. Files that are not
# JSON never get to it.
SEEN_BY_READER_ONLY = {
    "camera-default-up-parallel",
    "camera-same-point",
    "camera-up-parallel",
    "camera-up-zero",
    "camera-window-mirrored",
    "cone-same-point",
    "cone-zero-radii",
    "duplicate-key",
    "duplicate-key-escaped",
    "duplicate-material",
    "image-too-many-pixels",
    "mesh-missing",
    "mesh-transform-singular",
    "mesh-unknown-material",
    "path-frames-descend",
    "path-height-of-perspective",
    "path-no-view",
    "sphere-no-materials",
    "sphere-unknown-material",
    "sphere-unknown-material-far",
    "triangle-point-far-away",
    "triangle-repeated-vertex",
    "triangle-zero-area",
    "triangle-zero-area-rounded",
    "triangle-zero-normal",
}

# As tests/host_scene_test.cpp has them for the reader.
GOOD_AA = "none grid:1 grid:064 sobol:4096 adaptive:.05 adaptive:1. adaptive:1E-3 adaptive:0.05e0 edges:5.e-3 edges:00.5"
BAD_AA = "grid:0 grid:65 grid:+2 GRID:2 sobol:0 sobol:4097 adaptive: edges:inf edges:0x1p-3"

STRING_OR_COMMENT = re.compile(r'"(?:\\.|[^"\\])*"|//[^\r\n]*|/\*.*?\*/', re.DOTALL)


def strip_comments(text):
    """Blanks out comments, but not what looks like one within a string."""
    return STRING_OR_COMMENT.sub(lambda m: m[0] if m[0].startswith('"') else " ", text)


def refuse_constant(word):
    raise ValueError(f"{word} is not JSON")


def load(path):
    text = strip_comments(path.read_text(encoding="utf-8-sig"))
    return json.loads(text, parse_constant=refuse_constant)


def complaint(validator, path):
    """What is wrong with one scene file, or None; ValueError when it is not even JSON."""
    error = jsonschema.exceptions.best_match(validator.iter_errors(load(path)))
    return f"{error.json_path}: {error.message}" if error else None


def main():
    root = pathlib.Path(sys.argv[1])
    schema_path = root / "scenes" / "scene.schema.json"
    schema = json.loads(schema_path.read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    good = [path for path in schema_path.parent.rglob("*.json") if path.name not in ("scene.schema.json", "golden.json")]
    bad = list((root / "tests" / "scenes_bad").glob("*.json"))
    failures = 0 if good and bad else 1
    aa = jsonschema.Draft202012Validator(schema["$defs"]["image"]["properties"]["aa"])
    for texts, is_good in [(GOOD_AA, True), (BAD_AA, False)]:
        for text in texts.split():
            if aa.is_valid(text) != is_good:
                print(f"aa {text!r}: {'fails' if is_good else 'passes'}")
                failures += 1
    for path in [*good, *bad]:
        try:
            if path in good:
                json.loads(path.read_text(encoding="utf-8"))  # without comments: any JSON reader takes it
            problem = complaint(validator, path)
        except ValueError as error:
            problem = str(error)
        if (problem is None) != (path in good or path.stem in SEEN_BY_READER_ONLY):
            print(f"{path}: {problem or 'should fail the schema, but validates'}")
            failures += 1
    print(f"schema_test: {len(good)} good and {len(bad)} bad scenes: {failures} failures")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()

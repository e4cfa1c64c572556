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


def check_good(validator, paths):
    """Shipped scenes have no comments, so that any JSON reader takes them."""
    failures = []
    for path in paths:
        try:
            json.loads(path.read_text(encoding="utf-8"))
            problem = complaint(validator, path)
        except ValueError as error:
            problem = str(error)
        if problem:
            failures.append(f"{path}: should validate, but: {problem}")
    return failures


def check_bad(validator, paths):
    failures = []
    for path in paths:
        try:
            problem = complaint(validator, path)
        except ValueError:
            continue
        if problem is None and path.stem not in SEEN_BY_READER_ONLY:
            failures.append(f"{path}: should fail the schema, but validates")
        if problem is not None and path.stem in SEEN_BY_READER_ONLY:
            failures.append(f"{path}: listed as seen by the reader only, but fails: {problem}")
    return failures


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: schema_test.py REPO_ROOT")
    root = pathlib.Path(sys.argv[1])
    schema_path = root / "scenes" / "scene.schema.json"
    schema = json.loads(schema_path.read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    good = sorted(path for path in schema_path.parent.rglob("*.json") if path not in (schema_path, schema_path.with_name("golden.json")))
    bad = sorted((root / "tests" / "scenes_bad").glob("*.json"))
    if not good or not bad:
        sys.exit(f"schema_test: no scenes found under {root}; pass the repository root")
    failures = check_good(validator, good) + check_bad(validator, bad)
    for failure in failures:
        print(failure)
    verdict = f"{len(failures)} FAILURES" if failures else "ok"
    print(f"schema_test: {len(good)} good and {len(bad)} bad scenes: {verdict}")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()

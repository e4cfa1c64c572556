# SPDX-License-Identifier: Apache-2.0
"""--stats=json is what docs/results.schema.json says, on threads and on OpenCL.

usage: results_schema_test.py BUILD_DIR REPO_ROOT
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import jsonschema

from hang_limit import HANG_LIMIT

BUILD = pathlib.Path(sys.argv.pop(1))
ROOT = pathlib.Path(sys.argv.pop(1))
SCHEMA = json.loads((ROOT / "docs" / "results.schema.json").read_text())


def stats(*options):
    command = [str(BUILD / "mirrorball"), "render", str(ROOT / "scenes" / "cornell-box.json"),
               "--size", "64", "-q", "--stats=json", *options]
    result = subprocess.run(command, check=True, capture_output=True, timeout=HANG_LIMIT)
    return json.loads(result.stdout)


class ResultsSchema(unittest.TestCase):
    def setUp(self):
        self.validator = jsonschema.Draft202012Validator(SCHEMA)

    def test_schema_is_a_schema(self):
        jsonschema.Draft202012Validator.check_schema(SCHEMA)

    def test_threads(self):
        self.validator.validate(stats("--device", "threads"))

    def test_opencl(self):
        self.validator.validate(stats("--device", "pocl", "--launch", "sample"))

    def test_reference(self):
        with tempfile.TemporaryDirectory() as folder:
            picture = str(pathlib.Path(folder) / "reference.pfm")
            stats("--device", "threads", "-o", picture)
            result = stats("--device", "threads", "--reference", picture)
            self.assertEqual(result["error"]["rmse"], 0)
            self.validator.validate(result)

    def test_a_missing_field_is_noticed(self):
        result = stats("--device", "threads")
        del result["seconds"]["trace"]
        self.assertFalse(self.validator.is_valid(result))


if __name__ == "__main__":
    unittest.main(verbosity=2)

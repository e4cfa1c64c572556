#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Sources include what they name, themselves or by our own headers.

Several of them are compiled at a time, so that a missing #include would only show where each is compiled
on its own. It also compiles scripts/embree, which no build does. Usage: includes_test.py BUILD_DIR REPO_ROOT
"""
import functools
import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(sys.argv.pop())
del sys.argv[1:2]
ALGORITHMS = "all_of any_of clamp copy_if find find_if max min max_element min_element none_of sort stable_sort"
HEADERS = {
    "algorithm": "std::(" + "|".join(ALGORITHMS.split()) + ")", "array": "std::array", "atomic": "std::atomic",
    "chrono": "std::chrono", "cmath": "std::(sqrt|abs|pow|isfinite|isnan)", "filesystem": "std::filesystem",
    "fmt/format.h": "fmt::format", "fmt/ranges.h": "fmt::join", "fstream": "std::[io]fstream",
    "functional": "std::function", "future": "std::(async|future)", "map": "std::map", "memory": "std::(unique|shared)_ptr",
    "mutex": "std::(mutex|lock_guard|unique_lock)", "nlohmann": "nlohmann::", "numeric": "std::(iota|accumulate)",
    "optional": "std::optional", "set": "std::set", "span": "std::span", "string": "std::(string|to_string)",
    "string_view": "std::string_view", "thread": "std::thread", "tuple": "std::(tuple|tie)", "utility": "std::(move|exchange|pair)",
    "variant": "std::(variant|visit)", "vector": "std::vector"}


@functools.cache
def included(file):
    """The headers that a file of ours includes, those of its headers among them."""
    own = set(re.findall(r'^#include [<"]([^>"]+)[>"]', (ROOT / file).read_text(), re.MULTILINE))
    return own.union(*(included(header) for header in own if (ROOT / header).is_file()))


class IncludesTest(unittest.TestCase):
    def test_every_name_has_its_header(self):
        missing = []
        for path in sorted((ROOT / "host").rglob("*.[ch]*")):
            file, text = str(path.relative_to(ROOT)), path.read_text()
            for header, names in HEADERS.items():
                if re.search(rf"\b{names}\b", text) and not any(
                        (name + "/").startswith(header + "/") for name in included(file)):
                    missing.append(f"{file}: <{header}>")
        self.assertFalse(missing, "without:\n" + "\n".join(missing))

    def test_the_embree_program_compiles(self):
        sources = sorted((ROOT / "scripts" / "embree").glob("*.cpp"))
        self.assertTrue(sources)
        subprocess.run(["g++", "-std=c++20", "-march=native", "-fsyntax-only", "-Wno-psabi", f"-I{ROOT}", *sources],
                       check=True)


if __name__ == "__main__":
    unittest.main()

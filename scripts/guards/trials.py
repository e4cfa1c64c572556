# SPDX-License-Identifier: Apache-2.0
"""Changes a copy of the tree (removes something or introduces a fault), builds what the tests need, and
runs them. A change has a name, edits and tests, as in guards.py and mutants.py.
"""
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
TIME_LIMIT = 1800
PROGRAMS = {"stress": ["mirrorball"], "cli": ["mirrorball"], "py": ["mirrorball", "cl_shim"],
            "compiler": ["geometry_tests"], "geometry": ["geometry_tests"], "host": ["host_tests"],
            "kernel": ["kernel_tests"]}


def one_isa():
    """Native kernels for one instruction set: a change to the kernels compiles them all again."""
    with_avx2 = " avx2 " in (pathlib.Path("/proc/cpuinfo").read_text() + " ")
    return ["-DMIRRORBALL_ISAS=x86-64-v3"] if with_avx2 else []


class Tree:
    """The files git knows of as they are now, in build/NAME, with a build folder of their own."""

    def __init__(self, name):
        self.root = ROOT / "build" / name
        self.build_folder = self.root / "build"
        self.root.mkdir(parents=True, exist_ok=True)
        files = self.must("git", "ls-files", "--cached", "--others", "--exclude-standard", cwd=ROOT)
        for file in files.splitlines():
            self.copy(ROOT / file, self.root / file)
        self.must("cmake", "-S", ".", "-B", self.build_folder, "-G", "Ninja",
                  "-DMIRRORBALL_TESTS=ON", "-DCMAKE_UNITY_BUILD=OFF", *one_isa())

    @staticmethod
    def copy(source, copy):
        """A file that has not changed keeps its time."""
        if not source.is_file():
            return
        if copy.is_file() and copy.read_bytes() == source.read_bytes():
            return
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source, copy)
        shutil.copymode(source, copy)

    def quietly(self, *command, cwd=None):
        """Whether a command succeeds, and what it said."""
        try:
            run = subprocess.run([str(word) for word in command], cwd=cwd or self.root, check=False,
                                 text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                 timeout=TIME_LIMIT)
        except subprocess.TimeoutExpired:
            return False, "too long"
        return run.returncode == 0, run.stdout

    def must(self, *command, cwd=None):
        done, said = self.quietly(*command, cwd=cwd)
        if not done:
            sys.exit(f"{' '.join(map(str, command))}\n{said}")
        return said

    def build(self, tests):
        targets = {target for test in tests for target in targets_of(test)}
        return self.quietly("cmake", "--build", self.build_folder, "--target", *sorted(targets))

    def passes(self, test):
        kind, what = test
        program = self.build_folder / "mirrorball"
        if kind == "stress":
            quick = ["--quick"] if "rays" in what else []
            return self.quietly(program, "stress", "--case", what, "-q", *quick)[0]
        if kind == "cli" or kind.endswith(".py"):
            script = "cli_test.py" if kind == "cli" else kind
            done, said = self.quietly(sys.executable, f"tests/{script}", self.build_folder, ".", what)
            if "has no attribute" in said or "Ran 0 tests" in said:
                sys.exit(f"{script} has no test {what}")
            return done
        if what == "*":
            return self.quietly("ctest", "--test-dir", self.build_folder, "-R", f"^{kind}$")[0]
        names = ":".join(f"*{name.replace('.', '*.', 1)}*" for name in what.split(":"))
        done, said = self.quietly(self.build_folder / targets_of(test)[0],
                                  f"--gtest_filter={names}", "--gtest_brief=1")
        if " 0 tests from 0 test suites ran" in said:
            sys.exit(f"{kind} has no test {what}")
        return done

    def texts_with(self, change):
        """The files of a change, as they are with it."""
        texts = {}
        for file, old, new in change.edits:
            text = texts.get(file) or (self.root / file).read_text()
            if old not in text:
                sys.exit(f"{change.name}: not found in {file}: {old}")
            texts[file] = text.replace(old, new)
        return texts

    def check_unchanged(self, changes):
        """All texts are found, and all tests pass as long as nothing is changed."""
        for change in changes:
            self.texts_with(change)
        tests = sorted({test for change in changes for test in change.tests})
        built, said = self.build(tests)
        if not built:
            sys.exit(said)
        failing = [name_of(test) for test in tests if not self.passes(test)]
        if failing:
            sys.exit("fails with nothing changed: " + ", ".join(failing))

    def changed(self, change):
        return Changed(self, change)


class Changed:
    """The tree with a change, while it lasts."""

    def __init__(self, tree, change):
        self.tree = tree
        self.texts = tree.texts_with(change)
        self.before = {file: (tree.root / file).read_text() for file in self.texts}

    def __enter__(self):
        for file, text in self.texts.items():
            (self.tree.root / file).write_text(text)

    def __exit__(self, *_):
        for file, text in self.before.items():
            (self.tree.root / file).write_text(text)


def targets_of(test):
    """What to build: tests/CMakeLists.txt has which file is in which program."""
    if test[0].endswith(".py"):
        return PROGRAMS["py"]
    return PROGRAMS.get(test[0].split("_")[0], ["picture_tests"])


def name_of(test):
    kind, what = test
    return f"stress `{what}`" if kind == "stress" else f"`{kind}`: `{what}`"

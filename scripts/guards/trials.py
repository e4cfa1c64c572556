# SPDX-License-Identifier: Apache-2.0
"""Introduces a fault into a copy of the tree, builds what its tests need, and runs them."""
import contextlib
import dataclasses
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
TIME_LIMIT = 1800
PROGRAMS = {"stress": ["mirrorball"], "cli": ["mirrorball", "cl_shim"], "compiler": ["geometry_tests"],
            "geometry": ["geometry_tests"], "host": ["host_tests"], "kernel": ["kernel_tests"]}


@dataclasses.dataclass
class Fault:
    """`edits`: (file, text that stands in it once, text in its place). `tests`: a file's tests or a
    test program's with a filter, or "stress" with cases, or "cli" or a FILE.py with a test's name; each
    of them must fail."""
    name: str
    edits: list
    tests: list

    def misplaced(self):
        """What is wrong with where the fault is to go; empty when nothing is."""
        for file, old, _ in self.edits:
            found = (ROOT / file).read_text().count(old) if (ROOT / file).is_file() else 0
            if found != 1:
                return f"{self.name}: {found} times in {file}: {old}"
        return ""


def one_isa():
    """Native kernels for one instruction set: a change to the kernels compiles them all again."""
    with_avx2 = " avx2 " in (pathlib.Path("/proc/cpuinfo").read_text() + " ")
    return ["-DMIRRORBALL_NATIVE_ISAS=x86-64-v3"] if with_avx2 else []


class Tree:
    """The files git knows of as they are now, in build/mutants, with a build folder of their own."""

    def __init__(self):
        self.root = ROOT / "build" / "mutants"
        self.build_folder = self.root / "build"
        self.root.mkdir(parents=True, exist_ok=True)
        files = self.must("git", "ls-files", "--cached", "--others", "--exclude-standard", cwd=ROOT)
        for file in files.splitlines():
            self.copy(ROOT / file, self.root / file)
        for folder in {file.partition("/")[0] for file in files.splitlines() if "/" in file}:
            for path in (self.root / folder).rglob("*"):  # of a file that is gone, CMake would find the copy
                if path.is_file() and not (ROOT / path.relative_to(self.root)).exists():
                    path.unlink()
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

    def check_unchanged(self, faults):
        """All tests pass as long as nothing is changed."""
        tests = sorted({test for fault in faults for test in fault.tests})
        built, said = self.build(tests)
        if not built:
            sys.exit(said)
        failing = [name_of(test) for test in tests if not self.passes(test)]
        if failing:
            sys.exit("fails with nothing changed: " + ", ".join(failing))

    @contextlib.contextmanager
    def changed(self, fault):
        """The tree with a fault, while it lasts."""
        before = {file: (self.root / file).read_text() for file, _, _ in fault.edits}
        try:
            for file, old, new in fault.edits:
                path = self.root / file
                path.write_text(path.read_text().replace(old, new))
            yield
        finally:
            for file, text in before.items():
                (self.root / file).write_text(text)

    def verdict_on(self, fault):
        """Nothing when every test notices the fault; what is wrong otherwise."""
        with self.changed(fault):
            built, said = self.build(fault.tests)
            if not built:
                print(said, file=sys.stderr)
                return "does not build"
            unaware = [name_of(test) for test in fault.tests if self.passes(test)]
        return f"not noticed by {', '.join(unaware)}" if unaware else ""


def targets_of(test):
    """What to build: tests/CMakeLists.txt has which file is in which program."""
    if test[0].endswith(".py"):
        return ["mirrorball"]
    return PROGRAMS.get(test[0].split("_")[0], ["picture_tests"])


def name_of(test):
    kind, what = test
    return f"stress `{what}`" if kind == "stress" else f"`{kind}`: `{what}`"

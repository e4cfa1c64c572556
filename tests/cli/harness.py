# SPDX-License-Identifier: Apache-2.0
"""Runs mirrorball as a user would: a fresh folder per test, a time limit on every run."""
import contextlib
import fcntl
import json
import os
import pathlib
import pty
import re
import shutil
import signal
import struct
import subprocess
import tempfile
import termios
import unittest

from program import BUILD, HANG_LIMIT, PROGRAM, ROOT

POCL_DRIVER = "/etc/OpenCL/vendors/pocl.icd"
SHIM = str(BUILD / "libcl_shim.so")
SCENES = ROOT / "scenes"
# Shared by all tests, and removed at the end.
FOLDER = tempfile.TemporaryDirectory(prefix="mirrorball-cli-")
KERNEL_CACHE, NO_DRIVERS = (os.path.join(FOLDER.name, name) for name in ["cache", "no-drivers"])
os.mkdir(KERNEL_CACHE)
os.mkdir(NO_DRIVERS)

CAMERA = {"from": [0, 0, 4], "at": [0, 0, 0], "fov_degrees": 40}
GRAY = {"ambient": 1, "diffuse": 1}


def unwritable_folder(parent):
    """One that takes no file, not even from root."""
    if os.geteuid() == 0:
        return "/proc/sys"
    folder = parent / "unwritable"
    folder.mkdir(mode=0o500)
    return str(folder)


def scene_path(name):
    return str(SCENES / f"{name}.json")


def all_scenes():
    return sorted(p for p in SCENES.glob("*.json") if p.name not in ("golden.json", "scene.schema.json"))


def image_hash(text):
    """The hash in a summary line or in --stats text; None when there is none."""
    found = re.search(r"image (?:hash )?([0-9a-f]{16})\b", text)
    return found[1] if found else None


PROGRESS = re.compile(r"(?m)^ *\d+ %.*  ETA \S+\n")


def clean_environment(changes):
    """This process's environment without what changes mirrorball, and with PoCL alone."""
    variables = dict(os.environ)
    variables.setdefault("POCL_CACHE_DIR", KERNEL_CACHE)
    for name in ["MIRRORBALL_DEVICE", "POCL_DEVICES", "POCL_AFFINITY", "POCL_MAX_PTHREAD_COUNT",
                 "POCL_PTHREAD_MIN_THREADS", "OCL_ICD_VENDORS", "TERM", "TMUX",
                 "STY", "NO_COLOR", "CL_PLATFORM_INDEX", "CL_PLATFORM_NAME", "CL_DEVICE_INDEX", "CL_DEVICE_TYPE"]:
        variables.pop(name, None)
    if os.path.exists(POCL_DRIVER):
        variables["OCL_ICD_VENDORS"] = POCL_DRIVER
    variables.update(changes)
    return variables


class CliTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="mirrorball-test-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def run_cli(self, *arguments, env=None, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text="", **more):
        """Runs the program in the test's folder, with a text as standard input; output as text, without the
        lines of progress that it prints where the machine is slow."""
        result = subprocess.run(
            [PROGRAM, *map(str, arguments)], cwd=self.folder, stdout=stdout, stderr=stderr, input=text,
            env=clean_environment(env or {}), timeout=HANG_LIMIT, text=True, check=False, **more)
        if result.stderr and not {"-q", "--progress"} & set(arguments):
            result.stderr = PROGRESS.sub("", result.stderr)
        return result

    def succeed(self, *arguments, **more):
        """A run that must exit with 0."""
        result = self.run_cli(*arguments, **more)
        self.assertEqual(result.returncode, 0, f"{result.stdout}{result.stderr}")
        return result

    def output(self, *arguments, **more):
        """Of a run that must succeed and say nothing on stderr."""
        result = self.succeed(*arguments, **more)
        self.assertEqual(result.stderr, "")
        return result.stdout

    def run_shell(self, command, **env):
        """Runs a shell line with $MIRRORBALL and $SCENE (the single sphere) set."""
        return subprocess.run(
            ["bash", "-c", command], cwd=self.folder, capture_output=True, text=True,
            env=clean_environment(dict(env, MIRRORBALL=PROGRAM,
                                       SCENE=scene_path("single-sphere"))),
            stdin=subprocess.DEVNULL, timeout=HANG_LIMIT, check=False)

    def start(self, *arguments, env=None, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE):
        """Starts the program and leaves it running; it is killed at the end of the test."""
        process = subprocess.Popen(
            [PROGRAM, *map(str, arguments)], cwd=self.folder, text=True,
            stdin=stdin, stdout=stdout, stderr=subprocess.PIPE,
            env=clean_environment(env or {}), start_new_session=True)
        self.addCleanup(self._finish, process)
        return process

    def on_terminal(self, *arguments, env, columns=80, rows=24):
        """What a terminal of so many cells gets of the program, which is in front there and must succeed."""
        ours, theirs = pty.openpty()
        fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
        process = subprocess.Popen(
            [PROGRAM, *map(str, arguments)], cwd=self.folder, stdin=theirs, stdout=theirs, stderr=theirs,
            env=clean_environment(env), start_new_session=True,
            preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0))
        os.close(theirs)
        got = bytearray()
        with contextlib.suppress(OSError):  # the other end is closed
            while True:
                got.extend(os.read(ours, 65536))
        os.close(ours)
        self.assertEqual(process.wait(HANG_LIMIT), 0, got)
        return bytes(got).replace(b"\r\n", b"\n")

    @staticmethod
    def _finish(process):
        if process.poll() is None:
            process.send_signal(signal.SIGKILL)
        process.communicate()

    def render(self, scene, *arguments, **more):
        """A rendering that must succeed; scene is a name in scenes/ or a path."""
        path = scene_path(scene) if not os.sep in str(scene) else scene
        return self.succeed("render", path, *arguments, **more)

    def small_disk(self, options, name="disk"):
        """A small file system of its own; the test is skipped where that is not allowed."""
        if os.geteuid() != 0 or not shutil.which("mount"):
            self.skipTest("mounting a tmpfs takes root")
        place = self.folder / name
        place.mkdir()
        done = subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", place],
                              capture_output=True, text=True, timeout=HANG_LIMIT, check=False)
        if done.returncode != 0:
            self.skipTest(f"cannot mount a tmpfs: {done.stderr.strip()}")
        self.addCleanup(subprocess.run, ["umount", "-l", place], check=False, timeout=HANG_LIMIT)
        return place

    def hash_of(self, scene, *arguments, **more):
        result = self.render(scene, *arguments, **more)
        found = image_hash(result.stderr.strip().splitlines()[-1])
        self.assertIsNotNone(found, f"no image hash at the end of: {result.stderr}")
        return found

    def stats_of(self, scene, *arguments, **more):
        return json.loads(self.render(scene, "--stats=json", *arguments, **more).stdout)

    def bytes_of(self, name):
        return (self.folder / name).read_bytes()

    def write_text(self, name, text):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return str(path)

    def write_scene(self, file="scene.json", **keys):
        return self.write_text(file, json.dumps({"camera": CAMERA, **keys}))

    def pictures(self):
        """All files but journals: an interrupted render leaves one if it took over two seconds."""
        return [name for name in self.files() if not name.endswith(".mbj")]

    def files(self):
        return sorted(p.name for p in self.folder.iterdir())

    def assert_refused(self, result, code, *fragments, lines=1):
        """That exit code, that many lines on stderr naming all fragments, and no stdout."""
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertEqual(len(result.stderr.splitlines()), lines, result.stderr)
        for fragment in fragments:
            self.assertIn(fragment, result.stderr)

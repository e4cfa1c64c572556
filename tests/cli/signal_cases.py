# SPDX-License-Identifier: Apache-2.0
"""SIGINT and SIGTERM: exit 130 or 143, the picture so far saved and whole."""
import json
import os
import pathlib
import re
import select
import signal
import subprocess
import time

from harness import CliTest, scene_path
from pictures import png_texts, read_pfm, read_png
from program import HANG_LIMIT

LONG = ["--size", "900", "--aa", "grid:32", "--progress", "json"]
PATHS = {
    "threads": ["--device", "threads"],
    "pocl": ["--device", "pocl"],
    "pocl samples": ["--device", "pocl", "--launch", "sample"],
    "buffers": ["--size", "1500", "--aa", "grid:2", "--max-bounces", "400", "--device", "threads",
                "--schedule", "buffers"],
}


def long_options(path):
    """--size and --aa may be given only once."""
    own = PATHS[path]
    shared = LONG[4:] if "--size" in own else LONG
    return shared + own


class Interrupted(CliTest):
    def start_and_wait_until_tiles_are_done(self, path, output=None, *more):
        written = ["-o", output] if output else []
        process = self.start("render", scene_path("mirror-hall"), *written, *long_options(path),
                             *more)
        for line in process.stderr:
            if line.startswith("{") and json.loads(line)["fraction"] > 0:
                return process
        self.fail(f"ended before it could be interrupted: {process.wait()}")

    def stop(self, process, number):
        process.send_signal(number)
        stderr = process.communicate(timeout=HANG_LIMIT)[1]
        return process.returncode, stderr.strip().splitlines()

    def assert_stopped(self, path, number, output):
        process = self.start_and_wait_until_tiles_are_done(path, output)
        code, lines = self.stop(process, number)
        self.assertEqual(code, 128 + number, lines)
        partial = output.replace(".", ".partial.")
        message = re.search(r"after (\d+) of (\d+) tiles.*" + re.escape(partial), lines[-1])
        self.assertIsNotNone(message, lines)
        self.assertGreater(int(message[1]), 0)
        self.assertLess(int(message[1]), int(message[2]))
        self.assertEqual(self.pictures(), [partial])

    def assert_has_light_and_gaps(self, name):
        is_lit = read_pfm(self.folder / name).any(axis=2)
        self.assertTrue(is_lit.any() and not is_lit.all())

    def test_saves_what_is_finished(self):
        for path, number, output in [
                ("threads", signal.SIGINT, "out.pfm"), ("pocl", signal.SIGINT, "out.pfm"),
                ("pocl samples", signal.SIGINT, "out.pfm"), ("buffers", signal.SIGINT, "out.pfm"),
                ("threads", signal.SIGXCPU, "out.pfm"), ("threads", signal.SIGUSR1, "out.pfm"),
                ("threads", signal.SIGTERM, "out.png"), ("pocl", signal.SIGTERM, "out.png")]:
            with self.subTest(path=path, number=number):
                self.assert_stopped(path, number, output)
                if output == "out.pfm":
                    self.assert_has_light_and_gaps("out.partial.pfm")
                else:
                    texts = png_texts(self.folder / "out.partial.png")
                    self.assertRegex(texts["mirrorball:Partial"], r"^\d+ of \d+ tiles$")
                self.remove_all()

    def remove_all(self):
        for name in self.files():
            (self.folder / name).unlink()

    def interrupted(self, output):
        """The last line of a render that was interrupted."""
        code, lines = self.stop(self.start_and_wait_until_tiles_are_done("threads", output), signal.SIGINT)
        self.assertEqual(code, 130, lines)
        return lines[-1]

    def test_a_finished_picture_is_left_alone(self):
        self.write_text("out.png", "finished yesterday")
        self.interrupted("out.png")
        self.assertEqual((self.folder / "out.png").read_text(), "finished yesterday")
        self.assertEqual(self.pictures(), ["out.partial.png", "out.png"])

    def test_an_unfinished_picture_takes_the_place_of_another_and_of_nothing_else(self):
        for output in ["out.png", "out.exr", "out.pfm"]:
            partial = output.replace(".", ".partial.")
            self.write_text(partial, "mine")
            self.interrupted(output)
            self.assertEqual(self.bytes_of(partial), b"mine")
        self.remove_all()
        self.interrupted("out.png")
        first = self.bytes_of("out.partial.png")
        self.render("single-sphere", "--size", "8", "-o", "out.partial.png")
        finished = self.bytes_of("out.partial.png")
        self.interrupted("out.png")
        self.assertEqual(self.bytes_of("out.partial.png"), finished)
        for unfinished in [first, first[:-20]]:
            (self.folder / "out.partial.png").write_bytes(unfinished)
            self.assertIn("the finished part is in out.partial.png", self.interrupted("out.png"))
        self.assertEqual(self.pictures(), ["out.partial.png"])

    def test_again_where_a_format_has_no_metadata(self):
        for _ in range(2):
            process = self.start_and_wait_until_tiles_are_done("threads", "out.pfm", "--resume")
            lines = self.stop(process, signal.SIGINT)[1]
            self.assertIn("the finished part is in out.partial.pfm", lines[-1])

    def test_an_unfinished_picture_never_takes_the_place_of_an_input(self):
        self.render("single-sphere", "--size", "8", "-o", "out.partial.png")
        self.assert_refused(self.run_cli("render", scene_path("single-sphere"), "--size", "8", "-o", "out.png",
                                         "--reference", "out.partial.png"), 2, "out.partial.png")

    def test_as_terminals_and_timeout_send_it(self):
        """To the program and its worker process; to the program, and at once to its group."""
        for path in ["threads", "pocl", "pocl"]:
            for number, is_first_alone in [(signal.SIGINT, False), (signal.SIGTERM, True)]:
                process = self.start_and_wait_until_tiles_are_done(path, "out.pfm")
                if is_first_alone:
                    process.send_signal(number)
                os.killpg(process.pid, number)
                stderr = process.communicate(timeout=HANG_LIMIT)[1]
                self.assertEqual(process.returncode, 128 + number, stderr)
                self.assertEqual(self.pictures(), ["out.partial.pfm"])
                self.remove_all()

    def test_pocl_sigterm_while_its_worker_is_stopped(self):
        process = self.start_and_wait_until_tiles_are_done("pocl", "out.png")
        worker, = map(int, pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split())
        os.kill(worker, signal.SIGSTOP)
        sent = time.monotonic()
        code, lines = self.stop(process, signal.SIGTERM)
        self.assertEqual(code, 143, lines)
        self.assertLess(time.monotonic() - sent, 30)
        self.assertEqual(self.pictures(), ["out.partial.png"])

    def test_without_output_nothing_is_left(self):
        for path in ["threads", "pocl"]:
            process = self.start_and_wait_until_tiles_are_done(path)
            code, lines = self.stop(process, signal.SIGINT)
            self.assertEqual(code, 130, lines)
            self.assertRegex(lines[-1], r"interrupted \(Ctrl-C\) after \d+ of \d+ tiles$")
            self.assertEqual(self.pictures(), [])

    def start_and_wait_until_it_renders(self, *more):
        """One tile that takes minutes."""
        process = self.start("render", scene_path("glass"), "-o", "out.png", "--size", "2000",
                             "--tile", "2000", "--aa", "sobol:4096", "--device", "threads", "--lanes", "1",
                             "--progress", "json", *more)
        lines = (line for line in process.stderr if line.startswith("{"))
        if not next(lines, None) or not next(lines, None):  # before the first it may not have begun
            self.fail(f"ended before it could be interrupted: {process.wait()}")
        return process

    def next_word(self, process):
        for line in process.stderr:
            if not line.startswith("{"):
                return line
        return ""

    def test_says_at_once_that_it_stops_and_saves_nothing_of_half_a_tile(self):
        process = self.start_and_wait_until_it_renders()
        process.send_signal(signal.SIGINT)
        sent = time.monotonic()
        self.assertIn("stopping, saving what is finished; interrupt again to quit at once",
                      self.next_word(process))
        self.assertLess(time.monotonic() - sent, 20)
        stderr = process.communicate(timeout=HANG_LIMIT)[1]
        self.assertEqual(process.returncode, 130, stderr)
        self.assertRegex(stderr, r"interrupted \(Ctrl-C\) after 0 of 1 tiles\n$")
        self.assertEqual(self.pictures(), [])

    def test_a_second_signal_of_any_kind_quits_at_once(self):
        for first, second in [(signal.SIGINT, signal.SIGINT), (signal.SIGUSR1, signal.SIGTERM)]:
            process = self.start_and_wait_until_it_renders()
            process.send_signal(first)
            word = self.next_word(process)
            self.assertIn("saving what is finished", word)
            self.assertEqual("again to quit" in word, first == signal.SIGINT)
            time.sleep(0.25)  # else it is taken for an echo of the first
            process.send_signal(second)
            sent = time.monotonic()
            process.communicate(timeout=HANG_LIMIT)
            self.assertLess(time.monotonic() - sent, 20)
            self.assertEqual(process.returncode, -second)
            self.assertEqual(self.pictures(), [])

    def test_quiet_says_nothing_while_it_stops(self):
        process = self.start_and_wait_until_tiles_are_done("threads", "out.pfm", "-q")
        _, lines = self.stop(process, signal.SIGINT)
        self.assertNotIn("stopping", " ".join(lines))

    def test_finished_tiles_are_those_of_the_whole_picture(self):
        options = ["--size", "300", "--aa", "grid:32", "--device", "threads", "--tile", "20"]
        self.render("mirror-hall", *options, "-o", "whole.pfm")
        process = self.start("render", scene_path("mirror-hall"), *options, "-o", "part.pfm",
                             "--progress", "json")
        for line in process.stderr:
            if line.startswith("{") and json.loads(line)["fraction"] > 0:
                break
        self.stop(process, signal.SIGINT)
        whole, part = (read_pfm(self.folder / name) for name in ["whole.pfm", "part.partial.pfm"])
        self.assertTrue(((part == 0) | (part == whole)).all())

    def test_twice_leaves_no_half_file(self):
        process = self.start_and_wait_until_tiles_are_done("threads", "out.png")
        process.send_signal(signal.SIGINT)
        time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=HANG_LIMIT)
        self.assertIn(process.returncode, [130, -signal.SIGINT])
        for name in self.pictures():
            self.assertEqual(name, "out.partial.png")
            read_png(self.folder / name)

    def test_stats_say_incomplete(self):
        process = self.start("render", scene_path("mirror-hall"), *long_options("threads"),
                             "--stats=json")
        process.stderr.readline()
        process.send_signal(signal.SIGTERM)
        stdout = process.communicate(timeout=HANG_LIMIT)[0]
        self.assertEqual(process.returncode, 143)
        self.assertFalse(json.loads(stdout)["complete"])

    def test_out_of_time(self):
        for device in ["threads", "pocl"]:
            for seconds in [1.5, 6, 24]:  # a busy machine takes long to finish a tile
                result = self.run_cli("render", scene_path("mirror-hall"), "--size", "900", "--aa", "grid:32",
                                      "--device", device, "--timeout", seconds, "-o", "out.png")
                self.assertEqual(result.returncode, 8, result.stderr)
                if self.pictures():
                    break
            self.assertIn("out of time (--timeout) after", result.stderr)
            self.assertNotIn("again to quit", result.stderr)
            self.assertEqual(self.pictures(), ["out.partial.png"])
            self.remove_all()

    def test_out_of_time_before_it_began(self):
        result = self.run_cli("render", scene_path("mirror-hall"), "--size", "900", "--aa", "grid:32",
                              "--device", "pocl", "--timeout", "0.002", "-o", "out.png")
        self.assertEqual(result.returncode, 8, result.stderr)
        self.assertEqual(self.pictures(), [])

    def test_a_pipe_that_nobody_reads(self):
        os.mkfifo(self.folder / "out.png")
        for device in ["threads", "pocl"]:
            small = ["render", scene_path("single-sphere"), "--size", "8", "-o", "out.png",
                     "--device", device]
            result = self.run_cli(*small, "--timeout", "1")
            self.assertEqual(result.returncode, 8, result.stderr)
            self.assertIn("out of time (--timeout); nothing is saved", result.stderr)
            process = self.start(*small, "--progress", "json")
            for line in process.stderr:
                if line.startswith("{") and json.loads(line)["fraction"] == 1:
                    break
            code, lines = self.stop(process, signal.SIGTERM)
            self.assertEqual(code, -signal.SIGTERM, lines)
            self.assertEqual(lines[-1], "mirrorball: terminated (SIGTERM); nothing is saved")


class HangingDriver(CliTest):
    def test_ends_with_the_program_that_tries_it(self):
        """A library that is a pipe: loading it takes as long as the pipe is open."""
        os.mkfifo(self.folder / "driver.so")
        drivers = self.folder / "drivers"
        drivers.mkdir()
        (drivers / "x.icd").write_text(str(self.folder / "driver.so"))
        process = self.start("devices", env={"OCL_ICD_VENDORS": str(drivers)})
        with open(self.folder / "driver.so", "wb") as pipe:  # waits until the driver is being loaded
            process.terminate()
            self.assertEqual(process.wait(HANG_LIMIT), -signal.SIGTERM)
            readers = select.poll()
            readers.register(pipe, 0)
            self.assertTrue(readers.poll(5000), "on its own, it would end after 10 s")


class DoctorTest(CliTest):
    def test_a_stop_is_no_finding(self):
        """The signal reaches doctor while a process of its own tries a device."""
        for number in [signal.SIGTERM, signal.SIGUSR1]:
            with self.subTest(number=number):
                process = self.start("doctor")
                children = f"/proc/{process.pid}/task/{process.pid}/children"
                while process.poll() is None:
                    with open(children, encoding="ascii") as file:
                        lines = [self.command_of(child) for child in file.read().split()]
                    if any(b"--device" in line for line in lines):
                        break
                process.send_signal(number)
                output = process.communicate(timeout=HANG_LIMIT)[0]
                ends = -number if number == signal.SIGTERM else 128 + number
                self.assertEqual((process.returncode, output), (ends, ""))

    @staticmethod
    def command_of(process):
        try:
            with open(f"/proc/{process}/cmdline", "rb") as file:
                return file.read()
        except OSError:  # it has ended
            return b""


class StressTest(CliTest):
    def test_an_unfinished_family_has_no_verdict(self):
        process = self.start("stress", "--device", "threads", "--json", "s.json")
        text = process.stderr.readline() + process.stderr.readline()
        process.send_signal(signal.SIGINT)
        output, rest = process.communicate(timeout=HANG_LIMIT)
        begun = re.findall(r"^mirrorball: ([\w-]+), \d+ cases?$", text + rest, re.M)
        self.assertEqual(process.returncode, 130)
        result = json.loads((self.folder / "s.json").read_text())
        names = [family["name"] for family in result["families"]]
        self.assertEqual(names, begun[:-1])
        self.assertEqual((result["interrupted"], result["passed"]), (True, False))
        self.assertRegex(output, rf"STOPPED: {len(names)} of \d\d families, .*interrupted")


class SettingUp(CliTest):
    """Before there is a picture: one line says what happened and that nothing is saved."""

    def test_every_stop_signal_says_a_word(self):
        for number, reason in [(signal.SIGINT, "interrupted (Ctrl-C)"),
                               (signal.SIGTERM, "terminated"), (signal.SIGHUP, "hung up"),
                               (signal.SIGXCPU, "CPU time"), (signal.SIGUSR1, "asked to stop")]:
            with self.subTest(number=number):
                process = self.start("render", "-", "-o", "out.png", stdin=subprocess.PIPE)
                process.stdin.write(" " * 1000000)  # more than a pipe holds: it is being read
                process.send_signal(number)
                process.wait(HANG_LIMIT)
                lines = process.stderr.read().splitlines()
                self.assertEqual(len(lines), 1, lines)
                self.assertIn(reason, lines[0])
                self.assertIn("nothing is saved", lines[0])
                self.assertIn(process.returncode, [-number, 128 + number])
                self.assertEqual(self.files(), [])


class Ignored(CliTest):
    def test_signal_that_the_caller_ignores_stays_ignored(self):
        """As in `nohup` or a script's background job."""
        line = ("trap '' INT; $MIRRORBALL render $SCENE --size 200 --aa grid:12 --device threads & "
                "sleep 0.2; kill -INT $!; wait $!")
        self.assertEqual(self.run_shell(line).returncode, 0)

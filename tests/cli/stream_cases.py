# SPDX-License-Identifier: Apache-2.0
"""stdout and stderr: what goes where, progress, and streams that are closed or full."""
import json

from harness import SHIM, CliTest, scene_path

LONG = ["--size", "2000", "--aa", "grid:8", "--device", "threads", "-o", "out.pfm"]


class Summary(CliTest):
    def test_is_on_stderr_alone(self):
        result = self.render("single-sphere", "--size", "8", "-o", "out.png")
        self.assertEqual(result.stdout, "")
        self.assertEqual(len(result.stderr.splitlines()), 1)
        self.assertRegex(result.stderr,
                         r"^single-sphere: 8x8 grid:2 float on .* image [0-9a-f]{16}$")

    def test_a_picture_that_is_not_saved(self):
        lines = self.render("single-sphere", "--size", "8").stderr.splitlines()
        self.assertEqual(len(lines), 2)
        self.assertIn("-o", lines[0])
        self.assertIn("not saved", lines[0])
        self.assertEqual(self.render("single-sphere", "--size", "8", "-v").stdout, "")
        result = self.render("single-sphere", "--size", "8", "-q")
        self.assertEqual((result.stdout, result.stderr), ("", ""))
        for more in [["-o", "out.png"], ["--stats=json"]]:
            result = self.render("single-sphere", "--size", "8", *more)
            self.assertNotIn("not saved", result.stderr)


class Progress(CliTest):
    def first_lines(self, *options, count=2, env=None):
        process = self.start("render", scene_path("mirror-hall"), *LONG, *options, env=env)
        lines = [process.stderr.readline() for _ in range(count)]
        process.kill()
        return lines

    A_SECOND_OR_SO = ["--size", "500", "--device", "threads:1", "--aa", "grid:12"]

    def stderr_of(self, options=A_SECOND_OR_SO, columns=0, **env):
        """What a rendering writes to a terminal."""
        return self.on_terminal("render", scene_path("mirror-hall"), *options, env=env, columns=columns).decode()

    def test_bar_on_a_terminal(self):
        text = self.stderr_of(TERM="xterm")
        self.assertRegex(text, r"\r\[#*\.*\] +\d+ %  [\d.]+ Mrays/s  ETA \d+:\d\d")
        self.assertRegex(text, r"\] 100 %.*\n.*image [0-9a-f]{16}\n$")

    def test_bar_fits_its_terminal(self):
        for columns in [20, 60]:
            lines = self.stderr_of(columns=columns, TERM="xterm").split("\r")
            bars = [line for line in lines if " %  " in line and "image" not in line]
            self.assertTrue(bars)
            for line in bars:
                self.assertLess(len(line.rstrip("\n")), columns, line)
            self.assertEqual("[" in bars[0], columns >= 40)

    def test_a_terminal_learns_which_device_compiles(self):
        options = ["--size", "8", "--device", "pocl"]
        self.assertIn(": opening, compiling new kernels", self.stderr_of(options, TERM="xterm"))
        result = self.run_cli("render", scene_path("mirror-hall"), *options)
        self.assertNotIn("compiling", result.stderr)

    def test_no_bar_on_a_dumb_terminal(self):
        self.assertNotIn("[", self.stderr_of(TERM="dumb"))

    def test_json_lines_parse(self):
        result = self.render("mirror-hall", "--size", "200", "--progress", "json")
        lines = [json.loads(line) for line in result.stderr.splitlines() if line[0] == "{"]
        self.assertTrue(lines)
        for line in lines:
            self.assertEqual(set(line), {"fraction", "seconds", "rays"})
        self.assertEqual(lines[-1]["fraction"], 1)

    def test_json_grows(self):
        first, second = map(json.loads, self.first_lines("--progress", "json"))
        self.assertLess(first["seconds"], second["seconds"])
        self.assertLessEqual(first["fraction"], second["fraction"])
        self.assertGreater(second["rays"], 0)

    def test_plain_in_a_pipe(self):
        line = self.first_lines(count=1, env={"TERM": "xterm-256color"})[0]
        self.assertRegex(line, r"^ *\d+ %  [\d.]+ Mrays/s  ETA \d+:\d\d\n$")

    def test_bar_has_no_escape_codes(self):
        result = self.render("mirror-hall", "--size", "400", "--progress", "bar")
        self.assertNotIn("\x1b", result.stderr)

    def test_no_bar_for_a_short_picture(self):
        for _ in range(100):  # a busy machine may take long
            result = self.render("empty", "--size", "4", "--progress", "bar", "--stats=json")
            if json.loads(result.stdout)["seconds"]["total"] < 0.1:
                break
        self.assertEqual(result.stderr, "")

    def test_none(self):
        result = self.render("mirror-hall", "--size", "300", "--progress", "none", "-o", "out.png")
        self.assertEqual(len(result.stderr.splitlines()), 1)


class Lost(CliTest):
    """Streams that take nothing: never a crash, and exit 4 when a result was lost."""

    RESULTS = ["devices", "devices --json", "--version", "render --help", "scene info $SCENE",
               "scene check $SCENE", "render $SCENE --size 8 --stats",
               "render $SCENE --size 8 --stats=json"]

    def test_stdout_to_a_broken_pipe(self):
        for command in self.RESULTS:
            with self.subTest(command=command):
                line = f"$MIRRORBALL {command} | head -c 0; exit ${{PIPESTATUS[0]}}"
                self.assertIn(self.run_shell(line).returncode, [0, 4])

    def test_closed_stdout_is_an_error(self):
        for command in [*self.RESULTS, "render $SCENE --size 8 -o -"]:
            with self.subTest(command=command):
                result = self.run_shell(f"$MIRRORBALL {command} >&-")
                self.assertEqual(result.returncode, 4, result.stderr)

    def test_full_stdout_is_an_error(self):
        for command in self.RESULTS:
            with self.subTest(command=command):
                result = self.run_shell(f"$MIRRORBALL {command} > /dev/full")
                self.assertEqual(result.returncode, 4, result.stderr)
                self.assertEqual(len(result.stderr.splitlines()), 1)

    def test_stderr_closed_full_or_a_broken_pipe(self):
        for end in ["2>&-", "2>/dev/full", "2>&1 >/dev/null | head -c 0"]:
            with self.subTest(end=end):
                line = (f"$MIRRORBALL render $SCENE --size 200 --progress json -o out.png {end}; "
                        "exit ${PIPESTATUS[0]}")
                self.assertEqual(self.run_shell(line).returncode, 0)
                self.assertEqual(self.files(), ["out.png"])

    def test_error_with_stderr_closed_keeps_its_exit_code(self):
        for end in ["2>&-", "2>/dev/full"]:
            with self.subTest(end=end):
                self.assertEqual(self.run_shell(f"$MIRRORBALL render no.json {end}").returncode, 3)

    def test_all_streams_closed(self):
        line = "$MIRRORBALL render $SCENE --size 8 --device threads -o out.pfm <&- >&- 2>&-"
        self.assertEqual(self.run_shell(line).returncode, 0)
        size = (self.folder / "out.pfm").stat().st_size
        self.assertEqual(size, len("PF\n8 8\n-1.0\n") + 12 * 64)

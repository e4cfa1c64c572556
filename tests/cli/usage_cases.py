# SPDX-License-Identifier: Apache-2.0
"""Wrong command lines: exit 2 (7 for sizes beyond the limit), one line that names the option."""
from harness import CliTest, scene_path


class Help(CliTest):
    def test_version(self):
        self.assertRegex(self.succeed("--version").stdout, r"^mirrorball \d+\.\d+\.\d+ \(.+\)\n$")

    def test_lists_verbs_and_options(self):
        """shell_cases compares all options with the manual."""
        for verb, words in [([], ["render", "devices", "scene"]), (["devices"], ["--json"]),
                            (["scene"], ["info", "check"]), (["scene", "info"], ["SCENE", "--json"]),
                            (["render"], ["--device", "--size", "--aa", "--output"])]:
            text = self.output(*verb, "--help")
            for word in words:
                self.assertIn(word, text)


class WrongCommand(CliTest):
    def test_is_refused(self):
        for words, says in [([], ["a verb is required", "--help"]), (["rendr"], ["rendr"]), (["render"], ["SCENE"]),
                            (["scene"], ["a verb is required", "scene --help"]),
                            (["devices", "a", "b"], ["unexpected argument 'a'", "devices --help"])]:
            self.assert_refused(self.run_cli(*words), 2, *says)


class WrongOption(CliTest):
    def assert_option_refused(self, *arguments, code=2, says=()):
        result = self.run_cli("render", scene_path("single-sphere"), "-o", "out.png", *arguments)
        self.assert_refused(result, code, arguments[0].split("=")[0], *says)
        self.assertEqual(self.files(), [])

    GARBAGE = [
        ("--size", 2, "640x480", ["8x", "x8", "8x8x8", "eight", "8 x 8", "", "1e3", "8,8", "+8"]),
        ("--size", 2, "1 pixel", ["0", "0x8", "8x0", "-5"]),
        ("--size", 7, "65536", ["65537", "65537x1", "65536x65536", "16385x16384", "99999999999"]),
        ("--tile", 2, "1 pixel", ["0"]),
        ("--light-scale", 2, "0.5", ["half", "-1", "1,1,1", "1e31", "nan", "1x"]),
        ("--ambient", 2, "R,G,B", ["gray", "-1", "1,1", "1,1,1,1", "1,1,-1", "inf", "1,,1"]),
        ("--aa", 2, "grid:N", ["grid", "grid:", "grid:0", "grid:65", "grid:2x2", "nothing", "grid:-1"]),
        ("--crop", 2, "x0,y0,x1,y1", ["1,2,3", "0,0,0,5", "5,0,4,5", "-1,0,5,5", "a,b,c,d", "0,0,5,5,"]),
        ("--crop", 2, "240x180", ["0,0,241,1", "240,0,241,1", "0,180,1,181", "0,0,2147483647,2147483647"]),
        ("--threads", 2, "4096", ["0", "-1", "4097", "many"]),
        ("--max-bounces", 2, "100000", ["-1", "100001", "1.5", "lots", "99999999999"]),
    ]

    def test_garbage(self):
        for option, code, says, values in self.GARBAGE:
            for value in values:
                words = [f"{option}={value}"] if value.startswith("-") else [option, value]
                with self.subTest(option=option, value=value):
                    self.assert_option_refused(*words, code=code, says=[says])

    def test_others(self):
        for words, says in [(["--color"], ""), (["--check", "5%", "--math", "fast"], "--math strict"),
                            (["--stats=xml"], "json"), (["--quiet=x"], "takes no value"),
                            (["--size", "8", "--size", "9"], "given twice"),
                            (["--size"], ""), (["--device"], ""), (["--crop"], ""), (["-o=x.png"], "an '=' too many"),
                            *(([option, "rubbish"], "rubbish")
                              for option in ["--precision", "--math", "--launch", "--schedule", "--features",
                                             "--progress", "--encoding"])]:
            with self.subTest(words=words):
                self.assert_option_refused(*words, says=[says])
        self.assert_refused(self.run_cli("devices", "--json=x"), 2, "'--json' takes no value")

    def test_an_empty_name_is_no_name(self):
        """As from a script whose variable is unset."""
        for option in ["--reference", "--batch", "--device"]:
            with self.subTest(option=option):
                self.assert_option_refused(option, "")
        for verb, option in [("report", "--plots"), ("stress", "-o")]:
            self.assert_refused(self.run_cli(verb, *["x"] * (verb != "stress"), option, ""), 2,
                                option, "expected a name")

    def test_results_of_a_list_of_cases(self):
        for more in [["--json"], ["-o", "folder"]]:
            self.assert_refused(self.run_cli("stress", "--list", *more), 2, "--list", "--json")


class Guess(CliTest):
    def test_mistyped_verb(self):
        for verb, meant in [("rendr", "render"), ("devcies", "devices"), ("benhc", "bench"),
                            ("conv", "converge")]:
            self.assert_refused(self.run_cli(verb), 2, verb, f"did you mean '{meant}'?")

    def test_mistyped_option(self):
        for option, meant in [("--sise", "--size"), ("--presicion", "--precision"),
                              ("--outptu", "--output"), ("--hierarch", "--hierarchies")]:
            for value in [[f"{option}=8"], [option, "8"]]:
                result = self.run_cli("render", scene_path("empty"), *value)
                self.assert_refused(result, 2, f"'{option}'", f"did you mean '{meant}'?")

    def test_mistyped_choice(self):
        for option, value, meant in [("--filter", "gausian", "gaussian"), ("--math", "strickt", "strict"),
                                     ("--encoding", "sRGB", "srgb"), ("--aov", "dpeth", "depth"),
                                     ("--features", "mirors", "mirrors"), ("--stats=jsno", "", "json")]:
            with self.subTest(option=option):
                result = self.run_cli("render", scene_path("empty"), option, *[value] * bool(value))
                self.assert_refused(result, 2, option.split("=")[0], f"did you mean '{meant}'?")

    def test_nothing_near_gives_no_guess(self):
        for words in [["frobnicate"], ["render", scene_path("empty"), "--frobnicate"]]:
            result = self.run_cli(*words)
            self.assert_refused(result, 2, "frobnicate")
            self.assertNotIn("did you mean", result.stderr)

    def test_hint_names_the_verb(self):
        for verb in [["render"], ["bench"], ["scene", "info"]]:
            result = self.run_cli(*verb, "--frobnicate")
            self.assert_refused(result, 2, f"'mirrorball {' '.join(verb)} --help'")
            self.assertNotIn("VERB", result.stderr)


class OptionalValues(CliTest):
    """Options that may stand alone take a value with and without "=", and never the scene."""

    def assert_json(self, text):
        self.assertEqual(text.lstrip()[0], "{", text)

    def test_stats_json(self):
        scene = scene_path("empty")
        for words in [["--stats", "json", scene], [scene, "--stats", "json"],
                      [scene, "--stats=json"], ["--stats=json", scene]]:
            self.assert_json(self.succeed("render", *words, "--size", "4", "-q").stdout)

    def test_stats_alone_leaves_the_scene(self):
        for words in [["--stats", scene_path("empty")], ["--stats", "text", scene_path("empty")]]:
            self.assertIn("ray trace", self.succeed("render", *words, "--size", "4").stdout)

    BENCH = ["bench", "--sizes", "8", "--aa", "none", "--devices", "threads:1", "--precision",
             "float", "--repeats", "1", "-q"]

    def test_json_file(self):
        scene = scene_path("empty")
        for words in [["--json", "out.json", scene], [scene, "--json", "out.json"],
                      [scene, "--json=out.json"]]:
            for turn in ["new", "replaced"]:
                with self.subTest(words=words, turn=turn):
                    result = self.succeed(*self.BENCH, *words)
                    self.assert_json((self.folder / "out.json").read_text())
                    self.assertNotIn("{", result.stdout)
            (self.folder / "out.json").unlink()

    def test_json_alone_leaves_the_scene(self):
        scene = self.write_scene()
        before = (self.folder / "scene.json").read_text()
        for words in [["--json", scene], ["--json", "-", scene], [scene, "--json"]]:
            self.assert_json(self.succeed(*self.BENCH, *words).stdout)
        self.assertEqual((self.folder / "scene.json").read_text(), before)

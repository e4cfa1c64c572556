# SPDX-License-Identifier: Apache-2.0
"""Journals: renders that were interrupted go on, and shares of a picture are merged to the whole."""
import random
import signal
import struct
import time
import zlib

from harness import CliTest, scene_path

SMALL = ["--size", "90x70", "--device", "threads"]


class JournalTest(CliTest):
    def share(self, shares, part, *arguments, scene="cornell-box", expected=0):
        result = self.run_cli("render", scene_path(scene), "--shard", shares, "-o", part,
                              *arguments)
        self.assertEqual(result.returncode, expected, result.stderr)
        return result

    def merge(self, *arguments, expected=0):
        result = self.run_cli("merge", *arguments)
        self.assertEqual(result.returncode, expected, result.stderr)
        return result


class Shares(JournalTest):
    def assert_merges(self, count, *arguments, ending):
        self.render("cornell-box", "-o", f"whole.{ending}", *SMALL, *arguments)
        parts = [f"{count}-{i}.mbj" for i in range(count)]
        for i, part in enumerate(parts):
            self.share(f"{i}/{count}", part, *SMALL, *arguments)
        random.shuffle(parts)
        result = self.merge(*parts, "-o", f"merged.{ending}")
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertEqual(self.bytes_of(f"merged.{ending}"), self.bytes_of(f"whole.{ending}"))
        for part in parts:
            (self.folder / part).unlink()

    def test_of_filters_of_a_window_and_in_every_format(self):
        """host_journal_test has all modes and counts."""
        for count, ending, options in [(2, "png", ["--aa", "sobol:8", "--filter", "gaussian"]),
                                       (3, "pfm", ["--aa", "grid:4", "--filter", "mitchell"]),
                                       (4, "exr", ["--crop", "7,9,83,61", "--aa", "adaptive:0.05"])]:
            with self.subTest(options=options):
                self.assert_merges(count, *options, ending=ending)

    def test_of_which_one_is_whole_are_its_picture(self):
        for name in ["whole.pfm", "whole.png"]:
            self.run_cli("render", scene_path("cornell-box"), *SMALL, "-o", name)
        self.merge("whole.pfm", "-o", "again.png", "-q")
        result = self.run_cli("compare", "again.png", "whole.png", "--max-abs", "0")
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assert_refused(self.run_cli("merge", "missing.pfm", "-o", "none.png"), 3, "missing.pfm")

    def test_fit_together_whatever_finds_their_hits(self):
        self.run_cli("render", scene_path("mirror-hall"), *SMALL, "-o", "whole.pfm")
        self.share("0/2", "a.mbj", *SMALL, "--hierarchies", "on", scene="mirror-hall")
        self.share("1/2", "b.mbj", *SMALL, "--hierarchies", "off", scene="mirror-hall")
        self.merge("a.mbj", "b.mbj", "-o", "merged.pfm")
        self.assertEqual(self.bytes_of("merged.pfm"), self.bytes_of("whole.pfm"))

    def with_wrong_pixels(self, part):
        """Writes wrong.mbj: that part from a device that gets every pixel wrong."""
        whole, changed, at = self.bytes_of(part), self.bytes_of(part)[:8], 8
        while at < len(whole):
            kind, size, _ = struct.unpack_from("<III", whole, at)
            body = bytearray(whole[at + 12:at + 12 + size])
            if kind == 3:
                for value in range(16, size, 4):
                    body[value] ^= 1
            head = struct.pack("<II", kind, size)
            changed += head + struct.pack("<I", zlib.crc32(head + body)) + body
            at += 12 + size
        (self.folder / "wrong.mbj").write_bytes(changed)

    def test_of_which_one_is_wrong_are_found_by_a_share_rendered_again(self):
        self.share("0-1/2", "a.mbj", *SMALL)
        self.with_wrong_pixels("a.mbj")
        self.share("17/40", "again.mbj", *SMALL)
        result = self.merge("wrong.mbj", "again.mbj", "-o", "out.png", expected=1)
        self.assertIn("wrong.mbj (", result.stderr)
        self.assertNotIn("out.png", self.files())
        self.merge("a.mbj", "again.mbj")

    def test_from_several_devices(self):
        self.render("cornell-box", "-o", "whole.png", *SMALL)
        self.share("0/2", "a.mbj", "--size", "90x70", "--device", "pocl")
        self.share("1/2", "b.mbj", "--size", "90x70", "--device", "pocl,threads")
        self.share("0-1/2", "c.mbj", *SMALL)
        self.merge("c.mbj", "b.mbj", "a.mbj", "-o", "merged.png")
        self.assertEqual(self.bytes_of("merged.png"), self.bytes_of("whole.png"))

    def test_that_are_missing_are_named(self):
        for shares in ["0/9", "2/9", "4-8/9"]:
            self.share(shares, shares.replace("/", "-") + ".mbj", *SMALL)
        parts = [name for name in self.files() if name.endswith(".mbj")]
        result = self.merge(*parts, "-o", "out.png", expected=8)
        self.assertRegex(result.stderr, r"^mirrorball: \d+ pixels are missing; render --shard 1,3/9$")
        self.assertNotIn("out.png", self.files())
        result = self.merge(*parts, "-o", "out.png", "--allow-missing")
        self.assertIn("out.png", self.files())
        self.share("1,3/9", "rest.mbj", *SMALL)
        self.merge(*parts, "rest.mbj", "-o", "out.png")
        self.render("cornell-box", "-o", "whole.png", *SMALL)
        self.assertEqual(self.bytes_of("out.png"), self.bytes_of("whole.png"))

    def test_without_a_header_count_as_missing(self):
        self.share("0/2", "a.mbj", *SMALL)
        whole = self.bytes_of("a.mbj")
        for part in [whole[:0], whole[:5], whole[:8], whole[:100]]:
            (self.folder / "cut.mbj").write_bytes(part)
            result = self.merge("cut.mbj", "a.mbj", expected=8)
            self.assertIn("cut.mbj: ", result.stderr)
            self.assertIn("render --shard 1/2\n", result.stderr)
            self.merge("a.mbj", "cut.mbj", "--allow-missing", "-o", "out.png")
            self.assert_refused(self.run_cli("merge", "cut.mbj"), 3, "cut.mbj: ")

    def test_that_are_there_are_not_rendered_again(self):
        self.share("0/2", "a.mbj", *SMALL)
        before = self.bytes_of("a.mbj")
        result = self.share("0/2", "a.mbj", *SMALL)
        self.assertIn("resuming from a.mbj", result.stderr)
        self.assertIn("0.00 Mrays", result.stderr)
        self.assertEqual(self.bytes_of("a.mbj"), before)

    def test_do_not_replace_others(self):
        self.share("0/2", "a.mbj", *SMALL)
        before = self.bytes_of("a.mbj")
        result = self.share("1/2", "a.mbj", *SMALL, expected=4)
        self.assertIn("--fresh", result.stderr)
        self.assertEqual(self.bytes_of("a.mbj"), before)
        self.share("1/2", "a.mbj", *SMALL, "--fresh")
        self.assertNotEqual(self.bytes_of("a.mbj"), before)
        self.write_text("thesis.mbj", "precious")
        self.share("1/2", "thesis.mbj", *SMALL, "--fresh", expected=4)
        self.assertEqual(self.bytes_of("thesis.mbj"), b"precious")

    def test_are_refused_where_they_make_no_sense(self):
        scene = scene_path("cornell-box")
        for arguments in [["--shard", "2/2", "-o", "a.mbj"], ["--shard", "x", "-o", "a.mbj"],
                          ["--shard", "0/2", "-o", "a.png"], ["--shard", "0/2"],
                          ["--shard", "0/2", "-o", "a.mbj", "--math", "fast"],
                          ["--shard", "0/2", "-o", "a.mbj", "--schedule", "buffers", "--device",
                           "threads"], ["--fresh", "--resume", "-o", "a.png"], ["--resume"], ["--resume", "-o", "-"],
                          ["--shard", "0/2", "-o", "a.mbj", scene]]:
            self.assert_refused(self.run_cli("render", scene, *arguments), 2)
        self.assert_refused(self.run_cli("render", scene, "--shard", "0/2", "-o", "no/a.mbj"), 4)
        self.assertEqual(self.files(), [])

    def test_parts_that_are_none_are_refused(self):
        self.share("0/2", "a.mbj", *SMALL)
        self.share("1/2", "b.mbj", *SMALL, "--aa", "none")
        self.share("1/2", "c.mbj", *SMALL, scene="glass")
        self.share("1/2", "d.mbj", *SMALL, "--ambient", "0.5")
        self.write_text("text.mbj", "no journal")
        for part, words in [("b.mbj", "part of the same picture as a.mbj: the settings differ"),
                            ("c.mbj", "the scene differs"), ("d.mbj", "the scene differs"),
                            ("text.mbj", "is not a journal"),
                            ("nowhere.mbj", "cannot read"), (".", "directory")]:
            self.assert_refused(self.run_cli("merge", "a.mbj", part, "-o", "x.png"), 3, part, words)
        self.assert_refused(self.run_cli("merge", "a.mbj", "-o", "a.mbj"), 2)
        self.assert_refused(self.run_cli("merge"), 2)


class Resume(JournalTest):
    def records(self, journal):
        """How many whole records it has; the first is its header."""
        data = journal.read_bytes() if journal.exists() else b""
        count, at = 0, 8
        while at + 12 <= len(data):
            at += 12 + struct.unpack_from("<I", data, at + 4)[0]
            count += at <= len(data)
        return count

    def interrupted(self, number, *arguments):
        """Starts a render and ends it when its journal has more."""
        journal = self.folder / "out.png.mbj"
        before = self.records(journal)
        process = self.start("render", *arguments, "-o", "out.png", "--resume")
        while process.poll() is None and self.records(journal) <= max(before, 1):
            time.sleep(0.05)
        self.assertIsNone(process.poll(), "was too fast to be interrupted")
        process.send_signal(number)
        return process.wait(), process.stderr.read()

    def test_goes_on(self):
        hall = [scene_path("mirror-hall"), "--size", "300", "--aa", "grid:24"]
        adaptive = [scene_path("mirror-hall"), "--size", "400", "--aa", "adaptive:0.0001", "--precision", "double"]
        for whole, picture in ("hall.png", hall), ("adaptive.png", adaptive):
            self.succeed("render", *picture, "--device", "threads", "-o", whole)
        for number, whole, picture, device in [(signal.SIGKILL, "hall.png", hall, ["threads:1"]),
                                               (signal.SIGTERM, "hall.png", hall, ["pocl", "--threads", "1"]),
                                               (signal.SIGKILL, "adaptive.png", adaptive, ["threads:1"])]:
            with self.subTest(picture=picture, device=device):
                code, stderr = self.interrupted(number, *picture, "--device", *device)
                if number != signal.SIGKILL:
                    self.assertEqual(code, 128 + number)
                    self.assertIn("the same command resumes from there", stderr)
                result = self.succeed("render", *picture, "--device", *device, "-o", "out.png")
                self.assertRegex(result.stderr, r"resuming from out\.png\.mbj, which has [1-9]\d* %")
                self.assertEqual(self.bytes_of("out.png"), self.bytes_of(whole))
                self.assertNotIn("out.png.mbj", self.files())

    def test_a_full_disk_costs_the_journal_alone(self):
        result = self.run_shell('ulimit -f 40; "$MIRRORBALL" render "$SCENE" --size 300 --aa '
                                'grid:64 --device threads:1 --resume -o out.png')
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stderr, r"out\.png\.mbj: cannot write: .*; no more tiles are saved")
        self.assertEqual(self.files(), ["out.png"])
        result = self.run_shell('ulimit -f 1; "$MIRRORBALL" render "$SCENE" --size 300 '
                                '--device threads --shard 0/2 -o part.mbj')
        self.assertEqual(result.returncode, 4, result.stderr)

    def test_two_processes_that_start_together(self):
        arguments = [scene_path("mirror-hall"), "--size", "400", "--aa", "grid:64",
                     "--device", "threads:1", "-o", "out.mbj", "--shard", "0/2"]
        both = [self.start("render", *arguments) for _ in range(2)]
        while all(process.poll() is None for process in both):
            time.sleep(0.05)
        first, second = sorted(both, key=lambda process: process.poll() is not None)
        self.assertIsNone(first.poll())
        first.kill()
        stderr = second.stderr.read()
        self.assertEqual(second.returncode, 4, stderr)
        self.assertIn("another process is rendering", stderr)

    def test_stays_for_its_picture_and_goes_with_it(self):
        """So does the unfinished picture, and --fresh does not read the journal."""
        hall = [scene_path("mirror-hall"), "--size", "300", "--aa", "grid:24"]
        self.interrupted(signal.SIGTERM, *hall, "--device", "threads:1")
        journal = self.bytes_of("out.png.mbj")
        result = self.render("mirror-hall", "--size", "30", "-o", "out.png")
        self.assertIn("belongs to a different picture", result.stderr)
        self.assertEqual(self.bytes_of("out.png.mbj"), journal)
        self.assertIn("out.partial.png", self.files())
        result = self.succeed("render", *hall, "--device", "threads", "--fresh", "-o", "out.png")
        self.assertNotIn("resuming from", result.stderr)
        self.assertEqual(self.files(), ["out.png"])

    def test_of_which_the_start_is_damaged_starts_over(self):
        self.share("0/2", "part.mbj", *SMALL)
        whole = self.bytes_of("part.mbj")
        for length in [8, 100]:
            (self.folder / "part.mbj").write_bytes(whole[:length])
            self.assertIn("its start is damaged; starting over", self.share("0/2", "part.mbj", *SMALL).stderr)
            self.assertGreaterEqual(len(self.bytes_of("part.mbj")), len(whole) - 100)

    def test_that_ends_in_the_middle_of_a_tile(self):
        self.share("0/1", "out.png.mbj", *SMALL)
        (self.folder / "out.png.mbj").write_bytes(self.bytes_of("out.png.mbj")[:-20])
        result = self.render("cornell-box", "-o", "out.png", *SMALL)
        self.assertRegex(result.stderr, r"resuming .*; ignored its damaged end \(\d+ bytes\)")

    def test_stays_when_the_disk_is_full(self):
        place = self.small_disk("size=1500k")
        render = ["render", scene_path("single-sphere"), "--size", "300", "--device", "threads"]
        self.share("0/1", place / "out.pfm.mbj", *render[2:], scene="single-sphere")
        journal = (place / "out.pfm.mbj").read_bytes()
        self.assert_refused(self.run_cli(*render, "-o", place / "out.pfm"), 4, "out.pfm", "space", lines=2)
        self.assertEqual([file.name for file in place.iterdir()], ["out.pfm.mbj"])
        self.assertEqual((place / "out.pfm.mbj").read_bytes(), journal)
        (self.folder / "out.pfm.mbj").write_bytes(journal)
        self.assertIn("100 % of the picture", self.succeed(*render, "--resume", "-o", "out.pfm").stderr)

    def test_fresh_leaves_that_of_another_picture(self):
        self.share("0/1", "out.png.mbj", *SMALL)
        before = self.bytes_of("out.png.mbj")
        for device in ["threads", "pocl"]:
            self.render("single-sphere", "--size", "8", "--device", device, "--fresh", "-o", "out.png")
            self.assertEqual(self.bytes_of("out.png.mbj"), before)
        self.render("cornell-box", *SMALL[:2], "--device", "pocl", "--fresh", "-o", "out.png")
        self.assertEqual(self.files(), ["out.png"])

    def test_stats_tell(self):
        self.share("0/1", "out.png.mbj", *SMALL)
        stats = self.stats_of("cornell-box", "-o", "out.png", *SMALL)
        self.assertEqual(stats["resumed"], 1)
        self.share("0/1", "out.png.mbj", *SMALL)
        text = self.render("cornell-box", "-o", "out.png", *SMALL, "--stats").stdout
        self.assertIn("100 % of the picture from a journal", text)

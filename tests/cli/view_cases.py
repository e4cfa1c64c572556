# SPDX-License-Identifier: Apache-2.0
"""The picture while it is rendered: in the terminal, and in tev. Decoders written for these tests
look at what the program sends."""
import ctypes.util
import pathlib
import re
import signal
import socket
import struct
import threading
import time
import unittest

import numpy

from harness import CliTest, scene_path
from pictures import read_pfm, read_png
from program import HANG_LIMIT

UTF8 = {"TERM": "xterm-256color", "LC_ALL": "C.UTF-8"}
BLOCK = "▀".encode()
TAKES_A_WHILE = ["--size", "300", "--aa", "grid:8", "--lanes", "1", "--tile", "30"]


def decoded_half_blocks(frame):
    """Lines of half blocks in 24-bit colors, the last time they are drawn, as rows of RGB."""
    rows = []
    for line in re.split(rb"\x1b\[\d+A\r", frame)[-1].decode().split("\n"):
        if "▀" not in line:
            continue
        upper, lower, front, back = [], [], None, None
        for code, blocks in re.findall(r"\x1b\[([\d;]*)m(▀*)", line):
            numbers = [int(n) for n in code.split(";")]
            if numbers[:2] == [38, 2]:
                front, back = numbers[2:5], numbers[7:10]
            upper += front * len(blocks) if blocks else []
            lower += back * len(blocks) if blocks and back else []
        rows += [upper, lower] if lower else [upper]
    return numpy.array(rows).reshape(len(rows), -1, 3)


class Preview(CliTest):
    def preview(self, *arguments, env=None, device="threads", **terminal):
        return self.on_terminal("render", scene_path("cornell-box"), "--device", device, "-o", "out.png",
                                *arguments, env=UTF8 if env is None else env, **terminal)

    def assert_shows_the_saved_picture(self, text):
        self.assertEqual(decoded_half_blocks(text).tolist(), read_png(self.folder / "out.png").tolist())

    def test_half_blocks_are_the_pixels(self):
        for size in ["20x10", "7x5"]:
            self.assert_shows_the_saved_picture(self.preview("--preview", "--size", size))

    def test_a_large_picture_is_shrunk_to_the_terminal(self):
        text = self.preview("--preview", "--size", "100", columns=50, rows=12)
        means = read_png(self.folder / "out.png").reshape(20, 5, 20, 5, 3).mean(axis=(1, 3))
        for x, y in [(0, 0), (7, 12), (19, 19)]:
            self.assertLessEqual(abs(decoded_half_blocks(text)[y, x] - means[y, x]).max(), 1)

    def test_it_is_drawn_again_at_the_same_place_as_tiles_finish(self):
        text = self.preview("--preview", *TAKES_A_WHILE, rows=12)
        frames = text.split(b"\x1b[10A\r")
        self.assertGreater(len(frames), 2)
        first, last = (decoded_half_blocks(frame) for frame in (frames[0], frames[-1]))
        self.assertGreater((first == 0).sum(), (last == 0).sum())
        self.assertNotIn(b"%", text)  # no bar over it

    def test_none_in_a_pipe_and_on_terminals_that_cannot(self):
        result = self.render("single-sphere", "--size", "8", "--preview", env=UTF8)
        self.assertIn("no preview", result.stderr)
        self.assertNotIn("\x1b", result.stderr + result.stdout)
        for change in [{"TERM": "dumb"}, {"NO_COLOR": "1"}, {"LC_ALL": "C"}]:
            text = self.preview("--preview", "--size", "8", env=dict(UTF8, **change))
            self.assertIn(b"no preview", text)
            self.assertNotIn(BLOCK, text)

    def test_a_worker_process_draws_too(self):
        self.assert_shows_the_saved_picture(self.preview("--preview", "--size", "8", device="pocl"))


class TevServer:
    """Reads packets as tev's Ipc.cpp does."""

    def __init__(self, reads=True, slowly=False):
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        self.reads, self.slowly, self.data = reads, slowly, bytearray()
        self.created, self.updates, self.pixels = [], 0, {}
        self.thread = threading.Thread(target=self.serve, daemon=True)
        self.thread.start()

    def serve(self):
        self.connection, _ = self.listener.accept()
        if not self.reads:
            return
        while self.slowly and (read := self.connection.recv(100000)):
            self.data += read
            time.sleep(0.05)
        with self.connection.makefile("rb") as stream:
            while length := stream.read(4):
                packet = stream.read(struct.unpack("<I", length)[0] - 4)
                {4: self.create, 6: self.update}[packet[0]](packet[2:])

    def wait_for_more(self):
        before = len(self.data)
        while len(self.data) < before + 500000 and self.thread.is_alive():
            time.sleep(0.05)

    @staticmethod
    def texts(data, count):
        parts = data.split(b"\0", count)
        return [part.decode() for part in parts[:count]], parts[count]

    def create(self, data):
        (name,), data = self.texts(data, 1)
        width, height, channels = struct.unpack_from("<3i", data)
        names, rest = self.texts(data[12:], channels)
        assert not rest and names == ["R", "G", "B"], data
        self.created.append((name, width, height))
        self.pixels = {}

    def update(self, data):
        (name,), data = self.texts(data, 1)
        assert name == self.created[-1][0]
        (channels,) = struct.unpack_from("<i", data)
        _, data = self.texts(data[4:], channels)
        x, y, width, height = struct.unpack_from("<4i", data)
        offsets, strides = struct.unpack_from("<3q", data, 16), struct.unpack_from("<3q", data, 40)
        values = struct.unpack(f"<{(len(data) - 64) // 4}f", data[64:])
        for i in range(width * height):
            self.pixels[x + i % width, y + i // width] = tuple(
                values[offset + i * stride] for offset, stride in zip(offsets, strides))
        self.updates += 1


class Tev(CliTest):
    def render_to(self, server, *arguments):
        result = self.render("cornell-box", "--device", "threads", "-o", "out.pfm",
                             f"--tev=127.0.0.1:{server.port}", *arguments)
        return result

    def test_it_gets_the_picture(self):
        for more in [[], ["--crop", "5,3,30,28"], ["--aa", "adaptive:0.05"],
                     ["--precision", "double"]]:
            with self.subTest(more=more):
                server = TevServer()
                self.render_to(server, "--size", "40x30", *more)
                server.thread.join(20)
                picture = read_pfm(self.folder / "out.pfm")
                height, width, _ = picture.shape
                self.assertEqual(server.created, [("out.pfm", width, height)])
                got = [[server.pixels[x, y] for x in range(width)] for y in range(height)]
                self.assertTrue((got == picture).all())

    def test_it_gets_tiles_as_they_come(self):
        server = TevServer()
        self.render_to(server, *TAKES_A_WHILE)
        server.thread.join(20)
        self.assertGreater(server.updates, 10)

    def test_one_that_does_not_read_is_left_alone(self):
        server = TevServer(reads=False)
        result = self.render_to(server, "--size", "2000")
        self.assertIn("tev does not respond", result.stderr)

    def test_nothing_waits_for_one_that_reads_slowly(self):
        for outputs in [["out.pfm"], ["%s.pfm", scene_path("glass"), "--threads", "1"]]:
            with self.subTest(outputs=outputs):
                server = TevServer(slowly=True)
                process = self.start("render", scene_path("cornell-box"), "--device", "threads",
                                     "--size", "2000", f"--tev=127.0.0.1:{server.port}",
                                     "--progress", "none", "-o", *outputs)
                self.assertIn("cornell-box: 2000x2000", process.stderr.readline())
                self.assertTrue((self.folder / outputs[0].replace("%s", "cornell-box")).exists())
                server.wait_for_more()
                process.send_signal(signal.SIGINT)
                rest = process.communicate(timeout=HANG_LIMIT)[1]
                self.assertNotIn("stopping", rest)
                self.assertEqual(process.returncode, 0 if len(outputs) == 1 else 130, rest)
                server.thread.join(HANG_LIMIT)
                self.assertLess(len(server.data), 12 * 2000 * 2000, "there was nothing left to send")

    def test_an_address_needs_no_port(self):
        for option in ["--tev=localhost:1", "--tev=localhost", "--tev"]:
            result = self.succeed("render", "--size", "8", option, scene_path("single-sphere"))
            self.assertEqual(result.stderr.count("8x8"), 1, result.stderr)

    def test_an_option_takes_no_other_for_its_value(self):
        for option in ["--tev=", "--size="]:
            result = self.run_cli("render", scene_path("single-sphere"), option, "-o", "out.png")
            self.assert_refused(result, 2, f"'{option}' has no value")
        self.assertEqual(self.files(), [])

    def test_one_that_is_not_there(self):
        with socket.create_server(("127.0.0.1", 0)) as taken:
            port = taken.getsockname()[1]
        result = self.render("single-sphere", "--size", "8", "-o", "out.png",
                             f"--tev=127.0.0.1:{port}")
        self.assertIn("cannot reach tev", result.stderr)
        self.assertTrue(pathlib.Path(self.folder / "out.png").exists())


class Window(CliTest):
    @unittest.skipUnless(ctypes.util.find_library("SDL2-2.0"), "no SDL")
    def test_it_fills_and_shows_the_saved_picture_until_it_is_closed(self):
        """On SDL's screen in memory, of which each frame is saved."""
        process = self.start("render", scene_path("cornell-box"), "--device", "threads", *TAKES_A_WHILE, "--show",
                             "--progress", "none", "-o", "out.png",
                             env={"SDL_VIDEODRIVER": "dummy", "SDL_VIDEO_DUMMY_SAVE_FRAMES": "1"})
        self.assertIn("300x300", process.stderr.readline())
        self.assertIsNone(process.poll())
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(HANG_LIMIT), 0)
        frames = [name for name in self.files() if name.endswith(".bmp")]
        self.succeed("compare", frames[-1], "out.png", "--max-abs", "0")
        self.assertEqual(self.run_cli("compare", frames[0], "out.png", "--max-abs", "0").returncode, 1)

    def test_none_without_a_display(self):
        result = self.render("single-sphere", "--size", "8", "-o", "out.png", "--show",
                             env={"SDL_VIDEODRIVER": "offscreen"})
        self.assertIn("no window: ", result.stderr)
        self.assertIn("out.png", self.files())

#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What cmake installs and cpack packs runs from any folder."""
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

from program import BUILD


def run(*command, cwd="/", env=None):
    return subprocess.run([str(word) for word in command], cwd=cwd, env=env, text=True, check=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT).stdout


class Installed(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="mirrorball-test-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def check(self, prefix, zsh):
        """Without an environment: pictures of each library's format, and where it comes from."""
        pictures = {}
        for ending in ["png", "exr", "tif"]:
            picture = self.folder / f"picture.{ending}"
            said = run(prefix / "bin/mirrorball", "render", "--size", "40", "-o", picture,
                       prefix / "share/mirrorball/scenes/meshes.json", env={"LD_DEBUG": "files"})
            libraries = set(re.findall(r"file=(/\S*libmirrorball_\w+\.so)", said))
            self.assertEqual([pathlib.Path(library).resolve().parent for library in libraries],
                             [] if ending == "png" else [prefix / "lib/mirrorball"])
            pictures[re.search(r"image ([0-9a-f]{16})", said)[1]] = picture
        self.assertEqual(len(pictures), 1)
        for schema in ["results", "bench", "converge", "compare", "stress"]:
            self.assertTrue((prefix / f"share/mirrorball/schemas/{schema}.schema.json").is_file())
        for file in ["share/doc/mirrorball/copyright", "share/man/man1/mirrorball.1.gz",
                     "share/mirrorball/python/mirrorball/report.css",
                     "share/bash-completion/completions/mirrorball",
                     f"share/zsh/{zsh}/_mirrorball",
                     "share/fish/vendor_completions.d/mirrorball.fish"]:
            self.assertGreater((prefix / file).stat().st_size, 0, file)
        self.check_links(prefix / "share/doc/mirrorball")

    def check_links(self, docs):
        pages = list(docs.rglob("*.md"))
        for page in ["README.md", "docs/tutorial.md", "docs/gallery.md", "python/README.md"]:
            self.assertIn(docs / page, pages)
        for page in pages:
            for link in re.findall(r"\]\(([^)#]+)", page.read_text(encoding="utf-8")):
                self.assertTrue("://" in link or (page.parent / link).exists(), f"{page}: {link}")

    def check_advice(self, program, packages):
        """Without its modules, the program advises to install what its package names."""
        alone = self.folder / "alone"
        alone.mkdir()
        shutil.copy(program, alone)
        said = run(alone / "mirrorball", "doctor")
        named = set(re.findall(r"^missing .*(?:install|requires) (lib[\w.-]*\w)", said, re.M))
        self.assertEqual(len(named), 3, said)
        self.assertLessEqual(named, packages)

    def test_a_prefix_that_was_moved(self):
        run("cmake", "--install", BUILD, "--prefix", self.folder / "first")
        moved = (self.folder / "second").resolve()
        (self.folder / "first").rename(moved)
        self.check(moved, zsh="site-functions")

    @unittest.skipUnless(shutil.which("dpkg-deb"), "no Debian")
    def test_a_package(self):
        run("cpack", "-G", "DEB", "-B", self.folder, "--config", BUILD / "CPackConfig.cmake",
            cwd=self.folder)
        package = next(self.folder.glob("*.deb"))
        run("dpkg-deb", "-x", package, self.folder / "root")
        prefix = (self.folder / "root/usr").resolve()
        self.check(prefix, zsh="vendor-completions")
        depends = run("dpkg-deb", "-f", package, "Depends", "Recommends", "Suggests")
        self.check_advice(prefix / "bin/mirrorball", set(re.findall(r"lib[\w.-]+", depends)))
        depends += "libimath-3-1-29"  # comes with OpenEXR
        files = [prefix / "bin/mirrorball", *(prefix / "lib/mirrorball").iterdir()]
        self.assertGreaterEqual(len(files), 3)  # 4 where SDL is installed
        needed = {library: file.name for file in files
                  for library in re.findall(r"NEEDED\s+(\S+)", run("objdump", "-p", file))}
        for library, name in needed.items():
            owners = re.findall(r"^([^:,\s]+):", run("dpkg", "-S", f"*/{library}"), re.M)
            self.assertTrue(any(owner in depends for owner in owners), f"{name} needs {library}, which is in {owners}")


if __name__ == "__main__":
    unittest.main(verbosity=2)

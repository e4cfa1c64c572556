# SPDX-License-Identifier: Apache-2.0
"""What the scripts that measure have in common: commands that must succeed, renders, meshes."""
import argparse
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PROGRAM = ROOT / "build" / "release" / "mirrorball"
PAPER_SCENE = ROOT / "scenes" / "cornell-box.json"


def parser_of(doc):
    """For a script with this text, which takes the program's path."""
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", nargs="?", type=lambda text: pathlib.Path(text).resolve(), default=PROGRAM)
    return parser


def positive(text):
    """For argparse: a whole number from 1."""
    if int(text) < 1:
        raise ValueError
    return int(text)


def run(command, stderr=subprocess.PIPE, **more):
    """What the command, run in ROOT, prints; ends the script where the command fails."""
    result = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=stderr, text=True,
                            errors="replace", cwd=ROOT, check=False, **more)
    if result.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{result.stdout[-1000:]}{(result.stderr or '')[-2000:]}")
    return result.stdout


def render(program, scene, *options, **more):
    """The statistics of a render on the device that the options name, and on no other."""
    return json.loads(run([program, "render", scene, "-q", "--no-fallback", "--stats=json", *options],
                          **more))


def error_of(program, picture, reference):
    """How far the picture is from the reference, both clamped to 0..1."""
    result = subprocess.run([program, "compare", picture, reference, "--clamp", "--json"],
                            capture_output=True, text=True, cwd=ROOT, check=False)
    return json.loads(result.stdout)["error"]


def bumpy_mesh(folder, triangles, *options):
    """A scene with a mesh of so many triangles, written into the folder."""
    scene = pathlib.Path(folder) / f"bumpy-mesh-{triangles}{''.join(options)}.json"
    run([sys.executable, ROOT / "scripts/generate/generate.py", "bumpy-mesh", triangles, "-o", scene,
         *options])
    return scene

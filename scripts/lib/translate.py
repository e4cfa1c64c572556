# SPDX-License-Identifier: Apache-2.0
"""Scenes of spheres, triangles and PLY meshes in the languages of Tachyon and POV-Ray.

For timing these programs on the same geometry, lights and mirrors: Tachyon's highlights and ambient light
are as close as its materials allow, not identical. Anti-aliasing is four samples per pixel in both. Meshes
must be binary little-endian PLY files of triangles, as scripts/generate writes them; both programs read
only text.
"""
import json
import math
import pathlib
import re
import struct

from spd.vectors import cross, sub, unit


def read_scene(path):
    return json.loads(pathlib.Path(path).read_text())


def read_ply(path):
    """(points, corners) of a binary PLY of x, y, z as floats and triangles as uchar + int."""
    data = pathlib.Path(path).read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    counts = {name.decode(): int(count) for name, count
              in re.findall(rb"element (\w+) (\d+)", data[:end])}
    points = list(struct.iter_unpack("<3f", data[end:end + 12 * counts["vertex"]]))
    faces = struct.iter_unpack("<B3i", data[end + 12 * counts["vertex"]:][:13 * counts["face"]])
    return points, [face[1:] for face in faces]


def triangles_of(scene, folder):
    """(material, three points) of every triangle, those of meshes, too."""
    for triangle in scene.get("triangles", []):
        yield triangle["material"], triangle["vertices"]
    for mesh in scene.get("meshes", []):
        points, faces = read_ply(folder / mesh["file"])
        for face in faces:
            yield mesh["material"], [points[corner] for corner in face]


def rgb(value):
    return [value] * 3 if isinstance(value, (int, float)) else list(value)


def view(camera, width, height):
    """(forward, right, up) as unit vectors, and half the picture's height at distance 1."""
    forward = unit(sub(camera["at"], camera["from"]))
    right = unit(cross(forward, camera.get("up", [0, 1, 0])))
    half = math.tan(math.radians(camera["fov_degrees"]) / 2)
    if camera.get("fov_axis", "y") == "x":
        half *= height / width
    return forward, right, cross(right, forward), half


def words(numbers):
    return " ".join(f"{number:.9g}" for number in numbers)


def tachyon(scene, folder, width, height):
    """Mirrored in x: Tachyon's pictures are left-handed."""
    def across(point):
        return words([-point[0], point[1], point[2]])

    camera = scene["camera"]
    forward, _, up, half = view(camera, width, height)
    lines = ["BEGIN_SCENE", f"RESOLUTION {width} {height}",
             f"CAMERA ZOOM {0.5 / half:.9g} ASPECTRATIO 1.0 ANTIALIASING 3",
             f"RAYDEPTH {scene.get('max_bounces', 8) + 1}", f"CENTER {across(camera['from'])}",
             f"VIEWDIR {across(forward)}", f"UPDIR {across(up)}", "END_CAMERA",
             f"BACKGROUND {words(rgb(scene.get('background', 0)))}"]
    for light in scene["lights"]:
        lines.append(f"LIGHT CENTER {across(light['position'])} RAD 0.0001 "
                     f"COLOR {words(rgb(light['intensity']))}")
    ambient = max(rgb(scene.get("ambient_light", 0)))
    for name, material in scene["materials"].items():
        color = rgb(material.get("diffuse", 0))
        strength = max(*color, 1e-6)
        lines.append(f"TEXDEF {name} AMBIENT {ambient * min(1, max(rgb(material.get('ambient', 0)))):.9g} "
                     f"DIFFUSE {strength:.9g} SPECULAR {max(rgb(material.get('mirror', 0))):.9g} "
                     f"OPACITY 1.0 PHONG PLASTIC {max(rgb(material.get('specular', 0))):.9g} "
                     f"PHONG_SIZE {material.get('shininess', 1):.9g} "
                     f"COLOR {words(part / strength for part in color)} TEXFUNC 0")
    for sphere in scene.get("spheres", []):
        lines.append(f"SPHERE CENTER {across(sphere['center'])} RAD {sphere['radius']:.9g} "
                     f"{sphere['material']}")
    for material, (a, b, c) in triangles_of(scene, folder):
        lines.append(f"TRI V0 {across(a)} V1 {across(b)} V2 {across(c)} {material}")
    return "\n".join([*lines, "END_SCENE", ""])


def vector(numbers):
    return "<" + ", ".join(f"{number:.9g}" for number in numbers) + ">"


def povray_material(material):
    """The pigment tints ambient and diffuse light alike, so the ambient light is divided by it. `specular`
    is Blinn's lobe, untinted; where the highlight has a color, `metallic` tints it, and whitens it at
    grazing angles."""
    diffuse, specular = rgb(material.get("diffuse", 0)), rgb(material.get("specular", 0))
    strength = max(*diffuse, 1e-6)
    pigment = [max(part / strength, 1e-6) for part in diffuse]
    ambient = [part / tint for part, tint in zip(rgb(material.get("ambient", 0)), pigment)]
    metallic = " metallic" if min(specular) < max(specular) else ""
    return (f"pigment {{ rgb {vector(pigment)} }} finish {{ ambient rgb {vector(ambient)} diffuse {strength:.9g}"
            f" specular {max(specular):.9g}{metallic} roughness {1 / max(material.get('shininess', 1), 1):.9g}"
            f" reflection {{ rgb {vector(rgb(material.get('mirror', 0)))} }} }}")


def povray(scene, folder, width, height):
    camera = scene["camera"]
    forward, right, up, half = view(camera, width, height)
    lines = ["#version 3.7;",
             f"global_settings {{ assumed_gamma 1 ambient_light rgb {vector(rgb(scene.get('ambient_light', 0)))}"
             f" max_trace_level {scene.get('max_bounces', 8) + 1} adc_bailout 0 }}",
             f"background {{ rgb {vector(rgb(scene.get('background', 0)))} }}",
             f"camera {{ perspective location {vector(camera['from'])} direction {vector(forward)}"
             f" right {vector([2 * half * width / height * x for x in right])}"
             f" up {vector([2 * half * x for x in up])} }}"]
    for light in scene["lights"]:
        lines.append(f"light_source {{ {vector(light['position'])} rgb {vector(rgb(light['intensity']))} }}")
    for name, material in scene["materials"].items():
        lines.append(f"#declare {name}_ = texture {{ {povray_material(material)} }}")
    for sphere in scene.get("spheres", []):
        lines.append(f"sphere {{ {vector(sphere['center'])}, {sphere['radius']:.9g}"
                     f" texture {{ {sphere['material']}_ }} }}")
    by_material = {}
    for material, corners in triangles_of(scene, folder):
        by_material.setdefault(material, []).append(corners)
    for material, triangles in by_material.items():
        lines.append("mesh {")
        lines += ["triangle { " + ", ".join(map(vector, corners)) + " }" for corners in triangles]
        lines.append(f"texture {{ {material}_ }} }}")
    return "\n".join([*lines, ""])


FORMATS = {".dat": tachyon, ".pov": povray}


def translate(scene_file, output, size):
    """Writes the scene for the program that output's suffix names; size is (width, height)."""
    scene_file, output = pathlib.Path(scene_file), pathlib.Path(output)
    scene = read_scene(scene_file)
    output.write_text(FORMATS[output.suffix](scene, scene_file.parent, *size))

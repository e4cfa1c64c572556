# SPDX-License-Identifier: Apache-2.0
"""The Python package over the program that $MIRRORBALL names: python -m pytest python/tests"""
import json
import os
import pathlib
import re
import signal
import stat
import subprocess
import time

import numpy
import pytest

import mirrorball
from mirrorball.texts import name_renderers

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PAPER = ROOT / "scenes" / "cornell-box.json"
SMALL = {"device": "threads:1", "size": 24, "aa": "none"}
BALL = {"camera": {"from": [0, 0, 5], "at": [0, 0, 0], "fov_degrees": 40},
        "image": {"width": 20, "height": 10},
        "background": [0.25, 0.5, 0.75],
        "materials": {"red": {"ambient": [1, 0, 0]}},
        "ambient_light": 1,
        "spheres": [{"center": [0, 0, 0], "radius": 1, "material": "red"}]}


def test_a_picture_has_the_pixels_that_the_scene_says():
    picture = mirrorball.render(BALL, device="threads:1", aa="none")
    assert picture.array.shape == (10, 20, 3)
    assert picture.array.dtype == numpy.float32
    assert picture.array[0, 0].tolist() == [0.25, 0.5, 0.75]
    assert picture.array[5, 10].tolist() == [1, 0, 0]


def test_row_0_is_at_the_top():
    scene = {**BALL, "camera": {"from": [0, -3, 9], "at": [0, -3, 0], "fov_degrees": 40}}
    picture = mirrorball.render(scene, device="threads:1", aa="none")
    red = numpy.argwhere(picture.array[:, :, 0] == 1)
    assert len(red) > 0 and red[:, 0].max() < 5


def test_a_path_gives_the_hash_that_the_command_line_gives():
    picture = mirrorball.render(PAPER, **SMALL)
    printed = subprocess.run([mirrorball.find_program(), "render", PAPER, "--device", "threads:1",
                              "--size", "24", "--aa", "none", "--stats=json", "-q"], check=True,
                             capture_output=True, text=True).stdout
    assert picture.hash == json.loads(printed)["image"]["hash"]
    assert picture.stats["settings"]["width"] == 24


def test_saved_pngs_have_the_programs_pixels(tmp_path):
    light = mirrorball.render({"camera": {"from": [0, 0, 1], "at": [0, 0, 0], "fov_degrees": 60}, "background": [0.9] * 3},
                              size=2)
    (tmp_path / "shown.png").write_bytes(light._repr_png_())
    light.save(tmp_path / "light.png")
    assert mirrorball.compare(tmp_path / "shown.png", tmp_path / "light.png")["identical"]
    picture = mirrorball.render(PAPER, **SMALL)
    picture.save(tmp_path / "ours.png")
    subprocess.run([mirrorball.find_program(), "render", PAPER, "--device", "threads:1", "--size",
                    "24", "--aa", "none", "-q", "-o", tmp_path / "theirs.png"], check=True)
    assert mirrorball.compare(tmp_path / "ours.png", tmp_path / "theirs.png")["identical"]
    (tmp_path / "shown.png").write_bytes(picture._repr_png_())
    assert mirrorball.compare(tmp_path / "shown.png", tmp_path / "theirs.png")["identical"]


def test_saved_pfms_keep_every_bit(tmp_path):
    picture = mirrorball.render(PAPER, **SMALL)
    picture.save(tmp_path / "box.pfm")
    assert numpy.array_equal(mirrorball.read_pfm(tmp_path / "box.pfm"), picture.array)
    with pytest.raises(mirrorball.UsageError):
        picture.save(tmp_path / "box.xyz")


def test_options_are_spelled_as_the_program_takes_them():
    picture = mirrorball.render(PAPER, device="threads:1", size=(30, 20), aa="none", max_bounces=0,
                                crop=(0, 0, 15, 20), precision="double", no_fallback=True)
    assert picture.array.shape == (20, 15, 3)
    assert picture.stats["settings"]["precision"] == "double"
    assert picture.stats["rays"]["mirror"] == 0


def test_meshes_of_a_dict_are_named_from_the_working_folder(tmp_path, monkeypatch):
    (tmp_path / "one.obj").write_text("v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n")
    monkeypatch.chdir(tmp_path)
    scene = {**BALL, "spheres": [], "meshes": [{"file": "one.obj", "material": "red"}]}
    assert mirrorball.scene_info(scene)["mesh_triangles"] == 1
    picture = mirrorball.render(scene, device="threads:1", aa="none")
    assert picture.array[5, 10].tolist() == [1, 0, 0]
    assert scene["meshes"][0]["file"] == "one.obj"


@pytest.mark.parametrize("call, error, code, words", [
    (lambda: mirrorball.render("nowhere.json"), mirrorball.InputError, 3, "nowhere.json"),
    (lambda: mirrorball.render({"camera": 1}), mirrorball.InputError, 3, "camera"),
    (lambda: mirrorball.render(PAPER, aa="much"), mirrorball.UsageError, 2, "much"),
    (lambda: mirrorball.render(PAPER, no_such_option=1), mirrorball.UsageError, 2, "no-such-option"),
    (lambda: mirrorball.render(PAPER, device="name:nothing"), mirrorball.DeviceError, 5, "nothing"),
])
def test_mistakes_are_exceptions_with_the_programs_message(call, error, code, words):
    with pytest.raises(error) as caught:
        call()
    assert caught.value.exit_code == code
    assert words in str(caught.value)


@pytest.mark.parametrize("name", ["output", "watch", "show", "preview", "aov", "frames"])
def test_what_is_not_for_one_picture_is_no_option(name):
    with pytest.raises(TypeError, match=name):
        mirrorball.render(PAPER, **{name: True})
    assert mirrorball.render(PAPER, **SMALL, **{name: None}).array.shape == (24, 24, 3)


def test_a_picture_that_ran_out_of_time_names_no_file_that_is_gone():
    with pytest.raises(mirrorball.MissingPartsError, match="out of time") as caught:
        mirrorball.render(PAPER, device="threads:1", size=2000, aa="grid:64", timeout=1)
    assert "mirrorball-" not in str(caught.value) and ".partial" not in str(caught.value)


def test_scenes_hold_numpys_numbers():
    sphere = {"center": numpy.zeros(3), "radius": numpy.float32(1), "material": "red"}
    scene = {**BALL, "image": {"width": numpy.int64(20), "height": 10}, "spheres": [sphere]}
    assert mirrorball.render(scene, **SMALL).hash == mirrorball.render(BALL, **SMALL).hash
    with pytest.raises(TypeError, match="set"):
        mirrorball.render({**BALL, "spheres": {1, 2}})


def test_meshes_of_a_dict_need_a_folder_that_can_be_written(monkeypatch):
    monkeypatch.chdir("/proc")
    with pytest.raises(mirrorball.OutputError, match="/proc"):
        mirrorball.scene_info({**BALL, "meshes": [{"file": "one.obj", "material": "red"}]})


def test_a_program_that_is_not_there_is_said(monkeypatch):
    monkeypatch.setenv("MIRRORBALL", "/nowhere/mirrorball")
    with pytest.raises(FileNotFoundError, match="/nowhere/mirrorball"):
        mirrorball.render(PAPER)


def test_progress_goes_to_one():
    shares = []
    mirrorball.render(PAPER, progress=shares.append, **SMALL)
    assert shares == sorted(shares)
    assert shares[-1] == 1


def test_an_interrupt_stops_the_program(tmp_path, monkeypatch):
    pid = tmp_path / "pid"
    waits = tmp_path / "waits"
    waits.write_text(f"#!/bin/sh\necho $$ > {pid}\necho '{{\"fraction\": 0}}' >&2\nexec sleep 60\n")
    waits.chmod(waits.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("MIRRORBALL", str(waits))

    with pytest.raises(KeyboardInterrupt):
        mirrorball.render(PAPER, progress=lambda _: os.kill(os.getpid(), signal.SIGINT))
    with pytest.raises(ProcessLookupError):
        os.kill(int(pid.read_text()), 0)


def test_an_interrupted_program_may_end_though_nobody_reads_what_it_prints(tmp_path, monkeypatch):
    prints, ended = tmp_path / "prints", tmp_path / "ended"
    prints.write_text(f"#!/bin/sh\ntrap 'head -c 200000 /dev/zero; touch {ended}; exit' TERM INT\n"
                      "echo '{\"fraction\": 0}' >&2\nwhile :; do sleep 0.1; done\n")
    prints.chmod(prints.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("MIRRORBALL", str(prints))

    with pytest.raises(KeyboardInterrupt):
        mirrorball.render(PAPER, progress=lambda _: os.kill(os.getpid(), signal.SIGINT))
    assert ended.exists()


def test_what_progress_raises_stops_the_program():
    def fail(_):
        raise KeyError("enough")

    begun = time.monotonic()
    with pytest.raises(KeyError, match="enough"):
        mirrorball.render(PAPER, device="threads", size=2000, aa="sobol:4096", timeout=60,
                          progress=fail)
    assert time.monotonic() - begun < 30


def test_compare_takes_arrays_and_pictures():
    picture = mirrorball.render(PAPER, **SMALL)
    assert mirrorball.compare(picture, picture)["identical"]
    brighter = picture.array.copy()
    brighter[3, 4, 1] += 0.5
    answer = mirrorball.compare(brighter, picture, max_abs=0.1)
    assert answer["error"]["max"] == pytest.approx(0.5, abs=1e-6)
    assert answer["error"]["max_at"] == [4, 3]
    assert not answer["passed"]


def test_bench_gives_flat_rows():
    rows = mirrorball.bench(PAPER, sizes=[16, 24], aa="none", devices=["threads:1"], schedules="tiles",
                            repeats=1)
    assert {row["width"] for row in rows} == {16, 24}
    rows = mirrorball.bench(PAPER, sizes=[(20, 10)], aa="none", devices=["threads:1"], schedules="tiles",
                            repeats=1)
    assert [(row["width"], row["height"]) for row in rows if row["precision"] == "float"] == [(20, 10)]
    assert all(row["verdict"] == "right" for row in rows)
    assert all(row["figures.trace.median"] > 0 for row in rows)
    assert not any(isinstance(value, (dict, list)) for row in rows for value in row.values())
    assert rows.report["format"] == "mirrorball-bench"


def test_converge_gives_flat_rows(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    rows = mirrorball.converge(PAPER, size=16, devices="threads", aa="none,grid:2", precision="float",
                               reference_samples=16)
    assert len(rows) == 2
    assert all(row["figures.rmse"] > 0 for row in rows)


def test_devices_and_options_are_lists():
    assert isinstance(mirrorball.devices(), list)
    options = mirrorball.options("render")
    assert "max_bounces" in options
    assert not {"device", "format"} & set(mirrorball.options("bench"))
    assert not {"help", "output", "batch"} & set(options)  # render() takes none of them


def test_files_that_are_no_pfm_are_refused(tmp_path):
    (tmp_path / "x.pfm").write_bytes(b"P6\n1 1\n255\nabc")
    with pytest.raises(ValueError):
        mirrorball.read_pfm(tmp_path / "x.pfm")


def test_scenes_come_with_the_program():
    assert pathlib.Path(mirrorball.scene("cornell-box")).name == "cornell-box.json"
    with pytest.raises(FileNotFoundError):
        mirrorball.scene("nothing")


@pytest.mark.parametrize("ending", ["exr", "tif", "jpg"])
def test_pictures_are_saved_in_the_programs_formats(tmp_path, ending):
    picture = mirrorball.render(mirrorball.scene("cornell-box"), size=40, device="threads")
    path = tmp_path / f"box.{ending}"
    try:
        picture.save(path)
    except mirrorball.OutputError as error:
        if "libmirrorball_" not in str(error):
            raise
        pytest.skip(str(error))
    assert mirrorball.compare(path, picture)["error"]["rmse"] <= (.05 if ending == "jpg" else 0)


def test_aovs_are_arrays():
    scene = {"camera": {"from": [0, 0, 5], "at": [0, 0, 0], "fov_degrees": 40}, "lights": [{"position": [0, 0, 9]}],
             "materials": {"m": {"diffuse": 1}}, "spheres": [{"center": [0, 0, 0], "radius": 1, "material": "m"}]}
    found = mirrorball.aov(scene, "depth,normal,id,rays,samples", size=(21, 33), aa="none", device="threads")
    assert found["depth"].shape == (33, 21) and found["normal"].shape == (33, 21, 3)
    assert found["depth"][16, 10] == pytest.approx(4, abs=1e-2)
    assert found["normal"][16, 10] == pytest.approx([0, 0, 1], abs=5e-2)
    assert found["normal"][12, 10][1] > .1 > -.1 > found["normal"][20, 10][1]
    assert found["rays"][0, 0] == 1 and (found["samples"] == 1).all()
    assert found["id"][16, 10] != found["id"][0, 0]


def test_explain_and_stress_give_what_they_find():
    tree = mirrorball.explain(mirrorball.scene("cornell-box"), 30, 20, size=40)
    assert tree["format"] == "mirrorball-explain"
    rows = mirrorball.stress(case="needles", device="threads", quick=True)
    assert {row["family"] for row in rows} == {"needles"} and {row["verdict"] for row in rows} == {"pass"}
    assert rows.report["passed"] and {row["precision"] for row in rows} == {"float", "double"}


def test_mistakes_in_a_dict_name_the_dict():
    with pytest.raises(mirrorball.InputError) as caught:
        mirrorball.render({"spheers": []})
    assert "the scene's dict: " in str(caught.value) and "spheers" in str(caught.value)
    assert ".json" not in str(caught.value) and ":1:" not in str(caught.value)


def test_shipped_scenes_are_dicts(tmp_path):
    scene = mirrorball.load("cornell-box")
    assert scene["name"] and len(scene["spheres"]) == 2
    assert mirrorball.render(scene, size=40).hash == mirrorball.render(mirrorball.scene("cornell-box"), size=40).hash
    text = '\ufeff// a comment\n{"name": "http://x /* y */", /* another */ "spheres": []}'  # a byte order mark
    (tmp_path / "own.json").write_text(text, encoding="utf-8")
    assert mirrorball.load(tmp_path / "own.json") == {"name": "http://x /* y */", "spheres": []}


def test_help_lists_the_options():
    assert set(mirrorball.options("render")) <= set(re.findall(r"\w+", mirrorball.render.__doc__))


def test_rows_say_in_short_who_rendered_and_what_was_asked_for():
    rows = mirrorball.bench(mirrorball.scene("cornell-box"), sizes=[16], aa="none", repeats=1, precision="float",
                            devices=["pocl", "threads:1"], schedules="tiles")
    assert [row["asked"] for row in rows if row["device_name"] != "threads"] == ["pocl"]
    assert [(row["asked"], row["renderer"]) for row in rows if row["device_name"] == "threads"] == [("threads:1", "1 thread")]
    assert all(row["renderer"].startswith("PoCL") for row in rows if row["asked"] == "pocl")


@pytest.mark.parametrize("ending", ["png", "pfm"])
def test_a_picture_that_cannot_be_saved_is_an_error_of_the_program(tmp_path, ending):
    picture = mirrorball.render(mirrorball.scene("empty"), size=4, device="threads")
    with pytest.raises(mirrorball.OutputError, match="nowhere"):
        picture.save(tmp_path / "nowhere" / f"x.{ending}")


def test_rows_that_failed_are_rows_and_no_rows_are_an_error(tmp_path, monkeypatch):
    program = tmp_path / "mirrorball"
    row = {"device": "0", "device_name": "GPU", "verdict": "failed", "figures": None}
    program.write_text(f"#!/bin/sh\n[ $1 = bench ] && echo '{json.dumps({'rows': [row]})}'\necho no device >&2\nexit 5\n")
    program.chmod(0o755)
    monkeypatch.setenv("MIRRORBALL", str(program))
    assert [one["verdict"] for one in mirrorball.bench(PAPER)] == ["failed"]
    with pytest.raises(mirrorball.DeviceError, match="no device"):
        mirrorball.converge(PAPER)


def test_devices_of_one_name_are_told_apart():
    rows = [{"device": device, "device_name": name} for device, name in
            [("0", "H200"), ("1", "H200"), ("2", "pthread-haswell-X"), ("threads:1", "threads")]]
    name_renderers(rows)
    assert [row["renderer"] for row in rows] == ["H200, device 0", "H200, device 1", "PoCL (X)", "threads"]

# SPDX-License-Identifier: Apache-2.0
"""The pieces of the report's page; tests/report_test.py runs the whole."""
import json
import pathlib
import re
import xml.etree.ElementTree

import pytest

pytest.importorskip("matplotlib")

from mirrorball import page, plots, report, sections, texts
from mirrorball.program import run_json
from mirrorball.stress_section import by_margin, stress_section, used_tolerance
from mirrorball.study import Figures, Study


def test_numbers_keep_their_digits():
    assert [texts.significant(value) for value in (1234.4, 9.996, 0, 12)] == ["1234", "10.0", "0", "12.0"]
    assert texts.significant(.0499, 2) == "0.050"
    assert [texts.duration(value) for value in (.01234, .9996, 0)] == ["12.3\xa0ms", "1.00\xa0s", "0\xa0s"]
    assert texts.duration(42e-6, 2) == "42\xa0µs"
    assert [texts.scientific(value) for value in (3.44e-5, 0)] == ["3.4·10⁻⁵", "0"]
    assert texts.estimate_text({"rmse": 3e-5, "high": 4e-5}) == "3.0·10⁻⁵"
    assert texts.estimate_text({"rmse": None, "high": 4e-5}) == "below 4.0·10⁻⁵"


def test_a_device_has_the_short_name_that_the_program_gives_it():
    table = pathlib.Path(__file__).parents[2] / "tests" / "device_names.json"
    names = json.loads(table.read_text(encoding="utf-8"))
    assert {name: texts.short_name(name) for name in names} == names


def test_neighbors_are_spread_and_stay_in_order():
    assert plots.spread([.5, .2, .21], .1, 0, 1) == pytest.approx([.5, .155, .255])
    assert plots.spread([0, 0, 0], .1, 0, 1) == pytest.approx([0, .1, .2])
    assert plots.spread([1, .99], .1, 0, 1) == pytest.approx([1, .9])
    crowd = plots.spread([.3] * 5, .25, 0, 1)
    assert [b - a for a, b in zip(sorted(crowd), sorted(crowd)[1:])] == pytest.approx([.25] * 4)


def some_plot(name="p"):
    curves = [plots.Curve("<curve>", "s1", [plots.Point(1e-3, 1, "<1>", "bench-0#/rows/0", "none"), plots.Point(1, 1e-3)])]
    return plots.curves_plot(name, "Error & time", "falls", plots.Axis("time", "seconds"), plots.Axis("error", "power"),
                             curves, front=curves[0].points, floor=(1e-4, "noise"))


def test_a_plot_in_a_page_is_text_and_variables():
    svg = plots.inline_svg(some_plot())
    xml.etree.ElementTree.fromstring(svg)
    assert "var(--s1)" in svg and not re.search("#[0-9a-f]{6}", svg)
    assert ">&lt;curve&gt;</text>" in svg and ">10⁻³</text>" in svg and ">10\xa0ms</text>" in svg
    assert 'data-source="bench-0#/rows/0"><title>&lt;1&gt;</title>' in svg
    other = plots.inline_svg(some_plot("q"))
    assert not set(re.findall(r'\bid="([^"]*)"', svg)) & set(re.findall(r'\bid="([^"]*)"', other))
    for used in re.findall(r'(?:href="#|url\(#)([^")]*)', svg):
        assert f'id="{used}"' in svg


def test_text_in_the_page_is_escaped():
    assert page.text('<b a="x" c=\'y\'>&amp;\x01') == "&lt;b a=&quot;x&quot; c=&#x27;y&#x27;&gt;&amp;amp;\ufffd"
    block = page.data_block("x", {"name": "</script><!--<script>&"})
    assert block.count("</script>") == 1 and "\\u003c/script>\\u003c!--\\u003cscript>\\u0026" in block


def test_numbers_in_a_column_are_aligned_at_their_points():
    table = page.table("caption", ["name", "number"], [["a", "1.25"], ["b", "13"], ["c", page.Cell("2.0", "x#/y")]])
    assert '<td class="number">1.25</td>' in table
    assert '<td class="number" data-pad=".00">13</td>' in table
    assert '<td data-source="x#/y" class="number" data-pad="0">2.0</td>' in table


def test_the_stress_section_shows_verdicts_curves_and_the_worst_pictures(tmp_path: pathlib.Path):
    result = run_json(["stress", "--quick", "--case", "needles,ordinary,cone-rays", "--device", "threads", "--json", "-",
                       "-o", tmp_path, "-q"])
    figures = Figures()
    section = stress_section(result, tmp_path, figures)
    families = result["families"]
    order = by_margin(families)
    used = [used_tolerance(families[i]) for i in order]
    assert used == sorted(used, reverse=True) and len(used) == 3
    assert f"PASS: 3 of 3 families; {families[order[0]]['name']} comes closest to its tolerance" in section
    assert [plot.name for plot in figures.plots] == ["stress-needles"]
    cases = families[[family["name"] for family in families].index("needles")]["cases"]
    for i in range(len(cases)):
        assert re.search(rf'data-source="stress#/families/\d/cases/{i}/rows/0"', section)
    assert section.count("<img") == 6

    families[2]["passed"] = result["passed"] = False
    assert by_margin(families)[0] == 2
    section = stress_section(result, tmp_path, Figures())
    assert "FAIL: 2 of 3 families." in section and "<strong>fail</strong>" in section


def study_of(*rows, points=()):
    rows = [{"device": "threads:1", "device_name": "threads", "width": 8, "height": 8, "precision": "float",
             "figures": {}, "verdict": "right", **row} for row in rows]
    return Study(0, {"rows": rows}, {"points": [{**rows[0], **point} for point in points]}, {}, *[None] * 3, None)


def test_the_largest_picture_has_the_most_samples_also_where_pixels_differ_in_them():
    study = study_of(*[{"aa": aa, "samples": samples, "figures": {"trace": {}}}
                       for aa, samples in (("none", 1), ("adaptive:0.1", None), ("grid:2", 4))])
    assert [row["aa"] for row in study.largest()] == ["adaptive:0.1"]


def test_the_verdict_and_the_exit_code_count_points_too():
    failed = {"verdict": "failed", "figures": None, "samples": 1}
    study = study_of(failed, points=[{}, {"verdict": "wrong"}])
    assert "Of 3 combinations, 1 gave a wrong picture and 2 failed." in sections.verdict_details(study)
    assert [report.exit_code([one], None) for one in (study, study_of(failed))] == [1, 5]
    assert report.exit_code([study_of({})], {"passed": False}) == 1


def test_a_page_is_written_through_a_link_and_keeps_its_mode(tmp_path):
    (tmp_path / "page.html").touch(0o600)
    (tmp_path / "link.html").symlink_to("page.html")
    report._write(tmp_path / "link.html", b"page")
    assert (tmp_path / "link.html").is_symlink() and (tmp_path / "page.html").read_bytes() == b"page"
    assert (tmp_path / "page.html").stat().st_mode & 0o777 == 0o600 and len(list(tmp_path.iterdir())) == 2

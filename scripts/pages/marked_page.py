# SPDX-License-Identifier: Apache-2.0
"""A page of docs/ with parts that scripts write, each between its own markers."""
import pathlib

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
NUMERICS = ROOT / "docs" / "numerics.md"


def replace_between_marks(page, name, text):
    """Puts the text between the page's lines `<!-- NAME: begin -->` and `<!-- NAME: end -->`."""
    begin, end = f"<!-- {name}: begin -->\n", f"<!-- {name}: end -->\n"
    before, rest = page.read_text(encoding="utf-8").split(begin)
    _, after = rest.split(end)
    page.write_text(before + begin + text + end + after, encoding="utf-8")

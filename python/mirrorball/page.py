# SPDX-License-Identifier: Apache-2.0
"""The pieces of the report's page: text, tables, pictures and data as HTML."""
from __future__ import annotations

import base64
import dataclasses
import html
import json
import pathlib
import re
from typing import Any, Optional, Sequence, Union

import numpy

from . import plots
from .picture import png_of

#: Colors that no plot has, as in plots.THEME.
COLORS = {**plots.THEME, "rule": ("#d5dae0", "#363d46"), "tint": ("#f5f7f9", "#1c2127"),
          "accent": ("#0b62a3", "#79bdf2"), "shade": ("#0004", "#fff5")}
_POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'"
_LONG_TEXT = 40  # characters beyond which a cell's lines may break


@dataclasses.dataclass
class Cell:
    """A table's cell: its text, where its number lies in the data, and a bar for a share of 0 to 1."""
    text: str
    source: str = ""
    strong: bool = False
    share: Optional[float] = None


Row = Sequence[Union[Cell, str]]


def text(value: Any) -> str:
    """Any text as HTML: what is no character of a text becomes U+FFFD."""
    printable = re.sub("[\x00-\x08\x0b-\x1f\x7f\ud800-\udfff]", "\ufffd", str(value))
    return html.escape(printable)


def attribute(name: str, value: Any) -> str:
    return f' {name}="{text(value)}"' if value else ""


def paragraph(what: str, css_class: str = "", source: str = "") -> str:
    return f"<p{attribute('class', css_class)}{attribute('data-source', source)}>{text(what)}</p>\n"


def _decimals(number: str) -> int:
    return len((re.match(r"[0-9]+\.?([0-9]*)", number) or [""] * 2)[1])


def _is_number(cell: str) -> bool:
    """12.3, 1.9·10⁻⁷, -0.5 ± 0.1 or 43 %"""
    return re.fullmatch(r"[-−]?[0-9][0-9.]*(·10.*| %| ± .*)?", cell) is not None


def _cell(cell: Cell, is_head: bool, decimals: Optional[int]) -> str:
    """A cell; in a column of numbers (with so many decimals at most) aligned at the point."""
    source = attribute("data-source", cell.source)
    if is_head:
        return f'<th scope="row"{source}>{text(cell.text)}</th>'
    css_class, pad = "long" if len(cell.text) > _LONG_TEXT else "", ""
    if decimals is not None:
        is_short = _is_number(cell.text) or len(cell.text) < 6
        css_class = "number" + (" drawn" if cell.share is not None else "" if is_short else " words")
        if re.fullmatch("[0-9.]+", cell.text):
            missing = decimals - _decimals(cell.text)
            pad = ("." if missing and "." not in cell.text else "") + missing * "0"
    words = f"<strong>{text(cell.text)}</strong>" if cell.strong else text(cell.text)
    if cell.share is not None:
        words = ('<svg class="share" viewBox="0 0 100 10" aria-hidden="true"><rect class="whole" width="100" '
                 f'height="10"/><rect width="{100 * min(max(cell.share, 0), 1):.1f}" height="10"/></svg> {words}')
    return f"<td{source}{attribute('class', css_class)}{attribute('data-pad', pad)}>{words}</td>"


def table(caption: str, heads: Sequence[str], rows: Sequence[Row]) -> str:
    cells = [[part if isinstance(part, Cell) else Cell(part) for part in row] for row in rows]
    columns: list[Optional[int]] = []  # decimals of a column of numbers
    for i in range(len(heads)):
        texts = [row[i].text for row in cells if i < len(row) and row[i].text]
        numbers = [one for one in texts if _is_number(one)]
        columns.append(max(map(_decimals, numbers))
                       if i > 0 and numbers and 2 * len(numbers) >= len(texts) else None)
    head = "".join(f'<th scope="col"{attribute("class", "number" if column is not None else "")}>{text(name)}</th>'
                   for name, column in zip(heads, columns))
    body = "".join("<tr>" + "".join(_cell(cell, i == 0, columns[i]) for i, cell in enumerate(row)) + "</tr>\n"
                   for row in cells)
    return (f'<div class="scroll" tabindex="0" role="region"{attribute("aria-label", caption)}><table>\n'
            f"<caption>{text(caption)}</caption>\n<thead><tr>{head}</tr></thead>\n"
            f"<tbody>\n{body}</tbody></table></div>\n")


def image(pixels: Union[numpy.ndarray, bytes], alt: str, caption: str = "", source: str = "",
          window: Optional[tuple[int, int, int]] = None) -> str:
    """A picture, from its pixels or as PNG, with a frame around a square window (x, y, side) in it."""
    png = pixels if isinstance(pixels, bytes) else png_of(pixels)
    width, height = (int.from_bytes(png[at:at + 4], "big") for at in (16, 20))
    mark = ""
    if window:
        x, y, side = window
        place = f'x="{x}" y="{y}" width="{side}" height="{side}"'
        mark = (f'<svg class="mark" viewBox="0 0 {width} {height}" aria-hidden="true"><rect class="under" {place}/>'
                f'<rect class="over" {place}/></svg>')
    return (f'<figure{attribute("data-source", source)}><div class="picture"><img src="{png_uri(png)}" '
            f'width="{width}" height="{height}"{attribute("alt", alt)}>{mark}</div>'
            f"<figcaption>{text(caption)}</figcaption></figure>\n")


def png_uri(png: bytes) -> str:
    return "data:image/png;base64," + base64.b64encode(png).decode()


def data_block(name: str, value: Any) -> str:
    """JSON that a page keeps: < and & occur only in its texts, where a number can stand for them."""
    words = json.dumps(value, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    words = words.replace("<", "\\u003c").replace("&", "\\u0026")
    return f'<script type="application/json" id="{text(name)}">{words}</script>\n'


def document(title: str, body: str) -> str:
    """The whole page, which loads nothing and runs nothing."""
    def rules(theme: int) -> str:
        return "".join(f"--{name}:{pair[theme]};" for name, pair in COLORS.items())
    style = (pathlib.Path(__file__).parent / "report.css").read_text(encoding="utf-8")
    return (f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
            f'<meta http-equiv="Content-Security-Policy"{attribute("content", _POLICY)}>\n'
            '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
            '<meta name="color-scheme" content="light dark">\n<link rel="icon" href="data:,">\n'
            f"<title>{text(title)}</title>\n<style>\n:root{{color-scheme:light dark;{rules(0)}}}\n"
            f"@media screen and (prefers-color-scheme:dark){{:root{{{rules(1)}}}}}\n{style}</style>\n</head>\n"
            f"<body>\n{body}</body>\n</html>\n")

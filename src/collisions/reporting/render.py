"""What a report is made of, and how it becomes Markdown, or one HTML file that needs nothing from outside and prints well."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape
from itertools import groupby
from typing import TypeAlias

RECORD = "collisions-record"
_STYLE = """\
body { font: 10.5pt/1.4 Georgia, "Times New Roman", serif; color: #1a1a1a; max-width: 48em; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.6em; margin: 0 0 .3em; }
h2 { font-size: 1.15em; margin: 1.2em 0 .3em; border-bottom: 1px solid #6a6a6a; break-after: avoid; }
p, ul { margin: .4em 0; overflow-wrap: anywhere; }
ul { padding-left: 1.3em; }
.stressed { font-weight: bold; border: 2px solid #a01040; padding: .4em .6em; }
.tables { columns: 20em 2; column-gap: 2em; margin: .4em 0; }
.tables > div { break-inside: avoid; }
table { border-collapse: collapse; width: 100%; font-size: .92em; margin-bottom: .6em; }
caption { text-align: left; font-weight: bold; padding-bottom: .1em; overflow-wrap: anywhere; }
th, td { text-align: left; vertical-align: top; padding: .1em .5em .1em 0; border-bottom: 1px solid #d0d0d0; }
th { font-weight: normal; width: 55%; }
td { font-variant-numeric: tabular-nums; overflow-wrap: anywhere; }
figure { margin: .8em 0; max-width: 38em; break-inside: avoid; }
figcaption { font-size: .92em; }
svg { display: block; max-width: 100%; height: auto; }
svg * { stroke-linejoin: round; stroke-linecap: butt; }
pre { font-size: 8.5pt; line-height: 1.3; white-space: pre-wrap; overflow-wrap: anywhere; }
@page { size: A4; margin: 15mm; }
@media print {
  body { font-size: 9pt; max-width: none; margin: 0; padding: 0; }
  details pre { display: none; }
}
"""
FENCE = "```json\n"
_MARKS = re.compile(r"([\\`*_{}\[\]<>$|#~&])")
# What would begin a list or underline a line at the start of one.
_START = re.compile(r"^(\d*)([-+=.)])")
# Signs that join letters; what else has no shape of its own could make a line read as another.
_JOINERS = "\u200c\u200d"


@dataclass(frozen=True, slots=True)
class Heading:
    """The heading of a part; ``level`` 1 is the title."""

    text: str
    level: int = 2


@dataclass(frozen=True, slots=True)
class Paragraph:
    """A sentence or more; ``stressed`` if it must not be read over."""

    text: str
    stressed: bool = False


@dataclass(frozen=True, slots=True)
class Table:
    """Rows of what it is of, the quantity, and its value."""

    head: tuple[str, str, str]
    rows: tuple[tuple[str, str, str], ...]


@dataclass(frozen=True, slots=True)
class Items:
    """A list, each line with what it begins with, which may be nothing."""

    lines: tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class Picture:
    """A figure as SVG, and what it shows."""

    caption: str
    svg: str


@dataclass(frozen=True, slots=True)
class Working:
    """The derivation: Markdown with LaTeX, or plain text."""

    text: str


@dataclass(frozen=True, slots=True)
class Record:
    """What the report can be made again from, as JSON."""

    text: str


Block: TypeAlias = Heading | Paragraph | Table | Items | Picture | Working | Record


def plain(text: str) -> str:
    """A text that somebody gave, in one line and without signs that cannot be seen."""
    return visible(" ".join(text.split()))


def visible(text: str) -> str:
    """A text of one line or more with a mark in place of each sign that cannot be seen."""
    hidden = {sign for sign in set(text) if unicodedata.category(sign)[0] == "C" and sign not in _JOINERS + "\n"}
    return "".join("\ufffd" if sign in hidden else sign for sign in text)


def html(blocks: Sequence[Block], version: str) -> str:
    """The whole file."""
    title = next(block.text for block in blocks if isinstance(block, Heading))
    lines = [
        "<!DOCTYPE html>",
        '<html lang="en">',
        "<head>",
        '<meta charset="utf-8">',
        """<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'">""",
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f'<meta name="generator" content="collisions {escape(version)}">',
        f"<title>{escape(title)}</title>",
        f"<style>\n{_STYLE}</style>",
        "</head>",
        "<body>",
        *(line for block in blocks for line in _html(block)),
        "</body>",
        "</html>",
    ]
    return "\n".join(lines) + "\n"


def _html(block: Block) -> Iterator[str]:
    match block:
        case Heading(text, level):
            yield f"<h{level}>{escape(text)}</h{level}>"
        case Paragraph(text, stressed):
            yield f'<p class="stressed">{escape(text)}</p>' if stressed else f"<p>{escape(text)}</p>"
        case Table():
            yield from _tables(block)
        case Items(lines):
            yield "<ul>"
            for strong, text in lines:
                yield f"<li><strong>{escape(strong)}</strong> {escape(text)}</li>" if strong else f"<li>{escape(text)}</li>"
            yield "</ul>"
        case Picture(caption, svg):
            yield "<figure>"
            yield svg
            yield f"<figcaption>{escape(caption)}</figcaption>"
            yield "</figure>"
        case Working(text):
            yield f"<pre>{escape(text)}</pre>"
        case Record(text):
            yield "<details>"
            yield "<summary>Record with all digits (not printed)</summary>"
            yield f'<pre id="{RECORD}">{escape(text)}</pre>'
            yield "</details>"


def _tables(table: Table) -> Iterator[str]:
    """One table for each of what the rows are of, side by side where there is room."""
    yield '<div class="tables">'
    for of, rows in groupby(table.rows, key=lambda row: row[0]):
        yield "<div><table>"
        yield f"<caption>{escape(of)}</caption>"
        yield "<tbody>"
        for _, quantity, value in rows:
            yield f'<tr><th scope="row">{escape(quantity)}</th><td>{escape(value)}</td></tr>'
        yield "</tbody>"
        yield "</table></div>"
    yield "</div>"


def markdown(blocks: Sequence[Block]) -> str:
    """The whole page."""
    return "\n\n".join(_markdown(block) for block in blocks) + "\n"


def _markdown(block: Block) -> str:
    match block:
        case Heading(text, level):
            return f"{'#' * level} {_escaped(text)}"
        case Paragraph(text, stressed):
            return f"**{_escaped(text)}**" if stressed else _line(text)
        case Table(head, rows):
            lines = [head, *rows]
            shown = [f"| {' | '.join(map(_escaped, line))} |" for line in lines]
            return "\n".join([shown[0], "| --- | --- | --- |", *shown[1:]])
        case Items(lines):
            return "\n".join(
                f"- **{_escaped(strong)}** {_escaped(text)}" if strong else f"- {_line(text)}" for strong, text in lines
            )
        case Picture(caption, _):
            return _line(caption)
        case Working(text):
            return text.rstrip("\n")
        case Record(text):
            return f"{FENCE}{text}\n```"


def _escaped(text: str) -> str:
    return _MARKS.sub(r"\\\1", text)


def _line(text: str) -> str:
    return _START.sub(r"\1\\\2", _escaped(text))

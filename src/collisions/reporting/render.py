"""``Html`` and ``Markdown``: the output formats of a report. The HTML is one
self-contained file.
"""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import TypeAlias

from ..derivation.expressions import System
from ..derivation.page import HEAD, Page
from ..quantities.formatting import SI_UNITS, number_with_unit, typeset
from ..quantities.units import with_symbol

RECORD = "collisions-record"
_STYLE = """\
body { font: 12pt/1.4 Georgia, "Times New Roman", serif; color: #1a1a1a; max-width: 48em; margin: \
2em auto; padding: 0 1em; }
h1 { font-size: 1.6em; margin: 0 0 .3em; }
h2 { font-size: 1.15em; margin: 1.2em 0 .3em; border-bottom: 1px solid #6a6a6a; break-after: \
avoid; }
p, ul { margin: .4em 0; overflow-wrap: anywhere; }
ul { padding-left: 1.3em; }
.stressed { font-weight: bold; border: 2px solid #a01040; padding: .4em .6em; }
.tables { columns: 20em 2; column-gap: 2em; margin: .4em 0; }
.tables > div { break-inside: avoid; }
table { border-collapse: collapse; width: 100%; font-size: .92em; margin-bottom: .6em; }
caption { text-align: left; font-weight: bold; padding-bottom: .1em; overflow-wrap: anywhere; }
th, td { text-align: left; vertical-align: top; padding: .1em .5em .1em 0; border-bottom: 1px \
solid #d0d0d0; }
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
# Characters that start a list or underline the line above when they begin a line.
_START = re.compile(r"^(\d*)([-+=.)])")
# Joiners, which some scripts need; other invisible characters could change how a line reads.
_JOINERS = "\u200c\u200d"
_AS_PRINTED = 1e-9  # relative: a number this near to its six figures is shown by them
# numbers with no more digits are shown in full, as somebody typed them; the record has all digits
# of the others
_DIGITS = 12


def plain(text: str) -> str:
    """A user's text in one line and without invisible characters."""
    return visible(" ".join(text.split()))


def visible(text: str) -> str:
    """A text with a visible mark in place of each invisible character."""
    shown_as_is = _JOINERS + "\n"
    hidden = [s for s in set(text) if unicodedata.category(s)[0] == "C" and s not in shown_as_is]
    return text.translate(dict.fromkeys(map(ord, hidden), "\ufffd")) if hidden else text


class Printed(System):
    """Formats numbers with units as on a printed page."""

    typeset = True


class _Sheet(Page):
    """A derivation page with what both forms of a report have in common."""

    def __init__(
        self, units: str, deviations: Mapping[str, float], ranges: Mapping[str, tuple[float, float]]
    ) -> None:
        super().__init__(Printed(units), False, deviations, ranges)
        # Apart from ``parts``, to which equations are written: a report has those in its derivation
        # alone.
        self.blocks: list[str] = []

    def name(self, text: str) -> str:
        return plain(text)

    def as_given(self, value: float | None, kind: str, text: str | None) -> str:
        """A number in the units of the page, and how it was given; if not as a text, with all the
        digits that were typed.
        """
        if value is None:
            return f"given as {typeset(with_symbol(plain(text or '')))}"
        number = self.number(value, kind)
        if text is not None:
            return given_as(number, text)
        if not math.isfinite(value) or abs(float(f"{value:.{_DIGITS}g}") - value) > 1e-15 * abs(
            value
        ):
            return number
        printed = float(number.removesuffix(self.system.unit(kind)))
        if abs(printed - value * self.system.scale(kind)) <= _AS_PRINTED * abs(printed):
            return number
        return f"{number}, exactly {number_with_unit(f'{value:.{_DIGITS}g}', SI_UNITS[kind])}"

    def listed(self, lines: Sequence[str]) -> None:
        self.items([("", line) for line in lines])

    def items(self, lines: Sequence[tuple[str, str]]) -> None:
        """A list of items, each with a lead-in that may be empty."""
        raise NotImplementedError


def given_as(value: str, text: str) -> str:
    """A number as it is printed, and as it was given; not if it has the digits of a conversion,
    which nobody types.
    """
    given = typeset(with_symbol(plain(text)))
    digits = max(
        len(number.replace(".", "").lstrip("0")) for number in ["", *re.findall(r"\d*\.?\d+", text)]
    )
    return value if given == value or digits > _DIGITS else f"{value}, given as {given}"


class Html(_Sheet):
    """One HTML file."""

    def title(self, text: str) -> None:
        self._title = escape(text)
        self.blocks.append(f"<h1>{self._title}</h1>")

    def heading(self, text: str) -> None:
        self.blocks.append(f"<h2>{escape(text)}</h2>")

    def say(self, text: str) -> None:
        self.blocks.append(f"<p>{escape(text)}</p>")

    def stress(self, text: str) -> None:
        self.blocks.append(f'<p class="stressed">{escape(text)}</p>')

    def table(self, rows: Iterable[tuple[str, str, str]]) -> None:
        """One table per subject of the rows, side by side where there is room."""
        lines = ['<div class="tables">']
        subjects: dict[str, list[tuple[str, str, str]]] = {}
        for row in rows:
            subjects.setdefault(row[0], []).append(row)
        for of, parts in subjects.items():
            lines += ["<div><table>", f"<caption>{escape(of)}</caption>", "<tbody>"]
            lines += [
                f'<tr><th scope="row">{escape(what)}</th><td>{escape(value)}</td></tr>'
                for _, what, value in parts
            ]
            lines += ["</tbody>", "</table></div>"]
        self.blocks += [*lines, "</div>"]

    def items(self, lines: Sequence[tuple[str, str]]) -> None:
        starts = [f"<strong>{escape(start)}</strong> " if start else "" for start, _ in lines]
        texts = [
            f"<li>{start}{escape(text)}</li>"
            for start, (_, text) in zip(starts, lines, strict=True)
        ]
        self.blocks += ["<ul>", *texts, "</ul>"]

    def picture(self, caption: str, svg: str) -> None:
        """A figure as SVG, with its caption."""
        self.blocks += ["<figure>", svg, f"<figcaption>{escape(caption)}</figcaption>", "</figure>"]

    def working(self, text: str) -> None:
        self.blocks.append(f"<pre>{escape(text)}</pre>")

    def record(self, text: str) -> None:
        summary = "<summary>Record with all digits (not printed)</summary>"
        self.blocks += [
            "<details>",
            summary,
            f'<pre id="{RECORD}">{escape(text)}</pre>',
            "</details>",
        ]

    def whole(self, version: str) -> str:
        lines = [
            "<!DOCTYPE html>",
            '<html lang="en">',
            "<head>",
            '<meta charset="utf-8">',
            """<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src \
'unsafe-inline'">""",
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            f'<meta name="generator" content="collisions {escape(version)}">',
            f"<title>{self._title}</title>",
            f"<style>\n{_STYLE}</style>",
            "</head>",
            "<body>",
            *self.blocks,
            "</body>",
            "</html>",
        ]
        return "\n".join(lines) + "\n"


class Markdown(_Sheet):
    """Markdown, whose figures are left to the HTML form."""

    def title(self, text: str) -> None:
        self.blocks.append(f"# {_escaped(text)}")

    def heading(self, text: str) -> None:
        self.blocks.append(f"## {_escaped(text)}")

    def say(self, text: str) -> None:
        self.blocks.append(_line(text))

    def stress(self, text: str) -> None:
        self.blocks.append(f"**{_escaped(text)}**")

    def table(self, rows: Iterable[tuple[str, str, str]]) -> None:
        first, *lines = (f"| {' | '.join(map(_escaped, row))} |" for row in (HEAD, *rows))
        self.blocks.append("\n".join([first, "| --- | --- | --- |", *lines]))

    def items(self, lines: Sequence[tuple[str, str]]) -> None:
        texts = (
            f"**{_escaped(start)}** {_escaped(text)}" if start else _line(text)
            for start, text in lines
        )
        self.blocks.append("\n".join(f"- {text}" for text in texts))

    def working(self, text: str) -> None:
        """Below a heading of the report, without the title."""
        self.blocks.append(text.replace("\n## ", "\n### ").partition("\n")[2].strip("\n"))

    def record(self, text: str) -> None:
        self.blocks.append(f"{FENCE}{text}\n```")

    def whole(self, version: str) -> str:
        return "\n\n".join(self.blocks) + "\n"


Sheet: TypeAlias = Html | Markdown


def _escaped(text: str) -> str:
    return _MARKS.sub(r"\\\1", text)


def _line(text: str) -> str:
    return _START.sub(r"\1\\\2", _escaped(text))

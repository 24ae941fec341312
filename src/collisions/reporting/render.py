"""``Html`` and ``Markdown``: the output formats of a report. The HTML is one
self-contained file.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import TypeAlias

from ..derivation.expressions import System
from ..derivation.page import HEAD, Page
from ..quantities.formatting import SI_UNITS, number_with_unit, typeset
from ..quantities.printed_tables import Part, in_html, in_markdown
from ..quantities.units import with_symbol
from ..quantities.user_text import plain
from .mathml import mathml

RECORD = "collisions-record"
_STYLE = """\
body { font: 12pt/1.4 Georgia, "Times New Roman", serif; color: #1a1a1a; max-width: 54em; margin: \
2em auto; padding: 0 1em; }
h1 { font-size: 1.6em; margin: 0 0 .2em; }
h2 { font-size: 1.15em; margin: 1.2em 0 .3em; border-bottom: 1px solid #6a6a6a; }
h3 { font-size: 1em; margin: 1em 0 .2em; }
h4 { font-size: .95em; font-style: italic; margin: .8em 0 .2em; }
h1, h2, h3, h4 { break-after: avoid; overflow-wrap: anywhere; }
p, ul { margin: .4em 0; overflow-wrap: anywhere; orphans: 3; widows: 3; }
ul { padding-left: 1.3em; }
li { break-inside: avoid; }
.filed { margin: 0 0 .6em; color: #444; }
.stressed { font-weight: bold; border: 2px solid #a01040; padding: .4em .6em; }
.answer { display: flex; flex-wrap: wrap; gap: 1em; align-items: flex-start; border: 2px solid \
#1a1a1a; padding: .7em 1em; margin: .6em 0 1em; }
.answer > div { flex: 1.15 1 20em; min-width: 0; }
.answer > figure { flex: 1 1 17em; margin: 0; min-width: 0; }
.answer h2 { border: 0; margin: 0 0 .2em; }
.answer table { font-size: 1em; }
.answer th { width: 55%; }
.answer td { font-weight: bold; white-space: nowrap; }
.answer p, .answer li { font-size: .92em; }
.tables { margin: .4em 0; }
.tables > .wide { break-inside: avoid; }
table { border-collapse: collapse; width: 100%; font-size: .92em; margin-bottom: .6em; }
caption { text-align: left; font-weight: bold; padding-bottom: .1em; overflow-wrap: anywhere; }
tr { break-inside: avoid; }
tr:nth-child(-n+2) { break-after: avoid; }
tr:nth-last-child(-n+2) { break-before: avoid; }
th, td { text-align: left; vertical-align: top; padding: .1em .5em .1em 0; border-bottom: 1px \
solid #d0d0d0; overflow-wrap: anywhere; }
th { font-weight: normal; width: 40%; }
.both table { table-layout: fixed; }
.both thead td { width: 40%; }
thead th { font-weight: bold; width: auto; }
.columns thead td { width: 30%; }
td { font-variant-numeric: tabular-nums; }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(22em, 1fr)); gap: 1em \
2em; }
figure { margin: .6em 0; max-width: 38em; break-inside: avoid; }
figcaption { font-size: .92em; }
.figures > figure { max-width: 32em; }
svg { display: block; max-width: 100%; height: auto; }
svg * { stroke-linejoin: round; stroke-linecap: butt; }
.line { margin: .2em 0 .6em 1.5em; break-inside: avoid; overflow: auto hidden; }
p:has(+ .line), p:has(+ ul), p:has(+ .tables), summary { break-after: avoid; }
.line mtd { text-align: left; padding: .2em .1em; }
.line mtd:first-child { text-align: right; }
pre { font-size: 8.5pt; line-height: 1.3; white-space: pre-wrap; overflow-wrap: anywhere; }
summary { cursor: pointer; margin: .4em 0; }
@page { margin: 15mm 15mm 18mm; }
@media print {
  body { font-size: 9pt; max-width: none; margin: 0; padding: 0; }
  .answer { flex-wrap: nowrap; }
  .figures { grid-template-columns: 1fr 1fr; gap: .6em 2em; }
  .figures svg { max-height: 84mm; width: auto; }
  summary { list-style: none; }
  details::details-content { content-visibility: visible; block-size: auto; }
  details.record pre, details.screen > :not(summary) { display: none; }
  .line { overflow: visible; }
}
"""
FENCE = "```json\n"
_MARKS = re.compile(r"([\\`*_{}\[\]<>$|#~&])")
# Characters that start a list or underline the line above when they begin a line.
_START = re.compile(r"^(\d*)([-+=.)])")
# A slug is a pound-force times s²/ft: 0.45359237 kg x 9.80665 / 0.3048, both by definition.
_SLUG, _PER_SLUG = "slug*ft**2", 1.0 / (0.45359237 * 9.80665 / 0.3048 * 0.3048**2)
# A subject that is one of the two vehicles, which stand beside each other in one table.
_VEHICLE = re.compile(r"[AB](?= \(|$)")
_COLUMNS = 3  # subjects beside each other
_AS_PRINTED = 1e-9  # relative: a number this near to its six figures is shown by them
# numbers with no more digits are shown in full, as somebody typed them; the record has all digits
# of the others
_DIGITS = 12


class Printed(System):
    """Formats numbers with units as on a printed page; a US yaw inertia in slug·ft², as tables of
    vehicles have it.
    """

    typeset = True

    def label(self, kind: str) -> str:
        return _SLUG if self._is_slug(kind) else super().label(kind)

    def scale(self, kind: str) -> float:
        return _PER_SLUG if self._is_slug(kind) else super().scale(kind)

    def _is_slug(self, kind: str) -> bool:
        return kind == "inertia" and self.name == "us"


class _Sheet(Page):
    """A derivation page with what both forms of a report have in common."""

    def __init__(
        self,
        system: Printed,
        deviations: Mapping[str, float],
        ranges: Mapping[str, tuple[float, float]],
    ) -> None:
        super().__init__(system, False, deviations, ranges)
        # Apart from ``parts``, to which equations are written: a report has those in its derivation
        # alone.
        self.blocks: list[str] = []
        # What stands at the top and in the footer of a print: exhibit, case, author and date.
        self.filed: tuple[str, ...] = ()
        # How many figures stand on the page.
        self.drawn = 0
        # Headings are one level down within a part, and the ids of its figures have a prefix.
        self.level, self.prefix = 2, ""

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

    def columns(self, part: Part) -> None:
        """A table with a column for each thing that is said of its rows."""
        raise NotImplementedError

    def listed(self, lines: Sequence[str]) -> None:
        self.items([("", line) for line in lines])

    def items(self, lines: Sequence[tuple[str, str]]) -> None:
        """A list of items, each with a lead-in that may be empty."""
        raise NotImplementedError

    def subheading(self, text: str) -> None:
        """A heading within a section."""
        self.level += 1
        self.heading(text)
        self.level -= 1

    def begin_part(self, text: str, prefix: str) -> None:
        """Begin the part of one of several results."""
        self.end_parts()
        self.heading(text)
        self.level, self.prefix = 3, prefix

    def end_parts(self) -> None:
        """What follows is of the whole page."""
        self.level, self.prefix = 2, ""

    def open_answer(self) -> None:
        """Begin the box that has the answer."""
        self.heading("Answer")

    def close_answer(self, picture: tuple[str, str] | None) -> None:
        """End the box, with a figure beside it: its caption and SVG."""

    def figures_of_answer(self, rows: Sequence[tuple[str, str]]) -> None:
        """The figures in the box: what each is, and its text."""
        self.items([(f"{what}:", text) for what, text in rows])

    def fold(self, summary: str, printed: bool = True) -> None:
        """Begin what is read on demand, and perhaps not in print."""
        self.say(summary)

    def unfold(self) -> None:
        """End it."""


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

    def file(self, entries: Sequence[tuple[str, str]]) -> None:
        """Exhibit, case, author and date, below the title and in the footer of a print."""
        self.filed = tuple(f"{what}: {text}" for what, text in entries)
        self.blocks.append(f'<p class="filed">{escape(" · ".join(self.filed))}</p>')

    def heading(self, text: str) -> None:
        self.blocks.append(f"<h{self.level}>{escape(text)}</h{self.level}>")

    def say(self, text: str) -> None:
        self.blocks.append(f"<p>{escape(text)}</p>")

    def stress(self, text: str) -> None:
        self.blocks.append(f'<p class="stressed">{escape(text)}</p>')

    def table(self, rows: Iterable[tuple[str, str, str]]) -> None:
        """Both vehicles, or subjects of which the same is said, side by side in one table; any
        other subject in its own.
        """
        subjects: dict[str, list[tuple[str, str]]] = {}
        for of, *row in rows:
            subjects.setdefault(of, []).append((row[0], row[1]))
        lines = ['<div class="tables">']
        for group in _alike(subjects):
            if len(group) > 1 and len(subjects[group[0]]) == 1 and not _VEHICLE.match(group[0]):
                ((what, _),) = subjects[group[0]]
                lines += _within("wide", Part([(of, subjects[of][0][1]) for of in group], what))
                continue
            if len(group) > 1:
                lines += _within("both", _side_by_side(subjects, group))
                continue
            (of,) = group
            lines += _within("wide", Part(subjects[of], of))
        self.blocks += [*lines, "</div>"]

    def columns(self, part: Part) -> None:
        self.blocks += ['<div class="tables">', *_within("columns", part.plain()), "</div>"]

    def open_answer(self) -> None:
        self.blocks += ['<section class="answer">', "<div>"]
        self.heading("Answer")

    def close_answer(self, picture: tuple[str, str] | None) -> None:
        self.blocks.append("</div>")
        if picture is not None:
            self.picture(*picture)
        self.blocks.append("</section>")

    def figures_of_answer(self, rows: Sequence[tuple[str, str]]) -> None:
        self.blocks += in_html(Part(rows))

    def fold(self, summary: str, printed: bool = True) -> None:
        kind = "<details>" if printed else '<details class="screen">'
        self.blocks += [kind, f"<summary>{escape(summary)}</summary>"]

    def unfold(self) -> None:
        self.blocks.append("</details>")

    def items(self, lines: Sequence[tuple[str, str]]) -> None:
        starts = [f"<strong>{escape(start)}</strong> " if start else "" for start, _ in lines]
        texts = [
            f"<li>{start}{escape(text)}</li>"
            for start, (_, text) in zip(starts, lines, strict=True)
        ]
        self.blocks += ["<ul>", *texts, "</ul>"]

    def picture(self, caption: str, svg: str) -> None:
        """A figure as SVG, with its number and caption."""
        self.drawn += 1
        text = escape(f"Figure {self.drawn}. {caption}")
        self.blocks += ["<figure>", svg, f"<figcaption>{text}</figcaption>", "</figure>"]

    def working(self, text: str) -> None:
        """The Markdown of a derivation, below a heading of the report: its title is left out."""
        blocks = text.partition("\n")[2].strip().split("\n\n")
        self.blocks += [_as_html(block, self.level + 1) for block in blocks]

    def record(self, text: str) -> None:
        summary = "<summary>Record with all digits (not printed)</summary>"
        self.blocks += [
            '<details class="record">',
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
            f"<style>\n{_STYLE}{_footer(self.filed)}</style>",
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

    def file(self, entries: Sequence[tuple[str, str]]) -> None:
        """Exhibit, case, author and date, below the title."""
        self.blocks.append(_line(" · ".join(f"{what}: {text}" for what, text in entries)))

    def heading(self, text: str) -> None:
        self.blocks.append(f"{'#' * self.level} {_escaped(text)}")

    def say(self, text: str) -> None:
        self.blocks.append(_line(text))

    def stress(self, text: str) -> None:
        self.blocks.append(f"**{_escaped(text)}**")

    def table(self, rows: Iterable[tuple[str, str, str]]) -> None:
        self.blocks.append(in_markdown(Part(list(rows), columns=HEAD), _escaped))

    def columns(self, part: Part) -> None:
        heads = part.columns or ("value",)
        self.blocks.append(in_markdown(part.plain()._replace(columns=("of", *heads)), _escaped))

    def items(self, lines: Sequence[tuple[str, str]]) -> None:
        texts = (
            f"**{_escaped(start)}** {_escaped(text)}" if start else _line(text)
            for start, text in lines
        )
        self.blocks.append("\n".join(f"- {text}" for text in texts))

    def working(self, text: str) -> None:
        """Below a heading of the report, without the title."""
        self.blocks.append(
            text.replace("\n## ", f"\n{'#' * (self.level + 1)} ").partition("\n")[2].strip("\n")
        )

    def record(self, text: str) -> None:
        self.blocks.append(f"{FENCE}{text}\n```")

    def whole(self, version: str) -> str:
        return "\n\n".join(self.blocks) + "\n"


Sheet: TypeAlias = Html | Markdown


def _as_html(block: str, level: int) -> str:
    """A heading, formula, table, list or paragraph of a derivation in HTML."""
    if block.startswith("## "):
        return f"<h{level}>{_inline(block[3:])}</h{level}>"
    if block.startswith("$$"):
        return f'<div class="line">{mathml(block.strip("$"))}</div>'
    lines = block.split("\n")
    if block.startswith("- "):
        return "\n".join(["<ul>", *(f"<li>{_inline(line[2:])}</li>" for line in lines), "</ul>"])
    if block.startswith("| "):
        rows = [re.split(r"(?<!\\) \| ", line[2:-2]) for line in lines[2:]]
        cells = ("".join(f"<td>{_inline(part)}</td>" for part in row) for row in rows)
        return "\n".join(
            ["<table><tbody>", *(f"<tr>{row}</tr>" for row in cells), "</tbody></table>"]
        )
    if block.startswith("**"):
        return f'<p class="stressed">{_inline(block.strip("*"))}</p>'
    return f"<p>{_inline(block)}</p>"


def _inline(text: str) -> str:
    """A sentence of a derivation, with the symbols between dollar signs as formulas."""
    parts = re.split(r"(?<!\\)\$", text)
    return "".join(
        mathml(part) if at % 2 else escape(re.sub(r"\\(.)", r"\1", part))
        for at, part in enumerate(parts)
    )


def _alike(subjects: Mapping[str, Sequence[tuple[str, str]]]) -> list[list[str]]:
    """The subjects of each table: both vehicles, and up to three of which the same is said."""
    groups: list[list[str]] = []
    for of, rows in subjects.items():
        told = [what for what, _ in rows]
        for group in groups:
            same = told == [what for what, _ in subjects[group[0]]]
            vehicles = all(_VEHICLE.match(one) for one in (of, *group))
            if (same and (len(group) < _COLUMNS or len(told) == 1)) or vehicles:
                group.append(of)
                break
        else:
            groups.append([of])
    return [sorted(group) if _VEHICLE.match(group[0]) else group for group in groups]


def _within(kind: str, part: Part) -> list[str]:
    """A table in a box that the style sheet lays out."""
    first, *lines, last = in_html(part)
    return [f'<div class="{kind}">{first}', *lines, f"{last}</div>"]


def _side_by_side(subjects: Mapping[str, Sequence[tuple[str, str]]], group: Sequence[str]) -> Part:
    """The rows of several subjects in one table, each quantity once."""
    columns = [dict(subjects[of]) for of in group]
    told = dict.fromkeys(what for of in group for what, _ in subjects[of])
    rows = [(what, *(column.get(what, "") for column in columns)) for what in told]
    return Part(rows, columns=tuple(group))


def _footer(filed: Sequence[str]) -> str:
    """The style of the print's footer: what the page is filed under, and the page number."""
    text = "".join(f"\\{ord(letter):06x}" for letter in " · ".join(filed))
    return (
        '@page { @bottom-left { content: "'
        + text
        + '"; font: 8pt Georgia, serif; } @bottom-right { content: "Page " counter(page) " of " '
        "counter(pages); font: 8pt Georgia, serif; } }\n"
    )


def _escaped(text: str) -> str:
    return _MARKS.sub(r"\\\1", text)


def _line(text: str) -> str:
    return _START.sub(r"\1\\\2", _escaped(text))

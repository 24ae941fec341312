"""``Part``: rows under a heading and names of columns, and the printers of tables of them: as plain
text, in Markdown and in HTML.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from itertools import repeat, zip_longest
from typing import NamedTuple

from .user_text import plain

PAGE = 88  # characters of a line of a plain table
_LEAST = 24  # and at least of its longest column
_SHORT = 30  # characters of a cell that is a number, and not a sentence


class Part(NamedTuple):
    """Rows, each of a label and its cells, under a heading and the names of the columns; a folded
    one is for notebooks only.
    """

    rows: Sequence[tuple[str, ...]]
    heading: str = ""
    columns: tuple[str, ...] = ()
    folded: bool = False

    def plain(self) -> Part:
        """The same without what a name of a vehicle could change of how a line reads."""
        rows = [tuple(map(plain, row)) for row in self.rows]
        return Part(rows, plain(self.heading), tuple(map(plain, self.columns)), self.folded)


def aligned(parts: Sequence[Part]) -> list[str]:
    """The lines of a plain table of several parts, whose numbers stand below each other; one with
    sentences in it has columns of its own.
    """
    wide = {
        id(part)
        for part in parts
        if any(len(cell) > _SHORT for row in part.rows for cell in row[1:])
    }
    rows = {
        id(part): [
            ("  " * bool(part.heading or part.columns) + row[0], *row[1:]) for row in part.rows
        ]
        for part in parts
    }
    narrow = [part for part in parts if id(part) not in wide]
    widths = _widths(
        [row for part in narrow for row in rows[id(part)]]
        + [("", *part.columns) for part in narrow]
    )
    lines: list[str] = []
    columns: tuple[str, ...] = ()
    for part in parts:
        numbers = id(part) not in wide
        own = widths if numbers else _widths([*rows[id(part)], ("", *part.columns)])
        named = part.columns if part.columns != columns else ()
        columns = part.columns or columns
        if named or part.heading:
            lines += _line((part.heading, *named), own, numbers)
        for row in rows[id(part)]:
            lines += _line(row, own, numbers)
    return lines


def ruled(part: Part) -> str:
    """A plain table with a line below the names of its columns."""
    widths = [max(map(len, column)) for column in zip(part.columns, *part.rows, strict=True)]
    rule = tuple("-" * width for width in widths)
    padded = (
        (cell.ljust(width) for cell, width in zip(row, widths, strict=True))
        for row in (part.columns, rule, *part.rows)
    )
    return "\n".join("  ".join(row).rstrip() for row in padded)


def in_markdown(part: Part, written: Callable[[str], str] = str, sides: Sequence[str] = ()) -> str:
    """A table in Markdown; ``written`` escapes a cell, and ``sides`` has for each column "---", or
    "---:" for numbers.
    """
    rules = sides or ["---"] * len(part.columns)
    rows = (map(written, row) for row in (part.columns, *part.rows))
    head, *lines = (f"| {' | '.join(row)} |" for row in rows)
    return "\n".join([head, f"| {' | '.join(rules)} |", *lines])


_LONG_PATH = re.compile(r"[\w.\[\]]{20,}")


def _between_parts(path: re.Match[str]) -> str:
    return path_parted(path[0], "<wbr>")


def path_parted(path: str, mark: str) -> str:
    """A path such as impacts[0].energy_loss with a mark where it may break: at dots, if it has
    any, and else at underscores.
    """
    return re.sub(r"(?<=\.)(?=\w)" if "." in path else r"(?<=_)(?=\w)", mark, path)


def in_html(part: Part, of_table: str = "") -> list[str]:
    """The lines of a table in HTML that a style sheet lays out: the heading as its caption, the
    first cell of each row as its head.
    """
    from html import escape

    caption = [f"<caption>{escape(part.heading)}</caption>"] if part.heading else []
    # A path too long for its column breaks between its parts rather than within a word.
    heads = "".join(
        f'<th scope="col">{_LONG_PATH.sub(_between_parts, escape(name))}</th>'
        for name in part.columns
    )
    names = [f"<thead><tr><td></td>{heads}</tr></thead>"] if part.columns else []
    rows = [html_row(*row) for row in part.rows]
    return [f"<table{of_table}>", *caption, *names, "<tbody>", *rows, "</tbody>", "</table>"]


def html_row(
    head: str,
    *cells: str,
    of_head: str = ' scope="row"',
    of_cells: Iterable[str] = repeat(""),
    tag: str = "td",
) -> str:
    """A row in HTML, with these attributes of its head and of each cell."""
    from html import escape

    texts = "".join(
        f"<{tag}{own}>{escape(cell)}</{tag}>" for own, cell in zip(of_cells, cells, strict=False)
    )
    return f"<tr><th{of_head}>{escape(head)}</th>{texts}</tr>"


def in_notebook(title: str, parts: Sequence[Part], notes: Iterable[str]) -> list[str]:
    """Tables with their notes in HTML without a style sheet; folded parts below them."""
    from html import escape

    shown = [part for part in parts if not part.folded]
    span = max((len(row) for part in shown for row in part.rows), default=2)
    found = [_styled(title, shown, span) if shown else f"<p>{escape(title)}</p>"]
    found += [f"<p style='font-size:smaller;margin:.3em 0'>{escape(note)}</p>" for note in notes]
    for part in parts:
        if part.folded:
            inside = _styled("", [part._replace(heading="")], 2)
            found.append(f"<details><summary>{escape(part.heading)}</summary>{inside}</details>")
    return found


def _styled(title: str, parts: Sequence[Part], span: int) -> str:
    """One HTML table of several parts, as wide as the widest, with a style at every cell."""
    from html import escape

    lines = [f"<table>{f'<caption>{escape(title)}</caption>' if title else ''}<tbody>"]
    columns: tuple[str, ...] = ()
    for part in parts:
        # Columns of numbers are aligned at the right and never broken, those with sentences in them
        # at the left.
        longest = [
            max(map(len, column))
            for column in zip_longest(*(row[1:] for row in part.rows), fillvalue="")
        ]
        short = "text-align:right;white-space:nowrap" if not part.folded else "text-align:left"
        styles = [
            f" style='{short if most <= _SHORT else 'text-align:left'};padding-left:1em'"
            for most in longest
        ]
        if part.heading or part.columns != columns:
            heads = part.columns if part.columns != columns else ()
            columns = part.columns
            rest = "" if heads else f" colspan='{span}'"
            if part.heading or heads:
                left = f" style='text-align:left'{rest}"
                lines.append(
                    html_row(part.heading, *heads, of_head=left, of_cells=styles, tag="th")
                )
        label = " style='text-align:left;font-weight:normal'"
        lines += [html_row(*row, of_head=label, of_cells=styles) for row in part.rows]
    return "".join([*lines, "</tbody></table>"])


def _widths(rows: Sequence[tuple[str, ...]]) -> list[int]:
    most = max((len(row) for row in rows), default=0)
    widths = [max([1, *(len(row[i]) for row in rows if len(row) > i)]) for i in range(most)]
    if most > 1:
        at = max(range(1, most), key=widths.__getitem__)
        widths[at] = min(widths[at], max(widths[at] + PAGE - sum(widths) - 2 * (most - 1), _LEAST))
    return widths


def _line(row: tuple[str, ...], widths: Sequence[int], right: bool) -> list[str]:
    """One row of a plain table, in as many lines as its longest cell needs."""
    from textwrap import wrap

    wrapped = [wrap(cell, widths[i]) or [""] if i else [cell] for i, cell in enumerate(row)]
    lines = []
    for at in range(max(map(len, wrapped))):
        parts = [cell[at] if at < len(cell) else "" for cell in wrapped]
        first, *rest = (
            part.rjust(width) if i and right else part.ljust(width)
            for i, (part, width) in enumerate(zip(parts, widths, strict=False))
        )
        lines.append("  ".join([first, *rest]).rstrip())
    return lines

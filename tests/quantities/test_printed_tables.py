"""A table in each form: what a reader of that form, written elsewhere, finds in it."""

import re
from html.parser import HTMLParser

import pytest

from collisions.quantities.printed_tables import (
    Part,
    aligned,
    html_row,
    in_html,
    in_markdown,
    in_notebook,
    ruled,
)

ROWS = [("speed | of A", "14.2 m/s", "<b>"), ("mass", "1500 kg", "a & b")]
PART = Part(ROWS, "Vehicles", ("of", "A", "B"))


class _Read(HTMLParser):
    """The cells of HTML tables, row by row, and the text of their captions."""

    def __init__(self):
        super().__init__()
        self.rows, self.captions, self.inside = [], [], []

    def handle_starttag(self, tag, attrs):
        self.inside.append(tag)
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")

    def handle_endtag(self, tag):
        assert self.inside.pop() == tag

    def handle_data(self, data):
        if self.inside and self.inside[-1] in ("td", "th"):
            self.rows[-1][-1] += data
        if self.inside and self.inside[-1] == "caption":
            self.captions.append(data)


def read(lines):
    """The rows and captions of tables, each tag of which was closed."""
    found = _Read()
    found.feed("".join(lines))
    assert found.inside == []
    return found.rows, found.captions


def test_html_holds_the_rows():
    """With the names of columns above, whatever is in the cells."""
    rows, captions = read(in_html(PART._replace(columns=("A", "B"))))
    assert rows == [["", "A", "B"], *map(list, ROWS)]
    assert captions == ["Vehicles"]
    assert read([html_row("a", "b", "c")])[0] == [["a", "b", "c"]]


def test_a_notebook_has_the_folded_rows_below():
    """All in one table, but those that are read on demand."""
    folded = Part([("vx", "1.5")], "All numbers", folded=True)
    found = in_notebook("Title <1>", [PART._replace(columns=("A", "B")), folded], ["a < b"])
    rows, captions = read(found)
    assert captions == ["Title <1>"]
    assert rows == [["Vehicles", "A", "B"], *map(list, ROWS), ["vx", "1.5"]]
    assert found[1].count("a &lt; b") == 1
    assert "<details><summary>All numbers</summary>" in found[2]


def test_markdown_is_a_table_for_a_reader_of_markdown():
    """As markdown-it reads it, which is what the pages are made with."""
    markdown = pytest.importorskip("markdown_it").MarkdownIt("commonmark").enable("table")
    text = in_markdown(
        PART, lambda cell: re.sub(r"([|<&])", r"\\\1", cell), ("---", "---:", "---:")
    )
    html = markdown.render(text)
    rows, _ = read(re.sub(r"\n", "", html))
    assert rows == [list(PART.columns), *map(list, ROWS)]
    assert html.count("text-align:right") == 6


def test_plain_tables_have_columns_below_each_other():
    """Numbers at the right, texts at the left, and a line of its own below ruled names."""
    lines = aligned([Part([("mass", "1500 kg", "950 kg"), ("x", "1 m", "2 m")], "", ("A", "B"))])
    assert lines == [
        "              A       B",
        "  mass  1500 kg  950 kg",
        "  x         1 m     2 m",
    ]
    assert ruled(Part([("A", "mass", "1500 kg")], columns=("of", "quantity", "value"))) == (
        "of  quantity  value\n--  --------  -------\nA   mass      1500 kg"
    )


@pytest.mark.parametrize(
    ("name", "broken"),
    [
        ("impacts[0].a.delta_v_forward", "impacts[0].<wbr>a.<wbr>delta_v_forward"),
        ("a_very_long_name_without_dots", "a_<wbr>very_<wbr>long_<wbr>name_<wbr>without_<wbr>dots"),
        ("Civic.rest.x", "Civic.rest.x"),
        ("mean ± standard deviation", "mean ± standard deviation"),
    ],
)
def test_a_long_path_over_a_column_breaks_between_its_parts(name, broken):
    """A name that is short, or has spaces to break at, stays as it is."""
    page = "".join(in_html(Part([("mass", "1")], "", (name,))))
    assert f'<th scope="col">{broken}</th>' in page

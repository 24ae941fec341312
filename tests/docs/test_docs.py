"""The pages: each is listed, the glossary names every attribute, and every convention of signs has
its figure.
"""

import ast
import importlib
import importlib.util
import re
import subprocess
import sys
from pathlib import Path

import pytest

import collisions as col
from collisions import Impact, Vehicle
from collisions.impact.pulse import Pulse
from collisions.impact.vehicle_result import VehicleResult
from collisions.quantities.attributes import unit_of

DOCS = Path(__file__).resolve().parent.parent.parent / "docs"
KINDS = {"Impact": Impact, "VehicleResult": VehicleResult, "Vehicle": Vehicle, "Pulse": Pulse}

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not DOCS.is_dir(), reason="only where the docs are"),
]


def page(name):
    """The text of a page."""
    return (DOCS / f"{name}.md").read_text(encoding="utf-8")


def public(kind):
    """Every public attribute and method of a class."""
    return [
        name
        for name in {**dict.fromkeys(dir(kind)), **vars(kind).get("__annotations__", {})}
        if not name.startswith("_")
    ]


@pytest.fixture(scope="module")
def entries():
    """Attributes by class that the glossary's table has a row for, and the names it explains in
    words.
    """
    (terms,) = re.findall(r"^TERMS = (\[.*?^\])", page("glossary"), re.DOTALL | re.MULTILINE)
    rows = [row.elts[2].elts for row in ast.parse(terms, mode="eval").body.elts]
    table = {(kind.id, name.value) for kind, *names in rows for name in names}
    heads = re.findall(r"^(`.*`)\n: ", page("glossary"), re.MULTILINE)
    return table, {name for head in heads for name in re.findall(r"`(\w+)`", head)}


@pytest.mark.parametrize("kind", KINDS)
def test_every_attribute_has_an_entry_in_the_glossary(kind, entries):
    """Whatever carries a unit stands in the table; the rest is explained in words."""
    table, words = entries
    for name in public(KINDS[kind]):
        if unit_of(KINDS[kind], name) is None:
            assert name in words, f"{kind}.{name} has no words in docs/glossary.md"
        else:
            assert (kind, name) in table, f"{kind}.{name} has no row in docs/glossary.md"


def test_the_glossary_names_nothing_that_is_not_there(entries):
    """An attribute that was renamed leaves no entry behind."""
    table, words = entries
    for kind, name in table:
        assert name in public(KINDS[kind]), f"{kind}.{name}"
    for name in words:
        assert any(name in public(kind) for kind in KINDS.values()), name


def test_every_page_is_in_the_index():
    """Pages outside the index are found by nobody."""
    trees = re.findall(
        r"```\{toctree\}\n:hidden:\n:caption: [A-Z][a-z ]+\n\n(.*?)```", page("index"), re.DOTALL
    )
    names = [name for tree in trees for name in tree.split()]
    listed = set(names)
    assert len(names) == len(listed)
    assert listed - {"examples/index"} == {path.stem for path in DOCS.glob("*.md")} - {"index"}


def test_no_page_has_a_table_of_contents_of_its_own():
    """The theme has one beside every page, and prints "ERROR:" in place of another; ``.ci/run``
    looks at the pages built.
    """
    for path in DOCS.glob("*.md"):
        assert not re.search(r"\{contents\}|\.\. contents::", path.read_text(encoding="utf-8")), (
            path.name
        )


def figures():
    """Every figure that a page shows, with the page."""
    return [
        (path.stem, name)
        for path in sorted(DOCS.glob("*.md"))
        for name in re.findall(r"\{figure\} _static/(\S+)", path.read_text(encoding="utf-8"))
    ]


def test_every_figure_is_there_and_every_drawing_of_signs_is_shown():
    """Those of docs/figures.py are committed, and no page asks for another."""
    shown = {name for _, name in figures()}
    for name in shown:
        assert (DOCS / "_static" / name).is_file(), name
    (drawn,) = re.findall(
        r"^FIGURES = \{(.*?)^\}",
        (DOCS / "figures.py").read_text(encoding="utf-8"),
        re.DOTALL | re.MULTILINE,
    )
    assert {f"{name}.svg" for name in re.findall(r'"(\w+)":', drawn)} <= shown


def test_references_between_pages_lead_somewhere():
    """Every page and heading that a page refers to is there."""
    pages = {path.stem: path.read_text(encoding="utf-8") for path in DOCS.glob("*.md")}
    labels = set(re.findall(r"^\(([\w-]+)\)=$", "\n".join(pages.values()), re.MULTILINE))
    examples = {f"examples/{path.stem}" for path in (DOCS.parent / "examples").glob("*.py")} | {
        "examples/index"
    }
    for name, text in pages.items():
        for target in re.findall(r"\{doc\}`(?:[^`<]*<)?([\w/]+)>?`", text):
            assert target in pages or target in examples, f"{name} refers to {target}"
        for target in re.findall(r"\{ref\}`(?:[^`<]*<)?([\w-]+)>?`", text):
            assert target in labels, f"{name} refers to {target}"


def test_every_example_has_its_picture_in_the_gallery():
    """Made by ``python docs/gallery.py``; none is left of an example that is gone."""
    examples = {path.stem for path in (DOCS.parent / "examples").glob("*.py")}
    assert {path.stem for path in (DOCS / "_static" / "gallery").glob("*.png")} == examples


def test_the_page_of_public_names_has_every_module():
    """Its tables are made from ``__all__``; each name says in its first sentence what it is."""
    sys.path.insert(0, str(DOCS / "_ext"))
    try:
        from attributes import names_table
    finally:
        sys.path.remove(str(DOCS / "_ext"))
    (listed,) = re.findall(r"^modules = \((.*)\)$", page("public_names"), re.MULTILINE)
    for name in ast.literal_eval(f"[{listed}]"):
        module = importlib.import_module(f"collisions{name}")
        table = names_table(module)
        for public in module.__all__:
            assert f"`{public}`" in table
        assert "| |" not in table.replace("|  |", "| |"), "a name says nothing of itself"


def too_wide(path):
    """Lines of code of an example or of a page that are shown and over 88 wide."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".py":
        lines = [line for line in text.splitlines() if not line.startswith("#")]
    else:
        blocks = re.findall(
            r"^```(?:\{code-cell\}|python|sh|toml)[^\n]*\n(.*?)^```", text, re.DOTALL | re.MULTILINE
        )
        lines = [
            line for block in blocks if "remove-input" not in block for line in block.splitlines()
        ]
    return [line for line in lines if len(line) > 88]


@pytest.mark.parametrize(
    "path",
    [*sorted(DOCS.glob("*.md")), *sorted((DOCS.parent / "examples").glob("*.py"))],
    ids=lambda path: path.name,
)
def test_code_on_pages_is_at_most_88_wide(path):
    """So that no line wraps or scrolls."""
    assert too_wide(path) == []


@pytest.fixture(scope="module")
def looking():
    """The module ``docs/look.py``."""
    spec = importlib.util.spec_from_file_location("look", DOCS / "look.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize(
    ("body", "fault"),
    [
        ("<p>An offset of 3 m</p>", None),
        ('<div class="cell"><pre>offset = 3  # &lt;table&gt;</pre></div>', None),
        (
            r"<figure><svg><text x='9' y='9'>$\mathdefault{10}$</text></svg></figure>",
            "raw markup: '$\\\\math'",
        ),
        (r"<svg><text x='9' y='9'>\mathdefault{10}</text></svg>", "raw markup: '\\\\mathdefault'"),
        ("<p>&lt;table&gt;&lt;tr&gt;</p>", "raw markup: '<table'"),
        (
            "<div class='cell_output'><div class='output stderr'><pre>\nERROR: no\n"
            "</pre></div></div>",
            "an error in an output: 'ERROR: no'",
        ),
        (
            f"<div class='cell'><pre>a\n{'x' * 400}</pre></div>",
            f"a cell scrolls sideways: {'x' * 400!r}",
        ),
    ],
)
def test_a_page_with_a_fault_is_found_at_fault(body, fault, looking, tmp_path):
    """Each fault is found, and found alone; what only looks like one is not."""
    chromium = looking.browser()
    if chromium is None:
        pytest.skip("needs Chromium")
    style = "<style>pre { overflow: auto; }</style>"
    page = tmp_path / "page.html"
    page.write_text(
        f"<!DOCTYPE html><meta charset='utf-8'>{style}<body>{body}</body>", encoding="utf-8"
    )
    assert looking.look(chromium, page, 800, tmp_path) == ([] if fault is None else [fault])


@pytest.mark.parametrize(
    ("body", "faults"),
    [("<svg></svg>", []), ("", ["has no picture, though its cells draw"])],
    ids=["drawn", "left out"],
)
def test_a_page_of_pictures_without_one_is_at_fault(body, faults, looking, tmp_path):
    """Where another backend than that of notebooks was asked for, the figures were left out."""
    chromium = looking.browser()
    if chromium is None:
        pytest.skip("needs Chromium")
    page = tmp_path / f"{looking.ILLUSTRATED[0]}.html"
    page.write_text(
        f"<!DOCTYPE html><meta charset='utf-8'><body><div class='cell_output'>{body}</div></body>",
        encoding="utf-8",
    )
    assert looking.look(chromium, page, 800, tmp_path) == faults


@pytest.mark.parametrize("times", [1, 2])
def test_a_browser_that_gives_no_answer_is_asked_once_more(
    times, looking, tmp_path, monkeypatch, capsys
):
    """A page that it answers neither time is at fault, by its name."""
    asked = []

    def run(command, **settings):
        asked.append(command)
        if len(asked) <= times:
            raise subprocess.TimeoutExpired(command, settings["timeout"])
        return subprocess.CompletedProcess(
            command,
            0,
            '<pre id="found">{"scrolls":0,"covered":[],"text":"","wide":[],"errors":[]}</pre>',
        )

    monkeypatch.setattr(looking.subprocess, "run", run)
    monkeypatch.setattr(looking, "browser", lambda: "chromium")
    monkeypatch.setattr(looking, "made", lambda folder: [])
    monkeypatch.setattr(looking, "PAGES", ("slow",))
    monkeypatch.setattr(looking, "WIDTHS", (800,))
    assert looking.main(tmp_path) == times - 1
    assert len(asked) == 2
    assert (
        "slow.html at 800 pixels: could not be measured: twice no answer" in capsys.readouterr().out
    ) == (times == 2)


def test_the_readme_says_what_eccentric_errs_by_in_its_crossing():
    """Of the choice between the models, with the figure that it gives."""
    text = " ".join((DOCS.parent / "README.md").read_text("utf-8").split())
    said = re.search(
        r"in the crossing above `eccentric` errs by (\d\.\d) mph, so it is enough for (\d\.\d) mph",
        text,
    )
    a = col.Vehicle(
        mass="3400 lb",
        vx="30 mph",
        yaw_inertia="1770 slug*ft**2",
        x="-6.5 ft",
        y="1.3 ft",
        heading="0 deg",
    )
    b = col.Vehicle(
        mass="2900 lb",
        vy="25 mph",
        yaw_inertia="1250 slug*ft**2",
        x="2.6 ft",
        y="-4 ft",
        heading="90 deg",
    )
    contact = {
        "normal": "0 deg",
        "point": (0.0, 0.0),
        "friction": 0.5,
        "duration": "100 ms",
        "drag": 0.7,
    }
    choice = col.required_model(a, b, 0.1, **contact, tolerance=f"{said.group(2)} mph")
    assert choice.model == "eccentric"
    assert choice.errors.q["eccentric"].to("mph").m == pytest.approx(float(said.group(1)), abs=0.05)

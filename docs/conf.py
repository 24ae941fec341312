"""Sphinx settings. Nothing is fetched while building, and the pages fetch nothing."""

import os
import re
import shutil
import sys
from functools import partialmethod
from pathlib import Path

import jupytext
from nbclient import NotebookClient
from nbformat import NotebookNode

HERE = Path(__file__).parent
ROOT = HERE.parent
SEARCHED = [str(ROOT / "src"), str(HERE / "_ext")]
sys.path[:0] = SEARCHED
# The kernels that run the pages find the same modules.
os.environ["PYTHONPATH"] = os.pathsep.join(
    [*SEARCHED, *filter(None, [os.environ.get("PYTHONPATH")])]
)
# Pages run on the Python that builds them, whatever kernel of that name the machine has.
os.environ["JUPYTER_PATH"] = str(HERE / "_ext" / "jupyter")
os.environ["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"
# Another backend than that of notebooks would leave the figures out.
os.environ.pop("MPLBACKEND", None)

import collisions

project = "collisions"
author = "The collisions developers"
release = version = collisions.__version__

extensions = ["myst_nb", "sphinx.ext.autodoc", "numpydoc", "sphinx_design", "mathml", "attributes"]
exclude_patterns = ["_build", "jupyter_execute", "_ext", "_static", "**/.ipynb_checkpoints"]
nitpicky = True
# Bases outside the package have no page here.
nitpick_ignore = [
    ("py:class", name)
    for name in ("ValueError", "UserWarning", "Exception", "enum.IntEnum", "IntEnum")
]

html_theme = "furo"
html_title = f"collisions {version}"
html_static_path = ["_static"]
html_css_files = ["pages.css"]
html_math_renderer = "mathml"
html_copy_source = False
html_show_copyright = False

myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3

nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 300
nb_merge_streams = True
# Otherwise a line that a slow kernel sends in two pieces is printed as two lines.
NotebookClient.__init__ = partialmethod(NotebookClient.__init__, coalesce_streams=True)
nb_render_markdown_format = "myst"
nb_ipywidgets_js = {}  # would be fetched from elsewhere

autodoc_typehints = "none"
autodoc_member_order = "bysource"
numpydoc_show_class_members = False
numpydoc_class_members_toctree = False


def render_examples(source: Path, target: Path) -> None:
    """Turn every script of the source folder into a notebook of the target folder, with its data
    beside it and a list.
    """
    target.mkdir(exist_ok=True)
    scripts = (
        sorted(path for path in source.glob("*.py") if not path.name.startswith("_"))
        if source.is_dir()
        else []
    )
    wanted = {f"{script.stem}.ipynb" for script in scripts}
    for stale in target.glob("*.ipynb"):
        if stale.name not in wanted:
            stale.unlink()
    told = {}
    for script in scripts:
        notebook = jupytext.read(script, fmt="py:percent")
        for index, cell in enumerate(notebook.cells):
            cell["id"] = f"cell-{index}"  # the same at every build
            if re.match(r"(axes\[.*\]|right|plot|page)\.", cell.source.rpartition("\n")[2]):
                cell.source += ";"  # a picture is shown, and not the name of its axes or file
        fold_checks(notebook)
        notebook.metadata = NotebookNode(
            kernelspec={"name": "python3", "display_name": "Python 3", "language": "python"},
            mystnb={"output_stderr": "warn"},  # an example that warns is none to show
        )
        told[script.stem] = title_and_caption(notebook, script.stem)
        write(target / f"{script.stem}.ipynb", jupytext.writes(notebook, fmt="ipynb"))
    for folder in source.glob("*/"):
        if not folder.name.startswith((".", "_")):
            shutil.copytree(folder, target / folder.name, dirs_exist_ok=True)
    write(target / "index.md", gallery_of(told))


def fold_checks(notebook: NotebookNode) -> None:
    """Fold the cells under the heading of the checks: what teaches stands before it."""
    checks = False
    for cell in notebook.cells:
        checks = checks or cell.source.startswith("## Checks")
        if checks and cell.cell_type == "code":
            cell.metadata["tags"] = ["hide-cell"]


def title_and_caption(notebook: NotebookNode, otherwise: str) -> tuple[str, str]:
    """The first heading of a notebook, and the paragraph under it."""
    title, _, rest = notebook.cells[0].source.partition("\n")
    caption = rest.strip().split("\n\n")[0].replace("\n", " ")
    return (title[2:].strip(), caption) if title.startswith("# ") else (otherwise, "")


# Where an example stands in the gallery; one that is named nowhere stops the build.
GALLERY = {
    "The paper and published cases": (
        "paper_examples",
        "published_solutions",
        "pivoted_vehicle",
        "us_units",
    ),
    "Configurations": (
        "crossroads",
        "eccentric_types",
        "barrier",
        "three_cars",
        "truck_against_car",
        "sideswipe",
        "pole_impact",
        "parked_truck",
    ),
    "From what was found to the speeds before": (
        "example_2_backwards",
        "intersection_reconstruction",
        "in_line_by_momentum_and_ees",
        "pole_from_crush",
        "pole_after_side_impact",
        "chain_of_three",
        "rear_end_from_recorder",
        "two_accounts",
        "two_accounts_of_a_chain",
        "rest_positions",
    ),
    "Many cases": ("million_cases", "table_of_cases", "study_over_processes", "study_with_dask"),
}


def gallery_of(told: dict[str, tuple[str, str]]) -> str:
    """The page that shows the examples: a card each, with a picture where there is one."""
    page = ["# Worked examples", ""]
    if not told:
        return "\n".join([*page, "There are none in this copy of the sources.", ""])
    placed = [stem for stems in GALLERY.values() for stem in stems]
    if sorted(placed) != sorted(told):
        raise ValueError(f"GALLERY in docs/conf.py and examples/ differ: {set(placed) ^ set(told)}")
    page += [
        (
            "Each example is a script in `examples/`, run as these pages were built. It ends with "
            "checks of its answers, which are folded here."
        ),
        (
            "Pictures need the extra `plot`, tables and dask the extra `tools`: in the folder of "
            "the README,"
        ),
        '`pip install ".[plot,tools]"`.',
        "",
    ]
    for group, stems in GALLERY.items():
        page += [f"## {group}", "", "::::{grid} 1 2 2 2", ":gutter: 3", ""]
        for stem in stems:
            title, caption = told[stem]
            picture = HERE / "_static" / "gallery" / f"{stem}.png"
            page += [f":::{{grid-item-card}} {title}", f":link: {stem}", ":link-type: doc"]
            page += (
                [f":img-top: ../_static/gallery/{stem}.png", f":img-alt: {title}"]
                if picture.exists()
                else []
            )
            page += ["", caption, ":::", ""]
        page += ["::::", ""]
    page += ["## As notebooks", "", "The same examples to download:", ""]
    page += [f"- {{download}}`{stem}.ipynb <{stem}.ipynb>`: {told[stem][0]}" for stem in placed]
    page += ["", "```{toctree}", ":hidden:", "", *placed, "```", ""]
    return "\n".join(page)


def write(path: Path, text: str) -> None:
    """Leave a file alone that already says this, so that a second build has less to do."""
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")


render_examples(ROOT / "examples", HERE / "examples")

"""The picture and the list of the page "Architecture", read from the sources while the pages are
built.

``python docs/import_picture.py file.svg`` (or .png) writes the picture alone: rows and columns are
the parts of the package in the order of the import contract in pyproject.toml, the highest layer
first; a dot is an import. Where all imports run down, every dot is above the diagonal, and the grey
squares, which are the layers, are empty.
"""

from __future__ import annotations

import ast
import sys
import tomllib
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "src" / "collisions"

Imports = dict[str, set[str]]


def layers() -> list[list[str]]:
    """The parts of the package by layer of the contract, the highest first."""
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    contract = next(
        c for c in settings["tool"]["importlinter"]["contracts"] if c["type"] == "layers"
    )
    return [[name.strip() for name in layer.split("|")] for layer in contract["layers"]]


def parts() -> dict[str, str]:
    """Every module and folder of the package, with the first line of its docstring."""
    files = {
        path.parent.name if path.stem == "__init__" else path.stem: path
        for path in PACKAGE.glob("*/__init__.py")
    }
    files |= {path.stem: path for path in PACKAGE.glob("*.py") if path.stem != "__init__"}
    return {name: first_line(path) for name, path in sorted(files.items())}


def first_line(path: Path) -> str:
    """What a file says of itself."""
    said = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
    return said.split("\n\n")[0].replace("\n", " ")


def imports() -> Imports:
    """What each part imports of the others when it runs; imports for type checkers alone do not
    count.
    """
    known = parts()
    found: Imports = {name: set() for name in known}
    for path in PACKAGE.rglob("*.py"):
        place = path.relative_to(PACKAGE).with_suffix("").parts
        if place[0] in known:
            found[place[0]] |= {
                name
                for name in _imported(ast.parse(path.read_text(encoding="utf-8")), place)
                if name in known
            }
    return {name: needed - {name} for name, needed in found.items()}


def _imported(node: ast.AST, place: tuple[str, ...]) -> Iterator[str]:
    """The parts that the statements under a node import."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.If) and ast.unparse(child.test) == "TYPE_CHECKING":
            continue
        if isinstance(child, ast.ImportFrom) and child.level == len(place):
            yield from (
                [child.module.split(".")[0]]
                if child.module
                else (alias.name for alias in child.names)
            )
        yield from _imported(child, place)


def listed(name: str) -> str:
    """A part in one line, the files of a package indented below it."""
    folder = PACKAGE / name
    if not folder.is_dir():
        return f"- `{name}.py`: {first_line(PACKAGE / f'{name}.py')}"
    files = sorted(path for path in folder.glob("*.py") if path.stem != "__init__")
    return "\n".join(
        [
            f"- `{name}/`: {parts()[name]}",
            *(f"  - `{name}/{path.name}`: {first_line(path)}" for path in files),
        ],
    )


def whole() -> str:
    """Every file of the package in one line each, the highest layer first."""
    return "\n".join(listed(name) for layer in layers() for name in layer)


def draw(kind: str = "svg") -> bytes:
    """The picture as a file of that kind."""
    import matplotlib as mpl

    mpl.use("agg")
    mpl.rcParams |= {
        "svg.fonttype": "path",
        "svg.hashsalt": "collisions",
        "font.family": "DejaVu Sans",
    }
    import matplotlib.pyplot as plt
    from matplotlib.patches import Rectangle

    found = imports()
    order = [name for layer in layers() for name in layer]
    at = {name: index for index, name in enumerate(order)}
    fig, ax = plt.subplots(figsize=(8.6, 8.2))
    for layer in layers():
        first, count = at[layer[0]], len(layer)
        ax.add_patch(Rectangle((first, first), count, count, fc="#d5d9de", ec="none"))
        ax.plot([0, len(order)], [first, first], color="#d5d9de", lw=0.7, zorder=0)
        ax.plot([first, first], [0, len(order)], color="#d5d9de", lw=0.7, zorder=0)
    for name, row in at.items():
        columns = sorted(at[other] + 0.5 for other in found[name])
        ax.plot(columns, [row + 0.5] * len(columns), "o", color="#1f5fa8", ms=6)
    middles = [index + 0.5 for index in range(len(order))]
    names = [f"{name}/" if (PACKAGE / name).is_dir() else name for name in order]
    ax.set_xticks(middles, names, rotation=90, fontsize=9.5)
    ax.set_yticks(middles, names, fontsize=9.5)
    ax.set(xlim=(0, len(order)), ylim=(len(order), 0), aspect="equal")
    ax.set_ylabel("this part", fontsize=10.5)
    ax.set_xlabel("imports this one", fontsize=10.5)
    ax.xaxis.set_label_position("top")
    ax.tick_params(length=0, top=True, bottom=False, labeltop=True, labelbottom=False)
    ax.spines[:].set_color("#777777")
    file = BytesIO()
    fig.savefig(
        file, format=kind, bbox_inches="tight", metadata={"Date": None} if kind == "svg" else None
    )
    plt.close(fig)
    return file.getvalue()


if __name__ == "__main__":
    target = Path(sys.argv[1])
    target.write_bytes(draw(target.suffix[1:]))

"""The page "Architecture" says what is so: the picture agrees with the import contract, and every
file is on the page.
"""

import importlib.util
import re
from itertools import combinations
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent.parent
SCRIPT = ROOT / "docs" / "import_picture.py"

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not SCRIPT.is_file(), reason="this copy has no documentation"),
]


@pytest.fixture(scope="module")
def picture():
    """The script that draws the picture."""
    spec = importlib.util.spec_from_file_location("import_picture", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_contract_names_every_part_once(picture):
    """Each module and each folder of the package is in one layer, and the layers hold
    nothing else.
    """
    assert sorted(name for layer in picture.layers() for name in layer) == sorted(picture.parts())


def test_imports_run_down(picture):
    """A part imports only from the layers below its own, as the picture shows."""
    found = picture.imports()
    layers = picture.layers()
    for upper, lower in combinations(range(len(layers)), 2):
        for name in layers[lower]:
            assert not found[name] & set(layers[upper]), name
    for layer in layers:
        assert not any(found[name] & set(layer) for name in layer)


def test_the_picture_sees_imports(picture):
    """Absolute, inside a function and of a whole module; what only type checkers import is left
    out.
    """
    found = picture.imports()
    assert found["messages"] == {"kernels"}  # from ..kernels.status import Status
    assert "diagnostics" in found["reporting"]
    assert "engine" in found["impact"]  # inside its functions
    assert found["kernels"] == set()


def test_the_picture_has_a_dot_for_each_import(picture):
    """And it is the same picture when it is drawn again."""
    pytest.importorskip("matplotlib")
    svg = picture.draw().decode()
    dots = re.findall(r'<use xlink:href="#m\w+" x="[\d.]+" y="[\d.]+" style="fill: #1f5fa8', svg)
    assert len(dots) == sum(map(len, picture.imports().values()))
    assert svg == picture.draw().decode()


def test_every_file_is_on_the_page(picture):
    """The list that the page shows names each file of the package, with what it says of itself."""
    page = picture.whole()
    for path in picture.PACKAGE.rglob("*.py"):
        name = path.relative_to(picture.PACKAGE).as_posix()
        if path.stem != "__init__":
            assert f"`{name}`: {picture.first_line(path)}" in page
            assert picture.first_line(path), name


def test_the_page_names_what_is_there():
    """Files that the text of the page points to exist."""
    page = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    named = set(re.findall(r"`((?:[\w.]+/)*[\w.]+\.(?:py|md|toml)|(?:\w+/)+)`", page))
    assert len(named) > 20
    homes = (ROOT, ROOT / "src" / "collisions", ROOT / "tests")
    assert [
        name for name in sorted(named) if not any((home / name).exists() for home in homes)
    ] == []

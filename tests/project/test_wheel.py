"""What is tested is what is installed: one copy of the package, complete, with nothing beside it.

The imports come first, when tests are collected: doctests are found by the path of their source,
and a module that is loaded already is taken from where it is loaded. Where the package is
installed, that is the built wheel.
"""

import importlib
import pkgutil
import re
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

import pytest

import collisions

SOURCE = Path(__file__).resolve().parent.parent.parent / "src" / "collisions"
USED = Path(collisions.__file__).resolve().parent
MODULES = [
    importlib.import_module(found.name)
    for found in pkgutil.walk_packages(collisions.__path__, "collisions.")
]


def installed():
    """The distribution the tests use; skips where they run on the sources."""
    if USED == SOURCE:
        pytest.skip("the package is used from src")
    try:
        return distribution("collisions")
    except PackageNotFoundError:
        pytest.skip("the package is on the path without being installed")


def shipped(folder):
    """Every file of the package in a folder, by its place there."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }


def test_every_module_is_of_one_copy():
    """No module comes from the sources beside an installed package, whichever test
    loaded it first.
    """
    assert len(MODULES) > 100
    assert {Path(module.__file__).resolve().is_relative_to(USED) for module in MODULES} == {True}


def test_doctests_run_on_that_copy(request):
    """Those of this run, whose path in the sources is all that pytest shows."""
    doctests = [item for item in request.session.items if isinstance(item, pytest.DoctestItem)]
    files = {
        Path(item.dtest.globs["__file__"]).resolve()
        for item in doctests
        if "__file__" in item.dtest.globs
    }
    assert all(file.is_relative_to(USED) for file in files)


def test_the_wheel_holds_the_package_whole():
    """The files of the sources, byte for byte, ``py.typed`` among them, and no other."""
    installed()
    used, source = shipped(USED), shipped(SOURCE)
    assert sorted(used) == sorted(source)
    assert "py.typed" in used
    assert [name for name in used if used[name] != source[name]] == [], "install it again"


def test_the_wheel_holds_nothing_else():
    """Beside the package only what describes it."""
    files = [file for file in installed().files or () if "__pycache__" not in file.parts]
    # The command is installed beside Python, outside of the packages.
    roots = {file.parts[0] for file in files if file.name not in ("collisions", "collisions.exe")}
    assert roots == {"collisions", f"collisions-{collisions.__version__}.dist-info"}


def test_what_it_needs_at_run_time_is_numpy_and_pint():
    """Anything else is an extra."""
    needed = [line for line in installed().requires or () if "extra ==" not in line]
    assert sorted(re.match(r"\w+", line)[0] for line in needed) == ["numpy", "pint"]
    assert installed().version == collisions.__version__

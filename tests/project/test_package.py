"""The package itself: runs uninstalled, names what it promises, and type checkers see what callers
write.
"""

import rlcompleter
import subprocess
import sys
from pathlib import Path

import pytest

import collisions as col
from collisions.quantities.attributes import unit_of

ROOT = Path(__file__).parents[2]


def test_public_names():
    """Everything in __all__ is there, and the version is a literal."""
    for name in col.__all__:
        assert hasattr(col, name)
    text = (ROOT / "src/collisions/__init__.py").read_text(encoding="utf-8")
    assert f'__version__ = "{col.__version__}"' in text


def test_names_complete_as_far_as_they_are_public():
    """Of the package nothing but its public names; of ``.q`` every quantity, and no method that
    gives none.
    """
    assert {name for name in dir(col) if not name.startswith("_")} == set(col.__all__)
    car = col.Vehicle(mass=1100.0, vx=20.0)
    momentum = col.reconstruct.momentum(
        1e3, 2e3, course_a=0, course_b=1, course_a_after=0.5, speed_a_after=9, together=True
    )
    run = col.travel.path([(0, 0), (6, -1)], [0.0, 0.1], friction=0.7, lock=0.5)
    impact = col.linear_central(car, car.replace(vx=0.0), 0.4)
    for owner in (car, impact, impact.a, momentum, run, col.left_out(impact)):
        complete = rlcompleter.Completer({"owner": owner})
        found = {name.rstrip("()") for name in complete.attr_matches("owner.q.")}
        wanted = {name for name in dir(owner) if unit_of(type(owner), name) is not None}
        assert {f"owner.q.{name}" for name in wanted} <= found, type(owner)
        assert found.isdisjoint({"owner.q.q", "owner.q.to_dict", "owner.q.replace"})
    with pytest.raises(AttributeError):
        _ = impact.q.q


def test_runs_from_src_without_being_installed():
    """A checkout on the path is enough."""
    code = "import collisions; print(collisions.__file__)"
    found = subprocess.run(
        [
            sys.executable,
            "-I",
            "-c",
            f"import sys; sys.path.insert(0, {str(ROOT / 'src')!r}); {code}",
        ],
        check=True,
        capture_output=True,
        text=True,
        encoding="utf-8",
    )
    assert str(ROOT / "src") in found.stdout


def test_every_error_and_warning_has_the_base_it_promises():
    """ValueError for bad input and missing answers, UserWarning for warnings; all of them
    CollisionsError or CollisionsWarning.
    """
    errors = [getattr(col, name) for name in col.__all__ if name.endswith("Error")]
    warnings = [getattr(col, name) for name in col.__all__ if name.endswith("Warning")]
    assert len(errors) == 9
    assert len(warnings) == 5
    assert all(issubclass(kind, col.CollisionsError) for kind in errors)
    assert all(
        issubclass(kind, ValueError)
        for kind in errors
        if kind not in (col.CollisionsError, col.InternalError)
    )
    # A defect of the library is no fault of what was given.
    assert issubclass(col.InternalError, RuntimeError)
    assert not issubclass(col.InternalError, ValueError)
    assert all(
        issubclass(kind, col.CollisionsWarning) and issubclass(kind, UserWarning)
        for kind in warnings
    )
    assert col.AmbiguousSolutionError("two", solutions=(1, 2)).solutions == (1, 2)


def test_no_two_status_codes_are_alike():
    """The numbers come from one place and are distinct."""
    assert len({int(status) for status in col.Status}) == len(col.Status)

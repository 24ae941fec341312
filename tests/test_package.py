"""The package itself: runs uninstalled, names what it promises, and type checkers see what callers write."""

import subprocess
import sys
from pathlib import Path

import collisions as col

ROOT = Path(__file__).parents[1]


def test_public_names():
    """Everything in __all__ is there, and the version is a literal."""
    for name in col.__all__:
        assert hasattr(col, name)
    text = (ROOT / "src/collisions/__init__.py").read_text()
    assert f'__version__ = "{col.__version__}"' in text


def test_runs_from_src_without_being_installed():
    """A checkout on the path is enough."""
    code = "import collisions; print(collisions.__file__)"
    found = subprocess.run(
        [sys.executable, "-I", "-c", f"import sys; sys.path.insert(0, {str(ROOT / 'src')!r}); {code}"],
        check=True,
        capture_output=True,
        text=True,
    )
    assert str(ROOT / "src") in found.stdout


def test_every_error_and_warning_has_the_base_it_promises():
    """ValueError for bad input and missing answers, UserWarning for warnings; all of them CollisionsError or CollisionsWarning."""
    errors = [getattr(col, name) for name in col.__all__ if name.endswith("Error")]
    warnings = [getattr(col, name) for name in col.__all__ if name.endswith("Warning")]
    assert len(errors) == 8
    assert len(warnings) == 5
    assert all(issubclass(kind, col.CollisionsError) for kind in errors)
    assert all(issubclass(kind, ValueError) for kind in errors if kind is not col.CollisionsError)
    assert all(issubclass(kind, col.CollisionsWarning) and issubclass(kind, UserWarning) for kind in warnings)
    assert col.AmbiguousSolutionError("two", solutions=(1, 2)).solutions == (1, 2)


def test_no_two_status_codes_are_alike():
    """The numbers come from one place and are distinct."""
    assert len({int(status) for status in col.Status}) == len(col.Status)

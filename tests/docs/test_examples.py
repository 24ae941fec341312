"""The examples run as scripts from anywhere, and the README shows what really comes out."""

import doctest
import os
import subprocess
import sys
import warnings
from pathlib import Path

import pytest

import collisions

ROOT = Path(__file__).parents[2]
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))


def run(script, cwd):
    """A script in a fresh interpreter, warnings as errors, with the library the tests use."""
    library = str(Path(collisions.__file__).parents[1])
    path = os.pathsep.join(part for part in (library, os.environ.get("PYTHONPATH", "")) if part)
    return subprocess.run(
        [sys.executable, "-W", "error", str(script)],
        cwd=cwd,
        env={**os.environ, "PYTHONPATH": path, "PYTHONIOENCODING": "utf-8"},
        capture_output=True,
        text=True,
        encoding="utf-8",
        timeout=1200,
        check=False,
    )


def test_there_are_examples():
    """The folder is not empty, so the tests below mean something."""
    expected = {
        "barrier",
        "chain_of_three",
        "three_cars",
        "crossroads",
        "eccentric_types",
        "example_2_backwards",
        "in_line_by_momentum_and_ees",
        "intersection_reconstruction",
        "million_cases",
        "paper_examples",
        "parked_truck",
        "pivoted_vehicle",
        "pole_after_side_impact",
        "pole_from_crush",
        "pole_impact",
        "published_solutions",
        "rear_end_from_recorder",
        "rest_positions",
        "sideswipe",
        "study_over_processes",
        "study_with_dask",
        "table_of_cases",
        "truck_against_car",
        "two_accounts",
        "two_accounts_of_a_chain",
        "us_units",
    }
    assert expected <= {script.stem for script in EXAMPLES}


PAPER = ROOT / "examples" / "paper_examples.py"


@pytest.mark.parametrize(
    ("script", "elsewhere"),
    [
        pytest.param(PAPER, False, id="from the root"),
        *(pytest.param(path, True, id=path.stem, marks=pytest.mark.slow) for path in EXAMPLES),
    ],
)
def test_example_runs_and_its_checks_pass(script, elsewhere, tmp_path):
    """An example exits with 0 and ends in its checks, without a warning, wherever it is started."""
    done = run(script, tmp_path) if elsewhere else run(script.relative_to(ROOT), ROOT)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    assert done.stdout.splitlines()[-1] == "all checks passed"


@pytest.mark.slow
def test_a_failed_comparison_fails_the_example(tmp_path):
    """The checks at the end are real: with one paper figure altered, the script fails
    and names it.
    """
    script = PAPER.read_text(encoding="utf-8")
    altered = tmp_path / "altered.py"
    altered.write_text(script.replace("950 / 111", "951 / 111"), encoding="utf-8")
    done = run(altered, tmp_path)
    assert done.returncode != 0
    assert "Example 3, v'_A" in done.stderr
    assert "all checks passed" not in done.stdout


@pytest.mark.slow
def test_readme_shows_real_output():
    """Every Python block of the README gives the output printed under it."""
    with warnings.catch_warnings():
        warnings.simplefilter(
            "ignore", collisions.CollisionsWarning
        )  # one block shows a batch with a refused case
        failures, attempted = doctest.testfile(
            str(ROOT / "README.md"), module_relative=False, encoding="utf-8"
        )
    assert attempted > 15
    assert failures == 0


def test_readme_has_the_two_commands_each_on_a_line():
    """The commands of the front reader stand verbatim on lines of their own."""
    lines = (ROOT / "README.md").read_text(encoding="utf-8").splitlines()
    assert "python -m pip install . && python examples/paper_examples.py" in lines
    assert 'python -m pip install ".[test]" && python -m pytest' in lines

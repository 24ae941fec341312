"""Progress of long runs: a function of the caller's, a bar, or a line; silence for short runs."""

import sys
import types

import numpy as np
import pytest

import collisions as col
from collisions.engine.blocks import BLOCK
from collisions.messages import progress

# Cases in a block of a formula as short as that of a linear impact.
STEP = 2 * BLOCK
V = np.full(3 * STEP, 20.0)


def solve(shown):
    """A batch of three blocks."""
    return col.linear_central(
        col.Vehicle(mass=1000.0, vx=V), col.Vehicle(mass=1000.0), 0.1, progress=shown
    )


@pytest.fixture
def impatient(monkeypatch):
    """Progress is shown at once."""
    monkeypatch.setattr(progress, "_PATIENCE", -1.0)


def test_a_short_run_shows_nothing(capsys):
    """Not even when it is wanted."""
    solve(True)
    assert capsys.readouterr() == ("", "")


@pytest.mark.usefixtures("impatient")
def test_nothing_is_shown_unasked(capsys):
    """However long it takes."""
    solve(None)
    solve(False)
    assert capsys.readouterr() == ("", "")


@pytest.mark.usefixtures("impatient")
def test_a_line_where_tqdm_is_not_installed(capsys, monkeypatch):
    """On stderr, ended with the run."""
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    solve(True)
    out, err = capsys.readouterr()
    assert out == ""
    assert err == "".join(f"\r{(i + 1) * STEP} of {V.size} cases" for i in range(3)) + "\n"


@pytest.mark.usefixtures("impatient")
def test_a_bar_where_tqdm_is_installed(monkeypatch):
    """Called for every block, and closed at the end."""
    seen = []

    class Bar:
        def __init__(self, total, **options):
            self.n = 0
            seen.append(total)

        def update(self, more):
            self.n += more
            seen.append(self.n)

        def close(self):
            seen.append("closed")

    monkeypatch.setitem(sys.modules, "tqdm.auto", types.SimpleNamespace(tqdm=Bar))
    solve(True)
    assert seen == [V.size, STEP, 2 * STEP, 3 * STEP, "closed"]


@pytest.mark.slow
@pytest.mark.parametrize("threads", [1, 2])
def test_solve_counts_all_cases_once_whatever_their_models(threads):
    """One run from nothing to all, though three models answer."""
    size = 13 * BLOCK
    rng = np.random.default_rng(1)
    y, vy = rng.choice([0.0, 0.0, 0.6], size), rng.choice([0.0, 0.2], size)
    a = col.Vehicle(mass=1500.0, yaw_inertia=2400.0, vx=10.0, vy=vy, x=-0.1, y=y)
    b = col.Vehicle(mass=1200.0, yaw_inertia=1700.0, x=0.1, y=-y)
    seen = []
    contact = {"normal": 0.0, "point": (0.0, 0.0), "friction": 0.5, "tolerance": 0.1}
    impact = col.solve(
        a, b, 0.2, **contact, threads=threads, progress=lambda *done: seen.append(done)
    )
    assert len(set(impact.model)) == 3
    done = [one for one, _ in seen]
    assert {total for _, total in seen} == {size}
    assert done == sorted(set(done))
    # The prediction, which takes half of it, is counted too.
    assert done[0] < size / 4
    assert done.index(size) == len(done) - 1

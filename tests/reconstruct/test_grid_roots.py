"""Roots on a grid, of functions of which every root is known: where they hide between two places,
where answers end, and where there are none.
"""

import numpy as np
import pytest

from collisions.reconstruct.grid_roots import Narrowing, roots_on_grid
from collisions.reconstruct.speeds_tyres import _ON_LINE

GRID = np.arange(-64, 65) / 64.0
CELL = GRID[1] - GRID[0]
PLAIN = Narrowing(1e-9)
# Jumps are told apart by what is left there, as the search along a line does by an impact.
ALONG = _ON_LINE._replace(rounds=13)


def root_of_an_end(x):
    """From 0.3 on: it falls to the end of the answers as a root does, to 0.05 below 0 there."""
    return np.sqrt(np.where(x >= 0.3, x - 0.3, np.nan)) - 0.05


def steep_end(x):
    """Far above 0 at the last place of the grid that has an answer, and falling ever faster."""
    return np.where(x >= 0.3, x - 0.3, np.nan) ** 0.1 - 0.5


def end_from_below(x):
    """The same as answers end upwards, beyond a cell that is nearly flat."""
    return np.sqrt(np.where(x <= -0.2005, -0.2005 - x, np.nan)) - 0.02


def two_in_a_cell(x):
    return (x - 0.505) ** 2 - 1e-6


def one_place_alone(x):
    """Answers about one place of the grid alone."""
    return np.where(abs(x - GRID[80]) < 0.6 * CELL, x - GRID[80] - 0.25 * CELL, np.nan)


def zero_alone(x):
    """An answer at one place of the grid alone, which is the root."""
    return np.where(x == GRID[80], 0.0, np.nan)


def _fold(after):
    """Two roots about a turning point so many cells after the place before the last that has an
    answer, less than a piece of a cell apart.
    """
    turn = GRID[84] + after * CELL

    def fold(x):
        apart = ((x - turn) / CELL) ** 2 - 1e-6
        return np.where(x <= GRID[84] + 0.7 * CELL, apart, np.nan)

    fold.__name__ = f"fold {after}"
    return fold, [turn - 1e-3 * CELL, turn + 1e-3 * CELL]


FOLDS = dict(_fold(after) for after in (-0.4, -0.05, 0.02, 0.05, 0.4, 0.6))


def far(x):
    return 2.0 + x


FUNCTIONS = {
    root_of_an_end: [0.3025],
    end_from_below: [-0.2009],
    steep_end: [0.3 + 0.5**10],
    two_in_a_cell: [0.504, 0.506],
    one_place_alone: [GRID[80] + 0.25 * CELL],
    zero_alone: [GRID[80]],
    **FOLDS,
    far: [],
    np.sin: [0.0],
}


@pytest.mark.parametrize("how", [PLAIN, ALONG], ids=["plain", "along a line"])
@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda one: one.__name__)
def test_every_root_is_found(function, how):
    found = roots_on_grid(lambda x, case: [function(x)], 1, GRID, how)
    places = sorted({round(place, 8) for _, _, place in found})
    assert places == pytest.approx(FUNCTIONS[function], abs=1e-6)


def test_cases_and_rows_are_told_apart():
    """As many cases as make several blocks, each with a root of its own in the second row."""
    wanted = np.linspace(-0.9, 0.9, 600) + 1e-4

    def mismatch(x, case):
        return [x + 3.0, x - wanted[case]]

    for how in (PLAIN, ALONG):
        found = roots_on_grid(mismatch, wanted.size, GRID, how)
        assert [(case, row) for case, row, _ in found] == [(one, 1) for one in range(wanted.size)]
        assert [place for *_, place in found] == pytest.approx(wanted, abs=1e-9)


def test_a_jump_is_no_root():
    """It changes its sign from -1 to 1; what is left at the better end is too much for a root."""
    step = roots_on_grid(lambda x, case: [np.where(x < 0.31, -1.0, 1.0)], 1, GRID, PLAIN)
    assert step == []


def test_where_two_roots_meet_they_are_one():
    """It touches 0 and turns: found where ``touching`` says that this is one."""
    touch = [lambda x, case: [(x - 0.2) ** 2]]
    assert roots_on_grid(touch[0], 1, GRID, PLAIN) == []
    found = roots_on_grid(touch[0], 1, GRID, PLAIN._replace(touching=1e-9))
    assert [place for *_, place in found] == pytest.approx([0.2], abs=1e-4)


def test_a_run_of_zeros_has_its_ends():
    """Where nothing is left over a range, its ends are roots, and not each place of it."""
    flat = roots_on_grid(
        lambda x, case: [np.where(abs(x) < 0.2, 0.0, np.sign(x) * (abs(x) - 0.2))], 1, GRID, PLAIN
    )
    assert {abs(round(place, 6)) for *_, place in flat} <= {0.1875, 0.2, 0.203125}
    assert 0 < len(flat) <= 4


def test_no_case_has_no_root():
    assert roots_on_grid(lambda x, case: [x], 0, GRID, PLAIN) == []

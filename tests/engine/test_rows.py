"""A kernel of rows that was recorded gives the bits that it gives when it is called."""

from __future__ import annotations

import itertools
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from collisions.engine.rows import RowProgram
from collisions.kernels.run_out import OF_GROUND, Settings, ending, step

INPUTS = OF_GROUND + 9


def rows(count: int, seed: int = 1) -> np.ndarray:
    """Grounds and motions of cars: some wheels locked or free, some motions straight, some cars at
    rest.
    """
    rng = np.random.default_rng(seed)
    found = rng.uniform(0.2, 0.9, (INPUTS, count))
    found[:4] = rng.choice([0.0, 0.02, 0.3, 1.0], (4, count))
    found[5] = 9.5
    found[10:12] = 0.2
    found[18:20] = 0.03
    found[OF_GROUND : OF_GROUND + 8] -= 0.5
    found[OF_GROUND + 1 : OF_GROUND + 3, ::5] = 0.0
    found[OF_GROUND : OF_GROUND + 3, ::7] = 0.0
    return found


@pytest.mark.slow
@pytest.mark.parametrize("flags", list(itertools.product((False, True), repeat=4)))
@pytest.mark.parametrize("count", [1, 17, 200, 5000])
def test_a_step_has_the_same_bits(flags, count):
    settings, given = Settings(*flags), rows(count)
    with np.errstate(all="ignore"):
        expected = np.array(step(*given, *settings))
    program = RowProgram(step, INPUTS, settings)
    # Twice, as what is left in its memory must not count.
    for _ in range(2):
        found = program(given[:OF_GROUND], *given[OF_GROUND:])
        np.testing.assert_array_equal(found, expected)


def test_conditions_are_numbers():
    given = rows(50)[-9:-2]
    found = RowProgram(ending, 7, ())(given)
    with np.errstate(all="ignore"):
        np.testing.assert_array_equal(found, np.array(ending(*given), dtype=float))
    assert set(found[-2:].ravel()) <= {0.0, 1.0}


@pytest.mark.slow
def test_it_is_used_by_several_threads_at_once():
    program = RowProgram(step, INPUTS, Settings(False, False, False))
    parts = [rows(400, seed) for seed in range(16)]
    alone = [program(part) for part in parts]
    with ThreadPoolExecutor(4) as pool:
        for one, other in zip(alone, pool.map(program, parts), strict=True):
            np.testing.assert_array_equal(one, other)


def test_what_cannot_be_recorded_is_refused():
    def branches(one, other):
        return (one if one > 0.0 else other,)

    with pytest.raises(TypeError, match="through select"):
        RowProgram(branches, 2, ())

    def sums(one, other):
        return (np.sum(one) + other,)

    with pytest.raises(TypeError):
        RowProgram(sums, 2, ())

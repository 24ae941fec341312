"""Points of the unit cube: strictly inside, found from their place alone, stratified or evenly
spread as their design says.
"""

import importlib.util
import math
from pathlib import Path

import numpy as np
import pytest

from collisions.uncertainty import designs
from collisions.uncertainty.designs import DESIGNS, MOST_DIMENSIONS, REPLICATES

every_design = pytest.mark.parametrize("name", DESIGNS)


@every_design
@pytest.mark.parametrize("dimensions", [1, 5, MOST_DIMENSIONS])
def test_one_row_for_each_input(name, dimensions):
    """Strictly between 0 and 1, so that no quantile is infinite, and every row and sequence
    different from the others.
    """
    found = DESIGNS[name](dimensions, 3, 32)(0, 96)
    assert found.shape == (dimensions, 96, REPLICATES)
    assert found.dtype == np.float64
    assert found.min() > 0.0
    assert found.max() < 1.0
    assert (
        len({row.tobytes() for row in found.transpose(0, 2, 1).reshape(-1, 96)})
        == dimensions * REPLICATES
    )


def test_the_ends_of_the_whole_numbers_stay_inside():
    """The least and the greatest of 52 bits, beside which a float64 still has room on
    both sides.
    """
    found = designs._between(np.array([0, 2**52 - 1], dtype=np.uint64))
    assert found.tolist() == [2.0**-53, 1.0 - 2.0**-53]


@every_design
def test_points_are_found_from_their_place(name):
    """Any cut of the places gives the same points to the bit, in any order, from another design of
    the same seed too.
    """
    design = DESIGNS[name](3, 11, 100)
    whole = design(0, 1000)
    for start, stop in [
        (990, 1000),
        (0, 1),
        (99, 101),
        (100, 200),
        (37, 640),
        (500, 500),
        (0, 1000),
    ]:
        assert design(start, stop).tobytes() == whole[:, start:stop].tobytes()
        assert DESIGNS[name](3, 11, 100)(start, stop).tobytes() == whole[:, start:stop].tobytes()


@every_design
def test_another_seed_gives_other_points(name):
    """Not one of them is the same."""
    assert not np.any(DESIGNS[name](2, 1, 64)(0, 64) == DESIGNS[name](2, 2, 64)(0, 64))


@pytest.mark.parametrize("name", ["monte_carlo", "quasi_random"])
def test_what_is_drawn_does_not_depend_on_how_much_was_asked_for_first(name):
    """So a tolerance reached by doubling gives what so many samples give."""
    assert DESIGNS[name](2, 5, 8)(0, 300).tobytes() == DESIGNS[name](2, 5, 4096)(0, 300).tobytes()


def test_a_longer_latin_hypercube_begins_like_a_shorter_one():
    """Beyond the longest sheet, which a run by tolerance starts with."""
    assert (
        DESIGNS["latin_hypercube"](2, 5, 512)(0, 1500).tobytes()
        == DESIGNS["latin_hypercube"](2, 5, 10**6)(0, 1500).tobytes()
    )


@pytest.mark.parametrize("length", [1, 7, 64, 512])
def test_a_sheet_of_the_latin_hypercube_has_one_point_in_every_share(length):
    """In every row and sequence, sheet after sheet; and the order of one row tells nothing of
    another.
    """
    found = DESIGNS["latin_hypercube"](4, 9, length)(0, 3 * length).reshape(
        4, 3, length, REPLICATES
    )
    shares = np.sort(np.floor(found * length), axis=2)
    assert np.array_equal(shares, np.broadcast_to(np.arange(length)[:, None], shares.shape))


@pytest.mark.slow
@pytest.mark.parametrize("length", [64, 512, 4096])
def test_every_beginning_of_the_lattice_has_two_points_in_every_other_share(length):
    """A shifted lattice has one point in each of n shares of every row; the fold lays two of them,
    from its two halves, on each of n/2 shares, and a shift may part such a pair by one: so never
    more than 3 nor fewer than 1."""
    found = DESIGNS["quasi_random"](MOST_DIMENSIONS, 2, 0)(0, length)
    counts = np.apply_along_axis(
        np.bincount, 1, np.floor(found * (length // 2)).astype(int), minlength=length // 2
    )
    assert counts.sum(axis=1).min() == length
    assert counts.min() >= 1
    assert counts.max() <= 3


def test_an_unfolded_lattice_has_one_point_in_every_share():
    """Every component is odd, so that a power of two of points meets every share of every row
    exactly once.
    """
    assert all(z % 2 == 1 for z in designs._VECTOR)
    assert len(designs._VECTOR) == len(set(designs._VECTOR)) == MOST_DIMENSIONS
    for size in (64, 4096):
        places = designs._reversed_bits(np.arange(size, dtype=np.uint64))
        for z in designs._VECTOR:
            at = (places * np.uint64(z)) & np.uint64(2**52 - 1)
            assert len(set((at >> np.uint64(52 - size.bit_length() + 1)).tolist())) == size


def test_bits_in_reverse():
    """The van der Corput sequence: 0, 1/2, 1/4, 3/4, 1/8, ..."""
    found = designs._reversed_bits(np.arange(9, dtype=np.uint64)) / 2.0**52
    assert found.tolist() == [0.0, 0.5, 0.25, 0.75, 0.125, 0.625, 0.375, 0.875, 0.0625]


@pytest.mark.slow
@every_design
def test_uniform_and_independent(name):
    """Shares of 20 equal classes by chi-squared, and no row goes with another, nor one sequence
    with the next.

    chi-squared of 19 degrees of freedom exceeds 60 in 4 of a million rows of independent points, of
    which there are 64; evenly spread points only come nearer. The correlation of n independent
    pairs has a standard error of 1/sqrt(n), and 5 of those are exceeded in one of a thousand draws
    of all 2016 pairs.
    """
    found = DESIGNS[name](MOST_DIMENSIONS, 7, 512)(0, 512).reshape(MOST_DIMENSIONS, -1)
    expected = found.shape[1] / 20.0
    counts = np.apply_along_axis(np.bincount, 1, np.floor(found * 20.0).astype(int), minlength=20)
    assert ((counts - expected) ** 2 / expected).sum(axis=1).max() < 60.0
    rows = np.corrcoef(found) - np.eye(MOST_DIMENSIONS)
    assert np.abs(rows).max() < 5.0 / math.sqrt(found.shape[1])
    # A lattice keeps its order under a shift, so two of its sequences go together or against each
    # other; only their shifts are independent.
    if name != "quasi_random":
        sequences = np.corrcoef(DESIGNS[name](1, 7, 4096)(0, 4096)[0].T) - np.eye(REPLICATES)
        assert np.abs(sequences).max() < 5.0 / math.sqrt(4096)


@pytest.mark.slow
def test_the_vector_is_what_its_script_builds():
    """Its first components; each is chosen after the ones before it, so a different construction
    differs here.
    """
    source = Path(__file__).resolve().parents[2] / "benchmarks" / "lattice.py"
    if not source.exists():
        pytest.skip("benchmarks are not shipped with the tests here")
    spec = importlib.util.spec_from_file_location("lattice", source)
    lattice = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(lattice)
    assert tuple(lattice.build(4)) == designs._VECTOR[:4]


@pytest.mark.parametrize(("dimensions", "gain"), [(2, 300.0), (6, 30.0), (12, 5.0)])
def test_the_lattice_integrates_better_than_independent_points(dimensions, gain):
    """A product of 1 + (x - 1/2)/2, smooth and with interactions of every order, whose integral is
    1.

    The scatter over the sequences of 4096 points, against that of independent points, which is
    known: the variance of the function is (1 + 1/48)^d - 1. Sixteen sequences tell a scatter to a
    fifth; the gains asked for are a third of those found.
    """

    def function(at):
        return np.prod(1.0 + 0.5 * (at - 0.5), axis=0)

    found = function(DESIGNS["quasi_random"](dimensions, 4, 0)(0, 4096)).mean(axis=0) - 1.0
    independent = math.sqrt(((1.0 + 1.0 / 48.0) ** dimensions - 1.0) / 4096)
    assert math.sqrt(np.mean(found**2)) * gain < independent
    by_hypercube = (
        function(DESIGNS["latin_hypercube"](dimensions, 4, 4096)(0, 4096)).mean(axis=0) - 1.0
    )
    assert math.sqrt(np.mean(found**2)) < math.sqrt(np.mean(by_hypercube**2)) < independent
    # Independent points do what theory says: 16 of them lie within the range of chi-squared that is
    # left in 1 of 10,000 cases.
    by_chance = function(DESIGNS["monte_carlo"](dimensions, 4, 4096)(0, 4096)).mean(axis=0) - 1.0
    assert 3.0 < np.sum((by_chance / independent) ** 2) < 46.0

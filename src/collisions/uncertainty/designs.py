"""Sampling designs: independent, stratified or evenly spread points of the unit cube.

A design gives the points, one row of numbers in (0, 1) for each input. They come in ``REPLICATES``
independent sequences side by side, whose spread gives every standard error. Each point follows from
its place alone, not from what was drawn before, in which blocks, or on how many threads. Any
initial part of the sequences is a sample in itself.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any, TypeAlias

import numpy as np

# (dimensions, places, REPLICATES) for the places from start to stop.
Design: TypeAlias = Callable[[int, int], Any]

REPLICATES = 16
MOST_DIMENSIONS = 64
_SHEET = 512
_BITS = 52  # so that a number half a step up is exact, and none is 0 or 1
_EXPONENT_OF_ONE = np.float64(1.0).view(np.uint64)
# Made by benchmarks/lattice.py, which names the source of the construction.
_VECTOR = (
    1, 676721, 1020265, 898277, 180061, 182105, 868669, 774733, 63087, 936555, 97147, 221963,
    709561, 473463, 994195, 370017,
    558127, 118745, 76733, 454165, 579897, 185001, 561857, 732193, 40631, 283851, 649915, 922865,
    1007489, 403705, 546465,
    120849, 155837, 403403, 965613, 730939, 74637, 941553, 584613, 46567, 278117, 493725, 192733,
    607491, 302861, 184873,
    444267, 963411, 475351, 129463, 23859, 773601, 625795, 1022325, 526885, 863277, 644695,
    390061, 776017, 274005, 644703,
    76347, 1017301, 625603,
)  # fmt: skip


def monte_carlo(dimensions: int, seed: int, length: int) -> Design:
    """Independent points."""
    sources = [np.random.SeedSequence(seed, spawn_key=(0, j)) for j in range(dimensions)]

    def points(start: int, stop: int) -> Any:
        found = np.empty((dimensions, stop - start, REPLICATES))
        for row, source in zip(found, sources, strict=True):
            generator = np.random.PCG64DXSM(source)
            generator.advance(start * REPLICATES)
            row[...] = _between(
                (generator.random_raw(row.size) >> np.uint64(64 - _BITS)).reshape(row.shape)
            )
        return found

    return points


def latin_hypercube(dimensions: int, seed: int, length: int) -> Design:
    """Latin hypercube samples (sheets): in each, every input takes one value from each of as many
    equally likely strata.

    A sheet is as long as the run of ``length`` places, at most 512: a longer run has more sheets,
    not longer ones, so that it begins like a shorter one of at least that length.
    """
    size = max(1, min(length, _SHEET))

    @lru_cache(maxsize=4)
    def sheet(number: int) -> Any:
        generator = np.random.Generator(
            np.random.PCG64DXSM(np.random.SeedSequence(seed, spawn_key=(1, number)))
        )
        ranks = generator.permuted(
            np.broadcast_to(np.arange(size), (dimensions, REPLICATES, size)), axis=-1
        )
        within = _between(
            generator.bit_generator.random_raw(ranks.size) >> np.uint64(64 - _BITS)
        ).reshape(ranks.shape)
        # A sum that rounds up to the whole would be the next share, or 1.
        return np.minimum((ranks + within) / size, np.nextafter((ranks + 1) / size, 0.0)).transpose(
            0, 2, 1
        )

    def points(start: int, stop: int) -> Any:
        first, last = start // size, (max(stop, start + 1) - 1) // size
        sheets = np.concatenate([sheet(number) for number in range(first, last + 1)], axis=1)
        return sheets[:, start - first * size : stop - first * size]

    return points


def quasi_random(dimensions: int, seed: int, length: int) -> Design:
    """A rank-1 lattice sequence under independent random shifts, folded by the tent map.

    The points of a lattice rule fill the cube evenly in every pair of inputs. In the order of the
    bit-reversed index so does every beginning of them, best at powers of two; see F. J. Hickernell,
    H. S. Hong, P. L'Ecuyer, C. Lemieux, "Extensible lattice sequences for quasi-Monte Carlo
    quadrature", SIAM J. Sci. Comput. 22 (2000). The tent map makes them serve inputs that are not
    periodic: F. J. Hickernell, "Obtaining O(N^-2+eps) convergence for lattice quadrature rules"
    (2002).
    """
    generator = np.random.PCG64DXSM(np.random.SeedSequence(seed, spawn_key=(2,)))
    shift = (generator.random_raw(dimensions * REPLICATES) >> np.uint64(64 - _BITS)).reshape(
        dimensions, REPLICATES
    )
    vector, whole = np.array(_VECTOR[:dimensions], dtype=np.uint64), np.uint64(2**_BITS - 1)

    def points(start: int, stop: int) -> Any:
        place = _reversed_bits(np.arange(start, stop, dtype=np.uint64)).reshape(-1, 1)
        found = np.empty((dimensions, stop - start, REPLICATES))
        # Row by row in memory that stays in use: new pages take longer than the numbers.
        for row, factor, by in zip(found, vector, shift, strict=True):
            # Whole numbers wrap as the lattice does, so nothing is rounded.
            at = place * factor + by
            at &= whole
            folded = np.minimum(at, at ^ whole)
            folded <<= np.uint64(1)
            at >>= np.uint64(_BITS - 1)
            folded |= at
            row[...] = _between(folded)
        return found

    return points


def _between(whole: Any) -> Any:
    """Whole numbers below 2**52 as numbers strictly between 0 and 1."""
    # Their bits are the digits of numbers from 1 to 2, and the difference is exact.
    return (whole | _EXPONENT_OF_ONE).view(np.float64) - (1.0 - 2.0 ** -(_BITS + 1))


def _reversed_bits(index: Any) -> Any:
    """The index with its 52 bits in reverse: the van der Corput sequence, as whole numbers."""
    bits = np.unpackbits(index.astype("<u8").view(np.uint8), bitorder="little")
    return np.packbits(bits).view(">u8").astype(np.uint64) >> np.uint64(64 - _BITS)


DESIGNS = {
    "monte_carlo": monte_carlo,
    "latin_hypercube": latin_hypercube,
    "quasi_random": quasi_random,
}

"""Blocks of a batch: how long they are, and work on them in order, on one thread or several."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple, TypeAlias, TypeVar

import numpy as np

BLOCK = 8192
# Of formulas that are worked out as arrays: from two blocks on a solver within runs a recorded
# kernel, which halves the cost, and Python's calls weigh little.
OF_ARRAYS = 2 * BLOCK
# Of all threads together, in bytes; a longer block gains nothing.
_SCRATCH, _LONGEST = 6 * 2**20, 32768
# Of one thread alone: a short formula gains by longer blocks, as each has its own calls of Python.
_CACHE = 2**20
Progress: TypeAlias = Callable[[int, int], None]
T = TypeVar("T")
R = TypeVar("R")


def block_length(size: int, threads: int, scratch: int) -> int:
    """Cases per block for this scratch per case: a block has to stay in a core's own cache.

    Several threads use longer blocks: each numpy call passes the interpreter lock on, and waiting
    for it takes as long as a call on a short block. All blocks then have about the same length, so
    that no thread ends late.
    """
    if threads == 1 or size <= BLOCK:
        return BLOCK * max(1, min(2, _CACHE // (BLOCK * max(1, scratch))))
    longest = max(BLOCK, min(_LONGEST, _SCRATCH // (threads * max(1, scratch))))
    even = math.ceil(size / (threads * math.ceil(size / (threads * longest))))
    return max(BLOCK, math.ceil(even / 64) * 64)


def each_block(
    solve: Callable[[int], int],
    starts: Sequence[int],
    size: int,
    threads: int,
    progress: Progress | None,
) -> None:
    """Call ``solve`` with the start of every block, on so many threads; it returns the number of
    cases it has done.
    """
    done = 0
    for count in in_order(solve, starts, threads):
        done += count
        if progress is not None:
            progress(done, size)


def in_order(work: Callable[[T], R], items: Sequence[T], threads: int) -> Iterator[R]:
    """What becomes of each item, in order, with so many threads at work."""
    if threads == 1 or len(items) < 2:
        yield from map(work, items)
        return
    # Costs a tenth of importing numpy, and most calls need no second thread.
    from concurrent.futures import ThreadPoolExecutor

    with ThreadPoolExecutor(threads) as pool:
        try:
            yield from pool.map(work, items)
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise


class Part(NamedTuple):
    """A block of a batch of this shape."""

    whole: tuple[int, ...]
    block: slice

    @property
    def shape(self) -> tuple[int]:
        """That of its cases."""
        return (self.block.stop - self.block.start,)

    def of(self, value: Any) -> Any:
        """Its cases of an array; one number for all cases stays."""
        cut = isinstance(value, np.ndarray) and value.ndim
        return flat(value, self.whole)[self.block] if cut else value


def is_one_part(shape: tuple[int, ...]) -> bool:
    """Whether so many cases are worked out together."""
    return math.prod(shape) <= OF_ARRAYS


def in_parts(
    work: Callable[[Part], Mapping[str, Any]], shape: tuple[int, ...], dtype: Any = None
) -> dict[str, Any]:
    """What ``work`` finds for every case, by name: numbers, arrays or None of each block in arrays
    of the whole batch, of this type or else their own. Where a block has not a name that another
    has, its cases are NaN, or 0 where these are no floats.
    """
    size = math.prod(shape)
    whole: dict[str, Any] = {}

    def solve(start: int) -> int:
        part = Part(shape, slice(start, min(start + OF_ARRAYS, size)))
        for name, value in work(part).items():
            if name not in whole:
                kind = np.dtype(dtype or np.asarray(value).dtype)
                nothing = np.nan if kind.kind == "f" else 0
                whole[name] = None if value is None else np.full(shape, nothing, kind)
            if value is not None:
                whole[name].reshape(-1)[part.block] = value
        return part.shape[0]

    each_block(solve, range(0, size, OF_ARRAYS), size, 1, None)
    return whole


def flat(value: Any, shape: tuple[int, ...]) -> Any:
    """A flat view of a broadcast array, or an iterator over it where a view would need a copy of
    the whole.
    """
    if value.shape == shape and value.flags.c_contiguous:
        return value.reshape(-1)
    return np.broadcast_to(value, shape).flat

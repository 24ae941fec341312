"""Puts the steps of a tape into memory: which are needed, in which order, and which result is
written where.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Sequence
from itertools import accumulate
from operator import itemgetter
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from .tracing import CODE, Step, Tape

PAGE = 4096
LARGE_PAGE = 2 * 2**20
Call: TypeAlias = tuple[Callable[..., Any], Callable[[Any], Any]]


class Program(NamedTuple):
    """Calls in order, each a function and an itemgetter of the arrays that it reads and, last, the
    one that it writes.

    The arrays are inputs, outputs, constants, results that are one number for all cases, and
    buffers. The late calls only serve to compute the status, and are skipped for a block in which
    all cases have answers; ``judged`` has the inputs that are read to find out whether they are.
    ``outputs`` has those that are the same number in all cases, whatever the inputs.
    """

    calls: tuple[Call, ...]
    late: tuple[Call, ...]
    ok: int | None
    judged: frozenset[int]
    constants: tuple[Any, ...]
    numbers: tuple[Any, ...]
    buffers: tuple[Any, ...]
    outputs: dict[int, Any]

    @property
    def scratch(self) -> int:
        """Bytes of its buffers, by case."""
        return sum(dtype.itemsize for dtype in self.buffers)


def _needs(steps: Sequence[Step], wanted: set[int]) -> set[int]:
    """The computed steps that these depend on, themselves included."""
    needed = set(wanted)
    for index in range(len(steps) - 1, -1, -1):
        if index in needed and steps[index].function is not None:
            needed.update(steps[index].operands)
    return {index for index in needed if steps[index].function is not None}


def judged_by(steps: Sequence[Step], ok: int | None) -> frozenset[int]:
    """The inputs that are read to find out whether a case has an answer."""
    judging = set() if ok is None else _needs(steps, {ok})
    read = (steps[one] for index in judging for one in steps[index].operands)
    return frozenset(step.operands[0] for step in read if step.function is None and step.operands)


def allocate(
    tape: Tape, written: dict[int, int], inputs: int, outputs: int, constant_outputs: dict[int, Any]
) -> Program:
    """Drop unused steps and assign buffers by last use."""
    steps = tape.steps
    (status,) = (index for index, which in written.items() if which == 0)
    ok = tape.ok(status)
    early = _needs(steps, set(written) if ok is None else (written.keys() - {status}) | {ok})
    needed = _needs(steps, set(written))
    numbers = [index for index in sorted(needed) if not steps[index].sample.ndim]
    early, needed = early.difference(numbers), needed.difference(numbers)
    order = [*sorted(early), *sorted(needed - early)]
    last = {operand: -1 for index in numbers for operand in steps[index].operands}
    last |= {operand: at for at, index in enumerate(order) for operand in steps[index].operands}
    constants = [
        index
        for index in sorted(last)
        if steps[index].function is None and not steps[index].operands
    ]
    # Where each result is found among inputs, outputs, constants and buffers.
    places = {
        index: steps[index].operands[0]
        for index in last
        if steps[index].function is None and steps[index].operands
    }
    places |= {index: inputs + which for index, which in written.items()}
    places |= {index: inputs + outputs + at for at, index in enumerate((*constants, *numbers))}
    # Where a result can be put, and until which step: an output array holds others until its own
    # result is written.
    free: dict[Any, list[tuple[float, int]]] = defaultdict(list)
    for at, index in enumerate(order):
        if index in written:
            free[steps[index].sample.dtype].append((at, places[index]))
    rooms: dict[int, tuple[float, int]] = {}
    buffers: list[Any] = []
    waiting: list[int] = []
    for at, index in enumerate(order):
        function, operands, sample = steps[index]
        ended = [one for one in set(operands) & rooms.keys() if last[one] == at]
        # A ufunc may write its result over an operand; the other functions of a tape, which make
        # several calls, may not.
        ended, waiting = (
            (waiting + ended, []) if isinstance(function, np.ufunc) else (waiting, ended)
        )
        for one in ended:
            free[steps[one].sample.dtype].append(rooms[one])
        if index not in written:
            found = [room for room in free[sample.dtype] if room[0] > last[index]]
            if not found:
                found = [
                    (math.inf, inputs + outputs + len(constants) + len(numbers) + len(buffers))
                ]
                free[sample.dtype] += found
                buffers.append(sample.dtype)
            rooms[index] = min(found)
            free[sample.dtype].remove(rooms[index])
            places[index] = rooms[index][1]
    calls: list[Any] = [
        (steps[i].function, itemgetter(*(places[one] for one in (*steps[i].operands, i))))
        for i in (*numbers, *order)
    ]
    at_once = len(numbers) + len(early)
    return Program(
        tuple(calls[:at_once]),
        tuple(calls[at_once:]),
        None if ok is None else places[ok],
        judged_by(steps, ok),
        tuple(np.asarray(steps[index].sample) for index in constants),
        tuple(steps[index].sample.dtype for index in numbers),
        tuple(buffers),
        constant_outputs,
    )


def slice_memory(length: int, dtypes: Sequence[Any], memory: Any = None) -> tuple[Any, list[Any]]:
    """A piece of memory, and empty arrays of these types in it: ``memory`` where it is large
    enough, else a new one.
    """
    # Numpy's own alignment can make a step over a block take up to twice as long as one that begins
    # a memory page.
    unit = PAGE if 8 * length >= PAGE else 64
    sizes = [-(-length * dtype.itemsize // unit) * unit for dtype in dtypes]
    if memory is None or memory.size < sum(sizes):
        memory = _aligned(sum(sizes), PAGE)
    starts = accumulate(sizes, initial=0)
    return memory, [
        np.ndarray(length, dtype, memory, start)
        for start, dtype in zip(starts, dtypes, strict=False)
    ]


def aligned_arrays(length: int, dtypes: Sequence[Any]) -> list[Any]:
    """Empty arrays in memory that the system can hand out in large pages, at a fraction of the
    faults of small ones.

    Those shorter than a large page share one piece of memory, which stays as long as any of them.
    """
    if 8 * length < LARGE_PAGE:
        return slice_memory(length, dtypes)[1]
    return [_aligned(length * dtype.itemsize, LARGE_PAGE).view(dtype) for dtype in dtypes]


def _aligned(size: int, unit: int) -> Any:
    """So many empty bytes that begin a page of this size; the memory behind them reaches to the end
    of their last page.
    """
    whole = np.empty(-(-size // unit) * unit + unit, CODE)
    start = -whole.ctypes.data % unit
    return whole[start : start + size]

"""Puts the steps of a tape into memory: which are needed, in which order, and which result is written where."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Sequence
from operator import itemgetter
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from .tracing import Step, Tape

Call: TypeAlias = tuple[Callable[..., Any], Callable[[Any], Any]]


class Program(NamedTuple):
    """Calls in order, each a function and an itemgetter of the arrays that it reads and, last, the one that it writes.

    The arrays are inputs, outputs, constants and buffers. The late calls only serve to compute the status, and are skipped for
    a block in which all cases are fine.
    """

    calls: tuple[Call, ...]
    late: tuple[Call, ...]
    fine: int | None
    constants: tuple[Any, ...]
    buffers: tuple[Any, ...]


def _needs(steps: Sequence[Step], wanted: set[int]) -> set[int]:
    """The computed steps that these depend on, themselves included."""
    needed = set(wanted)
    for index in range(len(steps) - 1, -1, -1):
        if index in needed and steps[index].function is not None:
            needed.update(steps[index].operands)
    return {index for index in needed if steps[index].function is not None}


class _Room(NamedTuple):
    """Memory for an intermediate result: a buffer, or an output array until the step that writes the output."""

    until: float
    place: int


def placed(tape: Tape, written: dict[int, int], inputs: int, outputs: int) -> Program:
    """Drop unused steps and assign buffers by last use."""
    steps = tape.steps
    (status,) = (index for index, which in written.items() if which == 0)
    fine = tape.fine(status)
    early = _needs(steps, set(written) if fine is None else (written.keys() - {status}) | {fine})
    order = [*sorted(early), *sorted(_needs(steps, set(written)) - early)]
    last = {operand: at for at, index in enumerate(order) for operand in steps[index].operands}
    constants = [index for index in sorted(last) if steps[index].function is None and not steps[index].operands]
    # Where each result is found among inputs, outputs, constants and buffers.
    places = {index: steps[index].operands[0] for index in last if steps[index].function is None and steps[index].operands}
    places |= {index: inputs + which for index, which in written.items()}
    places |= {index: inputs + outputs + at for at, index in enumerate(constants)}
    rooms: dict[int, _Room] = {}
    free: dict[Any, list[_Room]] = defaultdict(list)
    # A ufunc may write its result over an operand; the helpers below that take two numpy calls may not.
    in_place = [isinstance(steps[index].function, np.ufunc) for index in order]
    for at, index in enumerate(order):
        if index in written and index != status:
            free[steps[index].sample.dtype].append(_Room(at if in_place[at] else at - 1, places[index]))
    buffers: list[Any] = []
    for at, index in enumerate(order):
        dtype = steps[index].sample.dtype
        ended = [operand for operand in set(steps[index].operands) & rooms.keys() if last[operand] == at]
        if index not in written:
            found = [rooms[one] for one in ended if in_place[at] and steps[one].sample.dtype == dtype] + free[dtype][::-1]
            found = [room for room in found if room.until >= last[index]]
            if not found:
                found.append(_Room(math.inf, inputs + outputs + len(constants) + len(buffers)))
                buffers.append(dtype)
            rooms[index] = min(found)
            places[index] = rooms[index].place
        for one in ended:
            free[steps[one].sample.dtype].append(rooms.pop(one))
        free[dtype] = [room for room in free[dtype] if room != rooms.get(index)]
    calls: list[Any] = [(steps[i].function, itemgetter(*(places[one] for one in (*steps[i].operands, i)))) for i in order]
    return Program(
        tuple(calls[: len(early)]),
        tuple(calls[len(early) :]),
        None if fine is None else places[fine],
        tuple(steps[index].sample for index in constants),
        tuple(buffers),
    )

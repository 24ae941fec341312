"""Many cases, each worked out by a model of its own: which one is found in blocks, then every stretch is parted by model.

The cases of a stretch are put in the order of their models, worked out, and put back in their places, all within the cache.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Sequence
from functools import partial
from itertools import chain
from typing import Any, NamedTuple

import numpy as np

from .batch import (
    BLOCK,
    BatchAnswer,
    Check,
    Straight,
    blank,
    block_length,
    each_block,
    faults_of,
    first_names,
    flat,
    part,
    room_for,
    settled,
)
from .model_error import ECCENTRIC, least_model
from .replay import Replay, aligned, record
from .status import Answer, Status


class Part(NamedTuple):
    """A kernel, its settings and its inputs."""

    kernel: Callable[..., tuple[Any, ...]]
    settings: tuple[Any, ...]
    inputs: tuple[Any, ...]


def least_models(
    settings: tuple[Any, ...],
    inputs: Sequence[Any],
    checks: Sequence[Check],
    shape: tuple[int, ...],
    dtype: Any,
    threads: int = 1,
    progress: Callable[[int, int], None] | None = None,
) -> tuple[Any, Any, Any]:
    """What ``least_model`` answers for many cases; where a check applies, the eccentric model, and no error is known."""
    size, kinds = math.prod(shape), (np.dtype(np.uint8), np.dtype(dtype), np.dtype(dtype))
    outputs = [aligned(size, kind) for kind in kinds]
    lanes = _lanes(inputs, checks, shape)
    length, work = BLOCK, _work(Part(least_model, settings, tuple(inputs)), size, kinds, dtype)
    mine = threading.local()

    def choose(start: int) -> int:
        block = slice(start, min(start + length, size))
        if not hasattr(mine, "run"):
            mine.run = work(length)
        cut = {key: part(lane, block, dtype) for key, lane in lanes.items()}
        which, *errors = answers = [output[block] for output in outputs]
        with np.errstate(all="ignore"):
            mine.run([cut[id(value)] for value in inputs], answers)
            for fault in faults_of(checks, cut):
                wrong = np.not_equal(fault, Status.OK)
                which[wrong] = ECCENTRIC
                for error in errors:
                    error[wrong] = np.nan
        return block.stop - block.start

    each_block(choose, range(0, size, length), size, threads, progress)
    which, linear, oblique = (output.reshape(shape) for output in outputs)
    return which, linear, oblique


def solve_mixed(
    models: Sequence[Part],
    which: Any,
    checks: Sequence[Check],
    shape: tuple[int, ...],
    dtype: Any,
    threads: int = 1,
    progress: Callable[[int, int], None] | None = None,
) -> Any:
    """The outputs of many cases, each by the model of its number, as ``solve_cases`` gives them for one model."""
    solve = partial(_solved, models, which, checks, shape, np.dtype(dtype), threads)
    if math.prod(shape) > BLOCK:
        return BatchAnswer(solve, solve(first_names([value for model in models for value in model.inputs], dtype), progress))
    return Answer(**solve(Answer._fields, progress))


def _solved(
    models: Sequence[Part],
    which: Any,
    checks: Sequence[Check],
    shape: tuple[int, ...],
    dtype: Any,
    threads: int,
    names: Sequence[str],
    progress: Callable[[int, int], None] | None = None,
) -> dict[str, Any]:
    size = math.prod(shape)
    kinds, outputs = room_for(names, size, dtype)
    lanes = _lanes(chain.from_iterable(model.inputs for model in models), checks, shape)
    numbers = flat(which, shape)
    works = [_work(model, size, kinds, dtype) for model in models]
    length = BLOCK
    if size > BLOCK:
        # A thread keeps the scratch of every model and an output of a stretch, and has at a time the inputs of a block.
        lined_up = (sum(not isinstance(lane, float) for lane in lanes.values()) + len(models)) * dtype.itemsize
        length = block_length(size, threads, sum(work.scratch for work in works) + lined_up)
    stretch = min(length * len(models), size)
    mine = threading.local()

    def solve(start: int) -> int:
        block = slice(start, min(start + stretch, size))
        if not hasattr(mine, "runs"):
            mine.runs = [work(length) for work in works]
            mine.room = aligned(stretch, np.float64)
        cut = {key: part(lane, block, dtype) for key, lane in lanes.items()}
        there = [None if output is None else output[block] for output in outputs]
        chosen = [np.flatnonzero(numbers[block] == number) for number in range(len(models))]
        order = np.concatenate(chosen)
        in_order = bool(np.all(order[1:] > order[:-1]))
        at = 0
        with np.errstate(all="ignore"):
            # Before anything is gathered: this reads the inputs in the order of the cases, which brings them into the cache.
            faults = faults_of(checks, cut)
            for model, run, cases in zip(models, mine.runs, chosen, strict=True):
                for some in np.array_split(cases, math.ceil(cases.size / length) or 1):
                    here = slice(at, at + some.size)
                    at += some.size
                    if some.size:
                        wanted = here if in_order else some
                        inputs = [_gathered(cut[id(value)], wanted) for value in model.inputs]
                        run(inputs, [None if output is None else output[here] for output in there])
        if not in_order:
            place = np.empty_like(order)
            place[order] = np.arange(order.size)
            for output in there:
                if output is not None:
                    moved = mine.room.view(output.dtype)[: output.size]
                    output[...] = output.take(place, out=moved, mode="clip")
        blank(faults, there)
        return block.stop - block.start

    each_block(solve, range(0, size, stretch), size, threads, progress)
    return settled(outputs, shape, dtype)


def _gathered(lane: Any, some: Any) -> Any:
    """Some cases of a stretch, which all are inside: to have numpy look takes as long as to gather them."""
    if isinstance(lane, float):
        return lane
    return lane[some] if isinstance(some, slice) else lane.take(some, mode="clip")


class _Work(NamedTuple):
    """How a kernel is run on blocks: as it is, or where they are many, recorded."""

    make: Callable[[int], Callable[[Sequence[Any], Sequence[Any]], None]]
    scratch: int

    def __call__(self, length: int) -> Callable[[Sequence[Any], Sequence[Any]], None]:
        return self.make(length)


def _work(model: Part, size: int, kinds: tuple[Any, ...], dtype: Any) -> _Work:
    if size <= BLOCK:
        return _Work(lambda length: Straight(model.kernel, model.settings), 0)
    texts = tuple(value.hex() if isinstance(value, float) else None for value in model.inputs)
    program = record(model.kernel, model.settings, texts, np.dtype(dtype), kinds)
    return _Work(partial(Replay, program), sum(program.buffers))


def _lanes(inputs: Any, checks: Sequence[Check], shape: tuple[int, ...]) -> dict[int, Any]:
    """By the id of a value what its cases are cut from; a plain number as it is."""
    given = {id(value): value for value in chain(inputs, *(check.values for check in checks))}
    return {key: value if isinstance(value, float) else flat(value, shape) for key, value in given.items()}

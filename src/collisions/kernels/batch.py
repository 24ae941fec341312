"""Many cases at once: a kernel run in blocks that stay in the cache, on one thread or several.

Every case is worked out by itself. A refused one is NaN in every output and carries its status; it cannot touch its neighbours.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import chain
from typing import Any, NamedTuple

import numpy as np

from .replay import Replay, aligned, record
from .status import Answer, Status

BLOCK = 8192
# Of all threads together, in bytes; a longer block gains nothing.
_SCRATCH, _LONGEST = 6 * 2**20, 32768
# What most callers read of a large batch, and the rest, which needs the status to blank the refused cases.
FIRST = (
    "status",
    "closing_speed",
    "normal_impulse",
    "tangential_impulse",
    "energy_loss",
    "delta_vx_a",
    "delta_vy_a",
    "delta_yaw_rate_a",
    "delta_vx_b",
    "delta_vy_b",
    "delta_yaw_rate_b",
)
LATER = ("status", *(name for name in Answer._fields if name not in FIRST))
# Plain numbers within these make nothing that float32 cannot hold: slip, coupling and impulse without slip are at most 1e30.
_SMALL, _LARGE = 1e-18, 1e6
_TINY, _HUGE = float(np.finfo(np.float32).tiny), float(np.finfo(np.float32).max)


class Check(NamedTuple):
    """What gives the status of a case, 0 if nothing is wrong with it, and the values it looks at.

    ``passes`` tells of whole arrays, at less cost, that they hold no fault; it may say no where there is none.
    """

    fault: Callable[..., Any]
    values: tuple[Any, ...]
    passes: Callable[..., bool] | None = None


def precision(values: Iterable[Any]) -> Any:
    """What is worked out in: float32 if there are arrays, all are, and the plain numbers beside them fit; else float64."""
    arrays = False
    for value in values:
        if isinstance(value, np.ndarray):
            arrays = True
            if value.dtype != np.float32:
                return np.float64
        elif value is not None and math.isfinite(value) and not (value == 0.0 or _TINY <= abs(value) <= _HUGE):
            return np.float64
    return np.float32 if arrays else np.float64


def solve_cases(
    kernel: Callable[..., tuple[Any, ...]],
    settings: tuple[Any, ...],
    inputs: Sequence[Any],
    checks: Sequence[Check],
    shape: tuple[int, ...],
    dtype: Any,
    threads: int = 1,
    progress: Callable[[int, int], None] | None = None,
) -> Any:
    """The kernel's outputs as locked arrays of the given shape; the first check that applies decides the status of a case.

    ``progress(done, total)`` is called after every block, from the calling thread.
    """
    solve = partial(_solved, kernel, settings, inputs, checks, shape, np.dtype(dtype), threads)
    if math.prod(shape) > BLOCK:
        return BatchAnswer(solve, solve(first_names(inputs, dtype), progress))
    return Answer(**solve(Answer._fields, progress))


def first_names(inputs: Sequence[Any], dtype: Any) -> Sequence[str]:
    """The outputs to work out at once; all of them where the status may turn on one that most callers never read.

    What plain numbers make is worked out in float64, and only once it is written is it seen that float32 cannot hold it.
    """
    plain = [abs(value) for value in inputs if isinstance(value, float) and math.isfinite(value) and value]
    return FIRST if dtype == np.float64 or all(_SMALL <= value <= _LARGE for value in plain) else Answer._fields


class BatchAnswer:
    """The ``Answer`` of many cases: a few outputs at once, the others together when the first of them is read.

    Writing an output costs as much as several steps of the formula, and most of them are never read.
    """

    def __init__(self, solve: Callable[[Sequence[str]], dict[str, Any]], found: dict[str, Any]) -> None:
        vars(self).update(found, _solve=solve)

    def __getattr__(self, name: str) -> Any:
        if name not in LATER:
            raise AttributeError(name)
        later, refused = self._solve(LATER), self.status > Status.ENERGY_GAIN
        if np.any(refused & (later["status"] <= Status.ENERGY_GAIN)):
            # Refused for an answer that is not among these.
            later = {
                key: np.where(refused, np.asarray(False if key == "sticks" else np.nan, value.dtype), value)
                for key, value in later.items()
                if key != "status"
            }
            for value in later.values():
                value.setflags(write=False)
        vars(self).update({**later, **vars(self)})
        return vars(self)[name]

    def _replace(self, status: Any) -> BatchAnswer:
        """The same with another status, as an ``Answer`` has it."""
        return BatchAnswer(self._solve, {**vars(self), "status": status})

    def __iter__(self) -> Iterator[Any]:
        return (getattr(self, name) for name in Answer._fields)

    def __reduce__(self) -> tuple[Any, ...]:
        return Answer, tuple(self)


def _solved(
    kernel: Callable[..., tuple[Any, ...]],
    settings: tuple[Any, ...],
    inputs: Sequence[Any],
    checks: Sequence[Check],
    shape: tuple[int, ...],
    dtype: Any,
    threads: int,
    names: Sequence[str],
    progress: Callable[[int, int], None] | None = None,
) -> dict[str, Any]:
    """The outputs of these names, the status always among them."""
    size = math.prod(shape)
    kinds, outputs = room_for(names, size, dtype)
    # An array that is looked at more than once is cut once.
    given = {id(value): value for value in chain(inputs, *(check.values for check in checks))}
    lanes = {key: value if isinstance(value, float) else flat(value, shape) for key, value in given.items()}
    work: Callable[[], Callable[[Sequence[Any], Sequence[Any]], None]] = partial(Straight, kernel, settings)
    length = BLOCK
    if size > BLOCK:
        texts = tuple(value.hex() if isinstance(value, float) else None for value in inputs)
        program = record(kernel, settings, texts, dtype, kinds)
        length = block_length(size, threads, sum(program.buffers))
        work = partial(Replay, program, length)
    mine = threading.local()

    def solve(start: int) -> int:
        block = slice(start, min(start + length, size))
        if not hasattr(mine, "run"):
            mine.run = work()
        cut = {key: part(lane, block, dtype) for key, lane in lanes.items()}
        answers = [None if output is None else output[block] for output in outputs]
        with np.errstate(all="ignore"):
            faults = faults_of(checks, cut)
            mine.run([cut[id(value)] for value in inputs], answers)
        blank(faults, answers)
        return block.stop - block.start

    each_block(solve, range(0, size, length), size, threads, progress)
    return settled(outputs, shape, dtype)


def room_for(names: Sequence[str], size: int, dtype: Any) -> tuple[tuple[Any, ...], list[Any]]:
    """The type and an array for every output of these names; None for the others."""
    types = {"status": np.dtype(np.uint8), "sticks": np.dtype(np.bool_)}
    kinds = tuple(types.get(name, dtype) if name in names else None for name in Answer._fields)
    return kinds, [None if kind is None else aligned(size, kind) for kind in kinds]


def settled(outputs: Sequence[Any], shape: tuple[int, ...], dtype: Any) -> dict[str, Any]:
    """The outputs by name, locked; of float32 without the cases whose answers only the float64 of plain numbers could hold."""
    if dtype == np.float32:
        beyond = np.zeros(outputs[0].shape, dtype=bool)
        for output in outputs:
            if output is not None and output.dtype == dtype:
                beyond |= np.isinf(output)
        closing, normal = (outputs[Answer._fields.index(name)] for name in ("closing_speed", "normal_impulse"))
        if closing is not None and normal is not None:
            # The work of the normal impulse, of which an elastic contact loses nothing, however large it is.
            with np.errstate(over="ignore"):
                beyond |= np.isinf(closing * normal)
        beyond &= outputs[0] <= Status.ENERGY_GAIN
        if beyond.any():
            blank([np.where(beyond, np.uint8(Status.OUT_OF_RANGE), np.uint8(Status.OK))], outputs)
    found = {name: output.reshape(shape) for name, output in zip(Answer._fields, outputs, strict=True) if output is not None}
    for output in found.values():
        output.setflags(write=False)
    return found


def each_block(
    solve: Callable[[int], int],
    starts: Sequence[int],
    size: int,
    threads: int,
    progress: Callable[[int, int], None] | None,
) -> None:
    """Calls ``solve`` with the start of every block, on so many threads; it gives back how many cases it has worked out."""
    if threads == 1 or len(starts) < 2:
        _report(map(solve, starts), size, progress)
        return
    # Costs a tenth of importing numpy, and most calls need no second thread.
    from concurrent.futures import ThreadPoolExecutor

    with ThreadPoolExecutor(threads) as pool:
        try:
            _report(pool.map(solve, starts), size, progress)
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise


def faults_of(checks: Sequence[Check], values: Mapping[int, Any]) -> list[Any]:
    """The statuses that the checks give the cases of a block, values found by their ids; checks that all pass give none."""
    found = []
    for check in checks:
        block = [values[id(value)] for value in check.values]
        if check.passes is None or not check.passes(*block):
            found.append(check.fault(*block))
    return found


def blank(faults: Sequence[Any], answers: Sequence[Any]) -> None:
    """The first fault that applies decides the status of a case; where it is refused, no answer is left."""
    status = answers[0]
    for fault in reversed(faults):
        np.copyto(status, fault, where=np.not_equal(fault, Status.OK), casting="unsafe")
    if status.max() > Status.ENERGY_GAIN:
        refused = status > Status.ENERGY_GAIN
        for name, answer in zip(Answer._fields[1:], answers[1:], strict=True):
            if answer is not None:
                answer[refused] = False if name == "sticks" else np.nan


def block_length(size: int, threads: int, scratch: int) -> int:
    """Cases a block, where a case needs so many bytes of scratch: what stays in the cache that a core has to itself.

    With threads, more: every numpy call hands the interpreter over, and to wait for it takes as long as a call
    on a short block. Then all blocks are about as long, so that no thread ends late.
    """
    if threads == 1:
        return BLOCK
    longest = max(BLOCK, min(_LONGEST, _SCRATCH // (threads * max(1, scratch))))
    even = math.ceil(size / (threads * math.ceil(size / (threads * longest))))
    return max(BLOCK, math.ceil(even / 64) * 64)


class Straight:
    """A kernel called on a block as it is: for so few cases that recording it would cost more."""

    def __init__(self, kernel: Callable[..., tuple[Any, ...]], settings: tuple[Any, ...]) -> None:
        self.kernel = kernel
        self.settings = settings

    def __call__(self, inputs: Sequence[Any], outputs: Sequence[Any]) -> None:
        for output, answer in zip(outputs, self.kernel(*inputs, *self.settings), strict=True):
            if output is not None:
                output[...] = answer


def _report(counts: Any, size: int, progress: Callable[[int, int], None] | None) -> None:
    done = 0
    for count in counts:
        done += count
        if progress is not None:
            progress(done, size)


def part(lane: Any, block: slice, dtype: Any) -> Any:
    """The cases of a block, in the precision of the batch; a plain number as it is."""
    if isinstance(lane, float):
        return lane
    part = lane[block]
    return part if part.dtype == dtype else part.astype(dtype)


def flat(value: Any, shape: tuple[int, ...]) -> Any:
    """Something whose slices are the cases in order, without a copy of the whole: a view, or an iterator over one."""
    if value.shape == shape and value.flags.c_contiguous:
        return value.reshape(-1)
    return np.broadcast_to(value, shape).flat

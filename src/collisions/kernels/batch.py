"""Many cases at once: kernels run in blocks that stay in the cache, on one thread or several.

Every case is worked out by itself. A refused one is NaN in every output and carries its status; it cannot touch its neighbours.
Where the cases have models of their own, those of a block are put in the order of their models, worked out, and put back.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache, lru_cache, partial
from itertools import chain
from typing import Any, NamedTuple, TypeAlias, TypeVar

import numpy as np

from .buffers import Program, large_arrays
from .elementwise import first_status
from .floats import compile_for_floats
from .model_error import ECCENTRIC, least_model
from .replay import Replay, input_kind, record
from .status import Answer, Status

BLOCK = 8192
# Up to so many cases in float64 are answered one by one, as single cases are: numpy's calls take longer than their arithmetic.
FEW = 24
# Of all threads together, in bytes; a longer block gains nothing.
_SCRATCH, _LONGEST = 6 * 2**20, 32768
# Of one thread alone: a short formula gains by longer blocks, as each has its own calls of Python.
_CACHE = 2**20
# Outputs that most callers read of a large batch; and the rest, with the status, which marks the cases to set to NaN.
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
# With plain numbers in this range no output overflows float32: slip, coupling and impulse without slip are at most 1e30.
_SMALL, _LARGE = 1e-18, 1e6
_TINY, _HUGE = float(np.finfo(np.float32).tiny), float(np.finfo(np.float32).max)

# Runs one block: reads the inputs and writes the outputs; an output that is not wanted is None.
# It gives whether all its cases are fine.
Run: TypeAlias = Callable[[Sequence[Any], Sequence[Any]], bool]
Progress: TypeAlias = Callable[[int, int], None]
T = TypeVar("T")
R = TypeVar("R")


class Check(NamedTuple):
    """Conditions for a fault, each with its status, and the values they look at.

    ``passes`` is a cheaper test of whole arrays; it may be False although there is no fault. ``implied`` says that a case that
    a kernel finds fine has no such fault if the kernel reads the values: a number that is not finite leaves no sum finite.
    """

    faults: Sequence[tuple[Callable[..., Any], Status]]
    values: tuple[Any, ...]
    passes: Callable[..., bool] | None = None
    implied: bool = False

    def fault(self, *values: Any) -> Any:
        """The status of each case, 0 if nothing is wrong."""
        return first_status(*((fault(*values), code) for fault, code in self.faults))


class Work(NamedTuple):
    """A kernel, its settings and its inputs."""

    kernel: Callable[..., tuple[Any, ...]]
    settings: tuple[Any, ...]
    inputs: tuple[Any, ...]


class Cases(NamedTuple):
    """The cases of a batch: their checks, shape, precision, and the number of threads."""

    checks: Sequence[Check]
    shape: tuple[int, ...]
    dtype: Any
    threads: int = 1

    @property
    def size(self) -> int:
        """How many there are."""
        return math.prod(self.shape)


def precision(values: Iterable[Any]) -> Any:
    """float32 if there are arrays, all of them are float32, and the plain numbers fit its range; else float64."""
    arrays = False
    for value in values:
        if isinstance(value, np.ndarray):
            arrays = True
            if value.dtype != np.float32:
                return np.float64
        elif value is not None and math.isfinite(value) and not (value == 0.0 or _TINY <= abs(value) <= _HUGE):
            return np.float64
    return np.float32 if arrays else np.float64


def solve_cases(works: Sequence[Work], which: Any, cases: Cases, progress: Progress | None = None) -> Any:
    """The outputs of many cases as locked arrays; the first check that applies decides the status of a case.

    ``which`` has the number of each case's work, None where there is but one. ``progress(done, total)`` is called after every
    block, from the calling thread.
    """
    solve = partial(_solved, works, which, cases)
    if cases.size > FEW:
        return BatchAnswer(solve, solve(_first_names(chain(*(work.inputs for work in works)), cases.dtype), progress))
    return Answer(**solve(Answer._fields, progress))


def _first_names(inputs: Iterable[Any], dtype: Any) -> Sequence[str]:
    """The outputs to compute at once; all of them where one that is rarely read may decide the status.

    Results of plain numbers are computed in float64, and an overflow of float32 shows only when they are written.
    """
    plain = (abs(value) for value in inputs if isinstance(value, float) and math.isfinite(value) and value)
    return FIRST if dtype == np.float64 or all(_SMALL <= value <= _LARGE for value in plain) else Answer._fields


def least_models(
    settings: tuple[Any, ...], inputs: tuple[Any, ...], cases: Cases, progress: Progress | None = None
) -> tuple[Any, Any, Any]:
    """``least_model`` for many cases; where a check applies, the result is the eccentric model with unknown (NaN) errors."""

    def refuse(faults: Sequence[Any], answers: Sequence[Any]) -> None:
        which, *errors = answers
        for fault in faults:
            wrong = np.not_equal(fault, Status.OK)
            which[wrong] = ECCENTRIC
            for error in errors:
                error[wrong] = np.nan

    kinds = np.dtype(np.uint8), np.dtype(cases.dtype), np.dtype(cases.dtype)
    works = [Work(least_model, settings, inputs)]
    outputs = large_arrays(cases.size, kinds)
    _in_blocks(works, _programs(works, kinds, cases), None, outputs, cases, refuse, progress)
    which, linear, oblique = (output.reshape(cases.shape) for output in outputs)
    return which, linear, oblique


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
            # Refused because of an output that is not among these.
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
        """The same with another status: the ``_replace`` of an ``Answer``."""
        return BatchAnswer(self._solve, {**vars(self), "status": status})

    def __iter__(self) -> Iterator[Any]:
        return (getattr(self, name) for name in Answer._fields)

    def __reduce__(self) -> tuple[Any, ...]:
        return Answer, tuple(self)


def _solved(
    works: Sequence[Work], which: Any, cases: Cases, names: Sequence[str], progress: Progress | None = None
) -> dict[str, Any]:
    """The outputs of these names, the status always included; locked."""
    dtype, size = np.dtype(cases.dtype), cases.size
    kinds = _kinds(tuple(names), dtype)
    programs = _programs(works, kinds, cases)
    program = programs[0] if which is None else None
    same = {} if program is None else program.outputs
    outputs: list[Any] = [None] * len(kinds)
    computed = {at: kind for at, kind in enumerate(kinds) if kind is not None and at not in same}
    for at, output in zip(computed, large_arrays(size, list(computed.values())), strict=True):
        outputs[at] = output
    _in_blocks(works, programs, which, outputs, cases, blank, progress)
    if dtype == np.float32:
        _refuse_beyond(outputs)
    if same:
        # The same number in every case takes no memory, unless some cases are refused.
        refused = outputs[0] > Status.ENERGY_GAIN
        some = refused.any()
        for at, value in same.items():
            number, none = (np.array(one, kinds[at]) for one in (value, math.nan if kinds[at] == dtype else False))
            outputs[at] = np.where(refused, none, number) if some else np.broadcast_to(number, size)
    named = zip(Answer._fields, outputs, strict=True)
    found = {name: output.reshape(cases.shape) for name, output in named if output is not None}
    for output in found.values():
        output.setflags(write=False)
    return found


@cache
def _kinds(names: tuple[str, ...], dtype: Any) -> tuple[Any, ...]:
    """The type of each output, None for one that is not among these names."""
    types = {"status": np.dtype(np.uint8), "sticks": np.dtype(np.bool_)}
    return tuple(types.get(name, dtype) if name in names else None for name in Answer._fields)


def _refuse_beyond(outputs: Sequence[Any]) -> None:
    """Refuse float32 cases with a result that only float64 can hold."""
    beyond = np.zeros(outputs[0].shape, dtype=bool)
    for output in outputs:
        if output is not None and output.dtype == np.float32:
            beyond |= np.isinf(output)
    closing, normal = (outputs[Answer._fields.index(name)] for name in ("closing_speed", "normal_impulse"))
    if closing is not None and normal is not None:
        # The work of the normal impulse; an elastic contact loses none of it, so the loss does not show its overflow.
        with np.errstate(over="ignore"):
            beyond |= np.isinf(closing * normal)
    beyond &= outputs[0] <= Status.ENERGY_GAIN
    if beyond.any():
        blank([np.where(beyond, np.uint8(Status.OUT_OF_RANGE), np.uint8(Status.OK))], outputs)


def blank(faults: Sequence[Any], answers: Sequence[Any]) -> None:
    """Set the status of each case to its first fault, and the outputs of refused cases to NaN."""
    status = answers[0]
    for fault in reversed(faults):
        np.copyto(status, fault, where=np.not_equal(fault, Status.OK), casting="unsafe")
    if status.max() > Status.ENERGY_GAIN:
        refused = status > Status.ENERGY_GAIN
        for name, answer in zip(Answer._fields[1:], answers[1:], strict=True):
            if answer is not None:
                answer[refused] = False if name == "sticks" else np.nan


def _in_blocks(
    works: Sequence[Work],
    programs: Sequence[Program | None],
    which: Any,
    outputs: Sequence[Any],
    cases: Cases,
    refuse: Callable[[Sequence[Any], Sequence[Any]], None],
    progress: Progress | None,
) -> None:
    """Run the kernels over all cases into these arrays; ``refuse`` gets the faults and outputs of each block."""
    checks, shape, dtype, threads = cases
    size = cases.size
    # By the id of a value, the flat view its blocks are cut from: an array that is read more than once is cut once.
    values = {id(value): value for value in chain(*(work.inputs for work in works), *(check.values for check in checks))}
    plain = {key: value for key, value in values.items() if isinstance(value, float)}
    columns = {key: flat(value, shape) for key, value in values.items() if key not in plain}
    taken = [list(map(id, work.inputs)) for work in works]
    numbers = None if which is None else flat(which, shape)
    # Scratch per thread: that of every model, with several models one set of outputs, and the inputs of one block.
    gathered = 0 if which is None else len(columns) + len(works)
    scratch = sum(program.scratch for program in programs if program is not None) + gathered * np.dtype(dtype).itemsize
    length = min(block_length(size, threads, scratch), size or 1)
    per_block = length * len(works)
    # What the kernel reads to find out whether a case is fine.
    program = programs[0] if which is None else None
    judged = set() if program is None else {id(works[0].inputs[at]) for at in program.judged}
    open_checks = [check for check in checks if not (check.implied and judged.issuperset(map(id, check.values)))]
    mine = threading.local()
    replays: list[Replay] = []

    def run_of(work: Work, program: Program | None) -> Run:
        if program is None:
            return partial(run_one_by_one, work.kernel, work.settings)
        replays.append(Replay(program, length))
        return replays[-1]

    def solve(start: int) -> int:
        block = slice(start, min(start + per_block, size))
        if not hasattr(mine, "runs"):
            mine.runs = [run_of(work, program) for work, program in zip(works, programs, strict=True)]
            mine.room = None if which is None else np.empty(min(per_block, size))
        cut = plain | {key: column[block].astype(dtype, copy=False) for key, column in columns.items()}
        inputs = [[cut[key] for key in keys] for keys in taken]
        answers = [None if output is None else output[block] for output in outputs]
        with np.errstate(all="ignore"):
            if numbers is None:
                fine = mine.runs[0](inputs[0], answers)
                faults = _faults(open_checks if fine else checks, cut)
            else:
                # Before gathering: the checks read the inputs in the order of the cases, which brings them into the cache.
                fine, faults = False, _faults(checks, cut)
                _run_by_model(mine.runs, inputs, numbers[block], answers, length, mine.room)
        if faults or not fine:
            refuse(faults, answers)
        return block.stop - block.start

    try:
        each_block(solve, range(0, size, per_block), size, threads, progress)
    finally:
        for replay in replays:
            replay.close()


def _faults(checks: Sequence[Check], cut: dict[int, Any]) -> list[Any]:
    """The statuses from the checks of a block; a check that passes gives none."""
    found = []
    for check in checks:
        values = [cut[id(value)] for value in check.values]
        if check.passes is None or not check.passes(*values):
            found.append(check.fault(*values))
    return found


def _run_by_model(
    runs: Sequence[Run], inputs: Sequence[Sequence[Any]], numbers: Any, answers: Sequence[Any], length: int, room: Any
) -> None:
    """Gather the cases of each model, solve them in blocks, and scatter the results in the order of the cases."""
    chosen = [np.flatnonzero(numbers == number) for number in range(len(runs))]
    order = np.concatenate(chosen)
    in_order = bool(np.all(order[1:] > order[:-1]))
    at = 0
    for run, given, cases in zip(runs, inputs, chosen, strict=True):
        for some in np.array_split(cases, math.ceil(cases.size / length) or 1):
            here = slice(at, at + some.size)
            at += some.size
            if some.size:
                wanted = here if in_order else some
                run([_gathered(column, wanted) for column in given], [None if one is None else one[here] for one in answers])
    if not in_order:
        place = np.empty_like(order)
        place[order] = np.arange(order.size)
        for answer in answers:
            if answer is not None:
                moved = room.view(answer.dtype)[: answer.size]
                answer[...] = answer.take(place, out=moved, mode="clip")


def _gathered(column: Any, some: Any) -> Any:
    """The elements of a block at these indices, all valid: letting numpy check them takes as long as gathering them."""
    if isinstance(column, float):
        return column
    return column[some] if isinstance(some, slice) else column.take(some, mode="clip")


def _programs(works: Sequence[Work], kinds: tuple[Any, ...], cases: Cases) -> list[Program | None]:
    """The kernels recorded for inputs and outputs of these kinds; None for a few cases."""
    dtype = np.dtype(cases.dtype)
    few = cases.size <= FEW and dtype == np.float64
    return [
        None if few else record(work.kernel, work.settings, tuple(map(input_kind, work.inputs)), dtype, kinds) for work in works
    ]


def run_one_by_one(
    kernel: Callable[..., tuple[Any, ...]], settings: tuple[Any, ...], inputs: Sequence[Any], outputs: Sequence[Any]
) -> bool:
    """Answer each case by the kernel compiled for floats; all by the kernel itself if one of them is not plainly fine."""
    count, function = len(outputs[0]), _for_floats(kernel, settings, len(inputs))
    columns = [[value] * count if isinstance(value, float) else value.tolist() for value in inputs]
    answers = [*map(function, zip(*columns, strict=True))]
    found = kernel(*inputs, *settings) if None in answers else zip(*answers, strict=True)
    for output, answer in zip(outputs, found, strict=True):
        if output is not None:
            output[...] = answer
    return not outputs[0].any()


@lru_cache(maxsize=64)
def _for_floats(kernel: Callable[..., tuple[Any, ...]], settings: tuple[Any, ...], count: int) -> Callable[[Any], Any]:
    return compile_for_floats(kernel, tuple(f"[{at}]" for at in range(count)), settings)


def block_length(size: int, threads: int, scratch: int) -> int:
    """Cases per block for this scratch per case: a block has to stay in a core's own cache.

    Several threads use longer blocks: each numpy call passes the interpreter lock on, and waiting for it takes as long as a
    call on a short block. All blocks then have about the same length, so that no thread ends late.
    """
    if threads == 1 or size <= BLOCK:
        return BLOCK * max(1, min(2, _CACHE // (BLOCK * max(1, scratch))))
    longest = max(BLOCK, min(_LONGEST, _SCRATCH // (threads * max(1, scratch))))
    even = math.ceil(size / (threads * math.ceil(size / (threads * longest))))
    return max(BLOCK, math.ceil(even / 64) * 64)


def each_block(solve: Callable[[int], int], starts: Sequence[int], size: int, threads: int, progress: Progress | None) -> None:
    """Call ``solve`` with the start of every block, on so many threads; it returns the number of cases it has done."""
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


def flat(value: Any, shape: tuple[int, ...]) -> Any:
    """A flat view of a broadcast array, or an iterator over it where a view would need a copy of the whole."""
    if value.shape == shape and value.flags.c_contiguous:
        return value.reshape(-1)
    return np.broadcast_to(value, shape).flat

"""Many cases at once: kernels run in blocks that stay in the cache, on one thread or several.

Cases are independent. A refused one is NaN in every output and carries its status. Where the cases
have models of their own, those of a part of the batch are gathered by model, computed, and put
back.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache, lru_cache, partial
from itertools import chain
from typing import Any, NamedTuple

import numpy as np

from ..kernels.elementwise import first_status
from ..kernels.model_error import ECCENTRIC, least_model
from ..kernels.status import Answer, Status
from .blocks import BLOCK, Progress, block_length, each_block, flat
from .buffers import Program, aligned_arrays
from .flattening import flattened, form_of, numbers_of
from .floats import compiled
from .replay import input_kind, record, replay

# Of cases with models of their own, so many are looked at together: about a block of each of three
# models.
_PART = 3 * BLOCK
# Up to so many cases in float64 are answered one by one, as single cases are: numpy's calls take
# longer than their arithmetic.
SCALAR_LIMIT = 24
# Outputs that most callers read of a large batch; and the rest, with the status, which marks the
# cases to set to NaN.
EAGER = (
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
LAZY = ("status", *(name for name in Answer._fields if name not in EAGER))
# With plain numbers in this range no output overflows float32: slip, coupling and impulse without
# slip are at most 1e30.
_SMALL, _LARGE = 1e-18, 1e6
_STICKS = Answer._fields.index("sticks")


class Check(NamedTuple):
    """Conditions for a fault, each with its status, and the values they look at.

    ``passes`` is a cheaper test of whole arrays; it may be False although there is no fault.
    ``implied`` says that a case that a kernel answers has no such fault if the kernel reads the
    values: a number that is not finite leaves no sum finite.
    """

    faults: Sequence[tuple[Callable[..., Any], Status]]
    values: tuple[Any, ...]
    passes: Callable[..., bool] | None = None
    implied: bool = False

    def fault(self, *values: Any) -> Any:
        """The status of each case, 0 if nothing is wrong."""
        return first_status(*((fault(*values), code) for fault, code in self.faults))


class KernelCall(NamedTuple):
    """A kernel, its settings and its inputs."""

    kernel: Callable[..., tuple[Any, ...]]
    settings: tuple[Any, ...]
    inputs: tuple[Any, ...]


def call_of(kernel: Callable[..., Any], arguments: Any, settings: tuple[Any, ...]) -> KernelCall:
    """A kernel of named parts, its arguments and settings as numbers in a row."""
    return KernelCall(flattened(kernel, form_of(arguments)), settings, tuple(numbers_of(arguments)))


class Batch(NamedTuple):
    """The cases of a batch: their checks, shape, precision, and the number of threads."""

    checks: Sequence[Check]
    shape: tuple[int, ...]
    dtype: Any
    threads: int = 1

    @property
    def size(self) -> int:
        """How many there are."""
        return math.prod(self.shape)


def solve_cases(
    calls: Sequence[KernelCall], which: Any, batch: Batch, progress: Progress | None = None
) -> Any:
    """The outputs of many cases as locked arrays; the first check that applies decides the status
    of a case.

    ``which`` has the number of each case's call, None where there is but one. ``progress(done,
    total)`` is called after every block, from the calling thread.
    """
    solve = (
        partial(_solved, calls[0], batch)
        if which is None
        else partial(_by_model, calls, which, batch)
    )
    if batch.size > SCALAR_LIMIT:
        return BatchAnswer(
            solve,
            solve(_first_names(chain(*(call.inputs for call in calls)), batch.dtype), progress),
        )
    return Answer(**solve(Answer._fields, progress))


def _first_names(inputs: Iterable[Any], dtype: Any) -> Sequence[str]:
    """The outputs to compute at once; all of them where one that is rarely read may decide the
    status.

    Results of plain numbers are computed in float64, and an overflow of float32 shows only when
    they are written.
    """
    plain = (
        abs(value)
        for value in inputs
        if isinstance(value, float) and math.isfinite(value) and value
    )
    return (
        EAGER
        if dtype == np.float64 or all(_SMALL <= value <= _LARGE for value in plain)
        else Answer._fields
    )


def least_models(
    arguments: tuple[Any, ...],
    settings: tuple[Any, ...],
    batch: Batch,
    progress: Progress | None = None,
) -> tuple[Any, Any, Any]:
    """``least_model`` for many cases; where a check applies, the result is the eccentric model with
    unknown (NaN) errors.
    """

    def refuse(faults: Sequence[Any], answers: Sequence[Any]) -> None:
        which, *errors = answers
        for fault in faults:
            wrong = np.not_equal(fault, Status.OK)
            which[wrong] = ECCENTRIC
            for error in errors:
                error[wrong] = np.nan

    kinds = np.dtype(np.uint8), np.dtype(batch.dtype), np.dtype(batch.dtype)
    call = call_of(least_model, arguments, settings)
    program, outputs = _program(call, kinds, batch), aligned_arrays(batch.size, kinds)
    for at, value in {} if program is None else program.outputs.items():
        outputs[at].fill(value)
    _in_blocks(call, program, outputs, batch, refuse, progress)
    which, linear, oblique = (output.reshape(batch.shape) for output in outputs)
    return which, linear, oblique


class BatchAnswer:
    """The ``Answer`` of many cases: a few outputs at once, the others together when the first of
    them is read.

    Writing an output costs as much as several steps of the formula, and most of them are never
    read.
    """

    def __init__(
        self, solve: Callable[[Sequence[str]], dict[str, Any]], found: dict[str, Any]
    ) -> None:
        vars(self).update(found, _solve=solve)

    def __getattr__(self, name: str) -> Any:
        if name not in LAZY:
            raise AttributeError(name)
        later, refused = self._solve(LAZY), self.status > Status.ENERGY_GAIN
        if np.any(refused & (later["status"] <= Status.ENERGY_GAIN)):
            # Refused because of an output that is not among these.
            later = {
                key: np.where(
                    refused, np.asarray(False if key == "sticks" else np.nan, value.dtype), value
                )
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


def _by_model(
    calls: Sequence[KernelCall],
    which: Any,
    batch: Batch,
    names: Sequence[str],
    progress: Progress | None = None,
) -> dict[str, Any]:
    """These outputs where cases have models of their own: in each part of the batch, those of one
    model are solved together.
    """
    checks, shape, dtype, threads = batch
    values = {
        id(value): value
        for value in chain(*(call.inputs for call in calls), *(check.values for check in checks))
    }
    columns = {
        key: value if isinstance(value, float) else flat(value, shape)
        for key, value in values.items()
    }
    numbers = flat(which, shape)
    kinds = {
        name: kind
        for name, kind in zip(Answer._fields, _kinds(tuple(names), np.dtype(dtype)), strict=True)
        if kind
    }
    found = dict(zip(kinds, aligned_arrays(batch.size, list(kinds.values())), strict=True))

    def solve(start: int) -> int:
        part = numbers[start : start + _PART]
        for number, (kernel, settings, inputs) in enumerate(calls):
            chosen = np.flatnonzero(part == number) + start
            if chosen.size:
                taken = {
                    key: column if isinstance(column, float) else column[chosen]
                    for key, column in columns.items()
                }
                own = [
                    check._replace(values=tuple(taken[id(value)] for value in check.values))
                    for check in checks
                ]
                call = KernelCall(kernel, settings, tuple(taken[id(value)] for value in inputs))
                for name, output in _solved(call, Batch(own, chosen.shape, dtype), names).items():
                    found[name][chosen] = output
        return len(part)

    each_block(solve, range(0, batch.size, _PART), batch.size, threads, progress)
    return _shaped(found, shape)


def _solved(
    call: KernelCall, batch: Batch, names: Sequence[str], progress: Progress | None = None
) -> dict[str, Any]:
    """The outputs of these names, the status always included; locked."""
    dtype, size = np.dtype(batch.dtype), batch.size
    if 0 < size <= SCALAR_LIMIT and dtype == np.float64:
        return _few_solved(call, batch, names, progress)
    kinds = _kinds(tuple(names), dtype)
    program = _program(call, kinds, batch)
    constant_outputs = {} if program is None else program.outputs
    outputs: list[Any] = [None] * len(kinds)
    computed = {
        at: kind for at, kind in enumerate(kinds) if kind is not None and at not in constant_outputs
    }
    for at, output in zip(computed, aligned_arrays(size, list(computed.values())), strict=True):
        outputs[at] = output
    _in_blocks(call, program, outputs, batch, refuse_cases, progress)
    if dtype == np.float32:
        _refuse_beyond(outputs)
    if constant_outputs:
        # The same number in every case takes no memory, unless some cases are refused.
        refused = outputs[0] > Status.ENERGY_GAIN
        some = refused.any()
        for at, value in constant_outputs.items():
            number, none = (
                np.array(one, kinds[at])
                for one in (value, math.nan if kinds[at] == dtype else False)
            )
            outputs[at] = np.where(refused, none, number) if some else np.broadcast_to(number, size)
    return _shaped(dict(zip(Answer._fields, outputs, strict=True)), batch.shape)


def _few_solved(
    call: KernelCall, batch: Batch, names: Sequence[str], progress: Progress | None
) -> dict[str, Any]:
    """The same for a few cases, whose outputs are the rows of one array."""
    checks, shape, _, _ = batch
    inputs = [_in_a_row(value, shape) for value in call.inputs]
    found, judged = _one_by_one(call, inputs, batch.size)
    ok = None not in found
    with np.errstate(all="ignore"):
        # Into the rows by case, a status of 0 and a truth as numbers, all of them to be told apart
        # again.
        rows = (
            np.array(found, dtype=np.float64).T.copy()
            if ok
            else _rows(call.kernel(*inputs, *call.settings), batch.size)
        )
        read = {id(call.inputs[at]) for at in judged} if ok else set()
        open_checks = _not_implied(checks, read)
        cut = dict(zip(map(id, call.inputs), inputs, strict=True))
        for value in chain.from_iterable(check.values for check in open_checks):
            if id(value) not in cut:
                cut[id(value)] = _in_a_row(value, shape)
        faults = _faults(open_checks, cut)
    status, sticks = rows[0].astype(np.uint8), rows[_STICKS] != 0.0
    if faults or not ok:
        outputs: list[Any] = list(rows)
        outputs[0], outputs[_STICKS] = status, sticks
        refuse_cases(faults, outputs)
    for whole in (rows, status, sticks):
        # Before they are taken apart: what is a part of a locked array is locked.
        whole.setflags(write=False)
    if progress is not None:
        progress(batch.size, batch.size)
    shaped = dict(zip(Answer._fields, rows.reshape(-1, *shape), strict=True))
    shaped |= {"status": status.reshape(shape), "sticks": sticks.reshape(shape)}
    return shaped if names is Answer._fields else {name: shaped[name] for name in names}


def _in_a_row(value: Any, shape: tuple[int, ...]) -> Any:
    """The cases of an array in a row, in float64; a plain number as it is."""
    if isinstance(value, float):
        return value
    if value.shape == shape and value.dtype == np.float64:
        return value.reshape(-1)
    whole = value if value.shape == shape else np.broadcast_to(value, shape)
    return whole.reshape(-1).astype(np.float64, copy=False)


def _rows(answers: Sequence[Any], size: int) -> Any:
    """The outputs of a kernel, each an array or one number for all cases, as rows of an array."""
    rows = np.empty((len(answers), size))
    for row, answer in zip(rows, answers, strict=True):
        row[...] = answer
    return rows


def _shaped(outputs: dict[str, Any], shape: tuple[int, ...]) -> dict[str, Any]:
    """The outputs that there are, in the shape of the batch; locked."""
    found = {name: output.reshape(shape) for name, output in outputs.items() if output is not None}
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
    closing, normal = (
        outputs[Answer._fields.index(name)] for name in ("closing_speed", "normal_impulse")
    )
    if closing is not None and normal is not None:
        # The work of the normal impulse; an elastic contact loses none of it, so the loss does not
        # show its overflow.
        with np.errstate(over="ignore"):
            beyond |= np.isinf(closing * normal)
    beyond &= outputs[0] <= Status.ENERGY_GAIN
    if beyond.any():
        refuse_cases(
            [np.where(beyond, np.uint8(Status.OUT_OF_RANGE), np.uint8(Status.OK))], outputs
        )


def refuse_cases(faults: Sequence[Any], answers: Sequence[Any]) -> None:
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
    call: KernelCall,
    program: Program | None,
    outputs: Sequence[Any],
    batch: Batch,
    refuse: Callable[[Sequence[Any], Sequence[Any]], None],
    progress: Progress | None,
) -> None:
    """Run the kernel over all cases into these arrays; ``refuse`` gets the faults and outputs of
    each block.
    """
    checks, shape, dtype, threads = batch
    size = batch.size
    # By the id of a value, the flat view its blocks are cut from: an array that is read more than
    # once is cut once.
    values = {id(value): value for value in chain(call.inputs, *(check.values for check in checks))}
    plain = {key: value for key, value in values.items() if isinstance(value, float)}
    columns = {key: flat(value, shape) for key, value in values.items() if key not in plain}
    length = min(block_length(size, threads, 0 if program is None else program.scratch), size or 1)
    # What the kernel reads to find out whether a case has an answer.
    judged = set() if program is None else {id(call.inputs[at]) for at in program.judged}
    open_checks = _not_implied(checks, judged)

    def solve(start: int) -> int:
        block = slice(start, min(start + length, size))
        cut = plain | {
            key: column[block].astype(dtype, copy=False) for key, column in columns.items()
        }
        inputs = [cut[id(value)] for value in call.inputs]
        answers = [None if output is None else output[block] for output in outputs]
        with np.errstate(all="ignore"):
            ok = (
                run_one_by_one(call, inputs, answers)
                if program is None
                else replay(program, inputs, answers)
            )
            faults = _faults(open_checks if ok else checks, cut)
        if faults or not ok:
            refuse(faults, answers)
        return block.stop - block.start

    each_block(solve, range(0, size, length), size, threads, progress)


def _not_implied(checks: Sequence[Check], judged: set[int]) -> list[Check]:
    """The checks that an answer does not imply, of a kernel that judged the values of these ids."""
    return [
        check
        for check in checks
        if not (check.implied and judged.issuperset(map(id, check.values)))
    ]


def _faults(checks: Sequence[Check], cut: dict[int, Any]) -> list[Any]:
    """The statuses from the checks of a block; a check that passes gives none."""
    found = []
    for check in checks:
        values = [cut[id(value)] for value in check.values]
        if check.passes is None or not check.passes(*values):
            found.append(check.fault(*values))
    return found


def _program(call: KernelCall, kinds: tuple[Any, ...], batch: Batch) -> Program | None:
    """The kernel recorded for inputs and outputs of these kinds; None for a few cases."""
    dtype = np.dtype(batch.dtype)
    few = batch.size <= SCALAR_LIMIT and dtype == np.float64
    return (
        None
        if few
        else record(call.kernel, call.settings, tuple(map(input_kind, call.inputs)), dtype, kinds)
    )


def run_one_by_one(call: KernelCall, inputs: Sequence[Any], outputs: Sequence[Any]) -> bool:
    """Answer each case by the kernel compiled for floats; all by the kernel itself if one of them
    has no plain answer.
    """
    answers, _ = _one_by_one(call, inputs, len(outputs[0]))
    found = call.kernel(*inputs, *call.settings) if None in answers else zip(*answers, strict=True)
    for output, answer in zip(outputs, found, strict=True):
        if output is not None:
            output[...] = answer
    return not outputs[0].any()


def _one_by_one(
    call: KernelCall, inputs: Sequence[Any], count: int
) -> tuple[list[Any], frozenset[int]]:
    """What the kernel compiled for floats gives for each case, None without a plain answer; and
    which inputs it judges.
    """
    function, judged = _for_floats(call.kernel, call.settings, len(inputs))
    columns = [[value] * count if isinstance(value, float) else value.tolist() for value in inputs]
    return [*map(function, zip(*columns, strict=True))], judged


@lru_cache(maxsize=64)
def _for_floats(
    kernel: Callable[..., tuple[Any, ...]], settings: tuple[Any, ...], count: int
) -> tuple[Callable[[Any], Any], frozenset[int]]:
    return compiled(kernel, tuple(f"[{at}]" for at in range(count)), settings)

"""Traces a kernel once into a list of numpy steps; runs them without temporaries on blocks, or compiles them to Python source.

``record`` calls the kernel with operands that note each operation. Common subexpressions are computed once, and steps that no
output needs are dropped. The operations are those of the kernel itself, so the results agree with it to the bit.
"""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Callable, Sequence
from functools import lru_cache
from operator import itemgetter
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

from .elementwise import larger
from .status import Answer, Status

_BITS = {4: np.dtype(np.int32), 8: np.dtype(np.int64)}
_CODE = np.dtype(np.uint8)
_PAGE = 4096
# How ``compile_for_floats`` writes each operation as Python source.
_WRITTEN: dict[Any, str] = {
    np.add: "({} + {})",
    np.subtract: "({} - {})",
    np.multiply: "({} * {})",
    np.true_divide: "({} / {})",
    np.negative: "(-{})",
    np.absolute: "abs({})",
    np.fmax: "larger({}, {})",
    np.sqrt: "({} ** 0.5)",
    np.greater: "({} > {})",
    np.greater_equal: "({} >= {})",
    np.less: "({} < {})",
    np.less_equal: "({} <= {})",
    np.equal: "({} == {})",
    np.not_equal: "({} != {})",
    np.bitwise_and: "({} and {})",
    np.bitwise_or: "({} or {})",
    np.bitwise_xor: "({} != {})",
    np.where: "({1} if {0} else {2})",
}

Call: TypeAlias = tuple[Callable[..., Any], Callable[[Any], Any]]


class Step(NamedTuple):
    """One step: the function, the numbers of the steps it reads, and a one-element sample of its result (which has its dtype).

    A step without a function is an input, whose one operand is its position among the inputs, or a constant, without operands.
    """

    function: Callable[..., Any] | None
    operands: tuple[int, ...]
    sample: Any


class Traced(NDArrayOperatorsMixin):
    """An operand during tracing: stands for the result of one step, and records what is done to it."""

    def __init__(self, tape: Tape, index: int, sample: Any) -> None:
        self.tape = tape
        self.index = index
        self.sample = sample

    def __array_ufunc__(self, ufunc: Any, method: str, *operands: Any, **options: Any) -> Any:
        return NotImplemented if method != "__call__" or options else self.tape.call(ufunc, *operands)

    def __array_function__(self, function: Any, types: Any, operands: Any, options: Any) -> Any:
        return NotImplemented if function is not np.where or options else self.tape.choose(*operands)

    def __bool__(self) -> bool:
        raise TypeError("a kernel chooses between arrays through select")


class Tape:
    """The steps of a kernel in the order it made them."""

    def __init__(self) -> None:
        self.steps: list[Step] = []
        self.known: dict[Any, Traced] = {}

    def add(self, function: Any, operands: tuple[int, ...], sample: Any, key: Any = None) -> Traced:
        """Add a step, unless an identical one exists; gives the operand for its result."""
        key = key or (function, operands, sample.dtype)
        if key not in self.known:
            self.known[key] = Traced(self, len(self.steps), sample)
            self.steps.append(Step(function, operands, sample))
        return self.known[key]

    def input(self, which: int, dtype: Any) -> Traced:
        """An array that the kernel is called with."""
        return self.add(None, (which,), np.ones(1, dtype))

    def operand(self, value: Any, dtype: Any = None) -> Traced:
        """The operand for a traced value or a plain number, cast to ``dtype`` if one is given."""
        if isinstance(value, Traced):
            same = dtype is None or dtype == value.sample.dtype
            return value if same else self.add(_cast, (value.index,), value.sample.astype(dtype))
        number = value if dtype is None else np.array(value, dtype=dtype)
        array = np.asarray(number)
        return self.add(None, (), number, ("number", type(number), array.dtype, array.tobytes()))

    def call(self, function: Callable[..., Any], *values: Any) -> Traced:
        """The step for an operator or a ufunc."""
        kinds = {value.sample.dtype for value in values if isinstance(value, Traced)}
        beside = kinds.pop() if len(kinds) == 1 else None
        if beside is None or beside.kind != "f":
            beside = None
        elif function is np.multiply and type(values[0]) is float and values[0] == 1.0:
            return self.operand(values[1])
        elif function is np.power and type(values[1]) is float and values[1] == 0.5:
            return self.call(np.sqrt, values[0])
        # A plain number is cast to the dtype of the array operand: the same value, read faster.
        operands = [self.operand(value, beside if type(value) is float else None) for value in values]
        return self.add(function, tuple(one.index for one in operands), function(*(one.sample for one in operands)))

    def choose(self, condition: Any, yes: Any, no: Any) -> Traced:
        """``np.where`` on the bits of both values: without branches, a quarter of its time where the cases are mixed."""
        samples = [value.sample if isinstance(value, Traced) else value for value in (condition, yes, no)]
        dtype, which = np.where(*samples).dtype, self.operand(condition)
        codes = dtype.kind in "iu"
        if codes:
            dtype = _CODE
        else:
            which = self.add(_mask, (which.index,), np.zeros(1, _BITS[dtype.itemsize]))
        operands = which, self.operand(yes, dtype), self.operand(no, dtype)
        return self.add(_label if codes else _pick, tuple(one.index for one in operands), np.zeros(1, dtype))

    def fine(self, status: int) -> int | None:
        """The operand `fine` of the final select(fine, OK, ...); None if the kernel does not end with that select."""
        function, operands, _ = self.steps[status]
        if function not in (_label, np.where) or self.steps[operands[1]].sample != Status.OK:
            return None
        return None if self.steps[operands[0]].function is None else operands[0]


class _FloatTape(Tape):
    """A tape for single cases, which keeps ``np.where`` as it is: it becomes an ``if`` expression."""

    def choose(self, condition: Any, yes: Any, no: Any) -> Traced:
        operands = [self.operand(value) for value in (condition, yes, no)]
        return self.add(np.where, tuple(one.index for one in operands), np.where(*(one.sample for one in operands)))


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


@lru_cache(maxsize=64)
def record(
    kernel: Callable[..., tuple[Any, ...]],
    settings: tuple[Any, ...],
    inputs: tuple[str | None, ...],
    dtype: Any,
    outputs: tuple[Any, ...],
) -> Program:
    """Trace a kernel whose inputs are arrays of ``dtype`` (None in ``inputs``) or plain numbers (as ``float.hex`` texts).

    ``outputs`` has the dtype of each output, None for one that is not wanted; the first, the status, always is.
    """
    tape = Tape()
    operands = [tape.input(at, dtype) if text is None else float.fromhex(text) for at, text in enumerate(inputs)]
    written: dict[int, int] = {}
    with np.errstate(all="ignore"):
        for which, (answer, wanted) in enumerate(zip(kernel(*operands, *settings), outputs, strict=True)):
            if wanted is not None:
                value = tape.operand(answer, None if isinstance(answer, Traced) else wanted)
                step, index = tape.steps[value.index], value.index
                if step.function is None or index in written or step.sample.dtype != wanted:
                    index = len(tape.steps)
                    tape.steps.append(Step(_cast, (value.index,), np.zeros(1, wanted)))
                written[index] = which
    return _placed(tape, written, len(inputs), len(outputs))


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


def _placed(tape: Tape, written: dict[int, int], inputs: int, outputs: int) -> Program:
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


def aligned(length: int, dtype: Any) -> Any:
    """An empty array aligned to a memory page; numpy's own alignment can make a step over it take up to twice as long."""
    dtype = np.dtype(dtype)
    whole = np.empty(length * dtype.itemsize + _PAGE, dtype=_CODE)
    start = -whole.ctypes.data % _PAGE
    return whole[start : start + length * dtype.itemsize].view(dtype)


class Replay:
    """A program with its own buffers for blocks of one length: one per thread."""

    def __init__(self, program: Program, length: int) -> None:
        self.program = program
        self.length = length
        self.buffers = [aligned(length, dtype) for dtype in program.buffers]

    def __call__(self, inputs: Sequence[Any], outputs: Sequence[Any]) -> None:
        """Run one block: the inputs, with arrays cut to the block, and slices of the outputs to write to."""
        length = len(outputs[0])
        buffers = self.buffers if length == self.length else [buffer[:length] for buffer in self.buffers]
        arrays = [*inputs, *outputs, *self.program.constants, *buffers]
        for function, chosen in self.program.calls:
            function(*chosen(arrays))
        if self.program.fine is not None and arrays[self.program.fine].all():
            outputs[0].fill(0)
            return
        for function, chosen in self.program.late:
            function(*chosen(arrays))


def _cast(value: Any, out: Any) -> None:
    np.copyto(out, value, casting="unsafe")


def _label(condition: Any, yes: Any, no: Any, out: Any) -> None:
    np.copyto(out, no)
    if condition.any():
        np.copyto(out, yes, where=condition)


def _mask(condition: Any, out: Any) -> None:
    """All bits set where the condition holds."""
    np.copyto(out, condition)
    np.negative(out, out)


def _pick(mask: Any, yes: Any, no: Any, out: Any) -> None:
    one, other, bits = (array.view(mask.dtype) for array in (yes, no, out))
    np.bitwise_xor(one, other, bits)
    np.bitwise_and(bits, mask, bits)
    np.bitwise_xor(bits, other, bits)


def compile_for_floats(
    kernel: Callable[..., tuple[Any, ...]], takes: tuple[str, ...], settings: tuple[Any, ...]
) -> Callable[[Any], Any]:
    """A kernel with these settings compiled to one plain function, which reads its numbers at the paths in ``takes``.

    Of a kernel that gives an ``Answer`` it answers only cases whose status is plainly OK. For any other case, and where Python
    raises, as in a division by 0, it returns None, and the caller runs the kernel itself.
    """
    tape = _FloatTape()
    with np.errstate(all="ignore"):
        numbers = [tape.input(which, np.float64) for which in range(len(takes))]
        given = kernel(*numbers, *settings)
        answers = [tape.operand(answer).index for answer in given]
    fine = tape.fine(answers[0]) if isinstance(given, Answer) else tape.operand(True).index
    if fine is None:
        raise ValueError(f"{kernel.__name__} does not end by choosing whether its case is fine")
    wanted = [fine, *(answers[1:] if isinstance(given, Answer) else answers)]
    uses = Counter(wanted)
    for index in range(len(tape.steps) - 1, -1, -1):
        if index in uses and tape.steps[index].function is not None:
            uses.update(tape.steps[index].operands)
    names: dict[int, str] = {}
    lines = ["a = inputs.a", "b = inputs.b"]
    for index in sorted(uses):
        function, operands, sample = tape.steps[index]
        parts = [] if function is None else [names[operand] for operand in operands]
        if function is np.bitwise_xor and parts[1] == "True":
            written = f"(not {parts[0]})"
        elif function is not None:
            if function not in _WRITTEN:
                name = getattr(function, "__name__", repr(function))
                raise TypeError(f"{kernel.__name__} uses {name}, which cannot be written for floats; see collisions.kernels")
            written = _WRITTEN[function].format(*parts)
        elif operands:
            path = takes[operands[0]]
            written = path if path.startswith(("a.", "b.")) else f"inputs.{path}"
        else:
            value = sample.item() if isinstance(sample, (np.ndarray, np.generic)) else sample
            written = repr(value) if math.isfinite(value) else f"float('{value}')"
        names[index] = written
        if uses[index] > 1 and (function is not None or operands):
            names[index] = f"v{index}"
            lines.append(f"v{index} = {written}")
    returned = ", ".join(names[index] for index in wanted[1:])
    returned = f"new(Answer, (OK, {returned}))" if isinstance(given, Answer) else f"({returned})"
    body = "\n        ".join([*lines, f"if {names[fine]}:"])
    source = (
        f"def function(inputs):\n    try:\n        {body}\n            return {returned}\n"
        f"    except (ArithmeticError, TypeError, ValueError):\n        pass\n    return None\n"
    )
    found: dict[str, Any] = {"larger": larger, "OK": Status.OK, "Answer": Answer, "new": tuple.__new__}
    exec(compile(source, f"<{kernel.__name__} of floats>", "exec"), found)
    compiled: Callable[[Any], Any] = found["function"]
    return compiled

"""Traces a kernel once into a list of steps, the ``Tape``, by calling it with operands that note
each operation.

Common subexpressions are one step. The tape is replayed on blocks of arrays (``replay``), and
printed as plain Python (``floats``) and as JavaScript (``javascript``): the operations are those of
the kernel, so all agree with it to the bit.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

from ..kernels.status import Status

CODE = np.dtype(np.uint8)
_BITS = {4: np.dtype(np.int32), 8: np.dtype(np.int64)}


class Step(NamedTuple):
    """One step: the function, the numbers of the steps it reads, and a sample of its result (which
    has its dtype).

    A step without a function is an input, whose one operand is its position among the inputs, or a
    constant, without operands. The sample has one element, or no dimensions if the result is one
    number for all cases.
    """

    function: Callable[..., Any] | None
    operands: tuple[int, ...]
    sample: Any


class Traced(NDArrayOperatorsMixin):
    """An operand during tracing: stands for the result of one step, and records what is
    done to it.
    """

    def __init__(self, tape: Tape, index: int, sample: Any) -> None:
        self.tape = tape
        self.index = index
        self.sample = sample

    def __array_ufunc__(self, ufunc: Any, method: str, *operands: Any, **options: Any) -> Any:
        return (
            NotImplemented if method != "__call__" or options else self.tape.call(ufunc, *operands)
        )

    def __array_function__(self, function: Any, types: Any, operands: Any, options: Any) -> Any:
        return (
            NotImplemented if function is not np.where or options else self.tape.choose(*operands)
        )

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

    def input(self, which: int, dtype: Any, shape: tuple[int, ...] = (1,)) -> Traced:
        """An array, or one number, that the kernel is called with."""
        return self.add(None, (which,), np.ones(shape, dtype))

    def operand(self, value: Any, dtype: Any = None) -> Traced:
        """The operand for a traced value or a plain number, cast to ``dtype`` if one is given."""
        if isinstance(value, Traced):
            same = dtype is None or dtype == value.sample.dtype
            return value if same else self.add(cast, (value.index,), value.sample.astype(dtype))
        number = value if dtype is None else np.array(value, dtype=dtype)
        array = np.asarray(number)
        return self.add(None, (), number, ("number", type(number), array.dtype, array.tobytes()))

    def call(self, function: Callable[..., Any], *values: Any) -> Traced:
        """The step for an operator or a ufunc; none where a truth that is known leaves the other as
        it is.
        """
        if function in (np.bitwise_and, np.bitwise_or):
            known = function is np.bitwise_and
            if known in (one if type(one) is bool else None for one in values):
                return self.operand(values[0] if values[1] is known else values[1])
        kinds = {
            value.sample.dtype
            for value in values
            if isinstance(value, Traced) and value.sample.ndim
        }
        beside = kinds.pop() if len(kinds) == 1 else None
        if beside is None or beside.kind != "f":
            beside = None
        elif function is np.multiply and type(values[0]) is float and values[0] == 1.0:
            return self.operand(values[1])
        elif function is np.power and type(values[1]) is float and values[1] == 0.5:
            return self.call(np.sqrt, values[0])
        # A plain number is cast to the dtype of the array operand, as numpy does with a Python
        # float.
        operands = [self.operand(value, beside if _is_number(value) else None) for value in values]
        return self.add(
            function,
            tuple(one.index for one in operands),
            function(*(one.sample for one in operands)),
        )

    def choose(self, condition: Any, yes: Any, no: Any) -> Traced:
        """``np.where`` on the bits of both values: without branches, a quarter of its time where
        the cases are mixed.
        """
        samples = [
            value.sample if isinstance(value, Traced) else value for value in (condition, yes, no)
        ]
        found = np.where(
            samples[0], *(float(sample) if _is_number(sample) else sample for sample in samples[1:])
        )
        dtype, which = found.dtype, self.operand(condition)
        codes = dtype.kind in "iu"
        if codes:
            dtype = CODE
        else:
            which = self.add(
                _mask, (which.index,), np.zeros(which.sample.shape, _BITS[dtype.itemsize])
            )
        operands = which, self.operand(yes, dtype), self.operand(no, dtype)
        return self.add(
            _label if codes else _pick,
            tuple(one.index for one in operands),
            np.zeros(found.shape, dtype),
        )

    def ok(self, status: int) -> int | None:
        """The operand `ok` of the final select(ok, OK, ...); None if the kernel does not end
        with that select.
        """
        function, operands, _ = self.steps[status]
        if function not in (_label, np.where) or self.steps[operands[1]].sample != Status.OK:
            return None
        return None if self.steps[operands[0]].function is None else operands[0]


class TextTape(Tape):
    """A tape to be printed, which keeps ``np.where`` as it is: it becomes a conditional
    expression.
    """

    def choose(self, condition: Any, yes: Any, no: Any) -> Traced:
        operands = [self.operand(value) for value in (condition, yes, no)]
        return self.add(
            np.where,
            tuple(one.index for one in operands),
            np.where(*(one.sample for one in operands)),
        )


def _is_number(value: Any) -> bool:
    """Whether this is a float, or stands for one, and not for an array."""
    sample = value.sample if isinstance(value, Traced) else value
    return type(sample) is float or (getattr(sample, "ndim", 1) == 0 and sample.dtype.kind == "f")


def cast(value: Any, out: Any) -> None:
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


def statements(
    tape: Tape,
    wanted: Sequence[int],
    inputs: Sequence[str],
    written: Mapping[Any, str],
    constant: Callable[[Any], str],
    kernel: str,
) -> tuple[list[str], list[str]]:
    """The tape as a text: assignments of what is used more than once, and an expression for each of
    the wanted steps.

    ``inputs`` are the expressions of the inputs, ``written`` has the pattern of each operation,
    ``constant`` writes a number.
    """
    uses = Counter(wanted)
    for index in range(len(tape.steps) - 1, -1, -1):
        if index in uses and tape.steps[index].function is not None:
            uses.update(tape.steps[index].operands)
    names: dict[int, str] = {}
    lines: list[str] = []
    for index in sorted(uses):
        function, operands, sample = tape.steps[index]
        if function is np.bitwise_xor and tape.steps[operands[1]].sample is True:
            text = written[np.logical_not].format(names[operands[0]])
        elif function is not None:
            if function not in written:
                name = getattr(function, "__name__", repr(function))
                raise TypeError(
                    f"{kernel} uses {name}, which cannot be written as a text; see "
                    "collisions.kernels"
                )
            text = written[function].format(*(names[operand] for operand in operands))
        else:
            value = sample.item() if isinstance(sample, (np.ndarray, np.generic)) else sample
            text = inputs[operands[0]] if operands else constant(value)
        names[index] = text
        if uses[index] > 1 and (function is not None or operands):
            names[index] = f"v{index}"
            lines.append(f"v{index} = {text}")
    return lines, [names[index] for index in wanted]

"""A kernel recorded once, then repeated on block after block in the same few buffers.

The kernel is called with operands that note what is done to them. What comes of it is a list of numpy calls, each with a
place to write to: an output, or a buffer that is free again after its last use. Nothing is worked out twice, nothing that no
output needs, and no memory is asked for while a block runs. The calls are those of the kernel itself, so the bits are too.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import lru_cache
from operator import itemgetter
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

INPUT, CONSTANT, BUFFER, OUTPUT = range(4)
_BITS = {4: np.dtype(np.int32), 8: np.dtype(np.int64)}
_CODE = np.dtype(np.uint8)
_PAGE = 4096

Call: TypeAlias = tuple[Callable[..., Any], Callable[[Any], Any]]


class Cell(NamedTuple):
    """Where a value lives: its kind of place, which one of that kind (or the constant itself), and what it is read as."""

    place: int
    which: Any
    dtype: Any


class Program(NamedTuple):
    """Calls in order, each a function and what picks the cells it reads and, last, writes; and the sizes of the buffers.

    The late ones only find out the status, and are left out of a block where all cases are fine.
    """

    calls: tuple[Call, ...]
    late: tuple[Call, ...]
    fine: int | None
    cells: tuple[Cell, ...]
    buffers: tuple[int, ...]


class Traced(NDArrayOperatorsMixin):
    """An array of the kernel as the tape knows it, with one element of it to tell the type."""

    def __init__(self, tape: Tape, index: int, sample: Any) -> None:
        self.tape = tape
        self.index = index
        self.sample = sample

    def __array_ufunc__(self, ufunc: Any, method: str, *operands: Any, **options: Any) -> Any:
        return NotImplemented if method != "__call__" or options else self.tape.call(ufunc, *operands)

    def __array_function__(self, function: Any, types: Any, operands: Any, options: Any) -> Any:
        return NotImplemented if function is not np.where or options else self.tape.choose(*operands)

    def __pow__(self, power: Any) -> Any:
        """What numpy does for an array and these powers."""
        return self.tape.call(np.sqrt, self) if power == 0.5 else self.tape.call(np.power, self, power)

    def __bool__(self) -> bool:
        raise TypeError("a kernel chooses between arrays through select")


class Tape:
    """What a kernel did: every value in order, the call it came from, and the value whose memory it shares."""

    def __init__(self) -> None:
        self.made: dict[int, tuple[Callable[..., Any], tuple[int, ...]]] = {}
        self.cells: list[Cell] = []
        self.root: list[int] = []
        self.known: dict[Any, Traced] = {}

    def add(self, cell: Cell, made: Any, sample: Any, root: int | None = None) -> Traced:
        if made is not None:
            self.made[len(self.cells)] = made
        self.cells.append(cell)
        self.root.append(len(self.root) if root is None else root)
        return Traced(self, len(self.cells) - 1, sample)

    def input(self, which: int, dtype: Any) -> Traced:
        """An array that the kernel is called with."""
        return self.add(Cell(INPUT, which, np.dtype(dtype)), None, np.ones(1, dtype))

    def operand(self, value: Any, dtype: Any = None) -> Traced:
        """A value of the kernel, or a plain number, which is noted as it is unless a type is asked for."""
        if isinstance(value, Traced):
            return (
                value
                if dtype is None or dtype == value.sample.dtype
                else self.keep(_cast, (value,), value.sample.astype(dtype))
            )
        if dtype is not None:
            value = np.array(value, dtype=dtype)
        key = "number", type(value), np.asarray(value).dtype, np.asarray(value).tobytes()
        if key not in self.known:
            self.known[key] = self.add(Cell(CONSTANT, value, dtype), None, value)
        return self.known[key]

    def call(self, function: Callable[..., Any], *values: Any) -> Traced:
        kinds = {value.sample.dtype for value in values if isinstance(value, Traced)}
        beside = kinds.pop() if len(kinds) == 1 else None
        if beside is None or beside.kind != "f":
            beside = None
        elif function is np.multiply and type(values[0]) is float and values[0] == 1.0:
            return self.operand(values[1])
        # A plain number takes the type of the array beside it: the same value, read faster.
        operands = tuple(self.operand(value, beside if type(value) is float else None) for value in values)
        return self.keep(function, operands, function(*(operand.sample for operand in operands)))

    def keep(self, function: Callable[..., Any], operands: tuple[Traced, ...], sample: Any) -> Traced:
        """The value of a call, which is the one noted before if it was made before."""
        numbers = tuple(operand.index for operand in operands)
        key = function, numbers, sample.dtype
        if key not in self.known:
            self.known[key] = self.add(Cell(BUFFER, None, sample.dtype), (function, numbers), sample)
        return self.known[key]

    def seen_as(self, value: Traced, dtype: Any) -> Traced:
        """The same memory read as another type."""
        key = "seen", value.index, dtype
        if key not in self.known:
            sample = value.sample.view(dtype)
            self.known[key] = self.add(Cell(BUFFER, None, dtype), None, sample, self.root[value.index])
        return self.known[key]

    def choose(self, condition: Any, yes: Any, no: Any) -> Traced:
        """``np.where`` on the bits of both values: without branches, a quarter of its time where the cases are mixed."""
        samples = [value.sample if isinstance(value, Traced) else value for value in (condition, yes, no)]
        dtype = np.where(*samples).dtype
        if dtype.kind in "iu":
            operands = self.operand(condition), self.operand(yes, _CODE), self.operand(no, _CODE)
            return self.keep(_label, operands, np.zeros(1, _CODE))
        bits = _BITS[dtype.itemsize]
        mask = self.keep(_mask, (self.operand(condition),), np.zeros(1, bits))
        one, other = (self.bits(self.operand(value, dtype), bits) for value in (yes, no))
        return self.seen_as(((one ^ other) & mask) ^ other, dtype)

    def bits(self, value: Traced, bits: Any) -> Traced:
        return (
            self.operand(value.sample.view(bits), bits)
            if self.cells[value.index].place == CONSTANT
            else self.seen_as(value, bits)
        )


@lru_cache(maxsize=64)
def record(
    kernel: Callable[..., tuple[Any, ...]],
    settings: tuple[Any, ...],
    inputs: tuple[str | None, ...],
    dtype: Any,
    outputs: tuple[Any, ...],
) -> Program:
    """The program of a kernel for inputs that are arrays of a type (None) or plain numbers (as ``float.hex`` has them).

    ``outputs`` are the types to write, None for what is not wanted; the first one is.
    """
    tape = Tape()
    operands: list[Any] = []
    for which, text in enumerate(inputs):
        if text is None:
            operands.append(tape.input(which, dtype))
        else:
            operands.append(float.fromhex(text))
    with np.errstate(all="ignore"):
        answers = kernel(*operands, *settings)
        for which, (answer, wanted) in enumerate(zip(answers, outputs, strict=True)):
            if wanted is None:
                continue
            value = tape.operand(answer, None if isinstance(answer, Traced) else wanted)
            root = tape.root[value.index]
            if tape.cells[root].place == BUFFER and value.sample.dtype == wanted:
                tape.cells[root] = Cell(OUTPUT, which, tape.cells[root].dtype)
            else:
                tape.add(Cell(OUTPUT, which, np.dtype(wanted)), (_cast, (value.index,)), None)
    return _placed(tape)


def _needs(tape: Tape, wanted: set[int]) -> set[int]:
    """All values that are worked out for these, themselves included."""
    needed = {tape.root[index] for index in wanted}
    for index in sorted(tape.made, reverse=True):
        if index in needed:
            needed.update(tape.root[operand] for operand in tape.made[index][1])
    return needed & tape.made.keys()


def _fine(tape: Tape, status: int) -> int | None:
    """The condition on which the status is 0 without more ado, if the kernel ends by choosing so."""
    function, operands = tape.made[status]
    is_short = function is _label and tape.cells[operands[1]].place == CONSTANT and tape.cells[operands[1]].which == 0
    return operands[0] if is_short and tape.cells[operands[0]].place == BUFFER else None


class _Room(NamedTuple):
    """Memory for a value between: a buffer, or an output up to the call that writes it."""

    until: float
    place: int
    which: int


def _placed(tape: Tape) -> Program:
    """The calls that an output needs, and for every value between a room, which is free again after its last use."""
    outputs = {index for index, cell in enumerate(tape.cells) if cell.place == OUTPUT}
    status = min(outputs, key=lambda index: int(tape.cells[index].which))
    fine = _fine(tape, status)
    early = _needs(tape, outputs if fine is None else (outputs - {status}) | {fine})
    order = [*sorted(early), *sorted(_needs(tape, outputs) - early)]
    written = {index: at for at, index in enumerate(order)}
    last = {tape.root[operand]: at for at, index in enumerate(order) for operand in tape.made[index][1]}
    # A ufunc may write over what it reads; what takes two steps may not.
    in_place = [isinstance(tape.made[index][0], np.ufunc) for index in order]
    cells = list(tape.cells)
    rooms: dict[int, _Room] = {}
    free: dict[int, list[_Room]] = {}
    for index in sorted(outputs - {status}):
        until = written[index] if in_place[written[index]] else written[index] - 1
        free.setdefault(cells[index].dtype.itemsize, []).append(_Room(until, OUTPUT, cells[index].which))
    buffers: list[int] = []
    for at, index in enumerate(order):
        size = cells[index].dtype.itemsize
        ended = [root for root in {tape.root[operand] for operand in tape.made[index][1]} & rooms.keys() if last[root] == at]
        if cells[index].place == BUFFER:
            found = [rooms[root] for root in ended if in_place[at] and cells[root].dtype.itemsize == size]
            found = [room for room in found + free.get(size, [])[::-1] if room.until >= last[index]]
            if not found:
                found.append(_Room(math.inf, BUFFER, len(buffers)))
                buffers.append(size)
            rooms[index] = min(found, key=lambda room: room.until)
            cells[index] = Cell(rooms[index].place, rooms[index].which, cells[index].dtype)
        for root in ended:
            free.setdefault(cells[root].dtype.itemsize, []).append(rooms.pop(root))
        free[size] = [room for room in free.get(size, []) if room != rooms.get(index)]
    return _numbered(tape, order, len(early), fine, cells, buffers)


def _numbered(tape: Tape, order: list[int], early: int, fine: int | None, cells: list[Cell], buffers: list[int]) -> Program:
    """The program of placed values, in which those that share a place and a type are one cell."""
    places: dict[Any, int] = {}
    found: list[Cell] = []

    def number(index: int) -> int:
        home = cells[tape.root[index]]
        cell = Cell(home.place, home.which, cells[index].dtype)
        key = (CONSTANT, index) if cell.place == CONSTANT else cell
        if key not in places:
            places[key] = len(found)
            found.append(cell)
        return places[key]

    calls = [(tape.made[index][0], itemgetter(*map(number, (*tape.made[index][1], index)))) for index in order]
    return Program(
        tuple(calls[:early]), tuple(calls[early:]), None if fine is None else number(fine), tuple(found), tuple(buffers)
    )


def aligned(length: int, dtype: Any) -> Any:
    """An empty array that begins on a page: numpy's own begin where a step over it costs up to twice as much."""
    dtype = np.dtype(dtype)
    whole = np.empty(length * dtype.itemsize + _PAGE, dtype=_CODE)
    start = -whole.ctypes.data % _PAGE
    return whole[start : start + length * dtype.itemsize].view(dtype)


class Replay:
    """A program with buffers of its own for blocks of a length: one for each thread."""

    def __init__(self, program: Program, length: int) -> None:
        self.program = program
        self.length = length
        self.buffers = [aligned(size * length, _CODE) for size in program.buffers]
        self.arrays = self._bound(length)
        self.moving = [(index, cell) for index, cell in enumerate(program.cells) if cell.place in (INPUT, OUTPUT)]

    def _bound(self, length: int) -> list[Any]:
        found: list[Any] = []
        for place, which, dtype in self.program.cells:
            if place == BUFFER:
                found.append(self.buffers[which][: length * dtype.itemsize].view(dtype))
            else:
                found.append(which if place == CONSTANT else None)
        return found

    def __call__(self, inputs: Sequence[Any], outputs: Sequence[Any]) -> None:
        """Work out one block: the inputs, arrays cut to it, and slices of the outputs to write to."""
        length = len(outputs[0])
        arrays = self.arrays if length == self.length else self._bound(length)
        for index, (place, which, dtype) in self.moving:
            array = inputs[which] if place == INPUT else outputs[which]
            arrays[index] = array if array.dtype == dtype else array.view(dtype)
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

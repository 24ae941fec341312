"""Records a kernel of rows once and runs its calls again, in memory that is kept: for many short
arrays, of which Python and fresh memory would take longer than the arithmetic.

A row is a number of every case; what is of each wheel has several rows in one array. Unlike a
``Tape``, whose operands have one row each, such an array is one operand of one call.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, NamedTuple, TypeAlias

import numpy as np

# Cases that are worked out together: more would not stay in the cache, and fewer take as many
# calls. Where there are less, the next of these widths is used, with numbers left from before in
# the cases that are too many.
_WIDTHS = (8, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512, 768, 1024, 1536, 2048)
# Of the arrays of a recording: another number than any of rows.
_SAMPLE = 97
# The number of an array, its first row, and how many rows it has; 0 for one without that dimension.
_Place: TypeAlias = tuple[int, int, int]


class _Call(NamedTuple):
    """A function, what it reads (places, or constants), and where it writes."""

    function: Callable[..., Any]
    reads: tuple[Any, ...]
    writes: _Place


class _Recorder:
    """The calls of a kernel in order, and the rows and types of all arrays; the first is that of
    the inputs.
    """

    def __init__(self, inputs: int) -> None:
        self.calls: list[_Call] = []
        self.rows: list[tuple[int, Any]] = [(inputs, np.dtype(np.float64))]
        # Arrays that are rows of others: which, and which row.
        self.within: dict[int, tuple[int, int]] = {}
        self._known: dict[Any, Any] = {}
        # So that none of another has the same identity.
        self._constants: list[Any] = []

    def call(self, function: Callable[..., Any], *operands: Any) -> Any:
        """The result of a call, which is made once for the same operands."""
        reads: list[Any] = []
        key: list[Any] = [function]
        for one in operands:
            if isinstance(one, Recorded):
                reads.append(one.place)
                key.append(one.place)
            else:
                reads.append(np.asarray(one))
                key.append(("constant", one if isinstance(one, (float, bool)) else id(one)))
                self._constants.append(one)
        known = self._known.get(tuple(key))
        if known is None:
            plain = [np.asarray(one) for one in operands]
            known = self._array(function(*plain))
            self.calls.append(_Call(function, tuple(reads), known.place))
            self._known[tuple(key)] = known
        return known

    def _array(self, sample: Any) -> Recorded:
        self.rows.append((len(sample) if sample.ndim == 2 else 0, sample.dtype))
        return Recorded.of(self, sample, (len(self.rows) - 1, 0, self.rows[-1][0]))

    def stack(self, parts: Sequence[Any]) -> Any:
        """Rows as one array: where they are rows of one in that order already, those."""
        places = [part.place for part in parts]
        sample = np.stack([np.asarray(part) for part in parts])
        first = places[0]
        if places == [(first[0], first[1] + at, 0) for at in range(len(places))]:
            return Recorded.of(self, sample, (*first[:2], len(places)))
        found = self._array(sample)
        for at, place in enumerate(places):
            row = (found.place[0], at, 0)
            rows, kind = self.rows[place[0]]
            if place[0] and not rows and kind == sample.dtype and place[0] not in self.within:
                # Written where it is read.
                self.within[place[0]] = row[:2]
            else:
                self.calls.append(_Call(np.add, (place, np.asarray(0.0)), row))
        return found


class Recorded(np.ndarray):
    """An array during a recording, which notes what is done to it."""

    recorder: _Recorder
    place: _Place

    @classmethod
    def of(cls, recorder: _Recorder, sample: Any, place: _Place) -> Recorded:
        """The array at a place, with numbers for a sample."""
        found: Recorded = np.asarray(sample).view(cls)
        found.recorder, found.place = recorder, place
        return found

    def __array_ufunc__(self, ufunc: Any, method: str, *operands: Any, **options: Any) -> Any:
        if method != "__call__" or options:
            return NotImplemented
        return self.recorder.call(ufunc, *operands)

    def __array_function__(self, function: Any, types: Any, operands: Any, options: Any) -> Any:
        if function is np.stack and not options:
            return self.recorder.stack(operands[0])
        if function is np.where and not options:
            return self.recorder.call(np.where, *operands)
        return NotImplemented

    def __getitem__(self, which: Any) -> Any:
        array, first, count = self.place
        if isinstance(which, slice):
            begin, end, _ = which.indices(count)
            place = array, first + begin, end - begin
        else:
            if not 0 <= which < count:
                raise IndexError(which)
            place = array, first + which, 0
        return Recorded.of(self.recorder, np.asarray(self)[which], place)

    def __iter__(self) -> Any:
        return (self[at] for at in range(self.place[2]))

    def __bool__(self) -> bool:
        raise TypeError("a kernel chooses between arrays through select")


class RowProgram:
    """A kernel of so many rows, whose results are rows too, as calls that can be made again.

    Parameters
    ----------
    kernel : function
        Takes the rows one by one, and settings behind them.
    inputs : int
        How many rows it takes.
    settings : tuple
        What else it takes.
    """

    def __init__(self, kernel: Callable[..., Any], inputs: int, settings: tuple[Any, ...]) -> None:
        recorder = _Recorder(inputs)
        sample = np.linspace(0.1, 0.9, inputs * _SAMPLE).reshape(inputs, _SAMPLE)
        with np.errstate(all="ignore"):
            rows = Recorded.of(recorder, sample, (0, 0, inputs))
            self._result: _Place = recorder.stack(kernel(*rows, *settings)).place
        self._within = recorder.within
        self._calls = self._needed(recorder.calls)
        self._memory = self._placed(recorder.rows)
        self._inputs = inputs
        # Memory that no one works in, each with its calls by width.
        self._free: list[tuple[list[Any], dict[int, Any]]] = []

    def _home(self, place: _Place) -> _Place:
        """Where an array that is a row of another is found."""
        array, first, count = place
        if array in self._within:
            array, first = self._within[array]
        return array, first, count

    def _needed(self, calls: list[_Call]) -> list[_Call]:
        """Those that the result depends on, with the homes of what they read and write."""
        needed, kept = {self._result[0]}, []
        for function, reads, writes in reversed(calls):
            home = self._home(writes)
            if home[0] in needed:
                homes = tuple(self._home(one) if type(one) is tuple else one for one in reads)
                needed.update(one[0] for one in homes if type(one) is tuple)
                kept.append(_Call(function, homes, home))
        return kept[::-1]

    def _placed(self, rows: list[tuple[int, Any]]) -> list[tuple[int, Any]]:
        """Let arrays share memory that are not needed at the same time; the rows and types of all
        pieces.
        """
        last = {self._result[0]: len(self._calls), 0: len(self._calls)}
        for at, (_, reads, writes) in enumerate(self._calls):
            for place in (*reads, writes):
                if type(place) is tuple:
                    last[place[0]] = max(at, last.get(place[0], 0))
        pieces: list[tuple[int, Any]] = [rows[0]]
        piece_of = {0: 0}
        free: dict[Any, list[int]] = {}
        for at, (_, reads, writes) in enumerate(self._calls):
            # A function of each case alone may write over what it reads.
            for array in {one[0] for one in reads if type(one) is tuple}:
                if last[array] == at:
                    free.setdefault(pieces[piece_of[array]], []).append(piece_of[array])
            if writes[0] not in piece_of:
                kind = rows[writes[0]]
                if free.get(kind):
                    piece_of[writes[0]] = free[kind].pop()
                else:
                    piece_of[writes[0]] = len(pieces)
                    pieces.append(kind)
        self._calls = [
            _Call(
                function,
                tuple((piece_of[one[0]], *one[1:]) if type(one) is tuple else one for one in reads),
                (piece_of[writes[0]], *writes[1:]),
            )
            for function, reads, writes in self._calls
        ]
        self._result = (piece_of[self._result[0]], *self._result[1:])
        return pieces

    def _bound(self, memory: list[Any], width: int) -> tuple[Any, Any, list[Any]]:
        """Inputs, result, and all calls with their arrays, of so many cases."""

        def view(place: _Place) -> Any:
            piece, first, count = place
            whole = memory[piece][: max(pieces[piece][0], 1) * width].reshape(-1, width)
            return whole[first : first + count] if count else whole[first]

        pieces = self._memory
        calls: list[Any] = []
        for function, reads, writes in self._calls:
            arrays = [view(one) if type(one) is tuple else one for one in reads]
            out = view(writes)
            if function is np.where:
                calls.append((_choose, (*arrays, out)))
            elif function in (np.minimum, np.maximum):
                # They take it by name alone.
                calls.append((partial(function, out=out), arrays))
            else:
                calls.append((function, (*arrays, out)))
        return view((0, 0, self._inputs)), view(self._result), calls

    def __call__(self, *parts: Any) -> Any:
        """The results of all cases, in rows; of parts that are rows or several rows each."""
        count = parts[-1].shape[-1]
        result = np.empty((self._result[2], count))
        try:
            memory, bound = self._free.pop()
        except IndexError:
            most = _WIDTHS[-1]
            memory = [np.zeros(max(rows, 1) * most, kind) for rows, kind in self._memory]
            bound = {}
        with np.errstate(all="ignore"):
            for begin in range(0, count, _WIDTHS[-1]):
                here = min(count - begin, _WIDTHS[-1])
                width = _WIDTHS[bisect_left(_WIDTHS, here)]
                if width not in bound:
                    bound[width] = self._bound(memory, width)
                given, found, calls = bound[width]
                at, cases = 0, slice(begin, begin + here)
                for part in parts:
                    some = part[..., cases]
                    rows = len(some) if some.ndim == 2 else 1
                    given[at : at + rows, :here] = some
                    at += rows
                for function, arrays in calls:
                    function(*arrays)
                result[:, cases] = found[:, :here]
        self._free.append((memory, bound))
        return result


def _choose(condition: Any, yes: Any, no: Any, out: Any) -> None:
    out[...] = np.where(condition, yes, no)

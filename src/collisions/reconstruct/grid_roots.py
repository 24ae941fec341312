"""Roots of functions of one number, many at once: looked for on a grid, then narrowed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

_PIECES = 16
# Repeated subdivisions of a grid cell until its pieces are as small as rounding.
_ROUNDS = 13
# Cases whose grids are looked at together, so that their arrays stay small.
_BLOCK = 256

# The mismatch of each row, from places and cases, which are arrays alike.
_Mismatch = Callable[[Any, Any], Sequence[Any]]


class Narrowing(NamedTuple):
    """How closely what a grid shows is looked at.

    ``rounds`` are the subdivisions of a cell in which the sign changes, ``turns`` those around a
    turning point or an end. Where the mismatch is not above ``largest`` is a root: a jump changes
    sign as well. A turning point where it is not above ``touching`` is one.

    ``near`` says how near 0 the mismatch has to come to be looked at: to so many times what it
    changes in a cell there or beside it. So many times as ``closer`` says, all such cells are
    subdivided before, and only what these show is looked at.
    """

    largest: float
    rounds: int = _ROUNDS
    turns: int = _ROUNDS
    touching: float = -1.0
    near: float = np.inf
    closer: int = 0


def roots_on_grid(
    mismatch: _Mismatch, count: int, grid: Any, how: Narrowing
) -> list[tuple[int, int, float]]:
    """Every root of each row of ``mismatch(place, case)`` that a grid of places shows, in so many
    cases: case, row and root.

    NaN marks where a row has no answer. A change of sign is narrowed down, also between a grid
    point and the place where a row ends; where the mismatch comes near 0 and turns away again, its
    turning point is looked at, for two roots may hide there.
    """
    found = []
    for start in range(0, count, _BLOCK):
        cases = np.arange(start, min(start + _BLOCK, count))
        found += _roots_on_grid(mismatch, cases, grid, how)
    return found


def _roots_on_grid(
    mismatch: _Mismatch, cases: Any, grid: Any, how: Narrowing
) -> list[tuple[int, int, float]]:
    values = np.stack(list(mismatch(np.tile(grid, cases.size), np.repeat(cases, grid.size))))
    # Rows and cases in one, the cases of a row one after another.
    values = values.reshape(-1, grid.size)
    row, of = np.divmod(np.arange(len(values)), max(cases.size, 1))
    lines = _Lines(row, cases[of], np.broadcast_to(grid, values.shape), values)
    for number in range(how.closer):
        lines = _closer(mismatch, lines, how.near, min(number, 1))
    known, size = np.isfinite(lines.values), abs(lines.values)
    # What is before the first cell of a part is looked at with the part there.
    own = min(how.closer, 1)
    changes = abs(np.diff(lines.values))

    line, i = np.nonzero(known[:, own:-1] != known[:, own + 1 :])
    i += own
    i, outside = np.where(known[line, i], (i, i + 1), (i + 1, i))
    if how.closer:
        # The last cell before the end; of one that is not there the end is looked at.
        last = np.clip(np.minimum(i, 2 * i - outside), 0, changes.shape[1] - 1)
        near = ~(size[line, i] > how.near * changes[line, last])
        line, i, outside = line[near], i[near], outside[near]
    ending = lines.brackets(line, i, outside)
    ending = ending._replace(high=_narrowed(mismatch, ending, _last_answer, 1, how.turns).low)

    # Answers often fold where they end, so that two are in the cell before, or beside its start.
    places, values = _sampled(mismatch, ending, _PIECES)
    before, last = 2 * i - outside, lines.values.shape[1] - 1
    there = (before >= 0) & (before <= last)
    before = np.clip(before, 0, last)
    ahead = lines.places[line, before], np.where(there, lines.values[line, before], np.nan)
    before_end = _Lines(
        ending.row,
        ending.case,
        *(
            np.insert(part, 0, first, axis=1)
            for part, first in zip((places, values), ahead, strict=True)
        ),
    )
    looks = _looked_at(lines, how, own), _looked_at(before_end, how, 1)
    # What is 0 all the way changes no sign.
    flat = _Brackets(*(part[np.all(values == 0.0, axis=1)] for part in ending))
    around = _joined([one.around for one in looks])
    side = np.concatenate([one.side for one in looks])[:, np.newaxis]
    turn = _narrowed(
        mismatch,
        around,
        lambda v: np.argmin(np.where(np.isnan(v), np.inf, side * v), axis=1) - 1,
        2,
        how.turns,
    )
    beside = around._replace(high=turn.low), around._replace(low=turn.low)
    whole = _joined([*(one.changing for one in looks), *beside, flat])
    _, ends = _sampled(mismatch, whole, 1)
    changing = ends[:, 0] * ends[:, 1] <= 0.0
    crossed = _Brackets(*(part[changing] for part in whole))
    found = _narrowed(mismatch, crossed, _change_of_sign, 1, how.rounds)
    return sorted(
        _near_zero(mismatch, found, how.largest)
        | (_near_zero(mismatch, turn, how.touching) if how.touching >= 0.0 else set())
    )


class _Look(NamedTuple):
    """What lines show: the cells in which the sign changes, those around a turning point, and the
    sign there.
    """

    changing: _Brackets
    around: _Brackets
    side: Any


def _looked_at(lines: _Lines, how: Narrowing, own: int) -> _Look:
    """What lines show from the ``own`` cell of each on."""
    signs, size = np.sign(lines.values), abs(lines.values)
    line, i = np.nonzero(_changes(signs)[:, own:])
    changing = lines.brackets(line, i + own, i + own + 1)
    same = signs[:, :-1] * signs[:, 1:] > 0.0
    turning = same[:, :-1] & same[:, 1:]
    turning &= size[:, 1:-1] <= np.minimum(size[:, :-2], size[:, 2:])
    if how.closer:
        changes = abs(np.diff(lines.values))
        turning &= size[:, 1:-1] <= how.near * np.maximum(changes[:, :-1], changes[:, 1:])
    line, i = np.nonzero(turning)
    return _Look(changing, lines.brackets(line, i, i + 2), signs[line, i])


class _Lines(NamedTuple):
    """Places in a row, as many for each: its row and case, the places and the mismatch there."""

    row: Any
    case: Any
    places: Any
    values: Any

    def brackets(self, line: Any, low: Any, high: Any) -> _Brackets:
        """The intervals between two places of some lines."""
        ends = self.places[line, low], self.places[line, high]
        return _Brackets(self.row[line], self.case[line], *ends)


def _closer(mismatch: _Mismatch, lines: _Lines, near: float, own: int) -> _Lines:
    """The cells in which the mismatch may come to 0, each in pieces, with one more before it; the
    first of a line is ``own``.
    """
    size = abs(lines.values)
    changes = abs(np.diff(lines.values))
    # A cell that reaches where there is no answer has what changes beside it alone.
    padded = np.pad(changes, ((0, 0), (1, 1)), constant_values=np.nan)
    most = np.fmax(np.fmax(padded[:, :-2], padded[:, 2:]), changes)
    least = np.fmin(size[:, :-1], size[:, 1:])
    # A cell where answers end is: they may fall as a root does, which no cell beside it shows.
    ends = np.isfinite(size[:, :-1]) != np.isfinite(size[:, 1:])
    line, i = np.nonzero((ends | (np.isfinite(least) & ~(least > near * most)))[:, own:])
    i += own
    low, high = lines.places[line, i], lines.places[line, i + 1]
    part = _Brackets(lines.row[line], lines.case[line], low - (high - low) / _PIECES, high)
    return _Lines(part.row, part.case, *_sampled(mismatch, part, _PIECES + 1))


class _Brackets(NamedTuple):
    """Intervals of places: for each its row, its case and both ends."""

    row: Any
    case: Any
    low: Any
    high: Any


def _joined(parts: Sequence[_Brackets]) -> _Brackets:
    """All of these brackets."""
    return _Brackets(*(np.concatenate(part) for part in zip(*parts, strict=True)))


def _near_zero(
    mismatch: _Mismatch, brackets: _Brackets, largest: float
) -> set[tuple[int, int, float]]:
    """Case, row and the better end of each bracket at which the mismatch is not above this."""
    _, rest = _sampled(mismatch, brackets, 1)
    places = np.where(abs(rest[:, 0]) <= abs(rest[:, 1]), brackets.low, brackets.high)
    sure = np.min(abs(rest), axis=1, initial=np.inf) <= largest
    parts = (brackets.case, brackets.row, places)
    return set(zip(*(part[sure].tolist() for part in parts), strict=True))


def _sampled(mismatch: _Mismatch, brackets: _Brackets, pieces: int) -> tuple[Any, Any]:
    """Split each bracket into ``pieces``; gives the end points, and the mismatch of the bracket's
    row at them.
    """
    row, low, high = (part[:, np.newaxis] for part in (brackets.row, brackets.low, brackets.high))
    places = np.append(low + (high - low) * (np.arange(pieces) / pieces), high, axis=1)
    if not places.size:
        return places, places
    values = np.stack(list(mismatch(places.ravel(), np.repeat(brackets.case, pieces + 1)))).reshape(
        -1, *places.shape
    )
    return places, values[row, np.arange(len(row))[:, np.newaxis], np.arange(pieces + 1)]


def _narrowed(
    mismatch: _Mismatch,
    brackets: _Brackets,
    first_piece: Callable[[Any], Any],
    count: int,
    rounds: int,
) -> _Brackets:
    """Narrow the brackets by repeated subdivision, each time to ``count`` pieces from the one
    ``first_piece`` chooses.
    """
    for _ in range(rounds):
        places, values = _sampled(mismatch, brackets, _PIECES)
        if places.size:
            first, of = np.clip(first_piece(values), 0, _PIECES - count), range(len(places))
            brackets = brackets._replace(low=places[of, first], high=places[of, first + count])
    return brackets


def _changes(signs: Any) -> Any:
    """Where signs change from one place to the next; of a run of 0, its ends."""
    flat = (signs[:, :-1] == 0.0) & (signs[:, 1:] == 0.0)
    return (signs[:, :-1] * signs[:, 1:] <= 0.0) & ~flat


def _change_of_sign(values: Any) -> Any:
    signs = np.sign(values)
    return np.argmax(signs[:, :-1] * signs[:, 1:] <= 0.0, axis=1)


def _last_answer(values: Any) -> Any:
    return np.argmax(np.isnan(values), axis=1) - 1

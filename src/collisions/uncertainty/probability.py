"""The probability that a condition holds: which samples it holds in, asked for all of them at once,
and wherever those that are known from one side only may lie.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from itertools import product
from typing import Any, TypeAlias

import numpy as np

from ..messages.errors import InputError, NoSolutionError

Condition: TypeAlias = Callable[[Any], Any]
# Asks a condition again of other values of the outputs that it is on, as many as before, which a
# function gives for each output.
Again: TypeAlias = Callable[[Callable[[Any], Any]], Any]

# How far beyond its bound a sample is looked at, by the spread of all values: from a thousandth to
# a thousand times that, four places in each doubling, and infinity.
_BEYOND = 2.0 ** np.arange(-10.0, 10.0, 0.25)
# More outputs than this, each at its bound or at infinity, are too many to try together.
_TOGETHER = 6
_GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)


def holds_of_one(condition: Condition, name: str, values: Any, sides: Any = None) -> Any:
    """Samples of one output, 1 where the condition holds and 0 where not; NaN without an
    answer. Sides are 1 of a sample that says "at least", -1 of "at most", else 0.
    """
    answered = ~np.isnan(values)
    count = int(np.count_nonzero(answered))
    wanted = f"the array of {name!r} and returns {count} booleans, such as lambda x: x > 13.9"
    known = values[answered]
    found = np.full(len(values), math.nan)
    found[answered] = _booleans(condition, known, count, wanted)
    if sides is not None:
        own = sides[answered]
        others = (_booleans(condition, place, count, wanted) for place in _places(known, own))
        _refuse_undecided(found[answered], others, [name])
    return found


def holds(
    condition: Condition, columns: Mapping[str, Any], sides: Mapping[str, Any] | None = None
) -> Any:
    """Joint samples, 1 where the condition holds and 0 where not; NaN where an output that it
    reads has no answer. Sides by name are those of outputs known from one side in some samples.
    """
    read = _Read(columns)
    first = next(iter(columns))
    count = len(columns[first])
    wanted = (
        f"a dict of arrays ({', '.join(columns)}) and returns {count} booleans, such as lambda "
        f"at: at[{first!r}] > 13.9"
    )
    found = _booleans(condition, read, count, wanted).astype(np.float64)
    for name in read.names:
        found[np.isnan(columns[name])] = math.nan
    if np.isnan(found).all():
        raise NoSolutionError(
            f"no sample has an answer to all of {', '.join(map(repr, read.names))}, which the "
            "condition reads, so there is no probability of it",
            code="all_failed",
        )
    undecided = {name: side for name, side in (sides or {}).items() if name in read.names}
    if undecided:
        others = (
            _booleans(condition, {**columns, **place}, count, wanted)
            for place in _joint_places(columns, undecided)
        )
        _refuse_undecided(found, others, list(undecided))
    return found


def _places(values: Any, sides: Any, beyond: Any = _BEYOND) -> Iterator[Any]:
    """The samples elsewhere: those known from one side at places beyond their bounds, the last
    infinitely far.

    No two samples are looked at in the same places, so that together they leave no gap that a
    condition could hold in unseen.
    """
    known = values[np.isfinite(values)]
    size = float(np.ptp(known)) if known.size else 0.0
    size = size or float(np.max(np.abs(known), initial=0.0)) or 1.0
    apart = 2.0 ** (0.25 * np.mod(_GOLDEN * np.arange(len(values)), 1.0))
    for far in beyond:
        yield values + sides * (far * size * apart)
    yield _unbounded(values, sides)


def _unbounded(values: Any, sides: Any) -> Any:
    infinite = np.copysign(math.inf, sides)
    return np.where((sides == 0) | np.isnan(values), values, infinite)


def _joint_places(columns: Mapping[str, Any], sides: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """The same of several outputs: each alone, all of them at different places, and every choice of
    those that are infinite.
    """
    for name, side in sides.items():
        for place in _places(columns[name], side):
            yield {name: place}
    if len(sides) > 1:
        rng = np.random.default_rng(1)
        orders = [rng.permutation(len(_BEYOND)) for _ in sides]
        for at in zip(*orders, strict=True):
            yield {
                name: next(_places(columns[name], side, _BEYOND[[one]]))
                for one, (name, side) in zip(at, sides.items(), strict=True)
            }
    infinite = {name: _unbounded(columns[name], side) for name, side in sides.items()}
    if len(infinite) > _TOGETHER:
        yield infinite
        return
    for chosen in product((False, True), repeat=len(infinite)):
        names = [name for name, one in zip(infinite, chosen, strict=True) if one]
        if len(names) > 1:
            yield {name: infinite[name] for name in names}


def _refuse_undecided(found: Any, others: Iterator[Any], names: list[str]) -> None:
    """Refuse if in some sample the condition holds at one place where it may lie, and not at
    another.
    """
    answered = ~np.isnan(found)
    differ = np.zeros(len(found), dtype=bool)
    # What a condition makes of infinity warns of nothing.
    with np.errstate(all="ignore"):
        for other in others:
            differ |= answered & (other != (found == 1.0))
    if count := int(np.count_nonzero(differ)):
        these = f"{' and '.join(map(repr, names))} {'is' if len(names) == 1 else 'are'}"
        raise InputError(
            f"in at least {count} of {np.count_nonzero(answered)} samples the condition may "
            f"hold or not, because {these} known from one side only there, as at least or "
            "at most a value; ask a condition that does not depend on what lies beyond, or "
            "find a distribution with `reconstruct.posterior` and a prior",
            code="one_sided",
            argument="condition",
        )


class _Read(Mapping[str, Any]):
    """Columns by name, which keeps the names of those that were read."""

    def __init__(self, columns: Mapping[str, Any]) -> None:
        self._columns = columns
        self.names: dict[str, None] = {}

    def __getitem__(self, name: str) -> Any:
        column = self._columns[name]
        self.names[name] = None
        return column

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)


def _booleans(condition: Any, given: Any, count: int, wanted: str) -> Any:
    """What the condition says of each sample."""
    raised: Exception | None = None
    try:
        found = condition(given) if callable(condition) else condition
    except (TypeError, ValueError, AttributeError, LookupError) as error:
        # What 'and' between arrays, and a name that is not there, come to.
        found, raised = None, error
    if not isinstance(found, np.ndarray) or found.shape != (count,) or found.dtype != np.bool_:
        said = f". It raised {type(raised).__name__}: {str(raised).rstrip('.')}" if raised else ""
        raise InputError(
            f"condition must be a function that takes {wanted}; join two of them by & or |, not "
            f"by 'and'{said}",
            code="bad_condition",
            argument="condition",
        ) from raised
    return found

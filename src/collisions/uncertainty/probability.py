"""The probability that a condition holds: which samples it holds in, asked once for all of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any, TypeAlias

import numpy as np

from ..messages.errors import InputError, NoSolutionError

Condition: TypeAlias = Callable[[Any], Any]


def holds_of_one(condition: Condition, name: str, values: Any) -> Any:
    """By sample of one output, 1 where the condition holds and 0 where not; NaN without an
    answer.
    """
    answered = ~np.isnan(values)
    count = int(np.count_nonzero(answered))
    found = np.full(len(values), math.nan)
    found[answered] = _booleans(
        condition,
        values[answered],
        count,
        f"the array of {name!r} and returns {count} booleans, such as lambda x: x > 13.9",
    )
    return found


def holds(condition: Condition, columns: Mapping[str, Any]) -> Any:
    """By joint sample, 1 where the condition holds and 0 where not; NaN where an output that it
    reads has no answer.
    """
    read = _Read(columns)
    first = next(iter(columns))
    count = len(columns[first])
    found = _booleans(
        condition,
        read,
        count,
        f"a dict of arrays ({', '.join(columns)}) and returns {count} booleans, such as lambda "
        f"at: at[{first!r}] > 13.9",
    ).astype(np.float64)
    for name in read.names:
        found[np.isnan(columns[name])] = math.nan
    if np.isnan(found).all():
        raise NoSolutionError(
            f"no sample has an answer to all of {', '.join(map(repr, read.names))}, which the "
            "condition reads, so there is no probability of it",
            code="all_failed",
        )
    return found


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

"""Turns a kernel of named parts into one of plain numbers in a row, which can be recorded and run
in blocks.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache, wraps
from typing import Any, TypeAlias

# The type of a tuple and the forms of its parts; True for a number, None where nothing is given.
Form: TypeAlias = Any


def form_of(parts: tuple[Any, ...]) -> Form:
    """How the numbers of nested tuples are arranged; hashable."""
    return type(parts), tuple(
        [
            form_of(part) if isinstance(part, tuple) else None if part is None else True
            for part in parts
        ]
    )


def numbers_of(parts: Any) -> list[Any]:
    """The numbers of nested tuples in a row, without what is not given."""
    found: list[Any] = []
    for part in parts:
        if isinstance(part, tuple):
            found += numbers_of(part)
        elif part is not None:
            found.append(part)
    return found


@cache
def flattened(kernel: Callable[..., Any], form: Form) -> Callable[..., Any]:
    """The kernel as a function of the numbers of its arguments, which are arranged in this form,
    and of its settings behind them.
    """

    @wraps(kernel)
    def of_numbers(*given: Any) -> Any:
        row = iter(given)
        arguments = _arranged(form, row)
        return kernel(*arguments, *row)

    return of_numbers


def _arranged(form: Form, row: Iterator[Any]) -> Any:
    if form is None:
        return None
    if form is True:
        return next(row)
    kind, forms = form
    parts = [_arranged(part, row) for part in forms]
    return tuple(parts) if kind is tuple else kind(*parts)

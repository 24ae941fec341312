"""``options``: refuses numbers without a unit, for callers who want that; for the current thread or
task only.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from contextlib import AbstractContextManager, contextmanager
from contextvars import ContextVar
from functools import wraps
from typing import Any, TypeVar, cast

from ..messages.hints import hinted
from .refusals import yes_or_no

F = TypeVar("F", bound=Callable[..., Any])

# Or the names of the arguments that need one, among numbers of the package's own.
units_required: ContextVar[bool | frozenset[str]] = ContextVar("units_required", default=False)
_callers: ContextVar[bool] = ContextVar("_callers", default=False)
_with_unit: ContextVar[Collection[str]] = ContextVar("_with_unit", default=())


class Default(float):
    """A default in SI, which needs no unit where numbers of the caller do."""


class options:
    """Settings that hold from the call on, or in a ``with`` block until its end; in this thread or
    task only.

    Parameters
    ----------
    require_units : bool
        Whether a number without a unit is refused where one with a unit is expected, as in
        ``vx=20``: by vehicles, solvers, reverse solvers, ``travel``, ``diagnose``, ``left_out``,
        ``explain``, ``report`` and pictures. 0 and infinity need none, nor do the numbers of a
        distribution such as ``Normal(13, 1)`` where its dimension is not known; that of inputs of a
        ``Scene`` is, and that of readings and tolerances of what a model returns as Quantities.
        Models of ``propagate``, ``fit`` and ``posterior``, and a restitution that is a function of
        the closing speed, are called with SI numbers, and may pass them on.

    Raises
    ------
    InputError
        ``require_units`` is not True or False.

    Examples
    --------
    >>> import collisions as col
    >>> with col.options(require_units=True):  # doctest: +ELLIPSIS
    ...     col.Vehicle(mass="1500 kg", vx=20)
    Traceback (most recent call last):
    ...
    collisions.UnitsError: vx = 20 has no unit, and options(require_units=True) asks for one; ...
    """

    @hinted
    def __init__(self, *, require_units: bool) -> None:
        if not isinstance(require_units, bool):
            raise yes_or_no("require_units", require_units, code="bad_option")
        self._before = units_required.set(require_units)

    def __enter__(self) -> options:
        return self

    def __exit__(self, *error: object) -> None:
        units_required.reset(self._before)


def in_si(but: Collection[str] = ()) -> AbstractContextManager[None]:
    """Within this context numbers need no unit: they are the package's own, in SI; ``but`` for
    those of these arguments, which are the caller's.
    """
    return _set(units_required, units_required.get() and frozenset(but))


def unit_required(argument: str) -> bool:
    """Whether the caller asked for a unit of this argument, or of what this is an element of."""
    required = units_required.get()
    if isinstance(required, bool):
        return required
    return argument.partition("[")[0] in required


def callers_options() -> AbstractContextManager[None]:
    """Within this context a function under ``computing`` reads its own arguments, by the options of
    its caller.
    """
    return _set(units_required, _callers.get())


def given_with_unit(arguments: Collection[str]) -> AbstractContextManager[None]:
    """Within this context numbers of these arguments were given with a unit: they are read again,
    and no other unit may have been meant.
    """
    return _set(_with_unit, arguments)


def had_unit(argument: str) -> bool:
    """Whether this argument is one of ``given_with_unit``."""
    return argument in _with_unit.get()


@contextmanager
def _set(variable: ContextVar[Any], value: Any) -> Iterator[None]:
    token = variable.set(value)
    try:
        yield
    finally:
        variable.reset(token)


def computing(function: F) -> F:
    """Decorate a function that works on results: the numbers it gives on are the package's own, in
    SI.

    Its arguments are the caller's, and are read in ``callers_options``.
    """
    named = hinted(function)

    @wraps(function)
    def inside(*args: Any, **options: Any) -> Any:
        with _set(_callers, units_required.get()), in_si():
            return named(*args, **options)

    return cast(F, inside)

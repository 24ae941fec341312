"""Exceptions, warnings, and the status of each case of a batch."""

from __future__ import annotations

import pickle
from functools import partial
from typing import Any, TypeVar

from ..kernels.status import Status as Status
from .marked import plain


class _Carrying(BaseException):
    """Base that carries a label and named fields in addition to the message, through
    pickling too.

    ``marked`` is the message with its code in marks, as ``marked.py`` has them, and ``place`` what
    stands before it, such as the case of a batch.
    """

    def __init__(self, message: str = "", *, code: str = "", **fields: Any) -> None:
        self.place: str = fields.pop("place", "")
        self.marked = message
        self.code = code
        self.fields = fields
        super().__init__(f"{self.place}: {plain(message)}" if self.place else plain(message))

    @property
    def inner(self) -> str:
        """The message with its marks and its place, for a message that holds it."""
        return f"{self.place}: {self.marked}" if self.place else self.marked

    def __init_subclass__(cls) -> None:
        if cls.__module__ == __name__:
            # Tracebacks show the name that callers import, and pickles hold it.
            cls.__module__ = __name__.partition(".")[0]

    def __reduce__(self) -> tuple[Any, ...]:
        parts = {"code": self.code, "place": self.place, **self.fields}
        try:
            pickle.dumps(parts.get("given"))
        except Exception:
            del parts["given"]  # what was given may be anything, and the message shows it
        return partial(type(self), **parts), (self.marked,)


class CollisionsError(_Carrying, Exception):
    """Base of every error raised by this library.

    ``code`` is a short label that does not change between versions; ``fields`` holds what else is
    known of the case.
    """

    @property
    def solutions(self) -> tuple[Any, ...]:
        """The solutions known when the case was refused: all that fit, or the ends of their range;
        empty if there are none.
        """
        return tuple(self.fields.get("solutions", ()))


class InputError(CollisionsError, ValueError):
    """An argument that cannot be used: the message names it, what was given, what is allowed and
    what to write.

    Each of these is an attribute too, None where the message has no such part.
    """

    @property
    def argument(self) -> str | None:
        """The argument that cannot be used, such as "mass", "a.mass" or "point[0]"."""
        value: str | None = self.fields.get("argument")
        return value

    @property
    def given(self) -> Any:
        """The value that was given."""
        return self.fields.get("given")

    @property
    def allowed(self) -> str | None:
        """What the argument must be, such as "from 0 to 1"."""
        return self._part("allowed")

    @property
    def instead(self) -> str | None:
        """What to write instead, or why."""
        return self._part("instead")

    def _part(self, name: str) -> str | None:
        text = self.fields.get(name)
        return (text and plain(text).lstrip(";: ")) or None


class UnitsError(InputError):
    """A quantity or a unit string that cannot be read, or that is of another kind than the
    argument.
    """


class ShapeError(InputError):
    """An argument of the wrong shape, or arrays whose shapes do not go together."""


class MissingInputError(InputError):
    """Something the chosen model needs was not given; nothing is taken as zero in its place."""


class NoImpactError(CollisionsError, ValueError):
    """The bodies do not approach each other along the normal; ``closing_speed`` [m/s] tells by how
    much.
    """

    @property
    def closing_speed(self) -> float | None:
        """Closing speed of the refused case [m/s], if one could be worked out."""
        value: float | None = self.fields.get("closing_speed")
        return value


class NoSolutionError(CollisionsError, ValueError):
    """The arguments are in order, but the model has no answer for them."""


class AmbiguousSolutionError(NoSolutionError):
    """More than one answer fits; all of them are in ``solutions``."""


class InternalError(CollisionsError, RuntimeError):
    """A defect of this library, which it found itself: two numbers that must agree do not.

    Neither number may be used. ``fields`` has what was compared: for a line of ``explain`` its
    ``equation`` and ``share``, the difference over the largest term.
    """


class CollisionsWarning(_Carrying, UserWarning):
    """Base of every warning given by this library; carries ``code`` and ``fields`` like
    the errors.
    """


class EnergyGainWarning(CollisionsWarning):
    """The impact ends with more energy than it began with; the result is returned as it is."""


class IllConditionedWarning(CollisionsWarning):
    """The answer changes greatly when the input changes slightly."""


class SuspectUnitsWarning(CollisionsWarning):
    """A number without a unit whose size suggests a unit other than the one it is taken in."""


class OutOfRangeWarning(CollisionsWarning):
    """Some cases were refused, or a value lies outside the range its source covers."""


E = TypeVar("E", bound=_Carrying)


def placed(error: E, place: str, **fields: Any) -> E:
    """The same error with the place that it is of before its message, and with these fields too."""
    places = ": ".join(filter(None, (place, error.place)))
    return type(error)(error.marked, code=error.code, place=places, **(error.fields | fields))


def reworded(error: E, message: str) -> E:
    """The same error with another message, marked."""
    return type(error)(message, code=error.code, place=error.place, **error.fields)


def as_marked(error: _Carrying) -> str:
    """The whole message of an error with its code in marks."""
    return f"{error.place}: {error.marked}" if error.place else error.marked

"""Exceptions, warnings, and the status of each case of a batch."""

from __future__ import annotations

from functools import partial
from typing import Any

from ..kernels.status import Status as Status


class _Carrying(BaseException):
    """Base that carries a label and named fields in addition to the message, through
    pickling too.
    """

    def __init__(self, message: str = "", *, code: str = "", **fields: Any) -> None:
        super().__init__(message)
        self.code = code
        self.fields = fields

    def __init_subclass__(cls) -> None:
        if cls.__module__ == __name__:
            # Tracebacks show the name that callers import, and pickles hold it.
            cls.__module__ = __name__.partition(".")[0]

    def __reduce__(self) -> tuple[Any, ...]:
        return partial(type(self), code=self.code, **self.fields), (str(self),)


class CollisionsError(_Carrying, Exception):
    """Base of every error raised by this library.

    ``code`` is a short label that does not change between versions; ``fields`` holds what else is
    known of the case.
    """


class InputError(CollisionsError, ValueError):
    """An argument that cannot be used: the message names it, what was given, what is allowed and
    what to write.
    """


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

    @property
    def solutions(self) -> tuple[Any, ...]:
        """The solutions known when the case was refused: all that fit, or the ends of their range;
        empty if there are none.
        """
        return tuple(self.fields.get("solutions", ()))


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

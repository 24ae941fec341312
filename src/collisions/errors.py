"""What can go wrong and how it is said: exceptions, warnings, and the status of each case of a batch."""

from __future__ import annotations

from enum import IntEnum
from typing import Any

from .kernels import codes


class _Carrying(BaseException):
    """Carries a label and named fields beside the message, through pickling too."""

    def __init__(self, message: str = "", *, code: str = "", **fields: Any) -> None:
        super().__init__(message)
        self.code = code
        self.fields = fields

    def __reduce__(self) -> tuple[Any, ...]:
        return _rebuild, (type(self), str(self), self.code, self.fields)


def _rebuild(kind: type[Any], message: str, code: str, fields: dict[str, Any]) -> Any:
    return kind(message, code=code, **fields)


class CollisionsError(_Carrying, Exception):
    """Base of every error raised by this library.

    ``code`` is a short label that does not change between versions, ``fields`` what else is known of the case.
    """


class InputError(CollisionsError, ValueError):
    """An argument that cannot be used: the message names it, what was given, what is allowed and what to write."""


class UnitsError(InputError):
    """A quantity or a unit string that cannot be read, or that is of another kind than the argument."""


class ShapeError(InputError):
    """An argument of the wrong shape, or arrays whose shapes do not go together."""


class MissingInputError(InputError):
    """Something the chosen model needs was not given; nothing is taken as zero in its place."""


class NoImpactError(CollisionsError, ValueError):
    """The bodies do not approach each other along the normal; ``closing_speed`` [m/s] tells by how much."""

    @property
    def closing_speed(self) -> float | None:
        """Closing speed of the refused case [m/s], if one could be worked out."""
        value: float | None = self.fields.get("closing_speed")
        return value


class NoSolutionError(CollisionsError, ValueError):
    """The arguments are in order, but the model has no answer for them."""

    @property
    def solutions(self) -> tuple[Any, ...]:
        """What the refusal tells of answers: every one that fits, or the ends of their range; empty if there is none."""
        return tuple(self.fields.get("solutions", ()))


class AmbiguousSolutionError(NoSolutionError):
    """More than one answer fits; all of them are in ``solutions``."""


class CollisionsWarning(_Carrying, UserWarning):
    """Base of every warning given by this library; carries ``code`` and ``fields`` like the errors."""


class EnergyGainWarning(CollisionsWarning):
    """The model ends with more energy than it began with; the value is returned as it is."""


class IllConditionedWarning(CollisionsWarning):
    """The answer moves much when the input moves little."""


class SuspectUnitsWarning(CollisionsWarning):
    """A number without a unit whose size suggests another unit than the one it is taken in."""


class OutOfRangeWarning(CollisionsWarning):
    """Some cases were refused, or a value lies outside the range its source covers."""


class Status(IntEnum):
    """Outcome of one case; ``sentence`` says it in words.

    ``OK`` and ``ENERGY_GAIN`` come with numbers, every other status with NaN.
    """

    OK = codes.OK
    ENERGY_GAIN = codes.ENERGY_GAIN
    SEPARATING = codes.SEPARATING
    GRAZING = codes.GRAZING
    IMMOVABLE = codes.IMMOVABLE
    SINGULAR_CONTACT = codes.SINGULAR_CONTACT
    NO_SLIP_PULLS = codes.NO_SLIP_PULLS
    RATIO_JAMS = codes.RATIO_JAMS
    OUT_OF_RANGE = codes.OUT_OF_RANGE
    NOT_FINITE = codes.NOT_FINITE
    NOT_POSITIVE = codes.NOT_POSITIVE
    BAD_RESTITUTION = codes.BAD_RESTITUTION
    BAD_FRICTION = codes.BAD_FRICTION
    BAD_FRACTION = codes.BAD_FRACTION
    ZERO_NORMAL = codes.ZERO_NORMAL
    PINNED_INFINITE = codes.PINNED_INFINITE
    PINNED_VELOCITY = codes.PINNED_VELOCITY
    SPINNING = codes.SPINNING
    TRANSVERSE = codes.TRANSVERSE
    NO_CLOSING = codes.NO_CLOSING
    NOT_SEPARATING = codes.NOT_SEPARATING
    CONTRADICTORY = codes.CONTRADICTORY
    UNDETERMINED = codes.UNDETERMINED
    AMBIGUOUS = codes.AMBIGUOUS
    AMBIGUOUS_INVERSE = codes.AMBIGUOUS_INVERSE
    STICK_INVERSE = codes.STICK_INVERSE
    INVERSE_E0 = codes.INVERSE_E0
    INFINITE_MASS = codes.INFINITE_MASS
    PARALLEL_HEADINGS = codes.PARALLEL_HEADINGS

    @property
    def label(self) -> str:
        """The ``code`` of the error that a single case of this status raises."""
        return self.name.lower()

    @property
    def sentence(self) -> str:
        """What this status means."""
        return _SENTENCES[self]


_SENTENCES = {
    Status.OK: "solved",
    Status.ENERGY_GAIN: "solved, but the model ends with more energy than it began with",
    Status.SEPARATING: "the bodies move apart along the normal, which must point from A into B",
    Status.GRAZING: "the bodies do not approach along the normal: the closing speed is 0",
    Status.IMMOVABLE: "nothing can yield along the normal",
    Status.SINGULAR_CONTACT: "the contact has one degree of freedom, so a no-slip impulse is not defined",
    Status.NO_SLIP_PULLS: "without slip the bodies would have to pull at each other",
    Status.RATIO_JAMS: "the impulse ratio is at or beyond the value at which the bodies jam",
    Status.OUT_OF_RANGE: "the answer is not a finite number",
    Status.NOT_FINITE: "an input is NaN, or infinite where it may not be",
    Status.NOT_POSITIVE: "a mass or a yaw inertia is not greater than 0",
    Status.BAD_RESTITUTION: "the restitution is outside 0 to 1",
    Status.BAD_FRICTION: "the friction is below 0",
    Status.BAD_FRACTION: "the critical fraction is outside 0 to 1",
    Status.ZERO_NORMAL: "the normal has no length",
    Status.PINNED_INFINITE: "a pinned body has an infinite mass or yaw inertia",
    Status.PINNED_VELOCITY: "the velocity of a pinned body is not its yaw rate times the arm",
    Status.SPINNING: "a body turns, which the central models cannot answer",
    Status.TRANSVERSE: "a body moves across the normal, which the linear model cannot answer",
    Status.NO_CLOSING: "the bodies did not approach before: the closing speed is 0",
    Status.NOT_SEPARATING: "the bodies do not part after the impact",
    Status.CONTRADICTORY: "what was given contradicts itself",
    Status.UNDETERMINED: "what was given leaves the answer open",
    Status.AMBIGUOUS: "more than one answer fits",
    Status.AMBIGUOUS_INVERSE: "more than one state before the impact ends so",
    Status.STICK_INVERSE: "the contact ended without slip, which tells nothing of the slip before",
    Status.INVERSE_E0: "after a plastic impact nothing is left of the closing speed",
    Status.INFINITE_MASS: "the motion of an infinite mass tells nothing of the impact",
    Status.PARALLEL_HEADINGS: "the courses are parallel, so momentum across them tells nothing",
}

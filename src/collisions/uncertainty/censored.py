"""``Censored``: a reading of which only bounds are known, as an observation of a posterior."""

from __future__ import annotations

from ..errors import InputError, MissingInputError
from ..hints import hinted
from ..units import Input
from .distribution import Stated, check_order, read_alike, show


class Censored(Stated):
    """A reading of which only one bound is known, or both: at least, at most, or between.

    A recorder that ended early read at least what it had reached; a speed class or a display in steps reads between two values.
    As evidence it weighs by its probability: that of a reading within the bounds, when readings scatter about the truth with a
    normal error; without an error the truth itself lies within. ``Interval(low, high)`` says the same as an observation.

    Parameters
    ----------
    low, high : float, str or Quantity, optional
        The bounds, ``low`` < ``high``; at least one of them. SI, or all with a unit.
    error : float, str or Quantity, optional
        Standard deviation of the reading, > 0, in the same unit; without it the bounds are sharp.

    Raises
    ------
    InputError
        No bound, bounds not in order, or an error not above 0.
    UnitsError
        Some numbers with a unit and some without, or units of different kinds.

    Examples
    --------
    The recorder lost power at 28 km/h of delta-V, read to 1 km/h.

    >>> Censored(low="28 km/h", error="1 km/h")
    Censored(low=28 km/h, error=1 km/h)
    """

    __slots__ = ("error", "high", "low")

    low: float | None
    high: float | None
    error: float | None

    @hinted
    def __init__(self, low: Input | None = None, high: Input | None = None, error: Input | None = None) -> None:
        (start, end, sigma), unit = read_alike({}, {"low": low, "high": high, "error": error})
        self._make(unit, low=start, high=end, error=sigma)

    def _derive(self, low: float | None, high: float | None, error: float | None) -> None:
        if low is None and high is None:
            raise MissingInputError(
                "a censored reading needs a bound; write Censored(low=...) for at least, Censored(high=...) for at most",
                code="missing_bound",
                argument="low",
            )
        if low is not None and high is not None:
            check_order(low, high, unit=self.unit)
        if error is not None and not error > 0.0:
            raise InputError(
                f"error must be > 0, got {show(error, self.unit)}; leave it out where the bounds are sharp",
                code="not_positive",
                argument="error",
            )
        self._set(low=low, high=high, error=error)

    def __str__(self) -> str:
        bounds = (("at least", self.low), ("at most", self.high), ("±", self.error))
        return ", ".join(f"{word} {show(value, self.unit)}" for word, value in bounds if value is not None)

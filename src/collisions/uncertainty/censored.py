"""``Censored``: a reading of which only bounds are known, as an observation of a posterior."""

from __future__ import annotations

from ..errors import InputError, MissingInputError
from ..hints import hinted
from ..units import Input
from .distribution import Stated, check_order, read_alike, show


class Censored(Stated):
    """A reading known only to lie above a bound, below one, or between two.

    A recorder that ended early would have read at least what it had reached; a speed class or a display in steps gives two
    values with the reading between them. As evidence, it is weighted by the probability that a reading falls within the
    bounds, where readings are normally distributed about the truth with the standard deviation ``error``. Without an error, the
    truth itself lies within the bounds, and an observation ``Interval(low, high)`` says the same.

    Parameters
    ----------
    low, high : float, str or Quantity, optional
        The bounds, ``low`` < ``high``; give at least one. SI, or all with a unit.
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
    The recorder lost power after a delta-V of 28 km/h; its standard deviation is 1 km/h.

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

"""How each kind of evidence is weighed: one class a kind, with its residual and log-likelihood."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..messages.errors import InputError
from ..uncertainty.distributions import Censored, Normal
from ..uncertainty.normal import log_survival
from ..uncertainty.turns import folded

_LOG_ROOT_TURN = 0.5 * math.log(math.tau)


class Reading:
    """What was observed of one output, and how well computed values agree with it.

    A new kind of evidence is a subclass, and its entry in ``KINDS``. ``computed`` is an array of
    values of the output in SI, ``angle`` whether these go round.
    """

    __slots__ = ("name", "value")

    # Whether it was read as a value, beside which the range of what is computed can be shown.
    is_value = False

    def __init__(self, name: str, value: Any) -> None:
        self.name, self.value = name, value

    @property
    def sigma(self) -> float:
        """Stated error, which residuals are counted in; 0 of sharp bounds."""
        raise NotImplementedError

    def residual(self, computed: Any, angle: bool) -> Any:
        """Observed minus computed values, by the short way round for angles."""
        raise NotImplementedError

    def log_likelihood(self, computed: Any, angle: bool) -> Any:
        """Logarithm of the probability or density of what was observed, given these values."""
        raise NotImplementedError

    def misfit(self, computed: Any, angle: bool) -> Any:
        """Its share in the chi-squared of all evidence; 0 of sharp bounds, which are met."""
        return (self.residual(computed, angle) / self.sigma) ** 2 if self.sigma else 0.0

    def missed(self, computed: Any, angle: bool) -> Any:
        """The distance by which sharp bounds are missed; 0 for readings with an error."""
        return np.zeros(len(computed)) if self.sigma else abs(self.residual(computed, angle))

    def observed(self, computed: float, residual: float) -> float:
        """What is shown as observed beside a computed value: of bounds the one that is missed."""
        return computed + residual

    def middle(self, computed: Any, angle: bool, residual: float) -> float:
        """What is shown as computed of many values, with the mean of their residuals."""
        return float(np.mean(computed))


class ValueReading(Reading):
    """A value with a normally distributed error."""

    __slots__ = ()

    is_value = True
    value: Normal

    @property
    def sigma(self) -> float:
        """Its standard deviation."""
        return self.value.given_sd

    def residual(self, computed: Any, angle: bool) -> Any:
        """Observed minus computed."""
        return folded(self.value.given_mean - computed, math.pi if angle else None)

    def log_likelihood(self, computed: Any, angle: bool) -> Any:
        """Logarithm of the normal density."""
        # Round the circle the density is cut off at half a turn on both sides.
        lost = math.log(math.erf(math.pi / (self.sigma * math.sqrt(2.0)))) if angle else 0.0
        return (
            -0.5 * (self.residual(computed, angle) / self.sigma) ** 2
            - math.log(self.sigma)
            - _LOG_ROOT_TURN
            - lost
        )

    def observed(self, computed: float, residual: float) -> float:
        """The value as it was read."""
        return self.value.given_mean

    def middle(self, computed: Any, angle: bool, residual: float) -> float:
        """The mean that goes with the value as it was read, of an angle whatever its turns."""
        return self.value.given_mean - residual


class CensoredReading(Reading):
    """A reading of which only bounds are known, sharp or with an error."""

    __slots__ = ()

    value: Censored

    @property
    def sigma(self) -> float:
        """The standard deviation of the reading behind the bounds."""
        return self.value.error or 0.0

    def residual(self, computed: Any, angle: bool) -> Any:
        """The bound that is missed minus the computed value; 0 within the bounds."""
        below, above = self._beyond(computed, angle)
        return np.maximum(below, 0.0) - np.maximum(above, 0.0)

    def log_likelihood(self, computed: Any, angle: bool) -> Any:
        """Logarithm of the probability that a reading lies within the bounds."""
        if not self.sigma:
            return np.zeros(len(computed))
        below, above = (part / self.sigma for part in self._beyond(computed, angle))
        if self.value.high is None:
            return log_survival(below)
        if self.value.low is None:
            return log_survival(above)
        # The probability between two scores, of which the nearer tail keeps its digits.
        near, far = np.maximum(below, above), np.minimum(below, above)
        outside = log_survival(np.maximum(near, 0.0)) + np.log(
            -np.expm1(log_survival(-far) - log_survival(near))
        )
        inside = np.log1p(-np.exp(log_survival(-far)) - np.exp(log_survival(-near)))
        return np.where(near > 0.0, outside, inside)

    def middle(self, computed: Any, angle: bool, residual: float) -> float:
        """The mean of the values; of an angle as they lie about the bounds."""
        return float(np.mean(self._turned(computed) if angle else computed))

    def _turned(self, computed: Any) -> Any:
        """Angles within half a turn of the middle of their bounds, of which both are given."""
        middle = 0.5 * math.fsum(one for one in (self.value.low, self.value.high) if one)
        return middle - folded(middle - computed, math.pi)

    def _beyond(self, computed: Any, angle: bool) -> tuple[Any, Any]:
        """Distances of values below the low bound, and above the high one; -inf for a bound that is
        not there.
        """
        low, high = self.value.low, self.value.high
        if angle:
            if low is None or high is None:
                raise InputError(
                    f"observed {self.name} is an angle, which goes round, with one bound; give "
                    "both, `Censored(low, high)`, or let the model return a plain number",
                    code="bad_observation",
                    argument="observed",
                )
            computed = self._turned(computed)
        return (
            computed * 0.0 - np.inf if low is None else low - computed,
            -np.inf if high is None else computed - high,
        )


KINDS: dict[type, type[Reading]] = {Normal: ValueReading, Censored: CensoredReading}

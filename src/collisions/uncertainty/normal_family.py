"""Bell-shaped inputs: a normal distribution of a quantity or of its logarithm, of which a truncation keeps a part."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..errors import InputError, ShapeError
from ..reading import ArgumentReader
from ..units import Input, shown
from .distribution import Distribution, check_order, read_alike, show
from .kept import Moments, kept_score, moments
from .normal import cdf, quantile, score_of_coverage, survival

_LEAST_KEPT = 1e-12
_FARTHEST = 8.0  # less than the least share is kept beyond this many standard deviations
_UNNOTICED = 1e-40  # a share lost beyond 13 standard deviations shifts nothing by as much as rounding does

Bounds = tuple[Input | None, Input | None]


class Bell(Distribution):
    """Base of what is normal on some scale: ``given_mean`` and ``given_sd`` are those before truncation."""

    __slots__ = ("_lost", "given_mean", "given_sd", "truncate")

    given_mean: float
    given_sd: float
    truncate: tuple[float | None, float | None] | None
    _lost: tuple[float, float, float] | None

    def __init__(self, mean: Input, sd: Input, *, truncate: Bounds | None = None) -> None:
        (given_mean, given_sd, *bounds), unit = read_alike({"mean": mean, "sd": sd}, parts_of(truncate))
        self._make(unit, given_mean, given_sd, tuple(bounds))

    def _make(self, unit: str, *parts: Any) -> None:
        mean, sd, truncate = parts
        if not sd > 0.0:
            raise InputError(
                f"sd must be > 0, got {show(sd, unit)}; of a quantity that is known exactly give the number itself",
                code="not_positive",
                argument="sd",
            )
        bounds = None if truncate is None or truncate == (None, None) else truncate
        self._set(unit=unit, given_mean=mean, given_sd=sd, truncate=bounds, _lost=None)
        self._describe(*self._whole())
        if bounds is not None:
            low, high = (-math.inf if bounds[0] is None else bounds[0]), (math.inf if bounds[1] is None else bounds[1])
            check_order(low, high, "the bounds of truncate", unit)
            self._truncate(max(low, self.support[0]), min(high, self.support[1]))

    def _parts(self) -> dict[str, Any]:
        return {"mean": self.given_mean, "sd": self.given_sd, "truncate": self.truncate}

    def _truncate(self, low: float, high: float) -> None:
        """Keeps what lies between two bounds, if enough does."""
        steepness = self._steepness
        anchor = min(max(self._value(0.0), low), high)
        kept = None
        if low < high and abs(score := self._score(anchor)) <= _FARTHEST:
            start, end = self._between(anchor, low), self._between(anchor, high)
            if end - start >= _LEAST_KEPT:
                kept = moments(score, start, end, steepness)
        if kept is None or kept.share < _LEAST_KEPT:
            raise InputError(
                f"truncate={show(self.truncate, self.unit)} leaves less than {_LEAST_KEPT:g} of the probability of "
                f"{type(self).__name__}(mean={show(self.given_mean, self.unit)}, sd={show(self.given_sd, self.unit)}); "
                f"look for a wrong bound, or state what is known otherwise, for example by Uniform(low, high)",
                code="truncated_away",
                argument="truncate",
            )
        start, end = self._score(low), self._score(high)
        # The fourth moment looks this much further up than the probability does.
        if cdf(start) + survival(end - 4.0 * steepness) < _UNNOTICED:
            self._set(support=(low, high))
            return
        self._set(_lost=(cdf(start), kept.share, survival(end)))
        self._describe(*self._moved(anchor, kept), kept.skewness, kept.kurtosis, (low, high))

    @property
    def _steepness(self) -> float:
        """Growth of the logarithm of the quantity with the score; 0 where the quantity itself grows with it."""
        return 0.0

    def _whole(self) -> tuple[float, float, float, float, tuple[float, float]]:
        """Moments and support before truncation."""
        raise NotImplementedError

    def _value(self, score: Any) -> Any:
        """The value at a score of the distribution before truncation."""
        raise NotImplementedError

    def _score(self, value: float) -> float:
        """The score of a value in the distribution before truncation, where the mean scores half the steepness."""
        return self._between(self.given_mean, value) + 0.5 * self._steepness

    def _between(self, start: float, end: float) -> float:
        """The difference of the scores of two values."""
        raise NotImplementedError

    def _moved(self, anchor: float, kept: Moments) -> tuple[float, float]:
        """Mean and standard deviation of what is kept, from those about the anchor."""
        raise NotImplementedError

    def _scored(self, z: Any) -> Any:
        return self._inside(self._value(z)) if self._lost is None else super()._scored(z)

    def _at(self, below: Any, above: Any) -> Any:
        score = quantile(below) if self._lost is None else kept_score(below, above, *self._lost)
        return self._inside(self._value(score))

    def _inside(self, value: Any) -> Any:
        """The value, held inside bounds that rounding may have crossed."""
        if self.truncate is None:
            return value
        low, high = self.support
        return np.clip(value, low, high) if isinstance(value, np.ndarray) else min(max(value, low), high)


class Normal(Bell):
    """A quantity whose errors are many, small and independent: a normal distribution, cut off at what is possible.

    Parameters
    ----------
    mean, sd : float, str or Quantity
        Mean and standard deviation before truncation; ``sd`` > 0. SI, or all with a unit.
    truncate : tuple (low, high), optional
        What is physically possible; None leaves a side open. ``mean`` and ``sd`` of the result are those of the part that is
        kept, ``given_mean`` and ``given_sd`` those of the whole.

    Raises
    ------
    InputError
        ``sd`` not above 0, bounds not in order, or a truncation that keeps less than 1e-12 of the probability.
    UnitsError
        Some numbers with a unit and some without, or units of different kinds.

    Examples
    --------
    >>> Normal("60 km/h", "3 km/h")
    Normal(mean=16.67 m/s, sd=0.8333 m/s)
    >>> low_speed_restitution = Normal(0.1, 0.1, truncate=(0, 1))
    >>> round(low_speed_restitution.mean, 4), round(low_speed_restitution.sd, 4)
    (0.1288, 0.0794)
    """

    __slots__ = ()

    @classmethod
    def between(cls, low: Input, high: Input, coverage: Input, *, truncate: Bounds | None = None) -> Normal:
        """The normal distribution that has this share of its probability between two values, and as much below as above.

        Parameters
        ----------
        low, high : float, str or Quantity
            The range, such as that of a published table.
        coverage : float [1]
            Share of the probability inside, between 0 and 1, before truncation.
        truncate : tuple (low, high), optional
            What is physically possible, applied to the distribution found.

        Raises
        ------
        InputError
            A coverage that is not between 0 and 1, or a range that is not in order.

        Examples
        --------
        A drag factor that is said to lie between 0.65 and 0.85 in nineteen cases of twenty.

        >>> Normal.between(0.65, 0.85, 0.95)
        Normal(mean=0.75, sd=0.05102)
        """
        (start, end, *bounds), share, unit = read_range(low, high, coverage, truncate)
        mean, half = 0.5 * start + 0.5 * end, 0.5 * end - 0.5 * start
        return cls._of(unit, mean, half / score_of_coverage(share), tuple(bounds))

    def _whole(self) -> tuple[float, float, float, float, tuple[float, float]]:
        return self.given_mean, self.given_sd, 0.0, 3.0, (-math.inf, math.inf)

    def _value(self, score: Any) -> Any:
        with np.errstate(over="ignore"):
            return self.given_mean + self.given_sd * score

    def _between(self, start: float, end: float) -> float:
        return (end - start) / self.given_sd

    def _moved(self, anchor: float, kept: Moments) -> tuple[float, float]:
        return anchor + self.given_sd * kept.mean, self.given_sd * kept.sd


class LogNormal(Bell):
    """A quantity that cannot be below 0 and errs by factors: its logarithm is normal.

    Parameters
    ----------
    mean, sd : float, str or Quantity
        Mean and standard deviation of the quantity itself, not of its logarithm, before truncation; both > 0.
    truncate : tuple (low, high), optional
        What is physically possible; None leaves a side open.

    Raises
    ------
    InputError
        ``mean`` or ``sd`` not above 0, bounds not in order, or a truncation that keeps less than 1e-12 of the probability.
    UnitsError
        Some numbers with a unit and some without, or units of different kinds.

    Examples
    --------
    >>> stiffness = LogNormal("700 kN/m", "200 kN/m")
    >>> stiffness
    LogNormal(mean=700000 N/m, sd=200000 N/m)
    >>> round(stiffness.quantile(0.5))
    673067
    """

    __slots__ = ("_median", "_scale")

    _median: float
    _scale: float

    @classmethod
    def between(cls, low: Input, high: Input, coverage: Input, *, truncate: Bounds | None = None) -> LogNormal:
        """The lognormal distribution that has this share of its probability between two values, and as much below as above.

        Parameters
        ----------
        low, high : float, str or Quantity
            The range; ``low`` > 0.
        coverage : float [1]
            Share of the probability inside, between 0 and 1, before truncation.
        truncate : tuple (low, high), optional
            What is physically possible, applied to the distribution found.

        Raises
        ------
        InputError
            A coverage that is not between 0 and 1, or a range that is not in order or not above 0.

        Examples
        --------
        >>> round(LogNormal.between("0.5 s", "2 s", 0.9).quantile(0.95), 12)
        2.0
        """
        (start, end, *bounds), share, unit = read_range(low, high, coverage, truncate)
        _check_positive("low", start)
        scale = 0.5 * (math.log(end) - math.log(start)) / score_of_coverage(share)
        with np.errstate(over="ignore", invalid="ignore"):
            mean = float(math.sqrt(start) * math.sqrt(end) * np.exp(0.5 * scale * scale))
            sd = mean * float(np.sqrt(np.expm1(scale * scale)))
        return cls._of(unit, mean, sd, tuple(bounds))

    def _whole(self) -> tuple[float, float, float, float, tuple[float, float]]:
        mean, sd = self.given_mean, self.given_sd
        _check_positive("mean", mean)
        relative = sd / mean
        if relative == 0.0:
            raise InputError(
                f"sd = {sd:.6g} is nothing beside a mean of {mean:.6g}; of what is known exactly give the number itself",
                code="out_of_range",
                argument="sd",
            )
        growth = 1.0 + relative * relative
        scale = math.sqrt(math.log1p(relative * relative)) if relative > 1e-8 else relative
        self._set(_median=mean / math.sqrt(growth), _scale=scale)
        kurtosis = growth * growth * (growth * growth + 2.0 * growth + 3.0) - 3.0
        return mean, sd, relative * (growth + 2.0), kurtosis, (0.0, math.inf)

    @property
    def _steepness(self) -> float:
        return self._scale

    def _value(self, score: Any) -> Any:
        with np.errstate(over="ignore"):
            value = self._median * np.exp(self._scale * score)
        return value if isinstance(score, np.ndarray) else float(value)

    def _between(self, start: float, end: float) -> float:
        if end <= 0.0:
            return -math.inf
        near = 0.5 * start <= end <= 2.0 * start
        return (math.log1p((end - start) / start) if near else math.log(end) - math.log(start)) / self._scale

    def _moved(self, anchor: float, kept: Moments) -> tuple[float, float]:
        return anchor * (1.0 + kept.mean), anchor * kept.sd


def parts_of(truncate: Any) -> dict[str, Any]:
    """Both bounds of a truncation by the names that messages call them."""
    if truncate is None:
        return {"truncate[0]": None, "truncate[1]": None}
    if not isinstance(truncate, (tuple, list)) or len(truncate) != 2:
        raise ShapeError(
            f"truncate must be a pair (low, high), where None leaves a side open, got {shown(truncate)}",
            code="bad_shape",
            argument="truncate",
        )
    return {f"truncate[{i}]": bound for i, bound in enumerate(truncate)}


def read_range(low: Input, high: Input, coverage: Input, truncate: Bounds | None) -> tuple[list[Any], float, str]:
    """A range, the bounds of a truncation, and the share of the probability that the range is to hold."""
    numbers, unit = read_alike({"low": low, "high": high}, parts_of(truncate))
    reader = ArgumentReader()
    share = reader.number(coverage, "", "coverage")
    reader.close()
    if not isinstance(share, float) or not 0.0 < share < 1.0:
        raise InputError(
            f"coverage must be more than 0 and less than 1, such as 0.95, got {shown(coverage)}; a range that cannot be left "
            f"is Uniform(low, high), or Interval(low, high) where nothing is known of likelihood",
            code="bad_fraction",
            argument="coverage",
        )
    check_order(numbers[0], numbers[1], unit=unit)
    return numbers, share, unit


def _check_positive(name: str, value: float) -> None:
    if not value > 0.0:
        raise InputError(
            f"{name} must be > 0 for a lognormal distribution, got {value:.6g}; for a quantity of either sign use Normal",
            code="not_positive",
            argument=name,
        )

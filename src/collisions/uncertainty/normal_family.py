"""``Normal`` and ``LogNormal`` inputs, whole or truncated.

What a truncation leaves is measured from an anchor, the most likely of the values left, in standard
deviations of the whole. From there the density falls as exp(-t (t + 2 m) / 2), with m the score of
the anchor. This neither underflows nor cancels, however far out in a tail or however narrow the
range is. The moments are integrals of this density over the range by Gauss-Legendre quadrature,
whose terms all have the same sign; the closed forms are differences of nearly equal numbers there.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple, Self

import numpy as np

from ..messages.errors import InputError, ShapeError
from ..messages.hints import hinted
from ..quantities.formatting import typeset
from ..quantities.reading import ArgumentReader
from ..quantities.refusals import must_be
from ..quantities.sourced import source_of
from ..quantities.units import Input
from .distribution import Distribution, check_order, from_numbers, narrowest, read_alike, show
from .normal import cdf, density, power_of_two, quantile, score_of_coverage, survival

# Positive nodes of the Gauss-Legendre rule of 12 points and their weights: numpy's come from
# eigenvalues, which leaves the weights 40 roundings off and the last digits to the machine.
_POSITIVE = (
    0.9815606342467192, 0.9041172563704749, 0.7699026741943047, 0.5873179542866175,
    0.3678314989981802, 0.1252334085114689,
)  # fmt: skip
_WEIGHTS = (
    0.04717533638651183, 0.10693932599531843, 0.16007832854334622, 0.20316742672306592,
    0.2334925365383548, 0.24914704581340277,
)  # fmt: skip
_NODES = np.array((*_POSITIVE, *(-x for x in _POSITIVE)))
_PANELS = 2.0  # to a standard deviation
_NEGLIGIBLE = 55.0  # below exp(-55) of its peak an integrand is negligible relative to 1e-16
_LEAST_SHARE = 1e-12  # of the probability, that a truncation must leave
_FARTHEST = 8.0  # less than the least share is left beyond this many standard deviations
_UNNOTICED = (
    1e-40  # probability cut off beyond 13 standard deviations shifts results by less than rounding
)

Truncation = tuple[Input | None, Input | None]


class NormalFamily(Distribution):
    """Base of distributions that are normal on some scale; ``given_mean`` and ``given_sd`` are
    those before truncation.
    """

    __slots__ = ("_split", "given_mean", "given_sd", "truncate")

    given_mean: float
    given_sd: float
    truncate: tuple[float | None, float | None] | None
    # Shares of the probability before truncation: below the lower bound, between both, and above
    # the upper one.
    _split: tuple[float, float, float] | None
    # Standard deviation of the quantity's logarithm; 0 for Normal, which is linear in the score.
    _log_sd: float = 0.0

    # Mean and standard deviation, before truncation, for which two values have the scores -score
    # and +score.
    _from_quantiles: Callable[[float, float, float], tuple[float, float]]
    # Moments and support before truncation, the value at a score there, and the difference of the
    # scores of two values.
    _untruncated: Callable[[], tuple[float, float, float, float, tuple[float, float]]]
    _value: Callable[[Any], Any]
    _between: Callable[[float, float], float]
    # Mean and standard deviation after truncation, from those about the anchor.
    _moved: Callable[[float, Moments], tuple[float, float]]

    @hinted
    def __init__(self, mean: Input, sd: Input, *, truncate: Truncation | None = None) -> None:
        given_mean, given_sd, bounds, unit = _read({"mean": mean, "sd": sd}, truncate)
        self._make(unit, mean=given_mean, sd=given_sd, truncate=bounds)
        self._set(source=source_of(mean))

    def __str__(self) -> str:
        if self._range is not None:
            low, high, share = self._range
            text = self._written(
                f"{{low}} to {{high}} ({100.0 * share:.10g} percent)", {"low": low, "high": high}
            )
        else:
            within = narrowest(self.given_mean, self.given_mean + self.given_sd)
            mean, sd = (
                show(value, self.unit, within) for value in (self.given_mean, self.given_sd)
            )
            _, apart, unit = mean.partition(" ")
            text = f"{mean.removesuffix(apart + unit)} ± {sd}"
        ends = zip(("at least", "at most"), self.truncate or (), strict=False)
        parts = [
            text,
            *(
                f"{bound} {show(end, self.unit, narrowest(self.mean, self.mean + self.sd))}"
                for bound, end in ends
                if end is not None
            ),
        ]
        # A mean ± a deviation alone is taken to be of a normal distribution.
        if self._range is not None or self._log_sd:
            parts.append(self._words)
        return typeset(", ".join(parts))

    @classmethod
    def between(
        cls, low: Input, high: Input, coverage: Input, *, truncate: Truncation | None = None
    ) -> Self:
        """The distribution of this kind with a given share of its probability between two values,
        and as much below as above.

        Parameters
        ----------
        low, high : float, str or Quantity
            The range, such as one from a published table; above 0 for a lognormal distribution.
        coverage : float [1]
            Share of the probability inside the range before truncation, between 0 and 1.
        truncate : tuple (low, high), optional
            Bounds of what is physically possible, applied to the distribution found.

        Returns
        -------
        LogNormal
            With this range as its central one.

        Raises
        ------
        InputError
            A coverage not between 0 and 1, or a range that is not in order or, for a lognormal
            distribution, not above 0.

        Examples
        --------
        A drag factor that is said to lie between 0.65 and 0.85 in nineteen cases out of twenty.

        >>> Normal.between(0.65, 0.85, 0.95)
        Normal(mean=0.75, sd=0.0510213456924654)
        >>> round(LogNormal.between("0.5 s", "2 s", 0.9).quantile(0.95), 12)
        2.0
        """
        start, end, bounds, unit = _read({"low": low, "high": high}, truncate)
        reader = ArgumentReader()
        share = reader.number(coverage, "", "coverage")
        reader.close()
        if not isinstance(share, float) or not 0.0 < share < 1.0:
            raise must_be(
                "coverage",
                "more than 0 and less than 1, such as 0.95",
                coverage,
                "; a range that cannot be left is `Uniform(low, high)`, or `Interval(low, "
                "high)` where nothing is known of likelihood",
                code="bad_fraction",
            )
        check_order(start, end, unit=unit)
        mean, sd = cls._from_quantiles(start, end, score_of_coverage(share))
        return from_numbers(
            cls, unit, {"mean": mean, "sd": sd, "truncate": bounds}, (start, end, share)
        )

    def _derive(
        self, mean: float, sd: float, truncate: tuple[float | None, float | None] | None
    ) -> None:
        if not sd > 0.0:
            raise must_be(
                "sd",
                "> 0",
                sd,
                "; of a quantity that is known exactly give the number itself",
                code="not_positive",
                got=show(sd, self.unit),
            )
        self._set(given_mean=mean, given_sd=sd, truncate=truncate, _split=None)
        self._describe(*self._untruncated())
        if truncate is not None:
            low, high = (
                (-math.inf if truncate[0] is None else truncate[0]),
                (math.inf if truncate[1] is None else truncate[1]),
            )
            check_order(low, high, "the bounds of truncate", self.unit)
            self._truncate(max(low, self.support[0]), min(high, self.support[1]))

    def _truncate(self, low: float, high: float) -> None:
        """Truncate to two bounds; refused if too little probability is left."""
        log_sd = self._log_sd
        anchor = min(max(float(self._value(0.0)), low), high)
        left = None
        if low < high and abs(score := self._score(anchor)) <= _FARTHEST:
            start, end = self._between(anchor, low), self._between(anchor, high)
            if end - start >= _LEAST_SHARE:
                left = moments(score, start, end, log_sd)
        if left is None or left.share < _LEAST_SHARE:
            raise InputError(
                f"`truncate={show(self.truncate, self.unit)}` leaves less than {_LEAST_SHARE:g} of "
                "the probability of "
                f"`{type(self).__name__}(mean={show(self.given_mean, self.unit)}, "
                f"sd={show(self.given_sd, self.unit)})`; look for a wrong bound, or state what is "
                "known otherwise, for example by `Uniform(low, high)`",
                code="truncated_away",
                argument="truncate",
            )
        start, end = self._score(low), self._score(high)
        # The fourth moment looks this much further up than the probability does.
        if cdf(start) + survival(end - 4.0 * log_sd) < _UNNOTICED:
            self._set(support=(low, high))
            return
        self._set(_split=(cdf(start), left.share, survival(end)))
        self._describe(*self._moved(anchor, left), left.skewness, left.kurtosis, (low, high))

    def _score(self, value: float) -> float:
        """The score of a value in the distribution before truncation, where the mean scores half
        the standard deviation of the logarithm.
        """
        return self._between(self.given_mean, value) + 0.5 * self._log_sd

    def _scored(self, z: Any) -> Any:
        return self._inside(self._value(z)) if self._split is None else super()._scored(z)

    def _at(self, below: Any, above: Any) -> Any:
        if self._split is None:
            return self._inside(self._value(quantile(below)))
        lost_below, share, lost_above = self._split
        lower, upper = lost_below + below * share, lost_above + above * share
        # The smaller side decides, so that nothing is lost near either end.
        score = quantile(np.asarray(np.minimum(lower, upper)))
        value = self._inside(self._value(np.where(lower <= upper, score, -score)))
        # The bounds themselves, whatever the last digit of the system's erfc makes of them.
        low, high = self.support
        return np.where(
            np.asarray(below) == 0.0, low, np.where(np.asarray(above) == 0.0, high, value)
        )

    def _inside(self, value: Any) -> Any:
        """The value, clipped to bounds that rounding may have crossed."""
        return value if self.truncate is None else np.clip(value, *self.support)


def is_whole_normal(distribution: Distribution) -> bool:
    """Whether the values of a distribution are worked out from normal scores, also where they are
    asked for by probability.
    """
    return isinstance(distribution, NormalFamily) and distribution._split is None


class Normal(NormalFamily):
    """A quantity whose error is the sum of many small, independent ones: a normal distribution, cut
    off at what is possible.

    Parameters
    ----------
    mean, sd : float, str or Quantity
        Mean and standard deviation before truncation; ``sd`` > 0. SI, or all with a unit.
    truncate : tuple (low, high), optional
        Bounds of what is physically possible; None or an infinity leaves a side open. The
        attributes ``mean`` and ``sd`` are those of the part that is kept, ``given_mean`` and
        ``given_sd`` those of the whole.

    Raises
    ------
    InputError
        ``sd`` not above 0, bounds not in order, or a truncation that keeps less than 1e-12 of the
        probability.
    UnitsError
        Some numbers with a unit and some without, or units of different kinds.

    Examples
    --------
    >>> Normal("60 km/h", "3 km/h")
    Normal(mean=60 km/h, sd=3 km/h)
    >>> low_speed_restitution = Normal(0.1, 0.1, truncate=(0, 1))
    >>> round(low_speed_restitution.mean, 4), round(low_speed_restitution.sd, 4)
    (0.1288, 0.0794)
    """

    __slots__ = ()

    _words = "normal"

    @staticmethod
    def _from_quantiles(low: float, high: float, score: float) -> tuple[float, float]:
        return 0.5 * low + 0.5 * high, (0.5 * high - 0.5 * low) / score

    def _untruncated(self) -> tuple[float, float, float, float, tuple[float, float]]:
        return self.given_mean, self.given_sd, 0.0, 3.0, (-math.inf, math.inf)

    def _value(self, score: Any) -> Any:
        with np.errstate(over="ignore"):
            return self.given_mean + self.given_sd * score

    def _between(self, start: float, end: float) -> float:
        return (end - start) / self.given_sd

    def _moved(self, anchor: float, left: Moments) -> tuple[float, float]:
        return anchor + self.given_sd * left.mean, self.given_sd * left.sd


class LogNormal(NormalFamily):
    """A quantity that cannot be below 0 and is known to within a factor: its logarithm is normal.

    Parameters
    ----------
    mean, sd : float, str or Quantity
        Mean and standard deviation of the quantity itself, not of its logarithm, before truncation;
        both > 0.
    truncate : tuple (low, high), optional
        Bounds of what is physically possible; None or an infinity leaves a side open.

    Raises
    ------
    InputError
        ``mean`` or ``sd`` not above 0, bounds not in order, or a truncation that keeps less than
        1e-12 of the probability.
    UnitsError
        Some numbers with a unit and some without, or units of different kinds.

    Examples
    --------
    >>> stiffness = LogNormal("700 kN/m", "200 kN/m")
    >>> stiffness
    LogNormal(mean=700 kN/m, sd=200 kN/m)
    >>> round(stiffness.quantile(0.5))
    673067
    """

    __slots__ = ("_log_sd", "_median")

    _words = "log-normal"

    _median: float

    @staticmethod
    def _from_quantiles(low: float, high: float, score: float) -> tuple[float, float]:
        _check_positive("low", low)
        scale = 0.5 * (math.log(high) - math.log(low)) / score
        with np.errstate(over="ignore", invalid="ignore"):
            mean = float(math.sqrt(low) * math.sqrt(high) * np.exp(0.5 * scale * scale))
            return mean, mean * float(np.sqrt(np.expm1(scale * scale)))

    def _untruncated(self) -> tuple[float, float, float, float, tuple[float, float]]:
        mean, sd = self.given_mean, self.given_sd
        _check_positive("mean", mean)
        relative = sd / mean
        if relative == 0.0:
            raise InputError(
                f"sd = {sd:.6g} is nothing beside a mean of {mean:.6g}; of what is known exactly "
                "give the number itself",
                code="out_of_range",
                argument="sd",
            )
        growth = 1.0 + relative * relative
        scale = math.sqrt(math.log1p(relative * relative)) if relative > 1e-8 else relative
        self._set(_median=mean / math.sqrt(growth), _log_sd=scale)
        kurtosis = growth * growth * (growth * growth + 2.0 * growth + 3.0) - 3.0
        return mean, sd, relative * (growth + 2.0), kurtosis, (0.0, math.inf)

    def _value(self, score: Any) -> Any:
        with np.errstate(over="ignore"):
            return self._median * np.exp(self._log_sd * score)

    def _between(self, start: float, end: float) -> float:
        if end <= 0.0:
            return -math.inf
        near = 0.5 * start <= end <= 2.0 * start
        return (
            math.log1p((end - start) / start) if near else math.log(end) - math.log(start)
        ) / self._log_sd

    def _moved(self, anchor: float, left: Moments) -> tuple[float, float]:
        return anchor * (1.0 + left.mean), anchor * left.sd


class Moments(NamedTuple):
    """The probability that a truncation leaves, and the moments of the rest."""

    share: float
    mean: float
    sd: float
    skewness: float
    kurtosis: float


def moments(anchor: float, low: float, high: float, log_sd: float = 0.0) -> Moments:
    """Moments of t between low <= 0 and high >= 0 from the anchor's score, or of exp(log_sd t) -
    1 if log_sd > 0.
    """
    # The fourth power of exp(log_sd t) has its peak this much further up.
    tilt = 4.0 * log_sd
    start = max(low, -_support_width(anchor))
    end = min(high, max(0.0, tilt - anchor) + _support_width(max(0.0, anchor - tilt)))
    panels = max(1, math.ceil(max(_PANELS, log_sd) * (end - start)))
    half = 0.5 * (end - start) / panels
    t = (start + half * (2.0 * np.arange(panels)[:, None] + 1.0 + _NODES)).reshape(-1)
    weighted = np.tile(_WEIGHTS, 2 * panels) * (half * np.exp(-0.5 * t * (t + 2.0 * anchor)))
    with np.errstate(all="ignore"):
        value = np.expm1(log_sd * t) if log_sd else t
        scale = power_of_two(value)
        value = value / scale
        total = float(np.sum(weighted))
        mean = float(np.sum(weighted * value)) / total
        away = value - mean
        sd = math.sqrt(float(np.sum(weighted * away**2)) / total)
        away /= sd
        third, fourth = (float(np.sum(weighted * away**power)) / total for power in (3, 4))
    return Moments(float(density(anchor)) * total, scale * mean, scale * sd, third, fourth)


def _support_width(score: float) -> float:
    """The distance from a score, away from the centre, over which the density is not negligible."""
    return 2.0 * _NEGLIGIBLE / (math.sqrt(score * score + 2.0 * _NEGLIGIBLE) + abs(score))


def _read(
    needed: dict[str, Any], truncate: Any
) -> tuple[float, float, tuple[float | None, ...] | None, str]:
    """Two numbers, the bounds of a truncation or None where both sides are open, and the unit of
    all.
    """
    if truncate is None:
        truncate = (None, None)
    if not isinstance(truncate, (tuple, list)) or len(truncate) != 2:
        raise must_be(
            "truncate",
            "a pair `(low, high)`, where `|None|-inf or inf` leaves a side open",
            truncate,
            code="bad_shape",
            kind=ShapeError,
        )
    bounds = {
        f"truncate[{i}]": None if _is_written(bound, infinity) else bound
        for i, (bound, infinity) in enumerate(zip(truncate, ("-inf", "inf"), strict=True))
    }
    (one, other, *ends), unit = read_alike(needed, bounds)
    return one, other, None if ends == [None, None] else tuple(ends), unit


def _is_written(bound: Any, text: str) -> bool:
    """Whether a text or a number reads so; of anything else the reader says what it is."""
    return isinstance(bound, (str, float, np.generic, np.ndarray)) and str(bound) == text


def _check_positive(name: str, value: float) -> None:
    if not value > 0.0:
        raise InputError(
            f"{name} must be > 0 for a lognormal distribution, got {value:.6g}; for a quantity "
            "of either sign use Normal",
            code="not_positive",
            argument=name,
        )

"""How likely a misfit this large is by chance: the upper tail of the chi-squared distribution."""

from __future__ import annotations

import math

_EPS = 2.0**-52
_TERMS = 10_000  # both expansions take about 6 sqrt(dof) terms at worst
_TINY = 1e-300


def survival(chi_squared: float, degrees_of_freedom: int) -> float:
    """Probability that a chi-squared variable exceeds the value: the regularised upper incomplete gamma function.

    The power series below the mean, the continued fraction by Lentz's method above (Abramowitz and Stegun 6.5.29, 6.5.31). NaN
    without degrees of freedom.
    """
    if degrees_of_freedom < 1 or math.isnan(chi_squared):
        return math.nan
    a, x = 0.5 * degrees_of_freedom, 0.5 * chi_squared
    if x <= 0.0:
        return 1.0
    if math.isinf(x):
        return 0.0
    front = math.exp(a * math.log(x) - x - math.lgamma(a))
    return 1.0 - front * _series(a, x) if x < a + 1.0 else front * _fraction(a, x)


def _series(a: float, x: float) -> float:
    term = total = 1.0 / a
    for k in range(1, _TERMS):
        term *= x / (a + k)
        total += term
        if term <= _EPS * total:
            break
    return total


def _fraction(a: float, x: float) -> float:
    b = x + 1.0 - a
    c, d = 1.0 / _TINY, 1.0 / b
    product = d
    for k in range(1, _TERMS):
        factor = k * (a - k)
        b += 2.0
        d = factor * d + b
        d = 1.0 / (d if d != 0.0 else _TINY)
        c = b + factor / c
        c = c if c != 0.0 else _TINY
        product *= c * d
        if abs(c * d - 1.0) <= 4.0 * _EPS:
            break
    return product

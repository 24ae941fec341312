"""The standard normal distribution: its quantiles, both its tails and its density.

Quantiles by M. J. Wichura, "Algorithm AS 241: The Percentage Points of the Normal Distribution",
Applied Statistics 37 (1988) 477-484: rational approximations good to 1e-16, one for the middle 85
percent and two for the tails. Tails of arrays by one series over the whole half line, after M. M.
Shepherd and J. G. Laframboise, "Chebyshev Approximation of (1 + 2x) exp(x^2) erfc x in 0 <= x <
infinity", Mathematics of Computation 36 (1981) 249-253, those of floats by ``math.erfc``. A
probability is as accurate as one rounding error in z allows, which far out is z**2 roundings of the
probability.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

_MIDDLE = 0.425  # half of the probability that the first approximation covers
_MIDDLE_TOP = (
    2.5090809287301226727e3, 3.3430575583588128105e4, 6.7265770927008700853e4,
    4.5921953931549871457e4, 1.3731693765509461125e4,
    1.9715909503065514427e3, 1.3314166789178437745e2, 3.3871328727963666080e0,
)  # fmt: skip
_MIDDLE_BOTTOM = (
    5.2264952788528545610e3, 2.8729085735721942674e4, 3.9307895800092710610e4,
    2.1213794301586595867e4, 5.3941960214247511077e3,
    6.8718700749205790830e2, 4.2313330701600911252e1, 1.0,
)  # fmt: skip
_NEAR = 5.0  # the root of -log(p) up to which the second approximation holds: p = 1.4e-11
_NEAR_TOP = (
    7.74545014278341407640e-4, 2.27238449892691845833e-2, 2.41780725177450611770e-1,
    1.27045825245236838258e0,
    3.64784832476320460504e0, 5.76949722146069140550e0, 4.63033784615654529590e0,
    1.42343711074968357734e0,
)  # fmt: skip
_NEAR_BOTTOM = (
    1.05075007164441684324e-9, 5.47593808499534494600e-4, 1.51986665636164571966e-2,
    1.48103976427480074590e-1,
    6.89767334985100004550e-1, 1.67638483018380384940e0, 2.05319162663775882187e0, 1.0,
)  # fmt: skip
_FAR_TOP = (
    2.01033439929228813265e-7, 2.71155556874348757815e-5, 1.24266094738807843860e-3,
    2.65321895265761230930e-2,
    2.96560571828504891230e-1, 1.78482653991729133580e0, 5.46378491116411436990e0,
    6.65790464350110377720e0,
)  # fmt: skip
_FAR_BOTTOM = (
    2.04426310338993978564e-15, 1.42151175831644588870e-7, 1.84631831751005468180e-5,
    7.86869131145613259100e-4,
    1.48753612908506148525e-2, 1.36929880922735805310e-1, 5.99832206555887937690e-1, 1.0,
)  # fmt: skip
# (1 + z) exp(z**2 / 2) times the probability above z, in powers of (z - 5) / (z + 5), highest
# first: its Chebyshev series cut where the terms fall below 2e-17.
_TAIL_CENTRE = 5.0
_NOTHING_BEYOND = 40.0  # standard deviations: the density is 0 as a float
_TAIL = (
    -3.815900213168514e-10, -2.822113988910648e-10, 4.401206334797407e-09, 3.6273927483026778e-09,
    -3.095213028954096e-08,
    -2.6286250023052777e-08, 1.9627825386664567e-07, 1.278782799028087e-07,
    -1.3074487347811043e-06, -7.034649330219469e-08,
    9.059824755430115e-06, -9.896097735484758e-06, -5.36075811419228e-05, 0.00018233414510864388,
    7.791597415650245e-06,
    -0.0016760723445528852, 0.006522000667783001, -0.01517041540251505, 0.02453696324367872,
    -0.026401042966308297,
    0.01000235238522938, 0.031030368425963708, -0.09155228183400904, 0.46151582985003775,
)  # fmt: skip
_ROOT_HALF = math.sqrt(0.5)
_DENSITY_AT_ZERO = 1.0 / math.sqrt(2.0 * math.pi)


def quantile(p: Any) -> Any:
    """The value that a standard normal variable stays below with probability p: -inf at 0, inf at
    1, NaN outside.
    """
    flat = np.ravel(p)
    with np.errstate(all="ignore"):
        offset = flat - 0.5
        found = offset * _ratio(_MIDDLE_TOP, _MIDDLE_BOTTOM, _MIDDLE * _MIDDLE - offset * offset)
        places = np.flatnonzero(~(np.abs(offset) <= _MIDDLE))
        if places.size:
            outer = flat[places]
            root = np.sqrt(-np.log(np.minimum(outer, 1.0 - outer)))
            distance = _ratio(_NEAR_TOP, _NEAR_BOTTOM, root - 1.6)
            far = np.flatnonzero(root > _NEAR)
            if far.size:
                distance[far] = _ratio(_FAR_TOP, _FAR_BOTTOM, root[far] - _NEAR)
                distance[np.isinf(root)] = np.inf
            found[places] = np.copysign(distance, offset[places])
    return found.reshape(np.shape(p)) if isinstance(p, np.ndarray) else float(found[0])


def score_of_coverage(coverage: float) -> float:
    """Half the width, in standard deviations, of the central range that holds this share of a
    normal distribution.
    """
    if coverage <= 2.0 * _MIDDLE:
        # Halved last: half of the least float is 0.
        return 0.5 * float(
            coverage
            * _ratio(_MIDDLE_TOP, _MIDDLE_BOTTOM, _MIDDLE * _MIDDLE - 0.25 * coverage * coverage)
        )
    return -float(quantile(0.5 * (1.0 - coverage)))


def cdf(z: Any) -> Any:
    """The probability below z, accurate in the lower tail too."""
    return survival(-z)


def survival(z: Any) -> Any:
    """The probability above z, accurate in the upper tail too."""
    if not isinstance(z, np.ndarray):
        return 0.5 * math.erfc(z * _ROOT_HALF)
    smaller = _beyond(np.abs(z))
    return np.where(z > 0.0, smaller, 1.0 - smaller)


def both_tails(z: Any) -> tuple[Any, Any]:
    """The probabilities below and above z, each accurate where it is small too."""
    if not np.ndim(z):
        return cdf(float(z)), survival(float(z))
    smaller = _beyond(np.abs(z))
    larger = 1.0 - smaller
    below = z < 0.0
    return np.where(below, smaller, larger), np.where(below, larger, smaller)


def density(z: float) -> float:
    """The density at z."""
    return _DENSITY_AT_ZERO * math.exp(-0.5 * z * z)


def _ratio(top: tuple[float, ...], bottom: tuple[float, ...], x: Any) -> Any:
    found = _polynomial(top, x)
    found /= _polynomial(bottom, x)
    return found


def _polynomial(coefficients: tuple[float, ...], x: Any) -> Any:
    """The polynomial with these coefficients, highest first."""
    found = coefficients[0] * x
    for coefficient in coefficients[1:-1]:
        found += coefficient
        found *= x
    found += coefficients[-1]
    return found


def _beyond(distance: Any) -> Any:
    """The probability beyond distances >= 0 on one side."""
    distance = np.minimum(distance, _NOTHING_BEYOND)
    return _beside_exponential(distance) * np.exp(-0.5 * np.square(distance))


def log_survival(z: Any) -> Any:
    """The logarithm of the probability above each of an array, also where that is too small for a
    float.
    """
    distance = np.abs(z)
    far = np.log(_beside_exponential(distance)) - 0.5 * np.square(distance)
    return np.where(z > 0.0, far, np.log1p(-_beyond(distance)))


def _beside_exponential(distance: Any) -> Any:
    """The probability beyond distances >= 0, over exp(-distance**2 / 2)."""
    found = _polynomial(_TAIL, (distance - _TAIL_CENTRE) / (distance + _TAIL_CENTRE))
    found /= distance + 1.0
    return found


def power_of_two(values: Any) -> float:
    """A power of two close to the largest magnitude: dividing by it before squaring avoids overflow
    and changes no digit.
    """
    return math.ldexp(1.0, math.frexp(float(np.max(np.abs(values), initial=0.0)))[1] - 1)

"""Real roots of parabolas and quartics that are known by their values at a few places."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from .codes import EPS

# Where a quartic is read off: nowhere a multiple of another or 0, for what is at rest there tells nothing.
PLACES = np.array([-1.06, -0.47, 0.13, 0.61, 1.27])
_FROM_PLACES = np.linalg.inv(np.vander(PLACES, increasing=True)).T
# A double root comes out of rounding as a pair with imaginary parts of the square root of it.
_REAL = 1e-6


def parabola_roots(samples: Sequence[Any], step: Any) -> tuple[Any, Any]:
    """Roots of the parabola through three points a step apart, the middle one at 0, rising; NaN where there are none."""
    behind, middle, ahead = samples
    square = 0.5 * (ahead + behind) - middle
    linear = 0.5 * (ahead - behind)
    scale = abs(behind) + abs(middle) + abs(ahead)
    square = np.where(abs(square) <= 8.0 * EPS * scale, 0.0, square)
    inside = linear * linear - 4.0 * square * middle
    # A double root, where the line only touches the parabola, survives rounding.
    inside = np.where(abs(inside) <= 64.0 * EPS * (linear * linear + abs(square) * scale), 0.0, inside)
    half = -0.5 * (linear + np.copysign(np.sqrt(inside), linear))
    one = np.where(square == 0.0, np.nan, half / square)
    other = np.where(half == 0.0, np.where(square == 0.0, np.nan, 0.0), middle / half)
    return step * np.fmin(one, other), step * np.fmax(one, other)


def quartic_roots(samples: Sequence[Any], step: Any) -> list[Any]:
    """Real roots of the quartic through five points at ``PLACES`` times the step; NaN in place of those that are not real."""
    values = np.stack(np.broadcast_arrays(*samples), axis=-1)
    largest = np.max(abs(values), axis=-1, keepdims=True)
    coefficients = (values / largest) @ _FROM_PLACES
    leading = coefficients[..., 4:]
    below = -coefficients[..., :4] / np.where(abs(leading) < EPS, EPS, leading)
    # Nothing is known where a value is none, or all of them are 0; eigvals would raise.
    known = np.all(np.isfinite(below), axis=-1, keepdims=True)
    companion = np.zeros((*values.shape[:-1], 4, 4))
    companion[..., range(1, 4), range(3)] = 1.0
    companion[..., 3] = np.where(known, below, 0.0)
    found = np.linalg.eigvals(companion)
    real = known & (abs(found.imag) <= _REAL * abs(found))
    return [step * np.where(real[..., i], found[..., i].real, np.nan) for i in range(4)]

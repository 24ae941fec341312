"""A smooth path through surveyed points: at each point the parabola of least squares, near points counting most."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

# Of the window: with this standard deviation, weights that fall off as a normal density err in the slope at the end of a path
# as equal weights within the window do, by the errors of the points and by a bend that changes along the way alike.
_SPREAD = 0.384
# The first lengths are those of the chords between the points, which errors of a dense survey make too long.
_PASSES = 3


def smooth(columns: Sequence[Sequence[Any]], window: Any, kind: Any) -> tuple[list[list[Any]], Any]:
    """x, y and heading at every point of a smooth path, and the weight of every point for the tangents at the first."""
    given, spread = _stacked(columns, window)
    found, spread = given, _SPREAD * spread
    for _ in range(_PASSES):
        steps = np.hypot(*np.diff(found[:2], axis=1))
        lengths = np.concatenate([0.0 * steps[:1], np.cumsum(steps, axis=0)])
        weights = [_weights(lengths, i, spread) for i in range(len(lengths))]
        found = np.stack([_parabola(lengths, given, weight, i)[0] for i, weight in enumerate(weights)], axis=1)
    return [list(row) for row in _rows(found, kind)], (lengths, weights[0])


def slopes(columns: Sequence[Sequence[Any]], at: Any, weights: Any, kind: Any) -> list[Any]:
    """Slope of each column at the first point, over what is measured there."""
    (*values, at), _ = _stacked([*columns, at])
    weights = weights.reshape(len(at), *(1,) * (at.ndim - weights.ndim), *weights.shape[1:])
    return _rows(_parabola(at, np.array(values), weights, 0)[1], kind)


def _stacked(columns: Sequence[Sequence[Any]], beside: Any = 0.0) -> tuple[Any, Any]:
    """An array of columns, points and cases, and another number of the same cases."""
    *parts, last = np.broadcast_arrays(*(part for column in columns for part in column), beside)
    return np.array(parts, dtype=float).reshape(len(columns), len(columns[0]), *last.shape), last


def _rows(found: Any, kind: Any) -> list[Any]:
    """The rows of an array in the precision of a batch; lists of floats, or floats, of a single case."""
    return list(found.astype(kind)) if kind is not None else list(found.tolist())


def _weights(lengths: Any, i: int, spread: Any) -> Any:
    """The weight of every point for the parabola at point i; two more points count, however far away they are."""
    last = len(lengths) - 1
    if last < 3:
        return np.ones_like(lengths)
    far = np.maximum(lengths[i] - lengths[max(min(i - 1, last - 2), 0)], lengths[min(max(i + 1, 2), last)] - lengths[i])
    # Divided before it is squared, which might overflow.
    return np.exp(-0.5 * ((lengths - lengths[i]) / np.maximum(spread, 0.25 * far)) ** 2)


def _parabola(at: Any, values: Any, weights: Any, i: int) -> tuple[Any, Any]:
    """Value and slope at point i of the parabola of weighted least squares; ``values`` has the points on its second axis.

    By polynomials that are orthogonal over the points, and from point i: coordinates of a map lose no digits.
    """
    size = at[-1]
    t = (at - at[i]) / size
    rise = values - values[:, i : i + 1]
    total = weights.sum(axis=0)
    mean = (weights * t).sum(axis=0) / total
    one = t - mean
    square = (weights * one * one).sum(axis=0)
    skew = (weights * one * one * one).sum(axis=0) / square
    two = one * (one - skew) - square / total
    first = (weights * one * rise).sum(axis=1) / square
    second = (weights * two * rise).sum(axis=1) / (weights * two * two).sum(axis=0) if len(at) > 2 else 0.0 * first
    # Through three points or two it passes, whatever the rounding.
    value = (weights * rise).sum(axis=1) / total - first * mean + second * two[i] if len(at) > 3 else 0.0
    return values[:, i] + value, (first - second * (2.0 * mean + skew)) / size

"""What evidence determines and what it leaves open: covariance and open directions from the slopes of a model."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from .least_squares import FLAT, rounding

_PART = 1e-4  # of its scale: an unknown that moves less along an open direction is not part of it


class Determination(NamedTuple):
    """Covariance (inf and NaN where nothing tells), open directions, and what each row contributed.

    ``open`` are directions that nothing tells, ``held`` those that the evidence does not tell and the priors do, each a row of
    changes in the units of the unknowns, the largest share of a scale being one whole scale. ``axes`` are the directions of
    one standard error each, ``rank`` how many there are.
    """

    covariance: Any
    open: Any
    held: Any
    shares: Any
    axes: Any

    @property
    def rank(self) -> int:
        """How many directions are told."""
        return len(self.axes)


def determination(slopes: Any, is_prior: Any, scale: Any, outputs: Any, steps: Any) -> Determination:
    """Of slopes (m, n) in standard deviations per unknown, some rows of them priors.

    A direction is open if moving along it by one scale changes everything by less than a thousandth of a standard deviation,
    or by less than the rounding of the differences that the slopes came from.
    """
    n = len(scale)
    scaled = slopes * scale
    noise = rounding(outputs, scale, steps)
    size, direction = _directions(scaled)
    told = size > np.maximum(FLAT, abs(direction) @ noise)
    open_, axes = direction[~told], direction[told] / size[told, np.newaxis]

    size, direction = _directions(scaled[~is_prior])
    untold = direction[size <= np.maximum(FLAT, abs(direction) @ noise)]
    # Those of the evidence alone, less what is open altogether.
    size, direction = _directions(untold - untold @ open_.T @ open_)
    held = direction[size > 0.5]

    lost = np.linalg.norm(open_, axis=0) > _PART
    gain = np.where(lost[:, np.newaxis], np.nan, axes.T @ (axes @ scaled.T))
    covariance = np.where(lost[:, np.newaxis] | lost, np.nan, axes.T @ axes) * np.outer(scale, scale)
    covariance[lost, lost] = np.inf
    with np.errstate(invalid="ignore", divide="ignore"):
        shares = gain**2 / np.sum(gain**2, axis=1, keepdims=True)
    assert covariance.shape == (n, n)
    return Determination(covariance, _plain(open_) * scale, _plain(held) * scale, shares, axes * scale)


def _directions(matrix: Any) -> tuple[Any, Any]:
    """All n singular values, those that are not there as 0, and their directions as rows."""
    n = matrix.shape[1]
    _, size, direction = np.linalg.svd(matrix, full_matrices=True)
    return np.append(size, np.zeros(n - len(size))), direction


def _plain(directions: Any) -> Any:
    """The same space spanned by rows of few unknowns each: reduced row echelon form, what is small left out."""
    rows = np.array(directions)
    for i in range(len(rows)):
        rest = abs(rows[i:])
        k, column = np.unravel_index(np.argmax(rest), rest.shape)
        rows[[i, i + int(k)]] = rows[[i + int(k), i]]
        rows[i] /= rows[i, column]
        others = np.arange(len(rows)) != i
        rows[others] -= np.outer(rows[others, column], rows[i])
    rows = np.where(abs(rows) > _PART, rows, 0.0)
    return rows / np.max(abs(rows), axis=1, keepdims=True, initial=_PART)

"""Cases drawn from the inputs: from points of the unit cube to named arrays, with the correlations the user states."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np

from ..errors import InputError
from ..reading import is_whole
from ..units import shown
from . import normal
from .distributions import Distribution, Samples

# Correlation of the normal scores of two inputs, by the pair of their names.
Correlation: TypeAlias = Mapping[tuple[str, str], float]

_NODES = 64  # of a Gauss-Hermite rule: exact for the scores of normals, 1e-12 for smooth quantile functions
_STEPS = 1024  # equal shares of probability instead, where a quantile function has steps
_ROUNDING = 1e-12  # of a pivot of the correlation matrix, which has ones on its diagonal


class Joint:
    """Distributions that are drawn together; ``rows`` tells which rows of the unit cube each group of them is drawn from."""

    def __init__(self, inputs: Mapping[str, Distribution], correlation: Correlation | None) -> None:
        self.inputs = inputs
        self.names = tuple(inputs)
        pairs = _checked(inputs, {} if correlation is None else correlation)
        self.groups = _groups(inputs, pairs)
        # The values of joint samples, in the order in which they belong together.
        self._together = {name: d.rows for name, d in inputs.items() if isinstance(d, Samples) and d.group is not None}
        self.rows: dict[tuple[str, ...], list[int]] = {}
        self.dimensions = 0
        for group in self.groups:
            count = 1 if group[0] in self._together else len(group)
            self.rows[group] = list(range(self.dimensions, self.dimensions + count))
            self.dimensions += count
        self._factors = {group: _factor(group, pairs) for group, rows in self.rows.items() if len(rows) > 1}

    def values(self, points: Any) -> dict[str, Any]:
        """The inputs at points (dimensions, cases)."""
        found: dict[str, Any] = {}
        for group, rows in self.rows.items():
            if group[0] in self._together:
                for name in group:
                    column = self._together[name]
                    found[name] = column[(points[rows[0]] * len(column)).astype(np.intp)]
            elif group in self._factors:
                independent = [normal.quantile(points[row]) for row in rows]
                for name, weights in zip(group, self._factors[group], strict=True):
                    # Term by term: a matrix product adds in an order that depends on how many cases there are.
                    scores = sum(weight * score for weight, score in zip(weights, independent, strict=True) if weight)
                    found[name] = self.inputs[name].scored(scores)
            else:
                found[group[0]] = self.inputs[group[0]].quantile(points[rows[0]])
        return {name: found[name] for name in self.names}

    def correlations(self) -> Any:
        """Pearson's correlations of the inputs themselves, in the order of their names."""
        matrix = np.eye(len(self.names))
        where = {name: i for i, name in enumerate(self.names)}
        for group in self.groups:
            for k, one in enumerate(group):
                for other in group[:k]:
                    i, j = where[one], where[other]
                    matrix[i, j] = matrix[j, i] = self._correlation(group, one, other)
        return matrix

    def _correlation(self, group: tuple[str, ...], one: str, other: str) -> float:
        a, b = self.inputs[one], self.inputs[other]
        if group[0] in self._together:
            return float(np.mean((self._together[one] - a.mean) / a.sd * ((self._together[other] - b.mean) / b.sd)))
        factor = self._factors[group]
        rho = float(factor[group.index(one)] @ factor[group.index(other)])
        rho = min(1.0, max(-1.0, rho))
        nodes, weights = _nodes(isinstance(a, Samples) or isinstance(b, Samples))
        x, y = nodes[:, None], rho * nodes[:, None] + math.sqrt(1.0 - rho * rho) * nodes
        return float(weights @ ((a.scored(x) - a.mean) / a.sd * ((b.scored(y) - b.mean) / b.sd)) @ weights)


def _nodes(stepped: bool) -> tuple[Any, Any]:
    """Standard normal scores and their weights, for the mean of a function of them."""
    if stepped:
        return normal.quantile((np.arange(_STEPS) + 0.5) / _STEPS), np.full(_STEPS, 1.0 / _STEPS)
    nodes, weights = np.polynomial.hermite_e.hermegauss(_NODES)
    return nodes, weights / weights.sum()


def _checked(inputs: Mapping[str, Distribution], correlation: Any) -> dict[frozenset[str], float]:
    """The correlations by pair, after what can be wrong with them."""
    if not isinstance(correlation, Mapping):
        raise InputError(
            f"correlation must be a dict such as {{('mass_a', 'mass_b'): 0.8}}, got {type(correlation).__name__}",
            code="bad_correlation",
            argument="correlation",
        )
    found: dict[frozenset[str], float] = {}
    for pair, value in correlation.items():
        if not isinstance(pair, tuple) or len(pair) != 2 or pair[0] == pair[1]:
            raise _bad(f"its keys are pairs of two names, got {shown(pair)}")
        for name in pair:
            if name not in inputs:
                raise _bad(f"{name!r} is not an input with a distribution; these are {', '.join(inputs) or 'none'}")
            if getattr(inputs[name], "group", None) is not None:
                raise _bad(f"{name!r} belongs to joint samples, which already say how it goes with the others")
        if not (is_whole(value) or isinstance(value, (float, np.floating))) or not -1.0 <= value <= 1.0:
            raise _bad(f"the correlation of {pair[0]} and {pair[1]} must be a number from -1 to 1, got {shown(value)}")
        key = frozenset(pair)
        if key in found and found[key] != float(value):
            raise _bad(f"{pair[0]} and {pair[1]} are given twice, as {found[key]:g} and {float(value):g}")
        found[key] = float(value)
    return found


def _bad(reason: str) -> InputError:
    return InputError(f"correlation: {reason}", code="bad_correlation", argument="correlation")


def _groups(inputs: Mapping[str, Distribution], pairs: Mapping[frozenset[str], float]) -> tuple[tuple[str, ...], ...]:
    """The inputs that go together, in order: correlated ones, and the columns of joint samples."""
    group_of = {name: {name} for name in inputs}

    def join(one: str, other: str) -> None:
        union = group_of[one] | group_of[other]
        for name in union:
            group_of[name] = union

    for pair, rho in pairs.items():
        if rho != 0.0:
            join(*pair)
    tokens: dict[str, str] = {}
    for name, distribution in inputs.items():
        token = getattr(distribution, "group", None)
        if token is not None:
            join(name, tokens.setdefault(token, name))
    found: list[tuple[str, ...]] = []
    for name in inputs:
        group = tuple(other for other in inputs if other in group_of[name])
        if group not in found:
            found.append(group)
    return tuple(found)


def _factor(group: Sequence[str], pairs: Mapping[frozenset[str], float]) -> Any:
    """The lower triangular matrix L of the group's correlation matrix L L^T; correlations of 1 are allowed."""
    count = len(group)
    factor = np.zeros((count, count))
    for i in range(count):
        for j in range(i + 1):
            rho = 1.0 if i == j else pairs.get(frozenset((group[i], group[j])), 0.0)
            rest = rho - float(factor[i, :j] @ factor[j, :j])
            pivot = factor[j, j]
            if i == j:
                if rest < -_ROUNDING:
                    raise _impossible(group)
                factor[i, i] = math.sqrt(rest) if rest > _ROUNDING else 0.0
            elif pivot > 0.0:
                factor[i, j] = rest / pivot
            elif abs(rest) > math.sqrt(_ROUNDING):
                raise _impossible(group)
    return factor


def _impossible(group: Sequence[str]) -> InputError:
    return _bad(
        f"these of {', '.join(group)} cannot hold together (the matrix has a negative eigenvalue); what goes with one input as "
        f"closely as this must go with its companions too: give the missing pairs, or lower values"
    )

"""Draws cases from the inputs with their correlations, runs the model on them, and finds each
input's share of the variance.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from typing import Any, TypeAlias

import numpy as np

from ..engine.blocks import in_order
from ..messages.errors import InputError, OutOfRangeWarning
from ..messages.marked import type_of
from ..messages.warning import Note
from ..quantities.reading import is_whole
from ..quantities.refusals import must_be
from ..quantities.units import shown
from . import normal, turns
from .designs import REPLICATES, Design
from .distribution import at_probabilities, at_scores, correlation_found
from .distributions import Distribution, Samples
from .model import Model
from .normal_family import is_whole_normal
from .one_sided import Answers, joined
from .output import Shares
from .sampled import average, deviation

# Correlation of the normal scores of two inputs, by the pair of their names.
Correlation: TypeAlias = Mapping[tuple[str, str], float]

BLOCK = 16384
_FIRST_BLOCK = 8192
_FIRST_SHOWN = 1024  # with a progress report: a slow model soon has one, and can be stopped
# of a Gauss-Hermite rule: exact for the scores of normals, 1e-12 for smooth quantile functions
_NODES = 64
_STEPS = 1024  # equal shares of probability instead, where a quantile function has steps
_ROUNDING = 64.0 * float(np.finfo(np.float64).eps)  # of what a model works out
# Of statements of how inputs go together.
TOGETHER = "inputs_together"
# A correlation below this changes a range by less than its digits.
_LOOSELY = 0.1
_PIVOT_TOL = 1e-12  # of the correlation matrix, which has ones on its diagonal


class Joint:
    """The joint distribution of the uncertain inputs: ``rows`` maps each group to its rows of the
    unit cube.
    """

    def __init__(self, inputs: Mapping[str, Distribution], correlation: Correlation | None) -> None:
        self.inputs = inputs
        pairs = _read_correlation(inputs, {} if correlation is None else correlation)
        self._pairs = pairs
        # The columns of joint samples, in the order in which they belong together.
        self._columns = {
            name: d.rows
            for name, d in inputs.items()
            if isinstance(d, Samples) and d.group is not None
        }
        self.rows: dict[tuple[str, ...], list[int]] = {}
        self.dimensions = 0
        for group in _groups(inputs, pairs):
            count = 1 if group[0] in self._columns else len(group)
            self.rows[group] = list(range(self.dimensions, self.dimensions + count))
            self.dimensions += count
        self.labels = [" & ".join(group) for group in self.rows]
        self._factors = {
            group: _factor(group, pairs) for group, rows in self.rows.items() if len(rows) > 1
        }
        # Rows whose normal scores are needed: worked out together, they take two thirds of the time
        # of one by one.
        by_score = [
            rows
            for group, rows in self.rows.items()
            if group in self._factors or is_whole_normal(inputs[group[0]])
        ]
        self._by_score = [row for rows in by_score for row in rows]

    def values(self, points: Any) -> dict[str, Any]:
        """The inputs at points (dimensions, cases) of the unit cube."""
        scores = dict(zip(self._by_score, normal.quantile(points[self._by_score]), strict=True))
        return self._at(points, scores)

    def scored(self, scores: Any) -> dict[str, Any]:
        """The inputs at independent normal scores (dimensions, cases)."""
        points = {
            rows[0]: normal.cdf(scores[rows[0]])
            for group, rows in self.rows.items()
            if group[0] in self._columns
        }
        return self._at(points, dict(enumerate(scores)))

    def _at(self, points: Any, scores: Mapping[int, Any]) -> dict[str, Any]:
        """The inputs, by row of the cube: at normal scores where these are known, and at
        probabilities elsewhere.
        """
        found: dict[str, Any] = {}
        for group, (row, *others) in self.rows.items():
            if group[0] in self._columns:
                for name in group:
                    column = self._columns[name]
                    at = (points[row] * len(column)).astype(np.intp)
                    found[name] = column[np.minimum(at, len(column) - 1)]
            elif group in self._factors:
                independent = [scores[each] for each in (row, *others)]
                for name, weights in zip(group, self._factors[group], strict=True):
                    # Term by term: a matrix product adds in an order that depends on how many cases
                    # there are.
                    mixed = sum(
                        weight * score
                        for weight, score in zip(weights, independent, strict=True)
                        if weight
                    )
                    found[name] = at_scores(self.inputs[name], mixed)
            elif row in scores:
                found[group[0]] = at_scores(self.inputs[group[0]], scores[row])
            else:
                found[group[0]] = at_probabilities(self.inputs[group[0]], points[row])
        return {name: found[name] for name in self.inputs}

    @property
    def ordered(self) -> Any:
        """For each row, whether its values rise with it; those of joint samples, which are in no
        order, do not.
        """
        return np.array(
            [group[0] not in self._columns for group, places in self.rows.items() for _ in places]
        )

    @property
    def notes(self) -> tuple[Note, ...]:
        """How the inputs go together as stated: without it nobody gets the same range again."""
        stated = [
            f"{one} and {other} {rho:.15g}"
            for one, other in combinations(self.inputs, 2)
            if (rho := self._pairs.get(frozenset((one, other)), 0.0))
        ]
        said = [f"correlation of the inputs as stated: {', '.join(stated)}"] if stated else []
        said += (
            f"joint samples, which keep the rows in which they were given: {', '.join(group)}"
            for group in self.rows
            if group[0] in self._columns and len(group) > 1
        )
        return *(Note(None, one, code=TOGETHER) for one in said), *self._apart()

    def _apart(self) -> Iterator[Note]:
        """That inputs which one fit found together were taken as independent."""
        apart = {
            (one, other): rho
            for one, other in combinations(self.inputs, 2)
            if frozenset((one, other)) not in self._pairs
            and abs(rho := correlation_found(self.inputs[one], self.inputs[other])) >= _LOOSELY
        }
        if not apart:
            return
        one, other = most = max(apart, key=lambda pair: abs(apart[pair]))
        pairs = "this pair was" if len(apart) == 1 else f"{len(apart)} pairs of what it found were"
        yield Note(
            OutOfRangeWarning,
            f"one fit found {one} and {other} with a correlation of {apart[most]:.2g}, and {pairs} "
            "taken as independent: write `correlation=fit.correlation`, with the names of these "
            "inputs",
            code="correlation_left_out",
        )

    def correlations(self) -> Any:
        """Pearson's correlations of the inputs themselves, in their order."""
        matrix = np.eye(len(self.inputs))
        order = {name: i for i, name in enumerate(self.inputs)}
        for group in self.rows:
            for other, one in combinations(group, 2):
                i, j = order[one], order[other]
                matrix[i, j] = matrix[j, i] = self._correlation(group, one, other)
        return matrix

    def _correlation(self, group: tuple[str, ...], one: str, other: str) -> float:
        a, b = self.inputs[one], self.inputs[other]
        if group[0] in self._columns:
            return float(
                np.mean(
                    (self._columns[one] - a.mean) / a.sd * ((self._columns[other] - b.mean) / b.sd)
                )
            )
        factor = self._factors[group]
        rho = min(1.0, max(-1.0, float(factor[group.index(one)] @ factor[group.index(other)])))
        # Standard normal scores and their weights, for the mean of a function of them.
        if isinstance(a, Samples) or isinstance(b, Samples):
            nodes, weights = (
                normal.quantile((np.arange(_STEPS) + 0.5) / _STEPS),
                np.full(_STEPS, 1.0 / _STEPS),
            )
        else:
            nodes, weights = np.polynomial.hermite_e.hermegauss(_NODES)
            weights = weights / weights.sum()
        x, y = nodes[:, None], rho * nodes[:, None] + math.sqrt(1.0 - rho * rho) * nodes
        return float(
            weights @ ((a.scored(x) - a.mean) / a.sd * ((b.scored(y) - b.mean) / b.sd)) @ weights
        )


def _read_correlation(
    inputs: Mapping[str, Distribution], correlation: Any
) -> dict[frozenset[str], float]:
    """The correlations by pair; invalid ones are refused."""
    if not isinstance(correlation, Mapping):
        raise must_be(
            "correlation",
            "`|a dict such as {('mass_a', 'mass_b'): 0.8}|rows such as "
            '[["a.mass", "b.mass", 0.5]]`',
            correlation,
            code="bad_correlation",
            got=type_of(correlation),
        )
    found: dict[frozenset[str], float] = {}
    for pair, value in correlation.items():
        if not isinstance(pair, tuple) or len(pair) != 2 or pair[0] == pair[1]:
            raise _bad(f"its keys are pairs of two names, got {shown(pair)}")
        for name in pair:
            if name not in inputs:
                raise _bad(
                    f"{shown(name)} is not an input with a distribution; these are "
                    f"{', '.join(inputs) or 'none'}"
                )
            if getattr(inputs[name], "group", None) is not None:
                raise _bad(
                    f"{name!r} belongs to joint samples, which already say how it goes with the "
                    "others"
                )
        if (
            not (is_whole(value) or isinstance(value, (float, np.floating)))
            or not -1.0 <= value <= 1.0
        ):
            raise _bad(
                f"the correlation of {pair[0]} and {pair[1]} must be a number from -1 to 1, got "
                f"{shown(value)}"
            )
        key = frozenset(pair)
        if key in found and found[key] != float(value):
            raise _bad(
                f"{pair[0]} and {pair[1]} are given twice, as {found[key]:g} and {float(value):g}"
            )
        found[key] = float(value)
    return found


def _bad(reason: str) -> InputError:
    return InputError(f"correlation: {reason}", code="bad_correlation", argument="correlation")


def _groups(
    inputs: Mapping[str, Distribution], pairs: Mapping[frozenset[str], float]
) -> list[tuple[str, ...]]:
    """The inputs that go together, in order: correlated ones, and the columns of joint samples."""
    joint: dict[str, set[str]] = {}
    for name, distribution in inputs.items():
        if isinstance(distribution, Samples) and distribution.group is not None:
            joint.setdefault(distribution.group, set()).add(name)
    group_of = {name: {name} for name in inputs}
    for linked in (*(pair for pair, rho in pairs.items() if rho != 0.0), *joint.values()):
        union = set().union(*(group_of[name] for name in linked))
        group_of |= dict.fromkeys(union, union)
    # As keys of a dict each group is kept once, where its first member stands.
    return list(
        dict.fromkeys(
            tuple(other for other in inputs if other in group_of[name]) for name in inputs
        )
    )


def _factor(group: Sequence[str], pairs: Mapping[frozenset[str], float]) -> Any:
    """The lower triangular matrix L of the group's correlation matrix L L^T; correlations of 1 are
    allowed.
    """
    count = len(group)
    factor = np.zeros((count, count))
    impossible = _bad(
        f"these of {', '.join(group)} cannot hold together (the matrix has a negative "
        "eigenvalue); what goes with one input as closely as this must go with its companions "
        "too: give the missing pairs, or lower values"
    )
    for i in range(count):
        for j in range(i):
            rest = pairs.get(frozenset((group[i], group[j])), 0.0) - float(
                factor[i, :j] @ factor[j, :j]
            )
            if factor[j, j] > 0.0:
                factor[i, j] = rest / factor[j, j]
            elif abs(rest) > math.sqrt(_PIVOT_TOL):
                raise impossible
        rest = 1.0 - float(factor[i, :i] @ factor[i, :i])
        if rest < -_PIVOT_TOL:
            raise impossible
        factor[i, i] = math.sqrt(rest) if rest > _PIVOT_TOL else 0.0
    return factor


@dataclass
class Sample:
    """The finished cases of a run: ``outputs`` by name, one value per case, NaN where there is no
    answer.
    """

    model: Model
    joint: Joint
    design: Design
    threads: int
    done: int = 0
    interrupted: bool = False
    outputs: Answers = field(default_factory=lambda: Answers({}, {}))

    def extend(self, samples: int, progress: Callable[[int, int], None] | None = None) -> None:
        """Go on to this many cases in all; on a KeyboardInterrupt keep the cases up to the first
        that is missing.
        """
        blocks = _blocks(self.done, samples, _FIRST_BLOCK if progress is None else _FIRST_SHOWN)
        parts = [self.outputs] if self.outputs else []
        try:
            for (_, stop), answers in zip(
                blocks, in_order(self._answers, blocks, self.threads), strict=True
            ):
                parts.append(answers)
                if progress is not None:
                    progress(stop, samples)
        except KeyboardInterrupt:
            if not parts:
                raise
            self.interrupted = True
        self.outputs = joined(parts)
        self.done = len(next(iter(self.outputs.values())))

    def inputs(self, start: int, stop: int) -> dict[str, Any]:
        """The inputs of these cases."""
        # Case i is place i // REPLICATES of sequence i % REPLICATES, so that any beginning holds as
        # much of each.
        first, last = start // REPLICATES, -(-stop // REPLICATES)
        points = self.design(first, last).reshape(self.joint.dimensions, -1)
        offset = start - first * REPLICATES
        with np.errstate(all="ignore"):
            return self.joint.values(points[:, offset : offset + stop - start])

    def _answers(self, block: tuple[int, int]) -> Answers:
        start, stop = block
        return self.model(self.inputs(start, stop), stop - start, check=start == 0)


def _blocks(start: int, stop: int, first: int) -> list[tuple[int, int]]:
    """Blocks from start to stop; those of a run begin with this many cases and grow."""
    found, size = [], BLOCK if start else min(first, BLOCK)
    while start < stop:
        found.append((start, min(start + size, stop)))
        start, size = found[-1][1], min(8 * size, BLOCK)
    return found


def sampled_shares(
    model: Model, joint: Joint, design: Callable[[int], Design], samples: int
) -> dict[str, Shares]:
    """Each input's share of the variance of every output, by redrawing that input while the others
    stay.

    It takes ``samples`` cases for each input, and twice as many besides. First-order shares by the
    estimator of A. Saltelli et al., "Variance based sensitivity analysis of model output", Computer
    Physics Communications 181 (2010), total shares by that of M. J. W. Jansen, "Analysis of
    variance designs for model output", Computer Physics Communications 117 (1999).
    """
    places = -(-samples // REPLICATES)
    points = design(2 * joint.dimensions)(0, places).reshape(2 * joint.dimensions, -1)
    with np.errstate(all="ignore"):
        one, other = (
            joint.values(points[: joint.dimensions]),
            joint.values(points[joint.dimensions :]),
        )
        draws = [one, other, *(one | {name: other[name] for name in group} for group in joint.rows)]
        answers = [model(drawn, points.shape[1]) for drawn in draws]
    found: dict[str, Shares] = {}
    for name, unit in model.units.items():
        values = np.array([answer[name] for answer in answers])
        if unit == "rad":
            values = turns.counted(values.reshape(-1)).reshape(values.shape)
        shares = [_shares(values[0], values[1], mixed) for mixed in values[2:]]
        found[name] = Shares(
            *(
                dict(zip(joint.labels, figures, strict=True))
                for figures in zip(*shares, strict=True)
            )
        )
    return found


def _shares(one: Any, other: Any, mixed: Any) -> tuple[float, ...]:
    """First-order and total share, and their standard errors, over the cases where all three have
    an answer.
    """
    answered = ~(np.isnan(one) | np.isnan(other) | np.isnan(mixed))

    def figures(cases: slice) -> tuple[float, float]:
        a, b, c = (values[cases][answered[cases]] for values in (one, other, mixed))
        if len(a) < 2:
            return math.nan, math.nan
        both = np.concatenate((a, b))
        # In units of its standard deviation, so that squares cannot overflow.
        middle, scale = average(both), deviation(both)
        # What differs by rounding alone is constant, and has nothing to share.
        if not scale > _ROUNDING * abs(middle):
            return math.nan, math.nan
        a, b, c, both = ((part - middle) / scale for part in (a, b, c, both))
        variance = float(np.var(both))
        # The mean is subtracted first: it does not affect the estimate, but its scatter.
        first = float(np.mean((b - both.mean()) * (c - a)))
        total = 0.5 * float(np.mean((a - c) ** 2))
        return (first / variance, total / variance) if variance > 0.0 else (math.nan, math.nan)

    with np.errstate(all="ignore"):
        first, total = figures(slice(None))
        apart = np.array([figures(slice(which, None, REPLICATES)) for which in range(REPLICATES)])
        errors = np.std(apart, axis=0, ddof=1) / math.sqrt(REPLICATES)
    return first, total, float(errors[0]), float(errors[1])

"""``fit``: estimates the unknowns of a scene from measurements, each with its error, by weighted
least squares.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ..messages.errors import AmbiguousSolutionError, InputError, NoSolutionError
from ..messages.hints import hinted
from ..messages.marked import as_code, type_of
from ..messages.warning import NO_ANSWER, Note, notes_of_samples, warn_of
from ..quantities.attributes import read_only
from ..quantities.units import is_quantity
from ..uncertainty.distribution import notes_of_inputs, read_alike
from ..uncertainty.distributions import Distribution, Interval, Normal, Uniform
from ..uncertainty.finer import FinerModel
from ..uncertainty.model import AnyModel, Model, function_of, range_hint, scene_among
from ..uncertainty.normal import score_of_coverage
from ..uncertainty.turns import folded
from .evidence import (
    Observation,
    bare_angle_notes,
    listed,
    observed_columns,
    read_evidence,
    read_value,
    refused_everywhere,
)
from .fit_result import Direction, Fit, Values, notes_of, residual_of
from .least_squares import (
    Determination,
    Ends,
    Problem,
    chi_squared_tail,
    determination,
    minimise,
    spread,
)
from .profile import Found, followed, least_at, table

_STARTS = 64
_MOST_BROKEN = 3  # answers at which no search converges
_PRIOR_SPAN = 3.0  # standard deviations of a prior within which searches start
_FEW = 2  # searches that ended at the best, among more: there may be a better one
_SAME_CHI_SQUARED = 1e-3  # misfits within this are the same
_TOO_CLOSE = 4.0  # of chi-squared, that the errors of the best do not exclude
_AROUND, _NUDGE = (
    8,
    1e-2,
)  # searches, and part of the scale of each unknown by which they start off at most
_AGREEMENT = 1e-2  # of the scale of an unknown: values within this agree
_ONE_BREAK = 0.1  # of the same: ends at a jump, a kink or a refusal within this are one
_TWO_ERRORS = 2.0
_STRAIGHT = 0.05  # of two errors: with a rise within this of it, an unknown has its range by slopes
_TWO_SIDED = score_of_coverage(0.95)
_OVERSTATED = 10.0  # times the errors that chi-squared shows: then the slope vanishes nearby
_LEAST_MOVE = 0.1  # standard errors: smaller moves and smaller rises are not compared
_FLAT_SHARE = 1e-6  # of the greatest slope: directions of less are left alone
_TO_REFINE, _MOST_REFINED = 25.0, 6  # of chi-squared, and places, for a finer model to start from
# Searches of a finer model alone; how long at first, and then of those that may lead somewhere:
# along a kink they would go on for long, and get no further.
_ELSEWHERE, _ROUNDS_ELSEWHERE, _MORE_ROUNDS = 12, 4, 30
_POSTERIOR = (
    "`|posterior(model, unknowns, observed, seed=1)|[posterior]`, with `Uniform(low, high)` of "
    "each unknown that has no prior"
)
_STEP_ROUNDS = 4
_FOR_NOISE = 5  # points at which the noise of the model is measured, once for all
_MOST_STEPS = 100.0  # standard errors over which slopes may be taken at most


@hinted
def fit(
    model: AnyModel,
    unknowns: Mapping[str, Any],
    observed: Mapping[str, Any],
    *,
    finer: AnyModel | None = None,
) -> Fit:
    """Estimate the unknowns of a scene from measurements, each given with its error.

    Weighted least squares: the sum of the squares of (observed - computed)/sigma, over the
    observations and the priors, is minimised within the bounds (Levenberg-Marquardt from 64 starts
    spread over what was known before). The covariance follows from the slopes of the model at the
    answer and the errors as stated; it is not scaled by the misfit. Where the model scatters
    between neighbours, as ``simulate`` does by its steps, the slopes are taken over a part of the
    errors. The standard errors hold where the errors of the observations are normal and
    independent, the model is nearly linear within two of them and no bound is near. Elsewhere the
    intervals follow chi-squared itself: they hold the values at which it rises by less than 3.84
    (for 95 percent) with the other unknowns fitted again. Where one value with such a range does
    not describe what the evidence says, ``fit`` refuses or warns; ``posterior`` then has the
    answer, whatever the priors and however nonlinear the model.

    Parameters
    ----------
    model : function
        ``model(**unknowns)`` returns a dict of named outputs; or a ``scene.Scene``, with paths for
        names. It is called with an array of cases for every unknown [SI] and returns arrays as
        long, NaN where it refuses (``on_failure="nan"``), as for ``uncertainty.propagate``. Each
        case is to be answered independently of the others; as a check, a few are called again by
        themselves. What is known exactly is written into the model.
    unknowns : dict
        By name, what is known before: a ``Normal`` (a prior, which has weight; ``truncate=`` gives
        bounds), a ``Uniform`` or an ``Interval`` (bounds without weight), or a number, text or
        Quantity to start from (nothing known; searches start between 0 and twice this value, or
        between -1 and 1 in SI if it is 0).
    observed : dict
        By output of the model, ``Normal(value, error)`` or the pair (value, error), both in SI or
        both with a unit; the error is a standard deviation. A text needs its unit where the model
        returns one; where it returns bare floats, ``("5", "1")`` is read as the numbers. What is
        observed, or returned by the model, with a unit of angle is taken round the circle: its
        residual is within half a turn. A bare number in radians cannot be told from any other
        number and is not.
    finer : function, optional
        A model that takes the same unknowns and returns the same outputs, and costs more. The
        searches all over the bounds are those of ``model``; from where they end the misfit of the
        finer model is minimised, whose fit this then is. It is searched all over the bounds too,
        from 12 places, and from all where it fits badly, its chi-squared more than 25 above that
        of ``model``. An answer of it that is far from every one of ``model`` may be missed.

    Returns
    -------
    Fit
        ``fit["speed_a"]`` has value, standard error and interval; see its attributes for residuals,
        chi-squared, what the evidence does not determine, and what ended on a bound.

    Raises
    ------
    InputError
        An argument that cannot be used, or a model (code "bad_model") that returns something other
        than named arrays, mixes the cases it is called with, or answers the same case differently
        when asked again.
    AmbiguousSolutionError
        Another answer has a chi-squared less than 4 above the best, and no one range describes
        both: each lies outside the errors of the other, or what is between them is excluded. All
        that the searches found are in ``solutions``. Answers that form one range, such as a contact
        that slid and one that stuck with any friction that is high enough, are in ``others``.
    NoSolutionError
        The model refuses at every start (code "refused"); or the misfit is least at a jump, an edge
        or a turning point of the model, where no error can be given, or at a point that at most two
        of the searches reached (code "no_convergence").

    Warns
    -----
    IllConditionedWarning
        Nothing determines an unknown, or the evidence excludes none of its values within its
        bounds; or the model refuses within two standard errors of the answer.
    SuspectUnitsWarning
        A bare observation differs from its computed value by more than pi, with neither beyond pi:
        perhaps an angle.
    CollisionsWarning
        The evidence contradicts itself: a misfit this large has a probability below 0.01.

    Examples
    --------
    A Golf (1200 kg) going south and a Pinto (1800 kg) going east, with the momenta after the impact
    (published answers 63.2 and 55.6 km/h), here each with an error of 1300 N s.

    >>> import numpy as np
    >>> import collisions as col
    >>> from collisions.uncertainty.distributions import Interval, Normal
    >>> def momentum(speed_golf, speed_pinto):
    ...     east, south = 1800 * speed_pinto, 1200 * speed_golf
    ...     return {"east": east, "south": south}
    >>> east = 1200 * 30 / 3.6 * np.cos(np.pi / 6) + 1800 * 50 / 3.6 * np.cos(np.pi / 4.5)
    >>> south = 1200 * 30 / 3.6 * np.sin(np.pi / 6) + 1800 * 50 / 3.6 * np.sin(np.pi / 4.5)
    >>> speeds = {
    ...     "speed_golf": Interval("0 km/h", "150 km/h"),
    ...     "speed_pinto": Interval("0 km/h", "150 km/h"),
    ... }
    >>> found = col.reconstruct.fit(
    ...     momentum, speeds, {"east": (east, 1300.0), "south": (south, 1300.0)}
    ... )
    >>> round(3.6 * found["speed_golf"].value, 1), round(3.6 * found["speed_pinto"].value, 1)
    (63.2, 55.6)

    Tyres that take 300 N s of each during the contact, as a finer model of the same scene:

    >>> def with_tyres(**speeds):
    ...     return {name: left - 300.0 for name, left in momentum(**speeds).items()}
    >>> measured = {"east": (east, 1300.0), "south": (south, 1300.0)}
    >>> finer = col.reconstruct.fit(momentum, speeds, measured, finer=with_tyres)
    >>> round(3.6 * finer["speed_golf"].value, 1), round(3.6 * finer["speed_pinto"].value, 1)
    (64.1, 56.2)
    >>> finer.calls["finer"] < finer.calls["model"]
    True
    """
    # A point at which numbers overflow counts as refused.
    with np.errstate(all="ignore"):
        inputs, problem = _read_inputs(model, unknowns, observed)
        starts = _starts(inputs, problem)
        problem = problem._replace(noise=problem.noise_near(starts[:_FOR_NOISE]))
        dearer = None if finer is None else _with_finer(inputs, problem, finer)
        ends = minimise(problem, starts)
        if np.all(np.isinf(ends.chi_squared)):
            advice = (
                "bounds or starts within which the impact happens; `reconstruct.posterior` "
                "finds rare ones too"
            )
            start = inputs.named(inputs.start)
            raise refused_everywhere(inputs.model, _STARTS, start, inputs.units, advice)
        searched = inputs.model
        if dearer is not None:
            starts, scout = _ends_to_refine(inputs, problem, ends), problem
            least = np.min(ends.chi_squared)
            inputs, problem = dearer
            problem = problem._replace(noise=problem.noise_near(starts[:_FOR_NOISE]), scout=scout)
            ends = minimise(problem, starts)
            if np.all(np.isinf(ends.chi_squared)):
                raise NoSolutionError(
                    "the finer model has no answer where the searches of model ended, among them "
                    f"{listed(inputs.named(starts[0]), inputs.units)}; fit the finer model alone: "
                    "fit(finer, unknowns, observed)",
                    code="refused",
                )
            if np.min(ends.chi_squared) > least + _TO_REFINE:
                # It fits badly where the other model fits, and may fit elsewhere.
                more = minimise(problem, _starts(inputs, problem))
                ends = Ends(*map(np.concatenate, zip(ends, more, strict=True)))
            ends = _with_elsewhere(inputs, problem, ends)
        best, ends, found_of = _followed(inputs, problem, ends, few=dearer is None)
        candidates = [best, *(one for one, _ in found_of[1:])]
        fits = []
        for one in candidates:
            where = _left_open(one, ends)
            notes = _said_at(inputs, where, inputs.model, worked_back=True)
            notes += _said_within(inputs, one, {note.code for note in notes})
            notes += tuple(bare_angle_notes(inputs.rows, inputs.model.units))
            notes += tuple(notes_of_inputs((row.name, row.reading.value) for row in inputs.rows))
            if dearer is not None:
                # No figure rests on what the first model says at the answer of the finer one.
                notes += tuple(
                    note._replace(warning=None, sentence=f"model, not finer: {note.sentence}")
                    for note in _said_at(inputs, where, searched)
                )
            fits.append(replace(_answer(one), model_notes=notes))
        if len(fits) > 1 and _distinct(found_of):
            raise _ambiguous([_with_own(*one) for one in zip(fits, candidates, strict=True)])
        found = replace(fits[0], **_with_profiles(fits, found_of))
        calls = {"model": searched.cases}
        if dearer is not None:
            calls["finer"] = inputs.model.cases
        found = replace(found, calls=calls, _scene=scene_among(finer, model))
    warn_of(notes_of(found))
    return found


def _with_finer(inputs: _Inputs, problem: Problem, finer: Any) -> tuple[_Inputs, Problem]:
    """The same inputs and problem with a finer model, whose outputs must be the same."""
    seen = [row.name for row in inputs.rows if not row.is_prior]
    dearer = FinerModel(function_of(finer, inputs.units, seen, "observed"), {})
    dearer.check_inputs(list(inputs.units), "unknowns", "bad_model")
    found = inputs._replace(model=dearer)
    found.computed(np.tile(inputs.start, (2, 1)))
    dearer.check_outputs(inputs.model)
    sigma = np.array([row.reading.sigma for row in inputs.rows])
    return found, problem._replace(evaluate=lambda points: found.computed(points) / sigma)


def _ends_to_refine(inputs: _Inputs, problem: Problem, ends: Ends) -> Any:
    """Where searches ended, apart from one another: the best, others nearly as good that another
    model may prefer, and what differs only in what nothing determines.
    """
    order = np.argsort(ends.chi_squared + _SAME_CHI_SQUARED * ~ends.converged, kind="stable")
    least = float(ends.chi_squared[order[0]])
    near = [k for k in order.tolist() if ends.chi_squared[k] <= least + _TO_REFINE]
    chosen: list[int] = []
    for k in near:
        apart = (
            np.any(abs(ends.points[k] - ends.points[other]) > _AGREEMENT * problem.scale)
            for other in chosen
        )
        if len(chosen) < _MOST_REFINED and all(apart):
            chosen.append(k)
    return ends.points[chosen]


def _with_elsewhere(inputs: _Inputs, problem: Problem, ends: Ends) -> Ends:
    """With the ends of a few searches of a finer model alone, all over the bounds: it may fit as
    well where the other model does not, as where only it can slide.
    """
    alone = problem._replace(scout=None)
    some = minimise(alone, _starts(inputs, problem, _ELSEWHERE), rounds=_ROUNDS_ELSEWHERE)
    near = some.chi_squared <= np.min(ends.chi_squared) + _TO_REFINE
    apart = np.min(
        np.max(abs(some.points[:, np.newaxis] - ends.points) / problem.scale, axis=2), axis=1
    )
    near &= apart > _ONE_BREAK
    if not np.any(near):
        return ends
    more = minimise(alone, some.points[near], rounds=_MORE_ROUNDS)
    return Ends(*map(np.concatenate, zip(ends, more, strict=True)))


def _left_open(found: _Candidate, ends: Ends) -> Any:
    """The points at which the model is asked for its warnings: the answer, and with it, for what
    nothing determines, each value at which a search ended as well.
    """
    points = found.point[np.newaxis]
    known = np.isfinite(found.errors)
    if np.all(known):
        return points
    here = ends.points[_ended_at(ends, found.chi_squared)]
    return np.unique(np.concatenate([points, np.where(known, found.point, here)]), axis=0)


def _said_at(
    inputs: _Inputs, points: Any, model: Model, *, worked_back: bool = False
) -> tuple[Note, ...]:
    """The warnings that a model gives at these points, of the model ``worked_back`` through also
    what it leaves out.
    """
    model.noted.clear()
    values = {name: np.array(points[:, j]) for j, name in enumerate(inputs.units)}
    model(values, len(points), check=False)
    return notes_of_samples(model.noted, worked_back=worked_back)


def _said_within(inputs: _Inputs, found: _Candidate, known: set[str]) -> tuple[Note, ...]:
    """What a model warns of at the ends of the 95 percent ranges, by the slopes, and not at the
    answer, whose warnings have these codes; that it refuses there is said elsewhere.
    """
    which = np.flatnonzero(np.isfinite(found.errors) & (found.errors > 0.0))
    if not which.size:
        return ()
    errors = found.errors[which]
    # One after the other, as their product may overflow.
    alike = found.determination.covariance[np.ix_(which, which)] / errors / errors[:, np.newaxis]
    if not np.all(np.isfinite(alike)):
        return ()
    sizes, axes = np.linalg.eigh(alike)
    # To the ends of each range, and along what together is known best and worst.
    ways = np.concatenate([alike, (axes * np.sqrt(np.maximum(sizes, 0.0))).T]) * errors
    away = np.zeros((len(ways), len(found.point)))
    away[:, which] = _TWO_SIDED * ways
    ends = np.clip(
        np.concatenate([found.point + away, found.point - away]),
        found.problem.low,
        found.problem.high,
    )
    ends = ends[np.all(np.isfinite(ends), axis=1)]
    model = inputs.model
    model.noted.clear()
    model({name: np.array(ends[:, j]) for j, name in enumerate(inputs.units)}, len(ends), False)
    new = {
        one.code: one.sentence
        for _, noted in model.noted
        for one in noted
        if one.code not in known | NO_ANSWER and 0.0 < one.least <= 1.0
    }
    return tuple(
        Note(None, f"at an end of a 95 percent range, not at the estimate: {sentence}", code=code)
        for code, sentence in new.items()
    )


class _Inputs(NamedTuple):
    """The inputs of a fit; ``rows`` are the observations, then the priors, and the rest goes by
    unknown.
    """

    model: Model
    rows: list[Observation]
    units: dict[str, str]
    start: Any
    has_prior: Any

    def named(self, point: Any) -> dict[str, float]:
        """The numbers of a point by unknown."""
        return dict(zip(self.units, point.tolist(), strict=True))

    def computed(self, points: Any) -> Any:
        """The model's value for each row at these points (k, n), in SI; a refused point is NaN in
        all observations.
        """
        answered = self.model(
            {name: np.array(points[:, j]) for j, name in enumerate(self.units)}, len(points)
        )
        found = np.stack(
            observed_columns([row.name for row in self.rows if not row.is_prior], answered), axis=1
        )
        found = np.where(np.all(np.isfinite(found), axis=1, keepdims=True), found, np.nan)
        return np.concatenate([found, points[:, self.has_prior]], axis=1)


def _read_inputs(function: Any, unknowns: Any, observed: Any) -> tuple[_Inputs, Problem]:
    """The inputs, and the least-squares problem that they pose, in units of standard deviations."""
    model, known, rows = read_evidence(function, unknowns, observed, "20.0", _unknown, read_value)
    units, priors, *numbers = zip(*known.values(), strict=True)
    start, scale, low, high = map(np.array, numbers)
    rows += [
        Observation.of(name, prior, is_prior=True)
        for name, prior in zip(known, priors, strict=True)
        if prior
    ]
    has_prior = np.array([prior is not None for prior in priors])
    inputs = _Inputs(model, rows, dict(zip(known, units, strict=True)), start, has_prior)
    # Two cases, because a model that takes numbers would answer an array of one.
    inputs.computed(np.tile(start, (2, 1)))
    sigma = np.array([row.reading.sigma for row in rows])
    angles = [not row.is_prior and row.is_angle(model.units[row.name]) for row in rows]
    return inputs, Problem(
        evaluate=lambda points: inputs.computed(points) / sigma,
        target=np.array([row.reading.residual(0.0, False) for row in rows]) / sigma,
        period=np.where(angles, math.tau / sigma, np.nan),
        low=low,
        high=high,
        scale=scale,
        span=np.where(has_prior, _PRIOR_SPAN, 1.0) * scale,
    )


def _starts(inputs: _Inputs, problem: Problem, count: int = _STARTS) -> Any:
    """Where to start: all over the bounds, or around the start as far as its scale, or three
    deviations of the prior.
    """
    points = spread(
        count,
        np.maximum(problem.low, inputs.start - problem.span),
        np.minimum(problem.high, inputs.start + problem.span),
    )
    points[0] = inputs.start
    return points


def _unknown(label: str, given: Any) -> tuple[str, Normal | None, float, float, float, float]:
    """What is known before of one unknown: its unit, a prior if any, where to start, a scale, and
    bounds.
    """
    if isinstance(given, Normal):
        low, high = given.support
        return given.unit, given, min(max(given.given_mean, low), high), given.given_sd, low, high
    if isinstance(given, (Uniform, Interval)):
        low, high = given.support if isinstance(given, Uniform) else (given.low, given.high)
        return given.unit, None, 0.5 * (low + high), high - low, low, high
    if isinstance(given, Distribution) or not (
        isinstance(given, (int, float, str, np.number)) or is_quantity(given)
    ):
        raise InputError(
            f"{as_code(label)} is of type {type_of(given)}; give a Normal (what is known "
            "before, with its weight), a Uniform or an Interval (bounds that weigh "
            "nothing), or a number to start from; `reconstruct.posterior` takes every "
            f"distribution{range_hint(given)}",
            code="bad_prior",
        )
    (start,), unit = read_alike({label: given})
    return unit, None, start, abs(start) or 1.0, -math.inf, math.inf


@dataclass(frozen=True, eq=False)
class _Candidate:
    """The point where a search ended, with step sizes that suit it."""

    inputs: _Inputs
    problem: Problem
    point: Any
    outputs: Any
    slopes: Any
    chi_squared: float
    converged: bool

    @cached_property
    def determination(self) -> Determination:
        """The covariance of the unknowns by the slopes."""
        return self.determination_of(np.ones(len(self.point), dtype=bool))

    def determination_of(self, chosen: Any) -> Determination:
        """The determination of the chosen unknowns by the slopes, with the others fixed."""
        scale = np.where(
            self.only_a_start, np.maximum(self.problem.scale, abs(self.point)), self.problem.scale
        )[chosen]
        is_prior, steps = (
            np.array([row.is_prior for row in self.inputs.rows]),
            self.problem.steps(self.point)[chosen],
        )
        return determination(
            self.slopes[:, chosen], is_prior, scale, self.outputs, steps, self.problem.noise
        )

    @property
    def only_a_start(self) -> Any:
        """For each unknown, whether its scale is only a guide for where to start."""
        return np.isinf(self.problem.low) & np.isinf(self.problem.high) & ~self.inputs.has_prior

    @property
    def errors(self) -> Any:
        """Standard errors; infinite for unknowns that are not identified."""
        return np.sqrt(np.diagonal(self.determination.covariance))

    @property
    def free(self) -> Any:
        """For each unknown, whether it is off its bounds; one that is not identified
        counts as off.
        """
        at_bound = (self.point <= self.problem.low) | (self.point >= self.problem.high)
        return ~(np.isfinite(self.errors) & at_bound)

    @cached_property
    def moves(self) -> tuple[Any, Any]:
        """Two errors of each unknown up and down (2, n), within the bounds, and how far the misfit
        rises there, in sigma.

        The others follow within their bounds, first by the slopes here, then by those there; where
        that is as in a linear model, they are fitted again.
        """
        covariance = self.determination_of(self.free).covariance
        known = np.isfinite(np.diagonal(covariance))
        which, covariance = np.flatnonzero(self.free)[known], covariance[np.ix_(known, known)]
        if not which.size:
            return np.zeros((2, 0)), np.zeros((2, 0))
        errors = np.sqrt(np.diagonal(covariance))
        ways = np.zeros((len(which), len(self.point)))
        ways[:, which] = covariance / errors[:, np.newaxis]
        room = np.stack(
            [
                self.problem.high[which] - self.point[which],
                self.point[which] - self.problem.low[which],
            ]
        )
        far = np.minimum(room / errors, _TWO_ERRORS)
        points = (self.point + (far * np.array([[1.0], [-1.0]]))[..., np.newaxis] * ways).reshape(
            -1, len(self.point)
        )
        within = np.clip(points, self.problem.low, self.problem.high)
        quick = self.problem.borrowing(self.point, self.slopes)
        outputs, slopes = quick.with_slopes(within)
        held = np.tile(which, 2)
        fixed = (
            ~self.free | (within != points) | (np.arange(len(self.point)) == held[:, np.newaxis])
        )
        slopes = slopes * self.problem.scale
        slopes = np.where(fixed[:, np.newaxis] | ~np.isfinite(slopes), 0.0, slopes)
        misfit = self.problem.misfit(outputs)[..., np.newaxis]
        misfit = misfit - slopes @ (np.linalg.pinv(slopes, _FLAT_SHARE) @ misfit)
        total = np.sum(misfit**2, axis=(1, 2))
        straight = np.tile(_straight(far, self._rise(total)), 2)
        if np.any(straight):
            # The slopes at one place do not tell of a kink beyond it.
            total[straight] = least_at(quick, within[straight], held[straight])
        return far, self._rise(total)

    def _rise(self, chi_squared: Any) -> Any:
        """The rise of the misfit in sigma, up and down (2, n)."""
        return np.sqrt(np.maximum(chi_squared - self.chi_squared, 0.0)).reshape(2, -1)

    @cached_property
    def at_a_kink(self) -> bool:
        """Whether the slopes differ from one side to the other, in a model that neither jumps nor
        scatters: a search ends there by ever shorter steps, and profiles give the range.
        """
        problem, point = self.problem, self.point
        return not problem.noise and problem.has_kink(point) and not problem.jumps(point)

    @property
    def bent(self) -> Any:
        """The unknowns whose range the slopes do not give: those for which the misfit rises
        otherwise, all of them where a bound holds one, and those that nothing determines.
        """
        which = np.flatnonzero(self.free)
        if which.size < len(self.point) or self.at_a_kink:
            return range(len(self.point))
        known = np.isfinite(self.errors)
        far, risen = self.moves
        return np.flatnonzero(known)[~_straight(far, risen)]

    @property
    def nonlinearity(self) -> float:
        """Relative error of the half-width of the 95 percent intervals; NaN if the model refuses
        within two errors.

        In a linear model the misfit rises by as many sigma as an unknown is moved in standard
        errors.
        """
        far, risen = self.moves
        compared = ~(np.maximum(far, risen) <= _LEAST_MOVE)
        return float(np.max(abs(far / risen - 1.0)[compared], initial=0.0))

    def turns_round(self, ends: Ends) -> bool:
        """Whether the searches agree in an unknown about which the slopes tell nothing: its misfit
        turns there.
        """
        converged = ends._replace(converged=True) if self.at_a_kink else ends
        here = ends.points[_ended_at(converged, self.chi_squared)]
        return len(here) > 0 and bool(
            np.any(np.isinf(self.errors) & (np.ptp(here, axis=0) < _AGREEMENT * self.problem.scale))
        )

    @cached_property
    def around(self) -> Ends:
        """Where searches from around the point end."""
        away = np.minimum(_NUDGE * self.problem.scale, self.errors)
        starts = self.point + spread(_AROUND, -away, away)
        return minimise(self.problem, starts, close=_NUDGE)

    @property
    def on_a_ridge(self) -> bool:
        """Whether searches from around the point leave it for less: one that met a ridge exactly
        has no slope to follow.
        """
        least = float(np.min(self.around.chi_squared))
        return least < self.chi_squared - _SAME_CHI_SQUARED

    def overstates_errors(self) -> bool:
        """Whether an error is far too large wherever its unknown has room: its slope vanishes
        nearby.
        """
        far, risen = self.moves
        over = (risen > _TWO_ERRORS) & (risen > _OVERSTATED * far)
        return bool(np.any(np.all(over | (far < _LEAST_MOVE), axis=0) & np.any(over, axis=0)))

    def way_to(self, point: Any) -> Any:
        """The way to another point; of angles the short one."""
        way = point - self.point
        turning = np.array([unit == "rad" for unit in self.inputs.units.values()])
        return np.where(turning, folded(way, math.pi), way)

    def is_apart(self, point: Any) -> bool:
        """Whether a point is more than a standard error away in what the evidence
        determines here.
        """
        known, way = np.isfinite(self.errors), self.way_to(point)
        size = self.errors[known]
        precision = np.linalg.pinv(
            self.determination.covariance[np.ix_(known, known)] / np.outer(size, size),
            hermitian=True,
        )
        return bool((way[known] / size) @ precision @ (way[known] / size) > 1.0)


def _examined(inputs: _Inputs, problem: Problem, ends: Ends, k: int) -> _Candidate:
    """The candidate where search k ended, refined with difference steps that suit it rather than
    the bounds or the start.
    """
    found = _Candidate(inputs, problem, *(part[k] for part in ends))
    most = np.where(found.only_a_start, math.inf, 10.0 * problem.scale)
    for _ in range(_STEP_ROUNDS):
        size = np.clip(
            abs(found.point), np.minimum(0.1 * problem.scale, _MOST_STEPS * found.errors), most
        )
        reach = np.fmin(problem.scale, found.errors)
        alike = abs(np.log2(size / found.problem.sizes(found.point))) < 1.0
        if problem.noise:
            alike &= abs(np.log2(reach / found.problem.reaches)) < 1.0
        if np.all(alike):
            break
        finer = problem._replace(size=size, reach=reach)
        again = minimise(finer, found.point[np.newaxis])
        if not again.chi_squared[0] <= found.chi_squared + _SAME_CHI_SQUARED:
            break
        found = _Candidate(inputs, finer, *(part[0] for part in again))
    return found


def _straight(far: Any, risen: Any) -> Any:
    """Which unknowns make the misfit rise as in a linear model, two errors up and down (2, n)."""
    return np.all(far == _TWO_ERRORS, axis=0) & np.all(abs(risen - far) <= _STRAIGHT * far, axis=0)


def _ended_at(ends: Ends, chi_squared: float) -> Any:
    """Which searches ended at a minimum of this misfit."""
    return ends.converged & (abs(ends.chi_squared - chi_squared) <= _SAME_CHI_SQUARED)


def _followed(
    inputs: _Inputs, problem: Problem, ends: Ends, few: bool
) -> tuple[_Candidate, Ends, list[tuple[_Candidate, Found]]]:
    """The best candidate, the ends of all searches, and the best and each rival with the profiles
    that its range needs.

    A profile that meets a lower misfit starts a search there.
    """
    for _ in range(_STEP_ROUNDS):
        # The least misfit, or one that is as good where a search converged.
        order = ends.chi_squared + _SAME_CHI_SQUARED * ~ends.converged
        best = _examined(inputs, problem, ends, int(np.argmin(order)))
        _check_minimum(best, ends, few)
        rivals = _rivals(best, ends)
        found = [
            (one, followed(one.problem, one.point, best.chi_squared, one.determination.covariance,
             range(len(one.point)) if len(rivals) > 1 else best.bent))
            for one in rivals
        ]  # fmt: skip
        lower = [one for _, one in found if one.lowest < best.chi_squared - _SAME_CHI_SQUARED]
        if not lower:
            break
        again = minimise(problem, np.stack([one.at for one in lower]))
        # As often as it takes to count as found: it was reached on purpose.
        ends = Ends(
            *(
                np.concatenate([one, *[two] * (_FEW + 1)])
                for one, two in zip(ends, again, strict=True)
            )
        )
    return best, ends, found


def _distinct(found: list[tuple[_Candidate, Found]]) -> bool:
    """Whether no one range describes the answers: two lie outside the errors of each other in an
    unknown that both determine, or values in between are excluded.
    """
    best = found[0][0]
    for other, _ in found[1:]:
        apart = best.way_to(other.point)
        error = np.maximum(best.errors, other.errors)
        if np.any(np.isfinite(error) & (abs(apart) > _TWO_SIDED * error)):
            return True
    for j in found[0][1].sides:
        reached = [[side.reach(_TWO_SIDED) for side in one.sides[j]] for _, one in found]
        pieces = sorted(one for one in reached if not np.any(np.isnan(one)))
        if any(low > max(top for _, top in pieces[:k]) for k, (low, _) in enumerate(pieces) if k):
            return True
    return False


def _with_profiles(fits: list[Fit], found: list[tuple[_Candidate, Found]]) -> dict[str, Any]:
    """What the profiles tell of the best fit: the ranges, the rivals within them, and whether the
    model refuses there.
    """
    names = fits[0].names
    return {
        "profiles": {
            names[j]: tuple(
                table([one.sides[j] for _, one in found], [one.closer[j] for _, one in found])
            )
            for j in found[0][1].sides
        },
        "others": tuple(fits[1:]),
        "refuses_nearby": any(one.refused for _, one in found),
    }


def _with_own(fit: Fit, found: _Candidate) -> Fit:
    """One of several answers with the profiles of itself alone, where slopes do not give its
    ranges.
    """
    which = found.bent if found.converged else range(len(found.point))
    covariance = found.determination.covariance
    own = followed(found.problem, found.point, found.chi_squared, covariance, which)
    profiles = {
        fit.names[j]: tuple(table([both], [own.closer[j]])) for j, both in own.sides.items()
    }
    return replace(fit, profiles=profiles, refuses_nearby=own.refused)


def _check_minimum(best: _Candidate, ends: Ends, few: bool = True) -> None:
    """Raise if one value and its error do not describe the least misfit that was found, with
    ``few`` also if few of many searches ended there.
    """
    kink = best.at_a_kink
    here = _ended_at(ends._replace(converged=True) if kink else ends, best.chi_squared)
    if (
        not (kink or best.converged)
        or (not kink and best.problem.has_kink(best.point))
        or best.turns_round(ends)
        or (not kink and best.overstates_errors())
    ):
        why = (
            "where the model jumps, bends, turns round or refuses, so that its slopes give no error"
        )
    elif few and (np.count_nonzero(here) <= _FEW < np.count_nonzero(np.isfinite(ends.chi_squared))):
        why = (
            f"where few of the {_STARTS} searches ended, so that a better answer may lie between "
            "them"
        )
    else:
        return
    at = best.inputs.named(best.point)
    raise NoSolutionError(
        f"the least misfit found is chi-squared {best.chi_squared:.6g} at "
        f"{listed(at, best.inputs.units)}, {why}. `reconstruct.posterior` answers there too, with "
        f"a range: write {_POSTERIOR}; or narrow the bounds to one side of it, or give a prior (a "
        "Normal)",
        code="no_convergence",
        chi_squared=float(best.chi_squared),
        at=at,
    )


def _rivals(best: _Candidate, ends: Ends) -> list[_Candidate]:
    """The best candidate, and others apart from it that the evidence does not exclude although the
    errors of the best do.

    Where the model jumps, bends or refuses a search does not converge, and the misfit may still be
    the least around.
    """
    found, most = [best], best.chi_squared + _TOO_CLOSE
    broken = 0
    for k in np.lexsort((ends.chi_squared, ~ends.converged)).tolist():
        if broken == _MOST_BROKEN or not ends.chi_squared[k] <= most:
            continue
        rival = _apart_from(found, ends, k)
        for _ in range(_STEP_ROUNDS):
            if rival is None or rival.converged or not rival.on_a_ridge:
                break
            # Along a kink or an edge a search stops before the least.
            rival = _apart_from(found, rival.around, int(np.argmin(rival.around.chi_squared)))
        if rival is not None and not rival.on_a_ridge:
            found.append(rival)
            broken += not rival.converged
    return found


def _apart_from(found: list[_Candidate], ends: Ends, k: int) -> _Candidate | None:
    """The candidate where search k ended, if that is apart from all that were found."""
    point, best = ends.points[k], found[0]
    # Slopes at a jump give no error to judge by, and searches stop all along one.
    away = (
        np.any(
            abs(one.way_to(point))
            > (_AGREEMENT if one.converged else _ONE_BREAK) * one.problem.scale
        )
        for one in found
    )
    if (ends.converged[k] or all(away)) and all(one.is_apart(point) for one in found):
        return _examined(best.inputs, best.problem._replace(size=None, reach=None), ends, k)
    return None


def _ambiguous(fits: list[Fit]) -> AmbiguousSolutionError:
    answers = "; ".join(
        f"chi-squared {one.chi_squared:.4g} at {listed(one.values, one.units)}" for one in fits
    )
    return AmbiguousSolutionError(
        f"{len(fits)} answers fit the evidence about as well: {answers}. "
        f"{_agreeing(fits)}`|All are in .solutions. |`How probable each is, with one range "
        f"over all of them, says `reconstruct.posterior`: write {_POSTERIOR}; or narrow "
        "the bounds of an unknown to one, or add an observation that tells them apart",
        code="ambiguous",
        solutions=tuple(fits),
    )


def _agreeing(fits: list[Fit]) -> str:
    """The unknowns on which all answers agree within a standard error of the best, if any."""
    best, *others = fits
    agree = []
    for name, error in best.standard_errors.items():
        apart = np.array([one.values[name] - best.values[name] for one in others])
        if best.units[name] == "rad":
            apart = folded(apart, math.pi)
        if math.isfinite(error) and np.all(abs(apart) <= error):
            agree.append(name)
    return f"They agree on {', '.join(agree)} within a standard error. " if agree else ""


def _by_weight(changes: Any, errors: Any) -> list[int]:
    """Which unknowns move along a direction, in order of how far they do beside their errors: the
    sentence is about the first.
    """
    with np.errstate(all="ignore"):
        weights = np.nan_to_num(abs(changes) / errors, nan=np.inf)
    return sorted(np.flatnonzero(changes).tolist(), key=lambda at: -weights[at])


def _answer(found: _Candidate) -> Fit:
    """The ``Fit`` of a candidate."""
    inputs, problem, point, determined = (
        found.inputs,
        found.problem,
        found.point,
        found.determination,
    )
    names, identified = tuple(inputs.units), np.isfinite(found.errors)
    over_sigma = -problem.misfit(found.outputs)
    computed = inputs.computed(point[np.newaxis])[0]
    residuals = {
        f"prior of {row.name}" if row.is_prior else row.name: residual_of(
            row, inputs.model.units.get(row.name), value, sigmas * row.reading.sigma
        )
        for row, value, sigmas in zip(
            inputs.rows, computed.tolist(), over_sigma.tolist(), strict=True
        )
    }
    sides = np.where(
        point <= problem.low, "low", np.where(point >= problem.high, "high", "")
    ).tolist()
    degrees_of_freedom = len(inputs.rows) - found.determination_of(found.free).rank
    chi_squared = float(over_sigma @ over_sigma)
    shares = [dict(zip(residuals, row, strict=True)) for row in determined.shares.tolist()]
    return Fit(
        values=Values(inputs.named(np.where(identified, point, math.nan)), inputs.units),
        names=names,
        units=inputs.units,
        bounds=dict(
            zip(names, zip(problem.low.tolist(), problem.high.tolist(), strict=True), strict=True)
        ),
        covariance=read_only(np.array(determined.covariance)),
        residuals=residuals,
        contributions={
            name: row if known else {}
            for name, row, known in zip(names, shares, identified, strict=True)
        },
        chi_squared=chi_squared,
        degrees_of_freedom=degrees_of_freedom,
        p_value=chi_squared_tail(chi_squared, degrees_of_freedom),
        undetermined=tuple(
            Direction(
                changes={names[j]: float(row[j]) for j in _by_weight(row, found.errors)},
                held_by_prior=held,
            )
            for held, rows in ((False, determined.unidentified), (True, determined.prior_only))
            for row in rows
        ),
        at_bounds={
            name: side
            for name, side, known in zip(names, sides, identified, strict=True)
            if side and known
        },
        nonlinearity=found.nonlinearity,
    )

"""``Fit``: the estimates of a fit, their errors, the residual of each observation, and the unknowns
left unidentified.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field, fields
from itertools import combinations
from types import MappingProxyType
from typing import Any

import numpy as np

from ..messages.errors import (
    CollisionsWarning,
    IllConditionedWarning,
    InputError,
    NoSolutionError,
    SuspectUnitsWarning,
)
from ..messages.shares import chance as chance_in_words
from ..messages.warning import AGREES, Note
from ..quantities.attributes import OWN_UNIT, Shown, derived
from ..quantities.refusals import LATERAL, must_be
from ..quantities.strict_json import strict
from ..quantities.tables import Cells, Part, Summary, as_sentence
from ..quantities.units import shown, to_quantity
from ..uncertainty.distribution import GivenUnit, correlated, found_by
from ..uncertainty.distributions import Normal
from ..uncertainty.normal import score_of_coverage
from .evidence import Observation

_GIVEN_ERRORS = "A standard error holds given the stated errors of the observations and priors."
_TAKE_POSTERIOR = (
    "; `reconstruct.posterior` gives the range that the evidence leaves, whatever its shape"
)
_NONE = "\u2013"
_LARGE_NONLINEARITY = 0.2  # of the half-width of a 95 percent interval
# Probabilities of the misfit below which the evidence is said to agree weakly, and to contradict
# itself.
_WEAK, CONTRADICTION = 0.05, 0.01
# A reading this many sigma off may have the wrong sign, if the other one takes this share of the
# misfit. What is computed is a compromise, in which it cannot take all of it.
_FAR_OFF, _NEARER = 3.0, 0.5


def with_unit(value: Any, unit: str | None) -> Any:
    """The number as a Quantity, or as it is if its unit is unknown."""
    return to_quantity(value, unit) if unit else value


class Values(dict[str, float]):
    """SI numbers by name; ``.q`` has them as Quantities where they were given units."""

    def __init__(self, values: Mapping[str, float], units: Mapping[str, str]) -> None:
        super().__init__(values)
        self.units = dict(units)

    @property
    def q(self) -> dict[str, Any]:
        """The same as Quantities; a number of unknown unit stays a number."""
        return {name: with_unit(value, self.units[name]) for name, value in self.items()}


class WithUnit(Shown):
    """Base of results whose numbers share one unit, which each instance sets."""

    __slots__ = ()
    unit: str

    @property
    def q(self) -> dict[str, Any]:
        """The same with the unit; numbers if it is unknown."""
        shared = {
            f.name: getattr(self, f.name)
            for f in fields(self)
            if f.metadata.get("unit") == OWN_UNIT
        }
        return {
            name: with_unit(value, self.unit) for name, value in shared.items() if value is not None
        }

    def _values(self, prefix: str = "") -> Iterator[tuple[str, Any, str | None]]:
        for f in fields(self):
            value = getattr(self, f.name)
            if value is not None and f.name != "unit":
                yield (
                    prefix + f.name,
                    value,
                    self.unit if f.metadata.get("unit") == OWN_UNIT else None,
                )


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Estimate(WithUnit):
    """One unknown: its value and standard error, NaN and inf if it is not identified; ``at_bound``
    is "low" or "high".
    """

    name: str
    unit: str
    value: float = field(metadata={"unit": OWN_UNIT})
    standard_error: float = field(metadata={"unit": OWN_UNIT})
    low: float = field(metadata={"unit": OWN_UNIT})
    high: float = field(metadata={"unit": OWN_UNIT})
    at_bound: str | None
    profile: tuple[tuple[float, float, float], ...] = ()

    _title = "Estimate"

    @property
    def determined(self) -> bool:
        """Whether evidence or a prior identifies it."""
        return math.isfinite(self.standard_error)

    def interval(self, coverage: float) -> tuple[float, float]:
        """Central range that holds the truth with this probability given the stated errors, cut off
        at the bounds.

        Normal theory around the estimate where the model is nearly linear; elsewhere the values at
        which chi-squared rises by less than the square of the normal score of the coverage, with
        the other unknowns fitted again. That is fitted for 95 percent, and where in doubt for 50,
        80, 90 and 99 percent; ends for others lie between these as the profile has them, beside a
        kink up to a quarter of the range off, and beyond 99.6 percent they go on as at its end. The
        bounds themselves where nothing determines the unknown.

        Parameters
        ----------
        coverage : float [-]
            Probability that the range holds, between 0 and 1.

        Returns
        -------
        tuple of two floats
            Both ends, in the unit of the unknown.
        """
        if (
            isinstance(coverage, bool)
            or not isinstance(coverage, (int, float))
            or not 0.0 < coverage < 1.0
        ):
            raise must_be(
                "coverage", "between 0 and 1, such as 0.95", coverage, code="bad_fraction"
            )
        if not self.determined:
            return self.low, self.high
        score = score_of_coverage(float(coverage))
        if self.profile:
            level, *sides = np.array(self.profile).T
            ends = [float(np.interp(score, level, side)) for side in sides]
            if score > level[-1]:
                more = (score - level[-1]) / (level[-1] - level[-2])
                ends = [side[-1] + more * (side[-1] - side[-2]) for side in sides]
            return max(self.low, ends[0]), min(self.high, ends[1])
        half = score * self.standard_error
        return max(self.low, self.value - half), min(self.high, self.value + half)


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Residual(WithUnit):
    """One observation or prior: the stated value, the fitted value, and their difference in sigma.

    ``residual`` is observed less computed; for angles by the short way round, in (-pi, pi].
    """

    name: str
    unit: str
    observed: float = field(metadata={"unit": OWN_UNIT})
    computed: float = field(metadata={"unit": OWN_UNIT})
    residual: float = field(metadata={"unit": OWN_UNIT})
    sigma: float = field(metadata={"unit": OWN_UNIT})
    over_sigma: float
    is_prior: bool

    _title = "Residual"


def residual_of(row: Observation, unit: str | None, computed: float, apart: float) -> Residual:
    """An observation or prior beside its computed value; for a censored reading, the bound that is
    missed, if any.
    """
    sigma = row.reading.sigma
    return Residual(
        name=row.name,
        unit=row.reading.value.unit or unit or "",
        observed=row.reading.observed(computed, apart),
        computed=computed,
        residual=apart,
        sigma=sigma,
        over_sigma=apart / sigma if sigma else 0.0,
        is_prior=row.is_prior,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Direction:
    """A direction in which the evidence does not determine the unknowns: the change of each in SI,
    all moving together.

    ``held_by_prior`` says whether the priors settle it; otherwise nothing does.
    """

    changes: dict[str, float]
    held_by_prior: bool

    @property
    def unknowns(self) -> tuple[str, ...]:
        """The unknowns that move along this direction."""
        return tuple(self.changes)

    @property
    def sentence(self) -> str:
        """The direction as a sentence."""
        what, *rest = self.changes
        if rest:
            moves = ", ".join(
                f"{name} by {self.changes[name] / self.changes[what]:+.4g}" for name in rest
            )
            what = f"a change of {what} by +1 together with {moves} (SI)"
        and_so = (
            "and rests on what was stated before"
            if self.held_by_prior
            else "and no prior settles it"
        )
        return f"{what} is not determined by the evidence, {and_so}"


class SpeedsFound:
    """The speeds before as other reverse answers have them, where the model has such names."""

    __slots__ = ()

    @derived("m/s")
    def speed_a(self: Any) -> float | None:
        """Speed of A before the impact [m/s]: what was found of "speed_a", of a posterior its mean;
        None where nothing has that name.
        """
        speed: float | None = self._speed("speed_a")
        return speed

    @derived("m/s")
    def speed_b(self: Any) -> float | None:
        """Speed of B before the impact [m/s]: what was found of "speed_b", of a posterior its mean;
        None where nothing has that name.
        """
        speed: float | None = self._speed("speed_b")
        return speed


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Fit(SpeedsFound, Shown):
    """The result of a fit: estimates of the unknowns from the observations, given the stated
    errors.

    ``values`` are SI floats by name, NaN where nothing determines an unknown; ``fit["speed_a"]``
    has value, standard error and interval. ``covariance`` (read-only, in the order of ``names``)
    follows from the model's slopes at the answer, with inf and NaN for what is not determined;
    where an unknown is in ``at_bounds`` it is the covariance without the bound, so that no error is
    too small. ``residuals`` and ``contributions`` go by the names of the observations, and by
    "prior of x" for the priors. ``contributions[unknown][observation]`` is the share of the
    unknown's variance that is due to the error of the observation. ``nonlinearity`` is the relative
    amount by which 1.96 standard errors are too narrow or too wide for 95 percent, judged by the
    rise of chi-squared when an unknown is moved by two standard errors (or to its bound) and the
    others follow the slopes, or are fitted again where those look right; NaN if the model refuses
    there. ``model_notes`` are the warnings of this library while the model worked at the answer,
    which ``statements`` have too; with an unknown that nothing determines, at each of its values
    with which a search ended there. What it warns of at an end of a range alone is stated and not
    raised. ``calls`` says how many cases were asked of each model: "model", and "finer" if one was
    given, whose fit this then is.

    ``profiles`` has, for unknowns whose range the slopes do not give, rows of a rise of the misfit
    in sigma with the least and the greatest value that has no more, the others fitted again,
    infinite where no value is too far; ``interval`` takes them. ``others`` are answers that fit
    about as well and are within the ranges. ``refuses_nearby`` says whether the model refuses
    within the range of 95 percent.
    """

    values: Values
    names: tuple[str, ...]
    units: dict[str, str]
    bounds: dict[str, tuple[float, float]]
    covariance: Any
    residuals: dict[str, Residual]
    contributions: dict[str, dict[str, float]]
    chi_squared: float = field(metadata={"unit": ""})
    degrees_of_freedom: int = field(metadata={"unit": ""})
    p_value: float = field(metadata={"unit": ""})
    undetermined: tuple[Direction, ...]
    at_bounds: dict[str, str]
    nonlinearity: float = field(metadata={"unit": ""})
    calls: dict[str, int] = field(default_factory=dict)
    profiles: dict[str, tuple[tuple[float, float, float], ...]] = field(default_factory=dict)
    others: tuple[Fit, ...] = ()
    refuses_nearby: bool = False
    model_notes: tuple[Note, ...] = ()
    # The scene that it is of, where the model was one.
    _scene: Any = None

    _title = "Fit to evidence"

    def __getitem__(self, name: str) -> Estimate:
        if not isinstance(name, str) or name not in self.names:
            raise InputError(
                f"{shown(name)} is none of the unknowns, which are {', '.join(self.names)}",
                code="unknown_name",
                argument="name",
            )
        low, high = self.bounds[name]
        return Estimate(
            name=name,
            unit=self.units[name],
            value=self.values[name],
            standard_error=self.standard_errors[name],
            low=low,
            high=high,
            at_bound=self.at_bounds.get(name),
            profile=self.profiles.get(name, ()),
        )

    @property
    def found(self) -> tuple[str, ...]:
        """Names of what was found, as opposed to what was observed: the unknowns."""
        return self.names

    def _speed(self, name: str) -> float | None:
        return self.values[name] if self.units.get(name) in ("", "m/s") else None

    @property
    def standard_errors(self) -> Values:
        """Standard errors by unknown; inf where nothing determines it."""
        roots = np.sqrt(np.diagonal(self.covariance)).tolist()
        return Values(dict(zip(self.names, roots, strict=True)), self.units)

    @derived()
    def correlation_matrix(self) -> Any:
        """Correlations in the order of ``names``; NaN for unknowns that are not determined."""
        errors = np.sqrt(np.diagonal(self.covariance))
        found = np.clip(self.covariance / np.outer(errors, errors), -1.0, 1.0)
        np.fill_diagonal(found, np.where(np.isfinite(errors), 1.0, np.nan))
        return found

    @property
    def correlation(self) -> dict[tuple[str, str], float]:
        """Correlations by pair of unknowns, as ``uncertainty.propagate`` takes them together with
        ``inputs``.
        """
        self._check_determined("correlation")
        pairs = combinations(enumerate(self.names), 2)
        return {
            (one, other): float(self.correlation_matrix[i, j]) for (i, one), (j, other) in pairs
        }

    @property
    def inputs(self) -> dict[str, Normal]:
        """Estimates by unknown, each a normal distribution within its bounds, as
        ``uncertainty.propagate`` takes them with ``correlation``; what was stated of the fit goes
        with them. A study of them without their correlation warns of that.

        Where normal distributions with the standard errors do not describe the answer, as where
        the model bends, it is a ``NoSolutionError`` (code "not_normal").
        """
        self._check_determined("inputs")
        against = "; ".join(note.sentence for note in _against_errors(self))
        if against:
            raise NoSolutionError(
                "inputs are normal distributions with the standard errors, which do not describe "
                f"this answer: {against}. In place of them give `posterior(model, unknowns, "
                "observed, seed=1).inputs()`, with `Uniform(low, high)` of each unknown that has "
                "no prior; they are joint samples, with no correlation beside them",
                code="not_normal",
            )
        normals = {name: self._as_normal(name) for name in self.names}
        return correlated(found_by("a fit", normals, notes_of(self)), self.correlation)

    @property
    def consistent(self) -> bool | None:
        """Whether a misfit this large has a probability of 0.01 or more; None with no more
        observations than unknowns.
        """
        return None if math.isnan(self.p_value) else self.p_value >= CONTRADICTION

    @property
    def told_by_bounds(self) -> tuple[str, ...]:
        """The unknowns of which the evidence excludes no value within their bounds, at 95
        percent.
        """
        return tuple(
            name
            for name, (low, high) in self.bounds.items()
            if low < high < math.inf
            and low > -math.inf
            and self[name].determined
            and self[name].interval(0.95) == (low, high)
        )

    @property
    def statements(self) -> tuple[str, ...]:
        """The statements that belong with the numbers, as sentences."""
        return tuple(note.statement for note in notes_of(self))

    def to_dict(self) -> dict[str, Any]:
        """Everything as strict JSON, with infinities and NaN by name.

        Returns
        -------
        dict
            Plain values that ``json.dumps`` writes; infinity and NaN as texts.
        """
        record = {
            "statements": self.statements,
            "unknowns": {name: asdict(self[name]) for name in self.names},
            "covariance": self.covariance.tolist(),
            "residuals": {name: asdict(one) for name, one in self.residuals.items()},
            "undetermined": [asdict(one) | {"sentence": one.sentence} for one in self.undetermined],
        }
        plain = (
            "names",
            "contributions",
            "at_bounds",
            "chi_squared",
            "degrees_of_freedom",
            "p_value",
            "nonlinearity",
            "calls",
        )
        written: dict[str, Any] = strict(record | {name: getattr(self, name) for name in plain})
        return written

    def _summary(self, numbers: Cells) -> Summary:
        def row(one: Estimate) -> tuple[str, ...]:
            if not one.determined:
                return one.name, "not determined", _NONE, _NONE
            bound = f" ({one.at_bound} bound)" if one.at_bound else ""
            value, error = (
                numbers.text(part, one.unit) for part in (one.value, one.standard_error)
            )
            return (
                one.name,
                value + bound,
                error,
                numbers.text(np.array(one.interval(0.95)), one.unit),
            )

        misfit = [
            (
                name,
                numbers.text(one.observed, one.unit),
                numbers.text(one.computed, one.unit),
                f"{one.over_sigma:+.2f}",
            )
            for name, one in self.residuals.items()
        ]
        parts = [
            Part(
                [row(self[name]) for name in self.names],
                "Unknown",
                ("estimate", "standard error", "95 percent interval"),
            ),
            Part(misfit, "Evidence", ("observed", "computed", "residual over sigma")),
            Part([("chi-squared", _chi_squared(self))] if self.degrees_of_freedom else []),
        ]
        return Summary(self._title, parts, (*map(as_sentence, self.statements), _GIVEN_ERRORS))

    def _texts(self) -> Iterator[str]:
        units = (*self.units.values(), *(one.unit for one in self.residuals.values()))
        return (f"1 {unit.written}" for unit in units if isinstance(unit, GivenUnit))

    def __repr__(self) -> str:
        return str(self.summary())

    def _as_normal(self, name: str) -> Normal:
        one = self[name]
        value, error = (with_unit(number, one.unit) for number in (one.value, one.standard_error))
        low, high = (
            with_unit(end, one.unit) if math.isfinite(end) else None for end in (one.low, one.high)
        )
        return Normal(value, error, truncate=(low, high))

    def _check_determined(self, what: str) -> None:
        left = [name for name in self.names if not self[name].determined]
        if left:
            raise NoSolutionError(
                f"{what} need every unknown determined, and nothing determines "
                f"{', '.join(left)}; give a prior of it (a Normal), leave it out, or read the "
                "others from .values and .covariance",
                code="undetermined",
                unknowns=tuple(left),
            )


def _chi_squared(found: Fit) -> str:
    """Chi-squared with its degrees of freedom, in words."""
    degrees = found.degrees_of_freedom
    return f"{found.chi_squared:.4g} with {degrees} degree{'' if degrees == 1 else 's'} of freedom"


def notes_of(found: Fit) -> Iterator[Note]:
    """The notes on a fit in the order of importance: first whether the evidence agrees."""
    if found.consistent is None:
        yield Note(None, "there is no more evidence than unknowns, so that nothing checks it")
    else:
        yield agreement(found.p_value, found.residuals, f" (chi-squared {_chi_squared(found)})")
    for direction in found.undetermined:
        advice = (
            "; give a prior of it (a Normal), or an observation that determines it, or "
            "take `reconstruct.posterior`"
        )
        open_ = Note(IllConditionedWarning, direction.sentence, advice, "undetermined")
        yield Note(None, direction.sentence) if direction.held_by_prior else open_
    yield from _against_errors(found)
    for name, one in found.residuals.items():
        if (
            not one.unit
            and not one.is_prior
            and max(abs(one.observed), abs(one.computed)) <= math.pi < abs(one.residual)
        ):
            degrees = f"'{math.degrees(one.observed):.4g} deg', '{math.degrees(one.sigma):.3g} deg'"
            yield Note(
                SuspectUnitsWarning,
                f"{name} is observed as {one.observed:.6g} and computed as {one.computed:.6g}; "
                "if it is an angle, the short way between them is round the circle: give it "
                f"with its unit, such as `Normal({degrees})`",
                "",
                "bare_angle",
            )
    if "finer" in found.calls:
        yield Note(
            None,
            f"the answer is that of the finer model, which was asked {found.calls['finer']} times, "
            f"and the other model {found.calls['model']} times",
        )
    yield from found.model_notes


def _against_errors(found: Fit) -> Iterator[Note]:
    """What says that normal distributions with the standard errors do not describe the answer."""
    for name, side in found.at_bounds.items():
        inward = "above" if side == "low" else "below"
        sentence = (
            f"{name} ended on its {side} bound, beyond which the evidence pulls it: its range "
            f"reaches {inward} only"
        )
        yield Note(None, sentence)
    for name in found.told_by_bounds:
        yield Note(
            IllConditionedWarning,
            f"the evidence excludes no value of {name} within its bounds: they limit it, not the "
            "evidence",
            _TAKE_POSTERIOR,
            "told_by_bounds",
        )
    if found.refuses_nearby:
        yield Note(
            IllConditionedWarning,
            "the model refuses within two standard errors of the answer: the 95 percent intervals "
            "end there",
            _TAKE_POSTERIOR,
            "not_linear",
        )
    if not found.nonlinearity <= _LARGE_NONLINEARITY:
        yield Note(
            None,
            "the model bends within two standard errors of the answer: the 95 percent intervals "
            "are those in which chi-squared rises by less than 3.84, and the standard errors do "
            "not describe them",
        )
    for other in found.others:
        yield Note(
            None,
            f"another answer fits about as well, with chi-squared {other.chi_squared:.4g} beside "
            f"{found.chi_squared:.4g}; the 95 percent intervals hold both",
        )


def agreement(
    p_value: float,
    residuals: Mapping[str, Residual],
    by: str = "",
    apart: Mapping[str, float] = MappingProxyType({}),
) -> Note:
    """Whether the evidence agrees with itself, by the chance of its misfit in two digits, never
    rounded across a limit or to a certainty; ``apart`` is what else may be off, in sigma.
    """
    text = f"{p_value:.2g}"
    text = next(
        (
            f"just below {limit:g}"
            for limit in (_WEAK, CONTRADICTION)
            if p_value < limit <= float(text)
        ),
        chance_in_words(p_value),
    )
    chance = f"a misfit this large or larger has a chance of {text}"
    with_priors = apart or any(one.is_prior for one in residuals.values())
    rest = (
        "the model, the stated errors {} the priors"
        if with_priors
        else "the model {} the stated errors"
    )
    if p_value >= _WEAK:
        whom = "itself and the priors" if with_priors else "itself"
        return Note(None, f"the evidence agrees with {whom}: {chance}", code=AGREES)
    if p_value >= CONTRADICTION:
        return Note(
            None,
            f"the evidence agrees only weakly with itself, {rest.format('and')}: {chance}",
        )
    off = {
        f"the {name}" if one.is_prior else name: one.over_sigma for name, one in residuals.items()
    } | {**apart}
    name, worst = max(off.items(), key=lambda item: abs(item[1]))
    return Note(
        CollisionsWarning,
        f"the evidence contradicts itself, {rest.format('or')}: {chance}",
        f", and {CONTRADICTION} would pass{by}; the furthest off is {name}, by "
        f"{abs(worst):.3g} sigma{''.join(map(_turned, residuals.values()))}",
        "contradictory",
    )


def _turned(one: Residual) -> str:
    """The hint at a reading whose sign may be that of another convention; "" for others."""
    with_other = abs(one.observed + one.computed)
    if one.is_prior or abs(one.over_sigma) < _FAR_OFF or with_other > _NEARER * abs(one.residual):
        return ""
    why = f": {LATERAL}" if "delta_v_left" in one.name else "; look at which way it is counted"
    return f". {one.name} fits better with the opposite sign{why}"

"""``posterior``: samples of the unknowns of a scene given all the evidence, and how probable the
evidence is.
"""

from __future__ import annotations

import math
import secrets
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ..engine.blocks import in_order
from ..messages.errors import CollisionsWarning, InputError, NoSolutionError
from ..messages.hints import hinted
from ..messages.marked import as_code, type_of
from ..messages.progress import reporter
from ..messages.warning import ONE_ORDER, Note, notes_of_samples, warn_of
from ..quantities.attributes import read_only
from ..quantities.units import Input
from ..uncertainty.distribution import notes_of_inputs
from ..uncertainty.distributions import Distribution
from ..uncertainty.finer import FinerModel
from ..uncertainty.model import AnyModel, Model, function_of, range_hint, scene_among, units_taken
from ..uncertainty.output_notes import unanswered_notes, wrap_notes, wraps_of
from ..uncertainty.propagation import check_options
from ..uncertainty.sampling import Correlation, Joint
from ..uncertainty.turns import folded
from .at_level import at_level
from .evidence import (
    Observation,
    bare_angle_notes,
    observed_columns,
    read_evidence,
    read_reading,
    refused_everywhere,
)
from .fit_result import residual_of
from .islands import Island, Islands, UnreachableError
from .least_squares import chi_squared_tail
from .posterior_result import Posterior, PosteriorOutput, notes_of
from .tempering import FinerIslands, FinerUnreachableError, TwoModels

ISLANDS = 8
_SIDE_BY_SIDE = (
    4  # in each call of the model, for any number of threads: so that no bit depends on it
)
_LEAST_SAMPLES = 512
_COMPARED = 64  # points of the priors at which a finer model is compared with the model
_LEAST_SOFTENED = 1e-3  # of the size of an output, where two models agree on it


@hinted
def posterior(
    model: AnyModel,
    unknowns: Mapping[str, Any],
    observed: Mapping[str, Any],
    *,
    finer: AnyModel | None = None,
    tolerance: Input | Mapping[str, Input] | None = None,
    samples: int = 8192,
    seed: int | None = None,
    correlation: Correlation | None = None,
    threads: int = 1,
    progress: Callable[[int, int], None] | bool | None = None,
) -> Posterior:
    """How probable each value of the unknowns of a scene is, given what was known before and
    everything observed.

    Bayes' theorem by sampling, for any priors, however nonlinear the model and however many answers
    there are. Tempered sequential Monte Carlo takes the samples from the priors to the posterior in
    eight islands, each resampled by itself; the differences between them give the sampling errors.
    An answer far from all others that has little of the probability may lose all its samples on the
    way, and the errors do not tell.
    All figures are conditional on the model, the priors and the stated errors of the observations,
    which are taken as normal and independent. For the method in this field see G. A. Davis,
    "Bayesian reconstruction of traffic accidents", Law, Probability and Risk 2 (2003) 69-89.

    Parameters
    ----------
    model : function
        ``model(**unknowns)`` returns a dict of named outputs, as for ``fit`` and
        ``uncertainty.propagate``; or a ``scene.Scene``, with paths for names. It is called with
        arrays of cases [SI] and answers case by case, NaN where it refuses (``on_failure="nan"``),
        which rules these values of the unknowns out. What is known exactly is written into the
        model.
    unknowns : dict
        By name, the prior (what was known before): any distribution of ``uncertainty``, truncated
        or not. An ``Interval`` says nothing about likelihood and is refused: give ``Uniform``.
    observed : dict
        By output of the model, ``Normal(value, error)`` or the pair (value, error) as for ``fit``;
        an ``Interval`` within which it lies; or ``Censored(low, high, error)``, a reading of which
        only one bound, or both, are known. Angles with a unit are taken round the circle. Bare
        numbers are in SI; a text needs its unit where the model returns one, and where it returns
        bare floats, whose unit is not known, ``("5", "1")`` is read as the numbers.
    finer : function, optional
        A model that takes the same unknowns and returns the same outputs, and costs more. The
        samples go towards the posterior of ``model`` first, until its likelihood to the power 0.15,
        or a lower one where the two models differ by several errors of the readings, and from there
        to the posterior of ``finer``. The answer is that of ``finer`` alone, its evidence included,
        wherever ``model`` leads, for five to twelve calls of it a sample, not a hundred, and more
        where the two differ by many errors of the readings; ``.calls`` has their number. Values
        that fit under ``finer`` alone, far from all that fit under ``model``, get no samples and
        are not found.
    tolerance : float [-] or dict, optional
        How far the model may be off, for a ``scene.Scene``: by result, as for ``Scene.required``;
        or one number for all, as a share of the stated error of each observation. The cheapest
        level of the scene that is within it for 95 % of the priors then answers in its place, and
        a statement says which. On wheels with readings of the way to rest, the samples go towards
        the same level followed coarsely first, as by ``finer``.
    samples : int, optional
        Total number of samples, at least 512. Four times as many halve the sampling errors.
    seed : int, optional
        Makes the result reproducible to the bit, for any number of threads; without it, ``.seed``
        tells which was used.
    correlation : dict, optional
        Correlations of the priors, {("mass_a", "mass_b"): 0.8}, as for ``uncertainty.propagate``,
        between their normal scores.
    threads : int, optional
        At most two are of use, each for four islands. The model must then be safe to call from
        several threads.
    progress : function or bool, optional
        Called with the samples done and their total; True shows a bar. An interrupt returns the
        islands finished by then.

    Returns
    -------
    Posterior
        Mean, spread, intervals and joint samples of the unknowns; predicted outputs;
        ``probability`` of any condition; the logarithm of the evidence with its error.

    Raises
    ------
    InputError
        An argument that cannot be used, or a model (code "bad_model") that does not answer case by
        case; or a finer model with other outputs (code "different_outputs").
    NoSolutionError
        The model refuses everywhere (code "refused"); or no sample meets the sharp bounds that were
        observed, or the errors are too small for any to fit (code "contradictory"); or the finer
        model has no answer at the posterior of ``model``, or is so far from it that the way there
        was not found (code "too_far").

    Warns
    -----
    CollisionsWarning
        The evidence contradicts itself or the priors: a misfit this large has a probability below
        0.01.
    OutOfRangeWarning
        An unknown or an output looks like an angle that jumps, or has directions to all sides, so
        that its mean means nothing, or little; or an output that is not observed has no value at
        some samples, and its figures are of the others (code "failed_cases").
    IllConditionedWarning
        The evidence says nothing about an unknown with a uniform prior; or the islands disagree, or
        the sample collapsed; or more than 1 % of the samples lie where only the finer model has an
        answer.

    What this library warned of while the model worked is counted over the samples. Of fewer than
    0.5 percent of them (95 percent where it is that readings differ) it is not raised and stands in
    ``statements`` alone. Other warnings that the model gives go where warnings go, and are counted
    nowhere.

    Examples
    --------
    A speed known to lie around 20 m/s, read twice. All are normal, so the answer is the weighted
    mean: weights 1/4, 1 and 1.

    >>> from collisions.reconstruct import posterior
    >>> from collisions.uncertainty import Normal
    >>> readings = {"video": (22.0, 1.0), "marks": (21.0, 1.0)}
    >>> model = lambda speed: {"video": speed, "marks": speed}
    >>> found = posterior(model, {"speed": Normal(20.0, 2.0)}, readings, seed=1)
    >>> round(found["speed"].mean, 1), round((0.25 * 20 + 22 + 21) / 2.25, 1)
    (21.3, 21.3)

    The standard deviation is 2/3, so 20 m/s is two of them below the mean, and the share above it
    is 0.97725.

    >>> probability, error = found.probability(lambda at: at["speed"] > 20.0)
    >>> abs(probability - 0.97725) < 3.0 * error < 0.01
    True

    A model that costs more, by which the video reads 3 % more, is called for a small part only.

    >>> dearer = lambda speed: {"video": 1.03 * speed, "marks": speed}
    >>> known = {"speed": Normal(20.0, 2.0)}
    >>> found = posterior(model, known, readings, finer=dearer, seed=1)
    >>> exact = (0.25 * 20 + 1.03 * 22 + 21) / (0.25 + 1.03**2 + 1)
    >>> abs(found["speed"].mean - exact) < 3.0 * found["speed"].mean_standard_error < 0.1
    True
    >>> found.calls["finer"] < 0.25 * found.calls["model"]
    True
    """
    # None is a choice of ``propagate`` alone.
    drawn = math.nan if samples is None else samples
    check_options("monte_carlo", drawn, None, seed, threads, progress, _LEAST_SAMPLES)
    called, priors, rows = read_evidence(
        model, unknowns, observed, "`Normal('50 km/h', '10 km/h')`", _prior, read_reading
    )
    seen, joint = [row.name for row in rows], Joint(priors, correlation)
    seed = int(seed) if seed is not None else secrets.randbits(64)
    given = int(samples), seed, int(threads), progress
    if tolerance is None:
        problem = _Problem(called, joint, rows)
        if finer is not None:
            problem.finer = FinerModel(function_of(finer, priors, seen, "observed"), {})
            problem.finer.check_inputs(priors, "unknowns", "bad_model")
        return replace(problem.answered_by(*given), _scene=scene_among(finer, model))
    if finer is not None:
        raise InputError(
            "give `finer=` or `tolerance=`, which takes a level of the scene and a coarser one "
            "below it, not both",
            code="bad_combination",
            argument="tolerance",
        )
    chosen = at_level(model, priors, rows, tolerance)
    whole = function_of(chosen.model, priors, seen, "observed")
    if chosen.below is not None:
        problem = _Problem(Model(chosen.below, {}), joint, rows, chosen.notes)
        problem.finer = FinerModel(whole, {})
        try:
            return replace(problem.answered_by(*given), _scene=model)
        except NoSolutionError as error:
            if error.code != "too_far":
                raise
    found = _Problem(Model(whole, {}), joint, rows, chosen.notes).answered_by(*given)
    return replace(found, _scene=model)


def _prior(label: str, given: Any) -> Distribution:
    if isinstance(given, Distribution):
        return given
    raise InputError(
        f"{as_code(label)} is of type {type_of(given)}; give a distribution of what was "
        "known before: Normal, or `Uniform(low, high)` where any value between two is "
        "as likely, which an Interval does not say. What is known exactly is written "
        f"into the model{range_hint(given)}",
        code="bad_prior",
    )


class _Problem:
    """The model, the priors and the observations, as a likelihood of normal scores."""

    def __init__(
        self, model: Model, joint: Joint, rows: list[Observation], notes: tuple[Note, ...] = ()
    ) -> None:
        self.model, self.joint, self.rows, self.notes = model, joint, rows, notes
        self.finer: FinerModel | None = None
        taken = units_taken(model)
        self.units = {
            name: prior.unit or taken.get(name, "") for name, prior in joint.inputs.items()
        }
        # The width by which observations with sharp bounds are softened on the way, by name.
        self.softened: dict[str, float] = {}
        self.answered = self.possible = False

    def answered_by(self, samples: int, seed: int, threads: int, progress: Any) -> Posterior:
        """The posterior by so many samples."""
        # A point at which numbers overflow counts as refused.
        with np.errstate(all="ignore"):
            if self.finer is not None:
                self.compare_models(self.finer, seed)
            islands = list(self.islands(-(-samples // ISLANDS), seed, threads, reporter(progress)))
            found = self.result(islands, samples, seed)
        warn_of(notes_of(found))
        return found

    def computed(
        self, model: Model, scores: Any, check: bool
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """The unknowns at these scores (cases, dimensions), and the outputs of the model."""
        values = self.joint.scored(scores.T)
        return values, model(values, len(scores), check)

    def compare_models(self, finer: FinerModel, seed: int) -> None:
        """Ask both models about the same few points of the priors: their outputs must be the same,
        and by how much they differ tells how far sharp bounds are softened.
        """
        random = np.random.Generator(
            np.random.PCG64DXSM(np.random.SeedSequence(seed, spawn_key=(4,)))
        )
        scores = random.standard_normal((_COMPARED, self.joint.dimensions))
        answers = [self.computed(model, scores, True)[1] for model in (self.model, finer)]
        finer.check_outputs(self.model)
        for columns in zip(*map(self.columns, answers), strict=True):
            (row, one, angle), (_, other, _) = columns
            if not row.reading.sigma:
                apart = folded(other - one, math.pi if angle else None)
                size, spread = (
                    float(np.sqrt(np.mean(part[np.isfinite(part)] ** 2)))
                    if np.any(np.isfinite(part))
                    else 0.0
                    for part in (apart, one)
                )
                self.softened[row.name] = max(size, _LEAST_SOFTENED * spread) or 1.0

    def columns(self, answers: Mapping[str, Any]) -> Iterator[tuple[Observation, Any, bool]]:
        """Each observation, what the model computes of it, and whether it is an angle."""
        columns = observed_columns([row.name for row in self.rows], answers)
        for row, column in zip(self.rows, columns, strict=True):
            yield row, column, row.is_angle(self.model.units[row.name])

    def observables(self, model: Model, scores: Any, check: bool) -> Any:
        """What the model computes of each observation (cases, observations)."""
        columns = self.columns(self.computed(model, scores, check)[1])
        return np.stack([column for _, column, _ in columns], axis=1)

    def judged(self, computed: Any) -> tuple[Any, Any]:
        """Log-likelihoods of what was computed, and by how much it misses sharp bounds; infinite
        where the evidence is impossible. With a finer model, sharp bounds are softened.
        """
        likelihood, missed = np.zeros(len(computed)), np.zeros(len(computed))
        for row, column in zip(self.rows, computed.T, strict=True):
            angle = row.is_angle(self.model.units[row.name])
            likelihood += row.reading.log_likelihood(column, angle)
            by = row.reading.missed(column, angle)
            if row.name in self.softened:
                likelihood -= 0.5 * (by / self.softened[row.name]) ** 2
            missed += by
        self.answered |= bool(np.any(~np.any(np.isnan(computed), axis=1)))
        possible = np.isfinite(likelihood) & np.isfinite(missed)
        self.possible |= bool(np.any(possible))
        return np.where(possible, likelihood, -np.inf), np.where(possible, missed, np.inf)

    def apart(self, one: Any, other: Any) -> Any:
        """How far the second of two such is from the first."""
        angles = [row.is_angle(self.model.units[row.name]) for row in self.rows]
        away = [
            folded(column, math.pi if angle else None)
            for column, angle in zip((other - one).T, angles, strict=True)
        ]
        return np.stack(away, axis=1)

    def islands(
        self, count: int, seed: int, threads: int, report: Callable[[int, int], None] | None
    ) -> list[Island]:
        """Islands of so many points; after an interrupt the finished ones, if there are any."""
        found: list[Island] = []

        def tell(part: float = 0.0) -> None:
            if report is not None:
                report(int((len(found) + part * _SIDE_BY_SIDE) * count), ISLANDS * count)

        def work(first: int) -> list[Island]:
            random = np.random.Generator(
                np.random.PCG64DXSM(np.random.SeedSequence(seed, spawn_key=(3, first)))
            )
            shape = (_SIDE_BY_SIDE, count, self.joint.dimensions)
            within = tell if threads == 1 else lambda part: None
            with np.errstate(all="ignore"):
                # Always the first islands check that the model answers case by case.
                def model(scores: Any) -> Any:
                    return self.observables(self.model, scores, not first)

                finer = self.finer
                if finer is None:
                    return Islands(lambda scores: self.judged(model(scores)), shape, random).found(
                        within
                    )
                models = TwoModels(
                    model,
                    lambda scores: self.observables(finer, scores, not first),
                    self.judged,
                    self.apart,
                    np.array([row.reading.sigma or self.softened[row.name] for row in self.rows]),
                )
                return FinerIslands(models, shape, random).found(within)

        try:
            for each in in_order(work, range(0, ISLANDS, _SIDE_BY_SIDE), threads):
                found += each
                tell()
        except KeyboardInterrupt:
            if not found:
                raise
        except UnreachableError as problem:
            raise self._no_solution(problem) from None
        except FinerUnreachableError:
            raise NoSolutionError(
                "the finer model has no answer where model puts the unknowns, or is too far from "
                "it for a way there to be found; run the finer model alone: "
                "posterior(finer, unknowns, observed)",
                code="too_far",
            ) from None
        return found

    def _no_solution(self, problem: UnreachableError) -> NoSolutionError:
        """Why no point of the priors explains what was observed."""
        at = {name: float(prior.quantile(0.5)) for name, prior in self.joint.inputs.items()}
        if math.isinf(problem.missed) and self.possible:
            return NoSolutionError(
                f"the model answers so seldom that none of {problem.draws} points drawn from the "
                "priors was usable; give priors within which the impact happens",
                code="refused",
                points=problem.draws,
            )
        if not self.answered:
            return refused_everywhere(
                self.model,
                problem.draws,
                at,
                self.units,
                "priors within which the impact happens",
            )
        sharp = (
            [row.name for row in self.rows if not row.reading.sigma]
            if math.isfinite(problem.missed)
            else []
        )
        what = (
            "comes near what was observed"
            if problem.missed == 0.0
            else "fits within numbers that a float holds"
        )
        if problem.missed and sharp:
            what = (
                f"meets the bounds observed of {', '.join(sharp)}: the nearest misses them by "
                f"{problem.missed:.3g} (SI)"
            )
        return NoSolutionError(
            f"the evidence contradicts the priors: no point of them {what}. Look for a slipped "
            "digit or a wrong unit, or give wider priors or errors",
            code="contradictory",
        )

    def result(self, islands: list[Island], samples: int, seed: int) -> Posterior:
        """The islands as one sample, each with its share of the evidence."""
        logs = np.array([one.log_evidence for one in islands])
        places = len(islands) * samples // ISLANDS
        ends = np.rint(places * np.cumsum(np.exp(logs - _log_mean(logs))) / len(islands)).astype(
            np.intp
        )
        counts = np.diff(ends, prepend=0)
        labels = np.repeat(np.arange(len(islands)), counts)
        points = [
            one.points[((np.arange(count) + 0.5) * len(one.points) / max(count, 1)).astype(np.intp)]
            for one, count in zip(islands, counts.tolist(), strict=True)
        ]
        scores = np.concatenate(points)
        model = self.finer or self.model
        model.noted.clear()  # of the way to the posterior
        values, answers = self.computed(model, scores, check=False)
        notes = notes_of_samples(model.noted, worked_back=True)
        calls = {"model": sum(one.calls for one in islands)}
        if self.finer is None:
            calls["model"] += len(scores)
        else:
            calls["finer"] = sum(one.finer_calls for one in islands) + len(scores)
            self.model.noted.clear()
            self.computed(self.model, scores, check=False)
            # No figure rests on it: what it warns of is stated only.
            notes += tuple(
                note._replace(warning=None, sentence=f"model, not finer: {note.sentence}")
                for note in notes_of_samples(self.model.noted)
            )
            calls = {name: count + _COMPARED for name, count in calls.items()}
            calls["model"] += len(scores)
        left_out = [_log_mean(np.delete(logs, k)) for k in range(len(logs))]
        squares, residuals = np.sum(scores[:, self.joint.ordered] ** 2, axis=1), {}
        for row, column, angle in self.columns(answers):
            squares += row.reading.misfit(column, angle)
            apart = float(np.mean(row.reading.residual(column, angle)))
            middle = row.reading.middle(column, angle, apart)
            residuals[row.name] = residual_of(row, self.model.units[row.name], middle, apart)
        unknowns = {
            name: PosteriorOutput(name, self.units[name] or None, column, labels)
            for name, column in values.items()
        }
        # A plain number has the unit that it was observed in.
        observed_in = {row.name: row.reading.value.unit for row in self.rows}
        predicted = {
            name: PosteriorOutput(
                name, self.model.units[name] or observed_in.get(name) or None, column, labels
            )
            for name, column in answers.items()
        }
        notes += tuple(bare_angle_notes(self.rows, self.model.units))
        notes += *unanswered_notes(predicted), *wrap_notes(wraps_of(predicted | unknowns))
        refused = float(np.mean([one.refused for one in islands]))
        if refused:
            notes = tuple(_ruled_out(note) for note in notes)
        notes += self.notes
        stated = [*self.joint.inputs.items(), *((row.name, row.reading.value) for row in self.rows)]
        notes += *notes_of_inputs(stated), *self.joint.notes
        return Posterior(
            priors=dict(self.joint.inputs),
            observed={row.name: row.reading.value for row in self.rows},
            draws=read_only(answers | values),
            unknowns=unknowns,
            predicted=predicted,
            residuals=residuals,
            log_evidence=_log_mean(logs),
            log_evidence_error=math.sqrt(float(np.var(left_out)) * (len(logs) - 1)),
            p_value=chi_squared_tail(
                float(np.min(squares)) - _best_above_least(len(self.joint.inputs), len(scores)),
                # Sharp bounds alone hold as many unknowns as there are at most.
                sum(row.reading.sigma > 0.0 for row in self.rows)
                or min(len(self.rows), len(self.joint.inputs)),
            ),
            refused=refused,
            moved=min(one.moved for one in islands),
            samples=len(scores),
            seed=seed,
            interrupted=len(islands) < ISLANDS,
            calls=calls,
            beyond=float(np.mean([one.beyond for one in islands])),
            model_notes=notes,
        )


def _ruled_out(note: Note) -> Note:
    """A note, as a warning if it says that evidence rules out what comes in another order."""
    return note._replace(warning=CollisionsWarning) if note.code == ONE_ORDER else note


def _best_above_least(unknowns: int, samples: int) -> float:
    """How far the chi-squared of the best sample lies above the least there is, in the median.

    Around the least it grows as the sum of as many squares of normal numbers as there are unknowns:
    of seventeen the best of 1,024 samples is 4 above it.
    """
    chance = 0.5 ** (1.0 / samples)
    low, high = 0.0, 2.0 * unknowns
    for _ in range(50):
        middle = 0.5 * (low + high)
        if chi_squared_tail(middle, unknowns) > chance:
            low = middle
        else:
            high = middle
    return low


def _log_mean(logs: Any) -> float:
    """Logarithm of the mean of numbers given by their logarithms."""
    most = float(np.max(logs))
    return most + math.log(float(np.mean(np.exp(logs - most))))

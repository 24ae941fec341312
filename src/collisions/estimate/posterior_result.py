"""``Posterior``: how probable each value of the unknowns is given the evidence, as joint samples;
and the evidence itself.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass, field, replace
from typing import Any

import numpy as np

from ..messages.errors import CollisionsWarning, IllConditionedWarning, InputError
from ..messages.warning import Note, warn_of
from ..quantities.attributes import read_only
from ..quantities.formatting import KIND_OF, typeset
from ..quantities.strict_json import strict
from ..quantities.tables import Cells, Part, Summarized, Summary, as_sentence
from ..quantities.units import rendered, shown
from ..uncertainty.distribution import found_by, notes_of_inputs, stated_in
from ..uncertainty.distributions import Censored, Distribution, Normal, Samples, Uniform
from ..uncertainty.normal import power_of_two
from ..uncertainty.output import Shares, bare_notes, outputs_part
from ..uncertainty.output_notes import unanswered_notes, wrap_notes, wraps_of
from ..uncertainty.probability import holds
from ..uncertainty.result import units_of
from ..uncertainty.sampled import Sampled, correlations
from .fit_result import CONTRADICTION, Residual, SpeedsFound, agreement, with_unit
from .worked_out import in_words, stated, worked_out

_NO_NARROWER, _NOT_MOVED = 0.1, 0.25  # of the variance of a prior, and of its deviation
# Of distribution functions: a mean moved so far makes half of it, and the draws of an ordinary
# number of samples a quarter.
_OTHER_SHAPE = 0.2
_PLACES = 1024  # in a prior, with equal shares of its probability
_ROUGH = 0.1  # of a standard deviation: the error of a mean
_ROUGH_EVIDENCE = 0.5  # of its logarithm
_FEW_MOVED = 0.5  # of the points
_FEW_ROWS = 100  # their mean is off by a tenth of its standard deviation
_MOSTLY_REFUSED = 0.05  # of the prior
_MOST_BEYOND = 0.01  # of the samples


class PosteriorOutput(Sampled):
    """One unknown, or one output of the model, given the evidence and the priors; otherwise like an
    output of ``propagate``.

    ``values`` are the samples, equally likely. Standard errors are those of sampling, by the
    jackknife over the islands; NaN where one island has all the samples.
    """

    given = "the evidence and the priors"

    def __init__(self, name: str, unit: str | None, values: Any, islands: Any) -> None:
        super().__init__(name, unit, values, dict)
        self._islands = islands

    def record(self) -> dict[str, Any]:
        """The figures as plain values that strict JSON can hold.

        Returns
        -------
        dict
            Plain values that ``json.dumps`` writes; infinity and NaN as texts.
        """
        found: dict[str, Any] = strict(self._basics())
        return found

    def _shares(self) -> Shares:
        raise InputError(
            f"{self.name!r} has no contributions: given the evidence the unknowns depend on one "
            "another, see the correlation",
            code="no_shares",
            argument="name",
        )

    def _like(self, name: str, values: Any) -> Sampled:
        return PosteriorOutput(name, None, values, self._islands)

    def _error(self, figure: Callable[[Any], Any]) -> Any:
        known = ~np.isnan(self.values)
        islands, values = self._islands[known], self.values[known]
        labels = np.unique(islands)
        if len(labels) < 2:
            return figure(np.zeros(2)) * math.nan
        found = [figure(values[islands != label]) for label in labels]
        scale = power_of_two(found)
        error = scale * np.sqrt(np.var(np.divide(found, scale), axis=0) * (len(labels) - 1))
        return error if np.ndim(error) else float(error)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Posterior(SpeedsFound, Summarized):
    """The result of ``posterior``: ``posterior["speed_a"]`` has mean, std, interval, quantile and
    histogram of an unknown.

    Attributes
    ----------
    priors : dict
        The prior stated for each unknown.
    observed : dict
        What was observed, as read: ``Normal`` or ``Censored``. ``source`` of each is what its value
        was worked out from, such as the dents measured by ``crush_energy``; "" where that is not
        known.
    draws : dict
        Joint samples, equally likely [SI]: of each unknown, and of each output of the model whose
        name is not that of an unknown.
    unknowns, predicted : dict of PosteriorOutput
        The unknowns, and the outputs the model computes from them; compare ``predicted`` with what
        was observed.
    residuals : dict of Residual
        By observation, observed less computed as the mean over the samples, also in units of the
        stated error.
    log_evidence, log_evidence_error : float
        Logarithm of the probability (for values, the density in SI) of all observations given model
        and priors, and its standard error from sampling. It has a meaning only beside that of
        another account of the same observations.
    p_value : float
        Chance of a misfit as large as the least or larger, counting also how far each unknown is
        from the middle of its prior, by as many normal errors as there are observations; sharp
        bounds count where no observation has an error. The least is that of the best sample without
        what the best of so many samples is above it.
    refused : float
        Share of the prior for which the model has no answer, which rules it out. With a finer model
        it is that of the other one, and points there were tried too.
    moved : float
        Share of the samples that the last steps of the sampling moved, in the island where it is
        smallest.
    samples : int
        How many samples there are.
    seed : int
        The seed that reproduces the result to the bit, for any number of threads.
    interrupted : bool
        Whether it was stopped early; the figures are those of the finished islands.
    calls : dict
        How many cases were asked of each model: "model", and "finer" if one was given, of which
        the figures then are.
    beyond : float
        With a finer model, the share of the samples that lie where the other model has no answer.
    model_notes : tuple
        The warnings of this library while the model worked at the samples, each with the number and
        share of those it is of; ``statements`` has them, those that were too few to raise too.
    results : dict of PosteriorOutput
        What ``with_result`` worked out from the samples.
    results_from : dict of dict
        By result, what it was worked out by and from, as texts.
    """

    priors: dict[str, Distribution]
    observed: dict[str, Normal | Censored]
    draws: dict[str, Any]
    unknowns: dict[str, PosteriorOutput]
    predicted: dict[str, PosteriorOutput]
    residuals: dict[str, Residual]
    log_evidence: float
    log_evidence_error: float
    p_value: float
    refused: float
    moved: float
    samples: int
    seed: int
    interrupted: bool
    calls: dict[str, int] = field(default_factory=dict)
    beyond: float = 0.0
    model_notes: tuple[Note, ...] = ()
    results: dict[str, PosteriorOutput] = field(default_factory=dict)
    results_from: dict[str, dict[str, str]] = field(default_factory=dict)
    # The scene that it is of, where the model was one.
    _scene: Any = None

    @property
    def _outputs(self) -> dict[str, PosteriorOutput]:
        return self.predicted | self.results | self.unknowns

    def __getitem__(self, name: str) -> PosteriorOutput:
        outputs = self._outputs
        if not isinstance(name, str) or name not in outputs:
            worked = f"; worked out were {', '.join(self.results)}" if self.results else ""
            raise InputError(
                f"{shown(name)} is none of the unknowns, which are {', '.join(self.unknowns)}, "
                f"nor of the outputs of the model, which are {', '.join(self.predicted)}{worked}",
                code="unknown_name",
                argument="name",
            )
        return outputs[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.unknowns)

    def __len__(self) -> int:
        return len(self.unknowns)

    def probability(self, condition: Callable[[Mapping[str, Any]], Any]) -> tuple[float, float]:
        """The probability that a condition holds, given the evidence and the priors, and its
        standard error from sampling.

        Parameters
        ----------
        condition : function
            Called with a dict of arrays [SI], one number per sample: the unknowns and the outputs
            of the model by name. Returns one boolean per sample. Samples without an answer to an
            output that it reads are left out.

        Returns
        -------
        probability, standard_error : float
            Between 0 and 1. If the condition holds in no sample or in every one, the error is 1
            over the number of samples; an answer far from all others that got no sample is not in
            it. It is NaN where one island has all the samples, of which
            ``posterior`` warns.

        Raises
        ------
        InputError
            A condition that does not return a boolean for every sample.
        NoSolutionError
            No sample has an answer to all outputs that the condition reads.
        """
        held = holds(condition, self.draws)
        return next(iter(self.unknowns.values()))._share(held)

    def with_result(
        self, name: str, function: Callable[..., Any], unit: str | None = None, /, **arguments: Any
    ) -> Posterior:
        """The same posterior with one more result: what follows from the unknowns, and from what
        the evidence does not tell.

        The result has a range as the unknowns have, ``found[name]`` gives it, and ``report`` says
        it in the answer, with what it was worked out from.

        Parameters
        ----------
        name : str
            What the result is called.
        function : function
            Called with the arguments, as arrays of one number per sample [SI] where they vary;
            returns one number per sample, such as ``travel.q.speed``.
        unit : str, optional
            Given by its place, as the first two: SI unit of the plain numbers that the function
            returns, such as "m/s", whatever units the report is in; without it such a result has
            none. A function that returns Quantities, as ``travel.q.speed`` does, needs none.
        **arguments
            By argument of the function: an unknown, an output or a result of this posterior, as
            ``found["speed_a"]``; a distribution of ``uncertainty``, which is drawn for each sample
            apart from all else; or a value, passed on as it is. Two results share no draws.

        Returns
        -------
        Posterior
            With ``results[name]``; this one stays as it is.

        Raises
        ------
        InputError
            A name that is taken, an argument that is an ``Interval`` or of another posterior, or a
            function that does not answer case by case.
        UnitsError
            A unit that is not SI, or another one than that of what the function returns.
        NoSolutionError
            The function has an answer at none of the samples (code "refused").

        Warns
        -----
        OutOfRangeWarning
            The function has no answer at some of the samples, and the figures are of the others
            (code "failed_cases").

        Examples
        --------
        A car left 12 m of skid marks before an impact at which it was still going some 10 m/s. With
        a drag of 0.7 the skid took 2 * 0.7 * 9.80665 * 12 from the square of its speed.

        >>> from collisions import travel
        >>> from collisions.reconstruct import posterior
        >>> from collisions.uncertainty import Normal, Uniform
        >>> found = posterior(
        ...     lambda speed: {"video": speed},
        ...     {"speed": Uniform("0 m/s", "40 m/s")},
        ...     {"video": ("10 m/s", "0.1 m/s")},
        ...     seed=1,
        ... )
        >>> found = found.with_result(
        ...     "speed before the skid",
        ...     travel.q.speed,
        ...     distance="12 m",
        ...     drag=Normal(0.7, 0.01),
        ...     end_speed=found["speed"],
        ... )
        >>> exact = (10**2 + 2 * 0.7 * 9.80665 * 12) ** 0.5
        >>> abs(found["speed before the skid"].mean - exact) < 0.01
        True
        """
        source = np.random.SeedSequence(self.seed, spawn_key=(5, len(self.results)))
        values, own, notes = worked_out(name, function, unit, arguments, self._outputs, source)
        islands = next(iter(self.unknowns.values()))._islands
        output = PosteriorOutput(name, own, values, islands)
        if output.failed:
            # That samples have no answer is raised once.
            notes = tuple(
                note._replace(warning=None) if note.code == "refused_cases" else note
                for note in notes
            )
        # The model may warn of the same: each statement says what it is of.
        notes = tuple(note._replace(sentence=f"{name}: {note.sentence}") for note in notes)
        notes += *unanswered_notes({name: output}), *wrap_notes(wraps_of({name: output}))
        known = {note.sentence for note in notes_of(self)}
        notes += tuple(
            note for note in notes_of_inputs(arguments.items()) if note.sentence not in known
        )
        warn_of(notes)
        return replace(
            self,
            draws=read_only(self.draws | {name: values}),
            results=self.results | {name: output},
            results_from=self.results_from | {name: stated(function, arguments)},
            model_notes=self.model_notes + notes,
        )

    def inputs(self) -> dict[str, Samples]:
        """The joint samples of the unknowns, as ``uncertainty.propagate`` takes them, or
        ``posterior`` as new priors; what was stated of this posterior goes with them.

        Returns
        -------
        dict of Samples
            By unknown.
        """
        joint = Samples.joint(
            **{name: with_unit(self.draws[name], one.unit) for name, one in self.unknowns.items()}
        )
        return found_by("a posterior", joint, notes_of(self))

    @property
    def found(self) -> tuple[str, ...]:
        """Names of what was found, as opposed to what was observed: the unknowns."""
        return tuple(self.unknowns)

    def _speed(self, name: str) -> float | None:
        output = self._outputs.get(name)
        known = output is not None and output.unit in (None, "", "m/s")
        return float(output.mean) if output is not None and known else None

    @property
    def correlation(self) -> dict[tuple[str, str], float]:
        """Correlations by pair of unknowns; NaN where one of them does not vary."""
        return correlations(self.unknowns)

    @property
    def shrinkage(self) -> dict[str, float]:
        """Share of the prior's variance that the evidence removed, by unknown: 1 if it tells all,
        0 if nothing.
        """
        return {
            name: 1.0 - (float(one.std) / self.priors[name].sd) ** 2
            for name, one in self.unknowns.items()
        }

    @property
    def prior_only(self) -> tuple[str, ...]:
        """The unknowns about which the evidence says next to nothing: their figures are those of
        the prior.
        """
        return tuple(
            name
            for name, share in self.shrinkage.items()
            if abs(share) < _NO_NARROWER
            and abs(self.unknowns[name].mean - self.priors[name].mean)
            < _NOT_MOVED * self.priors[name].sd
            and _apart(self.draws[name], self.priors[name]) < _OTHER_SHAPE
        )

    @property
    def consistent(self) -> bool:
        """Whether a misfit this large has a probability of 0.01 or more."""
        return self.p_value >= CONTRADICTION

    @property
    def statements(self) -> tuple[str, ...]:
        """The statements that belong with the numbers, as sentences."""
        return tuple(note.statement for note in notes_of(self))

    def to_dict(self) -> dict[str, Any]:
        """All figures as strict JSON; the samples themselves are left out.

        Returns
        -------
        dict
            Plain values that ``json.dumps`` writes; infinity and NaN as texts.
        """
        record = {
            "priors": {name: rendered(one, 1000) for name, one in self.priors.items()},
            "observed": {name: rendered(one, 1000) for name, one in self.observed.items()},
            "observed_from": self._sources(),
            "unknowns": {name: one.record() for name, one in self.unknowns.items()},
            "predicted": {name: one.record() for name, one in self.predicted.items()},
            "results": {name: one.record() for name, one in self.results.items()},
            "results_from": self.results_from,
            "residuals": {name: asdict(one) for name, one in self.residuals.items()},
            "correlation": [[*pair, value] for pair, value in self.correlation.items()],
            "statements": list(self.statements),
        }
        plain = (
            "log_evidence",
            "log_evidence_error",
            "p_value",
            "refused",
            "samples",
            "seed",
            "interrupted",
            "calls",
            "beyond",
        )
        written: dict[str, Any] = strict(record | {name: getattr(self, name) for name in plain})
        return written

    def _summary(self, numbers: Cells) -> Summary:
        kinds = {name: KIND_OF.get(one.unit or "", "") for name, one in self.predicted.items()}
        observed = [
            (
                name,
                stated_in(one, numbers, kinds[name]) if kinds[name] else str(one),
                f"{self.residuals[name].over_sigma:+.2f}",
            )
            for name, one in self.observed.items()
        ]
        known = {name: KIND_OF.get(one.unit or "", "") for name, one in self.unknowns.items()}
        priors = [
            (name, stated_in(one, numbers, known[name]) if known[name] else str(one))
            for name, one in self.priors.items()
        ]
        worked: list[Part] = []
        readings: list[Part] = []
        if sources := self._sources():
            rows = [(name, typeset(text)) for name, text in sources.items()]
            readings = [Part(rows, "What readings were worked out from")]
        if self.results:
            worked = [
                outputs_part(self.results, numbers, "Worked out from them"),
                Part(
                    [(name, in_words(texts)) for name, texts in self.results_from.items()],
                    "How it was worked out",
                ),
            ]
        parts = [
            outputs_part(self.unknowns, numbers, "Unknown"),
            *worked,
            outputs_part(self.predicted, numbers, "Predicted"),
            Part(observed, "Observed", ("as stated", "residual over sigma")),
            *readings,
            Part(priors, "Priors"),
            Part([("log evidence", f"{self.log_evidence:.4g} ± {self.log_evidence_error:.2g}")]),
        ]
        unseen = {k: one for k, one in self.predicted.items() if k not in self.observed}
        bare = bare_notes([*unseen.values(), *self.results.values()])
        notes = [*map(as_sentence, self.statements), *bare]
        return Summary(f"Given the evidence and the priors ({self.samples} samples)", parts, notes)

    def _sources(self) -> dict[str, str]:
        """What each reading was worked out from, where it says so."""
        return {name: one.source for name, one in self.observed.items() if one.source}

    def _texts(self) -> Iterator[str]:
        return units_of(self.observed | self.priors)


def _apart(draws: Any, prior: Distribution) -> float:
    """The largest difference of the distribution functions of draws and of their prior, as Smirnov
    has it: evidence may leave mean and variance as they were and exclude what lies between.
    """
    of_prior = np.sort(prior.quantile((np.arange(_PLACES) + 0.5) / _PLACES))
    drawn = np.sort(draws)
    places = np.concatenate([of_prior, drawn])
    one, other = (
        np.searchsorted(values, places, side="right") / values.size for values in (drawn, of_prior)
    )
    return float(np.max(np.abs(one - other)))


def _few_rows(found: Posterior) -> Iterator[Note]:
    """That the evidence leaves few rows of samples that are a prior: all draws are among these, so
    that their spread and their errors are those of so many.
    """
    groups: dict[Any, list[str]] = {}
    for name, prior in found.priors.items():
        # A few values by themselves are all that the quantity can be.
        if isinstance(prior, Samples) and (prior.group is not None or prior.rows.size >= _FEW_ROWS):
            groups.setdefault(name if prior.group is None else prior.group, []).append(name)
    for names in groups.values():
        prior = found.priors[names[0]]
        assert isinstance(prior, Samples)
        draws = found.draws[names[0]]
        _, counts = np.unique(draws, return_counts=True)
        # So many draws of equal weight have as large an error of their mean.
        rows = draws.size**2 / float(np.sum(np.square(counts, dtype=np.float64)))
        if rows < min(_FEW_ROWS, 0.5 * prior.rows.size):
            yield Note(
                IllConditionedWarning,
                f"of the {prior.rows.size} samples that are the prior of {', '.join(names)} the "
                f"evidence leaves about {rows:.0f}, of which all draws are copies: ranges and "
                "means are as rough as those of so few draws, and the standard errors do not show "
                "it",
                "; give all readings to one posterior, or take more samples where those of the "
                "prior come from",
                "few_rows",
            )


def notes_of(found: Posterior) -> Iterator[Note]:
    """The notes on a posterior in the order of importance: first whether the evidence agrees."""
    apart = {}
    for name, one in found.unknowns.items():
        prior = found.priors[name]
        with np.errstate(all="ignore"):
            off = float(np.float64(one.mean - prior.mean) / prior.sd)
        if math.isfinite(off):
            apart[f"the prior of {name}"] = off
    yield agreement(found.p_value, found.residuals, apart=apart)
    for name in found.prior_only:
        sentence = (
            f"the evidence says next to nothing of {name}: what is given of it rests on its "
            f"prior, {found.priors[name]}"
        )
        if isinstance(found.priors[name], Uniform):
            yield Note(
                IllConditionedWarning,
                sentence,
                "; give an observation that says more, or a prior",
                "undetermined",
            )
        else:
            yield Note(None, sentence)
    rough = [
        name
        for name, one in found.unknowns.items()
        if not one.mean_standard_error <= _ROUGH * one.std
    ]
    if rough or not found.log_evidence_error <= _ROUGH_EVIDENCE:
        what = ", ".join([f"the mean of {name}" for name in rough] or ["the evidence"])
        yield Note(
            IllConditionedWarning,
            f"the islands disagree on {what} by more than a tenth of its standard deviation, or "
            f"on the evidence by {found.log_evidence_error:.2g} in its logarithm",
            "; give more samples, or closer priors",
            "islands_disagree",
        )
    yield from _few_rows(found)
    if found.moved < _FEW_MOVED:
        yield Note(
            IllConditionedWarning,
            f"the sample collapsed: {1.0 - found.moved:.0%} of the samples could not be moved, "
            "so that many are the same",
            "; give more samples. A prior of few Samples, or a model that is nearly a jump, does "
            "this",
            "collapsed",
        )
    if found.refused > _MOSTLY_REFUSED:
        there = (
            "such as where no impact happens: those values are ruled out, and the answer is of "
            "the others"
        )
        if "finer" in found.calls:
            there = "where a few points were tried with the finer model"
        yield Note(
            None,
            f"the model has no answer for {found.refused:.0%} of the prior, {there}",
        )
    if "finer" in found.calls:
        cheap, dear = (found.calls[name] / max(found.samples, 1) for name in ("model", "finer"))
        yield Note(
            None,
            f"the figures are those of the finer model, called {dear:.3g} times a sample, wherever "
            f"the other model leads, called {cheap:.3g} times: values that fit under the finer one "
            "alone, far from all that fit under the other, are not looked for",
        )
    if found.beyond > _MOST_BEYOND:
        yield Note(
            IllConditionedWarning,
            f"{found.beyond:.0%} of the samples lie where only the finer model has an answer, to "
            "which the other one did not lead: the evidence may be too low, and errors too small",
            "; run the finer model alone: posterior(finer, unknowns, observed)",
            "beyond_model",
        )
    if found.interrupted:
        sentence = f"interrupted; the figures are those of {found.samples} samples"
        yield Note(CollisionsWarning, sentence, code="interrupted")
    yield from found.model_notes

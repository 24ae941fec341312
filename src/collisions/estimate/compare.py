"""``compare``: which account of a crash the evidence speaks for, and how much, from the posterior
of each.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import permutations
from typing import Any

from ..messages.errors import CollisionsWarning, InputError
from ..messages.hints import hinted
from ..messages.shares import chance
from ..messages.warning import AGREES, Note, warn_of
from ..quantities.reading import ArgumentReader
from ..quantities.refusals import must_be
from ..quantities.strict_json import strict
from ..quantities.tables import Cells, Part, Summarized, Summary, as_sentence
from ..quantities.units import shown
from .posterior_result import Posterior, notes_of

_SUM_TOL = 1e-9  # of probabilities that were stated
_FIGURES = 3  # of probabilities
_MOST = math.log(1e6)  # beyond it a factor is a matter of the tails of errors that nobody knows


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Comparison(Summarized):
    """The result of ``compare``: how probable each account is given the evidence, and the Bayes
    factors between them.

    Attributes
    ----------
    probability, probability_error : dict
        By account, its probability given the evidence and its prior probability, and the standard
        error from sampling.
    prior : dict
        By account, its prior probability.
    log_bayes_factors, log_bayes_factor_errors : dict
        By pair of accounts, the logarithm of how many times more probable the evidence is under the
        first than under the second, whatever their prior probabilities; and its standard error from
        sampling.
    priors : dict
        By account, the priors of its unknowns: the factors depend on how wide these are.
    sentence : str
        The result in words, for a report.
    statements : tuple of str
        The warnings of the posteriors, each with its account, and that of the comparison.
    """

    probability: dict[str, float]
    probability_error: dict[str, float]
    prior: dict[str, float]
    log_bayes_factors: dict[tuple[str, str], float]
    log_bayes_factor_errors: dict[tuple[str, str], float]
    priors: dict[str, dict[str, str]]
    sentence: str
    statements: tuple[str, ...] = ()

    def to_dict(self) -> dict[str, Any]:
        """Everything as strict JSON.

        Returns
        -------
        dict
            Plain values that ``json.dumps`` writes; infinity and NaN as texts.
        """
        factors = [
            [*pair, value, self.log_bayes_factor_errors[pair]]
            for pair, value in self.log_bayes_factors.items()
        ]
        plain = ("probability", "probability_error", "prior", "priors", "sentence", "statements")
        written: dict[str, Any] = strict(
            {name: getattr(self, name) for name in plain} | {"log_bayes_factors": factors}
        )
        return written

    def _with_error(self, name: str) -> str:
        """A probability with its error, which stands beside no "more than" or "less than"."""
        text = chance(self.probability[name], _FIGURES)
        return text if " " in text else f"{text} ± {self.probability_error[name]:.1g}"

    def _summary(self, numbers: Cells) -> Summary:
        rows = [
            (name, self._with_error(name), f"{self.prior[name]:.{_FIGURES}g}")
            for name in self.probability
        ]
        stated = [
            (name, "; ".join(f"{key} {prior}" for key, prior in priors.items()))
            for name, priors in self.priors.items()
        ]
        parts = [
            Part(rows, "Account", ("probability", "before the evidence")),
            Part(stated, "Priors"),
        ]
        return Summary(
            "Accounts compared, given the evidence and the priors",
            parts,
            (self.sentence, *map(as_sentence, self.statements)),
        )


@hinted
def compare(
    posteriors: Mapping[str, Posterior], prior: Mapping[str, float] | None = None
) -> Comparison:
    """Which of several accounts of a crash the evidence favours: Bayes factors and probabilities.

    The evidence of each account is how probable its model and its priors made what was observed.
    The ratio of two is the Bayes factor, or likelihood ratio: what the evidence is worth, whatever
    was thought before. An account with wide priors spreads its predictions thinly and loses by it;
    so the priors belong to the result and are printed with it. A question within one model, such as
    on which side of a line the contact was, is for ``Posterior.probability``. See R. E. Kass and A.
    E. Raftery, "Bayes factors", Journal of the American Statistical Association 90 (1995) 773-795.
    How often such probabilities come true was measured by simulation, as for the intervals of
    ``posterior``: ``python benchmarks/posterior.py``.

    Parameters
    ----------
    posteriors : dict of Posterior
        By account, at least two posteriors from the same observations.
    prior : dict, optional
        By account, its probability before the evidence; these add up to 1. Without it all are
        equal. The Bayes factors do not depend on it.

    Returns
    -------
    Comparison
        Probabilities with errors, logarithms of the Bayes factors, the priors of each account, and
        a sentence.

    Raises
    ------
    InputError
        Posteriors of different observations (code "different_evidence"), or probabilities that do
        not add up to 1.

    Warns
    -----
    CollisionsWarning
        The evidence contradicts every account (code "contradictory"): the best of them need not be
        good.

    Examples
    --------
    A skid of 20 m at a drag factor of 0.7 gives 16.6 m/s +/- 1 m/s. One driver says 50 km/h, the
    other 60, each +/- 3 km/h.

    >>> from collisions.reconstruct import compare, posterior
    >>> from collisions.uncertainty import Normal
    >>> def account(speed):
    ...     said = {"speed": Normal(speed, "3 km/h")}
    ...     return posterior(
    ...         lambda speed: {"marks": speed}, said, {"marks": ("16.6 m/s", "1 m/s")}, seed=1
    ...     )
    >>> found = compare({"50 km/h": account("50 km/h"), "60 km/h": account("60 km/h")})
    >>> round(found.probability["60 km/h"], 2)
    0.9
    >>> print(found.sentence)  # doctest: +ELLIPSIS
    The evidence is 8... times (...) more probable if "60 km/h" is true than if "50 km/h" is. ...
    """
    if (
        not isinstance(posteriors, Mapping)
        or len(posteriors) < 2
        or not all(
            isinstance(name, str) and isinstance(one, Posterior) for name, one in posteriors.items()
        )
    ):
        raise must_be(
            "posteriors",
            "a dict of two or more posteriors by name, such as `{'square': one, '20 deg': other}`",
            posteriors,
            code="bad_type",
        )
    _check_same_evidence(posteriors)
    before = _read_prior(posteriors, prior)
    logs = {name: one.log_evidence for name, one in posteriors.items()}
    errors = {name: one.log_evidence_error for name, one in posteriors.items()}
    joint = {name: logs[name] + math.log(before[name]) for name in logs}
    weights = {name: math.exp(one - max(joint.values())) for name, one in joint.items()}
    after = {name: weight / sum(weights.values()) for name, weight in weights.items()}
    # To first order in the errors of the logarithms.
    moves = {
        name: [after[name] * ((other == name) - after[other]) * errors[other] for other in after]
        for name in after
    }
    pairs = list(permutations(logs, 2))
    notes = []
    if all(one.consistent is False for one in posteriors.values()):
        sentence = (
            "the evidence contradicts every account, the stated errors, or itself: the best of "
            "these accounts need not be good; look at the residuals of each"
        )
        notes.append(Note(CollisionsWarning, sentence, code="contradictory"))
    # Of each account but that its evidence agrees; what several state stands once.
    stated: dict[str, list[str]] = {}
    for name, one in posteriors.items():
        for note in notes_of(one):
            if note.code != AGREES:
                stated.setdefault(note.statement, []).append(name)
    given = [f"{', '.join(names)}: {statement}" for statement, names in stated.items()]
    found = Comparison(
        probability=after,
        probability_error={name: math.hypot(*of_each) for name, of_each in moves.items()},
        prior=before,
        log_bayes_factors={(one, other): logs[one] - logs[other] for one, other in pairs},
        log_bayes_factor_errors={
            (one, other): math.hypot(errors[one], errors[other]) for one, other in pairs
        },
        priors={
            name: {unknown: str(one) for unknown, one in each.priors.items()}
            for name, each in posteriors.items()
        },
        sentence=_sentence(before, after, logs, errors),
        statements=(*given, *(note.statement for note in notes)),
    )
    warn_of(notes)
    return found


def _check_same_evidence(posteriors: Mapping[str, Posterior]) -> None:
    """Refuse posteriors whose observations differ from those of the first."""
    (first, reference), *others = posteriors.items()
    for name, one in others:
        differing = sorted({key for key, _ in reference.observed.items() ^ one.observed.items()})
        if differing:
            raise InputError(
                f"{name!r} and {first!r} were given different observations, of "
                f"{', '.join(differing)}; only accounts of the same evidence can be compared: "
                "give both all that was observed, in the same units",
                code="different_evidence",
                argument="posteriors",
            )


def _read_prior(posteriors: Mapping[str, Posterior], prior: Any) -> dict[str, float]:
    """The prior probabilities, by account."""
    if prior is None:
        return dict.fromkeys(posteriors, 1.0 / len(posteriors))
    if not isinstance(prior, Mapping) or set(prior) != set(posteriors):
        raise _bad_prior(
            f"prior must be a dict with a probability for each of {', '.join(posteriors)}, got "
            f"{shown(prior)}"
        )
    reader = ArgumentReader()
    found = {name: reader.number(prior[name], "", f"prior[{name!r}]") for name in posteriors}
    reader.close()
    if (
        not all(isinstance(one, float) and one > 0.0 for one in found.values())
        or abs(sum(found.values()) - 1.0) > _SUM_TOL
    ):
        raise _bad_prior(
            f"prior must be probabilities above 0 that add up to 1, got {shown(prior)}"
        )
    return found


def _bad_prior(text: str) -> InputError:
    return InputError(text, code="bad_prior", argument="prior")


def _in_figures(value: float) -> str:
    """A number in three figures, without a power of ten up to a million."""
    return f"{float(f'{value:.{_FIGURES}g}'):.7g}"


def _sentence(
    before: Mapping[str, float], after: Mapping[str, float], logs: Mapping[str, float], errors: Any
) -> str:
    """The result in words: the account that the evidence speaks for, against each other one."""
    best, *others = sorted(logs, key=lambda name: -logs[name])
    parts = []
    for other in others:
        factor, error = logs[best] - logs[other], math.hypot(errors[best], errors[other])
        times = "more than a million times"
        if factor < _MOST:
            low, high = (math.exp(factor + 2.0 * side * error) for side in (-1.0, 1.0))
            most, least, greatest = map(_in_figures, (math.exp(factor), low, high))
            times = f"{most} times ({least} to {greatest}, allowing for sampling error)"
        parts.append(f'{times} more probable if "{best}" is true than if "{other}" is')
    stated = _listed(f'{before[name]:.{_FIGURES}g} for "{name}"' for name in before)
    found = _listed(chance(after[name], _FIGURES) for name in before)
    return (
        f"The evidence is {' and '.join(parts)}. Prior probabilities of {stated} become {found}. "
        "This holds for the priors of each account as they are stated; wider or narrower ones "
        "would change these figures."
    )


def _listed(parts: Iterable[str]) -> str:
    *first, last = parts
    return f"{', '.join(first)} and {last}"

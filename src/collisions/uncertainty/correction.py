"""Samples of a model corrected towards a finer one, which was asked about a few hundred of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ..messages.errors import NoSolutionError, OutOfRangeWarning
from ..messages.warning import Calls, Note, notes_of_samples
from . import turns
from .designs import REPLICATES
from .distribution import show
from .finer import FinerModel
from .model import Model
from .one_sided import Answers
from .output import NO_SPREAD, Shares
from .probability import Again
from .sampled import Sampled, average, deviation

_FOLDS = 8
_PER_TERM = 4  # cases for each term of a regression
# Times the scatter, and at most the spread of an output: where a correction may err by more, the
# finer model is asked, but about no larger a share of the cases than this, or than it was before.
_MOST_OFF, _MOST_BEYOND = 10.0, 0.02
# Even a correction that is one number for all cases was learnt of those like them.
_LEAST_POWERS = 1
_FLAT = 1e-9  # directions of the terms that the cases do not determine
_MOST_SCATTER = 1.0 / 3.0  # of the spread of an output
_STAND_INS = 32  # drawings of what is left, of the cases that the finer model was asked
_SEEN = 3  # cases: what is to be expected in so many is in at least one of them, at 95 percent
_MOST_UNLIKE = 0.01  # of the cases: one model answers them, the other does not


class Correction(NamedTuple):
    """How the difference of two models follows from the inputs and the outputs of the first.

    ``by`` are the coefficients by output of all cases and then of all but each fold; ``scatter``
    the standard deviation of what is left in cross-validation, and ``left`` that by case: first
    those at ``places``, of which it was learnt. ``reach`` has the directions of the terms (columns)
    and how far those of the cases learnt from go along each; others may go ``farthest`` times as
    far.
    """

    powers: int
    middles: Any
    sizes: Any
    by: dict[str, Any]
    scatter: dict[str, float]
    left: dict[str, Any]
    places: Any
    reach: tuple[Any, Any]
    farthest: float

    def changes(self, columns: Any) -> dict[str, Any]:
        """What is to be added to each output (1 + folds, cases) at these inputs and outputs."""
        terms = self._terms(columns, self.powers)
        return {name: (terms @ by).T for name, by in self.by.items()}

    def beyond(self, columns: Any) -> Any:
        """Which cases lie so far beyond those learnt from that the regression says nothing of them.

        It errs there by the scatter times the root of the leverage, which is how far a case goes in
        the directions of ``reach``. A case of a regime in which hardly one learnt from is goes far,
        as its outputs hang together with the inputs in another way than those of all others.
        """
        directions, sizes = self.reach
        share = (self._terms(columns, max(self.powers, _LEAST_POWERS)) @ directions) / sizes
        constant = np.isinf(self.sizes)
        apart = abs(columns - self.middles)[:, constant]
        moved = apart > NO_SPREAD * np.maximum(abs(self.middles[constant]), NO_SPREAD)
        return (np.sum(share**2, axis=1) > self.farthest**2) | np.any(moved, axis=1)

    def _terms(self, columns: Any, powers: int) -> Any:
        # An output without an answer says nothing of the others.
        return _terms(np.nan_to_num((columns - self.middles) / self.sizes), powers)


class CorrectedModel(Model):
    """A model with the mean correction, without the scatter that remains."""

    def __init__(self, model: Model, correction: Correction, names: tuple[str, ...]) -> None:
        super().__init__(model.function, model.fixed)
        self.units, self._checked = model.units, True
        self.correction, self.names = correction, names

    def __call__(self, values: Mapping[str, Any], count: int, check: bool = True) -> Answers:
        """The outputs of the cases; NaN for those that the correction says nothing of, which shares
        of variance leave out.
        """
        answers = super().__call__(values, count, check)
        columns = _columns(values, answers, self.names)
        changes, beyond = self.correction.changes(columns), self.correction.beyond(columns)
        by = {name: np.where(beyond, np.nan, one[0]) for name, one in changes.items()}
        return Answers(
            {name: _moved(answers[name], by[name], self.units[name]) for name in answers},
            answers.sides,
        )


class Asked(NamedTuple):
    """The places of the samples of which the finer model's answer was learnt from; of one output
    what the correction leaves of each; and the orders in which that is drawn again.
    """

    places: Any
    left: Any
    orders: Any


class CorrectedOutput(Sampled):
    """A sampled output corrected towards a finer model; its standard errors also count how well the
    correction is known, and what its scatter misses.

    The former by leaving out one eighth of the finer model's cases after another. The latter by
    those cases themselves: what is drawn as scatter does not depend on the inputs, and where that
    which it stands for does, a figure of the cases as corrected differs from that of the finer
    model's own answers. This difference, and how it scatters without one sequence of samples after
    another, are an error. Both are of the same few cases, so the larger counts. What is left and
    does not depend on the inputs cannot be told from this, and makes the errors larger than they
    need be.
    """

    def __init__(
        self,
        name: str,
        unit: str | None,
        values: Any,
        shares: Callable[[], Mapping[str, Shares]],
        changes: Any,
        asked: Asked,
    ) -> None:
        super().__init__(name, unit, values, shares)
        self._changes, self._asked = changes, asked

    def _error(self, figure: Callable[[Any], Any]) -> Any:
        drawn = super()._error(figure)
        known = ~np.isnan(self.values)
        found = np.array([figure(self.values[known] + change[known]) for change in self._changes])
        learnt = np.sqrt(np.var(found, axis=0) * (len(found) - 1))
        # What is left has no mean, so that of the output misses none of it.
        missed = 0.0 if figure is average else self._missed(figure)
        error = np.hypot(drawn, np.maximum(learnt, missed))
        return error if np.ndim(error) else float(error)

    def _missed(self, figure: Callable[[Any], Any]) -> Any:
        """By how much a figure of the cases asked may err where they are corrected as all others
        are.
        """
        if not np.any(self._asked.left):
            return 0.0
        exact, corrected = self.values[self._asked.places], self._as_corrected()

        def missed(cases: Any) -> Any:
            stands = np.mean([figure(row[cases]) for row in corrected], axis=0)
            return figure(exact[cases]) - stands

        # Without one independent sequence of samples after another.
        fold = self._asked.places % REPLICATES
        without = np.array([missed(fold != k) for k in range(REPLICATES)])
        scatter = np.sqrt(np.var(without, axis=0) * (REPLICATES - 1))
        return np.hypot(missed(fold >= 0), scatter)

    def _as_corrected(self) -> Any:
        """The cases asked as they are corrected where they are not asked, once in each order."""
        places, left, orders = self._asked
        found = self.values[places] - left + left[orders]
        if self._directions is None:
            return found
        turn = 2.0 * math.pi
        return found - turn * np.rint((found - self._mean()) / turn)

    def _one_case(self) -> float:
        """The share of one case among those asked: they do not show what the finer model alone does
        more seldom.
        """
        asked = len(self._asked.places)
        return 1.0 / asked if asked else super()._one_case()

    def _share(self, held: Any, again: Again | None = None) -> tuple[float, float]:
        share, drawn = super()._share(held, again)
        places = self._asked.places
        if not len(places) or again is None:
            return share, max(drawn, self._one_case())

        def without(one: Any, k: int) -> Any:
            """All samples as corrected without a fold of the cases asked."""
            return one.values + one._changes[k]

        folds = [np.nanmean(again(partial(without, k=k))) for k in range(_FOLDS)]
        learnt = math.sqrt(float(np.var(folds)) * (_FOLDS - 1))

        def in_order(one: Any, k: int) -> Any:
            """All samples, those asked as they are corrected elsewhere."""
            values = one.values.copy()
            values[places] = one._as_corrected()[k]
            return values

        # The outputs of one case are drawn together, in the same orders.
        stands = [again(partial(in_order, k=k))[places] for k in range(_STAND_INS)]
        apart = held[places] - np.mean(stands, axis=0)
        apart = apart[~np.isnan(apart)]
        missed = math.hypot(float(np.mean(apart)), float(np.std(apart)) / math.sqrt(apart.size))
        return share, math.hypot(drawn, max(learnt, missed, self._one_case()))


class Corrected(NamedTuple):
    """Corrected outputs with what their errors are told by, the notes on them, the scatter by
    output, and how many cases the finer model was asked.
    """

    values: dict[str, Any]
    changes: dict[str, Any]
    asked: dict[str, Asked]
    model: Model
    scatter: dict[str, float]
    calls: int
    notes: tuple[Note, ...]

    def shares(self, foreseen: Callable[[], Mapping[str, Shares]]) -> dict[str, Shares]:
        """Shares of the variance that the correction foresees, as shares of the whole variance."""
        found = {}
        for name, one in foreseen().items():
            column = self.values[name]
            column = turns.counted(column) if self.model.units[name] == "rad" else column
            kept = 1.0 - min(1.0, self.scatter[name] / _spread(column)) ** 2
            found[name] = Shares(
                *({label: kept * share for label, share in part.items()} for part in one)
            )
        return found


def corrected(
    model: Model,
    finer: FinerModel,
    inputs: Mapping[str, Any],
    answers: Mapping[str, Any],
    wanted: int,
    seed: int,
) -> Corrected:
    """The answers of a model at sampled inputs, corrected towards the finer model.

    The first ``wanted`` cases, which any beginning of the samples spreads as evenly as all, are
    asked of the finer model. Its difference from the model is regressed on the inputs and the
    outputs, by as many powers as cross-validation finds best; what is left is drawn again from the
    differences that the regression did not foresee in cases it had not seen.

    Raises
    ------
    NoSolutionError
        The scatter that remains is more than a third of the spread of an output (code
        "too_different"), or the two models answer different cases.
    """
    total = len(next(iter(answers.values())))
    count = min(wanted, total)
    asked = {name: np.array(column[:count]) for name, column in inputs.items()}
    exact = finer(asked, count)
    finer.check_outputs(model)
    first = {name: answers[name][:count] for name in answers}
    unlike = np.any([np.isnan(first[name]) != np.isnan(exact[name]) for name in answers], axis=0)
    share = float(np.mean(unlike))
    if share > _MOST_UNLIKE and count < total:
        raise NoSolutionError(
            f"of {count} cases asked of both, model and finer differ in {np.sum(unlike)} on "
            f"whether there is an answer, so that the others cannot be corrected; {_ALONE}",
            code="too_different",
            cases=int(np.sum(unlike)),
        )
    values = {name: np.array(column) for name, column in answers.items()}
    changes = {name: np.zeros((_FOLDS, total)) for name in answers}
    none: Any = np.zeros(0, dtype=int)
    asked_of = dict.fromkeys(answers, Asked(none, np.zeros(0), none))
    scatter = dict.fromkeys(answers, 0.0)
    # Where all samples were asked of the finer model, its shares of variance are its own too.
    surrogate: Model = finer
    evenly, more = list(finer.noted), 0
    if count < total:
        names = tuple(name for name, column in inputs.items() if np.ptp(column) > 0.0)
        columns = _columns(inputs, answers, names)
        correction = _regressed(model, columns[:count], first, exact)
        least = _check_scatter(model, correction, exact)
        correction = correction._replace(farthest=min(correction.farthest, least))
        # Of a case without an answer there is nothing to correct.
        answered = np.any([~np.isnan(column) for column in answers.values()], axis=0)
        beyond = correction.beyond(columns) & answered
        beyond[:count] = False
        _check_beyond(beyond, count)
        surrogate, scatter = CorrectedModel(model, correction, names), correction.scatter
        # The same case's differences for all outputs, so that these stay together.
        random = np.random.Generator(
            np.random.PCG64DXSM(np.random.SeedSequence(seed, spawn_key=(5,)))
        )
        drawn = random.integers(count, size=total)
        places = correction.places
        orders = np.array([random.permutation(len(places)) for _ in range(_STAND_INS)])
        for name, by in correction.changes(columns).items():
            unit, left = model.units[name], correction.left[name]
            values[name] = _moved(answers[name], by[0] + left[drawn], unit)
            changes[name] = by[1:] - by[0]
            asked_of[name] = Asked(places, left[: len(places)], orders)
        more = int(np.count_nonzero(beyond))
        if more:
            too = finer({name: np.array(column[beyond]) for name, column in inputs.items()}, more)
            missing = [np.isnan(too[name]) != np.isnan(answers[name][beyond]) for name in answers]
            unlike = np.concatenate([unlike, np.any(missing, axis=0)])
        for name in answers:
            if more:
                values[name][beyond] = too[name]
            changes[name][:, beyond | (np.arange(total) < count)] = 0.0
    for name in answers:
        values[name][:count] = exact[name]
    # Those beyond were chosen: what is warned of them is of so many of all.
    noted = evenly, [(total, said) for _, said in finer.noted[len(evenly) :]]
    counts = count, more, total
    notes = tuple(_notes(model, scatter, values, counts, unlike, noted))
    return Corrected(values, changes, asked_of, surrogate, scatter, count + more, notes)


_ALONE = "run the finer model alone: propagate(finer, inputs)"


def _check_beyond(beyond: Any, count: int) -> None:
    """Refuse a correction of which too many cases lie beyond those asked."""
    many = int(np.count_nonzero(beyond))
    if many > max(count, _MOST_BEYOND * len(beyond)):
        raise NoSolutionError(
            f"{many} of {len(beyond)} cases lie so far beyond the {count} that were asked of the "
            "finer model, in a long tail or where contacts slide and hardly one asked did, that "
            f"these do not tell how to correct them; give more `finer_samples=`, or {_ALONE}",
            code="too_different",
            cases=many,
        )


def _columns(inputs: Mapping[str, Any], answers: Mapping[str, Any], names: tuple[str, ...]) -> Any:
    """What the difference is regressed on: the inputs that vary, and the outputs (cases, both)."""
    return np.stack([*(inputs[name] for name in names), *answers.values()], axis=1)


def _regressed(
    model: Model, columns: Any, first: Mapping[str, Any], exact: Mapping[str, Any]
) -> Correction:
    """The regression with the powers that foresee best what it has not seen, of the cases that are
    not each alone in its way: what all others tell of such a one, and it of them, is nothing.
    """
    apart = {}
    for name, column in first.items():
        difference = exact[name] - column
        turning = model.units[name] == "rad" and turns.are_directions(column[~np.isnan(column)])
        apart[name] = turns.folded(difference, math.pi if turning else None)
    answered = np.all(np.isfinite(columns), axis=1) & np.all(
        [np.isfinite(one) for one in apart.values()], axis=0
    )
    if np.count_nonzero(answered) < _FOLDS:
        raise NoSolutionError(
            f"only {np.count_nonzero(answered)} of {len(columns)} cases are answered by both "
            f"models, too few to correct the others by; {_ALONE}",
            code="too_different",
            cases=int(np.count_nonzero(answered)),
        )
    for _ in range(_FOLDS):
        found = _learnt(columns, apart, answered)
        alone = answered.copy()
        alone[answered] = found.beyond(columns[answered])
        if not np.any(alone) or np.count_nonzero(answered & ~alone) < _FOLDS:
            break
        answered = answered & ~alone
    return found._replace(farthest=_MOST_OFF)


def _learnt(columns: Any, apart: Mapping[str, Any], which: Any) -> Correction:
    """The regression on these cases, of what each output differs by."""
    known = columns[which]
    middles, sizes = np.mean(known, axis=0), np.std(known, axis=0)
    sizes = np.where(sizes > NO_SPREAD * np.maximum(abs(middles), NO_SPREAD), sizes, math.inf)
    scaled = np.nan_to_num((known - middles) / sizes)
    targets = np.stack([one[which] for one in apart.values()], axis=1)
    fold = np.arange(len(scaled)) % _FOLDS
    best: tuple[float, int, Any, Any] | None = None
    # In units of the differences themselves, for one choice of powers for all outputs.
    unit = np.max(abs(targets), axis=0)
    unit = np.where(unit > 0.0, unit, 1.0)
    for powers in range(4):
        terms = _terms(scaled, powers)
        if powers and len(terms) < _PER_TERM * terms.shape[1]:
            break
        by, left = [_solved(terms, targets)], np.zeros(targets.shape)
        for k in range(_FOLDS):
            by.append(_solved(terms[fold != k], targets[fold != k]))
            left[fold == k] = targets[fold == k] - terms[fold == k] @ by[-1]
        size = float(np.mean((left / unit) ** 2))
        if best is None or size < best[0]:
            best = size, powers, np.stack(by), left
    assert best is not None
    _, powers, by_all, left = best
    left = left - np.mean(left, axis=0)
    sizes_left = unit * np.sqrt(np.mean((left / unit) ** 2, axis=0))
    # As many as the cases, so that each can be drawn.
    rows = np.arange(len(columns)) % len(known)
    terms = _terms(scaled, max(powers, _LEAST_POWERS))
    _, reach, directions = np.linalg.svd(terms, full_matrices=False)
    return Correction(
        powers,
        middles,
        sizes,
        {name: by_all[:, :, k].T for k, name in enumerate(apart)},
        dict(zip(apart, sizes_left.tolist(), strict=True)),
        {name: left[rows, k] for k, name in enumerate(apart)},
        np.flatnonzero(which),
        (directions.T, np.maximum(reach, _FLAT * reach[0])),
        # Of a case that was learnt from: without it, its leverage h is h / (1 - h).
        _MOST_OFF / math.hypot(1.0, _MOST_OFF),
    )


def _solved(terms: Any, targets: Any) -> Any:
    """Least squares, without directions that nothing determines."""
    return np.linalg.lstsq(terms, targets, rcond=_FLAT)[0]


def _terms(columns: Any, powers: int) -> Any:
    """Terms of a regression (cases, terms): a constant; the columns; their squares; their products
    too.
    """
    parts = [np.ones((len(columns), 1))]
    if powers >= 1:
        parts.append(columns)
    if powers >= 2:
        parts.append(columns**2)
    if powers >= 3:
        one, other = np.triu_indices(columns.shape[1], 1)
        parts.append(columns[:, one] * columns[:, other])
    return np.concatenate(parts, axis=1)


def _moved(values: Any, by: Any, unit: str | None) -> Any:
    """Values with a change; directions stay in half a turn either way."""
    found = values + by
    if unit == "rad" and turns.are_directions(values[~np.isnan(values)]):
        found = turns.folded(found, math.pi)
    return found


def _check_scatter(model: Model, correction: Correction, exact: Mapping[str, Any]) -> float:
    """Refuse a correction that leaves too much; gives how many times as wide as that an output is,
    at the least.
    """
    least = math.inf
    for name, scatter in correction.scatter.items():
        if scatter > 0.0 and np.all(np.isin(exact[name], (0.0, 1.0))):
            raise NoSolutionError(
                f"{name} is either 0 or 1, and the two models differ on it, so that it cannot be "
                f"corrected; return what decides it, or {_ALONE}",
                code="too_different",
                output=name,
            )
        column = exact[name][~np.isnan(exact[name])]
        if model.units[name] == "rad" and turns.are_directions(column):
            column = turns.counted(column)
        spread, size = deviation(column), float(np.max(abs(column), initial=0.0))
        if scatter > _MOST_SCATTER * spread and scatter > NO_SPREAD * size:
            raise NoSolutionError(
                f"{name} of the finer model cannot be foreseen from the inputs and the model: what "
                f"is left has a standard deviation of {show(scatter, model.units[name] or '')}, "
                f"more than a third of its spread, {show(spread, model.units[name] or '')}; "
                f"{_ALONE}",
                code="too_different",
                output=name,
            )
        if scatter > NO_SPREAD * size:
            least = min(least, float(spread) / scatter)
    return least


def _notes(
    model: Model,
    scatter: Mapping[str, float],
    values: Mapping[str, Any],
    counts: tuple[int, int, int],
    unlike: Any,
    noted: tuple[Calls, Calls],
) -> Iterator[Note]:
    """What the correction rests on, and what the finer model warned of: ``noted`` of the cases
    asked, and of those asked besides. ``counts`` are those numbers, and that of all; ``unlike``
    says of each case asked whether only one of the models answers it.
    """
    count, more, total = counts
    besides = f", and {more} more that lie beyond these" if more else ""
    if count == total:
        yield Note(
            None, f"all {total} cases were asked of the finer model, whose answers these are"
        )
    else:
        listed = ", ".join(
            f"{name} {show(size, model.units[name] or '')} "
            f"({100.0 * size / _spread(values[name]):.2g} %)"
            for name, size in scatter.items()
        )
        yield Note(
            None,
            f"corrected towards the finer model, which was asked about {count} of {total} cases"
            f"{besides}: "
            "what the correction does not foresee has, in cross-validation, a standard deviation "
            f"(and share of that of the output) of {listed}; it widens the figures, and as a share "
            "of the variance belongs to no input. Where the finer model has an edge, ends of "
            "ranges beside it may be off by several times as much. What only the finer model does, "
            f"and in fewer than {_SEEN} of {count} cases, may be missed",
        )
    if cases := int(np.count_nonzero(unlike)):
        others = total - count - more
        # Those beyond were chosen, and say nothing of how many others differ.
        as_many = round(others * float(np.mean(unlike[:count])))
        rest = (
            f"; among the other {others}, which are answered where model answers, about {as_many} "
            "will differ as well"
            if as_many
            else ""
        )
        yield Note(
            OutOfRangeWarning,
            f"in {cases} of {count + more} cases asked of both, model and finer differ on whether "
            f"there is an answer{rest}",
            code="finer_differs",
            fields={"cases": cases},
        )
    for whose, calls in zip(("finer", "finer, of those that lie beyond"), noted, strict=True):
        for note in notes_of_samples(calls):
            yield note._replace(sentence=f"{whose}: {note.sentence}")


def _spread(values: Any) -> float:
    """Standard deviation of what has an answer, for a share of it."""
    known = values[~np.isnan(values)]
    return max(deviation(known) if known.size > 1 else 0.0, 1e-300)

"""``required``: which level of a scene the accuracy that is asked for needs, and what each
costs.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from time import process_time
from typing import Any

import numpy as np

from ..kernels.elementwise import POSITIVE_FINITE
from ..messages.errors import CollisionsError, InputError, NoSolutionError
from ..messages.warning import Note, Noted, Said, noted_in_call, notes_of_samples, quietly, warn_of
from ..quantities.reading import ArgumentReader
from ..quantities.settings import in_si
from ..quantities.strict_json import strict
from ..quantities.tables import Cells, Part, Summarized, Summary, as_sentence, given_texts
from ..quantities.units import shown
from ..uncertainty.designs import latin_hypercube
from ..uncertainty.distributions import Distribution
from ..uncertainty.model import compare_units
from ..uncertainty.sampling import Joint
from .levels import Level, levels_of
from .names import units_of
from .results import unit_of_result
from .scene import Scene

DRAWS = 32
SHARE = 0.95
# The 95 % point of 32 draws is known to about a quarter, and is 6 % low.
_MARGIN = 1.35
# How often a single run is timed.
_TIMED = 3


@dataclass(frozen=True, eq=False, repr=False)
class Cost:
    """What a level costs, and how far it is from the finest.

    Attributes
    ----------
    level : Level
        A model like the scene itself.
    seconds : float [s]
        The processor time of one run, on this machine.
    seconds_a_case : float [s]
        That of one of the draws, worked out together; NaN without unknowns.
    differences : dict of float
        By result, in SI, how far it is from that of the finest level in 95 % of the draws, times
        1.35; infinite where it has no answer in more than 5 %. Without unknowns, the difference at
        the stated values.
    within : bool
        Whether all differences are within what was asked for.
    """

    level: Level
    seconds: float
    seconds_a_case: float
    differences: Mapping[str, float]
    within: bool


class Required(Summarized):
    """The answer of ``Scene.required``: its levels with what they cost, from the cheapest to the
    finest.
    """

    def __init__(
        self,
        costs: tuple[Cost, ...],
        tolerances: Mapping[str, float],
        units: Mapping[str, str],
        draws: tuple[int, int],
        notes: Mapping[str, Sequence[Level]],
        texts: tuple[Any, ...],
    ) -> None:
        self.costs, self.tolerances, self.units = costs, tolerances, units
        self.draws, self.answered = draws
        self.notes = tuple(notes)
        self._of_levels = notes
        self._given = texts

    @property
    def level(self) -> Level:
        """The cheapest level that is within the tolerances; the finest where no other is."""
        return next((one.level for one in self.costs if one.within), self.finest)

    @property
    def finest(self) -> Level:
        """The level that the others are measured against."""
        return self.costs[-1].level

    @property
    def statements(self) -> tuple[str, ...]:
        """The statements that belong with the numbers, as sentences."""
        if self.draws:
            how = (
                f"a difference is that from the finest level in {SHARE:.0%} of {self.answered} "
                f"draws, times {_MARGIN:g}"
            )
        else:
            how = (
                "the differences are those at the stated values alone, and may be off by a factor "
                "of 3 over a range of them; give unknowns= for that"
            )
        found = [f"the cheapest level within what was asked for: {self.level.name}", how]
        if self.draws > self.answered:
            count = self.draws - self.answered
            found.append(f"{count} of {self.draws} draws have no answer at the finest level")
        return (*found, *self.notes)

    def _notes_of(self, level: Level) -> tuple[str, ...]:
        """The notes that are of a level or of the finest, against which it is measured."""
        found = {level.name, self.finest.name}
        return tuple(
            note for note, levels in self._of_levels.items() if found & {one.name for one in levels}
        )

    def to_dict(self) -> dict[str, Any]:
        """All figures as strict JSON, in SI.

        Returns
        -------
        dict
        """
        found: dict[str, Any] = strict(
            {
                "level": self.level.name,
                "draws": self.draws,
                "answered": self.answered,
                "tolerances": dict(self.tolerances),
                "units": dict(self.units),
                "levels": [
                    {
                        "contacts": one.level.contacts,
                        "motion": one.level.motion,
                        "seconds": one.seconds,
                        "seconds_a_case": one.seconds_a_case,
                        "differences": dict(one.differences),
                        "within": one.within,
                    }
                    for one in self.costs
                ],
                "statements": list(self.statements),
            }
        )
        return found

    def _summary(self, numbers: Cells) -> Summary:
        rows = [
            (
                one.level.name,
                f"{1e3 * one.seconds:.3g} ms",
                *(numbers.text(one.differences[path], unit) for path, unit in self.units.items()),
                "yes" if one.within else "no",
            )
            for one in self.costs
        ]
        asked = (numbers.text(self.tolerances[path], unit) for path, unit in self.units.items())
        rows.append(("asked for", "", *asked, ""))
        heads = ("time of a run", *self.units, "within")
        return Summary("Levels of the scene", [Part(rows, "Level", heads)], [
            as_sentence(one) for one in self.statements
        ])  # fmt: skip

    def _texts(self) -> Iterable[Any]:
        return self._given


def required(
    scene: Scene, tolerances: Any, unknowns: Any, draws: int, tolerance: float
) -> Required:
    """The levels of a scene, each with its cost and its difference from the finest."""
    if scene.shape is not None:
        raise InputError(
            "required is of one scene; write scene.case(0).required(...) for the first of this "
            "batch, and say by unknowns= what is not known exactly",
            code="bad_shape",
            argument="scene",
        )
    within, units = _read_tolerances(scene, tolerances)
    joint = None if unknowns is None else Joint(_read_unknowns(scene, unknowns), None)
    if not (isinstance(draws, int) and not isinstance(draws, bool) and DRAWS <= draws <= 4096):
        raise InputError(
            f"draws must be a whole number from {DRAWS} to 4096, got {shown(draws)}",
            code="bad_option",
            argument="draws",
        )
    # From here on all numbers are the package's own.
    with in_si():
        return _compared(scene, within, units, joint, draws, tolerance)


def _compared(
    scene: Scene,
    within: Mapping[str, float],
    units: Mapping[str, str],
    joint: Joint | None,
    draws: int,
    tolerance: float,
) -> Required:
    """The levels at the draws of the unknowns, against the finest of them."""
    levels, notes = levels_of(scene, tolerance)
    values: dict[str, Any] = {}
    count = 1
    if joint is not None:
        count = draws
        points = latin_hypercube(joint.dimensions, 0, draws)(0, draws)[:, :, 0]
        values = joint.values(points)
    answers, seconds, in_batch = [], [], []
    noted: list[list[Noted]] = []
    for level in levels:
        one = level._function([], list(units), tolerance, "tolerances")
        seconds.append(min(_time(one, [])[1] for _ in range(_TIMED)))
        said: list[Said] = []
        model = level._function(list(values), list(units), tolerance, "tolerances")
        found, spent = _time(model, said, **values)
        noted.append(noted_in_call(said, count))
        in_batch.append(spent / count if joint is not None else math.nan)
        answers.append(
            {
                path: np.full(count, np.nan)
                if found is None
                else np.broadcast_to(found[path].m_as(unit or "dimensionless"), (count,))
                for path, unit in units.items()
            }
        )
    finest = answers[-1]
    good = np.all([np.isfinite(value) for value in finest.values()], axis=0)
    if not good.any():
        raise NoSolutionError(
            "no draw has an answer at the finest level; bound the unknowns, or correct the scene",
            code="refused",
        )
    margin = 1.0 if joint is None else _MARGIN
    costs = []
    for level, own, spent, case in zip(levels, answers, seconds, in_batch, strict=True):
        differences = {
            path: _with_margin(_point(_apart(own[path], finest[path], unit)[good]), margin, unit)
            for path, unit in units.items()
        }
        holds = all(differences[path] <= within[path] for path in units)
        costs.append(Cost(level, spent, case, differences, holds))
    asked = 0 if joint is None else count
    answered = 0 if joint is None else int(good.sum())
    limits = list(_limits(levels, noted, count))
    warn_of(note for note, _ in limits)
    of_levels = {note.statement: where for note, where in limits} | notes
    return Required(
        tuple(costs), within, units, (asked, answered), of_levels, tuple(given_texts(scene))
    )


def _limits(
    levels: Sequence[Level], by_level: Sequence[Sequence[Noted]], count: int
) -> Iterator[tuple[Note, list[Level]]]:
    """What the models of the levels warned of, each sentence once with the levels it is of."""
    found: dict[tuple[str, str], list[tuple[Level, Note]]] = {}
    for level, noted in zip(levels, by_level, strict=True):
        # Draws without an answer are counted beside, and tell in the differences.
        for one in noted:
            if one.code != "refused_cases":
                for note in notes_of_samples([(count, [one])]):
                    found.setdefault((one.sentence, one.code), []).append((level, note))
    for (sentence, code), places in found.items():
        many = [note.fields.get("cases", count) for _, note in places]
        of, most, share = "in draws that are not counted ", None, None
        if None not in many:
            least, most = min(many), max(many)
            share = most / count
            of = f"in {least}{f' to {most}' if most > least else ''} of {count} draws "
        where = " and ".join(f"'{level.name}'" for level, _ in places)
        where = "every level" if len(places) == len(levels) else where
        # What a coarser level leaves out is in its difference, and is stated alone.
        last, note = places[-1]
        raised = note.warning if last is levels[-1] else None
        said_of = f"{of if count > 1 else ''}at {where}: {sentence}"
        fields = {"cases": most, "share": share}
        yield Note(raised, said_of, code=code, fields=fields), [level for level, _ in places]


def _time(model: Any, said: list[Said], **values: Any) -> tuple[Any, float]:
    """What a model answers, None where it is refused, and the processor time it took [s]."""
    begun = process_time()
    try:
        with quietly(said):
            found = model(**values)
    except CollisionsError:
        found = None
    return found, process_time() - begun


def _apart(own: Any, finest: Any, unit: str) -> Any:
    """How far answers are from those of the finest level; infinite where there is none."""
    off = own - finest
    if unit == "rad":
        off = (off + math.pi) % math.tau - math.pi
    return np.where(np.isnan(own), np.inf, np.abs(off))


def _with_margin(difference: float, margin: float, unit: str) -> float:
    """A difference with a margin; that of an angle is half a turn at most, or there is none."""
    found = margin * difference
    return min(found, math.pi) if unit == "rad" and math.isfinite(found) else found


def _point(differences: Any) -> float:
    """What this share of the differences does not exceed."""
    ordered = np.sort(differences)
    return float(ordered[math.ceil(SHARE * len(ordered)) - 1])


def _read_tolerances(scene: Scene, given: Any) -> tuple[dict[str, float], dict[str, str]]:
    if not isinstance(given, Mapping) or not given:
        raise InputError(
            "tolerances must be a dict from results to what they may be off by, such as "
            f"{{'Camry.rest.x': '0.5 m'}}, got {shown(given)}",
            code="bad_shape",
            argument="tolerances",
        )
    units = {path: unit_of_result(scene, path, "tolerances") for path in given}
    reader = ArgumentReader()
    found = {}
    for path, value in given.items():
        label = f"tolerances[{path!r}]"
        found[path] = reader.number(value, units[path], label, POSITIVE_FINITE)
        if isinstance(found[path], np.ndarray):
            text = f"{label} must be one number, got an array of shape {found[path].shape}"
            reader.refuse(InputError(text, code="bad_shape", argument="tolerances"))
    reader.close()
    return {path: float(value) for path, value in found.items()}, units


def _read_unknowns(scene: Scene, given: Any) -> dict[str, Distribution]:
    good = isinstance(given, Mapping) and bool(given)
    if not good or not all(isinstance(one, Distribution) for one in given.values()):
        raise InputError(
            "unknowns must be a dict from inputs to distributions, such as {'Camry.vx': "
            f"Normal('30 mph', '2 mph')}}, got {shown(given)}",
            code="bad_inputs",
            argument="unknowns",
        )
    known = units_of(scene, list(given), "unknowns")
    compare_units({path: one.unit for path, one in given.items()}, known, "unknowns")
    return dict(given)

"""``Together``: a run of a scene with what was found of the numbers of that scene, on one page:
which inputs of an impact are found, what the samples leave of it, and the measured places.
"""

from __future__ import annotations

import itertools
import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import replace
from operator import attrgetter
from typing import Any, NamedTuple

from .. import plot
from ..estimate.posterior_result import PosteriorOutput
from ..impact.impact import Impact
from ..messages.errors import CollisionsError, InputError
from ..plot.canvas import INK, Axes, Units
from ..quantities.formatting import UnitSystem
from ..quantities.settings import Default
from ..quantities.units import shown
from ..quantities.user_text import plain
from ..reconstruct import Fit, Posterior
from ..scene.one_run import need_one_run
from ..scene.results import by_contact, is_result, unit_of_result
from ..scene.run import Run
from ..scene.same import differs_at
from ..uncertainty.distributions import Normal
from .scene_words import input_in_words, result_in_words
from .words import listed, with_article

# What the samples are asked of each impact: the result, and whose it is.
_RANGED = {
    "a.delta_v": ("delta-V of {}", 0),
    "b.delta_v": ("delta-V of {}", 1),
    "a.pdof": ("PDOF of {} (0 from ahead, positive clockwise)", 0),
    "b.pdof": ("PDOF of {} (0 from ahead, positive clockwise)", 1),
    "closing_speed": ("closing speed", None),
}
_STATE = ("x", "y", "heading", "vx", "vy", "yaw_rate")
_OF_BODY = ("mass", "yaw_inertia", *_STATE)
# Relative, and in SI where a number is 0: a mean that was written into a scene and read again.
_SAME = 1e-9
_FROM_RUN = "from the run"


class Together(NamedTuple):
    """What was found of a scene, the run of it, and the part of the page that the first is."""

    found: Posterior | Fit
    run: Run
    part: int

    @property
    def middle(self) -> str:
        """What the numbers of the run are of those found."""
        word = "mean" if isinstance(self.found, Posterior) else "best value"
        return f"{word} of part {self.part}"

    @property
    def where(self) -> str:
        """Where among the numbers found the run is, in words: at their middle, or elsewhere."""
        marks, shared, words = self.marks(), self.run.scene.shared, self.words()
        apart = [
            words.get(name, name)
            for name in self.found.found
            if any(marks[path] != self.middle for path in shared.get(name, (name,)))
        ]
        if not apart:
            return f"at the {self.middle}"
        which = listed(map(plain, apart))
        return f"with {which} as set for this run, which is not the {self.middle}"

    @property
    def samples(self) -> int:
        """How many samples there are; none of a fit."""
        return self.found.samples if isinstance(self.found, Posterior) else 0

    def words(self) -> dict[str, str]:
        """The unknowns and the readings in words, by the paths of the scene that they have."""
        found, scene = self.found, self.run.scene
        read = found.observed if isinstance(found, Posterior) else {}
        inputs = scene.inputs()
        words = {
            name: input_in_words(scene, name)
            for name in found.found
            if name in inputs and name not in scene.shared
        }
        return words | {
            name: result_in_words(self.run, name)
            for name in read
            if name not in inputs and is_result(scene, name, len(self.run.impacts))
        }

    def marks(self) -> dict[str, str]:
        """By path, which numbers of the scene were found."""
        scene = self.run.scene
        numbers = dict(scene._numbers())
        for i in range(len(scene.contacts)):
            # The normal is kept as its cosine and sine.
            if (sine := numbers.get(f"contacts[{i}].normal[1]")) is not None:
                cosine = numbers[f"contacts[{i}].normal[0]"]
                numbers[f"contacts[{i}].normal"] = math.atan2(sine, cosine)
        for name, mover in scene.movers.items():
            numbers |= {
                f"{name}.speed": mover.vehicle.speed, f"{name}.course": mover.vehicle.course
            }  # fmt: skip
        marks = {}
        for name in self.found.found:
            middle = _middle(self.found, name)
            for path in scene.shared.get(name, (name,)):
                turns = scene.inputs()[path] == "rad"
                apart = float(numbers[path]) - middle
                apart = abs(math.remainder(apart, math.tau) if turns else apart)
                same = apart <= _SAME * max(1.0, abs(middle))
                marks[path] = self.middle if same else "set for this run"
        return marks

    def marks_of(self, number: int) -> dict[str, str]:
        """By the names of the inputs of an impact, which of them were found, and which the run came
        to the impact with.
        """
        run, all_marks, marks = self.run, self.marks(), {}
        impact = run.impacts[number]
        for label, name, side in zip("ab", run.pairs[number], (impact.a, impact.b), strict=True):
            start = run.scene.movers[name].vehicle
            polar = all_marks.get(f"{name}.speed") or all_marks.get(f"{name}.course")
            for part in _OF_BODY:
                mark = all_marks.get(f"{name}.{part}")
                if part in ("vx", "vy"):
                    mark = mark or polar
                one, other = getattr(side.before, part), getattr(start, part)
                known = one is not None and other is not None
                moved = known and abs(one - other) > _SAME * max(1.0, abs(one))
                mark = _FROM_RUN if part in _STATE and moved else mark
                if mark:
                    marks[f"{label}.{part}"] = mark
        rule = f"contacts[{run.rules[number]}]."
        given = run.scene.inputs()
        marks |= {
            name: _FROM_RUN
            for name in ("normal", "point[0]", "point[1]")
            if f"{rule}{name}" not in given
        }
        marks |= {
            path.removeprefix(rule): mark
            for path, mark in all_marks.items()
            if path.startswith(rule)
        }
        return marks

    def notes_of(self, number: int, notes: Mapping[str, str]) -> dict[str, str]:
        """The notes that were given by paths of the scene, by the names of inputs of an impact."""
        a, b = self.run.pairs[number]
        of = {f"{a}.": "a.", f"{b}.": "b.", f"contacts[{self.run.rules[number]}].": ""}
        return {
            own + name.removeprefix(path): text
            for name, text in notes.items()
            for path, own in of.items()
            if name.startswith(path)
        }

    def outlines_of(self, number: int) -> dict[str, list[tuple[float, float]]]:
        """The outlines of the two vehicles of an impact, of those that have one."""
        movers = self.run.scene.movers
        return {
            label: [(Default(ahead), Default(left)) for ahead, left in outline]
            for label, name in zip("ab", self.run.pairs[number], strict=True)
            if (outline := movers[name].outline) is not None
        }

    def ranges(self) -> list[dict[str, PosteriorOutput]]:
        """For each impact, by result, what the samples leave of it; nothing of a fit, which has no
        samples.
        """
        paths = [
            (number, name, self._path(number, name))
            for number, impact in enumerate(self.run.impacts)
            for name in _RANGED
            if _is_known(impact, name)
        ]
        found = self.outputs([path for *_, path in paths])
        ranges: list[dict[str, PosteriorOutput]] = [{} for _ in self.run.impacts]
        for number, name, path in paths if found else ():
            ranges[number][name] = found[path]
        return ranges

    def _path(self, number: int, name: str) -> str:
        """The path of a number of an impact: by its contact, if it is the first of that, as in
        another order it is none of this number.
        """
        path, rules = f"impacts[{number}].{name}", self.run.rules
        if rules[number] in rules[:number]:
            return path
        return by_contact(self.run.scene, path, rules[number])

    def outputs(self, paths: Sequence[str]) -> dict[str, PosteriorOutput]:
        """Results of the scene at every sample, by their paths."""
        found, scene = self.found, self.run.scene
        if not isinstance(found, Posterior) or not paths:
            return {}
        with warnings.catch_warnings():
            # Of the samples the posterior warned when it was made.
            warnings.simplefilter("ignore")
            try:
                model = scene.as_model(found.found, paths, tolerance=self.run.tolerance)
                answers = model(**{name: found.draws[name] for name in found.found})
            except CollisionsError:
                return {}
        islands = next(iter(found.unknowns.values()))._islands
        return {
            path: PosteriorOutput(
                path, unit_of_result(scene, path), answers[path].magnitude, islands
            )
            for path in paths
        }

    def with_outputs(self, names: Any) -> Together:
        """With the results of the scene that are asked for by their paths."""
        found, scene = self.found, self.run.scene
        if not isinstance(found, Posterior) or not isinstance(names, (list, tuple)):
            return self
        many = len(self.run.impacts)
        paths = [
            name for name in names if is_result(scene, name, many) and name not in found._outputs
        ]
        return self._replace(found=replace(found, predicted=found.predicted | self.outputs(paths)))

    def measured(self) -> dict[str, tuple[float, float]]:
        """The places of rest that were read, by vehicle."""
        places = {}
        for name in self.run.scene.movers:
            paths = [f"{name}.rest.{axis}" for axis in "xy"]
            seen = [self.found.residuals.get(path) for path in paths]
            if isinstance(self.found, Posterior):
                observed = self.found.observed
                if not all(isinstance(observed.get(path), Normal) for path in paths):
                    continue
            if seen[0] is not None and seen[1] is not None:
                places[name] = seen[0].observed, seen[1].observed
        return places

    def draw(self, run: Run, axes: Axes | None = None, units: UnitSystem | None = None) -> Axes:
        """The scene from above, with a cross where each vehicle was measured at rest."""
        drawn = plot.scene(run, axes=axes, units=units)
        metre = Units(units, run).factor("m")
        for name, (x, y) in self.measured().items():
            drawn.plot(
                x * metre, y * metre, "P", ms=9, mfc=INK, mec="white", mew=0.8, zorder=9,
                gid=f"{name}.measured",
            )  # fmt: skip
        return drawn


def words_of(name: str, pair: Sequence[str]) -> str:
    """A result that the samples are asked of, in words."""
    text, whose = _RANGED[name]
    return text if whose is None else text.format(with_article(pair[whose]))


def together_of(impact: Sequence[Any]) -> Together | None:
    """The run in a list and what was found of its scene, if it has a run; refused without the
    other.
    """
    runs = [one for one in impact if isinstance(one, Run)]
    if not runs:
        return None
    found = [one for one in impact if isinstance(one, (Posterior, Fit))]
    if len(runs) > 1 or len(found) != 1:
        raise InputError(
            "impact has a run of a scene in its list, which goes with one posterior or fit of the "
            "same scene, as in report([found, run]), or has a page of its own: write "
            "`report(run)`, and `uncertainty=` for what was propagated",
            code="not_an_impact",
            argument="impact",
        )
    need_one_run(runs[0], "report", "impact")
    _check_same_scene(found[0], runs[0])
    before = itertools.takewhile(lambda one: one is not found[0], impact)
    # Each impact of the run is a part.
    parts = sum(len(one.impacts) if isinstance(one, Run) else 1 for one in before)
    return Together(found[0], runs[0], parts + 1)


def _check_same_scene(found: Posterior | Fit, run: Run) -> None:
    """Refuse a run of another scene than that of which something was found."""
    inputs = run.scene.inputs()
    strange = [name for name in found.found if name not in inputs]
    strange += [
        name
        for name, one in found.residuals.items()
        if not one.is_prior and not is_result(run.scene, name, len(run.impacts))
    ]
    if strange:
        kind = type(found).__name__.lower()
        raise InputError(
            f"impact has a {kind} with {shown(strange[0])}, which the scene of its run does not "
            f"have; give a run of the scene that {kind} was given, such as "
            "`scene.replace({...}).run()`",
            code="bad_combination",
            argument="impact",
        )
    # Of a model that is a function of the caller's nothing else is known.
    if found._scene is not None and (path := differs_at(found._scene, run.scene, found.found)):
        kind = type(found).__name__.lower()
        raise InputError(
            f"impact has a {kind} and a run of another scene: {path} differs, which that {kind} "
            "did not find; give a run of the scene that it was given, or of that of `finer=`, such "
            "as `scene.replace({...}).run()` with the unknowns alone",
            code="bad_combination",
            argument="impact",
        )


def _middle(found: Posterior | Fit, name: str) -> float:
    """The mean, or the best value, of what was found."""
    return float(found[name].mean if isinstance(found, Posterior) else found[name].value)


def _is_known(impact: Impact, name: str) -> bool:
    """Whether an impact has a result that says something: of a body that nothing moves it has no
    delta-V.
    """
    label, _, inner = name.rpartition(".")
    if inner and label and not math.isfinite(getattr(impact, label).before.mass):
        return False
    value = attrgetter(name)(impact)
    return value is not None and math.isfinite(value)

"""Answers of the case of a whole crash: its model, what is asked of it by default, and the run that
a study found.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..estimate.fit_result import Fit
from ..estimate.posterior_result import Posterior
from ..messages.errors import InputError
from ..scene.model import as_function, order_of
from ..scene.results import numbered, unit_of_result
from ..scene.run import Run
from ..scene.scene import TOLERANCE, Scene
from .crash import SCENE
from .read import Call, Case, CaseError


def crash_model(case: Case, outputs: Sequence[str], place: str) -> Any:
    """The scene of a case as a function of its uncertain numbers, which gives these results as
    Quantities; ``place`` is the key that names them.
    """
    inside: Call = case.call.arguments[SCENE]
    tolerance = case.call.arguments.get("tolerance", TOLERANCE)
    scene: Scene = inside({})
    try:
        for path in outputs:
            unit_of_result(scene, path, "the scene")
        changed = _by_path(inside, dict.fromkeys(case.uncertain))
        order = order_of(scene, changed, numbered(scene, outputs), tolerance, "the scene")
    except InputError as error:
        raise CaseError((place, str(error))) from error

    def model(**values: Any) -> Any:
        made: Scene = inside(_by_path(inside, values))
        return as_function(made, [], outputs, tolerance, order=order)()

    vars(model)["answers_by_case"] = True
    return model


def run_at(case: Case, values: Mapping[str, Any]) -> Run:
    """The run of a case with some of its uncertain numbers."""
    run: Run = case.call(_by_path(case.call.arguments[SCENE], values))
    return run


def usual_outputs(run: Run) -> tuple[str, ...]:
    """What people ask of a crash: delta-V in each impact, and places of rest."""
    found = [f"impacts[{i}].{label}.delta_v" for i in range(len(run.impacts)) for label in "ab"]
    for name, mover in run.scene.movers.items():
        slowed = mover.tyres is not None or mover.drag is not None
        if slowed and mover.vehicle.x is not None:
            found += [f"{name}.rest.{axis}" for axis in "xy"]
    return tuple(found)


def found_run(case: Case, study: Fit | Posterior) -> tuple[Run, str]:
    """The run that a study of the case found, and which one it is, in a sentence.

    Of a fit that of its values; of a posterior that of the sample which is nearest to all medians,
    as the medians of each unknown need not go together.
    """
    if isinstance(study, Fit):
        values = {name: study[name].value for name in study.names}
        which = "the values of the fit"
    else:
        names = [*study.unknowns]
        drawn = np.array([study.draws[name] for name in names])
        spread = drawn.std(axis=1, keepdims=True)
        off = (drawn - np.median(drawn, axis=1, keepdims=True)) / np.where(spread > 0, spread, 1.0)
        nearest = int(np.argmin(np.sum(off * off, axis=0)))
        values = {name: float(drawn[i, nearest]) for i, name in enumerate(names)}
        which = "the sample that is nearest to the medians of all unknowns"
    return run_at(case, values), which


def _by_path(inside: Call, values: Mapping[str, Any]) -> dict[str, Any]:
    """The values of uncertain numbers by their paths, those of shared names at each of them."""
    shared = inside.arguments.get("shared") or {}
    found: dict[str, Any] = {}
    for name, value in values.items():
        found |= dict.fromkeys(shared.get(name, (name,)), value)
    return found

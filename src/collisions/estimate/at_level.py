"""``tolerance=`` of ``posterior``: the level of a scene that its accuracy needs, in its place."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from typing import Any, NamedTuple

from ..kernels.elementwise import POSITIVE_FINITE
from ..messages.errors import InputError, placed, reworded
from ..messages.marked import type_of
from ..messages.warning import Note, quietly
from ..quantities.formatting import KIND_OF
from ..quantities.reading import ArgumentReader
from ..quantities.settings import in_si
from ..quantities.tables import Sentences, given_texts
from ..quantities.units import shown
from ..uncertainty.distribution import show
from ..uncertainty.distributions import Distribution
from .evidence import Observation


class AtLevel(NamedTuple):
    """A level of a scene in its place, the same followed coarsely if that is to be sampled below
    it, and what is to be said of them.
    """

    model: Any
    below: Callable[..., Any] | None
    notes: tuple[Note, ...]


def at_level(
    model: Any, priors: Mapping[str, Distribution], rows: Sequence[Observation], tolerance: Any
) -> AtLevel:
    """The cheapest level of a scene that is within a tolerance for these priors."""
    if not hasattr(model, "required"):
        raise InputError(
            "tolerance is for a scene.Scene, of which it takes a level, and model is of type "
            f"{type_of(model)}; leave tolerance out",
            code="bad_option",
            argument="tolerance",
        )
    by_share = not isinstance(tolerance, Mapping)
    asked = _of_errors(rows, tolerance) if by_share else tolerance
    without = [row.name for row in rows if row.name not in asked]
    if without:
        raise InputError(
            f"tolerance says nothing of {', '.join(without)}, which the answer rests on too; give "
            "what each observation may be off by, or one number, a share of all their errors",
            code="bad_option",
            argument="tolerance",
        )
    try:
        # What the finest level warns of is among the notes.
        with quietly([]), in_si() if by_share else nullcontext():
            found = model.required(asked, priors)
    except InputError as error:
        argument = str(error.argument)
        if not argument.startswith("tolerances"):
            raise
        text = error.marked.replace("tolerances", "tolerance")
        argument = argument.replace("tolerances", "tolerance")
        raise placed(reworded(error, text), "", argument=argument) from None
    level = found.level
    cost = next(one for one in found.costs if one.level is level)
    say = Sentences(given_texts(model))

    def told(value: float, unit: str) -> str:
        return say(value, KIND_OF[unit], 4) if unit in KIND_OF else show(value, unit)

    differences = ", ".join(
        f"{path} by {told(cost.differences[path], unit)} of the {told(within, unit)} asked for"
        for (path, unit), within in zip(found.units.items(), found.tolerances.values(), strict=True)
    )
    said = (
        f"by tolerance=, the model is a level of the scene: {level.name}. In 95 % of the draws of "
        f"the priors it is off from the finest one by no more than this: {differences}"
    )
    if level is found.finest:
        said = f"by tolerance=, the model is the finest level of the scene: {level.name}"
    names = [row.name for row in rows]
    if found.answered < found.draws:
        said += f"; {found.draws - found.answered} of {found.draws} have no answer at the finest"
    notes = [said, *found._notes_of(level)]
    return AtLevel(
        level, level._coarser(list(priors), names), tuple(Note(None, text) for text in notes)
    )


def _of_errors(rows: Sequence[Observation], share: Any) -> dict[str, float]:
    """A share of the stated error of each observation [SI], or of the width of its bounds."""
    reader = ArgumentReader()
    read = reader.number(share, "", "tolerance", POSITIVE_FINITE)
    if not isinstance(read, float):
        text = (
            "tolerance must be one number, a share of the error of each observation, or a dict "
            f"from results to what they may be off by, got {shown(share)}"
        )
        reader.refuse(InputError(text, code="bad_option", argument="tolerance"))
    reader.close()
    found = {}
    for row in rows:
        wide = row.reading.sigma
        if not wide:
            bounds = row.reading.value
            low, high = getattr(bounds, "low", None), getattr(bounds, "high", None)
            wide = math.inf if low is None or high is None else high - low
        if not math.isfinite(wide):
            raise InputError(
                f"tolerance is a share of the error of each observation, and {row.name} has one "
                f"sharp bound; give a dict, such as `{{{row.name!r}: ...}}`",
                code="bad_option",
                argument="tolerance",
            )
        found[row.name] = read * wide
    return found

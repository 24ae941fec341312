"""Notes, within a study, that an infinite friction made a contact stick that may have slid."""

from __future__ import annotations

import math

import numpy as np

from ..kernels.contact_laws import FRICTION
from ..messages.errors import IllConditionedWarning
from ..messages.warning import in_study, warn_of_cases
from ..reference import INTER_VEHICLE_FRICTION
from .impact import Impact


def noted(impact: Impact) -> Impact:
    """The impact. Within ``propagate`` and the like its samples are noted that stick because of an
    infinite friction, at a ratio at which contacts between vehicles slide.

    Outside a study ``diagnose`` finds it: there a single impact is often tried with and without.
    """
    inputs = impact.inputs
    bound = inputs.rule_value
    # The first question is the cheapest one that settles nearly every single case.
    if (type(bound) is float and bound < math.inf) or inputs.rule != FRICTION or not in_study():
        return impact
    movable = np.isfinite(inputs.a.mass) & np.isfinite(inputs.b.mass)
    endless = np.isinf(bound) & movable & np.logical_not(impact.refused)
    if not np.any(endless):
        return impact
    least = INTER_VEHICLE_FRICTION.low
    sticks = endless & (np.abs(impact.impulse_ratio) >= least) & (impact.regime == "sticking")
    if np.any(sticks):
        text = (
            f"`friction=inf` makes the contact stick at an impulse ratio of {least:g} or "
            "more, at which contacts between vehicles slide "
            "(reference.INTER_VEHICLE_FRICTION): if it slid, this is not the impact. Give "
            "the friction with its uncertainty"
        )
        warn_of_cases(IllConditionedWarning(text, code="may_slide"), {text: sticks})
    return impact

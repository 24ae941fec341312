"""What is noted of a forward impact within a study: that an infinite friction made a contact stick
that may have slid, what its model leaves out, and why cases have no answer.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..kernels.contact_laws import FRICTION
from ..messages.errors import IllConditionedWarning
from ..messages.warning import WORKED_BACK, in_study, state_of_study, warn_of_cases
from ..reference import INTER_VEHICLE_FRICTION
from ..vehicle.vehicle import with_name
from .impact import Impact
from .left_out import tyres_lacking
from .run import state_refusals
from .tyres_stop import state_tyres_stop

# Models that a caller chose; ``solve`` chooses one of them by a tolerance, unless a duration lets
# it follow the contact in time.
_INSTANTS = ("linear_central", "oblique_central", "eccentric")
_LEFT = (
    "as an instant, which leaves out the tyres and the motion while the contact lasts; `left_out` "
    "says of one case how much that is"
)
_LEFT_BY_PUSH = (
    "as an instant with the impulses from outside, which leaves out the motion while the contact "
    "lasts; `left_out` says of one case how much that is"
)
_LEFT_BY_TYRES = (
    "that point and normal move on while the contact lasts; `finer=` with `time_resolved` has that "
    "too"
)


def _left_by_tyres(impact: Impact) -> str:
    if not (lacking := tyres_lacking(impact)):
        return f"with the tyres, which leaves out {_LEFT_BY_TYRES}"
    label = lacking[0]
    who = with_name(f"vehicle {label.upper()}", getattr(impact.inputs, label))
    return (
        f"with the tyres of one vehicle alone, which leaves out those of {who}, as they were not "
        f"given, and {_LEFT_BY_TYRES}"
    )


def noted(impact: Impact, on_failure: Any = None) -> Impact:
    """The impact. Within ``propagate`` and the like its samples are noted that stick because of an
    infinite friction, at a ratio at which contacts between vehicles slide, and with
    ``on_failure="nan"`` why samples have no answer; and within ``posterior`` and ``fit``, which
    work back through it, what its model leaves out.

    Outside a study ``diagnose`` finds it: there a single impact is often tried with and without.
    """
    if not in_study():
        return impact
    inputs = impact.inputs
    if on_failure == "nan":
        state_refusals(impact.status)
    if inputs.model in _INSTANTS or (inputs.model == "solve" and inputs.duration is None):
        rest = _left_by_tyres(impact) if inputs.tyres else _LEFT_BY_PUSH if inputs.pushed else _LEFT
        who = "solve answered" if inputs.model == "solve" else f"{inputs.model} solved"
        state_of_study(f"{who} every case {rest}", WORKED_BACK)
    state_tyres_stop(impact)
    bound = inputs.rule_value
    if (type(bound) is float and bound < math.inf) or inputs.rule != FRICTION:
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

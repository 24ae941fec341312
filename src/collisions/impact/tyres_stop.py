"""Where tyres could stop a vehicle, or its turning, within its contact: how much of their impulse
the mean force over the duration only estimates.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import reduce
from typing import Any, NamedTuple

import numpy as np

from ..messages.warning import in_study, state_of_cases
from .doubts import in_cases
from .impact import Impact, answer_of
from .time_resolved_inputs import held_impulse

# Of the momentum that a vehicle gains: half of the share by which a simpler model may err.
MOST_ESTIMATED = 0.05
# So many times what stops the vehicle is all that its tyres have.
_ALL = 1e6


class Estimated(NamedTuple):
    """Impulse and moment that the whole force of the tyres of a vehicle would give beyond half of
    what stops it; and the larger of them as a share of the momentum that it gains, infinite where
    it gains none.
    """

    impulse: Any
    moment: Any
    share: Any


def estimated(impact: Impact, label: str) -> Estimated:
    """What is only estimated of the impulse of the tyres of a vehicle."""
    side = getattr(impact, label)
    mass, inertia = side.before.mass, side.before.yaw_inertia
    half, whole = (
        held_impulse(impact.inputs, answer_of(impact), label, times) for times in (1.0, _ALL)
    )
    with np.errstate(all="ignore"):
        x, y, turn = (np.subtract(more, less) for more, less in zip(whole, half, strict=True))
        impulse, moment = np.hypot(x, y), np.abs(turn)
        # A moment at the radius of gyration.
        part = np.maximum(impulse, moment / np.sqrt(np.divide(inertia, mass)))
        share = part / np.multiply(mass, side.delta_v)
    share = np.where(part == 0.0, 0.0, np.where(np.isfinite(share), share, np.inf))
    return Estimated(impulse, moment, np.where(np.isinf(mass), 0.0, share))


def most_estimated(impact: Impact) -> Any:
    """The larger of both vehicles' shares; 0 without tyres, for a contact that was followed in time
    and where there is no answer.
    """
    if impact.pulse is not None:
        return 0.0
    shares = [estimated(impact, label).share for label in "ab" if label in impact.inputs.tyres]
    return np.where(impact.refused, 0.0, reduce(np.maximum, shares, 0.0))


def estimates(impact: Impact) -> Iterator[str]:
    """That more than a little is only estimated; of a batch, with the number of its cases."""
    if not impact.inputs.tyres:
        return
    shares = most_estimated(impact)
    most = float(np.max(shares, initial=0.0))
    much = "more than" if most >= 1.0 else f"up to {100.0 * most:.0f} percent of"
    sentence = (
        "the tyres could stop a vehicle, or its turning, within the duration of the contact: "
        f"{much} the momentum that it gains is only estimated; follow the contact in time, by "
        "time_resolved"
    )
    yield from in_cases(shares > MOST_ESTIMATED, sentence)


def state_tyres_stop(impact: Impact) -> None:
    """State of how many cases of a study more than a little is only estimated."""
    if not (in_study() and impact.inputs.tyres):
        return
    text = (
        "the tyres could stop a vehicle, or its turning, within the duration of the contact, and "
        f"more than {100.0 * MOST_ESTIMATED:g} percent of the momentum that it gains is only "
        "estimated; `finer=` with `time_resolved` follows the contact in time"
    )
    cases = most_estimated(impact) > MOST_ESTIMATED
    if np.any(cases):
        state_of_cases({text: cases if np.ndim(cases) else None}, "tyres_stop")

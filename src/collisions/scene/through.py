"""What is said of two that go through or into each other after they met."""

from __future__ import annotations

from typing import Any

import numpy as np

from .against import ends_of
from .between import PUSHED, Between
from .notices import Number, Told
from .touching import Pair

# Between their contact and the time they part, where it is looked how deep they are.
_SHARES = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9)
# Later than this [s] motion that nothing slows comes together by rounding alone.
SOON = 1e3


def note_through(
    told: Told, pair: Between, moving: Pair, cases: Any, parts: Any, limit: Any
) -> None:
    """Note two that were in contact, or touched too slowly for one, and go through each other
    before they part, or come to overlap deeper than they did then: what pushes them without a
    blow is not followed.

    ``parts`` is when they are apart [s]; not finite where they are not until ``limit``, from
    which on they may go another way.
    """
    had = np.isfinite(pair.allowed[cases])
    cases, parts, limit = cases[had], parts[had], limit[had]
    apart = np.isfinite(parts)
    ends, still = np.where(apart, parts, limit), ~apart & np.isinf(limit)
    ends[still] = ends_of(pair, cases[still])
    soon, struck = ends <= SOON, pair.allowed[cases] > PUSHED
    # What was passed over is looked at for so long, as it may come together ever so slowly.
    ends, apart = np.where(soon, ends, SOON), apart & soon
    soon |= ~struck
    cases, apart, ends, struck = cases[soon], apart[soon], ends[soon], struck[soon]
    if not len(cases):
        return
    met, state_a, state_b = moving.at(ends, cases)
    way = pair.side[:, cases]
    beyond = way[0] * (state_b[0] - state_a[0]) + way[1] * (state_b[1] - state_a[1]) < 0.0
    overlap, when = np.where(apart, 0.0, -met.gap), ends.copy()
    # Two that part, or rest, may have been deeper in between.
    for share in _SHARES:
        begun = pair.met[cases]
        moments = begun + share * (ends - begun)
        between, *_ = moving.at(moments, cases)
        when = np.where(-between.gap > overlap, moments, when)
        overlap = np.maximum(overlap, -between.gap)
    # One that is on the other side has gone through it, however deep their contact was.
    before = np.where(beyond & apart, pair.depth[cases], pair.crushed[cases])
    driven = overlap > before + pair.allowed[cases]
    told.driven[cases[driven]] = True
    if not told.single or not driven[0]:
        return
    (first, second), at = pair.names, float(ends[0])
    deep = Number(float(overlap[0]), "length", 2)
    how = "do not part right after their contact"
    if not struck[0]:
        how = f"touch at {float(pair.met[cases[0]]):.3g} s, too slowly for a contact"
    if beyond[0] and apart[0]:
        text = (
            f"{first} and {second} {how}, and are followed through "
            f"each other, to the other side at {at:.3g} s: one is slowed less and would push "
            "the other, which is not followed; their motion from there on is not what happened"
        )
        told.note_once("driven_through", text, at, pair.names)
    else:
        at = float(when[0])
        rest = (
            f" at {at:.3g} s, more than then: what pushes or turns them into each other "
            "without a blow is not followed"
        )
        words = f"{first} and {second} {how}, and overlap by ", deep, rest
        told.note_once("driven_together", words, at, pair.names)

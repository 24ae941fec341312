"""How long contacts last, and what that leaves of tyres and slope to what follows."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from ..impact.impact import Impact, way_to_separation
from .contact import Contact
from .motion import Ground

# Two contacts that share less of their duration than this share nothing.
_SHARED = 1e-9


class Lasting:
    """What contacts that last leave to each mover, by name."""

    def __init__(self, names: Iterable[str], count: int) -> None:
        names = [*names]
        # By mover, until when the last contact that was followed in time lasts.
        self.until: dict[str, Any] = {name: np.zeros(count) for name in names}
        # By mover, from when and until when the impulses of its contacts have what its tyres do.
        self.braked: dict[str, Any] = {
            name: np.repeat([[np.inf], [-np.inf]], count, axis=1) for name in names
        }
        # By mover, for how much longer than there is time a slope pulls in its last contact, and
        # from when to when [s].
        self.owed: dict[str, Any] = {name: np.zeros((3, count)) for name in names}

    def shares(self, names: Iterable[str], which: Any, time: Any, spans: tuple[Any, Any]) -> bool:
        """Whether tyres of these vehicles act for a part of a contact only, in any case."""
        return any(bool(self.had(name, which, time, spans).any()) for name in names)

    def had(self, name: str, which: Any, time: Any, spans: tuple[Any, Any]) -> Any:
        """For how much of a contact, of which ``spans`` has all and what is to come [s], the
        impulses of earlier ones have what the tyres of a vehicle do.
        """
        lasting, hold = spans
        begin, until = self.braked[name][:, which]
        ends = time + hold
        had = np.minimum(until, ends) - np.maximum(begin, ends - lasting)
        # One that follows at once on another shares nothing with it but rounding.
        return np.where(had > _SHARED * lasting, np.clip(had, 0.0, lasting), 0.0)

    def brake(self, name: str, which: Any, begins: Any, ends: Any) -> None:
        """Keep that the impulse of a contact has what the tyres of a vehicle do meanwhile."""
        begin, until = self.braked[name][:, which]
        begin = np.minimum(begin, begins)
        self.braked[name][:, which] = begin, np.maximum(until, ends)


def duration_of(contact: Contact, ground: Ground, which: Any, time: Any) -> tuple[Any, Any]:
    """How long a contact lasts that has a duration, and how much of that is to come [s]."""
    lasting = np.broadcast_to(ground.taker(which)(contact.duration), len(which))
    # States at time 0 are those of maximum engagement, half of the contact before them.
    return lasting, np.where((time == 0.0) & (not contact.touches), 0.5 * lasting, lasting)


def lasts_of(impact: Impact, count: int) -> tuple[Any, Any]:
    """How long contacts last that were followed in time, and how much of that is to come [s]; NaN
    of a case that was not.
    """
    way = way_to_separation(impact)
    if way is None:
        return np.full(count, np.nan), np.full(count, np.nan)
    whole = left = np.broadcast_to(way.duration, count)
    # The places given are those of first touch, or of maximum engagement.
    if impact.inputs.geometry != "first_contact":
        left = np.broadcast_to(whole - way.engaged, count)
    return whole, left

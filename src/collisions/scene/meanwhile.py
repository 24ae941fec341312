"""How vehicles move while a contact lasts that was followed in time, worked out where it is asked
for.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..impact.impact import Impact
from ..impact.recorded import curve_of, followed

# Moments of a contact between which states are cubics.
_MOMENTS = 41


class InTime:
    """One contact of some cases that was followed in time. ``ends`` are by vehicle its time and
    state at the start and the end of what is looked at, (7, 2, cases); NaN where a case was not
    followed.
    """

    def __init__(self, impact: Impact, ends: Mapping[str, Any]) -> None:
        self.ends = ends
        self.impact = impact

    @cached_property
    def tables(self) -> dict[str, Any]:
        """Time and state of each vehicle at some moments, (7, moments, cases)."""
        count = self.ends["a"].shape[2]
        found = {label: np.full((7, _MOMENTS, count), np.nan) for label in "ab"}
        inputs, answer = self.impact.inputs, self.impact._answer
        for cases, motions, engaged in followed(inputs, answer):
            for label, table in found.items():
                curve = curve_of(motions, label, engaged)
                before = getattr(self.impact, label).before
                rates = [
                    np.broadcast_to(part, count)[cases] + changes
                    for part, changes in ((before.vx, curve.vx), (before.vy, curve.vy))
                ]
                rates.append(curve.yaw_rate)
                begins = 0.0 * engaged if inputs.geometry == "first_contact" else engaged
                for at, case in enumerate(cases.tolist()):
                    table[:, :, case] = _table(
                        curve.time[:, at] - begins[at],
                        np.array([rate[:, at] for rate in rates]),
                        self.ends[label][:, :, case],
                    )
        return found


def _table(time: Any, rates: Any, ends: Any) -> Any:
    """Time and state of one vehicle in one case at even moments between both ends, (7, moments),
    from its velocities at some times.
    """
    last = ends[0, 1]
    moments = np.linspace(0.0, last, _MOMENTS)
    middles = np.diff(time) * 0.5 * (rates[:, 1:] + rates[:, :-1])
    ways = np.concatenate([np.zeros((3, 1)), np.cumsum(middles, axis=1)], axis=1)
    places = np.array([_integral(moments, time, *pair) for pair in zip(ways, rates, strict=True)])
    speeds = np.array([np.interp(moments, time, rate) for rate in rates])
    state = np.concatenate([places - places[:, :1] + ends[1:4, :1], speeds])
    # As exact as both ends, between which the steps of the contact are sums.
    share = moments / last if last > 0.0 else np.zeros(_MOMENTS)
    off = ends[1:, :] - state[:, [0, -1]]
    return np.concatenate([moments[None], state + off[:, :1] * (1.0 - share) + off[:, 1:] * share])


def _integral(moments: Any, time: Any, way: Any, rate: Any) -> Any:
    """The way at some moments of a velocity that goes evenly from one time to the next."""
    at = np.clip(np.searchsorted(time, moments, side="right") - 1, 0, len(time) - 2)
    past = np.clip(moments - time[at], 0.0, None)
    return way[at] + 0.5 * past * (rate[at] + np.interp(moments, time, rate))


@dataclass(frozen=True)
class During:
    """The motion of one vehicle in one contact that was followed in time, in some of its cases."""

    contact: InTime
    label: str
    cases: Any

    def of(self, some: Any) -> During:
        """That in some of the cases."""
        return During(self.contact, self.label, self.cases[some])

    @property
    def impact(self) -> Impact:
        """The contact itself."""
        return self.contact.impact

    @property
    def ends(self) -> Any:
        """Time and state at the start and the end, (7, 2, cases)."""
        return self.contact.ends[self.label][:, :, self.cases]

    @property
    def moments(self) -> Any:
        """From the start on the times between which the states of a single case are cubics [s]."""
        return np.linspace(0.0, self.ends[0, 1, 0], _MOMENTS)

    def at(self, time: Any, some: Any) -> Any:
        """The states of some of the cases, each at its time."""
        cases = self.cases[some]
        if not np.any(time):
            return self.contact.ends[self.label][1:, 0, cases]
        return _between(self.contact.tables[self.label], time, cases)


def _between(table: Any, time: Any, cases: Any) -> Any:
    """States between the moments of a table: cubics with their places and velocities."""
    moments = table[0][:, cases]
    before = np.clip(np.sum(moments <= time, axis=0) - 1, 0, len(moments) - 2)
    start, end = (table[0, at, cases] for at in (before, before + 1))
    width = end - start
    part = np.clip((time - start) / np.where(width > 0.0, width, 1.0), 0.0, 1.0)
    one, two = table[1:, before, cases], table[1:, before + 1, cases]
    p, q = one[:3], two[:3]
    v, w = width * one[3:], width * two[3:]
    rise = q - p
    bend = 3.0 * rise - 2.0 * v - w
    twist = v + w - 2.0 * rise
    places = p + part * (v + part * (bend + part * twist))
    rates = (v + part * (2.0 * bend + part * 3.0 * twist)) / np.where(width > 0.0, width, 1.0)
    return np.concatenate([places, rates])

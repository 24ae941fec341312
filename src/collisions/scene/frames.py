"""The moments at which a page plays a run, and the states of its vehicles there."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from .run import Run

# Moments of one page about, and the time that is shown of vehicles which nothing stops [s].
_MOST, _BEYOND = 500, 1.0
_STEPS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5)


class Frames(NamedTuple):
    """Equal steps of time from the start to rest; that of a contact twice, before and after.

    Attributes
    ----------
    times : array [s]
    states : dict of array
        By name, of (6, moments): x, y [m], heading [rad], vx, vy [m/s] and yaw rate [rad/s].
    after : list of int
        Of each impact, the moment right after it.
    """

    times: Any
    states: dict[str, Any]
    after: list[int]


def frames_of(run: Run) -> Frames:
    """The moments of one case, from its start until all rest, or a little after the last contact
    where something moves on.
    """
    courses, every = run._followed.courses, np.arange(1)
    with np.errstate(all="ignore"):
        goes_on = any(not math.isfinite(course.rests[0]) for course in courses.values())
    end = run.end + (_BEYOND if goes_on else 0.0)
    step = next((one for one in _STEPS if end <= one * _MOST), end / _MOST)
    bounds = [0.0, *run.times, end]
    times: list[float] = []
    states: dict[str, list[Any]] = {name: [] for name in courses}
    after = []
    for number, (begin, until) in enumerate(pairwise(bounds)):
        if number:
            after.append(len(times))
        inside = step * np.arange(math.floor(begin / step) + 1, math.ceil(until / step))
        inside = inside[(inside > begin) & (inside < until)]
        here = [begin, *inside.tolist(), until] if until > begin else [begin]
        times += here
        for name, course in courses.items():
            state = course.at(np.array(here), np.zeros(len(here), dtype=int))
            if number < len(bounds) - 2:
                state[:, -1:] = course.at(np.array(here[-1:]), every, before=True)
            states[name].append(state)
    joined = {name: np.concatenate(parts, axis=1) for name, parts in states.items()}
    return Frames(np.array(times), joined, after)

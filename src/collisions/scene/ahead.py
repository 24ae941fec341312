"""Looking ahead: when two movers next touch."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..messages.errors import InputError, NoSolutionError
from ..vehicle.vehicle import needed
from .against import horizon, lost_of, moving_of
from .between import APART, LEAST_CLOSING, PUSHED, Between
from .engaging import arrange
from .lasting import Lasting
from .notices import Told
from .through import note_through
from .touching import TOUCHING, closing_of, first_apart, first_touch

# Touches in a row that are too slow for a contact, after which two are not followed further.
_MOST_PASSED = 100
# Outlines overlap at the start beyond this [m].
_OVERLAPS = 1e-6


def at_start(told: Told, pair: Between) -> None:
    """Refuse outlines that overlap at the start without a contact; pairs that touch are one
    contact.
    """
    if pair.shapes is None:
        return
    every = np.arange(pair.courses[0].count)
    for course in pair.courses:
        for part in ("x", "y", "heading"):
            needed(course.mover.vehicle, part, "an outline in a scene", course.name)
    met, state_a, state_b = moving_of(pair).at(np.zeros(len(every)), every)
    pair.apart = met.gap > TOUCHING
    pair.first[~pair.apart] = np.where(met.gap < -_OVERLAPS, -np.inf, 0.0)[~pair.apart]
    begins = np.zeros(len(every), dtype=bool)
    for contact in pair.timed.values():
        begins |= pair.ground.cases(contact.at) == 0.0
    wrong = (met.gap < -_OVERLAPS) & ~begins
    if told.single and wrong.any():
        one, other = pair.names
        raise InputError(
            f"the outlines of {one} and {other} overlap by "
            f"{told.say(-float(met.gap[0]), 'length', 3)} "
            "at the start, and no contact of these two is at time 0; correct x, y, "
            f"heading or outline, or write `|Contact({one!r}, {other!r}, ...)|"
            f'[[contact]] with a = "{one}", b = "{other}"` at 0',
            code="overlap_at_start",
            argument="movers",
            movers=pair.names,
        )
    told.fail(np.flatnonzero(wrong), "overlap_at_start")
    # Two that touch as the scene begins, and close, have their contact then.
    axis = met.axis(met.widest)
    closing = closing_of(met, axis, state_a, state_b)
    pair.meets(every, 0.0, met, axis, PUSHED)
    pair.allowed[pair.apart | begins] = np.inf
    at_once = ~pair.apart & ~wrong & ~begins & (closing >= LEAST_CLOSING)
    pair.touch[at_once], pair.closing[at_once] = 0.0, closing[at_once]
    pair.first[at_once] = 0.0
    arrange(told, pair, np.flatnonzero(at_once))


def look_ahead(
    told: Told, lasting: Lasting, pair: Between, now: Any, alive: Any, limits: Any = None
) -> None:
    """Find the next touch of a pair where it is not known, and what becomes of it; with
    ``limits`` until a time of each case [s].
    """
    if limits is None:
        limits = np.full(len(now), np.inf)
    cases = np.flatnonzero(alive & np.isnan(pair.touch) & np.isinf(pair.due))
    rounds = 0
    while len(cases):
        rounds += 1
        if rounds > _MOST_PASSED:
            _grazing(told, pair, cases)
            return
        moving, limit = moving_of(pair), limits[cases]
        until = limit.copy()
        if np.isinf(limit).any():
            until = np.minimum(limit, horizon(pair, cases))
        until = np.minimum(until, lost_of(pair.courses, cases))
        begin = np.maximum(now[cases], np.where(np.isnan(pair.begun), 0.0, pair.begun)[cases])
        # A contact followed in time goes to its end before another of the two begins.
        for name in pair.names:
            begin = np.maximum(begin, lasting.until[name][cases])
        near = ~pair.apart[cases]
        if near.any():
            begin[near] = first_apart(moving, begin[near], until[near], cases[near], APART)
            note_through(told, pair, moving, cases[near], begin[near], limit[near])
        touch = first_touch(moving, begin, until, cases)
        _refuse_unknown_touch(told, pair, cases, touch.given_up)
        pair.apart[cases] = np.isfinite(begin)
        closer = touch.nearest < pair.nearest[cases]
        pair.nearest[cases] = np.where(closer, touch.nearest, pair.nearest[cases])
        pair.nearest_at[cases] = np.where(closer, touch.nearest_at, pair.nearest_at[cases])
        touches = np.isfinite(touch.time)
        # What is not found until then is looked for again from there on.
        unknown = ~touches & np.isfinite(limit)
        pair.touch[cases] = np.where(unknown, np.nan, touch.time)
        pair.closing[cases] = touch.closing
        pair.first[cases[touches]] = touch.time[touches]
        counts = touches & (touch.closing >= pair.least[cases])
        passes = touches & ~counts
        if pair.rule is not None:
            pair.instant[cases[counts]] = False
            arrange(told, pair, cases[counts])
        # A resting contact is passed over: the search goes on once they were apart.
        over = cases[passes]
        met, *_ = moving.at(touch.time[passes], over)
        pair.meets(over, touch.time[passes], met, met.axis(met.widest), PUSHED)
        pair.touch[over], pair.begun[over], pair.apart[over] = np.nan, touch.time[passes], False
        cases = over


def _refuse_unknown_touch(told: Told, pair: Between, cases: Any, until: Any) -> None:
    """Refuse what goes on for so long that it is not found out whether two touch; ``until``
    when they were followed [s], NaN where it is known.
    """
    lost = np.isfinite(until)
    if told.single and lost.any():
        one, other = pair.names
        raise NoSolutionError(
            f"{one} and {other} were followed until {float(until[0]):.4g} s, and still come "
            "nearer, so that it is not known whether they touch later; give what moves more "
            "drag, or tyres, or leave out the outline of one that is not to touch",
            code="touch_undecided",
            time=float(until[0]),
            movers=pair.names,
        )
    told.fail(cases[lost], "touch_undecided")


def _grazing(told: Told, pair: Between, cases: Any) -> None:
    """Give up cases in which two touch again and again, too slowly for a contact: what nothing
    slows may turn and graze another for years.
    """
    one, other = pair.names
    if told.single and pair.rule is not None:
        raise NoSolutionError(
            f"{one} and {other} touch again and again, {_MOST_PASSED} times by "
            f"{float(pair.begun[0]):.4g} s, always too slowly for a contact; give what moves "
            "tyres= or drag=, which would end it",
            code="never_ends",
            movers=pair.names,
        )
    pair.touch[cases] = np.inf
    if pair.rule is not None:
        told.fail(cases, "never_ends")

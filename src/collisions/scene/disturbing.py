"""What a blow does to the other touches of the two that it strikes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from .against import moving_of
from .between import AGAIN, APART, Between
from .engaging import arrange
from .notices import Told
from .touching import TOUCHING, closing_of, first_apart


def closings(pairs: Iterable[Between], struck: Between, which: Any, time: Any) -> dict[int, Any]:
    """How fast the pairs close that are in contact beside the one that is struck."""
    found = {}
    for pair in pairs:
        if pair is not struck and pair.shapes is not None and {*pair.names} & {*struck.names}:
            found[id(pair)] = _closing(pair, which, time)
    return found


def _closing(pair: Between, which: Any, time: Any) -> tuple[Any, Any, Any]:
    met, state_a, state_b = moving_of(pair).at(time, which)
    axis = met.axis(met.widest)
    return closing_of(met, axis, state_a, state_b), met.gap, met.widest


def disturb(told: Told, pair: Between, which: Any, times: tuple[Any, Any], before: Any) -> None:
    """A pair of which one was struck, from a time to another: its next touch is to be found
    again; it comes at once where it is in contact and is driven together.
    """
    struck, time = times
    came = pair.keep_touches(which, struck)
    pair.apart[came], pair.begun[came] = False, pair.touch[came]
    # A touch that was still ahead when it was passed over is none any more.
    ahead = which[pair.begun[which] > struck]
    pair.begun[ahead], pair.apart[ahead] = np.nan, True
    _not_yet_apart(pair, which, struck)
    # A touch that has begun goes on to its impulse.
    waiting = np.isfinite(pair.due[which]) & (pair.touch[which] <= struck)
    pair.touch[which] = np.where(waiting, pair.touch[which], np.nan)
    pair.due[which] = np.where(waiting, pair.due[which], np.inf)
    if pair.shapes is None or pair.contact is None:
        return
    kept = which[waiting]
    if len(kept):
        arrange(told, pair, kept)
        pair.due[kept] = np.maximum(pair.due[kept], time[waiting])
        pair.seen[kept] = np.maximum(pair.seen[kept], pair.due[kept])
    closing, gap, widest = _closing(pair, which, time)
    least = pair.least[which]
    in_contact = ~pair.apart[which] & ~waiting & (gap < APART)
    # Two that were pushed into each other slowly may close faster than that already.
    struck_on = (before[0] < least) | (closing - before[0] >= AGAIN)
    together = in_contact & (closing >= least) & struck_on
    driven = together & (gap <= TOUCHING)
    # Outlines that have parted a little meet anew.
    anew = which[together & ~driven]
    pair.apart[anew] = pair.anew[anew] = True
    some = which[driven]
    if not len(some):
        return
    pair.instant[some] = False
    pair.touch[some], pair.closing[some] = time[driven], closing[driven]
    pair.axis[some], pair.deepest[some] = widest[driven], False
    pair.due[some] = pair.seen[some] = time[driven]
    # Outlines that only touch have no overlap yet.
    bare = driven & (gap > -1e-3)
    if pair.contact.from_outlines and bare.any():
        pair.due[which[bare]] = np.inf
        arrange(told, pair, which[bare])


def _not_yet_apart(pair: Between, which: Any, time: Any) -> None:
    """Take back that two are apart which are so only later than an impact that comes before:
    their next touch was looked for from when they part.
    """
    if pair.shapes is None:
        return
    blow = np.where(np.any(pair.way[:, which] != 0.0, axis=0), pair.struck[which], np.nan)
    since = np.fmax(blow, pair.begun[which])
    some = pair.apart[which] & ~pair.anew[which] & (since <= time)
    if some.any():
        cases, until = which[some], time[some]
        parts = first_apart(moving_of(pair), since[some], until, cases, APART)
        pair.apart[cases] = parts <= until

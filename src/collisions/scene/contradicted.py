"""What a scene contradicts: contacts that do not come, another order, touches not described."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from ..messages.errors import CollisionsError, NoSolutionError, Status
from .against import horizon, moving_of, refuse_lost
from .between import Between
from .came import MOST_CONTACTS, Came
from .contact import Contact
from .motion import Course, Ground
from .notices import Number, Told
from .through import SOON
from .touching import TOUCHING

# A time [s] that is later than any other.
_LONG = 1e300
# So many moments are looked at for how near two vehicles come that do not touch.
_LOOKS = 129
# A contact at a time that comes within this [s] of a touch is that of the touch.
_LATE = 0.5
# What a negative number of a contact is called.
_NEGATIVE = {"at": "negative_time", "depth": "negative_length", "delay": "negative_duration"}


def refuse_numbers(told: Told, ground: Ground, contact: Contact) -> None:
    """Leave the cases without an answer whose time, depth or delay cannot be."""
    for name, code in _NEGATIVE.items():
        value = getattr(contact, name)
        if isinstance(value, np.ndarray):
            every = ground.cases(value)
            told.fail(np.flatnonzero(~np.isfinite(every)), Status.NOT_FINITE.label)
            told.fail(np.flatnonzero(every < 0.0), code)


def endless(told: Told, came: Came, contact: Contact, cases: Any) -> None:
    """Refuse what has not come to its end after as many contacts as a scene may have."""
    if told.single:
        raise NoSolutionError(
            f"the scene has not come to its end after {MOST_CONTACTS} contacts: {contact.a} "
            f"and {contact.b} go on touching, at {float(came.times[-1, 0]):.4g} s; a lower "
            "restitution, or tyres or drag, would end it",
            code="never_ends",
            movers=(contact.a, contact.b),
        )
    told.fail(cases, "never_ends")


def check(
    told: Told,
    came: Came,
    courses: Mapping[str, Course],
    contacts: Sequence[Contact],
    pairs: Sequence[Between],
    order: Sequence[tuple[str, str]] | None,
) -> None:
    """Refuse a case in which a contact does not come, or the order is another; note touches
    that no contact describes.
    """
    for rule, contact in enumerate(contacts):
        # What the contact before was refused for is said, and nothing more.
        told.gather(courses.values())
        absent = np.flatnonzero(~np.any(came.rules == rule, axis=0) & (told.failed == ""))
        # It may come where the motion of the two is not known any more.
        two = courses[contact.a], courses[contact.b]
        known = refuse_lost(two, absent, np.full(len(absent), np.inf))
        absent = absent[known]
        if len(absent) and told.single:
            raise _not_coming(told, pairs, rule, contact)
        told.fail(absent, "contact_missing")
    if order is not None:
        names = [(contact.a, contact.b) for contact in contacts]
        good = came.many == len(order)
        for number, pair in enumerate(order[:MOST_CONTACTS]):
            fits = [i for i, one in enumerate(names) if {*one} == {*pair}]
            good &= np.isin(came.rules[number], fits)
        if told.single and not good[0]:
            took = [names[rule] for rule in came.longest]
            raise NoSolutionError(
                f"the contacts come in the order {_listed(took)}, and order says {_listed(order)}",
                code="other_order",
                order=tuple(took),
            )
        told.fail(np.flatnonzero(~good), "other_order")
    for one in pairs:
        _note(told, came, one)


def _listed(pairs: Sequence[tuple[str, str]]) -> str:
    return ", then ".join(f"{one} and {other}" for one, other in pairs) or "none"


def _note(told: Told, came: Came, pair: Between) -> None:
    """Note touches of a pair that no contact describes."""
    if pair.rule is not None:
        return
    pair.keep_touches(np.arange(came.count), np.full(came.count, _LONG))
    one, other = pair.names
    for cases, times, closings in pair.touched:
        later = came.times[:, cases] - times
        of_them = np.isin(came.rules[:, cases], [*pair.timed]) & (later >= 0.0) & (later <= _LATE)
        lacking = ~of_them.any(axis=0)
        told.undescribed[cases[lacking]] = True
        if not told.single or not lacking[0]:
            continue
        time = float(times[0])
        words = (
            f"{one} and {other} touch at {time:.3g} s, closing by ",
            Number(float(closings[0]), "speed", 3),
            ", and no contact says what happens; they are followed as if they passed through "
            "each other",
        )
        told.note("touch_without_contact", words, time, pair.names)


def _not_coming(
    told: Told, pairs: Iterable[Between], rule: int, contact: Contact
) -> CollisionsError:
    pair = next(p for p in pairs if {contact.a, contact.b} == {*p.names})
    near, at = _nearest(pair)
    if not math.isfinite(near) or not math.isfinite(at):
        reason = "do not part and meet again"
    elif near <= TOUCHING:
        reason = (
            f"touch at {at:.3g} s, and do not close along the normal from {contact.a} into "
            f"{contact.b} where the impulse would act"
        )
    else:
        reason = f"are {told.say(near, 'length', 3)} apart at their closest, at {at:.3g} s"
    return NoSolutionError(
        f"contacts[{rule}] does not come: {contact.a} and {contact.b} {reason}; correct what "
        "leads there, or leave the contact out",
        code="contact_missing",
        distance=near,
        time=at,
        movers=(contact.a, contact.b),
    )


def _nearest(pair: Between) -> tuple[float, float]:
    """How near two vehicles of a single case come to each other [m], and when [s]; infinite
    where they were not looked for.

    The search for a touch passes over what cannot touch, so that it has seen but a bound.
    """
    near, at, one = float(pair.nearest[0]), float(pair.nearest_at[0]), np.zeros(1, dtype=int)
    if not math.isfinite(near) or near <= TOUCHING:
        return near, at
    moving, last = moving_of(pair), float(horizon(pair, one)[0])

    def gap(time: float) -> float:
        return float(moving.at(np.array([time]), one)[0].gap[0])

    times = np.linspace(0.0, min(last, SOON), _LOOKS).tolist()
    gaps = [gap(time) for time in times]
    best = min(range(_LOOKS), key=gaps.__getitem__)
    low, high = times[max(best - 1, 0)], times[min(best + 1, _LOOKS - 1)]
    for _ in range(40):
        one_third, two_thirds = low + (high - low) / 3.0, high - (high - low) / 3.0
        low, high = (low, two_thirds) if gap(one_third) <= gap(two_thirds) else (one_third, high)
    found = min((gap(time), time) for time in (0.5 * (low + high), times[best]))
    return found if found[0] < near else (near, at)

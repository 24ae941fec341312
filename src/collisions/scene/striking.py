"""Striking: a contact whose time has come acts on its two vehicles, in some of the cases."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Any

import numpy as np

from ..messages.errors import CollisionsError, NoSolutionError, Status
from ..messages.warning import quietly
from .against import moving_of, refuse_lost
from .between import AGAIN, DEEPER, LEAST_CLOSING, PUSHED, Between
from .came import Came
from .contact import IN_TIME, Contact
from .disturbing import closings, disturb
from .going_on import go_on
from .lasting import Lasting
from .motion import Course
from .notices import Told
from .placing import closing_at, place_of
from .solving import Solving


class Striking:
    """What applies the contacts of a scene, with all that one of them changes."""

    def __init__(
        self,
        contacts: Sequence[Contact],
        courses: Mapping[str, Course],
        pairs: Sequence[Between],
        told: Told,
        lasting: Lasting,
        came: Came,
    ) -> None:
        self._contacts, self._courses, self._pairs = contacts, courses, pairs
        self._told, self._lasting, self._came = told, lasting, came
        self._solving = Solving(contacts, courses, told, lasting, came)

    def of_one_kind(self, rule: int, which: Any, now: Any) -> list[Any]:
        """The cases by the tyres that act during a contact that lasts, and by whether it is at the
        start.
        """
        contact = self._contacts[rule]
        if contact.duration is None or self._told.single:
            return [which]
        groups: dict[tuple[int, int, bool], list[int]] = {}
        for case in which.tolist():
            one, other = (int(self._courses[n].wheels_of[case]) for n in (contact.a, contact.b))
            groups.setdefault((one, other, bool(now[case] == 0.0)), []).append(case)
        return [np.array(cases) for cases in groups.values()]

    def strike(self, rule: int, which: Any, now: Any) -> None:
        """Apply a contact whose time has come, by its model or by the least that is near enough."""
        contact = self._contacts[rule]
        pair = next(p for p in self._pairs if {contact.a, contact.b} == {*p.names})
        if not contact._takes_least:
            self._by(contact, rule, pair, which, now)
            return
        # A contact in time begins at first touch; what takes no time acts when an impulse does.
        early = np.zeros(len(which), dtype=bool)
        if contact.touches and contact._may_be_in_time:
            early = ~pair.instant[which] & (now[which] < pair.seen[which])
        fresh = which[early]
        if len(fresh):
            begins = self._least(contact._by_model(IN_TIME), rule, pair, fresh, now) == IN_TIME
            self._by(contact._by_model(IN_TIME), rule, pair, fresh[begins], now)
            wait = fresh[~begins]
            pair.instant[wait], pair.due[wait] = True, pair.seen[wait]
        which = which[~early]
        if not len(which):
            return
        models = self._least(contact, rule, pair, which, now)
        for model in np.unique(models).tolist():
            self._by(contact._by_model(model), rule, pair, which[models == model], now)

    def _least(self, contact: Contact, rule: int, pair: Between, which: Any, now: Any) -> Any:
        """The least model near enough of each of these cases of a contact, by where it strikes now:
        of a contact in time where that begins.
        """
        time = now[which]
        states = {name: self._courses[name].at(time, which) for name in (contact.a, contact.b)}
        # What cannot be worked out is refused where it strikes.
        found: Any = "eccentric"
        with self._told.unsaid(), quietly(), suppress(CollisionsError):
            place = place_of(self._told, pair, contact, which, time, states)
            whole = self._contacts[rule]
            impact = self._solving.by_model(
                rule, whole, which, time, states, place, on_failure="nan"
            )
            found = impact.model
        return np.broadcast_to(np.asarray(found, dtype=object), len(which))

    def _by(
        self,
        contact: Contact,
        rule: int,
        pair: Between,
        which: Any,
        now: Any,
    ) -> None:
        """Apply a contact by its model in the cases in which nothing is against it."""
        which = self._refuse_meanwhile(rule, contact, which, now[which])
        if not len(which):
            return
        time = now[which]
        states = {name: self._courses[name].at(time, which) for name in (contact.a, contact.b)}
        known = refuse_lost([self._courses[name] for name in states], which, time)
        if not known.all():
            which, time = which[known], time[known]
            states = {name: state[:, known] for name, state in states.items()}
            if not len(which):
                return
        normal, point = place_of(self._told, pair, contact, which, time, states)
        if contact.touches:
            # Two that do not close where they would push each other are passed over.
            closes = closing_at(contact, states, normal, point) >= LEAST_CLOSING
            if not closes.all():
                self._pass_over(pair, which[~closes], time[~closes])
                which, time = which[closes], time[closes]
                if not len(which):
                    return
                states = {name: state[:, closes] for name, state in states.items()}
                normal, point = (
                    None
                    if part is None
                    else tuple(one[closes] if np.ndim(one) else one for one in part)
                    for part in (normal, point)
                )
        impact = self._solving.impact_of(rule, contact, which, time, states, (normal, point))
        refused = np.atleast_1d(np.asarray(impact.status)) > Status.ENERGY_GAIN
        if refused.any() and not self._told.single:
            labels = np.array([Status(code).label for code in np.ravel(impact.status).tolist()])
            for label in np.unique(labels[refused]).tolist():
                self._told.fail(which[refused & (labels == label)], label)
        deepest = pair.deepest[which].copy() if contact.touches else np.zeros(len(which), bool)
        self._came.add(rule, which, time, impact, deepest)
        before = closings(self._pairs, pair, which, time)
        pair.first[which] = pair.began(which, time)
        ends = go_on(self._lasting, self._courses, contact, which, time, states, impact)
        pair.keep_touches(which, time)
        pair.due[which], pair.touch[which], pair.apart[which] = np.inf, np.nan, False
        pair.least[which], pair.begun[which], pair.anew[which] = AGAIN, np.nan, False
        if contact.duration is not None:
            self._note_drags(contact, which, time)
        if pair.shapes is not None:
            moving = moving_of(pair)
            met, *_ = moving.at(time, which)
            pair.struck[which] = time
        sign = 1.0 if contact.a == pair.names[0] else -1.0
        for row, part in zip(pair.way, impact.normal, strict=True):
            row[which] = sign * part
        if pair.shapes is not None:
            pair.meets(which, ends, met, pair.way[:, which], DEEPER)
            crushed = np.maximum(-moving.at(ends, which)[0].gap, 0.0)
            pair.crushed[which] = np.maximum(pair.depth[which], crushed)
        for other in self._pairs:
            if other is pair or not {contact.a, contact.b} & {*other.names}:
                continue
            disturb(self._told, other, which, (time, ends), before.get(id(other)))

    def _refuse_meanwhile(self, rule: int, contact: Contact, which: Any, time: Any) -> Any:
        """The cases in which no other contact of the two lasts, to which a contact at a time would
        come.
        """
        until = np.max(
            [self._lasting.until[name][which] for name in (contact.a, contact.b)], axis=0
        )
        meanwhile = time < until
        if meanwhile.any() and self._told.single:
            raise NoSolutionError(
                f"contacts[{rule}], {contact.a} and {contact.b}, is at {float(time[0]):.4g} s, "
                f"while another contact of one of them lasts until {float(until[0]):.4g} s; "
                "give a later time, a shorter duration, or `at='touch'`",
                code="contact_meanwhile",
                time=float(time[0]),
                movers=(contact.a, contact.b),
            )
        self._told.fail(which[meanwhile], "contact_meanwhile")
        return which[~meanwhile]

    def _pass_over(self, pair: Between, which: Any, time: Any) -> None:
        """A touch in which nothing pushes: the search goes on once the two were apart."""
        self._told.passed_over[which] = True
        if self._told.single:
            one, other = pair.names
            text = (
                f"{one} and {other} touch at {float(pair.touch[0]):.3g} s and do not close where "
                "the impulse would act; they are followed without one"
            )
            self._told.note("touch_passed_over", text, float(time[0]), pair.names)
        pair.due[which], pair.touch[which], pair.apart[which] = np.inf, np.nan, False
        pair.begun[which] = time
        met, *_ = moving_of(pair).at(time, which)
        pair.meets(which, time, met, met.axis(met.widest), PUSHED)

    def _note_drags(self, contact: Contact, which: Any, time: Any) -> None:
        """Note vehicles whose drag does not act during a contact that has a duration."""
        drags = {name: self._courses[name].mover.drag for name in (contact.a, contact.b)}
        slid = [name for name, drag in drags.items() if drag is not None and np.any(drag)]
        if not slid:
            return
        self._told.dragless[which] = True
        if self._told.single:
            text = (
                f"during the contact of {contact.a} and {contact.b}, which has a duration, "
                f"the drag of {' and '.join(slid)} does not act; tyres in place of a drag do"
            )
            names = contact.a, contact.b
            self._told.note("drag_during_contact", text, float(time[0]), names)

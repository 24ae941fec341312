"""The impact of a contact: solved by its model, with the tyres that act while it lasts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from typing import Any

import numpy as np

from ..impact.impact import Impact
from ..impact.inputs import OnFailure, part_of
from ..impact.solvers import eccentric, linear_central, oblique_central, solve, time_resolved
from ..kernels.contact_laws import FRICTION, RULES
from ..messages.errors import CollisionsError, placed
from ..messages.warning import NO_ANSWER, of_some, quietly
from ..quantities.settings import in_si
from ..vehicle.tyres import Tyres
from .came import Came
from .contact import IN_TIME, Contact
from .lasting import Lasting, duration_of, lasts_of
from .ledger import tyres_in_part, tyres_where_they_are
from .motion import Course, body_at
from .notices import Told

# Rounds in which it settles how long a contact lasts in which tyres act for a part.
_ROUNDS = 3


class Solving:
    """What solves the contacts of a scene, each where its time has come."""

    def __init__(
        self,
        contacts: Sequence[Contact],
        courses: Mapping[str, Course],
        told: Told,
        lasting: Lasting,
        came: Came,
    ) -> None:
        self._contacts, self._courses = contacts, courses
        self._told, self._lasting, self._came = told, lasting, came

    def impact_of(
        self, rule: int, contact: Contact, which: Any, time: Any, states: Any, place: Any
    ) -> Impact:
        """The impact of a contact; of one that takes the least model near enough the answer of
        ``solve``, which takes that model again.
        """
        if contact.in_time:
            return self.by_model(rule, contact, which, time, states, place)
        with nullcontext() if contact.duration is not None else self._told.unsaid():
            return self.by_model(rule, self._contacts[rule], which, time, states, place)

    def by_model(
        self,
        rule: int,
        contact: Contact,
        which: Any,
        time: Any,
        states: Any,
        place: Any,
        on_failure: OnFailure | None = None,
    ) -> Impact:
        """The impact of a contact in some cases, by its model."""
        ground = self._courses[contact.a].ground
        take = ground.taker(which)

        def numbers(value: Any) -> Any:
            return value if self._told.single else part_of(value, take)

        a, b = (
            body_at(self._courses[name].mover, name, states[name], take, single=self._told.single)
            for name in (contact.a, contact.b)
        )
        if self._told.single and float(time[0]) == 0.0 and not self._came.hits:
            # As they were given, texts included.
            a, b = (
                self._courses[name].mover.vehicle.replace(name=name)
                for name in (contact.a, contact.b)
            )
        normal, point = place
        options: dict[str, Any] = {"normal": normal, "incomplete": contact.incomplete}
        solver: Any = linear_central
        if contact.model != "linear_central":
            options |= {name: numbers(getattr(contact, name)) for name in RULES}
            options |= {"law": contact.law}
            solver = oblique_central
        if contact.model in ("eccentric", "solve", IN_TIME):
            solver = {"eccentric": eccentric, "solve": solve, IN_TIME: time_resolved}[contact.model]
            options["point"] = point
            if contact.in_time:
                options = {name: options[name] for name in ("normal", "point", FRICTION)}
                at_start = not contact.touches and float(time[0]) == 0.0
                options["geometry"] = "maximum_engagement" if at_start else "first_contact"
        if contact.model == "solve":
            options["tolerance"] = 0.0 if contact.tolerance is None else numbers(contact.tolerance)

        def solved(spans: Any, on_failure: OnFailure | None) -> Impact:
            given = options | {"on_failure": on_failure if self._told.single else "nan"}
            if spans is not None:
                given["duration"] = numbers(contact.duration)
                given |= {
                    f"tyres_{label}": self._tyres(name, which, time, spans, states[name])
                    for label, name in (("a", contact.a), ("b", contact.b))
                }
            found: Impact = solver(a, b, numbers(contact.restitution), **given)
            return found

        spans = None if contact.duration is None else duration_of(contact, ground, which, time)
        # Of a study, what is warned of is noted of the cases that come to this contact now; which
        # of them have no answer the run says itself.
        cases = np.isin(np.arange(self._came.count), which)
        try:
            with in_si(), of_some(cases, but=NO_ANSWER):
                if (
                    contact.in_time
                    and spans is not None
                    and self._lasting.shares(states, which, time, spans)
                ):
                    # How much of it the tyres have had goes by how long it lasts, and the other
                    # way round: a few rounds settle that.
                    with self._told.unsaid(), quietly():
                        for _ in range(_ROUNDS):
                            whole, left = lasts_of(solved(spans, "nan"), len(which))
                            known = np.isfinite(left)
                            spans = (
                                np.where(known, whole, spans[0]),
                                np.where(known, left, spans[1]),
                            )
                return solved(spans, on_failure)
        except CollisionsError as error:
            raise self._at(error, rule, time) from None

    def _tyres(
        self, name: str, which: Any, time: Any, spans: tuple[Any, Any], state: Any
    ) -> Tyres | None:
        """The tyres of a vehicle on the ground where it is in a contact that lasts, for as much of
        it as no earlier one has already.
        """
        course = self._courses[name]
        tyres = course.wheels[int(course.wheels_of[which[0]])]
        if tyres is None:
            return None
        tyres, mixed = tyres_where_they_are(tyres, course.ground, state, which)
        self._told.mixed[which] |= mixed
        if self._told.single and mixed[0]:
            text = (
                f"in the contact at {float(time[0]):.3g} s the wheels of {name} stand on ground of "
                f"different friction, of which the mean, {tyres.friction:.3g}, acts on all four "
                "while the contact lasts"
            )
            self._told.note("mixed_friction", text, float(time[0]), (name,))
        lasting, had = spans[0], self._lasting.had(name, which, time, spans)
        if not had.any():
            return tyres
        self._told.partly[which] |= had > 0.0
        if self._told.single:
            text = (
                f"in the contact at {float(time[0]):.3g} s the tyres of {name} act for "
                f"{float(lasting[0] - had[0]):.3g} s of its {float(lasting[0]):.3g} s, with that "
                "share of their friction, as an earlier contact has the rest"
            )
            self._told.note("durations_overlap", text, float(time[0]), (name,))
        share = 1.0 - had / lasting
        return tyres_in_part(tyres, float(share[0]) if self._told.single else share)

    def _at(self, error: CollisionsError, rule: int, time: Any) -> CollisionsError:
        """The error with the contact and its time before it."""
        contact = self._contacts[rule]
        where = f"contacts[{rule}], {contact.a} and {contact.b} at {float(time[0]):.4g} s"
        return placed(error, where)

"""The balance of momentum where a course is sought beside a speed: that of the same body, whose
velocity is then what the other momenta leave, or that of another one.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np

from ..impact.doubts import NEARLY_COLLINEAR
from ..kernels.reverse import Term
from ..kernels.status import EPS
from ..quantities.attributes import hypot
from ..quantities.directions import Angle

NEARLY_CANCELLING = 1.0 / math.tan(0.5 * NEARLY_COLLINEAR)
"""Above it, as at courses near one line, small errors move the answer far."""
# Of a sine of 1, what rounding may add to it.
_ROUNDING = 16.0 * EPS

Rows: TypeAlias = dict[str, dict[str, Any]]


def sought_course(terms: Mapping[str, Term]) -> str | None:
    """The one body whose course is sought beside one speed, by the name of its speed: the body
    whose speed is sought, or, where the course of that is known, the only moving one without.
    """
    unknown = [name for name, term in terms.items() if term.speed is None]
    if len(unknown) != 1:
        return None
    if terms[unknown[0]].course is None:
        return unknown[0]
    lacking = without_course(terms)
    return lacking[0] if len(lacking) == 1 else None


def without_course(terms: Mapping[str, Term]) -> list[str]:
    """The moving bodies of which no course is given, by the names of their speeds."""
    return [
        name
        for name, term in terms.items()
        if term.course is None and np.any(np.not_equal(term.speed, 0.0))
    ]


class Whole:
    """One velocity from the balance of momentum."""

    possible: Any = True

    def __init__(
        self, terms: Mapping[str, Term], name: str, pushes: Sequence[tuple[Any, Any]]
    ) -> None:
        self.speed_of = self.course_of = name
        self._terms, self._wanted = terms, terms[name]
        moving = [term for term in terms.values() if term.course is not None]
        x: Any = sum(push for push, _ in pushes)
        y: Any = sum(push for _, push in pushes)
        size: Any = sum(hypot(*push) for push in pushes)
        for term in moving:
            c, s = term.course.direction
            momentum = term.mass * term.speed
            x, y = x + term.sign * momentum * c, y + term.sign * momentum * s
            size = size + abs(momentum)
        sign = -self._wanted.sign
        self.x, self.y = sign * x / self._wanted.mass, sign * y / self._wanted.mass
        self.speed = hypot(self.x, self.y)
        self.angle = np.arctan2(self.y, self.x)
        self.condition = np.divide(size, self._wanted.mass * self.speed)

    def sensitivity(self, outside: bool) -> Rows:
        """Derivatives of the speed and of the course by every input, of which an impulse from
        outside may be one.
        """
        scale = -self._wanted.sign / self._wanted.mass
        course = _course(self.course_of)
        found = self._wanted._replace(speed=self.speed, course=Angle(self.angle, False))
        moved = {
            name: (scale * x, scale * y)
            for name, (x, y) in _by_input(
                {**self._terms, self.speed_of: found}, (self.speed_of, course), outside
            ).items()
        }
        c, s = np.cos(self.angle), np.sin(self.angle)
        return {
            self.speed_of: {name: c * x + s * y + 0.0 for name, (x, y) in moved.items()},
            course: {
                name: np.divide(c * y - s * x, self.speed) + 0.0 for name, (x, y) in moved.items()
            },
        }


class Beside:
    """The course of one body and the speed of another from the balance of momentum.

    Counted across the course of the unknown speed, the balance holds the unknown course alone, by
    its sine: it goes along with that course (``side`` 1) or against it (-1).
    """

    def __init__(
        self,
        terms: Mapping[str, Term],
        names: tuple[str, str],
        pushes: Sequence[tuple[Any, Any]],
        side: Any,
    ) -> None:
        self.speed_of, self.course_of = names
        self._terms = terms
        one, other = (terms[name] for name in names)
        axis = one.course
        c, s = axis.direction
        along: Any = sum(c * x + s * y for x, y in pushes)
        across: Any = sum(c * y - s * x for x, y in pushes)
        for term in terms.values():
            if term.speed is not None and term.course is not None:
                cosine, sine = axis.to(term.course)
                momentum = term.sign * term.mass * term.speed
                along, across = along + momentum * cosine, across + momentum * sine
        momentum = other.sign * other.mass * other.speed
        self.least = abs(across) / other.mass
        sine = np.divide(-across, momentum)
        self.possible = abs(sine) <= 1.0 + _ROUNDING
        # Tyres that are still worked out may yet make an impossible one possible.
        sine = np.clip(np.where(np.isnan(sine), 0.0, sine), -1.0, 1.0)
        cosine = side * np.sqrt((1.0 - sine) * (1.0 + sine))
        self._turn = cosine, sine
        self.speed = -(along + momentum * cosine) / (one.sign * one.mass)
        self.angle = np.arctan2(s * cosine + c * sine, c * cosine - s * sine)
        self.condition = np.divide(1.0 + abs(sine), abs(cosine))

    @property
    def at_an_end(self) -> Any:
        """Whether both sides are one: the course is at right angles to that of the other body."""
        return np.equal(self._turn[0], 0.0)

    def sensitivity(self, outside: bool) -> Rows:
        """As ``Whole.sensitivity``."""
        (one, other), course = (
            (self._terms[name] for name in (self.speed_of, self.course_of)),
            _course(self.course_of),
        )
        found = {
            self.speed_of: one._replace(speed=self.speed),
            self.course_of: other._replace(course=Angle(self.angle, False)),
        }
        inputs = _by_input({**self._terms, **found}, (self.speed_of, course), outside)
        cosine, sine = self._turn
        c, s = one.course.direction
        by_speed = -one.sign / one.mass
        # A momentum that underflows moves with nothing.
        by_course = np.divide(-other.sign, other.mass * other.speed)
        rows: Rows = {self.speed_of: {}, course: {}}
        for name, (x, y) in inputs.items():
            along, across = c * x + s * y, c * y - s * x
            turned = np.divide(across, cosine)
            rows[self.speed_of][name] = by_speed * (along + sine * turned) + 0.0
            rows[course][name] = by_course * turned + 0.0
        return rows


def _course(name: str) -> str:
    return name.replace("speed", "course")


def _by_input(
    terms: Mapping[str, Term], unknowns: Collection[str], outside: bool
) -> dict[str, tuple[Any, Any]]:
    """How the balance of momentum changes with each input, along x and y, at what was found."""
    moved: dict[str, tuple[Any, Any]] = {}
    moving = {name: term for name, term in terms.items() if term.course is not None}
    for side in "ab":
        x: Any = 0.0
        y: Any = 0.0
        for name, term in moving.items():
            # Vehicles that leave together have one term.
            if side == name[6] or (name == "speed_a_after" and len(terms) == 3):
                c, s = term.course.direction
                x, y = x + term.sign * term.speed * c, y + term.sign * term.speed * s
        moved[f"mass_{side}"] = x, y
    for name, term in moving.items():
        c, s = term.course.direction
        by = term.sign * term.mass
        if name not in unknowns:
            moved[name] = by * c, by * s
        if _course(name) not in unknowns:
            moved[_course(name)] = -by * term.speed * s, by * term.speed * c
    if outside:
        moved |= {"outside_impulse_x": (1.0, 0.0), "outside_impulse_y": (0.0, 1.0)}
    return moved

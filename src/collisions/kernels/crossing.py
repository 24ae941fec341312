"""Momentum along courses that cross: two unknown speeds from the planar momentum balance.

Every moving body is a term: sign (+ before, - after), mass, speed, course. The balance sum(sign m s h) + J = 0 crossed with one
unknown's course leaves the other unknown alone, and all cross products are sines of differences of courses.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, TypeAlias

import numpy as np


class Term(NamedTuple):
    """One body before or after; ``speed`` is None where it is asked for, ``course`` None for a body at rest."""

    sign: float
    mass: Any
    speed: Any
    course: Any


# Cosine and sine of the angle from one course to another.
Between: TypeAlias = Callable[[Any, Any], tuple[Any, Any]]


def crossed(terms: Sequence[Term], impulse: tuple[Any, Any] | None, course: Any, per_mass: Any, between: Between) -> Any:
    """The known momentum of the balance crossed with a course, over a mass."""
    total: Any = 0.0
    for term in terms:
        if term.speed is not None and term.course is not None:
            total = total + term.sign * (term.mass / per_mass) * (term.speed * between(term.course, course)[1])
    if impulse is not None:
        c, s = course.direction
        total = total + (impulse[0] * s - impulse[1] * c) / per_mass
    return total


def unknown_speed(terms: Sequence[Term], impulse: tuple[Any, Any] | None, wanted: Term, other: Term, between: Between) -> Any:
    """The speed of one unknown term, the other being eliminated; not finite where their courses are parallel."""
    sine = between(wanted.course, other.course)[1]
    return np.divide(-wanted.sign * crossed(terms, impulse, other.course, wanted.mass, between), sine)


def change_of_speed(cross: Any, wanted: Term, other: Term, between: Between) -> Any:
    """What a change of the balance, crossed with the other unknown's course, does to the wanted speed."""
    return np.divide(-wanted.sign * cross, wanted.mass * between(wanted.course, other.course)[1])


def course_change(term: Term, speed: Any, other: Term, between: Between) -> Any:
    """Change of the balance by radian of a term's course, crossed with the other unknown's course."""
    return -term.sign * term.mass * (speed * between(term.course, other.course)[0])

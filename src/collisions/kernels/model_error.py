"""Predicts the error of each central model and picks the cheapest within the tolerance.

Only the impulse at the contact is needed. The error, in m/s, is the hypot of the error of the
delta-V vector and of the radius of gyration times the error of the change of yaw rate.
"""

from math import inf, nan
from typing import Any, NamedTuple

from . import central, eccentric
from .contact_laws import CRITICAL_FRACTION
from .elementwise import larger, select
from .problem import Body, Contact, Problem

# Safety factor on a predicted error, so that the true error stays within the tolerance where the
# prediction is too small.
_MARGIN = 1.15
# A lever of so many eps of the coordinates may be rounding: of angles up to a turn, of what they
# were made from, and of slip. But not more than this, in m: in float32 far from the origin it would
# take a real one for rounding.
_LEVER, _LONGEST = 16.0, 1e-4
LINEAR, OBLIQUE, ECCENTRIC, LACKING = range(4)


class Known(NamedTuple):
    """What is known of A and of B: the position relative to the contact, and the yaw inertia.

    ``complete`` says whether everything that the eccentric model needs is known, ``central``
    whether the central models take all that was given.
    """

    places: tuple[bool, bool]
    inertias: tuple[bool, bool]
    complete: bool
    central: bool = True


def least_model(
    problem: Problem, tolerance: Any, rule: str, law: str, known: Known, eps: float
) -> tuple[Any, Any, Any]:
    """Number of the cheapest model within the tolerance, and the errors of the linear and the
    oblique model.

    What is unknown of the problem is filled in so that it makes no torque. LACKING is the eccentric
    model where it lacks something, unless it is known that the bodies do not approach; where the
    central models do not take what was given, every input is needed.
    """
    struck = eccentric.strike(problem, rule, law, eps)
    answered = struck.answered
    linear = oblique = select(answered, inf, nan)
    if known.central:
        linear, oblique = _errors(problem, rule, law, struck, answered)
    lacking: Any = False
    if not known.complete:
        matters, approach = _needed(problem, rule, known, struck, eps)
        apart = approach & ((struck.closing > 0.0) ^ True)
        lacking = (matters if known.central else True) & (apart ^ True)
        unknown = nan if known.central else inf
        linear, oblique = select(lacking, unknown, linear), select(lacking, unknown, oblique)
        lacking = apart ^ True
    within = tolerance > 0.0
    which = select(lacking, LACKING, ECCENTRIC)
    which = select(within & (_MARGIN * oblique <= tolerance), OBLIQUE, which)
    return select(within & (_MARGIN * linear <= tolerance), LINEAR, which), linear, oblique


def _needed(
    problem: Problem, rule: str, known: Known, struck: eccentric.Struck, eps: float
) -> tuple[Any, Any]:
    """Whether what is not known could matter, and whether the closing speed is known without it."""
    contact, approach, matters = problem.contact, True, False
    # Where the impulse without slip decides the ratio, it counts too.
    counts = contact.rule_value > 0.0 if rule == CRITICAL_FRACTION else False
    (normal, tangential), no_slip = struck.impulse, struck.without_slip
    size = abs(normal) + abs(tangential) + select(counts, abs(no_slip[0]) + abs(no_slip[1]), 0.0)
    each = zip(
        (problem.a, problem.b),
        struck.torques,
        eccentric.torques(*struck.responses, *no_slip),
        known.places,
        known.inertias,
        strict=True,
    )
    for body, torque, no_slip_torque, placed, weighed in each:
        if not placed:
            # Without a position the lever arm is unknown, which matters for a body that can turn or
            # is turning.
            approach = approach & (body.yaw_rate == 0.0)
            turns = (body.yaw_inertia < inf) | (body.yaw_rate != 0.0)
            matters = matters | (turns if weighed else True)
        elif not weighed:
            # Solved with infinite inertia: if there is no torque then, the true inertia does not
            # matter.
            turning = abs(torque) + select(counts, abs(no_slip_torque), 0.0)
            matters = matters | ((turning <= _rounding_of_lever(contact, body, eps) * size) ^ True)
    return matters, approach


def _rounding_of_lever(contact: Contact, body: Body, eps: float) -> Any:
    """A lever that may be nothing but rounding."""
    px, py = contact.point
    lever = _LEVER * eps * (abs(body.x) + abs(body.y) + abs(px) + abs(py))
    return select(lever < _LONGEST, lever, _LONGEST)


def _errors(
    problem: Problem, rule: str, law: str, struck: eccentric.Struck, answered: Any
) -> tuple[Any, Any]:
    """Errors of the linear and the oblique model for the worse of both bodies, from what the
    eccentric model answered.

    The errors are NaN where the eccentric model has no answer, infinite where the cheaper one has
    none.
    """
    oblique = central.strike(problem, rule, law)
    normal, tangential = oblique.impulse
    off_normal = struck.impulse[0] - normal
    torques, worst = struck.torques, []
    # Both central models have the same normal impulse, and the linear one no other.
    for off_tangential in (struck.impulse[1], struck.impulse[1] - tangential):
        squared = [
            # The last term is (radius of gyration times change of yaw rate) squared.
            _square(body.per_mass * off_normal)
            + _square(body.per_mass * off_tangential)
            + (body.per_mass * torque) * (body.per_inertia * torque)
            for body, torque in zip(struck.responses, torques, strict=True)
        ]
        worst.append(larger(*squared) ** 0.5)
    beyond = select(answered, inf, nan)
    return select(answered & oblique.answered, worst[0], beyond), select(
        answered & oblique.answered & (oblique.pulls ^ True), worst[1], beyond
    )


def _square(value: Any) -> Any:
    return value * value

"""Predicts the error of each central model and picks the cheapest within the tolerance.

Only the impulse at the contact is needed. The error, in m/s, is the hypot of the error of the delta-V vector and of the
radius of gyration times the error of the change of yaw rate.
"""

from collections.abc import Callable
from math import inf, nan
from typing import Any, NamedTuple

from .central import oblique_central
from .contact_laws import CRITICAL_FRACTION
from .eccentric import eccentric
from .elementwise import larger, select

# With ``impulse_only`` they return other values than an ``Answer``.
_eccentric: Callable[..., tuple[Any, ...]] = eccentric
_oblique: Callable[..., tuple[Any, ...]] = oblique_central
# Safety factor on a predicted error, so that the true error stays within the tolerance where the prediction is too small.
_MARGIN = 1.15
# A lever of so many eps of the coordinates may be rounding: of angles up to a turn, of what they were made from, and of slip.
# But not more than this, in m: in float32 far from the origin it would take a real one for rounding.
_LEVER, _LONGEST = 16.0, 1e-4
LINEAR, OBLIQUE, ECCENTRIC, LACKING = range(4)


class Known(NamedTuple):
    """What is known: positions of A and B relative to the contact, their yaw inertias, everything needed; and who is pinned.

    ``outside`` says whether there are impulses from outside, whose numbers then stand before the tolerance.
    """

    places: tuple[bool, bool]
    inertias: tuple[bool, bool]
    all: bool
    pinned: tuple[bool, bool]
    outside: bool = False


def least_model(*given: Any) -> tuple[Any, Any, Any]:
    """Number of the cheapest model within the tolerance, and the errors of the linear and the oblique model.

    The arguments are six numbers of the contact, nine of each body (unknown ones filled in so that they make no torque),
    the tolerance, rule, law, ``Known``, and eps. LACKING is the eccentric model where it lacks something, unless it is
    known that the bodies do not approach; with a pivot or an impulse from outside every input is needed.
    """
    contact, bodies, outside, (tolerance, rule, law, known, eps) = (
        given[:6],
        (given[6:15], given[15:24]),
        given[24:-5],
        given[-5:],
    )
    linear, oblique, closing, torques, impulse = _errors(contact, bodies, outside, rule, law, known.pinned, eps)
    lacking: Any = False
    approach: Any = True
    if not known.all:
        # Without a position the lever arm is unknown, which matters for a body that can turn or is turning.
        beyond_central = any(known.pinned) or known.outside
        for body, torque, placed, weighed in zip(bodies, torques, known.places, known.inertias, strict=True):
            _, inertia, _, _, spin, x, y, *_ = body
            if not placed:
                approach = approach & (spin == 0.0)
                lacking = lacking | ((inertia < inf) | (spin != 0.0) if weighed else True)
            elif not weighed:
                # Solved with infinite inertia: if there is no torque then, the true inertia does not matter.
                lever = _LEVER * eps * (abs(x) + abs(y) + abs(contact[4]) + abs(contact[5]))
                lever = select(lever < _LONGEST, lever, _LONGEST)
                lacking = lacking | ((torque <= lever * impulse) ^ True)
        if beyond_central:
            lacking = True
        apart = approach & ((closing > 0.0) ^ True)
        lacking = lacking & (apart ^ True)
        unknown = inf if beyond_central else nan
        linear, oblique = select(lacking, unknown, linear), select(lacking, unknown, oblique)
        lacking = apart ^ True
    within = tolerance > 0.0
    which = select(lacking, LACKING, ECCENTRIC)
    which = select(within & (_MARGIN * oblique <= tolerance), OBLIQUE, which)
    return select(within & (_MARGIN * linear <= tolerance), LINEAR, which), linear, oblique


def _errors(
    contact: tuple[Any, ...],
    bodies: tuple[Any, Any],
    outside: tuple[Any, ...],
    rule: str,
    law: str,
    pinned: tuple[bool, bool],
    eps: float,
) -> tuple[Any, Any, Any, tuple[Any, ...], Any]:
    """Errors of the linear and the oblique model for the worse of both bodies; closing speed; torques on A and B; impulse.

    The errors are NaN where the eccentric model has no answer, infinite where the cheaper one has none, as with a pivot or an
    impulse from outside. The
    torques are sizes, and so is the impulse: together with those of the impulse without slip where that decides the ratio.
    """
    answered, closing, (normal, tangential_impulse), no_slip, for_a, for_b = _eccentric(
        *contact, *bodies[0], *bodies[1], rule, law, *pinned, eps, impulse_only=True, outside=outside or None
    )
    torques: tuple[Any, ...] = (abs(for_a[2]), abs(for_b[2]))
    impulse = abs(normal) + abs(tangential_impulse)
    if rule == CRITICAL_FRACTION:
        matters = contact[3] > 0.0
        torques = tuple(
            torque + select(matters, abs(body[3]), 0.0) for torque, body in zip(torques, (for_a, for_b), strict=True)
        )
        impulse = impulse + select(matters, abs(no_slip[0]) + abs(no_slip[1]), 0.0)
    beyond: Any = select(answered, inf, nan)
    if any(pinned) or outside:
        return beyond, beyond, closing, torques, impulse
    # Mass, velocity and yaw rate of each body.
    point_masses = *bodies[0][:1], *bodies[0][2:5], *bodies[1][:1], *bodies[1][2:5]
    central, pulls, central_normal, central_tangential = _oblique(
        *contact[:4], *point_masses, rule, law, True, eps, impulse_only=True
    )
    off_normal = normal - central_normal
    worst = []
    # Both central models have the same normal impulse, and the linear one no other.
    for off_tangential in (tangential_impulse, tangential_impulse - central_tangential):
        squared = [
            # The last term is (radius of gyration times change of yaw rate) squared.
            _square(a * off_normal) + _square(a * off_tangential) + (a * torque) * (b * torque)
            for a, b, torque, _ in (for_a, for_b)
        ]
        worst.append(larger(*squared) ** 0.5)
    linear = select(answered & central, worst[0], beyond)
    oblique = select(answered & central & (pulls ^ True), worst[1], beyond)
    return linear, oblique, closing, torques, impulse


def _square(value: Any) -> Any:
    return value * value

"""Predicts the error of each central model and picks the cheapest within the tolerance.

Only the impulse at the contact is needed. The error, in m/s, is the hypot of the error of the
delta-V vector and of the radius of gyration times the error of the change of yaw rate.
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
# Safety factor on a predicted error, so that the true error stays within the tolerance where the
# prediction is too small.
_MARGIN = 1.15
# A lever of so many eps of the coordinates may be rounding: of angles up to a turn, of what they
# were made from, and of slip. But not more than this, in m: in float32 far from the origin it would
# take a real one for rounding.
_LEVER, _LONGEST = 16.0, 1e-4
LINEAR, OBLIQUE, ECCENTRIC, LACKING = range(4)


class Known(NamedTuple):
    """What is known: positions of A and B relative to the contact, their yaw inertias, everything
    needed; and who is pinned.

    ``outside`` says whether there are impulses from outside, whose numbers then stand before the
    tolerance.
    """

    places: tuple[bool, bool]
    inertias: tuple[bool, bool]
    all: bool
    pinned: tuple[bool, bool]
    outside: bool = False


def least_model(*given: Any) -> tuple[Any, Any, Any]:
    """Number of the cheapest model within the tolerance, and the errors of the linear and the
    oblique model.

    The arguments are six numbers of the contact, nine of each body (unknown ones filled in so that
    they make no torque), the tolerance, rule, law, ``Known``, and eps. LACKING is the eccentric
    model where it lacks something, unless it is known that the bodies do not approach; with a pivot
    or an impulse from outside every input is needed.
    """
    contact, bodies, outside = given[:6], (given[6:15], given[15:24]), given[24:-5]
    tolerance, rule, law, known, eps = given[-5:]
    answered, closing, impulse, no_slip, *of_bodies = _eccentric(
        *contact,
        *bodies[0],
        *bodies[1],
        rule,
        law,
        *known.pinned,
        eps,
        impulse_only=True,
        outside=outside or None,
    )
    beyond_central = any(known.pinned) or known.outside
    linear = oblique = select(answered, inf, nan)
    if not beyond_central:
        linear, oblique = _errors(contact, bodies, rule, law, eps, answered, impulse, of_bodies)
    lacking: Any = False
    if not known.all:
        approach: Any = True
        # Where the impulse without slip decides the ratio, it counts too.
        counts = contact[3] > 0.0 if rule == CRITICAL_FRACTION else False
        size = (
            abs(impulse[0])
            + abs(impulse[1])
            + select(counts, abs(no_slip[0]) + abs(no_slip[1]), 0.0)
        )
        bodies_known = zip(bodies, of_bodies, known.places, known.inertias, strict=True)
        for (_, inertia, _, _, spin, x, y, *_), (
            _,
            _,
            torque,
            no_slip_torque,
        ), placed, weighed in bodies_known:
            if not placed:
                # Without a position the lever arm is unknown, which matters for a body that can
                # turn or is turning.
                approach = approach & (spin == 0.0)
                lacking = lacking | ((inertia < inf) | (spin != 0.0) if weighed else True)
            elif not weighed:
                # Solved with infinite inertia: if there is no torque then, the true inertia does
                # not matter.
                lever = _LEVER * eps * (abs(x) + abs(y) + abs(contact[4]) + abs(contact[5]))
                lever = select(lever < _LONGEST, lever, _LONGEST)
                turning = abs(torque) + select(counts, abs(no_slip_torque), 0.0)
                lacking = lacking | ((turning <= lever * size) ^ True)
        apart = approach & ((closing > 0.0) ^ True)
        lacking = (True if beyond_central else lacking) & (apart ^ True)
        unknown = inf if beyond_central else nan
        linear, oblique = select(lacking, unknown, linear), select(lacking, unknown, oblique)
        lacking = apart ^ True
    within = tolerance > 0.0
    which = select(lacking, LACKING, ECCENTRIC)
    which = select(within & (_MARGIN * oblique <= tolerance), OBLIQUE, which)
    return select(within & (_MARGIN * linear <= tolerance), LINEAR, which), linear, oblique


def _errors(
    contact: Any,
    bodies: tuple[Any, Any],
    rule: str,
    law: str,
    eps: float,
    answered: Any,
    impulse: Any,
    of_bodies: Any,
) -> tuple[Any, Any]:
    """Errors of the linear and the oblique model for the worse of both bodies, from what the
    eccentric model answered.

    The errors are NaN where the eccentric model has no answer, infinite where the cheaper one has
    none.
    """
    # Mass, velocity and yaw rate of each body.
    point_masses = *bodies[0][:1], *bodies[0][2:5], *bodies[1][:1], *bodies[1][2:5]
    central, pulls, normal, tangential = _oblique(
        *contact[:4], *point_masses, rule, law, True, eps, impulse_only=True
    )
    off_normal = impulse[0] - normal
    worst = []
    # Both central models have the same normal impulse, and the linear one no other.
    for off_tangential in (impulse[1], impulse[1] - tangential):
        squared = [
            # The last term is (radius of gyration times change of yaw rate) squared.
            _square(a * off_normal) + _square(a * off_tangential) + (a * torque) * (b * torque)
            for a, b, torque, _ in of_bodies
        ]
        worst.append(larger(*squared) ** 0.5)
    beyond = select(answered, inf, nan)
    return select(answered & central, worst[0], beyond), select(
        answered & central & (pulls ^ True), worst[1], beyond
    )


def _square(value: Any) -> Any:
    return value * value

"""The impulse of tyres during a contact that is taken as an instant: the mean force of their
wheels, times its duration.
"""

from typing import Any, NamedTuple

from .contact_step import Body, Motion, Rolling, braked
from .elementwise import select
from .time_resolved import scaled
from .tyre import Tyres


class Held(NamedTuple):
    """Impulse of the tyres of one vehicle along x and y, and its moment about the
    centre of mass.
    """

    x: Any
    y: Any
    yaw: Any


# By Simpson's rule: before the contact, at half of its time, and after it.
_WEIGHTS = (1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0)
# On the mean the wheels of a vehicle have together no more than what stops it from the faster of
# its motions before and after: at each of these moments no more than so many times what would stop
# it then, times the faster over the sum of both. That is twice for one that the contact sets in
# motion, once for one that it leaves as it is. On the mean of slow impacts half as much, twice as
# much and no limit err by more (tests/travel/test_tyres_in_contact.py).
STOPS = 2.0
# The inputs of ``held`` before its settings, those of the tyres last.
NUMBERS = 13 + len(Tyres._fields) - 1 + 4


def held(*inputs: Any) -> Held:
    """The impulse of the wheels of one vehicle, from numbers and, at the end, the settings of its
    wheels.

    The numbers are mass, cosine and sine of the heading, velocity and yaw rate before, their
    changes, the share of the change at half of the time, the duration, gravity, ``STOPS`` or
    another limit in place of it, and those of ``Tyres`` with their four locks first.
    """
    mass, cos, sin, vx, vy, spin, dvx, dvy, dw, half, duration, gravity, stops, *rest = inputs
    *numbers, steered, transfers = rest
    tyres = Tyres(tuple(numbers[:4]), *numbers[4:])
    wheels = Rolling(steered, transfers)
    body = scaled(Body(1.0 / mass, 0.0, 0.0, 0.0), (cos, sin), 1.0, 1.0, gravity, tyres)
    begun, ended = (
        _speed_of_wheels(tyres, *motion)
        for motion in ((vx, vy, spin), (vx + dvx, vy + dvy, spin + dw))
    )
    faster, both = select(begun > ended, begun, ended), begun + ended
    share = select(both > 0.0, faster / select(both > 0.0, both, 1.0), 0.0)
    body = body._replace(cap=stops * share * body.cap)
    x: Any = 0.0
    y: Any = 0.0
    yaw: Any = 0.0
    for weight, share in zip(_WEIGHTS, (0.0, half, 1.0), strict=True):
        motion = Motion(vx + share * dvx, vy + share * dvy, spin + share * dw)
        after = braked(body, motion, duration, wheels)
        x, y, yaw = (
            x + weight * after.tyre_x,
            y + weight * after.tyre_y,
            yaw + weight * after.tyre_yaw,
        )
    return Held(x, y, yaw)


def _speed_of_wheels(tyres: Tyres, vx: Any, vy: Any, spin: Any) -> Any:
    """The root of the mean square of the speeds of the four wheels."""
    reach = tyres.ahead * tyres.ahead + tyres.left * tyres.left
    return (vx * vx + vy * vy + reach * spin * spin) ** 0.5

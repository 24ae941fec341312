"""What the central models err by, found from the impulse at the contact alone, without the rest of the eccentric answer.

An error is that of the delta-V vector and, times the radius of gyration, of the change of yaw rate: hypot of both, in m/s.
"""

from collections.abc import Callable
from math import inf, nan
from typing import Any, NamedTuple

from .codes import AT, ENERGY_GAIN, EPS, OUT_OF_RANGE
from .eccentric import eccentric, recoil
from .linear import linear_central
from .oblique import oblique_central
from .select import select

_eccentric: Callable[..., tuple[Any, ...]] = eccentric
# What a predicted error counts for, so that an answer stays within the tolerance where a prediction falls short.
_MARGIN = 1.15
# A lever of so many eps of the coordinates may be rounding: of angles up to a turn, of what they were made from, and of slip.
_ROUNDING = 16.0
LINEAR, OBLIQUE, ECCENTRIC, LACKING = range(4)


class Known(NamedTuple):
    """Whether the places of both bodies beside the contact are known, their yaw inertias, all that is needed, and any pivot."""

    places: tuple[bool, bool]
    inertias: tuple[bool, bool]
    all: bool
    pinned: tuple[bool, bool]


def least_model(*given: Any) -> tuple[Any, Any, Any]:
    """Which model is the least within the tolerance, by number, and what the linear and the oblique one err by.

    Given are six numbers of the contact, nine of each body (those that are not known filled in so that they make no torque),
    the tolerance, rule, law, what is known, and eps. LACKING is the eccentric model where it lacks something, unless it is
    known that the bodies do not approach; beside a pivot nothing may be lacking.
    """
    restitution, nx, ny, tangential, px, py = given[:6]
    bodies, tolerance = (given[6:15], given[15:24]), given[24]
    rule, law, known, eps = given[25:]
    linear, oblique, torques, impulse = shortfalls(
        restitution, nx, ny, tangential, px, py, *bodies, rule, law, known.pinned[0], known.pinned[1], eps
    )
    if any(known.pinned):
        # The central models cannot hold a pivot.
        linear, oblique = (select(error == error, inf, nan) for error in (linear, oblique))
    lacking: Any = False
    approach: Any = True
    if not known.all:
        # Without a place the lever is open, which matters to what can turn or does.
        for body, torque, placed, weighed in zip(bodies, torques, known.places, known.inertias, strict=True):
            _, inertia, _, _, spin, x, y, *_ = body
            if not placed:
                approach = approach & (spin == 0.0)
                lacking = lacking | ((inertia < inf) | (spin != 0.0) if weighed else True)
            elif not weighed:
                # No torque on a body that could not turn: none on one that can.
                size = (abs(x) + abs(y) + abs(px) + abs(py)) * impulse
                lacking = lacking | ((abs(torque) <= _ROUNDING * eps * size) ^ True)
        closing = closing_speed(nx, ny, px, py, *bodies)
        apart = approach & ((closing > 0.0) ^ True)
        lacking = lacking & (apart ^ True)
        linear, oblique = select(lacking, nan, linear), select(lacking, nan, oblique)
        lacking = apart ^ True
    within = tolerance > 0.0
    which = select(lacking, LACKING, ECCENTRIC)
    which = select(within & (_MARGIN * oblique <= tolerance), OBLIQUE, which)
    return select(within & (_MARGIN * linear <= tolerance), LINEAR, which), linear, oblique


def closing_speed(nx: Any, ny: Any, px: Any, py: Any, body_a: tuple[Any, ...], body_b: tuple[Any, ...]) -> Any:
    """Speed at which the contact points of free bodies approach along the normal."""
    (_, _, vx_a, vy_a, spin_a, x_a, y_a, *_), (_, _, vx_b, vy_b, spin_b, x_b, y_b, *_) = body_a, body_b
    ux = (vx_a - vx_b) + (spin_b * (py - y_b) - spin_a * (py - y_a))
    uy = (vy_a - vy_b) + (spin_a * (px - x_a) - spin_b * (px - x_b))
    return nx * ux + ny * uy


def shortfalls(
    restitution: Any,
    nx: Any,
    ny: Any,
    tangential: Any,
    px: Any,
    py: Any,
    body_a: tuple[Any, ...],
    body_b: tuple[Any, ...],
    rule: str,
    law: str,
    pinned_a: bool,
    pinned_b: bool,
    eps: float = EPS,
) -> tuple[Any, Any, tuple[Any, Any], Any]:
    """Error of the linear and of the oblique model, each for the worse of both bodies; the torques on A and B; the impulse.

    NaN where the eccentric model has no answer, infinite where the cheaper one has none.
    """
    answered, normal, tangential_impulse, for_a, for_b = _eccentric(
        restitution, nx, ny, tangential, px, py, *body_a, *body_b, rule, law, pinned_a, pinned_b, eps, impulse_only=True
    )
    impulse_x = nx * normal - ny * tangential_impulse
    impulse_y = ny * normal + nx * tangential_impulse
    (mass_a, _, vx_a, vy_a, *_), (mass_b, _, vx_b, vy_b, *_) = body_a, body_b
    velocities = (mass_a, vx_a, vy_a, mass_b, vx_b, vy_b)
    models = (
        linear_central(restitution, nx, ny, *velocities, eps),
        oblique_central(restitution, nx, ny, tangential, *velocities, rule, law, eps),
    )
    worst: list[Any] = [0.0, 0.0]
    for body, pinned, (torque, a, b), sign, at in (
        (body_a, pinned_a, for_a, -1.0, AT["delta_vx_a"]),
        (body_b, pinned_b, for_b, 1.0, AT["delta_vx_b"]),
    ):
        mass, inertia, _, _, _, x, y, pivot_x, pivot_y = body
        dvx, dvy, spin = recoil(a, b, torque, sign * impulse_x, sign * impulse_y, x, y, pivot_x, pivot_y, pinned)
        turning = select(spin == 0.0, 0.0, spin * spin * (inertia / mass))
        for i, model in enumerate(models):
            off_x, off_y = dvx - model[at], dvy - model[at + 1]
            error = (off_x * off_x + off_y * off_y + turning) ** 0.5
            worst[i] = select(error >= worst[i], error, worst[i])
    linear, oblique = (
        select(answered, select(model[0] > ENERGY_GAIN, inf, error), nan) for model, error in zip(models, worst, strict=True)
    )
    return linear, oblique, (for_a[0], for_b[0]), abs(normal) + abs(tangential_impulse)


def linear_carried(restitution: Any, nx: Any, ny: Any, *rest: Any) -> tuple[Any, ...]:
    """Answers of the linear model in the order of ``codes.OUTPUTS``, with the slip of what it carries through."""
    status, closing, _, _, *others = linear_central(restitution, nx, ny, *rest)
    _, vx_a, vy_a, _, vx_b, vy_b, *_ = rest
    slip = ny * (vx_a - vx_b) - nx * (vy_a - vy_b)
    finite = slip - slip == 0.0
    return select((status > ENERGY_GAIN) | finite, status, OUT_OF_RANGE), closing, slip, slip, *others

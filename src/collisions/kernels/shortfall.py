"""What the central models err by, found from the impulse at the contact alone, without the rest of the eccentric answer.

An error is that of the delta-V vector and, times the radius of gyration, of the change of yaw rate: hypot of both, in m/s.
"""

from collections.abc import Callable
from math import inf, nan
from typing import Any

from .codes import AT, ENERGY_GAIN, EPS
from .eccentric import eccentric, recoil
from .linear import linear_central
from .oblique import oblique_central
from .select import select

_eccentric: Callable[..., tuple[Any, ...]] = eccentric


def shortfalls_of(*given: Any) -> tuple[Any, ...]:
    """``shortfalls`` of free bodies, its arguments in a row: six of the contact, nine of each body, rule and law."""
    restitution, nx, ny, tangential, px, py = given[:6]
    rule, law = given[24:]
    return shortfalls(restitution, nx, ny, tangential, px, py, given[6:15], given[15:24], rule, law, False, False)


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
) -> tuple[Any, Any, Any, Any]:
    """Error of the linear and of the oblique model, each for the worse of both bodies, and the torques on A and B.

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
    return linear, oblique, for_a[0], for_b[0]

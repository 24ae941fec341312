"""What a cost is measured against: a plain formula, a plain record, and what else a user could take
(numba, pymunk).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from types import ModuleType
from typing import Any

import numpy as np


@dataclass(frozen=True, slots=True, kw_only=True)
class Bare:
    """The fields of a Vehicle, and nothing checked."""

    mass: float
    vx: float = 0.0
    vy: float = 0.0
    yaw_rate: float = 0.0
    yaw_inertia: float | None = None
    x: float | None = None
    y: float | None = None
    heading: float | None = None
    pivot: tuple[float, float] | None = None
    name: str = ""


def formula(
    m1, i1, vx1, vy1, w1, x1, y1, m2, i2, vx2, vy2, w2, x2, y2, e, normal, px, py, friction
):
    """Planar impact mechanics with Coulomb friction, as one writes it for floats: no checks, no
    units, no names.

    Squares are products: ``x**2`` calls pow, which takes Python several times as long, and flatters
    what is compared with it.
    """
    nx, ny = math.cos(normal), math.sin(normal)
    rx1, ry1, rx2, ry2 = px - x1, py - y1, px - x2, py - y2
    ux = (vx2 - w2 * ry2) - (vx1 - w1 * ry1)
    uy = (vy2 + w2 * rx2) - (vy1 + w1 * rx1)
    un, ut = ux * nx + uy * ny, uy * nx - ux * ny
    rn1, rt1 = rx1 * nx + ry1 * ny, ry1 * nx - rx1 * ny
    rn2, rt2 = rx2 * nx + ry2 * ny, ry2 * nx - rx2 * ny
    knn = 1 / m1 + 1 / m2 + rt1 * rt1 / i1 + rt2 * rt2 / i2
    ktt = 1 / m1 + 1 / m2 + rn1 * rn1 / i1 + rn2 * rn2 / i2
    knt = -(rn1 * rt1 / i1 + rn2 * rt2 / i2)
    if not un < 0:
        none = math.nan
        return none, none, none, none, none, none, none, none, none
    vn = -(1 + e) * un
    det = knn * ktt - knt * knt
    pn = (ktt * vn + knt * ut) / det
    pt = -(knt * vn + knn * ut) / det
    if pn <= 0 or abs(pt) > friction * pn:
        mu = -friction if pt < 0 else friction
        pn = vn / (knn + mu * knt)
        pt = mu * pn
    fx, fy = pn * nx - pt * ny, pn * ny + pt * nx
    ax1, ay1, aw1 = vx1 - fx / m1, vy1 - fy / m1, w1 - (rx1 * fy - ry1 * fx) / i1
    ax2, ay2, aw2 = vx2 + fx / m2, vy2 + fy / m2, w2 + (rx2 * fy - ry2 * fx) / i2
    before = (
        m1 * (vx1 * vx1 + vy1 * vy1) + i1 * w1 * w1 + m2 * (vx2 * vx2 + vy2 * vy2) + i2 * w2 * w2
    )
    after = (
        m1 * (ax1 * ax1 + ay1 * ay1)
        + i1 * aw1 * aw1
        + m2 * (ax2 * ax2 + ay2 * ay2)
        + i2 * aw2 * aw2
    )
    return ax1, ay1, aw1, ax2, ay2, aw2, pn, pt, (before - after) / 2


def numbers(scene: dict[str, Any]) -> tuple[Any, ...]:
    """What the formula takes, from a scene of batch_speed.py."""
    names = ("mass", "yaw_inertia", "vx", "vy", "yaw_rate", "x", "y")
    bodies = [scene[side][name] for side in "ab" for name in names]
    return (*bodies, scene["restitution"], scene["normal"], *scene["point"], scene["friction"])


def installed(name: str) -> ModuleType | None:
    """The module, or None where it is not installed."""
    try:
        return import_module(name)
    except ImportError:
        return None


def jitted(numba: ModuleType, parallel: bool) -> Callable[..., Any]:
    """The formula over arrays, compiled by numba: a million cases in a loop."""
    one = numba.njit(formula, error_model="numpy")
    prange = numba.prange

    def loop(
        m1, i1, vx1, vy1, w1, x1, y1, m2, i2, vx2, vy2, w2, x2, y2, e, normal, px, py, friction
    ):
        found = np.empty((9, len(m1)))
        for k in prange(len(m1)):
            (
                found[0, k], found[1, k], found[2, k], found[3, k], found[4, k],
                found[5, k], found[6, k], found[7, k], found[8, k],
            ) = one(
                m1[k], i1[k], vx1[k], vy1[k], w1[k], x1[k], y1[k], m2[k], i2[k], vx2[k], vy2[k],
                    w2[k], x2[k], y2[k],
                e[k], normal[k], px[k], py[k], friction[k],
            )  # fmt: skip
        return found

    return numba.njit(loop, parallel=parallel, error_model="numpy")


# Radius of the round noses that make the contact be where it is wanted, and a step in which nothing
# moves.
NOSE, STEP = 0.05, 1e-9


def stepped(pymunk: ModuleType, case: tuple[float, ...]) -> tuple[float, ...]:
    """Velocities and yaw rates after one step of a physics engine for games, for the numbers of the
    formula.

    It has no contact point or normal to be given: two small circles, one on each body, touch where
    and how it is wanted. Friction and restitution of a contact are the products of those of both
    shapes.
    """
    m1, i1, vx1, vy1, w1, x1, y1, m2, i2, vx2, vy2, w2, x2, y2, e, normal, px, py, friction = case
    nx, ny = (1.0 - 1e-9) * NOSE * math.cos(normal), (1.0 - 1e-9) * NOSE * math.sin(normal)
    space = pymunk.Space()
    bodies = []
    for m, i, vx, vy, w, x, y, side, own_e, own_friction in (
        (m1, i1, vx1, vy1, w1, x1, y1, -1.0, 1.0, 1.0),
        (m2, i2, vx2, vy2, w2, x2, y2, 1.0, e, friction),
    ):
        body = pymunk.Body(m, i)
        body.position, body.velocity, body.angular_velocity = (x, y), (vx, vy), w
        nose = pymunk.Circle(body, NOSE, (px + side * nx - x, py + side * ny - y))
        nose.elasticity, nose.friction = own_e, own_friction
        space.add(body, nose)
        bodies.append(body)
    space.step(STEP)
    return tuple(number for body in bodies for number in (*body.velocity, body.angular_velocity))

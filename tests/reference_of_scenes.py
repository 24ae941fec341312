"""Whole scenes integrated by other means: scipy's integration of each vehicle, a grid of times and
bisection for touches, and polygons cut edge by edge.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import collisions as col
from collisions.scene import Contact, Mover
from collisions.travel import GRAVITY, Tyres

State = Any
_STANDING = 0.02


def _counted(speed: Any) -> Any:
    return np.where(speed < _STANDING, (_STANDING + speed**2 / _STANDING) / 2.0, speed)


def _accelerations(state: State, tyres: Tyres, body: col.Vehicle) -> tuple[float, float, float]:
    """Of the centre of mass and in yaw, as the docstring of ``Tyres`` has the forces."""
    _, _, heading, vx, vy, w = state
    a = np.array([1, 1, -1, -1]) * tyres.wheelbase / 2
    b = np.array([1, -1, 1, -1]) * tyres.track / 2
    c, s = math.cos(heading), math.sin(heading)
    speed = math.sqrt(vx**2 + vy**2 + (w * math.hypot(a[0], b[0])) ** 2)
    forward, left = (c * vx + s * vy - w * b) / speed, (c * vy - s * vx + w * a) / speed
    lock = np.array(tyres.locks)
    x = np.clip(forward / _counted(np.hypot(forward, left)), -lock, lock)
    with np.errstate(divide="ignore", invalid="ignore"):
        z = np.fmin(1.0, tyres.cornering * np.abs(left / forward) / (3.0 * tyres.friction))
    most = np.minimum(np.sqrt(np.maximum(0.0, 1.0 - x**2)), 1.0 - (1.0 - z) ** 3)
    y = np.sign(left) * np.minimum(most, np.abs(left) / _counted(np.abs(left)))
    pull = -tyres.friction * GRAVITY / 4.0
    ahead, aside = pull * x, pull * y
    yaw = float(np.sum(a * aside - b * ahead)) * body.mass / body.yaw_inertia
    return (
        float(c * ahead.sum() - s * aside.sum()),
        float(s * ahead.sum() + c * aside.sum()),
        yaw,
    )


def motion(
    mover: Mover, state: State, begin: float, rtol: float = 1e-9
) -> tuple[Callable[[float], State], float]:
    """The state at any time from ``begin`` on, and the time of rest."""
    tyres, body = mover.tyres, mover.vehicle
    speed = math.hypot(state[3], state[4], state[5])
    if tyres is None or speed == 0.0:

        def unslowed(time: float) -> State:
            return np.array([*(state[:3] + (time - begin) * state[3:]), *state[3:]])

        return unslowed, begin if speed == 0.0 else math.inf
    reach = math.hypot(tyres.wheelbase, tyres.track) / 2

    def size(now: State) -> float:
        return math.hypot(now[3], now[4], reach * now[5])

    first = size(state)

    def slow(_: float, now: State) -> float:
        return size(now) - 2e-3 * first

    vars(slow)["terminal"] = True
    end = solve_ivp(
        lambda _, now: [*now[3:], *_accelerations(now, tyres, body)],
        (begin, begin + 200.0),
        state,
        rtol=rtol,
        atol=0.1 * rtol,
        events=slow,
        dense_output=True,
        max_step=0.05,
    )
    assert end.status == 1
    last, at = end.y[:, -1], float(end.t[-1])
    forces = np.array(_accelerations(last, tyres, body))
    weights = np.array([1.0, 1.0, reach**2])
    left = -float((weights * last[3:] ** 2).sum() / (weights * last[3:] * forces).sum())

    def slowed(time: float) -> State:
        if time <= at:
            return end.sol(time)
        share = min((time - at) / left, 1.0)
        places = last[:3] + last[3:] * left * (share - 0.5 * share * share)
        return np.array([*places, *((1.0 - share) * last[3:])])

    return slowed, at + left


def corners(mover: Mover, state: State) -> list[tuple[float, float]]:
    c, s = math.cos(state[2]), math.sin(state[2])
    return [(state[0] + c * x - s * y, state[1] + s * x + c * y) for x, y in mover.outline.tolist()]


def cut(one: list[tuple[float, float]], other: list[tuple[float, float]]) -> list[Any]:
    """The part of a polygon within another, edge by edge (Sutherland and Hodgman)."""
    found = one
    for (x0, y0), (x1, y1) in pairwise([*other, other[0]]):
        sides = [(x1 - x0) * (y - y0) - (y1 - y0) * (x - x0) for x, y in found]
        kept: list[Any] = []
        pairs = zip(found, found[1:] + found[:1], sides, sides[1:] + sides[:1], strict=True)
        for p, q, d, e in pairs:
            if d >= 0.0:
                kept.append(p)
            if (d >= 0.0) != (e >= 0.0):
                part = d / (d - e)
                kept.append((p[0] + part * (q[0] - p[0]), p[1] + part * (q[1] - p[1])))
        found = kept
        if not found:
            return []
    return found


def area_and_centre(polygon: list[Any]) -> tuple[float, tuple[float, float]]:
    if len(polygon) < 3:
        return 0.0, (math.nan, math.nan)
    x0, y0 = polygon[0]
    area = mx = my = 0.0
    for (x1, y1), (x2, y2) in pairwise(polygon[1:]):
        part = 0.5 * ((x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0))
        area += part
        mx += part * (x0 + x1 + x2) / 3.0
        my += part * (y0 + y1 + y2) / 3.0
    return area, (mx / area, my / area) if area else (math.nan, math.nan)


def gaps(a: Mover, b: Mover, state_a: State, state_b: State) -> list[tuple[float, Any]]:
    """The gap along each face of either, and its normal from A into B."""
    found = []
    pa, pb = corners(a, state_a), corners(b, state_b)
    for polygon, sign in ((pa, 1.0), (pb, -1.0)):
        for (x0, y0), (x1, y1) in zip(polygon, polygon[1:] + polygon[:1], strict=True):
            length = math.hypot(x1 - x0, y1 - y0)
            n = sign * (y1 - y0) / length, -sign * (x1 - x0) / length
            far = max(n[0] * x + n[1] * y for x, y in pa)
            near = min(n[0] * x + n[1] * y for x, y in pb)
            found.append((near - far, n))
    return found


def follow(
    movers: dict[str, Mover], contact: Contact, until: float = 3.0, step: float = 2e-3
) -> dict[str, Any] | None:
    """One touch of two vehicles and the rest of all; None if they do not touch, or glance."""
    start = {
        name: np.array(
            [getattr(m.vehicle, one) for one in ("x", "y", "heading", "vx", "vy", "yaw_rate")]
        )
        for name, m in movers.items()
    }
    ways = {name: motion(movers[name], start[name], 0.0) for name in movers}
    a, b = movers[contact.a], movers[contact.b]

    def gap(time: float) -> float:
        return max(g for g, _ in gaps(a, b, ways[contact.a][0](time), ways[contact.b][0](time)))

    times = np.arange(0.0, until, step)
    touching = next((i for i, time in enumerate(times) if gap(time) <= 0.0), None)
    if touching is None or touching == 0:
        return None
    touch = brentq(gap, times[touching - 1], times[touching], xtol=1e-13)
    at = touch + 0.03
    states = {name: ways[name][0](at) for name in movers}
    then = gaps(a, b, ways[contact.a][0](touch), ways[contact.b][0](touch))
    best = max(g for g, _ in then)
    now = gaps(a, b, states[contact.a], states[contact.b])
    _, normal = max(
        (one for one, before in zip(now, then, strict=True) if before[0] >= best - 1e-6),
        key=lambda one: one[0],
    )
    _, centre = area_and_centre(cut(corners(a, states[contact.a]), corners(b, states[contact.b])))
    if math.isnan(centre[0]):
        return None  # they have parted by then

    def body(name: str) -> col.Vehicle:
        x, y, heading, vx, vy, yaw_rate = (float(part) for part in states[name])
        return movers[name].vehicle.replace(
            x=x, y=y, heading=math.remainder(heading, math.tau), vx=vx, vy=vy, yaw_rate=yaw_rate
        )

    impact = col.eccentric(
        body(contact.a),
        body(contact.b),
        contact.restitution,
        normal=normal,
        point=centre,
        friction=contact.friction,
        on_failure="nan",
    )
    if not impact.ok:
        return None
    for name, side in ((contact.a, impact.a), (contact.b, impact.b)):
        states[name][3:] = side.after.vx, side.after.vy, side.after.yaw_rate
        ways[name] = motion(movers[name], states[name], at)
    rests = {name: way(1e6 if math.isfinite(end) else at) for name, (way, end) in ways.items()}
    return {"time": at, "impact": impact, "rest": rests, "begin": states}

"""An independent evaluation of a planar impact in 60 digits, and the scales its accuracy is measured by.

Written from the equations of section 1 of the numerics note in the most direct way (assemble K, solve the two equations, take
kinetic energies before and after), and not from the code of the package: with 60 digits the textbook forms are good enough.
Inputs are floats taken as exact. As the note asks, the data are the *differences* v2 - v1, c - x, c - O and x - O, each one
rounded subtraction; everything after them is exact here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from typing import Any

import mpmath

EPS = 2.0**-52


@dataclass(frozen=True)
class Body:
    """One body before the impact, in plain floats."""

    mass: float
    inertia: float
    vx: float = 0.0
    vy: float = 0.0
    spin: float = 0.0
    x: float = 0.0
    y: float = 0.0
    pivot: tuple[float, float] | None = None
    heading: float = 0.0


@dataclass(frozen=True)
class Scene:
    """A whole question: ``normal`` is an angle or a vector, ``rule`` one of friction, impulse_ratio, critical_fraction."""

    a: Body
    b: Body
    restitution: float
    normal: float | tuple[float, float]
    point: tuple[float, float]
    rule: str
    value: float
    law: str


@dataclass(frozen=True, repr=False)
class Half:
    """What one body had of it; ``a`` and ``b`` are its 1/m (0 if pinned) and 1/I, ``r`` and ``arm`` lengths of its levers."""

    dvx: Any
    dvy: Any
    dw: Any
    vx: Any
    vy: Any
    w: Any
    pivot_x: Any
    pivot_y: Any
    pdof: Any
    impulse_x: Any
    impulse_y: Any
    energy_change: Any
    a: Any
    b: Any
    r: Any
    arm: Any
    speed: Any
    mobility: Any


@dataclass(frozen=True, repr=False)
class Answer:
    """What the reference found; ``refused`` is None or the label of section 9, and ``spread`` is kappa times S_P."""

    refused: str | None
    closing: Any = None
    slip: Any = None
    slip_after: Any = None
    pn: Any = None
    pt: Any = None
    loss: Any = None
    loss_n: Any = None
    loss_t: Any = None
    regime: str = ""
    critical: Any = None
    no_slip: Any = None
    common_velocity: Any = None
    k_nn: Any = None
    k_nt: Any = None
    k_tt: Any = None
    det: Any = None
    s_u: Any = None
    kappa_mu: Any = None
    kappa_s: Any = None
    s_p: Any = None
    spread: Any = None
    no_slip_spread: Any = None
    resistance: Any = None
    a: Half | None = None
    b: Half | None = None


# Below this part of the trace (squared for the determinant) K cannot be told from a singular one: section 4, item 13.
SINGULAR = (64.0 * EPS) ** 2


@cache
def _context(digits: int) -> Any:
    mp = mpmath.mp.clone()
    mp.dps = digits
    return mp


def evaluate(scene: Scene, digits: int = 60) -> Answer:
    """The answer to a scene, or the label of its refusal."""
    mp = _context(digits)
    num = mp.mpf

    def rotated(v: tuple[Any, Any]) -> tuple[Any, Any]:
        return -v[1], v[0]

    def dot(p: Any, q: Any) -> Any:
        return p[0] * q[0] + p[1] * q[1]

    def length(v: Any) -> Any:
        return mp.sqrt(dot(v, v))

    e = num(scene.restitution)
    if isinstance(scene.normal, tuple):
        raw = num(scene.normal[0]), num(scene.normal[1])
        size = length(raw)
        n = raw[0] / size, raw[1] / size
    else:
        n = mp.cos_sin(num(scene.normal))
    t = rotated(n)

    # The data: floats, subtracted as floats.
    bodies = (scene.a, scene.b)
    own = [(0.0, 0.0) if body.pivot else (body.vx, body.vy) for body in bodies]
    dv = num(own[1][0] - own[0][0]), num(own[1][1] - own[0][1])
    r, arms, share, turn, spins = [], [], [], [], []
    for body in bodies:
        center = body.pivot or (body.x, body.y)
        r.append((num(scene.point[0] - center[0]), num(scene.point[1] - center[1])))
        arm = (num(body.x - center[0]), num(body.y - center[1]))
        arms.append(arm)
        spins.append(num(body.spin))
        if body.pivot:
            share.append(num(0))
            turn.append(1 / (num(body.inertia) + num(body.mass) * dot(arm, arm)))
        else:
            share.append(num(0) if math.isinf(body.mass) else 1 / num(body.mass))
            turn.append(num(0) if math.isinf(body.inertia) else 1 / num(body.inertia))

    q = [rotated(lever) for lever in r]
    u = tuple(dv[i] + spins[1] * q[1][i] - spins[0] * q[0][i] for i in (0, 1))
    closing, slip = -dot(n, u), dot(t, u)

    # K in scene axes, then its components along n and t.
    a = share[0] + share[1]
    xx, yy = (a + sum(turn[k] * q[k][i] * q[k][i] for k in (0, 1)) for i in (0, 1))
    xy = sum(turn[k] * q[k][0] * q[k][1] for k in (0, 1))
    k_n, k_t = ((xx * w[0] + xy * w[1], xy * w[0] + yy * w[1]) for w in (n, t))
    k_nn, k_nt, k_tt = dot(n, k_n), dot(n, k_t), dot(t, k_t)
    det = k_nn * k_tt - k_nt * k_nt
    trace = xx + yy - a  # tr of the note: a + sum b |r|^2
    if k_nn <= SINGULAR * trace:
        return Answer("immovable")
    if closing <= 0:
        return Answer("separating" if closing < 0 else "grazing", closing=closing)
    singular = det <= SINGULAR * trace * trace

    wanted_n, wanted_t = (1 + e) * closing, -(1 + e if scene.law == "kudlich-slibar" else 1) * slip
    no_slip = None
    if not singular:
        no_slip = (k_tt * wanted_n - k_nt * wanted_t) / det, (k_nn * wanted_t - k_nt * wanted_n) / det

    value = None if math.isinf(scene.value) else num(scene.value)
    sticks, ratio = False, num(0)
    if scene.rule == "impulse_ratio":
        regime, ratio = "given", value
    elif scene.value == 0.0:
        regime = "frictionless" if scene.rule == "friction" else "given"
    elif no_slip is None:
        return Answer("singular_contact")
    elif scene.rule == "critical_fraction":
        regime = "given"
        if no_slip[0] <= 0:
            return Answer("no_slip_pulls")
        ratio = value * no_slip[1] / no_slip[0]
    else:
        sticks = no_slip[0] > 0 and (value is None or abs(no_slip[1]) <= value * no_slip[0])
        regime = "sticking" if sticks else "sliding"
        if not sticks and value is None:
            return Answer("no_slip_pulls")
        if not sticks:
            ratio = -value if no_slip[1] < 0 else value
    resistance = k_nn + ratio * k_nt
    if sticks:
        pn, pt = no_slip
    else:
        if resistance <= 0:
            return Answer("ratio_jams")
        pn = wanted_n / resistance
        pt = ratio * pn
    slip_after = slip + k_nt * pn + k_tt * pt
    impulse = tuple(pn * n[i] + pt * t[i] for i in (0, 1))

    halves, common = [], []
    loss = num(0)
    for k, body in enumerate(bodies):
        force = impulse if k else (-impulse[0], -impulse[1])
        dw = turn[k] * (r[k][0] * force[1] - r[k][1] * force[0])
        w = spins[k]
        if body.pivot:
            change = rotated((dw * arms[k][0], dw * arms[k][1]))
            v = rotated((w * arms[k][0], w * arms[k][1]))
            pin = num(body.mass) * change[0] - force[0], num(body.mass) * change[1] - force[1]
        else:
            change = share[k] * force[0], share[k] * force[1]
            v = num(body.vx), num(body.vy)
            pin = num(0), num(0)
        after = v[0] + change[0], v[1] + change[1]
        # Equation 7 needs velocities whose difference is the data: those of A are kept, those of B are A's plus the difference.
        if body.pivot:
            base = v
        elif k:
            base = num(own[0][0]) + dv[0], num(own[0][1]) + dv[1]
        else:
            base = v
        ended = base[0] + change[0], base[1] + change[1]
        energy = dot(force, base) if math.isinf(body.mass) else num(body.mass) * (dot(ended, ended) - dot(base, base)) / 2
        if math.isinf(body.inertia):
            energy += (r[k][0] * force[1] - r[k][1] * force[0]) * w
        else:
            energy += num(body.inertia) * ((w + dw) ** 2 - w * w) / 2
        loss -= energy
        c, s = mp.cos_sin(num(body.heading))
        ahead, aside = c * force[0] + s * force[1], c * force[1] - s * force[0]
        halves.append(
            Half(
                *change, dw, *after, w + dw, *pin, mp.atan2(aside, -ahead), *force, energy,
                share[k], turn[k], length(r[k]), length(arms[k]), length(v), share[k] + turn[k] * dot(r[k], r[k]),
            )
        )  # fmt: skip
        contact = [v[i] + (0 if body.pivot else 1) * w * q[k][i] for i in (0, 1)]
        if body.pivot:
            contact = [w * q[k][i] for i in (0, 1)]
        moved = [(0 if body.pivot else change[i]) + dw * q[k][i] for i in (0, 1)]
        common.append(dot(n, contact) + dot(n, moved) / (1 + e))

    # The scales of section 2.
    s_u = length(dv) + sum(abs(spins[k]) * halves[k].r for k in (0, 1))

    def kappa_of_ratio(mu: Any) -> Any:
        levers = sum(turn[k] * halves[k].r * (abs(dot(t, r[k])) + abs(mu) * halves[k].r) for k in (0, 1))
        return (a + levers) / (k_nn + mu * k_nt)

    cross = r[0][0] * r[1][1] - r[0][1] * r[1][0]
    kappa_s = None if singular else (a * trace + turn[0] * turn[1] * halves[0].r * halves[1].r * abs(cross)) / det
    no_slip_spread = None if singular else kappa_s * (1 + e) * s_u * trace / det
    kappa_mu = None if sticks else kappa_of_ratio(ratio)
    s_p = (1 + e) * s_u * (trace / det if sticks else mp.sqrt(1 + ratio * ratio) / resistance)
    spread = (kappa_s if sticks else kappa_mu) * s_p
    if scene.rule == "critical_fraction" and scene.value:
        # The ratio is itself worked out from the no-slip impulse, known to its own spread; what P makes of that comes on top.
        of_ratio = value * no_slip_spread * (1 + abs(no_slip[1] / no_slip[0])) / no_slip[0]
        spread += of_ratio * pn * (1 + abs(k_nt) * mp.sqrt(1 + ratio * ratio) / resistance)
    critical = None
    if no_slip is not None:
        critical = no_slip[1] / no_slip[0] if no_slip[0] > 0 else mp.inf * (-1 if no_slip[1] < 0 else 1)
    return Answer(
        None, closing, slip, slip_after, pn, pt, loss, (1 - e) * closing * pn / 2, -pt * (slip + slip_after) / 2, regime,
        critical, no_slip, common[0], k_nn, k_nt, k_tt, det, s_u, kappa_mu, kappa_s, s_p, spread, no_slip_spread, resistance,
        halves[0], halves[1],
    )  # fmt: skip

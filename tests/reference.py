"""An independent evaluation of a planar impact in 60 digits, and the scales its accuracy is
measured by.

Written from the equations of section 1 of the numerics note in the most direct way (assemble K,
solve the two equations, take kinetic energies before and after), and not from the code of the
package: with 60 digits the textbook forms are good enough. Inputs are floats taken as exact. As the
note asks, the data are the *differences* v2 - v1, c - x, c - O and x - O, each one rounded
subtraction; everything after them is exact here.
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
    """A whole question: ``normal`` is an angle or a vector, ``rule`` one of friction,
    impulse_ratio, critical_fraction.
    """

    a: Body
    b: Body
    restitution: float
    normal: float | tuple[float, float]
    point: tuple[float, float]
    rule: str
    value: float
    law: str
    # Impulses on A and on B from outside: x, y and yaw at the centre of mass.
    outside: tuple[tuple[float, float, float], tuple[float, float, float]] = (
        (0.0, 0.0, 0.0),
        (0.0, 0.0, 0.0),
    )


@dataclass(frozen=True, repr=False)
class Half:
    """What one body had of it; ``a`` and ``b`` are its 1/m (0 if pinned) and 1/I, ``r`` and ``arm``
    lengths of its levers.
    """

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
    """What the reference found; ``refused`` is None or the label of section 9, and ``spread`` is
    kappa times S_P.
    """

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
    # The speed of parting, the normal impulse of the compression period, and by how much the
    # passage of law "stronge" is conditioned; of impulses from outside the speed they give the
    # contact.
    separation: Any = None
    compression: Any = None
    kappa: Any = None
    s_push: Any = None


@dataclass(frozen=True, repr=False)
class Passage:
    """A contact followed in the impulse from corner to corner, with the slip and the closing speed
    linear in between.

    ``directions`` has a direction (n, t) of the impulse for every stretch, ``stop`` the normal
    impulse at which the slip stopped first, ``top`` the impulse (n, t) and the work along the
    normal at the end of compression.
    """

    pn: Any
    pt: Any
    closing: Any
    slip: Any
    work: Any
    friction: Any
    top: Any
    directions: tuple[Any, ...]
    regime: str


def follow(
    mp: Any, k: tuple[Any, Any, Any], closing: Any, slip: Any, mu: Any, e: Any
) -> Passage | None:
    """Routh's construction: friction against the slip there is, until the part e squared of the
    work has come back.

    For e < 0 it ends before compression does, where that part is still to come. None if no normal
    impulse can act. ``mu`` is None for a friction without bound.
    """
    k_nn, k_nt, k_tt = k
    zero = mp.mpf(0)

    def run(goal: Any) -> Any:
        u, s, pn, pt, work, rubbed, top = closing, slip, zero, zero, zero, zero, None
        directions: list[Any] = []
        stopped = s == 0
        for _ in range(6):
            if s != 0:
                towards = -1 if s > 0 else 1
                n, t = (zero, mp.mpf(towards)) if mu is None else (mp.mpf(1), towards * mu)
            elif mu is None or abs(k_nt) <= mu * k_tt:
                n, t = mp.mpf(1), -k_nt / k_tt
            else:
                n, t = mp.mpf(1), -mu if k_nt > 0 else mu
            holds = s == 0 and t * k_tt == -k_nt
            fall, drift = k_nn * n + k_nt * t, k_nt * n + k_tt * t
            if u <= 0 and pn == 0:
                return None
            events = []
            if s != 0 and drift * s < 0:
                events.append((-s / drift, "stop"))
            if top is None and fall > 0:
                events.append((u / fall, "top"))
            if goal is not None and n > 0 and (e < 0 or top is not None):
                # work + u x - fall x^2 / 2 reaches the goal on the way up (e < 0) or on the way
                # down.
                inside = u * u - 2 * fall * (goal - work)
                if inside >= 0:
                    speed = mp.sqrt(inside) if e < 0 else -mp.sqrt(inside)
                    along = (u - speed) / fall if fall != 0 else (goal - work) / u
                    if along >= 0:
                        events.append((along, "end"))
            step, what = min(events)
            directions.append((n, t))
            work += n * (u - fall * step / 2) * step
            moved = zero if what == "stop" or holds else s + drift * step
            rubbed += abs(t) * step * (abs(s) + abs(moved)) / 2
            pn, pt, u, s = pn + n * step, pt + t * step, u - fall * step, moved
            stopped = stopped or what == "stop"
            if what == "top":
                u, top = zero, (pn, pt, work)
                if goal is None:
                    return top
            if what == "end" or (what == "top" and e == 0):
                regime = "sticking" if holds else "sliding" if s * slip >= 0 else "reversing"
                return Passage(pn, pt, u, s, work, rubbed, top, tuple(directions), regime)
        raise AssertionError("a contact has three stretches and two corners at most")

    top = run(None)
    if top is None or top[0] == 0:
        return None
    return run(top[2] * (1 - e * e))


# Below this part of the trace (squared for the determinant) K cannot be told from a singular one:
# section 4, item 13.
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

    # What the impulses from outside change at the contact.
    moments = []
    for k, body in enumerate(bodies):
        jx, jy, yaw = map(num, scene.outside[k])
        moments.append(yaw + arms[k][0] * jy - arms[k][1] * jx if body.pivot else yaw)
    push = tuple(
        sum(
            (2 * k - 1) * (share[k] * num(scene.outside[k][i]) + turn[k] * moments[k] * q[k][i])
            for k in (0, 1)
        )
        for i in (0, 1)
    )
    push_n, push_t = -dot(n, push), dot(t, push)
    wanted_n, wanted_t = (1 + e) * closing, -(1 + e if scene.law == "kudlich-slibar" else 1) * slip
    wanted_n, wanted_t = wanted_n + push_n, wanted_t - push_t
    if wanted_n <= 0 or (scene.law == "stronge" and closing + push_n <= 0):
        return Answer("separating", closing=closing)
    no_slip = None
    if not singular:
        no_slip = (
            (k_tt * wanted_n - k_nt * wanted_t) / det,
            (k_nn * wanted_t - k_nt * wanted_n) / det,
        )

    value = None if math.isinf(scene.value) else num(scene.value)
    sticks, ratio, passage, plastic, early = False, num(0), None, None, num(1)
    if scene.rule == "impulse_ratio":
        regime, ratio = "given", value
    elif scene.value == 0.0:
        regime = "frictionless" if scene.rule == "friction" else "given"
    elif no_slip is None:
        return Answer("singular_contact")
    elif scene.law == "stronge":
        left = closing + push_n
        passage = follow(mp, (k_nn, k_nt, k_tt), left, slip + push_t, value, e * closing / left)
        if passage is None:
            return Answer("no_slip_pulls")
        regime = passage.regime
        # Of what acts from outside so much has acted by the end of compression; or all of it where
        # that has no end within the contact.
        for early in (1 / (1 + max(e, 0)), num(1)):
            left_n, left_t = closing + early * push_n, slip + early * push_t
            plastic = follow(mp, (k_nn, k_nt, k_tt), left_n, left_t, value, num(0))
            if plastic and plastic.top[0] <= passage.pn:
                break
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
    if passage is not None:
        pn, pt = passage.pn, passage.pt
    elif sticks:
        pn, pt = no_slip
    else:
        if resistance <= 0:
            return Answer("ratio_jams")
        pn = wanted_n / resistance
        pt = ratio * pn
    slip_after = slip + push_t + k_nt * pn + k_tt * pt
    impulse = tuple(pn * n[i] + pt * t[i] for i in (0, 1))

    halves, common = [], []
    loss = num(0)
    for k, body in enumerate(bodies):
        force = impulse if k else (-impulse[0], -impulse[1])
        jx, jy, yaw = map(num, scene.outside[k])
        dw = turn[k] * (r[k][0] * force[1] - r[k][1] * force[0] + moments[k])
        w = spins[k]
        if body.pivot:
            change = rotated((dw * arms[k][0], dw * arms[k][1]))
            v = rotated((w * arms[k][0], w * arms[k][1]))
            pin = (
                num(body.mass) * change[0] - force[0] - jx,
                num(body.mass) * change[1] - force[1] - jy,
            )
        else:
            change = share[k] * (force[0] + jx), share[k] * (force[1] + jy)
            v = num(body.vx), num(body.vy)
            pin = num(0), num(0)
        after = v[0] + change[0], v[1] + change[1]
        # Equation 7 needs velocities whose difference is the data: those of A are kept, those of B
        # are A's plus the difference.
        if body.pivot:
            base = v
        elif k:
            base = num(own[0][0]) + dv[0], num(own[0][1]) + dv[1]
        else:
            base = v
        ended = base[0] + change[0], base[1] + change[1]
        energy = (
            dot(force, base)
            if math.isinf(body.mass)
            else num(body.mass) * (dot(ended, ended) - dot(base, base)) / 2
        )
        if not math.isinf(body.mass):
            energy -= (jx * (base[0] + ended[0]) + jy * (base[1] + ended[1])) / 2
        if not math.isinf(body.inertia):
            energy -= yaw * (w + w + dw) / 2
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
                share[k], turn[k], length(r[k]), length(arms[k]), length(v),
                    share[k] + turn[k] * dot(r[k], r[k]),
            )
        )  # fmt: skip
        contact = [v[i] + (0 if body.pivot else 1) * w * q[k][i] for i in (0, 1)]
        if body.pivot:
            contact = [w * q[k][i] for i in (0, 1)]
        moved = [(0 if body.pivot else change[i]) + dw * q[k][i] for i in (0, 1)]
        if passage is None:
            common.append(dot(n, contact) + dot(n, moved) / (1 + e))
            continue
        # The end of compression, as an impulse on this body.
        if not plastic or e < 0:
            common.append(mp.nan)
            continue
        cn, ct = (part * (2 * k - 1) for part in plastic.top[:2])
        struck = cn * n[0] + ct * t[0], cn * n[1] + ct * t[1]
        turned = turn[k] * (r[k][0] * struck[1] - r[k][1] * struck[0] + early * moments[k])
        pushed = [struck[i] + early * num(scene.outside[k][i]) for i in (0, 1)]
        moved = [share[k] * pushed[i] + turned * q[k][i] for i in (0, 1)]
        common.append(dot(n, contact) + dot(n, moved))

    # The scales of section 2.
    s_u = length(dv) + sum(abs(spins[k]) * halves[k].r for k in (0, 1))

    def kappa_of_ratio(mu: Any) -> Any:
        levers = sum(
            turn[k] * halves[k].r * (abs(dot(t, r[k])) + abs(mu) * halves[k].r) for k in (0, 1)
        )
        return (a + levers) / (k_nn + mu * k_nt)

    cross = r[0][0] * r[1][1] - r[0][1] * r[1][0]
    kappa_s = (
        None
        if singular
        else (a * trace + turn[0] * turn[1] * halves[0].r * halves[1].r * abs(cross)) / det
    )
    no_slip_spread = None if singular else kappa_s * (1 + e) * s_u * trace / det
    kappa_mu = None if sticks else kappa_of_ratio(ratio)
    s_push = sum(
        share[k] * length(tuple(map(num, scene.outside[k][:2])))
        + turn[k] * abs(moments[k]) * halves[k].r
        for k in (0, 1)
    )
    # The slip of an incomplete impact ends as a whole where it sticks, however small 1 + e.
    reach = (1 + max(e, 0)) * s_u + s_push
    s_p = reach * (trace / det if sticks else mp.sqrt(1 + ratio * ratio) / resistance)
    kappa = kappa_s if sticks else kappa_mu
    spread = kappa * s_p
    separation, compression = e * closing, pn / (1 + e) if e >= 0 else pn
    if passage is not None:
        separation, compression = -passage.closing, plastic.top[0] if e >= 0 else pn
        # Every stretch in its own direction; one along the tangent alone stops the slip.
        kappa, spread = num(0), num(0)
        for along_n, along_t in passage.directions:
            size = mp.sqrt(along_n * along_n + along_t * along_t)
            gives = abs(k_nn * along_n + k_nt * along_t) if along_n else k_tt
            of_stretch = (a + sum(turn[k] * halves[k].r ** 2 for k in (0, 1))) * size / gives
            kappa, spread = max(kappa, of_stretch), max(spread, of_stretch * reach * size / gives)
        if s_push:
            # The restitution for what is left of the closing speed is known to as much as that.
            of_e = (s_u + s_push) / left
            spread, kappa = (
                spread + of_e * mp.sqrt(pn * pn + pt * pt),
                kappa + of_e * abs(separation) / (s_u + s_push),
            )
    if scene.rule == "critical_fraction" and scene.value:
        # The ratio is itself worked out from the no-slip impulse, known to its own spread; what P
        # makes of that comes on top.
        of_ratio = value * no_slip_spread * (1 + abs(no_slip[1] / no_slip[0])) / no_slip[0]
        spread += of_ratio * pn * (1 + abs(k_nt) * mp.sqrt(1 + ratio * ratio) / resistance)
    loss_n, loss_t = (1 - e) * closing * pn / 2, -pt * (slip + slip_after) / 2
    if passage is not None:
        # What acts from outside does so in proportion to the normal impulse.
        loss_n = passage.work - push_n * pn / 2
        loss_t = loss - loss_n
    critical = None
    if no_slip is not None:
        critical = (
            no_slip[1] / no_slip[0] if no_slip[0] > 0 else mp.inf * (-1 if no_slip[1] < 0 else 1)
        )
    return Answer(
        None, closing, slip, slip_after, pn, pt, loss, loss_n, loss_t, regime,
        critical, no_slip, common[0], k_nn, k_nt, k_tt, det, s_u, kappa_mu, kappa_s, s_p, spread,
        no_slip_spread, resistance,
        halves[0], halves[1], separation, compression, kappa, s_push,
    )  # fmt: skip

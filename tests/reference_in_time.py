"""An independent evaluation, in 40 digits, of the steps by which ``time_resolved`` follows a
contact.

Written in complex numbers from the description of the scheme (the impulses of a step at one place,
then a drift to that of the next, in whose middle the tyres act), and not from the code of the
package, in SI where that works in units of the contact. What the package differs by is rounding.
What the steps differ by from the contact itself is another question, for which the tests have
closed forms and integrations of other kinds.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import mpmath

from reference import Body, Scene

GRAVITY, WHEELBASE, TRACK = 9.80665, 2.7, 1.5


@dataclass
class Side:
    """A body on its way: its velocity, way and turn (as a complex number of length 1) since the
    start.
    """

    mass: Any
    inertia: Any
    v: Any
    w: Any
    arm: Any
    wheels: list[Any]
    way: Any = 0
    turn: Any = 1
    start: tuple[Any, Any] = field(init=False)

    def __post_init__(self) -> None:
        self.start = self.v, self.w

    def at(self, arm: Any) -> Any:
        """Velocity of a place on it."""
        return self.v + 1j * self.w * arm

    def push(self, impulse: Any, moment: Any) -> None:
        """Change its motion."""
        self.v += impulse / self.mass
        self.w += moment / self.inertia

    @property
    def place(self) -> Any:
        """Where the place that met at first is now, from where its centre was."""
        return self.way + self.turn * self.arm


@dataclass
class Followed:
    """Changes of velocity and yaw rate of A and B; time, largest crush and force; the impulse on B
    and the losses along n and t.
    """

    changes: list[tuple[Any, Any]]
    time: Any
    crush: Any
    force: Any
    impulse: Any
    loss_n: Any
    loss_t: Any
    closing: Any
    # At maximum engagement: way and turn of both bodies, and the turn of the normal.
    engaged: list[Any]


def cross(one: Any, other: Any) -> Any:
    """The third component of the product of two vectors."""
    return one.real * other.imag - one.imag * other.real


def follow_in_time(
    scene: Scene, duration: float, drag: float, steps: int, moves: bool, digits: int = 40
) -> Followed | None:
    """The steps of a contact with a linear spring of this nominal duration; None where it does not
    begin or end.
    """
    with mpmath.workdps(digits):
        return _follow(scene, duration, drag, steps, moves)


def _follow(scene: Scene, duration: float, drag: float, steps: int, moves: bool) -> Followed | None:
    mp, num = mpmath.mp, mpmath.mpf
    e, mu = (
        num(scene.restitution),
        num(scene.value) if math.isfinite(scene.value) else num(10) ** 30,
    )
    if isinstance(scene.normal, tuple):
        normal = mpmath.mpc(*scene.normal)
        normal /= abs(normal)
    else:
        normal = mp.expj(num(scene.normal))

    def side(body: Body) -> Side:
        ahead = mp.expj(num(body.heading))
        wheels = [
            ahead * mpmath.mpc(x * WHEELBASE / 2, y * TRACK / 2) for x in (1, -1) for y in (1, -1)
        ]
        mass, inertia = (
            mp.inf if math.isinf(one) else num(one) for one in (body.mass, body.inertia)
        )
        arm = mpmath.mpc(scene.point[0] - body.x, scene.point[1] - body.y)
        return Side(
            mass,
            inertia,
            mpmath.mpc(body.vx, body.vy),
            num(body.spin),
            arm,
            wheels if drag and mass < mp.inf else [],
        )

    a, b = side(scene.a), side(scene.b)
    fixed_a, fixed_b = (one.mass == mp.inf and one.inertia == mp.inf for one in (a, b))
    # A body that cannot move keeps the normal; the other one carries the point.
    point_on_a, normal_on_a = (1, 0) if fixed_b else (0, 1) if fixed_a else (num(0.5), num(0.5))
    carried = num(1)

    def now() -> tuple[Any, ...]:
        """Normal, levers, closing speed, slip and K."""
        n = normal * carried
        to_b = b.place - b.arm - (a.place - a.arm)
        arm_a, arm_b = a.turn * a.arm + (1 - point_on_a) * to_b, b.turn * b.arm - point_on_a * to_b
        u = (b.at(arm_b) - a.at(arm_a)) / n
        levers = [(one, arm / n) for one, arm in ((a, arm_a), (b, arm_b))]
        k_nn = sum(1 / one.mass + arm.imag**2 / one.inertia for one, arm in levers)
        k_tt = sum(1 / one.mass + arm.real**2 / one.inertia for one, arm in levers)
        k_nt = -sum(arm.real * arm.imag / one.inertia for one, arm in levers)
        return n, arm_a, arm_b, -u.real, u.imag, k_nn, k_nt, k_tt

    closing_before, k_nn = now()[3], now()[5]
    closing = closing_before
    if closing_before <= 0:
        return None
    nominal = num(duration)
    stiffness = ((1 + e) * mp.pi / (2 * nominal)) ** 2 / k_nn
    crush = deepest = time = owed = late = loss_n = loss_t = num(0)
    impulse = mpmath.mpc(0)

    def brake(seconds: Any, ahead: Any) -> None:
        """Let the tyres act for so many seconds, with the headings of a moment that lies ahead."""
        for one in (a, b):
            hold = num(drag) * num(GRAVITY) * one.mass / 4 * seconds if one.wheels else 0
            total, moment = mpmath.mpc(0), num(0)
            heading = one.turn * turned(one.w * ahead)
            for wheel in one.wheels:
                place = heading * wheel
                u = one.at(place)
                at_most = (
                    1 / (4 * (1 / one.mass + abs(wheel) ** 2 / one.inertia))
                    if seconds > 0
                    else num(0)
                )
                held = -u * (hold / abs(u) if hold < at_most * abs(u) else at_most)
                total, moment = total + held, moment + cross(place, held)
            one.push(total, moment)

    def turned(angle: Any) -> Any:
        return (1 + 1j * angle / 2) / (1 - 1j * angle / 2)

    def drift(seconds: Any, braking: Any = None) -> None:
        """Move and turn, and let the tyres act for so many seconds in the middle."""
        nonlocal carried
        before = [(one.v, one.w) for one in (a, b)]
        if braking is not None:
            brake(braking, seconds / 2 if moves else 0)
        if not moves:
            return
        rates = []
        for one, (v, w) in zip((a, b), before, strict=True):
            one.way += (one.v + v) / 2 * seconds
            rates.append((one.w + w) / 2)
            one.turn *= turned(rates[-1] * seconds)
        carried *= turned((normal_on_a * rates[0] + (1 - normal_on_a) * rates[1]) * seconds)

    def tangential(p: Any, slip: Any, k_nt: Any, k_tt: Any) -> Any:
        if abs(k_nt) > mu * k_tt and slip * k_nt < 0:
            # The slip stops after this much, and friction cannot hold it.
            until = abs(slip) / (abs(k_nt) + mu * k_tt)
            if until < p:
                return -mp.sign(k_nt) * mu * (p - until) + mp.sign(k_nt) * mu * until
        return max(-mu * p, min(mu * p, -(slip + k_nt * p) / k_tt)) if k_tt else num(0)

    def back(depth: Any) -> Any:
        """Force on the way back, which is e squared of the way in long."""
        left = depth - (1 - e * e) * deepest
        return (
            stiffness * depth
            if depth > deepest
            else max(num(0), stiffness * left / (e * e))
            if e
            else num(0)
        )

    engaging, active, step = True, True, nominal / steps
    engaged: list[Any] = []
    # It gives up after so many steps of either half.
    left_over = most = 40 * steps
    while left_over:
        left_over -= 1
        if not active:
            if not engaging:
                break
            engaged = [
                *(a.way + a.v * late, a.turn * turned(a.w * late)),
                *(b.way + b.v * late, b.turn * turned(b.w * late)),
                carried * turned((normal_on_a * a.w + (1 - normal_on_a) * b.w) * late),
            ]
            left_over = most
            engaging, step = (
                False,
                min(mp.sqrt(e) * nominal / steps, num(0.6) * e / (1 + e) * nominal),
            )
            active = crush > (1 - e * e) * deepest and time < 3 * nominal
            continue
        this = step
        if not engaging:
            left = crush - (1 - e * e) * deepest
            if closing < 0 and left < -closing * this:
                this = left / -closing
        paid = max(owed + this / 2, num(0))
        drift(late + this / 2, paid)
        n, arm_a, arm_b, closing, slip, k_nn, k_nt, k_tt = now()
        depth = crush + this / 2 * closing
        p = (stiffness * depth if engaging else back(depth)) * this
        q = tangential(p, slip, k_nt, k_tt)
        after, took = closing - k_nn * p - k_nt * q, this
        ends = engaging and after <= 0
        if ends:
            part = closing / (closing - after) if closing > 0 else num(0)
            p, took = p * part, this * part
            q = tangential(p, slip, k_nt, k_tt)
            after = closing - k_nn * p - k_nt * q
        pushed = n * mpmath.mpc(p, q)
        a.push(-pushed, -cross(arm_a, pushed))
        b.push(pushed, cross(arm_b, pushed))
        impulse += pushed
        crush += took * (closing + after) / 2
        deepest = max(deepest, crush)
        loss_n += p * (closing + after) / 2
        loss_t -= q * (slip + slip + k_nt * p + k_tt * q) / 2
        time, owed, late = time + took, owed + took - paid, took - this / 2
        closing = after
        whole = e * e * deepest
        active = time < 3 * nominal and (
            not ends if engaging else crush - (deepest - whole) > num(10) ** -9 * whole
        )
    drift(late)
    brake(max(owed, num(0)), num(0))
    if time >= 3 * nominal or deepest <= 0:
        return None
    changes = [(one.v - one.start[0], one.w - one.start[1]) for one in (a, b)]
    return Followed(
        changes, time, deepest, stiffness * deepest, impulse, loss_n, loss_t, closing_before,
        engaged
    )  # fmt: skip

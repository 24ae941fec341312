"""Both impact speeds from the full geometry and two of: one speed, a delta-V, the energy dissipated, both EES.

As long as the contact keeps sliding one way, or sticks, the impulse is linear in the two speeds, and what was observed of it
quadratic. So in each regime the candidates are roots of a quadratic, read off the forward kernel at three places, polished on
it, and kept if the law as asked leads from them to what was observed. A share of the critical ratio makes the impulse a
quotient, with a divisor that is linear in the speeds; times its square what was observed is a quartic, read off at five places.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..arguments import read
from ..directions import direction
from ..eccentric import body_numbers, missing_numbers
from ..errors import InputError, MissingInputError, NoSolutionError, OutOfRangeWarning
from ..impact import Asked, Impact
from ..kernels import codes
from ..kernels.eccentric import eccentric
from ..kernels.energy import energy_losses
from ..kernels.friction import sticking_slip
from ..provenance import Reconstruction
from ..units import Door, Input, Pair, callers_level
from ..vehicle import Vehicle
from .inline import not_negative
from .outcome import Cases, exactly, input_faults, plain_error, settle
from .self_consistent import RestitutionOf, crossings

_forward: Callable[..., tuple[Any, ...]] = eccentric
_NUMBERS = ("mass", "yaw_inertia", "vx", "vy", "yaw_rate", "x", "y", "pivot_x", "pivot_y")
_STICK = "stick"
_SHARE = "share"
_SAME = 1e-6
_REDUNDANT = 1e-9
_POLISH = 3
# Part of the speeds that a derivative is taken over: exact for quadratics, to 1e-8 for quotients of them.
_STEP = 1e-4
# Where a quartic is read off: nowhere a multiple of another or 0, for a scene at rest there tells nothing.
_PLACES = np.array([-1.06, -0.47, 0.13, 0.61, 1.27])
_FROM_PLACES = np.linalg.inv(np.vander(_PLACES, increasing=True)).T


def speeds(
    a: Vehicle,
    b: Vehicle,
    *,
    course_a: Input | None,
    course_b: Input | None,
    restitution: Input | Callable[[float], float],
    normal: Input | tuple[Input, Input],
    point: Pair,
    friction: Input | None = None,
    impulse_ratio: Input | None = None,
    critical_fraction: Input | None = None,
    law: str = "brach",
    speed_a: Input | None = None,
    speed_b: Input | None = None,
    delta_v_a: Input | None = None,
    delta_v_b: Input | None = None,
    energy_loss: Input | None = None,
    ees_a: Input | None = None,
    ees_b: Input | None = None,
) -> tuple[Impact, ...]:
    """Impact speeds of both vehicles from where and how they met and two things that were found out.

    The model is that of ``eccentric``: levers, rotation, friction and both laws. Every pair of speeds that fits is returned.

    Parameters
    ----------
    a, b : Vehicle
        The vehicles at the moment of impact: mass, yaw inertia, position, yaw rate (heading for the PDOF). Their velocities are
        what is asked for, and replaced.
    course_a, course_b : angle [rad]
        Directions of motion before the impact; None for a vehicle whose speed is known to be 0.
    restitution : float, str, Quantity or array [1], or function
        Coefficient of restitution, or a function that gives it for a closing speed in m/s: solved together with the speeds,
        in single cases. With a number every root is found in closed form. With a function they are looked for on a grid of
        129 restitutions, between its places and where it turns or ends; two roots that the grid does not tell may be missed.
    normal : angle [rad] or tuple (nx, ny)
        Direction from A into B.
    point : pair [m]
        Contact point.
    friction, impulse_ratio, critical_fraction : float, str, Quantity or array [1], optional
        Exactly one, as for ``eccentric``.
    law : {"brach", "kudlich-slibar"}, optional
        How restitution acts and what no slip means.
    speed_a, speed_b : float, str, Quantity or array [m/s], optional
        A known speed, >= 0. Exactly two of the five kinds of knowledge.
    delta_v_a, delta_v_b : float, str, Quantity or array [m/s], optional
        A known delta-V, as from an event data recorder at the centre of mass. Not both: they tell the same.
    energy_loss : float, str, Quantity or array [J], optional
        Energy dissipated, along the normal and by friction.
    ees_a, ees_b : float, str, Quantity or array [m/s], optional
        Energy equivalent speeds of both: the energy absorbed along the normal at maximum crush, before restitution.

    Returns
    -------
    tuple of Impact
        Every impact that fits, by rising closing speed. In a batch each holds one root of every case, NaN where it has none.

    Raises
    ------
    InputError
        An argument that cannot be used, or not exactly two things known.
    NoSolutionError
        Nothing fits, or what is known leaves the speeds open.

    Warns
    -----
    OutOfRangeWarning
        A speed came out negative: backwards along its course.

    Examples
    --------
    A car strikes a parked one off-centre; its recorder shows a delta-V of 6 m/s.

    >>> import collisions as col
    >>> a = col.Vehicle(mass=1500, yaw_inertia=2500, x=-2.0, y=0.0)
    >>> b = col.Vehicle(mass=1300, yaw_inertia=2000, x=2.0, y=0.8)
    >>> (found,) = col.reconstruct.speeds(
    ...     a, b, course_a=0.0, course_b=None, speed_b=0.0, delta_v_a=6.0, restitution=0.1, normal=0.0, point=(0.0, 0.4),
    ...     friction=0.5)
    >>> round(found.a.before.vx, 2), round(found.a.delta_v, 12)
    (11.96, 6.0)
    """
    if (ees_a is None) != (ees_b is None):
        raise InputError(
            "give both ees_a and ees_b, or neither; that of an infinite mass is 0", code="one_ees", argument="ees_a"
        )
    given = exactly(
        {
            "speed_a": speed_a,
            "speed_b": speed_b,
            "delta_v_a": delta_v_a,
            "delta_v_b": delta_v_b,
            "energy_loss": energy_loss,
            "ees_a": ees_a,
        },
        2,
        "speeds",
    )
    door = Door()
    known = {name: not_negative(door, value, "J" if name == "energy_loss" else "m/s", name) for name, value in given.items()}
    if "ees_a" in known:
        known["ees_b"] = not_negative(door, ees_b, "m/s", "ees_b")
    courses = {}
    for label, course in (("a", course_a), ("b", course_b)):
        if course is not None:
            courses[label] = direction(door, course, f"course_{label}")
        elif np.any(np.not_equal(known.get(f"speed_{label}", np.nan), 0.0)):
            door.refuse(
                MissingInputError(
                    f"course_{label} is None, and speeds needs the course of every vehicle that moves; only a known speed of 0 "
                    f"needs none",
                    code="missing_course",
                    argument=f"course_{label}",
                )
            )
        else:
            courses[label] = (1.0, 0.0)
    function = RestitutionOf(restitution) if callable(restitution) else None
    for label, body in (("a", a), ("b", b)):
        if isinstance(body, Vehicle) and body.pivot is not None:
            door.refuse(
                InputError(
                    f"{label} has a pivot, so its velocity has no course of its own; use planar, or fit",
                    code="pinned",
                    argument="pivot",
                )
            )
    e, n, rule, bound, contact, _ = read(
        a,
        b,
        0.0 if function is not None else restitution,
        normal,
        point,
        friction,
        impulse_ratio,
        critical_fraction,
        law,
        [*door.problems, *missing_numbers(a, b, point)],
    )
    everything: dict[str, Any] = {**known, "restitution": e, rule: bound, "normal[0]": n[0], "normal[1]": n[1]}
    everything |= {f"point[{i}]": part for i, part in enumerate(contact or ())}
    for label, body in (("a", a), ("b", b)):
        numbers = body_numbers(body, contact)
        everything |= {
            f"{label}.{name}": value for name, value in zip(_NUMBERS, numbers, strict=True) if name not in ("vx", "vy")
        }
        everything |= {f"course_{label}[{i}]": part for i, part in enumerate(courses[label])}
        if body.heading is not None:
            everything[f"{label}.heading"] = body.heading
    cases = Cases.of(everything)
    with np.errstate(all="ignore"):
        _refuse_pairs(given, known, a, b)
        scene = _Scene({name: np.asarray(v, dtype=np.float64) for name, v in everything.items()}, rule, law, tuple(given))
        roots = scene.roots() if function is None else _joint(scene, cases, function)
        return _answers(cases, scene, _sorted(cases, scene, roots), a, b, (n, rule, bound, law, contact, e), function)


def _refuse_pairs(given: dict[str, Any], known: dict[str, Any], a: Vehicle, b: Vehicle) -> None:
    if given.keys() == {"speed_a", "speed_b"}:
        raise InputError(
            "speed_a and speed_b are both known: that is the forward problem, use eccentric", code="too_many_knowns"
        )
    if given.keys() == {"delta_v_a", "delta_v_b"}:
        on_a, on_b = (np.multiply(body.mass, known[f"delta_v_{label}"]) for label, body in (("a", a), ("b", b)))
        # fmax passes over the NaN of infinite masses.
        apart = float(np.fmax.reduce(abs(on_a - on_b) / np.maximum(on_a, on_b), axis=None, initial=0.0))
        raise InputError(
            f"delta_v_a and delta_v_b tell the same, the impulse (here they differ by {apart:.1%}); give one of them and a "
            f"speed or an energy",
            code="same_information",
            argument="delta_v_b",
            mismatch=apart,
        )


class _Root(NamedTuple):
    """A candidate: both speeds, the restitution they go with, and how well-posed they are."""

    speed_a: Any
    speed_b: Any
    restitution: Any
    condition: Any


class _Scene:
    """Two vehicles whose speeds are open, and what was observed of them."""

    def __init__(self, numbers: dict[str, Any], rule: str, law: str, kinds: tuple[str, ...]) -> None:
        self.numbers, self.rule, self.law, self.kinds = numbers, rule, law, kinds
        self.e, self.bound = numbers["restitution"], numbers[rule]
        self.targets = {kind: self._target(kind) for kind in kinds}
        # Set where a regime would let any slip fit; and where it might, with another restitution.
        self.open: Any = np.zeros((), dtype=bool)
        self.blind = False

    def _target(self, kind: str) -> Any:
        """What was observed, in the form that is quadratic in the speeds."""
        value, mass = self.numbers[kind], {label: self.numbers[f"{label}.mass"] for label in "ab"}
        if kind.startswith("delta_v"):
            return (mass[kind[-1]] * value) ** 2
        if kind == "ees_a":
            both = [(mass["a"], value), (mass["b"], self.numbers["ees_b"])]
            return sum(np.where(speed == 0.0, 0.0, 0.5 * m * (speed * speed)) for m, speed in both)
        return value

    def shares_critical(self) -> bool:
        """Whether the impulse ratio depends on the answer."""
        return self.rule == codes.CRITICAL_FRACTION and bool(np.any((self.bound > 0.0) & (self.bound < 1.0)))

    def regimes(self) -> list[Any]:
        """Impulse ratios, or sticking, that the contact may turn out to have."""
        if self.rule == codes.IMPULSE_RATIO:
            return [self.bound]
        if self.rule == codes.CRITICAL_FRACTION:
            return [np.where(self.bound == 0.0, 0.0, np.nan), _STICK, *([_SHARE] if self.shares_critical() else [])]
        finite = np.where(np.isinf(self.bound), np.nan, self.bound)
        return [finite, np.where(self.bound > 0.0, -finite, np.nan), _STICK]

    def run(self, speed_a: Any, speed_b: Any, e: Any, rule: str, bound: Any) -> tuple[Any, ...]:
        """The forward kernel at these speeds."""
        v, bodies = self.numbers, []
        for label, speed in (("a", speed_a), ("b", speed_b)):
            cx, cy = v[f"course_{label}[0]"], v[f"course_{label}[1]"]
            rest = [v[f"{label}.{name}"] for name in _NUMBERS[4:]]
            bodies += [v[f"{label}.mass"], v[f"{label}.yaw_inertia"], speed * cx, speed * cy, *rest]
        place = (v["normal[0]"], v["normal[1]"], bound, v["point[0]"], v["point[1]"])
        return _forward(e, *place, *bodies, rule, self.law, False, False)

    def observe(self, regime: Any, speed_a: Any, speed_b: Any, e: Any) -> dict[str, Any]:
        """What would be observed at these speeds if the contact were in this regime; times its weight, a polynomial of them."""
        weight: Any = 1.0
        if isinstance(regime, str):
            raw = self.run(speed_a, speed_b, e, codes.FRICTION, 0.0)
            closing, slip = raw[codes.AT["closing_speed"]], raw[codes.AT["slip_before"]]
            normal, tangential = raw[codes.AT["no_slip_normal"]], raw[codes.AT["no_slip_tangential"]]
        if regime is _SHARE:
            shared = self.bound * tangential
            weight = (normal + shared * (raw[codes.AT["coupling"]] * raw[codes.AT["effective_mass"]])) ** 2
            regime = shared / normal
        if isinstance(regime, str):
            kept = sticking_slip(e, self.law)
            loss = energy_losses(
                e,
                closing,
                slip,
                kept * slip,
                (1.0 + kept) * slip,
                0.0,
                normal,
                tangential,
                0.0,
                codes.IMPULSE_RATIO,
                "",
                codes.EPS,
            )[2]
        else:
            raw = self.run(speed_a, speed_b, e, codes.IMPULSE_RATIO, regime)
            normal, tangential, loss = (raw[codes.AT[name]] for name in ("normal_impulse", "tangential_impulse", "energy_loss"))
        return {"weight": weight, **self._seen(raw, normal, tangential, loss, speed_a, speed_b, e)}

    def _seen(self, raw: Any, normal: Any, tangential: Any, loss: Any, speed_a: Any, speed_b: Any, e: Any) -> dict[str, Any]:
        squared = normal * normal + tangential * tangential
        closing = raw[codes.AT["closing_speed"]]
        return {
            "closing": closing,
            "slip": raw[codes.AT["slip_before"]],
            "speed_a": speed_a,
            "speed_b": speed_b,
            "delta_v_a": squared,
            "delta_v_b": squared,
            "energy_loss": loss,
            "ees_a": 0.5 * closing * normal / (1.0 + e),
        }

    def roots(self, e: Any = None, polish: int = _POLISH) -> list[_Root]:
        """All candidates of every regime, whether the law leads from them to what was observed or not."""
        e = self.e if e is None else e
        found: list[_Root] = []
        for regime in self.regimes():
            pairs = self._on_a_line(regime, e) if self.kinds[0].startswith("speed") else self._crossing(regime, e)
            found += [self._polished(regime, e, *pair, polish) for pair in pairs]
        return found

    def _on_a_line(self, regime: Any, e: Any) -> list[tuple[Any, Any]]:
        """With one speed known: where the curve along the other meets what was observed."""
        fixed, kind = self.kinds
        value, target = self.targets[fixed], self.targets[kind]

        def seen(x: Any) -> dict[str, Any]:
            return self.observe(regime, *((value, x) if fixed == "speed_a" else (x, value)), e)

        def at(x: Any) -> Any:
            here = seen(x)
            return (here[kind] - target) * here["weight"]

        # The speeds that are there, and the one that one unit of speed would have to grow to.
        rest, one = seen(np.zeros(())), seen(np.ones(()))
        needed = np.sqrt(abs(target / (one[kind] - rest[kind])))
        step = abs(value) + abs(rest["closing"]) + abs(rest["slip"]) + np.where(np.isfinite(needed), needed, 0.0)
        xs = _roots(regime, at, np.where(step > 0.0, step, 1.0))
        return [(value + 0.0 * x, x) if fixed == "speed_a" else (x, value + 0.0 * x) for x in xs]

    def _crossing(self, regime: Any, e: Any) -> list[tuple[Any, Any]]:
        """With two quadratic observations: their ratio depends on slip over closing speed alone."""
        zero, one = np.zeros(()), np.ones(())
        rest, per_a, per_b = (self.observe(regime, *pair, e) for pair in ((zero, zero), (one, zero), (zero, one)))
        (ga, gb), (sa, sb) = ([part[name] - rest[name] for part in (per_a, per_b)] for name in ("closing", "slip"))
        crossed = ga * sb - gb * sa
        crossed = np.where(abs(crossed) <= 64.0 * codes.EPS * (np.hypot(ga, sa) * np.hypot(gb, sb)), np.nan, crossed)

        def speeds_at(closing: Any, slip: Any) -> tuple[Any, Any]:
            g, s = closing - rest["closing"], slip - rest["slip"]
            return (g * sb - s * gb) / crossed, (s * ga - g * sa) / crossed

        first, second = self.kinds

        def at(ratio: Any) -> tuple[Any, Any, Any]:
            seen = self.observe(regime, *speeds_at(one, ratio), e)
            return seen[first], seen[second], seen["weight"]

        c1, c2 = self.targets[first], self.targets[second]
        samples = [at(np.full((), ratio)) for ratio in (-1.0, 0.0, 1.0)]

        def everywhere(p1: Any, p2: Any) -> Any:
            scale = sum(abs(p2 * q1) + abs(p1 * q2) for q1, q2, _ in samples)
            return np.logical_and.reduce([abs(p2 * q1 - p1 * q2) <= _REDUNDANT * scale for q1, q2, _ in samples])

        # Where both tell the same of every slip, every slip fits, or none.
        leaves_open = everywhere(c1, c2)
        self.open = self.open | leaves_open
        self.blind = self.blind or bool(np.any(everywhere(*samples[1][:2])))

        def difference(ratio: Any) -> Any:
            q1, q2, weight = at(ratio)
            return np.where(leaves_open, np.nan, (c2 * q1 - c1 * q2) * weight)

        pairs = []
        for ratio in _roots(regime, difference, one):
            q1, q2, _ = at(ratio)
            closing = np.sqrt(np.where(c1 > 0.0, c1 / q1, c2 / q2))
            pairs.append(speeds_at(closing, ratio * closing))
        return pairs

    def _polished(self, regime: Any, e: Any, speed_a: Any, speed_b: Any, steps: int) -> _Root:
        """Newton's method on the kernel, with central differences for its derivatives."""
        condition: Any = np.nan
        for _ in range(steps):
            here = self.observe(regime, speed_a, speed_b, e)
            size = _STEP * (abs(speed_a) + abs(speed_b) + abs(here["closing"]))
            ahead_a, behind_a = (self.observe(regime, speed_a + h, speed_b, e) for h in (size, -size))
            ahead_b, behind_b = (self.observe(regime, speed_a, speed_b + h, e) for h in (size, -size))
            (j11, j12), (j21, j22) = (
                ((ahead_a[kind] - behind_a[kind]) / (2.0 * size), (ahead_b[kind] - behind_b[kind]) / (2.0 * size))
                for kind in self.kinds
            )
            r1, r2 = (here[kind] - self.targets[kind] for kind in self.kinds)
            determinant = j11 * j22 - j12 * j21
            step_a, step_b = (r1 * j22 - r2 * j12) / determinant, (r2 * j11 - r1 * j21) / determinant
            usable = np.isfinite(step_a) & np.isfinite(step_b)
            speed_a = speed_a - np.where(usable, step_a, 0.0)
            speed_b = speed_b - np.where(usable, step_b, 0.0)
            d1, d2 = ((2.0 if kind.startswith("delta_v") else 1.0) * abs(self.targets[kind]) for kind in self.kinds)
            moved = np.maximum(abs(d1 * j22) + abs(d2 * j12), abs(d2 * j11) + abs(d1 * j21))
            condition = moved / abs(determinant * here["closing"])
        return _Root(speed_a, speed_b, e, condition)

    def fits(self, root: _Root) -> tuple[Any, Any]:
        """Whether the law as asked leads from these speeds to what was observed, and the closing speed."""
        raw = self.run(root.speed_a, root.speed_b, root.restitution, self.rule, self.bound)
        normal, tangential, loss = (raw[codes.AT[n]] for n in ("normal_impulse", "tangential_impulse", "energy_loss"))
        seen = self._seen(raw, normal, tangential, loss, root.speed_a, root.speed_b, root.restitution)
        fits = raw[0] <= codes.ENERGY_GAIN
        speed_scale = abs(root.speed_a) + abs(root.speed_b) + seen["closing"]
        for kind in self.kinds:
            scale = (
                speed_scale
                if kind.startswith("speed")
                else seen[kind]
                if kind.startswith("delta_v")
                else seen["closing"] * normal
            )
            fits = fits & (abs(seen[kind] - self.targets[kind]) <= _SAME * scale)
        return fits, seen["closing"]


def _parabola_roots(samples: Sequence[Any], step: Any) -> tuple[Any, Any]:
    """Roots of the parabola through three points a step apart, the middle one at 0, rising; NaN where there are none."""
    behind, middle, ahead = samples
    square = 0.5 * (ahead + behind) - middle
    linear = 0.5 * (ahead - behind)
    scale = abs(behind) + abs(middle) + abs(ahead)
    square = np.where(abs(square) <= 8.0 * codes.EPS * scale, 0.0, square)
    inside = linear * linear - 4.0 * square * middle
    # A double root, where the line only touches the parabola, survives rounding.
    inside = np.where(abs(inside) <= 64.0 * codes.EPS * (linear * linear + abs(square) * scale), 0.0, inside)
    half = -0.5 * (linear + np.copysign(np.sqrt(inside), linear))
    one = np.where(square == 0.0, np.nan, half / square)
    other = np.where(half == 0.0, np.where(square == 0.0, np.nan, 0.0), middle / half)
    return step * np.fmin(one, other), step * np.fmax(one, other)


def _quartic_roots(samples: Sequence[Any], step: Any) -> list[Any]:
    """Real roots of the quartic through five points at ``_PLACES`` times the step; NaN in place of those that are not real."""
    values = np.stack(np.broadcast_arrays(*samples), axis=-1)
    values = np.where(np.all(np.isfinite(values), axis=-1, keepdims=True), values, 1.0)
    coefficients = (values / np.max(abs(values), axis=-1, keepdims=True)) @ _FROM_PLACES
    leading = coefficients[..., 4:]
    companion = np.zeros((*values.shape[:-1], 4, 4))
    companion[..., range(1, 4), range(3)] = 1.0
    companion[..., 3] = -coefficients[..., :4] / np.where(abs(leading) < codes.EPS, codes.EPS, leading)
    found = np.linalg.eigvals(companion)
    # A double root, where the line only touches the curve, survives rounding.
    real = abs(found.imag) <= _SAME * abs(found)
    return [step * np.where(real[..., i], found[..., i].real, np.nan) for i in range(4)]


def _roots(regime: Any, at: Callable[[Any], Any], step: Any) -> Sequence[Any]:
    """Roots of what a regime makes of the observations, on a scale that the step gives."""
    if regime is _SHARE:
        return _quartic_roots([at(step * place) for place in _PLACES], step)
    return _parabola_roots([at(-step), at(0.0 * step), at(step)], step)


def _joint(scene: _Scene, cases: Cases, function: RestitutionOf) -> list[_Root]:
    """Candidates where the restitution depends on the answer: solved on a grid of it, then where both agree."""
    if cases.shape is not None:
        raise InputError(
            "a function of restitution takes single cases; call once for each", code="bad_shape", argument="restitution"
        )
    if scene.shares_critical():
        raise InputError(
            "a function of restitution and a critical_fraction between 0 and 1 cannot be solved together; give impulse_ratio= "
            "or a number for the restitution",
            code="bad_combination",
            argument="critical_fraction",
        )

    def mismatch(e: Any) -> list[Any]:
        scene.open = np.zeros((), dtype=bool)
        return [function(scene.fits(root)[1] + 0.0 * e) - e for root in scene.roots(e, polish=0)]

    found = crossings(mismatch, np.linspace(0.0, 1.0, 129))
    scene.open = np.zeros((), dtype=bool)
    return [scene.roots(np.full((), e))[row] for row, e in found]


def _sorted(cases: Cases, scene: _Scene, roots: list[_Root]) -> list[tuple[_Root, Any]]:
    """The roots that fit, each once, by rising closing speed, and where in the batch they are."""
    shape = cases.shape or ()
    if not roots:
        return []
    parts = [np.stack([np.broadcast_to(root[i], shape) for root in roots]) for i in range(4)]
    judged = [scene.fits(root) for root in roots]
    fits = np.stack([np.broadcast_to(fit, shape) for fit, _ in judged])
    closing = np.stack([np.broadcast_to(speed, shape) for _, speed in judged])
    order = np.argsort(np.where(fits, closing, np.inf), axis=0, kind="stable")
    parts = [np.take_along_axis(part, order, axis=0) for part in (*parts, fits, closing)]
    *values, fits, closing = parts
    for i in range(1, len(roots)):
        apart = sum(abs(values[k][i] - values[k][i - 1]) for k in range(2))
        fits[i] &= ~(fits[i - 1] & (apart <= _SAME * closing[i]))
    rank = np.cumsum(fits, axis=0)
    most = int(np.max(rank[-1])) if rank.size else 0
    found = []
    for k in range(1, most + 1):
        chosen = fits & (rank == k)
        there = np.any(chosen, axis=0)
        which = np.argmax(chosen, axis=0)[np.newaxis]
        found.append((_Root(*(np.take_along_axis(value, which, axis=0)[0] for value in values)), there))
    return found


def _answers(
    cases: Cases,
    scene: _Scene,
    found: list[tuple[_Root, Any]],
    a: Vehicle,
    b: Vehicle,
    contact: tuple[Any, ...],
    function: RestitutionOf | None,
) -> tuple[Impact, ...]:
    n, rule, bound, law, point, e = contact
    faults = input_faults(scene.numbers)
    if not found or (cases.shape is None and scene.open):
        _refuse(cases, scene, faults, function)
        found = [(_Root(*(np.full((), np.nan) for _ in range(4))), np.zeros(cases.shape or (), dtype=bool))]
    impacts = []
    backward = 0.0
    for root, there in found:
        there = there & ~scene.open
        status = cases.verdict((*faults, (scene.open, codes.UNDETERMINED), (there, codes.OK), (True, codes.CONTRADICTORY)))
        moved = []
        for label, body, speed in (("a", a, root.speed_a), ("b", b, root.speed_b)):
            cx, cy = (scene.numbers[f"course_{label}[{i}]"] for i in range(2))
            vx, vy = (cases.values(np.where(there, speed * part + 0.0, np.nan)) for part in (cx, cy))
            moved.append(body._moved(vx, vy, body.yaw_rate))
            backward = min(backward, float(np.min(np.where(there, speed, 0.0), initial=0.0)))
        used = e if function is None else cases.values(root.restitution)
        origin = Reconstruction(
            method="speeds", known=scene.kinds, condition=cases.values(np.where(there, root.condition, np.nan))
        )
        asked = Asked("eccentric", moved[0], moved[1], used, n, rule, bound, law, point)
        impacts.append(settle(asked, status, origin, "nan", lambda index: plain_error(codes.CONTRADICTORY, "nothing fits")))
    if backward < 0.0:
        warnings.warn(
            OutOfRangeWarning(
                f"a speed came out as {backward:.6g} m/s: backwards along its course; check the courses",
                code="negative_speed",
                value=backward,
            ),
            stacklevel=callers_level(),
        )
    return tuple(impacts)


def _refuse(cases: Cases, scene: _Scene, faults: list[tuple[Any, int]], function: RestitutionOf | None) -> None:
    """Why there is no answer at all; a batch goes on, with NaN."""
    if cases.shape is not None:
        return
    if function is not None:
        function.complain()
    kinds = " and ".join("both EES" if kind == "ees_a" else kind for kind in scene.kinds)
    if not scene.kinds[0].startswith("speed"):
        (ax, ay), (bx, by) = ([float(scene.numbers[f"course_{label}[{i}]"]) for i in range(2)] for label in "ab")
        if abs(ax * by - ay * bx) <= 8.0 * codes.EPS:
            raise NoSolutionError(
                f"the courses are parallel, so {kinds} tell of the closing speed alone; give one of the speeds",
                code="parallel_headings",
            )
        if scene.open or (function is not None and scene.blind):
            raise NoSolutionError(
                f"where the contact slides, {kinds} tell of the closing speed alone and leave the slip open; give one of "
                f"the speeds",
                code="undetermined",
            )
    raise NoSolutionError(
        f"no speeds along these courses fit {kinds} with this restitution, {scene.rule} and geometry", code="contradictory"
    )

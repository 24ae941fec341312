"""The algebra behind ``speeds``: what would be observed at which speeds, and the speeds at which it would be.

As long as the contact keeps sliding one way, or sticks, the impulse is linear in the two speeds, and what was observed of it
quadratic. So in each regime the candidates are roots of a quadratic, read off the forward kernel at three places, polished on
it, and kept if the law as asked leads from them to what was observed. A share of the critical ratio makes the impulse a
quotient, with a divisor that is linear in the speeds; times its square what was observed is a quartic, read off at five places.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..kernels.contact_laws import CRITICAL_FRACTION, FRICTION, IMPULSE_RATIO, LAWS, energy_losses
from ..kernels.reverse import PLACES, absorbed_energy, parabola_roots, quartic_roots
from ..kernels.status import EPS, Status
from .common import NUMBERS, forward
from .speeds_open import ROUNDING, SAME, STICK, any_speed, blur, every_slip, reaches

REDUNDANT = 1e-9
_SHARE = "share"
_POLISH = 3
# Part of the speeds, and of a restitution of 1, that a derivative is taken over: exact for quadratics, to 1e-8 for quotients.
_STEP = 1e-4
_SQUARED = ("delta_v", "ees")


class Root(NamedTuple):
    """A candidate: both speeds, the restitution they go with, how well-posed they are, and the slope of each observation."""

    speed_a: Any
    speed_b: Any
    restitution: Any
    condition: Any
    slopes: Sequence[Any] = (0.0, 0.0)


class Scene:
    """Two vehicles whose speeds are open, and what was observed of them.

    Every case is worked out in a unit of speed and a unit of mass of its own, powers of two, so that squares of what was given
    neither overflow nor vanish. ``speed_unit``, ``mass_unit`` lead back.
    """

    def __init__(self, given: dict[str, Any], rule: str, law: str, kinds: tuple[str, ...]) -> None:
        self.rule, self.law, self.kinds = rule, law, kinds
        masses = np.minimum(given["a.mass"], given["b.mass"])
        sizes = [np.sqrt(given[kind]) / np.sqrt(masses) if kind == "energy_loss" else given[kind] for kind in kinds]
        self.mass_unit = _power_of_two(masses)
        self.speed_unit = _power_of_two(np.maximum(*sizes))
        self.numbers = {name: self._in_units(name, value) for name, value in given.items()}
        self.e, self.bound = given["restitution"], given[rule]
        self.targets = {kind: self._target(kind) for kind in kinds}
        self.spinning = sum(
            abs(self.numbers[f"{label}.yaw_rate"])
            * np.hypot(*(given[f"point[{i}]"] - given[f"{label}.{x}"] for i, x in enumerate("xy")))
            for label in "ab"
        )
        # Set where a regime lets any slip, or any speed, fit.
        self.open: Any = np.zeros((), dtype=bool)
        zero, one = np.zeros(()), np.ones(())
        seen = [self.observe(STICK, *pair, self.e) for pair in ((zero, zero), (one, zero), (zero, one))]
        self.rest = {name: seen[0][name] for name in ("closing", "slip")}
        self.per_speed = {name: tuple(part[name] - self.rest[name] for part in seen[1:]) for name in self.rest}

    def _in_units(self, name: str, value: Any) -> Any:
        kind = name.rpartition(".")[2]
        if kind in ("mass", "yaw_inertia"):
            return value / self.mass_unit
        if kind == "energy_loss":
            return value / self.mass_unit / self.speed_unit / self.speed_unit
        return value / self.speed_unit if kind.startswith(("speed", "delta_v", "ees", "yaw_rate")) else value

    def _target(self, kind: str) -> Any:
        """What was observed, in the form that is quadratic in the speeds."""
        value = self.numbers[kind]
        if kind.startswith("delta_v"):
            return (self.numbers[f"{kind[-1]}.mass"] * value) ** 2
        if kind == "ees_a":
            return absorbed_energy(self.numbers["a.mass"], value, self.numbers["b.mass"], self.numbers["ees_b"])
        return value

    def shares_critical(self) -> bool:
        """Whether the impulse ratio depends on the answer."""
        return self.rule == CRITICAL_FRACTION and bool(np.any((self.bound > 0.0) & (self.bound < 1.0)))

    def regimes(self) -> list[Any]:
        """Impulse ratios, or sticking, that the contact may turn out to have."""
        if self.rule == IMPULSE_RATIO:
            return [self.bound]
        if self.rule == CRITICAL_FRACTION:
            return [np.where(self.bound == 0.0, 0.0, np.nan), STICK, *([_SHARE] if self.shares_critical() else [])]
        finite = np.where(np.isinf(self.bound), np.nan, self.bound)
        return [finite, np.where(self.bound > 0.0, -finite, np.nan), STICK]

    def run(self, speed_a: Any, speed_b: Any, e: Any, rule: str, bound: Any) -> Any:
        """The forward kernel at these speeds."""
        v, bodies = self.numbers, []
        for label, speed in (("a", speed_a), ("b", speed_b)):
            cx, cy = v[f"course_{label}[0]"], v[f"course_{label}[1]"]
            rest = [v[f"{label}.{name}"] for name in NUMBERS[4:]]
            bodies += [v[f"{label}.mass"], v[f"{label}.yaw_inertia"], speed * cx, speed * cy, *rest]
        place = (v["normal[0]"], v["normal[1]"], bound, v["point[0]"], v["point[1]"])
        return forward(e, *place, *bodies, rule, self.law, False, False)

    def observe(self, regime: Any, speed_a: Any, speed_b: Any, e: Any) -> dict[str, Any]:
        """What would be observed at these speeds if the contact were in this regime; times its weight, a polynomial of them."""
        weight: Any = 1.0
        if isinstance(regime, str):
            raw = self.run(speed_a, speed_b, e, FRICTION, 0.0)
            closing, slip = raw.closing_speed, raw.slip_before
            normal, tangential = raw.no_slip_normal, raw.no_slip_tangential
        if regime is _SHARE:
            shared = self.bound * tangential
            weight = (normal + shared * (raw.coupling * raw.effective_mass)) ** 2
            regime = shared / normal
        if isinstance(regime, str):
            kept = LAWS[self.law].sticking_slip(e)
            slips = (slip, kept * slip, (1.0 + kept) * slip, 0.0)
            loss = energy_losses(e, closing, *slips, normal, tangential, 0.0, IMPULSE_RATIO, "", EPS)[2]
        else:
            raw = self.run(speed_a, speed_b, e, IMPULSE_RATIO, regime)
            normal, tangential, loss = (getattr(raw, name) for name in ("normal_impulse", "tangential_impulse", "energy_loss"))
        return {"weight": weight, **self._seen(raw, normal, tangential, loss, speed_a, speed_b, e)}

    def outcome(self, speed_a: Any, speed_b: Any, e: Any) -> tuple[Any, dict[str, Any]]:
        """The status under the law as asked, and what would be observed."""
        raw = self.run(speed_a, speed_b, e, self.rule, self.bound)
        normal, tangential, loss = (getattr(raw, name) for name in ("normal_impulse", "tangential_impulse", "energy_loss"))
        return raw[0], self._seen(raw, normal, tangential, loss, speed_a, speed_b, e)

    def _seen(self, raw: Any, normal: Any, tangential: Any, loss: Any, speed_a: Any, speed_b: Any, e: Any) -> dict[str, Any]:
        squared = normal * normal + tangential * tangential
        closing = raw.closing_speed
        slip, slip_after = raw.slip_before, raw.slip_after
        whole = abs(speed_a) + abs(speed_b) + self.spinning
        return {
            "closing": closing,
            "slip": slip,
            "whole": whole,
            "normal": normal,
            "impulse": np.sqrt(squared),
            # What the loss is summed up from, with the contact velocities as large as what they are the difference of.
            "lost": (1.0 - e) * closing * normal + abs(tangential) * (whole + abs(slip_after)),
            "speed_a": speed_a,
            "speed_b": speed_b,
            "delta_v_a": squared,
            "delta_v_b": squared,
            "energy_loss": loss,
            "ees_a": 0.5 * closing * normal / (1.0 + e),
        }

    def speeds_at(self, closing: Any, slip: Any) -> tuple[Any, Any]:
        """The speeds along the courses that bring the contact points together like this; NaN for parallel courses."""
        (ga, gb), (sa, sb) = self.per_speed["closing"], self.per_speed["slip"]
        crossed = ga * sb - gb * sa
        crossed = np.where(abs(crossed) <= 64.0 * EPS * (np.hypot(ga, sa) * np.hypot(gb, sb)), np.nan, crossed)
        g, s = closing - self.rest["closing"], slip - self.rest["slip"]
        return (g * sb - s * gb) / crossed, (s * ga - g * sa) / crossed

    def roots(self, e: Any = None, polish: int = _POLISH, slope: Callable[[Any], Any] | None = None) -> list[Root]:
        """All candidates of every regime, whether the law leads from them to what was observed or not.

        ``slope`` is the change of restitution with the closing speed, where there is one.
        """
        e = self.e if e is None else e
        self.open = np.zeros((), dtype=bool)
        found: list[Root] = []
        for regime in self.regimes():
            pairs = self._on_a_line(regime, e) if self.kinds[0].startswith("speed") else self._crossing(regime, e)
            found += [self._polished(regime, e, *pair, polish, slope) for pair in pairs]
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
        flat = [abs(here[kind] - target) <= blur(kind, here) for here in (rest, one)]
        if np.any(flat[0] & flat[1]):
            self.open = self.open | any_speed(self, regime, e)
        return [(value + 0.0 * x, x) if fixed == "speed_a" else (x, value + 0.0 * x) for x in xs]

    def _per_closing(self, regime: Any, slip: Any, e: Any) -> tuple[Any, Any, Any]:
        """Both observations at a closing speed of one unit and a slip, and their weight."""
        seen = self.observe(regime, *self.speeds_at(np.ones(()), slip), e)
        return seen[self.kinds[0]], seen[self.kinds[1]], seen["weight"]

    def _crossing(self, regime: Any, e: Any) -> list[tuple[Any, Any]]:
        """With two quadratic observations: their ratio depends on slip over closing speed alone."""
        c1, c2 = (self.targets[kind] for kind in self.kinds)
        # Where both tell the same of every slip, every slip fits, or none.
        seen = [self.observe(regime, *self.speeds_at(np.ones(()), np.full((), slip)), e) for slip in (-1.0, 0.0, 1.0)]
        samples = [(part[self.kinds[0]], part[self.kinds[1]], part["weight"]) for part in seen]
        alike = _everywhere(c1, c2, samples) | every_slip(self, seen)
        leaves_open = alike & reaches(self, regime) & ((c1 > 0.0) | (c2 > 0.0))
        self.open = self.open | leaves_open

        def difference(ratio: Any) -> Any:
            q1, q2, weight = self._per_closing(regime, ratio, e)
            return np.where(leaves_open, np.nan, (c2 * q1 - c1 * q2) * weight)

        pairs = []
        for ratio in _roots(regime, difference, np.ones(())):
            q1, q2, _ = self._per_closing(regime, ratio, e)
            closing = np.sqrt(np.where(c1 > 0.0, c1 / q1, c2 / q2))
            pairs.append(self.speeds_at(closing, ratio * closing))
        return pairs

    def blind(self, regime: Any, e: Any) -> tuple[Any, Any]:
        """Where both tell the same of every slip: by which part of themselves they are apart, and the closing speed."""
        c1, c2 = (self.targets[kind] for kind in self.kinds)
        samples = [self._per_closing(regime, np.full((), slip), e) for slip in (-1.0, 0.0, 1.0)]
        q1, q2, _ = samples[1]
        apart = (c2 * q1 - c1 * q2) / (abs(c2 * q1) + abs(c1 * q2))
        return np.where(_everywhere(q1, q2, samples), apart, np.nan), np.sqrt(c1 / q1)

    def _polished(
        self, regime: Any, e: Any, speed_a: Any, speed_b: Any, steps: int, slope: Callable[[Any], Any] | None
    ) -> Root:
        """Newton's method on the kernel, with central differences for its derivatives."""
        condition: Any = np.nan
        slopes: tuple[Any, ...] = (0.0, 0.0)
        rows: list[tuple[Any, Any]] = []
        here = self.observe(regime, speed_a, speed_b, e) if steps or slope is not None else {}
        for _ in range(steps):
            size = _STEP * (abs(speed_a) + abs(speed_b) + abs(here["closing"]))
            rows = self._derivatives(regime, e, speed_a, speed_b, size)
            (j11, j12), (j21, j22) = rows
            r1, r2 = (here[kind] - self.targets[kind] for kind in self.kinds)
            determinant = j11 * j22 - j12 * j21
            step_a, step_b = (r1 * j22 - r2 * j12) / determinant, (r2 * j11 - r1 * j21) / determinant
            ahead = self.observe(regime, speed_a - step_a, speed_b - step_b, e)
            # Where two roots meet the derivative is rounding, and a step over it may lead anywhere.
            away = self._off(ahead, here) > self._off(here, here)
            usable = np.isfinite(step_a) & np.isfinite(step_b) & ~away
            speed_a = speed_a - np.where(usable, step_a, 0.0)
            speed_b = speed_b - np.where(usable, step_b, 0.0)
            here = {name: np.where(usable, ahead[name], here[name]) for name in ahead}
            slopes = (abs(j11) + abs(j12), abs(j21) + abs(j22))
            condition = self._condition(rows, here["closing"])
        if slope is not None:
            # The restitution moves with the closing speed, and what is observed with it.
            after, before = (self.observe(regime, speed_a, speed_b, e + step) for step in (_STEP, -_STEP))
            e_by_closing = slope(here["closing"])
            by_e = [e_by_closing * (after[kind] - before[kind]) / (2.0 * _STEP) for kind in self.kinds]
            g_a, g_b = self.per_speed["closing"]
            whole = [(j_a + by * g_a, j_b + by * g_b) for (j_a, j_b), by in zip(rows, by_e, strict=True)]
            condition = self._condition(whole, here["closing"])
        return Root(speed_a, speed_b, e, condition, slopes)

    def _off(self, seen: dict[str, Any], here: dict[str, Any]) -> Any:
        """The larger part by which what is observed is off what was: for a loss, of the energy that it is what is left of."""
        whole = abs(here["closing"] * here["normal"])
        sizes = [abs(here[k]) + abs(self.targets[k]) + (whole if k == "energy_loss" else 0.0) for k in self.kinds]
        return np.fmax(*(abs(seen[k] - self.targets[k]) / size for k, size in zip(self.kinds, sizes, strict=True)))

    def _derivatives(self, regime: Any, e: Any, speed_a: Any, speed_b: Any, size: Any) -> list[tuple[Any, Any]]:
        """Of each observation by both speeds."""
        ahead_a, behind_a = (self.observe(regime, speed_a + h, speed_b, e) for h in (size, -size))
        ahead_b, behind_b = (self.observe(regime, speed_a, speed_b + h, e) for h in (size, -size))
        return [
            ((ahead_a[kind] - behind_a[kind]) / (2.0 * size), (ahead_b[kind] - behind_b[kind]) / (2.0 * size))
            for kind in self.kinds
        ]

    def _condition(self, rows: Sequence[Sequence[Any]], closing: Any) -> Any:
        """By how much relative errors of what was given may be larger in the speeds, taken relative to the closing speed."""
        (j11, j12), (j21, j22) = rows
        d1, d2 = ((2.0 if kind.startswith(_SQUARED) else 1.0) * abs(self.targets[kind]) for kind in self.kinds)
        moved = np.maximum(abs(d1 * j22) + abs(d2 * j12), abs(d2 * j11) + abs(d1 * j21))
        return moved / abs((j11 * j22 - j12 * j21) * closing)

    def fits(self, root: Root) -> tuple[Any, Any]:
        """Whether the law as asked leads from these speeds to what was observed, and the closing speed.

        The speeds of a root are themselves rounded, which moves an observation by its slope; the kernel adds the rounding of
        the parts that it sums up. What is off by more belongs to another regime than the law leads to. Near grazing rounding
        grows beyond the observation itself and tells nothing: there a part of the observation is the bound.
        """
        status, seen = self.outcome(root.speed_a, root.speed_b, root.restitution)
        # A course at a right angle to the normal, in radians, leaves a cosine of 1e-16: a closing speed that is what rounding
        # makes of speeds so large is none.
        fits = (status <= Status.ENERGY_GAIN) & (seen["closing"] > ROUNDING * seen["whole"])
        for kind, slope in zip(self.kinds, root.slopes, strict=True):
            scale = parts = seen["whole"] if kind.startswith("speed") else seen[kind]
            if kind == "energy_loss":
                scale = seen["closing"] * seen["normal"]
                # Where friction has a loss touch its least, speeds are found to the square root of rounding only.
                parts = seen["lost"] + np.where(self.bound == 0.0, 0.0, scale)
            rounding = ROUNDING * (slope * seen["whole"] + parts)
            fits = fits & (abs(seen[kind] - self.targets[kind]) <= np.minimum(rounding, SAME * scale))
        return fits, seen["closing"]


def _power_of_two(size: Any) -> Any:
    """The power of two next to a number; 1 for what is 0 or none."""
    usable = np.isfinite(size) & (size > 0.0)
    return np.ldexp(1.0, np.frexp(np.where(usable, size, 1.0))[1] - 1)


def _everywhere(p1: Any, p2: Any, samples: Sequence[tuple[Any, Any, Any]]) -> Any:
    """Whether two observations are in the proportion of p1 to p2 at every slip."""
    scale = sum(abs(p2 * q1) + abs(p1 * q2) for q1, q2, _ in samples)
    return np.logical_and.reduce([abs(p2 * q1 - p1 * q2) <= REDUNDANT * scale for q1, q2, _ in samples])


def _roots(regime: Any, at: Callable[[Any], Any], step: Any) -> Sequence[Any]:
    """Roots of what a regime makes of the observations, on a scale that the step gives."""
    if regime is _SHARE:
        return quartic_roots([at(step * place) for place in PLACES], step)
    return parabola_roots([at(-step), at(0.0 * step), at(step)], step)

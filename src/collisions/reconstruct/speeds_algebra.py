"""The algebra of ``speeds``: the observations as quadratic functions of both speeds (``Scene``), and the roots (``Root``).

As long as the contact keeps sliding one way, or sticks, the impulse is linear in the two speeds, and what was observed of it
quadratic. So in each regime the candidates are roots of a quadratic, read off the forward kernel at three places, polished on
it, and taken if the law that was given leads from them to what was observed. A share of the critical ratio makes the impulse a
quotient, with a divisor that is linear in the speeds; times its square what was observed is a quartic, read off at five places.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from ..kernels.contact_laws import CRITICAL_FRACTION, FRICTION, IMPULSE_RATIO, LAWS, energy_losses
from ..kernels.elementwise import larger, select
from ..kernels.floats import compile_for_floats
from ..kernels.reverse import PLACES, energy_of_speeds, parabola_roots, quartic_roots
from ..kernels.status import EPS, Status
from .common import NUMBERS, PAIRS, forward

# Relative difference within which two observations hold the same information.
REDUNDANT = 1e-9
# Difference, relative to the closing speed, within which two roots are one.
ROOT_TOL = 1e-6
# Worst case of the forward kernel's rounding, in eps of the parts that it adds up.
_KERNEL_ROUNDING = 32.0 * EPS
# Regimes whose impulse ratio is not known beforehand.
_STICK = "stick"
_SHARE = "share"
_NEWTON_STEPS = 3
# Finite-difference step, relative to the speeds and to a restitution of 1: exact for quadratics, to 1e-8 for quotients.
_STEP = 1e-4
# Relative shift of the speeds at a root, to see whether the observations fit there too.
_BESIDE = 0.02
# Sample points along a range of speeds: five, because an observation along it is a quotient of quartics at most.
_PARTS = (0.1, 0.3, 0.5, 0.7, 0.9)
_SQUARED = ("delta_v", "max_crush")
# Known under another name, but the same observation.
_OBSERVED_AS = {"ees_a": "energy_loss"}


class Root(NamedTuple):
    """A candidate solution: both speeds, their restitution, how well-posed they are, and the slope of each observation."""

    speed_a: Any
    speed_b: Any
    restitution: Any
    condition: Any
    slopes: Sequence[Any] = (0.0, 0.0)


class _Seen(NamedTuple):
    """The outputs of the forward kernel that tell of the observations."""

    status: Any
    closing_speed: Any
    slip_before: Any
    slip_after: Any
    normal_impulse: Any
    tangential_impulse: Any
    no_slip_normal: Any
    no_slip_tangential: Any
    effective_mass: Any
    coupling: Any
    energy_loss: Any


def _forward(*inputs: Any) -> _Seen:
    """The forward kernel of two free bodies."""
    raw = forward(*inputs, False, False)
    return _Seen._make(getattr(raw, name) for name in _Seen._fields)


@lru_cache(maxsize=16)
def _float_function(rule: str, law: str) -> Callable[[Sequence[float]], Any]:
    """The same compiled for plain floats."""
    return compile_for_floats(_forward, tuple(f"[{i}]" for i in range(24)), (rule, law))


class Scene:
    """Two vehicles whose speeds are unknown, and the two observations made of them.

    Every case is worked out in a unit of speed and a unit of mass of its own, powers of two, so that squares of what was given
    neither overflow nor vanish. ``speed_unit``, ``mass_unit`` lead back. A single case may be worked out with ``plain`` floats,
    much faster; then a division by 0 raises, and it has to be worked out without.
    """

    def __init__(self, given: dict[str, Any], rule: str, law: str, kinds: tuple[str, ...], plain: bool = False) -> None:
        self.given, self.rule, self.law, self.names = given, rule, law, kinds
        self.kinds = tuple(_OBSERVED_AS.get(kind, kind) for kind in kinds)
        masses = np.minimum(given["a.mass"], given["b.mass"])
        sizes = [np.sqrt(given[kind]) / np.sqrt(masses) if kind == "energy_loss" else abs(given[kind]) for kind in kinds]
        self.mass_unit = _power_of_two(masses)
        self.speed_unit = _power_of_two(np.maximum.reduce(np.broadcast_arrays(*sizes)))
        self.numbers = {name: self._in_units(name, value) for name, value in given.items()}
        self.e, self.bound = given["restitution"], given[rule]
        v: dict[str, Any] = {name: float(value) for name, value in self.numbers.items()} if plain else self.numbers
        self.plain = plain
        self.courses = [[v[f"course_{label}[{i}]"] for i in range(2)] for label in "ab"]
        bodies = (v.get(f"{label}.{name}", 0.0) for label in "ab" for name in NUMBERS)
        self.at_rest = [v["restitution"], v["normal[0]"], v["normal[1]"], v[rule], v["point[0]"], v["point[1]"], *bodies]
        self.targets = {kind: self._target(name) for kind, name in zip(self.kinds, kinds, strict=True)}
        if self.plain:
            self.targets = {kind: float(target) for kind, target in self.targets.items()}
        self.spinning = sum(
            abs(self.numbers[f"{label}.yaw_rate"])
            * np.hypot(*(given[f"point[{i}]"] - given[f"{label}.{x}"] for i, x in enumerate("xy")))
            for label in "ab"
        )
        # Whether backward roots are left out.
        self.forward_only = False
        if plain:
            self.e, self.bound, self.spinning = float(self.e), float(self.bound), float(self.spinning)
        # Set where any slip, or any speed, fits in a regime.
        self.undetermined: Any = np.zeros((), dtype=bool)
        zero, one = np.zeros(()), np.ones(())
        seen = [self.observe(_STICK, *pair, self.e) for pair in ((zero, zero), (one, zero), (zero, one))]
        self.rest = {name: seen[0][name] for name in ("closing", "slip")}
        self.per_speed = {name: tuple(part[name] - self.rest[name] for part in seen[1:]) for name in self.rest}

    def of(self, case: Any, shape: tuple[int, ...]) -> Scene:
        """The scene of some cases, by their places in the flattened batch."""
        flat = {name: np.broadcast_to(value, shape).reshape(-1)[case] for name, value in self.given.items()}
        return Scene(flat, self.rule, self.law, self.names)

    def _in_units(self, name: str, value: Any) -> Any:
        kind = name.rpartition(".")[2]
        if kind in ("mass", "yaw_inertia"):
            return value / self.mass_unit
        if kind == "energy_loss":
            return value / self.mass_unit / self.speed_unit / self.speed_unit
        return value / self.speed_unit if kind.startswith(("speed", "delta_v", "ees", "max_crush", "yaw_rate")) else value

    def _target(self, kind: str) -> Any:
        """The observed value in the form that is quadratic in the speeds."""
        value = self.numbers[kind]
        if kind.startswith("delta_v"):
            return (self.numbers[f"{kind[-1]}.mass"] * value) ** 2
        if kind in PAIRS:
            return energy_of_speeds(self.numbers["a.mass"], value, self.numbers["b.mass"], self.numbers[PAIRS[kind]])
        return value

    def shares_critical(self) -> bool:
        """Whether the impulse ratio depends on the answer."""
        return self.rule == CRITICAL_FRACTION and bool(np.any((self.bound > 0.0) & (self.bound < 1.0)))

    def regimes(self) -> list[Any]:
        """The impulse ratios, or sticking, that have to be tried."""
        if self.rule == IMPULSE_RATIO:
            return [self.bound]
        if self.rule == CRITICAL_FRACTION:
            return [np.where(self.bound == 0.0, 0.0, np.nan), _STICK, *([_SHARE] if self.shares_critical() else [])]
        finite = select(abs(self.bound) == np.inf, np.nan, self.bound)
        return [finite, select(self.bound > 0.0, -finite, np.nan), _STICK]

    def run(self, speed_a: Any, speed_b: Any, e: Any, rule: str, bound: Any) -> Any:
        """The forward kernel at these speeds."""
        if self.plain:
            numbers = self._of_forward(float(speed_a), float(speed_b), float(e), float(bound))
            found = _float_function(rule, self.law)(numbers)
            if found is not None:
                return found
        return _forward(*self._of_forward(speed_a, speed_b, e, bound), rule, self.law)

    def _of_forward(self, speed_a: Any, speed_b: Any, e: Any, bound: Any) -> list[Any]:
        """The numbers that the forward kernel takes, in their order."""
        found = self.at_rest.copy()
        found[0], found[3] = e, bound
        for start, speed, (cx, cy) in zip((8, 17), (speed_a, speed_b), self.courses, strict=True):
            found[start : start + 2] = speed * cx, speed * cy
        return found

    def observe(self, regime: Any, speed_a: Any, speed_b: Any, e: Any) -> dict[str, Any]:
        """The observations at these speeds if the contact is in this regime; times its weight, a polynomial of them."""
        if not isinstance(regime, str):
            return self._seen(self.run(speed_a, speed_b, e, IMPULSE_RATIO, regime), speed_a, speed_b, e)
        raw = self.run(speed_a, speed_b, e, FRICTION, 0.0)
        normal, tangential = raw.no_slip_normal, raw.no_slip_tangential
        if regime is _SHARE:
            shared = self.bound * tangential
            weight = (normal + shared * (raw.coupling * raw.effective_mass)) ** 2
            return self.observe(shared / normal, speed_a, speed_b, e) | {"weight": weight}
        left = LAWS[self.law].sticking_slip(e)
        slips = (raw.slip_before, left * raw.slip_before, (1.0 + left) * raw.slip_before, 0.0)
        loss = energy_losses(e, raw.closing_speed, *slips, normal, tangential, None, EPS)[2]
        return self._seen(raw, speed_a, speed_b, e, (normal, tangential, loss))

    def outcome(self, speed_a: Any, speed_b: Any, e: Any) -> tuple[Any, dict[str, Any]]:
        """Status and observations at these speeds under the given law."""
        raw = self.run(speed_a, speed_b, e, self.rule, self.bound)
        return raw.status, self._seen(raw, speed_a, speed_b, e)

    def _seen(self, raw: Any, speed_a: Any, speed_b: Any, e: Any, sticking: tuple[Any, ...] = ()) -> dict[str, Any]:
        """What is seen of the forward answer; ``sticking`` has the impulse and the loss in place of its own."""
        closing = raw.closing_speed
        normal, tangential, loss = sticking or (raw.normal_impulse, raw.tangential_impulse, raw.energy_loss)
        squared = normal * normal + tangential * tangential
        if self.plain:
            speed_a, speed_b, e = float(speed_a), float(speed_b), float(e)
        whole = abs(speed_a) + abs(speed_b) + self.spinning
        return {
            "weight": 1.0,
            "closing": closing,
            "slip": raw.slip_before,
            "whole": whole,
            "normal": normal,
            "tangential": tangential,
            "impulse": math.sqrt(squared) if type(squared) is float else np.sqrt(squared),
            # The terms of the loss, with each contact velocity as large as the velocities it is the difference of.
            "lost": (1.0 - e) * closing * normal + abs(tangential) * (whole + abs(raw.slip_after)),
            "speed_a": speed_a,
            "speed_b": speed_b,
            "delta_v_a": squared,
            "delta_v_b": squared,
            "energy_loss": loss,
            # What an incomplete impact absorbs it loses.
            "max_crush_speed_a": 0.5 * closing * normal * select(e < 0.0, 1.0 - e, 1.0 / (1.0 + e)),
        }

    def speeds_at(self, closing: Any, slip: Any) -> tuple[Any, Any]:
        """The speeds along the courses that give this closing speed and slip; NaN for parallel courses."""
        (ga, gb), (sa, sb) = self.per_speed["closing"], self.per_speed["slip"]
        crossed = ga * sb - gb * sa
        crossed = np.where(abs(crossed) <= 64.0 * EPS * (np.hypot(ga, sa) * np.hypot(gb, sb)), np.nan, crossed)
        g, s = closing - self.rest["closing"], slip - self.rest["slip"]
        return (g * sb - s * gb) / crossed, (s * ga - g * sa) / crossed

    def roots(self, e: Any = None, polish: int = _NEWTON_STEPS, slope: Callable[[Any], Any] | None = None) -> list[Root]:
        """All candidates of every regime, before ``fits`` checks them against the law.

        ``slope`` is the change of restitution with the closing speed, where there is one.
        """
        e = self.e if e is None else e
        self.undetermined = np.zeros((), dtype=bool)
        found: list[Root] = []
        for regime in self.regimes():
            pairs = self._on_a_line(regime, e) if self.kinds[0].startswith("speed") else self._crossing(regime, e)
            found += [self._polished(regime, e, *pair, polish, slope) for pair in pairs]
        return found

    def _with_known_speed(self, other: Any) -> tuple[Any, Any]:
        """Both speeds, where one is known."""
        known = self.targets[self.kinds[0]] + 0.0 * other
        return (known, other) if self.kinds[0] == "speed_a" else (other, known)

    def _on_a_line(self, regime: Any, e: Any) -> list[tuple[Any, Any]]:
        """With one speed known: the other speeds at which the observation is met."""
        fixed, kind = self.kinds
        target = self.targets[kind]

        def seen(x: Any) -> dict[str, Any]:
            return self.observe(regime, *self._with_known_speed(x), e)

        def excess(x: Any) -> Any:
            here = seen(x)
            return (here[kind] - target) * here["weight"]

        # The step: the speeds at 0, plus the unknown speed that reaches the target if its effect grows from that of one unit.
        rest, one = seen(np.zeros(())), seen(np.ones(()))
        needed = np.sqrt(abs(target / (one[kind] - rest[kind])))
        step = abs(self.targets[fixed]) + abs(rest["closing"]) + abs(rest["slip"])
        step = step + np.where(np.isfinite(needed), needed, 0.0)
        xs = _roots(regime, excess, np.where(step > 0.0, step, 1.0))
        flat = [abs(here[kind] - target) <= _observation_rounding(kind, here) for here in (rest, one)]
        if np.any(flat[0] & flat[1]):
            self.undetermined = self.undetermined | self._any_speed_fits(regime, e)
        return [self._with_known_speed(x) for x in xs]

    def _per_closing(self, regime: Any, slip: Any, e: Any) -> dict[str, Any]:
        """The observations at unit closing speed and this slip."""
        return self.observe(regime, *self.speeds_at(np.ones(()), slip), e)

    def _crossing(self, regime: Any, e: Any) -> list[tuple[Any, Any]]:
        """With two quadratic observations: their ratio depends on slip over closing speed alone."""
        k1, k2 = self.kinds
        c1, c2 = self.targets[k1], self.targets[k2]
        # Where both observations depend on slip alike, every slip fits, or none.
        samples = [self._per_closing(regime, np.full((), slip), e) for slip in (-1.0, 0.0, 1.0)]
        alike = self._redundant(c1, c2, samples) | np.logical_and.reduce(
            [
                abs(c2 * seen[k1] - c1 * seen[k2])
                <= c2 * _observation_rounding(k1, seen) + c1 * _observation_rounding(k2, seen)
                for seen in samples
            ]
        )
        any_slip = alike & self._can_occur(regime) & ((c1 > 0.0) | (c2 > 0.0))
        self.undetermined = self.undetermined | any_slip

        def difference(ratio: Any) -> Any:
            seen = self._per_closing(regime, ratio, e)
            return np.where(any_slip, np.nan, (c2 * seen[k1] - c1 * seen[k2]) * seen["weight"])

        pairs = []
        for ratio in _roots(regime, difference, np.ones(())):
            seen = self._per_closing(regime, ratio, e)
            closing = np.sqrt(np.where(c1 > 0.0, c1 / seen[k1], c2 / seen[k2]))
            pairs.append(self.speeds_at(closing, ratio * closing))
        return pairs

    def any_slip_at(self, regime: Any, e: Any) -> tuple[Any, Any]:
        """For two observations that depend on slip alike: their relative difference, and the closing speed."""
        k1, k2 = self.kinds
        samples = [self._per_closing(regime, np.full((), slip), e) for slip in (-1.0, 0.0, 1.0)]
        q1, q2 = samples[1][k1], samples[1][k2]
        of_first, of_second = self.targets[k2] * q1, self.targets[k1] * q2
        apart = (of_first - of_second) / (abs(of_first) + abs(of_second))
        return np.where(self._redundant(q1, q2, samples), apart, np.nan), np.sqrt(self.targets[k1] / q1)

    def _redundant(self, p1: Any, p2: Any, samples: Sequence[dict[str, Any]]) -> Any:
        """Whether both observations have the ratio p1 to p2 at every slip."""
        k1, k2 = self.kinds
        scale = sum(abs(p2 * seen[k1]) + abs(p1 * seen[k2]) for seen in samples)
        return np.logical_and.reduce([abs(p2 * seen[k1] - p1 * seen[k2]) <= REDUNDANT * scale for seen in samples])

    def _polished(
        self, regime: Any, e: Any, speed_a: Any, speed_b: Any, steps: int, slope: Callable[[Any], Any] | None
    ) -> Root:
        """Newton's method on the kernel, with central differences for its derivatives."""
        if self.plain:
            speed_a, speed_b, e = float(speed_a), float(speed_b), float(e)
            if not math.isfinite(speed_a + speed_b):
                steps = 0
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
            usable = (step_a - step_a == 0.0) & (step_b - step_b == 0.0) & (away ^ True)
            speed_a = speed_a - select(usable, step_a, 0.0)
            speed_b = speed_b - select(usable, step_b, 0.0)
            here = ahead if usable is True else {name: select(usable, ahead[name], here[name]) for name in ahead}
            slopes = (abs(j11) + abs(j12), abs(j21) + abs(j22))
            condition = self._condition(rows, here["closing"])
            if usable is False:
                break
        if slope is not None:
            # The restitution changes with the closing speed, and the observations with it.
            after, before = (self.observe(regime, speed_a, speed_b, e + step) for step in (_STEP, -_STEP))
            e_by_closing = slope(here["closing"])
            by_e = [e_by_closing * (after[kind] - before[kind]) / (2.0 * _STEP) for kind in self.kinds]
            g_a, g_b = self.per_speed["closing"]
            whole = [(j_a + by * g_a, j_b + by * g_b) for (j_a, j_b), by in zip(rows, by_e, strict=True)]
            condition = self._condition(whole, here["closing"])
        return Root(speed_a, speed_b, e, condition, slopes)

    def _off(self, seen: dict[str, Any], here: dict[str, Any]) -> Any:
        """Largest relative residual of both observations.

        An energy loss is measured against closing speed times normal impulse.
        """
        whole = abs(here["closing"] * here["normal"])
        sizes = [abs(here[k]) + abs(self.targets[k]) + (whole if k == "energy_loss" else 0.0) for k in self.kinds]
        return larger(*(abs(seen[k] - self.targets[k]) / size for k, size in zip(self.kinds, sizes, strict=True)))

    def _derivatives(self, regime: Any, e: Any, speed_a: Any, speed_b: Any, size: Any) -> list[tuple[Any, Any]]:
        """Derivatives of each observation by both speeds."""
        ahead_a, behind_a = (self.observe(regime, speed_a + h, speed_b, e) for h in (size, -size))
        ahead_b, behind_b = (self.observe(regime, speed_a, speed_b + h, e) for h in (size, -size))
        return [
            ((ahead_a[kind] - behind_a[kind]) / (2.0 * size), (ahead_b[kind] - behind_b[kind]) / (2.0 * size))
            for kind in self.kinds
        ]

    def _condition(self, rows: Sequence[Sequence[Any]], closing: Any) -> Any:
        """Condition: the factor by which relative input errors grow in the speeds, taken relative to the closing speed."""
        (j11, j12), (j21, j22) = rows
        d1, d2 = ((2.0 if kind.startswith(_SQUARED) else 1.0) * abs(self.targets[kind]) for kind in self.kinds)
        moved = np.maximum(abs(d1 * j22) + abs(d2 * j12), abs(d2 * j11) + abs(d1 * j21))
        return moved / abs((j11 * j22 - j12 * j21) * closing)

    def fits(self, root: Root) -> tuple[Any, Any]:
        """Whether the given law leads from these speeds to the observed values, and the closing speed.

        The speeds of a root are themselves rounded, which moves an observation by its slope; the kernel adds the rounding of
        the parts that it sums up. What is off by more belongs to another regime than the law leads to. Near grazing rounding
        grows beyond the observation itself and tells nothing: there a part of the observation is the bound.
        """
        raw = self.run(root.speed_a, root.speed_b, root.restitution, self.rule, self.bound)
        seen = self._seen(raw, root.speed_a, root.speed_b, root.restitution)
        fits = self.pushed(raw, root.speed_a, root.speed_b)
        for kind, slope in zip(self.kinds, root.slopes, strict=True):
            scale = parts = seen["whole"] if kind.startswith("speed") else seen[kind]
            if kind == "energy_loss":
                scale = seen["closing"] * seen["normal"]
                # Where friction makes the loss touch its minimum, speeds are accurate only to the square root of rounding.
                parts = seen["lost"] + np.where(self.bound == 0.0, 0.0, scale)
            rounding = _KERNEL_ROUNDING * (slope * seen["whole"] + parts)
            fits = fits & (abs(seen[kind] - self.targets[kind]) <= np.minimum(rounding, ROOT_TOL * scale))
        return fits, seen["closing"]

    def pushed(self, raw: Any, speed_a: Any, speed_b: Any) -> Any:
        """Whether these speeds are answered, with a closing speed beyond rounding.

        A course at a right angle to the normal, in radians, leaves a cosine of 1e-16: a closing speed that is what rounding
        makes of such large speeds counts as 0.
        """
        whole = abs(speed_a) + abs(speed_b) + self.spinning
        return (raw.status <= Status.ENERGY_GAIN) & (raw.closing_speed > _KERNEL_ROUNDING * whole)

    def _can_occur(self, regime: Any) -> Any:
        """Whether the law allows a regime: no sticking without friction, nor with less than the critical ratio."""
        if regime is _STICK:
            return self.bound == 1.0 if self.rule == CRITICAL_FRACTION else self.bound > 0.0
        return True

    def _any_speed_fits(self, regime: Any, e: Any) -> Any:
        """With one speed known: whether every other speed in this regime gives the same observation, and the one observed."""
        size = abs(self.targets[self.kinds[0]]) + abs(self.rest["closing"]) + abs(self.rest["slip"])
        size = np.where(size > 0.0, size, 1.0)
        low: Any = np.full((), -np.inf)
        high: Any = np.full((), np.inf)
        raws = (self.run(*self._with_known_speed(x), e, FRICTION, 0.0) for x in (-size, size))
        for behind, ahead in zip(*(self._conditions(regime, raw) for raw in raws), strict=True):
            # Each is linear in the speed, so it changes sign at one place.
            middle = size * (behind + ahead) / (behind - ahead)
            low = np.where(ahead > behind, np.maximum(low, middle), low)
            high = np.where(ahead < behind, np.minimum(high, middle), high)
            high = np.where((ahead == behind) & np.logical_not(ahead > 0.0), -np.inf, high)
        nearest = np.maximum(low, np.minimum(high, 0.0))
        low, high = np.maximum(low, nearest - size), np.minimum(high, nearest + size)
        wide = high - low > ROOT_TOL * size
        places = [self._with_known_speed(low + part * (high - low)) for part in _PARTS]
        return self._can_occur(regime) & wide & self._all_fit(e, places)

    def _conditions(self, regime: Any, raw: Any) -> list[Any]:
        """The expressions that must be positive for the law to lead to a regime."""
        closing, normal, tangential = raw.closing_speed, raw.no_slip_normal, raw.no_slip_tangential
        if self.rule == IMPULSE_RATIO:
            return [closing]
        if self.rule == CRITICAL_FRACTION:
            return [closing, np.where(self.bound > 0.0, normal, 1.0)]
        endless = np.isinf(self.bound)
        most = np.where(endless, 1.0, self.bound) * normal
        across = np.where(endless, 0.0, tangential)
        if regime is _STICK:
            return [closing, most - across, most + across]
        return [closing, np.where(self.bound > 0.0, np.copysign(1.0, regime) * across - most, 1.0)]

    def one_of_many(self, root: Root) -> Any:
        """Whether the speeds on one side of a root also give the observed values: a continuous range of solutions."""
        e = root.restitution
        size = abs(root.speed_a) + abs(root.speed_b) + self.spinning
        many: Any = False
        for side in (-_BESIDE, _BESIDE):
            pairs = [(root.speed_a, root.speed_b)]
            for moved in (0.5 * side * size, side * size):
                if self.kinds[0] == "speed_b":
                    pairs.append((root.speed_a + moved, root.speed_b))
                else:
                    beside = (root.speed_a, root.speed_b + moved)
                    pairs.append(beside if self.kinds[0] == "speed_a" else self._scaled(*beside, e))
            many = many | self._all_fit(e, pairs)
        return many

    def _scaled(self, speed_a: Any, speed_b: Any, e: Any) -> tuple[Any, Any]:
        """The speeds, scaled at the same slip per closing speed, that give the observation that is not a loss."""
        kind = self.kinds[1] if self.kinds[0] == "energy_loss" else self.kinds[0]
        seen = self.outcome(speed_a, speed_b, e)[1]
        factor = np.sqrt(self.targets[kind] / seen[kind])
        return self.speeds_at(factor * seen["closing"], factor * seen["slip"])

    def _all_fit(self, e: Any, pairs: Sequence[tuple[Any, Any]]) -> Any:
        """Whether the law leads from all these speeds to the observed values, and to the same value from each.

        An energy that was given is known to the rounding of the energies that it is the difference of. What the kernel answers
        is known to that of the energies lost alone: close to a restitution of 1 it tells amounts apart that are far smaller.
        """
        fit: Any = True
        first: dict[str, Any] = {}
        for speed_a, speed_b in pairs:
            status, seen = self.outcome(speed_a, speed_b, e)
            first = first or seen
            fit = fit & (status <= Status.ENERGY_GAIN)
            for kind in self.kinds:
                if kind.startswith("speed"):
                    continue
                rounding = _observation_rounding(kind, seen)
                within = _KERNEL_ROUNDING * (seen["lost"] + first["lost"])
                if kind != "energy_loss":
                    within = rounding + _observation_rounding(kind, first)
                fit = fit & (abs(seen[kind] - self.targets[kind]) <= rounding)
                fit = fit & (abs(seen[kind] - first[kind]) <= within)
        return fit


def _power_of_two(size: Any) -> Any:
    """The power of two next to a number; 1 for 0, NaN and infinity."""
    usable = np.isfinite(size) & (size > 0.0)
    return np.ldexp(1.0, np.frexp(np.where(usable, size, 1.0))[1] - 1)


def _observation_rounding(kind: str, seen: dict[str, Any]) -> Any:
    """Worst rounding error of an observation that was itself computed from speeds.

    An energy that is the difference of those before and after is known to the rounding of the impulse times the speeds.
    """
    if kind == "energy_loss":
        return _KERNEL_ROUNDING * seen["impulse"] * seen["whole"]
    return 2.0 * _KERNEL_ROUNDING * seen[kind] * (seen["whole"] / abs(seen["closing"]))


def _roots(regime: Any, at: Callable[[Any], Any], step: Any) -> Sequence[Any]:
    """Roots of a regime's equation in the observations, on a scale that the step gives."""
    if regime is _SHARE:
        return quartic_roots([at(step * place) for place in PLACES], step)
    return parabola_roots([at(-step), at(0.0 * step), at(step)], step)

"""The algebra of ``speeds``: the observations as quadratic functions of both speeds (``Scene``),
and the roots (``Root``).

As long as the contact keeps sliding one way, or sticks, the impulse is linear in the two speeds,
and what was observed of it quadratic. So in each regime the candidates are roots of a quadratic,
read off the forward kernel at three places, polished on it, and taken if the law that was given
leads from them to what was observed. A share of the critical ratio makes the impulse a quotient,
with a divisor that is linear in the speeds; times its square what was observed is a quartic, read
off at five places.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property, lru_cache, partial
from operator import attrgetter
from typing import Any, NamedTuple

import numpy as np

from ..engine.floats import compile_for_floats
from ..kernels.contact_laws import CRITICAL_FRACTION, FRICTION, IMPULSE_RATIO, LAWS, energy_losses
from ..kernels.elementwise import larger, select
from ..kernels.problem import Contact
from ..kernels.reverse import PLACES, energy_of_speeds, parabola_roots, quartic_roots
from ..kernels.status import EPS, Status
from .common import NUMBERS, PAIRS, forward
from .restitution_roots import RestitutionOf

# Relative difference within which two observations hold the same information.
REDUNDANT = 1e-9
# Difference, relative to the closing speed, within which two roots are one.
ROOT_TOL = 1e-6
# Worst case of the forward kernel's rounding, in eps of the parts that it adds up.
_KERNEL_ROUNDING = 32.0 * EPS
# Regimes whose impulse ratio is not known beforehand, and the one that the law leads to.
STICK, _SHARE, LAW = "stick", "share", "law"
_NEWTON_STEPS = 3
# Finite-difference step, relative to the speeds and to a restitution of 1: exact for quadratics, to
# 1e-8 for quotients.
_STEP = 1e-4
# How near a root that is not polished yet is to its place, relative to the speeds and to the
# impulse: far more than rounding.
_UNPOLISHED, _IMPULSE_UNPOLISHED = 1e-6, 1e-2
# Relative shift of the speeds at a root, to see whether the observations fit there too.
_BESIDE = 0.02
# Sample points along a range of speeds: five, because an observation along it is a quotient of
# quartics at most.
_PARTS = (0.1, 0.3, 0.5, 0.7, 0.9)
# What is observed, where that is not of the same name.
_OBSERVED_AS = {
    "delta_v_a": "squared_impulse",
    "delta_v_b": "squared_impulse",
    "ees_a": "energy_loss",
    "max_crush_speed_a": "absorbed_energy",
}
_OF_BODY = [name for name in NUMBERS if name not in ("vx", "vy")]
# The numbers that do not change with the speeds, in the order of ``_observed``, which takes the
# part of spinning first.
_FIXED = [f"{name}[{i}]" for name in ("normal", "point", "course_a", "course_b") for i in range(2)]
_FIXED += [f"{label}.{name}" for label in "ab" for name in _OF_BODY]
# Impulses of tyres on A and on B, along x and y and about the centre of mass, where they act.
HELD = [f"held_{label}.{name}" for label in "ab" for name in ("impulse_x", "impulse_y", "moment")]
# 1 where the tyres of a contact that stuck make it one that slid, and the other way round.
EITHER = "either"
# 1 where a contact that is stated to have stuck may take any friction.
FREE = "free"


class Root(NamedTuple):
    """A candidate solution: both speeds, their restitution, condition and closing speed.

    The closing speed is NaN unless the law leads from these speeds to the observed values;
    ``one_of_many`` says whether it leads there from those beside them as well, ``way`` of which of
    several scenes it is a root, where readings may mean one impulse or another.
    """

    speed_a: Any
    speed_b: Any
    restitution: Any
    condition: Any
    closing: Any
    one_of_many: Any = False
    way: Any = 0.0


NO_ROOT = Root(*[math.nan] * 5)


class Observed(NamedTuple):
    """What the forward kernel tells at two speeds; an observation times ``weight`` is a polynomial
    of them.
    """

    status: Any
    speed_a: Any
    speed_b: Any
    whole: Any
    closing: Any
    slip: Any
    normal: Any
    tangential: Any
    # The terms of the loss, with each contact velocity as large as the velocities it is the
    # difference of.
    lost: Any
    squared_impulse: Any
    energy_loss: Any
    absorbed_energy: Any
    effective_mass: Any
    coupling: Any
    weight: Any = 1.0


def _observed(speed_a: Any, speed_b: Any, e: Any, bound: Any, *fixed: Any) -> Observed:
    """The kernel of free bodies at these speeds; with ``sticks`` the impulse and the loss are those
    of a sticking contact.
    """
    *numbers, sticks, rule, law, held = fixed
    outside = None
    if held:
        outside = tuple(numbers[-6:-3]), tuple(numbers[-3:])
        numbers = numbers[:-6]
    spinning, nx, ny, px, py, *courses = numbers[:9]
    mass_a, inertia_a, *place_a = numbers[9:16]
    mass_b, inertia_b, *place_b = numbers[16:]
    body_a = mass_a, inertia_a, speed_a * courses[0], speed_a * courses[1], *place_a
    body_b = mass_b, inertia_b, speed_b * courses[2], speed_b * courses[3], *place_b
    contact = Contact(e, (nx, ny), bound, (px, py))
    raw = forward(contact, (body_a, body_b), rule, law, outside=outside)
    closing, slip = raw.closing_speed, raw.slip_before
    normal, tangential, loss = raw.normal_impulse, raw.tangential_impulse, raw.energy_loss
    if sticks:
        normal, tangential = raw.no_slip_normal, raw.no_slip_tangential
        slip_after = LAWS[law].sticking_slip(e) * slip
        loss = energy_losses(
            law, e, closing, slip, slip_after, True, 0.0, normal, tangential, None, EPS
        )[2]
    whole = abs(speed_a) + abs(speed_b) + spinning
    return Observed(
        status=raw.status,
        speed_a=speed_a,
        speed_b=speed_b,
        whole=whole,
        closing=closing,
        slip=slip,
        normal=normal,
        tangential=tangential,
        lost=(1.0 - e) * closing * normal + abs(tangential) * (whole + abs(raw.slip_after)),
        squared_impulse=normal * normal + tangential * tangential,
        energy_loss=loss,
        # What an incomplete impact absorbs it loses.
        absorbed_energy=0.5 * closing * normal * select(e < 0.0, 1.0 - e, 1.0 / (1.0 + e)),
        effective_mass=raw.effective_mass,
        coupling=raw.coupling,
    )


@lru_cache(maxsize=16)
def _observed_of_floats(
    sticks: bool, rule: str, law: str, held: bool
) -> Callable[[Sequence[float]], Observed | None]:
    """The same compiled for plain floats."""
    count = 5 + len(_FIXED) + (len(HELD) if held else 0)
    return compile_for_floats(
        _observed, tuple(f"[{i}]" for i in range(count)), (sticks, rule, law, held)
    )


class Scene:
    """Two vehicles whose speeds are unknown, and the two observations made of them.

    Every case is worked out in a unit of speed and a unit of mass of its own, powers of two, so
    that squares of what was given neither overflow nor vanish. ``speed_unit``, ``mass_unit`` lead
    back. A single case may be worked out with ``plain`` floats, much faster; then a division by 0
    raises, and it has to be worked out without.
    """

    def __init__(
        self,
        given: dict[str, Any],
        rule: str,
        law: str,
        names: tuple[str, ...],
        shape: tuple[int, ...],
        plain: bool = False,
    ) -> None:
        self.rule, self.law, self.names, self.shape, self.plain = rule, law, names, shape, plain
        self.kinds = tuple(_OBSERVED_AS.get(name, name) for name in names)
        # Observed as squares of what was given, whose relative errors are half of theirs.
        self.squares = frozenset(_OBSERVED_AS[name] for name in names if name in _OBSERVED_AS)
        number: Callable[[Any], Any] = float if plain else partial(np.asarray, dtype=np.float64)
        self.given = {name: number(value) for name, value in given.items()}
        masses = np.minimum(self.given["a.mass"], self.given["b.mass"])
        known = [(name, self.given[name]) for name in names]
        sizes = [
            np.sqrt(value) / np.sqrt(masses) if name == "energy_loss" else abs(value)
            for name, value in known
        ]
        self.mass_unit = number(_power_of_two(masses))
        self.speed_unit = number(_power_of_two(np.maximum.reduce(np.broadcast_arrays(*sizes))))
        self.numbers = v = {name: self._in_units(name, value) for name, value in self.given.items()}
        arms = {
            label: np.hypot(*(v[f"point[{i}]"] - v[f"{label}.{x}"] for i, x in enumerate("xy")))
            for label in "ab"
        }
        spinning = number(sum(abs(v[f"{label}.yaw_rate"]) * arm for label, arm in arms.items()))
        # Whether impulses of tyres act on both besides.
        self.held = HELD[0] in v
        self.fixed = [spinning, *(v[name] for name in (*_FIXED, *(HELD if self.held else ())))]
        self.e, self.bound = v["restitution"], v[rule]
        # Whether any case has a share of the critical ratio.
        self.shares = shares_critical(rule, self.bound)
        # Both observations of what is seen.
        self.both: Callable[[Observed], Any] = attrgetter(*self.kinds)
        self.targets = {
            kind: number(self._target(name)) for kind, name in zip(self.kinds, names, strict=True)
        }
        # Set where any slip, or any speed, fits in a regime; and where two regimes fit.
        self.undetermined: Any = np.zeros((), dtype=bool)
        self.ambiguous: Any = np.zeros((), dtype=bool)

    def of(self, cases: Any, e: Any = None) -> Scene:
        """The scene of some cases, by their places in the flattened batch, perhaps with another
        restitution.
        """
        given = {name: self.flat(value)[cases] for name, value in self.given.items()}
        if e is not None:
            given["restitution"] = e
        return Scene(given, self.rule, self.law, self.names, np.shape(cases))

    def findings(self) -> dict[str, Any]:
        """What ``roots`` found of every case besides them, by name."""
        return {"undetermined": self.undetermined, "ambiguous": self.ambiguous}

    def take(self, found: Mapping[str, Any]) -> None:
        """Take over the ``findings`` of all parts of these cases."""
        self.undetermined, self.ambiguous = found["undetermined"], found["ambiguous"]

    def flat(self, value: Any) -> Any:
        """A value of every case, one after another."""
        return np.broadcast_to(value, self.shape).reshape(-1)

    def _in_units(self, name: str, value: Any) -> Any:
        kind = name.rpartition(".")[2]
        if kind in ("mass", "yaw_inertia"):
            return value / self.mass_unit
        if kind == "energy_loss":
            return value / self.mass_unit / self.speed_unit / self.speed_unit
        if name.startswith("held"):
            return value / self.mass_unit / self.speed_unit
        return (
            value / self.speed_unit
            if kind.startswith(("speed", "delta_v", "ees", "max_crush", "yaw_rate"))
            else value
        )

    def _target(self, name: str) -> Any:
        """The observed value in the form that is quadratic in the speeds."""
        value = self.numbers[name]
        if name.startswith("delta_v"):
            return (self.numbers[f"{name[-1]}.mass"] * value) ** 2
        if name in PAIRS:
            return energy_of_speeds(
                self.numbers["a.mass"], value, self.numbers["b.mass"], self.numbers[PAIRS[name]]
            )
        return value

    def regimes(self) -> list[Any]:
        """The impulse ratios, or sticking, that have to be tried."""
        if self.rule == IMPULSE_RATIO:
            return [self.bound]
        if self.rule == CRITICAL_FRACTION:
            shares = [_SHARE] if self.shares else []
            return [np.where(self.bound == 0.0, 0.0, np.nan), STICK, *shares]
        finite = select(abs(self.bound) == np.inf, np.nan, self.bound)
        return [finite, select(self.bound > 0.0, -finite, np.nan), STICK]

    def observe(self, regime: Any, speed_a: Any, speed_b: Any, e_step: float = 0.0) -> Observed:
        """The observations at these speeds if the contact is in this regime, or in the one that the
        law leads to.
        """
        e = self.e + e_step if e_step else self.e
        if regime is _SHARE:
            stuck = self.observe(STICK, speed_a, speed_b)
            # A case without a share has none of these roots, whatever its neighbours have.
            share = select((self.bound > 0.0) & (self.bound < 1.0), self.bound, np.nan)
            shared = share * stuck.tangential
            weight = (stuck.normal + shared * (stuck.coupling * stuck.effective_mass)) ** 2
            return self.observe(shared / stuck.normal, speed_a, speed_b)._replace(weight=weight)
        rule, bound = IMPULSE_RATIO, regime
        if isinstance(regime, str):
            rule, bound = (FRICTION, 0.0) if regime is STICK else (self.rule, self.bound)
        settings = regime is STICK, rule, self.law, self.held
        if not self.plain:
            return _observed(speed_a, speed_b, e, bound, *self.fixed, *settings)
        numbers: list[Any] = [float(speed_a), float(speed_b), float(e), float(bound), *self.fixed]
        return _observed_of_floats(*settings)(numbers) or _observed(*numbers, *settings)

    def unit_responses(self, regime: Any) -> list[Observed]:
        """What is seen of vehicles that do not move, and of each moving by itself at a
        speed of 1.
        """
        zero, one = np.zeros(()), np.ones(())
        return [self.observe(regime, *pair) for pair in ((zero, zero), (one, zero), (zero, one))]

    @cached_property
    def _linear(self) -> tuple[Observed, tuple[Any, Any], tuple[Any, Any]]:
        """What is seen of vehicles that do not move, and the closing speed and the slip per unit of
        each speed.
        """
        rest, by_a, by_b = self.unit_responses(STICK)
        return (
            rest,
            (by_a.closing - rest.closing, by_b.closing - rest.closing),
            (by_a.slip - rest.slip, by_b.slip - rest.slip),
        )

    def speeds_at(self, closing: Any, slip: Any) -> tuple[Any, Any]:
        """The speeds along the courses that give this closing speed and slip; NaN for parallel
        courses.
        """
        rest, (ga, gb), (sa, sb) = self._linear
        crossed = ga * sb - gb * sa
        crossed = np.where(
            abs(crossed) <= 64.0 * EPS * (np.hypot(ga, sa) * np.hypot(gb, sb)), np.nan, crossed
        )
        g, s = closing - rest.closing, slip - rest.slip
        return (g * sb - s * gb) / crossed, (s * ga - g * sa) / crossed

    def candidates(self) -> list[tuple[Any, Any, Any]]:
        """Regime and both speeds of every candidate, as the algebra gives them."""
        self.undetermined = np.zeros((), dtype=bool)
        find = self._on_a_line if self.kinds[0].startswith("speed") else self._crossing
        return [(regime, *pair) for regime in self.regimes() for pair in find(regime)]

    def roots(self, function: RestitutionOf | None = None) -> list[Root]:
        """The candidates, polished; ``function`` gives the restitution by the closing speed, where
        it is no number.
        """
        return [
            self._polished_where_likely(*candidate, function) for candidate in self.candidates()
        ]

    def _with_known_speed(self, other: Any) -> tuple[Any, Any]:
        """Both speeds, where one is known."""
        known = self.targets[self.kinds[0]] + 0.0 * other
        return (known, other) if self.kinds[0] == "speed_a" else (other, known)

    def _on_a_line(self, regime: Any) -> list[tuple[Any, Any]]:
        """With one speed known: the other speeds at which the observation is met."""
        fixed, kind = self.kinds
        target = self.targets[kind]

        def seen(x: Any) -> Observed:
            return self.observe(regime, *self._with_known_speed(x))

        def excess(x: Any) -> Any:
            here = seen(x)
            return (getattr(here, kind) - target) * here.weight

        # The step: the speeds at 0, plus the unknown speed that reaches the target if its effect
        # grows from that of one unit.
        rest, one = seen(np.zeros(())), seen(np.ones(()))
        needed = np.sqrt(abs(target / (getattr(one, kind) - getattr(rest, kind))))
        step = (
            abs(self.targets[fixed])
            + abs(rest.closing)
            + abs(rest.slip)
            + np.where(np.isfinite(needed), needed, 0.0)
        )
        xs = _roots(regime, excess, np.where(step > 0.0, step, 1.0))
        flat = [
            abs(getattr(part, kind) - target) <= _observation_rounding(kind, part)
            for part in (rest, one)
        ]
        open_ = flat[0] & flat[1]
        if np.any(open_):
            self.undetermined = self.undetermined | (open_ & self._any_speed_fits(regime))
        return [self._with_known_speed(x) for x in xs]

    def _crossing(self, regime: Any) -> list[tuple[Any, Any]]:
        """With two quadratic observations: their ratio depends on slip over closing speed alone."""
        (k1, c1), (k2, c2) = self.targets.items()

        def apart(seen: Observed) -> Any:
            one, other = self.both(seen)
            return c2 * one - c1 * other

        # Where both observations depend on slip alike, every slip fits, or none.
        samples = self._samples(regime)
        rounding = [
            c2 * _observation_rounding(k1, seen) + c1 * _observation_rounding(k2, seen)
            for seen in samples
        ]
        alike = np.logical_and.reduce(
            [abs(apart(seen)) <= least for seen, least in zip(samples, rounding, strict=True)]
        )
        any_slip = (
            (self._redundant(c1, c2, samples) | alike)
            & self._can_occur(regime)
            & ((c1 > 0.0) | (c2 > 0.0))
        )
        self.undetermined = self.undetermined | any_slip

        def difference(ratio: Any) -> Any:
            seen = self._per_closing(regime, ratio)
            return np.where(any_slip, np.nan, apart(seen) * seen.weight)

        pairs = []
        for ratio in _roots(regime, difference, np.ones(())):
            one, other = self.both(self._per_closing(regime, ratio))
            closing = np.sqrt(np.where(c1 > 0.0, c1 / one, c2 / other))
            pairs.append(self.speeds_at(closing, ratio * closing))
        return pairs

    def _per_closing(self, regime: Any, slip: Any) -> Observed:
        """The observations at unit closing speed and this slip."""
        return self.observe(regime, *self.speeds_at(np.ones(()), slip))

    def _samples(self, regime: Any) -> list[Observed]:
        return [self._per_closing(regime, np.full((), slip)) for slip in (-1.0, 0.0, 1.0)]

    def _redundant(self, p1: Any, p2: Any, samples: Sequence[Observed]) -> Any:
        """Whether both observations have the ratio p1 to p2 at every slip."""
        pairs = [(p2 * one, p1 * other) for one, other in map(self.both, samples)]
        scale = sum(abs(one) + abs(other) for one, other in pairs)
        return np.logical_and.reduce(
            [abs(one - other) <= REDUNDANT * scale for one, other in pairs]
        )

    def any_slip_at(self, regime: Any) -> tuple[Any, Any]:
        """For two observations that depend on slip alike: their relative difference, and the
        closing speed.
        """
        c1, c2 = self.targets.values()
        samples = self._samples(regime)
        q1, q2 = self.both(samples[1])
        of_first, of_second = c2 * q1, c1 * q2
        apart = (of_first - of_second) / (abs(of_first) + abs(of_second))
        return np.where(self._redundant(q1, q2, samples), apart, np.nan), np.sqrt(c1 / q1)

    def _polished_where_likely(
        self, regime: Any, speed_a: Any, speed_b: Any, function: RestitutionOf | None
    ) -> Root:
        """The root polished in those cases in which the law ends in this regime, or nearly; in
        others NaN.
        """
        here, seen = (self.observe(which, speed_a, speed_b) for which in (regime, LAW))
        apart = abs(here.normal - seen.normal) + abs(here.tangential - seen.tangential)
        near = _UNPOLISHED * here.whole
        ends_so = (here.closing > 0.0) & (
            apart <= _IMPULSE_UNPOLISHED * abs(here.normal) + here.effective_mass * near
        )
        likely = ends_so | (abs(here.closing) <= near)
        if "energy_loss" in self.kinds:
            # An energy that is rounding beside those before and after says little of where the root
            # is.
            likely = likely | (
                _UNPOLISHED * here.energy_loss <= _observation_rounding("energy_loss", here)
            )
        if self.plain:
            return self._polished(regime, float(speed_a), float(speed_b)) if likely else NO_ROOT
        cases = np.flatnonzero(self.flat(likely))
        whole = np.full((len(Root._fields), math.prod(self.shape)), np.nan)
        if cases.size:
            regime = regime if isinstance(regime, str) else self.flat(regime)[cases]
            speed_a, speed_b = (self.flat(speed)[cases] for speed in (speed_a, speed_b))
            whole[:, cases] = np.broadcast_arrays(
                *self.of(cases)._polished(regime, speed_a, speed_b, function)
            )
        return Root._make(whole.reshape(len(whole), *self.shape))

    def _polished(
        self, regime: Any, speed_a: Any, speed_b: Any, function: RestitutionOf | None = None
    ) -> Root:
        """Newton's method on the kernel, with central differences for its derivatives."""
        here = self.observe(regime, speed_a, speed_b)
        for _ in range(_NEWTON_STEPS):
            h = _STEP * (abs(speed_a) + abs(speed_b) + abs(here.closing))
            by_a = self._slopes(
                h, *(self.observe(regime, speed_a + step, speed_b) for step in (h, -h))
            )
            by_b = self._slopes(
                h, *(self.observe(regime, speed_a, speed_b + step) for step in (h, -h))
            )
            (j11, j21), (j12, j22) = by_a, by_b
            r1, r2 = (
                value - target
                for value, target in zip(self.both(here), self.targets.values(), strict=True)
            )
            determinant = j11 * j22 - j12 * j21
            step_a, step_b = (
                (r1 * j22 - r2 * j12) / determinant,
                (r2 * j11 - r1 * j21) / determinant,
            )
            ahead = self.observe(regime, speed_a - step_a, speed_b - step_b)
            # Where two roots meet the derivative is rounding, and a step over it may lead anywhere.
            away = self._misfit_of(ahead, here) > self._misfit_of(here, here)
            usable = (step_a - step_a == 0.0) & (step_b - step_b == 0.0) & (away ^ True)
            speed_a = speed_a - select(usable, step_a, 0.0)
            speed_b = speed_b - select(usable, step_b, 0.0)
            if usable is False:
                break
            here = (
                ahead
                if usable is True
                else Observed._make(select(usable, *pair) for pair in zip(ahead, here, strict=True))
            )
        closing = self._closing_if_reproduced(
            speed_a, speed_b, [abs(one) + abs(other) for one, other in zip(by_a, by_b, strict=True)]
        )
        many = np.any(closing > 0.0) and self._one_of_many(speed_a, speed_b)
        if function is not None:
            # The restitution changes with the closing speed, and the observations with it.
            e_by_closing = self.speed_unit * function.slope(self.speed_unit * here.closing)
            seen = (
                self.both(self.observe(regime, speed_a, speed_b, step)) for step in (_STEP, -_STEP)
            )
            by_closing = [
                e_by_closing * (up - down) / (2.0 * _STEP) for up, down in zip(*seen, strict=True)
            ]
            by_a, by_b = (
                [
                    alone + through_e * closing_by_speed
                    for alone, through_e in zip(by_speed, by_closing, strict=True)
                ]
                for by_speed, closing_by_speed in zip((by_a, by_b), self._linear[1], strict=True)
            )
        return Root(
            speed_a, speed_b, self.e, self._condition(by_a, by_b, here.closing), closing, many
        )

    def _slopes(self, step: Any, ahead: Observed, behind: Observed) -> list[Any]:
        """Central difference of each observation."""
        return [
            (up - down) / (2.0 * step)
            for up, down in zip(self.both(ahead), self.both(behind), strict=True)
        ]

    def _misfit_of(self, seen: Observed, here: Observed) -> Any:
        """Largest relative residual of both observations; an energy loss is measured against
        closing speed times impulse.
        """
        whole = abs(here.closing * here.normal)
        offs: list[Any] = []
        for kind, target in self.targets.items():
            size = (
                abs(getattr(here, kind)) + abs(target) + (whole if kind == "energy_loss" else 0.0)
            )
            offs.append(abs(getattr(seen, kind) - target) / size)
        return larger(*offs)

    def _condition(self, by_a: Sequence[Any], by_b: Sequence[Any], closing: Any) -> Any:
        """Condition: the factor by which relative input errors grow in the speeds that are sought,
        taken relative to the closing speed.
        """
        (j11, j21), (j12, j22) = by_a, by_b
        d1, d2 = (
            (2.0 if kind in self.squares else 1.0) * abs(target)
            for kind, target in self.targets.items()
        )
        by_speed = {
            "speed_a": abs(d1 * j22) + abs(d2 * j12),
            "speed_b": abs(d2 * j11) + abs(d1 * j21),
        }
        sought = [one for name, one in by_speed.items() if name not in self.targets]
        moved = np.maximum.reduce(np.broadcast_arrays(*sought))
        return moved / abs((j11 * j22 - j12 * j21) * closing)

    def _closing_if_reproduced(self, speed_a: Any, speed_b: Any, slopes: Sequence[Any]) -> Any:
        """The closing speed where the kernel reproduces the observed values from these speeds under
        the given law, elsewhere NaN.

        The speeds of a root are themselves rounded, which moves an observation by its slope; the
        kernel adds the rounding of the parts that it sums up. What is off by more belongs to
        another regime than that in which the law ends. Near grazing rounding grows beyond the
        observation itself and tells nothing: there a part of the observation is the bound.
        """
        seen = self.observe(LAW, speed_a, speed_b)
        fits = pushed(seen)
        for (kind, target), slope in zip(self.targets.items(), slopes, strict=True):
            scale = parts = seen.whole if kind.startswith("speed") else getattr(seen, kind)
            if kind == "energy_loss":
                scale = seen.closing * seen.normal
                # Where friction makes the loss touch its minimum, speeds are accurate only to the
                # square root of rounding.
                parts = seen.lost + np.where(self.bound == 0.0, 0.0, scale)
            rounding = _KERNEL_ROUNDING * (slope * seen.whole + parts)
            fits = fits & (
                abs(getattr(seen, kind) - target) <= np.minimum(rounding, ROOT_TOL * scale)
            )
        return np.where(fits, seen.closing, np.nan)

    def _can_occur(self, regime: Any) -> Any:
        """Whether the law allows a regime: no sticking without friction, nor with less than the
        critical ratio.
        """
        if regime is STICK:
            return self.bound == 1.0 if self.rule == CRITICAL_FRACTION else self.bound > 0.0
        return True

    def _any_speed_fits(self, regime: Any) -> Any:
        """With one speed known: whether every other speed in this regime gives the same
        observation, and the one observed.
        """
        rest = self._linear[0]
        size = abs(self.targets[self.kinds[0]]) + abs(rest.closing) + abs(rest.slip)
        size = np.where(size > 0.0, size, 1.0)
        low: Any = np.full((), -np.inf)
        high: Any = np.full((), np.inf)
        seen = (self.observe(STICK, *self._with_known_speed(x)) for x in (-size, size))
        for behind, ahead in zip(*(self._conditions(regime, one) for one in seen), strict=True):
            # Each is linear in the speed, so it changes sign at one place.
            middle = size * (behind + ahead) / (behind - ahead)
            low = np.where(ahead > behind, np.maximum(low, middle), low)
            high = np.where(ahead < behind, np.minimum(high, middle), high)
            high = np.where((ahead == behind) & np.logical_not(ahead > 0.0), -np.inf, high)
        nearest = np.maximum(low, np.minimum(high, 0.0))
        low, high = np.maximum(low, nearest - size), np.minimum(high, nearest + size)
        wide = high - low > ROOT_TOL * size
        places = [self._with_known_speed(low + part * (high - low)) for part in _PARTS]
        return self._can_occur(regime) & wide & self._all_fit(places)

    def _conditions(self, regime: Any, stuck: Observed) -> list[Any]:
        """The expressions that must be positive for the law to lead to a regime."""
        if self.rule == IMPULSE_RATIO:
            return [stuck.closing]
        if self.rule == CRITICAL_FRACTION:
            return [stuck.closing, np.where(self.bound > 0.0, stuck.normal, 1.0)]
        endless = np.isinf(self.bound)
        most = np.where(endless, 1.0, self.bound) * stuck.normal
        across = np.where(endless, 0.0, stuck.tangential)
        if regime is STICK:
            return [stuck.closing, most - across, most + across]
        return [
            stuck.closing,
            np.where(self.bound > 0.0, np.copysign(1.0, regime) * across - most, 1.0),
        ]

    def _one_of_many(self, speed_a: Any, speed_b: Any) -> Any:
        """Whether the speeds on one side of a root also give the observed values: a continuous
        range of solutions.
        """

        def moved(step: Any) -> tuple[Any, Any]:
            if self.kinds[0] == "speed_b":
                return speed_a + step, speed_b
            beside = speed_a, speed_b + step
            return beside if self.kinds[0] == "speed_a" else self._scaled(*beside)

        far = _BESIDE * (abs(speed_a) + abs(speed_b) + self.fixed[0])
        slower, faster = (
            [(speed_a, speed_b), moved(0.5 * step), moved(step)] for step in (-far, far)
        )
        return self._all_fit(slower) | self._all_fit(faster)

    def _scaled(self, speed_a: Any, speed_b: Any) -> tuple[Any, Any]:
        """The speeds, scaled at the same slip per closing speed, that give the observation that is
        not a loss.
        """
        kind = self.kinds[1] if self.kinds[0] == "energy_loss" else self.kinds[0]
        seen = self.observe(LAW, speed_a, speed_b)
        factor = np.sqrt(self.targets[kind] / getattr(seen, kind))
        return self.speeds_at(factor * seen.closing, factor * seen.slip)

    def _all_fit(self, pairs: Sequence[tuple[Any, Any]]) -> Any:
        """Whether the law leads from all these speeds to the observed values, and to the same value
        from each.

        An energy that was given is known to the rounding of the energies that it is the difference
        of. What the kernel answers is known to that of the energies lost alone: close to a
        restitution of 1 it tells amounts apart that are far smaller.
        """
        fit: Any = True
        first: Observed | None = None
        for pair in pairs:
            seen = self.observe(LAW, *pair)
            first = first or seen
            fit = fit & (seen.status <= Status.ENERGY_GAIN)
            for kind, target in self.targets.items():
                if kind.startswith("speed"):
                    continue
                value, of_first, rounding = (
                    getattr(seen, kind),
                    getattr(first, kind),
                    _observation_rounding(kind, seen),
                )
                within = _KERNEL_ROUNDING * (seen.lost + first.lost)
                if kind != "energy_loss":
                    within = rounding + _observation_rounding(kind, first)
                fit = fit & (abs(value - target) <= rounding) & (abs(value - of_first) <= within)
            if not np.any(fit):
                break
        return fit


def shares_critical(rule: str, value: Any) -> bool:
    """Whether the impulse ratio depends on the answer."""
    return rule == CRITICAL_FRACTION and bool(np.any(np.greater(value, 0.0) & np.less(value, 1.0)))


def pushed(seen: Observed) -> Any:
    """Whether these speeds are answered, with a closing speed beyond rounding.

    A course at a right angle to the normal, in radians, leaves a cosine of 1e-16: a closing speed
    that is what rounding makes of such large speeds counts as 0.
    """
    return (seen.status <= Status.ENERGY_GAIN) & (seen.closing > _KERNEL_ROUNDING * seen.whole)


def _power_of_two(size: Any) -> Any:
    """The power of two next to a number; 1 for 0, NaN and infinity."""
    usable = np.isfinite(size) & (size > 0.0)
    return np.ldexp(1.0, np.frexp(np.where(usable, size, 1.0))[1] - 1)


def _observation_rounding(kind: str, seen: Observed) -> Any:
    """Worst rounding error of an observation that was itself computed from speeds.

    An energy that is the difference of those before and after is known to the rounding of the
    impulse times the speeds.
    """
    if kind == "energy_loss":
        return _KERNEL_ROUNDING * seen.squared_impulse**0.5 * seen.whole
    return 2.0 * _KERNEL_ROUNDING * getattr(seen, kind) * (seen.whole / abs(seen.closing))


def _roots(regime: Any, at: Callable[[Any], Any], step: Any) -> Sequence[Any]:
    """Roots of a regime's equation in the observations, on a scale that the step gives."""
    if regime is _SHARE:
        return quartic_roots([at(step * place) for place in PLACES], step)
    return parabola_roots([at(-step), at(0.0 * step), at(step)], step)

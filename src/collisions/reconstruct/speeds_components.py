"""The algebra of ``speeds`` from components of delta-V (``ComponentScene``): least squares, linear
in each regime.

Components are components of the impulse, which in each regime is linear in both speeds: each regime
is one linear problem, of as many equations as components were given. Its answer counts if the law
leads from these speeds to that regime; where none does, the best lies on the edge between two.
Components are known relative to the impulse, so all weigh alike as momenta; a speed that is given
is taken as exact.

With no speed known, both speeds follow only if the contact stuck. If it slid, the impulse has the
same direction at every slip above the one at which it would just have stuck: the answers are a
family that begins there (``_end``), in which each speed rises, falls or stays (``sides``). Members
in which a car goes backwards along its course are none: where its speed rises from below 0, the
family begins where that car stands.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from copy import copy
from functools import reduce
from typing import Any, NamedTuple

import numpy as np

from ..impact.doubts import MAY_SLIDE, NEARLY_COLLINEAR
from ..kernels.contact_laws import FRICTION
from ..messages.errors import IllConditionedWarning
from ..messages.shares import percent_beyond
from ..messages.warning import warn_of_cases
from ..quantities.directions import Angle
from ..reference import RECORDER_ACCURACY
from .common import Cases
from .restitution_roots import RestitutionOf
from .speeds_algebra import (
    EITHER,
    HELD,
    LAW,
    REDUNDANT,
    ROOT_TOL,
    STICK,
    Observed,
    Root,
    Scene,
    pushed,
)

COMPONENTS = tuple(f"delta_v_{part}_{label}" for label in "ab" for part in ("forward", "left"))
"""The components of delta-V that may be known."""
ACCURACY = RECORDER_ACCURACY.high
# Beyond three times the stated accuracy the known values contradict each other.
CONTRADICTION = 3.0 * ACCURACY
# Of the samples of a study: each adds the errors that were stated to those that the readings have,
# so that many differ although all is as it was stated. Where hardly any agrees, it is not.
_DISAGREE = 0.95
# A ratio up to this share of the friction is clearly below it: the contact stuck.
CLEARLY_BELOW = 0.5
# Speeds of a contact that stuck and of one that slid that differ by no more, of the closing speed,
# are one answer.
_ONE_ANSWER = 1e-3
# Of the impulse: what misses its known values by no more, as by their last digits, meets them.
_EXACT = 1e-4
# How much more than was known an energy may have been: it goes as the square of an impulse.
MOST_ENERGY = 1.0 + 2.0 * ACCURACY
# Beside a known speed, readings within their accuracy lead from the one to the other nearly always.
# What lies beyond those with which a contact sticks by more, of the closing speed, is another one.
_BEYOND = 0.1
# Ratios beside the one that both components of a vehicle show which are tried, by their angles:
# beyond these none fits.
_BESIDE = np.linspace(-1.0, 1.0, 13) * math.asin(ACCURACY)
# Relative size below which the effect of a speed is rounding.
_NO_EFFECT = 1e-12
# The same of a change of slip on one speed beside the other.
_STAYS = 1e-9
# Of the closing speed and the slip.
_INSIDE = 1e-12
_REFINEMENTS = 3
# Of a known value, to either side of it: central differences.
_SHARE = 1e-5
# What to write where the components show another ratio than the friction.
RATIO_SHOWN = "Write `friction=inf, slid='bound'`, which takes the ratio that the components show"
# What ``roots`` finds of every case.
_FOUND = ("misfit", "ended", "ratio", "may_slide", "leaves_slip", "both_ways")


def with_most_energy(known: Mapping[str, Any]) -> dict[str, Any]:
    """What was known, with the greatest energy that it may stand for; EES go as its root."""
    factors = {
        name: MOST_ENERGY if name == "energy_loss" else math.sqrt(MOST_ENERGY)
        for name in ("energy_loss", "ees_a", "ees_b")
    }
    return {
        name: factors[name] * value if name in factors else value for name, value in known.items()
    }


def fit_either(
    misfit: Any,
    least: Any,
    stuck: Sequence[Any],
    slid: Sequence[Sequence[Any]],
    closing: Any,
    forward_only: bool,
) -> Any:
    """Whether a contact that stuck, which misses what is known by this share of the impulse, fits
    within the accuracy of recorders, and speeds of one that slid, in pairs, NaN where they do not
    fit, are far from its own; but not where the ``least`` that any misses is nothing. With
    ``forward_only`` speeds backwards are none.
    """
    far = _far_from(stuck, slid, closing, forward_only)
    either: Any = (misfit <= ACCURACY) & (least > _EXACT) & far
    return either


def _far_from(
    stuck: Sequence[Any], slid: Sequence[Sequence[Any]], closing: Any, forward_only: bool
) -> Any:
    """Whether any pair of speeds of a contact that slid is far from those of one that stuck."""
    far: Any = False
    for pair in slid:
        slowest = np.minimum.reduce(np.broadcast_arrays(*pair, *stuck))
        allowed = slowest >= 0.0 if forward_only else True
        for one, own in zip(pair, stuck, strict=True):
            far = far | (allowed & (abs(one - own) > _BEYOND * closing))
    return far


class ComponentScene(Scene):
    """Two vehicles whose speeds are unknown, components of delta-V in their own axes, and perhaps a
    speed.
    """

    def __init__(
        self,
        given: dict[str, Any],
        rule: str,
        law: str,
        names: tuple[str, ...],
        shape: tuple[int, ...],
        plain: bool = False,
        regime: str | None = None,
        slid: str | None = None,
        most: float = CONTRADICTION,
        direction: float | None = None,
        forward_only: bool = False,
    ) -> None:
        super().__init__(given, rule, law, names, shape)
        self.forward_only = forward_only
        # That of the slip which is tried, by the sign of its impulse ratio; None for both.
        self._direction = direction
        # What known values may differ by.
        self.most = most
        self.stated, self.slid = regime, slid
        self.components = [name for name in names if name.startswith("delta_v")]
        self.unknown = [at for at, label in enumerate("ab") if f"speed_{label}" not in names]
        # 0 in place of unknown ones.
        self.known = [self.targets.get(f"speed_{label}", np.zeros(())) for label in "ab"]
        self.misfit: Any = np.full((), np.nan)
        # Where the answer is the end of the family of contacts that slid.
        self.ended: Any = np.zeros((), dtype=bool)
        # Ratio of the impulse of the answer, and where it is said to stick but may have slid.
        self.ratio: Any = np.full((), np.nan)
        self.may_slide: Any = np.zeros((), dtype=bool)
        # Where a contact that slid leaves the slip open, as with no speed known, or fits too.
        self.energy = self.targets.get("energy_loss")
        self.leaves_slip: Any = len(self.unknown) > 1 and self.energy is None
        # With a known speed: to which side of the answer each speed lies if the contact slid.
        self.toward: tuple[Any, Any] = (math.nan, math.nan)
        self.answer: tuple[Any, Any] = (math.nan, math.nan)
        # The least and the greatest other speed if it slid, and the ratio of each; and where these
        # lie to both sides of those of one that stuck, so that a bound has none.
        self.reach: tuple[Any, ...] = (math.nan,) * 4
        self.no_side: Any = np.zeros((), dtype=bool)
        # Where one that slid fits better, with another speed.
        self.slides_better: Any = np.zeros((), dtype=bool)
        # Where a bound was asked for and sliding fits either way, so that it has no side.
        self.both_ways: Any = np.zeros((), dtype=bool)
        # Where a contact that sticks fits.
        self.sticks: Any = np.zeros((), dtype=bool)
        # Beside an energy: where one that stuck and one that slid fit with different speeds.
        self.either: Any = np.zeros((), dtype=bool)
        # Where the friction is the ratio that the components show.
        self.shows_friction: Any = np.zeros((), dtype=bool)
        # The friction of a contact that may have stuck, where going forwards it must have slid.
        self.slid_at: Any = np.full((), np.nan)
        # Which way the truth may lie from each speed, where it may be another member of the family.
        self.sides: tuple[Any, Any] | None = None
        # The misfit of a contact that leaves the slip open.
        self.left_open: Any = np.full((), np.inf)
        # The scenes that this one stands for, each with its own impulse from the same readings.
        self.ways: list[ComponentScene] = []
        nx, ny = self.given["normal[0]"], self.given["normal[1]"]
        self._axes, self._momenta = [], []
        for kind in self.components:
            label = kind[-1]
            fx, fy = Angle(self.given[f"{label}.heading"], False).direction
            ax, ay = (fx, fy) if "forward" in kind else (-fy, fx)
            sign = 1.0 if label == "b" else -1.0
            self._axes.append((sign * (nx * ax + ny * ay), sign * (nx * ay - ny * ax)))
            x, y, _ = self._held_of(label)
            momentum = self.numbers[f"{label}.mass"] * self.numbers[kind]
            # The contact's part of it.
            self._momenta.append(momentum - (ax * x + ay * y))

    def _held_of(self, label: str) -> tuple[Any, Any, Any]:
        """Impulse of the tyres of a vehicle along x and y, and its moment."""
        if not self.held:
            return 0.0, 0.0, 0.0
        x, y, moment = (self.numbers[name] for name in HELD if name[5] == label)
        return x, y, moment

    def findings(self) -> dict[str, Any]:
        """As in any scene, and what the components tell of how the contact ended."""
        return {
            **super().findings(),
            **{name: getattr(self, name) for name in _FOUND},
            **{f"sides[{i}]": side for i, side in enumerate(self.sides or ())},
        }

    def take(self, found: Mapping[str, Any]) -> None:
        super().take(found)
        for name in _FOUND:
            setattr(self, name, found[name])
        self.sides = (found["sides[0]"], found["sides[1]"]) if "sides[0]" in found else None

    def roots(self, function: RestitutionOf | None = None) -> list[Root]:
        """The answer with the least misfit that the law leads to, or all that fit exactly; no
        others have a closing speed.
        """
        regimes = self._stated_regimes()
        tried, edges = [*map(self._solved, regimes)], self._edges()
        open_slip = np.fmin.reduce(np.broadcast_arrays(*(left for *_, left in tried + edges)))
        sticks, backwards = self._sticks(regimes, tried), np.zeros((), dtype=bool)
        if self.energy is not None:
            sliding = [self._end(regime) for regime in regimes if not isinstance(regime, str)]
            tried = [self._losing(*one) for one in tried]
            if self.rule == FRICTION and self.stated is None and not self.held:
                # With tyres those are compared in which they have settled.
                self.either = self._either(regimes, tried, sliding)
            tried += sliding
            # What is lost by sliding tells the slip, but for a contact without friction.
            open_slip = np.where(abs(self.bound) > 0.0, np.inf, open_slip)
        elif self.slid:
            tried, edges, sticks, backwards = self._bounded(
                regimes, tried, edges, sticks, open_slip <= ACCURACY
            )
        self.sticks = sticks
        found, misfits, _ = zip(*tried, *edges, strict=True)
        self.misfit = np.minimum.reduce(np.broadcast_arrays(*misfits))
        none = np.isinf(self.misfit)
        self.left_open = open_slip
        self.undetermined = none & (open_slip <= self.most)
        if self.slid and self.energy is None:
            self.undetermined = self.undetermined | (none & backwards)
        else:
            self.undetermined = self.undetermined | (open_slip <= REDUNDANT)
        best = [misfit <= np.maximum(ROOT_TOL, self.misfit) for misfit in misfits]
        if self.rule == FRICTION:
            self._weigh(sticks, open_slip <= ACCURACY, found, best)
        self.both_ways = self.both_ways & self.leaves_slip
        self.ambiguous = self.ambiguous | self.both_ways | self.either
        return [
            root._replace(closing=np.where(here, root.closing, np.nan))
            for root, here in zip(found, best, strict=True)
        ]

    def _stated_regimes(self) -> list[Any]:
        """The regimes to be tried: of what the caller stated, or all."""
        regimes = self.regimes()
        if self.rule != FRICTION:
            return regimes
        if self._direction is not None:
            del regimes[1 if self._direction > 0.0 else 0]
            if np.all(np.isfinite(self.bound)):
                regimes.remove(STICK)
        if self.stated is not None:
            return [one for one in regimes if (one is STICK) == (self.stated == "sticking")]
        # Without a ratio to slide at, nothing slides.
        return [one for one in regimes if one is STICK or not np.all(np.isnan(one))]

    def _sticks(self, regimes: Sequence[Any], tried: Sequence[tuple[Root, Any, Any]]) -> Any:
        """Where a contact that sticks fits."""
        of = [misfit for one, (_, misfit, _) in zip(regimes, tried, strict=False) if one is STICK]
        return np.isfinite(of[0]) if of else np.zeros((), dtype=bool)

    def _bounded(
        self,
        regimes: Sequence[Any],
        tried: list[tuple[Root, Any, Any]],
        edges: list[tuple[Root, Any, Any]],
        sticks: Any,
        near: Any,
    ) -> tuple[list[tuple[Root, Any, Any]], list[tuple[Root, Any, Any]], Any, Any]:
        """What was tried and the ends of families of contacts that slid, the edges beside them,
        where sticking fits, and where it does but for a car that goes backwards.
        """
        ends = [self._end(regime) for regime in regimes if not isinstance(regime, str)]
        ends = [(root, np.where(sticks, np.inf, misfit), left) for root, misfit, left in ends]
        if len(ends) > 1:
            self.both_ways = np.logical_and(*(misfit <= ACCURACY for _, misfit, _ in ends))
            if np.any(self.shows_friction):
                one = np.isfinite(np.minimum(*(misfit for _, misfit, _ in ends)))
                shown = one & self.slides_both_ways()
                self.both_ways = np.where(self.shows_friction, shown, self.both_ways)
        if self._direction is None and np.any(sticks & near):
            # At the friction, and so not at the ratio of a contact that stuck.
            self.both_ways = self.both_ways | (sticks & near & self.slides_both_ways())
        ratio = self._slid_forwards(regimes, tried, sticks & ~self.both_ways, near)
        backwards = np.isfinite(ratio)
        if np.any(backwards):
            end = self._end(ratio)
            there = np.isfinite(end[1])
            self.slid_at = np.where(there, abs(ratio), np.nan)
            self.bound = np.where(there, abs(ratio), self.bound)
            if self._direction is None:
                self.both_ways = np.where(there, self.slides_both_ways(), self.both_ways)
            sticks = sticks & np.logical_not(backwards)
            tried = [
                (root, np.where(backwards, np.inf, misfit), left) for root, misfit, left in tried
            ]
            ends.append(end)
        if ends:
            self.ended = np.isfinite(reduce(np.minimum, (misfit for _, misfit, _ in ends)))
        edges = [(root, np.where(self.ended, np.inf, misfit), left) for root, misfit, left in edges]
        return tried + ends, edges, sticks, backwards

    def _slid_forwards(
        self,
        regimes: Sequence[Any],
        tried: Sequence[tuple[Root, Any, Any]],
        sticks: Any,
        near: Any,
    ) -> Any:
        """The ratio of a contact that may have stuck, where a car goes backwards unless it slid;
        elsewhere NaN.
        """
        if not np.any(sticks):
            return np.full((), np.nan)
        (stuck,) = (one for regime, one in zip(regimes, tried, strict=True) if regime is STICK)
        speeds = stuck[0][:2]
        seen = self.observe(STICK, *speeds)
        ratio = seen.tangential / seen.normal
        open_ = sticks & np.logical_not(self._decided(abs(ratio), near))
        if len(self.unknown) == 1:
            # There is a family only where the other speed leaves the slip open.
            open_ = open_ & self._slip_stays_open()
        rising = [
            (side > 0.0) & (speed < 0.0)
            for side, speed in zip(self._ways(ratio), speeds, strict=True)
        ]
        if self._direction is not None:
            ratio = np.copysign(ratio, self._direction)
        return np.where(open_ & (rising[0] | rising[1]), ratio, np.nan)

    def _decided(self, size: Any, near: Any) -> Any:
        """Whether a contact that sticks at a ratio of this size did not slide, or slid with the
        same speeds.

        A ratio that is within the accuracy of recorders ``near`` to the friction is not below it.
        Without a friction a small ratio means that it stuck, as vehicles hardly slide at it, but
        not beside a known speed with which one that slid fits better.
        """
        bound = np.where(np.isinf(self.bound), MAY_SLIDE, self.bound)
        below = (size <= CLEARLY_BELOW * bound) & np.logical_not(near)
        if len(self.unknown) == 1:
            below = below & ~(np.isinf(self.bound) & self.slides_better)
            self.leaves_slip = self.leaves_slip | self._slip_stays_open()
        decided = below | np.logical_not(self.leaves_slip)
        if self.slid:
            # Asked for a bound, what friction can decide is not enough where contacts slide.
            decided = decided & ((size < MAY_SLIDE) | np.logical_not(self.leaves_slip))
        return decided

    def _weigh(self, sticks: Any, near: Any, found: Sequence[Root], best: Sequence[Any]) -> None:
        """Find where the contact may as well have slid, and to which side each speed then lies."""
        here = [at & (root.closing > 0.0) for at, root in zip(best, found, strict=True)]
        one, other = (
            sum(np.where(at, part, 0.0) for at, part in zip(here, parts, strict=True))
            / sum(np.where(at, 1.0, 0.0) for at in here)
            for parts in zip(*(root[:2] for root in found), strict=True)
        )
        self.answer = one, other
        stuck = self.observe(STICK, one, other)
        # One that slides has no more than the friction.
        self.ratio = np.clip(stuck.tangential / stuck.normal, -self.bound, self.bound)
        size = abs(self.ratio)
        decided = self._decided(size, near)
        if not self.slid and self.stated is None:
            self.ambiguous = sticks & ~self.undetermined & ~decided
            if self.forward_only and self.most < math.inf:
                # Of those that go forwards, only contacts that slid.
                least = -ROOT_TOL * stuck.closing
                back = self.ambiguous & (np.minimum(one, other) < least)
                ahead = np.minimum(*self.forwards(self.ratio, self.answer)) >= least
                self.undetermined = self.undetermined | (back & ahead)
                self.ambiguous = self.ambiguous & ~back
        told = (self.stated is not None) | (decided & self.leaves_slip)
        self.may_slide = sticks & (size >= MAY_SLIDE) & told
        if self.slid:
            self.ambiguous = self.ambiguous | (sticks & self.no_side & ~decided)
            first, second = (
                np.where(np.isnan(side), way, side)
                for side, way in zip(self.toward, self._ways(self.ratio), strict=True)
            )
            known = (sticks & decided) | np.logical_not(self.leaves_slip)
            self.sides = np.where(known, 0.0, first), np.where(known, 0.0, second)
            if len(self.unknown) == 1:
                # A size has no side where a speed rises from backwards to faster forwards.
                (at,) = self.unknown
                speed, fastest = (one, other)[at], self.reach[1]
                turns = (speed < 0.0) & (self.sides[at] > 0.0) & ~(fastest <= -speed)
                self.ambiguous = self.ambiguous | (sticks & turns)

    def fitting(self, regime: Any) -> tuple[Any, Any]:
        """Beside a known speed, the least and the greatest other one at which a contact of this
        regime fits the components within the accuracy of recorders; NaN for none.

        A speed from which the law leads to another regime counts as well.
        """
        here, ahead = (self.observe(regime, *self._with_unknown(one)) for one in (0.0, 1.0))
        n, t = here.normal, here.tangential
        by_n, by_t = ahead.normal - n, ahead.tangential - t
        allowed = ACCURACY**2
        low, high = np.full((), -np.inf), np.full((), np.inf)
        for label in "ab":
            left = [
                (target - (one * n + other * t), -(one * by_n + other * by_t))
                for kind, (one, other), target in zip(
                    self.components, self._axes, self._momenta, strict=True
                )
                if kind[-1] == label
            ]
            if not left:
                continue
            # What is left is no more than its share of the impulse: a quadratic in the speed.
            square = sum(by * by for _, by in left) - allowed * (by_n**2 + by_t**2)
            half = sum(at * by for at, by in left) - allowed * (n * by_n + t * by_t)
            at_0 = sum(at * at for at, _ in left) - allowed * (n**2 + t**2)
            root = np.sqrt(half**2 - square * at_0)
            # Along an axis across the impulse however much may be left.
            low = np.maximum(low, np.where(square > 0.0, (-half - root) / square, -np.inf))
            high = np.minimum(high, np.where(square > 0.0, (root - half) / square, np.inf))
        none = ~(low <= high)
        return np.where(none, np.nan, low), np.where(none, np.nan, high)

    def sliding(self, shown: Any, least: Any) -> tuple[Any, Any, Any, Any]:
        """Beside a known speed, the least and the greatest other one at which a contact that slid
        fits the components within the accuracy of recorders, at a ratio near the one ``shown``,
        and the ratio of each; NaN for none. Speeds below ``least`` are none.
        """
        # Components of both vehicles may each show another, all between these.
        wide = 1.0 if len({name[-1] for name in self.components}) == 1 else 2.0
        angle = np.arctan(shown) + wide * _BESIDE.reshape(-1, *[1] * len(self.shape))
        ratio = np.where(abs(angle) < 0.5 * math.pi, np.tan(angle), np.nan)
        low, high = self.fitting(ratio)
        here, ahead = (
            np.sign(ratio) * self._beyond(ratio, self._with_unknown(one)) for one in (0.0, 1.0)
        )
        # It slides where sticking takes more than this ratio.
        edge, rises = here / (here - ahead), ahead > here
        low = np.maximum(np.where(rises, np.maximum(low, edge), low), least)
        high = np.where(rises, high, np.minimum(high, edge))
        at_ratio = copy(self)
        at_ratio.bound = abs(ratio)
        ends = []
        for end, other, most in ((low, high, np.argmin), (high, low, np.argmax)):
            # A hair inside, as rounding decides whether the end itself slides.
            speed = end + _STAYS * (other - end)
            pair = self._with_unknown(speed)
            as_slid, seen = at_ratio.observe(ratio, *pair), at_ratio.observe(LAW, *pair)
            apart = abs(seen.normal - as_slid.normal) + abs(seen.tangential - as_slid.tangential)
            fits = pushed(seen) & (apart <= ROOT_TOL * abs(as_slid.normal)) & (low < high)
            worst = math.inf if most is np.argmin else -math.inf
            chosen = most(np.where(fits, speed, worst), axis=0)[np.newaxis]
            ends += [
                np.take_along_axis(np.where(fits, part, np.nan), chosen, axis=0)[0]
                for part in np.broadcast_arrays(speed, ratio)
            ]
        return ends[0], ends[2], ends[1], ends[3]

    def _with_unknown(self, speed: Any) -> tuple[Any, Any]:
        """The known speed and this other one, those of A and B."""
        first, second = (
            speed if at in self.unknown else known + 0.0 * speed
            for at, known in enumerate(self.known)
        )
        return first, second

    def _slip_stays_open(self) -> Any:
        """With one speed known: whether the other does not show in the closing speed, so that a
        contact that slid leaves it open.
        """
        rest, *moving = self.unit_responses(STICK)
        effects = [abs(one.closing - rest.closing) for one in moving]
        return effects[self.unknown[0]] <= _NO_EFFECT * np.maximum(*effects)

    def of_way(self, way: Any) -> ComponentScene:
        """This scene as it is for a root, by the ``way`` of that."""
        if not self.ways:
            return self
        chosen = copy(self)
        for name in (*_FOUND, "bound"):
            setattr(chosen, name, by_way(way, [getattr(one, name) for one in self.ways]))
        if self.slid:
            sides = (one.sides or (np.zeros(()), np.zeros(())) for one in self.ways)
            first, second = (by_way(way, both) for both in zip(*sides, strict=True))
            chosen.sides = first, second
        return chosen

    @property
    def begins_a_family(self) -> bool:
        """Whether speeds of a contact that slid begin at those of one that stuck, and go on to one
        side of them: beside a known speed it slid at another ratio.
        """
        return len(self.unknown) > 1

    def slides_both_ways(self) -> Any:
        """Whether a contact that slid at a ratio of either sign fits, and so one without any."""
        smooth = np.zeros(())
        speeds = self._solved(smooth)[0][:2]
        return self._misfit(self.observe(smooth, *speeds)) <= ACCURACY

    def if_slid(self, speeds: Sequence[Any]) -> tuple[Sequence[Any], tuple[Any, Any]]:
        """The end of the family if the contact slid at the ratio of the answer, which has these
        speeds, and to which side of it each speed lies: 1 above, -1 below, 0 where it stays.
        """
        return self.forwards(self.ratio, speeds), self._ways(self.ratio)

    def forwards(self, ratio: Any, speeds: Sequence[Any]) -> tuple[Any, Any]:
        """Of the family of contacts that slid at this ratio and begins at these speeds, the first
        member in which no car goes backwards whose speed rises.
        """
        moved, way = self._along_the_family(ratio)
        short = [
            np.where((speed < 0.0) & (side > 0.0), -speed / abs(by_slip), 0.0)
            for speed, side, by_slip in zip(speeds, self._ways(ratio), moved, strict=True)
        ]
        slip = np.maximum(*short)
        first, second = (
            np.where(slip > 0.0, np.where(own == slip, 0.0, speed + way * by_slip * slip), speed)
            for own, speed, by_slip in zip(short, speeds, moved, strict=True)
        )
        return first, second

    def _along_the_family(self, ratio: Any) -> tuple[list[Any], Any]:
        """What both speeds change by with the slip, and the sign of the slip along the family."""
        here, ahead = map(self._one_slip, (0.0, 1.0))
        grows = self._beyond(ratio, ahead) - self._beyond(ratio, here)
        return [b - a for a, b in zip(here, ahead, strict=True)], np.sign(ratio * grows)

    def _ways(self, ratio: Any) -> tuple[Any, Any]:
        """Which way each speed goes along the family."""
        moved, way = self._along_the_family(ratio)
        least = _STAYS * np.maximum(*map(abs, moved))
        least = [least if at in self.unknown else np.inf for at in range(2)]
        first, second = (
            np.where(abs(one) > limit, way * np.sign(one), 0.0)
            for one, limit in zip(moved, least, strict=True)
        )
        return first, second

    def _beyond(self, ratio: Any, speeds: Sequence[Any]) -> Any:
        """The excess of the tangential impulse that sticking takes over this ratio, signed."""
        stuck = self.observe(STICK, *speeds)
        return stuck.tangential - ratio * stuck.normal

    def _end(self, ratio: Any) -> tuple[Root, Any, Any]:
        """The end of the family of contacts that slid at this ratio: where sticking just takes it,
        or from where on both cars go forwards; or, with an energy known, the member that loses it.

        The components give the closing speed, and the end is the slip at which both regimes give
        the same impulse. From there on the loss grows linearly with the slip.
        """
        somewhere, _, misfit = self._solved(ratio)
        closing = self.observe(ratio, *somewhere[:2]).closing
        short, ahead = (self._beyond(ratio, self.speeds_at(closing, one)) for one in (0.0, 1.0))
        slip = short / (short - ahead)
        # A hair inside the family, or rounding decides whether the impact solved forwards slides.
        slip = slip + np.sign(ratio * (ahead - short)) * _INSIDE * (abs(slip) + closing)
        if self.energy is None:
            speeds = self.forwards(ratio, self.speeds_at(closing, slip))
            _, effects, inverse, _ = self._linear_in(STICK)
            momenta = self._seen_momenta(self.observe(ratio, *speeds))
            moved = self._moved(inverse, effects, momenta)
        else:
            further = np.sign(ratio * (ahead - short)) * closing
            places = slip, slip + further
            slip = self._slip_that_loses(ratio, closing, places, self.energy)
            within = (slip - places[0]) / further
            speeds = self.speeds_at(closing, slip)
            moved = self._moved_beside_an_energy(ratio, places)
        # However far the friction is from the ratio, the case has a bound; recorders must agree.
        agree = self._own_misfit() <= self.most
        usable = agree & np.isfinite(misfit) & (abs(ratio) > 0.0)
        usable = usable & pushed(self.observe(LAW, *speeds))
        if self.energy is not None:
            usable = usable & (within >= 0.0) & (misfit <= self.most)
        root = Root(*speeds, self.e, moved / abs(closing), np.where(usable, closing, np.nan))
        return root, np.where(usable, misfit, np.inf), np.full((), np.inf)

    def _slip_that_loses(self, ratio: Any, closing: Any, places: Sequence[Any], energy: Any) -> Any:
        """The slip at which a contact that slides at this ratio loses an energy, from the losses at
        two other places: it is linear in the slip.
        """
        loss, more = (
            self.observe(ratio, *self.speeds_at(closing, one)).energy_loss for one in places
        )
        return places[0] + (places[1] - places[0]) * ((energy - loss) / (more - loss))

    def _moved_beside_an_energy(self, ratio: Any, places: Sequence[Any]) -> Any:
        """How far relative errors of the momenta and the energy may move the speeds of a contact
        that slid, by central differences: the momenta move the closing speed, and with it, and with
        a ratio that they show, the slip that loses the energy.
        """
        of_friction = self._of_friction() if np.any(self.shows_friction) else None

        def speeds(momenta: Sequence[Any], energy: Any) -> tuple[Any, Any]:
            at = ratio
            if of_friction is not None:
                changes = (new - old for new, old in zip(momenta, self._momenta, strict=True))
                change = np.sign(ratio) * dot(of_friction, list(changes))
                at = ratio + np.where(self.shows_friction, change, 0.0)
            once, twice = (
                self._seen_momenta(self.observe(at, *self.speeds_at(one, 0.0 * one)))
                for one in (np.ones(()), np.full((), 2.0))
            )
            effect = [more - less for more, less in zip(twice, once, strict=True)]
            left = [momentum - less for momentum, less in zip(momenta, once, strict=True)]
            closing = 1.0 + dot(effect, left) / dot(effect, effect)
            return self.speeds_at(closing, self._slip_that_loses(at, closing, places, energy))

        known = [*self._momenta, self.energy]
        powers = [1.0] * len(self._momenta) + [2.0 if "energy_loss" in self.squares else 1.0]
        moved: Any = (0.0, 0.0)
        for at, (value, power) in enumerate(zip(known, powers, strict=True)):
            up, down = (
                speeds(changed[:-1], changed[-1])
                for changed in (
                    [*known[:at], (1.0 + step) * value, *known[at + 1 :]]
                    for step in (_SHARE, -_SHARE)
                )
            )
            moved = [
                before + power * abs(high - low) / (2.0 * _SHARE)
                for before, high, low in zip(moved, up, down, strict=True)
            ]
        return np.maximum(*moved)

    def _one_slip(self, slip: float) -> tuple[Any, Any]:
        return self.speeds_at(np.ones(()), slip * np.ones(()))

    def _losing(self, root: Root, misfit: Any, left: Any) -> tuple[Root, Any, Any]:
        """A contact that sticks, with what the known energy differs from its loss.

        An energy goes as the square of the impulse, of which all misfits are shares. Where no
        friction is known, a little more energy makes it a contact that slid, whose speeds move far
        more: the condition is the greater of both.
        """
        here = self.observe(STICK, *root[:2])
        loss = here.energy_loss
        if np.any(self.shows_friction):
            slid = self._end(here.tangential / here.normal)[0].condition
            condition = np.where(self.shows_friction, np.fmax(root.condition, slid), root.condition)
            root = root._replace(condition=condition)
        whole = np.maximum(misfit, 0.5 * abs(self.energy / loss - 1.0))
        fits = whole <= self.most
        root = root._replace(closing=np.where(fits, root.closing, np.nan))
        return root, np.where(fits, whole, np.inf), left

    def _either(
        self,
        regimes: Sequence[Any],
        stuck: Sequence[tuple[Root, Any, Any]],
        sliding: Sequence[tuple[Root, Any, Any]],
    ) -> Any:
        """Whether one that stuck and one that slid at the friction given both fit the components
        and the energy within the accuracy of recorders, neither exactly, and the latter reaches
        further within it; or both exactly, as where hardly any friction takes no energy.

        At the ratio that components show one that slid is no other: it begins at the one that
        stuck, and their energy says how far it slid.
        """
        assert self.energy is not None
        (stuck_at,) = (at for at, regime in enumerate(regimes) if regime is STICK)
        own, own_misfit, _ = stuck[stuck_at]
        most = copy(self)
        most.energy = MOST_ENERGY * self.energy
        further = [most._end(regime) for regime in regimes if regime is not STICK]
        # One that loses more fits too, also where none loses as little.
        least = np.fmin.reduce(np.broadcast_arrays(own_misfit, *(one[1] for one in sliding)))
        slid = [
            [np.where(misfit <= ACCURACY, speed, np.nan) for speed in root[:2]]
            for root, misfit, _ in (*sliding, *further)
        ]
        either = fit_either(own_misfit, least, own[:2], slid, own.closing, self.forward_only)
        # An energy goes as the square of the impulse.
        most.energy = (1.0 + 2.0 * _EXACT) * self.energy
        exact = [
            [np.where(misfit <= _EXACT, speed, np.nan) for speed in root[:2]]
            for root, misfit, _ in (most._end(regime) for regime in regimes if regime is not STICK)
        ]
        far = _far_from(own[:2], exact, own.closing, self.forward_only)
        either = either | ((own_misfit <= _EXACT) & far)
        return either & np.isfinite(self.bound) & ~self.shows_friction

    def loses_more(self) -> Any:
        """Whether the known energy is more than a contact that stuck loses."""
        root, _, _ = self._solved(STICK)
        return self.energy > self.observe(STICK, *root[:2]).energy_loss

    def _own_misfit(self) -> Any:
        """The misfit of the components to the impulse that fits them best, whatever the friction.

        It is 0 for those of one vehicle.
        """
        root, _, _ = self._solved(STICK)
        here = self.observe(STICK, *root[:2])
        return self._misfit(here)

    def _misfit(self, here: Observed) -> Any:
        """What the components differ by from those seen, relative to the impulse."""
        left = self._left(here)
        size = np.hypot(here.normal, here.tangential)
        return np.maximum(*(self._of(label, left) for label in "ab")) / size

    def _impulse_shown(self) -> tuple[Any, Any, Any, Any]:
        """The impulse along normal and tangent that the components show by themselves, as rows of
        their momenta and as numbers; and where they do not.
        """
        columns = [list(parts) for parts in zip(*self._axes, strict=True)]
        rows, flat = pseudoinverse(columns, [abs(part) for column in columns for part in column])
        normal, tangential = (dot(row, self._momenta) for row in rows)
        return rows, normal, tangential, flat

    def shown_ratio(self) -> Any:
        """The impulse ratio that the components show by themselves; NaN if they do not."""
        _, normal, tangential, flat = self._impulse_shown()
        return np.where(flat, np.nan, tangential / normal)

    def friction_differs(self) -> Any:
        """Where a friction beside a known speed is further from the ratio of the components alone
        than recorders may differ by.
        """
        stated = self.rule == FRICTION and self.stated is None and len(self.unknown) == 1
        if not stated or len(self.components) < 2:
            return np.zeros((), dtype=bool)
        _, normal, tangential, flat = self._impulse_shown()
        apart = abs(abs(tangential) - self.bound * normal) / np.hypot(normal, tangential)
        return np.isfinite(self.bound) & np.logical_not(flat) & (apart > ACCURACY)

    def _solved(self, regime: Any) -> tuple[Root, Any, Any]:
        """The least squares of a regime."""
        rest, effects, inverse, stays_open = self._linear_in(regime)
        speeds = [speed + 0.0 * rest[0] for speed in self.known]
        for _ in range(_REFINEMENTS):
            left = self._left(self.observe(regime, *speeds))
            for at, row in zip(self.unknown, inverse, strict=True):
                step = dot(row, left)
                speeds[at] = speeds[at] + np.where(np.isfinite(step), step, 0.0)
        if len(self.unknown) == 1 and not isinstance(regime, str) and np.any(self.shows_friction):
            inverse = [self._with_the_ratio(inverse[0], regime, speeds)]
        moved = self._moved(inverse, effects, self._momenta)
        return self._judged(regime, speeds, moved, stays_open)

    def _with_the_ratio(self, row: Sequence[Any], ratio: Any, speeds: Sequence[Any]) -> list[Any]:
        """What the momenta change the unknown speed by, with what they change the ratio by where
        they show it.
        """
        here, smooth = (self.observe(one, *speeds) for one in (ratio, 0.0 * ratio))
        # At one closing speed the reciprocal of the normal impulse is linear in the ratio.
        normal = (here.normal / smooth.normal - 1.0) * here.normal / ratio
        tangential = here.normal + ratio * normal
        by_ratio = -dot(row, [n * normal + t * tangential for n, t in self._axes])
        by_ratio = np.where(self.shows_friction & (ratio != 0.0), np.sign(ratio) * by_ratio, 0.0)
        return [one + by_ratio * part for one, part in zip(row, self._of_friction(), strict=True)]

    def _of_friction(self) -> list[Any]:
        """What the momenta change the friction by that they show."""
        rows, normal, tangential, _ = self._impulse_shown()
        ratio = tangential / normal
        return [np.sign(ratio) * (t - ratio * n) / normal for n, t in zip(*rows, strict=True)]

    def _moved(self, inverse: Sequence[Any], effects: Sequence[Any], momenta: Sequence[Any]) -> Any:
        """How far relative errors of the momenta and of a known speed may move the speeds."""
        moved: Any = 0.0
        for row in inverse:
            by_momenta = sum(
                abs(part * momentum) for part, momentum in zip(row, momenta, strict=True)
            )
            # A known speed enters by what it takes off the momenta.
            by_speeds = sum(
                abs(dot(row, effect) * speed)
                for effect, speed in zip(effects, self.known, strict=True)
            )
            moved = np.maximum(moved, by_momenta + by_speeds)
        return moved

    def _linear_in(self, regime: Any) -> tuple[list[Any], list[list[Any]], list[list[Any]], Any]:
        """What the components are at rest, the effect of each speed on them, the inverse for the
        unknown speeds, and where it leaves one open.
        """
        rest, *moving = map(self._seen_momenta, self.unit_responses(regime))
        effects = [
            [at - still for at, still in zip(momenta, rest, strict=True)] for momenta in moving
        ]
        columns = [effects[at] for at in self.unknown]
        inverse, stays_open = pseudoinverse(
            columns, [abs(part) for effect in effects for part in effect]
        )
        return rest, effects, inverse, stays_open

    def _edges(self) -> list[tuple[Root, Any, Any]]:
        """With one speed known: where sticking just uses up the friction, one way or the other.

        The least misfit lies there where that of each regime lies beyond its end.
        """
        if self.rule != FRICTION or len(self.unknown) > 1:
            return []
        (at,) = self.unknown
        known = self.known
        of_unknown, of_known = (
            [speed + (1.0 if i == one else 0.0) for i, speed in enumerate(known)]
            for one in (at, 1 - at)
        )
        seen = [
            self.observe(STICK, speed_a, speed_b)
            for speed_a, speed_b in (known, of_unknown, of_known)
        ]
        found = []
        for sign in (1.0, -1.0):
            here, by_unknown, by_known = (
                one.tangential - sign * self.bound * one.normal for one in seen
            )
            slope = by_unknown - here
            speeds = [speed + 0.0 * here for speed in known]
            speeds[at] = np.where(
                np.isfinite(self.bound) & (self.bound > 0.0), -here / slope, np.nan
            )
            moved = abs((by_known - here) / slope * known[1 - at])
            if np.any(self.shows_friction):
                by_friction = abs(self.observe(STICK, *speeds).normal / slope)
                by_friction = np.where(self.shows_friction, by_friction, 0.0)
                moved = moved + by_friction * sum(
                    abs(part * momentum)
                    for part, momentum in zip(self._of_friction(), self._momenta, strict=True)
                )
            root, misfit, left = self._judged(STICK, speeds, moved, False)
            # Small errors leave the answer there; greater ones move it on as one that slid.
            slid, _, _ = self._solved(sign * self.bound)
            root = root._replace(condition=np.fmax(root.condition, slid.condition))
            found.append((root, misfit, left))
        return found

    def _judged(
        self, regime: Any, speeds: Sequence[Any], moved: Any, stays_open: Any
    ) -> tuple[Root, Any, Any]:
        """The root at these speeds, whose relative errors grow to ``moved``, and its misfit
        relative to the impulse.

        The misfit is infinite unless the law leads from these speeds to the impulse of this regime.
        Last comes the misfit of a regime that may have been and leaves a speed open, else infinity.
        """
        here, seen = (self.observe(which, *speeds) for which in (regime, LAW))
        misfit = self._misfit(here)
        apart = abs(seen.normal - here.normal) + abs(seen.tangential - here.tangential)
        fits = pushed(seen) & (apart <= ROOT_TOL * abs(here.normal))
        usable = fits & np.logical_not(stays_open) & (misfit <= self.most)
        leaves_open = stays_open & self._can_occur(regime) & (here.normal > 0.0)
        root = Root(
            speeds[0],
            speeds[1],
            self.e,
            moved / abs(here.closing),
            np.where(usable, seen.closing, np.nan),
        )
        return root, np.where(usable, misfit, np.inf), np.where(leaves_open, misfit, np.inf)

    def _seen_momenta(self, seen: Observed) -> list[Any]:
        return [n * seen.normal + t * seen.tangential for n, t in self._axes]

    def _left(self, seen: Observed) -> list[Any]:
        return [
            target - one
            for target, one in zip(self._momenta, self._seen_momenta(seen), strict=True)
        ]

    def _of(self, label: str, left: Sequence[Any]) -> Any:
        """The length of what remains of the components of one vehicle."""
        return np.sqrt(
            sum(
                (
                    one * one
                    for kind, one in zip(self.components, left, strict=True)
                    if kind[-1] == label
                ),
                0.0,
            )
        )

    def warn(self, answered: Any, cases: Cases) -> None:
        """Warn of known values that differ beyond their accuracy, of courses near one line, of a
        contact that may have slid.
        """
        misfit = np.where(self.ended, self._own_misfit(), self.misfit) if self.slid else self.misfit
        differ = answered & (misfit > ACCURACY)
        who = " and ".join(self.names)
        up_to = "" if cases.shape is None else "up to "
        if np.any(differ):
            worst = float(np.max(np.where(answered, misfit, 0.0), initial=0.0))
            much = percent_beyond(worst, ACCURACY)
            # The misfit of an energy is half of what it differs by.
            twice = "" if self.energy is None else f" (or {2.0 * worst:.0%} of the energy)"
            why = (
                f"the stated accuracy of recorders is {ACCURACY:.0%}: one of them, a course or "
                "the geometry is wrong"
            )
            text = (
                f"{who} differ from their best common answer by {up_to}{much}% of the impulse"
                f"{twice}, where {why}"
            )
            sentence = f"{who} differ from their best common answer by more than they may, as {why}"
            text = cases.how_many(differ) + text
            warning = IllConditionedWarning(
                text, code="recorders_differ", value=worst, known=self.names
            )
            # Refused cases differ the most.
            warn_of_cases(warning, {sentence: cases.each(misfit > ACCURACY)}, _DISAGREE)
        ended = answered & self.ended & (self.misfit > ACCURACY) & np.logical_not(differ)
        if np.any(ended):
            worst = float(np.max(np.where(ended, self.misfit, 0.0)))
            much = percent_beyond(worst, ACCURACY)
            friction = (
                f"`friction={float(self.bound):.4g}`" if cases.shape is None else "this friction"
            )
            wrong = "the friction, one of them or the geometry is wrong"
            text = (
                f"a contact that slides with {friction} differs from {who} by {up_to}{much}% "
                f"of the impulse, where the stated accuracy of recorders is {ACCURACY:.0%}: {wrong}"
            )
            sentence = (
                f"a contact that slides with this friction differs from {who} by more than the "
                f"stated accuracy of recorders, {ACCURACY:.0%} of the impulse: {wrong}"
            )
            text = cases.how_many(ended) + text
            warning = IllConditionedWarning(
                text, code="friction_differs", value=worst, known=self.names
            )
            warn_of_cases(warning, {sentence: cases.each(ended)}, _DISAGREE)
        refused = np.logical_not(answered) & np.isinf(self.misfit) & self.friction_differs()
        refused = refused & np.logical_not(self.undetermined)
        if cases.shape is not None and np.any(refused):
            text = (
                f"no speed fits, and the ratio of {' and '.join(self.components)} is further from "
                f"the friction than recorders may differ. {RATIO_SHOWN}"
            )
            warning = IllConditionedWarning(cases.how_many(refused) + text, code="friction_differs")
            warn_of_cases(warning, {text: cases.each(refused)})
        (ax, ay), (bx, by) = (
            [self.given[f"course_{label}[{i}]"] for i in range(2)] for label in "ab"
        )
        sines = np.where(answered, abs(ax * by - ay * bx), 1.0)
        near = sines < math.sin(NEARLY_COLLINEAR)
        if len(self.unknown) > 1 and np.any(near):
            sine = float(np.min(sines))
            why = (
                "small errors of delta-V and of the courses move both speeds far; give one of them"
            )
            text = (
                f"course_a and course_b are {math.degrees(math.asin(sine)):.2g} degrees from one "
                f"line: {why}"
            )
            sentence = (
                f"course_a and course_b are within {math.degrees(NEARLY_COLLINEAR):.2g} degrees "
                f"of one line: {why}"
            )
            text = cases.how_many(near) + text
            warning = IllConditionedWarning(text, code="nearly_collinear", sine=sine)
            warn_of_cases(warning, {sentence: cases.each(near)})


class Shown(NamedTuple):
    """What components show of a contact: the friction in place of an infinite one, None where none
    is used; where a contact that slid fits as well as one that stuck, with other speeds; and to
    which side of those of the one that stuck each of those lies, NaN where that is not so; the
    least and the greatest of those beside a known speed, with the ratio of each; where they lie to
    both sides; and where the best of them fits better than the one that stuck.
    """

    friction: Any = None
    fits_both: Any = False
    toward: tuple[Any, Any] = (math.nan, math.nan)
    reach: tuple[Any, ...] = (math.nan,) * 4
    no_side: Any = False
    better: Any = False


def friction_shown(
    kind: Callable[..., ComponentScene],
    given: dict[str, Any],
    law: str,
    names: tuple[str, ...],
    shape: tuple[int, ...],
    regime: str | None,
) -> Shown:
    """The friction with the ratio that the components show in place of an infinite one, where the
    contact slid, and where a contact that slid fits as well as one that stuck.

    It slid where the caller stated that, where a known speed goes with a contact that slid and
    differs by more than recorders may from one that stuck, or where more energy was lost than
    sticking loses. A speed does not settle it where ``given`` says that it is ``EITHER``, and where
    a contact that slid fits within the accuracy of recorders with speeds far from one that stuck.
    """
    friction = given[FRICTION]
    speeds = [name for name in names if name.startswith("speed")]
    components = tuple(name for name in names if name.startswith("delta_v"))
    settles = speeds or len(components) < len(names)
    if regime == "sticking" or len(components) < 2 or not (settles or regime):
        return Shown()
    of_components = kind(given, FRICTION, law, components, shape).shown_ratio()
    shown = abs(of_components)
    usable = np.isinf(friction) & np.isfinite(shown)
    ratio = np.where(usable, shown, friction)
    if regime == "sliding":
        return Shown(ratio)
    stuck = kind(given, FRICTION, law, names, shape)
    either = np.asarray(given.get(EITHER, 0.0) > 0.0)
    if not speeds:
        return Shown(np.where(usable & stuck.loses_more() & ~either, shown, friction))
    slid = kind({**given, FRICTION: ratio}, FRICTION, law, names, shape, False, "sliding")
    closing = sum(np.nan_to_num(root.closing) for root in stuck.roots())
    one, other, *_ = slid.roots()
    slides = usable & ((one.closing > 0.0) | (other.closing > 0.0)) & (slid.misfit < stuck.misfit)
    settled = slides & (stuck.misfit > ACCURACY) & ~either
    (at,) = stuck.unknown
    move = slid.answer[at] - stuck.answer[at]
    least = _ONE_ANSWER * closing
    rises, falls = slides & (move > least), slides & (move < -least)
    better = (rises | falls) & ~settled
    stuck_at = stuck.answer[at]
    of_stuck = kind(given, FRICTION, law, names, shape)
    low, high = of_stuck.fitting(STICK)
    there = usable & (closing > 0.0) & ~settled
    reach: tuple[Any, ...] = (np.full((), np.nan),) * 4
    if np.any(there):
        reach = of_stuck.sliding(of_components, np.minimum(stuck_at, 0.0))
    rises = rises | (there & (reach[1] - np.fmax(high, stuck_at) > _BEYOND * closing))
    falls = falls | (there & (np.fmin(low, stuck_at) - reach[0] > _BEYOND * closing))
    differs = (rises | falls) & ~settled
    # One that hardly slid has the speeds of one that just stuck, to the ends of those.
    reach = np.fmin(reach[0], np.fmax(low, 0.0)), np.fmax(reach[1], high), *reach[2:]
    open_ = (usable & slid.undetermined & ~settled) | differs
    side = np.where(differs, np.subtract(rises, falls, dtype=np.float64), np.nan)
    of_known = np.where(differs, 0.0, np.nan)
    return Shown(
        np.where(settled, shown, friction) if np.any(settled) else None,
        open_,
        (side, of_known) if at == 0 else (of_known, side),
        reach,
        rises & falls & ~settled,
        better,
    )


def by_way(way: Any, values: Sequence[Any]) -> Any:
    """Of each case the value that goes with the way of its root."""
    whole = np.stack(np.broadcast_arrays(*values, way)[:-1])
    at = np.broadcast_to(np.asarray(way, dtype=np.int64), whole.shape[1:])
    return np.take_along_axis(whole, at[None], axis=0)[0]


def together(scenes: Sequence[ComponentScene], answered: Sequence[Any]) -> ComponentScene:
    """One scene for several that have the same readings and each an impulse of its own, and where
    they are ``answered``.
    """
    misfits = np.stack(np.broadcast_arrays(*(one.misfit for one in scenes)))
    usable = [there | one.ambiguous for there, one in zip(answered, scenes, strict=True)]
    fitting = np.where(np.stack(np.broadcast_arrays(*usable, misfits[0])[:-1]), misfits, np.inf)
    least = np.min(fitting, axis=0)
    none = np.isinf(least)
    best = fitting <= np.maximum(ROOT_TOL, least)
    # Of a single case, the texts are of the scene that fits best.
    at = int(np.argmin(np.where(none, misfits, fitting), axis=0)) if np.ndim(least) == 0 else 0
    whole = copy(scenes[at])
    whole.ways = list(scenes)
    whole.misfit = np.where(none, np.min(misfits, axis=0), least)
    slides = reduce(
        np.logical_or,
        (one.undetermined & (none | (one.left_open <= ACCURACY)) for one in scenes),
    )
    whole.undetermined = slides & none
    # A contact that slid fits beside one that stuck.
    for at, (one, here) in enumerate(zip(scenes, best, strict=True)):
        whole.ways[at] = copy(one)
        whole.ways[at].ambiguous = (one.ambiguous | (slides & one.sticks)) & here & ~none
    whole.ambiguous = reduce(np.logical_or, (one.ambiguous for one in whole.ways))
    whole.undetermined = whole.undetermined | (slides & ~whole.ambiguous)
    of_best = zip(scenes, best, strict=True)
    whole.both_ways = reduce(np.logical_or, (one.both_ways & at & ~none for one, at in of_best))
    whole.leaves_slip = reduce(np.logical_or, (one.leaves_slip for one in scenes))
    return whole


def dot(one: Sequence[Any], other: Sequence[Any]) -> Any:
    """The scalar product."""
    return sum(a * b for a, b in zip(one, other, strict=True))


def pseudoinverse(
    columns: Sequence[Sequence[Any]], sizes: Sequence[Any]
) -> tuple[list[list[Any]], Any]:
    """The rows of the pseudoinverse of one or two columns, by their orthogonal parts, and where
    these have no full rank.

    Without full rank they are those of the longer column alone.
    """
    least = (_NO_EFFECT * np.maximum.reduce(np.broadcast_arrays(*sizes))) ** 2
    squares = [dot(column, column) for column in columns]
    if len(columns) == 1:
        return [[part / squares[0] for part in columns[0]]], ~(squares[0] > least)
    swapped = squares[1] > squares[0]
    first, second = (
        [np.where(swapped, b, a) for a, b in zip(*pair, strict=True)]
        for pair in (columns, columns[::-1])
    )
    square = np.maximum(*squares)
    along = dot(first, second) / square
    across = [b - along * a for a, b in zip(first, second, strict=True)]
    crossed = dot(across, across)
    flat = ~(crossed > np.maximum(_NO_EFFECT**2 * square, 0.0))
    of_second = [np.where(flat, 0.0, part / crossed) for part in across]
    of_first = [part / square - along * other for part, other in zip(first, of_second, strict=True)]
    rows = [
        [np.where(swapped, b, a) for a, b in zip(*pair, strict=True)]
        for pair in ((of_first, of_second), (of_second, of_first))
    ]
    return rows, flat

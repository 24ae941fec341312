"""The algebra of ``speeds`` from components of delta-V (``ComponentScene``): least squares, linear
in each regime.

Components are components of the impulse, which in each regime is linear in both speeds: each regime
is one linear problem, of as many equations as components were given. Its answer counts if the law
leads from these speeds to that regime; where none does, the best lies on the edge between two.
Components are known relative to the impulse, so all weigh alike as momenta; a speed that is given
is taken as exact.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..kernels.contact_laws import FRICTION
from ..messages.errors import IllConditionedWarning
from ..messages.warning import warn_of_cases
from ..quantities.directions import Angle
from ..reference import RECORDER_ACCURACY
from .common import NEARLY_COLLINEAR, Cases
from .restitution_roots import RestitutionOf
from .speeds_algebra import LAW, REDUNDANT, ROOT_TOL, STICK, Root, Scene, Seen, pushed

ACCURACY = RECORDER_ACCURACY.high
# Beyond so many times the stated accuracy the known values contradict each other.
_CONTRADICTION = 3.0
# Relative size below which the effect of a speed is rounding.
_NO_EFFECT = 1e-12
_REFINEMENTS = 3


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
    ) -> None:
        super().__init__(given, rule, law, names, shape)
        self.components = [name for name in names if name.startswith("delta_v")]
        self.unknown = [at for at, label in enumerate("ab") if f"speed_{label}" not in names]
        # 0 in place of unknown ones.
        self.known = [self.targets.get(f"speed_{label}", np.zeros(())) for label in "ab"]
        self.misfit: Any = np.full((), np.nan)
        self.near_sliding: Any = np.zeros((), dtype=bool)
        nx, ny = self.given["normal[0]"], self.given["normal[1]"]
        self._axes, self._momenta = [], []
        for kind in self.components:
            label = kind[-1]
            fx, fy = Angle(self.given[f"{label}.heading"], False).direction
            ax, ay = (fx, fy) if "forward" in kind else (-fy, fx)
            sign = 1.0 if label == "b" else -1.0
            self._axes.append((sign * (nx * ax + ny * ay), sign * (nx * ay - ny * ax)))
            self._momenta.append(self.numbers[f"{label}.mass"] * self.numbers[kind])

    def roots(self, function: RestitutionOf | None = None) -> list[Root]:
        """The answer with the least misfit that the law leads to, or all that fit exactly; no
        others have a closing speed.
        """
        tried = [*map(self._solved, self.regimes()), *self._edges()]
        found, misfits, of_open_slip = zip(*tried, strict=True)
        self.misfit = np.minimum.reduce(np.broadcast_arrays(*misfits))
        open_slip = np.fmin.reduce(np.broadcast_arrays(*of_open_slip))
        none = np.isinf(self.misfit)
        self.undetermined = (open_slip <= REDUNDANT) | (
            none & (open_slip <= _CONTRADICTION * ACCURACY)
        )
        self.near_sliding = ~none & ~self.undetermined & (open_slip <= ACCURACY)
        best = [misfit <= np.maximum(ROOT_TOL, self.misfit) for misfit in misfits]
        return [
            root._replace(closing=np.where(here, root.closing, np.nan))
            for root, here in zip(found, best, strict=True)
        ]

    def _solved(self, regime: Any) -> tuple[Root, Any, Any]:
        """The least squares of a regime."""
        rest, *moving = map(self._seen_momenta, self.at_unit_speeds(regime))
        effects = [
            [at - still for at, still in zip(momenta, rest, strict=True)] for momenta in moving
        ]
        columns = [effects[at] for at in self.unknown]
        inverse, stays_open = _inverse(
            columns, [abs(part) for effect in effects for part in effect]
        )
        speeds = [speed + 0.0 * rest[0] for speed in self.known]
        for _ in range(_REFINEMENTS):
            left = self._left(self.observe(regime, *speeds))
            for at, row in zip(self.unknown, inverse, strict=True):
                step = _dot(row, left)
                speeds[at] = speeds[at] + np.where(np.isfinite(step), step, 0.0)
        moved: Any = 0.0
        for row in inverse:
            by_momenta = sum(
                abs(part * momentum) for part, momentum in zip(row, self._momenta, strict=True)
            )
            # A known speed enters by what it takes off the momenta.
            by_speeds = sum(
                abs(_dot(row, effect) * speed)
                for effect, speed in zip(effects, self.known, strict=True)
            )
            moved = np.maximum(moved, by_momenta + by_speeds)
        return self._judged(regime, speeds, moved, stays_open)

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
            found.append(self._judged(STICK, speeds, moved, False))
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
        left = self._left(here)
        misfit = np.maximum(*(self._of(label, left) for label in "ab")) / np.hypot(
            here.normal, here.tangential
        )
        apart = abs(seen.normal - here.normal) + abs(seen.tangential - here.tangential)
        fits = pushed(seen) & (apart <= ROOT_TOL * abs(here.normal))
        usable = fits & np.logical_not(stays_open) & (misfit <= _CONTRADICTION * ACCURACY)
        leaves_open = stays_open & self._can_occur(regime) & (here.normal > 0.0)
        root = Root(
            speeds[0],
            speeds[1],
            self.e,
            moved / abs(here.closing),
            np.where(usable, seen.closing, np.nan),
        )
        return root, np.where(usable, misfit, np.inf), np.where(leaves_open, misfit, np.inf)

    def _seen_momenta(self, seen: Seen) -> list[Any]:
        return [n * seen.normal + t * seen.tangential for n, t in self._axes]

    def _left(self, seen: Seen) -> list[Any]:
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
        differ = answered & (self.misfit > ACCURACY)
        if np.any(differ):
            worst = float(np.max(np.where(answered, self.misfit, 0.0), initial=0.0))
            who = " and ".join(self.names)
            why = (
                f"the stated accuracy of recorders is {ACCURACY:.0%}: one of them, a course or "
                "the geometry is wrong"
            )
            text = (
                f"{who} differ from their best common answer by {worst:.0%} of the impulse, "
                f"where {why}"
            )
            sentence = f"{who} differ from their best common answer by more than they may, as {why}"
            warning = IllConditionedWarning(text, code="recorders_differ", value=worst)
            warn_of_cases(warning, {sentence: cases.number(differ)})
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
            warning = IllConditionedWarning(text, code="nearly_collinear", sine=sine)
            warn_of_cases(warning, {sentence: cases.number(near)})
        slides = self.near_sliding & answered
        if np.any(slides):
            text = (
                "the direction of the delta-Vs is that of a contact that slides to the end, "
                "within the stated accuracy of recorders; it was taken to stick, as they lie "
                "within the friction. If it slid the slip is open: give one of the speeds"
            )
            warn_of_cases(
                IllConditionedWarning(text, code="may_slide"), {text: cases.number(slides)}
            )


def _dot(one: Sequence[Any], other: Sequence[Any]) -> Any:
    return sum(a * b for a, b in zip(one, other, strict=True))


def _inverse(columns: Sequence[Sequence[Any]], sizes: Sequence[Any]) -> tuple[list[list[Any]], Any]:
    """The rows of the pseudoinverse of one or two columns, by their orthogonal parts, and where
    these have no full rank.

    Without full rank they are those of the longer column alone.
    """
    least = (_NO_EFFECT * np.maximum.reduce(np.broadcast_arrays(*sizes))) ** 2
    squares = [_dot(column, column) for column in columns]
    if len(columns) == 1:
        return [[part / squares[0] for part in columns[0]]], ~(squares[0] > least)
    swapped = squares[1] > squares[0]
    first, second = (
        [np.where(swapped, b, a) for a, b in zip(*pair, strict=True)]
        for pair in (columns, columns[::-1])
    )
    square = np.maximum(*squares)
    along = _dot(first, second) / square
    across = [b - along * a for a, b in zip(first, second, strict=True)]
    crossed = _dot(across, across)
    flat = ~(crossed > np.maximum(_NO_EFFECT**2 * square, 0.0))
    of_second = [np.where(flat, 0.0, part / crossed) for part in across]
    of_first = [part / square - along * other for part, other in zip(first, of_second, strict=True)]
    rows = [
        [np.where(swapped, b, a) for a, b in zip(*pair, strict=True)]
        for pair in ((of_first, of_second), (of_second, of_first))
    ]
    return rows, flat

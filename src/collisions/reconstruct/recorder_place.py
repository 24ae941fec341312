"""Readings of recorders as they are built, away from the centre of mass and in axes that turn, as
what is known to ``speeds`` (``RecorderScene``).

A recorder at f ahead of the centre of mass and l to its left sums up the acceleration of its own
place in the axes of the car. While the contact lasts the car turns by psi, at the yaw rate w. With
the part P(t) of the impulse that has passed, the reading is

    forward:   C dv_f + S dv_l - dw l - W f
    left:     -S dv_f + C dv_l + dw f - W l

where dv is the delta-V of the centre of mass in the axes of the heading, dw the change of yaw rate,
C and S the means of cos psi and sin psi over the impulse, and W the integral of w^2 over time (A.
Marine, S. Werner, "Delta-V analysis from crash test data for vehicles with post-impact yaw motion",
SAE 980219, 1998). In each regime dv and dw are linear in both speeds, and C, S and W follow from dw
and the pulse: the readings are linear about the dw found last (Newton), until it stays.

One reading may come of several impulses, each with a turn of its own. They are looked for from many
turns (``RecorderScene.impulses``), and each begins a scene of its own.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..impact.pulse import QUARTER
from ..impact.recorded import read_axes, read_place
from ..messages.errors import InputError, MissingInputError, ShapeError
from ..quantities.directions import Angle
from ..quantities.reading import ArgumentReader
from ..quantities.units import shown
from ..vehicle.drag import read_duration
from .speeds_algebra import Observed, Root
from .speeds_components import CONTRADICTION, ComponentScene, dot, pseudoinverse

# Nodes and weights of a Gauss-Legendre rule over each part of the pulse: turns of half a radian to
# 1e-12.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
# Until two rounds differ by less than this turn, in radians; far more rounds than any crash needs.
_SETTLED, _ROUNDS = 1e-12, 60
# The largest turn of a car while the contact lasts, in radians: one that turns by more does not
# keep its point of contact and its lever arms. In how many turns it is looked for, of one recorder
# and of each of two.
_MOST_TURN, _TURNS = 0.5 * math.pi, {1: 65, 2: 9}
# Of the impulses that those lead to: rounds, until they differ by less than this turn, and the
# share within which two are one.
_LOOKS, _FOUND, _ONE = 10, 1e-7, 1e-5


class Recorders(NamedTuple):
    """Numbers of the recorders by name, the vehicles they are of, whether their axes turn, and of
    which the place was given: others are taken at the centre of mass.
    """

    numbers: dict[str, Any]
    labels: str
    turning: bool
    placed: str

    @property
    def names(self) -> tuple[str, ...]:
        """Their names among what was known."""
        places = [f"recorder_{label}" for label in self.placed]
        return (*places, "recorder_axes_turning" if self.turning else "recorder_axes_fixed")


def read_recorders(
    reader: ArgumentReader,
    places: dict[str, Any],
    axes: Any,
    duration: Any,
    components: Sequence[str],
) -> Recorders | None:
    """Places, axes and duration of the contact; None where none of them was given, and the
    components are those of the centre of mass in the axes of the heading.
    """
    given = {label: place for label, place in places.items() if place is not None}
    if not given and axes is None:
        if duration is not None:
            text = (
                f"duration = {shown(duration)} is that over which recorders turn or tyres act; "
                "write `axes='turning'` (or 'fixed'), and `recorder_a=(forward, left)` for the "
                "place; or give `tyres_a=`"
            )
            reader.refuse(InputError(text, code="bad_combination", argument="duration"))
        return None
    with_components = "".join(label for label in "ab" if any(n[-1] == label for n in components))
    stray = [label for label in given if label not in with_components]
    if stray or not with_components:
        name = f"recorder_{stray[0]}" if stray else "axes"
        side = stray[0] if stray else "a"
        text = (
            f"{name} is for components of delta-V, which it carries over to the centre of mass, "
            f"and none was given; give delta_v_forward_{side} and delta_v_left_{side}, or leave "
            "it out"
        )
        reader.refuse(InputError(text, code="bad_combination", argument=name))
    turning = axes is None or read_axes(reader, axes) == "turning"
    if duration is None:
        text = (
            "duration `|is None|is not given`, and a recorder turns with its car "
            "while the contact lasts; write `duration='100 ms'`, such as that of the "
            "recorded pulse, or 0 for a contact in which nothing turns"
        )
        reader.refuse(MissingInputError(text, code="missing_duration", argument="duration"))
        duration = 0.0
    numbers = {"duration": read_duration(reader, duration)}
    for label in with_components:
        name = f"recorder_{label}"
        place = given.get(label, (0.0, 0.0))
        if not isinstance(place, (tuple, list)) or len(place) != 2:
            text = (
                f"{name} must be `(forward, left)`, how far ahead of the centre of mass the "
                "recorder sits and how far to its left, such as `('0.5 m', 0)`, got "
                f"{shown(place)}"
            )
            reader.refuse(ShapeError(text, code="bad_shape", argument=name))
            continue
        names = f"{name}[0]", f"{name}[1]"
        numbers |= zip(names, read_place(reader, (place[0], place[1]), names), strict=True)
    return Recorders(numbers, with_components, turning, "".join(sorted(given)))


class Turning(NamedTuple):
    """How a car turns during the contact, and how each of it changes with the change of yaw rate.

    They are the means of cosine and sine of its turn over the impulse, the integral of the square
    of its yaw rate, and its turn at the start and the end.
    """

    cos: Any
    sin: Any
    square: Any
    before: Any
    after: Any


def turning(e: Any, duration: Any, spin: Any, change: Any) -> tuple[Turning, Turning]:
    """The turn of a car from the position of maximum engagement, by the yaw rate before and its
    change, and its slopes by that change; the impulse passes as that of the spring pulse.
    """
    # Compression up to a quarter of a sine, or in an incomplete impact up to its end.
    cut = np.where(e < 0.0, np.arccos(np.clip(-e, 0.0, 1.0)), QUARTER)
    back = np.where(e < 0.0, 0.0, e)
    length = duration / (1.0 + back)
    whole = 1.0 + e
    shape = (-1, *[1] * np.ndim(cut + length + spin + change))
    share, weight = 0.5 * (_NODES + 1.0).reshape(shape), 0.5 * _WEIGHTS.reshape(shape)
    # Of each part of the pulse: time since first contact, what has passed, its sum over time, its
    # rate by the share of the part, and how long the part lasts.
    until = length / cut * (cut - np.sin(cut)) / whole
    phase, later = share * cut, share * QUARTER
    compressing = (
        length * share,
        (1.0 - np.cos(phase)) / whole,
        length / cut * (phase - np.sin(phase)) / whole,
        cut * np.sin(phase) / whole,
        length,
    )
    restoring = (
        length * (1.0 + back * share),
        (1.0 + back * np.sin(later)) / whole,
        until + length * back / QUARTER * (later + back * (1.0 - np.cos(later))) / whole,
        QUARTER * back * np.cos(later) / whole,
        length * back,
    )
    found: Any = (0.0,) * 6
    for time, passed, summed, rate, lasts in (compressing, restoring):
        grows = summed - until
        turned = spin * (time - length) + change * grows
        rates = spin + change * passed
        parts = (
            rate * np.cos(turned),
            rate * np.sin(turned),
            lasts * rates * rates,
            -rate * np.sin(turned) * grows,
            rate * np.cos(turned) * grows,
            2.0 * lasts * rates * passed,
        )
        found = [
            one + np.sum(weight * part, axis=0) for one, part in zip(found, parts, strict=True)
        ]
    end = length * back / QUARTER * (QUARTER + back) / whole
    cos, sin, square, cos_slope, sin_slope, square_slope = found
    before, after = -spin * length - change * until, spin * length * back + change * end
    return (
        Turning(cos, sin, square, before, after),
        Turning(cos_slope, sin_slope, square_slope, -until, end),
    )


class RecorderScene(ComponentScene):
    """Two vehicles whose speeds are unknown, and components of delta-V as recorders show them."""

    def __init__(
        self,
        recorders: Recorders,
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
        start: tuple[Any, Any] = (0.0, 0.0),
    ) -> None:
        self._recorders, self.recorders = recorders, recorders.names
        # By regime, which is kept with what was found for it: what is seen at unit speeds, and the
        # answer with the axes and the turns that go with it.
        self._seen: dict[Any, tuple[Any, list[Observed]]] = {}
        self._roots: dict[Any, tuple[Any, tuple[Root, Any, Any], tuple[Any, Any, Any]]] = {}
        super().__init__(
            given, rule, law, names, shape, plain, regime, slid, most, direction, forward_only
        )
        self._duration = self.given["duration"] * self.speed_unit
        self._readings = [
            self.numbers[f"{kind[-1]}.mass"] * self.numbers[kind] for kind in self.components
        ]
        nx, ny = self.given["normal[0]"], self.given["normal[1]"]
        self._own: dict[str, tuple[Any, ...]] = {}
        self._by_tyres: dict[str, tuple[Any, ...]] = {}
        for label in recorders.labels:
            sign = 1.0 if label == "b" else -1.0
            fx, fy = Angle(self.given[f"{label}.heading"], False).direction
            rx, ry = (self.given[f"point[{i}]"] - self.given[f"{label}.{x}"]
                for i, x in enumerate("xy"))  # fmt: skip
            per_inertia = sign / self.numbers[f"{label}.yaw_inertia"]
            # Of the tyres: forward, left, and the change of yaw rate.
            x, y, moment = self._held_of(label)
            by_tyres = moment / self.numbers[f"{label}.yaw_inertia"]
            self._by_tyres[label] = fx * x + fy * y, fx * y - fy * x, by_tyres
            # Of the impulse along n and along t: forward, left, and the change of yaw rate.
            self._own[label] = (
                (sign * (nx * fx + ny * fy), sign * (nx * fy - ny * fx)),
                (sign * (ny * fx - nx * fy), sign * (nx * fx + ny * fy)),
                (per_inertia * (rx * ny - ry * nx), per_inertia * (rx * nx + ry * ny)),
            )
        self._changes: dict[str, Any] = {}
        self._turned: dict[str, Any] = {}
        # The impulse along n and t from which each regime is looked for.
        self._start = tuple(part / (self.mass_unit * self.speed_unit) for part in start)
        self._linear_about(self._start)

    def _linear_about(
        self,
        impulse: tuple[Any, Any],
        changes: Mapping[str, Any] | None = None,
        fixed: bool = False,
    ) -> None:
        """Set what the components say of the impulse, linear about this one along n and t.

        Cars turn as it makes them, or by these ``changes`` of their yaw rates; with ``fixed`` they
        keep to those whatever the impulse.
        """
        rows: dict[str, Any] = {}
        normal, tangential = impulse
        for label, own in self._own.items():
            mass, spin = self.numbers[f"{label}.mass"], self.numbers[f"{label}.yaw_rate"]
            by_contact = [n * normal + t * tangential for n, t in own]
            held = self._by_tyres[label]
            # What tyres do passes as what the contact does.
            ahead, aside, change = (one + more for one, more in zip(by_contact, held, strict=True))
            if changes is not None:
                change = changes[label]
            self._changes[label] = change
            turn, slope = turning(self.e, self._duration, spin, change)
            self._turned[label] = abs(turn.after - turn.before)
            f, left = (self.given[f"recorder_{label}[{i}]"] for i in range(2))
            if self._recorders.turning:
                c, s = turn.cos, turn.sin
                by_place = -change * left - turn.square * f, change * f - turn.square * left
                slopes = (
                    (slope.cos * ahead + slope.sin * aside) / mass - left - slope.square * f,
                    (slope.cos * aside - slope.sin * ahead) / mass + f - slope.square * left,
                )
            else:
                c, s = 1.0, 0.0
                (x0, y0), (x1, y1) = (
                    (np.cos(psi) * f - np.sin(psi) * left, np.sin(psi) * f + np.cos(psi) * left)
                    for psi in (turn.before, turn.after)
                )
                after = spin + change
                by_place = spin * y0 - after * y1, after * x1 - spin * x0
                slopes = (
                    spin * x0 * slope.before - y1 - after * x1 * slope.after,
                    x1 - after * y1 * slope.after + spin * y0 * slope.before,
                )
            for part, (one, other), extra, by in (
                ("forward", ((c, own[0]), (s, own[1])), by_place[0], slopes[0]),
                ("left", ((c, own[1]), (-s, own[0])), by_place[1], slopes[1]),
            ):
                by = 0.0 if fixed else by
                row = tuple(
                    one[0] * one[1][i] + other[0] * other[1][i] + mass * by * own[2][i]
                    for i in range(2)
                )
                known = mass * (by * (change - held[2]) - extra)
                if self.held:
                    at = 0 if part == "forward" else 1
                    known = known - (one[0] * held[at] + other[0] * held[1 - at])
                rows[f"delta_v_{part}_{label}"] = row, known
        self._axes = [rows[kind][0] for kind in self.components]
        self._momenta = [
            reading + rows[kind][1]
            for kind, reading in zip(self.components, self._readings, strict=True)
        ]

    def impulses(self) -> list[tuple[Any, Any]]:
        """The impulses along n and t, in kg m/s, that the readings may mean: each of as many cases
        as have so many, NaN in others, those first at which the cars turn least.

        They are those to which Newton's method leads from turns of up to a quarter either way: of
        all impulses, and with a known speed of those that each regime has.
        """
        spaces: list[tuple[tuple[Any, Any], list[tuple[Any, Any]]]] = []
        if len(self.components) > 1:
            spaces.append(((0.0, 0.0), [(1.0, 0.0), (0.0, 1.0)]))
        if len(self.unknown) == 1:
            (at,) = self.unknown
            for regime in self._stated_regimes():
                still, *moving = self.unit_responses(regime)
                by_speed = [
                    (one.normal - still.normal, one.tangential - still.tangential) for one in moving
                ]
                n, t = (self.known[1 - at] * part for part in by_speed[1 - at])
                spaces.append(((still.normal + n, still.tangential + t), [by_speed[at]]))
        found = [self._led_to(*space) for space in spaces]
        normal, tangential, turn = (np.concatenate(parts) for parts in zip(*found, strict=True))
        order = np.argsort(turn, axis=0, kind="stable")
        normal, tangential = (np.take_along_axis(p, order, 0) for p in (normal, tangential))
        kept = np.isfinite(normal)
        size = _ONE * np.hypot(normal, tangential)
        for i in range(1, len(kept)):
            apart = np.hypot(normal[:i] - normal[i], tangential[:i] - tangential[i])
            kept[i] &= ~np.any(kept[:i] & (apart <= size[i]), axis=0)
        order = np.argsort(~kept, axis=0, kind="stable")
        unit = self.mass_unit * self.speed_unit
        most = max(int(np.max(np.sum(kept, axis=0), initial=0)), 1)
        n, t = (
            np.take_along_axis(np.where(kept, part, np.nan), order, 0)[:most] * unit
            for part in (normal, tangential)
        )
        return list(zip(n, t, strict=True))

    def _led_to(
        self, base: tuple[Any, Any], along: Sequence[tuple[Any, Any]]
    ) -> tuple[Any, Any, Any]:
        """The impulses that turns lead to, from a base along one direction or two, and how far the
        cars turn there; NaN where none was found.
        """
        shape = self.shape
        labels = self._recorders.labels
        shares = np.linspace(-1.0, 1.0, _TURNS[len(labels)])
        # Closer where cars turn little, as nearly all do.
        turns = _MOST_TURN * shares * abs(shares)
        whole = turning(self.e, self._duration, 0.0, np.ones(shape))[0]
        per_change = whole.after - whole.before
        changes = {}
        for label, turn in zip(labels, np.meshgrid(*[turns] * len(labels)), strict=True):
            spun = self.numbers[f"{label}.yaw_rate"] * self._duration
            change = (turn.reshape(-1, *[1] * len(shape)) - spun) / per_change
            changes[label] = np.where(np.isfinite(change), change, 0.0)

        def impulse() -> tuple[Any, Any]:
            columns = [[n * dn + t * dt for n, t in self._axes] for dn, dt in along]
            left = [
                momentum - (n * base[0] + t * base[1])
                for (n, t), momentum in zip(self._axes, self._momenta, strict=True)
            ]
            inverse, _ = pseudoinverse(
                columns, [abs(part) for column in columns for part in column]
            )
            steps = [dot(row, left) for row in inverse]
            first, second = (
                base[i] + sum(step * way[i] for step, way in zip(steps, along, strict=True))
                for i in range(2)
            )
            return first, second

        self._linear_about((0.0, 0.0), changes, fixed=True)
        found = impulse()
        self._linear_about(found, changes)
        moved: Any = math.inf
        for _ in range(_LOOKS):
            before = dict(self._changes)
            found = impulse()
            self._linear_about(found)
            moved = self._turned_since(before)
            if not np.any(moved > _FOUND):
                break
        turn = sum(self._turned.values())
        there = (moved <= _FOUND) & self._within_the_most()
        whole_shape = np.broadcast_shapes(np.shape(changes[labels[0]]), shape)
        n, t, turn = (
            np.broadcast_to(np.where(there, part, np.nan), whole_shape) for part in (*found, turn)
        )
        return n, t, turn

    def _within_the_most(self) -> Any:
        """Where no car turns further than that while the contact lasts."""
        return np.logical_and.reduce(
            np.broadcast_arrays(*(turn <= _MOST_TURN for turn in self._turned.values()))
        )

    def unit_responses(self, regime: Any) -> list[Observed]:
        """As in any scene; it does not depend on the axes, so each regime is asked once."""
        key = regime if isinstance(regime, str) else id(regime)
        if key not in self._seen:
            self._seen[key] = regime, super().unit_responses(regime)
        return self._seen[key][1]

    def _solved(self, regime: Any) -> tuple[Root, Any, Any]:
        """The least squares of a regime, with the turn of the cars that its own answer leads to.

        Each regime is solved once; its axes are those that count after any call.
        """
        key = regime if isinstance(regime, str) else id(regime)
        if key not in self._roots:
            found = self._solved_once(regime)
            self._roots[key] = regime, found, (self._axes, self._momenta, dict(self._changes))
        _, found, (self._axes, self._momenta, changes) = self._roots[key]
        self._changes = dict(changes)
        return found

    def _solved_once(self, regime: Any) -> tuple[Root, Any, Any]:
        self._near_the_turn(regime)
        moved: Any = math.inf
        for _ in range(_ROUNDS):
            before = dict(self._changes)
            found = super()._solved(regime)
            moved = self._turned_since(before)
            if not np.any(moved > _SETTLED):
                break
        root, misfit, open_slip = found
        settled = moved <= _SETTLED
        return (
            root._replace(closing=np.where(settled, root.closing, np.nan)),
            np.where(settled, misfit, np.inf),
            np.where(settled, open_slip, np.inf),
        )

    def _near_the_turn(self, regime: Any) -> None:
        """Set the axes to those of the turn of this regime, but for rounding.

        The impulse of a regime is linear in the speeds, so that no impact has to be solved for it.
        """
        self._linear_about(self._start)
        still, *moving = self.unit_responses(regime)
        for _ in range(_ROUNDS):
            before = dict(self._changes)
            rest, effects, inverse, _ = self._linear_in(regime)
            left = [momentum - part for momentum, part in zip(self._momenta, rest, strict=True)]
            for speed, effect in zip(self.known, effects, strict=True):
                left = [one - speed * part for one, part in zip(left, effect, strict=True)]
            speeds = list(self.known)
            for at, row in zip(self.unknown, inverse, strict=True):
                step = sum(part * one for part, one in zip(row, left, strict=True))
                speeds[at] = np.where(np.isfinite(step), step, 0.0)
            normal, tangential = still.normal, still.tangential
            for speed, one in zip(speeds, moving, strict=True):
                normal = normal + speed * (one.normal - still.normal)
                tangential = tangential + speed * (one.tangential - still.tangential)
            self._linear_about((normal, tangential))
            if not np.any(self._turned_since(before) > _SETTLED):
                break

    def _turned_since(self, before: Mapping[str, Any]) -> Any:
        """How far the turn of the cars is from that with these changes of their yaw rates."""
        moved = sum(abs(self._changes[label] - before[label]) for label in self._own)
        return moved * self._duration

    def _judged(
        self, regime: Any, speeds: Sequence[Any], moved: Any, stays_open: Any
    ) -> tuple[Root, Any, Any]:
        here: Observed = self.observe(regime, *speeds)
        self._linear_about((here.normal, here.tangential))
        within = self._within_the_most()
        root, misfit, open_slip = super()._judged(regime, speeds, moved, stays_open)
        return (
            root._replace(closing=np.where(within, root.closing, np.nan)),
            np.where(within, misfit, np.inf),
            np.where(within, open_slip, np.inf),
        )


def by_own_names(
    known: Mapping[str, Any], recorders: Recorders | None, lasts: bool = False
) -> dict[str, Any]:
    """What was known, with that of recorders by names of its own: the result has the delta-V of the
    centre of mass, which the readings are not, and an instant for a contact unless it ``lasts``.
    """
    own: dict[str, str] = {}
    for label in "" if recorders is None else recorders.labels:
        own |= {
            f"delta_v_forward_{label}": f"reading_forward_{label}",
            f"delta_v_left_{label}": f"reading_left_{label}",
            f"recorder_{label}[0]": f"recorder_forward_{label}",
            f"recorder_{label}[1]": f"recorder_left_{label}",
            **({} if lasts else {"duration": "recorder_duration"}),
        }
    return {own.get(name, name): value for name, value in known.items()}

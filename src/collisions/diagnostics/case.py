"""A case to diagnose: the result, the evidence given with it, other results to compare it with, and
number formatting.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from ..impact.choice import ModelChoice
from ..impact.impact import Impact, solve_changed
from ..impact.inputs import OUTSIDE
from ..impact.left_out import LeftOut
from ..impact.solvers import required_model
from ..impact.vehicle_result import VehicleResult
from ..kernels.contact_laws import BRACH, FRICTION, LAWS
from ..kernels.status import EPS
from ..quantities.directions import angle_of, from_degrees, from_radians
from ..quantities.formatting import decimals_of, in_words, places, rounded, scale_of, unit_of
from ..reconstruct import MomentumSolution
from ..vehicle.outlines import in_scene, overlap
from ..vehicle.tyres import Tyres
from ..vehicle.vehicle import Vehicle, with_name
from .moves import Moves, moves

# A computed ratio that equals its limit up to rounding has not passed it.
RATIO_ROUNDING = 1e-9
# How far the normal is turned, in degrees, to see what depends on it.
_TURN = 10.0
_ENERGY_FIGURES = 4


class Damage(NamedTuple):
    """The PDOF and delta-V shown by a vehicle's damage, independent of the result, with a direction
    if given as a pair.
    """

    pdof: float | None
    delta_v: float | None
    direction: float | None


class VehicleFigures(NamedTuple):
    """The quantities that every result has for a vehicle, and its name in a sentence; mass and
    speed are those before. ``delta_v_from`` is where its delta-V comes from, clockwise from its
    heading: the PDOF, but for what else than the contact acts on it. ``mass_has_unit`` and
    ``speed_has_unit`` say whether they were given with one.
    """

    who: str
    mass: float
    speed: float
    delta_v: float
    delta_v_from: float | None
    pdof: float | None
    heading: float | None
    mass_has_unit: bool
    speed_has_unit: bool


@dataclass(frozen=True, kw_only=True, eq=False)
class _Case:
    """One result to examine, with the evidence given with it, and the tyres by vehicle label that
    count in place of the drag; sentences are in ``units``.
    """

    damage: dict[str, Damage]
    crush_energy: float | None
    duration: float
    drag: float
    tyres: Mapping[str, Tyres] = field(default_factory=dict)
    units: str

    def number(self, value: float, kind: str) -> str:
        """A number in these units, to the decimals of its kind; an energy to four figures."""
        scale, decimals, _ = _format(kind, self.units)
        scaled = value * scale
        if not math.isfinite(scaled):
            return in_words(scaled)
        return rounded(scaled, places(scaled, _ENERGY_FIGURES) if decimals is None else decimals)

    def text(self, value: float, kind: str) -> str:
        """The number with its unit."""
        return (
            f"{self.number(value, kind)} {_format(kind, self.units)[2]}"
            if math.isfinite(value)
            else in_words(value)
        )


def _speed_has_unit(vehicle: Vehicle) -> bool:
    """Whether its speed, or every component but 0, was given with a unit."""
    given: Mapping[str, Any] = vehicle.given or {}
    parts = {"vx": vehicle.vx, "vy": vehicle.vy}
    return "speed" in given or all(name in given or not value for name, value in parts.items())


@cache
def _format(kind: str, units: str) -> tuple[float, int | None, str]:
    """Scale, decimals and unit of a kind; angles get one decimal more than in a result, because
    they stand next to a limit.
    """
    decimals = decimals_of(kind, units)
    more = int(kind == "angle")
    unit = unit_of(kind, units).replace("deg", "degrees").replace("*", " ")
    return scale_of(kind, units), None if decimals is None else decimals + more, unit


@dataclass(frozen=True, kw_only=True, eq=False)
class MomentumCase(_Case):
    """A reconstruction by planar momentum, which knows courses and speeds but no contact."""

    answer: MomentumSolution

    def was_found(self, label: str, name: str) -> bool:
        """Whether a speed before was not given, but found."""
        return f"{name}_{label}" in self.answer.found

    @cached_property
    def vehicles(self) -> dict[str, VehicleFigures]:
        """Both vehicles by label."""
        names = ("mass", "speed", "delta_v", "pdof", "heading")
        return {
            label: VehicleFigures(
                who=f"vehicle {label.upper()}",
                delta_v_from=self._delta_v_from(label),
                **{name: getattr(self.answer, f"{name}_{label}") for name in names},
                **{
                    f"{name}_has_unit": isinstance(
                        (self.answer.given or {}).get(f"{name}_{label}"), str
                    )
                    for name in ("mass", "speed")
                },
            )
            for label in "ab"
        }

    def _velocity(self, label: str, when: str = "") -> Any:
        """The velocity of a vehicle before, or "_after", along x and y; of one at rest 0."""
        speed = getattr(self.answer, f"speed_{label}{when}")
        course = getattr(self.answer, f"course_{label}{when}")
        return np.zeros(2) if course is None else speed * np.array(from_radians(course))

    def _delta_v_from(self, label: str) -> float | None:
        heading = getattr(self.answer, f"heading_{label}")
        if heading is None:
            return None
        x, y = self._velocity(label, "_after") - self._velocity(label)
        c, s = from_radians(heading)
        return float(angle_of(-(c * x + s * y), c * y - s * x))

    def work_on(self, label: str, impulse: tuple[float, float]) -> float:
        """Work of an impulse on a vehicle, at the mean of its velocities before and after [J]."""
        mean = 0.5 * (self._velocity(label) + self._velocity(label, "_after"))
        return float(mean @ np.array(impulse))

    @cached_property
    def from_outside(self) -> tuple[float, float]:
        """The momentum that both vehicles together gain [N*s]: of tyres and what else acts from
        outside.
        """
        x, y = (
            sum(
                getattr(self.answer, name) or 0.0
                for name in (
                    f"outside_impulse_{axis}",
                    *(f"tyre_impulse_{axis}_{of}" for of in "ab"),
                )
            )
            for axis in "xy"
        )
        return x, y


@dataclass(frozen=True, kw_only=True, eq=False)
class ImpactCase(_Case):
    """An impact with outlines by vehicle label, what an impulse leaves out, and the results it is
    compared with.
    """

    answer: Impact
    outlines: dict[str, Any]
    left_out: LeftOut | None
    # By label, of an impact of a scene, as they were given at the start of that.
    starts: Mapping[str, Vehicle] = field(default_factory=dict)

    def stated(self, label: str) -> Vehicle:
        """A vehicle as it was given: of an impact of a scene at the start of that."""
        return self.starts.get(label, getattr(self.answer, label).before)

    def was_found(self, label: str, name: str) -> bool:
        """Whether a part of the motion before was not given, but found, or followed from the start
        of a scene.
        """
        start, before = self.stated(label), getattr(self.answer, label).before
        as_given = math.isclose(getattr(start, name), getattr(before, name), rel_tol=1e-9)
        return f"{name}_{label}" in self.answer.found or not as_given

    @cached_property
    def vehicles(self) -> dict[str, VehicleFigures]:
        """Both vehicles by label."""
        return {
            label: VehicleFigures(
                who,
                side.before.mass,
                side.before.speed,
                side.delta_v,
                None
                if side.delta_v_forward is None or side.delta_v_left is None
                else angle_of(-side.delta_v_forward, side.delta_v_left),
                side.pdof,
                side.before.heading,
                mass_has_unit="mass" in (self.stated(label).given or {}),
                speed_has_unit=_speed_has_unit(self.stated(label))
                or isinstance((self.answer.inputs.given or {}).get(f"speed_{label}"), str),
            )
            for label, who, side in self.sides
        }

    @cached_property
    def from_outside(self) -> tuple[float, float]:
        """The momentum that both vehicles together gain [N*s]: of tyres, pivots and what else acts
        from outside.
        """
        sides = (self.answer.a, self.answer.b)
        return (
            sum(side.before.mass * side.delta_vx for side in sides),
            sum(side.before.mass * side.delta_vy for side in sides),
        )

    @cached_property
    def sides(self) -> list[tuple[str, str, VehicleResult]]:
        """Label, name in a sentence, and side of both vehicles."""
        sides = (("a", "vehicle A", self.answer.a), ("b", "vehicle B", self.answer.b))
        return [(label, with_name(who, side.before), side) for label, who, side in sides]

    @cached_property
    def overlaps(self) -> tuple[float, float, float] | None:
        """Overlap of the outlines at the impact and after the duration (below 0: a gap), and the
        rounding error of both.
        """
        if len(self.outlines) < 2:
            return None
        now, later = (
            overlap(
                *(
                    in_scene(self.outlines[label], side.after, label, time)
                    for label, _, side in self.sides
                )
            )
            for time in (0.0, self.duration)
        )
        return (
            now,
            later,
            sum(
                outline_off_by(self.outlines[label], side.after, self.duration)
                for label, _, side in self.sides
            ),
        )

    @cached_property
    def model_choice(self) -> tuple[ModelChoice, str]:
        """The errors of the central models, and the contact point assumed if none was given."""
        impact, inputs, a, b = (
            self.answer,
            self.answer.inputs,
            self.answer.a.before,
            self.answer.b.before,
        )
        point: Any = impact.point
        how = ""
        places: Any = (a.x, a.y, b.x, b.y)
        if point is None and None not in places:
            point = 0.5 * (places[0] + places[2]), 0.5 * (places[1] + places[3])
            how = ", with the contact point taken half-way between the centres"
        options: dict[str, Any] = {inputs.rule: inputs.rule_value, "law": inputs.law or BRACH}
        options |= {name: getattr(inputs, name) for name in ("incomplete", *OUTSIDE)}
        return required_model(
            a, b, impact.restitution, normal=impact.normal, point=point, **options
        ), how

    @cached_property
    def other_laws(self) -> list[tuple[str, Impact]]:
        """The results under every other law, each with a description."""
        impact = self.answer
        if impact.law is None or impact.model == "linear_central":
            return []
        by_friction = impact.inputs.rule == FRICTION
        others = [
            name
            for name, law in LAWS.items()
            if name != impact.law and (by_friction or not law.followed)
        ]
        return [
            (f"under the law {name!r} instead of {impact.law!r}", solve_changed(impact, law=name))
            for name in others
        ]

    @cached_property
    def moves(self) -> Moves:
        """What would move the answer, largest first."""
        return moves(self)

    @cached_property
    def turned_normals(self) -> list[tuple[str, Impact]]:
        """The results with the normal turned either way, each with a description."""
        if self.answer.inputs.model == "linear_central":
            return []
        nx, ny = self.answer.normal
        answers = []
        for angle in (-_TURN, _TURN):
            c, s = from_degrees(angle)
            how = (
                "with the normal turned by "
                f"{'+' if angle > 0.0 else ''}{self.text(math.radians(angle), 'angle')}"
            )
            answers.append(
                (how, solve_changed(self.answer, normal=(c * nx - s * ny, s * nx + c * ny)))
            )
        return answers


Case: TypeAlias = ImpactCase | MomentumCase


def plain(value: float) -> str:
    """A number without a unit, to three figures."""
    return f"{value:.3g}" if math.isfinite(value) else in_words(value)


def off_by(*sizes: float) -> float:
    """Rounding bound of a few sums and differences of numbers of these sizes: 16 eps of all of them
    together.
    """
    return 16.0 * EPS * sum(map(abs, sizes))


def outline_off_by(outline: Any, vehicle: Vehicle, after: float = 0.0) -> float:
    """Rounding bound of the placed corners; a heading is known to a relative eps."""
    x, y, heading = (getattr(vehicle, name) for name in ("x", "y", "heading"))
    turned = float(np.max(np.abs(outline))) * (1.0 + abs(heading) + abs(vehicle.yaw_rate * after))
    return off_by(x, y, vehicle.speed * after, turned)

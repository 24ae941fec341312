"""``MomentumSolution``: the result of planar momentum, courses and speeds before and after, and
their sensitivities.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ..impact.doubts import BACKWARDS, NEARLY_COLLINEAR, from_one_line, in_cases
from ..kernels.status import Status
from ..messages.errors import MissingInputError
from ..quantities.attribute_stubs import MomentumSolutionQuantities
from ..quantities.attributes import Shown, derived, equal
from ..quantities.settings import in_si
from ..quantities.tables import (
    Cells,
    Part,
    Sentences,
    Summary,
    all_numbers,
    as_sentence,
    outcomes,
    sided,
)
from ..quantities.units import Value, to_quantity
from ..vehicle.drag import USUAL_DURATION
from ..vehicle.tyres import Tyres
from .momentum_others import other_velocity, tyres_may_turn
from .momentum_tyres import (
    TURN_ROUND,
    neglected,
    other_course,
    what_is_sought,
    why_it_moves,
)
from .momentum_vector import NEARLY_CANCELLING

# The arguments that give attributes which may be None.
_NEEDED = {
    "pdof_a": "heading_a",
    "pdof_b": "heading_b",
    "closing_speed": "normal",
    "restitution": "normal",
    **{f"tyre_impulse_{axis}_{label}": f"tyres_{label}" for label in "ab" for axis in "xy"},
}
_WITH_OUTSIDE = (
    "the impulse from outside is that on both vehicles together: what part of it each took is not "
    "known, and is left in its PDOF, which is not the direction of the contact's force alone"
)
TYRES_HELD = (
    "how far an input moves an answer is worked out with the impulse of the tyres as it is; solved "
    "again with another input, that impulse changes too"
)
_SENSITIVITY_UNITS = {"mass": "kg", "speed": "(m/s)", "course": "deg", "outside": "(N*s)"}


class Sensitivity(dict[str, dict[str, Value]]):
    """Sensitivities by unknown speed, then by input: change per SI unit of the input; per degree
    through ``.q``.
    """

    @property
    def q(self) -> dict[str, dict[str, Any]]:
        """The same with units, per degree where the input is an angle."""
        return {
            answer: {name: self._quantity(answer, name, value) for name, value in row.items()}
            for answer, row in self.items()
        }

    def __eq__(self, other: object) -> bool:
        return equal(self, other) if isinstance(other, Mapping) else NotImplemented

    def __ne__(self, other: object) -> bool:
        return not self == other

    @staticmethod
    def _quantity(answer: str, name: str, value: Any) -> Any:
        kind, degree = name.partition("_")[0], math.pi / 180.0
        value = value * degree if kind == "course" else value
        if answer.startswith("course"):
            return to_quantity(value / degree, f"deg/{_SENSITIVITY_UNITS[kind]}")
        return to_quantity(value, f"m/s/{_SENSITIVITY_UNITS[kind]}")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class MomentumSolution(Shown):
    """The result of planar momentum: two vehicles before and after an impact, and how sensitive the
    speeds are.

    Speeds are along the courses: a computed speed below 0 is motion backwards along its course.
    Values are floats, or arrays in a batch.
    """

    mass_a: Value = field(metadata={"unit": "kg"})
    mass_b: Value = field(metadata={"unit": "kg"})
    course_a: Value | None = field(default=None, metadata={"unit": "rad"})
    course_b: Value | None = field(default=None, metadata={"unit": "rad"})
    course_a_after: Value | None = field(default=None, metadata={"unit": "rad"})
    course_b_after: Value | None = field(default=None, metadata={"unit": "rad"})
    speed_a: Value = field(metadata={"unit": "m/s"})
    speed_b: Value = field(metadata={"unit": "m/s"})
    speed_a_after: Value = field(metadata={"unit": "m/s"})
    speed_b_after: Value = field(metadata={"unit": "m/s"})
    delta_v_a: Value = field(metadata={"unit": "m/s"})
    delta_v_b: Value = field(metadata={"unit": "m/s"})
    pdof_a: Value | None = field(default=None, metadata={"unit": "rad"})
    pdof_b: Value | None = field(default=None, metadata={"unit": "rad"})
    closing_speed: Value | None = field(default=None, metadata={"unit": "m/s"})
    restitution: Value | None = field(default=None, metadata={"unit": ""})
    translational_energy_loss: Value = field(metadata={"unit": "J"})
    condition: Value = field(metadata={"unit": ""})
    sensitivity: Sensitivity = field()
    unknowns: tuple[str, ...] = field()
    status: Any = field()
    heading_a: Value | None = field(default=None, metadata={"unit": "rad"})
    heading_b: Value | None = field(default=None, metadata={"unit": "rad"})
    course_near: Value | None = field(default=None, metadata={"unit": "rad"})
    normal_angle: Value | None = field(default=None, metadata={"unit": "rad"})
    outside_impulse_x: Value | None = field(default=None, metadata={"unit": "N*s"})
    outside_impulse_y: Value | None = field(default=None, metadata={"unit": "N*s"})
    duration: Value | None = field(default=None, metadata={"unit": "s"})
    yaw_rate_a_after: Value | None = field(default=None, metadata={"unit": "rad/s"})
    yaw_rate_b_after: Value | None = field(default=None, metadata={"unit": "rad/s"})
    tyre_impulse_x_a: Value | None = field(default=None, metadata={"unit": "N*s"})
    tyre_impulse_y_a: Value | None = field(default=None, metadata={"unit": "N*s"})
    tyre_impulse_x_b: Value | None = field(default=None, metadata={"unit": "N*s"})
    tyre_impulse_y_b: Value | None = field(default=None, metadata={"unit": "N*s"})
    tyres_a: Tyres | None = field(default=None)
    tyres_b: Tyres | None = field(default=None)
    # The arguments as they were given, texts and numbers, from which one case can be solved again.
    given: Mapping[str, Any] | None = field(default=None)

    _title = "Planar momentum"

    if TYPE_CHECKING:

        @property
        def q(self) -> MomentumSolutionQuantities: ...

    def _missing(self, name: str) -> MissingInputError | None:
        if name not in _NEEDED:
            return None
        argument = _NEEDED[name]
        kind = argument.partition("_")[0]
        return MissingInputError(
            f"{name} needs a {kind}, which was not given; write `{argument}='30 deg'`",
            code=f"missing_{kind}",
            argument=argument,
        )

    def _summary(self, numbers: Cells) -> Summary:
        numbers.answered = np.less_equal(self.status, Status.ENERGY_GAIN)
        values = (row for row in self._values() if row[0] != "ok")
        degree, speeds = math.pi / 180.0, self.sensitivity
        courses = [name for name in next(iter(speeds.values()), ()) if name.startswith("course")]
        rows = [
            (
                _of_vehicle(name),
                *(
                    numbers.text(
                        # Of a course they are degrees per degree.
                        row[name] if of.startswith("course") else degree * row[name],
                        "°" if of.startswith("course") else "m/s",
                    )
                    for of, row in speeds.items()
                ),
            )
            for name in courses
        ]
        changes = Part(rows, "Change per degree of", tuple(map(_of_vehicle, speeds)))
        stated = [TYRES_HELD] if self.tyres and rows else []
        return Summary(
            self._title,
            [*sided(values, numbers), changes, all_numbers(self._rows())],
            [*outcomes(self.status), *map(as_sentence, (*stated, *self._stated_in(numbers.name)))],
        )

    @property
    def found(self) -> tuple[str, ...]:
        """Names of what was found, as opposed to what was given: those of ``unknowns``."""
        return self.unknowns

    @property
    def tyres(self) -> dict[str, Tyres]:
        """The tyres by vehicle, "a" and "b", of those that have some."""
        both = (("a", self.tyres_a), ("b", self.tyres_b))
        return {label: one for label, one in both if one is not None}

    @property
    def statements(self) -> tuple[str, ...]:
        """What has to be said beside the numbers: without tyres, or without those of one vehicle,
        by how much the speeds would differ if these wheels slid for 0.1 s, or the duration given,
        with a drag of 0.7; that a speed is backwards, that the courses are near one line, or that a
        second course fits; that an impulse from outside is part of a PDOF; with tyres, which other
        velocities fit too, or that others may and were not looked for.
        """
        return self._stated_in(None)

    def _stated_in(self, units: str | None) -> tuple[str, ...]:
        """The statements with their numbers in a system of units, by default that of the inputs."""
        with in_si():
            return self._stated_by(Sentences(self._texts(), units))

    def _stated_by(self, say: Sentences) -> tuple[str, ...]:
        found = neglected(self, float(USUAL_DURATION), 0.7, lambda value, kind: say(value, kind, 2))
        said = [] if found is None else [found.sentence]
        said += [*self._doubts(say), *self._pushed()]
        if self.tyres:
            other = other_velocity(self)
            if other is not None:
                said.append(other.sentence(self, say))
            elif self._may_have_others():
                said.append(self._not_looked_for())
        return tuple(said)

    def _doubts(self, say: Sentences) -> Iterator[str]:
        """That a speed is backwards along its course, that small errors move the answer far, and
        that a second course fits.
        """
        answered = np.less_equal(self.status, Status.ENERGY_GAIN)
        speeds = [name for name in self.unknowns if name.startswith("speed")]
        for name in speeds if what_is_sought(self) != "velocity" else ():
            backwards = answered & np.less(getattr(self, name), -BACKWARDS)
            yield from in_cases(backwards, f"{name} is below 0: {TURN_ROUND}")
        if len(speeds) == 2:
            one, other = (getattr(self, name.replace("speed", "course")) for name in speeds)
            moves = np.less(from_one_line(one, other), NEARLY_COLLINEAR)
        else:
            moves = np.greater(self.condition, NEARLY_CANCELLING)
        yield from in_cases(answered & moves, why_it_moves(self))
        yield from self._second_course(say)

    def _second_course(self, say: Sentences) -> Iterator[str]:
        """That a second course fits, of which ``course_near`` chose one."""
        if what_is_sought(self) != "beside":
            return
        answered = np.less_equal(self.status, Status.ENERGY_GAIN)
        speed, course = other_course(self)
        name, of = (_of_vehicle(one) for one in self.unknowns)
        # Backwards along its course it is none.
        fits = answered & np.greater_equal(speed, 0.0) & np.isfinite(course)
        two = f"two courses fit as the {of}, and course_near chose"
        if np.any(answered & np.less(getattr(self, self.unknowns[0]), 0.0)):
            two = f"with another course as the {of} none goes backwards"
        if np.ndim(fits) or self.tyres:
            yield from in_cases(fits, f"{two}; look at the other too")
        elif fits:
            angle = math.remainder(float(course), math.tau)
            yield (
                f"{two}; with the other, {say(angle, 'angle', 4)}, the {name} is "
                f"{say(float(speed), 'speed', 4)}"
            )

    def _pushed(self) -> tuple[str, ...]:
        """That an impulse from outside is part of a PDOF, in a sentence."""
        has_pdof = self.pdof_a is not None or self.pdof_b is not None
        return (_WITH_OUTSIDE,) if has_pdof and self.outside_impulse_x is not None else ()

    def _may_have_others(self) -> bool:
        """Whether another pair may fit, as small changes of the tyres' impulse move what was found
        far, or that impulse turns with it; looked for are others of one velocity sought alone.
        """
        ill = np.asarray(self.condition) > NEARLY_CANCELLING
        far = what_is_sought(self) != "velocity" and bool(np.any(ill))
        return far or tyres_may_turn(self)

    def _not_looked_for(self) -> str:
        one, other = self.unknowns
        why = "vehicle as slow" if tyres_may_turn(self) else "condition as large"
        return (
            f"{one} and {other} are those to which the balance without tyres leads; with a {why} "
            "as here another pair may fit with the tyres, which was not looked for, and other "
            "evidence has to tell"
        )

    def _texts(self) -> Iterable[Any]:
        texts = [value for value in (self.given or {}).values() if not isinstance(value, Tyres)]
        of_tyres = [text for one in self.tyres.values() for text in one.given.values()]
        return [*texts, *of_tyres] or Shown._texts(self)

    @derived()
    def ok(self) -> Any:
        """Whether the case has a solution without a gain of energy."""
        return self.status == Status.OK


def _of_vehicle(name: str) -> str:
    """A name in words: "course_a_after" is "course of A after"."""
    quantity, vehicle, *rest = name.split("_")
    return " ".join((quantity, "of", vehicle.upper(), *rest))

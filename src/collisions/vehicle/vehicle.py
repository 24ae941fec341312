"""Vehicle: one body at one instant, before, during or after an impact."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import FrozenInstanceError, dataclass, field, fields
from typing import Any, Never, cast

import numpy as np

from ..kernels.elementwise import FINITE, POSITIVE, not_about_pivot, select, turning_velocity
from ..messages.errors import InputError, MissingInputError
from ..messages.hints import hinted, no_argument
from ..messages.marked import type_of
from ..quantities.attribute_stubs import VehicleQuantities
from ..quantities.attributes import (
    Quantities,
    derived,
    equal,
    format_value,
    hypot,
    read_only,
    returns,
)
from ..quantities.directions import Angle, angle_of, direction
from ..quantities.reading import ArgumentReader, broadcast, widened
from ..quantities.refusals import must_be
from ..quantities.settings import in_si, units_required
from ..quantities.tables import (
    Cells,
    Part,
    Sentences,
    Summarized,
    Summary,
    all_numbers,
    label_of,
)
from ..quantities.units import Input, Pair, Texts, Value, rendered, shown, texts_of

_isfinite = math.isfinite
_ABSENT: Any = object()


class _AsGiven(Summarized):
    """Base that adds ``given``: the texts that the fields were given as."""

    __slots__ = ("given",)

    given: Texts | None
    """Texts of what was given with a unit, by field or "speed" and "course"; None if all numbers
    were plain floats.
    """


@dataclass(frozen=True, slots=True, kw_only=True, init=False, eq=False, repr=False)
class Vehicle(_AsGiven):
    """One body in the road plane at one instant: what it weighs, where it is and how it moves.

    It describes the state before an impact as well as the state after it, so that the result of one
    impact can be the start of the next. The scene axes x and y are right-handed as seen from above;
    angles are counter-clockwise from +x. Numbers without a unit are SI; a Quantity or a text such
    as ``"80 km/h"`` is converted once, here. Any argument may be an array (a batch): arrays are
    copied and locked, and the solver checks their values case by case.

    Parameters
    ----------
    mass : float, str, Quantity or array [kg]
        Mass, > 0; ``inf`` for a body that keeps its velocity whatever strikes it, such as a wall.
    vx, vy : float, str, Quantity or array [m/s]
        Velocity of the centre of mass.
    yaw_rate : float, str, Quantity or array [rad/s]
        Yaw rate, positive counter-clockwise.
    yaw_inertia : float, str, Quantity or array [kg*m**2], optional
        Yaw moment of inertia about the centre of mass, > 0; ``inf`` for a body that keeps its yaw
        rate.
    x, y : float, str, Quantity or array [m], optional
        Position of the centre of mass. It is never taken as 0 when it was not given.
    heading : float, str, Quantity or array [rad], optional
        Direction in which the vehicle points, which need not be the direction in which it moves.
    pivot : pair [m], optional
        Scene point about which the body can only turn. Its velocity is then the yaw rate times the
        arm: worked out where vx and vy are 0; otherwise they must agree with it to 1e-9.
    name : str, optional
        Name used in messages and tables.

    Raises
    ------
    InputError
        Some arguments cannot be used; the message names each of them.

    Examples
    --------
    >>> Vehicle(mass="1100 kg", vx="80 km/h", name="A")
    Vehicle(mass=1100 kg, vx=22.2222 m/s, name='A')
    """

    mass: Value = field(metadata={"unit": "kg", "domain": POSITIVE})
    vx: Value = field(metadata={"unit": "m/s", "domain": FINITE})
    vy: Value = field(metadata={"unit": "m/s", "domain": FINITE})
    yaw_rate: Value = field(metadata={"unit": "rad/s", "domain": FINITE})
    yaw_inertia: Value | None = field(metadata={"unit": "kg*m**2", "domain": POSITIVE})
    x: Value | None = field(metadata={"unit": "m", "domain": FINITE})
    y: Value | None = field(metadata={"unit": "m", "domain": FINITE})
    heading: Value | None = field(metadata={"unit": "rad", "domain": FINITE})
    pivot: tuple[Value, Value] | None = field(metadata={"unit": "m", "domain": FINITE})
    name: str = field()

    @hinted
    def __init__(
        self,
        *unnamed: Never,
        mass: Input,
        vx: Input = 0.0,
        vy: Input = 0.0,
        yaw_rate: Input = 0.0,
        yaw_inertia: Input | None = None,
        x: Input | None = None,
        y: Input | None = None,
        heading: Input | None = None,
        pivot: Pair | None = None,
        name: str = "",
        **unknown: Never,
    ) -> None:
        if unnamed:
            raise TypeError(
                f"Vehicle takes its arguments by name, as in mass={rendered(unnamed[0])}: "
                f"{', '.join(NAMES)}"
            )
        if unknown:
            raise no_argument("Vehicle", NAMES, unknown, _HINTS)
        if (
            type(mass) is type(vx) is type(vy) is type(yaw_rate) is float
            and mass > 0.0
            and _isfinite(vx + vy)
            and -20.0 < yaw_rate < 20.0
            and (yaw_inertia is None or (type(yaw_inertia) is float and yaw_inertia > 0.0))
            and (x is None or (type(x) is float and _isfinite(x)))
            and (y is None or (type(y) is float and _isfinite(y)))
            and (heading is None or (type(heading) is float and -6.0 < heading < 6.0))
            and pivot is None
            and type(name) is str
            and not units_required.get()
        ):
            # Valid plain floats need no reader.
            _fill(self, mass, vx, vy, yaw_rate, yaw_inertia, x, y, heading, None, name, None)
        else:
            _fill(
                self, *_read_fields(mass, vx, vy, yaw_rate, yaw_inertia, x, y, heading, pivot, name)
            )

    @classmethod
    def barrier(cls, **rest: Any) -> Vehicle:
        """A body that neither moves nor turns: a wall, a pillar, or anything else that does not
        give way.

        Parameters
        ----------
        **rest
            Fields of the vehicle beside mass and yaw inertia, such as ``name``, as for
            ``Vehicle``.

        Returns
        -------
        Vehicle
            Of infinite mass and yaw inertia.

        Examples
        --------
        >>> Vehicle.barrier()
        Vehicle(mass=inf kg, yaw_inertia=inf kg*m**2, name='barrier')
        """
        return cls(**{"mass": math.inf, "yaw_inertia": math.inf, "name": "barrier", **rest})

    @classmethod
    def from_speed(cls, *, speed: Input, course: Input, **rest: Any) -> Vehicle:
        """A vehicle from its speed [m/s] and course [rad], the direction in which it moves.

        A course in degrees is reduced exactly: 90 deg gives vx = 0, not 6e-17.

        Parameters
        ----------
        speed : float, str, Quantity or array [m/s]
            Speed of the centre of mass, >= 0.
        course : float, str, Quantity or array [rad]
            Direction in which it moves, counter-clockwise from the x axis of the scene.
        **rest
            The other fields, as for ``Vehicle``.

        Returns
        -------
        Vehicle
            With these components of velocity.

        Raises
        ------
        InputError
            Also if vx or vy is given as well.

        Examples
        --------
        >>> Vehicle.from_speed(speed="60 km/h", course="90 deg", mass=900)
        Vehicle(mass=900 kg, vy=16.6667 m/s)
        """
        if "vx" in rest or "vy" in rest:
            raise InputError(
                "give either speed and course or vx and vy, not both",
                code="speed_twice",
                argument="speed",
            )
        reader = ArgumentReader()
        magnitude = reader.number(speed, "m/s", "speed")
        if np.any(below := np.less(magnitude, 0.0)):
            given, cure = shown(speed), ""
            if np.size(magnitude) > 1:
                given = (
                    f"{np.min(magnitude, where=below, initial=0.0):g} m/s, below 0 in "
                    f"{np.sum(below)} of {np.size(below)} cases"
                )
                cure = ", or bound what is drawn, as by `Normal(mean, sd, truncate=(low, high))`"
            reader.refuse(
                InputError(
                    f"speed must be >= 0, got {given}; turn the course by 180 deg to go the "
                    f"other way{cure}",
                    code="negative_speed",
                    argument="speed",
                )
            )
        cx, cy = direction(reader, course, "course", (magnitude,))
        reader.close()
        broadcast({"speed": magnitude, "course": cx})
        with np.errstate(all="ignore"):
            vx, vy = magnitude * cx + 0.0, magnitude * cy + 0.0
        if units_required.get():
            cls(**rest)  # names what lacks a unit; the velocity has been converted
        with in_si():
            vehicle = cls(**{**rest, "vx": vx, "vy": vy})
        if getattr(vx, "dtype", None) == np.float32 and vehicle.pivot is None:
            # Where other fields are float64, so is the velocity.
            cx, cy = direction(
                ArgumentReader(("course",)), course, "course", numbers_of(vehicle).values()
            )
            (magnitude,) = widened((magnitude,), numbers_of(vehicle).values())
            with np.errstate(all="ignore"):
                _set_vx(vehicle, read_only(magnitude * cx + 0.0))
                _set_vy(vehicle, read_only(magnitude * cy + 0.0))
        if reader.texts or reader.texts.units:
            # Both, so that a record can hold them in place of vx and vy.
            bare: Any = (("speed", speed, "m/s"), ("course", course, "rad"))
            texts = {
                name: f"{float(value)!r} {unit}"
                for name, value, unit in bare
                if isinstance(value, (int, float))
            }
            _set_given(vehicle, Texts(vehicle.given, texts if reader.texts else None, reader.texts))
        return vehicle

    def replace(self, **changes: Any) -> Vehicle:
        """The vehicle with some fields changed; the velocity of a pinned vehicle is worked out
        again.

        Parameters
        ----------
        **changes
            Fields with their new values, as for ``Vehicle``.

        Returns
        -------
        Vehicle
            A new one; this one stays as it is.

        Examples
        --------
        >>> Vehicle(mass=900.0).replace(yaw_inertia=1200.0)
        Vehicle(mass=900 kg, yaw_inertia=1200 kg*m**2)
        """
        unknown = [name for name in changes if name not in NAMES]
        if unknown:
            raise TypeError(
                f"replace() takes the fields of a Vehicle ({', '.join(NAMES)}), got "
                f"{unknown[0]!r}; speed and course make a new one by Vehicle.from_speed"
            )
        numbers = {name: getattr(self, name) for name in NAMES}
        if self.pivot is not None and changes.get("pivot", self.pivot) is not None:
            numbers["vx"] = numbers["vy"] = 0.0
        vehicle = vehicle_of(numbers, changes)
        if self.given is not None:
            gone = {*changes, *(("speed", "course") if {"vx", "vy"} & changes.keys() else ())}
            texts = {name: text for name, text in self.given.items() if name not in gone}
            _set_given(vehicle, Texts(texts, vehicle.given, units=self.given.units))
        return vehicle

    @property
    def q(self) -> VehicleQuantities:
        """The same attributes as pint Quantities of the application registry."""
        return cast(VehicleQuantities, Quantities(self))

    @derived("m/s")
    def speed(self) -> Value:
        """Speed of the centre of mass [m/s]."""
        return hypot(self.vx, self.vy)

    @derived("rad")
    def course(self) -> Value:
        """Direction of motion of the centre of mass [rad], in (-pi, pi]; NaN at rest."""
        return angle_of(self.vx, self.vy)

    @derived("kg*m/s")
    def momentum(self) -> tuple[Value, Value]:
        """Momentum (x, y) [kg*m/s]; for an infinite mass 0 at rest, otherwise infinite."""
        return _product(self.mass, self.vx), _product(self.mass, self.vy)

    @derived("J")
    def kinetic_energy(self) -> Value:
        """Kinetic energy of translation and rotation [J]; for an infinite mass 0 at rest, otherwise
        infinite.

        Raises
        ------
        MissingInputError
            The body turns and its yaw inertia was not given.
        """
        vx, vy, yaw_rate = widened((self.vx, self.vy, self.yaw_rate), numbers_of(self).values())
        energy = _product(self.mass, 0.5 * (vx * vx + vy * vy))
        if without_turning(self.yaw_rate):
            return energy
        inertia = needed(self, "yaw_inertia", "kinetic_energy of a turning body")
        return energy + _product(inertia, 0.5 * (yaw_rate * yaw_rate))

    @returns("m")
    def point(
        self,
        *,
        forward: Input = _ABSENT,
        left: Input = _ABSENT,
        distance: Input = _ABSENT,
        angle: Input = _ABSENT,
    ) -> tuple[Value, Value]:
        """The scene point (x, y) [m] of a place on the vehicle, given as forward and left or as
        distance and angle.

        Parameters
        ----------
        forward, left : [m]
            Ahead of the centre of mass, and to the driver's left (negative: to the right). One that
            is not given is 0.
        distance, angle : [m], [rad]
            Given together: distance from the centre of mass, and angle from the heading,
            counter-clockwise.

        Returns
        -------
        tuple of two floats or arrays [m]
            x and y in the scene.

        Raises
        ------
        MissingInputError
            The vehicle has no position or no heading.

        Examples
        --------
        >>> Vehicle(mass=1100.0, x=10.0, y=5.0, heading=0.0).point(forward=2.0, left="-50 cm")
        (12.0, 4.5)
        """
        reader = ArgumentReader()
        polar = distance is not _ABSENT, angle is not _ABSENT
        if (any(polar) and not all(polar)) or all(polar) != (
            forward is _ABSENT and left is _ABSENT
        ):
            raise InputError(
                "give `forward=` and `left=`, or `distance=` and `angle=`",
                code="bad_point",
                argument="point",
            )
        x, y, heading = (needed(self, name, "point") for name in ("x", "y", "heading"))
        if all(polar):
            length = reader.number(distance, "m", "distance")
            c, s = direction(reader, angle, "angle", (length, x, y, heading))
            broadcast({"distance": length, "angle": c})
            with np.errstate(all="ignore"):
                ahead, aside = length * c, length * s
        else:
            ahead = 0.0 if forward is _ABSENT else reader.number(forward, "m", "forward")
            aside = 0.0 if left is _ABSENT else reader.number(left, "m", "left")
        reader.close()
        broadcast({"x": x, "y": y, "heading": heading, "forward": ahead, "left": aside})
        hx, hy = Angle(heading, False).beside((x, y, ahead, aside)).direction
        with np.errstate(all="ignore"):
            return x + (ahead * hx - aside * hy), y + (ahead * hy + aside * hx)

    @returns("m/s")
    def velocity_at(self, point: Pair) -> tuple[Value, Value]:
        """Velocity (x, y) [m/s] of the point of the body that lies at a scene point.

        Parameters
        ----------
        point : pair of float, str, Quantity or array [m]
            Scene point (x, y) on the vehicle.

        Returns
        -------
        tuple of two floats or arrays [m/s]
            Along x and y of the scene.

        Raises
        ------
        MissingInputError
            The body turns and its position was not given.

        Examples
        --------
        >>> Vehicle(mass=1100.0, vx=10.0, yaw_rate=0.5, x=0.0, y=0.0).velocity_at((2.0, 1.0))
        (9.5, 1.0)
        """
        reader = ArgumentReader()
        px, py = reader.pair(point, "m", "point")
        reader.close()
        own = {name: getattr(self, name) for name in ("vx", "vy", "yaw_rate", "x", "y")}
        kind = None
        if broadcast({"point[0]": px, "point[1]": py} | own) is not None:
            from ..quantities.precision import precision

            # Among float32 arrays, a plain number beyond their range would become infinite.
            kind = precision([px, py, *own.values()])
        numbers = (px, py, *own.values())
        px, py, vx, vy, yaw_rate, x, y = (
            v.astype(kind) if isinstance(v, np.ndarray) else v for v in numbers
        )
        with np.errstate(all="ignore"):
            turn_x, turn_y = turn_at(self, yaw_rate, px, py, "velocity_at", x, y)
            return vx + turn_x, vy + turn_y

    def _missing(self, name: str) -> MissingInputError | None:
        return None if name in ("pivot", "given") else error_of_missing(self, name, f".q.{name}")

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Vehicle):
            return NotImplemented
        return all(equal(getattr(self, name), getattr(other, name)) for name in NAMES)

    def __repr__(self) -> str:
        return f"Vehicle({', '.join(f'{name}={text}' for name, text in self._rows())})"

    def _summary(self, numbers: Cells) -> Summary:
        kept = {name: getattr(self, name) for name in ("mass", "speed", "course", *NAMES[3:9])}
        kept = {name: value for name, value in kept.items() if value is not None}
        if without_turning(self.yaw_rate):
            del kept["yaw_rate"]
        units = {"speed": "m/s", "course": "rad", **UNITS}
        rows = [
            (label_of(name), numbers.text(value, units[name], name)) for name, value in kept.items()
        ]
        return Summary(self.name or "Vehicle", [Part(rows), all_numbers(self._rows())])

    def _texts(self) -> Iterable[Any]:
        return texts_of(self.given)

    def _rows(self) -> Any:
        for f in fields(self):
            value = getattr(self, f.name)
            if value is None or (
                type(value) in (float, str) and value in (0.0, "") and f.name in _QUIET
            ):
                continue
            yield (
                f.name,
                repr(value) if f.name == "name" else format_value(value, f.metadata["unit"]),
            )


def _refuse_setting(vehicle: Vehicle, name: str, value: Any = None) -> None:
    raise FrozenInstanceError(
        f"a Vehicle is frozen: {name} cannot be set; write vehicle.replace({name}=...)"
    )


def _state(vehicle: Vehicle) -> dict[str, Any]:
    """What a pickle and a copy have."""
    return {name: getattr(vehicle, name) for name in (*NAMES, "given")}


def _set_state(vehicle: Vehicle, state: Mapping[str, Any]) -> None:
    for name, value in state.items():
        object.__setattr__(vehicle, name, read_only(value))


# Those that dataclass generates raise a TypeError for names that are not fields, because of the
# slots; and Python 3.11.2 puts its own in place of a state that the class itself has.
for _name, _function in (
    ("__setattr__", _refuse_setting),
    ("__delattr__", _refuse_setting),
    ("__getstate__", _state),
    ("__setstate__", _set_state),
):
    setattr(Vehicle, _name, _function)

NAMES = tuple(f.name for f in fields(Vehicle))
UNITS = {f.name: f.metadata["unit"] for f in fields(Vehicle) if f.metadata}
DOMAINS = {
    f.name: f.metadata["domain"]
    for f in fields(Vehicle)
    if "domain" in f.metadata and f.name != "pivot"
}
_QUIET = frozenset({"vx", "vy", "yaw_rate", "name"})
# Slot descriptors set a field of a frozen object at a third of the cost of object.__setattr__.
_SETTERS = [getattr(Vehicle, name).__set__ for name in (*NAMES, "given")]


(
    _set_mass,
    _set_vx,
    _set_vy,
    _set_yaw_rate,
    _set_yaw_inertia,
    _set_x,
    _set_y,
    _set_heading,
    *_set_rest,
) = _SETTERS
_set_pivot, _set_name, _set_given = _set_rest


def _fill(
    vehicle: Vehicle,
    mass: Any,
    vx: Any,
    vy: Any,
    yaw_rate: Any,
    yaw_inertia: Any,
    x: Any,
    y: Any,
    heading: Any,
    pivot: Any,
    name: Any,
    given: Any,
) -> None:
    """Set every field; written out, as this is most of what a Vehicle costs."""
    _set_mass(vehicle, mass)
    _set_vx(vehicle, vx)
    _set_vy(vehicle, vy)
    _set_yaw_rate(vehicle, yaw_rate)
    _set_yaw_inertia(vehicle, yaw_inertia)
    _set_x(vehicle, x)
    _set_y(vehicle, y)
    _set_heading(vehicle, heading)
    _set_pivot(vehicle, pivot)
    _set_name(vehicle, name)
    _set_given(vehicle, given)


def vehicle_of(
    numbers: dict[str, Any],
    changes: dict[str, Any] | None = None,
    given: Mapping[str, str] | None = None,
) -> Vehicle:
    """A vehicle from SI numbers that were checked before, without unit warnings, and some new
    values.
    """
    vehicle: Vehicle = object.__new__(Vehicle)
    trusted = numbers.keys() - (changes or {}).keys()
    trusted |= {"pivot[0]", "pivot[1]"} if "pivot" in trusted else set()
    _fill(vehicle, *_read_fields(**{**numbers, **(changes or {})}, trusted=trusted))
    if given is not None:
        _set_given(vehicle, Texts(given))
    return vehicle


def moved(
    vehicle: Vehicle, vx: Any, vy: Any, yaw_rate: Any, given: Mapping[str, str] | None = None
) -> Vehicle:
    """The same body in another motion, without validation: used for results."""
    if vehicle.pivot is not None:
        vx, vy = turning_velocity(
            yaw_rate, vehicle.x, vehicle.y, vehicle.pivot[0], vehicle.pivot[1]
        )
    if isinstance(vx, np.ndarray):
        read_only((vx, vy, yaw_rate))
        texts: Texts | None = Texts(given)
    else:
        texts = None if given is None else Texts(given)
    other: Vehicle = object.__new__(Vehicle)
    x, y, heading, pivot = vehicle.x, vehicle.y, vehicle.heading, vehicle.pivot
    _fill(
        other,
        vehicle.mass,
        vx,
        vy,
        yaw_rate,
        vehicle.yaw_inertia,
        x,
        y,
        heading,
        pivot,
        vehicle.name,
        texts,
    )
    return other


def with_given(vehicle: Vehicle, given: Mapping[str, str]) -> Vehicle:
    """The vehicle with other texts for its numbers."""
    other: Vehicle = object.__new__(Vehicle)
    _set_state(other, {**_state(vehicle), "given": Texts(given)})
    return other


def numbers_of(vehicle: Vehicle) -> dict[str, Value]:
    """Every number of the vehicle by name, the coordinates of a pivot included."""
    found: dict[str, Value] = {
        name: value for name in DOMAINS if (value := getattr(vehicle, name)) is not None
    }
    return found | {f"pivot[{i}]": part for i, part in enumerate(vehicle.pivot or ())}


def without_turning(yaw_rate: Any) -> bool:
    """Whether no body turns, so that neither position nor inertia is needed; NaN of a refused case
    is ignored.
    """
    return bool(np.all((yaw_rate == 0.0) | (yaw_rate != yaw_rate)))


def turn_at(
    vehicle: Vehicle, yaw_rate: Any, px: Any, py: Any, purpose: str, x: Any = None, y: Any = None
) -> tuple[Any, Any]:
    """The velocity at a scene point due to the yaw rate; ``x`` and ``y`` in place of the vehicle's
    own.
    """
    if without_turning(yaw_rate):
        return yaw_rate, yaw_rate
    x, y = (
        needed(vehicle, name, purpose) if value is None else value
        for name, value in (("x", x), ("y", y))
    )
    return turning_velocity(yaw_rate, px, py, x, y)


_BY_SPEED = (
    "write Vehicle.from_speed(speed='45 mph', course='0 deg', ...), or the velocity in scene "
    "axes as vx= and vy="
)
_HINTS = {
    **dict.fromkeys(("speed", "velocity", "v", "course", "direction"), _BY_SPEED),
    "weight": "write mass=, such as mass='3400 lb' for a vehicle that weighs 3400 lb",
}


def with_name(label: str, vehicle: Vehicle) -> str:
    """A label that ends in the letter of a vehicle, and the name of the vehicle if that says more;
    a name that is the letter of the other is said to be one.
    """
    name = " ".join(vehicle.name.split())
    if name.lower() in ("", label.rpartition(" ")[2].lower()):
        return label
    return f"{label} ({named(name)})"


def named(name: str) -> str:
    """A name beside the letter of its vehicle; one that is a letter is said to be a name."""
    return f"named {name}" if name.lower() in ("a", "b") else name


def needed(vehicle: Vehicle, name: str, purpose: str, label: str = "the vehicle") -> Any:
    """The value of an optional field, or a MissingInputError that names the purpose."""
    value = getattr(vehicle, name)
    if value is None:
        raise error_of_missing(vehicle, name, purpose, label)
    return value


def error_of_missing(
    vehicle: Vehicle, name: str, purpose: str, label: str = "the vehicle"
) -> MissingInputError:
    """The error for a vehicle without a field that is needed."""
    who = with_name(label, vehicle)
    example = {
        "yaw_inertia": "`yaw_inertia='1800 kg*m**2'`, or inf for a body that does not rotate",
        "x": "`x='2.5 m'` (the centre of mass at the moment of impact)",
        "y": "`y='0 m'` (the centre of mass at the moment of impact)",
        "heading": (
            "`heading='30 deg'` (where it points, counter-clockwise from +x, whatever way it moves)"
        ),
    }[name]
    code = {
        "yaw_inertia": "missing_inertia",
        "x": "missing_position",
        "y": "missing_position",
        "heading": "missing_heading",
    }[name]
    return MissingInputError(
        f"{who} has no {name}, which {purpose} needs; give {example}",
        code=code,
        argument=name,
        vehicle=label,
    )


def not_a_vehicle(label: str, given: Any) -> InputError:
    """The error for an argument that is not a Vehicle."""
    write = (
        "its .before or .after"
        if isinstance(getattr(given, "after", None), Vehicle)
        else "collisions.Vehicle(mass=...)"
    )
    return must_be(
        label, "a Vehicle", given, f"; write {write}", code="not_a_vehicle", got=type_of(given)
    )


def _product(weight: Value, motion: Value) -> Value:
    """Mass times motion, where an infinite mass at rest counts as 0."""
    with np.errstate(invalid="ignore"):
        product: Value = select(motion == 0.0, 0.0, weight * motion)
    return product


def _read_fields(
    mass: Any,
    vx: Any,
    vy: Any,
    yaw_rate: Any,
    yaw_inertia: Any,
    x: Any,
    y: Any,
    heading: Any,
    pivot: Any,
    name: Any,
    trusted: Any = (),
) -> tuple[Any, ...]:
    """Validate the fields: SI values, and the texts of those given with a unit; one error names all
    that cannot be used.
    """
    reader = ArgumentReader(trusted)
    read: dict[str, Any] = {}
    raw = (mass, vx, vy, yaw_rate, yaw_inertia, x, y, heading)
    for (label, domain), value in zip(DOMAINS.items(), raw, strict=True):
        if value is not None:
            value = reader.number(value, UNITS[label], label, domain)
        elif label == "mass":
            reader.refuse(
                MissingInputError(
                    "mass is missing; give it in kg, or inf for a barrier",
                    code="missing_mass",
                    argument="mass",
                )
            )
        elif label in ("vx", "vy", "yaw_rate"):
            reader.refuse(
                InputError(
                    f"{label} `|is None|is not given`; leave it out for 0",
                    code="not_a_number",
                    argument=label,
                )
            )
        read[label] = value
    if not isinstance(name, str):
        quotes = "`||; put it in quotes`" if isinstance(name, (int, float)) else ""
        reader.refuse(must_be("name", "a text", name, quotes, code="not_a_text", got=type_of(name)))
    pin = None if pivot is None else reader.pair(pivot, "m", "pivot")
    reader.close()
    broadcast(read if pin is None else {**read, "pivot[0]": pin[0], "pivot[1]": pin[1]})
    if pin is not None:
        mass, vx, vy, yaw_rate, yaw_inertia, x, y, _ = read.values()
        read["vx"], read["vy"] = _pinned_velocity(
            pin, mass, vx, vy, yaw_rate, yaw_inertia, x, y, reader.texts
        )
    return (*read.values(), pin, name, reader.texts)


def _pinned_velocity(
    pin: tuple[Any, Any],
    mass: Any,
    vx: Any,
    vy: Any,
    yaw_rate: Any,
    yaw_inertia: Any,
    x: Any,
    y: Any,
    texts: Texts,
) -> tuple[Any, Any]:
    """Velocity (vx, vy) of a pinned body: computed if not given, else compared; arrays are compared
    by the solver.
    """
    for label, value in (("mass", mass), ("yaw_inertia", yaw_inertia)):
        if isinstance(value, float) and math.isinf(value):
            raise InputError(
                f"{label} is inf and pivot is given; a pinned body turns, so give its {label}, "
                "or `|use Vehicle.barrier()|leave out the pivot`",
                code="pinned_infinite",
                argument=label,
            )
    for label, value in (("x", x), ("y", y)):
        if value is None:
            raise MissingInputError(
                (f"{label} is missing; a pivot needs the position of the centre of mass `(x, y)`"),
                code="missing_position",
                argument=label,
            )
    with np.errstate(all="ignore"):
        arrays = (value for value in (mass, yaw_inertia, vx, vy) if isinstance(value, np.ndarray))
        wanted_x, wanted_y = turning_velocity(*widened((yaw_rate, x, y, *pin), arrays))
        if all(isinstance(value, float) for value in (vx, vy, wanted_x, wanted_y)):
            if not math.isfinite(wanted_x + wanted_y):
                raise InputError(
                    "the velocity of this pinned body is too large for a float: check x, y, "
                    "pivot and yaw_rate",
                    code="out_of_range",
                    argument="yaw_rate",
                )
            if (vx != 0.0 or vy != 0.0) and not_about_pivot(vx, vy, yaw_rate, x, y, *pin):
                say = Sentences(texts_of(texts))
                written, turning = (
                    ", ".join(say(part, "speed", figures) for part in velocity)
                    for velocity, figures in (((vx, vy), 6), ((wanted_x, wanted_y), 10))
                )
                raise InputError(
                    f"vx, vy = ({written}) cannot be the velocity of a body that turns about its "
                    f"pivot: yaw rate times arm gives ({turning}); leave vx and vy out, or correct "
                    "yaw_rate",
                    code="pinned_velocity",
                    argument="vx",
                )
            return wanted_x, wanted_y
        # Single cases never come here, and the import of the package need not wait for it.
        from ..quantities.precision import precision

        # Both in the precision of the vehicle: a velocity that underflows in it counts as not
        # given.
        given = (part for part in (vx, vy) if isinstance(part, np.ndarray))
        kind = precision(
            value
            for value in (mass, yaw_inertia, yaw_rate, x, y, *pin, *given)
            if value is not None
        )
        vx, vy = (np.asarray(v, dtype=kind) for v in (vx, vy))
        resting = np.equal(vx, 0.0) & np.equal(vy, 0.0)
        moved = np.broadcast_arrays(
            np.where(resting, wanted_x, vx), np.where(resting, wanted_y, vy)
        )
    found: tuple[Any, Any] = read_only(tuple(part.astype(kind) for part in moved))
    return found

"""``VehicleResult``: what an impact was for one vehicle: states before and after, delta-V, PDOF,
impulses and work.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from ..kernels.elementwise import select
from ..kernels.status import Passed
from ..messages.errors import InputError, MissingInputError, Status
from ..quantities.attribute_stubs import VehicleResultQuantities
from ..quantities.attributes import (
    Frozen,
    Quantities,
    attributes,
    derived,
    format_value,
    hypot,
    math_or_numpy,
    returns,
    unit_of,
)
from ..quantities.directions import Angle, angle_of
from ..quantities.formatting import clock_hour
from ..quantities.reading import ArgumentReader, broadcast, widened
from ..quantities.tables import Cells, Part, Summarized, Summary, all_numbers
from ..quantities.units import Input, Pair, Texts, Value
from ..vehicle.vehicle import Vehicle, error_of_missing, moved, turn_at, with_name, without_turning
from .inputs import Inputs
from .recorded import Axes, read_axes, read_moment, read_place, recorded

if TYPE_CHECKING:
    from .choice import ModelChoice


class VehicleResult(Frozen, Summarized):
    """One vehicle's part in an impact: its states before, during and after, and what changed.

    ``delta_v`` is the change of velocity of the centre of mass. Directions are in scene axes, with
    angles counter-clockwise from +x, except for the PDOF. Values are floats, or arrays in a batch.
    """

    _inputs: Inputs
    _answer: Any
    _index: int
    _choice: ModelChoice | None
    _elsewhere = MappingProxyType({Vehicle: "before.{0} or after.{0} in its place"})

    def __init__(self, inputs: Inputs, raw: Any, index: int, choice: ModelChoice | None) -> None:
        # Not the Impact itself: a cycle would keep a batch in memory until the collector runs.
        found = self.__dict__
        found["_inputs"], found["_answer"], found["_index"], found["_choice"] = (
            inputs,
            raw,
            index,
            choice,
        )

    def _change(self) -> tuple[Value, Value, Value]:
        raw = self._answer
        if self._index:
            return raw.delta_vx_b, raw.delta_vy_b, raw.delta_yaw_rate_b
        return raw.delta_vx_a, raw.delta_vy_a, raw.delta_yaw_rate_a

    def _until_compressed(self) -> tuple[Value, Value, Value]:
        """The part of the change that has passed at the end of compression."""
        if isinstance(self._answer, Passed):
            return (
                self._passed("compression_vx"),
                self._passed("compression_vy"),
                self._passed("compression_yaw_rate"),
            )
        from .choice import until_compressed

        names = [f"delta_{name}_{'ab'[self._index]}" for name in ("vx", "vy", "yaw_rate")]
        dvx, dvy, dw = until_compressed(self._inputs, self._answer, self._choice, names)
        return dvx, dvy, dw

    @property
    def q(self) -> VehicleResultQuantities:
        """The same attributes as pint Quantities; one that needs a heading not given raises a
        MissingInputError.
        """
        return cast(VehicleResultQuantities, Quantities(self))

    @derived()
    def before(self) -> Vehicle:
        """The vehicle just before contact."""
        return self._inputs.b if self._index else self._inputs.a

    @derived()
    def after(self) -> Vehicle:
        """The vehicle just after separation, ready to be the start of the next impact."""
        # Not self.before: of one case, of which most callers read little else, it would be a tenth
        # of the time.
        before, (dvx, dvy, dw) = (self._inputs.b if self._index else self._inputs.a), self._change()
        if type(dvx) is float:
            return moved(
                before, before.vx + dvx, before.vy + dvy, before.yaw_rate + dw, self._units()
            )
        motion = _changed(before.vx, dvx), _changed(before.vy, dvy), _changed(before.yaw_rate, dw)
        return moved(before, *motion, self._units())

    def _units(self) -> Texts | None:
        """Those of the inputs, in which the results are shown."""
        inputs = self._inputs
        if inputs.a.given is inputs.b.given is inputs.given is None:
            return None
        texts = inputs.texts
        return Texts(units=texts) if texts else None

    @derived()
    def at_compression(self) -> Vehicle:
        """The vehicle at the end of compression, after the impulse P/(1+e) (u and w0 of eqs 12 to
        19 of the paper).

        Under the law "stronge" it is the vehicle after the impulse up to then, which is no fixed
        part of P. An incomplete impact ends before compression does; there it is the vehicle after
        the impact.
        """
        before, (dvx, dvy, dw) = self.before, self._until_compressed()
        return moved(before, before.vx + dvx, before.vy + dvy, before.yaw_rate + dw, self._units())

    @derived("m/s")
    def delta_v(self) -> Value:
        """Magnitude of the change of velocity [m/s]."""
        return hypot(self.delta_vx, self.delta_vy)

    @derived("m/s")
    def delta_vx(self) -> Value:
        """Change of velocity along scene x [m/s]."""
        return self._change()[0]

    @derived("m/s")
    def delta_vy(self) -> Value:
        """Change of velocity along scene y [m/s]."""
        return self._change()[1]

    @derived("m/s")
    def delta_v_forward(self) -> Value | None:
        """Change of velocity along the vehicle's own heading [m/s]; None without a heading."""
        return self._own_axes(self.delta_vx, self.delta_vy)[0]

    @derived("m/s")
    def delta_v_left(self) -> Value | None:
        """Change of velocity to the vehicle's own left [m/s]; None without a heading.

        Event data recorders count lateral delta-V as positive to the right: the opposite sign.
        """
        return self._own_axes(self.delta_vx, self.delta_vy)[1]

    @derived("rad/s")
    def delta_yaw_rate(self) -> Value:
        """Change of yaw rate [rad/s], counter-clockwise."""
        return self._change()[2]

    @derived("N*s")
    def impulse_x(self) -> Value:
        """Impulse of the contact on this vehicle along scene x [N*s]."""
        return self._impulse()[0]

    @derived("N*s")
    def impulse_y(self) -> Value:
        """Impulse of the contact on this vehicle along scene y [N*s]."""
        return self._impulse()[1]

    @derived("rad")
    def impulse_direction(self) -> Value:
        """Scene angle of the impulse on this vehicle [rad], counter-clockwise from +x; NaN without
        an impulse.
        """
        return angle_of(self.impulse_x, self.impulse_y)

    @derived("rad")
    def pdof(self) -> Value | None:
        """Principal direction of force [rad]: where the force comes from, seen from the vehicle.

        It is 0 from straight ahead and positive clockwise (from the right), in (-pi, pi]. Tools
        disagree on the sign. It is taken from the contact impulse, also for a pinned vehicle. None
        without a heading, NaN without an impulse.
        """
        forward, left = self._own_axes(self.impulse_x, self.impulse_y)
        if forward is None or left is None:
            return None
        return angle_of(-forward, left)

    @derived()
    def pdof_clock(self) -> Any:
        """The PDOF as the nearest hour of a clock face, 12 from straight ahead, 3 from the right;
        None without a heading.
        """
        pdof = self.pdof
        if pdof is None:
            return None
        if isinstance(pdof, np.ndarray):
            return (np.rint(pdof * (6.0 / math.pi)) - 1.0) % 12.0 + 1.0
        return pdof if math.isnan(pdof) else clock_hour(pdof)

    @derived("m")
    def moment_arm(self) -> Value | None:
        """Moment arm h of the resultant contact impulse about the centre of mass [m], positive if
        it turns counter-clockwise.

        The arm times the impulse is the moment. Of a contact that moves on meanwhile, as in
        ``time_resolved`` by default, it is the arm of the moment that came about; of a body that
        cannot turn, it is that at the point as given. NaN without an impulse; None without a
        contact point or a position.
        """
        impulse, inertia = (self.impulse_x, self.impulse_y), self.before.yaw_inertia
        at_point = self._arm(*impulse)
        moves = isinstance(self._answer, Passed) and self._inputs.geometry != "fixed"
        if not moves or at_point is None or inertia is None:
            return at_point
        # Of a batch some may be impulses, which take no time.
        took = self._answer.duration
        stays = math_or_numpy(inertia).isinf(inertia) | math_or_numpy(took).isnan(took)
        with np.errstate(all="ignore"):
            size = hypot(*impulse)
            moment = inertia * self.delta_yaw_rate - self.tyre_moment
            arm: Value = select(stays, at_point, moment / select(size == 0.0, math.nan, size))
        return arm

    @derived("m")
    def normal_arm(self) -> Value | None:
        """Moment arm of the normal impulse alone about the centre of mass [m], signed as
        ``moment_arm`` (r of eq 13); at the point and with the normal as given.
        """
        nx, ny = self._inputs.normal
        answered = 0.0 * self._answer.normal_impulse
        towards = 1.0 if self._index else -1.0
        return self._arm(towards * nx + answered, towards * ny + answered)

    @derived("")
    def gamma(self) -> Value | None:
        """Share of the mass that acts at the impulse, k^2/(k^2 + h^2), with k the radius of
        gyration and h ``moment_arm``.

        This is the mass reduction factor of the CRASH programs: 1 for an impulse through the centre
        of mass, or a body that cannot turn. None without ``moment_arm`` or yaw inertia.
        """
        h, inertia = self.moment_arm, self.before.yaw_inertia
        if h is None or inertia is None:
            return None
        central = (h == 0.0) | (math_or_numpy(inertia).isinf(inertia) & (h == h))
        with np.errstate(all="ignore"):
            found: Value = select(
                central, 1.0, 1.0 / (1.0 + (h * h) * (self.before.mass / inertia))
            )
        return found

    @derived("N*s")
    def tyre_impulse_x(self) -> Value:
        """Impulse of the tyres on this vehicle during a contact that lasts, along scene x [N*s];
        otherwise 0.
        """
        return self._passed("tyre_impulse_x")

    @derived("N*s")
    def tyre_impulse_y(self) -> Value:
        """Impulse of the tyres on this vehicle during a contact that lasts, along scene y [N*s];
        otherwise 0.
        """
        return self._passed("tyre_impulse_y")

    @derived("kg*m**2/s")
    def tyre_moment(self) -> Value:
        """Moment of the impulse of the tyres about the centre of mass [N*m*s], counter-clockwise;
        otherwise 0.
        """
        return self._passed("tyre_moment")

    @derived("J")
    def tyre_loss(self) -> Value:
        """Energy that the tyres of this vehicle dissipated during the contact [J]; not part of
        ``energy_loss``.
        """
        return self._passed("tyre_loss")

    @derived("J")
    def kinetic_energy_change(self) -> Value:
        """Kinetic energy after minus that before [J]: the work of the contact, of an impulse from
        outside, and of the tyres.

        It depends on the frame of reference and is not damage. After a contact that took time it is
        NaN if both bodies move with an infinite mass or turn with an infinite yaw inertia.
        """
        if isinstance(self._answer, Passed):
            return self._work() - self.tyre_loss
        ux, uy, dux, duy = self._at_contact(self._change())
        by_contact = self.impulse_x * (ux + 0.5 * dux) + self.impulse_y * (uy + 0.5 * duy)
        by_contact = by_contact if self._outside() is None else by_contact + self.outside_work
        return by_contact - self.tyre_loss if self._inputs.tyres else by_contact

    @derived("N*s")
    def outside_x(self) -> Value:
        """Impulse on this vehicle from outside, as given, along scene x [N*s]."""
        return self._from_outside(0)

    @derived("N*s")
    def outside_y(self) -> Value:
        """Impulse on this vehicle from outside, as given, along scene y [N*s]."""
        return self._from_outside(1)

    @derived("kg*m**2/s")
    def outside_yaw(self) -> Value:
        """Moment of the impulse from outside about the centre of mass, as given [N*m*s],
        counter-clockwise.
        """
        return self._from_outside(2)

    @derived("J")
    def outside_work(self) -> Value:
        """Work of the impulse from outside on this vehicle [J], at the mean of the velocities
        before and after.

        The kinetic energy of both vehicles before, plus this work on both, is their kinetic energy
        after plus ``energy_loss``. The work depends on the frame of reference.
        """
        before, (dvx, dvy, dw) = self.before, self._change()
        if self._outside() is None:
            return 0.0 * dvx + 0.0
        along = self.outside_x * (before.vx + 0.5 * dvx) + self.outside_y * (before.vy + 0.5 * dvy)
        return along + self.outside_yaw * (before.yaw_rate + 0.5 * dw)

    @derived("N*s")
    def pivot_impulse_x(self) -> Value:
        """Impulse of the pivot on this vehicle along scene x [N*s]; 0 for a body that is not
        pinned.
        """
        return self._pivot_impulse(self.delta_vx, self.impulse_x, 0)

    @derived("N*s")
    def pivot_impulse_y(self) -> Value:
        """Impulse of the pivot on this vehicle along scene y [N*s]; 0 for a body that is not
        pinned.
        """
        return self._pivot_impulse(self.delta_vy, self.impulse_y, 1)

    @returns("m/s")
    def delta_v_at(self, point: Pair) -> tuple[Value, Value]:
        """Change of velocity (x, y) [m/s] of the point of the vehicle that lies at a scene point.

        It is what an accelerometer there would have recorded in an instant, not the delta-V of the
        centre of mass. While a contact lasts its axes turn, too: see ``recorded``.

        Parameters
        ----------
        point : pair of float, str, Quantity or array [m]
            Scene point (x, y) on the vehicle.

        Returns
        -------
        tuple of two floats or arrays [m/s]
            Along x and y of the scene.
        """
        reader = ArgumentReader()
        px, py = reader.pair(point, "m", "point")
        reader.close()
        broadcast({"point[0]": px, "point[1]": py, "delta_vx": self.delta_vx})
        px, py, x, y = widened((px, py, self.before.x, self.before.y), (self.delta_vx,))
        with np.errstate(all="ignore"):
            turn_x, turn_y = turn_at(self.before, self.delta_yaw_rate, px, py, "delta_v_at", x, y)
            return self.delta_vx + turn_x, self.delta_vy + turn_y

    @returns("m/s")
    def recorded(
        self, time: Any, *, forward: Input = 0.0, left: Input = 0.0, axes: Axes = "turning"
    ) -> tuple[Any, Any]:
        """What an event data recorder in the vehicle shows while the contact lasts: delta-V forward
        and to the left, up to these times.

        A recorder sums up the acceleration of its own place in the axes of the car, which turn with
        it: it reads more or less than the centre of mass gains, by the turn and by the place (A.
        Marine and S. Werner, SAE 980219, 1998). The contact is that of ``time_resolved``, force and
        tyres as there; the recorder has no error and no filter. So the samples of a curve can be
        evidence for ``reconstruct.posterior``. The heading given is that of the positions: at
        maximum engagement, or at first contact where ``geometry="first_contact"``. Each case is
        followed once more.

        Parameters
        ----------
        time : float, str, Quantity or array [s]
            Times after first contact, one or a row of them; of a batch also an array with the cases
            in the further axes, if every case has its own. Before the contact the reading is 0, and
            after its end the last one: what tyres do then is not followed.
        forward, left : float, str, Quantity or array [m]
            Where the recorder sits: how far ahead of the centre of mass, and to its left.
        axes : {"turning", "fixed"}
            Whether the axes turn with the car, or are those of its heading as given.

        Returns
        -------
        forward, left : float or array [m/s]
            Times first, then cases. Recorders count lateral delta-V as positive to the right: the
            opposite sign.

        Raises
        ------
        InputError
            The impact was not followed in time, or the vehicle has no heading.

        Examples
        --------
        >>> import collisions as col
        >>> a = col.Vehicle(mass=1500, vx=15, yaw_inertia=2500, x=-2.1, y=0, heading=0)
        >>> b = col.Vehicle(mass=1250, vy=11, yaw_inertia=1900, x=0.9, y=-0.4, heading="90 deg")
        >>> impact = col.time_resolved(
        ...     a, b, 0.1, normal=0, point=(0, 0.3), friction=0.5, duration="100 ms"
        ... )
        >>> ahead, left = impact.a.recorded(["30 ms", "60 ms", "90 ms"], forward=0.5, left=0)
        >>> [round(3.6 * float(speed), 1) for speed in ahead]
        [-2.9, -11.0, -22.3]
        """
        if self._inputs.model != "time_resolved" or not isinstance(self._answer, Passed):
            raise InputError(
                f"{title_of(self)} has no curve over time: an impulse takes no time; solve the "
                "impact by time_resolved(..., duration='100 ms')",
                code="no_pulse",
            )
        if self.before.heading is None:
            raise error_of_missing(
                self.before, "heading", "what its recorder shows", "ab"[self._index]
            )
        reader = ArgumentReader()
        if isinstance(time, (list, tuple)):
            time = [read_moment(reader, one) for one in time]
        else:
            time = read_moment(reader, time)
        place = read_place(reader, (forward, left))
        axes = read_axes(reader, axes)
        reader.close()
        return recorded(self._inputs, self._answer, "ab"[self._index], time, place, axes)

    def _passed(self, name: str) -> Value:
        """What a time-resolved impact answers for this vehicle; 0 for an impulse."""
        value: Value = getattr(
            self._answer, f"{name}_{'ab'[self._index]}", 0.0 * self._answer.normal_impulse
        )
        return value

    def _work(self) -> Value:
        """Work of a contact that took time; of a body without a finite energy what the other one
        and the losses leave.
        """
        own, other = (
            self._gain(),
            VehicleResult(self._inputs, self._answer, 1 - self._index, self._choice)._gain(),
        )
        work: Value = select(own == own, own, -self._answer.energy_loss - other)
        return work

    def _gain(self) -> Any:
        """Change of kinetic energy by the contact, without what the tyres took; NaN where it is not
        finite.
        """
        before, (dvx, dvy, dw) = self.before, self._change()
        vx, vy, spin = widened((before.vx, before.vy, before.yaw_rate), (dvx,))
        inertia = math.inf if before.yaw_inertia is None else before.yaw_inertia
        moving = before.mass * (dvx * (vx + 0.5 * dvx) + dvy * (vy + 0.5 * dvy))
        turning = inertia * dw * (spin + 0.5 * dw)
        # An infinite mass at rest, and an infinite inertia that does not turn, gain nothing.
        stands = math_or_numpy(before.mass).isinf(before.mass) & (vx == 0.0) & (vy == 0.0)
        rests = math_or_numpy(inertia).isinf(inertia) & (spin == 0.0)
        return select(stands, 0.0, moving) + select(rests, 0.0, turning) + self.tyre_loss

    def _impulse(self) -> tuple[Value, Value]:
        x, y = self._answer.impulse_x, self._answer.impulse_y
        return (x, y) if self._index else (-x, -y)

    def _from_outside(self, part: int) -> Value:
        outside = self._outside()
        return 0.0 * self.impulse_x + 0.0 if outside is None else outside[part]

    def _outside(self) -> tuple[Value, ...] | None:
        return self._inputs.outside_b if self._index else self._inputs.outside_a

    def _at_contact(self, change: tuple[Value, Value, Value]) -> tuple[Value, Value, Value, Value]:
        """Velocity before, and that of this ``change``, of the contact point; in a central model of
        the centre of mass.
        """
        before, place = self.before, self._inputs.point
        dvx, dvy, dw = change
        motion = before.vx, before.vy, dvx, dvy
        # ``solve`` keeps the point it was given, also where it took a central model; cases that it
        # refused may lack a position.
        answered = self._answer.status <= Status.ENERGY_GAIN
        turns = True if self._choice is None else (self._choice.model == "eccentric") & answered
        if place is None or not np.any(turns):
            return motion
        own = before.vx, before.vy, before.yaw_rate, before.x, before.y
        ux, uy, yaw_rate, x, y, px, py = widened((*own, *place), (self.delta_vx,))
        with np.errstate(all="ignore"):
            turn_x, turn_y = turn_at(before, yaw_rate, px, py, "velocity_at", x, y)
            more_x, more_y = turn_at(before, dw, px, py, "velocity_at", x, y)
            there = ux + turn_x, uy + turn_y, dvx + more_x, dvy + more_y
        vx, vy, dvx, dvy = (
            select(turns, at_point, centre) for at_point, centre in zip(there, motion, strict=True)
        )
        return vx, vy, dvx, dvy

    def _arm(self, x: Value, y: Value) -> Value | None:
        """Arm of a vector through the contact point about the centre of mass, counter-clockwise."""
        place, before = self._inputs.point, self.before
        if place is None or before.x is None or before.y is None:
            return None
        px, py, cx, cy = widened((*place, before.x, before.y), (self.delta_vx,))
        size = hypot(x, y)
        with np.errstate(all="ignore"):
            size = select(size == 0.0, math.nan, size)
            arm: Value = (px - cx) * (y / size) - (py - cy) * (x / size)
        return arm

    def _own_axes(self, x: Value, y: Value) -> tuple[Value | None, Value | None]:
        if self.before.heading is None:
            return None, None
        c, s = Angle(self.before.heading, False).beside((x, y)).direction
        return c * x + s * y, c * y - s * x

    def _missing(self, name: str) -> MissingInputError | None:
        """The error for an attribute that is None, if a field of the vehicle is missing."""
        if name not in ("moment_arm", "normal_arm", "gamma"):
            return error_of_missing(self.before, "heading", name, "ab"[self._index])
        lacking = [
            field for field in ("x", "y", "yaw_inertia") if getattr(self.before, field) is None
        ]
        if self._inputs.point is None or not lacking:
            return None
        return error_of_missing(self.before, lacking[0], name, "ab"[self._index])

    def _pivot_impulse(self, dv: Value, impulse: Value, axis: int) -> Value:
        if self.before.pivot is None:
            return 0.0 * impulse + 0.0
        outside = self._outside()
        pushed = impulse if outside is None else impulse + outside[axis]
        if self._inputs.tyres:
            pushed = pushed + (self.tyre_impulse_y if axis else self.tyre_impulse_x)
        return self.before.mass * dv - pushed

    def __repr__(self) -> str:
        delta_v = format_value(self.delta_v, "m/s")
        return f"<{'ab'[self._index]}: delta_v={delta_v}, after={self.after!r}>"

    def _summary(self, numbers: Cells) -> Summary:
        numbers.answered = self._answer.status <= Status.ENERGY_GAIN
        return Summary(
            title_of(self), [*beside((self,), numbers), all_numbers(self._rows())], SIGNS
        )

    def _texts(self) -> Iterable[Any]:
        return self._inputs.texts

    def _rows(self) -> Any:
        for name in attributes(type(self)):
            value = getattr(self, name)
            if value is not None and not isinstance(value, Vehicle):
                yield name, format_value(value, vars(type(self))[name].unit)


SIGNS = (
    "Courses and yaw are counter-clockwise from the x axis.",
    "PDOF is where the force comes from: 0 from straight ahead, positive from the right.",
)
_STATE = {"speed": "speed", "course": "course", "yaw_rate": "yaw rate"}
_CHANGE = {"delta_v": "total", "delta_v_forward": "forward", "delta_v_left": "left", "pdof": "PDOF"}


def title_of(side: VehicleResult) -> str:
    """The letter of a vehicle, and its name if that says more."""
    return with_name("AB"[side._index], side.before)


def beside(sides: Sequence[VehicleResult], numbers: Cells) -> list[Part]:
    """The rows of a summary on one or both vehicles, each in a column of its own."""
    turning = any(
        not without_turning(state.yaw_rate) for side in sides for state in (side.before, side.after)
    )
    state = {name: label for name, label in _STATE.items() if turning or name != "yaw_rate"}

    def rows(
        text: Callable[[VehicleResult, str], str], labels: dict[str, str]
    ) -> list[tuple[str, ...]]:
        return [(label, *(text(side, name) for side in sides)) for name, label in labels.items()]

    columns = tuple(map(title_of, sides))
    # What is seen from a vehicle needs its heading: without any, rows of it would say nothing.
    pointing = any(side.before.heading is not None for side in sides)
    change = {name: label for name, label in _CHANGE.items() if pointing or name == "delta_v"}
    return [
        Part(
            rows(lambda side, name: _of_state(side.before, name, numbers), state), "Before", columns
        ),
        Part(
            rows(lambda side, name: _of_state(side.after, name, numbers), state), "After", columns
        ),
        Part(rows(lambda side, name: _of_change(side, name, numbers), change), "Delta-V", columns),
    ]


def _of_state(vehicle: Vehicle, name: str, numbers: Cells) -> str:
    value = getattr(vehicle, name)
    if isinstance(value, float) and math.isnan(value) and vehicle.speed == 0.0:
        return "at rest"
    return numbers.text(value, unit_of(Vehicle, name), name)


def _changed(value: Value, change: Value) -> Value:
    """The sum; where a change that is the same in all cases meets one number, it is that of all
    cases too.
    """
    if (
        isinstance(change, np.ndarray)
        and change.size
        and not any(change.strides)
        and not isinstance(value, np.ndarray)
    ):
        return np.broadcast_to(value + change.flat[0], change.shape)
    return value + change


def _of_change(side: VehicleResult, name: str, numbers: Cells) -> str:
    value = getattr(side, name)
    return (
        "no heading" if value is None else numbers.text(value, unit_of(VehicleResult, name), name)
    )

"""``simulate``: a vehicle on four wheels from separation to rest, so that places of rest are
evidence of its motion.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar, NamedTuple

import numpy as np

from ..kernels.elementwise import POSITIVE_FINITE, UNIT_INTERVAL
from ..kernels.run_out import Settings, ground_of
from ..kernels.tyre import wheel_forces
from ..messages.errors import InputError, NoSolutionError, ShapeError
from ..messages.hints import hinted
from ..quantities.attributes import Shown, hypot, in_units_of, read_only
from ..quantities.precision import precision
from ..quantities.reading import ArgumentReader, broadcast, is_whole
from ..quantities.settings import Default
from ..quantities.tables import Cells, Summary
from ..quantities.units import Input, Pair, Texts, shown, texts_of
from ..vehicle.drag import gravity_on, in_plan, one_value
from ..vehicle.tyres import LOCKS, Tyres, kernel_numbers, lifts, not_tyres, refuse_lifting
from ..vehicle.vehicle import NAMES, UNITS, Vehicle, needed, not_a_vehicle, vehicle_of
from .areas import Areas
from .corners import read_areas
from .motion import GOES_ON, IN_TIME, RESTS, ROWS, Motion, between, follow, went_on
from .surfaces import out_of_range, read_slope, settle

# Cases that are followed together: few calls of numpy, and memory that is kept small.
_BLOCK = 2048
_MOST_MOMENTS = 100_000
_MOTION = ("vx", "vy", "yaw_rate", "x", "y", "heading")
# A tyre that uses this share of the friction leaves a mark.
MARKS = 0.9
_TOLERANCE = Default(5e-7)
_FINEST, _COARSEST = 1e-10, 1e-2


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class SimulatedPath(Shown):
    """The motion of a vehicle from separation to rest, or for as long as it was followed, by
    ``simulate``; arrays are over moments, then over cases of a batch.

    Attributes
    ----------
    time : array [s]
        From separation to the last moment.
    x, y : array [m]
        Position of the centre of mass at these moments.
    heading : array [rad]
        Counted on through full turns.
    vx, vy : array [m/s]
        Velocity of the centre of mass at these moments.
    yaw_rate : array [rad/s]
        Positive counter-clockwise.
    marks : tuple of pairs of arrays [m]
        For each wheel (front left, front right, rear left, rear right), x and y of its track where
        the tyre slides and so leaves a mark, that is where it uses 90 % of the friction or more;
        NaN elsewhere.
    end : Vehicle
        The vehicle at the last moment: at rest, or at the time ``until``.
    """

    _title: ClassVar[str] = "Simulated path"

    time: Any = field(metadata={"unit": "s"})
    x: Any = field(metadata={"unit": "m"})
    y: Any = field(metadata={"unit": "m"})
    heading: Any = field(metadata={"unit": "rad"})
    vx: Any = field(metadata={"unit": "m/s"})
    vy: Any = field(metadata={"unit": "m/s"})
    yaw_rate: Any = field(metadata={"unit": "rad/s"})
    marks: tuple[tuple[Any, Any], ...] = field(metadata={"unit": "m"})
    end: Vehicle

    @property
    def rest(self) -> Vehicle:
        """The vehicle at rest; NaN in the cases of a batch that do not rest by ``until``.

        Raises
        ------
        NoSolutionError
            The vehicle was followed for a while, and did not come to rest.
        """
        end, moves = self.end, _moves(self.end)
        if not np.any(moves):
            return end
        if moves.ndim == 0:
            raise NoSolutionError(
                f"the vehicle did not come to rest within the {float(self.time[-1]):.6g} s for "
                f"which it was followed: it moves at {end.speed:.6g} m/s then. end has the vehicle "
                "at that time, and at(time) before; for a place of rest, leave until out or give a "
                "later one",
                code="never_stops",
            )
        still = {name: np.where(moves, np.nan, 0.0) for name in ("vx", "vy", "yaw_rate")}
        at_rest = {
            name: np.where(moves, np.nan, getattr(end, name)) for name in ("x", "y", "heading")
        }
        kept = {name: getattr(end, name) for name in NAMES}
        found = {name: part.astype(self.x.dtype) for name, part in (still | at_rest).items()}
        return vehicle_of(kept | found, given=Texts(units=self._texts()))

    def at(self, time: Input) -> Vehicle:
        """The vehicle at a time after separation; before it as at separation, later at rest.

        A case of a batch that still moves at the last moment is NaN after it.

        Parameters
        ----------
        time : float, str, Quantity or array [s]
            For a batch also one for each case. Between the moments, the motion is a polynomial with
            their places and velocities: give more ``moments`` for more digits.

        Returns
        -------
        Vehicle

        Raises
        ------
        InputError
            The time is after the last moment, and the vehicle is not at rest then.
        """
        reader = ArgumentReader()
        read = one_value(reader, time, "s", "time")
        reader.close()
        cases = self.time.shape[1:]
        if not cases and np.ndim(read):
            raise ShapeError(
                f"time is an array of shape {np.shape(read)}, and this motion is one case, at one "
                "time; its time, x, y and the like have all moments, or write "
                "`|[path.at(one) for one in times]|time as one number`",
                code="bad_shape",
                argument="time",
            )
        try:
            wanted = np.broadcast_to(np.asarray(read, float), cases)
        except ValueError:
            raise ShapeError(
                f"time has the shape {np.shape(read)}, and takes one value, or one for each "
                f"case: {cases}",
                code="bad_shape",
                argument="time",
            ) from None
        last, end = self.time[-1], self.end
        moves = _moves(end)
        lost = moves & (wanted > last)
        if lost.ndim == 0 and lost:
            raise InputError(
                f"time is {float(wanted):.6g} s, and the vehicle was followed for "
                f"{float(last):.6g} s and moves on then; give simulate a later until",
                code="out_of_range",
                argument="time",
            )
        with np.errstate(all="ignore"):
            before = np.clip(np.sum(self.time <= wanted, axis=0) - 1, 0, len(self.time) - 2)
            start = _at(self.time, before)
            width = _at(self.time, before + 1) - start
            part = np.clip((wanted - start) / np.where(width > 0.0, width, 1.0), 0.0, 1.0)
            state = {name: getattr(end, name) for name in NAMES}
            for place, rate in (("x", "vx"), ("y", "vy"), ("heading", "yaw_rate")):
                (p, q), (v, w) = (
                    [_at(getattr(self, name), before + i) for i in (0, 1)] for name in (place, rate)
                )
                rise = q - p
                v, w = width * v, width * w
                state[place] = p + part * (
                    v + part * (3.0 * rise - 2.0 * v - w + part * (v + w - 2.0 * rise))
                )
                rates = v + part * (
                    2.0 * (3.0 * rise - 2.0 * v - w) + part * 3.0 * (v + w - 2.0 * rise)
                )
                state[rate] = np.where(width > 0.0, rates / np.where(width > 0.0, width, 1.0), 0.0)
                at_rest = (wanted >= last) & ~moves
                state[rate] = np.where(at_rest, 0.0 * q, np.where(lost, np.nan, state[rate]))
                state[place] = np.where(at_rest, q, np.where(lost, np.nan, state[place]))
                if wanted.ndim == 0:
                    state[place], state[rate] = float(state[place]), float(state[rate])
                else:
                    state[place], state[rate] = (
                        state[name].astype(self.x.dtype) for name in (place, rate)
                    )
        return vehicle_of(state, given=Texts(units=self._texts()))

    def _summary(self, numbers: Cells) -> Summary:
        numbers.over_time = True
        return Shown._summary(self, numbers)

    def _values(self, prefix: str = "") -> Iterator[tuple[str, Any, str | None]]:
        # The marks are for drawing; the end is what is compared with the scene.
        yield from (row for row in Shown._values(self, prefix) if row[0] != "marks")
        label = "end" if np.any(_moves(self.end)) else "rest"
        yield from (
            (f"{label}.{name}", getattr(self.end, name), UNITS[name])
            for name in ("x", "y", "heading")
        )


def _moves(end: Vehicle) -> Any:
    """Whether a vehicle has not come to rest; NaN counts as rest."""
    rates = (np.abs(np.asarray(getattr(end, name))) for name in ("vx", "vy", "yaw_rate"))
    return sum(rates) > 0.0


def _at(values: Any, moment: Any) -> Any:
    """The values of each case at its own moment."""
    if values.ndim == 1:
        return values[moment]
    return np.take_along_axis(values, np.asarray(moment)[None], axis=0)[0]


@hinted
def simulate(
    vehicle: Vehicle,
    tyres: Tyres,
    *,
    surfaces: Sequence[tuple[Sequence[Pair], Input]] | None = None,
    slope: Pair = (0.0, 0.0),
    rotating_mass: Input = 0.0,
    until: Input | None = None,
    moments: int = 101,
    tolerance: float = _TOLERANCE,
) -> SimulatedPath:
    """The motion of a vehicle from separation to rest on four wheels, each with its own friction,
    braking and slip.

    The vehicle moves in the plane under the forces of its tyres, as ``Tyres`` has them: each from
    the slip of its own wheel, to which the yaw adds, and from the ground under it.

    Parameters
    ----------
    vehicle : Vehicle
        At separation, with yaw inertia, position and heading, and free to move. Arrays in it are
        many cases.
    tyres : Tyres
        Friction, braking and size; arrays in it are many cases.
    surfaces : sequence of (corners, friction), optional
        Areas with a different friction, each with 3 to 1000 corners [m] in order. The first that a
        wheel is in counts. An area may have dents; sides that cross are refused.
    slope : pair of float, str, Quantity or array [-]
        Rise over run of the ground along x and along y of the scene: (0.05, 0) if it rises by 5 %
        in the direction of x; from -100 to 100.
    rotating_mass : float, str, Quantity or array [-]
        What the rotation of the wheels adds to the mass that has to be slowed, as a fraction of it:
        four times the moment of inertia of a wheel, over the square of its radius and the mass.
        "3 %" is about that of a car with no gear engaged.
    until : float, str, Quantity or array, optional [s]
        Time after separation until which the motion is followed, > 0, where rest is not what is
        asked for: also of a vehicle that nothing slows. Without it, to rest.
    moments : int
        Number of moments in the arrays, 2 or more.
    tolerance : float [-]
        Error of one step of the integration in what the place of rest depends on: in velocity over
        that at separation, and in heading [rad]; from 1e-10 to 0.01.

    Returns
    -------
    SimulatedPath
        A case of a batch that cannot be answered is NaN.

    Raises
    ------
    InputError
        Naming every argument that cannot be used; a vehicle on a pivot.
    MissingInputError
        The vehicle has no yaw inertia, position or heading.
    NoSolutionError
        The vehicle does not come to rest and there is no ``until``: nothing slows it, as where no
        wheel is braked and it rolls on, or it does not stay on a slope where it stops, which
        ``until`` does not follow either. An infinite mass.

    Warns
    -----
    CollisionsWarning
        How many cases of a batch cannot be answered, and why.
    SuspectUnitsWarning
        A bare number that is probably in another unit.

    Notes
    -----
    That a braked wheel rolls until its brake can hold it, and that the side force has what the
    circle leaves, is what SMAC does (McHenry, SAE 730980), with Fiala's side force (VDI-Z. 96
    (1954) 973). The spin of a wheel, integrated, comes to the same forces. A wheel that turns is
    slowed and turned by the ground as well: with ``rotating_mass``, what that takes adds to the
    force of its brake, as fast as the motion of the wheel along itself changes, in which the
    turning of the vehicle counts. Without it, places of rest are too near by about the same
    fraction of the way. What brings a wheel to its spin that comes off ice, on which its brake had
    locked it, is left out: where all four do, the vehicle goes on too fast by ``rotating_mass``.

    The model holds for cars that stay on their wheels on an even ground: suspension, rollover,
    kerbs, furrowing in soft ground, other vehicles, driving forces, rolling resistance and air
    resistance are left out, and ``friction`` is the same at every speed. Load transfer is left out
    unless ``Tyres`` has a height; then it is that of a vehicle without suspension: with 0.55 m it
    moved the places of rest of 400 spun cars by 5 % of the way in the median, and by 14 % or more
    in one of ten. Near rest, a rolling tyre is stiffer sideways than in reality. On a slope,
    positions are in plan, and speeds and times along the ground, as in ``distance`` and ``time``:
    up and down it a place moves more slowly than the speed says, by the cosine of its angle (0.5 %
    at a rise of 10 %). Vehicles keep their size in plan, and headings are counted along the ground.

    The integration is of orders 5 and 4 with its own step for each case, in a time that slows down
    with the vehicle, in which the end of the motion is regular. Where the motion is straight, it
    goes on in closed form to its rest or to the next edge; where it keeps its direction on the
    vehicle, on level ground and away from edges of areas, along an arc to its rest, once what that
    leaves out is no more than the error of a step. Steps end at edges of areas. A wheel
    that nearly stands still has less than its full force, so that it is held without chatter: below
    s = 0.02 of the speed of the vehicle (of which the yaw rate times the distance of the wheels
    from the centre of mass is a part), its slip v counts as (s + v**2 / s) / 2, and across it acts
    at most the part of the friction that is its side slip over that side slip counted in the same
    way. At the default ``tolerance``, the place of rest is off by at most 1e-3 of the distance
    travelled, the heading by 1e-3 rad and the time by 1e-3 of it, mostly by a hundredth of that; at
    1e-5, in two thirds of the time, by at most a few thousandths and mostly by 1e-4. A scene on a
    knife's edge, whose rest a change of the speed by 1e-5 moves by 5e-4 of the way, may be off by
    more. Places of rest so scatter by some 1e-5 of the way from one scene to the next.

    Examples
    --------
    With all wheels locked, a straight skid is ``speed**2 / (2 g friction)`` long:

    >>> from collisions import Vehicle
    >>> from collisions.travel import Tyres, distance, simulate
    >>> car = Vehicle(mass="1500 kg", yaw_inertia="2400 kg*m**2", x=0, y=0, heading=0, vx="50 km/h")
    >>> skid = simulate(car, Tyres(0.7, 1, wheelbase="2.7 m", track="1.5 m"))
    >>> round(skid.rest.x, 3), round(distance("50 km/h", drag=0.7), 3)
    (14.05, 14.05)

    Spun by an impact, with the left front wheel jammed and the others nearly free:

    >>> jammed = Tyres(0.7, [1, 0.05, 0.05, 0.05], "2.7 m", "1.5 m")
    >>> spun = simulate(car.replace(yaw_rate="150 deg/s"), jammed)
    >>> print(f"{spun.rest.q.heading.to('deg'):.0f~P} at ({spun.rest.x:.1f}, {spun.rest.y:.1f}) m")
    170 deg at (25.1, 0.2) m
    """
    reader = ArgumentReader()
    areas = [
        (np.array(corners), mu)
        for corners, mu in ([] if surfaces is None else read_areas(reader, surfaces))
    ]
    rises = read_slope(reader, slope)
    rotating = one_value(reader, rotating_mass, "", "rotating_mass", UNIT_INTERVAL)
    ends = None if until is None else one_value(reader, until, "s", "until", POSITIVE_FINITE)
    if not is_whole(moments) or not 2 <= moments <= _MOST_MOMENTS:
        text = f"moments must be a whole number from 2 to {_MOST_MOMENTS}, got {shown(moments)}"
        reader.refuse(InputError(text, code="bad_option", argument="moments"))
    within = reader.number(tolerance, "", "tolerance", POSITIVE_FINITE)
    if not (isinstance(within, float) and (within != within or _FINEST <= within <= _COARSEST)):
        text = (
            f"tolerance must be one number from {_FINEST:g} to {_COARSEST:g}, got "
            f"{shown(tolerance)}"
        )
        reader.refuse(InputError(text, code="bad_option", argument="tolerance"))
    if not isinstance(vehicle, Vehicle):
        reader.refuse(not_a_vehicle("vehicle", vehicle))
    elif vehicle.pivot is not None:
        text = (
            "vehicle is on a pivot; simulate takes one that is free: write "
            "vehicle.replace(pivot=None)"
        )
        reader.refuse(InputError(text, code="pinned", argument="vehicle"))
    if not isinstance(tyres, Tyres):
        reader.refuse(not_tyres("tyres", tyres))
    reader.close()
    made = prepared(vehicle, tyres, areas, rises, within, rotating, ends)
    motion, units, shape = made.motion, made.units, made.shape
    with np.errstate(all="ignore"):
        count = motion.start.shape[1]
        blocks = [slice(i, i + _BLOCK) for i in range(0, count or 1, _BLOCK)]
        parts = [
            _way(motion.of(cases), units[:, cases], moments, made.until[cases]) for cases in blocks
        ]
        way, ended = (np.concatenate(part, axis=-1) for part in zip(*parts, strict=True))
    if shape is None:
        refuse_one(int(ended[0]), motion.settings.sloped)
        if not np.all(np.isfinite(way[:4])):
            raise out_of_range()
        found, still = way[..., 0], 0.0
    else:
        ended = ended.reshape(shape)
        answered = (ended == RESTS) | (ended == IN_TIME)
        checks = [
            *made.checks,
            ("never_stops", ended == GOES_ON),
            ("no_convergence", ~answered),
        ]
        kind = precision(made.named.values())
        with np.errstate(all="ignore"):
            checks += [
                ("out_of_range", ~np.isfinite(way[:4].astype(kind)).all(axis=(0, 1)).reshape(shape))
            ]
        # 0, or NaN where a case is refused.
        still = read_only(settle(np.zeros(shape), made.finite, shape, checks).astype(kind))
        with np.errstate(all="ignore"):
            found = (way.reshape(len(way), moments, *shape) + still).astype(kind)
    time, x, y, heading, vx, vy, yaw_rate, *tracks = read_only(tuple(found))
    last = {"x": x[-1], "y": y[-1], "heading": heading[-1]}
    last |= {"vx": vx[-1], "vy": vy[-1], "yaw_rate": yaw_rate[-1]}
    state = {name: getattr(vehicle, name) for name in NAMES}
    state |= {name: float(part) if shape is None else part for name, part in last.items()}
    marks = tuple(zip(tracks[::2], tracks[1::2], strict=True))
    texts = texts_of(vehicle.given)
    end = vehicle_of(state, given=Texts(units=texts))
    path = SimulatedPath(
        time=time,
        x=x,
        y=y,
        heading=heading,
        vx=vx,
        vy=vy,
        yaw_rate=yaw_rate,
        marks=marks,
        end=end,
    )
    return in_units_of(path, texts)


class Prepared(NamedTuple):
    """Cases that are ready to be followed: their motion, the units of each, shape, numbers by name,
    what a case of a batch is refused for, and the time of each, in units of the motion, until which
    it is followed.
    """

    motion: Motion
    units: Any
    shape: tuple[int, ...] | None
    named: dict[str, Any]
    checks: list[tuple[str, Any]]
    until: Any

    @property
    def finite(self) -> dict[str, Any]:
        """The numbers that have to be finite."""
        return {
            name: number
            for name, number in self.named.items()
            if name not in ("mass", "yaw_inertia")
        }


def prepared(
    vehicle: Vehicle,
    tyres: Tyres,
    areas: Sequence[tuple[Any, Any]],
    slope: tuple[Any, Any],
    tolerance: float,
    rotating: Any = 0.0,
    until: Any = None,
) -> Prepared:
    """What ``simulate`` follows, from arguments that were read; raises what it raises."""
    ground = {f"surfaces[{i}]": mu for i, (_, mu) in enumerate(areas)}
    rises = dict(zip(("slope[0]", "slope[1]"), slope, strict=True))
    if isinstance(vehicle.mass, float) and math.isinf(vehicle.mass):
        raise NoSolutionError(
            "the mass of the vehicle is infinite, which friction does not stop",
            code="infinite_mass",
        )
    body = {name: needed(vehicle, name, "simulate") for name in ("mass", "yaw_inertia", *_MOTION)}
    wheels = tyres.named
    named = body | wheels | ground | rises | {"rotating_mass": rotating}
    if until is not None:
        named["until"] = until
    for friction in ground.values():
        refuse_lifting(wheels, friction, texts_of(tyres.given))
    unknown = _brakes_unknown(wheels, bool(areas))
    if unknown is True:
        raise InputError(
            "friction of the tyres is 0, so that the brakes of lock between 0 and 1 hold nothing "
            "on any of the surfaces; give the friction of the common ground to Tyres, and what "
            "is slippery as surfaces",
            code="bad_friction",
            argument="tyres",
        )
    shape = broadcast(named)
    flat = {
        name: np.broadcast_to(np.asarray(value, float), shape or ()).ravel()
        for name, value in named.items()
    }
    settings = Settings(
        tyres.steered,
        tyres.transfers,
        any(bool(np.any(rise != 0.0)) for rise in rises.values()),
        bool(np.any(rotating != 0.0)),
    )
    with np.errstate(all="ignore"):
        motion, units = _prepared(flat, [corners for corners, _ in areas], settings, tolerance)
    checks: list[tuple[str, Any]] = []
    if shape is not None:
        positive = (
            body["mass"],
            body["yaw_inertia"],
            *(wheels[name] for name in ("wheelbase", "track", "cornering")),
            *(() if until is None else (until,)),
        )
        checks = [("not_positive", ~np.greater(number, 0.0)) for number in positive]
        checks += [("infinite_mass", np.isinf(body["mass"]))]
        checks += [
            ("bad_friction", np.less(mu, 0.0)) for mu in (wheels["friction"], *ground.values())
        ]
        checks += [("bad_friction", unknown)]
        checks += [("not_finite", bad) for bad in _not_finite({**wheels, **ground, **rises})]
        checks += [
            ("bad_fraction", np.less(wheels[name], 0.0) | np.greater(wheels[name], 1.0))
            for name in ("lock", *LOCKS)
            if name in wheels
        ]
        checks += [("negative_length", np.less(wheels.get("height", 0.0), 0.0))]
        checks += [
            ("wheel_lifts", lifts(wheels, mu)) for mu in (wheels["friction"], *ground.values())
        ]
    stop = np.full(motion.start.shape[1], math.inf) if until is None else flat["until"] / units[2]
    return Prepared(motion, units, shape, named, checks, stop)


# What may be infinite: how stiff a tyre is, and a friction that nothing overcomes.
_ENDLESS = ("cornering", "friction", "surfaces")


def _not_finite(numbers: Mapping[str, Any]) -> Iterator[Any]:
    """Where each of these numbers cannot be."""
    for name, number in numbers.items():
        may_be = name.startswith(_ENDLESS)
        yield np.isnan(number) if may_be else np.logical_not(np.isfinite(number))


def _brakes_unknown(wheels: Mapping[str, Any], areas: bool) -> Any:
    """Whether a friction of 0 leaves open what the brakes of partly locked wheels hold
    elsewhere.
    """
    if not areas:
        return False
    locks = [wheels[name] for name in ("lock", *LOCKS) if name in wheels]
    none = np.equal(wheels["friction"], 0.0)
    found = none & np.any(
        np.broadcast_arrays(*(np.greater(part, 0.0) & np.less(part, 1.0) for part in locks)), axis=0
    )
    return bool(found) if found.ndim == 0 else found


def _prepared(
    flat: dict[str, Any], corners: Sequence[Any], settings: Settings, tolerance: float
) -> tuple[Motion, Any]:
    """The motion of all cases, and the units of each: origin x and y, time, length, and distance of
    the wheels.
    """
    own = kernel_numbers(flat, np)
    reach = hypot(own.ahead, own.left)
    # Refused cases need not be followed.
    usable = (
        (flat["friction"] >= 0.0)
        & (reach > 0.0)
        & (flat["mass"] > 0.0)
        & (flat["yaw_inertia"] > 0.0)
    )
    for part in own.locks:
        usable = usable & (part >= 0.0) & (part <= 1.0)
    others = {n: one for n, one in flat.items() if n not in ("mass", "yaw_inertia", "until")}
    for bad in _not_finite(others):
        usable = usable & np.logical_not(bad)
    rates = [np.where(usable, flat[name], 0.0) for name in ("vx", "vy", "yaw_rate")]
    turn = rates[2] * reach
    # The largest first, so that squares neither overflow nor vanish.
    largest = np.maximum(np.maximum(np.abs(rates[0]), np.abs(rates[1])), np.abs(turn))
    scale = np.where(largest > 0.0, largest, 1.0)
    rates = [part / scale for part in (rates[0], rates[1], turn)]
    size = np.sqrt(rates[0] ** 2 + rates[1] ** 2 + rates[2] ** 2)
    size = np.where(size > 0.0, size, 1.0)
    speed = scale * size
    rises = flat["slope[0]"], flat["slope[1]"]
    # Along the ground everything is as on the level, with the gravity that presses on it.
    pressing = gravity_on(rises)
    time, length = speed / pressing, speed * (speed / pressing)
    here = [flat["friction"]] * 4
    lengths = [own.ahead / reach, own.left / reach, own.cos, own.sin, own.over_ahead, own.over_left]
    rest = [
        reach * (reach * (flat["mass"] / flat["yaw_inertia"])),
        length / reach,
        *rises,
        flat["rotating_mass"],
    ]
    ground = np.array(
        np.broadcast_arrays(*own.locks, own.friction, own.cornering, *lengths, *here, *rest)
    )
    start = np.array([*(part / size for part in rates), flat["heading"]])
    origin = np.array([flat["x"], flat["y"]])
    areas = None
    if corners:
        frictions = np.array([flat[f"surfaces[{i}]"] for i in range(len(corners))])
        ahead = np.multiply.outer([1.0, 1.0, -1.0, -1.0], own.ahead)
        left = np.multiply.outer([1.0, -1.0, 1.0, -1.0], own.left)
        sloped = np.array(rises) if settings.sloped else None
        areas = Areas(corners, frictions, flat["friction"], origin, length, ahead, left, sloped)
    return Motion(ground, start, areas, settings, tolerance), np.array(
        [*origin, time, length, reach]
    )


def _way(motion: Motion, units: Any, moments: int, until: Any) -> tuple[Any, Any]:
    """Time, place, motion and marks of some cases at their moments up to a time of each; and how
    each ended.
    """
    followed = follow(motion, until)
    found, ended = followed.by_case, followed.ended
    count = len(found)
    before, after = np.empty((2, ROWS, moments, count))
    time = np.empty((moments, count))
    for case, rows in enumerate(found):
        if not rows.shape[1]:
            rows = np.full((ROWS, 1), np.nan)
        stop = until[case]
        if ended[case] == GOES_ON and stop < math.inf and np.any(rows[4:7, -1]):
            rows, ended[case] = went_on(rows, stop, motion.ground[17, case]), IN_TIME
        elif stop < rows[0, -1] and ended[case] in (RESTS, GOES_ON):
            ended[case] = IN_TIME
        at = time[:, case] = _moments(np.minimum(rows[0], stop), moments)
        step = np.clip(np.searchsorted(rows[0], at, side="right"), 1, max(rows.shape[1] - 1, 1))
        before[:, :, case] = rows[:, np.minimum(step - 1, rows.shape[1] - 1)]
        after[:, :, case] = rows[:, np.minimum(step, rows.shape[1] - 1)]
    took = after[0] - before[0]
    share = np.clip((time - before[0]) / np.where(took > 0.0, took, 1.0), 0.0, 1.0)
    spin = motion.ground[17]
    (x, y, heading), (vx, vy, turning) = between(before, after, share, spin)
    stands = ended != IN_TIME
    for part in (vx, vy, turning):
        part[-1, stands] = 0.0
    for part, last in zip((x, y, heading), after[1:4, -1], strict=True):
        part[-1, stands] = last[stands]
    # At rest the vehicle stands, with the marks that it came with.
    moving = [
        np.concatenate([part[:-1], np.where(stands, part[-2:-1], part[-1:])])
        for part in (vx, vy, turning / spin)
    ]
    origin_x, origin_y, second, length, reach = units
    # All moments of all cases in one row.
    ground = ground_of(tuple(np.tile(motion.ground, moments)))
    c, s = np.cos(heading), np.sin(heading)
    here: tuple[Any, ...] = ground.here
    if motion.areas is not None:
        many = motion.areas.of(np.tile(np.arange(count), moments))
        px, py = many.wheels(x.ravel(), y.ravel(), heading.ravel())
        here = (many.friction_at(px, py),)
    speed = np.sqrt(moving[0] ** 2 + moving[1] ** 2 + moving[2] ** 2)
    ux, uy, turn = (part / np.where(speed > 0.0, speed, 1.0) for part in moving)
    steered, transfers, sloped, *_ = motion.settings
    ((along, across, _),) = wheel_forces(
        ground.tyres,
        here,
        *(part.ravel() for part in (c * ux + s * uy, c * uy - s * ux, turn)),
        steered=steered,
        transfers=transfers,
    )
    used = zip(along.reshape(4, moments, count), across.reshape(4, moments, count), strict=True)
    x, y = in_plan(motion.ground[18:20], x, y) if sloped else (x, y)
    x, y = origin_x + length * x, origin_y + length * y
    tracks = []
    for (along, across), (ahead, aside) in zip(used, _corners(motion.ground, reach), strict=True):
        slides = np.hypot(along, across) >= MARKS
        tracks += [
            np.where(slides, x + c * ahead - s * aside, np.nan),
            np.where(slides, y + s * ahead + c * aside, np.nan),
        ]
    rate = length / second
    return np.array(
        [second * time, x, y, heading, rate * vx, rate * vy, turning / second, *tracks]
    ), ended


def _moments(steps: Any, count: int) -> Any:
    """Moments from the first step to the last: half of them by time, half by steps, which are short
    where the motion bends. A car that nearly rolls bends in its first second and rolls for minutes.
    """
    last = steps[-1]
    if not last > 0.0:
        return np.linspace(0.0, 1.0, count) * last
    passed = 0.5 * steps / last + 0.5 * np.arange(len(steps)) / max(len(steps) - 1, 1)
    found = np.interp(np.linspace(0.0, 1.0, count), passed, steps)
    found[-1] = last
    return found


def _corners(ground: Any, reach: Any) -> list[tuple[Any, Any]]:
    """Where the wheels are on the vehicle [m]."""
    ahead, left = reach * ground[6], reach * ground[7]
    return [(ahead, left), (ahead, -left), (-ahead, left), (-ahead, -left)]


def refuse_one(ended: int, sloped: bool) -> None:
    """Raises if a single case did not come to rest."""
    if ended == GOES_ON:
        on_slope = (
            " or it does not stay where it stops on the slope, which is too steep for its brakes,"
            if sloped
            else ""
        )
        raise NoSolutionError(
            "the vehicle does not come to rest: nothing slows it, since friction or lock are 0 "
            f"(a wheel of lock 0 rolls on),{on_slope} or the wheels are not braked; give the "
            "lock that stopped it, or the resistance to rolling as a lock such as 0.02, or until, "
            "the time for which it is to be followed",
            code="never_stops",
        )
    if ended not in (RESTS, IN_TIME):
        raise NoSolutionError(
            "the motion of the vehicle cannot be followed to its end: it spins too fast, or "
            "hardly anything slows it",
            code="no_convergence",
        )

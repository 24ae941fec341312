"""``simulate``: a vehicle on four wheels from separation to rest, so that places of rest are
evidence of its motion.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from ..kernels.elementwise import POSITIVE_FINITE, UNIT_INTERVAL
from ..messages.errors import InputError, NoSolutionError, ShapeError
from ..messages.hints import hinted
from ..quantities.attributes import Shown, hypot, in_units_of
from ..quantities.attributes import lock as write_locked
from ..quantities.precision import precision
from ..quantities.reading import ArgumentReader, broadcast, is_whole
from ..quantities.tables import Cells, Summary
from ..quantities.units import Input, Pair, Texts, shown, texts_of
from ..vehicle.drag import one_value
from ..vehicle.vehicle import NAMES, UNITS, Vehicle, needed, not_a_vehicle, vehicle_of
from .motion import Wheels, integrate, size
from .run_out import read_friction
from .surfaces import out_of_range, settle

WHEELS = ("front left", "front right", "rear left", "rear right")
# Cases that are integrated together: few calls of numpy, and memory that is kept small.
_BLOCK = 512
_MOST_MOMENTS = 100_000
_LOCKS = tuple(f"lock[{i}]" for i in range(len(WHEELS)))
_MOTION = ("vx", "vy", "yaw_rate", "x", "y", "heading")
# A tyre that uses this share of the friction leaves a mark.
_MARKS = 0.9


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class SimulatedPath(Shown):
    """The motion of a vehicle from separation to rest, by ``simulate``; arrays are over moments,
    then over cases of a batch.

    Attributes
    ----------
    time : array [s]
        Equal steps from separation to rest.
    x, y : array [m]
        Position of the centre of mass at these moments.
    heading : array [rad]
        Counted on through full turns.
    marks : tuple of pairs of arrays [m]
        For each wheel (front left, front right, rear left, rear right), x and y of its track where
        the tyre slides and so leaves a mark, that is where it uses 90 % of the friction or more;
        NaN elsewhere.
    rest : Vehicle
        The vehicle at rest.
    """

    _title: ClassVar[str] = "Simulated path"

    time: Any = field(metadata={"unit": "s"})
    x: Any = field(metadata={"unit": "m"})
    y: Any = field(metadata={"unit": "m"})
    heading: Any = field(metadata={"unit": "rad"})
    marks: tuple[tuple[Any, Any], ...] = field(metadata={"unit": "m"})
    rest: Vehicle

    def _summary(self, numbers: Cells) -> Summary:
        numbers.over_time = True
        return Shown._summary(self, numbers)

    def _values(self, prefix: str = "") -> Iterator[tuple[str, Any, str | None]]:
        # The marks are for drawing; the end is what is compared with the scene.
        yield from (row for row in Shown._values(self, prefix) if row[0] != "marks")
        yield from (
            (f"rest.{name}", getattr(self.rest, name), UNITS[name])
            for name in ("x", "y", "heading")
        )


@hinted
def simulate(
    vehicle: Vehicle,
    *,
    friction: Input,
    lock: Input | Sequence[Input],
    wheelbase: Input = "2.7 m",
    track: Input = "1.5 m",
    steer: Input = 0.0,
    surfaces: Sequence[tuple[Sequence[Pair], Input]] | None = None,
    cornering: Input = 9.5,
    limit: Input = "30 s",
    moments: int = 101,
) -> SimulatedPath:
    """The motion of a vehicle from separation to rest on four wheels, each with its own friction,
    braking and slip.

    The vehicle moves in the plane under the forces of its tyres. Each wheel carries a quarter of
    the weight. The force of a tyre is within the friction ellipse: at most ``friction`` times its
    load across the wheel and ``lock`` times that along it; of the forces in the ellipse, it is the
    one that does the most work against the slip. ``path`` does the same, but here the yaw adds to
    the slip of each wheel. For a locked wheel, the ellipse is a circle: full friction against the
    slip. For a rolling wheel, the side force is limited by the slip angle a, after Fiala::

        z = min(1, cornering |tan(a)| / (3 friction));    force across <= friction * load * (1 - (1 - z)**3)

    Parameters
    ----------
    vehicle : Vehicle
        At separation, with yaw inertia, position and heading, and free to move. Arrays in it are
        many cases.
    friction : float, str, Quantity or array
        Friction of locked tyres on the ground, > 0.
    lock : float, str, Quantity or array, or a list of four
        Braking along the wheels as a fraction of that of locked wheels, from damage, brakes or an
        engaged gear: 0 if a wheel rolls freely, 1 if it is locked. One for all, or front left,
        front right, rear left, rear right.
    wheelbase, track : float, str, Quantity or array [m]
        Distances between the wheels. The centre of mass is midway.
    steer : float, str, Quantity or array [rad]
        Steer angle of both front wheels, positive to the left.
    surfaces : sequence of (corners, friction), optional
        Areas with a different friction, each with three or more corners [m] in order. The first
        that a wheel is in counts.
    cornering : float, str, Quantity or array
        Cornering stiffness of a tyre over its load, per radian.
    limit : float, str, Quantity or array [s]
        Time within which the vehicle must come to rest.
    moments : int
        Number of moments in the arrays, 2 or more.

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
        The vehicle is not at rest within ``limit``, for example because no wheel is braked and it
        rolls on.

    Warns
    -----
    CollisionsWarning
        How many cases of a batch cannot be answered, and why.
    SuspectUnitsWarning
        A bare friction above 1.5 or steer above a turn, which is probably in another unit.

    Notes
    -----
    Fiala's side force (VDI-Z. 96 (1954) 973) as a share of the friction is what SMAC uses (McHenry,
    SAE 730980), which has a friction circle and a given braking force; at partial braking, the
    force along the wheel is smaller here at large slip angles, as in the drag of ``path`` and of
    CRASH. The difference amounts to one of ``lock``, which is uncertain anyway. For ``cornering``,
    16 to 17 % of the load per degree, or 9.5 per radian, is typical of cars (m-smac, tire
    properties).

    The model holds for cars that stay on their wheels on level ground: load transfer, suspension,
    rollover, kerbs, furrowing in soft ground, other vehicles, driving forces and air resistance are
    left out, and ``friction`` is the same at every speed. Near rest, a rolling tyre is stiffer
    sideways than in reality.

    The integration is of orders 5 and 4 with its own step for each case, in a time that slows down
    with the vehicle, in which the end of the motion is regular; once the motion is down to 0.001 of
    the initial one, the rest is a straight line. So it ends at rest, without chatter. Only a wheel
    that nearly stands still, at 0.001 of the speed of the vehicle, has less than its full force. In
    all, the place of rest is off by at most 1e-3 of the distance travelled and the heading by 1e-3
    rad, mostly by a hundredth of that; places in between by 2 mm.

    Examples
    --------
    With all wheels locked, a straight skid is ``speed**2 / (2 g friction)`` long:

    >>> from collisions import Vehicle
    >>> from collisions.travel import distance, simulate
    >>> car = Vehicle(mass="1500 kg", yaw_inertia="2400 kg*m**2", x=0, y=0, heading=0, vx="50 km/h")
    >>> skid = simulate(car, friction=0.7, lock=1)
    >>> round(skid.rest.x, 3), round(distance("50 km/h", drag=0.7), 3)
    (14.05, 14.05)

    Spun by an impact, with the left front wheel jammed and the others nearly free:

    >>> spun = simulate(car.replace(yaw_rate="150 deg/s"), friction=0.7, lock=[1, 0.05, 0.05, 0.05])
    >>> print(f"{spun.rest.q.heading.to('deg'):.0f~P} at ({spun.rest.x:.1f}, {spun.rest.y:.1f}) m")
    171 deg at (26.1, 0.4) m
    """
    reader = ArgumentReader()
    ground = {"friction": read_friction(reader, friction, "friction")}
    areas = [] if surfaces is None else _read_surfaces(reader, surfaces)
    ground |= {f"surfaces[{i}]": mu for i, (_, mu) in enumerate(areas)}
    locks: Any = {"lock": lock}
    if isinstance(lock, (list, tuple)):
        locks = dict(zip(_LOCKS, lock, strict=False))
        if len(lock) != len(WHEELS):
            text = (
                f"lock is a list of {len(lock)}; give one value for all wheels, or four: "
                f"{', '.join(WHEELS)}"
            )
            reader.refuse(ShapeError(text, code="bad_shape", argument="lock"))
    numbers = {
        name: one_value(reader, value, "", name, UNIT_INTERVAL) for name, value in locks.items()
    }
    numbers["steer"] = one_value(reader, steer, "rad", "steer")
    sizes = {
        "wheelbase": (wheelbase, "m"),
        "track": (track, "m"),
        "cornering": (cornering, ""),
        "limit": (limit, "s"),
    }
    positive = {
        name: one_value(reader, value, unit, name, POSITIVE_FINITE)
        for name, (value, unit) in sizes.items()
    }
    if not is_whole(moments) or not 2 <= moments <= _MOST_MOMENTS:
        text = f"moments must be a whole number from 2 to {_MOST_MOMENTS}, got {shown(moments)}"
        reader.refuse(InputError(text, code="bad_option", argument="moments"))
    if not isinstance(vehicle, Vehicle):
        reader.refuse(not_a_vehicle("vehicle", vehicle))
    elif vehicle.pivot is not None:
        text = (
            "vehicle is on a pivot; simulate takes one that is free: write "
            "vehicle.replace(pivot=None)"
        )
        reader.refuse(InputError(text, code="pinned", argument="vehicle"))
    reader.close()
    if isinstance(vehicle.mass, float) and math.isinf(vehicle.mass):
        raise NoSolutionError(
            "the mass of the vehicle is infinite, which friction does not stop",
            code="infinite_mass",
        )
    body = {name: needed(vehicle, name, "simulate") for name in ("mass", "yaw_inertia", *_MOTION)}
    named = body | ground | numbers | positive
    shape = broadcast(named)
    flat = {
        name: np.broadcast_to(np.asarray(value, float), shape or ()).ravel()
        for name, value in named.items()
    }
    with np.errstate(all="ignore"):
        wheels, start = _prepared(flat, [corners for corners, _ in areas])
        blocks = [slice(i, i + _BLOCK) for i in range(0, start.shape[1] or 1, _BLOCK)]
        parts = [
            _way(wheels.of(cases), start[:, cases], flat["limit"][cases], moments)
            for cases in blocks
        ]
        way, ended = (np.concatenate(part, axis=-1) for part in zip(*parts, strict=True))
    if shape is None:
        _refuse_one(*map(float, (*ended[:, 0], flat["limit"][0])))
        found, still = way[..., 0], 0.0
    else:
        limits = flat["limit"].reshape(shape)
        checks = [
            ("not_positive", ~np.greater(number, 0.0))
            for number in (body["mass"], body["yaw_inertia"], *positive.values())
        ]
        checks += [("infinite_mass", np.isinf(body["mass"]))]
        checks += [("bad_friction", np.less(mu, 0.0)) for mu in ground.values()]
        time, speed = ended.reshape(2, *shape)
        checks += [
            ("out_of_range", ~np.isfinite(time)),
            ("never_stops", time >= limits),
            ("no_convergence", speed > 0.0),
        ]
        finite = {
            name: number for name, number in named.items() if name not in ("mass", "yaw_inertia")
        }
        # 0, or NaN where a case is refused.
        still = write_locked(
            settle(np.zeros(shape), finite, shape, checks).astype(precision(named.values()))
        )
        found = (way.reshape(len(way), moments, *shape) + still).astype(still.dtype)
    time, x, y, heading, *tracks = write_locked(tuple(found))
    end = {"x": x[-1], "y": y[-1], "heading": heading[-1]}
    state = {name: getattr(vehicle, name) for name in NAMES} | dict.fromkeys(
        ("vx", "vy", "yaw_rate"), still
    )
    state |= {name: float(part) if shape is None else part for name, part in end.items()}
    marks = tuple(zip(tracks[::2], tracks[1::2], strict=True))
    texts = texts_of(vehicle.given)
    rest = vehicle_of(state, given=Texts(units=texts))
    return in_units_of(
        SimulatedPath(time=time, x=x, y=y, heading=heading, marks=marks, rest=rest), texts
    )


def _prepared(flat: dict[str, Any], corners: Sequence[Any]) -> tuple[Wheels, Any]:
    """The wheels, and the state at separation, of all cases."""
    ahead = np.multiply.outer([0.5, 0.5, -0.5, -0.5], flat["wheelbase"])
    left = np.multiply.outer([0.5, -0.5, 0.5, -0.5], flat["track"])
    steer = np.multiply.outer([1.0, 1.0, 0.0, 0.0], flat["steer"])
    reach = hypot(ahead[0], left[0])
    wheels = Wheels(
        ahead=ahead,
        left=left,
        cos=np.cos(steer),
        sin=np.sin(steer),
        lock=np.array([flat[name] if name in flat else flat["lock"] for name in _LOCKS]),
        friction=flat["friction"],
        cornering=flat["cornering"],
        reach=reach,
        gyration=flat["mass"] / flat["yaw_inertia"],
        areas=[(area, flat[f"surfaces[{i}]"]) for i, area in enumerate(corners)],
    )
    rows = [
        flat["vx"],
        flat["vy"],
        flat["yaw_rate"] * reach,
        flat["x"],
        flat["y"],
        flat["heading"],
        0.0 * reach,
    ]
    start = np.array(rows)
    # Refused cases need not be followed.
    start[
        :3,
        ~((wheels.friction >= 0.0) & np.all((wheels.lock >= 0.0) & (wheels.lock <= 1.0), axis=0)),
    ] = 0.0
    return wheels, start


def _way(wheels: Wheels, start: Any, limit: Any, moments: int) -> tuple[Any, Any]:
    """Time, place, heading and marks of some cases at equal steps of time; and the time and speed
    at which each ended.
    """
    states, slopes = integrate(wheels, start, limit)
    at, cases = states[:, 6], np.arange(start.shape[1])
    time = np.linspace(0.0, 1.0, moments)[:, None] * at[-1]
    after = (
        np.array([np.searchsorted(at[:, i], time[:, i], side="right") for i in cases], dtype=int)
        .reshape(-1, moments)
        .T
    )
    # Steps beyond the first that ends there repeat it.
    after = np.minimum(after, np.argmax(at >= at[-1], axis=0))
    before = np.maximum(after - 1, 0)
    width = at[after, cases] - at[before, cases]
    share = ((time - at[before, cases]) / np.where(width > 0.0, width, 1.0))[..., None]
    (p, q), (u, v) = (
        [part[which, :6, cases] for which in (before, after)] for part in (states, slopes)
    )
    # The cubic with the values and slopes at both ends of the step.
    bend = (1.0 - 2.0 * share) * (q - p) + width[..., None] * ((share - 1.0) * u + share * v)
    vx, vy, turn, *place = np.moveaxis(
        (1.0 - share) * p + share * q + share * (share - 1.0) * bend, -1, 0
    )
    # At the last moment the vehicle stands, with the marks that it came with.
    motion = [np.concatenate([part[:-1], part[-2:-1]]).ravel() for part in (vx, vy, turn)]
    every = wheels.of(np.tile(cases, moments))
    speed, (x, y, heading) = size(motion), [part.ravel() for part in place]
    *_, used = every.forces(
        motion[0] / speed, motion[1] / speed, motion[2] / speed / every.reach, x, y, heading
    )
    tracks = np.where(
        used[:, None] >= _MARKS,
        np.stack(every.places(x, y, np.cos(heading), np.sin(heading)), axis=1),
        np.nan,
    )
    found = np.concatenate([np.stack([time, *place]), tracks.reshape(2 * len(WHEELS), *time.shape)])
    return found, np.stack([at[-1], size(states[-1])])


def _refuse_one(time: float, speed: float, limit: float) -> None:
    """Raises if a single case did not come to rest."""
    if not math.isfinite(time + speed):
        raise out_of_range()
    if time >= limit or speed > 0.0:
        raise NoSolutionError(
            f"the vehicle is not at rest after {min(time, limit):.6g} s: friction or lock slow "
            "it too little (a wheel of lock 0 rolls on), limit is too short, or it spins too "
            "fast to be followed",
            code="never_stops" if time >= limit else "no_convergence",
            speed=speed,
        )


def _read_surfaces(reader: ArgumentReader, surfaces: Any) -> list[tuple[Any, Any]]:
    """Corners as an array of (n, 2), and friction, of each area."""
    areas = []
    for i, area in enumerate(surfaces if isinstance(surfaces, (list, tuple)) else [surfaces]):
        corners = area[0] if isinstance(area, (list, tuple)) and len(area) == 2 else None
        if not isinstance(corners, (list, tuple)) or len(corners) < 3:
            text = (
                f"surfaces[{i}] must be a pair of corners, three or more (x, y) in a list, and "
                f"friction; got {shown(area)}"
            )
            reader.refuse(ShapeError(text, code="bad_shape", argument="surfaces"))
            continue
        places = [
            reader.pair(place, "m", f"surfaces[{i}][0][{j}]") for j, place in enumerate(corners)
        ]
        if any(isinstance(part, np.ndarray) for place in places for part in place):
            text = f"surfaces[{i}] has an array among its corners; they are the same for every case"
            reader.refuse(ShapeError(text, code="bad_shape", argument="surfaces"))
            continue
        areas.append((np.array(places), read_friction(reader, area[1], f"surfaces[{i}]")))
    return areas

"""``Run``: a scene that was followed: its impacts, times, tracks, places of rest and energy."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from types import MappingProxyType
from typing import Any, ClassVar

import numpy as np

from ..impact.impact import Impact
from ..messages.errors import (
    CollisionsError,
    CollisionsWarning,
    InputError,
    OutOfRangeWarning,
    ShapeError,
    Status,
)
from ..messages.warning import warn_of_cases
from ..quantities.attributes import Frozen, Quantities, Shown, derived, format_value, read_only
from ..quantities.reading import ArgumentReader
from ..quantities.tables import Cells, Part, Summarized, Summary, all_numbers, cells, given_texts
from ..quantities.units import Input, Texts, texts_of
from ..vehicle.drag import one_value
from ..vehicle.vehicle import NAMES, Vehicle, vehicle_of
from .came import Hit
from .follow import Followed
from .ledger import on_drag, on_slope, on_tyres
from .marks import WHEELS
from .motion import STATE, Ground, body_at, no_rest, why_no_rest
from .notices import Notice
from .scene import Scene

# Moments of a track between two contacts.
_MOMENTS = 101
# Gauss's rule over a step, from 0 to 1, for the work of the ground.
_NODES, _WEIGHTS = (
    0.5 * (1.0 + np.polynomial.legendre.leggauss(5)[0]),
    0.5 * np.polynomial.legendre.leggauss(5)[1],
)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Track(Shown):
    """The way of one vehicle through a scene, on the clock of all; of a batch over moments, then
    over cases.

    At each contact the clock has its time twice, before and after; one that is followed in time
    begins then, and passes in the moments that follow.

    Attributes
    ----------
    time : array [s]
        Equal steps between contacts.
    x, y : array [m]
        Position of the centre of mass at these moments.
    heading : array [rad]
        Counted on through full turns.
    vx, vy : array [m/s]
    yaw_rate : array [rad/s]
    marks : dict of pairs of arrays [m], optional
        By wheel ("front_left" and so on), x and y of its track where the tyre uses 90 % of the
        friction or more; NaN elsewhere. Empty without tyres, and of a batch. A mark that is shorter
        than a step of this clock may lie between two of its moments; ``plot.scene``, ``play`` and
        the results "begin" and "end" have every mark from where it begins to where it ends.
    """

    _title: ClassVar[str] = "Track"

    time: Any = field(metadata={"unit": "s"})
    x: Any = field(metadata={"unit": "m"})
    y: Any = field(metadata={"unit": "m"})
    heading: Any = field(metadata={"unit": "rad"})
    vx: Any = field(metadata={"unit": "m/s"})
    vy: Any = field(metadata={"unit": "m/s"})
    yaw_rate: Any = field(metadata={"unit": "rad/s"})
    marks: Any = field(metadata={"unit": "m"})

    def _values(self, prefix: str = "") -> Iterator[tuple[str, Any, str | None]]:
        yield from (row for row in Shown._values(self, prefix) if row[0] != f"{prefix}marks")


class Moved(Frozen, Summarized):
    """One vehicle of a run: its way and its place of rest."""

    name: str
    _run: Run

    def __init__(self, run: Run, name: str) -> None:
        vars(self).update(_run=run, name=name)

    @property
    def path(self) -> Track:
        """Its way through the scene."""
        track: Track = self._run.paths[self.name]
        return track

    @property
    def rest(self) -> Vehicle:
        """The vehicle at its place of rest."""
        return self._run._rest(self.name)

    @property
    def impacts(self) -> tuple[Impact, ...]:
        """Its impacts in order."""
        pairs = zip(self._run.impacts, self._run.pairs, strict=True)
        return tuple(impact for impact, pair in pairs if self.name in pair)

    @property
    def q(self) -> Any:
        """The same attributes as pint Quantities of the application registry."""
        return Quantities(self)

    def _summary(self, numbers: Cells) -> Summary:
        return self.rest._summary(numbers)


class Run(Frozen, Summarized):
    """A scene as it went, from the start to rest: the answer of ``Scene.run``.

    Of a batch, numbers are arrays over the cases, and ``status`` says of each case why it has no
    answer. Impacts are counted in order of time.
    """

    def __init__(self, scene: Scene, tolerance: float, *, to_rest: bool = True) -> None:
        ground = Ground(scene.surfaces, scene.slope, tolerance, scene.shape)
        # What cannot be answered is NaN, of which numpy need not warn.
        with np.errstate(all="ignore"):
            found = Followed(scene.movers, scene.contacts, ground, scene.order, to_rest=to_rest)
        vars(self).update(scene=scene, tolerance=tolerance, _followed=found)
        _warn_of(found, found.told.failed != "")
        _warn_of_notices(found)

    scene: Scene
    tolerance: float
    _followed: Followed
    _run_in_words: ClassVar[str] = "run"

    @derived()
    def impacts(self) -> tuple[Impact, ...]:
        """The impacts in order of time, with the names of the vehicles.

        Of a batch each is over all cases, NaN where there is none; where the order of the contacts
        differs between cases it is an error, and ``case`` has those of one.
        """
        found = self._followed
        if found.single:
            return tuple(hit.impact for hit in found.came.hits)
        self._refuse_orders()
        return tuple(self._whole(number) for number in range(self._most))

    @derived()
    def pairs(self) -> tuple[tuple[str, str], ...]:
        """The names of the two vehicles of each impact."""
        self._refuse_orders()
        longest = self._followed.came.longest
        contacts = self.scene.contacts
        return tuple((contacts[rule].a, contacts[rule].b) for rule in longest)

    @derived()
    def rules(self) -> tuple[int, ...]:
        """The contact of the scene that each impact is, by its place in the list."""
        self._refuse_orders()
        return tuple(self._followed.came.longest)

    @derived("s")
    def times(self) -> tuple[Any, ...]:
        """When each impact came [s]."""
        return tuple(self._time(number) for number in range(self._most))

    @derived()
    def status(self) -> Any:
        """The label "ok", or one that says why a case has no answer; of a batch an array."""
        found = self._followed
        if found.single:
            return "ok"
        codes = np.where(found.told.failed == "", "ok", found.told.failed).astype(str)
        return codes.reshape(self._shape)

    @derived()
    def findings(self) -> tuple[Notice, ...]:
        """What the scene does not describe, or limits its answer; of a single case. Numbers are in
        the units in which the vehicles were given.
        """
        return self._findings_in(None)

    def _findings_in(self, units: str | None) -> tuple[Notice, ...]:
        """The findings with their numbers in a system of units, for None that of the vehicles."""
        found = self._followed
        notices = found.told.notices_in(units)
        for hit in found.came.hits if found.single else ():
            contact, time = self.scene.contacts[hit.rule], float(hit.time[0])
            if hit.impact.status == Status.ENERGY_GAIN:
                text = (
                    f"the impact of {contact.a} and {contact.b} at {time:.3g} s ends with more "
                    "energy than it began with, which no impact does: the inputs do not go together"
                )
                notices.append(Notice("energy_gain", text, time, (contact.a, contact.b)))
            if bool(hit.deepest[0]):
                text = (
                    f"{contact.a} and {contact.b} part before the depth or delay of their contact "
                    f"is reached; the impulse acts at their deepest, at {time:.3g} s"
                )
                notices.append(Notice("at_deepest", text, time, (contact.a, contact.b)))
        return tuple(sorted(notices, key=lambda one: one.time))

    @derived()
    def deepest(self) -> tuple[Any, ...]:
        """Whether the vehicles of each impact parted before the depth or delay that was asked for,
        so that it acts at their deepest.
        """
        found = self._followed
        if found.single:
            return tuple(bool(hit.deepest[0]) for hit in found.came.hits)
        return tuple(self._deepest(number) for number in range(self._most))

    @derived()
    def paths(self) -> Mapping[str, Track]:
        """The way of each vehicle, by name, on one clock."""
        return MappingProxyType(_ByName({name: self._track(name) for name in self.scene.movers}))

    @derived()
    def rest(self) -> Rests:
        """Each vehicle at its place of rest, by name; an error for one that nothing slows."""
        return Rests(self)

    @derived("s")
    def end(self) -> Any:
        """When the last vehicle that comes to rest does [s]; without one, the time of the last
        impact.
        """
        found = self._followed
        ends = self._ends()
        return float(ends[0]) if found.single else ends.reshape(self._shape)

    @derived("J")
    def energy(self) -> Mapping[str, Any]:
        """Where the kinetic energy went [J]: "before", the sum at the start; "contacts", what each
        took, its tyres and what a slope adds to the motion meanwhile included; "ground", what
        tyres, drag and slope took, by their power along the way; and "left" at the end of the
        clock.
        """
        self._refuse_batch("energy")
        movers = self.scene.movers
        begins = [movers[name].vehicle.kinetic_energy for name in movers]
        lost = tuple(
            impact.energy_loss
            + math.fsum((_tyre_loss(impact.a), _tyre_loss(impact.b)))
            + math.fsum(self._pulled(name, impact) for name in pair)
            for impact, pair in zip(self.impacts, self.pairs, strict=True)
        )
        ends = self._ends()
        left = [
            self._body(name, self._followed.courses[name].at(ends, np.arange(1))) for name in movers
        ]
        return MappingProxyType(
            {
                "before": math.fsum(begins),
                "contacts": lost,
                "ground": math.fsum(self._ground_work(name) for name in movers),
                "left": math.fsum(body.kinetic_energy for body in left),
            }
        )

    @derived("kg*m/s")
    def momentum(self) -> tuple[Any, ...]:
        """The momentum (x, y) of both vehicles of each impact together, before and after
        [kg*m/s].
        """
        found = []
        for impact in self.impacts:
            before, after = (
                tuple(
                    one + other
                    for one, other in zip(
                        getattr(impact.a, when).momentum,
                        getattr(impact.b, when).momentum,
                        strict=True,
                    )
                )
                for when in ("before", "after")
            )
            found.append((before, after))
        return tuple(found)

    @property
    def q(self) -> Any:
        """The same attributes as pint Quantities of the application registry."""
        return Quantities(self)

    def at(self, time: Input) -> dict[str, Vehicle]:
        """All vehicles at a time; at that of a contact, after it.

        A contact followed in time is on its way then: it begins at its time, with the motion before
        it, and at time 0 with that of its maximum engagement.

        Parameters
        ----------
        time : float, str, Quantity or array [s]
            From the start; for a batch also one for each case, NaN where there is none, as in
            ``times``. Later than the end, vehicles that rest stay, and others go on.

        Returns
        -------
        dict of Vehicle
            By name.

        Raises
        ------
        InputError
            A time before the start or infinite, or times that are not one for each case.
        """
        reader = ArgumentReader()
        read = one_value(reader, time, "s", "time")
        if np.any(np.less(read, 0.0)):
            text = "time must be >= 0: a scene starts at 0"
            reader.refuse(InputError(text, code="negative_time", argument="time"))
        if isinstance(read, np.ndarray) and np.any(np.isinf(read)):
            text = "time must be finite in every case"
            reader.refuse(InputError(text, code="not_finite", argument="time"))
        reader.close()
        found = self._followed
        if found.single and isinstance(read, np.ndarray):
            raise InputError(
                "time is an array, and this run is one case; run.paths has all moments",
                code="bad_shape",
                argument="time",
            )
        if isinstance(read, np.ndarray) and read.shape not in ((), (1,), self._shape):
            raise ShapeError(
                f"time has the shape {read.shape}, and this batch has {found.count} cases; give "
                "one time, or one for each case",
                code="bad_shape",
                argument="time",
            )
        wanted = np.array(np.broadcast_to(read, self._shape), dtype=float).reshape(-1)
        unknown = np.where(np.isnan(wanted), np.nan, 0.0)
        every = np.arange(found.count)
        with np.errstate(all="ignore"):
            states = {name: course.at(wanted, every) for name, course in found.courses.items()}
        return _ByName({name: self._body(name, state + unknown) for name, state in states.items()})

    def case(self, index: int | tuple[int, ...]) -> Run:
        """One case of a batch as a single run.

        Parameters
        ----------
        index : int or tuple of int
            Which case, as an index into the arrays of the batch.

        Returns
        -------
        Run

        Raises
        ------
        CollisionsError
            There is no such case, or it has no answer.
        """
        from .names import case_of

        return Run(case_of(self.scene, index, "run"), self.tolerance)

    def to_dict(self) -> dict[str, Any]:
        """The scene and the results as nested plain values that strict JSON can hold; ``from_dict``
        runs the scene again.

        Returns
        -------
        dict
        """
        from .record import run_record

        return run_record(self)

    @classmethod
    def from_dict(cls, record: Mapping[str, Any]) -> Run:
        """The run of a ``to_dict`` record, run again from its scene: equal to the original.

        Parameters
        ----------
        record : dict
            What ``to_dict`` gave, also through JSON.

        Returns
        -------
        Run
        """
        from .record import run_of

        return run_of(record)

    def to_columns(self, *, units: str | None = None) -> dict[str, list[Any]]:
        """The results as flat columns with one value for each case, ready for
        ``pandas.DataFrame(...)``.

        Parameters
        ----------
        units : {"si", "metric", "us"}, optional
            Units of the numbers, which then appear in the names. By default SI, with plain names.

        Returns
        -------
        dict of list
            By path, as ``Scene.results`` lists them, without those of marks; and besides them the
            status of each impact: "ok", "energy_gain", or "" where there is none. Of a batch whose
            contacts come in several orders, "impacts[k]" and "times[k]" have the impact that most
            cases have there, with a warning, and NaN in the others; "contacts[i].impact" has the
            first impact of a contact in every case.
        """
        from .results import columns_of

        return columns_of(self, units)

    def __getitem__(self, name: str) -> Moved:
        if name not in self.scene.movers:
            raise _no_mover(name, self.scene.movers)
        return Moved(self, name)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Run):
            return NotImplemented
        return self.scene == other.scene and self.tolerance == other.tolerance

    def __reduce__(self) -> tuple[Any, ...]:
        return Run, (self.scene, self.tolerance)

    # Parts

    def _roll_out(self) -> None:
        """Work out all motions to their rest, so that what cannot be followed is refused."""
        self._followed.to_rest(self._followed.courses)
        with np.errstate(all="ignore"):
            for course in self._followed.courses.values():
                _ = course.rests
        answered = self._followed.told.failed == ""
        self._followed.gather()
        _warn_of(self._followed, answered & (self._followed.told.failed != ""))

    @property
    def _shape(self) -> tuple[int, ...]:
        return self._followed.ground.shape or ()

    @property
    def _most(self) -> int:
        return self._followed.came.most

    def _deepest(self, number: int) -> Any:
        """Whether one impact of every case of a batch acts at the deepest."""
        found = np.zeros(self._followed.count, dtype=bool)
        for hit, some in self._hits(number):
            found[hit.which[some]] = hit.deepest[some]
        return read_only(found)

    def _refuse_batch(self, what: str) -> None:
        if not self._followed.single:
            raise InputError(
                f"{what} is of one case; write run.case(0).{what} for the first of this batch",
                code="bad_shape",
                argument="index",
            )

    def _refuse_orders(self) -> None:
        """Refuse to put impacts of a batch together whose cases have other contacts in other
        orders.
        """
        found = self._followed
        if found.single:
            return
        if not found.came.same_order:
            raise InputError(
                "the contacts come in another order in some cases of the batch, so that an "
                "impact is not of the same vehicles in all; run.case(i).impacts has those of "
                "one case, and run.to_columns()['contacts[0].impact...'] the first impact of a "
                "contact in every case",
                code="several_orders",
                argument="index",
            )

    def _time(self, number: int) -> Any:
        found, times = self._followed, self._followed.came.times
        if found.single:
            return float(times[number, 0])
        many = times[number] if number < len(times) else np.full(found.count, np.nan)
        good = np.where(found.told.failed == "", many, np.nan)
        return read_only(good.reshape(self._shape))

    def _whole(self, number: int) -> Impact:
        """The impacts of one number over all cases, NaN where there is none."""
        from .results import whole_impact

        return whole_impact(self, number)

    def _hits(self, number: int) -> list[tuple[Hit, Any]]:
        """What has impacts of this number, and of which of its cases they are."""
        found = [(hit, hit.number == number) for hit in self._followed.came.hits]
        return [(hit, some) for hit, some in found if some.any()]

    def _ends(self) -> Any:
        found = self._followed
        times = [*found.came.times, *found.lasting.until.values()]
        last = np.fmax.reduce(times, axis=0, initial=0.0)
        found.to_rest(found.courses)
        rests = np.array([course.rests for course in found.courses.values()])
        return np.maximum(last, np.where(np.isfinite(rests), rests, 0.0).max(axis=0))

    def _body(self, name: str, state: Any) -> Vehicle:
        found = self._followed
        if found.single:
            return body_at(self.scene.movers[name], name, state, lambda v: v, single=True)
        unanswered = self._unanswered(name)
        body = self.scene.movers[name].vehicle
        numbers: dict[str, Any] = {one: getattr(body, one) for one in NAMES}
        for one, row in zip(STATE, state + unanswered, strict=True):
            if numbers[one] is not None:
                numbers[one] = row.reshape(self._shape)
        texts = Texts(units=texts_of(body.given))
        return vehicle_of(numbers | {"name": name}, given=texts)

    def _unanswered(self, name: str) -> Any:
        """NaN for each case without an answer, also where only this motion has none, else 0."""
        found = self._followed
        good = (found.told.failed == "") & (found.courses[name].failed == "")
        return np.where(good, 0.0, np.nan)

    def _rest(self, name: str) -> Vehicle:
        found = self._followed
        course = found.courses[name]
        with np.errstate(all="ignore"):
            rests = course.rests
        if found.single and not math.isfinite(rests[0]):
            raise no_rest(course)
        with np.errstate(all="ignore"):
            # Ever after: at the moment itself, rounding may leave it a last digit short.
            late = np.where(np.isfinite(rests), np.inf, 0.0)
            state = course.at(late, np.arange(found.count))
        # Where nothing stops it there is no such place.
        state[:3] += np.where(np.isfinite(rests), 0.0, np.nan)
        state[3:] = 0.0
        return self._body(name, state)

    def _why_no_rest(self, name: str) -> str:
        """Why a vehicle has no place of rest, in words."""
        return why_no_rest(self._followed.courses[name])[0]

    def _bounds(self) -> Any:
        """Start, times of impacts and end, (bounds, cases)."""
        found = self._followed
        ends = self._ends()
        rows = [np.zeros(found.count)]
        for number in range(self._most):
            came = found.came.times[number]
            rows.append(np.where(np.isnan(came), ends, came))
        return np.array([*rows, ends])

    def _pieces(self, moments: int = _MOMENTS) -> Iterator[tuple[Any, bool]]:
        """The moments of the clock between two bounds, of (moments, cases)."""
        bounds = self._bounds()
        for number, (begin, end) in enumerate(pairwise(bounds)):
            if np.all(end <= begin):
                if number == len(bounds) - 2 and number:
                    # The scene ends with an impact: its state after.
                    yield begin[None], False
                elif number < len(bounds) - 2:
                    yield begin[None], True
                else:
                    yield begin[None], False
                continue
            share = np.linspace(0.0, 1.0, moments)[:, None]
            times = begin + share * (end - begin)
            times[-1] = end
            yield times, number < len(bounds) - 2

    def _states(self, name: str, moments: int = _MOMENTS) -> Iterator[tuple[Any, Any]]:
        """The clock and the states of a vehicle, piece by piece: (moments, cases), (6, ...)."""
        found = self._followed
        course, every = found.courses[name], np.arange(found.count)
        for times, ends_in_contact in self._pieces(moments):
            cases = np.broadcast_to(every, times.shape).ravel()
            states = course.at(times.ravel(), cases).reshape(6, *times.shape)
            if ends_in_contact:
                states[:, -1] = course.at(times[-1], every, before=True)
            yield times, states

    def _track(self, name: str) -> Track:
        found = self._followed
        mover = self.scene.movers[name]
        times, states, marks = [], [], []
        for clock, state in self._states(name):
            times.append(clock)
            states.append(state)
            if found.single:
                marks.append(self._marks(name, clock, state))
        time, state = np.concatenate(times), np.concatenate(states, axis=1)
        shape = (len(time), *self._shape)
        if not found.single:
            state = state + self._unanswered(name)
        rows = {one: read_only(row.reshape(shape)) for one, row in zip(STATE, state, strict=True)}
        tracks: dict[str, Any] = {}
        if found.single and mover.tyres is not None and marks:
            whole = np.concatenate(marks, axis=2)
            tracks = {
                wheel: (read_only(x.copy()), read_only(y.copy()))
                for wheel, (x, y) in zip(WHEELS, whole, strict=True)
            }
        return Track(time=read_only(time.reshape(shape)), **rows, marks=tracks)

    def _marks(self, name: str, clock: Any, state: Any) -> Any:
        _, marks = self._power(name, clock, state)
        return marks

    def _power(self, name: str, clock: Any, state: Any) -> tuple[Any, Any]:
        """What the ground takes at the moments of a piece [W], and marks."""
        found, mover = self._followed, self.scene.movers[name]
        state = state[:, :, 0]
        none = np.zeros(len(clock)), np.full((4, 2, len(clock)), np.nan)
        if mover.fixed:
            return none
        leg = found.courses[name].leg_at(float(clock[0, 0]))
        held = clock[:, 0] < leg.start[0] + leg.hold[0]
        power, marks = none
        if leg.tyres is not None:
            on_wheels = on_tyres(leg.tyres, mover, found.ground, state)
            power, marks = on_wheels.power, on_wheels.marks
        elif mover.drag is not None:
            stops = float(leg.stops[0])
            # The drag slows what a slope has added by the end of a contact too.
            speed = math.hypot(*leg.begun[3:5, 0])
            slowing = speed / stops if 0.0 < stops < math.inf else 0.0
            power = on_drag(mover, found.ground, state, slowing)
        # What moves on unslowed does so on a slope too.
        if found.ground.steepest and (leg.tyres is not None or mover.drag is not None):
            power = power + on_slope(mover, found.ground, state)
        pulls = 0.0
        if leg.pull is not None:
            pulls = -mover.vehicle.mass * (leg.pull[0, 0] * state[3] + leg.pull[1, 0] * state[4])
        return np.where(held, pulls, power), marks

    def _ground_work(self, name: str) -> float:
        """What the ground takes from one vehicle on the whole way [J]: its power, by Gauss's rule
        over the steps in which the vehicle is followed.
        """
        found, total = self._followed, 0.0
        course = found.courses[name]
        # The power jumps where a contact ends that the vehicle was held in, bends where a drag has
        # stopped it and at the moments of a contact that was followed in time, and jumps where a
        # wheel comes to an edge, at which a step ends.
        jumps: list[float] = []
        for leg in course.settled():
            acts = float(leg.start[0] + leg.hold[0])
            steps = (
                []
                if leg.followed is None
                else leg.followed.steps(np.zeros(1, dtype=int))[:, 0].tolist()
            )
            jumps += [acts, acts + float(leg.stops[0]), *(acts + moment for moment in steps)]
            if leg.during is not None:
                jumps += (leg.start[0] + leg.during.moments).tolist()
        # A leg may begin between two impacts, where tyres act again later than a contact has ended.
        ends = float(self._bounds()[-1, 0])
        starts = (float(leg.start[0]) for leg in course.settled())
        pieces = {*self._bounds()[:, 0].tolist(), *(start for start in starts if start < ends)}
        for begin, end in pairwise(sorted(pieces)):
            bounds = np.unique([begin, *(jump for jump in jumps if begin < jump < end), end])
            widths = np.diff(bounds)
            clock = (bounds[:-1, None] + widths[:, None] * _NODES).reshape(-1)
            state = course.at(clock, np.zeros(len(clock), dtype=int))
            power, _ = self._power(name, clock[:, None], state[:, :, None])
            total += float(widths @ (power.reshape(-1, len(_NODES)) @ _WEIGHTS))
        return total

    def _pulled(self, name: str, impact: Impact) -> float:
        """What the forces of a contact that is followed in time take from one vehicle [J] by acting
        on the motion that the slope adds meanwhile, which the impact itself is without.
        """
        mover = self.scene.movers[name]
        # By the impact: another contact may have begun at the same moment.
        for leg in self._followed.courses[name].settled():
            if leg.during is not None and leg.pull is not None and leg.during.impact is impact:
                break
        else:
            return 0.0
        ends = leg.during.ends[:, :, 0]
        if mover.fixed or not np.isfinite(ends[0, 1]):
            return 0.0
        (began, ended), after = ends[1:3].T, ends[4:6, 1]
        # Forces F at the times t: the sum of F t is mass by (velocity after by time, less the way).
        lags = ended - began - leg.hold[0] * after
        mass: float = mover.vehicle.mass
        return mass * float(leg.pull[:, 0] @ lags)

    def __repr__(self) -> str:
        found = self._followed
        cases = "" if found.single else f", {found.count} cases"
        return f"<Run of {', '.join(self.scene.movers)}: {self._most} impacts{cases}>"

    def _summary(self, numbers: Cells) -> Summary:
        movers = self.scene.movers
        parts: list[Part] = []
        rows: list[tuple[str, ...]] = []
        if self._followed.single:
            for time, pair, impact in zip(self.times, self.pairs, self.impacts, strict=True):
                rows.append(
                    (
                        f"{pair[0]} and {pair[1]}",
                        numbers.text(time, "s"),
                        numbers.text(impact.closing_speed, "m/s"),
                        numbers.text(impact.a.delta_v, "m/s"),
                        numbers.text(impact.b.delta_v, "m/s"),
                        numbers.text(impact.energy_loss, "J"),
                    )
                )
            heads = ("at", "closing", "delta-V of the first", "of the second", "energy lost")
            parts.append(Part(rows, "Impacts", heads))
        rows = []
        for name in movers:
            try:
                body = self._rest(name)
            except CollisionsError:
                rows.append((name, "goes on", "", ""))
                continue
            cells = [
                numbers.text(getattr(body, part), unit, part)
                for part, unit in (("x", "m"), ("y", "m"), ("heading", "rad"))
            ]
            rows.append((name, *cells))
        parts.append(Part(rows, "Places of rest", ("x", "y", "heading")))
        notes = [f"{one.sentence}." for one in self._findings_in(numbers.name)]
        title = f"Scene of {', '.join(movers)}"
        if not self._followed.single:
            wrong = int((self._followed.told.failed != "").sum())
            notes.append(f"{self._followed.count} cases, {wrong} of them without an answer.")
        return Summary(title, [*parts, all_numbers(self._rows())], notes)

    def _repr_html_(self) -> str:
        table = self.summary()._repr_html_()
        if not self._followed.single:
            return table
        from .picture import small_picture

        return small_picture(self, cells(None, given_texts(self))) + table

    def _rows(self) -> Iterator[tuple[str, str]]:
        for number in range(self._most):
            yield f"times[{number}]", format_value(self._time(number), "s")
        if self._followed.single:
            for number, impact in enumerate(self.impacts):
                yield from ((f"impacts[{number}].{name}", text) for name, text in impact._rows())

    def _texts(self) -> Iterable[Any]:
        return given_texts(self.scene)


class Rests(Frozen):
    """Vehicles at their places of rest by name, as in a dict; each is worked out when it is asked
    for.
    """

    _run: Run

    def __init__(self, run: Run) -> None:
        vars(self).update(_run=run)

    @property
    def q(self) -> Any:
        """The same places as pint Quantities of the application registry."""
        return _RestsInQuantities(self._run)

    def __getitem__(self, name: str) -> Vehicle:
        if name not in self:
            raise _no_mover(name, self)
        return self._run._rest(name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._run.scene.movers)

    def __len__(self) -> int:
        return len(self._run.scene.movers)

    def __contains__(self, name: object) -> bool:
        return name in self._run.scene.movers

    def keys(self) -> Iterable[str]:
        """The names of the vehicles.

        Returns
        -------
        iterable of str
        """
        return self._run.scene.movers.keys()

    def __repr__(self) -> str:
        return f"<places of rest of {', '.join(self)}>"


class _RestsInQuantities(Rests):
    def __getitem__(self, name: str) -> Any:
        return super().__getitem__(name).q


class _ByName(dict[str, Any]):
    """Something of each vehicle; the error for a name that is none has those that there are."""

    def __missing__(self, name: Any) -> Any:
        raise _no_mover(name, self)


def _no_mover(name: Any, movers: Iterable[str]) -> KeyError:
    return KeyError(f"{name!r} is no mover; the movers are {', '.join(movers)}")


def as_letters(pair: tuple[str, str]) -> str:
    """Which vehicle of a pair is A in an impact, and which is B; names that are the letter of the
    other are marked as names.
    """
    one, other = pair
    if one in ("b", "B") or other in ("a", "A"):
        one, other = f"\u201c{one}\u201d", f"\u201c{other}\u201d"
    return f"{one} as A and {other} as B"


def _warn_of(found: Followed, wrong: Any) -> None:
    """Say how many cases of a batch have no answer, and why."""
    if found.single or not wrong.any():
        return
    codes, counts = np.unique(found.told.failed[wrong].astype(str), return_counts=True)
    many = dict(zip(codes.tolist(), counts.tolist(), strict=True))
    listed = ", ".join(f"{count} {code}" for code, count in many.items())
    warn_of_cases(
        CollisionsWarning(
            f"{int(wrong.sum())} of {found.count} cases of the scene have no answer and "
            f"are NaN ({listed})",
            code="refused_cases",
            counts=many,
        ),
        {f"without an answer, as {code}": wrong & (found.told.failed == code) for code in many},
    )


# What a finding of one run is without its names and times.
_DRIVEN = (
    "two vehicles do not part right after their contact, or touch too slowly for one, and are "
    "followed through or into each other: "
    "what pushes them without a blow is not followed, and their places of rest may be wrong. Where "
    "that is so in a few percent of the cases, no more of the probability is in doubt; where in "
    "many, leave the places of rest out of the evidence, and give what was read before that: the "
    "delta-V of a recorder, or speed and course right after the impact, such as "
    "'impacts[0].a.after.course'"
)
_DRAGLESS = "a drag does not act during a contact that has a duration; tyres in its place do"
_MIXED = (
    "the wheels of a vehicle stand on ground of different friction in a contact that has a "
    "duration; their mean acts on all four meanwhile"
)
_PARTLY = (
    "the tyres of a vehicle act in a contact that has a duration only for what an earlier one "
    "leaves of it, with that share of their friction"
)
_UNDESCRIBED = (
    "two vehicles touch, and no contact says what happens; they are followed as if they passed "
    "through each other"
)


_PASSED_OVER = (
    "two vehicles touch and do not close where the impulse would act; they are followed without one"
)


_AT_DEEPEST = (
    "two vehicles part before the depth or delay of their contact is reached; the impulse acts at "
    "their deepest"
)


def _of_driven(said: str) -> OutOfRangeWarning:
    return OutOfRangeWarning(said, code="driven_through")


def _of_dragless(said: str) -> OutOfRangeWarning:
    return OutOfRangeWarning(said, code="drag_during_contact")


def _of_mixed(said: str) -> OutOfRangeWarning:
    return OutOfRangeWarning(said, code="mixed_friction")


def _of_partly(said: str) -> OutOfRangeWarning:
    return OutOfRangeWarning(said, code="durations_overlap")


def _of_undescribed(said: str) -> OutOfRangeWarning:
    return OutOfRangeWarning(said, code="touch_without_contact")


def _of_passed_over(said: str) -> OutOfRangeWarning:
    return OutOfRangeWarning(said, code="touch_passed_over")


def _of_deepest(said: str) -> OutOfRangeWarning:
    return OutOfRangeWarning(said, code="at_deepest")


_OF_FINDING = {
    "driven_through": (_of_driven, _DRIVEN),
    "driven_together": (_of_driven, _DRIVEN),
    "drag_during_contact": (_of_dragless, _DRAGLESS),
    "mixed_friction": (_of_mixed, _MIXED),
    "durations_overlap": (_of_partly, _PARTLY),
    "touch_without_contact": (_of_undescribed, _UNDESCRIBED),
    "touch_passed_over": (_of_passed_over, _PASSED_OVER),
    "at_deepest": (_of_deepest, _AT_DEEPEST),
}


def _warn_of_notices(found: Followed) -> None:
    """Say of how many cases of a batch that holds of which a single case has a finding."""
    if found.single:
        return
    for cases, made, text in (
        (found.told.driven, _of_driven, _DRIVEN),
        (found.told.dragless, _of_dragless, _DRAGLESS),
        (found.told.mixed, _of_mixed, _MIXED),
        (found.told.partly, _of_partly, _PARTLY),
        (found.told.undescribed, _of_undescribed, _UNDESCRIBED),
        (found.told.passed_over, _of_passed_over, _PASSED_OVER),
        (found.came.at_deepest, _of_deepest, _AT_DEEPEST),
    ):
        where = cases & (found.told.failed == "")
        if count := int(np.count_nonzero(where)):
            said = f"in {count} of {found.count} cases of the scene {text}"
            warn_of_cases(made(said), {text: where})


def warn_of_findings(run: Run) -> None:
    """Say of a single run what limits its answer, where the run itself is not seen; of an impact
    that gains energy its solver has warned.
    """
    for notice in run.findings if run._followed.single else ():
        if notice.code == "energy_gain":
            continue
        made, text = _OF_FINDING[notice.code]
        warn_of_cases(made(notice.sentence), {text: None})


def _tyre_loss(side: Any) -> float:
    loss: float = side.tyre_loss
    return loss

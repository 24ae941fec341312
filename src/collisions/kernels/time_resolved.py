"""The time-resolved impact: the contact set up in its own units, its start found, stepped through,
and answered in SI.
"""

from collections.abc import Callable, Sequence
from functools import lru_cache
from math import nan, pi
from typing import Any, NamedTuple

import numpy as np

from .contact_step import (
    LONGEST,
    MOST_FRICTION,
    Body,
    Contact,
    Motion,
    Passing,
    Place,
    Wheels,
    advance,
    approach,
    braked,
    compliance,
    drifted,
    force_back,
    place_of,
)
from .elementwise import first_status, select
from .status import EPS, Passed, Status
from .tyre import Tyres

# How often the start is corrected with all steps. How near what is reached has to be to the places
# given, in closing speed times duration and in radians: at 100 steps, and at most. By the cube of
# the steps it stays below their own error.
_CORRECTIONS, _NEAR, _NEAREST = 20, 3e-3, 1e-2
# Before that it is corrected with these parts of the steps; with fewer a contact is not followed.
_PARTS, _FEWEST = (0.05, 0.1, 0.2), 5
# How near it has to come with each of these parts of 100 steps or more, and how often it is
# corrected until then. Of fewer steps a part is a larger one, and so is what is near enough.
_ROUGHLY, _ROUGH_CORRECTIONS = 0.3, 12
# With this part of the steps it is found how the end changes with the start, where that has to move
# by no more than so many times what is near enough: the change is found to a few hundredths.
_DIFFERENCE, _NOT_FAR, _DIFFERENCES, _BLUR = 0.1, 20.0, 8, 0.1
# Rounding of a sum over the steps of a contact, as a share.
_ROUNDED = 1e-12
# Radians by which a body may turn within a step: above, answers are off by more than a percent.
_MOST_TURNED = 0.25
# So few cases are followed one by one.
_LEAST = 32
_FOUR: Wheels = ((1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0))
_ONE: Wheels = ((0.0, 0.0),)
_FIXED = (Contact, Body, Body)
_MOVING = (Motion, Motion, Passing)

Moving = tuple[Motion, Motion, Passing]
Fixed = tuple[Contact, Body, Body]
Run = Callable[[Fixed, Moving, bool, Any], Moving]


class Settings(NamedTuple):
    """What is the same of all cases: geometry, steps a nominal duration, whether that is given, and
    the wheels of A and B.
    """

    geometry: str
    steps: int
    timed: bool
    wheels_a: Wheels
    wheels_b: Wheels


def wheels_of(heading: Any, drag: Any) -> Wheels:
    """The wheels of a vehicle that slide: none without drag; all of its weight at the centre of
    mass without a heading.
    """
    return () if isinstance(drag, float) and drag == 0.0 else _ONE if heading is None else _FOUR


class Units(NamedTuple):
    """What is 1 inside a contact, in SI: its effective mass, closing speed, nominal duration and
    the way of that speed in that time.
    """

    mass: Any
    closing: Any
    duration: Any
    length: Any

    @property
    def impulse(self) -> Any:
        """Of impulses."""
        return self.mass * self.closing

    @property
    def energy(self) -> Any:
        """Of energies."""
        return self.mass * self.closing * self.closing


class SetUp(NamedTuple):
    """A contact before anything has moved: what is fixed and what moves, in its own units, and what
    is known of the places given.
    """

    fixed: Fixed
    moving: Moving
    units: Units
    closing_speed: Any
    coupling: Any
    yields: Any


def time_resolved(
    restitution: Any,
    normal: tuple[Any, Any],
    friction: Any,
    point: tuple[Any, Any],
    gravity: float,
    tyres: tuple[Tyres, Tyres],
    spring: Any,
    bodies: tuple[tuple[Any, ...], tuple[Any, ...]],
    settings: Settings,
    run: Callable[[Settings], Run],
    note: Any = None,
) -> Passed:
    """Solve one case of floats, or a block of arrays, as ``run`` does; SI in and out.

    ``spring`` is the nominal duration or a stiffness, as ``settings.timed`` says. ``bodies`` have
    mass, inertia, velocity, yaw rate, position, and cosine and sine of the heading, or None.
    ``note``, a ``Noted`` for one case, keeps what moves in every step.
    """
    steps = run(settings)
    start = _set_up(restitution, normal, friction, point, gravity, tyres, spring, bodies, settings)
    append = None if note is None else note.append
    converged: Any = True
    if settings.geometry == "maximum_engagement":
        search = _Search(start.fixed, start.moving, steps, settings, note)
        fixed, engaged, converged = search.found((start.closing_speed > 0.0) & start.yields)
        start = start._replace(fixed=fixed)
    else:
        fixed, (on_a, on_b, passing) = start.fixed, start.moving
        closing, _ = approach(place_of(*fixed, *start.moving), on_a, on_b)
        passing = passing._replace(closing=closing, active=closing > 0.0)
        engaged = steps(fixed, (on_a, on_b, passing), True, append)
    contact, a, b = fixed
    on_a, on_b, passing = engaged
    _, parting = force_back(contact, passing.crush, passing.deepest)
    more = (passing.crush > parting) & (passing.time < LONGEST)
    end = steps(fixed, (on_a, on_b, passing._replace(active=more)), False, append)
    on_a, on_b, passing = settled(contact, end, settings)
    owed = select(passing.owed > 0.0, passing.owed, 0.0)
    end = (
        braked(a, on_a, owed, settings.wheels_a),
        braked(b, on_b, owed, settings.wheels_b),
        passing,
    )
    if isinstance(note, Noted):
        note[-1:] = [tuple(value for part in end for value in part)]
    engaged = settled(contact, engaged, settings)
    found = _of_contact(start, normal, engaged, end)
    # The places given are those of maximum engagement, or of the start.
    given = engaged if settings.geometry == "maximum_engagement" else start.moving
    met, parted = engaged[2], end[2]
    found |= _of_body(
        "a", start.units, a, start.moving[0], (engaged[0], met), (end[0], parted), given[0], -1.0
    )
    found |= _of_body(
        "b", start.units, b, start.moving[1], (engaged[1], met), (end[1], parted), given[1], 1.0
    )
    status = _status(start, found, converged, end, settings.geometry)
    if isinstance(note, Noted) and status <= Status.ENERGY_GAIN:
        found["history"] = _history(note, start)
    return Passed(status=status, **found)


def _set_up(
    e: Any,
    normal: tuple[Any, Any],
    friction: Any,
    point: tuple[Any, Any],
    gravity: float,
    tyres: tuple[Tyres, Tyres],
    spring: Any,
    bodies: tuple[tuple[Any, ...], tuple[Any, ...]],
    settings: Settings,
) -> SetUp:
    """The contact in its own units, from SI."""
    (nx, ny), own = normal, [_own(body, *point) for body in bodies]
    (a, on_a), (b, on_b) = own
    place = Place(nx, ny, a.rx, a.ry, b.rx, b.ry)
    closing_speed, _ = approach(place, on_a, on_b)
    k_nn, k_nt, k_tt = compliance(place, a, b)
    yields = k_nn > (64.0 * EPS) ** 2 * (k_nn + k_tt)
    mass, closing = 1.0 / select(yields, k_nn, 1.0), select(closing_speed > 0.0, closing_speed, 1.0)
    # A quarter of a swing to maximum engagement, and back in e times that.
    swing = 0.5 * pi * (1.0 + e)
    duration = spring if settings.timed else swing * (mass / spring) ** 0.5
    units = Units(mass, closing, duration, closing * duration)
    weight = gravity * (duration / closing)
    (a, on_a), (b, on_b) = (
        (
            scaled(body, numbers[7], mass, units.length, weight, held),
            Motion(motion.vx / closing, motion.vy / closing, motion.spin * duration),
        )
        for (body, motion), numbers, held in zip(own, bodies, tyres, strict=True)
    )
    step = 1.0 / settings.steps
    back = e**0.5 * step
    soonest = 0.6 * e / (1.0 + e)
    fixed_a, fixed_b = ((body.per_mass == 0.0) & (body.per_inertia == 0.0) for body in (a, b))
    contact = Contact(
        swing * swing,
        e,
        select(friction < MOST_FRICTION, friction, MOST_FRICTION),
        nx,
        ny,
        on_a=select(fixed_b, 1.0, select(fixed_a, 0.0, 0.5)),
        turn_a=select(fixed_b, 0.0, select(fixed_a, 1.0, 0.5)),
        step=step,
        step_back=select(back < soonest, back, soonest),
    )
    # Broadcast, so that all that moves has the shape of the cases.
    zero = 0.0 * (
        closing + contact.step_back + contact.friction + on_a.vx + on_b.vx + sum((*a, *b))
    )
    on_a, on_b = (Motion(*(value + zero for value in motion)) for motion in (on_a, on_b))
    none = zero != zero
    passing = Passing(*(zero for _ in Passing._fields))._replace(
        c=1.0 + zero, sticks=none, active=none ^ True
    )
    # Broadcast too, as answers are.
    units, coupling = units._replace(mass=mass + 0.0 * zero), k_nt + 0.0 * zero
    return SetUp((contact, a, b), (on_a, on_b, passing), units, closing_speed, coupling, yields)


def _of_contact(
    start: SetUp, normal: tuple[Any, Any], engaged: Moving, end: Moving
) -> dict[str, Any]:
    """What is answered of the contact, in SI."""
    (contact, a, b), units, (nx, ny) = start.fixed, start.units, normal
    on_a, on_b, passing = end
    before = approach(place_of(contact, a, b, *start.moving), *start.moving[:2])
    after = approach(place_of(contact, a, b, *end), on_a, on_b)
    there = place_of(contact, a, b, *engaged)
    most = contact.stiffness * passing.deepest
    x, y = passing.impulse_x * units.impulse, passing.impulse_y * units.impulse
    met = engaged[2]
    return {
        "closing_speed": before[0] * units.closing,
        "slip_before": before[1] * units.closing,
        "slip_after": after[1] * units.closing,
        "normal_impulse": nx * x + ny * y,
        "tangential_impulse": nx * y - ny * x,
        "compression_impulse": (nx * met.impulse_x + ny * met.impulse_y) * units.impulse,
        "sticks": passing.sticks,
        "effective_mass": units.mass,
        "coupling": start.coupling,
        "energy_loss_normal": passing.work_n * units.energy,
        "energy_loss_tangential": passing.work_t * units.energy,
        "energy_loss": (passing.work_n + passing.work_t) * units.energy,
        "impulse_x": x,
        "impulse_y": y,
        "separation_speed": -after[0] * units.closing,
        "energy_absorbed": 0.5 * most * passing.deepest * units.energy,
        "duration": passing.time * units.duration,
        "peak_force": most * (units.impulse / units.duration),
        "max_crush": passing.deepest * units.length,
        "engaged_time": met.time * units.duration,
        "common_velocity": units.closing
        * (
            there.nx * (engaged[0].vx - engaged[0].spin * there.ay)
            + there.ny * (engaged[0].vy + engaged[0].spin * there.ax)
        ),
    }


def _of_body(
    label: str,
    units: Units,
    body: Body,
    begin: Motion,
    engaged: tuple[Motion, Passing],
    end: tuple[Motion, Passing],
    given: Motion,
    sign: float,
) -> dict[str, Any]:
    """What is answered of A or B, in SI, from its motions and what has passed by then; ``given`` is
    its motion where its place is given, ``sign`` that of the impulse on it.
    """
    found = {}
    for prefix, (motion, passing) in (("compression", engaged), ("delta", end)):
        x, y = sign * passing.impulse_x + motion.tyre_x, sign * passing.impulse_y + motion.tyre_y
        found[f"{prefix}_vx"] = body.per_mass * x * units.closing
        found[f"{prefix}_vy"] = body.per_mass * y * units.closing
        found[f"{prefix}_yaw_rate"] = (motion.spin - begin.spin) / units.duration
    last = end[0]
    found |= {
        "tyre_impulse_x": last.tyre_x * units.impulse,
        "tyre_impulse_y": last.tyre_y * units.impulse,
        "tyre_moment": last.tyre_yaw * (units.impulse * units.length),
        "tyre_loss": (0.0 - last.tyre_work) * units.energy,
        "peak_acceleration": last.acceleration**0.5 * (units.closing / units.duration),
        "moved_x": (last.dx - given.dx) * units.length,
        "moved_y": (last.dy - given.dy) * units.length,
        "turn_c": last.c * given.c + last.s * given.s,
        "turn_s": last.s * given.c - last.c * given.s,
    }
    return {f"{name}_{label}": value for name, value in found.items()}


def _status(start: SetUp, found: dict[str, Any], converged: Any, end: Moving, geometry: str) -> Any:
    """How the contact went; of several reasons against it the first."""
    passing = end[2]
    # Of the pulse, the crush at the end; that of two bodies that part fast may overflow first.
    checked = (*found.values(), passing.crush * start.units.length)
    total = sum((0.0 * value for value in checked), start=0.0 * start.units.length)
    finite = total - total == 0.0
    # Levers in units of a contact that is so short overflow, and no start can be found then.
    reach = sum(
        body.per_inertia * (body.rx * body.rx + body.ry * body.ry) for body in start.fixed[1:]
    )
    contact, a, b = start.fixed
    turns = [abs(motion.spin) * contact.step > _MOST_TURNED for motion in start.moving[:2]]
    loss = passing.work_n + passing.work_t
    absorbed = 0.5 * (contact.stiffness * passing.deepest) * passing.deepest
    # Friction without bound stops the slip before the spring pushes. Where the bodies part by that,
    # the answer would be that of one step, however short.
    place = place_of(contact, a, b, *start.moving)
    closing, slip = approach(place, *start.moving[:2])
    k = compliance(place, a, b)
    separates = (k.tt > 0.0) & (k.tt * closing + k.nt * slip <= 0.0)
    pulls = (contact.friction == MOST_FRICTION) & separates
    return first_status(
        (start.yields ^ True, Status.IMMOVABLE),
        (start.closing_speed < 0.0, Status.SEPARATING),
        (start.closing_speed == 0.0, Status.GRAZING),
        (reach - reach != 0.0, Status.OUT_OF_RANGE),
        (geometry != "fixed" and turns[0] | turns[1], Status.COARSE_STEPS),
        (converged ^ True, Status.NO_START),
        (found["closing_speed"] <= 0.0, Status.SEPARATING),
        (finite ^ True, Status.OUT_OF_RANGE),
        (pulls | (passing.deepest <= 0.0), Status.NO_SLIP_PULLS),
        (passing.time >= LONGEST, Status.ENDLESS_CONTACT),
        # What the steps err by, near a restitution of 1, beyond rounding.
        (loss < -_ROUNDED * absorbed, Status.ENERGY_GAIN),
    )


class Noted(list[tuple[float, ...]]):
    """What moves in every step of one case."""

    def shift(self, some: Any, new: tuple[Any, ...], old: tuple[Any, ...]) -> None:
        """Let the way end at ``new`` and not at ``old``, by as much as time has passed."""
        end, was = (
            np.array([(*on_a, *on_b, *passing)], dtype=np.float64)
            for on_a, on_b, passing in (new, old)
        )
        rows = np.array(self, dtype=np.float64)
        time = 2 * len(Motion._fields) + Passing._fields.index("time")
        # A way over which no time passes is its end alone.
        passed = rows[:, time : time + 1] / was[0, time] if was[0, time] > 0.0 else 1.0
        rows += passed * (end - was)
        self[:] = map(tuple, rows.tolist())


def _history(note: Noted, start: SetUp) -> tuple[Any, ...]:
    """Time, force, crush, delta-V of A and B, and their yaw rates, at the start and after every
    step.
    """
    contact, units = start.fixed[0], start.units
    on_a, on_b, passing = _moving_of(
        np.array([(*start.moving[0], *start.moving[1], *Passing()), *note], dtype=np.float64).T
    )
    crush, deepest = passing.crush, passing.deepest
    with np.errstate(all="ignore"):
        force = np.where(
            crush < deepest, force_back(contact, crush, deepest)[0], contact.stiffness * deepest
        )
    if contact.restitution == 0.0 or crush[-1] < deepest[-1]:
        force[-1] = 0.0
    return (
        passing.time * units.duration,
        force * (units.impulse / units.duration),
        crush * units.length,
        *(
            np.hypot(body.vx - body.vx[0], body.vy - body.vy[0]) * units.closing
            for body in (on_a, on_b)
        ),
        *(body.spin / units.duration for body in (on_a, on_b)),
    )


def _moving_of(numbers: Any) -> Moving:
    """What moves, from its numbers in a row."""
    count = len(Motion._fields)
    return (
        Motion(*numbers[:count]),
        Motion(*numbers[count : 2 * count]),
        Passing(*numbers[2 * count :]),
    )


def _own(body: tuple[Any, ...], px: Any, py: Any) -> tuple[Body, Motion]:
    """A body and its motion in SI, without what only tyres need."""
    mass, inertia, vx, vy, spin, x, y, *_ = body
    return Body(1.0 / mass, 1.0 / inertia, px - x, py - y), Motion(vx, vy, spin)


def scaled(body: Body, heading: Any, mass: Any, length: Any, weight: Any, tyres: Tyres) -> Body:
    """The body in units of the contact, with its wheels; ``weight`` is that of a unit of mass."""
    ahead, left = tyres.ahead / length, tyres.left / length
    if heading is None:
        heading, ahead, left = (1.0, 0.0), 0.0, 0.0
    per_mass, per_inertia = body.per_mass * mass, body.per_inertia * ((mass * length) * length)
    moves = per_mass > 0.0
    turning = (ahead * ahead + left * left) * per_inertia
    grip = select(moves, 0.25 * weight / select(moves, per_mass, 1.0), 0.0)
    cap = select(moves, 0.25 / select(moves, per_mass + turning, 1.0), 0.0)
    numbers = grip, cap, *tyres.locks, *tyres._replace(ahead=ahead, left=left)[1:]
    return Body(*(per_mass, per_inertia, body.rx / length, body.ry / length, *heading, *numbers))


class _Search:
    """The search for what the bodies and the normal move and turn until maximum engagement.

    A guess of that gives the geometry at first contact, and what is reached from there should be
    the guess. It is corrected with the step of a secant: with few steps first, as their error
    hardly matters, then with more, and with all until what is reached is near enough. Where the
    first time with all steps comes near, what a last correction changes is worked out with few
    steps, and added to what all of them reached. The cases of a block are independent.
    """

    def __init__(
        self, fixed: Fixed, moving: Moving, run: Run, settings: Settings, note: Any
    ) -> None:
        self.fixed, self.moving, self.run, self.settings = fixed, moving, run, settings
        self.note = note
        self.guess = _way(moving)
        self.older: tuple[list[Any], list[Any]] | None = None
        self.near = min(_NEAR * (100.0 / settings.steps) ** 3.0, _NEAREST)
        self.fewest = max(_FEWEST / _PARTS[0] / settings.steps, 1.0)

    def found(self, usable: Any) -> tuple[Fixed, Moving, Any]:
        """The geometry at first contact, the motions at maximum engagement, and where they were
        found.
        """
        near = left = self.roughly(usable)
        begun, engaged = self.fixed, self.moving
        for turn in range(_CORRECTIONS):
            if self.note is not None:
                self.note.clear()
            append = None if self.note is None else self.note.append
            start, end, approaching, reached = self.follow(1.0, self.guess, left, append)
            # Of a block only the cases that have not arrived are followed again.
            begun = start if turn == 0 else _where(left, start, begun)
            engaged = end if turn == 0 else _where(left, end, engaged)
            off = _minus(reached, self.guess)
            trial = self.next_guess(left, reached, off)
            far = _size(off)
            left = left & (((far <= self.near) & approaching) ^ True)
            close = left & approaching & (far <= _NOT_FAR * self.near)
            if np.any(close):
                here, there, arrived, hits = self.moved_on(off, trial, close)
                if np.any(hits):
                    begun = _where(hits, _moved_back(*self.fixed, arrived), begun)
                    later = _shifted(self.fixed[1:], self.moving, engaged, (here, there))
                    if self.note is not None:
                        self.note.shift(hits, later, engaged)
                    engaged = _where(hits, later, engaged)
                left = left & (hits ^ True)
                trial = _chosen(close, arrived, trial)
            if not np.any(left):
                break
            self.guess = _chosen(left, trial, self.guess)
        return begun, engaged, near & (left ^ True)

    def roughly(self, usable: Any) -> Any:
        """Correct the guesses with few steps, then with more; which cases come near in that."""
        near = usable
        for part in (part * self.fewest for part in _PARTS if part * self.fewest < 0.5):
            far = near
            for _ in range(_ROUGH_CORRECTIONS):
                _, _, _, reached = self.follow(part, self.guess, far)
                off = _minus(reached, self.guess)
                self.guess = _chosen(far, self.next_guess(far, reached, off), self.guess)
                far = far & ((_size(off) <= _ROUGHLY * self.fewest**2) ^ True)
                if not np.any(far):
                    break
            near = near & (far ^ True)
        return near

    def moved_on(
        self, off: list[Any], trial: list[Any], close: Any
    ) -> tuple[Moving, Moving, list[Any], Any]:
        """With few steps the ends from the guess and from where all steps would arrive by what few
        say, that start, and which of the close cases arrive.
        """
        left, part = close, max(_DIFFERENCE, _PARTS[0]) * self.fewest
        whole = [now + miss for now, miss in zip(self.guess, off, strict=True)]
        _, here, _, were = self.follow(part, self.guess, left)
        there, hits = here, left ^ left
        for _ in range(_DIFFERENCES):
            _, end, approaching, are = self.follow(part, trial, left)
            there = _where(left, end, there)
            reached = [one + (now - was) for one, now, was in zip(whole, are, were, strict=True)]
            missed = _minus(reached, trial)
            far = _size(missed) + _BLUR * _size(_minus(trial, self.guess))
            hits = hits | (left & approaching & (far <= self.near))
            left = close & (hits ^ True)
            if not np.any(left):
                break
            trial = _chosen(left, self.next_guess(left, reached, missed), trial)
        return here, there, trial, hits

    def follow(
        self, part: float, guess: list[Any], some: Any, append: Any = None
    ) -> tuple[Fixed, Moving, Any, list[Any]]:
        """With a part of the steps the start and the end of some cases from a guess, whether they
        approach there, and what is reached.
        """
        contact, a, b = self.fixed
        start = _moved_back(contact._replace(step=contact.step / part), a, b, guess)
        on_a, on_b, passing = self.moving
        closing, _ = approach(place_of(*start, *self.moving), on_a, on_b)
        passing = passing._replace(closing=closing, active=(closing > 0.0) & some)
        end = self.run(start, (on_a, on_b, passing), True, append)
        return start, end, closing > 0.0, _way(settled(start[0], end, self.settings))

    def next_guess(self, some: Any, reached: list[Any], off: list[Any]) -> list[Any]:
        """The next guess of some cases, from what they reached and by how much they missed."""
        trial = reached if self.older is None else _secant(reached, off, *self.older)
        # The other cases of a block have not been followed: their secant stays.
        self.older = (
            (off, reached)
            if self.older is None
            else (_chosen(some, off, self.older[0]), _chosen(some, reached, self.older[1]))
        )
        return trial


def _way(moving: Moving) -> list[Any]:
    """What the bodies and the normal have moved and turned."""
    on_a, on_b, passing = moving
    way = [(one.dx, one.dy, one.c, one.s) for one in (on_a, on_b)]
    return [*way[0], *way[1], passing.c, passing.s]


def _minus(one: list[Any], other: list[Any]) -> list[Any]:
    return [value - less for value, less in zip(one, other, strict=True)]


def _size(parts: list[Any]) -> Any:
    return sum(abs(part) for part in parts)


def _chosen(some: Any, new: list[Any], old: list[Any]) -> list[Any]:
    """The new values of some cases, and the old ones of the others."""
    # A single case has no others.
    return new if some is True else [select(some, *pair) for pair in zip(new, old, strict=True)]


def settled(contact: Contact, moving: Moving, settings: Settings) -> Moving:
    """What moves, drifted for the time that its last step left."""
    if settings.geometry == "fixed":
        return moving
    on_a, on_b, passing = moving
    return drifted(contact, (on_a, on_b), passing, passing.late)


def _shifted(
    bodies: tuple[Body, ...],
    begin: Moving,
    end: Moving,
    ends: tuple[Moving, Moving],
) -> Moving:
    """The end of a motion, from another start than that from which it was followed: by the
    difference of two ends. The work of the contact is such that no energy is lost in that.
    """
    found: list[Any] = []
    wholes: tuple[tuple[Any, ...], ...] = end, *ends
    for parts, was, now in zip(*wholes, strict=True):
        moved = {
            name: getattr(parts, name) + (getattr(now, name) - getattr(was, name))
            for name in parts._fields
            if name not in ("sticks", "active")
        }
        size = (moved["c"] * moved["c"] + moved["s"] * moved["s"]) ** 0.5
        found.append(parts._replace(**moved | {name: moved[name] / size for name in "cs"}))
    on_a, on_b, passing = found
    taken = on_a.tyre_work + on_b.tyre_work - passing.work_n - passing.work_t
    gained = _energy(bodies, (on_a, on_b)) - _energy(bodies, begin[:2])
    passing = passing._replace(work_n=passing.work_n + (taken - gained))
    return on_a, on_b, passing


def _energy(bodies: tuple[Body, ...], motions: tuple[Motion, ...]) -> Any:
    """The energy of motion, but of what is fixed."""
    total: Any = 0.0
    for body, motion in zip(bodies, motions, strict=True):
        for per, square in (
            (body.per_mass, motion.vx * motion.vx + motion.vy * motion.vy),
            (body.per_inertia, motion.spin * motion.spin),
        ):
            moves = per > 0.0
            total = total + 0.5 * select(moves, square, 0.0) / select(moves, per, 1.0)
    return total


def _where(some: Any, new: Any, old: Any) -> Any:
    """The new parts of some cases, and the old ones of the others."""
    if some is True:
        return new
    if isinstance(new, tuple):
        parts = (_where(some, *pair) for pair in zip(new, old, strict=True))
        return type(new)(*parts) if hasattr(new, "_fields") else tuple(parts)
    return new if new is old else select(some, new, old)


def cases_of(parts: Any, some: Any) -> Any:
    """Some cases of the arrays in a tuple."""
    if isinstance(parts, tuple):
        values = (cases_of(part, some) for part in parts)
        return type(parts)(*values) if hasattr(parts, "_fields") else tuple(values)
    return parts[some] if isinstance(parts, np.ndarray) else parts


def put(parts: Any, some: Any, new: Any) -> Any:
    """The same arrays with some cases replaced."""
    if isinstance(parts, tuple):
        values = (put(part, some, one) for part, one in zip(parts, new, strict=True))
        return type(parts)(*values) if hasattr(parts, "_fields") else tuple(values)
    whole = parts.copy()
    whole[some] = new
    return whole


def _secant(
    reached: Sequence[Any],
    off: Sequence[Any],
    off_before: Sequence[Any],
    reached_before: Sequence[Any],
) -> list[Any]:
    """The next guess, from where the last two led and by how much they missed."""
    change = [now - then for now, then in zip(off, off_before, strict=True)]
    square: Any = sum(part * part for part in change)
    along: Any = sum(part * now for part, now in zip(change, off, strict=True))
    share = along / select(square > 0.0, square, 1.0)
    share = select(abs(share) < 1.0, share, 0.0)
    return [now - share * (now - then) for now, then in zip(reached, reached_before, strict=True)]


def _moved_back(contact: Contact, a: Body, b: Body, moved: list[Any]) -> tuple[Contact, Body, Body]:
    """Geometry at first contact from that at maximum engagement, by what moves and turns between
    them.
    """
    turned = []
    for body, (dx, dy, c, s) in ((a, moved[:4]), (b, moved[4:8])):
        size = (c * c + s * s) ** 0.5
        turned.append((body, body.rx + dx, body.ry + dy, c / size, s / size))
    # Where the point was, seen from where it is: both bodies carry it there.
    cos = sin = x = y = 0.0
    for (body, rx, ry, c, s), share in zip(turned, (contact.on_a, 1.0 - contact.on_a), strict=True):
        cos, sin = cos + share * c, sin + share * s
        x, y = x + share * (body.rx - (c * rx - s * ry)), y + share * (body.ry - (s * rx + c * ry))
    square = cos * cos + sin * sin
    point_x, point_y = (cos * x + sin * y) / square, (cos * y - sin * x) / square
    bodies = [
        body._replace(
            rx=point_x + rx,
            ry=point_y + ry,
            cos=c * body.cos + s * body.sin,
            sin=c * body.sin - s * body.cos,
        )
        for body, rx, ry, c, s in turned
    ]
    c, s = moved[8:]
    size = (c * c + s * s) ** 0.5
    nx, ny = (c * contact.nx + s * contact.ny) / size, (c * contact.ny - s * contact.nx) / size
    return contact._replace(nx=nx, ny=ny), bodies[0], bodies[1]


@lru_cache(maxsize=64)
def _loop(compiled: Callable[..., Any], settings: tuple[Any, ...]) -> Any:
    return compiled(advance, _FIXED, _MOVING, settings)


def float_run(settings: Settings, compiled: Callable[..., Any]) -> Run:
    """Step through one case of floats; ``compiled`` makes a loop of floats from a step."""
    moves, wheels = settings.geometry != "fixed", (settings.wheels_a, settings.wheels_b)
    most = 40 * settings.steps

    def run(fixed: Fixed, moving: Moving, engaging: bool, note: Any) -> Moving:
        if not moving[2].active:
            return moving
        step = _loop(compiled, (engaging, moves, *wheels))
        return _moving_of(
            step(
                [v for part in fixed for v in part],
                [v for part in moving for v in part],
                most,
                note,
            )
        )

    return run


def block_run(settings: Settings, compiled: Callable[..., Any]) -> Run:
    """Step through a block of arrays, and through its last cases one by one; ``compiled`` makes a
    loop of floats from a step.
    """
    moves, one = settings.geometry != "fixed", float_run(settings, compiled)

    def run(fixed: Fixed, moving: Moving, engaging: bool, note: Any) -> Moving:
        for _ in range(40 * settings.steps):
            active = moving[2].active
            count = np.count_nonzero(active)
            if not count:
                break
            if count <= _LEAST:
                return _one_by_one(one, fixed, moving, engaging)
            if 2 * count < active.size:
                # Most have ended: go on without them.
                whole: Moving = put(
                    moving,
                    active,
                    run(cases_of(fixed, active), cases_of(moving, active), engaging, note),
                )
                return whole
            moving = advance(*fixed, *moving, engaging, moves, settings.wheels_a, settings.wheels_b)
        return moving

    return run


def _one_by_one(run: Run, fixed: Fixed, moving: Moving, engaging: bool) -> Moving:
    """Step through the active cases of a block as floats."""
    lost = Motion(*[nan] * len(Motion._fields))
    nowhere: Moving = (
        lost,
        lost,
        Passing(*[nan] * len(Passing._fields))._replace(sticks=False, active=False),
    )

    def ended(at: Any) -> Moving:
        try:
            return run(_case_of(fixed, at), _case_of(moving, at), engaging, None)
        except ArithmeticError:
            # As where arrays are divided by 0.
            return nowhere

    some = np.flatnonzero(moving[2].active)
    numbers = zip(
        *([value for part in one for value in part] for one in map(ended, some)), strict=True
    )
    whole: Moving = put(moving, some, _moving_of([np.array(column) for column in numbers]))
    return whole


def _case_of(parts: Any, at: Any) -> Any:
    """One case of the arrays in a tuple, as floats and truths."""
    if isinstance(parts, tuple):
        values = (_case_of(part, at) for part in parts)
        return type(parts)(*values) if hasattr(parts, "_fields") else tuple(values)
    return parts[at].item() if isinstance(parts, np.ndarray) else parts

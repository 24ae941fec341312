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
# With this part of the steps it is found how the end changes with the start, where that has to move
# by no more than so many times what is near enough: the change is found to a few hundredths.
_DIFFERENCE, _NOT_FAR, _DIFFERENCES, _BLUR = 0.1, 20.0, 4, 0.1
# A friction whose product with a force of 0 is 0.
_MOST_FRICTION = 1e150
# Rounding of a sum over the steps of a contact, as a share.
_ROUNDED = 1e-12
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
    e, (nx, ny), steps = restitution, normal, run(settings)
    own = [_own(body, *point) for body in bodies]
    (a, on_a), (b, on_b) = own
    place = Place(nx, ny, a.rx, a.ry, b.rx, b.ry)
    closing_speed, _ = approach(place, on_a, on_b)
    k_nn, k_nt, k_tt = compliance(place, a, b)
    yields = k_nn > (64.0 * EPS) ** 2 * (k_nn + k_tt)
    mass, closing = 1.0 / select(yields, k_nn, 1.0), select(closing_speed > 0.0, closing_speed, 1.0)
    swing = 0.5 * pi * (1.0 + e)
    duration = spring if settings.timed else swing * (mass / spring) ** 0.5
    length = closing * duration
    weight = gravity * (duration / closing)
    (a, on_a), (b, on_b) = (
        (
            scaled(body, numbers[7], mass, length, weight, held),
            Motion(motion.vx / closing, motion.vy / closing, motion.spin * duration),
        )
        for body, motion, numbers, held in (
            (a, on_a, bodies[0], tyres[0]),
            (b, on_b, bodies[1], tyres[1]),
        )
    )
    step = 1.0 / settings.steps
    back = e**0.5 * step
    soonest = 0.6 * e / (1.0 + e)
    fixed_a, fixed_b = ((body.per_mass == 0.0) & (body.per_inertia == 0.0) for body in (a, b))
    contact = Contact(
        swing * swing,
        e,
        select(friction < _MOST_FRICTION, friction, _MOST_FRICTION),
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
    start = [Motion(*(value + zero for value in motion)) for motion in (on_a, on_b)]
    none = zero != zero
    passing = Passing(*(zero for _ in Passing._fields))._replace(
        c=1.0 + zero, sticks=none, active=none ^ True
    )
    moving: Moving = start[0], start[1], passing
    begun = (contact, a, b), moving
    converged: Any = True
    if settings.geometry == "maximum_engagement":
        begun, engaged, converged = _found(
            *begun, steps, (closing_speed > 0.0) & yields, settings.steps, note
        )
    fixed, moving = begun
    contact, a, b = fixed
    first = place_of(contact, a, b, *moving)
    closing_before, slip_before = approach(first, *moving[:2])
    if settings.geometry != "maximum_engagement":
        moving = *moving[:2], passing._replace(closing=closing_before, active=closing_before > 0.0)
        engaged = steps(fixed, moving, True, None if note is None else note.append)
    _, parting = force_back(contact, engaged[2].crush, engaged[2].deepest)
    more = (engaged[2].crush > parting) & (engaged[2].time < LONGEST)
    moving = steps(
        fixed,
        (*engaged[:2], engaged[2]._replace(active=more)),
        False,
        None if note is None else note.append,
    )
    passing = moving[2]
    owed = select(passing.owed > 0.0, passing.owed, 0.0)
    on_a, on_b = after = (
        braked(a, moving[0], owed, settings.wheels_a),
        braked(b, moving[1], owed, settings.wheels_b),
    )
    separating, slip_after = approach(place_of(contact, a, b, on_a, on_b, passing), on_a, on_b)
    if isinstance(note, Noted):
        note[-1:] = [(*on_a, *on_b, *passing)]
    most = contact.stiffness * passing.deepest
    absorbed = 0.5 * most * passing.deepest
    impulse, energy = mass * closing, mass * closing * closing
    x, y = passing.impulse_x * impulse, passing.impulse_y * impulse
    found: dict[str, Any] = {
        "closing_speed": closing_before * closing,
        "slip_before": slip_before * closing,
        "slip_after": slip_after * closing,
        "normal_impulse": nx * x + ny * y,
        "tangential_impulse": nx * y - ny * x,
        "compression_impulse": (nx * engaged[2].impulse_x + ny * engaged[2].impulse_y) * impulse,
        "sticks": passing.sticks,
        "effective_mass": mass + 0.0 * zero,
        "coupling": k_nt + 0.0 * zero,
        "energy_loss_normal": passing.work_n * energy,
        "energy_loss_tangential": passing.work_t * energy,
        "energy_loss": (passing.work_n + passing.work_t) * energy,
        "impulse_x": x,
        "impulse_y": y,
        "separation_speed": -separating * closing,
        "energy_absorbed": absorbed * energy,
        "duration": passing.time * duration,
        "peak_force": most * (impulse / duration),
        "max_crush": passing.deepest * length,
        "engaged_time": engaged[2].time * duration,
    }
    there = place_of(contact, a, b, *engaged)
    found["common_velocity"] = closing * (
        there.nx * (engaged[0].vx - engaged[0].spin * there.ay)
        + there.ny * (engaged[0].vy + engaged[0].spin * there.ax)
    )
    for label, sign, body, before, most_engaged, end in zip(
        "ab", (-1.0, 1.0), (a, b), start, engaged, after, strict=False
    ):
        for prefix, motion, at in (
            ("compression", most_engaged, engaged[2]),
            ("delta", end, passing),
        ):
            found[f"{prefix}_vx_{label}"] = (
                body.per_mass * (sign * at.impulse_x + motion.tyre_x) * closing
            )
            found[f"{prefix}_vy_{label}"] = (
                body.per_mass * (sign * at.impulse_y + motion.tyre_y) * closing
            )
            found[f"{prefix}_yaw_rate_{label}"] = (motion.spin - before.spin) / duration
        found[f"tyre_impulse_x_{label}"] = end.tyre_x * impulse
        found[f"tyre_impulse_y_{label}"] = end.tyre_y * impulse
        found[f"tyre_moment_{label}"] = end.tyre_yaw * (impulse * length)
        found[f"tyre_loss_{label}"] = -end.tyre_work * energy
        found[f"peak_acceleration_{label}"] = end.acceleration**0.5 * (closing / duration)
        # The places given are those of maximum engagement, or of the start.
        given = most_engaged if settings.geometry == "maximum_engagement" else before
        found[f"moved_x_{label}"] = (end.dx - given.dx) * length
        found[f"moved_y_{label}"] = (end.dy - given.dy) * length
        found[f"turn_c_{label}"] = end.c * given.c + end.s * given.s
        found[f"turn_s_{label}"] = end.s * given.c - end.c * given.s
    total = sum((0.0 * value for value in found.values()), start=0.0 * length)
    finite = total - total == 0.0
    # Levers in units of a contact that is so short overflow, and no start can be found then.
    reach = sum(one.per_inertia * (one.rx * one.rx + one.ry * one.ry) for one in (a, b))
    loss = passing.work_n + passing.work_t
    status = first_status(
        (yields ^ True, Status.IMMOVABLE),
        (closing_speed < 0.0, Status.SEPARATING),
        (closing_speed == 0.0, Status.GRAZING),
        (reach - reach != 0.0, Status.OUT_OF_RANGE),
        (converged ^ True, Status.NO_START),
        (closing_before <= 0.0, Status.SEPARATING),
        (finite ^ True, Status.OUT_OF_RANGE),
        (passing.deepest <= 0.0, Status.NO_SLIP_PULLS),
        (passing.time >= LONGEST, Status.ENDLESS_CONTACT),
        # What the steps err by, near a restitution of 1, beyond rounding.
        (loss < -_ROUNDED * absorbed, Status.ENERGY_GAIN),
    )
    if isinstance(note, Noted) and status <= Status.ENERGY_GAIN:
        found["history"] = _history(
            note, contact, start, closing, duration, length, impulse / duration
        )
    return Passed(status=status, **found)


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
        rows += rows[:, time : time + 1] / was[0, time] * (end - was)
        self[:] = map(tuple, rows.tolist())


def _history(note: Noted, contact: Contact, start: list[Motion], *units: float) -> tuple[Any, ...]:
    """Time, force, crush, delta-V of A and B, and their yaw rates, at the start and after every
    step.
    """
    closing, duration, length, newton = units
    on_a, on_b, passing = _moving_of(
        np.array([(*start[0], *start[1], *Passing()), *note], dtype=np.float64).T
    )
    crush, deepest = passing.crush, passing.deepest
    with np.errstate(all="ignore"):
        force = np.where(
            crush < deepest, force_back(contact, crush, deepest)[0], contact.stiffness * deepest
        )
    if contact.restitution == 0.0 or crush[-1] < deepest[-1]:
        force[-1] = 0.0
    return (
        passing.time * duration,
        force * newton,
        crush * length,
        *(np.hypot(body.vx - body.vx[0], body.vy - body.vy[0]) * closing for body in (on_a, on_b)),
        *(body.spin / duration for body in (on_a, on_b)),
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


def _found(
    fixed: Fixed,
    moving: Moving,
    run: Run,
    usable: Any,
    steps: int,
    note: Any,
) -> tuple[tuple[Fixed, Moving], Moving, Any]:
    """The geometry at first contact for which that given is reached at maximum engagement, with the
    motions there.

    What the bodies move and turn until then is guessed, and corrected by what they do, with the
    step of a secant: first with few steps, as their error hardly matters, then with more, and with
    all until what is reached is near enough. Where the first time with all steps comes near, what a
    last correction changes is worked out with few steps, and added to what all of them reached.
    """
    on_a, on_b, passing = moving
    names = ("dx", "dy", "c", "s")
    guess = [*(getattr(one, name) for one in (on_a, on_b) for name in names), passing.c, passing.s]
    left: Any = usable & (passing.closing == passing.closing)
    older: tuple[tuple[Any, ...], tuple[Any, ...]] | None = None

    def ran(step: Any, from_here: list[Any], to: Any) -> tuple[Fixed, Moving, Any, list[Any]]:
        """Start, end, whether they approach there, and what is reached."""
        start = _moved_back(fixed[0]._replace(step=step), *fixed[1:], from_here)
        closing, _ = approach(place_of(*start, *moving), on_a, on_b)
        before = passing._replace(closing=closing, active=(closing > 0.0) & left)
        end = run(start, (on_a, on_b, before), True, to)
        reached = [*(getattr(one, name) for one in end[:2] for name in names), end[2].c, end[2].s]
        return start, end, closing > 0.0, reached

    def followed(step: Any) -> tuple[Fixed, Moving, Any, list[Any], list[Any]]:
        """Start, end, whether they approach there, by how much they miss, and what by rights should
        be the next guess.
        """
        nonlocal older
        start, end, approaching, reached = ran(step, guess, None if note is None else note.append)
        off = [new - old for new, old in zip(reached, guess, strict=True)]
        trial = reached if older is None else _secant(reached, off, *older)
        older = tuple(off), tuple(reached)
        return start, end, approaching, off, trial

    def moved_on(off: list[Any], trial: list[Any]) -> tuple[Moving, Moving, list[Any], Any]:
        """With few steps the ends from here and from where all steps would arrive by what few say,
        that start, and whether they do.
        """
        nonlocal left, older
        every, step = left, 1.0 / (max(_DIFFERENCE, _PARTS[0]) * fewest * steps)
        whole = [now + miss for now, miss in zip(guess, off, strict=True)]
        _, here, _, were = ran(step, guess, None)
        there, hits = here, every ^ every
        for _ in range(_DIFFERENCES):
            _, end, approaching, are = ran(step, trial, None)
            there = _where(left, end, there)
            reached = [one + (now - was) for one, now, was in zip(whole, are, were, strict=True)]
            missed = [now - then for now, then in zip(reached, trial, strict=True)]
            moved: Any = sum(abs(then - now) for then, now in zip(trial, guess, strict=True))
            far: Any = sum(abs(one) for one in missed) + _BLUR * moved
            hits = hits | (left & approaching & (far <= near))
            left = every & (hits ^ True)
            if not np.any(left):
                break
            ahead = reached if older is None else _secant(reached, missed, *older)
            # The other cases of a block have not been followed here: their secant stays.
            older = _where(left, (tuple(missed), tuple(reached)), older)
            trial = [select(left, new, old) for new, old in zip(ahead, trial, strict=True)]
        left = every
        return here, there, trial, hits

    fewest = max(_FEWEST / _PARTS[0] / steps, 1.0)
    for part in _PARTS:
        if part * fewest < 0.5:
            *_, guess = followed(1.0 / (part * fewest * steps))
    near = min(_NEAR * (100.0 / steps) ** 3.0, _NEAREST)
    begun: Fixed | None = None
    engaged = moving
    for _ in range(_CORRECTIONS):
        if note is not None:
            note.clear()
        start, end, approaching, off, trial = followed(fixed[0].step)
        # Of a block only the cases that have not arrived are followed again.
        begun, engaged = (
            (start, end)
            if begun is None
            else (_where(left, start, begun), _where(left, end, engaged))
        )
        far: Any = sum(abs(one) for one in off)
        left = left & (((far <= near) & approaching) ^ True)
        if not np.any(left):
            break
        close = left & approaching & (far <= _NOT_FAR * near)
        if np.any(close):
            every, left = left, close
            here, there, trial, hits = moved_on(off, trial)
            if np.any(hits):
                begun = _where(hits, _moved_back(*fixed, trial), begun)
                later = _shifted(fixed[1:], moving, engaged, (here, there))
                if note is not None:
                    note.shift(hits, later, engaged)
                engaged = _where(hits, later, engaged)
            left = every & (hits ^ True)
            if not np.any(left):
                break
        guess = [select(left, new, old) for new, old in zip(trial, guess, strict=True)]
    return (begun or fixed, moving), engaged, usable & (left ^ True)


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

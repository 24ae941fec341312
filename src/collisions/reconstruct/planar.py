"""``planar``: reconstructs the motion before an impact from the motion after, rotation included.

An impact run backwards in time is again an impact: velocities change sign, closing and separation
exchange places, and the impulse stays the same. So every origin of an end state is that state less
a candidate impulse; the forward kernel then says whether it leads there.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Any, Literal, NamedTuple, TypeAlias, get_args

import numpy as np

from ..engine.blocks import Part, in_parts, is_one_part
from ..impact.impact import Impact
from ..impact.inputs import TYRES, Inputs, Law, OnFailure, part_of, part_of_inputs, read_inputs
from ..impact.instant import LOOKED_AROUND, in_interval
from ..impact.models import ECCENTRIC
from ..impact.reconstruction import Reconstruction
from ..impact.run import error_of, solve_inputs
from ..impact.time_resolved_inputs import read_lasting
from ..impact.tyres_stop import state_tyres_stop
from ..kernels.contact_laws import BRACH, CRITICAL_FRACTION, FRICTION, IMPULSE_RATIO, KUDLICH_SLIBAR
from ..kernels.status import Status
from ..messages.errors import (
    AmbiguousSolutionError,
    CollisionsError,
    CollisionsWarning,
    IllConditionedWarning,
    InputError,
    OutOfRangeWarning,
)
from ..messages.hints import hinted
from ..messages.warning import quietly, state_of_study, warn_of_cases
from ..quantities.reading import ArgumentReader
from ..quantities.refusals import one_of
from ..quantities.tables import Sentences
from ..quantities.units import Input, Pair
from ..vehicle.drag import GRAVITY
from ..vehicle.tyres import Tyres
from ..vehicle.vehicle import Vehicle, moved
from .common import (
    Cases,
    exactly,
    finish,
    input_faults,
    numbers_by_name,
    read_amounts,
    run_forward,
    split_texts,
    state_instant,
    state_motion,
    state_other,
)
from .lasting import misses_of_impacts, numbers_of_times, settle, tyre_faults
from .origins import End, Given, Origin
from .speeds_algebra import shares_critical

Regime: TypeAlias = Literal["frictionless", "sliding", "sticking", "given"]
_REGIMES = get_args(Regime)
_MOTION = ("vx", "vy", "speed", "course", "yaw_rate")
# Below 0 by no more than this, a restitution that was solved for is 0.
_NO_RESTITUTION = 1e-9
# Of the speeds: motions that differ by no more are one.
_ONE_ORIGIN = 1e-6
# From so many motions before, spread over what the tyres can change, other origins are looked for:
# a tyre pulls to one side or to the other with the sign of a slip that may be small. Half as many
# miss an origin in one of a hundred random crashes, these in one of a thousand.
_STARTS = 16
# Multiples of these powers, modulo 1, fill four dimensions evenly.
_EVENLY = 1.0 / 1.1673039782614187 ** np.arange(1, 5)
_NEARLY_STICKING = (
    0.05  # of the difference between both directions of sliding: a smaller slip may be 0
)


@hinted
def planar(
    a_after: Vehicle,
    b_after: Vehicle,
    *,
    normal: Input | tuple[Input, Input],
    point: Pair,
    restitution: Input | None = None,
    closing_speed: Input | None = None,
    energy_loss: Input | None = None,
    friction: Input | None = None,
    impulse_ratio: Input | None = None,
    critical_fraction: Input | None = None,
    law: Law = "brach",
    regime: Regime | None = None,
    incomplete: bool = False,
    duration: Input | None = None,
    tyres_a: Tyres | None = None,
    tyres_b: Tyres | None = None,
    on_failure: OnFailure | None = None,
) -> Impact:
    """The impact that ended in these motions: ``eccentric`` backwards.

    The states after, the contact and the material determine the states before, except where the
    impact has erased them. A contact that ended without slip under "brach", or at rest under either
    law, keeps no trace of the slip before it; a plastic impact leaves no trace of the closing
    speed, so that it or the energy loss must be known; and an end state may have two origins. Such
    cases are refused, with any answers in ``solutions``; the message says what would decide. The
    theory is eqs 10 to 19 of "Application of Impulse Momentum Theory to Vehicle Collisions" with
    friction, solved for the motion before.

    With ``duration`` and ``tyres_a``, ``tyres_b`` the answer is the one for which ``eccentric``
    with the same arguments ends in these motions and has what else is known: the answer of the
    instant, which decides between origins, is refined to it. Since a tyre pulls to one side or the
    other with the sign of a slip that may be small, several motions before may end so: they are
    looked for from motions around that answer, as far as the tyres reach. What point and normal do
    while the contact lasts is left out, as it is there.

    Parameters
    ----------
    a_after, b_after : Vehicle
        The vehicles just after separation, with yaw inertia and position as for ``eccentric``.
    normal : angle [rad] or tuple (nx, ny)
        Direction from A into B.
    point : pair [m]
        Contact point.
    restitution : float, str, Quantity or array [1], optional
        Coefficient of restitution, above 0. Exactly one of restitution, closing speed and energy
        loss is given.
    closing_speed : float, str, Quantity or array [m/s], optional
        Speed at which the contact points approached along the normal, > 0.
    energy_loss : float, str, Quantity or array [J], optional
        Energy dissipated, >= 0 (not the energy absorbed at maximum crush).
    friction, impulse_ratio, critical_fraction : float, str, Quantity or array [1], optional
        Exactly one, as for ``eccentric``.
    law : {"brach", "kudlich-slibar"}, optional
        How restitution acts and what friction does, as for ``eccentric``.
    regime : {"frictionless", "sliding", "sticking", "given"}, optional
        How the contact ended, where that decides between two origins: a value of ``Impact.regime``.
    incomplete : bool, optional
        Whether the restitution may be negative (above -1), as for ``eccentric``: the contact points
        then go on approaching.
    duration, tyres_a, tyres_b
        As for ``eccentric``: how long the contact lasts, and the wheels that act on the ground
        meanwhile; one without has no tyre forces, and ``.statements`` say what they would change.
        An ``energy_loss`` is then that of the contact, without what the tyres take.
    on_failure : {None, "raise", "nan"}, optional
        What to do with a refused case of a batch.

    Returns
    -------
    Impact
        The result of ``eccentric`` for the states found. ``reconstruction.condition`` is (1+e)/e
        for a given restitution and for a contact that sticks under "kudlich-slibar"; otherwise it
        is 1 for a closing speed, and at most 2 for an energy loss. Where a slip may be zero (see
        below) it is the jump divided by that slip, or infinite. Impulse and energy keep all their
        digits even where the closing speed is tiny: they are computed from
        ``reconstruction.contact_velocity``, not from the rounded motions before. With tyres the
        condition is that of the instant, and the contact velocity that of the motions found.

    Raises
    ------
    InputError
        An argument that cannot be used.
    AmbiguousSolutionError
        More than one origin fits; all are in ``solutions``.
    NoSolutionError
        The contact points do not separate, or by no more than rounding; the contact stuck and says
        nothing about the slip before; or no motion before the impact ends in these motions, or
        none was found from which the contact ends so while the tyres act.

    Warns
    -----
    IllConditionedWarning
        The slip after the impact is so small that it may be zero: under "brach" the answer then
        jumps with its sign, or is the only end of a range that is open on the side where friction
        jams.
    OutOfRangeWarning
        With ``closing_speed`` or ``energy_loss``: the contact points still approach after the
        impact, by at most 1 percent of the closing speed, and were taken to stay together.

    Examples
    --------
    >>> import collisions as col
    >>> a = col.Vehicle(mass=1100, vx=20.0, yaw_inertia=1800, x=0.0, y=0.0)
    >>> b = col.Vehicle(mass=950, vy=16.0, yaw_inertia=1500, x=2.5, y=0.4)
    >>> contact = dict(normal=0.0, point=(1.6, 0.3), friction=0.2)
    >>> end = col.eccentric(a, b, 0.2, **contact)
    >>> start = col.reconstruct.planar(end.a.after, end.b.after, restitution=0.2, **contact)
    >>> round(start.a.before.vx, 12), round(start.b.before.vy, 12)
    (20.0, 16.0)
    """
    given = exactly(
        {"restitution": restitution, "closing_speed": closing_speed, "energy_loss": energy_loss},
        1,
        "planar",
    )
    (kind,) = given
    reader = ArgumentReader()
    times: dict[str, Any] = {}
    if duration is not None or tyres_a is not None or tyres_b is not None:
        times = read_lasting(reader, "planar", a_after, b_after, duration, (tyres_a, tyres_b))
    amounts = {} if kind == "restitution" else read_amounts(reader, given)
    speed = amounts.get("closing_speed")
    if isinstance(speed, float) and speed == 0.0:
        reader.refuse(
            InputError(
                "closing_speed must be > 0, got 0: without closing, no impact",
                code="not_positive",
                argument=kind,
            )
        )
    if regime is not None and (not isinstance(regime, str) or regime not in _REGIMES):
        reader.refuse(one_of("regime", _REGIMES, regime, code="bad_regime"))
    e = given.get("restitution", 0.0)
    arguments = (
        a_after,
        b_after,
        e,
        normal,
        point,
        (friction, impulse_ratio, critical_fraction),
        law,
    )
    beside = amounts | numbers_of_times(times)
    inputs = read_inputs("eccentric", arguments, reader.problems, beside.values(), incomplete)
    inputs = replace(inputs, **times)
    if inputs.law not in (BRACH, KUDLICH_SLIBAR):
        raise InputError(
            f"reconstruct.planar cannot go back under law {inputs.law!r}; give {BRACH!r} or "
            f"{KUDLICH_SLIBAR!r}, or fit a model with this law to what is known after "
            "(`reconstruct.fit`)",
            code="law_not_reversible",
            argument="law",
        )
    if kind == "energy_loss" and shares_critical(inputs.rule, inputs.rule_value):
        raise InputError(
            "a critical_fraction between 0 and 1 cannot be used with energy_loss; give "
            "`impulse_ratio=`, or the restitution or closing_speed instead of the energy",
            code="bad_combination",
            argument="critical_fraction",
        )
    numbers = (amounts or {kind: inputs.restitution}) | numbers_by_name(inputs, "_after")
    cases = Cases.of(numbers | numbers_of_times(times))
    arrays = {name: np.asarray(number, dtype=np.float64) for name, number in numbers.items()}
    pinned = a_after.pivot is not None, b_after.pivot is not None
    with np.errstate(all="ignore"):
        used, say = inputs.law or BRACH, Sentences((*inputs.texts, *reader.texts.values()))
        after = Given(arrays, kind, inputs.rule, used, pinned, cases.eps, incomplete, say)
        return _answer(
            cases,
            after,
            replace(inputs, given={**reader.texts, **(inputs.given or {})}),
            regime,
            on_failure,
        )


class _Looked(NamedTuple):
    """An end state, its origins as those of an instant, and those that count."""

    end: End
    instants: list[Origin]
    origins: list[Origin]


class _Found(NamedTuple):
    """Of each case its status, how many origins fit, the first of them, and how sure it is: where
    and by how much the motions after were changed, and where the slip after may be none.
    """

    status: Any
    count: Any
    vx_a: Any
    vy_a: Any
    yaw_rate_a: Any
    vx_b: Any
    vy_b: Any
    yaw_rate_b: Any
    restitution: Any
    closing_speed: Any
    slip_before: Any
    condition: Any
    pressed: Any
    approach: Any
    nearly: Any
    slip_after: Any
    slip_least: Any
    slip_most: Any


def _answer(
    cases: Cases, after: Given, inputs: Inputs, regime: Regime | None, on_failure: Any
) -> Impact:
    texts = dict(inputs.given or {})
    numbers, kind, rule = after.numbers, after.kind, after.rule
    known: dict[str, Any] = {name: numbers[name] for name in (kind, rule)}
    staying: list[Any] = []
    for label, body in (("a", inputs.a), ("b", inputs.b)):
        # The motion after differs from that of the vehicles before.
        of_body, of_motion = split_texts(body, _MOTION)
        staying.append(of_body)
        texts |= {f"{label}_after.{name}": text for name, text in of_motion.items()}
        by_speed = {"speed", "course"} <= of_motion.keys()
        names = ("speed", "course", "yaw_rate") if by_speed else ("vx", "vy", "yaw_rate")
        known |= {f"{label}_after.{name}": getattr(body, name) for name in names}
    inputs = replace(inputs, given=texts or None)
    together = is_one_part(cases.shape or ())
    whole = _looked(after, inputs, regime, cases.shape or ()) if together else None

    def work(part: Part) -> dict[str, Any]:
        there = after._replace(numbers={name: part.of(one) for name, one in numbers.items()})
        own = part_of_inputs(inputs, part.of) if inputs.tyres else inputs
        looked = _looked(there, own, regime, part.shape)
        return _backwards(Cases(part.shape, cases.dtype), looked, own, regime)._asdict()

    found = (
        _Found(**in_parts(work, cases.shape or ()))
        if whole is None
        else _backwards(cases, whole, inputs, regime)
    )
    sure = np.equal(found.status, Status.OK)

    def origin_of(
        velocity: Sequence[Any], condition: Any, count: Any, where: Any
    ) -> Reconstruction:
        velocity = () if inputs.tyres else velocity
        return cases.reconstruction(
            "planar", (kind, rule), condition, count, velocity, where, given=known
        )

    def inputs_of(motions: Sequence[Any], restitution: Any, keep: Any) -> Inputs:
        bodies = []
        for body, motion, given in zip((inputs.a, inputs.b), motions, staying, strict=True):
            vx, vy, yaw_rate = (cases.where(keep, part) for part in motion)
            bodies.append(moved(body, vx, vy, yaw_rate, given))
        e = inputs.restitution if kind == "restitution" else cases.where(keep, restitution)
        return replace(inputs, a=bodies[0], b=bodies[1], restitution=e)

    def refusal() -> CollisionsError:
        assert whole is not None  # of a single case
        end, instants, origins = whole
        stuck = found.status == Status.STICK_INVERSE
        # The solutions of a range are its ends, whichever regime was given. With tyres they are
        # none, as it is the range of the instant.
        fitting = [one for one in (end.origins(None) if stuck else origins) if one.fits]
        count = math.inf if stuck else len(fitting)
        if inputs.tyres and stuck:
            fitting = []
        elif found.status == Status.CONTRADICTORY and any(one.fits for one in instants):
            return _unsettled()
        solutions = tuple(
            run_forward(
                partial(inputs_of, one.motions, one.restitution),
                Status.OK,
                origin_of(one.contact_velocity, one.condition, count, True),
            )
            for one in fitting
            if count > 1
        )
        error = _refusal(found.status, end, regime, [one.regime for one in fitting], solutions)
        if inputs.tyres and found.status == Status.CONTRADICTORY:
            return _not_found(error.inner, end)
        return error

    def solve_case(index: tuple[int, ...]) -> Impact:
        take = partial(cases.one, index=index)
        contact: dict[str, Any] = {name: take(numbers[name]) for name in (kind, rule)}
        contact |= {
            "law": after.law,
            "normal": tuple(take(numbers[f"normal[{i}]"]) for i in range(2)),
            "point": tuple(take(numbers[f"point[{i}]"]) for i in range(2)),
        }
        contact |= {"regime": regime, "incomplete": after.incomplete}
        contact |= {name: part_of(getattr(inputs, name), take) for name in ("duration", *TYRES)}
        return planar(part_of(inputs.a, take), part_of(inputs.b, take), **contact)

    _warn(cases, found, after.say, whole)
    if inputs.tyres:
        state_of_study(f"planar with tyres: {LOOKED_AROUND}", "looked_for")
        state_motion("planar")
        state_other("planar", inputs.tyres, (inputs.a.mass, inputs.b.mass))
    else:
        state_instant("planar")
    velocity = found.closing_speed, found.slip_before
    origin = origin_of(velocity, found.condition, found.count, sure)
    if np.any(found.nearly):
        slips = (cases.where(sure, one) for one in (found.slip_least, found.slip_most))
        origin = replace(origin, slip_if_stuck=tuple(slips))
    motions = found[2:5], found[5:8]
    before = partial(inputs_of, motions, found.restitution)
    impact = finish(before, found.status, origin, on_failure, refusal, solve_case)
    state_tyres_stop(impact)
    return impact


def _looked(after: Given, inputs: Inputs, regime: Regime | None, shape: tuple[int, ...]) -> _Looked:
    end = End(after)
    origins = instants = end.origins(regime)
    if inputs.tyres:
        origins = _while_tyres_act(end, inputs, regime, shape)
    return _Looked(end, instants, origins)


def _backwards(cases: Cases, looked: _Looked, inputs: Inputs, regime: Regime | None) -> _Found:
    end, _, origins = looked
    count = sum((one.fits.astype(int) for one in origins), np.zeros((), dtype=int))
    no_trace = end.forgets_slip() & ((regime != "sliding") | end.always_sticks())
    plastic = np.equal(end.known, 0.0) & (end.kind == "restitution")
    if end.kind == "restitution":
        parts = np.where(
            np.less(end.known, 0.0), end.separation < -end.rounding, end.separation > end.rounding
        )
    else:
        parts = end.incomplete | (end.separation > -end.rounding)
    status = cases.first_status(
        (
            *input_faults(end.numbers, end.incomplete),
            *tyre_faults(inputs.duration, inputs.tyres),
            (end.status == Status.IMMOVABLE, Status.IMMOVABLE),
            (
                end.singular & (end.bound > 0.0) & (end.rule != IMPULSE_RATIO),
                Status.SINGULAR_CONTACT,
            ),
            (plastic, Status.INVERSE_E0),
            (np.logical_not(parts), Status.NOT_SEPARATING),
            (no_trace, Status.STICK_INVERSE),
            (count == 1, Status.OK),
            (count > 1, Status.AMBIGUOUS_INVERSE),
            (True, Status.CONTRADICTORY),
        )
    )
    sure = np.equal(status, Status.OK)
    first = _first_that_fits(origins)
    low, high = end.slip_range()
    jump = high - low
    # For a half-open range, the distance to its one end counts as half its length.
    reach = np.where(
        np.isinf(jump), 2.0 * np.minimum(abs(low - end.slip), abs(high - end.slip)), jump
    )
    nearly = sure & (abs(end.slip) < _NEARLY_STICKING * reach)
    condition = np.where(nearly, np.maximum(first.condition, jump / abs(end.slip)), first.condition)
    return _Found(
        status,
        count,
        *first.motions[0],
        *first.motions[1],
        first.restitution,
        *first.contact_velocity,
        condition,
        sure & end.pressed,
        end.approach,
        nearly,
        end.slip,
        np.where(nearly, low, np.nan),
        np.where(nearly, high, np.nan),
    )


def _while_tyres_act(
    end: End, inputs: Inputs, regime: str | None, shape: tuple[int, ...]
) -> list[Origin]:
    """The origins of the same end for a contact in which the tyres act, each once.

    Every origin of the instant is refined, also those that do not quite lead to this end, as one
    that slides may stick while the tyres act; and from other motions before, since several may end
    in these motions while the tyres act.
    """
    found: list[Origin] = []
    for origin in end.candidates(nearest=True):
        for refined in _refined(origin, end, inputs, shape):
            new = np.asarray(refined.fits)
            if regime is not None:
                new = new & np.equal(regime, refined.regime)
            for earlier in found:
                apart = sum(
                    abs(part - other)
                    for motion, another in zip(refined.motions, earlier.motions, strict=True)
                    for part, other in zip(motion, another, strict=True)
                )
                new = new & ~(earlier.fits & (apart <= _ONE_ORIGIN * end.size))
            if np.any(new) or not found:
                found.append(refined._replace(fits=new))
    return found


def _around(inputs: Inputs, motion: Sequence[Any], label: str, shifts: Any) -> list[Any]:
    """A motion before and others around it, along an axis in front: to the side and in yaw rate by
    shares, (starts, 2), of what the tyres of this vehicle can change; at last straight ahead, as
    most vehicles come.
    """
    tyres, body = inputs.tyres.get(label), getattr(inputs, label)
    vx, vy, spin = (np.asarray(part, dtype=np.float64) for part in motion)
    aside, turn = (share.reshape(-1, *[1] * vx.ndim) for share in shifts.T)
    if tyres is None or body.heading is None:
        return [np.broadcast_to(part, (len(shifts) + 1, *part.shape)) for part in (vx, vy, spin)]
    cos, sin = np.cos(body.heading), np.sin(body.heading)
    ahead = vx * cos + vy * sin
    most = GRAVITY * tyres.friction * inputs.duration
    with np.errstate(all="ignore"):
        turning = most * 0.5 * tyres.wheelbase * np.divide(body.mass, body.yaw_inertia)
    # Tyres do not turn what has no yaw inertia to speak of, or no end of it.
    turning = np.where(np.isfinite(turning), turning, 0.0)
    side = aside * most
    around = vx - side * sin, vy + side * cos, spin + turn * turning
    straight = ahead * cos, ahead * sin, 0.0 * spin
    return [
        np.concatenate((part, last[np.newaxis]))
        for part, last in zip(around, straight, strict=True)
    ]


def _refined(origin: Origin, end: End, inputs: Inputs, shape: tuple[int, ...]) -> list[Origin]:
    """Origins near this one for a contact in which the tyres act, from it and from motions around
    it; some may be one and the same.

    Unknown are the motions before and, where it was not given, the restitution; known the motions
    after and what was given in place of the restitution.
    """
    # The first start is the origin itself.
    shifts = 2.0 * ((0.5 + np.outer(np.arange(_STARTS), _EVENLY)) % 1.0) - 1.0
    speed = end.size + np.where(end.closing > 0.0, end.closing, 0.0)
    start: list[Any] = []
    sizes: list[Any] = []
    for at, label in enumerate("ab"):
        body, pinned = end.bodies[at], end.pinned[at]
        motion = [np.broadcast_to(part, shape) for part in origin.motions[at]]
        around = _around(inputs, motion, label, shifts[:, 2 * at : 2 * at + 2])
        lever = np.hypot(end.p[0] - body[5], end.p[1] - body[6])
        turning = speed / np.where(lever > 0.0, lever, 1.0)
        start += around[2:] if pinned else around
        sizes += [turning] if pinned else [speed, speed, turning]
    free = end.kind != "restitution"
    if free:
        start, sizes = [*start, origin.restitution], [*sizes, 1.0]
    start = [np.broadcast_to(part, (_STARTS + 1, *shape)) for part in start]

    def inputs_at(values: Sequence[Any]) -> Inputs:
        parts = iter(values)
        a, b = (
            moved(body, 0.0, 0.0, next(parts))
            if pinned
            else moved(body, next(parts), next(parts), next(parts))
            for body, pinned in zip((inputs.a, inputs.b), end.pinned, strict=True)
        )
        e = next(parts) if free else inputs.restitution
        # A restitution of 0 may come out a little below it.
        return replace(inputs, a=a, b=b, restitution=e, incomplete=True, given=None)

    def misses(tried: Inputs, answer: Any) -> list[Any]:
        found: list[Any] = []
        for label, body, pinned in zip("ab", end.bodies, end.pinned, strict=True):
            before = getattr(tried, label)
            for name, wanted in zip(("vx", "vy", "yaw_rate"), body[2:5], strict=True):
                if name == "yaw_rate" or not pinned:
                    change = getattr(answer, f"delta_{name}_{label}")
                    found.append((getattr(before, name) + change - wanted) / sizes[len(found)])
        if end.kind == "closing_speed":
            found.append((answer.closing_speed - end.known) / speed)
        elif free:
            scale = np.where(end.known > 0.0, end.known, 1.0)
            found.append((answer.energy_loss - end.known) / scale)
        return found

    highest = [math.inf] * (len(start) - 1) + [1.0] if free else None
    values, fits = settle(misses_of_impacts(inputs_at, misses), start, sizes, highest)
    with quietly():
        answer = solve_inputs(ECCENTRIC, inputs_at(values), "nan")
    e = values[-1] if free else np.broadcast_to(origin.restitution, fits.shape)
    if free and not end.incomplete:
        fits = fits & (e >= -_NO_RESTITUTION)
        e = np.where((e < 0.0) & (e >= -_NO_RESTITUTION), 0.0, e)
    regime: Any = origin.regime
    condition = origin.condition
    if end.rule == FRICTION:
        how = np.where(answer.sticks, "sticking", "sliding")
        regime = np.where(end.bound == 0.0, "frictionless", how)
        # Tyres may have turned the regime of the instant.
        with np.errstate(all="ignore"):
            condition = end.condition_of(regime == "sticking", e)
    conditions = np.broadcast_to(condition, fits.shape)
    parts = iter(values)
    still = np.broadcast_to(0.0 * speed, fits.shape)
    one, other = (
        (still, still, next(parts)) if pinned else (next(parts), next(parts), next(parts))
        for pinned in end.pinned
    )
    regimes = np.broadcast_to(regime, fits.shape)
    return [
        origin._replace(
            regime=regimes[at] if shape else str(regimes[at]),
            motions=(tuple(part[at] for part in one), tuple(part[at] for part in other)),
            restitution=e[at],
            condition=conditions[at],
            fits=fits[at],
        )
        for at in range(_STARTS + 1)
    ]


def _unsettled() -> CollisionsError:
    """The error for an instant that has an origin while the lasting contact has none."""
    return error_of(
        Status.CONTRADICTORY,
        "as an instant the impact has an origin, but none was found from which it ends so while "
        "the tyres act: check duration, the friction and the locks of tyres_a and tyres_b, and the "
        "motions after; without duration and tyres the answer is that of the instant",
    )


def _not_found(as_instant: str, end: End) -> CollisionsError:
    """The error where neither the instant has an origin nor one was found with the tyres."""
    return error_of(
        Status.CONTRADICTORY,
        f"no motion before was found from which the contact ends so while the tyres act: "
        f"{LOOKED_AROUND}. `reconstruct.posterior` with wide priors for the speeds and yaw rates "
        f"before looks everywhere. Without the tyres {as_instant}",
        separation_speed=float(end.separation),
        slip_after=float(end.slip),
        solutions=(),
    )


def _first_that_fits(origins: Sequence[Origin]) -> Origin:
    """The first origin that fits in each case, or the first of all."""
    which = np.argmax(np.stack(np.broadcast_arrays(*(one.fits for one in origins))), axis=0)

    def choose(values: Sequence[Any]) -> Any:
        return (
            tuple(map(choose, zip(*values, strict=True)))
            if isinstance(values[0], tuple)
            else np.take_along_axis(
                np.stack(np.broadcast_arrays(*values, which)[:-1]), which[np.newaxis], axis=0
            )[0]
        )

    _, *parts = zip(*origins, strict=True)
    return Origin("", *map(choose, parts))


def _warn(cases: Cases, found: _Found, say: Sentences, whole: _Looked | None) -> None:
    """Warn where the result depends on the last digits of the measured motion."""
    pressed, nearly = found.pressed, found.nearly
    if np.any(pressed):
        most = float(np.max(np.where(pressed, found.approach, 0.0)))
        what = "the contact points still approach after the impact"
        taken = "taken as 0, a plastic impact, and the motions after changed by as much"
        text = f"{cases.how_many(pressed)}{what}, by up to {say(most, 'speed', 3)}: {taken}"
        warning: CollisionsWarning = OutOfRangeWarning(text, code="nearly_plastic", approach=most)
        warn_of_cases(warning, {f"{what}, by no more than rounding: {taken}": cases.each(pressed)})
    if np.any(nearly):
        where, which = "in a wide range", "follows the sign of that slip"
        if cases.shape is None and whole is not None:
            low, high = whole.end.slip_range()
            where = in_interval(float(low), float(high), lambda end: say(end, "speed", 4))
            which = "is that end of the range" if np.isinf(high - low) else which
        least = float(np.min(np.where(nearly, abs(found.slip_after), np.inf)))
        text = (
            f"{cases.how_many(nearly)}the slip after the impact, "
            f"{say(least, 'speed', 3)}, is so small that it may be none: then the "
            f"contact stuck, and the slip before was anything {where}. The answer {which}; "
            "carry all digits, or decide with `impulse_ratio=` of either sign"
        )
        warning = IllConditionedWarning(text, code="nearly_sticking", slip_after=least)
        sentence = (
            "the slip after the impact is so small that it may be none: then the contact stuck, "
            "and the slip before is open"
        )
        warn_of_cases(warning, {sentence: cases.each(nearly)})


def _refusal(
    status: int, end: End, regime: str | None, regimes: list[str], solutions: tuple[Impact, ...]
) -> CollisionsError:
    """The error for a single case, with the candidates and their regimes; its advice does not lead
    to the same error.
    """
    separation, slip = float(end.separation), float(end.slip)
    match status:
        case Status.AMBIGUOUS_INVERSE:
            return _several(end, regimes, solutions)
        case Status.STICK_INVERSE:
            text = _stuck(end, slip, len(solutions))
        case Status.NOT_SEPARATING:
            text = _not_parting(end, separation)
        case Status.CONTRADICTORY:
            text = _contradiction(end, separation, slip, regime)
        case Status.INVERSE_E0:
            text = (
                "restitution = 0: after a plastic impact nothing is left of the closing speed; "
                f"give {_instead(end)} instead"
            )
        case _:
            text = Status(status).message
    return error_of(status, text, separation_speed=separation, slip_after=slip, solutions=solutions)


def _several(end: End, regimes: list[str], solutions: tuple[Impact, ...]) -> CollisionsError:
    """The error for a single case with several origins, which says what tells them apart."""
    ratios = [float(impact.impulse_ratio) for impact in solutions]
    apart = len({f"{ratio:.4g}" for ratio in ratios}) == len(ratios)
    deciding = [f"`regime={how!r}`" for how in regimes if regimes.count(how) == 1]
    if apart:
        each = " or ".join(
            f"{how} with impulse ratio {ratio:.4g} from a closing speed of "
            f"{end.say(impact.closing_speed, 'speed')}"
            for how, ratio, impact in zip(regimes, ratios, solutions, strict=True)
        )
        deciding.append("`impulse_ratio=` of one of them")
    else:
        # Origins of one regime with tyres: they differ in what the tyres did. To a microradian a
        # second, far below what anybody can know.
        rates = [
            end.say.apart([round(float(one.yaw_rate), 6) + 0.0 for one in states], "yaw rate", 3)
            for states in zip(*((one.a.before, one.b.before) for one in solutions), strict=True)
        ]
        each = " or ".join(
            f"{how}, with yaw rates before of {of_a} (A) and {of_b} (B)"
            for how, of_a, of_b in zip(regimes, *rates, strict=True)
        )
        deciding.append("what is known of the yaw rates before: take the one that it fits")
    return AmbiguousSolutionError(
        f"{len(solutions)} states before end so: {each}`|; all are in .solutions|`; what decides "
        f"is {', or '.join(deciding)}",
        code="ambiguous_inverse",
        solutions=solutions,
    )


def _instead(end: End) -> str:
    """The inputs that could replace the restitution."""
    return (
        "`closing_speed=`"
        if shares_critical(end.rule, end.bound)
        else "`closing_speed=` or `energy_loss=`"
    )


def _jamming_ratio(end: End) -> float:
    """The impulse ratio at which the bodies jam; infinite where none does."""
    return float(-end.k_nn / end.k_nt) if end.k_nt else math.inf


def _stuck(end: End, slip: float, ends: int) -> str:
    jamming = _jamming_ratio(end)
    held = ""
    if ends == 1:
        held = (
            "`|.solutions holds the one end of the range, where friction is just used up; to the "
            f"other side it is open, for impulse ratios towards {jamming:.4g}, where the bodies "
            "jam. |`"
        )
    elif ends:
        held = (
            f"`|.solutions holds the {ends} ends of the range, where friction is just used up. |`"
        )
    low, high = (
        (-float(end.bound), float(end.bound)) if end.rule == FRICTION else (-math.inf, math.inf)
    )
    if math.isfinite(jamming):
        low, high = (max(low, jamming), high) if jamming < 0.0 else (low, min(high, jamming))
    allowed = in_interval(low, high, lambda end: f"{end:.4g}")
    # At rest the slip before is lost under the other law too.
    other = (
        f", or `law={KUDLICH_SLIBAR!r}` if that is the model"
        if end.law == BRACH and abs(end.separation) > end.noise
        else ""
    )
    return (
        f"the contact ended without slip (slip after {end.say(slip, 'speed', 3)}, no "
        f"more than rounding leaves), and under {end.law!r} any slip before may end so: "
        f"the motion across the normal is lost. {held}What decides is `impulse_ratio=`, "
        "the tangential over the normal "
        f"impulse{f' ({allowed})' if allowed else ''}{other}"
    )


def _not_parting(end: End, separation: float) -> str:
    rounding = float(end.rounding)
    if end.kind == "restitution" and abs(separation) <= rounding:
        return (
            "whether the contact points part after the impact cannot be told from rounding: "
            f"separation speed {end.say(separation, 'speed', 3)}, of which rounding may be "
            f"{end.say(rounding, 'speed', 3)}. The restitution says nothing of the closing speed "
            f"then; give {_instead(end)} instead"
        )
    why = f"; for a plastic impact give {_instead(end)}"
    if end.kind != "restitution":
        why = (
            f", and more than a hundredth of the closing speed of "
            f"{end.say(float(end.closing), 'speed')}; check the motions after"
        )
    return (
        f"the contact points do not part after the impact: separation speed "
        f"{end.say(separation, 'speed')} along the normal, which must "
        f"point from A into B{why}"
    )


def _contradiction(end: End, separation: float, slip: float, regime: str | None) -> str:
    """The reason why no origin fits, and a remedy."""
    here = f"separation speed {end.say(separation, 'speed')}, slip after {end.say(slip, 'speed')}"
    given, known, bound = f"`{end.rule}={float(end.bound):g}`", float(end.known), float(end.bound)
    free = "give a finite `friction=`, or `impulse_ratio=`"
    origins = end.origins(None)
    fitting = {one.regime for one in origins if one.fits}
    if regime is not None and (
        fitting or regime not in {one.regime for one in origins if not np.isnan(one.normal)}
    ):
        found = f", the contact ended {' or '.join(sorted(fitting))}" if fitting else ""
        return (
            f"no motion before ends so in the regime {regime!r} under {end.law!r} with this "
            f"{end.rule} and {end.kind}: {here}; leave out `regime={found}`"
        )
    if end.always_sticks():
        return (
            f"with this {end.rule} a contact under {end.law!r} ends without slip, but the slip "
            f"after is {end.say(slip, 'speed')}; if that is an error of measurement, the contact "
            f"stuck and its motion across the normal is lost; {free}"
        )
    if end.kind == "closing_speed" and separation > known:
        return (
            f"the contact points part faster than they met: {here}, "
            f"`closing_speed={end.say(known, 'speed')}`; give at least "
            f"{end.say.at_least(separation, 'speed')}, or `restitution=` instead"
        )
    if end.always_sticks(KUDLICH_SLIBAR):
        return (
            f"with {given} the contact sticks, and under {end.law!r} none that sticks ends so: "
            f"{here}; {free}"
        )
    ratios = {FRICTION: (bound, -bound), IMPULSE_RATIO: (bound,)}.get(end.rule, ())
    if any(end.resistance(ratio) <= 0.0 for ratio in ratios):
        limit = _jamming_ratio(end)
        limit = abs(limit) if end.rule == FRICTION else limit
        return (
            f"{given} jams the bodies in a contact that ends so ({here}); give "
            f"`{end.rule}=` {'below' if limit > 0.0 else 'above'} {limit:.4g}, or check the "
            "yaw rates and the normal"
        )
    if end.kind == "energy_loss":
        # Friction acts against the slip; under "kudlich-slibar" against that of compression, and
        # the one after may be either.
        either = end.rule == IMPULSE_RATIO or end.law != BRACH
        least = min(
            (end.elastic_loss(ratio) for ratio in ratios if either or ratio * slip <= 0.0),
            default=0.0,
        )
        if least > known:
            return (
                f"`energy_loss={end.say(known, 'energy')}` is less than an impact with {given} "
                f"loses that ends so ({here}); give at least "
                f"{end.say.at_least(float(least), 'energy', 7)}, or `restitution=` or "
                "`closing_speed=` instead"
            )
    kind = {"energy_loss": "energy", "closing_speed": "speed"}.get(end.kind, "number")
    other = ", or give `friction=` or `impulse_ratio=`"
    return (
        f"no motion before ends so under {end.law!r} with {given} and "
        f"`{end.kind}={end.say(known, kind)}`: {here}; check the normal and the motions "
        f"after{other if end.rule == CRITICAL_FRACTION else ''}"
    )

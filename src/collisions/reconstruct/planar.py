"""Planar impact backwards, rotation included: from the motion after to the motion before.

Time reversed, an impact is an impact: velocities change sign, closing and separation exchange places and the impulse stays. So
every origin of an end state is a candidate impulse taken off that state; the forward kernel then says whether it leads there.
"""

from __future__ import annotations

import math
from functools import partial
from typing import Any, Literal, TypeAlias, get_args

import numpy as np

from ..amounts import amount
from ..errors import CollisionsError, InputError
from ..impact import Impact, found_by
from ..inputs import Inputs, Law, OnFailure, part_of, read_inputs
from ..kernels.contact_laws import CRITICAL_FRACTION, IMPULSE_RATIO
from ..kernels.status import EPS, Status
from ..models import body_numbers, missing_numbers
from ..provenance import Reconstruction
from ..reading import ArgumentReader
from ..units import Input, Pair, shown
from ..vehicle import Vehicle
from ..warning import quietly
from .common import NUMBERS, Cases, exactly, input_faults, parted, settle
from .origins import End, Origin
from .planar_refusals import plain_refusal, refusal, warn

Regime: TypeAlias = Literal["frictionless", "sliding", "sticking", "given"]
_REGIMES = get_args(Regime)
_MOTION = ("vx", "vy", "speed", "course", "yaw_rate")
_NEARLY_STICKING = 0.05  # of the jump between both ways to slide: a slip so small may be none


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
    on_failure: OnFailure | None = None,
) -> Impact:
    """The impact that ended in these motions: ``eccentric`` backwards.

    The states after, the contact and the material determine the states before, except where the impact has wiped them out. A
    contact that ended without slip under "brach", or at rest under either law, keeps no trace of the slip before; after a
    plastic impact nothing is left of the closing speed, unless it or the energy loss is known; and an end state may have two
    origins. Those are refused, with what there is in ``solutions`` and what would decide. The theory is eqs
    10 to 19 of "Application of Impulse Momentum Theory to Vehicle Collisions" with friction, solved for the motion before.

    Parameters
    ----------
    a_after, b_after : Vehicle
        The vehicles just after separation, with yaw inertia and position as for ``eccentric``.
    normal : angle [rad] or tuple (nx, ny)
        Direction from A into B.
    point : pair [m]
        Contact point.
    restitution : float, str, Quantity or array [1], optional
        Coefficient of restitution, above 0: exactly one of these three.
    closing_speed : float, str, Quantity or array [m/s], optional
        Speed at which the contact points approached along the normal, > 0.
    energy_loss : float, str, Quantity or array [J], optional
        Energy dissipated, >= 0 (not the energy absorbed at maximum crush).
    friction, impulse_ratio, critical_fraction : float, str, Quantity or array [1], optional
        Exactly one, as for ``eccentric``.
    law : {"brach", "kudlich-slibar"}, optional
        How restitution acts and what no slip means.
    regime : {"frictionless", "sliding", "sticking", "given"}, optional
        How the contact ended, where that decides between two origins: a value of ``Impact.regime``.
    on_failure : {None, "raise", "nan"}, optional
        What a refused case of a batch does.

    Returns
    -------
    Impact
        The answer of ``eccentric`` for the states found; ``reconstruction.condition`` is (1+e)/e for a given restitution and
        for a contact that sticks under "kudlich-slibar", else 1 for a closing speed, and at most 2 for an energy loss; where
        a slip may be none, see below, the jump over it, or infinite. Impulse and energy have all digits also where the closing
        speed is tiny: they are worked out from ``reconstruction.contact_velocity``, not from the rounded motions before.

    Raises
    ------
    InputError
        An argument that cannot be used.
    AmbiguousSolutionError
        More than one origin fits; all are in ``solutions``.
    NoSolutionError
        The motions do not part, or by no more than rounding; the contact stuck and says nothing of the slip before; or nothing
        before ends so.

    Warns
    -----
    IllConditionedWarning
        The slip after is so small that it may be none: under "brach" the answer then jumps with its sign,
        or is the one end of a range that is open where friction jams.
    OutOfRangeWarning
        With ``closing_speed`` or ``energy_loss``: the contact points still approach, by at most 1 percent of the closing speed,
        and were taken to stay together.

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
    given = exactly({"restitution": restitution, "closing_speed": closing_speed, "energy_loss": energy_loss}, 1, "planar")
    ((kind, value),) = given.items()
    reader = ArgumentReader()
    known = value if kind == "restitution" else _amount(reader, kind, value)
    if regime is not None and (not isinstance(regime, str) or regime not in _REGIMES):
        reader.refuse(
            InputError(
                f"regime must be one of {', '.join(map(repr, _REGIMES))}, got {shown(regime)}",
                code="bad_regime",
                argument="regime",
            )
        )
    inputs, _ = read_inputs(
        "eccentric",
        a_after,
        b_after,
        known if kind == "restitution" else 0.0,
        normal,
        point,
        (friction, impulse_ratio, critical_fraction),
        law,
        [*reader.problems, *missing_numbers(a_after, b_after, point)],
        (known,),
    )
    e, n, rule, bound, contact = inputs.restitution, inputs.normal, inputs.rule, inputs.rule_value, inputs.point
    bodies = body_numbers(a_after, contact), body_numbers(b_after, contact)
    known = e if kind == "restitution" else known
    everything = {kind: known, rule: bound, "normal[0]": n[0], "normal[1]": n[1]}
    everything |= {f"point[{i}]": part for i, part in enumerate(contact or ())}
    for label, body in zip("ab", bodies, strict=True):
        everything |= {f"{label}_after.{name}": number for name, number in zip(NUMBERS, body, strict=True)}
    everything |= {
        f"{label}_after.heading": body.heading for label, body in (("a", a_after), ("b", b_after)) if body.heading is not None
    }
    if rule == CRITICAL_FRACTION and kind == "energy_loss" and np.any((bound > 0.0) & (bound < 1.0)):
        raise InputError(
            "a critical_fraction between 0 and 1 cannot be used with energy_loss; give impulse_ratio=, or the restitution or "
            "closing_speed instead of the energy",
            code="bad_combination",
            argument="critical_fraction",
        )
    cases = Cases.of(everything)
    arrays = {name: np.asarray(number, dtype=np.float64) for name, number in everything.items()}
    pinned = a_after.pivot is not None, b_after.pivot is not None
    with np.errstate(all="ignore"):
        end = End(arrays, kind, rule, law, pinned, EPS if cases.shape is None else float(np.finfo(cases.dtype).eps))
        told = {**reader.texts, **(inputs.given or {})}
        return _answer(cases, end, a_after, b_after, (e, n, rule, bound, law, contact, told), regime, on_failure)


def _amount(reader: ArgumentReader, kind: str, value: Any) -> Any:
    number = amount(reader, value, "m/s" if kind == "closing_speed" else "J", kind)
    if kind == "closing_speed" and isinstance(number, float) and number == 0.0:
        reader.refuse(
            InputError("closing_speed must be > 0, got 0: without closing, no impact", code="not_positive", argument=kind)
        )
    return number


def _answer(
    cases: Cases, end: End, a: Vehicle, b: Vehicle, contact: tuple[Any, ...], regime: str | None, on_failure: Any
) -> Impact:
    e, n, rule, bound, law, point, told = contact
    kept = []
    for label, body in (("a", a), ("b", b)):
        staying, ended = parted(body, _MOTION)
        kept.append(staying)
        told |= {f"{label}_after.{name}": text for name, text in ended.items()}
    origins, fits = end.origin(regime)
    count = sum(fit.astype(int) for fit in fits) if fits else np.zeros((), dtype=int)
    blind = end.forgets_slip() & ((regime != "sliding") | end.always_sticks())
    plastic = np.equal(end.known, 0.0) & (end.kind == "restitution")
    parts = end.separation > (end.rounding if end.kind == "restitution" else -end.rounding)
    status = cases.first_status(
        (
            *input_faults(end.numbers),
            (end.status == Status.IMMOVABLE, Status.IMMOVABLE),
            (end.singular & (end.bound > 0.0) & (end.rule != IMPULSE_RATIO), Status.SINGULAR_CONTACT),
            (plastic, Status.INVERSE_E0),
            (~parts, Status.NOT_SEPARATING),
            (blind, Status.STICK_INVERSE),
            (count == 1, Status.OK),
            (count > 1, Status.AMBIGUOUS_INVERSE),
            (True, Status.CONTRADICTORY),
        )
    )
    sure = np.equal(status, Status.OK)
    which = np.argmax(np.stack(np.broadcast_arrays(*fits)), axis=0) if fits else 0
    condition = np.choose(which, [one.condition for one in origins]) if origins else np.nan
    low, high = end.range()
    jump = high - low
    # Of a range that is open only the end that there is tells how far a slip of none is.
    reach = np.where(np.isinf(jump), 2.0 * np.minimum(abs(low - end.slip), abs(high - end.slip)), jump)
    nearly = sure & (abs(end.slip) < _NEARLY_STICKING * reach)
    condition = np.where(nearly, np.maximum(condition, jump / abs(end.slip)), condition)

    def provenance(found: Any, answers: Any, velocity: Any) -> Reconstruction:
        known, condition = (end.kind, rule), cases.values(found)
        velocity = cases.values(velocity[0]), cases.values(velocity[1])
        return Reconstruction(method="planar", known=known, condition=condition, answers=answers, contact_velocity=velocity)

    def asked(found: list[Any], restitution: Any, keep: Any) -> Inputs:
        moved = [
            body._moved(*(cases.values(np.where(keep, part, np.nan)) for part in motion))._told(texts)
            for body, motion, texts in zip((a, b), found, kept, strict=True)
        ]
        used = e if end.kind == "restitution" else cases.values(np.where(keep, restitution, np.nan))
        return Inputs("eccentric", moved[0], moved[1], used, n, rule, bound, law, point, told or None)

    def solution(one: Origin, answers: float) -> Impact:
        found = provenance(one.condition, answers, one.contact_velocity)
        impact = Impact._solved(
            asked(list(one.motions), one.restitution, True)._changed(contact_velocity=found.contact_velocity)
        )
        return found_by(found, impact.inputs, impact._raw, Status.OK)

    def error(index: tuple[int, ...]) -> CollisionsError:
        if isinstance(status, np.ndarray):
            return _alone(int(status[index]), cases, end, a, b, index, regime)
        stuck = status == Status.STICK_INVERSE
        # Those of a range are its ends, however it was asked for.
        candidates, fitting = end.origin(None if stuck else regime)
        fitting = [one for one, fit in zip(candidates, fitting, strict=True) if fit]
        answers = math.inf if stuck else len(fitting)
        solutions = tuple(solution(one, answers) for one in fitting) if stuck or len(fitting) > 1 else ()
        return refusal(status, end, regime, fitting, solutions)

    motions = [
        [np.choose(which, [one.motions[side][part] for one in origins]) if origins else np.nan for part in range(3)]
        for side in range(2)
    ]
    restitution = np.choose(which, [one.restitution for one in origins]) if origins else np.nan
    velocity = [
        np.where(sure, np.choose(which, [one.contact_velocity[part] for one in origins]), np.nan) if origins else np.nan
        for part in range(2)
    ]
    warn(cases, end, sure & end.pressed, nearly)
    origin = provenance(np.where(sure, condition, np.nan), cases.whole(count), velocity)
    return settle(partial(asked, motions, restitution), status, origin, on_failure, error)


def _alone(status: int, cases: Cases, end: End, a: Vehicle, b: Vehicle, index: tuple[int, ...], regime: Any) -> CollisionsError:
    """The refusal of one case of a batch, by asking for it alone."""

    def take(array: Any) -> float:
        return cases.one(array, index)

    contact: dict[str, Any] = {name: take(end.numbers[name]) for name in (end.kind, end.rule)}
    contact |= {"law": end.law, "normal": (take(end.n[0]), take(end.n[1])), "point": (take(end.p[0]), take(end.p[1]))}
    try:
        with quietly():
            planar(part_of(a, take), part_of(b, take), regime=regime, **contact)
    except CollisionsError as problem:
        return problem
    return plain_refusal(status)

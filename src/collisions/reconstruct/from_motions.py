"""``restitution`` and ``friction``: the values that the motions before and after an impact show."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from ..impact.inputs import Inputs, body_numbers, read_inputs
from ..impact.run import error_of, warn_of_refusals
from ..kernels.contact_laws import BRACH, FRICTION
from ..kernels.elementwise import either_infinite, not_about_pivot, rounding
from ..kernels.problem import Contact
from ..messages.errors import (
    IllConditionedWarning,
    InputError,
    MissingInputError,
    NoImpactError,
    OutOfRangeWarning,
    Status,
)
from ..messages.hints import hinted
from ..messages.warning import warn
from ..quantities.tables import Sentences
from ..quantities.units import Input, Pair, Value, texts_of
from ..vehicle.vehicle import Vehicle, needed, not_a_vehicle, numbers_of, without_turning
from .common import ASK_ALONE, NUMBERS, Cases, forward, input_faults, warn_of_condition

_MISMATCH = 0.1  # of the impulse: more than measured yaw rates and speeds explain
# By an impulse, with the kind of each.
_UNCHANGED = {"mass": "mass", "yaw_inertia": "inertia", "x": "length", "y": "length"}
_SAME_BODY = 1e-9  # relative
_ANY = Vehicle(mass=1.0)  # stands in for bodies that were checked before
_STILL_APPROACH = (
    "the contact points still approach after the impact, which was incomplete (sideswipe) or is "
    "not this one"
)
_PART_FASTER = "the contact points part faster than they met; the data contradict each other"

_Faults = list[tuple[Any, int]]


@hinted
def restitution(
    a_before: Vehicle,
    b_before: Vehicle,
    a_after: Vehicle,
    b_after: Vehicle,
    *,
    normal: Input | tuple[Input, Input],
    point: Pair | None = None,
) -> Value:
    """Coefficient of restitution shown by the motions before and after the impact.

    Separation speed over closing speed along the normal: of the contact points with ``point``, of
    the centres of mass without it (eqs 8, 16, 18 and 19 of "Application of Impulse Momentum Theory
    to Vehicle Collisions"). Only the motions are used: masses and inertias do not matter, though
    those of each vehicle must be the same before and after.

    Parameters
    ----------
    a_before, b_before, a_after, b_after : Vehicle
        The vehicles just before and just after the impact. Those that turn need positions. Any
        positions given are those at the moment of impact, the same before and after: an impulse
        displaces nothing.
    normal : angle [rad] or tuple (nx, ny)
        Direction from A into B.
    point : pair [m], optional
        Contact point; without it the bodies are taken as points and may not turn.

    Returns
    -------
    float or array [1]
        Restitution; NaN for a refused case of a batch. Outside 0 to 1 it is returned with a
        warning.

    Raises
    ------
    InputError
        An argument that cannot be used; a vehicle whose mass, yaw inertia or position differs
        before and after.
    NoImpactError
        The bodies were not approaching before the impact.

    Warns
    -----
    OutOfRangeWarning
        Below 0: the contact points went on approaching, an incomplete impact. Above 1: they parted
        faster than they met.
    IllConditionedWarning
        The closing speed is below a millionth of the speeds, which cancel in it.

    Examples
    --------
    Railroad cars from a course sheet: 0.5 m/s into one at rest, leaving at -0.025 and 0.3 m/s
    (published answer 0.65).

    >>> import collisions as col
    >>> a, b = col.Vehicle(mass=20e3, vx=0.5), col.Vehicle(mass=35e3)
    >>> round(
    ...     col.reconstruct.restitution(a, b, a.replace(vx=-0.025), b.replace(vx=0.3), normal=0.0),
    ...     12,
    ... )
    0.65
    """
    bodies = {"a_before": a_before, "b_before": b_before, "a_after": a_after, "b_after": b_after}
    cases, before, after, faults = _observe(bodies, normal, point, "restitution")
    with np.errstate(all="ignore"):
        closing = before.closing_speed
        found = (0.0 - after.closing_speed) / np.where(closing > 0.0, closing, np.nan)
        status = cases.first_status((*faults, (cases.beyond(found), Status.OUT_OF_RANGE)))
        _check(cases, status, before, _as_given(bodies))
        answer = np.where(np.equal(status, Status.OK), found, np.nan)
        condition = (before.speeds + after.speeds) / closing
        # The velocities themselves are rounded, so an e of exactly 0 or 1 may come out slightly
        # outside.
        error = 4.0 * cases.eps * condition
        below, above = answer < -error, answer > 1.0 + error
    if np.any(below | above):
        _warn_of_restitution(answer, below, above, cases.shape is not None)
    _warn_if_cancelled(cases, condition, answer, "the restitution by more than 1")
    observed: Value = cases.values(answer)
    return observed


@hinted
def friction(
    a_before: Vehicle,
    b_before: Vehicle,
    a_after: Vehicle,
    b_after: Vehicle,
    *,
    normal: Input | tuple[Input, Input],
    point: Pair | None = None,
) -> Value:
    """Friction shown by the motions before and after the impact: the magnitude of tangential over
    normal impulse.

    The impulse is computed from the changes of velocity of both bodies, each weighted by the
    inverse square of its mass, since an error in velocity counts for more in a heavier body. If the
    contact was sliding, the ratio is the coefficient of friction; if it came to stick, the least
    that would suffice. The bodies must have no pivot.

    Parameters
    ----------
    a_before, b_before, a_after, b_after : Vehicle
        The vehicles just before and just after the impact, each unchanged in mass and, where given,
        in yaw inertia and position (that at the moment of impact).
    normal : angle [rad] or tuple (nx, ny)
        Direction from A into B.
    point : pair [m], optional
        Contact point, for the closing speed of bodies that turn.

    Returns
    -------
    float or array [1]
        Ratio of the impulses, >= 0.

    Raises
    ------
    InputError
        A body has a pivot, whose impulse is not known; or its mass, yaw inertia or position differs
        before and after.
    NoImpactError
        The bodies were not approaching before the impact, or were not pushed apart.

    Warns
    -----
    IllConditionedWarning
        The impulses of A and B differ by more than a tenth: momentum is not conserved in the data.
        Or the impulse is below a millionth of the momenta, which cancel in it.

    Examples
    --------
    >>> import collisions as col
    >>> a, b = col.Vehicle(mass=1500, vx=15.0, vy=4.0), col.Vehicle(mass=1200)
    >>> end = col.oblique_central(a, b, 0.1, normal=0.0, friction=0.2)
    >>> round(col.reconstruct.friction(a, b, end.a.after, end.b.after, normal=0.0), 12)
    0.2
    """
    bodies = {"a_before": a_before, "b_before": b_before, "a_after": a_after, "b_after": b_after}
    for label, body in bodies.items():
        if isinstance(body, Vehicle) and body.pivot is not None:
            raise InputError(
                f"{label} has a pivot, whose impulse is not known; friction takes free bodies",
                code="pinned",
                argument="pivot",
            )
    cases, before, after, faults = _observe(bodies, normal, point, "friction")
    with np.errstate(all="ignore"):
        mass_a, mass_b = before.a["mass"], before.b["mass"]
        change_a, change_b = (
            [end[name] - start[name] for name in ("vx", "vy")]
            for start, end in ((before.a, after.a), (before.b, after.b))
        )
        # The impulse on B by each body's own change, and their mean with weights 1/m^2, which an
        # infinite mass leaves alone.
        px, py = (b / mass_b - a / mass_a for a, b in zip(change_a, change_b, strict=True))
        nx, ny = before.normal
        normal_part, tangential_part = nx * px + ny * py, nx * py - ny * px
        too_large = cases.beyond(tangential_part / normal_part)
        status = cases.first_status(
            (*faults, (normal_part <= 0.0, Status.NOT_SEPARATING), (too_large, Status.OUT_OF_RANGE))
        )
        _check(cases, status, before, _as_given(bodies))
        sure = np.equal(status, Status.OK)
        on_a = [-mass_a * part for part in change_a]
        on_b = [mass_b * part for part in change_b]
        apart = np.hypot(on_b[0] - on_a[0], on_b[1] - on_a[1]) / np.maximum(
            np.hypot(*on_a), np.hypot(*on_b)
        )
        mismatched = np.isfinite(mass_a) & np.isfinite(mass_b) & sure & (apart > _MISMATCH)
        ratio = np.where(sure, abs(tangential_part) / normal_part, np.nan)
    if np.any(mismatched):
        most = float(np.max(np.where(mismatched, apart, 0.0)))
        by = f"{most:.0%}"
        if cases.shape is not None:
            by = f"up to {by} in {np.count_nonzero(mismatched)} of {np.size(status)} cases"
        what, cure = (
            "the impulses that the motions of A and B show differ by",
            "check masses, motions, and impulses from outside",
        )
        warn(
            IllConditionedWarning(f"{what} {by}: {cure}", code="momentum_mismatch", mismatch=most),
            cases.each(mismatched),
            f"{what} more than {_MISMATCH:.0%}: {cure}",
        )
    with np.errstate(all="ignore"):
        # What the impulses are differences of, beside what is left of them.
        sizes = [
            sum(abs(moment[name]) for moment in moments for name in ("vx", "vy")) / mass
            for moments, mass in (((before.a, after.a), mass_a), ((before.b, after.b), mass_b))
        ]
        condition = (sizes[0] + sizes[1]) / normal_part
    _warn_if_cancelled(cases, condition, ratio, "the friction by more than 1")
    observed: Value = cases.values(ratio)
    return observed


class _Moment(NamedTuple):
    """One instant, before or after: the numbers of both bodies; at the contact, the sum of the
    speeds that were subtracted.
    """

    a: dict[str, Any]
    b: dict[str, Any]
    normal: tuple[Any, ...]
    closing_speed: Any
    speeds: Any


def _observe(
    bodies: dict[str, Any], normal: Any, point: Any, purpose: str
) -> tuple[Cases, _Moment, _Moment, _Faults]:
    """The contact before and after, from the forward kernel, and the faults of the cases."""
    wrong = [
        not_a_vehicle(label, body)
        for label, body in bodies.items()
        if not isinstance(body, Vehicle)
    ]
    motions = (
        number
        for body in bodies.values()
        if isinstance(body, Vehicle)
        for number in numbers_of(body).values()
    )
    read = read_inputs(
        "solve", (_ANY, _ANY, 0.0, normal, point, (0.0, None, None), BRACH), wrong, motions
    )
    for label, body in bodies.items():
        _check_position(label, body, read.point, purpose)
    given = {
        f"{label}.{name}": value
        for label, body in bodies.items()
        for name, value in numbers_of(body).items()
    }
    numbers = {"normal[0]": read.normal[0], "normal[1]": read.normal[1], **given}
    numbers |= {f"point[{i}]": part for i, part in enumerate(read.point or ())}
    cases = Cases.of(numbers)
    with np.errstate(all="ignore"):
        before, after = (
            _moment(read, bodies[f"a_{when}"], bodies[f"b_{when}"]) for when in ("before", "after")
        )
        faults = [
            *input_faults(numbers),
            *(fault for body in bodies.values() for fault in _pivot_faults(body, cases.eps)),
            *_changed_bodies(given, read.point, cases, _as_given(bodies)),
            (before.closing_speed < 0.0, Status.SEPARATING),
            (before.closing_speed == 0.0, Status.NO_CLOSING),
        ]
    return cases, before, after, faults


def _check_position(label: str, body: Vehicle, contact: Any, purpose: str) -> None:
    """Raise for a body that turns if the contact point or the position of the body was
    not given.
    """
    if without_turning(body.yaw_rate):
        return
    if contact is None:
        raise MissingInputError(
            f"{label} turns, so {purpose} needs the contact point; give `point=(x, y)`",
            code="missing_point",
            argument="point",
        )
    for name in ("x", "y"):
        needed(body, name, purpose, label)


def _moment(read: Inputs, *bodies: Vehicle) -> _Moment:
    n, (px, py) = tuple(map(np.asarray, read.normal)), map(np.asarray, read.point or (0.0, 0.0))
    turning = [not without_turning(body.yaw_rate) for body in bodies]
    a, b = (
        # A body that does not turn moves alike everywhere; at the contact no lever of it overflows.
        {
            name: np.asarray(value, dtype=np.float64)
            for name, value in zip(NUMBERS, body_numbers(body, read.point), strict=True)
        }
        | ({} if turns else {"x": px, "y": py})
        for body, turns in zip(bodies, turning, strict=True)
    )
    pinned = (turns and body.pivot is not None for body, turns in zip(bodies, turning, strict=True))
    contact = Contact(np.zeros(()), n, np.zeros(()), (px, py))
    raw = forward(contact, (a.values(), b.values()), FRICTION, BRACH, pinned)
    speeds: Any = 0.0
    for body in (a, b):
        lever = abs(px - body["x"]) + abs(py - body["y"])
        speeds = speeds + abs(body["vx"]) + abs(body["vy"]) + abs(body["yaw_rate"]) * lever
    return _Moment(a, b, n, raw.closing_speed, speeds)


def _pivot_faults(body: Vehicle, eps: float) -> _Faults:
    """For arrays, the checks that ``Vehicle`` makes of single numbers of a pinned body."""
    if body.pivot is None:
        return []
    numbers = (body.vx, body.vy, body.yaw_rate, body.x, body.y, *body.pivot)
    motion: list[Any] = [np.asarray(number, dtype=np.float64) for number in numbers]
    motion.append(rounding(eps, body.vx, body.vy))
    infinite = either_infinite(body.mass, body.yaw_inertia)
    return [(infinite, Status.PINNED_INFINITE), (not_about_pivot(*motion), Status.PINNED_VELOCITY)]


def _changed_bodies(given: dict[str, Any], contact: Any, cases: Cases, say: Sentences) -> _Faults:
    """Cases in which the bodies before and after differ in more than motion; single numbers that
    differ are refused at once.
    """
    within = _SAME_BODY if cases.shape is None else max(_SAME_BODY, 8.0 * cases.eps)
    # A coordinate may be 0 but for rounding, so differences are judged by the size of the scene.
    scene = np.zeros(())
    for place in (
        *(value for name, value in given.items() if name.endswith((".x", ".y"))),
        *(contact or ()),
    ):
        scene = np.fmax(scene, abs(place))
    changed: list[str] = []
    faults: _Faults = []
    for label in ("a_before", "b_before"):
        for name, kind in _UNCHANGED.items():
            before, after = f"{label}.{name}", f"{label[0]}_after.{name}"
            if before not in given or after not in given:
                continue
            one, other = given[before], given[after]
            size = scene if kind == "length" else np.fmax(abs(one), abs(other))
            apart = np.abs(np.subtract(one, other))
            unlike = np.not_equal(one, other) & (
                (apart > within * size) | (np.isinf(one) ^ np.isinf(other))
            )
            if np.ndim(unlike):
                faults.append((unlike, Status.CONTRADICTORY))
            elif unlike:
                texts = [say(float(number), kind) for number in (one, other, apart)]
                changed.append(f"{before} = {texts[0]} and {after} = {texts[1]}, {texts[2]} apart")
    if changed:
        raise InputError(
            f"the bodies before and after must be the same: {'; '.join(changed)}. An impulse "
            "moves nothing: give both the position at the moment of impact, not at rest; "
            f"{changed[0][0]}_before.replace(vx=..., vy=..., yaw_rate=...) does",
            code="different_bodies",
            argument=changed[0].partition(".")[0],
        )
    return faults


def _warn_of_restitution(answer: Any, below: Any, above: Any, batch: bool) -> None:
    """Warn by how much an observed restitution is outside 0 to 1, and in a batch how many are on
    which side.
    """
    counts = {"below": int(np.count_nonzero(below)), "above": int(np.count_nonzero(above))}
    low, high = float(np.nanmin(answer)), float(np.nanmax(answer))
    worst = low if counts["below"] else high
    if not batch:
        text = f"is {worst:.4g}, " + (
            f"below 0: {_STILL_APPROACH}" if worst < 0.0 else f"above 1: {_PART_FASTER}"
        )
    else:
        kinds = (
            [f"{counts['below']} below 0, down to {low:.4g}: {_STILL_APPROACH}"]
            if counts["below"]
            else []
        )
        kinds += (
            [f"{counts['above']} above 1, up to {high:.4g}: {_PART_FASTER}"]
            if counts["above"]
            else []
        )
        text = (
            f"of {sum(counts.values())} of {np.size(answer)} cases is outside 0 to 1; "
            f"{'; '.join(kinds)}"
        )
    warn(
        OutOfRangeWarning(
            f"the observed restitution {text}",
            code="observed_restitution",
            value=worst,
            counts=counts,
        ),
        np.logical_or(below, above),
        f"the observed restitution is outside 0 to 1. Below 0, {_STILL_APPROACH}; above 1, "
        f"{_PART_FASTER}",
    )


def _warn_if_cancelled(cases: Cases, condition: Any, answer: Any, moves: str) -> None:
    """Warn where velocities so nearly cancel that the answer rests on their last digits."""
    where = np.where(np.isfinite(answer), condition, 0.0)
    warn_of_condition(
        where if cases.shape is not None else float(where),
        "the velocities",
        moves,
        "these motions do not show an impact",
    )


def _as_given(bodies: Mapping[str, Any]) -> Sentences:
    """How sentences about these vehicles write numbers."""
    return Sentences([text for body in bodies.values() for text in texts_of(body.given)])


def _check(cases: Cases, status: Any, before: _Moment, say: Sentences) -> None:
    """Raise the refusal of a single case, or warn of the refused cases of a batch."""
    if cases.shape is not None:
        if np.any(status > Status.ENERGY_GAIN):
            warn_of_refusals(status, ASK_ALONE)
    elif status == Status.NOT_SEPARATING:
        raise NoImpactError(
            "the motions show no impulse that pushes the bodies apart along the normal, which "
            "must point from A into B",
            code="not_pushed",
        )
    elif status in (Status.SEPARATING, Status.NO_CLOSING):
        speed, error = float(before.closing_speed), 4.0 * cases.eps * float(before.speeds)
        what = (
            f"closing speed {say(speed, 'speed')} along the normal, which must point from A into B"
        )
        if 0.0 < abs(speed) <= error:
            what = (
                f"closing speed {say(speed, 'speed', 3)}, which cannot be told from rounding, up "
                f"to {say(error, 'speed', 3)}"
            )
        raise NoImpactError(
            f"the bodies did not approach before the impact: {what}; without closing there is "
            "nothing to compare the separation with",
            code="no_closing" if status == Status.NO_CLOSING else "separating",
            closing_speed=speed,
        )
    elif status != Status.OK:
        raise error_of(status, f"{Status(status).sentence}: give motions that are known")

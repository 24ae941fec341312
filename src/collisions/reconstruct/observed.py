"""Restitution and friction that a known motion before and after shows."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..errors import (
    CollisionsError,
    IllConditionedWarning,
    InputError,
    MissingInputError,
    NoImpactError,
    OutOfRangeWarning,
    Status,
)
from ..inputs import read_inputs
from ..kernels.contact_laws import BRACH, FRICTION
from ..kernels.elementwise import either_infinite, not_about_pivot, rounding
from ..kernels.status import EPS
from ..models import body_numbers
from ..solving import error_of
from ..units import Input, Pair, Value
from ..vehicle import DOMAINS, Vehicle, not_a_vehicle
from ..warning import warn
from .common import ASK_ALONE, NUMBERS, Cases, forward, input_faults, raise_or_warn

_MISMATCH = 0.1  # of the impulse: more than measured yaw rates and speeds explain
_KEPT = {"mass": "kg", "yaw_inertia": "kg m2", "x": "m", "y": "m"}  # what no impulse changes
_PINNED = ("vx", "vy", "yaw_rate", "x", "y", "pivot[0]", "pivot[1]")  # what a body that turns about its pivot moves by
_SAME = 1e-9  # relative
_ANY = Vehicle(mass=1.0)  # in place of bodies that were looked at before
_STILL_APPROACH = "the contact points still approach after the impact, which was incomplete (sideswipe) or is not this one"
_PART_FASTER = "the contact points part faster than they met; the data contradict each other"


def restitution(
    a_before: Vehicle,
    b_before: Vehicle,
    a_after: Vehicle,
    b_after: Vehicle,
    *,
    normal: Input | tuple[Input, Input],
    point: Pair | None = None,
) -> Value:
    """Coefficient of restitution that the motions before and after show.

    Separation over closing speed along the normal: of the contact points with ``point``, of the centres of mass without it
    (eqs 8, 16, 18 and 19 of "Application of Impulse Momentum Theory to Vehicle Collisions"). Nothing but the motions is used:
    masses and inertias do not matter, though those of one vehicle must be the same before and after.

    Parameters
    ----------
    a_before, b_before, a_after, b_after : Vehicle
        The vehicles just before and just after. Those that turn need positions, and where positions are given they are those
        at the moment of impact, before and after alike: an impulse moves nothing.
    normal : angle [rad] or tuple (nx, ny)
        Direction from A into B.
    point : pair [m], optional
        Contact point; without it the bodies are taken as points and may not turn.

    Returns
    -------
    float or array [1]
        Restitution; NaN for a refused case of a batch. Outside 0 to 1 it is returned with a warning.

    Raises
    ------
    InputError
        An argument that cannot be used; a vehicle with another mass, yaw inertia or position after than before.
    NoImpactError
        The bodies did not approach before.

    Warns
    -----
    OutOfRangeWarning
        Below 0: the contact points went on approaching, an incomplete impact. Above 1: more speed than there was.

    Examples
    --------
    Railroad cars of a course sheet: 0.5 m/s into one at rest, leaving with -0.025 and 0.3 m/s (published answer 0.65).

    >>> import collisions as col
    >>> a, b = col.Vehicle(mass=20e3, vx=0.5), col.Vehicle(mass=35e3)
    >>> round(col.reconstruct.restitution(a, b, a.replace(vx=-0.025), b.replace(vx=0.3), normal=0.0), 12)
    0.65
    """
    before, after, cases, faults = _motions(a_before, b_before, a_after, b_after, normal, point, "restitution")
    with np.errstate(all="ignore"):
        closing, eps = before["closing_speed"], _eps(cases)
        found = (0.0 - after["closing_speed"]) / np.where(closing > 0.0, closing, np.nan)
        status = cases.first_status((*faults, *_closing_faults(closing), (cases.beyond(found), Status.OUT_OF_RANGE)))
        _raise_or_warn(cases, status, before)
        answer = np.where(np.equal(status, Status.OK), found, np.nan)
        # The velocities are rounded themselves, so an e of exactly 0 or 1 may be seen a little outside.
        rounding = 4.0 * eps * (before["speeds"] + after["speeds"]) / closing
        below, above = answer < -rounding, answer > 1.0 + rounding
    if np.any(below | above):
        _warn_of_restitution(answer, below, above, cases.shape is not None)
    observed: Value = cases.values(answer)
    return observed


def friction(
    a_before: Vehicle,
    b_before: Vehicle,
    a_after: Vehicle,
    b_after: Vehicle,
    *,
    normal: Input | tuple[Input, Input],
    point: Pair | None = None,
) -> Value:
    """Friction that the motions before and after show: the magnitude of tangential over normal impulse.

    The impulse is that of the changes of velocity of both bodies, each weighted by how little an error of its velocity weighs
    (the inverse square of its mass). If the contact was sliding this is the coefficient of friction; if it came to stick, the
    least that would do. Bodies without a pivot.

    Parameters
    ----------
    a_before, b_before, a_after, b_after : Vehicle
        The vehicles just before and just after, each with the same mass and, where given, the same yaw inertia and position,
        which is that at the moment of impact.
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
        A body has a pivot, whose impulse is not known; or is another one after than before.
    NoImpactError
        The bodies did not approach before, or were not pushed apart.

    Warns
    -----
    IllConditionedWarning
        The impulses of A and B differ by more than a tenth: momentum is not conserved in the data.

    Examples
    --------
    >>> import collisions as col
    >>> a, b = col.Vehicle(mass=1500, vx=15.0, vy=4.0), col.Vehicle(mass=1200)
    >>> end = col.oblique_central(a, b, 0.1, normal=0.0, friction=0.2)
    >>> round(col.reconstruct.friction(a, b, end.a.after, end.b.after, normal=0.0), 12)
    0.2
    """
    for label, body in (("a_before", a_before), ("b_before", b_before), ("a_after", a_after), ("b_after", b_after)):
        if isinstance(body, Vehicle) and body.pivot is not None:
            raise InputError(
                f"{label} has a pivot, whose impulse is not known; friction takes free bodies", code="pinned", argument="pivot"
            )
    before, after, cases, faults = _motions(a_before, b_before, a_after, b_after, normal, point, "friction")
    with np.errstate(all="ignore"):
        mass_a, mass_b = before["mass_a"], before["mass_b"]
        nx, ny = before["normal"]
        changes = [(after[f"vx_{s}"] - before[f"vx_{s}"], after[f"vy_{s}"] - before[f"vy_{s}"]) for s in "ab"]
        # The impulse on B by each body's own change, and their mean with weights 1/m^2, which an infinite mass leaves alone.
        px, py = (changes[1][i] / mass_b - changes[0][i] / mass_a for i in range(2))
        normal_part, tangential_part = nx * px + ny * py, nx * py - ny * px
        status = cases.first_status(
            (
                *faults,
                *_closing_faults(before["closing_speed"]),
                (normal_part <= 0.0, Status.NOT_SEPARATING),
                (cases.beyond(tangential_part / normal_part), Status.OUT_OF_RANGE),
            )
        )
        _raise_or_warn(cases, status, before)
        sure = np.equal(status, Status.OK)
        both = np.isfinite(mass_a) & np.isfinite(mass_b) & sure
        on_a = [-mass_a * part for part in changes[0]]
        on_b = [mass_b * part for part in changes[1]]
        apart = np.hypot(on_b[0] - on_a[0], on_b[1] - on_a[1]) / np.maximum(np.hypot(*on_a), np.hypot(*on_b))
        ratio = np.where(sure, abs(tangential_part) / normal_part, np.nan)
    if np.any(both & (apart > _MISMATCH)):
        most = float(np.max(np.where(both, apart, 0.0)))
        hit = np.count_nonzero(both & (apart > _MISMATCH))
        by = f"{most:.0%}" if cases.shape is None else f"up to {most:.0%} in {hit} of {np.size(status)} cases"
        warn(
            IllConditionedWarning(
                f"the impulses that the motions of A and B show differ by {by}: check masses, motions, and impulses from "
                f"outside",
                code="momentum_mismatch",
                mismatch=most,
            )
        )
    observed: Value = cases.values(ratio)
    return observed


def _motions(
    a_before: Any, b_before: Any, a_after: Any, b_after: Any, normal: Any, point: Any, purpose: str
) -> tuple[dict[str, Any], dict[str, Any], Cases, list[tuple[Any, int]]]:
    """What the kernel says of the contact before and after."""
    named = {"a_before": a_before, "b_before": b_before, "a_after": a_after, "b_after": b_after}
    wrong = [not_a_vehicle(label, body) for label, body in named.items() if not isinstance(body, Vehicle)]
    motions = (number for body in named.values() if isinstance(body, Vehicle) for number in body._numbers())
    read, _ = read_inputs("eccentric", _ANY, _ANY, 0.0, normal, point, (0.0, None, None), BRACH, wrong, motions)
    n, contact = read.normal, read.point
    everything: dict[str, Any] = {"normal[0]": n[0], "normal[1]": n[1]}
    sides = {}
    for moment, bodies in (("before", (a_before, b_before)), ("after", (a_after, b_after))):
        for label, body in zip("ab", bodies, strict=True):
            numbers = _numbers(body, contact, f"{label}_{moment}", purpose)
            sides[moment, label] = numbers
            everything |= {f"{label}_{moment}.{name}": value for name, value in zip(NUMBERS, numbers, strict=True)}
    everything |= {f"point[{i}]": part for i, part in enumerate(contact or ())}
    # What no motion needs is 0 above and what was given here, where it is looked at as it is in a single vehicle.
    kept = {f"{label}.{name}": value for label, body in named.items() for name, value in _as_given(body).items()}
    cases = Cases.of({**everything, **kept})
    found = []
    with np.errstate(all="ignore"):
        for moment, bodies in (("before", (a_before, b_before)), ("after", (a_after, b_after))):
            arrays = [[np.asarray(value, dtype=np.float64) for value in sides[moment, label]] for label in "ab"]
            pinned = [body.pivot is not None and not Vehicle._rests(body.yaw_rate) for body in bodies]
            inputs = (np.zeros(()), *map(np.asarray, n), np.zeros(()), *map(np.asarray, contact or (0.0, 0.0)))
            raw = forward(*inputs, *arrays[0], *arrays[1], FRICTION, BRACH, *pinned)
            known = {"closing_speed": raw.closing_speed, "normal": tuple(map(np.asarray, n)), "speeds": 0.0}
            for label, array in zip("ab", arrays, strict=True):
                known |= {f"{name}_{label}": array[i] for i, name in ((0, "mass"), (2, "vx"), (3, "vy"))}
                turning = abs(array[4]) * (abs(inputs[4] - array[5]) + abs(inputs[5] - array[6]))
                known["speeds"] = known["speeds"] + abs(array[2]) + abs(array[3]) + turning
            found.append(known)
        faults = [*input_faults({**everything, **kept}), *_pivot_faults(kept, named, cases)]
        return found[0], found[1], cases, [*faults, *_differences(kept, contact, cases)]


def _pivot_faults(kept: dict[str, Any], named: dict[str, Any], cases: Cases) -> list[tuple[Any, int]]:
    """What a pinned vehicle checks of single numbers, of arrays."""
    faults: list[tuple[Any, int]] = []
    for label in (label for label, body in named.items() if body.pivot is not None):
        mass, inertia = (kept.get(f"{label}.{name}", 0.0) for name in ("mass", "yaw_inertia"))
        motion = [kept[f"{label}.{name}"] for name in _PINNED]
        eps = rounding(_eps(cases), *motion[:2])
        vx, vy, yaw_rate, x, y, pin_x, pin_y = (np.asarray(value, dtype=np.float64) for value in motion)
        faults.append((either_infinite(mass, inertia), Status.PINNED_INFINITE))
        faults.append((not_about_pivot(vx, vy, yaw_rate, x, y, pin_x, pin_y, eps), Status.PINNED_VELOCITY))
    return faults


def _differences(kept: dict[str, Any], contact: Any, cases: Cases) -> list[tuple[Any, int]]:
    """Where a body before is not the same body in the same place after; single numbers that differ are refused at once."""
    within = _SAME if cases.shape is None else max(_SAME, 8.0 * float(np.finfo(cases.dtype).eps))
    # A coordinate may be 0 but for rounding, so what is small is told by the size of the scene.
    scene = np.zeros(())
    for place in (*(value for name, value in kept.items() if name.endswith((".x", ".y"))), *(contact or ())):
        scene = np.fmax(scene, abs(place))
    told: list[str] = []
    lanes: list[tuple[Any, int]] = []
    for label in ("a_before", "b_before"):
        for name, unit in _KEPT.items():
            before, after = f"{label}.{name}", f"{label[0]}_after.{name}"
            if before not in kept or after not in kept:
                continue
            one, other = kept[before], kept[after]
            size = scene if unit == "m" else np.fmax(abs(one), abs(other))
            apart = np.abs(np.subtract(one, other))
            unlike = np.not_equal(one, other) & ((apart > within * size) | (np.isinf(one) ^ np.isinf(other)))
            if np.ndim(unlike):
                lanes.append((unlike, Status.CONTRADICTORY))
            elif unlike:
                told.append(f"{before} = {one:.6g} {unit} and {after} = {other:.6g} {unit}, {apart:.6g} {unit} apart")
    if told:
        raise InputError(
            f"the bodies before and after must be the same: {'; '.join(told)}. An impulse moves nothing: give both the "
            f"position at the moment of impact, not at rest; {told[0][0]}_before.replace(vx=..., vy=..., yaw_rate=...) does",
            code="different_bodies",
            argument=told[0].partition(".")[0],
        )
    return lanes


def _warn_of_restitution(answer: Any, below: Any, above: Any, batch: bool) -> None:
    """Says by how much an observed restitution is outside 0 to 1, and in a batch how many are on which side."""
    counts = {"below": int(np.count_nonzero(below)), "above": int(np.count_nonzero(above))}
    low, high = float(np.nanmin(answer)), float(np.nanmax(answer))
    worst = low if counts["below"] else high
    if not batch:
        text = f"is {worst:.4g}, " + (f"below 0: {_STILL_APPROACH}" if worst < 0.0 else f"above 1: {_PART_FASTER}")
    else:
        kinds = [f"{counts['below']} below 0, down to {low:.4g}: {_STILL_APPROACH}"] if counts["below"] else []
        kinds += [f"{counts['above']} above 1, up to {high:.4g}: {_PART_FASTER}"] if counts["above"] else []
        text = f"of {sum(counts.values())} of {np.size(answer)} cases is outside 0 to 1; {'; '.join(kinds)}"
    warn(OutOfRangeWarning(f"the observed restitution {text}", code="observed_restitution", value=worst, counts=counts))


def _as_given(body: Vehicle) -> dict[str, Any]:
    """Every number of a vehicle by its name."""
    pivot = {f"pivot[{i}]": part for i, part in enumerate(body.pivot or ())}
    return {name: value for name in DOMAINS if (value := getattr(body, name)) is not None} | pivot


def _numbers(body: Vehicle, contact: Any, label: str, purpose: str) -> tuple[Any, ...]:
    """The numbers of one body; what does not matter for its motion at the contact is filled in."""
    turns = not Vehicle._rests(body.yaw_rate)
    if turns and contact is None:
        raise MissingInputError(
            f"{label} turns, so {purpose} needs the contact point; give point=(x, y)", code="missing_point", argument="point"
        )
    if contact is None or not turns:
        unknown = np.any(np.isnan(body.yaw_rate))
        return body.mass, np.inf, body.vx, body.vy, body.yaw_rate if unknown else 0.0, 0.0, 0.0, 0.0, 0.0
    for name in ("x", "y"):
        body._need(name, purpose, label)
    inertia = np.inf if body.yaw_inertia is None else body.yaw_inertia
    return body.mass, inertia, *body_numbers(body, contact)[2:]


def _closing_faults(closing: Any) -> list[tuple[Any, int]]:
    return [(closing < 0.0, Status.SEPARATING), (closing == 0.0, Status.NO_CLOSING)]


def _eps(cases: Cases) -> float:
    return EPS if cases.shape is None else float(np.finfo(cases.dtype).eps)


def _raise_or_warn(cases: Cases, status: Any, before: dict[str, Any]) -> None:
    def error(index: tuple[int, ...]) -> CollisionsError:
        code = int(np.asarray(status)[index])
        if code == Status.NOT_SEPARATING:
            return NoImpactError(
                "the motions show no impulse that pushes the bodies apart along the normal, which must point from A into B",
                code="not_pushed",
            )
        if code not in (Status.SEPARATING, Status.NO_CLOSING):
            return error_of(code, f"{Status(code).sentence}: give motions that are known")
        speed = cases.one(before["closing_speed"], index)
        rounding = 4.0 * _eps(cases) * cases.one(before["speeds"], index)
        what = f"closing speed {speed:.6g} m/s along the normal, which must point from A into B"
        if 0.0 < abs(speed) <= rounding:
            what = f"closing speed {speed:.3g} m/s, which cannot be told from rounding, up to {rounding:.3g} m/s"
        return NoImpactError(
            f"the bodies did not approach before the impact: {what}; without closing there is nothing to compare the "
            f"separation with",
            code="no_closing" if code == Status.NO_CLOSING else "separating",
            closing_speed=speed,
        )

    if cases.shape is not None:
        raise_or_warn(status, None, error, ASK_ALONE)
    elif status != Status.OK:
        raise error(())

"""``inline_closing_speed``: closing speed from one delta-V or an energy; central impacts only."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ..impact.run import error_of, warn_of_refusals
from ..kernels.central import shares
from ..kernels.elementwise import RESTITUTION
from ..kernels.reverse import changing_speed, energy_of_speeds, losing_speed
from ..kernels.status import Status
from ..messages.errors import AmbiguousSolutionError, NoSolutionError
from ..messages.hints import hinted
from ..quantities.reading import ArgumentReader
from ..quantities.tables import Sentences
from ..quantities.units import Input, Value
from .common import (
    ASK_ALONE,
    DRAGS,
    PAIRS,
    Cases,
    drag_faults,
    exactly,
    input_faults,
    read_amounts,
    read_drags,
    read_masses,
    slowed_by,
    state_instant,
    state_other,
)
from .restitution_roots import RestitutionOf, crossings


@hinted
def inline_closing_speed(
    mass_a: Input,
    mass_b: Input,
    restitution: Input | Callable[[float], float],
    *,
    delta_v_a: Input | None = None,
    delta_v_b: Input | None = None,
    energy_loss: Input | None = None,
    ees_a: Input | None = None,
    ees_b: Input | None = None,
    max_crush_speed_a: Input | None = None,
    max_crush_speed_b: Input | None = None,
    duration: Input | None = None,
    drag_a: Input | None = None,
    drag_b: Input | None = None,
) -> Value:
    """Closing speed of an in-line central impact from one delta-V, the energy dissipated, or two
    equivalent speeds.

    Valid only where the line of impact passes through both centres of mass and nothing moves across
    it. In two oblique crash tests this shortcut is 10 to 16 percent too high from the whole delta-V
    and 17 to 24 percent from the whole energy loss (NHTSA 4363 and 4474, on the documentation's
    page "Reverse reconstruction"): for anything else use ``speeds``.

    With ``duration`` and a drag of one vehicle or both, tyres act as impulses from outside, as
    ``eccentric`` takes them with ``outside_a`` and ``outside_b``: drag x weight x duration against
    a motion that goes from A towards B all the while, as where A runs into the rear of B, which may
    stand before. Met head-on, B moves the other way before, and this has no answer for it.

    Parameters
    ----------
    mass_a, mass_b : float, str, Quantity or array [kg]
        Masses, > 0; one may be ``inf``.
    restitution : float, str, Quantity or array [1], or function
        Coefficient of restitution, or a function that gives it for a closing speed in m/s; the two
        are then solved together, in a batch case by case, with NaN where no answer or more than one
        fits.
    delta_v_a, delta_v_b : float, str, Quantity or array [m/s], optional
        Change of velocity of one vehicle, >= 0.
    energy_loss : float, str, Quantity or array [J], optional
        Energy dissipated: what remains lost after restitution.
    ees_a, ees_b : float, str, Quantity or array [m/s], optional
        Energy equivalent speeds of both, by ISO 12353: they stand for the energy dissipated. That
        of an infinite mass is 0.
    max_crush_speed_a, max_crush_speed_b : float, str, Quantity or array [m/s], optional
        Speeds of maximum crush of both: they stand for the energy absorbed before restitution. That
        of an infinite mass is 0.
    duration : float, str, Quantity or array [s], optional
        How long the contact lasts, > 0, for the drags: 0.05 to 0.15 s for cars.
    drag_a, drag_b : float, str, Quantity or array [-], optional
        Drag factor of the tyres of a vehicle while the contact lasts, >= 0, or a deceleration: 0.7
        is locked wheels on a dry road. A vehicle without has no tyre forces, which a study
        states. A known delta-V has their part in it, and the energies are those of the contact
        alone.

    Returns
    -------
    float or array [m/s]
        Closing speed.

    Raises
    ------
    InputError
        An argument that cannot be used, or a function whose value is outside 0 to 1.
    AmbiguousSolutionError
        More than one closing speed agrees with the restitution function, or two with the delta-V of
        B: its tyres may have slowed B by so much more than A pushed, or A have pushed by so much
        more. All are in ``solutions``.
    NoSolutionError
        No closing speed fits.

    Examples
    --------
    For a delta-V of 5 km/h in a car struck by one of equal mass, a restitution suited to the low
    speed makes a difference of two km/h:

    >>> from collisions import reconstruct, reference
    >>> def low_speed(v):  # from 2 to 15 mph
    ...     return reference.restitution(v, outside="refuse")
    >>> round(3.6 * reconstruct.inline_closing_speed(1500, 1500, 0.1, delta_v_a="5 km/h"), 1)
    9.1
    >>> round(3.6 * reconstruct.inline_closing_speed(1500, 1500, low_speed, delta_v_a="5 km/h"), 1)
    7.2

    A parked car with locked wheels, in a contact of 0.1 s, holds half of that delta-V back:

    >>> held = {"duration": "100 ms", "drag_b": 0.7}
    >>> speed = reconstruct.inline_closing_speed(1500, 1500, 0.1, delta_v_b="5 km/h", **held)
    >>> round(3.6 * speed, 1)
    11.3
    """
    known = {
        "delta_v_a": delta_v_a,
        "delta_v_b": delta_v_b,
        "energy_loss": energy_loss,
        "ees_a": ees_a,
        "ees_b": ees_b,
    }
    known |= {"max_crush_speed_a": max_crush_speed_a, "max_crush_speed_b": max_crush_speed_b}
    given = exactly(known, 1, "inline_closing_speed")
    kind = next(iter(given))
    reader = ArgumentReader()
    numbers = read_masses(reader, mass_a, mass_b) | read_amounts(reader, given)
    numbers |= read_drags(reader, duration, {"drag_a": drag_a, "drag_b": drag_b})
    numbers["restitution"] = reader.number(
        0.0 if callable(restitution) else restitution, "", "restitution", RESTITUTION
    )
    reader.close()
    if duration is None:
        missing = "`duration=`, `drag_a=` and `drag_b=`"
        state_instant("inline_closing_speed", missing, of_one_case="")
    else:
        held = [name[-1] for name in DRAGS if name in numbers]
        masses = numbers["mass_a"], numbers["mass_b"]
        state_other("inline_closing_speed", held, masses, "drag", of_one_case="")
    cases = Cases.of(numbers)
    say = Sentences(reader.texts.values())
    if callable(restitution):
        return _with_function(cases, kind, numbers, RestitutionOf(restitution, cases), say)
    return _with_number(cases, kind, numbers, say)


def _closing_speeds(kind: str, numbers: dict[str, Any]) -> tuple[Any, Any]:
    """The closing speed, and a second one that fits as well, NaN where there is none."""
    values = {name: np.asarray(value, dtype=np.float64) for name, value in numbers.items()}
    with np.errstate(all="ignore"):
        share_a, share_b, reduced, _ = shares(values["mass_a"], values["mass_b"])
        if "duration" in values:
            slowed = slowed_by(values)
            return _held_closing_speeds(kind, values, share_a, share_b, reduced, slowed)
        if kind == "energy_loss":
            found = losing_speed(values["energy_loss"] / reduced, values["restitution"])
        elif kind in PAIRS:
            masses = [values[name] / reduced for name in ("mass_a", "mass_b")]
            per_mass = energy_of_speeds(masses[0], values[kind], masses[1], values[PAIRS[kind]])
            found = losing_speed(per_mass, values["restitution"] if kind == "ees_a" else 0.0)
        else:
            found = changing_speed(
                values[kind], share_a if kind == "delta_v_a" else share_b, values["restitution"]
            )
        return found, np.nan * found


def _held_closing_speeds(
    kind: str, values: dict[str, Any], share_a: Any, share_b: Any, reduced: Any, slowed: Any
) -> tuple[Any, Any]:
    """The same where tyres slow the vehicles by so much while the contact lasts.

    The impulse of the contact, per reduced mass, is (1 + e) c + k: it turns the closing speed c
    into the separation speed e c although tyres close the gap by -k, k = slowed B - slowed A. The
    energy that it takes is its product with the mean of the closing speeds before and after. A is
    slowed by both, B pushed on by the contact alone: so the size of its delta-V may be that of
    either sign.
    """
    e, more = values["restitution"], slowed["b"] - slowed["a"]
    if kind.startswith("delta_v"):
        by_contact = (
            ((values[kind] - slowed["a"]) / share_a, np.nan)
            if kind == "delta_v_a"
            else tuple((slowed["b"] + sign * values[kind]) / share_b for sign in (1.0, -1.0))
        )
        first, second = (
            np.where(each > 0.0, (each - more) / (1.0 + e), -1.0) for each in by_contact
        )
        # Without a delta-V both are one.
        return first, np.where((second > 0.0) & (second < first), second, np.nan)
    if kind == "energy_loss":
        energy = values[kind] / reduced
    else:
        masses = [values[name] / reduced for name in ("mass_a", "mass_b")]
        energy = energy_of_speeds(masses[0], values[kind], masses[1], values[PAIRS[kind]])
    # Until a common velocity all of the approach is taken; restitution brings a part of it back.
    taken = 1.0 if kind.startswith("max_crush") else (1.0 - e) * (1.0 + e)
    half = 0.5 * more / (1.0 + e)
    found = np.sqrt(half * half + 2.0 * energy / taken) - half
    return found, np.nan * found


def _with_number(
    cases: Cases,
    kind: str,
    numbers: dict[str, Any],
    say: Sentences,
    found: Any = None,
    faults: Any = (),
) -> Value:
    speed, other = _closing_speeds(kind, numbers) if found is None else (found, np.nan)
    status = cases.first_status(
        (
            *input_faults(numbers),
            (np.isinf(numbers["mass_a"]) & np.isinf(numbers["mass_b"]), Status.IMMOVABLE),
            (
                np.isinf(numbers.get(f"mass_{kind[-1]}", 0.0)) & kind.startswith("delta"),
                Status.INFINITE_MASS,
            ),
            *faults,
            *drag_faults(numbers),
            (("duration" in numbers) & np.less_equal(speed, 0.0), Status.CONTRADICTORY),
            (np.greater(other, 0.0), Status.AMBIGUOUS),
            (~cases.beyond(speed), Status.OK),
            (
                kind in ("energy_loss", "ees_a") and np.equal(numbers["restitution"], 1.0),
                Status.UNDETERMINED,
            ),
            (True, Status.UNDETERMINED if kind == "energy_loss" else Status.CONTRADICTORY),
        )
    )

    if cases.shape is None and status == Status.AMBIGUOUS:
        raise _either_way((cases.values(other), cases.values(speed)), say)
    if cases.shape is None and status != Status.OK:
        text = {
            Status.IMMOVABLE: "both masses are infinite; give at least one a finite mass",
            Status.INFINITE_MASS: (
                f"{kind} is that of an infinite mass, which has none; give that of the other "
                "vehicle"
            ),
            Status.UNDETERMINED: (
                "restitution = 1 loses no energy, so the energy tells nothing of the closing "
                "speed; give a delta-V"
            ),
        }.get(
            status,
            "these values give no finite closing speed; an infinite mass has an equivalent speed "
            "of 0"
            if "duration" not in numbers
            else "these values give no closing speed above 0: tyres alone change the velocities by "
            "as much; check duration, drag_a and drag_b",
        )
        raise error_of(status, text)
    if np.any(np.not_equal(status, Status.OK)):
        warn_of_refusals(status, ASK_ALONE)
    answer: Value = cases.where(np.equal(status, Status.OK), speed)
    return answer


def _either_way(both: tuple[Any, ...], say: Sentences) -> AmbiguousSolutionError:
    """B slowed by its tyres or pushed on by A, at the slower and the faster closing speed."""
    slow, fast = say.apart(both, "speed")
    return AmbiguousSolutionError(
        f"a delta-V of B of this size fits closing speeds of {slow}, at which its tyres slow B by "
        f"more than A pushes it on, and of {fast}, at which A pushes it on by more; give delta_v_a "
        "or an energy, or both speeds of B to reconstruct.central",
        code="ambiguous",
        solutions=both,
    )


def _with_function(
    cases: Cases, kind: str, numbers: dict[str, Any], function: RestitutionOf, say: Sentences
) -> Value:
    if cases.shape is None:
        # Refuses inputs that are wrong whatever the restitution.
        _with_number(cases, kind, numbers, say, _closing_speeds(kind, numbers)[0])
    shape = cases.shape or ()
    flat = {
        name: np.broadcast_to(np.asarray(value, dtype=np.float64), shape).reshape(-1)
        for name, value in numbers.items()
    }

    def speeds(e: Any, case: Any) -> tuple[Any, Any]:
        return _closing_speeds(
            kind, {name: value[case] for name, value in flat.items()} | {"restitution": e}
        )

    def mismatch(e: Any, case: Any) -> list[Any]:
        # Both speeds of maximum crush give the closing speed without e.
        return [function(speed + 0.0 * e) - e for speed in speeds(e, case)]

    count = math.prod(shape)
    found: list[set[float]] = [set() for _ in range(count)]
    ways = set()
    for case, which, e in crossings(mismatch, count):
        found[case] |= {float(speeds(np.float64(e), case)[which])}
        ways.add(which)
    each = [tuple(sorted(filter(math.isfinite, answers))) for answers in found]
    if cases.shape is not None:
        alone = np.array([answers[0] if answers else np.nan for answers in each]).reshape(shape)
        several = np.array([len(answers) > 1 for answers in each], dtype=bool).reshape(shape)
        faults = (several, Status.AMBIGUOUS), (np.isnan(alone), Status.CONTRADICTORY)
        function.warn_at(np.where(several, np.nan, alone))
        return _with_number(cases, kind, numbers, say, alone, faults)
    (answers,) = each
    if not answers:
        function.complain()
        raise NoSolutionError(
            "no closing speed has the restitution that leads to it", code="contradictory"
        )
    if len(answers) == len(ways) == 2:  # one of either sign
        raise _either_way(answers, say)
    if len(answers) > 1:
        raise AmbiguousSolutionError(
            "the function of restitution is met at closing speeds of "
            f"{' and '.join(say.apart(answers, 'speed'))}",
            code="ambiguous",
            solutions=answers,
        )
    function.warn_at(np.float64(answers[0]))
    answer: Value = cases.values(answers[0])
    return answer

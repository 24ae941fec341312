"""``speeds``: both impact speeds from the geometry and two known quantities."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import replace
from functools import partial
from itertools import chain
from operator import attrgetter
from typing import Any, Literal

import numpy as np

from ..impact.doubts import taken_to_stick
from ..impact.impact import Impact
from ..impact.inputs import TYRES, Inputs, Law, check_flag, read_inputs
from ..impact.instant import FROM_READINGS, looked_for
from ..impact.reconstruction import KNOWN
from ..impact.recorded import Axes
from ..impact.time_resolved_inputs import read_lasting
from ..kernels.contact_laws import BRACH, FRICTION, LAWS, RULES
from ..messages.errors import (
    AmbiguousSolutionError,
    CollisionsError,
    InputError,
    MissingInputError,
)
from ..messages.hints import hinted
from ..messages.warning import quietly, state_of_study
from ..quantities.directions import Angle, course
from ..quantities.reading import ArgumentReader
from ..quantities.refusals import must_be
from ..quantities.units import Input, Pair
from ..vehicle.tyres import Tyres
from ..vehicle.vehicle import Vehicle, error_of_missing
from .common import (
    PAIRS,
    Cases,
    exactly,
    numbers_by_name,
    read_amounts,
    state_instant,
    state_motion,
    state_other,
)
from .lasting import numbers_of_times
from .recorder_place import by_own_names, read_recorders
from .restitution_roots import RestitutionOf
from .speeds_algebra import shares_critical
from .speeds_answers import Ways, answers_of
from .speeds_components import COMPONENTS
from .speeds_search import Search
from .speeds_tyres import Attempt

# What may be known: any two, or else components of delta-V, with speeds or without.
_TWO_OF = (
    "speed_a",
    "speed_b",
    "delta_v_a",
    "delta_v_b",
    "energy_loss",
    *chain.from_iterable(PAIRS.items()),
)


@hinted
def speeds(
    a: Vehicle,
    b: Vehicle,
    *,
    course_a: Input | None,
    course_b: Input | None,
    restitution: Input | Callable[[float], float],
    normal: Input | tuple[Input, Input],
    point: Pair,
    friction: Input | None = None,
    impulse_ratio: Input | None = None,
    critical_fraction: Input | None = None,
    law: Law = "brach",
    incomplete: bool = False,
    speed_a: Input | None = None,
    speed_b: Input | None = None,
    delta_v_a: Input | None = None,
    delta_v_b: Input | None = None,
    energy_loss: Input | None = None,
    ees_a: Input | None = None,
    ees_b: Input | None = None,
    max_crush_speed_a: Input | None = None,
    max_crush_speed_b: Input | None = None,
    delta_v_forward_a: Input | None = None,
    delta_v_left_a: Input | None = None,
    delta_v_forward_b: Input | None = None,
    delta_v_left_b: Input | None = None,
    recorder_a: Pair | None = None,
    recorder_b: Pair | None = None,
    axes: Axes | None = None,
    duration: Input | None = None,
    tyres_a: Tyres | None = None,
    tyres_b: Tyres | None = None,
    forward_only: bool = False,
    regime: Literal["sticking", "sliding"] | None = None,
    slid: Literal["bound"] | None = None,
) -> tuple[Impact, ...]:
    """Impact speeds of both vehicles from the geometry of the impact and two known quantities.

    The model is that of ``eccentric``: lever arms, rotation, friction and both laws. All pairs of
    speeds that fit are returned. With ``duration`` and ``tyres_a``, ``tyres_b`` they are those at
    which ``eccentric`` with the same arguments has what is known.

    Parameters
    ----------
    a, b : Vehicle
        The vehicles at the moment of impact: mass, yaw inertia, position, yaw rate (and heading for
        the PDOF). Their velocities are sought; any that are given are replaced.
    course_a, course_b : angle [rad]
        Directions of motion before the impact; None for a vehicle whose speed is known to be 0.
    restitution : float, str, Quantity or array [1], or function
        Coefficient of restitution, or a function that gives it for a closing speed in m/s. A
        function is solved together with the speeds, in a batch case by case, and called with arrays
        if it takes them element by element. With a number, every root is found in closed form. With
        a function, which is much slower, they are sought on a grid of 129 restitutions, between its
        points and where the mismatch turns or ends; two roots that the grid does not separate may
        be missed.
    normal : angle [rad] or tuple (nx, ny)
        Direction from A into B.
    point : pair [m]
        Contact point.
    friction, impulse_ratio, critical_fraction : float, str, Quantity or array [1], optional
        Exactly one, as for ``eccentric``.
    law : str, optional
        How restitution acts and what friction does, as for ``eccentric``.
    incomplete : bool, optional
        Whether the restitution, given or from its function, may be negative (above -1), as for
        ``eccentric``.
    speed_a, speed_b : float, str, Quantity or array [m/s], optional
        A known speed, >= 0. Exactly two are needed of: a speed, a delta-V, the energy dissipated,
        the energy at maximum crush.
    delta_v_a, delta_v_b : float, str, Quantity or array [m/s], optional
        A known delta-V, as from an event data recorder at the centre of mass. Not both: they carry
        the same information.
    energy_loss : float, str, Quantity or array [J], optional
        Energy dissipated, along the normal and by friction.
    ees_a, ees_b : float, str, Quantity or array [m/s], optional
        Energy equivalent speeds of both vehicles by ISO 12353: together they stand for the energy
        dissipated and replace it.
    max_crush_speed_a, max_crush_speed_b : float, str, Quantity or array [m/s], optional
        Speeds of maximum crush of both vehicles: the energy absorbed along the normal at maximum
        crush, before restitution.
    delta_v_forward_a, delta_v_left_a : float, str, Quantity or array [m/s], optional
        Components of delta-V in the axes of a vehicle, which then needs its heading, as from an
        event data recorder (whose lateral delta-V is positive to the right, the opposite sign).
        With a known speed they must be two or more in all. Beside them one thing may be given that
        settles whether the contact stuck or slid: a speed, ``energy_loss`` or both EES. Both
        components of one vehicle give the impulse and its ratio. Both speeds follow from it if the
        contact stuck. If it slid at that ratio, it only repeats the friction: the answers are a
        family, which begins at the answer of the contact that stuck, and one speed must be known.
        Components do not tell which it was: see ``regime`` and ``slid``. An energy greater than a
        contact that stuck loses was lost by sliding.
    delta_v_forward_b, delta_v_left_b : float, str, Quantity or array [m/s], optional
        The same of B.
    recorder_a, recorder_b : pair [m], optional
        Where the recorder sits that the components of A, or of B, were read from: how far ahead of
        the centre of mass, and how far to its left (``recorded_pulse(...).place``). The components
        are then the readings at that place, and carried over to the centre of mass by the yaw of
        the vehicle, which is part of the solution (Marine and Werner, SAE 980219). Several pairs of
        speeds may have the same readings, each with a turn of its own: they are looked for where no
        car turns by more than a quarter while the contact lasts, and one may be missed, as
        ``.statements`` say.
    axes : {"turning", "fixed"}, optional
        Axes of the components: those of the car, which turn with it, as the accelerometers of a
        recorder sum up, or those of its heading at maximum engagement, which stay. By default
        turning where a recorder is given; otherwise the contact is an instant, in which both are
        the same.
    duration : float, str, Quantity or array [s], optional
        How long the contact lasts, during which axes turn and tyres act; needed with a recorder,
        axes or tyres. For axes it may be 0, for a contact in which nothing turns: the force is
        taken to keep one direction and to rise and fall like that of a spring, as in ``left_out``;
        headings are those of maximum engagement, as everywhere in an impulse.
    tyres_a, tyres_b : travel.Tyres, optional
        The wheels that act on the ground meanwhile, as for ``eccentric``; one without has no tyre
        forces, and ``.statements`` say what they would change. A known delta-V has their part in
        it, which is taken to pass as that of the contact does where axes turn; known energies are
        those of the contact, and not taken together with a recorder, axes or ``slid``, nor with
        components and ``friction=inf`` unless the contact is stated to have stuck, as several fit,
        each with another ratio. Answers are looked for from those of an instant without tyres and
        from a grid of other speeds, but for readings at a recorder's place, a bound, and more
        components than are needed without a speed or an energy: one that none of these leads to is
        missed, as ``.statements`` say. Beside a known speed and one other known value there is no
        such grid: the unknown speed is looked through both ways to 60 m/s, three times what both
        stand for or twice the answers of the instant, whichever is most, in 64 steps each way, and
        256 to a step where an answer may be near; two answers between two of the 64 may be missed.
    forward_only : bool
        Leave out the impacts in which a vehicle moves backwards along its course.
    regime : {"sticking", "sliding"}, optional
        Whether the contact stuck or slid to its end, for components of delta-V with ``friction``.
        With ``friction=inf`` no value of friction is needed: a contact that slid did so at the
        ratio that the components show. Without it and without a known speed, the friction decides
        only where the ratio is less than half of it (with ``friction=inf``, of the least in
        ``reference.INTER_VEHICLE_FRICTION``).
    slid : {"bound"}, optional
        What to answer, for components of delta-V with ``friction``, where the contact must have
        slid, or may have, and no speed is known: "bound" gives the end of the family, where its
        slip is least. ``reconstruction.one_sided`` says which way the truth may lie from each
        speed. Where a car goes backwards there, and less so along the family, the end is where it
        stands; a contact that may have stuck then slid, at the ratio that the components show.
        Beside a known speed, where one that stuck and one that slid both fit within the accuracy
        of recorders, it gives the one that stuck and on which side of that the other lies. Of all
        that slid and fit, those count that lie beyond all that stuck and fit by more than a tenth
        of the closing speed, and the best, where it fits better than the one that stuck.

    Returns
    -------
    tuple of Impact
        Every impact that fits, in order of rising closing speed. In a batch each holds one root of
        every case, NaN where a case has none. With more components than are needed, the answer is
        that of least squares: all have equal weight as parts of the impulse, since the error of a
        recorder is a share of it, and a speed is taken as exact.

    Raises
    ------
    InputError
        An argument that cannot be used, or too few or too many known quantities.
    NoSolutionError
        No speeds fit; or the known quantities leave the speeds open, or include the delta-V of an
        infinite mass.
    AmbiguousSolutionError
        Components do not tell whether the contact stuck or slid. Both answers are in ``solutions``,
        first the one that stuck. They have the same numbers, but those of the other are the end of
        its family, unless a car of the one that stuck goes backwards, or the friction is far above
        the ratio and sliding at it fits within ``reference.RECORDER_ACCURACY``. Or a bound was
        asked for, and sliding fits in either direction within that: ``solutions`` has the bounds of
        both, after what stuck, if that fits. Or beside a known speed a bound was asked for, and
        contacts that slid fit on both sides of one that stuck.

    Warns
    -----
    OutOfRangeWarning
        A speed came out negative: backwards along its course. Or, under ``propagate`` and the like,
        two answers meet and end among the samples or near them, which are then not the range of one
        answer.
    IllConditionedWarning
        Components disagree with one another, or with a known speed, by more than
        ``reference.RECORDER_ACCURACY``; beyond three times that they are refused. Or the contact
        was stated to have stuck, or was taken to, and may have slid (code "may_slide"): sticking
        needs an impulse ratio at which contacts between vehicles slide, from
        ``reference.INTER_VEHICLE_FRICTION.low`` on. Or a bound was asked for, or a case of a batch
        has no answer beside a known speed, and the ratio is further from the friction than
        recorders may be; or cases of a batch leave open whether the contact stuck or slid, or in
        which direction (code "slid_either_way"). Or, with no speed known, the courses are near one
        line.
    CollisionsWarning
        Some cases of a batch have no answer; they are NaN, and ``status`` of the first impact says
        why.

    Examples
    --------
    A car strikes a parked one off-centre; its recorder shows a delta-V of 6 m/s.

    >>> import collisions as col
    >>> a = col.Vehicle(mass=1500, yaw_inertia=2500, x=-2.0, y=0.0)
    >>> b = col.Vehicle(mass=1300, yaw_inertia=2000, x=2.0, y=0.8)
    >>> (found,) = col.reconstruct.speeds(
    ...     a,
    ...     b,
    ...     course_a=0.0,
    ...     course_b=None,
    ...     speed_b=0.0,
    ...     delta_v_a=6.0,
    ...     restitution=0.1,
    ...     normal=0.0,
    ...     point=(0.0, 0.4),
    ...     friction=0.5,
    ... )
    >>> round(found.a.before.vx, 2), round(found.a.delta_v, 12)
    (11.96, 6.0)

    With both components, and a contact that stuck, neither a speed nor the friction need be known.
    Here it takes an impulse ratio of 0.07 to stick, far below any friction between vehicles.

    >>> a, b = (v.replace(heading=heading) for v, heading in ((a, "10 deg"), (b, "80 deg")))
    >>> (found,) = col.reconstruct.speeds(
    ...     a,
    ...     b,
    ...     course_a="10 deg",
    ...     course_b="80 deg",
    ...     delta_v_forward_a="-18.5 km/h",
    ...     delta_v_left_a="4.6 km/h",
    ...     restitution=0.1,
    ...     normal=0.0,
    ...     point=(0.0, 0.4),
    ...     friction=float("inf"),
    ... )
    >>> [round(3.6 * side.before.speed, 1) for side in (found.a, found.b)]
    [49.9, 39.8]
    """
    given = dict(locals())
    search, told = _read(given)

    def again(**changes: Any) -> tuple[Impact, ...]:
        with quietly():
            try:
                return speeds(**{**given, **changes})
            except AmbiguousSolutionError as error:
                return error.solutions

    def one_way(direction: float) -> tuple[Impact, ...]:
        with quietly(), suppress(CollisionsError):
            return answered(search.solved(only={"direction": direction}))
        return ()

    def answered(attempt: Attempt) -> tuple[Impact, ...]:
        return answers_of(search, attempt, Ways(again, search.turned, one_way), reconstruction)

    with np.errstate(all="ignore"):
        attempt = search.solved()
        lasts = search.recorders is not None and np.any(search.numbers["duration"] > 0.0)
        if lasts:
            state_of_study(f"speeds {FROM_READINGS}", "looked_for")
        if search.inputs.tyres:
            names = (*search.names, *(search.recorders.names if search.recorders else ()))
            state_of_study(f"speeds with tyres: {looked_for(names)}", "looked_for")
            attempt = search.while_tyres_act(attempt)
            state_motion("speeds")
            masses = search.inputs.a.mass, search.inputs.b.mass
            state_other("speeds", search.inputs.tyres, masses)
        else:
            also_missing = "" if given["duration"] is not None else "`duration=`, "
            state_instant("speeds", f"{also_missing}`tyres_a=` and `tyres_b=`")
        also: tuple[str, ...] = ("restitution",) if search.function else ()
        if attempt.shows:
            also = (FRICTION,)
            if np.any(np.isfinite(search.inputs.rule_value)):
                told[FRICTION] = search.inputs.rule_value
        reconstruction = partial(search.cases.reconstruction, "speeds", given=told, also=also)
        return answered(attempt)


def _read(given: dict[str, Any]) -> tuple[Search, dict[str, Any]]:
    """What is sought, from the arguments; and what was given of the known quantities and courses,
    by the names that a result has for them.
    """
    _check_branch(given)
    a, b, duration, restitution = (given[one] for one in ("a", "b", "duration", "restitution"))
    components = {name: given[name] for name in COMPONENTS if given[name] is not None}
    others = _known_beside(components, {name: given[name] for name in _TWO_OF})
    reader = ArgumentReader()
    times: dict[str, Any] = {}
    tyres = given["tyres_a"], given["tyres_b"]
    if any(one is not None for one in tyres):
        _refuse_with_tyres(given)
        times = read_lasting(reader, "speeds", a, b, duration, tyres)
    known = read_amounts(reader, others)
    known |= {name: reader.number(value, "m/s", name) for name, value in components.items()}
    places = {label: given[f"recorder_{label}"] for label in "ab"}
    axes = given["axes"]
    turns = not times or axes is not None or any(place is not None for place in places.values())
    turning_for = duration if turns else None
    recorders = read_recorders(reader, places, axes, turning_for, tuple(components))
    courses = {
        label: _course(
            reader,
            label,
            given[label],
            given[f"course_{label}"],
            known.get(f"speed_{label}", np.nan),
            components,
        )
        for label in "ab"
    }
    check_flag(reader, "forward_only", given["forward_only"])
    inputs = _read_inputs(reader, given, known, courses, times)
    numbers = {
        **known,
        "restitution": inputs.restitution,
        **numbers_by_name(inputs, without=("vx", "vy")),
        **(recorders.numbers if recorders else {}),
    }
    # Both courses are widened to the precision of all other inputs.
    beside = (*numbers.values(), *(angle.value for angle in courses.values()))
    for label, angle in courses.items():
        numbers |= {
            f"course_{label}[{i}]": part for i, part in enumerate(angle.beside(beside).direction)
        }
    cases = Cases.of(numbers | numbers_of_times(times))
    function = None
    with np.errstate(all="ignore"):
        _refuse_combinations(inputs, known, bool(components), callable(restitution))
        if times and components and given["regime"] != "sticking":
            _refuse_open_ratio(inputs, known)
        if callable(restitution):
            function = RestitutionOf(restitution, cases, -1.0 if given["incomplete"] else 0.0)
    told = known | {
        f"course_{label}": angle.radians
        for label, angle in courses.items()
        if given[f"course_{label}"] is not None
    }
    told |= {
        name: number
        for name, number in (recorders.numbers if recorders else {}).items()
        if given[name.partition("[")[0]] is not None
    }
    search = Search(
        numbers,
        cases,
        inputs,
        known,
        function=function,
        recorders=recorders,
        regime=given["regime"],
        slid=given["slid"],
        forward_only=given["forward_only"],
        texts=by_own_names(reader.texts, recorders, bool(times)),
    )
    return search, by_own_names(told, recorders, bool(times))


def _read_inputs(
    reader: ArgumentReader,
    given: dict[str, Any],
    known: dict[str, Any],
    courses: dict[str, Angle],
    times: dict[str, Any],
) -> Inputs:
    """The impact as its forward model takes it, which is without its speeds."""
    restitution = given["restitution"]
    e = 0.0 if callable(restitution) else restitution
    rules = tuple(given[rule] for rule in ("friction", "impulse_ratio", "critical_fraction"))
    arguments = (
        *(given[one] for one in "ab"),
        e,
        given["normal"],
        given["point"],
        rules,
        given["law"],
    )
    in_time = numbers_of_times(times)
    beside = (*known.values(), *(angle.value for angle in courses.values()), *in_time.values())
    inputs = read_inputs("eccentric", arguments, reader.problems, beside, given["incomplete"])
    if not times:
        return inputs
    if callable(restitution):
        raise InputError(
            "a function of restitution and tyres cannot be solved together; give a number for the "
            "restitution",
            code="bad_combination",
            argument="restitution",
        )
    return replace(inputs, **times)


def _refuse_with_tyres(given: dict[str, Any]) -> None:
    """Refuse an energy beside readings of recorders, or a bound, where tyres act."""
    energies = [name for name in ("energy_loss", "ees_a", "ees_b") if given[name] is not None]
    for name in ("recorder_a", "recorder_b", "axes", "slid"):
        if given[name] is not None and energies:
            raise InputError(
                f"{name}, {energies[0]} and tyres cannot be taken together; leave out "
                f"{energies[0]}, or give a speed in its place",
                code="bad_combination",
                argument=name,
            )


def _refuse_open_ratio(inputs: Inputs, known: Mapping[str, Any]) -> None:
    """Refuse an energy beside components where tyres act and no friction limits the ratio.

    Tyres turn with the speeds that are sought, so that components and an energy fit several
    contacts, each with a ratio of its own, and nothing tells which it was.
    """
    energies = [name for name in ("energy_loss", "ees_a") if name in known]
    if energies and inputs.rule == FRICTION and np.any(np.isinf(inputs.rule_value)):
        raise InputError(
            f"friction=inf, components of delta-V, {energies[0]} and tyres cannot be taken "
            "together, as several contacts fit, each with another ratio of the impulse; give the "
            f"friction, a speed in place of {energies[0]}, or `regime='sticking'` if it stuck",
            code="bad_combination",
            argument="friction",
        )


def if_it_slid(impact: Impact) -> Impact | None:
    """The end of the family of impacts in which the contact slid at the ratio that it had in this
    one, which was taken to stick; None where components of delta-V did not tell its speeds, or one
    of these was known, with which it slid at another ratio.
    """
    origin, inputs = impact.reconstruction, impact.inputs
    if origin is None or not taken_to_stick(impact):
        return None
    if any(name.startswith("speed") for name in origin.known):
        return None
    given: dict[str, Any] = {
        name: attrgetter(KNOWN[name].path)(impact)
        for name in origin.known
        if name.startswith("delta_v")
    }
    given |= {f"course_{label}": getattr(inputs, label).course for label in "ab"}
    given |= {name: getattr(inputs, name) for name in ("restitution", "normal", "point")}
    given |= {"law": inputs.law or BRACH, "incomplete": inputs.incomplete}
    if inputs.tyres:
        given |= {name: getattr(inputs, name) for name in ("duration", *TYRES)}
    ratio = abs(impact.impulse_ratio)
    try:
        with quietly():
            found = speeds(
                inputs.a, inputs.b, friction=ratio, regime="sliding", slid="bound", **given
            )
    except CollisionsError:
        return None
    # A ratio of the other sign slid the other way.
    return min(found, key=lambda one: abs(one.impulse_ratio - impact.impulse_ratio))


def _check_branch(given: dict[str, Any]) -> None:
    """Refuse ``regime`` and ``slid`` that are none, or that do not go with what was given."""
    regime, slid = given["regime"], given["slid"]
    for name, value, allowed in (
        ("regime", regime, ("sticking", "sliding")),
        ("slid", slid, ("bound",)),
    ):
        if value is None:
            continue
        if not isinstance(value, str) or value not in allowed:
            raise must_be(
                name, f"{' or '.join(map(repr, allowed))}`|, or None|`", value, code="bad_option"
            )
        by_ratio = any(given[rule] is not None for rule in RULES if rule != FRICTION)
        if by_ratio or all(given[one] is None for one in COMPONENTS):
            raise InputError(
                f"`{name}={value!r}` is for components of delta-V with `friction=`, which do "
                "not tell whether the contact stuck or slid; leave it out, or give these",
                code="bad_combination",
                argument=name,
            )
    if regime == "sticking" and slid:
        raise InputError(
            "`regime='sticking'` says that the contact did not slide, so `slid='bound'` is "
            "about nothing; leave out one of them",
            code="bad_combination",
            argument="slid",
        )


def _known_beside(components: dict[str, Any], known: dict[str, Any]) -> dict[str, Any]:
    """The known quantities that were given: two of them, or speeds beside components, at least two
    in all.
    """
    others = (
        {name: value for name, value in known.items() if value is not None}
        if components
        else exactly(known, 2, "speeds")
    )
    if {"speed_a", "speed_b"} <= others.keys():
        raise InputError(
            "speed_a and speed_b are both known: that is the forward problem, use eccentric",
            code="too_many_knowns",
        )
    taken = [("speed_a",), ("speed_b",), ("energy_loss",), ("ees_a", "ees_b"), ()]
    stray = [name for name in others if components and tuple(others) not in taken]
    if stray:
        raise InputError(
            f"{', '.join(components)} and {', '.join(stray)} are not taken together: beside "
            "components of delta-V give a speed, energy_loss or both EES",
            code="bad_combination",
            argument=stray[0],
        )
    if components and len(components) + sum(name[:5] == "speed" for name in others) < 2:
        raise InputError(
            f"{next(iter(components))} alone leaves the speeds open; give another component, or "
            "one of the speeds",
            code="too_few_knowns",
            argument=next(iter(components)),
        )
    return others


def _course(
    reader: ArgumentReader, label: str, body: Any, given: Any, speed: Any, components: Iterable[str]
) -> Angle:
    """The course of a vehicle, not needed at rest; refuses a vehicle that has a pivot, or lacks the
    heading it needs.
    """
    if given is None and np.any(np.not_equal(speed, 0.0)):
        reader.refuse(
            MissingInputError(
                f"course_{label} `|is None|is not given`, and speeds needs the course of "
                "every vehicle that moves; only a known speed of 0 needs none",
                code="missing_course",
                argument=f"course_{label}",
            )
        )
    if isinstance(body, Vehicle) and body.pivot is not None:
        reader.refuse(
            InputError(
                f"{label} has a pivot, so its velocity has no course of its own; use planar",
                code="pinned",
                argument="pivot",
            )
        )
    if (
        isinstance(body, Vehicle)
        and body.heading is None
        and any(name[-1] == label for name in components)
    ):
        reader.refuse(error_of_missing(body, "heading", "a component of its delta-V", label))
    return Angle(0.0, False) if given is None else course(reader, given, f"course_{label}")


def _refuse_combinations(
    inputs: Inputs, known: dict[str, Any], components: bool, function: bool
) -> None:
    """Refuse what gives the same information twice, and what cannot be solved together."""
    if LAWS[inputs.law or BRACH].followed:
        raise InputError(
            f"reconstruct.speeds cannot go back under law {inputs.law!r}, whose impulse is "
            "not linear in the speeds; give another law, or fit a model with this one to "
            "what is known (`reconstruct.fit`)",
            code="law_not_reversible",
            argument="law",
        )
    if known.keys() == {"delta_v_a", "delta_v_b"}:
        on_a, on_b = (
            np.multiply(body.mass, known[f"delta_v_{label}"])
            for label, body in (("a", inputs.a), ("b", inputs.b))
        )
        # fmax passes over the NaN of infinite masses.
        apart = float(
            np.fmax.reduce(abs(on_a - on_b) / np.maximum(on_a, on_b), axis=None, initial=0.0)
        )
        raise InputError(
            f"delta_v_a and delta_v_b both give the impulse (here they differ by {apart:.1%}); "
            "give one of them and a speed or an energy",
            code="same_information",
            argument="delta_v_b",
            mismatch=apart,
        )
    if {"energy_loss", "ees_a"} <= known.keys():
        raise InputError(
            "energy_loss and both EES tell the same, the energy dissipated; give one of them and "
            "a speed or a delta-V",
            code="same_information",
            argument="ees_a",
        )
    shares = shares_critical(inputs.rule, inputs.rule_value)
    if (function or shares) and components:
        raise InputError(
            "components of delta-V take a number for the restitution, and no "
            "critical_fraction between 0 and 1; give `friction=`, `friction=inf` or "
            "`impulse_ratio=`",
            code="bad_combination",
            argument="restitution" if function else "critical_fraction",
        )
    if function and shares:
        raise InputError(
            "a function of restitution and a critical_fraction between 0 and 1 cannot be "
            "solved together; give `impulse_ratio=` or a number for the restitution",
            code="bad_combination",
            argument="critical_fraction",
        )

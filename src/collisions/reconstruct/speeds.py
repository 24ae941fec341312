"""``speeds``: both impact speeds from the geometry and two known quantities."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from itertools import chain, combinations
from operator import attrgetter
from typing import Any, Literal, NamedTuple

import numpy as np

from ..engine.blocks import Part, in_parts, is_one_part
from ..impact.impact import Impact
from ..impact.inputs import TYRES, Inputs, Law, check_flag, read_inputs
from ..impact.instant import LOOKED_FOR
from ..impact.reconstruction import KNOWN, Reconstruction, bounds_of
from ..impact.recorded import Axes
from ..impact.run import error_of, warn_of_refusals
from ..impact.time_resolved_inputs import read_lasting
from ..kernels.contact_laws import BRACH, FRICTION, LAWS, RULES
from ..kernels.status import EPS, Status
from ..messages.errors import (
    AmbiguousSolutionError,
    CollisionsError,
    IllConditionedWarning,
    InputError,
    MissingInputError,
    OutOfRangeWarning,
)
from ..messages.hints import hinted
from ..messages.warning import quietly, state_of_study, warn_of_cases, warn_of_samples
from ..quantities.directions import Angle, course
from ..quantities.reading import ArgumentReader
from ..quantities.refusals import LATERAL, must_be
from ..quantities.tables import Sentences, given_texts, said
from ..quantities.units import Input, Pair
from ..vehicle.tyres import Tyres
from ..vehicle.vehicle import Vehicle, error_of_missing, moved
from .common import (
    ASK_ALONE,
    PAIRS,
    Cases,
    counted,
    exactly,
    input_faults,
    numbers_by_name,
    read_amounts,
    run_forward,
    split_texts,
    state_instant,
    state_motion,
)
from .lasting import numbers_of_times, tyre_faults
from .recorder_place import RecorderScene, by_own_names, read_recorders
from .restitution_roots import RestitutionOf, crossings
from .speeds_algebra import LAW, NO_ROOT, REDUNDANT, ROOT_TOL, Root, Scene, shares_critical
from .speeds_components import (
    ACCURACY,
    CLEARLY_BELOW,
    CONTRADICTION,
    MAY_SLIDE,
    RATIO_SHOWN,
    ComponentScene,
    Shown,
    friction_shown,
    together,
)
from .speeds_tyres import Attempt, in_balance, other_starts, speeds_with_tyres

# What may be known: any two, or else components of delta-V, with speeds or without.
_TWO_OF = (
    "speed_a",
    "speed_b",
    "delta_v_a",
    "delta_v_b",
    "energy_loss",
    *chain.from_iterable(PAIRS.items()),
)
_COMPONENTS = tuple(f"delta_v_{part}_{label}" for label in "ab" for part in ("forward", "left"))
# Above this restitution hardly any energy is lost along the normal.
_ELASTIC = 1.0 - 1e-6
# Why a contact that slid has no direction.
EITHER_WAY = "both fit within the accuracy stated for recorders (reference.RECORDER_ACCURACY)"
# Distances of two answers whose ratio is less: the fold, quadratic, is as near as the samples are
# apart.
_NEAR_FOLD = 0.7


class Ways(NamedTuple):
    """Other ways to solve a single case: with other arguments, and with the signs of lateral
    components turned, which says of which components an answer results then; and with a contact
    that slid in one direction alone, by the sign of its impulse ratio.
    """

    again: Callable[..., tuple[Impact, ...]]
    turned: Callable[[], str]
    one_way: Callable[[float], tuple[Impact, ...]]


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
        The wheels that act on the ground meanwhile, as for ``eccentric``. A known delta-V has their
        part in it, which is taken to pass as that of the contact does where axes turn; known
        energies are those of the contact, and not taken together with a recorder, axes or
        ``slid``. Answers are looked for from those of an instant without tyres and from a grid of
        other speeds, but for readings at a recorder's place, a bound, and more components than are
        needed without a speed or an energy: one that none of these leads to is missed, as
        ``.statements`` say.
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
        of recorders, it gives the one that stuck and on which side of that the other lies.

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
        both, after what stuck, if that fits.

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
    _check_branch(given)
    components = {name: given[name] for name in _COMPONENTS if given[name] is not None}
    others = _known_beside(components, {name: given[name] for name in _TWO_OF})
    reader = ArgumentReader()
    times: dict[str, Any] = {}
    if tyres_a is not None or tyres_b is not None:
        _refuse_with_tyres(given)
        times = read_lasting(reader, "speeds", a, b, duration, (tyres_a, tyres_b))
    known = read_amounts(reader, others)
    known |= {name: reader.number(value, "m/s", name) for name, value in components.items()}
    places = {"a": recorder_a, "b": recorder_b}
    turns = not times or axes is not None or any(place is not None for place in places.values())
    turning_for = duration if turns else None
    recorders = read_recorders(reader, places, axes, turning_for, tuple(components))
    courses = {
        label: _course(reader, label, body, angle, known.get(f"speed_{label}", np.nan), components)
        for label, body, angle in (("a", a, course_a), ("b", b, course_b))
    }
    check_flag(reader, "forward_only", forward_only)
    e = 0.0 if callable(restitution) else restitution
    arguments = a, b, e, normal, point, (friction, impulse_ratio, critical_fraction), law
    in_time = numbers_of_times(times)
    beside = (*known.values(), *(angle.value for angle in courses.values()), *in_time.values())
    inputs = read_inputs("eccentric", arguments, reader.problems, beside, incomplete)
    if times:
        inputs = replace(inputs, **times)
    if times and callable(restitution):
        raise InputError(
            "a function of restitution and tyres cannot be solved together; give a number for the "
            "restitution",
            code="bad_combination",
            argument="restitution",
        )
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
    cases = Cases.of(numbers | in_time)
    with np.errstate(all="ignore"):
        _refuse_combinations(inputs, known, bool(components), callable(restitution))
        function = (
            RestitutionOf(restitution, cases, -1.0 if incomplete else 0.0)
            if callable(restitution)
            else None
        )
        names, used_law = counted(known), inputs.law or BRACH
        also = ("restitution",) if function else ()
        of_components = ComponentScene if recorders is None else partial(RecorderScene, recorders)
        # A function is called with all cases; the turn of cars is looked for until all have it.
        together = is_one_part(cases.shape or ()) or function is not None or recorders is not None

        asked = inputs

        def looked(
            own: dict[str, Any],
            some: Cases,
            most: float,
            plain: bool = False,
            shares: bool = False,
            only: Mapping[str, Any] = {},
        ) -> _Looked:
            """The scene of these numbers and its roots, with the friction that the components show
            in place of an infinite one. ``shares`` says that another case has a share of the
            critical ratio, ``only`` in which direction a contact that slid did.
            """
            if recorders is None or not np.any(own["duration"] > 0.0):
                return looked_from(only, own, some, most, plain, shares)
            starts = scene_of(own, some.shape or (), most).impulses()
            looks = [
                looked_from({"start": start, **only}, own, some, most, plain, shares)
                for start in starts
            ]
            return _together(looks, own[asked.rule])

        def looked_from(
            start: Mapping[str, Any],
            own: dict[str, Any],
            some: Cases,
            most: float,
            plain: bool,
            shares: bool,
        ) -> _Looked:
            """The same of the impulse at which readings that may mean several begin."""
            shape, friction, shown = some.shape or (), None, Shown()
            if components and asked.rule == FRICTION and np.any(np.isinf(asked.rule_value)):
                shown = friction_shown(
                    partial(of_components, most=most, **start), own, used_law, names, shape, regime
                )
                if shown.friction is not None:
                    friction = some.values(shown.friction)
                    own = {**own, FRICTION: friction}
            scene = scene_of(own, shape, most, plain, start)
            scene.shares = scene.shares or shares
            if isinstance(scene, ComponentScene):
                scene.leaves_slip = scene.leaves_slip | shown.fits_both
                scene.toward = shown.toward
                scene.shows_friction = np.isinf(asked.rule_value) & (friction is not None)
            roots = scene.roots() if function is None else _with_function(scene, function)
            if isinstance(scene, ComponentScene) and np.any(np.isfinite(scene.slid_at)):
                slid_at = np.where(np.isfinite(scene.slid_at), scene.slid_at, own[FRICTION])
                friction = some.values(slid_at)
            if most == math.inf:
                # Whether it stuck or slid is asked when the tyres are known.
                scene.ambiguous = np.zeros((), dtype=bool)
            # Of those in balance it is asked at the end.
            forwards = forward_only and not balanced
            return _Looked(scene, _in_order(scene, roots, forwards), friction)

        def scene_of(
            own: dict[str, Any],
            shape: tuple[int, ...],
            most: float,
            plain: bool = False,
            start: Mapping[str, Any] = {},
        ) -> Any:
            kind: Callable[..., Scene] = Scene
            if components:
                kind = partial(
                    of_components,
                    regime=regime,
                    slid=slid,
                    most=most,
                    forward_only=forward_only,
                    **start,
                )
            return kind(own, asked.rule, used_law, names, shape=shape, plain=plain)

        def attempt(
            held: dict[str, Any], most: float = CONTRADICTION, only: Mapping[str, Any] = {}
        ) -> Attempt:
            """The scene and its roots where these impulses of tyres act, and where known values may
            differ by so much.
            """
            own = {**numbers, **held}
            if not together:
                now = _in_parts(
                    own, cases, partial(looked, most=most, only=only), partial(scene_of, most=most)
                )
            else:
                try:
                    single = cases.shape is None and function is None
                    now = looked(own, cases, most, single, only=only)
                except ArithmeticError:  # of plain floats, which arrays answer with inf or NaN
                    now = looked(own, cases, most, only=only)
            of_inputs = asked if now.friction is None else _with_friction(asked, now.friction)
            return Attempt(now.scene, now.found, of_inputs, now.frictions, now.friction is not None)

        knows_speed = any(name.startswith("speed") for name in known)
        balanced = bool(times and components) and not {"energy_loss", "ees_a"} & known.keys()

        def solved(changes: dict[str, Any], only: Mapping[str, Any] = {}) -> Attempt:
            """The same with some numbers changed, in balance with the tyres."""

            def changed(held: dict[str, Any], most: float = CONTRADICTION) -> Attempt:
                return attempt({**held, **changes}, most, only)

            if not balanced:
                return changed({})
            now = in_balance(changed, numbers, cases)
            roots = [
                root._replace(closing=np.where(there, root.closing, np.nan))
                for root, there in now.found
            ]
            return now._replace(found=_in_order(now.scene, roots, forward_only))

        def turned() -> str:
            """What a single case may have wrong: the lateral components with whose signs turned
            both vehicles go forwards; "" for none.
            """
            lateral = [name for name in known if name.startswith("delta_v_left")]
            best, said_of = math.inf, ""
            for names in (names for n in (1, 2) for names in combinations(lateral, n)):
                scene, found, *_ = solved({name: -known[name] for name in names})
                assert isinstance(scene, ComponentScene)
                answer = found[0][0][:2] if found else scene.answer
                fits = (bool(found) or bool(np.any(scene.ambiguous))) and min(answer) >= 0.0
                if fits and scene.misfit < best:
                    best, said_of = float(scene.misfit), " and ".join(names)
            return said_of

        attempted = solved({})
        scene, found = attempted.scene, attempted.found
        if attempted.shows:
            also = (FRICTION,)
        texts = by_own_names(reader.texts, recorders, bool(times))

        def with_texts(one: Attempt) -> Attempt:
            if not texts:
                return one
            own = {**texts, **(one.inputs.given or {})}
            return one._replace(inputs=replace(one.inputs, given=own))

        attempted = with_texts(attempted)
        inputs = attempted.inputs
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
        if attempted.shows and np.any(np.isfinite(asked.rule_value)):
            told[FRICTION] = asked.rule_value
        told = by_own_names(told, recorders, bool(times))

        def again(**changes: Any) -> tuple[Impact, ...]:
            with quietly():
                try:
                    return speeds(**{**given, **changes})
                except AmbiguousSolutionError as error:
                    return error.solutions

        if inputs.tyres:
            state_of_study(f"speeds with tyres: {LOOKED_FOR}", "looked_for")
            # A place of a recorder and its axes are in the balance alone.
            alone = recorders is None and slid is None and not attempted.frictions
            if not balanced or (alone and (len(known) == 2 or knows_speed)):
                found = _while_tyres_act(
                    cases, scene, found, inputs, known, forward_only, regime, balanced
                )
        if not times:
            state_instant("speeds")
        if inputs.tyres:
            state_motion("speeds")
        reconstruction = partial(cases.reconstruction, "speeds", given=told, also=also)

        def answered(one: Attempt) -> tuple[Impact, ...]:
            return _answers(cases, one, known, function, forward_only, ways, reconstruction)

        def one_way(direction: float) -> tuple[Impact, ...]:
            with quietly(), suppress(CollisionsError):
                return answered(with_texts(solved({}, {"direction": direction})))
            return ()

        ways = Ways(again, turned, one_way)
        return answered(attempted._replace(found=found))


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


def taken_to_stick(impact: Impact) -> bool:
    """Whether components of delta-V told the speeds of an impact only because it was stated, or
    taken, to have stuck.
    """
    origin = impact.reconstruction
    return (
        origin is not None
        and impact.inputs.rule == FRICTION
        and any(name in _COMPONENTS for name in origin.known)
        and (
            origin.regime == "sticking"
            or not any(name.startswith(("speed", "energy", "ees")) for name in origin.known)
        )
        and not any((origin.one_sided or {}).values())
    )


def if_it_slid(impact: Impact) -> Impact | None:
    """The end of the family of impacts in which the contact slid at the ratio that it had in this
    one, which was taken to stick; None where components of delta-V did not tell its speeds.
    """
    origin, inputs = impact.reconstruction, impact.inputs
    if origin is None or not taken_to_stick(impact):
        return None
    given: dict[str, Any] = {
        name: attrgetter(KNOWN[name].path)(impact)
        for name in origin.known
        if name.startswith(("speed", "delta_v"))
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
        if by_ratio or all(given[one] is None for one in _COMPONENTS):
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


def _with_friction(inputs: Inputs, friction: Any) -> Inputs:
    """The inputs with the friction that was found in place of an infinite one."""
    texts = {name: text for name, text in (inputs.given or {}).items() if name != FRICTION}
    return replace(inputs, rule_value=friction, given=texts or None)


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


class _Looked(NamedTuple):
    """A scene, its roots and where each is, the friction that it showed, if any, and by the way of
    a root, where it is of several scenes.
    """

    scene: Scene
    found: list[tuple[Root, Any]]
    friction: Any
    frictions: Sequence[Any] = ()


def _together(looks: Sequence[_Looked], given: Any) -> _Looked:
    """The roots that fit best of scenes with the same readings and each an impulse of its own."""
    if len(looks) == 1:
        return looks[0]
    scenes = [look.scene for look in looks if isinstance(look.scene, ComponentScene)]
    answered = [
        np.logical_or.reduce(
            [np.zeros(look.scene.shape, dtype=bool), *(at for _, at in look.found)]
        )
        for look in looks
    ]
    whole = together(scenes, answered)
    roots = [
        root._replace(
            closing=np.where(
                there & (scene.misfit <= np.maximum(ROOT_TOL, whole.misfit)),
                root.closing,
                np.nan,
            ),
            way=np.full(whole.shape, float(i)),
        )
        for i, (look, scene) in enumerate(zip(looks, scenes, strict=True))
        for root, there in look.found
    ]
    shown = [look.friction for look in looks]
    frictions = [given if one is None else one for one in shown]
    one = next((one for one in shown if one is not None), None)
    return _Looked(whole, _in_order(whole, roots, False), one, () if one is None else frictions)


def _in_parts(
    own: dict[str, Any],
    cases: Cases,
    looked: Callable[..., _Looked],
    scene_of: Callable[..., Scene],
) -> _Looked:
    """The same as ``looked`` of all cases, block by block."""
    shape = cases.shape or ()
    whole = scene_of(own, shape)

    def work(part: Part) -> dict[str, Any]:
        there = {name: part.of(value) for name, value in own.items()}
        some = Cases(part.shape, cases.dtype)
        scene, found, friction, _ = looked(there, some, shares=whole.shares)
        parts = scene.findings()
        for i, (root, where) in enumerate(found):
            parts |= {f"{i}.{name}": value for name, value in root._asdict().items()}
            parts[f"{i}.there"] = where
        return parts if friction is None else {**parts, FRICTION: friction}

    merged = in_parts(work, shape)
    friction = merged.get(FRICTION)
    if friction is not None:
        # A part that shows none has what was given.
        friction = cases.values(np.where(np.isnan(friction), own[FRICTION], friction))
        whole = scene_of({**own, FRICTION: friction}, shape)
    whole.take(merged)
    found: list[tuple[Root, Any]] = []
    while f"{len(found)}.there" in merged:
        root = Root(*(merged[f"{len(found)}.{name}"] for name in Root._fields))
        found.append((root, merged[f"{len(found)}.there"]))
    return _Looked(whole, found, friction)


def _with_function(scene: Scene, function: RestitutionOf) -> list[Root]:
    """Candidates where the restitution is a function of the closing speed: found on a grid of e,
    then refined.
    """
    count = math.prod(scene.shape)

    def difference(part: Scene, closing: Any, e: Any) -> Any:
        return function(np.ravel(part.speed_unit * closing + 0.0 * e)) - e

    def mismatch(e: Any, case: Any) -> list[Any]:
        part = scene.of(case, e)
        return [
            difference(part, part.observe(LAW, *pair).closing, e) for _, *pair in part.candidates()
        ]

    def slips(e: Any, case: Any) -> list[Any]:
        part = scene.of(case, e)
        return [part.any_slip_at(regime)[0] + 0.0 * e for regime in part.regimes()]

    found: list[Root] = []
    of_cases = crossings(mismatch, count, function.least)
    if of_cases:
        case, candidate, restitution = map(np.array, zip(*of_cases, strict=True))
        roots = np.stack(scene.of(case, restitution).roots(function))
        chosen = roots[candidate, :, np.arange(case.size)]
        # Of each case the first root, then the second and so on.
        rank = np.arange(case.size) - np.searchsorted(case, case)
        whole = np.full((rank.max() + 1, count, len(Root._fields)), np.nan)
        whole[rank, case] = chosen
        found = [Root._make(one.T.reshape(-1, *scene.shape)) for one in whole]
    undetermined = np.zeros(count, dtype=bool)
    if not scene.kinds[0].startswith("speed"):
        for at, row, e in crossings(slips, count, function.least):
            # Any slip goes with this restitution; it is an answer if the function gives it there.
            part = scene.of(np.array([at]), np.full(1, e))
            undetermined[at] |= (
                abs(difference(part, part.any_slip_at(part.regimes()[row])[1], e)[0]) <= REDUNDANT
            )
    scene.undetermined = undetermined.reshape(scene.shape)
    return found


def _in_order(scene: Scene, roots: list[Root], forward_only: bool) -> list[tuple[Root, Any]]:
    """The distinct roots that fit, by rising closing speed, and their cases in the batch."""
    fitting = [root for root in roots if root is not NO_ROOT and np.any(root.closing > 0.0)]
    for root in fitting:
        scene.undetermined = scene.undetermined | ((root.closing > 0.0) & (root.one_of_many > 0.0))
    if not fitting or np.all(scene.undetermined | scene.ambiguous):
        return []
    if len(fitting) == 1 and scene.plain and not forward_only:
        return [(fitting[0], np.True_)]
    whole = np.array([[np.broadcast_to(part, scene.shape) for part in root] for root in fitting])
    speeds_a, speeds_b, _, _, closing, *_ = np.moveaxis(whole, 1, 0)

    def sort() -> None:
        """Sort the answers by closing speed in every case, those left out last."""
        order = np.argsort(closing, axis=0, kind="stable")
        whole[:] = np.take_along_axis(whole, order[:, np.newaxis], axis=0)

    closing[np.broadcast_to(scene.undetermined | scene.ambiguous, closing.shape)] = np.nan
    if forward_only:
        closing[np.minimum(speeds_a, speeds_b) < -ROOT_TOL * closing] = np.nan
    sort()
    apart = abs(speeds_a[1:] - speeds_a[:-1]) + abs(speeds_b[1:] - speeds_b[:-1])
    closing[1:][apart <= ROOT_TOL * closing[1:]] = np.nan
    sort()
    return [
        (Root(*root), there)
        for root, there in zip(whole, closing > 0.0, strict=True)
        if np.any(there)
    ]


def _answers(
    cases: Cases,
    attempted: Attempt,
    known: dict[str, Any],
    function: RestitutionOf | None,
    forward_only: bool,
    ways: Ways,
    reconstruction: Callable[..., Reconstruction],
) -> tuple[Impact, ...]:
    """The impact of each root; raises for a single case without one. ``reconstruction`` makes what
    says how it was found.
    """
    scene, found, inputs = attempted.scene, attempted.found, attempted.inputs
    faults = input_faults(scene.numbers, inputs.incomplete)
    of_walls = [
        np.isinf(scene.numbers[f"{name[-1]}.mass"])
        for name in scene.names
        if name.startswith("delta_v")
    ]
    faults += [(of_wall, Status.INFINITE_MASS) for of_wall in of_walls]
    faults.append((scene.undetermined, Status.UNDETERMINED))
    faults.append((scene.ambiguous, Status.AMBIGUOUS))
    staying = [
        split_texts(body, ("vx", "vy", "speed", "course"))[0] for body in (inputs.a, inputs.b)
    ]

    def inputs_of(root: Root, keep: Any) -> Inputs:
        bodies = []
        for label, body, speed, given in zip(
            "ab", (inputs.a, inputs.b), root[:2], staying, strict=True
        ):
            speed = speed * scene.speed_unit
            vx, vy = (
                cases.where(keep, speed * scene.numbers[f"course_{label}[{i}]"] + 0.0)
                for i in range(2)
            )
            bodies.append(moved(body, vx, vy, body.yaw_rate, given))
        e = inputs.restitution if function is None else cases.where(keep, root.restitution)
        own = attempted.inputs_of(root)
        return replace(own, a=bodies[0], b=bodies[1], restitution=e)

    if inputs.tyres:
        faults += tyre_faults(inputs.duration, inputs.tyres)
    nowhere = np.zeros(scene.shape, dtype=bool)
    count = sum((there.astype(np.int64) for _, there in found), nowhere.astype(np.int64))
    # Stuck and slid.
    count = np.where(scene.ambiguous, 2, count) if np.any(scene.ambiguous) else count
    impacts: list[Impact] = []
    scenes: list[ComponentScene | None] = []
    backward, whose, turned = 0.0, "", nowhere
    for root, there in found or [(NO_ROOT, nowhere)]:
        status = cases.first_status((*faults, (there, Status.OK), (True, Status.CONTRADICTORY)))
        if isinstance(status, int) and status != Status.OK:
            say = Sentences(inputs.texts)
            if status == Status.AMBIGUOUS and isinstance(scene, ComponentScene):
                sticks = any(np.any(one.ambiguous & one.sticks) for one in scene.ways or [scene])
                if np.any(scene.both_ways) and not sticks:
                    raise _slid_either_way(scene, known, say, ways.one_way)
                raise _stuck_or_slid(scene, known, say, ways.again)
            if inputs.tyres and status == Status.CONTRADICTORY:
                raise error_of(
                    status,
                    f"no speeds were found with which a contact with these tyres has "
                    f"{' and '.join(known)}: {LOOKED_FOR}. Give another known in place of one of "
                    "these, check the courses and the normal, or take `reconstruct.posterior` with "
                    "wide priors for the speeds, which looks everywhere",
                )
            raise _refusal(scene, status, known, function, forward_only, say, ways.turned)
        names = (*scene.names, *getattr(scene, "recorders", ()))
        origin = reconstruction(names, root.condition, count)
        own = scene.of_way(root.way) if isinstance(scene, ComponentScene) else None
        if own is not None:
            origin = replace(origin, regime=own.stated, one_sided=_sides(own, cases, root, there))
        impact = run_forward(
            partial(inputs_of, root), status, origin, None if cases.shape is None else "nan"
        )
        for label, speed in zip("AB", root[:2], strict=True):
            speed = np.where(impact.refused, np.nan, speed * scene.speed_unit)
            backward, whose = min(
                (backward, whose), (float(np.fmin.reduce(speed, axis=None, initial=0.0)), label)
            )
            turned = turned | np.less(speed, 0.0)
        impacts.append(impact)
        scenes.append(own)
    if cases.shape is not None and np.any(impacts[0].refused):
        warn_of_refusals(impacts[0].status, ASK_ALONE)
    _warn_of_folds(scene, found, count)
    if isinstance(scene, ComponentScene):
        scene.warn(np.logical_not(impacts[0].refused), cases)
        for own, impact in zip(scenes, impacts, strict=True):
            if own is not None:
                _warn_of_slip(own, impact, cases)
    if backward < 0.0:
        cure = (
            "backwards along its course; check the courses, and the normal, which must point "
            "from A into B"
        )
        text = (
            f"the speed of {whose} came out as {said(backward, 'speed', given_texts(impacts[0]))}: "
            f"{cure}"
        )
        if wrong := ways.turned() if cases.shape is None else "":
            text += f". With {wrong} of the other sign both go forwards: {LATERAL}"
        warning = OutOfRangeWarning(
            cases.how_many(turned) + text, code="negative_speed", value=backward
        )
        warn_of_cases(warning, {f"a speed comes out below 0, {cure}": cases.each(turned)})
    return tuple(impacts)


def _sides(scene: ComponentScene, cases: Cases, root: Root, there: Any) -> dict[str, Any] | None:
    """Which way the truth may lie from each speed; None unless ``slid`` asked for it."""
    if not scene.slid:
        return None
    sides = scene.sides or (0.0, 0.0)
    return {
        f"speed_{label}": cases.sides(np.where(there, _of_size(side, speed), 0.0))
        for label, side, speed in zip("ab", sides, root[:2], strict=True)
    }


def _of_size(side: Any, speed: Any) -> Any:
    """Which way the size of a speed may go, by which way it goes along the course: backwards, the
    size of one that falls rises.
    """
    return np.where(np.less(speed, 0.0), -side, side)


def _if_it_slid(scene: ComponentScene, impact: Impact, say: Sentences) -> str:
    """What follows for the speeds of a single case if its contact slid."""
    if scene.slides_both_ways():
        return f"it may have in either direction, since {EITHER_WAY}, and the speeds are open"
    signed = [_along(impact, label, scene) for label in "ab"]
    speeds, sides = scene.if_slid([speed / scene.speed_unit for speed in signed])
    ends = [float(speed * scene.speed_unit) for speed in speeds]
    return " and ".join(
        bounds_of(
            {
                f"speed_{label}": int(np.nan_to_num(_of_size(side, end)))
                for label, side, end in zip("ab", sides, ends, strict=True)
            },
            {f"speed_{label}": _told(end, say) for label, end in zip("ab", ends, strict=True)},
        )
    )


def _warn_of_slip(scene: ComponentScene, impact: Impact, cases: Cases) -> None:
    """Warn of a contact that was stated or taken to stick and may have slid, and of cases of a
    batch for which that has to be said.
    """
    answered = np.logical_not(impact.refused)
    slides = scene.may_slide & answered
    if np.any(slides):
        why = (
            f"contacts between vehicles slide from {MAY_SLIDE:g} on "
            "(reference.INTER_VEHICLE_FRICTION)"
        )
        ratio = float(np.max(np.where(slides, abs(scene.ratio), 0.0)))
        single = cases.shape is None
        then = (
            f"If it slid, {_if_it_slid(scene, impact, Sentences(impact.inputs.texts))}"
            if single
            else "If it slid, what was found is one end of the speeds that it may have had"
        )
        text = f"to stick, the contact needs an impulse ratio of {ratio:.2f}, and {why}. {then}"
        sentence = (
            f"the contact was taken to stick at an impulse ratio of {MAY_SLIDE:g} or more, "
            f"and {why}. If it slid, the speeds are those of one end of a family; "
            "`slid='bound'` says which"
        )
        warning = IllConditionedWarning(
            cases.how_many(slides) + text, code="may_slide", ratio=ratio
        )
        warn_of_cases(warning, {sentence: cases.each(slides)})
    if cases.shape is not None and np.any(scene.both_ways):
        text = (
            f"components of delta-V do not tell in which direction the contact slid: {EITHER_WAY}, "
            "so a bound has no side; give another component, or one of the speeds"
        )
        warning = IllConditionedWarning(
            cases.how_many(scene.both_ways) + text, code="slid_either_way"
        )
        warn_of_cases(warning, {text: cases.each(scene.both_ways)})
    if cases.shape is not None and scene.rule == FRICTION and not scene.slid:
        left = (scene.ambiguous | scene.undetermined) & np.logical_not(answered)
        if np.any(left & scene.leaves_slip):
            text = (
                "components of delta-V do not tell whether the contact stuck or slid, or it "
                "slid and leaves the slip open: write `regime='sticking'` if it stuck, give "
                "one of the speeds, or write `slid='bound'` for the end of the speeds that it "
                "may have had"
            )
            warning = IllConditionedWarning(cases.how_many(left) + text, code="stuck_or_slid")
            warn_of_cases(warning, {text: cases.each(left)})


def _stuck_or_slid(
    scene: ComponentScene,
    known: dict[str, Any],
    say: Sentences,
    again: Callable[..., tuple[Impact, ...]],
) -> AmbiguousSolutionError:
    """The error for a single case in which the contact either stuck or slid."""
    # Several ways may lead to one answer. A ratio of the other sign slid the other way.
    ratios = list(
        {
            f"{float(one.ratio):.9g}": float(one.ratio)
            for one in scene.ways or [scene]
            if np.any(one.ambiguous)
        }.values()
    )
    friction = float(scene.bound)
    stuck = again(regime="sticking", slid=None)
    slid: list[Impact] = []
    if math.isinf(friction):
        # Each at the ratio that is shown: beside a speed not that of the one that stuck.
        with suppress(CollisionsError):
            slid = [
                one
                for one in again(regime="sliding", slid="bound")
                if len(scene.unknown) == 1
                or any(abs(one.impulse_ratio - ratio) <= ROOT_TOL for ratio in ratios)
            ]
    # Far below the friction, a contact that slid did so at the friction, or it is that of another
    # impulse.
    far = not math.isinf(friction) and max(map(abs, ratios)) <= CLEARLY_BELOW * friction
    if far:
        with suppress(CollisionsError):
            slid = list(again(regime="sliding", slid="bound"))
    if not slid:
        for ratio in ratios:
            either_way = again(regime="sliding", slid="bound", friction=abs(ratio))
            slid.append(min(either_way, key=lambda one: abs(one.impulse_ratio - ratio)))
    ends = [[_along(impact, label, scene) for label in "ab"] for impact in slid]
    if len(stuck) == len(slid) == 1:
        # Where both are one place they have the same digits.
        same = ROOT_TOL * slid[0].closing_speed
        alike = zip(ends[0], (_along(stuck[0], label, scene) for label in "ab"), strict=True)
        ends = [[own if abs(own - end) <= same else end for end, own in alike]]
    speeds = [
        {f"speed_{label}": _told(end, say) for label, end in zip("ab", one, strict=True)}
        for one in ends
    ]
    bounds = ", or ".join(
        " and ".join(bounds_of(getattr(impact.reconstruction, "one_sided", None) or {}, one))
        for impact, one in zip(slid, speeds, strict=True)
    )
    alone = ", or ".join(
        _alone([_along(impact, label, scene) for label in "ab"], say) for impact in stuck
    )
    shown = " or ".join(dict.fromkeys(f"{abs(one):.2f}" for one in ratios))
    allowed = (
        "`friction=inf` does not say that it stuck"
        if math.isinf(friction)
        else f"`friction={friction:.4g}` is not clearly above that"
    )
    at = "at that ratio"
    if far:
        at = f"with `friction={friction:.4g}`"
        allowed = f"a contact that slid {at} has the same within {ACCURACY:.0%}"
    then = (
        "" if scene.slid else "; or `slid='bound'` for this end of the speeds that it may have had"
    )
    return AmbiguousSolutionError(
        f"{' and '.join(known)} do not tell whether the contact stuck or slid: they "
        f"have an impulse ratio of {shown}, and {allowed}. If it stuck, {alone}; if it slid "
        f"{at}, {bounds}. Write `regime='sticking'` or `regime='sliding'` if you "
        f"know which, the latter with one of the speeds or the energy lost{then}"
        "`|. Both answers are in .solutions|`",
        code=Status.AMBIGUOUS.label,
        ratio=abs(ratios[0]),
        solutions=(*stuck, *slid),
    )


def _slid_either_way(
    scene: Scene,
    known: dict[str, Any],
    say: Sentences,
    one_way: Callable[[float], tuple[Impact, ...]],
) -> AmbiguousSolutionError:
    """The error for a single case of which a bound has no side."""
    solutions = (*one_way(1.0), *one_way(-1.0))
    then, where = "a bound has no side", "The end that was found is in .solutions"
    if len(solutions) > 1:
        where = "Both answers are in .solutions"
        then = ", or ".join(
            " and ".join(
                bounds_of(
                    getattr(impact.reconstruction, "one_sided", None) or {},
                    {f"speed_{label}": _told(_along(impact, label, scene), say) for label in "ab"},
                )
            )
            for impact in solutions
        )
    return AmbiguousSolutionError(
        f"{' and '.join(known)} do not tell in which direction the contact slid: {EITHER_WAY}, so "
        f"{then}. Give another component of delta-V, or one of the speeds`|. {where}|`",
        code=Status.AMBIGUOUS.label,
        solutions=solutions,
    )


def _along(impact: Impact, label: str, scene: Scene) -> float:
    """The speed of a vehicle before, below 0 where it goes backwards along its course."""
    before = getattr(impact, label).before
    c, s = (scene.numbers[f"course_{label}[{i}]"] for i in range(2))
    return float(math.copysign(before.speed, c * before.vx + s * before.vy))


def _told(speed: float, say: Sentences) -> str:
    """The size of a speed along a course, and that it is backwards."""
    return say(abs(speed), "speed") + (" backwards along its course" if speed < 0.0 else "")


def _alone(speeds: Sequence[float], say: Sentences) -> str:
    """The speeds of both vehicles if the contact stuck."""
    if min(speeds) >= 0.0:
        one, other = (say(speed, "speed") for speed in speeds)
        return f"the speed of A is {one} and that of B {other}"
    return " and ".join(
        f"{label} would go backwards along its course at {say(-speed, 'speed')}"
        if speed < 0.0
        else f"the speed of {label} is {say(speed, 'speed')}"
        for label, speed in zip("AB", speeds, strict=True)
    )


def _while_tyres_act(
    cases: Cases,
    scene: Scene,
    found: list[tuple[Root, Any]],
    inputs: Inputs,
    known: dict[str, Any],
    forward_only: bool,
    regime: str | None,
    balanced: bool,
) -> list[tuple[Root, Any]]:
    """The roots of a contact in which the tyres act, in order, and where each is: those to which
    the roots of the instant and other speeds lead.

    Roots that are ``balanced`` have the impulse of the tyres already: of a contact that stuck, or
    beside a known speed and more components than it needs.
    """
    directions = {
        label: (scene.numbers[f"course_{label}[0]"], scene.numbers[f"course_{label}[1]"])
        for label in "ab"
    }
    shape, unit = cases.shape or (), scene.speed_unit
    starts = [
        tuple(np.where(there, speed * unit, np.nan) for speed in (root.speed_a, root.speed_b))
        for root, there in found
    ]
    starts += other_starts(inputs, known, shape)
    if not starts:
        return []
    begins = np.stack([np.stack(np.broadcast_arrays(*start)) for start in starts], axis=1)
    more = balanced and len(known) > 2
    answer = speeds_with_tyres(
        inputs,
        directions,
        (begins[0], begins[1]),
        known,
        (len(starts), *shape),
        len(found) if more else 0,
    )
    fits = answer.settled
    if balanced and not more:
        # Of the contacts that stick, where it is known that this one did.
        fits = fits & answer.sticks
        if regime is None:
            fits = fits & np.any([there for _, there in found] or [False], axis=0)
    if answer.misfit is not None:
        if regime is not None:
            # Other starts may lead to a contact that ended otherwise than was stated.
            so = np.broadcast_to(answer.sticks == (regime == "sticking"), fits.shape).copy()
            so[: len(found)] = True
            fits = fits & so
        fits = fits & (answer.misfit <= CONTRADICTION)
        fits, least = _best_of(answer.misfit, fits)
        if isinstance(scene, ComponentScene):
            scene.misfit = np.where(np.isfinite(least), least, scene.misfit)
            scene.may_slide = scene.may_slide & np.any(fits[: len(found)], axis=0)
    roots = []
    for i in range(len(starts)):
        instant = found[i][0] if i < len(found) else NO_ROOT
        condition = instant.condition if answer.condition is None else answer.condition[i]
        roots.append(
            Root(
                answer.speed_a[i] / unit,
                answer.speed_b[i] / unit,
                np.where(np.isfinite(answer.speed_a[i]), inputs.restitution, np.nan),
                condition,
                np.where(fits[i], answer.closing[i] / unit, np.nan),
            )
        )
    return _in_order(scene, roots, forward_only)


def _best_of(misfit: Any, fits: Any) -> tuple[Any, Any]:
    """Of what was found from several starts, all that fit exactly, or else the one that fits best,
    and by how much that misses.
    """
    misfit = np.where(fits, misfit, np.inf)
    least = np.min(misfit, axis=0)
    best = np.arange(len(misfit)).reshape(-1, *[1] * np.ndim(least)) == np.argmin(misfit, axis=0)
    return fits & np.where(least <= ROOT_TOL, misfit <= ROOT_TOL, best), least


def _warn_of_folds(scene: Scene, found: list[tuple[Root, Any]], count: Any) -> None:
    """Warn a study of samples near a fold: some cases have no answer, or its two answers all but
    meet.
    """
    if len(found) < 2:
        return
    (one, _), (other, both) = found[:2]
    gap = np.hypot(one.speed_a - other.speed_a, one.speed_b - other.speed_b)[both]
    if gap.size and (np.any(np.less(count, 2)) or gap.min() < _NEAR_FOLD * gap.max()):
        warn_of_samples(
            OutOfRangeWarning(
                f"{' and '.join(scene.names)} reach a fold, where two answers meet and beyond "
                "which there is none: the samples are no range of one answer. Look at both "
                "answers, or give components of delta-V or another known",
                code="fold",
            )
        )


def _refusal(
    scene: Scene,
    status: int,
    known: dict[str, Any],
    function: RestitutionOf | None,
    forward_only: bool,
    say: Sentences,
    turned: Callable[[], str],
) -> CollisionsError:
    """The error for a single case without a solution."""
    names = " and ".join(known)
    values = {
        name: f"{name} = {say(value, 'energy' if name == 'energy_loss' else 'speed')}"
        for name, value in known.items()
    }
    speed_is_known = scene.kinds[0].startswith("speed")
    forward = ", none of them backwards," if forward_only else ""
    (ax, ay), (bx, by) = (
        [scene.numbers[f"course_{label}[{i}]"] for i in range(2)] for label in "ab"
    )
    if status == Status.INFINITE_MASS:
        kind = next(kind for kind in known if kind.startswith("delta_v"))
        other = "delta_v_b" if kind == "delta_v_a" else "delta_v_a"
        text = (
            f"{kind} is that of an infinite mass, whose motion tells nothing of the impact; give "
            f"{other}"
        )
    elif isinstance(scene, ComponentScene) and status == Status.UNDETERMINED:
        text = (
            f"the contact slides, or its speeds do not show in {names}: their direction only "
            "repeats the friction, which leaves the slip undetermined; give "
            + ("the speed of the other vehicle" if speed_is_known else "one of the speeds")
        )
        if scene.rule == FRICTION and not scene.slid:
            text += ", or write `slid='bound'` for the end of the speeds that it may have had"
    elif isinstance(scene, ComponentScene) and (
        scene.stated == "sticking" and abs(scene.shown_ratio()) > scene.bound
    ):
        status = Status.CONTRADICTORY
        text = (
            "to stick, the contact needs an impulse ratio of "
            f"{float(abs(scene.shown_ratio())):.2f}, and "
            f"`friction={float(scene.bound):.4g}` allows no more than that; give the "
            "friction that held it (or inf), or leave out `regime='sticking'`"
        )
    elif (
        not isinstance(scene, ComponentScene)
        and not speed_is_known
        and abs(ax * by - ay * bx) <= 8.0 * EPS
    ):
        status = Status.PARALLEL_HEADINGS
        text = (
            f"the courses are parallel, so {names} tell of the closing speed alone; give one of "
            "the speeds"
        )
    elif status == Status.UNDETERMINED and "energy_loss" in scene.kinds and scene.e > _ELASTIC:
        energy = values[scene.names[scene.kinds.index("energy_loss")]]
        text = (
            f"many speeds along these courses lead to {energy} as far as rounding lets it tell, "
            "so it does not say which of them; give another of the knowns"
        )
    elif status == Status.UNDETERMINED and speed_is_known:
        text = (
            f"{names} leave the other speed open, for many lead to the same; give another of the "
            "knowns"
        )
    elif status == Status.UNDETERMINED:
        text = (
            f"where the contact slides, {names} tell of the closing speed alone and leave the "
            "slip open; give one of the speeds"
        )
    else:
        if function is not None:
            function.complain()
        status = Status.CONTRADICTORY
        text = (
            f"no speeds along these courses{forward} fit {' and '.join(values.values())} with "
            f"this restitution, {scene.rule} and geometry; check the courses, and the normal, "
            "which must point from A into B, or give another known in place of one of these"
        )
        if isinstance(scene, ComponentScene) and np.any(scene.friction_differs()):
            text += f"; or the contact slid at another ratio than this friction. {RATIO_SHOWN}"
    if status == Status.CONTRADICTORY and (wrong := turned()):
        text += f". With {wrong} of the other sign there is an answer: {LATERAL}"
    return error_of(status, text)

"""``diagnose``: runs every check on one impact and returns the findings; ``LIMITS`` lists the
checks.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import partial
from typing import Any, cast

from ..impact.impact import Impact
from ..impact.left_out import left_out
from ..kernels.elementwise import UNCHECKED
from ..messages.errors import InputError, MissingInputError
from ..messages.marked import type_of
from ..quantities.formatting import UnitSystem, check_system
from ..quantities.reading import ArgumentReader, amount, need_one_case, single_number
from ..quantities.settings import callers_options, computing, units_required
from ..quantities.tables import given_texts, spoken_system
from ..quantities.units import Input, Pair, rendered, shown
from ..reconstruct import MomentumSolution
from ..reconstruct.found_again import need_found_again
from ..scene.run import Run
from ..vehicle.drag import USUAL_DURATION, read_drag, read_duration
from ..vehicle.outlines import read_outline
from ..vehicle.tyres import Tyres
from ..vehicle.vehicle import Vehicle, error_of_missing
from . import checks_consistency, checks_inputs, checks_reliability
from .case import Case, Damage, ImpactCase, MomentumCase
from .finding import Check, Findings, Limit
from .scene import diagnose_run

_MODULES = (checks_consistency, checks_reliability, checks_inputs)
_CHECKS = [
    check for module in _MODULES for check in vars(module).values() if isinstance(check, Check)
]
_CHECKS_OF = {
    kind: [check for check in _CHECKS if issubclass(kind, check.kind)]
    for kind in (ImpactCase, MomentumCase)
}
LIMITS: Mapping[str, Limit] = {check.code: check.limit for check in _CHECKS}
"""What each finding measures, its default limit and where that is from, by code and in the order in
which findings are listed.
"""

_single = partial(single_number, text="takes one value: diagnose takes one case")


@computing
def diagnose(
    impact: Impact | MomentumSolution | Run,
    *,
    outline_a: Any = None,
    outline_b: Any = None,
    duration: Input = USUAL_DURATION,
    drag: Input = 0.7,
    tyres_a: Tyres | None = None,
    tyres_b: Tyres | None = None,
    limits: Mapping[str, Any] | None = None,
    crush_energy: Input | None = None,
    damage_pdof_a: Input | None = None,
    damage_pdof_b: Input | None = None,
    damage_delta_v_a: Input | Pair | None = None,
    damage_delta_v_b: Input | Pair | None = None,
    units: UnitSystem | None = None,
) -> Findings:
    """Check an impact, forward or reconstructed, for anything odd: returns the findings, an energy
    gain first.

    A finding is a reason to look again, not an error; the absence of findings proves nothing. Each
    compares a measured value with a limit; ``diagnostics.LIMITS`` lists the limits by code, with
    their units and sources.

    Parameters
    ----------
    impact : Impact, MomentumSolution or scene.Run
        One case, of any solver, including one that ``reconstruct`` found; or the answer of
        ``reconstruct.momentum``, whose courses, speeds, energy and evidence are judged; or a scene
        as it went: the findings of each impact in order, with its number and time and the outlines
        of its movers, and then what the scene itself leaves open. What shows the damage of one
        impact is then refused.
    outline_a, outline_b : tuple or list, optional
        For an Impact only: the outline of a vehicle, measured from its centre of mass, for
        ``point_outside`` and, if both are given, ``outlines_overlap``, ``outlines_gap`` and
        ``outlines_interpenetrate``: (length, width); (length, width, offset) [m] with the centre of
        mass that far ahead of the middle; or the corners (forward, left) [m] of a convex outline,
        in order. The vehicle then needs x, y and heading.
    duration : float, str or Quantity [s]
        Duration of the contact, as for ``left_out``; the outlines are followed for this time after
        the impact.
    drag : float, str or Quantity [-]
        Drag factor of the tyres, as for ``left_out``.
    tyres_a, tyres_b : travel.Tyres, optional
        For an Impact that was solved without them: the wheels of each vehicle in place of the drag,
        as for ``left_out``, in findings and moves. The vehicle then needs a heading.
    limits : dict of str to float, str or Quantity, optional
        Limits that replace the defaults, by code, units allowed, such as ``{"near_collinear": "15
        deg"}``; inf switches off a finding that appears above its limit, 0 one that appears below
        it.
    crush_energy : float, str or Quantity [J], optional
        Energy of the damage of both vehicles together, as from ``reconstruct.crush_energy``, for
        ``momentum_energy``. Whether it is the energy absorbed at maximum crush or what remains of
        it after restitution depends on the stiffness coefficients, so of an Impact it is compared
        with the nearer of ``energy_loss`` and ``energy_absorbed`` plus ``energy_loss_tangential``;
        of a MomentumSolution with the energy lost but for what tyres and an impulse from outside
        took.
    damage_pdof_a, damage_pdof_b : angle [rad], optional
        Direction of force shown by the damage of a vehicle, 0 from straight ahead, positive
        clockwise, for ``pdof_off_damage`` and ``yaw_against_lever``. The vehicle then needs a
        heading.
    damage_delta_v_a, damage_delta_v_b : float, str or Quantity [m/s], or pair of them, optional
        Delta-V shown by the damage of a vehicle, or by its event data recorder, for
        ``delta_v_off_damage`` and, if both are given, ``delta_v_pair``: the magnitude, or the pair
        (forward, left), which is compared as a vector. For a pair the vehicle needs a heading.
    units : "si", "metric" or "us", optional
        Units of the sentences: m/s, rad and J; km/h, degrees and kJ; mph, ft and ft lbf. By default
        "us" if the inputs were given so, else "metric". Measured value and limit stay in SI, as do
        the numbers in a sentence that asks which unit was meant.

    Returns
    -------
    tuple of Finding
        In the order of ``LIMITS``, vehicle A before B, shown as a table; empty if nothing was
        found. Its ``measured`` holds the codes of all checks that were made, whether or not they
        found anything. Its ``moves`` are what would move the answer: a table of delta-V and yaw
        rate with the contact point 0.25 m aside, the normal turned by 5 degrees, restitution,
        friction, and what an impulse leaves out, largest first. An answer of planar momentum has
        none.

    Raises
    ------
    InputError
        An argument that cannot be used, an unknown code, a batch (``ShapeError``), an answer that
        was refused, tyres for an answer that has its own or was followed in time, outlines for an
        answer of planar momentum, which has no positions, or a ``reconstruct.Fit`` (diagnose the
        impact at its values instead).
    MissingInputError
        An outline of a vehicle without position or heading, or a PDOF from the damage of a vehicle
        without heading.

    Notes
    -----
    What cannot be measured is left out, such as lever arms without a contact point or the course of
    a vehicle at rest. In an answer of the eccentric model, contact points and restitution cannot
    disagree, so ``contact_points_approach`` appears only where ``solve`` took a smaller model. Nor
    can an answer turn a vehicle against its own impulse, so ``yaw_against_lever`` needs the
    direction of force shown by the damage. A linear impact has no tangential direction to judge.

    Examples
    --------
    Example 3 of the paper has a restitution of 0.80, which serves the arithmetic and is no
    guidance:

    >>> import collisions as col
    >>> from collisions.diagnostics import diagnose
    >>> a = col.Vehicle(mass="900 kg", vx="60 km/h", yaw_inertia=float("inf"), x=0.0, y=4.0)
    >>> b = col.Vehicle(mass="1000 kg", yaw_inertia="1333 kg*m**2", x=0.0, y=2.0, pivot=(0.0, 0.0))
    >>> impact = col.eccentric(a, b, 0.80, normal=0.0, point=(0.0, 4.0), friction=0.0)
    >>> finding = diagnose(impact)[0]
    >>> finding.code, finding.measured, finding.limit
    ('restitution', 0.8, 0.3)
    >>> found = diagnose(impact, limits={"restitution": 0.9, "normal": 1.0})
    >>> len(found), found.moves[0].what
    (0, 'contact point 0.25 m aside')
    """
    given = dict(locals())
    if isinstance(impact, Run):
        with callers_options():
            spoken = (
                cast(UnitSystem, spoken_system(given_texts(impact))) if units is None else units
            )
        return diagnose_run(impact, given, spoken, partial(_of_one, **given))
    return _of_one(**given)


def _of_one(
    impact: Impact | MomentumSolution,
    *,
    outline_a: Any,
    outline_b: Any,
    duration: Input,
    drag: Input,
    tyres_a: Tyres | None,
    tyres_b: Tyres | None,
    limits: Mapping[str, Any] | None,
    crush_energy: Input | None,
    damage_pdof_a: Input | None,
    damage_pdof_b: Input | None,
    damage_delta_v_a: Input | Pair | None,
    damage_delta_v_b: Input | Pair | None,
    units: UnitSystem | None,
    starts: Mapping[str, Vehicle] = {},
) -> Findings:
    """The findings of one answer; ``starts`` has by label the vehicles of a scene as they were
    given.
    """
    # An implausible limit is intended, so it is not warned of; where units are required, it has
    # one.
    implausible = "limits['suspect_yaw_rate']", "limits['suspect_angle']"
    need_one_case(impact, (Impact, MomentumSolution), "diagnose", runs=True)
    need_found_again(impact)
    with callers_options():
        reader = ArgumentReader(trusted=() if units_required.get() else implausible)
        outlines = {
            label: _read_outline(reader, impact, given, label)
            for label, given in (("a", outline_a), ("b", outline_b))
            if given is not None
        }
        if units is None:
            units = cast(UnitSystem, spoken_system(given_texts(impact)))
        try:
            check_system(units)
        except InputError as problem:
            reader.refuse(problem)
        allowed = read_limits(limits, reader)
        if crush_energy is not None:
            crush_energy = _single(
                reader, amount(reader, crush_energy, "J", "crush_energy"), "crush_energy"
            )
        damage = {
            "a": _read_damage(reader, impact, damage_pdof_a, damage_delta_v_a, "a"),
            "b": _read_damage(reader, impact, damage_pdof_b, damage_delta_v_b, "b"),
        }
        left = None
        wheels = {"tyres_a": tyres_a, "tyres_b": tyres_b}
        given_wheels = {name: one for name, one in wheels.items() if one is not None}
        if given_wheels and not (isinstance(impact, Impact) and impact.pulse is None):
            reader.refuse(_no_use_for_tyres(impact, *given_wheels))
        if isinstance(impact, Impact):
            reader.close()
            if impact.pulse is None:
                left = left_out(
                    impact, duration=duration, drag=drag, tyres_a=tyres_a, tyres_b=tyres_b
                )
        # What an impulse leaves out comes with the duration and drag that it was asked for.
        time = _single(
            reader, read_duration(reader, duration) if left is None else left.duration, "duration"
        )
        pull = _single(
            reader, read_drag(reader, drag, "drag") if left is None else left.drag, "drag"
        )
        reader.close()
    known: Any = {
        "damage": damage,
        "crush_energy": crush_energy,
        "duration": time,
        "drag": pull,
        "tyres": {name[-1]: one for name, one in given_wheels.items()},
        "units": units,
    }
    case: Case
    if isinstance(impact, Impact):
        case = ImpactCase(answer=impact, outlines=outlines, left_out=left, starts=starts, **known)
    else:
        case = MomentumCase(answer=impact, **known)
    findings, measured = [], []
    for check in _CHECKS_OF[type(case)]:
        if allowed[check.code] != check.off:
            values = list(check.measure(case))
            findings += check.findings(values, allowed[check.code])
            measured += [check.code] if values else []
    return Findings(findings, measured, units, getattr(case, "moves", None))


def _no_use_for_tyres(answer: Impact | MomentumSolution, name: str, *_: str) -> InputError:
    """Why an answer is not judged with tyres beside it."""
    text = (
        "the impact was followed in time; give tyres_a and tyres_b to time_resolved, which has "
        "them act in it"
        if isinstance(answer, Impact)
        else "a MomentumSolution takes them itself; give duration, tyres_a and tyres_b to "
        "reconstruct.momentum"
    )
    return InputError(f"{name} is of no use here: {text}", code="bad_combination", argument=name)


def read_limits(given: Any, reader: ArgumentReader) -> dict[str, float | None]:
    """The limits of a call: the defaults, and the caller's in their place; units allowed."""
    limits = {code: limit.default for code, limit in LIMITS.items()}
    if given is not None and not isinstance(given, Mapping):
        kind = type_of(given)
        text = (
            "limits must be `|a dict|a table` from code to limit, such as `{'tyre_impulse': 0.2}`; "
            f"got {kind}"
        )
        reader.refuse(InputError(text, code="bad_limit", argument="limits"))
        return limits
    for code, value in (given or {}).items():
        name = f"limits[{rendered(code)}]"
        if code not in LIMITS:
            text = f"{name}: there is no finding {shown(code)}; known are {', '.join(LIMITS)}"
            reader.refuse(InputError(text, code="unknown_finding", argument="limits"))
            continue
        count = len(reader.problems)
        read = _single(
            reader,
            reader.number(value, LIMITS[code].unit, name, UNCHECKED),
            name,
            argument="limits",
        )
        if len(reader.problems) == count and not read >= 0.0:
            text = f"{name} must be >= 0 (inf switches it off), got {shown(value)}"
            reader.refuse(InputError(text, code="bad_limit", argument="limits"))
        limits[code] = read
    return limits


def _read_outline(
    reader: ArgumentReader, answer: Impact | MomentumSolution, given: Any, label: str
) -> Any:
    """The corners of an outline; refused if its vehicle has no position."""
    name = f"outline_{label}"
    if isinstance(answer, Impact):
        _need(reader, answer, ("x", "y", "heading"), name, label)
        return read_outline(reader, given, name)
    text = (
        f"{name} needs positions, which a MomentumSolution has not; leave it out, or diagnose "
        "the impact of collisions.eccentric at its speeds"
    )
    return reader.refuse(InputError(text, code="not_an_impact", argument=name))


def _read_damage(
    reader: ArgumentReader, answer: Impact | MomentumSolution, pdof: Any, delta_v: Any, label: str
) -> Damage:
    """The PDOF seen from the vehicle, the delta-V that its damage or recorder shows, and of a pair
    its direction as a PDOF.
    """
    direction, name = None, f"damage_pdof_{label}"
    if pdof is not None:
        pdof = _single(reader, reader.number(pdof, "rad", name), name)
        _need_heading(reader, answer, name, label)
    name = f"damage_delta_v_{label}"
    if isinstance(delta_v, (tuple, list)):
        forward, left = (_single(reader, part, name) for part in reader.pair(delta_v, "m/s", name))
        _need_heading(reader, answer, name, label)
        if not reader.problems:
            delta_v, direction = math.hypot(forward, left), math.atan2(left, -forward)
    elif delta_v is not None:
        delta_v = _single(reader, amount(reader, delta_v, "m/s", name), name)
    return Damage(pdof, delta_v, direction)


def _need_heading(
    reader: ArgumentReader, answer: Impact | MomentumSolution, name: str, label: str
) -> None:
    if isinstance(answer, Impact):
        _need(reader, answer, ("heading",), name, label)
    elif getattr(answer, f"pdof_{label}") is None:
        text = (
            f"the solution has no pdof_{label}, which {name} needs; give heading_{label}='30 "
            "deg' (where the vehicle points) to reconstruct.momentum"
        )
        reader.refuse(MissingInputError(text, code="missing_heading", argument=f"heading_{label}"))


def _need(
    reader: ArgumentReader, impact: Impact, fields: tuple[str, ...], purpose: str, label: str
) -> None:
    vehicle: Vehicle = getattr(impact, label).before
    lacking = [field for field in fields if getattr(vehicle, field) is None]
    if lacking:
        reader.refuse(error_of_missing(vehicle, lacking[0], purpose, label))

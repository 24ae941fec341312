"""diagnose: every finding on one impact."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any, TypeVar

import numpy as np

from ..amounts import at_least_zero
from ..contact_effects import left_out
from ..errors import InputError, ShapeError
from ..impact import Impact
from ..one_case import need_one_case
from ..outlines import read_outline
from ..reading import ArgumentReader
from ..reconstruct import MomentumSolution
from ..travel.surfaces import one_value, read_drag
from ..unit_systems import UnitSystem
from ..units import Input
from . import balance, checks_evidence, checks_impact, inputs, robustness
from .case import Balance, Case, Examined, Told, named
from .finding import Finding, Findings, read_limits
from .limits import LIMITS
from .words import read_words

_Examined = TypeVar("_Examined", bound=Examined)
_EVIDENCE: tuple[Callable[[Examined], Iterator[Finding]], ...] = (
    checks_evidence.momentum_energy,
    checks_evidence.pdof_off_damage,
    checks_evidence.delta_v_off_damage,
    inputs.suspect_drag,
    inputs.suspect_duration,
)
_IMPACT: tuple[Callable[[Case], Iterator[Finding]], ...] = (
    checks_impact.energy_gain,
    checks_impact.rounding,
    checks_impact.restitution,
    checks_impact.impulse_ratio,
    checks_impact.friction_gain,
    checks_impact.jamming,
    checks_impact.contact_points,
    checks_impact.outlines,
    checks_impact.normal_against_positions,
    checks_evidence.yaw_against_lever,
    checks_impact.impulse_off_normal,
    checks_impact.heading_off_course,
    checks_impact.point_outside,
    checks_impact.ill_conditioned,
    checks_impact.not_unique,
    checks_impact.tyre_impulse,
    checks_impact.reference_range,
    robustness.model,
    robustness.law,
    robustness.normal,
    inputs.suspect_inputs,
    inputs.suspect_friction,
    inputs.suspect_distance,
)
_BALANCE: tuple[Callable[[Balance], Iterator[Finding]], ...] = (
    balance.energy_gain,
    balance.restitution,
    balance.near_collinear,
    balance.ill_conditioned,
    balance.speed_backwards,
    balance.tyre_impulse,
    balance.suspect_inputs,
)


def diagnose(
    impact: Impact | MomentumSolution,
    *,
    outline_a: Any = None,
    outline_b: Any = None,
    duration: Input = 0.1,
    drag: Input = 0.7,
    limits: Mapping[str, Any] | None = None,
    crush_energy: Input | None = None,
    damage_pdof_a: Input | None = None,
    damage_pdof_b: Input | None = None,
    damage_delta_v_a: Input | None = None,
    damage_delta_v_b: Input | None = None,
    units: UnitSystem = "metric",
) -> Findings:
    """What is odd about an impact, forward or reconstructed: findings, an energy gain first.

    A finding is a reason to look again, not an error; no finding is no proof. Every one compares something measured with a
    limit, which ``diagnostics.LIMITS`` lists by code, with its unit and where it is from.

    Parameters
    ----------
    impact : Impact or MomentumSolution
        One case, of any solver; also one that ``reconstruct`` found, or the answer of ``reconstruct.momentum``, whose courses,
        speeds, energy and evidence are judged.
    outline_a, outline_b : tuple or list, optional
        Of an Impact: outline of a vehicle as seen from its centre of mass, for ``point_outside`` and, with both,
        ``outlines_overlap``, ``outlines_gap`` and ``outlines_interpenetrate``:
        (length, width); (length, width, offset) [m] with the centre of mass so far ahead of the middle; or the corners of a
        convex outline, (forward, left) [m] one after another. The vehicle then needs x, y and heading.
    duration : float, str or Quantity [s]
        Of the contact, as for ``left_out``; also how long the outlines are followed after it.
    drag : float, str or Quantity
        Of the tyres, as for ``left_out``.
    limits : dict of str to float, str or Quantity, optional
        Limits other than the default by code, units allowed, such as ``{"near_collinear": "15 deg"}``; inf switches a finding
        of what is above its limit off, 0 one of what is below.
    crush_energy : float, str or Quantity [J], optional
        Energy that the damage of both vehicles together takes, as by ``reconstruct.crush_energy``, for ``momentum_energy``.
    damage_pdof_a, damage_pdof_b : angle [rad], optional
        Direction of force that the damage of a vehicle shows, 0 from straight ahead, positive clockwise, for
        ``pdof_off_damage`` and ``yaw_against_lever``. The vehicle then needs a heading.
    damage_delta_v_a, damage_delta_v_b : float, str or Quantity [m/s], optional
        Delta-V that the damage of a vehicle, or its recorder, shows, for ``delta_v_off_damage``.
    units : "si", "metric" or "us"
        Of the sentences: m/s, rad and J; km/h, degrees and kJ; mph, ft and ft lbf. Measure and limit stay in SI, as do the
        numbers in a sentence that asks for the unit which was meant.

    Returns
    -------
    tuple of Finding
        In the order of ``LIMITS``, vehicle A before B; empty if nothing was found. Its ``measured`` has the codes of all that
        was looked at, found or not.

    Raises
    ------
    InputError
        An argument that cannot be used, a code that is none, a batch (``ShapeError``), an answer that was refused, outlines for
        one of planar momentum, which has no positions, or a ``reconstruct.Fit``: diagnose the impact at its values.
    MissingInputError
        An outline without a position or heading of its vehicle, a PDOF of the damage without a heading.

    Notes
    -----
    Left out where it cannot be measured: levers without a contact point, courses of a vehicle at rest. Contact points and
    restitution cannot disagree in an answer of the eccentric model, so ``contact_points_approach`` appears for answers of
    ``solve`` by a smaller one only; and an answer cannot turn a vehicle against its own impulse, so ``yaw_against_lever`` needs
    the direction of force that the damage shows. A linear impact has no tangential direction to judge.

    Examples
    --------
    Example 3 of the paper has a restitution of 0.80, which is arithmetic, not guidance:

    >>> import collisions as col
    >>> from collisions.diagnostics import diagnose
    >>> a = col.Vehicle(mass="900 kg", vx="60 km/h", yaw_inertia=float("inf"), x=0.0, y=4.0)
    >>> b = col.Vehicle(mass="1000 kg", yaw_inertia="1333 kg*m**2", x=0.0, y=2.0, pivot=(0.0, 0.0))
    >>> impact = col.eccentric(a, b, 0.80, normal=0.0, point=(0.0, 4.0), friction=0.0)
    >>> finding = diagnose(impact)[0]
    >>> finding.code, finding.measured, finding.limit
    ('restitution', 0.8, 0.3)
    >>> diagnose(impact, limits={"restitution": 0.9, "normal": 1.0})
    ()
    """
    # A limit beyond what is plausible is one on purpose.
    reader = ArgumentReader(trusted=("limits['suspect_yaw_rate']", "limits['suspect_angle']"))
    need_one_case(impact, (Impact, MomentumSolution), "diagnose")
    outlines = {
        label: read_outline(reader, given, f"outline_{label}")
        for label, given in (("a", outline_a), ("b", outline_b))
        if given is not None
    }
    if isinstance(impact, MomentumSolution) and outlines:
        reader.refuse(
            InputError(
                "outline_a and outline_b need positions, which a MomentumSolution has not; leave them out, or diagnose the "
                "impact of collisions.eccentric at its speeds",
                code="not_an_impact",
                argument="outline_a" if "a" in outlines else "outline_b",
            )
        )
    words = read_words(reader, units)
    allowed = read_limits(limits, reader)
    found = checks_evidence.read_evidence(
        reader,
        impact,
        crush_energy,
        {"a": damage_pdof_a, "b": damage_pdof_b},
        {"a": damage_delta_v_a, "b": damage_delta_v_b},
    )
    if isinstance(impact, MomentumSolution):
        time = one_value(reader, duration, "s", "duration")
        time = at_least_zero(reader, time, duration, "duration", "negative_duration", "it is the time from touching to parting")
        pull = read_drag(reader, drag, "drag")
        reader.close()
        _check_single(time, pull)
        solved = Balance(
            solution=impact,
            limits=allowed,
            evidence=found,
            energy_lost=impact.translational_energy_loss,
            told={
                label: Told(f"vehicle {label.upper()}", getattr(impact, f"delta_v_{label}"), getattr(impact, f"pdof_{label}"))
                for label in "ab"
            },
            duration=time,
            drag=pull,
            words=words,
        )
        return _sorted([*_each(_EVIDENCE, solved), *_each(_BALANCE, solved)], solved)
    reader.close()
    left = left_out(impact, duration=duration, drag=drag)
    _check_single(left.duration, left.drag)
    case = Case(
        impact=impact,
        outlines=outlines,
        left_out=left,
        limits=allowed,
        evidence=found,
        energy_lost=impact.energy_loss,
        told={label: Told(named(label, side), side.delta_v, side.pdof) for label, side in (("a", impact.a), ("b", impact.b))},
        duration=left.duration,
        drag=left.drag,
        words=words,
    )
    return _sorted([*_each(_EVIDENCE, case), *_each(_IMPACT, case)], case)


def _each(checks: tuple[Callable[[_Examined], Iterator[Finding]], ...], case: _Examined) -> Iterator[Finding]:
    for check in checks:
        yield from check(case)


def _sorted(findings: list[Finding], case: Examined) -> Findings:
    """By code and vehicle; every answer has an energy that was looked at, also one without a gain."""
    order = {code: at for at, code in enumerate(LIMITS)}
    measured = case.measured | ({"energy_gain"} if case.limits["energy_gain"] != math.inf else set())
    return Findings(sorted(findings, key=lambda finding: (order[finding.code], finding.vehicle)), measured)


def _check_single(duration: Any, drag: Any) -> None:
    if isinstance(duration, np.ndarray) or isinstance(drag, np.ndarray):
        raise ShapeError(
            "duration and drag take one value each: diagnose takes one case", code="bad_shape", argument="duration"
        )

"""diagnose: every finding on one impact."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from ..errors import InputError, ShapeError
from ..idealisation import left_out
from ..impact import Impact
from ..units import Door, Input
from . import inputs, physics, robustness
from .case import Case
from .finding import LIMITS, Finding, read_limits
from ..outlines import read_outline

_CHECKS: tuple[Callable[[Case], Iterator[Finding]], ...] = (
    physics.energy_gain,
    physics.momentum_energy,
    physics.restitution,
    physics.impulse_ratio,
    physics.jamming,
    physics.contact_points,
    physics.outlines,
    physics.yaw_against_lever,
    physics.impulse_off_normal,
    physics.point_outside,
    physics.near_collinear,
    physics.ill_conditioned,
    physics.tyre_impulse,
    physics.reference_range,
    robustness.model,
    robustness.law,
    robustness.normal,
    inputs.suspect_inputs,
)


def diagnose(
    impact: Impact,
    *,
    outline_a: Any = None,
    outline_b: Any = None,
    duration: Input = 0.1,
    drag: Input = 0.7,
    limits: Mapping[str, Any] | None = None,
) -> tuple[Finding, ...]:
    """What is odd about an impact, forward or reconstructed: findings, an energy gain first.

    A finding is a reason to look again, not an error; no finding is no proof. Every one compares something measured with a
    limit, which ``diagnostics.LIMITS`` lists by code, with its unit and where it is from.

    Parameters
    ----------
    impact : Impact
        One case, of any solver; also one that ``reconstruct`` found.
    outline_a, outline_b : tuple or list, optional
        Outline of a vehicle as seen from its centre of mass, for ``point_outside`` and, with both, ``outlines_interpenetrate``:
        (length, width); (length, width, offset) [m] with the centre of mass so far ahead of the middle; or the corners of a
        convex outline, (forward, left) [m] one after another. The vehicle then needs x, y and heading.
    duration : float, str or Quantity [s]
        Of the contact, as for ``left_out``; also how long the outlines are followed after it.
    drag : float, str or Quantity
        Of the tyres, as for ``left_out``.
    limits : dict of str to float, str or Quantity, optional
        Limits other than the default by code, units allowed, such as ``{"near_collinear": "15 deg"}``; inf switches a finding
        of what is above its limit off, 0 one of what is below.

    Returns
    -------
    tuple of Finding
        In the order of ``LIMITS``, vehicle A before B; empty if nothing was found.

    Raises
    ------
    InputError
        An argument that cannot be used, a code that is none, a batch (``ShapeError``), or an impact that was refused.
    MissingInputError
        An outline without a position or heading of its vehicle.

    Notes
    -----
    Left out where it cannot be measured: levers without a contact point, courses of a vehicle at rest. Contact points and
    restitution cannot disagree in an answer of the eccentric model, so ``contact_points_approach`` appears for answers of
    ``solve`` by a smaller one only. A linear impact has no tangential direction to judge.

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
    door = Door(trusted=("limits['suspect_yaw_rate']",))
    _check(door, impact)
    outlines = {
        label: read_outline(door, given, f"outline_{label}")
        for label, given in (("a", outline_a), ("b", outline_b))
        if given is not None
    }
    allowed = read_limits(limits, door)
    door.close()
    found = left_out(impact, duration=duration, drag=drag)
    if isinstance(found.duration, np.ndarray) or isinstance(found.drag, np.ndarray):
        raise ShapeError(
            "duration and drag take one value each: diagnose takes one case", code="bad_shape", argument="duration"
        )
    case = Case(impact=impact, outlines=outlines, left_out=found, limits=allowed)
    order = {code: at for at, code in enumerate(LIMITS)}
    findings = [finding for check in _CHECKS for finding in check(case)]
    return tuple(sorted(findings, key=lambda finding: (order[finding.code], finding.vehicle)))


def _check(door: Door, impact: Any) -> None:
    """Refuses what is not one impact with an answer."""
    if not isinstance(impact, Impact):
        door.refuse(
            InputError(
                f"impact must be an Impact, got {type(impact).__name__}; write diagnose(collisions.eccentric(...))",
                code="not_an_impact",
                argument="impact",
            )
        )
    elif isinstance(impact.status, np.ndarray):
        door.refuse(
            ShapeError(
                f"impact is a batch of shape {impact.status.shape}, and diagnose takes one case: ask the solver again with the "
                f"numbers of that case, such as mass=float(masses[0])",
                code="bad_shape",
                argument="impact",
            )
        )
    elif impact.refused:
        door.refuse(
            InputError(
                f"impact was refused, so there is nothing to diagnose: {impact.status.sentence}",
                code="refused_impact",
                argument="impact",
            )
        )

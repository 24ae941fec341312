"""A finding, and the limits that make one."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..errors import InputError, ShapeError
from ..fields import OWN, Quantities
from ..reference import INTER_VEHICLE_FRICTION
from ..units import Door, shown

_HVE = "https://github.com/edccorp/hveManuals, docs/manuals/programs/EDCRASH"
_MESSAGES = f"EDCRASH manual, chapter 6 ({_HVE}/06-messages.md)"
_METHOD = f"EDCRASH manual, chapter 4 ({_HVE}/04-calculation-method.md)"
_OWN = "set here"
# The door's word for a number that no domain bounds: an infinite limit switches a finding off.
_ANY = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """Something about an impact that should be looked at.

    Parameters
    ----------
    code : str
        Label that does not change between versions; a key of ``LIMITS``.
    sentence : str
        What was found, with its numbers.
    measured : float
        What was measured, in ``unit``; infinite where there is no answer to measure.
    limit : float
        What it passes, in ``unit``.
    unit : str
        SI unit, "" for a plain number. ``.q`` has both as Quantities.
    vehicle : str
        "a" or "b" where it is about one of them, else "".
    source : str
        Where the limit is from.
    """

    code: str
    sentence: str
    measured: float = field(metadata={"unit": OWN})
    limit: float = field(metadata={"unit": OWN})
    unit: str
    vehicle: str = ""
    source: str

    @property
    def q(self) -> Any:
        """The same attributes, measured and limit as pint Quantities."""
        return Quantities(self)


@dataclass(frozen=True, slots=True, kw_only=True)
class Limit:
    """The limit that a finding passes.

    Parameters
    ----------
    default : float or None
        In ``unit``; None where it depends on the case.
    unit : str
        SI unit.
    measured : str
        What is measured, and from which side the limit is passed.
    source : str
        Where the default is from: "set here" with the reason where nothing was found to cite.
    """

    default: float | None
    unit: str
    measured: str
    source: str


LIMITS: Mapping[str, Limit] = {
    "energy_gain": Limit(
        default=0.0,
        unit="J",
        measured="energy that the bodies have after above that before: above",
        source=f'eq 7 of the paper; "the crash created energy", {_MESSAGES}',
    ),
    "momentum_energy": Limit(
        default=0.01,
        unit="",
        measured=(
            "what momentum, or the loss of energy worked out from the speeds before and after, differs by from the impulse and "
            "its work, as a share: above"
        ),
        source=f"{_OWN}: both are one number but for rounding, and one percent would be seen by whoever checks by hand",
    ),
    "restitution": Limit(
        default=None,
        unit="",
        measured="restitution: above the highest that is plausible for the closing speed",
        source="reference.restitution_range",
    ),
    "impulse_ratio": Limit(
        default=1.0,
        unit="",
        measured="impulse ratio as a share of the critical one: above, or below 0, where it drives the slip",
        source="Coulomb friction ends with the slip and cannot reverse it; reference.SHARE_OF_CRITICAL_SMALL_OVERLAP ends at 1",
    ),
    "jamming": Limit(
        default=0.5,
        unit="",
        measured="impulse ratio as a share of the one at which the bodies jam: above",
        source=f"{_OWN}: at one half, the normal impulse is twice that of a frictionless contact",
    ),
    "contact_points_approach": Limit(
        default=0.1,
        unit="m/s",
        measured="speed at which the contact points still approach after the impact: above",
        source=f"{_OWN}: 0.4 km/h, below what evidence shows; {_MESSAGES} warns of any",
    ),
    "outlines_interpenetrate": Limit(
        default=0.05,
        unit="m",
        measured="how much further the outlines pass into each other by the end of the duration after separation: above",
        source=f"{_OWN}: 5 cm, about what positions are read to",
    ),
    "yaw_against_lever": Limit(
        default=0.1,
        unit="rad/s",
        measured="change of yaw rate against the turning direction of the normal impulse (lever above 1 cm): above",
        source=f"{_OWN}: 6 deg/s; Rotation Direction Warning, {_MESSAGES}, warns of any",
    ),
    "impulse_off_normal": Limit(
        default=math.radians(45.0),
        unit="rad",
        measured="angle between the impulse and the normal: above",
        source=f"the angle up to which crush energy is corrected for a force that is not perpendicular, {_METHOD}",
    ),
    "point_outside": Limit(
        default=0.1,
        unit="m",
        measured="distance of the contact point from the outline, outside of it: above",
        source=f"{_OWN}: 10 cm, about what positions are read to",
    ),
    "near_collinear": Limit(
        default=math.radians(10.0),
        unit="rad",
        measured="angle between the courses before, or to the opposite course: at or below",
        source=f"collinear impacts, {_METHOD}",
    ),
    "ill_conditioned": Limit(
        default=10.0,
        unit="",
        measured="condition of a reconstruction: above",
        source=f"{_OWN}: one percent of error may become ten in the speeds",
    ),
    "tyre_impulse": Limit(
        default=0.1,
        unit="",
        measured="the most that the tyres can give in the duration, as a share of delta-V: above",
        source=f"the 10 percent by which delta-V may differ between methods, {_MESSAGES}",
    ),
    "model": Limit(
        default=0.1,
        unit="",
        measured="predicted error of a central model as a share of the smaller delta-V, infinite where none is known: above",
        source=f"the 10 percent by which delta-V may differ between methods, {_MESSAGES}",
    ),
    "law": Limit(
        default=0.1,
        unit="",
        measured="how far delta-V and yaw move under the other law, as a share of delta-V: above",
        source=f"the 10 percent by which delta-V may differ between methods, {_MESSAGES}",
    ),
    "normal": Limit(
        default=0.1,
        unit="",
        measured="how far delta-V and yaw move with the normal turned by 10 degrees either way, as a share of delta-V: above",
        source=f"the 10 percent by which delta-V may differ, and 10 degrees by which a force direction may, {_MESSAGES}",
    ),
    "friction_low": Limit(
        default=INTER_VEHICLE_FRICTION.low,
        unit="",
        measured="friction, where the contact slides: below",
        source="reference.INTER_VEHICLE_FRICTION",
    ),
    "ratio_high": Limit(
        default=INTER_VEHICLE_FRICTION.high,
        unit="",
        measured="magnitude of the impulse ratio, which no Coulomb friction explains: above",
        source="reference.INTER_VEHICLE_FRICTION",
    ),
    "suspect_mass": Limit(
        default=50.0, unit="kg", measured="mass: below", source=f"{_OWN}: no motor vehicle is lighter; tonnes as kg"
    ),
    "suspect_heavy": Limit(
        default=1e5,
        unit="kg",
        measured="finite mass: above",
        source=f"{_OWN}: no road vehicle is heavier; grams as kg, or an immovable body that should be inf",
    ),
    "suspect_speed": Limit(
        default=70.0, unit="m/s", measured="speed before: above", source=f"{_OWN}: 250 km/h; km/h or mph as m/s"
    ),
    "suspect_yaw_rate": Limit(
        default=20.0,
        unit="rad/s",
        measured="yaw rate before: above",
        source=f"{_OWN}: three turns a second, as for a bare number at the door; deg/s as rad/s",
    ),
    "suspect_inertia_low": Limit(
        default=0.3,
        unit="m",
        measured="radius of gyration: below",
        source=f"{_OWN}: no vehicle is as compact; tonnes m2 as kg m2",
    ),
    "suspect_inertia_high": Limit(
        default=5.0,
        unit="m",
        measured="radius of gyration: above",
        source=f"{_OWN}: that of a rectangle 17 m long; lb ft2 as kg m2",
    ),
    "suspect_lever": Limit(
        default=10.0,
        unit="m",
        measured="distance of the contact point from the centre of mass: above",
        source=f"{_OWN}: half a road train; feet or cm as m, or two origins mixed",
    ),
}
"""By code, in the order in which findings are listed: what is measured, its default limit and where that is from."""


def read_limits(given: Any, door: Door) -> dict[str, float | None]:
    """The limits of a call: the defaults, and what the caller has instead; units allowed."""
    limits = {code: limit.default for code, limit in LIMITS.items()}
    if given is None:
        return limits
    if not isinstance(given, Mapping):
        door.refuse(
            InputError(
                f"limits must be a dict from code to limit, such as {{'tyre_impulse': 0.2}}; got {type(given).__name__}",
                code="bad_limit",
                argument="limits",
            )
        )
        return limits
    for code, value in given.items():
        name = f"limits[{code!r}]"
        if code not in LIMITS:
            door.refuse(
                InputError(
                    f"{name}: there is no finding {shown(code)}; known are {', '.join(LIMITS)}",
                    code="unknown_finding",
                    argument="limits",
                )
            )
            continue
        count = len(door.problems)
        read = door.number(value, LIMITS[code].unit, name, _ANY)
        if len(door.problems) > count:
            continue
        if isinstance(read, np.ndarray):
            door.refuse(ShapeError(f"{name} takes one value", code="bad_shape", argument="limits"))
        elif not read >= 0.0:
            door.refuse(
                InputError(
                    f"{name} must be >= 0 (inf switches it off), got {shown(value)}", code="bad_limit", argument="limits"
                )
            )
        else:
            limits[code] = read
    return limits

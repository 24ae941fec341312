"""The limits that make a finding: defaults by code, with their sources."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from ..reference import INTER_VEHICLE_FRICTION
from ..travel.surfaces import HIGHEST_DRAG

_HVE = "https://github.com/edccorp/hveManuals, docs/manuals/programs/EDCRASH"
_MESSAGES = f"EDCRASH manual, chapter 6 ({_HVE}/06-messages.md)"
_METHOD = f"EDCRASH manual, chapter 4 ({_HVE}/04-calculation-method.md)"
_OWN = "set here"


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
        default=0.5,
        unit="",
        measured="difference of the crush energy that was given from the energy that the impact takes, as a share of it: above",
        source=f"Conservation of Energy Warning, {_MESSAGES}: typically 50 percent",
    ),
    "rounding": Limit(
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
    "restitution_negative": Limit(
        default=0.01,
        unit="",
        measured="how far the restitution of momentum is below 0, infinite where the centres do not approach: above",
        source=f"{_OWN}: what rounded inputs leave of 0; Coefficient of Restitution Warnings, {_MESSAGES}, warn of any",
    ),
    "impulse_ratio": Limit(
        default=1.0,
        unit="",
        measured="impulse ratio as a share of the critical one: above, or below 0, where it drives the slip",
        source="Coulomb friction ends with the slip and cannot reverse it; reference.SHARE_OF_CRITICAL_SMALL_OVERLAP ends at 1",
    ),
    "friction_gain": Limit(
        default=0.005,
        unit="",
        measured="energy that the tangential impulse adds, as a share of the energy absorbed: above",
        source=f"{_OWN}: friction takes energy; half a percent is less than what any speed is known to",
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
        default=0.2,
        unit="m",
        measured="how much further the outlines pass into each other by the end of the duration after separation: above",
        source=f"{_OWN}: two positions of 10 cm each; stiff outlines of vehicles that turn apart pass by less",
    ),
    "outlines_overlap": Limit(
        default=None,
        unit="m",
        measured=(
            "how deep the outlines overlap at the impact: above the mutual crush of the impact in the duration and 0.3 m more"
        ),
        source=f"{_OWN}: the crush by left_out, positions to 10 cm each, and 10 cm for outlines that are rounder than drawn",
    ),
    "outlines_gap": Limit(
        default=0.3,
        unit="m",
        measured="gap between the outlines at the impact: above",
        source=f"{_OWN}: positions to 10 cm each, and 10 cm for outlines that are smaller than drawn",
    ),
    "normal_against_positions": Limit(
        default=0.1,
        unit="m",
        measured=(
            "how far, along the normal, the contact point lies behind the centre of A or B before its own, or without a point "
            "the centre of B behind that of A: above"
        ),
        source=f"{_OWN}: the normal points from A into B, so that a convex body has its centre behind the contact; 10 cm of "
        f"reading",
    ),
    "yaw_against_lever": Limit(
        default=0.1,
        unit="rad/s",
        measured=(
            "change of yaw rate against the lever of the principal force, in the damage_pdof that was given, where 10 degrees "
            "either way do not turn the lever: above"
        ),
        source=f"{_OWN}: 6 deg/s; Rotation Direction Warning, {_MESSAGES}, warns of any",
    ),
    "pdof_off_damage": Limit(
        default=math.radians(10.0),
        unit="rad",
        measured="angle between the PDOF and the damage_pdof that was given: above",
        source=f"PDOF Compatibility Warning, {_MESSAGES}: about 10 degrees",
    ),
    "delta_v_off_damage": Limit(
        default=0.1,
        unit="",
        measured="difference of the damage_delta_v that was given from delta-V, as a share of delta-V: above",
        source=f"Delta-V Compatibility Note, {_MESSAGES}: about 10 percent",
    ),
    "impulse_off_normal": Limit(
        default=math.radians(45.0),
        unit="rad",
        measured="angle between the impulse and the normal: above",
        source=f"the angle up to which crush energy is corrected for a force that is not perpendicular, {_METHOD}",
    ),
    "heading_off_course": Limit(
        default=math.radians(45.0),
        unit="rad",
        measured=(
            "angle between heading and course before, of a vehicle that goes 1 m/s or more and turns by less than 0.5 rad/s "
            "(one that spins may point anywhere): above"
        ),
        source=f"{_OWN}: beyond, it goes more sideways or backwards than ahead; a vehicle that slides with its rear out stays "
        f"below",
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
        measured="in a reconstruction by momentum, angle between the courses of both unknowns, or to the opposite: at or below",
        source=f"collinear impacts, {_METHOD}",
    ),
    "ill_conditioned": Limit(
        default=10.0,
        unit="",
        measured="condition of a reconstruction: above",
        source=f"{_OWN}: one percent of error may become ten in the speeds",
    ),
    "not_unique": Limit(
        default=1.0,
        unit="",
        measured="number of impacts that fit what the reconstruction was given: above",
        source=f"{_OWN}: one answer needs no choice",
    ),
    "speed_backwards": Limit(
        default=0.1,
        unit="m/s",
        measured="speed that momentum found, backwards along its course: above",
        source=f"{_OWN}: 0.4 km/h, below what evidence shows",
    ),
    "tyre_impulse": Limit(
        default=0.25,
        unit="",
        measured="the most that the tyres can give in the duration, as a share of delta-V: above",
        source=(
            f"{_OWN}: with 0.7 g in 0.1 s a delta-V below 2.7 m/s (10 km/h), where it is a minor impact; tyre forces are "
            f"insignificant but in minor impacts, sideswipes and impacts of large trucks, {_METHOD}"
        ),
    ),
    "model": Limit(
        default=0.1,
        unit="",
        measured="predicted error of a central model as a share of the smaller delta-V (inf if eccentric refuses): above",
        source=f"the 10 percent by which delta-V may differ between methods, {_MESSAGES}",
    ),
    "law": Limit(
        default=0.1,
        unit="",
        measured="length by which the vector of delta-V moves under the other law, as a share of delta-V: above",
        source=f"the 10 percent by which delta-V may differ between methods, {_MESSAGES}",
    ),
    "law_yaw": Limit(
        default=0.25,
        unit="",
        measured=(
            "change of yaw rate that the other law makes another by more than 6 deg/s, as a share of the larger (above 1 it "
            "turns the other way): above"
        ),
        source=f"{_OWN}: a quarter, which a rest position would show",
    ),
    "normal": Limit(
        default=0.2,
        unit="",
        measured=(
            "length by which the vector of delta-V moves with the normal turned by 10 degrees either way, as a share of "
            "delta-V: above"
        ),
        source=(
            f"a delta-V that turns with the normal by 10 degrees moves by 17 percent; with the 10 percent by which its size "
            f"may differ, {_MESSAGES}, that is 20 percent"
        ),
    ),
    "normal_yaw": Limit(
        default=0.5,
        unit="",
        measured="the same as law_yaw, with the normal turned by 10 degrees either way: above",
        source=f"{_OWN}: half or double; levers are short, so that a quarter is passed by four in ten ordinary side impacts",
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
        default=150.0,
        unit="kg",
        measured="mass: below",
        source=f"{_OWN}: no car is lighter, and a car of 1500 kg has 103 slug; tonnes or slugs as kg",
    ),
    "suspect_heavy": Limit(
        default=1e5,
        unit="kg",
        measured="finite mass: above",
        source=f"{_OWN}: no road vehicle is heavier; grams as kg, or an immovable body that should be inf",
    ),
    "suspect_speed": Limit(
        default=44.0, unit="m/s", measured="speed before: above", source=f"{_OWN}: 158 km/h; km/h or mph as m/s"
    ),
    "suspect_yaw_rate": Limit(
        default=20.0,
        unit="rad/s",
        measured="yaw rate before: above",
        source=f"{_OWN}: three turns a second, as for a bare number that is read; deg/s as rad/s",
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
        default=None,
        unit="m",
        measured=(
            "distance of the contact point from the centre of mass: above three radii of gyration of the vehicle, or 10 m "
            "where its yaw inertia is not known or infinite"
        ),
        source=(
            f"{_OWN}: the corner of a rectangle is 1.7 of its radii away, and a centre of mass may be off the middle; 10 m is "
            f"half a road train; feet or cm as m, or two origins mixed"
        ),
    ),
    "suspect_distance": Limit(
        default=None,
        unit="m",
        measured="without a contact point, distance between both centres of mass: above both limits of suspect_lever together",
        source=f"{_OWN}: as for suspect_lever",
    ),
    "suspect_angle": Limit(
        default=math.tau,
        unit="rad",
        measured="heading or course, or normal that was given as a number without a unit: above",
        source=f"{_OWN}: a full turn, as for a bare number that is read; degrees as rad",
    ),
    "suspect_friction": Limit(
        default=5.0,
        unit="",
        measured="finite friction between the vehicles: above",
        source=f"{_OWN}: over twice the highest impulse ratio of the small-overlap tests (2.05); percent as a plain number",
    ),
    "suspect_drag": Limit(
        default=HIGHEST_DRAG,
        unit="",
        measured="drag of the tyres: above",
        source=f"{_OWN}: no road tyre holds more, as for a bare number that is read; percent or m/s2 as a fraction of gravity",
    ),
    "suspect_duration": Limit(
        default=10.0,
        unit="",
        measured="duration of the contact as a multiple of the one that was published, 0.108 s: above",
        source=f"{_OWN}: no contact of vehicles lasts ten times reference.CONTACT_DURATION; ms as s",
    ),
    "model_unknown": Limit(
        default=0.0,
        unit="",
        measured="number of inputs that would be needed to tell what a central model errs by: above",
        source=f"{_OWN}: a note",
    ),
}
"""By code, in the order in which findings are listed: what is measured, its default limit and where that is from."""

"""Published values as data: each with its source, the range and the domain it holds for, and how good it is.

Nothing here is a default of a solver. ``PUBLISHED`` lists every value, ``FITS`` every formula.
"""

from .contact import (
    CONTACT_DURATION,
    IMPULSE_RATIO_OBLIQUE,
    IMPULSE_RATIO_SMALL_OVERLAP,
    INTER_VEHICLE_FRICTION,
    RESTITUTION,
    RESTITUTION_FIT,
    RESTITUTION_FRONTAL_BARRIER,
    RESTITUTION_LOW_SPEED,
    RESTITUTION_OBLIQUE,
    RESTITUTION_SMALL_OVERLAP,
    SHARE_OF_CRITICAL_OBLIQUE,
    SHARE_OF_CRITICAL_SMALL_OVERLAP,
    restitution,
    restitution_range,
)
from .ground import DRAG_FACTORS, drag_factor
from .inertia import YAW_INERTIA_RECTANGLE, YAW_INERTIA_WHEELBASE, yaw_inertia
from .published import Fit, Published

PUBLISHED: tuple[Published, ...] = (
    RESTITUTION,
    RESTITUTION_LOW_SPEED,
    RESTITUTION_OBLIQUE,
    RESTITUTION_SMALL_OVERLAP,
    RESTITUTION_FRONTAL_BARRIER,
    INTER_VEHICLE_FRICTION,
    IMPULSE_RATIO_OBLIQUE,
    IMPULSE_RATIO_SMALL_OVERLAP,
    SHARE_OF_CRITICAL_OBLIQUE,
    SHARE_OF_CRITICAL_SMALL_OVERLAP,
    CONTACT_DURATION,
    *DRAG_FACTORS,
)
"""Every published value."""

FITS: tuple[Fit, ...] = (RESTITUTION_FIT, YAW_INERTIA_WHEELBASE, YAW_INERTIA_RECTANGLE)
"""Every published formula."""

__all__ = [
    "CONTACT_DURATION",
    "DRAG_FACTORS",
    "FITS",
    "IMPULSE_RATIO_OBLIQUE",
    "IMPULSE_RATIO_SMALL_OVERLAP",
    "INTER_VEHICLE_FRICTION",
    "PUBLISHED",
    "RESTITUTION",
    "RESTITUTION_FIT",
    "RESTITUTION_FRONTAL_BARRIER",
    "RESTITUTION_LOW_SPEED",
    "RESTITUTION_OBLIQUE",
    "RESTITUTION_SMALL_OVERLAP",
    "SHARE_OF_CRITICAL_OBLIQUE",
    "SHARE_OF_CRITICAL_SMALL_OVERLAP",
    "YAW_INERTIA_RECTANGLE",
    "YAW_INERTIA_WHEELBASE",
    "Fit",
    "Published",
    "drag_factor",
    "restitution",
    "restitution_range",
    "yaw_inertia",
]

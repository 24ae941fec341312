"""Published values as data: each with its source, the range and the domain it holds for, and how
good it is.

Nothing here is a default of a solver. ``PUBLISHED`` lists every value, ``FITS`` every formula.
"""

from . import contact, ground, inertia
from .contact import (
    CONTACT_DURATION,
    CONTACT_DURATION_BRAKED,
    CONTACT_DURATION_SIDESWIPE,
    CONTACT_POINT_DRAWN,
    IMPULSE_RATIO_OBLIQUE,
    IMPULSE_RATIO_SMALL_OVERLAP,
    INTER_VEHICLE_FRICTION,
    RECORDER_ACCURACY,
    RECORDER_ERROR,
    RECORDER_RANGE,
    RECORDER_RESOLUTION,
    RESTITUTION,
    RESTITUTION_FIT,
    RESTITUTION_FRONTAL_BARRIER,
    RESTITUTION_LOW_SPEED,
    RESTITUTION_LOW_SPEED_FULL,
    RESTITUTION_LOW_SPEED_HALF,
    RESTITUTION_OBLIQUE,
    RESTITUTION_OVERLAP_HALF,
    RESTITUTION_OVERLAP_LARGE,
    RESTITUTION_OVERLAP_SMALL,
    RESTITUTION_SMALL_OVERLAP,
    SHARE_OF_CRITICAL_OBLIQUE,
    SHARE_OF_CRITICAL_SMALL_OVERLAP,
    restitution,
    restitution_by_overlap,
    restitution_range,
)
from .ground import (
    DRAG_FACTORS,
    ENGINE_BRAKING_HIGH,
    ENGINE_BRAKING_LOW,
    ROLLING_RESISTANCE,
    drag_factor,
)
from .inertia import YAW_INERTIA_INDEX, YAW_INERTIA_RECTANGLE, YAW_INERTIA_WHEELBASE, yaw_inertia
from .published import Fit, Published

PUBLISHED: tuple[Published, ...] = (
    *(
        value
        for part in (contact, inertia, ground)
        for name, value in vars(part).items()
        if isinstance(value, Published) and not name.startswith("_")
    ),
    *DRAG_FACTORS,
)
"""Every published value."""

FITS: tuple[Fit, ...] = (RESTITUTION_FIT, YAW_INERTIA_WHEELBASE, YAW_INERTIA_RECTANGLE)
"""Every published formula."""

__all__ = [
    "CONTACT_DURATION",
    "CONTACT_DURATION_BRAKED",
    "CONTACT_DURATION_SIDESWIPE",
    "CONTACT_POINT_DRAWN",
    "DRAG_FACTORS",
    "ENGINE_BRAKING_HIGH",
    "ENGINE_BRAKING_LOW",
    "FITS",
    "IMPULSE_RATIO_OBLIQUE",
    "IMPULSE_RATIO_SMALL_OVERLAP",
    "INTER_VEHICLE_FRICTION",
    "PUBLISHED",
    "RECORDER_ACCURACY",
    "RECORDER_ERROR",
    "RECORDER_RANGE",
    "RECORDER_RESOLUTION",
    "RESTITUTION",
    "RESTITUTION_FIT",
    "RESTITUTION_FRONTAL_BARRIER",
    "RESTITUTION_LOW_SPEED",
    "RESTITUTION_LOW_SPEED_FULL",
    "RESTITUTION_LOW_SPEED_HALF",
    "RESTITUTION_OBLIQUE",
    "RESTITUTION_OVERLAP_HALF",
    "RESTITUTION_OVERLAP_LARGE",
    "RESTITUTION_OVERLAP_SMALL",
    "RESTITUTION_SMALL_OVERLAP",
    "ROLLING_RESISTANCE",
    "SHARE_OF_CRITICAL_OBLIQUE",
    "SHARE_OF_CRITICAL_SMALL_OVERLAP",
    "YAW_INERTIA_INDEX",
    "YAW_INERTIA_RECTANGLE",
    "YAW_INERTIA_WHEELBASE",
    "Fit",
    "Published",
    "drag_factor",
    "restitution",
    "restitution_by_overlap",
    "restitution_range",
    "yaw_inertia",
]

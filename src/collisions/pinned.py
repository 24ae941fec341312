"""The velocity of a body that can only turn about a pin: worked out where it was not given, otherwise compared."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from .errors import InputError, MissingInputError
from .kernels.elementwise import not_about_pivot, turning_velocity
from .quantities import lock
from .reading import widened


def pinned_velocity(
    pin: tuple[Any, Any], mass: Any, vx: Any, vy: Any, yaw_rate: Any, yaw_inertia: Any, x: Any, y: Any
) -> tuple[Any, Any]:
    """Velocity (vx, vy); scalars are checked here, arrays by the solver."""
    for label, value in (("mass", mass), ("yaw_inertia", yaw_inertia)):
        if isinstance(value, float) and math.isinf(value):
            raise InputError(
                f"{label} is inf and pivot is given; a pinned body turns, so give its {label}, or use Vehicle.barrier()",
                code="pinned_infinite",
                argument=label,
            )
    for label, value in (("x", x), ("y", y)):
        if value is None:
            raise MissingInputError(
                f"{label} is missing; a pivot needs the position of the centre of mass (x, y)",
                code="missing_position",
                argument=label,
            )
    with np.errstate(all="ignore"):
        arrays = (value for value in (mass, yaw_inertia, vx, vy) if isinstance(value, np.ndarray))
        wanted_x, wanted_y = turning_velocity(*widened((yaw_rate, x, y, *pin), arrays))
        if all(isinstance(value, float) for value in (vx, vy, wanted_x, wanted_y)):
            if not math.isfinite(wanted_x + wanted_y):
                raise InputError(
                    "the velocity of this pinned body is too large for a float: check x, y, pivot and yaw_rate",
                    code="out_of_range",
                    argument="yaw_rate",
                )
            if (vx != 0.0 or vy != 0.0) and not_about_pivot(vx, vy, yaw_rate, x, y, *pin):
                raise InputError(
                    f"vx, vy = ({vx:g}, {vy:g}) m/s cannot be the velocity of a body that turns about its pivot: yaw rate "
                    f"times arm gives ({wanted_x + 0.0:.10g}, {wanted_y + 0.0:.10g}) m/s; leave vx and vy out, or correct "
                    f"yaw_rate",
                    code="pinned_velocity",
                    argument="vx",
                )
            return wanted_x, wanted_y
        # Single cases never come here, and the import of the package need not wait for it.
        from .kernels.batch import precision

        # Both in the precision of the vehicle: what is too small for it counts as not given.
        given = (part for part in (vx, vy) if isinstance(part, np.ndarray))
        kind = precision(value for value in (mass, yaw_inertia, yaw_rate, x, y, *pin, *given) if value is not None)
        vx, vy = (np.asarray(v, dtype=kind) for v in (vx, vy))
        resting = np.equal(vx, 0.0) & np.equal(vy, 0.0)
        moved = np.broadcast_arrays(np.where(resting, wanted_x, vx), np.where(resting, wanted_y, vy))
    found: tuple[Any, Any] = lock(tuple(part.astype(kind) for part in moved))
    return found

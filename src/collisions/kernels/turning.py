"""What a turn about a point does to a place on the body."""

from typing import Any


def turning_velocity(yaw_rate: Any, x: Any, y: Any, center_x: Any, center_y: Any) -> tuple[Any, Any]:
    """Velocity at (x, y) of a body that turns about the centre: the arm turned by +90 degrees, times the yaw rate."""
    return -yaw_rate * (y - center_y), yaw_rate * (x - center_x)

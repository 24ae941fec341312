"""From the axes of the crash data (x forward, y to the right, yaw clockwise) to those of the
library (ISO 8855).
"""

from __future__ import annotations


def vector(forward: float, right: float) -> tuple[float, float]:
    """A position or a velocity: x stays, y is to the left."""
    return forward, -right


def angle(clockwise: float) -> float:
    """A heading, a direction or a yaw rate: counterclockwise."""
    return -clockwise

"""Drag factors of tyres that slide on a road."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..errors import InputError, ShapeError
from ..reading import ArgumentReader
from ..units import Input, shown
from .published import Published

_THIRTY = 30.0 * 0.44704
_TABLE = (
    "Baker, Traffic Accident Investigation Manual (Northwestern University, 1975; Fricke 1990), table as quoted at "
    "http://mfes.com/friction.html"
)
_HOW_GOOD = (
    "A table of which its author could not recall who had tested what (same page); newer studies reviewed there find 0.72 to "
    "0.78 on dry asphalt on average, so its lower ends are low."
)


def _asphalt(wear: str, slow: tuple[float, float], fast: tuple[float, float]) -> tuple[Published, Published]:
    """The two rows of a surface: below and above 30 mph."""
    below, above = (
        Published(
            name=f"drag factor, dry asphalt, {wear}, {which} 30 mph",
            low=low,
            high=high,
            unit="",
            source=_TABLE,
            domain=f"locked wheels of cars on level, dry asphalt, {which} 30 mph (13.4 m/s)",
            quality=_HOW_GOOD,
        )
        for which, (low, high) in (("below", slow), ("above", fast))
    )
    return below, above


_BY_SURFACE = {
    "new dry asphalt": _asphalt("new, sharp", (0.80, 1.20), (0.65, 1.00)),
    "travelled dry asphalt": _asphalt("travelled", (0.60, 0.80), (0.55, 0.70)),
    "polished dry asphalt": _asphalt("polished by traffic", (0.55, 0.75), (0.45, 0.65)),
}
_STATUTE = Published(
    name="drag factor behind a statutory table of stopping distances",
    low=0.70,
    high=0.70,
    unit="",
    source=(
        "Code of Virginia, section 46.2-880, as quoted at "
        "https://www.lawserver.com/law/state/virginia/va-code/virginia_code_46-2-880"
    ),
    domain="automobile in good condition, level, dry highway free from loose material, 10 to 100 mph",
    quality="Worked out here: mph**2/(30 * 0.70) gives every braking distance of the table to the foot; a baseline by law.",
)

DRAG_FACTORS: tuple[Published, ...] = (*(row for rows in _BY_SURFACE.values() for row in rows), _STATUTE)
"""Every published drag factor."""


def drag_factor(surface: str, *, speed: Input) -> Published:
    """Published range of the drag factor of locked wheels on a surface.

    Wheels that roll, other surfaces and other vehicles have other values, of which none could be checked.

    Parameters
    ----------
    surface : {"new dry asphalt", "travelled dry asphalt", "polished dry asphalt"}
        Kind of road.
    speed : float, str or Quantity [m/s]
        At which the slide begins, >= 0.

    Returns
    -------
    Published
        The range with its source; 30 mph itself counts as above.

    Raises
    ------
    InputError
        A surface that is not in the table, or a speed that cannot be used.

    Examples
    --------
    >>> row = drag_factor("travelled dry asphalt", speed="80 km/h")
    >>> row.low, row.high
    (0.55, 0.7)
    """
    reader = ArgumentReader()
    fast: Any = reader.number(speed, "m/s", "speed")
    if isinstance(fast, np.ndarray):
        reader.refuse(ShapeError("speed takes one value; ask for each", code="bad_shape", argument="speed"))
    elif fast < 0.0:
        reader.refuse(InputError(f"speed must be >= 0, got {shown(speed)}", code="negative_speed", argument="speed"))
    if not isinstance(surface, str) or surface not in _BY_SURFACE:
        reader.refuse(
            InputError(
                f"surface must be one of {', '.join(map(repr, _BY_SURFACE))}, got {shown(surface)}; for any other there is no "
                f"value here that could be checked: measure it",
                code="unknown_surface",
                argument="surface",
            )
        )
    reader.close()
    return _BY_SURFACE[surface][int(fast >= _THIRTY)]

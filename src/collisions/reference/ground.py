"""Drag factors of tyres that slide on a road, and of wheels that roll."""

from __future__ import annotations

from functools import partial

from ..messages.hints import hinted
from ..quantities.reading import ArgumentReader, single_number
from ..quantities.refusals import must_be, one_of
from ..quantities.units import Input
from .published import Published

_THIRTY = 30.0 * 0.44704
# Of a speed that was converted from another unit.
_ROUNDING = 1e-12
_MANUAL = (
    "EDSMAC manual, chapter 2 (Engineering Dynamics Corporation; "
    "https://github.com/edccorp/hveManuals, docs/manuals/programs/EDSMAC/02-program-input.md)"
)
_TABLE = f"{_MANUAL}, Table 2-7"
_BAKER = (
    "Baker, Traffic Accident Investigation Manual (Northwestern University, 1975; Fricke 1990), "
    "as quoted at http://mfes.com/friction.html; the same values in the "
) + _TABLE
_HOW_GOOD = (
    "A table in the manual of a program, which cites its source by number and claims no accuracy."
)
_HOW_GOOD_DRY = (
    "A table of which its author could not recall who had tested what (mfes.com); newer studies "
    "reviewed there find 0.72 to 0.78 on dry asphalt on average, so its lower ends are low."
)
_ROWS: dict[str, tuple[float, ...]] = {
    # Lowest and highest in turn: dry below and above 30 mph, wet below and above.
    "new {} concrete": (0.80, 1.20, 0.70, 1.00, 0.50, 0.80, 0.40, 0.75),
    "travelled {} concrete": (0.60, 0.80, 0.60, 0.75, 0.45, 0.70, 0.45, 0.65),
    "polished {} concrete": (0.55, 0.75, 0.50, 0.65, 0.45, 0.65, 0.45, 0.60),
    "new {} asphalt": (0.80, 1.20, 0.65, 1.00, 0.50, 0.80, 0.45, 0.75),
    "travelled {} asphalt": (0.60, 0.80, 0.55, 0.70, 0.50, 0.80, 0.45, 0.75),
    "polished {} asphalt": (0.55, 0.75, 0.45, 0.65, 0.45, 0.65, 0.40, 0.60),
    "{} asphalt with excess tar": (0.50, 0.60, 0.35, 0.60, 0.30, 0.60, 0.25, 0.55),
    "{} packed and oiled gravel": (0.55, 0.85, 0.50, 0.80, 0.40, 0.80, 0.40, 0.60),
    "{} loose gravel": (0.40, 0.70, 0.40, 0.70, 0.45, 0.75, 0.45, 0.75),
    "{} packed cinders": (0.50, 0.70, 0.50, 0.70, 0.65, 0.75, 0.65, 0.75),
    "{} crushed rock": (0.55, 0.75, 0.55, 0.75, 0.55, 0.75, 0.55, 0.75),
    "{} ice": (0.10, 0.25, 0.07, 0.20, 0.05, 0.10, 0.05, 0.10),
    "{} packed snow": (0.30, 0.55, 0.35, 0.55, 0.30, 0.60, 0.30, 0.60),
    "{} loose snow": (0.10, 0.25, 0.10, 0.20, 0.30, 0.60, 0.30, 0.60),
}


def _rows(surface: str, ends: tuple[float, ...]) -> tuple[Published, Published]:
    """The two rows of a surface: below and above 30 mph."""
    dry_asphalt = surface.endswith(" dry asphalt")
    below, above = (
        Published(
            name=f"drag factor, {surface}, {which} 30 mph",
            low=low,
            high=high,
            source=_BAKER if dry_asphalt else _TABLE,
            domain=f"locked wheels of cars on level, {surface}, {which} 30 mph (13.4 m/s)",
            quality=_HOW_GOOD_DRY if dry_asphalt else _HOW_GOOD,
        )
        for which, (low, high) in (("below", ends[:2]), ("above", ends[2:]))
    )
    return below, above


_BY_SURFACE = {
    name.format(state): _rows(name.format(state), ends[at : at + 4])
    for name, ends in _ROWS.items()
    for state, at in (("dry", 0), ("wet", 4))
}


_not_braked = partial(
    Published,
    source=f"{_MANUAL}, Table 2-6, which has it from Calspan report ZQ-6057-V-6 (HS 805 040, "
    "NHTSA, 1978)",
    domain="cars on pavement; the table divides it by the friction, to give a share of it",
    quality=_HOW_GOOD,
)
ROLLING_RESISTANCE = _not_braked(
    name="drag factor, free rolling, full to partial tyre inflation", low=0.010, high=0.013
)
ENGINE_BRAKING_HIGH = _not_braked(
    name="drag factor, engine braking in high gear", low=0.150, high=0.200
)
ENGINE_BRAKING_LOW = _not_braked(
    name="drag factor, engine braking in low gear", low=0.200, high=0.400
)
_STATUTE = Published(
    name="drag factor behind a statutory table of stopping distances",
    low=0.70,
    high=0.70,
    source=(
        "Code of Virginia, section 46.2-880, as quoted at "
        "https://www.lawserver.com/law/state/virginia/va-code/virginia_code_46-2-880"
    ),
    domain="automobile in good condition, level, dry highway free from loose material, 10 to 100 "
    "mph",
    quality="Worked out here: the square of the speed in mph, over 30 times 0.70, gives every "
    "braking distance of the table to the foot; a baseline by law.",
)

DRAG_FACTORS: tuple[Published, ...] = (
    *(row for rows in _BY_SURFACE.values() for row in rows),
    _STATUTE,
)
"""Every published drag factor of locked wheels."""


@hinted
def drag_factor(surface: str, *, speed: Input) -> Published:
    """Published range of the drag factor of locked wheels on a surface.

    For rolling wheels there are ``ROLLING_RESISTANCE``, ``ENGINE_BRAKING_HIGH`` and
    ``ENGINE_BRAKING_LOW``. Other surfaces and other vehicles have other values, none of which could
    be checked.

    Parameters
    ----------
    surface : str
        "new", "travelled" or "polished", then "dry" or "wet", then "asphalt" or "concrete"; or
        "dry" or "wet" and one of "asphalt with excess tar", "packed and oiled gravel", "loose
        gravel", "packed cinders", "crushed rock", "ice", "packed snow" and "loose snow".
    speed : float, str or Quantity [m/s]
        Speed at which the slide begins, >= 0.

    Returns
    -------
    Published
        The range with its source; exactly 30 mph counts as above 30 mph.

    Raises
    ------
    InputError
        A surface that is not in the table, or a speed that cannot be used.

    Examples
    --------
    >>> row = drag_factor("travelled dry asphalt", speed="80 km/h")
    >>> row.low, row.high
    (0.55, 0.7)
    >>> row = drag_factor("polished wet asphalt", speed="80 km/h")
    >>> row.low, row.high
    (0.4, 0.6)
    """
    reader = ArgumentReader()
    fast = single_number(
        reader, reader.number(speed, "m/s", "speed"), "speed", "takes one value; ask for each"
    )
    if fast < 0.0:
        reader.refuse(must_be("speed", ">= 0", speed, code="negative_speed"))
    if not isinstance(surface, str) or surface not in _BY_SURFACE:
        reader.refuse(
            one_of(
                "surface",
                _BY_SURFACE,
                surface,
                "; for any other there is no value here that could be checked: measure it",
                code="unknown_surface",
            )
        )
    reader.close()
    return _BY_SURFACE[surface][int(fast >= _THIRTY * (1.0 - _ROUNDING))]

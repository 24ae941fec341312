"""Yaw inertia of a car from its mass and its dimensions."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..kernels.elementwise import POSITIVE
from ..messages.errors import InputError
from ..messages.hints import hinted
from ..quantities.reading import ArgumentReader, broadcast, widened
from ..quantities.tables import Sentences
from ..quantities.units import Input, Value, texts_of
from .published import Fit, Outside, Published, check_outside, settle

_CARS = {"mass": (880.0, 1622.0, "kg"), "length": (3.725, 4.826, "m")}

YAW_INERTIA_WHEELBASE = Fit(
    name="yaw inertia from wheelbase and length",
    formula="I = 0.1269 mass * wheelbase * length",
    unit="kg*m**2",
    ranges={**_CARS, "wheelbase": (2.4, 2.795, "m")},
    source=(
        "https://github.com/boonich/eeswebgl (ees/ees.py, routine SR1), whose cars are those of "
        "Schreier and Nelson, SAE Transactions 96 (1987)"
    ),
    domain="passenger cars; the range is that of the three cars it was found used or checked for",
    quality=(
        "Read from a program; its own source was not found. Of the one car found with mass, "
        "dimensions and yaw inertia together (2008 Ford Fusion in pycrash: 1621 kg, 3168 kg m2) "
        "it gives 15 percent less."
    ),
)
YAW_INERTIA_RECTANGLE = Fit(
    name="yaw inertia of a uniform rectangle",
    formula="I = mass * (length**2 + width**2) / 12",
    unit="kg*m**2",
    ranges=_CARS,
    source="Geometry: a uniform rectangle about its centre",
    domain="passenger cars; the range is that of the three cars of YAW_INERTIA_WHEELBASE",
    quality=(
        "Exact for a uniform rectangle, which no car is: its ends are lighter than its middle. "
        "Of the one car found with mass, dimensions and yaw inertia together (2008 Ford Fusion "
        "in pycrash: 1621 kg, 3168 kg m2) it gives 14 percent more."
    ),
)

YAW_INERTIA_INDEX = Published(
    name="yaw inertia over mass times the distances of both axles from the centre of mass",
    low=0.89,
    high=1.13,
    source=(
        "Heydinger and others, SAE 1999-01-1336 (NHTSA's measurements until 1998), of seven "
        "vehicles as quoted in the program OpenFPS (OpenFPS.Common, RunningGear)"
    ),
    domain="small and mid-size US and imported cars, and pickups up to three quarters of a ton, "
    "with their driver",
    quality=(
        "Second hand: the paper has hundreds of vehicles; quoted were 0.95, 1.13, 1.05, 0.98 and "
        "1.11 of five cars, 0.89 and 0.92 of two pickups."
    ),
)


@hinted
def yaw_inertia(
    mass: Input,
    *,
    length: Input,
    wheelbase: Input | None = None,
    width: Input | None = None,
    outside: Outside = "warn",
) -> Value:
    """Yaw inertia [kg*m**2] about the centre of mass, estimated from dimensions: by the wheelbase,
    or as a rectangle.

    A measured value is better: NHTSA measured hundreds of vehicles (SAE 1999-01-1336). For the one
    car that could be compared, the first form gives 15 percent less and the second 14 percent more
    than its yaw inertia, so take the two as a range. Their sources are in ``YAW_INERTIA_WHEELBASE``
    and ``YAW_INERTIA_RECTANGLE``. For larger vehicles, the mass times the distances of both axles
    from the centre of mass, times ``YAW_INERTIA_INDEX``, gives a range that was measured.

    Parameters
    ----------
    mass : float, str, Quantity or array [kg]
        As loaded, > 0.
    length : float, str, Quantity or array [m]
        Overall, > 0.
    wheelbase, width : float, str, Quantity or array [m], optional
        Exactly one of the two, > 0; it selects the form.
    outside : {"warn", "refuse"}
        What to do outside the range of the cars for which the form was checked.

    Returns
    -------
    float or array [kg*m**2]
        Yaw inertia; NaN for a case of a batch that is refused.

    Raises
    ------
    InputError
        An argument that cannot be used, both or neither of wheelbase and width, or one of them not
        below the length.

    Warns
    -----
    OutOfRangeWarning
        Outside the range of these cars.

    Examples
    --------
    >>> size = {"mass": "1621.2 kg", "length": "4.826 m"}
    >>> round(yaw_inertia(**size, wheelbase="2.718 m")), round(yaw_inertia(**size, width="1.829 m"))
    (2699, 3598)
    """
    reader = ArgumentReader()
    if (wheelbase is None) == (width is None):
        found = "none" if wheelbase is None else "both"
        reader.refuse(
            InputError(
                f"give exactly one of `wheelbase=` and `width=`, got {found}",
                code="one_form",
                argument="wheelbase",
            )
        )
    other = "wheelbase" if width is None else "width"
    numbers: dict[str, Any] = {"mass": reader.number(mass, "kg", "mass", POSITIVE)}
    for name, value in (("length", length), ("wheelbase", wheelbase), ("width", width)):
        if value is not None or name == "length":
            numbers[name] = reader.number(value, "m", name, POSITIVE)
    check_outside(reader, outside)
    reader.close()
    shape, say = broadcast(numbers), Sentences(texts_of(reader.texts))
    weight, over_all, second = widened([numbers[name] for name in ("mass", "length", other)])
    with np.errstate(all="ignore"):
        if other == "wheelbase":
            fit, found_inertia = YAW_INERTIA_WHEELBASE, 0.1269 * weight * second * over_all
        else:
            fit, found_inertia = (
                YAW_INERTIA_RECTANGLE,
                weight * (over_all * over_all + second * second) / 12.0,
            )
        usable = (second < over_all) & (weight > 0.0) & (second > 0.0) & np.isfinite(found_inertia)
    if shape is None and not math.isfinite(found_inertia):
        raise InputError(
            "the yaw inertia is not a finite number", code="out_of_range", argument="mass"
        )
    if shape is None and not usable:
        raise InputError(
            f"{other} {say(second, 'length')} is not below length {say(over_all, 'length')}; "
            "exchange them, or correct the unit",
            code="bad_dimensions",
            argument=other,
        )
    return settle(fit, found_inertia, numbers, usable, outside, say)

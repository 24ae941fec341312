"""The rows of the inputs of tyres, as a page lists them."""

from collections.abc import Iterator, Mapping
from typing import Any

from ..vehicle.tyres import Tyres

OF_WHEELS = {
    "friction": ("friction on the ground", "number"),
    "lock": ("braking (lock), as a share of what locks them", "number"),
    "lock[0]": ("braking of the front left wheel (lock)", "number"),
    "lock[1]": ("braking of the front right wheel (lock)", "number"),
    "lock[2]": ("braking of the rear left wheel (lock)", "number"),
    "lock[3]": ("braking of the rear right wheel (lock)", "number"),
    "wheelbase": ("wheelbase", "length"),
    "track": ("track", "length"),
    "steer": ("steer angle of the front wheels", "angle"),
    "cornering": ("cornering stiffness over the load, per radian", "number"),
    "height": ("height of the centre of mass", "length"),
}


def tyre_inputs(tyres_of: Mapping[str, Tyres]) -> Iterator[tuple[str, str, Any, str]]:
    """Description, argument, number and kind of everything given of the tyres of each vehicle."""
    for label, tyres in tyres_of.items():
        for name, what, value, kind in wheel_rows(tyres):
            yield f"tyres of {label.upper()}: {what}", f"tyres_{label}.{name}", value, kind


def wheel_rows(tyres: Tyres) -> Iterator[tuple[str, str, Any, str]]:
    """Argument, description, number and kind of everything given of some tyres."""
    for name, value in tyres.named.items():
        what, kind = OF_WHEELS[name]
        yield name, what, value, kind

"""Vehicle impacts by impulse and momentum: linear central, oblique central and eccentric.

Numbers without a unit are SI, angles are radians counter-clockwise; Quantities and texts such as "80 km/h" are converted at
the door. See ``Vehicle``, then ``linear_central``, ``oblique_central`` and ``eccentric``; ``reconstruct`` solves backwards,
``travel`` has what the ground takes.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .eccentric import eccentric
from .errors import (
    AmbiguousSolutionError,
    CollisionsError,
    CollisionsWarning,
    EnergyGainWarning,
    IllConditionedWarning,
    InputError,
    MissingInputError,
    NoImpactError,
    NoSolutionError,
    OutOfRangeWarning,
    ShapeError,
    Status,
    SuspectUnitsWarning,
    UnitsError,
)
from .impact import Impact
from .linear import linear_central
from .oblique import oblique_central
from .provenance import ModelChoice
from .scene import required_model, solve
from .vehicle import Vehicle

if TYPE_CHECKING:
    from . import reconstruct, travel
    from .idealisation import left_out

__version__ = "0.1.0"

__all__ = [
    "AmbiguousSolutionError",
    "CollisionsError",
    "CollisionsWarning",
    "EnergyGainWarning",
    "IllConditionedWarning",
    "Impact",
    "InputError",
    "MissingInputError",
    "ModelChoice",
    "NoImpactError",
    "NoSolutionError",
    "OutOfRangeWarning",
    "ShapeError",
    "Status",
    "SuspectUnitsWarning",
    "UnitsError",
    "Vehicle",
    "eccentric",
    "left_out",
    "linear_central",
    "oblique_central",
    "reconstruct",
    "required_model",
    "solve",
    "travel",
]


def __getattr__(name: str) -> Any:
    """What not every caller needs is imported when it is first asked for."""
    if name in ("reconstruct", "travel"):
        return import_module(f".{name}", __name__)
    if name == "left_out":
        return import_module(".idealisation", __name__).left_out
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

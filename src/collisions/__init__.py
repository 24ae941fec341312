"""Vehicle impacts by impulse and momentum: linear central, oblique central and eccentric.

Numbers without a unit are SI, angles are radians counter-clockwise; Quantities and texts such as "80 km/h" are converted at
the door. See ``Vehicle``, then ``linear_central``, ``oblique_central`` and ``eccentric``.
"""

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
from .vehicle import Vehicle

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
    "NoImpactError",
    "NoSolutionError",
    "OutOfRangeWarning",
    "ShapeError",
    "Status",
    "SuspectUnitsWarning",
    "UnitsError",
    "Vehicle",
    "eccentric",
    "linear_central",
    "oblique_central",
]

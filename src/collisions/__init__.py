"""Vehicle impacts by impulse and momentum: linear central, oblique central and eccentric.

Numbers without a unit are SI, angles are radians counter-clockwise; Quantities and texts such as
"80 km/h" are converted when read. See ``Vehicle``, then ``linear_central``, ``oblique_central`` and
``eccentric``; ``reconstruct`` solves backwards, ``travel`` covers motion over the ground, and
``uncertainty`` says how certain an answer is.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .messages.errors import (
    AmbiguousSolutionError,
    CollisionsError,
    CollisionsWarning,
    EnergyGainWarning,
    IllConditionedWarning,
    InputError,
    InternalError,
    MissingInputError,
    NoImpactError,
    NoSolutionError,
    OutOfRangeWarning,
    ShapeError,
    Status,
    SuspectUnitsWarning,
    UnitsError,
)
from .quantities.settings import options
from .vehicle.vehicle import Vehicle

if TYPE_CHECKING:
    from . import plot, reconstruct, reference, scene, travel, uncertainty
    from .derivation import explain
    from .diagnostics import diagnose
    from .impact.choice import ModelChoice
    from .impact.impact import Impact
    from .impact.left_out import left_out
    from .impact.schema import impact_schema
    from .impact.solvers import (
        eccentric,
        linear_central,
        oblique_central,
        required_model,
        solve,
        time_resolved,
    )
    from .reporting import report
    from .reporting.play import play
    from .reporting.what_if import what_if

__version__ = "0.2.0"

__all__ = [
    "AmbiguousSolutionError",
    "CollisionsError",
    "CollisionsWarning",
    "EnergyGainWarning",
    "IllConditionedWarning",
    "Impact",
    "InputError",
    "InternalError",
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
    "diagnose",
    "eccentric",
    "explain",
    "impact_schema",
    "left_out",
    "linear_central",
    "oblique_central",
    "options",
    "play",
    "plot",
    "reconstruct",
    "reference",
    "report",
    "required_model",
    "scene",
    "solve",
    "time_resolved",
    "travel",
    "uncertainty",
    "what_if",
]


# Modules of the lazily imported names.
_LATER = {
    "Impact": "impact.impact",
    "ModelChoice": "impact.choice",
    "diagnose": "diagnostics",
    "explain": "derivation",
    "impact_schema": "impact.schema",
    "left_out": "impact.left_out",
    "play": "reporting.play",
    "report": "reporting",
    "what_if": "reporting.what_if",
    **dict.fromkeys(
        (
            "eccentric",
            "linear_central",
            "oblique_central",
            "required_model",
            "solve",
            "time_resolved",
        ),
        "impact.solvers",
    ),
}
_MODULES = ("plot", "reconstruct", "reference", "scene", "travel", "uncertainty")


def __getattr__(name: str) -> Any:
    """Imports a module at the first use of its name, as not every caller needs all of them."""
    if name in _MODULES or name in _LATER.values():
        return import_module(f".{name}", __name__)
    if name not in _LATER:
        homes = (
            []
            if name[0] == "_"
            else [part for part in _MODULES if name in import_module(f".{part}", __name__).__all__]
        )
        hint = (
            f"; write {' or '.join(f'collisions.{part}.{name}' for part in homes)}" if homes else ""
        )
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}{hint}", name=name)
    found = globals()[name] = getattr(import_module(f".{_LATER[name]}", __name__), name)
    return found


def __dir__() -> list[str]:
    return [*__all__, "__version__"]

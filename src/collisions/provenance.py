"""Where an impact comes from: the reverse solver that found it and how firmly, or how its model was chosen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .units import Value

# From the least to the full one.
MODELS = ("linear_central", "oblique_central", "eccentric")


@dataclass(frozen=True, slots=True, kw_only=True)
class Reconstruction:
    """How a reverse solver found an impact.

    Parameters
    ----------
    method : str
        Function of ``collisions.reconstruct``.
    known : tuple of str
        What it was given beside masses and geometry.
    condition : float or array [1]
        How well-posed the question was: by how much relative errors of what was given may be larger in the speeds before the
        impact, taken relative to the closing speed. 10 means that one percent may become ten. It leaves out what is not known
        of friction, restitution, normal and courses. For ``planar`` it is the factor that restitution brings in, (1 + e)/e
        where e was given, or the jump between both ways to slide over the slip where that is larger.
    """

    method: str
    known: tuple[str, ...]
    condition: Value


@dataclass(frozen=True, slots=True, kw_only=True)
class ModelChoice:
    """Which model a scene requires, and why.

    Parameters
    ----------
    model : str or array of str
        "linear_central", "oblique_central" or "eccentric".
    reason : str
        Why, in a sentence.
    errors : dict of float or array [m/s]
        By cheaper model, what it is predicted to err by: hypot of the delta-V vector and of radius of gyration times yaw rate,
        for the worse of both vehicles. NaN where it cannot be told, infinite where that model has no answer.
    missing : dict of tuple of str
        By model, what it still needs, such as "a.yaw_inertia" or "point".
    tolerance : float or array [m/s]
        What was accepted.
    """

    model: Any
    reason: str
    errors: dict[str, Value]
    missing: dict[str, tuple[str, ...]]
    tolerance: Value

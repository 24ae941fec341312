"""Where an impact comes from when it was not asked for directly: the reverse solver that found it, and how firmly."""

from __future__ import annotations

from dataclasses import dataclass

from .units import Value


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
        impact, taken relative to the closing speed. About 1 is firm, 10 means that one percent may become ten. For ``planar``
        it is the factor that restitution brings in, (1 + e)/e where e was given.
    """

    method: str
    known: tuple[str, ...]
    condition: Value

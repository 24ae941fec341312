"""From the candidates of a scene to the roots that fit, each once and in order, for every case of a batch."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..errors import InputError
from .common import Cases
from .crossings import RestitutionOf, crossings
from .speeds_algebra import REDUNDANT, Root, Scene
from .speeds_open import SAME, untold


def joint(scene: Scene, cases: Cases, function: RestitutionOf) -> list[Root]:
    """Candidates where the restitution depends on the answer: solved on a grid of it, then where both agree."""
    if scene.shares_critical():
        raise InputError(
            "a function of restitution and a critical_fraction between 0 and 1 cannot be solved together; give impulse_ratio= "
            "or a number for the restitution",
            code="bad_combination",
            argument="critical_fraction",
        )

    def of_closing(closing: Any, e: Any) -> Any:
        return function(scene.speed_unit * closing + 0.0 * e)

    def slope(closing: Any) -> Any:
        return scene.speed_unit * function.slope(scene.speed_unit * closing)

    def mismatch(e: Any) -> list[Any]:
        return [of_closing(scene.fits(root)[1], e) - e for root in scene.roots(e, polish=0)]

    found = [scene.roots(np.full((), e), slope=slope)[row] for row, e in crossings(mismatch)]
    scene.open = np.zeros((), dtype=bool)
    if not scene.kinds[0].startswith("speed"):
        regimes = scene.regimes()
        for row, e in crossings(lambda e: [scene.blind(regime, e)[0] + 0.0 * e for regime in regimes]):
            # Any slip goes with this restitution; it is an answer if the function gives it there.
            closing = scene.blind(regimes[row], np.full((), e))[1]
            scene.open = scene.open | (abs(of_closing(closing, np.full(1, e))[0] - e) <= REDUNDANT)
    return found


def in_order(cases: Cases, scene: Scene, roots: list[Root]) -> list[tuple[Root, Any]]:
    """The roots that fit, each once, by rising closing speed, and where in the batch they are."""
    shape = cases.shape or ()
    if not roots:
        return []
    parts = [np.stack([np.broadcast_to(root[i], shape) for root in roots]) for i in range(4)]
    judged = [scene.fits(root) for root in roots]
    fits = np.stack([np.broadcast_to(fit, shape) for fit, _ in judged])
    closing = np.stack([np.broadcast_to(speed, shape) for _, speed in judged])
    for root, fit in zip(roots, fits, strict=True):
        if np.any(fit):
            scene.open = scene.open | (fit & untold(scene, root))
    fits &= ~scene.open
    order = np.argsort(np.where(fits, closing, np.inf), axis=0, kind="stable")
    parts = [np.take_along_axis(part, order, axis=0) for part in (*parts, fits, closing)]
    *values, fits, closing = parts
    for i in range(1, len(roots)):
        apart = sum(abs(values[k][i] - values[k][i - 1]) for k in range(2))
        fits[i] &= ~(fits[i - 1] & (apart <= SAME * closing[i]))
    rank = np.cumsum(fits, axis=0)
    most = int(np.max(rank[-1])) if rank.size else 0
    found = []
    for k in range(1, most + 1):
        chosen = fits & (rank == k)
        there = np.any(chosen, axis=0)
        which = np.argmax(chosen, axis=0)[np.newaxis]
        found.append((Root(*(np.take_along_axis(value, which, axis=0)[0] for value in values)), there))
    return found

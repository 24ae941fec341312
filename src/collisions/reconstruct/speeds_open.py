"""Whether what was observed leaves the speeds open: many of them lead to it, as far as rounding lets an observation tell."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..kernels.contact_laws import CRITICAL_FRACTION, FRICTION, IMPULSE_RATIO
from ..kernels.status import EPS, Status

if TYPE_CHECKING:
    from .speeds_algebra import Root, Scene

STICK = "stick"
# Part of the closing speed by which two roots that are one may be apart.
SAME = 1e-6
# Worst case of the forward kernel's rounding, in eps of the parts that it adds up.
ROUNDING = 32.0 * EPS
# Part of the speeds by which a root is moved, to see whether what was given tells it from its neighbours.
_BESIDE = 0.02
# Where a range of speeds is looked at: five places, for what is observed along it is a quotient of quartics at most.
_PARTS = (0.1, 0.3, 0.5, 0.7, 0.9)


def blur(kind: str, seen: dict[str, Any]) -> Any:
    """How far an observation may be off that was itself worked out from speeds, at worst.

    An energy that is the difference of those before and after is known to the rounding of the impulse times the speeds.
    """
    if kind == "energy_loss":
        return ROUNDING * seen["impulse"] * seen["whole"]
    return 2.0 * ROUNDING * seen[kind] * (seen["whole"] / abs(seen["closing"]))


def reaches(scene: Scene, regime: Any) -> Any:
    """Whether the law may lead to a regime: not to sticking without friction, nor with less than the critical ratio."""
    if regime is STICK:
        return scene.bound == 1.0 if scene.rule == CRITICAL_FRACTION else scene.bound > 0.0
    return True


def any_speed(scene: Scene, regime: Any, e: Any) -> Any:
    """With one speed known: whether at every other speed that leads to this regime the same is observed, and was."""
    fixed = scene.kinds[0]
    value = scene.targets[fixed]

    def pair(x: Any) -> tuple[Any, Any]:
        return (value + 0.0 * x, x) if fixed == "speed_a" else (x, value + 0.0 * x)

    size = abs(value) + abs(scene.rest["closing"]) + abs(scene.rest["slip"])
    size = np.where(size > 0.0, size, 1.0)
    low: Any = np.full((), -np.inf)
    high: Any = np.full((), np.inf)
    ends = (_conditions(scene, regime, scene.run(*pair(x), e, FRICTION, 0.0)) for x in (-size, size))
    for behind, ahead in zip(*ends, strict=True):
        # Each is linear in the speed, so it begins or ends to hold at one place.
        middle = size * (behind + ahead) / (behind - ahead)
        low = np.where(ahead > behind, np.maximum(low, middle), low)
        high = np.where(ahead < behind, np.minimum(high, middle), high)
        high = np.where((ahead == behind) & ~(ahead > 0.0), -np.inf, high)
    nearest = np.maximum(low, np.minimum(high, 0.0))
    low, high = np.maximum(low, nearest - size), np.minimum(high, nearest + size)
    wide = high - low > SAME * size
    return reaches(scene, regime) & wide & _same(scene, e, [pair(low + part * (high - low)) for part in _PARTS])


def _conditions(scene: Scene, regime: Any, raw: tuple[Any, ...]) -> list[Any]:
    """What must be above 0 for the law to lead to a regime."""
    closing, normal, tangential = (getattr(raw, name) for name in ("closing_speed", "no_slip_normal", "no_slip_tangential"))
    if scene.rule == IMPULSE_RATIO:
        return [closing]
    if scene.rule == CRITICAL_FRACTION:
        return [closing, np.where(scene.bound > 0.0, normal, 1.0)]
    endless = np.isinf(scene.bound)
    most = np.where(endless, 1.0, scene.bound) * normal
    across = np.where(endless, 0.0, tangential)
    if regime is STICK:
        return [closing, most - across, most + across]
    return [closing, np.where(scene.bound > 0.0, np.copysign(1.0, regime) * across - most, 1.0)]


def every_slip(scene: Scene, samples: Sequence[dict[str, Any]]) -> Any:
    """Whether both observations are in the proportion of what was given at every slip, to their rounding."""
    k1, k2 = scene.kinds
    c1, c2 = (scene.targets[kind] for kind in scene.kinds)
    return np.logical_and.reduce(
        [abs(c2 * seen[k1] - c1 * seen[k2]) <= c2 * blur(k1, seen) + c1 * blur(k2, seen) for seen in samples]
    )


def untold(scene: Scene, root: Root) -> Any:
    """Whether a root is one of many: to one side of it the speeds lead to what was observed as well."""
    e = root.restitution
    size = abs(root.speed_a) + abs(root.speed_b) + scene.spinning
    many: Any = False
    for side in (-_BESIDE, _BESIDE):
        pairs = [(root.speed_a, root.speed_b)]
        for moved in (0.5 * side * size, side * size):
            if scene.kinds[0] == "speed_b":
                pairs.append((root.speed_a + moved, root.speed_b))
            else:
                beside = (root.speed_a, root.speed_b + moved)
                pairs.append(beside if scene.kinds[0] == "speed_a" else _as_large(scene, *beside, e))
        many = many | _same(scene, e, pairs)
    return many


def _as_large(scene: Scene, speed_a: Any, speed_b: Any, e: Any) -> tuple[Any, Any]:
    """The speeds of the same slip per closing speed that lead to the observation that is not a loss."""
    kind = scene.kinds[1] if scene.kinds[0] == "energy_loss" else scene.kinds[0]
    seen = scene.outcome(speed_a, speed_b, e)[1]
    factor = np.sqrt(scene.targets[kind] / seen[kind])
    return scene.speeds_at(factor * seen["closing"], factor * seen["slip"])


def _same(scene: Scene, e: Any, pairs: Sequence[tuple[Any, Any]]) -> Any:
    """Whether the law leads from all these speeds to what was observed, and to one and the same of it.

    An energy that was given is known to the rounding of the energies that it is the difference of. What the kernel answers is
    known to that of the energies lost alone: close to a restitution of 1 it tells amounts apart that are far smaller.
    """
    same: Any = True
    first: dict[str, Any] = {}
    for speed_a, speed_b in pairs:
        status, seen = scene.outcome(speed_a, speed_b, e)
        first = first or seen
        same = same & (status <= Status.ENERGY_GAIN)
        for kind in scene.kinds:
            if kind.startswith("speed"):
                continue
            within = [ROUNDING * at["lost"] if kind == "energy_loss" else blur(kind, at) for at in (seen, first)]
            same = same & (abs(seen[kind] - scene.targets[kind]) <= blur(kind, seen))
            same = same & (abs(seen[kind] - first[kind]) <= within[0] + within[1])
    return same

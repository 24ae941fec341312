"""Whether two scenes are one but for some of their numbers."""

from __future__ import annotations

import math
from collections.abc import Collection
from typing import Any

from ..quantities.attributes import equal
from .scene import Scene

# Relative, and in SI below 1: speed and course that were set and read again.
_SAME = 1e-9


def differs_at(scene: Scene, other: Scene, found: Collection[str]) -> str:
    """The path of the first number, but for those ``found``, or the part, in which two scenes
    differ; "" if they do not.
    """
    free = {path for name in found for path in scene.shared.get(name, (name,))}
    one, two = dict(scene._numbers()), dict(other._numbers())
    for path in {**one, **two}:
        if not _is_of(path, free) and not _alike(one.get(path), two.get(path)):
            return path
    for part in ("contacts", "surfaces"):
        if len(getattr(scene, part)) != len(getattr(other, part)):
            return part
    for name, mover in scene.movers.items():
        # One without an outline touches nothing, and may be given one for the picture.
        outlines = mover.outline, other.movers[name].outline
        if all(one is not None for one in outlines) and not equal(*outlines):
            return f"{name}.outline"
    for i, (mine, own) in enumerate(zip(scene.contacts, other.contacts, strict=True)):
        for part in ("a", "b", "plane", "model", "law", "incomplete"):
            if getattr(mine, part) != getattr(own, part):
                return f"contacts[{i}].{part}"
        if (isinstance(mine.at, str) or isinstance(own.at, str)) and mine.at != own.at:
            return f"contacts[{i}].at"
    for i, (area, corners) in enumerate(zip(scene.surfaces, other.surfaces, strict=True)):
        if not equal(area[0], corners[0]):
            return f"surfaces[{i}]"
    return "" if scene.order == other.order else "order"


def _is_of(path: str, found: Collection[str]) -> bool:
    """Whether a number was found, or is a component of what was: of a speed and its course, or of a
    normal.
    """
    owner, _, part = path.rpartition(".")
    polar = part in ("vx", "vy") and ({f"{owner}.speed", f"{owner}.course"} & {*found})
    return path in found or bool(polar) or path.partition("normal[")[0] + "normal" in found


def _alike(one: Any, other: Any) -> bool:
    if one is None or other is None:
        return one is other
    if isinstance(one, float) and isinstance(other, float) and math.isfinite(one):
        return abs(one - other) <= _SAME * max(1.0, abs(one))
    return bool(equal(one, other))

"""What two point masses share: how a change of their relative velocity is divided between them."""

from math import inf
from typing import Any

from .select import select


def shares(mass_a: Any, mass_b: Any) -> tuple[Any, Any, Any, Any]:
    """Share of A, share of B, reduced mass, and whether both bodies are immovable.

    Built on the ratio of the lighter to the heavier mass, which is 0 against a barrier: nothing overflows, and no infinity meets
    another. The reduced mass is the lighter mass times its own share.
    """
    a_is_lighter = mass_a <= mass_b
    light = select(a_is_lighter, mass_a, mass_b)
    immovable = light == inf
    ratio = select(immovable, 1.0, light) / select(a_is_lighter, mass_b, mass_a)
    light_share = 1.0 / (1.0 + ratio)
    heavy_share = ratio * light_share
    share_a = select(a_is_lighter, light_share, heavy_share)
    share_b = select(a_is_lighter, heavy_share, light_share)
    return share_a, share_b, light * light_share, immovable

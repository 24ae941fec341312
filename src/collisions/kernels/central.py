"""What two point masses share: how a change of their relative velocity is divided between them."""

from math import inf
from typing import Any

from .select import select


def shares(mass_a: Any, mass_b: Any) -> tuple[Any, Any, Any, Any]:
    """Share of A, share of B, reduced mass, and whether both bodies are immovable.

    Built on ratios of the masses, which are 0 or infinite against a barrier: no sum or product of masses overflows, and no
    infinity meets another. The reduced mass is the lighter mass times its own share.
    """
    share_a = 1.0 / (1.0 + mass_a / mass_b)
    share_b = 1.0 / (1.0 + mass_b / mass_a)
    reduced = select(mass_a <= mass_b, mass_a * share_a, mass_b * share_b)
    return share_a, share_b, reduced, (mass_a == inf) & (mass_b == inf)

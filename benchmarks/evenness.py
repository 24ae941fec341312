"""How probable it is that ranks are as uneven as some are."""

from __future__ import annotations


def uniformity(counts: list[int]) -> float:
    """The chance of ranks that are as uneven as these or more: chi-squared over the bins."""
    from collisions.estimate.least_squares import chi_squared_tail

    each = sum(counts) / len(counts)
    return chi_squared_tail(sum((count - each) ** 2 for count in counts) / each, len(counts) - 1)

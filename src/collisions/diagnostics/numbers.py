"""Shares as numbers and in words, for findings and for what would move an answer."""

from __future__ import annotations

import math

from ..quantities.formatting import in_words
from ..quantities.formatting import percent as in_percent


def percent(share: float, decimals: int = 0) -> str:
    """A share in percent; infinite for a share of zero."""
    return (
        in_percent(share, decimals)
        if math.isfinite(share)
        else f"a share that is {in_words(share)}"
    )


def share(part: float, whole: float) -> float:
    """The quotient; infinite where the divisor is 0 or either is not a number."""
    if part == 0.0:
        return 0.0
    return part / whole if whole > 0.0 and math.isfinite(part) else math.inf

"""The cases of a batch that cannot be answered: found, counted, warned of once, and NaN in every answer."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from ..errors import CollisionsWarning
from ..kernels.elementwise import select
from ..warning import warn_of_cases


def settle(found: Sequence[Any], checks: Iterable[tuple[str, Any]], shape: tuple[int, ...]) -> list[Any]:
    """The answers of a batch of this shape, NaN where a check holds; the first that does says why."""
    unsettled = np.ones(shape, dtype=bool)
    counts: dict[str, int] = {}
    for code, lanes in checks:
        hit = unsettled & lanes
        if hit.any():
            counts[code] = counts.get(code, 0) + int(np.count_nonzero(hit))
            unsettled &= ~hit
    if counts:
        listed = ", ".join(f"{count} {code}" for code, count in counts.items())
        warn_of_cases(
            CollisionsWarning(
                f"{sum(counts.values())} of {unsettled.size} cases cannot be answered and are NaN ({listed})",
                code="refused_cases",
                counts=counts,
            )
        )
    return [select(unsettled, answer, np.nan) if counts else np.broadcast_to(answer, shape) for answer in found]

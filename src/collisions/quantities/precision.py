"""``precision``: whether the numbers of a call are worked out in float32 or float64."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

_TINY, _HUGE = float(np.finfo(np.float32).tiny), float(np.finfo(np.float32).max)


def precision(values: Iterable[Any]) -> Any:
    """float32 if there are arrays, all of them are float32, and the plain numbers fit its range;
    else float64.
    """
    arrays = False
    for value in values:
        if isinstance(value, np.ndarray):
            arrays = True
            if value.dtype != np.float32:
                return np.float64
        elif (
            value is not None
            and math.isfinite(value)
            and not (value == 0.0 or _TINY <= abs(value) <= _HUGE)
        ):
            return np.float64
    return np.float32 if arrays else np.float64

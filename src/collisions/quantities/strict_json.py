"""``strict``: values as strict JSON."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..messages.errors import Status


def strict(value: Any) -> Any:
    """The value as strict JSON: an infinity and NaN by name, an array with its precision, a pair as
    a list.
    """
    if isinstance(value, np.ndarray):
        return {
            "dtype": str(value.dtype),
            "shape": list(value.shape),
            "values": [strict(v) for v in value.reshape(-1).tolist()],
        }
    if isinstance(value, (tuple, list)):
        return [strict(part) for part in value]
    if isinstance(value, Status):
        return int(value)
    if isinstance(value, Mapping):
        return {name: strict(part) for name, part in value.items()}
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return value

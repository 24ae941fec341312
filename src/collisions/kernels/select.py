"""A choice that reads the same for one case and for many."""

from typing import Any

import numpy as np

from .codes import OK


def select(condition: Any, yes: Any, no: Any) -> Any:
    """``yes`` where the condition holds, ``no`` elsewhere; both have been worked out already."""
    if condition is True:
        return yes
    if condition is False:
        return no
    return np.where(condition, yes, no)


def larger(one: Any, other: Any) -> Any:
    """The larger of both; NaN only if both are."""
    if isinstance(one, float) and isinstance(other, float):
        return one if one >= other or other != other else other
    return np.fmax(one, other)


def divisor(usable: Any, value: Any) -> Any:
    """A value to divide by: 1.0 where it is of no use, as the case is refused or its quotient is passed over.

    Only a plain number needs that, because Python refuses to divide by zero; a lane of many is simply infinite or NaN.
    """
    return 1.0 if usable is False or (isinstance(value, float) and value == 0.0) else value


def verdict(*findings: tuple[Any, int]) -> Any:
    """Code of the first finding whose condition holds, 0 if none does."""
    status: Any = OK
    for condition, code in reversed(findings):
        if condition is not False:
            status = select(condition, code, status)
    return status

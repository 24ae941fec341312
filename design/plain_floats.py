"""What should a single case be made of: Python floats, numpy scalars, or arrays of one?

    python design/plain_floats.py

The same kernel runs on all of them, so it could take whatever the caller has. What it is handed
decides the cost.

What it showed (2 cores, Python 3.11, numpy 2): np.float64 costs 11 times as much, arrays without a
dimension 15 times, arrays of one 28 times. Decided: the reader makes Python floats of every scalar,
numpy's own included, and an attribute of a single case is a plain float. Only what has a shape
stays an array.
"""

import numpy as np
from measuring import compare
from one_result_object import PROBLEM, SETTINGS

from collisions.kernels.eccentric import eccentric


def solved(kind):
    """A call of the kernel on numbers of a kind."""

    def made(part):
        if isinstance(part, tuple):
            return (
                type(part)._make(map(made, part)) if hasattr(part, "_make") else (*map(made, part),)
            )
        return kind(part) if isinstance(part, float) else part

    given = made(PROBLEM)
    return lambda: eccentric(given, *SETTINGS)


if __name__ == "__main__":
    print("of plain floats:")
    kinds = {
        "Python floats": float,
        "np.float64": np.float64,
        "arrays without a dimension": np.array,
        "arrays of one": lambda value: np.array([value]),
    }
    compare({name: solved(kind) for name, kind in kinds.items()}, "Python floats")

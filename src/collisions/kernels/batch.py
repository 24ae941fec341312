"""Many cases at once: a kernel run in blocks that stay in the cache, on one thread or several.

Every case is worked out by itself. A refused one is NaN in every output and carries its status; it cannot touch its neighbours.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any, TypeAlias

import numpy as np

from .codes import ENERGY_GAIN, OK, OUTPUTS

BLOCK = 8192
_TINY, _HUGE = float(np.finfo(np.float32).tiny), float(np.finfo(np.float32).max)

# What gives the status of a case, 0 if nothing is wrong with it, and the values it looks at.
Check: TypeAlias = tuple[Callable[..., Any], tuple[Any, ...]]


def precision(values: Iterable[Any]) -> Any:
    """What is worked out in: float32 if there are arrays, all are, and the plain numbers beside them fit; else float64."""
    arrays = False
    for value in values:
        if isinstance(value, np.ndarray):
            arrays = True
            if value.dtype != np.float32:
                return np.float64
        elif value is not None and math.isfinite(value) and not (value == 0.0 or _TINY <= abs(value) <= _HUGE):
            return np.float64
    return np.float32 if arrays else np.float64


def solve_lanes(
    kernel: Callable[..., tuple[Any, ...]],
    inputs: Sequence[Any],
    checks: Sequence[Check],
    shape: tuple[int, ...],
    dtype: Any,
    threads: int = 1,
    progress: Callable[[int, int], None] | None = None,
) -> tuple[Any, ...]:
    """The kernel's outputs as locked arrays of the given shape; the first check that applies decides the status of a case.

    ``progress(done, total)`` is called after every block, from the calling thread.
    """
    size = int(np.prod(shape, dtype=np.int64))
    lanes = [_flat(value, shape) for value in inputs]
    checked = [(check, [_flat(value, shape) for value in values]) for check, values in checks]
    outputs = [np.empty(size, dtype={"status": np.uint8, "sticks": np.bool_}.get(name, dtype)) for name in OUTPUTS]

    def solve(start: int) -> int:
        block = slice(start, min(start + BLOCK, size))

        def cut(values: Sequence[Any]) -> list[Any]:
            return [value if isinstance(value, float) else value[block].astype(dtype, copy=False) for value in values]

        with np.errstate(all="ignore"):
            answers = kernel(*cut(lanes))
            status = outputs[0][block]
            status[...] = answers[0]
            for check, values in reversed(checked):
                fault = check(*cut(values))
                status[...] = np.where(np.equal(fault, OK), status, fault)
            refused = status > ENERGY_GAIN
            for name, output, answer in zip(OUTPUTS[1:], outputs[1:], answers[1:], strict=True):
                output[block] = answer
                output[block][refused] = False if name == "sticks" else np.nan
        return block.stop - block.start

    starts = range(0, size, BLOCK)
    if threads == 1 or len(starts) < 2:
        _report(map(solve, starts), size, progress)
    else:
        # Costs a tenth of importing numpy, and most calls need no second thread.
        from concurrent.futures import ThreadPoolExecutor

        with ThreadPoolExecutor(threads) as pool:
            try:
                _report(pool.map(solve, starts), size, progress)
            except BaseException:
                pool.shutdown(cancel_futures=True)
                raise
    for output in outputs:
        output.setflags(write=False)
    return tuple(output.reshape(shape) for output in outputs)


def _report(counts: Any, size: int, progress: Callable[[int, int], None] | None) -> None:
    done = 0
    for count in counts:
        done += count
        if progress is not None:
            progress(done, size)


def _flat(value: Any, shape: tuple[int, ...]) -> Any:
    """Something whose slices are the cases in order, without a copy of the whole: a view, or an iterator over one."""
    if isinstance(value, float):
        return value
    if value.shape == shape and value.flags.c_contiguous:
        return value.reshape(-1)
    return np.broadcast_to(value, shape).flat

"""An impact that was found backwards as an instant, refined for a contact in which tyres act:
Newton's method on ``eccentric`` with its duration and tyres.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from ..impact.inputs import TYRES, Inputs
from ..impact.models import ECCENTRIC
from ..impact.run import solve_inputs, tyre_checks
from ..impact.time_resolved_inputs import DOMAINS
from ..kernels.status import Status
from ..messages.warning import quietly
from ..vehicle.tyres import Tyres

# A share of the size of an unknown: far above rounding, and so small that tyres bend nothing
# over it.
_STEP = 2.0**-20
# Shares of the size of what was known: below the first nothing better is looked for, below the
# second it counts as reproduced.
_MET, SETTLED = 1e-12, 1e-9
# Evaluations in all, and how many may bring nothing in a row: a case that has settled, and one that
# has not. Over 600 scenes all that settle do so with four that bring nothing at most.
_MOST, _VAIN = 20, (2, 5)


def misses_of_impacts(
    inputs_at: Callable[[Sequence[Any]], Inputs],
    misses: Callable[[Inputs, Any], Sequence[Any]],
) -> Callable[[Sequence[Any]], Sequence[Any]]:
    """What ``settle`` asks, of impacts: ``inputs_at`` makes inputs with their tyres from unknowns,
    and ``misses`` says of inputs and the answer to them by how much each known value is missed.
    """

    def missed(values: Sequence[Any]) -> Sequence[Any]:
        inputs = inputs_at(values)
        with quietly():
            return misses(inputs, solve_inputs(ECCENTRIC, inputs, "nan"))

    return missed


def settle(
    missed: Callable[[Sequence[Any]], Sequence[Any]],
    start: Sequence[Any],
    sizes: Sequence[Any],
    highest: Sequence[float] | None = None,
) -> tuple[list[Any], Any]:
    """The unknowns for which the lasting contact reproduces what was known, and where it does.

    ``start`` has the unknowns of the instant, numbers or arrays of one shape, ``sizes`` how large
    each may be. ``missed`` says of unknowns, which may have an axis more than ``start``, in front,
    by how much each of as many known values is missed, as a share of its size. ``highest`` are
    bounds that no unknown passes. A case in which a step does not help takes half of it; one that
    has settled stays, so that it comes out of a batch as alone.
    """
    values = np.stack(np.broadcast_arrays(*start)).astype(np.float64)
    count, shape = len(values), values.shape[1:]
    steps = np.stack([np.broadcast_to(_STEP * np.asarray(size), shape) for size in sizes])
    steps = np.where(steps > 0.0, steps, _STEP)
    most = np.reshape(np.inf if highest is None else np.asarray(highest), (-1, *[1] * len(shape)))
    steps = np.where(values + steps > most, -steps, steps)
    best, left = values, np.full(shape, np.inf)
    move, vain = np.zeros_like(values), np.zeros(shape)
    for _ in range(_MOST):
        found, slopes = _tried(missed, values, steps)
        size = np.max(np.abs(found), axis=0)
        better = size < left
        best, left = np.where(better, values, best), np.where(better, size, left)
        vain = np.where(better, 0.0, vain + 1.0)
        over = vain >= np.where(left <= SETTLED, *_VAIN)
        active = np.isfinite(left) & (left > _MET) & ~over
        if not np.any(active):
            break
        move = np.where(better, _newton(slopes, found), 0.5 * move)
        move = np.where(np.isfinite(move) & active, move, 0.0)
        values = np.minimum(best - move, most)
    return [best[i] for i in range(count)], left <= SETTLED


def slopes_at(
    missed: Callable[[Sequence[Any]], Sequence[Any]], start: Sequence[Any], sizes: Sequence[Any]
) -> list[list[Any]]:
    """How what is missed changes with each unknown, by rows of what was known."""
    values = np.stack(np.broadcast_arrays(*start)).astype(np.float64)
    steps = np.stack([np.broadcast_to(_STEP * np.asarray(size), values[0].shape) for size in sizes])
    _, slopes = _tried(missed, values, np.where(steps > 0.0, steps, _STEP))
    return [list(row) for row in slopes]


def numbers_of_times(times: Mapping[str, Any]) -> dict[str, Any]:
    """Every number of a duration and of tyres, by its name, from the arguments by name."""
    found = {"duration": times["duration"]} if times.get("duration") is not None else {}
    return found | {
        f"{name}.{inner}": value
        for name in TYRES
        if times.get(name) is not None
        for inner, value in times[name].named.items()
    }


def tyre_faults(duration: Any, tyres: Mapping[str, Tyres]) -> Iterator[tuple[Any, Any]]:
    """The faults of arrays of them, whose elements the reader does not check, with their status."""
    if np.ndim(duration):
        for domain in DOMAINS["duration"]:
            yield from ((fault(duration), status) for fault, status in domain.faults)
    for check in tyre_checks(tyres):
        fault = check.fault(*check.values)
        yield np.not_equal(fault, Status.OK), fault


def _tried(missed: Any, values: Any, steps: Any) -> tuple[Any, Any]:
    """What is missed at these values, and how that changes with each of them: (misses, cases) and
    (misses, values, cases).
    """
    count = len(values)
    tried = np.repeat(values[:, None], count + 1, axis=1)
    for i in range(count):
        tried[i, i + 1] += steps[i]
    with np.errstate(all="ignore"):
        found = np.stack(np.broadcast_arrays(*missed(list(tried))))
        # The steps as they are after rounding.
        apart = np.stack([tried[i, i + 1] - tried[i, 0] for i in range(count)])
        return found[:, 0], (found[:, 1:] - found[:, :1]) / apart


def _newton(slopes: Any, found: Any) -> Any:
    """The step that the slopes ask for; NaN where they have no answer."""
    matrices, right = np.moveaxis(slopes, (0, 1), (-2, -1)), np.moveaxis(found, 0, -1)[..., None]
    known = np.all(np.isfinite(matrices), axis=(-2, -1), keepdims=True)
    matrices = np.where(known, matrices, np.eye(len(found)))
    right = np.where(known, right, np.nan)
    try:
        move = np.linalg.solve(matrices, right)
    except np.linalg.LinAlgError:
        # One singular case stops all; the others are to come out as without it.
        sign, _ = np.linalg.slogdet(matrices)
        singular, unit = (sign == 0.0)[..., None, None], np.eye(len(found))
        move = np.linalg.solve(np.where(singular, unit, matrices), right)
        least = np.linalg.pinv(np.where(singular, matrices, unit))
        move = np.where(singular, least @ np.where(known, right, 0.0), move)
    return np.moveaxis(move[..., 0], -1, 0)

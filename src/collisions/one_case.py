"""The refusal of what is not the answer to one case: another thing, a batch, or a case that was refused itself."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .errors import CollisionsError, InputError, ShapeError, Status


def _refused(status: int, text: str, **fields: Any) -> CollisionsError:
    return InputError(text, code="refused_impact", status=Status(status).label, **fields)


def need_one_case(
    answer: Any,
    kinds: tuple[type[Any], ...],
    function: str,
    *,
    instead: str = "",
    many: str = "",
    refused: Callable[..., CollisionsError] = _refused,
) -> None:
    """Refuses an argument ``impact`` that is not one answer of these kinds.

    ``function`` is what was called, as it is written. ``instead`` and ``many`` are what else may be done with another thing and
    with a batch; ``refused`` makes the error of a refused case from its status, a text and fields.
    """
    if not isinstance(answer, kinds):
        if isinstance(answer, tuple) and answer and all(isinstance(one, kinds) for one in answer):
            raise InputError(
                f"impact must be one answer, got a tuple of {len(answer)}, all that fit; write {function}(found[0]) for the "
                f"first",
                code="not_an_impact",
                argument="impact",
            )
        names = [kind.__name__ for kind in kinds]
        wanted = " or ".join(f"{'an' if name[0] in 'AEIOU' else 'a'} {name}" for name in names)
        fit = "" if "Fit" in names else ", for a Fit with the values that it found"
        raise InputError(
            f"impact must be {wanted}, got {type(answer).__name__}; write {function}(collisions.eccentric(...)){fit}{instead}",
            code="not_an_impact",
            argument="impact",
        )
    # A fit that was refused is an error.
    status = getattr(answer, "status", Status.OK)
    if isinstance(status, np.ndarray):
        how = "ask the solver again with the numbers of that case, such as mass=float(masses[0])"
        if hasattr(answer, "case"):
            first = 0 if status.ndim == 1 else (0,) * status.ndim
            how = f"write {function}(impact.case({first})) for the first one; impact.to_columns() has the table of all"
        raise ShapeError(
            f"impact is a batch of shape {status.shape}, and {function} takes one case: {how}{many}",
            code="bad_shape",
            argument="impact",
        )
    if status > Status.ENERGY_GAIN:
        raise refused(
            int(status),
            f"impact was refused, so {function} has nothing to work on: {status.sentence}; mend its inputs and solve it again",
            argument="impact",
        )

"""The check of what takes one run: a scene as it went, of one case."""

from __future__ import annotations

from typing import Any

from ..messages.errors import InputError, ShapeError
from ..quantities.units import shown
from .run import Run


def need_one_run(run: Any, function: str, argument: str = "run") -> Run:
    """The run of a single case; an error for anything else, with the name of the function."""
    if not isinstance(run, Run):
        raise InputError(
            f"{argument} must be a Run, got {shown(run)} of type {type(run).__name__}; write "
            f"{function}(scene.run()), with a collisions.scene.Scene",
            code="not_a_run",
            argument=argument,
        )
    shape = run.scene.shape
    if shape is not None:
        raise ShapeError(
            f"{argument} is a batch of shape {shape}, and {function} takes one case: "
            f"write {function}(run.case(0)) for the "
            "first one; run.to_columns() has the table of all",
            code="bad_shape",
            argument=argument,
        )
    return run

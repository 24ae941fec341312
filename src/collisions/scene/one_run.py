"""The check of what takes one run: a scene as it went, of one case."""

from __future__ import annotations

from typing import Any

from ..messages.errors import ShapeError
from ..quantities.refusals import must_be
from .run import Run


def need_one_run(run: Any, function: str, argument: str = "run") -> Run:
    """The run of a single case; an error for anything else, with the name of the function."""
    if not isinstance(run, Run):
        raise must_be(
            argument,
            "a Run",
            run,
            f" of type {type(run).__name__}; write {function}(scene.run()), with a "
            "collisions.scene.Scene",
            code="not_a_run",
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

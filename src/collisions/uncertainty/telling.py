"""What must be said of a propagation beside its figures, once however many runs it took."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from ..errors import CollisionsWarning, OutOfRangeWarning
from ..warning import warn
from .output import Output


@dataclass
class Run:
    """The outputs of one run, how it went, and what there is to tell of it."""

    outputs: Mapping[str, Output]
    asked: int
    failed: int
    interrupted: bool = False
    unreached: bool = False
    wrapped: tuple[str, ...] = ()
    differing: Mapping[str, float] = field(default_factory=dict)
    unanswered: frozenset[str] = frozenset()


def tell(method: str, runs: Sequence[Run], places: int, local: bool, asked: int, failed: int) -> None:
    """Warns of what was left out of all cases asked for, what was not reached, and what a local method does not know."""
    told: list[CollisionsWarning] = []
    if local:
        told += _not_local(method, runs, failed)
    elif failed:
        told.append(
            OutOfRangeWarning(
                f"{failed} of {asked} cases had no answer ({failed / asked:.2%}) and are left out: the figures hold given "
                f"that there is one. If such inputs cannot be, say so with truncate=",
                code="failed_cases",
                failed=failed,
            )
        )
    if any(run.unreached for run in runs):
        told.append(
            CollisionsWarning(
                f"{max(run.asked for run in runs)} cases do not bring the standard errors below the tolerance; this is what "
                f"they give",
                code="tolerance_not_reached",
            )
        )
    if any(run.interrupted for run in runs) or len(runs) < places:
        done = sum(not run.interrupted for run in runs)
        rest = f" at {done} of {places} places between the bounds: they say nothing of the rest" if places > 1 else ""
        told.append(
            CollisionsWarning(f"interrupted after {asked} cases; the figures are theirs{rest}", code="interrupted", done=asked)
        )
    wrapped = tuple(dict.fromkeys(name for run in runs for name in run.wrapped))
    known = tuple(name for name in wrapped if any(run.outputs[name].unit for run in runs))
    bare = tuple(name for name in wrapped if name not in known)
    for names, text in (
        (
            bare,
            "has values near pi and near -pi: if it is an angle, its mean means nothing. Return it with its unit "
            "(impact.a.q.pdof), so that it is known to be one",
        ),
        (
            known,
            "has directions so far round the circle from one another that its mean tells little: the mean errs by more than "
            "their spread shows, or another one far from it is about as good",
        ),
    ):
        if names:
            told.append(OutOfRangeWarning(f"{', '.join(names)} {text}", code="may_wrap", outputs=names))
    for warning in told:
        warn(warning)


def _not_local(method: str, runs: Sequence[Run], failed: int) -> list[CollisionsWarning]:
    worst: dict[str, float] = {}
    for run in runs:
        for name, by in run.differing.items():
            worst[name] = max(worst.get(name, 0.0), by)
    if not worst and not failed:
        return []
    reasons = []
    if worst:
        listed = ", ".join(
            f"{name} by {by:.2g} of its standard deviation" if math.isfinite(by) else f"{name} everywhere"
            for name, by in worst.items()
        )
        reasons.append(f"differs from cases drawn from the inputs: {listed}")
    if failed:
        reasons.append(f"knows nothing of the {failed} of them without an answer")
    return [
        OutOfRangeWarning(
            f"method={method!r} {' and '.join(reasons)}. A friction limit, a truncation or a bend lies within the spread of "
            f"the inputs, or an input is far from normal; take method='quasi_random'",
            code="not_local",
            differences=worst,
            failed=failed,
        )
    ]

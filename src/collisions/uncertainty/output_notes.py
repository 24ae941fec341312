"""What has to be said of outputs: cases without one, angles that jump, and figures that rest on few
cases.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from ..messages.errors import OutOfRangeWarning
from ..messages.shares import in_percent
from ..messages.warning import Note
from . import turns as angles
from .normal import power_of_two
from .output import NO_SPREAD, Output
from .sampled import Sampled, average

# From so many cases on, the share of the variance that one of them has at most: of a normal output
# it is 3 % of 256 cases, and less of more.
_MANY, _MOST_OF_ONE = 256, 0.1


def unanswered_notes(outputs: Mapping[str, Sampled]) -> Iterator[Note]:
    """That some cases have none of these outputs, whose figures are of the others."""
    for name, output in outputs.items():
        failed, count = output.failed, output.values.size
        if failed == count:
            # It has no figures that could mislead.
            yield Note(None, f"none of the {count} samples has {name!r}, and it has no figures")
        elif failed:
            sentence = (
                f"{failed} of {count} samples ({in_percent(failed, count)}) have no {name!r}, "
                "and its figures are of the others: they hold only where there is one"
            )
            fields = {"failed": failed, "output": name}
            yield Note(OutOfRangeWarning, sentence, code="failed_cases", fields=fields)


def wraps_of(outputs: Mapping[str, Sampled]) -> dict[str, str]:
    """By name of the outputs that look like an angle that jumps, or point to all sides, which."""
    wraps = {name: output._wraps() for name, output in outputs.items()}
    return {name: where for name, where in wraps.items() if where is not None}


def tail_notes(outputs: Mapping[str, Output]) -> Iterator[Note]:
    """That mean and standard deviation of an output rest on few cases far out."""
    for name, output in outputs.items():
        if not isinstance(output, Sampled) or output._sides is not None:
            continue
        values = output._answered
        varies = output._std() > NO_SPREAD * float(np.max(abs(values)))
        # A yes or no has a probability, whose error says how few cases it rests on.
        if values.size < _MANY or not varies or np.isin(values, (0.0, 1.0)).all():
            continue
        apart = values - average(values)
        squares = (apart / power_of_two(apart)) ** 2
        share = float(np.max(squares) / np.sum(squares))
        if share > _MOST_OF_ONE:
            yield Note(
                None,
                f"one of {values.size} cases has {100.0 * share:.0f} % of the variance of {name}: "
                "its mean and standard deviation, and their standard errors, rest on few cases far "
                "out; read its range",
            )


def wrap_notes(wrapped: Mapping[str, str]) -> Iterator[Note]:
    """That means of these outputs mean nothing, or little."""
    for kind, text, cure in (
        (
            angles.AT_HALF_TURN,
            "has values near pi and near -pi: if it is an angle, its mean means nothing",
            ". Return it with its unit (impact.a.q.pdof), so that it is known to be one",
        ),
        (
            angles.ONE_SIDED,
            (
                "has values near pi and near -pi, and some are known from one side only: if it is "
                "a direction, the ends of its range mean nothing"
            ),
            (
                ". Return how far it is from a direction near the middle of them, between -180 and "
                "180 deg, as by `(angle - middle + 180) % 360 - 180`"
            ),
        ),
        (
            angles.AT_FULL_TURN,
            (
                "has values near 0 and near a full turn, 2 pi, and few somewhere between: if it is "
                "a direction, its mean means nothing"
            ),
            (
                ". Return it with its unit and between -180 and 180 deg, as by `(angle + 180) % "
                "360 - 180`, so that it is counted round the circle"
            ),
        ),
        (
            angles.ALL_ROUND,
            (
                "has directions so far round the circle from one another that its mean tells "
                "little: the mean errs by more than their spread shows, or another one far from "
                "it is about as good"
            ),
            "",
        ),
    ):
        names = tuple(name for name, where in wrapped.items() if where == kind)
        if names:
            yield Note(
                OutOfRangeWarning,
                f"{', '.join(names)} {text}",
                cure,
                "may_wrap",
                {"outputs": names},
            )

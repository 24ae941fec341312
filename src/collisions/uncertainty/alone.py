"""Whether a model works every case out by itself: a few of the cases it answered together are asked again, each alone."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

import numpy as np

from ..errors import InputError
from . import angles

# The outputs of a case that is asked alone: arrays of one.
Ask: TypeAlias = Callable[[Mapping[str, Any]], Mapping[str, Any]]

_CASES = 5  # a call costs as much as some hundred cases, so that more would be felt beside a run of 8192
# Of the width of the middle half of the answers: an iteration that goes on until every case has converged ends a little
# differently alone. What is less than this changes no figure that anyone reads, whatever it comes from.
_UNNOTICED = 1e-6
_EPSILON = float(np.finfo(np.float64).eps)
# Of an answer: numpy adds in another order, or takes another path, for one number than for many. Solvers of this package
# answer alone as among others within a few.
_ROUNDINGS = 64.0
# Where differences of large numbers make more of it, so does moving the inputs by this many roundings, and both by chance.
_MOVES = (-8.0, -2.0, 2.0, 8.0)
_CHANCE = 16.0


def check_alone(ask: Ask, values: Mapping[str, Any], answers: Mapping[str, Any], count: int) -> bool:
    """Refuses a model that answers a case otherwise alone than among others; False if these cases do not tell enough of it.

    Those that are all the same tell nothing, those without an answer little, and those in rising order nothing of a sort.
    """
    if not any(np.any(column != column[0]) for column in values.values()):
        return False
    compared = False
    for i in _cases(answers, count):
        case = {name: column[i : i + 1].copy() for name, column in values.items()}
        among = {name: float(column[i]) for name, column in answers.items()}
        answered = not all(map(math.isnan, among.values()))
        try:
            alone = ask(case)
        except Exception as error:
            if answered:
                raise _not_alone(case, error) from error
            continue
        compared |= answered
        for name, value in among.items():
            _compare(ask, case, values, name, value, float(alone[name][0]), answers[name])
    return compared and any(np.any(column[1:] < column[:-1]) for column in values.values())


def _cases(answers: Mapping[str, Any], count: int) -> list[int]:
    """The last case, which all others came before, those of the greatest and the least answers, two without, and the middle."""
    found = [count - 1]
    lost: list[int] = []
    for column in answers.values():
        missing = np.flatnonzero(np.isnan(column))
        lost += missing[[0, -1]].tolist() if missing.size else []
        if missing.size < column.size:
            found += [int(np.nanargmax(column)), int(np.nanargmin(column))]
    return list(dict.fromkeys([*found[:3], *lost[:2], count // 2]))[:_CASES]


def _compare(
    ask: Ask, case: Mapping[str, Any], values: Mapping[str, Any], name: str, among: float, alone: float, answers: Any
) -> None:
    """Refuses an answer that differs by more than rounding can explain."""
    away = _apart(among, alone)
    if away == 0.0:
        return
    if math.isfinite(away) and away <= _ROUNDINGS * _EPSILON * max(abs(among), abs(alone)) + _UNNOTICED * _middle_half(answers):
        return
    again = float(ask(case)[name][0])
    if _apart(again, alone) != 0.0:
        raise InputError(
            f"model answers {name!r} with {_told(alone)} and, asked again for the very same case ({_listed(case)}), with "
            f"{_told(again)}: it draws random numbers, or remembers its calls. Every case must be worked out by itself and "
            f"from its arguments alone; give what is random as an argument of its own, with its distribution",
            code="bad_model",
            argument="model",
            output=name,
        )
    if away <= _CHANCE * _moved(ask, case, values, name, alone, math.isinf(away)):
        return
    raise InputError(
        f"model mixes cases: among {len(answers)} cases it answers {name!r} with {_told(among)} for {_listed(case)}, and with "
        f"{_told(alone)} for that case alone. Every case must be worked out by itself. In place of what is taken over all "
        f"cases, such as x.mean(), x.max(), x[0], a running sum, a sort or an if on the whole array, write a number into the "
        f"model, or numpy.where. Random numbers drawn in the model do this too: give what is random as an argument of its own, "
        f"with its distribution",
        code="bad_model",
        argument="model",
        output=name,
    )


def _moved(ask: Ask, case: Mapping[str, Any], values: Mapping[str, Any], name: str, alone: float, lost: bool) -> float:
    """By how much roundings of the inputs change the answer to a case alone; where one was lost, infinite if they do it too."""
    most = 0.0
    for key, value in case.items():
        rounding = _EPSILON * float(np.max(np.abs(values[key])))
        for move in _MOVES:
            try:
                beside = float(ask({**case, key: value + move * rounding})[name][0])
            except Exception:
                beside = math.nan
            away = _apart(beside, alone)
            if lost or math.isfinite(away):
                most = max(most, away)
    return most


def _apart(one: float, other: float) -> float:
    """How far two answers are apart; infinite where one of them is none. A direction may come out at either end of its turn."""
    if math.isnan(one) or math.isnan(other):
        return 0.0 if math.isnan(one) and math.isnan(other) else math.inf
    away = abs(one - other)
    return min(away, abs(away - 2.0 * math.pi)) if angles.are_directions(np.array([one, other])) else away


def _middle_half(answers: Any) -> float:
    """The width of the middle half of the answers, which a few far ones do not widen."""
    with np.errstate(all="ignore"):
        low, high = np.nanquantile(answers, (0.25, 0.75))
    width = float(high) - float(low)
    return width if math.isfinite(width) else 0.0


def _not_alone(case: Mapping[str, Any], error: BaseException) -> InputError:
    error = error.__cause__ or error
    return InputError(
        f"model answers a case ({_listed(case)}) among others, but not alone, as arrays of one number: "
        f"{type(error).__name__}: {str(error).rstrip('.')}. Every case must be worked out by itself, however many there are",
        code="bad_model",
        argument="model",
    )


def _listed(case: Mapping[str, Any]) -> str:
    return ", ".join(f"{name} = {float(value[0]):.9g}" for name, value in case.items())


def _told(value: float) -> str:
    return "no answer" if math.isnan(value) else f"{value:.9g}"

"""Why no speeds fit what was observed: what the first known allows for the second, by a scan with the forward kernel.

At a fixed ratio of slip to closing speed everything observed scales with the square of the closing speed, so that ratio is
scanned, at the size that the first known asks for; with one speed known, the other speed.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from typing import Any

import numpy as np

from ..errors import NoSolutionError, Status
from ..kernels.status import EPS
from .crossings import RestitutionOf
from .speeds_algebra import Scene

# Magnitudes that are tried around each place where something changes, and how often the best place is looked at more closely.
_SIZES = np.logspace(-9.0, 9.0, 721)
_CLOSER = 5
_PLACES = 65
# A range whose ends differ less is one value; what is this small beside it is 0.
_NOTHING = 1e-9
_NEAR = 1e-5
# A restitution above this loses next to nothing along the normal.
_ELASTIC = 1.0 - 1e-6

# Status, closing speed and what is observed of the second known, at places with a restitution; and what is left of that.
_Scan = Callable[[Any, Any], tuple[Any, Any, Any]]
_Values = Callable[[Any], Any]


def parallel(scene: Scene) -> bool:
    """Whether the courses are parallel."""
    (ax, ay), (bx, by) = ([float(scene.numbers[f"course_{label}[{i}]"]) for i in range(2)] for label in "ab")
    return abs(ax * by - ay * bx) <= 8.0 * EPS


def refusal(scene: Scene, status: int, function: RestitutionOf | None) -> NoSolutionError:
    """The error of a single case that has no answer."""
    kinds = " and ".join("both EES" if kind == "ees_a" else kind for kind in scene.kinds)
    if status == Status.INFINITE_MASS:
        kind = next(k for k in scene.kinds if k.startswith("delta_v") and np.isinf(scene.numbers[f"{k[-1]}.mass"]))
        other = "b" if kind[-1] == "a" else "a"
        return NoSolutionError(
            f"{kind} is that of an infinite mass, whose motion tells nothing of the impact; give delta_v_{other}",
            code="infinite_mass",
        )
    if not scene.kinds[0].startswith("speed") and parallel(scene):
        return NoSolutionError(
            f"the courses are parallel, so {kinds} tell of the closing speed alone; give one of the speeds",
            code="parallel_headings",
        )
    if status == Status.UNDETERMINED:
        return NoSolutionError(_many(scene, kinds), code="undetermined")
    if function is not None:
        function.complain()
    return NoSolutionError(
        f"no speeds along these courses fit {kinds} with this restitution, {scene.rule} and geometry: {_why(scene, function)}",
        code="contradictory",
    )


def _many(scene: Scene, kinds: str) -> str:
    """What is left open where many speeds lead to what was observed."""
    if "energy_loss" in scene.kinds and scene.e > _ELASTIC:
        return (
            f"many speeds along these courses lead to {_shown(scene, 'energy_loss')} as far as rounding lets it tell, so it "
            f"does not say which of them; give another of the knowns"
        )
    if scene.kinds[0].startswith("speed"):
        return f"{kinds} leave the other speed open, for many lead to the same; give another of the knowns"
    return f"where the contact slides, {kinds} tell of the closing speed alone and leave the slip open; give one of the speeds"


def _why(scene: Scene, function: RestitutionOf | None) -> str:
    first, second = scene.kinds
    if first.startswith("speed"):
        scan, places, whatever = *_by_other_speed(scene), "whatever the other speed"
    elif all(scene.targets[kind] == 0.0 for kind in scene.kinds):
        return "both are 0, which no impact leaves behind"
    else:
        if not scene.targets[first] > 0.0:
            first, second = second, first
        scan, places, whatever = *_by_slip(scene, first, second), "whatever the slip"
    given = float(scene.targets[second])
    values = _values(scan, scene.e) if function is None else _joint_values(scan, _table(scene, function))
    here = values(places)
    if np.all(np.isnan(here)):
        statuses = scan(places, scene.e)[0]
        outcome = Status(Counter(np.broadcast_to(statuses, places.shape).tolist()).most_common(1)[0][0])
        if outcome <= Status.ENERGY_GAIN:
            return f"nothing leads to {_shown(scene, first)}{'' if function is None else ' with a restitution of its own'}"
        return f"with {_shown(scene, first)}, {whatever}, {outcome.sentence}"
    low, high = (_extreme(values, places, sign) for sign in (-1.0, 1.0))
    low = 0.0 if _ends(places, here, lambda end, before: 5.0 * end < before) else low
    high = np.inf if _ends(places, here, lambda end, before: end > 5.0 * before) else high
    low = 0.0 if low <= _NOTHING * max(given, min(high, 1e6 * given)) else low
    # Between the places of a table only so much is known.
    digits = 6 if function is None else 3
    allowed = _range(scene, second, low, high, digits)
    if low < given < high:
        below = _extreme(lambda at: _where(values(at), lambda v: v <= given), places, 1.0)
        above = _extreme(lambda at: _where(values(at), lambda v: v >= given), places, -1.0)
        if not _NEAR * given < above - below < np.inf:
            # No gap that the scan sees: rounding, or an answer beyond its ends.
            return f"with {_shown(scene, first)} {_subject(second)} {allowed}, but nothing leads to {_shown(scene, second)}"
        allowed = f"{_range(scene, second, low, below, digits)} or {_range(scene, second, above, high, digits)}"
    was_given = f"{_shown(scene, second)} was given{_off(scene, low, high)}"
    return f"with {_shown(scene, first)} {_subject(second)} {allowed}, and {was_given}"


def _off(scene: Scene, low: float, high: float) -> str:
    """By how much what was given is out of the range, where the six digits of both do not show it."""
    kind = scene.kinds[1]
    given = float(scene.targets[kind])
    nearest = min(max(given, low), high)
    (one, unit), (other, _) = (_size(scene, kind, value) for value in (given, nearest))
    return f", {abs(one - other):.2g} {unit} off" if 0.0 < abs(given - nearest) < _NEAR * given else ""


def _values(scan: _Scan, e: Any) -> _Values:
    """What is observed of the second known, where the law has an answer: a single row."""

    def values(places: Any) -> Any:
        status, _, seen = scan(places, e)
        return np.where((status <= Status.ENERGY_GAIN) & np.isfinite(seen), seen, np.nan)[np.newaxis]

    return values


def _joint_values(scan: _Scan, restitution: Callable[[Any], Any]) -> _Values:
    """The same where the restitution belongs to the closing speed: a row for each piece of a grid of it that has both agree."""
    es = np.linspace(0.0, 1.0, 65)[:, np.newaxis]

    def values(places: Any) -> Any:
        status, closing, seen = scan(places, es)
        seen = np.where(status <= Status.ENERGY_GAIN, seen, np.nan)
        excess = restitution(closing) - es
        share = excess[:-1] / (excess[:-1] - excess[1:])
        share = np.where((share >= 0.0) & (share <= 1.0), share, np.nan)
        return seen[:-1] + share * (seen[1:] - seen[:-1])

    return values


def _table(scene: Scene, function: RestitutionOf) -> Callable[[Any], Any]:
    """The function of restitution between places where it was asked once, for it may be slow."""
    closing = np.logspace(-4.0, 4.0, 801)
    restitution = function(scene.speed_unit * closing)
    return lambda speeds: np.interp(speeds, closing, restitution, left=np.nan, right=np.nan)


def _by_slip(scene: Scene, first: str, second: str) -> tuple[_Scan, Any]:
    """Every slip per closing speed, at the closing speed that the first known asks for."""

    def scan(slip: Any, e: Any) -> tuple[Any, Any, Any]:
        status, seen = scene.outcome(*scene.speeds_at(np.ones(()), slip), e)
        scaled = scene.targets[first] / np.where(seen[first] > 0.0, seen[first], np.nan)
        return status, np.sqrt(scaled), scaled * seen[second]

    return scan, np.concatenate((-_SIZES[::-1], [0.0], _SIZES))


def _by_other_speed(scene: Scene) -> tuple[_Scan, Any]:
    """Every speed of the other vehicle, closely around those at which closing speed or slip change their sign."""
    first, second = scene.kinds
    which = 1 if first == "speed_a" else 0
    value = scene.targets[first]

    def scan(speed: Any, e: Any) -> tuple[Any, Any, Any]:
        status, seen = scene.outcome(*((value, speed) if which else (speed, value)), e)
        return status, seen["closing"], seen[second] + 0.0 * speed

    places = [np.zeros(1), -_SIZES, _SIZES]
    changes = {name: float(per_speed[which]) for name, per_speed in scene.per_speed.items()}
    for name, change in changes.items():
        if abs(change) > 64.0 * EPS * max(map(abs, changes.values())):
            middle = -(scene.rest[name] + scene.per_speed[name][1 - which] * value) / change
            places += [middle - _SIZES, middle.reshape(1), middle + _SIZES]
    return scan, np.unique(np.concatenate(places))


def _where(values: Any, wanted: Callable[[Any], Any]) -> Any:
    return np.where(wanted(values), values, np.nan)


def _extreme(values: _Values, places: Any, sign: float) -> float:
    """The largest value (the least, for a sign of -1), looked for more and more closely around the largest found."""
    best = -np.inf
    for _ in range(_CLOSER):
        here = values(places)
        signed = np.where(np.isnan(here), -np.inf, sign * here)
        best = max(best, float(np.max(signed)))
        middle = int(np.argmax(np.max(signed, axis=0)))
        places = np.linspace(places[max(middle - 1, 0)], places[min(middle + 1, len(places) - 1)], _PLACES)
    return sign * best


def _ends(places: Any, here: Any, changing: Callable[[Any, Any], Any]) -> bool:
    """Whether the values still change so at an end of the scan, against those at a tenth of it."""
    first, last = np.searchsorted(places, (0.1 * places[0], 0.1 * places[-1]))
    ends = ((here[:, -1], here[:, last]), (here[:, 0], here[:, first]))
    return any(bool(np.any((end > 0.0) & changing(end, before))) for end, before in ends)


def _subject(kind: str) -> str:
    if kind.startswith("delta_v"):
        return f"these courses and this contact make {kind}"
    doing = "dissipate" if kind == "energy_loss" else "absorb, at maximum crush,"
    return f"these courses and this contact {doing}"


def _size(scene: Scene, kind: str, value: Any) -> tuple[float, str]:
    """What was observed in SI, and its unit."""
    if kind.startswith("delta_v"):
        return float(np.sqrt(value) / scene.numbers[f"{kind[-1]}.mass"] * scene.speed_unit), "m/s"
    if kind.startswith("speed"):
        return float(value * scene.speed_unit), "m/s"
    return float(value * scene.mass_unit * scene.speed_unit * scene.speed_unit), "J"


def _shown(scene: Scene, kind: str) -> str:
    number, unit = _size(scene, kind, scene.targets[kind])
    return f"{number:.6g} J of both EES" if kind == "ees_a" else f"{kind} = {number:.6g} {unit}"


def _range(scene: Scene, kind: str, low: float, high: float, digits: int) -> str:
    (least, unit), (most, _) = (_size(scene, kind, value) for value in (low, high))
    first, last = (f"{float(f'{value:.{digits}g}'):.6g}" for value in (least, most))
    if np.isinf(high):
        return f"at least {first} {unit}" if low > 0.0 else f"more than 0 {unit}"
    if most - least <= _NEAR * most:
        return f"{last} {unit}"
    if low == 0.0:
        return f"{'more than 0 and ' if scene.targets[kind] == 0.0 else ''}at most {last} {unit}"
    return f"between {first} and {last} {unit}"

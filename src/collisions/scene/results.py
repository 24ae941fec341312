"""The results of a run by their paths, such as "Camry.rest.x", "impacts[0].a.delta_v" and
"contacts[1].impact.Camry.delta_v"; and the table of all.

``impacts[k]`` is counted in order of time, which may be another in each case;
``contacts[i].impact`` is the first impact of that contact, whenever it comes.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import nullcontext
from functools import cache
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..impact.impact import Impact, part_of_impact
from ..impact.vehicle_result import VehicleResult
from ..kernels.elementwise import UNIT_INTERVAL
from ..messages.errors import (
    CollisionsWarning,
    InputError,
    MissingInputError,
    NoSolutionError,
    Status,
)
from ..messages.warning import quietly, warn_of_cases
from ..quantities.attributes import attributes, unit_of
from ..quantities.formatting import KIND_OF
from ..quantities.reading import ArgumentReader
from ..quantities.settings import in_si
from ..quantities.tables import cells
from ..vehicle.vehicle import UNITS as OF_VEHICLE
from .curves import PARTS, Sample, check_lasts, no_curve, sample_of
from .marks import WHEELS, answers, of_mark
from .names import AT, POLAR, no_path
from .scene import Scene

if TYPE_CHECKING:
    from .run import Run

_MOMENTS = ("before", "after", "at_compression")
_STATE = ("x", "y", "heading", "vx", "vy", "yaw_rate", "speed", "course")
_PLACE = {"x": "m", "y": "m", "heading": "rad"}
_IMPACT = re.compile(rf"impacts{AT}\.(.+)")
_CONTACT = re.compile(rf"contacts{AT}\.impact\.(.+)")
_TIME = re.compile(rf"times{AT}")
_BETWEEN = re.compile(r"([^ -]+) *- *([^ -]+)")
REST = re.compile(r"([^.\[\]]+)\.rest\.(x|y|heading)")
_EES = re.compile(r"([ab])\.ees\(([^)]*)\)")
_LOOSE = re.compile(rf"(?:impacts|contacts){AT}\.(?:impact\.)?(.+)")
END = "end"


class OfImpact(NamedTuple):
    """What a path asks for of an impact: the name of a number of it, "" for its time, "a.ees"
    with the share of the energy that went into that vehicle, or "a.recorded" with a sample of a
    curve; of the first impact of a contact, or of the impact of this number in order of time.
    """

    contact: bool
    number: int
    name: str
    share: float = math.nan
    sample: Sample | None = None


def results_of(scene: Scene, impacts: int | None = None) -> dict[str, str]:
    """The paths of all results, with their units, but for those with a number in them: the distance
    of a place from a mark, the time between two, EES, and what a recorder shows.
    """
    return in_columns(scene, impacts) | {
        f"{name}.marks.{wheel}.{end}.{axis}": "m"
        for name, mover in scene.movers.items()
        if mover.tyres is not None or any(name in one.tyres_after for one in scene.contacts)
        for wheel in WHEELS
        for end in ("begin", "end")
        for axis in "xy"
    }


def in_columns(scene: Scene, impacts: int | None = None) -> dict[str, str]:
    """Those of them that are in the table of a run."""
    found: dict[str, str] = {}
    for name in scene.movers:
        found |= {f"{name}.rest.{part}": unit for part, unit in _PLACE.items()}
    found[END] = "s"
    for k in range(len(scene.contacts) if impacts is None else impacts):
        found[f"times[{k}]"] = "s"
        found |= {f"impacts[{k}].{part}": unit for part, unit in of_impact().items()}
    for i, contact in enumerate(scene.contacts):
        found[f"contacts[{i}].impact.time"] = "s"
        for part, unit in of_impact().items():
            label, dot, rest = part.partition(".")
            name = f"{getattr(contact, label)}.{rest}" if dot else part
            found[f"contacts[{i}].impact.{name}"] = unit
    return found


@cache
def of_impact() -> MappingProxyType[str, str]:
    """The numbers of an impact, with their units."""
    found: dict[str, str] = {}
    for name in attributes(Impact):
        unit = unit_of(Impact, name)
        if unit is not None and name not in ("point", "normal"):
            found[name] = unit
    for label in "ab":
        for name in attributes(VehicleResult):
            unit = unit_of(VehicleResult, name)
            if unit is not None:
                found[f"{label}.{name}"] = unit
        for moment in _MOMENTS:
            for name in _STATE:
                unit = OF_VEHICLE.get(name) or POLAR[name]
                found[f"{label}.{moment}.{name}"] = unit
    return MappingProxyType(found)


# Paths


def unit_of_result(scene: Scene, path: str, argument: str = "outputs") -> str:
    """The unit of a result; refused if the path is none."""
    if isinstance(path, str):
        if path == END or between(scene, path):
            return "s"
        found = REST.fullmatch(path)
        if found and found[1] in scene.movers:
            return _PLACE[found[2]]
        asked = asked_of(scene, path, argument)
        if asked is not None:
            if asked.sample is not None:
                check_lasts(scene, asked.number if asked.contact else None, path, argument)
            return _unit(asked)
        if of_mark(scene, path, argument):
            return "m"
    raise no_path(path, results_of(scene), argument, _meant(scene, path))


def is_result(scene: Scene, path: str, impacts: int) -> bool:
    """Whether a path is that of a result, of a run with so many impacts."""
    try:
        unit_of_result(scene, path)
    except (InputError, MissingInputError):
        return False
    return all(number < impacts for number in numbered(scene, [path]))


def _unit(asked: OfImpact) -> str:
    if not asked.name:
        return "s"
    return of_impact().get(asked.name, "m/s")


def asked_of(
    scene: Scene, path: str, argument: str = "outputs", *, warns: bool = False
) -> OfImpact | None:
    """What a path asks for of an impact; None for a path that does not. It ``warns`` of numbers
    without a unit where it is read first, and not whenever it is looked at again.
    """
    if found := _TIME.fullmatch(path):
        return OfImpact(False, int(found[1]), "")
    contact = False
    if found := _IMPACT.fullmatch(path):
        number, name = int(found[1]), found[2]
    elif found := _CONTACT.fullmatch(path):
        contact, number, name = True, int(found[1]), found[2]
        if number >= len(scene.contacts):
            return None
        if name == "time":
            return OfImpact(True, number, "")
        labelled = _labelled(scene, number, name)
        if labelled is None:
            return None
        name = labelled
    else:
        return None
    if name in of_impact():
        return OfImpact(contact, number, name)
    if ees := _EES.fullmatch(name):
        return OfImpact(contact, number, f"{ees[1]}.ees", _share(ees[2].strip(), path, argument))
    with nullcontext() if warns else quietly([]):
        sample = sample_of(name, path, argument)
    if sample:
        return OfImpact(contact, number, f"{sample.label}.recorded", sample=sample)
    return None


def _labelled(scene: Scene, number: int, name: str) -> str | None:
    """A number of a contact's impact by "a" or "b" in place of the name of a vehicle; None for one
    that names neither.
    """
    mover, dot, rest = name.partition(".")
    contact = scene.contacts[number]
    if dot and rest:
        for label in "ab":
            if getattr(contact, label) == mover:
                return f"{label}.{rest}"
        return None
    return name


def _share(text: str, path: str, argument: str) -> float:
    reader = ArgumentReader()
    if not text:
        raise InputError(
            f"{argument} has {path!r} without the share of the energy lost that went into this "
            f"vehicle; write '{path[:-1]}0.5)' for half of it",
            code="unknown_name",
            argument=argument,
        )
    found = reader.number(text, "", f"{path}: share", UNIT_INTERVAL)
    reader.close()
    return float(found)


def between(scene: Scene, path: str) -> tuple[str, str] | None:
    """The two times of which a path asks for the difference, the later first; None for another
    path.
    """
    found = _BETWEEN.fullmatch(path)
    if not found:
        return None
    for one in found.groups():
        asked = asked_of(scene, one)
        if one != END and (asked is None or asked.name):
            return None
    return found[1], found[2]


def numbered(scene: Scene, paths: Iterable[Any]) -> dict[int, str]:
    """The impacts that are asked for by their number in order of time, each with the first path
    that does so.
    """
    found: dict[int, str] = {}
    for path in paths:
        for one in between(scene, path) or (path,):
            asked = asked_of(scene, one)
            if asked is not None and not asked.contact:
                found.setdefault(asked.number, path)
    return found


def by_contact(scene: Scene, path: str, rule: int) -> str:
    """A path of an impact by its number, as that of the impact of a contact."""
    found = _IMPACT.fullmatch(path)
    if not found:
        return f"contacts[{rule}].impact.time"
    label, dot, rest = found[2].partition(".")
    name = f"{getattr(scene.contacts[rule], label)}.{rest}" if dot else label
    return f"contacts[{rule}].impact.{name}"


def _meant(scene: Scene, path: Any) -> str:
    """What to write in place of a result that goes by another name."""
    if not isinstance(path, str):
        return ""
    left = path.replace("delta_v_right", "delta_v_left")
    share = ""
    if left.endswith(".ees"):
        left += "(0.5)"
        share = ", with the share of the energy lost that went into it in place of 0.5"
    wanted = list(_candidates(scene, left))
    wanted = [one for one in dict.fromkeys(wanted) if asked_of(scene, one) is not None]
    if not wanted or wanted == [path]:
        return ""
    listed = " or ".join(f"'{one}'" for one in wanted)
    sign = " with the opposite sign, as it is positive to the left"
    which = ", of one contact or the other" if len(wanted) > 1 else ""
    return f"write {listed}{sign if 'delta_v_right' in path else ''}{share}{which}"


def _candidates(scene: Scene, path: str) -> Iterator[str]:
    """Paths that may be meant by one that is none."""
    if asked_of(scene, path):
        yield path
        return
    loose = _LOOSE.fullmatch(path)
    if not loose:
        mover, _, rest = path.partition(".")
        yield from _of_mover(scene, mover, rest)
        return
    number, name = int(loose[1]), loose[2]
    if path.startswith("contacts") and number < len(scene.contacts):
        label, dot, rest = name.partition(".")
        if dot and label in ("a", "b"):
            name = f"{getattr(scene.contacts[number], label)}.{rest}"
        yield f"contacts[{number}].impact.{name}"
    elif path.startswith("impacts"):
        mover, _, rest = name.partition(".")
        yield from _of_mover(scene, mover, rest)


def _of_mover(scene: Scene, mover: str, name: str) -> Iterator[str]:
    """A number of an impact of a vehicle, of each contact that it has."""
    for i, contact in enumerate(scene.contacts):
        if name and mover in (contact.a, contact.b):
            yield f"contacts[{i}].impact.{mover}.{name}"


# Values


def result_of(run: Run, path: str, order: Sequence[int] | None = None) -> Any:
    """The value of a result: a float, or of a batch an array, NaN where a case has none.

    With an ``order``, the contacts that impacts are of by their number, also where the impact of
    that number is another one; of a single case that is an error.
    """
    if path == END:
        return run.end
    if times := between(run.scene, path):
        later, sooner = (result_of(run, one, order) for one in times)
        return later - sooner
    if found := REST.fullmatch(path):
        value = getattr(run.rest[found[1]], found[2])
        if value is None:
            raise _without(path)
        return value
    if mark := of_mark(run.scene, path, "outputs"):
        return answers(run, [mark])[0]
    asked = asked_of(run.scene, path)
    assert asked is not None
    if asked.sample is not None:
        return curves_of(run, {path: asked}, order)[path]
    followed = run._followed
    numbers = _numbers(run, asked, path, order)
    if followed.single:
        number = int(numbers[0])
        return _value(run.impacts[number], asked, path) if asked.name else run.times[number]
    values = np.full(followed.count, np.nan)
    if not asked.name:
        came = np.flatnonzero(numbers >= 0)
        values[came] = followed.came.times[numbers[came], came]
    for hit in followed.came.hits if asked.name else ():
        some = hit.number == numbers[hit.which]
        if some.any():
            part = np.broadcast_to(_value(hit.impact, asked, path), len(hit.which))
            values[hit.which[some]] = part[some]
    values[followed.told.failed != ""] = np.nan
    return values


def curves_of(
    run: Run, asked: Mapping[str, OfImpact], order: Sequence[int] | None
) -> dict[str, Any]:
    """The values of samples of the curves of recorders, as those of ``result_of``: an impact is
    followed once for all samples of a recorder in it.
    """
    by_recorder: dict[tuple[Any, ...], list[str]] = {}
    for path, one in asked.items():
        assert one.sample is not None
        place = one.sample.forward, one.sample.left
        by_recorder.setdefault((one.contact, one.number, one.name, *place), []).append(path)
    followed, found = run._followed, {}
    for (*_, forward, left), paths in by_recorder.items():
        one = asked[paths[0]]
        samples = [sample for path in paths if (sample := asked[path].sample) is not None]
        times = np.array(list(dict.fromkeys(sample.time for sample in samples)))
        places = [int(np.flatnonzero(times == sample.time)[0]) for sample in samples]
        recorder = one.name[0], times, forward, left, paths[0]
        numbers = _numbers(run, one, paths[0], order)
        if followed.single:
            curves = _shown(run.impacts[int(numbers[0])], *recorder)
        else:
            curves = np.full((2, len(times), followed.count), np.nan)
            for hit in followed.came.hits:
                some = hit.number == numbers[hit.which]
                if some.any():
                    own = _shown(hit.impact, *recorder).reshape(2, len(times), -1)
                    own = np.broadcast_to(own, (2, len(times), len(hit.which)))
                    curves[:, :, hit.which[some]] = own[:, :, some]
            curves[:, :, followed.told.failed != ""] = np.nan
        for path, sample, at in zip(paths, samples, places, strict=True):
            value = curves[PARTS.index(sample.part), at]
            found[path] = float(value) if followed.single else value
    return found


def _shown(impact: Impact, label: str, times: Any, forward: float, left: float, path: str) -> Any:
    """Both parts of what a recorder shows at times, (2, times, ...)."""
    if impact.pulse is None:
        raise no_curve(f"{path}: its contact is not followed in time", path, "outputs")
    vehicle = impact.a if label == "a" else impact.b
    # Numbers without a unit were warned of, or refused, where the path was read.
    with quietly([]), in_si():
        return np.array(vehicle.recorded(times, forward=forward, left=left))


def _numbers(run: Run, asked: OfImpact, path: str, order: Sequence[int] | None) -> Any:
    """Which impact of each case is asked for, by its number in order of time; -1 for none."""
    followed = run._followed
    rules, number = followed.came.rules, asked.number
    if asked.contact:
        its = rules == number
        return np.where(its.any(axis=0), its.argmax(axis=0), -1)
    if followed.single and number >= len(run.impacts):
        raise _not_so_many(run, path)
    none = absent(run, number)
    if order is not None:
        other = another(run, number, order)
        if followed.single and other[0]:
            contact = run.scene.contacts[rules[number, 0]]
            raise NoSolutionError(
                f"{path}: impact {number} is of {contact.a} and {contact.b} here, and "
                f"{told(run.scene, number, order)}; write "
                f"'{by_contact(run.scene, path, order[number])}', which is of the same vehicles in "
                "every case",
                code="several_orders",
                argument="outputs",
            )
        none |= other
    return np.where(none, -1, number)


def absent(run: Run, number: int) -> Any:
    """Where there is no impact of a number, of the cases of a run."""
    rules = run._followed.came.rules
    if number >= len(rules):
        return np.ones(run._followed.count, dtype=bool)
    return rules[number] < 0


def another(run: Run, number: int, order: Sequence[int]) -> Any:
    """Where the impact of a number is another than in an order: of another contact, or another
    impact of the same.
    """
    rules = run._followed.came.rules
    if number >= min(len(rules), len(order)):
        return np.zeros(run._followed.count, dtype=bool)
    rule = order[number]
    before = np.count_nonzero(rules[:number] == rule, axis=0)
    same = (rules[number] == rule) & (before == list(order[:number]).count(rule))
    return (rules[number] >= 0) & ~same


def told(scene: Scene, number: int, order: Sequence[int]) -> str:
    """Which impact a number is in an order, in words."""
    rule = order[number]
    contact = scene.contacts[rule]
    many = list(order[:number]).count(rule)
    again = f", number {many + 1} of that contact" if many else ""
    return (
        f"impacts[{number}] of the scene as written is that of {contact.a} and {contact.b} "
        f"(contacts[{rule}]{again})"
    )


def _value(impact: Impact, asked: OfImpact, path: str) -> Any:
    if not math.isnan(asked.share):
        of_a = asked.name.startswith("a")
        return impact.ees(asked.share if of_a else 1.0 - asked.share)[0 if of_a else 1]
    value: Any = impact
    for name in asked.name.split("."):
        value = getattr(value, name)
    if value is None:
        raise _without(path)
    return value


def _without(path: str) -> MissingInputError:
    return MissingInputError(
        f"{path} has no value, as what it needs was not given, such as a heading, a position or a "
        "yaw inertia of the vehicle",
        code="missing_input",
        argument=path,
    )


def _not_so_many(run: Run, path: str) -> InputError:
    count = len(run.impacts)
    return InputError(
        f"{path}: this scene has {count} impact{'' if count == 1 else 's'}, counted from 0",
        code="unknown_name",
        argument="outputs",
    )


# All cases, and the table


def usual_order(run: Run) -> tuple[int, ...]:
    """The contacts that the impacts of a run are of, in order; of a batch those of most cases."""
    followed = run._followed
    rules = followed.came.rules[: followed.came.most, followed.told.failed == ""]
    found: list[int] = []
    like = np.ones(rules.shape[1], dtype=bool)
    for row in rules:
        here = row >= 0
        if not here.any():
            break
        # Among the cases that went like most so far, as long as there are some.
        like = like & here if (like & here).any() else here
        found.append(int(np.bincount(row[like]).argmax()))
        like = like & (row == found[-1])
    return tuple(found)


def whole_impact(run: Run, number: int) -> Impact:
    """The impacts of one number over all cases of a batch, NaN where there is none."""
    hits, count = run._hits(number), run._followed.count
    if len(hits) == 1 and np.count_nonzero(hits[0][1]) == count:
        return hits[0][0].impact
    if len(hits) > 1:
        raise InputError(
            f"impact {number} comes about otherwise in some cases of the batch; "
            "run.case(i).impacts has that of one case",
            code="several_orders",
            argument="index",
        )
    ((hit, some),) = hits

    def spread(value: Any) -> Any:
        # Numbers of models and flags have no NaN; where there is no impact, no number has a value.
        kind = np.asarray(value).dtype
        whole = np.zeros(count, kind) if kind.kind in "bu" else np.full(count, np.nan)
        whole[hit.which[some]] = np.broadcast_to(value, len(hit.which))[some]
        return whole

    return part_of_impact(hit.impact, spread, on_failure="nan")


def columns_of(run: Run, units: Any) -> dict[str, list[Any]]:
    """The results as columns with one value for each case."""
    system = None if units is None else cells(units)
    followed = run._followed
    order = usual_order(run)
    if not followed.single:
        warn_of_another(run, range(len(order)), order, "in most cases")
    found: dict[str, list[Any]] = {"status": np.ravel(run.status).tolist()}
    for number in range(run._most):
        found[f"impacts[{number}].status"] = _statuses(run, number, order)
    for path, unit in in_columns(run.scene, run._most).items():
        try:
            value = np.broadcast_to(result_of(run, path, order), (followed.count,))
        except (MissingInputError, TypeError):
            continue
        kind = KIND_OF.get(unit)
        name = path
        if system is not None and unit:
            if kind is not None:
                with np.errstate(over="ignore"):
                    value = value * system.scale(kind)
            name = f"{path} [{unit if kind is None else system.label(kind)}]"
        found[name] = value.tolist()
    return found


def _statuses(run: Run, number: int, order: Sequence[int]) -> list[str]:
    """The status of the impact of a number in each case; "" where it has none, or another."""
    followed = run._followed
    labels = np.full(followed.count, "", dtype=object)
    for hit in followed.came.hits:
        statuses = np.ravel(np.broadcast_to(hit.impact.status, len(hit.which))).tolist()
        for case, at, status in zip(hit.which.tolist(), hit.number.tolist(), statuses, strict=True):
            if at == number:
                labels[case] = Status(status).label
    labels[another(run, number, order) | (followed.told.failed != "")] = ""
    return labels.tolist()


def warn_of_another(run: Run, numbers: Iterable[int], order: Sequence[int], as_in: str) -> None:
    """Say in how many cases of a batch the impact of a number is another than in an order, and has
    no answer.
    """
    followed, parts = run._followed, {}
    for number in numbers:
        cases = another(run, number, order) & (followed.told.failed == "")
        if np.any(cases):
            contact = run.scene.contacts[order[number]]
            said = (
                f"impacts[{number}] is another than that of {contact.a} and {contact.b}, which it "
                f"is {as_in}, and has no answer; 'contacts[{order[number]}].impact...' is that of "
                "these two in every case"
            )
            parts[number, said] = cases
    if parts:
        many = {number: int(np.count_nonzero(cases)) for (number, _), cases in parts.items()}
        listed = ", ".join(f"impacts[{number}] {count}" for number, count in many.items())
        number, said = next(iter(parts))
        text = f"in {many[number]} of {followed.count} cases {said}"
        if len(parts) > 1:
            text = (
                f"of {followed.count} cases some have impacts of other contacts in this order than "
                f"{as_in}, and no answer to those ({listed}); 'contacts[0].impact...' is that of "
                "one contact in every case"
            )
        warning = CollisionsWarning(text, code="several_orders")
        warn_of_cases(warning, {said: cases for (_, said), cases in parts.items()})

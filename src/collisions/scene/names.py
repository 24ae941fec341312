"""The numbers of a scene by their paths: inputs that can be replaced, and results of a run.

A path is written as in Python: "Camry.vx", "Camry.tyres.lock[0]", "contacts[0].point[1]",
"Camry.rest.x", "impacts[0].a.delta_v", "Camry.marks.front_left.distance(12.3 m, 4.5 m)".
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

import numpy as np

from ..impact.impact import Impact, part_of_impact
from ..impact.inputs import index_of, part_of
from ..impact.vehicle_result import VehicleResult
from ..messages.errors import CollisionsError, InputError, MissingInputError, placed
from ..messages.warning import state_of_study
from ..quantities.attributes import attributes, unit_of
from ..quantities.directions import direction
from ..quantities.formatting import KIND_OF
from ..quantities.reading import ArgumentReader, at_least_zero
from ..quantities.refusals import must_be
from ..quantities.tables import cells
from ..vehicle.tyres import LOCKS, as_given
from ..vehicle.vehicle import UNITS as OF_VEHICLE
from ..vehicle.vehicle import Vehicle
from .contact import UNITS as OF_CONTACT
from .marks import answers, of_mark
from .scene import Scene, arguments_of

if TYPE_CHECKING:
    from .run import Run

_TYRES = {
    "friction": "",
    "lock": "",
    **dict.fromkeys(LOCKS, ""),
    "wheelbase": "m",
    "track": "m",
    "steer": "rad",
    "cornering": "",
    "height": "m",
}
_VEHICLE = {name: unit for name, unit in OF_VEHICLE.items() if name != "pivot"}
_POLAR = {"speed": "m/s", "course": "rad"}
_MOMENTS = ("before", "after", "at_compression")
_STATE = ("x", "y", "heading", "vx", "vy", "yaw_rate", "speed", "course")
_PLACE = {"x": "m", "y": "m", "heading": "rad"}
_MOST_NEAR = 3


def inputs_of(scene: Scene) -> dict[str, str]:
    """The paths of all inputs, with their units."""
    found: dict[str, str] = {}
    for name, mover in scene.movers.items():
        body = mover.vehicle
        for part, unit in _VEHICLE.items():
            if getattr(body, part) is not None:
                found[f"{name}.{part}"] = unit
        if np.all(body.speed != 0.0):
            found |= {f"{name}.{part}": unit for part, unit in _POLAR.items()}
        if mover.tyres is not None:
            found |= {f"{name}.tyres.{part}": _TYRES[part] for part in mover.tyres.named}
        if mover.drag is not None:
            found[f"{name}.drag"] = ""
    for i, contact in enumerate(scene.contacts):
        for part, value, unit in contact._values():
            path = f"contacts[{i}].{part}"
            if part == "normal":
                found[path] = "rad"
            elif isinstance(value, tuple):
                found |= {f"{path}[{k}]": unit or "" for k in range(2)}
            else:
                found[path] = unit or ""
        for name, tyres in contact.tyres_after.items():
            path = f"contacts[{i}].tyres_after.{name}"
            found |= {f"{path}.{part}": _TYRES[part] for part in tyres.named}
    found |= {f"surfaces[{i}]": "" for i in range(len(scene.surfaces))}
    found |= {f"slope[{i}]": "" for i in range(2)}
    for name, paths in scene.shared.items():
        found[name] = found.get(paths[0], "")
    return found


def check_shared(scene: Scene) -> None:
    """Refuse shared names whose paths are none, of several kinds, or of different numbers."""
    reader = ArgumentReader()
    known = inputs_of(scene)
    numbers = dict(scene._numbers())
    for name, paths in scene.shared.items():
        for path in paths:
            if path not in known:
                reader.refuse(no_path(path, known, f"shared[{name!r}]", _meant(scene, path)))
        if len({known[path] for path in paths if path in known}) > 1:
            listed = ", ".join(f"{path} [{known[path]}]" for path in paths if path in known)
            text = f"shared[{name!r}] names inputs of several kinds: {listed}"
            reader.refuse(InputError(text, code="bad_combination", argument="shared"))
        elif all(path in known for path in paths):
            first, *others = paths
            values = {path: _number_of(scene, numbers, path) for path in paths}
            unlike = [path for path in others if not _same(values[first], values[path])]
            if unlike:
                one, other = (
                    path if np.ndim(values[path]) else f"{path} is {values[path]:.6g} {known[path]}"
                    for path in (first, unlike[0])
                )
                text = (
                    f"shared[{name!r}] says that {', '.join(paths)} are one and the same number, "
                    f"and these differ: {one.strip()}, {other.strip()}; state the same at each"
                )
                reader.refuse(InputError(text, code="bad_combination", argument="shared"))
    reader.close()


def _number_of(scene: Scene, numbers: Mapping[str, Any], path: str) -> Any:
    """The number at a path of ``inputs_of``."""
    if path in numbers:
        return numbers[path]
    if f"{path}[0]" in numbers:
        # A normal, which is asked for as an angle.
        return np.arctan2(numbers[f"{path}[1]"], numbers[f"{path}[0]"])
    name, _, part = path.rpartition(".")
    return getattr(scene.movers[name].vehicle, part)


def _same(one: Any, other: Any) -> bool:
    """Whether two numbers are one, but for the rounding of a speed that is kept as vx and vy."""
    return bool(np.all(np.equal(one, other))) or bool(np.allclose(one, other, rtol=1e-9, atol=0.0))


def no_path(path: Any, known: Iterable[str], argument: str, instead: str = "") -> InputError:
    """The error for a path that is none, with what is meant, or else the nearest ones."""
    if not instead:
        listed = list(known)
        near = get_close_matches(str(path), listed, _MOST_NEAR, 0.5) or listed[:_MOST_NEAR]
        instead = f"near it are {', '.join(near)}"
    return InputError(
        f"{argument} has no {path!r}; {instead}", code="unknown_name", argument=argument
    )


def _meant(scene: Scene, path: Any) -> str:
    """What to write in place of an input that the scene would have, were it built otherwise."""
    found = _OF_MOVER.fullmatch(path) if isinstance(path, str) else None
    if not found or found[1] not in scene.movers or found[2] not in _POLAR:
        return ""
    return (
        f"{found[1]} stands, and what stands has no {found[2]}. Build it with "
        "`Vehicle.from_speed(speed=..., course=...)`, with any speed above 0, or take "
        f"'{found[1]}.vx' and '{found[1]}.vy'"
    )


def _meant_result(scene: Scene, path: Any) -> str:
    """What to write in place of a result that goes by another name."""
    if not isinstance(path, str):
        return ""
    text = path
    mover, _, rest = text.partition(".")
    sides = [
        (k, side)
        for k, contact in enumerate(scene.contacts)
        for side in "ab"
        if getattr(contact, side) == mover
    ]
    if sides and rest:
        (k, side), *_ = sides
        text = f"impacts[{k}].{side}.{rest}"
    left = text.replace("delta_v_right", "delta_v_left")
    inner = _OF_IMPACT.fullmatch(left)
    if left == path or not inner or inner[2] not in _of_impact():
        return ""
    which = ""
    if left != text:
        which = " with the opposite sign, as it is positive to the left"
    elif len(sides) > 1:
        which = ", or of another of its impacts, counted from 0 in order of time"
    return f"write '{left}'{which}"


def replaced(scene: Scene, changes: Any) -> Scene:
    """The scene with other numbers, each by its path."""
    if not isinstance(changes, Mapping) or not all(isinstance(path, str) for path in changes):
        raise must_be(
            "changes",
            "a dict from paths to numbers, such as `{'Camry.vx': '30 mph'}`",
            changes,
            code="bad_shape",
        )
    spread: dict[str, Any] = {}
    by: dict[str, str] = {}
    for path, value in changes.items():
        for one in _changed_by(scene, path):
            if one in spread:
                raise InputError(
                    f"{one} is changed twice, by {by[one]!r} and by {path!r}; change it by one",
                    code="bad_combination",
                    argument="changes",
                )
            spread[one], by[one] = value, path
    arguments = arguments_of(scene)
    grouped: dict[tuple[str, ...], dict[str, Any]] = {}
    for path, value in spread.items():
        owner, part = _owner(scene, path)
        grouped.setdefault(owner, {})[part] = value
    for owner, parts in grouped.items():
        _change(scene, arguments, owner, parts)
    return Scene(**arguments)


def _changed_by(scene: Scene, path: str) -> tuple[str, ...]:
    """The paths of the numbers that change with one: all that are one and the same with it."""
    if path in scene.shared:
        return scene.shared[path]
    for paths in scene.shared.values():
        if path in paths:
            return paths
    return (path,)


_OF_CONTACT = re.compile(r"contacts\[(\d+)\]\.(\w+)(?:\[([01])\])?")
_AFTER = re.compile(r"contacts\[(\d+)\]\.tyres_after\.([^.\[\]]+)\.(\w+(?:\[[0-3]\])?)")
_OF_LIST = re.compile(r"(surfaces|slope)\[(\d+)\]")
_OF_TYRES = re.compile(r"([^.\[\]]+)\.tyres\.(\w+(?:\[[0-3]\])?)")
_OF_MOVER = re.compile(r"([^.\[\]]+)\.(\w+)")


def _owner(scene: Scene, path: str) -> tuple[tuple[str, ...], str]:
    """What a path belongs to, and its name there; refused if it is none."""
    if found := _AFTER.fullmatch(path):
        i, name, part = found.groups()
        good = int(i) < len(scene.contacts) and name in scene.contacts[int(i)].tyres_after
        if good and part in _TYRES:
            return ("after", i, name), part
    elif found := _OF_CONTACT.fullmatch(path):
        i, part, at = found.groups()
        pair = part == "point"
        if int(i) < len(scene.contacts) and part in OF_CONTACT and pair == (at is not None):
            return ("contact", i), part if at is None else f"{part}[{at}]"
    elif found := _OF_LIST.fullmatch(path):
        part, i = found.groups()
        if int(i) < (len(scene.surfaces) if part == "surfaces" else 2):
            return (part,), i
    elif found := _OF_TYRES.fullmatch(path):
        name, part = found.groups()
        if name in scene.movers and scene.movers[name].tyres is not None and part in _TYRES:
            return ("tyres", name), part
    elif found := _OF_MOVER.fullmatch(path):
        name, part = found.groups()
        if name in scene.movers and part in (*_VEHICLE, *_POLAR, "drag"):
            return ("mover", name), part
    raise no_path(path, inputs_of(scene), "scene")


def _change(
    scene: Scene, arguments: dict[str, Any], owner: tuple[str, ...], parts: dict[str, Any]
) -> None:
    """Change some numbers of one part of a scene, within its arguments."""
    kind = owner[0]
    if kind in ("surfaces", "slope"):
        listed = list(arguments[kind])
        for at, value in parts.items():
            listed[int(at)] = (listed[int(at)][0], value) if kind == "surfaces" else value
        arguments[kind] = listed if kind == "surfaces" else tuple(listed)
        return
    try:
        if kind in ("tyres", "mover"):
            mover = arguments["movers"][owner[1]]
            if kind == "tyres":
                new = mover.replace(tyres=_tyres_with(mover.tyres, parts))
            else:
                drag = {"drag": parts.pop("drag")} if "drag" in parts else {}
                new = mover.replace(vehicle=_moving(owner[1], mover.vehicle, parts), **drag)
            arguments["movers"][owner[1]] = new
            return
        number = int(owner[1])
        contact = arguments["contacts"][number]
        if kind == "after":
            after = dict(contact.tyres_after)
            after[owner[2]] = _tyres_with(after[owner[2]], parts)
            arguments["contacts"][number] = contact.replace(tyres_after=after)
            return
        point = [*(contact.as_given("point") or ())]
        for k in range(2):
            if f"point[{k}]" in parts:
                if not point:
                    text = (
                        f"contacts[{number}].point is not given, and comes from the outlines; "
                        "write `point=` in the `|Contact|[[contact]]` to change it"
                    )
                    raise InputError(text, code="unknown_name", argument="scene")
                point[k] = parts.pop(f"point[{k}]")
        whole = {"point": tuple(point)} if point else {}
        arguments["contacts"][number] = contact.replace(**whole, **parts)
    except CollisionsError as error:
        path = "contacts[{}]" if kind in ("contact", "after") else "{}"
        raise placed(error, path.format(owner[1])) from None


def _tyres_with(tyres: Any, parts: Mapping[str, Any]) -> Any:
    """Tyres with other numbers, single locks among them."""
    locks = [name for name in parts if name in LOCKS]
    if not locks:
        return tyres.replace(**parts)
    if not isinstance(tyres.lock, tuple):
        raise InputError(
            f"{locks[0]} is of four locks, and the tyres have one for all; write lock, or "
            "lock=[...] in Tyres",
            code="unknown_name",
            argument="scene",
        )
    given = as_given(tyres, "lock")
    given = [parts.get(name, one) for name, one in zip(LOCKS, given, strict=True)]
    rest = {name: value for name, value in parts.items() if name not in LOCKS}
    return tyres.replace(lock=given, **rest)


def _moving(name: str, body: Vehicle, parts: dict[str, Any]) -> Vehicle:
    """A vehicle with other numbers, its speed and course among them."""
    polar = {part: parts.pop(part) for part in _POLAR if part in parts}
    if not polar:
        return body.replace(**parts)
    both = [part for part in ("vx", "vy") if part in parts]
    if both:
        raise InputError(
            f"{next(iter(polar))} and {both[0]} are changed at once; give either speed and course "
            "or vx and vy",
            code="speed_twice",
            argument="speed",
        )
    if len(polar) < 2 and np.any(body.speed == 0.0):
        missing = "course" if "speed" in polar else "speed"
        raise InputError(
            f"{name} stands, so its {missing} is not known; write '{name}.vx' and '{name}.vy' in "
            f"place of '{name}.{next(iter(polar))}', or build it with "
            "`Vehicle.from_speed(speed=..., course=...)`, with any speed above 0",
            code="missing_course",
            argument="speed",
        )
    reader = ArgumentReader()
    speed: Any = body.speed
    if "speed" in polar:
        read = reader.number(polar["speed"], "m/s", "speed")
        speed = at_least_zero(
            reader, read, polar["speed"], "speed", "negative_speed", "turn the course by 180 deg"
        )
        if np.any(np.less(read, 0.0)) and not reader.problems:
            text = (
                "speed must be >= 0 in every case; bound what is drawn, as by `truncate=(0, high)`"
            )
            reader.refuse(InputError(text, code="negative_speed", argument="speed"))
    if "course" in polar:
        cx, cy = direction(reader, polar["course"], "course")
    else:
        cx, cy = body.vx / body.speed, body.vy / body.speed
    reader.close()
    return body.replace(vx=speed * cx + 0.0, vy=speed * cy + 0.0, **parts)


def case_of(scene: Scene, index: Any, of: str = "scene") -> Scene:
    """One case of a batch as a single scene; ``of`` is what a caller has."""
    shape = scene.shape
    place = index_of(index, shape, of)

    def take(value: Any) -> Any:
        return np.broadcast_to(value, shape or ())[place].item()

    arguments = arguments_of(scene)
    arguments["movers"] = {
        name: mover.replace(
            vehicle=part_of(mover.vehicle, take),
            tyres=part_of(mover.tyres, take),
            drag=part_of(mover.as_given("drag"), take),
        )
        for name, mover in scene.movers.items()
    }
    arguments["contacts"] = [
        contact.replace(
            **{
                part: part_of(contact.as_given(part), take)
                for part in (*OF_CONTACT, "tyres_after")
                if part != "at" or not contact.touches
            }
        )
        for contact in scene.contacts
    ]
    arguments["surfaces"] = [
        (corners, part_of(friction, take)) for corners, friction in arguments["surfaces"]
    ]
    arguments["slope"] = part_of(arguments["slope"], take)
    return Scene(**arguments)


# Results


def results_of(scene: Scene, impacts: int | None = None) -> dict[str, str]:
    """The paths of all results, with their units."""
    found: dict[str, str] = {}
    for name in scene.movers:
        found |= {f"{name}.rest.{part}": unit for part, unit in _PLACE.items()}
    found["end"] = "s"
    for k in range(len(scene.contacts) if impacts is None else impacts):
        found[f"times[{k}]"] = "s"
        found |= {f"impacts[{k}].{part}": unit for part, unit in _of_impact().items()}
    return found


def _of_impact() -> dict[str, str]:
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
                unit = OF_VEHICLE.get(name) or _POLAR[name]
                found[f"{label}.{moment}.{name}"] = unit
    return found


_OF_IMPACT = re.compile(r"impacts\[(\d+)\]\.(.+)")
_TIME = re.compile(r"times\[(\d+)\]")
_REST = re.compile(r"([^.\[\]]+)\.rest\.(x|y|heading)")


def unit_of_result(scene: Scene, path: str, argument: str = "outputs") -> str:
    """The unit of a result; refused if the path is none."""
    if isinstance(path, str):
        if _TIME.fullmatch(path) or path == "end":
            return "s"
        found = _REST.fullmatch(path)
        if found and found[1] in scene.movers:
            return _PLACE[found[2]]
        found = _OF_IMPACT.fullmatch(path)
        if found and found[2] in (known := _of_impact()):
            return known[found[2]]
        if of_mark(scene, path, argument):
            return "m"
    raise no_path(path, results_of(scene), argument, _meant_result(scene, path))


def result_of(run: Run, path: str) -> Any:
    """The value of a result: a float, or of a batch an array, NaN where a case has none."""
    followed = run._followed
    if path == "end":
        return run.end
    if found := _TIME.fullmatch(path):
        number = int(found[1])
        if followed.single and number >= len(run.times):
            raise _not_so_many(run, path)
        return run._time(number)
    if found := _REST.fullmatch(path):
        value = getattr(run.rest[found[1]], found[2])
        if value is None:
            raise _without(path)
        return value
    if asked := of_mark(run.scene, path, "outputs"):
        return answers(run, [asked])[0]
    found = _OF_IMPACT.fullmatch(path)
    assert found is not None
    number, inner = int(found[1]), found[2].split(".")
    if followed.single:
        if number >= len(run.impacts):
            raise _not_so_many(run, path)
        return _inner(run.impacts[number], inner, path)
    values = np.full(followed.count, np.nan)
    for hit, some in run._hits(number):
        part = np.broadcast_to(_inner(hit.impact, inner, path), len(hit.which))
        values[hit.which[some]] = part[some]
    values[followed.failed != ""] = np.nan
    return values


def _inner(impact: Impact, names: list[str], path: str) -> Any:
    value: Any = impact
    for name in names:
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
        whole = np.full(count, np.nan)
        whole[hit.which[some]] = np.broadcast_to(value, len(hit.which))[some]
        return whole

    return part_of_impact(hit.impact, spread, on_failure="nan")


def columns_of(run: Run, units: Any) -> dict[str, list[Any]]:
    """The results as columns with one value for each case."""
    system = None if units is None else cells(units)
    followed = run._followed
    paths: dict[str, str] = results_of(run.scene, run._most)
    found: dict[str, list[Any]] = {"status": np.ravel(run.status).tolist()}
    for path, unit in paths.items():
        try:
            value = np.broadcast_to(result_of(run, path), (followed.count,))
        except (MissingInputError, TypeError):
            continue
        kind = KIND_OF.get(unit)
        name = path
        if system is not None and unit:
            if kind is not None:
                value = value * system.scale(kind)
            name = f"{path} [{unit if kind is None else system.label(kind)}]"
        found[name] = value.tolist()
    return found


def as_function(
    scene: Scene,
    names: Iterable[str],
    outputs: Iterable[str],
    tolerance: float,
    at_level: Callable[[Scene], Scene] | None = None,
) -> Callable[..., dict[str, Any]]:
    """A function of some numbers of a scene, by their paths, that returns some of its results as
    Quantities; ``at_level`` makes the scene that is run of the one with these numbers.
    """
    from ..quantities.units import shown, to_quantity
    from .run import Run, warn_of_findings

    listed = {}
    for argument, given in (("names", names), ("outputs", outputs)):
        read = _paths_in(given)
        if read is None:
            raise InputError(
                f"{argument} must be a list of paths, such as ['Camry.vx'], got {shown(given)}",
                code="bad_shape",
                argument=argument,
            )
        listed[argument] = read
    known, wanted = inputs_of(scene), listed["outputs"]
    for name in listed["names"]:
        if not isinstance(name, str):
            raise no_path(name, inputs_of(scene), "names")
        if name not in known:
            _owner(scene, name)
    units = {path: unit_of_result(scene, path) for path in wanted}
    marks = {path: asked for path in wanted if (asked := of_mark(scene, path, "outputs"))}
    standing = _standing(scene, listed["names"])
    # These are followed to their rest all at once.
    ends = [found[1] for path in wanted if (found := _REST.fullmatch(path))]
    resting = list(scene.movers) if "end" in wanted else list(dict.fromkeys(ends))

    def model(**values: Any) -> dict[str, Any]:
        for name in standing:
            state_of_study(
                f"{name} stands at the start: no speed above 0 was given for it, and its speed is "
                "not among the unknowns",
                "stands",
            )
        made = replaced(scene, values)
        made = made if at_level is None else at_level(made)
        # What vehicles touch after the last impact matters to where they come to rest.
        run = Run(made, tolerance, to_rest=bool(resting or marks))
        warn_of_findings(run)
        run._followed.to_rest(resting)
        # All points of a mark at once: the mark is worked out for them, and not kept.
        found = dict(zip(marks, answers(run, list(marks.values())), strict=True))
        found |= {path: result_of(run, path) for path in wanted if path not in marks}
        return {path: to_quantity(found[path], unit) for path, unit in units.items()}

    vars(model)["answers_by_case"] = True
    vars(model)["units_of_inputs"] = {path: known.get(path, "") for path in listed["names"]}
    return model


def _standing(scene: Scene, changed: Iterable[str]) -> list[str]:
    """The vehicles that stand at the start in every case, though they could move."""
    paths = {one for path in changed for one in _changed_by(scene, path)}
    return [
        name
        for name, mover in scene.movers.items()
        if not mover.fixed
        and all(
            np.all(np.equal(getattr(mover.vehicle, part), 0.0)) and f"{name}.{part}" not in paths
            for part in ("vx", "vy", "yaw_rate")
        )
        and f"{name}.speed" not in paths
    ]


def _paths_in(given: Any) -> tuple[Any, ...] | None:
    """What a collection holds; None of one text and of what is none.

    A Quantity of one number has the method of a collection.
    """
    if isinstance(given, str) or not isinstance(given, Iterable):
        return None
    try:
        return tuple(given)
    except TypeError:
        return None

"""The numbers of a scene by their paths, which can be replaced.

A path is written as in Python: "Camry.vx", "Camry.tyres.lock[0]", "contacts[0].point[1]".
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from ..impact.inputs import index_of, part_of
from ..messages.errors import CollisionsError, InputError, placed
from ..messages.hints import nearest
from ..quantities.directions import direction
from ..quantities.reading import ArgumentReader, at_least_zero
from ..quantities.refusals import must_be
from ..quantities.settings import in_si, unit_required
from ..quantities.units import rendered
from ..vehicle.tyres import LOCKS, as_given
from ..vehicle.vehicle import UNITS as OF_VEHICLE
from ..vehicle.vehicle import Vehicle
from .contact import UNITS as OF_CONTACT
from .scene import Scene, arguments_of

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
POLAR = {"speed": "m/s", "course": "rad"}
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
            found |= {f"{name}.{part}": unit for part, unit in POLAR.items()}
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
    """Refuse shared names whose paths are none, of several kinds, of different numbers, or under
    another name too.
    """
    reader = ArgumentReader()
    names: dict[str, str] = {}
    known = inputs_of(scene)
    numbers = dict(scene._numbers())
    for name, paths in scene.shared.items():
        for path in paths:
            if names.setdefault(path, name) != name:
                first = names[path]
                every = tuple(dict.fromkeys((*scene.shared[first], *paths)))
                text = (
                    f"shared has {path!r} under {first!r} and under {name!r}, so that all of both "
                    "are one and the same number; put them under one name, as "
                    f"`|shared={{{first!r}: {every!r}}}|{first!r} = {list(every)!r}`"
                )
                reader.refuse(InputError(text, code="bad_combination", argument="shared"))
                break
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
        written = path if isinstance(path, str) else ""
        near = nearest(written, listed, _MOST_NEAR, 0.5) or listed[:_MOST_NEAR]
        instead = f"near it are {', '.join(near)}"
    return InputError(
        f"{argument} has no {rendered(path)}; {instead}", code="unknown_name", argument=argument
    )


def _meant(scene: Scene, path: Any) -> str:
    """What to write in place of an input that the scene would have, were it built otherwise."""
    found = _OF_MOVER.fullmatch(path) if isinstance(path, str) else None
    if not found or found[1] not in scene.movers or found[2] not in POLAR:
        return ""
    return (
        f"{found[1]} stands, and what stands has no {found[2]}. Build it with "
        "`Vehicle.from_speed(speed=..., course=...)`, with any speed above 0, or take "
        f"'{found[1]}.vx' and '{found[1]}.vy'"
    )


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
        for one in changed_by(scene, path):
            if one in spread:
                raise InputError(
                    f"{one} is changed twice, by {by[one]!r} and by {path!r}; change it by one",
                    code="bad_combination",
                    argument="changes",
                )
            spread[one], by[one] = value, path
    arguments = arguments_of(scene)
    grouped: dict[tuple[str, ...], dict[str, Any]] = {}
    reader = ArgumentReader()
    for path, value in spread.items():
        owner, part = owner_of(scene, path)
        grouped.setdefault(owner, {})[part] = value
        # A normal may be a vector, which has none.
        if unit_required(path) and (unit := _unit(owner, part)) and not isinstance(value, tuple):
            reader.number(value, unit, path)
    reader.close()
    # What stays as it is are the scene's own numbers.
    with in_si():
        for owner, parts in grouped.items():
            _change(scene, arguments, owner, parts)
        return Scene(**arguments)


def changed_by(scene: Scene, path: str) -> tuple[str, ...]:
    """The paths of the numbers that change with one: all that are one and the same with it."""
    if path in scene.shared:
        return scene.shared[path]
    for paths in scene.shared.values():
        if path in paths:
            return paths
    return (path,)


# Each number has one way to be written, and none takes all memory to count up to.
AT = r"\[(0|[1-9][0-9]{0,3})\]"
_OF_CONTACT = re.compile(rf"contacts{AT}\.(\w+)(?:\[([01])\])?")
_AFTER = re.compile(rf"contacts{AT}\.tyres_after\.([^.\[\]]+)\.(\w+(?:\[[0-3]\])?)")
_OF_LIST = re.compile(rf"(surfaces|slope){AT}")
_OF_TYRES = re.compile(r"([^.\[\]]+)\.tyres\.(\w+(?:\[[0-3]\])?)")
_OF_MOVER = re.compile(r"([^.\[\]]+)\.(\w+)")


def owner_of(scene: Scene, path: str, argument: str = "scene") -> tuple[tuple[str, ...], str]:
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
        if name in scene.movers and part in (*_VEHICLE, *POLAR, "drag"):
            return ("mover", name), part
    raise no_path(path, inputs_of(scene), argument)


def units_of(scene: Scene, paths: Sequence[Any], argument: str = "scene") -> dict[str, str]:
    """The units of inputs, by what they are: also of one that has no value yet, as the height of
    tyres. Refused is what cannot be changed: what is none, and the speed of what stands.
    """
    found = {}
    for path in paths:
        if not isinstance(path, str):
            raise no_path(path, inputs_of(scene), argument)
        found[path] = _unit(*owner_of(scene, changed_by(scene, path)[0], argument))
    changed = {one for path in paths for one in changed_by(scene, path)}
    for name, mover in scene.movers.items():
        given = [part for part in POLAR if f"{name}.{part}" in changed]
        if len(given) == 1 and np.any(mover.vehicle.speed == 0.0):
            raise _no_course(name, given[0])
    return found


def _unit(owner: tuple[str, ...], part: str) -> str:
    """The unit of a part of a scene; "" where it has none."""
    kind = owner[0]
    if kind in ("tyres", "after"):
        return _TYRES[part]
    if kind == "contact":
        return "rad" if part == "normal" else OF_CONTACT[part.partition("[")[0]] or ""
    if kind == "mover":
        return "" if part == "drag" else POLAR.get(part) or _VEHICLE[part]
    return ""


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
    polar = {part: parts.pop(part) for part in POLAR if part in parts}
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
        raise _no_course(name, next(iter(polar)))
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


def _no_course(name: str, part: str) -> InputError:
    missing = "course" if part == "speed" else "speed"
    return InputError(
        f"{name} stands, so its {missing} is not known; write '{name}.vx' and '{name}.vy' in "
        f"place of '{name}.{part}', or build it with "
        "`Vehicle.from_speed(speed=..., course=...)`, with any speed above 0",
        code="missing_course",
        argument="speed",
    )


def case_of(scene: Scene, index: Any, of: str = "scene") -> Scene:
    """One case of a batch as a single scene; ``of`` is what a caller has."""
    shape = scene.shape
    place = index_of(index, shape, of)

    def take(value: Any) -> Any:
        return np.broadcast_to(value, shape or ())[place].item()

    with in_si():
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

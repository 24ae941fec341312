"""Records of scenes and runs: strict JSON, from which the scene is run again."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ..impact.records import (
    as_written,
    read_strict,
    to_record,
    tyres_of,
    tyres_record,
    vehicle_of_record,
    vehicle_record,
)
from ..messages.errors import InputError
from ..messages.warning import quietly
from ..quantities.attributes import equal
from ..quantities.directions import direction
from ..quantities.reading import ArgumentReader
from ..quantities.settings import in_si
from ..quantities.strict_json import strict
from ..quantities.units import shown
from ..vehicle.drag import read_drag
from .contact import NAMES, UNITS, Contact
from .mover import Mover
from .scene import Scene, arguments_of

if TYPE_CHECKING:
    from .run import Run

SCENE, RUN = "collisions scene 1", "collisions run 1"


def scene_record(scene: Scene) -> dict[str, Any]:
    """A record of a scene: each number as the text it was given as if it still reads as that
    number, or else in SI.
    """
    arguments = arguments_of(scene)
    return {
        "format": SCENE,
        "movers": [
            {
                "name": name,
                "vehicle": vehicle_record(mover.vehicle),
                "outline": None if mover.outline is None else mover.outline.tolist(),
                "tyres": tyres_record(mover.tyres),
                "drag": _drag_record(mover),
            }
            for name, mover in scene.movers.items()
        ],
        "contacts": [_contact_record(contact) for contact in scene.contacts],
        "surfaces": [
            {
                "corners": [list(corner) for corner in corners],
                "friction": as_written(text, friction, ""),
            }
            for (_, text), (corners, friction) in zip(
                arguments["surfaces"], scene.surfaces, strict=True
            )
        ],
        "slope": [
            as_written(text, part, "")
            for text, part in zip(arguments["slope"], scene.slope, strict=True)
        ],
        "order": None if scene.order is None else [list(pair) for pair in scene.order],
        "shared": {name: list(paths) for name, paths in scene.shared.items()},
    }


def _drag_record(mover: Mover) -> Any:
    """The text that a drag was given as if it still reads as that number, or else the number."""
    text = mover.as_given("drag")
    if isinstance(text, str) and isinstance(mover.drag, float):
        with quietly([]):
            if read_drag(ArgumentReader(), text, "drag") == mover.drag:
                return text
    return strict(mover.drag)


def _contact_record(contact: Contact) -> dict[str, Any]:
    found = {name: strict(getattr(contact, name)) for name in NAMES if name != "tyres_after"}
    for name, unit in UNITS.items():
        text, value = contact.as_given(name), getattr(contact, name)
        if name == "normal":
            as_text = isinstance(text, str) and equal(
                direction(ArgumentReader(), text, name), contact.normal
            )
            found[name] = text if as_text else strict(value)
        elif isinstance(value, tuple):
            found[name] = [
                as_written(part, one, unit) for part, one in zip(text, value, strict=True)
            ]
        else:
            found[name] = as_written(text, value, unit)
    found["tyres_after"] = {
        name: tyres_record(tyres) for name, tyres in contact.tyres_after.items()
    }
    return found


def scene_of(record: Any) -> Scene:
    """The scene of a record, validated like a caller's."""
    try:
        if record["format"] != SCENE:
            raise _bad_record(f"its format is {shown(record['format'])} and not {SCENE!r}", "Scene")
        movers = {}
        with in_si():
            for found in record["movers"]:
                if found["name"] in movers:
                    raise _bad_record(f"it has {shown(found['name'])} twice", "Scene")
                outline = found["outline"]
                corners = None if outline is None else [tuple(corner) for corner in outline]
                vehicle = vehicle_of_record(found["vehicle"])
                movers[found["name"]] = Mover(
                    vehicle,
                    outline=corners,
                    tyres=tyres_of(found["tyres"]),
                    drag=read_strict(found["drag"]),
                )
            contacts = [_contact_of(found) for found in record["contacts"]]
            surfaces = [
                ([tuple(corner) for corner in area["corners"]], read_strict(area["friction"]))
                for area in record["surfaces"]
            ]
            order = record["order"]
            return Scene(
                movers=movers,
                contacts=contacts,
                surfaces=surfaces,
                slope=read_strict(record["slope"]),
                order=None if order is None else [tuple(pair) for pair in order],
                shared={name: tuple(paths) for name, paths in record["shared"].items()},
            )
    except InputError:
        raise
    except Exception as error:
        raise _bad_record(f"{type(error).__name__} {error}", "Scene") from error


def _contact_of(found: Mapping[str, Any]) -> Contact:
    if found.keys() != set(NAMES):
        raise _bad_record(f"a contact has {', '.join(NAMES)}", "Scene")
    values = {name: read_strict(found[name]) for name in NAMES if name != "tyres_after"}
    after: Any = {name: tyres_of(tyres) for name, tyres in found["tyres_after"].items()}
    return Contact(**values, tyres_after=after)


def run_record(run: Run) -> dict[str, Any]:
    """A record of a run: its scene, and what came of it, in SI."""
    single = run._followed.single
    found: dict[str, Any] = {
        "format": RUN,
        "scene": scene_record(run.scene),
        "tolerance": run.tolerance,
        "status": run.status if single else run.status.tolist(),
        "times": strict(run.times),
        "columns": run.to_columns(),
    }
    if single:
        found["impacts"] = [
            {"contact": rule, "a": pair[0], "b": pair[1], **to_record(impact)}
            for rule, pair, impact in zip(run.rules, run.pairs, run.impacts, strict=True)
        ]
        found["findings"] = [notice._asdict() for notice in run.findings]
    record: dict[str, Any] = strict(found)
    return record


def run_of(record: Any) -> Run:
    """The run of a record, run again from its scene."""
    try:
        if record["format"] != RUN:
            raise _bad_record(f"its format is {shown(record['format'])} and not {RUN!r}", "Run")
        scene, tolerance = record["scene"], record["tolerance"]
    except InputError:
        raise
    except Exception as error:
        raise _bad_record(f"{type(error).__name__} {error}", "Run") from error
    return scene_of(scene).run(tolerance=tolerance)


def _bad_record(why: str, kind: str) -> InputError:
    return InputError(
        f"record is not what {kind}.to_dict() gives: {why}", code="bad_record", argument="record"
    )

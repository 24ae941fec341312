"""The case of a whole crash: what [[mover]], [[contact]], [[surface]] and [scene] of a file say, as
the call of a ``Scene``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..scene import Contact, Mover, Scene
from ..scene.run import Run
from ..scene.scene import TOLERANCE
from ..vehicle.tyres import Tyres
from .words import as_in_file

if TYPE_CHECKING:
    from .read import Call, Reader

SCENE = "scene"
LISTS = ("mover", "contact", "surface")
"""Tables of which a file may have several, each in double brackets."""
TABLES = (*LISTS, SCENE)
FROM_TABLES = ("movers", "contacts", "surfaces")
"""The arguments of ``Scene`` that these tables are."""
OF_MOVERS = ("name", "pivot")
# Of a vehicle: its name is that of its mover, and a scene cannot hold a pivot.
_NOT_OF_MOVERS = ("name", "pivot")
OF_MOVER = ("name", "outline", "tyres", "drag")
OF_SURFACE = ("corners", "friction")
OF_SCENE = ("slope", "order", "shared", "tolerance")
_SURFACE = 'corners = [["20 m", "-5 m"], ...] and friction = 0.3'


def run(scene: Scene, tolerance: float = TOLERANCE) -> Run:
    """A scene as it goes."""
    return scene.run(tolerance=tolerance)


def read_crash(reader: Reader) -> Call:
    """The call of ``run`` with the scene of a document."""
    movers: dict[str, Any] = {}
    for at, table in enumerate(_listed(reader, "mover")):
        name = table.get("name")
        if not isinstance(name, str) or not name:
            reader.refuse(
                f"mover[{at}].name",
                f"must be a text in quotes, got {as_in_file(name)}"
                if "name" in table
                else 'is missing; give the vehicle a name of its own, such as name = "Camry"',
            )
        elif name in movers:
            reader.refuse(
                f"mover[{at}].name",
                f"is {as_in_file(name)}, as that of another mover; give each a name of its own",
            )
        else:
            movers[name] = _mover(reader, name, table)
    if not movers:
        reader.refuse("", "has no vehicle; write [[mover]] with its name, mass and speed")
    contacts = tuple(
        _contact(reader, at, table) for at, table in enumerate(_listed(reader, "contact"))
    )
    surfaces = tuple(
        _surface(reader, at, table) for at, table in enumerate(_listed(reader, "surface"))
    )
    given = reader.table(SCENE)
    reader.known(given, SCENE, OF_SCENE)
    beside: dict[str, Any] = {"movers": movers, "contacts": contacts, "surfaces": surfaces}
    # As they stand in the file; what is wrong with them the scene says.
    beside |= {name: given[name] for name in ("order", "shared") if name in given}
    inside = {name: value for name, value in given.items() if name == "slope"}
    whole = reader.call(SCENE, Scene, inside, beside)
    _share(reader, given.get("shared"))
    options = {"tolerance": given["tolerance"]} if "tolerance" in given else {}
    return reader.call(SCENE, run, options, {"scene": whole})


def _listed(reader: Reader, name: str) -> list[dict[str, Any]]:
    """The tables in double brackets of one name."""
    found = reader.document.get(name, ())
    if isinstance(found, tuple) and all(isinstance(one, dict) for one in found):
        return list(found)
    reader.refuse(
        name,
        f"must be tables, one for each, got {as_in_file(found)}; write [[{name}]] on a line of "
        "its own, and its keys below",
    )
    return []


def _mover(reader: Reader, name: str, table: dict[str, Any]) -> Call:
    """The call of a mover, whose table has the keys of its vehicle too."""
    keys = [key for key in reader.of_vehicles if key not in _NOT_OF_MOVERS]
    reader.known(table, name, [*OF_MOVER, *keys])
    body = reader.moving(name, {key: value for key, value in table.items() if key in keys})
    beside: dict[str, Any] = {"vehicle": body}
    inside = {key: table[key] for key in ("outline", "tyres", "drag") if key in table}
    return reader.call(name, Mover, inside, beside)


def _contact(reader: Reader, at: int, table: dict[str, Any]) -> Call:
    """The call of a contact, which is called by its place in the file, counted from 0."""
    place = f"contacts[{at}]"
    beside = {}
    if "tyres_after" in table:
        given = table["tyres_after"]
        if not isinstance(given, dict):
            reader.refuse(
                f"{place}.tyres_after",
                f"must be a table by vehicle, got {as_in_file(given)}; write for example "
                "[contact.tyres_after.Civic], and the keys of its tyres below",
            )
            given = {}
        beside["tyres_after"] = {
            name: reader.call(f"{place}.tyres_after.{name}", Tyres, tyres)
            for name, tyres in given.items()
        }
    inside = {key: value for key, value in table.items() if key != "tyres_after"}
    return reader.call(place, Contact, inside, beside)


def _surface(reader: Reader, at: int, table: dict[str, Any]) -> tuple[Any, Any]:
    """Corners and friction; as a path has it, the place of an area is that of its friction."""
    place = f"surfaces[{at}]"
    reader.known(table, place, OF_SURFACE)
    for name in OF_SURFACE:
        if name not in table:
            reader.refuse(f"{place}.{name}", f"is missing; write {_SURFACE}")
    friction = table.get("friction")
    if friction is not None:
        friction = reader.value(place, friction, "Input")
    return table.get("corners", ()), friction


def _share(reader: Reader, shared: Any) -> None:
    """Make one number of those that a scene shares: what is stated of each has to be the same."""
    for name, paths in shared.items() if isinstance(shared, dict) else ():
        if not isinstance(paths, tuple) or not all(isinstance(path, str) for path in paths):
            continue
        stated = {path: reader.uncertain[path] for path in paths if path in reader.uncertain}
        if not stated:
            continue
        said = {str(one.stated) for one in stated.values()}
        without = [path for path in paths if path not in stated]
        if without or len(said) > 1:
            reader.refuse(
                f"{SCENE}.shared.{name}",
                f"says that {', '.join(paths)} are one and the same, and the file does not "
                "state the same of each"
                + (f" (nothing uncertain of {', '.join(without)})" if without else "")
                + "; write the same text at each of these paths",
            )
            continue
        first = next(iter(stated.values()))
        for path in paths:
            del reader.uncertain[path]
        reader.uncertain[name] = first.named(name)

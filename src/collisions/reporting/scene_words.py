"""The inputs and results of a scene in words, in place of their paths."""

from __future__ import annotations

import math
import re

from ..derivation.explain import IMPACT_ANSWERS, OF_VEHICLE
from ..derivation.wheels import OF_WHEELS
from ..kernels.contact_laws import RULES
from ..scene.names import AT
from ..scene.results import OfImpact, asked_of, between
from ..scene.run import Run
from ..scene.scene import Scene

_MOTION = {
    "speed": "speed",
    "course": "course",
    **{name: what for name, (what, _) in OF_VEHICLE.items() if name not in ("mass", "yaw_inertia")},
}
_SLOPES = {"slope": "x, y", "slope[0]": "x", "slope[1]": "y"}
_AT_REST = {"x": "position x", "y": "position y", "heading": "heading"}
_OF_CONTACT = {
    "restitution": "restitution",
    "friction": "friction",
    "normal": "normal",
    "point": "point",
    "point[0]": "x of the point",
    "point[1]": "y of the point",
    "at": "time",
    "depth": "depth of the overlap",
    "delay": "delay after first touch",
    "duration": "duration",
    "tolerance": "tolerance",
}
_MOMENTS = {
    "before": "before",
    "after": "after",
    "at_compression": "at the end of compression",
}
_SIDES = {"a": 0, "b": 1}
_CONTACT = re.compile(rf"contacts{AT}\.(?:tyres_after\.([^.]+)\.)?(.+)")
_AREA = re.compile(rf"surfaces{AT}")
_REST = re.compile(r"(.+)\.rest\.(x|y|heading)")
_MARK = re.compile(r"(.+)\.marks\.(\w+)\.(begin|end|distance)\.?(.+)")


def input_in_words(scene: Scene, path: str) -> str:
    """An input of a scene, or the pair that two are of; a name that several share as it was
    given.
    """
    if path in scene.shared:
        return path
    if path in _SLOPES:
        return f"slope of the ground along {_SLOPES[path]}"
    if found := _AREA.fullmatch(path):
        return f"friction of surface {int(found[1]) + 1}"
    if found := _CONTACT.fullmatch(path):
        where = contact_in_words(scene, int(found[1]))
        if found[2]:
            return f"{_of(found[2], OF_WHEELS[found[3]][0])}, after {where}"
        what = _OF_CONTACT.get(found[3]) or RULES[found[3]].meaning
        return f"{what} of {where}"
    name, _, part = path.partition(".")
    if part.startswith("tyres."):
        return _of(name, OF_WHEELS[part.removeprefix("tyres.")][0])
    if part in _MOTION:
        return f"{_of(name, _MOTION[part])} at the start"
    return f"drag factor of {name}" if part == "drag" else _of(name, OF_VEHICLE[part][0])


def result_in_words(run: Run, path: str) -> str:
    """A result of a run; the vehicles of an impact are those that it has in this run."""
    if path == "end":
        return "time until all rest"
    if found := _REST.fullmatch(path):
        return f"{_AT_REST[found[2]]} of {found[1]} at rest"
    if found := _MARK.fullmatch(path):
        name, wheel, what, rest = found.groups()
        mark = f"the mark of the {wheel.replace('_', ' ')} wheel of {name}"
        return (
            f"distance of {rest} from {mark}"
            if what == "distance"
            else f"{rest} of the {what} of {mark}"
        )
    if times := between(run.scene, path):
        later, sooner = (_moment(run, one) for one in times)
        return f"time between {sooner} and {later}"
    asked = asked_of(run.scene, path)
    return path if asked is None else _asked(run, asked)


def _asked(run: Run, asked: OfImpact) -> str:
    """A number of an impact, its vehicle by name."""
    where = _first(run, asked.number) if asked.contact else _impact(run, asked.number)
    if not asked.name:
        return f"time of {where}"
    row = IMPACT_ANSWERS.get(asked.name)
    label, dot, inner = asked.name.partition(".")
    what = _plain(inner if dot else label) if row is None else row[1]
    if not math.isnan(asked.share):
        what = "EES"
    if asked.sample is not None:
        what = IMPACT_ANSWERS[f"{asked.sample.label}.delta_v_{asked.sample.part}"][1]
    if not dot:
        return f"{what} of {where}"
    contact = run.scene.contacts[asked.number] if asked.contact else None
    pair = (contact.a, contact.b) if contact is not None else _pair(run, asked.number)
    whose = _of(pair[_SIDES[label]], what)
    if not math.isnan(asked.share):
        whose += f" with {asked.share:.3g} of the energy lost"
    if asked.sample is not None:
        whose += (
            f" after {1e3 * asked.sample.time:.4g} ms, recorded {asked.sample.forward:.4g} m ahead "
            f"of its centre of mass and {asked.sample.left:.4g} m to its left"
        )
    return f"{whose}, {where if asked.contact else _numbered(run, asked.number)}"


def _first(run: Run, number: int) -> str:
    return f"the first impact in {contact_in_words(run.scene, number)}"


def _moment(run: Run, path: str) -> str:
    """A moment of a run in words."""
    asked = asked_of(run.scene, path)
    if asked is None:
        return "the moment at which all rest"
    return _first(run, asked.number) if asked.contact else _impact(run, asked.number)


def about(what: str, letter: str) -> str:
    """Something of a vehicle: "course before" is "course of A before"."""
    lead, space, when = what.rpartition(" ")
    return (
        f"{lead} of {letter} {when}"
        if space and when in ("before", "after")
        else (f"{what} of {letter}")
    )


def _of(name: str, what: str) -> str:
    """The same, and of longer words such as "Camry: steer angle of the front wheels"."""
    return f"{name}: {what}" if re.search(r" of |[,(]", what) else about(what, name)


def _plain(inner: str) -> str:
    """A result that no table has, such as "after.x", by the words of its name."""
    moment, dot, part = inner.rpartition(".")
    if dot and moment in _MOMENTS and part in _MOTION:
        return f"{_MOTION[part]} {_MOMENTS[moment]}"
    return inner.replace("_", " ").replace(".", " ")


def contact_in_words(scene: Scene, number: int) -> str:
    """A contact by its vehicles, and by its time where it is not the only one of the two."""
    contact = scene.contacts[number]
    pair = {contact.a, contact.b}
    alone = sum({other.a, other.b} == pair for other in scene.contacts) == 1
    when = " at each touch" if contact.touches else f" at {_seconds(contact.at)}"
    return f"the contact of {contact.a} and {contact.b}{'' if alone else when}"


def _seconds(time: object) -> str:
    return f"{time:.2f} s" if isinstance(time, float) else "its time"


def _pair(run: Run, number: int) -> tuple[str, str]:
    return run.pairs[number] if number < len(run.pairs) else ("A", "B")


def _numbered(run: Run, number: int) -> str:
    """An impact by its number and its time in this run, if it came."""
    time = f" ({run.times[number]:.2f} s)" if number < len(run.times) else ""
    return f"impact {number + 1}{time}"


def _impact(run: Run, number: int) -> str:
    one, other = _pair(run, number)
    return f"{_numbered(run, number)}, {one} and {other}"

"""What recorders show while a contact that is followed in time lasts, by paths such as
"contacts[0].impact.Civic.recorded(40 ms, 0.4 m, -0.3 m).forward".
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, NamedTuple

from ..impact.recorded import read_moment, read_place
from ..messages.errors import InputError, ShapeError
from ..quantities.reading import ArgumentReader
from .contact import IN_TIME

if TYPE_CHECKING:
    from .scene import Scene

PARTS = ("forward", "left")
_MODELS = (IN_TIME, "solve")
_RECORDED = re.compile(r"([ab])\.recorded(?:\(([^()]*)\))?(?:\.(\w+))?")
_LIKE = "recorded(40 ms, 0.4 m, -0.3 m)"


class Sample(NamedTuple):
    """A sample of the curve of a recorder: the vehicle "a" or "b", the time after first contact
    [s], where the recorder sits [m], and which part of delta-V.
    """

    label: str
    time: float
    forward: float
    left: float
    part: str


def sample_of(name: str, path: str, argument: str) -> Sample | None:
    """What a path asks for of a recorder, from what follows its impact; None for any other."""
    found = _RECORDED.fullmatch(name)
    if not found:
        return None
    label, inside, part = found.groups()
    stem = path[: path.rindex(".recorded")]
    if inside is None or not inside.strip():
        raise _unlike(path, argument, "without a time after first contact", f"{stem}.{_LIKE}")
    if part not in PARTS:
        at = path[: path.rindex(")") + 1]
        text = "of which it has the parts forward and left, positive to the left"
        raise _unlike(path, argument, text, at)
    given = [one.strip() for one in inside.split(",")]
    if len(given) not in (1, 3):
        raise ShapeError(
            f"{argument} has {path!r}, with {len(given)} numbers; write the time after first "
            "contact alone, or with how far ahead of the centre of mass the recorder sits and how "
            f"far to its left: '{stem}.{_LIKE}.{part}'",
            code="bad_shape",
            argument=argument,
        )
    reader = ArgumentReader()
    time = read_moment(reader, _number(given[0]), f"{path}: time")
    ahead, aside = (_number(one) for one in (given[1:] or ["0", "0"]))
    forward, left = read_place(reader, (ahead, aside), (f"{path}: forward", f"{path}: left"))
    reader.close()
    return Sample(label, float(time), float(forward), float(left), part)


def _number(text: str) -> Any:
    try:
        return float(text)
    except ValueError:
        return text


def _unlike(path: str, argument: str, what: str, stem: str) -> InputError:
    return InputError(
        f"{argument} has {path!r}, a curve over time {what}; write '{stem}.forward' or "
        f"'{stem}.left'",
        code="unknown_name",
        argument=argument,
    )


def check_lasts(scene: Scene, rule: int | None, path: str, argument: str) -> None:
    """Refuse a sample of a curve where no contact that it may be of is followed in time; of the
    contact of this number, or of any.
    """
    contacts = scene.contacts if rule is None else (scene.contacts[rule],)
    if not any(contact.model in _MODELS for contact in contacts):
        whose = "no contact of this scene is" if rule is None else f"contacts[{rule}] is not"
        raise no_curve(f"{path}: {whose} followed in time", path, argument)


def no_curve(why: str, path: str, argument: str) -> InputError:
    """The error for a curve of an impulse."""
    stem, part = path[: path.rindex(".recorded")], path[path.rindex(".") + 1 :]
    return InputError(
        f"{why}, and an impulse takes no time, so that it has no curve of delta-V; write "
        "`duration=`, such as '100 ms', in its `|Contact|[[contact]]`, or take all of delta-V, "
        f"'{stem}.delta_v_{part}'",
        code="no_pulse",
        argument=argument,
    )

"""What a reverse solver was told: in words, its kind, and the answer that must come out at it again."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from ..directions import course
from ..formatting import SI_UNITS
from ..impact import Impact
from ..reading import ArgumentReader
from .blocks import Sheet

_MOTION = {
    "vx": ("velocity along x", "speed"),
    "vy": ("velocity along y", "speed"),
    "speed": ("speed", "speed"),
    "course": ("course", "angle"),
    "yaw_rate": ("yaw rate", "yaw rate"),
}
# By argument: words, kind, and the path of the attribute; without one where no answer has the number.
_KNOWN: dict[str, tuple[str, str, str | None]] = {
    "energy_loss": ("energy lost", "energy", "energy_loss"),
    "closing_speed": ("closing speed", "speed", "closing_speed"),
}
for _label in "ab":
    _of = f" of {_label.upper()}"
    _KNOWN |= {
        f"{_label}_after.{_name}": (f"{_what}{_of} after", _kind, f"{_label}.after.{_name}")
        for _name, (_what, _kind) in _MOTION.items()
    }
    _KNOWN |= {
        f"v{_label}": (f"velocity{_of} before", "speed", f"{_label}.before.vx"),
        f"v{_label}_after": (f"velocity{_of} after", "speed", f"{_label}.after.vx"),
        f"speed_{_label}": (f"speed{_of} before", "speed", f"{_label}.before.speed"),
        f"course_{_label}": (f"course{_of} before", "angle", f"{_label}.before.course"),
        f"delta_v_{_label}": (f"delta-V{_of}", "speed", f"{_label}.delta_v"),
        f"ees_{_label}": (f"EES{_of}", "speed", None),
    }
# A solver that runs backwards comes out at what it was told within this, relative to the speeds or energies of the impact;
# end states that still approach by up to a hundredth of the closing speed are taken to stay together.
_SAME = 1e-6
_TOGETHER = 0.02


def knowns(sheet: Sheet, impact: Impact) -> list[tuple[str, str, str]]:
    """The texts that a reverse solver was told, as rows of a table."""
    return [
        ("known", _KNOWN[name][0], sheet.as_given(_read(text, name), _KNOWN[name][1], text)) for name, text in _texts(impact)
    ]


def unlike(impact: Impact) -> Iterator[str]:
    """Texts that are of no number that could be known, or of another than the impact has."""
    for name, text in _texts(impact, every=True):
        if name not in _KNOWN or impact.reconstruction is None:
            yield f"it has no {name!r} that could have been given"
            continue
        words, kind, path = _KNOWN[name]
        read = _read(text, name)
        if path is None or read is None:
            continue
        number: Any = impact
        for part in path.split("."):
            number = getattr(number, part)
        # Of a speed that came out backwards the course is the opposite one; somebody at rest has none.
        apart = math.remainder(read - number, math.pi) if kind == "angle" else read - number
        if not math.isnan(number) and not abs(apart) <= _allowed(impact, kind):
            yield f"{name} was given as {text!r}, but the {words} is {number!r} {SI_UNITS[kind]}"


def _texts(impact: Impact, every: bool = False) -> Iterator[tuple[str, str]]:
    """Of what was told beside the contact."""
    contact = ("restitution", "normal", "point[0]", "point[1]", impact.inputs.rule)
    given: Mapping[str, Any] = impact.inputs.given or {}
    return ((name, text) for name, text in given.items() if name not in contact and (every or name in _KNOWN))


def _read(text: str, name: str) -> float | None:
    """The number of a text; None where its unit is of another registry."""
    reader = ArgumentReader()
    kind = _KNOWN[name][1]
    number = float(course(reader, text, name).radians) if kind == "angle" else reader.number(text, SI_UNITS[kind], name)
    return None if reader.problems or not isinstance(number, float) else number


def _allowed(impact: Impact, kind: str) -> float:
    sides = (impact.a, impact.b)
    speeds = sum(vehicle.speed for side in sides for vehicle in (side.before, side.after)) + impact.closing_speed
    if kind == "energy":
        return _SAME * (abs(impact.energy_absorbed) + abs(impact.energy_loss))
    if kind == "yaw rate":
        return _SAME * sum(abs(side.before.yaw_rate) + abs(side.after.yaw_rate) for side in sides) + _TOGETHER
    if kind == "angle":
        return _SAME + (_TOGETHER if impact.restitution == 0.0 else 0.0)
    return float(_SAME * speeds + (_TOGETHER * impact.closing_speed if impact.restitution == 0.0 else 0.0))

"""The balance of momentum where one velocity is sought whole, its speed and its course: what the
other momenta leave.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..kernels.reverse import Term
from ..quantities.attributes import hypot

NEARLY_CANCELLING = (1.0 + math.cos(math.radians(10.0))) / math.sin(math.radians(10.0))
"""Above it, as at courses within 10 degrees of one line, small errors move the answer far."""


def sought_whole(terms: Mapping[str, Term]) -> str | None:
    """The one body of which neither speed nor course is given, where all other speeds are."""
    unknown = [name for name, term in terms.items() if term.speed is None]
    return unknown[0] if len(unknown) == 1 and terms[unknown[0]].course is None else None


class Whole:
    """One velocity from the balance of momentum."""

    def __init__(
        self, terms: Mapping[str, Term], name: str, pushes: Sequence[tuple[Any, Any]]
    ) -> None:
        self.name, self.course = name, name.replace("speed", "course")
        self._terms, self._wanted = terms, terms[name]
        self._moving = {name: term for name, term in terms.items() if term.course is not None}
        x: Any = sum(push for push, _ in pushes)
        y: Any = sum(push for _, push in pushes)
        size: Any = sum(hypot(*push) for push in pushes)
        for term in self._moving.values():
            c, s = term.course.direction
            momentum = term.mass * term.speed
            x, y = x + term.sign * momentum * c, y + term.sign * momentum * s
            size = size + abs(momentum)
        sign = -self._wanted.sign
        self.x, self.y = sign * x / self._wanted.mass, sign * y / self._wanted.mass
        self.speed = hypot(self.x, self.y)
        self.angle = np.arctan2(self.y, self.x)
        self.condition = np.divide(size, self._wanted.mass * self.speed)

    def sensitivity(self, outside: bool) -> dict[str, dict[str, Any]]:
        """Derivatives of the speed and of the course by every input, of which an impulse from
        outside may be one.
        """
        wanted = self._wanted
        scale = -wanted.sign / wanted.mass
        moved: dict[str, tuple[Any, Any]] = {}
        for side in "ab":
            x: Any = 0.0
            y: Any = 0.0
            for name, term in self._moving.items():
                if side == name[6] or (name == "speed_a_after" and len(self._terms) == 3):
                    c, s = term.course.direction
                    x, y = x + term.sign * term.speed * c, y + term.sign * term.speed * s
            own = side == self.name[6] or (self.name == "speed_a_after" and len(self._terms) == 3)
            share = 1.0 / wanted.mass if own else 0.0
            moved[f"mass_{side}"] = scale * x - share * self.x, scale * y - share * self.y
        for name, term in self._moving.items():
            c, s = term.course.direction
            by = scale * term.sign * term.mass
            moved[name] = by * c, by * s
            across = by * term.speed
            moved[name.replace("speed", "course")] = -across * s, across * c
        if outside:
            moved |= {
                "outside_impulse_x": (scale, 0.0 * scale),
                "outside_impulse_y": (0.0 * scale, scale),
            }
        c, s = np.cos(self.angle), np.sin(self.angle)
        return {
            self.name: {name: c * x + s * y + 0.0 for name, (x, y) in moved.items()},
            self.course: {
                name: np.divide(c * y - s * x, self.speed) + 0.0 for name, (x, y) in moved.items()
            },
        }

"""The letters of the derivation: one for each quantity, with the number that the result holds."""

from __future__ import annotations

import math
from typing import Any

from ..impact import Impact
from ..side import Side
from ..vehicle import Vehicle
from .expressions import Expression, Symbol

# At the start, at the end of compression, and after.
BEFORE, COMPRESSED, AFTER = "before", "at_compression", "after"
_STATES = {BEFORE: ("", ""), COMPRESSED: ("^0", "0"), AFTER: ("'", "'")}


def letter(latex: str, text: str, value: Any, kind: str) -> Symbol:
    """A symbol of any kind."""
    return Symbol(latex, text, float(value), kind)


class Body:
    """The letters of one vehicle in an impact."""

    def __init__(self, impact: Impact, label: str) -> None:
        self.impact, self.label = impact, label
        self.side: Side = impact.a if label == "A" else impact.b
        self.start: Vehicle = self.side.before
        self.sign = -1.0 if label == "A" else 1.0

    @property
    def fixed(self) -> bool:
        """Whether no impulse moves it."""
        return math.isinf(self.start.mass)

    @property
    def turns(self) -> bool:
        """Whether an impulse can turn it."""
        return self.start.yaw_inertia is not None and math.isfinite(self.start.yaw_inertia)

    @property
    def mass(self) -> Symbol:
        """Its mass."""
        return letter(rf"m_{self.label}", f"m_{self.label}", self.start.mass, "mass")

    @property
    def inertia(self) -> Symbol:
        """Its yaw inertia about the centre of mass."""
        value = 0.0 if self.start.yaw_inertia is None else self.start.yaw_inertia
        return letter(rf"\bar{{I}}_{self.label}", f"I_{self.label}", value, "inertia")

    def state(self, when: str) -> Vehicle:
        """Its motion."""
        found: Vehicle = getattr(self.side, when)
        return found

    def arm(self, axis: str) -> Symbol:
        """From the pivot of a pinned body to its centre of mass, along a scene axis."""
        pivot, start = self.start.pivot or (0.0, 0.0), self.start
        place = (start.x, pivot[0]) if axis == "x" else (start.y, pivot[1])
        value = math.nan if place[0] is None else place[0] - place[1]
        return letter(rf"d_{{{self.label}{axis}}}", f"d_{self.label}{axis}", value, "length")

    def along(self, direction: str, when: str = BEFORE, contact: bool = False) -> Symbol:
        """Component "x", "y", "n" or "t" of the velocity of its centre of mass, or of the place at the contact."""
        state = self.state(when)
        point = self.impact.point
        vx, vy = state.velocity_at(point) if contact and point is not None else (state.vx, state.vy)
        nx, ny = self.impact.normal
        value = {"x": vx, "y": vy, "n": nx * vx + ny * vy, "t": nx * vy - ny * vx}[direction]
        mark = "'" if when == AFTER else ""
        if contact:
            # The paper has u with and without a bar; without bars the place at the contact needs another letter.
            base, text = ("u", "c0") if when == COMPRESSED else ("c", f"c{mark}")
            return letter(rf"{base}_{{{self.label}{direction}}}{mark}", f"{text}_{self.label}{direction}", value, "speed")
        base = "u" if when == COMPRESSED else "v"
        bar = rf"\bar{{{base}}}" if self.impact.model == "eccentric" else base
        return letter(rf"{bar}_{{{self.label}{direction}}}{mark}", f"{base}{mark}_{self.label}{direction}", value, "speed")

    def straight(self, when: str = BEFORE) -> Symbol:
        """Velocity along the line of a linear impact, which needs no component in its letter."""
        found = self.along("n", when)
        mark = "'" if when == AFTER else ""
        return letter(rf"v_{self.label}{mark}", f"v{mark}_{self.label}", found.value, "speed")

    def axis(self, name: str, when: str = BEFORE) -> Symbol:
        """Velocity of its centre of mass along a scene axis, by the letter that the derivation has for it."""
        lined = self.impact.model == "linear_central" and self.impact.normal == (1.0, 0.0) and name == "x"
        return self.straight(when) if lined else self.along(name, when)

    def spin(self, when: str = BEFORE) -> Symbol:
        """Yaw rate."""
        latex, text = _STATES[when]
        return letter(rf"\omega_{self.label}{latex}", f"w{text}_{self.label}", self.state(when).yaw_rate, "yaw rate")


class Contact:
    """The letters of the contact."""

    def __init__(self, impact: Impact) -> None:
        self.impact = impact
        self.e = letter("e", "e", impact.restitution, "number")
        self.closing = letter("g", "g", impact.closing_speed, "speed")
        self.slip = letter("s", "s", impact.slip_before, "speed")
        self.slip_after = letter("s'", "s'", impact.slip_after, "speed")
        self.mass = letter("m_e", "m_e", impact.effective_mass, "mass")
        self.normal = letter("P_n", "P_n", impact.normal_impulse, "impulse")
        self.tangential = letter("P_t", "P_t", impact.tangential_impulse, "impulse")
        self.compression = letter(r"\int P\,dt", "int_P_dt", impact.compression_impulse, "impulse")
        self.restitution = letter(r"\int R\,dt", "int_R_dt", impact.restitution_impulse, "impulse")
        self.ratio = letter(r"\mu_P", "mu_P", impact.impulse_ratio, "number")
        self.critical = letter(r"\mu_c", "mu_c", impact.critical_impulse_ratio, "number")
        self.loss = letter(r"\Delta E", "dE", impact.energy_loss, "energy")
        self.loss_n = letter(r"\Delta E_n", "dE_n", impact.energy_loss_normal, "energy")
        self.loss_t = letter(r"\Delta E_t", "dE_t", impact.energy_loss_tangential, "energy")
        self.nx, self.ny = (
            letter(f"n_{axis}", f"n_{axis}", part, "number") for axis, part in zip("xy", impact.normal, strict=True)
        )

    def dot(self, x: Expression, y: Expression) -> Expression:
        """The component of a vector along the normal."""
        return _weighed((self.nx, x, 1.0), (self.ny, y, 1.0))

    def cross(self, x: Expression, y: Expression) -> Expression:
        """The component of a vector along the tangent."""
        return _weighed((self.nx, y, 1.0), (self.ny, x, -1.0))

    def scene(self, axis: str, n: Expression, t: Expression) -> Expression:
        """The component along a scene axis of a vector that is known along the normal and the tangent."""
        return (
            _weighed((self.nx, n, 1.0), (self.ny, t, -1.0)) if axis == "x" else _weighed((self.ny, n, 1.0), (self.nx, t, 1.0))
        )

    def impulse(self, axis: str) -> Symbol:
        """Component of the impulse on B in scene axes."""
        value = self.impact.b.impulse_x if axis == "x" else self.impact.b.impulse_y
        return letter(f"P_{axis}", f"P_{axis}", value, "impulse")


def _weighed(*terms: tuple[Symbol, Expression, float]) -> Expression:
    """A sum of parts of a vector, without those that the direction leaves out and without factors of 1."""
    found: Expression | None = None
    for weight, part, sign in terms:
        if weight.value == 0.0:
            continue
        term = part if abs(weight.value) == 1.0 else weight * part
        way = sign * weight.value if abs(weight.value) == 1.0 else sign
        term = term if way > 0.0 or found is not None else -term
        found = term if found is None else found + term if way > 0.0 else found - term
    assert found is not None
    return found


def bodies(impact: Impact) -> tuple[Body, Body]:
    """The letters of A and of B."""
    return Body(impact, "A"), Body(impact, "B")

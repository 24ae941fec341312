"""``Symbols``: one symbol for each quantity of a derivation, with the result's number."""

from __future__ import annotations

import math
import re
from decimal import Decimal
from functools import cache, cached_property
from typing import Any

from ..impact.impact import Impact
from ..impact.inputs import PLACED
from ..impact.vehicle_result import VehicleResult
from ..kernels.contact_laws import BRACH, LAWS
from ..vehicle.vehicle import Vehicle
from .expressions import ATOM, SUM, ZERO, Expression, Pen, Written, signed_total

# At the start, at the end of compression, and after.
BEFORE, COMPRESSED, AFTER = "before", "at_compression", "after"
_PRIME = {BEFORE: "", COMPRESSED: "", AFTER: "'"}
# Plain text for LaTeX commands; every other command is written as its name.
_PLAIN = {
    r"\Delta ": "d",
    r"\omega": "w",
    r"\var": "",
    r"\lvert ": "|",
    r" \rvert": "|",
    r"\int ": "int_",
    r"\,": "_",
    "\\": "",
}


class Symbol(Expression):
    """A quantity with its symbol, its value in SI and its kind; the plain text of the symbol
    follows from its LaTeX.

    ``size`` is that of the largest terms the value was found from, where they are larger than
    itself.
    """

    def __init__(
        self, latex: str, value: Any, kind: str, text: str = "", size: float = 0.0
    ) -> None:
        self.latex, self.text, self.kind = latex, text or _plain_symbol(latex), kind
        super().__init__(float(value), max(abs(float(value)), size))

    def unless_zero(self) -> Expression:
        """The symbol, or ZERO, which is not written, if that is its value."""
        return self if self.value != 0.0 else ZERO

    def write(self, pen: Pen) -> Written:
        if pen.system is None:
            pen.named.append(self)
            return Written(self.latex if pen.latex else self.text, ATOM)
        printed = pen.system.working(self.value, self.kind, pen.more)
        rank = SUM if printed.startswith("-") else ATOM
        worth = Decimal(printed if math.isfinite(self.value) else self.value)
        if pen.marked and self.kind == "angle":
            printed += r"^\circ" if pen.latex else f" {pen.system.label(self.kind)}"
        return Written(printed, rank, worth, pen.system.unit_of(self.kind))


@cache
def _plain_symbol(latex: str) -> str:
    r"""A symbol in plain text: ``\bar{I}_A`` is I_A, ``v_{An}'`` is v'_An, ``\Delta v_A`` is dv_A,
    ``\omega_A^0`` is w0_A.
    """
    text = re.sub(r"\\(?:bar|mathrm)(?=\{)|[{}]", "", latex)
    for command, plain in _PLAIN.items():
        text = text.replace(command, plain)
    # The mark of the state stands before the index.
    return re.sub(r"_(\w+?)(?:\^(0)|('))", r"\2\3_\1", text).replace("^", "")


def delta_v(label: str, axis: str, value: Any) -> Symbol:
    """A component of delta-V, or its magnitude if no axis is named."""
    return Symbol(rf"\Delta v_{{{label}{axis}}}", value, "speed")


class Body:
    """The symbols of one vehicle in an impact."""

    def __init__(self, impact: Impact, label: str) -> None:
        self.impact, self.label = impact, label
        self.side: VehicleResult = impact.a if label == "A" else impact.b
        self.start: Vehicle = self.side.before
        # The impulse on A is the opposite of that on B.
        self.sign = -1.0 if label == "A" else 1.0
        self.fixed = math.isinf(self.start.mass)
        self.pinned = self.start.pivot is not None
        self.mass = Symbol(f"m_{label}", self.start.mass, "mass")

    @property
    def outside(self) -> tuple[Any, Any, Any] | None:
        """The impulse on it from outside and of tyres, along x and y and about its centre of mass;
        None if there is none.
        """
        side = self.side
        parts = side.outside_x, side.outside_y, side.outside_yaw
        # A contact followed in time has the work of its tyres apart from that of impulses from
        # outside.
        if self.impact.pulse is None and self.impact.inputs.tyres:
            x, y, yaw = parts
            parts = x + side.tyre_impulse_x, y + side.tyre_impulse_y, yaw + side.tyre_moment
        return parts if any(parts) else None

    @property
    def whence(self) -> str:
        """Where the impulse of ``outside`` is from, in words."""
        side = self.side
        if self.impact.pulse is not None or self.label.lower() not in self.impact.inputs.tyres:
            return "impulse from outside"
        given = any((side.outside_x, side.outside_y, side.outside_yaw))
        return "impulse of the tyres and from outside" if given else "impulse of the tyres"

    def pushed(self, direction: str) -> Symbol:
        """Component "x", "y", "n" or "t" of the impulse from outside."""
        x, y, _ = self.outside or (0.0, 0.0, 0.0)
        nx, ny = self.impact.normal
        value = {"x": x, "y": y, "n": nx * x + ny * y, "t": nx * y - ny * x}[direction]
        return Symbol(rf"\mathrm{{J}}_{{{self.label}{direction}}}", value, "impulse")

    @property
    def inertia(self) -> Symbol:
        """Its yaw inertia about the centre of mass."""
        return Symbol(rf"\bar{{I}}_{self.label}", self.start.yaw_inertia or 0.0, "inertia")

    def state(self, when: str) -> Vehicle:
        """Its motion."""
        found: Vehicle = getattr(self.side, when)
        return found

    def arm(self, axis: str) -> Symbol:
        """The arm from the pivot of a pinned body to its centre of mass, along a scene axis."""
        pivot_x, pivot_y = self.start.pivot or (0.0, 0.0)
        center, pivot = (self.start.x, pivot_x) if axis == "x" else (self.start.y, pivot_y)
        return Symbol(
            rf"d_{{{self.label}{axis}}}", math.nan if center is None else center - pivot, "length"
        )

    def along(self, direction: str, when: str = BEFORE, contact: bool = False) -> Symbol:
        """Component "x", "y", "n" or "t" of the velocity of its centre of mass, or of the place at
        the contact.
        """
        state, point, index = self.state(when), self.impact.point, f"{self.label}{direction}"
        vx, vy = state.velocity_at(point) if contact and point is not None else (state.vx, state.vy)
        nx, ny = self.impact.normal
        value = {"x": vx, "y": vy, "n": nx * vx + ny * vy, "t": nx * vy - ny * vx}[direction]
        size, turning = self._largest
        size += turning * self._reach((self.start.x, self.start.y)) if contact else 0.0
        if contact and when == COMPRESSED:
            # The paper has u with and without a bar; without bars the place at the contact needs
            # another symbol.
            return Symbol(f"u_{{{index}}}", value, "speed", f"c0_{index}", size)
        if contact:
            return Symbol(f"c_{{{index}}}{_PRIME[when]}", value, "speed", size=size)
        base = "u" if when == COMPRESSED else "v"
        bar = rf"\bar{{{base}}}" if self.impact.model in PLACED else base
        return Symbol(f"{bar}_{{{index}}}{_PRIME[when]}", value, "speed", size=size)

    @cached_property
    def _largest(self) -> tuple[float, float]:
        """Speed and yaw rate of the largest terms that the motions were found from: the rounding
        left in them is of these.

        The two parts of an impulse may nearly cancel in the moment, so each counts.
        """
        impact, states = self.impact, (self.start, self.state(AFTER))
        impulse = abs(float(impact.normal_impulse)) + abs(float(impact.tangential_impulse))
        speed = max(math.hypot(state.vx, state.vy) for state in states) + impulse / self.start.mass
        turning = max(abs(state.yaw_rate) for state in states)
        inertia = self.start.yaw_inertia
        if impact.model in PLACED and inertia:
            turning += (
                impulse * self._reach(self.start.pivot or (self.start.x, self.start.y)) / inertia
            )
        return (
            speed if math.isfinite(speed) else 0.0,
            turning if math.isfinite(turning) else 0.0,
        )

    def _reach(self, center: tuple[Any, Any]) -> float:
        """Distance of the contact from a place of the body; 0 where one of them is not known."""
        point = self.impact.point
        return (
            0.0
            if point is None or center[0] is None
            else math.hypot(point[0] - center[0], point[1] - center[1])
        )

    def straight(self, when: str = BEFORE) -> Symbol:
        """Velocity along the line of a linear impact, which needs no component in its symbol."""
        along = self.along("n", when)
        return Symbol(f"v_{self.label}{_PRIME[when]}", along.value, "speed", size=along.size)

    def axis(self, name: str, when: str = BEFORE) -> Symbol:
        """Velocity of its centre of mass along a scene axis, by the symbol that the derivation has
        for it.
        """
        lined = (
            self.impact.model == "linear_central"
            and self.impact.normal == (1.0, 0.0)
            and name == "x"
        )
        return self.straight(when) if lined else self.along(name, when)

    def spin(self, when: str = BEFORE) -> Symbol:
        """Yaw rate."""
        mark = "^0" if when == COMPRESSED else _PRIME[when]
        _, size = self._largest
        return Symbol(
            rf"\omega_{self.label}{mark}", self.state(when).yaw_rate, "yaw rate", size=size
        )

    def spin_change(self) -> Symbol:
        """The change of its yaw rate."""
        _, size = self._largest
        value = self.side.delta_yaw_rate
        return Symbol(rf"\Delta \omega_{self.label}", value, "yaw rate", size=size)

    def delta_v(self, axis: str = "") -> Symbol:
        """A component of its delta-V in scene axes, or its magnitude if no axis is named."""
        return delta_v(self.label, axis, getattr(self.side, f"delta_v{axis}"))


class Symbols:
    """The symbols of an impact, of its contact and of both bodies; and the law of the contact."""

    def __init__(self, impact: Impact) -> None:
        self.impact, self.law = impact, LAWS[impact.law or BRACH]
        self.a, self.b = self.bodies = Body(impact, "A"), Body(impact, "B")
        self.e = Symbol("e", impact.restitution, "number")
        self.closing = Symbol("g", impact.closing_speed, "speed")
        self.separation = Symbol("r", impact.separation_speed, "speed")
        self.slip = Symbol("s", impact.slip_before, "speed")
        self.slip_after = Symbol("s'", impact.slip_after, "speed")
        self.mass = Symbol("m_e", impact.effective_mass, "mass")
        self.normal = Symbol("P_n", impact.normal_impulse, "impulse")
        self.tangential = Symbol("P_t", impact.tangential_impulse, "impulse")
        self.compression = Symbol(r"\int P\,dt", impact.compression_impulse, "impulse")
        self.restitution = Symbol(r"\int R\,dt", impact.restitution_impulse, "impulse")
        self.critical = Symbol(r"\mu_c", impact.critical_impulse_ratio, "number")
        self.ratio = Symbol(r"\mu_P", impact.impulse_ratio, "number")
        self.loss = Symbol(r"\Delta E", impact.energy_loss, "energy")
        self.loss_n = Symbol(r"\Delta E_n", impact.energy_loss_normal, "energy")
        self.absorbed = Symbol("E_c", impact.energy_absorbed, "energy")
        self.loss_t = Symbol(r"\Delta E_t", impact.energy_loss_tangential, "energy")
        self.nx, self.ny = (
            Symbol(f"n_{axis}", part, "number")
            for axis, part in zip("xy", impact.normal, strict=True)
        )

    def relative(self, direction: str, when: str = BEFORE, contact: bool = False) -> Expression:
        """Velocity of B relative to A, of the centres of mass or at the contact."""
        return self.b.along(direction, when, contact) - self.a.along(direction, when, contact)

    def dot(self, x: Expression, y: Expression) -> Expression:
        """The component of a vector along the normal."""
        return _weighed((1.0, self.nx, x), (1.0, self.ny, y))

    def cross(self, x: Expression, y: Expression) -> Expression:
        """The component of a vector along the tangent."""
        return _weighed((1.0, self.nx, y), (-1.0, self.ny, x))

    def scene(self, axis: str, n: Expression, t: Expression) -> Expression:
        """The component along a scene axis of a vector that is known along the normal and the
        tangent.
        """
        if axis == "x":
            return _weighed((1.0, self.nx, n), (-1.0, self.ny, t))
        return _weighed((1.0, self.ny, n), (1.0, self.nx, t))

    def impulse(self, axis: str) -> Symbol:
        """Component of the impulse on B in scene axes."""
        return Symbol(
            f"P_{axis}",
            self.impact.b.impulse_x if axis == "x" else self.impact.b.impulse_y,
            "impulse",
        )


def _weighed(*terms: tuple[float, Symbol, Expression]) -> Expression:
    """A linear combination of vector parts, without terms of factor 0 and without factors of 1."""
    return signed_total(
        (sign * weight.value, part) if abs(weight.value) == 1.0 else (sign, weight * part)
        for sign, weight, part in terms
        if weight.value != 0.0
    )

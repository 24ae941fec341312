"""One result over the tuple of the kernel, or a tree of frozen records?

    python design/one_result_object.py

An answer has some forty numbers, and a caller reads a few. ``Impact`` keeps the inputs and the
kernel's tuple, and works out the rest when it is read. The other way is a record for the impact
with two for the sides and six for the states, all filled at once, as one would write it with
dataclasses. Nothing is checked or derived in them here: only made.

What it showed (2 cores, Python 3.11): with an Impact around it 1.14 times the kernel, with the tree
5.1 times. So the tree costs four times the physics. Decided: one object, ``Derived`` attributes, a
cache for what was read.
"""

from dataclasses import dataclass
from typing import Any

from measuring import col, compare, speed

from collisions.impact.impact import build
from collisions.impact.inputs import Inputs
from collisions.kernels.eccentric import eccentric
from collisions.kernels.problem import Body, Contact, Problem

CONTACT = Contact(0.1, (1.0, 0.0), 0.5, (0.0, 0.0))
SETTINGS = ("friction", "brach")


@dataclass(frozen=True, slots=True, kw_only=True)
class State:
    """A body at one instant."""

    mass: float
    yaw_inertia: float
    vx: float
    vy: float
    yaw_rate: float
    x: float
    y: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Half:
    """One vehicle."""

    before: State
    after: State
    at_compression: State
    delta_vx: float
    delta_vy: float
    delta_yaw_rate: float
    impulse_x: float
    impulse_y: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Whole:
    """The impact."""

    a: Half
    b: Half
    status: int
    closing_speed: float
    slip_before: float
    slip_after: float
    normal_impulse: float
    tangential_impulse: float
    energy_loss: float


def body(numbers: dict[str, float]) -> Body:
    """A body as the kernel takes it."""
    return Body(yaw_rate=0.0, **numbers)


PROBLEM = Problem(CONTACT, *map(body, speed.BODIES))
A, B = (col.Vehicle(**numbers) for numbers in speed.BODIES)
CASE = Inputs("eccentric", A, B, 0.1, (1.0, 0.0), "friction", 0.5, "brach", (0.0, 0.0))


def kernel() -> tuple[Any, ...]:
    """The formula alone."""
    return eccentric(PROBLEM, *SETTINGS)


def one_object() -> Any:
    """With the inputs beside it."""
    return build(CASE, eccentric(PROBLEM, *SETTINGS))


def half(
    numbers: dict[str, float], ix: float, iy: float, dvx: float, dvy: float, turn: float
) -> Half:
    """A vehicle with its three states."""

    def state(share: float) -> State:
        return State(
            mass=numbers["mass"],
            yaw_inertia=numbers["yaw_inertia"],
            vx=numbers["vx"] + share * dvx,
            vy=numbers["vy"] + share * dvy,
            yaw_rate=share * turn,
            x=numbers["x"],
            y=numbers["y"],
        )

    return Half(
        before=state(0.0), after=state(1.0), at_compression=state(1.0 / 1.1),
        delta_vx=dvx, delta_vy=dvy, delta_yaw_rate=turn, impulse_x=ix, impulse_y=iy,
    )  # fmt: skip


def tree() -> Whole:
    """All records, filled at once."""
    raw = eccentric(PROBLEM, *SETTINGS)
    ix, iy = raw[15:17]
    return Whole(
        a=half(speed.BODIES[0], -ix, -iy, *raw[17:20]),
        b=half(speed.BODIES[1], ix, iy, *raw[20:23]),
        status=raw[0], closing_speed=raw[1], slip_before=raw[2], slip_after=raw[3],
        normal_impulse=raw[4], tangential_impulse=raw[5], energy_loss=raw[14],
    )  # fmt: skip


if __name__ == "__main__":
    print("of the kernel alone:")
    compare(
        {
            "kernel": kernel,
            "kernel, and one object over its tuple": one_object,
            "kernel, and a tree of records": tree,
        },
        "kernel",
    )

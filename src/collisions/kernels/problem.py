"""The problem that a kernel solves, by name: a contact, two bodies, and what comes from outside."""

from typing import Any, NamedTuple


class Contact(NamedTuple):
    """Restitution, unit normal from A into B, value of the tangential rule, and point.

    Here and in ``Body`` a field that a model does not take is None.
    """

    restitution: Any
    normal: tuple[Any, ...]
    rule_value: Any = None
    point: Any = None


class Body(NamedTuple):
    """A body just before the contact; one with a ``pivot`` can only turn about that point."""

    mass: Any
    yaw_inertia: Any
    vx: Any
    vy: Any
    yaw_rate: Any
    x: Any = None
    y: Any = None
    pivot: Any = None


class Problem(NamedTuple):
    """What a kernel is given.

    ``outside`` has the impulses on A and on B from other things than the contact: x, y, and yaw at
    the centre of mass. ``contact_velocity`` has the closing speed and the slip before to more
    digits than the motions hold; it is used where it is that of the motions to their rounding.
    """

    contact: Contact
    a: Body
    b: Body
    outside: tuple[tuple[Any, ...], tuple[Any, ...]] | None = None
    contact_velocity: tuple[Any, Any] | None = None

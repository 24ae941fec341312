"""eccentric: two bodies that also turn, struck anywhere, free, pinned or fixed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from .answering import answer
from .arguments import Law, OnFailure, read
from .errors import InputError, MissingInputError
from .impact import SOLVERS, SOLVERS_FROM_CONTACT, Asked, Impact
from .kernels.eccentric import eccentric as kernel
from .kernels.eccentric import from_contact_velocity
from .progress import Progress
from .units import Input, Pair, Value
from .vehicle import Vehicle, missing


def eccentric(
    a: Vehicle,
    b: Vehicle,
    restitution: Input,
    *,
    normal: Input | Pair,
    point: Pair,
    friction: Input | None = None,
    impulse_ratio: Input | None = None,
    critical_fraction: Input | None = None,
    law: Law = "brach",
    on_failure: OnFailure | None = None,
    threads: int = 1,
    progress: Progress | None = None,
) -> Impact:
    """Solve an eccentric impact: the line of impact misses a centre of mass, so the bodies turn.

    Impulse and momentum, linear and angular, of both bodies, with restitution between the velocities of the contact points
    along the normal (eqs 10 to 19 of "Application of Impulse Momentum Theory to Vehicle Collisions"), for free, pinned and
    fixed bodies, and with friction along the tangent. The contact is one point with one normal, the impact takes no time and
    no distance, and tyre forces during it are left out. Valid where the impulse of the contact is large against that of the
    tyres, and where the damage can be given a point and a normal.

    Parameters
    ----------
    a, b : Vehicle
        States just before contact. Each needs ``yaw_inertia``, ``x`` and ``y``, unless its mass and inertia are infinite.
    restitution : float, str, Quantity or array [-]
        Coefficient of restitution e along the normal at the contact, 0 to 1.
    normal : angle [rad] or tuple (nx, ny)
        Direction from A into B at the contact. An array is taken as angles.
    point : pair [m]
        Scene point (x, y) at which the impulse acts, at the moment of maximum engagement.
    friction : float, str, Quantity or array [-]
        Coulomb bound on the tangential over the normal impulse, >= 0; 0 is the paper's contact, ``inf`` never slips.
    impulse_ratio : float, str, Quantity or array [-]
        Tangential over normal impulse, signed: positive along the normal turned by +90 degrees, on B.
    critical_fraction : float, str, Quantity or array [-]
        Share, 0 to 1, of the ratio that just stops slip. Exactly one of these three must be given.
    law : {"brach", "kudlich-slibar"}, optional
        Whether a sticking contact is without slip at separation, or at the end of compression.
    on_failure, threads, progress
        As for ``linear_central``.

    Returns
    -------
    Impact
        Velocities, yaw rates, delta-V, impulse and energy; see its attributes.

    Raises
    ------
    InputError
        An argument that cannot be used.
    MissingInputError
        A position, a yaw inertia or the contact point was not given. Nothing is taken as zero.
    NoImpactError
        The contact points do not approach along the normal.
    NoSolutionError
        Nothing can yield, the ratio jams, or no slip would need the bodies to pull.

    Examples
    --------
    Example 3 of the paper: A, not turning, strikes B at one end; B turns about its other end O.

    >>> import collisions as col
    >>> a = col.Vehicle(mass=900, vx="60 km/h", yaw_inertia=float("inf"), x=-1.0, y=4.0)
    >>> b = col.Vehicle(mass=1000, yaw_inertia=1000 * 4**2 / 12, x=0.0, y=2.0, pivot=(0.0, 0.0))
    >>> impact = col.eccentric(a, b, 0.80, normal=0.0, point=(0.0, 4.0), friction=0.0)
    >>> round(impact.b.after.yaw_rate, 3), round(impact.a.after.vx, 3)
    (-5.473, 8.559)
    >>> round(impact.b.pivot_impulse_x, 1), round(impact.energy_loss)
    (3648.6, 12162)
    """
    e, n, rule, bound, contact, plain, given = read(
        a, b, restitution, normal, point, friction, impulse_ratio, critical_fraction, law, missing_numbers(a, b, point)
    )
    return answer(
        kernel,
        (e, *n, bound, *(contact or ()), *body_numbers(a, contact), *body_numbers(b, contact)),
        (rule, law, a.pivot is not None, b.pivot is not None),
        ("eccentric", a, b, e, n, rule, bound, law, contact, given),
        plain,
        None,
        on_failure,
        threads,
        progress,
    )


def missing_numbers(a: Any, b: Any, point: Any) -> Sequence[InputError]:
    """What the model needs and was not given; a fixed body that does not turn needs no position."""
    if point is not None and _is_complete(a) and _is_complete(b):
        return ()
    found: list[InputError] = []
    if point is None:
        found.append(
            MissingInputError(
                "point is None, and eccentric needs it; give the scene point (x, y) at which the impulse acts",
                code="missing_point",
                argument="point",
            )
        )
    bodies = {"a": a, "b": b}
    return found + [missing(bodies[label], name, "eccentric", label) for label, name in lacking(a, b)]


def lacking(a: Any, b: Any) -> list[tuple[str, str]]:
    """Vehicle and field of what the model needs and the vehicles do not have; a fixed body needs no position."""
    found: list[tuple[str, str]] = []
    for label, body in (("a", a), ("b", b)):
        if type(body) is not Vehicle or _is_complete(body):
            continue
        inertia = 0.0 if body.yaw_inertia is None else body.yaw_inertia
        # One by one: beside an array without a case, a plain number still says that the body moves.
        fixed = np.all(np.isinf(body.mass)) and np.all(np.isinf(inertia)) and np.all(np.equal(body.yaw_rate, 0.0))
        needed = ("yaw_inertia",) if fixed else ("yaw_inertia", "x", "y")
        found += [(label, name) for name in needed if getattr(body, name) is None]
    return found


def _is_complete(body: Any) -> bool:
    return type(body) is Vehicle and body.yaw_inertia is not None and body.x is not None and body.y is not None


def body_numbers(vehicle: Vehicle, contact: Any) -> tuple[Any, ...]:
    """The numbers of one body; one without a position has no lever that matters."""
    x, y = vehicle.x, vehicle.y
    if x is None or y is None:
        x, y = contact
    pivot_x, pivot_y = vehicle.pivot or (0.0, 0.0)
    return vehicle.mass, vehicle.yaw_inertia, vehicle.vx, vehicle.vy, vehicle.yaw_rate, x, y, pivot_x, pivot_y


def _from_contact(asked: Asked, contact_velocity: tuple[Value, Value], on_failure: OnFailure | None = None) -> Impact:
    """``eccentric`` with a closing speed and a slip before of more digits than the motions before hold."""
    a, b, contact = asked.a, asked.b, asked.point
    numbers = *body_numbers(a, contact), *body_numbers(b, contact)
    return answer(
        from_contact_velocity,
        (*contact_velocity, asked.restitution, *asked.normal, asked.bound, *(contact or ()), *numbers),
        (asked.rule, asked.law, a.pivot is not None, b.pivot is not None),
        tuple(asked),
        False,
        None,
        on_failure,
        1,
        None,
    )


SOLVERS["eccentric"] = eccentric
SOLVERS_FROM_CONTACT["eccentric"] = _from_contact

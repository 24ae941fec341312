"""oblique_central: two bodies that do not turn, struck at an angle."""

from __future__ import annotations

from .answering import answer
from .arguments import Law, OnFailure, pivots, read
from .impact import SOLVERS, Impact
from .kernels.oblique import oblique_central as kernel
from .kernels.oblique import outside_central
from .progress import Progress
from .units import Input, Pair
from .vehicle import Vehicle


def oblique_central(
    a: Vehicle,
    b: Vehicle,
    restitution: Input,
    *,
    normal: Input | Pair,
    friction: Input | None = None,
    impulse_ratio: Input | None = None,
    critical_fraction: Input | None = None,
    law: Law = "brach",
    on_failure: OnFailure | None = None,
    threads: int = 1,
    progress: Progress | None = None,
) -> Impact:
    """Solve an oblique central impact: velocities at an angle to the normal, bodies that do not turn.

    Along the normal as in a linear impact (eq 9 of "Application of Impulse Momentum Theory to Vehicle Collisions"); along the
    tangent the paper's contact is frictionless (``friction=0``) and leaves the velocities as they are, otherwise friction
    changes them. The bodies are point masses: the line of impact is taken to pass through both centres of mass. Valid where
    the levers of the contact are small against the radii of gyration; else use ``eccentric``.

    Parameters
    ----------
    a, b : Vehicle
        States just before contact; only mass and velocity are used.
    restitution : float, str, Quantity or array [-]
        Coefficient of restitution e along the normal, 0 to 1.
    normal : angle [rad] or tuple (nx, ny)
        Direction from A into B. An array is taken as angles.
    friction : float, str, Quantity or array [-]
        Coulomb bound on the tangential over the normal impulse, >= 0; ``inf`` never slips.
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
        Velocities, delta-V, impulse and energy; see its attributes.

    Raises
    ------
    InputError
        An argument that cannot be used, or a body that turns or is pinned.
    NoImpactError
        The bodies do not approach along the normal.
    NoSolutionError
        Both masses are infinite.

    Examples
    --------
    Two equal balls (eCourses Dynamics 4.3, K. Gramoll): A at 4 m/s, 30 degrees off the line, meets B at 3 m/s, elastic.

    >>> import collisions as col
    >>> a = col.Vehicle.from_speed(mass=1.0, speed=4.0, course="30 deg")
    >>> b = col.Vehicle(mass=1.0, vx=-3.0)
    >>> impact = col.oblique_central(a, b, 1.0, normal=0.0, friction=0.0)
    >>> round(impact.b.after.vx, 3), round(impact.a.after.vx, 3), round(impact.a.after.vy, 3)
    (3.464, -3.0, 2.0)
    """
    e, n, rule, bound, _, plain, given = read(
        a, b, restitution, normal, None, friction, impulse_ratio, critical_fraction, law, pivots("oblique_central", a, b)
    )
    return answer(
        kernel,
        (e, n[0], n[1], bound, a.mass, a.vx, a.vy, b.mass, b.vx, b.vy),
        (rule, law),
        ("oblique_central", a, b, e, n, rule, bound, law, None, given),
        plain,
        (outside_central, (a.yaw_rate, b.yaw_rate)),
        on_failure,
        threads,
        progress,
    )


SOLVERS["oblique_central"] = oblique_central

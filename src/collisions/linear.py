"""linear_central: two bodies that move along one line and strike head to head or nose to tail."""

from __future__ import annotations

from .answering import answer
from .arguments import OnFailure, pivots, read
from .impact import SOLVERS, Impact
from .kernels import codes
from .kernels.linear import linear_central as kernel
from .kernels.linear import outside_linear
from .progress import Progress
from .units import Input, Pair
from .vehicle import Vehicle


def linear_central(
    a: Vehicle,
    b: Vehicle,
    restitution: Input,
    *,
    normal: Input | Pair = 0.0,
    on_failure: OnFailure | None = None,
    threads: int = 1,
    progress: Progress | None = None,
) -> Impact:
    """Solve a linear central impact: from the states before and the restitution to the states after.

    Momentum along the normal (eq 2 of "Application of Impulse Momentum Theory to Vehicle Collisions") and Newton's
    restitution (eqs 5 and 6). The bodies are point masses: they do not turn, and all motion is along the normal through both
    centres of mass. Valid for head-on and front-to-back collisions in line, against other vehicles or a barrier; a motion
    across the normal of more than 8 eps of the speed is refused.

    Parameters
    ----------
    a, b : Vehicle
        States just before contact; only mass and velocity are used.
    restitution : float, str, Quantity or array [-]
        Coefficient of restitution e, 0 (plastic) to 1 (elastic).
    normal : angle [rad] or tuple (nx, ny), optional
        Direction from A into B; the x axis if not given.
    on_failure : {None, "raise", "nan"}, optional
        What to do with a case that cannot be answered. None: a single case raises, in a batch it is NaN with a status and one
        warning counts them. "raise": the first one raises, also in a batch. "nan": NaN with a status, without a warning.
    threads : int, optional
        Threads for a batch.
    progress : callable or True, optional
        Called as ``progress(done, total)`` after each block of a batch; True shows a bar once a run takes over a second,
        with tqdm where that is installed (extra ``progress``).

    Returns
    -------
    Impact
        Velocities, delta-V, impulse and energy; see its attributes.

    Raises
    ------
    InputError
        An argument that cannot be used, a body that turns, is pinned, or moves across the normal.
    NoImpactError
        The bodies do not approach; the message gives the closing speed.
    NoSolutionError
        Both masses are infinite.

    Examples
    --------
    Example 2 of the paper: 1100 kg at 80 km/h into the back of 950 kg at rest, with the restitution found there.

    >>> import collisions as col
    >>> a = col.Vehicle(mass="1100 kg", vx="80 km/h")
    >>> b = col.Vehicle(mass="950 kg")
    >>> impact = col.linear_central(a, b, restitution=35 / 88)
    >>> round(impact.a.after.q.vx.m_as("km/h"), 2), round(impact.b.after.q.vx.m_as("km/h"), 2)
    (28.18, 60.0)
    >>> round(impact.energy_loss / 1000, 1)
    106.0
    """
    e, n, rule, bound, _, plain, given = read(
        a, b, restitution, normal, None, 0.0, None, None, codes.BRACH, pivots("linear_central", a, b)
    )
    nx, ny = n
    vx_a, vy_a, vx_b, vy_b = a.vx, a.vy, b.vx, b.vy
    return answer(
        kernel,
        (e, nx, ny, a.mass, vx_a, vy_a, b.mass, vx_b, vy_b),
        (),
        ("linear_central", a, b, e, n, rule, bound, None, None, given),
        plain,
        (outside_linear, (nx, ny, a.yaw_rate, vx_a, vy_a, b.yaw_rate, vx_b, vy_b)),
        on_failure,
        threads,
        progress,
    )


SOLVERS["linear_central"] = linear_central

"""The forward solvers: linear central, oblique central, eccentric, and ``solve``, which chooses the
simplest that suffices.
"""

from __future__ import annotations

from inspect import signature
from typing import TYPE_CHECKING, Any, Never

from ..kernels.contact_laws import FRICTION
from ..messages.hints import hinted, no_argument
from ..messages.progress import Progress
from ..quantities.attributes import in_units_of
from ..quantities.units import Impulse, Input, Pair
from ..vehicle.tyres import Tyres
from ..vehicle.vehicle import Vehicle
from .impact import Impact, build, solved
from .inputs import Law, OnFailure, plain_inputs, read_inputs
from .models import (
    ECCENTRIC,
    LINEAR,
    OBLIQUE,
    TIME_RESOLVED,
    Model,
    float_function,
    read_eccentric,
    read_for_solve,
)
from .noted import noted
from .run import solve_inputs
from .time_resolved_inputs import Geometry, read_contact_time

if TYPE_CHECKING:
    from .choice import ModelChoice

_FRICTIONLESS = 0.0, None, None
# Where an argument is that a solver does not have.
_ELSEWHERE = {
    **dict.fromkeys(
        ("friction", "impulse_ratio", "critical_fraction", "law"),
        "oblique_central and eccentric have it",
    ),
    **dict.fromkeys(("point", "outside_a", "outside_b"), "eccentric has it"),
    **dict.fromkeys(
        ("duration", "stiffness", "crush_a", "crush_b", "drag"), "time_resolved has it"
    ),
    **dict.fromkeys(("tyres_a", "tyres_b"), "eccentric and time_resolved have it"),
}


@hinted
def linear_central(
    a: Vehicle,
    b: Vehicle,
    restitution: Input,
    *,
    normal: Input | Pair = 0.0,
    incomplete: bool = False,
    on_failure: OnFailure | None = None,
    threads: int = 1,
    progress: Progress | None = None,
    **unknown: Never,
) -> Impact:
    """Solve a linear central impact: from the states before and the restitution to the states
    after.

    The model is conservation of momentum along the normal (eq 2 of "Application of Impulse Momentum
    Theory to Vehicle Collisions") and Newton's restitution (eqs 5 and 6). The bodies are point
    masses: they do not turn, and all motion is along the normal through both centres of mass. It is
    valid for head-on and front-to-rear collisions in line, against other vehicles or a barrier;
    motion across the normal of more than 8 eps of the speed is refused.

    Parameters
    ----------
    a, b : Vehicle
        States just before contact; only mass and velocity are used.
    restitution : float, str, Quantity or array [-]
        Coefficient of restitution e, 0 (plastic) to 1 (elastic).
    normal : angle [rad] or tuple (nx, ny), optional
        Direction from A into B; the x axis if not given.
    incomplete : bool, optional
        Whether the restitution may be below 0 (and above -1), for bodies that pass each other, or
        tear whatever held them together, before they reach a common velocity. The contact ends
        while they still approach, at -e times the closing speed.
    on_failure : {None, "raise", "nan"}, optional
        What to do with a case that cannot be answered. None: a single case raises; in a batch such
        cases are NaN with a status, and one warning counts them. "raise": the first one raises,
        also in a batch. "nan": NaN with a status, without a warning; ``propagate`` and the like
        state how many cases were refused, and why.
    threads : int, optional
        Number of threads for a batch.
    progress : callable or True, optional
        Called as ``progress(done, total)`` after each block of a batch; True shows a bar once a run
        takes over a second, with tqdm where that is installed (extra ``progress``).

    Returns
    -------
    Impact
        Velocities, delta-V, impulse and energy; see its attributes.

    Raises
    ------
    InputError
        An argument that cannot be used, or a body that turns, is pinned, or moves across the
        normal.
    NoImpactError
        The bodies do not approach; the message gives the closing speed.
    NoSolutionError
        Both masses are infinite.

    Examples
    --------
    Example 2 of the paper: 1100 kg at 80 km/h into the back of 950 kg at rest, with the restitution
    found there.

    >>> import collisions as col
    >>> a = col.Vehicle(mass="1100 kg", vx="80 km/h")
    >>> b = col.Vehicle(mass="950 kg")
    >>> impact = col.linear_central(a, b, restitution=35 / 88)
    >>> round(impact.a.after.q.vx.m_as("km/h"), 2), round(impact.b.after.q.vx.m_as("km/h"), 2)
    (28.18, 60.0)
    >>> round(impact.energy_loss / 1000, 1)
    106.0
    """
    if unknown:
        raise no_argument(
            "linear_central()", signature(linear_central).parameters, unknown, _ELSEWHERE
        )
    return _solve(
        LINEAR,
        a,
        b,
        restitution,
        normal,
        None,
        _FRICTIONLESS,
        None,
        incomplete,
        on_failure,
        threads,
        progress,
    )


@hinted
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
    incomplete: bool = False,
    on_failure: OnFailure | None = None,
    threads: int = 1,
    progress: Progress | None = None,
    **unknown: Never,
) -> Impact:
    """Solve an oblique central impact: velocities at an angle to the normal, bodies that do not
    turn.

    Along the normal the impact is solved as a linear one (eq 9 of "Application of Impulse Momentum
    Theory to Vehicle Collisions"). Along the tangent the paper's contact is frictionless
    (``friction=0``) and leaves the velocities as they are; otherwise friction changes them. The
    bodies are point masses: the line of impact is taken to pass through both centres of mass. The
    model is valid where the lever arms of the contact are small compared with the radii of
    gyration; elsewhere use ``eccentric``.

    Parameters
    ----------
    a, b : Vehicle
        States just before contact; only mass and velocity are used.
    restitution : float, str, Quantity or array [-]
        Coefficient of restitution e along the normal, 0 to 1.
    normal : angle [rad] or tuple (nx, ny)
        Direction from A into B. An array is taken as angles.
    friction, impulse_ratio, critical_fraction : float, str, Quantity or array [-]
        Exactly one of these three, as for ``eccentric``.
    law : {"brach", "kudlich-slibar", "stronge"}, optional
        As for ``eccentric``; without lever arms "stronge" gives the same as "brach".
    incomplete, on_failure, threads, progress
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
    Two equal balls (eCourses Dynamics 4.3, K. Gramoll): A at 4 m/s, 30 degrees off the line, meets
    B at 3 m/s, elastic.

    >>> import collisions as col
    >>> a = col.Vehicle.from_speed(mass=1.0, speed=4.0, course="30 deg")
    >>> b = col.Vehicle(mass=1.0, vx=-3.0)
    >>> impact = col.oblique_central(a, b, 1.0, normal=0.0, friction=0.0)
    >>> round(impact.b.after.vx, 3), round(impact.a.after.vx, 3), round(impact.a.after.vy, 3)
    (3.464, -3.0, 2.0)
    """
    if unknown:
        raise no_argument(
            "oblique_central()", signature(oblique_central).parameters, unknown, _ELSEWHERE
        )
    tangential = friction, impulse_ratio, critical_fraction
    return _solve(
        OBLIQUE,
        a,
        b,
        restitution,
        normal,
        None,
        tangential,
        law,
        incomplete,
        on_failure,
        threads,
        progress,
    )


@hinted
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
    incomplete: bool = False,
    outside_a: Impulse | None = None,
    outside_b: Impulse | None = None,
    duration: Input | None = None,
    tyres_a: Tyres | None = None,
    tyres_b: Tyres | None = None,
    on_failure: OnFailure | None = None,
    threads: int = 1,
    progress: Progress | None = None,
    **unknown: Never,
) -> Impact:
    """Solve an eccentric impact: the line of impact misses a centre of mass, so the bodies turn.

    The model applies impulse and momentum, linear and angular, to both bodies, with restitution
    between the velocities of the contact points along the normal (eqs 10 to 19 of "Application of
    Impulse Momentum Theory to Vehicle Collisions") and friction along the tangent. The bodies may
    be free, pinned or fixed. The contact is one point with one normal, the impact takes no time and
    no distance, and tyre forces during it are left out unless they are given as ``outside_a`` and
    ``outside_b``. The model is valid where the impulse of the contact is large compared with that
    of the tyres, and where a point and a normal can be assigned to the damage.

    Parameters
    ----------
    a, b : Vehicle
        States just before contact. Each needs ``yaw_inertia``, ``x`` and ``y``, unless its mass and
        inertia are infinite.
    restitution : float, str, Quantity or array [-]
        Coefficient of restitution e along the normal at the contact, 0 to 1.
    normal : angle [rad] or tuple (nx, ny)
        Direction from A into B at the contact. An array is taken as angles.
    point : pair [m]
        Scene point (x, y) at which the impulse acts, at the moment of maximum engagement.
    friction : float, str, Quantity or array [-]
        Coulomb bound on the ratio of tangential to normal impulse, >= 0; 0 is the paper's contact,
        ``inf`` never slips.
    impulse_ratio : float, str, Quantity or array [-]
        Ratio of tangential to normal impulse, signed: positive if the impulse on B is along the
        normal turned by +90 degrees.
    critical_fraction : float, str, Quantity or array [-]
        Fraction, 0 to 1, of the ratio that just stops the slip. Exactly one of friction, impulse
        ratio and critical fraction must be given.
    law : {"brach", "kudlich-slibar", "stronge"}, optional
        How restitution acts and what friction does. "brach": restitution acts on the closing speed,
        and a contact that sticks has no slip at separation. "kudlich-slibar": it has no slip at the
        end of compression, and the whole impulse up to then is multiplied by 1 + e. "stronge":
        restitution gives back e squared of the work of compression, and friction opposes a slip
        that may stop or reverse during the contact; with ``friction`` only.
    outside_a, outside_b : tuple (x, y) or (x, y, yaw) [N*s, N*s, N*m*s], optional
        Impulse on A and on B during the contact from something other than the other vehicle, such
        as tyres, a kerb or soft ground: its components along the scene axes at the centre of mass,
        and its moment about it. ``left_out`` estimates that of the tyres. The impulse is a given
        number; an object that stops a vehicle with whatever impulse that takes, such as a kerb of
        unknown impulse, is to be solved as a second impact, against a barrier.
    duration : float, str, Quantity or array [s], optional
        How long the contact lasts, for the impulse of the tyres; with ``tyres_a`` or ``tyres_b``.
    tyres_a, tyres_b : travel.Tyres, optional
        The wheels of each vehicle, which then needs a ``heading``. Their mean force is worked out
        from the motion without them, before, half-way through and after the contact (Simpson's
        rule); times the duration it acts as an impulse from outside, ``impact.a.tyre_impulse_x``,
        and the impact is solved once more. At each of these moments a wheel has no more than would
        stop it, as it moves then along its force, with a quarter of the vehicle's mass: once where
        the vehicle moves after as before, up to twice where the contact sets it in motion. Where
        tyres could stop a vehicle, or its turning, within the contact, their impulse is rough, and
        statements and ``diagnose`` say so (``tyres_stop``). This costs two calls; the motion during
        the contact, which ``time_resolved`` has too, is left out. A vehicle without has no tyre
        forces; ``left_out`` and ``diagnose`` say what they could do, a wall has none.
    incomplete, on_failure, threads, progress
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
        The contact points do not approach along the normal, or the impulses from outside separate
        them.
    NoSolutionError
        Neither body can yield, the ratio jams, or stopping the slip would need the bodies to pull
        at each other.

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

    A slow rear-end impact, and the same with B's wheels locked (drag 0.7 for 0.1 s):

    >>> a = col.Vehicle(mass=1500, vx=3.0, yaw_inertia=2600, x=-2.2, y=0.0)
    >>> b = col.Vehicle(mass=1500, yaw_inertia=2600, x=2.2, y=0.0)
    >>> for braking in (None, (-0.7 * 9.81 * 0.1 * 1500, 0.0)):
    ...     impact = col.eccentric(
    ...         a, b, 0.3, normal=0.0, point=(0.0, 0.0), friction=0.5, outside_b=braking
    ...     )
    ...     print(round(impact.b.delta_v, 2), round(impact.b.outside_work))
    1.95 0
    1.61 -827
    """
    if unknown:
        raise no_argument("eccentric()", signature(eccentric).parameters, unknown, _ELSEWHERE)
    tangential = friction, impulse_ratio, critical_fraction
    if duration is not None or tyres_a is not None or tyres_b is not None:
        arguments = a, b, restitution, normal, point, tangential, law
        more = {"incomplete": incomplete, "outside_a": outside_a, "outside_b": outside_b}
        inputs = read_eccentric(arguments, duration, tyres_a, tyres_b, **more)
        found = build(inputs, solve_inputs(ECCENTRIC, inputs, on_failure, threads, progress))
        return noted(found, on_failure)
    outside = None if outside_a is outside_b is None else (outside_a, outside_b)
    return _solve(
        ECCENTRIC,
        a,
        b,
        restitution,
        normal,
        point,
        tangential,
        law,
        incomplete,
        on_failure,
        threads,
        progress,
        outside,
    )


@hinted
def time_resolved(
    a: Vehicle,
    b: Vehicle,
    restitution: Input,
    *,
    normal: Input | Pair,
    point: Pair,
    friction: Input,
    duration: Input | None = None,
    stiffness: Input | None = None,
    crush_a: tuple[Input, Input, Input] | None = None,
    crush_b: tuple[Input, Input, Input] | None = None,
    drag: Input = 0.0,
    tyres_a: Tyres | None = None,
    tyres_b: Tyres | None = None,
    geometry: Geometry = "maximum_engagement",
    steps: int = 100,
    wheelbase: Input | None = None,
    track: Input | None = None,
    on_failure: OnFailure | None = None,
    threads: int = 1,
    progress: Progress | None = None,
    **unknown: Never,
) -> Impact:
    """Follow a contact that takes time: a spring between the vehicles, friction, sliding tyres, and
    changing positions.

    It integrates the contact over time, where ``eccentric`` applies one impulse. Along the normal a
    force grows with the penetration of the contact points; of the work it takes up, restitution
    gives back the share e squared (energetic restitution). Along the tangent Coulomb friction acts,
    and sticks where it can. The tyres slide on the ground. Meanwhile the vehicles move and turn:
    point and normal move with the mean of both vehicles; against a fixed body the point moves with
    the vehicle, and the normal with the fixed body. The model is valid for what ``eccentric``
    leaves out of a single contact patch with a single direction: low speeds, sideswipes, large
    vehicles.
    Crush that moves the centre of mass, roll and pitch are left out here too.

    Parameters
    ----------
    a, b : Vehicle
        Motions just before contact, and positions as ``geometry`` says. Each needs ``yaw_inertia``,
        ``x`` and ``y``, unless its mass and inertia are infinite; neither may have a pivot. The
        wheels are placed along the ``heading``; without one all drag acts at the centre of mass,
        where it cannot turn the vehicle.
    restitution : float, str, Quantity or array [-]
        Square root of the share of the work of compression that is given back, 0 to 1.
    normal : angle [rad] or tuple (nx, ny)
        Direction from A into B at the contact. An array is taken as angles.
    point : pair [m]
        Scene point (x, y) of the contact.
    friction : float, str, Quantity or array [-]
        Coefficient of Coulomb friction of the contact, >= 0; 0 is frictionless, ``inf`` never
        slips.
    duration : float, str, Quantity or array [s]
        Nominal duration: the stiffness is the one with which a frictionless contact of the same two
        vehicles would take that long if they did not move or turn meanwhile, so that it depends on
        their effective mass at the contact, lever arms included. The actual duration, in the
        answer's ``pulse``, differs because of friction, tyres and motion.
    stiffness : float, str, Quantity or array [N/m]
        Stiffness of both vehicles together, force over penetration.
    crush_a, crush_b : tuple (A [N/m], B [N/m**2], width [m])
        Crush stiffness coefficients as in CRASH, where A + B C is the force per width that leaves a
        crush C behind. While it acts the structure gives way by C + A/B, so the force grows from 0
        with B times that, and up to the largest force it takes up what ``reconstruct.crush_energy``
        says of the crush that is left, ``pulse.residual_crush_a``. That is 0 where the force stays
        below A. One is enough, and the other vehicle is then rigid; with both, the force is common
        to them. Exactly one of duration, stiffness and crush must be given.
    drag : float, str, Quantity or array [-]
        The rough form of tyres: all wheels of both vehicles slide, with this drag factor against
        their motion, whatever way they go, as for ``left_out``: 0.7 is locked wheels on a dry road;
        0 means no tyre forces. It leaves out that wheels which roll hardly resist along themselves
        and resist sideways with their full friction: in a T-bone no drag comes nearer to rolling
        wheels than 4 to 9 percent of delta-V. Give ``tyres_a`` and ``tyres_b`` where wheels roll.
    tyres_a, tyres_b : travel.Tyres, optional
        The wheels of each vehicle, in place of a drag: rolling, braked or steered, with the tyre
        force that ``travel.simulate`` has on the way to rest. A vehicle with tyres needs a
        ``heading``; one without has no tyre forces, and ``diagnose`` says what they could give.
    geometry : {"maximum_engagement", "first_contact", "fixed"}
        The moment to which the given positions belong. Maximum engagement is what all other solvers
        take; the start of the contact is then searched for, until the places reached are within
        0.003 of closing speed times duration of those given (in sum; 3 mm at 10 m/s and 0.1 s; with
        n steps that times (100/n)**3, but at most 0.01). Over 1,000 random impacts of cars this
        moves delta-V by 0.0006 m/s in the median, 0.003 in 9 of 10, and 0.02 at most. What the last
        correction of the start changes is mostly found with a tenth of the steps. Where it cannot
        be reached the case is refused. "fixed" leaves everything where it is.
    steps : int
        Steps per nominal duration, which is that of a linear spring with the same largest force. At
        its yaw rate before, a vehicle may turn by 0.25 rad within one.
    wheelbase, track : float, str, Quantity or array [m], optional
        With a drag, the same for both vehicles, with the centre of mass in the middle; 2.7 m and
        1.5 m if not given.
    on_failure, threads, progress
        As for ``linear_central``.

    Returns
    -------
    Impact
        Its ``pulse`` has force, crush and motions over time. Speeds, impulses and energies are
        those that came about: closing speed and slip before are those at first contact;
        ``energy_loss`` is that of the contact, ``a.tyre_loss`` that of A's tyres;
        ``at_compression`` is the state at maximum engagement. The positions in the result are those
        given, and do not change.

    Raises
    ------
    InputError
        An argument that cannot be used.
    MissingInputError
        A position, a yaw inertia or the contact point was not given. Nothing is taken as zero.
    NoImpactError
        The contact points do not approach along the normal.
    NoSolutionError
        Neither body can yield; no start leads to the positions given; the contact does not end
        within three nominal durations; or a vehicle turns by more than 0.25 rad within a step.

    Warns
    -----
    SuspectUnitsWarning
        A duration above 1 s, a stiffness below 10 kN/m, a width of crush above 10 m, an A above 0
        and below 1 kN/m or B below 10 kN/m**2, a drag above 1.5, or a wheelbase or track larger
        than that of any vehicle, given without a unit.

    Notes
    -----
    The integration is position Verlet. At 100 steps the error is about 3e-5 of delta-V with fixed
    geometry and no tyres, and about 1e-4 with moving geometry and tyres, if contact and wheels keep
    sliding; both fall with the square of the step. Where a tyre or, with moving geometry, the slip
    comes to a stop, the error falls in proportion to the step. Momentum is conserved to rounding.
    Without tyres and motion it is Stronge's contact (J. Appl. Mech. 58 (1991)), which is also the
    limit as the duration goes to 0. No tyre ever reverses the motion of its wheel, so tyres can
    only take energy away.

    At 100 steps the energies err by less than 3e-4 of the energy absorbed in nine of ten contacts,
    and by less than 2e-3 in 99 of 100. With a restitution of 1, at which nothing may be lost along
    the normal, ``energy_loss`` may thus be a little below 0: ``ok`` is then False, with a warning.

    The contact point and the normal are carried by the mean of both bodies, whatever their masses;
    but beside a fixed body (infinite mass and yaw inertia, as ``Vehicle.barrier()``) the other
    body carries the point, and the normal stays. A wall is therefore not the limit of a very
    heavy vehicle: while the geometry moves, the two answers differ, the yaw rate by a quarter in
    some cases, also for a mass of 1e18 kg. Give a barrier what does not give way, and a vehicle
    its real mass.

    Examples
    --------
    A parked car is struck from behind at 2 m/s; all wheels of both cars are locked. The impulse
    alone would give 1.40 m/s:

    >>> import collisions as col
    >>> a = col.Vehicle(mass=1500, vx=2.0, yaw_inertia=2600, x=-2.2, y=0.0, heading=0.0)
    >>> b = col.Vehicle(mass=1500, yaw_inertia=2600, x=2.2, y=0.0, heading=0.0)
    >>> contact = {"normal": 0.0, "point": (0.0, 0.0), "friction": 0.5}
    >>> impact = col.time_resolved(a, b, 0.4, **contact, duration="100 ms", drag=0.7)
    >>> (
    ...     round(impact.b.delta_v, 2),
    ...     round(impact.pulse.q.duration.m_as("ms")),
    ...     round(impact.pulse.q.max_crush.m_as("cm"), 1),
    ... )
    (0.73, 100, 8.8)
    """
    if unknown:
        raise no_argument(
            "time_resolved()", signature(time_resolved).parameters, unknown, _ELSEWHERE
        )
    spring = {"duration": duration, "stiffness": stiffness, "crush_a": crush_a, "crush_b": crush_b}
    others: dict[str, Any] = {
        "drag": drag,
        "wheelbase": wheelbase,
        "track": track,
        "geometry": geometry,
        "steps": steps,
    }
    others |= {"tyres_a": tyres_a, "tyres_b": tyres_b}
    inputs = read_contact_time(a, b, restitution, normal, point, friction, spring | others)
    found = build(inputs, solve_inputs(TIME_RESOLVED, inputs, on_failure, threads, progress))
    return noted(found, on_failure)


@hinted
def required_model(
    a: Vehicle,
    b: Vehicle,
    restitution: Input,
    *,
    normal: Input | Pair,
    point: Pair | None,
    friction: Input | None = None,
    impulse_ratio: Input | None = None,
    critical_fraction: Input | None = None,
    law: Law = "brach",
    incomplete: bool = False,
    outside_a: Impulse | None = None,
    outside_b: Impulse | None = None,
    tolerance: Input = 0.0,
    duration: Input | None = None,
    drag: Input | None = None,
    tyres_a: Tyres | None = None,
    tyres_b: Tyres | None = None,
) -> ModelChoice:
    """The simplest model whose answer stays within a tolerance of the eccentric one, or of the
    contact in time.

    Without a duration the eccentric model is the fullest, and what it leaves out itself
    (``left_out``) does not count.

    The candidates are the linear central model (which leaves motion across the normal unchanged),
    the oblique central model and the eccentric one. The error of a candidate is that of the vehicle
    for which it is larger: the hypotenuse of the error of its delta-V vector and of its radius of
    gyration times the error of its change of yaw rate. It is worked out from the impulse at the
    contact, without the rest of the eccentric answer, and a candidate is accepted if 1.15 times its
    error is within the tolerance. The effect of a lever arm depends on yaw inertia, position and
    point; where one of these is not known, and a lever arm may matter, the error is not known
    either. A lever arm of up to 16 eps of the coordinates, and of 0.1 mm at most, is rounding and
    does not matter.

    With ``duration``, a contact of that duration with tyres of that drag is a fourth candidate,
    ``time_resolved``, and the one against which all are measured; for this it is followed roughly,
    in 25 steps. The errors of the models that take no time then include what they leave out.
    ``time_resolved`` needs ``friction``, has a law of its own, which stands in for "brach"
    alone, and takes no pivot, no impulse from outside and no restitution below 0; otherwise it
    is not a candidate, and the reason says so, as it does where it has no answer. Where the 25
    steps find no start or no end of the contact, which more steps may find, it is required
    whatever the tolerance.

    Parameters
    ----------
    a, b, restitution, normal, point, friction, impulse_ratio, critical_fraction, law
        As for ``eccentric``; yaw inertias, positions and the point may be left None.
    incomplete, outside_a, outside_b
        As for ``eccentric``. With an impulse from outside, as with a pivot, the eccentric model is
        required.
    tolerance : float, str, Quantity or array [m/s]
        Largest error that is accepted, >= 0. With 0 the eccentric model is required, even where a
        simpler one would be exact; with ``duration`` it is ``time_resolved``, unless that is not a
        candidate or has no answer.
    duration, drag, tyres_a, tyres_b
        As for ``time_resolved``, optional; without ``drag`` or tyres there are no tyre forces. With
        tyres the eccentric model has them too, as ``eccentric`` does, and the central ones have
        not.

    Returns
    -------
    ModelChoice
        The model, the reason in a sentence, the error of each cheaper model, and what each model
        still needs.

    Raises
    ------
    InputError
        An argument that cannot be used.

    Examples
    --------
    A rear-end impact 0.4 m off the line of centres. Delta-V alone would not show the effect of the
    lever arm:

    >>> import collisions as col
    >>> a = col.Vehicle(mass=1500, vx=10.0, yaw_inertia=2400, x=-2.0, y=0.4)
    >>> b = col.Vehicle(mass=1200, yaw_inertia=1700, x=2.0, y=0.0)
    >>> choice = col.required_model(
    ...     a, b, 0.2, normal=0.0, point=(0.0, 0.4), friction=0.0, tolerance=0.5
    ... )
    >>> choice.model, round(choice.errors["linear_central"], 2)
    ('eccentric', 2.14)
    """
    arguments = a, b, restitution, normal, point, (friction, impulse_ratio, critical_fraction), law
    more = {"incomplete": incomplete, "outside_a": outside_a, "outside_b": outside_b}
    inputs = read_for_solve(arguments, tolerance, duration, drag, tyres_a, tyres_b, **more)
    from .choice import choose

    return in_units_of(choose(inputs)[0], inputs.texts)


@hinted
def solve(
    a: Vehicle,
    b: Vehicle,
    restitution: Input,
    *,
    normal: Input | Pair,
    point: Pair | None,
    friction: Input | None = None,
    impulse_ratio: Input | None = None,
    critical_fraction: Input | None = None,
    law: Law = "brach",
    incomplete: bool = False,
    outside_a: Impulse | None = None,
    outside_b: Impulse | None = None,
    tolerance: Input = 0.0,
    duration: Input | None = None,
    drag: Input | None = None,
    tyres_a: Tyres | None = None,
    tyres_b: Tyres | None = None,
    on_failure: OnFailure | None = None,
    threads: int = 1,
    progress: Progress | None = None,
    **unknown: Never,
) -> Impact:
    """Solve an impact with the simplest model that stays within a tolerance of the eccentric one,
    or of the contact in time.

    Without a duration the eccentric model is the fullest, and what it leaves out itself
    (``left_out``) does not count.

    The model is chosen by ``required_model``, in a batch for each case separately, and each case is
    solved by its own model. Motion that the model cannot represent, such as spin or motion across
    the normal, is left unchanged. Bodies that are known not to approach are refused, whatever else
    is missing.

    Parameters
    ----------
    a, b, restitution, normal, point, friction, impulse_ratio, critical_fraction, law
        As for ``eccentric``; what the required model does not need may be left None.
    tolerance : float, str, Quantity or array [m/s]
        Largest error that is accepted, as for ``required_model``.
    duration, drag : float, str, Quantity or array [s], [-], optional
        Duration of the contact and drag of the tyres, as for ``required_model``; a time-resolved
        contact is solved in 100 steps.
    tyres_a, tyres_b : travel.Tyres, optional
        The wheels of each vehicle in place of a drag, as for ``required_model``.
    incomplete, outside_a, outside_b, on_failure, threads, progress
        As for ``eccentric``.

    Returns
    -------
    Impact
        With the model used in ``model`` and how it was chosen in ``choice``.

    Raises
    ------
    InputError, NoImpactError, NoSolutionError
        As for ``eccentric``; MissingInputError if the required model lacks an input, in a batch for
        the first such case.

    Examples
    --------
    A square rear-end impact along the line of centres, for which no yaw inertia is needed.

    >>> import collisions as col
    >>> a, b = col.Vehicle(mass=1500, vx=10.0, x=-2.0, y=0.0), col.Vehicle(mass=1200, x=2.0, y=0.0)
    >>> impact = col.solve(
    ...     a, b, 0.2, normal=0.0, point=(0.0, 0.0), friction=0.5, tolerance="0.1 km/h"
    ... )
    >>> impact.model, round(impact.b.delta_v, 3)
    ('linear_central', 6.667)
    """
    if unknown:
        raise no_argument("solve()", signature(solve).parameters, unknown, _ELSEWHERE)
    arguments = a, b, restitution, normal, point, (friction, impulse_ratio, critical_fraction), law
    more = {"incomplete": incomplete, "outside_a": outside_a, "outside_b": outside_b}
    inputs = read_for_solve(arguments, tolerance, duration, drag, tyres_a, tyres_b, **more)
    return noted(solved(inputs, on_failure, threads, progress), on_failure)


def _solve(
    model: Model,
    a: Any,
    b: Any,
    restitution: Any,
    normal: Any,
    point: Any,
    tangential: tuple[Any, ...],
    law: Any,
    incomplete: Any,
    on_failure: Any,
    threads: Any,
    progress: Any,
    outside: tuple[Any, Any] | None = None,
) -> Impact:
    """Read the arguments and solve them, plain floats on the shortest way."""
    if (
        incomplete is False
        and outside is on_failure is progress is None
        and type(threads) is int
        and threads == 1
    ):
        inputs = plain_inputs(model.name, a, b, restitution, normal, point, tangential, law)
        if inputs is not None:
            answer = float_function(
                model,
                FRICTION,
                law,
                a.pivot is not None,
                b.pivot is not None,
                False,
                False,
            )(inputs.__dict__)
            if answer is not None:
                return noted(build(inputs, answer))
    arguments = a, b, restitution, normal, point, tangential, law
    inputs = read_inputs(model.name, arguments, (), (), incomplete, *(outside or (None, None)))
    found = build(inputs, solve_inputs(model, inputs, on_failure, threads, progress))
    return noted(found, on_failure)

"""What a kernel answers: the outcome of a case as a ``Status``, and its numbers by name as an
``Answer`` or a ``Passed``.
"""

from enum import IntEnum
from math import nan
from typing import Any, Literal, NamedTuple, TypeAlias

EPS = 2.0**-52

Family: TypeAlias = Literal["impact", "solution", "input"]


class _Outcome(int):
    """A code with its family of errors, what it means, and the message of a single case where every
    solver says the same.
    """

    about: Family
    sentence: str
    message: str

    def __new__(cls, code: int, about: Family, sentence: str, message: str = "") -> "_Outcome":
        outcome = int.__new__(cls, code)
        outcome.about, outcome.sentence, outcome.message = about, sentence, message
        return outcome


class Status(IntEnum):
    """Outcome of one case; ``sentence`` says it in words.

    ``about`` is its family of errors: "impact" (there was none), "solution" (the model has none) or
    "input". ``OK`` and ``ENERGY_GAIN`` come with numbers, every other status with NaN.
    """

    about: Family
    sentence: str
    # Its fields are filled in by ``refusal``.
    message: str

    def __new__(cls, outcome: int) -> "Status":
        member = int.__new__(cls, outcome)
        member._value_ = int(outcome)
        if isinstance(outcome, _Outcome):
            member.about, member.sentence, member.message = (
                outcome.about,
                outcome.sentence,
                outcome.message,
            )
        return member

    OK = _Outcome(0, "solution", "solved")
    ENERGY_GAIN = _Outcome(
        1, "solution", "solved, but the model ends with more energy than it began with"
    )
    SEPARATING = _Outcome(
        2,
        "impact",
        "the bodies move apart along the normal, which must point from A into B",
        "no impact: the bodies move apart along the normal, closing speed "
        "{closing_speed}; the normal is `({nx:.4g}, {ny:.4g})`, and must point from A into B; if "
        "A and B were meant the other way round, exchange them or write "
        "`normal=({opposite_x:.4g}, {opposite_y:.4g})`",
    )
    GRAZING = _Outcome(
        3,
        "impact",
        "the bodies do not approach along the normal: the closing speed is 0",
        "no impact: the bodies neither approach nor part along the normal, closing speed 0; the "
        "normal is `({nx:.4g}, {ny:.4g})`, and must point from A into B; give the speeds just "
        "before contact, or the normal of the surfaces that met",
    )
    IMMOVABLE = _Outcome(
        4,
        "solution",
        "nothing can yield along the normal",
        "nothing can yield along the normal: both bodies are fixed there (infinite masses, or a "
        "line of impact through the pivot of a body against a wall); give at least one a finite "
        "mass, or correct normal or point",
    )
    SINGULAR_CONTACT = _Outcome(
        5,
        "solution",
        "the contact has one degree of freedom, so a no-slip impulse is not defined",
        "the contact can move in one direction only (a pinned body against a fixed "
        "one, or parallel arms), so what would stop the slip is not defined; write "
        "`friction=0`, or give `impulse_ratio=`",
    )
    NO_SLIP_PULLS = _Outcome(
        6,
        "solution",
        "without slip the bodies would have to pull at each other",
        "{rule} = {value:g} asks for a contact without slip, which here needs the "
        "bodies to pull at each other; give a finite `friction=`, or `impulse_ratio=` "
        "to a solver that takes it",
    )
    RATIO_JAMS = _Outcome(
        7,
        "solution",
        "the impulse ratio is at or beyond the value at which the bodies jam",
        "{rule} = {value:g} jams the bodies: at {limit:.6g} the normal impulse grows without "
        "end; give a ratio {side} than that",
    )
    OUT_OF_RANGE = _Outcome(
        8,
        "input",
        "the answer is not a finite number",
        "the answer is not a finite number: the arguments are too large or too small for floats, "
        "or too far apart; give masses, lengths and speeds whose products stay between 1e-150 "
        "and 1e150",
    )
    NOT_FINITE = _Outcome(9, "input", "an input is NaN, or infinite where it may not be")
    NOT_POSITIVE = _Outcome(
        10,
        "input",
        "a mass, a yaw inertia, a duration, a stiffness or a length is not greater than 0",
    )
    BAD_RESTITUTION = _Outcome(
        11,
        "input",
        "the restitution is outside 0 to 1; with incomplete=True, it is not between -1 and 1",
    )
    BAD_FRICTION = _Outcome(12, "input", "the friction is below 0")
    BAD_FRACTION = _Outcome(13, "input", "the critical fraction is outside 0 to 1")
    ZERO_NORMAL = _Outcome(14, "input", "the normal has no length")
    PINNED_INFINITE = _Outcome(15, "input", "a pinned body has an infinite mass or yaw inertia")
    PINNED_VELOCITY = _Outcome(
        16, "input", "the velocity of a pinned body is not its yaw rate times the arm"
    )
    SPINNING = _Outcome(
        17,
        "input",
        "a body turns, which the central models cannot answer",
        "{model} takes bodies that do not turn, and {motion}; use eccentric, which needs "
        "yaw_inertia, x, y and point",
    )
    TRANSVERSE = _Outcome(
        18,
        "input",
        "a body moves across the normal, which the linear model cannot answer",
        "linear_central takes motion along the normal ({nx:.4g}, {ny:.4g}) only, and {motion}; "
        "use oblique_central, or give the normal along the motion",
    )
    NO_CLOSING = _Outcome(
        19, "impact", "the bodies did not approach before: the closing speed is 0"
    )
    NOT_SEPARATING = _Outcome(20, "solution", "the bodies do not part after the impact")
    CONTRADICTORY = _Outcome(21, "solution", "what was given contradicts itself")
    UNDETERMINED = _Outcome(22, "solution", "what was given leaves the answer open")
    AMBIGUOUS = _Outcome(23, "solution", "more than one answer fits")
    AMBIGUOUS_INVERSE = _Outcome(24, "solution", "more than one state before the impact ends so")
    STICK_INVERSE = _Outcome(
        25, "solution", "the contact ended without slip, which tells nothing of the slip before"
    )
    INVERSE_E0 = _Outcome(
        26, "solution", "after a plastic impact nothing is left of the closing speed"
    )
    INFINITE_MASS = _Outcome(
        27, "solution", "the motion of an infinite mass tells nothing of the impact"
    )
    PARALLEL_HEADINGS = _Outcome(
        28, "solution", "the courses are parallel, so nothing across them tells the speeds apart"
    )
    NO_START = _Outcome(
        29,
        "solution",
        "no start of the contact leads to the positions given at its maximum engagement",
        "no start of the contact was found from which it comes to the positions given "
        "at its maximum engagement; check duration or stiffness and the motions, or "
        "write `geometry='first_contact'` if the positions are those",
    )
    ENDLESS_CONTACT = _Outcome(
        30,
        "solution",
        "the contact does not end within three times its nominal duration",
        "the contact does not end within three times its nominal duration: the bodies stay "
        "together, pushed or held by tyres; give a shorter duration, less drag, or a higher "
        "restitution",
    )
    NEGATIVE_SIZE = _Outcome(31, "input", "a drag, a stiffness or a height is below 0")
    WHEEL_LIFTS = _Outcome(
        32,
        "input",
        "at this height of its centre of mass a vehicle could lift a wheel off the ground",
    )
    COARSE_STEPS = _Outcome(
        33,
        "solution",
        "a body turns by more than 0.25 rad within a time step",
        "a body turns by more than 0.25 rad within a time step, at its yaw rate before; give more "
        "`steps=`, or check yaw rate and duration",
    )

    @property
    def label(self) -> str:
        """The ``code`` of the error that a single case of this status raises."""
        return self.name.lower()


class Answer(NamedTuple):
    """What every kernel returns: impulses on B along the normal and the tangent, changes of
    velocity in scene axes.
    """

    status: Any
    closing_speed: Any
    slip_before: Any = 0.0
    slip_after: Any = 0.0
    normal_impulse: Any = 0.0
    tangential_impulse: Any = 0.0
    compression_impulse: Any = 0.0
    no_slip_normal: Any = 0.0
    no_slip_tangential: Any = 0.0
    sticks: Any = False
    effective_mass: Any = 0.0
    coupling: Any = 0.0
    energy_loss_normal: Any = 0.0
    energy_loss_tangential: Any = 0.0
    energy_loss: Any = 0.0
    impulse_x: Any = 0.0
    impulse_y: Any = 0.0
    delta_vx_a: Any = 0.0
    delta_vy_a: Any = 0.0
    delta_yaw_rate_a: Any = 0.0
    delta_vx_b: Any = 0.0
    delta_vy_b: Any = 0.0
    delta_yaw_rate_b: Any = 0.0
    # Of a law with a separation speed of its own.
    separation_speed: Any = 0.0


class WithTyres(NamedTuple):
    """An ``Answer`` of which a part is due to tyres, and what they did."""

    status: Any
    closing_speed: Any
    slip_before: Any
    slip_after: Any
    normal_impulse: Any
    tangential_impulse: Any
    compression_impulse: Any
    no_slip_normal: Any
    no_slip_tangential: Any
    sticks: Any
    effective_mass: Any
    coupling: Any
    energy_loss_normal: Any
    energy_loss_tangential: Any
    energy_loss: Any
    impulse_x: Any
    impulse_y: Any
    delta_vx_a: Any
    delta_vy_a: Any
    delta_yaw_rate_a: Any
    delta_vx_b: Any
    delta_vy_b: Any
    delta_yaw_rate_b: Any
    separation_speed: Any
    tyre_impulse_x_a: Any
    tyre_impulse_y_a: Any
    tyre_moment_a: Any
    tyre_loss_a: Any
    tyre_impulse_x_b: Any
    tyre_impulse_y_b: Any
    tyre_moment_b: Any
    tyre_loss_b: Any


class Passed(NamedTuple):
    """The answer of a contact that took time: that of an ``Answer``, what tyres did, and the state
    at maximum engagement.
    """

    status: Any
    closing_speed: Any = nan
    slip_before: Any = nan
    slip_after: Any = nan
    normal_impulse: Any = nan
    tangential_impulse: Any = nan
    compression_impulse: Any = nan
    no_slip_normal: Any = nan
    no_slip_tangential: Any = nan
    sticks: Any = False
    effective_mass: Any = nan
    coupling: Any = nan
    energy_loss_normal: Any = nan
    energy_loss_tangential: Any = nan
    energy_loss: Any = nan
    impulse_x: Any = nan
    impulse_y: Any = nan
    delta_vx_a: Any = nan
    delta_vy_a: Any = nan
    delta_yaw_rate_a: Any = nan
    delta_vx_b: Any = nan
    delta_vy_b: Any = nan
    delta_yaw_rate_b: Any = nan
    separation_speed: Any = nan
    energy_absorbed: Any = nan
    common_velocity: Any = nan
    compression_vx_a: Any = nan
    compression_vy_a: Any = nan
    compression_yaw_rate_a: Any = nan
    compression_vx_b: Any = nan
    compression_vy_b: Any = nan
    compression_yaw_rate_b: Any = nan
    tyre_impulse_x_a: Any = nan
    tyre_impulse_y_a: Any = nan
    tyre_moment_a: Any = nan
    tyre_loss_a: Any = nan
    tyre_impulse_x_b: Any = nan
    tyre_impulse_y_b: Any = nan
    tyre_moment_b: Any = nan
    tyre_loss_b: Any = nan
    duration: Any = nan
    peak_force: Any = nan
    peak_acceleration_a: Any = nan
    peak_acceleration_b: Any = nan
    max_crush: Any = nan
    # When the bodies were engaged the most, and how far each has gone and turned from the places
    # that were given until they part; the turn as its cosine and sine.
    engaged_time: Any = nan
    moved_x_a: Any = nan
    moved_y_a: Any = nan
    turn_c_a: Any = nan
    turn_s_a: Any = nan
    moved_x_b: Any = nan
    moved_y_b: Any = nan
    turn_c_b: Any = nan
    turn_s_b: Any = nan
    history: Any = None

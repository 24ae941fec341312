"""The vocabulary of the kernels: status codes, the tangential rules, the laws, and the order of their answers."""

OK = 0
ENERGY_GAIN = 1
SEPARATING = 2
GRAZING = 3
IMMOVABLE = 4
SINGULAR_CONTACT = 5
NO_SLIP_PULLS = 6
RATIO_JAMS = 7
OUT_OF_RANGE = 8
NOT_FINITE = 9
NOT_POSITIVE = 10
BAD_RESTITUTION = 11
BAD_FRICTION = 12
BAD_FRACTION = 13
ZERO_NORMAL = 14
PINNED_INFINITE = 15
PINNED_VELOCITY = 16
SPINNING = 17
TRANSVERSE = 18
NO_CLOSING = 19
NOT_SEPARATING = 20
CONTRADICTORY = 21
UNDETERMINED = 22
AMBIGUOUS = 23
AMBIGUOUS_INVERSE = 24
STICK_INVERSE = 25
INVERSE_E0 = 26
INFINITE_MASS = 27
PARALLEL_HEADINGS = 28

FRICTION = "friction"
IMPULSE_RATIO = "impulse_ratio"
CRITICAL_FRACTION = "critical_fraction"
RULES = (FRICTION, IMPULSE_RATIO, CRITICAL_FRACTION)

BRACH = "brach"
KUDLICH_SLIBAR = "kudlich-slibar"
LAWS = (BRACH, KUDLICH_SLIBAR)

EPS = 2.0**-52

# What every kernel returns, in this order: impulses on B along the normal and the tangent, changes of velocity in scene axes.
OUTPUTS = (
    "status",
    "closing_speed",
    "slip_before",
    "slip_after",
    "normal_impulse",
    "tangential_impulse",
    "compression_impulse",
    "no_slip_normal",
    "no_slip_tangential",
    "sticks",
    "effective_mass",
    "coupling",
    "energy_loss_normal",
    "energy_loss_tangential",
    "energy_loss",
    "impulse_x",
    "impulse_y",
    "delta_vx_a",
    "delta_vy_a",
    "delta_yaw_rate_a",
    "delta_vx_b",
    "delta_vy_b",
    "delta_yaw_rate_b",
)
AT = {name: index for index, name in enumerate(OUTPUTS)}

# %% [markdown]
# # Types of eccentric collision
#
# The front of A strikes the front door of B, its rear wing, half of its rear end or half of its
# front end: four types from the paper's figure 12. The impulse passes to one side of a centre of
# mass, so the cars turn. The example shows which way each car turns, that friction can reverse the
# rotation, and how far off a model without rotation is.
#
# The paper, "Application of Impulse Momentum Theory to Vehicle Collisions", treats the contact as
# frictionless (eqs 10 to 19). The positions and speeds here are ours.

# %%
import math

import matplotlib.pyplot as plt

import collisions as col
from collisions import plot

OUTLINE = ("4.4 m", "1.8 m")
A = col.Vehicle(
    mass="1500 kg",
    yaw_inertia="2500 kg*m**2",
    vx="50 km/h",
    x=-2.2,
    y=0.0,
    heading="0 deg",
    name="A",
)
B = A.replace(mass="1200 kg", yaw_inertia="1800 kg*m**2", vx=0.0, name="B")
# B, and the point of contact, which lies on the front of A at x = 0.
TYPES = {
    "front door": (
        B.replace(vy="40 km/h", x=0.9, y=-0.2, heading="90 deg"),
        (0.0, 0.0),
    ),
    "rear wing": (
        B.replace(vy="40 km/h", x=0.9, y=1.3, heading="90 deg"),
        (0.0, 0.0),
    ),
    "offset rear": (
        B.replace(vx="20 km/h", x=2.2, y=-0.9),
        (0.0, -0.45),
    ),
    "offset frontal": (
        B.replace(vx="-40 km/h", x=2.2, y=0.9, heading="180 deg"),
        (0.0, 0.45),
    ),
}


def collide(kind, friction, solver=col.eccentric):
    b, point = TYPES[kind]
    return solver(A, b, 0.1, normal="0 deg", point=point, friction=friction)


# %% [markdown]
# ## Which way they turn
#
# The restitution is 0.1, and yaw is positive counter-clockwise. The last column is the error of
# `oblique_central`, a model in which nothing turns, in delta-V and rotation together, as
# `required_model` measures it.

# %%
print(
    f"{'':<19}{'friction':>9}{'delta-V, km/h':>16}"
    f"{'yaw after, deg/s':>19}{'without rotation':>19}"
)
print(f"{'':<19}{'':>9}{'A':>8}{'B':>8}{'A':>11}{'B':>8}{'off by, km/h':>19}")
for kind in TYPES:
    for friction in (0.0, 0.5):
        impact = collide(kind, friction)
        models = collide(kind, friction, col.required_model)
        off = 3.6 * models.errors["oblique_central"]
        a, b = impact.a, impact.b
        print(
            f"{kind:<19}{friction:>9}{a.delta_v * 3.6:>8.1f}{b.delta_v * 3.6:>8.1f}"
            f"{math.degrees(a.after.yaw_rate):>11.0f}"
            f"{math.degrees(b.after.yaw_rate):>8.0f}{off:>19.1f}"
        )

# %% [markdown]
# Struck ahead of its centre of mass, B turns to the right without friction, and to the left with
# friction, because its side drags along the front of A. Struck on the rear wing, B is turned the
# same way by the normal impulse and by friction. In both cases only friction turns A, because the
# normal goes through A's centre of mass. In the two offset collisions, friction takes most of the
# rotation away.

# %%
figure, axes = plt.subplots(4, 1, figsize=(7, 22), layout="constrained")
for kind, ax in zip(TYPES, axes.flat, strict=True):
    impact = collide(kind, 0.5)
    plot.scene(impact, outline_a=OUTLINE, outline_b=OUTLINE, axes=ax, units="metric")
    ax.set_title(f"{kind}, friction 0.5")

# %% [markdown]
# ## Checks
#
# - Momentum, and angular momentum about a point far from the scene: what one body gives up, the
#   other takes.
# - The energy lost is the kinetic energy before the impact less that after it.
# - The contact points separate at e times the speed at which they met (eq 16 of the paper).
# - Without friction the effective mass at the contact is $1/(1/m_A + 1/m_B + r_A^2/I_A +
#   r_B^2/I_B)$, as in textbooks of dynamics.
# - Two equal cars at equal speeds in the offset frontal collision, without friction: by symmetry
#   each behaves as if it met a wall, so the impulse is $(1 + e)\,v/(1/m + r^2/I)$, and both turn
#   alike.
#
# Each side of a comparison is a sum of a few products; 1e-12 of the whole is a thousand times their
# rounding error.

# %%
FAR = (-30.0, 20.0)


def spin(car):
    """Angular momentum about FAR."""
    return (
        car.mass * ((car.x - FAR[0]) * car.vy - (car.y - FAR[1]) * car.vx)
        + car.yaw_inertia * car.yaw_rate
    )


for kind, (_, point) in TYPES.items():
    for friction in (0.0, 0.5):
        impact = collide(kind, friction)
        a, b = impact.a.before, impact.b.before
        a_after, b_after = impact.a.after, impact.b.after
        size = a.momentum[0]
        for axis in (0, 1):
            given = a.momentum[axis] - a_after.momentum[axis]
            taken = b_after.momentum[axis] - b.momentum[axis]
            assert abs(given - taken) < 1e-12 * size
        left_over = spin(a_after) + spin(b_after) - spin(a) - spin(b)
        assert abs(left_over) < 1e-12 * size * math.hypot(*FAR)
        energy = a.kinetic_energy + b.kinetic_energy
        lost = energy - a_after.kinetic_energy - b_after.kinetic_energy
        assert abs(lost - impact.energy_loss) < 1e-12 * a.kinetic_energy
        met = a.vx - b.vx
        part = b_after.velocity_at(point)[0] - a_after.velocity_at(point)[0]
        assert abs(part - 0.1 * met) < 1e-12 * met
        levers = sum((point[1] - car.y) ** 2 / car.yaw_inertia for car in (a, b))
        if friction == 0.0:
            impulse = 1.1 * met / (1 / a.mass + 1 / b.mass + levers)
            assert math.isclose(impact.normal_impulse, impulse, rel_tol=1e-12)

twin = A.replace(vx="-50 km/h", x=2.2, y=0.9, heading="180 deg")
head_on = col.eccentric(A, twin, 0.1, normal="0 deg", point=(0.0, 0.45), friction=0.0)
impulse = 1.1 * A.vx / (1 / A.mass + 0.45**2 / A.yaw_inertia)
assert math.isclose(head_on.normal_impulse, impulse, rel_tol=1e-12)
yaw_rate = 0.45 * impulse / A.yaw_inertia
for side in (head_on.a, head_on.b):
    assert math.isclose(side.after.yaw_rate, yaw_rate, rel_tol=1e-12)
print("all checks passed")

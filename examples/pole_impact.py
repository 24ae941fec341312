# %% [markdown]
# # A car slides sideways into a pole
#
# A car that has lost its grip slides sideways into a pole, which catches its right side away from
# the centre of mass, and the car turns about the pole. This example shows how to model a fixed
# body, and that the distance off centre decides how much of the speed becomes delta-V and how much
# becomes rotation.
#
# **The scene is invented.** `Vehicle.barrier()` is any body that does not give way. Its position is
# needed only to draw it: the contact point and the normal are all that the solver has to know.

# %%
import math

import matplotlib.pyplot as plt
import numpy as np

import collisions as col
from collisions import plot

RADIUS = 0.15  # m, of the pole
DENTED = 0.65  # m, from the centre of mass to the dented side of the car
POLE = col.Vehicle.barrier(x=0.0, y=0.0, heading=0.0, name="pole")
CAR = col.Vehicle(
    mass="1400 kg",
    yaw_inertia=2300,
    x=-RADIUS - DENTED,
    y=0.0,
    heading="90 deg",
    vx="40 km/h",
    name="car",
)


def struck(ahead, friction=0.5, restitution=0.1):
    """The car against a pole so many metres ahead of its centre of mass.

    Give an array for many such impacts.
    """
    car = CAR.replace(y=-ahead)
    return col.eccentric(
        car, POLE, restitution, normal="0 deg", point=(-RADIUS, 0.0), friction=friction
    )


around = np.radians(np.arange(0, 360, 15))
circle = [(RADIUS * math.cos(angle), RADIUS * math.sin(angle)) for angle in around]
axes = plot.scene(
    struck(0.9), outline_a=("4.4 m", "1.8 m"), outline_b=circle, units="metric"
)

# %% [markdown]
# ## Off centre
#
# The further off centre the pole, the less mass stands behind the contact (`effective_mass`), and
# the more of the speed goes on as rotation and as motion. The energy lost, which dents the car,
# falls too.

# %%
print(
    f"{'pole ahead':>11}{'delta-V':>10}{'yaw after':>11}"
    f"{'speed after':>13}{'energy lost':>13}{'effective mass':>16}"
)
print(f"{'m':>11}{'km/h':>10}{'deg/s':>11}{'km/h':>13}{'kJ':>13}{'kg':>16}")
for ahead in (0.0, 0.45, 0.9, 1.35, 1.8):
    impact = struck(ahead)
    car = impact.q.a
    print(
        f"{ahead:>11.2f}{car.delta_v.m_as('km/h'):>10.1f}"
        f"{car.after.yaw_rate.m_as('deg/s'):>z11.0f}"
        f"{car.after.speed.m_as('km/h'):>13.1f}"
        f"{impact.q.energy_loss.m_as('kJ'):>13.1f}{impact.effective_mass:>16.0f}"
    )

# %% [markdown]
# ## Along the whole side
#
# One call solves all positions of the pole. The thin lines are at the radius of gyration, the
# square root of yaw inertia over mass.

# %%
gyration = math.sqrt(CAR.yaw_inertia / CAR.mass)
ahead = np.linspace(-2.0, 2.0, 401)
FRICTIONS = {
    "without friction": (0.0, "--"),
    "friction 0.5": (0.5, "-"),
    "never slips": (math.inf, ":"),
}
figure, (left, right) = plt.subplots(1, 2, figsize=(8, 4), layout="constrained")
for label, (friction, dashes) in FRICTIONS.items():
    many = struck(ahead, friction)
    left.plot(ahead, many.a.q.delta_v.m_as("km/h"), "k" + dashes, label=label)
    right.plot(ahead, many.a.after.q.yaw_rate.m_as("deg/s"), "k" + dashes)
left.set(xlabel="pole ahead of the centre of mass [m]", ylabel="delta-V [km/h]")
right.set(
    xlabel="pole ahead of the centre of mass [m]", ylabel="yaw rate after [deg/s]"
)
for chart in (left, right):
    for place in (-gyration, gyration):
        chart.axvline(place, color="0.6", linewidth=0.8)
legend = figure.legend(loc="outside lower center", ncols=3)

# %% [markdown]
# Without friction the car turns fastest when the pole is off centre by exactly the radius of
# gyration, and delta-V there is half of what it is at the centre. Here the position of the pole
# deserves more care than the friction or the restitution.
#
# ## Checks
#
# The results are compared with formulas of mechanics, to a few eps (1e-12):
#
# - Without friction, the impulse is (1 + e) m v / (1 + d²/k²), with offset d and radius of gyration
#   k. The yaw rate is (1 + e) v d / (k² + d²), so it is greatest at d = k.
# - Held by the pole without any restitution, the car turns about it: angular momentum about the
#   contact point is conserved, because the impulse has no lever arm there.
# - The energy lost is the kinetic energy that the car has lost, since a pole does no work.

# %%
e, v, k = 0.1, CAR.vx, gyration
plain = struck(ahead, friction=0.0)
assert np.allclose(plain.a.delta_v, (1 + e) * v / (1 + (ahead / k) ** 2), rtol=1e-12)
assert np.allclose(
    plain.a.after.yaw_rate,
    (1 + e) * v * ahead / (k**2 + ahead**2),
    rtol=1e-12,
    atol=1e-12,
)
at_gyration = struck(k, friction=0.0)
assert np.all(at_gyration.a.after.yaw_rate >= plain.a.after.yaw_rate)
assert math.isclose(at_gyration.a.delta_v, 0.5 * (1 + e) * v, rel_tol=1e-12)

held = struck(ahead, friction=math.inf, restitution=0.0)
about_the_pole = CAR.yaw_inertia + CAR.mass * (DENTED**2 + ahead**2)
assert np.allclose(
    about_the_pole * held.a.after.yaw_rate, CAR.mass * v * ahead, rtol=1e-12, atol=1e-9
)

for friction, _ in FRICTIONS.values():
    many = struck(ahead, friction)
    assert np.allclose(
        CAR.kinetic_energy - many.a.after.kinetic_energy, many.energy_loss, rtol=1e-12
    )
print("all checks passed")

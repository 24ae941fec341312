# %% [markdown]
# # A truck against a car
#
# A truck of 12 t and a car of 1.3 t meet head-on, with half the width of the car overlapping the
# truck, and both turn. Both receive the same impulse but not the same delta-V: the delta-Vs are in
# the inverse ratio of the masses, and that of the car stays below what a moving wall would give it.
#
# The model is in the plane of the road: it does not describe a car that goes under the truck.

# %%
import math

import matplotlib.pyplot as plt
import numpy as np

import collisions as col
from collisions import plot

CONTACT = {"normal": "0 deg", "point": (0.0, 0.5), "friction": 0.4}
CAR = col.Vehicle(
    mass="1300 kg",
    yaw_inertia="2000 kg*m**2",
    vx="50 km/h",
    x=-2.0,
    y=0.0,
    heading="0 deg",
    name="car",
)
TRUCK = col.Vehicle(
    mass="12 t",
    yaw_inertia="60000 kg*m**2",
    vx="-40 km/h",
    x=4.0,
    y=1.3,
    heading="180 deg",
    name="truck",
)

impact = col.eccentric(CAR, TRUCK, 0.1, **CONTACT)
print(
    f"closing speed {impact.closing_speed * 3.6:.1f} km/h, contact: {impact.regime}\n"
)
print(
    f"{'':<6}{'impulse':>9}{'delta-V':>9}{'PDOF':>7}{'yaw':>8}"
    f"{'speed after':>13}{'course':>9}{'energy change':>15}"
)
print(
    f"{'':<6}{'kN·s':>9}{'km/h':>9}{'deg':>7}{'deg/s':>8}"
    f"{'km/h':>13}{'deg':>9}{'kJ':>15}"
)
for side in (impact.a, impact.b):
    after, impulse = side.after, math.hypot(side.impulse_x, side.impulse_y)
    print(
        f"{after.name:<6}{impulse / 1000:>9.1f}{side.delta_v * 3.6:>9.1f}"
        f"{math.degrees(side.pdof):>7.0f}{math.degrees(after.yaw_rate):>8.0f}"
        f"{after.speed * 3.6:>13.1f}{math.degrees(after.course):>9.0f}"
        f"{side.kinetic_energy_change / 1000:>15.1f}"
    )

# %% [markdown]
# Yaw is positive counter-clockwise, and the PDOF clockwise from straight ahead. The change in the
# kinetic energy of each vehicle depends on the frame of reference; the energy that both lose
# together does not.
#
# ## The mass of the truck
#
# All masses are solved at once, with an array that starts at the mass of the car. The radius of
# gyration stays the same. The last mass is there for the checks.

# %%
masses = np.array([1.3, 2.0, 3.5, 7.5, 12.0, 20.0, 40.0, 1e12]) * 1000
gyration = TRUCK.yaw_inertia / TRUCK.mass
heavier = col.eccentric(
    CAR, TRUCK.replace(mass=masses, yaw_inertia=gyration * masses), 0.1, **CONTACT
)
wall = col.Vehicle.barrier(vx="-40 km/h", name="moving wall")
limit = col.eccentric(CAR, wall, 0.1, **CONTACT)
print(f"{'truck, t':>10}{'delta-V car':>14}{'delta-V truck':>15}   km/h")
for mass, car, truck in zip(
    masses[:-1] / 1000, heavier.a.delta_v * 3.6, heavier.b.delta_v * 3.6, strict=False
):
    print(f"{mass:>10.1f}{car:>14.1f}{truck:>15.1f}")
print(f"{'wall':>10}{limit.a.delta_v * 3.6:>14.1f}{limit.b.delta_v * 3.6:>15.1f}")

# %%
figure, (above, below) = plt.subplots(
    2, 1, figsize=(7, 10), layout="constrained", height_ratios=(1.3, 1)
)
plot.scene(
    impact,
    outline_a=("4 m", "1.8 m"),
    outline_b=("8 m", "2.5 m"),
    axes=above,
    units="metric",
)
below.plot(masses[:-1] / 1000, heavier.a.delta_v[:-1] * 3.6, "o-", label="car")
below.plot(masses[:-1] / 1000, heavier.b.delta_v[:-1] * 3.6, "s--", label="truck")
below.axhline(
    limit.a.delta_v * 3.6, color="0.4", ls=":", label="car against a wall that moves"
)
below.set(
    xlabel="mass of the truck [t]",
    ylabel="delta-V [km/h]",
    title="The lighter vehicle has the larger delta-V",
    ylim=(0, None),
)
legend = below.legend()

# %% [markdown]
# ## Checks
#
# - Momentum: the delta-Vs are opposite, and in the inverse ratio of the masses.
# - Angular momentum about the contact: the impulse has no lever arm there, so each body keeps its
#   own.
# - The energy lost is the kinetic energy before the impact less that after it.
# - A truck of unlimited mass is a wall: the car has 1.3e-12 of the mass of the last truck, so 1e-11
#   leaves room.
# - For a plastic impact of centre against centre, as in any textbook, the delta-V of the car is the
#   closing speed times the mass of the truck over the mass of both.
#
# The first three hold to 1e-13 of the terms they are made of, a few products of floats.

# %%
for one, other in (
    (impact.a.delta_vx, impact.b.delta_vx),
    (impact.a.delta_vy, impact.b.delta_vy),
):
    assert abs(CAR.mass * one + TRUCK.mass * other) < 1e-13 * CAR.mass * CAR.speed
assert math.isclose(impact.a.delta_v / impact.b.delta_v, 12_000 / 1300, rel_tol=1e-13)


def spin(body):
    """Angular momentum about the contact."""
    x, y = CONTACT["point"]
    return (
        body.mass * ((body.x - x) * body.vy - (body.y - y) * body.vx)
        + body.yaw_inertia * body.yaw_rate
    )


after = impact.a.after, impact.b.after
for before, end in zip((CAR, TRUCK), after, strict=True):
    assert abs(spin(end) - spin(before)) < 1e-13 * TRUCK.mass * TRUCK.speed
energy = CAR.kinetic_energy + TRUCK.kinetic_energy
lost = energy - sum(body.kinetic_energy for body in after)
assert abs(lost - impact.energy_loss) < 1e-13 * energy
assert math.isclose(heavier.a.delta_v[-1], limit.a.delta_v, rel_tol=1e-11)
assert math.isclose(heavier.a.delta_yaw_rate[-1], limit.a.delta_yaw_rate, rel_tol=1e-11)
square = col.linear_central(CAR, TRUCK, 0.0)
plastic = (CAR.vx - TRUCK.vx) * 12_000 / 13_300
assert math.isclose(square.a.delta_v, plastic, rel_tol=1e-13)
print("all checks passed")

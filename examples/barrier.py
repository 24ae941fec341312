# %% [markdown]
# # A car into a rigid barrier
#
# A car hits a rigid wall, first squarely and then at 20 degrees, as it might hit a concrete barrier
# beside the road: once as a point mass and once with its front corner. This example shows the
# effect of restitution and friction in such an impact, and that impact speed, EES and delta-V are
# three different speeds.
#
# The wall is `Vehicle.barrier()`: a body of infinite mass, which takes up any momentum but no
# energy.

# %%
import math

import matplotlib.pyplot as plt

import collisions as col
from collisions import plot, reference

WALL = col.Vehicle.barrier()
OUTLINE = ("4.6 m", "1.8 m")


def kmh(speed):
    return 3.6 * speed


# %% [markdown]
# ## A square impact
#
# The car hits the wall at 56 km/h, with the restitution of one published test of this kind and, for
# comparison, with a plastic impact (restitution 0) and an elastic one (restitution 1).

# %%
published = reference.RESTITUTION_FRONTAL_BARRIER
print(f"restitution {published.typical}: {published.domain}; {published.source}")
car = col.Vehicle(mass="1500 kg", vx="56 km/h", name="car")
squares = [col.linear_central(car, WALL, e) for e in (0.0, published.typical, 1.0)]
print(
    f"{'restitution':>12}{'speed after':>13}{'delta-V':>10}"
    f"{'crush':>8}{'EES':>8}{'lost':>9}"
)
print(f"{'':>12}{'km/h':>13}{'km/h':>10}{'km/h':>8}{'km/h':>8}{'kJ':>9}")
for impact in squares:
    (crush, _), (ees, _) = impact.max_crush_speeds(share_a=1.0), impact.ees(share_a=1.0)
    print(
        f"{impact.restitution:>12}{kmh(impact.a.after.vx):>13.1f}"
        f"{kmh(impact.a.delta_v):>10.1f}{kmh(crush):>8.1f}"
        f"{kmh(ees):>8.1f}{impact.energy_loss / 1000:>9.1f}"
    )

# %% [markdown]
# The speed of maximum crush (column "crush") is the impact speed, whatever the restitution: at full
# crush the car stands still, and all its energy is in the crush. Restitution then returns part of
# that energy, which makes the delta-V larger and the energy loss smaller. The EES of ISO 12353
# stands for the energy lost.
#
# ## At 20 degrees
#
# The car travels along x at 80 km/h. The wall, on its left, runs at -20 degrees, so the normal from
# the car into the wall is at 70 degrees. The car is first a point mass; it then strikes with its
# front left corner, 2.3 m ahead of the centre of mass and 0.9 m to the left of it.

# %%
NORMAL, ANGLE = "70 deg", math.radians(20)
slanted = car.replace(
    vx="80 km/h", yaw_inertia="2600 kg*m**2", x=0.0, y=0.0, heading="0 deg"
)
corner = slanted.point(forward="2.3 m", left="0.9 m")
points = {
    mu: col.oblique_central(slanted, WALL, 0.1, normal=NORMAL, friction=mu)
    for mu in (0.0, 0.3, 0.6)
}
corners = {
    mu: col.eccentric(slanted, WALL, 0.1, normal=NORMAL, point=corner, friction=mu)
    for mu in (0.0, 0.3, 0.6)
}
print(
    f"{'':<8}{'friction':>9}{'speed after':>13}{'course':>9}{'yaw':>8}"
    f"{'delta-V':>10}{'crush':>7}{'lost':>7}{'by friction':>13}"
)
print(
    f"{'':<8}{'':>9}{'km/h':>13}{'deg':>9}{'deg/s':>8}"
    f"{'km/h':>10}{'km/h':>7}{'kJ':>7}{'kJ':>13}"
)
for label, family in (("point", points), ("corner", corners)):
    for mu, impact in family.items():
        after, (crush, _) = impact.a.after, impact.max_crush_speeds(share_a=1.0)
        print(
            f"{label:<8}{mu:>9}{kmh(after.speed):>13.1f}"
            f"{math.degrees(after.course):>9.1f}{math.degrees(after.yaw_rate):>8.0f}"
            f"{kmh(impact.a.delta_v):>10.1f}{kmh(crush):>7.1f}"
            f"{impact.energy_loss / 1000:>7.1f}"
            f"{impact.energy_loss_tangential / 1000:>13.1f}"
        )

# %% [markdown]
# The speed of maximum crush does not include the speed along the wall. It is the speed along the
# normal: 80 sin 20° = 27 km/h for a point mass. When the corner strikes, the car gives way by
# turning, and both crush and delta-V are smaller. Friction alone would turn it the other way; here
# it is not enough to do so.

# %%
figure, axes = plt.subplots(2, 1, figsize=(7, 11), layout="constrained")
plot.scene(corners[0.3], outline_a=OUTLINE, axes=axes[0], units="metric")
plot.impulse_plane(corners[0.3], axes=axes[1], units="metric")

# %% [markdown]
# ## Checks
#
# - Square: v' = -e v (Example 1 of the paper), delta-V (1 + e) v, speed of maximum crush = v, loss
#   m v² (1 - e²)/2 = m EES²/2.
# - A point mass that arrives at an angle b to the normal leaves at an angle a, with tan a = (tan
#   b)/e - mu/e - mu. An answer at askiitians.com/forums/Mechanics/10/1618 derives this for a ball
#   on a plate; here b = 70 degrees, and the contact slides.
# - The impulse acts at the corner, so about the corner the angular momentum of the car is
#   unchanged, whatever the friction.
# - The energy lost is the kinetic energy of the car before the impact less that after it.
#
# Each figure is a few products of floats, each good to 1e-16. A tolerance of 1e-13 of the size of
# the terms leaves room for these, even for the tangent of 70 degrees, which is divided by e = 0.1.

# %%
for impact in squares:
    e, v = impact.restitution, car.vx
    assert math.isclose(impact.a.after.vx, -e * v, rel_tol=1e-13)
    assert math.isclose(impact.a.delta_v, (1 + e) * v, rel_tol=1e-13)
    assert math.isclose(impact.max_crush_speeds(1.0)[0], v, rel_tol=1e-13)
    assert math.isclose(impact.ees(1.0)[0], v * math.sqrt(1 - e**2), rel_tol=1e-13)
    lost = 0.5 * car.mass * v**2 * (1 - e**2)
    assert math.isclose(impact.energy_loss, lost, rel_tol=1e-13)


def about_corner(body):
    """Angular momentum about the corner."""
    return (
        body.mass * ((body.x - corner[0]) * body.vy - (body.y - corner[1]) * body.vx)
        + body.yaw_inertia * body.yaw_rate
    )


for mu in points:
    leaves = points[mu].a.after.course + ANGLE  # from the wall
    tan_a = (1 / math.tan(ANGLE) - mu) / 0.1 - mu
    assert math.isclose(1 / math.tan(-leaves), tan_a, rel_tol=1e-13)
    for impact in (points[mu], corners[mu]):
        lost = slanted.kinetic_energy - impact.a.after.kinetic_energy
        assert abs(lost - impact.energy_loss) < 1e-13 * slanted.kinetic_energy
    size = slanted.mass * slanted.vx * math.hypot(*corner)
    assert abs(about_corner(corners[mu].a.after) - about_corner(slanted)) < 1e-13 * size
print("all checks passed")

# %% [markdown]
# # Types of collision at crossroads
#
# Two cars meet at crossroads in four ways, the subject of the paper's figure 8: from the side,
# corner to corner, merging, and turning left across the oncoming lane. The cars and their speeds
# are the same in all four. What makes the difference is the closing speed along the line of impact,
# and whether the contact slips.
#
# "Application of Impulse Momentum Theory to Vehicle Collisions" solves such cases as oblique
# central impacts: the line of impact goes through both centres of mass, so neither car turns. The
# positions and speeds here are ours. "Types of eccentric collision" shows what changes when the
# impulse passes to one side of the centre of mass.

# %%
import math

import matplotlib.pyplot as plt

import collisions as col
from collisions import plot

OUTLINE = ("4.4 m", "1.8 m")
COURSES = {  # of B, in degrees
    "from the side": 90,
    "corner to corner": 90,
    "merging": 40,
    "turning left": 225,
}
PLACES = {
    "from the side": (3.1, 0.0),
    "corner to corner": (3.1, -3.1),
    "merging": (-1.58, -3.0),
    "turning left": (4.39, 1.82),
}
A = col.Vehicle(mass="1500 kg", vx="50 km/h", x=0.0, y=0.0, heading="0 deg", name="A")


def collide(kind, restitution, friction):
    """A goes east through the origin; the normal runs from centre to centre, A to B."""
    course, (x, y) = f"{COURSES[kind]} deg", PLACES[kind]
    b = col.Vehicle.from_speed(mass="1200 kg", speed="40 km/h", course=course, name="B")
    b = b.replace(x=x, y=y, heading=course)
    return col.oblique_central(A, b, restitution, normal=(x, y), friction=friction)


# %% [markdown]
# ## One pair of cars, four collisions
#
# The restitution is 0.1. The paper's contact is frictionless, and leaves the velocity along the
# contact unchanged. In the other half of the table the contact is not slipping at separation. A
# real contact lies between the two: `friction=0.5`, say.

# %%
print(
    f"{'':<16}{'closing':>8}{'slip':>7}"
    f"    {'frictionless: delta-V':<27}{'no slip: delta-V':<24}"
)
print(
    f"{'':<16}{'':>8}{'':>7}"
    f"{'A':>8}{'B':>7}{'course B':>10}{'A':>10}{'B':>7}{'course B':>10}"
)
units = f"{'km/h':>8}{'km/h':>7}{'deg':>10}"
print(f"{'':<16}{'km/h':>8}{'km/h':>7}{units}  {units}")
for kind in COURSES:
    cases = [collide(kind, 0.1, friction) for friction in (0.0, math.inf)]
    cells = "  ".join(
        f"{case.a.delta_v * 3.6:>8.1f}{case.b.delta_v * 3.6:>7.1f}"
        f"{math.degrees(case.b.after.course):>10.0f}"
        for case in cases
    )
    closing, slip = cases[0].closing_speed * 3.6, abs(cases[0].slip_before) * 3.6
    print(f"{kind:<16}{closing:>8.1f}{slip:>7.1f}{cells}")

# %% [markdown]
# The same 50 and 40 km/h make a light touch when merging and a violent collision when turning left.
# Delta-V follows the closing speed if the contact is frictionless. If it does not slip, the speed
# along the contact counts as well.

# %%
figure, axes = plt.subplots(4, 1, figsize=(7, 22), layout="constrained")
for kind, ax in zip(COURSES, axes.flat, strict=True):
    impact = collide(kind, 0.1, 0.5)
    plot.scene(impact, outline_a=OUTLINE, outline_b=OUTLINE, axes=ax, units="metric")
    ax.set_title(f"{kind}, friction 0.5")

# %% [markdown]
# ## Checks
#
# - Frictionless: the impulse is (1 + e) times the reduced mass times the closing speed, and the
#   speed along the contact does not change (eqs 5, 6 and 9 of the paper).
# - Plastic and without slip, which textbooks call locked together: both cars leave with one
#   velocity, their total momentum over their total mass, and the energy lost is half the reduced
#   mass times the square of the relative velocity.
# - OpenStax, University Physics volume 1, section 9.5, "Traffic Collision": a car of 1200 kg going
#   east at 60 km/h and a truck of 3000 kg going north at 40 km/h lock together and leave at 9.25
#   m/s, or 33.3 km/h, in a direction of 59 degrees. The text calls this east of north; by the
#   components it prints, 4.76 m/s east and 7.93 m/s north, it is north of east.
#
# A few rounding errors of 1e-16 each stay below 1e-13 of the speeds. The book rounds its
# intermediate results to 0.01 m/s; its figures in km/h and degrees are met to half a unit of the
# last digit.

# %%
for kind in COURSES:
    smooth, locked = collide(kind, 0.1, 0.0), collide(kind, 0.0, math.inf)
    a, b = smooth.a.before, smooth.b.before
    whole, (nx, ny) = a.mass + b.mass, smooth.normal
    reduced = a.mass * b.mass / whole
    closing = (a.vx - b.vx) * nx + (a.vy - b.vy) * ny
    together = (
        (a.mass * a.vx + b.mass * b.vx) / whole,
        (a.mass * a.vy + b.mass * b.vy) / whole,
    )
    for side in (smooth.a, smooth.b):
        delta_v = 1.1 * reduced * closing / side.before.mass
        assert math.isclose(side.delta_v, delta_v, rel_tol=1e-13)
        assert abs(side.delta_vy * nx - side.delta_vx * ny) < 1e-13 * side.before.speed
    for after in (locked.a.after, locked.b.after):
        assert math.dist((after.vx, after.vy), together) < 1e-13 * a.speed
    lost = 0.5 * reduced * math.dist((a.vx, a.vy), (b.vx, b.vy)) ** 2
    assert math.isclose(locked.energy_loss, lost, rel_tol=1e-13)

car, truck = col.Vehicle(mass=1200, vx="60 km/h"), col.Vehicle(mass=3000, vy="40 km/h")
wreck = col.oblique_central(car, truck, 0.0, normal="45 deg", friction=math.inf).a.after
assert abs(wreck.speed - 9.25) < 0.01
assert abs(wreck.speed * 3.6 - 33.3) < 0.05
assert abs(math.degrees(wreck.course) - 59) < 0.5
assert math.dist((wreck.vx, wreck.vy), (4.76, 7.93)) < 0.01
print("all checks passed")

# %% [markdown]
# # A pole after a side impact
#
# A hatchback is struck in its side, behind its centre of mass. It turns, slides across the road and
# goes sideways into a pole. That is one scene: followed forward it says how hard either impact was,
# and taken backward, from where the cars stood, how fast both were before. The case is invented.

# %%

import math

import numpy as np

import collisions as col
from collisions import plot
from collisions.reconstruct import fit
from collisions.scene import Contact, Mover, Scene
from collisions.travel import Tyres
from collisions.uncertainty import Interval, Normal

KMH = 3.6

# %% [markdown]
# ## Forward
#
# Both cars stand on four wheels: those of the saloon are locked, and of the hatchback the wheel at
# the rear left, which the blow jammed; the others roll. The first contact is at time 0, where the
# states are given. The pole is a mover that stays: the second contact comes when the outlines meet.

# %%
hatchback = col.Vehicle(
    mass="1350 kg",
    yaw_inertia=2200,
    x="0 m",
    y="0 m",
    heading="0 deg",
    vx="50 km/h",
)
saloon = col.Vehicle(
    mass="1600 kg",
    yaw_inertia=2700,
    x="-0.6 m",
    y="-2.95 m",
    heading="90 deg",
    vy="40 km/h",
)
crash = Scene(
    movers={
        "Hatchback": Mover(
            hatchback,
            outline=("4.2 m", "1.75 m"),
            tyres=Tyres(0.75, [0.03, 0.03, 0.7, 0.03], "2.6 m", "1.5 m"),
        ),
        "Saloon": Mover(
            saloon,
            outline=("4.6 m", "1.8 m"),
            tyres=Tyres(0.75, 1, "2.75 m", "1.55 m"),
        ),
        "Pole": Mover(
            col.Vehicle.barrier(x=5, y=2.3, heading=0), outline=("0.3 m", "0.3 m")
        ),
    },
    contacts=[
        Contact(
            "Saloon",
            "Hatchback",
            restitution=0.1,
            friction=0.5,
            normal="90 deg",
            point=("-0.6 m", "-0.7 m"),
        ),
        Contact("Hatchback", "Pole", restitution=0.1, friction=0.5, at="touch"),
    ],
    shared={"road": ("Hatchback.tyres.friction", "Saloon.tyres.friction")},
)
run = crash.run()
print(run.summary("metric"))

# %%
plot.scene(run, units="metric")

# %% [markdown]
# ## Backward
#
# Where both cars stood was measured to 0.2 m, and how the hatchback stood to 6 degrees. From that
# both speeds are sought, with a friction of the road that is known to 0.05. Of the speeds only wide
# bounds are stated. `fit` gives each with its range. Where more is not known, as the restitution or
# the point of the first contact, `posterior` takes the same scene, evidence and paths, and minutes.

# %%
evidence = {
    "Hatchback.rest.x": ("3.9 m", "0.2 m"),
    "Hatchback.rest.y": ("2.1 m", "0.2 m"),
    "Hatchback.rest.heading": ("-92 deg", "6 deg"),
    "Saloon.rest.x": ("0.5 m", "0.2 m"),
    "Saloon.rest.y": ("0.5 m", "0.2 m"),
}
unknown = {
    "Hatchback.speed": Interval("10 km/h", "100 km/h"),
    "Saloon.speed": Interval("10 km/h", "100 km/h"),
    "road": Normal(0.75, 0.05),
}
found = fit(crash, unknown, evidence)
for name in ("Hatchback.speed", "Saloon.speed"):
    low, high = (KMH * end for end in found[name].interval(0.95))
    best = KMH * found[name].value
    print(f"{name}: {best:.0f} km/h, from {low:.0f} to {high:.0f} km/h (95 %)")
print(*found.statements, sep="\n")

# %% [markdown]
# ## Checks
#
# - Both speeds that the places of rest were made of lie in the ranges that were found.
# - No momentum is lost between the cars. Of the hatchback at the pole, the angular momentum about
#   the point of contact is the same before and after, as the impulse goes through that point.
# - The energy of the start is that which the contacts and the ground took.
# - The way of the saloon, on locked wheels, is integrated again from right after its impact: each
#   wheel carries a quarter of the weight and is held back by friction against its motion.

# %%
for name, speed in (("Hatchback.speed", 50), ("Saloon.speed", 40)):
    low, high = found[name].interval(0.95)
    assert low < speed / KMH < high

side, pole = run.impacts
for axis in ("vx", "vy"):
    before, after = (
        1600 * getattr(getattr(side.a, when), axis)
        + 1350 * getattr(getattr(side.b, when), axis)
        for when in ("before", "after")
    )
    assert math.isclose(before, after, rel_tol=1e-9, abs_tol=1e-6)
x, y = pole.point
about = [
    1350 * ((car.x - x) * car.vy - (car.y - y) * car.vx) + 2200 * car.yaw_rate
    for car in (pole.a.before, pole.a.after)
]
assert math.isclose(*about, rel_tol=1e-9)

start = 0.5 * 1350 * (50 / KMH) ** 2 + 0.5 * 1600 * (40 / KMH) ** 2
lost = side.energy_loss + pole.energy_loss + run.energy["ground"]
assert math.isclose(start, lost, rel_tol=2e-3)

G, STEP = 9.80665, 2e-4
car = side.a.after
state = np.array([car.x, car.y, car.heading, car.vx, car.vy, car.yaw_rate])
arms = [(2.75 / 2 * i, 1.55 / 2 * j) for i in (1, -1) for j in (1, -1)]


def slope(state):
    """The rates of place and velocity, by Coulomb's friction at four locked wheels."""
    _, _, heading, vx, vy, turning = state
    fx = fy = moment = 0.0
    for ahead, left in arms:
        rx = ahead * math.cos(heading) - left * math.sin(heading)
        ry = ahead * math.sin(heading) + left * math.cos(heading)
        ux, uy = vx - turning * ry, vy + turning * rx
        push = -0.75 * 1600 * G / 4 / max(math.hypot(ux, uy), 0.02)
        fx, fy = fx + push * ux, fy + push * uy
        moment += push * (rx * uy - ry * ux)
    return np.array([vx, vy, turning, fx / 1600, fy / 1600, moment / 2700])


for _ in range(round(3.0 / STEP)):
    middle = state + 0.5 * STEP * slope(state)
    state = state + STEP * slope(middle)
rest = run.rest["Saloon"]
assert math.hypot(state[0] - rest.x, state[1] - rest.y) < 0.01
assert abs(state[2] - rest.heading) < math.radians(1)
print("all checks passed")

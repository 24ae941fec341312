# %% [markdown]
# # A pole after a side impact
#
# A hatchback is struck in its side, behind its centre of mass. It turns, slides across the road and
# goes sideways into a pole. That is one scene: followed forward it says how hard either impact was,
# and taken backward, from where the cars stood, how fast both were. The case is invented.

# %%

import collisions as col
from collisions import plot
from collisions.reconstruct import posterior
from collisions.scene import Contact, Mover, Scene
from collisions.travel import Tyres
from collisions.uncertainty import Normal, Uniform

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
# What was found: where both cars stood, and how the hatchback stood. What is not known: both
# speeds, of which hardly anything is said beforehand, and within ranges the friction of the road
# and the restitution, the friction and the place of the first contact.

# %%
unknown = {
    "Hatchback.speed": Uniform("10 km/h", "90 km/h"),
    "Saloon.speed": Uniform("10 km/h", "90 km/h"),
    "road": Normal(0.75, 0.05),
    "contacts[0].restitution": Normal(0.1, 0.05, truncate=(0, 1)),
    "contacts[0].friction": Normal(0.5, 0.1, truncate=(0, None)),
    "contacts[0].point[0]": Normal("-0.6 m", "0.1 m"),
}
stood = run.rest
evidence = {
    "Hatchback.rest.x": (round(stood["Hatchback"].x, 1), 0.2),
    "Hatchback.rest.y": (round(stood["Hatchback"].y, 1), 0.2),
    "Hatchback.rest.heading": (round(stood["Hatchback"].heading, 1), 0.1),
    "Saloon.rest.x": (round(stood["Saloon"].x, 1), 0.2),
    "Saloon.rest.y": (round(stood["Saloon"].y, 1), 0.2),
}
print(evidence)
import time

t0 = time.time()
found = posterior(crash, unknown, evidence, samples=512, seed=1)
print(time.time() - t0)
print(found.summary("metric"))

# %% [markdown]
# # Speeds from the places of rest alone
#
# Two cars met at a crossing and slid to rest with locked wheels. Of the crash itself nobody knows
# more than where they met, which way they came from, and where they stand now. Everything else is
# a range: both speeds from 0 to 90 mph, the friction of the road and of the contact, the
# restitution, the masses, and the line of impact. What is sought are the speeds before, and how
# sure they are. All numbers are invented; the places of rest were made with known speeds, which
# are printed at the end.

# %%
import math
import warnings

import matplotlib.pyplot as plt
import numpy as np

import collisions as col
from collisions import plot, reconstruct
from collisions.scene import Contact, Mover, Scene
from collisions.uncertainty import Normal, Uniform

MPH = 0.44704

# %% [markdown]
# ## The scene
#
# The numbers in it are those that were stated first; each that is not known exactly gets its range
# below. Both cars slid on the same road, so that their drag is one number, "road".

# %%
a = col.Vehicle.from_speed(
    mass="1500 kg",
    yaw_inertia=2600,
    speed="30 mph",
    course="0 deg",
    heading="0 deg",
    x="-2.2 m",
    y="0.3 m",
)
b = col.Vehicle.from_speed(
    mass="1200 kg",
    yaw_inertia=2000,
    speed="30 mph",
    course="90 deg",
    heading="90 deg",
    x="0.9 m",
    y="-0.6 m",
)
crash = Scene(
    movers={
        "A": Mover(a, outline=("4.4 m", "1.8 m"), drag=0.7),
        "B": Mover(b, outline=("4.2 m", "1.7 m"), drag=0.7),
    },
    contacts=[
        Contact("A", "B", restitution=0.1, friction=0.5, normal="0 deg", point=(0, 0.1))
    ],
    shared={"road": ("A.drag", "B.drag")},
)
known_before = {
    "A.speed": Uniform("0 mph", "90 mph"),
    "B.speed": Uniform("0 mph", "90 mph"),
    "A.course": Normal("0 deg", "2 deg"),
    "B.course": Normal("90 deg", "2 deg"),
    "A.mass": Normal("1500 kg", "40 kg"),
    "B.mass": Normal("1200 kg", "40 kg"),
    "contacts[0].restitution": Uniform(0.0, 0.3),
    "contacts[0].friction": Normal.between(0.3, 0.8, 0.95),
    "contacts[0].normal": Normal("0 deg", "5 deg"),
    "road": Normal.between(0.6, 0.8, 0.95),
}

# %% [markdown]
# ## What was found
#
# The places of rest, read from photographs to half a metre. Here they come from a run with speeds
# that nothing below knows of.

# %%
TRUTH = {"A.speed": "41 mph", "B.speed": "27 mph", "road": 0.68}
rest = crash.replace(TRUTH).run().rest
observed = {
    f"{name}.rest.{axis}": Normal(f"{getattr(rest[name], axis):.1f} m", "0.5 m")
    for name in "AB"
    for axis in "xy"
}
for name, reading in observed.items():
    print(f"{name}: {reading}")

# %% [markdown]
# ## Back to the speeds
#
# A scene is a model: the inputs and results are named by their paths. In some samples the cars
# come together again as they slide, side against side, which the one contact at time 0 does not
# describe. It is a warning and a statement, with their number: so much of the probability is in
# doubt.

# %%
with warnings.catch_warnings():
    # Printed below with the other statements.
    warnings.simplefilter("ignore", col.OutOfRangeWarning)
    found = reconstruct.posterior(crash, known_before, observed, samples=1024, seed=1)
for name in ("A.speed", "B.speed"):
    low, high = (speed / MPH for speed in found[name].interval())
    print(
        f"{name}: {found[name].mean / MPH:.1f} mph, 95 % from {low:.1f} to {high:.1f}"
    )
for sentence in found.statements:
    print("-", sentence)

# %% [markdown]
# The road decides how wide the answer is: of the drag the places of rest say nothing, and both
# speeds rise with it. The line below is the same crash, on roads of any drag in the range.

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.4), layout="constrained")
speeds = {name: found.draws[f"{name}.speed"] / MPH for name in "AB"}
shown = left.scatter(
    speeds["A"], speeds["B"], c=found.draws["road"], s=8, cmap="cividis"
)
left.plot(41, 27, "x", color="C3", ms=10, mew=2)
left.set(xlabel="speed of A [mph]", ylabel="speed of B [mph]")
figure.colorbar(shown, ax=left, label="drag of the road")
nearest = int(np.argmin(sum((v - np.median(v)) ** 2 for v in speeds.values())))
likely = crash.replace(
    {name: float(found.draws[name][nearest]) for name in known_before}
)
plot.scene(likely.run(), axes=right, units="us")

# %% [markdown]
# ## Checks
#
# - The ranges hold the speeds with which the places of rest were made, and the masses of both cars
#   are those that were stated: the evidence says next to nothing of them.
# - By hand: with the drag of the run, the speeds just after the impact follow from the ways to
#   rest, and momentum along x and y gives the speeds before, within the error of half a metre.

# %%
for name, truth in (("A.speed", 41.0), ("B.speed", 27.0)):
    low, high = found[name].interval()
    assert low / MPH < truth < high / MPH
assert {"A.mass", "B.mass"} <= set(found.prior_only)
assert found.consistent
(again,) = [text for text in found.statements if "no contact says what happens" in text]
assert 50 < int(again.split()[0]) < 200
after = {
    name: math.sqrt(
        2 * 0.68 * 9.80665 * math.hypot(rest[name].x - start.x, rest[name].y - start.y)
    )
    for name, start in (("A", a), ("B", b))
}
along = {
    name: (
        after[name] * (rest[name].x - start.x),
        after[name] * (rest[name].y - start.y),
        math.hypot(rest[name].x - start.x, rest[name].y - start.y),
    )
    for name, start in (("A", a), ("B", b))
}
momentum = [
    sum(
        mass * along[name][axis] / along[name][2]
        for name, mass in (("A", 1500), ("B", 1200))
    )
    for axis in (0, 1)
]
assert math.isclose(momentum[0] / 1500 / MPH, 41.0, rel_tol=1e-3)
assert math.isclose(momentum[1] / 1200 / MPH, 27.0, rel_tol=1e-3)
print("all checks passed")

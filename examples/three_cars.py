# %% [markdown]
# # Three cars in a row
#
# The rear car runs into the middle car, and the middle car into the front car, which is standing. A
# scene has the cars and what happens when two of them meet; in which order they meet, and how
# often, comes out. The two scenes differ only in the gaps between the cars. The gaps decide the
# order of the impacts, and the order decides which car is struck from which side, and how hard.

# %%
import itertools
import math

import matplotlib.pyplot as plt
import numpy as np

import collisions as col
from collisions.scene import Contact, Mover, Scene

LENGTH, NAMES = 4.4, ("rear", "middle", "front")


def row(behind, ahead, restitution=0.2, masses=(1500, 1200, 1400), speeds=(60, 30, 0)):
    """Three cars that roll, the front one at 0; gaps in m from rear to front."""
    xs = (-2 * LENGTH - behind - ahead, -LENGTH - ahead, 0.0)
    movers = {
        name: Mover(
            col.Vehicle(mass=mass, vx=speed / 3.6, x=x, y=0, heading=0),
            outline=(LENGTH, 1.8),
        )
        for name, mass, speed, x in zip(NAMES, masses, speeds, xs, strict=True)
    }
    bumper = {"normal": 0, "model": "linear_central", "at": "touch"}
    pairs = itertools.pairwise(movers)
    contacts = [Contact(*pair, restitution=restitution, **bumper) for pair in pairs]
    return Scene(movers=movers, contacts=contacts)


# %% [markdown]
# ## The same speeds, two orders
#
# The rear car travels at 60 km/h and the middle one at 30 km/h; the front one is standing. The
# restitution is 0.2, and nobody brakes.

# %%
SCENES = {"gap ahead of the middle car": row(1.0, 4.0), "gap behind it": row(4.0, 1.0)}
runs = {label: scene.run() for label, scene in SCENES.items()}
for label, run in runs.items():
    print(f"{label}\n{'':<18}{'at':>6}{'closing':>10}{'delta-V, km/h':>21}{'lost':>8}")
    print(f"{'':<18}{'s':>6}{'km/h':>10}{'striking':>12}{'struck':>9}{'kJ':>8}")
    for time, pair, impact in zip(run.times, run.pairs, run.impacts, strict=True):
        striking, struck = (side.delta_v_forward * 3.6 for side in (impact.a, impact.b))
        print(
            f"{' and '.join(pair):<18}{time:>6.2f}{impact.closing_speed * 3.6:>10.1f}"
            f"{striking:>+12.1f}{struck:>+9.1f}{impact.energy_loss / 1000:>8.1f}"
        )
    after = ", ".join(f"{name} {car.vx * 3.6:.1f}" for name, car in run.at(5).items())
    print(f"after: {after} km/h\n")

# %% [markdown]
# With the larger gap ahead of it, the middle car is first thrown forward and then slowed by its
# hardest impact, which is also the hardest for the front car. With the larger gap behind it, the
# middle car is first slowed, and its hardest impact comes from behind. The final speeds are nearly
# the same in both scenes, so they do not tell which order it was.

# %%
figure, axes = plt.subplots(2, 1, figsize=(7, 9), sharex=True, layout="constrained")
for ax, (label, run) in zip(axes, runs.items(), strict=True):
    clocks = np.linspace(0.0, run.times[-1] + 0.3, 200)
    states = [run.at(float(clock)) for clock in clocks]
    for name, hatch in zip(SCENES[label].movers, ("//", "..", "\\\\"), strict=True):
        middles = np.array([state[name].x for state in states])
        style = {"alpha": 0.45, "hatch": hatch, "edgecolor": "white", "label": name}
        ax.fill_between(clocks, middles - LENGTH / 2, middles + LENGTH / 2, **style)
    for time in run.times:
        ax.axvline(time, color="0.3", lw=0.8, ls=":")
    ax.set(title=label, ylabel="position along the road [m]")
axes[0].legend(loc="lower right", title="back to front")
axes[1].set_xlabel("time [s] (dotted: an impact)")

# %% [markdown]
# ## A thousand gaps at once
#
# Arrays in a scene are many cases, each with an order of its own.

# %%
random = np.random.default_rng(1)
behind, ahead = random.uniform(0.5, 6.0, (2, 1000))
many = row(behind, ahead).run()
first = many.times[0]
rear_first = np.isclose(first, behind / (30 / 3.6))
print(f"the rear car is in the first impact in {rear_first.mean():.0%} of the cases")

# %% [markdown]
# ## Checks
#
# - The momentum of the three cars is unchanged, and their kinetic energy falls by what the impacts
#   lose.
# - With equal cars, elastic impacts and two cars standing, the last car takes all the speed
#   (Newton's cradle).
# - Cambridge Pre-U 9794/3, question 10 (a.simonm.io/questions?module=Pre-U+9794%2F3): particles of
#   1, 2 and 5 kg are a metre apart, the restitution is 0.5, and the first moves at 14 m/s. The
#   candidate is to show that the first comes to rest and that the second rebounds from the third.
#   Worked by hand, the second comes back at 0.5 m/s, and the third leaves at 3 m/s.
# - Of the thousand cases, the first impact comes when the smaller of both gaps closes.
#
# There are only a handful of impacts, each with a few rounding errors of 1e-16, so 1e-12 of the
# whole leaves room.

# %%
for run in runs.values():
    before, after = run.at(0).values(), run.at(5).values()
    momentum = sum(car.momentum[0] for car in before)
    assert math.isclose(sum(car.momentum[0] for car in after), momentum, rel_tol=1e-12)
    energy = run.energy
    lost = energy["before"] - energy["left"]
    assert abs(lost - sum(energy["contacts"])) < 1e-12 * energy["before"]
    assert energy["ground"] == 0.0

cradle = row(1.0, 1.0, restitution=1.0, masses=(1000,) * 3, speeds=(36, 0, 0)).run()
speeds = [car.vx for car in cradle.at(5).values()]
assert all(
    abs(v - wanted) < 1e-12 for v, wanted in zip(speeds, (0, 0, 10), strict=True)
)

exam = row(1.0, 1.0, restitution=0.5, masses=(1, 2, 5), speeds=(50.4, 0, 0)).run()
one, two = exam.impacts[:2]
for car, speed in ((one.a, 0.0), (one.b, 7.0), (two.a, -0.5), (two.b, 3.0)):
    assert abs(car.after.vx - speed) < 1e-12

assert np.allclose(first, np.minimum(behind, ahead) / (30 / 3.6), rtol=1e-9)
print("all checks passed")

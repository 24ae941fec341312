# %% [markdown]
# # A chain of three cars, front to back
#
# The rear car runs into the middle car, and the middle car into the front car, which is standing.
# The state of a car after one impact is its state before the next, until no car catches up with
# another. The two scenes differ only in the gaps between the cars. The gaps decide the order of the
# impacts, and the order decides which car is struck from which side, and how hard.

# %%
import itertools
import math

import matplotlib.pyplot as plt

import collisions as col
from collisions import plot

LENGTH = 4.4


def chain(cars, restitution):
    """Let cars in line roll and collide: times and positions, impacts, final cars."""
    clock, track, impacts = 0.0, [(0.0, [car.x for car in cars])], []
    while True:
        # How long each car needs to reach the one ahead of it.
        waits = [
            (max(ahead.x - behind.x - LENGTH, 0.0) / (behind.vx - ahead.vx), index)
            for index, (behind, ahead) in enumerate(itertools.pairwise(cars))
            if behind.vx > ahead.vx
        ]
        if not waits:
            return track, impacts, cars
        wait, first = min(waits)
        clock += wait
        cars = [car.replace(x=car.x + wait * car.vx) for car in cars]
        impact = col.linear_central(cars[first], cars[first + 1], restitution)
        cars[first : first + 2] = impact.a.after, impact.b.after
        track.append((clock, [car.x for car in cars]))
        impacts.append(impact)


def row(behind, ahead):
    """The three cars before, front one at 0; gaps behind and ahead of the middle."""
    middle = -LENGTH - ahead
    rear = middle - LENGTH - behind
    return [
        col.Vehicle(mass=mass, vx=vx, x=x, y=0.0, heading="0 deg", name=name)
        for name, mass, vx, x in (
            ("rear", "1500 kg", "60 km/h", rear),
            ("middle", "1200 kg", "30 km/h", middle),
            ("front", "1400 kg", 0.0, 0.0),
        )
    ]


# %% [markdown]
# ## The same speeds, two orders
#
# The rear car travels at 60 km/h and the middle one at 30 km/h; the front one is standing. The
# restitution is 0.2, and nobody brakes. A delta-V is positive forward.

# %%
SCENES = {
    "gap ahead of the middle car": row(1.0, 4.0),
    "gap behind the middle car": row(4.0, 1.0),
}
played = {label: chain(cars, 0.2) for label, cars in SCENES.items()}
for label, (track, impacts, cars) in played.items():
    print(f"{label}\n{'':<16}{'at':>6}{'closing':>10}{'delta-V, km/h':>21}{'lost':>8}")
    print(f"{'':<16}{'s':>6}{'km/h':>10}{'striking':>12}{'struck':>9}{'kJ':>8}")
    for (clock, _), impact in zip(track[1:], impacts, strict=True):
        who = f"{impact.a.before.name}, {impact.b.before.name}"
        striking, struck = (side.delta_v_forward * 3.6 for side in (impact.a, impact.b))
        print(
            f"{who:<16}{clock:>6.2f}{impact.closing_speed * 3.6:>10.1f}"
            f"{striking:>+12.1f}{struck:>+9.1f}{impact.energy_loss / 1000:>8.1f}"
        )
    speeds = ", ".join(f"{car.name} {car.vx * 3.6:.1f} km/h" for car in cars)
    print(f"after: {speeds}\n")

# %% [markdown]
# With the larger gap ahead of it, the middle car is first thrown forward and then slowed by its
# hardest impact, which is also the hardest for the front car. With the larger gap behind it, the
# middle car is first slowed, and its hardest impact comes from behind. The final speeds are nearly
# the same in both scenes, so they do not tell which order it was.

# %%
figure, axes = plt.subplots(2, 1, figsize=(7, 9), sharex=True, layout="constrained")
for ax, (label, (track, _, cars)) in zip(axes, played.items(), strict=True):
    last, places = track[-1]
    rolled = [x + 0.3 * car.vx for x, car in zip(places, cars, strict=True)]
    track = [*track, (last + 0.3, rolled)]
    clocks = [clock for clock, _ in track]
    for index, (car, hatch) in enumerate(zip(cars, ("//", "..", "\\\\"), strict=True)):
        middles = [xs[index] for _, xs in track]
        back, front = ([x + end for x in middles] for end in (-LENGTH / 2, LENGTH / 2))
        name = f"{car.name}, back to front"
        style = {"alpha": 0.45, "hatch": hatch, "edgecolor": "white", "label": name}
        ax.fill_between(clocks, back, front, **style)
    for clock in clocks[1:-1]:
        ax.axvline(clock, color="0.3", lw=0.8, ls=":")
    ax.set(title=label, ylabel="position along the road [m]")
axes[0].legend(loc="lower right")
axes[1].set_xlabel("time [s] (dotted: an impact)")

# %% [markdown]
# The momenta in the impact with the highest closing speed. In the picture, A is the striking car
# and B the struck one:

# %%
every = [impact for _, impacts, _ in played.values() for impact in impacts]
plot.momentum(max(every, key=lambda impact: impact.closing_speed), units="metric")

# %% [markdown]
# ## Checks
#
# - The total momentum of the three cars is unchanged, and their kinetic energy falls by what the
#   impacts lose.
# - Between impacts and through them, the common centre of mass moves on at one speed.
# - With equal cars, elastic impacts and two cars standing, the last car takes all the speed
#   (Newton's cradle).
# - Cambridge Pre-U 9794/3, question 10 (a.simonm.io/questions?module=Pre-U+9794%2F3): particles of
#   1, 2 and 5 kg are a metre apart, the restitution is 0.5, and the first moves at 14 m/s. The
#   candidate is to show that the first comes to rest and that the second rebounds from the third.
#   Worked by hand, the second comes back at 0.5 m/s, and the third leaves at 3 m/s.
#
# There are only a handful of impacts, each with a few rounding errors of 1e-16, so 1e-13 of the
# whole leaves room.

# %%
for label, (track, impacts, after) in played.items():
    before = SCENES[label]
    momentum = sum(car.momentum[0] for car in before)
    energy = sum(car.kinetic_energy for car in before)
    assert math.isclose(sum(car.momentum[0] for car in after), momentum, rel_tol=1e-13)
    lost = sum(impact.energy_loss for impact in impacts)
    kept = sum(car.kinetic_energy for car in after)
    assert abs(kept + lost - energy) < 1e-13 * energy
    centres = [
        sum(car.mass * x for car, x in zip(before, xs, strict=True)) for _, xs in track
    ]
    for (clock, _), centre in zip(track, centres, strict=True):
        assert abs(centre - centres[0] - momentum * clock) < 1e-13 * abs(centres[0])

equal = [
    car.replace(mass=1000, vx=speed)
    for car, speed in zip(row(1.0, 1.0), (10.0, 0.0, 0.0), strict=True)
]
assert all(
    abs(car.vx - speed) < 1e-13
    for car, speed in zip(chain(equal, 1.0)[2], (0.0, 0.0, 10.0), strict=True)
)

exam = [
    car.replace(mass=mass, vx=vx)
    for car, mass, vx in zip(row(1.0, 1.0), (1, 2, 5), (14.0, 0.0, 0.0), strict=True)
]
struck, second, *_ = chain(exam, 0.5)[1]
for car, speed in ((struck.a, 0.0), (struck.b, 7.0), (second.a, -0.5), (second.b, 3.0)):
    assert abs(car.after.vx - speed) < 1e-13
print("all checks passed")

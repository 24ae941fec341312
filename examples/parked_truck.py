# %% [markdown]
# # A car spun into a parked truck
#
# A car is struck in its side, turns, slides across the road and comes against a parked truck. How
# hard the second impact is depends on how the car gets there. The scene has both contacts, the
# first as it was found, the second whenever the outlines meet. The case is invented.

# %%
import collisions as col
from collisions import plot
from collisions.scene import Contact, Mover, Scene
from collisions.travel import Tyres
from collisions.uncertainty import Normal, Uniform, propagate

KMH = 3.6

# %% [markdown]
# ## The scene
#
# Tyres roll, brake or are jammed by the damage: `lock` is that of the front left, front right, rear
# left and rear right wheel. The car that is struck rolls until then, and its rear axle is jammed
# after it (`tyres_after`). Both contacts last a tenth of a second and are followed in time.

# %%
rolls, jammed = (
    Tyres(friction=0.7, lock=lock, wheelbase="2.6 m", track="1.5 m")
    for lock in (0.02, [0.02, 0.02, 0.8, 0.8])
)
striking = Mover(
    col.Vehicle(
        mass="1550 kg",
        yaw_inertia=2600,
        x="-3.1 m",
        y="-0.5 m",
        heading="0 deg",
        vx="60 km/h",
    ),
    outline=("4.5 m", "1.8 m"),
    tyres=Tyres(0.7, 1, "2.7 m", "1.55 m"),
)
struck = Mover(
    col.Vehicle(
        mass="1250 kg",
        yaw_inertia=1900,
        x="0 m",
        y="1.2 m",
        heading="90 deg",
        vy="32 km/h",
    ),
    outline=("4.2 m", "1.7 m"),
    tyres=rolls,
)
parked = Mover(
    col.Vehicle(mass="7 t", yaw_inertia=30000, x="6.5 m", y="7.5 m", heading="90 deg"),
    outline=("6.5 m", "2.4 m"),
    tyres=Tyres(0.7, 1, "3.9 m", "1.9 m"),
)
crash = Scene(
    movers={"Saloon": striking, "Hatchback": struck, "Truck": parked},
    contacts=[
        Contact(
            "Saloon",
            "Hatchback",
            restitution=0.1,
            friction=0.5,
            normal="0 deg",
            point=("-0.85 m", "-0.2 m"),
            duration="100 ms",
            tyres_after={"Hatchback": jammed},
        ),
        Contact(
            "Hatchback",
            "Truck",
            restitution=0.15,
            friction=0.4,
            at="touch",
            duration="100 ms",
        ),
    ],
)
run = crash.run()
print(run.summary("metric"))

# %%
plot.scene(run, units="metric")

# %% [markdown]
# ## Where the energy went, and how fast everything was
#
# Tyres take what the contacts leave. The account is of the forces along the way, so that it closes
# is a check.

# %%
energy = run.energy
print(f"before {energy['before'] / 1e3:6.1f} kJ")
for pair, taken in zip(run.pairs, energy["contacts"], strict=True):
    print(f"{' and '.join(pair)}: {taken / 1e3:6.1f} kJ")
print(f"ground {energy['ground'] / 1e3:6.1f} kJ, left {energy['left'] / 1e3:6.1f} kJ")
plot.timeline(run, units="metric")

# %% [markdown]
# ## How sure the second impact is
#
# The speed of the saloon is known to 3 km/h, the friction of road and contact and the restitution
# as ranges. The second impact is far less sure than the first, since every error of the first moves
# the way that the hatchback takes.

# %%
inputs = {
    "Saloon.vx": Normal("60 km/h", "3 km/h"),
    "Hatchback.tyres.friction": Uniform(0.6, 0.8),
    "contacts[0].friction": Uniform(0.4, 0.6),
    "contacts[0].restitution": Uniform(0.05, 0.2),
}
delta_v = ["impacts[0].b.delta_v", "impacts[1].a.delta_v"]
spread = propagate(crash, inputs, outputs=delta_v, samples=128, seed=1)
for name, what in zip(delta_v, ("from the saloon", "from the truck"), strict=True):
    low, high = (speed * KMH for speed in spread[name].interval())
    print(f"delta-V of the hatchback {what}: {low:.0f} to {high:.0f} km/h (95 %)")

# %% [markdown]
# ## Checks
#
# - Momentum is kept through each contact but for what the tyres gave, and the energy closes.
# - The second contact begins where the outlines touch: neither car jumps.
# - Without the truck the hatchback comes to rest beyond the place where it met it, which the scene
#   finds by itself.

# %%
for impact in run.impacts:
    assert impact.momentum_residual < 1e-9
kept = energy["before"] - sum(energy["contacts"]) - energy["ground"] - energy["left"]
assert abs(kept) < 1e-3 * energy["before"]
assert run.pairs == (("Saloon", "Hatchback"), ("Hatchback", "Truck"))
before, after = (run.at(run.times[1] + step)["Hatchback"] for step in (-1e-6, 1e-6))
assert abs(before.x - after.x) < 1e-4
assert abs(before.y - after.y) < 1e-4
alone = Scene(
    movers={name: crash.movers[name] for name in ("Saloon", "Hatchback")},
    contacts=crash.contacts[:1],
).run()
met = run.at(run.times[1])["Hatchback"]
assert alone.rest["Hatchback"].x > met.x
assert 0.0 < run.impacts[1].a.delta_v < run.impacts[0].b.delta_v
print("all checks passed")

# %% [markdown]
# # A chain of three, back to the speeds
#
# A van ran into a Golf, which was thrown into a taxi that stood at a red light. How fast was the
# van, and how fast was the Golf still? Known are where the three stand now, the dents of the van
# and the Golf, and what the recorder of the taxi says. The lines down to the report are all that
# the job takes. **The case is invented**, and so are the stiffness coefficients.

# %%
import collisions as col
from collisions.reconstruct import crush_energy, posterior
from collisions.scene import Contact, Mover, Scene
from collisions.uncertainty import Normal, Uniform

# The Golf was struck at the origin, where the glass lies. The taxi stood at the stop
# line, with 11 m between the two. The places are those of the middle of each vehicle.
cars = {
    "Van": col.Vehicle(mass="1650 kg", x="-4.4 m", y=0, heading=0),
    "Golf": col.Vehicle(mass="1250 kg", x=0, y=0, heading=0),
    "Taxi": col.Vehicle(mass="1400 kg", x="15.4 m", y=0, heading=0, vx=0),
}
size = ("4.4 m", "1.8 m")
bumper = {"normal": 0, "model": "linear_central", "restitution": 0.2}
crash = Scene(
    movers={name: Mover(cars[name], outline=size, drag=0.6) for name in cars},
    contacts=[
        Contact("Van", "Golf", at=0, **bumper),
        Contact("Golf", "Taxi", at="touch", **bumper),
    ],
    shared={"speed of the van": ("Van.vx",), "speed of the Golf": ("Golf.vx",)},
)
unknown = {
    **{f"speed of the {car}": Uniform("0 km/h", "150 km/h") for car in ("van", "Golf")},
    **{f"{name}.drag": Normal(0.6, 0.08) for name in cars},
    **{f"contacts[{i}].restitution": Normal(0.2, 0.1, truncate=(0, 1)) for i in (0, 1)},
}
# Across 1.5 m of the front of the van, and of the back of the Golf, three depths.
dents = {
    "front of the van": (["17 cm", "23 cm", "17 cm"], "40 kN/m", "450 kN/m**2"),
    "back of the Golf": (["19 cm", "25 cm", "19 cm"], "30 kN/m", "350 kN/m**2"),
}
damage = sum(crush_energy("1.5 m", *dents[name], name=name) for name in dents)
evidence = {
    "impacts[0].energy_absorbed": (damage, 0.2 * damage),
    "impacts[1].b.delta_v_forward": ("14 km/h", "1 km/h"),
    "Van.rest.x": ("5.7 m", "0.3 m"),
    "Golf.rest.x": ("11.6 m", "0.3 m"),
    "Taxi.rest.x": ("16.7 m", "0.3 m"),
}
found = posterior(crash, unknown, evidence, samples=1024, seed=1)
run = crash.replace({name: found[name].mean for name in unknown}).run()
page = col.report([found, run], title="A chain of three")
page.save("report.html")

# %% [markdown]
# ## What it says
#
# The report has what the evidence says, and then each of both impacts, with the range of its
# delta-V. What it says of the speeds, and how they went in the middle of their ranges:

# %%
from collisions import plot

for name in ("speed of the van", "speed of the Golf"):
    low, high = (3.6 * speed for speed in found[name].interval())
    print(f"{name}: {low:.0f} to {high:.0f} km/h (95 %)")
over, error = found.probability(lambda at: at["speed of the van"] > 55 / 3.6)
print(f"The van was over 55 km/h with a probability of {over:.2f}.")
plot.timeline(run, units="metric")

# %% [markdown]
# The dents tell how fast the van closed in on the Golf, the places of rest and the recorder how
# fast both were after it, and momentum does the rest. The van stopped short of the Golf; had it run
# into it again, the scene would need that contact too. The model has no answer where the van is
# the slower of the two, or the Golf stops short of the taxi.

# %%
print(*found.statements, sep="\n")
for name in cars:
    print(f"{name} at rest: {run.rest[name].x:.1f} m")

# %% [markdown]
# ## Checks
#
# - Each impact keeps the momentum of the two it is of; the kinetic energy before is what the
#   impacts and the ground took, which is worked out along the ways.
# - The readings are those of a run at 62 and 18 km/h, rounded: run forwards with these speeds, the
#   crash leads to them within their errors, and the ranges have both speeds in them.
# - By hand, along the road: the speeds just after the first impact follow from the ways to rest and
#   to the taxi, with the drag of 0.6 that the readings were made with.

# %%
import math

for impact in run.impacts:
    before, after = (
        sum(getattr(side, when).momentum[0] for side in (impact.a, impact.b))
        for when in ("before", "after")
    )
    assert math.isclose(after, before, rel_tol=1e-12)
energy = run.energy
taken = sum(energy["contacts"]) + energy["ground"] + energy["left"]
assert math.isclose(energy["before"], taken, rel_tol=1e-6)

speeds = {"speed of the van": 62, "speed of the Golf": 18}
made = crash.replace({name: f"{truth} km/h" for name, truth in speeds.items()}).run()
for name in cars:
    (reading, error) = (float(text[:-2]) for text in evidence[f"{name}.rest.x"])
    assert abs(made.rest[name].x - reading) < error
first, second = made.impacts
assert abs(first.energy_absorbed - damage) < 0.2 * damage
assert abs(3.6 * second.b.delta_v_forward - 14) < 1
for name, truth in speeds.items():
    low, high = (3.6 * speed for speed in found[name].interval())
    assert low < truth < high
    assert f"{low:.0f}" in page
    assert f"{high:.0f}" in page

slowed = 2 * 0.6 * 9.80665
van_after = math.sqrt(slowed * (5.7 + 4.4))
taxi_after = math.sqrt(slowed * (16.7 - 15.4))
golf_after = math.sqrt(slowed * (11.6 - 11.0))
# Momentum gives the speed of the Golf at the taxi, and the way there the speed before it.
golf_there = (1250 * golf_after + 1400 * taxi_after) / 1250
golf_before = math.sqrt(golf_there**2 + slowed * 11.0)
momentum = 1650 * van_after + 1250 * golf_before
assert math.isclose(momentum, (1650 * 62 + 1250 * 18) / 3.6, rel_tol=0.02)
print("all checks passed")

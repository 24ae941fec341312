# %% [markdown]
# # How fast was the car that hit the pole?
#
# A car slid sideways into a pole, turned about it and came to rest some metres on. The dent in its
# side was measured, and where it stands. From both follows how fast it was, and how sure that is.
# The lines down to the report are all that the job takes. **The case is invented**, and so are the
# stiffness coefficients: those of the very car belong in their place.

# %%
import collisions as col
from collisions.reconstruct import crush_energy, posterior
from collisions.scene import Contact, Mover, Scene
from collisions.travel import Tyres
from collisions.uncertainty import Normal, Uniform

# The pole is the origin; the car came along x, pointing along y. It pushed the pole
# along x too, so that the normal is 0.
car = col.Vehicle(
    mass="1400 kg", yaw_inertia=2300, x="-0.6 m", y="-0.7 m", heading="90 deg"
)
pole = col.Vehicle.barrier(x=0, y=0, heading=0)
braked = Tyres(friction=0.7, lock=0.8, wheelbase="2.6 m", track="1.5 m")
hit = Contact("Car", "Pole", normal=0, point=(-0.15, 0), restitution=0.1, friction=0.5)
crash = Scene(
    movers={
        "Car": Mover(car, outline=("4.4 m", "1.8 m"), tyres=braked),
        "Pole": Mover(pole, outline=("0.3 m", "0.3 m")),
    },
    contacts=[hit],
    shared={"speed of the car": ("Car.vx",)},
)
unknown = {
    "speed of the car": Uniform("0 km/h", "120 km/h"),
    "Car.tyres.friction": Normal(0.7, 0.05),
    "contacts[0].restitution": Normal(0.1, 0.05, truncate=(0, 1)),
    "contacts[0].friction": Normal(0.5, 0.1, truncate=(0, None)),
    "contacts[0].point[1]": Normal("0 m", "0.05 m"),
}
# Across 0.9 m of the side, six depths; a reading of the energy is good to a fifth.
depths = ["10 cm", "38 cm", "56 cm", "60 cm", "36 cm", "10 cm"]
dent = crush_energy("0.9 m", depths, "25 kN/m", "900 kN/m**2", name="right side")
evidence = {
    "impacts[0].energy_absorbed": (dent, 0.2 * dent),
    "Car.rest.x": ("0.3 m", "0.3 m"),
    "Car.rest.y": ("-1.7 m", "0.3 m"),
    "Car.rest.heading": ("175 deg", "5 deg"),
}
found = posterior(crash, unknown, evidence, samples=1024, seed=1)
run = crash.replace({name: found[name].mean for name in unknown}).run()
page = col.report([found, run], title="Speed of the car at the pole")
page.save("report.html")

# %% [markdown]
# ## What it says
#
# The report has what the evidence says, and as its second part the impact at the means. It finds
# that the car goes sideways, and so it did. What it says of the speed, and the crash at that speed:

# %%
from collisions import plot

low, high = (3.6 * speed for speed in found["speed of the car"].interval())
print(f"{low:.0f} to {high:.0f} km/h (95 %)")
print(*found.statements, sep="\n")
plot.scene(run, units="metric")

# %% [markdown]
# ## Checks
#
# - The energy of the car before is that lost at the pole, and of its motion after, at the means of
#   what was found; the energy absorbed is that of the dent within twice its error.
# - The report says the range that is printed above.

# %%
import math

(impact,) = run.impacts
before = 0.5 * 1400 * found["speed of the car"].mean ** 2
after = impact.a.after.kinetic_energy
assert math.isclose(before, impact.energy_loss + after, rel_tol=1e-9)
assert abs(impact.energy_absorbed - dent) < 2 * 0.2 * dent
assert f"{low:.0f}" in str(page)
assert f"{high:.0f}" in str(page)
print("all checks passed")

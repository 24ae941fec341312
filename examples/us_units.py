# %% [markdown]
# # A whole case in US units
#
# An oblique frontal crash test of two vehicles, NHTSA 4474, worked from pounds, feet, miles per
# hour and degrees to the answer, its derivation and a report in the same units. This example shows
# where to give units and where to ask for them, and which pound is which.
#
# The inputs are those printed for a Honda Accord and a Mitsubishi Montero in SAE 2006-01-0908, as
# given in pycrash (github.com/joe-cormier/pycrash, test_inputs_rose.py). They were chosen so that
# the solution fits the test.

# %%
import math

import collisions as col
from collisions import plot

# %% [markdown]
# ## Units in
#
# A value given as text is one number and one unit. `lb` is a mass, `lbf` a force: what weighs 3000
# lbf has a mass of 3000 lb. Yaw inertias are printed here in slug·ft², which is the same as
# lbf·ft·s². In lb·ft² the number is about 32 times as large.


# %%
def placed(centre, **rest):
    """A vehicle whose impact centre is at the origin of the scene.

    `centre` is the distance of that point, and its angle from the heading.
    """
    vehicle = col.Vehicle.from_speed(x="0 ft", y="0 ft", course=rest["heading"], **rest)
    x, y = vehicle.point(distance=centre[0], angle=centre[1])
    return vehicle.replace(x=-x, y=-y)


montero = placed(
    ("5.5 ft", "15.2 deg"),
    mass="4657 lb",
    yaw_inertia="2863 slug*ft**2",
    speed="35 mph",
    heading="31.6 deg",
    name="Montero",
)
accord = placed(
    ("2.9 ft", "34.7 deg"),
    mass="3305.7 lb",
    yaw_inertia="2066 lbf*ft*s**2",
    speed="35 mph",
    heading="180 deg",
    name="Accord",
)
impact = col.eccentric(
    montero,
    accord,
    0.15,
    normal="51.8 deg",
    point=("0 ft", "0 ft"),
    critical_fraction="100 %",
)

# %% [markdown]
# ## Units out
#
# An attribute is a plain number in SI. Under `.q` it is a Quantity that can be converted to any
# unit of its kind.

# %%
print(f"{'':<10}{'delta-V':>10}{'yaw rate after':>17}{'PDOF':>13}{'speed after':>14}")
for side in (impact.a.q, impact.b.q):
    delta_v, after = f"{side.delta_v.to('mph'):.1f~P}", side.after
    yaw_rate, speed = f"{after.yaw_rate.to('deg/s'):.0f~P}", after.speed.to("mph")
    pdof = f"{side.pdof.to('deg'):.0f~P}"
    print(
        f"{side.before.name:<10}{delta_v:>10}{yaw_rate:>17}"
        f"{pdof:>13}{f'{speed:.1f~P}':>14}"
    )
print(
    f"normal impulse {impact.q.normal_impulse.to('lbf*s'):.0f~P}, "
    f"energy lost {impact.q.energy_loss.to('ft*lbf'):.0f~P}"
)
axes = plot.scene(
    impact, outline_a=("15 ft", "5.8 ft"), outline_b=("15.7 ft", "5.8 ft"), units="us"
)

# %% [markdown]
# `explain` and `report` take US units too, and show what was given beside what it was converted to:

# %%
text = col.explain(impact, units="us", form="text")
print(text[text.index("Closing speed:") : text.index("Slip, of B")].rstrip() + "\n")

page = col.report(impact, units="us", form="markdown", title="NHTSA 4474")
rows = [
    line.strip("| ").split(" | ") for line in page.splitlines() if line.startswith("| ")
]
for who, what, value in (row for row in rows if len(row) == 3):
    if what in ("yaw inertia about the centre of mass", "delta-V", "energy lost"):
        print(f"{who}: {what.removesuffix(' about the centre of mass')} {value}")

# %% [markdown]
# `form="html"`, which is the default, makes one file with the figures in it.
#
# ## Pounds that go wrong
#
# A force given for a mass is refused, and the message says what to write. An inertia in lb·ft² is a
# valid inertia: only its size gives away that slug·ft² was meant, and it is `diagnose` that says
# so.

# %%
refusal = None
try:
    col.Vehicle(mass="4657 lbf")
except col.UnitsError as error:
    refusal = error
    print(error)

light = montero.replace(yaw_inertia="2863 lb*ft**2")
mistaken = col.eccentric(
    light,
    accord,
    0.15,
    normal="51.8 deg",
    point=("0 ft", "0 ft"),
    critical_fraction="100 %",
)
print(f"the Montero would spin at {mistaken.a.q.delta_yaw_rate.to('deg/s'):.0f~P}")
findings = {finding.code: finding.sentence for finding in col.diagnose(mistaken)}
print(findings["suspect_inertia_low"])

# %% [markdown]
# ## Checks
#
# - Published, for the printed inputs: delta-V 28.7 and 40.5 mph, changes of yaw rate of 194 and 40
#   deg/s, critical ratio -0.40. The contact is printed to a tenth of a foot or degree, so 0.2 mph
#   and 1 deg/s are allowed; the ratio is printed to two decimals.
# - By the definitions of the units (mile 1609.344 m, foot 0.3048 m, pound 0.45359237 kg, g 9.80665
#   m/s²) the inputs are held in SI, to a few eps.
# - The energy lost is the kinetic energy the vehicles had before less what they have after, added
#   up in foot-pounds. Each part is rounded, so the two agree to 1e-12.

# %%
for side, delta_v, turn in ((impact.a.q, 28.7, 194), (impact.b.q, 40.5, 40)):
    assert abs(side.delta_v.m_as("mph") - delta_v) < 0.2
    assert abs(side.delta_yaw_rate.m_as("deg/s") - turn) < 1.0
assert abs(impact.critical_impulse_ratio - -0.40) < 0.005

pound, foot, gravity = 0.45359237, 0.3048, 9.80665
assert math.isclose(montero.speed, 35 * 1609.344 / 3600, rel_tol=1e-15)
assert math.isclose(montero.mass, 4657 * pound, rel_tol=1e-15)
assert math.isclose(accord.yaw_inertia, 2066 * pound * gravity * foot, rel_tol=1e-14)
energy = [
    sum(v.q.kinetic_energy.m_as("ft*lbf") for v in pair)
    for pair in ((montero, accord), (impact.a.after, impact.b.after))
]
assert math.isclose(
    energy[0] - energy[1], impact.q.energy_loss.m_as("ft*lbf"), rel_tol=1e-12
)
assert refusal is not None
assert refusal.code == "bad_units"
print("all checks passed")

# %% [markdown]
# # A sideswipe by its impulse ratio
#
# Two oncoming cars strike each other with their left front corners and scrape past, and the
# tangential impulse decides what follows. This example shows how to give it as `impulse_ratio=`,
# how that differs from `friction=`, and what a wrong ratio costs.
#
# **The scene is invented.** `impulse_ratio` is the tangential impulse over the normal impulse,
# *signed*: positive if the impulse on B points along the tangent. `friction` is a limit without a
# sign: the solver finds the direction of the tangential impulse, and stops where slip stops. With a
# ratio it does neither.

# %%
import math
import warnings

import matplotlib.pyplot as plt
import numpy as np

import collisions as col
from collisions import plot, reference

A = col.Vehicle(
    mass="1500 kg",
    yaw_inertia=2600,
    x=-1.8,
    y=-0.7,
    heading="0 deg",
    vx="70 km/h",
    name="A",
)
B = col.Vehicle(
    mass="1400 kg",
    yaw_inertia=2400,
    x=1.8,
    y=0.7,
    heading="180 deg",
    vx="-60 km/h",
    name="B",
)
CONTACT = {"restitution": 0.1, "normal": "75 deg", "point": (0.0, 0.0)}

scrape = col.eccentric(A, B, friction=0.5, **CONTACT)
axes = plot.scene(
    scrape, outline_a=("4.5 m", "1.8 m"), outline_b=("4.4 m", "1.75 m"), units="metric"
)

# %% [markdown]
# ## Which sign, and how much
#
# The slip before the impact says which way B slides along A, and the tangential impulse on B
# opposes it. The critical ratio is the one that just stops slip.

# %%
against = -math.copysign(1.0, scrape.slip_before)
critical = scrape.critical_impulse_ratio
print(
    f"closing speed {scrape.q.closing_speed.to('km/h'):.1f~P}, "
    f"slip {scrape.q.slip_before.to('km/h'):.1f~P}"
)
print(f"critical impulse ratio {critical:.2f}; published ranges, as magnitudes:")
FRICTION = reference.INTER_VEHICLE_FRICTION
SNAGGED = reference.IMPULSE_RATIO_SMALL_OVERLAP
for published in (FRICTION, reference.IMPULSE_RATIO_OBLIQUE, SNAGGED):
    print(f"{published.low:5.2f} to {published.high:.2f}  {published.name}")

# %% [markdown]
# None of these ranges is for a sideswipe between two cars. Panels that slide have a coefficient of
# friction of up to about 1. Where wheels or corners snag, the ratio is above 1, as in the
# small-overlap tests, and is not a coefficient of friction between surfaces. The damage must show
# which it was.
#
# ## What a wrong ratio costs
#
# Beyond the critical ratio the slip reverses. The answer may then gain energy; the library warns of
# this and never clips the answer.

# %%
print(
    f"{'':<20}{'ratio':>7}{'regime':>10}{'delta-V A':>11}"
    f"{'yaw rate A':>12}{'slip after':>12}{'energy lost':>13}"
)
print(f"{'':<20}{'':>7}{'':>10}{'km/h':>11}{'deg/s':>12}{'km/h':>12}{'kJ':>13}")
contacts = [
    {"friction": 0.5},
    *({"impulse_ratio": against * size} for size in (0.5, 1.0, 1.5, 2.0)),
    {"friction": math.inf},
]
found = []
for tangential in contacts:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found.append(col.eccentric(A, B, **tangential, **CONTACT))
    ((name, value),) = tangential.items()
    impact, side = found[-1], found[-1].a.q
    print(
        f"{f'{name}={value:g}':<20}{impact.impulse_ratio:>7.2f}{impact.regime:>10}"
        f"{side.delta_v.m_as('km/h'):>11.1f}{side.delta_yaw_rate.m_as('deg/s'):>12.0f}"
        f"{impact.q.slip_after.m_as('km/h'):>12.1f}"
        f"{impact.q.energy_loss.m_as('kJ'):>13.0f}"
    )
    for warning in caught:
        print(f"    warning: {warning.message.code}")

# %%
sizes = np.linspace(0.0, abs(critical), 200)
swept = col.eccentric(A, B, impulse_ratio=against * sizes, **CONTACT)
delta_v, turn = swept.a.q.delta_v, swept.a.q.delta_yaw_rate
figure, charts = plt.subplots(1, 2, figsize=(8, 4), layout="constrained")
for chart, label, curve in (
    (charts[0], "delta-V of A [km/h]", delta_v.m_as("km/h")),
    (charts[1], "change of yaw rate of A [deg/s]", turn.m_as("deg/s")),
):
    for published, shade in ((FRICTION, "0.9"), (SNAGGED, "0.75")):
        chart.axvspan(published.low, published.high, color=shade, label=published.name)
    chart.plot(sizes, curve, "k", label="up to the critical ratio")
    chart.set(xlabel="size of the impulse ratio", ylabel=label)
legend = figure.legend(
    *charts[0].get_legend_handles_labels(), loc="outside lower center", ncols=2
)

# %% [markdown]
# From a friction of 0.5 to the critical ratio, delta-V grows more than fivefold and A turns the
# other way. Give a range, and say what it rests on.
#
# ## Checks
#
# - While the contact slides, `friction` gives the ratio of the same size against the slip; without
#   a limit it gives the critical ratio. Each pair is one impulse reached in two ways, so the two
#   agree to a few eps: 1e-12.
# - Linear momentum (some 1e4 kg m/s) and angular momentum about the contact (some 1e4 kg m²/s) are
#   conserved, to the rounding error of such sums, which is below 1e-9.
# - Published: small-overlap test CF11016, listed under class "Sideswipe" in the sheet "Brach
#   Matrix.xlsx" in github.com/joe-cormier/pycrash. Restitution, contact and ratio (98.9 percent of
#   a critical ratio of 2.006) were fitted to the measured motion, so they must return it. They are
#   printed to a tenth of a foot or degree, which is worth up to 0.8 ft/s and 4 deg/s each; a
#   quarter of that is allowed.


# %%
def carried(pair):
    """Momentum of two vehicles: along x, along y, and angular about the origin."""
    turning = sum(
        v.yaw_inertia * v.yaw_rate + v.mass * (v.x * v.vy - v.y * v.vx) for v in pair
    )
    return sum(v.mass * v.vx for v in pair), sum(v.mass * v.vy for v in pair), turning


sliding, given, *_, unlimited = found
assert math.isclose(sliding.a.delta_v, given.a.delta_v, rel_tol=1e-12)
assert math.isclose(unlimited.impulse_ratio, critical, rel_tol=1e-12)
assert unlimited.a.delta_v > 5 * sliding.a.delta_v
assert unlimited.a.delta_yaw_rate > 0 > sliding.a.delta_yaw_rate
for impact in found:
    assert np.allclose(
        carried((impact.a.after, impact.b.after)), carried((A, B)), rtol=0, atol=1e-9
    )

fusion = col.Vehicle(
    mass="111 slug",
    yaw_inertia="2336.3 slug*ft**2",
    vx="58.6 ft/s",
    x=0.0,
    y=0.0,
    heading="0 deg",
)
corner = fusion.point(distance="4.4 ft", angle="29.3 deg")
test = col.eccentric(
    fusion,
    col.Vehicle.barrier(),
    0.147,
    normal="77.6 deg",
    point=corner,
    impulse_ratio=-0.989 * 2.006,
)
assert abs(test.a.q.delta_vx.m_as("ft/s") - -51.2) < 0.2
assert abs(test.a.q.delta_vy.m_as("ft/s") - -13.11) < 0.2  # the sheet prints magnitudes
assert abs(test.a.q.delta_yaw_rate.m_as("deg/s") - 163.11) < 1.0
print("all checks passed")

# %% [markdown]
# # Two accounts of one crash
#
# At a crossroads car A, going east, strikes car B in the side. "I was doing 50 or 60", says the
# driver of A. "That car was doing 80", says the driver of B. The evidence is marks, a rest position
# and half a recording. What is it worth, and for whom? The scene is invented.
#
# The same evidence is given to both accounts. They differ only in what they state beforehand: the
# prior of one speed.

# %%
import math

import matplotlib.pyplot as plt
import numpy as np

import collisions as col
from collisions import plot, travel
from collisions.reconstruct import compare, posterior
from collisions.uncertainty import Censored, Normal, Uniform

SAMPLES = 2048


def crash(speed_a, speed_b, restitution, friction, contact, drag):
    """What the marks and the recorder would show."""
    a = col.Vehicle(mass=1500, vx=speed_a, yaw_inertia=2500, x=-2.1, y=0.0)
    b = col.Vehicle(mass=1250, vy=speed_b, yaw_inertia=1900, x=0.9, y=-0.4)
    impact = col.eccentric(
        a,
        b,
        restitution,
        normal=0.0,
        point=(0.0, contact),
        friction=friction,
        on_failure="nan",
    )
    return {
        "delta-V of A": impact.a.q.delta_v,
        "course of A after": impact.a.after.q.course,
        "course of B after": impact.b.after.q.course,
        "run-out of A": impact.a.after.speed**2 / (2.0 * travel.GRAVITY * drag),
    }


observed = {
    # the recording of A ended early
    "delta-V of A": Censored(low="24 km/h", error="1 km/h"),
    "course of A after": Normal("8 deg", "3 deg"),
    "course of B after": Normal("27 deg", "3 deg"),
    "run-out of A": Normal(9.0, 0.8),
}
common = {
    "speed_b": Uniform("5 km/h", "60 km/h"),
    "restitution": Normal(0.1, 0.05, truncate=(0, 1)),
    "friction": Normal(0.5, 0.15, truncate=(0, None)),
    "contact": Normal(0.2, 0.15),
    "drag": Normal(0.7, 0.06),
}
said_by_a = Normal("55 km/h", "4 km/h")
said_by_b = Uniform("75 km/h", "95 km/h")


def account(speed_a, seed=1):
    return posterior(
        crash, {"speed_a": speed_a, **common}, observed, samples=SAMPLES, seed=seed
    )


# %% [markdown]
# ## Which account does the evidence speak for?
#
# `compare` takes one posterior for each account. The factor says how many times more probable the
# evidence is if one account is true than if the other is. The probabilities of the accounts need
# one thing more: how probable each was before the evidence. That is for the court; here it is 1 to
# 1.

# %%
driver_a, driver_b = account(said_by_a), account(said_by_b)
found = compare({"driver of A": driver_a, "driver of B": driver_b})
print(found.summary())

# %% [markdown]
# ## How the answer moves with the priors
#
# The factor compares what the accounts state, and so it depends on how narrowly they state it.
# Whoever says "somewhere between 61 and 150" spreads a prediction thinly, and what a driver meant
# by 50 or 60 is a matter of judgement. Show the whole table, not one line of it.

# %%
versions_a = {
    "55 ± 2": Normal("55 km/h", "2 km/h"),
    "55 ± 4": said_by_a,
    "55 ± 8": Normal("55 km/h", "8 km/h"),
}
versions_b = {
    "80 ± 5": Normal("80 km/h", "5 km/h"),
    "75 to 95": said_by_b,
    "60 to 100": Uniform("60 km/h", "100 km/h"),
    "61 to 150": Uniform("61 km/h", "150 km/h"),
}
logs_a = {name: account(prior).log_evidence for name, prior in versions_a.items()}
logs_b = {
    name: account(prior, seed=2).log_evidence for name, prior in versions_b.items()
}
print("How many times more probable the evidence is on B's account than on A's:")
print(f"{'B: km/h':<12}" + "".join(f"{'A: ' + name:>14}" for name in versions_a))
for name, log in logs_b.items():
    factors = (math.exp(log - of_a) for of_a in logs_a.values())
    shown = (f"{factor:.0f}" if factor > 10 else f"{factor:.1f}" for factor in factors)
    print(f"{name:<12}" + "".join(f"{text:>14}" for text in shown))

# %% [markdown]
# ## The question without the accounts
#
# Often the question is not who is right, but how fast A was going. Then neither driver's statement
# goes in: there is one posterior, with a prior that favours neither, and it gives the probability
# that is asked for. The residuals say whether the evidence agrees with itself at all.

# %%
open_minded = account(Uniform("20 km/h", "130 km/h"), seed=3)
low, high = (3.6 * end for end in open_minded["speed_a"].interval(0.95))
over, error = open_minded.probability(lambda at: at["speed_a"] > 60 / 3.6)
print(
    f"speed of A: {3.6 * open_minded['speed_a'].mean:.0f} km/h, "
    f"95 percent from {low:.0f} to {high:.0f} km/h"
)
print(f"probability that A was over 60 km/h: {over:.3f} ± {error:.3f}")
print(open_minded.statements[0])

figure, (above, below) = plt.subplots(
    2, 1, figsize=(7, 8), layout="constrained", height_ratios=(3, 2)
)
plot.distribution(open_minded["speed_a"], axes=above, units="metric")
plot.residuals(open_minded, axes=below)

# %% [markdown]
# ## How to say it
#
# The expert speaks about the evidence, the court about the accounts. So the expert's sentence gives
# the factor, and what it rests on:
#
# > *The findings are the marks, the rest position and the incomplete recording. With the priors
# listed, they are [factor] times > more probable if A drove as the driver of B states than if A
# drove as its own driver states. Over the range of priors in the > table the factor stays between
# [least] and [greatest]. The factor is not the probability that either driver is telling the >
# truth: that depends on all the other evidence too.*
#
# This follows the guideline of the European forensic institutes (ENFSI, Guideline for Evaluative
# Reporting in Forensic Science, 2015), which asks for the probability of the findings given each
# proposition, not of a proposition given the findings. The statement should be accompanied by the
# priors, the stated errors of the readings, the residuals, and the remark that all of this holds if
# the model does.

# %% [markdown]
# ## Checks
#
# - The evidence of an account is the mean of the likelihood over its priors. Here that mean is
#   found again by plain draws from numpy's own generator, with the densities written out. The two
#   agree within 5 standard errors, those of the 200,000 draws included.
# - The posterior odds are the prior odds times the factor.
# - The posterior from the neutral prior, cut off to the range that an account states, gives the
#   same speeds as the posterior of that account.

# %%
rng, count = np.random.default_rng(1), 200_000
normals = {
    name: rng.standard_normal(count)
    for name in ("restitution", "friction", "contact", "drag")
}
drawn = {
    "speed_a": rng.uniform(75, 95, count) / 3.6,
    "speed_b": rng.uniform(5, 60, count) / 3.6,
    "restitution": 0.1 + 0.05 * normals["restitution"],
    "friction": 0.5 + 0.15 * normals["friction"],
    "contact": 0.2 + 0.15 * normals["contact"],
    "drag": 0.7 + 0.06 * normals["drag"],
}
possible = (drawn["restitution"] >= 0.0) & (drawn["friction"] >= 0.0)  # the truncations
drawn = {name: values[possible] for name, values in drawn.items()}
outputs = {
    name: np.asarray(getattr(value, "magnitude", value))
    for name, value in crash(**drawn).items()
}
log = np.array(
    [
        math.log(0.5 * math.erfc((24 / 3.6 - v) * 3.6 / math.sqrt(2.0)))
        for v in outputs["delta-V of A"]
    ]
)
for name, value, sigma in (
    ("course of A after", math.radians(8), math.radians(3)),
    ("course of B after", math.radians(27), math.radians(3)),
    ("run-out of A", 9.0, 0.8),
):
    off = (value - outputs[name]) / sigma
    log += -0.5 * off**2 - math.log(sigma * math.sqrt(2.0 * math.pi))
mean, spread = np.mean(np.exp(log)), np.std(np.exp(log)) / math.sqrt(len(log))
scatter = math.hypot(driver_b.log_evidence_error, spread / mean)
assert abs(driver_b.log_evidence - math.log(mean)) < 5.0 * scatter

one_in_ten = compare(
    {"driver of A": driver_a, "driver of B": driver_b},
    prior={"driver of A": 0.9, "driver of B": 0.1},
)
factor = math.exp(found.log_bayes_factors["driver of B", "driver of A"])
after = one_in_ten.probability["driver of B"]
assert math.isclose(after / (1.0 - after), factor / 9.0, rel_tol=1e-9)

speeds = open_minded.draws["speed_a"]
inside = speeds[(speeds > 75 / 3.6) & (speeds < 95 / 3.6)]
if len(inside) > 200:
    scatter = math.hypot(
        driver_b["speed_a"].mean_standard_error,
        2.0 * np.std(inside) / math.sqrt(len(inside)),
    )
    assert abs(np.mean(inside) - driver_b["speed_a"].mean) < 5.0 * scatter
print("all checks passed")

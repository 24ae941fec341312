# %% [markdown]
# # A million cases
#
# Every input of a rear-end impact is uncertain. The inputs are drawn a million times, and all the
# cases are solved in one call. This example shows what becomes of the cases that have no answer,
# how long a case takes, and that `uncertainty.propagate` gets there with fewer.
#
# **The scene is invented.** A runs into the back of B, offset by up to 0.6 m, in traffic where
# either car may have been the faster.

# %%
import math
import time
import warnings

import numpy as np

import collisions as col
from collisions import plot
from collisions.uncertainty import Normal, Uniform, propagate

COUNT = 1_000_000
KMH = 1 / 3.6


def crash(speed_a, speed_b, mass_a, mass_b, offset, restitution, friction, **options):
    """A behind B with a small offset to one side; numbers or arrays, in SI."""
    place_a = {"x": -2.2, "y": offset, "heading": 0.0}
    place_b = {"x": 2.1, "y": 0.0, "heading": 0.0}
    a = col.Vehicle(
        mass=mass_a, yaw_inertia=1.7 * mass_a, vx=speed_a, **place_a, name="A"
    )
    b = col.Vehicle(
        mass=mass_b, yaw_inertia=1.6 * mass_b, vx=speed_b, **place_b, name="B"
    )
    contact = {"normal": 0.0, "point": (0.0, offset / 2), "friction": friction}
    return col.eccentric(a, b, restitution, **contact, **options)


# %% [markdown]
# ## Draw
#
# The seed lets others draw the same million. Bare arrays are in SI, which also saves parsing text
# at every call.

# %%
rng = np.random.default_rng(seed=8)
drawn = {
    "speed_a": rng.normal(50 * KMH, 8 * KMH, COUNT),
    "speed_b": rng.normal(30 * KMH, 6 * KMH, COUNT),
    "mass_a": rng.normal(1500.0, 40.0, COUNT),
    "mass_b": rng.normal(1250.0, 40.0, COUNT),
    "offset": rng.uniform(-0.6, 0.6, COUNT),
    "restitution": rng.normal(0.15, 0.075, COUNT),
    "friction": rng.uniform(0.3, 1.0, COUNT),
}

# %% [markdown]
# ## Solve
#
# `progress` takes a function, or `True` for a bar. `on_failure="nan"` says that refused cases are
# expected; without it, a single warning would give their number. `threads=2` would use two cores.


# %%
def quarters(done, total):
    """Say when another quarter is done."""
    if done * 4 // total > len(seen):
        seen.append(done)
        print(f"{done / total:.0%} done")


seen = []
started = time.perf_counter()
batch = crash(**drawn, on_failure="nan", progress=quarters)
delta_v = batch.b.delta_v
batch_time = (time.perf_counter() - started) / COUNT

singles = [
    {name: float(values[i]) for name, values in drawn.items()}
    for i in np.flatnonzero(batch.ok)[:1000]
]
started = time.perf_counter()
one_by_one = [crash(**single).b.delta_v for single in singles]
single_time = (time.perf_counter() - started) / len(singles)
print(
    f"here a case took {1e9 * batch_time:.0f} ns in the batch, "
    f"{1e6 * single_time:.0f} µs on its own"
)

# %% [markdown]
# ## Cases without an answer
#
# Such a case is NaN in every answer, and `status` says why. To leave these cases out is to say that
# they cannot have happened. Here that is true: the impact did happen, so A was the faster, and in
# such an impact the restitution is not negative.

# %%
for code, count in zip(*np.unique(batch.status, return_counts=True), strict=True):
    status = col.Status(code)
    print(f"{count:>8}  {count / COUNT:7.2%}  {status.label}")
    print(f"{'':>4}{status.sentence}")
answered = delta_v[batch.ok]
low, middle, high = np.quantile(answered, (0.025, 0.5, 0.975)) / KMH
print(
    f"delta-V of B: median {middle:.1f} km/h, "
    f"95 percent from {low:.1f} to {high:.1f} km/h"
)

# %% [markdown]
# ## The same by `propagate`
#
# `propagate` takes units, and draws points that are spread evenly, so that fewer are enough;
# `mean_standard_error` says how far off the mean may be. `truncate=` cuts off values that are
# impossible. The closing speed is not an input, so cases in which the cars separate remain, and a
# warning gives their number.

# %%
known = {
    "speed_a": Normal("50 km/h", "8 km/h"),
    "speed_b": Normal("30 km/h", "6 km/h"),
    "mass_a": Normal("1500 kg", "40 kg"),
    "mass_b": Normal("1250 kg", "40 kg"),
    "offset": Uniform("-60 cm", "60 cm"),
    "restitution": Normal(0.15, 0.075, truncate=(0, 1)),
    "friction": Uniform(0.3, 1.0),
}


def answers(**inputs):
    return {"delta-V of B": crash(**inputs, on_failure="nan").b.q.delta_v}


with warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter("always")
    started = time.perf_counter()
    result = propagate(answers, known, method="quasi_random", seed=8)
    took = time.perf_counter() - started
    print(f"{result.samples} cases in {took:.2f} s, and {caught[0].message}")
found = result["delta-V of B"]
median = found.q.quantile(0.5).m_as("km/h")
ends = " to ".join(f"{end.m_as('km/h'):.1f}" for end in found.q.interval(0.95))
print(f"delta-V of B: median {median:.1f} km/h, 95 percent from {ends} km/h")

axes = plot.distribution(found, units="metric")
edges = found.histogram().edges / KMH
percent = np.full(answered.size, 100 / answered.size)
style = {"histtype": "step", "color": "C1", "linewidth": 2, "label": "the million"}
axes.hist(answered / KMH, edges, weights=percent, **style)
legend = axes.legend(loc="upper right", fontsize="small")

# %% [markdown]
# ## Checks
#
# - Momentum, and angular momentum about the origin, are conserved in every case that has an answer.
#   They are some 1e4 in SI, and the rounding error of such sums is below 1e-9.
# - The closing speed is normal with mean 50 - 30 = 20 and standard deviation √(8² + 6²) = 10 km/h.
#   It is negative if it falls more than 2 standard deviations below its mean, which has a
#   probability of 0.02275 in any table. The same goes for the restitution. The number of refused
#   cases is within 4 standard deviations of a binomial count.
# - The mean closing speed of the cases that approach is that of a normal distribution cut off at 0,
#   in closed form. This mean, and the mean delta-V from `propagate`, agree with the batch within 4
#   standard errors.


# %%
def carried(a, b):
    """Linear momentum along x and y, and angular momentum about the origin."""
    turning = sum(
        v.yaw_inertia * v.yaw_rate + v.mass * (v.x * v.vy - v.y * v.vx) for v in (a, b)
    )
    along, across = a.mass * a.vx + b.mass * b.vx, a.mass * a.vy + b.mass * b.vy
    return np.array([along, across, turning])[:, batch.ok]


before = carried(batch.a.before, batch.b.before)
after = carried(batch.a.after, batch.b.after)
assert np.allclose(after, before, rtol=0, atol=1e-9)

table = 0.02275
expected = COUNT * (1 - (1 - table) ** 2)
assert abs(np.count_nonzero(~batch.ok) - expected) < 4 * math.sqrt(expected)
assert np.all(np.isnan(delta_v) == ~batch.ok)

density = math.exp(-(2.0**2) / 2) / math.sqrt(2 * math.pi)
closing = batch.closing_speed[batch.ok]
mean = (20 + 10 * density / (1 - table)) * KMH
standard_error = closing.std() / math.sqrt(closing.size)
assert abs(closing.mean() - mean) < 4 * standard_error
standard_error = math.hypot(
    found.mean_standard_error, answered.std() / math.sqrt(answered.size)
)
assert abs(found.mean - answered.mean()) < 4 * standard_error
print("all checks passed")

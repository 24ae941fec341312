# %% [markdown]
# # A million cases
#
# Every input of a rear-end impact is uncertain. The inputs are drawn a million times, and all the
# cases are solved in one call. This example shows what becomes of the cases that have no answer,
# how long a case takes, how a hundred million of them need no more memory than a few, and that
# `uncertainty.propagate` gets there with fewer.
#
# **The scene is invented.** A runs into the back of B, offset by up to 0.6 m, in traffic where
# either car may have been the faster.

# %%
import math
import time
import tracemalloc
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
def draw(count, seed):
    """So many values of every input."""
    rng = np.random.default_rng(seed)
    return {
        "speed_a": rng.normal(50 * KMH, 8 * KMH, count),
        "speed_b": rng.normal(30 * KMH, 6 * KMH, count),
        "mass_a": rng.normal(1500.0, 40.0, count),
        "mass_b": rng.normal(1250.0, 40.0, count),
        "offset": rng.uniform(-0.6, 0.6, count),
        "restitution": rng.normal(0.15, 0.075, count),
        "friction": rng.uniform(0.3, 1.0, count),
    }


drawn = draw(COUNT, seed=8)

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
# ## A hundred million
#
# A batch keeps its inputs and outputs, some 200 bytes a case, and `propagate` its samples. Where
# there are more cases than memory, draw a block, solve it, add its delta-V to the counts of a
# histogram, and forget it. Every block has a seed of its own, so that any of them can be drawn
# again, in whatever order and by whatever process; the counts are added up in the end. A quantile
# is known to the width of a bin, here 0.05 km/h. A hundred million cases are `BLOCKS = 2_000`, and
# need the memory of one block; shown are four.

# %%
BLOCK, BLOCKS = 50_000, 4
EDGES = np.linspace(0.0, 100.0, 2001) * KMH


def counted(blocks):
    """Delta-V of B in so many blocks, counted; the rest has no answer."""
    counts = np.zeros(EDGES.size - 1, dtype=np.int64)
    for number in range(blocks):
        block = crash(**draw(BLOCK, seed=(8, number)), on_failure="nan")
        counts += np.histogram(block.b.delta_v[block.ok], EDGES)[0]
    return counts


def most_memory(blocks):
    """The largest number of bytes that was held while so many blocks were counted."""
    tracemalloc.start()
    counted(blocks)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return most


counts = counted(BLOCKS)
streamed = np.interp(
    [0.025, 0.5, 0.975], np.cumsum(counts) / counts.sum(), EDGES[1:] / KMH
)
print(
    f"delta-V of B: median {streamed[1]:.1f} km/h, "
    f"95 percent from {streamed[0]:.1f} to {streamed[2]:.1f} km/h, "
    f"from {BLOCKS * BLOCK:,} cases in {BLOCKS} blocks"
)
more = most_memory(BLOCKS) / most_memory(2)
print(f"{BLOCKS} blocks need {more:.2f} times the memory of two")

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
# - The quantiles of the stream are those of the million within 4 standard errors and the width of a
#   bin, and every case that has an answer was counted. More blocks need no more memory.
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

assert more < 1.05
assert abs(BLOCKS * BLOCK - counts.sum() - expected * BLOCKS * BLOCK / COUNT) < 4 * (
    math.sqrt(expected * BLOCKS * BLOCK / COUNT)
)
sigma = answered.std() / KMH
for share, value in zip((0.025, 0.5, 0.975), streamed, strict=True):
    # The density at a quantile, from the million: how often a case lies near it.
    near = np.mean(np.abs(answered / KMH - value) < 0.1 * sigma) / (0.2 * sigma)
    standard_error = math.sqrt(share * (1 - share) / counts.sum()) / near
    wanted = np.quantile(answered, share) / KMH
    assert abs(value - wanted) < 4 * standard_error + 0.05

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

# %% [markdown]
# # A large study with dask
#
# A study like "A large study over several processes", for those who use dask: `delayed` puts solver
# calls into a graph, and dask runs them on threads, on processes or on a cluster. Each block is an
# ordinary batch; vehicles and outputs are passed as pickles. Reading the outputs is a step of the
# graph, so that no impact, which holds all its inputs and every output, leaves its worker. The
# steps that follow, here three quantiles, are part of the graph, too. The answers are those of one
# batch in one process, to the last bit.

# %%
from operator import attrgetter

import dask
import numpy as np

import collisions as col

CASES, BLOCK = 60_000, 20_000


# %% [markdown]
# Speeds, restitution and friction of a rear-end collision with an offset are drawn before the work
# is divided.


# %%
def drawn(cases, seed):
    """Front and rear car, restitution and friction of every case."""
    rng = np.random.default_rng(seed)
    rear = {
        "mass": 1500.0,
        "yaw_inertia": 2400.0,
        "x": -2.0,
        "y": 0.4,
        "vx": rng.normal(15.0, 1.0, cases),
    }
    front = {
        "mass": 1200.0,
        "yaw_inertia": 1700.0,
        "x": 2.0,
        "y": 0.0,
        "vx": rng.uniform(0.0, 5.0, cases),
    }
    return rear, front, rng.uniform(0.0, 0.3, cases), rng.uniform(0.2, 0.7, cases)


def part(values, block):
    """The cases of one block, from a vehicle or an array."""
    if isinstance(values, dict):
        return col.Vehicle(
            **{name: part(value, block) for name, value in values.items()}
        )
    return values[block] if isinstance(values, np.ndarray) else values


NAMES = (
    "status",
    "normal_impulse",
    "tangential_impulse",
    "energy_loss",
    "b.delta_v",
    "b.delta_yaw_rate",
)
outputs = attrgetter(*NAMES)
SCENE = {"normal": 0.0, "point": (0.0, 0.2), "on_failure": "nan"}
whole = slice(None)

# %% [markdown]
# The line with `__main__` is for processes, which import this file anew. The workers need nothing
# from it: the task is a function of the library.

# %%
if __name__ == "__main__":
    rear, front, restitution, friction = drawn(CASES, seed=8)
    tasks = [
        dask.delayed(outputs)(
            dask.delayed(col.eccentric)(
                part(rear, block),
                part(front, block),
                restitution[block],
                friction=friction[block],
                **SCENE,
            )
        )
        for block in (slice(start, start + BLOCK) for start in range(0, CASES, BLOCK))
    ]
    quantiles = dask.delayed(np.quantile)(
        dask.delayed(np.concatenate)(
            [task[NAMES.index("b.delta_v")] for task in tasks]
        ),
        [0.05, 0.5, 0.95],
    )
    on_threads = dask.compute(*tasks, scheduler="threads", num_workers=2)
    *on_processes, found = dask.compute(
        *tasks, quantiles, scheduler="processes", num_workers=2
    )
    low, middle, high = found * 3.6
    print(
        f"delta-V of the front car: {middle:.1f} km/h, "
        f"9 of 10 cases from {low:.1f} to {high:.1f} km/h"
    )

# %% [markdown]
# ## Checks
#
# The answers agree bit for bit: every case is worked out by itself, whatever block, thread or
# process it is in.

# %%
if __name__ == "__main__":
    one = col.eccentric(
        part(rear, whole), part(front, whole), restitution, friction=friction, **SCENE
    )
    for way, blocks in (("threads", on_threads), ("processes", on_processes)):
        for name, *parts, column in zip(NAMES, *blocks, outputs(one), strict=True):
            if not np.array_equal(np.concatenate(parts), column):
                raise AssertionError(f"{name} differs on {way}")
    if not np.array_equal(found, np.quantile(one.b.delta_v, [0.05, 0.5, 0.95])):
        raise AssertionError("the quantiles differ")
    print("all checks passed")

# %% [markdown]
# # A large study over several processes
#
# A hundred thousand side impacts with drawn speeds, masses and contact points are solved in blocks
# by worker processes. Every block is an ordinary batch. The workers send back the outputs that the
# study reads, not the impacts, which hold all their inputs and every output. They need nothing from
# this file, so the same lines run in a script, in a notebook and where processes are started by
# spawn. At the end the blocks are compared with one batch in one process: they are the same to the
# last bit.

# %%
import multiprocessing
import os
import pickle
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from operator import attrgetter

import numpy as np

import collisions as col

CASES, BLOCK = 100_000, 20_000


# %% [markdown]
# Every case is drawn before the work is divided, so the study does not depend on the number of
# blocks or workers.


# %%
def drawn(cases, seed):
    """Both vehicles, the restitution and the contact point of every case."""
    rng = np.random.default_rng(seed)
    a = {
        "mass": rng.normal(1500.0, 100.0, cases),
        "vx": rng.normal(14.0, 1.0, cases),
        "yaw_inertia": rng.normal(2400.0, 150.0, cases),
        "x": np.full(cases, -2.0),
        "y": rng.uniform(-0.5, 0.5, cases),
    }
    b = {
        "mass": rng.normal(1200.0, 80.0, cases),
        "vy": rng.normal(11.0, 1.0, cases),
        "yaw_inertia": rng.normal(1700.0, 100.0, cases),
        "x": np.full(cases, 0.8),
        "y": rng.uniform(-1.5, 0.0, cases),
    }
    return a, b, rng.uniform(0.0, 0.3, cases)


def vehicles(fields, blocks):
    """One vehicle for each block, each holding many cases."""
    return [
        col.Vehicle(**{name: values[block] for name, values in fields.items()})
        for block in blocks
    ]


# %% [markdown]
# The options that all cases share are bound to the solver by `partial`. A refused case is NaN with
# a status, as in any batch. `attrgetter` names the outputs. A `map` that nobody has read is a
# recipe: it travels to a worker as functions and inputs, and `list` carries it out there. Where
# processes are started by spawn, each of them imports this file anew, and the line with `__main__`
# keeps it from starting the study again.

# %%
solve = partial(
    col.eccentric, normal=0.0, point=(0.0, 0.0), friction=0.5, on_failure="nan"
)
NAMES = (
    "status",
    "regime",
    "energy_loss",
    "a.delta_v",
    "b.delta_v",
    "b.delta_yaw_rate",
)
outputs = attrgetter(*NAMES)

if __name__ == "__main__":
    a, b, restitution = drawn(CASES, seed=8)
    blocks = [slice(start, start + BLOCK) for start in range(0, CASES, BLOCK)]
    context = multiprocessing.get_context("spawn")
    workers = min(2, os.cpu_count() or 1)
    with ProcessPoolExecutor(workers, mp_context=context) as executor:
        recipes = [
            map(outputs, map(solve, [one], [other], [restitution[block]]))
            for one, other, block in zip(
                vehicles(a, blocks), vehicles(b, blocks), blocks, strict=True
            )
        ]
        found = [part for (part,) in executor.map(list, recipes)]

    columns = {
        name: np.concatenate(parts)
        for name, parts in zip(NAMES, zip(*found, strict=True), strict=True)
    }
    delta_v = columns["a.delta_v"]
    low, middle, high = np.quantile(delta_v, [0.025, 0.5, 0.975]) * 3.6
    print(
        f"delta-V of A: {middle:.1f} km/h, "
        f"95 of 100 cases from {low:.1f} to {high:.1f} km/h"
    )
    sticking = np.mean(columns["regime"] == "sticking")
    print(f"{sticking:.0%} of the contacts stop slipping")

# %% [markdown]
# ## Checks
#
# The answers agree bit for bit, because every case is worked out by itself: what else is in its
# block makes no difference.

# %%
if __name__ == "__main__":
    whole = solve(col.Vehicle(**a), col.Vehicle(**b), restitution)
    compared = [
        np.array_equal(columns[name], one)
        for name, one in zip(NAMES, outputs(whole), strict=True)
    ]
    if not all(compared):
        raise AssertionError("the answers of the blocks differ from those of the whole")
    if not whole.ok.all():
        raise AssertionError("a case of this study was refused")
    print(f"{len(compared)} columns of {CASES:,} cases, the same to the last bit")
    sent, impact = len(pickle.dumps(found)), len(pickle.dumps(whole))
    if not sent < impact / 2:
        raise AssertionError("the outputs are no smaller than half of the impact")
    print(f"the workers sent {sent / impact:.0%} of what the impacts would have been")
    print("all checks passed")

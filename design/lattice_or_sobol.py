"""Which evenly spread points should ``propagate`` draw: Latin hypercube, Sobol', or a lattice,
folded or not?

    python design/lattice_or_sobol.py

The delta-V and the yaw rate of a car struck from the side, eight inputs, 4096 cases. An error is
the root of the mean square over 32 seeds, in standard deviations of the output, against a million
points of the folded lattice with a seed of its own. Sobol' points are those of scipy, scrambled,
where it is installed. What each design costs and how often its intervals hold the truth is measured
in ``benchmarks/uncertainty.py``.

What it showed: mean and deviation of delta-V are off by 1.2e-2 and 1.1e-2 with independent points,
6.5e-4 and 9.3e-3 with Latin hypercubes, 4.3e-4 and 2.4e-3 with Sobol' points, 1.8e-3 and 6.3e-3
with the lattice as it is and 1.5e-4 and 3.1e-3 folded; the yaw rate alike. Decided: the folded
lattice. It is about as good as Sobol' points, its only table is one number for each input, and a
point is found from its place alone, so blocks, threads and interrupts change no bit.
"""

from importlib import import_module

import numpy as np
from measuring import QUICK, speed

from collisions.uncertainty import designs
from collisions.uncertainty.normal import quantile

scenes = import_module("uncertainty_scenes")
SEEDS, LENGTH = (4, 64) if QUICK else (32, 4096 // designs.REPLICATES)
REFERENCE = 2**10 if QUICK else 2**16


def design(name):
    """Points (dimensions, cases) of a design of the package."""
    return lambda d, seed, length: designs.DESIGNS[name](d, seed, length)(0, length).reshape(d, -1)


def unfolded(d, seed, length):
    """The lattice without the tent map."""
    shift = np.random.default_rng(seed).random((d, 1, designs.REPLICATES))
    place = np.arange(length).reshape(1, -1, 1) / length
    return (
        (place * np.array(designs._VECTOR[:d], dtype=float).reshape(d, 1, 1) + shift) % 1.0
    ).reshape(d, -1)


def sobol(d, seed, length):
    """Scrambled Sobol' points, as many sequences side by side."""
    qmc = import_module("scipy.stats.qmc")
    found = [
        qmc.Sobol(d, rng=np.random.default_rng([seed, k])).random(length)
        for k in range(designs.REPLICATES)
    ]
    return np.clip(np.concatenate(found).T, 2.0**-53, 1.0 - 2.0**-53)


def answers(made):
    """Delta-V and yaw rate at points of the unit cube; bounds of the inputs are left out, they are
    five deviations away.
    """
    given = {
        name: x.mean + x.sd * quantile(row)
        for (name, x), row in zip(scenes.SIDE.items(), made, strict=True)
    }
    found = scenes.t_bone(**given)
    return found.b.delta_v, found.b.delta_yaw_rate


def figures(made):
    """Mean and standard deviation of each output."""
    return np.array([[x.mean(), x.std()] for x in answers(made)])


if __name__ == "__main__":
    ways = {name: design(name) for name in designs.DESIGNS}
    ways["the lattice without the tent map"] = unfolded
    if speed.speed_rivals.installed("scipy") is not None:
        ways["Sobol', scrambled (scipy)"] = sobol
    d = len(scenes.SIDE)
    true = figures(design("quasi_random")(d, 10_000, REFERENCE))
    print(
        f"{LENGTH * designs.REPLICATES} cases:       delta-V: mean, deviation      yaw rate: "
        "mean, deviation"
    )
    for name, way in ways.items():
        off = np.array(
            [(figures(way(d, seed, LENGTH)) - true) / true[:, 1:] for seed in range(SEEDS)]
        )
        worst = np.sqrt((off**2).mean(axis=0))
        print(f"  {name:34s}" + "".join(f"  {value:9.1e}" for value in worst.reshape(-1)))

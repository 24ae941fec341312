"""What a typed caller writes; checked by mypy --strict, never run."""

import numpy as np
import pint

import collisions as col

a = col.Vehicle(mass="1100 kg", vx=pint.Quantity(80, "km/h"), x=0, y=np.float64(0.0), yaw_inertia=1800)
b = col.Vehicle(mass=950.0, vx=np.array([1.0, 2.0]))


def speed_after(restitution: float) -> float:
    impact = col.linear_central(a, b, restitution)
    return impact.a.after.vx * 3.6


def mean_loss() -> float:
    impact = col.eccentric(a, b, 0.1, normal=(1, 0), point=("1 m", 0.0), friction=0.5, law="kudlich-slibar", threads=2)
    total: float = impact.energy_loss.mean() + impact.a.delta_v[0]
    return total

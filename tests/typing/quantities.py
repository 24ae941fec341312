"""Quantities of pint itself, whose own types leave too much open for the strict mode of pyright;
never run.
"""

import numpy as np
import pint

import collisions as col

ureg: "pint.UnitRegistry[float]" = pint.UnitRegistry()
speed = pint.Quantity(80, "km/h")
many = pint.Quantity(np.array([10.0, 20.0]), "mph")

a = col.Vehicle(
    mass=ureg.Quantity(1500, "kg"),
    vx=speed,
    x=0.0,
    y=0.0,
    yaw_inertia=2400.0,
    pivot=pint.Quantity([1.0, 0.0], "m"),
)
b = col.Vehicle.from_speed(mass=1200.0, speed=many, course=pint.Quantity(90, "deg"))
impact = col.eccentric(
    a, b, 0.1, normal=pint.Quantity(30, "deg"), point=(pint.Quantity(1, "ft"), 0.0), friction=0.5
)
loss: "pint.Quantity[float]" = impact.q.energy_loss

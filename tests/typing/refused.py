"""What a type checker must refuse; every line that ends in "refused" has an error, and no other
line has one.
"""

# pyright: reportUnnecessaryComparison=true
# as in its strict mode

import collisions as col
from collisions import reconstruct, travel, uncertainty

a = col.Vehicle(mass=1500.0, vx=10.0, yaw_inertia=2400.0, x=-2.0, y=0.0)
b = col.Vehicle(mass="1200 kg", yaw_inertia=1700.0, x=2.0, y=0.0)
impact = col.linear_central(a, b, 0.1)

col.Vehicle(1500.0)  # refused
col.Vehicle(vx=10.0)  # refused
col.Vehicle(mass=1500.0, velocity=10.0)  # refused
col.Vehicle(mass=None)  # refused
col.Vehicle(mass=1500.0, vx=1j)  # refused
col.Vehicle(mass=1500.0, pivot=1.0)  # refused
col.Vehicle(mass=1500.0, name=3)  # refused
col.Vehicle.from_speed(mass=1500.0, speed=10.0)  # refused
a.point(2.0, 0.5)  # refused
a.mass = 1600.0  # refused
print(a.velocity)  # refused
print(a.q.velocity)  # refused
print(impact.q.b.after.delta_v)  # refused
print(impact.a.q.deltav)  # refused
travel.q.speed("60 ft")  # refused

col.linear_central(a, 1200.0, 0.1)  # refused
col.linear_central(a, b)  # refused
col.linear_central(a, b, 0.1, friction=0.5)  # refused
col.linear_central(a, b, 0.1, on_failure="ignore")  # refused
col.oblique_central(a, b, 0.1, friction=0.5)  # refused
col.eccentric(a, b, 0.1, normal=0.0, friction=0.5)  # refused
col.eccentric(a, b, 0.1, normal=0.0, point=1.0, friction=0.5)  # refused
col.eccentric(a, b, 0.1, normal=0.0, point=(0.0, 0.0), friction=0.5, law="newton")  # refused
col.eccentric(a, b, 0.1, normal=0.0, point=(0.0, 0.0), mu=0.5)  # refused
col.solve(a, b, 0.1, normal=0.0, point=(0.0, 0.0), friction=0.5, tolerance=None)  # refused

print(impact.kind == "elastik")  # refused
print(impact.regime == "stiking")  # refused
print(impact.regime != "slidding")  # refused
print(impact.model == "excentric")  # refused
print(impact.law == "newton")  # refused
print(impact.status == col.Status.SEPERATING)  # refused
print(impact.choice is not None and impact.choice.model == "linear")  # refused

impact.closing_speed = 3.0  # refused
print(impact.delta_v)  # refused
impact.ees()  # refused
print(impact.a.after.delta_v)  # refused
col.Impact.from_dict("a record")  # refused
text: str = impact.energy_loss  # refused

reconstruct.planar(
    a,
    b,
    normal=0.0,
    point=(0.0, 0.0),
    restitution=0.1,
    friction=0.5,
    law="brah",  # refused
)
reconstruct.planar(
    a,
    b,
    normal=0.0,
    point=(0.0, 0.0),
    restitution=0.1,
    friction=0.5,
    regime="stiking",  # refused
)
col.explain(impact, form="html")  # refused
col.report(impact, form="pdf")  # refused
col.diagnose(a)  # refused
col.explain(impact, units="imperial")  # refused
reconstruct.central(1500.0, 1200.0, 10.0, 0.0, 0.1)  # refused
reconstruct.momentum(1500.0)  # refused
travel.speed("12 m")  # refused
uncertainty.Normal()  # refused

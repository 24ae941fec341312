"""Work and energy before and after the impact: speed, distance and time of a vehicle that slows
over known ground; and how fast somebody was thrown.

``drag`` is the deceleration on the level as a fraction of gravity, ``grade`` the rise over the run,
positive uphill in the direction of travel. Distances are measured in plan, as on a scene diagram;
speeds are along the slope, and times are for the length of the slope. A tape laid on the slope
reads longer by a factor of ``sqrt(1 + grade**2)``: 0.5 % at a grade of 10 %.

Worksheets in US units give the speed in mph as sqrt(30 f d), with d in feet. The constant for
standard gravity is 29.914, so their speeds are 0.14 % higher than these; those of worksheets that
use 32.2 ft/s2 are 0.04 % higher.

Results are SI floats. ``travel.q.speed`` and the others of ``travel.q`` give them as Quantities.
"""

from ..quantities.attributes import in_quantities
from ..vehicle.drag import GRAVITY
from ..vehicle.tyres import Tyres
from .run_out import RunOut, path
from .simulate import SimulatedPath, simulate
from .straight import distance, speed, time
from .thrown import throw_bounds, throw_speed


class q:
    """The functions of this module that return a number, returning it as a Quantity.

    Examples
    --------
    >>> from collisions import travel
    >>> print(f"{travel.q.speed('60 ft', drag=0.7).to('mph'):.1f~P}")
    35.4 mph
    """

    speed = staticmethod(in_quantities(speed, "m/s"))
    distance = staticmethod(in_quantities(distance, "m"))
    throw_bounds = staticmethod(in_quantities(throw_bounds, "m/s"))
    throw_speed = staticmethod(in_quantities(throw_speed, "m/s"))
    time = staticmethod(in_quantities(time, "s"))


__all__ = [
    "GRAVITY",
    "RunOut",
    "SimulatedPath",
    "Tyres",
    "distance",
    "path",
    "simulate",
    "speed",
    "throw_bounds",
    "throw_speed",
    "time",
]

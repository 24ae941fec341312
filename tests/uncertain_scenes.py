"""Models of uncertain scenes, and their inputs drawn by numpy's own generators: nothing here is
drawn by the package.
"""

import numpy as np

import collisions as col
from collisions import reconstruct, travel
from collisions.uncertainty import LogNormal, Normal, Triangular, Uniform


def rear_end(speed, restitution, mass_a):
    """A car driven into one that stands."""
    a, b = col.Vehicle(mass=mass_a, vx=speed), col.Vehicle(mass=1200.0)
    impact = col.linear_central(a, b, restitution, on_failure="nan")
    return {"delta_v": impact.b.delta_v, "energy_loss": impact.energy_loss}


def stick_slip(speed_a, speed_b, friction, restitution):
    """A side impact whose contact sticks in some cases and slides in others."""
    a = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=-2.2, y=0.0, vx=speed_a)
    b = col.Vehicle(mass=1300.0, yaw_inertia=2100.0, x=0.9, y=-0.4, vy=speed_b)
    impact = col.eccentric(
        a, b, restitution, normal=0.0, point=(0.0, 0.0), friction=friction, on_failure="nan"
    )
    return {"yaw": impact.b.after.yaw_rate, "delta_v": impact.b.delta_v}


def chain(drag, length, course_after, mass_a, mass_b):
    """Speeds before a right-angled impact, from the marks to rest by way of travel and momentum."""
    after = travel.speed(length, drag=drag)
    found = reconstruct.momentum(
        mass_a,
        mass_b,
        course_a=0.0,
        course_b=0.5 * np.pi,
        course_a_after=course_after,
        speed_a_after=after,
        together=True,
        on_failure="nan",
    )
    return {"speed_a": found.speed_a, "speed_b": found.speed_b}


def truncated(mean, sd, low, high=np.inf):
    """A normal drawn anew wherever it lies outside."""

    def draw(generator, count):
        found = mean + sd * generator.standard_normal(count)
        while (outside := (found < low) | (found > high)).any():
            found[outside] = mean + sd * generator.standard_normal(np.count_nonzero(outside))
        return found

    return draw


def lognormal(mean, sd):
    variance = np.log1p((sd / mean) ** 2)
    return lambda generator, count: np.exp(
        np.log(mean) - 0.5 * variance + np.sqrt(variance) * generator.standard_normal(count)
    )


def triangular(low, mode, high):
    """Two uniform numbers: their sum, stretched to each side of the mode."""

    def draw(generator, count):
        away = generator.uniform(size=count) + generator.uniform(size=count) - 1.0
        share = (mode - low) / (high - low)
        side = np.where(generator.uniform(size=count) < share, low - mode, high - mode)
        return mode + side * np.abs(away)

    return draw


# By scene the model, the inputs as they are stated, and how each is drawn by numpy.
SCENES = {
    "rear_end": (
        rear_end,
        {
            "speed": Normal(8.0, 0.4),
            "restitution": Normal(0.15, 0.12, truncate=(0.0, 1.0)),
            "mass_a": Uniform(1450.0, 1600.0),
        },
        {
            "speed": lambda generator, count: 8.0 + 0.4 * generator.standard_normal(count),
            "restitution": truncated(0.15, 0.12, 0.0, 1.0),
            "mass_a": lambda generator, count: generator.uniform(1450.0, 1600.0, count),
        },
    ),
    "stick_slip": (
        stick_slip,
        {
            "speed_a": Normal(15.0, 0.8),
            "speed_b": Normal(10.0, 0.8),
            "friction": LogNormal(0.45, 0.12),
            "restitution": Triangular(0.0, 0.1, 0.3),
        },
        {
            "speed_a": lambda generator, count: 15.0 + 0.8 * generator.standard_normal(count),
            "speed_b": lambda generator, count: 10.0 + 0.8 * generator.standard_normal(count),
            "friction": lognormal(0.45, 0.12),
            "restitution": triangular(0.0, 0.1, 0.3),
        },
    ),
    "chain": (
        chain,
        {
            "drag": Normal(0.7, 0.05, truncate=(0.3, None)),
            "length": Normal("18 m", "0.5 m"),
            "course_after": Normal("35 deg", "3 deg"),
            "mass_a": Normal(1500.0, 40.0),
            "mass_b": Normal(1200.0, 40.0),
        },
        {
            "drag": truncated(0.7, 0.05, 0.3),
            "length": lambda generator, count: 18.0 + 0.5 * generator.standard_normal(count),
            "course_after": lambda generator, count: np.radians(
                35.0 + 3.0 * generator.standard_normal(count)
            ),
            "mass_a": lambda generator, count: 1500.0 + 40.0 * generator.standard_normal(count),
            "mass_b": lambda generator, count: 1200.0 + 40.0 * generator.standard_normal(count),
        },
    ),
}

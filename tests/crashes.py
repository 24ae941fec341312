"""Whole crashes that several tests draw, play, report and explain."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np

import collisions as col
from collisions.scene import Contact, Mover, Run, Scene
from collisions.travel import Tyres

NAMES = ("Camry", "Civic", "Truck")


@functools.cache
def three_cars() -> Run:
    """A car strikes another from the side, which is pushed into a parked truck over a slippery
    patch, and is run into again.
    """
    camry = col.Vehicle(
        mass="3400 lb", yaw_inertia=2600, x=-2.6, y=0.2, heading="0 deg", vx="40 mph"
    )
    civic = col.Vehicle(mass="2750 lb", yaw_inertia=1900, x=1, y=1, heading="90 deg", vy="20 mph")
    truck = col.Vehicle(mass="6 t", yaw_inertia=25000, x=8, y=11, heading="90 deg")
    locked = [1, 0.05, 0.05, 0.05]
    again = {"restitution": 0.1, "friction": 0.5}
    return Scene(
        movers={
            "Camry": Mover(camry, outline=(4.8, 1.8), tyres=Tyres(0.7, locked, 2.78, 1.55)),
            "Civic": Mover(civic, outline=(4.5, 1.7), tyres=Tyres(0.7, 0.3, 2.62, 1.48)),
            "Truck": Mover(truck, outline=(6.2, 2.3), tyres=Tyres(0.7, 1, 3.6, 1.8)),
        },
        contacts=[
            Contact("Camry", "Civic", normal=0, point=(0, 0.3), **again),
            Contact("Civic", "Truck", restitution=0.2, friction=0.4, at="touch"),
            Contact("Camry", "Civic", at="touch", **again),
        ],
        surfaces=[([(2, 4), (8, 4), (8, 9), (2, 9)], 0.3)],
    ).run()


def coasting() -> Run:
    """Two cars in line without outlines that nothing slows."""
    a = col.Vehicle(mass=1500, x=-2, y=0, heading=0, vx=10)
    b = col.Vehicle(mass=1000, x=2, y=0, heading=0)
    contact = Contact("<A & co>", "B", restitution=0.0, normal=0, model="linear_central")
    return Scene(movers={"<A & co>": Mover(a), "B": Mover(b)}, contacts=[contact]).run()


def over_ice() -> Run:
    """A car whose brakes lock its wheels on a strip of ice of 0.4 m alone."""
    car = col.Vehicle(mass=1500.0, yaw_inertia=2500.0, x=0.0, y=0.0, heading=0.0, vx=25.0)
    ice = [([(30.05, -5), (30.45, -5), (30.45, 5), (30.05, 5)], 0.1)]
    mover = Mover(car, tyres=Tyres(0.7, 0.3, 2.7, 1.5))
    return Scene(movers={"A": mover}, contacts=[], surfaces=ice).run()


def furthest_from(x: Any, y: Any, places: Any) -> float:
    """How far the furthest of these places (2, n) is from the line through x and y, which NaN
    interrupts.
    """
    line = np.array([x, y])
    begin, along = line[:, :-1, None], np.diff(line)[..., None]
    length = np.sum(along * along, axis=0)
    apart = places[:, None] - begin
    share = np.clip(np.sum(apart * along, axis=0) / np.where(length > 0.0, length, 1.0), 0.0, 1.0)
    return float(np.max(np.nanmin(np.hypot(*(apart - share * along)), axis=0)))

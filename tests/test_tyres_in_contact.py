"""Tyres that roll, brake and steer during a contact: against scipy's integration, written from the definitions."""

import json
import math
import pickle

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar

import collisions as col
from collisions.travel import Tyres

GRAVITY = 9.80665
ROLLING = Tyres(0.7, 0.02, 2.7, 1.5)
STRUCK = Tyres(0.7, 0.0, 2.6, 1.5)
CONTACT = {"normal": 0.0, "point": (0.0, 0.0), "friction": 0.3}


class Integrated:
    """A contact with a linear spring and four wheels a vehicle, as ordinary differential equations; complex numbers are vectors.

    The wheels are those of the definition: rolling until the brake can hold them, Fiala's side force, the friction circle.
    Friction at the contact turns round within 1 mm/s of slip, the force of a wheel within 1 cm/s of its motion.
    """

    def __init__(self, a, b, e, contact, stiffness, tyres):
        self.bodies, self.e, self.k, self.tyres = (a, b), e, stiffness, tyres
        self.mu, self.n = contact["friction"], complex(math.cos(contact["normal"]), math.sin(contact["normal"]))
        self.on = [complex(*contact["point"]) - complex(body.x, body.y) for body in (a, b)]

    def wheels(self, label, turn, v, w):
        """Force and moment of the wheels of one vehicle."""
        body, tyres = self.bodies[label], self.tyres[label]
        if tyres is None:
            return 0.0, 0.0
        force, moment = 0.0, 0.0
        ahead = turn * complex(math.cos(body.heading), math.sin(body.heading))
        load = body.mass * GRAVITY / 4.0
        for x, y, lock in zip((1, 1, -1, -1), (1, -1, 1, -1), tyres.locks, strict=True):
            place = ahead * complex(0.5 * x * tyres.wheelbase, 0.5 * y * tyres.track)
            axis = ahead * complex(math.cos(tyres.steer), math.sin(tyres.steer)) if x > 0 else ahead
            slip = (v + 1j * w * place) / axis
            speed = abs(slip)
            if speed == 0.0:
                continue
            soft = math.tanh(speed / 0.01)
            along = -math.copysign(min(lock, abs(slip.real) / speed), slip.real)
            z = 1.0
            if slip.real != 0.0:
                z = min(1.0, tyres.cornering * abs(slip.imag / slip.real) / (3.0 * tyres.friction))
            across = -math.copysign(min(math.sqrt(1.0 - along**2), 1.0 - (1.0 - z) ** 3), slip.imag)
            pull = tyres.friction * load * soft * complex(along, across) * axis
            force, moment = force + pull, moment + (place.conjugate() * pull).imag
        return force, moment

    def geometry(self, s):
        """Turns of both, contact point, normal, closing speed and slip."""
        turns = [complex(math.cos(s[at + 5]), math.sin(s[at + 5])) for at in (0, 6)]
        points = [complex(s[at + 3], s[at + 4]) + turn * on for at, turn, on in zip((0, 6), turns, self.on, strict=True)]
        middle, normal = 0.5 * sum(points), self.n * complex(math.cos(0.5 * (s[5] + s[11])), math.sin(0.5 * (s[5] + s[11])))
        at = [
            complex(s[i], s[i + 1]) + 1j * s[i + 2] * (middle - complex(s[i + 3], s[i + 4])) for i in (0, 6)
        ]
        relative = (at[1] - at[0]) / normal
        return turns, middle, normal, -relative.real, relative.imag

    def rates(self, s, force):
        turns, middle, normal, closing, slip = self.geometry(s)
        push = force * complex(1.0, -self.mu * math.tanh(slip / 1e-3)) * normal
        found = []
        for label, sign in ((0, -1.0), (1, 1.0)):
            i, body = 6 * label, self.bodies[label]
            pull, moment = self.wheels(label, turns[label], complex(s[i], s[i + 1]), s[i + 2])
            arm = middle - complex(s[i + 3], s[i + 4])
            total = sign * push + pull
            spin = (sign * (arm.conjugate() * push).imag + moment) / body.yaw_inertia
            found += [total.real / body.mass, total.imag / body.mass, spin, s[i], s[i + 1], s[i + 2]]
        return [*found, closing]

    def run(self):
        """Change of velocity (vx, vy, yaw rate) of A and of B."""
        start = [p for body in self.bodies for p in (body.vx, body.vy, body.yaw_rate, body.x, body.y, 0.0)] + [0.0]
        options = {"method": "LSODA", "rtol": 1e-9, "atol": 1e-10, "max_step": 1e-3}

        def together(t, s):
            return self.geometry(s)[3]

        together.terminal = True
        first = solve_ivp(lambda t, s: self.rates(s, self.k * s[12]), (0.0, 1.0), start, events=together, **options)
        assert first.status == 1
        deepest = first.y[12, -1]

        def back(s):
            return self.k / self.e**2 * (s[12] - (1.0 - self.e**2) * deepest)

        def apart(t, s):
            return back(s)

        apart.terminal = True
        last = solve_ivp(lambda t, s: self.rates(s, back(s)), (0.0, 1.0), first.y[:, -1], events=apart, **options)
        assert last.status == 1
        end = last.y[:, -1]
        return np.array([end[at + i] - start[at + i] for at in (0, 6) for i in range(3)])


def car(vx, vy, x, y, heading, mass=1500.0, yaw_rate=0.0):
    return col.Vehicle(
        mass=mass, yaw_inertia=1.7 * mass, vx=vx, vy=vy, x=x, y=y, heading=math.radians(heading), yaw_rate=yaw_rate
    )


SCENES = {
    "T-bone, both roll": (car(9.0, 0, -2.2, 0.1, 0), car(0, 12.0, 0.8, -1.0, 90, 1200.0), ROLLING, STRUCK),
    "T-bone, struck at rest": (car(8.0, 0, -2.2, 0.0, 0), car(0, 0, 0.8, -0.9, 90, 1200.0), ROLLING, STRUCK),
    "T-bone, slow": (car(5.0, 0, -2.2, 0.1, 0), car(0, 8.0, 0.8, 0.6, 90, 1300.0), ROLLING, STRUCK),
    "T-bone, striking car brakes and steers": (
        car(9.0, 0, -2.2, 0.1, 0),
        car(0, 10.0, 0.8, -0.5, 90, 1200.0),
        Tyres(0.7, [0.6, 0.6, 0.3, 0.3], 2.7, 1.5, steer="10 deg"),
        STRUCK,
    ),
    "oblique, one wheel locked": (
        car(12.0, 1.0, -2.0, 0.5, 5),
        car(-4.0, 6.0, 1.5, -0.6, 120, 1100.0),
        Tyres(0.8, [1, 0, 0, 0], 2.7, 1.5),
        STRUCK,
    ),
    "only A has tyres": (car(9.0, 0, -2.2, 0.1, 0), car(0, 9.0, 0.8, -1.0, 90), Tyres(0.7, 1, 2.7, 1.5), None),
}


def far(found, wanted, a, b):
    """How far apart for the worse vehicle, over its own change: delta-V, and yaw rate by the radius of gyration."""
    shares = []
    for at, body in ((0, a), (3, b)):
        scale = np.array([1.0, 1.0, math.sqrt(body.yaw_inertia / body.mass)])
        shares.append(np.linalg.norm((found[at : at + 3] - wanted[at : at + 3]) * scale) / np.linalg.norm(wanted[at : at + 2]))
    return max(shares)


def changes(impact):
    return np.array([p for side in (impact.a, impact.b) for p in (side.delta_vx, side.delta_vy, side.delta_yaw_rate)])


@pytest.mark.parametrize("name", SCENES)
def test_against_scipy(name):
    """Within 0.5 % of delta-V at the usual 100 steps; the same with 400 steps to a quarter of that."""
    a, b, tyres_a, tyres_b = SCENES[name]
    wanted = Integrated(a, b, 0.2, CONTACT, 4e5, (tyres_a, tyres_b)).run()
    found = {}
    for steps in (100, 400):
        found[steps] = col.time_resolved(
            a, b, 0.2, **CONTACT, stiffness=4e5, tyres_a=tyres_a, tyres_b=tyres_b, geometry="first_contact", steps=steps
        )
    assert far(changes(found[100]), wanted, a, b) < 5e-3
    assert far(changes(found[400]), wanted, a, b) < 1.25e-3

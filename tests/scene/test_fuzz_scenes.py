"""Fuzzed scenes of two to four vehicles: a run in order or a refusal, and nothing foreign.

Each seed is one scene. ``COLLISIONS_FUZZ_CASES`` is the number of them (``100000``) or a range
(``50000:100000``), without it a few. A failure names its seed. Every public name with anything at
all is in ``project/test_fuzz_names.py``; here the numbers are those of crashes and their limits.
"""

from __future__ import annotations

import math
import os
import random
import warnings
from collections import Counter
from typing import Any

import numpy as np
import pytest

import collisions as col
from collisions.scene import Contact, Mover, Run, Scene
from collisions.travel import Tyres

_FEW = 60
# Cases of a batch.
_CASES = 3


def seeds() -> range:
    """The scenes of this run."""
    first, _, last = os.environ.get("COLLISIONS_FUZZ_CASES", str(_FEW)).rpartition(":")
    return range(int(first or 0), int(last))


class Drawn(random.Random):
    """Numbers of one scene; in some scenes arrays, and in some of them ends of what can be."""

    def __init__(self, seed: int) -> None:
        super().__init__(seed)
        self.many = self.random() < 0.1
        self.extreme = self.random() < 0.2

    def number(self, low: float, high: float, *special: float) -> Any:
        """One between both, now and then a special one, or one for each case."""
        if self.many and self.random() < 0.3:
            return np.array([self.one(low, high, *special) for _ in range(_CASES)])
        return self.one(low, high, *special)

    def one(self, low: float, high: float, *special: float) -> float:
        """A single number."""
        if special and self.random() < 0.2:
            return self.choice(special)
        if self.extreme and self.random() < 0.1:
            return self.choice((0.0, 1e-12, 1e-300, 1e12, 1e300, -1.0, -0.0)) * self.choice(
                (1, 1, -1)
            )
        return self.uniform(low, high)

    def mover(self, place: int) -> Mover:
        """A vehicle near a place, which may drive, spin or stand, on tyres, by drag or unslowed."""
        mass = self.number(700.0, 3000.0, 1500.0)
        speed = self.number(0.0, 30.0, 0.0, 0.0, 10.0)
        course = self.one(-math.pi, math.pi, 0.0, math.pi / 2, math.pi)
        with np.errstate(over="ignore"):
            yaw_inertia = mass * self.one(1.0, 3.0, 1.5)
        body = col.Vehicle(
            mass=mass,
            yaw_inertia=yaw_inertia,
            x=7.0 * place + self.number(-2.0, 2.0, 0.0),
            y=self.number(-3.0, 3.0, 0.0, 0.0),
            heading=course + self.choice((0.0, 0.0, self.one(-1.0, 1.0), math.pi / 2)),
            vx=speed * math.cos(course),
            vy=speed * math.sin(course),
            yaw_rate=self.choice((0.0, 0.0, self.number(-4.0, 4.0))),
        )
        given: dict[str, Any] = {"outline": self.outline()}
        how = self.random()
        if how < 0.25:
            lock = self.choice((1.0, 0.3, [1.0, 0.1, 0.1, 0.1], self.one(0.02, 1.0)))
            given["tyres"] = Tyres(self.one(0.3, 0.9), lock, 2.7, 1.5)
        elif how < 0.75:
            given["drag"] = self.number(0.2, 0.9, 0.0)
        return Mover(body, **given)

    def outline(self) -> Any:
        """A rectangle, or three to five corners."""
        if self.random() < 0.8:
            return self.one(3.0, 9.0, 4.5), self.one(1.2, 2.5, 1.8)
        turns = sorted(self.uniform(0.0, math.tau) for _ in range(self.randrange(3, 6)))
        return [(2.2 * math.cos(turn), math.sin(turn)) for turn in turns]

    def contact(self, a: str, b: str) -> Contact:
        """A rule of any kind for two vehicles."""
        given: dict[str, Any] = {"restitution": self.number(0.0, 1.0, 0.0, 1.0)}
        touches = self.random() < 0.85
        given["at"] = "touch" if touches else self.number(0.0, 0.5, 0.0)
        model = self.choice((None, None, None, "solve", "oblique_central", "linear_central"))
        if model != "linear_central":
            given["friction"] = self.number(0.0, 1.0, 0.0, math.inf)
        if model is not None:
            given["model"] = model
        if self.random() < 0.2:
            given["normal"] = self.one(-math.pi, math.pi, 0.0)
        elif self.random() < 0.2:
            given["plane"] = "crossings"
        if touches and self.random() < 0.3:
            given[self.choice(("depth", "delay"))] = self.number(0.0, 0.4, 0.0)
        if model in (None, "solve") and self.random() < 0.3:
            given["duration"] = self.one(0.01, 0.2)
            if model is None and self.random() < 0.5:
                given["model"] = "eccentric"
            if model == "solve":
                given["tolerance"] = self.choice((0.0, 0.1, 1.0, 5.0))
        if self.random() < 0.1:
            given["tyres_after"] = {self.choice((a, b)): Tyres(0.7, 1.0, 2.7, 1.5)}
        return Contact(a, b, **given)

    def scene(self) -> Scene:
        """Vehicles in a row or about, with one to three contacts."""
        names = "ABCD"[: self.randrange(2, 5)]
        movers = {name: self.mover(place) for place, name in enumerate(names)}
        pairs = [(one, two) for i, one in enumerate(names) for two in names[i + 1 :]]
        pairs = self.sample(pairs, min(len(pairs), self.randrange(1, 4)))
        given: dict[str, Any] = {}
        if self.random() < 0.1:
            given["slope"] = (self.one(-0.1, 0.1), 0.0)
        if self.random() < 0.05:
            given["surfaces"] = [([(2, -4), (9, -4), (9, 4)], self.one(0.1, 0.9))]
        contacts = [self.contact(*pair) for pair in pairs]
        for number, one in enumerate(contacts):
            rolls = any(movers[name].tyres is not None for name in (one.a, one.b))
            if one.duration is not None and not (one.in_time or rolls):
                contacts[number] = one.replace(duration=None)
        return Scene(movers=movers, contacts=contacts, **given)


def followed(seed: int) -> str:
    """What becomes of a scene: "answered", or the label of its refusal. Contacts that do not come
    are left out, one after another.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        try:
            crash = Drawn(seed).scene()
            while True:
                try:
                    looked_at(crash.run(tolerance=1e-3))
                    return "answered"
                except col.NoSolutionError as error:
                    if error.code != "contact_missing" or "movers" not in error.fields:
                        raise
                    missing = {*error.fields["movers"]}
                kept = [one for one in crash.contacts if {one.a, one.b} != missing]
                ground = {"surfaces": crash.surfaces, "slope": crash.slope}
                crash = Scene(movers=crash.movers, contacts=kept, **ground)
        except col.CollisionsError as error:
            return labelled(error)


def labelled(error: col.CollisionsError) -> str:
    """The label of a refusal, which has a text too and can be caught as a ValueError."""
    assert isinstance(error, ValueError)
    assert str(error)
    assert error.code
    return error.code


def looked_at(run: Run) -> None:
    """The answer has numbers where its status says so, and its contacts are in order and keep
    momentum.
    """
    good = np.atleast_1d(run.status) == "ok"
    times = np.array([np.atleast_1d(time) for time in run.times])
    assert np.all(np.diff(times, axis=0) >= 0.0, where=np.isfinite(times[1:]))
    for state in run.at(1.0).values():
        for name in ("x", "y", "heading", "vx", "vy", "yaw_rate"):
            assert np.isfinite(np.atleast_1d(getattr(state, name)))[good].all(), name
    if run.scene.shape is None:
        for impact, (before, after) in zip(run.impacts, run.momentum, strict=True):
            # Those of the two may cancel. What tyres do during the contact comes from outside.
            sides = impact.a, impact.b
            for i, part in enumerate(("tyre_impulse_x", "tyre_impulse_y")):
                after = (
                    *after[:i],
                    after[i] - sum(getattr(one, part) or 0.0 for one in sides),
                    *after[i + 1 :],
                )
            sizes = [abs(p) for one in sides for p in (*one.before.momentum, *one.after.momentum)]
            assert after == pytest.approx(before, abs=1e-9 * max(sizes))
        assert run.end >= max(run.times, default=0.0)


@pytest.mark.slow
def test_fuzzed_scenes_raise_nothing_foreign() -> None:
    found: Counter[str] = Counter()
    for seed in seeds():
        try:
            found[followed(seed)] += 1
        except Exception as error:
            error.add_note(f"seed {seed}")
            raise
    # Most scenes of a fuzz that tests something are followed to their end.
    assert found["answered"] >= 0.3 * found.total(), found


def alone_and_among_others(seed: int) -> str:
    """Whether each case of a batch goes the way that it goes alone: by the same models at the same
    times, and to the same places.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", col.CollisionsWarning)
        try:
            crash = Drawn(seed).scene()
            if crash.shape is not None:
                return "a batch itself"
            name = next((one for one, mover in crash.movers.items() if mover.vehicle.speed), "A")
            path, was = f"{name}.vx", crash.movers[name].vehicle.vx
            speeds = was + np.array([0.0, 0.4, 1.1])
            batch = crash.replace({path: speeds}).run(tolerance=1e-3)
        except col.CollisionsError as error:
            return labelled(error)
        for number, speed in enumerate(speeds.tolist()):
            alone, code = None, "ok"
            try:
                alone = crash.replace({path: speed}).run(tolerance=1e-3)
            except col.CollisionsError as error:
                code = error.code
            # Of several reasons a batch may meet another first.
            assert (batch.status[number] == "ok") == (code == "ok"), (batch.status[number], code)
            if alone is None:
                continue
            first = batch.case(number)
            for one, other in zip(first.impacts, alone.impacts, strict=True):
                assert one.model == other.model
            assert np.allclose(first.times, alone.times, rtol=0.0, atol=1e-6)
            among = batch.at(0.5)
            for body, state in alone.at(0.5).items():
                for part in ("x", "y", "heading"):
                    here = np.broadcast_to(getattr(among[body], part), 3)[number]
                    assert abs(here - getattr(state, part)) < 1e-5, (body, part)
    return "answered"


@pytest.mark.slow
def test_fuzzed_batches_go_as_their_cases_do() -> None:
    found: Counter[str] = Counter()
    for seed in seeds():
        try:
            found[alone_and_among_others(seed)] += 1
        except Exception as error:
            error.add_note(f"seed {seed}")
            raise
    assert found["answered"] >= 0.3 * found.total(), found

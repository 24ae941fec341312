"""Levels of a scene: the same crash with contacts of an instant, with their tyres or followed in
time, and with motion by a drag or on wheels.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np

from ..kernels.contact_laws import BRACH, FRICTION
from ..quantities.attributes import same_fields
from ..quantities.settings import in_si
from ..vehicle.drag import GRAVITY, USUAL_DURATION, gravity_on
from .contact import IN_TIME, Contact
from .model import as_function
from .mover import Mover
from .run import Run
from .scene import Scene

OfContacts: TypeAlias = Literal["instant", "with tyres", "in time"]
OfMotion: TypeAlias = Literal["drag", "wheels", "as given"]
INSTANT, WITH_TYRES, FOLLOWED = "instant", "with tyres", "in time"
DRAG, WHEELS, AS_GIVEN = "drag", "wheels", "as given"
# From the one that takes the least time to the finest, as benchmarks/scene_levels.py has them.
_ORDER = ((INSTANT, DRAG), (FOLLOWED, DRAG), (INSTANT, WHEELS), (WITH_TYRES, WHEELS),
          (FOLLOWED, WHEELS))  # fmt: skip
# A way [m] that is too short to tell a drag.
_SHORT = 0.01
# How finely the motion of a coarser model is followed: places of rest are then off by 1 cm in the
# median (benchmarks/scene_posterior.py).
COARSE = 1e-3
_OF_THE_WAY = re.compile(r"\.rest\.|\.marks\.|^end\b")
_OF_IMPULSES = ("eccentric", "solve", IN_TIME)


@dataclass(frozen=True, eq=False, repr=False)
class Level:
    """One level of a scene: a model like the scene itself, for ``propagate``, ``fit`` and
    ``posterior``, with the inputs of the scene that it was made from.

    Attributes
    ----------
    contacts : {"instant", "with tyres", "in time"}
        How contacts are solved: by an impulse; by one with that of the tyres meanwhile; or followed
        in time.
    motion : {"drag", "wheels", "as given"}
        How the vehicles go on: straight, with the drag that their wheels had on average; on their
        wheels; or, where no vehicle has tyres, as the scene says.
    given : Scene
        The scene that it was made from.
    drags : dict of float [-]
        By vehicle, the share of the friction of its tyres that a drag has.
    """

    contacts: str
    motion: str
    given: Scene
    drags: Mapping[str, float]

    @property
    def scene(self) -> Scene:
        """The scene of this level."""
        return self._of(self.given)

    @property
    def name(self) -> str:
        """Both in words."""
        motion = {DRAG: "by drag", WHEELS: "on wheels", AS_GIVEN: "as given"}[self.motion]
        return f"contacts {self.contacts}, motion {motion}"

    def as_model(
        self, names: Sequence[str], outputs: Sequence[str], *, tolerance: float = 1e-5
    ) -> Callable[..., dict[str, Any]]:
        """The level as a function, as ``Scene.as_model``.

        Parameters
        ----------
        names, outputs, tolerance
            As for ``Scene.as_model``: inputs are those of the scene that was given.

        Returns
        -------
        function
        """
        return self._function(names, outputs, tolerance)

    def _coarser(
        self, names: Sequence[str], outputs: Sequence[str]
    ) -> Callable[..., dict[str, Any]] | None:
        """The same level with its motion followed coarsely, to be sampled with the level as
        ``finer``; None where that would save nothing: without wheels, or where no output is of the
        way to rest.
        """
        if self.motion != WHEELS or not any(_OF_THE_WAY.search(path) for path in outputs):
            return None
        return self._function(names, outputs, COARSE)

    def results(self) -> dict[str, str]:
        """The paths of its results, with their units.

        Returns
        -------
        dict of str
        """
        return self.given.results()

    def _function(
        self,
        names: Sequence[str],
        outputs: Sequence[str],
        tolerance: float,
        argument: str = "outputs",
    ) -> Callable[..., dict[str, Any]]:
        return as_function(self.given, names, outputs, tolerance, self._of, argument)

    def _of(self, scene: Scene) -> Scene:
        with in_si():
            return _made(scene, self.contacts, self.motion, self.drags)

    def __eq__(self, other: object) -> bool:
        return same_fields(self, other) if isinstance(other, Level) else NotImplemented

    def __repr__(self) -> str:
        return f"<Level: {self.name}>"


def levels_of(scene: Scene, tolerance: float) -> tuple[list[Level], dict[str, list[Level]]]:
    """The levels that a scene has, the finest last, and what they take as given, in sentences with
    the levels that these are of.
    """
    wheeled = [name for name, mover in scene.movers.items() if mover.tyres is not None]
    followed = [i for i, contact in enumerate(scene.contacts) if _may_last(contact)]
    notes = [
        f"the model of contacts[{i}] is that given at every level, as no contact in time has "
        f"{'its law' if contact.model in _OF_IMPULSES else f'the model {contact.model!r}'}"
        for i, contact in enumerate(scene.contacts)
        if i not in followed
    ]
    assumed = [f"contacts[{i}]" for i in followed if scene.contacts[i].duration is None]
    if assumed:
        notes.append(
            f"the duration of {', '.join(assumed)} is not given, and is taken as "
            f"{float(USUAL_DURATION):g} s"
        )
    if followed:
        notes.append(
            "a contact in time returns a share of the work (the law of Stronge); where the slip "
            "stops or turns round, the difference from an impulse of another law includes that"
        )
    wanted = [
        (contacts, motion if wheeled else AS_GIVEN)
        for contacts, motion in _ORDER
        if (followed or contacts == INSTANT) and (wheeled or (motion == WHEELS and contacts !=
                                                              WITH_TYRES))
    ]  # fmt: skip
    finest = Level(*wanted[-1], scene, {})
    drags = _drags(finest.scene.run(tolerance=tolerance), wheeled)
    levels = [Level(contacts, motion, scene, drags) for contacts, motion in wanted]
    found = dict.fromkeys(notes, levels)
    if wheeled:
        shares = ", ".join(f"{name} {share:.2f}" for name, share in drags.items())
        said = (
            "a drag is the share of the friction that the tyres took on average on the way at the "
            f"stated values: {shares}"
        )
        found[said] = [one for one in levels if one.motion == DRAG]
    return levels, found


def _may_last(contact: Contact) -> bool:
    """Whether a contact may be followed in time."""
    impulse = contact.model in _OF_IMPULSES and contact.rule == FRICTION
    return impulse and not contact.incomplete


def _made(scene: Scene, contacts: str, motion: str, drags: Mapping[str, float]) -> Scene:
    """The scene at a level."""
    movers = {
        name: _by_drag(mover, drags[name]) if motion == DRAG and mover.tyres is not None else mover
        for name, mover in scene.movers.items()
    }
    made = [_contact(contact, contacts, movers) for contact in scene.contacts]
    if motion == DRAG:
        made = [contact.replace(tyres_after=None) for contact in made]
    # Names of shared inputs are of the scene that was given.
    return Scene(
        movers=movers,
        contacts=made,
        surfaces=list(scene.surfaces),
        slope=scene.slope,
        order=scene.order,
    )


def _by_drag(mover: Mover, share: float) -> Mover:
    assert mover.tyres is not None
    return mover.replace(tyres=None, drag=share * mover.tyres.friction)


def _contact(contact: Contact, level: str, movers: Mapping[str, Mover]) -> Contact:
    if not _may_last(contact):
        return contact
    duration = USUAL_DURATION if contact.duration is None else contact.as_given("duration")
    plain = contact.replace(model="eccentric", duration=None, tolerance=None)
    if level == FOLLOWED:
        return plain.replace(model=IN_TIME, duration=duration, law=BRACH)
    on_tyres = any(movers[name].tyres is not None for name in (contact.a, contact.b))
    return plain.replace(duration=duration) if level == WITH_TYRES and on_tyres else plain


def _drags(run: Run, names: Sequence[str]) -> dict[str, float]:
    """The share of the friction that the tyres of each vehicle took on average, by their work along
    the way; of one that hardly moves, the mean of its locks.
    """
    return dict(_shares(run, names))


def _shares(run: Run, names: Sequence[str]) -> Iterator[tuple[str, float]]:
    for name in names:
        mover, track = run.scene.movers[name], run.paths[name]
        tyres = mover.tyres
        assert tyres is not None
        along, across = np.diff(track.x), np.diff(track.y)
        climbs = float(run.scene.slope[0]) * along + float(run.scene.slope[1]) * across
        # Along the ground, of which the track is the plan.
        way = float(np.sqrt(along * along + across * across + climbs * climbs).sum())
        weight = mover.vehicle.mass * gravity_on(run.scene.slope)
        if way < _SHORT or not math.isfinite(weight):
            yield name, float(np.mean(tyres.locks))
            continue
        taken = run._ground_work(name) - mover.vehicle.mass * GRAVITY * float(climbs.sum())
        # What rolls freely takes nothing but rounding.
        yield name, max(float(taken / (weight * way * tyres.friction)), 0.0)

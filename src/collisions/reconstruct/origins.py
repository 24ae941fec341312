"""The states that may have been before an end state: candidate impulses taken off it, each tried on
the forward kernel.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ..kernels.contact_laws import (
    BRACH,
    CRITICAL_FRACTION,
    FRICTION,
    IMPULSE_RATIO,
    KUDLICH_SLIBAR,
    LAWS,
)
from ..kernels.eccentric import recoil, response
from ..kernels.problem import Contact
from ..kernels.status import EPS, Status
from ..quantities.tables import Sentences
from .common import NUMBERS, body_of, forward

_NEARLY_PLASTIC = (
    0.01  # of the closing speed: what measured motions may still approach after a plastic impact
)
_IMPULSE_TOL = 1e-6  # of the impulse: far above rounding, far below what separates two origins
_MOTION_ROUNDING = 64.0  # eps of the motions
_NEARLY_ALL = 0.999  # of the critical impulse ratio
# of the closing speed: a motion after that may be the rounding of a slip before which nothing
# bounds
_LOST_MOTION = 1e-6


class Origin(NamedTuple):
    """A candidate for the state before: how the contact ended, the impulse on B, what goes with it,
    and whether it fits.

    ``contact_velocity`` is the closing speed and the slip before; where friction ``jams``, none
    ends this way.
    """

    regime: str
    normal: Any
    tangential: Any
    restitution: Any
    condition: Any
    contact_velocity: tuple[Any, Any]
    jams: Any
    motions: tuple[tuple[Any, Any, Any], tuple[Any, Any, Any]]
    fits: Any


class Given(NamedTuple):
    """The state after and the contact in numbers by name; what else is known, of which kind, and by
    which rule and law; the rounding, and how messages write numbers.
    """

    numbers: dict[str, Any]
    kind: str
    rule: str
    law: str
    pinned: tuple[bool, bool]
    eps: float
    incomplete: bool
    say: Sentences


class End:
    """The state after, and what the kernel says of the contact there."""

    def __init__(self, given: Given) -> None:
        numbers, kind, rule, law, pinned, eps, incomplete, say = given
        self.numbers, self.kind, self.rule, self.law = numbers, kind, rule, law
        self.pinned, self.incomplete, self.say = pinned, incomplete, say
        self.known, self.bound = numbers[kind], numbers[rule]
        # Whether all that the rule allows is sticking, and whether it allows it at all.
        self.only_sticks = (
            np.isposinf(self.bound)
            if rule == FRICTION
            else (rule == CRITICAL_FRACTION) & (self.bound == 1.0)
        )
        self.may_stick = self.bound > 0.0 if rule == FRICTION else self.only_sticks
        self.n = numbers["normal[0]"], numbers["normal[1]"]
        self.p = numbers["point[0]"], numbers["point[1]"]
        self.bodies = [[numbers[f"{label}_after.{name}"] for name in NUMBERS] for label in "ab"]
        self._mobilities()
        here = self._contact()
        self.status = here.status
        self.separation = 0.0 - here.closing_speed
        self.k_nn = 1.0 / here.effective_mass
        self.k_nt = here.coupling
        self.size = self._size(self.bodies)
        # The motion before leaves its rounding in the one after.
        self.closing = (
            np.sqrt(2.0 * self.known * self.k_nn) if kind == "energy_loss" else self._closing()
        )
        self.rounding = (
            _MOTION_ROUNDING * eps * (self.size + np.where(self.closing > 0.0, self.closing, 0.0))
        )
        self.approach = 0.0 - self.separation
        slight = (self.approach > self.rounding) & (self.approach <= _NEARLY_PLASTIC * self.closing)
        self.pressed = slight & (kind != "restitution") & (not incomplete)
        if np.any(self.pressed):
            # The nearest end that is plastic: a small push along the normal takes off what still
            # approaches.
            push = np.where(self.pressed, self.approach / self.k_nn, 0.0)
            moved = self._moving(self._struck(push, 0.0 * push))
            # Others stay as they were, to the sign of a zero.
            self.bodies = [
                [np.where(self.pressed, new, was) for new, was in zip(*pair, strict=True)]
                for pair in zip(moved, self.bodies, strict=True)
            ]
            here = self._contact()
            self.separation = np.where(self.pressed, 0.0, 0.0 - here.closing_speed)
        self.slip = here.slip_before
        # K^-1 times the contact velocity after.
        self.stopping = 0.0 - here.no_slip_normal, 0.0 - here.no_slip_tangential
        self.slides = self._slides()
        self.noise = self._noise(eps)
        self.at_rest = (abs(self.slip) <= self.noise) & (abs(self.separation) <= self.noise)

    def origins(self, regime: str | None) -> list[Origin]:
        """The candidates; those fit that are of the regime, lead to this end and repeat no earlier
        one.
        """
        found: list[Origin] = []
        for origin in self.candidates():
            new = np.asarray(origin.fits) & (regime in (None, origin.regime))
            for earlier in found:
                apart = abs(origin.normal - earlier.normal) + abs(
                    origin.tangential - earlier.tangential
                )
                new = new & ~(
                    earlier.fits
                    & (apart <= _IMPULSE_TOL * (abs(origin.normal) + abs(origin.tangential)))
                )
            found.append(origin._replace(fits=new))
        return found

    def resistance(self, ratio: Any) -> Any:
        """The contact's resistance along the normal to an impulse of this ratio; where it is not
        above 0, the bodies jam.
        """
        return sum(a + b * rt * (rt - ratio * rn) for a, b, rn, rt in self.responses)

    def elastic_loss(self, ratio: Any) -> Any:
        """The energy lost by an impact of this ratio with e = 1 that ends this way: the least
        possible.
        """
        normal = 2.0 * self.separation / self.resistance(ratio)
        return 0.0 - ratio * normal * (self.slip - 0.5 * self._slip_change(normal, ratio * normal))

    def always_sticks(self, law: str = BRACH) -> Any:
        """Whether the contact is under this law and can only end sticking."""
        return self.only_sticks & (self.law == law)

    def slip_range(self) -> tuple[Any, Any]:
        """The range of the slip before, for a contact that stuck under "brach"; infinite where
        friction jams.
        """
        if not self.slides or self.law != BRACH:
            return np.full((), np.nan), np.full((), np.nan)
        slips = [
            np.where(one.jams, np.copysign(np.inf, self.k_nt), one.contact_velocity[1])
            for one in self.slides
        ]
        return np.minimum(*slips), np.maximum(*slips)

    def forgets_slip(self) -> Any:
        """Whether the contact ended so that the law keeps no trace of the slip before: without
        slip, or at rest.
        """
        return self.may_stick & (
            self.at_rest if self.law == KUDLICH_SLIBAR else abs(self.slip) <= self.noise
        )

    def _mobilities(self) -> None:
        """Whether K has an inverse, and by how much the rounding of a contact that sticks is
        magnified in the motion after.
        """
        contact = Contact(0.0, self.n, point=self.p)
        self.levers = [
            response(body_of(numbers, pinned), contact)
            for numbers, pinned in zip(self.bodies, self.pinned, strict=True)
        ]
        # The levers along n and t.
        self.responses = [(a, b, rn, rt) for a, b, _, _, rn, rt in self.levers]
        (a_a, b_a, rn_a, rt_a), (a_b, b_b, rn_b, rt_b) = self.responses
        a, cross = a_a + a_b, rn_a * rt_b - rt_a * rn_b
        self.trace = a + b_a * (rn_a * rn_a + rt_a * rt_a) + b_b * (rn_b * rn_b + rt_b * rt_b)
        determinant = (a + (b_a / self.trace) * cross * (b_b * cross)) / self.trace
        self.singular = determinant <= (_MOTION_ROUNDING * EPS) ** 2
        self.magnified = np.where(self.singular, 1.0, 1.0 / determinant)

    def _contact(self, e: Any = 0.0, n: tuple[Any, Any] | None = None) -> Any:
        """What the kernel says of the end state as if it approached: the closing speed there is
        minus the separation speed.
        """
        return self._kernel(np.full((), e), FRICTION, np.zeros(()), self.bodies, n)

    def _kernel(
        self,
        e: Any,
        rule: str,
        bound: Any,
        bodies: Sequence[Sequence[Any]],
        n: Any = None,
        **known: Any,
    ) -> Any:
        law = self.law if rule == self.rule else BRACH
        contact = Contact(e, n or self.n, bound, self.p)
        return forward(contact, bodies, rule, law, self.pinned, **known)

    def _struck(self, normal: Any, tangential: Any) -> Any:
        """The motions of A and B when an impulse with these parts on B, and its opposite on A, is
        added.
        """
        nx, ny = self.n
        x, y = nx * normal - ny * tangential, ny * normal + nx * tangential
        motions = []
        for body, lever, pinned, sign in zip(
            self.bodies, self.levers, self.pinned, (-1.0, 1.0), strict=True
        ):
            torque = sign * (lever.rx * y - lever.ry * x)
            changes = recoil(body_of(body, pinned), lever, torque, sign * x, sign * y)
            motions.append(
                tuple(part + change for part, change in zip(body[2:5], changes, strict=True))
            )
        return tuple(motions)

    def _moving(self, motions: Any) -> list[list[Any]]:
        """The numbers of both bodies in other motions."""
        return [
            [*body[:2], *motion, *body[5:]]
            for body, motion in zip(self.bodies, motions, strict=True)
        ]

    def _size(self, bodies: Sequence[Sequence[Any]]) -> Any:
        """The speeds of motions whose rounding matters at the contact."""
        return sum(
            np.hypot(b[2], b[3]) + abs(b[4]) * np.hypot(self.p[0] - b[5], self.p[1] - b[6])
            for b in bodies
        )

    def _noise(self, eps: float) -> Any:
        """What rounding may leave of the slip and of the separation speed where the contact is at
        rest after the impact.

        The motion after may then be next to nothing, so the motion before counts. The slip before a
        contact that stuck lies between those of contacts that slid either way, and the energy lost
        bounds it; where friction jams on one side or has no end, and no energy is known, nothing
        does.
        """
        size = self.size + np.where(self.closing > 0.0, self.closing, 0.0)
        endless = self.only_sticks
        for slide in self.slides:
            moved = self._size(self._moving(slide.motions))
            size = np.fmax(size, np.where(slide.jams, np.nan, self.size + moved))
            endless = endless | slide.jams
        if self.kind == "energy_loss":
            size = size + np.sqrt(2.0 * self.known * 2.0 * self.trace)
        # Only two pins leave nothing of the motion.
        lost = endless & (self.kind == "closing_speed") & (self.size < _LOST_MOTION * self.closing)
        return np.where(lost, np.inf, _MOTION_ROUNDING * eps * self.magnified * size)

    def _slides(self) -> list[Origin]:
        """The origins of a contact that slid one way and the other to the end."""
        if self.rule != FRICTION:
            return []
        finite = np.where(np.isinf(self.bound) | (self.bound == 0.0), np.nan, self.bound)
        return [self._along("sliding", sign * finite) for sign in (1.0, -1.0)]

    def candidates(self, nearest: bool = False) -> list[Origin]:
        """Every origin the law allows, whether it fits or not; beyond a fold, where a share of the
        critical ratio has none, the ``nearest`` to one if that is asked for.
        """
        if self.rule == IMPULSE_RATIO:
            return [self._along("given", self.bound)]
        frictionless = np.where(self.bound == 0.0, 0.0, np.nan)
        if self.rule == FRICTION:
            found = [self._along("frictionless", frictionless), *self.slides]
        else:
            shared = [
                np.where((self.bound > 0.0) & (self.bound < 1.0), ratio, np.nan)
                for ratio in self._shared_ratios(nearest)
            ]
            found = [self._along("given", ratio) for ratio in (frictionless, *shared)]
        # Under "brach" a contact that sticks keeps no trace of the slip before.
        return found if self.law == BRACH else [*found, self._sticking()]

    def _slip_change(self, normal: Any, tangential: Any) -> Any:
        """What an impulse adds to the slip."""
        return sum(
            a * tangential + b * rn * (rn * tangential - rt * normal)
            for a, b, rn, rt in self.responses
        )

    def _closing(self) -> Any:
        """The closing speed, where it or the restitution is known."""
        return self.known if self.kind == "closing_speed" else self.separation / self.known

    def condition_of(self, sticks: Any, e: Any) -> Any:
        """How far a relative error of what is known in place of the velocities, and of the motions
        after, grows in those before, for this restitution.

        One that sticks returns the whole velocity times it, so that the slip before is known by it
        alone.
        """
        by_restitution = abs(1.0 + 1.0 / e)
        along = {"closing_speed": 1.0, "energy_loss": 2.0}.get(self.kind, by_restitution)
        return np.where(sticks, by_restitution, along)

    def _along(self, regime: str, ratio: Any) -> Origin:
        """The origin for a given impulse ratio."""
        resistance = self.resistance(ratio)
        if self.kind == "energy_loss":
            # Along the impulse the contact is a one-dimensional one, with the effective mass of
            # that direction.
            length = np.hypot(1.0, ratio)
            there = self._contact(
                n=(
                    (self.n[0] - ratio * self.n[1]) / length,
                    (self.n[1] + ratio * self.n[0]) / length,
                )
            )
            parting, mass = 0.0 - there.closing_speed, there.effective_mass
            root = np.sqrt(parting * parting + 2.0 * self.known / mass)
            impulse = mass * np.where(
                parting > 0.0, parting + root, (2.0 * self.known / mass) / (root - parting)
            )
            normal = impulse / length
            closing = resistance * normal - self.separation
            e = self.separation / closing
        else:
            closing = self._closing()
            normal = (closing + self.separation) / resistance
            e = self.separation / self.known if self.kind == "closing_speed" else self.known
        condition = self.condition_of(False, e)
        if self.rule == CRITICAL_FRACTION:
            # The slip after is this part of the slip before.
            left = abs(1.0 - self.bound * (1.0 - LAWS[self.law].sticking_slip(e)))
            condition = np.maximum(condition, 1.0 / left)
        tangential = ratio * normal
        velocity = closing, self.slip - self._slip_change(normal, tangential)
        return self._origin(regime, normal, tangential, e, condition, velocity, resistance > 0.0)

    def _sticking(self) -> Origin:
        """The origin of a contact that does not slip under "kudlich-slibar", which returns the
        whole velocity times e.
        """
        if self.kind == "energy_loss":
            stored = self.stopping[0] * self.separation + self.stopping[1] * self.slip
            inverse = np.copysign(np.sqrt(1.0 + 2.0 * self.known / stored), self.separation)
        elif self.kind == "closing_speed":
            inverse = self.known / self.separation
        else:
            inverse = 1.0 / self.known
        factor = 1.0 + inverse
        closing = self.known if self.kind == "closing_speed" else self.separation * inverse
        parts = abs(self.separation) if self.incomplete else self.separation
        possible = self.may_stick & ~self.at_rest & (parts > self.rounding)
        impulse = factor * self.stopping[0], factor * self.stopping[1]
        regime = "sticking" if self.rule == FRICTION else "given"
        return self._origin(
            regime,
            *impulse,
            1.0 / inverse,
            self.condition_of(True, 1.0 / inverse),
            (closing, 0.0 - self.slip * inverse),
            possible,
        )

    def _shared_ratios(self, nearest: bool = False) -> tuple[Any, Any]:
        """Impulse ratios that are the given share of the critical one.

        The no-slip impulse is proportional to P - y, with y = K^-1 (0, s') under "brach" and K^-1
        (r, s') under "kudlich-slibar"; P_t N_s = f T_s P_n, with P_n from the closing speed, leaves
        a quadratic in the ratio. Where it has no root, its turning point is ``nearest`` to one.
        """
        share = self.bound
        y_n, y_t = self.stopping
        if self.law == BRACH:
            # With e = -1 the wanted change along the normal is 0, and what remains is the slip.
            only_slip = self._contact(e=-1.0)
            y_n, y_t = 0.0 - only_slip.no_slip_normal, 0.0 - only_slip.no_slip_tangential
            # Of a slip that is rounding one root would be its reciprocal. Where nearly all of it
            # was stopped, the slip before is known from what is left alone.
            none = (abs(self.slip) <= self.noise) & (share < _NEARLY_ALL)
            y_n, y_t = np.where(none, 0.0, y_n), np.where(none, 0.0, y_t)
        square = y_n * self.k_nt
        linear = (
            y_n * self.k_nn
            - share * y_t * self.k_nt
            - (1.0 - share) * (self._closing() + self.separation)
        )
        constant = 0.0 - share * y_t * self.k_nn
        inside = linear * linear - 4.0 * square * constant
        half = -0.5 * (linear + np.copysign(np.sqrt(inside), linear))
        one, other = half / square, constant / half
        if nearest:
            turn = np.where(inside < 0.0, -0.5 * linear / square, np.nan)
            one, other = np.where(inside < 0.0, turn, one), np.where(inside < 0.0, turn, other)
        return one, other

    def _origin(
        self,
        regime: str,
        normal: Any,
        tangential: Any,
        e: Any,
        condition: Any,
        velocity: tuple[Any, Any],
        possible: Any,
    ) -> Origin:
        e = np.where((e < 0.0) & (abs(self.separation) <= self.rounding), 0.0, e)
        e = np.where(
            (e > 1.0) & (e <= 1.0 + 16.0 * EPS + self.rounding / abs(self.separation)), 1.0, e
        )
        motions = self._struck(0.0 - normal, 0.0 - tangential)
        found = self._kernel(
            e, self.rule, self.bound, self._moving(motions), contact_velocity=velocity
        )
        off = abs(found.normal_impulse - normal) + abs(found.tangential_impulse - tangential)
        again = off <= _IMPULSE_TOL * (abs(normal) + abs(tangential))
        fits = (
            possible
            & again
            & (found.status <= Status.ENERGY_GAIN)
            & ((e > -1.0) if self.incomplete else (e >= 0.0))
            & (e <= 1.0)
        )
        jams = ~np.isnan(normal) & ~np.asarray(possible)
        return Origin(regime, normal, tangential, e, condition, velocity, jams, motions, fits)

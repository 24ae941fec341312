"""The states that may have been before an end state: candidate impulses taken off it, each tried on the forward kernel."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ..kernels.contact_laws import BRACH, CRITICAL_FRACTION, FRICTION, IMPULSE_RATIO, KUDLICH_SLIBAR, LAWS
from ..kernels.eccentric import recoil, response
from ..kernels.status import EPS, Status
from .common import NUMBERS, forward

NEARLY_PLASTIC = 0.01  # of the closing speed: what measured motions may still approach after a plastic impact
_SAME = 1e-6  # of the impulse: far above rounding, far below what separates two origins
_ROUNDING = 64.0  # eps of the motions
_LOST = 1e-6  # of the closing speed: a motion after that may be the rounding of a slip before which nothing bounds


class Origin(NamedTuple):
    """A candidate for the state before: how the contact ended, the impulse on B, what goes with it, and whether it fits.

    ``contact_velocity`` is the closing speed and the slip before; where friction ``jams`` there is none that ends so.
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


class End:
    """The state after, and what the kernel says of the contact there."""

    def __init__(
        self, numbers: dict[str, Any], kind: str, rule: str, law: str, pinned: tuple[bool, bool], eps: float = EPS
    ) -> None:
        self.numbers = numbers
        self.kind, self.rule, self.law, self.pinned = kind, rule, law, pinned
        self.known, self.bound = numbers[kind], numbers[rule]
        self.n = numbers["normal[0]"], numbers["normal[1]"]
        self.p = numbers["point[0]"], numbers["point[1]"]
        self.bodies = [[numbers[f"{label}_after.{name}"] for name in NUMBERS] for label in "ab"]
        here = self._at_the_end()
        self.status = here[0]
        self.separation = 0.0 - here.closing_speed
        self.k_nn = 1.0 / here.effective_mass
        self.k_nt = here.coupling
        self._mobilities()
        self.size = self._size(self.bodies)
        # The motion before leaves its rounding in the one after.
        self.closing = np.sqrt(2.0 * self.known * self.k_nn) if kind == "energy_loss" else self._closing()
        self.rounding = _ROUNDING * eps * (self.size + np.where(self.closing > 0.0, self.closing, 0.0))
        self.approach = 0.0 - self.separation
        self.pressed = (
            (self.approach > self.rounding) & (self.approach <= NEARLY_PLASTIC * self.closing) & (kind != "restitution")
        )
        if np.any(self.pressed):
            # The nearest end that is plastic: a small push along the normal takes off what still approaches.
            push = np.where(self.pressed, self.approach / self.k_nn, 0.0)
            for body, motion in zip(self.bodies, self._struck(push, 0.0 * push), strict=True):
                body[2:5] = motion
            here = self._at_the_end()
            self.separation = np.where(self.pressed, 0.0, 0.0 - here.closing_speed)
        self.slip = here.slip_before
        # K^-1 times the contact velocity after.
        self.whole = 0.0 - here.no_slip_normal, 0.0 - here.no_slip_tangential
        self.slides = self._slides()
        self.noise = self._noise(eps)
        self.at_rest = (abs(self.slip) <= self.noise) & (abs(self.separation) <= self.noise)

    def _at_the_end(self) -> Any:
        """What the kernel says of the end state, as if it approached: the closing speed there is minus the separation speed."""
        return self._kernel(np.zeros(()), FRICTION, np.zeros(()), self.bodies)

    def _responses(self) -> list[tuple[Any, Any, Any, Any]]:
        """Of A and B the response a and b, and the lever along n and t."""
        (nx, ny), (px, py) = self.n, self.p
        found = []
        for (mass, inertia, vx, vy, _, cx, cy, ox, oy), pinned in zip(self.bodies, self.pinned, strict=True):
            a, b, rx, ry, _, _ = response(mass, inertia, vx, vy, cx, cy, ox, oy, px, py, pinned)
            found.append((a, b, nx * rx + ny * ry, nx * ry - ny * rx))
        return found

    def _mobilities(self) -> None:
        """Whether K has an inverse, and by how much the rounding of a contact that sticks is magnified in the motion after."""
        self.responses = self._responses()
        (a_a, b_a, rn_a, rt_a), (a_b, b_b, rn_b, rt_b) = self.responses
        a, cross = a_a + a_b, rn_a * rt_b - rt_a * rn_b
        self.trace = a + b_a * (rn_a * rn_a + rt_a * rt_a) + b_b * (rn_b * rn_b + rt_b * rt_b)
        determinant = (a + (b_a / self.trace) * cross * (b_b * cross)) / self.trace
        self.singular = determinant <= (_ROUNDING * EPS) ** 2
        self.magnified = np.where(self.singular, 1.0, 1.0 / determinant)

    def _size(self, bodies: Sequence[Sequence[Any]]) -> Any:
        """The speeds of motions whose rounding matters at the contact."""
        return sum(np.hypot(b[2], b[3]) + abs(b[4]) * np.hypot(self.p[0] - b[5], self.p[1] - b[6]) for b in bodies)

    def _noise(self, eps: float) -> Any:
        """What rounding may leave of the slip and of the separation speed when the contact is at rest after the impact.

        The motion after may be next to nothing then, so it is the motion before that tells. A slip before that stuck lies
        between those of a contact that slid either way, and the energy lost bounds it; where friction jams on one side or has
        no end, and no energy is known, nothing does.
        """
        size = self.size + np.where(self.closing > 0.0, self.closing, 0.0)
        for slide in self.slides:
            moved = self._size([[*b[:2], *motion, *b[5:]] for b, motion in zip(self.bodies, slide.motions, strict=True)])
            size = np.fmax(size, np.where(slide.jams, np.nan, self.size + moved))
        if self.kind == "energy_loss":
            size = size + np.sqrt(2.0 * self.known * 2.0 * self.trace)
        endless = np.isinf(self.bound) if self.rule == FRICTION else self.bound == 1.0
        for slide in self.slides:
            endless = endless | slide.jams
        # Only two pins leave nothing of the motion.
        lost = endless & (self.kind == "closing_speed") & (self.size < _LOST * self.closing)
        return np.where(lost, np.inf, _ROUNDING * eps * self.magnified * size)

    def _struck(self, normal: Any, tangential: Any) -> list[tuple[Any, Any, Any]]:
        """The motions of A and B when an impulse with these parts on B, and its opposite on A, is added."""
        (nx, ny), (px, py) = self.n, self.p
        x, y = nx * normal - ny * tangential, ny * normal + nx * tangential
        motions = []
        for body, pinned, sign in zip(self.bodies, self.pinned, (-1.0, 1.0), strict=True):
            mass, inertia, vx, vy, yaw_rate, cx, cy, ox, oy = body
            a, b, rx, ry, _, _ = response(mass, inertia, vx, vy, cx, cy, ox, oy, px, py, pinned)
            dvx, dvy, dw = recoil(a, b, sign * (rx * y - ry * x), sign * x, sign * y, cx, cy, ox, oy, pinned)
            motions.append((vx + dvx, vy + dvy, yaw_rate + dw))
        return motions

    def _kernel(self, e: Any, rule: str, bound: Any, bodies: Sequence[Sequence[Any]], n: Any = None, **known: Any) -> Any:
        law = self.law if rule == self.rule else BRACH
        inputs = (e, *(n or self.n), bound, *self.p, *bodies[0], *bodies[1])
        return forward(*inputs, rule, law, *self.pinned, **known)

    def _slides(self) -> list[Origin]:
        """The origins of a contact that slid one way and the other to the end."""
        if self.rule != FRICTION:
            return []
        finite = np.where(np.isinf(self.bound) | (self.bound == 0.0), np.nan, self.bound)
        return [self._along("sliding", sign * finite) for sign in (1.0, -1.0)]

    def candidates(self) -> list[Origin]:
        """Every origin the law allows, whether it fits or not."""
        if self.rule == IMPULSE_RATIO:
            return [self._along("given", self.bound)]
        frictionless = np.where(self.bound == 0.0, 0.0, np.nan)
        if self.rule == FRICTION:
            without = self._along("frictionless", frictionless)
            return [without, *self.slides, self._sticking("sticking", self.bound > 0.0)]
        shared = [np.where((self.bound > 0.0) & (self.bound < 1.0), ratio, np.nan) for ratio in self._shared_ratios()]
        ratios = [frictionless, *shared]
        return [*(self._along("given", ratio) for ratio in ratios), self._sticking("given", self.bound == 1.0)]

    def resistance(self, ratio: Any) -> Any:
        """What the contact resists along the normal to an impulse of this ratio: where it is not above 0, the bodies jam."""
        return sum(a + b * rt * (rt - ratio * rn) for a, b, rn, rt in self.responses)

    def _slip_change(self, normal: Any, tangential: Any) -> Any:
        """What an impulse adds to the slip."""
        return sum(a * tangential + b * rn * (rn * tangential - rt * normal) for a, b, rn, rt in self.responses)

    def _along(self, regime: str, ratio: Any) -> Origin:
        """The origin for a given impulse ratio."""
        resistance = self.resistance(ratio)
        if self.kind == "energy_loss":
            # Along the impulse the contact is a one-dimensional one, with the effective mass of that direction.
            length = np.hypot(1.0, ratio)
            d = (self.n[0] - ratio * self.n[1]) / length, (self.n[1] + ratio * self.n[0]) / length
            there = self._kernel(np.zeros(()), FRICTION, np.zeros(()), self.bodies, d)
            parting, mass = 0.0 - there.closing_speed, there.effective_mass
            root = np.sqrt(parting * parting + 2.0 * self.known / mass)
            impulse = mass * np.where(parting > 0.0, parting + root, (2.0 * self.known / mass) / (root - parting))
            normal = impulse / length
            closing = resistance * normal - self.separation
            e, condition = self.separation / closing, 2.0
        else:
            closing = self._closing()
            normal = (closing + self.separation) / resistance
            e = self.separation / self.known if self.kind == "closing_speed" else self.known
            condition = 1.0 if self.kind == "closing_speed" else (1.0 + e) / e
        if self.rule == CRITICAL_FRACTION:
            # The slip after is this part of the slip before.
            left = abs(1.0 - self.bound * (1.0 - LAWS[self.law].sticking_slip(e)))
            condition = np.maximum(condition, 1.0 / left)
        tangential = ratio * normal
        velocity = closing, self.slip - self._slip_change(normal, tangential)
        return self._origin(regime, normal, tangential, e, condition, velocity, resistance > 0.0)

    def _closing(self) -> Any:
        """The closing speed, where it or the restitution is known."""
        return self.known if self.kind == "closing_speed" else self.separation / self.known

    def _sticking(self, regime: str, possible: Any) -> Origin:
        """The origin of a contact that does not slip under "kudlich-slibar", which sends all of the velocity back e-fold."""
        if self.law == BRACH:
            nothing = np.full((), np.nan)
            return self._origin(regime, nothing, nothing, nothing, nothing, (nothing, nothing), False)
        if self.kind == "energy_loss":
            stored = self.whole[0] * self.separation + self.whole[1] * self.slip
            inverse = np.sqrt(1.0 + 2.0 * self.known / stored)
        elif self.kind == "closing_speed":
            inverse = self.known / self.separation
        else:
            inverse = 1.0 / self.known
        factor = 1.0 + inverse
        closing = self.known if self.kind == "closing_speed" else self.separation * inverse
        possible = possible & ~self.at_rest & (self.separation > self.rounding)
        impulse = factor * self.whole[0], factor * self.whole[1]
        return self._origin(regime, *impulse, 1.0 / inverse, factor, (closing, 0.0 - self.slip * inverse), possible)

    def _shared_ratios(self) -> tuple[Any, Any]:
        """Impulse ratios that are the given share of the critical one.

        The no-slip impulse is proportional to P - y, with y = K^-1 (0, s') under "brach" and K^-1 (r, s') under
        "kudlich-slibar"; P_t N_s = f T_s P_n, with P_n from the closing speed, leaves a quadratic in the ratio.
        """
        y_n, y_t = self.whole
        if self.law == BRACH:
            # With e = -1 the wanted change along the normal is 0, and what remains is the slip.
            only_slip = self._kernel(np.full((), -1.0), FRICTION, np.zeros(()), self.bodies)
            y_n, y_t = 0.0 - only_slip.no_slip_normal, 0.0 - only_slip.no_slip_tangential
        share = self.bound
        square = y_n * self.k_nt
        linear = y_n * self.k_nn - share * y_t * self.k_nt - (1.0 - share) * (self._closing() + self.separation)
        constant = 0.0 - share * y_t * self.k_nn
        half = -0.5 * (linear + np.copysign(np.sqrt(linear * linear - 4.0 * square * constant), linear))
        return half / square, constant / half

    def _origin(
        self, regime: str, normal: Any, tangential: Any, e: Any, condition: Any, velocity: tuple[Any, Any], possible: Any
    ) -> Origin:
        e = np.where((e < 0.0) & (abs(self.separation) <= self.rounding), 0.0, e)
        e = np.where((e > 1.0) & (e <= 1.0 + 16.0 * EPS + self.rounding / abs(self.separation)), 1.0, e)
        motions = self._struck(0.0 - normal, 0.0 - tangential)
        before = [[*body[:2], *motion, *body[5:]] for body, motion in zip(self.bodies, motions, strict=True)]
        answer = self._kernel(e, self.rule, self.bound, before, contact_velocity=velocity)
        n_again, t_again = answer.normal_impulse, answer.tangential_impulse
        again = abs(n_again - normal) + abs(t_again - tangential) <= _SAME * (abs(normal) + abs(tangential))
        fits = possible & again & (answer[0] <= Status.ENERGY_GAIN) & (e >= 0.0) & (e <= 1.0)
        jams = ~np.isnan(normal) & ~np.asarray(possible)
        return Origin(regime, normal, tangential, e, condition, velocity, jams, (motions[0], motions[1]), fits)

    def origin(self, regime: str | None) -> tuple[list[Origin], Any]:
        """The candidates, and for each whether it fits and is none of those before it."""
        origins = [origin for origin in self.candidates() if regime in (None, origin.regime)]
        fits: list[Any] = []
        for i, origin in enumerate(origins):
            new = np.asarray(origin.fits)
            for earlier, taken in zip(origins[:i], fits, strict=True):
                apart = abs(origin.normal - earlier.normal) + abs(origin.tangential - earlier.tangential)
                new = new & ~(taken & (apart <= _SAME * (abs(origin.normal) + abs(origin.tangential))))
            fits.append(new)
        return origins, fits

    def elastic_loss(self, ratio: Any) -> Any:
        """The energy that an impact of this ratio with e = 1 loses that ends so: the least of all."""
        normal = 2.0 * self.separation / self.resistance(ratio)
        return 0.0 - ratio * normal * (self.slip - 0.5 * self._slip_change(normal, ratio * normal))

    def always_sticks(self, law: str = BRACH) -> Any:
        """Whether the contact is under this law and cannot end but as one that sticks."""
        if self.rule == IMPULSE_RATIO or self.law != law:
            return False
        return np.isposinf(self.bound) if self.rule == FRICTION else self.bound == 1.0

    def range(self) -> tuple[Any, Any]:
        """Between which slips before a contact that stuck under "brach" had its own; infinite where friction jams."""
        if not self.slides or self.law != BRACH:
            return np.full((), np.nan), np.full((), np.nan)
        slips = [np.where(one.jams, np.copysign(np.inf, self.k_nt), one.contact_velocity[1]) for one in self.slides]
        return np.minimum(*slips), np.maximum(*slips)

    def forgets_slip(self) -> Any:
        """Whether the contact ended so that the law keeps no trace of the slip before: without slip, or at rest."""
        if self.rule == IMPULSE_RATIO:
            return False
        could_stick = self.bound > 0.0 if self.rule == FRICTION else self.bound == 1.0
        return could_stick & (self.at_rest if self.law == KUDLICH_SLIBAR else abs(self.slip) <= self.noise)

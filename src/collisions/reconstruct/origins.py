"""The states that may have been before an end state: candidate impulses taken off it, each tried on the forward kernel."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ..kernels import codes
from ..kernels.eccentric import recoil, response
from ..kernels.friction import sticking_slip
from .outcome import NUMBERS, forward

NEARLY_PLASTIC = 0.01  # of the closing speed: what measured motions may still approach after a plastic impact
_SAME = 1e-6  # of the impulse: far above rounding, far below what separates two origins


class Origin(NamedTuple):
    """A candidate for the state before: how the contact ended, the impulse on B, what goes with it, and whether it fits."""

    regime: str
    normal: Any
    tangential: Any
    restitution: Any
    condition: Any
    slip: Any
    motions: tuple[tuple[Any, Any, Any], tuple[Any, Any, Any]]
    fits: Any


class End:
    """The state after, and what the kernel says of the contact there."""

    def __init__(self, numbers: dict[str, Any], kind: str, rule: str, law: str, pinned: tuple[bool, bool]) -> None:
        self.numbers = numbers
        self.kind, self.rule, self.law, self.pinned = kind, rule, law, pinned
        self.known, self.bound = numbers[kind], numbers[rule]
        self.n = numbers["normal[0]"], numbers["normal[1]"]
        self.p = numbers["point[0]"], numbers["point[1]"]
        self.bodies = [[numbers[f"{label}_after.{name}"] for name in NUMBERS] for label in "ab"]
        here = self._at_the_end()
        self.status = here[0]
        self.separation = 0.0 - here[codes.AT["closing_speed"]]
        self.k_nn = 1.0 / here[codes.AT["effective_mass"]]
        self.k_nt = here[codes.AT["coupling"]]
        speeds = [np.hypot(body[2], body[3]) for body in self.bodies]
        levers = [np.hypot(self.p[0] - body[5], self.p[1] - body[6]) for body in self.bodies]
        scale = sum(speeds) + sum(abs(body[4]) * lever for body, lever in zip(self.bodies, levers, strict=True))
        # The motion before leaves its rounding in the one after.
        closing = np.sqrt(2.0 * self.known * self.k_nn) if kind == "energy_loss" else self._closing()
        self.rounding = 64.0 * codes.EPS * (scale + np.where(closing > 0.0, closing, 0.0))
        self.approach = 0.0 - self.separation
        self.pressed = (self.approach > self.rounding) & (self.approach <= NEARLY_PLASTIC * closing) & (kind != "restitution")
        if np.any(self.pressed):
            # The nearest end that is plastic: a small push along the normal takes off what still approaches.
            push = np.where(self.pressed, self.approach / self.k_nn, 0.0)
            for body, motion in zip(self.bodies, self._struck(push, 0.0 * push), strict=True):
                body[2:5] = motion
            here = self._at_the_end()
            self.separation = np.where(self.pressed, 0.0, 0.0 - here[codes.AT["closing_speed"]])
        self.slip = here[codes.AT["slip_before"]]
        # K^-1 times the contact velocity after.
        self.whole = 0.0 - here[codes.AT["no_slip_normal"]], 0.0 - here[codes.AT["no_slip_tangential"]]
        self.at_rest = (abs(self.slip) <= self.rounding) & (abs(self.separation) <= self.rounding)

    def _at_the_end(self) -> tuple[Any, ...]:
        """What the kernel says of the end state, as if it approached: the closing speed there is minus the separation speed."""
        return self._kernel(np.zeros(()), codes.FRICTION, np.zeros(()), self.bodies)

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

    def _kernel(self, e: Any, rule: str, bound: Any, bodies: Sequence[Sequence[Any]], n: Any = None) -> tuple[Any, ...]:
        law = self.law if rule == self.rule else codes.BRACH
        inputs = (e, *(n or self.n), bound, *self.p, *bodies[0], *bodies[1])
        return forward(*inputs, rule, law, *self.pinned)

    def candidates(self) -> list[Origin]:
        """Every origin the law allows, whether it fits or not."""
        if self.rule == codes.IMPULSE_RATIO:
            return [self._along("given", self.bound)]
        if self.rule == codes.FRICTION:
            finite = np.where(np.isinf(self.bound), np.nan, self.bound)
            return [
                self._along("frictionless", np.where(self.bound == 0.0, 0.0, np.nan)),
                *(self._along("sliding", np.where(self.bound > 0.0, sign * finite, np.nan)) for sign in (1.0, -1.0)),
                self._sticking("sticking", self.bound > 0.0),
            ]
        # No part of the critical ratio is 0, also where a contact has none.
        ratios = (np.where(self.bound == 0.0, 0.0, ratio) for ratio in self._shared_ratios())
        shared = (np.where(self.bound < 1.0, ratio, np.nan) for ratio in ratios)
        return [*(self._along("given", ratio) for ratio in shared), self._sticking("given", self.bound == 1.0)]

    def _along(self, regime: str, ratio: Any) -> Origin:
        """The origin for a given impulse ratio."""
        resistance = self.k_nn + ratio * self.k_nt
        if self.kind == "energy_loss":
            # Along the impulse the contact is a one-dimensional one, with the effective mass of that direction.
            length = np.hypot(1.0, ratio)
            d = (self.n[0] - ratio * self.n[1]) / length, (self.n[1] + ratio * self.n[0]) / length
            there = self._kernel(np.zeros(()), codes.FRICTION, np.zeros(()), self.bodies, d)
            parting, mass = 0.0 - there[codes.AT["closing_speed"]], there[codes.AT["effective_mass"]]
            root = np.sqrt(parting * parting + 2.0 * self.known / mass)
            impulse = mass * np.where(parting > 0.0, parting + root, (2.0 * self.known / mass) / (root - parting))
            normal = impulse / length
            closing = resistance * normal - self.separation
            return self._origin(regime, normal, ratio * normal, self.separation / closing, 2.0, resistance > 0.0)
        normal = (self._closing() + self.separation) / resistance
        e = self.separation / self.known if self.kind == "closing_speed" else self.known
        condition = 1.0 if self.kind == "closing_speed" else (1.0 + e) / e
        if self.rule == codes.CRITICAL_FRACTION:
            # The slip after is this part of the slip before.
            left = abs(1.0 - self.bound * (1.0 - sticking_slip(e, self.law)))
            condition = np.maximum(condition, 1.0 / left)
        return self._origin(regime, normal, ratio * normal, e, condition, resistance > 0.0)

    def _closing(self) -> Any:
        """The closing speed, where it or the restitution is known."""
        return self.known if self.kind == "closing_speed" else self.separation / self.known

    def _sticking(self, regime: str, possible: Any) -> Origin:
        """The origin of a contact that does not slip under "kudlich-slibar", which sends all of the velocity back e-fold."""
        if self.law == codes.BRACH:
            nothing = np.full((), np.nan)
            return self._origin(regime, nothing, nothing, nothing, nothing, False)
        if self.kind == "energy_loss":
            stored = self.whole[0] * self.separation + self.whole[1] * self.slip
            inverse = np.sqrt(1.0 + 2.0 * self.known / stored)
        elif self.kind == "closing_speed":
            inverse = self.known / self.separation
        else:
            inverse = 1.0 / self.known
        factor = 1.0 + inverse
        possible = possible & ~self.at_rest
        return self._origin(regime, factor * self.whole[0], factor * self.whole[1], 1.0 / inverse, factor, possible)

    def _shared_ratios(self) -> tuple[Any, Any]:
        """Impulse ratios that are the given share of the critical one.

        The no-slip impulse is proportional to P - y, with y = K^-1 (0, s') under "brach" and K^-1 (r, s') under
        "kudlich-slibar"; P_t N_s = f T_s P_n, with P_n from the closing speed, leaves a quadratic in the ratio.
        """
        y_n, y_t = self.whole
        if self.law == codes.BRACH:
            # With e = -1 the wanted change along the normal is 0, and what remains is the slip.
            only_slip = self._kernel(np.full((), -1.0), codes.FRICTION, np.zeros(()), self.bodies)
            y_n, y_t = 0.0 - only_slip[codes.AT["no_slip_normal"]], 0.0 - only_slip[codes.AT["no_slip_tangential"]]
        share = self.bound
        square = y_n * self.k_nt
        linear = y_n * self.k_nn - share * y_t * self.k_nt - (1.0 - share) * (self._closing() + self.separation)
        constant = 0.0 - share * y_t * self.k_nn
        half = -0.5 * (linear + np.copysign(np.sqrt(linear * linear - 4.0 * square * constant), linear))
        return half / square, constant / half

    def _origin(self, regime: str, normal: Any, tangential: Any, e: Any, condition: Any, possible: Any) -> Origin:
        e = np.where((e < 0.0) & (abs(self.separation) <= self.rounding), 0.0, e)
        e = np.where((e > 1.0) & (e <= 1.0 + 16.0 * codes.EPS + self.rounding / abs(self.separation)), 1.0, e)
        motions = self._struck(0.0 - normal, 0.0 - tangential)
        before = [[*body[:2], *motion, *body[5:]] for body, motion in zip(self.bodies, motions, strict=True)]
        answer = self._kernel(e, self.rule, self.bound, before)
        n_again, t_again = answer[codes.AT["normal_impulse"]], answer[codes.AT["tangential_impulse"]]
        again = abs(n_again - normal) + abs(t_again - tangential) <= _SAME * (abs(normal) + abs(tangential))
        fits = possible & again & (answer[0] <= codes.ENERGY_GAIN) & (e >= 0.0) & (e <= 1.0)
        slip = answer[codes.AT["slip_before"]]
        return Origin(regime, normal, tangential, e, condition, slip, (motions[0], motions[1]), fits)

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

    def always_sticks(self) -> bool:
        """Whether no contact under this law can end with slip."""
        sure = self.rule == codes.FRICTION and np.any(np.isposinf(self.bound))
        return self.law == codes.BRACH and bool(sure or (self.rule == codes.CRITICAL_FRACTION and np.any(self.bound == 1.0)))

    def jump(self, origins: list[Origin]) -> Any:
        """Distance of the slips before to which a contact that slid either way leads back; NaN where nothing jumps."""
        slips = [origin.slip for origin in origins if origin.regime == "sliding"]
        return abs(slips[0] - slips[1]) if self.law == codes.BRACH and len(slips) == 2 else np.full((), np.nan)

    def forgets_slip(self) -> Any:
        """Whether the contact ended so that the law keeps no trace of the slip before: without slip, or at rest."""
        if self.rule == codes.IMPULSE_RATIO:
            return False
        could_stick = self.bound > 0.0 if self.rule == codes.FRICTION else self.bound == 1.0
        return could_stick & (self.at_rest if self.law == codes.KUDLICH_SLIBAR else abs(self.slip) <= self.rounding)

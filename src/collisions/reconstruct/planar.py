"""Planar impact backwards, rotation included: from the motion after to the motion before.

Time reversed, an impact is an impact: velocities change sign, closing and separation exchange places and the impulse stays. So
every origin of an end state is a candidate impulse taken off that state; the forward kernel then says whether it leads there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..arguments import read
from ..eccentric import body_numbers, missing_numbers
from ..errors import AmbiguousSolutionError, CollisionsError, InputError, NoSolutionError
from ..impact import Asked, Impact
from ..kernels import codes
from ..kernels.eccentric import eccentric, recoil, response
from ..provenance import Reconstruction
from ..units import Door, Input, Pair
from ..vehicle import Vehicle
from .outcome import Cases, exactly, input_faults, plain_error, settle

_forward: Callable[..., tuple[Any, ...]] = eccentric
_REGIMES = ("frictionless", "sliding", "sticking", "given")
_SAME = 1e-6  # of the impulse: far above rounding, far below what separates two origins
_NUMBERS = ("mass", "yaw_inertia", "vx", "vy", "yaw_rate", "x", "y", "pivot_x", "pivot_y")


def planar(
    a_after: Vehicle,
    b_after: Vehicle,
    *,
    normal: Input | tuple[Input, Input],
    point: Pair,
    restitution: Input | None = None,
    closing_speed: Input | None = None,
    energy_loss: Input | None = None,
    friction: Input | None = None,
    impulse_ratio: Input | None = None,
    critical_fraction: Input | None = None,
    law: str = "brach",
    regime: str | None = None,
    on_failure: str | None = None,
) -> Impact:
    """The impact that ended in these motions: ``eccentric`` backwards.

    The states after, the contact and the material determine the states before, except where the impact has wiped them out. A
    contact that ended without slip under "brach", or at rest under either law, keeps no trace of the slip before; after a
    plastic impact nothing is left of the closing speed, unless it or the energy loss is known; and an end state may have two
    origins. Those are refused, with what there is in ``solutions`` and what would decide.

    Parameters
    ----------
    a_after, b_after : Vehicle
        The vehicles just after separation, with yaw inertia and position as for ``eccentric``.
    normal : angle [rad] or tuple (nx, ny)
        Direction from A into B.
    point : pair [m]
        Contact point.
    restitution : float, str, Quantity or array [1], optional
        Coefficient of restitution, above 0: exactly one of these three.
    closing_speed : float, str, Quantity or array [m/s], optional
        Speed at which the contact points approached along the normal, > 0.
    energy_loss : float, str, Quantity or array [J], optional
        Energy dissipated, >= 0 (not the energy absorbed at maximum crush).
    friction, impulse_ratio, critical_fraction : float, str, Quantity or array [1], optional
        Exactly one, as for ``eccentric``.
    law : {"brach", "kudlich-slibar"}, optional
        How restitution acts and what no slip means.
    regime : {"frictionless", "sliding", "sticking", "given"}, optional
        How the contact ended, where that decides between two origins: a value of ``Impact.regime``.
    on_failure : {None, "raise", "nan"}, optional
        What a refused case of a batch does.

    Returns
    -------
    Impact
        The answer of ``eccentric`` for the states found; ``reconstruction.condition`` is (1+e)/e for a given restitution and
        for a contact that sticks under "kudlich-slibar", else 1 for a closing speed, and at most 2 for an energy loss.

    Raises
    ------
    InputError
        An argument that cannot be used.
    AmbiguousSolutionError
        More than one origin fits; all are in ``solutions``.
    NoSolutionError
        The motions do not part, or nothing before ends so.

    Examples
    --------
    >>> import collisions as col
    >>> a = col.Vehicle(mass=1100, vx=20.0, yaw_inertia=1800, x=0.0, y=0.0)
    >>> b = col.Vehicle(mass=950, vy=16.0, yaw_inertia=1500, x=2.5, y=0.4)
    >>> contact = dict(normal=0.0, point=(1.6, 0.3), friction=0.2)
    >>> end = col.eccentric(a, b, 0.2, **contact)
    >>> start = col.reconstruct.planar(end.a.after, end.b.after, restitution=0.2, **contact)
    >>> round(start.a.before.vx, 12), round(start.b.before.vy, 12)
    (20.0, 16.0)
    """
    given = exactly({"restitution": restitution, "closing_speed": closing_speed, "energy_loss": energy_loss}, 1, "planar")
    ((kind, value),) = given.items()
    door = Door()
    amount = value if kind == "restitution" else _amount(door, kind, value)
    if regime is not None and (not isinstance(regime, str) or regime not in _REGIMES):
        door.refuse(
            InputError(
                f"regime must be one of {', '.join(map(repr, _REGIMES))}, got {regime!r}", code="bad_regime", argument="regime"
            )
        )
    e, n, rule, bound, contact, _ = read(
        a_after,
        b_after,
        amount if kind == "restitution" else 0.0,
        normal,
        point,
        friction,
        impulse_ratio,
        critical_fraction,
        law,
        [*door.problems, *missing_numbers(a_after, b_after, point)],
    )
    bodies = body_numbers(a_after, contact), body_numbers(b_after, contact)
    known = e if kind == "restitution" else amount
    everything = {kind: known, rule: bound, "normal[0]": n[0], "normal[1]": n[1]}
    everything |= {f"point[{i}]": part for i, part in enumerate(contact or ())}
    for label, body in zip("ab", bodies, strict=True):
        everything |= {f"{label}_after.{name}": number for name, number in zip(_NUMBERS, body, strict=True)}
    everything |= {
        f"{label}_after.heading": body.heading for label, body in (("a", a_after), ("b", b_after)) if body.heading is not None
    }
    if rule == codes.CRITICAL_FRACTION and kind == "energy_loss" and np.any((bound > 0.0) & (bound < 1.0)):
        raise InputError(
            "a critical_fraction between 0 and 1 cannot be used with energy_loss; give impulse_ratio=, or the restitution or "
            "closing_speed instead of the energy",
            code="bad_combination",
            argument="critical_fraction",
        )
    cases = Cases.of(everything)
    arrays = {name: np.asarray(number, dtype=np.float64) for name, number in everything.items()}
    pinned = a_after.pivot is not None, b_after.pivot is not None
    with np.errstate(all="ignore"):
        end = _End(arrays, kind, rule, law, pinned)
        return _answer(cases, end, a_after, b_after, (e, n, rule, bound, law, contact), regime, on_failure)


def _amount(door: Door, kind: str, value: Any) -> Any:
    unit, least = ("m/s", "> 0") if kind == "closing_speed" else ("J", ">= 0")
    number = door.number(value, unit, kind)
    if not isinstance(number, np.ndarray) and (number <= 0.0 if kind == "closing_speed" else number < 0.0):
        door.refuse(InputError(f"{kind} must be {least}, got {value!r}", code="not_positive", argument=kind))
    return number


class _Origin(NamedTuple):
    """A candidate for the state before: how the contact ended, the impulse on B, restitution, condition, motions before."""

    regime: str
    normal: Any
    tangential: Any
    restitution: Any
    condition: Any
    motions: tuple[tuple[Any, Any, Any], tuple[Any, Any, Any]]
    fits: Any


class _End:
    """The state after, and what the kernel says of the contact there."""

    def __init__(self, numbers: dict[str, Any], kind: str, rule: str, law: str, pinned: tuple[bool, bool]) -> None:
        self.numbers = numbers
        self.kind, self.rule, self.law, self.pinned = kind, rule, law, pinned
        self.known, self.bound = numbers[kind], numbers[rule]
        self.n = numbers["normal[0]"], numbers["normal[1]"]
        self.p = numbers["point[0]"], numbers["point[1]"]
        self.bodies = [[numbers[f"{label}_after.{name}"] for name in _NUMBERS] for label in "ab"]
        # Approaching the end state, so to speak: the closing speed there is minus the separation speed.
        here = self._kernel(np.zeros(()), codes.FRICTION, np.zeros(()), self.bodies)
        self.status = here[0]
        self.separation = 0.0 - here[codes.AT["closing_speed"]]
        self.slip = here[codes.AT["slip_before"]]
        self.k_nn = 1.0 / here[codes.AT["effective_mass"]]
        self.k_nt = here[codes.AT["coupling"]]
        # K^-1 times the contact velocity after.
        self.whole = 0.0 - here[codes.AT["no_slip_normal"]], 0.0 - here[codes.AT["no_slip_tangential"]]
        speeds = [np.hypot(body[2], body[3]) for body in self.bodies]
        levers = [np.hypot(self.p[0] - body[5], self.p[1] - body[6]) for body in self.bodies]
        scale = sum(speeds) + sum(abs(body[4]) * lever for body, lever in zip(self.bodies, levers, strict=True))
        # The motion before leaves its rounding in the one after.
        closing = np.sqrt(2.0 * self.known * self.k_nn) if kind == "energy_loss" else self._closing()
        self.rounding = 64.0 * codes.EPS * (scale + np.where(closing > 0.0, closing, 0.0))
        self.at_rest = (abs(self.slip) <= self.rounding) & (abs(self.separation) <= self.rounding)

    def _kernel(self, e: Any, rule: str, bound: Any, bodies: Sequence[Sequence[Any]], n: Any = None) -> tuple[Any, ...]:
        law = self.law if rule == self.rule else codes.BRACH
        inputs = (e, *(n or self.n), bound, *self.p, *bodies[0], *bodies[1])
        return _forward(*inputs, rule, law, *self.pinned)

    def candidates(self) -> list[_Origin]:
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
        shared = (np.where(self.bound < 1.0, ratio, np.nan) for ratio in self._shared_ratios())
        return [*(self._along("given", ratio) for ratio in shared), self._sticking("given", self.bound == 1.0)]

    def _along(self, regime: str, ratio: Any) -> _Origin:
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
        return self._origin(regime, normal, ratio * normal, e, condition, resistance > 0.0)

    def _closing(self) -> Any:
        """The closing speed, where it or the restitution is known."""
        return self.known if self.kind == "closing_speed" else self.separation / self.known

    def _sticking(self, regime: str, possible: Any) -> _Origin:
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

    def _origin(self, regime: str, normal: Any, tangential: Any, e: Any, condition: Any, possible: Any) -> _Origin:
        e = np.where((e < 0.0) & (abs(self.separation) <= self.rounding), 0.0, e)
        e = np.where((e > 1.0) & (e <= 1.0 + 16.0 * codes.EPS + self.rounding / abs(self.separation)), 1.0, e)
        (nx, ny), (px, py) = self.n, self.p
        x, y = nx * normal - ny * tangential, ny * normal + nx * tangential
        motions = []
        for body, pinned, sign in zip(self.bodies, self.pinned, (-1.0, 1.0), strict=True):
            mass, inertia, vx, vy, yaw_rate, cx, cy, ox, oy = body
            a, b, rx, ry, _, _ = response(mass, inertia, vx, vy, cx, cy, ox, oy, px, py, pinned)
            dvx, dvy, dw = recoil(a, b, sign * (rx * y - ry * x), sign * x, sign * y, cx, cy, ox, oy, pinned)
            motions.append((vx - dvx, vy - dvy, yaw_rate - dw))
        before = [[*body[:2], *motion, *body[5:]] for body, motion in zip(self.bodies, motions, strict=True)]
        forward = self._kernel(e, self.rule, self.bound, before)
        n_again, t_again = forward[codes.AT["normal_impulse"]], forward[codes.AT["tangential_impulse"]]
        again = abs(n_again - normal) + abs(t_again - tangential) <= _SAME * (abs(normal) + abs(tangential))
        fits = possible & again & (forward[0] <= codes.ENERGY_GAIN) & (e >= 0.0) & (e <= 1.0)
        return _Origin(regime, normal, tangential, e, condition, (motions[0], motions[1]), fits)

    def origin(self, regime: str | None) -> tuple[list[_Origin], Any]:
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

    def forgets_slip(self) -> Any:
        """Whether the contact ended so that the law keeps no trace of the slip before: without slip, or at rest."""
        if self.rule == codes.IMPULSE_RATIO:
            return False
        could_stick = self.bound > 0.0 if self.rule == codes.FRICTION else self.bound == 1.0
        return could_stick & (self.at_rest if self.law == codes.KUDLICH_SLIBAR else abs(self.slip) <= self.rounding)


def _answer(
    cases: Cases, end: _End, a: Vehicle, b: Vehicle, contact: tuple[Any, ...], regime: str | None, on_failure: Any
) -> Impact:
    e, n, rule, bound, law, point = contact
    origins, fits = end.origin(regime)
    count = sum(fit.astype(int) for fit in fits) if fits else np.zeros((), dtype=int)
    blind = end.forgets_slip() & (regime != "sliding")
    plastic = np.equal(end.known, 0.0) & (end.kind == "restitution")
    parts = end.separation > (end.rounding if end.kind == "restitution" else -end.rounding)
    status = cases.verdict(
        (
            *input_faults(end.numbers),
            (end.status == codes.IMMOVABLE, codes.IMMOVABLE),
            (plastic, codes.INVERSE_E0),
            (~parts, codes.NOT_SEPARATING),
            (blind, codes.STICK_INVERSE),
            (count == 1, codes.OK),
            (count > 1, codes.AMBIGUOUS_INVERSE),
            (True, codes.CONTRADICTORY),
        )
    )
    sure = np.equal(status, codes.OK)
    which = np.argmax(np.stack(np.broadcast_arrays(*fits)), axis=0) if fits else 0
    condition = np.choose(which, [one.condition for one in origins]) if origins else np.nan
    origin = Reconstruction(method="planar", known=(end.kind, rule), condition=cases.values(np.where(sure, condition, np.nan)))

    def asked(found: list[Any], restitution: Any, keep: Any) -> Asked:
        moved = [
            body._moved(*(cases.values(np.where(keep, part, np.nan)) for part in motion))
            for body, motion in zip((a, b), found, strict=True)
        ]
        used = e if end.kind == "restitution" else cases.values(np.where(keep, restitution, 0.0))
        return Asked("eccentric", moved[0], moved[1], used, n, rule, bound, law, point)

    def error(index: tuple[int, ...]) -> CollisionsError:
        solutions: tuple[Impact, ...] = ()
        if cases.shape is None:
            solutions = tuple(
                asked(list(one.motions), one.restitution, True).ask()
                for one, fit in zip(origins, fits, strict=True)
                if fit and status in (codes.AMBIGUOUS_INVERSE, codes.STICK_INVERSE)
            )
        separation, slip = cases.one(end.separation, index), cases.one(end.slip, index)
        return _error(int(np.asarray(status)[index]), end, separation, slip, regime, solutions)

    motions = [
        [np.choose(which, [one.motions[side][part] for one in origins]) if origins else np.nan for part in range(3)]
        for side in range(2)
    ]
    restitution = np.choose(which, [one.restitution for one in origins]) if origins else np.nan
    return settle(asked(motions, restitution, sure), status, origin, on_failure, error)


def _error(
    status: int, end: _End, separation: float, slip: float, regime: str | None, solutions: tuple[Impact, ...]
) -> CollisionsError:
    if status == codes.AMBIGUOUS_INVERSE:
        told = " or ".join(
            f"{impact.regime} with impulse ratio {impact.impulse_ratio:.4g} from a closing speed of "
            f"{impact.closing_speed:.6g} m/s"
            for impact in solutions
        )
        return AmbiguousSolutionError(
            f"{len(solutions) or 'several'} states before end so{': ' if told else ''}{told}; all are in .solutions; what "
            f"decides is regime= (how the contact ended) or impulse_ratio= of either sign",
            code="ambiguous_inverse",
            solutions=solutions,
        )
    if status == codes.STICK_INVERSE:
        other = ", or law='kudlich-slibar' if that is the model" if end.law == codes.BRACH else ""
        return NoSolutionError(
            f"the contact ended without slip (slip after {slip:.3g} m/s), and under {end.law!r} any slip before may end so: "
            f"the motion across the normal is lost. .solutions holds the {len(solutions)} ends of the range, where friction is "
            f"just used up; regime='sliding' or impulse_ratio= of either sign decides{other}",
            code="stick_inverse",
            solutions=solutions,
        )
    texts = {
        codes.INVERSE_E0: "restitution = 0: after a plastic impact nothing is left of the closing speed; give closing_speed= "
        "or energy_loss= instead",
        codes.NOT_SEPARATING: f"the contact points do not part after the impact: separation speed {separation:.6g} m/s along "
        f"the normal, which must point from A into B; for a plastic impact give closing_speed= or energy_loss=",
        codes.IMMOVABLE: "nothing can yield along the normal: both bodies are fixed there; correct normal or point, or give a "
        "finite mass",
    }
    text = texts.get(status)
    if text is None:
        wanted = f" in the regime {regime!r}" if regime is not None else ""
        text = (
            f"no motion before ends so{wanted} under {end.law!r} with this {end.rule} and {end.kind}: separation speed "
            f"{separation:.6g} m/s, slip after {slip:.6g} m/s; check the normal and the yaw rates, or give another of "
            f"restitution, closing_speed, energy_loss"
        )
    return plain_error(status, text, separation_speed=separation, slip_after=slip, solutions=solutions)

"""Formulas of the reverse solvers: in-line impacts from any three values, crossing courses, and
roots of polynomials.

In line (eqs 5 to 8 of the paper, read backwards) everything follows from the closing speed g and
the separation speed r = e g: with the shares of the masses f_a + f_b = 1,

    va - vb = g     vb' - va' = r     va - va' = f_a (g + r)     vb' - vb = f_b (g + r)     loss = m
    (g - r)(g + r) / 2

Tyres that slow A by s_a and B by s_b while the contact lasts leave all of these true of velocities
that have half of it already before, and half of it not yet after (va - s_a / 2, va' + s_a / 2):
these have g + k/2 and r + k/2, with k = s_b - s_a. Only r = e g is then another line.

Along courses that cross, every moving body is a term: sign (+ before, - after), mass, speed,
course. The balance sum(sign m s h) + J = 0 crossed with one unknown's course leaves the other
unknown alone, and all cross products are sines of differences of courses.
"""

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from .status import EPS

VELOCITIES = ("va", "vb", "va_after", "vb_after")
# Closing and separation speed.
Pair: TypeAlias = tuple[Any, Any]
# Sample points of a quartic: no point is 0 or a multiple of another, where a body at rest would
# carry no information.
PLACES = np.array([-1.06, -0.47, 0.13, 0.61, 1.27])
_FROM_PLACES = np.linalg.inv(np.vander(PLACES, increasing=True)).T
# A double root comes out of rounding as a pair with imaginary parts of the square root of it.
_REAL = 1e-6


def inline_speeds(
    known: dict[str, Any],
    share_a: Any,
    share_b: Any,
    reduced: Any,
    eps: float = EPS,
    incomplete: bool = False,
    more: Any = 0.0,
    slowed: Any = 0.0,
) -> list[Pair]:
    """Closing and separation speeds that fit the three known values: one pair, or two that the
    caller must tell apart.

    ``incomplete`` says whether the separation speed may be below 0. ``more`` is what tyres add to
    both, k/2, of velocities with half of what they do, ``slowed``.
    """
    v = {name: known[name] for name in VELOCITIES if name in known}
    restitution: Any = known.get("restitution")
    if len(v) == 3:
        return [_from_three(v, share_a, share_b)]
    if len(v) == 2:
        p, q, difference = _relation(v, share_a, share_b)
        if np.any(np.not_equal(slowed, 0.0)):
            # Velocities with half of what tyres do are rounded, so that equal ones may differ.
            sizes = sum(abs(value) for value in v.values()) + slowed
            rounding = np.where(slowed > 0.0, 4.0 * eps * sizes, 0.0)
            difference = np.where(abs(difference) <= rounding, 0.0, difference)
        relation = p, q, difference
    if "energy_loss" not in known:
        beside = (1.0 - restitution) * more
        closing = (difference - q * beside) / (p + q * restitution)
        return [(closing, restitution * closing + beside)]
    squared = 2.0 * known["energy_loss"] / reduced
    if len(v) == 1:
        closing = losing_speed(known["energy_loss"] / reduced, restitution, more)
        return [(closing, restitution * closing + (1.0 - restitution) * more)]
    # Where tyres take from the approach, a separation below 0 here may be none of the bodies.
    both = incomplete or bool(np.any(np.less(more, 0.0)))
    return _from_energy(v, relation, squared, eps, both)


def moved_by_rounding(
    known: dict[str, Any],
    share_a: Any,
    share_b: Any,
    reduced: Any,
    eps: float,
    pair: Pair,
    scale: Any,
) -> tuple[Any, Any]:
    """How far rounding may move a closing and a separation speed that two velocities and an energy
    give; ``scale`` is the size of the velocities. 0 for other known values.

    The pair lies where the line p g + q r = d cuts the hyperbola (g - r)(g + r) = s. A step t along
    the line, (-q, p) t, changes (g - r)(g + r) by -2 h t - (p^2 - q^2) t^2, h = p r + q g. What
    rounding does to s and d is a change ds: away from a double root it moves the pair by ds/(2 h),
    and at one, where h = 0, by the root of ds/(p^2 - q^2), which is the most.
    """
    v = {name: known[name] for name in VELOCITIES if name in known}
    if len(v) != 2 or "energy_loss" not in known:
        return 0.0, 0.0
    p, q, _ = _relation(v, share_a, share_b)
    larger = np.fmax(abs(p), abs(q))
    p, q = p / larger, q / larger
    g, r = pair
    squared = 2.0 * known["energy_loss"] / reduced
    ds = 16.0 * eps * (squared + scale / larger * (abs(g) + abs(r)))
    bend = abs(p * p - q * q) * ds
    h = np.fmax(abs(p * r + q * g), np.sqrt(bend))
    step = ds / (h + np.sqrt(h * h - bend))
    return abs(q) * step, abs(p) * step


def allowed_losses(
    known: dict[str, Any], share_a: Any, share_b: Any, reduced: Any
) -> tuple[Any, Any]:
    """The least and the most that two known velocities can lose with e from 0 to 1; NaN where no
    impact has these velocities.

    With e = 0 they lose (difference / p)^2 m / 2. That is the most, unless q is negative: then a
    bounce needs a faster approach, and the loss rises with e, without end if p <= -q, else until e
    = -q/p, from where it falls to 0.
    """
    v = {name: known[name] for name in VELOCITIES if name in known}
    if len(v) != 2 or _names(v) == ("va_after", "vb_after"):
        return np.nan, np.nan
    p, q, difference = _relation(v, share_a, share_b)
    plastic = 0.5 * reduced * (difference / p) ** 2
    without_end = (p < -q) | ((p == -q) & (difference > 0.0))
    bounced = np.where(difference == 0.0, 0.0, 0.5 * reduced * difference**2 / (p + q))
    most = np.where(without_end, np.inf, np.where(np.less(q, 0.0), bounced, plastic))
    possible = difference >= 0.0
    return np.where(possible, np.where(without_end, plastic, 0.0), np.nan), np.where(
        possible, most, np.nan
    )


def moving_apart(known: dict[str, Any], share_a: Any, share_b: Any) -> Any:
    """Whether two known velocities leave no approach, whatever the energy: with p > -q and g > r, p
    g + q r is positive.
    """
    v = {name: known[name] for name in VELOCITIES if name in known}
    if len(v) != 2 or "energy_loss" not in known:
        return False
    p, q, difference = _relation(v, share_a, share_b)
    return (difference < 0.0) & (p > 0.0) & (p >= -q)


def losing_speed(loss_per_mass: Any, restitution: Any, more: Any = 0.0) -> Any:
    """Closing speed that dissipates an energy per reduced mass (eq 8), with what tyres add to it,
    as in ``inline_speeds``.
    """
    half = more / (1.0 + restitution)
    squared = 2.0 * loss_per_mass / ((1.0 - restitution) * (1.0 + restitution))
    return np.sqrt(half * half + squared) - half + more


def energy_of_speeds(mass_a: Any, speed_a: Any, mass_b: Any, speed_b: Any) -> Any:
    """Energy that two equivalent speeds stand for, of which an infinite mass has none."""
    pairs = (mass_a, speed_a), (mass_b, speed_b)
    parts = [np.where(speed == 0.0, 0.0, 0.5 * mass * (speed * speed)) for mass, speed in pairs]
    return parts[0] + parts[1]


def changing_speed(delta_v: Any, share: Any, restitution: Any) -> Any:
    """Closing speed that changes the velocity of a body with this share by delta-V (eqs
    5 and 6).
    """
    return delta_v / (share * (1.0 + restitution))


def _from_three(v: dict[str, Any], share_a: Any, share_b: Any) -> Pair:
    total = (
        (v["va"] - v["va_after"]) / share_a
        if {"va", "va_after"} <= v.keys()
        else (v["vb_after"] - v["vb"]) / share_b
    )
    if {"va", "vb"} <= v.keys():
        closing = v["va"] - v["vb"]
        return closing, total - closing
    separation = v["vb_after"] - v["va_after"]
    return total - separation, separation


def _relation(v: dict[str, Any], share_a: Any, share_b: Any) -> tuple[Any, Any, Any]:
    """The equation that two velocities give for closing and separation speed, p g + q r = value: p,
    q and the value.
    """
    first, second = v.values()
    return {
        ("va", "vb"): (1.0, 0.0, first - second),
        ("va", "va_after"): (share_a, share_a, first - second),
        ("va", "vb_after"): (share_a, -share_b, first - second),
        ("vb", "va_after"): (share_b, -share_a, second - first),
        ("vb", "vb_after"): (share_b, share_b, second - first),
        ("va_after", "vb_after"): (0.0, 1.0, second - first),
    }[_names(v)]


def _names(v: dict[str, Any]) -> tuple[str, str]:
    first, second = v
    return first, second


def _from_energy(
    v: dict[str, Any], relation: tuple[Any, Any, Any], squared: Any, eps: float, both: bool
) -> list[Pair]:
    """With (g - r)(g + r) given; ``both`` asks for a separation speed below 0 too."""
    p, q, difference = relation
    root = np.sqrt(squared)
    match _names(v):
        case ("va", "vb"):
            left = (difference - root) * (difference + root)
            # Rounding may leave a value below 0 for an impact that loses all it can.
            parting = np.sqrt(np.where((left < 0.0) & (left >= -16.0 * eps * squared), 0.0, left))
            return (
                [(difference, parting), (difference, -parting)] if both else [(difference, parting)]
            )
        case ("va_after", "vb_after"):
            return [(np.hypot(difference, root), difference)]
        case ("va", "va_after") | ("vb", "vb_after"):
            total = difference / p
            less = np.where(squared == 0.0, 0.0, squared / total)
            return [(0.5 * (total + less), 0.5 * (total - less))]
    # p g + q r with p > 0 > q is a hyperbola cut by a line: the roots, each in the form that
    # subtracts nothing.
    q = -q
    inside = difference * difference + (q - p) * squared
    rounding = 16.0 * eps * (difference * difference + squared)
    middle = np.sqrt(np.where(abs(inside) <= rounding, 0.0, inside))
    sign = np.where(difference < 0.0, -1.0, 1.0)
    size = abs(difference)
    separation = sign * (p * p * squared - difference * difference) / (p * middle + q * size)
    near = (
        sign * (difference * difference + q * q * squared) / (q * middle + p * size),
        np.where(p == 0.0, 0.0 - difference / q, separation),
    )
    far = sign * (q * middle + p * size) / (p - q), sign * (p * middle + q * size) / (p - q)
    return [near, far]


class Term(NamedTuple):
    """One body before or after; ``speed`` is None where it is unknown, ``course`` None for a body
    at rest.
    """

    sign: float
    mass: Any
    speed: Any
    course: Any


def unknown_speed(
    terms: Iterable[Term], impulse: tuple[Any, Any] | None, wanted: Term, other: Term
) -> Any:
    """The speed of one unknown term, the other being eliminated; not finite where their courses are
    parallel.
    """
    total: Any = 0.0
    for term in terms:
        if term.speed is not None and term.course is not None:
            total = total + term.sign * (term.mass / wanted.mass) * (
                term.speed * term.course.to(other.course)[1]
            )
    if impulse is not None:
        c, s = other.course.direction
        total = total + (impulse[0] * s - impulse[1] * c) / wanted.mass
    return np.divide(-wanted.sign * total, wanted.course.to(other.course)[1])


def parabola_roots(samples: Sequence[Any], step: Any) -> tuple[Any, Any]:
    """Roots of the parabola through three points a step apart, the middle one at 0, rising; NaN
    where there are none.
    """
    behind, middle, ahead = samples
    square = 0.5 * (ahead + behind) - middle
    linear = 0.5 * (ahead - behind)
    scale = abs(behind) + abs(middle) + abs(ahead)
    square = np.where(abs(square) <= 8.0 * EPS * scale, 0.0, square)
    inside = linear * linear - 4.0 * square * middle
    # A double root, where the line only touches the parabola, survives rounding.
    inside = np.where(
        abs(inside) <= 64.0 * EPS * (linear * linear + abs(square) * scale), 0.0, inside
    )
    half = -0.5 * (linear + np.copysign(np.sqrt(inside), linear))
    one = np.where(square == 0.0, np.nan, half / square)
    other = np.where(half == 0.0, np.where(square == 0.0, np.nan, 0.0), middle / half)
    return step * np.fmin(one, other), step * np.fmax(one, other)


def quartic_roots(samples: Sequence[Any], step: Any) -> list[Any]:
    """Real roots of the quartic through five points at ``PLACES`` times the step; NaN in place of
    complex ones.
    """
    values = np.stack(np.broadcast_arrays(*samples), axis=-1)
    largest = np.max(abs(values), axis=-1, keepdims=True)
    coefficients = (values / largest) @ _FROM_PLACES
    leading = coefficients[..., 4:]
    below = -coefficients[..., :4] / np.where(abs(leading) < EPS, EPS, leading)
    # No roots where a value is not finite, or all are 0; eigvals would raise.
    known = np.all(np.isfinite(below), axis=-1, keepdims=True)
    companion = np.zeros((*values.shape[:-1], 4, 4))
    companion[..., range(1, 4), range(3)] = 1.0
    companion[..., 3] = np.where(known, below, 0.0)
    found = np.linalg.eigvals(companion)
    real = known & (abs(found.imag) <= _REAL * abs(found))
    return [step * np.where(real[..., i], found[..., i].real, np.nan) for i in range(4)]

"""Outlines in motion: how far apart two are, when they first touch, and where they overlap.

All work on many cases at once: corners are (2, corners, cases), axes (2, cases) or (2, axes,
cases). Axes point from the first outline to the second.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

# Outlines this near [m] touch.
TOUCHING = 1e-9
# Axes whose gap is within this [m] of the greatest are candidates for the face struck.
_ALIKE = 1e-6
_MOST_STEPS = 3000
# No step is longer [s] where velocities change: bounds of the yaw rate hold for as long.
_LONGEST_STEP = 0.2
_SHORTEST_STEP = 1e-12
# Whether a pair has parted is looked at no more often [s].
_SHORTEST_LOOK = 1e-2
_SECTIONS = 48
_GOLDEN = 0.6180339887498949
# The depth of an overlap is looked at this often [s], or in so many parts of a delay.
_SEARCH, _PARTS = 2.5e-3, 12
# From a second after first touch on, looks for a depth are apart by this share of the time since
# then; of a pair that has not parted, stopped or come to it after so long [s] it is not known.
_SEARCH_SHARE, LONGEST_SEARCH = 2.5e-3, 1e3
# So many looks at all cases, which are then over for nearly all.
_TOGETHER = 400


class Shape(NamedTuple):
    """An outline: corners (2, corners) counter-clockwise and the outward normals of its edges, on
    the vehicle.
    """

    corners: Any
    normals: Any
    reach: float

    @classmethod
    def of(cls, outline: Any) -> Shape:
        """From corners in rows."""
        corners = np.asarray(outline, float).T
        edges = np.roll(corners, -1, axis=1) - corners
        keep = np.hypot(*edges) > 0.0
        edges = edges[:, keep]
        normals = np.array([edges[1], -edges[0]]) / np.hypot(*edges)
        return cls(corners, normals, float(np.max(np.hypot(*corners))))

    def placed(self, state: Any) -> Any:
        """Corners in the scene."""
        return _turned(self.corners, state[2]) + state[:2, None]

    def faces(self, state: Any) -> Any:
        """Outward normals in the scene."""
        return _turned(self.normals, state[2])


def _turned(vectors: Any, heading: Any) -> Any:
    c, s = np.cos(heading), np.sin(heading)
    x, y = vectors[0][:, None], vectors[1][:, None]
    return np.array([c * x - s * y, s * x + c * y])


class Meeting(NamedTuple):
    """Two outlines at one time: corners, all axes, and the gap along each (negative: overlap)."""

    one: Any
    other: Any
    axes: Any
    gaps: Any

    @property
    def gap(self) -> Any:
        """The greatest gap along an axis: below 0 where the outlines overlap."""
        return self.gaps.max(axis=0)

    @property
    def widest(self) -> Any:
        """Which axis has the greatest gap."""
        return self.gaps.argmax(axis=0)

    def axis(self, which: Any) -> Any:
        """One of the axes for each case."""
        return self.axes[:, which, np.arange(self.axes.shape[2])]


def meeting(a: Shape, b: Shape, state_a: Any, state_b: Any) -> Meeting:
    """Both outlines in these states."""
    # From the first centre of mass, so that a distant origin rounds nothing.
    away = state_b[:2] - state_a[:2]
    one = _turned(a.corners, state_a[2])
    other = _turned(b.corners, state_b[2]) + away[:, None]
    axes = np.concatenate([a.faces(state_a), -b.faces(state_b)], axis=1)
    ends = _along(axes, one).max(axis=1)
    starts = _along(axes, other).min(axis=1)
    return Meeting(one, other, axes, starts - ends)


def _along(axes: Any, corners: Any) -> Any:
    """Corners along axes, of (axes, corners, cases)."""
    return axes[0][:, None] * corners[0][None] + axes[1][:, None] * corners[1][None]


def _on_axis(axis: Any, vectors: Any) -> Any:
    """Vectors, or the corners of each case, along one axis of each case."""
    return axis[0] * vectors[0] + axis[1] * vectors[1]


class Pair(NamedTuple):
    """Two outlines and how both move: ``states(times, cases)`` of each, the bounds of their
    accelerations, and ``speeds(cases, state, state)``, the bound of how fast any two points of them
    come together from then on.
    """

    a: Shape
    b: Shape
    states: Callable[[Any, Any], tuple[Any, Any]]
    bounds: Callable[[Any], Any]
    speeds: Callable[[Any, Any, Any], Any]

    def at(self, time: Any, cases: Any) -> tuple[Meeting, Any, Any]:
        """The outlines, and both states, at a time of each case."""
        state_a, state_b = self.states(time, cases)
        return meeting(self.a, self.b, state_a, state_b), state_a, state_b


def _steps(clearance: Any, rate: Any, bend: Any) -> Any:
    """The time in which a clearance is used up at most, from its rate and a bound of its
    acceleration.
    """
    with np.errstate(all="ignore"):
        straight = np.where(rate > 0.0, clearance / np.where(rate > 0.0, rate, 1.0), np.inf)
        root = np.sqrt(rate * rate + 2.0 * bend * clearance)
        bent = 2.0 * clearance / (rate + root)
        return np.where(bend > 0.0, np.where(rate + root > 0.0, bent, np.inf), straight)


def _bending(pair: Pair, bounds: Any, state_a: Any, state_b: Any) -> Any:
    """A bound of the relative acceleration of any two corners, over the next step."""
    push_a, spin_a, push_b, spin_b = bounds
    turn_a = np.abs(state_a[5]) + _LONGEST_STEP * spin_a
    turn_b = np.abs(state_b[5]) + _LONGEST_STEP * spin_b
    return (
        push_a + push_b
        + pair.a.reach * (spin_a + turn_a * turn_a)
        + pair.b.reach * (spin_b + turn_b * turn_b)
    )  # fmt: skip


def _rates(corners: Any, state: Any, centre: Any) -> Any:
    """Velocities of corners in the scene."""
    arm = corners - centre[:, None]
    return np.array([state[3] - state[5] * arm[1], state[4] + state[5] * arm[0]])


def _corner_rates(met: Meeting, axis: Any, state_a: Any, state_b: Any) -> tuple[Any, Any]:
    """Gaps between every two corners along an axis of each case, and how fast they close."""
    none = np.zeros((2, axis.shape[1]))
    away = state_b[:2] - state_a[:2]
    p, q = _on_axis(axis, met.one), _on_axis(axis, met.other)
    u, v = _rates(met.one, state_a, none), _rates(met.other, state_b, away)
    pu, qv = _on_axis(axis, u), _on_axis(axis, v)
    return q[None] - p[:, None], pu[:, None] - qv[None]


def closing_of(met: Meeting, axis: Any, state_a: Any, state_b: Any) -> Any:
    """How fast the gap along an axis closes where the outlines are nearest along it; of a face
    against a face the greatest over the stretch in which they overlap.

    The axis turns with its face, so that both outlines are taken as they move at one place: where a
    corner is, and not at the ends of the face that it comes to.
    """
    across = np.array([-axis[1], axis[0]])
    p, q = _on_axis(axis, met.one), _on_axis(axis, met.other)
    # Without a number all count, and the answer has none either.
    near_one = ~(p < p.max(axis=0) - _ALIKE)
    near_other = ~(q > q.min(axis=0) + _ALIKE)
    ends = [
        (np.where(near, at, np.inf).min(axis=0), np.where(near, at, -np.inf).max(axis=0))
        for near, at in (
            (near_one, _on_axis(across, met.one)),
            (near_other, _on_axis(across, met.other)),
        )
    ]
    (low_one, high_one), (low_other, high_other) = ends
    # Those that are past each other sidewise are nearest between both ends.
    stretch = np.array([np.maximum(low_one, low_other), np.minimum(high_one, high_other)])
    away, going = state_b[:2] - state_a[:2], state_a[3:5] - state_b[3:5]
    turn = state_b[5] * (stretch - _on_axis(across, away)) - state_a[5] * stretch
    return (_on_axis(axis, going) + turn).max(axis=0)


class Touch(NamedTuple):
    """When outlines first touch [s] (infinite: never), how fast they close there [m/s], the nearest
    that they were [m], and when; and until when they were followed [s] where they still came
    nearer as the search came to its end, NaN elsewhere.
    """

    time: Any
    closing: Any
    nearest: Any
    nearest_at: Any
    given_up: Any


def first_touch(pair: Pair, begin: Any, until: Any, cases: Any) -> Touch:
    """The first touch of some cases after a time at which they are apart, by conservative
    advancement.

    Each step goes as far as no corner can pass the axis between both, by its velocity and a bound
    of its acceleration. So no touch is missed, however short.
    """
    total = len(cases)
    time = np.array(begin, dtype=float)
    found = Touch(
        np.full(total, np.inf), np.zeros(total), np.full(total, np.inf), np.array(begin, float),
        np.full(total, np.nan),
    )  # fmt: skip
    going = np.flatnonzero(time <= until)
    for _ in range(_MOST_STEPS):
        if not len(going):
            break
        now, mine = time[going], cases[going]
        met, state_a, state_b = pair.at(now, mine)
        gap = met.gap
        axis = met.axis(met.widest)
        nearer = gap < found.nearest[going]
        found.nearest[going[nearer]] = gap[nearer]
        found.nearest_at[going[nearer]] = now[nearer]
        touch = gap <= TOUCHING
        if touch.any():
            at = going[touch]
            found.time[at] = now[touch]
            closing = closing_of(met, axis, state_a, state_b)
            found.closing[at] = closing[touch]
        gaps, rates = _corner_rates(met, axis, state_a, state_b)
        bend = _bending(pair, pair.bounds(mine), state_a, state_b)
        step = _steps(gaps, rates, bend).min(axis=(0, 1))
        step = np.where(bend > 0.0, np.minimum(step, _LONGEST_STEP), step)
        # No energy comes to vehicles that the ground slows.
        with np.errstate(all="ignore"):
            step = np.fmax(step, gap / pair.speeds(mine, state_a, state_b))
        # Without a number there is no motion to follow, and those that rest stay where they are.
        moves = np.any(state_a[3:] != 0.0, axis=0) | np.any(state_b[3:] != 0.0, axis=0)
        on = ~touch & (now + step <= until[going]) & np.isfinite(gap) & moves
        time[going] = now + np.maximum(step, _SHORTEST_STEP)
        going = going[on]
    if len(going):
        met, state_a, state_b = pair.at(time[going], cases[going])
        _, rates = _corner_rates(met, met.axis(met.widest), state_a, state_b)
        # Those that only move apart by then are left alone.
        nearer = going[rates.max(axis=(0, 1)) > 0.0]
        found.given_up[nearer] = time[nearer]
    return found


def first_apart(pair: Pair, begin: Any, until: Any, cases: Any, gap: float) -> Any:
    """When some cases are first this far apart [s]; infinite where they are not by then."""
    time = np.array(begin, dtype=float)
    found = np.full(len(cases), np.inf)
    going = np.arange(len(cases))
    for _ in range(_MOST_STEPS):
        if not len(going):
            break
        now, mine = time[going], cases[going]
        met, state_a, state_b = pair.at(now, mine)
        apart = met.gap >= gap
        found[going[apart]] = now[apart]
        bend = _bending(pair, pair.bounds(mine), state_a, state_b)
        away = np.hypot(*(state_b[3:5] - state_a[3:5]))
        away += pair.a.reach * np.abs(state_a[5]) + pair.b.reach * np.abs(state_b[5])
        step = _steps(np.maximum(gap - met.gap, 0.0), away, bend)
        step = np.where(bend > 0.0, np.minimum(step, _LONGEST_STEP), step)
        time[going] = now + np.maximum(step, _SHORTEST_LOOK)
        moves = np.any(state_a[3:] != 0.0, axis=0) | np.any(state_b[3:] != 0.0, axis=0)
        going = going[~apart & (now < until[going]) & np.isfinite(met.gap) & moves]
    return found


def struck_face(pair: Pair, touch: Any, later: Any, cases: Any) -> Any:
    """Which axis is that of the face struck at first touch: where several touch, the one whose
    overlap stays least.
    """
    met, *_ = pair.at(touch, cases)
    alike = met.gaps >= met.gap - _ALIKE
    then, *_ = pair.at(later, cases)
    return np.where(alike, then.gaps, -np.inf).argmax(axis=0)


def engaged(
    pair: Pair,
    axis_of: Callable[[Meeting, Any], Any],
    touch: Any,
    cases: Any,
    delay: Any,
    depth: Any,
) -> tuple[Any, Any, Any]:
    """When the impulse acts [s], whether the pair was at its deepest before, and whether neither is
    known.

    ``axis_of`` gives the axis of some of these cases, by their place. The impulse acts ``delay``
    after first touch, or at the ``depth`` along that axis, of which one is None; of a pair that
    parts before, at its deepest. One that neither reaches the depth nor parts nor stands within
    ``LONGEST_SEARCH`` is not known, and NaN.
    """

    def deep(time: Any, some: Any = slice(None)) -> tuple[Any, Any, Any]:
        """The depth along the axis, the least along any, which is below 0 where they are apart, and
        whether both stand.
        """
        met, state_a, state_b = pair.at(time, cases[some])
        axis = axis_of(met, some)
        p, q = _on_axis(axis, met.one), _on_axis(axis, met.other)
        stand = ~np.any((state_a[3:] != 0.0) | (state_b[3:] != 0.0), axis=0)
        return p.max(axis=0) - q.min(axis=0), -met.gap, stand

    count = len(cases)
    unknown = np.zeros(count, dtype=bool)
    if delay is None:
        time, width, reached, parted = _searched(deep, touch, depth)
        unknown = ~(reached | parted)
    else:
        width, reached = delay / _PARTS, np.zeros(count, dtype=bool)
        # All looks at once.
        times = np.add.accumulate([touch, *[np.broadcast_to(width, count)] * _PARTS])[1:]
        met, *_ = pair.at(times.ravel(), np.tile(cases, _PARTS))
        apart = met.gap.reshape(times.shape) > 0.0
        parted = apart.any(axis=0)
        time = times[np.where(parted, apart.argmax(axis=0), -1), np.arange(count)]
    due = time if delay is None else touch + delay
    if reached.any():
        left, right = np.maximum(time - width, touch), time
        for _ in range(_SECTIONS):
            middle = 0.5 * (left + right)
            beyond = deep(middle)[0] >= depth
            left, right = np.where(beyond, left, middle), np.where(beyond, middle, right)
        due = np.where(reached, right, due)
    if parted.any():
        left, right = np.array(touch, dtype=float), time
        for _ in range(_SECTIONS):
            part = _GOLDEN * (right - left)
            one, two = right - part, left + part
            more = deep(one)[1] > deep(two)[1]
            left, right = np.where(more, left, one), np.where(more, two, right)
        due = np.where(parted, 0.5 * (left + right), due)
    return np.where(unknown, np.nan, due), parted, unknown


def _searched(
    deep: Callable[..., tuple[Any, Any, Any]], touch: Any, depth: Any
) -> tuple[Any, Any, Any, Any]:
    """The look at which a depth is reached, or the pair parts or stands before; the time since the
    look before it; and which of both it is: neither where the search came to its end.
    """
    count = len(touch)
    time, before = np.array(touch, dtype=float), np.zeros(count)
    reached, parted = np.zeros(count, dtype=bool), np.zeros(count, dtype=bool)
    width = np.full(count, _SEARCH)
    depth = np.broadcast_to(depth, count)
    some, looks = np.arange(count), 0
    while len(some):
        looks += 1
        # Those that are through stand still meanwhile.
        going = ~(reached | parted)[some]
        wide = np.maximum(_SEARCH, _SEARCH_SHARE * (time - touch)[some])
        width[some[going]] = wide[going]
        time[some[going]] += wide[going]
        now, least, stand = deep(time[some], some)
        hit = going & (least >= 0.0) & (now >= depth[some])
        ends = going & ~hit & ((least < 0.0) | (now < before[some]) | stand)
        reached[some[hit]], parted[some[ends]] = True, True
        before[some[going]] = now[going]
        on = ~(reached | parted) & (time - touch <= LONGEST_SEARCH)
        if looks >= _TOGETHER or not on.any():
            some = np.flatnonzero(on)
    return time, width, reached, parted


def overlap_of(one: Any, other: Any) -> tuple[Any, Any, Any]:
    """Centroid (2, cases) of the overlap of convex outlines, its area, and their crossings.

    Crossings are (2, edges, edges, cases), NaN where two edges do not cross. Where nothing
    overlaps the centroid is that of the corners and crossings that touch, or NaN.
    """
    inside_one = _inside(one, other)
    inside_other = _inside(other, one)
    crossings = _crossings(one, other)
    cases = one.shape[2]
    points = np.concatenate([one, other, crossings.reshape(2, -1, cases)], axis=1)
    valid = np.concatenate([inside_one, inside_other, np.isfinite(crossings[0]).reshape(-1, cases)])
    count = valid.sum(axis=0)
    with np.errstate(all="ignore"):
        mean = np.where(valid, points, 0.0).sum(axis=1) / np.where(count > 0, count, 1)
        mean = np.where(count > 0, mean, np.nan)
        x, y = np.where(valid, points - mean[:, None], 0.0)
        angle = np.where(valid, np.arctan2(y, x), np.inf)
        order = np.argsort(angle, axis=0, kind="stable")
        x, y = np.take_along_axis(x, order, axis=0), np.take_along_axis(y, order, axis=0)
        place = np.arange(len(x))[:, None]
        # Those that are none repeat the first, which adds no area.
        x, y = np.where(place < count, x, x[:1]), np.where(place < count, y, y[:1])
        nx, ny = np.roll(x, -1, axis=0), np.roll(y, -1, axis=0)
        twice = x * ny - nx * y
        area = 0.5 * twice.sum(axis=0)
        share = np.where(area > 0.0, 6.0 * area, 1.0)
        centre = np.array([((x + nx) * twice).sum(axis=0), ((y + ny) * twice).sum(axis=0)]) / share
        size = np.hypot(x, y).max(axis=0)
        thin = area <= 1e-14 * np.maximum(size * size, 1e-30)
    return mean + np.where(thin, 0.0, centre), area, crossings


def distance_outside(point: Any, outline: Any) -> Any:
    """How far a point (2, cases) lies outside of a convex outline; 0 within it."""
    edges = np.roll(outline, -1, axis=1) - outline
    away = point[:, None] - outline
    square = (edges * edges).sum(axis=0)
    share = (away * edges).sum(axis=0) / np.where(square > 0.0, square, 1.0)
    off = np.hypot(*(away - np.clip(share, 0.0, 1.0) * edges)).min(axis=0)
    return np.where(_inside(point[:, None], outline)[0], 0.0, off)


def _inside(points: Any, outline: Any) -> Any:
    """Which points lie in a convex outline, its edge included."""
    edges = np.roll(outline, -1, axis=1) - outline
    away = points[:, :, None] - outline[:, None]
    side = edges[0] * away[1] - edges[1] * away[0]
    return (side >= -1e-12).all(axis=1)


def _crossings(one: Any, other: Any) -> Any:
    """Where edges of the one cross edges of the other."""
    p, r = one[:, :, None], (np.roll(one, -1, axis=1) - one)[:, :, None]
    q, s = other[:, None], (np.roll(other, -1, axis=1) - other)[:, None]
    cross = r[0] * s[1] - r[1] * s[0]
    with np.errstate(all="ignore"):
        ahead = ((q[0] - p[0]) * s[1] - (q[1] - p[1]) * s[0]) / cross
        along = ((q[0] - p[0]) * r[1] - (q[1] - p[1]) * r[0]) / cross
        hits = (ahead >= 0.0) & (ahead <= 1.0) & (along >= 0.0) & (along <= 1.0)
        hits &= np.abs(cross) > 0.0
        return np.where(hits, p + ahead * r, np.nan)

"""Profiles: how chi-squared rises when one unknown is held at other values and the rest is fitted
again. Where a model bends or a bound is near they give the range that slopes do not.

The range of probability p holds the values at which chi-squared rises by less than the square of
the normal score of p (D. J. Venzon and S. H. Moolgavkar, "A method for computing
profile-likelihood-based confidence intervals", Applied Statistics 37 (1988) 87).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from ..uncertainty.normal import score_of_coverage
from .least_squares import Ends, Problem, minimise, spread

_AT_95 = 8
LEVELS = score_of_coverage(0.95) / _AT_95 * np.arange(13)  # sigma
_OFTEN_ASKED = tuple(score_of_coverage(share) for share in (0.5, 0.8, 0.9, 0.99))  # besides
SAME_CHI_SQUARED = 1e-3  # misfits within this are the same
_RISE = 0.98  # sigma, aimed at from one value to the next: two lead to 95 percent
_MOST_RISE, _LONGER, _SHORTEST = 1.5, 4.0, 1e-3  # of steps, the last a part of the first
_MOST_STEPS = 24
_CLOSE, _ROUNDS = 1e-2, 40  # of the fits again: chi-squared to 1e-4
_LAST_ROUNDS = 10  # from a place that is near already, or along a kink without an end
_FIRST = 0.125  # of its scale, for an unknown without a standard error
_REACHED = 1.8  # sigma, where 95 percent counts as reached
_FINE = 0.3  # sigma, aimed at from one value to the next on the way back in another valley
_MOST_VALLEYS = 4  # one beyond the other
# Places beside a fit to start from: as far away as the misfit lets [sigma], and over whole spans.
_ELSEWHERE, _FAR_OFF, _AWAY = 8, 8, 3.0
# of each: how many; and rounds until the best is chosen
_TRIED, _TRIED_FAR_OFF, _FIRST_ROUNDS = 4, 4, 3
_DEPARTS = 0.1  # sigma: places where the model is nearer to its slopes need no search
_ALIKE = 0.02  # of the way, and sigma: ends this near each other need no fit in between
_CLOSELY_ALIKE = 0.005  # the same for what else is often asked: none of it was aimed at
_MOST_REFINED = 3  # fits in between
_STRAIGHT, _MOST_HALVED = 2e-4, 7  # of a side: rows bend by less; and how often they are halved
_PUT_RIGHT, _MOST_PUT_RIGHT = 0.01, 8  # of the way: an end that moves less is right; and fits
_LOWER = 0.05  # of chi-squared: what is lower by less is the same valley


class Place(NamedTuple):
    """A value of a side, between others: before which of them it is, and all unknowns that these
    put there.
    """

    number: int
    value: float
    point: Any


class Side(NamedTuple):
    """Values on one side of the answer, outward, the rise of the misfit at each in sigma, and the
    slope of chi-squared there, NaN where borrowed slopes do not tell; beyond the last the model
    refuses if it is ``at_edge``. ``valleys`` are others in which the misfit is lower from some
    value on. ``points`` are all unknowns at each value.
    """

    values: Any
    rises: Any
    slopes: Any
    points: Any
    bound: float
    at_edge: bool
    valleys: tuple[Side, ...] = ()

    def reach(self, level: float) -> float:
        """The furthest value with no more than this rise; NaN if there is none."""
        ends = [one.end(level) for one in (self, *self.valleys)]
        outward = max if self.bound > self.values[0] else min
        return float(outward((x for x in ends if not math.isnan(x)), default=math.nan))

    def end(self, level: float) -> float:
        """The furthest value with no more than this rise in this valley."""
        inside = np.flatnonzero(self.rises <= level)
        if not inside.size:
            return math.nan
        k = int(inside[-1])
        values, rises = self.values, self.rises
        if k < len(values) - 1:
            return self._between(k, level)
        if self.at_edge or values[k] == self.bound:
            return float(values[k])
        slope = (values[k] - values[k - 1]) / (rises[k] - rises[k - 1]) if k else math.inf
        if rises[k] < LEVELS[-1] - _RISE or not math.isfinite(slope):
            return self.bound  # it goes on without a rise
        end = float(values[k] + slope * (level - rises[k]))
        return min(end, self.bound) if self.bound > self.values[0] else max(end, self.bound)

    def rise_at(self, value: float) -> float:
        """The rise at a value, by straight lines from place to place."""
        way = math.copysign(1.0, self.bound - self.values[0])
        return float(np.interp(way * value, way * self.values, self.rises))

    def in_doubt(self, level: float, alike: float) -> Place | None:
        """The place of the furthest value with this rise, if it is between others and a straight
        line in the rise leads elsewhere, by more than is ``alike``.
        """
        inside = np.flatnonzero(self.rises <= level)
        k = int(inside[-1]) if inside.size else len(self.values)
        if k >= len(self.values) - 1:
            return None
        end, (low, high) = self._between(k, level), self.values[k : k + 2]
        straight = low + (high - low) * (level - self.rises[k]) / (
            self.rises[k + 1] - self.rises[k]
        )
        same = abs(end - straight) <= alike * abs(end - self.values[0])
        near = min(abs(self.rises[k : k + 2] - level)) <= alike
        # Values so near to each other that rounding leaves none between them tell no more.
        between = min(low, high) < end < max(low, high)
        return self.place(end) if between and not (same or near) else None

    def place(self, value: float) -> Place:
        """The place of a value, with all unknowns as straight lines put them."""
        way = math.copysign(1.0, self.bound - self.values[0])
        outward = way * self.values
        n = int(np.searchsorted(outward, way * value))
        point = np.array([np.interp(way * value, outward, one) for one in self.points.T])
        return Place(n, value, point)

    def with_place(self, place: Place, rise: float, slope: float, point: Any) -> Side:
        """With what was found at a place, instead of what was there, if anything."""
        n = place.number
        rest = n + int(n < len(self.values) and self.values[n] == place.value)

        def put(of: Any, new: Any) -> Any:
            return np.concatenate([of[:n], [new], of[rest:]])

        return self._replace(
            values=put(self.values, place.value),
            rises=put(self.rises, rise),
            slopes=put(self.slopes, slope),
            points=put(self.points, point),
        )

    def _between(self, k: int, level: float) -> float:
        """Where chi-squared reaches the level after value k, by the cubic of both ends and slopes,
        where one is not known that of a straight line in the rise; bisected, since that need not
        be monotonic.
        """
        start, width = self.values[k], self.values[k + 1] - self.values[k]
        rises, slopes = self.rises[k : k + 2], self.slopes[k : k + 2] * width
        straight = 2.0 * rises * (rises[1] - rises[0])
        (below, above), (left, right) = rises**2, np.where(np.isnan(slopes), straight, slopes)
        low, high = 0.0, 1.0
        for _ in range(40):
            t = 0.5 * (low + high)
            there = (
                below * (1.0 + 2.0 * t) * (1.0 - t) ** 2
                + left * t * (1.0 - t) ** 2
                + above * t * t * (3.0 - 2.0 * t)
                - right * t * t * (1.0 - t)
            )
            low, high = (t, high) if there <= level * level else (low, t)
        return float(start + low * width)


class Found(NamedTuple):
    """Both sides of each unknown that was followed, by its place; the same with what was fitted for
    ranges of other probabilities than 95 percent; and the least misfit met on the way.
    """

    sides: dict[int, tuple[Side, Side]]
    closer: dict[int, tuple[Side, Side]]
    lowest: float
    at: Any

    @property
    def refused(self) -> bool:
        """Whether the model refuses within the range of 95 percent."""
        return any(
            side.at_edge and side.rises[-1] < 2.0 for both in self.sides.values() for side in both
        )


class _Begin(NamedTuple):
    """Where a track begins: the unknown that is held, which way it goes and how far at most, what
    is known there, the first step and how the others go with it, and the rise to aim at from one
    value to the next.
    """

    unknown: int
    outward: float
    bound: float
    point: Any
    rise: float
    climb: float
    step: float
    way: Any
    aim: float


class _Track(NamedTuple):
    """Values, rises and slopes of chi-squared along a track (3, k), and the points; whether the
    model refuses beyond the last, and the fit that first reached 95 percent, if any.
    """

    along: Any
    points: Any
    at_edge: bool
    reached: Ends | None

    def side(self, bound: float) -> Side:
        """These values as a side that ends at this bound."""
        values, rises, slopes = self.along
        return Side(values, rises, slopes, self.points, float(bound), self.at_edge)


def followed(
    problem: Problem, point: Any, chi_squared: float, covariance: Any, which: Iterable[int]
) -> Found:
    """The profiles of these unknowns from a point, by the rise above ``chi_squared``, which is that
    of the best answer. The covariance says where to look first.

    A fit that goes on from the value before stays on its side of a kink. So where a track reaches
    95 percent the other unknowns are fitted from elsewhere as well, and a lower misfit met there is
    followed both ways. With a scout its slopes lead the way, and those of the model itself put the
    ends right.
    """
    start = minimise(problem, point[np.newaxis])
    quick = problem.borrowing(start.points[0], start.slopes[0])
    pieces, least = _pieces(quick, start, point, chi_squared, covariance, which)
    if quick is not problem:
        _put_right(problem, chi_squared, pieces)
    sides = _joined(pieces)
    alike = _CLOSELY_ALIKE if quick is problem else _ALIKE  # calls of a finer model are dear
    _refine(problem, chi_squared, _by_side(pieces), _OFTEN_ASKED, alike)
    return Found(sides, _joined(pieces), *least)


_Pieces: TypeAlias = dict[int, tuple[list[Side], list[Side]]]


def _joined(pieces: _Pieces) -> dict[int, tuple[Side, Side]]:
    """Each side of its pieces: that of the answer, and those of other valleys."""
    low, high = (
        {j: both[way][0]._replace(valleys=tuple(both[way][1:])) for j, both in pieces.items()}
        for way in (0, 1)
    )
    return {j: (low[j], high[j]) for j in pieces}


def _by_side(pieces: _Pieces) -> list[tuple[int, list[Side]]]:
    """The pieces of each side, with the unknown that is held."""
    return [(j, side) for j, both in pieces.items() for side in both]


def _put_right(problem: Problem, chi_squared: float, pieces: _Pieces) -> None:
    """Fit at the end of 95 percent of each piece by slopes of the model itself, until that moves
    it no more.
    """
    asked = [(j, side, i, math.nan) for j, side in _by_side(pieces) for i in range(len(side))]
    for _ in range(_MOST_PUT_RIGHT):
        moved = []
        for j, side, i, was in asked:
            end = side[i].end(LEVELS[_AT_95])
            way = abs(end - side[i].values[0])
            if not (math.isnan(end) or abs(end - was) <= _PUT_RIGHT * way):
                moved.append((j, side, i, end))
        asked = moved
        if not asked:
            break
        places = [side[i].place(end) for _, side, i, end in asked]
        starts, held = np.stack([one.point for one in places]), np.array([j for j, *_ in asked])
        starts[np.arange(len(held)), held] = [one.value for one in places]
        kept = np.arange(starts.shape[1]) == held[:, np.newaxis]
        found = minimise(problem, starts, held=kept, close=_CLOSE, rounds=_LAST_ROUNDS)
        climbs = _climbs(problem, found, held)
        for row, ((_, side, i, _), place) in enumerate(zip(asked, places, strict=True)):
            rise = math.sqrt(max(0.0, found.chi_squared[row] - chi_squared))
            if math.isfinite(rise):
                side[i] = side[i].with_place(place, rise, climbs[row], found.points[row])


def _pieces(
    problem: Problem,
    start: Ends,
    point: Any,
    chi_squared: float,
    covariance: Any,
    which: Iterable[int],
) -> tuple[_Pieces, tuple[float, Any]]:
    """For both sides of each of these unknowns the piece of the answer and those of other valleys;
    and the least misfit met on the way, with its place.
    """
    errors = np.sqrt(np.diagonal(covariance))
    wide = np.minimum(problem.high - problem.low, problem.scale)
    first = np.where(np.isfinite(errors), np.minimum(_RISE * errors, wide), _FIRST * wide)
    ways = np.where(np.isfinite(errors), covariance / errors**2, 0.0).T
    ways = np.where(np.isfinite(ways), ways, 0.0)

    begin = math.sqrt(max(0.0, start.chi_squared[0] - chi_squared))
    # To either side by itself: the answer may be at a kink.
    _, changes, moves = problem.neighbours(point[np.newaxis])
    toward = np.where(moves == 0.0, 0.0, changes / moves)[:, 0] @ problem.misfit(start.outputs[0])
    begins = [
        _Begin(j, way, bound, point, begin, 2.0 * slope, first[j], ways[j], _RISE)
        for j in which
        for way, bound, slope in (
            (-1.0, problem.low[j], toward[1, j]),
            (1.0, problem.high[j], toward[0, j]),
        )
    ]
    tracks, least = _follow(problem, chi_squared, begins)
    pieces = [[track.side(one.bound)] for one, track in zip(begins, tracks, strict=True)]
    asked = {k: track.reached for k, track in enumerate(tracks) if track.reached}
    for _ in range(_MOST_VALLEYS):
        if not asked:
            break
        places = Ends(*map(np.concatenate, zip(*asked.values(), strict=True)))
        held = np.array([begins[k].unknown for k in asked])
        lower = beside(problem, places, held)
        rises = np.sqrt(np.maximum(0.0, lower.chi_squared - chi_squared))
        climbs = _climbs(problem, lower, held)
        left = lower.chi_squared < places.chi_squared - _LOWER
        owners, turned = [], []
        for i, k in enumerate(asked):
            if left[i]:
                step = first[begins[k].unknown]
                out = begins[k]._replace(
                    point=lower.points[i], rise=rises[i], climb=climbs[i], way=0.0 * point
                )
                back = out._replace(
                    outward=-out.outward, bound=point[out.unknown], step=_FINE * step, aim=_FINE
                )
                owners.append(k)
                turned += [out, back]
        until = [side for k in owners for side in (None, pieces[k][0])]
        tracks, met = _follow(problem, chi_squared, turned, until)
        least = min(least, met, key=lambda one: one[0])
        for k, away, inward in zip(owners, tracks[::2], tracks[1::2], strict=True):
            along = np.concatenate([inward.along[:, :0:-1], away.along], axis=1)
            points = np.concatenate([inward.points[:0:-1], away.points])
            valley = away._replace(along=along, points=points)
            pieces[k].append(valley.side(begins[k].bound))
        asked = {
            k: track.reached for k, track in zip(owners, tracks[::2], strict=True) if track.reached
        }
    both = {begins[k].unknown: (pieces[k], pieces[k + 1]) for k in range(0, len(begins), 2)}
    _refine(problem, chi_squared, _by_side(both), (LEVELS[_AT_95],), _ALIKE)
    return both, least


def _refine(
    problem: Problem,
    chi_squared: float,
    sides: list[tuple[int, list[Side]]],
    levels: Sequence[float],
    alike: float,
) -> None:
    """Fits where the pieces of each side, with the unknown that is held, put the ends of these
    rises, where that is in doubt.
    """
    for _ in range(_MOST_REFINED):
        asked = [
            (j, side, i, place)
            for j, side in sides
            for i, piece in enumerate(side)
            for level in levels
            if (place := piece.in_doubt(level, alike))
        ]
        if not asked:
            break
        # From both sides, since there may be a kink in between.
        starts = np.concatenate(
            [side[i].points[at.number - 1 : at.number + 1] for _, side, i, at in asked]
        )
        held = np.repeat([j for j, *_ in asked], 2)
        starts[np.arange(len(held)), held] = np.repeat([at.value for *_, at in asked], 2)
        kept = np.arange(starts.shape[1]) == held[:, np.newaxis]
        ends = minimise(problem, starts, held=kept, close=_CLOSE, rounds=_LAST_ROUNDS)
        climbs = _climbs(problem, ends, held)
        for row, (_, side, i, at) in zip(range(0, len(held), 2), asked, strict=True):
            row += int(np.argmin(ends.chi_squared[row : row + 2]))
            rise = math.sqrt(max(0.0, ends.chi_squared[row] - chi_squared))
            if math.isfinite(rise):
                # Another end may have been put before it.
                place = side[i].place(at.value)
                side[i] = side[i].with_place(place, rise, climbs[row], ends.points[row])


def _follow(
    problem: Problem, chi_squared: float, begins: list[_Begin], until: Sequence[Side | None] = ()
) -> tuple[list[_Track], tuple[float, Any]]:
    """The tracks from these beginnings, and the least misfit met and where.

    A track inward, from another valley, goes ``until`` it is no lower than this side or no longer
    falls.
    """
    least = (math.inf, np.zeros(0))
    if not begins:
        return [], least
    unknowns, outward, bound, at, rise, climbs, step, ways, aim = map(
        np.array, zip(*begins, strict=True)
    )
    every = np.arange(len(begins))
    value, shortest = at[every, unknowns], _SHORTEST * step
    tracks = [[(value[k], rise[k], climbs[k])] for k in every]
    visited = [[at[k].copy()] for k in every]
    reached: list[Ends | None] = [None] * len(begins)
    # Of each track the last value to which chi-squared rose by too much at once.
    beyond: list[tuple[tuple[Any, Any, Any], Any] | None] = [None] * len(begins)
    held = np.arange(at.shape[1]) == unknowns[:, np.newaxis]
    edge, live, inward = np.zeros(len(begins), dtype=bool), value != bound, aim < _RISE
    for _ in range(_MOST_STEPS):
        rows = every[live]
        if not rows.size:
            break
        new = value[rows] + outward[rows] * step[rows]
        new = np.where(outward[rows] * (new - bound[rows]) >= 0.0, bound[rows], new)
        guess = at[rows] + ways[rows] * (new - value[rows])[:, np.newaxis]
        guess = np.clip(guess, problem.low, problem.high)
        guess[np.arange(rows.size), unknowns[rows]] = new
        ends = minimise(problem, guess, held=held[rows], close=_CLOSE, rounds=_ROUNDS)
        k = int(np.argmin(ends.chi_squared))
        if ends.chi_squared[k] < least[0]:
            least = (float(ends.chi_squared[k]), ends.points[k])
        found = np.sqrt(np.maximum(0.0, ends.chi_squared - chi_squared))
        climbed, climbs = found - rise[rows], _climbs(problem, ends, unknowns[rows])
        short = step[rows] <= shortest[rows]
        refused = np.isinf(found)
        good = ~refused & ((climbed <= _MOST_RISE) | short)
        edge[rows[refused & short]] = True
        live[rows[refused & short]] = False
        step[rows[~good]] *= np.where(refused[~good], 0.5, _RISE / climbed[~good]).clip(0.1, 0.6)
        for j in np.flatnonzero(~good & ~refused).tolist():
            beyond[rows[j]] = ((new[j], found[j], climbs[j]), ends.points[j])
        for j in np.flatnonzero(good).tolist():
            row, moved = rows[j], new[j] - value[rows[j]]
            tracks[row].append((new[j], found[j], climbs[j]))
            visited[row].append(ends.points[j])
            ways[row] = (ends.points[j] - at[row]) / moved
            went = -climbed[j] if inward[row] else climbed[j]
            part = aim[row] / went if went > 0.0 else _LONGER
            step[row] = abs(moved) * min(max(part, 1.0 / _LONGER), _LONGER)
            at[row], value[row], rise[row] = ends.points[j], new[j], found[j]
            live[row] = new[j] != bound[row] and found[j] < LEVELS[-1] - 0.01
            if inward[row]:
                live[row] &= went > 0.0 and found[j] < until[row].rise_at(new[j])
            if found[j] >= _REACHED and not inward[row] and reached[row] is None:
                reached[row] = Ends(*(part[j : j + 1] for part in ends))
    for k in every[live]:
        # One that got no further before a jump ends there.
        if (last := beyond[k]) is not None and outward[k] * (last[0][0] - value[k]) > 0.0:
            tracks[k].append(last[0])
            visited[k].append(last[1])
    return [
        _Track(np.array(tracks[k]).T, np.array(visited[k]), bool(edge[k]), reached[k])
        for k in every
    ], least


def least_at(problem: Problem, points: Any, held: Any) -> Any:
    """The least chi-squared with the unknown ``held`` in each of these points kept, from there and
    from around it.
    """
    kept = np.arange(points.shape[1]) == held[:, np.newaxis]
    here = minimise(problem, points, held=kept, close=_CLOSE, rounds=_LAST_ROUNDS)
    return np.minimum(here.chi_squared, beside(problem, here, held).chi_squared)


def beside(problem: Problem, places: Ends, held: Any) -> Ends:
    """The least misfit at each of these places with the unknown ``held`` there kept, from starts
    around it: an infinite one where the model follows its slopes to all of them.
    """
    count, n = places.points.shape
    found = Ends(*(part.copy() for part in places))
    found.chi_squared[:] = math.inf
    if n == 1:
        return found
    kept = np.arange(n) == held[:, np.newaxis]
    scaled = np.where(kept[:, np.newaxis], 0.0, places.slopes * problem.span)
    _, size, direction = np.linalg.svd(np.where(np.isfinite(scaled), scaled, 0.0))
    # In the directions of the slopes, as far as the misfit rises alike along each, or one span;
    # the last is that of what is kept. Where slopes are steep here, another valley may lie further.
    every = _ELSEWHERE + _FAR_OFF
    far = np.ones((every, count, n))
    far[:_ELSEWHERE, :, : size.shape[1]] = np.minimum(1.0, _AWAY / np.maximum(size, _AWAY))
    around = spread(every, -np.ones(n - 1), np.ones(n - 1))
    moved = np.einsum("si,ski,kij->ksj", around, far[..., :-1], direction[:, :-1]) * problem.span
    moved = np.where(kept[:, np.newaxis], 0.0, moved)
    starts = np.clip(places.points[:, np.newaxis] + moved, problem.low, problem.high)
    moved = starts - places.points[:, np.newaxis]
    outputs = problem.evaluate(starts.reshape(-1, n)).reshape(count, every, -1)
    straight = places.outputs[:, np.newaxis] + np.einsum("kmn,ksn->ksm", places.slopes, moved)
    off = np.linalg.norm(problem.wrapped(outputs - straight), axis=2)
    high = np.sum(problem.misfit(outputs) ** 2, axis=2)
    high = np.where(off > _DEPARTS, high, np.inf)
    chosen = np.concatenate(
        [
            np.argsort(high[:, :_ELSEWHERE], axis=1)[:, :_TRIED],
            np.argsort(high[:, _ELSEWHERE:], axis=1)[:, :_TRIED_FAR_OFF] + _ELSEWHERE,
        ],
        axis=1,
    )
    which, nth = np.nonzero(np.isfinite(np.take_along_axis(high, chosen, axis=1)))
    if not which.size:
        return found
    tried = minimise(
        problem,
        starts[which, chosen[which, nth]],
        held=kept[which],
        close=_CLOSE,
        rounds=_FIRST_ROUNDS,
    )
    lower = []
    for k in np.unique(which).tolist():
        rows = np.flatnonzero(which == k)
        row = rows[np.argmin(tried.chi_squared[rows])]
        if tried.chi_squared[row] < places.chi_squared[k] - _LOWER:
            lower.append((k, row))
    if lower:
        into, rows = np.array(lower).T
        _put(found, into, problem, tried.points[rows], kept[into])
    return found


def _put(found: Ends, into: Any, problem: Problem, starts: Any, kept: Any) -> None:
    """Put where fits from these starts end, with what is kept, into the rows that are higher."""
    ends = minimise(problem, starts, held=kept, close=_CLOSE, rounds=_LAST_ROUNDS)
    lower = ends.chi_squared < found.chi_squared[into]
    for part, of in zip(found, ends, strict=True):
        part[into[lower]] = of[lower]


def _climbs(problem: Problem, ends: Ends, unknowns: Any) -> Any:
    """Slope of chi-squared by the unknown that each row holds: the others add nothing to it where
    it is least in them. NaN with borrowed slopes, which may be far off there.
    """
    if problem.borrowed is not None:
        return np.full(len(unknowns), math.nan)
    gradient = 2.0 * np.einsum("kmn,km->kn", ends.slopes, problem.misfit(ends.outputs))
    return gradient[np.arange(len(unknowns)), unknowns]


def table(
    pairs: list[tuple[Side, Side]], closer: list[tuple[Side, Side]]
) -> list[tuple[float, float, float]]:
    """Rise of the misfit in sigma, and the least and the greatest value with no more, of all these
    profiles of one unknown; the first is that of the best answer. The row of 95 percent is of the
    ``pairs``, others of those that are ``closer``, with more rows where straight lines between
    them lead elsewhere.
    """
    levels = LEVELS.tolist()
    at_95 = _widening([_reached(pairs, level) for level in levels])[_AT_95]
    low, high = np.array(_widening([_reached(closer, level) for level in levels])).T
    inside = np.arange(len(levels)) < _AT_95
    low = np.where(inside, np.maximum(low, at_95[0]), np.minimum(low, at_95[0]))
    high = np.where(inside, np.minimum(high, at_95[1]), np.maximum(high, at_95[1]))
    low[_AT_95], high[_AT_95] = at_95
    rows = list(zip(levels, low.tolist(), high.tolist(), strict=True))
    finite = [one[np.isfinite(one)] for one in (low, high)]
    near = [_STRAIGHT * float(np.ptp(one)) if one.size else 0.0 for one in finite]
    for _ in range(_MOST_HALVED):
        halved = rows[:1]
        for below, above in pairwise(rows):
            level = 0.5 * (below[0] + above[0])
            least, most = _reached(closer, level)
            middle = (
                level,
                min(max(least, above[1]), below[1]),
                max(min(most, above[2]), below[2]),
            )
            bent = any(
                _off_line(middle[side], below[side], above[side]) > near[side - 1]
                for side in (1, 2)
            )
            halved += [middle, above] if bent else [above]
        if len(halved) == len(rows):
            break
        rows = halved
    return rows


def _reached(pairs: list[tuple[Side, Side]], level: float) -> tuple[float, float]:
    """The least and the greatest value of all these profiles with no more than this rise."""
    low, high = (
        [x for pair in pairs if not math.isnan(x := pair[side].reach(level))] for side in (0, 1)
    )
    return min(low, default=math.inf), max(high, default=-math.inf)


def _widening(ends: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Each range with those before it: none shrinks as chi-squared may rise further."""
    low, high = np.array(ends).T
    low, high = np.minimum.accumulate(low), np.maximum.accumulate(high)
    return list(zip(low.tolist(), high.tolist(), strict=True))


def _off_line(middle: float, below: float, above: float) -> float:
    """How far a value is from half-way between two; 0 for infinities that are the same."""
    straight = 0.5 * (below + above)
    return 0.0 if middle == straight else abs(middle - straight)

"""Areas of other friction: what lies under a wheel, and where wheels cross an edge."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ..vehicle.drag import in_plan

# Points along a step, between which the way of a wheel counts as straight.
_CHORDS = 8
# A wheel this near an edge, of the length that the motion has by its speed, is on the side that it
# moves to.
_NEAR = 1e-6
# Wheels are clear of all edges that are this many times as far away as the vehicle still goes.
_CLEAR = 4.0


class Areas(NamedTuple):
    """Polygons, the friction of each in every case, that outside of all, and where the cases start
    and how long they are.

    ``corners`` are polygons of (n, 2) [m]; ``frictions`` has a row for each and a column for each
    case. Places are over ``length`` and from ``origin`` [m]; ``ahead_of`` and ``left_of`` are
    places of the four wheels [m], of (4, cases). Where ``rises`` is given, the slope of (2, cases),
    places are along the ground, and polygons in plan.
    """

    corners: Sequence[Any]
    frictions: Any
    outside: Any
    origin: Any
    length: Any
    ahead_of: Any
    left_of: Any
    rises: Any = None

    def of(self, which: Any) -> Areas:
        """Those of some of the cases."""
        return Areas(
            self.corners, *(None if part is None else part[..., which] for part in self[1:])
        )

    @classmethod
    def joined(cls, parts: Sequence[Areas]) -> Areas:
        """Those of the cases of several, whose polygons are the same."""
        rows = zip(*(part[1:] for part in parts), strict=True)
        return cls(
            parts[0].corners,
            *(None if row[0] is None else np.concatenate(row, axis=-1) for row in rows),
        )

    def friction_at(self, px: Any, py: Any) -> Any:
        """The friction at places in the scene [m], of (wheels, cases): of the first area that holds
        each.
        """
        found = np.broadcast_to(self.outside, px.shape)
        for corners, mu in zip(reversed(self.corners), self.frictions[::-1], strict=True):
            inside = np.zeros(px.shape, dtype=bool)
            for (x0, y0), (x1, y1) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
                if y0 != y1:
                    inside ^= ((y0 > py) != (y1 > py)) & (
                        px < x0 + (x1 - x0) * ((py - y0) / (y1 - y0))
                    )
            found = np.where(inside, mu, found)
        return found

    def wheels(self, x: Any, y: Any, heading: Any) -> tuple[Any, Any]:
        """Places of the wheels in the scene [m], of (4, ...)."""
        c, s = np.cos(heading), np.sin(heading)
        ahead, left = (
            part.reshape(4, *(1,) * (np.ndim(x) - 1), -1) for part in (self.ahead_of, self.left_of)
        )
        px, py = (
            origin + self.length * part
            for origin, part in zip(self.origin, self._in_plan(x, y), strict=True)
        )
        return px + c * ahead - s * left, py + s * ahead + c * left

    def _in_plan(self, x: Any, y: Any) -> tuple[Any, Any]:
        return (x, y) if self.rises is None else in_plan(self.rises, x, y)

    def under(self, x: Any, y: Any, heading: Any, vx: Any, vy: Any, turning: Any) -> Any:
        """The friction under each wheel, of (4, cases); on an edge that of the side to which the
        wheel moves.
        """
        px, py = self.wheels(x, y, heading)
        c, s = np.cos(heading), np.sin(heading)
        vx, vy = self._in_plan(vx, vy)
        ux = self.length * vx - turning * (s * self.ahead_of + c * self.left_of)
        uy = self.length * vy + turning * (c * self.ahead_of - s * self.left_of)
        speed = np.hypot(ux, uy)
        near = _NEAR * self.length / np.where(speed > 0.0, speed, 1.0)
        return self.friction_at(px + near * ux, py + near * uy)

    def ahead(self, x: Any, y: Any, heading: Any, ux: Any, uy: Any, left: Any) -> Any:
        """How far a vehicle that moves straight along (ux, uy) goes to the next edge; infinite if
        it rests before it.
        """
        px, py = self.wheels(x, y, heading)
        ux, uy = self._in_plan(ux, uy)
        edges = self._edges()
        # Beyond all areas is far enough.
        reach = np.max(np.abs(edges), axis=(0, 1, 2)) + np.max(np.hypot(px, py), axis=0)
        far = np.minimum(left, 4.0 * reach / self.length + 1.0)
        near = np.minimum(_NEAR, far)
        ways = [self.length * part * np.array([near, far])[:, None] for part in (ux, uy)]
        share = _first((px + ways[0], py + ways[1]), edges)[0]
        found: Any = np.where(
            np.isfinite(share),
            near + np.where(np.isfinite(share), share, 0.0) * (far - near),
            np.inf,
        )
        return found

    def clear(self, x: Any, y: Any, heading: Any, left: Any) -> Any:
        """Whether no wheel comes near an edge of a vehicle that goes ``left`` until it rests."""
        far = self._to_edges(x, y, heading)
        found: Any = far > _CLEAR * self.length * (left + _NEAR)
        return found

    def _to_edges(self, x: Any, y: Any, heading: Any) -> Any:
        """How far the nearest wheel is from the nearest edge [m]."""
        px, py = (part[:, None] for part in self.wheels(x, y, heading))
        (qx, qy), (rx, ry) = (part.T[..., None] for part in self._edges())
        ex, ey, away_x, away_y = rx - qx, ry - qy, px - qx, py - qy
        square = ex * ex + ey * ey
        share = (away_x * ex + away_y * ey) / np.where(square > 0.0, square, 1.0)
        share = np.clip(share, 0.0, 1.0)
        return np.hypot(away_x - share * ex, away_y - share * ey).min(axis=(0, 1))

    def crossed(self, before: Any, after: Any, spin: Any) -> Any:
        """The share of the time of a step at which a wheel first crosses an edge; 1 or more if none
        does before its end.
        """
        from .motion import between

        count = before.shape[1]
        found = np.ones(count)
        edges = self._edges()
        # Most steps are away from all edges.
        near = self._to_edges(*before[1:4]) <= self._reach(before, after, spin)
        if not near.any():
            return found
        some = np.flatnonzero(near)
        own, before, after, spin = self.of(some), before[:, some], after[:, some], spin[some]

        def places(share: Any) -> tuple[Any, Any]:
            (x, y, heading), _ = between(before, after, share, spin)
            px, py = own.wheels(x, y, heading)
            return np.moveaxis(px, 0, -2), np.moveaxis(py, 0, -2)

        shares = np.linspace(0.0, 1.0, _CHORDS + 1)
        px, py = places(shares[:, None])
        steps = np.hypot(px[1] - px[0], py[1] - py[0])
        part = np.minimum(_NEAR * own.length / np.where(steps > 0.0, steps, np.inf), 1.0)
        px[0], py[0] = px[0] + part * (px[1] - px[0]), py[0] + part * (py[1] - py[0])
        at, wheel, edge = _first((px, py), edges)
        hit = np.flatnonzero(np.isfinite(at))
        if not len(hit):
            return found
        own, before, after, spin, at, wheel = (
            self.of(some[hit]),
            before[:, hit],
            after[:, hit],
            spin[hit],
            at[hit],
            wheel[hit],
        )
        (qx, qy), (rx, ry) = np.moveaxis(edges[:, edge[hit]], -1, 1)
        cases = np.arange(len(hit))

        def beyond(share: Any) -> tuple[Any, Any, Any]:
            px, py = (part[wheel, cases] for part in places(share))
            return (rx - qx) * (py - qy) - (ry - qy) * (px - qx), px, py

        low, high = np.floor(at) / _CHORDS, (np.floor(at) + 1.0) / _CHORDS
        one, two = beyond(low)[0], beyond(high)[0]
        share = at / _CHORDS
        for _ in range(4):
            middle, px, py = beyond(share)
            same = (middle > 0.0) == (one > 0.0)
            low, one = np.where(same, share, low), np.where(same, middle, one)
            high, two = np.where(same, high, share), np.where(same, two, middle)
            # At the edge to the last digit, either end is the share: half way between would be far.
            steep = two - one
            share = low - one * (high - low) / np.where(steep != 0.0, steep, 1.0)
            share = np.minimum(np.maximum(share, low), high)
        # An end that is hardly beyond the edge is on it.
        _, px, py = beyond(share)
        _, end_x, end_y = beyond(np.ones(len(hit)))
        on = np.hypot(end_x - px, end_y - py) <= _NEAR * own.length
        found[some[hit]] = np.where(on, 1.0, np.clip(share, 1e-9, 1.0 - 1e-12))
        return found

    def _reach(self, before: Any, after: Any, spin: Any) -> Any:
        """How far a wheel comes at most within a step from where it begins [m].

        By the polynomial of ``between``: its parts for the velocities at both ends are no more than
        0.2 of what these are over the time of the step, and those for the accelerations 0.02.
        """
        took = after[0] - before[0]
        lever = np.hypot(self.ahead_of, self.left_of).max(axis=0)
        parts = [
            np.abs(after[1 + at] - before[1 + at])
            + 0.2 * took * factor * (np.abs(before[4 + at]) + np.abs(after[4 + at]))
            + 0.02 * took * took * factor * (np.abs(after[7 + at]) + np.abs(after[10 + at]))
            for at, factor in ((0, 1.0), (1, 1.0), (2, np.abs(spin)))
        ]
        return self.length * (np.hypot(*parts[:2]) + _NEAR) + lever * parts[2]

    def _edges(self) -> Any:
        """Start and end of all edges, of (2, edges, 2)."""
        starts = np.concatenate(list(self.corners))
        return np.array(
            [starts, np.concatenate([np.roll(corners, -1, axis=0) for corners in self.corners])]
        )


def _first(points: tuple[Any, Any], edges: Any) -> tuple[Any, Any, Any]:
    """Where polylines first cross an edge, which wheel and which edge, by case; infinite where none
    does.

    ``points`` are x and y, of (points, wheels, cases).
    """
    px, py = (part[..., None] for part in points)
    (qx, qy), (rx, ry) = np.moveaxis(edges, -1, 1)
    side = (rx - qx) * (py - qy) - (ry - qy) * (px - qx)
    dx, dy = px[1:] - px[:-1], py[1:] - py[:-1]
    one = dx * (qy - py[:-1]) - dy * (qx - px[:-1])
    two = dx * (ry - py[:-1]) - dy * (rx - px[:-1])
    before, after = side[:-1], side[1:]
    crosses = ((before > 0.0) != (after > 0.0)) & ((one > 0.0) != (two > 0.0))
    steep = before - after
    part = before / np.where(crosses, steep, 1.0)
    at = np.where(crosses, np.arange(len(part))[:, None, None, None] + part, np.inf)
    # The first of wheels and edges together.
    _, wheels, cases, count = at.shape
    flat = np.moveaxis(at.min(axis=0), 1, 0).reshape(cases, wheels * count)
    which = flat.argmin(axis=1)
    return flat[np.arange(cases), which], which // count, which % count

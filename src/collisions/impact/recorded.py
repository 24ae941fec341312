"""What a recorder in a vehicle shows while a contact lasts: its delta-V over time, at its place and
in its axes.

A recorder sums up the acceleration of its own place in the axes of the car, which turn with it. Of
a place r ahead and to the left of the centre of mass, with the yaw rate w, that acceleration is a +
dw/dt x r - w^2 r, so in axes that turn the place adds dw x r, less r times the integral of w^2; and
what the centre of mass gains is turned back by the yaw of its moment (A. Marine, S. Werner,
"Delta-V analysis from crash test data for vehicles with post-impact yaw motion", SAE 980219, 1998).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, Literal, NamedTuple, TypeAlias, get_args

import numpy as np

from ..kernels.elementwise import FINITE
from ..kernels.status import Passed, Status
from ..messages.errors import InputError, ShapeError
from ..quantities.attributes import read_only
from ..quantities.reading import ArgumentReader, warn_if_large
from ..quantities.units import has_unit, shown
from ..vehicle.drag import LONGEST_CONTACT
from .inputs import Inputs

Axes: TypeAlias = Literal["turning", "fixed"]
FARTHEST = 20.0  # m; no recorder is farther from the centre of mass
_LIKELY = 5.0  # m; beyond, as of a long truck, a number without a unit may be of another one
# Cases of a block, whose steps are all kept, and how many are faster one by one.
_BLOCK, _FEW = 512, 24


class Curve(NamedTuple):
    """Time, change of velocity in the scene, and yaw rate of one vehicle at the start and after
    every step; and when the vehicles were engaged the most. Steps first, then cases.
    """

    time: Any
    vx: Any
    vy: Any
    yaw_rate: Any
    engaged: Any


def own_axes(curve: Curve, heading: float) -> tuple[Any, Any]:
    """Forward and left parts of the change of velocity, in the axes of the heading that was
    given.
    """
    cos, sin = np.cos(heading), np.sin(heading)
    return cos * curve.vx + sin * curve.vy + 0.0, cos * curve.vy - sin * curve.vx + 0.0


def readings(
    curve: Curve, heading: Any, place: tuple[Any, Any], axes: Axes, from_start: bool
) -> tuple[Any, Any]:
    """Forward and left delta-V that a recorder at a place has summed up by the end of every step.

    ``heading`` is that of the vehicle where it is engaged the most, or ``from_start`` that at first
    contact.
    """
    ahead, aside = place
    spin, step = curve.yaw_rate, np.diff(curve.time, axis=0)
    turned = _summed(0.5 * step * (spin[1:] + spin[:-1]))
    if not from_start:
        turned = turned - _at(curve.time, turned, curve.engaged)
    if axes == "fixed":
        # The velocity of the place itself, in the axes of the heading.
        forward, left = own_axes(curve, heading)
        cos, sin = np.cos(turned), np.sin(turned)
        by_x, by_y = -spin * (sin * ahead + cos * aside), spin * (cos * ahead - sin * aside)
        return forward + (by_x - by_x[:1]), left + (by_y - by_y[:1])
    angle = heading + 0.5 * (turned[1:] + turned[:-1])
    cos, sin = np.cos(angle), np.sin(angle)
    dx, dy = np.diff(curve.vx, axis=0), np.diff(curve.vy, axis=0)
    faster = spin - spin[:1]
    square = _summed(step * (spin[1:] * spin[1:] + spin[1:] * spin[:-1] + spin[:-1] ** 2) / 3.0)
    return (
        _summed(cos * dx + sin * dy) - faster * aside - square * ahead,
        _summed(cos * dy - sin * dx) + faster * ahead - square * aside,
    )


def _summed(steps: Any) -> Any:
    """The sums up to every step, from 0."""
    return np.concatenate((np.zeros_like(steps[:1]), np.cumsum(steps, axis=0)))


def _at(times: Any, values: Any, at: Any) -> Any:
    """The values at these times, one for each case."""
    if np.ndim(times) == 1:
        return np.interp(at, times, values)
    return np.array([np.interp(*case) for case in zip(at, times.T, values.T, strict=True)])


def curve_of(motions: Any, label: str, engaged: Any) -> Curve:
    """The curve of a vehicle among the numbers of a contact, SI: time, and of A and of B changes of
    velocity and yaw rate; and when they were engaged the most.
    """
    first = 1 if label == "a" else 4
    vx, vy, yaw_rate = motions[first : first + 3]
    return Curve(motions[0], vx, vy, yaw_rate, engaged)


def motions_of(rows: list[tuple[float, ...]], found: Passed, start: tuple[Any, ...]) -> Any:
    """The numbers of a contact in SI from the rows of its steps, in units of the contact; ``start``
    has the velocities and the yaw rates of A and B before.
    """
    from ..kernels.contact_step import Motion, Passing

    count = len(Motion._fields)
    columns = np.array(rows, dtype=np.float64).T
    of = {name: columns[2 * count + at] for at, name in enumerate(Passing._fields)}
    return _in_si(
        of["time"],
        of["deepest"][-1],
        [columns[at] for at in (0, 1, 2, count, count + 1, count + 2)],
        found,
        start,
    )


def _in_si(
    time: Any, deepest: Any, motion: list[Any], found: Passed, start: tuple[Any, ...]
) -> Any:
    """The same from columns without the start, which has to be put before them."""
    duration = found.duration / time[-1]
    length = found.max_crush / deepest
    closing = length / duration
    units = (closing, closing, 1.0 / duration) * 2
    changes = [
        np.concatenate((0.0 * time[:1], part * unit - first))
        for part, unit, first in zip(motion, units, start, strict=True)
    ]
    for at in (2, 5):
        changes[at] = changes[at] + start[at]
    return np.array([np.concatenate((0.0 * time[:1], time * duration)), *changes])


def start_of(inputs: Inputs, cut: Callable[[Any], Any]) -> tuple[Any, ...]:
    """Velocities and yaw rates of A and B before."""
    return tuple(
        cut(part) for body in (inputs.a, inputs.b) for part in (body.vx, body.vy, body.yaw_rate)
    )


def recorded(
    inputs: Inputs,
    answer: Passed,
    label: str,
    time: Any,
    place: tuple[Any, Any],
    axes: Axes,
) -> tuple[Any, Any]:
    """What a recorder in a vehicle shows at times after first contact, times first and then cases;
    NaN for a refused case.
    """
    body = inputs.b if label == "b" else inputs.a
    from_start = inputs.geometry == "first_contact"
    shape = np.shape(answer.status)
    size = math.prod(shape)
    given = "parts of different shapes"
    try:
        times = np.asarray(time, dtype=np.float64)
        given = f"shape {times.shape}"
        rows = times if times.ndim > 1 else times.reshape(-1, *[1] * len(shape))
        at = np.broadcast_to(rows, (len(rows), *shape)).reshape(-1, size)
    except ValueError:
        raise ShapeError(
            f"time has {given}, and must be a number, a row of times, or times first "
            f"and then the cases, (times{''.join(f', {one}' for one in shape)})",
            code="bad_shape",
            argument="time",
        ) from None
    for name, part in zip(("forward", "left"), place, strict=True):
        if np.broadcast_shapes(np.shape(part), (1,) * len(shape)) != (1,) * len(shape) and (
            np.shape(part) != shape
        ):
            raise ShapeError(
                f"{name} has shape {np.shape(part)}, and the impact has cases of shape {shape}; "
                "give one number, or one for each case",
                code="bad_shape",
                argument=name,
            )
    found = np.full((2, *at.shape), math.nan)
    for cases, motions, engaged in followed(inputs, answer):
        curve = curve_of(motions, label, engaged)
        cut = partial(_cut, cases=cases, shape=shape)
        curves = readings(
            curve, cut(body.heading), (cut(place[0]), cut(place[1])), axes, from_start
        )
        for i, case in enumerate(cases):
            for kept, values in zip(found, curves, strict=True):
                kept[:, case] = np.interp(at[:, case], curve.time[:, i], values[:, i])
    forward, left = (part.reshape(len(rows), *shape) for part in found)
    if not times.ndim and not shape:
        return float(forward[0]), float(left[0])
    if not times.ndim:
        forward, left = forward[0], left[0]
    read_only((forward, left))
    return forward, left


def followed(inputs: Inputs, answer: Passed) -> Iterator[tuple[Any, Any, Any]]:
    """Some answered cases after the other, by their places among all: which, their motions while
    the contact lasts, and when they were engaged the most.
    """
    shape = np.shape(answer.status)
    answered = np.flatnonzero(np.ravel(np.asarray(answer.status) <= Status.ENERGY_GAIN))
    length = 1 if len(answered) <= _FEW else _BLOCK
    for start in range(0, len(answered), length):
        cases = answered[start : start + length]
        cut = partial(_cut, cases=cases, shape=shape)
        if length > 1:
            yield cases, *_followed_together(inputs, cut, len(cases))
            continue
        alone = _followed_alone(inputs, partial(_one, cut=cut))
        if alone is not None:
            yield cases, alone[0][..., np.newaxis], np.array([alone[1]])


def _cut(value: Any, cases: Any, shape: tuple[int, ...]) -> Any:
    """The numbers of some cases, by their places among all."""
    if not isinstance(value, np.ndarray):
        return value
    return np.broadcast_to(value, shape).reshape(-1)[cases].astype(np.float64)


def _one(value: Any, cut: Callable[[Any], Any]) -> Any:
    return float(cut(value)[0]) if isinstance(value, np.ndarray) else value


def _followed_alone(inputs: Inputs, cut: Callable[[Any], Any]) -> Any:
    """One case of plain floats, and when it was engaged the most; None where it has no answer by
    itself.
    """
    from ..kernels.time_resolved import Noted
    from .time_resolved_inputs import follow_case

    rows = Noted()
    found = follow_case(inputs, cut, rows)
    if found.status > Status.ENERGY_GAIN or not rows:
        return None
    return motions_of(rows, found, start_of(inputs, cut)), found.engaged_time


def _followed_together(inputs: Inputs, cut: Callable[[Any], Any], count: int) -> Any:
    """Many cases as arrays, with every step kept, and when each was engaged the most."""
    from ..kernels import time_resolved as kernel
    from .time_resolved_inputs import kernel_arguments

    steps = _Steps(count)
    with np.errstate(all="ignore"):
        found = kernel.time_resolved(
            **kernel_arguments(inputs, cut), run=partial(_kept_run, steps=steps), note=steps
        )
        time, *motion = steps.columns()
        start = start_of(inputs, cut)
        # The tyres act for half a step more after the last one.
        ends = [
            getattr(found, f"delta_{name}_{label}")
            for label in "ab"
            for name in ("vx", "vy", "yaw_rate")
        ]
        motions = _in_si(time, steps.deepest, motion, found, start)
        past = np.arange(motions.shape[1])[:, np.newaxis] >= steps.count
        for at, end in enumerate(ends, 1):
            if at in (3, 6):
                end = end + start[at - 1]
            motions[at] = np.where(past, end, motions[at])
        return motions, found.engaged_time


class _Steps:
    """The steps of many cases, each with as many as it took the last time it was followed."""

    def __init__(self, cases: int) -> None:
        self.count = np.zeros(cases, dtype=np.intp)
        self._kept = np.zeros((64, 7, cases))
        self.deepest = np.zeros(cases)

    def begin(self, active: Any) -> None:
        """The active cases are followed anew from first contact."""
        self.count[active] = 0

    def clear(self) -> None:
        """Nothing is forgotten of cases that are not followed again."""

    def append(self, moving: tuple[Any, Any, Any], active: Any) -> None:
        """One more step of the cases that were active in it."""
        on_a, on_b, passing = moving
        cases = np.flatnonzero(active)
        at = self.count[cases]
        if at.size and at.max() >= len(self._kept):
            self._kept = np.concatenate((self._kept, np.zeros_like(self._kept)))
        parts = passing.time, *on_a[:3], *on_b[:3]
        self._kept[at, :, cases] = np.array([part[cases] for part in parts]).T
        self.deepest[cases] = passing.deepest[cases]
        self.count[cases] += 1

    def shift(self, some: Any, new: tuple[Any, ...], old: tuple[Any, ...]) -> None:
        """Let the ways of some cases end at ``new`` and not at ``old``, by as much as time has
        passed.
        """
        cases = np.flatnonzero(some)
        end, was = (
            np.array([passing.time, *on_a[:3], *on_b[:3]])[:, cases]
            for on_a, on_b, passing in (new, old)
        )
        kept = self._kept[:, :, cases]
        # A way over which no time passes is its end alone.
        passed = np.where(was[0] > 0.0, kept[:, :1] / was[0], 1.0)
        self._kept[:, :, cases] = kept + passed * (end - was)
        self.deepest[cases] = new[2].deepest[cases]

    def columns(self) -> Any:
        """Numbers, steps and cases; beyond its end a case stays as it ended."""
        most = max(1, int(self.count.max()))
        last = np.minimum(np.arange(most)[:, np.newaxis], np.maximum(self.count - 1, 0))
        return np.take_along_axis(self._kept, last[:, np.newaxis, :], axis=0).swapaxes(0, 1)


def _kept_run(settings: Any, steps: _Steps) -> Any:
    """Steps through a block of arrays, and keeps what moves."""
    from ..kernels.contact_step import advance

    moves = settings.geometry != "fixed"

    def run(
        fixed: tuple[Any, Any, Any],
        moving: tuple[Any, Any, Any],
        engaging: bool,
        note: Any,
    ) -> tuple[Any, Any, Any]:
        # Without a note only the end is asked for.
        if engaging and note is not None:
            steps.begin(moving[2].active)
        for _ in range(40 * settings.steps):
            active = moving[2].active
            if not np.any(active):
                break
            wheels = settings.wheels_a, settings.wheels_b
            moving = advance(*fixed, *moving, engaging, moves, *wheels)
            if note is not None:
                note(moving, active)
        return moving

    return run


def read_axes(reader: ArgumentReader, axes: Any) -> Any:
    """In which axes a recorder counts."""
    if not isinstance(axes, str) or axes not in get_args(Axes):
        text = (
            "axes must be 'turning' (with the car, as accelerometers sum up) or 'fixed' (those of "
            f"its heading), got {shown(axes)}"
        )
        return reader.refuse(InputError(text, code="bad_option", argument="axes"))
    return axes


def read_moment(reader: ArgumentReader, time: Any, name: str = "time") -> Any:
    """A time after first contact, with a warning if a bare number is longer than any contact."""
    found = reader.number(time, "s", name, FINITE)
    if not reader.problems:
        warn_if_large(time, found, LONGEST_CONTACT, name, "seconds", "ms")
    return found


def read_place(
    reader: ArgumentReader, place: tuple[Any, Any], names: tuple[str, str] = ("forward", "left")
) -> tuple[Any, Any]:
    """Where a recorder sits, ahead of the centre of mass and to its left."""
    forward, left = (_read_distance(reader, *pair) for pair in zip(place, names, strict=True))
    return forward, left


def _read_distance(reader: ArgumentReader, given: Any, name: str) -> Any:
    found = reader.number(given, "m", name, FINITE)
    if reader.problems:
        return found
    if np.all(np.abs(found) <= FARTHEST):
        warn_if_large(given, found, _LIKELY, name, "metres", "in", "cm")
        return found
    doubt = "" if has_unit(given) else " (were millimetres meant?)"
    text = f"{name} must be within {FARTHEST:g} m of the centre of mass, got {shown(given)}{doubt}"
    return reader.refuse(InputError(text, code="out_of_range", argument=name))

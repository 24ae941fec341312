"""The force of a contact over time: assumed, as a spring pulse, where one is needed; or as it
passed, a ``Pulse``.

The force is largest when compression ends, as in figure 3 of "Application of Impulse Momentum
Theory to Vehicle Collisions". It rises like that of a linear spring, as a quarter of a sine, and
falls like that of a stiffer one, as another quarter, which takes e times as long. Whatever the
restitution, its peak is pi/2 times its mean. An incomplete impact (e < 0) ends on the way up, when
the closing speed has fallen to -e times what it was. ``share`` is a share of the duration.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from typing import Any, NamedTuple

import numpy as np

from ..kernels.elementwise import safe_divisor, select
from ..quantities.attributes import Shown, math_or_numpy
from ..quantities.units import Value

QUARTER = 0.5 * math.pi


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Pulse(Shown):
    """A contact as ``time_resolved`` followed it.

    Attributes
    ----------
    duration : float or array [s]
        From first contact to separation.
    peak_force : float or array [N]
        The largest force along the normal.
    max_crush : float or array [m]
        Largest distance by which the contact points passed into each other along the normal, both
        vehicles together.
    peak_acceleration_a, peak_acceleration_b : float or array [m/s**2]
        Largest acceleration of the centre of mass, from contact and tyres, without the jump by
        which a friction of ``inf`` stops the slip at once.
    residual_crush_a, residual_crush_b : float or array [m], optional
        With ``crush_a`` or ``crush_b``, what is left of the crush of the vehicle, as it is measured
        on it: that at the largest force less A/B. 0 where the contact was too light to leave any;
        None for a vehicle without a crush stiffness.
    residual_crush : float or array [m], optional
        The sum of both.
    time, force, crush : array [s], [N], [m]
        Values at the start and after every step; None for a batch, where ``impact.case(i).pulse``
        has those of a case.
    delta_v_a, delta_v_b : array [m/s]
        Magnitude of the change of velocity up to each of these times.
    yaw_rate_a, yaw_rate_b : array [rad/s]
        Yaw rate at each of these times.
    delta_v_forward_a, delta_v_left_a, delta_v_forward_b, delta_v_left_b : array [m/s], optional
        The change of velocity of the centre of mass up to each of these times along the vehicle's
        heading as given, and to its left, as ``impact.a.delta_v_forward`` has the whole of it; None
        without a heading. What a recorder shows, in axes that turn with the car and at its own
        place, and of the cases of a batch, is ``impact.a.recorded(times)``.
    """

    _title = "Pulse"

    duration: Value = field(metadata={"unit": "s"})
    peak_force: Value = field(metadata={"unit": "N"})
    max_crush: Value = field(metadata={"unit": "m"})
    peak_acceleration_a: Value = field(metadata={"unit": "m/s**2"})
    peak_acceleration_b: Value = field(metadata={"unit": "m/s**2"})
    residual_crush: Value | None = field(default=None, metadata={"unit": "m"})
    residual_crush_a: Value | None = field(default=None, metadata={"unit": "m"})
    residual_crush_b: Value | None = field(default=None, metadata={"unit": "m"})
    time: Any = field(default=None, metadata={"unit": "s"})
    force: Any = field(default=None, metadata={"unit": "N"})
    crush: Any = field(default=None, metadata={"unit": "m"})
    delta_v_a: Any = field(default=None, metadata={"unit": "m/s"})
    delta_v_b: Any = field(default=None, metadata={"unit": "m/s"})
    yaw_rate_a: Any = field(default=None, metadata={"unit": "rad/s"})
    yaw_rate_b: Any = field(default=None, metadata={"unit": "rad/s"})
    delta_v_forward_a: Any = field(default=None, metadata={"unit": "m/s"})
    delta_v_left_a: Any = field(default=None, metadata={"unit": "m/s"})
    delta_v_forward_b: Any = field(default=None, metadata={"unit": "m/s"})
    delta_v_left_b: Any = field(default=None, metadata={"unit": "m/s"})


class Parted(NamedTuple):
    """How a contact that was followed in time ends: its duration and when the vehicles were engaged
    the most [s]; and by vehicle how far it moved along x and y [m] and turned [rad] from the places
    that were given until then.
    """

    duration: Any
    engaged: Any
    moved: dict[str, tuple[Any, Any, Any]]


def parted(answer: Any) -> Parted:
    """The end of a contact from what the kernel answered."""
    return Parted(
        answer.duration,
        answer.engaged_time,
        {
            label: (
                getattr(answer, f"moved_x_{label}"),
                getattr(answer, f"moved_y_{label}"),
                np.arctan2(getattr(answer, f"turn_s_{label}"), getattr(answer, f"turn_c_{label}")),
            )
            for label in "ab"
        },
    )


CURVES = tuple(f.name for f in fields(Pulse) if f.type == "Any")
"""The fields of a ``Pulse`` that have a value for every step."""


def rise(share: Any) -> Any:
    """Force over its peak at a share of the compression time; restitution runs the
    curve backwards.
    """
    return math_or_numpy(share).sin(QUARTER * share)


def compression_time(e: Any) -> Any:
    """Share of the duration after which compression ends; above 1 where the impact ends before."""
    return 1.0 / _rate(e)


def _rate(e: Any) -> Any:
    """Duration over compression time: how many quarters of a sine would fit into it; NaN from a
    restitution of -1 on, where nothing is held.
    """
    held = select(e > -1.0, e, math.nan)
    cut = math.acos(max(-held, 0.0)) if isinstance(e, float) else np.arccos(np.maximum(-held, 0.0))
    return select(e < 0.0, cut / QUARTER, 1.0 + e)


def passed(e: Any, share: float) -> Any:
    """Share of the impulse that has been transmitted at a share of the duration."""
    xp = math_or_numpy(e)
    phase = share * _rate(e)
    compressing = 1.0 - xp.cos(QUARTER * phase)
    # 0 before restitution begins: divided by a tiny restitution it would be infinite, which has no
    # sine.
    late = select(phase <= 1.0, 0.0, phase - 1.0)
    restoring = 1.0 + e * xp.sin(QUARTER * (late / safe_divisor(True, e)))
    return select(phase <= 1.0, compressing, restoring) / select(e > -1.0, 1.0 + e, math.nan)


def mean_passed(e: Any) -> Any:
    """Mean of ``passed`` over the duration."""
    angle = QUARTER * _rate(e)
    mean = select(e < 0.0, 1.0 - math_or_numpy(e).sin(angle) / angle, 1.0 - (1.0 - e) / QUARTER)
    return mean / select(e > -1.0, 1.0 + e, math.nan)


def engaged(e: Any) -> tuple[Any, Any]:
    """Shares of the duration until maximum engagement: of the time, and of ``passed`` summed up to
    then.

    An incomplete impact is engaged the most as it ends.
    """
    complete = (1.0 - 1.0 / QUARTER) / ((1.0 + e) * (1.0 + e))
    return select(e < 0.0, 1.0, 1.0 / (1.0 + e)), select(e < 0.0, mean_passed(e), complete)


def restoring(e: Any) -> Any:
    """Mean of ``passed`` after maximum engagement, weighted with the speed of parting."""
    return select(e < 0.0, 1.0, (1.0 + 0.5 * QUARTER * e) / (1.0 + e))


def drifting(e: Any) -> tuple[tuple[Any, Any], tuple[Any, Any]]:
    """Shares of the duration, of the time and of ``passed``, weighted with the speed; in
    compression and in restitution.

    A small force beside that of a linear spring changes its energy by what it does on the way, so
    its effect on the speed that the spring takes up or gives back has the cosine or the sine as
    weight. Of an incomplete impact without restitution.
    """
    per_e = 1.0 / (QUARTER * (1.0 + e))
    back = select(e < 0.0, 0.0, e) * per_e
    return (per_e, per_e * (1.0 - 0.5 * QUARTER) / (1.0 + e)), (back, back * restoring(e))


def mean_square_passed(e: Any) -> Any:
    """Mean of the square of ``passed`` over the duration."""
    angle, sin = QUARTER * _rate(e), math_or_numpy(e).sin
    cut = (1.5 - 2.0 * sin(angle) / angle + 0.25 * sin(2.0 * angle) / angle) / (1.0 + e) ** 2
    whole = (1.5 - 2.0 / QUARTER + e * (1.0 + e * (2.0 / QUARTER + 0.5 * e))) / (1.0 + e) ** 3
    return select(e < 0.0, cut, whole)


def greatest_crush(e: Any) -> Any:
    """Greatest mutual crush, over closing speed times duration; NaN where the bodies pass or tear
    before.
    """
    return select(e < 0.0, math.nan, compression_time(e) / QUARTER)

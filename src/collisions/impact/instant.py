"""What an impact that was found backwards as an instant leaves out, in one sentence, or what it
still leaves out with tyres.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..kernels.elementwise import turning_velocity
from ..messages.errors import CollisionsError
from ..messages.warning import quietly
from ..quantities.formatting import percent
from ..quantities.tables import Sentences
from ..vehicle.vehicle import with_name
from .impact import Impact
from .left_out import LeftOut, left_out, tyres_held, tyres_lacking
from .reconstruction import Reconstruction

# Of the tyres of an impulse: how its kernel, ``held``, limits their force.
LIMITED = (
    "that of each wheel limited at each of these moments to what would stop it, as it moves then "
    "along its force, with a quarter of the vehicle's mass (up to twice that where the contact "
    "sets the vehicle in motion or stops it)"
)
# Of pairs of known values that are not the components of recorders.
LOOKED_FOR = (
    "answers are looked for from those of an instant without tyres and, unless components of "
    "delta-V alone are more than is needed, from a grid of other speeds; one that none of these "
    "leads to is missed"
)
# Of a known speed and one other known value.
LOOKED_ALONG = (
    "answers are looked for from those of an instant without tyres and by a scan of the unknown "
    "speed, to 60 m/s (216 km/h, 134 mph) both ways and further where what is known is large; one "
    "that lies beyond, or that the steps of the scan do not tell from another or from a jump, is "
    "missed"
)
# Of readings of recorders away from the centre of mass, or in axes that turn.
LOOKED_FOR_TURNS = (
    "answers are looked for from many turns of the cars of up to a quarter during the contact; one "
    "that none of these leads to is missed, and one that turns by more is none"
)
FROM_READINGS = f"from readings away from the centre of mass: {LOOKED_FOR_TURNS}"
# Of motions before that ``planar`` finds with tyres.
LOOKED_AROUND = (
    "origins are looked for from those of an instant without tyres and from motions around them, "
    "as far as the tyres reach, and one that none of these leads to is missed"
)
# Of speeds that were asked for forwards alone, after which answers.
LEFT_BACKWARDS = "in which a vehicle goes backwards along its course: left out (forward_only=True)"
# Of the closing speed: by no more do motions after differ that nothing changed.
_ROUNDING = 1e-9
# The reverse solvers that take a duration and tyres.
TAKE_TYRES = ("planar", "speeds")


class Neglect(NamedTuple):
    """The larger share of delta-V that is left out, for tyres or for the motion, the sentence for
    it, and what it assumes.
    """

    share: float
    sentence: str
    assumed: str = "drag and duration"


def neglected(
    impact: Impact,
    found: LeftOut | None = None,
    *,
    wheels: Collection[str] = (),
    of_scene: bool = False,
) -> Neglect | None:
    """What a reconstruction as an instant leaves out, as ``left_out`` estimates it, of the worse of
    both vehicles and in a batch in the median; of one with the tyres of one vehicle, what the other
    leaves out without. None of an impact that was not reconstructed, or that has the tyres or drags
    of both. ``wheels`` are the vehicles whose tyres it was estimated with, and not with a drag,
    ``of_scene`` says that the impact is one of a scene whose numbers were found.
    """
    origin, lacking = impact.reconstruction, tyres_lacking(impact)
    if not lacking or impact.pulse is not None or np.all(impact.refused):
        return None
    if origin is None and not of_scene:
        return None
    if found is None:
        try:
            with quietly():
                found = left_out(impact)
        except CollisionsError:
            # Numbers at the end of what floats hold.
            return None
    tyres, motion = (
        _worst(getattr(found.a, name), getattr(found.b, name))
        for name in ("tyre_share", "geometry_share")
    )
    if tyres_held(impact):
        return _of_the_other(impact, lacking[0], found, tyres, of_scene=of_scene)
    parts = [
        f"{percent(share)} {what}"
        for share, what in (
            (tyres, f"for {_tyres_in_words(found, lacking, wheels)}"),
            (motion, "for point and normal that move on"),
        )
        if math.isfinite(share)
    ]
    if not parts:
        return None
    advice = f"give duration= and {', '.join(f'tyres_{label}=' for label in lacking)}"
    if of_scene:
        advice = "give the contact duration= and its vehicles tyres="
    elif origin is not None and origin.method not in TAKE_TYRES:
        # Drags act against a motion from A towards B alone.
        states = impact.a.before, impact.a.after, impact.b.before, impact.b.after
        follows = all(np.nanmin(state.vx) >= 0.0 for state in states)
        advice = (
            f"give duration= and {', '.join(f'drag_{label}=' for label in lacking)}"
            if follows
            else "collisions.left_out says more of it"
        )
    sentence = (
        f"found as an instant: of delta-V that leaves out about {' and '.join(parts)}, during "
        f"{_middle(found.duration):.3g} s{_medians(impact)}; {advice}"
    )
    return Neglect(max(share for share in (tyres, motion) if math.isfinite(share)), sentence)


def _of_the_other(
    impact: Impact, label: str, found: LeftOut, share: float, *, of_scene: bool
) -> Neglect | None:
    """What an impact leaves out that has the tyres of one vehicle, and not those of this one."""
    if not math.isfinite(share):
        return None
    who = with_name(f"vehicle {label.upper()}", getattr(impact.inputs, label))
    advice = f"give tyres_{label}="
    if of_scene:
        advice = "give that vehicle its tyres="
    elif not impact.inputs.tyres:
        advice = f"give drag_{label}=, which is 0 where its wheels roll"
    sentence = (
        f"found without the tyres of {who}: of delta-V that leaves out about {percent(share)} if "
        f"they slide with a drag of {_middle(found.drag):.2g} for "
        f"{_middle(found.duration):.3g} s{_medians(impact)}; {advice}"
    )
    return Neglect(share, sentence, "drag")


def _tyres_in_words(found: LeftOut, lacking: Sequence[str], wheels: Collection[str]) -> str:
    """What was left out for tyres: those given beside the impact, and others that slide."""
    sliding = f"that slide with a drag of {_middle(found.drag):.2g}"
    given = [label for label in lacking if label in wheels]
    if not given:
        return f"tyres {sliding}"
    if len(given) == len(lacking):
        return "the tyres as given"
    (other,) = set(lacking) - set(given)
    return f"the tyres of {given[0].upper()} as given and those of {other.upper()} {sliding}"


def _medians(impact: Impact) -> str:
    return " (medians)" if np.ndim(impact.closing_speed) else ""


def found_backwards(impact: Impact) -> tuple[str, ...]:
    """What has to be said of how an impact was found backwards, beside what an instant leaves
    out.
    """
    return (
        *_forwards_alone(impact),
        *_may_have_stuck(impact),
        *_motions_changed(impact),
        *_found_from_readings(impact),
        *_found_with_tyres(impact),
    )


def _forwards_alone(impact: Impact) -> tuple[str, ...]:
    """How many answers were left out of speeds that were asked for forwards alone."""
    left = 0 if impact.reconstruction is None else impact.reconstruction.left_backwards
    if left is None or not np.any(left):
        return ()
    of = "one more answer fits" if np.ndim(left) == 0 and left == 1 else f"{left} more answers fit"
    if np.ndim(left):
        cases = f"{np.count_nonzero(left)} of {np.size(left)} cases"
        of = f"in {cases}, up to {np.max(left)} more fit"
    return (f"{of}, {LEFT_BACKWARDS}",)


def looked_for(known: Sequence[str]) -> str:
    """How speeds with tyres were looked for, by the names of what was known, of which both EES, or
    both speeds of maximum crush, are one.
    """
    along = len(known) == 2 and any(name.startswith("speed") for name in known)
    return LOOKED_ALONG if along else LOOKED_FOR


def _found_from_readings(impact: Impact) -> tuple[str, ...]:
    """What has to be said of speeds from readings of recorders in a contact that lasts: how they
    were looked for.
    """
    origin = impact.reconstruction
    if origin is None or not any(name.startswith("recorder_axes") for name in origin.known):
        return ()
    lasts = impact.inputs.duration
    if lasts is None:
        lasts = origin.given.get("recorder_duration", 0.0)
    if not np.any(np.greater(lasts, 0.0)):
        return ()
    return (f"found {FROM_READINGS}",)


def _found_with_tyres(impact: Impact) -> tuple[str, ...]:
    """What has to be said of an impact that was found backwards with tyres: how the speeds or
    motions before were looked for, where others may have been missed, and what is left out.
    """
    origin = impact.reconstruction
    if origin is None or origin.method not in TAKE_TYRES or not impact.inputs.tyres:
        return ()
    return *_looked_for(origin), *_bound_with_tyres(origin), *_motion_left_out(impact)


def _bound_with_tyres(origin: Reconstruction) -> tuple[str, ...]:
    """What has to be said of speeds that are known from one side alone."""
    if not any(np.any(side) for side in (origin.one_sided or {}).values()):
        return ()
    return (
        "a bound with tyres: with more slip the tyres do otherwise than at this end of the speeds, "
        "and one that hardly changes from there on may lie a little beyond its bound",
    )


def _may_have_stuck(impact: Impact) -> tuple[str, ...]:
    """What has to be said of an impact that ``planar`` found from a slip after that may be none."""
    origin = impact.reconstruction
    if origin is None or origin.slip_if_stuck is None:
        return ()
    low, high = origin.slip_if_stuck
    nearly = np.logical_not(np.isnan(low))
    if not np.any(nearly):
        return ()
    say = Sentences(impact.inputs.texts)
    where, of = "in a wide range", ""
    if np.ndim(low) == 0:
        where = in_interval(float(low), float(high), lambda end: say(end, "speed", 4))
    else:
        of = f"in {np.count_nonzero(nearly)} of {np.size(low)} cases, "
    least = float(np.min(np.where(nearly, np.abs(impact.slip_after), np.inf)))
    return (
        f"{of}the slip after the impact, {say(least, 'speed', 3)}, is so small that it may be "
        f"none: then the contact stuck, and the slip before was anything {where or 'at all'}; the "
        "answer is that of the sign of the slip after. Decide with impulse_ratio= of either sign",
    )


def in_interval(low: float, high: float, text: Callable[[float], str]) -> str:
    """Where a number lies between two, which ``text`` writes; "" for all numbers."""
    if math.isinf(low):
        return "" if math.isinf(high) else f"below {text(high)}"
    return f"above {text(low)}" if math.isinf(high) else f"between {text(low)} and {text(high)}"


def _motions_changed(impact: Impact) -> tuple[str, ...]:
    """What has to be said of an impact that ``planar`` found from motions after in which the
    contact points still approach a little: they are not the motions of the answer.
    """
    origin, point = impact.reconstruction, impact.point
    if origin is None or origin.method != "planar" or point is None:
        return ()
    (nx, ny), approach = impact.normal, 0.0
    for sign, label in ((1.0, "a"), (-1.0, "b")):
        after = getattr(impact, label).after
        given = {
            name: origin.given.get(f"{label}_after.{name}", getattr(after, name))
            for name in ("vx", "vy", "yaw_rate")
        }
        if after.pivot is not None:
            given |= {"vx": 0.0, "vy": 0.0}
        place = (after.x, after.y) if after.pivot is None else after.pivot
        # A wall has no place, and does not turn. A refused case may have no number.
        with np.errstate(all="ignore"):
            turn_x, turn_y = (
                (0.0, 0.0)
                if place[0] is None
                else turning_velocity(given["yaw_rate"], *point, *place)
            )
            approach = approach + sign * (nx * (given["vx"] + turn_x) + ny * (given["vy"] + turn_y))
    with np.errstate(all="ignore"):
        share = np.where(np.equal(impact.restitution, 0.0), approach / impact.closing_speed, 0.0)
    most = float(np.fmax.reduce(share, axis=None, initial=0.0))
    if most <= _ROUNDING:
        return ()
    cases = "" if share.ndim == 0 else "in some cases "
    return (
        f"{cases}the contact points still approach in the motions after as they were given, by up "
        f"to {100.0 * most:.2g} percent of the closing speed: taken as 0, a plastic impact, and "
        "the motions after changed by as much",
    )


def _motion_left_out(impact: Impact) -> tuple[str, ...]:
    """What is left out of an impact that has its tyres, as ``left_out`` estimates it."""
    if np.all(impact.refused):
        return ()
    try:
        with quietly():
            found = left_out(impact)
    except CollisionsError:
        # Numbers at the end of what floats hold.
        return ()
    motion = _worst(found.a.geometry_share, found.b.geometry_share)
    if not math.isfinite(motion):
        return ()
    return (
        f"found with tyres: of delta-V that leaves out about {percent(motion)} for point and "
        f"normal that move on, during {_middle(found.duration):.3g} s{_medians(impact)}; fit or "
        "posterior with time_resolved as the model has it",
    )


def _looked_for(origin: Reconstruction) -> tuple[str, ...]:
    if origin.method == "planar":
        return (f"found with tyres: {LOOKED_AROUND}",)
    return (f"found with tyres: {looked_for(origin.known)}",)


def _worst(one: Any, other: Any) -> float:
    """The larger of both vehicles' middle shares; NaN where neither has one."""
    first, second = (math.nan if part is None else _middle(part) for part in (one, other))
    return float(np.fmax(first, second))


def _middle(values: Any) -> float:
    """The median of the cases that have one."""
    known = np.asarray(values, dtype=np.float64)
    known = known[np.isfinite(known)]
    return float(np.median(known)) if known.size else math.nan

"""Findings on how firmly an answer stands: its conditioning, its model and law, the direction of
the normal, and friction.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

from ..impact.doubts import (
    BACKWARDS,
    MOTIONS_CANCEL,
    NEARLY_COLLINEAR,
    angle_of_courses,
    apart_in_words,
    growth_by_motions,
    motions_cancel,
    shares_apart,
    speeds_along,
    sticking_needs,
    taken_to_stick,
)
from ..impact.impact import Impact
from ..impact.inputs import PLACED
from ..impact.instant import neglected
from ..impact.left_out import tyres_lacking
from ..impact.reconstruction import (
    NOT_THIS,
    bounds_of,
    from_components,
    how_many,
    known_in_words,
)
from ..impact.tyres_stop import MOST_ESTIMATED, estimated
from ..impact.vehicle_result import VehicleResult
from ..reconstruct.momentum_tyres import lasts
from ..reconstruct.momentum_tyres import neglected as momentum_neglect
from ..reconstruct.momentum_tyres import tyres_lacking as momentum_lacking
from ..reconstruct.speeds import if_it_slid
from ..reference import INTER_VEHICLE_FRICTION, RECORDER_ACCURACY
from ..vehicle.drag import GRAVITY
from .case import RATIO_ROUNDING, Case, ImpactCase, MomentumCase, off_by, plain
from .finding import MESSAGES, METHOD, Measured, above, at_or_below, below, finding
from .numbers import percent, share

# In rad/s: a smaller difference of yaw rates shows in no rest position.
_YAW_RATE_SEEN = 0.1


@finding(
    "in a reconstruction of two speeds by momentum or from components of delta-V, angle between "
    "both courses, or to the opposite",
    at_or_below(NEARLY_COLLINEAR, "rad"),
    f"collinear impacts, {METHOD}",
)
def near_collinear(case: Case) -> Iterator[Measured]:
    if isinstance(case, MomentumCase):
        names = case.answer.unknowns
        if any(name.startswith("course") for name in names):
            return  # of one vehicle, whose course is an answer
        one, other = (getattr(case.answer, name.replace("speed", "course")) for name in names)
        of = f"the courses of {' and '.join(names)}"
        then = "across it, momentum tells little of these speeds"
    else:
        origin = case.answer.reconstruction
        if origin is None or angle_of_courses(origin) is None:
            return
        one, other = origin.given["course_a"], origin.given["course_b"]
        of = "course_a and course_b"
        then = "small errors of delta-V and of the courses move both speeds far"
    # Exactly ten degrees still count, even where rounding makes them more.
    angle = max(abs(math.remainder(one - other, math.pi)) - off_by(one, other, math.pi), 0.0)
    yield Measured(angle, f"{of} are {case.text(angle, 'angle')} from one line: {then}")


@finding(
    "condition of a reconstruction",
    above(10.0),
    "set here: one percent of error may become ten in the speeds",
)
def ill_conditioned(case: Case) -> Iterator[Measured]:
    if isinstance(case, MomentumCase):
        moves = []
        for speed, row in case.answer.sensitivity.items():
            course = max(
                (name for name in row if name.startswith("course")), key=lambda name: abs(row[name])
            )
            kind = "angle" if speed.startswith("course") else "speed"
            moves.append(
                f"{speed} changes by {case.text(abs(row[course]) * math.pi / 180.0, kind)} "
                f"per degree of {course}"
            )
        condition = case.answer.condition
        yield Measured(
            condition,
            f"reconstruct.momentum has a condition of {plain(condition)}: {'; '.join(moves)}",
        )
    elif (origin := case.answer.reconstruction) is not None:
        given = ", ".join(known_in_words(origin.known))
        sentence = (
            f"reconstruct.{origin.method}: one percent in what was given ({given}) may become "
            f"{plain(origin.condition)} percent of the closing speed in the speeds before"
        )
        if origin.slip_if_stuck is not None and not math.isnan(origin.slip_if_stuck[0]):
            slip = case.text(abs(case.answer.slip_after), "speed")
            sentence = (
                f"reconstruct.{origin.method}: the sign of the slip after, {slip}, decides, and it "
                "may be none: then the contact stuck, and the slip before is open"
            )
        yield Measured(origin.condition, sentence)


@finding(
    "growth of errors of the motions after in the closing speed, of a reconstruction from them",
    above(MOTIONS_CANCEL),
    "set here: one percent of error may become ten in the closing speed",
)
def motions_after_cancel(case: ImpactCase) -> Iterator[Measured]:
    growth = float(growth_by_motions(case.answer))
    yield Measured(growth, motions_cancel(growth))


@finding(
    "number of impacts that fit what the reconstruction was given",
    above(1.0),
    "set here: one answer needs no choice",
)
def not_unique(case: ImpactCase) -> Iterator[Measured]:
    origin = case.answer.reconstruction
    if origin is not None:
        given = ", ".join(known_in_words(origin.known))
        sentence = (
            f"reconstruct.{origin.method} found {how_many(origin.answers)} that fit what was given "
            f"({given}), of which this is one: other evidence must tell which"
        )
        yield Measured(origin.answers, sentence)


@finding(
    "speed that was found, backwards along its course",
    above(BACKWARDS, "m/s"),
    "set here: 0.4 km/h, below what evidence shows",
)
def speed_backwards(case: Case) -> Iterator[Measured]:
    if isinstance(case, MomentumCase):
        names = [name for name in case.answer.unknowns if name.startswith("speed")]
        along = {name: getattr(case.answer, name) for name in names}
    else:
        along = speeds_along(case.answer)
    for name, speed in along.items():
        sentence = (
            f"{name} is {case.text(speed, 'speed')}, backwards along its course: check the courses"
            f"{'' if isinstance(case, MomentumCase) else ' and the normal'}"
        )
        yield Measured(-speed, sentence, vehicle=name.split("_")[1])


@finding(
    "the most that the tyres can give in the duration, as a share of delta-V",
    above(0.25),
    "set here: with 0.7 g in 0.1 s a delta-V below 2.7 m/s (10 km/h), where it is a minor "
    "impact; tyre forces are insignificant but in minor impacts, sideswipes and impacts of "
    f"large trucks, {METHOD}",
)
def tyre_impulse(case: Case) -> Iterator[Measured]:
    lacking = (
        momentum_lacking(case.answer)
        if isinstance(case, MomentumCase)
        else tyres_lacking(case.answer)
    )
    for label in lacking:
        vehicle = case.vehicles[label]
        time = case.duration
        if isinstance(case, ImpactCase) and case.left_out is not None:
            left = getattr(case.left_out, label)
            most, part = left.tyre_delta_v_bound, left.tyre_share_bound
            # For a body that turns about a pivot it is an estimate.
            how = "up to" if getattr(case.answer, label).before.pivot is None else "about"
        else:
            if isinstance(case, MomentumCase):
                time = lasts(case.answer, time)
            most = case.drag * GRAVITY * time
            part, how = share(most, vehicle.delta_v), "up to"
        slide = f"a drag of {case.drag:.2g}"
        if label in case.tyres:
            slide = f"a friction of {case.tyres[label].friction:.2g}"
        sentence = (
            f"tyres of {vehicle.who} that slide for {time:.3g} s with {slide} give {how} "
            f"{case.text(most, 'speed')}, "
            f"{percent(part)} of its delta-V of {case.text(vehicle.delta_v, 'speed')}"
        )
        yield Measured(part, sentence, label)


@finding(
    "impulse that the whole force of tyres would give in an instant beyond half of what stops the "
    "vehicle, or its turning, as a share of the momentum that it gains",
    above(MOST_ESTIMATED),
    "set here: half of the share by which a simpler model may err; where it is less, nine in ten "
    "delta-V of impacts at 1.5 to 12 m/s are within 10 percent of the contact in time at fixed "
    "places",
)
def tyres_stop(case: ImpactCase) -> Iterator[Measured]:
    impact = case.answer
    if impact.pulse is not None:
        return
    for label, who, side in case.sides:
        if label not in impact.inputs.tyres or math.isinf(side.before.mass):
            continue
        impulse, moment, part = map(float, estimated(impact, label))
        sentence = (
            f"tyres of {who} could stop it, or its turning, within the duration of the contact: "
            f"their whole force would give {case.text(impulse, 'impulse')} and "
            f"{case.text(moment, 'angular momentum')} more than half of what stops them, "
            f"{percent(part)} of the momentum that the vehicle gains, and how much of it acts an "
            "impulse only estimates: follow the contact in time, by time_resolved"
        )
        yield Measured(part, sentence, label)


@finding(
    "in a reconstruction without tyres, what an instant leaves out, or without those of one "
    "vehicle, what these would do, as a share of delta-V, or of a speed that momentum found",
    above(0.1),
    f"the 10 percent by which delta-V may differ between methods, {MESSAGES}",
)
def instant(case: Case) -> Iterator[Measured]:
    if isinstance(case, MomentumCase):
        left = momentum_neglect(case.answer, case.duration, case.drag, case.text)
        if left is not None:
            yield Measured(left.share, left.sentence)
    elif case.left_out is not None:
        neglect = neglected(case.answer, case.left_out, wheels=case.tyres)
        if neglect is not None:
            yield Measured(neglect.share, neglect.sentence)


@finding(
    "predicted error of a central model as a share of the smaller delta-V (inf if eccentric "
    "refuses)",
    above(0.1),
    f"the 10 percent by which delta-V may differ between methods, {MESSAGES}",
)
def model(case: ImpactCase) -> Iterator[Measured]:
    name = case.answer.model
    if name in PLACED:
        return
    choice, how = case.model_choice
    error = choice.errors[name]
    if not math.isnan(error):
        delta_v = min(
            (side.delta_v for _, _, side in case.sides if side.delta_v > 0.0), default=math.inf
        )
        sentence = (
            f"{name} is predicted to err by {case.text(error, 'speed')}{how}, against a delta-V of "
            f"{case.text(delta_v, 'speed')}: take eccentric"
        )
        yield Measured(error / delta_v, sentence)
    elif not choice.missing["eccentric"]:
        yield Measured(
            math.inf,
            f"the error of {name} cannot be estimated: the eccentric model has no answer here",
        )


def _worst(
    case: ImpactCase,
    answers: list[tuple[str, Impact]],
    size: Callable[[VehicleResult, VehicleResult], float],
) -> Any:
    """The description of another result, label and name of the vehicle for which it differs most,
    and both its sides; of a tie the first, which is vehicle A's.
    """
    changes = [
        (how, label, who, old, new)
        for how, answer in answers
        if not answer.refused
        for (label, who, old), new in zip(case.sides, (answer.a, answer.b), strict=True)
    ]
    sizes = [size(*change[3:]) for change in changes]
    most = max(sizes, default=0.0) * (1.0 - RATIO_ROUNDING)
    return next((change for change, own in zip(changes, sizes, strict=True) if own >= most), None)


def _delta_v_change(old: VehicleResult, new: VehicleResult) -> float:
    """Length of the change of the delta-V vector, as a share of delta-V; 0 for a body that nothing
    moves.
    """
    length = math.hypot(new.delta_vx - old.delta_vx, new.delta_vy - old.delta_vy)
    return share(length, old.delta_v) if old.delta_v > 0.0 else 0.0


def _yaw_change(old: VehicleResult, new: VehicleResult) -> float:
    """Difference of both changes of yaw rate, as a share of the larger; above 1 with the other
    sign.
    """
    was, now = old.delta_yaw_rate, new.delta_yaw_rate
    step = abs(now - was)
    return share(step, max(abs(was), abs(now))) if step > _YAW_RATE_SEEN else 0.0


def _compare_delta_v(case: ImpactCase, answers: list[tuple[str, Impact]]) -> Iterator[Measured]:
    refused = [how for how, answer in answers if answer.refused]
    if refused:
        yield Measured(math.inf, f"{refused[0]}, there is no answer")
    elif answers:
        how, label, who, old, new = _worst(case, answers, _delta_v_change)
        change = _delta_v_change(old, new)
        turn = abs(
            math.remainder(
                math.atan2(new.delta_vy, new.delta_vx) - math.atan2(old.delta_vy, old.delta_vx),
                math.tau,
            )
        )
        sentence = (
            f"{how}, delta-V of {who} changes by {percent(change)} as a vector: from "
            f"{case.text(old.delta_v, 'speed')} to {case.text(new.delta_v, 'speed')}, and in "
            f"direction by {case.text(turn, 'angle')}"
        )
        yield Measured(change, sentence, label)


def _compare_yaw(case: ImpactCase, answers: list[tuple[str, Impact]]) -> Iterator[Measured]:
    worst = _worst(case, answers, _yaw_change)
    if worst is not None:
        how, label, who, old, new = worst
        was, now = old.delta_yaw_rate, new.delta_yaw_rate
        other_way = (
            ", the other way"
            if min(abs(was), abs(now)) > _YAW_RATE_SEEN and was * now < 0.0
            else ""
        )
        turned = (
            f"{case.text(now, 'yaw rate')} instead of {case.number(was, 'yaw rate')}{other_way}"
        )
        sentence = f"{how}, the impact turns {who} by {turned}"
        yield Measured(_yaw_change(old, new), sentence, label)


@finding(
    "length by which the vector of delta-V moves under the other law, as a share of delta-V",
    above(0.1),
    f"the 10 percent by which delta-V may differ between methods, {MESSAGES}",
)
def law(case: ImpactCase) -> Iterator[Measured]:
    return _compare_delta_v(case, case.other_laws)


@finding(
    "difference in change of yaw rate under the other law, if over 6 deg/s, as a share of the "
    "larger (above 1: other way)",
    above(0.25),
    "set here: a quarter, which a rest position would show",
)
def law_yaw(case: ImpactCase) -> Iterator[Measured]:
    return _compare_yaw(case, case.other_laws)


@finding(
    "length by which the vector of delta-V moves with the normal turned by 10 degrees either "
    "way, as a share of delta-V",
    above(0.2),
    "a delta-V that turns with the normal by 10 degrees moves by 17 percent; with the 10 "
    f"percent by which its size may differ, {MESSAGES}, that is 20 percent",
)
def normal(case: ImpactCase) -> Iterator[Measured]:
    return _compare_delta_v(case, case.turned_normals)


@finding(
    "the same as law_yaw, with the normal turned by 10 degrees either way",
    above(0.5),
    "set here: half or double; levers are short, so that a quarter is passed by four in ten "
    "ordinary side impacts",
)
def normal_yaw(case: ImpactCase) -> Iterator[Measured]:
    return _compare_yaw(case, case.turned_normals)


@finding(
    "largest change of delta-V in what would move the answer (diagnose(...).moves), as a share "
    "of delta-V; inf if there is no answer then",
    above(0.25),
    "set here: a quarter; predictions of staged crashes from drawn contacts, made before their "
    "measurements were read, scatter by about a fifth (documentation, validation, table 1)",
)
def moves(case: ImpactCase) -> Iterator[Measured]:
    if not case.moves:
        return
    most = case.moves[0]
    if math.isinf(most.share):
        yield Measured(math.inf, f"{most.what}: there is no answer")
        return
    changes = zip(case.sides, (most.delta_v_a, most.delta_v_b), strict=True)
    parts = [
        f"delta-V of {who} by {case.text(change, 'speed')} of {case.text(side.delta_v, 'speed')}"
        for (_, who, side), change in changes
        if side.delta_v > 0.0
    ]
    turns = [
        f"the yaw rate of {who} by {case.text(turn, 'yaw rate')}"
        for (_, who, _), turn in zip(case.sides, (most.yaw_rate_a, most.yaw_rate_b), strict=True)
        if turn is not None and turn > _YAW_RATE_SEEN
    ]
    sentence = f"{most.what}: that moves {', '.join([*parts, *turns])}"
    yield Measured(most.share, sentence, rounding=RATIO_ROUNDING)


@finding(
    "largest change of a yaw rate after in what would move the answer",
    above(2.0, "rad/s"),
    "set here: a third of a turn in a second of the way to rest, which a rest position shows",
)
def moves_yaw(case: ImpactCase) -> Iterator[Measured]:
    turns = [
        (turn, label, who, move.what)
        for move in case.moves
        for (label, who, _), turn in zip(
            case.sides, (move.yaw_rate_a, move.yaw_rate_b), strict=True
        )
        if turn is not None and not math.isnan(turn)
    ]
    if turns:
        turn, label, who, what = max(turns)
        sentence = f"{what}: that moves the yaw rate of {who} by {case.text(turn, 'yaw rate')}"
        yield Measured(turn, sentence, label)


@finding(
    "friction, where the contact slides",
    below(INTER_VEHICLE_FRICTION.low),
    "reference.INTER_VEHICLE_FRICTION",
)
def friction_low(case: ImpactCase) -> Iterator[Measured]:
    impact, friction = case.answer, case.answer.friction
    slides = (
        impact.regime in ("sliding", "frictionless")
        and impact.slip_before != 0.0
        and impact.model != "linear_central"
    )
    if friction is not None and slides:
        sentence = (
            f"the contact slides with a friction of {friction:.3g}; 0.3 to 1.0 is recommended "
            "between vehicles, 0.55 usual"
        )
        yield Measured(friction, sentence)


@finding(
    "magnitude of the impulse ratio of a contact that was stated, or taken, to stick",
    above(INTER_VEHICLE_FRICTION.low),
    "reference.INTER_VEHICLE_FRICTION",
)
def may_slide(case: ImpactCase) -> Iterator[Measured]:
    impact, origin = case.answer, case.answer.reconstruction
    movable = math.isfinite(impact.a.before.mass) and math.isfinite(impact.b.before.mass)
    if origin is not None and from_components(origin.known):
        stated = taken_to_stick(impact)
    else:
        stated = impact.friction == math.inf and movable
    bound = origin is not None and any((origin.one_sided or {}).values())
    if impact.regime != "sticking" or bound or not stated:
        return
    ratio = abs(impact.impulse_ratio)
    slid = if_it_slid(impact)
    then = NOT_THIS if origin is not None else f"friction was less than that, and {NOT_THIS}"
    if slid is not None and slid.reconstruction is not None:
        speeds = {name: case.text(getattr(slid, name), "speed") for name in ("speed_a", "speed_b")}
        then = " and ".join(bounds_of(slid.reconstruction.one_sided or {}, speeds)) or NOT_THIS
    yield Measured(ratio, sticking_needs(ratio, then))


@finding(
    "number of speeds known from one side only, as the contact slid or may have",
    above(0.0),
    "set here: a bound is no value",
)
def one_sided(case: ImpactCase) -> Iterator[Measured]:
    origin = case.answer.reconstruction
    sides = {} if origin is None else origin.one_sided or {}
    count = sum(map(abs, sides.values()))
    speeds = {
        f"speed_{label}": case.text(side.before.speed, "speed") for label, _, side in case.sides
    }
    sentence = (
        f"the contact slid, or may have: {' and '.join(bounds_of(sides, speeds))}; a speed, an "
        "energy or both EES would tell more"
    )
    yield Measured(count, sentence)


@finding(
    "largest difference between components of delta-V that were given and the answer, as a share "
    "of the impulse",
    above(RECORDER_ACCURACY.high),
    "reference.RECORDER_ACCURACY",
)
def components_differ(case: ImpactCase) -> Iterator[Measured]:
    origin = case.answer.reconstruction
    if origin is None or not from_components(origin.known):
        return
    share = float(shares_apart(case.answer))
    yield Measured(share, apart_in_words(case.answer, share))


@finding(
    "magnitude of the impulse ratio, which no Coulomb friction explains",
    above(INTER_VEHICLE_FRICTION.high),
    "reference.INTER_VEHICLE_FRICTION",
)
def ratio_high(case: ImpactCase) -> Iterator[Measured]:
    ratio = abs(case.answer.impulse_ratio)
    sentence = (
        f"the tangential impulse is {ratio:.2f} times the normal one, beyond friction between "
        "vehicles: parts must have snagged, as in small-overlap tests (1.57 to 2.05)"
    )
    yield Measured(ratio, sentence)

"""The answers of ``speeds``: an impact for each root, what has to be said of them, and why a case
has none or more than one.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ..impact.doubts import MAY_SLIDE
from ..impact.impact import Impact
from ..impact.inputs import Inputs
from ..impact.instant import LEFT_BACKWARDS, looked_for
from ..impact.reconstruction import NOT_THIS, Reconstruction, bounds_of
from ..impact.run import error_of, warn_of_refusals
from ..impact.tyres_stop import state_tyres_stop
from ..kernels.contact_laws import FRICTION
from ..kernels.status import EPS, Status
from ..messages.errors import (
    AmbiguousSolutionError,
    CollisionsError,
    IllConditionedWarning,
    OutOfRangeWarning,
)
from ..messages.warning import (
    answer_counts,
    in_study,
    state_of_cases,
    warn_of_cases,
    warn_of_samples,
)
from ..quantities.refusals import LATERAL
from ..quantities.tables import Sentences, given_texts, said
from ..vehicle.vehicle import moved
from .common import ASK_ALONE, Cases, input_faults, run_forward, split_texts
from .lasting import tyre_faults
from .speeds_algebra import NO_ROOT, ROOT_TOL, Root, Scene
from .speeds_components import (
    ACCURACY,
    CLEARLY_BELOW,
    COMPONENTS,
    MOST_ENERGY,
    RATIO_SHOWN,
    ComponentScene,
    with_most_energy,
)
from .speeds_search import Search, forwards
from .speeds_tyres import Attempt

# Above this restitution hardly any energy is lost along the normal.
_ELASTIC = 1.0 - 1e-6
# Of the closing speed: a speed backwards by no more is 0 but for rounding.
_ROUNDING = 1e-12
# Why a contact that slid has no direction.
EITHER_WAY = "both fit within the accuracy stated for recorders (reference.RECORDER_ACCURACY)"
# Distances of two answers whose ratio is less: the fold, quadratic, is as near as the samples are
# apart.
_NEAR_FOLD = 0.7


class Ways(NamedTuple):
    """Other ways to solve a single case: with other arguments, and with the signs of lateral
    components turned, which says of which components an answer results then; and with a contact
    that slid in one direction alone, by the sign of its impulse ratio.
    """

    again: Callable[..., tuple[Impact, ...]]
    turned: Callable[..., str]
    one_way: Callable[[float], tuple[Impact, ...]]


def answers_of(
    search: Search,
    attempted: Attempt,
    ways: Ways,
    reconstruction: Callable[..., Reconstruction],
) -> tuple[Impact, ...]:
    """The impact of each root; raises for a single case without one. ``reconstruction`` makes what
    says how it was found.
    """
    cases, known, function = search.cases, search.known, search.function
    scene, found, inputs = attempted.scene, attempted.found, attempted.inputs
    faults = input_faults(scene.numbers, inputs.incomplete)
    of_walls = [
        np.isinf(scene.numbers[f"{name[-1]}.mass"])
        for name in scene.names
        if name.startswith("delta_v")
    ]
    faults += [(of_wall, Status.INFINITE_MASS) for of_wall in of_walls]
    if not scene.kinds[0].startswith("speed"):
        # However the evidence is told, speeds along one line show as their difference alone; what
        # tyres add to that is less than what anything is known to.
        (ax, ay), (bx, by) = (
            [scene.numbers[f"course_{label}[{i}]"] for i in range(2)] for label in "ab"
        )
        parallel = abs(ax * by - ay * bx) <= 8.0 * EPS
        faults.append((parallel, Status.PARALLEL_HEADINGS))
    faults.append((scene.undetermined, Status.UNDETERMINED))
    faults.append((scene.ambiguous, Status.AMBIGUOUS))
    staying = [
        split_texts(body, ("vx", "vy", "speed", "course"))[0] for body in (inputs.a, inputs.b)
    ]

    def inputs_of(root: Root, keep: Any) -> Inputs:
        bodies = []
        for label, body, speed, given in zip(
            "ab", (inputs.a, inputs.b), root[:2], staying, strict=True
        ):
            speed = speed * scene.speed_unit
            vx, vy = (
                cases.where(keep, speed * scene.numbers[f"course_{label}[{i}]"] + 0.0)
                for i in range(2)
            )
            bodies.append(moved(body, vx, vy, body.yaw_rate, given))
        e = inputs.restitution if function is None else cases.where(keep, root.restitution)
        own = attempted.inputs_of(root)
        return replace(own, a=bodies[0], b=bodies[1], restitution=e)

    if inputs.tyres:
        faults += tyre_faults(inputs.duration, inputs.tyres)
    nowhere = np.zeros(scene.shape, dtype=bool)
    count = all_count = _number_of(found, scene)
    ranks: list[Any] = []
    if search.forward_only:
        found, ranks = forwards(scene, found)
        count = _number_of(found, scene)
    # Stuck and slid.
    if np.any(scene.ambiguous):
        count, all_count = (np.where(scene.ambiguous, 2, one) for one in (count, all_count))
    impacts: list[Impact] = []
    scenes: list[ComponentScene | None] = []
    backward, whose, turned = 0.0, "", nowhere
    names = (*scene.names, *getattr(scene, "recorders", ()))
    for at, (root, there) in enumerate(found or [(NO_ROOT, nowhere)]):
        status = cases.first_status((*faults, (there, Status.OK), (True, Status.CONTRADICTORY)))
        if isinstance(status, int) and status != Status.OK:
            say = Sentences(inputs.texts)
            if status == Status.CONTRADICTORY and attempted.found:
                raise _backwards_alone(scene, attempted.found, known, say)
            if status == Status.AMBIGUOUS and isinstance(scene, ComponentScene):
                ways_of = [one for one in scene.ways or [scene] if np.any(one.ambiguous)]
                sticks = any(np.any(one.sticks) for one in ways_of)
                if any(np.any(one.both_ways) for one in [scene, *ways_of]) and not sticks:
                    raise _slid_either_way(scene, known, say, ways.one_way)
                if scene.energy is not None:
                    raise _either_beside_an_energy(scene, known, say, ways.again)
                raise _stuck_or_slid(scene, known, say, ways.again)
            by_energy = not any(name in COMPONENTS for name in known)
            if (
                inputs.tyres
                and status == Status.UNDETERMINED
                and by_energy
                and not inputs.rule_value
            ):
                raise error_of(
                    status,
                    f"without friction {' and '.join(known)} tell of the closing speed, and of the "
                    "speeds with it only by what the tyres add, which may be the same for many; "
                    "give one of the speeds",
                )
            if inputs.tyres and status == Status.CONTRADICTORY:
                raise error_of(
                    status,
                    f"no speeds were found with which a contact with these tyres has "
                    f"{' and '.join(known)}: {looked_for(names)}. Give another known in place of "
                    "one of these, check the courses and the normal, or take "
                    "`reconstruct.posterior` with wide priors for the speeds, which looks "
                    "everywhere",
                )
            raise _refusal(search, scene, status, say, ways.turned)
        origin = reconstruction(names, root.condition, count)
        own = None
        if isinstance(scene, ComponentScene):
            own = scene.of_way(root.way)
            origin = replace(
                origin,
                regime=own.stated,
                one_sided=_sides(own, cases, root, there),
                misfit=cases.where(there, scene.misfit),
            )
        if search.forward_only:
            origin = replace(origin, left_backwards=cases.counts(all_count - count))
        impact = run_forward(
            partial(inputs_of, root), status, origin, None if cases.shape is None else "nan"
        )
        impacts.append(impact)
        scenes.append(own)
        if not answer_counts(at):
            continue
        state_tyres_stop(impact)
        for label, speed in zip("AB", root[:2], strict=True):
            speed = np.where(impact.refused, np.nan, speed * scene.speed_unit)
            # One that is 0 to rounding goes neither way.
            goes_back = np.less(speed, -_ROUNDING * impact.closing_speed)
            slowest = np.fmin.reduce(np.where(goes_back, speed, 0.0), axis=None, initial=0.0)
            backward, whose = min((backward, whose), (float(slowest), label))
            turned = turned | goes_back
        if function is not None:
            function.warn_at(np.where(impact.refused, np.nan, impact.closing_speed))
    if cases.shape is not None and np.any(impacts[0].refused):
        warn_of_refusals(impacts[0].status, ASK_ALONE)
    _warn_of_folds(scene, found, count, all_count)
    if search.forward_only:
        _say_what_is_left_out(cases, ranks, count, all_count)
    if isinstance(scene, ComponentScene):
        scene.warn(np.logical_not(impacts[0].refused), cases)
        for at, (own, impact) in enumerate(zip(scenes, impacts, strict=True)):
            if own is not None and answer_counts(at):
                _warn_of_slip(own, impact, cases)
                _warn_of_bounds(impact, cases)
    if backward < 0.0:
        cure = (
            "backwards along its course; check the courses, and the normal, which must point "
            "from A into B"
        )
        sides = [
            impact.reconstruction.one_sided or {} for impact in impacts if impact.reconstruction
        ]
        if any(np.any(side) for one in sides for side in one.values()):
            cure += "; the bound is of cars that go so, and says nothing of those that go forwards"
        text = (
            f"the speed of {whose} came out as {said(backward, 'speed', given_texts(impacts[0]))}: "
            f"{cure}"
        )
        # A wrong sign has most cases of a batch go backwards, and takes time to be looked for.
        likely = isinstance(scene, ComponentScene) and np.mean(turned) > 0.5
        advice = ""
        if wrong := ways.turned(turned) if likely else "":
            these = "" if cases.shape is None else " in most of these cases"
            advice = f". With {wrong} of the other sign both go forwards{these}: {LATERAL}"
        warning = OutOfRangeWarning(
            cases.how_many(turned) + text + advice, code="negative_speed", value=backward
        )
        said_of_study = f"a speed comes out below 0, {cure}{advice}"
        warn_of_cases(warning, {said_of_study: cases.each(turned)})
    return tuple(impacts)


def _sides(scene: ComponentScene, cases: Cases, root: Root, there: Any) -> dict[str, Any] | None:
    """Which way the truth may lie from each speed; None unless ``slid`` asked for it."""
    if not scene.slid:
        return None
    sides = scene.sides or (0.0, 0.0)
    return {
        f"speed_{label}": cases.sides(np.where(there, _of_size(side, speed), 0.0))
        for label, side, speed in zip("ab", sides, root[:2], strict=True)
    }


def _of_size(side: Any, speed: Any) -> Any:
    """Which way the size of a speed may go, by which way it goes along the course: backwards, the
    size of one that falls rises.
    """
    return np.where(np.less(speed, 0.0), -side, side)


def _if_it_slid(scene: ComponentScene, impact: Impact, say: Sentences) -> str:
    """What follows for the speeds of a single case if its contact slid."""
    if not scene.begins_a_family:
        return NOT_THIS
    if scene.slides_both_ways():
        return f"it may have in either direction, since {EITHER_WAY}, and the speeds are open"
    signed = [_along(impact, label, scene) for label in "ab"]
    speeds, sides = scene.if_slid([speed / scene.speed_unit for speed in signed])
    ends = [float(speed * scene.speed_unit) for speed in speeds]
    bounds = bounds_of(
        {
            f"speed_{label}": int(np.nan_to_num(_of_size(side, end)))
            for label, side, end in zip("ab", sides, ends, strict=True)
        },
        {f"speed_{label}": _told(end, say) for label, end in zip("ab", ends, strict=True)},
    )
    return " and ".join(bounds) or NOT_THIS


def _warn_of_bounds(impact: Impact, cases: Cases) -> None:
    """Warn a study, which would else take the end of a family for a value, of cases that are known
    from one side only; outside of it the answer says so itself.
    """
    sides = getattr(impact.reconstruction, "one_sided", None) or {}
    bound = np.any([np.not_equal(side, 0) for side in sides.values()], axis=0) if sides else False
    if in_study() and np.any(bound):
        text = (
            "the contact slid, or may have, and a speed is known from one side only: hand it on as "
            "`uncertainty.OneSided` with `reconstruction.one_sided`, or its range is that of the "
            "least slip"
        )
        warn_of_cases(OutOfRangeWarning(text, code="bound_as_value"), {text: cases.each(bound)})


def _warn_of_slip(scene: ComponentScene, impact: Impact, cases: Cases) -> None:
    """Warn of a contact that was stated or taken to stick and may have slid, and of cases of a
    batch for which that has to be said.
    """
    answered = np.logical_not(impact.refused)
    slides = scene.may_slide & answered
    if np.any(slides):
        why = (
            f"contacts between vehicles slide from {MAY_SLIDE:g} on "
            "(reference.INTER_VEHICLE_FRICTION)"
        )
        ratio = float(np.max(np.where(slides, abs(scene.ratio), 0.0)))
        one_end = end = NOT_THIS
        if scene.begins_a_family:
            one_end = "what was found is one end of the speeds that it may have had"
            end = "the speeds are those of one end of a family"
            # Not taken beside an energy.
            end += "" if scene.energy is not None else "; `slid='bound'` says which"
        if cases.shape is None:
            one_end = _if_it_slid(scene, impact, Sentences(impact.inputs.texts))
        needs = f"to stick, the contact needs an impulse ratio of {ratio:.2f}"
        text = f"{needs}, and {why}. If it slid, {one_end}"
        sentence = (
            f"the contact was taken to stick at an impulse ratio of {MAY_SLIDE:g} or more, "
            f"and {why}. If it slid, {end}"
        )
        warning = IllConditionedWarning(
            cases.how_many(slides) + text, code="may_slide", ratio=ratio
        )
        warn_of_cases(warning, {sentence: cases.each(slides)})
    if cases.shape is not None and np.any(scene.both_ways):
        text = (
            f"components of delta-V do not tell in which direction the contact slid: {EITHER_WAY}, "
            "so a bound has no side; give another component, or one of the speeds"
        )
        warning = IllConditionedWarning(
            cases.how_many(scene.both_ways) + text, code="slid_either_way"
        )
        warn_of_cases(warning, {text: cases.each(scene.both_ways)})
    if cases.shape is not None and scene.rule == FRICTION and not scene.slid:
        left = (scene.ambiguous | scene.undetermined) & np.logical_not(answered)
        if np.any(left & scene.leaves_slip):
            text = (
                "components of delta-V do not tell whether the contact stuck or slid, or it "
                "slid and leaves the slip open: write `regime='sticking'` if it stuck, give "
                "one of the speeds, or write `slid='bound'` for the end of the speeds that it "
                "may have had"
            )
            warning = IllConditionedWarning(cases.how_many(left) + text, code="stuck_or_slid")
            warn_of_cases(warning, {text: cases.each(left)})


def _stuck_or_slid(
    scene: ComponentScene,
    known: dict[str, Any],
    say: Sentences,
    again: Callable[..., tuple[Impact, ...]],
) -> AmbiguousSolutionError:
    """The error for a single case in which the contact either stuck or slid."""
    # Several ways may lead to one answer. A ratio of the other sign slid the other way.
    ratios = list(
        {
            f"{float(one.ratio):.9g}": float(one.ratio)
            for one in scene.ways or [scene]
            if np.any(one.ambiguous)
        }.values()
    )
    friction = float(scene.bound)
    stuck = again(regime="sticking", slid=None)
    slid: list[Impact] = []
    if math.isinf(friction):
        # Each at the ratio that is shown: beside a speed not that of the one that stuck.
        with suppress(CollisionsError):
            slid = [
                one
                for one in again(regime="sliding", slid="bound")
                if len(scene.unknown) == 1
                or any(abs(one.impulse_ratio - ratio) <= ROOT_TOL for ratio in ratios)
            ]
    # Far below the friction, a contact that slid did so at the friction, or it is that of another
    # impulse.
    far = not math.isinf(friction) and max(map(abs, ratios)) <= CLEARLY_BELOW * friction
    if far:
        with suppress(CollisionsError):
            slid = list(again(regime="sliding", slid="bound"))
    beside_speed = len(scene.unknown) == 1
    reaches = [
        one.reach
        for one in scene.ways or [scene]
        if np.any(one.ambiguous) and math.isfinite(one.reach[0])
    ]
    if not slid and reaches:
        # Those that fit have other ratios than the one shown.
        for ratio in dict.fromkeys(abs(float(one)) for one in reaches[0][2:]):
            with suppress(CollisionsError):
                slid += again(regime="sliding", slid=None, friction=ratio)
    elif not slid:
        for ratio in ratios:
            either_way = again(regime="sliding", slid="bound", friction=abs(ratio))
            slid.append(min(either_way, key=lambda one: abs(one.impulse_ratio - ratio)))
    ends = [[_along(impact, label, scene) for label in "ab"] for impact in slid]
    if len(stuck) == len(slid) == 1:
        # Where both are one place they have the same digits.
        same = ROOT_TOL * slid[0].closing_speed
        alike = zip(ends[0], (_along(stuck[0], label, scene) for label in "ab"), strict=True)
        ends = [[own if abs(own - end) <= same else end for end, own in alike]]
    speeds = [
        {f"speed_{label}": _told(end, say) for label, end in zip("ab", one, strict=True)}
        for one in ends
    ]
    bounds = [
        " and ".join(bounds_of(getattr(impact.reconstruction, "one_sided", None) or {}, one))
        for impact, one in zip(slid, speeds, strict=True)
    ]
    # One that leaves nothing open, as beside a known speed, has no bound.
    if_slid = ", or ".join(
        bound or _alone(end, say) for bound, end in zip(bounds, ends, strict=True)
    )
    if reaches:
        least, most = (
            pick(float(one[at]) for one in reaches) * scene.speed_unit
            for at, pick in enumerate((min, max))
        )
        if_slid += (
            f"{'; ' if slid else ', '}that of {'AB'[scene.unknown[0]]} may then be from "
            f"{_told(least, say)} to {_told(most, say)} within the accuracy stated for recorders "
            "(reference.RECORDER_ACCURACY)"
        )
    alone = ", or ".join(
        _alone([_along(impact, label, scene) for label in "ab"], say) for impact in stuck
    )
    shown = " or ".join(dict.fromkeys(f"{abs(one):.2f}" for one in ratios))
    allowed = (
        "`friction=inf` does not say that it stuck"
        if math.isinf(friction)
        else f"`friction={friction:.4g}` is not clearly above that"
    )
    at = "at a ratio near that" if reaches else "at that ratio"
    if slid and beside_speed and math.isinf(friction):
        # That of the components alone, from which one that stuck beside this speed differs.
        own = dict.fromkeys(f"{abs(one.impulse_ratio):.2f}" for one in slid)
        at = f"at a ratio of {' or '.join(own)}"
    if far:
        at = f"with `friction={friction:.4g}`"
        allowed = f"a contact that slid {at} has the same within {ACCURACY:.0%}"
    with_ = "" if beside_speed else ", the latter with one of the speeds or the energy lost"
    then = "this end of the speeds that it may have had"
    if beside_speed and not any(bounds):
        then = "the one that stuck and the side of it on which the other lies"
    then = "" if scene.slid else f"; or `slid='bound'` for {then}"
    return AmbiguousSolutionError(
        f"{' and '.join(known)} do not tell whether the contact stuck or slid: they "
        f"have an impulse ratio of {shown}, and {allowed}. If it stuck, {alone}; if it slid "
        f"{at}, {if_slid}. Write `regime='sticking'` or `regime='sliding'` if you "
        f"know which{with_}{then}"
        "`|. Both answers are in .solutions|`",
        code=Status.AMBIGUOUS.label,
        ratio=abs(ratios[0]),
        solutions=(*stuck, *slid),
    )


def _either_beside_an_energy(
    scene: ComponentScene,
    known: dict[str, Any],
    say: Sentences,
    again: Callable[..., tuple[Impact, ...]],
) -> AmbiguousSolutionError:
    """The error for a single case in which components and an energy fit one that stuck and one that
    slid.
    """
    more = {name: one for name, one in with_most_energy(known).items() if name not in COMPONENTS}
    answers: list[tuple[Impact, ...]] = []
    for changes in ({"regime": "sticking"}, {"regime": "sliding"}, {"regime": "sliding", **more}):
        answers.append(())
        with suppress(CollisionsError):
            # One may fit with more energy alone.
            answers[-1] = again(**changes, slid=None)
    told = [
        ", or ".join(
            _alone([_along(impact, label, scene) for label in "ab"], say) for impact in impacts
        )
        for impacts in answers
    ]
    percent = f"{100.0 * (MOST_ENERGY - 1.0):.0f} percent"
    with_more = f"with an energy {percent} greater, {told[2]}" if told[2] else ""
    if_slid = " and, ".join(one for one in (told[1], with_more) if one) or "others"
    return AmbiguousSolutionError(
        f"{' and '.join(known)} do not tell whether the contact stuck or slid with "
        f"`friction={float(scene.bound):.4g}`: both fit within {ACCURACY:.0%} of the impulse, the "
        f"stated accuracy of recorders, which are {percent} of an energy. If it stuck, {told[0]}; "
        f"if it slid, {if_slid}. Write `regime='sticking'` or `regime='sliding'` if you know "
        "which, or give one of the speeds`|. These answers are in .solutions|`",
        code=Status.AMBIGUOUS.label,
        solutions=tuple(impact for impacts in answers for impact in impacts),
    )


def _slid_either_way(
    scene: Scene,
    known: dict[str, Any],
    say: Sentences,
    one_way: Callable[[float], tuple[Impact, ...]],
) -> AmbiguousSolutionError:
    """The error for a single case of which a bound has no side."""
    solutions = (*one_way(1.0), *one_way(-1.0))
    then, where = "a bound has no side", "The end that was found is in .solutions"
    if len(solutions) > 1:
        where = "Both answers are in .solutions"
        then = ", or ".join(
            " and ".join(
                bounds_of(
                    getattr(impact.reconstruction, "one_sided", None) or {},
                    {f"speed_{label}": _told(_along(impact, label, scene), say) for label in "ab"},
                )
            )
            for impact in solutions
        )
    return AmbiguousSolutionError(
        f"{' and '.join(known)} do not tell in which direction the contact slid: {EITHER_WAY}, so "
        f"{then}. Give another component of delta-V, or one of the speeds`|. {where}|`",
        code=Status.AMBIGUOUS.label,
        solutions=solutions,
    )


def _values(known: dict[str, Any], say: Sentences) -> dict[str, str]:
    """What was known of a single case, by name, each with its number."""
    return {
        name: f"{name} = {say(value, 'energy' if name == 'energy_loss' else 'speed')}"
        for name, value in known.items()
    }


def _backwards_alone(
    scene: Scene, found: list[tuple[Root, Any]], known: dict[str, Any], say: Sentences
) -> CollisionsError:
    """The error for a single case in every answer of which a vehicle goes backwards, where those
    are left out.
    """
    told = [
        _alone([float(speed * scene.speed_unit) for speed in root[:2]], say) for root, _ in found
    ]
    return error_of(
        Status.CONTRADICTORY,
        f"in every answer that fits {' and '.join(_values(known, say).values())} a vehicle "
        "goes backwards along its course, and `forward_only=True` leaves those out: "
        f"{', or '.join(told)}. Check the courses, and the normal, which must point from A into B, "
        "or leave out `forward_only=True`",
    )


def _along(impact: Impact, label: str, scene: Scene) -> float:
    """The speed of a vehicle before, below 0 where it goes backwards along its course."""
    before = getattr(impact, label).before
    c, s = (scene.numbers[f"course_{label}[{i}]"] for i in range(2))
    return float(math.copysign(before.speed, c * before.vx + s * before.vy))


def _told(speed: float, say: Sentences) -> str:
    """The size of a speed along a course, and that it is backwards."""
    return say(abs(speed), "speed") + (" backwards along its course" if speed < 0.0 else "")


def _alone(speeds: Sequence[float], say: Sentences) -> str:
    """The speeds of both vehicles if the contact stuck."""
    if min(speeds) >= 0.0:
        one, other = (say(speed, "speed") for speed in speeds)
        return f"the speed of A is {one} and that of B {other}"
    return " and ".join(
        f"{label} would go backwards along its course at {say(-speed, 'speed')}"
        if speed < 0.0
        else f"the speed of {label} is {say(speed, 'speed')}"
        for label, speed in zip("AB", speeds, strict=True)
    )


def _number_of(found: list[tuple[Root, Any]], scene: Scene) -> Any:
    """How many roots each case has."""
    none = np.zeros(scene.shape, dtype=np.int64)
    return sum((there.astype(np.int64) for _, there in found), none)


def _say_what_is_left_out(cases: Cases, ranks: list[Any], count: Any, all_count: Any) -> None:
    """Say in which cases answers were left out in which a vehicle goes backwards, and warn of those
    that have no other, and of samples that are of one answer here and of another there.
    """
    alone = (count == 0) & (all_count > 0)
    if cases.shape is not None and np.any(alone):
        text = (
            "in every answer a vehicle goes backwards along its course, and `forward_only=True` "
            "leaves those out"
        )
        warning = OutOfRangeWarning(cases.how_many(alone) + text, code="only_backwards")
        warn_of_cases(warning, {text: cases.each(alone)})
    others = (count > 0) & (all_count > count)
    if np.any(others):
        text = f"more than this one fits, {LEFT_BACKWARDS}"
        state_of_cases({text: cases.each(others)}, "left_backwards")
    for at, rank in enumerate(ranks):
        there = count > at
        below = np.broadcast_to(rank, np.shape(count))[there]
        above = (all_count - 1)[there] - below
        # Where others begin or end among themselves, an answer keeps its place from one end.
        moves = below.size and np.ptp(below) > 0 and np.ptp(above) > 0
        if answer_counts(at) and moves:
            warn_of_samples(
                OutOfRangeWarning(
                    "of two answers the one of lower closing speed has a vehicle go backwards in "
                    "some cases alone, and `forward_only=True` leaves it out there and takes the "
                    "other: the samples are no range of one answer. Leave out `forward_only=True` "
                    "and look at both answers, or bound the inputs",
                    code="fold",
                )
            )
            break


def _warn_of_folds(scene: Scene, found: list[tuple[Root, Any]], count: Any, all_count: Any) -> None:
    """Warn a study of samples near a fold: some cases have no answer, or its two answers all but
    meet. ``all_count`` is of all answers, of which those ``found`` may go forwards alone: of the
    others it is no matter that two of them meet.
    """
    if not np.any(all_count > 1):
        return
    near = False
    if len(found) > 1:
        (one, _), (other, both) = found[:2]
        gap = np.hypot(one.speed_a - other.speed_a, one.speed_b - other.speed_b)[both]
        near = gap.size > 0 and gap.min() < _NEAR_FOLD * gap.max()
    if near or np.any(all_count == 0) or (len(found) > 1 and np.any(count < 2)):
        warn_of_samples(
            OutOfRangeWarning(
                f"{' and '.join(scene.names)} reach a fold, where two answers meet and beyond "
                "which there is none: the samples are no range of one answer. Look at both "
                "answers, or give components of delta-V or another known",
                code="fold",
            )
        )


def _refusal(
    search: Search,
    scene: Scene,
    status: int,
    say: Sentences,
    turned: Callable[[], str],
) -> CollisionsError:
    """The error for a single case without a solution."""
    known = search.known
    names = " and ".join(known)
    values = _values(known, say)
    speed_is_known = scene.kinds[0].startswith("speed")
    if status == Status.INFINITE_MASS:
        kind = next(kind for kind in known if kind.startswith("delta_v"))
        other = "delta_v_b" if kind == "delta_v_a" else "delta_v_a"
        text = (
            f"{kind} is that of an infinite mass, whose motion tells nothing of the impact; give "
            f"{other}"
        )
    elif status == Status.PARALLEL_HEADINGS:
        text = (
            f"the courses are parallel, so {names} tell of the closing speed "
            f"{'all but ' if search.inputs.tyres else ''}alone; give one of the speeds"
        )
    elif isinstance(scene, ComponentScene) and status == Status.UNDETERMINED:
        text = (
            f"the contact slides, or its speeds do not show in {names}: their direction only "
            "repeats the friction, which leaves the slip undetermined; give "
            + ("the speed of the other vehicle" if speed_is_known else "one of the speeds")
        )
        if not scene.bound and not speed_is_known:
            text = (
                f"without friction {names} tell of the closing speed alone, whatever the slip; "
                "give one of the speeds"
            )
        elif scene.rule == FRICTION and not scene.slid:
            text += ", or write `slid='bound'` for the end of the speeds that it may have had"
    elif isinstance(scene, ComponentScene) and (
        scene.stated == "sticking" and abs(scene.shown_ratio()) > scene.bound
    ):
        status = Status.CONTRADICTORY
        text = (
            "to stick, the contact needs an impulse ratio of "
            f"{float(abs(scene.shown_ratio())):.2f}, and "
            f"`friction={float(scene.bound):.4g}` allows no more than that; give the "
            "friction that held it (or inf), or leave out `regime='sticking'`"
        )
    elif status == Status.UNDETERMINED and "energy_loss" in scene.kinds and scene.e > _ELASTIC:
        energy = values[scene.names[scene.kinds.index("energy_loss")]]
        text = (
            f"many speeds along these courses lead to {energy} as far as rounding lets it tell, "
            "so it does not say which of them; give another of the knowns"
        )
    elif status == Status.UNDETERMINED and speed_is_known:
        text = (
            f"{names} leave the other speed open, for many lead to the same; give another of the "
            "knowns"
        )
    elif status == Status.UNDETERMINED:
        text = (
            f"where the contact slides, {names} tell of the closing speed alone and leave the "
            "slip open; give one of the speeds"
        )
    else:
        if search.function is not None:
            search.function.complain()
        status = Status.CONTRADICTORY
        text = (
            f"no speeds along these courses fit {' and '.join(values.values())} with "
            f"this restitution, {scene.rule} and geometry; check the courses, and the normal, "
            "which must point from A into B, or give another known in place of one of these"
        )
        if isinstance(scene, ComponentScene) and np.any(scene.friction_differs()):
            text += f"; or the contact slid at another ratio than this friction. {RATIO_SHOWN}"
    if status == Status.CONTRADICTORY and (wrong := turned()):
        text += f". With {wrong} of the other sign there is an answer: {LATERAL}"
    return error_of(status, text)
